"""What tests of the page share: checks, the picture at rest, and hands on its controls."""
import base64
import hashlib
import io
import json
import os
import subprocess
import sys

from PIL import Image

from checks import check

PROGRAM = os.path.abspath(sys.argv[1])
STAGE = "globalThis.halflight?.frames.statistics.stage"


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
