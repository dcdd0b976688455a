#!/usr/bin/env python3
"""Every function and test that docs/equations.md names exists, where it says.

usage: equations.py SOURCE_FOLDER

In a table's row, `name()` is a function of src/; `program: case` is a case of a test program, and each `case` after
it, without a colon, one more of the same program.
"""
import pathlib
import re
import sys

root = pathlib.Path(sys.argv[1])
code = "\n".join(path.read_text() for path in sorted((root / "src").rglob("*.[ch]")))
programs = {path.stem: path.read_text() for path in (root / "tests").glob("*/*.c")}
problems = []


def is_defined(function, text):
    """Whether the text holds the function's head: its name after a type and attributes, at the start of a line."""
    attributes = r"(?:__attribute__\(\(\w+(?:, \w+)*\)\) )?"
    return re.search(rf"^[A-Za-z_][A-Za-z0-9_ *]*[ *]{attributes}[A-Za-z0-9_ *]*\b{re.escape(function)}\(", text, re.M) is not None


lines = (root / "docs" / "equations.md").read_text().splitlines()
named = 0
for number, line in enumerate(lines, 1):
    if not line.startswith("|"):
        continue
    program = None
    for name in re.findall(r"`([^`]+)`", line):
        place = f"docs/equations.md:{number}"
        named += 1
        if name.endswith("()"):
            if not is_defined(name[:-2], code):
                problems.append(f"{place}: no function {name} in src/")
            continue
        program, _, case = name.rpartition(": ") if ": " in name else (program, "", name)
        if program not in programs:
            problems.append(f"{place}: {name}: no test program {program}.c")
        elif not is_defined(case, programs[program]):
            problems.append(f"{place}: {program}.c has no case {case}")

if named < 10:
    problems.append("docs/equations.md: its tables are not understood")
print("\n".join(problems) or f"{named} names checked")
sys.exit(bool(problems))
