#!/usr/bin/env python3
"""The page for people with other eyes and hands: axe-core finds nothing, edges are seen, keys lead everywhere.

usage: accessible.py PROGRAM FOLDER   FOLDER keeps axe-core, from the package index, from one run to the next

HALFLIGHT_SCREENSHOTS names a folder for pictures of the page in both themes at all sizes.
"""
import glob
import json
import os
import shutil
import subprocess
import sys
import tempfile
import zipfile

import checks
import seen
from browser import Browser
from checks import check
from hands import PROGRAM, center, press, press_named, rest, scene_of
from viewer import Viewer, need_viewer

SIZES = ((390, 844), (820, 1180), (1280, 720), (1920, 1080))
OPEN_ALL = """document.querySelectorAll('details').forEach((d) => { d.open = true; })"""


def find_axe(folder):
    """The text of axe-core; None: the package index is not in reach."""
    os.makedirs(folder, exist_ok=True)
    packages = f"{folder}/axe_playwright_python-*.whl"
    if not glob.glob(packages):
        subprocess.run([sys.executable, "-m", "pip", "download", "-q", "--no-deps", "-d", folder, "axe-playwright-python==0.1.8"], check=False)
    for package in glob.glob(packages):
        with zipfile.ZipFile(package) as files:
            return files.read("axe_playwright_python/axe.min.js").decode()
    return None


def axe_finds_nothing(browser, axe, what):
    browser.run(axe + "; 0")
    passed, found = browser.run("""axe.run(document, { resultTypes: ['violations'] }).then(({ passes, violations }) => [passes.map(({ id }) => id),
      violations.map(({ id, help, nodes }) => [id, help, nodes.length, nodes.slice(0, 4).map(({ html, failureSummary }) => [html.slice(0, 160), failureSummary])])])""")
    check("color-contrast" in passed, f"{what}: axe-core has looked: {passed}")
    check(found == [], f"{what}: {json.dumps(found, indent=1)}")


def nothing_is_cut(browser, what):
    """Nothing of the side bar, and no button, is cut at its right."""
    cut = browser.run("""[...document.querySelectorAll('aside :is(button, input, select, textarea, canvas, output), header button')].filter((e) => {
      const box = e.getBoundingClientRect(), room = e.closest('aside, header').getBoundingClientRect();
      return box.width > 0 && (box.left < room.left || box.right > room.right - 4 || (e.matches('button') && e.scrollWidth > e.clientWidth + 1)); }).map((e) => e.outerHTML.slice(0, 120))""")
    check(cut == [], f"{what}: cut: {cut}")


def full_screen(browser):
    """By the key and by the button, and back."""
    browser.run("document.getElementById('view').focus()")
    browser.key("f")
    browser.wait("document.fullscreenElement?.classList.contains('viewer')")
    browser.key("f")
    browser.wait("document.fullscreenElement === null")
    browser.click(center(browser, "#full"))
    browser.wait("document.fullscreenElement !== null")
    check(browser.run("document.querySelector('#full').getBoundingClientRect().right <= innerWidth"), "the button is in reach there")
    browser.click(center(browser, "#full"))
    browser.wait("document.fullscreenElement === null")
    rest(browser)


def keys_after_a_drag(browser):
    """A light that was dragged, or a slider that was moved, does not keep the keys for itself."""
    dot = center(browser, ".light-dot")
    browser.drag(dot, [dot[0] + 40, dot[1] + 20])
    before = scene_of(browser)["render"]["shadows"]
    browser.key("s")
    check(scene_of(browser)["render"]["shadows"] != before, "s changes the shadows after a light was dragged")
    browser.key("u")
    check(scene_of(browser)["render"]["shadows"] == before, "u undoes it")
    browser.run("document.querySelector('aside input[type=range]').scrollIntoView({ block: 'center' })")
    browser.click(center(browser, "aside input[type=range]"))
    check(browser.run("document.activeElement.type === 'range'"), "the slider has the focus")
    browser.key("s")
    check(scene_of(browser)["render"]["shadows"] != before, "s changes the shadows after a slider was moved")
    browser.key("b")
    check(browser.run("document.querySelector('.viewer').classList.contains('bare')"), "b hides the side bar")
    browser.key("b")
    rest(browser)


