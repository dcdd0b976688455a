"""Meshes: variants of OBJ, STL, PLY, glTF and VTK against trimesh, meshio and VTK, by area, volume and colours.

usage: meshes.py DUMP_VOLUME DUMP_MESH HALFLIGHT"""
import base64
import json
import struct
import sys

import meshio
import numpy as np
import trimesh
import vtk
from campaign import DUMP_MESH, PROGRAM, count, finish, root, run
from vtk.util.numpy_support import numpy_to_vtk, vtk_to_numpy

vtk.vtkObject.GlobalWarningDisplayOff()
random = np.random.RandomState(5)


def dumped(path):
    """(vertices, triangles, colours, what was said)."""
    told = run(DUMP_MESH, path)
    vertices, triangles, colors = [], [], []
    for line in told.stdout.splitlines():
        words = line.split()
        if words[0] == "v":
            vertices.append([float(w) for w in words[1:4]])
        elif words[0] == "t":
            triangles.append([int(w) for w in words[1:4]])
            colors.append(None if words[4] == "-" else [float(w) for w in words[4:]])
    return np.array(vertices).reshape(-1, 3), np.array(triangles, int).reshape(-1, 3), colors, told.stderr


def measures(vertices, triangles):
    """Area, and volume within (of closed meshes)."""
    a, b, c = (np.asarray(vertices)[np.asarray(triangles)[:, n]] for n in range(3))
    return np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2, np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6


def mesh(kind, name, path, area, volume=None, triangles=None):
    vertices, faces, colors, told = dumped(path)
    if len(faces) == 0:
        count(kind, name, f"no triangles: {told.strip()}")
        return None
    is_area, is_volume = measures(vertices, faces)
    good = abs(is_area - area) <= 1e-4 * area and (volume is None or abs(is_volume - volume) <= 1e-4 * abs(volume)) and (triangles is None or len(faces) == triangles)
    count(kind, name, "" if good else f"area {is_area}, not {area}; volume {is_volume}, not {volume}; {len(faces)} triangles, not {triangles} {told}")
    return colors


BOX = trimesh.creation.box((1, 2, 3))
BALL = trimesh.creation.icosphere(2, 1.5)
RING = trimesh.creation.annulus(1, 2, 0.5)


def outlines():
    """Concave outlines in the plane: an L, an arrow, a gear, a C, a random star."""
    yield "L", [(0, 0), (3, 0), (3, 1), (1, 1), (1, 4), (0, 4)]
    yield "arrow", [(0, 1), (3, 1), (3, 0), (5, 2), (3, 4), (3, 3), (0, 3), (1, 2)]
    yield "gear", [(np.cos(t * np.pi / 16) * (3 if t % 4 < 2 else 2), np.sin(t * np.pi / 16) * (3 if t % 4 < 2 else 2)) for t in range(32)]
    yield "C", [(np.cos(t) * 3, np.sin(t) * 3) for t in np.linspace(0.3, 6, 30)] + [(np.cos(t) * 2, np.sin(t) * 2) for t in np.linspace(6, 0.3, 30)]
    radius = random.uniform(1, 4, 25)
    yield "star", [(r * np.cos(t), r * np.sin(t)) for r, t in zip(radius, np.linspace(0, 2 * np.pi, 26)[:-1])]


def plane_area(points):
    x, y = np.asarray(points, float).T
    return abs(np.dot(x, np.roll(y, -1)) - np.dot(y, np.roll(x, -1))) / 2


