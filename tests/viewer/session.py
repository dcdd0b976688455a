#!/usr/bin/env python3
"""Nothing is lost, in a headless Chromium or Firefox: the whole state after a reload, after another start of the viewer, after a lost network and out of
a file.

usage: session.py PROGRAM chromium|firefox-esr [FOLDER]
FOLDER: where screenshots are kept; without it they are not made.
"""
import json
import os
import stat
import subprocess
import sys
import tempfile
import time

import checks
from checks import check
from firefox import browser_named
from hands import KEYS, PROGRAM, STATE, center, equals_render, open_section, press, press_named, reload, rest, scene_of, set_control, undo
from viewer import Viewer, need_viewer

SHOTS = os.path.abspath(sys.argv[3]) if len(sys.argv) > 3 else None
BANNER = "document.querySelector('.banner')"


def shot(browser, name):
    if SHOTS is not None:
        browser.screenshot(f"{SHOTS}/{name}.png")


def saved_json(path):
    """The file that the page saves, once it is there."""
    end = time.monotonic() + 60
    while not os.path.exists(path) or os.path.getsize(path) == 0:  # Firefox keeps its name first
        check(time.monotonic() < end, f"{path} is saved")
        time.sleep(0.05)
    with open(path, encoding="utf-8") as file:
        return json.load(file)


def work(browser):
    """Something of everything; returns the state."""
    set_control(browser, "Colours", "magma", "change")
    browser.run("halflight.slices.moveTo([3, 4, 5])")
    browser.run("halflight.store.setPage({ layout: 'four', windows: { 0: [0.25, 0.75] } })")
    browser.run("halflight.store.setMarks('ruler', [{ kind: 'ruler', points: [[0, 0, 0], [3, 4, 0]], text: 'five' }])")
    browser.run("[...document.querySelectorAll('details')].find((d) => d.querySelector('summary').textContent === 'Session').open = true")
    rest(browser)
    press(browser, "bookmark")
    x, y = center(browser, "#view")
    browser.drag([x - 60, y + 60], [x - 30, y + 80])
    rest(browser)
    return browser.run(STATE)


def after_reload(browser):
    before = work(browser)
    reload(browser)
    check(browser.run(STATE) == before, "a reload: all is as it was")
    check(browser.run("document.querySelectorAll('.slice:not([hidden])').length") == 3 and browser.run("document.querySelectorAll('.bookmarks li').length") == 1, "and is shown")
    colors = scene_of(browser)["volumes"][0]["transfer_function"]["color"]
    undo(browser)
    check(browser.run("document.querySelectorAll('.bookmarks li').length") == 0 and browser.run("halflight.store.marks.length") == 1, "undo goes on: the bookmark")
    undo(browser)
    check(browser.run("halflight.store.marks.length") == 0, "the ruler")
    undo(browser)
    check(browser.run("halflight.slices.layout") == "picture" and browser.run("halflight.store.page.windows === undefined"), "layout and window")
    undo(browser)
    check(scene_of(browser)["volumes"][0]["transfer_function"]["color"] != colors, "and the colours")
    for _ in range(4):
        press_named(browser, "Redo")
    rest(browser)
    camera = scene_of(browser)["camera"]
    browser.run("document.querySelector('.bookmarks .view').click()")
    check(scene_of(browser)["camera"] != camera, "the bookmark leads back")
    browser.run("document.getElementById('view').focus()")
    browser.key("c")
    check(scene_of(browser)["camera"] == camera, "and is undone as any view")
    browser.run("halflight.store.setPage({ layout: 'picture' })")
    equals_render(browser, "reloaded")


def after_restart(browser, viewer, options):
    """Another viewer on the same port goes on with the page, and with the file that it had opened."""
    browser.run("fetch('open?file=second.nrrd', { method: 'POST' })")  # numbers of the first viewer are not those of the second
    open_section(browser, "Open")
    browser.wait("[...document.querySelectorAll('.files .file')].some((b) => b.textContent === 'second.nrrd')")
    browser.run("[...document.querySelectorAll('.files .file')].find((b) => b.textContent === 'second.nrrd').click()")
    browser.wait("document.title.startsWith('second')")
    rest(browser)
    set_control(browser, "Colours", "viridis", "change")
    rest(browser)
    viewer.interrupt()
    browser.run("halflight.store.changeRender('shadows', 'hard')")
    browser.wait(f"{BANNER} && !{BANNER}.hidden")
    check(browser.run("document.getElementById('stage').textContent") == "failed", "the picture is not the scene's")
    check("Retry" in browser.run(f"{BANNER}.textContent"), "the banner offers to try again")
    check(browser.run("getComputedStyle(document.getElementById('picture')).objectFit") == "cover", "the picture is not stretched into the room that the banner leaves")
    shot(browser, "banner")
    before = browser.run(STATE)
    os.mkdir("lost")
    browser.save_in("lost")
    browser.click(center(browser, ".banner button:last-child"))
    saved = saved_json("lost/second-session.json")
    saved["page"].pop("sections", None)
    check([saved["scene"], saved["marks"], saved["page"]] == json.loads(before), "the session is saved without a viewer")
    low, top = browser.run(f"[{BANNER}.getBoundingClientRect().bottom, document.getElementById('message').getBoundingClientRect().top]")
    check(browser.run("document.getElementById('message').textContent") == "saved second-session.json" and top >= low, f"the page says so below the banner: {top}, {low}")
    with Viewer(PROGRAM, *options) as again:
        check(again.url == viewer.url, f"the same URL: {again.url}")
        browser.click(center(browser, ".banner button"))
        browser.wait(f"{BANNER}.hidden")
        rest(browser)
        check(browser.run(STATE) == before, "all is as it was")
        equals_render(browser, "restarted")
        reload(browser)
        check(browser.run("document.title").startswith("second") and browser.run(STATE) == before, "the opened file, after a reload too")
        problems = [line for line in browser.problems if "ERR_CONNECTION_REFUSED" not in line and "410" not in line]
        check(problems == [], f"the console has errors: {problems}")
        browser.problems.clear()
        files(browser)
        network(browser)


