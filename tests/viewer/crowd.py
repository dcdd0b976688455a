#!/usr/bin/env python3
"""The viewer in a crowd: strangers who hold connections do not lock the page out, and what pages held is given back when
they close. Judged by what the server says that it holds (state.json); limits of time are for hangs alone.

usage: crowd.py PROGRAM
"""
import http.client
import json
import os
import shutil
import socket
import subprocess
import sys
import tempfile
import threading
import time

import checks
from browser import Browser
from checks import check
from viewer import Viewer, need_viewer

PROGRAM = os.path.abspath(sys.argv[1])
HANG = 120  # seconds, after which something hangs
MOST_WAITING = 128  # connections that wait for a request, as the server says
numbers = iter(range(1, 10**6))


def request(viewer, method, path, body=None):
    status, _, answer = viewer.request(method, path, body, timeout=HANG)
    return status, answer


def state(viewer):
    status, body = request(viewer, "GET", "state.json")
    check(status == 200, "the state is answered")
    return json.loads(body)


def wait_for(what, until):
    end = time.monotonic() + HANG
    while not until():
        check(time.monotonic() < end, what)
        time.sleep(0.05)


def dial(viewer, *pieces):
    client = socket.create_connection(("127.0.0.1", viewer.port), timeout=HANG)
    for piece in pieces:
        client.sendall(piece)
    return client


def has_ended(client):
    """Whether the other end has closed the connection."""
    client.setblocking(False)
    try:
        return client.recv(1000) == b""
    except BlockingIOError:
        return False
    except OSError:
        return True
    finally:
        client.settimeout(HANG)


def frame(viewer, scene, page, number=None, side=64, spacing=1, opened=0):
    small = json.loads(json.dumps(scene))
    small["image"].update(width=side, height=side)
    small["render"].update(sheet_spacing=spacing)
    return request(viewer, "POST", f"frame?page={page}&number={number or next(numbers)}&format=png&opened={opened}", json.dumps(small))


# ---- connections ----

def silent_strangers(viewer):
    """Many connections without a request: the page is answered after each ten of them."""
    clients = []
    for n in range(400):
        clients.append(dial(viewer) if n % 2 else dial(viewer, b"GET /"))
        if n % 10 == 9:
            check(request(viewer, "GET", "start.json")[0] == 200, f"the page among {n + 1} silent strangers")
    now = state(viewer)
    check(now["waiting"] <= MOST_WAITING and now["turned_away"] >= 400 - MOST_WAITING, f"those who waited for longest have gone: {now}")
    wait_for("their connections are closed", lambda: sum(map(has_ended, clients)) >= 400 - MOST_WAITING)
    for client in clients:
        client.close()
    wait_for("and forgotten", lambda: state(viewer)["connections"] <= 2)


def slow_strangers(viewer, scene):
    """Connections that send a byte now and then, and come back when they are closed."""
    head = f"POST /{'0' * 32}/frame HTTP/1.1\r\nHost: localhost\r\nX: ".encode()
    ended = threading.Event()

    def dribble():
        clients = [dial(viewer, head) for _ in range(32)]
        while not ended.wait(0.02):
            for n, client in enumerate(clients):
                try:
                    client.sendall(b"x")
                except OSError:
                    client.close()
                    clients[n] = dial(viewer, head)
        for client in clients:
            client.close()

    threads = [threading.Thread(target=dribble) for _ in range(6)]
    for thread in threads:
        thread.start()
    for n in range(30):
        check(frame(viewer, scene, "crowd")[0] == 200, f"frame {n} among slow strangers")
    ended.set()
    for thread in threads:
        thread.join()


def deadlines(viewer):
    """A head, and a body with the token, that never end, however busily."""
    head = f"POST /{viewer.token}/scene HTTP/1.1\r\nHost: localhost\r\nContent-Length: 4000000\r\n".encode()
    upload = f"POST /{viewer.token}/upload?name=a.nrrd HTTP/1.1\r\nHost: localhost\r\nContent-Length: 4000000\r\n".encode()
    clients = [dial(viewer, head), dial(viewer, head + b"\r\n"), dial(viewer, upload + b"\r\n"), dial(viewer, b"G")]
    end = time.monotonic() + HANG
    while clients:
        check(time.monotonic() < end, "requests that never end are ended")
        time.sleep(0.1)
        for client in clients:
            try:
                client.sendall(b"x")
            except OSError:
                pass
        clients = [client for client in clients if not has_ended(client)]
    def left():
        return [name for name in os.listdir(os.environ["TMPDIR"]) if "halflight-view" in name]
    while left():
        check(time.monotonic() < end, f"and leave nothing: {left()}")
        time.sleep(0.1)


