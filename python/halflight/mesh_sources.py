"""Reads meshes of other packages: data sets of VTK and PyVista, and meshes of trimesh and meshio. The objects are
recognised by their methods, so that none of these packages is required.
"""
from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from . import colors
from .transfer import colormap_points

__all__ = ["Surface", "find", "painted"]

Rows = np.ndarray[Any, Any]


class Surface(NamedTuple):
    """Triangles, lines and single points, with the arrays that lie on them.

    Arrays of points have a row for each of `points`. Arrays of cells have a row for each single point, then for each
    line, then for each triangle, which is VTK's order.
    """

    points: Rows
    triangles: Rows
    lines: Sequence[Rows] = ()  # the lines, each as a list of indices of points
    vertices: Rows = np.zeros(0, np.int64)  # the single points, as indices of points
    normals: Rows | None = None
    of_points: Mapping[str, Rows] = {}
    of_cells: Mapping[str, Rows] = {}
    active: str | None = None


def find(source: Any) -> Surface:
    """The surface of `source`.

    Raises
    ------
    TypeError
        If it is no mesh.
    """
    if hasattr(source, "GetCellData") and hasattr(source, "GetPoint"):
        return _of_vtk(source)
    if hasattr(source, "points") and hasattr(source, "triangulate"):
        plain = source.triangulate()
        return Surface(np.asarray(plain.points), np.asarray(plain.faces).reshape(-1, 4)[:, 1:])
    if hasattr(source, "points") and hasattr(source, "cells_dict"):
        return _of_meshio(source)
    if hasattr(source, "vertices") and hasattr(source, "faces"):
        painted = getattr(getattr(source, "visual", None), "vertex_colors", None)
        own = getattr(getattr(source, "visual", None), "kind", None) == "vertex" and painted is not None
        found = {"vertex_colors": np.asarray(painted)} if own else {}
        return Surface(np.asarray(source.vertices), np.asarray(source.faces), of_points=found,
                       active="vertex_colors" if own else None)
    if hasattr(source, "GetBlock") or hasattr(source, "n_blocks"):
        raise TypeError(f"{type(source).__name__} has several blocks: give one of them, or combine() it")
    raise TypeError(f"{type(source).__name__} is no path and no mesh: give vertices and triangles")


