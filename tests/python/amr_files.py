"""Writes adaptive grids as codes do: plotfiles of AMReX."""
from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np

Patch = tuple[Sequence[int], Any]  # the first cell (x, y, z) in the level's index space, and the cells' values [z][y][x]


def means(field: Callable[..., Any], cells: int, first: Sequence[int], count: Sequence[int], points: int = 4) -> Any:
    """The means of a field over cells of the unit cube, which has `cells` along an edge: [z][y][x]."""
    x, y, z = ((first[a] + (np.arange(count[a] * points) + 0.5) / points) / cells for a in range(3))
    values = np.broadcast_to(field(x[None, None, :], y[None, :, None], z[:, None, None]), (len(z), len(y), len(x)))
    return values.reshape(count[2], points, count[1], points, count[0], points).mean((1, 3, 5))


def levels(field: Callable[..., Any], ratio: int = 2, cells: int = 32) -> list[list[Patch]]:
    """A coarse level over the unit cube, in eight patches, and a finer level around the cube's middle."""
    half, fine = cells // 2, cells * ratio
    coarse = [((x, y, z), means(field, cells, (x, y, z), (half,) * 3)) for z in (0, half) for y in (0, half) for x in (0, half)]
    boxes = [((8, 8, 8), (8, 16, 16)), ((16, 8, 8), (8, 8, 16)), ((16, 16, 12), (4, 8, 8))] if cells >= 24 else [((4, 4, 4), (8, 8, 4))]
    finer = []
    for first, count in boxes:
        first, count = tuple(ratio * n for n in first), tuple(ratio * n for n in count)
        finer.append((first, means(field, fine, first, count)))
    return [coarse, finer]


def write_plotfile(folder: Path, names: Sequence[str], components: Sequence[list[list[Patch]]], ratio: int = 2,
                   cells: int = 32, kind: str = "<f8") -> None:
    """components: for each name the levels' patches, all with the same boxes. The world is the unit cube."""
    layout = {"<f8": "((8, (64 11 52 0 1 12 0 1023)),(8, (8 7 6 5 4 3 2 1)))", ">f8": "((8, (64 11 52 0 1 12 0 1023)),(8, (1 2 3 4 5 6 7 8)))",
              "<f4": "((8, (32 8 23 0 1 9 0 127)),(4, (4 3 2 1)))"}[kind]
    count = len(components[0])
    sizes = [cells * ratio ** level for level in range(count)]
    boxes = " ".join(f"((0,0,0) ({n - 1},{n - 1},{n - 1}) (0,0,0))" for n in sizes)
    lines = ["HyperCLaw-V1.1", str(len(names)), *names, "3", "0.25", str(count - 1), "0 0 0 ", "1 1 1 ",
             f"{ratio} " * (count - 1), boxes + " ", "0 " * count, *(f"{1 / n:.17g} " * 3 for n in sizes), "0", "0"]
    for level in range(count):
        os.makedirs(folder / f"Level_{level}")
        text, data, places = ["1", "1", str(len(names)), "0", f"({len(components[0][level])} 0"], b"", []
        for number, (first, values) in enumerate(components[0][level]):
            last = [first[a] + values.shape[2 - a] - 1 for a in range(3)]
            box = f"(({first[0]},{first[1]},{first[2]}) ({last[0]},{last[1]},{last[2]}) (0,0,0))"
            text.append(box)
            places.append(len(data))
            data += f"FAB {layout}{box} {len(names)}\n".encode()
            data += b"".join(np.ascontiguousarray(part[level][number][1]).astype(kind).tobytes() for part in components)
        text += [")", str(len(places)), *(f"FabOnDisk: Cell_D_00000 {place}" for place in places), "", ""]
        (folder / f"Level_{level}" / "Cell_D_00000").write_bytes(data)
        (folder / f"Level_{level}" / "Cell_H").write_text("\n".join(text), newline="\n")
        lines += [f"{level} {len(places)} 0.25", "0", f"Level_{level}/Cell"]
    (folder / "Header").write_text("\n".join(lines) + "\n", newline="\n")


def write_vthb(path: Path, parts: list[list[Patch]], ratio: int = 2, cells: int = 32) -> None:
    """VTK's overlapping AMR over the unit cube, with a file for each box."""
    lines = ['<VTKFile type="vtkOverlappingAMR" version="1.1" byte_order="LittleEndian"><vtkOverlappingAMR origin="0 0 0" grid_description="XYZ">']
    for level, row in enumerate(parts):
        step = 1 / cells / ratio**level
        lines.append(f'<Block level="{level}" spacing="{step} {step} {step}">')
        for index, (first, values) in enumerate(row):
            ends = [(first[a], first[a] + values.shape[2 - a]) for a in range(3)]
            name, extent = f"box_{level}_{index}.vti", " ".join(f"{low} {high}" for low, high in ends)
            box = " ".join(f"{low} {high - 1}" for low, high in ends)
            lines.append(f'<DataSet index="{index}" amr_box="{box}" file="{name}"/>')
            numbers = " ".join(repr(float(value)) for value in np.asarray(values, np.float32).ravel())
            (path.parent / name).write_text(
                f'<VTKFile type="ImageData"><ImageData WholeExtent="{extent}" Origin="0 0 0" Spacing="{step} {step} {step}"><Piece Extent="{extent}">'
                f'<CellData><DataArray type="Float32" Name="density" format="ascii">{numbers}</DataArray></CellData></Piece></ImageData></VTKFile>')
        lines.append("</Block>")
    path.write_text("\n".join([*lines, "</vtkOverlappingAMR></VTKFile>"]))
