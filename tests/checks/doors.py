#!/usr/bin/env python3
"""What a library must not do to its host, and what its host must not do to it, as far as its text tells.

usage: doors.py SOURCE_FOLDER

Every public function is a door (src/core/door.h), but for those that do no arithmetic, which are listed here. No
source changes the process's umask or its locale. What the library reads and writes does not follow the host's
locale: numbers are read and written by src/text/plain.c alone.
"""
import pathlib
import re
import sys

root = pathlib.Path(sys.argv[1])
problems = []

# They copy, count, name, keep or let go.
NO_ARITHMETIC = re.compile(
    r"hl_(\w+_(defaults|name|count|retain|release|destroy|describe|summary|text)|version|context_\w+|image_(width|height|pixels|"
    r"pixels_const|add_layer|find_scene)|mesh_reads_name|ranks_\w+|setting_(get|find)|scene_write_options|"
    r"volume_(unit|label_map|get_array|get_channel|get_segment|get_selection|get_series)|\w+_get_(format|packing)|component_of_name|renderer_(create|share|share_over_ranks|use_device))")
PROGRAM = ("cli", "server", "film", "process")  # rooms of the program, which leaves the locale "C" as it is

declared = set()
for header in (root / "include" / "halflight").glob("*.h"):
    declared |= set(re.findall(r"HL_API[^;{]*?\b(hl_\w+)\(", header.read_text()))
doors = {}
for source in sorted((root / "src").rglob("*.[ch]")):
    text = source.read_text()
    place = source.relative_to(root)
    for match in re.finditer(r"^[\w \*]*?\b(hl_\w+)\([^;{}]*?\)\s*\{(\s*HL_DOOR;)?", text, re.M):
        if match.group(1) in declared:
            doors[match.group(1)] = (place, match.group(2) is not None)
    bare = re.sub(r"/\*.*?\*/|//[^\n]*", lambda m: re.sub(r"[^\n]", " ", m.group()), text, flags=re.S)

    def refuse(pattern, reason):
        for match in re.finditer(pattern, bare):
            line = bare.count("\n", 0, match.start()) + 1
            problems.append(f"{place}:{line}: {match.group().split('(')[0]}: {reason}")

    if place.as_posix() in ("src/platform/windows/locale.c", "src/platform/windows/include/locale.h"):
        continue  # what src/text/plain.c asks for: the locale of one thread alone
    refuse(r"\bumask\(", "changes the host's files in other threads: create with the right mode")
    refuse(r"\b(setlocale|localeconv)\(", "the locale is the host's")
    if str(place) in ("src/text/plain.c", "src/text/plain_json.c"):
        continue
    refuse(r"\b(strto(d|f|ld)(_l)?|atof)\(", "use hl_plain_number()")
    if place.parts[1] in PROGRAM:
        continue
    refuse(r"\b(json_load\w*|json_dump\w*|json_sprintf)\(", "use src/text/plain_json.h")
    refuse(r"\bv\w*printf\(", "use hl_plain_vprint()")
    refuse(r"\b(\w*scanf|str(n)?casecmp|strcoll|strxfrm)\(", "follows the locale: see src/text/plain.h")
    refuse(r"\b(is(alpha|alnum|digit|xdigit|space|print|punct|graph|cntrl|blank|upper|lower)|to(upper|lower))\(",
           "follows the locale: compare characters")
    refuse(r"\b\w*printf\((?:[^;\"]|\"(?:[^\"\\]|\\.)*\")*?%[-+ #0-9.*]*[aAeEfFgG]", "use hl_plain_print()")

for name in sorted(declared - set(doors)):
    problems.append(f"{name}: declared in include/halflight, and its definition was not found")
for name, (place, door) in sorted(doors.items()):
    plain = NO_ARITHMETIC.fullmatch(name) is not None
    if door == plain:
        problems.append(f"{place}: {name} " + ("is listed as one without arithmetic, and has a door" if door else
                                              "has no door: begin it with HL_DOOR (src/core/door.h)"))
if len(doors) < 100:
    problems.append(f"only {len(doors)} public functions were found")
print("\n".join(problems))
sys.exit(1 if problems else 0)
