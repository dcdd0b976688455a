#!/usr/bin/python3
"""Compares the reader of NanoVDB with OpenVDB: grids written by its Python module, converted by nanovdb_convert.

usage: nanovdb.py DUMP_VOLUME
Exit 77: python3-openvdb, numpy or nanovdb_convert (libnanovdb-tools) is missing.
"""
import json
import pathlib
import shutil
import struct
import subprocess
import sys
import tempfile

try:
    import numpy as np
    import pyopenvdb as vdb
    from agreement import Case, run
except ImportError as absent:
    print("skipped:", absent)
    sys.exit(77)
if not shutil.which("nanovdb_convert"):
    print("skipped: no nanovdb_convert")
    sys.exit(77)

PACKINGS = [[], ["-z"], ["-b"]]


def convert(grids, path, *options):
    source = path.with_suffix(".vdb")
    vdb.write(str(source), grids=grids)
    subprocess.run(["nanovdb_convert", "-f", *options, str(source), str(path)], check=True, capture_output=True)
    return path


def dense(grid, kind):
    """Voxels [k][j][i] of the box of active voxels, and its first voxel."""
    low, high = map(np.array, grid.evalActiveVoxelBoundingBox())
    shape = tuple(high - low + 1)
    voxels = np.zeros(shape + ((3,) if kind.endswith("3") else ()), {"bool": bool, "int": np.int32, "int64": np.int64,
                      "double": np.float64}.get(kind, np.float32))
    grid.copyToArray(voxels, ijk=tuple(int(v) for v in low))
    return np.moveaxis(voxels, [0, 1, 2], [2, 1, 0]), low


def fill(grid, voxels, ijk):
    grid.copyFromArray(voxels, ijk=ijk)
    grid.fill((-60, 60, -20), (-50, 70, -5), voxels.flat[0] if voxels.ndim == 3 else tuple(voxels[0, 0, 0]), True)


def scalar_cases(root):
    """Every kind that nanovdb_convert writes, each by every codec, under a turned and sheared map."""
    random = np.random.default_rng(1)
    matrix = [[0.5, 0.1, 0, 0], [0, 0.75, 0.2, 0], [0.3, 0, 2, 0], [10, -20, 30, 1]]  # rows: images of x, y, z
    axes = np.array(matrix)[:3, :3].T
    kinds = {"float": vdb.FloatGrid, "double": getattr(vdb, "DoubleGrid", None), "int": getattr(vdb, "Int32Grid", None),
             "int64": getattr(vdb, "Int64Grid", None), "bool": vdb.BoolGrid, "vec3": vdb.Vec3SGrid}
    for kind, make in kinds.items():
        if make is None:
            continue
        grid = make()
        voxels = random.normal(0, 100, (23, 19, 30) + ((3,) if kind == "vec3" else ()))
        voxels = voxels > 50 if kind == "bool" else voxels.astype(np.int32 if kind.startswith("int") else np.float64)
        fill(grid, voxels, (-11, 100, 5))
        grid.transform = vdb.createLinearTransform(matrix)
        grid.name = "of " + kind
        for number, options in enumerate(PACKINGS):
            path = convert([grid], root / ("%s%d.nvdb" % (kind, number)), *options)
            name = "vec3" if kind == "vec3" else kind
            expected, low = dense(grid, name + ("3" if kind == "vec3" and not name.endswith("3") else ""))
            origin = axes @ low + [10, -20, 30]
            if kind == "vec3":
                yield Case(str(path), np.linalg.norm(expected.astype(float), axis=-1).astype(np.float32), origin, axes,
                           (-1, -1, -1, -2))
                for component in range(3):
                    yield Case(str(path), expected[..., component], origin, axes, (-1, -1, -1, component))
            else:
                yield Case(str(path), expected.astype(np.uint8) if kind == "bool" else expected, origin, axes)


