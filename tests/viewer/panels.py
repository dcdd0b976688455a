#!/usr/bin/env python3
"""The page's panels of sky, isosurfaces, scattering, cuts and labels in a headless Chromium: each control changes the picture at once, is
undone, and leads to what `halflight render` makes of the exported scene.

usage: panels.py PROGRAM
"""
import json
import os
import shutil
import sys
import tempfile

import checks
from browser import Browser
from checks import check
from hands import (PROGRAM, STAGE, center, changes, copied_command, equals_render, open_section, press_named, rest, scene_of, set_control,
                   undone)
from viewer import Viewer, need_viewer

SIZE = (720, 420)  # of the window: the picture is small, and so quick


def sky(browser):
    open_section(browser, "Sky")
    check(browser.run("document.querySelector('.sky-handle').getBoundingClientRect().width") == 0, "no sky, no ring")
    changes(browser, "even sky", lambda: set_control(browser, "Even", "", section="Sky"), "sky")
    first = scene_of(browser)["sky"]
    changes(browser, "strength", lambda: set_control(browser, "Strength", 1.5, section="Sky"), "sky")
    undone(browser, "sky", first, "strength")
    changes(browser, "gradient", lambda: set_control(browser, "Gradient", "", section="Sky"), "sky")
    changes(browser, "ground", lambda: set_control(browser, "Ground", "#ff2000", section="Sky"), "sky")
    changes(browser, "horizon", lambda: set_control(browser, "Horizon", "#2040ff", section="Sky"), "sky")
    changes(browser, "dark ground", lambda: set_control(browser, "Dark below the horizon", "", section="Sky"), "sky")
    changes(browser, "up", lambda: set_control(browser, "Up", "+x", "change", section="Sky"), "sky")
    check(scene_of(browser)["sky"]["up"] == [1, 0, 0], "up is the list's axis")
    at = center(browser, ".sky-handle")
    changes(browser, "zenith drag", lambda: browser.drag(at, [at[0] - 40, at[1] + 15]), "sky")
    up = scene_of(browser)["sky"]["up"]
    browser.run("document.querySelector('.sky-handle').focus()")
    changes(browser, "zenith by keys", lambda: [browser.key("ArrowLeft") for _ in range(8)], "sky")
    check(scene_of(browser)["sky"]["up"] != up and abs(sum(x * x for x in scene_of(browser)["sky"]["up"]) - 1) < 1e-12, "up is of length 1")
    equals_render(browser, "sky")
    changes(browser, "no sky", lambda: set_control(browser, "None", "", section="Sky"), "sky")
    check("sky" not in scene_of(browser), "a scene without sky has no such key")


def sky_image(browser):
    """The rotation of an environment image by the slider, the ring and its keys."""
    open_section(browser, "Sky")
    changes(browser, "rotation", lambda: set_control(browser, "Rotation", 120, section="Sky"), "sky")
    at = center(browser, ".sky-handle + .sky-handle")
    changes(browser, "ring drag", lambda: browser.drag(at, [at[0] + 50, at[1]]), "sky")
    turned = scene_of(browser)["sky"]["rotation_deg"]
    check(turned != 120 and -180 <= turned <= 180, f"the ring turns the image: {turned}")
    browser.run("document.querySelector('.sky-handle + .sky-handle').focus()")
    changes(browser, "ring by keys", lambda: [browser.key("ArrowRight") for _ in range(5)], "sky")
    check(abs((scene_of(browser)["sky"]["rotation_deg"] - turned) % 360 - 15) < 1e-9, "a key turns by three degrees")
    changes(browser, "gradient instead", lambda: set_control(browser, "Gradient", "", section="Sky"), "sky")
    changes(browser, "image again", lambda: set_control(browser, "Image", "", section="Sky"), "sky")
    check(scene_of(browser)["sky"]["file"].endswith("sky.png"), "the image comes back")
    equals_render(browser, "sky-image")


