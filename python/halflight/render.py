"""Renders scenes to pictures."""
from __future__ import annotations

import math
import os
import threading
from collections.abc import Mapping, Sequence
from typing import Any, Literal, Unpack

import numpy as np

from . import arrays
from ._library import call, context, ffi, lib, made, text_of
from ._settings import number, size_of
from ._words import check_keywords, suggests, suggests_also
from .camera import Camera
from .colors import is_colormap
from .image import Image, Pixels
from .keywords import FurtherSettings
from .lights import Light
from .mesh import Mesh
from .progress import Progress, told
from .scene import Scene, Settings, Side
from .transfer import TransferFunction
from .values import VALUES, function_for, range_for, range_of_slice
from .volume import Look, Picture, Source, Volume, as_volume, map_over, volume_from

__all__ = ["Renderer", "reference", "render"]


def _add_layers(image: Image) -> tuple[Any, dict[str, Pixels], list[Any]]:
    """Buffers for all layers, as ``halflight render --layers`` asks for them."""
    struct = lib.hl_scene_describe(image.scene._handle)
    layers = ffi.new("hl_layers *")
    layers.struct_size = ffi.sizeof("hl_layers")
    arrays_by_name: dict[str, Pixels] = {}
    lights = ffi.new("hl_light_layers[]", struct.light_count)

    def add(name: str, channels: str) -> Any:
        pointer, arrays_by_name[name] = image._add_layer(name, channels)
        return pointer

    layers.ambient = add("ambient", "RGB")
    volumes = [struct.volumes[n] for n in range(struct.volume_count)]
    if any(one.shading == lib.HL_SHADING_FLAT or one.material.emission > 0 for one in volumes):
        layers.emission = add("emission", "RGB")
    if struct.sky.type != lib.HL_SKY_NONE:
        layers.sky = add("sky", "RGB")
        layers.sky_shadow = add("sky_shadow", "RGB")
    for n, light in enumerate(lights):
        light.picture = add(f"light{n}", "RGB")
        light.shadow = add(f"light{n}_shadow", "RGB")
    layers.lights, layers.light_count = lights, len(lights)
    layers.depth_first = add("depth_first", "Z")
    layers.depth_mean = add("depth_mean", "Z")
    layers.normal = add("normal", "XYZ")
    layers.object = add("object", "Z")
    return layers, arrays_by_name, [lights]


def _told_statistics(struct: Any) -> dict[str, Any]:
    names = [name for name, _ in ffi.typeof("hl_render_statistics").fields if name != "struct_size"]
    found: dict[str, Any] = {}
    for name in names:
        value = getattr(struct, name)
        found[name] = text_of(value) if isinstance(value, ffi.CData) else value
    found["instruction_set"] = text_of(lib.hl_instruction_set_name(struct.instruction_set))
    return found


def _as_scene(scene: Any) -> Scene:
    if not isinstance(scene, Scene):
        raise TypeError(f"{type(scene).__name__} is no Scene: use halflight.render() for volumes")
    return scene


