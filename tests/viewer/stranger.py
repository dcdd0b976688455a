#!/usr/bin/env python3
"""A stranger's files: whatever a file names, the viewer reads nothing outside of the folder of the file that was opened,
and its answer does not tell whether there is such a file. For every format that can name another file.

usage: stranger.py PROGRAM
"""
import io
import json
import os
import shutil
import struct
import sys
import tempfile
import threading
import zipfile

from PIL import Image

import checks
from checks import check
from dicom_files import dicom, dicom_slice, element
from viewer import Viewer, need_viewer

PROGRAM = os.path.abspath(sys.argv[1])
PARAVIEW_STATE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "../unit/paraview-points.pvsm")
PLOTFILE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "../fuzz/corpus/amrex/double.zip")
VOLUME = "_8x8x8_uint8.raw"  # how names of bare voxels end


def request(viewer, path, body=None, method="POST", **query):
    """(status, the answer's text)."""
    status, _, answer = viewer.request(method, path, body, **query)
    return status, answer.decode(errors="replace")


# ---- carriers: files that name another file ----

def dicomdir(name):
    item = element(0x00041500, "CS", name.replace("/", "\\").encode())
    return dicom(element(0x00041220, "SQ", struct.pack("<HHI", 0xfffe, 0xe000, len(item)) + item))


def zipped(name, content):
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w") as archive:
        archive.writestr(name, content)
    return out.getvalue()


def meta_image(name):
    return f"ObjectType = Image\nNDims = 3\nDimSize = 8 8 8\nElementType = MET_UCHAR\nElementDataFile = {name}\n".encode()


def detached_nrrd(name):
    return f"NRRD0004\ntype: uint8\ndimension: 3\nsizes: 8 8 8\nencoding: raw\ndata file: {name}\n".encode()


def vg_header(name):
    return f"{{volume1}}\n[file1]\nFileFormat = raw\nSize = 8 8 8\nName = {name}\nDatatype = unsigned integer\nBitsPerElement = 8\n{{volumeprimitive1}}\n[geometry]\nresolution = 1 1 1\n".encode()


def listed_meta_image(name):
    return f"ObjectType = Image\nNDims = 3\nDimSize = 8 8 1\nElementType = MET_UCHAR\nElementDataFile = LIST\n{name}\n".encode()


def listed_nrrd(name):
    return f"NRRD0004\ntype: uint8\ndimension: 3\nsizes: 8 8 1\nencoding: raw\ndata file: LIST\n{name}\n".encode()


EXTENT = "0 8 0 8 0 8"


def image_data(numbers):
    return (f'<VTKFile type="ImageData"><ImageData WholeExtent="{EXTENT}" Origin="0 0 0" Spacing="1 1 1"><Piece Extent="{EXTENT}"><CellData>'
            f'<DataArray type="UInt8" Name="v" format="ascii">{" ".join(map(str, numbers))}</DataArray></CellData></Piece></ImageData></VTKFile>').encode()


def parallel_image_data(name):
    return (f'<VTKFile type="PImageData"><PImageData WholeExtent="{EXTENT}" Origin="0 0 0" Spacing="1 1 1"><PCellData>'
            f'<PDataArray type="UInt8" Name="v"/></PCellData><Piece Extent="{EXTENT}" Source="{name}"/></PImageData></VTKFile>').encode()


def adaptive_grid(name):
    return ('<VTKFile type="vtkOverlappingAMR"><vtkOverlappingAMR origin="0 0 0"><Block level="0" spacing="1 1 1">'
            f'<DataSet index="0" amr_box="0 7 0 7 0 7" file="{name}"/></Block></vtkOverlappingAMR></VTKFile>').encode()


