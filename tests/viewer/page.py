#!/usr/bin/env python3
"""The viewer's page in a headless Chromium: hands move the picture, and at rest it is what `halflight render` makes.

usage: page.py PROGRAM
"""
import io
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time

from PIL import Image

import checks
from browser import Browser
from checks import check
from hands import PROGRAM, STAGE, center, changes, equals_render, final_picture, press, resize, rest, scene_of, set_control
from viewer import Viewer, need_viewer


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
    # The fill light from the eye, which has a handle in the very middle once it is chosen, is not in the way.
    changes(browser, "left drag from the middle", lambda: browser.drag([x, y], to), "camera")
    browser.run("document.getElementById('view').focus()")
    changes(browser, "the first view", lambda: browser.key("Home"), "camera")
    changes(browser, "arrow key", lambda: browser.key("ArrowLeft"), "camera")
    changes(browser, "parallel projection", lambda: set_control(browser, "Parallel", ""), "camera")
    changes(browser, "frame everything", lambda: press(browser, "Show all") or browser.wait(f"{STAGE} === 'moving'"), "camera")


def few_bytes(sent, what):
    """Moving frames send differences of 600 bytes at most; a whole scene only where the picture at rest was under way, one for each."""
    moving = [(size, "base=" in path) for path, size in sent if "moving=1" in path]
    told = [size for size, differs in moving if differs]
    check(told and max(told) <= 600, f"{what}: {moving}")
    check(len(moving) - len(told) < max(1, sum("moving=0" in path for path, _ in sent)), f"{what}: whole scenes: {sent}")


def uploads(browser):
    """While something moves, a frame sends what differs from the scene that the viewer holds: few bytes; where it holds none, the scene, and the picture is the same."""
    x, y = center(browser, "#view")
    rest(browser)
    browser.run("""(() => { const asked = globalThis.fetch; globalThis.sent = [];
      globalThis.fetch = (path, options) => { if (path.startsWith('frame?')) sent.push([path, new TextEncoder().encode(options.body).length]); return asked(path, options); }; })()""")
    whole = len(browser.run("JSON.stringify(halflight.store.scene)"))
    for name, act in (("camera", lambda: browser.drag([x - 120, y + 90], [x - 60, y + 110], steps=12)), ("wheel", lambda: browser.wheel(x - 120, y + 90, -60)),
                      ("light", lambda: browser.drag((dot := center(browser, ".light-dot")), [dot[0] + 40, dot[1] + 20], steps=12)),
                      ("exposure", lambda: set_control(browser, "Exposure", 0.5))):
        browser.run("sent.length = 0")
        act()
        rest(browser)
        few_bytes(browser.run("sent"), f"{name}, of a scene of {whole}")
    page = browser.run("new URLSearchParams(sent.at(-1)[0].slice(6)).get('page')")
    browser.run(f"sent.length = 0, fetch('leave?page={page}', {{ method: 'POST' }}).then(() => 0)")
    browser.drag([x - 120, y + 90], [x - 60, y + 110])
    equals_render(browser, "forgotten")
    moving = [(size, "base=" in path) for path, size in browser.run("sent") if "moving=1" in path]
    check(moving[0][0] <= 600 and moving[0][1] and moving[1][0] > 600 and not moving[1][1], f"the viewer has forgotten the scene: {moving}")
    few_bytes(browser.run("sent")[2:], "and holds the one that came")
    expected = [problem for problem in browser.problems if "409" in problem]
    check(len(expected) == 1, f"one refusal: {browser.problems}")
    browser.problems.remove(expected[0])


def shape_of_moving_pictures(browser):
    """While something moves, pictures are smaller and have the shape of the full one, so that nothing is stretched."""
    resize(browser, 820, 1180)
    rest(browser)
    browser.run("""(() => { const picture = document.getElementById('picture'); globalThis.shapes = [];
      new MutationObserver(() => shapes.push([picture.width, picture.height])).observe(picture, { attributes: true, attributeFilter: ['width', 'height'] }); })()""")
    x, y = center(browser, "#view")
    browser.drag([x - 60, y + 90], [x, y + 110], steps=12)
    rest(browser)
    full = scene_of(browser)["image"]
    shapes = browser.run("shapes")
    check(len({tuple(shape) for shape in shapes}) > 1, f"smaller pictures were shown: {shapes}")
    check(all(abs(width * full["height"] / full["width"] - height) <= 0.5 for width, height in shapes), f"of {full['width']} x {full['height']}: {shapes}")


