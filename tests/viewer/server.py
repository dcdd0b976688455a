#!/usr/bin/env python3
"""The viewer's server: what it answers, what it refuses, and that it outlives bad clients.

usage: server.py PROGRAM
"""
import http.client
import io
import json
import os
import resource
import shutil
import socket
import subprocess
import sys
import tempfile
import threading
import time
import urllib.parse

import numpy
from PIL import Image

import checks
from checks import check
from viewer import Viewer, need_viewer

PROGRAM = os.path.abspath(sys.argv[1])


def request(viewer, method, path, body=None, **headers):
    """(status, headers, body)"""
    return viewer.request(method, path, body, {name.replace("_", "-"): value for name, value in headers.items()})


numbers = iter(range(1, 10**6))
later = iter(range(100, 10**6))  # of a page whose first frames have numbers of their own


def frame(viewer, scene, page="test", format="png", number=None, **more):
    query = f"frame?page={page}&number={number or next(numbers)}&format={format}"
    query += "".join(f"&{key}={value}" for key, value in more.items())
    return request(viewer, "POST", query, json.dumps(scene))


def small(scene, side=96):
    scene = json.loads(json.dumps(scene))
    scene["image"].update(width=side, height=side)
    return scene


def pixels(png):
    with Image.open(io.BytesIO(png)) as image:
        return image.convert("RGBA").tobytes()


def exact_pictures(viewer, scene):
    """A frame in PNG and EXR has the bytes that `halflight render` writes of the same scene, and the scene's bytes too."""
    with open("scene.json", "w") as file:
        json.dump(scene, file)
    os.mkdir("rendered")  # beside its data a picture would name them relative to itself
    for format, depth, metadata in (("png", 8, 1), ("png", 16, 1), ("exr", 8, 1), ("png", 8, 0)):
        status, headers, body = frame(viewer, scene, format=format, depth=depth, metadata=metadata)
        subprocess.run([PROGRAM, "render", "scene.json", "-o", f"rendered/picture.{format}", "--quiet",
                        *(["--depth", str(depth)] if format == "png" else []), *([] if metadata else ["--no-metadata"])], check=True)
        with open(f"rendered/picture.{format}", "rb") as file:
            check(status == 200 and body == file.read(), f"{format} of depth {depth} differs from halflight render's")
        check((b"halflight:scene" in body) == (format == "png" and metadata == 1), "the scene in it, or not")
        check("render;dur=" in headers["Server-Timing"], "a frame tells its times")
    status, headers, body = frame(viewer, scene, format="jpeg", quality=70)
    times = {name: float(value) for name, value in (part.split(";dur=") for part in headers["Server-Timing"].split(", "))}
    check(0 < times["processor"] < os.cpu_count() * 1.1 * (times["read"] + times["render"] + times["encode"]), f"a frame tells its processor time: {times}")
    check(status == 200 and body[:3] == b"\xff\xd8\xff" and headers["Content-Type"] == "image/jpeg", "a JPEG frame")


