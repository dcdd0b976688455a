#!/usr/bin/python3
"""Pictures as other programs see them: Pillow, NumPy, exrheader, and decoders for what those cannot read.

usage: images.py IMAGE_PICTURES     (the test program beside this file)

Written by the library, read here: PNG of 8 and 16 bits with and without alpha, OpenEXR, NPY. Written here,
read by the library: PNG of Pillow's modes, NPY of NumPy's types. Exit status 77: a module is missing.
"""
import shutil
import struct
import subprocess
import sys
import tempfile
import zlib
from pathlib import Path

try:
    import numpy
    from PIL import Image
except ImportError as missing:
    print(f"skipped: {missing}")
    sys.exit(77)

BACKGROUND = numpy.array([0.5, 0.25, 0.125])


def decode_srgb(code):
    code = numpy.asarray(code, float)
    return numpy.where(code <= 0.04045, code / 12.92, ((code + 0.055) / 1.055) ** 2.4)


def encode_srgb(linear):
    linear = numpy.clip(linear, 0, 1)
    return numpy.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)


def known_picture():
    y, x = numpy.mgrid[0:37, 0:45]
    alpha = (x % 33) / 32
    picture = numpy.stack([alpha * (x + y) / 128, alpha * y * y / 2048, alpha * x * y / 1024, alpha], axis=2)
    picture[0] = 0
    return picture.astype("<f4")