def fingers_on_the_camera(browser):
    x, y = center(browser, "#view")
    at = [x - 120, y + 90]
    height = "import('./camera.js').then((m) => m.worldHeight(halflight.store.scene.camera))"
    far, target = browser.run(height), scene_of(browser)["camera"]["target"]
    changes(browser, "one finger", lambda: browser.touch([at], [[at[0] + 40, at[1] + 20]]), "camera")
    check(abs(browser.run(height) / far - 1) < 1e-9 and scene_of(browser)["camera"]["target"] == target, "one finger turns")
    changes(browser, "two fingers apart", lambda: browser.touch([at, [x, y + 90]], [[at[0] - 40, at[1]], [x + 40, y + 90]]), "camera")
    check(browser.run(height) < 0.9 * far, "two fingers apart come nearer")
    target = scene_of(browser)["camera"]["target"]
    changes(browser, "two fingers aside", lambda: browser.touch([at, [x, y + 90]], [[at[0] + 40, at[1]], [x + 40, y + 90]]), "camera")
    check(scene_of(browser)["camera"]["target"] != target, "two fingers aside pan")
    changes(browser, "framed again", lambda: press(browser, "Show all") or browser.wait(f"{STAGE} === 'moving'"), "camera")


def hands_on_the_light(browser):
    handle = center(browser, ".light-dot")
    changes(browser, "light drag", lambda: browser.drag(handle, [handle[0] + 70, handle[1] + 20]), "lights")
    ring = browser.run("document.querySelector('.light-ring').getBoundingClientRect().left")  # at its right lies a handle of the clip box
    y = center(browser, ".light-dot")[1]
    before = scene_of(browser)["lights"][0]["angular_diameter_deg"]
    changes(browser, "ring drag", lambda: browser.drag([ring + 0.5, y], [ring - 24, y]), "lights")
    check(scene_of(browser)["lights"][0]["angular_diameter_deg"] > before + 5, "a wider ring is a larger light")
    changes(browser, "intensity", lambda: set_control(browser, "Intensity", 2.5), "lights")
    changes(browser, "colour of the light", lambda: set_control(browser, "Colour", "#ff8040", section="Lights"), "lights")
    changes(browser, "hard shadows", lambda: set_control(browser, "Hard", ""), "render")
    changes(browser, "no shadows", lambda: set_control(browser, "Off", ""), "render")
    changes(browser, "soft shadows", lambda: set_control(browser, "Soft", ""), "render")
    changes(browser, "method", lambda: set_control(browser, "Method", "sublights", "change"), "render")


def scrolled_over(browser):
    """The wheel turned downwards over the drawing scrolls the side bar as long as all values are shown; turned upwards it zooms the values."""
    browser.run("document.querySelector('canvas.function').scrollIntoView({ block: 'center' })")
    x, y = center(browser, "canvas.function")
    top = browser.run("document.getElementById('panels').scrollTop")
    browser.wheel(x, y, 60)
    browser.wait(f"document.getElementById('panels').scrollTop > {top}", timeout=20)
    browser.run("document.querySelector('canvas.function').scrollIntoView({ block: 'center' })")
    x, y = center(browser, "canvas.function")
    top = browser.run("document.getElementById('panels').scrollTop")
    browser.wheel(x, y, -60)
    browser.wheel(x, y, 30)
    browser.run("new Promise((done) => setTimeout(done, 500))")
    check(browser.run("document.getElementById('panels').scrollTop") == top, "while values are zoomed, the side bar stays")
    browser.wheel(x, y, 600)
    browser.run("new Promise((done) => setTimeout(done, 500))")


def hands_on_the_function(browser):
    browser.run("document.querySelector('canvas.function').scrollIntoView({ block: 'center' })")
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
    changes(browser, "tone", lambda: browser.run("document.querySelector('[aria-label=Tone] input[value=filmic]').click()"), "image")


