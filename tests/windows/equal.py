#!/usr/bin/env python3
"""The program for Windows makes the pictures of this system's program, byte for byte, in wine.

usage: equal.py FOLDER PROGRAM
FOLDER is that of scripts/windows. The scenes are those of tests/equal_scenes.py.
"""
import os
import pathlib
import shutil
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests"))
from equal_scenes import compare_pictures, write_all  # noqa: E402


def main():
    windows, program = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
    wine, made = shutil.which("wine"), windows / "halflight" / "halflight.exe"
    if wine is None or not made.exists():
        print("1..1\nok 1 - pictures # SKIP wine or the program for Windows is not there: scripts/windows makes it")
        return
    os.environ |= {"WINEPREFIX": str(windows / "wine"), "WINEDEBUG": "-all"}
    with tempfile.TemporaryDirectory(prefix="halflight-windows-") as text:
        folder = pathlib.Path(text)
        scenes = write_all(folder, program)
        print(f"1..{len(scenes)}")
        if compare_pictures([wine, made], program, folder, [name for name, _ in scenes]):
            sys.exit(1)


main()
