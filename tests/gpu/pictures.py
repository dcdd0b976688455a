#!/usr/bin/env python3
"""Holds pictures that a device makes to the bytes of the processors' pictures, and what is told of those that it does
not make.

usage: pictures.py PROGRAM [--all]

Without --all, one scene of each feature is made: OpenCL on the processors compiles its programs for most of the time.
"""
import json
import os
import pathlib
import random
import subprocess
import sys
import tempfile

import made_volumes

program = os.path.abspath(sys.argv[1])
SIZE = 128
OPACITY = [[0.1, 0], [0.5, 0.08], [1, 0.3]]
DENSE = [[0.2, 0], [0.3, 0.95]]
AROUND = [[0, 0.02], [1, 0.3]]
LAYERS = [[0.15, 0], [0.25, 0.4], [0.4, 0.02], [0.6, 0.02], [0.7, 0], [0.75, 0.8], [1, 0.9]]


def run(folder, *arguments):
    checks = os.environ.get("ASAN_OPTIONS", "") + ":detect_leaks=0"  # what a driver's compiler leaves behind is its own
    environment = {**os.environ, "XDG_CACHE_HOME": str(folder / "cache"), "ASAN_OPTIONS": checks.lstrip(":")}
    return subprocess.run([program, *map(str, arguments)], capture_output=True, text=True, cwd=folder, env=environment)


def scene(opacity=OPACITY, shadows="hard", shading="none", direction=(0.4, -0.7, 0.5), volume=None, light=None, camera=None,
          render=None, function=None, sky=None):
    view = {"type": "perspective", "position": [50, 32, -88], "target": [0, 0, 0], "up": [0, 1, 0], "fovy_deg": 30}
    return {"halflight": 1, "image": {"width": SIZE, "height": SIZE}, "camera": camera or view, "ambient": [0.1, 0.1, 0.1],
            **({"sky": sky} if sky else {}),
            "lights": [{"color": [1, 0.9, 0.8], "intensity": 1.2, "shadows": shadows,
                        **(light or {"type": "directional", "direction": list(direction)})}],
            "volumes": [{"file": "cloud.nrrd", "shading": shading,
                         "transfer_function": {"unit_distance": 1, "opacity": opacity,
                                               "color": [[0, 0.5, 0.6, 0.3], [0.5, 0.6, 0.4, 0.2], [1, 1, 1, 1]],
                                               **(function or {})},
                         **(volume or {})}],
            "render": {"sheet_spacing": 1, "shadows": shadows, **(render or {})}}


def plane(*normal):
    return {"type": "plane", "point": [1, 1, -1], "normal": list(normal)}


PAPER = {"soft_method": "paper"}
SUBLIGHTS = {"soft_method": "sublights"}
CLIP = {"min": [5, 3, 4], "max": [24, 20, 15]}
BALL = {"type": "sphere", "center": [4, 2, -6], "radius": 9}
BLOCK = {"type": "box", "min": [-9, -5, -13], "max": [7, 9, 3]}
STEEP = {"gradient_opacity": [[0.02, 0], [0.12, 1]]}
SUN = {"type": "directional", "direction": [0.4, -0.7, 0.5], "angular_diameter_deg": 7}
LAMP = {"type": "point", "position": [40, 50, -50], "radius": 9}
TILTED = {"type": "rect", "position": [30, 40, -40], "edge1": [14, 0, 6], "edge2": [0, 12, 16]}
WITHIN = {"type": "point", "position": [4, 3, -5], "radius": 3}
FORWARDS, BACKWARDS = ({"scattering": {"anisotropy": g, "albedo": [0.9, 0.7, 0.5]}} for g in (0.7, -0.4))
SLIDE = {"file": "slide.npy", "screen": {"center": [20, 26, -26], "right": [9, 0, 6], "up": [-2, 7, 5]}}
WIDE_SLIDE = {"file": "slide.npy", "screen": {"center": [-16, 28, -20], "right": [12, 0, -9.6], "up": [4.5, 9.7, 10]}}
SHOWN = {"file": "slide.npy"}
BEHIND = {**SUN, "direction": [0.2, -0.3, -0.9]}
EVEN_SKY = {"type": "uniform", "color": [0.6, 0.8, 1], "strength": 0.8}
SKY = {"type": "gradient", "zenith": [0.36, 0.4, 0.5], "horizon": [0.32, 0.33, 0.36], "ground": [0.16, 0.14, 0.12]}
ORGANS = {"file": "organs.nrrd", "labels": [{"value": 1, "color": [0.9, 0.2, 0.1], "opacity": 0.8}, {"value": 2}, {"value": 3, "color": [0.1, 0.3, 0.9], "tint": 0.6},
                                            {"value": 4, "visible": False}]}
