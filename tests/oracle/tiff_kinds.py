#!/usr/bin/python3
"""TIFF stacks as ImageJ, tifffile and microscopes write them, made here tag by tag, and what must be read from them.

usage: tiff_kinds.py DUMP_VOLUME HALFLIGHT
Exit 77: numpy is missing.
"""
import json
import pathlib
import shutil
import struct
import subprocess
import sys
import tempfile

try:
    import numpy as np
except ImportError as absent:
    print("skipped:", absent)
    sys.exit(77)

DUMP, PROGRAM = sys.argv[1:3]
root = pathlib.Path(tempfile.mkdtemp(prefix="halflight-tiff-"))
problems = []


def check(name, condition, what=""):
    print("ok" if condition else "not ok", "-", name, "" if condition else f": {what}")
    if not condition:
        problems.append(name)


def tiff(pages, description="", resolution=(1, 1), order="<", more=(), tail=b""):
    """A file of these pages, [height][width] or with samples, uncompressed; `tail`: bytes after the first page's pixels."""
    out = bytearray((b"II*\0" if order == "<" else b"MM\0*") + b"\0\0\0\0")
    link = 4
    for number, page in enumerate(pages):
        page = np.asarray(page)
        samples = page.shape[2] if page.ndim == 3 else 1
        pixels = page.astype(page.dtype.newbyteorder(order)).tobytes()
        strip = len(out)
        out += pixels + (tail if number == 0 else b"")
        out += b"\0" * (len(out) % 2)
        text = description.encode() + b"\0" if number == 0 and description else b""
        text_at = len(out)
        out += text + b"\0" * (len(text) % 2)
        rational = len(out)
        for value in resolution:
            out += struct.pack(order + "II", round(value * 1000), 1000)
        kind = {"u": 1, "i": 2, "f": 3}[page.dtype.kind]
        tags = [(256, 4, 1, page.shape[1]), (257, 4, 1, page.shape[0]), (258, 3, 1, 8 * page.dtype.itemsize), (259, 3, 1, 1),
                (262, 3, 1, 2 if samples > 1 else 1), (273, 4, 1, strip), (277, 3, 1, samples), (278, 4, 1, page.shape[0]),
                (279, 4, 1, len(pixels)), (282, 5, 1, rational), (283, 5, 1, rational + 8), (296, 3, 1, 1), (339, 3, 1, kind), *more]
        if text:
            tags.append((270, 2, len(text), text_at))
        if samples > 1:
            bits = len(out)
            out += struct.pack(f"{order}{samples}H", *[8 * page.dtype.itemsize] * samples) + b"\0" * (2 * samples % 4)
            tags[2] = (258, 3, samples, bits)
            tags = [t if t[0] != 339 else (339, 3, samples, bits + 2 * samples) for t in tags]
            out += struct.pack(f"{order}{samples}H", *[kind] * samples)
            tags = [t if t[0] != 339 else (339, 3, samples, len(out) - 2 * samples) for t in tags]
            out += b"\0" * (len(out) % 4)
        at = len(out)
        out[link:link + 4] = struct.pack(order + "I", at)
        out += struct.pack(order + "H", len(tags))
        for tag, kind_of, count, value in sorted(tags):
            short = kind_of == 3 and count == 1
            out += struct.pack(order + "HHI", tag, kind_of, count) + (struct.pack(order + "HH", value, 0) if short else struct.pack(order + "I", value))
        link = len(out)
        out += b"\0\0\0\0"
    return bytes(out)


def read(name, content, *options):
    path = root / name
    path.write_bytes(content)
    told = subprocess.run([PROGRAM, "info", "--json", str(path), *options], capture_output=True, text=True, timeout=60)
    if told.returncode != 0:
        return None, None, told.stderr
    choice = {options[n]: options[n + 1] for n in range(0, len(options), 2)}
    out = root / "voxels"
    subprocess.run([DUMP, "%s#%s,%s,-1,-1" % (path, choice.get("--time", -1), choice.get("--channel", -1)), str(out)], check=True, capture_output=True)
    info = json.loads(told.stdout)
    return info, np.fromfile(out).reshape(info["dimensions"][::-1]), told.stderr


