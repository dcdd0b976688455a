"""The layers of a napari viewer as a scene.

napari counts axes z, y, x; Halflight's world is x, y, z. Where x, y and z are left-handed as the viewer's camera shows them,
the scene's z axis is turned round.
"""
from __future__ import annotations

from typing import Any

import halflight
import numpy as np

_MOST_VOXELS = 1 << 28  # of a pyramid's level
_UNIT_VOXELS = 4  # a layer's brightest value is as opaque as the layer over so many voxels


class _View:
    """Which axes are seen, where the others stand, and how the layers' world becomes the scene's."""

    def __init__(self, viewer: Any) -> None:
        self.viewer = viewer
        self.displayed = tuple(viewer.dims.order)[-3:] if viewer.dims.ndim >= 3 else (0, 1)
        # napari's word is of its axes z, y, x: what it calls right-handed is left-handed as x, y, z.
        self.mirrored = str(getattr(viewer.camera, "handedness", "left")).rsplit(".", 1)[-1].lower() == "right"

    def axes(self, layer: Any) -> list[int]:
        """The layer's own axes that are seen, z first: it may have fewer than the viewer."""
        shift = self.viewer.dims.ndim - layer.ndim
        return [axis - shift for axis in self.displayed if axis >= shift]

    def affine(self, layer: Any, place: Any = None) -> np.ndarray:
        """4x4, from data coordinates (x, y, z) of the seen axes to the scene's world."""
        axes = self.axes(layer)
        origin = np.zeros(layer.ndim) if place is None else np.asarray(place, dtype=float)
        start = np.asarray(layer.data_to_world(origin))[axes]
        matrix = np.eye(4)
        for column, axis in enumerate(axes[::-1]):
            step = np.asarray(layer.data_to_world(origin + np.eye(layer.ndim)[axis]))[axes] - start
            matrix[:len(axes), column] = step[::-1]
        matrix[:len(axes), 3] = start[::-1]
        return np.diag([1, 1, -1, 1]) @ matrix if self.mirrored else matrix

    def position(self, layer: Any) -> np.ndarray:
        """Where the sliders stand, in the layer's data coordinates."""
        return np.asarray(layer.world_to_data(np.asarray(self.viewer.dims.point)[-layer.ndim:]))

    def is_here(self, layer: Any, coordinates: np.ndarray) -> np.ndarray:
        """Which data coordinates, [n][ndim], lie in the slice that the sliders show."""
        hidden = [axis for axis in range(layer.ndim) if axis not in self.axes(layer)]
        return np.all(abs(coordinates[:, hidden] - self.position(layer)[hidden]) <= 0.5, axis=1) if hidden else np.ones(len(coordinates), bool)

    def xyz(self, layer: Any, coordinates: np.ndarray) -> np.ndarray:
        """Data coordinates in the scene's world, [n][3]."""
        axes = self.axes(layer)
        plain = np.zeros((len(coordinates), 3))
        plain[:, :len(axes)] = coordinates[:, axes][:, ::-1]
        return plain @ self.affine(layer)[:3, :3].T + self.affine(layer)[:3, 3]


def _slice(view: _View, layer: Any) -> tuple[Any, np.ndarray]:
    """The three-dimensional array that is seen, [z][y][x] (and colours), and where it is."""
    data, factor = layer.data, np.ones(layer.ndim)
    if layer.multiscale:
        sizes = [int(np.prod(level.shape)) for level in data]
        level = next((n for n, size in enumerate(sizes) if size <= _MOST_VOXELS), len(sizes) - 1)
        factor = np.asarray(layer.downsample_factors[level])[:layer.ndim]
        data = data[level]
    axes, position = view.axes(layer), view.position(layer) / factor
    index: list[Any] = [slice(None)] * layer.ndim
    for axis in range(layer.ndim):
        if axis not in axes:
            index[axis] = int(np.clip(round(position[axis]), 0, data.shape[axis] - 1))
    array = np.asarray(data[tuple(index)])
    kept = [axis for axis in range(layer.ndim) if axis in axes]
    colors = [len(kept)] if array.ndim > len(kept) else []
    array = array.transpose([kept.index(axis) for axis in axes] + colors)
    if len(axes) == 2:
        array = array[None]
    affine = view.affine(layer).copy()
    scale = np.ones(3)
    scale[:len(axes)] = factor[axes][::-1]
    affine[:3, 3] += affine[:3, :3] @ ((scale - 1) / 2)  # the middle of a coarse voxel
    affine[:3, :3] *= scale
    return array, affine


