#!/usr/bin/env python3
"""Draws the images of lights of the example scenes to examples/slides/, the same bytes on every run.

beams.png  three disks of pure red, green and blue on black
beam.png   one white disk on black
grid.png   white lines on a dim ground, 16 squares a side
logo.png   the emblem and name of Halflight between four corners
open.png   white: a screen that only bounds the light
window.png a window of four coloured panes
Shapes are drawn by their distance, smooth over one pixel.
"""
import math
import pathlib
import struct
import zlib

FOLDER = pathlib.Path(__file__).resolve().parent / "slides"


class Canvas:
    """Linear RGB, drawn over in order."""

    def __init__(self, width, height, ground=(0, 0, 0)):
        self.width, self.height = width, height
        self.rows = [[ground] * width for _ in range(height)]

    def draw(self, color, distance, box):
        """distance(x, y): to the shape's outline in pixels, negative inside; box: its bounds."""
        left, top, right, bottom = box
        for y in range(max(0, int(top) - 1), min(self.height, int(bottom) + 2)):
            row = self.rows[y]
            for x in range(max(0, int(left) - 1), min(self.width, int(right) + 2)):
                part = min(1, max(0, 0.5 - distance(x + 0.5, y + 0.5)))
                if part > 0:
                    row[x] = tuple(a + (b - a) * part for a, b in zip(row[x], color))

    def line(self, color, a, b, thickness):
        r = thickness / 2
        dx, dy = b[0] - a[0], b[1] - a[1]
        length = dx * dx + dy * dy

        def distance(x, y):
            t = min(1, max(0, ((x - a[0]) * dx + (y - a[1]) * dy) / length))
            return math.hypot(x - a[0] - t * dx, y - a[1] - t * dy) - r

        self.draw(color, distance, (min(a[0], b[0]) - r, min(a[1], b[1]) - r, max(a[0], b[0]) + r, max(a[1], b[1]) + r))

    def disk(self, color, x0, y0, radius):
        self.draw(color, lambda x, y: math.hypot(x - x0, y - y0) - radius,
                  (x0 - radius, y0 - radius, x0 + radius, y0 + radius))

    def write(self, name):
        rows = b"".join(b"\0" + bytes(encode(v) for pixel in row for v in pixel) for row in self.rows)
        header = struct.pack(">IIBBBBB", self.width, self.height, 8, 2, 0, 0, 0)
        chunks = (b"IHDR", header), (b"IDAT", zlib.compress(rows, 9)), (b"IEND", b"")
        data = b"".join(struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))
                        for kind, body in chunks)
        (FOLDER / name).write_bytes(b"\x89PNG\r\n\x1a\n" + data)


def encode(linear):
    """To an 8-bit sRGB code (IEC 61966-2-1)."""
    value = 12.92 * linear if linear <= 0.0031308 else 1.055 * linear ** (1 / 2.4) - 0.055
    return round(255 * min(1, max(0, value)))


def beams():
    canvas = Canvas(96, 288)
    for row, color in enumerate([(1, 0, 0), (0, 1, 0), (0, 0, 1)]):
        canvas.disk(color, 48, 48 + 96 * row, 36)
    canvas.write("beams.png")


def beam():
    canvas = Canvas(128, 128)
    canvas.disk((1, 1, 1), 64, 64, 56)
    canvas.write("beam.png")


def grid():
    squares, side, line = 16, 32, 4
    canvas = Canvas(squares * side, squares * side, (0.12, 0.12, 0.12))
    for i in range(squares):
        middle = side * (i + 0.5)
        for a, b in (((middle, -9), (middle, 999)), ((-9, middle), (999, middle))):
            canvas.line((1, 1, 1), a, b, line)
    canvas.write("grid.png")


def arc(x0, y0, radius, start_deg, end_deg, steps=16):
    angles = [math.radians(start_deg + (end_deg - start_deg) * i / steps) for i in range(steps + 1)]
    return [(x0 + radius * math.cos(a), y0 - radius * math.sin(a)) for a in angles]