def surfaces(browser):
    open_section(browser, "Isosurfaces")
    before = scene_of(browser)["volumes"]
    changes(browser, "a first surface", lambda: press_named(browser, "Add: isosurface"), "volumes")
    volume = scene_of(browser)["volumes"][0]
    check(len(volume["iso"]) == 1 and all(point[1] == 0 for point in volume["transfer_function"]["opacity"]), "the surface stands alone")
    probed(browser, volume["iso"][0]["value"])
    changes(browser, "a second surface", lambda: press_named(browser, "Add: isosurface"), "volumes")
    changes(browser, "opacity", lambda: set_control(browser, "Opacity", 0.7, section="Isosurfaces"), "volumes")
    changes(browser, "colour", lambda: set_control(browser, "Colour", "#20c040", section="Isosurfaces"), "volumes")
    browser.run("document.querySelector('canvas.values').scrollIntoView()")
    at = browser.run("(({ x, y, width }) => [x + 0.3 * width, y + 40])(document.querySelector('canvas.values').getBoundingClientRect())")
    value = scene_of(browser)["volumes"][0]["iso"][1]["value"]
    changes(browser, "value on the histogram", lambda: browser.drag(at, [at[0] + 20, at[1]]), "volumes")
    check(scene_of(browser)["volumes"][0]["iso"][1]["value"] > value, "the line is dragged")
    changes(browser, "value", lambda: set_control(browser, "Value", 60, section="Isosurfaces"), "volumes")
    equals_render(browser, "surfaces")
    copied_command(browser)
    changes(browser, "matter too", lambda: set_control(browser, "Surfaces alone", "", section="Isosurfaces"), "volumes")
    check(scene_of(browser)["volumes"][0]["transfer_function"] == before[0]["transfer_function"], "the function comes back")
    changes(browser, "surfaces alone", lambda: set_control(browser, "Surfaces alone", "", section="Isosurfaces"), "volumes")
    changes(browser, "remove", lambda: press_named(browser, "Remove this isosurface"), "volumes")
    changes(browser, "remove the last", lambda: press_named(browser, "Remove this isosurface"), "volumes")
    check(scene_of(browser)["volumes"] == before, "what was there is there again")


def polygons(browser, place):
    """A polygon is made, its vertices are dragged, added and removed, by hand and by keys."""
    def polygon():
        return scene_of(browser)["volumes"][0]["transfer_function"]["polygons"][0]

    def keys(*names):
        browser.run("document.querySelector('canvas.plane').focus()")
        for name, alt in names:
            browser.run("document.querySelector('canvas.plane').dispatchEvent(new KeyboardEvent('keydown', "
                        f"{{ key: '{name}', altKey: {str(alt).lower()}, bubbles: true }})); 0")

    changes(browser, "a polygon", lambda: press_named(browser, "Add a polygon"), "volumes")
    made = polygon()
    check(len(made["vertices"]) == 4 and made["falloff"] == 1, f"a rhomb: {made}")
    browser.run("document.querySelector('canvas.plane').scrollIntoView()")
    changes(browser, "a vertex", lambda: browser.drag(place(4 / 6, 0.5), place(0.9, 0.7)), "volumes")
    dragged = polygon()
    check([dragged["vertices"][n] == made["vertices"][n] for n in range(4)] == [True, True, False, True], "one vertex follows the hand")
    check(dragged["vertices"][2][0] > made["vertices"][2][0] and dragged["apex"] == made["apex"], f"to where it goes: {dragged}")
    changes(browser, "the apex", lambda: browser.drag(place(0.5, 0.5), place(0.6, 0.5)), "volumes")
    check(polygon()["apex"][0] > made["apex"][0] and polygon()["vertices"] == dragged["vertices"], "the apex follows the hand")
    browser.drag(place(0.6, 0.5), place(0.02, 0.98))
    check(polygon()["apex"][0] > dragged["vertices"][0][0], "the apex stays where it sees the border")
    changes(browser, "falloff", lambda: set_control(browser, "Soft edge", 0.25), "volumes")
    check(polygon()["falloff"] == 0.5, "the falloff is the soft edge")
    keys(("Insert", True))
    check(len(polygon()["vertices"]) == 5, "a fifth vertex")
    placed = polygon()["vertices"]
    keys(("End", False), ("ArrowUp", True))
    check(sum(a != b for a, b in zip(placed, polygon()["vertices"])) == 1, "one vertex follows the keys")
    keys(("Delete", True))
    check(len(polygon()["vertices"]) == 4, "a vertex is gone")
    equals_render(browser, "polygons")
    keys(("Delete", False))
    check("polygons" not in scene_of(browser)["volumes"][0]["transfer_function"], "the polygon is gone")


