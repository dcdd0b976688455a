"""Defines scenes: volumes, lights, a camera and settings. The library checks a scene when it is made."""
from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from typing import Any, Literal, Unpack

import numpy

from . import _settings, arrays, cuts
from . import marks as scene_marks
from ._library import call, choices_of, composed, context, ffi, lib, made, path_bytes, text_of
from ._words import check_keywords, choice
from .camera import Camera, camera_from
from .composing import background_option, build_scene, scene_for_meshes
from .keywords import PictureSettings, RenderSettings
from .lights import Light, images_are_same, light_from
from .mesh import Mesh, mesh_from
from .volume import Picture, Volume, as_volume, index_of, load_options, volume_from

__all__ = ["Scene", "Settings"]

Side = Literal["automatic", "front", "back", "left", "right", "top", "bottom", "iso", "xy", "xz", "yz", "yx", "zx", "zy"]
LightRig = Literal["studio", "raking", "rim", "overcast"]


class Settings(PictureSettings, RenderSettings, total=False):
    """Keywords of `Scene`. Keywords that are not given are chosen from the first volume.

    Parameters
    ----------
    camera : Camera, str, (azimuth, elevation), a mapping or (position, focal point, up)
        "front", "back", "left", "right", "top", "bottom" and "iso" are sides, "xy", "xz", ... PyVista's: the axes to the
        picture's right and top; angles in degrees. Three points are PyVista's ``camera_position``. A mapping has the
        program's options of the camera: `view` (a side), `up` ("+z" or a vector), `azimuth`, `elevation`, `roll`, `zoom`,
        `fovy` and `ortho`, as ``{"view": "front", "up": "+z", "ortho": True, "zoom": 1.2}``.
    lights : a light, a list of them, or the name of a rig
        See `halflight.lights`. "studio", "raking", "rim" and "overcast" are lights that go with the camera, and a sky.
    ambient : float, (r, g, b) or str
        Light from everywhere.
    size : (width, height), int or str
        Pixels; 512 is a square, "640x480" a text.
    background : colour, "transparent" or "sky"
        The colour that a PNG shows behind the volumes. With "sky", all pictures show the scene's sky behind the
        volumes.
    description : str
        One sentence on the scene, for its file.
    meshes : a Mesh or a list of them
        Triangles among the volumes.
    cuts : a mapping or a list of them
        What is cut out of all volumes, in the world: as `cuts` of a `Volume`.
    density : float
        All matter is so many times as dense: 3 makes smoke and glass thicker, 0.3 thinner. Labels keep their opacities.
    color_by : str
        Another volume, whose values at the same place give the volumes their colours: ``FILE[:ARRAY][:MAP[:LO,HI]]``, as
        "zmap.nii.gz:hot:0,7".
    color_by_threshold : float or (float, float)
        With `color_by`, matter keeps its own colour where the other values are below this number, or between these two.
    slice : str
        A slice across x, y or z, as in radiology, seen straight on: "z=0.5" is a fraction, "z=40mm" a place in the world. Its
        values are grey, or as `cmap` and `clim` of `halflight.render` say, and labels lie over them.
    marks : a mapping or a list of them
        Measures and texts in the world, which `Image.annotate` draws: ``{"kind": "ruler", "points": [(0, 0, 0), (9, 0, 0)],
        "text": "width"}``; kinds are "ruler", "angle", "line", "arrow" and "text".
    sky : float, colour or mapping
        Light from all directions, of which folds and hollows receive less: an even colour, or the keywords of
        `halflight.keywords.SkySettings`, as ``{"type": "gradient", "zenith": (0.5, 0.7, 1)}``. An image is an array
        of linear RGB, ``{"type": "image", "pixels": array}``.
    """

    camera: Camera | Side | str | Sequence[float] | Sequence[Sequence[float]] | Mapping[str, Any]
    lights: Light | Sequence[Light] | LightRig
    ambient: float | Sequence[float] | str
    size: tuple[int, int] | int | str
    background: float | Sequence[float] | str
    description: str
    meshes: Mesh | Sequence[Mesh]
    cuts: Any
    density: float
    color_by: str
    color_by_threshold: float | Sequence[float]
    slice: str
    marks: Any
    sky: float | Sequence[float] | str | Mapping[str, Any]


