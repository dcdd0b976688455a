#!/usr/bin/python3
"""Variants of NRRD, MetaImage, NIfTI, ANALYZE, MGH and VTK files, written here, and what must be read from them.

usage: volume_kinds.py DUMP_VOLUME HALFLIGHT
VTK writes its XML files, where it is installed. Exit 77: numpy is missing.
"""
import bz2
import gzip
import json
import lzma
import pathlib
import shutil
import struct
import subprocess
import sys
import tempfile
import zlib

try:
    import numpy as np
except ImportError as absent:
    print("skipped:", absent)
    sys.exit(77)

DUMP, PROGRAM = sys.argv[1:3]
root = pathlib.Path(tempfile.mkdtemp(prefix="halflight-kinds-"))
problems = []
VOXELS = np.random.RandomState(1).randint(-900, 900, (7, 6, 5)).astype("<i2")


def check(name, condition, what=""):
    print("ok" if condition else "not ok", "-", name, "" if condition else f": {what}")
    if not condition:
        problems.append(name)


def read(path, choice=""):
    told = subprocess.run([PROGRAM, "info", "--json", str(path)], capture_output=True, text=True, timeout=60)
    if told.returncode != 0:
        return None, None, told.stderr
    out = root / "voxels"
    subprocess.run([DUMP, f"{path}{choice}", str(out)], check=True, capture_output=True)
    info = json.loads(told.stdout)
    return info, np.fromfile(out).reshape(info["dimensions"][::-1]), told.stderr


def expect(name, path, voxels, spacing=(1, 1, 1), origin=None, axes=None, told="", choice="", tolerance=0):
    info, found, said = read(path, choice)
    good = info is not None and found.shape == voxels.shape and np.allclose(found, voxels, rtol=0, atol=tolerance)
    check(name, good, said if info is None else (found.shape, voxels.shape))
    if info is None:
        return None
    step = np.array(info["direction"]) * info["spacing"]
    check(f"{name}: its place", (spacing is None or np.allclose(info["spacing"], spacing)) and (origin is None or np.allclose(info["origin"], origin)) and
          (axes is None or np.allclose(step, axes)), (info["spacing"], info["origin"], step.tolist()))
    check(f"{name}: what is told", (told in said) if told else said == "", said)
    return info


def write(name, content):
    path = root / name
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    return path


HEAD = "NRRD0004\ntype: short\ndimension: 3\nsizes: 5 6 7\nendian: little\n"


