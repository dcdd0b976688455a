#!/usr/bin/env python3
"""Runs the wrong inputs of wrong_inputs.txt and prints TAP.

usage: wrong_inputs.py PROGRAM [NAME ...]     (all without a name)

Each must end with its exit code and exactly its one line on standard error, nothing on standard output and no new file:
what is wrong, where, and what to do. A block is

    == what is wrong
    --- FILE [bytes|gzip]      a file, to the next line that begins with --- or $; bytes: one line, a Python bytes literal's
    its text                   inside; gzip: the same, compressed
    $ halflight ...            run by sh in a folder that holds the files and, besides, ball.nrrd, picture.png and long.npy
    3
    halflight: ball.nrrd: ...

'#' begins a comment between blocks.
"""
import ast
import gzip
import os
import pathlib
import subprocess
import sys
import tempfile
import zlib

HERE = pathlib.Path(__file__).resolve().parent


def png(width, height):
    """A grey 8-bit PNG."""
    def chunk(kind, data):
        return len(data).to_bytes(4, "big") + kind + data + zlib.crc32(kind + data).to_bytes(4, "big")
    header = width.to_bytes(4, "big") + height.to_bytes(4, "big") + bytes([8, 0, 0, 0, 0])
    rows = zlib.compress(b"".join(b"\0" + b"\x80" * width for _ in range(height)))
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", rows) + chunk(b"IEND", b"")


def npy(height, width):
    """Black RGBA floats."""
    header = f"{{'descr': '<f4', 'fortran_order': False, 'shape': ({height}, {width}, 4), }}".ljust(117) + "\n"
    return b"\x93NUMPY\x01\x00" + len(header).to_bytes(2, "little") + header.encode() + bytes(16 * width * height)


def common_files(folder):
    (folder / "ball.nrrd").write_bytes(b"NRRD0004\ntype: uint8\ndimension: 3\nsizes: 4 4 4\nencoding: raw\n\n" + bytes(range(64)))
    (folder / "picture.png").write_bytes(png(4, 4))
    (folder / "long.npy").write_bytes(npy(2, 9))


def content(lines, kind):
    if kind == "":
        return "".join(line + "\n" for line in lines).encode()
    data = ast.literal_eval('b"' + "".join(lines) + '"')
    return gzip.compress(data, mtime=0) if kind == "gzip" else data


def parse(text):
    """[(name, {file: bytes}, command, exit code, message)]"""
    cases = []
    for block in ("\n" + text).split("\n== ")[1:]:
        lines = [line for line in block.split("\n")]
        name, rest, files = lines[0], lines[1:], {}
        while rest[0].startswith("--- "):
            _, file, *kind = rest[0].split(" ")
            end = next(i for i in range(1, len(rest)) if rest[i].startswith(("--- ", "$ ")))
            files[file] = content(rest[1:end], kind[0] if kind else "")
            rest = rest[end:]
        message = rest[2] if len(rest) > 2 else ""
        cases.append((name, files, rest[0][2:], rest[1] if len(rest) > 1 else "", message))
    return cases


def run(program, case):
    """(exit code, standard output, standard error, new files)"""
    _, files, command, _, _ = case
    with tempfile.TemporaryDirectory(prefix="halflight-wrong-") as name:
        folder = pathlib.Path(name)
        common_files(folder)
        for file, data in files.items():
            (folder / file).write_bytes(data)
        before = set(os.listdir(folder))
        prelude = f'halflight() {{ "{program}" "$@"; }}\n'
        done = subprocess.run(["sh", "-eu", "-c", prelude + command], cwd=folder, stdin=subprocess.DEVNULL,
                              capture_output=True, timeout=60, env=dict(os.environ, LC_ALL="C.UTF-8"))
        return (done.returncode, done.stdout.decode(errors="replace"), done.stderr.decode(errors="replace"),
                sorted(set(os.listdir(folder)) - before))


def problems(program, case):
    code, out, err, new = run(program, case)
    found = []
    if str(code) != case[3]:
        found.append(f"exit code: expected {case[3]}, got {code}")
    if err != case[4] + "\n":
        found += [f"expected {case[4]!r}", f"got {err!r}"]
    if out != "" or new:
        found.append(f"standard output {out!r}, new files {new}")
    return found


def main():
    program = pathlib.Path(sys.argv[1]).resolve()
    cases = parse((HERE / "wrong_inputs.txt").read_text())
    cases = [case for case in cases if not sys.argv[2:] or case[0] in sys.argv[2:]]
    failed = 0
    print(f"1..{len(cases)}")
    for number, case in enumerate(cases, 1):
        found = problems(program, case)
        failed += bool(found)
        print(f"{'not ok' if found else 'ok'} {number} - {case[0]}", flush=True)
        for line in found:
            print(f"# {line}")
    sys.exit(1 if failed or not cases else 0)


if __name__ == "__main__":
    main()
