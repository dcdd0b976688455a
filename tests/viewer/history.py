#!/usr/bin/env python3
"""The history, in a headless Chromium or Firefox: one step a gesture, menus, handles and choices that follow it, and what is switched off or hidden comes
back, also after a reload. What the page says of its picture is true.

usage: history.py PROGRAM chromium|firefox-esr
"""
import json
import time

from checks import check
from hands import STAGE, center, on_rings, open_section, press, press_named, reload, rest, scene_of, set_control, undo


def slider_at(browser, label):
    """The middle of the slider with this label, brought into view."""
    return browser.run(f"""(() => {{ const label = [...document.querySelectorAll('aside label')].find((l) => l.textContent === {json.dumps(label)} && l.offsetParent);
      const b = document.getElementById(label.htmlFor); b.scrollIntoView({{ block: 'center' }}); const r = b.getBoundingClientRect(); return [r.x + r.width / 2, r.y + r.height / 2]; }})()""")


def one_step_a_gesture(browser):
    open_section(browser, "Lights")
    before = scene_of(browser)["lights"]
    x, y = slider_at(browser, "Intensity")
    browser.mouse("mousePressed", x, y)
    for part in range(4):  # slower than any clock of a history
        browser.mouse("mouseMoved", x + 8 * part, y)
        time.sleep(0.4)
    browser.mouse("mouseReleased", x + 24, y)
    first = scene_of(browser)["lights"]
    browser.drag([x + 24, y], [x + 44, y], steps=3)  # at once
    check(first != before and scene_of(browser)["lights"] != first, "two drags of a slider")
    undo(browser)
    check(scene_of(browser)["lights"] == first, "one undo takes the second drag back, however soon it came")
    undo(browser)
    check(scene_of(browser)["lights"] == before, "one undo takes the first drag back, however long it took")
    press_named(browser, "Redo")
    check(scene_of(browser)["lights"] == first, "redo")
    undo(browser)
    browser.run("document.querySelector('.light').focus()")
    places = [scene_of(browser)["lights"]]
    for _ in range(3):
        browser.key("ArrowRight")
        places.append(scene_of(browser)["lights"])
    for place in places[-2::-1]:
        undo(browser)
        check(scene_of(browser)["lights"] == place, "each press of a key is a step")
    rest(browser)


def cameras_are_undone(browser):
    open_section(browser, "Session")
    first = scene_of(browser)["camera"]
    x, y = center(browser, "#view")
    browser.drag([x - 120, y + 90], [x - 60, y + 110])
    second = scene_of(browser)["camera"]
    browser.drag([x - 120, y + 90], [x - 100, y + 90])
    lights = scene_of(browser)["lights"]
    browser.run("document.getElementById('view').focus()")
    browser.key("c")
    check(second != first and scene_of(browser)["camera"] == second, "c: the view before")
    press(browser, "camera back")
    check(scene_of(browser)["camera"] == first and scene_of(browser)["lights"] == lights, "the first view, and nothing else")
    browser.run("document.getElementById('view').focus()")
    browser.key("C")
    check(scene_of(browser)["camera"] == second, "C: the view after")


