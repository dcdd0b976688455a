#!/usr/bin/env python3
"""The files that scripts/macos makes hold code for both processors, need no library but the system's, and take their mathematics from themselves.

usage: linked.py FOLDER
They have never run: this is what can be seen of them without macOS.
"""
import pathlib
import re
import subprocess
import sys

VARYING = "__sincosf?_stret|__exp10f?|a?(sin|cos|tan)h?f?|atan2f?|cbrtf?|erff?|expm?1?2?f?|hypotf?|log(1p|2|10)?f?|powf?|sincosf?"


def said(*command):
    return subprocess.run(command, capture_output=True, text=True, check=True).stdout


def main():
    folder = pathlib.Path(sys.argv[1])
    files = [folder / "halflight", folder / "libhalflight.0.dylib"]
    if not all(file.exists() for file in files):
        print("1..1\nok 1 - linked # SKIP the program for macOS is not there: scripts/macos makes it")
        return
    print(f"1..{4 * len(files) + 1}")
    number = failures = 0

    def check(good, what):
        nonlocal number, failures
        number += 1
        failures += not good
        print(f"{'ok' if good else 'not ok'} {number} - {what}")

    for file in files:
        processors = set(said("llvm-lipo-19", "-archs", file).split())
        check(processors == {"x86_64", "arm64"}, f"{file.name}: processors {sorted(processors)}")
        needed = {line.split()[0] for line in said("llvm-otool-19", "-L", file).splitlines() if line.startswith("\t")}
        foreign = {name for name in needed if not name.startswith("/usr/lib/libSystem") and name != "@rpath/libhalflight.0.dylib"}
        check(needed and not foreign, f"{file.name}: needs {sorted(needed)}")
        check("minos 13.0" in said("llvm-otool-19", "-l", file), f"{file.name}: for macOS 13.0 and newer")
        taken = [name for name in re.findall(r"\b_(\w+)$", said("llvm-nm-19", "--undefined-only", file), re.M) if re.fullmatch(VARYING, name)]
        check(not taken, f"{file.name}: mathematics of the system {sorted(set(taken))}")
    check("path @loader_path (" in said("llvm-otool-19", "-l", files[0]), "halflight: finds the library beside it")
    if failures:
        sys.exit(1)


main()
