#!/usr/bin/env python3
"""Writes the page's files as C arrays, so that the program carries them.

usage: embed.py OUTPUT FILE ...
index.html is served as the page itself, under the empty name.
"""
import pathlib
import sys

TYPES = {".html": "text/html; charset=utf-8", ".css": "text/css; charset=utf-8",
         ".js": "text/javascript; charset=utf-8", ".svg": "image/svg+xml"}

output, *paths = sys.argv[1:]
lines = ['/* Made by embed.py of the files in page/. */', '#include "server/parts.h"', ""]
rows = []
for number, path in enumerate(map(pathlib.Path, paths)):
    content = path.read_bytes()
    lines.append(f"static const unsigned char file_{number}[] = {{")
    lines += ["  " + ",".join(map(str, content[at:at + 24])) + "," for at in range(0, len(content), 24)]
    lines += ["};"]
    name = "" if path.name == "index.html" else path.name
    rows.append(f'  {{"{name}", "{TYPES[path.suffix]}", file_{number}, sizeof file_{number}}},')
lines += ["", "const server_asset server_assets[] = {", *rows, "};",
          "const size_t server_asset_count = sizeof server_assets / sizeof *server_assets;"]
pathlib.Path(output).write_text("\n".join(lines) + "\n")
