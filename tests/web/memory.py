#!/usr/bin/env python3
"""A page shows a volume of more than 2^28 voxels with the program's bytes, tells in one line what is too large, and goes on.

usage: memory.py FOLDER PROGRAM
FOLDER is the folder of scripts/web. The library runs in node.
"""
import json
import pathlib
import shutil
import subprocess
import sys
import tempfile
import zlib

ROOT = pathlib.Path(__file__).resolve().parents[2]
SIZE = (48, 32)
# Name, dimensions, whether the memory is taken before, what is said.
JOBS = [
    ("small.nrrd", (40, 40, 40), False, "shown"),
    ("wide.nrrd", (8192, 8192, 5), False, "shown"),
    ("vast.nrrd", (2048, 2048, 1200), False, "/vast.nrrd: the size 2048 x 2048 x 1200 needs more memory than this program can address"),
    ("small.nrrd", (40, 40, 40), False, "shown"),
    ("wide.nrrd", (8192, 8192, 5), True, "out of memory: /wide.nrrd needs 335544320 bytes more than there are or than the limit allows"),
    ("small.nrrd", (40, 40, 40), False, "shown"),
]


def write_steps(path, dimensions):
    """Voxels that grow along x. Of a volume that no page can hold, one slice is written."""
    x, y, z = dimensions
    slice_bytes = bytes(255 * i // (x - 1) for i in range(x)) * y
    packer = zlib.compressobj(1, wbits=31)
    with path.open("wb") as file:
        file.write(f"NRRD0004\ntype: uint8\ndimension: 3\nsizes: {x} {y} {z}\nencoding: gzip\n\n".encode())
        for _ in range(z if x * y * z < 1 << 31 else 1):
            file.write(packer.compress(slice_bytes))
        file.write(packer.flush())


def main():
    web, program = pathlib.Path(sys.argv[1]).resolve() / "page", pathlib.Path(sys.argv[2]).resolve()
    wasm = web / "halflight-relaxed.wasm"
    if shutil.which("node") is None or not wasm.exists():
        print("1..1\nok 1 - memory # SKIP node or the library as WebAssembly is not there: scripts/web makes it")
        return
    with tempfile.TemporaryDirectory(prefix="halflight-web-") as text:
        folder = pathlib.Path(text)
        for name, dimensions in {job[:2] for job in JOBS}:
            write_steps(folder / name, dimensions)
        (folder / "jobs").write_text(json.dumps([{"file": name, "full": full, "out": f"out{n}", "size": SIZE} for n, (name, _, full, _) in enumerate(JOBS)]))
        done = subprocess.run(["node", "--experimental-wasm-relaxed-simd", ROOT / "tests" / "web" / "memory.mjs", ROOT / "src" / "web" / "page" / "engine.js",
                               wasm, folder, folder / "jobs"], capture_output=True, text=True)
        if done.returncode != 0:
            sys.exit(done.stderr.strip()[-800:])
        lines = done.stdout.splitlines()
        if lines == ["unfused"]:
            print("1..1\nok 1 - memory # SKIP node rounds products before their sums")
            return
        print(f"1..{len(JOBS)}")
        failures = 0
        for n, ((name, _, _, wanted), said) in enumerate(zip(JOBS, lines, strict=True)):
            good = said == wanted
            if good and said == "shown":
                subprocess.run([program, "render", folder / f"out{n}.json", "-o", folder / "native.npy", "--quiet"], check=True)
                good = (folder / "native.npy").read_bytes() == (folder / f"out{n}.npy").read_bytes()
            failures += not good
            print(f"{'ok' if good else 'not ok'} {n + 1} - {name}: {said}", flush=True)
        if failures:
            sys.exit(1)


main()
