"""Adaptive grids and cells beside yt and PyVista: the first two rows of docs/pictures/peers-fields.png, and what each
picture cost. Not part of the tests.

    python3 tests/peers/fields.py FOLDER [PICTURE]

FOLDER has DD0010/moving7_0010 (Enzo, from the data of PyVista's and yt's tests) and disk_out_ref.ex2 (from VTK's test
data). Python needs yt, pyvista, h5py and halflight. A picture that is there keeps what lies below the two rows."""
from __future__ import annotations

import os
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np

SIZE, TILE, GAP = (800, 600), (292, 219), 4
JOBS = ("yt", "shells", "shells-soft", "pyvista", "cells", "cells-soft", "shells-all")

# Shells at five logarithms of density: extinction STRENGTH exp(-((log d - place) / WIDTH)^2)
LOGARITHMS, PLACES, WIDTH, STRENGTH = (-0.6, 5.2), np.array([1.2, 2.0, 2.8, 3.6, 4.4]), 0.2, 3.5
COLORS = np.array([(0.10, 0.10, 0.75), (0.45, 0.1, 0.6), (0.8, 0.15, 0.4), (0.95, 0.55, 0.15), (1, 0.95, 0.5)])
CENTRE, HEIGHT = (0.7507, 0.7502, 0.7502), 0.27
# Opacity by temperature, per OPAQUE_WAY, and the view of the disk
COLD, HOT, OPAQUE_WAY = 293.15, 913.15, 2.0
OPACITY = [(COLD, 0), (COLD + 0.06 * (HOT - COLD), 0.02), ((COLD + HOT) / 2, 0.2), (HOT, 0.5)]
VIEW, ANGLE = ((0, -26, 10), (0, 0, 2.6), (0, 0, 1)), 30


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


def draw(data: Path, kind: str, out: str) -> None:
    if kind == "yt":
        draw_by_yt(data, out)
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

    made: Any = Image.open(picture).convert("RGB") if picture.exists() else Image.new(
        "RGB", (3 * TILE[0] + 2 * GAP, 2 * TILE[1] + GAP), "white")
    for n, path in enumerate(pictures):
        tile = Image.open(path).convert("RGB").resize(TILE, Image.Resampling.LANCZOS)
        made.paste(tile, (n % 3 * (TILE[0] + GAP), n // 3 * (TILE[1] + GAP)))
    made.save(picture, optimize=True)


def main(arguments: list[str]) -> None:
    if len(arguments) == 3:  # one picture, in a process of its own
        draw(Path(arguments[0]), arguments[1], arguments[2])
        return
    data = Path(arguments[0])
    if not (data / "disk_out_ref.vtu").exists():
        import pyvista

        pyvista.read(data / "disk_out_ref.ex2").combine().save(data / "disk_out_ref.vtu")
    for kind in JOBS:
        print(f"{kind:12}", measured([sys.executable, __file__, str(data), kind, str(data / f"{kind}.png")]), flush=True)
    compose([str(data / f"{kind}.png") for kind in JOBS[:6]], Path(arguments[1] if len(arguments) > 1 else data / "peers-fields.png"))


main(sys.argv[1:])
