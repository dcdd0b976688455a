#!/usr/bin/python3
"""Meshes of many programs, written here, and what must be read from them.

usage: mesh_kinds.py DUMP_MESH
Concave polygons in every format that has polygons, variants of OBJ, STL, PLY and glTF, surfaces of unstructured grids. Exit 77:
numpy is missing.
"""
import base64
import json
import pathlib
import random
import shutil
import struct
import subprocess
import sys
import tempfile

try:
    import numpy as np
except ImportError as absent:
    print("skipped:", absent)
    sys.exit(77)

DUMP = sys.argv[1]
root = pathlib.Path(tempfile.mkdtemp(prefix="halflight-mesh-"))
problems = []


def check(name, condition, what=""):
    print("ok" if condition else "not ok", "-", name, "" if condition else f": {what}")
    if not condition:
        problems.append(name)


def read(name, content):
    """(vertices [n][3], triangles [n][3], their colours, what was told) of a file of this content."""
    path = root / name
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    told = subprocess.run([DUMP, str(path)], capture_output=True, text=True, timeout=60)
    vertices, triangles, colors = [], [], []
    for line in told.stdout.splitlines():
        words = line.split()
        if words[0] == "v":
            vertices.append([float(w) for w in words[1:4]])
        if words[0] == "t":
            triangles.append([int(w) for w in words[1:4]])
            colors.append([float(w) for w in words[4:]] if words[4] != "-" else None)
    return np.array(vertices), triangles, colors, told.stderr


def area_of(vertices, triangles):
    return sum(np.linalg.norm(np.cross(vertices[b] - vertices[a], vertices[c] - vertices[a])) / 2 for a, b, c in triangles)


def polygon_area(points):
    points = np.asarray(points, float)
    normal = sum(np.cross(a, b) for a, b in zip(points, np.roll(points, -1, 0)))
    return np.linalg.norm(normal) / 2


# ---- concave polygons ----

NOTCH = [(0, 0, 0), (4, 0, 0), (4, 4, 0), (2, 1, 0), (0, 4, 0)]
STAR = [(np.cos(k * np.pi / 6) * (3 if k % 2 else 1), np.sin(k * np.pi / 6) * (3 if k % 2 else 1), 0) for k in range(12)]
COMB = [(0, 0, 0), (9, 0, 0), *[(x, 5 if k % 2 else 1, 0) for k, x in enumerate(range(9, -1, -1))]]
SPIRAL = [(0, 0, 0), (8, 0, 0), (8, 8, 0), (1, 8, 0), (1, 2, 0), (6, 2, 0), (6, 6, 0), (3, 6, 0), (3, 5, 0), (5, 5, 0), (5, 3, 0),
          (2, 3, 0), (2, 7, 0), (7, 7, 0), (7, 1, 0), (0, 1, 0)]


def turned(points, seed):
    """The same polygon anywhere in space."""
    matrix, _ = np.linalg.qr(np.random.default_rng(seed).normal(0, 1, (3, 3)))
    return np.asarray(points, float) @ matrix.T + [5, -7, 3]


