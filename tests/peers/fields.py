"""Adaptive grids, cells and particles beside yt, PyVista and pynbody: docs/pictures/peers-fields.png, and what each picture
cost. Not part of the tests. The third row, of SPLASH, is not made here.

    python3 tests/peers/fields.py FOLDER [PICTURE]

FOLDER has DD0010/moving7_0010 (Enzo, from the data of PyVista's and yt's tests), disk_out_ref.ex2 (from VTK's test
data) and 12M.00001 (ChaNGa, from the data of pynbody's tests). Python needs yt, pyvista, h5py, pynbody and halflight. A
picture that is there keeps the rows of which the data are not there."""
from __future__ import annotations

import os
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np

SIZE, TILE, GAP = (800, 600), (292, 219), 4
JOBS = ("yt", "shells", "shells-soft", "pyvista", "cells", "cells-soft", "pynbody", "columns", "particles-soft", "shells-all")
ROWS = (0, 1, 3)  # of the picture; the third row is SPLASH's
DATA = {"pynbody": "12M.00001", "columns": "12M.00001", "particles-soft": "12M.00001", "pyvista": "disk_out_ref.ex2",
        "cells": "disk_out_ref.ex2", "cells-soft": "disk_out_ref.ex2"}

# Shells at five logarithms of density: extinction STRENGTH exp(-((log d - place) / WIDTH)^2)
LOGARITHMS, PLACES, WIDTH, STRENGTH = (-0.6, 5.2), np.array([1.2, 2.0, 2.8, 3.6, 4.4]), 0.2, 3.5
COLORS = np.array([(0.10, 0.10, 0.75), (0.45, 0.1, 0.6), (0.8, 0.15, 0.4), (0.95, 0.55, 0.15), (1, 0.95, 0.5)])
CENTRE, HEIGHT = (0.7507, 0.7502, 0.7502), 0.27
# Opacity by temperature, per OPAQUE_WAY, and the view of the disk
COLD, HOT, OPAQUE_WAY = 293.15, 913.15, 2.0
OPACITY = [(COLD, 0), (COLD + 0.06 * (HOT - COLD), 0.02), ((COLD + HOT) / 2, 0.2), (HOT, 0.5)]
VIEW, ANGLE = ((0, -26, 10), (0, 0, 2.6), (0, 0, 1)), 30
# The gas of a galaxy: the edge of the cube around its middle and the spacing of its voxels (kpc), the darkest and the
# brightest column (in the file's units of mass, by kpc^2), and the optical depth of the brightest one
CUBE, SPACING, COLUMNS, DEPTH = 100.0, 0.2, (0.3, 9000.0), 9.0


def draw_by_yt(data: Path, out: str) -> None:
    import yt
    from PIL import Image

    yt.set_log_level(50)
    grid = yt.load(str(data / "DD0010/moving7_0010"))
    scene = yt.create_scene(grid, field=("enzo", "Density"))
    source, camera = scene.get_source(0), scene.camera
    source.set_log(True)
    source.grey_opacity = True
    source.transfer_function = yt.ColorTransferFunction(LOGARITHMS)
    for place, color in zip(PLACES, COLORS, strict=True):
        source.transfer_function.add_gaussian(place, WIDTH**2, [*(STRENGTH * color), STRENGTH])
    camera.focus = grid.arr(CENTRE, "code_length")
    camera.position = grid.arr([*CENTRE[:2], 3], "code_length")
    camera.switch_orientation(normal_vector=[0, 0, -1], north_vector=[0, 1, 0])
    camera.resolution = SIZE
    camera.width = grid.arr([HEIGHT * SIZE[0] / SIZE[1], HEIGHT, 1.4], "code_length")
    image = np.asarray(scene.render())[..., :3]
    image = np.transpose(image, (1, 0, 2)) if image.shape[0] == SIZE[0] else image
    image = image / np.percentile(image.max(-1), 99.5)  # its colours are brighter than 1
    Image.fromarray((255 * np.clip(image, 0, 1) ** (1 / 2.2)).astype("u1")).save(out)