def ome_tiff(name):
    text = ('<?xml version="1.0"?><OME xmlns="http://www.openmicroscopy.org/Schemas/OME/2016-06"><Image ID="Image:0"><Pixels ID="Pixels:0" '
            'DimensionOrder="XYZCT" Type="uint8" SizeX="8" SizeY="8" SizeZ="2" SizeC="1" SizeT="1"><TiffData FirstZ="0" IFD="0" PlaneCount="1">'
            '<UUID FileName="%s">urn:uuid:1</UUID></TiffData><TiffData FirstZ="1" IFD="0" PlaneCount="1"><UUID FileName="%s">urn:uuid:1</UUID>'
            '</TiffData></Pixels></Image></OME>' % (name, name))
    out = io.BytesIO()
    Image.new("L", (8, 8), 100).save(out, "TIFF", tiffinfo={270: text})
    return out.getvalue()


def scene(**parts):
    whole = {"halflight": 1, "image": {"width": 16, "height": 16}, "volumes": [{"shapes": [{"type": "sphere", "radius": 5}], "voxel_size": 1}]}
    return json.dumps({**whole, **parts}).encode()


def volume_scene(name, **more):
    return scene(volumes=[{"file": name, **more}])


def with_voxels(**more):
    """A scene of the voxels that lie beside it, with more keys of the volume."""
    return volume_scene("own" + VOLUME, **more)


def plane(name):
    return {"second": "gradient", "image": {"file": name, "value": [0, 255], "second": [0, 50]}}


def light(**more):
    return scene(lights=[{"type": "point", "position": [0, 0, 99], **more}])


SCREEN = {"center": [0, 0, 20], "right": [9, 0, 0], "up": [0, 9, 0]}
WINDOW = {"type": "rect", "position": [0, 0, 50], "edge1": [9, 0, 0], "edge2": [0, 9, 0]}

# The file that names another one, what it holds for a name, and how the name ends.
CARRIERS = [
    ("mhd.mhd", meta_image, VOLUME),
    ("header.vgi", vg_header, VOLUME),
    ("nrrd.nhdr", detached_nrrd, VOLUME),
    ("list.mhd", listed_meta_image, VOLUME),
    ("list.nhdr", listed_nrrd, VOLUME),
    ("pieces.pvti", parallel_image_data, ".vti"),
    ("boxes.vthb", adaptive_grid, ".vti"),
    ("ome.tif", ome_tiff, ".tif"),
    ("disc.dcm", dicomdir, ".dcm"),
    ("volume.json", volume_scene, VOLUME),
    ("header.json", volume_scene, ".nhdr"),
    ("slices.json", volume_scene, ".slices"),
    ("mask.json", lambda name: with_voxels(mask={"file": name, "labels": True}), VOLUME),
    ("table.json", lambda name: with_voxels(labels=True, label_table=name), ".txt"),
    ("function.json", lambda name: with_voxels(transfer_function={"file": name}), ".tf.json"),
    ("slicer.json", lambda name: with_voxels(transfer_function={"file": name}), ".vp"),
    ("paraview.json", lambda name: with_voxels(transfer_function={"file": name}), ".pvsm"),
    ("plane.json", lambda name: with_voxels(transfer_function=plane(name)), ".png"),
    ("mesh.json", lambda name: scene(meshes=[{"file": name}]), ".ply"),
    ("sky.json", lambda name: scene(sky={"type": "image", "file": name}), ".png"),
    ("texture.json", lambda name: light(texture={"file": name, "screen": SCREEN}), ".png"),
    ("window.json", lambda name: scene(lights=[{**WINDOW, "emission": {"file": name}}]), ".png"),
]

# The readers of these refuse all names with a slash, in words of their own.
ALONE = {"ome.tif"}

# Files beside a scene that name another one: they come with a scene of their own.
NESTED = [
    ("descriptor.dat", lambda name: f"ObjectFileName: {name}\nResolution: 8 8 8\nFormat: UCHAR\n".encode(), VOLUME, lambda own: volume_scene(own)),
    ("buffers.gltf", lambda name: gltf(name), ".bin", lambda own: scene(meshes=[{"file": own}])),
    ("nested.nhdr", detached_nrrd, VOLUME, lambda own: volume_scene(own)),
    ("plane.tf.json", lambda name: json.dumps(plane(name)).encode(), ".png", lambda own: with_voxels(transfer_function={"file": own})),
]

