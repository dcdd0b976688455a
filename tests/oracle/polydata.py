#!/usr/bin/python3
"""PolyData as Halflight reads them beside VTK's own readers, in every encoding that VTK writes.

usage: polydata.py DUMP_MESH
Exit 77: VTK is missing.
"""
import pathlib
import re
import subprocess
import sys
import tempfile

try:
    import numpy as np
    import vtk
    from vtk.util.numpy_support import numpy_to_vtk, vtk_to_numpy
except ImportError as absent:
    print("skipped:", absent)
    sys.exit(77)

DUMP = sys.argv[1]
problems = []
root = pathlib.Path(tempfile.mkdtemp(prefix="halflight-polydata-"))
random = np.random.default_rng(7)
VIRIDIS = {0: (0x44, 0x01, 0x54), 1: (0xfd, 0xe7, 0x25)}


def check(name, condition, what=""):
    print("ok" if condition else "not ok", "-", name, "" if condition else f": {what}")
    if not condition:
        problems.append(name)


def linear(srgb):
    srgb = np.asarray(srgb) / 255
    return np.where(srgb <= 0.04045, srgb / 12.92, ((srgb + 0.055) / 1.055) ** 2.4)


def cells(lists):
    made = vtk.vtkCellArray()
    for points in lists:
        made.InsertNextCell(len(points), points)
    return made


def array(name, values, kind=None):
    made = numpy_to_vtk(np.ascontiguousarray(values), deep=True, array_type=kind)
    made.SetName(name)
    return made


