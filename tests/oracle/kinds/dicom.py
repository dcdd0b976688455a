"""DICOM: segmentations, mosaics, multi-frame kinds, places told in part, colours and private syntaxes, against highdicom, pydicom,
ITK (GDCM) and what the standard says.

usage: dicom.py DUMP_VOLUME DUMP_MESH HALFLIGHT"""
import struct
import subprocess
import sys
import warnings

import gdcm
import highdicom
import numpy as np
import pydicom
import SimpleITK
from campaign import DUMP_VOLUME, count, finish, read, root, volume
from pydicom.dataset import Dataset, FileMetaDataset
from pydicom.sequence import Sequence
from pydicom.uid import ExplicitVRBigEndian, ExplicitVRLittleEndian, ImplicitVRLittleEndian, RLELossless, generate_uid

warnings.simplefilter("ignore")
random = np.random.RandomState(11)
VOXELS = random.randint(0, 200, (7, 6, 5))
CT_CLASS = "1.2.840.10008.5.1.4.1.1.2"


def base(sop_class, modality, syntax=ExplicitVRLittleEndian):
    made = Dataset()
    made.file_meta = FileMetaDataset()
    made.file_meta.MediaStorageSOPClassUID = made.SOPClassUID = sop_class
    made.file_meta.MediaStorageSOPInstanceUID = made.SOPInstanceUID = generate_uid()
    made.file_meta.TransferSyntaxUID = syntax
    made.StudyInstanceUID, made.SeriesInstanceUID, made.FrameOfReferenceUID = "1.2.3", "1.2.4", "1.2.5"
    made.PatientName, made.PatientID, made.PatientBirthDate, made.PatientSex = "A^B", "1", "", ""
    made.StudyDate, made.StudyTime, made.AccessionNumber, made.StudyID, made.ReferringPhysicianName = "20200101", "120000", "1", "1", ""
    made.Modality, made.SeriesNumber, made.InstanceNumber = modality, 1, 1
    made.Manufacturer = "none"
    return made


def pixels(made, planes, bits=16, photometric="MONOCHROME2", samples=1):
    planes = np.asarray(planes)
    made.Rows, made.Columns = planes.shape[-3 if samples > 1 else -2], planes.shape[-2 if samples > 1 else -1]
    made.SamplesPerPixel, made.PhotometricInterpretation = samples, photometric
    made.BitsAllocated = made.BitsStored = bits
    made.HighBit, made.PixelRepresentation = bits - 1, 0
    if samples > 1:
        made.PlanarConfiguration = 0
    frames = planes.ndim - (3 if samples > 1 else 2)
    if frames:
        made.NumberOfFrames = planes.shape[0]
    order = ">" if made.file_meta.TransferSyntaxUID == ExplicitVRBigEndian else "<"
    made.PixelData = planes.astype(f"{order}u{bits // 8}").tobytes()
    made["PixelData"].VR = "OB" if bits == 8 and order == "<" else "OW"
    return made


def save(made, path):
    path.parent.mkdir(parents=True, exist_ok=True)
    syntax = made.file_meta.TransferSyntaxUID
    pydicom.dcmwrite(path, made, enforce_file_format=True, implicit_vr=syntax == ImplicitVRLittleEndian, little_endian=syntax != ExplicitVRBigEndian)
    return path


def ct_slices(positions, orientation=(1, 0, 0, 0, 1, 0), planes=VOXELS, **more):
    made = []
    for n, position in enumerate(positions):
        one = base(CT_CLASS, "CT")
        one.InstanceNumber = n + 1
        one.ImagePositionPatient, one.ImageOrientationPatient, one.PixelSpacing = [float(x) for x in position], list(orientation), [0.75, 0.5]
        one.SliceThickness = 2
        one.RescaleIntercept, one.RescaleSlope = 0, 1
        one.ImageType = ["ORIGINAL", "PRIMARY", "AXIAL"]
        for word, value in more.items():
            setattr(one, word, value(n) if callable(value) else value)
        made.append(pixels(one, planes[n]))
    return made