POINTS = struct.pack("<9f", 0, 0, 0, 9, 0, 0, 0, 9, 9)


def gltf(name):
    return json.dumps({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
                       "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
                       "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}],
                       "bufferViews": [{"buffer": 0, "byteLength": 36}], "buffers": [{"byteLength": 36, "uri": name}]}).encode()


def write(path, content):
    with open(path, "wb") as file:
        file.write(content)


SECRETS = {
    VOLUME: bytes(n % 7 for n in range(512)),
    ".nhdr": detached_nrrd("own" + VOLUME),
    ".vti": image_data(n % 7 for n in range(512)),
    ".txt": b"1 one 255 0 0 255\n2 two 0 255 0 255\n3 three 0 0 255 255\n",
    ".tf.json": b'{"opacity": [[0, 0], [6, 1]]}',
    ".ply": b"ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n"
            b"property list uchar int vertex_indices\nend_header\n0 0 0\n9 0 0\n0 9 9\n3 0 1 2\n",
    ".bin": POINTS,
    ".vp": b"1\n1\n0.9\n0.1\n0.2\n10\n4 0 0 6 0.75\n4 0 0 10 1\n8 0 1 0 0 6 0 0 1\n",
    ".dcm": dicom_slice(),
}


def make_secrets(folder):
    """Every kind of file, by the name "secret" and its ending."""
    for ending, content in SECRETS.items():
        write(f"{folder}/secret{ending}", content)
    write(f"{folder}/own{VOLUME}", SECRETS[VOLUME])
    Image.new("RGB", (8, 8), (200, 100, 50)).save(f"{folder}/secret.png")
    Image.new("L", (8, 8), 50).save(f"{folder}/secret.tif")
    os.mkdir(f"{folder}/secret.slices")
    for n in range(3):
        Image.new("L", (8, 8), 50 * n).save(f"{folder}/secret.slices/s{n}.png")
    shutil.copy(PARAVIEW_STATE, f"{folder}/secret.pvsm")


def spellings(ending, outside):
    """Names of the secret, each with the same name of a file that is not there."""
    there, absent = f"secret{ending}", f"absent{ending}"
    for folder in (outside, "../outside", "inner/../../outside", "/proc/self/cwd/../outside", f"/proc/self/root{outside}", f"file://{outside}",
                   "http://127.0.0.1:1", "away"):  # "away": a link to the folder
        yield f"{folder}/{there}", f"{folder}/{absent}"
    yield f"leak{ending}", f"dangling{ending}"  # links to the file, and to none


def masked(line, name):
    return line.replace(name, "NAME").replace(name.replace("/", "\\"), "NAME")


def tell_nothing(viewer, what, attempt, ending, outside):
    """Every spelling is refused, in words that do not depend on what there is."""
    words = set()
    for there, absent in spellings(ending, outside):
        answers = []
        for name in (there, absent):
            status, line = attempt(viewer, name)
            check(status == 400, f"{what}: the name {name} is refused, not {status}: {line[:200]}")
            answers.append(masked(line, name))
        check(answers[0] == answers[1], f"{what}: {there} and {absent} have the same words: {answers}")
        words.add(answers[0])
    return words


def by_open(file, make, also=None):
    """Writes the file into the viewer's folder and opens it."""
    def attempt(viewer, name):
        write(file, make(name))
        if also is not None:
            write(*also)
        return request(viewer, "open", file=also[0] if also is not None else file)
    return attempt


def by_upload(file, make):
    def attempt(viewer, name):
        return request(viewer, "upload", make(name), name=file)
    return attempt