GRAINS = {"file": "grains.csv", "array": "density"}
CELLS = {"file": "cells.vtu"}
SHELL = [[0.2, 0], [0.4, 0.1], [1, 0.5]]
BAND = [[0.2, 0], [0.2, 0.5], [0.45, 0.5], [0.45, 0]]
THIN = [[0.001, 0], [0.05, 0.2], [1, 0.6]]
FAR = {"type": "perspective", "position": [70, 50, -120], "target": [0, 0, 0], "up": [0, 1, 0], "fovy_deg": 30}
FLAT = {"type": "orthographic", "position": [50, 32, -88], "target": [0, 0, 0], "up": [0, 1, 0], "height": 50}
PLANE = {"unit_distance": 1, "second": "gradient", "boxes": [
    {"value": [0.12, 0.5], "second": [0.01, 0.05], "edge": [0.05, 0.01], "color": [0.2, 0.4, 0.7], "opacity": 0.3},
    {"value": [0.3, 1], "second": [0.03, 0.2], "edge": [0.1, 0.02], "color": [0.8, 0.5, 0.2], "opacity": 0.9}]}


GLASS = {"unit_distance": 1, "opacity": [[0.2, 0], [0.7, 0.2]], "color": [[0, 0.2, 0.5, 0.9], [1, 0.9, 0.9, 1]]}
MOVED = {"file": "cloud.nrrd", "transform": {"translate": [7, 4, -5]}, "shading": "none", "transfer_function": GLASS}
TURNED = {"file": "cloud.nrrd", "transform": {"scale": 0.7, "rotate": {"axis": [1, 2, 0.5], "angle_deg": 40}, "translate": [-9, 3, 2]}, "shading": "none",
          "transfer_function": {**GLASS, "opacity": [[0.3, 0], [0.35, 0.9]]}}


def beside(made, *more):
    """The scene with more volumes beside and within its own."""
    made["volumes"] += more
    return made


def halved(made):
    """The scene with its volume in two halves, whose boxes meet within slabs."""
    whole = made["volumes"].pop()
    made["volumes"] += [{**whole, "clip": {"min": [0, 0, 0], "max": [14.3, 31, 31]}},
                        {**whole, "clip": {"min": [14.3, 0, 0], "max": [31, 31, 31]}}]
    return made


def projected(render=None, **more):
    """A maximum projection."""
    return scene(render={"compositing": "maximum", "sheet_spacing": 0.5, **(render or {})}, **more)


def with_plane(made):
    """The scene with a transfer function of value and gradient."""
    shown = made["volumes"][0]
    kept = {name: value for name, value in shown["transfer_function"].items() if name == "gradient_opacity"}
    shown["transfer_function"] = {**PLANE, **kept}
    return made


