#!/usr/bin/python3
"""Holds the DICOM reader against pydicom (its own test files), GDCM (every codec but HTJ2K), OpenJPH (HTJ2K) and dcm2niix
(geometry).

usage: dicom_judges.py DUMP_VOLUME [DATA_FOLDER]
Needs Debian's python3-pydicom, python3-gdcm, python3-nibabel, openjph-tools and dcm2niix, and no network. Prints a line for each file;
exit 1 if a value or a place differs.
"""
import glob
import json
import math
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import warnings

import gdcm
import nibabel
import numpy as np
import pydicom
from pydicom.dataset import FileDataset, FileMetaDataset
from pydicom.pixel_data_handlers.util import convert_color_space

warnings.filterwarnings("ignore")
pydicom.config.settings.reading_validation_mode = pydicom.config.IGNORE
DUMP = sys.argv[1]
folder = pathlib.Path(tempfile.mkdtemp(prefix="halflight-judges-"))
wrong = 0


def read(path):
    told = subprocess.run([DUMP, str(path), str(folder / "voxels")], capture_output=True, timeout=60, text=True)
    info = json.loads(told.stdout)
    if "error" in info:
        return info, None
    return info, np.fromfile(folder / "voxels").reshape(info["dimensions"][::-1])


def tell(name, good, what):
    global wrong
    wrong += not good
    print("equal " if good else "DIFFER", name, what)


def judge_pixels(path, name):
    data = pydicom.dcmread(path, force=True)
    if not any(key in data for key in ("PixelData", "FloatPixelData", "DoubleFloatPixelData")):
        return
    info, found = read(path)
    try:
        wanted = data.pixel_array
    except Exception as reason:
        print("none  ", name, f"pydicom: {str(reason)[:60]}; here: {info.get('error', 'read')[-90:]}")
        return
    if found is None:
        print("not   ", name, info["error"][-110:])
        return
    syntax, tolerance = str(data.file_meta.TransferSyntaxUID), 1e-6
    if data.SamplesPerPixel == 3:
        if "YBR_FULL" in data.PhotometricInterpretation and not np.allclose(
                np.sqrt((wanted.astype(float) ** 2).sum(-1)).ravel(), found.ravel()):
            wanted = convert_color_space(wanted, data.PhotometricInterpretation, "RGB")
            tolerance = 0.01 if syntax.endswith(".4.50") else tolerance  # colours are rounded twice
        wanted = np.sqrt((wanted.astype(float) ** 2).sum(-1))
    else:
        wanted = wanted.astype(float)
        if data.PhotometricInterpretation == "MONOCHROME1" and data.Modality not in ("CT", "PT"):
            wanted = 2 ** data.BitsStored - 1 - wanted if data.PixelRepresentation == 0 else -1 - wanted
        slope = data.get("RescaleSlope", data.get("DoseGridScaling", 1))
        wanted = wanted * float(slope) + float(data.get("RescaleIntercept", 0))
    if wanted.size != found.size:
        tell(name, False, f"{wanted.shape} {found.shape}")
        return
    difference = np.nanmax(np.abs(wanted.ravel() - found.ravel()))
    allowed = tolerance * max(1, np.abs(wanted).max())
    if syntax.endswith(".4.51") and data.BitsStored > 8:
        allowed = 1  # the inverse transform of 12 bits is rounded once, or several times
    tell(name, difference <= allowed, f"by {difference:g}")