def every_format(viewer, outside):
    for file, make, ending in CARRIERS:
        opened, words = by_open(file, make), tell_nothing(viewer, f"open {file}", by_open(file, make), ending, outside)
        check(len(words) == 1 or file in ALONE, f"open {file}: one wording: {words}")
        status, line = opened(viewer, f"secret{ending}")
        check(status == 200, f"open {file}: what lies beside it is read, not {status}: {line[:300]}")
        status, line = opened(viewer, f"inner/secret{ending}")
        check(status == (400 if file in ALONE else 200), f"open {file}: and what lies below, not {status}: {line[:300]}")
        tell_nothing(viewer, f"upload {file}", by_upload(file, make), ending, outside)
        status, line = by_upload(file, make)(viewer, f"secret{ending}")
        check(status == 400, f"upload {file}: nothing is beside it, not {status}")
    archive = lambda name: zipped("in.mhd", meta_image(name))  # its files name nothing outside of it
    for attempt in (by_open("archive.zip", archive), by_upload("archive.zip", archive)):
        tell_nothing(viewer, "archive.zip", attempt, VOLUME, outside)
        check(attempt(viewer, f"secret{VOLUME}")[0] == 400, "archive.zip: nothing is beside it")
    for file, make, ending, own in NESTED:
        opened = by_open(file, make, ("nested.json", own(file)))
        tell_nothing(viewer, f"{file} in a scene", opened, ending, outside)
        status, line = opened(viewer, f"secret{ending}")
        check(status == 200, f"{file} in a scene: what lies beside it is read, not {status}: {line[:300]}")


def links_of_known_names(viewer):
    """Files whose names are not in a header: the voxels of a NIfTI pair, the chunks of Zarr, the slices of a folder."""
    header = bytearray(348)
    struct.pack_into("<i", header, 0, 348)
    struct.pack_into("<8h", header, 40, 3, 8, 8, 8, 1, 1, 1, 1)
    struct.pack_into("<2h", header, 70, 2, 8)
    struct.pack_into("<8f", header, 76, 1, 1, 1, 1, 1, 1, 1, 1)
    header[344:348] = b"ni1\0"
    write("pair.hdr", bytes(header))
    write("pair.json", volume_scene("pair.hdr"))
    os.symlink(f"../outside/secret{VOLUME}", "pair.img")
    check(request(viewer, "open", file="pair.json")[0] == 400, "the voxels of a NIfTI pair are no link that leads out")
    os.remove("pair.img")
    write("pair.img", SECRETS[VOLUME])
    check(request(viewer, "open", file="pair.json")[0] == 200, "a NIfTI pair")
    os.mkdir("store.zarr")
    write("store.zarr/.zarray", json.dumps({"zarr_format": 2, "shape": [8, 8, 8], "chunks": [8, 8, 8], "dtype": "|u1", "compressor": None,
                                            "fill_value": 0, "order": "C", "filters": None}).encode())
    os.symlink(f"../../outside/secret{VOLUME}", "store.zarr/0.0.0")
    linked = request(viewer, "open", file="store.zarr")
    os.remove("store.zarr/0.0.0")
    empty = request(viewer, "open", file="store.zarr")
    write("store.zarr/0.0.0", SECRETS[VOLUME])
    full = request(viewer, "open", file="store.zarr")
    ranges = [json.loads(text)["volumes"][0]["range"] if status == 200 else text for status, text in (linked, empty, full)]
    check(ranges[0] == ranges[1] and 0 <= ranges[2][0] < ranges[2][1] <= 6, f"a chunk is no link that leads out: {ranges}") # noise is smoothed
    os.mkdir("group.zarr")
    for path in ("../store.zarr", "../../outside", f"{os.getcwd()}/store.zarr"):
        write("group.zarr/.zattrs", json.dumps({"multiscales": [{"version": "0.4", "axes": [{"name": n, "type": "space"} for n in "zyx"], "datasets": [
            {"path": path, "coordinateTransformations": [{"type": "scale", "scale": [1, 1, 1]}]}]}]}).encode())
        write("group.zarr/.zgroup", b'{"zarr_format": 2}')
        check(request(viewer, "open", file="group.zarr")[0] == 400, f"an image of OME-Zarr at {path}")
        for images in ({"plate": {"wells": [{"path": path}]}}, {"well": {"images": [{"path": path}]}}):
            write("group.zarr/.zattrs", json.dumps(images).encode())
            check(request(viewer, "open", file="group.zarr")[0] == 400, f"an image of a plate or a well at {path}")
    os.mkdir("linked")
    for n in range(3):
        os.symlink(f"../../outside/secret.slices/s{n}.png", f"linked/s{n}.png")
    check(request(viewer, "open", file="linked")[0] == 400, "slices are no links that lead out")


