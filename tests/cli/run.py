#!/usr/bin/env python3
"""Runs the command-line cases and prints TAP.

usage: run.py [--quick|--slow] PROGRAM [CASE ...]            (all cases without a name)

A case is a shell script NAME.sh in a folder beside this file, run with `sh -eu` in an empty folder of its own.
Beside it may stand
    NAME.sh.stdout.exact   the whole standard output; without it or .glob, standard output must be empty
    NAME.sh.stdout.glob    one pattern per line, * for any text
    NAME.sh.stderr.glob    the same for standard error; without it, standard error must be empty
    NAME.sh.exit           the exit code; 0 without it
In the script, `halflight` is the program, `tool` is tool.py, and $SOURCE the source folder. Exit code 77 skips the
case; the last line of standard output is the reason. A case that takes several seconds holds a line `# slow: REASON`;
--quick leaves these cases out, and --slow runs them alone. As many cases run at a time as there are processors. `await_handler PID` waits until a process catches SIGINT.
"""
import concurrent.futures
import fnmatch
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
SKIP = 77
SECONDS = 1800  # for cases that hang alone

PRELUDE = """
halflight() { "$HALFLIGHT" "$@"; }
tool() { "$PYTHON" "$SOURCE/tests/cli/tool.py" "$@"; }
# Waits until process $1 catches SIGINT (bit 1 of the mask), and a little more, so that it is at work.
await_handler() {
  for _ in $(seq 300); do
    if grep -qs '^SigCgt:.*[2367abef]$' "/proc/$1/status"; then break; fi
    sleep 0.1
  done
  sleep 0.5
}
. "$0"
"""


def differences(name, kind, text):
    """What is wrong with the output `text` of the case, as a list of lines."""
    exact = HERE / f"{name}.{kind}.exact"
    glob = HERE / f"{name}.{kind}.glob"
    if exact.exists():
        expected = exact.read_text()
        return [] if text == expected else [f"{kind}: expected {expected!r}", f"{kind}: got {text!r}"]
    patterns = glob.read_text().splitlines() if glob.exists() else []
    lines = text.splitlines()
    if len(lines) != len(patterns):
        return [f"{kind}: expected {len(patterns)} lines, got {len(lines)}: {text!r}"]
    return [f"{kind}: expected {pattern!r}, got {line!r}"
            for pattern, line in zip(patterns, lines) if not fnmatch.fnmatchcase(line, pattern)]


def run_case(name, environment):
    """(problems, reason to skip or None) of one case."""
    folder = tempfile.mkdtemp(prefix="halflight-cli-")
    try:
        done = subprocess.run(["sh", "-eu", "-c", PRELUDE, str(HERE / name)], cwd=folder, env=environment,
                              stdin=subprocess.DEVNULL, capture_output=True, timeout=SECONDS)
    except subprocess.TimeoutExpired:
        return [f"still running after {SECONDS} seconds"], None
    finally:
        shutil.rmtree(folder, ignore_errors=True)
    stdout, stderr = done.stdout.decode(errors="replace"), done.stderr.decode(errors="replace")
    if done.returncode == SKIP:
        return [], (stdout.splitlines() or ["no reason given"])[-1]
    exit_file = HERE / f"{name}.exit"
    expected = int(exit_file.read_text()) if exit_file.exists() else 0
    problems = differences(name, "stdout", stdout) + differences(name, "stderr", stderr)
    if done.returncode != expected:
        problems.insert(0, f"exit code: expected {expected}, got {done.returncode}")
    return problems, None


def main():
    kind = sys.argv[1] if sys.argv[1] in ("--quick", "--slow") else None
    program, *wanted = sys.argv[1 if kind is None else 2:]
    program = pathlib.Path(program).resolve()
    all_cases = sorted(str(path.relative_to(HERE)) for path in HERE.glob("*/*.sh"))
    cases = [name for name in all_cases if not wanted or name in wanted or name[:-3] in wanted]
    if kind is not None:
        cases = [name for name in cases if ("\n# slow: " in (HERE / name).read_text()) == (kind == "--slow")]
    environment = dict(os.environ, HALFLIGHT=str(program), PYTHON=sys.executable, SOURCE=str(HERE.parent.parent),
                       LC_ALL="C.UTF-8")
    print(f"1..{len(cases)}")
    failed = 0
    with concurrent.futures.ThreadPoolExecutor(len(os.sched_getaffinity(0))) as pool:
        results = pool.map(lambda name: run_case(name, environment), cases)
        for number, (name, (problems, skipped)) in enumerate(zip(cases, results), 1):
            failed += bool(problems)
            suffix = f" # SKIP {skipped}" if skipped is not None else ""
            print(f"{'not ok' if problems else 'ok'} {number} - {name[:-3]}{suffix}", flush=True)
            for problem in problems:
                print(f"# {problem}")
    sys.exit(1 if failed or not cases else 0)


main()
