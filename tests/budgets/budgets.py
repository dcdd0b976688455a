#!/usr/bin/env python3
"""Holds the instructions of small frames to the counts stored in counts.json, within 3 %.

usage: budgets.py [--renew] PROGRAM COMPILERS

valgrind counts them: the same on a loaded machine, and on any processor with AVX2. What a frame does between slabs
is counted, and for two scenes all that a renderer does, preparation included. Counts depend on the compilers, so that the
test is skipped where these are others than the stored counts' own. --renew stores the counts of this build; the
commit that does says why they changed.
"""
import concurrent.futures
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

from scenes import SCENES, write_volumes

STORED = pathlib.Path(__file__).with_name("counts.json")
TOLERANCE = 0.03
SETS = ("scalar", "avx2")
# What is counted: (name, scene, function, instruction set). Preparation in scalar code takes minutes to count.
COUNTED = [(name, name, "hl_sweep_run", instructions) for name in SCENES for instructions in SETS] + [
    (f"{name}_prepared", name, "hl_renderer_render_layers", "avx2") for name in ("sky_hard", "labels")]


def count(program, folder, scene, function, instructions):
    """Instructions within a function, in a whole run of the program."""
    name = f"{scene}-{function}-{instructions}"
    environment = {key: value for key, value in os.environ.items() if key != "MALLOC_PERTURB_"}  # it fills memory
    done = subprocess.run(
        ["valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null", f"--toggle-collect={function}", program, "render",
         str(folder / f"{scene}.json"), "-o", str(folder / f"{name}.png"), "--instruction-set", instructions],
        capture_output=True, text=True, env=environment)
    found = re.search(r"Collected : (\d+)", done.stderr)
    if done.returncode != 0 or found is None or int(found[1]) == 0:
        sys.exit(f"{name}: {done.stderr.strip()[-400:]}")
    return int(found[1])


def count_all(program):
    """{"name, instruction set": count}."""
    with tempfile.TemporaryDirectory(prefix="halflight-budgets-") as text, concurrent.futures.ThreadPoolExecutor(2) as pool:
        folder = pathlib.Path(text)
        write_volumes(folder)
        for name, scene in SCENES.items():
            (folder / f"{name}.json").write_text(json.dumps(scene))
        tasks = {f"{name}, {instructions}": pool.submit(count, program, folder, scene, function, instructions)
                 for name, scene, function, instructions in COUNTED}
        return {name: task.result() for name, task in tasks.items()}


def supports_avx2():
    try:
        return " avx2 " in pathlib.Path("/proc/cpuinfo").read_text()
    except OSError:
        return False


def why_not(stored, compilers):
    if shutil.which("valgrind") is None:
        return "valgrind is not installed"
    if not supports_avx2():
        return "this processor has no AVX2"
    if stored["compilers"] != compilers:
        return f"the stored counts are of {stored['compilers']}, this build is of {compilers}"
    return None


def compare(stored, counts):
    print(f"1..{len(counts)}")
    failures = 0
    for number, (name, found) in enumerate(counts.items(), 1):
        expected = stored["counts"].get(name)
        good = expected is not None and abs(found - expected) <= TOLERANCE * expected
        failures += not good
        change = "not stored" if expected is None else f"{found / expected - 1:+.2%} of {expected}"
        print(f"{'ok' if good else 'not ok'} {number} - {name}: {found}, {change}", flush=True)
    return failures


def main():
    renew = sys.argv[1] == "--renew"
    program, compilers = sys.argv[2:4] if renew else sys.argv[1:3]
    if renew:
        STORED.write_text(json.dumps({"compilers": compilers, "counts": count_all(program)}, indent=1) + "\n")
        return
    stored = json.loads(STORED.read_text())
    reason = why_not(stored, compilers)
    if reason is not None:
        print(f"1..1\nok 1 - budgets # SKIP {reason}")
        return
    if compare(stored, count_all(program)):
        sys.exit(1)


main()