def network(browser):
    """Without a network the banner comes, and goes when the network is back, without a hand."""
    browser.offline(True)
    set_control(browser, "Colours", "viridis", "change")
    browser.wait(f"!{BANNER}.hidden")
    browser.offline(False)
    browser.wait(f"{BANNER}.hidden")
    rest(browser)


def drop(browser, name, text):
    """A file falls on the page."""
    browser.run(f"""(() => {{ const transfer = new DataTransfer(); transfer.items.add(new File([{json.dumps(text)}], {json.dumps(name)}));
      document.querySelector('.viewer').dispatchEvent(new DragEvent('drop', {{ dataTransfer: transfer, bubbles: true, cancelable: true }})); }})()""")


def files(browser):
    """A session as a file brings everything back; a scene of what is open the scene; others are refused in words."""
    os.mkdir("saved")
    browser.save_in("saved")
    work(browser)
    state = json.loads(browser.run(STATE))
    unfolded = "[...document.querySelectorAll('aside details[open] > summary')].map((summary) => summary.textContent).join()"
    browser.wait("halflight.store.page.sections?.Session")
    sections = browser.run(unfolded)
    browser.run("[...document.querySelectorAll('aside button')].find((b) => b.textContent === 'save session').click()")
    session = json.dumps(saved_json("saved/second-session.json"))
    press(browser, "start afresh")
    rest(browser)
    check(json.loads(browser.run(STATE))[1:] == [[], {}], "as it began")
    undo(browser)
    check(json.loads(browser.run(STATE))[1] == state[1], "undo brings back what was done")
    press(browser, "start afresh")
    rest(browser)
    with open("in-list.json", "w", encoding="utf-8") as file:
        file.write(session)
    open_section(browser, "Open")
    browser.reload()
    listed = "[...document.querySelectorAll('.files .file')].find((b) => b.textContent === 'in-list.json')"
    browser.wait(f"globalThis.halflight?.start && {listed} !== undefined")
    browser.run(f"{listed}.click()")
    browser.wait("halflight.store.marks.length === 1", timeout=60)
    rest(browser)
    check(json.loads(browser.run(STATE))[1] == state[1], "a session in the list of files is opened")
    press(browser, "start afresh")
    rest(browser)
    open_section(browser, "Sky")
    browser.wait("halflight.store.page.sections?.Sky")
    drop(browser, "a-session.json", session)
    browser.wait("halflight.store.marks.length === 1")
    rest(browser)
    check(browser.run(unfolded) == sections, f"its sections are unfolded: {browser.run(unfolded)}, not {sections}")
    check(json.loads(browser.run(STATE)) == state, "the session brings all back")
    undo(browser)
    check(json.loads(browser.run(STATE))[1] == [], "as one step")
    changed = json.loads(session)["scene"]
    changed["image"]["background"] = [0.1, 0.2, 0.3]
    drop(browser, "scene.json", json.dumps(changed))
    browser.wait("halflight.store.scene.image.background[2] === 0.3")
    rest(browser)
    for name, text, words in (("a.json", "{", "no JSON"), ("b.json", "[1]", "neither a session nor a scene"), ("c.json", '{"halflight_session": 1}', "neither"),
                              ("d.json", json.dumps({**json.loads(session), "source": "../none.nrrd", "scene": {**changed, "volumes": []}}), "no such file"),
                              ("e.json", json.dumps({**changed, "camera": {"type": "fish"}}), "camera")):
        before = browser.run(STATE)
        drop(browser, name, text)
        browser.wait(f"document.getElementById('message').textContent.includes({json.dumps(words)})")
        check(browser.run(STATE) == before, f"{name} changes nothing")
    damaged = [None, {"cut": {"type": "constructor"}, "at": 0}, {"cut": {"type": "plane", "point": [1, 2]}, "at": 0}, {"cut": {"type": "sphere", "center": [1, 2, 3], "radius": 1}, "at": "0"}]
    hostile = {**json.loads(session), "marks": [{"kind": "<img>", "points": [[0, 0, 0]]}, {"kind": "text", "points": [[0, None, 0]]}, {"kind": "text", "points": [[1, 2, 3]], "text": "<b>"}],
               "page": {"cut": -1, "surface": "0", "aside": {"cut 0": damaged, "sceneCut 0": 7, "all cuts": 3}, "film": {"frames": 1e9, "fps": "2", "frame": -1, "format": "exe", "open": True, "turns": True, "from": {"camera": {}, "image": None},
                                 "tracks": [{"path": "camera", "points": [[0, {"position": 1}]]}, {"path": 7}, None, {"path": "lights.0.intensity", "points": [[2, 1], [9, 3]]}]}}}
    drop(browser, "f.json", json.dumps(hostile))
    browser.wait("halflight.store.marks.length === 1 && halflight.store.marks[0].text === '<b>'")
    rest(browser)
    check(browser.run(KEYS) == [["lights.0.intensity", 2], ["lights.0.intensity", 9]] and browser.run("document.querySelector('[aria-label=\"Frames of the film\"]').value") == "120",
          f"of its film what is right: {browser.run(KEYS)}")
    browser.problems.clear()  # refused requests


