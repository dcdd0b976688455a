"""TIFF, OME-TIFF, OME-Zarr, Zarr and folders of raw slices: variants against tifffile, zarr and ome-zarr.

usage: microscopes.py DUMP_VOLUME DUMP_MESH HALFLIGHT"""
import json
import struct
import sys

import numcodecs
import numpy as np
import tifffile
import zarr
from campaign import PROGRAM, count, finish, read, refused, root, run, volume

random = np.random.RandomState(3)
VOXELS = random.randint(0, 60000, (3, 2, 7, 6, 5)).astype(np.uint16)  # t, c, z, y, x


def by_tifffile(kind, name, path, options, pick, spacing=None, **more):
    """Holds a file against tifffile's series; pick: the index of t, c that is read."""
    with tifffile.TiffFile(path) as file:
        series = file.series[0]
        data, axes = series.asarray(), series.axes
    index = tuple(pick.get(a, slice(None)) for a in axes)
    volume(kind, name, path, data[index].reshape(data[index].shape[-3:]), spacing, options=options, **more)


def chosen(time, channel):
    return ("--time", str(time)) * (time is not None) + ("--channel", str(channel)) * (channel is not None)


def test_imagej():
    for name, data, meta, resolution, spacing, options, pick in (
            ("stack", VOXELS[0, 0], {"axes": "ZYX", "spacing": 2.0, "unit": "um"}, (4, 2), (0.25, 0.5, 2), (), {}),
            ("hyperstack", VOXELS.transpose(0, 2, 1, 3, 4), {"axes": "TZCYX", "spacing": 1.5, "unit": "micron", "finterval": 2.5}, (2, 2), (0.5, 0.5, 1.5), chosen(2, 1), {"T": 2, "C": 1}),
            ("channels alone", VOXELS[0].transpose(1, 0, 2, 3), {"axes": "ZCYX", "unit": "nm", "spacing": 300}, (0.01, 0.01), (0.1, 0.1, 0.3), chosen(None, 1), {"C": 1}),
            ("times alone", VOXELS[:, 0], {"axes": "TZYX", "unit": "mm", "spacing": 0.001}, (1000, 1000), (1, 1, 1), chosen(1, None), {"T": 1}),
            ("floats", VOXELS[0, 0].astype(np.float32) / 7, {"axes": "ZYX", "spacing": 3, "unit": "cm"}, (10, 20), (1000, 500, 30000), (), {})):
        path = root / "i.tif"
        tifffile.imwrite(path, data, imagej=True, metadata=meta, resolution=resolution)
        by_tifffile("ImageJ", name, path, options, pick, spacing)
    # the layout above 4 GB: one directory, all pixels after it
    for name, shape, axes, options, pick in (("stack", (7, 6, 5), "ZYX", (), {}), ("hyperstack", (3, 7, 2, 6, 5), "TZCYX", chosen(1, 1), {"T": 1, "C": 1}),
                                             ("channels", (7, 2, 6, 5), "ZCYX", chosen(None, 0), {"C": 0}), ("bytes", (9, 6, 5), "ZYX", (), {}), ("floats", (4, 8, 3), "ZYX", (), {})):
        kind = np.uint8 if name == "bytes" else np.float32 if name == "floats" else np.uint16
        data = random.randint(0, 255, shape).astype(kind)
        path = root / "big.tif"
        tifffile.imwrite(path, data, imagej=True, metadata={"axes": axes, "spacing": 2.0, "unit": "um"}, contiguous=True)
        content = bytearray(path.read_bytes())
        with tifffile.TiffFile(path) as file:
            last = file.pages[0]
            order = file.byteorder
        tags = struct.unpack_from(order + "H", content, last.offset)[0]
        struct.pack_into(order + "I", content, last.offset + 2 + 12 * tags, 0)  # no directory follows
        path.write_bytes(content)
        if len(tifffile.TiffFile(path).pages) != 1:
            count("ImageJ above 4 GB", name, "the judge's file has several pages")
            continue
        by_tifffile("ImageJ above 4 GB", name, path, options, pick, (1, 1, 2))
    for name, unit, more, spacing in (("yunit", "um", {"yunit": "nm"}, (0.5, 0.0005, 2)), ("zunit", "mm", {"zunit": "um"}, (500, 500, 2)), ("\\u00B5m", "\\u00B5m", {}, (0.5, 0.5, 2)),
                                      ("inch", "inch", {}, (12700, 12700, 50800)), ("both", "um", {"yunit": "mm", "zunit": "nm"}, (0.5, 500, 0.002))):
        path = root / "u.tif"
        lines = "".join(f"{word}={value}\n" for word, value in more.items())
        description = f"ImageJ=1.54f\nimages=7\nslices=7\nunit={unit}\n{lines}spacing=2.0\nloop=false\n"
        with tifffile.TiffWriter(path) as writer:
            for n in range(7):
                writer.write(VOXELS[0, 0, n], description=description if n == 0 else None, metadata=None, resolution=(2, 2), contiguous=False)
        volume("ImageJ units", name, path, VOXELS[0, 0], spacing)


