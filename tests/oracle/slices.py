#!/usr/bin/python3
"""Folders of numbered pictures, written by Pillow, and what must be read from them.

usage: slices.py DUMP_VOLUME HALFLIGHT
Order by number, kinds and depths, grey that was stored as colours, several series, gaps, archives, and files cut at many
lengths. Exit 77: numpy or Pillow is missing.
"""
import json
import pathlib
import shutil
import struct
import subprocess
import sys
import tempfile
import zipfile

try:
    import numpy as np
    from PIL import Image
except ImportError as absent:
    print("skipped:", absent)
    sys.exit(77)

DUMP, PROGRAM = sys.argv[1:3]
root = pathlib.Path(tempfile.mkdtemp(prefix="halflight-slices-"))
random = np.random.RandomState(1)
GREY = random.randint(0, 256, (12, 9, 13)).astype(np.uint8)
DEEP = random.randint(0, 65536, (12, 9, 13)).astype(np.uint16)
problems = []


def check(name, condition, what=""):
    print("ok" if condition else "not ok", "-", name, "" if condition else f": {what}")
    if not condition:
        problems.append(name)


def read(path, *options):
    told = subprocess.run([PROGRAM, "info", "--json", str(path), *options], capture_output=True, text=True, timeout=60)
    if told.returncode != 0:
        return None, told.stderr
    subprocess.run([DUMP, str(path), str(root / "voxels")], capture_output=True, timeout=60, check=True)
    info = json.loads(told.stdout)
    return np.fromfile(root / "voxels").reshape(info["dimensions"][::-1]) if not options else info, told.stderr


def write(name, planes, pattern, **options):
    folder = root / name
    folder.mkdir()
    for n, plane in enumerate(planes):
        image = Image.fromarray(plane)
        image.save(folder / pattern.format(n + 1), **options)
    return folder


def expect(name, path, wanted, warning="", tolerance=0):
    found, told = read(path)
    good = found is not None and found.shape == wanted.shape
    check(name, good and np.abs(found - wanted).max() <= tolerance, told if found is None else found.shape)
    check(f"{name}: what is told", warning in told if warning else told == "", told)


