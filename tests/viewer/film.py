#!/usr/bin/env python3
"""Films in a headless Chromium or Firefox: keys and the timeline are kept over a reload and are steps of the history, and the picture is that of the
film's frame.

usage: film.py PROGRAM chromium|firefox-esr
"""
import json
import math

from checks import check
from hands import KEYS, STATE, center, final_picture, on_rings, open_section, press, press_named, reload, resize, rest, scene_of, set_control, undo


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
    steps = "halflight.store.history[0].length"
    first, count, frame = browser.run(work), browser.run(steps), browser.run("halflight.store.page.film.frame")
    while browser.run("document.querySelectorAll('.timeline .key').length") > 0:
        browser.run("document.querySelector('[aria-label^=\"Remove the keys\"]').click()")
    browser.run("(() => { const n = document.querySelector('[aria-label=\"Frames of the film\"]'); n.value = 120; n.dispatchEvent(new Event('change')); })()")
    seek(0)
    set_control(browser, "Intensity", 1)
    press_named(browser, "Add a key of Intensity")
    seek(100)
    set_control(browser, "Intensity", 3)
    press_named(browser, "Add a key of Intensity")
    rest(browser)
    browser.run("globalThis.asked = fetch, globalThis.fetch = async (...all) => { await globalThis.held; return asked(...all); }, globalThis.held = new Promise((go) => { globalThis.goOn = go; }), 0")
    seek(20)
    check(browser.run("document.getElementById('stage').dataset.stage") == "waiting", "the picture is not final as long as the frame's scene is still to come")
    browser.run("globalThis.held = null, goOn(), 0")
    has(1.4, "between the keys")
    shadows = "halflight.store.scene.render.shadows"
    for place, act, value, back in ((30, lambda: browser.run("halflight.store.changeRender('shadows', 'soft')"), 1.6, 1.6), (50, lambda: set_control(browser, "Intensity", 2.5), 2.5, 2)):
        browser.run("globalThis.held = new Promise((go) => { globalThis.goOn = go; }), 0")
        before = browser.run(shadows)
        seek(place)
        act()
        changed = browser.run(shadows)
        browser.run("globalThis.held = null, goOn(), 0")
        has(value, f"a change while the scene of frame {place} is coming")
        check(browser.run(shadows) == changed, "and the change is seen")
        undo(browser)
        has(back, "the change undone, at the same frame")
        check(browser.run(shadows) == before, "without the change")
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
    while browser.run(steps) > count:
        undo(browser)
        rest(browser)
    seek(frame)
    rest(browser)
    check(browser.run(work) == first, f"undo leads back to the first state, {first}: {browser.run(work)}")
    open_section(browser, "Session")
    browser.wait("document.querySelector('.timeline').hidden")
    rest(browser)


def lights_turn(browser):
    """One key holds a light's place. Between two keys the light turns about what it shines on, also where it comes from the other side; a film of an earlier version does the same."""
    def direction():
        return scene_of(browser)["lights"][0]["direction"]

    def seek(frame):
        browser.run(f"(() => {{ const s = document.querySelector('[aria-label=Frame]'); s.value = {frame}; s.dispatchEvent(new Event('input')); }})()")
        rest(browser)

    def degrees(a, b):
        return math.degrees(math.acos(max(-1, min(1, sum(x * y for x, y in zip(a, b)) / math.hypot(*a) / math.hypot(*b)))))

    def half_way(what):
        seek(50)
        angles = [degrees(direction(), end) for end in ends]
        check(all(abs(angle - 60) < 1e-3 for angle in angles), f"{what}: in the middle of 120 degrees: {angles}")
        check(abs(math.hypot(*direction()) - 1) < 1e-6, f"{what}: a direction: {direction()}")

    browser.run("halflight.store.setFilm({ tracks: [], frames: 120, fps: 30, turns: false, frame: 0, format: 'mp4', open: true })")
    open_section(browser, "Film")
    ends = [[-1, 0, 0], [0.5, 0, -math.sqrt(0.75)]]
    for frame, end in zip((0, 100), ends):
        seek(frame)
        browser.run(f"halflight.store.changeLight(0, 'place', ({{ frame, ...light }}) => ({{ ...light, direction: {json.dumps(end)} }}))")
        press(browser, "key of the light's place now")
    check(browser.run("[...document.querySelectorAll('.track-name')].map((n) => n.textContent)") == ["light 1, direction"], "one track")
    check(browser.run(KEYS) == [["lights.0.direction", 0], ["lights.0.direction", 100]], f"two keys: {browser.run(KEYS)}")
    half_way("one key each")
    options = browser.run("[...document.querySelectorAll('#film-paths option')].map((o) => o.value).filter((v) => v.startsWith('lights.0.direction'))")
    check(options == ["lights.0.direction"], f"its numbers are not offered: {options}")
    old = [{"path": f"lights.0.direction.{k}", "points": [[0, ends[0][k]], [100, ends[1][k]]]} for k in range(3)]
    browser.run(f"halflight.store.setFilm({{ ...halflight.store.page.film, tracks: {json.dumps(old)} }})")
    check(browser.run(KEYS) == [["lights.0.direction", 0], ["lights.0.direction", 100]], f"an earlier film: {browser.run(KEYS)}")
    seek(20)
    half_way("an earlier film")


if __name__ == "__main__":
    on_rings(film_after_reload, film_is_undone, film_is_shown, lights_turn)
