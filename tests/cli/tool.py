#!/usr/bin/env python3
"""What the command-line cases need besides the program: small volumes, and a look into its outputs.

Uses Python's standard library alone, so that it shares no reader with the program or its other tests.
"""
import ast
import json
import math
import struct
import sys
import zlib

import stacks


def ball(size, path):
    """A size^3 uint8 volume: 255 in a centred ball of 0.35 size radius, an edge of two voxels, air outside;
    a smaller ball stands beyond its +x, +y and +z side, so that no two views are equal."""
    n = int(size)

    def value(x, y, z):
        big = 0.35 * n - math.dist((x, y, z), (n / 2 - 0.5,) * 3)
        small = 0.1 * n - math.dist((x, y, z), (0.8 * n, 0.75 * n, 0.85 * n))
        return max(0, min(255, round(128 + 64 * max(big, small))))

    with open(path, "wb") as file:
        file.write(bytes(value(x, y, z) for z in range(n) for y in range(n) for x in range(n)))


def atlas(size, path):
    """A size^3 label map of 64-bit integers: a ball of four labels, two of which have one float."""
    n = int(size)
    middle = n / 2 - 0.5

    def label(x, y, z):
        if math.dist((x, y, z), (middle,) * 3) > 0.4 * n:
            return 0
        return ((997, 182305693), (614454277, 614454278))[z < middle][x < middle]

    with open(path, "wb") as file:
        file.write(f"NRRD0004\ntype: int64\ndimension: 3\nsizes: {n} {n} {n}\nendian: little\nencoding: raw\n\n".encode())
        for z in range(n):
            file.write(struct.pack(f"<{n * n}q", *(label(x, y, z) for y in range(n) for x in range(n))))


def read_npy(path):
    """(height, width, channels, numbers) of a float32 array."""
    data = open(path, "rb").read()
    assert data[:6] == b"\x93NUMPY", f"{path} is no .npy file"
    length, = struct.unpack("<H", data[8:10])
    header = ast.literal_eval(data[10:10 + length].decode())
    assert header["descr"] == "<f4" and not header["fortran_order"], header
    height, width, channels = (*header["shape"], 1)[:3]
    return height, width, channels, struct.unpack(f"<{height * width * channels}f", data[10 + length:])


def npy_shape(path):
    """height width channels"""
    print(*read_npy(path)[:3])


def brightness(path):
    """Mean of R + G + B over the left, right, upper and lower half: 'left right upper lower'."""
    height, width, channels, numbers = read_npy(path)
    sums = dict(left=0.0, right=0.0, upper=0.0, lower=0.0)
    for y in range(height):
        for x in range(width):
            light = sum(numbers[channels * (y * width + x):][:3])
            sums["left" if x < width / 2 else "right"] += light
            sums["upper" if y < height / 2 else "lower"] += light
    print(*(f"{2 * total / (width * height):.5f}" for total in sums.values()))


def coverage(path):
    """Width and height, in pixels, of the box of the pixels that are not empty."""
    height, width, channels, numbers = read_npy(path)
    covered = [(x, y) for y in range(height) for x in range(width) if numbers[channels * (y * width + x) + 3] > 0.01]
    assert covered, f"{path} is empty"
    xs, ys = [x for x, _ in covered], [y for _, y in covered]
    print(max(xs) - min(xs) + 1, max(ys) - min(ys) + 1)


def ratio(path, other):
    """How many times as great the second picture's sums of R, G, B and A are."""
    height, width, channels, a = read_npy(path)
    b = read_npy(other)[3]
    print(*(f"{sum(b[c::4]) / sum(a[c::4]):.4f}" for c in range(4)))