def narrow_pages(browser):
    """In a picture taller than wide as much is seen across as in a square one; the wide one comes back."""
    across = """import('./camera.js').then((m) => { const { camera, image } = halflight.store.scene;
      return m.worldHeight(camera) * Math.min(1, image.width / image.height); })"""
    before, camera = browser.run(across), scene_of(browser)["camera"]
    resize(browser, 820, 1180)
    check(abs(browser.run(across) / before - 1) < 1e-9, "a narrow page shows as much across")
    rest(browser)
    resize(browser, 1280, 720)
    back = scene_of(browser)["camera"]
    check(max(abs(a - b) for a, b in zip(camera["position"], back["position"])) < 1e-9 * before, "a wide page shows what it showed")


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
    check(browser.run("(({ scrollHeight, clientHeight }) => scrollHeight <= clientHeight)(document.getElementById('help'))"), "which is seen whole in 1280 x 720")
    browser.run("document.getElementById('help').close()")
    overflow = browser.run("[document.documentElement.scrollWidth - innerWidth, document.documentElement.scrollHeight - innerHeight]")
    check(max(overflow) <= 0, "the page fits into 1280 x 720")


def saved_as_seen(browser):
    """A saved picture that is taller than wide shows as much across as the one on the screen; its sides follow what it is for."""
    os.mkdir("saved")
    browser.call("Page.setDownloadBehavior", behavior="allow", downloadPath=os.path.abspath("saved"))
    check(browser.run("document.getElementById('scale-bar').disabled && document.getElementById('no-unit').textContent.includes('no unit')"), "no bar without a unit")
    browser.run("(() => { const unit = document.getElementById('unit'); unit.value = 'mm'; unit.dispatchEvent(new Event('input')); })()")
    check(browser.run("!document.getElementById('scale-bar').disabled && document.querySelector('.scale text').textContent.endsWith(' mm')"), "with one there is, in the picture, too")
    command = "import('./export.js').then((m) => m.commandLine(halflight.store.scene, 'a', { scaleBar: true, unit: 'light years' }))"
    check(" --unit 'light years' --scale-bar auto@target " in browser.run(command), "the copied command names the unit")
    browser.run("halflight.store.setPage({ unit: '' })")
    seen = browser.run("halflight.store.scene.image.width")
    set_control(browser, "For", "2", "change")
    sides = browser.run("[...document.querySelectorAll('[aria-label$=\"in pixels\"]')].map((input) => +input.value)")
    check(sides[0] == 2 * seen, f"twice as seen: {sides}")
    chosen = """(() => { const label = [...document.querySelectorAll('aside label')].find((l) => l.textContent === 'For'); return document.getElementById(label.htmlFor); })()"""
    check(browser.run(f"{chosen}.value") == "2", "the list says so")
    width, height = browser.run("[innerWidth, innerHeight]")
    resize(browser, width - 100, height)
    check(browser.run("+document.querySelector('[aria-label=\"Width in pixels\"]').value === 2 * halflight.store.scene.image.width"), "also in another window")
    resize(browser, width, height)
    browser.run(f"{chosen}.value = '', {chosen}.dispatchEvent(new Event('change')), {chosen}.scrollIntoView({{ block: 'center' }}), {chosen}.focus()")
    for purpose in ("1", "2", "4", "8.5cm"):
        for kind in ("rawKeyDown", "keyUp"):
            browser.call("Input.dispatchKeyEvent", type=kind, key="ArrowDown", code="ArrowDown", windowsVirtualKeyCode=40)
        browser.wait(f"{chosen}.value === '{purpose}'", timeout=20)  # the keyboard reaches each size
    set_control(browser, "For", "8.5cm", "change")
    check(browser.run("+document.querySelector('[aria-label=\"Width in pixels\"]').value") == 1004, "8.5 cm at 300 dpi")
    browser.run("""['Width', 'Height'].forEach((side, n) => { const input = document.querySelector(`[aria-label="${side} in pixels"]`);
      input.value = [120, 300][n]; input.dispatchEvent(new Event('input')); })""")
    check(browser.run(f"{chosen}.value") == "", "what is typed is for these pixels")
    set_control(browser, "Transparent", "")
    press(browser, "save picture")
    set_control(browser, "Transparent", "")
    end = time.monotonic() + 60
    while not os.path.exists("saved/rings.png"):
        check(time.monotonic() < end, "it is saved")
        time.sleep(0.05)
    with Image.open("saved/rings.png") as image:
        tall = json.loads(image.text["halflight:scene"])
        check(image.mode == "RGBA" and image.getextrema()[3] == (0, 255), f"nothing is behind it: {image.mode} {image.getextrema()}")
    share = """(camera, image) => import('./camera.js').then((m) => m.worldHeight(camera) * Math.min(1, image.width / image.height))"""
    now, saved = (browser.run(f"({share})({json.dumps(scene['camera'])}, {json.dumps(scene['image'])})") for scene in (scene_of(browser), tall))
    check((tall["image"]["width"], tall["image"]["height"]) == (120, 300) and abs(saved / now - 1) < 1e-9, f"as much across: {saved}, {now}")


