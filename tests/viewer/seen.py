"""Contrasts of a page's controls with what lies around them, measured in a picture of the screen (WCAG 2.2, 1.4.11)."""
import json
import os
import tempfile

from PIL import Image

from checks import check

LEAST_CONTRAST = 3  # of what makes out a control

# Each control that is seen: its kind, its name and its box. A switch that is off and a slider show their tracks. A control that is disabled, and the choice of
# several that is taken, need no edge of their own.
CONTROLS = """(() => {
  const seen = (e) => { const { width, height } = e.getBoundingClientRect(); return width > 0 && height > 0 && !e.disabled && !e.closest('dialog:not([open])'); };
  const named = (e) => `${e.tagName.toLowerCase()} ${e.type ?? ''} "${e.getAttribute('aria-label') ?? e.labels?.[0]?.textContent ?? (e.textContent.trim().slice(0, 30) || e.className)}"`;
  const list = (kind, selector) => [...document.querySelectorAll(selector)].filter(seen).map((e) => {
    const { left, top, right, bottom } = e.getBoundingClientRect(); return [kind, named(e), [left, top, right, bottom], e.closest('aside') !== null]; });
  return [...list('edge', ':is(aside, header, footer, .timeline, .banner) :is(button:not(.file, .key, .key-here), select, textarea, input:is([type=text], [type=search], [type=color], [type=checkbox]:not([role]))), aside .segments, aside canvas[tabindex]'),
    ...list('line', 'aside input[type=number]'), ...list('track', ':is(aside, .timeline) input[type=range]:not(.double *), aside .double, .track-keys'),
    ...list('fill', 'aside input[role=switch]'), ...list('mark', '.key')];
})()"""


def luminance(color):
    linear = [x / 255 / 12.92 if x / 255 <= 0.04045 else ((x / 255 + 0.055) / 1.055) ** 2.4 for x in color]
    return sum(share * x for share, x in zip((0.2126, 0.7152, 0.0722), linear))


def contrast(a, b):
    low, high = sorted((luminance(a), luminance(b)))
    return (high + 0.05) / (low + 0.05)


def contrast_of(picture, kind, box):
    """The contrast of a control's edge, track or fill with the ground beside it; kind and box: of CONTROLS."""
    left, top, right, bottom = box
    at = lambda x, y: picture.getpixel((min(max(int(x), 0), picture.width - 1), min(max(int(y), 0), picture.height - 1)))  # noqa: E731
    middle = (left + right) / 2, (top + bottom) / 2

    def best(ground, places):
        return max(contrast(at(*ground), at(*place)) for place in places)
    steps = (-1, 0, 1, 2, 3)
    if kind == "edge":
        # Where the corners are round, the edge is looked for at the middle of each side.
        return min(best((left - 2, middle[1]), [(left + d, middle[1]) for d in steps]), best((right + 1, middle[1]), [(right - 1 - d, middle[1]) for d in steps]),
                   best((middle[0], top - 2), [(middle[0], top + d) for d in steps]), best((middle[0], bottom + 1), [(middle[0], bottom - 1 - d) for d in steps]))
    if kind == "line":
        return best((left + 6, bottom + 1), [(left + 6, bottom - 1 - d) for d in steps])
    if kind == "track":  # at both ends, of which at most one is below the thumb
        return min(best((x, middle[1] - 9), [(x, middle[1] + d) for d in steps]) for x in (left + 4, right - 4))
    if kind == "fill":
        return best((left - 2, middle[1]), [(left + 1, middle[1]), (right - 2, middle[1])])  # its knob is at one end
    return best((middle[0], top - 1), [middle])  # mark


def in_window(browser):
    """{name: contrast} of the controls that are whole in the window."""
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "screen.png")
        browser.screenshot(path)
        with Image.open(path) as file:
            picture = file.convert("RGB")
    controls, width, height, top, low = browser.run(f"""(() => {{ const {{ top, bottom }} = document.getElementById('panels').getBoundingClientRect();
      return [JSON.stringify({CONTROLS}), innerWidth, innerHeight, top, bottom]; }})()""")
    found = {}
    for kind, name, box, is_panel in json.loads(controls):
        if box[0] >= 0 and box[2] <= width and box[1] >= (top + 3 if is_panel else 0) and box[3] <= (low - 3 if is_panel else height):
            found[f"{kind} of {name}"] = min(contrast_of(picture, kind, box), found.get(f"{kind} of {name}", 21))
    return found


def contrasts(browser):
    """{name: contrast} of all controls of the page, from the top of the side bar to its end."""
    found, end = {}, browser.run("(() => { const p = document.getElementById('panels'); return Math.max(p.scrollHeight - p.clientHeight, 0); })()")
    step = max(browser.run("document.getElementById('panels').clientHeight") - 220, 100)  # more than the height of any control
    for place in [*range(0, int(end), int(step)), end]:
        browser.run(f"document.getElementById('panels').scrollTop = {place}; document.activeElement?.blur?.(); new Promise((told) => requestAnimationFrame(() => requestAnimationFrame(told)))")
        for name, seen in in_window(browser).items():
            found[name] = min(seen, found.get(name, 21))
    return found


def edges_are_seen(browser, what):
    """On the screen the edges of fields, buttons and choices, and the tracks of sliders and switches, stand out from what is around them."""
    found = contrasts(browser)
    for kind, least in (("edge", 60), ("line", 10), ("track", 15), ("fill", 2), ("mark", 1)):
        check(len([name for name in found if name.startswith(kind)]) >= least, f"{what}: there are controls of the kind {kind}: {list(found)}")
    low = {name: round(contrast, 2) for name, contrast in found.items() if contrast < LEAST_CONTRAST}
    check(low == {}, f"{what}: of a contrast below {LEAST_CONTRAST}: {low}")