def patches_of_a_plotfile(viewer, outside):
    """The lists of patches in a plotfile of AMReX name the files of their cells."""
    with zipfile.ZipFile(PLOTFILE) as archive:
        archive.extractall("plot")
    shutil.copy("plot/Level_0/Cell_D_00000", f"{outside}/secret.fab")
    for name in ("secret", "absent"):
        os.symlink(f"../../../outside/{name}.fab", f"plot/Level_0/{'leak' if name == 'secret' else 'dangling'}.fab")
    with open("plot/Level_0/Cell_H", "rb") as file:
        patches = file.read()
    def opened(viewer, name):
        write("plot/Level_0/Cell_H", patches.replace(b"Cell_D_00000", name.encode()))
        return request(viewer, "open", file="plot")
    tell_nothing(viewer, "plotfile", opened, ".fab", outside)
    check(opened(viewer, "Cell_D_00000")[0] == 200, "a plotfile's own patches are read")


def libraries_of_materials(viewer, outside):
    """An OBJ mesh is shown without the colours of a library that it may not read, and nothing tells whether there is one."""
    mesh = "v 0 0 0\nv 9 0 0\nv 0 9 9\nusemtl red\nf 1 2 3\n"
    for place in (outside, ".", "inner"):
        write(f"{place}/secret.mtl", b"newmtl red\nKd 1 0 0\n")
    for n, name in enumerate(("secret", "absent")):
        os.symlink(f"../outside/{name}.mtl", ("leak.mtl", "dangling.mtl")[n])
    def opened(name):
        write("mesh.obj", f"mtllib {name}\n{mesh}".encode())
        write("mesh.json", scene(meshes=[{"file": "mesh.obj"}]))
        status, text = request(viewer, "open", file="mesh.json")
        if status != 200:
            return status, text
        start = json.loads(text)
        picture = request(viewer, "frame", json.dumps(start["scene"]), page="m", format="png", opened=start["opened"], number=next(numbers))
        return status, masked(json.dumps({key: value for key, value in start.items() if key != "opened"}), name), picture
    numbers = iter(range(1, 10**6))
    for there, absent in spellings(".mtl", outside):
        check(opened(there) == opened(absent), f"mesh.obj: {there} and {absent} have the same answer: {opened(there)[:2]} {opened(absent)[:2]}")
    red, grey = opened("secret.mtl")[2], opened("absent.mtl")[2]
    check(red[0] == grey[0] == 200 and red != grey, "a library beside the mesh colours it")