def _image(view: _View, layer: Any, look: str) -> halflight.Volume:
    array, affine = _slice(view, layer)
    voxel = float(np.linalg.norm(affine[:3, :3], axis=0).min())
    if layer.rgb:
        return halflight.Volume(np.ascontiguousarray(array), affine=affine, name=layer.name, copy=True)
    plain = halflight.Volume(array, affine=affine, name=layer.name, copy=True)
    function = halflight.TransferFunction.from_napari(layer, unit_distance=_UNIT_VOXELS * voxel)
    if str(layer.rendering).lower().endswith("iso"):
        threshold = float(layer.iso_threshold)
        color = function.color[np.abs(function.color[:, 0] - threshold).argmin(), 1:]
        return plain.replace(iso=[(threshold, tuple(color), float(layer.opacity))])
    if look == "layers":
        return plain.replace(transfer_function=function, shading="phong")
    chosen = plain.replace(look=look)
    own = chosen.look["transfer_function"]
    return chosen.replace(transfer_function=halflight.TransferFunction(own.opacity, function.color, own.unit_distance))


def _labels(view: _View, layer: Any) -> halflight.Volume | None:
    array, affine = _slice(view, layer)
    wanted = [int(layer.selected_label)] if layer.show_selected_label else [int(one) for one in np.unique(array)]
    shown = {}
    for value in wanted:
        color = None if value == 0 else layer.get_color(value)
        if color is not None and np.asarray(color)[3] > 0:
            shown[value] = (halflight.srgb(*map(float, np.clip(np.asarray(color)[:3], 0, 1))), float(layer.opacity))
    return halflight.Volume(array, affine=affine, name=layer.name, labels=shown, copy=True) if shown else None


def _srgb8(colors: Any) -> np.ndarray:
    return np.rint(255 * np.clip(np.asarray(colors, dtype=float), 0, 1)).astype(np.uint8)


def _surface(view: _View, layer: Any) -> halflight.Mesh:
    vertices, faces = np.asarray(layer.data[0]), np.asarray(layer.data[1])
    values = np.asarray(layer.data[2] if len(layer.data) > 2 else np.ones(len(vertices)))
    while values.ndim > 1:  # values over the sliders' axes
        values = values[int(np.clip(view.viewer.dims.current_step[0], 0, len(values) - 1))]
    if layer.vertex_colors is not None:
        shown = _srgb8(layer.vertex_colors)
    else:
        low, high = layer.contrast_limits
        shown = _srgb8(layer.colormap.map(np.clip((values - low) / max(high - low, 1e-30), 0, 1) ** float(layer.gamma)))
    lit = str(layer.shading).lower()
    light = {"diffuse": 0.0, "specular": 0.0, "ambient": 0.0, "emission": 1.0} if lit.endswith("none") else {}
    return halflight.Mesh(view.xyz(layer, vertices), faces[:, ::-1] if np.linalg.det(view.affine(layer)[:3, :3]) < 0 else faces, colors=shown, color=1,
                          opacity=float(layer.opacity), smooth=lit.endswith("smooth"), name=layer.name, **light)


def _points(view: _View, layer: Any) -> halflight.Mesh | None:
    seen = view.is_here(layer, np.asarray(layer.data)) & np.asarray(layer.shown)
    if not seen.any():
        return None
    scale = float(abs(np.linalg.det(view.affine(layer)[:3, :3])) ** (1 / 3))
    radius = np.broadcast_to(np.asarray(layer.size, dtype=float).reshape(len(layer.data), -1).mean(axis=1), len(layer.data)) / 2 * scale
    return halflight.Mesh(spheres=np.column_stack([view.xyz(layer, np.asarray(layer.data)), radius])[seen],
                          sphere_colors=_srgb8(layer.face_color)[seen], color=1, opacity=float(layer.opacity), name=layer.name)


