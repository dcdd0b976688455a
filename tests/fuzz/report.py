#!/usr/bin/env python3
"""Writes the table of fuzz targets into a document, between its markers.

usage: report.py DOCUMENT (from the source folder)
Executions, seconds and findings come from build-fuzz/logs, line coverage from the corpus programs of build-coverage, run
over the committed inputs and those of build-fuzz/corpus. Targets without a log keep the row that the document has.
The exit status is 1 if a campaign ended with a finding.
"""
import json
import os
import pathlib
import re
import subprocess
import sys

BEGIN, END = "<!-- fuzz table -->", "<!-- end of fuzz table -->"

# What a target is for: its title, and the files whose lines count.
TARGETS = {
    "nrrd": ("NRRD", ["volume/formats/nrrd.c", "volume/formats/nrrd_header.c"]),
    "nifti": ("NIfTI", ["volume/formats/nifti.c"]),
    "metaimage": ("MetaImage", ["volume/formats/metaimage.c"]),
    "legacy_vtk": ("legacy VTK", ["volume/formats/vtk/legacy_vtk.c"]),
    "vti": ("VTK XML", ["volume/formats/vtk/vti.c", "volume/io/xml.c"]),
    "npy": ("NumPy", ["volume/formats/npy.c"]),
    "mrc": ("MRC, CCP4", ["volume/formats/mrc.c"]),
    "dicom": ("DICOM, zip archives", ["volume/formats/dicom/dicom.c", "volume/io/source.c", "volume/io/bundle_zip.c"] + [
        f"volume/formats/dicom/{name}.c" for name in ("directory", "elements", "frame", "header", "jpeg", "jpeg_2000", "jpeg_codes", "jpeg_extended", "jpeg_ls",
                                              "jpeg_lossless", "rle", "set", "stack", "voxels")]),
    "raw": ("bare voxels, descriptors", ["volume/formats/raw.c"]),
    "transfer": ("transfer functions", ["json/foreign/foreign_nodes.c", "json/foreign/paraview.c", "json/foreign/paraview_state.c", "json/foreign/slicer.c", "json/foreign/slicer_text.c", "json/transfer_function.c"]),
    "shapes": ("shapes", ["json/shapes.c", "json/shapes_volume.c", "shape/"]),
    "picture": ("PNG, OpenEXR, NPY", ["image/png_read.c", "image/exr_read.c", "image/npy.c"]),
    "scene": ("scene files", ["json/", "scene/"]),
    "render": ("whole renders", ["render/", "light/", "shadow", "grid/", "view/", "fill/"])}
SHARED = ("all volume files, what they share included", ["volume/"],
          ["nrrd", "nifti", "metaimage", "legacy_vtk", "vti", "npy", "mrc", "dicom", "raw"])

TARGETS["labels"] = ("label maps, tables of labels", ["label/", "scene/label/label_list.c", "scene/label/label_table.c"])
TARGETS["keys"] = ("keys of films", ["film/keys.c", "film/film.c"])
TARGETS["words"] = ("the command line", ["cli/options.c", "cli/render/options.c"])
TARGETS["http"] = ("requests of the viewer", ["server/"])
TARGETS["obj"] = ("OBJ and its materials", ["mesh/obj"])
TARGETS["stl"] = ("STL", ["mesh/stl.c"])
TARGETS["mgh"] = ("FreeSurfer's MGH", ["volume/formats/mgh.c"])
TARGETS["slc"] = ("VolVis' SLC", ["volume/formats/slc.c"])
TARGETS["vgi"] = ("VGStudio's VGI, boxes of VTK's adaptive grids", ["volume/formats/vgi.c", "volume/formats/vtk/vthb.c"])
TARGETS["particle_files"] = ("particles", ["particles/", "volume/formats/particles/"])
TARGETS["vtr"] = ("VTK rectilinear grids", ["volume/formats/vtk/rectilinear.c"])
TARGETS["vtu"] = ("VTK's cells", ["volume/formats/vtk/vtu.c", "volume/formats/vtk/cell_mesh.c", "bricks/cells.c"])
TARGETS["amrex"] = ("AMReX plotfiles", ["volume/formats/amr/amrex.c", "volume/formats/amr/amr.c", "bricks/patches.c"])
TARGETS["ply"] = ("PLY", ["mesh/ply.c"])
TARGETS["gltf"] = ("glTF", ["mesh/gltf"])
TARGETS["vtp"] = ("VTK PolyData", ["mesh/vtp.c", "mesh/legacy_polydata.c", "mesh/polydata.c"])
TARGETS["tiff"] = ("TIFF, OME-TIFF, ImageJ", ["volume/formats/tiff/"])
TARGETS["slices"] = ("pictures of slices", ["volume/formats/slices/"])
TARGETS["zarr"] = ("Zarr, OME-Zarr", ["volume/formats/zarr/"])
TARGETS["nanovdb"] = ("NanoVDB", ["volume/formats/vdb/"])
SHARED[2].append("tiff")

