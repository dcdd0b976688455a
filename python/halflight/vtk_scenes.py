"""Makes scenes of the things that a renderer of VTK shows: PyVista's plotters, ParaView's views, Slicer's 3D views.

VTK is asked for the look of its actors and volumes, and draws nothing. The data are taken from the places in which the
host keeps them: data after the mapper's pipeline, colours as the mapper makes them, matrices, properties, lights and
the camera.
"""
from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from . import colors, grids, vtk_grids
from ._library import warn
from .camera import Camera
from .lights import Directional, Light, Point, Spot
from .mesh import Mesh
from .scene import Scene
from .transfer import TransferFunction
from .volume import Volume

if TYPE_CHECKING:
    from .image import Image

__all__ = ["from_pyvista", "from_vtk", "render_pyvista"]

Shading = Literal["light", "display"]
_COLORS = "halflight colours"  # the array that carries a mapper's colours through filters
_SUN = 7.0  # degrees: the angular diameter of a light that casts soft shadows


def _matrix(matrix: Any) -> np.ndarray[Any, np.dtype[np.float64]]:
    return np.array([[matrix.GetElement(row, column) for column in range(4)] for row in range(4)])


def _parts(renderer: Any) -> Iterator[tuple[Any, np.ndarray[Any, Any]]]:
    """The visible actors and volumes with their places in the world, including the parts of assemblies."""
    for n in range(renderer.GetViewProps().GetNumberOfItems()):
        prop = renderer.GetViewProps().GetItemAsObject(n)
        if not prop.GetVisibility():
            continue
        prop.InitPathTraversal()
        while (path := prop.GetNextPath()) is not None:
            node = path.GetLastNode()
            part = node.GetViewProp()
            if part.IsA("vtkProp3D") and part.GetVisibility() and hasattr(part, "GetMapper"):
                matrix = node.GetMatrix() if node.GetMatrix() is not None else part.GetMatrix()
                yield part, _matrix(matrix)


class _Taken:
    """The parts of a scene that are collected from one renderer."""

    def __init__(self, renderer: Any, size: tuple[int, int], display: bool) -> None:
        self.renderer, self.size, self.display = renderer, size, display
        self.camera = Camera.from_vtk(renderer.GetActiveCamera(), size[0] / size[1])
        self.meshes: list[Mesh] = []
        self.volumes: list[Volume] = []
        self.maximum = self.nearest = False

    def color(self, shown: Any) -> Any:
        """A colour of VTK in the numbers of this scene: linear light, or VTK's own numbers if VTK's shading is asked
        for.
        """
        values = np.asarray(shown, dtype=np.float64)
        return values if self.display else colors.to_linear(np.clip(values, 0, 1))

    def pixels_at(self, places: np.ndarray[Any, Any]) -> np.ndarray[Any, Any]:
        """The world lengths of a pixel beside points, [n][3]."""
        if self.camera.height is not None:
            return np.full(len(places), self.camera.height / self.size[1])
        eye, target = np.asarray(self.camera.position), np.asarray(self.camera.target)
        distance = float(np.linalg.norm(target - eye))
        depths = np.maximum((places - eye) @ ((target - eye) / distance), 1e-3 * distance)
        lengths: np.ndarray[Any, Any] = 2 * depths * math.tan(math.radians(self.camera.fovy_deg) / 2) / self.size[1]
        return lengths


_UNLIT = {"ambient": 0.0, "diffuse": 0.0, "specular": 0.0, "emission": 1.0}


def _material(prop: Any) -> dict[str, float]:
    if hasattr(prop, "GetLighting") and not prop.GetLighting():
        return dict(_UNLIT)
    return {"ambient": prop.GetAmbient(), "diffuse": prop.GetDiffuse(), "specular": prop.GetSpecular(),
            "shininess": max(prop.GetSpecularPower(), 0.0)}


# ---- actors


