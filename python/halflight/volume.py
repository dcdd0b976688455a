"""Defines volumes: voxels, their place in the world, and their look."""
from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple, Unpack

import numpy as np

from . import _settings, arrays, beside, cuts, grids, isosurface, mask, neighbours, pieces, vtk_grids
from ._library import call, choices_of, composed, context, ffi, lib, made, path_bytes, text_of
from ._words import check_keywords, choice
from .transfer import function_from
from .values import VALUES, function_for
from .volume_info import FileArray, FileChannel, FileSegment, FileSeries, Info, read_info
from .volume_look import Look, fill_look

__all__ = ["FileArray", "FileChannel", "FileSegment", "FileSeries", "Info", "Look", "Volume", "info"]

Source = Any  # a path, an array, or an object of one of the packages that halflight.neighbours knows

_OF_FILES = ("array", "component", "series", "time", "channel", "level")
_OF_VALUES = ("transfer_function", "iso", "mask")
_FIELDS = _settings.names(lib.HL_SETTINGS_VOLUME, "scale", "clip_min", "clip_max")


class Volume:
    """Voxels with their place in the world and their look.

    An array is not copied if the library can read it as it lies in memory: packed uint8, bool, uint16 and float32,
    with axes in any order. The caller may delete the array. If the array is changed while the volume or a scene with
    it lives, the next picture of the volume is refused: make another `Volume`, or copy the array by ``copy=True``.

    Parameters
    ----------
    source : path, array, or an object that has one
        A file (NRRD, MetaImage, NIfTI, VTK, NumPy, raw), anything with ``__array__``, the buffer protocol or
        DLPack, images of nibabel, SimpleITK and ITK, pynrrd's ``(data, header)``, xarray, PyVista and VTK image
        data, zarr, h5py and dask arrays. `Particles` stand for their logarithm of density.
    spacing : float or 3 floats, optional
        World units between voxels, in the order of `axes`.
    origin : (x, y, z), optional
        World position of the first voxel's centre.
    direction : array_like, shape (3, 3), optional
        Its columns are the unit vectors of the index axes x, y, z in the world.
    affine : array_like, shape (4, 4) or (3, 4), optional
        From voxel indices (x, y, z) to the world, in place of the three above.
    space : str, optional
        The directions in a patient's body to which x, y and z of the world point, as three letters: R or L, A or P,
        S or I. "RAS", "LPS" and "LAS" keep the world; of others, such as "PIR" for sagittal slices, the world is turned into RAS.
    axes : str, optional
        The order of the array's axes; "zyx", the default, is ``array[z][y][x]``.
    array, component, series, time, channel, level : optional
        Of a file with several: the array's name; the number of the component, "magnitude", or "color" or
        "luminance" for voxels with colours; a DICOM series by number, UID or description; the number of the time
        step and resolution; the number of the channel, or its name in the file. `array` chooses a variable of an xarray.Dataset, too.
    copy : bool
        Copy the voxels of an array, which may then be changed.
    smooth : float, optional
        Smooth the voxels by a Gaussian of so many voxels along each axis; 0: not at all. By default, 0.8 for brains
        without their skull, which end in a cliff of voxels, and for thick slices; 0 for all else, for slices and for
        maximum projections.
    **look : Look
        How it looks and where it stands: `name`, `transfer_function`, `clip`, `scale`, the keywords of
        `halflight.keywords.VolumeSettings` and `MaterialSettings`, and `cmap`, `clim`, `opacity` and others as for
        `halflight.render`.

    Examples
    --------
    >>> import numpy as np
    >>> volume = Volume(np.zeros((4, 5, 6), np.uint8), spacing=(2, 1, 1))
    >>> volume.dimensions
    (6, 5, 4)
    """

    __slots__ = ("__weakref__", "_automatic", "_base", "_changes", "_colored", "_file", "_handle", "_laid", "_loading", "_order", "_shapes", "_sharp")

    def __init__(self, source: Source, *, spacing: arrays.Spacing | None = None, origin: Any = None,
                 direction: Any = None, affine: Any = None, space: str | None = None, axes: str | None = None,
                 array: str | None = None, component: int | str | None = None, series: str | None = None, time: int | None = None,
                 channel: int | str | None = None, level: int | None = None, copy: bool = False,
                 smooth: float | None = None, _picture: Picture | None = None, **look: Unpack[Look]) -> None:
        check_keywords("Volume()", look, [*Look.__annotations__, "spacing", "origin", "direction", "affine", "space", "axes", "copy", "smooth", *_OF_FILES])
        self._sharp: Any = None  # the handle of the voxels before they were smoothed
        self._handle: Any = None
        self._file: str | None = None
        self._loading: Any = None
        self._automatic: Any = None  # the scene that shows the volume with no further choice
        # Or the scene from which the volume was read, and its number in this scene.
        self._base: tuple[Any, int] | None = None
        self._order: tuple[int, ...] | None = None
        self._laid: tuple[str, arrays.Place] | None = None  # the order of the array's axes, and the place along x, y, z
        self._colored: Any = None  # the array, if its voxels are colours
        self._shapes: str | None = None  # the text that the voxels were made from
        self._changes: dict[str, Any] = {word: value for word, value in look.items() if word not in VALUES}
        place = {"spacing": spacing, "origin": origin, "direction": direction, "affine": affine}
        chosen = {"array": array, "component": component, "series": series, "time": time, "channel": channel,
                  "level": level}
        if hasattr(source, "_as_volume"):
            source = source._as_volume()
        if isinstance(source, Volume):
            for word, value in {**place, **chosen, "space": space, "axes": axes, "copy": copy or None}.items():
                if value is not None:
                    raise TypeError(f"{word} is for arrays and files: a Volume has been read already")
            self._share(source)
        else:
            if axes is not None:
                arrays.check_axes(axes)
            self._read(source, axes, place, space, {word: value for word, value in chosen.items() if value is not None}, copy, _picture)
        if smooth is not None:
            self._smooth(smooth)
        values: Any = {word: look[word] for word in VALUES if word in look}  # type: ignore[literal-required]
        if (function := function_for(self, self._changes.get("look") == "mip", **values)) is not None:
            self._changes["transfer_function"] = function

    def _smooth(self, sigma: float) -> None:
        """Take smoothed voxels in place of the volume's."""
        sharp = self._handle if self._sharp is None else self._sharp
        self._handle = made(lib.hl_volume_smooth, "hl_volume", lib.hl_volume_release, sharp, _settings.number("smooth", sigma))
        self._sharp, self._automatic = sharp, None
        if self._base is not None:
            raise TypeError("smooth is for volumes of files and arrays: a scene says it itself")

    def _read(self, source: Source, axes: str | None, place: dict[str, Any], letters: str | None, chosen: dict[str, Any],
              copy: bool, picture: Picture | None) -> None:
        if isinstance(source, (str, os.PathLike)):
            for word in ("origin", "direction", "affine"):
                if place[word] is not None:
                    raise TypeError(f"{word} is for arrays: a file says it itself")
            self._load(os.fspath(source), place["spacing"], letters, axes or "zyx", chosen, picture)
            return
        is_grid = not isinstance(source, np.ndarray) and vtk_grids.is_grid(source)
        name = chosen.pop("array", None) if hasattr(source, "data_vars") or is_grid else None
        mesh = vtk_grids.of_vtk(source, name) if is_grid else None
        if mesh is not None:
            source = mesh[0]
            if mesh[1] is not None:
                self._changes.setdefault("name", mesh[1])
        if isinstance(source, (grids.Cells, grids.Patches)):
            for word in [word for word, value in {**place, "space": letters}.items() if value is not None] + list(chosen):
                raise TypeError(f"{word} is for arrays and files: a grid has places of its own")
            self._handle = source.handle()
            return
        for word in chosen:
            raise TypeError(f"{word} is for files that hold several: choose by an index")
        found = neighbours.find(source) if name is None else neighbours.variable(source, name)
        order = axes or found.axes or "zyx"
        known = {word: value for word, value in place.items() if value is not None} or found.place
        space = found.space if known is found.place else 0
        where, array = arrays.make_place(order, *map(known.get, place)), arrays.without_single_axes(found.array)
        if letters is not None:
            where, space = arrays.in_space(where, letters)
        self._handle = self._made(array, order, where, space, None if copy else found.owner, copy)
        if pieces.has_colors(array.shape, array.dtype):
            self._colored = np.array(array).transpose([order.index(letter) for letter in "zyx"] + [3])
        if len(array.shape) == 3:
            self._order = tuple(array.shape[order.index(letter)] for letter in "xyz")
            self._laid = order, where
        if found.name is not None:
            self._changes.setdefault("name", found.name)

    @staticmethod
    def _made(array: Any, order: str, place: arrays.Place, space: int, owner: object, copy: bool) -> Any:
        """An hl_volume of an array, which is borrowed, copied, read piece by piece, or has colours as voxels."""
        if pieces.has_colors(array.shape, array.dtype):
            return pieces.color_volume(np.asarray(array), order, place, space)
        if neighbours.is_stored(array):
            if pieces.does_not_fit(array):
                return pieces.volume_of_pieces(array, order, place, space)
            array = neighbours.read_whole(array)
        elif copy:
            array = np.array(array, order="C")
        return arrays.make_volume(array, order, place, space, owner)

    def _share(self, other: Volume) -> None:
        self._handle, self._file, self._loading = other._handle, other._file, other._loading
        self._base, self._order, self._laid, self._shapes, self._colored = other._base, other._order, other._laid, other._shapes, other._colored
        self._sharp = other._sharp
        self._changes = {**other._changes, **self._changes}
        same = (self._changes.get("look"), self._is_of_values()) == (other._changes.get("look"), other._is_of_values())
        self._automatic = other._automatic if same else None

    def _load(self, path: str, spacing: arrays.Spacing | None, space: str | None, axes: str, chosen: dict[str, Any],
              picture: Picture | None) -> None:
        options, keep = load_options(chosen, spacing, space, axes, picture)
        self._file = path
        self._loading = (options, keep)
        self._handle = made(lib.hl_volume_load_with, "hl_volume", lib.hl_volume_release, context, path_bytes(path),
                            options, path=path)
        # A scene, and a restored volume, read the channel by its number, and the resolution that suits the picture.
        read = ffi.new("hl_volume_selection *", {"struct_size": ffi.sizeof("hl_volume_selection")})
        if lib.hl_volume_get_selection(self._handle, read) == lib.HL_OK:
            if options.channel_name != ffi.NULL:
                options.channel, options.channel_name = read.channel, ffi.NULL
            if picture is not None and read.levels > 1:
                options.level = read.aim
        options.pixels = options.preview_pixels = 0

    @classmethod
    def from_cells(cls, points: Any, cells: Any, types: Any, values: Any, **look: Unpack[Look]) -> Volume:
        """A mesh of cells with values, sampled at distances of about half of a cell's edge. The volume is transparent
        outside of the cells.

        Parameters
        ----------
        points : array_like, shape (points, 3)
            In the world.
        cells : array_like of int, shape (cells, corners) or flat
            Points, from 0, in VTK's order. A flat list has each cell's number of corners before them, as PyVista's
            ``grid.cells``.
        types : int, or array_like of int, shape (cells,)
            VTK's numbers: 10 tetrahedra, 12 hexahedra, 13 wedges, 14 pyramids. Quadratic cells are read by their corners.
        values : array_like, shape (points,) or (cells,)
            The values, of which missing ones are NaN. Values of cells are averaged at the points.

        Examples
        --------
        >>> points = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
        >>> import warnings
        >>> with warnings.catch_warnings():
        ...     warnings.simplefilter("ignore")  # it tells how far the samples are from the mesh
        ...     Volume.from_cells(points, [(0, 1, 2, 3)], 10, [0, 1, 1, 2]).dimensions
        (2, 2, 2)
        """
        return cls(grids.Cells(points, cells, types, values), **look)

    @classmethod
    def from_amr(cls, patches: Any, *, ratio: int | Sequence[int] = 2, cells: Sequence[int] | None = None,
                 first: Sequence[int] = (0, 0, 0), origin: Sequence[float] = (0, 0, 0),
                 spacing: float | Sequence[float] = 1, **look: Unpack[Look]) -> Volume:
        """An adaptive grid, without seams where the level changes.

        Parameters
        ----------
        patches : iterable of (level, (x, y, z), array)
            The level from 0, the coarsest; the patch's first cell in the level's index space; and the means of the
            values over its cells, [z][y][x]. Finer patches replace coarser ones that they cover.
        ratio : int or ints
            The number of cells of each level along an edge of a cell of the level before: 2, 4, 8, ...
        cells : (x, y, z), optional
            The number of cells of level 0 in the domain. By default, the domain is the region that the patches of
            level 0 cover.
        first : (x, y, z)
            The domain's first cell of level 0.
        origin : (x, y, z)
            World position of the domain's corner with the least coordinates.
        spacing : float or 3 floats
            World units: the edges x, y, z of a cell of level 0.

        Examples
        --------
        >>> import numpy as np
        >>> patches = [(0, (0, 0, 0), np.ones((8, 8, 8))), (1, (4, 4, 4), np.ones((8, 8, 8)))]
        >>> Volume.from_amr(patches).dimensions
        (16, 16, 16)
        """
        return cls(grids.Patches(patches, ratio, cells, first, origin, spacing), **look)

    def replace(self, **look: Unpack[Look]) -> Volume:
        """The same voxels with another look."""
        return Volume(self, **look)

    @property
    def look(self) -> Mapping[str, Any]:
        """The volume's look: the keywords that were given, and the choices that are made from the data."""
        struct = self._struct()
        look = _settings.read(struct, lib.HL_SETTINGS_VOLUME)
        look = {word: look[word] for word in _FIELDS} | _settings.read(struct.material, lib.HL_SETTINGS_MATERIAL)
        look["name"] = None if struct.name == ffi.NULL else text_of(struct.name)
        look["transfer_function"] = function_from(struct.transfer_function)
        look["clip"] = (tuple(struct.clip_min), tuple(struct.clip_max)) if struct.clipped else None
        if struct.iso_count > 0:
            look["iso"] = isosurface.isosurfaces_from(struct)
        if struct.cut_count > 0:
            look["cuts"] = cuts.cuts_from(struct)
        if struct.label_count > 0:
            look["labels"] = mask.labels_from(struct.labels, struct.label_count, False)
        if struct.mask.volume != ffi.NULL:
            look["mask"] = {"volume": _of_handle(struct.mask.volume, struct.mask.file), "rest": struct.mask.rest,
                            "show": mask.labels_from(struct.mask.labels, struct.mask.label_count, True)}
        look["scale"] = tuple(struct.scale * one for one in struct.axis_scale)
        return look | self._changes

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> np.ndarray[Any, Any]:
        """The voxels, [z][y][x]. They are the read-only voxels of a borrowed array, or else a copy."""
        loan = arrays.loan_of(self._handle)
        if loan is None:
            if copy is False:
                raise ValueError("the volume's voxels are the library's own: they can only be copied")
            voxels = pieces.voxels_of(self._handle)
        else:
            voxels = loan.voxels.copy() if copy else loan.voxels.view()
            voxels.flags.writeable = bool(copy)
        return voxels if dtype is None else voxels.astype(dtype, copy=False)

    @property
    def affine(self) -> np.ndarray[Any, np.dtype[np.float64]]:
        """The matrix, 4x4, that maps the indices (x, y, z) of ``numpy.asarray(volume)`` to the world."""
        place = self._place()
        matrix = np.eye(4)
        matrix[:3, :3], matrix[:3, 3] = np.array(place.steps).T, place.origin
        return matrix

    def _place(self) -> arrays.Place:
        loan = arrays.loan_of(self._handle)
        if loan is not None:
            return loan.place
        info = self.info()
        return arrays.Place(tuple(info.origin.tolist()), tuple(map(tuple, (info.direction * info.spacing).T.tolist())))

    def save(self, path: str | os.PathLike[str], *, type: str | None = None, shrink: int = 1, unit: str | None = None) -> None:
        """Write the voxels with their place: .nrrd, .nii, .nii.gz, .mha, .vti, .mrc, .tif, .npy, .raw or .raw.gz, by the name's ending.

        Parameters
        ----------
        path : path
            The file, which appears whole or not at all. The name of a raw file states size and type, as for reading.
        type : str, optional
            The type of the voxels, such as "uint8"; by default a type that holds all values.
        shrink : int
            A written voxel is the mean over this number of voxels along each axis. For a label map, it is the most
            common label of these voxels.
        unit : str, optional
            The unit of lengths, such as "um", where the volume's file does not tell one.

        Examples
        --------
        >>> Volume(np.arange(8, dtype=np.uint8).reshape(2, 2, 2), spacing=0.5).save("eight.nrrd")
        >>> Volume("eight.nrrd").info().spacing.tolist()
        [0.5, 0.5, 0.5]
        """
        options = ffi.new("hl_volume_save_options *")
        lib.hl_volume_save_options_defaults(options)
        if type is not None:
            kinds = {text_of(lib.hl_voxel_type_name(kind)): kind for kind in range(1, 12)}
            options.type = kinds[choice("type", type, kinds)]
        if isinstance(shrink, bool) or shrink != int(shrink) or shrink < 1:
            raise ValueError(f"shrink: {shrink!r} is no whole number from 1 on")
        options.shrink = int(shrink)
        if options.shrink > 1:
            labels = ffi.new("int *")
            call(lib.hl_volume_is_label_map, context, self._handle, labels)
            options.labels = labels[0]
        if unit is not None:
            text = ffi.new("char[]", str(unit).encode())
            options.unit = text
        call(lib.hl_volume_save_with, context, self._handle, path_bytes(path), options)

    def _source(self) -> tuple[str, Any]:
        """The source of the voxels, for pickle and comparison: ("file", (path, how it is read)), ("shapes", text) or
        ("array", ...).
        """
        if self._shapes is not None:
            return "shapes", self._shapes
        if self._file is not None and os.path.exists(self._file):
            return "file", (os.path.abspath(self._file), self._reading())
        loan = arrays.loan_of(self._handle)
        info = self.info()
        space = next((code for code in range(4) if lib.hl_space_name(code) != ffi.NULL and text_of(lib.hl_space_name(code)) == info.space), 0)
        voxels = np.asarray(self) if self._colored is None else self._colored
        return "array", (voxels, tuple(self._place()), loan.space if loan is not None else space, self._order)

    def _reading(self) -> dict[str, Any]:
        """The options for reading the file that differ from the defaults."""
        struct, plain = self._loading[0] if self._loading is not None else self._struct(), ffi.new("hl_volume_load_options *")
        said: dict[str, Any] = {}
        lib.hl_volume_load_options_defaults(plain)
        for word in ("array", "series", "component", "time", "channel", "level"):
            value = getattr(struct, word)
            if word in ("array", "series"):
                if value != ffi.NULL:
                    said[word] = text_of(value)
            elif value != getattr(plain, word):
                name = lib.hl_component_name(value) if word == "component" else ffi.NULL
                said[word] = value if name == ffi.NULL else text_of(name)
        if self._sharp is not None:
            said["smooth"] = lib.hl_volume_smoothing(self._handle)
        if any(struct.spacing):
            said["spacing"] = list(struct.spacing)[::-1]
        if struct.file_space != ffi.NULL:
            said["space"] = text_of(struct.file_space)
        return said

    def __reduce__(self) -> Any:
        look = dict(self._changes) if self._base is None else self.look
        kind, source = self._source()
        return _restored, (kind, (arrays.packed(source[0]), *source[1:]) if kind == "array" else source, look)

    def __copy__(self) -> Volume:
        return Volume(self)

    def __deepcopy__(self, memo: dict[int, Any]) -> Volume:
        return Volume(self)  # volumes do not change

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Volume):
            return NotImplemented
        if not _settings.same(self.look, other.look):
            return False
        if self._handle == other._handle:
            return True
        (kind, one), (other_kind, two) = self._source(), other._source()
        if kind != other_kind or kind != "array":
            return kind == other_kind and bool(one == two)
        return one[1:3] == two[1:3] and np.array_equal(one[0], two[0], equal_nan=one[0].dtype.kind == "f")

    def __hash__(self) -> int:
        return hash(self.dimensions)

    @property
    def dimensions(self) -> tuple[int, int, int]:
        """Voxels along the index axes x, y, z."""
        return self.info().dimensions

    def info(self) -> Info:
        """Size, type, place and statistics."""
        return read_info(self._handle, self._file_text(), self._order)

    def percentile(self, percent: float) -> float:
        """The data value below which `percent` percent of the finite voxels lie, as ``numpy.percentile`` computes it.

        Examples
        --------
        >>> Volume(np.arange(101.0).reshape(1, 1, 101)).percentile(25)
        25.0
        """
        percents, value = ffi.new("double[1]", [_settings.number("percent", percent)]), ffi.new("double[1]")
        call(lib.hl_volume_percentiles, self._handle, percents, 1, value)
        return float(value[0])

    def __repr__(self) -> str:
        size = "x".join(map(str, self.dimensions))
        return f"<halflight.Volume {size} {self.info().type}{'' if self._file is None else f' {self._file}'}>"

    def _file_text(self) -> Any:
        return ffi.NULL if self._file is None else ffi.new("char[]", path_bytes(self._file))

    def _is_of_values(self) -> bool:
        """Whether a label map has its values instead of its labels: settings ask for values, or it is not drawn and may only be
        another volume's second number."""
        labels = self._changes.get("labels")
        undrawn = self._changes.get("visible") is False and self._changes.get("casts_shadow") is False
        return labels is False or (labels is None and (undrawn or any(self._changes.get(word) is not None for word in _OF_VALUES)))

    def _base_scene(self) -> tuple[Any, int]:
        """A scene that has the volume, and the volume's number there."""
        if self._base is not None:
            return self._base
        if self._automatic is None:
            look = self._changes.get("look")
            projected = look is not None and choice("look", look, choices_of("look")) == "mip"
            wanted = ffi.new("char[]", b"auto" if look is None else look.encode())
            self._automatic = made(lib.hl_scene_for_volume_look, "hl_scene", lib.hl_scene_release, context, self._handle,
                                   self._file_text(), wanted)
            if self._is_of_values() and lib.hl_scene_describe(self._automatic).volumes[0].label_count > 0:
                self._automatic = composed(lib.hl_scene_describe(self._automatic), lib.HL_COMPOSE_BARE | lib.HL_COMPOSE_VALUES, {})
            if projected:
                self._automatic = composed(lib.hl_scene_describe(self._automatic), lib.HL_COMPOSE_BARE, {"look": "mip"})
        return self._automatic, 0

    def _struct(self) -> Any:
        scene, index = self._base_scene()
        return lib.hl_scene_describe(scene).volumes[index]

    def _fill(self, struct: Any, keep: list[Any], place: str) -> None:
        """Set an hl_scene_volume, which is valid as long as `keep`."""
        keep.append(self)
        ffi.memmove(ffi.addressof(struct), ffi.addressof(self._struct()), ffi.sizeof("hl_scene_volume"))
        if self._loading is not None:
            options = self._loading[0]
            for word in ("spacing", "file_space", *_OF_FILES):
                setattr(struct, word, getattr(options, word))
        fill_look(struct, self._changes, self._handle, self._base is not None, lambda source: map_over(source, self), keep, place)


