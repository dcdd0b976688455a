"""Faces that cut matter and isosurfaces, and isosurfaces' own shape, beside closed forms.

A face of even matter is as bright as its cosine to the light, whatever the light's angle and the eye's. An isosurface of
squared distances is a ball: the B-spline of values x^2 is x^2 + 1/3 on voxels one unit apart (its variance along an axis).
"""
import math

import numpy

import lines
import scenes

VOXELS, DEPTH, NOISE = 96, 24, 0.03  # the box's voxels across and down; the noise's standard deviation
NORMAL = numpy.array([0.2, 0.1, 1]) / math.sqrt(1.05)
LIGHTS, EYES, WIDTH_DEG = (70, 30, 15), (70, 20, 5), 4
SEEN, MARGIN = 40, 2  # voxels: the picture's height; what is left out along the face's edges
SURFACE = 0.5  # the value of isosurfaces of shapes and of the noisy box
FUNCTIONS = ([[0, 0], [1, 0.99]], [[0.4, 0], [0.6, 0.99]])
RADIUS, STRETCHES = 60, (1, 5, 20)


def volume_file(label, values, spacing):
    """An NRRD file of values[z, y, x]; its middle is the origin."""
    path = scenes.WORK / f"{label}.nrrd"
    sizes = values.shape[::-1]
    origin = ",".join(str((1 - n) * d / 2) for n, d in zip(sizes, spacing))
    axes = " ".join("(" + ",".join(str(d if a == i else 0) for a in range(3)) + ")" for i, d in enumerate(spacing))
    head = ("NRRD0004\ntype: float\ndimension: 3\nspace dimension: 3\n"
            f"sizes: {' '.join(map(str, sizes))}\nspace directions: {axes}\nspace origin: ({origin})\n"
            "endian: little\nencoding: raw\n\n")
    scenes.WORK.mkdir(parents=True, exist_ok=True)
    path.write_bytes(head.encode() + values.astype("<f4").tobytes())
    return str(path)


# ---- faces of a noisy box ----

def noisy_box():
    noise = numpy.random.default_rng(7).normal(1, NOISE, (DEPTH, VOXELS, VOXELS))
    return {"file": volume_file("noisy-box", noise, (1, 1, 1)),
            "cuts": [{"type": "plane", "point": [0, 0, 0], "normal": list(NORMAL)}]}


def way_from(elevation_deg, azimuth_deg):
    """The unit vector from the face towards a light or an eye."""
    elevation, azimuth = math.radians(elevation_deg), math.radians(azimuth_deg)
    u = numpy.cross([0, 1, 0], NORMAL)
    u /= numpy.linalg.norm(u)
    v = numpy.cross(NORMAL, u)
    return math.sin(elevation) * NORMAL + math.cos(elevation) * (math.cos(azimuth) * u + math.sin(azimuth) * v)


def face_seen(eye):
    """The pixels whose ray meets the face away from its edges."""
    right = numpy.cross(NORMAL, eye)
    right /= numpy.linalg.norm(right)
    up = numpy.cross(eye, right)
    places = ((numpy.arange(lines.SIDE) + 0.5) / lines.SIDE - 0.5) * SEEN
    at = places[None, :, None] * right - places[:, None, None] * up
    at = at - (at @ NORMAL)[:, :, None] / (eye @ NORMAL) * eye
    half = numpy.array([VOXELS, VOXELS, DEPTH]) / 2 - MARGIN
    return (abs(at) < half).all(2).astype(float)


def face(volume, light_deg, eye_deg, settings, spacing, label):
    """The 99.9 percentiles of the face's deviations from its cosine to the light, and of its lines."""
    eye, light = way_from(eye_deg, 0), way_from(light_deg, 53)
    camera = {"type": "orthographic", "position": list(eye * 200), "target": [0, 0, 0], "up": list(NORMAL), "height": SEEN}
    lamp = {"type": "directional", "direction": list(-light), "angular_diameter_deg": WIDTH_DEG}
    made, _ = lines.picture(volume, camera, lamp, label, sheet_spacing=spacing, **settings)
    seen, even = face_seen(eye), numpy.full(made.shape, light @ NORMAL)
    deviation = numpy.quantile(abs(made / even - 1)[seen > 0], 0.999)
    return deviation, lines.high_passed(made - even, even, seen)


