#!/usr/bin/env python3
"""Figures of `halflight render` and `halflight figure`, read back by other programs: poppler for PDF, an XML parser for SVG, Pillow for PNG and TIFF.

usage: figures.py PROGRAM
"""
import json
import math
import re
import shutil
import subprocess
import xml.etree.ElementTree as XML
from pathlib import Path

import numpy as np
from figure_tools import Image, box_of, changed, check, grounds, halflight, nifti, paths, program, rods, run, tool, white_rectangles, words


def rod_distance(picture):
    """Between the two rods in a picture, in pixels: of the middles of their brightness."""
    light = np.asarray(Image.open(picture).convert("L")).astype(float)
    light = np.clip(light - np.median(light), 0, None).sum(0)
    half = len(light) // 2
    middle = [(light[part] * np.arange(len(light))[part]).sum() / light[part].sum() for part in (slice(0, half), slice(half, None))]
    return middle[1] - middle[0]


def bars():
    for spacing, unit, length in (0.5, "mm", "20mm"), (2.0, "micron", "80um"), (1.0, "meter", "4000cm"), (0.25, "micron", "0.01mm"):
        nifti("rods.nii", rods, spacing, unit)
        look = ["rods.nii", "--ortho", "--view", "front", "--size", "400x300", "--quiet"]
        halflight(*look, "-o", "plain.png")
        halflight(*look, "--scale-bar", length, "-o", "bar.png")
        halflight(*look, "--scale-bar", length, "-o", "bar.svg")
        page = float(XML.parse("bar.svg").getroot().get("viewBox").split()[2])
        (left, top, width, thick), = white_rectangles("bar.svg")
        pixels = width * 400 / page
        check(abs(pixels - rod_distance("plain.png")) < 0.3, f"{length}: {pixels} and {rod_distance('plain.png')} pixels")
        row = np.asarray(Image.open("bar.png").convert("L"))[round((top + thick / 2) * 400 / page)]
        check(abs(np.count_nonzero(row > 150) - pixels) <= 1, f"{length}: the bar of the PNG")
        check(not np.array_equal(np.asarray(Image.open("bar.png")), np.asarray(Image.open("plain.png"))), "a bar is drawn")


def chosen_lengths():
    """The unit follows the length, and the length is 1, 2 or 5 times a power of ten, at most a quarter of the width."""
    for spacing, unit in (0.5, "mm"), (0.0005, "mm"), (40.0, "mm"), (3.0, "meter"), (0.3, "micron"), (0.004, "micron"):
        nifti("rods.nii", rods, spacing, unit)
        look = ["rods.nii", "--ortho", "--size", "90x90", "--quiet"]
        height = json.loads(halflight(*look, "--print-scene"))["camera"]["height"]
        halflight(*look, "--scale-bar", "auto", "-o", "bar.pdf")
        number, name = re.fullmatch(r"(\S+) (\S+)\s*", words("bar.pdf")).groups()
        metres = {"nm": 1e-9, "µm": 1e-6, "mm": 1e-3, "m": 1}
        part = float(number) * metres[name] / (height * {"mm": 1e-3, "meter": 1, "micron": 1e-6}[unit])
        check(0.1 < part <= 0.25 and 1 <= float(number) < 1000 and number.rstrip("0") in ("1", "2", "5"), f"{number} {name} of {height} {unit}")


def perspective():
    nifti("rods.nii", rods, 1.0)
    look = ["rods.nii", "--view", "front", "--size", "200x200", "--quiet"]
    said = halflight(*look, "--scale-bar", "auto", "-o", "no.png", exit_code=2)
    check("perspective" in said and "@target" in said and not Path("no.png").exists(), f"refused: {said}")
    camera = json.loads(halflight(*look, "--print-scene"))["camera"]
    distance = math.dist(camera["position"], camera["target"])
    for depth, told in ("target", "at the target"), ("150", "at depth 150"):
        halflight(*look, "--scale-bar", f"10mm@{depth}", "-o", "bar.svg")
        halflight(*look, "--scale-bar", f"10mm@{depth}", "-o", "bar.pdf")
        check(words("bar.pdf").split("\n")[0] == f"10 mm {told}", words("bar.pdf"))
        away = distance if depth == "target" else 150
        page = float(XML.parse("bar.svg").getroot().get("viewBox").split()[2])
        expected = 10 / (2 * away * math.tan(math.radians(camera["fovy_deg"]) / 2)) * page
        check(abs(white_rectangles("bar.svg")[0][2] - expected) < 0.01, f"at {depth}: {expected} points")


