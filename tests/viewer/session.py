#!/usr/bin/env python3
"""Nothing is lost, in a headless Chromium or Firefox: one step of the history a gesture, menus that follow it, and the whole state after a reload, after
another start of the viewer, after a lost network and out of a file. What the page says of its picture is true.

usage: session.py PROGRAM chromium|firefox-esr [FOLDER]
FOLDER: where screenshots are kept; without it they are not made.
"""
import json
import os
import stat
import subprocess
import sys
import tempfile
import time

import checks
from checks import check
from firefox import browser_named
from hands import PROGRAM, STAGE, center, equals_render, final_picture, open_section, press, press_named, resize, rest, scene_of, set_control
from viewer import Viewer, need_viewer

SHOTS = os.path.abspath(sys.argv[3]) if len(sys.argv) > 3 else None
BANNER = "document.querySelector('.banner')"


def undo(browser):
    press_named(browser, "Undo")


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


# Which sections are unfolded is told by an event that comes later.
STATE = "(({ sections, ...page }) => JSON.stringify([halflight.store.scene, halflight.store.marks, page]))(halflight.store.page)"


def work(browser):
    """Something of everything; returns the state."""
    set_control(browser, "Colours", "magma", "change")
    browser.run("halflight.slices.moveTo([3, 4, 5])")
    browser.run("halflight.store.setPage({ layout: 'four', windows: { 0: [0.25, 0.75] } })")
    browser.run("halflight.store.setMarks('ruler', [{ kind: 'ruler', points: [[0, 0, 0], [3, 4, 0]], text: 'five' }])")
    browser.run("[...document.querySelectorAll('details')].find((d) => d.querySelector('summary').textContent === 'Session').open = true")
    rest(browser)
    press(browser, "bookmark")
    x, y = center(browser, "#view")
    browser.drag([x - 60, y + 60], [x - 30, y + 80])
    rest(browser)
    return browser.run(STATE)


def reload(browser):
    browser.run("globalThis.before = true")
    browser.reload()
    browser.wait("globalThis.before === undefined && globalThis.halflight !== undefined")
    rest(browser)


def after_reload(browser):
    before = work(browser)
    reload(browser)
    check(browser.run(STATE) == before, "a reload: all is as it was")
    check(browser.run("document.querySelectorAll('.slice:not([hidden])').length") == 3 and browser.run("document.querySelectorAll('.bookmarks li').length") == 1, "and is shown")
    colors = scene_of(browser)["volumes"][0]["transfer_function"]["color"]
    undo(browser)
    check(browser.run("document.querySelectorAll('.bookmarks li').length") == 0 and browser.run("halflight.store.marks.length") == 1, "undo goes on: the bookmark")
    undo(browser)
    check(browser.run("halflight.store.marks.length") == 0, "the ruler")
    undo(browser)
    check(browser.run("halflight.slices.layout") == "picture" and browser.run("halflight.store.page.windows === undefined"), "layout and window")
    undo(browser)
    check(scene_of(browser)["volumes"][0]["transfer_function"]["color"] != colors, "and the colours")
    for _ in range(4):
        press_named(browser, "Redo")
    rest(browser)
    camera = scene_of(browser)["camera"]
    browser.run("document.querySelector('.bookmarks .view').click()")
    check(scene_of(browser)["camera"] != camera, "the bookmark leads back")
    browser.run("document.getElementById('view').focus()")
    browser.key("c")
    check(scene_of(browser)["camera"] == camera, "and is undone as any view")
    browser.run("halflight.store.setPage({ layout: 'picture' })")
    equals_render(browser, "reloaded")


KEYS = "[...document.querySelectorAll('.timeline .key')].map((key) => [key.dataset.path, +key.dataset.frame])"


