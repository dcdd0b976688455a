#!/usr/bin/env python3
"""The list of formats of all wheels has the rows of this program, but for the rows that either of them misses.

usage: wheel_formats.py SOURCE_FOLDER PROGRAM

scripts/wheel --test compares the list with a wheel's own program, and runs rarely.
"""
import pathlib
import subprocess
import sys

source, program = pathlib.Path(sys.argv[1]), sys.argv[2]


def rows(text):
    """{(heading, name): what is said of it}"""
    found, heading = {}, ""
    for line in text.splitlines():
        if line.startswith(" "):
            found[heading, line[2:30].rstrip()] = line[30:]
        else:
            heading = line
    return found


listed = rows((source / "packaging/wheel/formats.txt").read_text())
own = rows(subprocess.run([program, "info", "--formats"], capture_output=True, text=True, check=True).stdout)
failures = [f"only one of them has {key[1]}" for key in listed.keys() ^ own.keys()]
failures += [f"{key[1]}: the list says {listed[key]!r}, the program {own[key]!r}" for key in listed.keys() & own.keys()
             if listed[key] != own[key] and not any(said.startswith("is missing") for said in (listed[key], own[key]))]
print(*failures, sep="\n")
sys.exit(1 if failures else 0)