def units_are_not_invented():
    Path("plain_64x64x64_uint8.raw").write_bytes(rods.tobytes())
    look = ["plain_64x64x64_uint8.raw", "--ortho", "--size", "60x60", "--quiet"]
    said = halflight(*look, "--scale-bar", "auto", "-o", "no.png", exit_code=2)
    check("unit" in said and not Path("no.png").exists(), said)
    halflight(*look, "--scale-bar", "auto", "--unit", "kpc", "-o", "a.pdf")
    check("kpc" in words("a.pdf"), words("a.pdf"))
    halflight(*look, "--scale-bar", "20", "--unit", "code units", "-o", "a.pdf")
    check(words("a.pdf").startswith("20 code units"), words("a.pdf"))
    said = halflight(*look, "--scale-bar", "20um", "--unit", "code units", "-o", "no.png", exit_code=2)
    check("code units" in said, said)
    said = halflight(*look, "--axes", "letters", "-o", "no.png", exit_code=2)
    check("body" in said, said)


def physical_sizes():
    nifti("rods.nii", rods, 1.0)
    look = ["rods.nii", "--view", "iso", "--quiet"]
    halflight(*look, "--width", "30mm", "--dpi", "150", "-o", "a.png")
    halflight(*look, "--width", "30mm", "--dpi", "150", "-o", "a.tif")
    halflight(*look, "--width", "30mm", "--dpi", "150", "-o", "a.pdf")
    halflight(*look, "--width", "3cm", "--dpi", "150", "-o", "deep.tif", "--depth", "16")
    png, tif = Image.open("a.png"), Image.open("a.tif")
    wide = round(30 / 25.4 * 150)
    check(png.size == (wide, wide) and abs(png.info["dpi"][0] - 150) < 0.02, f"{png.size} {png.info['dpi']}")
    check(tif.size == png.size and tif.info["dpi"][0] == 150 and tif.tag_v2[296] == 2, f"{tif.info}")
    check(np.array_equal(np.asarray(png.convert("RGB")), np.asarray(tif)), "the TIFF has the PNG's pixels")
    check(Image.open("deep.tif").tag_v2[258] == (16, 16, 16), "16 bits")
    page = re.search(r"Page size:\s+(\S+) x (\S+)", tool("pdfinfo", "a.pdf")).groups()
    check(all(abs(float(side) - 30 / 25.4 * 72) < 0.3 for side in page), f"{page}")
    check("CreationDate" not in tool("pdfinfo", "a.pdf"), "a PDF has the same bytes whenever it is made")
    tool("pdfimages", "-png", "a.pdf", "inside")
    check(np.array_equal(np.asarray(Image.open("inside-000.png").convert("RGB")), np.asarray(png.convert("RGB"))), "the PDF has the PNG's pixels")
    halflight(*look, "--size", "50x40", "-o", "unsized.png")
    check("dpi" not in Image.open("unsized.png").info, "no size is invented")
    halflight(*look, "--size", "50x40", "--dpi", "100", "--annotate", "x@0.5,0.5", "-o", "sized.png")
    check(abs(Image.open("sized.png").info["dpi"][0] - 100) < 0.02, "--dpi alone")
    said = halflight(*look, "--size", "50x40", "--dpi", "100", "--width", "89mm", "-o", "no.png", exit_code=2)
    check("contradict" in said, said)


def hostile_texts():
    nifti("rods.nii", rods, 1.0)
    text = "<b>a</b> & \"c\" \x1b[31m\u202edrow\x07"
    look = ["rods.nii", "--size", "300x200", "--quiet", "--annotate", f"{text}@0.1,0.5"]
    halflight(*look, "-o", "a.svg")
    XML.parse("a.svg")
    check(not re.search(r"[\x00-\x08\x0b-\x1f]", Path("a.svg").read_text()), "no control characters in the SVG")
    halflight(*look, "-o", "a.pdf")
    seen = words("a.pdf")
    check('<b>a</b> & "c" ' in seen and "[31m" in seen and "drow" in seen and "\x1b" not in seen and "\u202e" not in seen, repr(seen))


