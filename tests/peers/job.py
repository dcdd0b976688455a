"""Writes the scene of scene.json and its volume into the files that each of the renderers reads.

The files go to build/peers. job.json holds the scene and what is computed from it: the camera's axes, the direction of the
light, and the transfer function as a table of 256 extinctions and colours.
"""
import json
import math
import pathlib

import numpy

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
WORK = ROOT / "build" / "peers"
CLIP = {"min": [-104, -111, -112], "max": [104, 128, 112]}  # the tree and its pot, without the boards of the scanner


class MissingData(Exception):
    """The volume is not in the data folder."""


def unit(vector):
    return vector / numpy.linalg.norm(vector)


def read_bonsai(path):
    """uint8 [z][y][x]; world coordinates are indices less 128."""
    import gzip
    if not path.exists():
        raise MissingData(f"there is no {path}")
    header, _, payload = path.read_bytes().partition(b"\n\n")
    fields = dict(line.split(":", 1) for line in header.decode().splitlines() if ":" in line and not line.startswith("#"))
    if fields["encoding"].strip() in ("gz", "gzip"):
        payload = gzip.decompress(payload)
    x, y, z = (int(word) for word in fields["sizes"].split())
    return numpy.frombuffer(payload, numpy.uint8, x * y * z).reshape(z, y, x)


def clipped(volume):
    kept = numpy.zeros_like(volume)
    low, high = (numpy.array(CLIP[end]) + 128 for end in ("min", "max"))
    inside = tuple(slice(low[axis], high[axis]) for axis in (2, 1, 0))
    kept[inside] = volume[inside]
    return kept


def write_volumes(volume):
    z, y, x = volume.shape
    numpy.save(WORK / "volume.npy", volume)
    (WORK / "bonsai.nrrd").write_bytes(
        f"NRRD0004\ntype: uint8\ndimension: 3\nsizes: {x} {y} {z}\nspace dimension: 3\n"
        f"space directions: (1,0,0) (0,1,0) (0,0,1)\nspace origin: (-128,-128,-128)\nencoding: raw\n\n".encode()
        + volume.tobytes())
    (WORK / "volume.vtk").write_bytes(
        f"# vtk DataFile Version 3.0\nbonsai\nBINARY\nDATASET STRUCTURED_POINTS\nDIMENSIONS {x} {y} {z}\n"
        f"ORIGIN -128 -128 -128\nSPACING 1 1 1\nPOINT_DATA {x * y * z}\nSCALARS density unsigned_char 1\n"
        f"LOOKUP_TABLE default\n".encode() + volume.tobytes())
    (WORK / "volume.raw").write_bytes(volume.tobytes())


def classified(transfer_function):
    """(extinction per voxel [256], linear RGB [256][3]) of the values 0 to 255: opacity o of a voxel is -ln(1 - o)."""
    values = numpy.arange(256)
    points = numpy.array(transfer_function["opacity"])
    extinction = -numpy.log1p(-numpy.interp(values, points[:, 0], points[:, 1]))
    colors = numpy.array(transfer_function["color"])
    return extinction, numpy.stack([numpy.interp(values, colors[:, 0], colors[:, 1 + c]) for c in range(3)], axis=1)


def prepare(data, size, samples):
    """Writes all files; returns what is in job.json."""
    WORK.mkdir(parents=True, exist_ok=True)
    write_volumes(clipped(read_bonsai(data / "bonsai" / "bonsai.nrrd")))
    scene = json.loads((HERE / "scene.json").read_text())
    scene["image"].update(width=size, height=size)
    (WORK / "scene.json").write_text(json.dumps(scene))
    camera, light = scene["camera"], scene["lights"][0]
    position, target = numpy.array(camera["position"], float), numpy.array(camera["target"], float)
    forward = unit(target - position)
    right = unit(numpy.cross(forward, camera["up"]))
    extinction, color = classified(scene["volumes"][0]["transfer_function"])
    job = {
        "work": str(WORK), "size": size, "samples": samples,
        "camera": dict(camera, forward=forward.tolist(), right=right.tolist(), true_up=numpy.cross(right, forward).tolist()),
        "light": dict(light, direction=unit(-numpy.array(light["position"], float)).tolist(),
                      distance=math.dist(light["position"], [0, 0, 0])),
        "transfer_function": scene["volumes"][0]["transfer_function"],
        "extinction": extinction.tolist(), "color": color.tolist(),
    }
    (WORK / "job.json").write_text(json.dumps(job))
    return job
