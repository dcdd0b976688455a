#!/usr/bin/env python3
"""Measuring on the page, in a headless Chromium or Firefox: rulers, angles, lines, arrows and texts by clicks in the picture and in slices, by fingers and keys;
their numbers are those of the file's lengths, and they stand in the scene.

usage: marks.py PROGRAM chromium|firefox-esr [FOLDER]
FOLDER: where screenshots are kept; without it they are not made.
"""
import json
import base64
import io
import math
import os
import re
import shutil
import subprocess
import sys
import tempfile

import numpy
from PIL import Image

import checks
from checks import check
from firefox import browser_named
from hands import PROGRAM, STAGE, center, open_section, press, press_named, rest, scene_of, set_control
from viewer import Viewer, need_viewer

SIDE, SPACING = 40, (2.0, 1.0, 1.0)  # voxels; millimetres along x, y, z
SHOTS = os.path.abspath(sys.argv[3]) if len(sys.argv) > 3 else None


def write_ball():
    x, y, z = (axis - 19.5 for axis in numpy.mgrid[:SIDE, :SIDE, :SIDE])
    ball = (250 * numpy.clip(16.5 - numpy.sqrt((2 * x) ** 2 + y * y + z * z), 0, 1)).astype("u1")
    header = (f"NRRD0004\ntype: uint8\ndimension: 3\nspace dimension: 3\nsizes: {SIDE} {SIDE} {SIDE}\nspace directions: ({SPACING[0]},0,0) (0,1,0) (0,0,1)\n"
              "space origin: (0,0,0)\nspace units: \"mm\" \"mm\" \"mm\"\nencoding: raw\n\n")
    with open("ball.nrrd", "wb") as file:
        file.write(header.encode() + ball.tobytes(order="F"))


def world(voxel):
    return [spacing * index for spacing, index in zip(SPACING, voxel)]


def pixel(browser, voxel, name="axial"):
    return browser.run(f"""(() => {{ const view = halflight.slices.view({json.dumps(name)}), [x, y] = view.project({json.dumps(world(voxel))});
      const box = view.area.getBoundingClientRect(); return [box.x + x, box.y + y]; }})()""")


def in_picture(browser, point):
    return browser.run(f"""import('./camera.js').then((m) => {{ const view = document.getElementById('view'), box = view.getBoundingClientRect();
      const [x, y] = m.projector(halflight.store.scene.camera, view.clientWidth, view.clientHeight)({json.dumps(point)}); return [box.x + x, box.y + y]; }})""")


def marks(browser):
    return json.loads(browser.run("JSON.stringify(halflight.store.marks)"))


def measured(browser):
    return browser.run("[...document.querySelectorAll('.marks .measured')].map((one) => one.textContent)")


def close(point, other, reach):
    return math.dist(point, other) <= reach