def menus_follow(browser):
    chosen = "(label) => document.getElementById([...document.querySelectorAll('aside label')].find((l) => l.textContent === label).htmlFor).value"
    def menu(label):
        return browser.run(f"({chosen})({json.dumps(label)})")
    open_section(browser, "Transfer function")
    start = menu("Preset")
    set_control(browser, "Colours", "viridis", "change")
    check(menu("Colours") == "viridis", "the menu tells the colormap")
    set_control(browser, "Colours", "magma", "change")
    undo(browser)
    check(menu("Colours") == "viridis", "undone: the one before")
    undo(browser)
    check(menu("Colours") == "" and menu("Preset") == start, "undone: none")
    points = "halflight.store.scene.volumes[0].transfer_function.opacity.length"
    before = browser.run(points)
    set_control(browser, "Preset", "ct-bone", "change")
    browser.wait(f"{points} !== {before}")
    check(menu("Preset") == "ct-bone", "the preset")
    undo(browser)
    check(menu("Preset") == start, "undone: no longer the preset")
    press_named(browser, "Redo")
    check(menu("Preset") == "ct-bone", "redone: the preset again")
    line = scene_of(browser)["volumes"][0]["transfer_function"]
    press(browser, "by gradient")
    check("boxes" in scene_of(browser)["volumes"][0]["transfer_function"], "by gradient")
    press(browser, "by value")
    check(scene_of(browser)["volumes"][0]["transfer_function"] == line, "by value: the line that was")
    undo(browser)
    undo(browser)
    undo(browser)
    rest(browser)


def steps_change_something(browser):
    """What changes nothing is no step; what lies over the picture is undone, too; and a slider shows again what it had shown."""
    rest(browser)
    steps = "halflight.store.history[0].length"
    count = browser.run(steps)
    browser.run("document.querySelector('.choice[aria-pressed=true]').click()")
    browser.run("halflight.store.changeRender('shadows', halflight.store.scene.render.shadows)")
    browser.wait("document.getElementById('stage').textContent === 'final'")  # the click waits for the look's scene
    check(browser.run(steps) == count, "the choice of what is chosen is no step")
    boxes = "['legend', 'scale-bar'].map((id) => document.getElementById(id).checked)"
    open_section(browser, "Save")
    browser.run("""(() => { const asked = globalThis.fetch; globalThis.drawn = []; globalThis.fetch = async (...all) => { const answer = await asked(...all);
      if (String(all[0]).startsWith('overlay')) drawn.push(answer.headers.get('Server-Timing')); return answer; }; })()""")
    browser.run("document.getElementById('legend').click()")
    browser.wait("!document.querySelector('canvas.figure').hidden")
    check(browser.run("drawn") == [None], f"no picture is rendered for the legend: {browser.run('drawn')}")
    check(browser.run(boxes) == [True, False], "a legend")
    undo(browser)
    check(browser.run(boxes) == [False, False] and browser.run("document.querySelector('canvas.figure').hidden"), "is undone")
    press_named(browser, "Redo")
    browser.wait("!document.querySelector('canvas.figure').hidden")
    undo(browser)
    open_section(browser, "Transfer function")
    set_control(browser, "Opacity", -1, section="Transfer function")
    shown = "document.querySelector('[aria-label=\"Opacity in ×\"]').value"
    before = browser.run(shown)
    press(browser, "by gradient")
    undo(browser)
    check(browser.run(shown) == before != "1", f"the factor is what it was: {before}, {browser.run(shown)}")
    undo(browser)
    rest(browser)


def fields_undo_themselves(browser):
    """Ctrl + Z in a field is the field's; keys work again after a light was dragged."""
    open_section(browser, "Lights")
    set_control(browser, "Intensity", 2)
    steps = "halflight.store.history[0].length"
    count = browser.run(steps)
    browser.run("document.querySelector('details[open] input.number').focus()")
    browser.key("z", modifiers=2)
    check(browser.run(steps) == count and count > 0, f"a field's Ctrl + Z leaves the scene: {count}, {browser.run(steps)}")
    handle = center(browser, ".light-dot")
    browser.drag(handle, [handle[0] + 20, handle[1] + 5])
    shadows = scene_of(browser)["render"]["shadows"]
    browser.key("s")
    check(scene_of(browser)["render"]["shadows"] != shadows, "'s' works after a light was dragged")
    for _ in range(3):
        undo(browser)