class Scene:
    """What is rendered; immutable.

    Parameters
    ----------
    volumes : Volume, path, array, or a list of them
        Look, lights and camera are chosen from the first, as ``halflight render`` does. Meshes may be among them, or be
        all that there is.
    **settings : Settings
        `camera` (a Camera; "front", "back", "left", "right", "top", "bottom", "iso"; or azimuth and elevation in
        degrees), `lights` (a list, or a rig: "studio", "raking", "rim", "overcast"), `ambient`, `size` (width, height in
        pixels), `background` (a colour, "transparent", or "sky"),
        `description`, and the keywords of `halflight.keywords.PictureSettings` and `RenderSettings`: `shadows`,
        `exposure`, ...

    Examples
    --------
    >>> import numpy as np
    >>> scene = Scene(np.ones((8, 8, 8), np.uint8), size=(64, 48), shadows="hard")
    >>> scene.size, scene.settings["shadows"]
    ((64, 48), 'hard')
    """

    __slots__ = ("__weakref__", "_handle", "_volumes")

    def __init__(self, volumes: Any = (), *, _layers: str | None = None, **settings: Unpack[Settings]) -> None:
        check_keywords("Scene()", settings, Settings.__annotations__)
        given = list(volumes) if isinstance(volumes, list) or isinstance(volumes, tuple) and not volumes else [volumes]
        if (own := [one for one in given if isinstance(one, Mesh)]):
            more = settings.get("meshes", ())
            settings["meshes"] = [*own, *([more] if isinstance(more, Mesh) else more)]
        self._volumes = tuple(as_volume(source) for source in given if not isinstance(source, Mesh))
        if not self._volumes and not settings.get("meshes"):
            raise ValueError("a scene needs at least one volume or mesh")
        base = self._volumes[0]._base_scene()[0] if self._volumes else scene_for_meshes()
        self._handle = build_scene(base, self._volumes, {**settings, "_layers": _layers}, True)

    @classmethod
    def from_json(cls, text: str, folder: str | os.PathLike[str] | None = None, name: str = "scene") -> Scene:
        """The scene of a scene file's text; relative paths begin in `folder`, by default the current one.

        Examples
        --------
        >>> shapes = '{"halflight": 1, "volumes": [{"shapes": [{"type": "sphere", "radius": 8}], "voxel_size": 1}]}'
        >>> Scene.from_json(shapes).size
        (512, 512)
        """
        raw = text.encode()
        return cls._of(made(lib.hl_scene_from_json, "hl_scene", lib.hl_scene_release, context, raw, len(raw),
                            ffi.NULL if folder is None else ffi.new("char[]", path_bytes(folder)), name.encode()))

    @classmethod
    def load(cls, path: str | os.PathLike[str]) -> Scene:
        """The scene of a file. Relative paths in the file begin in its folder."""
        file = os.fspath(path)
        return cls._of(made(lib.hl_scene_load, "hl_scene", lib.hl_scene_release, context, path_bytes(file),
                            path=file))

    @classmethod
    def of_channels(cls, path: str | os.PathLike[str], channels: str | Sequence[int | str] = "all", *, look: str = "auto",
                    array: str | None = None, series: str | None = None, time: int | None = None, level: int | None = None,
                    spacing: Any = None, space: str | None = None, smooth: float | None = None) -> Scene:
        """A scene of several channels of a file, such as a microscope's. Each channel is a volume in a colour of its
        own. The file may state this colour (OME, ImageJ, omero). If it does not, the colours are green and magenta,
        cyan, yellow, ...

        Parameters
        ----------
        path : path
        channels : "all", or a list of numbers from 0 and of the file's own names
        look, array, series, time, level, spacing, space, smooth : optional
            As for `halflight.render`.
        """
        return cls._of_channels(path, channels, None, look=look, array=array, series=series, time=time, level=level, spacing=spacing,
                                space=space, smooth=smooth)

    @classmethod
    def _of_channels(cls, path: str | os.PathLike[str], channels: str | Sequence[int | str], picture: Picture | None, *,
                     look: str = "auto", background: Any = None, spacing: Any = None, space: str | None = None,
                     smooth: float | None = None, **chosen: Any) -> Scene:
        """The same, at the resolutions that suit a picture. background: what maximum projections begin with."""
        file = os.fspath(path)
        options, keep = load_options({word: value for word, value in chosen.items() if value is not None}, spacing, space, "zyx", picture)
        listed = [channels] if isinstance(channels, str) else [one if isinstance(one, str) else str(index_of("channel", one)) for one in channels]
        if not listed:
            raise ValueError("channel: [] names none: give a number or a name, several as [0, 2], or 'all'")
        projected = choice("look", look, choices_of("look")) == "mip"
        sigma = ffi.NULL if smooth is None else ffi.new("double *", _settings.number("smooth", smooth))
        handle = made(lib.hl_scene_for_channels, "hl_scene", lib.hl_scene_release, context, path_bytes(file), options,
                      ",".join(listed).encode(), sigma, look.encode(), path=file)
        del keep  # the texts that `options` borrows are kept in this list
        if projected:
            before = {} if background is None else {"background": background_option(background)}
            handle = composed(lib.hl_scene_describe(handle), lib.HL_COMPOSE_BARE, {"look": "mip", **before})
        return cls._of(handle)

    @classmethod
    def _of(cls, handle: Any) -> Scene:
        scene = cls.__new__(cls)
        scene._handle = handle
        count = lib.hl_scene_describe(handle).volume_count
        scene._volumes = tuple(volume_from(handle, index) for index in range(count))
        return scene

    def to_json(self) -> str:
        """The scene file's text. Volumes of arrays have no file: save them first."""
        return self._text(None)

    def _text(self, folder: str | None) -> str:
        """The text, for a picture in a folder: files in it, or below, are named relative to it. A picture's text does not
        tell the number of threads, which changes no picture.
        """
        text, handle = ffi.new("char **"), self._handle
        if folder is not None and lib.hl_scene_describe(handle).render.threads != 0:
            plain = ffi.new("hl_scene_description *", lib.hl_scene_describe(handle)[0])
            plain.render.threads = 0
            handle = made(lib.hl_scene_create, "hl_scene", lib.hl_scene_release, context, plain)
        call(lib.hl_scene_to_json_beside, context, handle,
             ffi.NULL if folder is None else ffi.new("char[]", path_bytes(folder)), text)
        try:
            return text_of(text[0])
        finally:
            lib.hl_text_release(context, text[0])

    def replace(self, volumes: Any = None, **settings: Unpack[Settings]) -> Scene:
        """Another scene with some things changed.

        Examples
        --------
        >>> import numpy as np
        >>> Scene(np.ones((8, 8, 8), np.uint8)).replace(size=(32, 32)).size
        (32, 32)
        """
        check_keywords("Scene.replace()", settings, ["volumes", *Settings.__annotations__])
        given = self._volumes if volumes is None else volumes if isinstance(volumes, (list, tuple)) else [volumes]
        return self._changed(given, settings, False)

    def _changed(self, volumes: Sequence[Any], settings: Mapping[str, Any], chosen: bool, flags: int = 0) -> Scene:
        """The scene with other volumes and settings. chosen: whether the scene's camera and light were chosen for its
        volumes, so that they are chosen anew. flags: further ones of hl_compose_flag.
        """
        other = Scene.__new__(Scene)
        other._volumes = tuple(as_volume(source) for source in volumes)
        other._handle = build_scene(self._handle, other._volumes, settings, chosen, flags)
        return other

    def save(self, path: str | os.PathLike[str], *, copy: bool = False) -> None:
        """Write a scene file (.json) that `Scene.load` and ``halflight render`` read, and beside it the data that are
        only in memory.

        Arrays, and images of lights and skies that are arrays, go into a folder beside the file, whose name begins as the
        file's; meshes are written into the scene. Files stay where they are, named relative to the scene where they lie
        beside or below it.

        Parameters
        ----------
        path : path
            Its name ends in .json.
        copy : bool
            Whether volumes that come from files are written into the folder, too, so that the scene and its folder can
            be sent to other people.

        Examples
        --------
        >>> import numpy as np
        >>> Scene(np.ones((8, 8, 8), np.uint8), size=16).save("ones.json")
        >>> Scene.load("ones.json").volumes[0].dimensions
        (8, 8, 8)
        """
        from .bundle import save

        save(self, os.fspath(path), copy)

    def to_html(self, path: str | os.PathLike[str] | None = None, *, title: str = "Halflight") -> str:
        """The scene with its data as one page for browsers, with camera, light and all panels alive.

        It opens from a disk. Volumes are cut to the box that shows anything, and lie in 8 bits where these hold all values.
        The viewer's page itself is made by ``scripts/web``. A package has the page if it was there when the package was
        built; otherwise the variable ``HALFLIGHT_PAGE`` of the environment names it.

        Parameters
        ----------
        path : path
            The page is written there, too.
        title : str
            The title of the page.

        Returns
        -------
        str
            The page's text.

        Raises
        ------
        FileNotFoundError
            The viewer's page is not there.
        """
        from .page_file import page_of

        text = page_of(self, title)
        if path is not None:
            from . import picture_files

            picture_files.write_whole(os.fspath(path), text.encode())
        return text

    def _state(self) -> dict[str, Any]:
        """Everything that the scene shows beside its volumes, as the keywords that make it."""
        state: dict[str, Any] = {word: getattr(self, word) for word in (
            "camera", "lights", "ambient", "size", "background", "meshes", "cuts", "marks", "exposure", "tone", "sky", "description")}
        return state | dict(self.settings)

    def __reduce__(self) -> Any:
        return _restored, (self._volumes, self._state())

    def __copy__(self) -> Scene:
        return self.replace()

    def __deepcopy__(self, memo: dict[int, Any]) -> Scene:
        return self.replace()  # scenes do not change

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Scene):
            return NotImplemented
        return self._handle == other._handle or (
            self._volumes == other._volumes and _settings.same(self._state(), other._state())
            and all(map(images_are_same, self.lights, other.lights)))

    def __hash__(self) -> int:
        return hash((self.size, len(self._volumes)))

    def _check_arrays(self) -> None:
        """Raise ValueError if an array has been changed since a volume borrowed it."""
        struct = self._struct
        for n in range(struct.volume_count):
            for what, handle in (("array", struct.volumes[n].volume), ("mask", struct.volumes[n].mask.volume)):
                loan = arrays.loan_of(handle) if handle != ffi.NULL else None
                if loan is not None and not loan.is_unchanged():
                    where = f"volumes[{n}]: " if struct.volume_count > 1 else ""
                    raise ValueError(f"{where}the {what} was changed after the volume was made: make a new Volume and Scene of it, "
                                     "or give copy=True")

    @property
    def _struct(self) -> Any:
        return lib.hl_scene_describe(self._handle)

    @property
    def volumes(self) -> tuple[Volume, ...]:
        """The volumes."""
        return self._volumes

    @property
    def camera(self) -> Camera:
        """The camera."""
        return camera_from(self._struct.camera)

    @property
    def lights(self) -> tuple[Light, ...]:
        """The lights."""
        return tuple(light_from(self._struct.lights[n]) for n in range(self._struct.light_count))

    @property
    def meshes(self) -> tuple[Mesh, ...]:
        """The meshes."""
        return tuple(mesh_from(self._struct.meshes[n]) for n in range(self._struct.mesh_count))

    @property
    def cuts(self) -> list[dict[str, Any]]:
        """The cuts of all volumes."""
        return cuts.cuts_from(self._struct)

    @property
    def marks(self) -> list[dict[str, Any]]:
        """Measures and texts that stand in the scene."""
        return scene_marks.marks_from(self._struct)

    @property
    def sky(self) -> dict[str, Any]:
        """Light from all directions, by the keywords of `halflight.keywords.SkySettings`, with an image's `pixels`."""
        sky = self._struct.sky
        found = _settings.read(sky, lib.HL_SETTINGS_SKY)
        if sky.pixels != ffi.NULL:
            held = ffi.buffer(sky.pixels, 4 * sky.width * sky.height * 3)
            found["pixels"] = numpy.frombuffer(held, numpy.float32).reshape(sky.height, sky.width, 3).copy()
        return found

    @property
    def description(self) -> str | None:
        """One sentence on the scene."""
        return None if self._struct.description == ffi.NULL else text_of(self._struct.description)

    @property
    def size(self) -> tuple[int, int]:
        """Width and height in pixels."""
        return self._struct.width, self._struct.height

    @property
    def ambient(self) -> tuple[float, float, float]:
        """Light from everywhere, linear RGB."""
        red, green, blue = self._struct.ambient
        return red, green, blue

    @property
    def background(self) -> tuple[float, float, float] | str:
        """Linear RGB, "transparent", or "sky"."""
        red, green, blue = self._struct.background
        if self._struct.background_sky:
            return "sky"
        return "transparent" if self._struct.background_transparent else (red, green, blue)

    @property
    def exposure(self) -> float:
        """The exposure, in stops, by which a PNG shows the scene brighter."""
        exposure: float = self._struct.exposure
        return exposure

    @property
    def tone(self) -> str:
        """The way in which a PNG shows light brighter than white: "clip" or "filmic"."""
        tone: str = _settings.from_field(_settings.table(lib.HL_SETTINGS_IMAGE)["tone"], self._struct.tone)
        return tone

    @property
    def settings(self) -> Mapping[str, Any]:
        """The settings of the scene file's `render`, by their names."""
        return _settings.read(self._struct.render, lib.HL_SETTINGS_RENDER)

    def __repr__(self) -> str:
        width, height = self.size
        counts = ((len(self.volumes), "volume"), (self._struct.mesh_count, "mesh"), (len(self.lights), "light"))
        said = [f"{n} {noun}{'' if n == 1 else 'es' if noun == 'mesh' else 's'}" for n, noun in counts if n or noun != "mesh"]
        return f"<halflight.Scene {width}x{height}, {', '.join(said)}>"


def _restored(volumes: tuple[Volume, ...], state: dict[str, Any]) -> Scene:
    """The scene with this state, as pickle makes it."""
    scene = Scene.__new__(Scene)
    scene._volumes = volumes
    scene._handle = build_scene(scene_for_meshes(), volumes, state, False)
    return scene
