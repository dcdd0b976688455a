#!/usr/bin/env python3
"""Legends of figures of `halflight render` and `halflight figure`, read back by other programs.

usage: figure_legends.py PROGRAM
"""
import json
import re
import subprocess
import xml.etree.ElementTree as XML
from pathlib import Path

import numpy as np
from figure_tools import Image, check, grounds, halflight, nifti, paths, program, rods, run, tool, words


def srgb(linear):
    return [0 if c <= 0 else 1 if c >= 1 else 12.92 * c if c <= 0.0031308 else 1.055 * c ** (1 / 2.4) - 0.055 for c in linear]


def legends():
    """The strip's colours are the function's, in the SVG's gradient and in the PNG's pixels."""
    nifti("rods.nii", np.minimum(rods, 250), 1.0)
    points = [[50, 0.02, 0.3, 0.9], [100, 0.9, 0.5, 0.05], [100, 0.1, 0.8, 0.1], [250, 1, 1, 0.2]]
    Path("tf.json").write_text(json.dumps({"opacity": [[50, 0], [60, 1], [250, 0.2]], "color": points}))
    look = ["rods.nii", "--tf", "tf.json", "--size", "500x500", "--quiet", "--legend", "Flow (m/s)"]
    for name in "a.svg", "a.pdf", "a.png":
        halflight(*look, "-o", name)
    check("Flow (m/s)" in words("a.pdf"), words("a.pdf"))
    numbers = [float(line) for line in words("a.pdf").split("\n") if re.fullmatch(r"[\d.]+", line)]
    check(sorted(numbers) == [50, 100, 150, 200, 250], f"{numbers}")
    Path("short.json").write_text(json.dumps({"opacity": [[110, 0], [120, 1], [230, 1]], "color": [[110, 1, 0, 0], [230, 1, 1, 0]]}))
    halflight("rods.nii", "--tf", "short.json", "--size", "400x110", "--quiet", "--legend", "auto", "-o", "short.pdf")
    numbers = [float(line) for line in words("short.pdf").split("\n") if re.fullmatch(r"[\d.]+", line)]
    check(sorted(numbers) == [150, 200], f"a short strip has two numbers at least, and ends with the function: {numbers}")
    for name, greatest in ("part_0.nii", 199.9), ("part_1.nii", 200):
        nifti(name, np.minimum(rods, greatest), 1.0)
    halflight("part_*.nii", "--range-of-all", "--size", "400x200", "--quiet", "--legend", "auto", "-o", "%s.png")
    # The numbers stand right of column 365. Left of it the matter shines through the legend's ground, and may differ.
    first, second = (np.asarray(Image.open(f"part_{n}.png").convert("RGB"))[:, 365:] for n in range(2))
    check(np.array_equal(first, second) and np.ptp(first) > 100, "a series with one range has the same numbers beside its legends")
    table = np.array(points)

    def color(value, before):
        if value == 100:
            return srgb(points[1 if before else 2][1:])
        return srgb([np.interp(value, table[:, 0] + [0, 0, 1e-9, 0], table[:, c]) for c in (1, 2, 3)])

    root = XML.parse("a.svg").getroot()
    gradient, = root.iter("{http://www.w3.org/2000/svg}linearGradient")
    stops = [(float(stop.get("offset")), [float(n) / 100 for n in re.findall(r"([\d.]+)%", stop.get("style") or stop.get("stop-color"))])
             for stop in gradient.iter("{http://www.w3.org/2000/svg}stop")]
    jump = []
    for offset, found in stops:
        value = 50 + 200 * offset
        value = 100 if abs(value - 100) < 1e-3 else value
        if value == 100:
            jump.append(min((True, False), key=lambda before: max(abs(a - b) for a, b in zip(found, color(100, before)))))
        expected = color(value, bool(jump) and jump[-1])
        check(max(abs(a - b) for a, b in zip(found, expected)) < 0.002, f"at {value}: {found}, not {expected}")
    check(len(stops) >= 20 and jump == sorted(jump, reverse=True) and len(set(jump)) == 2, "the jump at 100 has both colours")
    bottom, top = float(gradient.get("y1")), float(gradient.get("y2"))
    box, = [n for style, n in paths("a.svg") if "fill:url(#" in style and len(n) == 10]
    scale = 500 / float(root.get("viewBox").split()[2])
    picture = np.asarray(Image.open("a.png").convert("RGB")) / 255
    for value in 60, 80, 95, 110, 150, 200, 240:
        y = bottom + (value - 50) / 200 * (top - bottom)
        found = picture[int(y * scale), int((min(box[::2]) + max(box[::2])) / 2 * scale)]
        check(max(abs(found - color(value, True))) < 0.02, f"at {value}: {found}, not {color(value, True)}")


