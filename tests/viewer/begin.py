#!/usr/bin/env python3
"""The first seconds of the page, what it offers by itself, and how it is handed on: the light that sweeps, looks and light rigs with small
pictures, two pictures side by side, presets of the volume's kind, the switch of all cuts, links, keys of films beside sliders.

usage: begin.py PROGRAM BROWSER
"""
import json
import os
import shutil
import subprocess
import sys
import tempfile

import checks
from checks import check
from firefox import browser_named
from hands import PROGRAM, STAGE, center, changes, open_section, press, press_named, resize, rest, scene_of, set_control
from viewer import Viewer, need_viewer


def sweeps(browser, url):
    """The light moves while the page opens, and comes to rest where the scene has it; not where motion is unwanted."""
    browser.open(url)
    browser.wait(f"{STAGE} !== undefined")
    rest(browser)
    # The first picture comes late, as of a large volume: the animation begins when it is there.
    browser.run("""(() => { const own = window.fetch; window.frames = 0; window.parts = [];
      window.fetch = async (path, options) => {
        if (/^frame\?page=\w+&/.test(path) && window.frames++ === 0) await new Promise((done) => setTimeout(done, 600));
        return own(path, options); }; })()""")
    browser.run("halflight.frames.animate((scene, part) => { parts.push(part); return { ...scene, lights: scene.lights.map((l) => ({ ...l, intensity: part })) }; }, 2000)")
    picture = rest(browser)
    parts = browser.run("parts")
    check(parts[0] == 0 and len(parts) >= 2 and parts == sorted(set(parts)) and parts[-1] < 1, f"frames of an animation: {parts}")
    browser.run("halflight.frames.move()")
    check(rest(browser) == picture, "and then the scene's own")
    part = browser.run("""import('./light.js').then(({ sweptLight, directionOf }) => { const { scene } = halflight.store;
      return [0, 0.5, 1].map((part) => directionOf(sweptLight(scene, part).lights[0], scene.camera)); })""")
    own = browser.run("import('./light.js').then(({ directionOf }) => directionOf(halflight.store.scene.lights[0], halflight.store.scene.camera))")
    check(max(abs(a - b) for a, b in zip(part[2], own)) < 1e-9 and part[0][2] < own[2] - 0.3, f"the sweep ends at the light's own place: {part}, {own}")
    check(all(abs(row[1] - own[1]) < 1e-9 for row in part), "at one height")
    check(not browser.run("halflight.store.canUndo"), "the sweep is no step of the history")


def coarse_first(browser):
    """The first picture of a large volume has sheets so far apart that a copy of 128^3 voxels or fewer suits them; that of a small one has not."""
    spacings = browser.run("""import('./frames.js').then(async ({ Frames }) => {
      const { scene } = halflight.store, first = (side) => new Promise((resolve) => {
        const store = { scene: { ...scene, volumes: scene.volumes.slice(0, 1) }, listen() {} };
        const channel = { fetchFrame: async (asked) => { resolve(asked.render.sheet_spacing); frames.end(); return null; } };
        const start = { volumes: [{ dimensions: [side, side, side], axes: [[1, 0, 0], [0, 1, 0], [0, 0, 1]] }] };
        const frames = new Frames({ store, start, channel }, document.createElement('canvas'), () => {});
        frames.move();
      });
      return [await first(64), await first(512), await first(1024)]; })""")
    check(spacings[1] == 4 and spacings[2] == 8, f"512^3 and 1024^3 voxels: {spacings}")
    check(spacings[0] < 2, f"64^3 voxels: {spacings}")


def pictures_of(browser, label):
    return f"[...document.querySelectorAll('[aria-label={json.dumps(label)}] canvas')]"