MADE = {
    "medium": scene(),
    "boxed, light from behind": scene(opacity=AROUND, direction=(0.2, -0.3, -0.9)),
    "opaque, light from behind, runs of 5": scene(opacity=DENSE, direction=(0.2, -0.3, -0.9), render={"slabs_at_once": 5}),
    "opaque": scene(opacity=DENSE),
    "surface without shadows": scene(opacity=DENSE, shadows="off", shading="phong"),
    "faces of the border": scene(shading="phong", shadows="off", opacity=AROUND),
    "faces of a clip box as media": scene(shading="phong", shadows="off", volume={"clip": CLIP, "cut_shading": "none"}),
    "surfaces": scene(opacity=DENSE, shading="phong"),
    "soft surfaces, light from behind": scene(shading="phong", direction=(0.2, -0.3, -0.9)),
    "faces with shadows": scene(shading="phong", opacity=AROUND, volume={"clip": CLIP}),
    "several surfaces, colours, near light": scene(opacity=LAYERS, shading="phong", volume={"attenuation_color": [1, 0.5, 0.2]},
                                                   light={"type": "point", "position": [40, 50, -50]}),
    "several surfaces, flat view, runs of 3": scene(opacity=LAYERS, shading="phong", camera=FLAT,
                                                    render={"slabs_at_once": 3, "shadow_lookup": "bilinear"}),
    "a cut plane": scene(volume={"cuts": [plane(1, 0.4, -0.2)]}),
    "cuts, surfaces": scene(opacity=AROUND, shading="phong",
                            volume={"cuts": [plane(1, 0.3, 0.2), BALL, {**BLOCK, "keep": "inside"}]}),
    "cuts in one another, runs of 3": scene(volume={"cuts": [BLOCK, BALL]}, render={"slabs_at_once": 3}),
    "an inner corner of surfaces": scene(opacity=DENSE, shading="phong", direction=(1, 0.15, -0.5), volume={"cuts": [BLOCK]}),
    "a ball is left, near light": scene(opacity=LAYERS, shading="phong", volume={"cuts": [{**BALL, "keep": "inside"}]},
                                        light={"type": "point", "position": [40, 50, -50]}),
    "cuts with shadows, light from behind": scene(opacity=DENSE, shading="phong", direction=(0.2, -0.3, -0.9),
                                                  volume={"cuts": [plane(0, 0, 1)], "cut_casts_shadow": True}),
    "faces of cuts as media, flat view": scene(opacity=AROUND, shading="phong", camera=FLAT,
                                               volume={"cuts": [plane(0.2, 1, 0), BLOCK], "cut_shading": "none"}),
    "a cut surface by its gradient": scene(opacity=DENSE, shading="phong",
                                           volume={"cuts": [plane(0.2, 1, 0)], "cut_shading": "gradient"}),
    "a field at levels": scene(opacity=THIN, volume=GRAINS, camera=FAR),
    "a field at levels, surfaces": scene(opacity=[[0.02, 0], [0.06, 0.6]], shading="phong", camera=FAR,
                                         volume={**GRAINS, "cuts": [plane(1, 0.3, 0.2)]}),
    "a mask": scene(opacity=AROUND, volume={"mask": {**ORGANS, "rest": 0.1}}),
    "a mask, surfaces": scene(opacity=DENSE, shading="phong", volume={"mask": {**ORGANS, "rest": 0}}),
    "a mask, surfaces in layers, near light": scene(opacity=LAYERS[:-2], shading="phong", volume={"mask": {**ORGANS, "rest": 0.3}},
                                                    light={"type": "point", "position": [40, 50, -50]}),
    "a mask without a colour, light from behind": scene(opacity=DENSE, shading="phong", direction=(0.2, -0.3, -0.9),
                                                        volume={"mask": {**ORGANS, "labels": [{"value": 2}, {"value": 1, "opacity": 0.3}]}}),
    "a mask, gradient opacity": scene(opacity=LAYERS, shading="phong", function=STEEP,
                                      volume={"mask": {**ORGANS, "rest": 0.5}}),
    "a mask, cuts, flat view": scene(opacity=AROUND, camera=FLAT, volume={"mask": ORGANS, "cuts": [BALL, plane(1, 0.4, -0.2)]}),
    "a mask of cut surfaces without shadows": scene(opacity=DENSE, shading="phong", shadows="off",
                                                    volume={"mask": ORGANS, "cuts": [plane(1, 0.4, -0.2)]}),
    "a mask, soft shadows, colours": scene(shadows="soft", opacity=DENSE, light=SUN,
                                           volume={"mask": ORGANS, "attenuation_color": [1, 0.5, 0.2]}),
    "a mask, a sky, surfaces": scene(sky=SKY, opacity=DENSE, shading="phong", volume={"mask": ORGANS}),
    "a mask, coloured voxels": scene(opacity=[[20, 0], [200, 0.3]], volume={"file": "colors.nrrd", "mask": {**ORGANS, "rest": 0.4}}),
    "a mask, a field at levels": scene(opacity=THIN, camera=FAR, volume={**GRAINS, "mask": {**ORGANS, "rest": 0.4}}),
    "gradient opacity": scene(opacity=DENSE, function=STEEP, light={"type": "point", "position": [40, 50, -50]}),
    "gradient opacity, surfaces": scene(opacity=LAYERS, shading="phong", function=STEEP),
    "gradient opacity, cuts, light from behind": scene(function=STEEP, direction=(0.2, -0.3, -0.9),
                                                       volume={"cuts": [BALL, plane(1, 0.4, -0.2)]}),
    "gradient opacity of cut surfaces": scene(opacity=DENSE, shading="phong", function=STEEP, volume={"cuts": [BALL]}),
    "a mask, cut surfaces, light from behind": scene(opacity=AROUND, shading="phong", direction=(0.2, -0.3, -0.9),
                                                     volume={"mask": {**ORGANS, "rest": 1}, "cuts": [BALL, plane(1, 0.4, -0.2)]}),
    "value and gradient": with_plane(scene()),
    "value and gradient, surfaces": with_plane(scene(shading="phong", light={"type": "point", "position": [40, 50, -50]})),
    "value and gradient, gradient opacity, a mask": with_plane(scene(shading="phong", function=STEEP, volume={"mask": {**ORGANS, "rest": 0.4}})),
    "value and gradient, cuts, light from behind": with_plane(scene(shading="phong", direction=(0.2, -0.3, -0.9),
                                                                    volume={"cuts": [BALL, plane(1, 0.4, -0.2)]})),
    "value and gradient, soft shadows, a sky": with_plane(scene(shadows="soft", shading="phong", light=SUN, sky=SKY)),
    "value and gradient, a field at levels, flat view": with_plane(scene(camera=FLAT, volume=GRAINS, direction=(0.2, -0.3, -0.9))),
    "soft shadows": scene(shadows="soft", light=SUN),
    "soft shadows of a wide light": scene(shadows="soft", opacity=DENSE, light={**SUN, "angular_diameter_deg": 25}),
    "soft shadows of surfaces": scene(shadows="soft", shading="phong", opacity=LAYERS, light=SUN),
    "soft shadows of surfaces, light from behind": scene(shadows="soft", shading="phong", opacity=DENSE, light=BEHIND),
    "soft shadows of colours": scene(shadows="soft", light=SUN, volume={"attenuation_color": [1, 0.5, 0.2]}),
    "soft shadows of cuts": scene(shadows="soft", shading="phong", opacity=AROUND, light=SUN,
                                  volume={"cuts": [plane(1, 0.3, 0.2), BALL, {**BLOCK, "keep": "inside"}]}),
    "soft shadows of cuts that cast, gradient opacity": scene(shadows="soft", opacity=DENSE, light=SUN, function=STEEP,
                                                              volume={"cuts": [BALL], "cut_casts_shadow": True}),
    "soft shadows, a clip box": scene(shadows="soft", shading="phong", opacity=AROUND, light=SUN, volume={"clip": CLIP}),
    "soft shadows of cut surfaces, gradient opacity": scene(opacity=DENSE, shading="phong", function=STEEP, shadows="soft",
                                                            light=SUN, volume={"cuts": [BALL]}),
    "soft shadows of surfaces, a mask": scene(opacity=DENSE, shading="phong", shadows="soft", light=SUN, volume={"mask": ORGANS}),
    "soft shadows of surfaces in layers, a mask, cuts, light from behind": scene(
        opacity=LAYERS, shading="phong", shadows="soft", light=BEHIND, volume={"mask": {**ORGANS, "rest": 0.3}, "cuts": [BALL, plane(1, 0.4, -0.2)]}),
    "soft shadows of surfaces in a clip box, gradient opacity": scene(opacity=AROUND, shading="phong", function=STEEP, shadows="soft",
                                                                      light=SUN, volume={"clip": CLIP}),
    "soft shadows of a mesh of cells": scene(opacity=SHELL, shading="phong", shadows="soft", light=SUN, volume=CELLS),
    "soft shadows of a near light": scene(shadows="soft", shading="phong", opacity=DENSE, light=LAMP),
    "soft shadows beside hard ones": scene(shadows="soft", shading="phong", opacity=DENSE, light=SUN),
    "the paper's soft shadows": scene(shadows="soft", light=SUN, render=PAPER),
    "the paper's soft shadows of surfaces, colours, near light": scene(
        shadows="soft", shading="phong", opacity=LAYERS, light=LAMP, volume={"attenuation_color": [1, 0.5, 0.2]}, render=PAPER),
    "the paper's soft shadows of a wide light from behind, cuts": scene(
        shadows="soft", shading="phong", opacity=DENSE, light={**BEHIND, "angular_diameter_deg": 30},
        volume={"cuts": [BALL, plane(1, 0.4, -0.2)]}, render={**PAPER, "slabs_at_once": 3}),
    "the paper's soft shadows of an inner corner, a mask": scene(
        shadows="soft", shading="phong", opacity=DENSE, light=SUN, volume={"mask": {**ORGANS, "rest": 0}, "cuts": [BLOCK]}, render=PAPER),
    "sub-lights": scene(shadows="soft", light=SUN, render=SUBLIGHTS),
    "sub-lights of surfaces in layers, colours, near light": scene(
        shadows="soft", shading="phong", opacity=LAYERS, light=LAMP, volume={"attenuation_color": [1, 0.5, 0.2]}, render=SUBLIGHTS),
    "sub-lights of a tilted light, dense": scene(shadows="soft", shading="phong", opacity=DENSE, light=TILTED,
                                                 render={**SUBLIGHTS, "light_samples": 3, "slabs_at_once": 3}),
    "sub-lights of a light within": scene(shadows="soft", shading="phong", opacity=AROUND, light=WITHIN, render=SUBLIGHTS),
    "sub-lights of a wide light from behind, cuts": scene(
        shadows="soft", shading="phong", opacity=DENSE, light={**BEHIND, "angular_diameter_deg": 40},
        volume={"cuts": [BALL, plane(1, 0.4, -0.2)]}, render={**SUBLIGHTS, "light_samples": 5}),
    "sub-lights, a clip box, flat view, a slab at once": scene(shadows="soft", opacity=AROUND, camera=FLAT, light=SUN, volume={"clip": CLIP},
                                                               render={**SUBLIGHTS, "slabs_at_once": 1}),
    "sub-lights of an inner corner, a mask, a sky": scene(
        sky=SKY, shadows="soft", shading="phong", opacity=DENSE, light=SUN, volume={"mask": {**ORGANS, "rest": 0}, "cuts": [BLOCK]},
        render=SUBLIGHTS),
    "sub-lights beside hard ones": scene(shadows="soft", shading="phong", opacity=LAYERS, light=TILTED, render=SUBLIGHTS),
    "forward scattering under a wide light": scene(light=SUN, volume=FORWARDS),
    "backward scattering under a ball and a tilted light": scene(light=LAMP, volume=BACKWARDS, shading="phong"),
    "forward scattering under a sky, soft shadows": scene(sky=SKY, shadows="soft", light=SUN, volume={**FORWARDS, "cuts": [BALL]}),
    "backward scattering under a sky, no shadows received": scene(sky=EVEN_SKY, light=TILTED,
                                                                  volume={**BACKWARDS, "receives_shadow": False}),
    "a projected image, parallel light without shadows": scene(shadows="off", light={"type": "directional", "direction": [0.4, -0.7, 0.5], "texture": WIDE_SLIDE}),
    "a projected image, a sun's soft shadows, surfaces": scene(shadows="soft", shading="phong", opacity=LAYERS, light={**SUN, "texture": WIDE_SLIDE}),
    "a projected image, a lamp's hard shadows, colours": scene(shading="phong", light={**LAMP, "texture": SLIDE}, volume={"attenuation_color": [1, 0.5, 0.2]}),
    "a projected image, sub-lights, cuts, a sky": scene(sky=SKY, shadows="soft", shading="phong", opacity=DENSE, light={**LAMP, "texture": SLIDE},
                                                         volume={"cuts": [BALL]}, render=SUBLIGHTS),
    "hard shadows of a light that shows an image": scene(shading="phong", light={**TILTED, "emission": SHOWN}),
    "sub-lights of a light that shows an image, colours, surfaces": scene(
        shadows="soft", shading="phong", opacity=LAYERS, light={**TILTED, "emission": SHOWN},
        volume={"attenuation_color": [1, 0.5, 0.2], "cuts": [BALL]}, render=SUBLIGHTS),
    "sub-lights of lights of which one shows an image": scene(shadows="soft", light={**TILTED, "emission": SHOWN}, render=SUBLIGHTS),
    "an even sky": scene(sky=EVEN_SKY),
    "a sky, surfaces": scene(sky=SKY, shading="phong", opacity=DENSE),
    "a sky, soft shadows of surfaces, colours": scene(sky=SKY, shadows="soft", shading="phong", opacity=LAYERS, light=SUN,
                                                      volume={"attenuation_color": [1, 0.5, 0.2]}),
    "a sky, cuts, light from behind": scene(sky=SKY, shadows="soft", shading="phong", opacity=AROUND, light=BEHIND,
                                            volume={"cuts": [plane(1, 0.3, 0.2), BALL]}),
    "a sky on a volume that receives no shadows": scene(sky=EVEN_SKY, shading="phong", opacity=LAYERS,
                                                        volume={"receives_shadow": False}),
    "a sky, a field at levels": scene(sky=SKY, opacity=[[0.02, 0], [0.06, 0.6]], shading="phong", camera=FAR, volume=GRAINS),
    "a sky, a medium that absorbs": scene(sky=SKY, shadows="soft", light=SUN, volume={"scattering": {"albedo": [0.9, 0.7, 0.5]}}),
    "coloured voxels": scene(opacity=[[20, 0], [200, 0.3]], volume={"file": "colors.nrrd"}),
    "a mesh of cells": scene(opacity=SHELL, volume=CELLS),
    "a mesh of cells, surfaces": scene(opacity=SHELL, shading="phong", volume=CELLS),
    "a maximum projection": projected(),
    "a projection of a band of values, flat view": projected(opacity=BAND, camera=FLAT, render={"kernel": "gaussian"}),
    "a projection from within": projected(camera={"type": "perspective", "position": [3, -2, -6], "target": [0, 0, 0], "up": [0, 1, 0],
                                                  "fovy_deg": 80}),
    "a projection of a clip box, wide sheets, runs of 3": projected(opacity=AROUND, volume={"clip": CLIP},
                                                                    render={"sheet_spacing": 0.4, "slabs_at_once": 3}),
    "a projection of cuts": projected(opacity=AROUND, volume={"cuts": [plane(1, 0.3, 0.2), BALL, {**BLOCK, "keep": "inside"}]}),
    "a projection of cuts, linear": projected(opacity=BAND, volume={"cuts": [BLOCK, BALL]}, render={"kernel": "linear"}),
    "a projection of a field at levels": projected(opacity=THIN, camera=FAR, volume=GRAINS),
    "a projection of a mesh of cells": projected(opacity=SHELL, volume=CELLS),
    "a projection of a mesh of cells, cuts, flat view": projected(opacity=SHELL, camera=FLAT, volume={**CELLS, "cuts": [BALL]}),
    "a projection of a mask": projected(opacity=AROUND, volume={"mask": ORGANS}),
    "a projection of coloured voxels": projected(opacity=[[20, 0], [200, 0.3]], volume={"file": "colors.nrrd"}),
    "near light, colours, flat view": scene(light={"type": "point", "position": [40, 50, -50]}, camera=FLAT,
                                            volume={"attenuation_color": [1, 0.5, 0.2]}),
}
MADE.update({
    "two media": beside(scene(opacity=AROUND), MOVED),
    "two media, light from behind, runs of 3": beside(scene(opacity=AROUND, direction=(0.2, -0.3, -0.9), render={"slabs_at_once": 3}), MOVED),
    "two volumes of surfaces": beside(scene(opacity=DENSE, shading="phong"), {**MOVED, "shading": "phong"}),
    "surfaces in a medium, near light, colours": beside(
        scene(opacity=LAYERS, shading="phong", volume={"attenuation_color": [1, 0.5, 0.2]}, light={"type": "point", "position": [40, 50, -50]}), MOVED),
    "three volumes, of which one only casts shadows and one receives none": beside(
        scene(opacity=DENSE, shading="phong"), {**MOVED, "visible": False}, {**TURNED, "receives_shadow": False, "shading": "phong"}),
    "three volumes without shadows, one flat, flat view": beside(
        scene(opacity=AROUND, shading="phong", shadows="off", camera=FLAT), {**MOVED, "shading": "flat"}, TURNED),
    "volumes, soft shadows of surfaces, colours": beside(
        scene(shadows="soft", shading="phong", opacity=LAYERS, light=SUN, volume={"attenuation_color": [1, 0.5, 0.2]}), {**MOVED, "shading": "phong"}, TURNED),
    "volumes, the paper's soft shadows": beside(scene(shadows="soft", shading="phong", opacity=DENSE, light=SUN, render=PAPER), MOVED),
    "volumes under a sky, forward scattering": beside(scene(sky=SKY, shadows="soft", light=SUN, volume=FORWARDS), {**MOVED, **BACKWARDS}, {**TURNED, "shading": "phong"}),
    "volumes with a function of value and gradient, a projected image": beside(
        with_plane(scene(shading="phong", light={**LAMP, "texture": SLIDE})), MOVED, {**TURNED, "shading": "phong"}),
    "coloured voxels in two volumes": beside(
        scene(opacity=[[20, 0], [200, 0.3]], volume={"file": "colors.nrrd"}),
        {**TURNED, "file": "colors.nrrd", "shading": "phong", "transfer_function": {**GLASS, "opacity": [[60, 0], [90, 0.9]]}}),
    "a volume in a field at levels": beside(scene(opacity=THIN, camera=FAR, volume=GRAINS), {**GRAINS, **TURNED, "file": "grains.csv"}),
})
LABELS = scene(shading="phong")
LABELS["volumes"] = [{"file": "labels.nrrd", "labels": [{"value": 1, "color": [0.8, 0.2, 0.1]}, {"value": 2, "color": [0.1, 0.4, 0.8]}]}]
MADE["labels"] = LABELS
MADE["soft shadows beside hard ones"]["lights"].append({"type": "directional", "direction": [-0.5, -0.5, 0.5], "shadows": "hard"})
MADE["backward scattering under a ball and a tilted light"]["lights"].append(TILTED)
MADE["sub-lights of lights of which one shows an image"]["lights"].append({**LAMP, "shadows": "soft"})
MADE["sub-lights beside hard ones"]["lights"] += [{"type": "directional", "direction": [-0.5, -0.5, 0.5], "shadows": "hard"},
                                                   {**LAMP, "shadows": "soft"}]
