#!/usr/bin/env python3
"""The viewer's page in a headless Chromium: hands move the picture, and at rest it is what `halflight render` makes.

usage: page.py PROGRAM
"""
import base64
import hashlib
import io
import json
import os
import shutil
import subprocess
import sys
import tempfile

from PIL import Image

from browser import Browser
from viewer import Viewer

PROGRAM = os.path.abspath(sys.argv[1])
STAGE = "globalThis.halflight?.frames.statistics.stage"
checks = 0


def check(condition, what):
    global checks
    checks += 1
    if not condition:
        sys.exit(f"FAILED: {what}")


def rest(browser):
    """Waits for the final picture; returns the SHA-256 of the pixels on the screen, R, G, B, A."""
    browser.wait(f"{STAGE} === 'final'")
    return browser.run("""(() => {
      const canvas = document.getElementById('picture');
      const { data } = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height);
      return crypto.subtle.digest('SHA-256', data).then((hash) =>
        [...new Uint8Array(hash)].map((byte) => byte.toString(16).padStart(2, '0')).join(''));
    })()""")


def scene_of(browser):
    return json.loads(browser.run("JSON.stringify(halflight.store.scene)"))


def equals_render(browser, name):
    """The picture at rest is, byte for byte and pixel for pixel, that of `halflight render` on the exported scene."""
    screen = rest(browser)
    text = browser.run("import('./export.js').then((m) => m.sceneText(halflight.store.scene))")
    os.makedirs(name)
    with open(f"{name}/scene.json", "w") as file:
        file.write(text)
    subprocess.run([PROGRAM, "render", f"{name}/scene.json", "-o", f"{name}/picture.png", "--quiet"], check=True)
    with open(f"{name}/picture.png", "rb") as file:
        rendered = file.read()
    shown = base64.b64decode(browser.run("""halflight.frames.finalPicture.arrayBuffer().then((b) =>
      btoa(new Uint8Array(b).reduce((text, byte) => text + String.fromCharCode(byte), '')))"""))
    check(shown == rendered, f"{name}: the final picture's bytes are not those of halflight render")
    image = Image.open(io.BytesIO(rendered)).convert("RGBA")
    check(hashlib.sha256(image.tobytes()).hexdigest() == screen, f"{name}: the screen does not show the final picture's pixels")


def changes(browser, what, act, key):
    """act() changes the picture and the scene's part `key`, and nothing of the rest."""
    before, picture = scene_of(browser), rest(browser)
    act()
    browser.wait(f"{STAGE} !== 'start'")
    after = scene_of(browser)
    check(rest(browser) != picture, f"{what}: the picture stays the same")
    changed = {name for name in after if after[name] != before.get(name)}
    check(changed == {key}, f"{what}: changes {changed}, not {key}")


def center(browser, selector):
    """The middle of an element on the screen."""
    return browser.run(f"""(() => {{ const b = document.querySelector({json.dumps(selector)}).getBoundingClientRect();
      return [b.x + b.width / 2, b.y + b.height / 2]; }})()""")


def set_control(browser, label, value, event="input"):
    """Moves the slider, list or switch with this label as a hand would."""
    browser.run(f"""(() => {{
      const label = [...document.querySelectorAll('aside label')].find((l) => l.textContent.trim() === {json.dumps(label)});
      const control = document.getElementById(label.htmlFor);
      control.closest('details').open = true;
      if (control.type === 'checkbox' || control.type === 'radio') control.click();
      else {{ control.value = {json.dumps(value)}; control.dispatchEvent(new Event({json.dumps(event)})); }}
    }})()""")


def press(browser, text):
    browser.run(f"""(() => {{ const b = [...document.querySelectorAll('button')].find((x) => x.textContent === {json.dumps(text)});
      if (b.closest('details')) b.closest('details').open = true; b.click(); }})()""")


def hands_on_the_camera(browser):
    x, y = center(browser, "#view")
    at = [x - 120, y + 90]  # beside the lights' handles
    to = [x - 60, y + 110]
    changes(browser, "left drag", lambda: browser.drag(at, to), "camera")
    distance = "(({ position: p, target: t }) => Math.hypot(p[0] - t[0], p[1] - t[1], p[2] - t[2]))(halflight.store.scene.camera)"
    far = browser.run(distance)
    target = scene_of(browser)["camera"]["target"]
    changes(browser, "shift drag", lambda: browser.drag(at, to, modifiers=8), "camera")
    check(scene_of(browser)["camera"]["target"] != target and abs(browser.run(distance) / far - 1) < 1e-9, "shift drag pans")
    changes(browser, "ctrl drag", lambda: browser.drag(at, to, modifiers=2), "camera")
    changes(browser, "wheel", lambda: browser.wheel(*at, -200), "camera")
    check(browser.run(distance) < far, "the wheel turned forwards comes nearer")
    changes(browser, "right drag", lambda: browser.drag(at, [at[0], at[1] + 40], button="right"), "camera")
    browser.run("document.getElementById('view').focus()")
    changes(browser, "arrow key", lambda: browser.key("ArrowLeft"), "camera")
    changes(browser, "parallel projection", lambda: set_control(browser, "Parallel", ""), "camera")
    changes(browser, "frame everything", lambda: press(browser, "Frame") or browser.wait(f"{STAGE} === 'moving'"), "camera")