def drawn_over(viewer, scene):
    """A scale bar, a legend and axes are those of `halflight render`, alone or in the picture. They are refused where the files do not tell what
    they say, or where the format does not hold them."""
    os.mkdir("drawn")

    def equals(viewer, scene, words, **asked):
        status, _, body = frame(viewer, scene, **asked)
        with open("drawn.json", "w") as file:
            json.dump(scene, file)
        subprocess.run([PROGRAM, "render", "drawn.json", *words, "-o", "drawn/picture.png", "--quiet"], check=True)
        with open("drawn/picture.png", "rb") as file:
            check(status == 200 and body == file.read(), f"{words}: {status} {body[:99] if status != 200 else ''}")
        lies_over(viewer, scene, body, asked)
        return body

    def with_room(scene):
        """The legend has room beside the matter. Where it has none, the program puts it below the picture."""
        return scene | {"camera": scene["camera"] | {"fovy_deg": 75}, "image": scene["image"] | {"width": 320, "height": 240}}

    roomy = with_room(scene)
    legend = equals(viewer, roomy, ["--legend", "auto"], legend=1)
    check(pixels(legend) != pixels(frame(viewer, roomy)[2]), "the legend is seen")
    plain = frame(viewer, scene)[2]
    equals(viewer, scene, ["--unit", "kpc", "--scale-bar", "auto@target"], scale_bar=1, unit="kpc")
    check(pixels(equals(viewer, scene, ["--axes", "arrows"], axes="arrows")) != pixels(plain), "the axes are seen")
    target = scene["camera"]["target"]
    marked = scene | {"marks": [{"kind": "ruler", "points": [target, [target[0] + 0.3, *target[1:]]], "text": "r"}, {"kind": "text", "points": [target], "text": "t"}]}
    check(pixels(equals(viewer, marked, ["--unit", "kpc", "--marks"], marks=1, unit="kpc")) != pixels(plain), "the marks are seen")
    check(pixels(frame(viewer, marked)[2]) == pixels(plain), "marks change no picture by themselves")
    for asked in ({"axes": "letters"}, {"axes": "arrow"}, {"scale_bar": 1}, {"legend": 1, "depth": 16}, {"legend": 1, "format": "exr"}, {"legend": 1, "format": "jpeg"}, {"legend": 2}, {"marks": 1}):
        status, _, body = frame(viewer, scene, **asked)
        check(status == 400 and body.count(b"\n") <= 1 and any(word in body for word in (b"unit", b"8 bits", b"directions", b"none")), f"{asked}: {status} {body}")
    subprocess.run([PROGRAM, "convert", "torus.nrrd", "torus.mrc", "--quiet"], check=True)
    with Viewer(PROGRAM, "torus.mrc") as measured:
        scene = with_room(json.loads(request(measured, "GET", "start.json")[2])["scene"])
        bar = equals(measured, scene, ["--scale-bar", "auto@target", "--legend", "auto"], scale_bar=1, legend=1)
        check(pixels(bar) != pixels(frame(measured, scene)[2]), "the bar is seen")
        scene["image"]["background_transparent"] = True
        scene["camera"] = {"type": "orthographic", "height": 2, **{key: scene["camera"][key] for key in ("position", "target", "up")}}
        equals(measured, scene, ["--scale-bar", "auto"], scale_bar=1)


def shared_with_picture(viewer, scene):
    """The overlay of the picture that its page has been shown last is made without a renderer of its own; that of another scene, or of
    another page, renders a small picture."""
    def overlay(asked, page="sharing"):
        status, headers, body = request(viewer, "POST", f"overlay?page={page}-overlay&number={next(numbers)}&legend=1", json.dumps(asked))
        check(status == 200, f"an overlay: {status}")
        return body, "Server-Timing" in headers

    other = json.loads(json.dumps(scene))
    other["image"]["exposure"] = 0.5
    alone = overlay(scene)
    check(alone[1], "no picture was made yet")
    frame(viewer, scene, page="sharing", moving=1)
    check(overlay(scene)[1], "nor one at rest")
    frame(viewer, scene, page="sharing")
    shared, rendered = overlay(scene)
    check(not rendered, "the picture tells where the matter is")
    check(abs(levels(shared) - levels(alone[0])).max() == 0, "the legend lies where it lay")
    check(overlay(other)[1] and overlay(scene, page="sharin")[1], "another scene, and another page")
    frame(viewer, other, page="sharing")
    check(not overlay(other)[1] and overlay(scene)[1], "the newest picture counts")
    request(viewer, "POST", "leave?page=sharing")
    check(overlay(other)[1], "a page that has gone has none")


def levels(png):
    with Image.open(io.BytesIO(png)) as image:
        return numpy.asarray(image.convert("RGBA"), dtype=float)