def test_concave():
    for name, points in outlines():
        turn = trimesh.transformations.random_rotation_matrix(random.uniform(size=3))[:3, :3]
        corners = np.c_[points, np.zeros(len(points))] @ turn.T + 7
        area, n = plane_area(points), len(points)
        (root / "p.obj").write_text("".join("v %.9g %.9g %.9g\n" % tuple(p) for p in corners) + "f " + " ".join(str(k - n) for k in range(n)) + "\n")
        mesh("concave polygons", f"{name}.obj", root / "p.obj", area)
        (root / "p.ply").write_bytes((f"ply\nformat binary_big_endian 1.0\nelement vertex {n}\nproperty double x\nproperty double y\nproperty double z\nelement face 1\n"
                                      "property list ushort int vertex_index\nend_header\n").encode() + corners.astype(">f8").tobytes() + struct.pack(f">H{n}i", n, *range(n)))
        mesh("concave polygons", f"{name}.ply", root / "p.ply", area)
        data = vtk.vtkPolyData()
        made = vtk.vtkPoints()
        cells = vtk.vtkCellArray()
        for p in corners:
            made.InsertNextPoint(*p)
        cells.InsertNextCell(n, list(range(n)))
        data.SetPoints(made)
        data.SetPolys(cells)
        for writer, ending in ((vtk.vtkXMLPolyDataWriter(), "vtp"), (vtk.vtkPolyDataWriter(), "vtk")):
            writer.SetInputData(data)
            writer.SetFileName(str(root / f"p.{ending}"))
            writer.Write()
            mesh("concave polygons", f"{name}.{ending}", root / f"p.{ending}", area)


def test_obj():
    for name, made in (("box", BOX), ("ball", BALL), ("ring", RING)):
        text = trimesh.exchange.obj.export_obj(made, include_normals=True)
        (root / "a.obj").write_text(text)
        mesh("OBJ", f"trimesh's {name}", root / "a.obj", made.area, made.volume)
    v = "".join("v %g %g %g\n" % tuple(p) for p in BOX.vertices)
    f = [" ".join(str(c + 1) for c in face) for face in BOX.faces]
    for name, text in {
            "1//": v + "".join("f " + " ".join(w + "//" for w in face.split()) + "\n" for face in f),
            "1/1/ and a comment": v + "vt 0 0\n" + "".join("f " + " ".join(w + "/1/" for w in face.split()) + " # x\n" for face in f),
            "continued within numbers' line, with tabs": v.replace("v ", "v\t\\\n ") + "".join("f " + face.replace(" ", " \\\n\t") + "\n" for face in f),
            "continued at the end of the file": v + "".join(f"f {face}\n" for face in f) + "# end \\",
            "colours of vertices": v.replace("\n", " 1 0.5 0\n") + "".join(f"f {face}\n" for face in f),
            "weights of vertices": v.replace("\n", " 1.0\n") + "".join(f"f {face}\n" for face in f),
            "CR alone and a mark": "\ufeff" + (v + "".join(f"f {face}\n" for face in f)).replace("\n", "\r"),
            "points, lines, curves between": v + "p 1 2\nl 1 2 3\n" + "".join(f"f {face}\n" for face in f) + "vp 0.1 0.2\ns 1\ng a b\n",
            "negative with normals": v + "vn 0 0 1\n" + "".join("f " + " ".join(f"{int(w) - 9}//-1" for w in face.split()) + "\n" for face in f)}.items():
        (root / "a.obj").write_text(text)
        mesh("OBJ", name, root / "a.obj", BOX.area, BOX.volume, 12)
    for name, mtl in (("Kd", "newmtl a\nKd 0.8 0.1 0.2\nnewmtl b\nKd 0 0 1\n"), ("d", "newmtl a\nKd 1 0 0\nd 0.25\nnewmtl b\nKd 0 1 0\nd 1\n"), ("Tr", "newmtl a\n\tKd 1 1 0\n\tTr 0.25\nnewmtl b\nKd 0 1 1\n"),
                      ("blanks and comments", "# x\n\nnewmtl   a \n  Kd   0.5 0.5 0.5   # grey\nillum 2\nnewmtl b\nKd .1 .2 .3\n"), ("CR LF", "newmtl a\r\nKa 0 0 0\r\nKd 0.3 0.6 0.9\r\nnewmtl b\r\nKd 1 1 1\r\n")):
        (root / "m.mtl").write_text(mtl)
        (root / "m.obj").write_text("mtllib m.mtl\n" + v + "usemtl a\n" + "".join(f"f {face}\n" for face in f[:6]) + "usemtl b\n" + "".join(f"f {face}\n" for face in f[6:]))
        colors = mesh("OBJ materials", name, root / "m.obj", BOX.area, BOX.volume, 12)
        judged = meshio.read(root / "m.obj")
        assert len(judged.cells_dict["triangle"]) == 12
        lines = [line.split() for line in mtl.splitlines() if line.split()]
        wanted, current = {}, None
        for words in lines:
            current = words[1] if words[0] == "newmtl" else current
            if words[0] == "Kd":
                wanted[current] = [float(w) for w in words[1:4]]
        good = colors and all(c is not None for c in colors) and len({tuple(c) for c in colors[:6]}) == 1 and colors[0][:3] != colors[6][:3]
        order = colors and [np.argsort(wanted["a"]).tolist() == np.argsort(colors[0][:3]).tolist()]
        alpha = {"d": 0.25, "Tr": 0.75}.get(name, 1)
        count("OBJ materials", f"{name}: colours", "" if good and order and abs(colors[0][3] - alpha) < 1e-6 else colors)


