#!/usr/bin/env python3
"""Slices on the page, in a headless Chromium or Firefox: planes lie as radiologists look at them, the crosshair tells the file's values, though
the picture shows smoothed ones, and hands, fingers and keys move it; labels, isolines and slabs; a click in the picture puts the crosshair on what is seen.

usage: slices.py PROGRAM chromium|firefox-esr [FOLDER]
FOLDER: where screenshots are kept; without it they are not made.
"""
import json
import math
import os
import subprocess
import sys
import tempfile

import numpy

import checks
from checks import check
from firefox import browser_named
from hands import PROGRAM, center, open_section, press_named, rest, scene_of, set_control
from viewer import Viewer, need_viewer

SIDES = (40, 50, 30)  # i, j, k
SPACING = (1.5, 1.0, 2.0)
FIRST = (-30.0, 20.0, -25.0)  # of voxel 0, 0, 0, in right, front, head; j runs to the back
SHOTS = os.path.abspath(sys.argv[3]) if len(sys.argv) > 3 else None


def write_volumes():
    """A head of a kind: a ball of values that differ from voxel to voxel, with a bright spot at its left. Right-anterior-superior, j to the back.
    Labels of the same grid: 3 in a box around the spot."""
    i, j, k = numpy.mgrid[:SIDES[0], :SIDES[1], :SIDES[2]]
    far = numpy.sqrt((1.5 * (i - 20)) ** 2 + (j - 25.0) ** 2 + (2 * (k - 15)) ** 2)
    voxels = numpy.where(far < 22, 1000 + (7 * i + 11 * j + 13 * k) % 200, -1000).astype("<i2")
    spot = (slice(10, 13), slice(24, 27), slice(14, 17))
    voxels[spot] = 3000
    labels = numpy.zeros(SIDES, "u1")
    labels[spot] = 3
    for name, data, kind in (("head", voxels, "int16"), ("organs", labels, "uint8")):
        header = (f"NRRD0004\ntype: {kind}\ndimension: 3\nspace: right-anterior-superior\nsizes: {SIDES[0]} {SIDES[1]} {SIDES[2]}\n"
                  f"space directions: ({SPACING[0]},0,0) (0,-{SPACING[1]},0) (0,0,{SPACING[2]})\nspace origin: ({FIRST[0]},{FIRST[1]},{FIRST[2]})\n"
                  f"space units: \"mm\" \"mm\" \"mm\"\nencoding: raw\nendian: little\n\n")
        with open(f"{name}.nrrd", "wb") as file:
            file.write(header.encode() + data.tobytes(order="F"))
    return voxels


def world(voxel):
    return [FIRST[0] + SPACING[0] * voxel[0], FIRST[1] - SPACING[1] * voxel[1], FIRST[2] + SPACING[2] * voxel[2]]


def area(name):
    return f"[data-plane={name}] .slice-area"


def still(browser):
    """The slices and the readout are those of the crosshair."""
    rest(browser)
    browser.run("new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))")  # the planes have their sizes
    browser.wait("!halflight.slices.isBusy")


def readout(browser):
    still(browser)
    return json.loads(browser.run("JSON.stringify(halflight.slices.readout)"))


def move(browser, voxel):
    browser.run(f"halflight.slices.moveTo({json.dumps(world(voxel))})")


def pixel(browser, name, voxel):
    """Where a voxel is on the screen, in the plane of this name."""
    return browser.run(f"""(() => {{ const view = halflight.slices.view({json.dumps(name)}), [x, y] = view.project({json.dumps(world(voxel))});
      const box = view.area.getBoundingClientRect(); return [box.x + x, box.y + y]; }})()""")


def color(browser, name, voxel):
    """The colour of a voxel in the slice's canvas."""
    return browser.run(f"""(() => {{ const view = halflight.slices.view({json.dumps(name)}), [x, y] = view.project({json.dumps(world(voxel))});
      return [...view.area.querySelector('canvas').getContext('2d').getImageData(Math.round(x), Math.round(y), 1, 1).data]; }})()""")