def item(**words):
    made = Dataset()
    for word, value in words.items():
        setattr(made, word, value)
    return made


# ---- segmentations, by highdicom ----

def test_seg():
    source = ct_slices([(10, 20, 30 + 2 * n) for n in range(7)])
    masks = np.zeros((7, 6, 5, 3), np.uint8)
    masks[1:4, 1:5, :2, 0] = 1
    masks[2:7, :, 2:4, 1] = 1
    masks[0, 0, 4, 2] = masks[6, 5, 4, 2] = 1
    concept = highdicom.sr.CodedConcept("123", "99X", "organ")

    def describe(number, name, kind=highdicom.seg.SegmentAlgorithmTypeValues.MANUAL, **more):
        return highdicom.seg.SegmentDescription(number, name, concept, concept, kind, **more)

    for name, kind, omit, syntax, names in (
            ("binary, empty frames left out", "BINARY", True, ExplicitVRLittleEndian, ("liver", "spleen", "dots")),
            ("binary, all frames", "BINARY", False, ImplicitVRLittleEndian, ("a", "b", "c")),
            ("fractional", "FRACTIONAL", True, ExplicitVRLittleEndian, ("left: lung", "right, lung", "ä")),
            ("fractional by run lengths", "FRACTIONAL", True, RLELossless, ("x", "y", "z")),
            ("label map", "LABELMAP", False, ExplicitVRLittleEndian, ("one", "two", "three")),
            ("binary with colours", "BINARY", True, ExplicitVRLittleEndian, ("r", "g", "b"))):
        colors = [highdicom.color.CIELabColor(*c) for c in ((54.29, 80.81, 69.89), (87.82, -79.27, 80.99), (29.57, 68.30, -112.03))]
        segments = [describe(n + 1, names[n], **({"display_color": colors[n]} if "colours" in name else {})) for n in range(3)]
        data = masks if kind != "LABELMAP" else (masks * [1, 2, 3]).max(-1).astype(np.uint8)
        if kind == "FRACTIONAL":
            data = masks.astype(np.float32) * 0.5
        made = highdicom.seg.Segmentation(source, data, kind, segments, generate_uid(), 2, generate_uid(), 1, "m", "n", "1", "2", omit_empty_frames=omit, transfer_syntax_uid=syntax)
        path = root / "seg.dcm"
        made.save_as(path)
        if kind == "FRACTIONAL":
            for n in range(3):
                info, found, told = read(path, "--array", names[n])
                low = info and [a["name"] for a in info["arrays"]]
                good = info and low == list(names) and abs(info["range"][1] - 0.5) < 0.01
                count("DICOM SEG", f"{name}, {names[n]}", "" if good else (told, low, info and info["range"]))
            continue
        used = np.flatnonzero(masks.any((1, 2, 3)))
        wanted = (masks * [1, 2, 3]).max(-1)[used[0]:used[-1] + 1]
        info = volume("DICOM SEG", name, path, wanted, (0.5, 0.75, 2), (10, 20, 30 + 2 * used[0]))
        told = [(s["value"], s["name"]) for s in info.get("segments", []) if s["value"] != 0] if info else None
        count("DICOM SEG", f"{name}: names", "" if told == [(n + 1, names[n]) for n in range(3)] else told)
        if "colours" in name:
            near = [np.abs(np.array([int(s["color"][c:c + 2], 16) for c in (1, 3, 5)]) - rgb).max() for s, rgb in zip(info["segments"], ((255, 0, 0), (0, 255, 0), (0, 0, 255)))]
            count("DICOM SEG", "colours from the file", "" if max(near) < 6 else [s["color"] for s in info["segments"]])
    over = masks.copy()
    over[2:4, 1:5, :3, 1] = 1
    made = highdicom.seg.Segmentation(source, over, "BINARY", [describe(n + 1, f"s{n}") for n in range(3)], generate_uid(), 2, generate_uid(), 1, "m", "n", "1", "2")
    made.save_as(root / "over.dcm")
    info, _, told = read(root / "over.dcm")
    seen = np.zeros_like(over)
    for layer in range(info["components"] if info else 0):
        subprocess.run([DUMP_VOLUME, f"{root / 'over.dcm'}#-1,-1,-1,{layer}", str(root / "layer")], check=True, capture_output=True)
        layer_voxels = np.fromfile(root / "layer").reshape(info["dimensions"][::-1])
        for n in range(3):
            seen[:layer_voxels.shape[0], ..., n] |= (layer_voxels == n + 1).astype(np.uint8)
    used = np.flatnonzero(over.any((1, 2, 3)))
    count("DICOM SEG", "overlaps are kept", "" if "overlap" in told and np.array_equal(seen[:len(used)], over[used[0]:used[-1] + 1]) else told)
    tilted = ct_slices([(10 + n, 20 - n, 30 + n) for n in range(7)], (2 ** -.5, 2 ** -.5, 0, 6 ** -.5, -(6 ** -.5), -2 * 6 ** -.5))
    normal = np.cross((2 ** -.5, 2 ** -.5, 0), (6 ** -.5, -(6 ** -.5), -2 * 6 ** -.5))
    tilted = ct_slices([np.array((10, 20, 30)) + 2.5 * n * normal for n in range(7)], (2 ** -.5, 2 ** -.5, 0, 6 ** -.5, -(6 ** -.5), -2 * 6 ** -.5))
    made = highdicom.seg.Segmentation(tilted, masks[..., 1], "BINARY", [describe(1, "oblique")], generate_uid(), 2, generate_uid(), 1, "m", "n", "1", "2")
    made.save_as(root / "oblique.dcm")
    volume("DICOM SEG", "oblique", root / "oblique.dcm", masks[2:7, ..., 1], (0.5, 0.75, 2.5), np.array((10, 20, 30)) + 5 * normal)