def rulers(browser):
    """From voxel to voxel of a slice: the length of the file, in its unit; one step of undo."""
    a, b = (10, 12, 20), (28, 30, 20)
    press(browser, "Ruler")
    check(browser.run("document.querySelector('[data-kind=ruler]').getAttribute('aria-pressed')") == "true", "the tool is chosen")
    browser.click(pixel(browser, a))
    check(marks(browser) == [], "one point is no ruler")
    dots = browser.run("[...document.querySelectorAll('[data-plane=axial] .mark-dot')].map((dot) => { const b = dot.getBoundingClientRect(); return [b.x + b.width / 2, b.y + b.height / 2]; })")
    check(len(dots) == 1 and math.dist(dots[0], pixel(browser, a)) < 1.5, f"but is seen where it lies: {dots}")
    check(browser.run("[...document.querySelectorAll('.mark-text')].every((text) => text.textContent === '')"), "and has no length")
    browser.click(pixel(browser, b))
    (ruler,) = marks(browser)
    check(browser.run("document.querySelectorAll('.mark-dot').length") == 0, "a ruler has handles in place of the dot")
    length = math.dist(world(a), world(b))
    check(ruler["kind"] == "ruler" and close(ruler["points"][0], world(a), 0.2) and close(ruler["points"][1], world(b), 0.2), f"the ruler: {ruler}")
    check(abs(float(measured(browser)[0].split()[0]) - length) < 0.3 and measured(browser)[0].endswith(" mm"), f"{length} mm: {measured(browser)}")
    check(browser.run("document.querySelector('[data-kind=ruler]').getAttribute('aria-pressed')") == "false", "the tool is done")
    drawn = browser.run("[...document.querySelectorAll('#overlay .mark-text, [data-plane=axial] .mark-text')].map((t) => t.textContent)")
    check(drawn == [measured(browser)[0]] * 2, f"it is written in the picture and in the slice: {drawn}")
    browser.run("halflight.store.setMarks('another', [...halflight.store.marks, halflight.store.marks[0]])")
    order = browser.run("[...document.querySelector('#overlay .mark').parentNode.children].map((part) => part.localName)")
    check(order == ["path"] * 4 + ["text"] * 2, f"texts lie above the lines of other marks: {order}")
    press_named(browser, "Undo")
    press_named(browser, "Undo")
    check(marks(browser) == [] and measured(browser) == [], "undo")
    press_named(browser, "Redo")
    check(marks(browser) == [ruler], "redo")
    browser.drag(pixel(browser, b), pixel(browser, (28, 12, 20)))
    moved = marks(browser)[0]
    check(close(moved["points"][1], world((28, 12, 20)), 0.3) and moved["points"][0] == ruler["points"][0], f"its end is dragged: {moved}")
    press_named(browser, "Undo")
    check(marks(browser) == [ruler], "in one step")
    stroke = "getComputedStyle(document.querySelector('[data-plane=axial] .mark-handle .square')).stroke"
    check(browser.run(stroke) == "rgb(255, 225, 77)", f"its ends are seen on a black slice: {browser.run(stroke)}")
    browser.run("document.querySelector('[data-plane=axial] .mark-handle').focus()")
    browser.key("ArrowRight")
    check(marks(browser)[0]["points"][0] != ruler["points"][0], "and moved by keys")
    press_named(browser, "Undo")


def texts_of_rulers(browser):
    """The text of a ruler covers neither its line nor the squares at its ends, whichever way it runs."""
    before, middle = marks(browser), (19, 19, 20)
    for step in ((8, 0), (8, 3), (8, 12), (1, 12), (0, 12), (-1, 12), (-8, 12), (-8, 3)):
        ends = [[middle[0] + sign * step[0], middle[1] + sign * step[1], middle[2]] for sign in (1, -1)]
        browser.run(f"halflight.store.setMarks('test', [{{ kind: 'ruler', points: {json.dumps([world(end) for end in ends])} }}])")
        left, top, right, low = browser.run("""(({ x, y, width, height }) => [x, y, x + width, y + height])(document.querySelector('[data-plane=axial] .mark-text').getBoundingClientRect())""")
        one, other = (pixel(browser, end) for end in ends)
        line = [[a + (b - a) * part / 200 for a, b in zip(one, other)] for part in range(201)]
        reach = [5 if part in (0, 200) else 0 for part in range(201)]  # pixels; half a square
        covered = [place for place, side in zip(line, reach) if left < place[0] + side and place[0] - side < right and top < place[1] + side and place[1] - side < low]
        check(covered == [], f"a ruler along {step}: its text [{left}, {top}, {right}, {low}] covers {covered[:2]}")
        press_named(browser, "Undo")
    check(marks(browser) == before, "undone")


def angles(browser):
    press(browser, "Angle")
    for voxel in ((19, 5, 20), (19, 19, 20), (26, 19, 20)):
        browser.click(pixel(browser, voxel))
    check(marks(browser)[-1]["kind"] == "angle" and abs(float(measured(browser)[1].rstrip("°")) - 90) < 0.6, f"a right angle: {measured(browser)}")