def fit(browser, size):
    """The page in a window of this size, at rest; a phone has two pixels for each of the page's."""
    browser.call("Emulation.setDeviceMetricsOverride", width=size[0], height=size[1], deviceScaleFactor=2 if size[0] < 500 else 1, mobile=False)
    browser.wait("halflight.store.scene.image.width === Math.round(document.getElementById('view').clientWidth * devicePixelRatio)")
    browser.run("document.getElementById('panels').scrollTop = 0")
    rest(browser)


def keys_line_up(browser, what):
    """The keys of all tracks lie above the slider of frames, at its scale; a narrow page keeps room for them."""
    ends = browser.run("[...document.querySelectorAll('.track-keys, .track input')].map((e) => { const { left, right } = e.getBoundingClientRect(), margin = e.matches('input') ? 7 : 0; return [Math.round(left + margin), Math.round(right - margin)]; })")
    check(len(ends) > 2 and all(end == ends[0] for end in ends) and ends[0][1] - ends[0][0] > 140, f"{what}: the timeline's columns: {ends}")


def status_fits(browser, size):
    """What the line below the picture tells is not cut."""
    cut = browser.run("""[...document.querySelectorAll('footer > *')].filter((e) => e.getBoundingClientRect().width > 0 &&
      (e.getBoundingClientRect().right > e.parentElement.getBoundingClientRect().right - 12 || e.scrollWidth > e.clientWidth + 1 && getComputedStyle(e).display !== 'inline')).map((e) => e.textContent)""")
    check(cut == [], f"{size}: cut: {cut}")
    check(browser.run("document.getElementById('statistics').textContent.includes('KiB')"), f"{size}: the line tells the size")


chromium = shutil.which("chromium")
if chromium is None:
    print("chromium is not installed")
    sys.exit(77)
axe = find_axe(os.path.abspath(sys.argv[2]))
pictures = os.environ.get("HALFLIGHT_SCREENSHOTS")
with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    need_viewer(PROGRAM)
    subprocess.run([PROGRAM, "make", "rings", "--size", "32", "--quiet", "-o", "rings.nrrd"], check=True)
    with Viewer(PROGRAM, "rings.nrrd", "--sheet-spacing", "0.75", "--light-samples", "2") as viewer, Browser(chromium, SIZES[-1]) as browser:
        browser.open(viewer.url)
        rest(browser)
        full_screen(browser)
        keys_after_a_drag(browser)
        for theme in ("dark", "light"):
            if browser.run("document.querySelector('.viewer').dataset.theme ?? 'dark'") != theme:
                browser.run("document.getElementById('theme').click()")
            check(browser.run("document.querySelector('.viewer').dataset.theme ?? 'dark'") == theme, f"the theme is {theme}")
            for size in SIZES:
                fit(browser, size)
                if pictures:
                    browser.screenshot(f"{pictures}/{theme}-{size[0]}.png")
                status_fits(browser, size)
            browser.run(OPEN_ALL)
            press(browser, "key of the camera now")
            press_named(browser, "Add a key of Intensity")
            rest(browser)
            seen.edges_are_seen(browser, theme)
            if axe is not None:
                axe_finds_nothing(browser, axe, theme)
                browser.run("document.getElementById('help').showModal()")
                axe_finds_nothing(browser, axe, f"{theme}, the help sheet")
                browser.run("document.getElementById('help').close()")
            for size in SIZES:
                fit(browser, size)
                nothing_is_cut(browser, f"{theme}, {size}")
                keys_line_up(browser, f"{theme}, {size}")
            if axe is not None:
                fit(browser, SIZES[0])
                check(browser.run("document.querySelector('header').clientHeight") < 80, "two rows of buttons on a phone")
                axe_finds_nothing(browser, axe, f"{theme}, on a phone")
            if pictures:
                fit(browser, (1280, 5200))
                browser.screenshot(f"{pictures}/{theme}-all.png")
        check(browser.problems == [], f"the console has errors: {browser.problems}")
print(f"{checks.count} checks passed{'' if axe is not None else '; without axe-core, as the package index is not in reach'}")
