"""Lines where nothing casts a shadow: floors and balls alone. The eye sees lines first, which sums of squares hardly notice.

A floor alone looks as it does without shadows, under any light: what differs is wrong. A smooth ball has no edge within its
outline: there its picture minus the mean of the pixels around it is what should not be there.
"""
import json
import math

import numpy

import scenes

SIDE, REACH, INSIDE = 200, 4, 10  # pixels: the picture, to the edge of the square that is smoothed, to the objects' outlines
MATERIAL = {"ambient": 0, "diffuse": 1, "specular": 0}
FLOOR = {"shapes": [{"type": "box", "size": [420, 420, 12]}], "voxel_size": 2}
BALL = {"shapes": [{"type": "sphere", "radius": 45}], "voxel_size": 1}
FLOOR_CAMERA = {"position": [300, -420, 500], "target": [0, 0, 0], "up": [0, 0, 1], "fovy_deg": 22}
BALL_CAMERA = {"position": [90, -160, 90], "target": [0, 0, 0], "up": [0, 0, 1], "fovy_deg": 20}
NEAR = [{"type": "rect", "position": [0, 0, 190], "edge1": [80, 0, 0], "edge2": [0, 80, 0]},
        {"type": "rect", "position": [0, 0, 400], "edge1": [160, 0, 0], "edge2": [0, 160, 0]},
        {"type": "disk", "position": [0, 0, 190], "normal": [0, 0, -1], "radius": 45},
        {"type": "point", "position": [0, 0, 190], "radius": 45},
        {"type": "point", "position": [0, 60, 120], "radius": 20}]
BALL_SIZES = (5, 20, 40, 60, 90, 120)
SPACINGS = (0.5, 1)


def far_lights():
    """Sixteen directional lights, 5, 15 and 30 degrees wide, 25 to 85 degrees above the floor."""
    for i in range(16):
        elevation, azimuth = math.radians(25 + 4 * i), 2.4 * i
        yield {"type": "directional", "angular_diameter_deg": (5, 15, 30)[i % 3],
               "direction": [-math.cos(elevation) * math.cos(azimuth), -math.cos(elevation) * math.sin(azimuth), -math.sin(elevation)]}


def wide(degrees):
    return {"type": "directional", "direction": [-0.5, 0.55, -0.5], "angular_diameter_deg": degrees}


def scene_of(volume, camera, light, render):
    """A white volume; one with isosurfaces shows these alone."""
    volume = {**volume, "shading": "phong", "material": MATERIAL}
    if "iso" in volume:
        volume["iso"] = [{**surface, "color": [1, 1, 1]} for surface in volume["iso"]]
    else:
        volume["transfer_function"] = {**volume.get("transfer_function", {}), "color": [1, 1, 1]}
    return {"halflight": 1, "image": {"width": SIDE, "height": SIDE}, "ambient": [0, 0, 0], "camera": camera, "lights": [light],
            "volumes": [volume], "render": render}


def picture(volume, camera, light, label, **render):
    """Brightness and alpha, linear."""
    scenes.run(scene_of(volume, camera, light, render), label)
    pixels = numpy.load(scenes.WORK / f"{label}.npy").astype(float)
    return pixels[:, :, 0], pixels[:, :, 3]


def mean_around(values, reach=REACH):
    """The mean of the square of pixels around each pixel that has all of them."""
    windows = numpy.lib.stride_tricks.sliding_window_view(values, (2 * reach + 1, 2 * reach + 1))
    return windows.mean((2, 3))


def inner(values):
    """The pixels that have a square of INSIDE pixels on every side."""
    return values[INSIDE:-INSIDE, INSIDE:-INSIDE]


def high_passed(difference, bright, alpha):
    """The 99.9 percentile of a difference minus its mean around each pixel, in parts of the brightness there or of half the
    greatest one, whichever is more; of pixels around which all is opaque."""
    opaque = numpy.lib.stride_tricks.sliding_window_view(alpha, (2 * INSIDE + 1, 2 * INSIDE + 1)).min((2, 3)) > 0.99
    rest = INSIDE - REACH
    lines = abs(inner(difference) - mean_around(difference)[rest:-rest, rest:-rest])[opaque]
    around = mean_around(bright)[rest:-rest, rest:-rest][opaque]
    return numpy.quantile(lines / numpy.maximum(around, around.max() / 2), 0.999)