def zoom_goes_on(browser):
    """The eye passes what it looked at."""
    x, y = center(browser, "#view")
    before = scene_of(browser)["camera"]
    eyes = []
    for _ in range(60):
        browser.wheel(x, y, -400)
        eyes.append(scene_of(browser)["camera"]["position"])
    last = sum((a - b) ** 2 for a, b in zip(eyes[-1], eyes[-6])) ** 0.5
    check(last > 0.3, f"the last five steps still move the eye: {last}")
    browser.run(f"halflight.store.setCamera({json.dumps(before)})")


def true_status(browser):
    """The line under the picture is not 'final' from the very moment of a change; slow pictures tell how far they are."""
    browser.run("halflight.store.changeRender('soft_method', 'sublights')")
    browser.run("halflight.store.changeRender('light_samples', 8)")  # a slow picture on any machine
    rest(browser)
    said = browser.run("(halflight.store.changeRender('sheet_spacing', 0.01), document.getElementById('stage').dataset.stage)")
    check(said == "moving", f"at the change: {said}")
    browser.wait(f"{STAGE} === 'refining'")
    browser.wait("/^[0-9]+ %/.test(document.getElementById('progress').textContent)")
    check(browser.run("document.getElementById('stage').textContent") != "final", "not final while it is made")
    for _ in range(3):
        undo(browser)
    rest(browser)
    check(browser.run("document.getElementById('progress').textContent") == "", "at rest nothing is under way")
    marks = browser.run("""(halflight.store.setMarks('test', [{ kind: 'text', points: [[0, 0, 0]], text: 'here' }]), document.getElementById('stage').dataset.stage)""")
    check(marks == "final", "a mark changes no picture")
    undo(browser)
    check(browser.run(STAGE) == "final" and browser.run("halflight.store.marks.length") == 0, "nor does its undo")


def choices_are_undone(browser, title, noun, things):
    """What is chosen in a panel for editing is a choice like others: it is undone, and comes back with the chosen thing. things: its list in the scene."""
    def chosen():
        return browser.run(f"[...document.querySelectorAll('[aria-label={title}] [role=tab]')].findIndex((tab) => tab.ariaSelected === 'true')"), len(browser.run(things))

    def tab(number):
        browser.run(f"document.querySelectorAll('[aria-label={title}] [role=tab]')[{number}].click()")

    open_section(browser, title)
    there = len(browser.run(things))
    if there == 0:
        press_named(browser, f"Add: {noun}")
    count = max(there, 1)
    press_named(browser, f"Add: {noun}")
    check(chosen() == (count, count + 1), f"a new {noun} is chosen: {chosen()}")
    tab(0)
    check(chosen() == (0, count + 1), f"the first {noun}: {chosen()}")
    undo(browser)
    check(chosen() == (count, count + 1), f"undone: the new {noun}: {chosen()}")
    press_named(browser, "Redo")
    check(chosen() == (0, count + 1), f"redone: the first {noun}: {chosen()}")
    undo(browser)
    press_named(browser, f"Remove this {noun}")
    check(chosen() == (count - 1, count), f"the {noun} before: {chosen()}")
    undo(browser)
    check(chosen() == (count, count + 1), f"one step brings the {noun} back, and chosen: {chosen()}")
    check(browser.run("halflight.store.canRedo"), "the step can be done again")
    reload(browser)
    check(chosen() == (count, count + 1), f"after a reload, too: {chosen()}")
    undo(browser)
    check(chosen() == (0, count), f"as it was: {chosen()}")
    if there == 0:
        undo(browser)
    rest(browser)


