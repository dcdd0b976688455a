"""Fields of yt's data sets as volumes: adaptive grids at their own levels, or cells of one size, in the data set's own units."""
from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import halflight
import numpy as np

_BLOCK = 8  # cells along an edge of the boxes in which cells are handed over


def volume_of(source: Any, field: Any, *, level: int | None = None, unit: str = "code_length", log: bool | None = None,
              **look: Any) -> halflight.Volume:
    """A field of a data set or of a region of it.

    Patches (Enzo, FLASH, AMReX) and octrees (RAMSES, ART) keep their levels, and no seams show between these.

    Parameters
    ----------
    source : yt data set, region or covering grid
        Of a data set all, of a region the cells whose middles lie in it.
    field : str or (type, name)
    level : int, optional
        Of refinement: all cells get this level's size, in the box of the source.
    unit : str
        Of lengths in the world.
    log : bool, optional
        The values' logarithms to base 10; by default what yt says of the field.
    **look
        Keywords of `halflight.Volume`.
    """
    data_set = getattr(source, "ds", source)
    if log is None:
        log = data_set._get_field_info(field).take_log
    look.setdefault("name", field if isinstance(field, str) else field[-1])
    adaptive = level is None and not hasattr(source, "ActiveDimensions") and getattr(data_set.index, "max_level", 0) > 0
    return _of_cells(source, data_set, field, unit, log, look) if adaptive else _of_box(source, data_set, field, level or 0, unit, log, look)


def _numbers(values: Any, log: bool) -> np.ndarray[Any, Any]:
    values = np.asarray(values, dtype=np.float32)
    if not log:
        return values
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.where(values > 0, np.log10(values), np.nan).astype(np.float32)


def _of_box(source: Any, data_set: Any, field: Any, level: int, unit: str, log: bool, look: dict[str, Any]) -> halflight.Volume:
    """Cells of one size."""
    grid = source
    if not hasattr(source, "ActiveDimensions"):
        left = source.left_edge if hasattr(source, "left_edge") else data_set.domain_left_edge
        right = source.right_edge if hasattr(source, "right_edge") else data_set.domain_right_edge
        widths = np.asarray((right - left) / (data_set.domain_width / data_set.domain_dimensions), dtype=float)
        grid = data_set.covering_grid(level, left, np.maximum(np.rint(widths * data_set.refine_by**level), 1).astype(int))
    spacing = np.asarray(grid.dds.to(unit), dtype=float)
    origin = np.asarray(grid.left_edge.to(unit), dtype=float) + spacing / 2
    return halflight.Volume(_numbers(grid[field], log), axes="xyz", spacing=tuple(spacing), origin=tuple(origin), **look)


def _of_cells(source: Any, data_set: Any, field: Any, unit: str, log: bool, look: dict[str, Any]) -> halflight.Volume:
    """The cells that no finer ones cover, each at its own level."""
    cells = source if hasattr(source, "icoords") else data_set.all_data()
    places, levels, values = np.asarray(cells.icoords), np.asarray(cells.ires), _numbers(cells[field], log)
    if len(places) == 0:
        raise ValueError(f"no cell's middle lies in {source}")
    ratio = int(data_set.refine_by)
    coarse = places // ratio ** levels[:, None]
    first, count = coarse.min(axis=0), np.ptp(coarse, axis=0) + 1
    spacing = np.asarray((data_set.domain_width / data_set.domain_dimensions).to(unit), dtype=float)
    origin = np.asarray(data_set.domain_left_edge.to(unit), dtype=float) + first * spacing
    patches = [patch for level in np.unique(levels)
               for patch in _blocks(int(level), places[levels == level], values[levels == level], first * ratio**level, count * ratio**level)]
    return halflight.Volume.from_amr(patches, ratio=ratio, cells=count.tolist(), first=first.tolist(), origin=tuple(origin),
                                     spacing=tuple(spacing), **look)


def _blocks(level: int, places: Any, values: Any, low: Any, size: Any) -> Iterator[tuple[int, Any, Any]]:
    """The cells of a level in boxes that lie within low .. low + size - 1. Cells without a value are NaN, which leaves coarser ones as they are."""
    blocks, number = np.unique((places - low) // _BLOCK, axis=0, return_inverse=True)
    filled = np.full((len(blocks), _BLOCK, _BLOCK, _BLOCK), np.nan, dtype=np.float32)
    x, y, z = ((places - low) % _BLOCK).T
    filled[number.ravel(), z, y, x] = values
    for block, box in zip(blocks, filled):
        x, y, z = np.minimum(size - block * _BLOCK, _BLOCK)
        yield level, low + block * _BLOCK, box[:z, :y, :x]
