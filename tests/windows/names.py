#!/usr/bin/env python3
"""The program for Windows opens files by any name, keeps what a header or a store names below its folder, reads volumes larger than memory, and finds
the files beside itself.

usage: names.py FOLDER PROGRAM
FOLDER is that of scripts/windows. It runs in wine, which follows links of the system below it by itself: links are not tested.
"""
import base64
import gzip
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

LONG = "long-name-" * 22  # 220 letters: with its folder more than the 260 that the system's usual calls take
HEADER = "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 4 4 4\nencoding: raw\n"
SIZE = ["--size", "16x16", "--quiet"]


def held_files(page):
    """The files that a page holds, {name: bytes}. Packed, they tell the system that packed them."""
    held = re.findall(r'data-file="([^"]*)">([^<]*)<', page.read_text(encoding="utf-8")) if page.exists() else []
    return {name: gzip.decompress(base64.b64decode(packed)) for name, packed in held}


def main():
    windows, program = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
    wine, made = shutil.which("wine"), windows / "halflight" / "halflight.exe"
    if wine is None or not made.exists():
        print("1..1\nok 1 - names # SKIP wine or the program for Windows is not there: scripts/windows makes it")
        return
    os.environ |= {"WINEPREFIX": str(windows / "wine"), "WINEDEBUG": "-all"}
    number = failures = 0

    def check(good, what):
        nonlocal number, failures
        number += 1
        failures += not good
        print(f"{'ok' if good else 'not ok'} {number} - {what}", flush=True)

    with tempfile.TemporaryDirectory(prefix="halflight-windows-") as text:
        folder = pathlib.Path(text)

        def run(words, **how):
            return subprocess.run([wine, made, *words], cwd=folder, capture_output=True, **how)

        def native(words):
            subprocess.run([program, *words], cwd=folder, capture_output=True, check=True)

        (folder / "inner").mkdir()
        (folder / "inner" / LONG).mkdir()
        native(["make", "rings", "--size", "20", "--quiet", "-o", "rings.nrrd"])
        native(["render", "rings.nrrd", "-o", "native.npy", *SIZE])
        expected = (folder / "native.npy").read_bytes()

        for name in ("Ä 体積 📦.nrrd", f"inner/{LONG}/{LONG}.nrrd"):
            shutil.copyfile(folder / "rings.nrrd", folder / name)
            out = name.replace(".nrrd", ".npy")
            done = run(["render", name.replace("/", "\\"), "-o", out, *SIZE])
            check(done.returncode == 0 and (folder / out).read_bytes() == expected, f"{name[:12]}...: read and written")
        done = run(["render", "-", "-o", "-", "--format", "npy", *SIZE], input=(folder / "rings.nrrd").read_bytes())
        check(done.stdout == expected, "standard streams carry bytes")
        done = run(["render", "*gs.nrr?", "-o", "inner/%d.png", *SIZE])
        check(done.returncode == 0 and (folder / "inner" / "0.png").exists(), "a pattern names files")

        done = run(["export", "rings.nrrd", "-o", "found.html", "--quiet"])
        native(["export", "rings.nrrd", "-o", "named.html", "--page", windows / "halflight" / "halflight.html", "--quiet"])
        found, named = (held_files(folder / name) for name in ("found.html", "named.html"))
        check(done.returncode == 0 and found["scene.json"] == named["scene.json"] and found.keys() == named.keys() == {"scene.json", "volume0.nrrd"},
              f"the program finds the page beside itself: {done.stderr.decode()}")

        (folder / "outside.raw").write_bytes(bytes(range(64)))
        for name in ("//localhost/share/x.raw", "\\\\localhost\\share\\x.raw"):
            (folder / "a.nhdr").write_text(HEADER + f"data file: {name}\n")
            done = run(["render", "a.nhdr", "-o", "a.npy", *SIZE])
            check(done.returncode == 3 and b"No such file" in done.stderr, f"no file of the network: {name}")
        store = folder / "inner" / "store.zarr"
        array = {"zarr_format": 2, "shape": [4, 4, 4], "chunks": [4, 4, 4], "dtype": "|u1", "compressor": None, "fill_value": 0, "order": "C", "filters": None}
        (folder / "array").mkdir()
        (folder / "array" / ".zarray").write_text(json.dumps(array))
        (folder / "array" / "0.0.0").write_bytes(bytes(range(64)))
        shutil.copytree(folder / "array", store / "0")
        for path, code in (("0", 0), ("..\\..\\array", 3), ("../../array", 3), ("0\\..\\..\\..\\array", 3), (f"Z:{folder}/array", 3)):
            scales = {"version": "0.4", "axes": [{"name": axis, "type": "space"} for axis in "zyx"], "datasets": [
                {"path": path, "coordinateTransformations": [{"type": "scale", "scale": [1, 1, 1]}]}]}
            (store / ".zattrs").write_text(json.dumps({"multiscales": [scales]}))
            (store / ".zgroup").write_text(json.dumps({"zarr_format": 2}))
            done = run(["render", "inner/store.zarr", "-o", "a.npy", *SIZE])
            check(done.returncode == code, f"a store's array {path.replace(text, '')}: exit code {code}")

        with open(folder / "large_400x400x400_uint8.raw", "wb") as file:  # larger than the limit, with a small body
            file.truncate(400**3)
            for row in range(800):
                file.seek(((180 + row // 40) * 400 + 180 + row % 40) * 400 + 150)
                file.write(bytes((3 * i + row) % 256 for i in range(90)))
        words = ["render", "large_400x400x400_uint8.raw", "--max-memory", "130M", *SIZE, "-o"]
        native([*words, "native.npy"])
        done = run([*words, "windows.npy"])
        check(done.returncode == 0 and (folder / "windows.npy").read_bytes() == (folder / "native.npy").read_bytes(), "a volume larger than memory")
        print(f"1..{number}")
    if failures:
        sys.exit(1)


main()