def compared_with_before(browser, button, volumes):
    """One click in the panel shows the look before beside this one, the next click ends that."""
    browser.run("(() => { const own = window.fetch; window.beside = []; window.fetch = (path, options) => { if (/^frame\\?page=\\w+-compared&/.test(path)) beside.push(options.body); return own(path, options); }; })()")
    making = "getComputedStyle(document.querySelector('.side'), '::after').content.includes('being made')"
    browser.run(f"{button}.click()")
    check(browser.run(f"document.querySelector('.compared').hidden === {making}"), "as long as the other picture is made, the page says so")
    browser.run("window.fetchNow = window.fetch, window.fetch = async (path, ...more) => { if (path.includes('-compared&')) await new Promise((go) => { window.goOn = go; }); return fetchNow(path, ...more); }, 0")
    browser.run("import('./camera.js').then((m) => halflight.store.setCamera(m.turn(halflight.store.scene.camera, 0.1, 0)))")
    browser.wait("window.goOn !== undefined")
    check(browser.run(f"document.querySelector('.compared').hidden && {making}"), "also after another view")
    browser.run("window.fetch = fetchNow, goOn(), 0")
    browser.wait("!document.querySelector('.compared').hidden")
    check(not browser.run(making), "it is made")
    browser.run("halflight.store.undoCamera()")
    rest(browser)
    check(json.loads(browser.run("beside.at(-1)"))["volumes"] == volumes, "the other picture has the look before")
    check(browser.run("[...document.querySelectorAll('.side')].map((s) => s.textContent)") == ["before", "now"], "both sides are named")
    check(browser.run(f"{button}.getAttribute('aria-pressed')") == "true", "the button says so")
    browser.run(f"{button}.click()")
    check(browser.run("document.querySelector('.compared').hidden && document.querySelector('.divider').hidden"), "it ends")


def looks(browser):
    """Each look has a small picture of this volume, which differ; a click takes the look, one undo the one before."""
    open_section(browser, "Looks")
    browser.wait(f"{pictures_of(browser, 'Looks')}.every((canvas) => canvas.dataset.drawn === '')")
    names = browser.run("[...document.querySelectorAll('[aria-label=Looks] button')].map((b) => b.textContent)")
    check({"surface", "translucent", "mip"} <= set(names), f"the program's looks: {names}")
    drawn = browser.run(f"""{pictures_of(browser, 'Looks')}.map((canvas) =>
      canvas.getContext('2d').getImageData(0, 0, 112, 80).data.reduce((sum, x) => sum + x, 0))""")
    check(len(set(drawn)) >= 4, f"pictures differ: {drawn}")
    before, camera = scene_of(browser)["volumes"], scene_of(browser)["camera"]
    browser.wait("document.querySelector('[aria-label=Looks] [aria-pressed=true]')?.textContent === 'auto'")  # what it began with
    beside = "document.querySelector('[aria-label=Looks] + .row button')"
    check(browser.run(f"{beside}.disabled"), "there is nothing before to compare with")
    press(browser, "translucent")
    browser.wait("halflight.store.canUndo")
    rest(browser)
    compared_with_before(browser, beside, before)
    check(scene_of(browser)["volumes"] != before and scene_of(browser)["camera"] == camera, "the look is taken, from the same view")
    browser.wait("document.querySelector('[aria-label=Looks] [aria-pressed=true]')?.textContent === 'translucent'")
    press_named(browser, "Undo")
    rest(browser)
    check(scene_of(browser)["volumes"] == before, "undone in one step")
    check(browser.run("document.querySelector('[aria-label=Looks] [aria-pressed=true]')?.textContent") != "translucent", "and the panel follows")


