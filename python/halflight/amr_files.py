"""Reads adaptive grids from HDF5 files of FLASH, Chombo and Enzo by h5py.

Files are opened below the folder of the file that the caller names.
"""
from __future__ import annotations

import os
import re
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any, Unpack

import numpy as np

from ._hdf5 import open_file
from ._library import warn
from .errors import InputError

if TYPE_CHECKING:
    from .volume import Look, Volume

__all__ = ["open_amr"]

Patch = tuple[int, tuple[int, ...], Any]


def open_amr(path: str | os.PathLike[str], field: str | None = None, *, log: bool = False, finest: int | None = None, **look: Unpack[Look]) -> Volume:
    """An adaptive grid of FLASH, Chombo or Enzo in HDF5 files, which needs h5py. Plotfiles of AMReX are opened by `Volume`.

    Parameters
    ----------
    path : path
        FLASH's and Chombo's file, or Enzo's file of parameters or its `.hierarchy` file.
    field : str, optional
        The variable's name. Without a name, the density is read, or else the first variable, and a warning says which
        one.
    log : bool
        Whether the logarithms to base 10 of the cells' values are taken. A transfer function has 4096 steps over all values, which
        is too few for densities that differ by many powers of ten. Cells whose value is not above 0 are empty.
    finest : int, optional
        The finest level of refinement that is taken, where 0 is the coarsest one; by default all. Cells of finer levels than a
        picture can show cost time, since a picture has sheets as near to each other as the finest cells.
    **look
        Keywords of `Volume`.
    """
    from .volume import Volume

    if finest is not None and finest < 0:
        raise ValueError(f"finest is {finest}: levels begin at 0, the coarsest one")
    path = Path(path)
    hierarchy = path if path.name.endswith(".hierarchy") else path.with_name(path.name + ".hierarchy")
    if hierarchy == path or hierarchy.is_file():
        return Volume.from_amr(**_taken(_enzo(hierarchy, field), log, finest), **look)
    with open_file(path) as file:
        if "refine level" in file and "bounding box" in file:
            return Volume.from_amr(**_taken(_flash(file, field, finest), log, finest), **look)
        if "num_levels" in file.attrs and "level_0" in file:
            return Volume.from_amr(**_taken(_chombo(file, field), log, finest), **look)
    raise InputError(f"{path}: is no file of FLASH or Chombo: give one, or Enzo's .hierarchy file")


def _taken(grid: dict[str, Any], log: bool, finest: int | None) -> dict[str, Any]:
    """The grid without the levels beyond the finest one, and with logarithms if they are asked for."""
    patches: Iterator[Patch] = (patch for patch in grid["patches"] if finest is None or patch[0] <= finest)
    if log:
        patches = ((level, first, _logarithms(values)) for level, first, values in patches)
    return {**grid, "patches": patches}


def _logarithms(values: Any) -> np.ndarray[Any, Any]:
    values = np.asarray(values, dtype=np.float32)
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.where(values > 0, np.log10(values), np.nan).astype(np.float32)


def _chosen(names: list[str], field: str | None, path: Any) -> str:
    """The field's name: the wanted one, or else a density, or else the first field."""
    if field is not None:
        if field in names:
            return field
        raise InputError(f"{path}: there is no field {field!r}: choose one of {', '.join(names)}")
    if not names:
        raise InputError(f"{path}: there is no field in it: give a file with the cells' values")
    name = next((name for name in names if name.lower() in ("density", "dens", "rho")), names[0])
    if len(names) > 1:
        warn(f"{path}: {len(names)} fields: {name!r} is taken: choose by field=")
    return name


def _text(value: Any) -> str:
    value = np.asarray(value).ravel()[0]
    return value.decode("latin-1").strip() if isinstance(value, bytes) else str(value).strip()


def _flash(file: Any, field: str | None, finest: int | None) -> dict[str, Any]:
    """Reads blocks of equal numbers of cells in an octree. The blocks of level 1 are the largest. Leaves are taken, and
    other blocks of the finest level.
    """
    names = [_text(name) for name in np.asarray(file["unknown names"]).ravel()] if "unknown names" in file else []
    values = file[_chosen([name for name in names if name in file], field, file.filename)]
    levels, bounds = np.asarray(file["refine level"]), np.asarray(file["bounding box"], float)
    if values.ndim != 4 or bounds.shape != (len(levels), 3, 2) or len(values) != len(levels):
        raise InputError(f"{file.filename}: its blocks have {values.ndim - 1} dimensions: give a file of three")
    kinds = np.asarray(file["node type"]) if "node type" in file else np.ones(len(levels), int)
    low, high, size = bounds[:, :, 0].min(axis=0), bounds[:, :, 1].max(axis=0), np.array(values.shape[:0:-1])
    coarsest = int(levels.min())
    widest = bounds[levels == coarsest][0]
    step = (widest[:, 1] - widest[:, 0]) / size

    def patches() -> Iterator[Patch]:
        for block, level in enumerate(levels - coarsest):
            if kinds[block] == 1 or level == 0 or level == finest:
                first = np.rint((bounds[block, :, 0] - low) / step * 2.0**level).astype(int)
                yield int(level), tuple(first.tolist()), values[block]

    return {"patches": patches(), "cells": np.rint((high - low) / step).astype(int).tolist(), "origin": low.tolist(), "spacing": step.tolist()}


