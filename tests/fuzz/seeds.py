#!/usr/bin/python3
"""Writes the first inputs of the fuzz targets that read scenes, shapes, transfer functions and pictures.

usage: seeds.py PROGRAM SOURCE_FOLDER CORPUS_FOLDER

Scenes are the examples, shrunk: their files become the three that the target offers, their grids and pictures small.
Shapes are the ready-made ones and those of the examples. PNG files of every kind are put together here.
"""
import json, pathlib, struct, subprocess, sys, zlib

program, source, corpus = sys.argv[1], pathlib.Path(sys.argv[2]), pathlib.Path(sys.argv[3])


def write(target, name, content):
    folder = corpus / target
    folder.mkdir(parents=True, exist_ok=True)
    (folder / name).write_bytes(content if isinstance(content, bytes) else content.encode())


def text(value):
    return json.dumps(value, separators=(",", ":"))


def shrink(value, key=""):
    """A scene with small grids and the target's files."""
    if isinstance(value, dict):
        return {k: shrink(v, k) for k, v in value.items() if k not in ("description", "$schema")}
    if isinstance(value, list):
        return [shrink(v) for v in value]
    if key == "file":
        return "t.png" if value.endswith(".png") else "f.json" if value.endswith(".json") else "v.nrrd"
    return value * 6 if key == "voxel_size" else value


def more_than_one_number():
    """Labels, masks, functions of two numbers, opacity by gradient, isosurfaces and cuts."""
    boxes = [{"value": [5, 60], "second": [1, 20], "edge": [3, 2], "sigma": 0.2, "color": [1, 0.5, 0.2], "opacity": 0.5}]
    polygons = [{"vertices": [[5, 1], [60, 1], [30, 20]], "apex": [30, 8], "falloff": 0.5, "opacity": 0.4}]
    image = {"file": "t.png", "value": [0, 255], "second": [0, 20]}
    functions = [
        {"opacity": [[0, 0], [255, 1]], "gradient_opacity": [[0, 0], [20, 1]]},
        {"second": "gradient", "unit_distance": 2, "boxes": boxes, "polygons": polygons},
        {"second": "gradient", "image": image, "gradient_opacity": [[0, 0.5], [9, 1]]}]
    cuts = [{"type": "plane", "point": [1, 1, 1], "normal": [0, 1, 1], "world": True},
            {"type": "box", "min": [0, 0, 0], "max": [1, 2, 3], "keep": "inside"}, {"type": "sphere", "center": [1, 1, 1], "radius": 1}]
    labels = [{"value": 9, "name": "rim", "color": [1, 0, 0], "opacity": 0.5}, {"value": 40, "visible": False}, {"value": 255}]
    volumes = {
        "labels": {"labels": labels}, "labels-all": {"labels": True, "label_table": "f.json"},
        "mask": {"mask": {"file": "v.nrrd", "rest": 0.1, "labels": [dict(labels[0], tint=0.5), *labels[1:]]}},
        "iso": {"iso": [{"value": 20, "color": [1, 0.8, 0.2], "opacity": 0.5}, {"value": 200}]},
        "cuts": {"cuts": cuts, "cut_shading": "none", "cut_casts_shadow": True}}
    for n, function in enumerate(functions):
        volumes[f"two-numbers-{n}"] = {"transfer_function": function}
        write("transfer", f"two-numbers-{n}.json", text(function))
    for name, volume in volumes.items():
        write("scene", f"{name}.json", text({"halflight": 1, "volumes": [{"file": "v.nrrd", **volume}]}))
    write("scene", "second-volume.json", text({"halflight": 1, "volumes": [
        {"file": "v.nrrd", "transfer_function": {"second": {"volume": "b"}, "boxes": boxes}}, {"name": "b", "file": "v.nrrd", "visible": False}]}))
    write("scene", "scene-cuts.json", text({"halflight": 1, "volumes": [{"file": "v.nrrd"}], "cuts": cuts, "meshes": [
        {"spheres": [[1, 1, 1, 1]], "cut": False}, {"floor": True}, {"floor": 2, "cut": True}]}))


