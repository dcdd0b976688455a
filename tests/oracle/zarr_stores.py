#!/usr/bin/python3
"""Zarr hierarchies that are written here, byte by byte, and what must be read from them.

usage: zarr_stores.py DUMP_VOLUME HALFLIGHT
Versions 2 and 3, every type and byte order, raw, zlib and gzip, shards, check sums, missing chunks, order of axes;
OME-Zarr's axes, units, levels, collections; archives; links and paths that lead out; damaged files. Chunks packed by zstd
and Blosc are left to scripts/judges. Exit 77: numpy is missing.
"""
import bz2
import gzip
import itertools
import json
import lzma
import os
import pathlib
import shutil
import struct
import subprocess
import sys
import tempfile
import zipfile
import zlib

try:
    import numpy as np
    from agreement import Case, run, sample
except ImportError as absent:
    print("skipped:", absent)
    sys.exit(77)

KINDS = ["uint8", "int8", "uint16", "int16", "uint32", "int32", "uint64", "int64", "float16", "float32", "float64"]
SHAPE = (7, 10, 13)  # of chunks of CHUNK, which it is no multiple of
CHUNK = (3, 4, 5)


# ---- a writer ----

def crc32c(content):
    rest = 0xffffffff
    for byte in content:
        rest ^= byte
        for _ in range(8):
            rest = rest >> 1 ^ (0x82f63b78 if rest & 1 else 0)
    return struct.pack("<I", rest ^ 0xffffffff)


def write(path, content):
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(content if isinstance(content, bytes) else json.dumps(content).encode())