def shot(browser, name):
    if SHOTS is not None:
        for _ in range(2):
            theme = browser.run("document.querySelector('.viewer').dataset.theme")
            browser.screenshot(f"{SHOTS}/{name}-{theme}.png")
            browser.run("document.getElementById('theme').click()")


def layouts(browser):
    open_section(browser, "Slices")
    check(browser.run("[...document.querySelectorAll('.slice')].every((s) => s.hidden)"), "the picture alone at first")
    wide = browser.run("halflight.store.scene.image.width")
    set_control(browser, "Four-up", "")
    still(browser)
    shown = browser.run("[...document.querySelectorAll('.slice')].filter((s) => !s.hidden).map((s) => s.querySelector('figcaption').textContent)")
    check(shown == ["Axial", "Coronal", "Sagittal"], f"four-up: {shown}")
    check(browser.run("halflight.store.scene.image.width") < 0.55 * wide, "the picture makes room")
    boxes = browser.run("""[...document.querySelectorAll('#view, .slice')].map((e) => { const b = e.getBoundingClientRect(); return [b.x, b.y, b.width, b.height]; })""")
    check(len({(b[2] // 3, b[3] // 3) for b in boxes}) == 1, f"four of one size: {boxes}")
    shot(browser, "four")
    browser.run("document.getElementById('view').focus()")
    browser.key("2")
    still(browser)
    check(browser.run("[...document.querySelectorAll('.slice')].filter((s) => !s.hidden).length") == 1, "one slice beside the picture")
    set_control(browser, "Plane", "sagittal", "change")
    check(browser.run("document.querySelector('.slice:not([hidden]) figcaption').textContent") == "Sagittal", "of the plane that is chosen")
    browser.run("document.getElementById('view').focus()")
    browser.key("1")
    pressed = "document.getElementById('slices').getAttribute('aria-pressed')"
    check(browser.run("halflight.slices.layout") == "picture" and browser.run(pressed) == "false", "1: the picture alone")
    browser.click(center(browser, "#slices"))
    check(browser.run("halflight.slices.layout") == "four" and browser.run(pressed) == "true", "a button in the head shows the slices")
    browser.click(center(browser, "#slices"))
    check(browser.run("halflight.slices.layout") == "picture", "and hides them")
    browser.key("4")
    still(browser)


def as_radiologists_look(browser, voxels):
    """The spot at the left of the body lies at the right of the axial and the coronal plane; in front is above, and left in the sagittal one."""
    spot = (11, 25, 15)
    move(browser, spot)
    found = readout(browser)
    check(found["voxel"] == list(spot) and found["value"] == 3000, f"the spot: {found}")
    for name in ("axial", "coronal"):
        x, middle = pixel(browser, name, spot)[0], center(browser, area(name))[0]
        check(x > middle + 20, f"{name}: the left of the body is at the right")
    check(pixel(browser, "axial", (20, 5, 15))[1] < center(browser, area("axial"))[1] - 20, "axial: the front is above")
    check(pixel(browser, "coronal", (20, 25, 28))[1] < center(browser, area("coronal"))[1] - 20, "coronal: the head is above")
    check(pixel(browser, "sagittal", (11, 5, 15))[0] < center(browser, area("sagittal"))[0] - 20, "sagittal: the front is at the left")
    letters = browser.run(f"[...document.querySelector('{area('axial')}').querySelectorAll('.edge')].map((e) => e.textContent)")
    check(letters == ["R", "L", "A", "P"], f"the axial plane's letters: {letters}")
    crossed = browser.run("""[...document.querySelectorAll('.slice:not([hidden])')].flatMap((slice) => {
      const [, y, x] = slice.querySelector('.crosshair').getAttribute('d').match(/^M0 ([^H]+)H.*M([^ ]+) 0V/);
      return [...slice.querySelectorAll('.edge')].filter((letter) => { const b = letter.getBBox(); return (b.x < x && x < b.x + b.width) || (b.y < y && y < b.y + b.height); }).map((letter) => letter.textContent); })""")
    check(crossed == [], f"the crosshair runs through no letter: {crossed}")
    facts = browser.run("[...document.querySelectorAll('.facts')].map((p) => p.textContent).find((text) => text.includes('voxels of'))")
    check(", int16, " in facts and "values -1000 to 3000" in facts, f"the panel tells the file's values: {facts}")
    long, tall = pixel(browser, "axial", (39, 0, 15)), pixel(browser, "axial", (0, 49, 15))
    check(abs(abs(long[0] - tall[0]) / abs(long[1] - tall[1]) - 39 * 1.5 / 49) < 0.01, "voxels are as wide as they are")
    for name in ("axial", "coronal", "sagittal"):
        check(color(browser, name, spot)[:3] == [255, 255, 255] or color(browser, name, spot)[0] > 200, f"{name}: the spot is bright: {color(browser, name, spot)}")
    check(browser.run("document.querySelector('output.value').textContent") == "3000 · bone", "its value and its label")
    place = browser.run("document.querySelector('#panels output.facts').textContent")
    right, front, head = world(spot)
    check(place.startswith(f"L {-right:.1f} P {-front:.1f} S {head:.1f}"), f"its place: {place}")


def hands(browser, voxels):
    """Clicks, drags, wheel, keys and fingers: the crosshair's value is always the file's."""
    def agrees(what):
        found = readout(browser)
        check(found["inside"] and found["value"] == voxels[tuple(found["voxel"])], f"{what}: {found}")
        return found["voxel"]

    move(browser, (20, 25, 15))
    browser.click(pixel(browser, "axial", (28, 31, 15)))
    check(agrees("a click") == [28, 31, 15], "a click in the axial plane")
    browser.drag(pixel(browser, "coronal", (28, 31, 15)), pixel(browser, "coronal", (17, 31, 12)))
    check(agrees("a drag") == [17, 31, 12], "a drag in the coronal plane")
    x, y = center(browser, area("axial"))
    browser.wheel(x, y, 120)
    check(agrees("the wheel") in ([17, 31, 15], [17, 31, 9]), "the wheel goes through the planes")
    browser.run(f"document.querySelector('{area('sagittal')}').focus()")
    move(browser, (17, 31, 12))
    for key, expected in (("ArrowLeft", [17, 30, 12]), ("ArrowUp", [17, 30, 13]), ("PageUp", [18, 30, 13]), ("PageDown", [17, 30, 13]), ("ArrowRight", [17, 31, 13]), ("ArrowDown", [17, 31, 12])):
        browser.key(key)
        check(agrees(key) == expected, f"{key} leads to {readout(browser)['voxel']}")
    camera = scene_of(browser)["camera"]
    place = pixel(browser, "axial", (25, 20, 12))
    browser.touch([place])
    check(agrees("a finger") == [25, 20, 12], "a finger in the axial plane")
    before = pixel(browser, "axial", (0, 0, 12))
    if browser.fingers > 1:
        browser.touch([[x - 30, y], [x + 30, y]], [[x - 60, y], [x + 60, y]])
    else:
        browser.run("halflight.slices.view('axial').area.focus()")
        for _ in range(3):
            browser.key("+")
    after = pixel(browser, "axial", (0, 0, 12))
    check(math.hypot(after[0] - x, after[1] - y) > 1.5 * math.hypot(before[0] - x, before[1] - y), "two fingers apart: larger")
    browser.run(f"document.querySelector('{area('axial')}').focus()")
    browser.key("Home")
    check(max(abs(a - b) for a, b in zip(pixel(browser, "axial", (0, 0, 12)), before)) < 0.01, "Home: as it was")
    browser.drag([x, y], [x + 40, y + 25], modifiers=8)
    moved = pixel(browser, "axial", (0, 0, 12))
    check(abs(moved[0] - before[0] - 40) < 1 and abs(moved[1] - before[1] - 25) < 1, "shift + drag pans")
    under = [round(x) + 50, round(y) + 20]
    at = f"""(() => {{ const view = halflight.slices.view('axial'), box = view.area.getBoundingClientRect(); return view.pointAt([{under[0]} - box.x, {under[1]} - box.y]); }})()"""
    place = browser.run(at)
    browser.wheel(*under, -100, modifiers=2)
    check(max(abs(a - b) for a, b in zip(browser.run(at), place)) < 1e-6, "ctrl + wheel zooms to the cursor")
    browser.key("Home")
    window = browser.run("halflight.slices.window")
    browser.drag([x, y], [x + 60, y - 30], button="right")
    changed = browser.run("halflight.slices.window")
    check(changed[1] - changed[0] > window[1] - window[0] and sum(changed) > sum(window), f"a right drag: {window} becomes {changed}")
    press_named(browser, "Undo")
    check(browser.run("halflight.slices.window") == window, "undo brings back window and level")
    press_named(browser, "Redo")
    check(browser.run("halflight.slices.window") == changed, "redo the change")
    browser.run("""document.querySelector('button[title="Window and level as at first"]').click()""")
    automatic = browser.run("halflight.slices.window")
    check(automatic == window, f"auto: the window as it was: {window}, {automatic}")
    check(scene_of(browser)["camera"] == camera, "no hand on a slice moves the camera")


def window_and_level(browser):
    """Greys run from one end of the window to the other."""
    browser.run("halflight.slices.window = [1000, 1200]")
    move(browser, (20, 25, 15))
    still(browser)
    for voxel in ((22, 28, 15), (15, 20, 15), (24, 21, 15)):
        value = 1000 + (7 * voxel[0] + 11 * voxel[1] + 13 * voxel[2]) % 200
        expected = 255 * (value - 1000) / 200
        check(abs(color(browser, "axial", voxel)[0] - expected) <= 1, f"the grey of {value}: {color(browser, 'axial', voxel)}, not {expected}")
    browser.run("halflight.slices.window = null")


def slabs(browser, voxels):
    """A thick plane shows the greatest of its layers; the readout stays the voxel's own."""
    move(browser, (20, 25, 10))
    still(browser)
    dark = color(browser, "axial", (11, 25, 10))
    browser.run("halflight.store.setPage({ thickness: 24 })")
    still(browser)
    check(dark[0] < 200 < color(browser, "axial", (11, 25, 10))[0], f"the spot is 5 slices away: {dark}, {color(browser, 'axial', (11, 25, 10))}")
    check(readout(browser)["value"] == voxels[20, 25, 10], "the value at the crosshair")
    set_control(browser, "Slab shows", "minimum", "change", section="Slices")
    still(browser)
    check(color(browser, "axial", (11, 25, 10))[0] < 200, "the least of the layers is no spot")
    browser.run("halflight.store.setPage({ thickness: 0, blend: 'maximum' })")


def labels_and_isolines(browser):
    move(browser, (11, 25, 15))
    still(browser)
    red, green, blue, _ = color(browser, "axial", (11, 25, 15))
    check(red > blue + 60, f"the label is red over the grey: {red} {green} {blue}")
    set_control(browser, "Labels", "", section="Slices")
    still(browser)
    red, green, blue, _ = color(browser, "axial", (11, 25, 15))
    check(red == green == blue, "without labels: grey")
    set_control(browser, "Labels", "", section="Slices")
    # The isoline half way up the ball's edge is a circle of its radius, in the world.
    browser.run("halflight.store.changeVolume(0, 'iso', (v) => ({ ...v, iso: [{ value: 0, color: [0, 1, 0], opacity: 1 }] }))")
    move(browser, (20, 25, 15))
    still(browser)
    radii = browser.run("""import('./contours.js').then(({ contourPieces }) => { const { plane, values } = halflight.slices.shown('axial');
      const pieces = contourPieces(values, plane.width, plane.height, 0), found = [];
      for (let n = 0; n < pieces.length; n += 2) found.push(Math.hypot(1.5 * (pieces[n] - 19), pieces[n + 1] - 25));
      return found; })""")
    check(len(radii) > 100 and all(20 < radius < 23 for radius in radii), f"a circle of 22: {min(radii)} to {max(radii)}")
    green = browser.run("""(() => { const canvas = document.querySelector('[data-plane=axial] canvas'), { data } = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height);
      let count = 0; for (let n = 0; n < data.length; n += 4) count += data[n + 1] > 200 && data[n] < 60 && data[n + 2] < 60; return count; })()""")
    check(green > 50, f"the isoline is drawn: {green} green pixels")
    # It lies where the picture has its isosurface, which is one of the smoothed values: they make the spot less bright.
    value, pictured = browser.run("(({ values, pictured }) => [values, pictured].map((all) => Math.max(...all)))(halflight.slices.shown('axial'))")
    check(value == 3000 and 2500 < pictured < 2900, f"isolines are of smoothed values: {value} {pictured}")
    shot(browser, "labels")
    for title in ("Isosurfaces", "Transfer function"):
        open_section(browser, title)
        told = browser.run("document.querySelector('details[open] .smoothed:not([hidden])')?.textContent")
        check(told is not None and told.endswith(" to 3000."), f"{title}: the range of the file's values is told beside that of the smoothed ones: {told}")
    browser.run("halflight.store.undo()")


def reds(browser, voxels):
    """How bright the voxels of the axial plane are, wherever the scene puts the volume: the red of the slice's canvas at each of them."""
    return browser.run(f"""import('./sections.js').then(({{ pointAt }}) => {{ const view = halflight.slices.view('axial'), {{ grid, transform }} = halflight.slices.source;
      const canvas = view.area.querySelector('canvas').getContext('2d');
      return {json.dumps(voxels)}.map((voxel) => {{ const [x, y] = view.project(pointAt(grid, transform, voxel)); return canvas.getImageData(Math.round(x), Math.round(y), 1, 1).data[0]; }}); }})""")


def line_pixels(browser):
    return browser.run("""(() => { const canvas = document.querySelector('[data-plane=axial] canvas'), { data } = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height);
      let count = 0; for (let n = 0; n < data.length; n += 4) count += data[n] === 255 && data[n + 1] === 122 && data[n + 2] === 102; return count; })()""")


def is_inside(cut, point):
    """How far a point lies inside a cut's shape, for planes and spheres in millimetres."""
    if cut["type"] == "plane":
        normal = numpy.array(cut["normal"])
        return numpy.dot(numpy.subtract(point, cut["point"]), normal) / numpy.linalg.norm(normal)
    if cut["type"] == "sphere":
        return cut["radius"] - math.dist(point, cut["center"])
    return min(min(high - x, x - low) for low, high, x in zip(cut["min"], cut["max"], point))


def cuts_in_slices(browser):
    """What cuts and clip boxes remove is dimmed, with a line at its border: for each shape, in the lengths of the file and in those of the scene."""
    browser.run("document.getElementById('view').focus()")
    browser.key("4")
    move(browser, (20, 25, 15))
    browser.run("halflight.slices.window = [0, 1200]")
    still(browser)
    voxels = [[i, j, 15] for i in range(12, 30, 3) for j in range(12, 40, 3) if (1.5 * (i - 20)) ** 2 + (j - 25) ** 2 < 17**2]
    bright, middle = reds(browser, voxels), world((20, 25, 15))
    check(min(bright) > 150 and line_pixels(browser) == 0, f"nothing is cut: {min(bright)}")
    plane = {"type": "plane", "point": middle, "normal": [1, -0.7, 0.2]}
    box = {"type": "box", "min": [middle[0] - 9, middle[1] - 30, middle[2] - 4], "max": [middle[0] + 7, middle[1] + 5, middle[2] + 6]}
    sphere = {"type": "sphere", "center": [middle[0] + 5, middle[1] + 4, middle[2] + 6], "radius": 12}
    turn = {"scale": [2, 2, 2], "rotate": {"axis": [1, 2, 3], "angle_deg": 40}, "translate": [5, -7, 9]}
    # { cuts of the volume, its clip box, cuts of the scene, its transform }
    scenes = [([plane], None, [], None), ([box], None, [], None), ([sphere | {"keep": "inside"}], None, [], None), ([], box, [], None), ([], None, [sphere], None),
              ([plane, sphere], None, [box], None), ([sphere], box, [], turn), ([plane | {"world": True}], None, [sphere | {"keep": "inside", "radius": 40}], turn)]
    place = "import('./boxes.js').then((m) => %s.map((point) => m.placed(point, %s)))"
    for own, clip, of_scene, transform in scenes:
        changed = {"cuts": own} | ({"clip": {"min": clip["min"], "max": clip["max"]}} if clip else {}) | ({"transform": transform} if transform else {})
        browser.run(f"""halflight.store.change('cuts of a test', ({{ volumes: [{{ cuts: _, clip: __, ...first }}, ...others], cuts: ___, ...scene }}) =>
          ({{ ...scene, cuts: {json.dumps(of_scene)}, volumes: [{{ ...first, ...{json.dumps(changed)} }}, ...others] }}))""")
        places = browser.run(place % (json.dumps([world(voxel) for voxel in voxels]), json.dumps(transform or {})))
        browser.run(f"halflight.slices.moveTo({json.dumps(browser.run(place % (json.dumps([middle]), json.dumps(transform or {})))[0])})")
        still(browser)
        now, dimmed, left, border = reds(browser, voxels), 0, 0, line_pixels(browser)
        for voxel, there, before, after in zip(voxels, places, bright, now):
            deep = [(is_inside(cut, there if cut.get("world") else world(voxel)), cut.get("keep")) for cut in own]
            deep += [(is_inside(shape, world(voxel)), "inside") for shape in [clip] if shape] + [(is_inside(cut, there), cut.get("keep")) for cut in of_scene]
            if min(abs(away) for away, _ in deep) < (2.5 if transform else 1.6):
                continue  # at the border lies the line
            gone = any((away > 0) != (keep == "inside") for away, keep in deep)
            check(after < 0.5 * before if gone else after == before, f"{own} {clip} {of_scene} {transform}: {voxel} has {after}, before {before}, gone: {gone}")
            dimmed, left = dimmed + gone, left + (not gone)
        check(dimmed >= 3 and left >= 3 and border > 60, f"{own} {clip} {of_scene}: {dimmed} voxels dimmed, {left} left, {border} pixels of the line")
        shot(browser, f"cuts-{scenes.index((own, clip, of_scene, transform))}")
        browser.run("halflight.store.undo()")
    browser.run("halflight.slices.window = null")
    move(browser, (20, 25, 15))
    still(browser)


def clicks_in_the_picture(browser):
    """The crosshair goes to the ball's surface under the cursor, or stays where nothing is seen; a drag only turns."""
    move(browser, (20, 25, 15))
    still(browser)
    x, y = center(browser, "#view")
    middle = world((20, 25, 15))
    for step in ((0, 0), (35, 20), (-30, 25)):
        browser.click((x + step[0], y + step[1]))
        browser.wait(f"Math.hypot(...halflight.slices.cursor.map((x, k) => x - {json.dumps(middle)}[k])) > 1")
        still(browser)
        cursor = browser.run("halflight.slices.cursor")
        far = math.dist(cursor, middle)
        check(19.5 < far < 23.5, f"a click {step}: on the ball of 22, {far} from its middle")
        screen = browser.run("import('./camera.js').then((m) => m.projector(halflight.store.scene.camera, document.getElementById('view').clientWidth, document.getElementById('view').clientHeight)(halflight.slices.cursor))")
        box = browser.run("(({ x, y }) => [x, y])(document.getElementById('view').getBoundingClientRect())")
        check(math.dist([box[0] + screen[0], box[1] + screen[1]], [x + step[0], y + step[1]]) < 1.5, f"under the cursor: {screen}")
        move(browser, (20, 25, 15))
        still(browser)
    before = browser.run("halflight.slices.cursor")
    browser.drag([x - 60, y + 40], [x - 20, y + 55])
    still(browser)
    box = browser.run("(({ x, y }) => [x, y])(document.getElementById('view').getBoundingClientRect())")
    browser.click((box[0] + 8, box[1] + 8))
    browser.wait("/Nothing is seen/.test(document.getElementById('message').textContent)")
    check(browser.run("halflight.slices.cursor") == before, "a drag, and a click beside the ball, leave the crosshair")


def oblique(browser):
    """The oblique plane lies as the picture, and keeps so when it is told to."""
    move(browser, (11, 25, 15))
    browser.run("document.getElementById('view').focus()")
    browser.key("2")
    set_control(browser, "Plane", "oblique", "change")
    browser.wait("halflight.slices.shown('oblique') !== null")
    still(browser)
    at = "import('./sections.js').then((m) => m.sampleAt(halflight.slices.shown('oblique').plane, halflight.slices.source, halflight.slices.cursor))"
    column, row, layer = browser.run(at)
    check(abs(layer) < 1e-9, "it goes through the crosshair")
    value = browser.run(f"(({{ plane, values }}) => values[Math.round({row}) * plane.width + Math.round({column})])(halflight.slices.shown('oblique'))")
    check(value > 2500, f"and shows the spot there: {value}")
    across = browser.run("""Promise.all([import('./sections.js'), import('./camera.js'), import('./vector.js')]).then(([s, c, v]) => {
      const { plane } = halflight.slices.shown('oblique'), point = (x, y) => s.samplePoint(plane, halflight.slices.source, x, y), frame = c.axes(halflight.store.scene.camera);
      const step = v.subtract(point(1, 0), point(0, 0)); return [v.dot(step, frame.right) / v.length(step), v.dot(step, frame.towards)]; })""")
    check(abs(across[0] - 1) < 1e-9 and abs(across[1]) < 1e-9, f"its rows are the picture's: {across}")
    shot(browser, "oblique")
    set_control(browser, "Follows the picture", "")
    before = browser.run("JSON.stringify(halflight.slices.shown('oblique').plane)")
    browser.key("x")
    still(browser)
    check(browser.run("JSON.stringify(halflight.slices.shown('oblique').plane)") == before, "it keeps its place")


kind = browser_named(sys.argv[2])
with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    need_viewer(PROGRAM)
    values = write_volumes()
    with open("tf.json", "w", encoding="utf-8") as steep:
        json.dump({"opacity": [[0, 0], [500, 1]], "color": [[0, 0.8, 0.7, 0.6]], "unit_distance": 0.5}, steep)
    made = subprocess.run([PROGRAM, "render", "head.nrrd", "--tf", "tf.json", "--mask", "organs.nrrd", "--show", "3=red,rest:1", "--sheet-spacing", "1", "--smooth", "0.8", "--shadows", "hard", "--print-scene"],
                          capture_output=True, text=True, check=True)
    scene = json.loads(made.stdout)
    scene["volumes"][0]["mask"]["labels"][0]["name"] = "bone"
    with open("head.json", "w", encoding="utf-8") as file:
        json.dump(scene, file)
    with Viewer(PROGRAM, "head.json") as viewer, kind(size=(1100, 760)) as page:
        page.open(viewer.url)
        rest(page)
        layouts(page)
        as_radiologists_look(page, values)
        hands(page, values)
        window_and_level(page)
        slabs(page, values)
        labels_and_isolines(page)
        clicks_in_the_picture(page)
        cuts_in_slices(page)
        oblique(page)
        check(page.problems == [], f"the console has errors: {page.problems}")
print(f"{checks.count} checks passed")
