#!/usr/bin/env python3
"""Compares the readers of microscopes' formats voxel for voxel with Python's own.

usage: microscopes.py DUMP_VOLUME
scripts/judges runs it where the judges are installed: mrcfile and tifffile. Exit 0: all agree; 1: some do not.
"""
import itertools
import os
import struct
import sys
import tempfile

import mrcfile
import numpy as np
import tifffile

from agreement import SHAPE, Case, run, sample


# ---------------------------------------------------------------- MRC


def mrc_read(path):
    """Voxels by mrcfile; the grid by MRC2014 from the header that mrcfile has parsed."""
    with mrcfile.open(path, permissive=True) as file:
        header, voxels = file.header, np.array(file.data)
        size = file.voxel_size
        lengths = np.array([size.x, size.y, size.z], float)
        order = [int(header.mapc) - 1, int(header.mapr) - 1, int(header.maps) - 1]
        axes = np.diag(lengths)[:, order]
        origin = np.array([header.origin.x, header.origin.y, header.origin.z], float)
        start = np.array([header.nxstart, header.nystart, header.nzstart], float)
    return voxels, origin if origin.any() else axes @ start, axes


def mrc_cases(folder):
    kinds = ["int8", "int16", "uint16", "float16", "float32", "complex64"]
    number = 0
    for kind, order, packed, placed in itertools.product(
            kinds, itertools.permutations((1, 2, 3)), (None, "gzip"), (False, True)):
        number += 1
        path = os.path.join(folder, "%d.mrc%s" % (number, ".gz" if packed else ""))
        voxels = sample("float32") + 1j * sample("float32", seed=2) if kind == "complex64" else sample(kind)
        voxels = np.nan_to_num(voxels, nan=3, posinf=4, neginf=5) if kind == "complex64" else voxels
        with mrcfile.new(path, compression=packed, overwrite=True) as file:
            file.set_data(voxels.astype(kind))
            if number % 3 == 0:
                file.set_extended_header(np.zeros(17 * number % 300, "V1"))
            file.voxel_size = (0.5, 1.25, 3.75)
            file.header.mapc, file.header.mapr, file.header.maps = order
            file.header.nxstart, file.header.nystart, file.header.nzstart = (-5, 2, 9)
            if placed:
                file.header.origin = (10.5, -2.25, 100)
        read, origin, axes = mrc_read(path)
        if kind == "complex64":
            read = np.abs(read.astype("complex128"))
        yield Case(path, read, origin, axes)
    for big in False, True:  # the other byte order, and four volumes in one file
        path = os.path.join(folder, "stack%d.mrc" % big)
        volumes = sample("int16", (4, *SHAPE))
        with mrcfile.new(path, overwrite=True) as file:
            file.set_data(volumes)
        with open(path, "rb") as file:
            content = file.read()
        if big:
            words = np.frombuffer(content[:1024], "<u4").astype(">u4")
            words[52:54] = np.frombuffer(b"MAP \x11\x11\0\0", ">u4")
            header = bytearray(words.tobytes())
            header[104:112] = content[104:112]
            header[224:] = content[224:1024]
            with open(path, "wb") as file:
                file.write(bytes(header) + volumes.astype(">i2").tobytes())
        with mrcfile.open(path, permissive=True) as file:
            read = np.array(file.data)
        assert read.shape == volumes.shape
        for time in range(4):
            yield Case(path, read[time], choice=(time, -1, -1, -1))


# ---------------------------------------------------------------- TIFF


def tiff_cases(folder):
    """Every type, byte order and layout; compressions that lose nothing, then JPEG as tifffile decodes it."""
    number = 0
    kinds = ["uint8", "int8", "uint16", "int16", "uint32", "int32", "uint64", "int64", "float16", "float32", "float64"]
    for kind, order, big in itertools.product(kinds, "<>", (False, True)):
        for compression, tile, predictor in ((None, None, False), ("zlib", (16, 32), False), ("lzw", None, True),
                                             ("packbits", (32, 16), False), ("zstd", None, True), ("lzma", None, False)):
            if predictor and (kind.endswith("64") or kind == "float16"):
                predictor = False
            number += 1
            path = os.path.join(folder, "%d.tif" % number)
            voxels = sample(kind, (4, 37, 45))
            tifffile.imwrite(path, voxels, byteorder=order, bigtiff=big, compression=compression, tile=tile,
                             predictor=predictor, rowsperstrip=None if tile else 7, photometric="minisblack")
            yield Case(path, tifffile.imread(path))
    for planar, kind in itertools.product(("contig", "separate"), ("uint8", "uint16", "float32")):
        path = os.path.join(folder, "rgb_%s_%s.tif" % (planar, kind))
        shape = (4, 37, 45, 3) if planar == "contig" else (4, 3, 37, 45)
        voxels = np.nan_to_num(sample(kind, shape), posinf=1, neginf=2)
        tifffile.imwrite(path, voxels, photometric="rgb", planarconfig=planar, tile=(16, 16))
        read = tifffile.imread(path)
        read = read if planar == "contig" else np.moveaxis(read, 1, -1)
        for component in range(3):
            yield Case(path, read[..., component], choice=(-1, -1, -1, component))
        yield Case(path, np.linalg.norm(read.astype(float), axis=-1), choice=(-1, -1, -1, -2))
    bits = os.path.join(folder, "bits.tif")
    tifffile.imwrite(bits, sample("uint8", (4, 37, 45)) > 99)
    yield Case(bits, tifffile.imread(bits).astype("uint8"))
    for count in 2, 4, 10, 12, 14:  # packed, the highest bit first
        path = os.path.join(folder, "packed%d.tif" % count)
        voxels = sample("uint16", (1, 37, 45)) & ((1 << count) - 1)
        rows = [np.packbits((row[:, None] >> np.arange(count)[::-1] & 1).astype("uint8").ravel()) for row in voxels[0]]
        content = write_packed(np.concatenate(rows).tobytes(), 45, 37, count)
        with open(path, "wb") as file:
            file.write(content)
        read = tifffile.imread(path)
        assert np.array_equal(read, voxels[0])
        yield Case(path, read[None].astype("uint8" if count <= 8 else "uint16"))
    smooth = (np.add.outer(np.arange(4), np.add.outer(np.arange(64), np.arange(48))) * 2).astype("uint8")
    jpeg = os.path.join(folder, "jpeg.tif")
    tifffile.imwrite(jpeg, smooth, compression="jpeg", tile=(16, 16), photometric="minisblack")
    yield Case(jpeg, tifffile.imread(jpeg))


