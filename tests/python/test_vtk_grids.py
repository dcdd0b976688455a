"""Grids as PyVista's readers give them: OpenFOAM's and EnSight's cases, in blocks, against the fields that they hold."""
from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import halflight as hl

from test_cells import blob, inner, linear, places_of

pyvista = pytest.importorskip("pyvista")

N = 12  # cells an edge of the unit cube


def header(kind: str, name: str) -> str:
    return f"FoamFile\n{{\n    version 2.0;\n    format ascii;\n    class {kind};\n    object {name};\n}}\n"


def foam_list(rows: list[str]) -> str:
    return f"{len(rows)}\n(\n" + "\n".join(rows) + "\n)\n"


def write_foam(folder: Path, field: Any) -> Path:
    """A case of OpenFOAM: a cube of N^3 hexahedra, whose faces are sorted as OpenFOAM wants them, and a field of its cells."""
    def point(i: int, j: int, k: int) -> int:
        return (k * (N + 1) + j) * (N + 1) + i

    cells = [(i, j, k) for k in range(N) for j in range(N) for i in range(N)]
    number = {cell: n for n, cell in enumerate(cells)}
    within: list[tuple[int, int, tuple[int, ...]]] = []
    outside: list[tuple[int, tuple[int, ...]]] = []
    for cell, owner in number.items():
        for axis in range(3):
            u, v = (np.eye(3, dtype=int)[(axis + 1) % 3], np.eye(3, dtype=int)[(axis + 2) % 3])
            for side in (0, 1):
                corner = np.array(cell) + side * np.eye(3, dtype=int)[axis]
                turn = [corner, corner + u, corner + u + v, corner + v]
                face = tuple(point(*p) for p in (turn if side else turn[::-1]))  # the normal points out of the owner
                beside = tuple(int(c) for c in np.array(cell) + (2 * side - 1) * np.eye(3, dtype=int)[axis])
                if beside not in number:
                    outside.append((owner, face))
                elif number[beside] > owner:
                    within.append((owner, number[beside], face))
    within.sort(key=lambda row: row[:2])
    mesh, zero, system = folder / "constant/polyMesh", folder / "0", folder / "system"
    for made in (mesh, zero, system):
        made.mkdir(parents=True)
    edge = [n / N for n in range(N + 1)]
    (mesh / "points").write_text(header("vectorField", "points") + foam_list([f"({x} {y} {z})" for z in edge for y in edge for x in edge]))
    faces = [row[2] for row in within] + [row[1] for row in outside]
    (mesh / "faces").write_text(header("faceList", "faces") + foam_list(["4(" + " ".join(map(str, face)) + ")" for face in faces]))
    (mesh / "owner").write_text(header("labelList", "owner") + foam_list([str(row[0]) for row in within] + [str(row[0]) for row in outside]))
    (mesh / "neighbour").write_text(header("labelList", "neighbour") + foam_list([str(row[1]) for row in within]))
    (mesh / "boundary").write_text(header("polyBoundaryMesh", "boundary") + foam_list(
        [f"walls {{ type wall; nFaces {len(outside)}; startFace {len(within)}; }}"]))
    values = [str(float(field(*((c + 0.5) / N for c in cell)))) for cell in cells]
    (zero / "T").write_text(header("volScalarField", "T") + "dimensions [0 0 0 0 0 0 0];\ninternalField nonuniform List<scalar>\n"
                            + foam_list(values) + ";\nboundaryField { walls { type zeroGradient; } }\n")
    vectors = [f"({value} 0 0)" for value in values]
    (zero / "U").write_text(header("volVectorField", "U") + "dimensions [0 1 -1 0 0 0 0];\ninternalField nonuniform List<vector>\n"
                            + foam_list(vectors) + ";\nboundaryField { walls { type zeroGradient; } }\n")
    (system / "controlDict").write_text(header("dictionary", "controlDict") + "startTime 0;\nendTime 0;\ndeltaT 1;\nwriteInterval 1;\n")
    case = folder / "case.foam"
    case.touch()
    return case