def letters():
    nifti("rods.nii", rods, 1.0)
    for view, expected in ("front", "SRLI"), ("left", "SAPI"), ("top", "ARLP"):
        halflight("rods.nii", "--ortho", "--view", view, "--axes", "letters", "--size", "200x200", "--quiet", "-o", "a.pdf")
        check(sorted(words("a.pdf").split()) == sorted(expected), f"{view}: {words('a.pdf')!r}")
    boxes = re.findall(r'xMin="([\d.]+)" yMin="([\d.]+)"[^>]*>(\w)<', tool("pdftotext", "-bbox", "a.pdf", "-"))
    place = {letter: (float(x), float(y)) for x, y, letter in boxes}
    # A body is seen from its head with its front at the upper edge, as in atlases: its right is at the picture's right.
    check(place["A"][1] < place["P"][1] and place["L"][0] < place["R"][0], f"{place}")


def points_of_the_world():
    """A ring lies on the voxel that it names."""
    nifti("rods.nii", rods, 1.0)
    look = ["rods.nii", "--ortho", "--view", "front", "--size", "400x400", "--quiet"]
    camera = json.loads(halflight(*look, "--print-scene"))["camera"]
    halflight(*look, "--annotate", "rod@52,32,32", "-o", "a.svg")
    page = float(XML.parse("a.svg").getroot().get("viewBox").split()[2])
    arc = next(n for style, n in paths("a.svg") if "stroke:rgb(100%" in style and "fill:none" in style)
    middle = (min(arc[::2]) + max(arc[::2])) / 2 * 400 / page
    halflight(*look, "-o", "plain.npy")
    cover = np.load("plain.npy")[..., 3].sum(0)
    halves = [(cover[part] * np.arange(400)[part]).sum() / cover[part].sum() + 0.5 for part in (slice(0, 200), slice(200, 400))]
    check(min(abs(middle - half) for half in halves) < 0.2 and camera["height"] > 0, f"{middle} among {halves}")


def marked(look, marks, **volume):
    """marked.json: a scene of `look` with these marks, and with these settings of its volume."""
    scene = json.loads(halflight(*look, "--print-scene"))
    scene["volumes"][0].update(volume)
    Path("marked.json").write_text(json.dumps(scene | {"marks": marks}))
    return scene


def length_said(number):
    """A length as the viewer's page writes it (shortNumber() of controls.js)."""
    from decimal import ROUND_HALF_UP, Decimal
    digits = 5 if 1000 <= number < 1e5 else 3
    exact = Decimal(number)
    rounded = exact.quantize(Decimal(1).scaleb(exact.adjusted() - digits + 1), ROUND_HALF_UP)
    if 1e-3 <= number < 1e5:
        text = format(rounded, "f")
        return (text.rstrip("0").rstrip(".") if "." in text else text)
    power = rounded.adjusted()
    return f"{rounded.scaleb(-power):.2f}e{'+' if power >= 0 else '-'}{abs(power)}"


