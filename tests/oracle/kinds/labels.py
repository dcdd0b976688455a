"""Whole numbers of 32 and 64 bits and doubles through info, convert, labels and masks, and tables of labels: against numpy, pynrrd,
ITK, VTK, tifffile and zarr.

usage: labels.py DUMP_VOLUME DUMP_MESH HALFLIGHT"""
import json
import shutil
import sys

import nrrd
import numpy as np
import SimpleITK
import tifffile
import vtk
import zarr
from campaign import PROGRAM, count, finish, read, root, run
from vtk.util.numpy_support import numpy_to_vtk, vtk_to_numpy

IDS = {"uint32": (614454277, 614454278, 4294967295), "int32": (-2147483648, 2147483646, 2147483647), "uint64": (720575940621039145, 720575940621039146, 9223372036854775807),
       "int64": (-720575940621039146, -720575940621039145, 1 << 60), "float64": (2.0 ** 24 + 1, 2.0 ** 53 - 1, -123456789.0)}


def label_map(kind):
    voxels = np.zeros((12, 12, 12), kind)
    for n, number in enumerate(IDS[kind]):
        voxels[1 + 4 * n:4 + 4 * n, 2:10, 2:10] = number
    return voxels


def write_nrrd(path, voxels):
    nrrd.write(str(path), voxels.T)


def write_mha(path, voxels):
    SimpleITK.WriteImage(SimpleITK.GetImageFromArray(voxels), str(path))


def write_npy(path, voxels):
    np.save(path, voxels)


def write_tif(path, voxels):
    tifffile.imwrite(path, voxels, metadata={"axes": "ZYX"})


def write_vti(path, voxels):
    image = vtk.vtkImageData()
    image.SetDimensions(*voxels.shape[::-1])
    array = numpy_to_vtk(voxels.ravel(), deep=True)
    array.SetName("ids")
    image.GetPointData().SetScalars(array)
    writer = vtk.vtkXMLImageDataWriter()
    writer.SetInputData(image)
    writer.SetFileName(str(path))
    writer.Write()


def write_zarr(path, voxels):
    shutil.rmtree(path, ignore_errors=True)
    zarr.save_array(path, voxels, zarr_format=2)


def write_raw(path, voxels):
    voxels.tofile(path)


WRITERS = {"a.nrrd": write_nrrd, "a.mha": write_mha, "a.npy": write_npy, "a.tif": write_tif, "a.vti": write_vti, "a.zarr": write_zarr}


def test_numbers():
    for kind, ids in IDS.items():
        voxels = label_map(kind)
        whole = sorted(int(number) for number in ids)
        for name, write in WRITERS.items():
            path = root / name
            write(path, voxels)
            info, _, told = read(path)
            least, most = (int(min(0, *ids)), int(max(ids)))
            count("numbers in info", f"{kind}, {name}", "" if info and [int(x) for x in info["range"]] == [least, most] else (told, info and info["range"], least, most))
            for other, load in (("b.nrrd", lambda p: nrrd.read(str(p))[0].T), ("b.vti", read_vti)):
                told = run(PROGRAM, "convert", path, root / other)
                back = load(root / other) if told.returncode == 0 else None
                good = back is not None and back.dtype == voxels.dtype and np.array_equal(back, voxels)
                count("numbers by convert", f"{kind}, {name} to {other}", "" if good else (told.stderr, back is not None and (back.dtype, np.unique(back))))
            told = run(PROGRAM, "convert", path, root / "s.nrrd", "--shrink", "2")
            shrunk = nrrd.read(str(root / "s.nrrd"))[0] if told.returncode == 0 else np.zeros(1)
            count("numbers by convert", f"{kind}, {name} shrunk", "" if set(np.unique(shrunk).tolist()) <= {0, *ids} and len(np.unique(shrunk)) == 4 else (told.stderr, np.unique(shrunk)))
            scene = run(PROGRAM, "render", path, "--print-scene")
            shown = [one["value"] for one in json.loads(scene.stdout)["volumes"][0].get("labels", [])] if scene.returncode == 0 else scene.stderr
            count("numbers of labels", f"{kind}, {name}", "" if shown == whole else shown)
        (root / "table.csv").write_text("".join(f"{number},name {n},{n},20,30\n" for n, number in enumerate(whole)))
        scene = run(PROGRAM, "render", root / "a.nrrd", "--label-table", root / "table.csv", "--show", f"{whole[1]}=red:0.5", "--print-scene")
        shown = [(one["value"], one["name"], one["opacity"]) for one in json.loads(scene.stdout)["volumes"][0]["labels"] if one["visible"]] if scene.returncode == 0 else scene.stderr
        count("numbers of labels", f"{kind}, by --show and a table", "" if shown == [(whole[1], "name 1", 0.5)] else shown)
        np.save(root / "scan.npy", np.random.RandomState(1).randint(0, 99, (12, 12, 12)).astype(np.uint8))
        scene = run(PROGRAM, "render", root / "scan.npy", "--mask", root / "a.nrrd", "--show", str(whole[0]), "--print-scene")
        shown = [one["value"] for one in json.loads(scene.stdout)["volumes"][0]["mask"]["labels"]] if scene.returncode == 0 else scene.stderr
        count("numbers of masks", kind, "" if shown == [whole[0]] else shown)
        (root / "scene.json").write_text(scene.stdout)
        drawn = run(PROGRAM, "render", root / "scene.json", "--print-scene")
        count("numbers of masks", f"{kind}, in a scene that is read again", "" if drawn.stdout == scene.stdout else drawn.stderr)


