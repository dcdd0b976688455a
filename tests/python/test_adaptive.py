"""Adaptive grids: constants and linear fields are exact, mass is kept, and broken files are refused in words."""
from __future__ import annotations

import subprocess
from dataclasses import astuple
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import halflight as hl

from amr_files import levels, means, write_plotfile, write_vthb


def blob(x: Any, y: Any, z: Any) -> Any:
    return 1 + np.exp(-((x - 0.45) ** 2 + (y - 0.5) ** 2 + (z - 0.5) ** 2) / (2 * 0.12**2))


def linear(x: Any, y: Any, z: Any) -> Any:
    return 3 + x - 2 * y + 0.5 * z


def open_plotfile(folder: Path, *fields: Any, ratio: int = 2, kind: str = "<f8", **chosen: Any) -> hl.Volume:
    write_plotfile(folder, [f"field {n}" for n in range(len(fields))], [levels(field, ratio) for field in fields], ratio, kind=kind)
    return hl.Volume(folder, **chosen)


@pytest.mark.parametrize("ratio", [2, 4])
def test_place_and_size(tmp_path: Path, ratio: int) -> None:
    info = hl.info(open_plotfile(tmp_path / "plt", blob, ratio=ratio))
    assert info.dimensions == (32 * ratio,) * 3
    np.testing.assert_allclose(info.spacing, 1 / 32 / ratio)
    np.testing.assert_allclose(info.origin, 0.5 / 32 / ratio)
    assert info.arrays[0].name == "field 0" and info.arrays[0].of_cells
    assert info.nonfinite_count == 0


@pytest.mark.parametrize("kind", ["<f8", ">f8", "<f4"])
def test_constants_are_exact(tmp_path: Path, kind: str) -> None:
    info = hl.info(open_plotfile(tmp_path / "plt", lambda x, y, z: 0.75 + 0 * x, kind=kind))
    assert info.range == (0.75, 0.75)


@pytest.mark.parametrize("ratio", [2, 4])
def test_linear_fields_are_exact(tmp_path: Path, ratio: int) -> None:
    voxels = np.asarray(open_plotfile(tmp_path / "plt", linear, ratio=ratio))
    cells = 32 * ratio
    truth = means(linear, cells, (0, 0, 0), (cells,) * 3, 2)
    inner = (slice(4 * ratio, -4 * ratio),) * 3  # a domain's outermost cells go on beyond it
    np.testing.assert_allclose(voxels[inner], truth[inner], atol=2e-6)


@pytest.mark.parametrize("ratio", [2, 4])
def test_the_difference_is_told(tmp_path: Path, ratio: int) -> None:
    """A constant keeps the means of its cells, a smooth field nearly so, and a step loses much beside it."""
    exact = hl.info(open_plotfile(tmp_path / "a", lambda x, y, z: 0.75 + 0 * x, ratio=ratio)).field_error
    assert exact is not None and astuple(exact) == (0, 0, "exact", "the means over the cells")
    smooth, sharp = (hl.info(open_plotfile(tmp_path / name, field, ratio=ratio)).field_error for name, field in
                     (("b", blob), ("c", lambda x, y, z: 1 + np.sign(x - 0.5) + 0 * y + 0 * z)))
    assert smooth is not None and smooth.value is not None and 0 < smooth.value < 0.005
    assert sharp is not None and sharp.value is not None and 0.1 < sharp.value < 1


@pytest.mark.parametrize("ratio", [2, 4])
def test_mass_is_kept(tmp_path: Path, ratio: int) -> None:
    volume = open_plotfile(tmp_path / "plt", lambda x, y, z: blob(x, y, z) - 1, ratio=ratio)
    coarse, fine = levels(lambda x, y, z: blob(x, y, z) - 1, ratio)
    mass = sum(values.sum() for _, values in coarse) / 32**3
    assert abs(np.asarray(volume, np.float64).mean() / mass - 1) < 1e-3


