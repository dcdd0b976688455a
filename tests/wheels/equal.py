#!/usr/bin/env python3
"""A wheel's program reads and writes what all wheels do, finds the page for `halflight export` in the wheel, and makes the pictures of this system's
program, byte for byte.

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


def try_export(command, program, folder):
    """Prints a line of TAP: whether the program writes a scene into the wheel's page. Returns whether it is good."""
    what = "2 - the program finds the wheel's page"
    if pathlib.Path(command[0]).name.startswith("ld-"):
        print(f"ok {what} # SKIP a loader that is started by name is the running program's file")
        return True
    subprocess.run([program, "make", "rings", "--size", "16", "-o", folder / "rings.nrrd", "--quiet"], check=True)
    done = subprocess.run([*command, "export", "rings.nrrd", "-o", "rings.html", "--quiet"], cwd=folder, capture_output=True, text=True)
    good = done.returncode == 0 and b'data-file="volume0.nrrd"' in (folder / "rings.html").read_bytes()
    print(f"{'ok' if good else 'not ok'} {what} {done.stderr.strip()}", flush=True)
    return good


def main():
    program, command = pathlib.Path(sys.argv[1]).resolve(), [shutil.which(sys.argv[2]), *sys.argv[3:]]
    failures = 0
    with tempfile.TemporaryDirectory(prefix="halflight-wheels-") as text:
        folder = pathlib.Path(text)
        scenes = write_all(folder, program)
        print(f"1..{len(scenes) + 2}")
        # Without a converter of OpenVDB in PATH, which would be listed.
        listed = subprocess.run([*command, "info", "--formats"], capture_output=True, text=True, check=True, env={"PATH": ""}).stdout
        expected = (ROOT / "packaging/wheel/formats.txt").read_text()
        failures += listed != expected
        print(f"{'ok' if listed == expected else 'not ok'} 1 - the formats are those of packaging/wheel/formats.txt")
        failures += not try_export(command, program, folder)
        failures += compare_pictures(command, program, folder, [name for name, _ in scenes], 3)
    if failures:
        sys.exit(1)


main()