def lines(browser):
    """A line ends by a double click, by Enter, or is given up by Escape; its length is the sum of its pieces."""
    corners = ((8, 8, 20), (28, 8, 20), (28, 32, 20))
    press(browser, "Line")
    for voxel in corners:
        browser.click(pixel(browser, voxel))
    browser.click(pixel(browser, corners[-1]), count=2)
    line = marks(browser)[-1]
    check(line["kind"] == "line" and len(line["points"]) == 3, f"a double click ends it: {line}")
    check(abs(float(measured(browser)[2].split()[0]) - 64) < 0.5, f"40 and 24: {measured(browser)}")
    press(browser, "Line")
    for voxel in corners[:2]:
        browser.click(pixel(browser, voxel))
    browser.run("document.getElementById('view').focus()")
    browser.key("Enter")
    check(len(marks(browser)) == 4 and len(marks(browser)[-1]["points"]) == 2, "Enter ends it")
    press_named(browser, "Undo")
    press(browser, "Line")
    for voxel in corners:
        browser.click(pixel(browser, voxel))
    browser.key("Enter")
    check(len(marks(browser)) == 4 and len(marks(browser)[-1]["points"]) == 3, f"Enter ends it in the slice that has its points, too: {marks(browser)[3:]}")
    press_named(browser, "Undo")
    press(browser, "Line")
    for voxel in corners[:2]:
        browser.click(pixel(browser, voxel))
    press(browser, "Ruler")
    check(len(marks(browser)) == 4 and len(marks(browser)[-1]["points"]) == 2, "another tool leaves the line as far as it has come")
    browser.key("Escape")
    press(browser, "Line")
    browser.click(pixel(browser, corners[0]))
    browser.key("Escape")
    check(len(marks(browser)) == 4 and browser.run("document.querySelectorAll('[aria-pressed=true][data-kind]').length") == 0, "Escape gives it up")
    count = len(marks(browser))
    press_named(browser, "Remove Line 4")
    check(len(marks(browser)) == count - 1, "a mark is removed")


def arrows_and_texts(browser):
    press(browser, "Arrow")
    browser.touch([pixel(browser, (5, 5, 20))])
    browser.touch([pixel(browser, (19, 19, 20))])
    arrow = marks(browser)[-1]
    check(arrow["kind"] == "arrow" and close(arrow["points"][1], world((19, 19, 20)), 0.5), f"an arrow by fingers: {arrow}")
    press(browser, "Text")
    browser.click(pixel(browser, (12, 25, 20)))
    browser.type("a lesion")
    check(marks(browser)[-1] == {"kind": "text", "points": marks(browser)[-1]["points"], "text": "a lesion"}, f"a text, typed: {marks(browser)[-1]}")
    check("a lesion" in browser.run("document.querySelector('#overlay').textContent"), "it is written in the picture")


def by_keys(browser):
    """The crosshair gives points where no pointer does."""
    browser.run("halflight.slices.moveTo([20, 10, 20])")
    browser.run("document.querySelector('[data-kind=ruler]').focus()")
    browser.run("document.activeElement.click()")
    browser.run("document.querySelector('[data-plane=axial] .slice-area').focus()")
    browser.key("Enter")
    for _ in range(5):
        browser.key("ArrowDown")
    browser.key("Enter")
    last = marks(browser)[-1]
    check(last["kind"] == "ruler" and abs(math.dist(*last["points"]) - 5) < 1e-6, f"five voxels by keys: {last}")


