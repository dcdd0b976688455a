#!/usr/bin/python3
"""DICOM series that are written here, element by element, and what must be read from them.

usage: dicom.py DUMP_VOLUME HALFLIGHT
Geometry, order, gaps, series, times, rescaling, padding and every transfer syntax that needs no codec library beyond
Pillow's, and the same files cut at many lengths. Exit 77: numpy is missing.
"""
import json
import pathlib
import shutil
import struct
import subprocess
import sys
import zipfile

from dicom_files import (BIG, CT, DUMP, EXPLICIT, EXTENDED, BASELINE, DEFLATED, HU, IMPLICIT, JPEG_2000, PROGRAM, RLE, check,
                         dicom_file, expect, line, np, pixel_elements, problems, read, root, write_slices)


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


try:
    for test in (test_geometry, test_gaps, test_series, test_values, test_enhanced, test_syntaxes, test_bundles,
                 test_damage):
        test()
finally:
    shutil.rmtree(root, ignore_errors=True)
print(f"{len(problems)} problems")
sys.exit(1 if problems else 0)
