#!/usr/bin/env python3
"""What lies where, by requests: planes of voxels are the file's own values, depths are those of the layers, and hostile numbers are refused.

usage: places.py PROGRAM
"""
import json
import math
import os
import sys
import tempfile

import numpy

import checks
from checks import check
from viewer import Viewer, need_viewer

PROGRAM = os.path.abspath(sys.argv[1])
SHAPE = (9, 11, 14)  # k, j, i


def post(viewer, path, body=b"", **query):
    status, _, answer = viewer.request("POST", path, body, **query)
    return status, answer


def plane(viewer, width, height, **query):
    """(values, bytes a value) of a plane."""
    status, body = post(viewer, "slice", width=width, height=height, **query)
    check(status == 200, f"a plane {query}: {status} {body[:200]}")
    size = len(body) // (width * height)
    check(size in (4, 8) and len(body) == size * width * height, f"{len(body)} bytes for {width} x {height} values")
    return numpy.frombuffer(body, f"f{size}").reshape(height, width), size


def planes_are_the_files_values(viewer, voxels, size):
    k, j, i = SHAPE
    found, width = plane(viewer, i, j, origin="0,0,3")
    check(width == size and (found == voxels[3]).all(), "a slice along k")
    found, _ = plane(viewer, k, i, origin="13,4,0", across="0,0,1", down="-1,0,0")
    check((found == voxels[:, 4, ::-1].T).all(), "a slice along j, turned")
    found, _ = plane(viewer, i, j, origin="0,0,0", depth=k)
    check((found == voxels.max(axis=0)).all(), "a maximum intensity projection")
    found, _ = plane(viewer, i, j, origin="0,0,0", depth=k, blend="minimum")
    check((found == voxels.min(axis=0)).all(), "a minimum intensity projection")
    found, width = plane(viewer, i, j, origin="0,0,0", depth=k, blend="mean")
    mean = voxels.mean(axis=0)
    check(width == 4 and (abs(found - mean) <= 1e-6 * abs(mean)).all(), "means, as floats")
    found, width = plane(viewer, 1, 1, origin="2.5,3,4", between="linear")
    middle = (float(voxels[4, 3, 2]) + float(voxels[4, 3, 3])) / 2
    check(width == 4 and abs(found[0, 0] / middle - 1) < 1e-6, "between two voxels")
    found, _ = plane(viewer, 2, 1, origin="13,0,0")
    check(found[0, 0] == voxels[0, 0, 13] and math.isnan(found[0, 1]), "nothing beside the grid")


def hostile_planes(viewer):
    good = {"width": 4, "height": 4}
    for wrong in ({"width": 0}, {"width": -1}, {"height": ""}, {"width": 8193}, {"width": 8192, "height": 8192}, {"depth": 0}, {"depth": 8193},
                  {"width": 4096, "height": 4096, "depth": 8192}, {"origin": "1,2"}, {"origin": "1,2,3,4"}, {"origin": "nan,0,0"}, {"origin": "0,inf,0"},
                  {"origin": "1e400,0,0"}, {"origin": "2e9,0,0"}, {"across": "0x10,0,0"}, {"across": ",,"}, {"down": "a,b,c"}, {"through": "1,0, 0"},
                  {"through": "1" * 200 + ",0,0"}, {"origin": ""}, {"blend": "sum"}, {"between": "cubic"}, {"of": "colors"}, {"volume": 1}, {"volume": -1},
                  {"volume": 2**40}, {"of": "mask"}, {"opened": -1}, {"opened": "x"}, {"width": "4\0"}, {"width": 2**63}, {"width": "1e1"}):
        status, line = post(viewer, "slice", **{**good, **wrong})
        check(status == 400 and len(line) > 5, f"slice {wrong}: refused, not {status} {line[:80]}")
    check(post(viewer, "slice", **{**good, "opened": 77})[0] == 410, "what is not open")
    for path, headers, expected in ((f"/{'0' * 32}/slice?width=4&height=4", {}, 403), (f"/{viewer.token}/slice?width=4&height=4", {"Origin": "http://example.com"}, 403),
                                    (f"/{viewer.token}/slice?width=4&height=4", {"Host": "example.com"}, 403), (f"/{viewer.token}/depth?page=a&number=1", {"Origin": "null"}, 403)):
        status = viewer.request("POST", path, b"", headers)[0]
        check(status == expected, f"{path} {headers}: {status}")
    # far places, and steps that leave the grid at once, are empty planes
    for far in ({"origin": "1e9,-1e9,1e9"}, {"across": "1e9,0,0", "origin": "5,5,5000"}):
        status, body = post(viewer, "slice", **good, **far)
        check(status == 200 and numpy.isnan(numpy.frombuffer(body, "f4")).all(), f"nothing at {far}")


def depths(viewer):
    """The depth of a ball's middle pixel is the eye's distance to its front."""
    scene = json.loads(viewer.request("GET", "start.json")[2])["scene"]
    scene["image"].update(width=15, height=15)
    status, body = post(viewer, "depth", json.dumps(scene), page="a", number=1)
    check(status == 200, f"a depth: {status} {body}")
    found = json.loads(body)
    eye, target = (numpy.array(scene["camera"][key]) for key in ("position", "target"))
    distance = numpy.linalg.norm(eye - target)
    check(status == 200 and found["object"] == 1 and found["opacity"] > 0.99, f"the ball: {found}")
    check(distance - 12 < found["depth"] < distance - 8, f"its front, 10 before the middle at {distance}: {found['depth']}")
    scene["camera"]["target"] = [1000, 1000, 1000]
    found = json.loads(post(viewer, "depth", json.dumps(scene), page="a", number=2)[1])
    check(found == {"depth": None, "opacity": 0, "object": 0}, f"beside it: {found}")
    scene["image"].update(width=65)
    check(post(viewer, "depth", json.dumps(scene), page="a", number=3)[0] == 400, "a large picture")
    for query in ({}, {"page": "a"}, {"page": "A", "number": 1}, {"page": "a", "number": 0}, {"page": "a", "number": 9, "opened": -1}):
        check(post(viewer, "depth", json.dumps(scene), **query)[0] == 400, f"depth {query}")
    check(post(viewer, "depth", b"{", page="a", number=9)[0] == 400 and post(viewer, "depth", page="a", number=9)[0] == 400, "no scene")


with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    need_viewer(PROGRAM)
    chance = numpy.random.default_rng(5)
    for name, voxels, size in (("short", chance.integers(-3000, 3000, SHAPE, "i2"), 4), ("float", chance.random(SHAPE, "f4") + 1, 4),
                               ("long", chance.integers(10**9, 2 * 10**9, SHAPE, "u4"), 8), ("double", chance.random(SHAPE) + 1, 4)):
        numpy.save(f"{name}.npy", voxels)
        with Viewer(PROGRAM, f"{name}.npy") as viewer:
            planes_are_the_files_values(viewer, voxels.astype("f4") if name == "double" else voxels, size)
            if name == "short":
                hostile_planes(viewer)
    z, y, x = numpy.mgrid[:32, :32, :32] - 15.5
    numpy.save("ball.npy", (200 * numpy.clip(10.5 - numpy.sqrt(x * x + y * y + z * z), 0, 1)).astype("u1"))
    with Viewer(PROGRAM, "ball.npy") as viewer:
        depths(viewer)
print(f"{checks.count} checks passed")
