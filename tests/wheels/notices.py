#!/usr/bin/env python3
"""packaging/wheel/notices.py refuses what a wheel may not hold: libraries under the GPL, and libraries that are not listed.

usage: notices.py        it needs pyelftools
"""
import pathlib
import shutil
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "packaging/wheel"))
import notices  # noqa: E402

MIT = {"licence": "MIT", "archives": ["libgood.a"]}


def refuses(check, *arguments):
    try:
        check(*arguments)
    except SystemExit as refusal:
        return str(refusal).startswith("notices: ")
    return False


def under(licence, archive):
    return {"good": MIT, "other": {"licence": licence, "archives": [archive]}}


def main():
    failures = []
    for licence in ("GPL-2.0-or-later", "GPL-3.0-only", "MIT AND GPL-2.0-only", "GPL-2.0-only OR MIT", "LGPL-2.1-or-later", "AGPL-3.0-only"):
        if not refuses(notices.check_licences, under(licence, "libother.a")):
            failures.append(f"{licence}, linked in, is taken")
    for licence, archive in (("MIT", "libother.a"), ("IJG AND Zlib", "libother.a"), ("LGPL-2.1-or-later", "libother.so.1")):
        if refuses(notices.check_licences, under(licence, archive)):
            failures.append(f"{licence} of {archive} is refused")
    if not refuses(notices.check_licences, under("GPL-2.0-only", "libother.so.1")):
        failures.append("the GPL of a file of its own is taken")
    with tempfile.TemporaryDirectory() as text:
        (pathlib.Path(text) / "lib").mkdir()
        for name, bad in (("libgood.a", False), ("libjbig.a", True)):
            (pathlib.Path(text) / "lib" / name).touch()
            if refuses(notices.check_archives, {"good": MIT}, pathlib.Path(text)) != bad:
                failures.append(f"{name} is {'taken' if bad else 'refused'}")
    # A program of Debian's that needs libraries beyond the C library.
    program = pathlib.Path(shutil.which("dpkg-deb")).read_bytes()
    if not refuses(notices.check_needed, {"good": MIT}, {"halflight/bin/program": program}):
        failures.append("a file that needs a library outside of the wheel is taken")
    if not refuses(notices.check_needed, {"good": MIT}, {"halflight.libs/libjbig-0123abcd.so.0.1.0": pathlib.Path(shutil.which("true")).read_bytes()}):
        failures.append("a library in the wheel that is not listed is taken")
    print("\n".join(failures) or "what a wheel may not hold is refused")
    sys.exit(bool(failures))


main()
