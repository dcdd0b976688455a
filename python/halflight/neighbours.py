"""Reads volumes of other packages. The objects are recognised by their methods, so that none of these packages is
imported or required.
"""
from __future__ import annotations

import sys
from typing import Any, NamedTuple

import numpy as np

from ._library import lib, warn


class Found(NamedTuple):
    """An array with the facts that its package knows about it. A fact is None if the package does not know it."""

    array: Any  # an array of NumPy, or an array that is read by slices (`is_stored`)
    axes: str | None = None
    place: dict[str, Any] = {}  # keywords of arrays.make_place(); the spacing is in the order of axes
    space: int = 0
    owner: object = None
    name: str | None = None


def find(source: Any) -> Found:
    """The array of `source`.

    Raises
    ------
    TypeError
        If `source` is no array, and has no array.
    """
    if isinstance(source, np.ndarray):
        return Found(source)
    if hasattr(source, "data_vars"):
        return _xarray(_variable(source, None))
    for matches, read in _READERS:
        if matches(source):
            return read(source)
    if hasattr(source, "__dlpack__") and not hasattr(source, "__array_interface__"):
        return Found(np.from_dlpack(source), owner=source)
    if is_stored(source):
        return Found(source)
    if hasattr(source, "__array__") or hasattr(source, "__array_interface__") or _has_buffer(source):
        return Found(np.asarray(source), owner=source)
    raise TypeError(f"{type(source).__name__} is no path, array or volume")


def _has_buffer(source: object) -> bool:
    try:
        memoryview(source)  # type: ignore[arg-type]
    except TypeError:
        return False
    return True


def is_stored(source: Any) -> bool:
    """Whether the array is read by slices, because it is an array of zarr, h5py or dask."""
    return not isinstance(source, np.ndarray) and hasattr(source, "shape") and hasattr(source, "dtype") and (
        hasattr(source, "chunks") or type(source).__module__.partition(".")[0] in ("h5py", "zarr"))


def read_whole(source: Any) -> np.ndarray[Any, Any]:
    """zarr, h5py and dask: the whole array."""
    size = int(np.prod(source.shape)) * np.dtype(source.dtype).itemsize
    if size >= 1 << 30:
        warn(f"{type(source).__name__}: all {size / 2**30:.1f} GiB are read into memory: limit_memory() has them read by "
             "pieces, and a slice with a step, such as array[::2, ::2, ::2], is smaller")
    return np.asarray(source[...])


def _nibabel(source: Any) -> Found:
    return Found(np.asanyarray(source.dataobj), "xyz", {"affine": source.affine}, lib.HL_SPACE_RAS, source)


def _itk(source: Any) -> Found:
    """Reads images of SimpleITK and ITK. The index x runs fastest, and world coordinates increase to the left, back
    and head.
    """
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


_CALLED = {  # the names of the axes of the world in models and microscopes
    "x": "x xc x_c lon longitude long rlon easting east i column columns col xt_ocean nav_lon".split(),
    "y": "y yc y_c lat latitude rlat northing north j row rows yt_ocean nav_lat".split(),
    "z": "z zc z_c lev level levels height altitude alt depth plev pressure isobaric k slice slices plane planes zlev".split(),
}


def _letter(source: Any, name: Any) -> str | None:
    """The axis of the world to which a dimension belongs, by its coordinate's CF attributes or by its name."""
    attributes = getattr(source.coords[name], "attrs", {}) if name in source.coords else {}
    said = str(attributes.get("axis", "")).lower()
    if said in ("x", "y", "z"):
        return said
    return next((letter for letter, names in _CALLED.items() if str(name).lower() in names), None)


def _axes_of(source: Any) -> str | None:
    """The letters of the dimensions, if each of x, y and z occurs once."""
    letters = [_letter(source, name) for name in source.dims]
    return "".join(str(one) for one in letters) if sorted(map(str, letters)) == ["x", "y", "z"] else None