# ---- enhanced multi-frames ----

def functional(made, order, positions, spacing=(0.75, 0.5), thickness=2, orientation=(1, 0, 0, 0, 1, 0), per_frame=lambda k: {}):
    made.SharedFunctionalGroupsSequence = Sequence([item(
        PixelMeasuresSequence=Sequence([item(PixelSpacing=list(spacing), SliceThickness=thickness)]),
        PlaneOrientationSequence=Sequence([item(ImageOrientationPatient=list(orientation))]))])
    made.PerFrameFunctionalGroupsSequence = Sequence([item(PlanePositionSequence=Sequence([item(ImagePositionPatient=[float(x) for x in positions[k]])]), **per_frame(k)) for k in order])
    return made


def test_enhanced():
    line = [(10, 20, 30 + 2 * k) for k in range(7)]
    for name, order, syntax in (("in order", range(7), ExplicitVRLittleEndian), ("backwards", range(6, -1, -1), ImplicitVRLittleEndian),
                                ("shuffled", (3, 0, 6, 1, 5, 2, 4), ExplicitVRLittleEndian), ("big-endian", range(7), ExplicitVRBigEndian)):
        made = pixels(base("1.2.840.10008.5.1.4.1.1.2.1", "CT", syntax), VOXELS[list(order)])
        volume("DICOM enhanced CT", name, save(functional(made, list(order), line), root / "e.dcm"), VOXELS, (0.5, 0.75, 2), (10, 20, 30), np.diag([0.5, 0.75, 2]))
    scale = lambda k: {"PixelValueTransformationSequence": Sequence([item(RescaleSlope=k + 1, RescaleIntercept=-k, RescaleType="US")])}  # noqa: E731
    made = pixels(base("1.2.840.10008.5.1.4.1.1.4.1", "MR"), VOXELS)
    scaled = VOXELS * (np.arange(7) + 1)[:, None, None] - np.arange(7)[:, None, None]
    volume("DICOM enhanced CT", "a scale of each frame", save(functional(made, range(7), line, per_frame=scale), root / "e.dcm"), scaled, tolerance=1e-3)
    turned = (0, 1, 0, 0, 0, -1)
    made = pixels(base("1.2.840.10008.5.1.4.1.1.4.1", "MR"), VOXELS)
    made = functional(made, range(7), [(10 - 2 * k, 20, 30) for k in range(7)], orientation=turned)
    volume("DICOM enhanced CT", "sagittal", save(made, root / "e.dcm"), VOXELS, (0.5, 0.75, 2), (10, 20, 30), np.array([[0, 0, -2], [0.5, 0, 0], [0, -0.75, 0]]))


