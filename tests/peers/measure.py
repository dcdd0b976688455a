"""One function per renderer: runs it on the job and returns an Outcome for each kind of shadows that it can make."""
import dataclasses
import json
import math
import os
import pathlib
import re
import resource
import shutil
import statistics
import subprocess
import sys
import time

import numpy
from PIL import Image

import job as jobs

sys.path.append(str(jobs.HERE.parent / "accuracy"))
import outside  # noqa: E402  (Mitsuba's environment)

WORK, HERE = jobs.WORK, jobs.HERE
PATIENCE = 600  # seconds, of one renderer


class Unavailable(Exception):
    """Why there is nothing to report of a renderer."""


@dataclasses.dataclass
class Outcome:
    """A picture (linear RGB, float) and what it cost: medians of frames, by the clock and of all threads, and the process."""
    renderer: str
    version: str
    kind: str
    picture: numpy.ndarray
    frame_ms: float
    processor_ms: float
    process_s: float
    frames: int
    noise: float = 0.0
    note: str = ""


def run(command, variables=None):
    """(standard output and error, seconds by the clock, processor seconds) of a program that must succeed."""
    words = [str(word) for word in command]
    if shutil.which(words[0]) is None:
        raise Unavailable(f"{pathlib.Path(words[0]).name} is not installed")
    before, begin = resource.getrusage(resource.RUSAGE_CHILDREN), time.perf_counter()
    try:
        done = subprocess.run(words, capture_output=True, text=True, timeout=PATIENCE,
                              env=dict(os.environ, **(variables or {})))
    except subprocess.TimeoutExpired:
        raise Unavailable(f"not done within {PATIENCE} s") from None
    seconds, after = time.perf_counter() - begin, resource.getrusage(resource.RUSAGE_CHILDREN)
    if done.returncode != 0:
        lines = [line for line in (done.stderr + done.stdout).splitlines() if line.strip()]
        raise Unavailable(f"it failed: {lines[-1].strip()[:120] if lines else done.returncode}")
    return done, seconds, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def measured(output):
    """The JSON in a program's last line of output."""
    return json.loads(output.strip().splitlines()[-1])


def to_linear(encoded):
    return numpy.where(encoded <= 0.04045, encoded / 12.92, ((encoded + 0.055) / 1.055) ** 2.4)


def read_png(path):
    """As it is stored, 0 to 1."""
    with Image.open(path) as image:
        return numpy.asarray(image.convert("RGB")) / 255


def median(times):
    return statistics.median(times)


def outcome(renderer, version, kind, picture, report, seconds, **more):
    return Outcome(renderer, version, kind, picture, median(report["frame_ms"]), median(report["processor_ms"]), seconds,
                   len(report["frame_ms"]), **more)


def halves(first, second):
    """(mean, root mean square of its noise where there is a picture) of two pictures that differ by chance alone."""
    mean = (first + second) / 2
    seen = mean.max(axis=2) > 0.005
    return mean, math.sqrt((((first - second) / 2)[seen] ** 2).mean())


def paraview(job):
    home = WORK / "paraview" / "usr"
    if not (home / "bin/pvpython").exists():
        raise Unavailable("ParaView is not unpacked")
    library = next(home.glob("lib/*-linux-gnu"))
    done, seconds, _ = run(["xvfb-run", "-a", home / "bin/pvpython", "--force-offscreen-rendering", HERE / "paraview_scene.py",
                            WORK / "job.json", 3],
                           {"LD_LIBRARY_PATH": str(library), "PYTHONPATH": str(home / "lib/python3/dist-packages")})
    report = measured(done.stdout)
    for kind in ("off", "hard"):
        if kind in report:
            picture = job["light"]["intensity"] * numpy.load(WORK / f"paraview-{kind}.npy")
            yield outcome("ParaView", report["version"], kind, picture, report[kind], seconds)


def vtk(job):
    done, seconds, _ = run(["xvfb-run", "-a", "/usr/bin/python3", HERE / "vtk_scene.py", WORK / "job.json", 3])
    report = measured(done.stdout)
    picture = job["light"]["intensity"] * numpy.load(WORK / "vtk-off.npy")
    yield outcome("VTK", report["version"], "off", picture, report["off"], seconds)


def blender(job):
    run(["/usr/bin/python3", HERE / "write_vdb.py", WORK / "job.json"])
    _, seconds, _ = run(["blender", "--background", "--factory-startup", "--python-exit-code", "1",
                         "--python", HERE / "blender_scene.py", "--", WORK / "job.json"])
    report = json.loads((WORK / "blender.json").read_text())
    picture, noise = halves(*(to_linear(read_png(WORK / f"blender-{seed}.png")) for seed in range(2)))
    yield outcome("Blender Cycles", report["version"], "soft", picture, report["soft"], seconds, noise=noise)


