#!/usr/bin/env python3
"""What the page says and shows of itself, in a headless Chromium or Firefox: the progress of a picture never falls, counts reach their end, and edges of
controls are seen.

usage: said.py PROGRAM chromium|firefox-esr
"""
import json
import os
import subprocess
import sys
import tempfile

import checks
from checks import check
from dicom_files import dicom_slice
from firefox import browser_named
from hands import PROGRAM, open_section, resize, rest, set_control
from seen import LEAST_CONTRAST, edges_are_seen, in_window
from viewer import Viewer, need_viewer

# A line of its own, whose channel gives one answer after the other; the last one stays.
LINE = """(async () => {
  const { statusLine } = await import('./status.js'), place = document.createElement('div');
  place.innerHTML = '<span id="stage"></span><span id="progress"></span><span id="statistics"></span>';
  const find = (id) => place.querySelector('#' + id);
  const line = statusLine(find, { progress: async () => { const answer = window.answers[0]; window.asked++; return answer; } });
  const show = (stage, state) => line.show({ stage, state, bytes: 0 });
  Object.assign(window, { answers: [], asked: 0, tells: show, ends: line.end, told: () => find('progress').textContent });
})()"""


def told(browser, part, stage="picture"):
    """What the line says when the picture's progress is this."""
    browser.run(f"window.answers = [{json.dumps({'part': part, 'stage': stage, 'others': 0})}]; window.before = asked; 0")
    browser.wait("asked >= before + 2")  # the first one may have been under way
    return browser.run("told()")


def percent(text):
    return int(text.split(" %")[0]) if "%" in text else 0


def progress_rises(browser):
    """Of all pictures on the way to the final one of a state, and of what is made before each, the line tells one part, which rises."""
    browser.run(LINE)
    lines = []
    for picture, ways in (("moving", [(0.1, "picture"), (0.9, "picture"), (0.2, "picture")]), ("settling", [(0, "picture"), (0.81, "picture")]),
                          ("refining", [(0, "picture"), (0.5, "labels"), (0.97, "labels"), (0.3, "sky"), (0, "picture"), (0.56, "picture"), (1, "picture")])):
        browser.run(f"tells('{picture}', 1)")
        lines += [told(browser, *way) for way in ways]
    parts = [percent(line) for line in lines]
    check(parts == sorted(parts) and parts[0] > 0 and parts[-1] == 99, f"the part rises up to the picture: {lines}")
    check(len(set(parts)) > 7, f"each picture and each thing takes a part of the way: {lines}")
    check([line for line in lines if "smoothing labels" in line] == lines[6:8] and "light of the sky" in lines[8], f"and what is made is said: {lines}")
    browser.run("tells('final', 1)")
    check(browser.run("told()") == "", "no progress of a picture that is there")
    browser.run("tells('moving', 2)")
    check(0 < percent(told(browser, 0.5)) < parts[-1], "another state begins anew")
    browser.run("ends()")
    browser.run("tells('moving', 3)")
    asked = browser.run("asked")
    browser.run("new Promise((done) => setTimeout(done, 1500))")
    check(browser.run("asked") <= asked + 1, "a page that shows another file asks no more; one question may have been under way")


def awaited_states(browser):
    """From the click on a look, or on "Show all", no picture is called final until the scene that was asked for is there and drawn."""
    browser.run("""(() => { const own = window.fetch; window.fetch = async (...all) => { if (/^scene/.test(String(all[0]))) await window.held; return own(...all); }; })()""")
    for act in ("[...document.querySelectorAll('.choice')].find((b) => b.textContent === 'xray').click()", "document.getElementById('reset').click()"):
        browser.run("window.held = new Promise((go) => { window.release = go; }); 0")
        said = browser.run(f"({act}, document.getElementById('stage').textContent)")
        check(said == "waiting", f"at the click: {said}")
        browser.run("window.release()")
        rest(browser)
        browser.wait("document.getElementById('stage').textContent === 'final'")
    browser.run("document.getElementById('undo').click()")
    rest(browser)


