#!/usr/bin/python3
"""DICOM series that are written here, element by element, and what must be read from them.

usage: dicom.py DUMP_VOLUME HALFLIGHT
Geometry, order, gaps, series, times, rescaling, padding and every transfer syntax that needs no codec library beyond
Pillow's, and the same files cut at many lengths. Exit 77: numpy is missing.
"""
import io
import json
import pathlib
import random
import shutil
import struct
import subprocess
import sys
import tempfile
import zipfile
import zlib

try:
    import numpy as np
except ImportError as absent:
    print("skipped:", absent)
    sys.exit(77)

DUMP, PROGRAM = sys.argv[1:3]
IMPLICIT, EXPLICIT, BIG, DEFLATED = (f"1.2.840.10008.1.2{end}" for end in ("", ".1", ".2", ".1.99"))
RLE, BASELINE, EXTENDED, JPEG_2000 = (f"1.2.840.10008.1.2{end}" for end in (".5", ".4.50", ".4.51", ".4.90"))
LONG = {"OB", "OW", "SQ", "UN", "UT", "OF", "OD"}
problems = []


# ---- a writer ----

def value_bytes(vr, value, order):
    if isinstance(value, bytes):
        return value + b"\0" * (len(value) % 2)
    kinds = {"US": "H", "SS": "h", "UL": "I", "FD": "d", "FL": "f"}
    if vr in kinds:
        values = value if isinstance(value, (list, tuple)) else [value]
        return struct.pack(f"{order}{len(values)}{kinds[vr]}", *values)
    text = "\\".join(f"{v:.16g}" if isinstance(v, float) else str(v) for v in value) \
        if isinstance(value, (list, tuple)) else str(value)
    return (text + ("\0" if vr == "UI" else " ") * (len(text) % 2)).encode()


def element(tag, vr, value, syntax):
    order = ">" if syntax == BIG else "<"
    if vr == "SQ":  # items of undefined length, the sequence too
        content = b"".join(struct.pack(f"{order}HHI", 0xfffe, 0xe000, 0xffffffff) + elements(item, syntax)
                           + struct.pack(f"{order}HHI", 0xfffe, 0xe00d, 0) for item in value)
        content += struct.pack(f"{order}HHI", 0xfffe, 0xe0dd, 0)
        length = 0xffffffff
    else:
        content = value_bytes(vr, value, order)
        length = 0xffffffff if content.startswith(b"\xfe\xff\x00\xe0") and tag == 0x7fe00010 else len(content)
    head = struct.pack(f"{order}HH", tag >> 16, tag & 0xffff)
    if syntax == IMPLICIT:
        return head + struct.pack("<I", length) + content
    if vr in LONG:
        return head + vr.encode() + b"\0\0" + struct.pack(f"{order}I", length) + content
    return head + vr.encode() + struct.pack(f"{order}H", length) + content


def elements(items, syntax):
    return b"".join(element(tag, vr, value, syntax) for tag, (vr, value) in sorted(items.items()))


def dicom_file(items, syntax):
    meta = element(0x00020010, "UI", syntax, EXPLICIT)
    layout = syntax if syntax in (IMPLICIT, BIG) else EXPLICIT
    content = elements(items, layout)
    if syntax == DEFLATED:
        packer = zlib.compressobj(9, zlib.DEFLATED, -15)
        content = packer.compress(content) + packer.flush()
    return b"\0" * 128 + b"DICM" + element(0x00020000, "UL", len(meta), EXPLICIT) + meta + content


def fragments(frames):
    content = struct.pack("<HHI", 0xfffe, 0xe000, 0)
    for frame in frames:
        frame += b"\0" * (len(frame) % 2)
        content += struct.pack("<HHI", 0xfffe, 0xe000, len(frame)) + frame
    return content + struct.pack("<HHI", 0xfffe, 0xe0dd, 0)


def pack_bits(data):
    """PackBits, as literal runs and as runs of equal bytes in turn."""
    out, at = b"", 0
    while at < len(data):
        run = 1
        while at + run < len(data) and run < 128 and data[at + run] == data[at]:
            run += 1
        if run > 1:
            out += bytes([257 - run, data[at]])
        else:
            out += bytes([0, data[at]])
        at += run
    return out