def boxes(browser):
    """A function of value and gradient: boxes are made, dragged, coloured, removed and undone."""
    open_section(browser, "Transfer function")
    before = scene_of(browser)["volumes"]
    changes(browser, "by gradient", lambda: press_named(browser, "by gradient"), "volumes")
    function = scene_of(browser)["volumes"][0]["transfer_function"]
    check(function["second"] == "gradient" and len(function["boxes"]) == 1 and "opacity" not in function, "one box by the gradient")
    browser.run("document.querySelector('canvas.plane').scrollIntoView()")
    def place(x, y):
        return browser.run(f"(({{ x, y, width, height }}) => [x + 9 + {x} * (width - 18), y + 9 + {1 - y} * (height - 18)])"
                           "(document.querySelector('canvas.plane').getBoundingClientRect())")
    box = function["boxes"][0]
    low, high = box["value"][0] / 200, box["value"][1] / 200
    middle = place((low + high) / 2, 0.5)
    changes(browser, "drag", lambda: browser.drag(middle, place((low + high) / 2, 0.8)), "volumes")
    moved = scene_of(browser)["volumes"][0]["transfer_function"]["boxes"][0]
    check(abs(moved["second"][0] - 0.3 * box["second"][1]) < 0.02 * box["second"][1] and abs(moved["value"][0] - box["value"][0]) < 2,
          f"the box follows the hand: {moved}")
    changes(browser, "an edge", lambda: browser.drag(place((low + high) / 2, 0.3), place((low + high) / 2, 0.1)), "volumes")
    resized = scene_of(browser)["volumes"][0]["transfer_function"]["boxes"][0]
    check(resized["second"][1] == moved["second"][1] and resized["second"][0] < moved["second"][0], f"an edge follows the hand: {resized}")
    changes(browser, "colour", lambda: set_control(browser, "Fill colour", "#20c040"), "volumes")
    changes(browser, "opacity", lambda: set_control(browser, "Fill opacity", 0.9), "volumes")
    changes(browser, "edge", lambda: set_control(browser, "Soft edge", 0.4), "volumes")
    equals_render(browser, "boxes")
    copied_command(browser, "-o.json")
    check(browser.run("![...document.querySelectorAll('summary')].some((s) => s.textContent === 'Isosurfaces' && s.checkVisibility())"),
          "surfaces are for functions of the value")
    browser.run("document.querySelector('canvas.plane').focus()")
    browser.key("Insert")
    check(len(scene_of(browser)["volumes"][0]["transfer_function"]["boxes"]) == 2, "a second box")
    browser.key("Delete")
    check(len(scene_of(browser)["volumes"][0]["transfer_function"]["boxes"]) == 1, "and it is gone")
    polygons(browser, place)
    while scene_of(browser)["volumes"] != before:
        browser.run("halflight.store.undo(); 0")
    check(browser.run("document.querySelector('canvas.plane') === null"), "the line is back")
    rest(browser)


def scattering(browser):
    open_section(browser, "Volume")
    changes(browser, "a medium", lambda: set_control(browser, "Medium", "", section="Volume"), "volumes")
    changes(browser, "onwards", lambda: set_control(browser, "Forward", 0.6, section="Volume"), "volumes")
    changes(browser, "albedo", lambda: set_control(browser, "Albedo", 0.5, section="Volume"), "volumes")
    changes(browser, "tint", lambda: set_control(browser, "Tint", "#ff8080", section="Volume"), "volumes")
    check(scene_of(browser)["volumes"][0]["scattering"]["albedo"][0] == 0.5, "the tint leaves the albedo")
    changes(browser, "multiple", lambda: set_control(browser, "Multiple scattering", "", section="Volume"), "volumes")
    changes(browser, "emission", lambda: set_control(browser, "Emission", 0.5, section="Volume"), "volumes")
    equals_render(browser, "scattering")


