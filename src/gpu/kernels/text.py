#!/usr/bin/env python3
"""Writes the kernels as one C string: sweep.c with all that it includes of this project, each file once.

usage: text.py OUTPUT SOURCES_FOLDER FILE ...
FILE: the entry, relative to SOURCES_FOLDER; the others are named for the build to watch.
"""
import pathlib
import re
import sys

output, folder, entry, *_ = sys.argv[1:]
seen = set()


def lines_of(name):
    seen.add(name)
    for line in (pathlib.Path(folder) / name).read_text().splitlines():
        included = re.match(r'#include "(.*)"', line)
        if not included:
            yield line
        elif included[1] not in seen:
            yield from lines_of(included[1])


text = "\n".join(lines_of(entry)) + "\n"
content = text.encode() + b"\0"
rows = [",".join(map(str, content[at:at + 24])) for at in range(0, len(content), 24)]
pathlib.Path(output).write_text("/* Made by text.py of the files in gpu/kernels/. */\n"
                                "extern const char hl_kernel_text[];\n"
                                "const char hl_kernel_text[] = {\n  " + ",\n  ".join(rows) + "};\n")
if len(sys.argv) > 4 and sys.argv[-1] == "--plain":
    print(text)
