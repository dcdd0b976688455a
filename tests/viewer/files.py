#!/usr/bin/env python3
"""Opening other files, films, and two pages at once: by requests, and on the page in a headless Chromium.

usage: files.py PROGRAM
"""
import base64
import http.client
import io
import json
import math
import os
import pathlib
import shutil
import subprocess
import tempfile
import threading
import time
import zipfile

from PIL import Image

import checks
from browser import Browser
from checks import check
from dicom_files import dicom_slice
from hands import PROGRAM, center, changes, equals_render, final_picture, open_section, press, press_named, rest, scene_of, set_control
from viewer import Viewer, need_viewer


def request(viewer, method, path, body=None, **query):
    status, _, answer = viewer.request(method, path, body, **query)
    return status, answer


def folder_is_the_border(viewer):
    """Files below the folder that the viewer was started in are listed and opened, others are not."""
    status, body = request(viewer, "GET", "folder.json", at="")
    names = {entry["name"]: entry["folder"] for entry in json.loads(body)["entries"]}
    check(status == 200 and names == {"inside": True, "first.nrrd": False, "second.nrrd": False}, f"the list: {names}")
    inside = json.loads(request(viewer, "GET", "folder.json", at="inside")[1])["entries"]
    check([entry["name"] for entry in inside] == ["scene.json", "third.nrrd", "triangle.obj"], f"the folder in it: {inside}")
    for at in ("..", "inside/../..", "/etc", "away", "none", "first.nrrd", "a" * 5000):
        check(request(viewer, "GET", "folder.json", at=at)[0] == 404, f"the folder {at[:20]!r} is refused")
    for file in ("../outside/secret.nrrd", "away/secret.nrrd", "link.nrrd", "/etc/passwd", "none.nrrd", "notes.txt", "", "inside"):
        check(request(viewer, "POST", "open", file=file)[0] in (400, 403), f"the file {file} is refused")
    check(request(viewer, "POST", "open", file="broken.nrrd")[0] in (400, 403), "a broken file is an error")
    start = json.loads(request(viewer, "POST", "open", file="inside/scene.json")[1])
    check(os.path.isabs(start["scene"]["volumes"][0]["file"]) and start["title"] == "scene.json", "a scene can be opened")
    check(os.path.isabs(start["scene"]["meshes"][0]["file"]), "its meshes are named wherever the page's scene is saved")


def folders_are_volumes(viewer):
    """A folder of slices is opened as one volume; what its links lead to is not."""
    for folder in ("slices", "linked", "none"):
        os.mkdir(folder)
    for n in range(4):
        plane = Image.new("L", (6, 5), 40 * n)
        plane.save(f"slices/s_{n}.png")
        plane.save(f"../outside/s_{n}.png")
        os.symlink(f"../../outside/s_{n}.png", f"linked/s_{n}.png")
    status, body = request(viewer, "POST", "open", file="slices")
    start = json.loads(body)
    check(status == 200 and start["title"] == "slices" and start["volumes"][0]["dimensions"] == [6, 5, 4], "a folder of slices is a volume")
    check(start["scene"]["volumes"][0]["file"] == os.path.realpath("slices"), "and has its whole path")
    for folder in ("none", "linked"):
        status, line = request(viewer, "POST", "open", file=folder)
        check(status == 400 and line.decode().startswith(f"{folder}: "), f"the folder {folder} is no volume, and is named: {line}")
    for folder in ("slices", "linked", "none"):
        shutil.rmtree(folder)


