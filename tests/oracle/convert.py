#!/usr/bin/python3
"""What `halflight convert` writes, as other programs read it: nibabel, VTK, Teem, and this program itself.

usage: convert.py DUMP_VOLUME HALFLIGHT
Voxels and the place of each in the body must be what they were, in every format and type; boxes and means are compared
with NumPy's. Exit 77: a judge is missing.
"""
import json
import pathlib
import shutil
import subprocess
import sys
import tempfile

try:
    import nibabel
    import numpy as np
    import vtk
    from vtk.util.numpy_support import vtk_to_numpy
except ImportError as absent:
    print("skipped:", absent)
    sys.exit(77)

DUMP, PROGRAM = sys.argv[1:3]
UNU = shutil.which("teem-unu") or shutil.which("unu")
SIZE = (7, 6, 5)  # k, j, i
SPACES = {"RAS": "right-anterior-superior", "LPS": "left-posterior-superior", "LAS": "left-anterior-superior"}
TO_RAS = {"RAS": [1, 1, 1], "LPS": [-1, -1, 1], "LAS": [-1, 1, 1], None: [1, 1, 1]}
problems = []
root = pathlib.Path(tempfile.mkdtemp(prefix="halflight-convert-"))


def check(name, condition, what=""):
    print("ok" if condition else "not ok", "-", name, "" if condition else f": {what}")
    if not condition:
        problems.append(name)


def write_nrrd(path, voxels, origin, axes, space):
    place = f"space: {SPACES[space]}\n" if space else "space dimension: 3\n"
    names = {"f": "float", "d": "double"}
    rows = " ".join("(%.17g,%.17g,%.17g)" % tuple(axis) for axis in axes.T)
    head = (f"NRRD0004\ntype: {names.get(voxels.dtype.char, voxels.dtype.name)}\ndimension: 3\n{place}"
            f"sizes: {voxels.shape[2]} {voxels.shape[1]} {voxels.shape[0]}\nspace directions: {rows}\n"
            "space origin: (%.17g,%.17g,%.17g)\nendian: little\nencoding: raw\n\n" % tuple(origin))
    path.write_bytes(head.encode() + voxels.tobytes())


def convert(source, target, *options):
    return subprocess.run([PROGRAM, "convert", "--quiet", str(source), str(target), *options], capture_output=True, text=True,
                          timeout=60)


def seen_by_us(path):
    out = root / "voxels"
    info = json.loads(subprocess.run([DUMP, str(path), str(out)], capture_output=True, timeout=60, check=True).stdout)
    space = json.loads(subprocess.run([PROGRAM, "info", "--json", str(path)], capture_output=True, timeout=60,
                                      check=True).stdout)["space"]
    axes = np.array(info["direction"]).reshape(3, 3) * info["spacing"]
    return np.fromfile(out).reshape(info["dimensions"][::-1]), np.array(info["origin"]), axes, space


def seen_by_nibabel(path):
    image = nibabel.load(path)
    return np.asarray(image.dataobj).T, image.affine[:3, 3], image.affine[:3, :3], "RAS"


def seen_by_vtk(path):
    reader = vtk.vtkXMLImageDataReader() if path.suffix == ".vti" else vtk.vtkMetaImageReader()
    reader.SetFileName(str(path))
    reader.Update()
    image = reader.GetOutput()
    values = vtk_to_numpy(image.GetPointData().GetScalars()).reshape(image.GetDimensions()[::-1])
    direction = np.array([[image.GetDirectionMatrix().GetElement(r, c) for c in range(3)] for r in range(3)])
    return values, np.array(image.GetOrigin()), direction * image.GetSpacing(), None


def seen_by_teem(path):
    raw = root / "teem.raw"
    subprocess.run([UNU, "save", "-f", "nrrd", "-e", "raw", "-i", str(path), "-o", str(raw)], check=True, capture_output=True)
    head, _, voxels = raw.read_bytes().partition(b"\n\n")
    fields = dict(line.split(": ", 1) for line in head.decode().splitlines() if ": " in line)
    kinds = {"unsigned char": "u1", "signed char": "i1", "unsigned short": "u2", "short": "i2", "unsigned int": "u4",
             "int": "i4", "float": "f4", "double": "f8", "unsigned long long int": "u8", "long long int": "i8"}
    sizes = [int(n) for n in fields["sizes"].split()][::-1]
    axes = np.array([eval(vector) for vector in fields["space directions"].split()]).T
    space = {name: key for key, name in SPACES.items()}.get(fields.get("space"))
    return np.frombuffer(voxels, kinds[fields["type"]]).reshape(sizes), np.array(eval(fields["space origin"])), axes, space


