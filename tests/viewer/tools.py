#!/usr/bin/env python3
"""The page's tools in a headless Chromium or Firefox: exports, probe, clip handles, labels, and hundreds of random hands.

usage: tools.py PROGRAM chromium|firefox-esr [FOLDER]
FOLDER: where axe.min.js of axe-core may lie, which judges the page for screen readers; that part is left out without it.
"""
import glob
import json
import os
import random
import subprocess
import sys
import tempfile
import time
import urllib.request

import numpy

import checks
from checks import check
from firefox import browser_named
from hands import PROGRAM, STAGE, center, changes, copied_command, equals_render, final_picture, resize, rest, scene_of
from viewer import Viewer, need_viewer


def exported_texts(browser):
    """The command and the Python program make the final picture, byte for byte."""
    program, shown = copied_command(browser, "it's; rm *.json"), final_picture(browser)
    folder = tempfile.mkdtemp(dir=".")
    compile(program, "program", "exec")
    packages = glob.glob(f"{os.path.dirname(PROGRAM)}/../../python/stage/**/halflight", recursive=True)
    packages = [path for path in packages if os.path.exists(f"{path}/__init__.py")]
    if packages:  # the Python tests install it there
        environment = dict(os.environ, PYTHONPATH=os.path.dirname(packages[0]))
        subprocess.run([sys.executable, "-c", program], cwd=folder, check=True, env=environment)
        with open(f"{folder}/a_b.png", "rb") as file:
            check(file.read() == shown, "the copied program makes the picture")


def light_by_render(x, y):
    """The part of the light that arrives at what is seen there, by two pictures of the program."""
    seen = []
    for shadows in ("soft", "off"):
        subprocess.run([PROGRAM, "render", "ball.nrrd", "--tf", "white.json", "--shadows", shadows, "--size", "380x352", "--ambient", "0",
                        "-o", "light.npy", "--quiet"], check=True)
        picture = numpy.load("light.npy")
        seen.append(picture[int(352 * y) - 2:int(352 * y) + 3, int(380 * x) - 2:int(380 * x) + 3, 0].mean())
    return seen[0] / seen[1]


def probe(browser):
    """A ball of one value: its value and opacity are known in the middle, and nothing is beside it."""
    browser.run("document.getElementById('probe').click()")
    rest(browser)
    browser.wait("halflight.probe.at(0.5, 0.5) !== null")
    found = browser.run("halflight.probe.at(0.5, 0.5)")
    check(60 <= found["value"] <= 200.5 and found["opacity"] > 0.98, f"the ball's own value: {found}")
    check(browser.run("halflight.probe.at(0.02, 0.02).value") is None, "nothing is seen in the corner")
    for place in ((0.4, 0.35), (0.5, 0.5), (0.6, 0.7)):
        light, expected = browser.run(f"halflight.probe.at({place[0]}, {place[1]}).light"), light_by_render(*place)
        check(abs(light - expected) < 0.06, f"the light at {place} is {light}, by two pictures {expected}")
    x, y = center(browser, "#view")
    browser.mouse("mouseMoved", x, y, button="none")
    browser.wait("/value 1[0-9.]+.*opacity (0.99|1.00)/.test(document.querySelector('.probe').textContent)")
    browser.run("document.getElementById('probe').click()")
    check(browser.run("document.querySelector('.probe').hidden"), "the probe is switched off")


def clip_handles(browser):
    browser.run("[...document.querySelectorAll('summary')].find((s) => s.textContent === 'Volume').click()")
    browser.wait("document.querySelector('.clip-handle').getBoundingClientRect().width > 5")
    x, y = center(browser, ".clip-handle.axis-0:nth-child(2)")
    changes(browser, "a clip handle", lambda: browser.drag([x, y], [x - 150, y - 30]), "volumes")
    clip = scene_of(browser)["volumes"][0]["clip"]
    check(clip["min"][0] < clip["max"][0] < 31.5 - 2, f"the handle cuts: {clip}")
    browser.run("document.querySelector('.clip-handle.axis-1').focus()")
    changes(browser, "arrow keys on a clip handle", lambda: [browser.key("ArrowUp") for _ in range(20)], "volumes")
    # A drag and a row of keys are a step each, or a few where the machine is so slow that keys come far apart.
    browser.run("for (let step = 0; step < 21 && halflight.store.scene.volumes[0].clip; step++) halflight.store.undo(); 0")
    check("clip" not in scene_of(browser)["volumes"][0], "undone")


