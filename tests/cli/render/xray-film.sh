# The look xray before a bright background is a film: where white matter before black shows 1 - T, black matter before
# white shows a power of T, by which both show the same middle grey.
tool ball 16 ball_16x16x16_uint8.raw
xray() { halflight render ball_16x16x16_uint8.raw --look xray --size 32 --quiet "$@"; }
xray --density 0.15 -o black.png --depth 16
xray --density 0.15 --background white -o white.png --depth 16
xray --background white -o layers.npy
"$PYTHON" - <<'END'
import math, struct, zlib
def light(name):
    data, at, packed = open(name, "rb").read(), 8, b""
    while at < len(data):
        length, kind = struct.unpack(">I4s", data[at:at + 8])
        packed += data[at + 8:at + 8 + length] if kind == b"IDAT" else b""
        at += length + 12
    raw, row, before, values = zlib.decompress(packed), 32 * 6, bytes(32 * 6), []
    for y in range(32):
        kind, line = raw[y * (row + 1)], bytearray(raw[y * (row + 1) + 1:(y + 1) * (row + 1)])
        for x in range(row):
            a, b, c = line[x - 6] if x > 5 else 0, before[x], before[x - 6] if x > 5 else 0
            near = min((abs(b - c), 0, a), (abs(a - c), 1, b), (abs(a + b - 2 * c), 2, c))[2]
            line[x] = line[x] + (0, a, b, (a + b) // 2, near)[kind] & 255
        before = bytes(line)
        values += [v / 65535 for v in struct.unpack(">96H", before)[::3]]
    return [v / 12.92 if v <= 0.04045 else ((v + 0.055) / 1.055) ** 2.4 for v in values]
black, white = light("black.png"), light("white.png")
print(white[0], min(white) < 0.6)
power = math.log(0.18) / math.log(0.82)
middle = [32 * y + x for y in range(14, 18) for x in range(14, 18)]  # the ball's edges pass through other pixels
mean = [sum(picture[p] for p in middle) / len(middle) for picture in (black, white)]
print(0.1 < mean[1] < 0.9, abs(mean[1] - (1 - mean[0]) ** power) < 0.05)
END
# A colour map keeps its colours, a scene's look is adapted to the scene's background, and the scene in the picture is the picture.
xray --background white --colormap hot --print-scene >hot.json
tool json hot.json "max(d['volumes'][0]['transfer_function']['color'][-1][1:])"
xray --background white --print-scene >film.json
halflight render film.json --quiet -o again.npy
cmp layers.npy again.npy
halflight render film.json --look xray --print-scene >again.json
tool json again.json "d['volumes'][0]['transfer_function']['color'][0][1:]"
halflight render film.json --look xray --background black --print-scene >again.json
tool json again.json "d['volumes'][0]['transfer_function']['color'][0][1:]"
# Every volume is dark; channels keep their colours.
xray ball_16x16x16_uint8.raw --background white --print-scene >two.json
tool json two.json "[v['transfer_function']['color'][0][1:] for v in d['volumes']]"