def _outline(kind: str, corners: np.ndarray) -> np.ndarray:
    """A shape's border, closed unless it is a line."""
    if kind == "ellipse":
        angle = np.linspace(0, 2 * np.pi, 65)[:, None]
        middle, right, up = corners.mean(axis=0), (corners[1] - corners[0]) / 2, (corners[3] - corners[0]) / 2
        return middle + np.cos(angle) * right + np.sin(angle) * up
    return corners if kind in ("line", "path") else np.vstack([corners, corners[:1]])


def _shapes(view: _View, layer: Any) -> list[halflight.Mesh]:
    scale = float(abs(np.linalg.det(view.affine(layer)[:3, :3])) ** (1 / 3))
    lines, colors, meshes = [], [], []
    for corners, kind, width, edge, face in zip(layer.data, layer.shape_type, layer.edge_width, layer.edge_color, layer.face_color, strict=True):
        border = _outline(str(kind), np.asarray(corners, dtype=float))
        if not view.is_here(layer, border).all():
            continue
        places = view.xyz(layer, border)
        if edge[3] > 0 and width > 0:
            lines.append(np.column_stack([places, np.full(len(places), width / 2 * scale)]))
            colors.append(np.repeat(_srgb8(edge)[None], len(places), axis=0))
        if face[3] > 0 and kind not in ("line", "path"):
            fan = [(0, n, n + 1) for n in range(1, len(places) - 2)]
            meshes.append(halflight.Mesh(places[:-1], fan, color=halflight.srgb(*map(float, face[:3])), opacity=float(face[3] * layer.opacity),
                                         smooth=False, name=layer.name))
    if lines:
        meshes.append(halflight.Mesh(lines=lines, line_colors=np.vstack(colors), color=1, opacity=float(layer.opacity), name=layer.name))
    return meshes


def _tracks(view: _View, layer: Any) -> halflight.Mesh | None:
    data, colors = np.asarray(layer.data), _srgb8(layer.track_colors)
    now = view.position(layer)[0] if 0 not in view.axes(layer) else np.inf
    near = (data[:, 1] <= now + layer.head_length) & (data[:, 1] >= now - layer.tail_length) if np.isfinite(now) else np.ones(len(data), bool)
    voxel = float(abs(np.linalg.det(view.affine(layer)[:3, :3])) ** (1 / 3))
    lines, shown = [], []
    for track in np.unique(data[:, 0]):
        seen = near & (data[:, 0] == track)
        if seen.sum() >= 2:
            places = view.xyz(layer, data[seen, 1:])
            lines.append(np.column_stack([places, np.full(len(places), layer.tail_width / 4 * voxel)]))
            shown.append(colors[seen])
    return halflight.Mesh(lines=lines, line_colors=np.vstack(shown), color=1, opacity=float(layer.opacity), name=layer.name) if lines else None


def _vectors(view: _View, layer: Any) -> halflight.Mesh | None:
    data = np.asarray(layer.data, dtype=float)
    seen = view.is_here(layer, data[:, 0])
    if not seen.any():
        return None
    starts, ends = view.xyz(layer, data[seen, 0]), view.xyz(layer, data[seen, 0] + layer.length * data[seen, 1])
    radius = float(layer.edge_width) / 2 * float(abs(np.linalg.det(view.affine(layer)[:3, :3])) ** (1 / 3))
    colors = np.repeat(_srgb8(np.broadcast_to(layer.edge_color, (len(data), 4)))[seen], 2, axis=0)
    return halflight.Mesh(lines=list(np.stack([starts, ends], axis=1)), line_colors=colors, radius=radius, color=1, opacity=float(layer.opacity),
                          name=layer.name)