def _chombo(file: Any, field: str | None) -> dict[str, Any]:
    """Reads a file with a group for each level. A group has boxes of cells, and one array with the values of all
    boxes.
    """
    names = [_text(file.attrs[f"component_{n}"]) for n in range(int(file.attrs["num_components"]))]
    component = names.index(_chosen(names, field, file.filename))
    count, ratios, patches = int(file.attrs["num_levels"]), [], list[Patch]()
    domain = file["level_0"].attrs["prob_domain"]
    if "lo_k" not in (domain.dtype.names or ()):
        raise InputError(f"{file.filename}: its domain has two dimensions: give a file of three")
    low, high = ([int(domain[f"{end}_{axis}"]) for axis in "ijk"] for end in ("lo", "hi"))
    for level in range(count):
        group = file[f"level_{level}"]
        ratios.append(int(np.asarray(group.attrs["ref_ratio"]).ravel()[0]) if "ref_ratio" in group.attrs else 2)
        data, at = group["data:datatype=0"], 0
        ghosts = group["data_attributes"].attrs["outputGhost"] if "data_attributes" in group and "outputGhost" in group["data_attributes"].attrs else None
        around = [int(ghosts[name]) if ghosts is not None else 0 for name in (ghosts.dtype.names if ghosts is not None else "ijk")]
        offsets = np.asarray(group["data:offsets=0"]) if "data:offsets=0" in group else None
        for number, box in enumerate(np.asarray(group["boxes"])):
            first = [int(box[f"lo_{axis}"]) for axis in "ijk"]
            size = [int(box[f"hi_{axis}"]) - start + 1 + 2 * ghost for axis, start, ghost in zip("ijk", first, around, strict=True)]
            begin = int(offsets[number]) if offsets is not None else at
            cells = size[0] * size[1] * size[2]
            if min(size) < 1 or begin + (component + 1) * cells > len(data):
                raise InputError(f"{file.filename}: box {number} of level {level} has more cells than values")
            values = np.asarray(data[begin + component * cells : begin + (component + 1) * cells]).reshape(size[::-1])
            inner = tuple(slice(ghost, length - ghost) for ghost, length in zip(around[::-1], size[::-1], strict=True))
            patches.append((level, tuple(first), values[inner]))
            at += cells * len(names)
    step = float(file["level_0"].attrs["dx"])
    return {"patches": patches, "ratio": ratios[: count - 1], "first": low, "cells": [b - a + 1 for a, b in zip(low, high, strict=True)],
            "origin": [start * step for start in low], "spacing": step}


def _enzo(path: Path, field: str | None) -> dict[str, Any]:
    """Reads a text that lists grids by their edges. Each grid is a group in one of the files beside the text."""
    word = r"\s*=\s*(.+)"
    grids = []
    for text in re.split(r"^Grid\s*=\s*", path.read_text(errors="replace"), flags=re.MULTILINE)[1:]:
        found = {name: match[1].split() for name in ("GridLeftEdge", "GridRightEdge", "GridStartIndex", "GridEndIndex", "BaryonFileName")
                 if (match := re.search(name + word, text)) is not None}
        if len(found) == 5:
            edges = [np.array(found[name], float) for name in ("GridLeftEdge", "GridRightEdge")]
            size = np.array(found["GridEndIndex"], int) - np.array(found["GridStartIndex"], int) + 1
            grids.append((int(text.split()[0]), *edges, size, Path(found["BaryonFileName"][0]).name))
    if not grids or any(len(grid[1]) != 3 for grid in grids):
        raise InputError(f"{path}: lists no grids of three dimensions")
    steps = np.array([(right - left) / size for _, left, right, size, _ in grids])
    coarsest = steps.max(axis=0)
    roots = [grid for grid, step in zip(grids, steps, strict=True) if step[0] > 0.99 * coarsest[0]]
    low, high = np.min([grid[1] for grid in roots], axis=0), np.max([grid[2] for grid in roots], axis=0)
    patches, name = list[Patch](), None
    for (number, left, _, size, file), step in zip(grids, steps, strict=True):
        with open_file(path.parent / file) as opened:
            group = opened[f"Grid{number:08d}"]
            if name is None:
                name = _chosen([one for one in group if getattr(group[one], "ndim", 0) == 3], field, path)
            values = np.asarray(group[name])
        if values.shape != tuple(size[::-1]):
            raise InputError(f"{path}: grid {number} has {values.shape[::-1]} values for {tuple(size)} cells")
        level = int(np.rint(np.log2(coarsest[0] / step[0])))
        patches.append((level, tuple(np.rint((left - low) / step).astype(int).tolist()), values))
    return {"patches": patches, "cells": np.rint((high - low) / coarsest).astype(int).tolist(), "origin": low.tolist(), "spacing": coarsest.tolist()}
