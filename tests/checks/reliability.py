#!/usr/bin/env python3
"""Every promise of docs/reliability.md names a test, and every test that it names exists.

usage: reliability.py SOURCE_FOLDER

In tables whose last column is headed "held by", each row names tests in backquotes: a path, a test of meson's, or
`test: function` for a function in the source of that test.
"""
import pathlib
import re
import sys


def meson_tests(source):
    """{name of a test: whether it stands in some tests/**/meson.build}"""
    text = "\n".join(path.read_text() for path in source.glob("tests/**/meson.build"))
    return set(re.findall(r"'([a-z0-9_]+)'", text))


def rows(lines):
    """(line number, first cell, last cell) of the tables' rows."""
    inside = False
    for number, line in enumerate(lines, 1):
        cells = [cell.strip() for cell in line.strip().strip("|").split("|")] if line.startswith("|") else []
        if cells and cells[-1] == "held by":
            inside = True
        elif not cells:
            inside = False
        elif inside and not set(line) <= set("|-: "):
            yield number, cells[0], cells[-1]


def problem(source, tests, name):
    """What is wrong with the name of a test, or None."""
    if "/" in name:
        return None if (source / name).exists() else "there is no such file"
    test, _, function = name.partition(": ")
    if test not in tests:
        return "no meson.build has a test of this name"
    if not function:
        return None
    sources = list(source.glob(f"tests/**/{test}.c"))
    if not any(re.search(rf"\bcmocka_unit_test(_\w+)?\({function}\b", path.read_text()) for path in sources):
        return f"{test}.c has no test {function}"
    return None


def main():
    source = pathlib.Path(sys.argv[1])
    tests = meson_tests(source)
    problems, count = [], 0
    for number, promise, held_by in rows((source / "docs/reliability.md").read_text().splitlines()):
        names = re.findall(r"`([^`]+)`", held_by)
        count += 1
        if not names:
            problems.append(f"docs/reliability.md:{number}: no test holds \"{promise}\"")
        for name in names:
            wrong = problem(source, tests, name)
            if wrong:
                problems.append(f"docs/reliability.md:{number}: {name}: {wrong}")
    if count == 0:
        problems.append("docs/reliability.md: its tables are not understood")
    print("\n".join(problems))
    sys.exit(bool(problems))


main()