def expect(name, content, voxels, spacing=(1, 1, 1), unit=None, options=(), file="a.tif"):
    info, found, told = read(file, content, *options)
    good = info is not None and found.shape == voxels.shape and np.array_equal(found, voxels)
    check(name, good, told if info is None else (found.shape, voxels.shape))
    if info is not None:
        check(f"{name}: lengths", np.allclose(info["spacing"], spacing, rtol=1e-6) and info["unit"] == unit, (info["spacing"], info["unit"]))
    return info


VOXELS = np.random.RandomState(1).randint(0, 60000, (3, 2, 7, 6, 5)).astype(np.uint16)  # t, c, z, y, x


def imagej(images, slices=None, channels=None, frames=None, lines=()):
    parts = [f"ImageJ=1.53t", f"images={images}"]
    parts += [f"{word}={n}" for word, n in (("channels", channels), ("slices", slices), ("frames", frames)) if n]
    return "\n".join([*parts, "hyperstack=true", *lines]) + "\n"


def test_imagej():
    stack = VOXELS[0, 0]
    rest = lambda planes, order: b"".join(p.astype(p.dtype.newbyteorder(order)).tobytes() for p in planes)  # noqa: E731
    for order in "<>":
        one = tiff([stack[0]], imagej(7, 7, lines=["spacing=2.0", "unit=um"]), order=order, tail=rest(stack[1:], order))
        expect(f"one page of seven, {order}", one, stack, (1, 1, 2), "micrometre")
        hyper = VOXELS.transpose(0, 2, 1, 3, 4).reshape(-1, 6, 5)
        whole = tiff([hyper[0]], imagej(42, 7, 2, 3), order=order, tail=rest(hyper[1:], order))
        for time, channel in ((0, 0), (2, 1), (1, 0)):
            expect(f"one page of a hyperstack, {order}, {time}, {channel}", whole, VOXELS[time, channel],
                   options=("--time", str(time), "--channel", str(channel)))
    floats = stack.astype(np.float32) / 7
    expect("one page of floats", tiff([floats[0]], imagej(7, 7), order=">", tail=rest(floats[1:], ">")), floats.astype(float))
    info, found, told = read("a.tif", tiff([stack[0]], imagej(99, 99), tail=rest(stack[1:], "<")))
    check("more pictures than the file has", info and info["dimensions"] == [5, 6, 1] and "promises 99 pictures" in told, told)
    for unit, factor in (("micron", 1), ("\\u00B5m", 1), ("µm", 1), ("nm", 1e-3), ("mm", 1e3), ("cm", 1e4), ("inch", 25400), ("m", 1e6)):
        expect(f"the unit {unit}", tiff(stack, imagej(7, 7, lines=["spacing=2.5", f"unit={unit}"]), (4, 2)), stack,
               (0.25 * factor, 0.5 * factor, 2.5 * factor), "micrometre")
    expect("units of each axis", tiff(stack, imagej(7, 7, lines=["spacing=500", "unit=um", "yunit=nm", "zunit=nm"]), (4, 0.002)), stack,
           (0.25, 0.5, 0.5), "micrometre")
    expect("pixels are no unit", tiff(stack, imagej(7, 7, lines=["spacing=3", "unit=pixel"]), (4, 2)), stack, (0.25, 0.5, 3))


