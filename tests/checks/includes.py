#!/usr/bin/env python3
"""Dependencies between rooms point one way, and programs see the public headers alone.

usage: includes.py SOURCE_FOLDER
"""
import pathlib
import re
import sys

# room: rooms whose headers it may include besides its own and the public ones
ALLOWED = {
    "core": set(),
    "volume": {"core"},
    "shape": {"core", "volume"},
    "scene": {"core", "volume", "shape"},
    "image": {"core"},
    "simd": {"core", "volume", "scene", "splat", "light", "shadow", "shadow_cascade", "shadow_sublights", "render"},
    "splat": {"core", "volume", "scene", "simd"},
    "light": {"core", "volume", "scene", "simd", "splat"},
    "shadow": {"core", "volume", "scene", "simd", "splat", "light"},
    "shadow_hard": {"core", "scene", "simd", "splat", "light", "shadow"},
    "shadow_paper": {"core", "scene", "simd", "splat", "light", "shadow"},
    "shadow_cascade": {"core", "scene", "simd", "splat", "light", "shadow"},
    "shadow_sublights": {"core", "scene", "simd", "splat", "light", "shadow"},
    "render": {"core", "volume", "scene", "simd", "splat", "light", "shadow", "image"},
    "reference": {"core", "volume", "scene"},
    "cli": set(),
}
PUBLIC_ONLY = {"cli"}

root = pathlib.Path(sys.argv[1])
problems = []


def includes(path):
    for number, line in enumerate(path.read_text().splitlines(), 1):
        match = re.match(r'\s*#\s*include\s+(["<])([^">]+)[">]', line)
        if match:
            yield number, match.group(1) == '"', match.group(2)


def check_source(path, room):
    for number, quoted, name in includes(path):
        place = f"{path.relative_to(root)}:{number}"
        if not quoted:
            continue
        first = name.split("/")[0]
        if "/" not in name:
            if not (path.parent / name).exists():
                problems.append(f"{place}: {name} is not in this room")
        elif room in PUBLIC_ONLY:
            problems.append(f"{place}: {name}: {room} sees <halflight/...> alone")
        elif first != room and first not in ALLOWED[room]:
            problems.append(f"{place}: {name}: {room} may not depend on {first}")
        elif not (root / "src" / name).exists():
            problems.append(f"{place}: {name} does not exist")


sources = sorted((root / "src").glob("*/*.[ch]"))
for source in sources:
    if source.parent.name not in ALLOWED:
        problems.append(f"src/{source.parent.name}: unknown room: add it to the table in this script")
    else:
        check_source(source, source.parent.name)

headers = sorted((root / "include" / "halflight").glob("*.h"))
for header in headers:
    for number, quoted, name in includes(header):
        if quoted and not (header.parent / name).exists():
            problems.append(f"{header.relative_to(root)}:{number}: {name} is not a public header")

if len(sources) < 20 or len(headers) < 5:
    problems.append(f"only {len(sources)} sources and {len(headers)} headers were found in {root}")
for problem in problems:
    print(problem)
sys.exit(1 if problems else 0)