def read_png(path):
    """A PNG of 8 or 16 bits as integers, height x width x channels (Pillow cuts 16 bits to 8)."""
    data, at, pixels = path.read_bytes(), 8, b""
    while at < len(data):
        length, kind = struct.unpack(">I4s", data[at:at + 8])
        body = data[at + 8:at + 8 + length]
        assert zlib.crc32(kind + body) == struct.unpack(">I", data[at + 8 + length:at + 12 + length])[0]
        if kind == b"IHDR":
            width, height, depth, colour, _, _, interlace = struct.unpack(">IIBBBBB", body)
            assert interlace == 0
        if kind == b"IDAT":
            pixels += body
        at += 12 + length
    channels = {0: 1, 2: 3, 4: 2, 6: 4}[colour]
    step, raw = channels * depth // 8, zlib.decompress(pixels)
    rows, above = [], bytearray(width * step)
    for y in range(height):
        start = y * (width * step + 1)
        kind, row = raw[start], bytearray(raw[start + 1:start + 1 + width * step])
        for i in range(len(row)):
            left = row[i - step] if i >= step else 0
            corner = above[i - step] if i >= step else 0
            up = above[i]
            nearest = min((left, up, corner), key=lambda v: abs(left + up - corner - v))
            row[i] = (row[i] + (0, left, up, (left + up) // 2, nearest)[kind]) & 255
        rows.append(row)
        above = row
    codes = numpy.frombuffer(b"".join(rows), ">u2" if depth == 16 else "u1")
    return codes.reshape(height, width, channels).astype(int)


def read_exr(path):
    """An OpenEXR file of float scanlines, ZIP or uncompressed chunks, as channels by name."""
    data = path.read_bytes()
    assert data[:8] == bytes([0x76, 0x2F, 0x31, 1, 2, 0, 0, 0])
    at, attributes = 8, {}
    while data[at] != 0:
        name_end = data.index(0, at)
        type_end = data.index(0, name_end + 1)
        size = struct.unpack("<i", data[type_end + 1:type_end + 5])[0]
        attributes[data[at:name_end].decode()] = data[type_end + 5:type_end + 5 + size]
        at = type_end + 5 + size
    x0, y0, x1, y1 = struct.unpack("<4i", attributes["dataWindow"])
    width, height = x1 - x0 + 1, y1 - y0 + 1
    channels = attributes["channels"]
    names = []
    while channels[0] != 0:
        end = channels.index(0)
        names.append(channels[:end].decode())
        assert struct.unpack("<i", channels[end + 1:end + 5])[0] == 2, "32-bit float"
        channels = channels[end + 17:]
    assert attributes["compression"] == b"\x03", "ZIP"
    planes = {name: numpy.zeros((height, width), "<f4") for name in names}
    for offset in struct.unpack(f"<{(height + 15) // 16}Q", data[at + 1:at + 1 + 8 * ((height + 15) // 16)]):
        first, size = struct.unpack("<ii", data[offset:offset + 8])
        chunk, lines = data[offset + 8:offset + 8 + size], min(16, height - first + y0)
        if size < lines * width * 4 * len(names):
            steps = numpy.frombuffer(zlib.decompress(chunk), "u1").astype(int)
            steps[1:] -= 128
            coded = (numpy.cumsum(steps) & 255).astype("u1")
            half = (len(coded) + 1) // 2
            plain = numpy.empty(len(coded), "u1")
            plain[0::2], plain[1::2] = coded[:half], coded[half:]
            chunk = plain.tobytes()
        values = numpy.frombuffer(chunk, "<f4").reshape(lines, len(names), width)
        for i, name in enumerate(names):
            planes[name][first - y0:first - y0 + lines] = values[:, i]
    return planes


def check_written(folder):
    picture = known_picture()
    assert numpy.load(folder / "picture.npy").dtype == numpy.dtype("<f4")
    assert numpy.array_equal(numpy.load(folder / "picture.npy"), picture)
    planes = read_exr(folder / "picture.exr")
    assert sorted(planes) == list("ABGR")
    assert all(numpy.array_equal(planes[c], picture[:, :, i]) for i, c in enumerate("RGBA"))
    if shutil.which("exrheader"):
        header = subprocess.check_output(["exrheader", folder / "picture.exr"], text=True)
        assert "zip" in header and "(0 0) - (44 36)" in header, header
        assert header.count("32-bit floating-point") == 4, header

    colour, alpha = picture[:, :, :3].astype(float), picture[:, :, 3:].astype(float)
    over = encode_srgb(colour + (1 - alpha) * BACKGROUND)
    with numpy.errstate(invalid="ignore"):
        alone = encode_srgb(numpy.where(alpha > 0, colour / alpha, 0))
    for name, truth, maximum in [("rgb8", over, 255), ("rgb16", over, 65535),
                                 ("rgba8", numpy.dstack([alone, alpha]), 255),
                                 ("rgba16", numpy.dstack([alone, alpha]), 65535)]:
        codes = read_png(folder / f"{name}.png")
        # 16 bits are rounded (a float's own rounding may tip a tie); 8 bits are dithered by under half a code
        assert codes.shape == truth.shape
        assert abs(codes - maximum * truth).max() < (1 if maximum == 255 else 0.51), name
        assert abs((codes - maximum * truth).mean()) < 0.05, name
        if maximum == 255:
            assert numpy.array_equal(codes[0], numpy.round(maximum * truth[0])), name
        seen = Image.open(folder / f"{name}.png")
        assert seen.info["halflight:scene"] == '{"halflight": 1}' and "srgb" in seen.info
        assert numpy.array_equal(numpy.asarray(seen), codes // (256 if maximum == 65535 else 1)), name


def convert(program, source, target):
    return subprocess.run([program, "convert", source, target], capture_output=True, text=True)


def check_read(program, folder):
    random = numpy.random.default_rng(1)
    rgba = random.integers(0, 256, (23, 31, 4), "u1")
    for mode in ["1", "L", "LA", "P", "RGB", "RGBA", "I;16"]:
        if mode == "I;16":
            source = Image.fromarray(random.integers(0, 65536, (23, 31), "u2"))
            truth = numpy.asarray(source)[:, :, None] / 65535
        else:
            source = Image.fromarray(rgba).convert("RGB" if mode == "P" else mode)
            source = source.quantize(64) if mode == "P" else source
            truth = numpy.asarray(source.convert("RGBA")) / 255
        source.save(folder / "in.png")
        done = convert(program, folder / "in.png", folder / "out.npy")
        assert done.returncode == 0, done.stderr
        alpha = truth[:, :, 3:] if truth.shape[2] == 4 else numpy.ones_like(truth[:, :, :1])
        expected = numpy.dstack([decode_srgb(truth[:, :, :3]) * alpha * numpy.ones(3), alpha])
        assert abs(numpy.load(folder / "out.npy") - expected).max() < 2e-7, mode

    floats = random.standard_normal((7, 5, 4))
    for array, good in [(floats.astype("f4"), True), (floats, True), (floats[:, :, :3].astype("f4"), True),
                        (floats[:, :, :1].copy(), True), (floats[:, :, 0].astype("f4"), True),
                        (floats.astype(">f4"), False), (numpy.asfortranarray(floats), False),
                        (floats.astype("f2"), False), (floats[:, :, :2].copy(), False),
                        (floats[0, 0], False)]:
        numpy.save(folder / "in.npy", array)
        done = convert(program, folder / "in.npy", folder / "out.exr")
        assert (done.returncode == 0) == good and (good or "expected" in done.stderr), done.stderr
        if good:
            planes = read_exr(folder / "out.exr")
            array = array.reshape(7, 5, -1).astype("f4")
            grey = array.shape[2] == 1
            for i, c in enumerate("RGB"):
                assert numpy.array_equal(planes[c], array[:, :, 0 if grey else i])
            alpha = array[:, :, 3] if array.shape[2] == 4 else numpy.ones((7, 5))
            assert numpy.array_equal(planes["A"], alpha)


def main():
    program = sys.argv[1]
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        subprocess.run([program, "write", folder], check=True)
        check_written(folder)
        check_read(program, folder)
    print("ok")


main()