def looks_follow(browser):
    """The small pictures follow cuts as soon as the picture rests: each is asked for once. One that is being made when something moves is given up. The view and marks make none anew."""
    browser.run("""(() => { const own = window.fetch; window.small = []; window.fetch = (path, options) => {
      if (/^frame\\?page=\\w+-small&/.test(path)) small.push(halflight.frames.statistics.stage); return own(path, options); }; })()""")
    drawn = f"""{pictures_of(browser, 'Looks')}.map((canvas) => canvas.getContext('2d').getImageData(0, 0, 112, 80).data.reduce((sum, x, n) => (sum * 31 + x * n) % 1000003, 7))"""
    count = browser.run(f"{pictures_of(browser, 'Looks')}.length")

    def follow(what, act):
        browser.run("small.length = 0")
        before = browser.run(drawn)
        act()
        rest(browser)
        after, asked = browser.run(drawn), browser.run("small")
        check(all(one != other for one, other in zip(before, after)), f"{what}: each picture is another one: {before}, {after}")
        check(len(asked) == count and set(asked) == {"final"}, f"{what}: each is made once, at rest: {asked}")

    middle = "halflight.start.volumes[0].axes.reduce((point, axis, a) => point.map((x, k) => x + (axis[k] * halflight.start.volumes[0].dimensions[a]) / 2), halflight.start.volumes[0].origin)"
    follow("a cut", lambda: browser.run(f"halflight.store.changeVolume(0, 'cuts', (v) => ({{ ...v, cuts: [{{ type: 'plane', point: {middle}, normal: halflight.store.scene.camera.position.map((x, k) => x - halflight.store.scene.camera.target[k]) }}] }}))"))
    check(browser.run("document.querySelector('[aria-label=Looks] [aria-pressed=true]')?.textContent") == "auto", "the look is still the one it was")
    x, y = center(browser, "#view")
    browser.run("small.length = 0")
    browser.drag([x - 90, y + 60], [x + 60, y + 90], 12)
    rest(browser)
    browser.run("halflight.store.setMarks('test', [{ kind: 'text', points: [[0, 0, 0]], text: 'here' }])")
    rest(browser)
    check(browser.run("small") == [], "another view and a mark change no small picture")
    browser.run("halflight.store.undoCamera()")
    press_named(browser, "Undo")
    browser.run("halflight.store.changeVolume(0, 'cuts', (v) => ({ ...v, cuts: [{ ...v.cuts[0], normal: v.cuts[0].normal.map((x) => -x) }] }))")
    browser.wait("small.length > 0")
    browser.drag([x - 90, y + 60], [x + 60, y + 90], 12)
    rest(browser)
    asked = browser.run("small")
    check(set(asked) == {"final"} and count <= len(asked) <= count + 1, f"none is begun while something moves, and the one under way once more: {asked}")
    browser.run("""(() => { const own = window.fetch; window.held = []; small.length = 0; window.fetch = async (path, options) => {
      if (path.startsWith('scene?') && window.goOn !== true) { held.push(path); await new Promise((go) => { window.letGo = go; }); }
      return own(path, options); }; window.goOn = false; })()""")
    browser.run("halflight.store.changeVolume(0, 'cuts', (v) => ({ ...v, cuts: [{ ...v.cuts[0], normal: v.cuts[0].normal.map((x) => -x) }] }))")
    browser.wait("held.length > 0")
    browser.run("import('./camera.js').then((m) => { halflight.store.setCamera(m.turn(halflight.store.scene.camera, 0.1, 0)); goOn = true; letGo(); })")
    rest(browser)
    asked = browser.run("small")
    check(asked == ["final"] * count, f"a look that comes while something moves waits for the rest: {asked}")
    press_named(browser, "Undo")
    browser.run("halflight.store.undoCamera()")
    for _ in range(2):
        press_named(browser, "Undo")
    rest(browser)


def projection_of_surfaces(browser):
    """A volume with an isosurface becomes a maximum projection, which has none, in one step."""
    with_surface = "({ ...scene, volumes: scene.volumes.map((volume) => ({ ...volume, iso: [{ value: 100, color: [1, 1, 1], opacity: 1 }] })) })"
    browser.run(f"halflight.store.change('iso', (scene) => {with_surface})")
    rest(browser)
    before = scene_of(browser)["volumes"]
    press(browser, "mip")
    browser.wait("halflight.store.scene.render.compositing === 'maximum'")
    rest(browser)
    check("iso" not in scene_of(browser)["volumes"][0], "the isosurface has gone")
    press_named(browser, "Undo")
    rest(browser)
    check(scene_of(browser)["volumes"] == before, "undone in one step")
    press_named(browser, "Undo")
    rest(browser)


def rigs(browser):
    """Four rigs; one after the other is as bright as from the beginning."""
    open_section(browser, "Lights")
    names = browser.run("halflight.start.rigs")
    check(names == ["studio", "raking", "rim", "overcast"], f"four rigs: {names}")
    browser.wait(f"{pictures_of(browser, 'Light rigs')}.every((canvas) => canvas.dataset.drawn === '')")
    first = scene_of(browser)["lights"]
    columns = browser.run("""import('./gallery.js').then(({ evenColumns }) => [evenColumns(4, 315), evenColumns(4, 250), evenColumns(7, 315), evenColumns(5, 320), evenColumns(3, 900), evenColumns(2, 50)])""")
    check(columns == [4, 2, 4, 3, 3, 1], f"rows are as even as the width allows: {columns}")
    rows = browser.run("""[...document.querySelectorAll('[aria-label="Light rigs"] button')].map((b) => b.getBoundingClientRect()).map(({ top, left }) => [Math.round(top), Math.round(left)])""")
    check(len({top for top, _ in rows}) == 1 and len({left for _, left in rows}) == 4, f"four rigs lie in one row: {rows}")

    def take(name):
        before = scene_of(browser)["lights"]
        press(browser, name)
        browser.wait(f"JSON.stringify(halflight.store.scene.lights) !== {json.dumps(json.dumps(before, separators=(',', ':')))}")
        browser.wait(f"document.querySelector('[aria-label=\"Light rigs\"] [aria-pressed=true]')?.textContent === {json.dumps(name)}")
        return scene_of(browser)["lights"]

    studio = take("studio")
    check(len(studio) == 3 and studio != first, "lights of a studio")
    take("overcast")
    check(take("studio") == studio, "as bright as at first")
    for _ in range(3):
        press_named(browser, "Undo")
    check(scene_of(browser)["lights"] == first, "a step each")
    rest(browser)