# Strokes in a box of the given width and height 1, y downwards.
LETTERS = {
    "H": (0.68, [[(0, 0), (0, 1)], [(0.68, 0), (0.68, 1)], [(0, 0.5), (0.68, 0.5)]]),
    "A": (0.78, [[(0, 1), (0.39, 0), (0.78, 1)], [(0.15, 0.64), (0.63, 0.64)]]),
    "L": (0.52, [[(0, 0), (0, 1), (0.52, 1)]]),
    "F": (0.54, [[(0, 1), (0, 0), (0.54, 0)], [(0, 0.48), (0.46, 0.48)]]),
    "I": (0.0, [[(0, 0), (0, 1)]]),
    "G": (0.86, [arc(0.5, 0.5, 0.5, 50, 330) + [(0.933, 0.54), (0.56, 0.54)]]),
    "T": (0.66, [[(0, 0), (0.66, 0)], [(0.33, 0), (0.33, 1)]]),
}


def write_text(canvas, text, x0, y0, height, thickness, gap, color):
    for letter in text:
        width, strokes = LETTERS[letter]
        for stroke in strokes:
            for a, b in zip(stroke, stroke[1:]):
                canvas.line(color, (x0 + a[0] * height, y0 + a[1] * height),
                            (x0 + b[0] * height, y0 + b[1] * height), thickness)
        x0 += (width + gap) * height
    return x0


def emblem(canvas, x0, y0, radius, color):
    """A disk cut along a diagonal: one half full, the other in sheets that let ever less of the light through."""
    slant = math.sqrt(0.5)
    period = radius / 5

    def distance(x, y):
        across = (x - x0) * slant - (y - y0) * slant  # towards the upper right
        outside = math.hypot(x - x0, y - y0) - radius
        if across < 0:
            return outside
        sheet = math.floor(across / period)
        thickness = period * (0.8 - 0.17 * sheet)
        from_middle = abs(across - (sheet + 0.62) * period) - thickness / 2
        return max(outside, from_middle)

    canvas.draw(color, distance, (x0 - radius, y0 - radius, x0 + radius, y0 + radius))


def logo():
    white, amber, ground = (1, 0.96, 0.9), (1, 0.55, 0.1), (0.035, 0.075, 0.22)
    canvas = Canvas(640, 480, ground)
    emblem(canvas, 320, 188, 122, amber)
    text, height, gap = "HALFLIGHT", 46, 0.42
    width = sum(LETTERS[c][0] + gap for c in text) * height - gap * height
    write_text(canvas, text, 320 - width / 2, 352, height, 8, gap, white)
    for sx in (0, 1):
        for sy in (0, 1):
            corner = (26 + sx * 588, 26 + sy * 428)
            canvas.line(white, corner, (corner[0] + (1 - 2 * sx) * 48, corner[1]), 8)
            canvas.line(white, corner, (corner[0], corner[1] + (1 - 2 * sy) * 48), 8)
    canvas.write("logo.png")


def window():
    side, bar = 96, 8
    canvas = Canvas(side, side)
    panes = [(1, 0.05, 0.03), (1, 0.75, 0.1), (0.1, 0.8, 0.25), (0.08, 0.2, 1)]
    for y in range(side):
        canvas.rows[y] = [panes[2 * (y >= side // 2) + (x >= side // 2)] for x in range(side)]
    for at, thickness in ((0, 2 * bar), (side / 2, bar), (side, 2 * bar)):
        canvas.line((0, 0, 0), (at, -9), (at, side + 9), thickness)
        canvas.line((0, 0, 0), (-9, at), (side + 9, at), thickness)
    canvas.write("window.png")


if __name__ == "__main__":
    FOLDER.mkdir(exist_ok=True)
    beams()
    beam()
    grid()
    logo()
    window()
    Canvas(1, 1, (1, 1, 1)).write("open.png")