def _mapped_colors(mapper: Any, data: Any) -> tuple[Any, bool] | None:
    """The RGBA colours that a mapper gives to its data, and whether they belong to cells; None if the mapper has a
    single colour.
    """
    from vtkmodules.util.numpy_support import vtk_to_numpy

    if not mapper.GetScalarVisibility():
        return None
    textured = mapper.GetInterpolateScalarsBeforeMapping()
    # With True, the colours would be a texture, which other renderers cannot read.
    mapper.SetInterpolateScalarsBeforeMapping(False)
    try:
        mapped = mapper.MapScalars(data, 1.0)
    finally:
        mapper.SetInterpolateScalarsBeforeMapping(textured)
    if mapped is None or mapped.GetNumberOfTuples() == 0:
        return None
    rows, points, cells = mapped.GetNumberOfTuples(), data.GetNumberOfPoints(), data.GetNumberOfCells()
    asked = mapper.GetScalarMode()  # 0 is the default, 1 and 3 stand for points, 2 and 4 for cells
    of_cells = asked in (2, 4) or asked == 0 and data.GetPointData().GetScalars() is None
    if rows not in (points, cells):
        return None
    of_cells = of_cells if points == cells else rows == cells
    return np.array(vtk_to_numpy(mapped)), of_cells


def _clipped(data: Any, mapper: Any, matrix: np.ndarray[Any, Any]) -> Any:
    """The data without the parts that the mapper's clipping planes cut off. The planes are in the world."""
    planes = mapper.GetClippingPlanes()
    if planes is None or planes.GetNumberOfItems() == 0:
        return data
    from vtkmodules.vtkCommonDataModel import vtkPlane
    from vtkmodules.vtkFiltersCore import vtkClipPolyData

    inverse = np.linalg.inv(matrix)
    for n in range(planes.GetNumberOfItems()):
        world = planes.GetItem(n)
        plane = vtkPlane()
        plane.SetOrigin((inverse @ [*world.GetOrigin(), 1])[:3])
        plane.SetNormal(matrix[:3, :3].T @ world.GetNormal())
        clip = vtkClipPolyData()
        clip.SetInputData(data)
        clip.SetClipFunction(plane)
        clip.Update()
        data = clip.GetOutput()
    return data


def _edges_filter() -> Any:
    try:
        from vtkmodules.vtkFiltersCore import vtkExtractEdges
    except ImportError:  # versions of VTK before 9.2 have the class in another module
        from vtkmodules.vtkFiltersExtraction import vtkExtractEdges
    return vtkExtractEdges()


def _surface(data: Any, mapped: tuple[Any, bool] | None, wireframe: bool, points_alone: bool) -> Any:
    """A vtkPolyData of the parts of its data that the actor draws, with their colours."""
    from vtkmodules.util.numpy_support import numpy_to_vtk
    from vtkmodules.vtkFiltersGeneral import vtkVertexGlyphFilter
    from vtkmodules.vtkFiltersGeometry import vtkGeometryFilter

    carried = data.NewInstance()
    carried.ShallowCopy(data)
    if mapped is not None:
        array = numpy_to_vtk(mapped[0], deep=True)
        array.SetName(_COLORS)
        (carried.GetCellData() if mapped[1] else carried.GetPointData()).AddArray(array)
    filters: list[Any] = [] if hasattr(carried, "GetPolys") else [vtkGeometryFilter()]
    if points_alone:
        filters.append(vtkVertexGlyphFilter())
    elif wireframe:
        filters.append(_edges_filter())
    for one in filters:
        one.SetInputData(carried)
        one.Update()
        carried = one.GetOutput()
    return carried


def _put_radii(taken: _Taken, surface: Any, prop: Any, matrix: np.ndarray[Any, Any]) -> None:
    """Set the radii of points and lines so that they are as wide in the picture as VTK draws them, in pixels. The
    radius at each point depends on the point's distance from the eye.
    """
    from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy

    places = vtk_to_numpy(surface.GetPoints().GetData()) @ matrix[:3, :3].T + matrix[:3, 3]
    width = prop.GetPointSize() if surface.GetNumberOfVerts() else prop.GetLineWidth()
    scale = abs(np.linalg.det(matrix[:3, :3])) ** (1 / 3)
    array = numpy_to_vtk(max(width, 1) / 2 * taken.pixels_at(places) / scale, deep=True)
    array.SetName("radius")
    surface.GetPointData().AddArray(array)