def two_pictures(browser):
    """Left of a line the picture without shadows; the line is dragged and moved by keys."""
    set_control(browser, "Compare", "off", "change")
    browser.wait("!document.querySelector('.compared').hidden && !document.querySelector('.divider').hidden")
    differ = browser.run("""(() => { const [a, b] = ['.compared', '#picture'].map((name) => { const c = document.querySelector(name);
      return c.getContext('2d').getImageData(0, 0, c.width, c.height).data; });
      return a.length === b.length ? a.reduce((sum, x, n) => sum + Math.abs(x - b[n]), 0) / a.length : -1; })()""")
    check(differ > 0.2, f"shadows make a difference: {differ}")
    check(browser.run("[...document.querySelectorAll('.side')].map((s) => s.textContent)") == ["without shadows", "soft shadows"], "both sides are named")
    size = browser.run("[innerWidth, innerHeight]")
    resize(browser, 390, 844)
    browser.run("document.querySelector('.side').setAttribute('data-making', '')")  # the longest name
    inside = browser.run("""(() => { const view = document.getElementById('view').getBoundingClientRect();
      return [...document.querySelectorAll('.side')].every((side) => { const b = side.getBoundingClientRect(); return b.left >= view.left && b.right <= view.right; }); })()""")
    check(inside, "names have room in a narrow picture")
    browser.run("document.querySelector('.divider').focus()")
    for key in ["ArrowLeft"] * 4 + ["ArrowRight"] * 4:
        browser.key(key)
        browser.run("document.querySelector('.side').setAttribute('data-making', '')")
        browser.run("halflight.report('saved a file with a long name.json')")
        clear = browser.run("document.querySelector('#message').getBoundingClientRect().top - Math.max(...[...document.querySelectorAll('.side')].map((side) => side.getBoundingClientRect().bottom))")
        check(clear > 0, f"a message is below the names, by {clear}")
    browser.run("document.querySelector('#message').hidden = true")
    resize(browser, *size)
    browser.wait("!document.querySelector('.compared').hidden")
    x, y = center(browser, ".divider")
    browser.drag([x, y], [x - 90, y + 5])
    at = browser.run("+document.querySelector('.divider').getAttribute('aria-valuenow')")
    check(at < 50, f"dragged to {at}")
    browser.run("document.querySelector('.divider').focus()")
    browser.key("ArrowRight")
    check(browser.run("+document.querySelector('.divider').getAttribute('aria-valuenow')") == at + 5, "moved by a key")
    browser.run("import('./camera.js').then((m) => halflight.store.setCamera(m.turn(halflight.store.scene.camera, 0.2, 0)))")
    check(browser.run("document.querySelector('.compared').hidden"), "the other picture is not shown for another view")
    browser.wait("!document.querySelector('.compared').hidden")
    set_control(browser, "Compare", "", "change")
    check(browser.run("document.querySelector('.compared').hidden && document.querySelector('.divider').hidden"), "it ends")
    press(browser, "keep")
    changes(browser, "no shadows", lambda: browser.run("halflight.store.changeRender('shadows', 'off')"), "render")
    set_control(browser, "Compare", "kept", "change")
    browser.wait("!document.querySelector('.compared').hidden")
    check(browser.run("[...document.querySelectorAll('.side')].map((s) => s.textContent)") == ["kept before", "now"], "what was kept, and now")
    set_control(browser, "Compare", "", "change")
    press_named(browser, "Undo")
    rest(browser)