class Renderer:
    """Renders scenes one after the other, and keeps the prepared data of their volumes.

    A renderer serves one thread at a time, and other threads wait. To render in several threads at once, make a
    renderer for each of them. After ``fork`` the child may go on with it.

    Parameters
    ----------
    device : str, optional
        The device that makes the pictures: "cpu", the default; "gpu", the first GPU; "auto", a GPU if it is faster; or
        a part of a name that ``halflight devices`` lists. All devices make the same pictures. If a GPU cannot make a
        picture, the processors make it, and ``Image.statistics["device_reason"]`` says why.

    Examples
    --------
    >>> import numpy as np
    >>> scene, renderer = Scene(np.ones((8, 8, 8), np.uint8), size=(32, 32)), Renderer()
    >>> frames = [renderer.render(scene.replace(camera=(angle, 20))) for angle in (0, 90)]
    >>> [frame.size for frame in frames]
    [(32, 32), (32, 32)]
    """

    __slots__ = ("__weakref__", "_handle", "_lock", "_process")

    def __init__(self, device: str | None = None) -> None:
        self._handle = made(lib.hl_renderer_create, "hl_renderer", lib.hl_renderer_destroy, context)
        if device is not None:
            if not isinstance(device, str):
                raise TypeError(f"device: {device!r} is no text: give 'cpu', 'gpu', 'auto' or a part of a GPU's name")
            call(lib.hl_renderer_use_device, self._handle, ffi.new("char[]", device.encode()))
        self._lock, self._process = threading.Lock(), os.getpid()

    def close(self) -> None:
        """Release the prepared data. The renderer cannot be used afterwards. ``with Renderer() as renderer:`` does it.
        """
        with self._lock:
            if self._handle is not None:
                ffi.release(self._handle)
            self._handle = None

    def __enter__(self) -> Renderer:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    @suggests
    def render(self, scene: Scene, *, layers: bool = False, progress: Progress = None) -> Image:
        """The scene's picture.

        Parameters
        ----------
        scene : Scene
            What is rendered.
        layers : bool
            Whether to keep each light, its shadow, the sky and its shadow, ambient light, depths and normals as
            separate layers in ``Image.layers``.
        progress : bool or callable, optional
            True: a bar by tqdm, or a line on stderr. A callable gets the stage's name and a fraction, 0 to 1. If it
            raises an exception, the render stops.
        """
        if self._process != os.getpid():  # a lock that another thread held at the fork stays locked
            self._lock, self._process = threading.Lock(), os.getpid()
        image = Image(_as_scene(scene))
        scene._check_arrays()
        wanted, found, keep = _add_layers(image) if layers else (ffi.NULL, dict[str, Pixels](), [])
        statistics = ffi.new("hl_render_statistics *")
        statistics.struct_size = ffi.sizeof("hl_render_statistics")
        with self._lock, told(progress):
            if self._handle is None:
                raise ValueError("the renderer is closed: make another one")
            call(lib.hl_renderer_render_layers, self._handle, scene._handle, lib.hl_image_pixels(image._handle),
                 4 * image.size[0], wanted, statistics)
        del keep
        image._finish(found, _told_statistics(statistics))
        return image


@suggests
def reference(scene: Scene, *, light_points: int = 1024, step: float = 0.25, rays: int = 0, paths: int = 64,
              layers: bool = False, progress: Progress = None) -> Image:
    """The scene's picture by the slow ray marcher that judges the sheets.

    Parameters
    ----------
    scene : Scene
        What is rendered.
    light_points : int
        The number of points on each extended light.
    step : float
        The length of a ray's steps, in edges of the smallest voxel.
    rays : int
        The number of rays along each side of a pixel, 1 to 8; 0 for the number that the renderer averages.
    paths : int
        The number of random paths from each pixel if media scatter light more than once. They are the same at every
        call.
    layers, progress
        As for `Renderer.render`.

    Examples
    --------
    >>> import numpy as np
    >>> scene = Scene(np.ones((8, 8, 8), np.uint8), size=(16, 16), shadows="hard")
    >>> exact = np.asarray(reference(scene, light_points=16))
    >>> bool(abs(exact - Renderer().render(scene)).max() < 0.1)
    True
    """
    image = Image(_as_scene(scene))
    scene._check_arrays()
    options = ffi.new("hl_reference_options *")
    lib.hl_reference_options_defaults(options)
    options.light_points, options.step, options.rays, options.paths = light_points, step, rays, paths
    options.threads = lib.hl_scene_describe(scene._handle).render.threads
    wanted, found, keep = _add_layers(image) if layers else (ffi.NULL, dict[str, Pixels](), [])
    with told(progress):
        call(lib.hl_reference_render_layers, context, scene._handle, options, lib.hl_image_pixels(image._handle),
             4 * image.size[0], wanted)
    del keep
    image._finish(found, {})
    return image


def _look(volume: Volume, projected: bool, words: Mapping[str, Any]) -> Volume:
    """The volume with the transfer function that keywords of `Values` ask for. projected: whether the picture is a
    maximum projection.
    """
    function = function_for(volume, projected, **words)
    if function is None:
        return volume
    low, high = range_for(words.get("clim"), volume) or (0.0, 0.0)
    return volume.replace(transfer_function=function, legend_low=low, legend_high=high)


