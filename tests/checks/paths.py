#!/usr/bin/env python3
"""Every file that a page or a comment names exists; a source file's first comment begins with its own name.

usage: paths.py SOURCE_FOLDER

Pages: each path that begins with a folder of the repository, "src/room/file.c"; a "*" stands for any text. Comments
of C files: these paths, and each "file.c" or "room/file.h", which must be the end of some file's path. Names with
capitals ("NAME.c") stand for any name.
"""
import pathlib
import re
import sys

root = pathlib.Path(sys.argv[1])
FOLDERS = "src|include|tests|scripts|docs|examples|man"
pages = [path for path in root.glob("*.md") if path.name != "CHANGELOG.md"] + sorted(root.glob("docs/**/*.md"))
sources = [path for folder in ("src", "include", "tests") for path in sorted((root / folder).rglob("*.[ch]"))]
files = {str(path.relative_to(root)) for folder in FOLDERS.split("|") for path in (root / folder).rglob("*")}
ends = {"/".join(path.split("/")[first:]) for path in files for first in range(path.count("/") + 1)}
OTHERS = re.compile(r"zlib\.h|nifti[12]\w*\.[ch]")  # of other projects
problems = []
named = 0


def is_there(path):
    """Whether a path, or a pattern with "*", leads to something of the repository."""
    if re.search(r"[A-Z]{2}", path.rpartition("/")[2]) or re.search(r"\b[A-Z]{3}", path):
        return True
    return any(root.glob(path)) if "*" in path else (root / path).exists()


def check_paths(text, place):
    """Notes the paths in a text that lead nowhere."""
    global named
    for match in re.finditer(rf"(?<![\w/.$-])((?:{FOLDERS})/[\w./*-]*\w[\w/*]*)", text):
        named += 1
        path = match.group(1).rstrip("/")
        # programs are named like their sources
        if not is_there(path) and not is_there(path + ".c"):
            problems.append(f"{place}: there is no {path}")


for page in pages:
    check_paths(page.read_text(), page.relative_to(root))
for source in sources:
    text = source.read_text()
    place = source.relative_to(root)
    own = str(place).partition("/")[2]
    first = re.match(r"/\* (\S+\.[ch]) ", text)
    if place.parts[0] != "tests" and (first is None or first.group(1) != own):
        problems.append(f"{place}:1: the first comment begins with {first and first.group(1)}, not {own}")
    for comment in re.finditer(r"/\*.*?\*/", text, re.S):
        line = text.count("\n", 0, comment.start()) + 1
        check_paths(comment.group(), f"{place}:{line}")
        for match in re.finditer(r"(?<![\w/.<*-])((?:[a-z]\w*/)*[a-z]\w+\.[ch])\b", comment.group()):
            named += 1
            if match.group(1) not in ends and not OTHERS.fullmatch(match.group(1)):
                problems.append(f"{place}:{line}: there is no {match.group(1)}")

if named < 100:
    problems.append(f"only {named} paths were found: the pages are not understood")
print("\n".join(problems) or f"{named} paths checked")
sys.exit(bool(problems))