def judge(name, seen, wanted, has_space, tolerance=1e-6, with_place=True):
    values, origin, axes, space = seen
    voxels, wanted_origin, wanted_axes, wanted_space = wanted
    same = values.shape == voxels.shape and np.array_equal(values.astype(float), voxels.astype(float), equal_nan=True)
    check(f"{name}: voxels", same, (values.shape, voxels.shape))
    if not with_place:
        return
    if has_space:  # compare places in the body
        turn, wanted_turn = np.diag(TO_RAS[space]), np.diag(TO_RAS[wanted_space])
        origin, axes, wanted_origin, wanted_axes = turn @ origin, turn @ axes, wanted_turn @ wanted_origin, \
            wanted_turn @ wanted_axes
    check(f"{name}: place", np.allclose(origin, wanted_origin, rtol=tolerance, atol=tolerance) and
          np.allclose(axes, wanted_axes, rtol=tolerance, atol=tolerance), (origin, wanted_origin, axes, wanted_axes))


def voxels_of(kind):
    random = np.random.default_rng(5)
    if kind.startswith("float"):
        voxels = random.normal(0, 100, SIZE).astype("float32").astype(kind)
        voxels[1, 2, 3] = np.nan
        return voxels
    limits = np.iinfo(kind)
    return random.integers(max(limits.min, -2**23), min(limits.max, 2**23), SIZE).astype(kind)


def test_formats():
    origin, axes = np.array([-12.5, 3.25, 100]), np.array([[0.5, 0.25, 0], [-0.25, 1, 0.125], [0, 0.5, -2]])
    for space in ("RAS", "LPS", "LAS", None):
        for kind in ("uint8", "int8", "uint16", "int16", "uint32", "int32", "float32", "float64"):
            if space not in ("LPS", None) and kind != "int16":
                continue
            wanted = voxels_of(kind), origin, axes, space
            source = root / "source.nrrd"
            write_nrrd(source, *wanted)
            for ending, judges in ((".nrrd", [seen_by_teem] if UNU else []), (".nii", [seen_by_nibabel]),
                                   (".nii.gz", [seen_by_nibabel]), (".mha", [seen_by_vtk]), (".vti", [seen_by_vtk])):
                target = root / f"target{ending}"
                told = convert(source, target)
                check(f"{kind} {space} as {ending}", told.returncode == 0, told.stderr)
                for seen in [seen_by_us] + judges:
                    by_vtk_mha = seen is seen_by_vtk and ending == ".mha"  # it does not read directions
                    anatomical = ending != ".vti" and space is not None
                    judge(f"{kind} {space} as {ending}, {seen.__name__}", seen(target), wanted, anatomical,
                          with_place=not by_vtk_mha)
                if ending != ".vti" and space in ("RAS", "LPS"):
                    check("the space is told", seen_by_us(target)[3] is not None)


def test_tiff():
    try:
        import tifffile
    except ImportError:
        print("skipped: tifffile")
        return
    origin, axes = np.zeros(3), np.diag([0.3, 0.25, 1.7])
    for kind in ("uint8", "int8", "uint16", "int16", "uint32", "int32", "float32", "float64"):
        wanted = voxels_of(kind), origin, axes, None
        write_nrrd(root / "source.nrrd", *wanted)
        told = convert(root / "source.nrrd", root / "target.tif", "--unit", "um")
        check(f"{kind} as .tif", told.returncode == 0 and not told.stderr, told.stderr)
        judge(f"{kind} as .tif, seen by us", seen_by_us(root / "target.tif"), wanted, False)
        with tifffile.TiffFile(root / "target.tif") as file:
            spacing = [page.tags[tag].value[1] / page.tags[tag].value[0] for page in file.pages for tag in ("XResolution", "YResolution")]
            check(f"{kind} as .tif: pages", file.is_imagej and len(file.pages) == SIZE[0], len(file.pages))
            check(f"{kind} as .tif: lengths", np.allclose(spacing, [0.3, 0.25] * SIZE[0], rtol=1e-8)
                  and file.imagej_metadata["spacing"] == 1.7 and file.imagej_metadata["unit"] == "um", (spacing, file.imagej_metadata))
            check(f"{kind} as .tif: voxels", np.array_equal(file.asarray(), wanted[0], equal_nan=True))