def handles_follow_choices(browser):
    """The handles in the picture are those of the chosen light and cut, also after undo."""
    open_section(browser, "Lights")
    press_named(browser, "Add: light")
    browser.run("document.querySelector('.light').focus()")  # as after a drag; handles that come and go do not choose
    light = "document.querySelector('.light.chosen').dataset.light"
    last = browser.run(light)
    browser.run("document.querySelectorAll('[aria-label=Lights] [role=tab]')[0].click()")
    check(browser.run(light) == "0" != last, "the handle of the first light is marked")
    undo(browser)
    check(browser.run(light) == last, "and that of the last one again")
    undo(browser)
    open_section(browser, "Cuts")
    press_named(browser, "Add: cut")
    press_named(browser, "Add: cut")
    set_control(browser, "Sphere", "", section="Cuts")
    handles = "[...document.querySelectorAll('.cut-handle:not([hidden])')].map((handle) => handle.getAttribute('aria-label'))"
    sphere = browser.run(handles)
    field = "document.querySelector('[aria-label=\"Radius of the cut\"]') !== null"
    check(len(sphere) == 2 and browser.run(field), f"a sphere's handles and its radius: {sphere}")
    browser.run("document.querySelectorAll('[aria-label=Cuts] [role=tab]')[0].click()")
    check(browser.run(handles) == ["Plane of the cut, in the picture"] and not browser.run(field), f"the plane's: {browser.run(handles)}")
    undo(browser)
    check(browser.run(handles) == sphere and browser.run(field), f"the sphere's again: {browser.run(handles)}")


def cuts_that_are_off(browser):
    """A cut that is switched off keeps its place in the list through undo, redo and a reload, and all cuts come back after a reload."""
    cuts, tabs = "halflight.store.scene.volumes[0].cuts", "document.querySelectorAll('[aria-label=Cuts] [role=tab]').length"
    before = browser.run(cuts)
    check([cut["type"] for cut in before] == ["plane", "sphere"], f"two cuts: {before}")
    browser.run("document.querySelectorAll('[aria-label=Cuts] [role=tab]')[0].click()")
    off = lambda: set_control(browser, "This cut", "", section="Cuts")  # noqa: E731
    off()
    check(browser.run(cuts) == before[1:] and browser.run(tabs) == 2, "the first cut is off, and in the list")
    undo(browser)
    check(browser.run(cuts) == before and browser.run(tabs) == 2, "one step switches it on")
    press_named(browser, "Redo")
    reload(browser)
    check(browser.run(cuts) == before[1:] and browser.run(tabs) == 2, "it is off, and in the list, after a reload")
    off()
    check(browser.run(cuts) == before, "it comes back at its place")
    set_control(browser, "All cuts", "")
    reload(browser)
    check(browser.run(cuts) is None, "all cuts are off")
    set_control(browser, "All cuts", "")
    check(browser.run(cuts) == before, "all cuts are on again")
    while browser.run(f"{cuts} !== undefined"):
        undo(browser)
    rest(browser)


def functions_come_back(browser):
    """The transfer function that surfaces have hidden, or that another kind of function has replaced, comes back after a reload."""
    tf = "halflight.store.scene.volumes[0].transfer_function"
    before = browser.run(tf)
    open_section(browser, "Isosurfaces")
    press_named(browser, "Add: isosurface")
    check(browser.run(tf) != before, "the surface alone is shown")
    reload(browser)
    press_named(browser, "Remove this isosurface")
    check(browser.run(tf) == before, "without the surface the rest is shown as before")
    open_section(browser, "Transfer function")
    press(browser, "by gradient")
    check("boxes" in browser.run(tf), "a function of value and gradient")
    reload(browser)
    press(browser, "by value")
    check(browser.run(tf) == before, "the function of the value is back")
    rest(browser)


def all_choices_are_undone(browser):
    choices_are_undone(browser, "Lights", "light", "halflight.store.scene.lights")
    choices_are_undone(browser, "Isosurfaces", "isosurface", "halflight.store.scene.volumes[0].iso ?? []")
    choices_are_undone(browser, "Cuts", "cut", "halflight.store.scene.volumes[0].cuts ?? []")


if __name__ == "__main__":
    on_rings(one_step_a_gesture, cameras_are_undone, menus_follow, steps_change_something, fields_undo_themselves, zoom_goes_on, true_status,
             all_choices_are_undone, handles_follow_choices, cuts_that_are_off, functions_come_back)