def scenes():
    for path in sorted((source / "examples").glob("*.json")):
        scene = shrink(json.loads(path.read_text()))
        if len(text(scene)) < 3000:
            write("scene", path.name, text(scene))
        for n, volume in enumerate(scene["volumes"]):
            if "shapes" in volume:
                keys = {k: volume[k] for k in ("shapes",) if k in volume}
                if "groups" in scene:
                    keys["groups"] = scene["groups"]
                if len(text(keys)) < 2000:
                    write("shapes", f"{path.stem}-{n}.json", text(keys))
    write("scene", "least.json", '{"halflight":1,"volumes":[{"file":"v.nrrd"}]}')
    write("scene", "stand-in.json", text({"halflight": 1, "volumes": [
        {"file": "absent.nrrd", "stand_in": {"shapes": [{"type": "sphere", "radius": 9}], "voxel_size": 2}}]}))
    lights = [
        {"type": "point", "position": [1, 2, 9], "radius": 0.5, "falloff": "inverse_square"},
        {"type": "spot", "position": [1, 2, 9], "direction": [0, 0, -1], "opening_angle_deg": 40, "falloff_angle_deg": 5},
        {"type": "rect", "position": [1, 2, 9], "edge1": [1, 0, 0], "edge2": [0, 1, 0], "shadows": "soft"},
        {"type": "disk", "position": [1, 2, 9], "normal": [0, 0, 1], "radius": 2, "shadows": "hard"},
        {"type": "polygon", "vertices": [[0, 0, 9], [1, 0, 9], [0, 1, 9]]},
        {"type": "directional", "direction": [0, 0, -1], "angular_diameter_deg": 9, "texture": {
            "file": "t.png", "screen": {"center": [0, 0, 9], "right": [1, 0, 0], "up": [0, 1, 0]}}}]
    volume = {
        "name": "a", "file": "v.nrrd", "transform": {
            "scale": 2, "rotate": {"axis": [0, 0, 1], "angle_deg": 30}, "translate": [1, 2, 3]},
        "shading": "none", "material": {"ambient": 1, "diffuse": 0.7, "specular": 0.3, "shininess": 32},
        "attenuation_color": [1, 0.5, 0.2],
        "scattering": {"anisotropy": 0.5, "albedo": [1, 0.9, 0.5], "multiple": True}, "visible": False, "casts_shadow": False, "receives_shadow": False,
        "clip": {"min": [0, 0, 0], "max": [1, 1, 1]}}
    functions = [
        {"unit_distance": 1, "opacity": [[0, 0], [255, 1]], "color": [[0, 0, 0, 0], [255, 1, 1, 1]]},
        {"opacity": [[0, 0], [255, 1]], "colormap": "viridis", "range": [0, 255]},
        {"preset": "ct-bone"}, {"file": "f.json"}, {"opacity": 0.3, "color": [1, 0.5, 0.2]}]
    for n, light in enumerate(lights):
        write("scene", f"light-{n}.json", text({"halflight": 1, "lights": [light], "volumes": [{"file": "v.nrrd"}]}))
    for n, function in enumerate(functions):
        write("scene", f"function-{n}.json", text({"halflight": 1, "volumes": [dict(volume, transfer_function=function)]}))
        write("transfer", f"own-{n}.json", text(function))
    write("scene", "shine.json", text({
        "halflight": 1, "image": {"width": 8, "height": 6, "exposure": -1.5, "tone": "filmic"}, "volumes": [
            dict(volume, shading="flat", material={"emission": 2.5}, transform={"scale": [1, 2, 0.5]}, visible=True)]}))
    write("scene", "maximum.json", text({
        "halflight": 1, "image": {"width": 8, "height": 6}, "volumes": [
            {"file": "v.nrrd"}, dict(volume, transfer_function={"preset": "mip", "colormap": "hot"}, visible=True)],
        "render": {"compositing": "maximum"}}))
    write("scene", "render.json", text({
        "halflight": 1, "image": {"width": 8, "height": 6, "background": [0, 0.1, 0.2]},
        "camera": {"type": "orthographic", "position": [0, -9, 0], "target": [0, 0, 0], "up": [0, 0, 1], "height": 5},
        "ambient": [0.1, 0.2, 0.3], "volumes": [{"file": "v.nrrd"}],
        "render": {"shadows": "soft", "soft_method": "sublights", "light_samples": 3, "sheet_spacing": 0.5,
                   "kernel": "gaussian", "reconstruction": "splat", "slicing": "image-aligned",
                   "shadow_resolution": 64, "threads": 2}}))


