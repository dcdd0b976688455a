"""Scenes that another build must render as the program does, byte for byte: volumes and a mesh as they are dropped on a page; those of the budgets, one for
each kind of work; the stored pictures'; the examples, in small pictures. Those over real volumes are left out where ../shared/data, or the folder
HALFLIGHT_DATA, is not there.
"""
import json
import math
import os
import pathlib
import shutil
import subprocess
import sys
import zipfile
import zlib

ROOT = pathlib.Path(__file__).resolve().parents[1]
sys.path[:0] = [str(ROOT / "tests" / "budgets"), str(ROOT / "tests" / "viewer")]
from dicom_files import dicom_slice  # noqa: E402
from scenes import KEY, SCENES, SIDE, SKY, scene, soft, write_volumes  # noqa: E402

DATA = pathlib.Path(os.environ.get("HALFLIGHT_DATA", ROOT.parent / "shared" / "data"))
SIZE_DROPPED = (48, 48)  # of volumes' pictures: a square, as the standard size is
SIZE = (72, 64)  # pixels of the examples' pictures
HAZE = {"file": f"haze_{SIDE}x{SIDE}x{SIDE}_uint8.raw", "shading": "none",
        "transfer_function": {"opacity": [[40, 0], [255, 0.05]], "color": [[0, 1, 1, 1]]}}
MORE = {
    "glow": scene({**HAZE, "scattering": {"multiple": True, "albedo": [0.99, 0.95, 0.9]}}),
    "glow_in_sky": scene({**HAZE, "scattering": {"multiple": True, "anisotropy": 0.6}}, sky=SKY),
    "lining": scene({**HAZE, "scattering": {"anisotropy": 0.7}}),
    "isosurfaces": scene({"transfer_function": {"opacity": [[0, 0]], "color": [[0, 1, 1, 1]]}, "iso": [{"value": 100, "opacity": 0.5}, {"value": 180}]}),
    "maximum": scene(render={"compositing": "maximum"}),
    "mask": scene({"mask": {"file": "labels.nrrd", "rest": 0.1, "labels": [{"value": 1, "opacity": 0.8, "color": [1, 0.4, 0.2]}]}}),
    "sky_soft_mesh": scene(render=soft("cascade"), sky=SKY, meshes=[{"file": "pyramid.stl", "color": [0.7, 0.7, 0.8]}]),
    "spot": scene(lights=[KEY, {"type": "spot", "position": [-30, -10, 60], "direction": [50, 30, -40], "opening_angle_deg": 40, "intensity": 2}]),
    "room": scene(lights=[{"type": "point", "position": [-20, -20, 60], "radius": 8}], render=soft("sublights")),
    "splat_soft": scene(render={**soft("paper"), "reconstruction": "splat"}),
    "cells": scene({"file": "cells.vtu", "transfer_function": {"opacity": [[1.5, 0.8], [2.2, 0]], "color": [[0, 1, 0.6, 0.3]]}}),
    "orthographic": scene() | {"camera": {"type": "orthographic", "position": [-60, -40, 70], "target": [20, 20, 20], "up": [0, 0, 1], "height": 50}},
}


def write_stored_volumes(folder):
    """Volumes of the stored pictures' names and sizes; what they hold is another matter."""
    for name, side in (("ball_24x24x24_uint8.raw", 24), ("stage_32x32x32_uint8.raw", 32)):
        places = ((x, y, z) for z in range(side) for y in range(side) for x in range(side))
        middle = (side - 1) / 2
        (folder / name).write_bytes(bytes(
            255 if z < 2 else int(max(0, min(255, 30 * (0.35 * side - math.dist((x, y, z), (middle,) * 3))))) for x, y, z in places))
    header = "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 20 24 16\nspacings: 1 1.5 2\nencoding: raw\n\n"
    voxels = bytes(int(127 + 60 * math.sin(x * 0.7) + 60 * math.cos(y * 0.5 + z)) for z in range(16) for y in range(24) for x in range(20))
    (folder / "waves.nrrd").write_bytes(header.encode() + voxels)


def files_of(value):
    """The names of files in a scene."""
    if isinstance(value, dict):
        for key, inner in value.items():
            if key == "file" and isinstance(inner, str):
                yield inner
            else:
                yield from files_of(inner)
    elif isinstance(value, list):
        for inner in value:
            yield from files_of(inner)


def place_example(path, folder):
    """An example in a small picture, with its files in the folder; None: its files are not there."""
    text = path.read_text()
    for name in set(files_of(json.loads(text))):
        source = DATA / name[5:] if name.startswith("data:") else path.parent / name
        if not source.exists():
            return None
        place = name.replace("data:", "").lstrip("/")
        (folder / place).parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(source, folder / place)
        text = text.replace(json.dumps(name), json.dumps(place))
    scene = json.loads(text)
    scene["image"] |= dict(zip(("width", "height"), SIZE))
    return scene


def write_scenes(folder):
    """[(name of a scene's file, names of its files)], all in the folder."""
    write_volumes(folder)
    write_stored_volumes(folder)
    write_cells(folder / "cells.vtu")
    scenes = SCENES | MORE
    scenes |= {path.stem: json.loads(path.read_text()) for path in sorted((ROOT / "tests" / "golden").glob("*.json"))}
    scenes |= {path.stem: place_example(path, folder) for path in sorted((ROOT / "examples").glob("*.json"))}
    written = []
    for name, scene in scenes.items():
        if scene is not None:
            (folder / f"{name}.json").write_text(json.dumps(scene))
            written.append((f"{name}.json", [f"{name}.json", *sorted(set(files_of(scene)))]))
    return written