def film_after_reload(browser):
    """The film is kept with the tab: after a reload its timeline lies open under the picture, which so has the size that it had."""
    resize(browser, 500, 900)  # higher than wide: the camera depends on the picture's shape
    open_section(browser, "Film")
    rest(browser)
    browser.run("(() => { const n = document.querySelector('[aria-label=\"Frames of the film\"]'); n.value = 41; n.dispatchEvent(new Event('change')); })()")
    press(browser, "key of the camera now")
    press_named(browser, "Add a key of Intensity")
    browser.run("(() => { const s = document.querySelector('[aria-label=Frame]'); s.value = 40; s.dispatchEvent(new Event('input')); })()")
    browser.wait("halflight.store.page.film.frame === 40")
    set_control(browser, "Intensity", 0.5)
    press_named(browser, "Add a key of Intensity")
    rest(browser)
    keys, state, picture = browser.run(KEYS), browser.run(STATE), final_picture(browser)
    check(keys == [["camera", 0], ["lights.0.intensity", 0], ["lights.0.intensity", 40]], f"three keys: {keys}")
    reload(browser)
    check(browser.run("!document.querySelector('.timeline').hidden && document.querySelector('.viewer').classList.contains('filming')"), "the timeline lies open")
    check(browser.run(KEYS) == keys and browser.run("document.querySelector('[aria-label=Frame]').value") == "40", f"with its keys and frame: {browser.run(KEYS)}")
    after = browser.run(STATE)
    check(after == state, f"a reload with an open timeline: all is as it was: {after}, {state}")
    check(final_picture(browser) == picture, "and so is the picture")
    browser.run("(() => { const n = document.querySelector('[aria-label=\"Frames of the film\"]'); n.value = 11; n.dispatchEvent(new Event('change')); })()")
    check(browser.run(KEYS) == [["camera", 0], ["lights.0.intensity", 0], ["lights.0.intensity", 10]], f"a shorter film has all its keys: {browser.run(KEYS)}")
    open_section(browser, "Session")
    browser.wait("document.querySelector('.timeline').hidden")
    resize(browser, 900, 620)
    undo(browser)
    rest(browser)


def film_is_undone(browser):
    """Keys that are set, moved and removed, and a film's length and format, are steps of the history; to go to a frame is none."""
    def tracks():
        return browser.run("JSON.stringify([halflight.store.page.film?.frames ?? 120, halflight.store.page.film?.format ?? 'mp4', (halflight.store.page.film?.tracks ?? []).map(({ path, points }) => [path, points.map(([frame]) => frame)])])")

    def seek(frame):
        browser.run(f"(() => {{ const s = document.querySelector('[aria-label=Frame]'); s.value = {frame}; s.dispatchEvent(new Event('input')); }})()")
        browser.wait(f"halflight.store.page.film.frame === {frame}")

    def drag_key(frame, way):
        x, y = center(browser, f".timeline .key[data-frame='{frame}']")
        browser.drag([x, y], [x + way, y], 6)

    open_section(browser, "Film")
    rest(browser)
    states = [tracks()]

    def step(act):
        act()
        states.append(tracks())
        check(states[-1] != states[-2], f"the film has changed: {states[-2:]}")

    seek(3)
    step(lambda: press_named(browser, "Add a key of Intensity"))
    seek(6)
    step(lambda: press_named(browser, "Add a key of Intensity"))
    step(lambda: drag_key(6, 80))
    step(lambda: browser.run("(() => { const n = document.querySelector('[aria-label=\"Frames of the film\"]'); n.value = 81; n.dispatchEvent(new Event('change')); })()"))
    step(lambda: set_control(browser, "Format", "gif", "change", section="Film"))
    browser.run("document.querySelector('.timeline .key').focus()")
    step(lambda: browser.key("Delete"))
    for before in reversed(states[:-1]):
        browser.run("halflight.store.undo()")
        check(tracks() == before, f"one step back: {tracks()}, not {before}")
        check(browser.run("!document.querySelector('.timeline').hidden"), "the panel stays open")
    for after in states[1:]:
        browser.run("halflight.store.redo()")
        check(tracks() == after, f"one step on: {tracks()}, not {after}")
    shown = browser.run(KEYS)
    check(shown == [[path, frame] for path, frames in json.loads(states[-1])[2] for frame in frames], f"the strip follows: {shown}")
    for _ in states[1:]:
        browser.run("halflight.store.undo()")
    check(tracks() == states[0], "the film is as it was")
    # A step of the scene leaves the view from which a whole turn starts.
    browser.run("(() => { const t = [...document.querySelectorAll('label')].find((l) => l.textContent === 'Whole turn'); document.getElementById(t.htmlFor).click(); })()")
    seek(0)
    browser.run("halflight.store.changeRender('shadows', 'off')")
    browser.run("import('./camera.js').then((m) => halflight.store.setCamera(m.turn(halflight.store.scene.camera, 0.3, 0)))")
    seek(1)
    start = "JSON.stringify(halflight.store.page.film.from)"
    chosen = browser.run(start)
    browser.run("halflight.store.undo()")
    seek(2)
    check(browser.run(start) == chosen, "the turn starts where the camera was put")
    browser.run("halflight.store.undo()")
    open_section(browser, "Session")
    browser.wait("document.querySelector('.timeline').hidden")
    rest(browser)