def index_of(word: str, value: Any) -> int:
    """A number from 0 on."""
    if isinstance(value, bool) or not isinstance(value, (int, np.integer)) or value < 0:
        raise ValueError(f"{word}: {value!r} is no number from 0 on" + (" and not 'magnitude'" if word == "component" else ""))
    return int(value)


class Picture(NamedTuple):
    """The picture for which one of several resolutions is read: the members of hl_volume_load_options."""

    pixels: int
    preview_pixels: int


def load_options(chosen: Mapping[str, Any], spacing: arrays.Spacing | None, space: str | None, axes: str,
                 picture: Picture | None = None) -> tuple[Any, list[Any]]:
    """An hl_volume_load_options, which is valid as long as the list."""
    options, keep = ffi.new("hl_volume_load_options *"), list[Any]()
    lib.hl_volume_load_options_defaults(options)
    if picture is not None:
        options.pixels, options.preview_pixels = picture
    for word, value in chosen.items():
        if word in ("array", "series"):
            keep.append(value := ffi.new("char[]", str(value).encode()))
        elif word == "component" and value in ("magnitude", "color", "luminance"):
            value = lib.hl_component_of_name(value.encode())
        elif word == "channel" and isinstance(value, str):
            keep.append(value := ffi.new("char[]", value.encode()))
            word = "channel_name"
        else:
            value = index_of(word, value)
        setattr(options, word, value)
    if spacing is not None:
        options.spacing = arrays.spacing_xyz(spacing, axes)
    if space is not None:
        arrays.check_letters(space)
        keep.append(text := ffi.new("char[]", space.encode()))
        options.file_space = text
    return options, keep