def _canvas_size(viewer: Any) -> tuple[int, int]:
    """Width and height of the viewer's canvas."""
    if hasattr(viewer, "canvas"):
        height, width = viewer.canvas.size
    else:  # napari before 0.7
        height, width = getattr(viewer, "_canvas_size", None) or (600, 800)
    return max(int(width), 1), max(int(height), 1)


def _camera(view: _View, canvas_height: float) -> Any:
    viewer = view.viewer
    if viewer.dims.ndisplay != 3:
        return "iso"
    camera = halflight.Camera.from_napari(viewer.camera, canvas_height)
    if not view.mirrored:
        return camera
    turned = {word: (x, y, -z) for word in ("position", "target", "up") for x, y, z in (getattr(camera, word),)}
    return halflight.Camera(**turned, fovy_deg=camera.fovy_deg, height=camera.height)


def scene_of(viewer: Any, *, size: Any = None, look: str = "layers", light: tuple[float, float] = (-40.0, 45.0), softness: float = 7.0,
             **settings: Any) -> halflight.Scene:
    """The scene that a napari viewer shows: its visible layers, sliders and camera.

    Parameters
    ----------
    viewer : napari.Viewer
    size : (width, height), optional
        Pixels; by default the canvas's.
    look : str
        "layers": images by their colormaps and contrast limits; or a look of Halflight's ("surface", "translucent", "xray",
        "smoke", "vessels") in the layers' colours.
    light : (azimuth, elevation)
        Degrees from the line of sight: (0, 0) is a headlight.
    softness : float
        The light's angular diameter in degrees; 0: hard shadows.
    **settings
        Keywords of `halflight.Scene`.
    """
    view = _View(viewer)
    canvas = _canvas_size(viewer)
    volumes: list[Any] = []
    meshes: list[Any] = []
    for layer in viewer.layers:
        if not layer.visible or layer.metadata.get("halflight"):
            continue
        kind = next((base.__name__ for base in type(layer).__mro__ if base.__name__ in (
            "Image", "Labels", "Surface", "Points", "Shapes", "Tracks", "Vectors")), "")
        if kind == "Image":
            volumes.append(_image(view, layer, look))
        elif kind == "Labels":
            volumes.append(_labels(view, layer))
        elif kind == "Shapes":
            meshes += _shapes(view, layer)
        elif kind:
            made = {"Surface": _surface, "Points": _points, "Tracks": _tracks, "Vectors": _vectors}[kind](view, layer)
            meshes.append(made)
    volumes, meshes = [one for one in volumes if one is not None], [one for one in meshes if one is not None]
    if not volumes and not meshes:
        raise ValueError("no visible layer has anything to show")
    words: dict[str, Any] = {
        "size": size if size is not None else canvas, "camera": _camera(view, canvas[1]), "background": "black",
        "lights": [halflight.Directional.beside_camera(*light, angular_diameter_deg=softness, intensity=1.5)], "ambient": 0.35, "sky": 0.0,
        "shadows": "soft" if softness > 0 else "hard"}
    if look == "mip" or look == "layers" and settings.get("compositing") == "maximum":
        words["compositing"] = "maximum"
    return halflight.Scene([*volumes, *meshes], **{**words, **settings})


def render(viewer: Any, **settings: Any) -> halflight.Image:
    """The picture of a napari viewer: see `scene_of`."""
    return halflight.Renderer().render(scene_of(viewer, **settings))


def render_animation(animation: Any, folder: Any, **settings: Any) -> list[str]:
    """The frames of a napari-animation ``Animation`` as numbered pictures in a folder: see `scene_of`."""
    import pathlib

    place = pathlib.Path(folder)
    place.mkdir(parents=True, exist_ok=True)
    paths = []
    with halflight.Renderer() as renderer:
        for number, state in enumerate(animation._frames):
            state.apply(animation.viewer)
            paths.append(str(place / f"frame{number:04d}.png"))
            renderer.render(scene_of(animation.viewer, **settings)).save(paths[-1])
    return paths