def film_is_shown(browser):
    """The picture is that of the film's frame, also after undo and redo, and after keys were moved and removed."""
    def seek(frame):
        browser.run(f"(() => {{ const s = document.querySelector('[aria-label=Frame]'); s.value = {frame}; s.dispatchEvent(new Event('input')); }})()")

    def has(value, what):
        now = "halflight.store.scene.lights[0].intensity"
        browser.wait(f"Math.abs({now} - {value}) < 1e-9", timeout=60)
        rest(browser)
        check(abs(browser.run(now) - value) < 1e-9, f"{what}: {browser.run(now)}, not {value}")

    open_section(browser, "Film")
    work = "JSON.stringify([halflight.store.scene.lights, halflight.store.page.film?.tracks])"
    first = browser.run(work)
    while browser.run("document.querySelectorAll('.timeline .key').length") > 0:
        browser.run("document.querySelector('[aria-label^=\"Remove the keys\"]').click()")
    browser.run("(() => { const n = document.querySelector('[aria-label=\"Frames of the film\"]'); n.value = 120; n.dispatchEvent(new Event('change')); })()")
    seek(0)
    set_control(browser, "Intensity", 1)
    press_named(browser, "Add a key of Intensity")
    seek(100)
    set_control(browser, "Intensity", 3)
    press_named(browser, "Add a key of Intensity")
    seek(20)
    has(1.4, "between the keys")
    browser.run("halflight.store.changeRender('shadows', 'off')")
    seek(40)
    has(1.8, "further on")
    undo(browser)
    check(scene_of(browser)["render"]["shadows"] == "hard", "a step of another frame is undone")
    has(1.8, "the picture stays that of its frame")
    seek(60)
    press_named(browser, "Redo")
    check(scene_of(browser)["render"]["shadows"] == "off", "and comes again")
    has(2.2, "at the frame now")
    undo(browser)
    browser.run("document.querySelector('.timeline .key[data-frame=\"100\"]').focus()")
    for _ in range(2):
        browser.key("ArrowLeft", modifiers=8)
    has(2.5, "a key that was moved to frame 80")
    undo(browser)
    undo(browser)
    has(2.2, "and back")
    browser.run("document.querySelector('.timeline .key[data-frame=\"0\"]').focus()")
    browser.key("Delete")
    check(browser.run("document.activeElement.dataset.frame") == "100", "the focus lies on the key that is left")
    has(3, "one key is left")
    browser.key("z", modifiers=2)
    check(browser.run("document.activeElement.dataset.frame") == "100", "and stays there after undo")
    has(2.2, "and there are two again")
    browser.run("halflight.store.changeVolume(0, 'scattering', (v) => ({ ...v, scattering: { anisotropy: 0 } }))")  # as without it
    browser.run("document.querySelector('.viewer').dispatchEvent(new CustomEvent('halflight-key', { detail: { paths: ['volumes.0.scattering.anisotropy', 'lights.1.intensity'] } }))")
    seek(61)
    has(2.22, "a number at its default has a key")
    browser.run("halflight.store.change('remove light', (scene) => ({ ...scene, lights: scene.lights.slice(0, 1) }))")
    seek(62)
    told = browser.run("document.getElementById('message').textContent")
    check(told.endswith("film changes: light 2, intensity."), f"a track of what is there no longer is told: {told}")
    for _ in range(3):
        undo(browser)
    seek(60)
    has(2.2, "without it")
    camera = scene_of(browser)["camera"]["position"]
    away = f"Math.hypot(...halflight.store.scene.camera.position.map((x, k) => x - {json.dumps(camera)}[k]))"
    turn = "(() => { const t = [...document.querySelectorAll('label')].find((l) => l.textContent === 'Whole turn'); document.getElementById(t.htmlFor).click(); })()"
    for act, is_turned in ((lambda: browser.run(turn), True), (lambda: browser.run(turn), False), (lambda: undo(browser), True), (lambda: undo(browser), False)):
        act()
        browser.wait(f"{away} > 0.1" if is_turned else f"{away} < 1e-6", timeout=60)
        rest(browser)
    while browser.run(work) != first:
        check(browser.run("halflight.store.canUndo"), f"undo leads back to the first state, {first}: {browser.run(work)}")
        undo(browser)
    open_section(browser, "Session")
    browser.wait("document.querySelector('.timeline').hidden")
    rest(browser)


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


