#!/usr/bin/env python3
"""Opens the inputs of ../shared/reports, which were made anew after public problem reports, and holds what the program
says of each against the right answer of the README there.

usage: reports.py PROGRAM
Exit 77: the folder is absent.
"""
import json
import pathlib
import subprocess
import sys

FOLDER = pathlib.Path(__file__).resolve().parents[2] / ".." / "shared" / "reports"
USUAL = 5, 6, 7

# Name, dimensions, range, spacing.
VOLUMES = [
    ("dicom_enhanced_us_volume_frames_descending.dcm", USUAL, (0, 99), (0.25, 0.5, 2)),
    ("dicom_nm_spacing_between_slices_minus_2.dcm", USUAL, (0, 99), (0.25, 0.5, 2)),
    ("dicom_no_positions_slice_location_2mm_thickness_9", USUAL, (0, 99), (0.25, 0.5, 2)),
    ("dicom_seg_organ1_slices_0-2_organ2_slices_3-6.dcm", USUAL, (0, 2), (0.25, 0.5, 2)),
    ("dicom_seg_organ1_slices_1-3_organ2_slices_2-6.dcm", (5, 6, 6), (0, 2), (0.25, 0.5, 2)),
    ("dicom_siemens_mosaic_7_slices.dcm", USUAL, (0, 99), (0.25, 0.5, 2)),
    ("label_ids_614454277_and_614454278_uint32.nrrd", (24, 24, 24), (0, 614454278), (1, 1, 1)),
    ("metaimage_LIST.mhd", USUAL, (0, 99), (1, 1, 1)),
    ("nifti_dim0_4_dim4_0.nii", USUAL, (0, 99), (2, 2.5, 3)),
    ("nrrd_4d_by_simpleitk_space_dimension_4.nrrd", USUAL, (0, 97), (1, 2, 3)),
    ("nrrd_axis_direction_nan_nan_nan.nrrd", (4, 5, 6), (0.2890629470348358, 3.820213794708252), (0.75, 0.5, 2)),
    ("nrrd_data_file_pattern.nhdr", USUAL, (0, 99), (1, 1, 1)),
    ("nrrd_gzip_byteskip_minus_1.nhdr", USUAL, (0, 99), (1, 1, 1)),
    ("ome_z_size_in_dm.ome.tif", USUAL, (0, 99), (0.299, 0.299, 1)),
    ("ome_zarr_nested_chunks_no_dimension_separator.zarr", USUAL, (0, 99), (1, 1, 1)),
    ("tiff_imagej_stack_one_ifd_as_above_4GB.tif", USUAL, (0, 99), (1, 1, 2)),
    ("tifffile_default_4d_TZYX.tif", USUAL, (0, 99), (1, 1, 1)),
    ("vti_four_pieces.vti", USUAL, (0, 99), (0.5, 1, 2)),
    ("vti_ghost_array_first.vti", USUAL, (0, 99), (0.5, 1, 2)),
    ("vti_lz4.vti", USUAL, (0, 99), (0.5, 1, 2)),
    ("vtk_legacy_ascii_cell_data_field.vtk", USUAL, (0, 99), (0.5, 1, 2)),
    ("vtk_legacy_string_field_data.vtk", USUAL, (0, 99), (0.5, 1, 2)),
]

# What else README.md asks of some.
MORE = {
    "dicom_enhanced_us_volume_frames_descending.dcm": {"origin": (10.0, 20.0, 30.0)},
    "dicom_nm_spacing_between_slices_minus_2.dcm": {"direction": ((1, 0, 0), (0, 1, 0), (0, 0, -1))},
    "tifffile_default_4d_TZYX.tif": {"times": 3},
}

# Name of a table, words of --show, the labels that show.
TABLES = [
    ("label_table_utf8_bom_no_header.csv", [], {"left", "right"}),
    ("label_table_itksnap_cr_only.txt", [], {"a", "b"}),
    ("label_table_itksnap_13_not_visible.txt", ["--show", "all"], {"b"}),
    ("label_table_itksnap_13_not_visible.txt", ["--show", "13"], {"hidden"}),
]


def run(*words):
    return subprocess.run([str(word) for word in words], capture_output=True, text=True, timeout=60)


def is_near(told, right):
    return all(abs(a - b) <= 1e-6 * max(1, abs(b)) if isinstance(b, float) else a == b
               for a, b in zip(told, right, strict=True))


def check_volume(program, name, dimensions, span, spacing):
    ran = run(program, "info", FOLDER / name, "--json")
    if ran.returncode != 0:
        return [f"{name}: {ran.stderr.strip()}"]
    told = json.loads(ran.stdout)
    right = {"dimensions": dimensions, "range": span, "spacing": [float(length) for length in spacing]}
    wrong = [f"{name}: {key} {told[key]}, not {value}" for key, value in right.items() if not is_near(told[key], value)]
    wrong += [f"{name}: {key} {told[key]}, not {value}" for key, value in MORE.get(name, {}).items()
              if json.loads(json.dumps(value)) != told[key]]
    return wrong


def check_table(program, name, words, names):
    ran = run(program, "render", FOLDER / "label_13_beside_42.nrrd", "--label-table", FOLDER / name, *words,
              "--print-scene")
    if ran.returncode != 0:
        return [f"{name}: {ran.stderr.strip()}"]
    labels = json.loads(ran.stdout)["volumes"][0]["labels"]
    shown = {label["name"] for label in labels if label.get("visible", True)}
    return [] if shown == names else [f"{name}: {words} shows {shown}, not {names}"]


def main():
    program = sys.argv[1]
    if not FOLDER.is_dir():
        print("skipped: no ../shared/reports")
        return 77
    wrong = [line for row in VOLUMES for line in check_volume(program, *row)]
    wrong += [line for row in TABLES for line in check_table(program, *row)]
    print(*wrong, f"{len(VOLUMES)} volumes and {len(TABLES)} tables: {len(wrong)} wrong", sep="\n")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