def test_nrrd():
    raw = VOXELS.tobytes()
    for encoding, pack in (("bzip2", bz2.compress), ("bz2", bz2.compress), ("gzip", gzip.compress)):
        expect(f"encoding {encoding}", write("a.nrrd", HEAD.encode() + f"encoding: {encoding}\n\n".encode() + pack(raw)), VOXELS)
        packed = write("a.pack", pack(b"before" * 99 + raw))
        expect(f"the last bytes of {encoding}", write("a.nhdr", HEAD + f"encoding: {encoding}\nbyte skip: -1\ndata file: {packed.name}\n"), VOXELS)
    expect("the last bytes in an attached file", write("a.nrrd", HEAD.encode() + b"encoding: gzip\nbyte skip: -1\n\n" + gzip.compress(b"xyz" + raw)), VOXELS)
    for n in range(7):
        write(f"slices/s{n:03}.raw", VOXELS[n].tobytes())
        write(f"slices/t{2 * n}.raw", b"head" + VOXELS[n].tobytes())
        write(f"slices/u {n}.gz", gzip.compress(VOXELS[n].tobytes()))
    expect("a pattern", write("a.nhdr", HEAD + "encoding: raw\ndata file: slices/s%03d.raw 0 6 1\n"), VOXELS)
    expect("a pattern backwards", write("a.nhdr", HEAD + "encoding: raw\ndata file: slices/s%03d.raw 6 0 -1\n"), VOXELS[::-1])
    expect("a pattern by steps, with a skip", write("a.nhdr", HEAD + "encoding: raw\nbyte skip: 4\ndata file: slices/t%d.raw 0 12 2 2\n"), VOXELS)
    names = "\n".join(f"slices/s{n:03}.raw" for n in range(7))
    expect("a list", write("a.nhdr", HEAD + f"encoding: raw\ndata file: LIST\n{names}\n"), VOXELS)
    expect("a list of slices of two dimensions", write("a.nhdr", HEAD + f"encoding: raw\ndata file: LIST 2\n{names}"), VOXELS)
    expect("a list of packed slices", write("a.nhdr", HEAD + "encoding: gzip\ndata file: LIST\n" + "\n".join(f"slices/u {n}.gz" for n in range(7))), VOXELS)
    expect("the last bytes of each", write("a.nhdr", HEAD + "encoding: raw\nbyte skip: -1\ndata file: slices/t%d.raw 0 12 2\n"), VOXELS)
    _, _, told = read(write("a.nhdr", HEAD + "encoding: raw\ndata file: slices/s%03d.raw 0 7 1\n"))
    check("one too many", told.count("\n") == 1, told)
    _, _, told = read(write("a.nhdr", HEAD + f"encoding: raw\ndata file: LIST\n{names.replace('s004', 'missing')}\n"))
    check("one that is missing", told.count("\n") == 1 and "missing.raw" in told, told)
    four = "NRRD0004\ntype: short\ndimension: 4\nspace dimension: 4\nsizes: 5 6 7 2\nspace directions: (1,0,0,0) (0,2,0,0) (0,0,3,0) (0,0,0,4)\n" \
           "kinds: domain domain domain domain\nendian: little\nencoding: raw\nspace origin: (1,2,3,9)\n\n"
    info = expect("four dimensions of space", write("a.nrrd", four.encode() + raw + (VOXELS + 1).tobytes()), VOXELS, (1, 2, 3), (1, 2, 3), told="a series of volumes")
    check("are times", info and info["times"] == 2, info)
    for none in ("none", "(nan,nan,nan)", "(NaN, NaN, NaN)"):
        vector = f"NRRD0004\ntype: short\ndimension: 4\nspace: RAS\nsizes: 2 5 6 7\nspace directions: {none} (.75,0,0) (0,.5,0) (0,0,2)\n" \
                 "kinds: vector domain domain domain\nendian: little\nencoding: raw\n\n"
        pair = np.stack([VOXELS, 2 * VOXELS], -1).astype("<i2")
        expect(f"a direction {none}", write("a.nrrd", vector.encode() + pair.tobytes()), 2.0 * VOXELS, (.75, .5, 2), choice="#-1,-1,-1,1", told="magnitude")
    seg = HEAD.replace("short", "uint") + "encoding: raw\nSegment0_Name:=hippocampus\nSegment0_LabelValue:=614454277\n\n"
    expect("a segment of a great number", write("a.seg.nrrd", seg.encode() + np.full((7, 6, 5), 614454277, "<u4").tobytes()), np.full((7, 6, 5), 614454277.0))


