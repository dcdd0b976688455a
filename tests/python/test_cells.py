"""Meshes of cells as volumes: constants and linear fields are exact, kinds of cells agree, and broken files are refused."""
from __future__ import annotations

import json
import re
import subprocess
from dataclasses import astuple
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import halflight as hl

from cell_files import CUBES, mesh, lattice, values_at, write_cells, write_curvilinear, write_legacy


def blob(x: Any, y: Any, z: Any) -> Any:
    return np.exp(-((x - 0.45) ** 2 + (y - 0.5) ** 2 + (z - 0.55) ** 2) / (2 * 0.2**2))


def greatest_error(edge: float) -> float:
    """Of the blob, whose second derivatives are 1 / 0.2^2 at most: along each axis the interpolation between points an edge
    apart errs by edge^2 / 8 of them, and the B-spline of samples half an edge apart by (edge / 2)^2 / 6."""
    return 3 / 0.2**2 * (edge**2 / 8 + (edge / 2) ** 2 / 6)


def linear(x: Any, y: Any, z: Any) -> Any:
    return 3 + x - 2 * y + 0.5 * z


def places_of(info: hl.Info) -> tuple[Any, Any, Any]:
    """The world's coordinates of the voxels, to be broadcast to [z][y][x]."""
    x, y, z = (info.origin[a] + info.spacing[a] * np.arange(info.dimensions[a]) for a in range(3))
    return x[None, None, :], y[None, :, None], z[:, None, None]


def inner(voxels: Any, margin: int = 2) -> Any:
    """Voxels whose neighbours all lie in cells."""
    return voxels[(slice(margin, -margin),) * 3]


@pytest.mark.parametrize("kind", sorted(CUBES))
@pytest.mark.parametrize("bend", [0, 0.1])
def test_linear_fields_are_exact(tmp_path: Path, kind: str, bend: float) -> None:
    places, cells, types = mesh(kind, 9, bend)
    volume = hl.Volume(write_cells(tmp_path / "a.vtu", places, cells, types, {"f": values_at(linear, places)}))
    voxels, truth = np.asarray(volume), np.broadcast_to(linear(*places_of(hl.info(volume))), np.asarray(volume).shape)
    assert np.isfinite(voxels).all()
    np.testing.assert_allclose(inner(voxels), inner(truth), atol=3e-6)


@pytest.mark.parametrize("kind", sorted(CUBES))
def test_constants_are_exact(tmp_path: Path, kind: str) -> None:
    places, cells, types = mesh(kind, 6, 0.1)
    info = hl.info(hl.Volume(write_cells(tmp_path / "a.vtu", places, cells, types, {"f": np.full(len(places), 0.1)})))
    assert info.range == (float(np.float32(0.1)),) * 2 and info.nonfinite_count == 0


def test_spacing_is_half_of_an_edge(tmp_path: Path) -> None:
    places, cells, types = mesh("hexahedra", 11)
    info = hl.info(hl.Volume(write_cells(tmp_path / "a.vtu", places, cells, types, {"f": values_at(blob, places)})))
    assert all(18 <= n <= 22 for n in info.dimensions)
    np.testing.assert_allclose(info.origin - info.spacing / 2, 0, atol=1e-12)
    np.testing.assert_allclose(info.origin + info.spacing * (np.array(info.dimensions) - 0.5), 1, atol=1e-12)


@pytest.mark.parametrize("encoding", ["ascii", "binary"])
def test_kinds_of_cells_agree(tmp_path: Path, encoding: str) -> None:
    for kind in CUBES:
        places, cells, types = mesh(kind, 21)
        volume = hl.Volume(write_cells(tmp_path / f"{kind}.vtu", places, cells, types, {"f": values_at(blob, places)}, encoding=encoding))
        truth = np.broadcast_to(blob(*places_of(hl.info(volume))), np.asarray(volume).shape)
        assert np.abs(inner(np.asarray(volume) - truth)).max() < greatest_error(1 / 20), kind


def test_curvilinear_grids(tmp_path: Path) -> None:
    places = lattice(21, 0.1)
    volume = hl.Volume(write_curvilinear(tmp_path / "a.vts", 21, places, values_at(blob, places)))
    truth = np.broadcast_to(blob(*places_of(hl.info(volume))), np.asarray(volume).shape)
    assert np.abs(inner(np.asarray(volume) - truth)).max() < greatest_error((1 + 0.1 * np.pi) / 20)  # the bend stretches cells


