"""Small scenes whose frames are counted: one for each kind of work that a frame may have to do."""
import math
import struct

SIDE = 40
MATTER = {"transfer_function": {"opacity": [[60, 0], [120, 0.9]], "color": [[0, 0.8, 0.6, 0.4], [200, 1, 0.9, 0.8]]},
          "material": {"ambient": 0.1, "diffuse": 0.8, "specular": 0.2}}
KEY = {"type": "directional", "direction": [1, 0.6, -1], "angular_diameter_deg": 6}
CAMERA = {"position": [-1.4 * SIDE, -SIDE, 2 * SIDE], "target": [SIDE / 2] * 3, "up": [0, 0, 1]}


def balls(x, y, z):
    """Four balls with soft edges; 0 to 250."""
    centres = ((13, 14, 14, 9), (27, 25, 20, 8), (14, 28, 28, 6), (28, 12, 30, 5))
    return max(max(0, min(250, 125 + 60 * (r - ((x - a) ** 2 + (y - b) ** 2 + (z - c) ** 2) ** 0.5))) for a, b, c, r in centres)


def write_volumes(folder):
    places = [(x, y, z) for z in range(SIDE) for y in range(SIDE) for x in range(SIDE)]
    name = f"{SIDE}x{SIDE}x{SIDE}_uint8.raw"
    (folder / f"balls_{name}").write_bytes(bytes(int(balls(*place)) for place in places))
    (folder / f"haze_{name}").write_bytes(bytes(min(255, 40 + 4 * z + (x * y) % 7) for x, y, z in places))
    labels = bytes((1 + x // 14) * (balls(x, y, z) > 125) for x, y, z in places)
    header = f"NRRD0004\ntype: uint8\ndimension: 3\nsizes: {SIDE} {SIDE} {SIDE}\nencoding: raw\n\n"
    (folder / "labels.nrrd").write_bytes(header.encode() + labels)
    corners = [(4, 4, -2), (36, 4, -2), (36, 36, -2), (4, 36, -2), (20, 20, 46)]
    faces = [(0, 1, 2), (0, 2, 3), (0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)]
    stl = b"".join(struct.pack("<12fH", 0, 0, 0, *corners[a], *corners[b], *corners[c], 0) for a, b, c in faces)
    (folder / "pyramid.stl").write_bytes(bytes(80) + struct.pack("<I", len(faces)) + stl)


def scene(volume=None, lights=(KEY,), render=None, **more):
    settings = {"file": f"balls_{SIDE}x{SIDE}x{SIDE}_uint8.raw", **MATTER, **(volume or {})}
    volumes = [{key: value for key, value in settings.items() if value is not None}]
    return {"halflight": 1, "image": {"width": 56, "height": 56}, "camera": CAMERA, "lights": list(lights), "volumes": volumes,
            "render": {"sheet_spacing": 1, "shadows": "hard", "threads": 1, **(render or {})}, **more}


def hull(count, radius):
    """Planes all round the middle, which leave about a ball: what holds an object is cut away by such planes."""
    heights = [(2 * i + 1) / count - 1 for i in range(count)]
    normals = [[math.cos(2.4 * i) * math.sqrt(1 - h * h), math.sin(2.4 * i) * math.sqrt(1 - h * h), h] for i, h in enumerate(heights)]
    return [{"type": "plane", "point": [SIDE / 2 + radius * n for n in normal], "normal": normal} for normal in normals]


def soft(method):
    return {"shadows": "soft", "soft_method": method}


SKY = {"type": "gradient", "zenith": [1, 1.04, 1.09], "horizon": [0.8, 0.8, 0.8], "ground": [0.2, 0.2, 0.2], "up": [0, 0, 1]}
SCENES = {
    "off": scene(render={"shadows": "off"}),
    "hard": scene(),
    "paper": scene(render=soft("paper")),
    "cascade": scene(render=soft("cascade")),
    "sublights": scene(render=soft("sublights")),
    "sky_off": scene(render={"shadows": "off"}, sky=SKY),
    "sky_hard": scene(sky=SKY),
    "medium": scene({"file": f"haze_{SIDE}x{SIDE}x{SIDE}_uint8.raw", "shading": "none",
                     "transfer_function": {"opacity": [[40, 0], [255, 0.05]], "color": [[0, 1, 1, 1]]}}),
    "mesh": scene(meshes=[{"file": "pyramid.stl", "color": [0.7, 0.7, 0.8], "opacity": 0.6}]),
    "labels": scene({"file": "labels.nrrd", "labels": True, "transfer_function": None}),
    "cut": scene({"cuts": [{"type": "plane", "point": [20, 20, 20], "normal": [0.6, 0.2, 0.7]}]}),
    "hull": scene({"cuts": hull(24, 17)}),
    "two_numbers": scene({"transfer_function": {"second": "gradient", "boxes": [
        {"value": [60, 256], "second": [10, 90], "edge": [40, 10], "color": [0.8, 0.6, 0.4], "opacity": 0.9}]}}),
}
