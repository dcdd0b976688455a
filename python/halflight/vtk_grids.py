"""Reads the cells of grids of VTK and PyVista: unstructured grids, curvilinear grids, and blocks of such grids, which
readers of OpenFOAM and EnSight make.
"""
from __future__ import annotations

import warnings
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from .grids import Cells

__all__ = ["is_grid", "of_vtk"]

# VTK's numbers of the kinds of cells that have a volume (vtkCellType.h).
_VOLUMES = [10, 11, 12, 13, 14, 15, 16, 24, 25, 26, 27, 29, 31, 32, 33, 37, 41, 42, 71, 72, 73, 74, 78, 79, 80, 81]


def _is_a(source: Any, name: str) -> bool:
    # A grid is recognised by its class, because from VTK 9.5 on images and rectilinear grids also have methods that return points and cells.
    return bool(getattr(source, "IsA", lambda _: False)(name))


def _is_unstructured(source: Any) -> bool:
    return _is_a(source, "vtkUnstructuredGrid")


def _is_curvilinear(source: Any) -> bool:
    return _is_a(source, "vtkStructuredGrid")


def _is_of_blocks(source: Any) -> bool:
    return hasattr(source, "GetNumberOfBlocks") or hasattr(source, "GetNumberOfPartitions") or hasattr(source, "GetNumberOfPartitionedDataSets")


def is_grid(source: Any) -> bool:
    """Whether `of_vtk` can read this object."""
    return _is_of_blocks(source) or _is_unstructured(source) or _is_curvilinear(source)


def _with_points(source: Any) -> Any:
    """A block, with a point for each of its places also if it is a rectilinear grid or an image."""
    is_rectilinear = _is_a(source, "vtkRectilinearGrid")
    if not is_rectilinear and not _is_a(source, "vtkImageData"):
        return source
    from vtkmodules.vtkFiltersGeneral import vtkImageDataToPointSet, vtkRectilinearGridToPointSet

    convert = vtkRectilinearGridToPointSet() if is_rectilinear else vtkImageDataToPointSet()
    convert.SetInputData(source)
    convert.Update()
    return convert.GetOutput()


def _leaves(source: Any) -> Iterator[Any]:
    """The grids of cells among the blocks, in their order. Surfaces, such as OpenFOAM's patches, are left out."""
    for count, part in (("GetNumberOfBlocks", "GetBlock"), ("GetNumberOfPartitionedDataSets", "GetPartitionedDataSet"),
                        ("GetNumberOfPartitions", "GetPartition")):
        if hasattr(source, count):
            for n in range(getattr(source, count)()):
                yield from _leaves(getattr(source, part)(n))
            return
    source = _with_points(source)
    if source is not None and source.GetNumberOfCells() and (_is_curvilinear(source) or (_is_unstructured(source) and _has_volume(source))):
        yield source


def _types(source: Any) -> Any:
    from vtkmodules.util.numpy_support import vtk_to_numpy

    with warnings.catch_warnings():
        warnings.simplefilter("ignore", DeprecationWarning)  # VTK 9.6 has another name for this method
        return vtk_to_numpy(source.GetCellTypesArray())


def _has_volume(source: Any) -> bool:
    return bool(np.isin(_types(source), _VOLUMES).any())


def _structured_cells(size: Sequence[int]) -> Any:
    """The hexahedra of a grid of points [z][y][x]: (cells, 8)."""
    number = np.arange(size[0] * size[1] * size[2]).reshape(size[::-1])
    corners = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]
    parts = [number[z : size[2] - 1 + z, y : size[1] - 1 + y, x : size[0] - 1 + x].ravel() for x, y, z in corners]
    return np.stack(parts, 1)


@dataclass
class _Shape:
    """A grid's points, cells in VTK's flat list, and kinds of cells."""

    points: Any
    cells: Any
    types: Any