def test_spacing():
    for name, modality, step, thickness, third in (("NM", "NM", -2, 4, -2), ("NM up", "NM", 3.5, 4, 3.5), ("PET", "PT", -5, 5, -5), ("NM without it", "NM", None, 4, 4),
                                                   ("NM oblique", "NM", -1.5, 9, -1.5)):
        made = pixels(base("1.2.840.10008.5.1.4.1.1.20", modality), VOXELS)
        orientation = (1, 0, 0, 0, 0, 1) if name == "NM oblique" else (1, 0, 0, 0, 1, 0)
        made.PixelSpacing, made.SliceThickness = [0.75, 0.5], thickness
        if step is not None:
            made.SpacingBetweenSlices = step
        made.DetectorInformationSequence = Sequence([item(ImagePositionPatient=[1.0, 2.0, 3.0], ImageOrientationPatient=list(orientation))])
        made.NumberOfSlices, made.SliceVector, made.FrameIncrementPointer = 7, list(range(1, 8)), 0x00540080
        normal = np.cross(orientation[:3], orientation[3:])
        axes = np.stack([np.array(orientation[:3]) * 0.5, np.array(orientation[3:]) * 0.75, normal * third], -1)
        volume("DICOM NM, negative spacing", name, save(made, root / "nm.dcm"), VOXELS, (0.5, 0.75, abs(third)), (1, 2, 3), axes)
    # one per slice: the sign says nothing where positions are told
    made = ct_slices([(0, 0, -2 * n) for n in range(7)], SpacingBetweenSlices=-2)
    for n, one in enumerate(made):
        save(one, root / "neg" / f"{n}.dcm")
    info, found, told = read(root / "neg")
    order = found[::-1] if info and np.array(info["direction"])[2, 2] > 0 else found
    count("DICOM NM, negative spacing", "slices downwards", "" if info and np.array_equal(order, VOXELS) and abs(info["spacing"][2] - 2) < 1e-6 else told)


def test_ultrasound():
    for name, order, kind in (("down", range(6, -1, -1), "FD"), ("up", range(7), "FD"), ("shuffled", (5, 0, 1, 6, 3, 2, 4), "FD"), ("turned", range(7), "turned"), ("times", range(7), "times")):
        frames, planes = [], []
        orientation = [0.0, 1, 0, 0, 0, 1] if kind == "turned" else [1.0, 0, 0, 0, 1, 0]
        for t in range(2 if kind == "times" else 1):
            for k in order:
                where = [1.0 + 2 * k, 2, 3] if kind == "turned" else [1.0, 2, 3 + 2 * k]
                one = item(PlanePositionVolumeSequence=Sequence([item(ImagePositionVolume=where)]))
                if kind == "times":
                    one.FrameContentSequence = Sequence([item(TemporalPositionIndex=t + 1, DimensionIndexValues=[t + 1, k + 1])])
                    one.TemporalPositionSequence = Sequence([item(TemporalPositionTimeOffset=float(t))])
                frames.append(one)
                planes.append(VOXELS[k] + 50 * t)
        made = pixels(base("1.2.840.10008.5.1.4.1.1.6.2", "US"), np.array(planes), 8)
        made.SharedFunctionalGroupsSequence = Sequence([item(PixelMeasuresSequence=Sequence([item(PixelSpacing=[0.75, 0.5], SliceThickness=2)]),
                                                             PlaneOrientationVolumeSequence=Sequence([item(ImageOrientationVolume=orientation)]))])
        made.PerFrameFunctionalGroupsSequence = Sequence(frames)
        axes = np.array([[0, 0, 2], [0.5, 0, 0], [0, 0.75, 0]]) if kind == "turned" else np.diag([0.5, 0.75, 2])
        options = ("--time", "1") if kind == "times" else ()
        volume("DICOM ultrasound volume", name, save(made, root / "us.dcm"), VOXELS + 50 * bool(options), (0.5, 0.75, 2), (1, 2, 3), axes, options=options)


