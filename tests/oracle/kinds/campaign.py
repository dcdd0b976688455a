"""What the campaigns of kinds share: reading by the program, checks, and their count for each kind.

A campaign is a file beside this one. It writes variants of a kind of file with a judge's own library, or byte by byte where no
library writes them, and holds what the program reads against what the judge reads."""
import json
import pathlib
import shutil
import subprocess
import sys
import tempfile

import numpy as np

DUMP_VOLUME, DUMP_MESH, PROGRAM = sys.argv[1:4]
root = pathlib.Path(tempfile.mkdtemp(prefix="halflight-kinds-"))
counts, wrong = {}, []


def run(*words):
    return subprocess.run([str(word) for word in words], capture_output=True, text=True, timeout=120)


def count(kind, name, problem):
    """Counts a variant; problem: what is wrong, or nothing."""
    right, total = counts.get(kind, (0, 0))
    counts[kind] = right + (not problem), total + 1
    if problem:
        wrong.append(f"{kind}: {name}: {problem}")
        print("not ok -", wrong[-1])


def read(path, *options):
    """(what info tells, voxels [z][y][x], what was said); None for the first two where the file was refused."""
    told = run(PROGRAM, "info", "--json", path, *options)
    if told.returncode != 0:
        return None, None, told.stderr
    info = json.loads(told.stdout)
    choice = {"--time": -1, "--channel": -1, "--level": -1, "--component": -1}
    choice.update((word, number) for word, number in zip(options[::2], options[1::2]) if word in choice)
    out = root / "voxels"
    run(DUMP_VOLUME, "%s#%s,%s,%s,%s" % (path, *choice.values()), out)
    return info, np.fromfile(out).reshape(info["dimensions"][::-1]), told.stderr


def lps(info):
    """The grid's origin and axes in the space of ITK and DICOM, left-posterior-superior."""
    turn = {"RAS": [-1, -1, 1], "LAS": [1, -1, 1]}.get(info["space"], [1, 1, 1])
    steps = np.array(info["direction"]) * info["spacing"]
    return np.array(info["origin"]) * turn, (steps.T * turn).T


def volume(kind, name, path, voxels, spacing=None, origin=None, axes=None, options=(), tolerance=0, said=None):
    """Holds a volume against voxels [z][y][x], and its place (LPS; axes: the steps along i, j, k as columns) where it is given."""
    info, found, told = read(path, *options)
    if info is None:
        count(kind, name, f"refused: {told.strip()}")
        return None
    problem = ""
    voxels = np.asarray(voxels)
    if found.shape != voxels.shape:
        problem = f"shape {found.shape}, not {voxels.shape}"
    elif not np.allclose(found, voxels.astype(float), rtol=0, atol=tolerance, equal_nan=True):
        problem = f"{np.count_nonzero(found != voxels)} of {voxels.size} voxels differ: {found.ravel()[:4]} {voxels.ravel()[:4]}"
    here, steps = lps(info)
    for what, is_, wanted in (("spacing", info["spacing"], spacing), ("origin", here, origin), ("axes", steps, axes)):
        if wanted is not None and not np.allclose(is_, wanted, rtol=1e-5, atol=1e-5):
            problem += f" {what} {np.asarray(is_).tolist()}, not {np.asarray(wanted).tolist()}"
    if said is not None and said not in told:
        problem += f" said {told!r}, not {said!r}"
    count(kind, name, problem)
    return info


def refused(kind, name, path, words):
    """Holds that a file is refused in one line that has these words."""
    told = run(PROGRAM, "info", path)
    fine = told.returncode != 0 and told.stderr.count("\n") == 1 and words in told.stderr
    count(kind, name, "" if fine else f"{told.returncode}: {told.stderr.strip()}")


def finish():
    """Prints the counts; the exit status."""
    shutil.rmtree(root, ignore_errors=True)
    for kind, (right, total) in sorted(counts.items()):
        print(f"{kind}: {right} of {total}")
    print(f"{len(counts)} kinds, {sum(total for _, total in counts.values())} variants, {len(wrong)} wrong")
    return 1 if wrong else 0