def private_tokens(folder):
    """The token that a port keeps is the user's alone; where it is not, it is replaced, and without a private folder none is kept."""
    names = [entry for entry in os.listdir(folder) if entry.startswith("halflight-view-")]
    check(names == [f"halflight-view-{port}"], f"one token is kept: {names}")
    name = names[0]
    check(stat.S_IMODE(os.stat(f"{folder}/{name}").st_mode) == 0o600, "the token's file is the user's alone")
    with Viewer(PROGRAM, "first.nrrd") as free:
        check(f"halflight-view-{free.port}" not in os.listdir(folder), "a free port keeps none")
    with Viewer(PROGRAM, "first.nrrd", "--port", port) as again:
        token = again.token
    with Viewer(PROGRAM, "first.nrrd", "--port", port) as again:
        check(again.token == token, "the port's token")
    for spoil in (lambda path: os.chmod(path, 0o644), lambda path: os.truncate(path, 31), lambda path: [os.unlink(path), os.symlink("/etc/hostname", path)]):
        spoil(f"{folder}/{name}")
        with Viewer(PROGRAM, "first.nrrd", "--port", port) as again:
            check(again.token != token, "a token that others could know is not used")
            token = again.token
        check(stat.S_IMODE(os.lstat(f"{folder}/{name}").st_mode) == 0o600, "the new one is the user's alone")
    with Viewer(PROGRAM, "first.nrrd", "--port", port) as again:
        os.unlink(f"{folder}/{name}")
        refused = subprocess.run([PROGRAM, "view", "--no-browser", "first.nrrd", "--port", port], capture_output=True, text=True, check=False)
        check(refused.returncode != 0 and "is taken" in refused.stderr, f"a second viewer does not get the port: {refused.stderr}")
        check(not os.path.exists(f"{folder}/{name}"), "and does not touch the first one's token")
    os.mkdir(f"{folder}/{name}")
    with Viewer(PROGRAM, "first.nrrd", "--port", port) as again:
        check(len(again.token) == 32 and again.token != token, "a folder of the token's name stays, and the token is a new one")
        token = again.token
    os.rmdir(f"{folder}/{name}")
    os.mkfifo(f"{folder}/{name}", 0o600)
    with Viewer(PROGRAM, "first.nrrd", "--port", port) as again:
        check(again.token != token and stat.S_ISREG(os.lstat(f"{folder}/{name}").st_mode), "a pipe of its name is replaced, and not waited for")
        token = again.token
    os.chmod(folder, 0o755)
    with Viewer(PROGRAM, "first.nrrd", "--port", port) as again:
        check(again.token != token, "none is read or kept in a folder that others can enter")


if __name__ == "__main__":
    kind = browser_named(sys.argv[2])
    with tempfile.TemporaryDirectory() as place:
        os.chdir(place)
        need_viewer(PROGRAM)
        os.mkdir("runtime", 0o700)
        os.environ["XDG_RUNTIME_DIR"] = os.path.abspath("runtime")
        for made in ("first", "second"):
            subprocess.run([PROGRAM, "make", "rings" if made == "first" else "torus", "--size", "32", "--quiet", "-o", f"{made}.nrrd"], check=True)
        with Viewer(PROGRAM, "first.nrrd") as chosen:
            port = str(chosen.port)
        arguments = ["first.nrrd", "--sheet-spacing", "2", "--shadows", "hard", "--port", port]
        with Viewer(PROGRAM, *arguments) as first, kind(size=(900, 620)) as page:
            page.open(first.url)
            rest(page)
            after_reload(page)
            check(page.problems == [], f"the console has errors: {page.problems}")
            after_restart(page, first, arguments)
        private_tokens("runtime")
    print(f"{checks.count} checks passed")