def shapes():
    names = subprocess.run([program, "make", "--list"], check=True, capture_output=True, text=True).stdout
    for name in (line.split()[0] for line in names.splitlines() if line.strip()):
        printed = subprocess.run([program, "make", name, "--print"], check=True, capture_output=True, text=True).stdout
        write("shapes", f"{name}.json", text(json.loads(printed)))
    write("shapes", "voxel-size.json", text({"shapes": [{"type": "cone", "radius": 4, "height": 9}], "voxel_size": 0.5}))


def functions():
    for space in ("RGB", "HSV", "Lab", "CIELAB", "Diverging", "Step"):
        write("transfer", f"paraview-{space}.json", text([{
            "ColorSpace": space, "Name": "x", "NanColor": [1, 0, 0],
            "RGBPoints": [0, 0.23, 0.29, 0.75, 10, 0.7, 0.01, 0.14, 20, 1, 1, 0],
            "Points": [0, 0, 0.3, 0.6, 10, 1, 0.5, 0, 20, 0.5, 0.5, 0]}]))
    write("transfer", "plane.json", text({"second": {"volume": "b"}, "boxes": [{"value": [0, 1], "second": [2, 3],
          "color": [1, 0, 0], "opacity": 0.5, "edge": [1, 0]}], "polygons": [{"vertices": [[0, 0], [1, 0], [0, 1]],
          "apex": [0.2, 0.2], "falloff": 0.5}], "image": {"file": "a.png", "value": [0, 1], "second": [0, 1]}}))
    write("transfer", "slicer.json", text({"@schema": "x", "volumeProperties": [{"components": [{
        "scalarOpacityUnitDistance": 0.5,
        "scalarOpacity": {"type": "piecewiseLinearFunction", "points": [
            {"x": -100, "y": 0}, {"x": 100, "y": 0.8, "midpoint": 0.4, "sharpness": 0.3}]},
        "rgbTransferFunction": {"points": [{"x": 0, "color": [1, 0, 0]}, {"x": 10, "color": [0, 0, 1]}]},
        "gradientOpacity": {"points": [{"x": 0, "y": 0}, {"x": 9, "y": 1}]}}]}]}))