def _picture_of(place: Mapping[str, Any], settings: Mapping[str, Any], read_whole: bool) -> Picture | None:
    """The picture for which the resolution of a file is chosen, as by the program. A picture that is zoomed in reads the
    resolution of one that is not first, which then shows where the camera looks; read_whole: whether it does not.
    """
    if place.get("level") is not None:
        return None
    plain = ffi.new("hl_scene_description *")
    lib.hl_scene_description_defaults(plain)
    size, camera = settings.get("size"), settings.get("camera")
    side = max((plain.width, plain.height) if size is None else size_of("size", size))
    zoom = number("camera: zoom", camera.get("zoom") or 1) if isinstance(camera, Mapping) else 1
    once = zoom <= 1 or read_whole or any(place.get(word) is not None for word in ("spacing", "space", "smooth"))
    return Picture(min(math.ceil(side * max(zoom, 1)), 2**31 - 1), 0 if once else side)


def _nearer(scene: Scene, sources: Sequence[Any]) -> Scene:
    """The scene with volumes that are as fine as its picture shows them, where its camera sees them. sources: of these volumes."""
    struct = lib.hl_scene_describe(scene._handle)
    if not lib.hl_scene_is_coarse(struct):
        return scene
    return Scene._of(made(lib.hl_scene_read_finer, "hl_scene", lib.hl_scene_release, context, scene._handle,
                          ffi.addressof(struct, "camera"), 1, urls=[os.fspath(one) for one in sources if isinstance(one, (str, os.PathLike))]))


def _read(source: Any, place: Mapping[str, Any], is_slice: bool, picture: Picture | None) -> Volume:
    """The volume of a source. A slice shows the voxels as they are; a Volume keeps what it has."""
    words: dict[str, Any] = dict(place)
    if isinstance(source, (str, os.PathLike)):
        words["_picture"] = picture
    if is_slice and not isinstance(source, Volume):
        words.setdefault("smooth", 0.0)
    return Volume(source, **words)


def _layers(look: Mapping[str, Any], count: int, beside: int) -> str | None:
    """The value of the library's option "colormap" by which the volumes of a slice lie over each other: it says which volumes
    have a colormap. None if only the first volume has one. count: the number of volumes with the keywords of `Values`;
    beside: the number of further volumes.
    """
    named = ["viridis" if is_colormap(_look_for(look, n, count).get("cmap")) else "" for n in range(count)]
    return ",".join(named + [""] * beside) if any(named[1:]) else None


def _laid_over(volume: Volume, composed: TransferFunction) -> Volume:
    """A layer of a slice with its opacity from the least value of its colours on. composed: the layer's function before its
    colours were changed.
    """
    function = volume.look["transfer_function"]
    low = float(function.color[0][0])
    opacity = [(np.nextafter(low, -np.inf), 0.0), (low, float(composed.opacity[-1][1]))]
    return volume.replace(transfer_function=TransferFunction(opacity, function.color, composed.unit_distance))


def _sliced(scene: Scene, count: int, look: Mapping[str, Any]) -> Scene:
    """The scene of a slice, of whose volumes the first `count` have the functions that keywords of `Values` ask for."""
    if not look:
        return scene
    volumes = [volume_from(scene._handle, n) for n in range(len(scene.volumes))]
    for n in range(count):
        words = _look_for(look, n, count)
        if words.get("cmap") is not None and words.get("tf") is None and not words.get("log_scale"):
            words["clim"] = words.get("clim") or range_of_slice(volumes[n])
        composed: TransferFunction = volumes[n].look["transfer_function"]
        stated = _look_for(look, n, count).get("clim") is not None
        volumes[n] = _look(volumes[n], True, words)
        if not stated:
            volumes[n] = volumes[n].replace(legend_low=0.0, legend_high=0.0)
        if composed.opacity[0][1] == 0 and words.get("opacity") is None and words.get("tf") is None:
            volumes[n] = _laid_over(volumes[n], composed)
    return scene.replace(volumes)


def _refuse_beside_slice(material: Mapping[str, Any]) -> None:
    for word in ("look", "iso"):
        if material.get(word) is not None:
            raise ValueError(f"slice and {word} exclude each other: give one of them")