def lengths_of_marks():
    """Rulers say the length in the file, in its unit or in the given one, rounded as on the page; no unit is invented."""
    nifti("rods.nii", rods, 1.0)
    look = ["rods.nii", "--ortho", "--view", "front", "--size", "300x300", "--quiet"]
    lengths = [12.25, 0.125, 1 / 3, 12.35, 999.6, 1234.56, 99999.7, 123456.0, 0.000125, 0.0012, 40, 7.125]
    rulers = [{"kind": "ruler", "points": [[20, 20, 14 + 3 * n], [20 + length, 20, 14 + 3 * n]], "text": f"r{n}"} for n, length in enumerate(lengths)]
    marked(look, rulers)
    for unit, symbol in ([], "mm"), (["--unit", "um"], "µm"), (["--unit", "au"], "au"):
        halflight("marked.json", "--marks", *unit, "-o", "marks.pdf", "--quiet")
        said = "".join(words("marks.pdf").split())
        for n, length in enumerate((20 + length) - 20 for length in lengths):
            # The middle of a longer ruler lies beyond the picture, and its text, too.
            if length < 60:
                check("".join(f"r{n}:{length_said(length)}{symbol}".split()) in said, f"{length}: {length_said(length)} {symbol} in {said!r}")
    angle = {"kind": "angle", "points": [[40, 20, 30], [20, 20, 30], [20 + 10 * math.cos(0.7), 20, 30 + 10 * math.sin(0.7)]], "text": ""}
    line = {"kind": "line", "points": [[10, 30, 10], [30, 30, 10], [30, 30, 25]], "text": "way"}
    # What the scene does with the volume changes no length of its file. A point of the file lies where the volume's transform puts it.
    turn = {"scale": 2, "rotate": {"axis": [0, 0, 1], "angle_deg": 90}, "translate": [3, 4, 5]}
    turned = [mark | {"points": [[3 - 2 * y, 4 + 2 * x, 5 + 2 * z] for x, y, z in mark["points"]]} for mark in (angle, line)]
    for marks, volume in ([angle, line], {}), (turned, {"transform": turn}):
        marked(look, marks, **volume)
        halflight("marked.json", "--marks", "--view", "front", "-o", "marks.pdf", "--quiet")
        check(f"{math.degrees(0.7):.1f}°" in words("marks.pdf") and "way: 35 mm" in words("marks.pdf"), words("marks.pdf"))
    nifti("rods.nii", rods, 1.0, "unknown")
    marked(look, [{"kind": "ruler", "points": [[20, 32, 32], [50, 32, 32]]}])
    halflight("marked.json", "--marks", "-o", "marks.pdf", "--quiet")
    check(words("marks.pdf").split() == ["30"], f"no unit is known: {words('marks.pdf')!r}")
    said = halflight(*look, "--marks", "-o", "no.png", exit_code=2)
    check("has none" in said and not Path("no.png").exists(), said)


def places_of_marks():
    """Each kind is drawn where its points lie, as a vector; a mark with a point behind the eye is left out."""
    nifti("rods.nii", rods, 1.0)
    look = ["rods.nii", "--ortho", "--view", "front", "--size", "400x400", "--quiet"]
    points = [[12, 32, 32], [52, 32, 32], [32, 32, 52]]
    scene = marked(look, [{"kind": "line", "points": points}])
    camera = scene["camera"]
    halflight("marked.json", "--marks", "-o", "marks.svg", "--quiet")
    page = float(XML.parse("marks.svg").getroot().get("viewBox").split()[2])
    # From the front, x grows to the picture's left or right, and z upwards: the camera says which.
    way = np.subtract(camera["target"], camera["position"])
    right = np.cross(way, camera["up"])
    right, up = right / np.linalg.norm(right), np.array(camera["up"]) / np.linalg.norm(camera["up"])
    seen = [page * (0.5 + sign * np.dot(np.subtract(point, camera["target"]), axis) / camera["height"]) for point in points for sign, axis in ((1, right), (-1, up))]
    found = [numbers for style, numbers in paths("marks.svg") if len(numbers) == 6 and "fill:none" in style]
    check(len(found) == 2 and max(abs(np.subtract(found[1], seen))) < 0.05, f"{found} beside {seen}")
    halflight("marked.json", "-o", "plain.png", "--quiet")
    halflight("marked.json", "--marks", "-o", "marked.png", "--quiet")
    plain, drawn = (np.asarray(Image.open(name).convert("L")).astype(int) for name in ("plain.png", "marked.png"))
    middle = [round((seen[k] + seen[k + 2]) / 2 * 400 / page) for k in (0, 1)]
    check(drawn[middle[1] - 1:middle[1] + 2, middle[0]].max() > 150 and plain.shape == drawn.shape and (plain != drawn).mean() < 0.05, "the PNG shows the line over the picture")
    for high in 0, 1:  # a ruler's text is below a line that rises to the right, and above one that falls
        ends = sorted([[16, 32, 32], [48, 32, 32]], key=lambda point: np.dot(point, right))
        ends[high][2] += 24
        marked(look, [{"kind": "ruler", "points": ends, "text": "xxx"}])
        halflight("marked.json", "--marks", "-o", "ruler.png", "--quiet")
        (rows, columns), (one, other) = np.nonzero(np.asarray(Image.open("ruler.png").convert("L")) != plain), (
            [200 + sign * 400 * np.dot(np.subtract(point, camera["target"]), axis) / camera["height"] for sign, axis in ((1, right), (-1, up))] for point in ends)
        below = rows - (one[1] + (columns - one[0]) * (other[1] - one[1]) / (other[0] - one[0]))
        text = below[abs(below) > 8]
        check(len(text) > 20 and (text > 0).all() == (high == 1) and (text < 0).all() == (high == 0), f"the text of a ruler: {text.min()} to {text.max()} pixels below the line")
    kinds = {"ruler": 2, "angle": 3, "line": 2, "arrow": 2, "text": 1}
    for kind, count in kinds.items():
        marked(look, [{"kind": kind, "points": points[:count], "text": "x"}])
        halflight("marked.json", "--marks", "-o", "kind.png", "--quiet")
        check((np.asarray(Image.open("kind.png").convert("L")) != plain).any(), f"{kind} is drawn")
    eye = ["rods.nii", "--view", "front", "--size", "200x200", "--quiet"]
    position = json.loads(halflight(*eye, "--print-scene"))["camera"]["position"]
    behind = (np.array(position) + 2 * (np.array(position) - [32, 32, 32])).tolist()
    marked(eye, [{"kind": "ruler", "points": [[32, 32, 32], behind], "text": "seen"}, {"kind": "text", "points": [[32, 32, 32]], "text": "here"}])
    halflight("marked.json", "--marks", "-o", "marks.pdf", "--quiet")
    check(words("marks.pdf").split() == ["here"], words("marks.pdf"))