# ---- mosaics ----

def csa(fields):
    content = b"SV10\4\3\2\1" + struct.pack("<II", len(fields), 77)
    for name, texts in fields.items():
        content += name.encode().ljust(64, b"\0") + struct.pack("<i4siiI", len(texts), b"FD\0\0", 4, len(texts) + 1, 77)
        for text in [*texts, ""]:
            data = text.encode() + (b"\0" if text else b"")
            content += struct.pack("<4I", 77, len(data), 77, len(data)) + data + b"\0" * (-len(data) % 4)
    return content


def test_mosaic():
    for name, slices, side, turn in (("4 slices", 4, 2, 1), ("9 slices", 9, 3, 1), ("5 slices downwards", 5, 3, -1), ("16 coronal", 16, 4, 1), ("two slices", 2, 2, 1)):
        voxels = random.randint(0, 900, (slices, 6, 5))
        tiles = np.zeros((6 * side, 5 * side), int)
        for k in range(slices):
            tiles[k // side * 6:k // side * 6 + 6, k % side * 5:k % side * 5 + 5] = voxels[k]
        orientation = (1, 0, 0, 0, 0, -1) if "coronal" in name else (1, 0, 0, 0, 1, 0)
        normal = np.cross(orientation[:3], orientation[3:]) * turn
        x, y = np.array(orientation[:3]), np.array(orientation[3:])
        first = np.array([10.0, 20, 30])
        corner = first + 0.5 * x * (5 - 5 * side) / 2 + 0.75 * y * (6 - 6 * side) / 2
        one = ct_slices([corner], orientation, [tiles], ImageType=["ORIGINAL", "PRIMARY", "M", "MOSAIC"], SpacingBetweenSlices=2.5, Modality="MR")[0]
        block = one.private_block(0x0029, "SIEMENS CSA HEADER", create=True)
        block.add_new(0x10, "OB", csa({"NumberOfImagesInMosaic": [str(slices)], "SliceNormalVector": [f"{c:.8f}" for c in normal]}))
        path = save(one, root / "mosaic.dcm")
        info, found, told = read(path)
        forward = info and np.dot(np.array(info["direction"])[:, 2], normal) > 0
        shown = found if forward else found[::-1] if info else None
        start = first if forward else first + 2.5 * (slices - 1) * normal
        good = info and shown.shape == voxels.shape and np.array_equal(shown, voxels) and np.allclose(info["origin"], start) and np.allclose(info["spacing"], (0.5, 0.75, 2.5))
        count("DICOM mosaics", name, "" if good else (told, info and (info["dimensions"], info["origin"], info["spacing"])))


# ---- places told in part, holes, several pictures at a place ----

def test_places():
    def folder(name, slices, remove=()):
        for n, one in enumerate(slices):
            for word in remove:
                if word in one:
                    delattr(one, word)
            save(one, root / name / f"{n}.dcm")
        return root / name

    line = [(10, 20, 30 + 2.5 * n) for n in range(7)]
    volume("DICOM places in part", "locations downwards", folder("p1", ct_slices(line, SliceLocation=lambda n: 50 - 2.5 * n), ("ImagePositionPatient",)), VOXELS[::-1], (0.5, 0.75, 2.5))
    volume("DICOM places in part", "locations, no orientation", folder("p2", ct_slices(line, SliceLocation=lambda n: 3 * n), ("ImagePositionPatient", "ImageOrientationPatient")), VOXELS,
           (0.5, 0.75, 3))
    volume("DICOM places in part", "positions, no orientation", folder("p3", ct_slices(line), ("ImageOrientationPatient",)), VOXELS, (0.5, 0.75, 2.5))
    volume("DICOM places in part", "numbers alone", folder("p4", ct_slices(line, SpacingBetweenSlices=3), ("ImagePositionPatient", "ImageOrientationPatient")), VOXELS, (0.5, 0.75, 3))
    volume("DICOM places in part", "no thickness, no locations", folder("p5", ct_slices(line), ("ImagePositionPatient", "ImageOrientationPatient", "SliceThickness")), VOXELS, None)
    volume("DICOM places in part", "locations with wrong numbers", folder("p6", ct_slices(line, SliceLocation=lambda n: 2.5 * n, InstanceNumber=lambda n: 7 - n), ("ImagePositionPatient",)), VOXELS,
           (0.5, 0.75, 2.5))
    for name, gap, said in (("a hole of 50 mm", 20, "left empty"), ("a hole of 4 slices", 4, ""), ("two holes", 15, "left empty"), ("a hole after the first", 12, "left empty"),
                            ("a hole in a tilted stack", 20, "left empty")):
        steps = [0, 1, 2, 2 + gap, 3 + gap, 4 + gap, 5 + gap]
        steps = [0, 1, 1 + gap, 2 + gap, 3 + gap, 3 + 2 * gap, 4 + 2 * gap] if name == "two holes" else steps
        steps = [0, gap, gap + 1, gap + 2, gap + 3, gap + 4, gap + 5] if "first" in name else steps
        tilt = np.array([0, np.sin(0.3), np.cos(0.3)]) if "tilted" in name else np.array([0, 0, 1])
        orientation = (1, 0, 0, 0, np.cos(0.3), -np.sin(0.3)) if "tilted" in name else (1, 0, 0, 0, 1, 0)
        info, found, told = read(folder(name, ct_slices([2.5 * s * tilt for s in steps], orientation)))
        good = info and found.shape[0] == steps[-1] + 1 and all(np.array_equal(found[s], VOXELS[n]) for n, s in enumerate(steps))
        empty = [k for k in range(steps[-1] + 1) if k not in steps]
        if said:
            good = good and np.isnan(found[empty]).all() and said in told
        count("DICOM holes", name, "" if good else (told, info and info["dimensions"]))
    for name, words in (("echoes", {"EchoTime": lambda n: 10 + 20 * (n % 2)}), ("b values", {"DiffusionBValue": lambda n: 1000.0 * (n % 2)}),
                        ("times", {"AcquisitionTime": lambda n: f"1200{10 + 10 * (n % 2)}"}), ("trigger times", {"TriggerTime": lambda n: 100 * (n % 2)}),
                        ("acquisitions", {"AcquisitionNumber": lambda n: 1 + n % 2})):
        places = [line[n // 2] for n in range(14)]
        planes = [VOXELS[n // 2] + 1000 * (n % 2) for n in range(14)]
        made = ct_slices(places, planes=planes, Modality="MR", **words)
        info, found, told = read(folder("several-" + name.replace(" ", "-"), made))
        good = info and info["dimensions"] == [5, 6, 7] and info["times"] == 2 and (np.array_equal(found, VOXELS) or np.array_equal(found, VOXELS + 1000))
        count("DICOM, several at a place", name, "" if good else (told, info and (info["dimensions"], info["times"])))


# ---- colours ----

def test_colors():
    rgb = random.randint(0, 256, (4, 6, 5, 3)).astype(np.uint8)

    def check(name, made, wanted):
        path = save(made, root / "c.dcm")
        info, found, told = read(path)
        luma = (wanted.astype(int) @ [54, 183, 19] + 128) >> 8
        good = info and found.shape == luma.shape and np.abs(found - luma).max() <= 1 and info["component"] in ("luminance", "color", "rgba")
        count("DICOM colours", name, "" if good else (told, info and info["component"]))

    check("RGB", pixels(base("1.2.840.10008.5.1.4.1.1.3.1", "US"), rgb, 8, "RGB", 3), rgb)
    planar = pixels(base("1.2.840.10008.5.1.4.1.1.3.1", "US"), rgb, 8, "RGB", 3)
    planar.PlanarConfiguration = 1
    planar.PixelData = rgb.transpose(0, 3, 1, 2).tobytes()
    check("RGB by planes", planar, rgb)
    ybr = pydicom.pixels.convert_color_space(rgb, "RGB", "YBR_FULL")
    check("YBR_FULL", pixels(base("1.2.840.10008.5.1.4.1.1.3.1", "US"), ybr, 8, "YBR_FULL", 3), pydicom.pixels.convert_color_space(ybr, "YBR_FULL", "RGB"))
    even = random.randint(0, 256, (4, 6, 4, 3)).astype(np.uint8)
    even[:, :, 1::2, 1:] = even[:, :, ::2, 1:]
    sub = pixels(base("1.2.840.10008.5.1.4.1.1.3.1", "US"), even, 8, "YBR_FULL_422", 3)
    sub.PixelData = np.stack([even[:, :, ::2, 0], even[:, :, 1::2, 0], even[:, :, ::2, 1], even[:, :, ::2, 2]], -1).tobytes()
    check("YBR_FULL_422", sub, pydicom.pixels.convert_color_space(even, "YBR_FULL", "RGB"))
    made = pixels(base("1.2.840.10008.5.1.4.1.1.3.1", "US"), rgb, 8, "RGB", 3)
    made.compress(RLELossless)
    made.save_as(root / "c.dcm", enforce_file_format=True)
    info, found, told = read(root / "c.dcm")
    luma = (rgb.astype(int) @ [54, 183, 19] + 128) >> 8
    count("DICOM colours", "RGB by run lengths", "" if info and np.abs(found - luma).max() <= 1 else told)
    index = random.randint(0, 256, (4, 6, 5)).astype(np.uint8)
    made = pixels(base("1.2.840.10008.5.1.4.1.1.3.1", "US"), index, 8, "PALETTE COLOR")
    tables = random.randint(0, 65536, (3, 256)).astype(np.uint16)
    for c, word in enumerate(("Red", "Green", "Blue")):
        setattr(made, f"{word}PaletteColorLookupTableDescriptor", [256, 0, 16])
        setattr(made, f"{word}PaletteColorLookupTableData", tables[c].tobytes())
    check("PALETTE COLOR", made, (pydicom.pixels.apply_color_lut(index, made) >> 8).astype(np.uint8))


# ---- GE's private syntax, judged by GDCM ----

def test_ge():
    for n, (name, voxels, modality) in enumerate((("small", VOXELS[0], "CT"), ("large numbers", VOXELS[1] * 300, "CT"), ("another size", random.randint(0, 4000, (9, 4)), "MR"),
                                                  ("one row", random.randint(0, 4000, (1, 8)), "CT"), ("zeros", np.zeros((4, 4), int), "MR"))):
        made = ct_slices([(1, 2, 3)], planes=[voxels], Modality=modality)[0]
        made.file_meta.TransferSyntaxUID = ImplicitVRLittleEndian
        made.PixelData = voxels.astype(">u2").tobytes()
        path = save(made, root / "ge.dcm")
        data = path.read_bytes()
        old, new = b"1.2.840.10008.1.2\0", b"1.2.840.113619.5.2"
        assert len(old) == len(new)
        path.write_bytes(data.replace(old, new, 1))
        reader = gdcm.ImageReader()
        reader.SetFileName(str(path))
        judged = reader.Read()
        raw = np.frombuffer(reader.GetImage().GetBuffer().encode("utf-8", errors="surrogateescape"), "<u2") if judged else None
        if raw is not None and raw.size == voxels.size:
            assert np.array_equal(raw.reshape(voxels.shape), voxels), "the judge reads other voxels"
        volume("DICOM, GE's private syntax", name, path, voxels[None], (0.5, 0.75, 2), (1, 2, 3))


for test in (test_seg, test_enhanced, test_spacing, test_ultrasound, test_mosaic, test_places, test_colors, test_ge):
    test()
sys.exit(finish())