def _given(**words: Any) -> dict[str, Any]:
    return {word: value for word, value in words.items() if value is not None}


Words = Literal["off", "hard", "soft"]
Shade = Literal["phong", "none", "flat"]
Looked = Literal["auto", "surface", "translucent", "xray", "smoke", "vessels", "mip"]
View = Camera | Side | str | Sequence[float] | Sequence[Sequence[float]] | Mapping[str, Any]


class Asked(FurtherSettings, total=False):
    """The keywords of `render` that say what is seen."""

    spacing: arrays.Spacing
    origin: Any
    direction: Any
    affine: Any
    space: str
    axes: str
    cmap: Any
    clim: Sequence[float | str]
    log_scale: bool
    opacity: Any
    opacity_unit_distance: float
    shade: bool | Shade
    ambient: float
    diffuse: float
    specular: float
    shininess: float
    tf: Any
    shadows: bool | Words
    lights: Light | Sequence[Light]
    camera: View
    size: tuple[int, int] | int | str
    background: Any
    threads: int
    array: str
    component: int | str
    series: str
    time: int
    channel: int | str | Sequence[int | str]
    level: int
    smooth: float
    meshes: Mesh | Sequence[Mesh]
    iso: Any
    cuts: Any
    mask: Any
    labels: Any
    look: Looked
    sky: Any
    slice: str
    density: float
    color_by: str
    color_by_threshold: float | Sequence[float]


_PLACE = ("spacing", "origin", "direction", "affine", "space", "axes", "array", "component", "series", "time", "channel", "level", "smooth")
_MATERIAL = ("ambient", "diffuse", "specular", "shininess", "iso", "cuts", "mask", "look",
             *(word for word in FurtherSettings.__annotations__ if word in Look.__annotations__))
_SETTINGS = ("shadows", "lights", "camera", "size", "background", "threads", "meshes", "sky", "slice", "density", "color_by", "color_by_threshold",
             *(word for word in FurtherSettings.__annotations__ if word in Settings.__annotations__))


def scene_for(volume: Source, **asked: Unpack[Asked]) -> Scene:
    """The scene that `render` renders."""
    check_keywords("halflight", asked, Asked.__annotations__)
    words: dict[str, Any] = {**asked}
    place, material, settings = ({word: words[word] for word in group if word in words}
                                 for group in (_PLACE, _MATERIAL, _SETTINGS))
    if (shade := words.get("shade")) is not None:
        material["shading"] = ("phong" if shade else "flat") if isinstance(shade, (bool, np.bool_)) else shade
    if isinstance(settings.get("shadows"), (bool, np.bool_)):
        settings["shadows"] = "soft" if settings["shadows"] else "off"
    look = {word: words[word] for word in VALUES if word in words}
    return _scene_of(volume, place, material, settings, look, words.get("labels"))


def _is_scene(volume: Any) -> bool:
    return isinstance(volume, (str, os.PathLike)) and os.fspath(volume).lower().endswith(".json")