def test_mrc():
    axes = np.array([[2, 0.5, 0.25], [0, 3, -0.5], [0, 0, 4]])
    for kind in ("uint8", "int8", "uint16", "int16", "float32"):
        wanted = voxels_of(kind), np.array([-1, 2, 30]), axes, None
        write_nrrd(root / "source.nrrd", *wanted)
        for ending in (".mrc", ".mrc.gz"):
            told = convert(root / "source.nrrd", root / f"t{ending}")
            check(f"{kind} as {ending}", told.returncode == 0, told.stderr)
            judge(f"{kind} as {ending}", seen_by_us(root / f"t{ending}"), wanted, False, 1e-5)
    write_nrrd(root / "source.nrrd", voxels_of("int16"), np.zeros(3), axes[:, [1, 0, 2]], None)
    told = convert(root / "source.nrrd", root / "t.mrc")
    check("a turned grid is no MRC map", told.returncode == 4 and not (root / "u.mrc").exists(), told)


def test_boxes_and_means():
    voxels = voxels_of("int16")
    origin, axes = np.array([1, 2, 3]), np.diag([2.0, 3, 4])
    write_nrrd(root / "source.nrrd", voxels, origin, axes, None)
    told = convert(root / "source.nrrd", root / "t.nrrd", "--crop", "i=1:4", "--crop", "k=2:", "--crop", "j=:5")
    check("a box", told.returncode == 0, told.stderr)
    judge("a box", seen_by_us(root / "t.nrrd"), (voxels[2:, :5, 1:4], origin + [2, 0, 8], axes, None), False)
    for options, kind in ((["--type", "float64"], float), ([], "int16")):
        convert(root / "source.nrrd", root / "t.nrrd", "--shrink", "2", "--crop", "i=1:5", "--crop", "k=1:", "--crop", "j=:5",
                *options)
        part = voxels[1:, :5, 1:5].astype(float)
        means = np.stack([[[part[k:k + 2, j:j + 2, i:i + 2].mean() for i in (0, 2)] for j in (0, 2, 4)] for k in (0, 2, 4)])
        wanted = np.floor(means + 0.5) if kind == "int16" else means
        judge(f"means, {kind}", seen_by_us(root / "t.nrrd"), (wanted.astype("float32"), origin + [2 + 1, 1.5, 4 + 2],
                                                              axes * 2, None), False)