def test_shaped():
    for axes, shape, options, pick in (("TZYX", (3, 7, 6, 5), chosen(2, None), {"T": 2}), ("CZYX", (2, 7, 6, 5), chosen(None, 1), {"C": 1}), ("ZCYX", (7, 2, 6, 5), chosen(None, 1), {"C": 1}),
                                       ("TCZYX", (3, 2, 7, 6, 5), chosen(1, 0), {"T": 1, "C": 0}), ("ZYX", (7, 6, 5), (), {}), ("CTZYX", (2, 3, 7, 6, 5), chosen(2, 1), {"C": 1, "T": 2})):
        data = random.randint(0, 60000, shape).astype(np.uint16)
        path = root / "s.tif"
        tifffile.imwrite(path, data, metadata={"axes": axes}, compression="zlib" if axes == "CZYX" else None, bigtiff=axes == "TCZYX", tile=(16, 16) if axes == "ZCYX" else None)
        by_tifffile("tifffile's series", axes, path, options, pick)
    for name, shape in (("volumetric", (20, 40, 50)), ("volumetric, odd", (17, 33, 65))):
        data = random.randint(0, 255, shape).astype(np.uint8)
        for compression in (None, "zlib", "lzw"):
            path = root / "v.tif"
            tifffile.imwrite(path, data, volumetric=True, tile=(16, 16, 16), compression=compression)
            if compression == "lzw":
                refused("volumetric TIFF", f"{name}, {compression}", path, "save it with plain deflate, or uncompressed")
            else:
                volume("volumetric TIFF", f"{name}, {compression}", path, data)


def test_ome():
    units = {"nm": 1e-3, "mm": 1e3, "\u00b5m": 1, "\u212b": 1e-4, "in": 25400, "dam": 1e7, "fm": 1e-9, "mi": 1609344e3, "ft": 304800, "pm": 1e-6}
    for unit, factor in units.items():
        path = root / "o.ome.tif"
        size = 0.25 / factor
        tifffile.imwrite(path, VOXELS[0, 0], metadata={"axes": "ZYX", "PhysicalSizeX": size, "PhysicalSizeXUnit": unit if unit != "\u212b" else "\u00c5", "PhysicalSizeY": 2 * size,
                         "PhysicalSizeYUnit": unit if unit != "\u212b" else "\u00c5", "PhysicalSizeZ": 8 * size, "PhysicalSizeZUnit": unit if unit != "\u212b" else "\u00c5"})
        volume("OME-TIFF lengths", f"the unit {unit}", path, VOXELS[0, 0], (0.25, 0.5, 2))
    for axes, data, options, pick in (("TCZYX", VOXELS, chosen(2, 1), {"T": 2, "C": 1}), ("TZCYX", VOXELS.transpose(0, 2, 1, 3, 4), chosen(1, 1), {"T": 1, "C": 1}),
                                      ("CZYX", VOXELS[0], chosen(None, 1), {"C": 1}), ("ZCYX", VOXELS[0].transpose(1, 0, 2, 3), chosen(None, 0), {"C": 0}),
                                      ("TZYX", VOXELS[:, 0], chosen(2, None), {"T": 2})):
        path = root / "a.ome.tif"
        tifffile.imwrite(path, data, metadata={"axes": axes, "Channel": {"Name": ["a", "b"]}} if "C" in axes else {"axes": axes}, compression="zlib" if axes == "CZYX" else None)
        by_tifffile("OME-TIFF", axes, path, options, pick)