def _take_actor(taken: _Taken, actor: Any, matrix: np.ndarray[Any, Any]) -> None:
    mapper = actor.GetMapper()
    if mapper is None:
        return
    mapper.Update()
    data = mapper.GetInputDataObject(0, 0)
    if hasattr(mapper, "GetSourceIndexing") and hasattr(mapper, "GetScaleFactor"):
        warn("glyphs are left out: show the output of a glyph filter")
    elif hasattr(data, "NewIterator"):
        blocks = getattr(mapper, "GetCompositeDataDisplayAttributes", lambda: None)()
        for leaf in _leaves(data):
            if blocks is None or not blocks.HasBlockVisibility(leaf) or blocks.GetBlockVisibility(leaf):
                color = blocks.GetBlockColor(leaf) if blocks is not None and blocks.HasBlockColor(leaf) else None
                _take_data(taken, actor, leaf, matrix, color)
    elif hasattr(data, "GetPointData"):
        _take_data(taken, actor, data, matrix, None)
    elif data is not None:
        warn(f"{type(mapper).__name__} of {type(data).__name__} is left out: only data sets are meshes")


def _leaves(composite: Any) -> Iterator[Any]:
    """The data sets of a composite data set."""
    iterator = composite.NewIterator()
    iterator.InitTraversal()
    while not iterator.IsDoneWithTraversal():
        if hasattr(leaf := iterator.GetCurrentDataObject(), "GetPointData"):
            yield leaf
        iterator.GoToNextItem()


def _take_data(taken: _Taken, actor: Any, data: Any, matrix: np.ndarray[Any, Any], color: Any) -> None:
    """Add a data set as the actor shows it. color: a colour that replaces the actor's."""
    if data.GetNumberOfPoints() == 0:
        return
    mapper, prop = actor.GetMapper(), actor.GetProperty()
    if actor.GetTexture() is not None or prop.GetInterpolation() == 3:
        warn("an actor's texture or physically based material is left out: it has its plain colour")
    points_alone, wireframe = prop.GetRepresentation() == 0, prop.GetRepresentation() == 1
    mapped = _mapped_colors(mapper, data) if color is None else None
    # A mesh converts bytes to linear light, and these bytes become VTK's numbers.
    if mapped is not None and taken.display:
        mapped[0][:, :3] = np.rint(255 * colors.to_srgb(mapped[0][:, :3] / 255.0))
    surface = _clipped(_surface(data, mapped, wireframe, points_alone), mapper, matrix)
    if surface.GetNumberOfCells() == 0:
        return
    if surface.GetNumberOfVerts() or surface.GetNumberOfLines():
        _put_radii(taken, surface, prop, matrix)
    look: dict[str, Any] = {**_material(prop), "opacity": prop.GetOpacity()}
    words: dict[str, Any] = {"scalars": False}
    # VTK makes a tube's normals itself. A polygon has a normal of its own if the data have no normals.
    round_tubes = surface.GetNumberOfLines() > 0 and surface.GetNumberOfPolys() == 0
    smooth = round_tubes or (prop.GetInterpolation() != 0 and surface.GetPointData().GetNormals() is not None)
    if mapped is None:
        look["color"] = taken.color(prop.GetDiffuseColor() if color is None else color).tolist()
    else:
        words["scalars"] = _COLORS
    taken.meshes.append(Mesh(surface, affine=matrix, smooth=bool(smooth), **words, **look))


# ---- volumes


