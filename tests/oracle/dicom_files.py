"""A writer of DICOM files, element by element, and what the program reads from them, for the tests beside it.

A test that imports it is run with the arguments DUMP_VOLUME and HALFLIGHT. Exit 77: numpy is missing.
"""
import io
import json
import pathlib
import random
import struct
import subprocess
import sys
import tempfile
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


ramp = np.random.RandomState(1).randint(-1000, 2000, (6, 4, 5))
CT = ramp.astype(np.int16)
HU = CT * 2.0 - 1024
root = pathlib.Path(tempfile.mkdtemp(prefix="halflight-dicom-"))