def test_series():
    planes = VOXELS.reshape(-1, 6, 5)
    shaped = lambda shape, **more: json.dumps({"shape": list(shape), **more})  # noqa: E731
    tzyx, zcyx = VOXELS[:, 0].reshape(-1, 6, 5), VOXELS[0].transpose(1, 0, 2, 3).reshape(-1, 6, 5)
    for time in range(3):
        expect(f"TZYX, time {time}", tiff(tzyx, shaped((3, 7, 6, 5), axes="TZYX")), VOXELS[time, 0], options=("--time", str(time)))
        expect(f"four axes without letters, time {time}", tiff(tzyx, shaped((3, 7, 6, 5))), VOXELS[time, 0], options=("--time", str(time)))
    for channel in range(2):
        pick = ("--channel", str(channel))
        expect(f"CZYX, channel {channel}", tiff(VOXELS[0].reshape(-1, 6, 5), shaped((2, 7, 6, 5), axes="CZYX")), VOXELS[0, channel], options=pick)
        expect(f"ZCYX, channel {channel}", tiff(zcyx, shaped((7, 2, 6, 5), axes="ZCYX")), VOXELS[0, channel], options=pick)
    expect("TCZYX", tiff(planes, shaped((3, 2, 7, 6, 5), axes="TCZYX")), VOXELS[2, 1], options=("--time", "2", "--channel", "1"))
    expect("CTZYX", tiff(VOXELS.transpose(1, 0, 2, 3, 4).reshape(-1, 6, 5), shaped((2, 3, 7, 6, 5), axes="CTZYX")), VOXELS[2, 1], options=("--time", "2", "--channel", "1"))
    expect("three axes", tiff(VOXELS[0, 0], shaped((7, 6, 5))), VOXELS[0, 0])
    expect("one page of a series", tiff([tzyx[0]], shaped((3, 7, 6, 5), axes="TZYX"), tail=tzyx[1:].tobytes()), VOXELS[1, 0], options=("--time", "1"))
    expect("an unknown axis is slices", tiff(tzyx, shaped((3, 7, 6, 5), axes="QQYX")), tzyx)
    expect("a text that is no series", tiff(tzyx, '{"shape": "no"}'), tzyx)


def test_lengths():
    stack = VOXELS[0, 0]
    units = {"dm": 1e5, "km": 1e9, "Mm": 1e12, "mm": 1e3, "pm": 1e-6, "Pm": 1e21, "Å": 1e-4, "thou": 25.4, "ft": 304800, "yd": 914400,
             "&#181;m": 1, "&#xb5;m": 1, "µm": 1, "pt": 25400 / 72, "li": 25400 / 12, "am": 1e-12}
    for unit, factor in units.items():
        xml = ('<?xml version="1.0" encoding="UTF-8"?><OME><Image ID="Image:0"><Pixels ID="Pixels:0" DimensionOrder="XYZCT" Type="uint16" '
               'SizeX="5" SizeY="6" SizeZ="7" SizeC="1" SizeT="1" PhysicalSizeX="%.17g" PhysicalSizeXUnit="%s" PhysicalSizeY="0.5" '
               'PhysicalSizeZ="%.17g" PhysicalSizeZUnit="%s"><TiffData/></Pixels></Image></OME>' % (0.25 / factor, unit, 2 / factor, unit))
        expect(f"OME's unit {unit}", tiff(stack, xml), stack, (0.25, 0.5, 2), "micrometre", file="a.ome.tif")
    xml = xml.replace('"am"', '"pixel"').replace("%.17g" % (0.25 / 1e-12), "3").replace("%.17g" % (2 / 1e-12), "4")
    expect("OME's pixels are no unit", tiff(stack, xml), stack, (3, 0.5, 4), file="a.ome.tif")


def test_deep():
    """ImageDepth: a page is a volume."""
    stack = VOXELS[0, 0]
    content = tiff([stack[0]], more=[(32997, 4, 1, 7)], tail=stack[1:].tobytes())
    expect("a page of seven slices", content, stack)
    try:
        import tifffile
    except ImportError:
        print("skipped: tiles of several slices, without tifffile")
        return
    volume = np.random.RandomState(3).randint(0, 255, (20, 40, 50)).astype(np.uint8)
    for compression in (None, "zlib"):
        tifffile.imwrite(root / "deep.tif", volume, volumetric=True, tile=(16, 16, 16), compression=compression)
        expect(f"tiles of sixteen slices, {compression}", (root / "deep.tif").read_bytes(), volume.astype(float))


try:
    for test in (test_imagej, test_series, test_lengths, test_deep):
        test()
finally:
    shutil.rmtree(root, ignore_errors=True)
print(f"{len(problems)} problems")
sys.exit(1 if problems else 0)
