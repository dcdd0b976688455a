#!/usr/bin/env python3
"""A wheel's program reads and writes what all wheels do, and makes the pictures of this system's program, byte for byte.

usage: equal.py PROGRAM COMMAND ...
COMMAND runs the wheel's program: its path alone, or after another system's loader or qemu. The scenes are those of tests/equal_scenes.py.
"""
import pathlib
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests"))
from equal_scenes import compare_pictures, write_all  # noqa: E402


def main():
    program, command = pathlib.Path(sys.argv[1]).resolve(), [shutil.which(sys.argv[2]), *sys.argv[3:]]
    failures = 0
    with tempfile.TemporaryDirectory(prefix="halflight-wheels-") as text:
        folder = pathlib.Path(text)
        scenes = write_all(folder, program)
        print(f"1..{len(scenes) + 1}")
        # Without a converter of OpenVDB in PATH, which would be listed.
        listed = subprocess.run([*command, "info", "--formats"], capture_output=True, text=True, check=True, env={"PATH": ""}).stdout
        expected = (ROOT / "packaging/wheel/formats.txt").read_text()
        failures += listed != expected
        print(f"{'ok' if listed == expected else 'not ok'} 1 - the formats are those of packaging/wheel/formats.txt")
        failures += compare_pictures(command, program, folder, [name for name, _ in scenes], 2)
    if failures:
        sys.exit(1)


main()
