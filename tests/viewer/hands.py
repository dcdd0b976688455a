"""What tests of the page share: checks, the picture at rest, and hands on its controls."""
import base64
import hashlib
import io
import json
import os
import subprocess
import sys
import tempfile

from PIL import Image

import checks
from checks import check
from firefox import browser_named
from viewer import Viewer, need_viewer

PROGRAM = os.path.abspath(sys.argv[1])
STAGE = "globalThis.halflight?.frames.statistics.stage"
# All of a person's work. Which sections are unfolded is told by an event that comes later.
STATE = "(({ sections, ...page }) => JSON.stringify([halflight.store.scene, halflight.store.marks, page]))(halflight.store.page)"
# The keys in the timeline: their paths and frames.
KEYS = "[...document.querySelectorAll('.timeline .key')].map((key) => [key.dataset.path, +key.dataset.frame])"


def rest(browser):
    """Waits for the final picture; returns the SHA-256 of the pixels on the screen, R, G, B, A."""
    browser.wait(f"{STAGE} === 'final' && document.getElementById('stage')?.dataset.stage !== 'waiting' && document.querySelector('.gallery[data-busy]') === null")
    return browser.run("""(() => {
      const canvas = document.getElementById('picture');
      const { data } = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height);
      return crypto.subtle.digest('SHA-256', data).then((hash) =>
        [...new Uint8Array(hash)].map((byte) => byte.toString(16).padStart(2, '0')).join(''));
    })()""")


def resize(browser, width, height):
    """Gives the page a window of width x height pixels, and waits until its picture has the size that this leaves for it."""
    browser.resize(width, height)
    browser.wait(f"""innerWidth === {width} && innerHeight === {height} && (() => {{
      const view = document.getElementById('view');
      const {{ image }} = halflight.store.scene;
      return image.width === Math.max(view.clientWidth, 16) && image.height === Math.max(view.clientHeight, 16); }})()""")


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
    check(final_picture(browser) == rendered, f"{name}: the final picture's bytes are not those of halflight render")
    image = Image.open(io.BytesIO(rendered)).convert("RGBA")
    check(hashlib.sha256(image.tobytes()).hexdigest() == screen, f"{name}: the screen does not show the final picture's pixels")


def changes(browser, what, act, key):
    """act() changes the picture and the scene's part `key`, and nothing of the rest."""
    before, picture = scene_of(browser), rest(browser)
    act()
    browser.wait(f"{STAGE} !== 'start'")
    after = scene_of(browser)
    check(rest(browser) != picture, f"{what}: the picture stays the same")
    changed = {name for name in {*before, *after} if after.get(name) != before.get(name)}
    check(changed == {key}, f"{what}: changes {changed}, not {key}")


def center(browser, selector):
    """The middle of an element on the screen."""
    return browser.run(f"""(() => {{ const b = document.querySelector({json.dumps(selector)}).getBoundingClientRect();
      return [b.x + b.width / 2, b.y + b.height / 2]; }})()""")


def set_control(browser, label, value, event="input", section=""):
    """Moves the slider, list or switch with this label as a hand would, which reaches no hidden panel; section: the title of the panel, where others have such a label too."""
    browser.run(f"""(() => {{
      const label = [...document.querySelectorAll('aside label')].find((l) => l.textContent.trim() === {json.dumps(label)} && l.closest('[hidden]') === null &&
        ({json.dumps(section)} === '' || l.closest('details')?.querySelector('summary').textContent.includes({json.dumps(section)})));
      const control = document.getElementById(label.htmlFor);
      if (control.closest('details')) control.closest('details').open = true;
      if (control.type === 'checkbox' || control.type === 'radio') control.click();
      else {{ control.value = {json.dumps(value)}; control.dispatchEvent(new Event({json.dumps(event)})); }}
    }})()""")


def press(browser, text):
    browser.run(f"""(() => {{ const b = [...document.querySelectorAll('button')].find((x) => x.textContent === {json.dumps(text)});
      if (b.closest('details')) b.closest('details').open = true; b.click(); }})()""")


def press_named(browser, name):
    """The button with this accessible name, or this text."""
    browser.run(f"""[...document.querySelectorAll('button')].find((b) => (b.getAttribute('aria-label') ?? b.textContent) === {json.dumps(name)}).click()""")


def open_section(browser, title):
    browser.run(f"""[...document.querySelectorAll('details')].forEach((d) => {{
      d.open = d.querySelector('summary').textContent === {json.dumps(title)}; }})""")
    browser.wait("[...document.querySelectorAll('details')].some((d) => d.open)")


def undo(browser):
    press_named(browser, "Undo")


def reload(browser):
    browser.run("globalThis.before = true")
    browser.reload()
    browser.wait("globalThis.before === undefined && globalThis.halflight !== undefined")
    rest(browser)


def undone(browser, key, before, what):
    """One undo brings the scene's part back as it was, one redo the change."""
    after = scene_of(browser)[key]
    changes(browser, f"{what}, undone", lambda: press_named(browser, "Undo"), key)
    check(scene_of(browser)[key] == before, f"{what}: undo brings back what was")
    changes(browser, f"{what}, redone", lambda: press_named(browser, "Redo"), key)
    check(scene_of(browser)[key] == after, f"{what}: redo brings it again")


def final_picture(browser):
    """The bytes of the final picture."""
    rest(browser)
    return base64.b64decode(browser.run("""halflight.frames.finalPicture.arrayBuffer().then((b) =>
      btoa(new Uint8Array(b).reduce((text, byte) => text + String.fromCharCode(byte), '')))"""))


def copied_command(browser, title="picture"):
    """The copied command makes the final picture, byte for byte. Returns the copied Python program."""
    shown = final_picture(browser)
    command, program = browser.run(f"""import('./export.js').then((m) =>
      [m.commandLine(halflight.store.scene, {json.dumps(title)}), m.pythonProgram(halflight.store.scene, 'a"b.json')])""")
    environment = dict(os.environ, PATH=f"{os.path.dirname(PROGRAM)}:{os.environ['PATH']}")
    with tempfile.TemporaryDirectory(dir=".") as folder:
        subprocess.run(["sh", "-eu", "-c", command], cwd=folder, check=True, env=environment, capture_output=True)
        with open(f"{folder}/{title.removesuffix('.json')}.png", "rb") as file:
            check(file.read() == shown, "the copied command makes the picture")
    return program


def on_rings(*tests):
    """Runs tests, each a function of a browser, one after the other on the page of a small volume. The browser is the one that the command line names."""
    with tempfile.TemporaryDirectory() as place:
        os.chdir(place)
        need_viewer(PROGRAM)
        subprocess.run([PROGRAM, "make", "rings", "--size", "32", "--quiet", "-o", "rings.nrrd"], check=True)
        with Viewer(PROGRAM, "rings.nrrd", "--sheet-spacing", "2", "--shadows", "hard") as viewer, browser_named(sys.argv[2])(size=(900, 620)) as page:
            page.open(viewer.url)
            rest(page)
            for test in tests:
                test(page)
            check(page.problems == [], f"the console has errors: {page.problems}")
    print(f"{checks.count} checks passed")