def gradient_of(svg):
    """(offset, colour) of the stops of an SVG's only gradient."""
    gradient, = XML.parse(svg).getroot().iter("{http://www.w3.org/2000/svg}linearGradient")
    return [(float(stop.get("offset")), [float(n) / 100 for n in re.findall(r"([\d.]+)%", stop.get("style") or stop.get("stop-color"))])
            for stop in gradient.iter("{http://www.w3.org/2000/svg}stop")]


def logarithmic_strips():
    """Over equal ratios of values, a strip has the colours that an even strip has over equal differences; its numbers are powers of ten."""
    nifti("decades.nii", np.geomspace(1e-6, 1e2, 64**3).reshape(64, 64, 64).astype(np.float32), 1.0)
    look = ["decades.nii", "--look", "mip", "--colormap", "viridis", "--size", "300x300", "--quiet", "--legend", "auto"]
    halflight(*look, "--range", "1,10", "-o", "even.svg")
    even = gradient_of("even.svg")
    for low, high, wanted in (1e-5, 1e1, ["10\u207b4", "10\u207b2", "100"]), (2.0, 9.0, ["2", "4", "6", "8"]):
        ranged = [*look, "--range", f"{low},{high}", "--range-scale", "log"]
        halflight(*ranged, "-o", "log.svg")
        found = gradient_of("log.svg")
        far = max(abs(np.interp(offset, [o for o, _ in even], [c[n] for _, c in even]) - color[n]) for offset, color in found for n in range(3))
        check(far < 0.01, f"{low} to {high}: the colours differ by {far}")
        halflight(*ranged, "-o", "log.pdf")
        halflight(*ranged, "-o", "kept.png")
        halflight("kept.png", "--quiet", "--legend", "auto", "-o", "kept.pdf")
        seen, kept = (words(name).translate(str.maketrans("\u2070\u00b9\u00b2\u00b3\u2074\u2075", "012345")).split() for name in ("log.pdf", "kept.pdf"))
        check(all(number in seen for number in wanted), f"{low} to {high}: {seen}")
        check(sorted(kept) == sorted(seen), f"the scene of a picture keeps the scale and the range: {kept}, not {seen}")


