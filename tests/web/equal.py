#!/usr/bin/env python3
"""The library as WebAssembly makes the program's pictures, byte for byte, in node.

usage: equal.py FOLDER PROGRAM [--few]
FOLDER is the folder of scripts/web. The scenes are those of tests/equal_scenes.py; --few: one in eight of them, by the files with relaxed SIMD alone.
"""
import json
import pathlib
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests"))
from equal_scenes import SIZE_DROPPED, render_with, write_all  # noqa: E402


def render_web(wasm, threads, taken, folder, scenes):
    """{name: (bytes, milliseconds)}; a text: why there are none."""
    jobs = [{"scene": scene, "files": files, "out": f"web.npy.d/{scene}", "size": None if scene.endswith(".json") else SIZE_DROPPED}
            for scene, files in scenes]
    (folder / "web.npy.d").mkdir(exist_ok=True)
    (folder / "jobs").write_text(json.dumps(jobs))
    done = subprocess.run(["node", "--experimental-wasm-relaxed-simd", ROOT / "tests" / "web" / "render.mjs", ROOT / "src" / "web" / "page" / "engine.js",
                           wasm, folder, folder / "jobs", str(threads), str(taken)], capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"{wasm}: {done.stderr.strip()[-800:]}")
    if done.stdout.strip() in ("unknown", "unfused"):
        return {"unknown": "node does not know an instruction of it", "unfused": "node rounds products before their sums"}[done.stdout.strip()]
    times = dict(line.split() for line in done.stdout.splitlines())
    return {job["scene"]: ((folder / job["out"]).read_bytes(), int(times[job["scene"]])) for job in jobs}


def try_heap(wasm):
    """A text: the number of blocks of memory that two threads got at once, and of pages that were free and not taken; or the problem of node."""
    done = subprocess.run(["node", "--experimental-wasm-relaxed-simd", ROOT / "tests" / "web" / "heap.mjs", wasm, "3"], capture_output=True, text=True)
    return done.stdout.strip() or done.stderr.strip()[-800:]


def main():
    web, program = pathlib.Path(sys.argv[1]).resolve() / "page", pathlib.Path(sys.argv[2]).resolve()
    few = "--few" in sys.argv[3:]
    # Name, file, threads, bytes that lie before all else, number of scenes. Pointers behind two gibibytes are negative numbers for a script.
    sets = [("simd", "halflight.wasm", 1, 0, None), ("relaxed", "halflight-relaxed.wasm", 1, 0, None),
            ("threads", "halflight-threads.wasm", 3, 0, None), ("behind 2 GiB", "halflight-relaxed.wasm", 1, 2200000000, 4)]
    if few:
        sets = [one for one in sets if one[0] in ("relaxed", "threads")]
    if shutil.which("node") is None or not all((web / wasm).exists() for _, wasm, *_ in sets):
        print("1..1\nok 1 - pictures # SKIP node or the library as WebAssembly is not there: scripts/web makes it")
        return
    with tempfile.TemporaryDirectory(prefix="halflight-web-") as text:
        folder = pathlib.Path(text)
        scenes = write_all(folder, program)[::8 if few else 1]
        expected = {scene: render_with([program], folder, scene, "native.npy") for scene, _ in scenes}
        print(f"1..{1 + sum(len(scenes[:some]) for *_, some in sets)}")
        heap = try_heap(web / "halflight-threads.wasm")
        good = heap in ("0 0", "unknown")  # node may not know an instruction of the file
        print(f"{'ok' if good else 'not ok'} 1 - threads that allocate memory at once: blocks that were given twice, free pages that were not taken: {heap}",
              flush=True)
        number, failures = 1, int(not good)
        for name, wasm, threads, taken, some in sets:
            found = render_web(web / wasm, threads, taken, folder, scenes[:some])
            for scene, _ in scenes[:some]:
                number += 1
                if isinstance(found, str):
                    print(f"ok {number} - {name} {scene} # SKIP {found}")
                    continue
                good = found[scene][0] == expected[scene]
                failures += not good
                print(f"{'ok' if good else 'not ok'} {number} - {name} {scene}: {found[scene][1]} ms", flush=True)
        if failures:
            sys.exit(1)


main()
