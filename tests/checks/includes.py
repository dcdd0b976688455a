#!/usr/bin/env python3
"""Dependencies between rooms and between the files of a room point one way; programs see the public headers alone; plans are plain data.

usage: includes.py SOURCE_FOLDER
The rooms and what each may use are the table in docs/architecture.md: the rooms named there, and the rooms that those may use.
"""
import pathlib
import re
import sys

root = pathlib.Path(sys.argv[1])
problems = []


def allowed_rooms(page):
    """{room: rooms whose headers it may include besides its own and the public ones} from the page's table of rooms."""
    rows = re.findall(r"^\| (`src/[\w*]+/`[^|]*)\|.*\|([^|]*)\|$", page, re.M)
    return {room.name: {name.strip() for name in uses.split(",") if name.strip()}
            for rooms, uses in rows for pattern in re.findall(r"`src/([\w*]+)/`", rooms)
            for room in (root / "src").glob(pattern)}


def closure(uses, start):
    """All that `start` uses, by way of others too. uses: {name: names that it uses}."""
    reached, waiting = set(), [start]
    while waiting:
        for use in uses.get(waiting.pop(), set()) - reached:
            reached.add(use)
            waiting.append(use)
    return reached


def find_circles(allowed):
    """A room that may use another one may not be used by it."""
    for room in sorted(allowed):
        if room in closure(allowed, room):
            problems.append(f"docs/architecture.md: src/{room}/ may use itself by way of other rooms")


PUBLIC_HEADERS = "the public headers"
ALLOWED = allowed_rooms((root / "docs" / "architecture.md").read_text())
PUBLIC_ONLY = {room for room, uses in ALLOWED.items() if PUBLIC_HEADERS in uses}
for room, uses in ALLOWED.items():
    for use in sorted(uses - set(ALLOWED) - {PUBLIC_HEADERS}):
        problems.append(f"docs/architecture.md: src/{room}/ may use {use}, which is no room of the table")
find_circles(ALLOWED)


# The headers whose structs a plan is made of.
PLAN_HEADERS = ["plan/frame_plan.h", "plan/frame_objects.h", "plan/frame.h", "light/light_source.h", "scene/light/light_shape.h",
                "surface/surfaces.h"]


def check_plan():
    """A plan is plain data: no member of its structs points to a description of the scene."""
    for header in PLAN_HEADERS:
        text = (root / "src" / header).read_text()
        for struct, body in re.findall(r"^typedef struct (\w+) \{\n(.*?)^\}", text, re.M | re.S):
            for kind in re.findall(r"^  (?:const )?(hl_light|hl_transfer_function|hl_scene_\w+) \*", body, re.M):
                problems.append(f"src/{header}: {struct} points to the description {kind}: copy what back ends need of it")


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
        elif room in PUBLIC_ONLY and first not in ALLOWED[room] | {room}:
            problems.append(f"{place}: {name}: {room} sees <halflight/...> and the rooms of its row alone")
        elif first != room and first not in ALLOWED[room]:
            problems.append(f"{place}: {name}: {room} may not depend on {first}")
        elif not (root / "src" / name).exists():
            problems.append(f"{place}: {name} does not exist")


def subject(path):
    """What a file in src/ is about: its name without its ending; NAME.c, NAME.h and NAME_lanes.h are one subject."""
    return re.sub(r"(_lanes)?\.[ch]$", "", str(path))


def find_circles_within(room):
    """Of two subjects of a room only one may include the other, be it by way of others."""
    uses = {}
    for source in sorted((root / "src" / room).glob("**/*.[ch]")):
        path = source.relative_to(root / "src")
        for _, quoted, name in includes(source):
            name = name if "/" in name else path.parent / name
            if quoted and subject(name) != subject(path):
                uses.setdefault(subject(path), set()).add(subject(name))
    for start in sorted(uses):
        also = sorted(use for use in uses[start] if start in closure(uses, use))
        if also:
            problems.append(f"src/{start}: includes itself by way of {', '.join(also)}")


sources = sorted((root / "src").glob("*/**/*.[ch]"))
for source in sources:
    room = source.relative_to(root / "src").parts[0]
    if room not in ALLOWED:
        problems.append(f"src/{room}: unknown room: add it to the table in docs/architecture.md")
    else:
        check_source(source, room)

for room in sorted(ALLOWED):
    find_circles_within(room)

check_plan()

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