def legends_below():
    """Below all pictures a legend has all rows once, in columns within the page, and covers nothing."""
    labels = np.zeros((32, 32, 32), np.uint8)
    names = [f"Region-of-interest-{n}" for n in range(1, 15)]
    for n in range(14):
        labels[4:28, 4:28, 2 + 2 * n:4 + 2 * n] = n + 1
    nifti("labels.nii", labels, 1.0)
    Path("table.csv").write_text("".join(f"{n + 1},{name},{18 * n},80,200\n" for n, name in enumerate(names)))
    look = ["labels.nii", "--label-table", "table.csv", "--background", "white", "--quiet"]
    legend = ["--legend", "auto"]
    for sheet in ["--views", "left,right", "--width", "89mm"], ["--size", "300x300"]:
        below = [] if "--views" in sheet else ["--place", "legend=below"]
        halflight(*look, *sheet, *legend, *below, "-o", "below.pdf")
        check(sorted(word for word in words("below.pdf").split() if word.startswith("Region")) == sorted(names), words("below.pdf"))
        page = [float(n) for n in re.search(r"Page size:\s+(\S+) x (\S+)", tool("pdfinfo", "below.pdf")).groups()]
        boxes = re.findall(r'xMin="([\d.]+)" yMin="([\d.]+)" xMax="([\d.]+)" yMax="([\d.]+)">Region', tool("pdftotext", "-bbox", "below.pdf", "-"))
        rights, bottoms = ([float(box[n]) for box in boxes] for n in (2, 3))
        check(max(rights) < page[0] and max(bottoms) < page[1] and len({box[0] for box in boxes}) > 1, f"{boxes} on {page}")
        halflight(*look, *sheet, *legend, *below, "-o", "below.png")
        halflight(*look, *sheet, "-o", "plain.png")
        plain, drawn = (np.asarray(Image.open(name).convert("RGB")) for name in ("plain.png", "below.png"))
        check(drawn.shape[1] == plain.shape[1] and drawn.shape[0] > plain.shape[0] and np.array_equal(drawn[:len(plain)], plain), "the pictures stay")
        check((drawn[len(plain):] < 100).any(), "the strip has the legend")
    Path("page.json").write_text(json.dumps({"width": "89mm", "options": {"label-table": "table.csv", "legend": "auto", "place": "legend=below"},
                                             "panels": [{"input": "labels.nii"}, {"input": "labels.nii", "view": "left"}]}))
    done = subprocess.run([program, "figure", "page.json", "-o", "page.pdf"], capture_output=True, text=True)
    check(done.returncode == 0 and words("page.pdf").count("Region") == 14, f"{done.stderr}: {words('page.pdf')}")
    high = float(re.search(r"x ([\d.]+) mm", done.stderr).group(1))
    size = re.search(r"Page size:\s+\S+ x (\S+)", tool("pdfinfo", "page.pdf")).group(1)
    check(abs(float(size) / 72 * 25.4 - high) < 0.1, f"{size} points, and {high} mm are told")
    few = labels * (labels < 4)  # beside a strip of colours there is room for three rows in one column
    nifti("few.nii", few, 1.0)
    nifti("scan.nii", np.hypot(*np.mgrid[-1:1:32j, -1:1:32j, -1:1:32j][:2]).astype(np.float32), 1.0)
    halflight("scan.nii", "--look", "xray", "--labels", "few.nii", "--label-table", "table.csv", "--width", "183mm", "--dpi", "72", "--quiet", *legend, "--place", "legend=below", "-o", "few.pdf")
    lefts = re.findall(r'xMin="([\d.]+)"[^>]*>Region', tool("pdftotext", "-bbox", "few.pdf", "-"))
    check(len(lefts) == 3 and len(set(lefts)) == 1, f"{lefts}")
    said = halflight(*look, "--scale-bar", "auto", "--ortho", "--place", "scale-bar=below", "-o", "no.png", exit_code=2)
    check("no PART=CORNER" in said, said)


def label_legends():
    labels = np.zeros((32, 32, 32), np.uint8)
    labels[4:14, 4:28, 4:28], labels[18:28, 4:28, 4:28] = 3, 7
    nifti("labels.nii", labels, 1.0)
    Path("table.txt").write_text("3 Liver<left> 255 0 0 0\n7 Kidney 0 128 255 0\n")
    look = ["labels.nii", "--label-table", "table.txt", "--show", "all", "--size", "300x300", "--quiet", "--legend", "auto"]
    halflight(*look, "-o", "a.pdf")
    seen = words("a.pdf").split("\n")
    check("Kidney" in seen and any(line.startswith("Liver") for line in seen), f"{seen}")
    halflight(*look, "-o", "a.svg")
    fills = [[float(n) for n in re.findall(r"([\d.]+)%", style)][:3] for style, n in paths("a.svg") if len(n) == 10]
    for wanted in (100, 0, 0), (0, 128 / 2.55, 100):
        check(any(len(fill) == 3 and max(abs(a - b) for a, b in zip(fill, wanted)) < 0.3 for fill in fills), f"{wanted} among {fills}")


def titles_of_legends():
    """The ground of a legend with a long title is as wide as its lines, and no word is cut; a title that is broken keeps the strip."""
    nifti("full.nii", np.full((32, 32, 32), 200, np.uint8), 1.0)
    look = ["full.nii", "--look", "surface", "--ortho", "--whole", "--zoom", "4", "--size", "500x400", "--quiet", "--range", "0,250", "--place", "legend=upper-right"]
    title = "X-ray attenuation of the bonsai tree (arbitrary units)"
    widths = []
    for asked in "Flow", title:
        halflight(*look, "--legend", asked, "-o", "full.svg")
        (left, _, right, _), = grounds("full.svg")
        widths.append((right - left) / 7)
    check(widths[0] < 8 and widths[0] <= widths[1] < 11.5, f"{widths} sizes of letters")
    halflight(*look, "--legend", title, "-o", "full.pdf")
    check(title.split() == [word for word in words("full.pdf").split() if not re.fullmatch(r"[\d.]+", word)], f"{words('full.pdf')!r}")


run(legends, logarithmic_strips, legends_below, label_legends, titles_of_legends)
