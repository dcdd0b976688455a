#!/usr/bin/python3
"""Channels of microscopes: what files tell of them, and pictures of several, as OME-TIFF, ImageJ's TIFF and OME-Zarr.

usage: channels.py HALFLIGHT
The files are written here, tag by tag. Exit 77: numpy or Pillow is missing.
"""
import json
import pathlib
import struct
import subprocess
import sys
import tempfile

try:
    import numpy as np
    from PIL import Image
except ImportError as absent:
    print("skipped:", absent)
    sys.exit(77)

PROGRAM = pathlib.Path(sys.argv[1]).resolve()
root = pathlib.Path(tempfile.mkdtemp(prefix="halflight-channels-"))
problems = []


def check(name, condition, what=""):
    print("ok" if condition else "not ok", "-", name, "" if condition else f": {what}")
    if not condition:
        problems.append(name)


def run(*words):
    done = subprocess.run([PROGRAM, *map(str, words)], cwd=root, capture_output=True, text=True)
    return done.returncode, done.stdout, done.stderr


# ---- three channels: balls in three places ----

SIDE = 24
CENTRES = ((6, 12, 12), (12, 12, 12), (18, 12, 12))


def ball(centre):
    z, y, x = np.mgrid[:SIDE, :SIDE, :SIDE]
    away = np.sqrt((x - centre[0]) ** 2 + (y - centre[1]) ** 2 + (z - centre[2]) ** 2)
    return np.clip(250 - 45 * away, 0, 250).astype(np.uint8)


BALLS = [ball(centre) for centre in CENTRES]


def tiff(pages, description, order="<", more=()):
    """Uncompressed pages of bytes; more: (tag, type, numbers) of the first page."""
    out = bytearray((b"II*\0" if order == "<" else b"MM\0*") + b"\0\0\0\0")
    link = 4
    for number, page in enumerate(pages):
        strip = len(out)
        out += page.tobytes()
        tags = [(256, 4, [page.shape[1]]), (257, 4, [page.shape[0]]), (258, 3, [8]), (259, 3, [1]), (262, 3, [1]),
                (273, 4, [strip]), (277, 3, [1]), (278, 4, [page.shape[0]]), (279, 4, [page.size])]
        if number == 0:
            tags += [(270, 2, list(description.encode() + b"\0")), *more]
        entries = b""
        for tag, kind, numbers in sorted(tags):
            letter = {1: "B", 2: "B", 3: "H", 4: "I"}[kind]
            value = struct.pack(f"{order}{len(numbers)}{letter}", *numbers)
            if len(value) > 4:
                place, value = struct.pack(order + "I", len(out)), out.extend(value) or b""
                value = place
            entries += struct.pack(order + "HHI", tag, kind, len(numbers)) + value.ljust(4, b"\0")
        struct.pack_into(order + "I", out, link, len(out))
        out += struct.pack(order + "H", len(tags)) + entries
        link = len(out)
        out += b"\0\0\0\0"
    return bytes(out)


def write_ome(name, channels, told):
    described = "".join(f'<Channel ID="Channel:0:{n}" {words}/>' for n, words in enumerate(told))
    text = ('<?xml version="1.0"?><OME xmlns="http://www.openmicroscopy.org/Schemas/OME/2016-06"><Image ID="Image:0"><Pixels ID="Pixels:0" '
            f'DimensionOrder="XYZCT" Type="uint8" SizeX="{SIDE}" SizeY="{SIDE}" SizeZ="{SIDE}" SizeC="{len(channels)}" SizeT="1">{described}'
            '<TiffData/></Pixels></Image></OME>')
    (root / name).write_bytes(tiff([page for channel in channels for page in channel], text))