def _regular(data: Any) -> Any:
    """A vtkImageData. Other grids are sampled on an image."""
    if hasattr(data, "GetSpacing") and hasattr(data, "GetOrigin"):
        return data
    from vtkmodules.vtkFiltersCore import vtkResampleToImage

    bounds = np.array(data.GetBounds()).reshape(3, 2)
    widths = np.maximum(np.ptp(bounds, axis=1), 1e-30)
    wanted = data.GetDimensions() if hasattr(data, "GetDimensions") else 3 * [max(2, round(data.GetNumberOfCells() ** (1 / 3)))]
    step = min(float((widths / np.maximum(np.array(wanted) - 1, 1)).min()), float(widths.max()) / 32)
    step = max(step, float(widths.max()) / 400)
    dimensions = [int(one) for one in np.maximum(np.ceil(widths / step).astype(int) + 1, 2)]
    warn(f"{type(data).__name__} is sampled to {dimensions[0]} x {dimensions[1]} x {dimensions[2]} voxels of {step:g}")
    sample = vtkResampleToImage()
    sample.SetInputDataObject(data)
    sample.SetUseInputBounds(True)
    sample.SetSamplingDimensions(dimensions)
    sample.Update()
    made = sample.GetOutput()
    name = data.GetPointData().GetScalars() or data.GetCellData().GetScalars()
    if name is not None:
        made.GetPointData().SetActiveScalars(name.GetName())
    return made


def _image_affine(image: Any) -> np.ndarray[Any, Any]:
    """The matrix from the indices of the active scalars to the data's own space."""
    direction = np.eye(3)
    if hasattr(image, "GetDirectionMatrix"):
        matrix = image.GetDirectionMatrix()
        direction = np.array([[matrix.GetElement(row, column) for column in range(3)] for row in range(3)])
    first = np.array(image.GetExtent()[::2], dtype=float)
    if image.GetPointData().GetScalars() is None:
        first += 0.5
    affine = np.eye(4)
    affine[:3, :3] = direction * image.GetSpacing()
    affine[:3, 3] = np.array(image.GetOrigin()) + affine[:3, :3] @ first
    return affine


def _take_volume(taken: _Taken, actor: Any, matrix: np.ndarray[Any, Any]) -> None:
    from .neighbours import find

    mapper, prop = actor.GetMapper(), actor.GetProperty()
    if mapper is None:
        return
    mapper.Update()
    mesh = vtk_grids.of_vtk(mapper.GetInputDataObject(0, 0))
    image = _regular(mapper.GetInputDataObject(0, 0)) if mesh is None else None
    function = TransferFunction.from_vtk(prop)
    if taken.display:
        function.color = function.color.copy()
        function.color[:, 1:] = colors.to_srgb(function.color[:, 1:])
    look: dict[str, Any] = {"transfer_function": function, "shading": "phong" if prop.GetShade() else "flat", **_material(prop)}
    planes = mapper.GetClippingPlanes()
    if planes is not None and planes.GetNumberOfItems():
        look["cuts"] = [{"type": "plane", "point": tuple(planes.GetItem(n).GetOrigin()), "world": True,
                         "normal": tuple(-one for one in planes.GetItem(n).GetNormal())} for n in range(planes.GetNumberOfItems())]
    if getattr(mapper, "GetCropping", lambda: 0)():
        low_high = np.array(mapper.GetCroppingRegionPlanes()).reshape(3, 2)
        if mapper.GetCroppingRegionFlags() == 0x0002000:  # the sub-volume in the middle
            look["clip"] = tuple(low_high[:, 0]), tuple(low_high[:, 1])
        else:
            warn("the volume's cropping regions are left out, but for one box")
    blend = mapper.GetBlendMode() if hasattr(mapper, "GetBlendMode") else 0
    taken.maximum |= blend == 1
    if blend not in (0, 1):
        warn("the volume's blend mode is left out: Halflight composites, or shows the maximum")
    taken.nearest |= prop.GetInterpolationType() == 0
    if mesh is not None:
        points = np.asarray(mesh[0].points, float) @ matrix[:3, :3].T + matrix[:3, 3]
        taken.volumes.append(Volume(replace(mesh[0], points=points), **look))
    else:
        taken.volumes.append(Volume(find(image).array, axes="zyx", affine=matrix @ _image_affine(image), **look))


# ---- lights, and the whole