def _variable(dataset: Any, name: str | None) -> Any:
    """The variable of an xarray.Dataset with this name or, without a name, the only variable that is a volume."""
    found = {str(key): value for key, value in dataset.data_vars.items() if sum(size > 1 for size in value.shape) >= 3}
    if name is None and len(found) == 1:
        return next(iter(found.values()))
    if name in found:
        return found[name]
    listed = ", ".join(f"'{key}'" for key in found)
    if name is not None:
        raise ValueError(f"array: the dataset has no volume '{name}'" + (f": use one of {listed}" if found else ""))
    raise ValueError(f"the dataset has {len(found)} volumes" + (f": choose one of {listed} with array=" if found else ""))


def variable(dataset: Any, name: str) -> Found:
    """A variable of an xarray.Dataset."""
    return _xarray(_variable(dataset, name))


def _warn_of_shape(source: Any, steps: dict[str, float], axes: str) -> None:
    """Warn if coordinates make the volume a plate or a needle, as coordinates in degrees and metres do together."""
    extents = {letter: abs(steps[letter]) * max(size - 1, 1) for letter, size in zip(axes, source.shape, strict=True)}
    if max(extents.values()) > 100 * min(extents.values()):
        said = ", ".join(f"{letter} {extents[letter]:g}" for letter in "xyz")
        warn(f"by its coordinates the volume is {said} wide: give spacing=, where their units differ")


def _xarray(source: Any) -> Found:
    """Reads an array of xarray. The names or CF attributes of the dimensions tell the axes. Evenly spaced coordinates
    tell the place.
    """
    if len(source.dims) > 3:  # the coordinate of a single time, member or channel
        single = [name for name, size in zip(source.dims, source.shape, strict=True) if size == 1 and _letter(source, name) is None]
        source = source.isel(dict.fromkeys(single[:len(source.dims) - 3], 0))
    axes = _axes_of(source) or "zyx"
    named = _axes_of(source) is not None
    spacing, origin = [], {}
    for name, letter in zip(source.dims, axes, strict=False):
        values = np.asarray(source.coords[name].values) if name in source.coords else None
        if values is not None and str(getattr(source.coords[name], "attrs", {}).get("positive", "")).lower() == "down" \
                and values.dtype.kind in "iuf":
            values = -values.astype(float)
        if values is None or values.dtype.kind not in "iuf" or len(values) < 2:
            spacing.append(1.0)
            origin[letter] = float(values[0]) if values is not None and values.dtype.kind in "iuf" else 0.0
            continue
        step = (float(values[-1]) - float(values[0])) / (len(values) - 1)
        if step == 0 or np.abs(np.diff(values.astype(float)) - step).max() > 1e-3 * abs(step):
            raise ValueError(f"the coordinates of '{name}' are not evenly spaced: interpolate them to a regular grid")
        spacing.append(step)
        origin[letter] = float(values[0])
    steps = dict(zip(axes, spacing, strict=False))
    if len(source.dims) == 3:
        _warn_of_shape(source, steps, axes)
    affine = [[steps[letter] if row == letter else 0.0 for letter in "xyz"] + [origin[row]] for row in "xyz"] if (
        len(source.dims) == 3) else None
    name = str(source.name) if source.name is not None else None
    array = source.data if is_stored(source.data) else np.asarray(source.data)
    return Found(array, axes if named else None, {} if affine is None else {"affine": affine}, owner=source, name=name)


def _vtk(source: Any) -> Found:
    """Reads a vtkImageData of VTK or PyVista: the active scalars of the points, or else of the cells."""
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
    values: np.ndarray[Any, Any] = vtk_to_numpy(scalars)
    colors = values.ndim == 2 and values.shape[1] in (3, 4) and values.dtype == np.uint8
    if values.ndim > 1 and not colors:
        raise ValueError(f"the active scalars have {values.shape[1]} components: give one of them as an array")
    place = {"spacing": steps[::-1], "direction": direction,
             "origin": (np.asarray(origin) + direction @ (first * steps)).tolist()}
    shape = dimensions[::-1] + ([values.shape[1]] if colors else [])
    return Found(values.reshape(shape), "zyx", place, owner=source, name=scalars.GetName())


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
