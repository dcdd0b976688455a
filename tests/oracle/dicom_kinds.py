#!/usr/bin/python3
"""Kinds of DICOM objects beyond plain series, written here element by element, and what must be read from them.

usage: dicom_kinds.py DUMP_VOLUME HALFLIGHT
Segmentations, mosaics, frames of nuclear medicine and of ultrasound volumes, places that are told in part, colours,
GE's private syntax, holes. Exit 77: numpy is missing.
"""
import json
import shutil
import struct
import subprocess
import sys

from dicom_files import (BIG, CT, DUMP, EXPLICIT, HU, IMPLICIT, check, dicom_file, expect, line, np, pixel_elements, problems, read,
                         root, slice_items, write_slices)

GE = "1.2.840.113619.5.2"
SHARED = {0x00209116: ("SQ", [{0x00200037: ("DS", [1, 0, 0, 0, 1, 0])}]),
          0x00289110: ("SQ", [{0x00280030: ("DS", [0.75, 0.5]), 0x00180050: ("DS", 2)}])}
VOXELS = np.random.RandomState(5).randint(0, 200, (7, 6, 5))


def third_axis(info):
    return np.array(info["direction"])[:, 2] * info["spacing"][2] if info else None


# ---- segmentations ----

def segmentation(masks, kind="BINARY", syntax=EXPLICIT, colors=None, most=255, names=None, positions=None):
    """masks: {number: {slice: [rows][columns]}}; frames of slices that are absent are not written."""
    frames, planes = [], []
    for number, slices in masks.items():
        for k, mask in slices.items():
            where = positions[k] if positions else [10.0, 20.0, 30.0 + 2 * k]
            frames.append({0x00209113: ("SQ", [{0x00200032: ("DS", [float(x) for x in where])}]),
                           0x0062000a: ("SQ", [{0x0062000b: ("US", number)}])})
            planes.append(np.asarray(mask))
    segments = []
    for number in masks:
        one = {0x00620004: ("US", number), 0x00620005: ("LO", (names or {}).get(number, f"organ{number}"))}
        if colors:
            one[0x0062000d] = ("US", colors[number])
        segments.append(one)
    items = {0x00080060: ("CS", "SEG"), 0x0020000e: ("UI", "1.2.9"), 0x00620001: ("CS", kind),
             0x00620002: ("SQ", segments), 0x52009229: ("SQ", [SHARED]), 0x52009230: ("SQ", frames),
             0x00280002: ("US", 1), 0x00280004: ("CS", "MONOCHROME2"), 0x00280008: ("IS", len(planes)),
             0x00280010: ("US", planes[0].shape[0]), 0x00280011: ("US", planes[0].shape[1]), 0x00280103: ("US", 0)}
    bits = 1 if kind == "BINARY" else 8
    items.update({0x00280100: ("US", bits), 0x00280101: ("US", bits), 0x00280102: ("US", bits - 1)})
    stacked = np.stack(planes).astype(np.uint8)
    data = np.packbits(stacked.ravel(), bitorder="little").tobytes() if bits == 1 else stacked.tobytes()
    if kind == "FRACTIONAL":
        items[0x0062000e] = ("US", most)
    items[0x7fe00010] = ("OB", data)
    return dicom_file(items, syntax)


def label_map(masks, shape):
    """The numbers of the segments, and how many voxels lie in several."""
    labels, count = np.zeros(shape), np.zeros(shape)
    for number, slices in masks.items():
        for k, mask in slices.items():
            labels[k][mask != 0] = number
            count[k] += mask != 0
    return labels, (count > 1).sum()


