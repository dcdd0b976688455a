"""The volume as OpenVDB grids, by Debian's python3-openvdb: values for Blender, extinctions for vdb_render.

usage: write_vdb.py JOB.json      writes volume.vdb and extinction.vdb; prints OpenVDB's version as JSON
"""
import json
import sys

import numpy
import pyopenvdb

job = json.load(open(sys.argv[1]))
volume = numpy.load(job["work"] + "/volume.npy")


def needed(values, threshold):
    """Voxels with a value above the threshold among those within one of them: others are nothing to interpolation, and
    what is sparse is faster."""
    near = numpy.pad(values > threshold, 1)
    for axis in range(3):
        near = near | numpy.roll(near, 1, axis) | numpy.roll(near, -1, axis)
    return near[1:-1, 1:-1, 1:-1]


def write(name, values):
    grid = pyopenvdb.FloatGrid()
    grid.copyFromArray(numpy.ascontiguousarray(values.transpose(2, 1, 0), numpy.float32), ijk=(-128, -128, -128))
    grid.name, grid.gridClass = "density", pyopenvdb.GridClass.FOG_VOLUME
    grid.transform = pyopenvdb.createLinearTransform(voxelSize=1)
    pyopenvdb.write(f"{job['work']}/{name}.vdb", grids=[grid])


transparent = max(value for value, opacity in job["transfer_function"]["opacity"] if opacity == 0)
write("volume", numpy.where(needed(volume, transparent), volume, 0))
write("extinction", numpy.array(job["extinction"])[volume])
print(json.dumps({"version": ".".join(str(part) for part in pyopenvdb.LIBRARY_VERSION)}))