def test_stl():
    text = trimesh.exchange.stl.export_stl_ascii(BALL)
    binary = trimesh.exchange.stl.export_stl(BALL)
    for name, content in (("text", text.encode()), ("lines and tabs first", ("\n\t\n " + text).encode()), ("mark and capitals", ("\ufeff" + text.upper()).encode()), ("CR alone", text.replace("\n", "\r").encode()),
                          ("two solids", (text + "\n" + text.replace("solid", "solid b", 1)).encode()), ("binary", binary), ("binary that begins with solid", b"solid ascii" + binary[11:]),
                          ("binary with blanks first", b"   solid x\n" + binary[11:]), ("binary with colours", binary[:80] + binary[80:84] + b"".join(
                              binary[84 + 50 * k:84 + 50 * k + 48] + b"\x1f\x80" for k in range(len(BALL.faces))))):
        (root / "a.stl").write_bytes(content)
        times = 2 if name == "two solids" else 1
        mesh("STL", name, root / "a.stl", BALL.area * times, BALL.volume * times, len(BALL.faces) * times)


def test_ply():
    for name, made, encoding in (("text", BOX, "ascii"), ("binary", BALL, "binary"), ("ring", RING, "binary")):
        (root / "a.ply").write_bytes(trimesh.exchange.ply.export_ply(made, encoding=encoding))
        mesh("PLY", name, root / "a.ply", made.area, made.volume)
    colored = trimesh.creation.box((1, 2, 3))
    colored.visual.face_colors = random.randint(0, 255, (12, 4)).astype(np.uint8)
    (root / "c.ply").write_bytes(trimesh.exchange.ply.export_ply(colored))
    colors = mesh("PLY", "colours of faces", root / "c.ply", BOX.area, BOX.volume, 12)
    count("PLY", "which differ", "" if colors and len({tuple(c) for c in colors if c}) == 12 else colors)
    meshio.write_points_cells(root / "m.ply", BALL.vertices.astype(np.float32), [("triangle", BALL.faces.astype(np.int32))])
    mesh("PLY", "meshio's", root / "m.ply", BALL.area, BALL.volume)
    strip = [0, 1, 2, 3, 4, 5, -1, 0, 2, 4]
    points = np.array([(0, 0, 0), (0, 1, 0), (1, 0, 0), (1, 1, 0), (2, 0, 0), (2, 1, 0)], float)
    head = "ply\nformat {} 1.0\ncomment strips\nelement vertex 6\nproperty float x\nproperty float y\nproperty float z\nelement tristrips 1\nproperty list int int vertex_indices\nend_header\n"
    for name, content in (("text", head.format("ascii").encode() + ("".join("%g %g %g\n" % tuple(p) for p in points) + " ".join(map(str, [len(strip), *strip])) + "\n").encode()),
                          ("little", head.format("binary_little_endian").encode() + points.astype("<f4").tobytes() + struct.pack(f"<{1 + len(strip)}i", len(strip), *strip)),
                          ("big", head.format("binary_big_endian").encode() + points.astype(">f4").tobytes() + struct.pack(f">{1 + len(strip)}i", len(strip), *strip)),
                          ("several strips", (head.replace("tristrips 1", "tristrips 2").format("ascii") + "".join("%g %g %g\n" % tuple(p) for p in points) + "4 0 1 2 3\n4 2 3 4 5\n").encode()),
                          ("CR LF", (head.format("ascii") + "".join("%g %g %g\n" % tuple(p) for p in points) + " ".join(map(str, [len(strip), *strip])) + "\n").replace("\n", "\r\n").encode())):
        (root / "s.ply").write_bytes(content)
        mesh("PLY strips", name, root / "s.ply", 2)