def idle_browsers(viewer):
    """Connections that were of use once are kept, as far as there is room."""
    clients = []
    for _ in range(2 * MOST_WAITING):
        connection = http.client.HTTPConnection("127.0.0.1", viewer.port, timeout=HANG)
        connection.request("GET", f"/{viewer.token}/opening.json")
        connection.getresponse().read()
        clients.append(connection)
    wait_for("few idle connections are kept", lambda: state(viewer)["waiting"] <= MOST_WAITING)
    clients[-1].request("GET", f"/{viewer.token}/opening.json")
    check(clients[-1].getresponse().status == 200, "the last of them is")
    for connection in clients:
        connection.close()


# ---- pages that close ----

def closed_while_rendering(viewer, scene):
    """A frame that would take long ends when nobody waits for it any longer."""
    slow = json.loads(json.dumps(scene))
    slow["image"].update(width=2048, height=2048)
    slow["render"].update(sheet_spacing=0.01)
    body = json.dumps(slow).encode()
    client = dial(viewer, f"POST /{viewer.token}/frame?page=long&number=1&format=png HTTP/1.1\r\nHost: localhost\r\n"
                          f"Content-Length: {len(body)}\r\n\r\n".encode() + body)
    wait_for("the frame is begun", lambda: state(viewer)["rendering"] == 1)
    client.close()
    wait_for("and ends", lambda: state(viewer)["rendering"] == 0)
    request(viewer, "POST", "leave?page=long")


def left(viewer, scene):
    """A page that leaves gives back its renderers and what it has opened, and ends its frames; those of a lane end with its pictures."""
    before = state(viewer)
    check(before["pages"] == 0, f"no page yet: {before}")
    for page in ("one", "only"):
        check(frame(viewer, scene, page)[0] == 200, f"a frame of {page}")
    pages = state(viewer)
    for lane in ("one-probe", "one-small", "one-small"):
        check(frame(viewer, scene, lane)[0] == 200, f"a frame of {lane}")
    wait_for("the renderers of lanes have ended", lambda: state(viewer)["pages"] == 2 and state(viewer)["held"] == pages["held"])
    with open("torus.nrrd", "rb") as file:
        status, body = request(viewer, "POST", "upload?name=mine.nrrd", file.read())
    start = json.loads(body)
    check(status == 200 and frame(viewer, start["scene"], "one", opened=start["opened"])[0] == 200, "a file of its own")
    during = state(viewer)
    check(during["pages"] == 2 and during["opened"] == 2 and during["held"] > before["held"], f"what they hold: {during}")
    check(request(viewer, "POST", f"leave?page=one&opened={start['opened']}")[0] == 204, "it leaves")
    check(state(viewer)["pages"] == 1 and state(viewer)["opened"] == 1, "and with it its file, but no other page")
    check(request(viewer, "POST", "leave?page=only")[0] == 204, "the other, too")
    after = state(viewer)
    check(after["pages"] == 0 and after["held"] == before["held"], f"all is given back: {before} {after}")
    for query in ("leave", "leave?page=A", "leave?page=a&opened=x", "leave?page=a&opened=-1"):
        check(request(viewer, "POST", query)[0] == 400, query)
    check(request(viewer, "POST", "leave?page=none&opened=999")[0] == 204 and state(viewer)["opened"] == 1, "a page that never was")
    check(request(viewer, "POST", "leave?page=none&opened=0")[0] == 204 and state(viewer)["opened"] == 1, "the program's own input stays")
    slow = json.loads(json.dumps(scene))
    answers = []
    asking = threading.Thread(target=lambda: answers.append(frame(viewer, slow, "slow", side=2048, spacing=0.01)[0]))
    asking.start()
    wait_for("a slow frame is begun", lambda: state(viewer)["rendering"] == 1)
    request(viewer, "POST", "leave?page=slow")
    asking.join(HANG)
    check(answers == [204] and state(viewer)["pages"] == 0, f"its frames end: {answers}")


