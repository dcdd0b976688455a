#!/usr/bin/env python3
"""Fingers on the page, in a headless Chromium or Firefox, at the size of a phone: in slices a tap moves the crosshair, two fingers zoom and move nothing
else, one finger does what the panel chooses; lights, clip handles, points of a transfer function, keys of a film and the line between two compared
pictures follow the finger that holds them.

usage: touch.py PROGRAM chromium|firefox-esr
"""
import os
import sys
import tempfile

import numpy

import checks
from checks import check
from firefox import browser_named
from hands import PROGRAM, center, open_section, press_named, rest, scene_of, set_control
from viewer import Viewer, need_viewer

CURSOR = "halflight.slices.cursor"
WINDOW = "halflight.slices.window"
AXIAL = "halflight.slices.view('axial')"


def write_ball():
    """Values that fall from 255 in the middle to 0 at the border, 32 voxels wide."""
    k, j, i = numpy.mgrid[:32, :32, :32] - 15.5
    voxels = numpy.clip(255 * (1 - numpy.sqrt(i * i + j * j + k * k) / 16), 0, 255).astype("u1")
    with open("ball.nrrd", "wb") as file:
        file.write(b"NRRD0004\ntype: uint8\ndimension: 3\nsizes: 32 32 32\nencoding: raw\n\n" + voxels.tobytes())


def still(browser):
    rest(browser)
    browser.wait(f"{AXIAL}.project({CURSOR})?.[2] !== undefined && Math.abs({AXIAL}.project({CURSOR})[2]) < 1")


def place_of(browser, x, y):
    """The middle of the axial slice, moved by x and y pixels."""
    middle = center(browser, "[data-plane=axial] .slice-area")
    return [middle[0] + x, middle[1] + y]


def point_at(browser, place):
    """The point of the scene under a place of the axial slice."""
    return browser.run(f"""(() => {{ const view = {AXIAL}, box = view.area.getBoundingClientRect();
      return view.pointAt([{place[0]} - box.x, {place[1]} - box.y]); }})()""")


def near(a, b, most=0.01):
    return max(abs(x - y) for x, y in zip(a, b)) < most


def fingers_in_a_slice(browser):
    open_section(browser, "Slices")
    set_control(browser, "One slice", "")
    browser.wait("halflight.slices.shown('axial') !== null")
    still(browser)
    place = place_of(browser, 20, -15)
    expected = point_at(browser, [round(x) for x in place])
    browser.touch([[round(x) for x in place]])
    check(near(browser.run(CURSOR), expected), "a tap moves the crosshair to its place")
    place, end = [[round(x) for x in place_of(browser, *at)] for at in ((-20, 10), (15, 25))]
    expected = point_at(browser, end)
    browser.touch([place], [end])
    check(near(browser.run(CURSOR), expected), "a drag takes it along")
    still(browser)

    if browser.fingers > 1:
        cursor, window, span = browser.run(CURSOR), browser.run(WINDOW), "Math.hypot(...[0, 1].map((k) => a[k] - b[k]))"
        scale = f"(() => {{ const a = {AXIAL}.project([0, 0, 0]), b = {AXIAL}.project([10, 0, 0]); return {span}; }})()"
        before, (x, y) = browser.run(scale), place_of(browser, 0, 0)
        # The first finger goes down alone, and is the last that leaves, after it has moved on.
        browser.touch([[x - 20, y], None], [[x - 20, y], [x + 20, y]], [[x - 40, y], [x + 40, y]], [[x - 40, y], None], [[x - 5, y + 30], None])
        check(abs(browser.run(scale) / before - 2) < 0.1, f"two fingers twice as far apart: twice as large: {browser.run(scale) / before}")
        check(browser.run(CURSOR) == cursor, "and the crosshair stays where it is")
        check(browser.run(WINDOW) == window, "as do window and level")
        browser.run(f"{AXIAL}.reset()")

    cursor, window = browser.run(CURSOR), browser.run(WINDOW)
    x, y = [round(part) for part in place_of(browser, 0, 0)]
    set_control(browser, "Window", "")
    browser.touch([[x, y]], [[x + 40, y]], [[x + 60, y - 30]])
    changed = browser.run(WINDOW)
    check(changed[1] - changed[0] > window[1] - window[0] and sum(changed) > sum(window), f"window and level by one finger: {window} becomes {changed}")
    check(browser.run(CURSOR) == cursor, "which leaves the crosshair")
    browser.touch([[x + 12, y + 12]])
    check(not near(browser.run(CURSOR), cursor), "while a tap moves it as before")
    still(browser)

    set_control(browser, "Planes", "")
    layer = browser.run(CURSOR)
    browser.touch([[x, y]], [[x, y + 20]], [[x, y + 48]])
    moved = [abs(a - b) for a, b in zip(browser.run(CURSOR), layer)]
    check(sorted(round(part, 3) for part in moved) == [0, 0, 6], f"48 pixels go through six planes: {moved}")
    still(browser)

    set_control(browser, "Pan", "")
    before = browser.run(f"{AXIAL}.project([0, 0, 0])")
    browser.touch([[x, y]], [[x + 20, y]], [[x + 30, y + 10]])
    after = browser.run(f"{AXIAL}.project([0, 0, 0])")
    check(abs(after[0] - before[0] - 30) < 1.5 and abs(after[1] - before[1] - 10) < 1.5, f"one finger pans: {before} becomes {after}")
    browser.drag([x, y], [x - 30, y - 10])
    back = browser.run(f"{AXIAL}.project([0, 0, 0])")
    check(abs(back[0] - before[0]) < 1.5 and abs(back[1] - before[1]) < 1.5, "as does the left button")
    set_control(browser, "Crosshair", "")
    browser.run("halflight.store.setPage({ layout: 'picture' })")
    browser.wait("""halflight.store.scene.image.width === Math.max(document.getElementById('view').clientWidth, 16) &&
      halflight.store.scene.image.height === Math.max(document.getElementById('view').clientHeight, 16)""")
    rest(browser)