def write_ensight(folder: Path, field: Any) -> Path:
    """A case of EnSight Gold in ASCII: two parts of hexahedra, which together fill the unit cube, and a surface."""
    parts = []
    for low, high in ((0, N // 2), (N // 2, N)):
        z = np.arange(low, high + 1) / N
        grid = np.stack(np.meshgrid(z, np.arange(N + 1) / N, np.arange(N + 1) / N, indexing="ij"), -1)[..., ::-1].reshape(-1, 3)
        number = np.arange(len(grid)).reshape(len(z), N + 1, N + 1)
        corners = [(0, 0, 0), (0, 0, 1), (0, 1, 1), (0, 1, 0), (1, 0, 0), (1, 0, 1), (1, 1, 1), (1, 1, 0)]
        cells = np.stack([number[a : len(z) - 1 + a, b : N + b, c : N + c].ravel() for a, b, c in corners], 1)
        parts.append((grid, "hexa8", cells))
    parts.append((np.array([(0.0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)]), "quad4", np.array([(0, 1, 2, 3)])))
    geometry, scalars = ["geometry", "of the test", "node id assign", "element id assign"], ["T"]
    for n, (points, kind, cells) in enumerate(parts):
        geometry += ["part", f"{n + 1:10d}", f"part {n}", "coordinates", f"{len(points):10d}"]
        geometry += [f"{value:12.5e}" for value in points.T.ravel()]
        geometry += [kind, f"{len(cells):10d}"] + ["".join(f"{corner + 1:10d}" for corner in cell) for cell in cells]
        scalars += ["part", f"{n + 1:10d}", "coordinates"] + [f"{float(field(*point)):12.5e}" for point in points]
    folder.mkdir(parents=True)
    (folder / "a.geo").write_text("\n".join(geometry) + "\n")
    (folder / "a.scl").write_text("\n".join(scalars) + "\n")
    case = folder / "a.case"
    case.write_text("FORMAT\ntype: ensight gold\nGEOMETRY\nmodel: a.geo\nVARIABLE\nscalar per node: T a.scl\n")
    return case


def truth(field: Any, volume: hl.Volume) -> Any:
    return np.broadcast_to(field(*places_of(hl.info(volume))), np.asarray(volume).shape)


def test_openfoam(tmp_path: Path) -> None:
    reader = pyvista.OpenFOAMReader(str(write_foam(tmp_path / "foam", linear)))
    reader.set_active_time_value(0)
    case = reader.read()
    assert "internalMesh" in case.keys() and "boundary" in case.keys()
    volume = hl.Volume(case, array="T")
    voxels = np.asarray(volume)
    np.testing.assert_allclose(inner(voxels, 4), inner(truth(linear, volume), 4), atol=1e-5)
    np.testing.assert_allclose(np.array(voxels.shape), 2 * N, atol=1)
    lengths = np.asarray(hl.Volume(case, array="U"))  # of vectors along x
    np.testing.assert_allclose(inner(lengths, 4), np.abs(inner(voxels, 4)), atol=1e-5)


def test_ensight(tmp_path: Path) -> None:
    case = pyvista.EnSightReader(str(write_ensight(tmp_path / "ensight", linear))).read()
    assert len(case) == 3
    volume = hl.Volume(case, array="T")
    np.testing.assert_allclose(inner(np.asarray(volume)), inner(truth(linear, volume)), atol=2e-5)


def test_blocks_are_one_grid(tmp_path: Path) -> None:
    """The picture of parts is the picture of the whole."""
    size = [np.linspace(0, 1, N + 1)] * 3
    whole = pyvista.RectilinearGrid(*size).cast_to_unstructured_grid()
    whole.point_data["f"] = blob(*whole.points.T)
    halves = [whole.extract_cells(np.flatnonzero(side(whole.cell_centers().points[:, 2], 0.5))) for side in (np.less, np.greater)]
    parts = pyvista.MultiBlock([*halves, pyvista.Plane(), None])
    pictures = [np.asarray(hl.render(hl.Volume(source, array="f"), size=(48, 48)), float) for source in (whole, parts)]
    assert pictures[0].std() > 0.05
    assert np.abs(pictures[0] - pictures[1]).max() <= 1 / 255


def test_what_is_no_grid_of_cells(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="no block of cells with a volume"):
        hl.Volume(pyvista.MultiBlock([pyvista.Plane()]))
    case = pyvista.EnSightReader(str(write_ensight(tmp_path / "ensight", linear))).read()
    with pytest.raises(ValueError, match="has no array 'p': choose of T"):
        hl.Volume(case, array="p")


@pytest.mark.parametrize("kind", ["rectilinear", "image"])
def test_blocks_may_be_grids_along_the_axes(kind: str) -> None:
    """As in EnSight's cases: a block that is a rectilinear grid or an image holds the cells of the same curvilinear grid."""
    x, y, z = np.linspace(0, 1, 13) ** (2 if kind == "rectilinear" else 1), np.linspace(0, 2, 9), np.linspace(0, 1, 7)
    if kind == "rectilinear":
        grid = pyvista.RectilinearGrid(x, y, z)
    else:
        grid = pyvista.ImageData(dimensions=(13, 9, 7), spacing=(x[1], y[1], z[1]))
    grid["field"] = linear(*grid.points.T)
    blocks = pyvista.MultiBlock([grid])
    found, curvilinear = hl.Volume(blocks, array="field"), hl.Volume(grid.cast_to_structured_grid(), array="field")
    assert found.dimensions == curvilinear.dimensions
    assert np.array_equal(np.asarray(found), np.asarray(curvilinear), equal_nan=True)
