"""What the tests of figures share: the program, and what poppler, an XML parser and Pillow say about its figures."""
import os
import re
import shutil
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as XML
from pathlib import Path

try:
    import nibabel
    import numpy as np
    from PIL import Image
except ImportError as absent:
    print(f"{absent.name} is not installed")
    sys.exit(77)
if not shutil.which("pdftotext"):
    print("poppler-utils is not installed")
    sys.exit(77)

program = str(Path(sys.argv[1]).resolve())
checks = 0


def check(condition, what):
    global checks
    checks += 1
    if not condition:
        sys.exit(f"wrong: {what}")


def halflight(*arguments, exit_code=0):
    done = subprocess.run([program, "render", *map(str, arguments)], capture_output=True, text=True)
    check(done.returncode == exit_code, f"{arguments}: exit code {done.returncode}: {done.stderr}")
    return done.stdout if exit_code == 0 else done.stderr


def tool(*arguments):
    return subprocess.run(arguments, check=True, capture_output=True, text=True).stdout


def words(path):
    return tool("pdftotext", path, "-")


def nifti(path, voxels, spacing, unit="mm"):
    image = nibabel.Nifti1Image(voxels, np.diag([spacing] * 3 + [1.0]))
    image.header.set_xyzt_units(unit)
    image.to_filename(path)


def paths(svg):
    """[(style, numbers of its path)] of the vectors of an SVG."""
    found = []
    for element in XML.parse(svg).iter("{http://www.w3.org/2000/svg}path"):
        style = element.get("style") or ";".join(f"{k}:{v}" for k, v in element.attrib.items())
        found.append((style, [float(n) for n in re.findall(r"-?\d+(?:\.\d+)?", element.get("d"))]))
    return found


def white_rectangles(svg):
    """(left, top, width, height) of the rectangles filled with white."""
    found = []
    for style, n in paths(svg):
        if re.search(r"fill:rgb\(100%,100%,100%\)", style) and "stroke:none" in style and len(n) == 10:
            found.append((min(n[::2]), min(n[1::2]), max(n[::2]) - min(n[::2]), max(n[1::2]) - min(n[1::2])))
    return found


def grounds(svg):
    """(left, top, right, bottom) of the translucent grounds behind parts of the overlay."""
    return [(min(n[::2]), min(n[1::2]), max(n[::2]), max(n[1::2])) for style, n in paths(svg) if "fill-opacity:0.54" in style]


def changed(picture, plain):
    """Where a picture differs from another one."""
    return (np.asarray(Image.open(picture).convert("RGB")) != np.asarray(Image.open(plain).convert("RGB"))).any(axis=2)


def box_of(where):
    """(left, top, right, bottom) of what is true, in pixels."""
    rows, columns = np.nonzero(where)
    return columns.min(), rows.min(), columns.max() + 1, rows.max() + 1


# Two rods along the line of sight, 40 voxels apart: what a bar is measured against.
rods = np.zeros((64, 64, 64), np.uint8)
rods[12, 20:44, 32] = rods[52, 20:44, 32] = 255


def run(*tests):
    """Runs tests in a folder of their own."""
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        for test in tests:
            before = checks
            test()
            print(f"{test.__name__}: {checks - before} checks", flush=True)