def lies_over(viewer, scene, drawn, asked):
    """The overlay alone, laid over the picture without it, is the picture with it, up to the roundings of both to 8 bits: it knows where the
    picture shows matter."""
    query = "".join(f"&{key}={value}" for key, value in asked.items())
    status, _, body = request(viewer, "POST", f"overlay?page=test-overlay&number={next(numbers)}{query}", json.dumps(scene))
    check(status == 200, f"the overlay alone: {status}")
    over, plain, both = levels(body), levels(frame(viewer, scene)[2]), levels(drawn)
    part = over[..., 3:] / 255
    behind = plain[..., 3:] / 255 * (1 - part)
    laid = part * over[..., :3] + behind * plain[..., :3]
    change = both[..., 3:] / 255 * both[..., :3] - laid
    check(over.shape == both.shape and over[..., 3].max() > 0 and abs(change).max() <= 3, f"{asked}: {abs(change).max()} levels")


def overlays_without_room(viewer, scene):
    """A legend that finds no room is left out of a picture and of its overlay, and both answers say so; one that has room says nothing."""
    for side, told in ((20, True), (160, False)):
        asked = small(scene, side)
        for status, headers, _ in (frame(viewer, asked, legend=1), request(viewer, "POST", f"overlay?page=test-overlay&number={next(numbers)}&legend=1", json.dumps(asked))):
            note = urllib.parse.unquote(headers.get("Halflight-Note") or "")
            check(status == 200 and ("the legend finds no room" in note) == told and (note == "") == (not told), f"{side} pixels: {status} {note!r}")


def complete_scenes(viewer, scene):
    """A scene without camera and transfer function comes back with both."""
    bare = {"halflight": 1, "volumes": [{"file": scene["volumes"][0]["file"]}]}
    status, _, body = request(viewer, "POST", "scene", json.dumps(bare))
    check(status == 200, "a scene is completed")
    complete = json.loads(body)
    check("position" in complete["camera"] and complete["volumes"][0]["transfer_function"]["opacity"], "completely")
    check(request(viewer, "POST", "scene", json.dumps(complete))[2] == body, "a complete scene stays the same")


def refusals(viewer, scene):
    """Foreign hosts and origins, wrong tokens, and what is malformed or too large."""
    good, text = viewer.token, json.dumps(small(scene))
    local = f"127.0.0.1:{viewer.port}"
    for host, expected in ((local, 200), (f"localhost:{viewer.port}", 200), ("localhost:1", 200), ("[::1]:80", 200),
                           ("example.com", 403), ("127.0.0.1.example.com", 403), ("localhost:80x", 403), ("", 403)):
        check(request(viewer, "GET", "start.json", Host=host)[0] == expected, f"Host {host!r}: {expected}")
    for origin, expected in ((f"http://{local}", 200), ("http://example.com", 403), ("null", 403), (f"https://{local}", 403),
                             (f"http://127.0.0.1:{viewer.port + 1}", 403)):
        answer = request(viewer, "POST", "scene", text, Host=local, Origin=origin)[0]
        check(answer == expected, f"Origin {origin}: {expected}, not {answer}")
    for site, expected in (("same-origin", 200), ("same-site", 403), ("cross-site", 403), ("none", 403)):
        answer = request(viewer, "POST", "scene", text, Host=local, Origin="null", Sec_Fetch_Site=site)[0]
        check(answer == expected, f"no origin told, {site}: {expected}, not {answer}")
    for path in ("/", "/start.json", f"/{good[:-1]}x/", f"/{good}", f"/{good}x/", f"/{good[:-1]}/", f"//{good}/", "/" + 200 * "a"):
        check(request(viewer, "GET", path)[0] == 403, f"the path {path} is refused")
    check(request(viewer, "GET", "../secret")[0] in (403, 404) and request(viewer, "GET", "nothing.js")[0] == 404, "unknown files")
    check(request(viewer, "PUT", "scene", text)[0] == 405 and request(viewer, "DELETE", "")[0] == 405, "other methods")
    check(request(viewer, "POST", "scene", b"", Content_Length=str(5 << 20))[0] == 413, "a body that is too large")
    for body in ("", "{", "[]", "\0", '{"halflight": 2}', text.replace('"fovy_deg": 30', '"fovy_deg": 900'), "{" * 100000):
        status, headers, line = request(viewer, "POST", "scene", body)
        check(status == 400 and headers["Content-Type"].startswith("text/plain") and len(line) > 5, f"malformed: {body[:30]!r}")
    for query in ("frame", "frame?page=a&number=1", "frame?page=A&number=1&format=png", "frame?page=a&number=-1&format=png",
                  "frame?page=a&number=1&format=gif", "frame?page=a&number=1&format=jpeg&quality=1000",
                  "frame?page=a&number=1&format=png&depth=9", "frame?page=a&number=1&format=png&metadata=2", f"frame?page={'a' * 33}&number=1&format=png"):
        check(request(viewer, "POST", query, text)[0] == 400, query)
    vast = small(scene, 16000)
    check(frame(viewer, vast)[0] == 400, "a picture of 256 million pixels")


