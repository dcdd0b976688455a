"""Writes one volume of bytes in the formats that are read slice by slice or chunk by chunk, uncompressed.

write(size, path): size as "160x170x200"; the path's ending chooses: .raw, .tif, .zarr (chunks that do not divide
the volume), .dicom and .slices (folders). The value of voxel (i, j, k) is (3 i + 5 j + 7 k) mod 256.
"""
import json
import os
import struct
import zlib

CHUNK = 48


def rows(width, j_range, k, first=0):
    """The rows of slice k, cut to `width` voxels from voxel `first` on."""
    ramp = bytes(3 * n % 256 for n in range(256 + first + width))
    third = pow(3, -1, 256)
    for j in j_range:
        start = third * (5 * j + 7 * k) % 256 + first
        yield ramp[start:start + width]


def whole_slice(size, k):
    return b"".join(rows(size[0], range(size[1]), k))


def write_raw(size, path):
    with open(path, "wb") as file:
        for k in range(size[2]):
            file.write(whole_slice(size, k))


def write_tiff(size, path):
    """Pages of one strip each: the directory, then the strip."""
    width, height, depth = size
    with open(path, "wb") as file:
        file.write(b"II*\0" + struct.pack("<I", 8))
        for k in range(depth):
            at, bytes_of_directory = file.tell(), 2 + 9 * 12 + 4
            strip = at + bytes_of_directory
            tags = [(256, width), (257, height), (258, 8), (259, 1), (262, 1), (273, strip), (277, 1), (278, height),
                    (279, width * height)]
            after = strip + width * height if k + 1 < depth else 0
            file.write(struct.pack("<H", len(tags)))
            for tag, value in tags:
                file.write(struct.pack("<HHII", tag, 4, 1, value))
            file.write(struct.pack("<I", after) + whole_slice(size, k))


def write_zarr(size, path):
    os.makedirs(path)
    meta = dict(zarr_format=2, shape=size[::-1], chunks=[CHUNK] * 3, dtype="|u1", compressor=None, fill_value=0, order="C",
                filters=None)
    with open(f"{path}/.zarray", "w") as file:
        json.dump(meta, file)
    counts = [-(-n // CHUNK) for n in size]
    for c in range(counts[2]):
        for b in range(counts[1]):
            for a in range(counts[0]):
                with open(f"{path}/{c}.{b}.{a}", "wb") as file:
                    for k in range(CHUNK * c, CHUNK * c + CHUNK):
                        file.write(b"".join(rows(CHUNK, range(CHUNK * b, CHUNK * b + CHUNK), k, CHUNK * a)))


def write_dicom(size, path):
    def element(tag, kind, value):
        value = value if isinstance(value, bytes) else value.encode()
        value += (b"\0" if kind in ("UI", "OB") else b" ") * (len(value) % 2)
        length = struct.pack("<HI", 0, len(value)) if kind == "OB" else struct.pack("<H", len(value))
        return struct.pack("<HH", tag >> 16, tag & 0xffff) + kind.encode() + length + value

    def words(tag, *values):
        return element(tag, "US", struct.pack(f"<{len(values)}H", *values))

    os.makedirs(path)
    for k in range(size[2]):
        meta = element(0x00020010, "UI", "1.2.840.10008.1.2.1")
        content = (element(0x00080016, "UI", "1.2.840.10008.5.1.4.1.1.2") + element(0x00080018, "UI", f"1.2.3.{k + 1}") +
                   element(0x00080060, "CS", "CT") + element(0x0020000d, "UI", "1.2.4") +
                   element(0x0020000e, "UI", "1.2.5") + element(0x00200032, "DS", f"0\\0\\{k}") +
                   element(0x00200037, "DS", "1\\0\\0\\0\\1\\0") + words(0x00280002, 1) +
                   element(0x00280004, "CS", "MONOCHROME2") + words(0x00280010, size[1]) + words(0x00280011, size[0]) +
                   element(0x00280030, "DS", "1\\1") + words(0x00280100, 8) + words(0x00280101, 8) + words(0x00280102, 7) +
                   words(0x00280103, 0) + element(0x7fe00010, "OB", whole_slice(size, k)))
        with open(f"{path}/{k}.dcm", "wb") as file:
            file.write(b"\0" * 128 + b"DICM" + element(0x00020000, "UL", struct.pack("<I", len(meta))) + meta + content)


def write_slices(size, path):
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    os.makedirs(path)
    for k in range(size[2]):
        lines = b"".join(b"\0" + row for row in rows(size[0], range(size[1]), k))
        with open(f"{path}/slice_{k}.png", "wb") as file:
            file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", size[0], size[1], 8, 0, 0, 0, 0)) +
                       chunk(b"IDAT", zlib.compress(lines, 1)) + chunk(b"IEND", b""))


WRITERS = {".raw": write_raw, ".tif": write_tiff, ".zarr": write_zarr, ".dicom": write_dicom, ".slices": write_slices}


def write(size, path):
    WRITERS[os.path.splitext(path)[1]]([int(n) for n in size.split("x")], path)