def foreign_functions():
    """What other programs write: Slicer's properties in three formats, and a state of ParaView."""
    prop = ('<VolumeProperty name="{}" interpolation="1" gradientOpacity="6 0 0 20 1 30 0.5" scalarOpacity="6 -100 0 50 0.25 50 0.75" '
            'colorTransfer="8 -100 1 0 0 100 0 0 1"/>')
    write("transfer", "slicer-preset.xml", prop.format("A"))
    write("transfer", "slicer-presets.xml", f'<MRML>{prop.format("A")}{prop.format("B")}</MRML>')
    write("transfer", "slicer.vp", "1\n1\n0.9\n0.1\n0.2\n10\n6 -100 0 50 0.25 40 0.75\n4 0 0 10 1\n8 -100 1 0 0 100 0 0 1\n")
    component = {"componentWeight": 1, "scalarOpacityUnitDistance": 2, "disableGradientOpacity": False,
                 "scalarOpacity": {"points": [{"x": 0, "y": 0.5, "midpoint": 0.4, "sharpness": 0.9}, {"x": 9, "y": 1}]},
                 "rgbTransferFunction": {"points": [{"x": 0, "color": [1, 0.5, 0]}, {"x": 9, "color": [0, 0, 1]}]},
                 "gradientOpacity": {"points": [{"x": 0, "y": 0}, {"x": 9, "y": 1}]}}
    write("transfer", "slicer-components.json", text({"volumeProperties": [
        {"independentComponents": True, "interpolationType": "linear", "components": [component, component]}]}))

    def listed(name, numbers):
        elements = "".join(f'<Element index="{n}" value="{number}"/>' for n, number in enumerate(numbers))
        return f'<Property name="{name}" number_of_elements="{len(numbers)}">{elements}</Property>'
    boxes = listed("Boxes", [20, 2, 40, 4, 1, 0.5, 0, 0.6, 1, 1, 9, 3, 0, 0, 1, 1]) + listed("Range", [0, 100, 0, 10])
    shown = listed("ScalarOpacityUnitDistance", [2]) + listed("UseTransfer2D", [1]) + listed("UseGradientForTransfer2D", [1])

    def proxy(group, kind, number, content):
        return f'<Proxy group="{group}" type="{kind}" id="{number}">{content}</Proxy>'

    def named(name, number):
        return f'<Property name="{name}"><Proxy value="{number}"/><Domain name="d"><Proxy value="9"/></Domain></Property>'
    plane = proxy("transfer_2d_functions", "TransferFunction2D", 5, boxes) + proxy("representations", "Grid", 6, shown)
    write("transfer", "paraview-state.pvsm", f"<ParaView>{plane}</ParaView>")
    colors = listed("RGBPoints", [0, 0, 0, 1, 10, 1, 0, 0]) + listed("ColorSpace", [1]) + listed("HSVWrap", [0]) + listed("UseLogScale", [0])
    shown = listed("Representation", ["Volume"]) + listed("Visibility", [1]) + listed("ScalarOpacityUnitDistance", [2])
    shown += named("LookupTable", 7) + named("ScalarOpacityFunction", 8)
    volume = proxy("lookup_tables", "PVLookupTable", 7, colors) + proxy("representations", "Grid", 6, shown)
    volume += proxy("piecewise_functions", "PiecewiseFunction", 8, listed("Points", [0, 0, 0.3, 0.6, 10, 1, 0.5, 0]))
    write("transfer", "paraview-volume.pvsm", f"<ParaView>{volume}</ParaView>")


def chunk(kind, data):
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


def png(colour, depth, interlaced, width=5, height=4):
    """A PNG whose samples count up; the seven passes of Adam7 are rows of their own."""
    channels = {0: 1, 2: 3, 3: 1, 4: 2, 6: 4}[colour]
    passes = [(0, 0, 8, 8), (4, 0, 8, 8), (0, 4, 4, 8), (2, 0, 4, 4), (0, 2, 2, 4), (1, 0, 2, 2), (0, 1, 1, 2)]
    rows = b""
    for x, y, dx, dy in passes if interlaced else [(0, 0, 1, 1)]:
        across, down = -(-(width - x) // dx), -(-(height - y) // dy)
        if across > 0 and down > 0:
            for row in range(down):
                length = (across * channels * depth + 7) // 8
                # An index beyond the palette would be an error in itself.
                rows += bytes([row % 5]) + bytes((17 * row + 3 * n) % 256 if colour != 3 else 0 for n in range(length))
    body = chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, depth, colour, 0, 0, interlaced))
    body += chunk(b"gAMA", struct.pack(">I", 45455)) + chunk(b"tEXt", b"Title\0seed")
    if colour == 3:
        body += chunk(b"PLTE", bytes(range(6))) + chunk(b"tRNS", b"\x80\xff")
    if colour == 0:
        body += chunk(b"tRNS", b"\0\0")
    return b"\x89PNG\r\n\x1a\n" + body + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b"")


