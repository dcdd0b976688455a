#!/usr/bin/env python3
"""The commands of the pages run, with small stand-ins for the files that they name. The cookbook's commands have a test of their own.

usage: commands.py SOURCE_FOLDER PROGRAM
A block of a page is a shell script. It runs where its first command is `halflight`, or writes a file for it. Blocks that explain how a command is
written (INPUT, OUT) are left out.
"""
import math
import os
import pathlib
import re
import subprocess
import sys
import tempfile

SOURCE, PROGRAM = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]).resolve()
sys.path.insert(0, str(SOURCE / "tests/viewer"))
from dicom_files import dicom_slice  # noqa: E402

# Sizes of volumes, pictures and films, with what a test has time for.
SMALLER = {"2048x2048x2048": "32x32x32", "furry-sphere  ": "furry-sphere --size 24", "256x256": "48x48", "640x480": "64x48",
           "--turntable 120": "--turntable 2", "TMPDIR=/scratch": "TMPDIR=."}
SIDE = 40  # voxels of a stand-in; a figure's bar of 20 mm fits into its picture
PAGE = '<!doctype html><head><title>Halflight</title><script data-part="worker.js"></script></head><body></body>\n'
# `halflight view` ends when the page's address has been printed.
WRAPPER = """#!/bin/sh
[ "$1" = view ] || exec "{program}" "$@"
"{program}" "$@" --no-browser >address &
until [ -s address ]; do kill -0 $! || exit 1; sleep 0.05; done
rm address
kill $!
wait $! || true
"""
SYNOPSIS = re.compile(r"\b(INPUT|FILE|SHAPE|IN OUT)\b")
HEADER = f"""NRRD0004
type: uint8
dimension: 3
sizes: {SIDE} {SIDE} {SIDE}
encoding: raw
"""
SEGMENTS = """Segment0_Name:=liver
Segment0_LabelValue:=1
Segment1_Name:=tumour
Segment1_LabelValue:=2

"""


def blocks(page):
    """The indented blocks of a page that are scripts of the program."""
    text = re.sub(r"^```.*?^```", "", page.read_text(), flags=re.M | re.S)
    for block in re.findall(r"(?:(?<=\n\n)|\A)((?:    .*\n)+)", text):
        script = "".join(line[4:] for line in block.splitlines(keepends=True))
        if re.match(r"(\w+=\S+ )?halflight |cat >", script) and not SYNOPSIS.search(script):
            yield script


def run(script, folder):
    for large, small in SMALLER.items():
        script = script.replace(large, small)
    return subprocess.run(["bash", "-euo", "pipefail", "-c", script], cwd=folder, capture_output=True, text=True,
                          env=os.environ | {"PATH": f"{folder}/bin:/usr/bin:/bin", "HALFLIGHT_PAGE": f"{folder}/page.html"})


def write_inputs(folder):
    """The files that the pages name."""
    (folder / "bin").mkdir()
    (folder / "bin/halflight").write_text(WRAPPER.format(program=PROGRAM))
    (folder / "bin/halflight").chmod(0o755)
    (folder / "page.html").write_text(PAGE)
    (folder / "examples").symlink_to((SOURCE / "examples").resolve())
    make = lambda *words: subprocess.run([PROGRAM, *words, "--quiet"], cwd=folder, check=True)  # noqa: E731
    distances = [math.dist((x, y, z), (SIDE / 2,) * 3) for z in range(SIDE) for y in range(SIDE) for x in range(SIDE)]
    (folder / "ct.nrrd").write_bytes(f"{HEADER}\n".encode() + bytes(int(max(0, 255 - 14 * distance)) for distance in distances))
    for name in ("scan.nrrd", "head.nii.gz", "brain.nii.gz", "YOUR_VOLUME.nii.gz", "VOLUME.nii.gz"):
        make("convert", "ct.nrrd", name)
    labels = bytes((distance < 14) * (1 + n % 2) for n, distance in enumerate(distances))
    (folder / "organs.seg.nrrd").write_bytes(f"{HEADER}{SEGMENTS}".encode() + labels)
    (folder / "huge_32x32x32_uint16.raw").write_bytes(bytes(n % 251 for n in range(2 * 32**3)))
    (folder / "CD/DICOM").mkdir(parents=True)
    (folder / "slices").mkdir()
    for place in range(4):
        (folder / f"CD/DICOM/{place}").write_bytes(dicom_slice(place, [(0x00200011, "IS", b"4")]))
        make("render", "ct.nrrd", "--size", "16x16", "--shadows", "off", "-o", f"slices/slice_{place}.png")
    scene = subprocess.run([PROGRAM, "render", "ct.nrrd", "--print-scene", "--size", "32x24"], cwd=folder, check=True, capture_output=True, text=True).stdout
    for name in ("scene.json", "SCENE.json"):
        (folder / name).write_text(scene)
    places = [(n % 4, n // 4 % 4, n // 16) for n in range(64)]
    rows = "\n".join(f"{x},{y},{z},{1 + x},{10 + y}" for x, y, z in places)
    (folder / "galaxy.csv").write_text(f"x,y,z,mass,temperature\n{rows}\n")
    (folder / "water.xyz").write_text("\n".join(["64", "water", *(f"O {x} {y} {z}" for x, y, z in places)]) + "\n")
    (folder / "melt.lammpstrj").write_text("".join(
        f"ITEM: TIMESTEP\n{step}\nITEM: NUMBER OF ATOMS\n64\nITEM: BOX BOUNDS pp pp pp\n0 4\n0 4\n0 4\nITEM: ATOMS id type x y z\n" +
        "".join(f"{n + 1} 1 {x} {y} {z}\n" for n, (x, y, z) in enumerate(places)) for step in range(0, 50, 10)))


def main():
    pages = [SOURCE / "README.md", SOURCE / "packaging/wheel/README.md",
             *(page for page in sorted((SOURCE / "docs").glob("*.md")) if page.name != "cookbook.md")]
    number = failures = 0
    with tempfile.TemporaryDirectory(prefix="halflight-commands-") as text:
        folder = pathlib.Path(text)
        write_inputs(folder)
        for page in pages:
            for script in blocks(page):
                number += 1
                done = run(script, folder)
                failures += done.returncode != 0
                print(f"{'ok' if done.returncode == 0 else 'not ok'} {number} - {page.relative_to(SOURCE)}: {script.splitlines()[0]}")
                if done.returncode != 0:
                    print("".join(f"# {line}\n" for line in done.stderr.splitlines()), end="", flush=True)
    print(f"1..{number}")
    sys.exit(failures > 0 or number < 10)


main()
