#!/usr/bin/env python3
"""Compares the reader of OME-Zarr with zarr and ome-zarr themselves, voxel for voxel: every codec, level and placement.

usage: ngff.py DUMP_VOLUME
scripts/judges runs it where the judges are installed. Exit 0: all agree; 1: some do not.
"""
import itertools
import os
import shutil
import sys
import tempfile
import zipfile

import numcodecs
import numpy as np
import ome_zarr.io
import ome_zarr.reader
import ome_zarr.writer
import zarr
from ome_zarr.format import FormatV04, FormatV05
from zarr import codecs

from agreement import Case, run, sample

KINDS = ["uint8", "int8", "uint16", "int16", "uint32", "int32", "uint64", "int64", "float16", "float32", "float64"]
SHAPE = (21, 34, 45)
CHUNK = (8, 16, 12)


def packings():
    """Version and compressor of each kind that zarr writes and Halflight reads."""
    yield 2, None
    yield 2, numcodecs.Zlib(4)
    yield 2, numcodecs.GZip(4)
    yield 2, numcodecs.Zstd(4)
    for name, shuffle in itertools.product(("lz4", "lz4hc", "blosclz", "zstd", "zlib"), (0, 1, 2)):
        yield 2, numcodecs.Blosc(cname=name, shuffle=shuffle)
    yield 3, None
    yield 3, codecs.GzipCodec(level=4)
    yield 3, codecs.ZstdCodec(level=4, checksum=True)
    yield 3, [codecs.ZstdCodec(level=4), codecs.Crc32cCodec()]
    for name, shuffle in itertools.product(("lz4", "lz4hc", "blosclz", "zstd", "zlib"), ("noshuffle", "shuffle", "bitshuffle")):
        yield 3, codecs.BloscCodec(cname=name, shuffle=shuffle)


def array_cases(folder):
    number = itertools.count()
    for (version, packing), kind in itertools.product(packings(), KINDS):
        path = os.path.join(folder, "%d.zarr" % next(number))
        array = zarr.create_array(path, shape=SHAPE, dtype=kind, chunks=CHUNK, zarr_format=version, compressors=packing,
                                  fill_value=3)
        voxels = sample(kind, SHAPE)
        array[:16] = voxels[:16]  # the rest is missing
        yield Case(path, zarr.open_array(path, mode="r")[:])
    for packing, order, turn in itertools.product(
            (None, codecs.ZstdCodec(), codecs.BloscCodec(cname="lz4")), ("little", "big"), ((0, 1, 2), (2, 0, 1))):
        path = os.path.join(folder, "%d.zarr" % next(number))
        array = zarr.create_array(path, shape=SHAPE, dtype="int16", chunks=CHUNK, shards=tuple(2 * c for c in CHUNK),
                                  compressors=packing, serializer=codecs.BytesCodec(endian=order), fill_value=-7,
                                  filters=None if turn == (0, 1, 2) else codecs.TransposeCodec(order=turn))
        array[:9, 3:20] = sample("int16", SHAPE)[:9, 3:20]
        yield Case(path, zarr.open_array(path, mode="r")[:])
        archive = path + ".zip"
        with zipfile.ZipFile(archive, "w") as file:
            for place, _, names in os.walk(path):
                for name in names:
                    full = os.path.join(place, name)
                    file.write(full, os.path.relpath(full, path))
        yield Case(archive, zarr.open_array(zarr.storage.ZipStore(archive, mode="r"), mode="r")[:])


def add_units(path):
    """ome-zarr's writer leaves units out."""
    group = zarr.open_group(path, mode="r+")
    attributes = dict(group.attrs)
    for axis in attributes.get("ome", attributes)["multiscales"][0]["axes"]:
        if axis["type"] == "space":
            axis["unit"] = "nanometer"
    group.attrs.update(attributes)


def image_cases(folder):
    """Pyramids as ome-zarr writes them, placed as its own reader says."""
    number = itertools.count()
    for form, axes in itertools.product((FormatV04(), FormatV05()), ("tczyx", "zyx", "cyx", "yx")):
        path = os.path.join(folder, "%d.zarr" % next(number))
        extent = dict(t=2, c=3, z=8, y=64, x=96)
        voxels = sample("uint16", [extent[a] for a in axes])
        scale = [{"z": 2.0, "y": 0.325, "x": 0.65}.get(a, 1.0) for a in axes]
        kinds = {"t": "time", "c": "channel"}
        described = [dict(name=a, type=kinds.get(a, "space")) for a in axes]
        ome_zarr.writer.write_image(voxels, path, axes=described, fmt=form, scale=dict(zip(axes, scale)),
                                    storage_options=dict(chunks=tuple(min(16, n) for n in voxels.shape)))
        add_units(path)
        node = next(iter(ome_zarr.reader.Reader(ome_zarr.io.parse_url(path, mode="r"))()))
        for level, (data, changes) in enumerate(zip(node.data, node.metadata["coordinateTransformations"])):
            step = dict(zip(axes, changes[0]["scale"]))
            move = dict(zip(axes, changes[1]["translation"])) if len(changes) > 1 else {}
            read = np.asarray(data)
            for time, channel in itertools.product(range(2 if "t" in axes else 1), range(3 if "c" in axes else 1)):
                picked = read
                for kind, index in ("c", channel), ("t", time):
                    if kind in axes:
                        picked = np.take(picked, index, axes.index(kind))
                picked = picked if "z" in axes else picked[None]
                lengths = [step["x"], step["y"], step.get("z", step["x"])]
                yield Case(path, picked, [move.get(a, 0) * 1e-3 for a in "xyz"], np.diag(lengths) * 1e-3,
                           (time, channel, level, -1))


def main():
    program, failures = sys.argv[1], 0
    for name, cases in (("Zarr", array_cases), ("OME-Zarr", image_cases)):
        folder = tempfile.mkdtemp()
        failures += run(program, name, cases(folder))
        shutil.rmtree(folder)
    return 1 if failures else 0


sys.exit(main())