def test_values_of_cells(tmp_path: Path) -> None:
    places, cells, types = mesh("hexahedra", 9)
    middles = places[cells].mean(axis=1)
    path = write_cells(tmp_path / "a.vtu", places, cells, types, None, {"f": values_at(linear, middles)})
    volume = hl.Volume(path)
    assert hl.info(volume).arrays[0].of_cells
    truth = np.broadcast_to(linear(*places_of(hl.info(volume))), np.asarray(volume).shape)
    np.testing.assert_allclose(inner(np.asarray(volume), 4), inner(truth, 4), atol=3e-6)


def test_numbers_of_points_are_not_taken(tmp_path: Path) -> None:
    """An array that the file calls the ids of its points is shown only where there is no other one."""
    places, cells, types = mesh("hexahedra", 3)
    path = write_cells(tmp_path / "a.vtu", places, cells, types, {"number": np.arange(float(len(places)))}, {"f": np.linspace(1, 2, len(cells))})
    for attribute, chosen in (("", "number"), ('GlobalIds="number"', "f"), ('PedigreeIds="number"', "f")):
        told = tmp_path / "b.vtu"
        told.write_text(path.read_text().replace("<PointData>", f"<PointData {attribute}>"))
        assert [array.name for array in hl.info(hl.Volume(told)).arrays if array.chosen] == [chosen]
    told.write_text(re.sub("<CellData>.*</CellData>", "", told.read_text(), flags=re.DOTALL))
    assert hl.info(hl.Volume(told)).range[1] > 20


def test_outside_of_cells_is_nothing(tmp_path: Path) -> None:
    places, cells, types = mesh("hexahedra", 9)
    kept = cells[places[cells].mean(axis=1)[:, 0] < 0.5]
    also = np.concatenate([kept, cells[-1:]])  # the far corner keeps the box
    volume = hl.Volume(write_cells(tmp_path / "a.vtu", places, also, types[: len(also)], {"f": values_at(linear, places)}))
    voxels, x = np.asarray(volume), places_of(hl.info(volume))[0].ravel()
    assert np.isnan(voxels[4, 4, x > 0.6]).all()
    assert np.isfinite(voxels[4, 4, x < 0.4]).all()


def test_vectors_are_magnitudes(tmp_path: Path) -> None:
    places, cells, types = mesh("tetrahedra", 5)
    vectors = np.broadcast_to(np.array([3.0, 0, 4]), (len(places), 3))
    path = write_cells(tmp_path / "a.vtu", places, cells, types, {"v": vectors})
    with pytest.warns(hl.HalflightWarning, match="magnitude"):
        assert hl.info(hl.Volume(path)).range == (5, 5)
    assert hl.info(hl.Volume(path, component=2)).range == (4, 4)


def spline_at(volume: hl.Volume, places: Any) -> Any:
    """The field at places of the world, from the coefficients that the voxels of a mesh of cells are; NaN where the field
    depends on a coefficient outside of the mesh."""
    info, coefficients = hl.info(volume), np.pad(np.asarray(volume), 3, constant_values=np.nan).astype(np.float64)
    at = (places - info.origin) / info.spacing
    first = np.floor(at).astype(int)
    t = at - first
    weights = np.stack([(1 - t) ** 3, 3 * t**3 - 6 * t**2 + 4, -3 * t**3 + 3 * t**2 + 3 * t + 1, t**3], 1) / 6
    total = np.zeros(len(places))
    for k, j, i in np.ndindex(4, 4, 4):
        weight = weights[:, i, 0] * weights[:, j, 1] * weights[:, k, 2]
        total += weight * coefficients[first[:, 2] + k + 2, first[:, 1] + j + 2, first[:, 0] + i + 2]
    return total


def places_in_cells(kind: str, places: Any, cells: Any, values: Any, count: int) -> tuple[Any, Any]:
    """Random places in cells, by random weights of the cells' corners, and the values there."""
    random = np.random.default_rng(1)
    chosen = cells[random.integers(0, len(cells), count)]
    if kind == "tetrahedra":
        weights = random.dirichlet(np.ones(4), count)
    else:
        u, v, w = random.random((3, count))
        at = [(1 - u) * (1 - v), u * (1 - v), u * v, (1 - u) * v]
        weights = np.stack([a * (1 - w) for a in at] + [a * w for a in at], 1)
    return (places[chosen] * weights[..., None]).sum(axis=1), (values[chosen] * weights).sum(axis=1)