def test_mass_of_thin_matter_is_kept() -> None:
    """A shell that is thinner than a cell has the mass of its cells, and no value that no cell has."""
    def shell(x: Any, y: Any, z: Any) -> Any:
        return 2 * np.exp(-(((np.sqrt((x - 0.5) ** 2 + (y - 0.5) ** 2 + (z - 0.5) ** 2) - 0.34) / 0.015) ** 2))

    cells = means(shell, 32, (0, 0, 0), (32,) * 3)
    # Two cells more, far from the matter, make two levels: the shell itself lies in one of them.
    volume = hl.Volume.from_amr([(0, (0, 0, 0), cells), (1, (0, 0, 0), np.zeros((2, 2, 2)))])
    voxels = np.asarray(volume, np.float64)
    assert abs(voxels.mean() / cells.mean() - 1) < 1e-6
    assert 0 <= voxels.min() and voxels.max() <= cells.max()
    # Where the shell crosses the faces of finer patches, the sum differs by less than the bar of .1 %.
    patches = [(level, first, 1 + values) for level, row in enumerate(levels(shell)) for first, values in row]
    everywhere = sum(values.sum() / 32**3 for level, _, values in patches if level == 0)
    fine, coarse = zip(*[(values.sum() / 64**3, sum_below(patches, first, values.shape)) for level, first, values in patches if level])
    mass = everywhere + sum(fine) - sum(coarse)
    assert abs(np.asarray(hl.Volume.from_amr(patches), np.float64).mean() / mass - 1) < 1e-3