def test_segmentations():
    def masks_of(parts):
        return {number: {k: (VOXELS[k] + 37 * number) % 100 < 40 for k in range(*part)} for number, part in parts.items()}

    apart = {1: {k: VOXELS[k] < 60 for k in range(1, 4)}, 2: {k: VOXELS[k] > 120 for k in range(2, 7)}}
    wanted, shared = label_map(apart, VOXELS.shape)
    assert shared == 0
    for name, syntax in (("explicit", EXPLICIT), ("implicit", IMPLICIT), ("big-endian", BIG)):
        path = root / f"seg-{name}.dcm"
        path.write_bytes(segmentation(apart, syntax=syntax))
        info = expect(f"two segments, {name}", path, wanted[1:])
        check("their place", info and info["origin"] == [10, 20, 32] and info["spacing"] == [0.5, 0.75, 2], info)
    holes = {7: {k: VOXELS[k] < 90 for k in (0, 1, 2, 5, 6)}}  # nothing is invented where a segment has no frame
    path = root / "holes.dcm"
    path.write_bytes(segmentation(holes))
    expect("absent frames are empty", path, label_map(holes, VOXELS.shape)[0])
    many = {number: {number % 7: VOXELS[number % 7] == number % 50} for number in range(250, 300)}
    path = root / "many.dcm"
    path.write_bytes(segmentation(many))
    found = np.zeros(VOXELS.shape)
    for number, slices in many.items():
        for k, mask in slices.items():
            found[k][mask] = number
    info, values, told = read(path)
    check("numbers above 255", info and info["type"] == "uint16" and set(np.unique(values)) <= {0, *many}, (info, told))
    overlapping = masks_of({1: (0, 7), 2: (2, 5), 5: (0, 7)})
    path = root / "overlap.dcm"
    path.write_bytes(segmentation(overlapping))
    info, values, told = read(path)
    check("overlaps are told", info and "segments overlap" in told, told)
    seen = {number: np.zeros(VOXELS.shape, bool) for number in overlapping}
    for layer in range(info["components"]):
        out = root / f"layer{layer}"
        subprocess.run([DUMP, f"{path}#-1,-1,-1,{layer}", str(out)], check=True, capture_output=True)
        voxels = np.fromfile(out).reshape(VOXELS.shape)
        for number in overlapping:
            seen[number] |= voxels == number
    check("and kept", all(np.array_equal(seen[number][k], mask) for number, slices in overlapping.items()
                          for k, mask in slices.items()), info["components"])
    fractions = {3: {k: VOXELS[k] for k in range(7)}, 4: {k: 199 - VOXELS[k] for k in range(3)}}
    path = root / "fractions.dcm"
    path.write_bytes(segmentation(fractions, "FRACTIONAL", most=200))
    info = expect("fractions", path, VOXELS / 200, 'of 2 arrays, organ3 is taken', tolerance=1e-7)
    check("each segment is an array", info and [a["name"] for a in info["arrays"]] == ["organ3", "organ4"], info)
    info, _, told = read(path, "--array", "organ4")
    check("the other by its name", info and info["range"] == [0, 199 / 200], (info, told))


def test_label_map_kind():
    """The newer segmentations, whose pixels are segments' numbers."""
    planes = [(VOXELS[k] % 3).astype(np.uint8) for k in range(7)]
    frames = [{0x00209113: ("SQ", [{0x00200032: ("DS", [0.0, 0.0, 2.0 * k])}])} for k in range(7)]
    items = {0x00080060: ("CS", "SEG"), 0x0020000e: ("UI", "1.2.9"), 0x00620001: ("CS", "LABELMAP"),
             0x00620002: ("SQ", [{0x00620004: ("US", n), 0x00620005: ("LO", f"part {n}")} for n in (1, 2)]),
             0x52009229: ("SQ", [SHARED]), 0x52009230: ("SQ", frames)}
    items.update(pixel_elements(planes, EXPLICIT))
    items[0x00280120] = ("US", 0)  # a picture shows nothing there: it is the background
    path = root / "labelmap.dcm"
    path.write_bytes(dicom_file(items, EXPLICIT))
    expect("a label map of segments", path, np.stack(planes).astype(float))