def cancelled_frames(browser):
    """A refinement that a newer change makes useless is cancelled, and counted."""
    before = browser.run("halflight.frames.statistics.cancelled")
    for _ in range(3):
        browser.run("halflight.store.changeRender('sheet_spacing', 0.01)")
        browser.wait(f"{STAGE} === 'refining'")
        browser.run("halflight.store.changeRender('sheet_spacing', 1)")
        rest(browser)
    check(browser.run("halflight.frames.statistics.cancelled") >= before + 3, "cancelled refinements are counted")


def axe(browser, path):
    """No violations, in both themes, with all panels open."""
    with open(path) as file:
        script = file.read()
    browser.run("document.querySelectorAll('details').forEach((d) => { d.open = true; })")
    for _ in ("dark", "light"):
        browser.run(script + "; 0")
        found = browser.run("axe.run().then((r) => r.violations.map((v) => [v.id, v.nodes.map((n) => n.html)]))", timeout=120)
        check(found == [], f"axe-core: {found}")
        browser.run("document.getElementById('theme').click()")


def keyboard_only(browser):
    """Tab reaches every control, and comes back out of the transfer function's drawing."""
    browser.run("document.querySelectorAll('details').forEach((d) => { d.open = true; }); document.activeElement.blur()")
    reached = set()
    for _ in range(320):
        browser.key("Tab")
        reached.add(browser.run("""(() => { const e = document.activeElement; e.dataset.reached = 1;
          return e.id || e.getAttribute('aria-label') || e.getAttribute('class') || e.tagName; })()"""))
    # Of a group of choices Tab reaches the chosen one, arrow keys the others; the lights' handles are one each.
    missed = browser.run("""[...document.querySelectorAll('button, select, input, canvas[tabindex], summary, #view, .light, .clip-handle')].filter((e) =>
      !e.dataset.reached && !e.disabled && e.type !== 'radio' && e.getBoundingClientRect().width > 0 && !e.closest('dialog')).map((e) => e.outerHTML.slice(0, 90))""")
    check(missed == [], f"Tab does not reach {missed}")
    check("function" in reached or any("Opacity over values" in one for one in reached), "the drawing is reached")