def write_packed(pixels, width, height, bits):
    """A little-endian TIFF of one strip, written by hand."""
    tags = [(256, 3, width), (257, 3, height), (258, 3, bits), (259, 3, 1), (262, 3, 1), (273, 4, 8), (277, 3, 1),
            (278, 3, height), (279, 4, len(pixels))]
    at = 8 + len(pixels) + len(pixels) % 2
    entries = b"".join(struct.pack("<HHII", tag, kind, 1, value) for tag, kind, value in tags)
    head = b"II*\0" + struct.pack("<I", at) + pixels + b"\0" * (len(pixels) % 2)
    return head + struct.pack("<H", len(tags)) + entries + struct.pack("<I", 0)


def stack_cases(folder):
    letters = "TCZ"
    shape = dict(T=3, C=2, Z=5)
    for order in itertools.permutations(letters):
        path = os.path.join(folder, "%s.ome.tif" % "".join(order))
        voxels = sample("uint16", [shape[letter] for letter in order] + [11, 13])
        tifffile.imwrite(path, voxels, metadata={
            "axes": "".join(order) + "YX", "PhysicalSizeX": 0.5, "PhysicalSizeY": 0.75, "PhysicalSizeZ": 2000,
            "PhysicalSizeZUnit": "nm"})
        with tifffile.TiffFile(path) as file:
            series = file.series[0]
            read = np.moveaxis(series.asarray(), [series.axes.index(letter) for letter in letters], range(3))
        for time, channel in itertools.product(range(3), range(2)):
            yield Case(path, read[time, channel], axes=np.diag([0.5, 0.75, 2]), choice=(time, channel, -1, -1))
    path = os.path.join(folder, "imagej.tif")
    tifffile.imwrite(path, sample("uint16", (3, 5, 2, 11, 13)), imagej=True, resolution=(4, 2),
                     metadata={"axes": "TZCYX", "spacing": 2.5, "unit": "um"})
    read = tifffile.imread(path)
    for time, channel in itertools.product(range(3), range(2)):
        yield Case(path, read[time, :, channel], axes=np.diag([0.25, 0.5, 2.5]), choice=(time, channel, -1, -1))
    path = os.path.join(folder, "pyramid.ome.tif")
    levels = [sample("uint8", (3, 64 >> n, 48 >> n), n) for n in range(3)]
    with tifffile.TiffWriter(path) as file:
        file.write(levels[0], subifds=2, metadata={"axes": "ZYX", "PhysicalSizeX": 2, "PhysicalSizeY": 2,
                                                    "PhysicalSizeZ": 5})
        for level in levels[1:]:
            file.write(level, subfiletype=1)
    with tifffile.TiffFile(path) as file:
        for n, level in enumerate(file.series[0].levels):
            size = 2 * 2.0**n
            yield Case(path, level.asarray(), (size / 2 - 1, size / 2 - 1, 0), np.diag([size, size, 5]), (-1, -1, n, -1))
    yield from several_files(folder)


def several_files(folder):
    """An OME-TIFF of one file for each slice, and the same read from any of them."""
    voxels = sample("int16", (2, 4, 11, 13))
    planes = list(itertools.product(range(2), range(4)))
    data = "".join('<TiffData FirstT="%d" FirstZ="%d" IFD="0" PlaneCount="1"><UUID FileName="m_%d_%d.ome.tif">urn:uuid:%d'
                   "</UUID></TiffData>" % (time, z, time, z, number) for number, (time, z) in enumerate(planes))
    xml = ('<?xml version="1.0" encoding="UTF-8"?><OME xmlns="http://www.openmicroscopy.org/Schemas/OME/2016-06" '
           'UUID="urn:uuid:0"><Image ID="Image:0"><Pixels ID="Pixels:0" DimensionOrder="XYZCT" Type="int16" SizeX="13" '
           'SizeY="11" SizeZ="4" SizeC="1" SizeT="2"><Channel ID="Channel:0:0" SamplesPerPixel="1"/>%s</Pixels></Image>'
           "</OME>" % data)
    for time, z in planes:
        tifffile.imwrite(os.path.join(folder, "m_%d_%d.ome.tif" % (time, z)), voxels[time, z], description=xml,
                         metadata=None)
    for name in "m_0_0.ome.tif", "m_1_2.ome.tif":
        path = os.path.join(folder, name)
        read = tifffile.imread(os.path.join(folder, "m_0_0.ome.tif"))
        for time in range(2):
            yield Case(path, read[time], choice=(time, -1, -1, -1))


def main():
    program, failures = sys.argv[1], 0
    for name, cases in (("MRC", mrc_cases), ("TIFF", tiff_cases), ("OME-TIFF and ImageJ", stack_cases)):
        with tempfile.TemporaryDirectory() as folder:
            failures += run(program, name, cases(folder))
    return 1 if failures else 0


sys.exit(main())
