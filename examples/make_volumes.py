#!/usr/bin/env python3
"""Writes the small volumes of the example scenes to examples/volumes/, the same bytes on every run.

ring.nrrd    a torus about the z axis, radii 22 and 6 voxels
floor.nrrd   a slab with rounded edges
cloud.nrrd   a cumulus: fractal noise above a level, in a flat-bottomed heap
Values are 0 to 255. The surface is at 128, and values rise over four voxels across it, so that every kernel
reconstructs it smoothly.
"""
import gzip
import math
import pathlib
import random

FOLDER = pathlib.Path(__file__).resolve().parent / "volumes"


def write(name, size, value):
    """value(x, y, z): of the voxel at integers, relative to the centre of the grid."""
    nx, ny, nz = size
    voxels = bytes(max(0, min(255, round(value(x - (nx - 1) / 2, y - (ny - 1) / 2, z - (nz - 1) / 2))))
                   for z in range(nz) for y in range(ny) for x in range(nx))
    origin = ",".join(f"{-(n - 1) / 2:g}" for n in size)
    header = (f"NRRD0004\ntype: uchar\ndimension: 3\nspace dimension: 3\nsizes: {nx} {ny} {nz}\n"
              f"space directions: (1,0,0) (0,1,0) (0,0,1)\nspace origin: ({origin})\nencoding: gzip\n\n")
    (FOLDER / name).write_bytes(header.encode() + gzip.compress(voxels, 9, mtime=0))


def ring(x, y, z):
    return 128 + 64 * (6 - math.hypot(math.hypot(x, y) - 22, z))


def floor(x, y, z):
    outside = [max(0, abs(x) - 52), max(0, abs(y) - 52), max(0, abs(z) - 1)]
    return 128 + 64 * (3 - math.hypot(*outside))


def smooth(t):
    return t * t * t * (t * (6 * t - 15) + 10)


class Noise:
    """Value noise on the integer lattice, smoothly interpolated, in [-1, 1]."""

    def __init__(self, seed):
        numbers = random.Random(seed)
        self.lattice = [numbers.uniform(-1, 1) for _ in range(32 ** 3)]

    def at(self, x, y, z):
        cell = [math.floor(v) for v in (x, y, z)]
        weight = [smooth(v - c) for v, c in zip((x, y, z), cell)]
        total = 0
        for corner in range(8):
            share, index = 1, 0
            for axis in range(3):
                bit = corner >> axis & 1
                share *= weight[axis] if bit else 1 - weight[axis]
                index = 32 * index + (cell[axis] + bit) % 32
            total += share * self.lattice[index]
        return total


def main():
    FOLDER.mkdir(exist_ok=True)
    write("ring.nrrd", (64, 64, 20), ring)
    write("floor.nrrd", (116, 116, 16), floor)
    noise = Noise(7)

    def cloud(x, y, z):
        fractal = sum(0.55 ** octave * noise.at(*(v * 0.055 * 2.1 ** octave + 16 for v in (x, y, z)))
                      for octave in range(5))
        heap = 1 - math.hypot(x / 38, y / 26, (z + 12) / (30 if z > -12 else 8))
        return 340 * (heap + 0.55 * fractal)

    write("cloud.nrrd", (88, 64, 56), cloud)


main()
