"""Multiple scattering beside Mitsuba 3's volpath at full depth: one row of docs/scattering.md for each case.

usage: scripts/scattering [--objects LIST] [--lights LIST] [--samples N]

A case is an object, a light, an albedo and an anisotropy. Both programs get the same voxels; Halflight's transfer function makes
extinction linear in them. Light of intensity I is an irradiance of 4 pi I to Mitsuba. Errors are means over the pixels
brighter than a twentieth of the brightest, after a mean over 3 x 3 pixels that takes most of Mitsuba's noise away.
Beside sun, point and area a light may be sky, of radiance 1 from everywhere, or image, an environment with a small sun;
once:LIGHT compares light that was scattered once, in both.
"""
import argparse
import gzip
import itertools
import json
import math
import os
import pathlib
import subprocess

import mitsuba as mi
import numpy as np

mi.set_variant("llvm_ad_mono")
ROOT = pathlib.Path(__file__).resolve().parents[2]
DATA = pathlib.Path(os.environ.get("HALFLIGHT_DATA", ROOT.parent / "shared/data"))
FOLDER = ROOT / "build/scattering"
PROGRAM = os.environ.get("HALFLIGHT", ROOT / "build/halflight")
SIDE = 48  # pixels
FILES = {"smoke": ("smoke_plume_pbrt/smoke_plume_100x100x40_float.nrrd", 0.25),
         "cloud": ("wdas_cloud/wdas_cloud_sixteenth_density.nrrd", 1.0)}


def read_nrrd(path):
    head, data = path.read_bytes().split(b"\n\n", 1)
    said = dict(line.split(": ", 1) for line in head.decode().split("\n") if ": " in line)
    sizes = [int(size) for size in said["sizes"].split()]
    if said["encoding"] in ("gzip", "gz"):
        data = gzip.decompress(data)
    return np.frombuffer(data, "<f4", count=math.prod(sizes)).reshape(sizes[::-1])


def voxels(name):
    """[z][y][x] from 0 to 1, and the extinction of 1 per voxel."""
    if name in FILES:
        values = read_nrrd(DATA / FILES[name][0])
        return np.pad(values / values.max(), 1), FILES[name][1]
    z, y, x = np.mgrid[0:48, 0:48, 0:48].astype(np.float32) - 23.5
    if name == "ball":
        return np.clip(20.5 - np.sqrt(x * x + y * y + z * z), 0, 1), 1.0
    distance = np.maximum(np.maximum(abs(x) - 17, abs(y) - 14), abs(z) - 11)
    return np.clip(0.5 - distance, 0, 1) * (0.8 + 0.2 * np.sin(0.5 * x + 1.3 * np.sin(0.4 * y) + z * 0.3)), 3.0


def radiance(x, y, z):
    """The image's, by direction: from the ground to the zenith, and a sun some ten degrees wide."""
    return 0.4 + 0.3 * z + 25 * np.exp(-(1 - (-0.6 * x - 0.5 * y + 0.62 * z) / math.hypot(0.6, 0.5, 0.62)) / 0.01)


def environment(ours):
    """[64][128] in the layout of Halflight, whose zenith is z, or of Mitsuba, whose image's is y."""
    row, column = np.mgrid[0:64, 0:128]
    down, turn = math.pi * (row + 0.5) / 64, 2 * math.pi * (column + 0.5) / 128
    side, height = np.sin(down), np.cos(down)
    if ours:
        return radiance(-side * np.sin(turn), -side * np.cos(turn), height).astype(np.float32)
    return radiance(side * np.sin(turn), height, -side * np.cos(turn)).astype(np.float32)


def light_of(kind, size):
    if kind == "sky":
        return {"type": "uniform"}
    if kind == "image":
        np.save(FOLDER / "environment.npy", np.repeat(environment(True)[..., None], 3, 2))
        return {"type": "image", "file": str(FOLDER / "environment.npy")}
    towards = np.array([-0.6, -0.5, 0.62])
    towards /= np.linalg.norm(towards)
    if kind == "sun":
        return {"type": "directional", "direction": (-towards).tolist(), "intensity": 1}
    light = {"type": "point", "position": (1.1 * size * towards).tolist(), "falloff": "inverse_square",
             "intensity": (1.1 * size) ** 2}
    if kind == "area":
        edge = np.cross(towards, [0, 0, 1])
        edge *= 0.6 * size / np.linalg.norm(edge)
        light.update(type="rect", edge1=edge.tolist(), edge2=np.cross(edge, towards).tolist())
    return light


def ours(case, values, extinction, multiple):
    name, kind, albedo, g = case
    kind = kind.split(":")[-1]
    size, corner = max(values.shape), [-(n - 1) / 2 for n in values.shape[::-1]]
    opacity = [[float(v), 1 - math.exp(-extinction * v)] for v in np.linspace(0, 1, 129)]
    scene = {"halflight": 1, "image": {"width": SIDE, "height": SIDE}, "ambient": [0, 0, 0],
             "camera": {"position": [0, -2.4 * size, 0.6 * size], "target": [0, 0, 0], "fovy_deg": 30},
             "lights": [light_of(kind, size)], "render": {"kernel": "linear"},
             "volumes": [{"file": str(FOLDER / f"{name}.npy"), "shading": "none", "transform": {"translate": corner},
                          "transfer_function": {"opacity": opacity, "unit_distance": 1, "color": [1, 1, 1]},
                          "scattering": {"anisotropy": g, "albedo": [albedo] * 3, "multiple": multiple}}]}
    if kind in ("sky", "image"):
        scene["sky"] = scene["lights"].pop()
    (FOLDER / "scene.json").write_text(json.dumps(scene))
    subprocess.run([PROGRAM, "render", FOLDER / "scene.json", "--quiet", "-o", FOLDER / "ours.npy"], check=True)
    return np.load(FOLDER / "ours.npy")[..., 0], scene