def shot(browser, name):
    if SHOTS is not None:
        browser.screenshot(f"{SHOTS}/{name}.png")


def saved_json(path):
    """The file that the page saves, once it is there."""
    end = time.monotonic() + 60
    while not os.path.exists(path) or os.path.getsize(path) == 0:  # Firefox keeps its name first
        check(time.monotonic() < end, f"{path} is saved")
        time.sleep(0.05)
    with open(path, encoding="utf-8") as file:
        return json.load(file)


def after_restart(browser, viewer, options):
    """Another viewer on the same port goes on with the page, and with the file that it had opened."""
    browser.run("fetch('open?file=second.nrrd', { method: 'POST' })")  # numbers of the first viewer are not those of the second
    open_section(browser, "Open")
    browser.wait("[...document.querySelectorAll('.files .file')].some((b) => b.textContent === 'second.nrrd')")
    browser.run("[...document.querySelectorAll('.files .file')].find((b) => b.textContent === 'second.nrrd').click()")
    browser.wait("document.title.startsWith('second')")
    rest(browser)
    set_control(browser, "Colours", "viridis", "change")
    rest(browser)
    viewer.interrupt()
    browser.run("halflight.store.changeRender('shadows', 'hard')")
    browser.wait(f"{BANNER} && !{BANNER}.hidden")
    check(browser.run("document.getElementById('stage').textContent") == "failed", "the picture is not the scene's")
    check("Retry" in browser.run(f"{BANNER}.textContent"), "the banner offers to try again")
    check(browser.run("getComputedStyle(document.getElementById('picture')).objectFit") == "cover", "the picture is not stretched into the room that the banner leaves")
    shot(browser, "banner")
    before = browser.run(STATE)
    os.mkdir("lost")
    browser.save_in("lost")
    browser.click(center(browser, ".banner button:last-child"))
    saved = saved_json("lost/second-session.json")
    saved["page"].pop("sections", None)
    check([saved["scene"], saved["marks"], saved["page"]] == json.loads(before), "the session is saved without a viewer")
    low, top = browser.run(f"[{BANNER}.getBoundingClientRect().bottom, document.getElementById('message').getBoundingClientRect().top]")
    check(browser.run("document.getElementById('message').textContent") == "saved second-session.json" and top >= low, f"the page says so below the banner: {top}, {low}")
    with Viewer(PROGRAM, *options) as again:
        check(again.url == viewer.url, f"the same URL: {again.url}")
        browser.click(center(browser, ".banner button"))
        browser.wait(f"{BANNER}.hidden")
        rest(browser)
        check(browser.run(STATE) == before, "all is as it was")
        equals_render(browser, "restarted")
        reload(browser)
        check(browser.run("document.title").startswith("second") and browser.run(STATE) == before, "the opened file, after a reload too")
        problems = [line for line in browser.problems if "ERR_CONNECTION_REFUSED" not in line and "410" not in line]
        check(problems == [], f"the console has errors: {problems}")
        browser.problems.clear()
        files(browser)
        network(browser)


def network(browser):
    """Without a network the banner comes, and goes when the network is back, without a hand."""
    browser.offline(True)
    set_control(browser, "Colours", "viridis", "change")
    browser.wait(f"!{BANNER}.hidden")
    browser.offline(False)
    browser.wait(f"{BANNER}.hidden")
    rest(browser)


def drop(browser, name, text):
    """A file falls on the page."""
    browser.run(f"""(() => {{ const transfer = new DataTransfer(); transfer.items.add(new File([{json.dumps(text)}], {json.dumps(name)}));
      document.querySelector('.viewer').dispatchEvent(new DragEvent('drop', {{ dataTransfer: transfer, bubbles: true, cancelable: true }})); }})()""")