def volume_from(scene: Any, index: int) -> Volume:
    """The volume with this number in a scene."""
    struct = lib.hl_scene_describe(scene).volumes[index]
    found = _of_handle(struct.volume, struct.file)
    found._base = scene, index
    found._shapes = None if struct.shapes == ffi.NULL else text_of(struct.shapes)
    return found


def _of_handle(handle: Any, file: Any) -> Volume:
    """A Volume of an hl_volume, which it retains."""
    found = Volume.__new__(Volume)
    found._sharp = found._loading = found._automatic = found._order = found._laid = found._shapes = found._base = found._colored = None
    found._file = None if file == ffi.NULL else os.fsdecode(ffi.string(file))
    found._changes = {}
    lib.hl_volume_retain(handle)
    found._handle = ffi.gc(handle, lib.hl_volume_release)
    return found


def volume_of_handle(handle: Any) -> Volume:
    """A Volume of voxels that the library made, of an hl_volume."""
    return _of_handle(handle, ffi.NULL)


def _restored(kind: str, source: Any, look: dict[str, Any]) -> Volume:
    """The volume of a source that `Volume._source` has returned, as pickle makes it."""
    if kind == "file":
        return Volume(source[0], **source[1], **look)
    found = Volume.__new__(Volume)
    found._sharp = found._file = found._loading = found._automatic = found._base = found._shapes = found._order = found._laid = found._colored = None
    found._changes = dict(look)
    if kind == "shapes":
        raw = source.encode()
        found._shapes = source
        found._handle = made(lib.hl_volume_from_shapes, "hl_volume", lib.hl_volume_release, context, raw, len(raw), b"shapes",
                             ffi.NULL)
        return found
    packed, place, space, found._order = source
    voxels = packed.view()
    found._handle = Volume._made(voxels, "zyx", arrays.Place(*place), space, None, False)
    if voxels.ndim == 4:
        found._colored = voxels
    return found


def as_volume(source: Any) -> Volume:
    """Returns a Volume unchanged, and makes a Volume of anything else."""
    return source if isinstance(source, Volume) else Volume(source)


def map_over(source: Any, volume: Volume) -> Volume:
    """Returns the Volume of a label map over `volume`. A map whose source does not tell its place takes the volume's place."""
    if isinstance(source, Volume) or hasattr(source, "_as_volume"):
        return as_volume(source)
    if not isinstance(source, (str, os.PathLike)):
        return Volume(source, **beside.place_of_array(source, volume))
    found = Volume(source)
    place = beside.place_of_file(found._handle, volume._handle, volume._loading)
    return Volume(source, **place) if place else found


def info(volume: Source, **place: Any) -> Info:
    """The properties of a volume, as ``halflight info --json`` prints them.

    Parameters
    ----------
    volume : path, array or Volume
        See `Volume`, whose keywords are taken too.

    Examples
    --------
    >>> import numpy as np
    >>> info(np.arange(8, dtype=np.uint8).reshape(2, 2, 2)).range
    (0.0, 7.0)
    """
    return Volume(volume, **place).info()
