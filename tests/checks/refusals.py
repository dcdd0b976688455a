#!/usr/bin/python3
"""What cannot be read is refused by its right name with what would mend it, and what is passed over is told.

usage: refusals.py PROGRAM SOURCE_FOLDER
The texts of all refusals of readers are looked at, one by one. Files of other formats, by their marks, and files of which a part
is not shown, are written here and given to the program.
"""
import base64
import json
import pathlib
import re
import struct
import subprocess
import sys
import tempfile

PROGRAM, SOURCE = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2])
root = pathlib.Path(tempfile.mkdtemp(prefix="halflight-refusals-"))
problems = []


def check(name, condition, what=""):
    if not condition:
        problems.append(name)
        print(f"{name}: {what}")


# ---- the texts ----

MEND = re.compile(r": (choose|convert|crop|decompress|export|extract|give|install|join|number|pack|raise|reduce|resample|save|shrink|state|take|unpack|write) |"
                  r": (unpack|resample) it")
# Where the text is put together of parts, which hold the mend.
PARTS = {"volume/load.c": "%s: %s", "volume/formats/dicom/header.c": "%s: %s: convert it with gdcmconv or dcm2niix",
         "volume/formats/npy.c": ("save it as", ""), "volume/formats/vtk/vti.c": "an XML file whose first element is", "volume/formats/vtk/vtk_pieces.c": "an XML file whose first element is", "mesh/vtp.c": "an XML file whose first element is",
         "volume/formats/vtk/vtk_xml.c": ("a VTKFile of type", "a DataArray of type", " is not read: save it")}


def call_text(text, start):
    """The strings of the call that the place lies in, from there on."""
    depth, at, strings = 1, start, []
    while depth > 0 and at < len(text) and text[at] != ";":
        if text[at] == '"':
            end = at + 1
            while text[end] != '"':
                end += 2 if text[end] == "\\" else 1
            strings.append(text[at + 1:end])
            at = end
        depth += {"(": 1, ")": -1}.get(text[at], 0)
        at += 1
    return "".join(strings)


def survey():
    count = 0
    for room in ("volume", "mesh"):
        for path in sorted((SOURCE / "src" / room).rglob("*.c")):
            name = str(path.relative_to(SOURCE / "src"))
            source = path.read_text()
            for place in re.finditer("HL_ERROR_UNSUPPORTED", source):
                text = call_text(source, place.start())
                if not text or text[0].islower() and "%" not in text and len(text.split()) < 2:
                    continue  # compared, not refused
                count += 1
                parts = PARTS.get(name, ())
                known = any(text.startswith(part) for part in ((parts,) if isinstance(parts, str) else parts))
                check(f"{name}: a refusal without a mend", known or MEND.search(text + " "), text)
    check("refusals are found", count > 70, count)
    return count


# ---- other formats ----

def run(*words):
    done = subprocess.run([PROGRAM, *map(str, words)], cwd=root, capture_output=True, text=True)
    return done.returncode, done.stdout, done.stderr