def labels(browser):
    check(browser.run("![...document.querySelectorAll('summary')].some((s) => s.textContent === 'Transfer function' && s.checkVisibility())"),
          "labels have no transfer function")
    first = scene_of(browser)["volumes"]
    changes(browser, "an eye", lambda: press_named(browser, "Show label 2"), "volumes")
    undone(browser, "volumes", first, "an eye")
    paint = "(() => { const c = document.querySelector('[aria-label=\"Colour of label 1\"]'); c.value = '#ff0000'; c.dispatchEvent(new Event('input')); })()"
    changes(browser, "colour of a label", lambda: browser.run(paint), "volumes")
    thin = "(() => { const c = document.querySelector('[aria-label=\"Opacity of label 1\"]'); c.value = 0.3; c.dispatchEvent(new Event('change')); })()"
    changes(browser, "opacity of a label", lambda: browser.run(thin), "volumes")
    changes(browser, "alone", lambda: press_named(browser, "Show label 2 alone"), "volumes")
    shown = scene_of(browser)["volumes"]
    press_named(browser, "Show label 2")
    check(scene_of(browser)["volumes"] == shown, "one label stays")
    equals_render(browser, "labels")
    changes(browser, "all", lambda: press_named(browser, "show all"), "volumes")
    probed(browser, 2)


def mask(browser):
    """The labels of the second volume's mask, while the first is chosen, which has none."""
    def set_on(name, value, event):
        control = f"document.querySelector('[aria-label=\"{name}\"]')"
        browser.run(f"{control}.value = '{value}'; {control}.dispatchEvent(new Event('{event}')); 0")

    masked = lambda: scene_of(browser)["volumes"][1]["mask"]  # noqa: E731
    first = scene_of(browser)["volumes"]
    changes(browser, "an eye", lambda: press_named(browser, "Show label 2"), "volumes")
    undone(browser, "volumes", first, "an eye")
    changes(browser, "colour of a mask's label", lambda: set_on("Colour of label 1", "#2040ff", "input"), "volumes")
    check(masked()["labels"][0]["tint"] == 1, "the label's matter takes its colour")
    changes(browser, "opacity of a mask's label", lambda: set_on("Opacity of label 1", 0.3, "change"), "volumes")
    changes(browser, "the rest", lambda: set_control(browser, "Rest", 0.5, section="Labels"), "volumes")
    check(masked()["rest"] == 0.5, "the rest has half its opacity")
    equals_render(browser, "mask")
    chosen = "document.querySelector('.chooser select')"
    volumes = scene_of(browser)["volumes"]
    browser.run(f"{chosen}.value = '1'; {chosen}.dispatchEvent(new Event('change')); 0")
    changes(browser, "the opacity of the chosen volume", lambda: set_control(browser, "Opacity", 1), "volumes")
    check(scene_of(browser)["volumes"][0] == volumes[0] and scene_of(browser)["volumes"][1] != volumes[1], "panels are about the chosen volume")


def as_labels(browser):
    """A volume of numbers of things is shown as labels, and no longer when that is undone."""
    before = scene_of(browser)["volumes"]
    changes(browser, "as labels", lambda: press_named(browser, "show as labels") or browser.wait(f"{STAGE} === 'moving'"), "volumes")
    check([label["value"] for label in scene_of(browser)["volumes"][0]["labels"]] == [1, 2], "both labels are there")
    press_named(browser, "Show label 2")
    equals_render(browser, "as-labels")
    browser.run("halflight.store.undo(); halflight.store.undo(); 0")
    check(scene_of(browser)["volumes"] == before, "both steps are undone")
    sections = browser.run("[...document.querySelectorAll('summary')].filter((s) => s.checkVisibility()).map((s) => s.textContent)")
    check("Transfer function" in sections and "Labels" not in sections, f"the transfer function is back, and the labels are gone: {sections}")


def follows(browser, what, name, drag, key, ways):
    """The handle of this name is dragged, and goes with the pointer, or, along one way, to the place of the way that is nearest to it."""
    handle = f"[aria-label='{name}, in the picture']"
    x, y = center(browser, handle)
    changes(browser, what, lambda: browser.drag([x, y], [x + drag[0], y + drag[1]]), key)
    moved = [end - start for end, start in zip(center(browser, handle), (x, y))]
    far = moved[0]**2 + moved[1]**2
    check(far > 9, f"{what}: the handle stays where it is, {moved}")
    if ways == 2:
        check(max(abs(a - b) for a, b in zip(moved, drag)) < 3, f"{what}: moved by {moved}, not {drag}")
    else:
        beside = abs(moved[0] * (drag[0] - moved[0]) + moved[1] * (drag[1] - moved[1])) / far**0.5
        check(beside < 3, f"{what}: moved by {moved} of {drag}")