def frames_are_counted(browser):
    """The last frame of a film is as many as the film has."""
    open_section(browser, "Film")
    browser.run("(() => { const n = document.querySelector('[aria-label=\"Frames of the film\"]'); n.value = 8; n.dispatchEvent(new Event('change')); })()")
    count = "document.querySelector('.time').textContent.split(' · ')[0]"
    browser.run("(() => { const s = document.querySelector('[aria-label=Frame]'); s.value = 0; s.dispatchEvent(new Event('input')); })()")
    browser.wait(f"{count} === '1 of 8'")
    browser.run("(() => { const s = document.querySelector('[aria-label=Frame]'); s.value = s.max; s.dispatchEvent(new Event('input')); })()")
    browser.wait(f"{count} === '8 of 8'")
    check(browser.run("document.querySelector('[aria-label=Frame]').getAttribute('aria-valuetext')") == "frame 8 of 8", "the slider says it, too")


def press_in_list(browser, text):
    browser.wait(f"[...document.querySelectorAll('.files button')].some((b) => b.textContent === {json.dumps(text)})")
    browser.run(f"[...document.querySelectorAll('.files button')].find((b) => b.textContent === {json.dumps(text)}).scrollIntoView({{ block: 'center' }})")
    browser.click(browser.run(f"""(() => {{ const b = [...document.querySelectorAll('.files button')].find((x) => x.textContent === {json.dumps(text)}).getBoundingClientRect();
      return [b.x + b.width / 2, b.y + b.height / 2]; }})()"""))


def warnings_are_told(browser):
    """What the program says of a file that is opened, or of what it draws over a picture, is on the page: in passing, and beside the switch."""
    open_section(browser, "Open")
    press_in_list(browser, "bare.nrrd")
    browser.wait("halflight.start.title === 'bare.nrrd'")
    check(browser.run("document.getElementById('title').title") == "bare.nrrd", "the whole name is told where it is cut")
    told = browser.run("document.getElementById('message').textContent")
    check("bare.nrrd" in told and "little-endian is assumed" in told, f"of the file: {told}")
    rest(browser)
    note = "the legend finds no room in the picture and is left out"
    browser.run("""(() => { const own = window.fetch; window.fetch = async (...all) => {
      const answer = await own(...all);
      return window.note && String(all[0]).startsWith('overlay') ? new Response(await answer.blob(), { headers: { 'Halflight-Note': encodeURIComponent(window.note) } }) : answer; }; })()""")
    browser.run(f"window.note = {json.dumps(note)}; 0")
    set_control(browser, "Legend", "")
    said = "[...document.querySelectorAll('aside [role=status]')].filter((e) => !e.hidden && e.closest('details').firstElementChild.textContent === 'Save').map((e) => e.textContent)"
    browser.wait(f"JSON.stringify({said}) === {json.dumps(json.dumps([note]))}")
    check(browser.run("document.getElementById('message').textContent") == note, "and over the picture")
    browser.run("window.note = ''; 0")
    set_control(browser, "Axes", "arrows", "change")
    browser.wait(f"{said}.length === 0")
    set_control(browser, "Axes", "none", "change")
    set_control(browser, "Legend", "")
    rest(browser)


def series_of_a_folder(browser):
    """A folder of DICOM files without endings is opened from the list. Of its two series the page says which it shows, and opens the other one."""
    open_section(browser, "Open")
    press_in_list(browser, "patient ›")
    press_in_list(browser, "scans ›")
    browser.wait("document.querySelector('[aria-label=\"Files and folders\"]').textContent.includes('the folder may hold DICOM')")
    press_in_list(browser, "open as one volume")
    browser.wait("halflight.start.title === 'scans'")
    check("is shown, one of 2 series" in browser.run("document.getElementById('message').textContent"), "the message says that there are two")
    rest(browser)
    open_section(browser, "Open")
    browser.wait("[...document.querySelectorAll('.files button')].some((b) => b.textContent === 'scans ›')")  # the list is of the folder where it lies
    set_control(browser, "Series", "1.2.4", "change")
    browser.wait("halflight.store.scene.volumes[0].series === '1.2.4'")
    rest(browser)
    check(browser.run("halflight.start.volumes[0].dimensions") == [8, 8, 3], "the other series is open")
    browser.run("window.old = true")
    browser.reload()
    browser.wait("!window.old && globalThis.halflight !== undefined")
    rest(browser)
    check(browser.run("halflight.store.scene.volumes[0].series") == "1.2.4", "and is so after a reload")


