#!/usr/bin/env python3
"""Volumes of several resolutions in the viewer: the coarsest is there first, finer ones follow, and a picture that is saved waits for
them.

usage: refinement.py PROGRAM
"""
import json
import os
import pathlib
import shutil
import sys
import tempfile
import threading
import zlib

import numpy

import checks
from browser import Browser
from checks import check
from viewer import Viewer, need_viewer

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "cli"))
import servers  # noqa: E402

PROGRAM = os.path.abspath(sys.argv[1])
SIDE, CHUNK, LEVELS = 512, 64, 4


def write_pyramid(folder):
    """Levels of 512^3 to 64^3 voxels of a small ball in the middle, whose surface is rough at the finest level alone. Empty chunks are
    missing."""
    noise = numpy.random.default_rng(1)
    folder.mkdir(parents=True)
    for level in range(LEVELS):
        size, array = SIDE >> level, folder / str(level)
        array.mkdir()
        (array / ".zarray").write_text(json.dumps(
            {"zarr_format": 2, "shape": [size] * 3, "chunks": [CHUNK] * 3, "dtype": "|u1", "compressor": {"id": "zlib", "level": 1},
             "fill_value": 0, "order": "C", "filters": None, "dimension_separator": "/"}))
        middle = size // CHUNK // 2
        near = range(max(middle - 1, 0), min(middle + 1, size // CHUNK))
        for place in ((z, y, x) for z in near for y in near for x in near):
            z, y, x = (CHUNK * p + numpy.arange(CHUNK) + 0.5 - size / 2 for p in place)
            distance = numpy.sqrt(z[:, None, None] ** 2 + y[None, :, None] ** 2 + x[None, None, :] ** 2) * 10 / size
            if level == 0:
                distance += noise.uniform(0, 0.1, distance.shape)
            chunk = (numpy.clip(8 * (1 - distance) + 0.5, 0, 1) * 250).astype("u1")
            file = array.joinpath(*map(str, place))
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_bytes(zlib.compress(chunk.tobytes(), 1))
    (folder / ".zgroup").write_text('{"zarr_format": 2}')
    (folder / ".zattrs").write_text(json.dumps({"multiscales": servers.levels_text(LEVELS)}))


numbers = iter(range(1, 10**6))


def frame(viewer, scene, page="test", **more):
    query = "".join(f"&{key}={value}" for key, value in more.items())
    return viewer.request("POST", f"frame?page={page}&number={next(numbers)}&format=png{query}", json.dumps(scene))


def quick_frame(viewer, scene):
    """A frame as the page asks for it to show it: it waits for no finer level."""
    query = f"frame?page=test&number={next(numbers)}&format=jpeg&quality=80&coarse=1"
    return viewer.request("POST", query, json.dumps(scene))


def small(scene, side=96):
    scene = json.loads(json.dumps(scene))
    scene["image"].update(width=side, height=side)
    return scene


def told(viewer, name, opened=0):
    return json.loads(viewer.request("GET", f"{name}.json?opened={opened}")[2])


def from_disk():
    """Files that a page opens are read from coarse to fine, and a scene that is closed ends the reading."""
    with Viewer(PROGRAM, "stores/a.zarr/3") as viewer:
        check(not told(viewer, "start")["refining"], "an array of one resolution")
        opened = json.loads(viewer.request("POST", "open?file=stores/a.zarr")[2])
        check(opened["refining"] and opened["volumes"][0]["dimensions"] == [128] * 3, "a file that a page opens")
        scene = small(opened["scene"])
        check(scene["volumes"][0]["level"] == 0, "its scene names the level")
        status, _, picture = frame(viewer, scene, opened=opened["opened"])
        now = told(viewer, "refined", opened["opened"])
        check(status == 200 and now["refined"] == 2 and not now["refining"], f"its picture: {status} {now}")
        coarser = {**scene, "volumes": [{**scene["volumes"][0], "level": 2}]}
        check(frame(viewer, coarser, opened=opened["opened"])[0] == 400, "a scene of another level is not taken for this one")
        again = json.loads(viewer.request("POST", "open?file=stores/a.zarr")[2])
        viewer.request("POST", f"leave?page=test&opened={again['opened']}")
        check(viewer.interrupt(20) == 0, "the viewer ends while a level is read")
        check(len(picture) > 1000, "a picture")


def is_finer(name):
    """Whether a server's file is a chunk of a finer level than the first one that is read."""
    return name.startswith(("a.zarr/0/", "a.zarr/1/")) and name[-1].isdigit()


def final_picture(path):
    with Viewer(PROGRAM, path) as viewer:
        scene = small(told(viewer, "start")["scene"])
        status, _, picture = frame(viewer, scene, metadata=0)
        check(status == 200, f"the picture of {path}: {status}")
    return picture


def coarse_first(server, url, right):
    """While the server holds the finer levels back, the page has the coarsest one."""
    released = threading.Event()
    server.forget()
    server.hold = lambda name: released.wait() if is_finer(name) else None
    with Viewer(PROGRAM, url) as viewer:
        start = told(viewer, "start")
        check(start["refining"] and start["volumes"][0]["dimensions"] == [128] * 3, f"the coarsest level first: {start['refining']}")
        check(quick_frame(viewer, small(start["scene"]))[0] == 200, "a picture of the coarsest level")
        check(told(viewer, "refined") == {"refined": 0, "refining": True, "problem": ""}, "finer levels are awaited")
        released.set()
        status, _, picture = frame(viewer, small(start["scene"]), metadata=0)
        check(status == 200 and picture == right, f"the finest level's picture is the folder's: {status}")
    server.hold = None
    needed = sum(file.stat().st_size for file in pathlib.Path("stores/a.zarr/0").rglob("*") if file.is_file())
    check(needed < server.sent < 3 * needed, f"at most 3 times the finest level's bytes: {server.sent}, {needed}")


def passing_faults(server, url, right):
    """A fault that passes does no harm."""
    for kinds in (["500"], ["cut"]):
        server.forget(**{"a.zarr__0__3__3__3": kinds})
        check(final_picture(url) == right, f"{kinds}, then the file")


def lasting_faults(server, url):
    """Where a chunk of the finest level does not come as it is, the page goes on with the level before, and nothing is saved."""
    for fault, words in (("500", "the server answers 500"), ("403", "the server answers 403"), ("cut", "it does not arrive"),
                         ("page", "a chunk does not unpack"), ("half", "a chunk does not unpack"),
                         ("flipped", "a chunk does not unpack")):
        server.forget(**{"a.zarr__0__3__3__3": ["always", fault]})
        with Viewer(PROGRAM, url) as viewer:
            scene = small(told(viewer, "start")["scene"])
            status, _, line = frame(viewer, scene)
            check(status == 400 and words in line.decode() and "only a coarser resolution was read" in line.decode(),
                  f"{fault}: nothing is saved: {status} {line}")
            now = told(viewer, "refined")
            check(now["refined"] == 1 and not now["refining"] and words in now["problem"], f"{fault}: the page is told: {now}")
            check(quick_frame(viewer, scene)[0] == 200, f"{fault}: the page goes on")
            check(told(viewer, "start")["volumes"][0]["dimensions"] == [256] * 3, f"{fault}: the level before the finest")


def absent_chunks(server, url):
    """A server that has no file for a chunk: its voxels have the fill value, and the page says so for as long as it shows them."""
    (pathlib.Path("stores/a.zarr/0/3/3/3")).rename("kept")
    server.forget()
    try:
        with Viewer(PROGRAM, url) as viewer:
            check(told(viewer, "start")["refining"], "it is read from coarse to fine")
            line = "the server has no file for 505 of 512 chunks: their voxels have the fill value"
            if shutil.which("chromium"):
                with Browser(size=(390, 844)) as browser:
                    browser.open(viewer.url)
                    browser.wait(f"document.getElementById('message')?.hidden === false && document.getElementById('message').textContent.includes({json.dumps(line)})")
                    browser.wait("globalThis.halflight.frames.statistics.stage === 'final'")
                    said = browser.run("[document.getElementById('resolution').title, ...[...document.querySelectorAll('.facts')].map((one) => one.textContent)].join('|')")
                    check(said.count(line) == 2, f"the line below the picture and the panel say it: {said}")
                    check(browser.run("(({ left, right }) => left >= 0 && right <= innerWidth)(document.getElementById('resolution').getBoundingClientRect())"), "within the page")
            status, _, _ = frame(viewer, small(told(viewer, "start")["scene"]))
            check(status == 200 and told(viewer, "start")["volumes"][0]["absent_chunks"] == [505, 512], f"seven of eight chunks are there: {told(viewer, 'start')['volumes'][0]['absent_chunks']}")
    finally:
        pathlib.Path("kept").rename("stores/a.zarr/0/3/3/3")
    with Viewer(PROGRAM, "stores/a.zarr") as viewer:
        frame(viewer, small(told(viewer, "start")["scene"]))
        check(told(viewer, "start")["volumes"][0]["absent_chunks"] == [0, 0], "a folder's files can be seen: nothing is said")


def from_server():
    """A store on a server, by its URL on the command line."""
    server = servers.Server(pathlib.Path("stores"))
    url = f"{server.url}/a.zarr"
    os.environ["no_proxy"] = "127.0.0.1"
    os.environ.pop("http_proxy", None)
    right = final_picture("stores/a.zarr")
    for number, part in enumerate((lambda: coarse_first(server, url, right), lambda: passing_faults(server, url, right),
                                   lambda: lasting_faults(server, url), lambda: absent_chunks(server, url))):
        os.environ["XDG_CACHE_HOME"] = os.path.abspath(f"cache{number}")
        os.mkdir(f"cache{number}")
        part()


def main():
    need_viewer(PROGRAM)
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        write_pyramid(pathlib.Path("stores/a.zarr"))
        from_disk()
        if shutil.which("curl") is not None:
            from_server()
    print(f"{checks.count} checks")


if __name__ == "__main__":
    main()
