"""The scenes of the comparison, and pictures of them: the renderer's, and the reference's, which are kept.

A scene is a JSON file beside this one. It is rendered at its own size by the sheets; the reference, which is slow, makes
every fifth pixel of every fifth row: a picture a fifth as wide has its pixels' centres there.
"""
import copy
import hashlib
import json
import pathlib
import subprocess

import numpy

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
PROGRAM = ROOT / "build" / "halflight"
WORK = ROOT / "build" / "accuracy"
STRIDE = 5
LIGHT_POINTS = 1024
# The reference's step in voxels: a quarter for hard shadows, which are cheap; finer where matter is as sharp as the grid.
FINE_STEP, SHARP_STEP, STEP, SHARP_SCENES = 0.25, 0.35, 0.5, ("plate", "wall")


class MissingData(Exception):
    """A scene's file is not where data are looked for."""


def names(only):
    return [path.stem for path in sorted(HERE.glob("*.json")) if only in path.stem]


def load(name, data):
    """The scene with its files found."""
    scene = json.loads((HERE / f"{name}.json").read_text())
    for volume in scene["volumes"]:
        if "file" not in volume:
            continue
        volume["file"] = str(data / volume["file"].removeprefix("data:"))
        if not pathlib.Path(volume["file"]).exists():
            raise MissingData(volume["file"])
    return scene


def changed(scene, shadows, **render):
    """The scene with other settings under its key `render`."""
    scene = copy.deepcopy(scene)
    scene.setdefault("render", {}).update(shadows=shadows, **render)
    return scene


def run(scene, label, *options):
    """Renders into WORK/label.npy; returns the statistics, or None where this version refuses the settings."""
    WORK.mkdir(parents=True, exist_ok=True)
    path = WORK / f"{label}.json"
    path.write_text(json.dumps(scene))
    output = WORK / f"{label}.npy"
    done = subprocess.run([PROGRAM, "render", path, "-o", output, "--json", "--quiet", *options],
                          capture_output=True, text=True)
    if done.returncode == 4 or "not yet in this version" in done.stderr:
        return None
    if done.returncode != 0:
        raise SystemExit(done.stderr.strip())
    return json.loads(done.stdout)


class Pictures:
    """What a run with --layers left: picture[h, w, 4], shadow[h, w] of the first light, each of some pixels."""

    def __init__(self, label, step=1):
        def layer(suffix):
            return numpy.load(WORK / f"{label}{suffix}.npy").astype(float)[step // 2::step, step // 2::step]
        self.picture = layer("")
        self.shadow = layer("-light0_shadow")[:, :, 0]


def reference(name, scene, shadows):
    """The reference's pictures of a scene, made where they are not kept."""
    scene = changed(scene, shadows)
    size = scene["image"]["width"]
    points = LIGHT_POINTS if shadows == "soft" else 1
    step = FINE_STEP if shadows == "hard" else SHARP_STEP if name.startswith(SHARP_SCENES) else STEP
    files = [pathlib.Path(v["file"]).read_bytes() for v in scene["volumes"] if "file" in v]
    key = hashlib.sha256(json.dumps([scene, points, step, STRIDE], sort_keys=True).encode() + b"".join(files)).hexdigest()
    label = f"reference-{name}-{shadows}-{key[:12]}"
    if not (WORK / f"{label}.npy").exists():
        print(f"  reference, {shadows} shadows, {points} points on each light ...", flush=True)
        run(scene, label, "--reference", "--layers", "--light-points", str(points), "--step", str(step), "--rays", "1",
            "--size", f"{size // STRIDE}x{size // STRIDE}")
    return Pictures(label)


def sheets(name, scene, label, shadows, **render):
    """The renderer's pictures, at the reference's pixels; None where this version refuses the method."""
    label = f"{name}-{label}"
    if run(changed(scene, shadows, **render), label, "--layers") is None:
        return None
    return Pictures(label, STRIDE)
