"""Runs in an environment that has Mitsuba 3: the volume under a disk of light, single scattering.

usage: mitsuba_scene.py JOB.json      prints what was measured as JSON; mitsuba-soft.npy gets two pictures, linear RGB

A frame is two halves of its samples by two seeds: their mean is the picture, their difference tells its noise.
"""
import json
import math
import sys
import time

import mitsuba
import numpy

job = json.load(open(sys.argv[1]))
mitsuba.set_variant("llvm_ad_rgb")
from mitsuba import ScalarTransform4f as Transform  # noqa: E402  (needs the variant)

camera, light = job["camera"], job["light"]


def cropped(volume):
    """(the part of the volume that is not transparent, with a margin; the index of its first voxel as x, y, z): null
    collisions outside would only cost time."""
    filled = numpy.array(job["extinction"])[volume] > 0
    low, high = [], []
    for axis in range(3):
        seen = numpy.flatnonzero(filled.any(tuple(other for other in range(3) if other != axis)))
        low.append(max(seen[0] - 1, 0))
        high.append(seen[-1] + 2)
    return volume[low[0]:high[0], low[1]:high[1], low[2]:high[2]], numpy.array(low[::-1])


volume, first = cropped(numpy.load(job["work"] + "/volume.npy"))
voxels = numpy.array(volume.shape[::-1], float)
corner = first - 128.5  # a grid's values are those of the middles of its voxels; voxel 0 is at -128
box = Transform().translate(corner.tolist()).scale(voxels.tolist())


def grid(values):
    return {"type": "gridvolume", "grid": mitsuba.VolumeGrid(numpy.ascontiguousarray(values, numpy.float32)), "raw": True,
            "filter_type": "trilinear", "wrap_mode": "clamp", "to_world": box}


# A disk of radiance L and area A gives L A / D^2 at a distance D before it; isotropic scattering sends 1 / 4 pi of that on.
radiance = light["intensity"] * 4 * math.pi * light["distance"] ** 2 / (math.pi * light["radius"] ** 2)
half = camera["height"] / 2
scene = mitsuba.load_dict({
    "type": "scene",
    "integrator": {"type": "volpath", "max_depth": 2, "rr_depth": 100, "hide_emitters": True},
    "light": {"type": "disk", "to_world": Transform().look_at(light["position"], camera["target"], camera["up"])
              .scale([light["radius"], light["radius"], 1]),
              "emitter": {"type": "area", "radiance": {"type": "rgb", "value": radiance}}},
    "sensor": {"type": "orthographic", "near_clip": 0.01, "far_clip": 1e4,
               "to_world": Transform().look_at(camera["position"], camera["target"], camera["up"]).scale([half, half, 1]),
               "film": {"type": "hdrfilm", "width": job["size"], "height": job["size"], "rfilter": {"type": "box"}},
               "sampler": {"type": "independent"}},
    "box": {"type": "cube", "bsdf": {"type": "null"},
            "to_world": Transform().translate((corner + voxels / 2).tolist()).scale((voxels / 2).tolist()),
            "interior": {"type": "heterogeneous", "phase": {"type": "isotropic"},
                         "sigma_t": grid(numpy.array(job["extinction"])[volume][..., None]),
                         "albedo": grid(numpy.array(job["color"])[volume])}},
})
halves = []
begin, processor = time.perf_counter(), time.process_time()
for seed in range(2):
    halves.append(numpy.array(mitsuba.render(scene, spp=job["samples"] // 2, seed=seed))[:, :, :3])
frame = 1e3 * (time.perf_counter() - begin)
processor = 1e3 * (time.process_time() - processor)
numpy.save(job["work"] + "/mitsuba-soft.npy", halves)
print(json.dumps({"version": mitsuba.__version__, "soft": {"frame_ms": [frame], "processor_ms": [processor]}}))