def files(browser):
    """A session as a file brings everything back; a scene of what is open the scene; others are refused in words."""
    os.mkdir("saved")
    browser.save_in("saved")
    work(browser)
    state = json.loads(browser.run(STATE))
    unfolded = "[...document.querySelectorAll('aside details[open] > summary')].map((summary) => summary.textContent).join()"
    browser.wait("halflight.store.page.sections?.Session")
    sections = browser.run(unfolded)
    browser.run("[...document.querySelectorAll('aside button')].find((b) => b.textContent === 'save session').click()")
    session = json.dumps(saved_json("saved/second-session.json"))
    press(browser, "start afresh")
    rest(browser)
    check(json.loads(browser.run(STATE))[1:] == [[], {}], "as it began")
    undo(browser)
    check(json.loads(browser.run(STATE))[1] == state[1], "undo brings back what was done")
    press(browser, "start afresh")
    rest(browser)
    with open("in-list.json", "w", encoding="utf-8") as file:
        file.write(session)
    open_section(browser, "Open")
    browser.reload()
    listed = "[...document.querySelectorAll('.files .file')].find((b) => b.textContent === 'in-list.json')"
    browser.wait(f"globalThis.halflight?.start && {listed} !== undefined")
    browser.run(f"{listed}.click()")
    browser.wait("halflight.store.marks.length === 1", timeout=60)
    rest(browser)
    check(json.loads(browser.run(STATE))[1] == state[1], "a session in the list of files is opened")
    press(browser, "start afresh")
    rest(browser)
    open_section(browser, "Sky")
    browser.wait("halflight.store.page.sections?.Sky")
    drop(browser, "a-session.json", session)
    browser.wait("halflight.store.marks.length === 1")
    rest(browser)
    check(browser.run(unfolded) == sections, f"its sections are unfolded: {browser.run(unfolded)}, not {sections}")
    check(json.loads(browser.run(STATE)) == state, "the session brings all back")
    undo(browser)
    check(json.loads(browser.run(STATE))[1] == [], "as one step")
    changed = json.loads(session)["scene"]
    changed["image"]["background"] = [0.1, 0.2, 0.3]
    drop(browser, "scene.json", json.dumps(changed))
    browser.wait("halflight.store.scene.image.background[2] === 0.3")
    rest(browser)
    for name, text, words in (("a.json", "{", "no JSON"), ("b.json", "[1]", "neither a session nor a scene"), ("c.json", '{"halflight_session": 1}', "neither"),
                              ("d.json", json.dumps({**json.loads(session), "source": "../none.nrrd", "scene": {**changed, "volumes": []}}), "no such file"),
                              ("e.json", json.dumps({**changed, "camera": {"type": "fish"}}), "camera")):
        before = browser.run(STATE)
        drop(browser, name, text)
        browser.wait(f"document.getElementById('message').textContent.includes({json.dumps(words)})")
        check(browser.run(STATE) == before, f"{name} changes nothing")
    damaged = [None, {"cut": {"type": "constructor"}, "at": 0}, {"cut": {"type": "plane", "point": [1, 2]}, "at": 0}, {"cut": {"type": "sphere", "center": [1, 2, 3], "radius": 1}, "at": "0"}]
    hostile = {**json.loads(session), "marks": [{"kind": "<img>", "points": [[0, 0, 0]]}, {"kind": "text", "points": [[0, None, 0]]}, {"kind": "text", "points": [[1, 2, 3]], "text": "<b>"}],
               "page": {"cut": -1, "surface": "0", "aside": {"cut 0": damaged, "sceneCut 0": 7, "all cuts": 3}, "film": {"frames": 1e9, "fps": "2", "frame": -1, "format": "exe", "open": True, "turns": True, "from": {"camera": {}, "image": None},
                                 "tracks": [{"path": "camera", "points": [[0, {"position": 1}]]}, {"path": 7}, None, {"path": "lights.0.intensity", "points": [[2, 1], [9, 3]]}]}}}
    drop(browser, "f.json", json.dumps(hostile))
    browser.wait("halflight.store.marks.length === 1 && halflight.store.marks[0].text === '<b>'")
    rest(browser)
    check(browser.run(KEYS) == [["lights.0.intensity", 2], ["lights.0.intensity", 9]] and browser.run("document.querySelector('[aria-label=\"Frames of the film\"]').value") == "120",
          f"of its film what is right: {browser.run(KEYS)}")
    browser.problems.clear()  # refused requests


