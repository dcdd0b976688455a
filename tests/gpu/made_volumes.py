"""Files that the tests of devices make: particles, voxels with colours, labels, a mesh of cells, and a light's image."""
import itertools
import math
import random
import struct


def write_grains(path):
    """Particles of two sizes with empty places between them: a field at two levels or more."""
    draw = random.Random(4)
    rows = ["x,y,z,mass,h"]
    for _ in range(260):
        rows.append(",".join(f"{x:.4f}" for x in (draw.gauss(-9, 3), draw.gauss(-6, 3), draw.gauss(-7, 3), 1, draw.uniform(1, 1.6))))
    for _ in range(30):
        place = draw.uniform(-20, 40), draw.uniform(-20, 30), draw.uniform(-20, 30)
        rows.append(",".join(f"{x:.4f}" for x in (*place, 6, draw.uniform(3.5, 7))))
    path.write_text("\n".join(rows) + "\n")


def write_colors(path):
    """Bytes of red, green, blue and opacity: a ball with blue noise in it."""
    draw, size = random.Random(6), (20, 18, 16)
    voxels = bytearray()
    for z, y, x in itertools.product(range(size[2]), range(size[1]), range(size[0])):
        inside = max(0, 90 - (x - 9) ** 2 - (y - 9) ** 2 - (z - 8) ** 2) * 2
        voxels += bytes((12 * x, 13 * y, draw.randrange(256), inside + draw.randrange(40) if inside else 0))
    header = ("NRRD0004\ntype: uint8\ndimension: 4\nsizes: 4 %d %d %d\nkinds: RGBA-color space space space\n"
              "encoding: raw\n\n" % size)
    path.write_bytes(header.encode() + voxels)


def write_slide(path):
    """An image of 40 x 30 pixels: stripes and a fine checkerboard, in three colours."""
    pixels = [value for y, x in itertools.product(range(30), range(40))
              for value in (0.1 + 0.9 * (x // 5 % 2), 0.2 + y / 30, float((x + y) % 2))]
    header = f"{{'descr': '<f4', 'fortran_order': False, 'shape': (30, 40, 3), }}"
    header += " " * (117 - len(header)) + "\n"
    path.write_bytes(b"\x93NUMPY\x01\x00" + struct.pack("<H", len(header)) + header.encode() + struct.pack(f"<{len(pixels)}f", *pixels))


def write_labels(path):
    """Two balls that touch, with the numbers 1 and 2."""
    size = 24
    voxels = bytes(1 if (x - 8) ** 2 + (y - 12) ** 2 + (z - 12) ** 2 < 30 else
                   2 if (x - 16) ** 2 + (y - 12) ** 2 + (z - 11) ** 2 < 25 else 0
                   for z, y, x in itertools.product(range(size), repeat=3))
    header = "NRRD0004\ntype: uint8\ndimension: 3\nsizes: %d %d %d\nencoding: raw\n\n" % (size, size, size)
    path.write_bytes(header.encode() + voxels)


def write_organs(path, scale=1):
    """A map on a slanted grid around the origin, which does not cover the cloud: two balls that touch, a bar through them and
    single voxels, with the numbers 1 to 4. scale: how many times the map is larger."""
    draw, size = random.Random(8), (20, 22, 18)
    voxels = bytes(3 if abs(y - 12) < 2 and abs(z - 9) < 2 else
                   1 if (x - 6) ** 2 + (y - 11) ** 2 + (z - 9) ** 2 < 42 else
                   2 if (x - 14) ** 2 + (y - 11) ** 2 + (z - 9) ** 2 < 30 else
                   4 if draw.random() < 0.02 else 0
                   for z, y, x in itertools.product(*(range(n) for n in reversed(size))))
    header = ("NRRD0004\ntype: uint8\ndimension: 3\nsizes: %d %d %d\nspace dimension: 3\nspace origin: %s\n"
              "space directions: %s %s %s\nencoding: raw\n\n"
              % (*size, *("(%g,%g,%g)" % tuple(scale * x for x in vector)
                          for vector in ((-13, -17, -15), (1.5, 0.1, 0), (-0.1, 1.4, 0.2), (0, 0.1, 1.6)))))
    path.write_bytes(header.encode() + voxels)


def write_cells(path):
    """A ring of hexahedra, 24 around, 5 outwards and 5 high, with values at its points."""
    around, out, high = 24, 5, 5
    numbers = list(itertools.product(range(high + 1), range(out + 1), range(around)))
    places, values = [], []
    for k, j, i in numbers:
        angle, radius = 2 * math.pi * i / around, 6 + 9 * j / out
        places.append("%.5f %.5f %.5f" % (radius * math.cos(angle), 14 * k / high - 7, radius * math.sin(angle)))
        values.append("%.4f" % (0.5 + 0.3 * math.sin(3 * angle) + 0.2 * math.cos(1.3 * k + j)))
    corner = {number: at for at, number in enumerate(numbers)}
    steps = ((0, 0), (0, 1), (1, 1), (1, 0))
    cells = [" ".join(str(corner[k + up, j + outwards, (i + on) % around]) for up in (0, 1) for on, outwards in steps)
             for k, j, i in itertools.product(range(high), range(out), range(around))]
    array = '<DataArray type="%s" Name="%s" NumberOfComponents="%d" format="ascii">%s</DataArray>'
    path.write_text('<VTKFile type="UnstructuredGrid" version="0.1" byte_order="LittleEndian"><UnstructuredGrid>'
                    f'<Piece NumberOfPoints="{len(places)}" NumberOfCells="{len(cells)}"><PointData Scalars="f">'
                    + array % ("Float32", "f", 1, " ".join(values)) + "</PointData><Points>"
                    + array % ("Float32", "places", 3, " ".join(places)) + "</Points><Cells>"
                    + array % ("Int32", "connectivity", 1, " ".join(cells))
                    + array % ("Int32", "offsets", 1, " ".join(str(8 * (n + 1)) for n in range(len(cells))))
                    + array % ("UInt8", "types", 1, " ".join("12" for _ in cells))
                    + "</Cells></Piece></UnstructuredGrid></VTKFile>\n")