def film_scenes(viewer, scene):
    """The scene of a film's frame: keys count as they say, and hostile numbers are refused."""
    text = json.dumps(small(scene))
    width = scene["lights"][0]["angular_diameter_deg"]
    key = "lights.0.angular_diameter_deg=0:10,20:30"

    def at(query):
        status, _, body = request(viewer, "POST", f"scene?{query}", text)
        return status, json.loads(body)["lights"][0]["angular_diameter_deg"] if status == 200 else body

    check(at("frames=21&key0=" + key) == (200, width), "no frame: the scene as it is")
    for frame, value in ((0, 10), (5, 15), (20, 30)):
        check(at(f"frame={frame}&frames=21&key0={key}") == (200, value), f"frame {frame}: {value}")
    check(at("frame=100000&frames=21&key0=" + key) == (200, 30), "after the last key its value stays")
    status, turned = request(viewer, "POST", "scene?frame=30&turntable=60", text)[::2]
    eye, before = (json.loads(t)["camera"] for t in (turned, text))
    middle = [sum(c["position"][axis] for c in (eye, before)) / 2 for axis in range(3)]
    up = before["up"]
    along = sum((m - t) * u for m, t, u in zip(middle, before["target"], up))
    away = [m - t - along * u for m, t, u in zip(middle, before["target"], up)]
    check(status == 200 and max(map(abs, away)) < 1e-6, "half a turn: the eye is opposite, about the axis that points up")
    own = scene["volumes"][0]["transfer_function"]
    paths = [f"volumes.0.transfer_function.color.{n}.{c}" for n in range(len(own["color"])) for c in (1, 2, 3)]
    paths += [f"volumes.0.transfer_function.opacity.{n}.1" for n in range(len(own["opacity"]))]
    paths += [f"{path}.{c}" for path in ("ambient", "image.background", "lights.0.color", "lights.1.color") for c in range(3)]
    paths += [f"{path}.{c}" for path in ("camera.position", "camera.target", "sky.zenith", "sky.horizon", "sky.ground") for c in range(3)]
    check(len(paths) > 32, f"enough numbers for the keys: {len(paths)}")
    keys = [f"&key{n}={path}=0:0.5" for n, path in enumerate(paths[:33])]
    check(at("frame=0&frames=9" + "".join(keys[:32])) == (200, width), "32 keys")
    for query in ("frame=-1", "frame=1e9", "frame=NaN", "frame=", "frame=100001", "frame=2147483648", "frame=18446744073709551616",
                  "frame=0x10", "frame=1.5", "frame=%00", "frame=1&frames=-1", "frame=1&frames=100001", "frame=1&turntable=nan",
                  "frame=1&turntable=4294967297", "frame=1&frames=1e3", "frame=-0", "frame=%201", "frame=" + 400 * "9",
                  "frame=0&frames=2&key0=", "frame=0&frames=2&key0=camera", "frame=0&frames=2&key0=nothing.5=0:1",
                  "frame=0&frames=2&key0=camera.azimuth=0:nan", "frame=0&frames=2&key0=camera.azimuth=-1:0",
                  "frame=0&frames=2&key0=camera.azimuth=99999999999999999999:0", "frame=0&frames=2&key0=lights.99.intensity=0:1",
                  "frame=0&frames=2&key0=lights.-1.intensity=0:1", "frame=0&frames=2&key0=camera.zoom=0:1e999",
                  "frame=0&frames=2&key0=image.width=0:1e9", "frame=0&frames=2&key0=" + 3000 * "a.", "frame=0&frames=9" + "".join(keys)):
        status, answer = at(query)
        check(status == 400 and len(answer) > 5, f"scene?{query[:60]}: refused, not {status} {answer}")
    check(at("frame=20&frames=21&key0=" + key) == (200, 30), "it still answers")