def sum_below(patches: list[Any], first: Any, shape: Any) -> float:
    """The mass of the coarse cells below a finer patch: the finer cells replace them."""
    whole = np.zeros((32,) * 3)
    for level, at, values in patches:
        if level == 0:
            whole[tuple(slice(at[a], at[a] + values.shape[2 - a]) for a in (2, 1, 0))] = values
    return float(whole[tuple(slice(first[a] // 2, (first[a] + shape[2 - a]) // 2) for a in (2, 1, 0))].sum()) / 32**3


def test_a_component_by_name(tmp_path: Path) -> None:
    folder = tmp_path / "plt"
    volume = open_plotfile(folder, linear, lambda x, y, z: 7 + 0 * x, array="field 1")
    assert hl.info(volume).range == (7, 7)
    with pytest.raises(hl.InputError, match="field 0"):
        hl.Volume(folder, array="pressure")


def test_one_level_is_a_dense_volume(tmp_path: Path) -> None:
    coarse = levels(blob)[:1]
    write_plotfile(tmp_path / "plt", ["density"], [coarse])
    np.testing.assert_array_equal(np.asarray(hl.Volume(tmp_path / "plt")), means(blob, 32, (0, 0, 0), (32,) * 3).astype(np.float32))


@pytest.mark.parametrize(("file", "old", "new", "words"), [
    ("Header", "\n3\n", "\n2\n", "2 dimensions"),
    ("Header", "\n2 \n", "\n3 \n", "refined by 3"),
    ("Header", "((0,0,0) (31,31,31)", "((0,0,0) (15,31,31)", "beyond the domain"),
    ("Level_1/Cell_H", "FabOnDisk: Cell_D_00000", "FabOnDisk: ../../secret", "has no file"),
    ("Level_1/Cell_H", "(3 0", "(2000000 0", "as many boxes as it promises"),
    ("Level_1/Cell_H", "FabOnDisk: Cell_D_00000 0", "FabOnDisk: Cell_D_00000 99999999", "expected \"FAB\""),
    ("Level_1/Cell_D_00000", "(64 11 52", "(63 11 52", "expected \"FAB\""),
])
def test_broken_plotfiles_are_refused(tmp_path: Path, file: str, old: str, new: str, words: str) -> None:
    folder = tmp_path / "plt"
    open_plotfile(folder, blob)
    (tmp_path / "secret").write_bytes((folder / "Level_1" / "Cell_D_00000").read_bytes())
    bytes = (folder / file).read_bytes()
    assert old.encode() in bytes
    (folder / file).write_bytes(bytes.replace(old.encode(), new.encode()))
    with pytest.raises((hl.InputError, hl.UnsupportedError), match=words):
        hl.Volume(folder)


def test_cut_plotfiles_are_refused(tmp_path: Path) -> None:
    folder = tmp_path / "plt"
    open_plotfile(folder, blob)
    data = folder / "Level_1" / "Cell_D_00000"
    data.write_bytes(data.read_bytes()[:-100])
    with pytest.raises(hl.InputError, match="ends before"):
        hl.Volume(folder)


def test_patches_are_the_plotfile(tmp_path: Path) -> None:
    parts = levels(blob)
    write_plotfile(tmp_path / "plt", ["density"], [parts], kind="<f4")
    patches = [(level, first, values) for level, row in enumerate(parts) for first, values in row]
    volume = hl.Volume.from_amr(patches, spacing=1 / 32)
    np.testing.assert_array_equal(np.asarray(volume), np.asarray(hl.Volume(tmp_path / "plt")))
    np.testing.assert_allclose(hl.info(volume).origin, 1 / 128)
    with pytest.raises(ValueError, match="beyond the domain"):
        hl.Volume.from_amr([*patches, (1, (60, 0, 0), np.zeros((8, 8, 8)))])
    with pytest.raises(ValueError, match="no patch of level 0"):
        hl.Volume.from_amr(patches[-1:])


@pytest.mark.parametrize("ratio", [2, 4])
def test_overlapping_amr_of_vtk(tmp_path: Path, ratio: int) -> None:
    parts = levels(blob, ratio, 16) if ratio == 4 else levels(blob, ratio)
    cells = 16 if ratio == 4 else 32
    write_vthb(tmp_path / "a.vthb", parts, ratio, cells)
    patches = [(level, first, values) for level, row in enumerate(parts) for first, values in row]
    volume = hl.Volume(tmp_path / "a.vthb")
    np.testing.assert_array_equal(np.asarray(volume), np.asarray(hl.Volume.from_amr(patches, ratio=ratio, spacing=1 / cells)))
    np.testing.assert_allclose(hl.info(volume).spacing, 1 / cells / ratio)
    assert hl.info(volume).arrays[0].name == "density"
    (tmp_path / "a.vthb").write_text((tmp_path / "a.vthb").read_text().replace("box_1_0.vti", "../box_1_0.vti"))
    with pytest.raises((hl.InputError, OSError)):
        hl.Volume(tmp_path / "a.vthb")


def test_slices(tmp_path: Path, program: str) -> None:
    """A slice of a field at levels is the slice of the voxels that the field has."""
    levels_of_blob, voxels = open_plotfile(tmp_path / "plt", blob), means(blob, 64, (0, 0, 0), (64,) * 3)
    look: dict[str, Any] = {"slice": "z=0.5", "size": (48, 48), "clim": (1, 2)}
    pictures = [np.asarray(hl.render(levels_of_blob, **look))]
    pictures.append(np.asarray(hl.render(hl.Volume(voxels.astype(np.float32), spacing=1 / 64, origin=(1 / 128,) * 3), **look)))
    words = [program, "render", str(tmp_path / "plt"), "--slice", "z=0.5", "--size", "48x48", "--range", "1,2", "-o", str(tmp_path / "a.npy")]
    subprocess.run(words, check=True, capture_output=True)
    pictures.append(np.load(tmp_path / "a.npy"))
    assert pictures[0].shape == pictures[2].shape and pictures[1][..., 0].max() > 0.5
    for picture in (pictures[0], pictures[2]):
        assert np.abs(picture - pictures[1]).max() < 0.02