def pages():
    """Panels on a page: places, letters, what is shared, insets."""
    nifti("rods.nii", rods, 1.0)
    nifti("far.nii", np.roll(rods, 9, 1) // 2, 1.0)
    page = {"width": "100mm", "gap": "4mm", "dpi": 127, "share": ["camera", "light", "range"],
            "options": {"ortho": True, "view": "front", "threshold": 60},
            "panels": [{"input": "rods.nii", "scale-bar": "20mm", "inset": {"zoom": 3, "part": 0.25, "corner": "upper right"}},
                       {"input": ["far.nii"], "legend": "Dose (Gy)", "annotate": ["one@0.3,0.6", "two@0.3,0.8"]}]}
    Path("sub").mkdir(exist_ok=True)
    for name in "rods.nii", "far.nii":
        shutil.copy(name, "sub")
    Path("sub/page.json").write_text(json.dumps(page))
    run = lambda *arguments: subprocess.run([program, "figure", "sub/page.json", "--quiet", *arguments], capture_output=True, text=True)
    for name in "page.pdf", "page.png", "page.svg":
        done = run("-o", name)
        check(done.returncode == 0 and Path(name).exists(), done.stderr)
    seen = words("page.pdf").split()
    check(all(word in seen for word in ["a", "b", "20", "mm", "Dose", "(Gy)", "one", "two"]) and "c" not in seen, f"{seen}")
    size = [float(n) for n in re.search(r"Page size:\s+(\S+) x (\S+)", tool("pdfinfo", "page.pdf")).groups()]
    check(abs(size[0] - 100 / 25.4 * 72) < 0.3 and abs(size[1] - 48 / 25.4 * 72) < 0.3, f"{size}")
    pictures = tool("pdfimages", "-list", "page.pdf").split("\n")[2:-1]
    check(sorted(int(line.split()[3]) for line in pictures) == [60, 240, 240], f"{pictures}")
    whole = np.asarray(Image.open("page.png").convert("L")).astype(int)
    check(whole.shape == (240, 500) and (whole[:, 243:257] == 255).all(), f"{whole.shape}: the gap is white")
    halves = [np.argwhere(part[100:140] > 90).mean(0) for part in (whole[:, :60], whole[:, 260:320])]
    check(abs(halves[0] - halves[1]).max() < 1, f"one camera: {halves}")
    for change, word in (("\"front\"", "\"frnt\""), "front"), (("\"ortho\"", "\"orto\""), "did you mean 'ortho'"), \
            (("[\"far.nii\"]", "\"../far.nii\""), "leads out"), (("[\"far.nii\"]", "\"/etc/passwd\""), "leads out"), \
            (("\"100mm\"", "\"wide\""), "lengths"), (("\"gap\"", "\"gab\""), "unknown key 'gab'"):
        Path("sub/page.json").write_text(json.dumps(page).replace(*change))
        done = run("-o", "no.pdf")
        check(done.returncode in (2, 3) and word in done.stderr and done.stderr.count("\n") == 1 and not Path("no.pdf").exists(), done.stderr)


def plain_pictures():
    """Pictures without a scene are panels as they are, beside rendered ones; a first panel without a scene shares nothing."""
    nifti("rods.nii", rods, 1.0)
    codes = np.arange(30 * 20 * 3, dtype=np.uint32).reshape(20, 30, 3) * 97 % 251
    Image.fromarray(codes.astype(np.uint8)).save("where.png")
    halflight("rods.nii", "--size", "30x20", "--quiet", "-o", "light.exr")
    page = {"width": "90mm", "gap": "0mm", "dpi": 25.4, "letters": False,
            "panels": [{"input": "rods.nii"}, {"input": "where.png", "annotate": "note@0.1,5"}, {"input": "light.exr"}]}
    Path("plain.json").write_text(json.dumps(page))
    run = lambda: subprocess.run([program, "figure", "plain.json", "-o", "plain.png", "--quiet"], capture_output=True, text=True)
    done = run()
    check(done.returncode == 0, done.stderr)
    drawn = np.asarray(Image.open("plain.png").convert("RGB"))
    check(drawn.shape == (30, 90, 3) and np.array_equal(drawn[:20, 30:60], codes), f"{drawn.shape}: the picture's own codes")
    check((drawn[20:, 30:] == 255).all() and np.ptp(drawn[:20, 60:]) > 20, "the third panel shows the rods")
    for grey, ink in (20, "100%"), (235, "0%"):
        Image.new("RGB", (30, 20), (grey,) * 3).save("even.png")
        Path("plain.json").write_text(json.dumps(page | {"panels": [{"input": "even.png", "letter": "a"}]}))
        subprocess.run([program, "figure", "plain.json", "-o", "plain.svg", "--quiet"], check=True)
        check(f"fill:rgb({ink},{ink},{ink});fill-opacity:1" in Path("plain.svg").read_text().replace(" ", ""), f"ink on the grey {grey}")
    Path("plain.json").write_text(json.dumps(page | {"panels": page["panels"][1:], "share": ["light"]}))
    done = run()
    check(done.returncode == 3 and "'where.png', is a picture without a scene to share" in done.stderr, done.stderr)
    Path("plain.json").write_text(json.dumps(page | {"panels": [{"input": "where.png", "scale-bar": "auto"}]}))
    done = run()
    check(done.returncode != 0 and "need the picture's scene" in done.stderr, done.stderr)


def letters_stay_in_place():
    """Letters of pixels stand where the font puts them, not at whole pixels: equal letters are equally far apart."""
    Image.new("RGB", (300, 40), (255, 255, 255)).save("even.png")
    page = {"width": "60mm", "dpi": 127, "font-size": 8.3, "letters": False, "panels": [{"input": "even.png", "annotate": "llllllllllll@0.1,0.5"}]}
    Path("even.json").write_text(json.dumps(page))
    subprocess.run([program, "figure", "even.json", "-o", "drawn.png", "--quiet"], check=True)
    ink = 255.0 - np.asarray(Image.open("drawn.png").convert("L")).mean(0)
    starts = np.flatnonzero((ink[1:] > 0) & (ink[:-1] == 0)) + 1
    ends = np.flatnonzero((ink[1:] == 0) & (ink[:-1] > 0)) + 1
    middles = np.array([(ink[a:b] * np.arange(a, b)).sum() / ink[a:b].sum() for a, b in zip(starts, ends)])
    gaps = np.diff(middles)
    check(len(middles) == 12 and np.ptp(gaps) < 0.3 and abs(gaps.mean() - round(gaps.mean())) > 0.05, f"{len(middles)} letters, gaps {gaps}")


def grounds_behind_parts():
    """A ground lies behind the bar, the legend and the arrows where the picture shows matter there, and nowhere else. It leaves 46 % of the
    picture's codes; a long legend and the arrows do not lie over each other."""
    ramp = np.zeros((64, 64, 64), np.uint8)
    ramp[4:60, 4:60, 4:60] = np.linspace(120, 250, 56).astype(np.uint8)
    nifti("ramp.nii", ramp, 1.0)
    look = ["ramp.nii", "--look", "surface", "--ortho", "--view", "front", "--size", "400x400", "--quiet", "--whole"]
    parts = ["--scale-bar", "10mm", "--legend", "auto", "--axes", "arrows"]
    halflight(*look, "--zoom", "0.5", *parts, "-o", "apart.svg")
    check(grounds("apart.svg") == [], f"nothing lies behind: {grounds('apart.svg')}")
    over = [*parts, "--place", "legend=upper-right"]  # a legend without a place of its own goes below the picture
    halflight(*look, "--zoom", "4", *over, "-o", "over.svg")
    halflight(*look, "--zoom", "4", *over, "-o", "over.png")
    halflight(*look, "--zoom", "4", "-o", "plain.png")
    page = float(XML.parse("over.svg").getroot().get("viewBox").split()[2])
    found = grounds("over.svg")
    check(len(found) == 3, f"grounds of legend, arrows and bar: {found}")
    plain, over = (np.asarray(Image.open(name).convert("RGB")).astype(float) for name in ("plain.png", "over.png"))
    for left, top, right, bottom in found:
        x, y = round((left + 0.5) * 400 / page), round((top + bottom) / 2 * 400 / page)
        check(abs(over[y, x] - 0.46 * plain[y, x]).max() <= 2 and plain[y, x].max() > 60, f"{over[y, x]} of {plain[y, x]} at {x}, {y}")
    labels = np.zeros((64, 64, 64), np.uint8)
    labels[8:56, 8:56, 8:56] = 1 + np.arange(48)[:, None, None]
    nifti("labels.nii", labels, 1.0)
    halflight("labels.nii", "--ortho", "--size", "400x400", "--zoom", "4", "--quiet", "--legend", "auto", "--axes", "arrows", "--place", "legend=upper-right", "-o", "rows.svg")
    legend, arrows = sorted(grounds("rows.svg"), key=lambda ground: ground[1])
    check(legend[3] <= arrows[1] + 1e-6 or legend[0] >= arrows[2] - 1e-6, f"the legend {legend} meets the arrows {arrows}")


def parts_cover_the_least():
    """A legend, a bar and arrows cover nothing where there is room beside the matter, in all formats at one place; a corner that is asked for is
    exact, and its mirror image is another corner's."""
    block = np.zeros((64, 64, 64), np.uint8)
    block[2:36, 20:44, 2:62] = 200
    nifti("block.nii", block, 1.0)

    def seen(zoom, aside):
        """aside.json: the block at that part of the picture's height to the right of its middle."""
        scene = json.loads(halflight("block.nii", "--look", "surface", "--ortho", "--view", "front", "--whole", "--size", "360x300", "--zoom", zoom, "--print-scene"))
        camera = scene["camera"]
        way = np.cross(np.subtract(camera["target"], camera["position"]), camera["up"])
        way *= -aside * camera["height"] / np.linalg.norm(way)
        camera.update({key: np.add(camera[key], way).tolist() for key in ("position", "target")})
        Path("aside.json").write_text(json.dumps(scene))
        halflight("aside.json", "--quiet", "-o", "plain.png")

    seen(1.2, 0.35)
    halflight("aside.json", "--quiet", "-o", "plain.npy")
    matter = np.load("plain.npy")[..., 3] > 0.5 / 255
    look = ["aside.json", "--quiet"]
    check(matter[30:150, 340].all() and not matter[:, :160].any(), "the matter is at the right, where legends usually are")
    parts = ["--legend", "Flow of water through the porous rock (m/s)", "--scale-bar", "10mm", "--axes", "arrows"]
    for name in "free.png", "free.svg", "free.pdf":
        halflight(*look, *parts, "-o", name)
    drawn = changed("free.png", "plain.png")
    check(drawn.sum() > 500 and not (drawn & matter).any() and grounds("free.svg") == [], f"{(drawn & matter).sum()} pixels cover matter")
    halflight(*look, *parts, "--place", "legend=upper-right", "-o", "asked.png")
    check((changed("asked.png", "plain.png") & matter).sum() > 500, "the usual corner of the legend is over matter")
    # The strip of colours and the numbers beside it are where the PNG has them.
    page = float(XML.parse("free.svg").getroot().get("viewBox").split()[2])
    strip, = [n for style, n in paths("free.svg") if "fill:url(#" in style and len(n) == 10]
    left, top, right, bottom = (round(x * 360 / page) for x in (min(strip[::2]), min(strip[1::2]), max(strip[::2]), max(strip[1::2])))
    inside = drawn[top + 1:bottom - 1, left + 1:right - 1]
    check(inside.all() and inside.size > 200 and right < 180, f"the strip at {left}, {top}, {right}, {bottom}")
    boxes = re.findall(r'xMin="([\d.]+)" yMin="([\d.]+)" xMax="([\d.]+)" yMax="([\d.]+)">([^<]*)<', tool("pdftotext", "-bbox", "free.pdf", "-"))
    check({"Flow", "of", "water", "(m/s)", "10", "mm"} <= {word for *_, word in boxes}, f"{boxes}: nothing of the title is cut")
    for x0, y0, x1, y1, word in boxes:
        x, y = (round((float(a) + float(b)) / 2 * 360 / page) for a, b in ((x0, x1), (y0, y1)))
        check(drawn[y - 5:y + 6, x - 6:x + 7].any() and not matter[y, x], f"{word} of the PDF at {x}, {y}")
    # Corners: over nothing, a part is as far from the edges of each.
    seen(0.1, 0)
    for part, words_of_part, usual in (("legend", ["--legend", "auto"], "upper-right"), ("scale-bar", ["--scale-bar", "100mm"], "lower-left"), ("axes", ["--axes", "arrows"], "lower-right")):
        halflight(*look, *words_of_part, "-o", "free.png")
        halflight(*look, *words_of_part, "--place", f"{part}={usual}", "-o", "asked.png")
        check(Path("free.png").read_bytes().split(b"IDAT", 1)[1] == Path("asked.png").read_bytes().split(b"IDAT", 1)[1], f"{part}: the usual corner is free")
        one = box_of(changed("asked.png", "plain.png"))
        for corner in "upper-left", "upper-right", "lower-left", "lower-right":
            halflight(*look, *words_of_part, "--place", f"{part}={corner}", "-o", "asked.png")
            found = box_of(changed("asked.png", "plain.png"))
            x = [one[0], one[2]] if corner.split("-")[1] == usual.split("-")[1] else [360 - one[2], 360 - one[0]]
            y = [one[1], one[3]] if corner.split("-")[0] == usual.split("-")[0] else [300 - one[3], 300 - one[1]]
            check(max(abs(np.subtract(found, (x[0], y[0], x[1], y[1])))) <= 1, f"{part} in the {corner} corner: {found}, expected {x}, {y}")


def without_room():
    """A part that finds no room is left out, and a line says so."""
    nifti("rods.nii", rods, 1.0)
    look = ["rods.nii", "--ortho", "--size", "40x30"]
    halflight(*look, "--quiet", "-o", "plain.png")
    done = subprocess.run([program, "render", *look, "--font-size", "12", "--legend", "auto", "--place", "legend=upper-right", "-o", "none.png"], capture_output=True, text=True)
    check(done.returncode == 0 and done.stderr.count("the legend finds no room in the picture and is left out") == 1, done.stderr)
    check(not changed("none.png", "plain.png").any(), "nothing is drawn")


def linear_files_are_refused():
    nifti("rods.nii", rods, 1.0)
    for name in "a.exr", "a.npy":
        said = halflight("rods.nii", "--legend", "auto", "-o", name, exit_code=2)
        check("linear light" in said and not Path(name).exists(), said)
    said = halflight("rods.nii", "--legend", "auto", "--depth", "16", "-o", "no.png", exit_code=2)
    check("8 bits" in said, said)


run(bars, chosen_lengths, perspective, units_are_not_invented, physical_sizes, hostile_texts, letters, points_of_the_world, lengths_of_marks,
    places_of_marks, pages, plain_pictures, letters_stay_in_place, grounds_behind_parts, parts_cover_the_least, without_room,
    linear_files_are_refused)
