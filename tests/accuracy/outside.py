"""An outside truth: Mitsuba 3, single scattering through a grid, against the sheets and the reference.

Both solve the same integral when extinction is proportional to density, the albedo is 1, nothing is a surface and the
kernel is linear: the picture is the transmittance to the eye times extinction times what arrives of the light, up to one
scale (the phase function and the light's units), which is fitted. Mitsuba's pixels are means over the pixel; so are
ours, of 3 x 3 parts. Its noise is known from two seeds.
"""
import hashlib
import json
import os
import pathlib
import subprocess

import numpy

import scenes

VERSION = "3.9.1"
SIZE, EDGE, EXTINCTION, VOXELS = 64, 2.0, 8.0, 32
CAMERA = {"position": [3, -5, 3], "target": [0, 0, 0], "up": [0, 0, 1], "height": 2.7}
LIGHTS = {
    "directional": {"type": "directional", "direction": [-0.5, 0.3, -1]},
    "point": {"type": "point", "position": [1.6, -0.9, 2.4], "radius": 0},
    "area (a ball of light)": {"type": "point", "position": [1.6, -0.9, 2.4], "radius": 0.5},
}


def environment():
    """The Python of an environment with Mitsuba, and the variables it needs."""
    home = scenes.ROOT / "build" / "mitsuba"
    python = home / "bin" / "python"
    if not python.exists():
        subprocess.run(["/usr/bin/python3", "-m", "venv", home], check=True)
    if subprocess.run([python, "-c", "import mitsuba, numpy"], capture_output=True).returncode != 0:
        subprocess.run([python, "-m", "pip", "install", "--quiet", f"mitsuba=={VERSION}", "numpy"], check=True)
    llvm = sorted(pathlib.Path("/usr/lib").glob("*-linux-gnu/libLLVM-19.so*"))
    return python, dict(os.environ, DRJIT_LIBLLVM_PATH=str(llvm[0])) if llvm else dict(os.environ)


def density():
    """Three soft balls that shade each other, nothing at the grid's faces."""
    z, y, x = numpy.mgrid[0:VOXELS, 0:VOXELS, 0:VOXELS]

    def ball(cx, cy, cz, radius):
        return numpy.maximum(0, 1 - ((x - cx) ** 2 + (y - cy) ** 2 + (z - cz) ** 2) / radius ** 2)
    return numpy.maximum.reduce([ball(10, 11, 11, 8), ball(21, 19, 17, 7.5), ball(14, 16, 24, 5)]).astype("<f4")


def write_grid(grid, path):
    step = EDGE / VOXELS
    first = -EDGE / 2 + step / 2
    header = (f"NRRD0004\ntype: float\ndimension: 3\nsizes: {VOXELS} {VOXELS} {VOXELS}\nspace dimension: 3\n"
              f"space directions: ({step},0,0) (0,{step},0) (0,0,{step})\nspace origin: ({first},{first},{first})\n"
              f"endian: little\nencoding: raw\n\n")
    path.write_bytes(header.encode() + grid.tobytes())


def scene(light, size):
    """Ours: an opacity of EXTINCTION * density * u per tiny length u is that extinction."""
    unit = 1e-5
    light = dict(light, color=[1, 1, 1])
    if light["type"] == "point":
        light["falloff"] = "inverse_square"
    return {"halflight": 1, "image": {"width": size, "height": size},
            "camera": dict(CAMERA, type="orthographic"), "ambient": [0, 0, 0], "lights": [light],
            "volumes": [{"file": str(scenes.WORK / "outside.nrrd"), "shading": "none",
                         "transfer_function": {"unit_distance": unit, "opacity": [[0, 0], [1, EXTINCTION * unit]],
                                               "color": [[0, 1, 1, 1]]}}],
            "render": {"kernel": "linear", "shadows": "soft" if light.get("radius") else "hard", "sheet_spacing": 0.5}}


def fold(picture):
    """Means of 3 x 3 pixels."""
    return picture.reshape(SIZE, 3, SIZE, 3).mean((1, 3))


def fit(ours, truth):
    """(RMSE after the best single scale, that scale), in units of the truth's maximum."""
    scale = (ours * truth).sum() / (ours * ours).sum()
    return numpy.sqrt(((scale * ours - truth) ** 2).mean()) / truth.max(), scale


def by_mitsuba(label, light, samples, passes):
    output = scenes.WORK / f"outside-{label}-{samples}x{passes}.npy"
    if not output.exists():
        job = {"grid": str(scenes.WORK / "outside-grid.npy"), "output": str(output), "edge": EDGE, "size": SIZE,
               "extinction": EXTINCTION, "samples": samples, "passes": passes, "camera": CAMERA, "light": light}
        path = scenes.WORK / f"outside-{label}.json"
        path.write_text(json.dumps(job))
        python, variables = environment()
        subprocess.run([python, scenes.HERE / "mitsuba_scene.py", path], check=True, env=variables)
    return numpy.load(output).astype(float)


def measure(samples=512, passes=8):
    """One row per light: its name, Mitsuba's noise, and the RMSE of our methods, all of the picture's maximum."""
    scenes.WORK.mkdir(parents=True, exist_ok=True)
    grid = density()
    numpy.save(scenes.WORK / "outside-grid.npy", grid)
    write_grid(grid, scenes.WORK / "outside.nrrd")
    rows = []
    for name, light in LIGHTS.items():
        print(f"mitsuba, {name} light", flush=True)
        label = name.split()[0]
        first, second = by_mitsuba(label, light, samples, passes)
        truth = (first + second) / 2
        noise = numpy.sqrt(((first - second) ** 2).mean()) / 2 / truth.max()
        row = {"light": name, "noise": noise, "truth": truth, "ours": {}}
        for method, options in {"sheets": [], "reference": ["--reference", "--light-points", "32"]}.items():
            made = scene(light, 3 * SIZE)
            key = hashlib.sha256(json.dumps([made, options], sort_keys=True).encode() + grid.tobytes()).hexdigest()[:12]
            kept = f"outside-{label}-{method}-{key}"
            if method == "sheets" or not (scenes.WORK / f"{kept}.npy").exists():
                scenes.run(made, kept, *options)
            picture = fold(numpy.load(scenes.WORK / f"{kept}.npy").astype(float)[:, :, 0])
            row[method], scale = fit(picture, truth)
            row["ours"][method] = scale * picture
        rows.append(row)
    return rows, 2 * samples * passes
