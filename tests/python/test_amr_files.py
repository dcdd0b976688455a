"""FLASH's, Chombo's and Enzo's files give the volume that their patches give."""
from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import halflight as hl

from amr_files import levels, means

h5py = pytest.importorskip("h5py")


def blob(x: Any, y: Any, z: Any) -> Any:
    return 1 + np.exp(-((x - 0.45) ** 2 + (y - 0.5) ** 2 + (z - 0.5) ** 2) / (2 * 0.12**2))


def patches(ratio: int = 2) -> list[Any]:
    return [(level, first, values) for level, row in enumerate(levels(blob, ratio)) for first, values in row]


def test_chombo(tmp_path: Path) -> None:
    box = np.dtype([(f"{end}_{axis}", "i4") for end in ("lo", "hi") for axis in "ijk"])
    with h5py.File(tmp_path / "a.hdf5", "w") as file:
        file.attrs.update(num_levels=2, num_components=2, component_0=np.bytes_("vx"), component_1=np.bytes_("density"))
        for level, row in enumerate(levels(blob)):
            group, cells = file.create_group(f"level_{level}"), 32 * 2**level
            group.attrs.update(dx=1 / cells, ref_ratio=2)
            group.attrs["prob_domain"] = np.array((0, 0, 0, cells - 1, cells - 1, cells - 1), box)
            ends = [(*first, *(first[a] + values.shape[2 - a] - 1 for a in range(3))) for first, values in row]
            group["boxes"] = np.array(ends, box)
            group["data:datatype=0"] = np.concatenate([np.concatenate([0 * values.ravel(), values.ravel()]) for _, values in row])
    with pytest.warns(hl.HalflightWarning, match="'density' is taken"):
        volume = hl.open_amr(tmp_path / "a.hdf5")
    np.testing.assert_array_equal(np.asarray(volume), np.asarray(hl.Volume.from_amr(patches())))
    np.testing.assert_allclose(hl.info(volume).origin, 1 / 128)
    coarse = hl.open_amr(tmp_path / "a.hdf5", "density", finest=0)
    np.testing.assert_array_equal(np.asarray(coarse), np.asarray(hl.Volume.from_amr([patch for patch in patches() if patch[0] == 0])))
    assert hl.info(coarse).dimensions == (32, 32, 32)
    with pytest.raises(ValueError, match="finest is -1"):
        hl.open_amr(tmp_path / "a.hdf5", "density", finest=-1)
    with pytest.raises(hl.InputError, match="choose one of vx, density"):
        hl.open_amr(tmp_path / "a.hdf5", "temperature")


def test_flash(tmp_path: Path) -> None:
    blocks = [(1, (x, y, z)) for z in (0, 1) for y in (0, 1) for x in (0, 1)] + [(2, (x, y, z)) for z in (0, 1) for y in (0, 1) for x in (0, 1)]
    values = np.array([means(blob, 16 * level, tuple(8 * n for n in at), (8, 8, 8)) for level, at in blocks])
    bounds = np.array([[[n / 2 / level, (n + 1) / 2 / level] for n in at] for level, at in blocks])
    with h5py.File(tmp_path / "a.h5", "w") as file:
        file["refine level"], file["node type"] = [level for level, _ in blocks], [2] + [1] * 15
        file["bounding box"], file["dens"] = bounds, values
        file["unknown names"] = np.array([[b"dens"]])
    volume = hl.open_amr(tmp_path / "a.h5")
    same = [(level - 1, tuple(8 * n for n in at), part) for (level, at), part in zip(blocks, values, strict=True)]
    np.testing.assert_array_equal(np.asarray(volume), np.asarray(hl.Volume.from_amr(same, spacing=1 / 16)))
    assert hl.info(volume).dimensions == (32, 32, 32)
    coarse = hl.open_amr(tmp_path / "a.h5", finest=0)  # also the block that finer blocks cover
    np.testing.assert_array_equal(np.asarray(coarse), np.asarray(hl.Volume.from_amr([patch for patch in same if patch[0] == 0], spacing=1 / 16)))


def test_enzo(tmp_path: Path) -> None:
    text = ""
    for number, (level, first, values) in enumerate(patches(), 1):
        step, size = 1 / 32 / 2**level, values.shape[::-1]
        with h5py.File(tmp_path / "data.cpu0000", "a") as file:
            file[f"Grid{number:08d}/Density"] = values
        rows = {"GridStartIndex": (3, 3, 3), "GridEndIndex": tuple(n + 2 for n in size), "GridLeftEdge": tuple(n * step for n in first),
                "GridRightEdge": tuple((n + m) * step for n, m in zip(first, size, strict=True)), "BaryonFileName": ("./data.cpu0000",)}
        text += f"\nGrid = {number}\n" + "".join(f"{name} = {' '.join(map(str, row))} \n" for name, row in rows.items())
    (tmp_path / "data.hierarchy").write_text(text)
    volume = hl.open_amr(tmp_path / "data.hierarchy")
    np.testing.assert_array_equal(np.asarray(volume), np.asarray(hl.Volume.from_amr(patches())))
    (tmp_path / "data").write_text("InitialTime = 0\n")  # the file of parameters, by which other programs open the data
    np.testing.assert_array_equal(np.asarray(hl.open_amr(tmp_path / "data")), np.asarray(volume))
    logs = [(level, first, np.log10(values.astype(np.float32))) for level, first, values in patches()]
    np.testing.assert_array_equal(np.asarray(hl.open_amr(tmp_path / "data", log=True)), np.asarray(hl.Volume.from_amr(logs)))
    coarse = hl.open_amr(tmp_path / "data", finest=0)
    np.testing.assert_array_equal(np.asarray(coarse), np.asarray(hl.Volume.from_amr([patch for patch in patches() if patch[0] == 0])))


def test_other_files_are_refused(tmp_path: Path) -> None:
    with h5py.File(tmp_path / "a.h5", "w") as file:
        file["voxels"] = np.zeros((4, 4, 4))
    with pytest.raises(hl.InputError, match="no file of FLASH or Chombo"):
        hl.open_amr(tmp_path / "a.h5")
