"""Builds scenes out of volumes, meshes, lights and settings. The library decides what the settings mean (hl_scene_compose)."""
from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy

from . import _settings, colors, cuts, transfer
from . import marks as scene_marks
from ._library import call, composed, context, ffi, lib, made
from ._words import check_keywords, choice
from .camera import Camera, view_options
from .keywords import SkySettings
from .lights import Light
from .mesh import Mesh
from .volume import Volume

SIDES = ("automatic", "front", "back", "left", "right", "top", "bottom", "iso")
LIGHT_RIGS = ("studio", "raking", "rim", "overcast")
_RENDER = _settings.names(lib.HL_SETTINGS_RENDER)
_IMAGE = _settings.names(lib.HL_SETTINGS_IMAGE, "width", "height", "background", "background_transparent",
                        "background_sky")
_TOP = _settings.names(lib.HL_SETTINGS_SCENE, "ambient")


def _set_lights(struct: Any, lights: Any, keep: list[Any]) -> None:
    given = [lights] if isinstance(lights, Light) else list(lights)
    array = ffi.new("hl_light[]", len(given))
    for n, light in enumerate(given):
        if not isinstance(light, Light):
            raise TypeError(f"lights[{n}]: {light!r} is no light: use Directional, Point, Spot, Rect, Disk or Polygon")
        light._fill(array[n], keep, f"lights[{n}]: ")
    keep.append(array)
    struct.lights, struct.light_count = array, len(array)


def _set_meshes(struct: Any, meshes: Mesh | Sequence[Mesh], keep: list[Any]) -> None:
    given = [meshes] if isinstance(meshes, Mesh) else list(meshes)
    array = ffi.new("hl_scene_mesh[]", len(given))
    for n, mesh in enumerate(given):
        if not isinstance(mesh, Mesh):
            raise TypeError(f"meshes[{n}]: {mesh!r} is no Mesh")
        mesh._fill(array[n], keep, f"meshes[{n}]: ")
    keep.append(array)
    struct.meshes, struct.mesh_count = array, len(given)


def _forget_sky(struct: Any) -> None:
    """Remove the sky that was chosen for a volume, but keep its zenith."""
    plain = ffi.new("hl_scene_description *")
    lib.hl_scene_description_defaults(plain)
    plain.sky.up = list(struct.up)
    ffi.memmove(ffi.addressof(struct), ffi.addressof(plain, "sky"), ffi.sizeof("hl_sky"))


def _set_sky(struct: Any, sky: Any, keep: list[Any]) -> None:
    look = dict(sky) if isinstance(sky, Mapping) else {"type": "uniform", "color": colors.linear_color("sky", sky)}
    check_keywords("sky", look, [*SkySettings.__annotations__, "pixels"])
    if (pixels := look.pop("pixels", None)) is not None:
        image = numpy.ascontiguousarray(pixels, numpy.float32)
        if image.ndim != 3 or image.shape[2] != 3 or image.size == 0:
            raise ValueError(f"sky: pixels of the shape {image.shape}: give (height, width, 3)")
        keep.append(buffer := ffi.from_buffer("float[]", image))
        struct.pixels, struct.height, struct.width = buffer, image.shape[0], image.shape[1]
        struct.file = ffi.NULL
    _settings.fill("sky: ", struct, lib.HL_SETTINGS_SKY, look)
    if not isinstance(sky, Mapping) and not any(struct.color):  # no sky, as with the program's option --sky 0
        struct.type = lib.HL_SKY_NONE


def _set_background(struct: Any, background: Any) -> None:
    struct.background_transparent = isinstance(background, str) and background == "transparent"
    struct.background_sky = isinstance(background, str) and background == "sky"
    if struct.background_sky and struct.sky.type == lib.HL_SKY_NONE:
        raise ValueError("background: 'sky': the scene has no sky: give sky=, as sky=\"skyblue\"")
    if not struct.background_sky and not struct.background_transparent:
        struct.background = colors.linear_color("background", background)


def _frame(struct: Any, side: int, angles: Sequence[float] | None) -> None:
    """Place the camera so that it frames all volumes, from a side or turned to azimuth and elevation."""
    view = ffi.new("hl_view *")
    camera = ffi.addressof(struct, "camera")
    address = ffi.addressof(struct)
    call(lib.hl_view_choose, address, side, ffi.NULL, view)
    call(lib.hl_camera_frame_view, address, view, 1.0, camera)
    if angles is not None:
        view.azimuth_deg, view.elevation_deg = angles
        if lib.hl_camera_turn(view, camera) != lib.HL_OK:
            raise ValueError(f"camera: azimuth {angles[0]} and elevation {angles[1]}: the elevation is from -90 to 90")


# PyVista's names of views: the direction from which the eye looks, and the direction that is up.
SIDES_BY_AXES = {"xy": ((0, 0, 1), (0, 1, 0)), "yx": ((0, 0, -1), (1, 0, 0)), "xz": ((0, -1, 0), (0, 0, 1)),
                 "zx": ((0, 1, 0), (1, 0, 0)), "yz": ((1, 0, 0), (0, 0, 1)), "zy": ((-1, 0, 0), (0, 1, 0))}


