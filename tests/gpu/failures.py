#!/usr/bin/env python3
"""Lets calls of a device's driver fail, and holds what follows: the processors make the picture, with their bytes, and the
program says why.

usage: failures.py PROGRAM FAILING_LIBRARY
"""
import ctypes.util
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile

program, failing = (os.path.abspath(path) for path in sys.argv[1:3])
OUT_OF_MEMORY, LOST, UNBUILT, SPOILT = -4, -36, -11, 0
FAILURES = [
    ("clCreateContext 1", LOST), ("clCreateCommandQueue 1", OUT_OF_MEMORY), ("clBuildProgram 1", UNBUILT), ("clCreateKernel 3", OUT_OF_MEMORY),
    *((f"clCreateBuffer {number}", OUT_OF_MEMORY) for number in (1, 2, 6, 15, 30)),
    *((f"clEnqueueWriteBuffer {number}", LOST) for number in (1, 4, 12)),
    *((f"clEnqueueNDRangeKernel {number}", LOST) for number in (1, 2, 9, 40)),
    *((f"clEnqueueReadBuffer {number}", error) for number in (1, 2, 3, 4) for error in (LOST,)),
    *((f"clEnqueueReadBuffer {number}", SPOILT) for number in (1,)),
]
# What the program says of each failure. SPOILT: a result is changed.
REASONS = {OUT_OF_MEMORY: "^[^:]+ has no memory left$", LOST: "failed with OpenCL's error -36$", UNBUILT: "does not compile the kernels: ",
           SPOILT: "^[^:]+ (makes another picture|computes) "}
REASON_TOLD = re.compile(r"halflight: warning: the processors make the pictures: [ -~]+\n")
SCENE = {"halflight": 1, "image": {"width": 48, "height": 48},
         "camera": {"type": "perspective", "position": [50, 32, -88], "target": [0, 0, 0], "up": [0, 1, 0], "fovy_deg": 30},
         "lights": [{"type": "directional", "direction": [0.4, -0.7, 0.5], "shadows": "hard"}],
         "volumes": [{"file": "cloud.nrrd", "transfer_function": {"unit_distance": 1, "opacity": [[0.1, 0], [1, 0.3]]}}],
         "render": {"sheet_spacing": 1}}


def real_library():
    """The path of the system's loader of OpenCL."""
    listed = subprocess.run(["/sbin/ldconfig", "-p"], capture_output=True, text=True).stdout.splitlines()
    paths = [line.split("=>")[-1].strip() for line in listed if line.strip().startswith("libOpenCL.so.1 ")]
    return paths[0] if paths else ctypes.util.find_library("OpenCL")


def run(folder, *arguments, fails=None):
    # A released text would be told as bytes of 0xf9.
    environment = {**os.environ, "XDG_CACHE_HOME": str(folder / "cache"), "LD_LIBRARY_PATH": os.path.dirname(failing),
                   "OPENCL_LIBRARY": real_library() or "", "MALLOC_PERTURB_": str(0xf9)}
    if fails:
        environment["OPENCL_FAILS"] = fails
    return subprocess.run([program, *map(str, arguments)], capture_output=True, text=True, errors="replace", cwd=folder, env=environment)


def picture(folder, device, fails=None):
    done = run(folder, "render", "scene.json", "--device", device, "-o", f"{device}.npy", "--json", fails=fails)
    assert done.returncode == 0, f"{fails}: {done.stderr}"
    return (folder / f"{device}.npy").read_bytes(), json.loads(done.stdout), done.stderr


def main():
    if not real_library():
        print("there is no loader of OpenCL here")
        sys.exit(77)
    with tempfile.TemporaryDirectory() as made:
        folder = pathlib.Path(made)
        done = run(folder, "make", "cloud", "--size", 32, "-o", "cloud.nrrd", "--quiet")
        assert done.returncode == 0, done.stderr
        (folder / "scene.json").write_text(json.dumps(SCENE))
        own, _, _ = picture(folder, "cpu")
        whole, report, _ = picture(folder, "opencl")
        if report["device"] == "cpu":
            print("no device of OpenCL is here:", report["device_reason"])
            sys.exit(77)
        assert whole == own
        failed = 0
        for call, error in FAILURES:
            if call.startswith("clBuildProgram"):
                for path in (folder / "cache/halflight").iterdir():
                    path.unlink()
            made, report, told = picture(folder, "opencl", fails=f"{call} {error}")
            assert made == own, f"{call} {error}: another picture"
            if report["device"] != "cpu":
                continue # the device makes fewer such calls
            failed += 1
            reason = report.get("device_reason", "")
            assert re.search(REASONS[error], reason), f"{call} {error}: {reason!r}"
            assert not told or REASON_TOLD.match(told), f"{call} {error}: {told!r}"
            assert len(told.splitlines()) <= 1, f"{call} {error}: {told}"
            print(f"{call} {error}: {report['device_reason']}", flush=True)
        assert failed > len(FAILURES) - 4, failed


main()