def in_the_picture(browser):
    """Points lie on what is seen, and stay there as the camera turns; other planes do not show them."""
    press(browser, "Ruler")
    x, y = center(browser, "#view")
    count = len(marks(browser))
    for n, place in enumerate(((x - 20, y + 25), (x + 30, y + 10))):
        browser.click(place)
        browser.wait("halflight.marking.unfinished !== null" if n == 0 else f"halflight.store.marks.length === {count + 1}")
    points = marks(browser)[-1]["points"]
    middle = world((19.5, 19.5, 19.5))
    for point, place in zip(points, ((x - 20, y + 25), (x + 30, y + 10))):
        check(14.5 < math.dist(point, middle) < 18, f"on the ball of 16: {point}")
        check(math.dist(in_picture(browser, point), place) < 1.5, "under the pointer")
    browser.run("document.getElementById('view').focus()")
    for _ in range(4):
        browser.key("ArrowLeft")
    check(marks(browser)[-1]["points"] == points and math.dist(in_picture(browser, points[0]), (x - 20, y + 25)) > 3, "they stand in the scene")
    rest(browser)
    before = in_picture(browser, points[0])
    browser.drag(before, [before[0] + 20, before[1] - 10])
    moved = marks(browser)[-1]["points"]
    check(moved[1] == points[1] and math.dist(in_picture(browser, moved[0]), [before[0] + 20, before[1] - 10]) < 1.5, "a point is dragged in the picture")
    camera = scene_of(browser)["camera"]
    check(browser.run(STAGE) == "final" and scene_of(browser)["camera"] == camera, "which moves no camera")


def axis_of_values(browser):
    """Numbers stand under the histogram's bars."""
    open_section(browser, "Transfer function")
    browser.run("""(() => { globalThis.said = []; const own = CanvasRenderingContext2D.prototype.fillText;
      CanvasRenderingContext2D.prototype.fillText = function (text, ...rest) { said.push([text, rest[0]]); return own.call(this, text, ...rest); }; })()""")
    set_control(browser, "Colours", "viridis", "change")
    said = browser.run("said")
    numbers = [float(text) for text, _ in said][:7]
    check(len(numbers) >= 4 and numbers[0] >= 0 and numbers[-1] <= 250 and all(b > a for a, b in zip(numbers, numbers[1:])), f"the axis: {said}")
    press_named(browser, "Undo")


def saved_blob(browser, text):
    """What a button of the panel saves, by its text."""
    browser.run("saved.length = 0")
    press(browser, text)
    browser.wait("saved.length === 1")
    return base64.b64decode(browser.run("""saved[0].arrayBuffer().then((bytes) => btoa(new Uint8Array(bytes).reduce((text, byte) => text + String.fromCharCode(byte), '')))"""))


def rendered(scene, name, *words):
    with open("saved.json", "wb") as file:
        file.write(scene)
    os.makedirs("rendered", exist_ok=True)  # beside its data a picture would name them relative to itself
    subprocess.run([PROGRAM, "render", "saved.json", *words, "-o", f"rendered/{name}", "--quiet"], check=True)
    with open(f"rendered/{name}", "rb") as file:
        return file.read()


