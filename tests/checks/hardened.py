#!/usr/bin/env python3
"""The program, the library and the viewer's module are built as distributions build, and only the module loads a server.

usage: hardened.py PROGRAM LIBRARY FOLDER_OF_OBJECTS [MODULE]

Looks into their ELF files with readelf: PIE, full RELRO with BIND_NOW, a stack that runs no code, no relocation of code, the stack
protector and FORTIFY in use; and on x86 every object of the library marks the targets of jumps (CET). The linker marks the whole
file only where the C library's start files are marked as well, which Debian 12's are not.
"""
import pathlib
import re
import subprocess
import sys

program, library, objects, *modules = sys.argv[1:]
problems = []


def readelf(option, path):
    return subprocess.run(["readelf", "-W", option, str(path)], check=True, capture_output=True, text=True).stdout


def check(condition, problem):
    if not condition:
        problems.append(problem)


for path in (program, library, *modules):
    dynamic, segments, symbols = readelf("-d", path), readelf("-l", path), readelf("--dyn-syms", path)
    check("BIND_NOW" in dynamic and re.search(r"FLAGS_1.*\bNOW\b", dynamic), f"{path}: no BIND_NOW")
    check("GNU_RELRO" in segments, f"{path}: no RELRO")
    check(re.search(r"GNU_STACK .* RW +0x", segments), f"{path}: the stack may run code")
    check("TEXTREL" not in dynamic, f"{path}: code is relocated")
    check("__stack_chk_fail" in symbols, f"{path}: no stack protector")
    check(re.search(r"__\w+_chk@", symbols), f"{path}: no FORTIFY")
check(re.search(r"FLAGS_1.*\bPIE\b", readelf("-d", program)), f"{program}: no PIE")

if "X86-64" in readelf("-h", library):
    found = sorted(pathlib.Path(objects).glob("libhalflight-internal.a.p/*.o")) + sorted(pathlib.Path(objects).glob("hot/*.o"))
    check(len(found) > 100, f"{objects}: only {len(found)} objects")
    for path in found:
        check(re.search(r"x86 feature: IBT, SHSTK", readelf("-n", path)), f"{path}: no CET")

loaded = subprocess.run(["ldd", program], check=True, capture_output=True, text=True).stdout
for name in ("libmicrohttpd", "libgnutls", "libp11-kit"):
    check(name not in loaded, f"{program}: loads {name}, which the viewer alone needs")
print("\n".join(problems))
sys.exit(1 if problems else 0)
