#!/usr/bin/env python3
"""Every option of `halflight render` gives the pictures of a series the bytes that it gives a file alone; TAP.

usage: series_options.py PROGRAM

For each option of the help text, and for each kind of input that an option is about, three runs: one file alone, a
series of this file, and a series of two files with the same content. All pictures of a file must be the same bytes,
those of the scene that they carry included. Options that are for one picture are refused for a series, before
anything is written, and so is each missing file that an option names.
"""
import json
import os
import pathlib
import re
import shutil
import struct
import subprocess
import sys
import tempfile

import stacks

program = str(pathlib.Path(sys.argv[1]).resolve())
SIZE = 12
LINE = re.compile(r"^  (?:-\w, )?--([\w-]+)", re.M)


def ball(k, j, i):
    """0 to 200 within a ball, and a block beyond it, so that no two sides are alike."""
    away = sum((x - 5.5) ** 2 for x in (i, j, k)) ** 0.5
    return 200 if away < 4 else 90 if i > 8 and j > 6 and k > 3 else 10


def label(k, j, i):
    return 0 if ball(k, j, i) < 50 else 1 + (i > 5) + (ball(k, j, i) == 90)


def slope(k, j, i):
    """As the ball, on a slope: no label map, which --smooth refuses."""
    return ball(k, j, i) // 2 + 3 * i + 2 * j + k


def voxels(value):
    return bytes(value(k, j, i) for k in range(SIZE) for j in range(SIZE) for i in range(SIZE))


def nrrd(path, data, first_axis=None):
    sizes = ([first_axis] if first_axis else []) + [SIZE] * 3
    kinds = (["vector"] if first_axis else []) + ["domain"] * 3
    directions = (["none"] if first_axis else []) + ["(1,0,0)", "(0,1,0)", "(0,0,1)"]
    lines = ["NRRD0004", "type: uint8", f"dimension: {len(sizes)}", "space: left-posterior-superior",
             f"sizes: {' '.join(map(str, sizes))}", f"space directions: {' '.join(directions)}",
             f"kinds: {' '.join(kinds)}", "encoding: raw", "space origin: (0,0,0)"]
    pathlib.Path(path).write_bytes(("\n".join(lines) + "\n\n").encode() + data)


def nifti(path, data, times):
    """A header of NIfTI 1 with bytes, one millimetre a voxel."""
    header = bytearray(352)
    struct.pack_into("<i", header, 0, 348)
    struct.pack_into("<8h", header, 40, 4, SIZE, SIZE, SIZE, times, 1, 1, 1)
    struct.pack_into("<hh", header, 70, 2, 8)
    struct.pack_into("<8f", header, 76, 1, 1, 1, 1, 1, 1, 1, 1)
    struct.pack_into("<f", header, 108, 352)
    header[344:348] = b"n+1\0"
    pathlib.Path(path).write_bytes(bytes(header) + data)


def vti(path, arrays):
    cells = "".join(f'<DataArray type="UInt8" Name="{name}" format="ascii">{" ".join(map(str, data))}</DataArray>'
                    for name, data in arrays.items())
    extent = f"0 {SIZE - 1} 0 {SIZE - 1} 0 {SIZE - 1}"
    pathlib.Path(path).write_text(
        f'<?xml version="1.0"?><VTKFile type="ImageData" version="0.1" byte_order="LittleEndian"><ImageData '
        f'WholeExtent="{extent}" Origin="0 0 0" Spacing="1 1 1"><Piece Extent="{extent}"><PointData>{cells}'
        f"</PointData></Piece></ImageData></VTKFile>")