def links(browser, url):
    """A link holds what was changed, and no names of files; the page of another tab shows the same."""
    browser.run("halflight.store.changeLight(0, 'intensity', (l) => ({ ...l, intensity: 0.75 }))")
    rest(browser)
    link = browser.run("import('./link.js').then((m) => m.linkOf(halflight.store, halflight.start))")
    check(link.startswith("#view=") and len(link) < 700, f"a short link: {len(link)}")
    told = browser.run(f"""(async () => {{ const bytes = Uint8Array.from(atob({json.dumps(link[6:])}.replaceAll('-', '+').replaceAll('_', '/')), (c) => c.charCodeAt(0));
      return new Response(new Blob([bytes]).stream().pipeThrough(new DecompressionStream('deflate-raw'))).text(); }})()""")
    check("ball" not in told, f"it names no file: {told}")
    wanted = scene_of(browser)
    browser.run("sessionStorage.clear(); window.onpagehide = null; 0")
    browser.run("halflight.store.replace({ scene: halflight.start.scene, marks: [], page: {} })")
    check(scene_of(browser)["lights"] != wanted["lights"], "the beginning again")
    browser.run(f"location.hash = {json.dumps(link)}")
    browser.wait("halflight.store.scene.lights[0].intensity === 0.75")
    now = scene_of(browser)
    check(now["lights"] == wanted["lights"], "the lights of the link")
    far = max(abs(a - b) for a, b in zip(now["camera"]["position"], wanted["camera"]["position"]))
    check(far < 1e-6 * max(map(abs, wanted["camera"]["position"])), f"its view: {far}")
    check(browser.run("location.hash") == "", "the address is clean again")
    for bad in ("#view=!!", "#view=" + link[6:20], "#view=e30", "#view="):
        before = scene_of(browser)
        browser.run(f"halflight.followLink({json.dumps(bad)})")
        check(scene_of(browser)["volumes"] == before["volumes"], f"{bad}: is refused, or changes nothing")
    rest(browser)


def keys_beside_sliders(browser):
    """While the panel of films is open, a button beside a slider adds a key of its number."""
    check(browser.run("[...document.querySelectorAll('.key-here')].every((b) => b.offsetParent === null)"), "unseen before")
    browser.run("document.querySelectorAll('details').forEach((d) => { d.open = ['Film', 'Lights', 'View', 'Volume'].includes(d.querySelector('summary').textContent); })")
    browser.wait("document.querySelector('.viewer').classList.contains('filming')")
    check("clip" not in scene_of(browser)["volumes"][0] and "exposure" not in scene_of(browser)["image"], "numbers that the scene does not name")
    frame = "document.querySelector('[aria-label=Frame]').getBoundingClientRect().y"
    low = browser.run(frame)
    for name in ("Add a key of Intensity", "Add a key of Exposure", "key of the light's place now", "Add a key of Specular", "Add a key of clip x"):
        press_named(browser, name)
    check(browser.run(frame) == low, "the slider of frames stays where it is while tracks are added")
    tracks = browser.run("[...document.querySelectorAll('.track-name')].map((n) => n.textContent)")
    check(tracks == ["light 1, intensity", "image exposure", "light 1, direction", "volume 1, material specular", "volume 1, clip min x", "volume 1, clip max x"],
          f"tracks: {tracks}; {browser.run('document.getElementById(`message`).textContent')}")
    press_named(browser, "Undo")
    check(browser.run("document.querySelectorAll('.track-name').length") == 4 and "clip" not in scene_of(browser)["volumes"][0], "one step takes the key back, and what it has named")
    missing = browser.run("[...document.querySelectorAll('aside input[type=range]')].filter((e) => e.closest('details').firstElementChild.textContent !== 'Slices' && !e.closest('.row')?.querySelector('.key-here')).map((e) => e.labels[0]?.textContent)")
    check(missing == ["Sub-lights", "Smooth edges"], f"each slider of a number that can change from frame to frame has a key: {missing}")
    browser.run("document.querySelectorAll('details').forEach((d) => { d.open = false; })")


def points_in_order(browser):
    """Points that lie beyond the volume's range keep their order when the first of them is dragged into it."""
    moved = browser.run("""import('./transfer_function.js').then((m) => { const tf = { opacity: [[-3000, 0], [-2000, 0.1], [50, 0.5], [4000, 1], [5000, 1]], color: [] };
      return [[0, 10], [0, -9000], [4, 100], [4, 1e9]].map(([n, value]) => m.movePoint(tf, n, value, 0.3, [0, 255]).opacity.map((p) => p[0])); })""")
    check(all(row == sorted(row) for row in moved), f"in order: {moved}")
    check(moved[0][0] == -2000 and moved[1][0] == -3000 and moved[3][4] == 5000, f"as far as the neighbour, or where it was: {moved}")