def fits_a_phone(browser):
    """Nothing is cut at 390 pixels, whatever is unfolded, and whatever is touched has 24 pixels."""
    resize(browser, 390, 844)
    browser.run("document.querySelectorAll('details').forEach((d) => { d.open = true; })")
    rest(browser)
    cut = browser.run("""[...document.querySelectorAll('.viewer :is(button, input, select, canvas, output, summary)')].filter((e) => {
      const { left, right, width } = e.getBoundingClientRect();
      return width > 0 && (left < 0 || right > innerWidth || (e.matches('button') && e.scrollWidth > e.clientWidth + 1)); }).map((e) => e.outerHTML.slice(0, 120))""")
    check(cut == [] and browser.run("document.documentElement.scrollWidth") == 390, f"cut: {cut}")
    small = browser.run("""[...document.querySelectorAll('.viewer :is(button, input:not([type=radio]), select, summary, .segments label)')].filter((e) => {
      const { width, height } = e.getBoundingClientRect(); return width > 0 && (width < 24 || height < 24); }).map((e) => e.outerHTML.slice(0, 120))""")
    check(small == [], f"smaller than 24 pixels: {small}")


def banner_is_seen(browser, viewer):
    """The buttons of the banner that says that the viewer is lost stand out from it in both themes."""
    viewer.process.terminate()
    viewer.process.wait()
    browser.run("halflight.store.changeRender('shadows', 'hard')")
    browser.wait("!document.querySelector('.banner').hidden")
    for theme in ("dark", "light"):
        browser.run(f"(() => {{ if (document.querySelector('.viewer').dataset.theme !== '{theme}') document.getElementById('theme').click(); }})()")
        buttons = {name: contrast for name, contrast in in_window(browser).items() if "Retry" in name or "save session" in name}
        check(any("Retry" in name for name in buttons) and min(buttons.values()) >= LEAST_CONTRAST, f"{theme}: {buttons}")


chosen = browser_named(sys.argv[2])
with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    need_viewer(PROGRAM)
    subprocess.run([PROGRAM, "make", "rings", "--size", "32", "--quiet", "-o", "rings.nrrd"], check=True)
    with open("bare.nrrd", "wb") as file:
        file.write(b"NRRD0004\ntype: int16\ndimension: 3\nsizes: 8 8 8\nencoding: raw\n\n" + bytes(n % 251 for n in range(1024)))
    os.makedirs("patient/scans")
    for n in range(9):
        with open(f"patient/scans/IM{n}", "wb") as file:
            file.write(dicom_slice(n, [(0x0020000e, "UI", b"1.2.%d" % (3 + n % 3 // 2)), (0x0008103e, "LO", b"Scan %d" % (n % 3 // 2))]))
    with Viewer(PROGRAM, "rings.nrrd", "--sheet-spacing", "2") as viewer, chosen(size=(900, 620)) as page:
        page.open(viewer.url)
        rest(page)
        progress_rises(page)
        awaited_states(page)
        frames_are_counted(page)
        page.run("document.querySelectorAll('details').forEach((d) => { d.open = true; }); [...document.querySelectorAll('button')].find((b) => b.textContent === 'key of the camera now').click()")
        rest(page)
        for theme in ("dark", "light"):
            page.run(f"(() => {{ if (document.querySelector('.viewer').dataset.theme !== '{theme}') document.getElementById('theme').click(); }})()")
            edges_are_seen(page, theme)
        fits_a_phone(page)
        resize(page, 900, 620)
        warnings_are_told(page)
        series_of_a_folder(page)
        check(page.problems == [], f"the console has errors: {page.problems}")
        banner_is_seen(page, viewer)
print(f"{checks.count} checks passed")