def rle_frame(plane):
    size = plane.itemsize
    segments = [pack_bits(plane.tobytes()[size - 1 - n::size]) for n in range(size)]
    starts, at = [], 64
    for segment in segments:
        starts.append(at)
        at += len(segment)
    return struct.pack("<16I", size, *(starts + [0] * (15 - size))) + b"".join(segments)


def pillow_frame(plane, **options):
    from PIL import Image
    out = io.BytesIO()
    Image.fromarray(plane).save(out, **options)
    return out.getvalue()


def segment(marker, content):
    return bytes([0xff, marker]) + struct.pack(">H", len(content) + 2) + content


def jpeg_12_frame(plane, restart=3):
    """Extended JPEG (T.81, process 4) of 12 bits with steps of 1 and codes of 9 bits; restarts after 3 blocks."""
    n = np.arange(8)
    cosines = np.cos((2 * n[None, :] + 1) * n[:, None] * np.pi / 16) / 2
    cosines[0] /= np.sqrt(2)
    order = sorted(((u, v) for u in n for v in n), key=lambda p: (sum(p), p[0] if sum(p) % 2 else p[1]))  # zigzag
    rows, columns = plane.shape
    padded = np.pad(plane.astype(float) - 2048, ((0, -rows % 8), (0, -columns % 8)), "edge")
    blocks, previous = [], 0
    for y in range(0, padded.shape[0], 8):
        for x in range(0, padded.shape[1], 8):
            block = np.rint(cosines @ padded[y:y + 8, x:x + 8] @ cosines.T).astype(int)
            numbers = [int(block[p]) for p in order]
            if len(blocks) % restart == 0:
                previous = 0
            codes, run = [(0, numbers[0] - previous)], 0  # (zeros before it, number)
            previous = numbers[0]
            for number in numbers[1:]:
                run = run + 1 if number == 0 else run
                if number != 0:
                    codes += [(15, 0)] * (run // 16) + [(run % 16, number)]
                    run = 0
            blocks.append(codes + ([(0, 0)] if run else []))
    symbols = sorted({zeros << 4 | abs(number).bit_length() for block in blocks for zeros, number in block})
    table = bytes([0] * 8 + [len(symbols)] + [0] * 7 + symbols)
    scans = []
    for first in range(0, len(blocks), restart):
        bits = ""
        for zeros, number in (code for block in blocks[first:first + restart] for code in block):
            size = abs(number).bit_length()
            bits += format(symbols.index(zeros << 4 | size), "09b")
            bits += format(number if number > 0 else number + (1 << size) - 1, f"0{size}b") if size else ""
        bits += "1" * (-len(bits) % 8)
        scans.append(bytes(int(bits[b:b + 8], 2) for b in range(0, len(bits), 8)).replace(b"\xff", b"\xff\0"))
    data = b"".join(scan + bytes([0xff, 0xd0 + k % 8]) for k, scan in enumerate(scans[:-1])) + scans[-1]
    return (b"\xff\xd8" + segment(0xdb, b"\0" + bytes([1] * 64)) +
            segment(0xc1, struct.pack(">BHHB", 12, rows, columns, 1) + b"\1\x11\0") +
            segment(0xc4, b"\0" + table) + segment(0xc4, b"\x10" + table) + segment(0xdd, struct.pack(">H", restart)) +
            segment(0xda, b"\1\1\0\0\x3f\0") + data + b"\xff\xd9")


def pixel_elements(planes, syntax):
    kind = planes[0].dtype
    items = {0x00280002: ("US", 1), 0x00280004: ("CS", "MONOCHROME2"), 0x00280010: ("US", planes[0].shape[0]),
             0x00280011: ("US", planes[0].shape[1]), 0x00280100: ("US", 8 * kind.itemsize),
             0x00280101: ("US", 8 * kind.itemsize), 0x00280102: ("US", 8 * kind.itemsize - 1),
             0x00280103: ("US", int(kind.kind == "i"))}
    if len(planes) > 1:
        items[0x00280008] = ("IS", len(planes))
    if syntax == RLE:
        data = fragments([rle_frame(p) for p in planes])
    elif syntax == BASELINE:
        data = fragments([pillow_frame(p, format="JPEG", quality=95) for p in planes])
    elif syntax == EXTENDED:
        data = fragments([jpeg_12_frame(p) for p in planes])
    elif syntax == JPEG_2000:
        data = fragments([pillow_frame(p, format="JPEG2000", no_jp2=True) for p in planes])
    else:
        order = ">" if syntax == BIG else "<"
        data = b"".join(p.astype(p.dtype.newbyteorder(order)).tobytes() for p in planes)
    items[0x7fe00010] = ("OW" if kind.itemsize > 1 else "OB", data)
    return items


def slice_items(plane, position, number, uid="1.2.3", syntax=EXPLICIT, **extra):
    items = {0x00080060: ("CS", "CT"), 0x0008103e: ("LO", "Thorax"), 0x00180050: ("DS", 9), 0x0020000e: ("UI", uid),
             0x00200011: ("IS", 7), 0x00200013: ("IS", number), 0x00200032: ("DS", [float(x) for x in position]),
             0x00200037: ("DS", [1, 0, 0, 0, 1, 0]), 0x00280030: ("DS", [0.75, 0.5]),
             0x00281052: ("DS", -1024), 0x00281053: ("DS", 2)}
    items.update(pixel_elements([plane], syntax))
    items.update({int(tag[1:], 16): value for tag, value in extra.items()})
    return items


def write_slices(folder, planes, positions, uid="1.2.3", syntax=EXPLICIT, extra=lambda n: {}):
    folder.mkdir(parents=True, exist_ok=True)
    names = list(range(len(planes)))
    random.Random(3).shuffle(names)
    for n, plane in enumerate(planes):
        items = slice_items(plane, positions[n], names[n], uid, syntax, **extra(n))
        (folder / f"{uid}-{names[n]}").write_bytes(dicom_file(items, syntax))


# ---- what is read ----

def check(name, condition, what):
    print("ok" if condition else "not ok", "-", name, "" if condition else f": {what}")
    if not condition:
        problems.append(name)


def read(path, *options):
    """(info, values [k][j][i], warnings)"""
    told = subprocess.run([PROGRAM, "info", "--json", str(path), *options], capture_output=True, text=True, timeout=60)
    if told.returncode != 0:
        return None, None, told.stderr
    info, values = json.loads(told.stdout), None
    if not options:
        out = root / "voxels"
        subprocess.run([DUMP, str(path), str(out)], capture_output=True, timeout=60, check=True)
        values = np.fromfile(out, float).reshape(info["dimensions"][::-1])
    return info, values, told.stderr


def expect(name, path, values, warning="", spacing=None, tolerance=0.0, options=()):
    info, found, told = read(path, *options)
    if info is None:
        check(name, False, told)
        return None
    good = found is not None and found.shape == values.shape
    worst = np.nanmax(np.abs(found - values)) if good else None
    same_holes = good and np.array_equal(np.isnan(found), np.isnan(values))
    check(name, good and same_holes and worst <= tolerance, f"{found.shape} {values.shape} differ by {worst}")
    check(f"{name}: what is told", (warning in told) if warning else told == "", told)
    if spacing is not None:
        check(f"{name}: spacing", np.allclose(info["spacing"], spacing, rtol=0, atol=1e-9), info["spacing"])
    return info


def line(count, step, origin=(-10, 20, 5)):
    return [[o + n * s for o, s in zip(origin, step)] for n in range(count)]


def test_geometry():
    positions = line(6, (0, 0, 2.5))
    write_slices(root / "plain", CT, positions)
    info = expect("shuffled slices", root / "plain", HU, spacing=[0.5, 0.75, 2.5])
    check("origin, type and space", info["origin"] == [-10, 20, 5] and info["type"] == "int16" and
          info["space"] == "LPS", info)
    scene = json.loads(subprocess.run([PROGRAM, "render", root / "plain", "--print-scene"], capture_output=True, check=True).stdout)
    eye = np.subtract(scene["camera"]["position"], scene["camera"]["target"])
    check("seen from the front, upright", eye[1] < 0 and scene["camera"]["up"][2] > 0.5, scene["camera"])
    for path in (root / "plain").iterdir():
        (root / "both").mkdir(exist_ok=True)
        (root / "both" / path.name).write_bytes(b"II*\0\x08\0\0\0" + path.read_bytes()[8:])
    expect("slices that begin like TIFF files", root / "both", HU, spacing=[0.5, 0.75, 2.5])
    one = next((root / "both").iterdir())
    check("one of them", read(one)[0] is not None and read(one)[0]["dimensions"][2] == 1, read(one)[2])
    write_slices(root / "down", CT, line(6, (0, 0, -2.5)))
    info = expect("slices from the head down", root / "down", HU[::-1], spacing=[0.5, 0.75, 2.5])
    check("their origin is the lowest slice's", info["origin"] == [-10, 20, 5 - 12.5], info["origin"])
    write_slices(root / "tilt", CT, line(6, (0, 1.25, 2.5)))
    info = expect("a tilted gantry", root / "tilt", HU)
    third = np.array(info["direction"])[:, 2] * info["spacing"][2]
    check("its grid is sheared", np.allclose(third, [0, 1.25, 2.5], atol=1e-12), third)
    write_slices(root / "sagittal", CT, line(6, (1.5, 0, 0)), extra=lambda n: {"t00200037": ("DS", [0, 1, 0, 0, 0, -1])})
    info = expect("sagittal slices", root / "sagittal", HU[::-1], spacing=[0.5, 0.75, 1.5])
    check("their directions", np.allclose(np.array(info["direction"]), [[0, 0, -1], [1, 0, 0], [0, -1, 0]]), info)


def test_gaps():
    positions = line(6, (0, 0, 2.5))
    keep = [0, 1, 2, 4, 5]
    write_slices(root / "gap", [CT[n] for n in keep], [positions[n] for n in keep])
    filled = HU.copy()
    filled[3] = np.floor((CT[2].astype(float) + CT[4]) / 2 + 0.5) * 2 - 1024
    expect("a missing slice", root / "gap", filled, "1 of 6 slices are missing", [0.5, 0.75, 2.5])
    write_slices(root / "uneven", CT[:4], [positions[0], positions[1], [-10, 20, 8.5], [-10, 20, 11.25]])
    info, values, told = read(root / "uneven")
    check("uneven slices", "not evenly spaced" in told and np.array_equal(values[0], HU[0]) and
          np.array_equal(values[-1], HU[3]), told)
    write_slices(root / "double", list(CT) + [CT[2]], positions + [positions[2]])
    expect("a doubled slice", root / "double", HU, "1 slices lie where others are")
    write_slices(root / "localizer", CT, positions)
    write_slices(root / "localizer" / "more", CT[:1], [[0, 0, 0]], extra=lambda n: {
        "t00080008": ("CS", "ORIGINAL\\PRIMARY\\LOCALIZER"), "t00200037": ("DS", [1, 0, 0, 0, 0, -1])})
    shutil.move(next((root / "localizer" / "more").iterdir()), root / "localizer" / "first")
    expect("a localizer in the series", root / "localizer", HU, "1 of 7 slices are left out: localizers")
    write_slices(root / "nowhere", CT, positions)
    for path in (root / "nowhere").iterdir():
        path.write_bytes(path.read_bytes().replace(struct.pack("<HH", 0x20, 0x32) + b"DS",
                                                   struct.pack("<HH", 0x20, 0x3f) + b"DS"))
    info, values, told = read(root / "nowhere")
    check("slices without positions", "tell no positions" in told and info["spacing"][2] == 9 and
          "space" in info and info["space"] is None, (told, info))


def test_series():
    write_slices(root / "two" / "a", CT, line(6, (0, 0, 1)))
    write_slices(root / "two" / "b", CT[:3] + 7, line(3, (0, 0, 1)), uid="1.2.4", extra=lambda n: {
        "t00200011": ("IS", 8), "t0008103e": ("LO", "Leg"), "t00080060": ("CS", "MR")})
    (root / "two" / "notes.txt").write_text("not a slice")
    expect("the largest of two series", root / "two", HU, 'of 2 series, 7: CT "Thorax", 5 x 4 x 6 is taken')
    info, _, _ = read(root / "two")
    listed = [(s["number"], s["modality"], s["description"], s["dimensions"], s["chosen"]) for s in info["series"]]
    check("info lists the series", listed == [(7, "CT", "Thorax", [5, 4, 6], True), (8, "MR", "Leg", [5, 4, 3], False)], info)
    for wish in ("8", "1.2.4", "leg"):
        info, _, told = read(root / "two", "--series", wish)
        check(f"--series {wish}", info is not None and info["dimensions"] == [5, 4, 3], told)
    _, _, told = read(root / "two", "--series", "9")
    check("--series 9", 'there is no series "9": there is 7: CT "Thorax"' in told, told)
    times = [CT + 10 * t for t in range(3)]
    for t, planes in enumerate(times):
        write_slices(root / "time" / f"t{t}", planes, line(6, (0, 0, 1)), extra=lambda n, t=t: {
            "t00200100": ("IS", t + 1)})
    expect("the first of three times", root / "time", HU, "time 0 is taken")
    info, _, told = read(root / "time", "--time", "2")
    check("the third", info["range"] == [HU.min() + 40, HU.max() + 40], (told, info))


def test_padding_larger_than_memory():
    """Padding in the first slice alone is found when others are stored already: all are read once more."""
    planes = np.random.default_rng(1).integers(-900, 900, (64, 420, 500)).astype(np.int16)
    planes[0, :20] = -2000
    write_slices(root / "large", planes, line(64, (0, 0, 1)), extra=lambda n: {"t00280120": ("SS", -2000)})
    pictures = []
    for limit in ([], ["--max-memory", "32M"]):
        out = root / f"large{len(limit)}.npy"
        told = subprocess.run([PROGRAM, "info", "--json", str(root / "large"), *limit], capture_output=True, text=True)
        drawn = subprocess.run([PROGRAM, "render", str(root / "large"), "--size", "40x30", "--shadow-resolution", "32", "--ambient", "0.3",
                                "--quiet", "-o", str(out), *limit], capture_output=True, text=True)
        pictures.append((told.stdout, out.read_bytes() if out.exists() else drawn.stderr))
    check("padding in a volume larger than memory", len(pictures[0][0]) > 0 and pictures[0] == pictures[1],
          [p if isinstance(p, str) else "" for pair in pictures for p in pair])


def test_values():
    positions = line(6, (0, 0, 1))
    write_slices(root / "pet", CT, positions, extra=lambda n: {"t00281053": ("DS", 0.5 + n), "t00281052": ("DS", 0)})
    expect("a rescaling of each slice", root / "pet", CT * (0.5 + np.arange(6))[:, None, None], tolerance=1e-3)
    padded = CT.copy()
    padded[:, 0, 0] = -2000
    values = HU.copy()
    values[:, 0, 0] = np.nan
    write_slices(root / "padding", padded, positions, extra=lambda n: {"t00280120": ("SS", -2000)})
    expect("padding is transparent", root / "padding", values)
    test_padding_larger_than_memory()
    bits = (CT & 0xfff).astype(np.uint16)
    signed = np.where(bits >= 2048, bits.astype(int) - 4096, bits)
    twelve = {"t00280101": ("US", 12), "t00280102": ("US", 11)}
    write_slices(root / "12", bits | 0xf000, positions, extra=lambda n: twelve)
    expect("12 of 16 bits", root / "12", bits * 2.0 - 1024)
    write_slices(root / "12s", bits | 0x3000, positions, extra=lambda n: {**twelve, "t00280103": ("US", 1)})
    expect("12 signed bits of 16", root / "12s", signed * 2.0 - 1024)
    mono = {"t00280004": ("CS", "MONOCHROME1"), "t00080060": ("CS", "MG"), **twelve}
    write_slices(root / "mono", bits, positions, extra=lambda n: mono)
    expect("MONOCHROME1 is turned around", root / "mono", (4095 - bits) * 2.0 - 1024)


def test_enhanced():
    positions = line(6, (0, 0.5, 1.5))
    order = [3, 0, 5, 1, 4, 2]
    frames = [{0x00209113: ("SQ", [{0x00200032: ("DS", [float(x) for x in positions[n]])}]),
               0x00289145: ("SQ", [{0x00281052: ("DS", float(n)), 0x00281053: ("DS", 1 + n)}])} for n in order]
    shared = {0x00209116: ("SQ", [{0x00200037: ("DS", [1, 0, 0, 0, 1, 0])}]),
              0x00289110: ("SQ", [{0x00280030: ("DS", [0.75, 0.5]), 0x00180050: ("DS", 9)}])}
    wanted = np.stack([CT[n] * (1.0 + n) + n for n in range(6)])
    for syntax, name in ((EXPLICIT, "explicit"), (IMPLICIT, "implicit"), (BIG, "big-endian"), (RLE, "run lengths")):
        items = {0x00080060: ("CS", "MR"), 0x0020000e: ("UI", "1.2.9"), 0x52009229: ("SQ", [shared]),
                 0x52009230: ("SQ", frames)}
        items.update(pixel_elements([CT[n] for n in order], syntax))
        path = root / f"enhanced-{name.replace(' ', '-')}.dcm"
        path.write_bytes(dicom_file(items, syntax))
        info = expect(f"an enhanced file, {name}", path, wanted, tolerance=1e-3)
        third = np.array(info["direction"])[:, 2] * info["spacing"][2] if info else None
        check("its third axis", info and np.allclose(third, [0, 0.5, 1.5]), third)


def test_syntaxes():
    positions = line(6, (0, 0, 1))
    for name, syntax in (("implicit", IMPLICIT), ("big-endian", BIG), ("deflated", DEFLATED), ("run lengths", RLE)):
        folder = root / name.replace(" ", "-")
        write_slices(folder, CT, positions, syntax=syntax)
        expect(f"{name} slices", folder, HU)
    corpus = pathlib.Path(__file__).parent.parent / "fuzz" / "corpus" / "dicom"  # written by GDCM
    few = np.array([[[1, 2, 3, 9], [-4, 5, 90, 7], [8, 8, 8, 8]]]) * 2.0 - 1024
    expect("a lossless JPEG slice", corpus / "slice-lossless", few)
    info, _, told = read(corpus / "slice-jpegls")
    if info is None and "no CharLS" in told:
        print("skipped: JPEG-LS, without CharLS")
    else:
        expect("a JPEG-LS slice", corpus / "slice-jpegls", few)
    deep = np.random.RandomState(4).randint(0, 4096, (6, 19, 30)).astype(np.uint16)
    write_slices(root / "jpeg12", deep, positions, syntax=EXTENDED, extra=lambda n: {"t00280101": ("US", 12),
                                                                                     "t00280102": ("US", 11)})
    expect("JPEG slices of 12 bits", root / "jpeg12", deep * 2.0 - 1024, tolerance=2 * 2)  # coefficients are rounded
    write_slices(root / "jpeg12c", deep[:2], positions[:2], syntax=EXTENDED, extra=lambda n: {
        "t00280002": ("US", 3), "t00280004": ("CS", "RGB"), "t00280101": ("US", 12), "t00280102": ("US", 11)})
    for path in (root / "jpeg12c").iterdir():
        data = path.read_bytes()
        frame, at = data.index(b"\xff\xd8"), data.index(b"\xff\xc1")
        length, = struct.unpack_from("<I", data, frame - 4)
        three = b"\3" + b"".join(bytes([c, 0x11, 0]) for c in (1, 2, 3))
        path.write_bytes(data[:frame - 4] + struct.pack("<I", length + 6) + data[frame:at + 2] + struct.pack(">H", 17) +
                         data[at + 4:at + 9] + three + data[at + 13:])
    info, _, told = read(root / "jpeg12c")
    check("colour JPEG of 12 bits is refused", info is None and told.count("\n") == 1 and
          "lossy JPEG of 3 components of 12 bits: 1 of 12 bits is read, or 8 bits" in told, told)
    try:
        from PIL import features
    except ImportError:
        return
    smooth = np.clip(np.arange(24)[:, None] * 4 + np.arange(32)[None] * 3 + np.arange(6)[:, None, None], 0, 255)
    smooth = smooth.astype(np.uint8)
    write_slices(root / "jpeg", smooth, positions, syntax=BASELINE)
    expect("JPEG slices", root / "jpeg", smooth * 2.0 - 1024, tolerance=8)
    if features.check("jpg_2000"):
        write_slices(root / "jpeg2000", smooth, positions, syntax=JPEG_2000)
        expect("JPEG 2000 slices", root / "jpeg2000", smooth * 2.0 - 1024)


def test_bundles():
    archive = root / "slices.zip"
    with zipfile.ZipFile(archive, "w", zipfile.ZIP_DEFLATED) as out:
        for n, path in enumerate(sorted((root / "plain").iterdir())):
            out.write(path, f"disc/{n}.dcm", zipfile.ZIP_STORED if n % 2 else zipfile.ZIP_DEFLATED)
    expect("a zip archive", archive, HU, spacing=[0.5, 0.75, 2.5])
    disc = root / "disc"
    (disc / "images").mkdir(parents=True)
    records = []
    for n, path in enumerate(sorted((root / "plain").iterdir())):
        shutil.copy(path, disc / "images" / f"im{n}")
        records.append({0x00041500: ("CS", f"IMAGES\\IM{n}")})
    records.append({0x00041500: ("CS", "..\\plain\\other")})
    (disc / "DICOMDIR").write_bytes(dicom_file({0x00041220: ("SQ", records)}, EXPLICIT))
    expect("a DICOMDIR", disc / "DICOMDIR", HU, warning="1 links or names that lead elsewhere, or to nothing, are left out")
    linked = root / "linked"
    write_slices(linked, CT, line(6, (0, 0, 2.5)))
    (linked / "out").symlink_to(root / "two" / "b" / next((root / "two" / "b").iterdir()).name)
    (linked / "around").symlink_to(linked)
    expect("links that lead elsewhere", linked, HU, "2 links or names that lead elsewhere")
    one = next((root / "plain").iterdir())
    info, _, told = read(one)
    check("one slice", info and info["dimensions"] == [5, 4, 1] and info["spacing"] == [0.5, 0.75, 9], (told, info))


def test_damage():
    """Every length of a file, and every byte of its header changed: a volume, or an error of one line."""
    sources = [next((root / "plain").iterdir()), root / "enhanced-implicit.dcm", next((root / "run-lengths").iterdir()),
               next((root / "deflated").iterdir())]
    folder, failed = root / "damaged", []
    folder.mkdir()
    for s, source in enumerate(sources):
        content, paths = source.read_bytes(), []
        step = max(1, len(content) // 250)
        for n in range(132, len(content), step):
            changed = bytearray(content)
            changed[n] ^= 1 << n % 8
            for kind, data in (("cut", content[:n]), ("changed", bytes(changed))):
                path = folder / f"{s}-{kind}-{n}.dcm"
                path.write_bytes(data)
                paths.append(str(path))
        pairs = [word for path in paths for word in (path, "-")]
        told = subprocess.run([DUMP, *pairs], capture_output=True, text=True, timeout=200, errors="replace")
        lines = [json.loads(each) for each in told.stdout.splitlines()]
        if told.returncode < 0 or len(lines) != len(paths):
            failed.append(f"{source.name}: ended after {len(lines)} of {len(paths)}")
    check("damaged files", not failed, failed)
    small = zipfile.ZipFile(root / "bomb.zip", "w", zipfile.ZIP_DEFLATED)
    small.writestr("a.dcm", b"\0" * 128 + b"DICM" + b"\0" * 50_000_000)
    small.close()
    _, _, told = read(root / "bomb.zip", "--max-memory", "4M")
    check("an archive's bomb under a memory limit", told.count("\n") == 1, told)


ramp = np.random.RandomState(1).randint(-1000, 2000, (6, 4, 5))
CT = ramp.astype(np.int16)
HU = CT * 2.0 - 1024
root = pathlib.Path(tempfile.mkdtemp(prefix="halflight-dicom-"))
try:
    for test in (test_geometry, test_gaps, test_series, test_values, test_enhanced, test_syntaxes, test_bundles,
                 test_damage):
        test()
finally:
    shutil.rmtree(root, ignore_errors=True)
print(f"{len(problems)} problems")
sys.exit(1 if problems else 0)