@suggests_also(FurtherSettings.__annotations__)
def render(volume: Source = None, *, spacing: arrays.Spacing | None = None, origin: Any = None, direction: Any = None,
           affine: Any = None, space: str | None = None, axes: str | None = None, cmap: Any = None,
           clim: Sequence[float | str] | None = None, log_scale: bool | None = None, opacity: Any = None,
           opacity_unit_distance: float | None = None, shade: bool | Shade | None = None,
           ambient: float | None = None, diffuse: float | None = None, specular: float | None = None,
           shininess: float | None = None, tf: Any = None, shadows: bool | Words | None = None,
           lights: Light | Sequence[Light] | None = None, camera: View | None = None,
           size: tuple[int, int] | int | str | None = None, background: Any = None, threads: int | None = None,
           layers: bool = False, progress: Progress = None, device: str | None = None, array: str | None = None,
           component: int | str | None = None, series: str | None = None, time: int | None = None,
           channel: int | str | Sequence[int | str] | None = None, level: int | None = None, smooth: float | None = None,
           meshes: Mesh | Sequence[Mesh] | None = None, iso: Any = None, cuts: Any = None, mask: Any = None,
           labels: Any = None, look: Looked | None = None, sky: Any = None, slice: str | None = None,
           density: float | None = None, color_by: str | None = None, color_by_threshold: float | Sequence[float] | None = None,
           **further: Unpack[FurtherSettings]) -> Image:
    """A picture of a volume, in one call.

    An array's axes, and `spacing`, are in the order ``axes="zyx"``: ``array[z][y][x]``, spacing ``(dz, dy, dx)``.
    Keywords that are not given are chosen from the data, as ``halflight render`` does. The picture of a file has the
    same bytes as the program's picture.

    Parameters
    ----------
    volume : path, array, Volume, Mesh, an object that has an array, or a list of them
        A volume file, a scene file (.json), or what `Volume` takes. Of several volumes, such as the channels of a
        microscope, `cmap`, `clim`, `log_scale`, `opacity`, `opacity_unit_distance` and `tf` may be lists with one for
        each. None: the `meshes` alone.
    spacing, origin, direction, affine, space, axes : optional
        The place of an array in the world, and the directions of the world in a body: see `Volume`.
    cmap : str, matplotlib colormap, colour or colours, optional
        Halflight's colormaps, matplotlib's, or one colour; over `clim`, by default over the values that are seen.
    clim : (low, high), optional
        The data values that colours and, unless `opacity` has values of its own, opacities spread over; texts
        such as "1%" and "99.5%" are percentiles of the data. With a `cmap`, values that are clear without `clim`
        stay clear.
    log_scale : bool, optional
        Spread colours and opacities evenly over the logarithms of the values; `clim` must be above 0.
    opacity : float, str or sequence, optional
        A number for all values; "linear", "sigmoid" or "geom" over `clim`; numbers spread evenly over `clim`; or
        pairs (value, opacity). Per `opacity_unit_distance`.
    opacity_unit_distance : float, optional
        World units; by default the smallest voxel edge where `opacity` is given.
    shade : bool or str, optional
        True or "phong": surfaces; False or "flat": the colours themselves, without light; "none": a medium, lit
        and shadowed, without surfaces.
    ambient, diffuse, specular, shininess : float, optional
        The material: ka, kd, ks and n.
    tf : str, path or TransferFunction, optional
        A preset (`presets`), or a file: Halflight's, ParaView's or Slicer's.
    shadows : bool or str, optional
        "off", "hard" or "soft"; True is "soft".
    lights : a light or a list of them, optional
        See `halflight.lights`.
    camera : Camera, str, (azimuth, elevation), a mapping or (position, focal point, up), optional
        A side ("front", "left", "top", "iso", "xy", ...) and angles in degrees frame the volume. So does a mapping of the
        program's options, such as ``{"view": "front", "up": "+z", "ortho": True, "zoom": 1.2}``: see `Settings`.
    size : (width, height), int or "640x480", optional
        Pixels; default (512, 512).
    background : colour or "transparent", optional
        Names and "#rrggbb" are sRGB, numbers linear.
    threads : int, optional
        0, the default, is one per processor. The picture is the same with any number.
    layers, progress : optional
        As for `Renderer.render`.
    device : str, optional
        As for `Renderer`.
    array, component, series, time, channel, level : optional
        Of a file with several: see `Volume`. A channel is a number or its name in the file. Several
        channels, ``channel=[0, "GFP"]`` or ``channel="all"``, share the picture, each in a colour of its own: see
        `Scene.of_channels`.
    smooth : float, optional
        Smooth the voxels by a Gaussian of so many voxels: see `Volume`.
    meshes : Mesh or a list of them, optional
        Triangles among the volumes.
    iso : a value, (value, color, opacity), or a list of them, optional
        Surfaces on which the volume has one value, in place of what an automatic transfer function shows.
    cuts : a mapping or a list of them, optional
        What is cut out of the volume: {"type": "plane", "point": (x, y, z), "normal": (x, y, z)} and others, see `Look`.
    mask : a label map, or a mapping, optional
        Where the volume shows, and in which colours: see `halflight.volume.Look`.
    labels : True, label map or mapping, optional
        True, a label or a list of labels: the volume is a label map, and they show as smooth surfaces. A label map (array,
        path, Volume), or {"volume": map, "show": ..., "table": ...}: its labels show beside the volume. A map of as many
        voxels whose source does not tell its place has the volume's place. See `halflight.volume.Look`.
    look : str, optional
        "surface", "translucent", "xray", "smoke", "vessels" or "mip", a maximum projection, in place of the automatic look.
    sky : float, colour or mapping, optional
        Light from all directions in place of the automatic one, 0 for none: see `Settings`.
    slice : str, optional
        A slice across x, y or z, as in radiology: "z=0.5" is a fraction, "z=40mm" a place in the world, in the file's own
        unit "z=40u". Its values are grey, or as `cmap` and `clim` say; labels of `labels` or `mask` lie over them. Where a volume
        after the first one has a colormap, each volume lies over those before it, from the low end of its `clim` on.
    density : float, optional
        All matter is so many times as dense: 3 makes smoke and glass thicker, 0.3 thinner.
    color_by, color_by_threshold : str; float or (float, float), optional
        The colours of another volume's values at the same place, ``FILE[:ARRAY][:MAP[:LO,HI]]``, as "zmap.nii.gz:hot:0,7". Matter
        keeps its own colour where the other values are below the threshold, or between two numbers.
    **further : FurtherSettings
        What `Volume` and `Scene` take besides: `exposure`, `soft_method`, `anisotropy`, ...

    Returns
    -------
    Image

    Examples
    --------
    >>> import numpy as np
    >>> z, y, x = np.mgrid[-1:1:24j, -1:1:24j, -1:1:24j]
    >>> image = render(np.exp(-4 * (x**2 + y**2 + z**2)), cmap="inferno", size=(64, 48))
    >>> image.size
    (64, 48)
    """
    asked: Asked = _given(  # type: ignore[assignment]
        spacing=spacing, origin=origin, direction=direction, affine=affine, space=space, axes=axes, cmap=cmap, clim=clim,
        log_scale=log_scale, opacity=opacity, opacity_unit_distance=opacity_unit_distance, shade=shade, ambient=ambient, diffuse=diffuse,
        specular=specular, shininess=shininess, tf=tf, shadows=shadows, lights=lights, camera=camera, size=size,
        background=background, threads=threads, array=array, component=component, series=series, time=time,
        channel=channel, level=level, smooth=smooth, meshes=meshes, iso=iso, cuts=cuts, mask=mask, labels=labels, look=look, sky=sky,
        slice=slice, density=density, color_by=color_by,
        color_by_threshold=color_by_threshold, **further)
    with told(progress):
        scene = scene_for(volume, **asked)
    return Renderer(device).render(scene, layers=layers, progress=progress)