LARGE = scene(volume={"file": "large.nrrd"}, render={"sheet_spacing": 4},
              camera={"type": "perspective", "position": [380, 250, -680], "target": [0, 0, 0], "up": [0, 1, 0], "fovy_deg": 30})
# One scene of each feature.
FEW = ("medium", "a field at levels, surfaces", "gradient opacity, cuts, light from behind", "coloured voxels", "labels", "a projection of cuts",
       "the paper's soft shadows of surfaces, colours, near light", "a sky, soft shadows of surfaces, colours",
       "forward scattering under a sky, soft shadows",
       "a projected image, sub-lights, cuts, a sky",
       "three volumes, of which one only casts shadows and one receives none",
       "soft shadows of surfaces in layers, a mask, cuts, light from behind")
LEFT = {
    "more than 16 x 16 sub-lights": scene(shadows="soft", light=SUN, render={**SUBLIGHTS, "light_samples": 17}),
    "blurred shadows of lights that show images on their surfaces": scene(shadows="soft", light={**TILTED, "emission": SHOWN}),
    "meshes or isosurfaces": {**scene(), "meshes": [{"spheres": [[0, -12, 0, 3]]}]},
    "a mask with sheets more than 1.5 voxels apart": scene(volume={"mask": ORGANS}, render={"sheet_spacing": 1.6}),
    "several volumes of which one has a mask": beside(scene(volume={"mask": ORGANS}), MOVED),
    "several volumes of which one is cut or clipped": halved(scene(opacity=AROUND)),
    "a maximum projection of several volumes": beside(projected(), MOVED),
    "several volumes with different types of voxels": beside(scene(), {**MOVED, "file": "colors.nrrd"}),
    "splatting in place of gathering": scene(render={"reconstruction": "splat"}),
}