def pages_scenes(viewer, outside):
    """The scene that a page sends opens no file, and does not tell whether there is one."""
    start = json.loads(request(viewer, "open", file="volume.json")[1])
    query = {"page": "s", "format": "png", "opened": start["opened"]}
    number = iter(range(1, 10**6))
    for file, make, ending in [entry for entry in CARRIERS if entry[0].endswith(".json")]:
        for there, absent in spellings(ending, outside):
            answers = [request(viewer, "frame", make(name), number=next(number), **query) for name in (there, absent)]
            check(all(status == 400 for status, _ in answers), f"a page's scene like {file} with {there}: {answers[0]}")
            check(masked(answers[0][1], there) == masked(answers[1][1], absent), f"a page's scene like {file}: the same words")
    stand_in = {"shapes": [{"type": "sphere", "radius": 5}], "voxel_size": 1}
    for name in (f"{outside}/secret{VOLUME}", f"{outside}/absent{VOLUME}"):
        status, line = request(viewer, "frame", volume_scene(name, stand_in=stand_in), number=next(number), **query)
        check(status == 400 and "shapes" in line, f"a stand-in takes the place of {name}: {status} {line[:100]}")
        write("stand.json", volume_scene(name, stand_in=stand_in))
        status, line = request(viewer, "open", file="stand.json")
        check(status == 200 and json.loads(line)["volumes"][0]["dimensions"] != [8, 8, 8], f"a stand-in takes the place of {name}: {status}")


def kinds_of_vtk_files(viewer):
    """The first bytes of a .vtk file tell whether it holds a mesh: those of the opened file, and of no other file of its name."""
    begin = b"# vtk DataFile Version 3.0\nt\nASCII\nDATASET "
    mesh = begin + b"POLYDATA\nPOINTS 3 float\n0 0 0 9 0 0 0 9 9\nPOLYGONS 1 4\n3 0 1 2\n"
    grid = (begin + b"STRUCTURED_POINTS\nDIMENSIONS 2 2 2\nORIGIN 0 0 0\nSPACING 1 1 1\nPOINT_DATA 8\n"
            b"SCALARS v unsigned_char\nLOOKUP_TABLE default\n0 1 2 3 4 5 6 7\n")
    write("inner/thing.vtk", mesh)
    write("../outside/mesh.vtk", mesh)
    os.symlink("../outside/mesh.vtk", "linked.vtk")
    attempts = [("open in a folder", request(viewer, "open", file="inner/thing.vtk"), 0),
                ("upload", request(viewer, "upload", mesh, name="thing.vtk"), 0)]
    write("thing.vtk", grid)
    attempts += [("upload beside a grid", request(viewer, "upload", mesh, name="thing.vtk"), 0), ("open a grid", request(viewer, "open", file="thing.vtk"), 1)]
    write("thing.vtk", mesh)
    attempts += [("upload a grid beside a mesh", request(viewer, "upload", grid, name="thing.vtk"), 1),
                 ("upload a grid beside a link that leads out", request(viewer, "upload", grid, name="linked.vtk"), 1)]
    for what, (status, line), volumes in attempts:
        check(status == 200 and len(json.loads(line)["volumes"]) == volumes, f"{what}: {volumes} volumes, not {status}: {line[:200]}")


def odd_files(viewer):
    """Pipes and devices are not waited for; names with zero bytes are refused."""
    os.mkfifo(f"pipe{VOLUME}")
    write("pipe.mhd", meta_image(f"pipe{VOLUME}"))
    write("pipe.json", volume_scene(f"pipe{VOLUME}"))
    for file in ("pipe.mhd", "pipe.json", f"pipe{VOLUME}"):
        check(request(viewer, "open", file=file)[0] == 400, f"{file} is refused, and not waited for")
    check(request(viewer, "open", file=f"secret{VOLUME}\0.json")[0] == 400, "a name with a zero byte")
    check(request(viewer, "upload", b"x", name="../a\0.nrrd")[0] == 400, "a name of an upload with a zero byte")
    check(request(viewer, "open", file=".")[0] in (200, 400) and request(viewer, "open", file="..")[0] == 403, "the folder itself, at most")