def _shape(source: Any) -> _Shape:
    from vtkmodules.util.numpy_support import vtk_to_numpy

    points = vtk_to_numpy(source.GetPoints().GetData())
    if _is_curvilinear(source):
        size = [0, 0, 0]
        source.GetDimensions(size)
        corners = _structured_cells(size)
        return _Shape(points, np.insert(corners, 0, 8, axis=1).ravel(), np.full(len(corners), 12, np.uint8))
    cells = source.GetCells()
    corners, starts = vtk_to_numpy(cells.GetConnectivityArray()), vtk_to_numpy(cells.GetOffsetsArray())
    flat = np.insert(corners.astype(np.int64), starts[:-1].astype(np.int64), np.diff(starts))
    return _Shape(points, flat, _types(source))


def _moved(cells: Any, by: int) -> Any:
    """VTK's flat list with other numbers of points."""
    moved, at = np.array(cells, np.int64), 0
    moved += by
    while at < len(cells):
        moved[at] = cells[at]
        at += int(cells[at]) + 1
    return moved


def _joined(shapes: Sequence[_Shape]) -> _Shape:
    if len(shapes) == 1:
        return shapes[0]
    before = np.cumsum([0] + [len(shape.points) for shape in shapes])
    return _Shape(np.concatenate([shape.points for shape in shapes]),
                  np.concatenate([_moved(shape.cells, int(by)) for shape, by in zip(shapes, before, strict=False)]),
                  np.concatenate([shape.types for shape in shapes]))


def _names(data: Any) -> list[str]:
    return [data.GetArrayName(n) for n in range(data.GetNumberOfArrays()) if data.GetArrayName(n)]


def _active(grids: Sequence[Any]) -> tuple[bool, str]:
    """Whether the active scalars belong to cells, and their name. If no grid has active scalars, the only array of one
    component is taken.
    """
    for grid in grids:
        for of_cells, data in ((False, grid.GetPointData()), (True, grid.GetCellData())):
            if data.GetScalars() is not None:
                return of_cells, data.GetScalars().GetName()
    found = {(of_cells, name) for grid in grids for of_cells, data in ((False, grid.GetPointData()), (True, grid.GetCellData()))
             for name in _names(data) if data.GetArray(name).GetNumberOfComponents() == 1}
    if len({name for _, name in found}) != 1:
        some = ", ".join(sorted({name for _, name in found}))
        raise ValueError(f"the grid has no active scalars: name an array by array=...{': ' + some if some else ''}")
    return min(found)


def _named(grids: Sequence[Any], name: str) -> tuple[bool, str]:
    """Whether an array of this name belongs to cells. If points and cells both have it, the reader has read the cells'
    values, and computed the others.
    """
    for of_cells, data in ((True, "GetCellData"), (False, "GetPointData")):
        if any(name in _names(getattr(grid, data)()) for grid in grids):
            return of_cells, name
    known = sorted({found for grid in grids for data in (grid.GetCellData(), grid.GetPointData()) for found in _names(data)})
    raise ValueError(f"the grid has no array {name!r}: choose of {', '.join(known)}")


def _values(grid: Any, of_cells: bool, name: str | None) -> Any:
    """A grid's values. They are NaN if the grid lacks the array. An array of several components gives the lengths of
    the vectors.
    """
    from vtkmodules.util.numpy_support import vtk_to_numpy

    data = grid.GetCellData() if of_cells else grid.GetPointData()
    array = data.GetArray(name) if name is not None else data.GetScalars()
    if array is None:
        return np.full(grid.GetNumberOfCells() if of_cells else grid.GetNumberOfPoints(), np.nan)
    values = np.asarray(vtk_to_numpy(array), float)
    return values if values.ndim == 1 else np.sqrt((values**2).sum(1))


def of_vtk(source: Any, array: str | None = None) -> tuple[Cells, str | None] | None:
    """The cells of a grid, with an array's values (default: the active scalars) and its name; None for anything but grids of cells."""
    if not is_grid(source):
        return None
    grids = list(_leaves(source)) if _is_of_blocks(source) else [source]
    if not grids:
        raise ValueError(f"{type(source).__name__} has no block of cells with a volume")
    of_cells, name = _named(grids, array) if array is not None else _active(grids)
    values = np.concatenate([_values(grid, of_cells, name) for grid in grids])
    joined = _joined([_shape(grid) for grid in grids])
    return Cells(joined.points, joined.cells, joined.types, values), name