def _look_for(look: Mapping[str, Any], index: int, count: int) -> dict[str, Any]:
    """The keywords of one of several volumes: lists have one for each."""
    found = dict(look)
    for word, value in look.items():
        if count > 1 and isinstance(value, list):
            if len(value) != count:
                raise ValueError(f"{word}: a list of {len(value)} for {count} volumes: give one for each, or one for all")
            found[word] = value[index]
    return found


def _label_volume(labels: Any, volumes: Sequence[Volume]) -> Volume:
    """The label map that the keyword `labels` shows beside volumes. Its place follows the first one."""
    parts = dict(labels) if isinstance(labels, Mapping) else {"volume": labels}
    source = parts.pop("volume")
    found = map_over(source, volumes[0]) if volumes else as_volume(source)
    return found.replace(labels=parts or True)


def _shows_itself(labels: Any) -> bool:
    """Whether the volume itself is the label map, because no other label map is named."""
    if isinstance(labels, Mapping):
        return "volume" not in labels
    plain = isinstance(labels, (bool, int, float)) or isinstance(labels, str) and not os.path.exists(labels)
    return plain or isinstance(labels, (list, tuple, set)) and all(isinstance(one, (str, int, float)) for one in labels)


def _scene_of(volume: Any, place: Mapping[str, Any], material: dict[str, Any], settings: dict[str, Any],
              look: Mapping[str, Any], labels: Any) -> Scene:
    if labels is not None and _shows_itself(labels):
        material["labels"], labels = labels, None
    is_slice = settings.get("slice") is not None
    if is_slice:
        _refuse_beside_slice(material)
    at_once = {} if is_slice else look  # the functions of a slice are changed when the scene is sliced
    named = {word: material[word] for word in ("look",) if word in material}
    if isinstance(volume, Scene) or _is_scene(volume):
        for word in place:
            raise TypeError(f"{word} is for volumes: a scene says where its volumes are")
        scene = volume if isinstance(volume, Scene) else Scene.load(volume)
        count = len(scene.volumes)
        if "look" in named:
            settings.setdefault("compositing", "maximum" if named["look"] == "mip" else "light")
        projected = settings.get("compositing", scene.settings["compositing"]) == "maximum"
        changed = [_look(one.replace(**named), projected, _look_for(at_once, n, count)).replace(**material) for n, one in enumerate(scene.volumes)]
        shown = changed if labels is None else [*changed, _label_volume(labels, changed)]
        layers = _layers(look, count, len(shown) - count) if is_slice else None
        made = scene.replace(shown, **settings) if layers is None else scene._changed(shown, {**settings, "_layers": layers}, False)
        return _sliced(made, count, look) if is_slice else made
    picture = _picture_of(place, settings, is_slice or labels is not None or any(material.get(word) is not None for word in ("labels", "mask")))
    channels = place.get("channel")
    if channels == "all" or isinstance(channels, Sequence) and not isinstance(channels, str):
        return _nearer(_scene_of_channels(volume, channels, place, material, settings, look, labels, picture), [volume])
    given = volume if isinstance(volume, list) else [volume] if volume is not None or not settings.get("meshes") else []
    sources = [one for one in given if not isinstance(one, Mesh)]
    projected = named.get("look") == "mip"
    volumes = [_look(_read(one, place, is_slice, picture).replace(**named), projected, _look_for(at_once, n, len(sources))).replace(**material)
               for n, one in enumerate(sources)]
    if not volumes:
        for word in (*place, *look, *material):
            raise TypeError(f"{word} is for volumes: the picture has none")
    others = [one for one in given if isinstance(one, Mesh)] + ([] if labels is None else [_label_volume(labels, volumes)])
    whole = Scene([*volumes, *others], _layers=_layers(look, len(sources), 0 if labels is None else 1) if is_slice else None, **settings)
    return _sliced(whole, len(sources), look) if is_slice else _nearer(whole, sources)