@pytest.mark.parametrize("kind", ["hexahedra", "tetrahedra"])
@pytest.mark.parametrize(("bend", "rough"), [(0, False), (0.1, False), (0, True)])
def test_the_field_keeps_to_its_bound(tmp_path: Path, kind: str, bend: float, rough: bool) -> None:
    places, cells, types = mesh(kind, 11, bend)
    values = np.random.default_rng(0).random(len(places)) if rough else values_at(blob, places)
    volume = hl.Volume(write_cells(tmp_path / "a.vtu", places, cells, types, {"f": values}))
    told = hl.info(volume).field_error
    assert told is not None and told.value is not None and told.of_range is not None and told.kind == "bound"
    at, truth = places_in_cells(kind, places, cells, values, 100000)
    found = np.nanmax(np.abs(spline_at(volume, at) - truth))
    assert found <= told.value < 3 * found
    low, high = hl.info(volume).range
    assert told.of_range == pytest.approx(told.value / (high - low))


@pytest.mark.parametrize("kind", sorted(CUBES))
def test_the_bound_of_exact_fields_is_none(tmp_path: Path, kind: str) -> None:
    places, cells, types = mesh(kind, 9, 0.1)
    for field, most in ((linear, 2e-6), (lambda x, y, z: 0.1 + 0 * x, 0)):
        told = hl.info(hl.Volume(write_cells(tmp_path / "a.vtu", places, cells, types, {"f": values_at(field, places)}))).field_error
        assert told is not None and told.value is not None and told.value <= most


def test_a_layer_of_cells_has_no_bound(tmp_path: Path) -> None:
    places, cells, types = mesh("hexahedra", 9)
    layer = places[cells].mean(axis=1)[:, 2] < 1 / 8
    volume = hl.Volume(write_cells(tmp_path / "a.vtu", places, cells[layer], types[layer], {"f": values_at(linear, places)}))
    told = hl.info(volume).field_error
    assert told is not None and astuple(told) == (None, None, "bound", "the values between the corners of the cells")


def test_the_program_tells_the_bound(tmp_path: Path, program: str) -> None:
    Image = pytest.importorskip("PIL.Image")
    places, cells, types = mesh("tetrahedra", 11)
    path = write_cells(tmp_path / "a.vtu", places, cells, types, {"f": values_at(blob, places)})
    run = subprocess.run([program, "info", path, "--json"], check=True, capture_output=True, text=True)
    found = re.search(r"corners by ([0-9.e+-]+) at most", run.stderr)
    told, bound = json.loads(run.stdout)["field_error"], hl.info(hl.Volume(path)).field_error
    assert bound is not None and bound.value is not None
    assert told == {"value": bound.value, "of_range": bound.of_range, "kind": "bound", "source": bound.source}
    assert found is not None and float(found[1]) == float(f"{bound.value:.2g}")
    picture = tmp_path / "a.png"
    run = subprocess.run([program, "render", path, "-o", picture, "--size", "32x32", "--json"], check=True, capture_output=True, text=True)
    drawn = json.loads(run.stdout)["field_errors"]
    assert 0 < drawn[0]["opacity"] <= 1  # of the transfer function
    assert drawn == [{"volume": 0, "opacity": drawn[0]["opacity"]} | told] == json.loads(Image.open(picture).text["halflight:field_errors"])
    run = subprocess.run([program, "info", picture], check=True, capture_output=True, text=True)
    assert f"field       a.vtu: differs from {bound.source} by {bound.value:.2g} at most" in run.stdout
    run = subprocess.run([program, "info", picture, "--json"], check=True, capture_output=True, text=True)
    assert json.loads(run.stdout)["picture"]["field_errors"] == drawn
    subprocess.run([program, "render", path, "-o", picture, "--size", "32x32", "--no-metadata"], check=True, capture_output=True)
    assert "halflight:field_errors" not in Image.open(picture).text
    hl.render(path, size=(32, 32)).save(picture)
    assert json.loads(Image.open(picture).text["halflight:field_errors"]) == drawn
    shown = subprocess.run([program, "info", path], check=True, capture_output=True, text=True).stdout
    assert f"field       differs from {bound.source} by {bound.value:.2g} at most" in shown


