"""Describes arrays to the library: the places of voxels in memory and in the world.

The library borrows voxels of uint8, uint16 and float32 whose rows are packed; rows and slices may lie apart. The axes
may have any order, and may be counted from either end. So an array is borrowed as it lies in memory if the voxels are
adjacent along one axis: in C or Fortran order, transposed, flipped, as a box cut out of a larger array, or as every
second slice. Other arrays are copied once, by the library.
"""
from __future__ import annotations

from collections.abc import Sequence
import weakref
import zlib
from typing import Any, NamedTuple

import numpy as np

from ._library import call, context, ffi, lend, lib, unlend, warn
from ._settings import number, numbers_of

_TYPES = {
    "u1": lib.HL_VOXEL_U8, "i1": lib.HL_VOXEL_I8, "u2": lib.HL_VOXEL_U16, "i2": lib.HL_VOXEL_I16,
    "u4": lib.HL_VOXEL_U32, "i4": lib.HL_VOXEL_I32, "u8": lib.HL_VOXEL_U64, "i8": lib.HL_VOXEL_I64,
    "f2": lib.HL_VOXEL_F16, "f4": lib.HL_VOXEL_F32, "f8": lib.HL_VOXEL_F64,
}
_BORROWED = ("u1", "u2", "f4")
_LARGE = 64 << 20  # bytes: copies from this size on are reported by a warning

Spacing = float | Sequence[float]


class Place(NamedTuple):
    """The place of the voxels: the first voxel's centre, and the step in the world along each of the index axes x, y,
    z.
    """

    origin: tuple[float, ...]
    steps: tuple[tuple[float, ...], ...]


def check_axes(axes: object) -> str:
    """`axes`, if it has each of x, y and z once."""
    if not isinstance(axes, str):
        raise TypeError(f"axes: {axes!r} is no text such as 'zyx'")
    if sorted(axes) != ["x", "y", "z"]:
        raise ValueError(f"axes: '{axes}' does not have each of x, y and z once: 'zyx' is [z][y][x], 'xyz' [x][y][z]")
    return axes


def spacing_xyz(spacing: Spacing, axes: str) -> list[float]:
    """The distances along x, y and z: `spacing` has the array's order, or is one number for all."""
    given = [number("spacing", spacing)] * 3 if np.ndim(spacing) == 0 else numbers_of("spacing", spacing)
    for one in given:
        if not one > 0:
            raise ValueError(f"spacing: {one:g} is not above 0: give the world units between voxels")
    return [given[axes.index(name)] for name in "xyz"]


def matrix_of(place: str, value: Any, shapes: Sequence[tuple[int, int]]) -> list[list[float]]:
    """A matrix of one of these shapes, or its numbers in a row."""
    try:
        matrix = np.asarray(value, dtype=np.float64)
    except (TypeError, ValueError):
        raise TypeError(f"{place}: {value!r} is no matrix of numbers") from None
    for shape in shapes:
        if matrix.shape == shape or matrix.shape == (shape[0] * shape[1],):
            found: list[list[float]] = matrix.reshape(shape).tolist()
            return found
    wanted = " or ".join(f"{rows}x{columns}" for rows, columns in shapes)
    raise ValueError(f"{place}: the shape {matrix.shape} is not {wanted}")


def make_place(axes: str, spacing: Spacing | None, origin: Any, direction: Any, affine: Any) -> Place:
    """The place that the keywords of `Volume` give."""
    if affine is not None:
        for name, value in (("spacing", spacing), ("origin", origin), ("direction", direction)):
            if value is not None:
                raise TypeError(f"{name} and affine say the same: give one of them")
        rows = matrix_of("affine", affine, [(4, 4), (3, 4)])
        return Place(tuple(row[3] for row in rows[:3]), tuple(tuple(row[n] for row in rows[:3]) for n in range(3)))
    along = spacing_xyz(1.0 if spacing is None else spacing, axes)
    turned = np.eye(3).tolist() if direction is None else matrix_of("direction", direction, [(3, 3)])
    first = [0.0, 0.0, 0.0] if origin is None else numbers_of("origin", origin)
    return Place(tuple(first), tuple(tuple(row[n] * along[n] for row in turned) for n in range(3)))


_LETTERS = {"R": (0, 1), "L": (0, -1), "A": (1, 1), "P": (1, -1), "S": (2, 1), "I": (2, -1)}  # the axis of RAS, and the sign along it


