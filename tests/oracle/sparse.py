#!/usr/bin/python3
"""Sparse NanoVDB files stay sparse in memory, and give the pictures and numbers of the dense volume.

usage: sparse.py PROGRAM
Exit 77: python3-openvdb, numpy or nanovdb_convert (libnanovdb-tools) is missing.
"""
import json
import pathlib
import shutil
import subprocess
import sys
import tempfile

try:
    import numpy as np
    import pyopenvdb as vdb
except ImportError as absent:
    print("skipped:", absent)
    sys.exit(77)
if not shutil.which("nanovdb_convert"):
    print("skipped: no nanovdb_convert")
    sys.exit(77)

program = sys.argv[1]
SIDE, BALL = 208, 40


def run(*arguments):
    done = subprocess.run([program, *map(str, arguments)], capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"{arguments}: {done.stderr}")
    return done.stdout


def balls():
    """Two soft balls in opposite corners of a box, and nothing between them: the grid, and its voxels."""
    x, y, z = np.mgrid[:BALL, :BALL, :BALL] - (BALL - 1) / 2
    ball = np.clip(1.2 - np.sqrt(x * x + y * y + z * z) / 16, 0, 1).astype(np.float32)
    grid = vdb.FloatGrid()
    grid.name = "density"
    for corner in [(-50, 7, 1), (-50 + SIDE - BALL, 7 + SIDE - BALL, 1 + SIDE - BALL)]:
        grid.copyFromArray(ball, ijk=corner)
    return grid


def main(root):
    vdb.write(str(root / "balls.vdb"), grids=[balls()])
    subprocess.run(["nanovdb_convert", "-f", str(root / "balls.vdb"), str(root / "balls.nvdb")], check=True,
                   capture_output=True)
    run("convert", root / "balls.nvdb", root / "balls.nrrd")
    facts = [json.loads(run("info", "--json", root / name)) for name in ("balls.nvdb", "balls.nrrd")]
    for key in ("dimensions", "range", "mean", "histogram"):
        if key in facts[0] and json.dumps(facts[0][key]) != json.dumps(facts[1][key]):
            sys.exit(f"{key}: {facts[0][key]} of bricks, {facts[1][key]} of voxels")
    errors = [one.get("field_error") for one in facts]
    if errors != [{"value": 0, "of_range": 0, "kind": "exact", "source": "the dense grid of the voxels"}, None]:
        sys.exit(f"field errors: {errors}")
    worst = 0
    for render in ({"soft_method": "cascade"}, {"soft_method": "sublights"}, {"shadows": "hard"}, {"kernel": "linear"}):
        pictures, peaks = [], []
        for name in ("balls.nvdb", "balls.nrrd"):
            scene = {"halflight": 1, "image": {"width": 160, "height": 120}, "render": render, "volumes": [
                {"file": name, "transfer_function": {"opacity": [[0.1, 0], [0.5, 0.3], [1, 0.5]], "unit_distance": 8}}]}
            (root / "scene.json").write_text(json.dumps(scene))
            report = json.loads(run("render", root / "scene.json", "-o", root / "picture.npy", "--json"))
            pictures.append(np.load(root / "picture.npy"))
            peaks.append(report["peak_memory_bytes"])
        if pictures[0].max() <= 0:
            sys.exit(f"{render}: nothing is seen")
        worst = max(worst, float(np.abs(pictures[0] - pictures[1]).max()))
        print(render, "peaks:", peaks)
        # beside the pictures' buffers: bricks of a third of the box at most, in place of the box and its tables
        if peaks[1] - peaks[0] < SIDE**3 * 2:
            sys.exit(f"the sparse volume took {peaks[0]} bytes, the dense one {peaks[1]}")
    print("greatest difference:", worst)
    if not worst < 1e-6:
        sys.exit("the pictures differ")


with tempfile.TemporaryDirectory() as folder:
    main(pathlib.Path(folder))