def _look_along(struct: Any, towards_eye: Sequence[float], up: Sequence[float]) -> None:
    """Place the camera so that it frames the visible part of the scene from this direction."""
    camera = struct.camera
    camera.position, camera.target, camera.up = list(towards_eye), [0.0, 0.0, 0.0], list(up)
    if lib.hl_camera_fit(ffi.addressof(struct), 1.0, ffi.addressof(camera)) != lib.HL_OK:
        raise ValueError("camera: what is seen cannot be framed from there")


def _set_camera(struct: Any, camera: Any) -> None:
    if isinstance(camera, Camera):
        camera._fill(struct.camera)
    elif isinstance(camera, str) and len(camera) == 2 and camera in SIDES_BY_AXES:
        _look_along(struct, *SIDES_BY_AXES[camera])
    elif isinstance(camera, str):
        _frame(struct, SIDES.index(camera), None)
    else:
        if isinstance(camera, set) or not hasattr(camera, "__len__"):
            raise TypeError(f"camera: {camera!r} is no Camera, side or (azimuth, elevation)")
        if len(camera) == 3 and all(hasattr(one, "__len__") for one in camera):
            Camera.from_cpos(camera, struct.camera.fovy_deg)._fill(struct.camera)
            return
        angles = _settings.numbers_of("camera", camera, 2)
        if abs(angles[1]) > 90:
            raise ValueError(f"camera: the elevation {angles[1]:g} is not from -90 to 90")
        _frame(struct, lib.HL_SIDE_AUTOMATIC, angles)


def scene_for_meshes() -> Any:
    """A scene of one small triangle, with the camera and the light that the program gives to meshes alone."""
    keep: list[Any] = []
    array = ffi.new("hl_scene_mesh[1]")
    Mesh([(0, 0, 0), (1, 0, 0), (0, 1, 1)], [(0, 1, 2)])._fill(array[0], keep, "")
    return made(lib.hl_scene_for_meshes, "hl_scene", lib.hl_scene_release, context, array, 1)


def _options(settings: Mapping[str, Any], volumes: Sequence[Volume], flags: int) -> dict[str, str]:
    """The settings whose meaning is the library's (hl_scene_compose), as the program's options."""
    options: dict[str, str] = {}
    if (size := settings.get("size")) is not None:
        width, height = _settings.size_of("size", size)
        options["size"] = f"{width}x{height}"
    if isinstance(camera := settings.get("camera"), Mapping):
        options.update(view_options(camera))
    elif isinstance(camera, str) and camera not in SIDES_BY_AXES:
        if choice("camera", camera, SIDES) != "automatic":
            options["view"] = camera
    if isinstance(rig := settings.get("lights"), str):
        options["light-rig"] = choice("lights", rig, LIGHT_RIGS)
    if (ambient := settings.get("ambient")) is not None:
        options["ambient"] = ",".join(map(repr, map(float, colors.linear_color("ambient", ambient))))
    for word in ("shadows", "kernel"):
        if settings.get(word) is not None:
            options[word] = str(settings[word])
    if settings.get("density") is not None:
        options["density"] = repr(_settings.number("density", settings["density"]))
    _option_color_by(settings, options)
    if (at := settings.get("slice")) is not None:
        if not isinstance(at, str):
            raise TypeError(f"slice: {at!r} is no text such as 'z=0.5' or 'z=40mm'")
        options["slice"] = at
        if settings.get("_layers") is not None:
            options["colormap"] = settings["_layers"]
        if settings.get("sheet_spacing") is not None:
            options["sheet-spacing"] = repr(_settings.number("sheet_spacing", settings["sheet_spacing"]))
    if flags & lib.HL_COMPOSE_BARE and (look := _fitted_look(volumes)) is not None:
        options["look"] = look  # several projected volumes get a colour each, and one volume's greys fit the background
        if (background := settings.get("background")) is not None:
            options["background"] = background_option(background)
    elif (flags & lib.HL_COMPOSE_CUT or _have_labels_within(volumes, flags)) and (look := volumes[0]._changes.get("look")) not in (None, "mip"):
        options["look"] = str(look)
    return options


def background_option(background: Any) -> str:
    """A background as the library's option of this name has it."""
    named = background if isinstance(background, str) and background in ("transparent", "sky") else None
    return named or ",".join(map(repr, map(float, colors.linear_color("background", background))))


def _option_color_by(settings: Mapping[str, Any], options: dict[str, str]) -> None:
    """Add the options that give volumes the colours of another volume."""
    by, threshold = settings.get("color_by"), settings.get("color_by_threshold")
    if by is not None:
        if not isinstance(by, str):
            raise TypeError(f"color_by: {by!r} is no text such as 'zmap.nii.gz:hot:0,7'")
        options["color-by"] = by
    if threshold is not None:
        ends = [threshold] if isinstance(threshold, (int, float)) else _settings.numbers_of("color_by_threshold", threshold, 2)
        options["color-by-threshold"] = ",".join(repr(_settings.number("color_by_threshold", end)) for end in ends)