def private_tokens(folder):
    """The token that a port keeps is the user's alone; where it is not, it is replaced, and without a private folder none is kept."""
    names = [entry for entry in os.listdir(folder) if entry.startswith("halflight-view-")]
    check(names == [f"halflight-view-{port}"], f"one token is kept: {names}")
    name = names[0]
    check(stat.S_IMODE(os.stat(f"{folder}/{name}").st_mode) == 0o600, "the token's file is the user's alone")
    with Viewer(PROGRAM, "first.nrrd") as free:
        check(f"halflight-view-{free.port}" not in os.listdir(folder), "a free port keeps none")
    with Viewer(PROGRAM, "first.nrrd", "--port", port) as again:
        token = again.token
    with Viewer(PROGRAM, "first.nrrd", "--port", port) as again:
        check(again.token == token, "the port's token")
    for spoil in (lambda path: os.chmod(path, 0o644), lambda path: os.truncate(path, 31), lambda path: [os.unlink(path), os.symlink("/etc/hostname", path)]):
        spoil(f"{folder}/{name}")
        with Viewer(PROGRAM, "first.nrrd", "--port", port) as again:
            check(again.token != token, "a token that others could know is not used")
            token = again.token
        check(stat.S_IMODE(os.lstat(f"{folder}/{name}").st_mode) == 0o600, "the new one is the user's alone")
    with Viewer(PROGRAM, "first.nrrd", "--port", port) as again:
        os.unlink(f"{folder}/{name}")
        refused = subprocess.run([PROGRAM, "view", "--no-browser", "first.nrrd", "--port", port], capture_output=True, text=True, check=False)
        check(refused.returncode != 0 and "is taken" in refused.stderr, f"a second viewer does not get the port: {refused.stderr}")
        check(not os.path.exists(f"{folder}/{name}"), "and does not touch the first one's token")
    os.mkdir(f"{folder}/{name}")
    with Viewer(PROGRAM, "first.nrrd", "--port", port) as again:
        check(len(again.token) == 32 and again.token != token, "a folder of the token's name stays, and the token is a new one")
        token = again.token
    os.rmdir(f"{folder}/{name}")
    os.mkfifo(f"{folder}/{name}", 0o600)
    with Viewer(PROGRAM, "first.nrrd", "--port", port) as again:
        check(again.token != token and stat.S_ISREG(os.lstat(f"{folder}/{name}").st_mode), "a pipe of its name is replaced, and not waited for")
        token = again.token
    os.chmod(folder, 0o755)
    with Viewer(PROGRAM, "first.nrrd", "--port", port) as again:
        check(again.token != token, "none is read or kept in a folder that others can enter")


kind = browser_named(sys.argv[2])
with tempfile.TemporaryDirectory() as place:
    os.chdir(place)
    need_viewer(PROGRAM)
    os.mkdir("runtime", 0o700)
    os.environ["XDG_RUNTIME_DIR"] = os.path.abspath("runtime")
    for made in ("first", "second"):
        subprocess.run([PROGRAM, "make", "rings" if made == "first" else "torus", "--size", "32", "--quiet", "-o", f"{made}.nrrd"], check=True)
    with Viewer(PROGRAM, "first.nrrd") as chosen:
        port = str(chosen.port)
    arguments = ["first.nrrd", "--sheet-spacing", "2", "--shadows", "hard", "--port", port]
    with Viewer(PROGRAM, *arguments) as first, kind(size=(900, 620)) as page:
        page.open(first.url)
        rest(page)
        one_step_a_gesture(page)
        cameras_are_undone(page)
        menus_follow(page)
        steps_change_something(page)
        fields_undo_themselves(page)
        zoom_goes_on(page)
        true_status(page)
        after_reload(page)
        film_after_reload(page)
        film_is_undone(page)
        film_is_shown(page)
        choices_are_undone(page, "Lights", "light", "halflight.store.scene.lights")
        choices_are_undone(page, "Isosurfaces", "isosurface", "halflight.store.scene.volumes[0].iso ?? []")
        choices_are_undone(page, "Cuts", "cut", "halflight.store.scene.volumes[0].cuts ?? []")
        handles_follow_choices(page)
        cuts_that_are_off(page)
        functions_come_back(page)
        check(page.problems == [], f"the console has errors: {page.problems}")
        after_restart(page, first, arguments)
    private_tokens("runtime")
print(f"{checks.count} checks passed")