def memory_of_all(scene):
    """Pages that do not fit together each get their frames, within the limit."""
    def held_by(viewer, count):
        for n in range(count):
            check(frame(viewer, scene, f"page{n}", side=256)[0] == 200, f"page {n} of {count}")
        return state(viewer)["held"]

    with Viewer(PROGRAM, "large.nrrd") as viewer:
        one, two = held_by(viewer, 1), held_by(viewer, 2)
        peak = state(viewer)["peak"]
    check(two > one, f"each page holds memory: {one} {two}")
    limit = peak + (two - one) // 2  # a frame of one page fits beside no more than another one's renderer
    with Viewer(PROGRAM, "large.nrrd", "--max-memory", str(limit)) as viewer:
        for _ in range(2):
            held_by(viewer, 8)
        now = state(viewer)
        check(now["peak"] <= limit, f"all together stay within --max-memory: {now} {limit}")
        check(now["pages"] < 8, f"idle pages have given way: {now}")


def renderers_of_copies(viewer, scene):
    """Each coarser copy of a volume has a renderer of its own while something moves, so that going back to it prepares nothing again."""
    def moving(spacing):
        asked = json.loads(json.dumps(scene))
        asked["image"].update(width=64, height=64)
        asked["render"].update(sheet_spacing=spacing)
        connection = http.client.HTTPConnection("127.0.0.1", viewer.port, timeout=HANG)
        connection.request("POST", f"/{viewer.token}/frame?page=copies&number={next(numbers)}&format=jpeg&moving=1&opened=0", json.dumps(asked))
        answer = connection.getresponse()
        answer.read()
        connection.close()
        check(answer.status == 200, f"a frame with sheets {spacing} voxels apart")
        return state(viewer)["renderers"], {part.split(";dur=")[0]: float(part.split(";dur=")[1]) for part in answer.getheader("Server-Timing").split(", ")}

    counts, times = zip(*[moving(spacing) for spacing in (1, 2, 4, 2, 4, 1)])
    check(counts == (1, 2, 3, 3, 3, 3), f"one for the volume, and one for each of two copies: {counts}")
    check(all(0 < now["once"] < now["read"] + now["render"] for now in times[:3]), f"the first frame of each tells what it has prepared: {times}")
    check(all(now["once"] <= now["read"] for now in times[3:]), f"later ones have prepared nothing: {times}")
    request(viewer, "POST", "leave?page=copies")
    check(state(viewer)["renderers"] == 0, "all of them end with the page")


def copies_of_both_kinds(viewer, scene):
    """A map that is shown by its labels, and then by its values, has copies for both: while something moves, each has a renderer of its own."""
    by_values = json.loads(json.dumps(scene))
    del by_values["volumes"][0]["labels"]
    by_values["volumes"][0]["transfer_function"] = {"unit_distance": 1, "opacity": [[0, 0], [2, 0.5]], "color": [[0, 0.5, 0.5, 0.5]]}

    def moving(asked, spacing):
        asked = json.loads(json.dumps(asked))
        asked["image"].update(width=64, height=64)
        asked["render"].update(sheet_spacing=spacing)
        status, answer = request(viewer, "POST", f"frame?page=kinds&number={next(numbers)}&format=jpeg&moving=1&opened=0", json.dumps(asked))
        check(status == 200, f"a frame with sheets {spacing} voxels apart: {answer}")
        return state(viewer)["renderers"]

    counts = [moving(*asked) for asked in ((scene, 4), (scene, 2), (by_values, 4), (by_values, 2), (by_values, 4), (scene, 4))]
    check(counts == [1, 2, 3, 3, 3, 3], f"one for each of two copies of each kind, in three places: {counts}")
    request(viewer, "POST", "leave?page=kinds")