def cuts_of_the_program(browser, url):
    """What the program has cut away by itself is said below the picture, and one click brings it back."""
    browser.open(url)
    rest(browser)
    browser.problems.clear()  # the page before has lost its viewer
    cuts = scene_of(browser)["volumes"][0]["cuts"]
    resize(browser, 820, 600)
    check(browser.run("""(() => {
      const note = document.querySelector('.note'), range = document.createRange(), { paddingLeft, paddingRight } = getComputedStyle(note);
      range.selectNodeContents(note);
      return range.getBoundingClientRect().width <= note.clientWidth - parseFloat(paddingLeft) - parseFloat(paddingRight) + 0.01; })()"""), "the button shows all of its text on a tablet")
    resize(browser, 900, 600)
    rest(browser)
    note = "document.querySelector('.note')"
    check("show what holds it" in browser.run(f"{note}.textContent") and str(len(cuts)) in browser.run(f"{note}.textContent"), "it is said")
    changes(browser, "show what was cut away", lambda: browser.run(f"{note}.click()"), "volumes")
    check("cuts" not in scene_of(browser)["volumes"][0], "nothing is cut")
    changes(browser, "cut again", lambda: browser.run(f"{note}.click()"), "volumes")
    check(scene_of(browser)["volumes"][0]["cuts"] == cuts, "as before")
    browser.run("document.getElementById('view').focus()")
    changes(browser, "by the key", lambda: browser.key("k"), "volumes")
    changes(browser, "by the switch", lambda: set_control(browser, "All cuts", ""), "volumes")
    check(scene_of(browser)["volumes"][0]["cuts"] == cuts, "the same cuts")
    groups = browser.run("[...document.querySelectorAll('optgroup')].map((g) => g.label)")
    check(groups == ["suited to scanned body", "for other volumes"], f"presets of its kind come first: {groups}")


def real_head():
    """A head in a scanner, at a quarter of its resolution; None where there are no real volumes."""
    data = os.environ.get("HALFLIGHT_DATA", os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../../shared/data"))
    path = os.path.join(data, "cranium_mha/cranium.mha")
    if not os.path.exists(path):
        return None
    subprocess.run([PROGRAM, "convert", path, "head.nrrd", "--shrink", "4", "--quiet"], check=True)
    return "head.nrrd"


def opened_panels_are_seen(browser):
    """A click on the last panel's title shows what is in it, though the side bar was full."""
    resize(browser, 900, 600)
    title = "[...document.querySelectorAll('aside .section > summary')].findLast((one) => one.offsetParent)"
    browser.run(f"document.querySelectorAll('aside .section').forEach((one) => {{ one.open = one.querySelector('summary').textContent === 'Looks'; }}); {title}.scrollIntoView({{ block: 'end' }})")
    browser.run("new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))")
    box = browser.run(f"(({{ x, y, width, height }}) => [x + width / 2, y + height / 2])({title}.getBoundingClientRect())")
    browser.click(box)
    browser.wait(f"{title}.parentElement.open")
    browser.run("new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))")
    seen = "(() => { const part = %s.parentElement.getBoundingClientRect(), bar = document.querySelector('aside').getBoundingClientRect(); return part.bottom <= bar.bottom + 1 || part.top <= bar.top + 1; })()" % title
    check(browser.run(seen), "the panel is in view")
    browser.click(browser.run(f"(({{ x, y, width, height }}) => [x + width / 2, y + height / 2])({title}.getBoundingClientRect())"))
    rest(browser)


name = sys.argv[2]
if shutil.which(name) is None:
    print(f"{name} is not installed")
    sys.exit(77)
with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    need_viewer(PROGRAM)
    subprocess.run([PROGRAM, "make", "rings", "--size", "32", "--quiet", "-o", "ball.nrrd"], check=True)
    head = real_head()
    with browser_named(name)(name, (900, 600)) as browser:
        with Viewer(PROGRAM, "ball.nrrd") as viewer:
            sweeps(browser, viewer.url)
            coarse_first(browser)
            points_in_order(browser)
            looks(browser)
            looks_follow(browser)
            projection_of_surfaces(browser)
            rigs(browser)
            two_pictures(browser)
            links(browser, viewer.url)
            keys_beside_sliders(browser)
            opened_panels_are_seen(browser)
            check(browser.problems == [], f"the console has errors: {browser.problems}")
        if head is not None:
            with Viewer(PROGRAM, head) as viewer:
                cuts_of_the_program(browser, viewer.url)
        check(browser.problems == [], f"the console has errors: {browser.problems}")
        print(f"{checks.count} checks passed{'' if head else ', without a real head'}")