def polygons():
    for name, points in (("notch", NOTCH), ("star", STAR), ("comb", COMB), ("spiral", SPIRAL)):
        for first in range(0, len(points), max(1, len(points) // 5)):
            for seed in (1, 2):
                rolled = np.roll(turned(points, seed), -first, 0)
                yield f"{name} from corner {first}, {seed}", rolled
                yield f"{name} backwards from corner {first}, {seed}", rolled[::-1]


def obj_of(points):
    return "".join("v %.17g %.17g %.17g\n" % tuple(p) for p in points) + "f " + " ".join(str(n + 1) for n in range(len(points))) + "\n"


def ply_of(points):
    return ("ply\nformat ascii 1.0\nelement vertex %d\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n"
            "property list uchar int vertex_indices\nend_header\n" % len(points) + "".join("%.17g %.17g %.17g\n" % tuple(p) for p in points)
            + " ".join(map(str, [len(points), *range(len(points))])) + "\n")


def ply_faces_first(points):
    return ("ply\nformat ascii 1.0\nelement face 1\nproperty list uchar int vertex_indices\nelement vertex %d\nproperty float x\n"
            "property float y\nproperty float z\nend_header\n" % len(points) + " ".join(map(str, [len(points), *range(len(points))])) + "\n"
            + "".join("%.17g %.17g %.17g\n" % tuple(p) for p in points))


def vtk_of(points):
    n = len(points)
    return (f"# vtk DataFile Version 3.0\na\nASCII\nDATASET POLYDATA\nPOINTS {n} double\n" + "".join("%.17g %.17g %.17g\n" % tuple(p) for p in points)
            + f"POLYGONS 1 {n + 1}\n{n} " + " ".join(map(str, range(n))) + "\n")


def vtp_of(points, grid=False):
    n, kind = len(points), "UnstructuredGrid" if grid else "PolyData"
    cells = (f'<Cells><DataArray type="Int64" Name="connectivity" format="ascii">{" ".join(map(str, range(n)))}</DataArray>'
             f'<DataArray type="Int64" Name="offsets" format="ascii">{n}</DataArray>')
    cells = cells + '<DataArray type="UInt8" Name="types" format="ascii">7</DataArray></Cells>' if grid else cells.replace("Cells", "Polys") + "</Polys>"
    count = 'NumberOfCells="1"' if grid else 'NumberOfPolys="1"'
    return (f'<VTKFile type="{kind}" version="1.0" byte_order="LittleEndian"><{kind}><Piece NumberOfPoints="{n}" {count}><Points>'
            f'<DataArray type="Float64" NumberOfComponents="3" format="ascii">{" ".join("%.17g" % v for p in points for v in p)}</DataArray>'
            f'</Points>{cells}</Piece></{kind}></VTKFile>')


def test_polygons():
    writers = {"p.obj": obj_of, "p.ply": ply_of, "q.ply": ply_faces_first, "p.vtk": vtk_of, "p.vtp": vtp_of,
               "p.vtu": lambda points: vtp_of(points, True)}
    for file, write in writers.items():
        wrong = []
        for name, points in polygons():
            vertices, triangles, _, told = read(file, write(points))
            wanted = polygon_area(points)
            normals = [np.cross(vertices[b] - vertices[a], vertices[c] - vertices[a]) for a, b, c in triangles]
            whole = sum(normals) if triangles else np.zeros(3)
            same_way = all(np.dot(n, whole) > 0 for n in normals if np.linalg.norm(n) > 1e-5)  # others are rounded to nothing
            if not triangles or abs(area_of(vertices, triangles) - wanted) > 1e-5 * wanted or not same_way:
                wrong.append((name, told))
        check(f"concave polygons of {file}", not wrong, wrong[:3])
    vertices, triangles, _, _ = read("quad.obj", obj_of([(0, 0, 0), (2, 0, 0), (2, 2, 0), (0, 2, 0)]))
    check("a convex polygon stays a fan", triangles == [[0, 1, 2], [0, 2, 3]], triangles)
    many = [(np.cos(k * np.pi / 2000), np.sin(k * np.pi / 2000), 0) for k in range(4000)]
    many = [(x * (1 if k % 2 else 0.7), y * (1 if k % 2 else 0.7), 0) for k, (x, y, _) in enumerate(many)]
    vertices, triangles, _, _ = read("many.obj", obj_of(many))
    check("a polygon of 4000 corners", abs(area_of(vertices, triangles) - polygon_area(many)) < 1e-4, len(triangles))


# ---- OBJ ----

CUBE = [(x, y, z) for z in (0, 1) for y in (0, 1) for x in (0, 1)]
FACES = [(1, 3, 4, 2), (5, 6, 8, 7), (1, 2, 6, 5), (3, 7, 8, 4), (1, 5, 7, 3), (2, 4, 8, 6)]


def test_obj():
    points = "".join("v %d %d %d\n" % p for p in CUBE)
    faces = ["f %d %d %d %d" % f for f in FACES]
    variants = {
        "continued lines": points.replace("v 1 1 1", "v 1 \\\n 1 1") + "\n".join(f.replace(" ", " \\\n", 2) for f in faces),
        "a continued line after CR": points + "\n".join(f[:4] + "\\\r\n" + f[4:] for f in faces),
        "comments after faces": points + "".join(f + " # the face\n" for f in faces),
        "comments after vertices": points.replace("\n", " # here\n") + "\n".join(faces),
        "a comment without a blank": points + "".join(f + " #x\n" for f in faces),
        "CR alone": (points + "\n".join(faces)).replace("\n", "\r"),
        "CR and LF": (points + "\n".join(faces)).replace("\n", "\r\n"),
        "a byte order mark": "\ufeff" + points + "\n".join(faces),
        "corners 1//": points + "\n".join("f " + " ".join(w + "//" for w in f.split()[1:]) for f in faces),
        "corners 1/1/": points + "vt 0 0\n" + "\n".join("f " + " ".join(w + "/1/" for w in f.split()[1:]) for f in faces),
        "corners 1/": points + "\n".join("f " + " ".join(w + "/" for w in f.split()[1:]) for f in faces),
        "negative corners": points + "\n".join("f " + " ".join(str(int(w) - 9) for w in f.split()[1:]) for f in faces),
        "tabs and blanks": points.replace(" ", "\t ") + "\n".join("  " + f + "  " for f in faces),
        "groups, objects, smoothing": "o a\ng b\ns 1\n" + points + "s off\n" + "\n".join(faces),
    }
    for name, text in variants.items():
        vertices, triangles, _, told = read("a.obj", text)
        check(name, len(vertices) == 8 and len(triangles) == 12 and abs(area_of(vertices, triangles) - 6) < 1e-9, told)
    (root / "a b.mtl").write_text("# colours\nnewmtl red one\nKd 1 0 0 # red\nd 0.5\nnewmtl blue\r\nKd 0 0 1\nTr 0.25\nmap_Kd x.png\n")
    text = "mtllib a b.mtl\n" + points + faces[0] + "\nusemtl red one\n" + faces[1] + "\nusemtl blue\n" + "\n".join(faces[2:5]) + "\nusemtl none\n" + faces[5]
    _, triangles, colors, told = read("m.obj", text)
    wanted = [[1, 1, 1, 1]] * 2 + [[1, 0, 0, 0.5]] * 2 + [[0, 0, 1, 0.75]] * 6 + [[1, 1, 1, 1]] * 2
    check("colours of materials", colors == wanted, (colors, told))
    _, triangles, colors, told = read("m.obj", text.replace("a b.mtl", "../a b.mtl"))
    check("materials elsewhere are not read", len(triangles) == 12 and colors[2] in (None, [1, 1, 1, 1]), (colors, told))


# ---- STL ----

def stl_text():
    text = "solid a\n"
    for f in FACES:
        for corners in ((f[0], f[1], f[2]), (f[0], f[2], f[3])):
            text += "facet normal 0 0 0\n outer loop\n" + "".join("  vertex %d %d %d\n" % CUBE[c - 1] for c in corners) + " endloop\nendfacet\n"
    return text + "endsolid a\n"


def test_stl():
    text = stl_text()
    for name, content in {"as it is": text, "a blank first": " \t" + text, "a line first": "\n\n" + text, "capitals": text.upper(),
                          "Words": text.title(), "a byte order mark": "\ufeff" + text, "CR and LF": text.replace("\n", "\r\n"),
                          "CR alone": text.replace("\n", "\r"), "no title": text.replace("solid a", "solid", 1)}.items():
        vertices, triangles, _, told = read("a.stl", content)
        check(f"ASCII STL, {name}", len(triangles) == 12 and abs(area_of(vertices, triangles) - 6) < 1e-9, told)
    facets = []
    for f in FACES:
        for corners in ((f[0], f[1], f[2]), (f[0], f[2], f[3])):
            facets.append(struct.pack("<12fH", 0, 0, 0, *(v for c in corners for v in CUBE[c - 1]), 0))
    for title in (b"solid but binary", b"  SOLID", b"any"):
        for tail in (b"", b"more after it"):
            _, triangles, _, told = read("b.stl", title.ljust(80, b"\0") + struct.pack("<I", 12) + b"".join(facets) + tail)
            check(f"binary STL with the title {title}{' and a tail' if tail else ''}", len(triangles) == 12, told)


# ---- PLY ----

def test_ply():
    text = ply_of(CUBE).replace("element face 1", "element face 6").rsplit("\n", 2)[0] + "\n"
    text += "".join("4 " + " ".join(str(c - 1) for c in f) + "\n" for f in FACES)
    _, triangles, _, told = read("cr.ply", text.replace("\n", "\r"))
    check("PLY with CR alone", len(triangles) == 12, told)
    strip = [0, 1, 2, 3, -1, 4, 6, 5, 7, -1]
    head = ("ply\nformat %s 1.0\nelement vertex 8\nproperty float x\nproperty float y\nproperty float z\nelement tristrips 1\n"
            "property list int int vertex_indices\nend_header\n")
    ascii_text = head % "ascii" + "".join("%d %d %d\n" % p for p in CUBE) + " ".join(map(str, [len(strip), *strip])) + "\n"
    binary = (head % "binary_little_endian").encode() + b"".join(struct.pack("<3f", *p) for p in CUBE) + struct.pack("<11i", len(strip), *strip)
    for name, content in (("ascii", ascii_text), ("binary", binary)):
        vertices, triangles, _, told = read("strips.ply", content)
        check(f"strips of PLY, {name}", triangles == [[0, 1, 2], [2, 1, 3], [4, 6, 5], [5, 6, 7]], (triangles, told))


# ---- glTF ----

def gltf(changes=lambda d: None, uri=None):
    positions = np.array(CUBE, "<f4").tobytes()
    indices = np.array([[f[0], f[1], f[2], f[0], f[2], f[3]] for f in FACES], "<u2").ravel() - 1
    data = positions + indices.astype("<u2").tobytes()
    document = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
                "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
                "buffers": [{"byteLength": len(data)}],
                "bufferViews": [{"buffer": 0, "byteLength": 96}, {"buffer": 0, "byteOffset": 96, "byteLength": 72}],
                "accessors": [{"bufferView": 0, "componentType": 5126, "count": 8, "type": "VEC3"},
                              {"bufferView": 1, "componentType": 5123, "count": 36, "type": "SCALAR"}]}
    document["buffers"][0]["uri"] = uri or "data:application/octet-stream;base64," + base64.b64encode(data).decode()
    changes(document)
    return document, data


def test_gltf():
    def cube(name, told=""):
        vertices, triangles, _, said = read(*name)
        check(told or name[0], len(triangles) == 12 and abs(area_of(vertices, triangles) - 6) < 1e-6, said)

    for file in ("a b.bin", "ä.bin", "100%.bin", "a%20c.bin"):
        for uri in ({"a b.bin": ["a b.bin", "a%20b.bin"], "ä.bin": ["ä.bin", "%C3%A4.bin", "%c3%a4.bin"], "100%.bin": ["100%25.bin", "100%.bin"],
                     "a%20c.bin": ["a%2520c.bin", "a%20c.bin"]}[file]):
            document, data = gltf(uri=uri)
            (root / file).write_bytes(data)
            cube(("u.gltf", json.dumps(document)), f"the uri {uri}")
            (root / file).unlink()
    document, data = gltf()
    del document["buffers"][0]["uri"]
    text = json.dumps(document).encode()
    text += b" " * (1 - len(text) % 4 if len(text) % 4 < 2 else 5 - len(text) % 4)  # no multiple of four
    assert len(text) % 4 == 1
    for name, padding in (("padded as it should be", 3), ("unpadded", 0)):
        length = len(text) + (padding if padding else 0)
        chunk = struct.pack("<I", length) + b"JSON" + text + b" " * padding
        body = chunk + struct.pack("<I", len(data)) + b"BIN\0" + data
        cube(("c.glb", b"glTF" + struct.pack("<II", 2, 12 + len(body)) + body), f"GLB {name}")
    stated = struct.pack("<I", len(text)) + b"JSON" + text + b" " * 3 + struct.pack("<I", len(data)) + b"BIN\0" + data
    cube(("c.glb", b"glTF" + struct.pack("<II", 2, 12 + len(stated)) + stated), "GLB padded beyond the stated length")

    def sparse(document):
        """The last two corners are sparse; in the view they are wrong."""
        moved = np.array(CUBE, "<f4")
        moved[6:] = 7
        values = np.array(CUBE, "<f4")[6:].tobytes()
        extra = moved.tobytes() + struct.pack("<2H", 6, 7) + values
        document["buffers"].append({"byteLength": len(extra), "uri": "data:;base64," + base64.b64encode(extra).decode()})
        document["bufferViews"] += [{"buffer": 1, "byteLength": 96}, {"buffer": 1, "byteOffset": 96, "byteLength": 4},
                                    {"buffer": 1, "byteOffset": 100, "byteLength": 24}]
        document["accessors"][0] |= {"bufferView": 2, "sparse": {"count": 2, "indices": {"bufferView": 3, "componentType": 5123},
                                                                "values": {"bufferView": 4}}}

    cube(("s.gltf", json.dumps(gltf(sparse)[0])), "sparse positions")

    def all_sparse(document):
        extra = struct.pack("<8B", *range(8)) + np.array(CUBE, "<f4").tobytes()
        document["buffers"].append({"byteLength": len(extra), "uri": "data:;base64," + base64.b64encode(extra).decode()})
        document["bufferViews"] += [{"buffer": 1, "byteLength": 8}, {"buffer": 1, "byteOffset": 8, "byteLength": 96}]
        del document["accessors"][0]["bufferView"]
        document["accessors"][0]["sparse"] = {"count": 8, "indices": {"bufferView": 2, "componentType": 5121}, "values": {"bufferView": 3}}

    cube(("s.gltf", json.dumps(gltf(all_sparse)[0])), "positions without a view")

    def draco(document):
        document["extensionsRequired"] = ["KHR_draco_mesh_compression"]

    def draco_used(document):
        document["extensionsUsed"] = ["KHR_draco_mesh_compression"]
        document["meshes"][0]["primitives"][0]["extensions"] = {"KHR_draco_mesh_compression": {"bufferView": 0, "attributes": {"POSITION": 0}}}
        del document["accessors"][0]["bufferView"]

    for change in (draco, draco_used):
        _, triangles, _, told = read("d.gltf", json.dumps(gltf(change)[0]))
        check(f"Draco by name, {change.__name__}", "compressed by Draco" in told and "unpack it" in told and not triangles, told)

    def beyond(document):
        sparse(document)
        document["accessors"][0]["sparse"]["count"] = 9

    _, triangles, _, told = read("d.gltf", json.dumps(gltf(beyond)[0]))
    check("sparse elements beyond the view", told.count("\n") == 1 and not triangles, told)


# ---- unstructured grids ----

def test_unstructured():
    try:
        import vtk
    except ImportError:
        print("skipped: VTK is not installed")
        return
    from vtk.util.numpy_support import numpy_to_vtk, vtk_to_numpy

    def surface_area(grid):
        surface = vtk.vtkDataSetSurfaceFilter()
        surface.SetInputData(grid)
        triangles = vtk.vtkTriangleFilter()
        triangles.SetInputConnection(surface.GetOutputPort())
        mass = vtk.vtkMassProperties()
        mass.SetInputConnection(triangles.GetOutputPort())
        triangles.Update()
        output = triangles.GetOutput()
        points = vtk_to_numpy(output.GetPoints().GetData())
        cells = vtk_to_numpy(output.GetPolys().GetData()).reshape(-1, 4)[:, 1:]
        return area_of(points.astype(float), cells.tolist())

    corners = {10: 4, 11: 8, 12: 8, 13: 6, 14: 5, 5: 3, 9: 4, 8: 4, 24: 10, 25: 20, 22: 6}
    for mode in ("ascii", "binary", "appended"):
        for kinds in ([10], [11], [12], [13], [14], [5, 9, 8], [10, 12, 13]):
            grid, points = vtk.vtkUnstructuredGrid(), vtk.vtkPoints()
            for n, kind in enumerate(kinds):
                cell = vtk.vtkGenericCell()
                cell.SetCellType(kind)
                where = np.array(cell.GetParametricCoords() and [cell.GetParametricCoords()[i] for i in range(3 * corners[kind])]).reshape(-1, 3)
                ids = [points.InsertNextPoint(*(p + [3 * n, 0, 0])) for p in where]
                grid.InsertNextCell(kind, len(ids), ids)
            grid.SetPoints(points)
            grid.GetCellData().SetScalars(numpy_to_vtk(np.arange(len(kinds), dtype=float)))
            path = root / "w.vtu"
            writer = vtk.vtkXMLUnstructuredGridWriter()
            writer.SetInputData(grid)
            writer.SetFileName(str(path))
            {"ascii": writer.SetDataModeToAscii, "binary": writer.SetDataModeToBinary, "appended": writer.SetDataModeToAppended}[mode]()
            writer.Write()
            vertices, triangles, colors, told = read("r.vtu", path.read_bytes())
            check(f"a grid of the cells {kinds}, {mode}", triangles and abs(area_of(vertices, triangles) - surface_area(grid)) < 1e-5, told)
            if len(kinds) > 1:
                check("with colours of cells", colors[0] is not None and len({tuple(c) for c in colors}) == len(kinds), colors[:3])
    image = vtk.vtkImageData()
    image.SetDimensions(4, 3, 5)
    cells = vtk.vtkAppendFilter()
    cells.SetInputData(image)
    cells.Update()
    writer = vtk.vtkXMLUnstructuredGridWriter()
    writer.SetInputData(cells.GetOutput())
    writer.SetFileName(str(root / "w.vtu"))
    writer.Write()
    vertices, triangles, _, told = read("r.vtu", (root / "w.vtu").read_bytes())
    check("a box of voxels is seen from outside", triangles and abs(area_of(vertices, triangles) - 2 * (3 * 2 + 3 * 4 + 2 * 4)) < 1e-5, told)
    middle = vertices.mean(0)
    outwards = [np.dot(np.cross(vertices[b] - vertices[a], vertices[c] - vertices[a]), vertices[a] + vertices[b] + vertices[c] - 3 * middle) > 0
                for a, b, c in triangles]
    check("its faces look outwards", all(outwards), outwards.count(False))


def test_damage():
    """Texts cut at many lengths, and with bytes changed: a mesh, or an error of one line."""
    sources = {"x.obj": obj_of(SPIRAL).encode(), "x.ply": ply_of(STAR).encode(), "x.stl": stl_text().encode(),
               "x.vtu": vtp_of(NOTCH, True).encode(), "x.gltf": json.dumps(gltf()[0]).encode()}
    dice, failed = random.Random(1), []
    for name, content in sources.items():
        for n in range(0, len(content), max(1, len(content) // 25)):
            changed = bytearray(content)
            changed[n] = dice.randrange(256)
            for data in (content[:n], bytes(changed)):
                (root / name).write_bytes(data)
                told = subprocess.run([DUMP, str(root / name)], capture_output=True, timeout=60)
                if told.returncode not in (0, 1) or (told.returncode == 1 and told.stderr.count(b"\n") != 1):
                    failed.append((name, n, told.returncode, told.stderr[:200]))
    check("damaged files", not failed, failed[:3])


try:
    for test in (test_polygons, test_obj, test_stl, test_ply, test_gltf, test_unstructured, test_damage):
        test()
finally:
    shutil.rmtree(root, ignore_errors=True)
print(f"{len(problems)} problems")
sys.exit(1 if problems else 0)