def mitsuba(job):
    try:
        python, variables = outside.environment()
    except (OSError, subprocess.CalledProcessError) as error:
        raise Unavailable(f"its environment could not be made: {error}") from None
    done, seconds, _ = run([python, HERE / "mitsuba_scene.py", WORK / "job.json"], variables)
    report = measured(done.stdout)
    picture, noise = halves(*numpy.load(WORK / "mitsuba-soft.npy").astype(float))
    yield outcome("Mitsuba 3", report["version"], "soft", picture, report["soft"], seconds, noise=noise)


def openvdb(job):
    """Its PNG files are linear. The light is as bright as colours of the table would have it."""
    camera, light = job["camera"], job["light"]

    def triple(v):
        return ",".join(f"{x:g}" for x in v)
    picture, brightness = WORK / "openvdb.png", 0.35 * light["intensity"]
    command = ["vdb_render", WORK / "extinction.vdb", picture, "-v", "-res", f"{job['size']}x{job['size']}",
               "-camera", "ortho", "-frame", camera["height"], "-translate", triple(camera["position"]),
               "-lookat", triple(camera["target"]), "-up", triple(camera["up"]),
               "-light", triple([*light["position"], *3 * [brightness]]), "-absorb", "0,0,0", "-scatter", "1,1,1",
               "-gain", "0", "-step", "1"]
    version, _, _ = run(["/usr/bin/python3", HERE / "write_vdb.py", WORK / "job.json"])
    for step, note in ((3, "shadow rays in steps of 3 voxels, its default"), (1, "shadow rays in steps of 1 voxel")):
        done, seconds, processor = run([*command, "-shadowstep", step])
        tracing = float(re.findall(r"completed in ([\d.]+) sec", done.stdout + done.stderr)[1])
        frame = {"frame_ms": [1e3 * tracing], "processor_ms": [1e3 * processor]}
        yield outcome("OpenVDB vdb_render", measured(version.stdout)["version"], "hard", read_png(picture), frame, seconds,
                      note=note)


def write_volpack_job(job, path):
    camera, light = job["camera"], job["light"]
    lines = [[job["size"], camera["height"]], camera["right"], camera["true_up"], camera["forward"], light["direction"]]
    lines += [[-math.expm1(-extinction), *color] for extinction, color in zip(job["extinction"], job["color"])]
    path.write_text("\n".join(" ".join(f"{x:.9g}" for x in line) for line in lines) + "\n")


def volpack(job):
    run(["cc", "-O2", HERE / "volpack.c", "-o", WORK / "volpack", "-lvolpack", "-lm"])
    write_volpack_job(job, WORK / "volpack.txt")
    done, seconds, _ = run([WORK / "volpack", WORK / "volume.raw", WORK / "volpack.txt", 15, WORK / "volpack"])
    report = measured(done.stdout)
    version, _, _ = run(["dpkg-query", "-W", "-f", "${Version}", "libvolpack1"])
    for kind in ("off", "hard"):
        pixels = numpy.fromfile(WORK / f"volpack-{kind}.rgb", numpy.uint8).reshape(job["size"], job["size"], 3)
        picture = job["light"]["intensity"] * pixels[::-1] / 255
        yield outcome("VolPack", version.stdout.split("-")[0], kind, picture, report[kind], seconds,
                      note=f"classified before, once, in {report['classify_ms'] / 1e3:.1f} s")


RENDERERS = {"volpack": volpack, "openvdb": openvdb, "vtk": vtk, "paraview": paraview, "blender": blender, "mitsuba": mitsuba}


class Halflight:
    """Measured between the others, a few frames at a time, so that what else the machine does slows all alike."""
    KINDS = {"off": "off", "hard": "hard", "paper": "soft_paper", "cascade": "soft_cascade", "sublights": "soft_sublights"}

    def __init__(self, program):
        self.program, self.reports = program, []

    def bench(self, frames=2):
        done, _, _ = run([self.program, "bench", WORK / "scene.json", "--frames", frames, "--json"])
        self.reports.append(json.loads(done.stdout))

    def outcomes(self):
        for kind, key in self.KINDS.items():
            soft = ["soft", "--soft-method", kind] if key.startswith("soft") else [kind]
            output = WORK / f"halflight-{kind}.npy"
            _, seconds, _ = run([self.program, "render", WORK / "scene.json", "--quiet", "--shadows", *soft, "-o", output])
            frame = {of: [report[of][key] for report in self.reports] for of in ("frame_ms", "processor_ms")}
            picture = numpy.load(output)[:, :, :3].astype(float)
            yield outcome("Halflight", self.reports[0]["version"], kind, picture, frame, seconds)