def test_letters():
    """Names in Latin-1 and in UTF-8, also one that is cut in the middle of a letter."""
    masks = {1: {k: VOXELS[k] < 60 for k in range(3)}}
    for name, coded in (("Körper".encode("latin-1"), "Körper"), ("Körper".encode(), "Körper"), (b"x" + 63 * "é".encode(), "x" + 63 * "é"),
                        (b"xx" + 63 * "é".encode(), "xx" + 62 * "é")):
        data = segmentation(masks, names={1: "y" * len(name)}).replace(b"y" * len(name), name)
        path = root / "letters.dcm"
        path.write_bytes(data)
        info, _, told = read(path)
        check(f"the name {coded}", info and info["segments"][0]["name"] == coded, (told, info and info["segments"]))


# ---- mosaics ----

def csa_header(fields, second=True):
    """Siemens' private header: {name: [texts]}."""
    content = (b"SV10\4\3\2\1" if second else b"") + struct.pack("<II", len(fields), 77)
    for name, texts in fields.items():
        content += name.encode().ljust(64, b"\0") + struct.pack("<i4sii", len(texts), b"FD\0\0", 4, len(texts) + 1)
        content += struct.pack("<I", 77)
        for text in [*texts, ""]:
            data = text.encode() + (b"\0" if text else b"")
            size = len(data)
            content += struct.pack("<4I", *((77, size, 77, size) if second else (size, 0, 77, 0)))
            content += data + b"\0" * (-size % 4)
    return content


def test_mosaics():
    tiles = np.zeros((18, 15), np.int16)
    for k in range(7):
        y, x = divmod(k, 3)
        tiles[6 * y:6 * y + 6, 5 * x:5 * x + 5] = VOXELS[k]
    for name, told, sign in (
            ("a number", {0x00190010: ("LO", "SIEMENS MR HEADER"), 0x0019100a: ("US", 7)}, 1),
            ("another block", {0x00190010: ("LO", "OTHER"), 0x00190011: ("LO", "SIEMENS MR HEADER"), 0x0019110a: ("US", 7)}, 1),
            ("a CSA header", {0x00290010: ("LO", "SIEMENS CSA HEADER"), 0x00291010: ("OB", csa_header(
                {"EchoLinePosition": ["32"], "NumberOfImagesInMosaic": ["7"], "SliceNormalVector": ["0.0", "0.0", "1.0"]}))}, 1),
            ("an old CSA header", {0x00290010: ("LO", "SIEMENS CSA HEADER"), 0x00291010: ("OB", csa_header(
                {"NumberOfImagesInMosaic": ["7"], "SliceNormalVector": ["0.0", "0.0", "-1.0"]}, False))}, -1)):
        extra = {"t%08x" % tag: value for tag, value in told.items()}
        extra |= {"t00080008": ("CS", "ORIGINAL\\PRIMARY\\M\\ND\\MOSAIC"), "t00280030": ("DS", [0.5, 0.25]),
                  "t00180088": ("DS", 2), "t00281052": ("DS", 0), "t00281053": ("DS", 1)}
        path = root / f"mosaic-{name.replace(' ', '-')}.dcm"
        path.write_bytes(dicom_file(slice_items(tiles, [8.75, 17, 30], 1, **extra), EXPLICIT))
        info = expect(f"a mosaic with {name}", path, VOXELS[::sign].astype(float), spacing=[0.25, 0.5, 2])
        check("its place", info and np.allclose(info["origin"], [10, 20, 30 - (0 if sign > 0 else 12)]), info)
    untold = {"t00080008": ("CS", "ORIGINAL\\PRIMARY\\MOSAIC")}
    path = root / "mosaic-untold.dcm"
    path.write_bytes(dicom_file(slice_items(tiles, [0, 0, 0], 1, **untold), EXPLICIT))
    info, _, told = read(path)
    check("a mosaic of untold slices", info and "does not tell how many" in told, told)


# ---- frames without places of their own, and in a volume's space ----

