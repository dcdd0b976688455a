#!/usr/bin/env python3
"""Sums the tests of several build folders, names what failed, and prints "N passed, N failed, N skipped".

usage: count_tests.py BUILD_FOLDER ...
A test that speaks TAP counts as its parts, and one that failed without a failing part (a crash, a timeout) as one
failure. A folder without results, as after a build that does not compile, counts as a failure.
"""
import json
import pathlib
import re
import sys

passed = failed = skipped = 0
names = []


def failed_parts(test):
    """The names of the parts of a test that failed, as it printed them."""
    return re.findall(r"^not ok\b[ \d-]*([^\n]*)", test.get("stdout") or "", re.M)


def last_words(test):
    """The last line that a test printed which ended without the name of a failing part."""
    lines = ((test.get("stdout") or "") + "\n" + (test.get("stderr") or "")).split("\n")
    return next((line.strip()[:300] for line in reversed(lines) if line.strip()), "no output")


def count(test):
    """(passed, failed, skipped) of one line of the log."""
    passes = re.findall(r"^ok\b([^\n]*)", test.get("stdout") or "", re.M)
    skips = sum("# SKIP" in rest.upper() for rest in passes)
    bad, good = len(failed_parts(test)), len(passes) - skips
    if test["result"] == "SKIP":
        return 0, 0, max(1, skips)
    if test["result"] not in ("OK", "EXPECTEDFAIL"):
        return good, max(1, bad), skips
    return (good, bad, skips) if passes or bad else (1, 0, 0)


for folder in sys.argv[1:]:
    log = pathlib.Path(folder) / "meson-logs" / "testlog.json"
    lines = log.read_text().splitlines() if log.exists() else []
    if not lines:
        failed += 1
        names.append(f"{folder}: no test ran")
    for line in lines:
        test = json.loads(line)
        good, bad, skips = count(test)
        passed, failed, skipped = passed + good, failed + bad, skipped + skips
        if bad:
            names.append(f"{folder}: {test['name']}: " + (", ".join(failed_parts(test)) or f"ended early: {last_words(test)}"))
for name in names:
    print(f"failed: {name}")
print(f"{passed} passed, {failed} failed, {skipped} skipped")
sys.exit(1 if failed else 0)