def write_slice(path, plane, position, orientation, number, series="1.2.3"):
    meta = FileMetaDataset()
    meta.TransferSyntaxUID = "1.2.840.10008.1.2.1"
    meta.MediaStorageSOPClassUID = "1.2.840.10008.5.1.4.1.1.4"
    meta.MediaStorageSOPInstanceUID = f"{series}.{number}"
    data = FileDataset(str(path), {}, file_meta=meta, preamble=b"\0" * 128)
    data.SOPClassUID, data.SOPInstanceUID = meta.MediaStorageSOPClassUID, meta.MediaStorageSOPInstanceUID
    data.Modality, data.SeriesInstanceUID, data.StudyInstanceUID = "MR", series, "1.2"
    data.SeriesNumber, data.InstanceNumber, data.PatientName = 1, number, "A"
    data.ImagePositionPatient = [round(float(x), 6) for x in position]
    data.ImageOrientationPatient = [float(x) for x in orientation]
    data.PixelSpacing, data.SliceThickness = [2, 1.75], 9
    data.Rows, data.Columns = plane.shape
    data.SamplesPerPixel, data.PhotometricInterpretation = 1, "MONOCHROME2"
    data.BitsAllocated = data.BitsStored = 8 * plane.itemsize
    data.HighBit, data.PixelRepresentation = data.BitsStored - 1, int(plane.dtype.kind == "i")
    data.PixelData = plane.tobytes()
    data.is_little_endian, data.is_implicit_VR = True, False
    data.save_as(str(path), write_like_original=False)


HTJ2K = {"HTJ2KLossless": "1.2.840.10008.1.2.4.201", "HTJ2KLosslessRPCL": "1.2.840.10008.1.2.4.202",
         "HTJ2K": "1.2.840.10008.1.2.4.203"}
for name, uid in HTJ2K.items():  # that pydicom's older versions do not know
    pydicom.uid.UID_dictionary.setdefault(uid, (name, "Transfer Syntax", "", "", name))


def pack_htj2k(path, codec):
    """Writes a file's plane anew as HTJ2K by OpenJPH, which reads unsigned pictures; returns what OpenJPH decodes."""
    data = pydicom.dcmread(path)
    plane = data.pixel_array
    (folder / "plane.pgm").write_bytes(b"P5 %d %d %d\n" % (*plane.shape[::-1], 2 ** data.BitsStored - 1) +
                                       plane.astype(">u2" if data.BitsStored > 8 else "u1").tobytes())
    options = ["-qstep", "0.01"] if codec == "HTJ2K" else ["-reversible", "true"]
    if codec == "HTJ2KLossless":
        options += ["-prog_order", "LRCP"]
    subprocess.run(["ojph_compress", "-i", folder / "plane.pgm", "-o", folder / "plane.j2c", *options],
                   capture_output=True, check=True)
    subprocess.run(["ojph_expand", "-i", folder / "plane.j2c", "-o", folder / "back.pgm"], capture_output=True, check=True)
    data.PixelData = pydicom.encaps.encapsulate([(folder / "plane.j2c").read_bytes()])
    data["PixelData"].VR = "OB"
    data["PixelData"].is_undefined_length = True
    data.file_meta.TransferSyntaxUID = HTJ2K[codec]
    data.save_as(str(path), write_like_original=False)
    back = (folder / "back.pgm").read_bytes()
    return np.frombuffer(back[-plane.nbytes:], ">u2" if plane.itemsize == 2 else "u1").reshape(plane.shape)


def judge_htj2k():
    noise = np.random.RandomState(4)
    for bits, shape in ((16, (37, 53)), (12, (64, 64)), (8, (21, 16)), (8, (130, 300))):
        smooth = np.add.outer(np.arange(shape[0]) ** 2, 3 * np.arange(shape[1])) + noise.randint(0, 9, shape)
        plane = (smooth % 2 ** bits).astype(np.uint8 if bits == 8 else np.uint16)
        for codec in HTJ2K:
            write_slice(folder / "packed", plane, (0, 0, 0), (1, 0, 0, 0, 1, 0), 1)
            wanted = pack_htj2k(folder / "packed", codec)
            info, found = read(folder / "packed")
            good = found is not None and np.array_equal(wanted, plane) == (codec != "HTJ2K")
            by = 0 if found is None else np.abs(found[0] - wanted).max()
            tell(f"{codec} of {bits} bits, {shape}, by OpenJPH", good and by <= (1 if codec == "HTJ2K" else 0),
                 info.get("error", f"by {by:g}"))