def test_gltf():
    scene = trimesh.Scene()
    for n, made in enumerate((BOX, BALL, RING)):
        scene.add_geometry(made, transform=trimesh.transformations.translation_matrix((5 * n, 0, 0)) @ trimesh.transformations.random_rotation_matrix(random.uniform(size=3)))
    total, within = BOX.area + BALL.area + RING.area, BOX.volume + BALL.volume + RING.volume
    glb = trimesh.exchange.gltf.export_glb(scene)
    (root / "a.glb").write_bytes(glb)
    mesh("glTF", "trimesh's GLB", root / "a.glb", total, within)
    folder = root / "g"
    folder.mkdir()
    files = trimesh.exchange.gltf.export_gltf(scene)
    for name, content in files.items():
        (folder / name).write_bytes(content)
    main = next(name for name in files if name.endswith(".gltf"))
    mesh("glTF", "trimesh's files", folder / main, total, within)
    document = json.loads(files[main])
    for n, buffer in enumerate(document["buffers"]):
        content = (folder / buffer["uri"]).read_bytes()
        new = ["half light %d.bin", "ünï%d.bin", "a#b%d.bin", "x+y %d&.bin"][n % 4] % n
        (folder / new).write_bytes(content)
        buffer["uri"] = "".join(c if c.isalnum() and ord(c) < 128 or c in "._-" else "".join("%%%02X" % b for b in c.encode()) for c in new)
    (folder / "u.gltf").write_text(json.dumps(document))
    mesh("glTF", "percent-encoded URIs", folder / "u.gltf", total, within)
    size = struct.unpack_from("<I", glb, 12)[0]
    text = glb[20:20 + size].rstrip()
    rest = glb[20 + size:]
    body = struct.pack("<I", len(text)) + b"JSON" + text + rest
    (root / "n.glb").write_bytes(b"glTF" + struct.pack("<II", 2, 12 + len(body)) + body)
    mesh("glTF", f"GLB, unpadded by {len(text) % 4}", root / "n.glb", total, within)
    for name, kind, dtype in (("bytes", 5121, "u1"), ("shorts", 5123, "<u2"), ("ints", 5125, "<u4")):
        base = BOX.vertices.astype("<f4")
        wrong = base.copy()
        index = [1, 4, 6]
        wrong[index] = 9
        faces = BOX.faces.astype("<u2")
        data = wrong.tobytes() + faces.tobytes()
        sparse = np.array(index, dtype).tobytes().ljust(12, b"\0") + base[index].tobytes()
        document = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}], "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
                    "buffers": [{"byteLength": len(part), "uri": "data:application/octet-stream;base64," + base64.b64encode(part).decode()} for part in (data, sparse)],
                    "bufferViews": [{"buffer": 0, "byteLength": 96}, {"buffer": 0, "byteOffset": 96, "byteLength": 72}, {"buffer": 1, "byteLength": 12}, {"buffer": 1, "byteOffset": 12, "byteLength": 36}],
                    "accessors": [{"bufferView": 0, "componentType": 5126, "count": 8, "type": "VEC3", "sparse": {"count": 3, "indices": {"bufferView": 2, "componentType": kind}, "values": {"bufferView": 3}}},
                                  {"bufferView": 1, "componentType": 5123, "count": 36, "type": "SCALAR"}]}
        (root / "s.gltf").write_text(json.dumps(document))
        mesh("glTF", f"sparse by {name}", root / "s.gltf", BOX.area, BOX.volume, 12)
    document["extensionsRequired"] = ["KHR_draco_mesh_compression"]
    (root / "d.gltf").write_text(json.dumps(document))
    told = dumped(root / "d.gltf")[3]
    count("glTF", "Draco by name", "" if "Draco" in told and told.count("\n") == 1 else told)