def test_means_of_a_ramp():
    """The mean of a linear function over a box is its value at the box's middle: exactly, wherever the box lies in the world."""
    origin, axes = np.array([-3, 8.5, 40]), np.array([[0.5, 0.25, 0], [-0.25, 1, 0.125], [0, 0.5, -2]])

    def ramp(origin, axes, shape):
        index = np.stack(np.indices(shape)[::-1], -1).astype(float)
        return (index @ axes.T + origin) @ [2, -3, 5] + 100

    shape = (12, 8, 16)
    write_nrrd(root / "source.nrrd", ramp(origin, axes, shape), origin, axes, "LPS")
    for n in (1, 2, 4):
        told = convert(root / "source.nrrd", root / "t.nrrd", "--shrink", str(n))
        check(f"a ramp shrunk by {n}", told.returncode == 0, told.stderr)
        for seen in [seen_by_us] + ([seen_by_teem] if UNU else []):
            values, new_origin, new_axes, space = seen(root / "t.nrrd")
            check(f"a ramp shrunk by {n}, {seen.__name__}: its values where they lie",
                  values.shape == tuple(s // n for s in shape) and space == "LPS" and np.array_equal(new_axes, axes * n) and
                  np.array_equal(values, ramp(new_origin, new_axes, values.shape)), np.abs(values - ramp(new_origin, new_axes, values.shape)).max())
            check(f"a ramp shrunk by {n}, {seen.__name__}: its mean", values.mean() == ramp(origin, axes, shape).mean())


def test_units():
    """Lengths keep their unit where a format can tell it, and are turned into the one unit of a format that has no other."""
    kinds = {"um": ("micrometre", "micron", 1e4, 1), "mm": ("millimetre", "mm", 1e7, 1), "m": ("metre", "meter", 1e10, 1),
             "A": ("angstrom", "micron", 1, 1e-4)}
    origin, axes = np.array([1, 2.5, -3]), np.diag([0.25, 0.5, 2])
    told = lambda path: json.loads(subprocess.run([PROGRAM, "info", "--json", path], capture_output=True, check=True,  # noqa: E731
                                                  timeout=60).stdout).get("unit")
    for word, (unit, nifti_unit, to_angstrom, to_nifti) in kinds.items():
        write_nrrd(root / "source.nrrd", voxels_of("int16"), origin, axes, "RAS")
        text = (root / "source.nrrd").read_bytes()
        (root / "source.nrrd").write_bytes(text.replace(b"endian:", b'space units: "%s" "%s" "%s"\nendian:' % ((word.encode(),) * 3), 1))
        check(f"{word} is read", told(root / "source.nrrd") == unit, told(root / "source.nrrd"))
        for ending, factor in ((".nrrd", 1), (".nii", to_nifti), (".mrc", to_angstrom)):
            target = root / f"t{ending}"
            convert(root / "source.nrrd", target)
            _, new_origin, new_axes, _ = seen_by_us(target)
            check(f"{word} as {ending}", np.allclose(new_axes, axes * factor, rtol=1e-6) and np.allclose(new_origin, origin * factor, rtol=1e-6),
                  (new_axes, new_origin))
        check(f"{word} is written: NRRD", told(root / "t.nrrd") == unit and b'space units: "%s" ' % word.encode() in (root / "t.nrrd").read_bytes())
        check(f"{word} is written: NIfTI", nibabel.load(root / "t.nii").header.get_xyzt_units()[0] == nifti_unit)
        check(f"{word} is written: MRC", told(root / "t.mrc") == "angstrom")
    for wrong in (b'"mm" "mm" "um"', b'"mm" "mm"', b"mm mm mm", b'"parsec" "parsec" "parsec"', b'"' + 300 * b"m"):
        (root / "source.nrrd").write_bytes(text.replace(b"endian:", b"space units: " + wrong + b"\nendian:", 1))
        check(f"no unit: {wrong[:20]}", told(root / "source.nrrd") is None)


def test_types():
    values = np.array([-3e9, -129, -128.5, -0.5, 0, 0.49, 0.5, 254.6, 255.4, 65535, 65519, 65521, 6.1e-5, 3e-8, 1e-9, 2.5,
                       np.nan, np.inf], "float32").reshape(1, 2, 9)
    write_nrrd(root / "source.nrrd", values, np.zeros(3), np.eye(3), None)
    for kind in ("uint8", "int8", "uint16", "int16", "uint32", "int32", "uint64", "int64"):
        told = subprocess.run([PROGRAM, "convert", root / "source.nrrd", root / "t.nrrd", "--type", kind], capture_output=True,
                              text=True)
        limits = np.iinfo(kind)
        wanted = np.clip(np.floor(np.nan_to_num(values.astype(float), posinf=0) + 0.5), float(limits.min),
                         float(limits.max))
        found = seen_by_us(root / "t.nrrd")[0]
        check(f"rounded to {kind}", np.allclose(found, wanted, rtol=2e-7, atol=0), (found, wanted))
        check(f"warnings of {kind}", "2 values are not finite" in told.stderr and
              ("beyond the range" in told.stderr) == (kind != "int64"), told)
        convert(root / "source.nrrd", root / "t.npy", "--type", kind)
        array = np.load(root / "t.npy")
        check(f"NumPy's array of {kind}", array.dtype == kind and array.shape == values.shape and np.allclose(array.astype(float), wanted, rtol=2e-7, atol=0), array)
    convert(root / "source.nrrd", root / "t.npy")
    check("NumPy's array of floats", np.array_equal(np.load(root / "t.npy"), values, equal_nan=True))
    check("the voxels of the array are aligned", (root / "t.npy").stat().st_size - values.nbytes == 128)
    name = root / "x_9x2x1_float16.raw"
    check("half floats are written", convert(root / "source.nrrd", name, "--type", "float16").returncode == 0)
    with np.errstate(over="ignore"):
        check("the nearest half floats", np.array_equal(np.fromfile(name, "float16").view("u2"),
                                                        values.astype("float16").ravel().view("u2")),
              np.fromfile(name, "float16"))
    told = convert(root / "source.nrrd", root / "t.mrc", "--type", "uint8")
    check("a type that the format has not", told.returncode == 2 and "hold no uint8" in told.stderr, told)
    for options in (["--crop", "i=3:2"], ["--crop", "x=1:2"], ["--crop", "i=1"], ["--crop", "i=0:10"], ["--shrink", "0"]):
        check(f"refused: {options}", convert(root / "source.nrrd", root / "no.nrrd", *options).returncode == 2 and
              not (root / "no.nrrd").exists())
    check("OUT is IN", convert(root / "source.nrrd", root / "source.nrrd").returncode == 2)


test_formats()
test_tiff()
test_mrc()
test_boxes_and_means()
test_means_of_a_ramp()
test_units()
test_types()
shutil.rmtree(root)
print(f"{len(problems)} problems")
sys.exit(1 if problems else 0)