def make(colors, place, kinds="vlps", doubles=False):
    """A grid of 20 points with cells of every kind wanted. colors: None, "rgb", "rgba" or "scalars"; place: points or cells."""
    data = vtk.vtkPolyData()
    points = vtk.vtkPoints()
    if doubles:
        points.SetDataTypeToDouble()
    for n in range(20):
        points.InsertNextPoint(n % 5 + 0.25 * random.random(), n // 5, random.random())
    data.SetPoints(points)
    count = 0
    for letter, lists, put in (("v", [[0], [3, 4]], data.SetVerts), ("l", [[0, 1, 2], [10, 15]], data.SetLines),
                               ("p", [[0, 1, 6], [1, 2, 7, 6], [2, 3, 4, 9, 8]], data.SetPolys),
                               ("s", [[10, 15, 11, 16, 12, 17], [13, 18, 14]], data.SetStrips)):
        if letter in kinds:
            put(cells(lists))
            count += len(lists)
    target, size = (data.GetPointData(), 20) if place == "points" else (data.GetCellData(), count)
    if colors in ("rgb", "rgba"):
        target.SetScalars(array("shade", random.integers(0, 256, (size, len(colors)), dtype=np.uint8)))
    if colors == "scalars":
        target.SetScalars(array("heat", random.permutation(size).astype(np.float32)))
    data.GetPointData().AddArray(array("velocity", random.random((20, 3)).astype(np.float32)))
    data.GetPointData().AddArray(array("radius", 0.05 + 0.01 * np.arange(20)))
    data.GetPointData().SetNormals(array("Normals", np.tile(np.float32([0, 0.6, 0.8]), (20, 1))))
    return data


def ours(path):
    done = subprocess.run([DUMP, str(path)], capture_output=True, text=True, timeout=60)
    if done.returncode != 0:
        return done.stderr.strip()
    return {letter: [line.split()[1:] for line in done.stdout.splitlines() if line[0] == letter] for letter in "vts"}


def lists_of(cells):
    """The cells' points, as VTK's reader gives them."""
    ids = vtk.vtkIdList()
    cells.InitTraversal()
    while cells.GetNextCell(ids):
        yield [ids.GetId(n) for n in range(ids.GetNumberOfIds())]


def expected_colors(data):
    """Linear colours, of points or of cells, and which of them."""
    for place, attributes in (("points", data.GetPointData()), ("cells", data.GetCellData())):
        scalars = attributes.GetScalars()
        if scalars is not None:
            values = vtk_to_numpy(scalars)
            return place, values, scalars.GetNumberOfComponents()
    return None, None, 0


def same_color(found, values, components, n):
    """A colour of the dump beside VTK's value: bytes exactly, scalars at the ends of the colormap and in their order."""
    if values is None:
        return found == ["-"]
    found = np.float64(found)
    if components > 1:
        return np.allclose(found[:3], linear(values[n][:3]), atol=1e-6) and \
            np.isclose(found[3], values[n][3] / 255 if components == 4 else 1)
    for end, at in ((0, values.min()), (1, values.max())):
        if values[n] == at and not np.allclose(found[:3], linear(VIRIDIS[end]), atol=2e-3):
            return False
    return 0 <= found[:3].min() and found[:3].max() <= 1 and found[3] == 1


def compare(name, path, data):
    """data: as VTK's reader read the file."""
    found = ours(path)
    if isinstance(found, str):
        return check(name, False, found)
    points = vtk_to_numpy(data.GetPoints().GetData()).astype(np.float32)
    place, values, components = expected_colors(data)
    triangles, cell = [], 0
    sphere = 0
    for points_of in lists_of(data.GetVerts()):
        for point in points_of:
            row = found["s"][sphere]
            radius = data.GetPointData().GetArray("radius").GetValue(point)
            if not np.allclose(np.float32(row[:4]), [*points[point], radius]) or \
               not same_color(row[4:], values, components, point if place == "points" else cell):
                return check(name, False, f"sphere {sphere}: {row}")
            sphere += 1
        cell += 1
    cell += data.GetNumberOfLines()
    for points_of in lists_of(data.GetPolys()):
        triangles += [(points_of[0], points_of[n - 1], points_of[n], cell) for n in range(2, len(points_of))]
        cell += 1
    for points_of in lists_of(data.GetStrips()):
        for n in range(2, len(points_of)):
            a, b = (n - 1, n - 2) if n % 2 else (n - 2, n - 1)
            triangles.append((points_of[a], points_of[b], points_of[n], cell))
        cell += 1
    if data.GetNumberOfLines() == 0 and len(found["t"]) != len(triangles) or len(found["t"]) < len(triangles):
        return check(name, False, f"{len(found['t'])} triangles")
    for row, (a, b, c, cell) in zip(found["t"], triangles):
        if [int(n) for n in row[:3]] != [a, b, c] or place == "cells" and not same_color(row[3:], values, components, cell):
            return check(name, False, f"triangle {row} beside {a, b, c}")
    if triangles:
        for n, row in enumerate(found["v"][:len(points)]):
            if not np.array_equal(np.float32(row[:3]), points[n]) or not np.allclose(np.float64(row[3:6]), [0, 0.6, 0.8]) or \
               place == "points" and not same_color(row[6:], values, components, n):
                return check(name, False, f"vertex {n}: {row}")
    check(name, True)


def tubes(name, path, data):
    """Tubes stay as far from the lines' ends as their radii say: their box is that of the points, widened."""
    found = ours(path)
    if isinstance(found, str):
        return check(name, False, found)
    at = np.float64([row[:3] for row in found["v"]])
    points = vtk_to_numpy(data.GetPoints().GetData())
    radius = vtk_to_numpy(data.GetPointData().GetArray("radius"))
    used = [point for line in lists_of(data.GetLines()) for point in line]
    low, high = (points[used] - radius[used, None]).min(axis=0), (points[used] + radius[used, None]).max(axis=0)
    check(name, (at.min(axis=0) >= low - 1e-5).all() and (at.max(axis=0) <= high + 1e-5).all() and
          (at.max(axis=0) - at.min(axis=0) > 0.9 * (high - low)).all(), f"{at.min(axis=0)} {at.max(axis=0)}, {low} {high}")


def write_xml(data, path, mode, compressor, big, header):
    writer = vtk.vtkXMLPolyDataWriter()
    writer.SetInputData(data)
    writer.SetFileName(str(path))
    {"ascii": writer.SetDataModeToAscii, "binary": writer.SetDataModeToBinary}.get(mode, writer.SetDataModeToAppended)()
    writer.SetEncodeAppendedData(mode != "raw")
    {"none": writer.SetCompressorTypeToNone, "zlib": writer.SetCompressorTypeToZLib}[compressor]()
    (writer.SetByteOrderToBigEndian if big else writer.SetByteOrderToLittleEndian)()
    (writer.SetHeaderTypeToUInt64 if header == 64 else writer.SetHeaderTypeToUInt32)()
    writer.Write()
    reader = vtk.vtkXMLPolyDataReader()
    reader.SetFileName(str(path))
    reader.Update()
    return reader.GetOutput()


def write_pieces(parts, path):
    """One file whose pieces are those of several."""
    texts = []
    for part in parts:
        write_xml(part, path, "ascii", "none", False, 32)
        texts.append(path.read_text())
    pieces = "".join(re.search("<Piece.*</Piece>", text, re.DOTALL).group() for text in texts)
    path.write_text(re.sub("<Piece.*</Piece>", lambda _: pieces, texts[0], flags=re.DOTALL))
    reader = vtk.vtkXMLPolyDataReader()
    reader.SetFileName(str(path))
    reader.Update()
    return reader.GetOutput()


def write_legacy(data, path, binary, version):
    writer = vtk.vtkPolyDataWriter()
    writer.SetInputData(data)
    writer.SetFileName(str(path))
    writer.SetFileVersion(version)
    (writer.SetFileTypeToBinary if binary else writer.SetFileTypeToASCII)()
    writer.Write()
    reader = vtk.vtkPolyDataReader()
    reader.SetFileName(str(path))
    reader.Update()
    return reader.GetOutput()


for mode in ("ascii", "binary", "base64", "raw"):
    for compressor in ("none", "zlib"):
        for big, header in ((False, 32), (True, 64)):
            path = root / f"{mode}-{compressor}-{header}.vtp"
            compare(path.name, path, write_xml(make("rgb", "points", doubles=big), path, mode, compressor, big, header))
for binary in (False, True):
    for version in (42, 51):
        path = root / f"legacy-{'binary' if binary else 'ascii'}-{version}.vtk"
        compare(path.name, path, write_legacy(make("rgba", "cells", doubles=binary), path, binary, version))
for colors in (None, "rgb", "rgba", "scalars"):
    for place in ("points", "cells"):
        for kinds in ("vlps", "v", "p", "s", "vp"):
            path = root / f"{colors}-{place}-{kinds}.vtp"
            compare(path.name, path, write_xml(make(colors, place, kinds), path, "raw", "zlib", False, 32))
            path = path.with_suffix(".vtk")
            compare(path.name, path, write_legacy(make(colors, place, kinds), path, place == "cells", 51))
path = root / "lines.vtp"
tubes(path.name, path, write_xml(make("scalars", "points", "l"), path, "binary", "none", False, 32))
# VTK's reader puts the cell data of several pieces together as if strips came before polygons: without strips it does not matter.
for colors in (None, "rgb", "scalars"):
    for place, kinds in ("points", ("vlps", "s", "vp", "vlps")), ("cells", ("vlp", "p", "vp", "vlp")):
        path = root / f"pieces-{colors}-{place}.vtp"
        compare(path.name, path, write_pieces([make(colors, place, some) for some in kinds], path))
sys.exit(1 if problems else 0)