def saved_pictures(browser):
    """A saved picture has the marks with the texts of the page, as `halflight render --marks` draws them; a box leaves them out."""
    # From farther away all texts lie in the picture.
    browser.run("(({ position, target, ...camera }) => halflight.store.setCamera({ ...camera, target, position: position.map((x, k) => target[k] + 2 * (x - target[k])) }))(halflight.store.scene.camera)")
    rest(browser)
    open_section(browser, "Save")
    browser.run("globalThis.saved = []; URL.createObjectURL = (blob) => { saved.push(blob); return 'blob:none'; }; HTMLAnchorElement.prototype.click = () => {}")
    check(browser.run("(({ checked, disabled }) => checked && !disabled)(document.getElementById('saved-marks'))"), "marks are saved as soon as there are any")
    scene = saved_blob(browser, "save scene")
    check(json.loads(scene)["marks"] == marks(browser), "the scene file has the marks")
    picture = saved_blob(browser, "save picture")
    check(picture == rendered(scene, "marks.png", "--marks"), "the picture is that of halflight render --marks")
    with Image.open(io.BytesIO(picture)) as image:
        check(json.loads(image.text["halflight:scene"])["marks"] == marks(browser), "the picture's own scene has the marks")
    command = browser.run("import('./export.js').then((m) => m.commandLine(halflight.store.file, 'a', { marks: true }))")
    check(" --marks <<" in command and '"marks": [' in command, "the copied command draws them")
    browser.run("document.getElementById('saved-marks').click()")
    plain = saved_blob(browser, "save picture")
    check(plain == rendered(scene, "plain.png") and plain != picture, "without the box they are left out")
    browser.run("document.getElementById('saved-marks').click()")
    shown = browser.run("[...document.querySelectorAll('#overlay .mark-text')].map((one) => one.textContent)")
    if shutil.which("pdftotext"):
        rendered(scene, "marks.pdf", "--marks")
        told = subprocess.run(["pdftotext", "rendered/marks.pdf", "-"], check=True, capture_output=True, text=True).stdout
        missing = [text for text in shown if not all(word in told for word in text.split())]  # words, as texts may overlap
        check(len(shown) >= 6 and missing == [], f"the page's texts {shown}, the PDF's {told!r}")
    # A ruler of the page, and the same one in the picture: in fractions of the sides.
    ruler = next(mark for mark in marks(browser) if mark["kind"] == "ruler")
    box = browser.run("(({ x, y, width, height }) => [x, y, width, height])(document.getElementById('view').getBoundingClientRect())")
    ends = [[(at - low) / side for at, low, side in zip(in_picture(browser, point), box[:2], box[2:])] for point in ruler["points"]]
    svg = rendered(scene, "marks.svg", "--marks").decode()
    width, height = (float(side) for side in re.search(r'viewBox="0 0 (\S+) (\S+)"', svg).groups())
    lines = [[float(n) for n in re.findall(r"-?[0-9.]+", d)] for d in re.findall(r'd="(M [^"A-KN-Z]*)"', svg)]
    expected = [side * at for end in ends for at, side in zip(end, (width, height))]
    check(any(len(line) == 4 and max(abs(a - b) for a, b in zip(line, expected)) < 0.1 for line in lines), f"the ruler {expected} among {lines[:8]}")
    # The scene file brings its marks along.
    with open("saved.json", "wb") as file:
        file.write(scene)
    with Viewer(PROGRAM, "saved.json") as other, kind(size=(900, 600)) as second:
        second.open(other.url)
        rest(second)
        check(marks(second) == marks(browser), "a viewer of the scene file shows its marks")
        check(second.run("[...document.querySelectorAll('#overlay .mark-text')].map((one) => one.textContent)") == shown, "with the same texts")
        check("marks" not in scene_of(second) and second.problems == [], f"{second.problems}")


kind = browser_named(sys.argv[2])
with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    need_viewer(PROGRAM)
    write_ball()
    with Viewer(PROGRAM, "ball.nrrd", "--sheet-spacing", "1", "--shadows", "hard") as viewer, kind(size=(1100, 760)) as page:
        page.open(viewer.url)
        rest(page)
        axis_of_values(page)
        page.run("document.getElementById('view').focus()")
        page.key("4")
        page.run(f"halflight.slices.moveTo({json.dumps(world((19, 19, 20)))})")
        open_section(page, "Measure")
        rest(page)
        page.wait("halflight.slices.shown('axial') && halflight.slices.readout")
        rulers(page)
        texts_of_rulers(page)
        angles(page)
        lines(page)
        arrows_and_texts(page)
        by_keys(page)
        in_the_picture(page)
        if SHOTS is not None:
            for theme in range(2):
                page.screenshot(f"{SHOTS}/marks-{theme}.png")
                page.run("document.getElementById('theme').click()")
        page.run(f"halflight.slices.moveTo({json.dumps(world((19, 19, 8)))})")
        page.run("new Promise((done) => setTimeout(done, 500))")
        shown = page.run("document.querySelectorAll('[data-plane=axial] .mark').length")
        check(shown < len(marks(page)), f"another plane shows fewer: {shown}")
        saved_pictures(page)
        check(page.problems == [], f"the console has errors: {page.problems}")
print(f"{checks.count} checks passed")
