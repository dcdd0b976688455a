"""Makes volumes of grids that are no boxes of voxels: meshes of cells, and adaptive grids of patches."""
from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ._library import context, ffi, lib, made

__all__ = ["Cells", "Patches"]


def _pointer(kind: str, values: Any, dtype: str) -> tuple[Any, Any]:
    """The values as a C array, and the object that keeps them alive."""
    kept = np.ascontiguousarray(values, dtype)
    return ffi.cast(f"const {kind} *", kept.__array_interface__["data"][0]), kept


@dataclass(frozen=True)
class Cells:
    """A mesh of cells with values, which `Volume.from_cells` takes."""

    points: Any
    cells: Any
    types: Any
    values: Any

    def _corners(self) -> tuple[Any, Any]:
        """The corners of all cells, and for each cell the index after its last corner."""
        cells = np.asarray(self.cells)
        if cells.dtype.kind not in "iu":
            raise TypeError("cells are numbers of points: an array of whole numbers")
        if cells.ndim == 2:
            return cells.ravel(), np.arange(1, len(cells) + 1) * cells.shape[1]
        if cells.ndim != 1:
            raise ValueError(f"cells have the shape {cells.shape}: give (cells, corners), or VTK's list of each cell's number of corners and its corners")
        ends, at = [], 0
        while at < len(cells):
            ends.append(at)
            at += int(cells[at]) + 1
        if at > len(cells):
            raise ValueError("the list of cells ends within a cell")
        counts = np.array(ends, np.int64)
        return np.delete(cells, counts), np.cumsum(cells[counts])

    def handle(self) -> Any:
        """An hl_volume of the mesh."""
        points, values = np.asarray(self.points), np.asarray(self.values)
        if points.ndim != 2 or points.shape[1] != 3:
            raise ValueError(f"points have the shape {points.shape}: give (points, 3)")
        corners, ends = self._corners()
        types = np.broadcast_to(np.asarray(self.types, np.uint8), (len(ends),))
        if values.shape not in ((len(points),), (len(ends),)):
            raise ValueError(f"values have the shape {values.shape}: give one for each of {len(points)} points or {len(ends)} cells")
        description = ffi.new("hl_cells_description *")
        lib.hl_cells_description_defaults(description)
        description.points, keep_points = _pointer("double", points, "f8")
        description.types, keep_types = _pointer("unsigned char", types, "u1")
        description.ends, keep_ends = _pointer("int64_t", ends, "i8")
        description.corners, keep_corners = _pointer("int64_t", corners, "i8")
        description.values, keep_values = _pointer("double", values, "f8")
        description.point_count, description.cell_count, description.corner_count = len(points), len(ends), len(corners)
        description.of_cells = values.shape != (len(points),)
        return made(lib.hl_volume_create_cells, "hl_volume", lib.hl_volume_release, context, description)


@dataclass(frozen=True)
class Patches:
    """An adaptive grid, which `Volume.from_amr` takes."""

    patches: Iterable[tuple[int, Sequence[int], Any]]
    ratio: int | Sequence[int] = 2
    cells: Sequence[int] | None = None
    first: Sequence[int] = (0, 0, 0)
    origin: Sequence[float] = (0, 0, 0)
    spacing: float | Sequence[float] = 1

    def handle(self) -> Any:
        """An hl_volume of the grid."""
        patches = [(int(level), tuple(map(int, first)), np.ascontiguousarray(values, np.float32)) for level, first, values in self.patches]
        if not patches:
            raise ValueError("there is no patch")
        for _, first, values in patches:
            if values.ndim != 3 or len(first) != 3:
                raise ValueError("a patch is (level, (x, y, z) of its first cell, values [z][y][x])")
        levels = max(level for level, _, _ in patches) + 1
        ratios = [self.ratio] * (levels - 1) if isinstance(self.ratio, int) else list(self.ratio)
        if len(ratios) < levels - 1:
            raise ValueError(f"{levels} levels have {levels - 1} ratios: {len(ratios)} are given")
        coarse = [(first, values) for level, first, values in patches if level == 0]
        if self.cells is None and not coarse:
            raise ValueError("there is no patch of level 0: say how many cells of it the domain has by cells=(x, y, z)")
        count = self.cells or [max(first[a] + values.shape[2 - a] for first, values in coarse) - self.first[a] for a in range(3)]
        description, rows = ffi.new("hl_amr_description *"), ffi.new("hl_patch[]", len(patches))
        keep = ffi.new("int[]", ratios or [2])
        lib.hl_amr_description_defaults(description)
        description.levels, description.ratios = levels, keep
        description.first, description.count = list(map(int, self.first)), list(map(int, count))
        description.origin = list(map(float, self.origin))
        description.spacing = [float(step) for step in np.broadcast_to(np.asarray(self.spacing, float), (3,))]
        for row, (level, first, values) in zip(rows, patches, strict=True):
            row.level, row.first, row.count = level, first, values.shape[::-1]
            row.values = ffi.cast("const float *", values.__array_interface__["data"][0])
        description.patches, description.patch_count = rows, len(patches)
        return made(lib.hl_volume_create_amr, "hl_volume", lib.hl_volume_release, context, description)
