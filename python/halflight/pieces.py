"""Passes arrays to the library as files: arrays for which memory has no room, and arrays whose voxels are colours.

Both become an NRRD file without compression. Arrays of zarr, h5py and dask are written slice by slice to such a file
in the scratch folder, and read from it, as other volumes larger than memory are. Arrays of colours become such a file
in memory.
"""
from __future__ import annotations

import contextlib
import os
import tempfile
from collections.abc import Iterator
from typing import Any

import numpy as np

from . import memory
from ._library import call, context, ffi, lib, made, path_bytes
from .arrays import Place

__all__ = ["color_file", "color_volume", "does_not_fit", "has_colors", "volume_of_pieces", "voxels_of"]

_TYPES = {"u1": "uint8", "i1": "int8", "u2": "uint16", "i2": "int16", "u4": "uint32", "i4": "int32", "u8": "uint64",
          "i8": "int64", "f4": "float", "f8": "double"}
_PIECE = 32 << 20  # bytes that are read at once, unless the array's chunks are larger


def _header(shape: tuple[int, ...], kind: str, axes: str, place: Place, space: int, colors: bool) -> bytes:
    """The header of an array whose first three axes are `axes`, the slowest first."""
    steps = {letter: place.steps["xyz".index(letter)] for letter in axes}
    vectors = ["(" + ",".join(repr(float(one)) for one in steps[letter]) + ")" for letter in reversed(axes)]
    kinds = ["domain"] * 3
    if colors:
        vectors, kinds = ["none", *vectors], ["RGB-color" if shape[-1] == 3 else "RGBA-color", *kinds]
    spaces = {lib.HL_SPACE_RAS: "right-anterior-superior", lib.HL_SPACE_LPS: "left-posterior-superior",
              lib.HL_SPACE_LAS: "left-anterior-superior"}
    lines = ["NRRD0004", f"type: {_TYPES[kind]}", f"dimension: {len(shape)}",
             f"space: {spaces[space]}" if space in spaces else "space dimension: 3",
             "sizes: " + " ".join(map(str, reversed(shape))), "space directions: " + " ".join(vectors),
             "kinds: " + " ".join(kinds), "encoding: raw",
             "endian: " + ("little" if np.little_endian else "big"),
             "space origin: (" + ",".join(repr(float(one)) for one in place.origin) + ")", "", ""]
    return "\n".join(lines).encode()


def has_colors(shape: tuple[int, ...], dtype: Any) -> bool:
    """Whether an array is [z][y][x][3 or 4]: colours, of 8 or 16 bits or of floats from 0 to 1."""
    return len(shape) == 4 and shape[3] in (3, 4) and np.dtype(dtype).str[1:] in ("u1", "u2", "f4", "f8")


def color_file(array: np.ndarray[Any, Any], axes: str, place: Place | tuple[Any, Any], space: int) -> bytes:
    """An NRRD file whose voxels are colours."""
    if array.dtype.kind == "f":
        if array.size and not (np.nanmin(array) >= 0 and np.nanmax(array) <= 1):
            raise ValueError(f"the array's colours go from {np.nanmin(array):g} to {np.nanmax(array):g}: floats are from 0 to 1")
        array = (np.nan_to_num(array) * 255 + 0.5).astype(np.uint8)
    plain = np.ascontiguousarray(array, array.dtype.newbyteorder("="))
    return _header(plain.shape, plain.dtype.str[1:], axes, Place(*place), space, True) + plain.tobytes()


def color_volume(array: np.ndarray[Any, Any], axes: str, place: Place, space: int) -> Any:
    """An hl_volume whose voxels have colours of their own, sRGB, and whose values are the alpha or the luminance."""
    content = color_file(array, axes, place, space)
    options = ffi.new("hl_volume_load_options *")
    lib.hl_volume_load_options_defaults(options)
    options.component = lib.HL_COMPONENT_COLOR
    options.bytes, options.byte_count = ffi.from_buffer(content), len(content)
    return made(lib.hl_volume_load_with, "hl_volume", lib.hl_volume_release, context, b"array.nrrd", options)


def does_not_fit(array: Any) -> bool:
    """Whether the memory limit leaves no room for an array that is read by slices."""
    limit = memory.current()[0]
    size = int(np.prod(array.shape)) * np.dtype(array.dtype).itemsize
    return limit is not None and bool(size > limit - lib.hl_context_memory_held(context))


def _slices(array: Any, step: int) -> Iterator[np.ndarray[Any, Any]]:
    for first in range(0, array.shape[0], step):
        yield np.asarray(array[first:first + step])


def _step(array: Any) -> int:
    """The number of slices along the first axis that are read at once. They are whole chunks if the chunks are not
    larger than the piece.
    """
    slice_bytes = max(int(np.prod(array.shape[1:])) * np.dtype(array.dtype).itemsize, 1)
    chunks: Any = getattr(array, "chunks", None) or (1,)
    chunk = max(chunks[0]) if isinstance(chunks[0], tuple) else int(chunks[0])
    return max(min(chunk, int(array.shape[0])), _PIECE // slice_bytes // chunk * chunk, 1)


def volume_of_pieces(array: Any, axes: str, place: Place, space: int) -> Any:
    """An hl_volume of an array that is read slice by slice. The file through which its voxels go is removed afterwards."""
    kind = np.dtype(array.dtype).str[1:]
    stored = "u1" if kind == "b1" else "f4" if kind == "f2" else kind
    if stored not in _TYPES:
        raise TypeError(f"the array's type is {array.dtype}: a volume is of bool, integers or floats of 16 to 64 bits")
    if len(array.shape) != 3:
        raise ValueError(f"the array has the shape {tuple(array.shape)}: a volume has three axes, here '{axes}'; "
                         "of more, choose with an index, such as array[0]")
    number, path = tempfile.mkstemp(prefix="halflight-", suffix=".nrrd", dir=memory.current()[1])
    try:
        with os.fdopen(number, "wb") as file:
            file.write(_header(tuple(array.shape), stored, axes, place, space, False))
            for piece in _slices(array, _step(array)):
                np.ascontiguousarray(piece, np.dtype(stored)).tofile(file)
        return made(lib.hl_volume_load_with, "hl_volume", lib.hl_volume_release, context, path_bytes(path), ffi.NULL)
    finally:
        with contextlib.suppress(FileNotFoundError):
            os.unlink(path)


_NIFTI = {2: "u1", 4: "i2", 8: "i4", 16: "f4", 64: "f8", 256: "i1", 512: "u2", 768: "u4", 1024: "i8", 1280: "u8"}


def voxels_of(handle: Any) -> np.ndarray[Any, Any]:
    """The voxels of an hl_volume, [z][y][x] of its index axes, in the type that holds its values; by way of a NIfTI file."""
    with tempfile.TemporaryDirectory(prefix="halflight-", dir=memory.current()[1]) as folder:
        path = os.path.join(folder, "voxels.nii")
        call(lib.hl_volume_save, context, handle, path_bytes(path), warns=False)
        with open(path, "rb") as file:
            header = file.read(352)
            sizes = np.frombuffer(header, "<i2", 8, 40)
            kind = _NIFTI[int(np.frombuffer(header, "<i2", 1, 70)[0])]
            file.seek(int(np.frombuffer(header, "<f4", 1, 108)[0]))
            return np.fromfile(file, f"<{kind}").reshape(tuple(int(one) for one in sizes[3:0:-1]))