def viewer_without(limit, folder):
    """A viewer that may write files of so many bytes, into a folder."""
    limits, before = resource.getrlimit(resource.RLIMIT_FSIZE), os.environ.get("TMPDIR")
    resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limits[1]))
    os.environ["TMPDIR"] = folder
    try:
        return Viewer(PROGRAM, "torus.nrrd")
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, limits)
        if before is None:
            del os.environ["TMPDIR"]
        else:
            os.environ["TMPDIR"] = before


def nothing_can_be_stored(scene):
    """A full disk and a missing folder are the viewer's faults, and not the faults of who asks. Nothing is left."""
    text, content = json.dumps(small(scene, 64)), os.urandom(200000)
    temporary, formats = os.path.abspath("temporary"), ["zip", *(["gif", "mp4"] if shutil.which("ffmpeg") else [])]
    os.mkdir(temporary)
    for limit, folder in ((1000, temporary), (-1, os.path.abspath("none"))):
        with viewer_without(limit, folder) as viewer:
            for kind in formats:
                status, _, line = request(viewer, "POST", f"film?page=a&number={next(numbers)}&format={kind}&turntable=3", text)
                check(status == 500 and len(line) > 10, f"a film ({kind}) that cannot be stored: {status} {line}")
            status, _, line = request(viewer, "POST", "upload?name=a.nrrd", content)
            check(status == 500 and b"is the disk full?" in line, f"a file that cannot be stored: {status} {line}")
            for path, body, reason in (("upload?name=a.exe", content, b"no file of volumes"), ("film?page=a&number=1e9&format=zip&turntable=3", text, b"a film needs"),
                                       (f"film?page=a&number={next(numbers)}&format=zip&turntable=70000", text, b"no archive of 70000 pictures"),
                                       (f"film?page=a&number={next(numbers)}&format=zip&frames=2&key0=nothing=0:1", text, b"nothing")):
                if folder == temporary or not path.endswith("70000"):
                    status, _, line = request(viewer, "POST", path, body)
                    check(status == 400 and reason in line, f"{path[:60]} is a mistake: {status} {line}")
            check(frame(viewer, small(scene))[0] == 200, "it still answers")
    check(os.listdir(temporary) == [], "nothing is left")