def write_particles(path):
    """A table of 120 particles on a spiral, closer together at its middle."""
    rows = ((math.sqrt(n) * math.cos(n), math.sqrt(n) * math.sin(n), 2 * math.sin(0.7 * n), 1 + n % 3, 10 + n) for n in range(120))
    path.write_text("x,y,z,mass,temperature\n" + "".join(",".join(map(repr, row)) + "\n" for row in rows))


def write_cells(path):
    """A VTK file of 64 hexahedra, whose edges are bent, with values at their corners."""
    side = 5
    places = [(x, y, z) for z in range(side) for y in range(side) for x in range(side)]
    at = lambda x, y, z: (z * side + y) * side + x  # noqa: E731
    corners = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]
    cells = [[at(x + a, y + b, z + c) for a, b, c in corners] for x, y, z in places if max(x, y, z) < side - 1]
    words = lambda numbers: " ".join(map(str, numbers))  # noqa: E731
    points = words(9 * n for x, y, z in places for n in (x + 0.2 * math.sin(y), y + 0.2 * math.sin(z), z + 0.2 * math.sin(x)))
    array = '<DataArray type="{}" Name="{}" NumberOfComponents="{}" format="ascii">{}</DataArray>'.format
    path.write_text(
        f'<VTKFile type="UnstructuredGrid"><UnstructuredGrid><Piece NumberOfPoints="{len(places)}" NumberOfCells="{len(cells)}">'
        f'<PointData>{array("Float32", "distance", 1, words(math.dist(place, (2, 2, 2)) for place in places))}</PointData>'
        f'<Points>{array("Float32", "Points", 3, points)}</Points>'
        f'<Cells>{array("Int32", "connectivity", 1, words(n for cell in cells for n in cell))}'
        f'{array("Int32", "offsets", 1, words(range(8, 8 * len(cells) + 1, 8)))}'
        f'{array("UInt8", "types", 1, words(12 for _ in cells))}</Cells></Piece></UnstructuredGrid></VTKFile>')


def write_dropped(folder, program):
    """Volumes as they are dropped on a page: [(name, names of its files)], all in the folder."""
    subprocess.run([program, "make", "rings", "--size", "20", "--quiet", "-o", folder / "rings.nrrd"], check=True)
    names = [f"rings.{ending}" for ending in ("nii.gz", "vti", "mha", "mrc")]
    for name in names:
        subprocess.run([program, "convert", folder / "rings.nrrd", folder / name, "--quiet"], check=True)
    write_particles(folder / "particles.csv")
    (folder / "tetrahedron.obj").write_text("v 0 0 0\nv 9 0 1\nv 2 8 0\nv 3 2 7\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n")
    (folder / "series").mkdir(exist_ok=True)
    for place in range(9):
        (folder / "series" / f"{place}.dcm").write_bytes(dicom_slice(place))
    multiscales = [{"version": "0.4", "axes": [{"name": axis, "type": "space"} for axis in "zyx"], "datasets": [
        {"path": "0", "coordinateTransformations": [{"type": "scale", "scale": [2, 1, 1]}]}]}]
    array = {"zarr_format": 2, "shape": [6, 8, 10], "chunks": [6, 8, 10], "dtype": "|u1", "compressor": {"id": "zlib", "level": 5}, "fill_value": 0,
             "order": "C", "filters": None}
    with zipfile.ZipFile(folder / "image.ome.zarr.zip", "w") as store:
        store.writestr(".zgroup", json.dumps({"zarr_format": 2}))
        store.writestr(".zattrs", json.dumps({"multiscales": multiscales}))
        store.writestr("0/.zarray", json.dumps(array))
        store.writestr("0/0.0.0", zlib.compress(bytes(n % 251 for n in range(480))))
    series = [f"series/{place}.dcm" for place in range(9)]
    return [(name, [name]) for name in [*names, "image.ome.zarr.zip", "particles.csv", "tetrahedron.obj"]] + [("series", series)]


def write_all(folder, program):
    """[(name, names of its files)], all in the folder: dropped volumes, and scenes, whose names end in .json."""
    return write_dropped(folder, program) + write_scenes(folder)


def compare_pictures(command, program, folder, names, first=1):
    """Prints a line of TAP for each name, numbered from `first`: whether a command makes the program's picture, byte for byte. Returns how many differ."""
    failures = 0
    for number, name in enumerate(names, first):
        expected = render_with([program], folder, name, "native.npy")
        try:
            good, why = render_with(command, folder, name, "other.npy") == expected, ""
        except subprocess.CalledProcessError as error:
            good, why = False, f": exit code {error.returncode}"
        failures += not good
        print(f"{'ok' if good else 'not ok'} {number} - {name}{why}", flush=True)
    return failures


def render_with(command, folder, name, out):
    """The picture's bytes, as a program renders it. command: the program's words."""
    size = [] if name.endswith(".json") else ["--size", "x".join(map(str, SIZE_DROPPED))]
    subprocess.run([*command, "render", name, "-o", out, "--quiet", *size], check=True, cwd=folder)
    return (folder / out).read_bytes()