def test_unstructured():
    sizes = {"tetra": 4, "hexahedron": 8, "wedge": 6, "pyramid": 5, "tetra10": 10}
    boxes = np.array([(x, y, z) for z in range(3) for y in range(3) for x in range(3)], float)
    hexes = np.array([[b + o for o in (0, 1, 4, 3, 9, 10, 13, 12)] for b in (0, 1, 3, 4, 9, 10, 12, 13)])
    split = lambda h: [[h[0], h[1], h[3], h[4]], [h[1], h[2], h[3], h[6]], [h[1], h[3], h[4], h[6]], [h[3], h[4], h[6], h[7]], [h[1], h[4], h[5], h[6]]]  # noqa: E731
    tets = np.array([t for h in hexes[:1] for t in split(h)])
    wedges = np.array([[h[0], h[1], h[3], h[4], h[5], h[7]] for h in hexes] + [[h[1], h[2], h[3], h[5], h[6], h[7]] for h in hexes])
    for name, cells in (("hexahedra", [("hexahedron", hexes)]), ("tetrahedra", [("tetra", tets)]), ("wedges", [("wedge", wedges)]), ("mixed", [("hexahedron", hexes[:4]), ("wedge", wedges[8:9])]),
                        ("triangles and quads", [("triangle", BOX.faces), ("quad", np.array([[0, 1, 3, 2]]))])):
        points = BOX.vertices if "triangles" in name else boxes
        meshio.write_points_cells(root / "u.vtu", points, cells, binary=name != "mixed")
        reader = vtk.vtkXMLUnstructuredGridReader()
        reader.SetFileName(str(root / "u.vtu"))
        surface = vtk.vtkDataSetSurfaceFilter()
        surface.SetInputConnection(reader.GetOutputPort())
        triangles = vtk.vtkTriangleFilter()
        triangles.SetInputConnection(surface.GetOutputPort())
        triangles.Update()
        output = triangles.GetOutput()
        area, _ = measures(vtk_to_numpy(output.GetPoints().GetData()).astype(float), vtk_to_numpy(output.GetPolys().GetData()).reshape(-1, 4)[:, 1:])
        mesh("VTU surfaces", name, root / "u.vtu", area)


def test_polydata():
    for name, mode in (("ascii", "Ascii"), ("binary", "Binary"), ("appended", "Appended")):
        for compressor in ("ZLib", "LZ4", "LZMA"):
            data = vtk.vtkPolyData()
            points, cells = vtk.vtkPoints(), vtk.vtkCellArray()
            for p in BALL.vertices:
                points.InsertNextPoint(*p)
            for face in BALL.faces:
                cells.InsertNextCell(3, [int(c) for c in face])
            data.SetPoints(points)
            data.SetPolys(cells)
            array = numpy_to_vtk(random.uniform(size=len(BALL.faces)), deep=True)
            array.SetName("s")
            data.GetCellData().SetScalars(array)
            writer = vtk.vtkXMLPolyDataWriter()
            writer.SetInputData(data)
            writer.SetFileName(str(root / "b.vtp"))
            getattr(writer, f"SetDataModeTo{mode}")()
            getattr(writer, f"SetCompressorTypeTo{compressor}")()
            writer.Write()
            mesh("VTK PolyData", f"{name}, {compressor}", root / "b.vtp", BALL.area, BALL.volume)


for test in (test_concave, test_obj, test_stl, test_ply, test_gltf, test_unstructured, test_polydata):
    test()
sys.exit(finish())