def _of_meshio(source: Any) -> Surface:
    triangles = np.asarray(source.cells_dict.get("triangle", np.zeros((0, 3), int)))
    quads = np.asarray(source.cells_dict.get("quad", np.zeros((0, 4), int)))
    both = np.vstack([triangles, quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
    cells = {name: np.concatenate([by_type.get("triangle", [])] + 2 * [by_type.get("quad", [])])
             for name, by_type in getattr(source, "cell_data_dict", {}).items()}
    return Surface(np.asarray(source.points), both, of_points=dict(getattr(source, "point_data", {})), of_cells=cells)


def _polydata(source: Any) -> Any:
    """A vtkPolyData. For other data sets it is their surface, as extract_surface() gives it."""
    from vtkmodules.vtkFiltersGeometry import vtkGeometryFilter

    if hasattr(source, "GetPolys"):
        return source
    outside = vtkGeometryFilter()
    outside.SetInputData(source)
    outside.Update()
    return outside.GetOutput()


def _triangles(plain: Any) -> Any:
    """A vtkPolyData of the triangles alone."""
    from vtkmodules.vtkFiltersCore import vtkTriangleFilter

    triangles = vtkTriangleFilter()
    triangles.SetInputData(plain)
    triangles.PassVertsOff()
    triangles.PassLinesOff()
    triangles.Update()
    return triangles.GetOutput()


def _cells(cells: Any) -> list[Rows]:
    """The point numbers of each cell of a vtkCellArray."""
    from vtkmodules.util.numpy_support import vtk_to_numpy

    if cells.GetNumberOfCells() == 0:
        return []
    ends: Any = vtk_to_numpy(cells.GetOffsetsArray())
    return np.split(vtk_to_numpy(cells.GetConnectivityArray()), ends[1:-1])


def _arrays(data: Any) -> dict[str, Rows]:
    from vtkmodules.util.numpy_support import vtk_to_numpy

    found = {}
    for n in range(data.GetNumberOfArrays()):
        array = data.GetArray(n)
        if array is not None and array.GetName():
            found[array.GetName()] = vtk_to_numpy(array)
    return found


def _of_vtk(source: Any) -> Surface:
    """Reads a vtkPolyData as it is, and other data sets by their surface."""
    from vtkmodules.util.numpy_support import vtk_to_numpy

    plain = _polydata(source)
    if plain.GetNumberOfPoints() == 0:
        raise ValueError(f"{type(source).__name__} has no points: there is nothing to see")
    points = vtk_to_numpy(plain.GetPoints().GetData())
    cut = _triangles(plain)
    triangles = _cells(cut.GetPolys())
    vertices, lines = _cells(plain.GetVerts()), _cells(plain.GetLines())
    # A cell of several single points counts as several cells.
    before = [len(cell) for cell in vertices] + len(lines) * [1]
    cells, of_triangles = _arrays(plain.GetCellData()), _arrays(cut.GetCellData())
    of_cells = {name: np.concatenate([np.repeat(values[:len(before)], before, axis=0), of_triangles.get(name, values[:0])])
                for name, values in cells.items()}
    normals = plain.GetPointData().GetNormals()
    active = source.GetPointData().GetScalars()
    active = source.GetCellData().GetScalars() if active is None else active
    return Surface(points, np.vstack(triangles) if triangles else np.zeros((0, 3), np.int64), lines,
                   np.concatenate(vertices) if vertices else np.zeros(0, np.int64),
                   None if normals is None else vtk_to_numpy(normals),
                   _arrays(plain.GetPointData()), of_cells,
                   active.GetName() if active is not None else None)


class Painted(NamedTuple):
    """Colours of the rows of an array, [n][4]: linear RGB and opacity."""

    rows: Rows
    of_cells: bool


def _array_of(place: str, surface: Surface, scalars: Any) -> tuple[Rows, bool]:
    """The array whose name is `scalars`, or `scalars` itself if it is an array, and whether it lies on cells."""
    cells = len(surface.vertices) + len(surface.lines) + len(surface.triangles)
    if isinstance(scalars, str):
        if scalars in surface.of_points:
            return np.asarray(surface.of_points[scalars]), False
        if scalars in surface.of_cells:
            return np.asarray(surface.of_cells[scalars]), True
        from ._words import nearest

        known = [*surface.of_points, *surface.of_cells]
        raise ValueError(f"{place}scalars: the mesh has no array '{scalars}'" + (nearest(scalars, known) if known else ""))
    values = np.asarray(scalars)
    if len(values) == len(surface.points):
        return values, False
    if len(values) == cells:
        return values, True
    raise ValueError(f"{place}scalars: {len(values)} values for {len(surface.points)} vertices and {cells} cells: "
                     "give one for each vertex or for each cell")


def painted(place: str, surface: Surface, scalars: Any, cmap: Any, clim: Any, log_scale: bool = False,
            nan_color: Any = 0.5) -> Painted:
    """The colours of an array's values, or the array itself if it holds 8-bit colours."""
    values, of_cells = _array_of(place, surface, scalars)
    if values.ndim == 2 and values.shape[1] in (3, 4) and values.dtype == np.uint8:
        linear = values / 255.0
        linear[:, :3] = colors.to_linear(linear[:, :3])
        opacity = linear[:, 3:] if linear.shape[1] == 4 else np.ones((len(linear), 1))
        return Painted(np.hstack([linear[:, :3], opacity]), of_cells)
    if values.ndim == 2 and values.shape[1] == 1:
        values = values[:, 0]
    if values.ndim == 2:
        # Vectors are shown by their lengths, as files and PyVista show them.
        values = np.sqrt((values.astype(float) ** 2).sum(axis=1))
    if values.ndim != 1 or values.dtype.kind not in "biuf":
        raise TypeError(f"{place}scalars: {values.dtype} of the shape {values.shape} are no numbers for each vertex or cell")
    return Painted(map_values(place, values.astype(np.float64), cmap, clim, log_scale, nan_color), of_cells)


def map_values(place: str, values: Rows, cmap: Any, clim: Any, log_scale: bool, nan_color: Any) -> Rows:
    """The colours of numbers, [n][4]."""
    finite = values[np.isfinite(values)]
    if clim is None:
        clim = (float(finite.min()), float(finite.max())) if len(finite) else (0.0, 1.0)
    from ._settings import numbers_of

    low, high = numbers_of(f"{place}clim", clim, 2)
    if not low <= high:
        raise ValueError(f"{place}clim: {low:g} is not below {high:g}")
    if log_scale:
        if not low > 0:
            raise ValueError(f"{place}clim: {low:g} is not above 0, as log_scale wants it")
        low, high = math.log(low), math.log(high)
        with np.errstate(divide="ignore", invalid="ignore"):
            values = np.where(values > 0, np.log(np.maximum(values, 1e-300)), -np.inf)
    points = colors.sampled(f"{place}cmap", cmap, 0.0, 1.0)
    table = np.array(points if points is not None else colormap_points(cmap))
    along = np.clip((values - low) / (high - low) if high > low else np.zeros_like(values), 0, 1)
    shown = np.ones((len(values), 4))
    for channel in range(3):
        shown[:, channel] = np.interp(np.nan_to_num(along), table[:, 0], table[:, 1 + channel])
    shown[np.isnan(values), :3] = colors.linear_color(f"{place}nan_color", nan_color)
    return shown