def test_surfaces_of_fields_are_written(tmp_path: Path, program: str) -> None:
    """Cells are a volume, of which `convert` writes the surface where the field has a value."""
    places, cells, types = mesh("tetrahedra", 21)
    path = write_cells(tmp_path / "a.vtu", places, cells, types, {"f": 1 - np.linalg.norm(places - 0.5, axis=1)})
    subprocess.run([program, "convert", path, tmp_path / "a.stl", "--iso", "0.7"], check=True, capture_output=True)
    told = json.loads(subprocess.run([program, "info", tmp_path / "a.stl", "--json"], check=True, capture_output=True, text=True).stdout)
    np.testing.assert_allclose(told["volume"], 4 / 3 * np.pi * 0.3**3, rtol=0.04)


def test_surfaces_stay_meshes(tmp_path: Path, program: str) -> None:
    places, quads = lattice(2), np.array([[0, 1, 3, 2]])
    path = write_cells(tmp_path / "a.vtu", places, quads, np.array([9], np.uint8), {"f": values_at(linear, places)})
    with pytest.raises(hl.InputError, match="no cell has a volume"), pytest.warns(hl.HalflightWarning, match="without a volume"):
        hl.Volume(path)
    subprocess.run([program, "render", path, "-o", tmp_path / "a.png", "--size", "32x32"], check=True, capture_output=True)


@pytest.mark.parametrize(("old", "new", "words"), [
    ('NumberOfPoints="64"', 'NumberOfPoints="9999999999"', "promises"),
    ('NumberOfCells="27"', 'NumberOfCells="28"', "ends before|expected a number"),
    ('Name="offsets"', 'Name="offset"', "no array of offsets"),
    ("64</DataArray>\n</PointData>", "</DataArray>\n</PointData>", "."),
])
def test_broken_files_are_refused(tmp_path: Path, old: str, new: str, words: str) -> None:
    places, cells, types = mesh("hexahedra", 4)
    path = write_cells(tmp_path / "a.vtu", places, cells, types, {"f": np.full(len(places), 64, "i8")}, encoding="ascii")
    text = path.read_text()
    assert old in text
    path.write_text(text.replace(old, new))
    with pytest.raises((hl.InputError, MemoryError), match=words):
        hl.Volume(path)


def test_cells_that_name_no_point_are_refused(tmp_path: Path) -> None:
    places, cells, types = mesh("hexahedra", 4)
    cells[3, 5] = 64
    with pytest.raises(hl.InputError, match="names point 64: there are 64"):
        hl.Volume(write_cells(tmp_path / "a.vtu", places, cells, types, {"f": values_at(linear, places)}))


def test_arrays_are_the_file(tmp_path: Path) -> None:
    places, cells, types = mesh("wedges", 7, 0.1)
    values = values_at(blob, places)
    volume = hl.Volume(write_cells(tmp_path / "a.vtu", places, cells, types, {"f": values}))
    flat = np.insert(cells, 0, cells.shape[1], axis=1).ravel()
    for given in (cells, flat):
        np.testing.assert_array_equal(np.asarray(hl.Volume.from_cells(places, given, types, values)), np.asarray(volume))
    with pytest.raises(ValueError, match="one for each of 343 points or 432 cells"):
        hl.Volume.from_cells(places, cells, types, values[:-1])
    with pytest.raises(ValueError, match="names point 343"):
        hl.Volume.from_cells(places, cells + 1, types, values)


def test_grids_of_vtk(tmp_path: Path) -> None:
    pytest.importorskip("vtkmodules")
    from vtkmodules.vtkIOXML import vtkXMLStructuredGridReader, vtkXMLUnstructuredGridReader

    places, cells, types = mesh("tetrahedra", 7, 0.1)
    write_cells(tmp_path / "a.vtu", places, cells, types, {"density": values_at(blob, places)})
    write_curvilinear(tmp_path / "a.vts", 7, lattice(7, 0.1), values_at(blob, lattice(7, 0.1)))
    for reader, name in ((vtkXMLUnstructuredGridReader(), "a.vtu"), (vtkXMLStructuredGridReader(), "a.vts")):
        reader.SetFileName(str(tmp_path / name))
        reader.Update()
        grid = reader.GetOutput()
        grid.GetPointData().SetActiveScalars("density")
        np.testing.assert_array_equal(np.asarray(hl.Volume(grid)), np.asarray(hl.Volume(tmp_path / name)))


