"""Volumes of other packages, known by what they can do; none of these packages is imported or required."""
from __future__ import annotations

import sys
from typing import Any, NamedTuple

import numpy as np

from ._library import lib, warn


class Found(NamedTuple):
    """An array with what its package knows about it; None where it knows nothing."""

    array: np.ndarray[Any, Any]
    axes: str | None = None
    place: dict[str, Any] = {}  # keywords of arrays.make_place(); spacing in the order of axes
    space: int = 0
    owner: object = None
    name: str | None = None


def find(source: Any) -> Found:
    """The array of `source`.

    Raises
    ------
    TypeError
        If it is no array, and nothing that has one.
    """
    if isinstance(source, np.ndarray):
        return Found(source)
    for matches, read in _READERS:
        if matches(source):
            return read(source)
    if hasattr(source, "__dlpack__") and not hasattr(source, "__array_interface__"):
        return Found(np.from_dlpack(source), owner=source)
    if hasattr(source, "chunks") or type(source).__module__.partition(".")[0] in ("h5py", "zarr"):
        return _stored(source)
    if hasattr(source, "__array__") or hasattr(source, "__array_interface__") or _has_buffer(source):
        return Found(np.asarray(source), owner=source)
    raise TypeError(f"{type(source).__name__} is no path, array or volume")


def _has_buffer(source: object) -> bool:
    try:
        memoryview(source)  # type: ignore[arg-type]
    except TypeError:
        return False
    return True


def _stored(source: Any) -> Found:
    """zarr, h5py and dask: the whole array is read."""
    size = int(np.prod(source.shape)) * np.dtype(source.dtype).itemsize
    if size >= 1 << 30:
        warn(f"{type(source).__name__}: all {size / 2**30:.1f} GiB are read into memory: "
             "a slice with a step, such as array[::2, ::2, ::2], is smaller")
    return Found(np.asarray(source[...]))


def _nibabel(source: Any) -> Found:
    return Found(np.asanyarray(source.dataobj), "xyz", {"affine": source.affine}, lib.HL_SPACE_RAS, source)


def _itk(source: Any) -> Found:
    """SimpleITK's images and ITK's: x runs fastest, world coordinates are left, back, head."""
    if hasattr(source, "GetPixelIDTypeAsString"):
        array, direction = sys.modules["SimpleITK"].GetArrayViewFromImage(source), source.GetDirection()
    else:
        itk = sys.modules["itk"]
        array, direction = itk.array_view_from_image(source), itk.array_from_matrix(source.GetDirection())
    place = {"spacing": list(source.GetSpacing())[::-1], "origin": list(source.GetOrigin()),
             "direction": np.asarray(direction, dtype=float)}
    return Found(array, "zyx", place, lib.HL_SPACE_LPS, source)


def _pynrrd(source: Any) -> Found:
    """(data, header) of nrrd.read(), in either index order."""
    data, header = source
    sizes = tuple(int(size) for size in header.get("sizes", data.shape))
    fortran = data.shape == sizes and (sizes != sizes[::-1] or not data.flags.c_contiguous)
    place: dict[str, Any] = {}
    directions = header.get("space directions")
    if directions is not None:
        place["affine"] = np.column_stack([np.asarray(directions, dtype=float).T,
                                           header.get("space origin", (0, 0, 0))])
    elif "spacings" in header:
        spacings = list(map(float, header["spacings"]))
        place["spacing"] = spacings if fortran else spacings[::-1]
    spaces = {"right-anterior-superior": lib.HL_SPACE_RAS, "ras": lib.HL_SPACE_RAS,
              "left-posterior-superior": lib.HL_SPACE_LPS, "lps": lib.HL_SPACE_LPS,
              "left-anterior-superior": lib.HL_SPACE_LAS, "las": lib.HL_SPACE_LAS}
    return Found(data, "xyz" if fortran else "zyx", place, spaces.get(str(header.get("space", "")).lower(), 0))


def _xarray(source: Any) -> Found:
    """Dimensions called x, y and z say the axes; evenly spaced coordinates the place."""
    axes = "".join(str(name).lower() for name in source.dims)
    named = sorted(axes) == ["x", "y", "z"]
    spacing, origin = [], {}
    for name, letter in zip(source.dims, axes if named else "zyx", strict=False):
        values = np.asarray(source.coords[name].values) if name in source.coords else None
        if values is None or values.dtype.kind not in "iuf" or len(values) < 2:
            spacing.append(1.0)
            origin[letter] = float(values[0]) if values is not None and values.dtype.kind in "iuf" else 0.0
            continue
        step = (float(values[-1]) - float(values[0])) / (len(values) - 1)
        if step == 0 or np.abs(np.diff(values.astype(float)) - step).max() > 1e-3 * abs(step):
            raise ValueError(f"the coordinates of '{name}' are not evenly spaced: interpolate them to a regular grid")
        spacing.append(step)
        origin[letter] = float(values[0])
    steps = dict(zip(axes if named else "zyx", spacing, strict=False))
    affine = [[steps[letter] if row == letter else 0.0 for letter in "xyz"] + [origin[row]] for row in "xyz"] if (
        len(steps) == 3) else None
    name = str(source.name) if source.name is not None else None
    array = np.asarray(source.data) if isinstance(source.data, np.ndarray) else _stored(source.data).array
    return Found(array, axes if named else None, {} if affine is None else {"affine": affine}, owner=source, name=name)


def _vtk(source: Any) -> Found:
    """vtkImageData and PyVista's: the active scalars of the points, else of the cells."""
    from vtkmodules.util.numpy_support import vtk_to_numpy

    dimensions, steps = list(source.GetDimensions()), list(source.GetSpacing())
    origin, direction = list(source.GetOrigin()), np.eye(3)
    if hasattr(source, "GetDirectionMatrix"):
        matrix = source.GetDirectionMatrix()
        direction = np.array([[matrix.GetElement(row, column) for column in range(3)] for row in range(3)])
    first = np.array(source.GetExtent()[::2], dtype=float)
    scalars = source.GetPointData().GetScalars()
    if scalars is None:
        scalars = source.GetCellData().GetScalars()
        dimensions = [max(size - 1, 1) for size in dimensions]
        first += 0.5
    if scalars is None:
        raise ValueError(f"{type(source).__name__} has no active scalars: set them, or give an array")
    values = vtk_to_numpy(scalars)
    if values.ndim > 1:
        raise ValueError(f"the active scalars have {values.shape[1]} components: give one of them as an array")
    place = {"spacing": steps[::-1], "direction": direction,
             "origin": (np.asarray(origin) + direction @ (first * steps)).tolist()}
    return Found(values.reshape(dimensions[::-1]), "zyx", place, owner=source, name=scalars.GetName())


def _has(*attributes: str) -> Any:
    return lambda source: all(hasattr(source, attribute) for attribute in attributes)


_READERS = [
    (_has("dataobj", "affine", "header"), _nibabel),
    (_has("GetSpacing", "GetOrigin", "GetDirection", "GetLargestPossibleRegion"), _itk),
    (_has("GetPixelIDTypeAsString", "GetSpacing", "GetOrigin", "GetDirection"), _itk),
    (_has("GetPointData", "GetDimensions", "GetSpacing", "GetOrigin"), _vtk),
    (_has("dims", "coords", "data"), _xarray),
    (lambda source: isinstance(source, tuple) and len(source) == 2 and isinstance(source[0], np.ndarray)
     and hasattr(source[1], "get"), _pynrrd),
]