def to_the_crosshair(browser, cuts_now):
    """A cut goes to the crosshair by one button, which is there while slices are."""
    move = "[...document.querySelectorAll('button')].find((b) => b.textContent === 'to the crosshair' && b.closest('details').open)"
    check(browser.run(f"{move}.offsetParent === null"), "no crosshair, no button")
    browser.run("halflight.store.setPage({ layout: 'beside', cursor: [9, 8, 7] })")
    box = cuts_now()[1]
    browser.wait(f"{move}.offsetParent !== null")
    changes(browser, "a box goes to the crosshair", lambda: browser.run(f"{move}.click()"), "volumes")
    moved = cuts_now()[1]
    middle = [(low + high) / 2 for low, high in zip(moved["min"], moved["max"])]
    check(max(abs(a - b) for a, b in zip(middle, [9, 8, 7])) < 1e-9, f"its middle is there: {middle}")
    sides = [[high - low for low, high in zip(one["min"], one["max"])] for one in (box, moved)]
    check(max(abs(a - b) for a, b in zip(*sides)) < 1e-9, f"its sides are as long as before: {sides}")
    press_named(browser, "Undo")
    browser.run("halflight.store.setPage({ layout: 'picture' })")
    rest(browser)
    check(cuts_now()[1] == box, "undone in one step")


def cuts(browser):
    """Cuts of every shape, their numbers, their switch, and what is refused."""
    def cuts_now():
        return scene_of(browser)["volumes"][0].get("cuts", [])

    def number(name, value):
        field = f"document.querySelector('[aria-label=\"{name} of the cut\"]')"
        return lambda: browser.run(f"{field}.value = '{value}'; {field}.dispatchEvent(new Event('change')); 0")

    open_section(browser, "Cuts")
    changes(browser, "a cut", lambda: press_named(browser, "Add: cut"), "volumes")
    check(cuts_now()[0]["type"] == "plane" and cuts_now()[0]["normal"] == [1, 0, 0], "the first cut is a plane")
    changes(browser, "its point", number("Point x", 5), "volumes")
    changes(browser, "its direction", number("Direction z", 0.5), "volumes")
    check(cuts_now()[0]["point"][0] == 5 and cuts_now()[0]["normal"] == [1, 0, 0.5], "the fields are the plane's numbers")
    before = cuts_now()
    changes(browser, "off", lambda: set_control(browser, "This cut", "", section="Cuts"), "volumes")
    check("cuts" not in scene_of(browser)["volumes"][0], "a cut that is off is not in the scene")
    changes(browser, "on", lambda: set_control(browser, "This cut", "", section="Cuts"), "volumes")
    check(cuts_now() == before, "it comes back as it was")
    follows(browser, "a plane's handle", "Plane of the cut", (-25, 6), "volumes", 1)
    step = [now - then for now, then in zip(cuts_now()[0]["point"], before[0]["point"])]
    check(step[0] != 0 and step[1] == 0 and abs(step[2] - step[0] / 2) < 1e-9, f"the plane moves along its direction: {step}")
    browser.run("document.querySelector('.cut-handle').focus()")
    changes(browser, "arrow keys on a plane's handle", lambda: browser.key("ArrowLeft"), "volumes")
    browser.run(f"""for (let step = 0; step < 9 && halflight.store.scene.volumes[0].cuts[0].point[0] !== {before[0]["point"][0]}; step++)
      halflight.store.undo(); 0""")  # a drag is a step, or a few where the machine is slow
    check(cuts_now() == before, "both are undone")
    changes(browser, "faces", lambda: set_control(browser, "Cut faces", "none", "change", section="Cuts"), "volumes")
    changes(browser, "keep", lambda: set_control(browser, "Inside", "", section="Cuts"), "volumes")
    changes(browser, "a second cut", lambda: press_named(browser, "Add: cut"), "volumes")
    changes(browser, "a sphere", lambda: set_control(browser, "Sphere", "", section="Cuts"), "volumes")
    eye, ball = scene_of(browser)["camera"]["position"], cuts_now()[1]["center"]
    middle = browser.run("halflight.start.volumes[0].dimensions.map((count, k) => halflight.start.volumes[0].origin[k] + halflight.start.volumes[0].axes[k][k] * (count - 1) / 2)")
    parts = [(at - x) / (to - x) for at, x, to in zip(ball, middle, eye)]
    check(max(parts) - min(parts) < 1e-6 and 0 < parts[0] < 1, f"the sphere begins between the middle and the eye: {parts}")
    for axis in "xyz":
        number(f"Centre {axis}", 7.5)()  # in the picture
    changes(browser, "radius", number("Radius", 4), "volumes")
    follows(browser, "a sphere's middle", "Middle of the cut", (-12, 9), "volumes", 2)
    follows(browser, "a sphere's rim", "Radius of the cut", (9, 9), "volumes", 1)
    number("Radius", 4)()
    number("Radius", -1)()
    check(cuts_now()[1]["radius"] == 4 and len(cuts_now()) == 2, "a radius below 0 is refused")
    changes(browser, "a box", lambda: set_control(browser, "Box", "", section="Cuts"), "volumes")
    box = cuts_now()[1]
    follows(browser, "a box's face", "Box of the cut z, least", (3, 12), "volumes", 1)
    check(cuts_now()[1] == {**box, "min": [*box["min"][:2], cuts_now()[1]["min"][2]]}, "one face moves alone")
    to_the_crosshair(browser, cuts_now)
    equals_render(browser, "cuts")
    last = cuts_now()
    changes(browser, "all cuts off", lambda: set_control(browser, "All cuts", ""), "volumes")
    check("cuts" not in scene_of(browser)["volumes"][0], "no cut is left in the scene")
    changes(browser, "all cuts on", lambda: set_control(browser, "All cuts", ""), "volumes")
    check(cuts_now() == last, "all come back as they were")
    press_named(browser, "cut 2")
    changes(browser, "remove", lambda: press_named(browser, "Remove this cut"), "volumes")
    check(cuts_now() == last[:1], "the chosen cut is removed")
    browser.run("halflight.store.undo(); 0")
    check(cuts_now() == last, "and comes back when that is undone")