def read_vti(path):
    reader = vtk.vtkXMLImageDataReader()
    reader.SetFileName(str(path))
    reader.Update()
    image = reader.GetOutput()
    return vtk_to_numpy(image.GetPointData().GetArray(0)).reshape(image.GetDimensions()[::-1])


def test_tables():
    voxels = np.zeros((12, 12, 12), np.uint16)
    voxels[1:5, 2:10, 2:10], voxels[6:11, 2:10, 2:10] = 13, 42
    nrrd.write(str(root / "map.nrrd"), voxels.T)
    both = {13: ("left", (0, 128, 0)), 42: ("right", (0, 0, 255))}
    snap = "################\n# ITK-SnAP Label Description File\n################\n    0     0    0    0        0  0  0    \"Clear Label\"\n"
    rows = {
        "FreeSurfer": "#No. Label Name:   R G B A\n\n0   Unknown  0 0 0 0\n13  left     0 128 0 0\n42  right  0 0 255 0\n",
        "a mark and CR LF": "\ufeff13 left 0 128 0 0\r\n42 right 0 0 255 0\r\n",
        "CR alone": "13 left 0 128 0 255\r42 right 0 0 255 255\r",
        "commas with a header": "label,name,r,g,b\n13,left,0,128,0\n42,right,0,0,255\n",
        "semicolons and quotes": "13;\"left\";0;128;0\n42;\"right\";0;0;255\n",
        "ITK-SNAP": snap + "   13     0  128    0        1  1  1    \"left\"\n   42     0    0  255        1  1  1    \"right\"\n",
        "ITK-SNAP by CR": (snap + "   13     0  128    0        1  1  1    \"left\"\n   42     0    0  255        1  1  1    \"right\"\n").replace("\n", "\r"),
        "BIDS": "index\tname\tabbreviation\tcolor\tmapping\n13\tleft\tL\t#008000\t1\n42\tright\tR\t#0000ff\t2\n",
        "BIDS, other order": "name\tcolor\tindex\nleft\t#008000\t13\nright\t#0000FF\t42\n",
        "BIDS with a mark": "\ufeffindex\tname\tcolor\r\n13\tleft\t#008000\r\n42\tright\t#0000ff\r\n",
        "Slicer": "# Color table file x.txt\n# 3 values\n0 Background 0 0 0 0\n13 left 0 128 0 255\n42 right 0 0 255 255\n",
        "commas and names with blanks": "label,name,r,g,b\n13,left,0,128,0\n42, right ,0,0,255\n",
        "tabs": "13\tleft\t0\t128\t0\t0\n42\t\tright\t0\t0\t255\t0\n",
        "tabs and blanks": "13\tleft   0 128 0 0\n42\tright  0 0 255 0\n",
        "fractions": "13 left 0.0 0.50196 0.0\n42 right 0.0 0.0 1.0\n"}
    for name, text in rows.items():
        path = root / ("dseg.tsv" if "BIDS" in name else "table.txt")
        path.write_bytes(text.encode())
        scene = run(PROGRAM, "render", root / "map.nrrd", "--label-table", path, "--print-scene")
        if scene.returncode != 0:
            count("tables", name, scene.stderr)
            continue
        labels = json.loads(scene.stdout)["volumes"][0]["labels"]
        linear = lambda c: c / 255 / 12.92 if c / 255 <= 0.04045 else ((c / 255 + 0.055) / 1.055) ** 2.4  # noqa: E731
        good = [(one["value"], one["name"]) for one in labels] == [(v, n) for v, (n, _) in both.items()] and all(
            np.allclose(one["color"], [linear(c) for c in both[one["value"]][1]], atol=2e-3) for one in labels)
        count("tables", name, "" if good else labels)
    hidden = snap + "   13     0  128    0        1  0  1    \"left\"\n   42     0    0  255      0.5  1  1    \"right: half\"\n"
    (root / "t.txt").write_text(hidden)
    for words, shows in (((), {42}), (("--show", "all"), {42}), (("--show", "left"), {13}), (("--show", "right: half"), {42}), (("--show", "right: half:0.25"), {42}), (("--show", "13,42=red"), {13, 42})):
        scene = run(PROGRAM, "render", root / "map.nrrd", "--label-table", root / "t.txt", *words, "--print-scene")
        shown = {one["value"] for one in json.loads(scene.stdout)["volumes"][0]["labels"] if one["visible"]} if scene.returncode == 0 else scene.stderr
        count("tables: visibility and names with a colon", " ".join(words) or "alone", "" if shown == shows else shown)
    for name, header in (("names and colours", {"Segment0_Name": "liver: left", "Segment0_LabelValue": "13", "Segment0_Layer": "0", "Segment0_Color": "1 0 0", "Segment1_Name": "spleen", "Segment1_LabelValue": "42",
                                                "Segment1_Color": "0 0.5 1"}),
                         ("values that rise otherwise", {"Segment0_Name": "b", "Segment0_LabelValue": "42", "Segment1_Name": "a", "Segment1_LabelValue": "13"}),
                         ("a label that is absent", {"Segment0_Name": "a", "Segment0_LabelValue": "13", "Segment1_Name": "none", "Segment1_LabelValue": "7"}),
                         ("numbers without 0", {"Segment5_Name": "a", "Segment5_LabelValue": "13", "Segment7_Name": "b", "Segment7_LabelValue": "42"}),
                         ("many properties", {"Segment0_ID": "Segment_1", "Segment0_Name": "a", "Segment0_NameAutoGenerated": "0", "Segment0_LabelValue": "13", "Segment0_Extent": "0 1 0 1 0 1",
                                              "Segment0_Tags": "Segmentation.Status:inprogress|", "Segmentation_MasterRepresentation": "Binary labelmap"})):
        nrrd.write(str(root / "x.seg.nrrd"), voxels.T, header)
        scene = run(PROGRAM, "render", root / "x.seg.nrrd", "--print-scene")
        names = {one["value"]: one.get("name") for one in json.loads(scene.stdout)["volumes"][0]["labels"]} if scene.returncode == 0 else scene.stderr
        wanted = {int(header[key.replace("_Name", "_LabelValue")]): value for key, value in header.items() if key.endswith("_Name")}
        wanted = {value: name for value, name in wanted.items() if value in (13, 42)}
        good = isinstance(names, dict) and set(names) == {13, 42} and all(names[value] == given for value, given in wanted.items())
        count("colours and names of .seg.nrrd", name, "" if good else (names, scene.stderr))


def test_several_files():
    """Channels of a microscope, modalities of an MR: several files with one volume each, one look each."""
    random = np.random.RandomState(2)
    for n in range(3):
        nrrd.write(str(root / f"c{n}.nrrd"), (random.randint(0, 300, (12, 12, 12)) + 100 * n).astype(np.uint16))
    files = [root / f"c{n}.nrrd" for n in range(3)]
    for name, words, volumes in (("two", files[:2], 2), ("three", files, 3), ("with labels", [*files[:2], "--labels", root / "map.nrrd"], 3), ("with a mask", [*files[:2], "--mask", root / "map.nrrd"], 2),
                                 ("with a look", [*files[:2], "--look", "mip"], 2)):
        scene = run(PROGRAM, "render", *words, "--print-scene")
        found = json.loads(scene.stdout)["volumes"] if scene.returncode == 0 else []
        count("several files", name, "" if len(found) == volumes else scene.stderr)


for test in (test_numbers, test_tables, test_several_files):
    test()
sys.exit(finish())