def drawn(seed, compositing):
    """A scene with cuts of all kinds, drawn by a seed."""
    draw = random.Random(seed)
    cuts = []
    for _ in range(draw.randint(1, 3)):
        at = [draw.uniform(-8, 8) for _ in range(3)]
        kept = {"keep": draw.choice(("inside", "outside"))}
        cuts.append(draw.choice(({**plane(*(draw.uniform(-1, 1) for _ in range(3))), "point": at},
                                 {"type": "sphere", "center": at, "radius": draw.uniform(5, 14), **kept},
                                 {"type": "box", "min": [a - draw.uniform(2, 12) for a in at],
                                  "max": [a + draw.uniform(2, 12) for a in at], **kept})))
    light = {**SUN, "direction": [draw.uniform(-1, 1), draw.uniform(-1, 1), draw.uniform(0.1, 1)],
             "angular_diameter_deg": draw.choice((1, 7, 30))}
    opacity, shadows, weighed = draw.choice((AROUND, LAYERS, DENSE)), draw.choice(("hard", "soft")), draw.random() < 0.7
    method = draw.choice(("cascade", "paper", "sublights"))
    return scene(opacity=opacity, shading="phong", light=light, shadows=shadows, sky=draw.choice((None, EVEN_SKY, SKY)),
                 function=STEEP if weighed and draw.random() < 0.4 else None,
                 volume={**({"mask": {**ORGANS, "rest": draw.choice((0, 0.3, 1))}} if weighed else {}), "cuts": cuts,
                         "cut_casts_shadow": draw.random() < 0.3, "cut_shading": draw.choice(("face", "none"))},
                 render={"slabs_at_once": draw.choice((0, 4, 9)), "compositing": compositing, "soft_method": method})