def exr(compression, pixel_type):
    """Two scanlines of three pixels, R, G and B; compression 0 none, 2 ZIPS, 3 ZIP."""
    width, height, lines = 3, 2, 2 if compression == 3 else 1
    sample = struct.pack("<e" if pixel_type == 1 else "<f" if pixel_type == 2 else "<I", 1)
    channels = b"".join(name + b"\0" + struct.pack("<iBBBBii", pixel_type, 0, 0, 0, 0, 1, 1) for name in (b"B", b"G", b"R"))
    box = struct.pack("<4i", 0, 0, width - 1, height - 1)
    attributes = [(b"channels", b"chlist", channels + b"\0"), (b"compression", b"compression", bytes([compression])),
                  (b"dataWindow", b"box2i", box), (b"displayWindow", b"box2i", box), (b"lineOrder", b"lineOrder", b"\0"),
                  (b"pixelAspectRatio", b"float", struct.pack("<f", 1)),
                  (b"screenWindowCenter", b"v2f", struct.pack("<2f", 0, 0)),
                  (b"screenWindowWidth", b"float", struct.pack("<f", 1))]
    header = b"\x76\x2f\x31\x01\x02\0\0\0" + b"".join(
        name + b"\0" + kind + b"\0" + struct.pack("<i", len(value)) + value for name, kind, value in attributes) + b"\0"
    chunks = []
    for y in range(0, height, lines):
        data = sample * (width * 3 * lines)
        if compression in (2, 3):
            split = data[0::2] + data[1::2]
            coded = bytes([split[0]]) + bytes((split[n] - split[n - 1] + 128) % 256 for n in range(1, len(split)))
            packed = zlib.compress(coded)
            data = packed if len(packed) < len(data) else data
        chunks.append(struct.pack("<ii", y, len(data)) + data)
    at = len(header) + 8 * len(chunks)
    offsets = b""
    for block in chunks:
        offsets += struct.pack("<Q", at)
        at += len(block)
    return header + offsets + b"".join(chunks)


def npy(shape, kind, size, fortran=False):
    header = f"{{'descr': '{kind}', 'fortran_order': {fortran}, 'shape': {shape}, }}".encode().ljust(117) + b"\n"
    count = 1
    for side in shape:
        count *= side
    return b"\x93NUMPY\x01\0" + struct.pack("<H", len(header)) + header + bytes(n % 60 for n in range(count * size))


def hdr(size, rows):
    return b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n" + size + b"\n" + rows


def pictures():
    for colour, depths in ((0, (1, 2, 4, 8, 16)), (2, (8, 16)), (3, (1, 8)), (4, (8, 16)), (6, (8, 16))):
        for depth in depths:
            write("picture", f"colour{colour}-{depth}.png", png(colour, depth, depth % 8))
            if depth == 8:
                write("picture", f"colour{colour}-{depth}-interlaced.png", png(colour, depth, 1))
    for compression in (0, 2, 3):
        for pixel_type in (0, 1, 2):
            write("picture", f"compression{compression}-type{pixel_type}.exr", exr(compression, pixel_type))
    write("picture", "rgba.npy", npy((2, 3, 4), "<f4", 4))
    write("picture", "rgb-double.npy", npy((2, 3, 3), "<f8", 8))
    write("picture", "grey-big-endian.npy", npy((2, 3), ">f4", 4))
    write("picture", "fortran.npy", npy((2, 3, 4), "<f4", 4, True))
    write("picture", "plain.hdr", hdr(b"+Y 2 -X 3", bytes(range(100, 124))))
    write("picture", "runs-of-pixels.hdr", hdr(b"-Y 2 +X 9", bytes((7, 8, 9, 130, 1, 1, 1, 8)) * 2))
    write("picture", "runs-of-bytes.hdr", hdr(b"-Y 2 +X 9", bytes((2, 2, 0, 9) + (137, 5) * 3 + (9, *range(120, 129))) * 2))


scenes()
more_than_one_number()
shapes()
functions()
foreign_functions()
pictures()