def awaited(viewer, scene):
    """While the light of the sky is made, progress.json says so, with the part that is done; then it tells of the picture."""
    scene = json.loads(json.dumps(scene))
    scene["image"].update(width=400, height=400)
    scene["sky"] = {"type": "uniform", "color": [1, 1, 1], "strength": 0.5}
    told, ended = [], threading.Event()

    def ask():
        while not ended.is_set():
            told.append(json.loads(request(viewer, "GET", "progress.json?page=sky")[1]))

    asking = threading.Thread(target=ask)
    asking.start()
    number = next(numbers)
    status, _ = request(viewer, "POST", f"frame?page=sky&number={number}&format=png&opened=0", json.dumps(scene))
    ended.set()
    asking.join()
    check({one["frame"] for one in told if one["part"] > 0} == {number}, f"each part names its frame, {number}: {told[:5]}")
    parts = [one["part"] for one in told if one["stage"] == "sky"]
    check(status == 200 and len(parts) > 2 and parts == sorted(parts) and any(0 < part < 1 for part in parts), f"the light of the sky is told: {parts}")
    last = max(n for n, one in enumerate(told) if one["stage"] == "sky")
    check(any(one["stage"] == "picture" and 0 < one["part"] < 1 for one in told[last:]), f"then the picture: {told[last:last + 5]}")
    told.clear()
    ended.clear()
    asking = threading.Thread(target=ask)
    asking.start()
    scene["camera"]["position"][0] += 1
    request(viewer, "POST", f"frame?page=sky&number={next(numbers)}&format=png&opened=0", json.dumps(scene))
    ended.set()
    asking.join()
    check(told and all(one["stage"] != "sky" for one in told), "the light is kept for another view")
    request(viewer, "POST", "leave?page=sky")


def write_map(path, side):
    """A label map: boxes of 1 and 2."""
    row = bytes(side // 8) + b"\1" * (side // 4) + b"\2" * (side // 2) + bytes(side // 8)
    inner = row * (side // 2)
    empty = bytes(side * side // 4)
    slices = [empty + inner + empty if side // 8 <= k < side - side // 8 else bytes(side * side) for k in range(side)]
    with open(path, "wb") as file:
        file.write(f"NRRD0004\ntype: uint8\ndimension: 3\nsizes: {side} {side} {side}\nencoding: raw\n\n".encode() + b"".join(slices))


def reloads(chromium):
    """A page that is reloaded, and closed, leaves nothing behind."""
    with Viewer(PROGRAM, "torus.nrrd") as viewer, Browser(chromium, (400, 300)) as browser:
        before = state(viewer)
        for _ in range(4):
            browser.open(viewer.url)
            browser.wait("globalThis.halflight?.frames.statistics.stage === 'final'")
            browser.wait("document.querySelector('[data-busy]') === null")
            wait_for("one page with one renderer, as so small a volume has no coarser copies",
                     lambda: (state(viewer)["pages"], state(viewer)["renderers"]) == (1, 1))
        browser.open("about:blank")
        wait_for("the page has gone", lambda: state(viewer)["pages"] == 0)
        check(state(viewer)["held"] == before["held"], "with all that it held")
        browser.open(viewer.url)
        browser.wait("globalThis.halflight?.frames.statistics.stage === 'final'")
        browser.call("Page.close")
        wait_for("a closed tab has gone", lambda: state(viewer)["pages"] == 0)


with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    os.mkdir("temporary")
    os.environ["TMPDIR"] = f"{folder}/temporary"
    need_viewer(PROGRAM)
    subprocess.run([PROGRAM, "make", "torus", "--size", "24", "--quiet"], check=True)
    subprocess.run([PROGRAM, "make", "torus", "--size", "96", "--quiet", "-o", "large.nrrd"], check=True)
    with Viewer(PROGRAM, "torus.nrrd") as viewer:
        scene = json.loads(request(viewer, "GET", "start.json")[1])["scene"]
        silent_strangers(viewer)
        left(viewer, scene)
        slow_strangers(viewer, scene)
        deadlines(viewer)
        idle_browsers(viewer)
        closed_while_rendering(viewer, scene)
    subprocess.run([PROGRAM, "make", "fire-ball", "--size", "160", "--quiet", "-o", "larger.nrrd"], check=True)
    with Viewer(PROGRAM, "larger.nrrd") as viewer:
        renderers_of_copies(viewer, json.loads(request(viewer, "GET", "start.json")[1])["scene"])
        awaited(viewer, json.loads(request(viewer, "GET", "start.json")[1])["scene"])
    write_map("map.nrrd", 128)
    with Viewer(PROGRAM, "map.nrrd", "--show", "all") as viewer:
        copies_of_both_kinds(viewer, json.loads(request(viewer, "GET", "start.json")[1])["scene"])
    with Viewer(PROGRAM, "large.nrrd") as viewer:
        large = json.loads(request(viewer, "GET", "start.json")[1])["scene"]
    memory_of_all(large)
    chromium = shutil.which("chromium")
    if chromium is not None:
        reloads(chromium)
    print(f"{checks.count} checks passed")
