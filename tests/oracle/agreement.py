"""Volumes as judges read them, and the comparison with what dump_volume says of the same files."""
import itertools
import json
import os
import subprocess
import tempfile

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


def differences(case, seen, voxels_path):
    if seen["status"] != 0:
        return [seen["error"]]
    values = case.voxels.astype(np.float64)
    if case.voxels.dtype == np.float64:  # fractions are kept as float32; what floats cannot hold is not finite
        with np.errstate(over="ignore"):
            floats = values.astype(np.float32).astype(np.float64)
            values = np.where((np.abs(values) >= 2**24) & np.isfinite(floats), values, floats)
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
    tolerance = 2e-7 if case.choice and case.choice[-1] == -2 else 1e-7  # sums round three times
    if case.voxels.dtype.kind in "iu" and tolerance == 1e-7:
        tolerance = 0
    same = np.array_equal(finite, np.isfinite(found)) and np.allclose(found[finite], values[finite], tolerance, 0)
    return lines if same else lines + ["voxels differ"]


def run(program, name, cases):
    """The number of differences; judges' files are read by few processes, each of which reads many."""
    failures, count = 0, 0
    cases = iter(cases)
    while some := list(itertools.islice(cases, 40)):
        with tempfile.TemporaryDirectory() as folder:
            named = [case.path + ("#%d,%d,%d,%d" % case.choice if case.choice else "") for case in some]
            voxels = [os.path.join(folder, str(number)) for number in range(len(some))]
            words = [word for pair in zip(named, voxels) for word in pair]
            lines = subprocess.run([program, *words], check=True, capture_output=True, text=True).stdout.splitlines()
            for case, path, line, out in zip(some, named, lines, voxels, strict=True):
                for difference in differences(case, json.loads(line), out):
                    print("%s: %s" % (path, difference))
                    failures += 1
        count += len(some)
    print("%s: %d volumes, %d differences" % (name, count, failures), flush=True)
    return failures