def saved_with_bar(browser):
    """A saved picture has the scale bar, the legend and the axes that the copied command draws, and the page shows them."""
    browser.run("['scale-bar', 'legend'].forEach((id) => document.getElementById(id).click())")
    check(browser.run("document.getElementById('scale-bar').checked && document.getElementById('no-unit').hidden"), "the file tells its unit")
    set_control(browser, "Axes", "arrows", "change")
    figure = "document.querySelector('.figure')"
    browser.wait(f"!{figure}.hidden")
    drawn = browser.run(f"{figure}.getContext('2d').getImageData(0, 0, {figure}.width, {figure}.height).data.reduce((sum, x) => sum + x, 0)")
    check(drawn > 0 and browser.run("getComputedStyle(document.querySelector('.scale')).display") == "none", "they are shown in place of the page's own")
    check("letters" not in browser.run("[...document.querySelectorAll('aside option')].map((o) => o.value)"), "the file tells no directions of a body")
    browser.run("import('./camera.js').then((m) => halflight.store.setCamera(m.turn(halflight.store.scene.camera, 0.2, 0)))")
    check(browser.run(f"{figure}.hidden"), "they are not shown for another view")
    rest(browser)
    browser.wait(f"!{figure}.hidden")
    os.remove("saved/rings.png")  # the first one: the map's picture has this name, too
    press(browser, "save picture")
    browser.wait("document.getElementById('message').textContent.includes('saved')")
    end = time.monotonic() + 60
    while not os.path.exists("saved/rings.png"):
        check(time.monotonic() < end, "it is saved")
        time.sleep(0.05)
    command = browser.run("import('./export.js').then((m) => m.commandLine(halflight.store.scene, 'bar', { scaleBar: true, legend: true, axes: 'arrows' }))")
    os.mkdir("bar")
    environment = dict(os.environ, PATH=f"{os.path.dirname(PROGRAM)}:{os.environ['PATH']}")
    subprocess.run(["sh", "-eu", "-c", command], cwd="bar", check=True, env=environment, capture_output=True)
    with open("saved/rings.png", "rb") as saved, open("bar/bar.png", "rb") as made:
        check(saved.read() == made.read(), "the copied command makes the picture")
    with Image.open("bar/bar.png") as drawn:
        shown = Image.open(io.BytesIO(final_picture(browser)))
        check(drawn.convert("RGB").tobytes() != shown.convert("RGB").tobytes(), "something is drawn over it")
    set_control(browser, "Format", "exr", "change")
    check(browser.run("document.getElementById('plain-format').hidden === false"), "EXR holds linear light")
    browser.wait("JSON.parse(sessionStorage.getItem('halflight-session') ?? '{}').page?.over?.axes === 'arrows'")
    browser.run("window.old = true; 0")
    browser.call("Page.reload")
    browser.wait("window.old === undefined && globalThis.halflight !== undefined")
    rest(browser)
    browser.wait(f"!{figure}.hidden && document.getElementById('legend').checked")
    browser.run("['scale-bar', 'legend'].forEach((id) => document.getElementById(id).click())")
    set_control(browser, "Axes", "none", "change")
    check(browser.run(f"{figure}.hidden"), "nothing is drawn any more")


def messages_cover_nothing(browser):
    """A message over the picture covers no scale bar, no axes and no legend, neither the page's own nor those of a figure, also on a phone."""
    covered = """(() => { const message = document.getElementById('message').getBoundingClientRect(), view = document.getElementById('view').getBoundingClientRect();
      const meets = (b) => b.width > 0 && b.left < message.right && message.left < b.right && b.top < message.bottom && message.top < b.bottom;
      const own = [...document.querySelectorAll('.scale, .marker, .side')].filter((e) => meets(e.getBoundingClientRect())).map((e) => e.getAttribute('class'));
      const figure = document.querySelector('.figure'), part = figure.width / view.width;
      const [left, top, width, height] = [message.left - view.left, message.top - view.top, message.width, message.height].map((x) => Math.round(part * x));
      const drawn = !figure.hidden && figure.getContext('2d').getImageData(left, top, width, height).data.some((x) => x > 0);
      return [document.getElementById('message').hidden, message.left >= view.left && message.right <= view.right, own, drawn]; })()"""
    for size in ((390, 844), (600, 900), (1280, 720)):
        resize(browser, *size)
        rest(browser)
        for axes in ("none", "arrows"):
            set_control(browser, "Axes", axes, "change")
            if axes == "arrows":
                browser.run("['scale-bar', 'legend'].forEach((id) => document.getElementById(id).click())")
                browser.wait("!document.querySelector('.figure').hidden")
            for text in ("saved rings.png", "a line of many words, as long as those that say why a file was refused and what would mend it"):
                browser.run(f"halflight.report({json.dumps(text)})")
                found = browser.run(covered)
                check(found == [False, True, [], False], f"{size}, axes {axes}: {found}")
        browser.run("['scale-bar', 'legend'].forEach((id) => document.getElementById(id).click())")
        set_control(browser, "Axes", "none", "change")


