#!/usr/bin/env python3
"""How much work is done after somebody asked a call to stop, in instructions, which callgrind counts; prints TAP.

usage: patience.py PATIENCE        (the program of patience.c)

For each scene: the instructions between some questions of the cancel callback, and those from the answer "stop" to
the end. Both together are what is done at most after a request. A count of instructions is the same on a busy machine.
"""
import concurrent.futures
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

MOST = 20_000_000  # instructions; docs/reliability.md promises it. A processor of today does 3,000,000,000 and more a second


def counts(program, scene, folder):
    """{"between": [instructions ...], "end": [instructions]} of a scene; raises RuntimeError."""
    done = subprocess.run(["valgrind", "--tool=callgrind", f"--callgrind-out-file={folder}/{scene}", program, scene],
                          capture_output=True, text=True)
    if done.returncode != 0:
        raise RuntimeError(done.stderr.strip())
    found = {}
    for path in pathlib.Path(folder).glob(f"{scene}.*"):
        head = path.read_text()
        trigger = re.search(r"^desc: Trigger: Client Request: (\w+)", head, re.M)
        if trigger:
            found.setdefault(trigger.group(1), []).append(int(re.search(r"^(?:summary|totals): (\d+)", head, re.M).group(1)))
    return found


def problem_of(program, scene, folder):
    """(a line for the report, what is wrong or None) of a scene."""
    try:
        found = counts(program, scene, folder)
    except RuntimeError as reason:
        return "", str(reason)
    if len(found.get("between", [])) < 5 or len(found.get("end", [])) != 1:
        return "", f"callgrind wrote other counts than were asked for: {found}"
    between, end = max(found["between"]), found["end"][0]
    line = f"{scene}: at most {between:,} between two questions, {end:,} from the answer to the end"
    return line, None if between + end <= MOST else f"more than {MOST:,} instructions: {line}"


def main():
    program = str(pathlib.Path(sys.argv[1]).resolve())
    if shutil.which("valgrind") is None:
        print("1..0 # SKIP valgrind is not installed")
        return 0
    scenes = subprocess.run([program], check=True, capture_output=True, text=True).stdout.split()
    print(f"1..{len(scenes)}")
    failed = 0
    with tempfile.TemporaryDirectory(prefix="halflight-patience-") as folder, \
            concurrent.futures.ThreadPoolExecutor(len(os.sched_getaffinity(0))) as pool:
        for number, (scene, (line, problem)) in enumerate(
                zip(scenes, pool.map(lambda name: problem_of(program, name, folder), scenes)), 1):
            failed += problem is not None
            print(f"{'not ok' if problem else 'ok'} {number} - {scene}\n# {problem or line}", flush=True)
    return 1 if failed else 0


sys.exit(main())
