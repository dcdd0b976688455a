#!/usr/bin/env python3
"""A viewer that is zoomed into a pyramid: at rest the page has the voxels that its picture deserves, where the picture sees them.

usage: zoomed.py PROGRAM
"""
import itertools
import json
import os
import pathlib
import shutil
import sys
import tempfile
import threading
import time
import urllib.parse
import zlib

import numpy

import checks
from browser import HANG, Browser
from checks import check
from viewer import Viewer, need_viewer

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "cli"))
import servers  # noqa: E402
import subprocess  # noqa: E402

PROGRAM = os.path.abspath(sys.argv[1])
LONG, WIDE, CHUNK, LEVELS, PIXELS, FULL = 1024, 64, 32, 3, 96, 0.8
STORE = "stores/a.zarr"
WORDS = ("--shadows", "off", "--sky", "0")
ALL = LONG * WIDE * WIDE // CHUNK**3
MIDDLE = "a.zarr__0__1__1__16"


def write_pyramid(folder):
    """A beam of noise, at three resolutions, of which none follows from another one. Chunks at its end are absent."""
    noise = numpy.random.default_rng(1)
    folder.mkdir(parents=True)
    for level in range(LEVELS):
        shape, array = [WIDE >> level, WIDE >> level, LONG >> level], folder / str(level)
        chunk = min(CHUNK, shape[0])
        array.mkdir()
        (array / ".zarray").write_text(json.dumps(
            {"zarr_format": 2, "shape": shape, "chunks": [chunk] * 3, "dtype": "|u1", "compressor": {"id": "zlib", "level": 1},
             "fill_value": 0, "order": "C", "filters": None, "dimension_separator": "/"}))
        for place in itertools.product(*(range(size // chunk) for size in shape)):
            if place[2] * chunk > FULL * shape[2]:
                continue
            file = array.joinpath(*map(str, place))
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_bytes(zlib.compress(noise.integers(40, 250, (chunk,) * 3, "u1").tobytes(), 1))
        write_groups(folder, level)
    (folder / ".zgroup").write_text('{"zarr_format": 2}')
    (folder / ".zattrs").write_text(json.dumps({"multiscales": servers.levels_text(LEVELS)}))


def write_groups(folder, level):
    """A store of this level alone, which is read whole."""
    alone = folder.parent / f"alone{level}.zarr"
    shutil.copytree(folder / str(level), alone / str(level))
    text = servers.levels_text(LEVELS)
    text[0]["datasets"] = [text[0]["datasets"][level]]
    (alone / ".zgroup").write_text('{"zarr_format": 2}')
    (alone / ".zattrs").write_text(json.dumps({"multiscales": text}))


numbers = iter(range(1, 10**6))


def start_of(viewer):
    """What the viewer begins with, when all that is shared by all views is read; its scene has a picture across which the volume goes once."""
    while json.loads(viewer.request("GET", "refined.json?opened=0")[2])["refining"]:
        time.sleep(0.05)
    start = json.loads(viewer.request("GET", "start.json?opened=0")[2])
    scene = start["scene"]
    scene["image"].update(width=PIXELS, height=PIXELS)
    scene["camera"] = {"type": "orthographic", "height": LONG, "target": [LONG / 2, WIDE / 2, WIDE / 2], "position": [LONG / 2 + 300, -900, 700], "up": [0, 0, 1]}
    return start


def frame(viewer, scene, page="test", **more):
    """(status, body, what the picture shows of its volumes). A picture at rest, as the page asks for it."""
    query = {"format": "png", "coarse": 1, "seen": 1, **more}
    words = urllib.parse.urlencode({"page": page, "number": next(numbers), **query})
    status, headers, body = viewer.request("POST", f"frame?{words}", json.dumps(scene))
    return status, body, json.loads(urllib.parse.unquote(headers.get("Halflight-Seen", "null")))


def zoomed(scene, factor, aside=0.0):
    """The scene, nearer, and past the middle by a part of the volume's length along x."""
    camera = scene["camera"]
    moved = [aside * LONG, 0, 0]
    return {**scene, "camera": {**camera, "height": camera["height"] / factor, **{key: [x + d for x, d in zip(camera[key], moved)] for key in ("position", "target")}}}


def rendered_again(picture):
    """The bytes of the picture that the program makes of a picture's scene."""
    subprocess.run([PROGRAM, "render", picture, "-o", "again.png", "--no-metadata", "--quiet"], check=True)
    return pathlib.Path("again.png").read_bytes()


def pixels(png):
    pathlib.Path("seen.png").write_bytes(png)
    subprocess.run([PROGRAM, "convert", "seen.png", "seen.npy", "--quiet"], check=True)
    return numpy.load("seen.npy")


def of_whole_level(scene, level):
    """The picture of the scene of which all voxels of a level are read, in a PNG's numbers."""
    scene = json.loads(json.dumps(scene))
    scene["volumes"][0]["file"] = os.path.abspath(f"stores/alone{level}.zarr")
    del scene["volumes"][0]["level"]
    pathlib.Path("whole.json").write_text(json.dumps(scene))
    subprocess.run([PROGRAM, "render", "whole.json", "-o", "whole.png", "--quiet"], check=True)
    return pixels(pathlib.Path("whole.png").read_bytes())


def levels_of(seen):
    return None if seen is None else [volume["level"] for volume in seen["volumes"]]


def from_folder():
    """The level that a pixel deserves, where the picture sees it."""
    with Viewer(PROGRAM, STORE, *WORDS) as viewer:
        start = start_of(viewer)
        scene = start["scene"]
        check(start["volumes"][0]["level_follows_view"] and scene["volumes"][0]["level"] == 1, f"512 voxels at first: {scene['volumes'][0]['level']}")
        status, first, seen = frame(viewer, scene)
        check(status == 200 and seen is None, f"the whole volume has voxels enough: {seen}")
        check(frame(viewer, zoomed(scene, 5))[2] is None, "480 pixels need no more than 512 voxels")
        for factor, level in ((6, 0), (20, 0)):
            near = zoomed(scene, factor)
            status, picture, seen = frame(viewer, near)
            check(status == 200 and levels_of(seen) == [level] and seen["problem"] == "", f"zoom {factor}: {status} {seen}")
            right = of_whole_level(near, level)
            check(numpy.array_equal(pixels(picture), right), f"zoom {factor}: the picture of all voxels of level {level}")
            coarse = of_whole_level(near, 1)
            check(numpy.abs(coarse - right).max() > 0.1, "another one than that of the coarser voxels")
            status, moving, seen = frame(viewer, near, format="npy", seen=0)
            check(status == 200 and seen is None, "a picture that does not ask shows the voxels that are there")
        lit = json.loads(json.dumps(zoomed(scene, 20)))
        lit["ambient"] = [0.5, 0.5, 0.5]
        check(levels_of(frame(viewer, lit)[2]) == [0], "other light, same voxels")
        check(frame(viewer, scene)[1] == first, "the whole volume again")
        saved = frame(viewer, zoomed(scene, 8), "test-save", coarse=0, seen=0)
        check(saved[0] == 200 and levels_of(saved[2]) == [0], f"what is saved has them, too: {saved[0]} {saved[2]}")
        pathlib.Path("saved.png").write_bytes(saved[1])
        check(rendered_again("saved.png") == frame(viewer, zoomed(scene, 8), "test-save", coarse=0, seen=0, metadata=0)[1], "and is rendered again with the same bytes")
        told = json.loads(subprocess.run([PROGRAM, "render", "saved.png", "--print-scene"], capture_output=True, text=True, check=True).stdout)
        check(told["volumes"][0]["level"] == 0, "and its scene names the level")
    with Viewer(PROGRAM, STORE, *WORDS, "--level", "1") as viewer:
        start = start_of(viewer)
        check(not start["volumes"][0]["level_follows_view"] and frame(viewer, zoomed(start["scene"], 4))[2] is None, "a level that a person names stays")


def chunks_asked(server, level=0):
    return {name for name in server.requests if name.startswith(f"a.zarr/{level}/") and name[-1].isdigit()}


def bytes_of(names):
    return sum(path.stat().st_size for path in (pathlib.Path("stores", name) for name in names) if path.is_file())


def few_bytes(server, url):
    """The chunks that the picture sees, and no others."""
    with Viewer(PROGRAM, url, *WORDS) as viewer:
        scene = start_of(viewer)["scene"]
        server.forget()
        frame(viewer, scene)
        check(server.requests == [], f"the picture of the whole volume needs no more: {server.requests}")
        near = zoomed(scene, 8)
        status, picture, seen = frame(viewer, near)
        asked = chunks_asked(server)
        check(status == 200 and levels_of(seen) == [0] and seen["problem"] == "", f"{status} {seen} {len(asked)}")
        check(0 < len(asked) < ALL / 3 and not chunks_asked(server, 1), f"chunks of the finest level alone: {len(asked)} of {ALL}")
        check(server.sent <= bytes_of(asked) + 4096, f"once each: {server.sent}, {bytes_of(asked)}")
        check(numpy.array_equal(pixels(picture), of_whole_level(near, 0)), "the picture of all voxels")
        server.forget()
        check(frame(viewer, near)[1] == picture and server.requests == [], "the same view asks for nothing")


def moving_meanwhile(server, url):
    """While finer voxels are read, moving frames are made, and end the reading."""
    released, reached = threading.Event(), threading.Event()

    def hold(name):
        if name.startswith("a.zarr/0/") and name[-1].isdigit():
            reached.set()
            released.wait()

    server.forget()
    with Viewer(PROGRAM, url, *WORDS) as viewer:
        scene = start_of(viewer)["scene"]
        frame(viewer, scene, format="jpeg", moving=1, seen=0)
        server.hold = hold
        answers = []
        waiting = threading.Thread(target=lambda: answers.append(frame(viewer, zoomed(scene, 8))))
        waiting.start()
        check(reached.wait(HANG), "finer voxels are asked for")
        progress = json.loads(viewer.request("GET", "progress.json?page=test")[2])
        check(progress["stage"] in ("voxels", "picture"), f"progress: {progress}")
        status, _, seen = frame(viewer, zoomed(scene, 8, 0.01), format="jpeg", moving=1, seen=0)
        check(status == 200 and seen is None and not released.is_set(), f"a moving frame comes while the server is held: {status}")
        waiting.join()
        check(answers and answers[0][0] == 204, f"the picture at rest is given up: {answers and answers[0][0]}")
        server.hold = None
        released.set()
        status, picture, seen = frame(viewer, zoomed(scene, 8))
        check(status == 200 and levels_of(seen) == [0] and numpy.array_equal(pixels(picture), of_whole_level(zoomed(scene, 8), 0)), "the next one has them")


def faults(server, url):
    """Where a chunk that is seen does not come as it is, the picture is that of the coarser voxels, and says so."""
    with Viewer(PROGRAM, url, *WORDS) as viewer:
        scene = start_of(viewer)["scene"]
        near = zoomed(scene, 8)
        coarser = frame(viewer, near, seen=0)[1]
        for fault, words in (("500", "the server answers 500"), ("403", "the server answers 403"), ("cut", "it does not arrive"),
                             ("page", "a chunk does not unpack"), ("half", "a chunk does not unpack"), ("flipped", "a chunk does not unpack")):
            server.forget(**{MIDDLE: ["always", fault]})
            status, picture, seen = frame(viewer, near)
            check(status == 200 and picture == coarser and seen["volumes"] == [] and words in seen["problem"], f"{fault}: {status} {seen}")
            status, line, _ = frame(viewer, near, "test-save", coarse=0)
            check(status == 400 and words in line.decode() and "only a coarser resolution was read" in line.decode(), f"{fault}: nothing is saved: {status} {line[:200]}")
        server.forget(**{MIDDLE: ["500"]})
        right = of_whole_level(near, 0)
        status, picture, seen = frame(viewer, near)
        check(status == 200 and seen["problem"] == "" and numpy.array_equal(pixels(picture), right), f"a fault that passes does no harm: {seen}")
        slow = threading.Semaphore(2)

        def drip(name):
            with slow:
                time.sleep(0.02)

        server.hold = drip
        status, picture, seen = frame(viewer, zoomed(scene, 8, 0.02))
        server.hold = None
        check(status == 200 and seen["problem"] == "" and numpy.array_equal(pixels(picture), of_whole_level(zoomed(scene, 8, 0.02), 0)), "a slow server")
        server.forget(**{MIDDLE: ["always", "404"]})
        status, picture, seen = frame(viewer, zoomed(scene, 8.01))
        check(status == 200 and seen["volumes"][0]["absent_chunks"][0] >= 1, f"a chunk that the server lacks is told: {seen}")
        server.forget()
        status, _, seen = frame(viewer, zoomed(scene, 40, 0.45))
        check(status == 200 and seen["problem"] == "" and seen["volumes"][0]["absent_chunks"] == [len(chunks_asked(server)), ALL] and len(chunks_asked(server)) > 0,
              f"where all chunks that are seen are absent, the store is whole: {seen}")


def page(server, url):
    """The page says what it waits for, shows the finer voxels, and names their level in the scene that it saves."""
    released, reached = threading.Event(), threading.Event()

    def hold(name):
        if name.startswith("a.zarr/0/") and name[-1].isdigit():
            reached.set()
            released.wait()

    server.forget()
    rest = "globalThis.halflight?.frames.statistics.stage === 'final'"
    nearer = """(() => { const { store } = globalThis.halflight, { camera } = store.scene, { position: p, target: t } = camera;
        store.setCamera({ ...camera, ...(camera.type === "orthographic" ? { height: camera.height / 8 } : { position: p.map((x, a) => t[a] + (x - t[a]) / 8) }) });
        return true; })()"""
    level, own = ("globalThis.halflight.store.%s.volumes[0].level" % file for file in ("shownFile", "file"))
    said = "document.getElementById('resolution').textContent"
    with Viewer(PROGRAM, url, *WORDS) as viewer, Browser(size=(640, 480)) as browser:
        browser.open(viewer.url)
        browser.wait(rest)
        base = browser.run(own)
        server.hold = hold
        browser.run(nearer)
        browser.wait("document.getElementById('progress').textContent.includes('finer voxels are being read')")
        check(reached.wait(HANG) and not browser.run(rest), "the page says what it waits for")
        server.hold = None
        released.set()
        browser.wait(rest)
        check(browser.run(level) == 0 and browser.run(own) == base == 1, f"the saved scene has the level that is seen: {base} {browser.run(level)}")
        check("a coarser" not in browser.run(said), f"all is there: {browser.run(said)}")
        server.forget(**{f"a.zarr__0__1__1__{x}": ["always", "500"] for x in range(LONG // CHUNK)})
        browser.run(nearer.replace("/ 8", "/ 1.2"))
        browser.wait(rest)
        check("a coarser resolution is shown" in browser.run(said) and "answers 500" in browser.run(said), f"the page says what it does not show: {browser.run(said)}")
        check(browser.run(level) == base, "the saved scene is the one of the picture")
        server.forget()
        browser.run(nearer.replace("/ 8", "/ 0.9"))
        browser.wait(rest)
        check("a coarser" not in browser.run(said) and browser.run(level) == 0, f"the fault has passed: {browser.run(said)}")


def main():
    need_viewer(PROGRAM)
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        write_pyramid(pathlib.Path(STORE))
        from_folder()
        if shutil.which("curl") is not None:
            server = servers.Server(pathlib.Path("stores"))
            url = f"{server.url}/a.zarr"
            os.environ["no_proxy"] = "127.0.0.1"
            os.environ.pop("http_proxy", None)
            for number, part in enumerate((few_bytes, moving_meanwhile, faults) + ((page,) if shutil.which("chromium") else ())):
                os.environ["XDG_CACHE_HOME"] = os.path.abspath(f"cache{number}")
                os.mkdir(f"cache{number}")
                part(server, url)
    print(f"{checks.count} checks")


if __name__ == "__main__":
    main()