FOREIGN = {"a.mnc": (b"\x89HDF\r\n\x1a\n", "HDF5"), "b.mnc": (b"CDF\x01", "NetCDF"), "c.nc": (b"CDF\x02", "NetCDF"), "d.nc": (b"CDF\x05", "NetCDF"),
           "e.zst": (b"\x28\xb5\x2f\xfd", "zstd"), "f.7z": (b"7z\xbc\xaf\x27\x1c", "7-Zip"), "g.rar": (b"Rar!\x1a\x07\x01\0", "RAR"),
           "h.tar": (b"a.nrrd".ljust(257, b"\0") + b"ustar\0", "tar archive"), "i.czi": (b"ZISRAWFILE", "CZI"), "j.nd2": (b"\xda\xce\xbe\x0a", "ND2"),
           "k.lif": (b"p\0\0\0\x10\0\0\0\x2a", "LIF"), "l.oib": (b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1", "compound file"),
           "m.am": (b"# AmiraMesh BINARY-LITTLE-ENDIAN 2.1\n", "Amira"), "n.am": (b"# Avizo BINARY", "Avizo"), "o.fits": (b"SIMPLE  =  T", "FITS"),
           "p.mat": (b"MATLAB 5.0 MAT-file", "MATLAB"), "q.v": (b"MATRIX72v\0", "ECAT"), "r.PAR": (b"# === DATA DESCRIPTION FILE ===", "PAR file"),
           "s.pvm": (b"PVM3\n", "PVM"), "t.pvm": (b"DDS v3d\n", "PVM"), "v.jpg": (b"\xff\xd8\xff\xe0", "JPEG picture"),
           "w.foam": (b"", "OpenFOAM"), "x.case": (b"FORMAT\ntype: ensight gold\n", "EnSight"), "y.ex2": (b"CDF\x01", "Exodus"),
           "DD0010": (b"InitialCycleNumber  = 10\n", "Enzo")}


def foreign():
    for name, (begin, title) in FOREIGN.items():
        (root / name).write_bytes(begin.ljust(600, b"\0") if begin else b"")
        code, out, said = run("info", name)
        check(f"{name} is refused by its name", code == 4, (code, said))
        if title in ("HDF5", "NetCDF"):
            check(f"{name}: Python's way", {"HDF5": "h5py.File(path)", "NetCDF": "xarray.open_dataset(path)"}[title] in said, said)
        check(f"{name}: the words", said.count("\n") == 1 and title in said and re.search(r": [a-z].*(convert|export|save|unpack|decompress|give|write)", said), said)


# ---- what is passed over ----

def passed():
    (root / "m.mtl").write_text("newmtl a\nKd 1 0 0\nmap_Kd a.png\n")
    (root / "m.obj").write_text("mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n")
    code, _, said = run("render", "m.obj", "--size", "16x16", "-o", "m.png")
    check("textures of OBJ are told", code == 0 and "m.obj: its textures (map_Kd) are not shown" in said, said)
    points = base64.b64encode(struct.pack("<9f", 0, 0, 0, 1, 0, 0, 0, 1, 0)).decode()
    gltf = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}], "buffers": [{"byteLength": 36, "uri": "data:application/octet-stream;base64," + points}],
            "bufferViews": [{"buffer": 0, "byteLength": 36}], "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}]}
    for keys, words in (({"textures": [{}]}, "its textures are not shown"), ({"animations": [{}]}, "it is shown at rest"), ({"skins": [{}]}, "it is shown at rest"), ({}, "")):
        (root / "m.gltf").write_text(json.dumps({**gltf, **keys}))
        code, _, said = run("render", "m.gltf", "--size", "16x16", "-o", "m.png")
        check(f"glTF {keys}", code == 0 and (words in said if words else "not" not in said), said)
    image = ('<VTKFile type="ImageData"><ImageData WholeExtent="0 1 0 1 0 1" Spacing="1 1 1" Origin="0 0 0"><Piece Extent="0 1 0 1 0 1"><PointData>'
             '<DataArray type="String" Name="words" format="ascii">97 0</DataArray><DataArray type="UInt8" Name="a" format="ascii">1 2 3 4 5 6 7 8</DataArray>'
             "</PointData></Piece></ImageData></VTKFile>")
    (root / "a.vti").write_text(image)
    code, out, said = run("info", "a.vti")
    check("an array that cannot be read is listed as such", code == 0 and "words (not read)" in said and "not read" in out, (out, said))
    folder = root / "two.zarr"
    (folder / "0").mkdir(parents=True)
    axes = [{"name": name, "type": "space"} for name in "zyx"]
    multiscale = {"version": "0.4", "axes": axes, "datasets": [{"path": "0", "coordinateTransformations": [{"type": "scale", "scale": [1, 1, 1]}]}]}
    (folder / ".zattrs").write_text(json.dumps({"multiscales": [multiscale, multiscale]}))
    (folder / "0/.zarray").write_text(json.dumps({"zarr_format": 2, "shape": [2, 2, 2], "chunks": [2, 2, 2], "dtype": "|u1", "compressor": None, "fill_value": 0,
                                                  "order": "C", "filters": None}))
    (folder / "0/0.0.0").write_bytes(bytes(range(8)))
    code, _, said = run("info", "two.zarr")
    check("a second multiscale image is told", code == 0 and "describes 2 images: the first is taken" in said, said)


print(f"{survey()} refusals")
foreign()
passed()
sys.exit(1 if problems else 0)