def scene_cuts(browser):
    """Cuts of a scene of two volumes: made, moved, switched off, removed; the panel is there for several volumes alone."""
    title = "Cuts of the scene"

    def now():
        return scene_of(browser).get("cuts")

    open_section(browser, title)
    changes(browser, "a cut of all", lambda: press_named(browser, "Add: cut of the scene"), "cuts")
    check(now()[0]["type"] == "plane" and now()[0]["point"] == [13.5, 7.5, 7.5], f"a plane through the middle of both volumes: {now()}")
    field = "document.querySelector('[aria-label=\"Point x of the cut of the scene\"]')"
    changes(browser, "its point", lambda: browser.run(f"{field}.value = 5; {field}.dispatchEvent(new Event('change')); 0"), "cuts")
    check(now()[0]["point"][0] == 5 and all("cuts" not in volume for volume in scene_of(browser)["volumes"]), "the scene is cut, no volume")
    follows(browser, "a plane's handle", "Plane of the cut of the scene", (20, 0), "cuts", 1)
    changes(browser, "a box", lambda: set_control(browser, "Box", "", section=title), "cuts")
    follows(browser, "a box's face", "Box of the cut of the scene x, least", (25, 0), "cuts", 1)
    changes(browser, "a sphere", lambda: set_control(browser, "Sphere", "", section=title), "cuts")
    equals_render(browser, "scene cuts")
    before = now()
    changes(browser, "off", lambda: set_control(browser, "This cut", "", section=title), "cuts")
    check(now() is None, "a cut that is off is not in the scene")
    changes(browser, "on", lambda: set_control(browser, "This cut", "", section=title), "cuts")
    check(now() == before, "it comes back as it was")
    changes(browser, "remove", lambda: press_named(browser, "Remove this cut of the scene"), "cuts")
    check(now() is None, "it is removed")
    browser.run("halflight.store.undo(); 0")
    check(now() == before, "and comes back when that is undone")