def random_hands(browser, count=500):
    """Any order of drags, wheels, keys and controls: no error in the console, no growth, and the picture still exact."""
    chance = random.Random(26)
    x, y = center(browser, "#view")
    keys = [*"+-[]xyzXYZrlsuUiptb", "ArrowLeft", "ArrowRight", "ArrowUp", "ArrowDown"]
    controls = "[...document.querySelectorAll('aside input, aside select, aside button')]"

    def act():
        kind = chance.randrange(6)
        at = [x + chance.randint(-150, 150), y + chance.randint(-150, 150)]
        if kind == 0:
            to = [at[0] + chance.randint(-80, 80), at[1] + chance.randint(-80, 80)]
            browser.drag(at, to, 3, chance.choice(["left", "middle", "right"]), chance.choice([0, 2, 8]))
        elif kind == 1:
            browser.wheel(*at, chance.randint(-300, 300))
        elif kind == 2:
            browser.run("document.getElementById('view').focus()")
            browser.key(chance.choice(keys))
        elif kind == 3:
            # The drawing of a function of one number or of two; labels have none.
            box = browser.run("""(() => { const drawing = document.querySelector('.function-area canvas');
              drawing?.scrollIntoView({ block: 'center' });
              const { x = 0, y = 0, width = 0, height = 0 } = drawing?.getBoundingClientRect() ?? {}; return [x, y, width, height]; })()""")
            at = [box[0] + chance.random() * box[2], box[1] + chance.random() * box[3]]
            browser.drag(at, [at[0] + chance.randint(-60, 60), at[1] + chance.randint(-40, 40)], 3)
        else:
            browser.run(f"""(() => {{ const all = {controls}.filter((e) => !/picture|scene|command|Python|film|pen|play|nrrd|json/.test(e.textContent) && !e.closest('[hidden]'));
              const e = all[{chance.randrange(10**6)} % all.length];
              if (e.tagName === 'BUTTON' || e.type === 'checkbox' || e.type === 'radio') e.click();
              else if (e.tagName === 'SELECT') {{ e.selectedIndex = {chance.randrange(10**6)} % e.length; e.dispatchEvent(new Event('change')); }}
              else {{ if (e.type === 'color') e.value = '#{chance.randrange(1 << 24):06x}';
                else e.value = e.type === 'range' ? +e.min + {chance.random()} * (e.max - e.min) : {chance.uniform(-50, 300)};
                e.dispatchEvent(new Event('input')); e.dispatchEvent(new Event('change')); }} }})()""")

    browser.run("""(() => {
      const own = window.fetch; window.refusals = [];
      window.fetch = async (...all) => { const answer = await own(...all);
        if (answer.status >= 400) answer.clone().text().then((text) => refusals.push(text));
        return answer; };
    })()""")

    def sizes():
        heap = browser.used_memory() or 0
        nodes = browser.run("document.querySelectorAll('*').length")
        return heap, nodes

    # What is used for the first time (a pick's renderer, labels, slices) is kept: only what grows after that is lost.
    for _ in range(count // 2):
        act()
    before = sizes()
    for _ in range(count - count // 2):
        act()
    after = sizes()
    browser.run("document.getElementById('help').close?.()")
    check(after[0] < before[0] + (8 << 20) and after[1] < before[1] + 400, f"the page grows: {before} to {after}")
    check(browser.problems == [], f"the console has errors: {browser.run('[...new Set(refusals)]')} {browser.problems[:2]}")


def server_state(viewer):
    with urllib.request.urlopen(f"http://127.0.0.1:{viewer.port}/{viewer.token}/state.json", timeout=600) as answer:
        return json.load(answer)


def leaves_nothing(browser, viewer, held):
    """The page that closes gives back all that its renderers held, hundreds of megabytes at their peak. A scene that it was opening at this moment
    may stay until another one needs its place. held: the server's bytes before the page came."""
    browser.open("about:blank")
    end = time.monotonic() + 100  # of one that hangs; a page of which the server hears nothing stays for 300 seconds
    while (after := server_state(viewer))["pages"] > 0:
        check(time.monotonic() < end, f"the page's state stays: {after}")
        time.sleep(0.05)
    check(after["held"] <= held + (8 << 20), f"the server grows: {held} to {after}")


def write_ball(path):
    """32^3 bytes: 200 in a ball of radius 10, 0 elsewhere."""
    voxels = bytes(200 if (x - 15.5)**2 + (y - 15.5)**2 + (z - 15.5)**2 < 100 else 0
                   for z in range(32) for y in range(32) for x in range(32))
    with open(path, "wb") as file:
        file.write(b"NRRD0004\ntype: uint8\ndimension: 3\nsizes: 32 32 32\nencoding: raw\n\n" + voxels)


chosen = browser_named(sys.argv[2])
AXE = glob.glob(f"{os.path.abspath(sys.argv[3])}/**/axe.min.js", recursive=True) if len(sys.argv) > 3 else []
with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    need_viewer(PROGRAM)
    write_ball("ball.nrrd")
    with open("white.json", "w") as file:
        file.write('{"unit_distance": 1, "opacity": [[60, 0], [150, 0.6]], "color": [[0, 1, 1, 1]]}')
    scene = subprocess.run([PROGRAM, "render", "ball.nrrd", "--tf", "white.json", "--print-scene"],
                           check=True, capture_output=True).stdout
    with open("ball.json", "wb") as file:
        file.write(scene)
    with Viewer(PROGRAM, "ball.json") as viewer, chosen(size=(720, 420)) as browser:
        held = server_state(viewer)["held"]
        browser.open(viewer.url)
        rest(browser)
        probe(browser)
        exported_texts(browser)
        clip_handles(browser)
        cancelled_frames(browser)
        keyboard_only(browser)
        if AXE:
            axe(browser, AXE[0])
        random_hands(browser, 500 if browser.used_memory() is not None else 200)  # growth is measured in the browser that tells its memory
        resize(browser, 760, 440)
        equals_render(browser, "last")
        frames = browser.run("halflight.frames.statistics")
        leaves_nothing(browser, viewer, held)
        print(f"{checks.count} checks passed{'' if AXE else ', without axe-core'}; frames: {frames}")