def hands_on_the_light(browser):
    handle = center(browser, ".light-dot")
    changes(browser, "light drag", lambda: browser.drag(handle, [handle[0] + 70, handle[1] + 20]), "lights")
    ring = browser.run("document.querySelector('.light-ring').getBoundingClientRect().right")
    y = center(browser, ".light-dot")[1]
    before = scene_of(browser)["lights"][0]["angular_diameter_deg"]
    changes(browser, "ring drag", lambda: browser.drag([ring - 0.5, y], [ring + 24, y]), "lights")
    check(scene_of(browser)["lights"][0]["angular_diameter_deg"] > before + 5, "a wider ring is a larger light")
    changes(browser, "intensity", lambda: set_control(browser, "Intensity", 2.5), "lights")
    changes(browser, "colour of the light", lambda: set_control(browser, "Colour", "#ff8040"), "lights")
    changes(browser, "hard shadows", lambda: set_control(browser, "Hard", ""), "render")
    changes(browser, "no shadows", lambda: set_control(browser, "Off", ""), "render")
    changes(browser, "soft shadows", lambda: set_control(browser, "Soft", ""), "render")
    changes(browser, "method", lambda: set_control(browser, "Method", "sublights", "change"), "render")


def hands_on_the_function(browser):
    box = browser.run("(({ x, y, width, height }) => [x, y, width, height])(document.querySelector('canvas.function').getBoundingClientRect())")
    place = [box[0] + 0.5 * box[2], box[1] + 0.3 * box[3]]
    count = "halflight.store.scene.volumes[0].transfer_function.opacity.length"
    points = browser.run(count)
    changes(browser, "a new point", lambda: browser.drag(place, [place[0] + 12, place[1] + 60]), "volumes")
    check(browser.run(count) == points + 1, "a click adds a point")
    before = scene_of(browser)["volumes"]
    changes(browser, "Delete", lambda: browser.key("Delete"), "volumes")
    check(browser.run(count) == points, "Delete removes it")
    changes(browser, "undo", lambda: press(browser, "Undo"), "volumes")
    check(scene_of(browser)["volumes"] == before, "undo brings it back")
    changes(browser, "redo", lambda: press(browser, "Redo"), "volumes")
    changes(browser, "opacity", lambda: set_control(browser, "Opacity", -2), "volumes")
    changes(browser, "colormap", lambda: set_control(browser, "Colours", "viridis", "change"), "volumes")
    changes(browser, "preset", lambda: set_control(browser, "Preset", "ct-bone", "change") or
            browser.wait(f"{STAGE} === 'moving'"), "volumes")
    changes(browser, "automatic", lambda: set_control(browser, "Preset", "automatic", "change") or
            browser.wait(f"{STAGE} === 'moving'"), "volumes")


def other_panels(browser):
    clip = "document.querySelector('[aria-label=\"Clip x, greatest\"]')"
    changes(browser, "clip", lambda: browser.run(f"{clip}.value = 0; {clip}.dispatchEvent(new Event('input'))"), "volumes")
    changes(browser, "background", lambda: set_control(browser, "Background", "#203050"), "image")
    changes(browser, "exposure", lambda: set_control(browser, "Exposure", 1), "image")


def keyboard_and_names(browser):
    """Every control has a name, and ids are not used twice."""
    nameless = browser.run("""[...document.querySelectorAll('button, input, select, canvas.function, [role=slider]')].filter((e) => {
      const label = e.id && document.querySelector(`label[for="${e.id}"]`);
      return !(e.getAttribute('aria-label') || label || e.closest('label') || e.textContent.trim());
    }).map((e) => e.outerHTML)""")
    check(nameless == [], f"controls without a name: {nameless}")
    twice = browser.run("(() => { const ids = [...document.querySelectorAll('[id]')].map((e) => e.id); return ids.length - new Set(ids).size; })()")
    check(twice == 0, "an id is used twice")
    browser.run("document.getElementById('view').focus()")
    browser.key("?")
    check(browser.run("document.getElementById('help').open"), "'?' opens the help sheet")
    browser.run("document.getElementById('help').close()")
    overflow = browser.run("[document.documentElement.scrollWidth - innerWidth, document.documentElement.scrollHeight - innerHeight]")
    check(max(overflow) <= 0, "the page fits into 1280 x 720")


chromium = shutil.which("chromium")
if chromium is None:
    print("chromium is not installed")
    sys.exit(77)
with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    if subprocess.run([PROGRAM, "view", "none.nrrd", "--no-browser"], capture_output=True, check=False).returncode == 4:
        print("built without the viewer")
        sys.exit(77)
    subprocess.run([PROGRAM, "make", "rings", "--size", "32", "--quiet", "-o", "rings.nrrd"], check=True)
    quick = subprocess.run([PROGRAM, "render", "rings.nrrd", "--print-scene", "--sheet-spacing", "2", "--light-samples", "2"],
                           check=True, capture_output=True)
    with open("rings.json", "wb") as file:
        file.write(quick.stdout)
    with Viewer(PROGRAM, "rings.json") as viewer, Browser(chromium, (1280, 720)) as browser:
        browser.open(viewer.url)
        rest(browser)
        equals_render(browser, "first")
        keyboard_and_names(browser)
        browser.resize(720, 420)
        browser.wait("halflight.store.scene.image.width === 380")
        hands_on_the_camera(browser)
        hands_on_the_light(browser)
        hands_on_the_function(browser)
        other_panels(browser)
        equals_render(browser, "last")
        counts = browser.run("halflight.frames.statistics")
        check(browser.problems == [], f"the console has errors: {browser.problems}")
        print(f"{checks} checks passed; frames: {counts}")