def _have_labels_within(volumes: Sequence[Volume], flags: int) -> bool:
    """Whether label maps show beside volumes whose opacities are those of their look, which may hide the labels."""
    others = [one for one in volumes if one._changes.get("labels") in (None, False)]
    return bool(flags & lib.HL_COMPOSE_BARE) and 0 < len(others) < len(volumes) and all(
        one._base is None and one._changes.get("transfer_function") is None and one._changes.get("iso") is None for one in others)


def _fitted_look(volumes: Sequence[Volume]) -> str | None:
    """The look whose greys fit the background, if the transfer functions of all volumes are those of this look."""
    looks = {one._changes.get("look") if one._base is None and one._changes.get("transfer_function") is None else None
             for one in volumes}
    return next((look for look in ("mip", "xray") if looks == {look}), None)


def _fade_into_background(struct: Any, volumes: Sequence[Volume], settings: Mapping[str, Any], keep: list[Any]) -> None:
    """Fit the colormap of a single volume's maximum projection to a background of one colour."""
    if len(volumes) != 1 or settings.get("slice") is not None or struct.background_transparent or struct.background_sky:
        return
    if isinstance(volumes[0]._changes.get("transfer_function"), transfer.MappedProjection):
        background = list(struct.background) if settings.get("background") is not None else [0.0, 0.0, 0.0]
        function = transfer.faded(volumes[0]._handle, background, struct.volumes[0].transfer_function)
        struct.volumes[0].transfer_function = function[0]
        keep.append(function)


def _flags(volumes: Sequence[Volume], settings: Mapping[str, Any]) -> int:
    """What the library is told of a scene whose camera and light were chosen for its first volume."""
    flags: int = lib.HL_COMPOSE_BARE
    cut = settings.get("cuts") is not None
    if cut or len(volumes) != 1 or any(one._changes.keys() - {"name"} for one in volumes):
        flags |= lib.HL_COMPOSE_CHANGED
    if settings.get("meshes") is not None:
        flags |= lib.HL_COMPOSE_MESHES
    if len(volumes) == 1 and volumes[0]._base is None and (cut or volumes[0]._changes.keys() & {"cuts", "clip"}):
        flags |= lib.HL_COMPOSE_CUT
    return flags


def build_scene(base: Any, volumes: Sequence[Volume], settings: Mapping[str, Any], chosen: bool, flags: int = 0) -> Any:
    """An hl_scene: that of `base` with other volumes and settings. chosen: its camera was chosen for a volume."""
    keep: list[Any] = [base]
    pointer = ffi.new("hl_scene_description *", lib.hl_scene_describe(base)[0])
    struct = pointer[0]
    flags |= _flags(volumes, settings) if chosen else 0
    array = ffi.new("hl_scene_volume[]", len(volumes)) if volumes else ffi.NULL
    for n, volume in enumerate(volumes):
        volume._fill(array[n], keep, f"volumes[{n}]: " if len(volumes) > 1 else "")
    struct.volumes, struct.volume_count = array, len(volumes)
    if chosen and len(volumes) > 1:
        spacings = [lib.hl_scene_describe(one._base_scene()[0]).render.sheet_spacing for one in volumes]
        struct.render.sheet_spacing = lib.hl_scene_joined_spacing(pointer, spacings)
    if (meshes := settings.get("meshes")) is not None:
        _set_meshes(struct, meshes, keep)
    if (cut := settings.get("cuts")) is not None:
        cuts.fill(struct, cut, keep, "")
    if (marks := settings.get("marks")) is not None:
        scene_marks.fill(struct, marks, keep)
    if (lights := settings.get("lights")) is not None and not isinstance(lights, str):
        _set_lights(struct, lights, keep)
        flags |= lib.HL_COMPOSE_LIGHTS
    if (sky := settings.get("sky")) is not None:
        if chosen:
            _forget_sky(struct.sky)
        _set_sky(struct.sky, sky, keep)
        flags |= lib.HL_COMPOSE_SKY
    if (background := settings.get("background")) is not None:
        _set_background(struct, background)
    if (description := settings.get("description")) is not None:
        keep.append(text := ffi.new("char[]", description.encode()))
        struct.description = text
    rest = dict(settings)
    _settings.fill("", struct, lib.HL_SETTINGS_IMAGE, _settings.taken(rest, _IMAGE))
    _settings.fill("", struct, lib.HL_SETTINGS_SCENE, _settings.taken(rest, _TOP))
    _settings.fill("", struct.render, lib.HL_SETTINGS_RENDER, _settings.taken(rest, _RENDER))
    if chosen:
        _fade_into_background(struct, volumes, settings, keep)
    options = _options(settings, volumes, flags)
    if (camera := settings.get("camera")) is not None and "view" not in options and not isinstance(camera, Mapping):
        if "size" in options:
            struct.width, struct.height = map(int, options["size"].split("x"))
        _set_camera(struct, camera)
        flags |= lib.HL_COMPOSE_CAMERA
    return composed(pointer, flags, options)
