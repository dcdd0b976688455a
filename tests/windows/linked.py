#!/usr/bin/env python3
"""The library and the program for Windows need the system's libraries alone, and take no mathematics from them: the last bits would differ.

usage: linked.py FOLDER
FOLDER is that of scripts/windows.
"""
import pathlib
import re
import shutil
import subprocess
import sys

VARYING = "a?(sin|cos|tan)h?f?|atan2f?|cbrtf?|erff?|expm?1?2?f?|hypotf?|log(1p|2|10)?f?|powf?|sincosf?"
OF_SYSTEM = r"api-ms-win-crt-[\w-]+\.dll|(kernel32|shell32|ntdll|psapi|advapi32|bcrypt)\.dll"


def main():
    folder = pathlib.Path(sys.argv[1]) / "halflight"
    files = sorted(folder.glob("*.exe")) + sorted(folder.glob("*.dll"))
    if shutil.which("objdump") is None or not files:
        print("1..1\nok 1 - linked # SKIP objdump or the program for Windows is not there: scripts/windows makes it")
        return
    print(f"1..{2 * len(files)}")
    failures = 0
    for number, file in enumerate(files):
        text = subprocess.run(["objdump", "-p", file], capture_output=True, text=True, check=True).stdout
        imports = text[text.index("The Import Tables"):].split("The Export Tables")[0].split("The Function Table")[0]
        needed = set(re.findall(r"DLL Name: (\S+)", imports))
        foreign = {name for name in needed if not re.fullmatch(OF_SYSTEM, name, re.I) and not (folder / name).exists()}
        taken = [name for name in re.findall(r"^\s+[0-9a-f]+\s+\d+\s+(\w+)$", imports, re.M) if re.fullmatch(VARYING, name)]
        for offset, (good, what) in enumerate([(needed and not foreign, f"needs {sorted(needed)}"), (not taken, f"mathematics of the system {taken}")]):
            failures += not good
            print(f"{'ok' if good else 'not ok'} {2 * number + offset + 1} - {file.name}: {what}")
    if failures:
        sys.exit(1)


main()