def fingers_on_handles(browser):
    light = "halflight.store.scene.lights[0].direction"
    before, camera = browser.run(light), scene_of(browser)["camera"]
    x, y = [round(part) for part in center(browser, ".light-dot")]
    browser.touch([[x, y]], [[x + 15, y + 5]], [[x + 30, y + 10]])
    check(browser.run(light) != before and scene_of(browser)["camera"] == camera, "a finger moves a light, and no camera")
    if browser.fingers > 1:
        lit = browser.run(light)
        x, y = [round(part) for part in center(browser, ".light-dot")]
        browser.touch([[x, y], None], [[x, y], [x + 5, y + 60]], [[x, y], [x + 60, y + 90]])
        check(near(browser.run(light), lit, 1e-6), "a second finger does not move the light that the first one holds")
    rest(browser)
    open_section(browser, "Volume")
    browser.wait("document.querySelector('.clip-handle').getBoundingClientRect().width > 5")
    x, y = [round(part) for part in center(browser, ".clip-handle.axis-0:nth-child(2)")]
    camera = scene_of(browser)["camera"]
    browser.touch([[x, y]], [[x - 20, y]], [[x - 60, y - 10]])
    scene = scene_of(browser)
    check("clip" in scene["volumes"][0] and scene["camera"] == camera, "a finger moves a face of the clip box")
    press_named(browser, "Undo")
    check("clip" not in scene_of(browser)["volumes"][0], "in one step of the history")


def finger_on_the_function(browser):
    """A finger is not as sharp as a mouse: it takes hold of a point that is 15 pixels away."""
    open_section(browser, "Transfer function")
    browser.run("document.querySelector('canvas.function').scrollIntoView({ block: 'center' })")
    points = "halflight.store.scene.volumes[0].transfer_function.opacity"
    count = browser.run(f"{points}.length")
    n = browser.run(f"{points}.findIndex(([, opacity]) => opacity > 0.2)")
    x, y = browser.run(f"""(() => {{ const box = document.querySelector('canvas.function').getBoundingClientRect(), [value, opacity] = {points}[{n}];
      const [low, high] = halflight.start.volumes[0].range; // the drawing has margins of 9 pixels and is 180 high; below it are an axis and the colours
      return [box.x + 9 + (value - low) / (high - low) * (box.width - 18), box.y + 9 + (1 - opacity) * (180 - 16 - 20 - 18)]; }})()""")
    before = browser.run(f"{points}[{n}][1]")
    browser.touch([[round(x), round(y + 14)]], [[round(x), round(y + 30)]], [[round(x), round(y + 60)]])
    check(browser.run(f"{points}.length") == count, "no point is added beside it")
    check(browser.run(f"{points}[{n}][1]") < before - 0.2, "the point follows the finger")
    press_named(browser, "Undo")


def finger_on_the_timeline(browser):
    open_section(browser, "Film")
    browser.run("document.querySelector('.key-here').closest('details').open = true")
    browser.run("[...document.querySelectorAll('.key-here')].find((b) => b.getAttribute('aria-label') === 'Add a key of Intensity').click()")
    keys = "[...document.querySelectorAll('.timeline .key')].map((key) => +key.dataset.frame)"
    browser.wait(f"{keys}.length > 0")
    before = browser.run(keys)
    browser.run("document.querySelector('.timeline .key').scrollIntoView({ block: 'nearest' })")
    x, y = [round(part) for part in center(browser, ".timeline .key")]
    browser.touch([[x, y]], [[x + 20, y]], [[x + 60, y]], [[x + 90, y]])
    check(browser.run(keys)[0] > before[0], f"a finger drags a key: {before} becomes {browser.run(keys)}")
    # A key that is set while the film plays is a step of the history as any other.
    browser.run("[...document.querySelectorAll('.timeline button')].find((b) => b.textContent === 'play').click()")
    browser.wait("[...document.querySelectorAll('.timeline button')].some((b) => b.textContent === 'stop playing')")
    browser.run("[...document.querySelectorAll('.key-here')].find((b) => b.getAttribute('aria-label') === 'Add a key of Ambient').click()")
    browser.wait(f"{keys}.length === {len(before) + 1}")
    browser.run("[...document.querySelectorAll('.timeline button')].filter((b) => b.textContent === 'stop playing').forEach((b) => b.click())")
    press_named(browser, "Undo")
    check(browser.run(f"{keys}.length") == len(before), "undo takes away the key that was set while the film played")


def finger_on_the_divider(browser):
    browser.run("document.activeElement.blur()")
    browser.key("a")
    browser.wait("!document.querySelector('.divider').hidden && !document.querySelector('.compared').hidden")
    at = "+document.querySelector('.divider').getAttribute('aria-valuenow')"
    x, y = [round(part) for part in center(browser, ".divider")]
    browser.touch([[x, y]], [[x + 20, y]], [[x + 60, y]])
    check(browser.run(at) > 55, f"a finger drags the line between two pictures: {browser.run(at)}")


kind = browser_named(sys.argv[2])
with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    need_viewer(PROGRAM)
    write_ball()
    with Viewer(PROGRAM, "ball.nrrd", "--shadows", "hard") as viewer, kind(size=(390, 844)) as page:
        page.open(viewer.url)
        rest(page)
        fingers_in_a_slice(page)
        fingers_on_handles(page)
        finger_on_the_function(page)
        finger_on_the_timeline(page)
        finger_on_the_divider(page)
        check(page.problems == [], f"the console has errors: {page.problems}")
print(f"{checks.count} checks passed")
