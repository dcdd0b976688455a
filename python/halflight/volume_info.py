"""Describes volumes: size, type, place, statistics, and the other content of a volume's file."""
from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ._library import call, ffi, lib, text_of

__all__ = ["FieldError", "FileArray", "FileChannel", "FileSegment", "FileSeries", "Info", "read_info"]


@dataclass(frozen=True)
class FileArray:
    """An array of a volume's file. It has `components` values for each voxel. `chosen` tells whether the array was
    read.
    """

    name: str
    type: str | None
    components: int
    of_cells: bool
    chosen: bool


@dataclass(frozen=True)
class FileSeries:
    """A DICOM series. `dimensions` are columns, rows and slices. `number` is None if the files have no number."""

    uid: str
    number: float | None
    modality: str
    description: str
    dimensions: tuple[int, int, int]
    chosen: bool


@dataclass(frozen=True)
class FileChannel:
    """The facts about a channel in a volume's file. Facts that the file does not state are "" and None. `window`: the
    data values that are shown black and white.
    """

    name: str
    color: tuple[float, float, float] | None
    window: tuple[float, float] | None
    chosen: bool


@dataclass(frozen=True)
class FileSegment:
    """A segment that a label map's file names: `layer` is the component whose voxels have the `value`."""

    value: int
    name: str
    layer: int
    color: tuple[float, float, float] | None


@dataclass(frozen=True)
class FieldError:
    """The difference between the field of a volume and the content of its file.

    Attributes
    ----------
    value : float or None
        The difference in data values; None if nothing could be compared, as in a mesh of one layer of cells.
    of_range : float or None
        `value` as a part of the volume's range.
    kind : str
        "exact": `value` is the greatest difference; "bound": no difference is greater.
    source : str
        A text that says with what the field was compared.
    """

    value: float | None
    of_range: float | None
    kind: str
    source: str


@dataclass(frozen=True)
class Info:
    """The properties of a volume, as ``halflight info --json`` prints them. Values are data values.

    Attributes
    ----------
    dimensions : tuple of 3 int
        The numbers of voxels along the index axes x, y, z.
    type : str
        Of the voxels: "uint8", "int16", "float32", ...
    spacing, origin : ndarray of float64, shape (3,)
        World units: the distance of voxels along x, y, z, and the centre of the first voxel.
    direction : ndarray of float64, shape (3, 3)
        Its columns are the unit vectors of the index axes x, y, z.
    range : tuple of 2 float
        The least and the greatest finite value. A value is an int if a float would round it.
    mean : float
        The mean of the finite voxels.
    nonfinite_count : int
        The number of NaN and infinite voxels, which are transparent.
    histogram : ndarray of uint64, shape (256,)
        The numbers of finite voxels in equal bins over `range`.
    space : str or None
        "RAS", "LPS" or "LAS" if the anatomical directions of the world's axes are known.
    unit : str or None
        The unit of lengths, as the volume's file names it.
    taken_for : str
        The kind of data for which an automatic look is chosen.
    arrays : tuple of FileArray
        The arrays of the volume's file; empty if the volume has no file.
    times, channels, levels : int
        The numbers of times, channels and levels in the file, each at least 1.
    time, channel, level : int
        The time, the channel and the level that were read.
    series : tuple of FileSeries
        The DICOM series in the folder or archive.
    segments : tuple of FileSegment
        The segments of a label map whose file names its labels.
    channel_list : tuple of FileChannel
        The file's channels, if the file describes them.
    field_error : FieldError or None
        Of meshes of cells, grids with refinement and sparse grids, whose field is made of what the file says; None for
        volumes that are their voxels.
    """

    dimensions: tuple[int, int, int]
    type: str
    spacing: np.ndarray[Any, np.dtype[np.float64]]
    origin: np.ndarray[Any, np.dtype[np.float64]]
    direction: np.ndarray[Any, np.dtype[np.float64]]
    range: tuple[float, float]
    mean: float
    nonfinite_count: int
    histogram: np.ndarray[Any, np.dtype[np.uint64]] = field(repr=False)
    space: str | None
    taken_for: str
    arrays: tuple[FileArray, ...] = ()
    times: int = 1
    time: int = 0
    channels: int = 1
    channel: int = 0
    levels: int = 1
    level: int = 0
    series: tuple[FileSeries, ...] = ()
    segments: tuple[FileSegment, ...] = ()
    channel_list: tuple[FileChannel, ...] = ()
    field_error: FieldError | None = None
    unit: str | None = None


def _raw_info(handle: Any) -> Any:
    """The hl_volume_info of an hl_volume."""
    raw = _sized("info")
    if lib.hl_volume_get_info(handle, raw) != lib.HL_OK:
        raise RuntimeError("the volume is not known")
    return raw