def group(path, array, version, **attributes):
    """An OME-Zarr image of one level, by zarr."""
    made = zarr.open_group(path, mode="w", zarr_format=version)
    made.attrs.update(attributes)
    return made


def multiscales(axes, scale, translation=None, version="0.4"):
    transforms = [{"type": "scale", "scale": scale}] + ([{"type": "translation", "translation": translation}] if translation else [])
    return [{"version": version, "axes": [{"name": a, "type": {"t": "time", "c": "channel"}.get(a, "space"), **({"unit": "micrometer"} if a in "zyx" else {})} for a in axes],
             "datasets": [{"path": "0", "coordinateTransformations": transforms}]}]


def test_zarr():
    codecs = {"blosc lz4": numcodecs.Blosc("lz4", 5, 1), "blosc zstd bit shuffle": numcodecs.Blosc("zstd", 5, 2), "zlib": numcodecs.Zlib(5), "gzip": numcodecs.GZip(5), "zstd": numcodecs.Zstd(3),
              "lz4": numcodecs.LZ4(), "bz2": numcodecs.BZ2(5), "lzma": numcodecs.LZMA(), "none": None}
    filters = {"delta": [numcodecs.Delta("<u2")], "shuffle": [numcodecs.Shuffle(2)], "delta and shuffle": [numcodecs.Delta("<u2"), numcodecs.Shuffle(2)], "none": None,
               "fixed scale": [numcodecs.FixedScaleOffset(0, 1, "<u2", "<u2")]}
    for codec, packer in codecs.items():
        for filtered in ("none", "delta") if codec != "blosc lz4" else filters:
            path = root / "z.zarr"
            made = group(path, None, 2, multiscales=multiscales("zyx", [2, 0.5, 0.25]))
            array = made.create_array("0", shape=(7, 6, 5), chunks=(3, 4, 2), dtype="<u2", compressors=packer, filters=filters[filtered], chunk_key_encoding={"name": "v2", "separator": "/"})
            array[:] = VOXELS[0, 0]
            data = zarr.open_group(path, mode="r")["0"][:]
            volume("Zarr codecs" if filtered == "none" else "Zarr filters", f"{codec}, {filtered}", path, data, (0.25, 0.5, 2))
    for name, version, order, separator, dtype, axes, options in (
            ("0.2 flat", 2, "C", ".", "<u2", "tczyx", chosen(1, 1)), ("nested, Fortran", 2, "F", "/", "<f4", "tczyx", chosen(2, 0)), ("big-endian", 2, "C", "/", ">i4", "zyx", ()),
            ("version 3", 3, "C", "/", "int16", "czyx", chosen(None, 1)), ("version 3, 64 bits", 3, "C", ".", "uint64", "zyx", ()), ("nested, no separator told", 2, "C", "/", "<u2", "tczyx", chosen(0, 1))):
        data = {"tczyx": VOXELS, "czyx": VOXELS[0], "zyx": VOXELS[0, 0]}[axes].astype(dtype if version == 2 else np.dtype(dtype))
        path = root / "n.zarr"
        scale = [1] * (len(axes) - 3) + [2, 0.5, 0.25]
        where = [0] * (len(axes) - 3) + [30, 20, 10]
        if version == 2:
            made = group(path, None, 2, multiscales=multiscales(axes, scale, where))
            array = made.create_array("0", shape=data.shape, chunks=(1,) * (len(axes) - 3) + (4, 4, 4), dtype=data.dtype, order=order, chunk_key_encoding={"name": "v2", "separator": separator})
        else:
            made = group(path, None, 3, ome={"version": "0.5", "multiscales": multiscales(axes, scale, where)})
            array = made.create_array("0", shape=data.shape, chunks=(1,) * (len(axes) - 3) + (4, 4, 4), dtype=data.dtype, chunk_key_encoding={"name": "default", "separator": separator})
        array[:] = data
        if "told" in name:
            text = json.loads((path / "0" / ".zarray").read_text())
            text.pop("dimension_separator")
            (path / "0" / ".zarray").write_text(json.dumps(text))
        part = data[tuple(int(o) for o in options[1::2])] if options else data
        volume("OME-Zarr", name, path, part, (0.25, 0.5, 2), (10, 20, 30), options=options)
    for name, ids, colors, properties in (("names", (1, 2), [], [{"label-value": 1, "name": "cell"}, {"label-value": 2, "class": "nucleus"}]),
                                          ("colours", (3, 9), [{"label-value": 3, "rgba": [255, 0, 0, 255]}, {"label-value": 9, "rgba": [0, 128, 255, 255]}], []),
                                          ("both", (614454277, 614454278), [{"label-value": 614454278, "rgba": [1, 2, 3]}], [{"label-value": 614454277, "name": "x"}]),
                                          ("64 bits", (720575940621039145, 720575940621039146), [{"label-value": 720575940621039145, "rgba": [9, 9, 9, 255]}], [{"label-value": 720575940621039146, "name": "y"}]),
                                          ("empty", (1, 5), [], [])):
        labels = np.zeros((7, 6, 5), np.uint64)
        labels[:3], labels[4:] = ids
        path = root / "l.zarr"
        made = group(path, None, 2, **{"multiscales": multiscales("zyx", [1, 1, 1]), "image-label": {"version": "0.4", "colors": colors, "properties": properties}})
        array = made.create_array("0", shape=labels.shape, chunks=(4, 4, 4), dtype="<u8", chunk_key_encoding={"name": "v2", "separator": "/"})
        array[:] = labels
        info, found, told = read(path)
        told_segments = {s["value"] for s in info.get("segments", [])} if info else None
        wanted = {one["label-value"] for one in colors + properties}
        scene = run(PROGRAM, "render", path, "--print-scene")
        shown = [one["value"] for one in json.loads(scene.stdout)["volumes"][0].get("labels", [])] if scene.returncode == 0 else scene.stderr
        good = told_segments == wanted and shown == list(ids) and np.array_equal(info["range"], [0, ids[1]])
        count("OME-Zarr labels", name, "" if good else (told, told_segments, shown, info and info["range"]))
    for name, omero in (("windows", [{"label": "DAPI", "color": "0000FF", "window": {"start": 10, "end": 500, "min": 0, "max": 65535}}, {"label": "GFP", "color": "00ff00"}]),):
        path = root / "w.zarr"
        made = group(path, None, 2, multiscales=multiscales("czyx", [1, 1, 1, 1]), omero={"channels": omero})
        array = made.create_array("0", shape=VOXELS[0].shape, chunks=(1, 4, 4, 4), dtype="<u2", chunk_key_encoding={"name": "v2", "separator": "/"})
        array[:] = VOXELS[0]
        info, _, told = read(path)
        channels = info and [(c["name"], c.get("color"), c.get("window")) for c in info["channel_list"]]
        count("OME-Zarr", name, "" if channels == [("DAPI", "#0000ff", [10, 500]), ("GFP", "#00ff00", None)] else (told, channels))


def test_raw_folders():
    for name, kind, order, ending, header in (("bytes", np.uint8, "<", "raw", ""), ("little", np.int16, "<", "raw", ""), ("big", np.uint16, ">", "img", ""), ("floats", np.float32, "<", "raw", ""),
                                              ("doubles big", np.float64, ">", "bin", "")):
        folder = root / f"raw-{name.replace(' ', '-')}"
        folder.mkdir()
        data = (VOXELS[0, 0] // 300).astype(kind)
        for n in range(7):
            (folder / f"slice{n + 8}.{ending}").write_bytes(data[n].astype(data.dtype.newbyteorder(order)).tobytes())
        word = {np.uint8: "uint8", np.int16: "int16", np.uint16: "uint16", np.float32: "float32", np.float64: "float64"}[kind]
        told = run(PROGRAM, "info", folder)
        names = told.stderr
        tried = folder.rename(folder.with_name(f"{folder.name}_5x6_{word}{'_be' if order == '>' else ''}"))
        volume("folders of raw slices", f"{name} (without a kind: {names.strip()[-120:]})", tried, data)


for test in (test_imagej, test_shaped, test_ome, test_zarr, test_raw_folders):
    test()
sys.exit(finish())
