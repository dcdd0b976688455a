"""Fields of yt's data sets as volumes: a covering grid, or a part of it, in the data set's own units."""
from __future__ import annotations

from typing import Any

import halflight
import numpy as np


def volume_of(source: Any, field: Any, *, level: int | None = None, unit: str = "code_length", log: bool | None = None,
              most_voxels: int = 1 << 27, **look: Any) -> halflight.Volume:
    """A field of a data set or of a region of it.

    Parameters
    ----------
    source : yt data set, region or covering grid
        Of a data set all, of a region its box.
    field : str or (type, name)
    level : int, optional
        Of refinement; by default the finest with at most `most_voxels`.
    unit : str
        Of lengths in the world.
    log : bool, optional
        The values' logarithms to base 10; by default what yt says of the field.
    **look
        Keywords of `halflight.Volume`.
    """
    data_set = getattr(source, "ds", source)
    if hasattr(source, "ActiveDimensions"):
        grid = source
    else:
        left = source.left_edge if hasattr(source, "left_edge") else data_set.domain_left_edge
        right = source.right_edge if hasattr(source, "right_edge") else data_set.domain_right_edge
        widths = np.asarray((right - left) / (data_set.domain_width / data_set.domain_dimensions), dtype=float)
        if level is None:
            level = int(getattr(data_set.index, "max_level", 0))
            while level > 0 and np.prod(np.ceil(widths * data_set.refine_by**level)) > most_voxels:
                level -= 1
        grid = data_set.covering_grid(level, left, np.maximum(np.rint(widths * data_set.refine_by**level), 1).astype(int))
    values = np.asarray(grid[field], dtype=np.float32)
    if log if log is not None else data_set._get_field_info(field).take_log:
        with np.errstate(divide="ignore"):
            values = np.where(values > 0, np.log10(values), np.nan).astype(np.float32)
    spacing = np.asarray(grid.dds.to(unit), dtype=float)
    origin = np.asarray(grid.left_edge.to(unit), dtype=float) + spacing / 2
    look.setdefault("name", field if isinstance(field, str) else field[-1])
    return halflight.Volume(values, axes="xyz", spacing=tuple(spacing), origin=tuple(origin), **look)