def faces(methods):
    """{method: {"matter"|"isosurface": {spacing: {light: (deviation, lines)}}}}: the greatest of all eyes and functions."""
    box, results = noisy_box(), {}
    kinds = {"matter": [{**box, "transfer_function": {"opacity": function, "unit_distance": 1}} for function in FUNCTIONS],
             "isosurface": [{**box, "iso": [{"value": SURFACE}]}]}
    for name, settings in methods.items():
        print(f"cut faces, {name}", flush=True)
        label = f"faces-{name.replace(' ', '-')}"
        results[name] = {kind: {spacing: {light: numpy.max([face(volume, light, eye, settings, spacing, label)
                                                            for volume in volumes for eye in EYES], axis=0)
                                          for light in LIGHTS} for spacing in lines.SPACINGS}
                         for kind, volumes in kinds.items()}
    return results


# ---- the shape of isosurfaces ----

def shape(stretch):
    """How far the points that the eye sees lie off the ball: root mean square and 99.9 percentile, in smallest edges."""
    counts = [2 * (RADIUS + 8), 2 * (RADIUS + 8), 2 * (RADIUS // stretch + 4)]
    x, y, z = [(numpy.arange(n) - (n - 1) / 2) * d for n, d in zip(counts, (1, 1, stretch))]
    squares = z[:, None, None] ** 2 + y[None, :, None] ** 2 + x[None, None, :] ** 2
    value = -(RADIUS ** 2 + (2 + stretch ** 2) / 3)
    eye = numpy.array([0.48, -0.64, 0.6])
    volume = {"file": volume_file(f"ball-{stretch}", -squares, (1, 1, stretch)), "iso": [{"value": value}]}
    height = 2.2 * RADIUS
    scene = lines.scene_of(volume, {"type": "orthographic", "position": list(eye * 300), "target": [0, 0, 0], "up": [0, 0, 1],
                                    "height": height}, {"type": "directional", "direction": list(-eye)}, {"shadows": "off"})
    label = f"shape-{stretch}"
    scenes.run(scene, label, "--layers")
    depth = numpy.load(scenes.WORK / f"{label}-depth_first.npy").astype(float)
    places = ((numpy.arange(lines.SIDE) + 0.5) / lines.SIDE - 0.5) * height
    beside = places[None, :] ** 2 + places[:, None] ** 2
    front = beside < (0.8 * RADIUS) ** 2  # the rest is seen at a slant, where a pixel's samples lie far apart in depth
    away = numpy.sqrt(beside + (300 - depth) ** 2)[front] - RADIUS
    return math.sqrt((away ** 2).mean()), numpy.quantile(abs(away), 0.999)


# ---- the page ----

def percent(values):
    return ", ".join(f"{100 * value:.2f}" for value in values)


def face_rows(results, kind):
    return [[name] + [percent(found[kind][spacing][light]) for spacing in lines.SPACINGS for light in LIGHTS]
            for name, found in results.items()]


def section(found, shapes, floors, table):
    """Sections of docs/accuracy.md. floors: of isosurfaces, as lines.measure() gives them; table(head, rows): a table."""
    heads = ["method"] + [f"{spacing:g}, {light}°" for spacing in lines.SPACINGS for light in LIGHTS]
    kinds = ("far", "near")
    return f"""## Faces of cuts

A plane cuts a box of {VOXELS} x {VOXELS} x {DEPTH} voxels with a noise of {NOISE * 100:g} % (standard deviation). The face that it leaves is as bright as its cosine to the
light. Two numbers are told in percent of this brightness: the 99.9 percentile of the deviation from it, and of lines, as above.
Each is the greatest for eyes {", ".join(map(str, EYES[:-1]))} and {EYES[-1]} degrees above the face. Columns are the sheet spacing and the light's angle
above the face. Soft lights are {WIDTH_DEG} degrees wide.

**Matter**, by two transfer functions: opacities 0 to .99 for values from 0 to 1, and from .4 to .6.

{table(heads, face_rows(found, "matter"))}

**Isosurfaces** of the same box, whose face is a cap.

{table(heads, face_rows(found, "isosurface"))}

## Isosurfaces

**Shape.** The isosurface of squared distances is a ball of {RADIUS} voxels. The points that the eye sees lie this far off it, in smallest edges of voxels.

{table(["voxels", "root mean square", "99.9 percentile"], [[f"1:1:{s}", f"{rms:.4f}", f"{most:.4f}"] for s, (rms, most) in shapes.items()])}

**Floors** as isosurfaces, under the lights of the floors above: lines, mean and greatest, by sheet spacing.

{table(["method"] + [f"{kind}, {spacing:g}" for kind in kinds for spacing in lines.SPACINGS], lines.rows(floors, kinds))}

**Balls** as isosurfaces, by the width of a directional light in degrees. {lines.own_line(floors)} is the ball's own.

{table(["method", "spacing"] + [f"{degrees}" for degrees in lines.BALL_SIZES], lines.ball_rows(floors))}
"""
