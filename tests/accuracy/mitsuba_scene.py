"""Runs within an environment that has Mitsuba 3: one light's pictures of a grid, by two seeds.

usage: mitsuba_scene.py JOB.json       (see outside.py for what is in it)
"""
import json
import sys

import mitsuba
import numpy

job = json.load(open(sys.argv[1]))
mitsuba.set_variant("llvm_ad_rgb")
from mitsuba import ScalarTransform4f as Transform  # noqa: E402  (needs the variant)


def light():
    described = job["light"]
    if described["type"] == "directional":
        return {"type": "directional", "direction": described["direction"], "irradiance": {"type": "rgb", "value": 1}}
    if described["radius"] == 0:
        return {"type": "point", "position": described["position"], "intensity": {"type": "rgb", "value": 1}}
    return {"type": "sphere", "center": described["position"], "radius": described["radius"],
            "emitter": {"type": "area", "radiance": {"type": "rgb", "value": 1}}}


edge, camera = job["edge"], job["camera"]
grid = numpy.load(job["grid"])
box = Transform().translate([-edge / 2] * 3).scale(edge)
half = camera["height"] / 2
scene = mitsuba.load_dict({
    "type": "scene",
    "integrator": {"type": "volpath", "max_depth": 2, "rr_depth": 100, "hide_emitters": True},
    "light": light(),
    "sensor": {"type": "orthographic", "near_clip": 0.01, "far_clip": 1e4,
               "to_world": Transform().look_at(camera["position"], camera["target"], camera["up"]).scale([half, half, 1]),
               "film": {"type": "hdrfilm", "width": job["size"], "height": job["size"], "rfilter": {"type": "box"}},
               "sampler": {"type": "independent"}},
    "cube": {"type": "cube", "to_world": Transform().scale(edge / 2), "bsdf": {"type": "null"},
             "interior": {"type": "heterogeneous", "albedo": 1.0, "scale": job["extinction"],
                          "phase": {"type": "isotropic"},
                          "sigma_t": {"type": "gridvolume", "grid": mitsuba.VolumeGrid(grid[..., None]),
                                      "filter_type": "trilinear", "wrap_mode": "clamp", "raw": True,
                                      "to_world": box}}},
})
pictures = []
for seed in range(2):
    total, passes = 0, job["passes"]
    for part in range(passes):
        picture = mitsuba.render(scene, spp=job["samples"], seed=seed * passes + part)
        total = total + numpy.array(picture)[:, :, 0]
    pictures.append(total / passes)
numpy.save(job["output"], numpy.array(pictures))
