#!/usr/bin/python3
"""Compares the volume formats voxel for voxel with other readers and writers of the same files.

usage: volumes.py DUMP_VOLUME [DATA_FOLDER]

Teem (teem-unu), nibabel and VTK write files in many variants, and read the real data sets; dump_volume must
see the same dimensions, type, placement, statistics and voxels. Exit 0: all agree; 1: some do not; 77: a
judge is missing.
"""
import gzip
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import warnings

try:
    import nibabel
    import numpy as np
    import vtk
    from vtk.util.numpy_support import numpy_to_vtk, vtk_to_numpy
except ImportError as absent:
    print("skipped:", absent)
    sys.exit(77)

UNU = shutil.which("teem-unu") or shutil.which("unu")
if UNU is None:
    print("skipped: teem-unu is not installed")
    sys.exit(77)

TYPES = ["uint8", "int8", "uint16", "int16", "uint32", "int32", "float32", "float64", "uint64", "int64"]
NAMES = TYPES + ["float16"]
SHAPE = (5, 4, 3)  # k, j, i: unequal, so that no two axes can be confused


class Case:
    """A file, and what its judge says about it: voxels [k][j][i], and origin and axes of the grid."""

    def __init__(self, path, voxels=None, origin=(0, 0, 0), axes=None, kind=None, status=0):
        self.path, self.voxels, self.status, self.kind = path, voxels, status, kind
        self.origin = np.asarray(origin, float)
        self.axes = np.eye(3) if axes is None else np.asarray(axes, float)  # columns


def sample(kind, seed=1):
    """Voxels that use the whole range of a type; NaN and infinities too."""
    random = np.random.default_rng(seed)
    if kind.startswith("float"):
        voxels = random.normal(0, 1000, SHAPE).astype(kind)
        voxels[1, 2, 0], voxels[0, 3, 2], voxels[4, 0, 1] = np.nan, np.inf, -np.inf
        return voxels
    limits = np.iinfo(kind)
    voxels = random.integers(limits.min, limits.max, SHAPE, dtype=kind, endpoint=True)
    voxels.flat[:2] = limits.min, limits.max
    return voxels


def oblique():
    """A left-handed, sheared placement: origin and axes as columns."""
    return np.array([-12.5, 3.25, 100]), np.array([[0.5, 0.25, 0], [-0.25, 1, 0.125], [0, 0.5, -2]])


# ---------------------------------------------------------------- writers