def test_kinds():
    colors = np.stack([GREY, GREY[::-1], GREY // 2], -1)
    expect("PNG, without zeros before the numbers", write("png", GREY, "s_{}.png"), GREY)
    expect("PNG of 16 bits", write("png16", DEEP, "s-{:03}.png"), DEEP)
    for name, options in (("tiff", {}), ("lzw", {"compression": "tiff_lzw"})):
        expect(f"TIFF, {name}", write(name, DEEP, "{:02}.tif", **options), DEEP)
    smooth = np.broadcast_to(np.arange(13, dtype=np.uint8) * 9, (12, 9, 13)).copy()
    expect("JPEG", write("jpeg", smooth, "{}.JPG", quality=100), smooth, tolerance=1)
    expect("bits", write("bits", GREY > 99, "{:04}.png"), GREY > 99)
    expect("grey as colours", write("grey", np.repeat(GREY[..., None], 3, -1), "{}.png"), GREY)
    luminance = (colors.astype(int) @ [54, 183, 19] + 128) // 256
    expect("colours", write("colors", colors, "{}.png"), luminance)
    expect("colours, TIFF", write("tiff_colors", colors, "{}.tif"), luminance)
    alpha = np.concatenate([colors, GREY[..., None]], -1)
    expect("colours with alpha", write("alpha", alpha, "{}.png"), GREY)
    info, _ = read(root / "alpha", "--component", "luminance")
    check("luminance in place of alpha", info["mean"] == luminance.mean() and info["component"] == "luminance", info)
    info, _ = read(root / "colors", "--component", "1")
    check("a colour", info["mean"] == colors[..., 1].mean(), info)
    palette = root / "palette"
    palette.mkdir()
    for n, plane in enumerate(GREY):
        image = Image.fromarray(plane // 64, "P")
        image.putpalette([0, 0, 0, 80, 80, 80, 160, 160, 160, 240, 240, 240])
        image.save(palette / f"{n}.png")
    expect("a grey palette", palette, GREY // 64 * 80.0)


def test_folders():
    shutil.copytree(root / "png", root / "two")
    shutil.copy(root / "png" / "s_1.png", root / "two" / "thumb_1.png")
    (root / "two" / "notes.txt").write_text("no slice")
    expect("the longest of two series", root / "two", GREY, "of 2 series of numbered pictures")
    shutil.copytree(root / "png", root / "gap")
    (root / "gap" / "s_5.png").unlink()
    expect("a number is missing", root / "gap", np.delete(GREY, 4, 0), "1 numbers are missing")
    with zipfile.ZipFile(root / "slices.zip", "w", zipfile.ZIP_DEFLATED) as archive:
        for path in sorted((root / "tiff").iterdir()):
            archive.write(path, f"a/{path.name}")
    expect("an archive", root / "slices.zip", DEEP)
    shutil.copytree(root / "png", root / "odd")
    Image.fromarray(GREY[0, :4]).save(root / "odd" / "s_7.png")
    found, told = read(root / "odd")
    check("a slice of another size", found is None and "s_7.png" in told and "take it out" in told, told)
    stacks = root / "stacks"
    stacks.mkdir()
    for time in range(3):
        Image.fromarray(DEEP[0]).save(stacks / f"t{time}.tif", save_all=True,
                                      append_images=[Image.fromarray(plane + time) for plane in DEEP[1:]])
    info, told = read(stacks, "--time", "2")
    check("stacks are time steps", info and info["dimensions"] == [13, 9, 12] and info["times"] == 3, told)


def write_raw(name, planes, pattern):
    folder = root / name
    folder.mkdir()
    for n, plane in enumerate(planes):
        (folder / pattern.format(n)).write_bytes(plane.tobytes())
    return folder


def test_raw():
    signed = (DEEP.astype(np.int32) - 32768).astype(np.int16)
    wide = DEEP.astype(np.uint32) * 4099 + 1  # floats round some of them
    for name, planes, pattern in (
            ("scan_13x9_uint16", DEEP, "{}.raw"), ("of_names", DEEP, "s{:03}_13x9_uint16.raw"), ("last", GREY, "13x9x1_uint8_{}.raw"),
            ("big_13x9_uint16_be", DEEP.astype(">u2"), "a{}.raw"), ("little_13x9_int16_le", signed.astype("<i2"), "a.{:04}.raw"),
            ("floats_13x9_float32", GREY.astype("<f4"), "{}.raw"), ("ids_13x9_uint32", wide, "{}.raw"),
            ("bin_13x9_uint16", DEEP, "z{}.bin"), ("img_13x9_uint16", DEEP, "{:04}.img")):
        expect(f"raw slices {name}/{pattern}", write_raw(name, planes, pattern), planes.astype(np.float64))
    expect("raw slices in an archive", pack("raw.zip", sorted((root / "of_names").iterdir())), DEEP.astype(np.float64))
    found, told = read(write_raw("unsaid", GREY, "{}.raw"))
    check("raw slices whose names say nothing", found is None and "raw slices need their size and type" in told, told)
    (root / "of_names/s003_13x9_uint16.raw").write_bytes(b"short")
    found, told = read(root / "of_names")
    check("a raw slice of another length", found is None and
          "s003_13x9_uint16.raw: its name promises 13 x 9 voxels of uint16, the file has 5 bytes" in told, told)
    (root / "far_4000000000x4000000000_uint8").mkdir()
    for n in range(2):
        (root / f"far_4000000000x4000000000_uint8/{n}.raw").write_bytes(b"x")
    found, told = read(root / "far_4000000000x4000000000_uint8")
    check("raw slices that promise more than there is", found is None and "the file has 1 bytes" in told, told)
    found, told = read(write_raw("volumes", [GREY, GREY], "v{}_13x9x12_uint8.raw"))
    check("raw volumes are no slices", found is None and "a folder in which no volume was found" in told, told)


def pack(name, paths):
    with zipfile.ZipFile(root / name, "w", zipfile.ZIP_DEFLATED) as archive:
        for path in paths:
            archive.write(path, f"a/{path.name}")
    return root / name


def write_ome(folder):
    """An OME-TIFF with a file for each slice; the slice of file n is plane n."""
    data = "".join(f'<TiffData FirstZ="{z}" IFD="0" PlaneCount="1"><UUID FileName="m{z}.tif">urn:uuid:{z}</UUID></TiffData>'
                   for z in range(len(DEEP)))
    xml = ('<OME xmlns="http://www.openmicroscopy.org/Schemas/OME/2016-06"><Image ID="Image:0"><Pixels ID="Pixels:0" '
           f'DimensionOrder="XYZCT" Type="uint16" SizeX="13" SizeY="9" SizeZ="{len(DEEP)}" SizeC="1" SizeT="1">'
           f'<Channel ID="Channel:0:0" SamplesPerPixel="1"/>{data}</Pixels></Image></OME>')
    folder.mkdir()
    for z, plane in enumerate(DEEP):
        Image.fromarray(plane).save(folder / f"m{z}.tif", tiffinfo={270: xml})
    return sorted(folder.iterdir())


def test_archives():
    stacks = sorted((root / "stacks").iterdir())
    info, told = read(pack("stacks.zip", stacks), "--time", "2")
    check("stacks in an archive are time steps", info and info["dimensions"] == [13, 9, 12] and info["times"] == 3 and
          abs(info["mean"] - np.concatenate([DEEP[:1], DEEP[1:] + 2]).mean()) < 1e-3, told)
    expect("one stack in an archive", pack("one.zip", stacks[:1]), DEEP)
    shutil.copy(stacks[0], root / "plain.tif")
    expect("one file without a number in an archive", pack("plain.zip", [root / "plain.tif"]), DEEP)
    found, told = read(pack("nested.zip", [root / "plain.zip"]))
    check("an archive in an archive", found is None and "a zip archive within another: unpack it" in told, told)
    ome = write_ome(root / "ome")
    expect("an OME-TIFF of several files", root / "ome", DEEP)
    expect("an OME-TIFF of several files in an archive", pack("ome.zip", ome), DEEP)
    found, told = read(pack("ome-cut.zip", ome[:5]))
    check("a file of an OME-TIFF is not in its archive", found is None and "the archive has no such file" in told, told)
    whole = (root / "ome.zip").read_bytes()
    for length in range(0, len(whole), len(whole) // 40):
        (root / "cut.zip").write_bytes(whole[:length])
        told = subprocess.run([PROGRAM, "info", root / "cut.zip"], capture_output=True, text=True, timeout=60)
        if told.returncode != 3 or told.stderr.count("\n") != 1:
            check(f"an archive cut after {length} bytes", False, told)


def write_overlapping_pages(path, entries, pages, start=0x30008):
    """A chain of TIFF pages, each of which begins 12 bytes after the one before: their tags are the same bytes."""
    def unit(tag, value):
        return struct.pack("<HHHIH", entries, tag, 3, 1, value)
    units = [unit(254, 1)] * (entries + pages + 1)
    units[entries - 12:entries - 3] = [unit(*tag) for tag in ((256, 1), (257, 1), (258, 8), (259, 1), (262, 1), (273, 8), (277, 1),
                                                              (278, 1), (279, 1))]
    data = bytearray(b"II*\0" + struct.pack("<I", start) + bytes(start - 8) + b"".join(units) + bytes(64))
    for n in range(pages):
        struct.pack_into("<I", data, start + 2 + 12 * (n + entries), start + 12 * (n + 1) if n + 1 < pages else 0)
    path.write_bytes(data)
    return path


def test_hostile_pages():
    """Libtiff's time grows with pages times the square of their tags: 3.4 s, and minutes, were it given these."""
    for entries, pages, words in ((500, 480, "their tags lie over each other"), (4000, 3900, "a page of 4000 tags")):
        found, told = read(write_overlapping_pages(root / f"{entries}.tif", entries, pages))
        check(f"pages that share {entries} tags", found is None and words in told.splitlines()[-1], told)


def test_damage():
    for name, path in (("png", "s_6.png"), ("png16", "s-006.png"), ("tiff", "06.tif"), ("jpeg", "6.JPG")):
        folder = root / f"cut-{name}"
        shutil.copytree(root / name, folder)
        whole = (folder / path).read_bytes()
        for length in sorted({0, 1, 2, 7, 8, 20, *range(33, len(whole), max(1, len(whole) // 25))}):
            (folder / path).write_bytes(whole[:length])
            told = subprocess.run([PROGRAM, "info", folder], capture_output=True, text=True, timeout=60)
            if told.returncode not in (0, 3) or (told.returncode == 3 and told.stderr.count("\n") != 1):
                check(f"{path} cut after {length} bytes", False, told)
    bomb = root / "bomb"
    bomb.mkdir()
    head = (root / "png" / "s_1.png").read_bytes()
    for n in range(3):
        wide = bytearray(head)
        wide[16:24] = b"\x00\x00\xff\xff\x00\x00\xff\xff"
        import zlib
        wide[29:33] = zlib.crc32(wide[12:29]).to_bytes(4, "big")
        (bomb / f"{n}.png").write_bytes(wide)
    found, told = read(bomb)
    check("a picture that the file cannot hold", found is None and "can hold" in told, told)


test_kinds()
test_folders()
test_raw()
test_archives()
test_hostile_pages()
test_damage()
shutil.rmtree(root)
print(f"{len(problems)} problems")
sys.exit(1 if problems else 0)
