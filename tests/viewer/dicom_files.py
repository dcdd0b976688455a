"""DICOM files of explicit little-endian elements, for tests."""
import struct


def element(tag, kind, value):
    value += (b"\0" if kind in ("UI", "OW") else b" ") * (len(value) % 2)
    head = struct.pack("<HH", tag >> 16, tag & 0xffff) + kind.encode()
    return head + (struct.pack("<HI", 0, len(value)) if kind in ("OW", "SQ") else struct.pack("<H", len(value))) + value


def dicom(*elements):
    meta = element(0x00020010, "UI", b"1.2.840.10008.1.2.1")
    return b"\0" * 128 + b"DICM" + element(0x00020000, "UL", struct.pack("<I", len(meta))) + meta + b"".join(elements)


def dicom_slice(place=0, more=()):
    """A slice of 8 x 8 voxels at a height; more: (tag, kind, value) of other elements."""
    elements = [(0x00080060, "CS", b"CT"), (0x0020000e, "UI", b"1.2.3"), (0x00200032, "DS", b"0\\0\\%d" % place),
                (0x00200037, "DS", b"1\\0\\0\\0\\1\\0"), (0x00280004, "CS", b"MONOCHROME2"), (0x00280030, "DS", b"1\\1"),
                (0x7fe00010, "OW", bytes((n * (1 + place)) % 256 for n in range(64)))]
    elements = [one for one in elements if one[0] not in {tag for tag, *_ in more}] + list(more)
    elements += [(tag, "US", struct.pack("<H", number)) for tag, number in
                 ((0x00280002, 1), (0x00280010, 8), (0x00280011, 8), (0x00280100, 8), (0x00280101, 8), (0x00280102, 7), (0x00280103, 0))]
    return dicom(*(element(*one) for one in sorted(elements)))