def check_letters(space: object) -> list[tuple[int, int]]:
    """The axes of RAS and the signs of the three letters of `space`."""
    if not isinstance(space, str):
        raise TypeError(f"space: {space!r} is no text such as 'RAS'")
    found = [_LETTERS.get(letter, (-1, 0)) for letter in space.upper()]
    if sorted(axis for axis, _ in found) != [0, 1, 2]:
        raise ValueError(f"space: '{space}': give the directions to which x, y and z point, as 'RAS', 'LPS' or another three of R or L, "
                         "A or P, S or I")
    return found


def in_space(place: Place, letters: str) -> tuple[Place, int]:
    """A place in the anatomical space that three letters state, and the space; as the library reads a file with
    `hl_volume_load_options.file_space`.
    """
    found = check_letters(letters)
    for space in (lib.HL_SPACE_RAS, lib.HL_SPACE_LPS, lib.HL_SPACE_LAS):
        if ffi.string(lib.hl_space_name(space)).decode() == letters.upper():
            return place, int(space)

    def turned(vector: Sequence[float]) -> tuple[float, ...]:
        said = {axis: sign * one + 0.0 for (axis, sign), one in zip(found, vector, strict=True)}
        return said[0], said[1], said[2]

    return Place(turned(place.origin), tuple(turned(step) for step in place.steps)), int(lib.HL_SPACE_RAS)


def without_single_axes(array: Any) -> Any:
    """The array with at most three axes, after axes of length 1 were removed, beginning with the first axis."""
    while len(array.shape) > 3 and 1 in array.shape:
        index: list[Any] = [slice(None)] * len(array.shape)
        index[tuple(array.shape).index(1)] = 0
        array = array[tuple(index)]
    return array


def readable(array: np.ndarray[Any, Any], axes: str) -> np.ndarray[Any, Any]:
    """The voxels as [z][y][x] in a type and byte order that the library reads; a view where that is possible."""
    if array.ndim != 3:
        if array.ndim == 2:
            raise ValueError(f"the array has the shape {array.shape}: a volume has three axes, here '{axes}'; "
                             "of one slice, use array[None]")
        raise ValueError(f"the array has the shape {array.shape}: a volume has three axes, here '{axes}'; "
                         "of more, choose with an index, such as array[0]")
    if isinstance(array, np.ma.MaskedArray):
        masked: Any = array.astype(np.float32)
        array = masked.filled(np.nan)
    voxels = array.transpose([axes.index(name) for name in "zyx"])
    if voxels.dtype == np.bool_:
        voxels = voxels.view(np.uint8)
    kind = voxels.dtype.str[1:]
    if kind not in _TYPES:
        raise TypeError(f"the array's type is {array.dtype}: a volume is of bool, integers or floats of 16 to 64 bits")
    if not voxels.dtype.isnative:
        if voxels.nbytes >= _LARGE:
            warn(f"the array's bytes are in the other order: {voxels.nbytes >> 20} MiB are copied")
        voxels = voxels.astype(voxels.dtype.newbyteorder("="))
    if not voxels.flags.aligned or not any(voxels.strides):
        voxels = np.array(voxels, order="C")
    return voxels


class _Lying(NamedTuple):
    """Voxels as the library reads them: [z][y][x] of its index axes, and bytes from one voxel to the next along x, y, z."""

    voxels: np.ndarray[Any, Any]
    place: Place
    strides: tuple[int, int, int]


def _strides(voxels: np.ndarray[Any, Any]) -> tuple[int, int, int]:
    """Bytes from voxel to voxel along x, y, z. Along axes of one voxel the number has no effect, and is the number of
    a packed block.
    """
    found, block = [], voxels.itemsize
    for size, stride in zip(voxels.shape[::-1], voxels.strides[::-1], strict=True):
        found.append(stride if size > 1 else block)
        block = max(block, abs(found[-1]) * size)
    return found[0], found[1], found[2]


def _as_it_lies(voxels: np.ndarray[Any, Any], place: Place) -> _Lying:
    """The array with its axes sorted by their strides, and with no negative strides, if the library can then borrow
    the voxels.
    """
    if voxels.flags.c_contiguous:
        return _Lying(voxels, place, _strides(voxels))
    origin, steps, turned = list(place.origin), list(place.steps), voxels
    for n in range(3):
        axis = 2 - n  # of the array [z][y][x]
        if voxels.strides[axis] < 0 and voxels.shape[axis] > 1:
            origin = [o + s * (voxels.shape[axis] - 1) for o, s in zip(origin, steps[n], strict=True)]
            steps[n] = tuple(-s for s in steps[n])
            turned = np.flip(turned, axis)
    long = [axis for axis in range(3) if turned.shape[axis] > 1]  # axes of one voxel stay where they are
    falling = iter(sorted(long, key=lambda axis: -turned.strides[axis]))
    order = [next(falling) if axis in long else axis for axis in range(3)]
    turned = turned.transpose(order)
    strides = _strides(turned)
    if strides[0] != turned.itemsize:  # the library copies these voxels, in the order in which the caller counts them
        return _Lying(voxels, place, _strides(voxels))
    return _Lying(turned, Place(tuple(origin), tuple(steps[2 - axis] for axis in reversed(order))), strides)


