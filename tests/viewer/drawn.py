"""Files of many kinds, and scenes and requests that are drawn at random, for scripts/siege."""
import copy
import json
import os
import pathlib
import shutil
import subprocess
import zlib

CORPUS = pathlib.Path(__file__).resolve().parent.parent / "fuzz" / "corpus"
# folders of the fuzz targets' inputs, and the ending that a name gets
INPUTS = {"amrex": ".zip", "dicom": ".dcm", "gltf": "", "mgh": "", "obj": "", "particle_files": "", "ply": "", "stl": "", "tiff": "", "vtp": "", "vtu": "",
          "zarr": ".zip"}


# ---- files ----

def write_nrrd(path, side, value):
    voxels = bytes(value(x, y, z) for z in range(side) for y in range(side) for x in range(side))
    pathlib.Path(path).write_bytes(f"NRRD0004\ntype: uint8\ndimension: 3\nsizes: {side} {side} {side}\nencoding: raw\n\n".encode() + voxels)


def write_pyramid(folder, side=128, levels=4):
    """An OME-Zarr image of several resolutions; some chunks of the finest are missing."""
    datasets = []
    for level in range(levels):
        size = side >> level
        chunk, array = min(size, 32), pathlib.Path(folder, str(level))
        array.mkdir(parents=True)
        (array / ".zarray").write_text(json.dumps(
            {"zarr_format": 2, "shape": [size] * 3, "chunks": [chunk] * 3, "dtype": "|u1", "compressor": {"id": "zlib", "level": 1},
             "fill_value": 0, "order": "C", "filters": None, "dimension_separator": "/"}))
        places = range(size // chunk)
        for z, y, x in ((z, y, x) for z in places for y in places for x in places if level > 0 or (x + y + z) % 3 > 0):
            file = array / str(z) / str(y) / str(x)
            file.parent.mkdir(parents=True, exist_ok=True)
            row = bytes((n * (level + 1) + 37 * x) % 256 for n in range(chunk))
            file.write_bytes(zlib.compress(row * chunk * chunk, 1))
        datasets.append({"path": str(level), "coordinateTransformations": [{"type": "scale", "scale": [2.0**level] * 3}]})
    axes = [{"name": axis, "type": "space"} for axis in "zyx"]
    pathlib.Path(folder, ".zgroup").write_text('{"zarr_format": 2}')
    pathlib.Path(folder, ".zattrs").write_text(json.dumps({"multiscales": [{"version": "0.4", "axes": axes, "datasets": datasets}]}))


def scenes():
    """Scenes by name, which between them have all kinds of things."""
    values = {"file": "values.nrrd"}
    sun = {"type": "directional", "direction": [0.5, 0.3, -1], "angular_diameter_deg": 9}
    screen = {"center": [0, -30, 30], "right": [5, 0, 0], "up": [0, 3, 3]}
    plane = {"second": "gradient", "boxes": [{"value": [40, 200], "second": [0, 90], "edge": [20, 6], "color": [0.2, 0.4, 0.7]}]}
    of_other = {"second": {"volume": "a"}, "polygons": [{"vertices": [[0, 0], [1, 0], [0.5, 200]], "color": [1, 0, 0]}]}
    labels = [{"value": 1, "color": [1, 0, 0]}, {"value": 2, "opacity": 0.4}, {"value": 3}, {"value": 4, "visible": False}]
    mask = {"file": "labels.nrrd", "rest": 0.3, "labels": [{"value": 1, "visible": False}, {"value": 2, "color": [0, 1, 0]}]}
    return {
        "mask": {"volumes": [{**values, "mask": mask}]},
        "sky": {"volumes": [values], "sky": {"type": "image", "file": "picture.png"}, "meshes": [{"spheres": [[5, 5, 25, 3]]}, {"floor": True}]},
        "slide": {"volumes": [values], "lights": [{"type": "spot", "position": [0, -40, 40], "direction": [0, 1, -1], "radius": 2,
                                                   "texture": {"file": "picture.png", "screen": screen}}]},
        "window": {"volumes": [values], "lights": [{"type": "rect", "position": [10, 10, 40], "edge1": [8, 0, 0], "edge2": [0, 8, 0],
                                                    "emission": {"file": "picture.png"}}]},
        "plane": {"volumes": [{**values, "name": "a", "transfer_function": plane}, {"file": "torus.nrrd", "transfer_function": of_other}]},
        "glow": {"volumes": [{"file": "torus.nrrd", "shading": "none", "scattering": {"multiple": True, "anisotropy": 0.4}}]},
        "labels": {"volumes": [{"file": "labels.nrrd", "labels": labels}], "sky": {"type": "gradient"}, "lights": [sun]},
        "meshes": {"meshes": [{"file": "ply-ascii.ply"}, {"spheres": [[0, 0, 0, 1], [2, 0, 0, 0.5]], "opacity": 0.5}, {"floor": True}]},
        "surfaces": {"volumes": [{**values, "iso": [{"value": 100, "color": [1, 0.7, 0]}, {"value": 180, "opacity": 0.4}],
                                  "cuts": [{"type": "plane", "point": [10, 10, 10], "normal": [1, 0, 1]}]}, {"file": "torus.nrrd"}]},
        "shapes": {"volumes": [{"voxel_size": 1, "shapes": [{"type": "sphere", "radius": 6}]}, values]}}


def write_files(program):
    """Writes files into the current folder. Returns the names of those that a page may try to open."""
    write_nrrd("labels.nrrd", 20, lambda x, y, z: 0 if min(x, y, z) < 3 or max(x, y, z) > 16 else 1 + (x > 9) + 2 * (y > 9))
    write_nrrd("values.nrrd", 20, lambda x, y, z: (x * y + 7 * z) % 251)
    write_nrrd("large.nrrd", 70, lambda x, y, z: min(255, 3 * x + y))  # previews have copies of it
    write_pyramid("pyramid.zarr")
    subprocess.run([program, "render", "values.nrrd", "--size", "24x16", "--quiet", "-o", "picture.png"], check=True)
    for folder, ending in INPUTS.items():
        for path in (CORPUS / folder).iterdir():
            shutil.copy(path, f"{folder}-{path.name}{ending}")
    for name, scene in scenes().items():
        pathlib.Path(name + ".json").write_text(json.dumps({"halflight": 1, **scene}))
    return sorted(os.listdir())


# ---- scenes ----

RENDER = {"shadows": ("off", "hard", "soft"), "soft_method": ("cascade", "paper", "sublights"), "light_samples": (1, 2), "sheet_spacing": (0.5, 1, 2, 4),
          "kernel": ("bspline", "gaussian", "linear", "interpolating"), "reconstruction": ("auto", "splat", "gather"), "threads": (0, 1, 2, 3),
          "slicing": ("half-vector", "image-aligned"), "shadow_lookup": ("auto", "bilinear", "cubic", "nearest"), "pixel_samples": (0, 1, 2),
          "shadow_resolution": ("auto", 1, 2, 16, 64, 200), "compositing": ("light", "light", "light", "maximum"), "slabs_at_once": (0, 1, 3)}
FUNCTIONS = ({"preset": "smoke"}, {"preset": "ct-skin"}, {"opacity": [[0, 0.2], [255, 0.2]], "color": [1, 0.5, 0.2]},
             {"opacity": [[0.2, 0], [0.6, 0.8]], "colormap": "viridis", "range": [0, 1]},
             {"opacity": [[20, 0], [160, 0.8]], "gradient_opacity": [[0, 0], [30, 1]]},
             {"second": "gradient", "boxes": [{"value": [0, 255], "second": [0, 20], "sigma": 0.3}]},
             {"second": "gradient", "polygons": [{"vertices": [[0, 0], [200, 0], [100, 50]]}]})
MESHES = ({"spheres": [[5, 5, 5, 3], [9, 5, 5, 0.2]], "opacity": 0.4}, {"floor": True})
SKIES = ({"type": "none"}, {"type": "uniform"}, {"type": "gradient"}, {"type": "gradient", "hemisphere": True, "strength": 3})


def draw_light(dice):
    kind = dice.choice(("directional", "point", "spot", "rect", "disk", "polygon"))
    light = {"type": kind, "intensity": dice.choice((1, 0.3, 5)), "shadows": dice.choice(("off", "hard", "soft")),
             "falloff": "none" if kind == "directional" else dice.choice(("none", "inverse_square"))}
    place, way = [dice.uniform(-40, 60) for _ in range(3)], [dice.uniform(-1, 1), dice.uniform(-1, 1), -1]
    own = {"directional": {"direction": way, "angular_diameter_deg": dice.choice((0, 7, 30, 119))},
           "point": {"position": place, "radius": dice.choice((0, 1, 8))},
           "spot": {"position": place, "direction": way, "opening_angle_deg": dice.choice((5, 40, 170)), "radius": dice.choice((0, 2))},
           "rect": {"position": place, "edge1": [dice.uniform(0, 9), 0, 0], "edge2": [0, dice.uniform(0, 9), 1]},
           "disk": {"position": place, "normal": [0, 0, -1], "radius": dice.choice((0, 3))},
           "polygon": {"vertices": [[-30, 0, 9], [-30, 6, 9], [-30, 3, 15]]}}
    return {**light, **own[kind]}


def draw_cut(dice):
    return dice.choice(({"type": "plane", "point": [dice.uniform(0, 20)] * 3, "normal": [dice.uniform(-1, 1), dice.uniform(-1, 1), 1]},
                        {"type": "box", "min": [2, 2, 2], "max": [dice.uniform(3, 20)] * 3},
                        {"type": "sphere", "center": [10, 10, 10], "radius": dice.uniform(1, 15), "keep": dice.choice(("inside", "outside"))}))


def change_volume(dice, volume):
    of_labels = bool(volume.get("labels"))
    if dice.random() < 0.3 and not of_labels:
        volume["iso"] = [{"value": dice.choice((0.1, 0.3, 0.5, 50, 100, 180)), "opacity": dice.choice((1, 0.5))} for _ in range(dice.choice((1, 1, 3)))]
    if dice.random() < 0.3:
        volume["cuts"] = [draw_cut(dice) for _ in range(dice.choice((1, 2, 5)))]
    if dice.random() < 0.2:
        volume["clip"] = {"min": [dice.uniform(-5, 8)] * 3, "max": [dice.uniform(8.1, 30)] * 3}
    if dice.random() < 0.3 and not of_labels:
        volume["shading"] = dice.choice(("phong", "none", "flat"))
    if dice.random() < 0.15 and not of_labels:
        volume.update(shading="none", scattering={"multiple": dice.random() < 0.5, "anisotropy": dice.uniform(-0.99, 0.99)})
    if dice.random() < 0.15:
        volume["transform"] = {"scale": dice.choice((1, 0.5, [1, 2, 0.5])), "translate": [dice.uniform(-5, 5)] * 3,
                               "rotate": {"axis": [dice.random() + 0.1, dice.random(), dice.random()], "angle_deg": dice.uniform(-180, 180)}}
    if dice.random() < 0.25 and not of_labels:
        volume["transfer_function"] = copy.deepcopy(dice.choice(FUNCTIONS))
    for key in ("visible", "casts_shadow", "receives_shadow", "cut_casts_shadow"):
        if dice.random() < 0.07:
            volume[key] = dice.random() < 0.5
    for label in (volume["labels"] if of_labels and isinstance(volume["labels"], list) else volume.get("mask", {}).get("labels") or []):
        if dice.random() < 0.3:
            label.update(visible=dice.random() < 0.6)


def draw_scene(dice, base):
    """A scene like another one, with other settings in many places."""
    scene = copy.deepcopy(base)
    scene["image"].update(width=dice.choice((1, 7, 24, 60, 100)), height=dice.choice((1, 9, 24, 50, 80)))
    scene["image"]["background_sky"] = dice.random() < 0.1
    render = scene.setdefault("render", {})
    for key, choices in RENDER.items():
        if dice.random() < 0.35:
            render[key] = dice.choice(choices)
    render["sheet_spacing"] = max(render.get("sheet_spacing", 1), 0.5)
    if "position" in scene.get("camera", {}):
        far = dice.choice((0, 1, 10))
        scene["camera"]["position"] = [place + dice.uniform(-far, far) for place in scene["camera"]["position"]]
    for volume in scene.get("volumes", []):
        change_volume(dice, volume)
    if dice.random() < 0.2:
        scene["lights"] = [draw_light(dice) for _ in range(dice.choice((0, 1, 2, 4)))]
    if dice.random() < 0.2:
        scene["sky"] = dict(dice.choice(SKIES))
    if dice.random() < 0.15:
        scene["meshes"] = [*scene.get("meshes", []), copy.deepcopy(dice.choice(MESHES))]
    if dice.random() < 0.12:
        scene["cuts"] = [draw_cut(dice)]
    return scene


def places(value, path=()):
    """The paths of all members and elements."""
    inner = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for key, item in inner:
        yield from places(item, (*path, key))
        yield (*path, key)


ODD = (1e300, -1e300, 1e-300, -1, 0, 1, 0.5, 1e15, 1e38, 1e9, 2**31, -2**31, 2**53, True, None, "x", "NaN", "auto", [], {}, [0, 0, 0], [1e300] * 3, [1, 2])
ODD_TEXTS = ("NaN", "1e999", "-1e999", "01", "1e", "\"\\u0000\"", "\"\\ud800\"", "[", "{", "1" * 400, "nul")
LARGE = ("width", "height", "pixel_samples", "light_samples", "shadow_resolution")  # greater ones are right, and take long


def draw_text(dice, scene):
    """The scene's text. One in five has an odd value, and a few are no JSON."""
    scene = copy.deepcopy(scene)
    if dice.random() < 0.2:
        *way, key = dice.choice(list(places(scene)))
        owner = scene
        for step in way:
            owner = owner[step]
        old, odd = owner[key], dice.choice(ODD)
        if isinstance(old, (int, float)) and dice.random() < 0.5:
            odd = dice.choice((10 * old, old / 10, -old, old + 1e-7, 1e5 * old))
        if isinstance(odd, (int, float)) and (key in LARGE and odd > 400 or key == "sheet_spacing" and odd < 0.2):
            odd = 400
        owner[key] = odd
    text = json.dumps(scene)
    place, chance = dice.randrange(len(text)), dice.random()
    if chance < 0.02:
        text = text[:place]
    elif chance < 0.05:
        text = text[:place] + dice.choice(ODD_TEXTS) + text[place + 1:]
    return text.encode()


def difference(dice, before, after):
    """What changes in a scene, as the page sends it (src/server/bases.c)."""
    if not isinstance(before, dict) or not isinstance(after, dict) or dice.random() < 0.1:
        return {"to": after}
    changes = {key: {"gone": 1} for key in before if key not in after}
    changes.update({key: {"to": after[key]} for key in after if key not in before})
    changes.update({key: difference(dice, before[key], after[key]) for key in before if key in after and before[key] != after[key]})
    return {"in": changes}