def shared_pixels(path, other):
    """Which part of the second picture's pixels the first, an odd number of times as wide, has at their centres."""
    height, width, channels, a = read_npy(path)
    rows, columns, _, b = read_npy(other)
    times = width // columns
    def pixel(numbers, n):
        return numbers[channels * n:channels * (n + 1)]
    same = sum(pixel(a, (times * y + times // 2) * width + times * x + times // 2) == pixel(b, y * columns + x)
               for y in range(rows) for x in range(columns))
    print(f"{same / (rows * columns):.2f}")


def sum_layers(picture, *layers):
    """The layers of three channels sum to the picture's RGB."""
    height, width, channels, numbers = read_npy(picture)
    parts = [read_npy(layer) for layer in layers]
    assert channels == 4 and all(part[:3] == (height, width, 3) for part in parts)
    for i in range(height * width):
        for c in range(3):
            total = sum(part[3][3 * i + c] for part in parts)
            assert abs(total - numbers[4 * i + c]) < 2e-6, f"pixel {i}: {total} is not {numbers[4 * i + c]}"


def exr_channels(path):
    """{channel name: rows of floats} of an OpenEXR file of 32-bit floats in scan lines, ZIP compressed
    (openexr.com, "OpenEXR file layout"): chunks of 16 lines, each line one channel after the other."""
    data = open(path, "rb").read()
    assert data[:8] == bytes([0x76, 0x2F, 0x31, 1, 2, 0, 0, 0]), f"{path} is no OpenEXR file of scan lines"
    at, attributes = 8, {}
    while data[at] != 0:
        name, kind = data.index(0, at), data.index(0, data.index(0, at) + 1)
        size, = struct.unpack("<i", data[kind + 1:kind + 5])
        attributes[data[at:name].decode()] = data[kind + 5:kind + 5 + size]
        at = kind + 5 + size
    left, top, right, bottom = struct.unpack("<4i", attributes["dataWindow"])
    width, height = right - left + 1, bottom - top + 1
    assert attributes["compression"] == b"\x03", "not ZIP"
    names, channels = [], attributes["channels"]
    while channels[0] != 0:
        end = channels.index(0)
        names.append(channels[:end].decode())
        assert struct.unpack("<i", channels[end + 1:end + 5])[0] == 2, "not 32-bit floats"
        channels = channels[end + 17:]
    rows = {name: [None] * height for name in names}
    chunk_count = (height + 15) // 16
    for offset in struct.unpack(f"<{chunk_count}Q", data[at + 1:at + 1 + 8 * chunk_count]):
        first, size = struct.unpack("<ii", data[offset:offset + 8])
        chunk, lines = data[offset + 8:offset + 8 + size], min(16, top + height - first)
        if size < lines * width * 4 * len(names):  # else it is stored as it is
            coded = bytearray(zlib.decompress(chunk))
            for i in range(1, len(coded)):
                coded[i] = (coded[i - 1] + coded[i] - 128) & 255
            half, chunk = (len(coded) + 1) // 2, bytearray(len(coded))
            chunk[0::2], chunk[1::2] = coded[:half], coded[half:]
        numbers = struct.unpack(f"<{lines * width * len(names)}f", chunk)
        for line in range(lines):
            for i, name in enumerate(names):
                start = (line * len(names) + i) * width
                rows[name][first - top + line] = numbers[start:start + width]
    return rows


def exr_holds(exr, picture, *layers):
    """The OpenEXR file's channels are those of the .npy picture (R G B A) and of LAYER=CHANNELS (light0=RGB: channels
    light0.R, light0.G, light0.B of PICTURE-light0.npy), no more, and have the same numbers. Two channels that are alike would not
    show that they were exchanged: they are refused."""
    rows, held, stem = exr_channels(exr), {}, picture.removesuffix(".npy")
    for layer in ("=RGBA", *layers):
        name, letters = layer.split("=")
        height, width, channels, numbers = read_npy(f"{stem}-{name}.npy" if name else picture)
        assert channels == len(letters), f"{layer}: {channels} channels"
        for c, letter in enumerate(letters):
            held[f"{name}.{letter}" if name else letter] = numbers[c::channels]
    assert sorted(rows) == sorted(held), f"channels {sorted(rows)}, not {sorted(held)}"
    for name, numbers in held.items():
        found = tuple(value for row in rows[name] for value in row)
        assert found == numbers, f"{name}: other numbers than in the .npy"
    assert len(set(held.values())) == len(held), "two channels are alike"


def png_chunks(path):
    data = open(path, "rb").read()
    assert data[:8] == b"\x89PNG\r\n\x1a\n", f"{path} is no PNG file"
    at = 8
    while at < len(data):
        length, = struct.unpack(">I", data[at:at + 4])
        body = data[at + 8:at + 8 + length]
        check, = struct.unpack(">I", data[at + 8 + length:at + 12 + length])
        assert check == zlib.crc32(data[at + 4:at + 8 + length]), "a chunk is damaged"
        yield data[at + 4:at + 8].decode(), body
        at += 12 + length


def png_header(path):
    """width height bits color-type (2: RGB, 6: RGBA)"""
    chunks = dict(png_chunks(path))
    print(*struct.unpack(">IIBB", chunks["IHDR"][:10]))
    assert "IEND" in chunks


def png_scene(path):
    """The scene that the picture carries."""
    for kind, body in png_chunks(path):
        if kind in ("tEXt", "iTXt", "zTXt") and body.startswith(b"halflight:scene\0"):
            rest = body.split(b"\0", 1)[1]
            if kind == "tEXt":
                print(rest.decode())
            elif kind == "zTXt":
                print(zlib.decompress(rest[1:]).decode())
            else:
                compressed, text = rest[0], rest[2:].split(b"\0", 2)[2]
                print((zlib.decompress(text) if compressed else text).decode())
            return
    sys.exit(f"{path} carries no scene")


def png_rows(path):
    """(width, height, channels, rows of 8-bit samples); knows the filters of the PNG specification, section 9."""
    chunks = list(png_chunks(path))
    width, height, bits, color_type = struct.unpack(">IIBB", dict(chunks)["IHDR"][:10])
    assert bits == 8
    step = {2: 3, 6: 4}[color_type]
    rows = zlib.decompress(b"".join(body for kind, body in chunks if kind == "IDAT"))
    above, lines = bytearray(width * step), []
    for row in range(height):
        at = row * (width * step + 1)
        kind, line = rows[at], bytearray(rows[at + 1:at + 1 + width * step])
        for i in range(len(line)):
            left, up, corner = (line[i - step], above[i], above[i - step]) if i >= step else (0, above[i], 0)
            guess = left + up - corner
            nearest = min((left, up, corner), key=lambda value: abs(guess - value))
            line[i] = (line[i] + (0, left, up, (left + up) // 2, nearest)[kind]) % 256
        above = line
        lines.append(bytes(line))
    return width, height, step, lines


def png_pixel(path, x, y):
    """The 8-bit channels of one pixel."""
    _, _, step, lines = png_rows(path)
    print(*lines[int(y)][int(x) * step:(int(x) + 1) * step])


def png_border(path):
    """The greatest 8-bit value of a picture's outermost pixels, and of all its pixels."""
    width, _, step, lines = png_rows(path)
    print(max(max(lines[0]), max(lines[-1]), max(max(line[:step] + line[(width - 1) * step:]) for line in lines)),
          max(max(line) for line in lines))


def drawn_over(plain, first, both):
    """How many pixels a first drawing over a plain picture changes, a second one over both, and how many they share."""
    rows = [png_rows(path) for path in (plain, first, both)]
    width, height, step = rows[0][:3]
    assert all(row[:3] == (width, height, step) for row in rows)

    def changed(a, b):
        return {(x, y) for y in range(height) for x in range(width)
                if a[3][y][x * step:(x + 1) * step] != b[3][y][x * step:(x + 1) * step]}
    one, other = changed(rows[0], rows[1]), changed(rows[1], rows[2])
    print(len(one), len(other), len(one & other))


def ppm_of_png(path, ppm):
    """The same picture without alpha as a PPM file."""
    width, height, step, lines = png_rows(path)
    assert step == 3
    with open(ppm, "wb") as file:
        file.write(b"P6\n%d %d\n255\n" % (width, height) + b"".join(lines))


def json_get(path, expression):
    """Evaluates a Python expression in which `d` is the parsed file."""
    print(eval(expression, {"d": json.load(open(path)), "len": len, "sum": sum, "sorted": sorted, "abs": abs, "max": max, "min": min, "round": round}))


COMMANDS = {"atlas": atlas, "ball": ball, "stack": stacks.write, "npy-shape": npy_shape, "brightness": brightness, "coverage": coverage, "ratio": ratio,
            "shared-pixels": shared_pixels,
            "sum_layers": sum_layers, "exr-holds": exr_holds,
            "png-header": png_header, "png-scene": png_scene, "png-pixel": png_pixel, "png-border": png_border,
            "ppm-of-png": ppm_of_png, "drawn-over": drawn_over, "json": json_get}
COMMANDS[sys.argv[1]](*sys.argv[2:])