def emitter_of(light):
    if light["type"] == "uniform":
        return {"type": "constant", "radiance": 1.0}
    if light["type"] == "image":
        pixels = np.repeat(environment(False)[..., None], 3, 2)
        return {"type": "envmap", "bitmap": mi.Bitmap(pixels)}
    power = 4 * math.pi * light["intensity"]
    if light["type"] == "directional":
        return {"type": "directional", "direction": light["direction"], "irradiance": power}
    if light["type"] == "point":
        return {"type": "point", "position": light["position"], "intensity": power}
    place = np.array(light["position"])
    edge1, edge2 = np.array(light["edge1"]) / 2, np.array(light["edge2"]) / 2
    if np.dot(np.cross(edge1, edge2), place) > 0:
        edge2 = -edge2
    matrix = np.eye(4)
    matrix[:3, :] = np.stack([edge1, edge2, -place / np.linalg.norm(place), place], axis=1)
    area = 4 * np.linalg.norm(edge1) * np.linalg.norm(edge2)
    return {"type": "rectangle", "to_world": mi.ScalarTransform4f(matrix), "emitter": {"type": "area", "radiance": power / area}}


def theirs(case, scene, values, extinction, samples):
    stored = FOLDER / ("mitsuba-" + "-".join(map(str, (*case, samples))).replace(":", "-") + ".npy")
    if stored.exists():
        return np.load(stored)
    move, camera, size = mi.ScalarTransform4f(), scene["camera"], list(values.shape[::-1])
    g = case[3]
    medium = {"type": "heterogeneous", "albedo": case[2], "scale": extinction,
              "sigma_t": {"type": "gridvolume", "grid": mi.VolumeGrid(values[..., None].astype(np.float32)),
                          "to_world": move.translate([-n / 2 for n in size]).scale(size)},
              "phase": {"type": "hg", "g": g} if g else {"type": "isotropic"}}
    film = {"type": "hdrfilm", "width": SIDE, "height": SIDE, "rfilter": {"type": "box"}, "pixel_format": "luminance"}
    world = mi.load_dict({
        "type": "scene", "integrator": {"type": "volpath", "max_depth": 2 if case[1].startswith("once:") else -1, "rr_depth": 64,
                                          "hide_emitters": True},
        "light": emitter_of(scene["sky"] if "sky" in scene else scene["lights"][0]),
        "sensor": {"type": "perspective", "fov": 30, "fov_axis": "y", "film": film,
                   "to_world": mi.ScalarTransform4f().look_at(camera["position"], camera["target"], [0, 0, 1])},
        "box": {"type": "cube", "to_world": mi.ScalarTransform4f().scale([n / 2 for n in size]), "bsdf": {"type": "null"},
                "interior": medium}})
    np.save(stored, np.array(mi.render(world, spp=samples, seed=1))[..., 0])
    return np.load(stored)


def smooth(picture):
    return sum(np.roll(picture, (i, j), (0, 1)) for i in (-1, 0, 1) for j in (-1, 0, 1)) / 9


def error_of(ours, theirs):
    ours, theirs = smooth(ours), smooth(theirs)
    bright = theirs > 0.05 * np.percentile(theirs, 99)
    return 100 * (abs(ours - theirs)[bright] / theirs[bright]).mean(), ours[bright].sum() / theirs[bright].sum()


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--objects", default="ball,block,smoke,cloud")
    parser.add_argument("--lights", default="sun,point,area")
    parser.add_argument("--albedos", default="0.5,0.9,0.99")
    parser.add_argument("--samples", type=int, default=256)
    asked = parser.parse_args()
    FOLDER.mkdir(parents=True, exist_ok=True)
    print("| object | light | albedo | g | mean relative error | brightness | scattered once: error | brightness |")
    print("|---|---|---|---|---|---|---|---|")
    for name in asked.objects.split(","):
        values, extinction = voxels(name)
        np.save(FOLDER / f"{name}.npy", values.astype(np.float32))
        for case in itertools.product([name], asked.lights.split(","), map(float, asked.albedos.split(",")), (0.0, 0.8)):
            once, _ = ours(case, values, extinction, False)
            picture, scene = ours(case, values, extinction, not case[1].startswith("once:"))
            truth = theirs(case, scene, values, extinction, asked.samples)
            (error, ratio), (error_once, ratio_once) = error_of(picture, truth), error_of(once, truth)
            print(f"| {' | '.join(map(str, case))} | {error:.1f} % | {ratio:.2f} | {error_once:.1f} % | {ratio_once:.2f} |", flush=True)


main()