def _lights(taken: _Taken, soft: bool) -> list[Light]:
    """The renderer's lights at their current places."""
    renderer = taken.renderer
    renderer.UpdateLightsGeometryToFollowCamera()
    found: list[Light] = []
    lights = renderer.GetLights()
    for n in range(lights.GetNumberOfItems()):
        light = lights.GetItemAsObject(n)
        if not light.GetSwitch() or light.GetIntensity() <= 0:
            continue
        position, target = np.array(light.GetTransformedPosition()), np.array(light.GetTransformedFocalPoint())
        words: dict[str, Any] = {"color": tuple(taken.color(light.GetDiffuseColor()).tolist()), "intensity": light.GetIntensity()}
        direction = tuple((target - position).tolist())
        if not light.GetPositional():
            found.append(Directional(direction=direction, angular_diameter_deg=_SUN if soft else 0.0, **words))
        elif light.GetConeAngle() < 90:
            found.append(Spot(position=tuple(position), direction=direction, opening_angle_deg=2 * light.GetConeAngle(), falloff_angle_deg=0.0, **words))
        else:
            found.append(Point(position=tuple(position), **words))
    if not found:  # when VTK draws without lights, it makes a light beside the camera
        found.append(Directional(direction=(0.0, 0.0, -1.0), frame="camera"))
    return found


def from_vtk(renderer: Any, *, size: Any = None, shading: Shading = "light", **settings: Any) -> Scene:
    """The scene that a vtkRenderer shows: volumes, meshes, lines and points, lights, camera and background.

    Parameters
    ----------
    renderer : vtkRenderer
        A renderer of PyVista (``plotter.renderer``), ParaView (``view.GetRenderer()``), Slicer, or a program of your
        own.
    size : (width, height), optional
        Pixels; by default the render window's.
    shading : "light" or "display"
        VTK shades with the numbers that screens show; Halflight with light. "display" takes VTK's numbers for light, so that
        surfaces are as bright as VTK's in a picture that is then shown as it is (`Image.as_display`).
    **settings
        Keywords of `Scene` in place of the renderer's own: `lights`, `shadows`, `camera`, `background`, `sky`, ...

    Returns
    -------
    Scene
        Lines are tubes and points spheres, as wide as they are drawn. Edges on surfaces are left out, and so are text and
        scalar bars, which ``plotter.halflight()`` of PyVista adds; rectilinear grids that are shown as volumes are sampled to voxels: a warning says to which. Unstructured and curvilinear
        grids are read by their cells (`Volume.from_cells`).
    """
    from ._settings import size_of
    from ._words import choice

    choice("shading", shading, ("light", "display"))
    window = renderer.GetRenderWindow()
    width, height = size_of("size", size if size is not None else window.GetSize() if window is not None else (512, 512))
    taken = _Taken(renderer, (width, height), shading == "display")
    take: Callable[[_Taken, Any, Any], None]
    for part, matrix in _parts(renderer):
        take = _take_volume if hasattr(part.GetMapper(), "GetCropping") or part.IsA("vtkVolume") else _take_actor
        take(taken, part, matrix)
    if not taken.meshes and not taken.volumes:
        raise ValueError("the renderer shows no volume and no mesh")
    shadows = settings.get("shadows", "off" if taken.display else "soft")
    background = renderer.GetBackground()
    if renderer.GetGradientBackground():
        warn("the background's gradient is left out: it has the lower colour")
    words: dict[str, Any] = {
        "size": (width, height), "camera": taken.camera, "lights": _lights(taken, shadows == "soft"), "sky": 0.0,
        "background": colors.to_linear(np.array(background)).tolist()}
    if taken.maximum:  # without light
        words["compositing"] = "maximum"
    else:
        words |= {"ambient": taken.color(renderer.GetAmbient()).tolist(), "shadows": shadows}
    if taken.volumes:
        words["kernel"] = "linear"  # VTK interpolates linearly, too
    return Scene([*taken.volumes, *taken.meshes], **{**words, **settings})


def _ready(plotter: Any) -> Any:
    """A plotter's renderer, with the camera that it gets when it is shown first."""
    renderer = plotter.renderer
    if not renderer.camera.is_set and getattr(plotter, "_first_time", True):
        renderer.camera_position = renderer.get_default_cam_pos()
        renderer.ResetCamera()
    return renderer


