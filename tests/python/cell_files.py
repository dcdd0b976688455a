"""Writes meshes of cells as VTK's XML files: hexahedra, tetrahedra, wedges and pyramids that fill a cube, and curvilinear grids."""
from __future__ import annotations

import base64
import struct
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

NAMES = {np.dtype("f8"): "Float64", np.dtype("f4"): "Float32", np.dtype("i8"): "Int64", np.dtype("u1"): "UInt8"}
# the cells of a cube by its corners in VTK's order of hexahedra, and their types
CUBES = {"hexahedra": (12, [[0, 1, 2, 3, 4, 5, 6, 7]]), "voxels": (11, [[0, 1, 3, 2, 4, 5, 7, 6]]),
         "tetrahedra": (10, [[0, 1, 3, 4], [1, 2, 3, 6], [1, 3, 4, 6], [3, 4, 6, 7], [1, 4, 5, 6]]),
         "wedges": (13, [[0, 1, 2, 4, 5, 6], [0, 2, 3, 4, 6, 7]]),
         "pyramids": (14, [[0, 1, 2, 3, 8], [4, 7, 6, 5, 8], [0, 4, 5, 1, 8], [1, 5, 6, 2, 8], [2, 6, 7, 3, 8], [3, 7, 4, 0, 8]])}


def lattice(points: int, bend: float = 0) -> Any:
    """The points of a cube of edge 1, [z][y][x] as rows of x, y, z; bend moves inner points."""
    axis = np.linspace(0, 1, points)
    z, y, x = np.meshgrid(axis, axis, axis, indexing="ij")
    found = np.stack([x.ravel(), y.ravel(), z.ravel()], 1)
    inner = np.prod(np.sin(np.pi * found), axis=1)
    return found + bend * inner[:, None] * np.array([1, -0.5, 0.25])


def mesh(kind: str, points: int, bend: float = 0) -> tuple[Any, Any, Any]:
    """Points, cells by their corners, and the cells' type. Tetrahedra alternate, so that neighbours share faces."""
    places, (number, parts) = lattice(points, bend), CUBES[kind]
    n = points - 1
    k, j, i = (a.ravel() for a in np.meshgrid(*[np.arange(n)] * 3, indexing="ij"))
    steps = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]])
    corners = [((k + dz) * points + j + dy) * points + i + dx for dx, dy, dz in steps]
    if kind == "tetrahedra":  # every second cube is turned over
        odd = (i + j + k) % 2 == 1
        corners = [np.where(odd, corners[[1, 0, 3, 2, 5, 4, 7, 6][c]], corners[c]) for c in range(8)]
    if kind == "pyramids":
        middles = np.mean([places[c] for c in corners], axis=0)
        corners.append(len(places) + np.arange(len(middles)))
        places = np.concatenate([places, middles])
    cells = np.concatenate([np.stack([corners[c] for c in part], 1) for part in parts])
    return places, cells, np.full(len(cells), number, np.uint8)


def array(name: str, values: Any, encoding: str) -> str:
    values = np.ascontiguousarray(values)
    components = f' NumberOfComponents="{values.shape[1]}"' if values.ndim == 2 else ""
    if encoding == "ascii":
        text = " ".join(repr(float(v)) if values.dtype.kind == "f" else str(v) for v in values.ravel())
    else:
        text = base64.b64encode(struct.pack("<I", values.nbytes) + values.tobytes()).decode()
    return f'<DataArray type="{NAMES[values.dtype]}" Name="{name}"{components} format="{encoding}">{text}</DataArray>'


def write_cells(path: Path, places: Any, cells: Any, types: Any, at_points: dict[str, Any] | None = None,
                at_cells: dict[str, Any] | None = None, encoding: str = "binary") -> Path:
    ends = np.cumsum([cells.shape[1]] * len(cells)).astype("i8")
    text = ['<VTKFile type="UnstructuredGrid" byte_order="LittleEndian"><UnstructuredGrid>',
            f'<Piece NumberOfPoints="{len(places)}" NumberOfCells="{len(cells)}"><PointData>',
            *(array(name, values, encoding) for name, values in (at_points or {}).items()), "</PointData><CellData>",
            *(array(name, values, encoding) for name, values in (at_cells or {}).items()), "</CellData><Points>",
            array("Points", places, encoding), "</Points><Cells>", array("connectivity", cells.ravel().astype("i8"), encoding),
            array("offsets", ends, encoding), array("types", types, encoding), "</Cells></Piece></UnstructuredGrid></VTKFile>"]
    path.write_text("\n".join(text))
    return path


def write_curvilinear(path: Path, points: int, places: Any, values: Any) -> Path:
    extent = f"0 {points - 1} " * 3
    path.write_text(f'<VTKFile type="StructuredGrid" byte_order="LittleEndian"><StructuredGrid WholeExtent="{extent}"><Piece Extent="{extent}">'
                    f'<PointData>{array("density", values, "binary")}</PointData><Points>{array("Points", places, "binary")}</Points>'
                    "</Piece></StructuredGrid></VTKFile>")
    return path


def write_legacy(path: Path, places: Any, cells: Any, types: Any, at_points: dict[str, Any] | None = None,
                 at_cells: dict[str, Any] | None = None, encoding: str = "binary", version: str = "5.1") -> Path:
    """A legacy file. Before version 5.1 cells are one list of counts and points."""
    def numbers(values: Any) -> bytes:
        values = np.asarray(values).ravel()
        return " ".join(map(repr, values.tolist())).encode() if encoding == "ascii" else values.astype(values.dtype.newbyteorder(">")).tobytes()

    ends = np.arange(len(cells) + 1) * cells.shape[1]
    flat = np.insert(cells, 0, cells.shape[1], axis=1).astype("i4")
    parts: list[str | bytes] = [f"# vtk DataFile Version {version}\nmesh\n{'ASCII' if encoding == 'ascii' else 'BINARY'}\n",
                                f"DATASET UNSTRUCTURED_GRID\nPOINTS {len(places)} double\n", numbers(places)]
    if version == "5.1":
        parts += [f"\nCELLS {len(ends)} {cells.size}\nOFFSETS vtktypeint64\n", numbers(ends.astype("i8")),
                  "\nCONNECTIVITY vtktypeint64\n", numbers(cells.astype("i8"))]
    else:
        parts += [f"\nCELLS {len(cells)} {flat.size}\n", numbers(flat)]
    parts += [f"\nCELL_TYPES {len(types)}\n", numbers(types.astype("i4"))]
    for section, count, arrays in (("CELL_DATA", len(cells), at_cells or {}), ("POINT_DATA", len(places), at_points or {})):
        parts += [f"\n{section} {count}\n"] if arrays else []
        for name, values in arrays.items():
            parts += [f"SCALARS {name} double {values.size // count}\nLOOKUP_TABLE default\n", numbers(values), "\n"]
    path.write_bytes(b"".join(part.encode() if isinstance(part, str) else part for part in parts))
    return path


def values_at(field: Callable[..., Any], places: Any) -> Any:
    return np.asarray(field(*places.T), "f8")