def begins_as_told():
    """The options of render say what the page begins with: the scene is that of render, but for its absolute paths."""
    subprocess.run([PROGRAM, "make", "cloud", "--size", "24", "--quiet"], check=True)
    with open("labels_24x24x24_uint8.raw", "wb") as file:
        file.write(bytes(1 + (n % 24) // 8 for n in range(24**3)))
    labels = os.path.abspath("labels_24x24x24_uint8.raw")
    for options in (["torus.nrrd", "--look", "xray", "--view", "left", "--background", "white"],
                    ["torus.nrrd", "--sky", "0.5:0.2", "--light", "30,40", "--light-size", "12", "--exposure", "1", "--floor"],
                    ["torus.nrrd", "cloud.nrrd", "--colormap", "torus=viridis", "--clip", "x=0:0.5", "--cut-sphere", "0.5,0.5,1:0.3"],
                    ["torus.nrrd", "--iso", "0.5:gold", "--shadows", "hard", "--sheet-spacing", "2", "--ortho", "--zoom", "2"],
                    ["cloud.nrrd", "--mask", "labels_24x24x24_uint8.raw", "--show", "1=red,2:0.5"],
                    ["cloud.nrrd", "--labels", "labels_24x24x24_uint8.raw", "--show", "3"]):
        printed = subprocess.run([PROGRAM, "render", *options, "--print-scene", "--quiet"], capture_output=True, text=True, check=True)
        wanted = printed.stdout
        for name in ("torus.nrrd", "cloud.nrrd", "labels_24x24x24_uint8.raw"):
            wanted = wanted.replace(f'"{name}"', f'"{os.path.abspath(name)}"')
        with Viewer(PROGRAM, *options) as viewer:
            found = json.loads(request(viewer, "GET", "start.json")[2])["scene"]
            check(found == json.loads(wanted), f"{options}: another scene than render's")
            quick = small(found, 16)
            quick["render"].update(sheet_spacing=4)
            check(frame(viewer, quick)[0] == 200, f"{options}: a frame")
    check(labels in wanted, "the label map's path is absolute")
    for wrong in (["--size", "9x9"], ["--layers"], ["--threads", "-1"], ["--look", "none"]):
        run = subprocess.run([PROGRAM, "view", "torus.nrrd", "--no-browser", *wrong], capture_output=True, text=True)
        check(run.returncode == 2 and run.stdout == "", f"view {wrong} is refused")


def no_other_file(viewer, scene):
    """A page cannot open what was not open at the start."""
    for change in (lambda s: s["volumes"][0].update(file="/etc/passwd"),
                   lambda s: s["volumes"][0].update(transfer_function={"file": "/etc/passwd"}),
                   lambda s: s["lights"][0].update(texture={"file": "/etc/passwd", "screen": {"center": [0, 0, 9], "right": [1, 0, 0], "up": [0, 1, 0]}}),
                   lambda s: s["volumes"].append({"shapes": [{"type": "sphere", "radius": 5}], "voxel_size": 1})):
        other = small(scene)
        change(other)
        status, _, line = frame(viewer, other)
        check(status == 400 and b"root" not in line, "another file is refused")


def headers_protect(viewer):
    for path in ("", "main.js", "style.css", "icon.svg", "start.json"):
        status, headers, body = request(viewer, "GET", path)
        check(status == 200 and body, f"{path or 'the page'} is served")
        policy = headers["Content-Security-Policy"]
        check("default-src 'none'" in policy and "unsafe" not in policy and "frame-ancestors 'none'" in policy, "a strict policy")
        check(headers["X-Content-Type-Options"] == "nosniff" and headers["Cache-Control"] == "no-store", "headers")


def newer_frames_cancel(viewer, scene):
    """A slow frame is answered with 204 soon after a newer one of its page has come; other pages go on."""
    slow = small(scene, 1024)
    slow["render"].update(sheet_spacing=0.05)
    answers = {}

    def ask(name, page, number, what):
        answers[name] = frame(viewer, what, page=page, number=number)[0]

    threads = [threading.Thread(target=ask, args=("slow", "one", 100, slow))]
    threads[0].start()
    time.sleep(0.4)
    ask("other", "two", 1, small(scene))
    ask("newer", "one", 101, small(scene))
    threads[0].join()
    ask("late", "one", 99, small(scene))
    check(answers["other"] == 200 and answers["newer"] == 200, "newer frames and other pages are rendered")
    check(answers["slow"] == 204 and answers["late"] == 204, f"outdated frames are cancelled: {answers}")


def quick_frames():
    """While something moves, frames with wide sheets are of coarser volumes; with close sheets they are of the volume itself."""
    subprocess.run([PROGRAM, "make", "rings", "--size", "96", "--quiet", "-o", "fine.nrrd"], check=True)
    with Viewer(PROGRAM, "fine.nrrd") as viewer:
        scene = small(json.loads(request(viewer, "GET", "start.json")[2])["scene"], 160)
        scene["image"]["tone"], scene["render"]["sheet_spacing"] = "clip", 0.5

        def picture(spacing, moving):
            wanted = json.loads(json.dumps(scene))
            wanted["render"]["sheet_spacing"] = spacing
            status, _, body = frame(viewer, wanted, moving=moving)
            check(status == 200, f"a frame: {body[:200]}")
            with Image.open(io.BytesIO(body)) as image:
                return numpy.asarray(image.convert("RGB")).astype(float)

        exact, quick = picture(0.5, 0), picture(2, 1)
        check(not numpy.array_equal(quick, picture(2, 0)), "a quick frame is of another volume")
        check(abs(quick.mean() / exact.mean() - 1) < 0.05, f"as bright: {quick.mean()}, {exact.mean()}")
        check(numpy.array_equal(picture(0.5, 1), exact), "with close sheets a frame is of the volume itself")
        check(request(viewer, "POST", "frame?page=a&number=1&format=png&moving=2", "{}")[0] == 400, "moving is 0 or 1")


def differences(viewer, scene):
    """A frame of a difference from the page's newest whole scene is the picture of the scene that it makes; other bases and malformed ones are refused."""
    whole = small(scene, 64)
    wanted = json.loads(json.dumps(whole))
    wanted["camera"]["position"][0] += 1.25
    wanted["image"].pop("exposure", None)
    wanted["lights"] = wanted["lights"][:1]
    gone = {"exposure": {"gone": 1}} if "exposure" in whole["image"] else {}
    part = {"in": {"camera": {"in": {"position": {"in": {"0": {"to": wanted["camera"]["position"][0]}}}}},
                   "lights": {"to": wanted["lights"]}, "image": {"in": gone}}}

    def asked(part, base, number, page="base"):
        return request(viewer, "POST", f"frame?page={page}&number={number}&format=png&base={base}", part if isinstance(part, str) else json.dumps(part))

    check(asked(part, 1, 2)[0] == 409, "no scene was sent whole")
    exact = frame(viewer, wanted, page="exact", number=1)[2]
    check(frame(viewer, whole, page="base", number=5)[2] != exact, "another picture")
    status, _, picture = asked(part, 5, 6)
    check(status == 200 and picture == exact, f"the picture, byte for byte: {status} {picture[:99]}")
    check(asked(part, 5, 7)[2] == exact, "the base stays as it was")
    check(asked(part, 4, 8)[0] == 409 and asked(part, 5, 1, "other")[0] == 409, "the base of another frame, or of another page")
    for wrong in ("", "{", "[]", "{}", '{"in": 1}', '{"in": {"camera": {}}}', '{"in": {"none": {"gone": 1}}}', '{"in": {"lights": {"in": {"99": {"to": 1}}}}}',
                  '{"in": {"lights": {"in": {"": {"to": 1}}}}}', '{"in": {"lights": {"in": {"0": {"gone": 1}}}}}', '{"to": 1}', '{"to": {}, "to": {}}',
                  '{"in": {"volumes": {"in": {"0": {"in": {"file": {"to": "/etc/passwd"}}}}}}}', '{"in":' * 9000):
        status, _, line = asked(wrong, 5, next(later))
        check(status == 400 and 5 < len(line) < 600, f"{wrong[:60]!r}: {status} {line[:99]}")
    check(asked(part, 0, next(later))[0] == 400 and asked(part, -1, next(later))[0] == 400 and asked(part, "x", next(later))[0] == 400, "numbers that are none")
    check(asked(part, 5, next(later))[2] == exact, "it still answers")
    request(viewer, "POST", "leave?page=base", "")
    check(asked(part, 5, next(later))[0] == 409, "a page that was closed has no scene")


def many_pages(viewer, scene):
    """More pages than are kept: each gets its own camera's picture."""
    pictures = {}
    for number in range(10):
        turned = small(scene, 48)
        turned["camera"]["position"][0] += 10 * number
        pictures[number] = frame(viewer, turned, page=f"many-{number}")[2]
    check(len(set(pictures.values())) == 10, "ten cameras, ten pictures")
    check(frame(viewer, small(scene, 48), page="many-9")[2] == pictures[0], "the same camera on another page: the same picture")


def bad_clients(viewer, scene):
    """Clients that hang, vanish or lie leave the server as it was."""
    def raw(*pieces):
        client = socket.create_connection(("127.0.0.1", viewer.port))
        for piece in pieces:
            client.sendall(piece)
        return client

    head = f"POST /{viewer.token}/frame?page=bad&number=1&format=png HTTP/1.1\r\nHost: localhost\r\n".encode()
    body = json.dumps(small(scene, 512)).encode()
    hanging = [raw(), raw(b"GET"), raw(head), raw(head + b"Content-Length: 1000\r\n\r\n{"), raw(b"\0\xff\r\n\r\n" * 100)]
    for _ in range(5):
        raw(head + b"Content-Length: %d\r\n\r\n" % len(body) + body).close()
    raw(head + b"Content-Length: 10\r\n\r\n" + body).close()
    raw(head + b"Content-Length: -5\r\n\r\n" + body).close()
    raw(head + b"Transfer-Encoding: chunked\r\n\r\n" + b"ffffff\r\n" + b"x" * 5000).close()
    raw(b"GET / HTTP/1.1\r\n" + b"A: " + b"b" * 100000).close()
    check(frame(viewer, small(scene))[0] == 200, "it still answers")
    for client in hanging:
        client.close()


def ends_cleanly(viewer, scene):
    """Ctrl-C ends the program, also while a frame is rendered, which is not finished."""
    slow = small(scene, 2048)
    slow["render"].update(sheet_spacing=0.05)

    answers = []

    def ask():
        try:
            answers.append(frame(viewer, slow, page="last")[0])
        except (http.client.HTTPException, OSError):
            pass

    asking = threading.Thread(target=ask)
    asking.start()
    time.sleep(0.3)
    check(viewer.interrupt() == 0, "Ctrl-C is the way to end it: status 0")
    asking.join()
    check(200 not in answers, f"without the frame: {answers}")
    check(viewer.process.stderr.read() == "", "and in silence")


def busy_port():
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        port = str(taken.getsockname()[1])
        run = subprocess.run([PROGRAM, "view", "torus.nrrd", "--no-browser", "--port", port], capture_output=True, text=True)
        check(run.returncode == 1 and run.stdout == "" and f"port {port} is taken" in run.stderr, "a taken port is said")
    with Viewer(PROGRAM, "torus.nrrd", "--port", port) as viewer:
        check(viewer.port == int(port) and request(viewer, "GET", "")[0] == 200, "a free one is used")


with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    need_viewer(PROGRAM)
    subprocess.run([PROGRAM, "make", "torus", "--size", "32", "--quiet"], check=True)
    with Viewer(PROGRAM, "torus.nrrd") as viewer:
        check(len(viewer.token) == 32, "a token of 128 bits")
        start = json.loads(request(viewer, "GET", "start.json")[2])
        scene = start["scene"]
        check(os.path.isabs(scene["volumes"][0]["file"]) and len(start["volumes"][0]["histogram"]) == 256, "start.json")
        exact_pictures(viewer, small(scene))
        drawn_over(viewer, small(scene))
        overlays_without_room(viewer, scene)
        shared_with_picture(viewer, small(scene, 700))
        complete_scenes(viewer, scene)
        refusals(viewer, scene)
        film_scenes(viewer, scene)
        no_other_file(viewer, scene)
        headers_protect(viewer)
        newer_frames_cancel(viewer, scene)
        differences(viewer, scene)
        many_pages(viewer, scene)
        bad_clients(viewer, scene)
        ends_cleanly(viewer, scene)
    nothing_can_be_stored(scene)
    begins_as_told()
    quick_frames()
    busy_port()
print(f"{checks.count} checks passed")