def write_imagej(name, channels, order, colors, ranges):
    pages = [channel[z] for z in range(SIDE) for channel in channels]
    text = f"ImageJ=1.53t\nimages={len(pages)}\nchannels={len(channels)}\nslices={SIDE}\nhyperstack=true\nmode=composite\n"
    tables = [bytes(n * c // 255 for c in color for n in range(256)) for color in colors]
    numbers = struct.pack(f"{order}{len(ranges)}d", *ranges)

    def word(letters):
        return letters if order == ">" else letters[::-1]
    head = word(b"IJIJ") + word(b"rang") + struct.pack(order + "I", 1) + word(b"luts") + struct.pack(order + "I", len(tables))
    more = [(50838, 4, [len(head), len(numbers), *map(len, tables)]), (50839, 1, list(head + numbers + b"".join(tables)))]
    (root / name).write_bytes(tiff(pages, text, order, more))


def write_zarr(name, channels, omero):
    folder = root / name
    (folder / "0").mkdir(parents=True)
    axes = [{"name": "c", "type": "channel"}, *({"name": n, "type": "space", "unit": "micrometer"} for n in "zyx")]
    scale = [{"type": "scale", "scale": [1, 1, 1, 1]}]
    (folder / ".zgroup").write_text('{"zarr_format": 2}')
    (folder / ".zattrs").write_text(json.dumps({
        "multiscales": [{"version": "0.4", "axes": axes, "datasets": [{"path": "0", "coordinateTransformations": scale}]}], "omero": omero}))
    (folder / "0/.zarray").write_text(json.dumps({
        "zarr_format": 2, "shape": [len(channels), SIDE, SIDE, SIDE], "chunks": [1, SIDE, SIDE, SIDE], "dtype": "|u1", "compressor": None,
        "fill_value": 0, "order": "C", "filters": None, "dimension_separator": "."}))
    for n, channel in enumerate(channels):
        (folder / f"0/{n}.0.0.0").write_bytes(channel.tobytes())


# ---- what files tell ----

write_ome("three.ome.tif", BALLS, ['Name="DAPI" Color="65535"', 'Name="GFP" Color="16711935"', 'Name="Cy5" Color="-16776961"'])
write_ome("plain.ome.tif", BALLS[:2], ['SamplesPerPixel="1"', 'SamplesPerPixel="1"'])
write_ome("white.ome.tif", BALLS[:2], ['Color="-1"', 'Color="-1"'])
write_imagej("little.tif", BALLS, "<", [(255, 0, 0), (0, 255, 255), (255, 255, 0)], [0, 200, 10, 150, 20, 100])
write_imagej("big.tif", BALLS, ">", [(255, 0, 0), (0, 255, 255), (255, 255, 0)], [0, 200, 10, 150, 20, 100])
write_zarr("omero.zarr", BALLS, {"channels": [
    {"label": "nuclei", "color": "0000FF", "window": {"start": 5, "end": 200, "min": 0, "max": 255}, "active": True},
    {"label": "actin", "color": "ff8000"}, {"label": "bell\u0007", "color": "not a colour"}]})


# A group of label maps beside the image, as NGFF has it: info lists them, and each opens as a volume.
(root / "omero.zarr/labels").mkdir()
(root / "omero.zarr/labels/.zattrs").write_text(json.dumps({"labels": ["cells", "../../etc", 7]}))
write_zarr("omero.zarr/labels/cells", [(BALLS[0] > 100).astype(np.uint8) * 3], {})


def channels_of(name):
    code, out, complaint = run("info", name, "--json")
    return json.loads(out).get("channel_list") if code == 0 else complaint


def told(name):
    return [(c["name"], c.get("color"), c.get("window")) for c in channels_of(name) or ()]


check("OME: names and colours", told("three.ome.tif") == [("DAPI", "#0000ff", None), ("GFP", "#00ff00", None), ("Cy5", "#ff0000", None)],
      told("three.ome.tif"))
ranges = [(0, 200), (10, 150), (20, 100)]
for name in ("little.tif", "big.tif"):
    check(f"ImageJ: colours and windows, {name}",
          told(name) == [("", color, list(r)) for color, r in zip(("#ff0000", "#00ffff", "#ffff00"), ranges)], told(name))
check("omero: names, colours, windows", told("omero.zarr") == [("nuclei", "#0000ff", [5, 200]), ("actin", "#ff8000", None), ("bell?", None, None)],
      told("omero.zarr"))
check("nothing is told: no list", channels_of("plain.ome.tif") is None, channels_of("plain.ome.tif"))
code, out, _ = run("info", "three.ome.tif", "--channel", 1)
check("info as text", code == 0 and "channel 1   GFP, #00ff00" in out, out)
check("label maps of an image", json.loads(run("info", "omero.zarr", "--json")[1]).get("label_maps") == ["labels/cells"],
      run("info", "omero.zarr")[1])
check("label maps as text", "label map   omero.zarr/labels/cells: a volume of its own" in run("info", "omero.zarr")[1], run("info", "omero.zarr")[1])
code, out, complaint = run("info", "omero.zarr/labels/cells", "--json")
check("a label map opens", code == 0 and json.loads(out)["range"] == [0, 3], complaint)
(root / "omero.zarr/labels/.zattrs").write_text("{damaged")
check("a damaged list of label maps does not refuse the image", run("info", "omero.zarr")[0] == 0, run("info", "omero.zarr")[2])


# ---- pictures ----

def picture(name, *words, out="a.png"):
    code, _, complaint = run("render", name, "--size", "60x60", "--view", "front", "--ortho", "--quiet", *words, "-o", out)
    return np.asarray(Image.open(root / out).convert("RGB")).astype(int) if code == 0 else complaint


def hues(pixels):
    """Which of red, green and blue are at least half of the brightest, for every pixel that is bright."""
    if isinstance(pixels, str):
        return pixels
    bright = pixels[pixels.max(axis=2) > 140]
    return {tuple(bool(one) for one in pixel >= pixel.max() / 2) for pixel in bright}


def letters(*names):
    known = {"red": (True, False, False), "green": (False, True, False), "blue": (False, False, True), "cyan": (False, True, True),
             "magenta": (True, False, True), "yellow": (True, True, False), "orange": (True, True, False)}
    return {known[name] for name in names}


for look in ((), ("--look", "mip"), ("--look", "surface")):
    seen = hues(picture("three.ome.tif", "--channel", "all", *look))
    check(f"all channels in the file's colours {look}", isinstance(seen, set) and letters("red", "green", "blue") <= seen, seen)
    seen = hues(picture("three.ome.tif", "--channel", "0,2", *look))
    check(f"channels 0 and 2 {look}", isinstance(seen, set) and letters("red", "blue") <= seen and not letters("green") & seen, seen)
    seen = hues(picture("plain.ome.tif", "--channel", "all", *look))
    check(f"two channels without colours: green and magenta {look}", isinstance(seen, set) and letters("green", "magenta") <= seen, seen)
    seen = hues(picture("white.ome.tif", "--channel", "all", *look))
    check(f"equal colours tell nothing: green and magenta {look}", isinstance(seen, set) and letters("green", "magenta") <= seen, seen)
seen = hues(picture("little.tif", "--channel", "all", "--look", "mip"))
check("ImageJ's colours", isinstance(seen, set) and letters("red", "cyan", "yellow") <= seen, seen)
seen = hues(picture("omero.zarr", "--channel", "0,1", "--look", "mip"))
check("omero's colours", isinstance(seen, set) and letters("blue", "orange") <= seen, seen)
# Stepped channels may be smoothed before they are shown, and keep the colours that the file tells.
generator = np.random.default_rng(5)
write_zarr("stepped.zarr", [np.where(one > 60, 200, 20).astype(np.uint8) + generator.integers(0, 16, one.shape, np.uint8) for one in BALLS[:2]],
           {"channels": [{"color": "0000FF"}, {"color": "FF8000"}]})
code, out, complaint = run("render", "stepped.zarr", "--channel", "all", "--print-scene")
smoothed = [volume.get("smooth", 0) for volume in json.loads(out)["volumes"]] if code == 0 else complaint
check("a stepped channel is smoothed", isinstance(smoothed, list) and any(smoothed), smoothed)
seen = hues(picture("stepped.zarr", "--channel", "all", "--look", "mip"))
check("colours of smoothed channels", isinstance(seen, set) and letters("blue", "orange") <= seen, seen)

# The window of a channel narrows opacities as --range does; one that is wider than what is seen changes nothing. Projections are white from its end on.
def opacities(name, *words):
    code, out, complaint = run("render", name, *words, "--print-scene")
    return json.loads(out)["volumes"][0]["transfer_function"]["opacity"] if code == 0 else complaint


for name, window in (("narrow.zarr", (40, 90)), ("wide.zarr", (0, 255)), ("unsaid.zarr", None)):
    write_zarr(name, BALLS[:2], {"channels": [{"window": {"start": window[0], "end": window[1]}}] if window else [{}]})
for look in ("auto", "surface", "translucent", "xray", "smoke"):
    check(f"a channel's window in the look {look}", opacities("narrow.zarr", "--channel", 0, "--look", look)
          == opacities("unsaid.zarr", "--channel", 0, "--look", look, "--range", "40,90"), opacities("narrow.zarr", "--channel", 0, "--look", look))
    check(f"a wide window in the look {look}", opacities("wide.zarr", "--channel", 0, "--look", look)
          == opacities("unsaid.zarr", "--channel", 0, "--look", look))
whites = [(picture(name, "--channel", "0", "--look", "mip") >= 250).all(axis=2).sum() for name in ("narrow.zarr", "unsaid.zarr")]
check("a projection is white from the window's end on", whites[0] > 3 * whites[1], whites)

# One command, and its scene again: the same bytes.
first = picture("three.ome.tif", "--channel", "all")
again = run("render", "a.png", "--quiet", "-o", "b.png")
check("the scene in the picture makes it again", again[0] == 0 and (root / "a.png").read_bytes() == (root / "b.png").read_bytes(), again[2])
code, out, complaint = run("render", "three.ome.tif", "--channel", "2,0", "--print-scene")
scene = json.loads(out) if code == 0 else {"volumes": []}
check("volumes are named after channels, in the order asked for",
      [(v["name"], v["channel"]) for v in scene["volumes"]] == [("Cy5", 2), ("DAPI", 0)], complaint or out)
code, out, complaint = run("render", "plain.ome.tif", "--channel", "all", "--print-scene")
check("or else by number", code == 0 and [v["name"] for v in json.loads(out)["volumes"]] == ["channel0", "channel1"], complaint)
seen = hues(picture("three.ome.tif", "--channel", "all", "--look", "mip", "--colormap", "GFP=#ffff00"))
check("an option for one channel", isinstance(seen, set) and letters("yellow") <= seen and not letters("green") & seen, seen)
one, plain = picture("three.ome.tif", "--channel", "1"), picture("three.ome.tif", "--channel", "1", "--look", "auto")
check("one channel has the look of its volume", isinstance(one, np.ndarray) and (one == plain).all(), one)
code, out, complaint = run("render", "three.ome.tif", "--channel", "1", "--print-scene")
check("and its scene is of one volume", code == 0 and [v.get("channel") for v in json.loads(out)["volumes"]] == [1], complaint or out)

# Channels by the file's own names, in any case; a number below the number of channels is never a name, any other may be one.
def chosen(name, words):
    code, out, complaint = run("render", name, "--channel", words, "--print-scene")
    return [v.get("channel", 0) for v in json.loads(out)["volumes"]] if code == 0 else complaint


write_ome("waves.ome.tif", BALLS, ['Name="488"', 'Name="0"', 'Name="cy5"'])
for name, words, numbers in (("three.ome.tif", "GFP", [1]), ("three.ome.tif", "dapi,Cy5", [0, 2]), ("three.ome.tif", "Cy5,1", [2, 1]),
                             ("omero.zarr", "actin", [1]), ("omero.zarr", "actin,nuclei", [1, 0]), ("waves.ome.tif", "488", [0]),
                             ("waves.ome.tif", "0", [0]), ("waves.ome.tif", "CY5,488", [2, 0])):
    check(f"channels by name: {name} {words}", chosen(name, words) == numbers, chosen(name, words))
check("a channel by its name is the one by its number", (picture("three.ome.tif", "--channel", "GFP") == picture("three.ome.tif", "--channel", "1")).all())
for words in ("GFP", "1"):
    code, _, complaint = run("convert", "three.ome.tif", f"{words}.nrrd", "--channel", words, "--quiet")
    check(f"convert takes channel {words}", code == 0, complaint)
check("and writes the same", (root / "GFP.nrrd").read_bytes() == (root / "1.nrrd").read_bytes())
code, _, complaint = run("info", "plain.ome.tif", "--channel", "GFP")
check("channels without names", complaint.strip().endswith("plain.ome.tif: there is no channel 'GFP': choose 0 to 1"), complaint)
code, _, complaint = run("info", "1.nrrd", "--channel", "GFP")
check("a file of one channel", "there is no channel 'GFP': the file has one, 0: leave" in complaint, complaint)

# A series: each frame shows all channels of its own file.
write_ome("t0.ome.tif", BALLS[:2], ['Color="65535"', 'Color="-16776961"'])
write_ome("t1.ome.tif", BALLS[1:], ['Color="65535"', 'Color="-16776961"'])
code, _, complaint = run("render", "t?.ome.tif", "--channel", "all", "--look", "mip", "--size", "60x60", "--view", "front", "--ortho", "--quiet",
                         "-o", "frames/%d.png")
frames = [np.asarray(Image.open(root / f"frames/{n}.png").convert("RGB")).astype(int) for n in range(2)] if code == 0 else []
check("a series shows all channels of each file", len(frames) == 2 and all(letters("red", "blue") <= hues(f) for f in frames)
      and (frames[0] != frames[1]).any(), complaint)


def middle(pixels, channel):
    light = pixels[:, :, channel].astype(float)
    return (light.sum(axis=0) * np.arange(60)).sum() / light.sum()


if frames:
    check("both channels move", middle(frames[1], 0) - middle(frames[0], 0) > 5 and middle(frames[1], 2) - middle(frames[0], 2) > 5,
          [(middle(f, 0), middle(f, 2)) for f in frames])

# ---- what is refused ----

numbers = "give a number from 0 on or a name, several as 0,2, or all: halflight info lists the channels' names"
known = "choose 0 to 2, or by name: DAPI, GFP, Cy5"
for words, line in {("--channel", "1,9"): f"three.ome.tif: there is no channel 9: {known}",
                    ("--channel", "0,x"): f"three.ome.tif: there is no channel 'x': {known}",
                    ("--channel", "0,,1"): f"--channel: '0,,1': {numbers}",
                    ("--channel", "-1"): f"three.ome.tif: there is no channel '-1': {known}",
                    ("--channel", "GFP,1"): "three.ome.tif: channel 1 is there twice",
                    ("--channel", "1,1"): "--channel: '1,1': channel 1 is there twice"}.items():
    code, _, complaint = run("render", "three.ome.tif", *words, "-o", "none.png")
    check(f"refused: {' '.join(words)}", code != 0 and complaint.strip().endswith(line) and not (root / "none.png").exists(), complaint)

sys.exit(1 if problems else 0)