def picture(folder, name, device, *options):
    done = run(folder, "render", f"{name}.json", "--device", device, "-o", f"{device}.npy", "--json", *options)
    assert done.returncode == 0, f"{name}: {done.stderr}"
    return (folder / f"{device}.npy").read_bytes(), json.loads(done.stdout)


def hold(folder, name, description, *options):
    (folder / f"{name}.json").write_text(json.dumps(description))
    own, _ = picture(folder, name, "cpu")
    other, report = picture(folder, name, "opencl", *options)
    assert own == other, f"{name}: the device makes another picture than the processors"
    return report


def hold_whole(folder):
    """A volume larger than memory, and scenes with cuts that are drawn by seeds."""
    done = run(folder, "make", "cloud", "--size", 400, "-o", "large.nrrd", "--quiet")
    assert done.returncode == 0, done.stderr
    report = hold(folder, "larger than memory", LARGE, "--max-memory", "85M", "--threads", 2)
    assert report["device"] != "cpu", report
    for seed in range(4):
        hold(folder, f"drawn-{seed}", drawn(seed, "light"))
        report = hold(folder, f"drawn-{seed}-projected", drawn(seed, "maximum"))
        assert report["device"] != "cpu", report


def main():
    whole = sys.argv[2:] == ["--all"]
    with tempfile.TemporaryDirectory() as made:
        folder = pathlib.Path(made)
        listed = run(folder, "devices", "--json")
        assert listed.returncode == 0, listed.stderr
        devices = json.loads(listed.stdout)
        done = run(folder, "make", "cloud", "--size", 32, "-o", "cloud.nrrd", "--quiet")
        assert done.returncode == 0, done.stderr
        made_volumes.write_slide(folder / "slide.npy")
        made_volumes.write_grains(folder / "grains.csv")
        made_volumes.write_colors(folder / "colors.nrrd")
        made_volumes.write_labels(folder / "labels.nrrd")
        made_volumes.write_cells(folder / "cells.vtu")
        made_volumes.write_organs(folder / "organs.nrrd")
        nowhere = folder / "nowhere.json"
        nowhere.write_text(json.dumps(scene()))
        done = run(folder, "render", nowhere, "--device", "no such device", "-o", "n.npy", "--json")
        report = json.loads(done.stdout)
        assert report["device"] == "cpu" and "no device answers" in report["device_reason"], report
        assert "the processors make the pictures" in done.stderr, done.stderr
        if not any(device["interface"] == "opencl" for device in devices["devices"]):
            print("no device of OpenCL is here:", devices.get("missing", ""))
            sys.exit(77)
        for name in MADE if whole else FEW:
            report = hold(folder, name, MADE[name])
            assert report["device"] != "cpu" and report["samples_shaded"] > 1000, f"{name}: {report}"
        if whole:
            hold_whole(folder)
        for reason, description in LEFT.items():
            report = hold(folder, reason, description)
            assert report["device"] == "cpu" and report["device_reason"] == reason, f"{reason}: {report}"
        stored = list((folder / "cache/halflight").iterdir())
        assert stored and all(path.stat().st_mode & 0o777 == 0o600 for path in stored), stored
        for path in stored: # spoilt programs are no harm: they are compiled anew
            content = path.read_bytes()
            path.write_bytes(content[:len(content) // 2])
        hold(folder, "medium", MADE["medium"])


main()