def judge_codecs():
    noise = np.random.RandomState(2)
    planes = {"int16": noise.randint(-1500, 3000, (37, 53)).astype(np.int16),
              "uint16": noise.randint(0, 65535, (20, 33)).astype(np.uint16),
              "uint8": noise.randint(0, 255, (21, 16)).astype(np.uint8)}
    for kind, plane in planes.items():
        write_slice(folder / "plain", plane, (0, 0, 0), (1, 0, 0, 0, 1, 0), 1)
        for codec in ("JPEGLosslessProcess14", "JPEGLosslessProcess14_1", "JPEGLSLossless", "JPEG2000Lossless", "RLELossless"):
            shutil.copy(folder / "plain", folder / "packed")
            assert pack(folder / "packed", codec)
            info, found = read(folder / "packed")
            tell(f"{codec} of {kind}", found is not None and np.array_equal(found[0], plane), info.get("error", ""))


def judge_geometry():
    c, s = math.cos(0.3), math.sin(0.3)
    twisted = (c, s, 0, -s * c, c * c, -s)
    cases = {"axial": ((1, 0, 0, 0, 1, 0), (0, 0, 4)), "downwards": ((1, 0, 0, 0, 1, 0), (0, 0, -4)),
             "turned": ((c, s, 0, -s, c, 0), (0, 0, 4)), "oblique": (twisted, 4 * np.cross(twisted[:3], twisted[3:])),
             "sagittal": ((0, 1, 0, 0, 0, -1), (3, 0, 0)), "coronal": ((1, 0, 0, 0, 0, -1), (0, -3, 0))}
    values = np.random.RandomState(3).randint(0, 4000, (9, 17, 13)).astype(np.int16)
    for name, (orientation, step) in cases.items():
        series = folder / name
        series.mkdir()
        for n, plane in enumerate(values):
            position = np.array([-10, 20, 5]) + n * np.array(step)
            write_slice(series / f"{n * 7 % 9}", plane, position, orientation, n + 1)
        subprocess.run(["dcm2niix", "-z", "n", "-f", name, "-o", str(folder), str(series)], capture_output=True, timeout=60)
        image = nibabel.load(folder / f"{name}.nii")
        info, found = read(series)
        place = np.array(info["direction"]).reshape(3, 3) * info["spacing"]
        indices = np.array(list(np.ndindex(*info["dimensions"])))
        world = (indices @ place.T + info["origin"]) * [-1, -1, 1]  # LPS to RAS
        there = (np.c_[world, np.ones(len(world))] @ np.linalg.inv(image.affine).T)[:, :3]
        voxels = np.rint(there).astype(int)
        inside = ((voxels >= 0) & (voxels < image.shape[:3])).all()
        off = np.abs(there - voxels).max()
        same = inside and np.array_equal(np.asarray(image.dataobj)[tuple(voxels.T)], found[tuple(indices[:, ::-1].T)])
        tell(f"{name} slices, by dcm2niix", bool(same and off < 1e-4), f"places differ by {off:.2g} voxels")


def pack(path, codec):
    if codec in HTJ2K:
        return pack_htj2k(path, codec) is not None
    reader, change, writer = gdcm.ImageReader(), gdcm.ImageChangeTransferSyntax(), gdcm.ImageWriter()
    reader.SetFileName(str(path))
    reader.Read()
    change.SetTransferSyntax(gdcm.TransferSyntax(getattr(gdcm.TransferSyntax, codec)))
    change.SetInput(reader.GetImage())
    change.Change()
    writer.SetFile(reader.GetFile())
    writer.SetImage(change.GetOutput())
    writer.SetFileName(str(path))
    return writer.Write()