root = pathlib.Path(__file__).resolve().parents[2]
coverage = root / "build-coverage"


def campaign(target):
    """(executions, seconds, a finding or not) of a log; None where there is none."""
    log = root / "build-fuzz" / "logs" / f"{target}.log"
    text = log.read_text(errors="replace") if log.exists() else ""
    runs = re.search(r"stat::number_of_executed_units:\s*(\d+)", text)
    done = re.search(r"Done \d+ runs in (\d+) second", text)
    return (int(runs[1]), int(done[1]) if done else 0, done is None) if runs else None


def profile(target):
    """Runs a target over both its corpora; the profile's path."""
    made = coverage / f"{target}.profdata"
    raw = []
    for folder in (root / "tests/fuzz/corpus" / target, root / "build-fuzz/corpus" / target):
        if folder.is_dir() and any(folder.iterdir()):
            raw.append(coverage / f"{target}-{len(raw)}.profraw")
            subprocess.run([coverage / f"tests/fuzz/fuzz_{target}_corpus", folder], check=True, stdout=subprocess.DEVNULL,
                           env=dict(os.environ, LLVM_PROFILE_FILE=str(raw[-1])))
    subprocess.run(["llvm-profdata", "merge", "-sparse", *raw, "-o", made], check=True)
    return made


def lines(programs, profile_data, parts):
    """Covered and all lines of the sources whose path has one of the parts."""
    objects = [f"--object={program}" for program in programs[1:]]
    text = subprocess.run(["llvm-cov", "export", "-summary-only", f"-instr-profile={profile_data}", programs[0], *objects],
                          check=True, capture_output=True, text=True).stdout
    files = [f for f in json.loads(text)["data"][0]["files"]
             if any("/src/" + part in os.path.normpath(f["filename"]) for part in parts)]
    return sum(f["summary"]["lines"]["covered"] for f in files), sum(f["summary"]["lines"]["count"] for f in files)


def percent(counted):
    return f"{100 * counted[0] / counted[1]:.0f} %"


def program(target):
    return coverage / f"tests/fuzz/fuzz_{target}_corpus"


def row(title, executions, seconds, speed, covered, finding):
    return f"| {title} | {executions} | {seconds} | {speed} | {covered} | {finding} |"


def row_of(target, title, parts, old):
    """(row, profile, a finding or not) of a target; None where it has no campaign. Without a program of build-coverage what
    is covered stays as the document's row `old` has it, and the profile is None."""
    run = campaign(target)
    if run is None:
        return None
    executions, seconds, finding = run
    made = profile(target) if program(target).exists() else None
    covered = percent(lines([program(target)], made, parts)) if made else old.split("|")[5].strip() if old else ""
    spent = (f"{seconds:,}", f"{executions // max(seconds, 1):,}") if seconds > 0 else ("", "")  # a finding ends the clock too
    return row(title, f"{executions:,}", *spent, covered, "yes" if finding else "none"), made, finding


document = pathlib.Path(sys.argv[1])
text = document.read_text()
before, rest = text.split(BEGIN, 1)
known = {line.split("|")[1].strip(): line for line in rest.split(END, 1)[0].splitlines() if line.startswith("| ")}
rows = ["| target | executions | seconds | a second | lines covered | finding |", "|---|--:|--:|--:|--:|---|"]
profiles, found = {}, False
for target, (title, parts) in TARGETS.items():
    made = row_of(target, title, parts, known.get(title))
    rows.append(made[0] if made else known.get(title, row(title, "", "", "", "", "not run")))
    if made:
        if made[1]:
            profiles[target] = made[1]
        found = found or made[2]
title, parts, members = SHARED
if all(m in profiles for m in members):
    merged = coverage / "volumes.profdata"
    subprocess.run(["llvm-profdata", "merge", "-sparse", *(profiles[m] for m in members), "-o", merged], check=True)
    rows.append(row(title, "", "", "", percent(lines([program(m) for m in members], merged, parts)), ""))
elif title in known:
    rows.append(known[title])
document.write_text(before + BEGIN + "\n\n" + "\n".join(rows) + "\n\n" + END + rest.split(END, 1)[1])
print("\n".join(rows))
sys.exit(1 if found else 0)