def test_packed():
    raw = VOXELS.tobytes()
    nrrd = HEAD.encode() + b"encoding: raw\n\n" + raw
    for ending, pack in (("bz2", bz2.compress), ("xz", lzma.compress), ("gz", gzip.compress)):
        expect(f"a whole file by {ending}", write(f"a.nrrd.{ending}", pack(nrrd)), VOXELS)
        half = len(nrrd) // 2
        expect(f"in two parts by {ending}", write(f"a.nrrd.{ending}", pack(nrrd[:half]) + pack(nrrd[half:])), VOXELS)
        for cut in (8, 10, 12, 20, len(pack(nrrd)) // 2):
            _, _, told = read(write("cut.nrrd." + ending, pack(nrrd)[:cut]))
            check(f"cut by {ending} at {cut}", told.count("\n") == 1 and ("cut short" in told or "at most" in told), told)
    mrc = struct.pack("<10i", 5, 6, 7, 1, 0, 0, 0, 5, 6, 7) + struct.pack("<6f", 5, 6, 7, 90, 90, 90) + struct.pack("<3i", 1, 2, 3)
    mrc = mrc.ljust(208, b"\0") + b"MAP \x44\x44\0\0"
    expect("MRC by bzip2", write("a.mrc.bz2", bz2.compress(mrc.ljust(1024, b"\0") + raw)), VOXELS)


def test_metaimage():
    head = "ObjectType = Image\nNDims = 3\nDimSize = 5 6 7\nElementSpacing = 1 2 3\nElementType = MET_SHORT\n"
    for n in range(7):
        write(f"slices/s{n:03}.raw", VOXELS[n].tobytes())
        write(f"slices/z{n}.zraw", zlib.compress(VOXELS[n].tobytes()))
        write(f"slices/h{n}.raw", b"head" + VOXELS[n].tobytes())
    names = "\n".join(f"slices/s{n:03}.raw" for n in range(7))
    for word in ("LIST", "LIST 2D", "LIST 2"):
        expect(f"ElementDataFile = {word}", write("a.mhd", head + f"ElementDataFile = {word}\n{names}\n"), VOXELS, (1, 2, 3))
    expect("a pattern", write("a.mhd", head + "ElementDataFile = slices/s%03d.raw 0 6 1\n"), VOXELS, (1, 2, 3))
    expect("packed files", write("a.mhd", head + "CompressedData = True\nElementDataFile = slices/z%d.zraw 0 6 1\n"), VOXELS, (1, 2, 3))
    expect("a header of each", write("a.mhd", head + "HeaderSize = 4\nElementDataFile = slices/h%d.raw 0 6 1\n"), VOXELS, (1, 2, 3))
    expect("the last bytes of each", write("a.mhd", head + "HeaderSize = -1\nElementDataFile = slices/h%d.raw 0 6 1\n"), VOXELS, (1, 2, 3))


def nifti(dim, magic=b"n+1\0", order="<", origin=(0, 0, 0), slope=0.0, offset=352.0):
    header = bytearray(348)
    struct.pack_into(order + "i", header, 0, 348)
    struct.pack_into(order + "8h", header, 40, *dim)
    struct.pack_into(order + "2h", header, 70, 4, 16)
    struct.pack_into(order + "8f", header, 76, 1, 2, 3, 4, 1, 1, 1, 1)
    struct.pack_into(order + "2f", header, 108, offset, slope)
    struct.pack_into(order + "3h", header, 253, *origin)
    header[344:348] = magic
    return bytes(header)


def test_nifti():
    raw = VOXELS.tobytes()
    for dim in ((4, 5, 6, 7, 0, 0, 0, 0), (4, 5, 6, 7, -1, 1, 1, 1), (7, 5, 6, 7, 1, 0, 0, 0)):
        expect(f"dim {dim}", write("a.nii", nifti(dim) + b"\0" * 4 + raw), VOXELS, (2, 3, 4), told=": 1 is taken")
    for order in "<>":
        pixels = VOXELS.astype(order + "i2").tobytes()
        write("b.img", pixels)
        for origin, used in (((0, 0, 0), None), ((2, 3, 4), (2, 3, 4)), ((500, 1, 1), None), ((-1, 3, 4), (-1, 3, 4))):
            path = write("b.hdr", nifti((4, 5, 6, 7, 1, 0, 0, 0)[:4] + (1, 1, 1, 1), b"\0" * 4, order, origin, offset=0.0))
            index = np.array(used) - 1 if used else (np.array([5, 6, 7]) - 1) / 2
            axes = np.diag([-2.0, 3, 4])
            for name in ("b.hdr", "b.img"):
                expect(f"ANALYZE {order} {origin}, {name}", path.with_name(name), VOXELS, (2, 3, 4), -axes @ index, axes, "an ANALYZE header")
    mat = np.array([[0, -3, 0, 50], [2, 0, 0, -60], [0, 0, 4, 70], [0, 0, 0, 1.0]])
    place = dict(spacing=(2, 3, 4), axes=mat[:3, :3], origin=mat[:3, :4].sum(1))
    for order in "<>":
        level_4 = lambda name, matrix: struct.pack(order + "5i", 1000 * (order == ">"), *matrix.shape, 0, len(name) + 1) + name.encode() + b"\0" + \
            matrix.T.astype(order + "f8").tobytes()  # noqa: E731
        older = level_4("M", np.diag([-1, 1, 1, 1]) @ mat)
        for name, content in (("M", older), ("mat", level_4("mat", mat)), ("both", level_4("M", mat * 7) + level_4("mat", mat)), ("another before", level_4("x", np.zeros((3, 5))) + older)):
            write("b.mat", content)
            write("b.hdr", nifti((4, 5, 6, 7, 1, 1, 1, 1), b"\0" * 4, ">", offset=0.0))
            expect(f"SPM's .mat, {name}, {order}", root / "b.hdr", VOXELS, **place, told="SPM's .mat file beside it does")
        for length in range(0, len(older), 3):
            write("b.mat", older[:length])
            expect(f"SPM's .mat cut at {length}", root / "b.hdr", VOXELS, (2, 3, 4), told="is not read")
    write("b.mat", b"MATLAB 5.0 MAT-file, Platform: GLNXA64".ljust(200))
    expect("a newer .mat", root / "b.hdr", VOXELS, (2, 3, 4), told="save -v4")
    (root / "b.mat").unlink()
    write("b.hdr", nifti((4, 5, 6, 7, 1, 1, 1, 1), b"\0" * 4, ">", slope=0.5, offset=0.0))
    expect("SPM's scale", root / "b.hdr", VOXELS * 0.5, (2, 3, 4), told="an ANALYZE header")


def test_mgh():
    def mgh(voxels, code, frames=1, good=1):
        axes = np.array([[-1, 0, 0], [0, 0, 1], [0, -1, 0]], float)  # columns: directions of i, j, k
        head = struct.pack(">7ih", 1, 5, 6, 7, frames, code, 0, good) + struct.pack(">3f", 2, 3, 4)
        head += struct.pack(">9f", *axes.T.ravel()) + struct.pack(">3f", 10, 20, 30)
        return head.ljust(284, b"\0") + voxels.astype(voxels.dtype.newbyteorder(">")).tobytes(), axes

    for code, kind in ((0, "u1"), (1, "i4"), (3, "f4"), (4, "i2")):
        voxels = (VOXELS % 200).astype(kind)
        content, axes = mgh(voxels, code)
        steps = axes * [2, 3, 4]
        origin = np.array([10, 20, 30]) - steps @ (np.array([5, 6, 7]) / 2)
        for name, data in (("a.mgh", content), ("a.mgz", gzip.compress(content)), ("tail.mgh", content + b"\0" * 20)):
            info = expect(f"type {code}, {name}", write(name, data), voxels.astype(float), (2, 3, 4), origin, steps)
            check("its space", info and info["space"] == "RAS" and info["unit"] == "millimetre", info)
    content, _ = mgh(np.stack([VOXELS, VOXELS + 1]), 4, frames=2)
    info = expect("frames", write("a.mgh", content), VOXELS + 1.0, (2, 3, 4), choice="#1,-1,-1,-1", told="a series of volumes")
    check("are times", info and info["times"] == 2, info)
    content, _ = mgh(VOXELS, 4, good=0)
    expect("no place", write("a.mgh", content), VOXELS, (1, 1, 1), (2.5, -3.5, 3), [[-1, 0, 0], [0, 0, 1], [0, -1, 0]])


def legacy(data, binary=False, geometry=None):
    geometry = geometry or b"DATASET STRUCTURED_POINTS\nDIMENSIONS 5 6 7\nSPACING 0.5 1 2\nORIGIN 1 2 3\n"
    return b"# vtk DataFile Version 5.1\nx\n" + (b"BINARY\n" if binary else b"ASCII\n") + geometry + data


def test_legacy():
    numbers = (" ".join(map(str, VOXELS.ravel())) + "\n").encode()
    big = VOXELS.astype(">i2").tobytes() + b"\n"
    place = dict(spacing=(.5, 1, 2), origin=(1, 2, 3))
    for binary, values in ((False, numbers), (True, big)):
        text = b"FIELD FieldData 1\nname 1 2 string\nhalf%20light\n\n" if not binary else \
            b"FIELD FieldData 1\nname 1 2 string\n" + bytes([0xc0 | 4]) + b"half" + struct.pack(">H", 0x8000 | 70) + b"x" * 70 + b"\n"
        field = b"FIELD FieldData 1\nGID 1 210 short\n" + values
        expect(f"texts before, {binary}", write("a.vtk", legacy(text + b"POINT_DATA 210\nSCALARS s short\nLOOKUP_TABLE default\n" + values, binary)), VOXELS, **place)
        empty = b"FIELD FieldData 2\nnothing 1 0 float\n\nGID 1 210 short\n" + values
        expect(f"an array without values, {binary}", write("a.vtk", legacy(b"POINT_DATA 210\n" + empty, binary)), VOXELS, **place)
        expect(f"a FIELD alone, {binary}", write("a.vtk", legacy(b"POINT_DATA 210\n" + field, binary)), VOXELS, **place)
        expect(f"a FIELD of the file, {binary}", write("a.vtk", legacy(field, binary)), VOXELS, **place)
        cells = b"DATASET STRUCTURED_POINTS\nDIMENSIONS 6 7 8\nSPACING 0.5 1 2\nORIGIN 1 2 3\n"
        for part in (b"SCALARS s short\nLOOKUP_TABLE default\n" + values, field):
            expect(f"cells, {binary}", write("a.vtk", legacy(b"CELL_DATA 210\n" + part, binary, cells)), VOXELS, (.5, 1, 2), (1.25, 2.5, 4))
    coordinates = lambda letter, numbers: f"{letter}_COORDINATES {len(numbers)} float\n{' '.join(map(str, numbers))}\n"  # noqa: E731
    even = ("DATASET RECTILINEAR_GRID\nDIMENSIONS 5 6 7\n" + coordinates("X", range(5)) + coordinates("Y", [2 * n for n in range(6)]) +
            coordinates("Z", [10 - n for n in range(7)])).encode()
    scalars = b"POINT_DATA 210\nSCALARS s short\nLOOKUP_TABLE default\n" + numbers
    expect("an even rectilinear grid", write("a.vtk", legacy(scalars, geometry=even)), VOXELS, (1, 2, 1), (0, 0, 10), np.diag([1, 2, -1]))
    z = [0, 1, 2, 3, 5, 7, 8]
    uneven = ("DATASET RECTILINEAR_GRID\nDIMENSIONS 5 6 7\n" + coordinates("X", range(5)) + coordinates("Y", range(6)) + coordinates("Z", z)).encode()
    wanted = np.stack([np.interp(np.arange(9), z, VOXELS[:, j, i].astype(float)) for j in range(6) for i in range(5)], -1).reshape(9, 6, 5)
    expect("an uneven one is resampled", write("a.vtk", legacy(scalars, geometry=uneven)), wanted, told="resampled to 5 x 6 x 9 even ones", tolerance=1e-4)
    uneven = uneven.replace(b"DIMENSIONS 5 6 7", b"DIMENSIONS 6 7 7").replace(coordinates("X", range(5)).encode(), coordinates("X", range(6)).encode()) \
        .replace(coordinates("Y", range(6)).encode(), coordinates("Y", range(7)).encode())
    cells = b"CELL_DATA 180\nSCALARS s short\nLOOKUP_TABLE default\n" + " ".join(map(str, VOXELS[:6].ravel())).encode()
    expect("cells keep their values", write("a.vtk", legacy(cells, geometry=uneven)), VOXELS[[0, 1, 2, 3, 3, 4, 4, 5]].astype(float), told="resampled")


def test_vtk():
    try:
        import vtk
    except ImportError:
        print("skipped: VTK is not installed")
        return
    from vtk.util.numpy_support import numpy_to_vtk
    vtk.vtkObject.GlobalWarningDisplayOff()

    def image_of(voxels, cells=False):
        image = vtk.vtkImageData()
        k, j, i = voxels.shape
        image.SetDimensions(i + cells, j + cells, k + cells)
        image.SetSpacing(0.5, 1, 2)
        image.SetOrigin(1, 2, 3)
        array = numpy_to_vtk(voxels.ravel().astype("i2"), deep=True)
        array.SetName("GID")
        (image.GetCellData() if cells else image.GetPointData()).SetScalars(array)
        return image

    def save(writer, data, name, mode, compressor="ZLib", pieces=1):
        writer.SetInputData(data)
        writer.SetFileName(str(root / name))
        (writer.SetDataModeToAscii, writer.SetDataModeToBinary, writer.SetDataModeToAppended)[mode]()
        {"None": writer.SetCompressorTypeToNone, "ZLib": writer.SetCompressorTypeToZLib, "LZ4": writer.SetCompressorTypeToLZ4,
         "LZMA": writer.SetCompressorTypeToLZMA}[compressor]()
        writer.SetBlockSize(1 << 15)
        if pieces > 1:
            writer.SetNumberOfPieces(pieces)
        writer.Write()
        return root / name

    large = np.random.RandomState(2).randint(-999, 999, (40, 30, 50)).astype("i2")
    for mode in range(3):
        for compressor in ("None", "ZLib", "LZ4", "LZMA"):
            for voxels in (VOXELS, large):
                expect(f"image data, mode {mode}, {compressor}, {voxels.shape}",
                       save(vtk.vtkXMLImageDataWriter(), image_of(voxels), "a.vti", mode, compressor), voxels.astype(float), (.5, 1, 2), (1, 2, 3))
        for pieces in (2, 5):
            for cells in (False, True):
                path = save(vtk.vtkXMLPImageDataWriter(), image_of(large, cells), f"p{mode}{pieces}.pvti", mode, pieces=1)
                path.unlink()
                writer = vtk.vtkXMLPImageDataWriter()
                writer.SetNumberOfPieces(pieces)
                writer.SetStartPiece(0)
                writer.SetEndPiece(pieces - 1)
                path = save(writer, image_of(large, cells), f"p{mode}{pieces}.pvti", mode)
                where = (1.25, 2.5, 4) if cells else (1, 2, 3)
                expect(f"{pieces} files, mode {mode}, {cells}", path, large.astype(float), (.5, 1, 2), where)
                if pieces == 5:
                    next(root.glob(f"p{mode}5*_3.vti"), path).unlink()
                    _, _, told = read(path)
                    check("a file is missing", told.count("\n") == 1, told)
    header = '<VTKFile type="ImageData" byte_order="LittleEndian"><ImageData WholeExtent="2 6 0 5 0 6" Origin="0 0 0" Spacing="1 1 1">'
    pieces = ""
    for low, high in ((2, 4), (4, 6)):
        part = VOXELS[:, :, low - 2:high - 1].ravel()
        pieces += f'<Piece Extent="{low} {high} 0 5 0 6"><PointData Scalars="GID"><DataArray type="Int16" Name="GID" format="ascii">' \
                  f'{" ".join(map(str, part))}</DataArray></PointData></Piece>'
    expect("two pieces in a file", write("two.vti", header + pieces + "</ImageData></VTKFile>"), VOXELS, origin=(2, 0, 0))
    beyond = pieces.replace('"4 6 0', '"5 7 0')
    _, _, told = read(write("two.vti", header + beyond + "</ImageData></VTKFile>"))
    check("a piece beyond the whole", told.count("\n") == 1 and "beyond the whole" in told, told)
    for uneven in (False, True):
        grid = vtk.vtkRectilinearGrid()
        grid.SetDimensions(5, 6, 7)
        z = np.array([0, 1, 2, 3, 5, 7, 8.0]) if uneven else 2 * np.arange(7.0)
        for put, numbers in ((grid.SetXCoordinates, 1 + 0.5 * np.arange(5)), (grid.SetYCoordinates, np.arange(6.0)), (grid.SetZCoordinates, z)):
            put(numpy_to_vtk(numbers, deep=True))
        array = numpy_to_vtk(VOXELS.ravel().astype("i2"), deep=True)
        array.SetName("GID")
        grid.GetPointData().SetScalars(array)
        for mode in range(3):
            path = save(vtk.vtkXMLRectilinearGridWriter(), grid, "a.vtr", mode)
            if uneven:
                wanted = np.stack([np.interp(np.arange(9), z, VOXELS[:, j, i].astype(float)) for j in range(6) for i in range(5)], -1).reshape(9, 6, 5)
                expect(f"an uneven .vtr, mode {mode}", path, wanted, (.5, 1, 1), (1, 0, 0), told="resampled", tolerance=1e-4)
            else:
                expect(f"an even .vtr, mode {mode}", path, VOXELS, (.5, 1, 2), (1, 0, 0))
    image = image_of(VOXELS)
    ghosts = numpy_to_vtk(np.zeros(210, "u1"), deep=True)
    ghosts.SetName("vtkGhostType")
    other = vtk.vtkImageData()
    other.CopyStructure(image)
    other.GetPointData().AddArray(ghosts)
    other.GetPointData().AddArray(image.GetPointData().GetScalars())
    expect("ghosts are passed over", save(vtk.vtkXMLImageDataWriter(), other, "g.vti", 0), VOXELS, (.5, 1, 2), (1, 2, 3), told="GID is taken")


try:
    for test in (test_nrrd, test_packed, test_metaimage, test_nifti, test_mgh, test_legacy, test_vtk):
        test()
finally:
    shutil.rmtree(root, ignore_errors=True)
print(f"{len(problems)} problems")
sys.exit(1 if problems else 0)