def judge_series(data_folder):
    """Series made of real volumes: names shuffled, gantries tilted, two in a folder, each transfer syntax of GDCM."""
    axial, sagittal = (1, 0, 0, 0, 1, 0), (0, 1, 0, 0, 0, -1)
    cases = [("cranium_mha/cranium.mha", axial, (0, 0, 3), None), ("cranium_mha/cranium.mha", axial, (0, 0.8, 3), "RLELossless"),
             ("bonsai/bonsai.nrrd", axial, (0, 0, 1.5), "JPEG2000Lossless"), ("engine/*", axial, (0, 0, -1), "JPEGLosslessProcess14_1"),
             ("stroke_t1_nii/*.nii*", sagittal, (1.5, 0, 0), "JPEGLSLossless"),
             ("hipip_signed/*.nrrd", axial, (0, 0, 2), "JPEGLosslessProcess14"),
             ("headmr_mhd/*.mhd", axial, (0, -0.5, 4), "two series in one folder"),
             ("cranium_mha/cranium.mha", axial, (0, 0, 3), "JPEG2000Lossless"),
             ("stroke_t1_nii/*.nii*", sagittal, (1.5, 0, 0), "JPEG2000Lossless"),
             ("hipip_signed/*.nrrd", axial, (0, 0, 2), "JPEG2000Lossless"),
             ("engine/*", axial, (0, 0, 1), "HTJ2KLossless"), ("bonsai/bonsai.nrrd", axial, (0, 0, 1.5), "HTJ2KLosslessRPCL"),
             ("stroke_t1_nii/*.nii*", axial, (0, 0.3, 2), "HTJ2KLossless")]
    random = np.random.RandomState(7)
    for number, (pattern, orientation, step, codec) in enumerate(cases):
        paths = sorted(glob.glob(f"{data_folder}/{pattern}"))
        info, values = next(((i, v) for i, v in map(read, paths) if v is not None), (None, None))
        if values is None:
            print("absent", pattern)
            continue
        values = values[::2, ::2, ::2]
        planes = values.astype(np.int16 if values.min() < 0 else np.uint8 if values.max() < 256 else np.uint16)
        if not np.array_equal(planes, values):  # floats
            low, high = values.min(), values.max()
            planes = np.rint((values - low) / (high - low) * 4095).astype(np.uint16)
        series = folder / f"series{number}"
        series.mkdir()
        names = random.permutation(len(planes))
        for n, plane in enumerate(planes):
            path = series / f"IM{names[n]:04}"
            write_slice(path, plane, np.array([-10, 20, 5]) + n * np.array(step), orientation, n + 1)
            if codec is not None and "series" not in codec:
                assert pack(path, codec)
        if codec == "two series in one folder":
            for n in range(3):
                write_slice(series / f"A{n}", planes[n][:5, :7], np.array([0, 0, n]), axial, n + 1, "1.2.4")
        info, found = read(series)
        wanted = planes if np.dot(np.cross(orientation[:3], orientation[3:]), step) > 0 else planes[::-1]
        third = np.array(info.get("direction", [0] * 9)).reshape(3, 3)[:, 2] * info.get("spacing", [0] * 3)[2]
        same_step = np.allclose(np.abs(third), np.abs(step), atol=1e-5)
        tell(f"series of {pattern}, {codec or 'explicit'}, {len(planes)} slices {step} apart",
             found is not None and np.array_equal(found, wanted) and same_step, info.get("error", third))


base = os.path.dirname(pydicom.__file__) + "/data"
for path in sorted(glob.glob(base + "/test_files/**/*", recursive=True) + glob.glob(base + "/charset_files/*.dcm")):
    if os.path.isfile(path) and "DICOMDIR" not in path and not path.endswith((".py", ".json", ".txt", ".xml", ".zip", ".pyc")):
        try:
            judge_pixels(path, path[len(base) + 1:])
        except pydicom.errors.InvalidDicomError:
            pass
judge_codecs()
judge_htj2k()
judge_geometry()
if len(sys.argv) > 2:
    judge_series(sys.argv[2])
print(f"{wrong} differ")
sys.exit(1 if wrong else 0)