def series_of_a_folder(viewer):
    """Of several DICOM series in a folder the largest is open at first, the others are told, and each can be opened, by an absolute name, too."""
    os.mkdir("scans")
    for n in range(9):
        with open(f"scans/IM{n}", "wb") as file:
            file.write(dicom_slice(n, [(0x0020000e, "UI", b"1.2.%d" % (3 + n % 3 // 2))]))
    start = json.loads(request(viewer, "POST", "open", file="scans")[1])
    told = [(one["choice"], one["modality"], one["dimensions"], one["chosen"]) for one in start["volumes"][0]["series"]]
    check(sorted(told) == [("1.2.3", "CT", [8, 8, 6], True), ("1.2.4", "CT", [8, 8, 3], False)], f"two series: {told}")
    other = json.loads(request(viewer, "POST", "open", file=os.path.realpath("scans"), series="1.2.4")[1])
    check(other["volumes"][0]["dimensions"] == [8, 8, 3] and other["scene"]["volumes"][0]["series"] == "1.2.4", "the other one, which its scene names")
    status, line = request(viewer, "POST", "open", file="scans", series="1.2.5")
    check(status == 400 and line.decode().startswith("scans: "), f"no such series: {line}")
    shutil.rmtree("scans")


def damaged(viewer, volume):
    """What is wrong with a dropped file is told under the name that it was dropped by, in one line."""
    subprocess.run([PROGRAM, "convert", "first.nrrd", "first.nii.gz", "--quiet"], check=True)
    with open("first.nii.gz", "rb") as file:
        packed = file.read()
    garbage = ["nrrd", "nii", "nii.gz", "mha", "mrc", "npy", "tif", "dcm", "vti", "vtk", "vtu", "nvdb", "mgz", "csv", "raw", "json", "zip", "nrrd.gz"]
    files = [(f"my scan.{ending}", content) for ending in garbage for content in (b"nonsense" * 9, b"")]
    files += [("cut.nrrd", volume[:len(volume) // 2]), ("cut.nrrd", volume[:40]), ("cut.nii.gz", packed[:len(packed) // 2]), ("cut.nii.gz", packed[:20]), ("cut_9x9x9_uint8.raw", b"abc"),
              ("header.nhdr", b"NRRD0004\ntype: uchar\ndimension: 3\nsizes: 4 4 4\nencoding: raw\ndata file: voxels.raw\n\n"),
              ("scene.json", b'{"halflight": 1, "volumes": [{"file": "../first.nrrd"}]}'), ("scene.json", b'{"halflight": 1, "volumes": [{"file": "/etc/passwd"}]}')]
    for name, content in files:
        status, line = request(viewer, "POST", "upload", content, name=name)
        check(status == 400 and line.startswith(name.encode()) and line.strip().count(b"\n") == 0, f"{name}: {status} {line[:200]}")
        check(b"halflight-view" not in line and os.environ["TMPDIR"].encode() not in line, f"{name}: a temporary name: {line[:200]}")


def uploads_are_checked(viewer):
    with open("first.nrrd", "rb") as file:
        volume = file.read()
    status, body = request(viewer, "POST", "upload", volume, name="dropped.nrrd")
    start = json.loads(body)
    check(status == 200 and start["scene"]["volumes"][0]["file"] == "dropped.nrrd" and start["opened"] > 0, "a dropped file is open")
    scene = start["scene"]
    scene["image"].update(width=32, height=32)
    text = json.dumps(scene)
    asked = {"page": "up", "number": 1, "format": "png"}
    check(request(viewer, "POST", "frame", text, opened=start["opened"], **asked)[0] == 200, "and can be rendered")
    check(request(viewer, "POST", "frame", text, **{**asked, "number": 2})[0] == 400, "under its own number alone")
    check(request(viewer, "POST", "frame", text, opened=999, **{**asked, "number": 3})[0] == 410, "a number that was never given")
    for name in ("", "a.txt", "../a.nrrd", "a/b.nrrd", ".nrrd", ".hidden.nrrd", "x" * 300 + ".nrrd"):
        check(request(viewer, "POST", "upload", volume, name=name)[0] == 400, f"the name {name[:20]!r} is refused")
    check(request(viewer, "POST", "upload", b"nonsense", name="a.nrrd")[0] == 400, "a file that is none")
    damaged(viewer, volume)
    left = [name for name in os.listdir(os.environ["TMPDIR"]) if name.startswith("halflight-view")]
    check(left == [], f"nothing is left of them: {left}")
    connection = http.client.HTTPConnection("127.0.0.1", viewer.port, timeout=60)
    connection.putrequest("POST", f"/{viewer.token}/upload?name=large.nrrd")
    connection.putheader("Content-Length", str(10 ** 15))
    connection.endheaders()
    answer = connection.getresponse()
    check(answer.status == 413 and b"--max-memory" in answer.read(), "a file larger than memory")
    connection.close()
    for _ in range(8):  # more than are kept
        check(request(viewer, "POST", "upload", volume, name="again.nrrd")[0] == 200, "many are opened in turn")


def films(viewer, scene):
    """A film by request; one that is cancelled; keys that are wrong."""
    small = json.loads(json.dumps(scene))
    small["image"].update(width=48, height=40)
    asked = {"page": "film", "format": "mp4", "turntable": 5}
    zipped = {**asked, "format": "zip", "page": "zip"}
    status, body = request(viewer, "POST", "film", json.dumps(small), number=1, key0="lights.0.intensity=0:1,4:2", **zipped)
    with open("small.json", "w") as file:
        json.dump(small, file)
    subprocess.run([PROGRAM, "animate", "small.json", "--turntable", "5", "--key", "lights.0.intensity=0:1,4:2", "-o", "pictures", "--quiet"],
                   check=True)
    own = [Image.open(pathlib.Path("pictures", name)) for name in sorted(os.listdir("pictures"))]
    archive = zipfile.ZipFile(io.BytesIO(body))
    check(status == 200 and archive.testzip() is None, f"pictures in an archive: {status}")
    check(archive.namelist() == [f"frame-{n}.png" for n in range(5)], f"their names: {archive.namelist()}")
    shown = [Image.open(io.BytesIO(archive.read(name))) for name in archive.namelist()]
    check([p.tobytes() for p in shown] == [p.tobytes() for p in own], "they are those of halflight animate")
    check(all("halflight:scene" in p.text for p in shown), "and carry their scenes")
    status, body = request(viewer, "POST", "film", json.dumps(small), number=1, key0="lights.0.intensity=0:1,4:2", **asked)
    if shutil.which("ffmpeg") is None:
        check(status == 400 and b"ffmpeg" in body, "without ffmpeg the page says so")
        return
    with open("film.mp4", "wb") as file:
        file.write(body)
    frames = subprocess.run(["ffprobe", "-v", "error", "-count_frames", "-show_entries", "stream=nb_read_frames,width,height", "-of", "csv=p=0",
                             "film.mp4"], capture_output=True, text=True).stdout.strip()
    check(status == 200 and frames == "48,40,5", f"a film of five frames: {frames}")
    subprocess.run([PROGRAM, "animate", "small.json", "--turntable", "5", "--key", "lights.0.intensity=0:1,4:2", "-o", "own.mp4", "--quiet"],
                   check=True)
    with open("own.mp4", "rb") as file:
        check(file.read() == body, "the film of halflight animate, byte for byte")
    check(request(viewer, "POST", "film", json.dumps(small), number=2, key0="lights.0.intensty=0:1", **asked)[0] == 400, "a wrong key")
    status, body = request(viewer, "POST", "scene", json.dumps(small), key0="lights.0.intensity=0:1,4:2", frames=5, frame=1)
    check(status == 200 and json.loads(body)["lights"][0]["intensity"] == 1.25, f"the scene at a frame: {status}")
    for wrong in ({"frame": -1}, {"frame": "x"}, {"frame": 1, "frames": 0.5}, {"frame": 1, "key0": "lights=0:1"}):
        check(request(viewer, "POST", "scene", json.dumps(small), **wrong)[0] == 400, f"no scene at {wrong}")
    small["image"].update(width=800, height=800)
    answers = []
    slow = threading.Thread(target=lambda: answers.append(request(viewer, "POST", "film", json.dumps(small), number=3,
                                                                  **{**asked, "turntable": 10000})[0]))
    slow.start()
    for _ in range(3000):
        time.sleep(0.1)
        progress = json.loads(request(viewer, "GET", "film.json", page="film")[1])
        if progress["frames"] == 10000 and progress["done"] > 0:
            break
    check(progress["frames"] == 10000 and progress["done"] > 0, f"a film tells how far it is: {progress}")
    check(request(viewer, "POST", "cancel", page="film", number=4)[0] == 204, "it can be stopped")
    slow.join(300)
    check(answers == [204], "and stops")


def fair_shares(viewer, scene):
    """Two pages that ask for frames all the time get about as many each, each of its own camera."""
    counts, pictures = [0, 0], [set(), set()]

    def ask(who):
        mine = json.loads(json.dumps(scene))
        mine["image"].update(width=160, height=160)
        mine["camera"]["position"][0] += 0.02 * who
        while sum(counts) < 24:
            status, body = request(viewer, "POST", "frame", json.dumps(mine), page=f"fair-{who}", number=counts[who] + 1, format="png")
            check(status == 200, "a frame of one of two pages")
            counts[who] += 1
            pictures[who].add(body)

    threads = [threading.Thread(target=ask, args=(who,)) for who in (0, 1)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    check(len(pictures[0]) == len(pictures[1]) == 1 and pictures[0] != pictures[1], "each page has its own camera")
    check(min(counts) >= 3 and max(counts) < 2 * min(counts), f"two pages get fair shares: {counts}")


def to_frame(browser, frame):
    """Moves the timeline's slider, and waits for the frame's scene."""
    browser.run("window.told = false; halflight.store.listen((_, name) => { window.told ||= name === 'time'; }); 0")
    browser.run(f"(() => {{ const s = document.querySelector('[aria-label=Frame]'); s.value = {frame}; s.dispatchEvent(new Event('input')); }})()")
    browser.wait("told")


def timeline(browser):
    """Keys of the camera and of a number: what the page shows at a frame is the frame of the copied command's film."""
    open_section(browser, "Film")
    browser.run("(() => { const n = document.querySelector('[aria-label=\"Frames of the film\"]'); n.value = 5; n.dispatchEvent(new Event('change')); })()")
    press(browser, "key of the camera now")
    first = scene_of(browser)["camera"]
    to_frame(browser, 4)
    browser.run("import('./camera.js').then((m) => halflight.store.setCamera(m.zoom(m.turn(halflight.store.scene.camera, 1.6, 0.2), 1.3)))")
    press(browser, "key of the camera now")
    last = scene_of(browser)["camera"]
    browser.run("document.querySelector('[aria-label=\"A number of the scene\"]').value = 'lights.0.intensity'")
    press(browser, "key of this number now")
    to_frame(browser, 0)
    browser.run("halflight.store.changeLight(0, 'intensity', (l) => ({ ...l, intensity: 3 }))")
    press(browser, "key of this number now")
    check(browser.run("[...document.querySelectorAll('.track-name')].map((n) => n.textContent)") == ["camera", "light 1, intensity"], "two tracks")
    check(browser.run("document.querySelectorAll('.key').length") == 4, "two keys each")
    to_frame(browser, 2)

    def reach(camera):
        return math.dist(camera["position"], camera["target"])

    at = scene_of(browser)
    check(abs(reach(at["camera"]) / math.sqrt(reach(first) * reach(last)) - 1) < 1e-6, "half way the camera is at the mean of both distances")
    arms = [[p - t for p, t in zip(c["position"], c["target"])] for c in (first, at["camera"], last)]
    angles = [math.acos(sum(x * y for x, y in zip(a, b)) / math.hypot(*a) / math.hypot(*b)) for a, b in zip(arms, arms[1:])]
    check(abs(angles[0] - angles[1]) < 1e-6, f"and has turned by half of the angle: {angles}")
    shown = final_picture(browser)
    browser.run("(() => { const s = [...document.querySelectorAll('select')].find((x) => x.value === 'mp4'); s.value = 'zip'; s.dispatchEvent(new Event('change')); })()")
    browser.run("window.copied = ''; navigator.clipboard.writeText = async (text) => { copied = text; }; 0")
    press(browser, "copy animate command")
    browser.wait("copied !== ''")
    environment = dict(os.environ, PATH=f"{os.path.dirname(PROGRAM)}:{os.environ['PATH']}")
    subprocess.run(["sh", "-eu", "-c", browser.run("copied")], env=environment, check=True, capture_output=True)
    names = sorted(os.listdir("dropped"))
    check(len(names) == 5, f"five pictures: {names}")
    own = Image.open(pathlib.Path("dropped", names[2])).convert("RGBA").tobytes()
    check(own == Image.open(io.BytesIO(shown)).convert("RGBA").tobytes(), "the frame of the film is the one that was shown")
    browser.run("(() => { const s = [...document.querySelectorAll('select')].find((x) => x.value === 'zip'); s.value = 'mp4'; s.dispatchEvent(new Event('change')); })()")
    browser.run("document.querySelector('.key').focus()")
    browser.key("ArrowRight")
    check(browser.run("document.activeElement.dataset.frame") == "1", "an arrow key moves a key")
    x, y = center(browser, ".key")
    browser.drag([x, y], [x + 0.25 * browser.run("document.querySelector('.track-keys').clientWidth"), y])
    check(browser.run("document.querySelector('.key').dataset.frame") == "2", "a key is dragged")
    browser.run("document.querySelector('.key').focus()")
    browser.key("Delete")
    check(browser.run("document.querySelectorAll('.key').length") == 3, "Delete removes a key")
    press(browser, "play")
    browser.wait("halflight.frames.statistics.stage === 'moving'")
    press(browser, "stop playing")
    rest(browser)


def joined(viewer, scene):
    """A mesh is opened alone; volumes and meshes are added to a page's own scene, whose light and direction of view stay."""
    status, body = request(viewer, "POST", "open", file="inside/triangle.obj")
    mesh = json.loads(body)
    check(status == 200 and mesh["volumes"] == [] and mesh["scene"]["meshes"][0]["file"] == os.path.realpath("inside/triangle.obj"), f"a mesh alone: {status}")
    mine = json.loads(json.dumps(scene))
    mine["lights"][0]["intensity"] = 0.7
    status, body = request(viewer, "POST", "join", json.dumps(mine), opened=0, **{"with": mesh["opened"]}, title="both")
    both = json.loads(body)
    check(status == 200 and both["title"] == "both" and both["opened"] not in (0, mesh["opened"]), f"they are open together: {status}")
    check(both["scene"]["lights"] == mine["lights"] and both["scene"]["volumes"] == mine["volumes"], "what the page had done stays")
    check([one["file"] for one in both["scene"]["meshes"]] == [mesh["scene"]["meshes"][0]["file"]], "with the mesh")
    check(request(viewer, "POST", "join", json.dumps(mine), opened=0, **{"with": mesh["opened"]}, title="again")[0] == 410, "what was added is open no longer by itself")
    again = json.loads(request(viewer, "POST", "open", file="inside/triangle.obj")[1])
    third = json.loads(request(viewer, "POST", "open", file="inside/third.nrrd")[1])
    both = json.loads(request(viewer, "POST", "join", json.dumps(both["scene"]), opened=both["opened"], **{"with": again["opened"]}, title="three")[1])
    colors = [one["color"] for one in both["scene"]["meshes"]]
    check(len(colors) == 2 and colors[0] != colors[1], f"the second mesh has a colour of its own: {colors}")
    both = json.loads(request(viewer, "POST", "join", json.dumps(both["scene"]), opened=both["opened"], **{"with": third["opened"]}, title="four")[1])
    names = [os.path.basename(one["file"]) for one in both["scene"]["volumes"]]
    check(names == ["first.nrrd", "third.nrrd"] and len(both["scene"]["meshes"]) == 2 and len(both["volumes"]) == 2, f"all four: {names}")
    small = json.loads(json.dumps(both["scene"]))
    small["image"].update(width=32, height=32)
    check(request(viewer, "POST", "frame", json.dumps(small), opened=both["opened"], page="join", number=1, format="png")[0] == 200, "and can be rendered")
    for query in ({}, {"with": 0}, {"with": "x"}, {"with": both["opened"]}):
        check(request(viewer, "POST", "join", json.dumps(both["scene"]), opened=both["opened"], title="t", **query)[0] == 400, f"{query} is refused")
    request(viewer, "POST", "leave", page="join", opened=both["opened"])


def reloaded(browser):
    """Reloads the page once it has kept its state."""
    kept = "JSON.stringify(JSON.parse(sessionStorage.getItem('halflight-session') ?? '{}').scene) === JSON.stringify(halflight.store.scene)"
    browser.wait(kept)
    browser.run("window.old = true; 0")
    browser.call("Page.reload")
    browser.wait("window.old === undefined && globalThis.halflight !== undefined")
    rest(browser)


def undone_and_redone(browser):
    """Undo goes on to what was done before a file was added, redo brings the file back, and another one can be added in its place."""
    has_meshes = "(halflight.store.scene.meshes ?? []).length"
    browser.run("document.getElementById('undo').focus(); document.getElementById('undo').click()")
    rest(browser)
    check(scene_of(browser)["meshes"][0].get("visible", True) is True and browser.run(has_meshes) == 1, "the mesh is shown again")
    browser.run("document.getElementById('undo').click()")
    check(browser.run(has_meshes) == 0 and scene_of(browser)["render"]["shadows"] == "hard", "undo takes the added mesh away")
    check(browser.run("document.activeElement.id") == "undo", "the focus stays")
    called = "[document.getElementById('title').textContent, document.title]"
    check(browser.run(called) == ["first.nrrd", "first.nrrd · Halflight"], f"called as before: {browser.run(called)}")
    check(browser.run("[...document.querySelectorAll('.section')].find((e) => e.firstElementChild.textContent === 'Meshes').hidden"), "and its panel")
    equals_render(browser, "without")
    browser.run("document.getElementById('undo').click()")
    check(scene_of(browser)["render"]["shadows"] != "hard" and browser.run("halflight.store.canUndo") is False, "undo goes on before it")
    reloaded(browser)
    check(browser.run(has_meshes) == 0 and browser.run("halflight.store.canRedo") is True, "a reload keeps what is undone")
    check(browser.run(called) == ["first.nrrd", "first.nrrd · Halflight"], "and what it is called")
    for _ in range(2):
        browser.run("document.getElementById('redo').click()")
        rest(browser)
    check(browser.run(has_meshes) == 1 and browser.run("halflight.start.scene.meshes.length") == 1, "redo brings the mesh back")
    check(browser.run(called) == ["first.nrrd + triangle.obj", "first.nrrd + triangle.obj · Halflight"], "and its name")
    equals_render(browser, "again")
    browser.run("document.getElementById('undo').click()")
    rest(browser)
    open_section(browser, "Open")
    browser.wait("[...document.querySelectorAll('.files button')].some((b) => b.textContent === '‹ back')")  # the list began where the mesh lies
    press(browser, "‹ back")
    browser.wait("[...document.querySelectorAll('.files button')].some((b) => b.textContent === 'second.nrrd')")
    set_control(browser, "Add to what is open", "", section="Open")
    press(browser, "second.nrrd")
    browser.wait("halflight.store.scene.volumes.length === 2")
    equals_render(browser, "other")
    check(browser.run("document.title") == "first.nrrd + second.nrrd · Halflight", "the mesh that is undone is not in the name")
    reloaded(browser)
    check(browser.run("halflight.store.scene.volumes.length === 2 && halflight.start.volumes.length === 2") and browser.run(has_meshes) == 0, "another file takes the place of the one that is undone")
    browser.run("document.getElementById('undo').click()")
    check(browser.run("halflight.store.scene.volumes.length === 1 && document.querySelector('.chooser').hidden"), "a volume is taken away, too")
    equals_render(browser, "single")


def several_files(browser, url):
    """Files are added from the list, and several are dropped at once; a reload brings them back; the panel of meshes changes them."""
    browser.run("sessionStorage.clear()")
    browser.open(url)
    browser.wait("document.getElementById('title')?.textContent === 'first.nrrd'")
    rest(browser)
    open_section(browser, "Open")
    browser.wait("[...document.querySelectorAll('.files button')].some((b) => b.textContent === 'second.nrrd')")
    browser.run("halflight.store.changeRender('shadows', 'hard')")
    set_control(browser, "Add to what is open", "", section="Open")
    press(browser, "inside ›")
    browser.wait("[...document.querySelectorAll('.files button')].some((b) => b.textContent === 'triangle.obj')")
    press(browser, "triangle.obj")
    browser.wait("document.getElementById('title').textContent === 'first.nrrd + triangle.obj'")
    equals_render(browser, "added")
    both = scene_of(browser)
    check(len(both["volumes"]) == 1 and len(both["meshes"]) == 1 and both["render"]["shadows"] == "hard", "the mesh is added to what was made")
    changes(browser, "a mesh that is hidden", lambda: press_named(browser, "Show triangle.obj"), "meshes")
    check(scene_of(browser)["meshes"][0]["visible"] is False, "its eye")
    browser.wait("JSON.parse(sessionStorage.getItem('halflight-session') ?? '{}').scene?.meshes?.[0].visible === false")
    browser.run("window.old = true; 0")
    browser.call("Page.reload")
    browser.wait("window.old === undefined && document.getElementById('title')?.textContent === 'first.nrrd + triangle.obj'")
    rest(browser)
    check(scene_of(browser)["meshes"][0]["visible"] is False, "a reload goes on with both")
    undone_and_redone(browser)
    browser.run("""(() => {
      const data = new DataTransfer(), bytes = Uint8Array.from(atob(%s), (c) => c.charCodeAt(0));
      data.items.add(new File([bytes], 'one.nrrd'));
      data.items.add(new File(['v 0 0 0\\nv 9 0 0\\nv 0 9 9\\nf 1 2 3\\n'], 'two.obj'));
      document.querySelector('.viewer').dispatchEvent(new DragEvent('drop', { dataTransfer: data, bubbles: true, cancelable: true }));
    })()""" % json.dumps(base64.b64encode(pathlib.Path("first.nrrd").read_bytes()).decode()))
    browser.wait("document.getElementById('title').textContent === 'one.nrrd + two.obj'")
    rest(browser)
    check(len(scene_of(browser)["meshes"]) == 1, "files that are dropped together are one scene")
    check(browser.problems == [], f"the console has errors: {browser.problems}")


def on_the_page(browser):
    """The list and a dropped file open volumes; the film panel makes one."""
    rest(browser)
    browser.run("[...document.querySelectorAll('summary')].find((s) => s.textContent === 'Open').click()")
    browser.wait("[...document.querySelectorAll('.files button')].some((b) => b.textContent === 'second.nrrd')")
    press(browser, "second.nrrd")
    browser.wait("document.getElementById('title').textContent === 'second.nrrd'")
    equals_render(browser, "listed")
    check(scene_of(browser)["volumes"][0]["file"].endswith("/second.nrrd"), "the list opens a file")
    browser.run("""(() => {
      const data = new DataTransfer();
      data.items.add(new File([Uint8Array.from(atob(window.volume), (c) => c.charCodeAt(0))], 'dropped.nrrd'));
      document.querySelector('.viewer').dispatchEvent(new DragEvent('drop', { dataTransfer: data, bubbles: true, cancelable: true }));
    })()""")
    browser.wait("document.getElementById('title').textContent === 'dropped.nrrd'")
    rest(browser)
    shutil.copy("first.nrrd", "dropped.nrrd")
    check(scene_of(browser)["volumes"][0]["file"] == "dropped.nrrd", "a dropped file is named without a folder")
    browser.run("document.getElementById('view').focus()")
    turned = "halflight.store.scene.camera.position.join()"
    before = browser.run(turned)
    browser.key("ArrowLeft")
    check(browser.run(turned) != before, "keys work on after another file")
    rest(browser)
    timeline(browser)
    if shutil.which("ffmpeg"):
        browser.run("""(() => {
          window.saved = []; URL.createObjectURL = (blob) => { saved.push([blob.type, blob.size]); return 'blob:none'; };
          HTMLAnchorElement.prototype.click = () => {};
        })()""")
        press(browser, "make film")
        browser.wait("saved.length > 0", timeout=60)
        check(browser.run("saved[0][0] === 'video/mp4' && saved[0][1] > 1000"), "the page makes a film")
    command = browser.run("""import('./film_panel.js').then((m) => m.animateCommand(halflight.store.scene, 'a b.nrrd',
      { turntable: 3, frames: 3, keys: ['lights.0.intensity=0:1,2:2'], fps: 10, format: 'gif' }))""")
    environment = dict(os.environ, PATH=f"{os.path.dirname(PROGRAM)}:{os.environ['PATH']}")
    done = subprocess.run(["sh", "-eu", "-c", command], env=environment, capture_output=True, text=True)
    check(done.returncode == 0, f"the copied command runs: {done.stderr}")
    check(browser.problems == [], f"the console has errors: {browser.problems}")


chromium = shutil.which("chromium")
with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    os.environ["TMPDIR"] = tempfile.tempdir = folder + "/temporary"
    for name in ("temporary", "outside", "work", "work/inside"):
        os.mkdir(name)
    os.chdir("work")
    need_viewer(PROGRAM)
    for shape, path in (("rings", "first"), ("torus", "second"), ("fire-ball", "inside/third"), ("torus", "../outside/secret")):
        subprocess.run([PROGRAM, "make", shape, "--size", "24", "--quiet", "-o", f"{path}.nrrd"], check=True)
    with open("inside/scene.json", "w") as file:
        file.write('{"halflight": 1, "volumes": [{"file": "third.nrrd"}], "meshes": [{"file": "triangle.obj"}]}')
    with open("inside/triangle.obj", "w") as file:
        file.write("v 0 0 0\nv 9 0 0\nv 0 9 9\nf 1 2 3\n")
    os.symlink("../outside", "away")
    os.symlink("../outside/secret.nrrd", "link.nrrd")
    with open("notes.txt", "w") as file:
        file.write("not a volume")
    with Viewer(PROGRAM, "first.nrrd") as viewer:
        start = json.loads(request(viewer, "GET", "start.json")[1])
        folder_is_the_border(viewer)
        films(viewer, start["scene"])
        fair_shares(viewer, start["scene"])
        folders_are_volumes(viewer)
        series_of_a_folder(viewer)
        joined(viewer, start["scene"])
        uploads_are_checked(viewer)
    if chromium is not None:
        with Viewer(PROGRAM, "first.nrrd") as viewer, Browser(chromium, (720, 420)) as browser:
            browser.open(viewer.url)
            rest(browser)
            with open("first.nrrd", "rb") as file:
                browser.run(f"window.volume = '{base64.b64encode(file.read()).decode()}'; 0")
            on_the_page(browser)
            several_files(browser, viewer.url)
        with Viewer(PROGRAM, "inside/triangle.obj") as viewer, Browser(chromium, (720, 420)) as browser:
            browser.open(viewer.url)
            equals_render(browser, "mesh")
            check(browser.problems == [], f"a mesh alone: the console has errors: {browser.problems}")
    print(f"{checks.count} checks passed")