def test_nuclear_medicine():
    base = {0x00080060: ("CS", "NM"), 0x0020000e: ("UI", "1.2.9"), 0x00180050: ("DS", 4), 0x00280030: ("DS", [0.5, 0.25]),
            0x00540022: ("SQ", [{0x00200032: ("DS", [10.0, 20.0, 30.0]), 0x00200037: ("DS", [1, 0, 0, 0, 1, 0])}])}
    planes = list(VOXELS.astype(np.uint16))
    for step, third in ((-2, (0, 0, -2)), (3, (0, 0, 3)), (None, (0, 0, 4))):
        items = dict(base)
        if step is not None:
            items[0x00180088] = ("DS", step)
        items.update(pixel_elements(planes, EXPLICIT))
        path = root / f"nm{step}.dcm"
        path.write_bytes(dicom_file(items, EXPLICIT))
        info = expect(f"slices {step} apart", path, VOXELS.astype(float))
        check("their axis", info and np.allclose(third_axis(info), third) and info["origin"] == [10, 20, 30], info)
    gated = [planes[k] + 300 * slot for slot in range(2) for k in range(7)]
    items = dict(base)
    items[0x00540070] = ("US", [1 + n // 7 for n in range(14)])
    items[0x00540080] = ("US", [1 + n % 7 for n in range(14)])
    items[0x00180088] = ("DS", 2)
    items.update(pixel_elements(gated, EXPLICIT))
    path = root / "gated.dcm"
    path.write_bytes(dicom_file(items, EXPLICIT))
    info = expect("time slots are times", path, VOXELS.astype(float), "time 0 is taken")
    check("two of them", info and info["times"] == 2, info)
    items = dict(base)
    items[0x00540050] = ("US", [1] * 7)
    items.update(pixel_elements(planes, EXPLICIT))
    path = root / "projections.dcm"
    path.write_bytes(dicom_file(items, EXPLICIT))
    info, _, told = read(path)
    check("projections are told", info and "projections from several sides" in told, told)


def test_films():
    """Frames that the Frame Increment Pointer says are times (PS3.3, C.7.6.6) are times of one slice."""
    planes = list(VOXELS.astype(np.uint8))
    for syntax in (EXPLICIT, IMPLICIT):
        for increment in (0x1063, 0x1065):
            items = {0x00080060: ("CS", "US"), 0x0020000e: ("UI", "1.2.9"), 0x00181063: ("DS", 33.3), 0x00280009: ("US", [0x18, increment])}
            items.update(pixel_elements(planes, syntax))
            path = root / "film.dcm"
            path.write_bytes(dicom_file(items, syntax))
            info = expect(f"a film's first frame, {increment:x}", path, VOXELS[:1].astype(float), "time 0 is taken")
            check("its times", info and info["times"] == 7, info)
            info = json.loads(subprocess.run([sys.argv[2], "info", "--json", path, "--time", "4"], capture_output=True, text=True).stdout)
            check("another of them", info["mean"] == VOXELS[4].astype(np.uint8).mean(), info)
    items[0x00280009] = ("US", [0x54, 0x80])
    path.write_bytes(dicom_file(items, syntax))
    info = expect("frames that are slices stay slices", path, VOXELS.astype(float), "tell no positions")


def test_ultrasound_volume():
    order = range(6, -1, -1)
    shared = {0x0020930f: ("SQ", [{0x00209302: ("FD", [1.0, 0, 0, 0, 1.0, 0])}]), 0x00289110: SHARED[0x00289110]}
    frames = [{0x0020930e: ("SQ", [{0x00209301: ("FD", [10.0, 20.0, 30.0 + 2 * k])}])} for k in order]
    for syntax in (EXPLICIT, IMPLICIT):
        items = {0x00080060: ("CS", "US"), 0x0020000e: ("UI", "1.2.9"), 0x52009229: ("SQ", [shared]), 0x52009230: ("SQ", frames)}
        items.update(pixel_elements([VOXELS[k].astype(np.uint8) for k in order], syntax))
        path = root / "us.dcm"
        path.write_bytes(dicom_file(items, syntax))
        info = expect("an ultrasound volume", path, VOXELS.astype(float), spacing=[0.5, 0.75, 2])
        check("its place", info and info["origin"] == [10, 20, 30] and info["space"] is None, info)


# ---- places that are told in part ----

def without(folder, *tags):
    """Renames elements, so that they are not known."""
    for path in folder.iterdir():
        data = path.read_bytes()
        for tag in tags:
            data = data.replace(struct.pack("<HH", tag >> 16, tag & 0xffff) + b"DS", struct.pack("<HH", tag >> 16, 0x3f) + b"DS")
        path.write_bytes(data)


def test_partial_places():
    positions = line(6, (0, 0, 2.5))
    write_slices(root / "locations", CT, positions, extra=lambda n: {"t00201041": ("DS", 7 + 2.5 * n)})
    without(root / "locations", 0x00200032)
    expect("locations without positions", root / "locations", HU, "their locations", [0.5, 0.75, 2.5])
    write_slices(root / "one-place", CT, [positions[0]] * 6, extra=lambda n: {"t00201041": ("DS", 7 + 2.5 * n)})
    expect("locations where positions are all the same", root / "one-place", HU, "their locations", [0.5, 0.75, 2.5])
    for name, step, taken in (("axial", (0, 0, 2.5), "axial"), ("coronal", (0, 2.5, 0), "coronal"), ("sagittal", (-2.5, 0, 0), "sagittal")):
        write_slices(root / f"bare-{name}", CT, line(6, step))
        without(root / f"bare-{name}", 0x00200037)
        info = expect(f"positions without orientation, {name}", root / f"bare-{name}", HU, f"taken for {taken}", [0.5, 0.75, 2.5])
        check("their axis", info and np.allclose(third_axis(info), step), info)
    write_slices(root / "hole", CT, [positions[0], positions[1], positions[2], *[[-10, 20, 5 + 2.5 * n] for n in (28, 29, 30)]])
    info, values, told = read(root / "hole")
    check("a hole stays empty", info and info["dimensions"][2] == 31 and np.isnan(values[3:28]).all() and
          np.array_equal(values[:3], HU[:3]) and np.array_equal(values[28:], HU[3:]) and "25 slices in wider holes are left empty" in told,
          (info, told))


def test_several_at_one_place():
    """Magnitude and phase have their own numbers from 1 on: the kind of the picture tells them apart."""
    positions = line(6, (0, 0, 2.5))
    for word, more in (("M", 0), ("P", 5000)):
        write_slices(root / "kinds" / word, (CT // 4 + more).astype(np.int16), positions, extra=lambda n, word=word: {
            "t00080008": ("CS", f"ORIGINAL\\PRIMARY\\{word}\\ND"), "t00200013": ("IS", 1 + (5 * n if word == "M" else n))})
    info, values, told = read(root / "kinds")
    pictures = [(CT // 4 + more) * 2.0 - 1024 for more in (0, 5000)]
    check("one kind of picture", info and info["times"] == 2 and any(np.array_equal(values, p) for p in pictures), told)


# ---- colours and syntaxes ----

def color_items(planes, photometric, more=None):
    items = {0x00080060: ("CS", "US"), 0x0020000e: ("UI", "1.2.9"), 0x00200032: ("DS", [0.0, 0.0, 0.0]),
             0x00200037: ("DS", [1, 0, 0, 0, 1, 0]), 0x00280030: ("DS", [1, 1])}
    items.update(pixel_elements([p[..., 0] if p.ndim == 3 else p for p in planes], EXPLICIT))
    items[0x00280004] = ("CS", photometric)
    if planes[0].ndim == 3:
        items[0x00280002] = ("US", 3)
        items[0x7fe00010] = ("OB", b"".join(p.tobytes() for p in planes))
    items.update(more or {})
    return items


def test_colors():
    random = np.random.RandomState(2)
    rgb = random.randint(0, 256, (4, 6, 5, 3)).astype(np.uint8)
    luma = (rgb.astype(int) @ [54, 183, 19] + 128) >> 8
    (root / "rgb.dcm").write_bytes(dicom_file(color_items(list(rgb), "RGB"), EXPLICIT))
    info = expect("RGB is colour", root / "rgb.dcm", luma.astype(float))
    check("by its luminance", info and info["component"] == "luminance", info)
    ybr = np.full((4, 6, 5, 3), 128, np.uint8)
    ybr[..., 0] = rgb[..., 0]
    (root / "ybr.dcm").write_bytes(dicom_file(color_items(list(ybr), "YBR_FULL"), EXPLICIT))
    expect("YBR is colour", root / "ybr.dcm", rgb[..., 0].astype(float))
    index = random.randint(8, 16, (4, 6, 5)).astype(np.uint8)
    tables = random.randint(0, 256, (3, 6)).astype(np.uint8)  # of the values 10 to 15
    at = np.clip(index.astype(int) - 10, 0, 5)
    colors = [tables[c][at].astype(int) for c in range(3)]
    wanted = ((54 * colors[0] + 183 * colors[1] + 19 * colors[2] + 128) >> 8).astype(float)
    for name, more in (
            ("of 8 bits", {0x00281101 + c: ("US", [6, 10, 8]) for c in range(3)} | {
                0x00281201 + c: ("OW", tables[c].tobytes()) for c in range(3)}),
            ("of 16 bits", {0x00281101 + c: ("US", [6, 10, 16]) for c in range(3)} | {
                0x00281201 + c: ("OW", (tables[c].astype("<u2") << 8).tobytes()) for c in range(3)}),
            ("in segments", {0x00281101 + c: ("US", [6, 10, 16]) for c in range(3)} | {
                0x00281221 + c: ("OW", struct.pack("<HH6H", 0, 6, *(int(v) << 8 for v in tables[c]))) for c in range(3)})):
        path = root / "palette.dcm"
        path.write_bytes(dicom_file(color_items(list(index), "PALETTE COLOR", more), EXPLICIT))
        expect(f"a palette {name}", path, wanted)
    (root / "line.dcm").write_bytes(dicom_file(color_items(list(index), "PALETTE COLOR", {
        0x00281101 + c: ("US", [256, 0, 16]) for c in range(3)} | {
        0x00281221 + c: ("OW", struct.pack("<6H", 0, 1, 0, 1, 255, 255 << 8)) for c in range(3)}), EXPLICIT))
    expect("a palette of a line", root / "line.dcm", index.astype(float))


def test_ge_private():
    """Elements are implicit and little-endian, pixels big-endian."""
    positions = line(6, (0, 0, 2.5))
    folder = root / "ge"
    folder.mkdir()
    for n, plane in enumerate(CT):
        items = slice_items(plane, positions[n], n, "1.2.3", BIG)
        data = dicom_file(items, IMPLICIT).replace(IMPLICIT.encode() + b"\0", GE.encode(), 1)
        at = data.index(GE.encode())
        data = data[:at - 2] + struct.pack("<H", len(GE)) + data[at:]
        grown = struct.unpack_from("<I", data, 140)[0] + len(GE) - len(IMPLICIT) - 1
        (folder / str(n)).write_bytes(data[:140] + struct.pack("<I", grown) + data[144:])
    expect("GE's private syntax", folder, HU, spacing=[0.5, 0.75, 2.5])


try:
    for test in (test_segmentations, test_label_map_kind, test_letters, test_mosaics, test_nuclear_medicine, test_films, test_ultrasound_volume,
                 test_partial_places, test_several_at_one_place, test_colors, test_ge_private):
        test()
finally:
    shutil.rmtree(root, ignore_errors=True)
print(f"{len(problems)} problems")
sys.exit(1 if problems else 0)
