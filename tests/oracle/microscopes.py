#!/usr/bin/env python3
"""Compares the readers of microscopes' formats voxel for voxel with Python's own.

usage: microscopes.py DUMP_VOLUME
scripts/judges runs it where the judges are installed: mrcfile. Exit 0: all agree; 1: some do not.
"""
import itertools
import json
import os
import subprocess
import sys
import tempfile

import mrcfile
import numpy as np

SHAPE = (5, 4, 3)  # k, j, i: unequal, so that no two axes can be confused


class Case:
    """A file, what dump_volume is to choose of it, and what the judge reads: voxels [k][j][i], origin, axes as columns."""

    def __init__(self, path, voxels, origin=(0, 0, 0), axes=None, choice=None):
        self.path, self.voxels, self.choice = path, np.asarray(voxels), choice
        self.origin, self.axes = np.asarray(origin, float), np.eye(3) if axes is None else np.asarray(axes, float)


def sample(kind, shape=SHAPE, seed=1):
    random = np.random.default_rng(seed)
    if np.dtype(kind).kind == "f":
        voxels = random.normal(0, 1000, shape).astype(kind)
        voxels.flat[7:10] = np.nan, np.inf, -np.inf
        return voxels
    limits = np.iinfo(kind)
    voxels = random.integers(limits.min, limits.max, shape, dtype=kind, endpoint=True)
    voxels.flat[:2] = limits.min, limits.max
    return voxels


# ---------------------------------------------------------------- MRC


def mrc_read(path):
    """Voxels by mrcfile; the grid by MRC2014 from the header that mrcfile has parsed."""
    with mrcfile.open(path, permissive=True) as file:
        header, voxels = file.header, np.array(file.data)
        size = file.voxel_size
        lengths = np.array([size.x, size.y, size.z], float)
        order = [int(header.mapc) - 1, int(header.mapr) - 1, int(header.maps) - 1]
        axes = np.diag(lengths)[:, order]
        origin = np.array([header.origin.x, header.origin.y, header.origin.z], float)
        start = np.array([header.nxstart, header.nystart, header.nzstart], float)
    return voxels, origin if origin.any() else axes @ start, axes


def mrc_cases(folder):
    kinds = ["int8", "int16", "uint16", "float16", "float32", "complex64"]
    number = 0
    for kind, order, packed, placed in itertools.product(
            kinds, itertools.permutations((1, 2, 3)), (None, "gzip"), (False, True)):
        number += 1
        path = os.path.join(folder, "%d.mrc%s" % (number, ".gz" if packed else ""))
        voxels = sample("float32") + 1j * sample("float32", seed=2) if kind == "complex64" else sample(kind)
        voxels = np.nan_to_num(voxels, nan=3, posinf=4, neginf=5) if kind == "complex64" else voxels
        with mrcfile.new(path, compression=packed, overwrite=True) as file:
            file.set_data(voxels.astype(kind))
            if number % 3 == 0:
                file.set_extended_header(np.zeros(17 * number % 300, "V1"))
            file.voxel_size = (0.5, 1.25, 3.75)
            file.header.mapc, file.header.mapr, file.header.maps = order
            file.header.nxstart, file.header.nystart, file.header.nzstart = (-5, 2, 9)
            if placed:
                file.header.origin = (10.5, -2.25, 100)
        read, origin, axes = mrc_read(path)
        if kind == "complex64":
            read = np.abs(read.astype("complex128"))
        yield Case(path, read, origin, axes)
    for big in False, True:  # the other byte order, and four volumes in one file
        path = os.path.join(folder, "stack%d.mrc" % big)
        volumes = sample("int16", (4, *SHAPE))
        with mrcfile.new(path, overwrite=True) as file:
            file.set_data(volumes)
        with open(path, "rb") as file:
            content = file.read()
        if big:
            words = np.frombuffer(content[:1024], "<u4").astype(">u4")
            words[52:54] = np.frombuffer(b"MAP \x11\x11\0\0", ">u4")
            header = bytearray(words.tobytes())
            header[104:112] = content[104:112]
            header[224:] = content[224:1024]
            with open(path, "wb") as file:
                file.write(bytes(header) + volumes.astype(">i2").tobytes())
        with mrcfile.open(path, permissive=True) as file:
            read = np.array(file.data)
        assert read.shape == volumes.shape
        for time in range(4):
            yield Case(path, read[time], choice=(time, -1, -1))


# ---------------------------------------------------------------- comparison


def differences(case, seen, voxels_path):
    if seen["status"] != 0:
        return [seen["error"]]
    values = case.voxels.astype(np.float64)
    if case.voxels.dtype.itemsize > 2 and case.voxels.dtype != np.float32:  # kept as float32
        values = case.voxels.astype(np.float32).astype(np.float64)
    spacing = np.linalg.norm(case.axes, axis=0)
    checks = [("dimensions", seen["dimensions"], values.shape[::-1], 0),
              ("spacing", seen["spacing"], spacing, 1e-6 * spacing.max()),
              ("origin", seen["origin"], case.origin, 1e-6 * (1 + np.abs(case.origin).max())),
              ("direction", seen["direction"], (case.axes / spacing).ravel(), 1e-6)]
    lines = ["%s %s, expected %s" % (name, found, list(wanted)) for name, found, wanted, tolerance in checks
             if len(found) != len(wanted) or np.abs(np.subtract(found, wanted)).max() > tolerance]
    found = np.fromfile(voxels_path)
    if found.size != values.size:
        return lines + ["%d voxels, expected %d" % (found.size, values.size)]
    found = found.reshape(values.shape)
    finite = np.isfinite(values)
    same = np.array_equal(finite, np.isfinite(found)) and np.allclose(found[finite], values[finite], 1e-7, 0)
    return lines if same else lines + ["voxels differ"]


def run(program, name, cases):
    failures, count = 0, 0
    for case in cases:
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "voxels.f64")
            named = case.path + ("#%d,%d,%d" % case.choice if case.choice else "")
            output = subprocess.run([program, named, path], check=True, capture_output=True, text=True).stdout
            for difference in differences(case, json.loads(output), path):
                print("%s: %s" % (named, difference))
                failures += 1
        count += 1
    print("%s: %d volumes, %d differences" % (name, count, failures), flush=True)
    return failures


def main():
    program, failures = sys.argv[1], 0
    for name, cases in (("MRC", mrc_cases),):
        with tempfile.TemporaryDirectory() as folder:
            failures += run(program, name, cases(folder))
    return 1 if failures else 0


sys.exit(main())