def from_pyvista(plotter: Any, *, size: Any = None, shading: Shading = "light", **settings: Any) -> Scene:
    """The scene of a PyVista plotter's active renderer: see `from_vtk`, whose keywords these are.

    Examples
    --------
    ``plotter.halflight(shadows="soft").save("picture.png")`` is the same in one call, where PyVista 0.48 or newer is installed.
    """
    if not hasattr(plotter, "renderer") or not hasattr(plotter, "window_size"):
        raise TypeError(f"from_pyvista(): {type(plotter).__name__} is no pyvista.Plotter: use from_vtk() for a vtkRenderer")
    return from_vtk(_ready(plotter), size=tuple(plotter.window_size) if size is None else size, shading=shading, **settings)


def _legends(plotter: Any, size: tuple[int, int]) -> np.ndarray[Any, Any] | None:
    """The things that the plotter draws flat over its picture, [height][width][4] in sRGB: PyVista draws it over black
    and over white.
    """
    props = plotter.renderer.GetViewProps()
    parts = [props.GetItemAsObject(n) for n in range(props.GetNumberOfItems())]
    if not any(part.IsA("vtkActor2D") and part.GetVisibility() for part in parts) or plotter.render_window is None:
        return None
    if tuple(plotter.window_size) != size:
        warn(f"scalar bars and text are left out: the picture is not as large as the window, {plotter.window_size[0]} x {plotter.window_size[1]}")
        return None
    hidden = [part for part in parts if part.IsA("vtkProp3D") and part.GetVisibility()]
    background, gradient = plotter.renderer.GetBackground(), plotter.renderer.GetGradientBackground()
    shown = []
    try:
        for part in hidden:
            part.VisibilityOff()
        plotter.renderer.SetGradientBackground(False)
        for grey in (0.0, 1.0):
            plotter.renderer.SetBackground(grey, grey, grey)
            plotter.render()
            shown.append(np.asarray(plotter.screenshot(None, return_img=True))[..., :3] / 255.0)
    finally:
        for part in hidden:
            part.VisibilityOn()
        plotter.renderer.SetBackground(background)
        plotter.renderer.SetGradientBackground(gradient)
    alpha = (1 - (shown[1] - shown[0]).mean(axis=-1, keepdims=True)).clip(0, 1)
    plain = np.divide(shown[0], alpha, out=np.zeros_like(shown[0]), where=alpha > 0.004)
    drawn: np.ndarray[Any, Any] = np.concatenate([plain.clip(0, 1), np.where(alpha > 0.004, alpha, 0)], axis=-1)
    return drawn


def render_pyvista(plotter: Any, *, shading: Shading = "light", legends: bool = True, layers: bool = False, progress: Any = None,
                   **settings: Any) -> Image:
    """The picture of a PyVista plotter, as `from_pyvista` makes the scene, under the plotter's scalar bars and text."""
    from .render import Renderer

    image = Renderer().render(from_pyvista(plotter, shading=shading, **settings), layers=layers, progress=progress)
    image = image.as_display() if shading == "display" else image
    over = _legends(plotter, image.size) if legends else None
    if over is not None:
        _lay_over(image, over)
    return image


def _lay_over(image: Image, over: np.ndarray[Any, Any]) -> None:
    """Mix sRGB colours into a picture as screens do, over its background. If the background is transparent, mix in
    linear light.
    """
    pixels, alpha, background = np.asarray(image), over[..., 3:], image.scene.background
    if isinstance(background, str):
        pixels[...] = np.concatenate([colors.to_linear(over[..., :3]), np.ones_like(alpha)], axis=-1) * alpha + (1 - alpha) * pixels
        return
    shown = colors.to_srgb(pixels[..., :3] + (1 - pixels[..., 3:]) * np.asarray(background))
    mixed = np.concatenate([colors.to_linear(over[..., :3] * alpha + (1 - alpha) * shown), np.ones_like(alpha)], axis=-1)
    pixels[...] = np.where(alpha > 0, mixed, pixels)