def probed(browser, *values):
    """Where nothing is seen through, the probe finds each of these."""
    browser.run("halflight.probe.on = true; 0")
    rest(browser)
    browser.wait("halflight.probe.at(0.5, 0.5) !== null")
    found = browser.run("""Array.from({ length: 400 }, (_, n) => halflight.probe.at((n % 20) / 20, Math.floor(n / 20) / 20))
      .filter((at) => at.opacity > 0.98).map((at) => at.value)""")
    for value in values:
        check(any(abs(one - value) < 0.01 for one in found), f"the probe finds no {value}: {found}")
    browser.run("halflight.probe.on = false; 0")


def meshes_alone(browser):
    open_section(browser, "Sky")
    changes(browser, "a sky over meshes", lambda: set_control(browser, "Even", "", section="Sky"), "sky")
    equals_render(browser, "meshes")


def write(name, voxels):
    with open(name, "wb") as file:
        file.write(b"NRRD0004\ntype: uint8\ndimension: 3\nsizes: 16 16 16\nencoding: raw\n\n" + bytes(voxels))


def ball(x, y, z, radius):
    return lambda at: (at[0] - x)**2 + (at[1] - y)**2 + (at[2] - z)**2 < radius**2


def write_inputs():
    """A soft ball, two labels, a sky image, and scenes of them."""
    places = [(x, y, z) for z in range(16) for y in range(16) for x in range(16)]
    write("soft.nrrd", [max(0, 200 - round(3.5 * ((x - 7.5)**2 + (y - 7.5)**2 + 1.5 * (z - 7.5)**2))) for x, y, z in places])
    one, two = ball(5, 7, 7, 4), ball(11, 8, 8, 3)
    write("labels.nrrd", [1 if one(at) else 2 if two(at) else 0 for at in places])
    from PIL import Image
    image = Image.new("RGB", (16, 8), (40, 40, 40))
    image.paste((255, 200, 80), (2, 1, 7, 5))
    image.save("sky.png")
    quick = {"sheet_spacing": 1}
    soft = {"file": "soft.nrrd", "transfer_function": {"opacity": [[60, 0], [150, 0.6]], "color": [0.7, 0.7, 0.7]}}
    for name, scene in (("soft", {"volumes": [soft]}),
                        ("cut", {"volumes": [soft]}),
                        ("pair", {"volumes": [{**soft, "name": "a"}, {**soft, "name": "b", "transform": {"translate": [12, 0, 0]}}]}),
                        ("image", {"volumes": [soft], "sky": {"type": "image", "file": "sky.png", "strength": 0.5}}),
                        ("labels", {"volumes": [{"file": "labels.nrrd", "labels": True}]}),
                        ("mask", {"volumes": [{**soft, "name": "faint", "transform": {"translate": [20, 0, 0]}},
                                              {**soft, "mask": {"file": "labels.nrrd", "labels": [{"value": 1}, {"value": 2}], "rest": 0.1}}]}),
                        ("numbers", {"volumes": [{"file": "labels.nrrd"}]}),
                        ("meshes", {"meshes": [{"spheres": [[0, 0, 0, 1]]}, {"floor": True}]})):
        with open(f"{name}.json", "w") as file:
            json.dump({"halflight": 1, "render": quick, **scene}, file)


chromium = shutil.which("chromium")
if chromium is None:
    print("chromium is not installed")
    sys.exit(77)
with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    need_viewer(PROGRAM)
    write_inputs()
    for scene, parts in (("soft", (sky, surfaces, boxes, scattering)), ("cut", (cuts,)), ("pair", (scene_cuts,)), ("image", (sky_image,)), ("labels", (labels,)), ("mask", (mask,)),
                         ("numbers", (as_labels,)),
                         ("meshes", (meshes_alone,))):
        with Viewer(PROGRAM, f"{scene}.json") as viewer, Browser(chromium, SIZE) as browser:
            browser.open(viewer.url)
            rest(browser)
            for part in parts:
                part(browser)
            check(browser.problems == [], f"{scene}: the console has errors: {browser.problems}")
    print(f"{checks.count} checks passed")