def sessions(viewer):
    """A page gets a session below the viewer's folder, and no other file."""
    session = json.dumps({"halflight_session": 1, "scene": {"camera": {}}}).encode()
    write("inner/kept.json", session)
    write("other.json", b'{"halflight_session": "1", "halflight": 1}')
    write("broken.json", session[:-1])
    write("deep.json", b"[" * 100000)
    write("../outside/kept.json", session)
    os.symlink("../outside/kept.json", "linked.json")
    os.symlink("inner/kept.json", "within.json")
    os.mkfifo("pipe-session.json")
    for name, status in (("inner/kept.json", 200), ("within.json", 200), ("other.json", 204), ("broken.json", 204), ("deep.json", 204), ("linked.json", 204),
                         ("../outside/kept.json", 204), (os.path.abspath("../outside/kept.json"), 204), ("pipe-session.json", 204), ("inner", 204), ("none.json", 204)):
        answer = request(viewer, "session", file=name)
        check(answer[0] == status, f"{name}: {answer}")
        if status == 200:
            check(json.loads(answer[1]) == json.loads(session), f"{name}: {answer}")


def changing_links(viewer):
    """A folder that becomes a link out of the viewer's folder, and a folder again, leads no request out, whenever it changes."""
    session = json.dumps({"halflight_session": 1, "place": "inside"}).encode()
    os.mkdir("turning")
    write("turning/kept.json", session)
    write("../outside/kept.json", session.replace(b"inside", b"outside"))
    write(f"../outside/only-outside{VOLUME}", b"0")
    os.symlink("../outside", "turned")
    stopped = threading.Event()

    def turn():
        while not stopped.is_set():
            for name, other in (("turning", "kept-aside"), ("turned", "turning"), ("turning", "turned"), ("kept-aside", "turning")):
                os.rename(name, other)

    turner = threading.Thread(target=turn)
    turner.start()
    answers = [request(viewer, "session", b"", file="turning/kept.json") for _ in range(1000)]
    lists = [request(viewer, "folder.json", method="GET", at="turning") for _ in range(300)]
    stopped.set()
    turner.join()
    check(any(status == 200 for status, _ in answers), "the session is read while its folder stands")
    check(any("kept.json" in text for _, text in lists), "the folder is listed while it stands")
    check(not any("outside" in text for _, text in answers), "no session outside is read through a link that comes and goes")
    check(not any("only-outside" in text for _, text in lists), "no folder outside is listed through a link that comes and goes")


def data_folder(viewer, outside):
    """Scenes of pages do not reach the data folder, by which names of the command line begin."""
    for name in ("data:secret", "data:../outside/secret"):
        for attempt in (by_open("data.json", volume_scene), by_upload("data.json", volume_scene)):
            status, line = attempt(viewer, name + VOLUME)
            check(status == 400 and outside not in line, f"{name} is refused: {line}")


with tempfile.TemporaryDirectory() as folder:
    folder = os.path.realpath(folder)
    os.environ["TMPDIR"] = tempfile.tempdir = f"{folder}/temporary"
    for name in ("temporary", "outside", "work", "work/inner"):
        os.mkdir(f"{folder}/{name}")
    os.chdir(f"{folder}/work")
    need_viewer(PROGRAM)
    outside = f"{folder}/outside"
    for place in (outside, ".", "inner"):
        make_secrets(place)
    os.symlink("../outside", "away")
    for ending in [*SECRETS, ".png", ".tif", ".pvsm", ".slices"]:
        os.symlink(f"../outside/secret{ending}", f"leak{ending}")
        os.symlink(f"../outside/absent{ending}", f"dangling{ending}")
    with Viewer(PROGRAM, f"own{VOLUME}", "--data", outside) as viewer:
        every_format(viewer, outside)
        links_of_known_names(viewer)
        patches_of_a_plotfile(viewer, outside)
        libraries_of_materials(viewer, outside)
        pages_scenes(viewer, outside)
        kinds_of_vtk_files(viewer)
        odd_files(viewer)
        sessions(viewer)
        changing_links(viewer)
        data_folder(viewer, outside)
        left = [name for name in os.listdir(os.environ["TMPDIR"]) if name.startswith("halflight-view")]
        check(left == [], f"nothing is left of uploads: {left}")
    print(f"{checks.count} checks passed")