def draw_shells(data: Path, kind: str, out: str) -> None:
    import halflight as hl

    at = np.linspace(*LOGARITHMS, 600)
    each = STRENGTH * np.exp(-(((at[:, None] - PLACES) / WIDTH) ** 2))
    colors = each @ COLORS / np.maximum(each.sum(1, keepdims=True), 1e-30)
    function = hl.TransferFunction(list(zip(at, 1 - np.exp(-each.sum(1)), strict=True)), color=np.column_stack([at, colors]))
    soft = kind == "shells-soft"
    volume = hl.open_amr(data / "DD0010/moving7_0010", "Density", log=True, finest=None if kind == "shells-all" else 5,
                         transfer_function=function, shading="none" if soft else "flat")
    camera = hl.Camera(position=(*CENTRE[:2], 3), target=CENTRE, up=(0, 1, 0), height=HEIGHT)
    hl.render(volume, size=SIZE, camera=camera, background="black", shadows="soft" if soft else "off").save(out)


def draw_by_pyvista(data: Path, out: str) -> None:
    import pyvista

    mesh = pyvista.read(data / "disk_out_ref.vtu").triangulate()
    opacity = np.interp(np.linspace(COLD, HOT, 256), *zip(*OPACITY, strict=True)) * 255
    plotter = pyvista.Plotter(off_screen=True, window_size=SIZE)
    plotter.background_color = "black"
    plotter.add_volume(mesh, scalars="Temp", cmap="inferno", clim=(COLD, HOT), opacity=opacity.astype("u1"),
                       opacity_unit_distance=OPAQUE_WAY, show_scalar_bar=False)
    plotter.camera_position = VIEW
    plotter.camera.view_angle = ANGLE
    plotter.screenshot(out)


def draw_cells(data: Path, kind: str, out: str) -> None:
    import halflight as hl
    import matplotlib

    codes = matplotlib.colormaps["inferno"](np.linspace(0, 1, 256))[:, :3]
    linear = np.where(codes <= 0.04045, codes / 12.92, ((codes + 0.055) / 1.055) ** 2.4)
    function = hl.TransferFunction(OPACITY, color=np.column_stack([np.linspace(COLD, HOT, 256), linear]), unit_distance=OPAQUE_WAY)
    soft = kind == "cells-soft"
    volume = hl.Volume(data / "disk_out_ref.vtu", array="Temp", transfer_function=function, shading="none" if soft else "flat")
    camera = hl.Camera(position=VIEW[0], target=VIEW[1], up=VIEW[2], fovy_deg=ANGLE)
    hl.render(volume, size=SIZE, camera=camera, background="black", shadows="soft" if soft else "off").save(out)


def gas_of_galaxy(data: Path) -> Any:
    """Places about the middle of the 500 densest particles, masses, smoothing lengths and temperatures, in the cube."""
    import pynbody

    gas = pynbody.load(str(data / "12M.00001")).gas
    places = np.array(gas["pos"], float)
    places -= places[np.argsort(np.array(gas["rho"]))[-500:]].mean(0)
    kept = np.all(abs(places) < CUBE / 2, axis=1)
    return (places[kept], *(np.array(gas[name], float)[kept] for name in ("mass", "smooth", "temp")))