class Loan:
    """Voxels that a volume borrows, [z][y][x], with their place, and with a sample that was taken when they were
    borrowed.
    """

    __slots__ = ("__weakref__", "owner", "place", "sample", "space", "voxels")

    def __init__(self, voxels: np.ndarray[Any, Any], place: Place, space: int, owner: object) -> None:
        self.voxels, self.place, self.space, self.owner = voxels, place, space, owner
        self.sample = _sample_of(voxels)

    def is_unchanged(self) -> bool:
        """Whether a new sample equals the sample that was taken when the voxels were borrowed."""
        return self.sample == _sample_of(self.voxels)


_SAMPLED = 48  # voxels along each axis

_loans: weakref.WeakValueDictionary[int, Loan] = weakref.WeakValueDictionary()  # by the address of the volume


def _sample_of(voxels: np.ndarray[Any, Any]) -> int:
    """A checksum of a lattice of voxels. A change of the voxels in any box that is as wide as the lattice's gaps
    changes a voxel of the lattice.
    """
    steps = tuple(slice(None, None, -(-size // _SAMPLED)) for size in voxels.shape)
    return zlib.crc32(np.ascontiguousarray(voxels[steps]).view(np.uint8).data)


class Packed(NamedTuple):
    """An array in the order of its bytes in memory, with the facts that restore the same view, so that copies keep
    this order.
    """

    voxels: np.ndarray[Any, Any]
    order: tuple[int, ...]
    turned: tuple[bool, ...]

    def view(self) -> np.ndarray[Any, Any]:
        """Restores the array, whose axes have the same order in memory as before."""
        return self.voxels.transpose(self.order)[_from_the_end(self.turned)]


def _from_the_end(turned: Sequence[bool]) -> tuple[slice, ...]:
    return tuple(slice(None, None, -1 if one else None) for one in turned)


def packed(array: np.ndarray[Any, Any]) -> Packed:
    """The array for pickle."""
    turned = tuple(stride < 0 for stride in array.strides)
    falling = sorted(range(array.ndim), key=lambda axis: -abs(array.strides[axis]))
    lying = np.ascontiguousarray(array[_from_the_end(turned)].transpose(falling))
    return Packed(lying, tuple(falling.index(axis) for axis in range(array.ndim)), turned)


def loan_of(handle: Any) -> Loan | None:
    """The voxels that an hl_volume borrows; None if it has its own voxels."""
    return _loans.get(int(ffi.cast("uintptr_t", handle)))


def make_volume(array: np.ndarray[Any, Any], axes: str, place: Place, space: int, owner: object) -> Any:
    """An hl_volume of the array's voxels; `owner` is kept as long as it borrows them."""
    if 0 in array.shape:
        raise ValueError(f"the array has the shape {array.shape}: there is no voxel in it")
    voxels = readable(without_single_axes(array), axes)
    given, where = voxels, place
    kind = voxels.dtype.str[1:]
    strides = _strides(voxels)
    if kind in _BORROWED:
        voxels, place, strides = _as_it_lies(voxels, place)
    description = ffi.new("hl_volume_description *")
    lib.hl_volume_description_defaults(description)
    description.type = _TYPES[kind]
    description.dimensions = voxels.shape[::-1]
    description.stride_bytes = strides
    description.origin, description.axis = place.origin, place.steps
    description.space = space
    description.voxels = ffi.cast("void *", voxels.__array_interface__["data"][0])
    loan = Loan(given, where, space, owner)
    lend(description, loan)
    made = ffi.new("hl_volume **")
    try:
        call(lib.hl_volume_create, context, description, made)
    except BaseException:
        unlend(description)
        raise
    handle = ffi.gc(made[0], lib.hl_volume_release)
    # If the library has copied the voxels, the loan ends with this call.
    _loans[int(ffi.cast("uintptr_t", handle))] = loan
    return handle