def quantised_cases(root):
    """The quantised kinds, held against what nanovdb_convert makes of them on the way back."""
    grid = vdb.createLevelSetSphere(radius=20, center=(5, -3, 70), voxelSize=0.5)
    for kind in "fp4", "fp8", "fp16", "fpN":
        path = convert([grid], root / ("%s.nvdb" % kind), "--" + kind)
        back = root / ("%s-back.vdb" % kind)
        told = subprocess.run(["nanovdb_convert", "-f", str(path), str(back)], capture_output=True)
        if told.returncode != 0 or not back.exists():
            print("%s: nanovdb_convert does not read it back" % kind)
            continue
        read = vdb.readAll(str(back))[0][0]
        expected, low = dense(read, "float")
        yield Case(str(path), expected, np.array(low) * 0.5, np.eye(3) * 0.5)
    yield from level_set(root)


def level_set(root):
    grid = vdb.createLevelSetSphere(radius=60, voxelSize=0.5)
    path = convert([grid], root / "sphere.nvdb")
    expected, low = dense(grid, "float")
    yield Case(str(path), expected, np.array(low) * 0.5, np.eye(3) * 0.5)


def damaged_boxes(root):
    """A box of active voxels that is damaged is cut to the regions of 128^3 voxels that the tree has."""
    grid = vdb.FloatGrid()
    low, high = (-3, 5, 7), (60, 50, 40)
    grid.fill(low, high, 2.5, True)
    path = convert([grid], root / "box.nvdb")
    content, box = path.read_bytes(), struct.pack("<6i", *low, *high)
    for change in ((0, 0, 0, 4000, 4000, 4000), (-4000, -4000, -4000, 0, 0, 0)):
        wrong = [stated + more for stated, more in zip((*low, *high), change)]
        damaged = root / ("box%d.nvdb" % wrong[5])
        damaged.write_bytes(content.replace(box, struct.pack("<6i", *wrong)))
        first, last = np.maximum(wrong[:3], (-128, 0, 0)), np.minimum(wrong[3:], 127)
        expected = np.zeros(last - first + 1, np.float32)
        expected[tuple(slice(a - f, b - f + 1) for a, b, f in zip(low, high, first))] = 2.5
        yield Case(str(damaged), np.moveaxis(expected, [0, 1, 2], [2, 1, 0]), first)


def check_names(program, root):
    """Of several grids, the one called density; others by their names; damaged files give errors."""
    grids = []
    for name, value in ("heat", 1.5), ("density", 2.5):
        grid = vdb.FloatGrid()
        grid.fill((0, 0, 0), (9, 9, 9), value, True)
        grid.name = name
        grids.append(grid)
    path = convert(grids, root / "two.nvdb", "-z")
    info = subprocess.run([program, str(path), "-"], capture_output=True, text=True).stdout
    failures = [] if json.loads(info)["range"][1] == 2.5 else ["density is not taken"]
    content, paths = path.read_bytes(), []
    for n in range(0, len(content), max(1, len(content) // 300)):
        flipped = bytearray(content)
        flipped[n] ^= 1 << n % 8
        for kind, data in ("cut", content[:n]), ("changed", bytes(flipped)):
            paths.append(root / ("%s%d.nvdb" % (kind, n)))
            paths[-1].write_bytes(data)
    words = [word for each in paths for word in (str(each), "-")]
    lines = subprocess.run([program, *words], capture_output=True, text=True, errors="replace").stdout.splitlines()
    failures += [] if len(lines) == len(paths) else ["ended at %s" % paths[len(lines)].name]
    print("\n".join(failures) if failures else "names and damage: as expected")
    return len(failures)


def main():
    program = sys.argv[1]
    root = pathlib.Path(tempfile.mkdtemp(prefix="halflight-nanovdb-"))
    try:
        failures = run(program, "NanoVDB", scalar_cases(root)) + run(program, "quantised", quantised_cases(root))
        failures += run(program, "damaged boxes", damaged_boxes(root))
        failures += check_names(program, root)
    finally:
        shutil.rmtree(root, ignore_errors=True)
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