def save_columns(columns: Any, out: str) -> None:
    """The logarithm of columns, as a picture and as numbers. columns: [y][x], y up."""
    import matplotlib
    from PIL import Image

    low, high = np.log10(COLUMNS)
    shown = (np.log10(np.maximum(columns, 1e-9)) - low) / (high - low)
    codes = matplotlib.colormaps["inferno"](np.clip(shown, 0, 1))[::-1, :, :3]
    wide = np.zeros((SIZE[1], SIZE[0], 3), "u1")
    wide[:, (SIZE[0] - SIZE[1]) // 2 :][:, : SIZE[1]] = np.round(255 * codes)
    Image.fromarray(wide).save(out)
    np.save(Path(out).with_suffix(".npy"), columns)


def draw_by_pynbody(data: Path, out: str) -> None:
    import pynbody

    places, masses, lengths, _ = gas_of_galaxy(data)
    made = pynbody.new(gas=len(places))
    made["pos"], made["mass"], made["smooth"], made["rho"] = places, masses, lengths, masses / lengths**3
    for name, unit in (("pos", "kpc"), ("mass", "Msol"), ("smooth", "kpc"), ("rho", "Msol kpc^-3")):
        made[name].units = unit
    save_columns(np.asarray(pynbody.plot.sph.image(made.gas, qty="rho", units="Msol kpc^-2", width=f"{CUBE} kpc", resolution=SIZE[1],
                                                   noplot=True, ret_im=False)), out)


def draw_particles(data: Path, kind: str, out: str) -> None:
    import halflight as hl

    places, masses, lengths, temperatures = gas_of_galaxy(data)
    gas = hl.Particles(places, masses, h=lengths)
    if kind == "particles-soft":
        camera = hl.Camera(position=(0, -160, 120), target=(0, 0, 0), up=(0, 0, 1), fovy_deg=16)
        hl.render(gas.colored(np.log10(temperatures), "inferno", spacing=SPACING), size=SIZE, camera=camera, background="black", shadows="soft").save(out)
        return
    volume = gas.volume("density", spacing=SPACING)
    thin = DEPTH / COLUMNS[1]
    values = np.geomspace(1e-6, 1, 2000) * volume.info().range[1]
    function = hl.TransferFunction([(0, 0), *zip(values, -np.expm1(-thin * values), strict=True)], unit_distance=1.0)
    camera = hl.Camera(position=(0, 0, 500), target=(0, 0, 0), up=(0, 1, 0), height=CUBE)
    seen = np.asarray(hl.render(volume.replace(transfer_function=function, shading="flat"), size=(SIZE[1], SIZE[1]), camera=camera,
                                background="transparent", shadows="off"))
    save_columns(-np.log1p(-np.minimum(seen[::-1, :, 3].astype(float), 1 - 1e-7)) / thin, out)


def draw(data: Path, kind: str, out: str) -> None:
    if kind == "yt":
        draw_by_yt(data, out)
    elif kind == "pynbody":
        draw_by_pynbody(data, out)
    elif kind in ("columns", "particles-soft"):
        draw_particles(data, kind, out)
    elif kind == "pyvista":
        draw_by_pyvista(data, out)
    elif kind.startswith("cells"):
        draw_cells(data, kind, out)
    else:
        draw_shells(data, kind, out)


def measured(command: list[str]) -> str:
    """Processor time, time by the clock and the most memory of a process."""
    begin = time.monotonic()
    process = subprocess.Popen(command, stderr=subprocess.DEVNULL)
    _, status, used = os.wait4(process.pid, 0)
    if status != 0:
        raise SystemExit(f"{' '.join(command)} failed")
    return f"{used.ru_utime + used.ru_stime:6.1f} s {time.monotonic() - begin:6.1f} s by the clock {used.ru_maxrss / 1024:6.0f} MB"


def compose(pictures: list[str], picture: Path) -> None:
    from PIL import Image

    made: Any = Image.new("RGB", (3 * TILE[0] + 2 * GAP, 4 * TILE[1] + 3 * GAP), "white")
    if picture.exists():
        made.paste(Image.open(picture).convert("RGB"))
    for n, path in enumerate(pictures):
        if not Path(path).exists():
            continue
        tile = Image.open(path).convert("RGB").resize(TILE, Image.Resampling.LANCZOS)
        made.paste(tile, (n % 3 * (TILE[0] + GAP), ROWS[n // 3] * (TILE[1] + GAP)))
    made.save(picture, optimize=True)


def main(arguments: list[str]) -> None:
    if len(arguments) == 3:  # one picture, in a process of its own
        draw(Path(arguments[0]), arguments[1], arguments[2])
        return
    data = Path(arguments[0])
    if (data / "disk_out_ref.ex2").exists() and not (data / "disk_out_ref.vtu").exists():
        import pyvista

        pyvista.read(data / "disk_out_ref.ex2").combine().save(data / "disk_out_ref.vtu")
    for kind in JOBS:
        if not (data / DATA.get(kind, "DD0010")).exists():
            continue
        print(f"{kind:12}", measured([sys.executable, __file__, str(data), kind, str(data / f"{kind}.png")]), flush=True)
    compose([str(data / f"{kind}.png") for kind in JOBS[:9]], Path(arguments[1] if len(arguments) > 1 else data / "peers-fields.png"))


main(sys.argv[1:])