def unu(*arguments):
    subprocess.run([UNU, *arguments], check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


def teem_cases(folder):
    names = dict(zip(TYPES, ["uchar", "signed char", "ushort", "short", "uint", "int", "float", "double",
                             "unsigned long long", "long long"]))
    origin, axes = oblique()
    for kind in TYPES:
        voxels = sample(kind)
        raw = os.path.join(folder, kind + ".raw")
        voxels.tofile(raw)
        plain = os.path.join(folder, kind + "_source.nrrd")
        directions = " ".join("(%g,%g,%g)" % tuple(axes[:, axis]) for axis in range(3))
        unu("make", "-i", raw, "-t", names[kind], "-s", "3", "4", "5", "-en", "little", "-spc", "RAS",
            "-orig", "(%g,%g,%g)" % tuple(origin), "-dirs", directions, "-o", plain)
        for encoding in "raw", "gzip", "ascii", "hex":
            for endian in ("little", "big") if encoding != "ascii" else ("little",):
                for ending in "nrrd", "nhdr":
                    path = os.path.join(folder, "%s_%s_%s.%s" % (kind, encoding, endian, ending))
                    unu("save", "-f", "nrrd", "-e", encoding, "-en", endian, "-i", plain, "-o", path)
                    expected = voxels
                    if encoding == "ascii" and kind == "float32":  # what Teem itself makes of its digits
                        back = os.path.join(folder, "back.nrrd")
                        unu("save", "-f", "nrrd", "-e", "raw", "-en", "little", "-i", path, "-o", back)
                        with open(back, "rb") as file:
                            expected = np.frombuffer(file.read()[-voxels.nbytes:], "<f4").reshape(SHAPE)
                    yield Case(path, expected, origin, axes, kind)
        spaced = os.path.join(folder, kind + "_spaced.nrrd")
        unu("make", "-i", raw, "-t", names[kind], "-s", "3", "4", "5", "-en", "little",
            "-sp", "0.5", "nan", "3", "-o", spaced)
        yield Case(spaced, voxels, axes=np.diag([0.5, 1, 3]), kind=kind)


def nibabel_cases(folder):
    for image_class, version in (nibabel.Nifti1Image, 1), (nibabel.Nifti2Image, 2):
        for kind in TYPES:
            for endian in "<", ">":
                for ending in ".nii", ".nii.gz", "_pair.hdr":
                    for placement in "sform", "qform", "qform_left", "both":
                        name = "%s_%d_%s_%s%s" % (kind, version, "lb"[endian == ">"], placement, ending)
                        yield nifti_case(os.path.join(folder, name), image_class, kind, endian, placement)
    header = nibabel.Nifti1Header()
    header.set_data_dtype("int16")
    scaled = nibabel.Nifti1Image(sample("int16"), np.diag([1, 2, 3, 1]), header)
    for slope, intercept in (0.25, -100), (-3, 7), (np.nan, np.nan), (1, 0):
        path = os.path.join(folder, "scaled_%g.nii" % slope)
        nibabel.save(scaled, path)
        with open(path, "r+b") as file:  # nibabel would choose its own
            file.seek(112)
            file.write(np.array([slope, intercept], "<f4").tobytes())
        image = nibabel.load(path)
        yield Case(path, np.asanyarray(image.dataobj).transpose(), image.affine[:3, 3],
                   image.affine[:3, :3], "int16")
    series = os.path.join(folder, "series.nii")
    steps = np.stack([sample("uint8", seed).transpose() for seed in (1, 2)], axis=-1)
    nibabel.save(nibabel.Nifti1Image(steps, np.eye(4)), series)
    yield Case(series, sample("uint8"), kind="uint8")  # the first of a series
    single = os.path.join(folder, "single.nii")
    voxels = sample("uint8")
    nibabel.save(nibabel.Nifti1Image(voxels.transpose()[..., None], np.eye(4)), single)
    yield Case(single, voxels, kind="uint8")


def nifti_case(path, image_class, kind, endian, placement):
    voxels = sample(kind)
    if path.endswith(".hdr"):
        image_class = nibabel.Nifti1Pair if image_class is nibabel.Nifti1Image else nibabel.Nifti2Pair
    header = image_class.header_class(endianness=endian)
    header.set_data_dtype(np.dtype(kind).newbyteorder(endian))
    origin, axes = oblique()
    affine = np.eye(4)
    affine[:3, :3], affine[:3, 3] = axes, origin
    turn = np.array([[0.36, 0.48, -0.8], [-0.8, 0.6, 0], [0.48, 0.64, 0.6]])
    rigid = np.eye(4)
    rigid[:3, :3] = turn @ np.diag([0.5, 2, -3 if placement == "qform_left" else 3])
    rigid[:3, 3] = origin
    image = image_class(voxels.transpose(), None, header)
    has_sform, has_qform = placement in ("sform", "both"), placement != "sform"
    image.header.set_sform(affine if has_sform else None, int(has_sform))
    image.header.set_qform(rigid if has_qform else None, int(has_qform))
    image.update_header = lambda: None
    nibabel.save(image, path)
    back = nibabel.load(path)
    assert back.header.endianness == endian
    return Case(path, np.asanyarray(back.dataobj).transpose(), back.affine[:3, 3], back.affine[:3, :3], kind)


def vtk_image(voxels, extent_start=(0, 0, 0), direction=None, cells=False):
    image = vtk.vtkImageData()
    k, j, i = np.array(voxels.shape) + (1 if cells else 0)
    x, y, z = extent_start
    image.SetExtent(x, x + int(i) - 1, y, y + int(j) - 1, z, z + int(k) - 1)
    image.SetOrigin(-12.5, 3.25, 100)
    image.SetSpacing(0.5, 1.25, 3)
    if direction is not None:
        image.SetDirectionMatrix([float(value) for value in direction.flat])
    array = numpy_to_vtk(voxels.ravel(), deep=True)
    array.SetName("density")
    (image.GetCellData() if cells else image.GetPointData()).SetScalars(array)
    return image


def vtk_world(image, cells=False):
    """Origin and axes of the first voxel, by VTK's own transformation."""
    first = np.array(image.GetExtent()[::2], float) + (0.5 if cells else 0)
    points = [np.zeros(3) for _ in range(4)]
    image.TransformContinuousIndexToPhysicalPoint(first, points[0])
    for axis in range(3):
        image.TransformContinuousIndexToPhysicalPoint(first + np.eye(3)[axis], points[axis + 1])
    return points[0], np.stack([points[axis + 1] - points[0] for axis in range(3)], axis=1)


def write_vti(path, image, mode="Appended", compressor="ZLib", big=False, wide=False, encode=True,
              block=None):
    writer = vtk.vtkXMLImageDataWriter()
    writer.SetFileName(path)
    writer.SetInputData(image)
    getattr(writer, "SetDataModeTo" + mode)()
    getattr(writer, "SetCompressorTypeTo" + compressor)()
    getattr(writer, "SetByteOrderTo" + ("BigEndian" if big else "LittleEndian"))()
    getattr(writer, "SetHeaderTypeToUInt" + ("64" if wide else "32"))()
    writer.SetEncodeAppendedData(encode)
    if block:
        writer.SetBlockSize(block)
    assert writer.Write() == 1


def vti_cases(folder):
    turn = np.array([[0.36, 0.48, -0.8], [-0.8, 0.6, 0], [0.48, 0.64, 0.6]])
    for kind in TYPES:
        voxels = sample(kind)
        finite = np.nan_to_num(voxels, posinf=5, neginf=-5) if kind.startswith("float") else voxels
        image = vtk_image(voxels, (2, -1, 5), turn)
        origin, axes = vtk_world(image)
        text = os.path.join(folder, kind + "_ascii.vti")
        write_vti(text, vtk_image(finite, (2, -1, 5), turn), "Ascii")
        yield Case(text, read_vti(text)[0], origin, axes, kind)
        for mode, encode in ("Binary", True), ("Appended", True), ("Appended", False):
            for compressor in "None", "ZLib":
                for big in False, True:
                    for wide in False, True:
                        name = "%s_%s_%d_%s_%d_%d.vti" % (kind, mode, encode, compressor, big, wide)
                        path = os.path.join(folder, name)
                        write_vti(path, image, mode, compressor, big, wide, encode)
                        yield Case(path, voxels, origin, axes, kind)
    large = np.random.default_rng(2).integers(0, 9, (31, 33, 35)).astype("int16")
    for mode in "Binary", "Appended":
        for block in 1024, 35 * 33 * 31 * 2, 1 << 20:
            path = os.path.join(folder, "blocks_%s_%d.vti" % (mode, block))
            write_vti(path, vtk_image(large), mode, block=block)
            yield Case(path, large, *vtk_world(vtk_image(large)), "int16")
    cells = vtk_image(sample("uint8"), (1, 2, 3), turn, cells=True)
    path = os.path.join(folder, "cells.vti")
    write_vti(path, cells)
    yield Case(path, sample("uint8"), *vtk_world(cells, cells=True), "uint8")
    yield from several_arrays(folder)
    for compressor in "LZ4", "LZMA":
        path = os.path.join(folder, compressor + ".vti")
        write_vti(path, image := vtk_image(sample("uint8")), compressor=compressor)
        yield Case(path, sample("uint8"), *vtk_world(image), "uint8")


def several_arrays(folder):
    """The active scalars are wanted, wherever they stand; without, the first array of one component."""
    image = vtk_image(sample("uint8"))
    directions = np.random.default_rng(5).normal(0, 9, (*SHAPE, 3)).astype("float32")
    vectors = numpy_to_vtk(directions.reshape(-1, 3), deep=True)
    vectors.SetName("vectors")
    other = numpy_to_vtk(sample("int32", 3).ravel(), deep=True)
    other.SetName("other")
    image.GetPointData().AddArray(vectors)
    image.GetPointData().AddArray(other)
    world = vtk_world(image)
    for mode in "Ascii", "Binary", "Appended":
        path = os.path.join(folder, "active_%s.vti" % mode)
        image.GetPointData().SetActiveScalars("other")
        write_vti(path, image, mode)
        yield Case(path, sample("int32", 3), *world, "int32")
        path = os.path.join(folder, "first_%s.vti" % mode)
        image.GetPointData().SetActiveScalars(None)
        write_vti(path, image, mode)
        yield Case(path, sample("uint8"), *world, "uint8")
    image.GetPointData().SetActiveScalars("vectors")
    path = os.path.join(folder, "vectors.vti")
    write_vti(path, image)
    # Added up one by one in floats, as the voxels are.
    magnitude = np.abs(directions[..., 0])
    for part in directions[..., 1], directions[..., 2]:
        magnitude = np.sqrt(magnitude.astype(float) ** 2 + part.astype(float) ** 2).astype("float32")
    yield Case(path, magnitude, *world, "float32")


def legacy_cases(folder):
    for kind in TYPES:
        for mode in "ASCII", "Binary":
            for active in True, False:
                path = os.path.join(folder, "%s_%s_%d.vtk" % (kind, mode, active))
                voxels = sample(kind)
                if kind.startswith("float") and mode == "ASCII":
                    voxels = np.nan_to_num(voxels, posinf=5, neginf=-5)
                image = vtk.vtkStructuredPoints()
                image.DeepCopy(vtk_image(voxels))
                vectors = numpy_to_vtk(np.ones((60, 3), "float64"), deep=True)
                vectors.SetName("vectors")
                image.GetPointData().AddArray(vectors)
                if not active:
                    image.GetPointData().SetActiveScalars(None)
                writer = vtk.vtkStructuredPointsWriter()
                getattr(writer, "SetFileTypeTo" + mode)()
                writer.SetInputData(image)
                writer.SetFileName(path)
                assert writer.Write() == 1
                yield Case(path, read_legacy(path)[0], *vtk_world(image), kind)


def numpy_cases(folder):
    """What numpy writes, of every type, byte order, element order and version."""
    for kind in TYPES + ["float16", "bool"]:
        for order in "<", ">":
            for fortran in False, True:
                for version in (1, 0), (2, 0), (3, 0):
                    voxels = sample("uint8", 4) > 99 if kind == "bool" else sample("float32").astype(kind) \
                        if kind == "float16" else sample(kind)
                    path = os.path.join(folder, "%s_%s_%d_%d.npy" % (kind, "lb"[order == ">"], fortran, version[0]))
                    written = np.asarray(voxels, order="F" if fortran else "C").astype(np.dtype(kind).newbyteorder(order))
                    with open(path, "wb") as file:
                        np.lib.format.write_array(file, written, version)
                    yield Case(path, voxels, kind="uint8" if kind == "bool" else kind)
    for fortran in False, True:  # components at the end, and a series
        for name, parts, axis in ("components", 4, -1), ("series", 5, 0):
            steps = np.stack([sample("int16", seed) for seed in range(1, parts + 1)], axis=axis)
            path = os.path.join(folder, "%s_%d.npy" % (name, fortran))
            if name == "series":
                steps = np.repeat(steps, 2, axis=-1)  # a last axis of 3 would be components
            np.save(path, np.asarray(steps, order="F" if fortran else "C"))
            expected = sample("int16")
            yield Case(path, np.repeat(expected, 2, axis=-1) if name == "series" else expected, kind="int16")
    complex_path = os.path.join(folder, "complex.npy")
    np.save(complex_path, np.full(SHAPE, 3 + 4j, "complex64") * np.arange(60).reshape(SHAPE))
    yield Case(complex_path, 5 * np.arange(60.0).reshape(SHAPE), kind="float32")


def meta_cases(folder):
    for kind in TYPES[:8]:  # VTK writes no 64 bit integers here
        for ending in "mha", "mhd":
            for compress in True, False:
                path = os.path.join(folder, "%s_%d.%s" % (kind, compress, ending))
                image = vtk_image(sample(kind))
                writer = vtk.vtkMetaImageWriter()
                writer.SetInputData(image)
                writer.SetFileName(path)
                if ending == "mhd":
                    writer.SetRAWFileName(path[:-4] + (".zraw" if compress else ".raw"))
                writer.SetCompression(compress)
                writer.Write()
                yield Case(path, sample(kind), *vtk_world(image), kind)


# ---------------------------------------------------------------- readers of the real data sets


def image_of(reader, path):
    reader.SetFileName(path)
    reader.Update()
    image = reader.GetOutput()
    scalars = image.GetPointData().GetScalars() or image.GetPointData().GetArray(0)
    i, j, k = image.GetDimensions()
    return vtk_to_numpy(scalars).reshape(k, j, i), *vtk_world(image)


def read_vti(path):
    return image_of(vtk.vtkXMLImageDataReader(), path)


def read_legacy(path):
    return image_of(vtk.vtkStructuredPointsReader(), path)


def read_meta(path):
    return image_of(vtk.vtkMetaImageReader(), path)


def read_nifti(path):
    image = nibabel.load(path)
    return np.asanyarray(image.dataobj).transpose(), image.affine[:3, 3], image.affine[:3, :3]


def read_raw(path):
    sizes, kind = re.search(r"(\d+x\d+x\d+)_([a-z]+\d+)\.raw", path).groups()
    shape = [int(size) for size in sizes.split("x")][::-1]
    with (gzip.open if path.endswith(".gz") else open)(path, "rb") as file:
        return np.frombuffer(file.read(), kind).reshape(shape), np.zeros(3), np.eye(3)


def read_nrrd(path):
    """Through Teem, which normalises the header; without a "space", which Teem wants, after giving it one."""
    with tempfile.TemporaryDirectory() as folder:
        source = path
        with open(path, "rb") as file:
            content = file.read()
        if b"space directions" in content[:2000] and b"\nspace:" not in content[:2000]:
            source = os.path.join(folder, "with_space.nrrd")
            with open(source, "wb") as file:
                file.write(content.replace(b"\nspace directions", b"\nspace: RAS\nspace directions", 1))
        target = os.path.join(folder, "plain.nhdr")
        unu("save", "-f", "nrrd", "-e", "raw", "-en", "little", "-i", source, "-o", target)
        with open(target, encoding="latin1") as file:
            fields = dict(re.findall(r"^([a-z ]+): (.*)$", file.read(), re.M))
        kind = {"unsigned char": "uint8", "short": "<i2", "float": "<f4"}[fields["type"]]
        voxels = np.fromfile(target.replace(".nhdr", ".raw"), kind)
    voxels = voxels.reshape([int(size) for size in fields["sizes"].split()][::-1])
    if "space directions" not in fields:
        return voxels, np.zeros(3), np.diag([float(spacing) for spacing in fields["spacings"].split()])
    vectors = [eval(vector) for vector in re.findall(r"\([^)]*\)", fields["space directions"])]
    return voxels, np.array(eval(fields["space origin"])), np.array(vectors, float).T


def real_cases(data):
    readers = {".nrrd": read_nrrd, ".mha": read_meta, ".mhd": read_meta, ".nii.gz": read_nifti,
               ".vti": read_vti, ".vtk": read_legacy, ".raw": read_raw, ".raw.gz": read_raw}
    for folder, _, names in sorted(os.walk(data)):
        for name in sorted(names):
            path = os.path.join(folder, name)
            reader = next((readers[ending] for ending in readers if name.endswith(ending)), None)
            if name == "skull.nrrd":
                yield Case(path, status=4)
            elif name.endswith(".dat"):
                raw = next(other for other in names if other.endswith(".raw"))
                yield Case(path, *read_raw(os.path.join(folder, raw)))
            elif reader is not None and (reader != read_raw or re.search(r"_[a-z]+\d+\.raw", name)):
                yield Case(path, *reader(path))


# ---------------------------------------------------------------- comparison


def differences(case, seen, voxels_path):
    """What dump_volume saw otherwise, as a list of lines."""
    if seen["status"] != case.status:
        return ["status %d, expected %d: %s" % (seen["status"], case.status, seen.get("error", ""))]
    if case.status != 0:
        return [] if os.path.basename(case.path) in seen["error"] else ["the error does not name the file"]
    expected = np.asarray(case.voxels)
    values = expected.astype(np.float64)
    if case.kind == "float64":  # fractions are kept as float32; what floats cannot hold is not finite
        with np.errstate(over="ignore"):
            floats = values.astype(np.float32).astype(np.float64)
            values = np.where((np.abs(values) >= 2**24) & np.isfinite(floats), values, floats)
    finite = values[np.isfinite(values)]
    scale = np.abs(finite).max() + 1e-300
    spacing = np.linalg.norm(case.axes, axis=0)
    checks = [
        ("dimensions", seen["dimensions"], expected.shape[::-1], 0),
        ("type", [NAMES.index(seen["type"])], [NAMES.index(case.kind or expected.dtype.name)], 0),
        ("spacing", seen["spacing"], spacing, 1e-6),
        ("origin", seen["origin"], case.origin, 1e-5),
        ("direction", seen["direction"], (case.axes / spacing).ravel(), 1e-6),
        ("range", seen["range"], [finite.min(), finite.max()], 1e-12 * scale),
        ("mean", seen["mean"], [finite.mean()], 1e-9 * scale),
        ("nonfinite_count", [seen["nonfinite_count"]], [values.size - finite.size], 0)]
    lines = ["%s %s, expected %s" % (name, found, list(wanted)) for name, found, wanted, tolerance in checks
             if len(found) != len(wanted) or np.abs(np.subtract(found, wanted)).max() > tolerance]
    found = np.fromfile(voxels_path)
    if found.size != values.size:
        return lines + ["%d voxels, expected %d" % (found.size, values.size)]
    found = found.reshape(values.shape)
    same = np.array_equal(np.isfinite(values), np.isfinite(found)) and \
        np.abs(found - values)[np.isfinite(values)].max() <= 1e-12 * scale
    return lines if same else lines + ["voxels differ"]


def run(program, name, cases):
    failures, count = 0, 0
    with tempfile.TemporaryDirectory() as folder:
        def check(batch):
            nonlocal failures, count
            arguments, paths = [], []
            for number, case in enumerate(batch):
                paths.append(os.path.join(folder, "%d.f64" % number))
                arguments += [case.path, paths[-1]]
            output = subprocess.run([program, *arguments], check=True, capture_output=True, text=True).stdout
            lines = output.splitlines()
            assert len(lines) == len(batch), output
            for case, line, path in zip(batch, lines, paths):
                for difference in differences(case, json.loads(line), path):
                    print("%s: %s" % (case.path, difference))
                    failures += 1
                count += 1
        batch, size = [], 0
        for case in cases:
            batch.append(case)
            size += 0 if case.voxels is None else np.asarray(case.voxels).size
            if size > 4e6 or len(batch) == 100:
                check(batch)
                batch, size = [], 0
        if batch:
            check(batch)
    print("%s: %d files, %d differences" % (name, count, failures), flush=True)
    return failures


def main():
    program = sys.argv[1]
    data = os.environ.get("HALFLIGHT_DATA") or (sys.argv[2] if len(sys.argv) > 2 else "")
    warnings.simplefilter("ignore")
    vtk.vtkObject.GlobalWarningDisplayOff()
    failures = 0
    for name, cases in (("Teem", teem_cases), ("nibabel", nibabel_cases), ("VTK image data", vti_cases),
                        ("VTK legacy", legacy_cases), ("MetaImage", meta_cases), ("NumPy", numpy_cases)):
        with tempfile.TemporaryDirectory() as folder:
            failures += run(program, name, cases(folder))
    if os.path.isdir(data):
        failures += run(program, "real data", real_cases(data))
    else:
        print("real data: skipped, there is no folder %r" % data)
    return 1 if failures else 0


sys.exit(main())