def legends_without_room(browser):
    """The message line says that a legend finds no room in the picture."""
    resize(browser, 300, 200)
    rest(browser)
    browser.run("halflight.report('')")
    browser.run("document.getElementById('legend').click()")
    browser.wait("document.getElementById('message').textContent.includes('the legend finds no room in the picture')")
    browser.run("document.getElementById('legend').click()")
    resize(browser, 1280, 720)
    rest(browser)


def reach(browser):
    """On a phone, on a tablet and on a desk all buttons are in reach, and none is smaller than 24 pixels."""
    for size in ((390, 844), (820, 1180), (1280, 720)):
        resize(browser, *size)
        browser.run("document.querySelectorAll('details').forEach((d) => { d.open = true; })")
        rest(browser)
        away = browser.run("""[...document.querySelectorAll('header button, #view')].filter((e) => { const b = e.getBoundingClientRect();
          return b.width > 0 && (b.left < 0 || b.right > innerWidth || b.bottom > innerHeight); }).map((e) => e.textContent)""")
        small = browser.run("""[...document.querySelectorAll('button, input:not([type=radio]), select, summary')].filter((e) => { const b = e.getBoundingClientRect();
          return b.width > 0 && Math.min(b.width, b.height) < 23.9; }).map((e) => e.outerHTML.slice(0, 90))""")
        check(away == [] and small == [], f"{size}: out of reach: {away}; too small: {small}")


chromium = shutil.which("chromium")
if chromium is None:
    print("chromium is not installed")
    sys.exit(77)
with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    need_viewer(PROGRAM)
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
        saved_as_seen(browser)
        reach(browser)
        narrow_pages(browser)
        shape_of_moving_pictures(browser)
        resize(browser, 720, 420)
        uploads(browser)
        hands_on_the_camera(browser)
        fingers_on_the_camera(browser)
        hands_on_the_light(browser)
        scrolled_over(browser)
        hands_on_the_function(browser)
        other_panels(browser)
        equals_render(browser, "last")
        counts = browser.run("halflight.frames.statistics")
        bar = "document.querySelector('.scale text').textContent"
        check(re.fullmatch(r"[\d.]+", browser.run(bar)), f"a scale without a unit: {browser.run(bar)}")
        with Viewer(PROGRAM, "rings.nrrd", "--unit", "cm") as told:
            browser.open(told.url)
            rest(browser)
            check(re.fullmatch(r"[\d.]+ cm", browser.run(bar)), f"a scale in the unit of --unit: {browser.run(bar)}")
            check(browser.run("!document.getElementById('scale-bar').disabled && document.getElementById('unit').value === 'cm'"), "which fills the field")
        subprocess.run([PROGRAM, "convert", "rings.nrrd", "rings.mrc", "--quiet"], check=True)
        with Viewer(PROGRAM, "rings.mrc") as map_viewer:
            browser.open(map_viewer.url)
            rest(browser)
            check(re.fullmatch(r"[\d.]+ Å", browser.run(bar)), f"a scale in Angstroms: {browser.run(bar)}")
            facts = browser.run("[...document.querySelectorAll('details')].find((d) => d.querySelector('summary').textContent === 'Volume').querySelector('.facts').textContent")
            check(re.match(r"\d+ × \d+ × \d+ voxels of ([\d.]+) × \1 × \1 Å, ", facts), f"the size of voxels: {facts}")
            saved_with_bar(browser)
            messages_cover_nothing(browser)
            legends_without_room(browser)
        check(browser.problems == [], f"the console has errors: {browser.problems}")
        print(f"{checks.count} checks passed; frames: {counts}")
