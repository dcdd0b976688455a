#!/usr/bin/env python3
"""`halflight export`: what a page holds of a scene is cut to what shows, in bytes where these hold all values, and gives the scene's picture.

usage: exported.py PROGRAM
"""
import base64
import gzip
import json
import os
import pathlib
import re
import struct
import subprocess
import sys
import tempfile

sys.path[:0] = [str(pathlib.Path(__file__).resolve().parents[1] / "budgets")]
from scenes import SCENES, scene, write_volumes  # noqa: E402

PROGRAM = pathlib.Path(sys.argv[1]).resolve()
STUB = '<!doctype html><head><title>Halflight</title><script data-part="worker.js"></script></head><body></body>\n'
number = 0


def check(good, what):
    global number
    number += 1
    print(f"{'ok' if good else 'not ok'} {number} - {what}", flush=True)
    if not good:
        sys.exit(1)


def program(*words, folder=None, page="stub.html"):
    """Runs the program in its folder; returns its exit code and its messages."""
    place = {"HALFLIGHT_PAGE": page} if page is not None else {}
    environment = {name: value for name, value in os.environ.items() if name != "HALFLIGHT_PAGE"} | place | {"TMPDIR": str(folder / "scratch")}
    done = subprocess.run([PROGRAM, *words], cwd=folder, env=environment, capture_output=True, text=True)
    return done.returncode, done.stderr


def unpack(page, folder):
    """Writes what a page holds to a folder. Returns the names."""
    folder.mkdir()
    held = re.findall(r'<script type="text/plain" data-file="([^"]*)">([^<]*)</script>', page.read_text())
    for name, packed in held:
        (folder / name).write_bytes(gzip.decompress(base64.b64decode(packed, validate=True)))
    return [name for name, _ in held]


def export(content, name, folder):
    """The folder of what the page of a scene holds."""
    (folder / f"{name}.json").write_text(json.dumps(content))
    code, line = program("export", f"{name}.json", "--quiet", folder=folder)
    check(code == 0, f"{name}: is written {line}")
    unpack(folder / f"{name}.html", folder / name)
    return folder / name


def facts(volume, folder):
    done = subprocess.run([PROGRAM, "info", "--json", volume], capture_output=True, text=True, check=True)
    return json.loads(done.stdout)


def try_pictures(folder):
    """The pictures of scenes and of their pages' scenes are the same, but for the places of sheets in a smaller box."""
    for name, content in SCENES.items():
        held = export(content, name, folder)
        pictures = []
        for at, text in ((folder, f"{name}.json"), (held, "scene.json")):
            code, line = program("render", at / text, "-o", at / f"{name}.png", "--quiet", folder=folder)
            check(code == 0, f"{name}: is rendered {line}")
            pictures.append(at / f"{name}.png")
        code, line = program("diff", *pictures, "--max-rmse", "0.01", folder=folder)
        check(code == 0, f"{name}: has the scene's picture {line}")


def try_cut(folder):
    """A ball of 16-bit voxels in a corner of a grid: the page has its box, with three voxels around, in bytes."""
    side, middle = 48, (12, 14, 33)
    near = lambda place: sum((a - b) ** 2 for a, b in zip(place, middle)) < 64  # noqa: E731
    voxels = [200 * near((i, j, k)) for k in range(side) for j in range(side) for i in range(side)]
    header = f"NRRD0004\ntype: uint16\ndimension: 3\nsizes: {side} {side} {side}\nspace dimension: 3\nspace directions: (2,0,0) (0,2,0) (0,0,2)\n" \
             "space origin: (10,20,30)\nendian: little\nencoding: raw\n\n"
    (folder / "corner.nrrd").write_bytes(header.encode() + struct.pack(f"<{len(voxels)}H", *voxels))
    held = export(scene({"file": "corner.nrrd"}), "corner", folder)
    found = facts(held / "volume0.nrrd", folder)
    check(found["type"] == "uint8", f"the values lie in bytes: {found['type']}")
    reach = 7 + 1 + 3  # the ball's voxels, the planes beside them, and what is around
    check(found["dimensions"] == [2 * reach + 1] * 3, f"the ball's box alone: {found['dimensions']}")
    check(found["origin"] == [o + 2 * (m - reach) for o, m in zip((10, 20, 30), middle)], f"where it was: {found['origin']}")
    shown = scene({"file": "corner.nrrd"}, render={"kernel": "interpolating"})
    found = facts(export(shown, "whole", folder) / "volume0.nrrd", folder)
    check(found["dimensions"] == [side] * 3, "a kernel that goes beyond the voxels' values keeps the whole volume")


def try_labels(folder):
    """Of a label map what a hidden label covers is no part of the box."""
    labels = [{"value": value, "visible": value == 1} for value in (1, 2, 3)]
    held = export(scene({"file": "labels.nrrd", "labels": labels, "transfer_function": None}), "one_label", folder)
    found = facts(held / "volume0.nrrd", folder)
    first, last = 5 - 1 - 3, 13 + 1 + 3  # label 1 has voxels from i = 5 to 13
    check(found["dimensions"][0] == last - first + 1 and found["origin"][0] == first and found["dimensions"][1] > 30,
          f"the box of label 1: {found['dimensions']} from {found['origin']}")


def try_words(folder):
    code, line = program("export", "labels.json", "--title", 'A <b> & "c"', "-o", "titled.html", "--quiet", folder=folder)
    page = (folder / "titled.html").read_text()
    check(code == 0 and "<title>A &lt;b&gt; &amp; &quot;c&quot;</title>" in page, "a title is text")
    check(page.endswith("</head><body></body>\n"), "the page goes on behind its files")
    code, line = program("export", "labels.json", folder=folder, page=None)
    check(code == 3 and line.startswith("halflight: the viewer's page is not installed: scripts/web in Halflight's sources makes it, and ") and
          line.endswith("or name it by --page, as --page build-web/halflight.html\n"),
          f"without the viewer's page: {line}")
    code, line = program("export", "labels.json", "--page", "labels.json", "--quiet", folder=folder)
    check(code == 3 and "labels.json: is not the page halflight.html that scripts/web makes" in line, f"another file: {line}")
    code, line = program("export", "labels.json", "-o", "labels.png", folder=folder)
    check(code == 2 and ".html" in line, f"another ending: {line}")
    check(list((folder / "scratch").iterdir()) == [], "no file stays behind")


def main():
    with tempfile.TemporaryDirectory(prefix="halflight-export-") as text:
        folder = pathlib.Path(text)
        write_volumes(folder)
        (folder / "stub.html").write_text(STUB)
        (folder / "scratch").mkdir()
        try_pictures(folder)
        try_cut(folder)
        try_labels(folder)
        try_words(folder)
    print(f"1..{number}")


main()