def chunks(voxels, size):
    """Each chunk's coordinates, and its voxels: whole, with zeros beyond the array's end."""
    counts = [-(-extent // step) for extent, step in zip(voxels.shape, size)]
    for place in itertools.product(*map(range, counts)):
        part = voxels[tuple(slice(p * s, (p + 1) * s) for p, s in zip(place, size))]
        yield place, np.pad(part, [(0, s - extent) for s, extent in zip(size, part.shape)])


def write_2(folder, voxels, size=CHUNK, order="<", packing=None, layout="C", separator=None, fill=0, without=()):
    kind = voxels.dtype.newbyteorder(order)
    packers = {None: bytes, "zlib": zlib.compress, "gzip": gzip.compress}
    meta = {"zarr_format": 2, "shape": voxels.shape, "chunks": size, "fill_value": fill, "order": layout, "filters": None,
            "dtype": order + kind.kind + str(kind.itemsize), "compressor": packing and {"id": packing, "level": 1}}
    if separator:
        meta["dimension_separator"] = separator
    write(folder / ".zarray", meta)
    for place, part in chunks(voxels, size):
        if place not in without:
            write(folder / (separator or ".").join(map(str, place)), packers[packing](part.astype(kind).tobytes(layout)))


def codec(name, **configuration):
    return {"name": name, "configuration": configuration}


def write_3(folder, voxels, size=CHUNK, order="little", codecs=(), turned=None, shard=None, start=False, fill=0,
            separator="/", without=(), names=None, attributes=None):
    """codecs: names after "bytes"; shard: chunks in a shard along each axis."""
    packers = {"gzip": gzip.compress, "crc32c": lambda content: content + crc32c(content)}
    inner = ([codec("transpose", order=turned)] if turned else []) + [codec("bytes", endian=order)] + \
        [{"name": name} if name == "crc32c" else codec(name, level=1) for name in codecs]
    outer = [s * n for s, n in zip(size, shard)] if shard else size
    if shard:
        inner = [codec("sharding_indexed", chunk_shape=size, codecs=inner, index_location="start" if start else "end",
                       index_codecs=[codec("bytes", endian="little"), {"name": "crc32c"}])]
    write(folder / "zarr.json", {
        "zarr_format": 3, "node_type": "array", "shape": voxels.shape, "data_type": voxels.dtype.name, "fill_value": fill,
        "chunk_grid": codec("regular", chunk_shape=outer), "codecs": inner, "dimension_names": names,
        "chunk_key_encoding": codec("default", separator=separator), "attributes": attributes or {}})

    def pack(part):
        content = np.transpose(part, turned or range(part.ndim)).astype(
            voxels.dtype.newbyteorder(order)).tobytes()
        for name in codecs:
            content = packers[name](content)
        return content

    for place, part in chunks(voxels, outer):
        name = folder / separator.join(["c", *map(str, place)])
        if not shard:
            if place not in without:
                write(name, pack(part))
            continue
        index, body = [], b""
        count = len(list(chunks(part, size)))
        head = 16 * count + 4 if start else 0
        for number, (_, each) in enumerate(chunks(part, size)):
            content = pack(each)
            absent = number in without
            index.append((2**64 - 1, 2**64 - 1) if absent else (head + len(body), len(content)))
            body += b"" if absent else content
        table = b"".join(struct.pack("<QQ", *entry) for entry in index)
        table += crc32c(table)
        write(name, table + body if start else body + table)


def archive(folder, inside=""):
    path = pathlib.Path(str(folder) + ".zip")
    with zipfile.ZipFile(path, "w") as file:
        for each in sorted(folder.rglob("*")):
            if each.is_file():
                file.write(each, inside + str(each.relative_to(folder)))
    return path


# ---- arrays ----

def array_cases(root):
    number = itertools.count()

    def fresh():
        return root / ("a%d.zarr" % next(number))

    for kind, order, packing, layout in itertools.product(KINDS, "<>", (None, "zlib", "gzip"), "CF"):
        folder, voxels = fresh(), sample(kind, SHAPE)
        write_2(folder, voxels, order=order, packing=packing, layout=layout, separator="/" if layout == "F" else None)
        yield Case(str(folder), voxels)
    for kind, order, codecs in itertools.product(KINDS, ("little", "big"), ((), ("gzip",), ("crc32c",), ("gzip", "crc32c"))):
        folder, voxels = fresh(), sample(kind, SHAPE)
        write_3(folder, voxels, order=order, codecs=codecs)
        yield Case(str(folder), voxels)
    voxels = sample("int16", SHAPE)
    for turned in itertools.permutations(range(3)):
        folder = fresh()
        write_3(folder, voxels, turned=turned, shard=(2, 1, 3), codecs=("gzip",))
        yield Case(str(folder), voxels)
    for start, separator, shard in itertools.product((False, True), "./", ((1, 1, 1), (3, 3, 3), (1, 2, 4))):
        folder = fresh()
        write_3(folder, voxels, shard=shard, start=start, separator=separator, codecs=("crc32c",))
        yield Case(str(folder), voxels)
        yield Case(str(archive(folder)), voxels)
        yield Case(str(archive(folder, "some/where.zarr/")), voxels)
    large = sample("uint16", (110, 120, 130))  # read on several threads
    folder = fresh()
    write_3(folder, large, size=(16, 32, 24), shard=(2, 2, 2), codecs=("gzip",))
    yield Case(str(folder), large)


def fill_cases(root):
    fills = [("uint8", 7, 7), ("int8", -5, -5), ("uint16", 65535, 65535), ("int16", -32768, -32768), ("uint32", 70000, 70000),
             ("int64", -9, -9), ("float16", -1.5, -1.5), ("float16", "NaN", np.nan), ("float32", 0.25, 0.25),
             ("float32", "-Infinity", -np.inf), ("float32", "0x40490fdb", np.pi), ("float64", "Infinity", np.inf),
             ("float32", None, 0), ("float16", 6e-8, 5.960464477539063e-08)]
    for number, (kind, told, value) in enumerate(fills):
        voxels = np.nan_to_num(sample(kind, SHAPE))
        expected = voxels.copy()
        expected[3:6, 4:8, 10:] = value
        expected[:3, :4, :5] = value
        folder = root / ("f%d.zarr" % number)
        if not str(told).startswith("0x"):
            write_2(folder / "two", voxels, fill=told, without={(1, 1, 2), (0, 0, 0)})
            yield Case(str(folder / "two"), expected)
        write_3(folder / "three", voxels, fill=told, without={(1, 1, 2), (0, 0, 0)})
        yield Case(str(folder / "three"), expected)
        write_3(folder / "shards", voxels, fill=told, shard=(3, 3, 3), without={0, 14})
        expected = voxels.copy()
        expected[:3, :4, :5] = value
        expected[3:6, 4:8, 10:] = value
        yield Case(str(folder / "shards"), expected)


def write_filtered(folder, voxels, filters, packing=None, nested=False, size=CHUNK):
    """Version 2 with filters, packed by bz2, lzma or lz4 (one literal run). Nested chunks do not say their separator."""
    packers = {None: bytes, "bz2": bz2.compress, "lzma": lzma.compress,
               "lz4": lambda data: struct.pack("<I", len(data)) + bytes([0xf0]) + b"\xff" * ((len(data) - 15) // 255) +
               bytes([(len(data) - 15) % 255]) + data}
    write(folder / ".zarray", {"zarr_format": 2, "shape": voxels.shape, "chunks": size, "fill_value": 0, "order": "C", "filters": filters or None,
                               "dtype": voxels.dtype.str, "compressor": packing and {"id": packing}})
    for place, part in chunks(voxels, size):
        values = part.ravel()
        for one in filters:
            if one["id"] == "delta":
                values = np.diff(values, prepend=values.dtype.type(0)).astype(one["dtype"])
            if one["id"] == "fixedscaleoffset":
                values = np.around((values.astype(float) - one["offset"]) * one["scale"]).astype(one["astype"])
        data = values.tobytes()
        for one in filters:
            if one["id"] == "shuffle":
                data = np.frombuffer(data, "u1").reshape(-1, one["elementsize"]).T.tobytes()
        write(folder / ("/" if nested else ".").join(map(str, place)), packers[packing](data))


def filter_cases(root):
    for number, kind in enumerate(("|u1", "<u2", "<i4", "<i8", "<f4")):
        voxels = np.random.default_rng(number).integers(0, 100, SHAPE).astype(kind)
        width = np.dtype(kind).itemsize
        delta, shuffle = {"id": "delta", "dtype": kind}, {"id": "shuffle", "elementsize": width}
        scaled = {"id": "fixedscaleoffset", "dtype": kind, "astype": "<i2", "scale": 2, "offset": 7}
        for many, (filters, packing) in enumerate(itertools.product(
                ([], [delta], [shuffle], [delta, shuffle], [scaled], [scaled, {"id": "shuffle", "elementsize": 2}]), (None, "bz2", "lzma", "lz4"))):
            folder = root / ("filters%d_%d.zarr" % (number, many))
            write_filtered(folder, voxels, filters, packing, nested=many % 2 == 1)
            yield Case(str(folder), voxels)
    labels = np.random.default_rng(9).integers(0, 3, SHAPE).astype("u1")
    folder = root / "labels.zarr"
    write_filtered(folder / "0", labels, [], nested=True)
    write(folder / ".zgroup", {"zarr_format": 2})
    write(folder / ".zattrs", {"multiscales": [{"version": "0.3", "axes": ["z", "y", "x"], "datasets": [{"path": "0"}]}], "image-label": {
        "version": "0.3", "colors": [{"label-value": 1, "rgba": [255, 0, 0, 255]}, {"label-value": 2, "rgba": [0, 0, 255, 9]}],
        "properties": [{"label-value": 2, "class": "nucleus"}]}})
    yield Case(str(folder), labels)


# ---- OME-Zarr ----

def image_attributes(version, axes, levels, units=None, all_levels=None, **more):
    """levels: (path, transformations) each."""
    kinds = {"t": "time", "c": "channel"}
    described = [dict({"name": axis, "type": kinds.get(axis, "space")},
                      **({"unit": units[axis]} if units and axis in units else {})) for axis in axes]
    multiscale = {"version": version, "name": "the image", "axes": described,
                  "datasets": [{"path": path, "coordinateTransformations": change} for path, change in levels]}
    if all_levels:
        multiscale["coordinateTransformations"] = all_levels
    return dict({"multiscales": [multiscale]}, **more)


def write_image(folder, attributes, version):
    if version == "0.4":
        write(folder / ".zgroup", {"zarr_format": 2})
        write(folder / ".zattrs", attributes)
    else:
        write(folder / "zarr.json", {"zarr_format": 3, "node_type": "group",
                                     "attributes": {"ome": dict(attributes, version="0.5")}})


def write_level(folder, voxels, version, size):
    if version == "0.4":
        write_2(folder, voxels, size=size, packing="zlib", separator="/")
    else:
        write_3(folder, voxels, size=size, codecs=("gzip",))


def image_cases(root):
    extent = dict(t=3, c=2, z=5, y=6, x=7)
    step = dict(z=2000, y=0.5, x=0.25)
    for version, axes in itertools.product(("0.4", "0.5"), ("tczyx", "czyx", "zyx", "tyx", "yx", "cyx", "zxy", "ctzyx", "xyz")):
        folder = root / ("%s-%s.zarr" % (axes, version))
        levels = []
        for n in range(3):
            shape = [max(1, extent[a] * 2 >> n) if a in "yx" else extent[a] for a in axes]
            voxels = sample("uint16", shape, seed=n)
            scale = {"type": "scale", "scale": [step.get(a, 1) * (2**n if a in "yx" else 1) for a in axes]}
            move = {"type": "translation", "translation": [{"x": 3 + n, "y": 5, "z": -1000}.get(a, 0) for a in axes]}
            levels.append((str(n), [scale, move]))
            write_level(folder / str(n), voxels, version, [min(3, s) for s in shape])
            for time, channel in itertools.product(range(3 if "t" in axes else 1), range(2 if "c" in axes else 1)):
                picked = voxels
                order = [a for a in axes]
                for kind, index in ("t", time), ("c", channel):
                    if kind in order:
                        picked = np.take(picked, index, order.index(kind))
                        order.remove(kind)
                picked = np.transpose(picked, [order.index(a) for a in "zyx" if a in order])
                picked = picked if picked.ndim == 3 else picked[None]
                last = [step[a] * (2**n if a in "yx" else 1) for a in axes if a in step][-1]
                depth = step["z"] / 1000 if "z" in axes else last  # a plane is as thick as its last axis' step
                yield Case(str(folder), picked, (3 + n, 5, -1 if "z" in axes else 0),
                           np.diag([step["x"] * 2**n, step["y"] * 2**n, depth]), (time, channel, n, -1))
        units = dict(x="micrometer", y="micrometer", z="nanometer") if "z" in axes else dict(x="micrometer", y="micrometer")
        write_image(folder, image_attributes(version, axes, levels, units), version)
    folder = root / "all.zarr"  # a transformation of all levels, after each one's own; lengths without units
    voxels = sample("float32", (4, 5, 6))
    write_level(folder / "deep/path", voxels, "0.4", (2, 5, 4))
    write_image(folder, image_attributes("0.4", "zyx", [("deep/path", [{"type": "scale", "scale": [1, 2, 4]}])], all_levels=[
        {"type": "scale", "scale": [3, 3, 3]}, {"type": "translation", "translation": [1, 2, 3]}]), "0.4")
    yield Case(str(folder), voxels, (3, 2, 1), np.diag([12, 6, 3]))
    folder = root / "old.zarr"  # 0.2: neither axes nor scales
    for n in range(2):
        voxels = sample("uint8", (1, 2, 4, 8 >> n, 8 >> n), seed=n)
        write_level(folder / str(n), voxels, "0.4", (1, 1, 4, 4, 4))
        yield Case(str(folder), voxels[0, 1], (n / 2, n / 2, 0), np.diag([1 + n, 1 + n, 1]), (-1, 1, n, -1))
    write_image(folder, {"multiscales": [{"version": "0.2", "datasets": [{"path": "0"}, {"path": "1"}]}]}, "0.4")


def grouped_cases(root):
    """Collections, and groups of arrays that are no image."""
    folder, series = root / "series.zarr", [sample("uint16", (3, 4, 5), seed=n) for n in range(2)]
    write(folder / ".zgroup", {"zarr_format": 2})
    write(folder / ".zattrs", {"bioformats2raw.layout": 3})
    plate = root / "plate.zarr"
    write(plate / "zarr.json", {"zarr_format": 3, "node_type": "group", "attributes": {"ome": {
        "version": "0.5", "plate": {"wells": [{"path": "A/1"}, {"path": "B/7"}]}}}})
    for n, voxels in enumerate(series):
        for place, version in (folder / str(n), "0.4"), (plate / ("A/1/0", "B/7/0")[n], "0.5"):
            write_level(place / "0", voxels, version, (3, 4, 5))
            write_image(place, image_attributes(version, "zyx", [("0", [{"type": "scale", "scale": [1, 1, 1]}])]), version)
    yield Case(str(folder), series[0])
    yield Case(str(plate), series[0])
    yield Case(str(folder / "1"), series[1])
    yield Case(str(archive(plate)), series[0])
    group = root / "group.zarr"
    write(group / ".zgroup", {"zarr_format": 2})
    write_2(group / "a_line", np.arange(13, dtype="float32"), size=(13,))
    write_2(group / "density", series[1], size=(3, 4, 5))
    yield Case(str(group), series[1])
    yield Case(str(archive(group)), series[1])
    named = root / "named.zarr"
    write_3(named, sample("int16", (2, 4, 5, 3)), size=(2, 4, 5, 3), names=["time", "x", "y", "z"])
    yield Case(str(named), np.transpose(sample("int16", (2, 4, 5, 3))[1], (2, 1, 0)), choice=(1, -1, -1, -1))


# ---- what is refused ----

def read(path, *more):
    words = [DUMP, *itertools.chain.from_iterable((str(each), "-") for each in (path, *more))]
    told = subprocess.run(words, capture_output=True, text=True, timeout=200, errors="replace")
    return [json.loads(line) for line in told.stdout.splitlines()]


def refusals(root):
    voxels = sample("uint8", SHAPE)

    def changed(name, change, write_array=write_2, **options):
        folder = root / name
        write_array(folder, voxels, **options)
        meta = folder / (".zarray" if write_array is write_2 else "zarr.json")
        content = json.loads(meta.read_text())
        change(content, folder)
        meta.write_text(json.dumps(content))
        return folder

    def cut(name):
        return lambda _, folder: os.truncate(folder / name, (folder / name).stat().st_size - 1)

    def spoil(name, at):
        def do(_, folder):
            content = bytearray((folder / name).read_bytes())
            content[at] ^= 255
            (folder / name).write_bytes(content)
        return do

    def lead_out(_, folder):
        (root / "outside").write_bytes((folder / "0.0.0").read_bytes())
        for chunk in folder.glob("[0-9]*"):
            chunk.unlink()
        (folder / "0.0.0").symlink_to(root / "outside")

    def no_chunks(_, folder):
        for chunk in folder.glob("[0-9]*"):
            chunk.unlink()

    climbing = root / "climbing"
    write_image(climbing, image_attributes("0.4", "zyx", [("../a", [])]), "0.4")
    yield "a level in another folder", climbing, "in the folder"
    yield "a link out of the folder", changed("link", lead_out), "not one of its 27 chunks"
    yield "no chunks", changed("none", no_chunks), "not one of its 27 chunks"
    yield "a chunk cut short", changed("short", cut("0.0.0")), "it is damaged"
    yield "a packed chunk cut short", changed("packed", cut("0.0.0"), packing="zlib"), "it is damaged"
    yield "a shard cut short", changed("shard", cut("c/0/0/0"), write_3, shard=(3, 3, 3)), "index of a shard is damaged"
    yield "a check sum", changed("sum", spoil("c/0/0/0", 3), write_3, codecs=("crc32c",)), "check sum is wrong"
    yield "a shard's index", changed("index", spoil("c/0/0/0", 40), write_3, shard=(3, 3, 3), start=True), "index of a shard"
    yield "other codecs", changed("zfpy", lambda meta, _: meta.update(compressor={"id": "zfpy"})), "packed by \"zfpy\""
    yield "filters", changed("filters", lambda meta, _: meta.update(filters=[{"id": "packbits"}])), "the filter \"packbits\" is not read"
    yield "complex numbers", changed("complex", lambda meta, _: meta.update(dtype="<c8")), "<c8"
    yield "no shape", changed("shape", lambda meta, _: meta.update(shape=[0, 3, 3])), "above 0"
    yield "too much", changed("huge", lambda meta, _: meta.update(shape=[2**40, 2**20, 2**20])), ""
    yield "too many chunks", changed("many", lambda meta, _: meta.update(shape=[2000, 2000, 2000], chunks=[1, 1, 1])), ""
    yield "a large chunk", changed("large", lambda meta, _: meta.update(chunks=[2**40, 2**40, 2**40])), "2 GiB"
    yield "no JSON", changed("json", lambda meta, folder: (folder / "zarr.json").write_text("{")), "zarr.json, line 1"
    empty = root / "empty"
    write(empty / ".zgroup", {"zarr_format": 2})
    yield "an empty group", empty, "neither an OME-Zarr image"


def check_refusals(root):
    failures = 0
    for name, path, words in refusals(root):
        answer = read(path)[0]
        if answer["status"] == 0 or words not in answer["error"]:
            print("%s: %s" % (name, answer if answer["status"] else "was read"))
            failures += 1
    return failures


def check_levels(root):
    """By default the level that the picture shows: one with a voxel for each pixel along the longest axis, if there is one."""
    levels, failures = [], 0
    for n in range(3):
        write_level(root / "pyramid" / str(n), sample("uint8", (8 >> n, 40 >> n, 80 >> n), seed=n), "0.4", (4, 20, 40))
        levels.append((str(n), [{"type": "scale", "scale": [2**n] * 3}]))
    write_image(root / "pyramid", image_attributes("0.4", "zyx", levels), "0.4")
    for options, level in (("--size 81x9", 0), ("--size 80x9", 0), ("--size 40x30", 1), ("--size 9x40", 1), ("--size 20x9", 2),
                           ("--size 9x9", 2), ("--size 9x9 --level 1", 1), ("--size 20x9 --zoom 2", 1)):
        told = subprocess.run([PROGRAM, "render", str(root / "pyramid"), *options.split(), "--quiet", "--print-scene"], check=True,
                              capture_output=True, timeout=60)
        found = json.loads(told.stdout)["volumes"][0].get("level")
        if found != level:
            print("%s: level %s, not %d" % (options, found, level))
            failures += 1
    return failures


def check_damage(root):
    """Archives cut at every length and changed at every byte: a volume, or an error of one line."""
    sources = []
    write_3(root / "d3", sample("uint16", (4, 4, 4)), size=(2, 4, 4), shard=(2, 1, 1), codecs=("gzip", "crc32c"))
    write_2(root / "d2" / "0", sample("uint8", (4, 4, 4)), size=(2, 4, 4), packing="zlib")
    write_image(root / "d2", image_attributes("0.4", "zyx", [("0", [{"type": "scale", "scale": [1, 2, 3]}])]), "0.4")
    sources = [archive(root / "d3"), archive(root / "d2")]
    failures = 0
    for source in sources:
        content, paths = source.read_bytes(), []
        for n in range(0, len(content), 7):
            flipped = bytearray(content)
            flipped[n] ^= 1 << n % 8
            for kind, data in ("cut", content[:n]), ("changed", bytes(flipped)):
                path = root / ("%s-%s-%d" % (source.name, kind, n))
                path.write_bytes(data)
                paths.append(path)
        lines = read(*paths)
        if len(lines) != len(paths):
            print("%s: ended at %s" % (source.name, paths[len(lines)].name))
            failures += 1
    return failures


def main():
    failures = 0
    root = pathlib.Path(tempfile.mkdtemp(prefix="halflight-zarr-"))
    try:
        for name, cases in (("arrays", array_cases), ("fill values", fill_cases), ("filters", filter_cases), ("images", image_cases),
                            ("groups", grouped_cases)):
            failures += run(DUMP, name, list(cases(root)))
        failures += check_refusals(root) + check_levels(root) + check_damage(root)
    finally:
        shutil.rmtree(root, ignore_errors=True)
    print("%d problems" % failures)
    return 1 if failures else 0


if __name__ == "__main__":
    DUMP, PROGRAM = sys.argv[1:3]
    sys.exit(main())