@pytest.mark.parametrize("encoding", ["ascii", "binary"])
@pytest.mark.parametrize("version", ["3.0", "5.1"])
def test_legacy_grids(tmp_path: Path, encoding: str, version: str) -> None:
    places, cells, types = mesh("wedges", 7, 0.1)
    at_points, at_cells = {"f": values_at(blob, places)}, {"g": np.arange(len(cells), dtype="f8")}
    old = write_legacy(tmp_path / "a.vtk", places, cells, types, at_points, at_cells, encoding, version)
    new = write_cells(tmp_path / "a.vtu", places, cells, types, at_points, at_cells)
    for name in ("f", "g"):
        np.testing.assert_array_equal(np.asarray(hl.Volume(old, array=name)), np.asarray(hl.Volume(new, array=name)))
    assert hl.info(hl.Volume(old)).range == hl.info(hl.Volume(new)).range  # points come first


def test_legacy_curvilinear_grids(tmp_path: Path) -> None:
    places = lattice(7, 0.1)
    values = values_at(blob, places)
    (tmp_path / "a.vtk").write_text("# vtk DataFile Version 3.0\nmesh\nASCII\nDATASET STRUCTURED_GRID\nDIMENSIONS 7 7 7\nPOINTS 343 double\n"
                                    + " ".join(map(repr, places.ravel().tolist())) + "\nPOINT_DATA 343\nSCALARS density double\n"
                                    + "LOOKUP_TABLE default\n" + " ".join(map(repr, values.tolist())) + "\n")
    write_curvilinear(tmp_path / "a.vts", 7, places, values)
    np.testing.assert_array_equal(np.asarray(hl.Volume(tmp_path / "a.vtk")), np.asarray(hl.Volume(tmp_path / "a.vts")))


@pytest.mark.parametrize(("old", "new", "words"), [
    ("POINTS 64", "POINTS 9999999999", "expected .POINTS number type"),
    ("POINTS 64", "POINTS 65", "."),
    ("CELL_TYPES 27", "CELL_TYPES 26", "."),
    ("CELLS 27 243", "CELLS 28 243", "cell 27 of CELLS has more points"),
    ("\n8 0 ", "\n999 0 ", "cell 0 of CELLS has more points"),
    ("POINT_DATA 64", "POINT_DATA 63", "is not read: save the values"),
    ("POINTS 64 double", "POINTS 64 bit", "are not read"),
    ("DATASET UNSTRUCTURED_GRID", "DATASET STRUCTURED_GRID\nDIMENSIONS 4 4 5", "DIMENSIONS 4 x 4 x 5, and POINTS has 64"),
])
def test_broken_legacy_grids_are_refused(tmp_path: Path, old: str, new: str, words: str) -> None:
    places, cells, types = mesh("hexahedra", 4)
    path = write_legacy(tmp_path / "a.vtk", places, cells, types, {"f": values_at(blob, places)}, encoding="ascii", version="3.0")
    text = path.read_text()
    assert old in text
    path.write_text(text.replace(old, new, 1))
    with pytest.raises((hl.InputError, hl.UnsupportedError, MemoryError), match=words):
        hl.Volume(path)


def test_legacy_grids_of_vtk(tmp_path: Path) -> None:
    pytest.importorskip("vtkmodules")
    from vtkmodules.vtkIOLegacy import vtkUnstructuredGridWriter
    from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader

    places, cells, types = mesh("tetrahedra", 7, 0.1)
    reader, writer = vtkXMLUnstructuredGridReader(), vtkUnstructuredGridWriter()
    reader.SetFileName(str(write_cells(tmp_path / "a.vtu", places, cells, types, {"density": values_at(blob, places)})))
    reader.Update()
    writer.SetInputData(reader.GetOutput())
    for binary in (False, True):
        for version in (42, 51):
            writer.SetFileName(str(tmp_path / "a.vtk"))
            writer.SetFileType(2 if binary else 1)
            writer.SetFileVersion(version)
            writer.Write()
            np.testing.assert_allclose(np.asarray(hl.Volume(tmp_path / "a.vtk")), np.asarray(hl.Volume(tmp_path / "a.vtu")), atol=1e-5)