def _scene_of_channels(path: Any, channels: str | Sequence[int | str], place: Mapping[str, Any], material: Mapping[str, Any],
                       settings: dict[str, Any], look: Mapping[str, Any], labels: Any, picture: Picture | None) -> Scene:
    if not isinstance(path, (str, os.PathLike)):
        raise TypeError("channel is for files that hold several: choose by an index")
    for word in place:
        if word in ("origin", "direction", "affine", "axes", "component"):
            raise TypeError(f"{word} is not for several channels of a file")
    is_slice = settings.get("slice") is not None
    reading = {word: value for word, value in place.items() if word != "channel"}
    if is_slice:
        reading.setdefault("smooth", 0.0)
    scene = Scene._of_channels(path, channels, picture, look=material.get("look", "auto"), background=settings.get("background"), **reading)
    shown = {word: value for word, value in material.items() if word != "look"}
    count = len(scene.volumes)
    projected = material.get("look") == "mip"
    volumes = [_look(one, projected, {} if is_slice else _look_for(look, n, count)).replace(**shown) for n, one in enumerate(scene.volumes)]
    chosen = [*(look.get(word) for word in ("clim", "opacity", "opacity_unit_distance", "tf")), shown.get("iso")]
    is_own = material.get("look", "auto") != "auto" or any(one is not None for one in chosen)
    layers = _layers(look, count, 0 if labels is None else 1) if is_slice else None
    made = scene._changed(volumes if labels is None else [*volumes, _label_volume(labels, volumes)], {**settings, "_layers": layers}, True,
                          lib.HL_COMPOSE_FUNCTIONS if is_own else 0)
    return _sliced(made, count, look) if is_slice else made