def read_info(handle: Any, file: Any, order: Any) -> Info:
    """Size, type, place and statistics of an hl_volume.

    Parameters
    ----------
    handle : hl_volume
    file : char pointer
        The name of its file; null if there is none.
    order : 3 int or None
        The order of the voxels along x, y, z, if the library was given other axes than the array's.
    """
    raw = _raw_info(handle)
    kind = ffi.new("const char **")
    call(lib.hl_volume_guess, handle, file, kind)
    dimensions = order or tuple(raw.dimensions)
    return Info(
        dimensions=(int(dimensions[0]), int(dimensions[1]), int(dimensions[2])),
        type=text_of(lib.hl_voxel_type_name(raw.type)), spacing=np.array(list(raw.spacing)),
        origin=np.array(list(raw.origin)), direction=np.array([list(row) for row in raw.direction]),
        range=(_range_end(handle, 0, raw.range[0]), _range_end(handle, 1, raw.range[1])), mean=raw.mean, nonfinite_count=raw.nonfinite_count,
        histogram=np.array(list(raw.histogram), dtype=np.uint64),
        space=None if lib.hl_space_name(raw.space) == ffi.NULL else text_of(lib.hl_space_name(raw.space)),
        unit=None if (unit := lib.hl_volume_unit(handle)) == ffi.NULL else text_of(unit),
        taken_for=text_of(kind[0]), field_error=_field_error(handle), **_choices(handle))


def _field_error(handle: Any) -> FieldError | None:
    raw = _sized("field_error")
    if lib.hl_volume_get_field_error(handle, raw) != lib.HL_OK:
        return None
    known = raw.value == raw.value
    return FieldError(raw.value if known else None, raw.of_range if known else None, text_of(raw.kind), text_of(raw.source))


def _range_end(handle: Any, end: int, value: float) -> float:
    """The least or the greatest value, as an int if a float would round it."""
    text = ffi.new("char[]", lib.HL_NUMBER_TEXT_BYTES)
    if abs(value) < 2**53 or lib.hl_volume_write_range(handle, end, text) != lib.HL_OK:
        return value
    digits = text_of(text)
    return int(digits) if digits.lstrip("-").isdigit() else value


def _choices(handle: Any) -> dict[str, Any]:
    """The content of the volume's file, and the part of it that was read."""
    selection, array, series = (_sized(name) for name in ("selection", "array", "series"))
    arrays, many = list[FileArray](), list[FileSeries]()
    for n in range(lib.hl_volume_array_count(handle)):
        if lib.hl_volume_get_array(handle, n, array) == lib.HL_OK:
            kind = text_of(lib.hl_voxel_type_name(array.type)) if array.type else None
            arrays.append(FileArray(text_of(array.name), kind, array.components, bool(array.of_cells),
                                    bool(array.chosen)))
    for n in range(lib.hl_volume_series_count(handle)):
        if lib.hl_volume_get_series(handle, n, series) == lib.HL_OK:
            number = None if series.number != series.number else series.number
            columns, rows, slices = series.dimensions
            many.append(FileSeries(text_of(series.uid), number, text_of(series.modality),
                                   text_of(series.description), (columns, rows, slices), bool(series.chosen)))
    if lib.hl_volume_get_selection(handle, selection) != lib.HL_OK:
        raise RuntimeError("the volume is not known")
    segment, segments = _sized("segment"), list[FileSegment]()
    for n in range(lib.hl_volume_segment_count(handle)):
        if lib.hl_volume_get_segment(handle, n, segment) == lib.HL_OK:
            red, green, blue = segment.srgb
            color = (red, green, blue) if segment.has_color else None
            segments.append(FileSegment(segment.value, text_of(segment.name), segment.layer, color))
    channel, channels = _sized("channel"), list[FileChannel]()
    for n in range(selection.channels):
        if lib.hl_volume_get_channel(handle, n, channel) == lib.HL_OK:
            low, high = channel.window
            red, green, blue = channel.srgb
            channels.append(FileChannel(text_of(channel.name), (red, green, blue) if channel.has_color else None,
                                        (low, high) if low == low else None, bool(channel.chosen)))
    if all(one.name == "" and one.color is None and one.window is None for one in channels):
        channels = []
    words = ("times", "time", "channels", "channel", "levels", "level")
    return {word: getattr(selection, word) for word in words} | {
        "arrays": tuple(arrays), "series": tuple(many), "segments": tuple(segments), "channel_list": tuple(channels)}


def _sized(noun: str) -> Any:
    """A struct hl_volume_`noun` that knows its size."""
    struct = ffi.new(f"hl_volume_{noun} *")
    struct.struct_size = ffi.sizeof(f"hl_volume_{noun}")
    return struct