even_floors = {}  # floors without shadows, which are the same for all methods: {(volume, light, spacing): picture}


def even_floor(volume, light, spacing):
    key = json.dumps([volume, light, spacing])
    if key not in even_floors:
        even_floors[key] = picture(volume, FLOOR_CAMERA, light, "lines-even", shadows="off", sheet_spacing=spacing)
    return even_floors[key]


def floor(volume, light, settings, spacing, label):
    """Lines of what differs from the floor without shadows."""
    even, alpha = even_floor(volume, light, spacing)
    made, _ = picture(volume, FLOOR_CAMERA, light, label, sheet_spacing=spacing, **settings)
    return high_passed(made - even, even, alpha)


def ball(volume, degrees, settings, spacing, label):
    made, alpha = picture(volume, BALL_CAMERA, wide(degrees), label, sheet_spacing=spacing, **settings)
    return high_passed(made, made, alpha)


def measure(methods, **surface):
    """{method: {"far"|"near"|"balls": {spacing: [lines, ...]}}}; methods: {name: settings}; surface: of the volumes."""
    results = {}
    for name, settings in methods.items():
        print(f"lines, {name}", flush=True)
        label = f"lines-{name.replace(' ', '-')}"
        results[name] = {kind: {spacing: [floor({**FLOOR, **surface}, light, settings, spacing, label) for light in lights]
                                for spacing in SPACINGS}
                         for kind, lights in (("far", list(far_lights())), ("near", NEAR))}
        results[name]["balls"] = {spacing: [ball({**BALL, **surface}, degrees, settings, spacing, label) for degrees in BALL_SIZES]
                                  for spacing in SPACINGS}
    return results


def rows(results, kinds):
    """Of each method: mean and greatest by kind of scene and spacing, in percent."""
    return [[name] + [f"{100 * numpy.mean(found[kind][spacing]):.2f}, {100 * max(found[kind][spacing]):.2f}"
                      for kind in kinds for spacing in SPACINGS] for name, found in results.items()]


def ball_rows(results):
    return [[name, f"{spacing:g}"] + [f"{100 * lines:.2f}" for lines in found["balls"][spacing]]
            for name, found in results.items() for spacing in SPACINGS]


def own_line(results):
    """What a ball has without soft shadows, in percent."""
    return f"{100 * min(results['hard']['balls'][SPACINGS[0]]):.2f}"


def section(results, table):
    """A section of docs/accuracy.md. table(head, rows): makes a table."""
    heads = [f"{kind}, {spacing:g}" for kind in ("far", "near") for spacing in SPACINGS]
    return f"""## Lines

The eye sees lines first, which root mean squares hardly notice. Where nothing casts a shadow there should be none: a floor alone
looks as it does without shadows, a smooth ball has no edge within its outline. A *line* is what is left of a difference from the
floor without shadows, or of the ball's picture, when the mean of the {2 * REACH + 1} x {2 * REACH + 1} pixels around each pixel is
taken off; its 99.9 percentile is told, in percent of the brightness around it.

**Floors**, 420 x 420 x 12, voxels of 2, {SIDE} x {SIDE} pixels; mean and greatest of {len(list(far_lights()))} far lights (5, 15 and
30 degrees wide, 25 to 85 degrees above the floor) and of {len(NEAR)} near ones (rectangles, a disk, balls of light), by sheet spacing.

{table(["method"] + heads, rows(results, ("far", "near")))}

**Balls** of a radius of 45 voxels, by the width of a directional light in degrees. {own_line(results)} is the ball's own: its shadow line is an edge
under hard light.

{table(["method", "spacing"] + [f"{degrees}" for degrees in BALL_SIZES], ball_rows(results))}
"""