def ome_zarr(path):
    """Two channels at two resolutions."""
    def array(name, size, data):
        folder = pathlib.Path(path, name)
        folder.mkdir(parents=True)
        shape = [2, size, size, size]
        (folder / ".zarray").write_text(json.dumps(dict(
            zarr_format=2, shape=shape, chunks=shape, dtype="|u1", compressor=None, fill_value=0, order="C",
            filters=None)))
        (folder / "0.0.0.0").write_bytes(data)

    whole = voxels(ball)
    half = bytes(ball(2 * k, 2 * j, 2 * i) for k in range(SIZE // 2) for j in range(SIZE // 2) for i in range(SIZE // 2))
    array("0", SIZE, whole + voxels(label))
    array("1", SIZE // 2, half + bytes(len(half)))
    axes = [dict(name="c", type="channel")] + [dict(name=n, type="space", unit="micrometer") for n in "zyx"]
    datasets = [dict(path=str(n), coordinateTransformations=[dict(type="scale", scale=[1] + [2 ** n] * 3)])
                for n in range(2)]
    pathlib.Path(path, ".zgroup").write_text(json.dumps(dict(zarr_format=2)))
    pathlib.Path(path, ".zattrs").write_text(json.dumps(dict(
        multiscales=[dict(version="0.4", axes=axes, datasets=datasets)])))


def mesh(path):
    """A tetrahedron beside the ball."""
    pathlib.Path(path).write_text("v 2 2 -3\nv 10 2 -3\nv 6 10 -3\nv 6 6 0\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n")


def write_inputs():
    """{kind: ending}: each kind is two files with the same content, part_1 and part_2 with this ending."""
    nrrd("part_1.nrrd", voxels(ball))
    nrrd("part_1.vectors.nrrd", bytes(b for v in voxels(ball) for b in (v, 255 - v, 7)), 3)
    nrrd("part_1.slope.nrrd", voxels(slope))
    nrrd("part_1.seg.nrrd", voxels(label))
    nifti("part_1.nii", voxels(ball) + voxels(label), 2)
    vti("part_1.vti", dict(first=voxels(ball), second=voxels(label)))
    ome_zarr("part_1.ome.zarr")
    stacks.write(f"{SIZE}x{SIZE}x{SIZE}", "part_1.dicom")
    mesh("part_1.obj")
    mesh("wall.obj")
    endings = [path[len("part_1"):] for path in os.listdir() if path.startswith("part_1")]
    for ending in endings:
        copy = shutil.copytree if os.path.isdir("part_1" + ending) else shutil.copyfile
        copy("part_1" + ending, "part_2" + ending)
    nrrd("map.nrrd", voxels(label))
    pathlib.Path("table.csv").write_text("label,name,color\n1,left,#ff0000\n2,right,#00ff00\n3,block,#0000ff\n")
    for name in ("map.bad", "bad.png"):
        pathlib.Path(name).write_text("neither a picture nor a label map")
    pathlib.Path("look.json").write_text(json.dumps(dict(
        opacity=[[20, 0], [150, 0.8]], color=[[0, 0.1, 0.2, 0.5], [200, 1, 0.8, 0.6]], unit_distance=1)))
    run("render", "part_1.nrrd", "--size", "16x8", "--quiet", "-o", "sky.png")


def run(*arguments):
    return subprocess.run([program, *arguments], stdin=subprocess.DEVNULL, capture_output=True, text=True)


# What is given with an option: the words of the run after the operands. The ending of the series' files; "" is
# ".nrrd". Meshes that stand beside the files are operands.
CASES = {
    "size": ["--size 20x24"],
    "background": ["--background #204060", "--background transparent"],
    "exposure": ["--exposure 0.5"],
    "tone": ["--tone filmic"],
    "width": ["--width 24mm"],
    "dpi": ["--dpi 100"],
    # In a series, parts without a corner have their usual one, so that they stay in place.
    "scale-bar": ["--scale-bar auto@target --unit mm --place scale-bar=lower-left"],
    "unit": ["--scale-bar 3@target --unit um --place scale-bar=lower-left"],
    "legend": ["--legend auto --place legend=upper-right", ".seg.nrrd --show all --legend Parts --place legend=upper-right"],
    "axes": ["--axes arrows --place axes=lower-right", "--axes letters"],
    "place": ["--legend auto --place legend=lower-left"],
    "annotate": ["--annotate x@0.2,0.4 --annotate y@6,6,6"],
    "font-size": ["--legend auto --font-size 4 --place legend=upper-right"],
    "view": ["--view left"],
    "up": ["--up +y", ".obj --up +y"],
    "azimuth": ["--azimuth 30", ".obj --azimuth 30"],
    "elevation": ["--elevation 50"],
    "roll": ["--roll 10"],
    "zoom": ["--zoom 1.5"],
    "fovy": ["--fovy 45"],
    "ortho": ["--ortho", ".obj --ortho"],
    "array": [".vti --array second", ".vti --array second --show all"],
    "component": [".vectors.nrrd --component 1", ".vectors.nrrd --component magnitude", ".vectors.nrrd --component color"],
    "series": [".dicom --series 1.2.5"],
    "time": [".nii --time 1", ".nii --time 1 --show all"],
    "channel": [".ome.zarr --channel 1"],
    "level": [".ome.zarr --level 1", ".ome.zarr --size 6x6"],
    "spacing": ["--spacing 1,2,3", ".seg.nrrd --show all --spacing 1,2,3"],
    "space": ["--space LPS", "--space PIR", ".seg.nrrd --show all --space PIR"],
    "look": [f"--look {look}" for look in ("auto", "surface", "translucent", "xray", "smoke", "vessels", "mip")],
    "tf": ["--tf look.json", "--tf ct-bone"],
    "colormap": ["--colormap viridis", "--colormap viridis --look mip"],
    "color-by": [".slope.nrrd --color-by part_1.slope.nrrd:inferno:20,90"],
    "color-by-threshold": [".slope.nrrd --color-by part_1.slope.nrrd:inferno:20,90 --color-by-threshold 60"],
    "range": ["--range 20,150", "--range 1%,99%", "--labels map.nrrd --range map=0,9"],
    "range-scale": ["--range 20,150 --range-scale log"],
    "threshold": ["--threshold 80"],
    "smooth": [".slope.nrrd --smooth 1.5"],
    "iso": ["--iso 100", "--iso 60:skyblue:0.5 --iso 150 --tf look.json"],
    "density": ["--density 0.5"],
    "slice": ["--slice z=0.5", "--slice x=0.3 --labels map.nrrd"],
    "clip": ["--clip x=0.2:0.7"],
    "cut-plane": ["--cut-plane 0.5,0.5,0.5:1,0,0", "--labels map.nrrd --cut-plane 0.5,0.5,0.5:1,0,0"],
    "cut-box": ["--cut-box x=0.5:,y=:0.5,z=0.5:"],
    "cut-sphere": ["--cut-sphere 0.5,0.5,1:0.3"],
    "cut-shading": ["--clip x=0.2:0.7 --cut-shading gradient"],
    "cut-casts-shadow": ["--clip x=0.2:0.7 --cut-casts-shadow"],
    "whole": ["--whole"],
    "shading": ["--shading none"],
    "floor": ["--floor", ".obj --floor", "wall.obj --floor"],
    "outline": ["--outline", "wall.obj --outline --floor"],
    "labels": ["--labels map.nrrd", "wall.obj --labels map.nrrd"],
    "mask": ["--mask map.nrrd", "wall.obj --mask map.nrrd"],
    "label-table": ["--labels map.nrrd --label-table table.csv", "--mask map.nrrd --label-table table.csv",
                    ".seg.nrrd --label-table table.csv"],
    "show": ["--labels map.nrrd --show 1,2=red:0.5", "--mask map.nrrd --show 2=red:0.5,rest:0.1", ".seg.nrrd --show 2",
             ".seg.nrrd --show left,block=yellow:0.4 --label-table table.csv --clip x=0:0.6"],
    "ruler": ["--ruler 0,0.5,0.5:1,0.5,0.5:width"],
    "ambient": ["--ambient 0.4"],
    "light-rig": ["--light-rig rim", ".obj --light-rig studio"],
    "scattering": ["--scattering 0.9"],
    "sky": ["--sky sky.png", "--sky #404080:white", "--sky 0", ".obj --sky sky.png"],
    "light": ["--light 30,20"],
    "light-size": ["--light-size 20"],
    "shadows": ["--shadows off", "--shadows hard"],
    "soft-method": ["--soft-method paper"],
    "light-samples": ["--soft-method sublights --light-samples 2"],
    "pixel-samples": ["--pixel-samples 2"],
    "shadow-resolution": ["--shadow-resolution 20"],
    "shadow-lookup": ["--shadow-lookup nearest"],
    "sheet-spacing": ["--sheet-spacing 1"],
    "kernel": ["--kernel interpolating", ".seg.nrrd --show all --kernel gaussian"],
    "reconstruction": ["--reconstruction splat"],
    "slicing": ["--slicing image-aligned"],
    "data": ["--data ."],
    "threads": ["--threads 2"],
    "device": ["--device cpu"],
    "instruction-set": ["--instruction-set scalar"],
    "max-memory": ["--max-memory 400M"],
    "no-metadata": ["--no-metadata", ".seg.nrrd --no-metadata"],
    "quiet": ["", ".seg.nrrd", ".obj", "wall.obj", ".obj wall.obj"],
}
# They are for one picture: a line says so, or the option that they go with.
ONE_PICTURE = {"format": "png", "views": "front,left", "depth": "16", "layers": None, "reference": None, "print-scene": None, "print-plan": None, "json": None,
               "light-points": "4", "step": "1", "paths": "4", "rays": "1", "strips-over-ranks": None,
               "volume-over-ranks": None, "frames-over-ranks": None}
# What they draw stands in scene files alone, which are no series.
SCENES_ONLY = {"marks"}
# They are for a series; tests/cli/series/one-look.sh compares their pictures.
SERIES_ONLY = {"output", "part", "range-of-all", "help"}
# Files beside the series' own that are not there, or not what they should be.
MISSING = ["--labels missing.nrrd", "--mask missing.nrrd", "--labels map.nrrd --label-table missing.csv",
           "--show all --label-table missing.csv", "--tf missing.json", "--sky missing.png", "missing.obj",
           "--mask map.bad", "--labels map.bad", "--sky bad.png"]

problems = []


def split(case):
    """(ending, operands beside the files, options) of a case."""
    words = case.split()
    ending = words.pop(0) if words and words[0].startswith(".") else ".nrrd"
    operands = [words.pop(0)] if words and words[0].endswith(".obj") and not words[0].startswith("--") else []
    return ending, operands, words


def compare(case):
    ending, operands, options = split(case)
    options = [*options, "--quiet"] + ([] if "--size" in options else ["--size", "24x24"])
    pictures = {}
    for name, arguments in {"first": [f"part_1{ending}", *operands, "-o", "first.png"],
                            "second": [f"part_2{ending}", *operands, "-o", "second.png"],
                            "series of one": [f"part_[1]{ending}", *operands, "-o", "one/%d.png"],
                            "series of two": [f"part_?{ending}", *operands, "-o", "two/%d.png"]}.items():
        done = run("render", *arguments, *options)
        if done.returncode != 0 or done.stderr:
            return f"{name}: exit {done.returncode}, {done.stderr.strip()}"
        pictures[name] = arguments[-1]
    again = [os.stat(f"two/{n}.png").st_ino for n in range(2)]
    run("render", f"part_?{ending}", *operands, "-o", "two/%d.png", *options)
    # A picture without its scene does not tell that it is the right one, nor does a scene what is drawn over it.
    figure = {"--width", "--dpi", "--scale-bar", "--legend", "--axes", "--marks", "--ruler", "--annotate"}
    told = "--no-metadata" not in options and not figure & set(options)
    if (again == [os.stat(f"two/{n}.png").st_ino for n in range(2)]) != told:
        return "the pictures of the series were " + ("made again" if told else "taken for those that were there")
    first, second = pathlib.Path("first.png").read_bytes(), pathlib.Path("second.png").read_bytes()
    if first == second and "--no-metadata" not in options:
        return "the pictures of two files do not tell them apart: they carry no scene"
    for path, alone in {"one/0.png": first, "two/0.png": first, "two/1.png": second}.items():
        if pathlib.Path(path).read_bytes() != alone:
            return f"{path} has other bytes than the picture of the file alone"
    return None


def refused(case, code, pattern):
    """A series with these words ends with the exit code and one line that holds the pattern, and writes nothing."""
    ending, operands, options = split(case)
    done = run("render", f"part_?{ending}", *operands, "-o", "refused/%d.png", *options)
    lines = done.stderr.splitlines()
    if os.path.exists("refused") and os.listdir("refused"):
        return f"{os.listdir('refused')} were written"
    if done.returncode != code or len(lines) != 1 or not re.search(pattern, lines[0]):
        return f"exit {done.returncode}, {done.stderr!r} where /{pattern}/ was awaited"
    return None


def clean():
    for folder in ("one", "two", "refused"):
        shutil.rmtree(folder, ignore_errors=True)


def main():
    folder = tempfile.mkdtemp(prefix="halflight-series-")
    os.chdir(folder)
    try:
        write_inputs()
        results = {}
        offered = set(LINE.findall(run("help", "render").stdout))
        told = set(CASES) | set(ONE_PICTURE) | SERIES_ONLY | SCENES_ONLY
        results["every option has a case"] = f"differs: {sorted(offered ^ told)}" if offered != told else None
        for option, cases in CASES.items():
            for case in cases:
                clean()
                results[f"--{option}: '{case}'"] = compare(case)
        for option, value in ONE_PICTURE.items():
            clean()
            results[f"--{option} is refused"] = refused(f"--{option} {value}" if value else f"--{option}", 2, f"--{option}")
        for case in MISSING:
            clean()
            named = re.escape(next(word for word in case.split() if "missing" in word or "bad" in word))
            results[f"'{case}' is refused"] = refused(case, 3, named)
        results["meshes found beside volumes are refused"] = refused("part_?.obj", 2, "pattern found meshes")
    finally:
        os.chdir("/")
        shutil.rmtree(folder, ignore_errors=True)
    print(f"1..{len(results)}")
    for number, (name, problem) in enumerate(results.items(), 1):
        print(f"{'not ok' if problem else 'ok'} {number} - {name}")
        if problem:
            print(f"# {problem}")
    sys.exit(any(results.values()))


main()
