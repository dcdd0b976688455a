"""Pyramids of OME-Zarr far beyond memory: the program takes the level that the limit leaves room for, and reads none of the finest levels.
Chunks that are absent take no memory."""
from __future__ import annotations

import json
import subprocess
import sys
import zlib
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import halflight as hl

SIDE, CHUNK, COARSEST = 8192, 64, 7

# Runs a command and prints the KiB that it used at most. The system counts the memory of the process that starts another one to that
# one's peak, too: a small interpreter starts the command in place of the tests' own.
MEASURED = """import resource, subprocess, sys
subprocess.run(sys.argv[1:], stdout=subprocess.DEVNULL, check=True)
print(resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss)"""
measures_memory = pytest.mark.skipif(sys.platform == "win32", reason="the system has no count of a child's memory")


def ball(level: int, chunk: tuple[int, int, int]) -> Any:
    """A chunk of a ball in the middle, whose radius is a sixteenth of the side: u16, [z][y][x]."""
    size = SIDE >> level
    z, y, x = (CHUNK * number + np.arange(CHUNK) + 0.5 - size / 2 for number in chunk)
    distance = np.sqrt(z[:, None, None] ** 2 + y[None, :, None] ** 2 + x[None, None, :] ** 2) * 16 / size
    return (np.clip(4 * (1 - distance) + 0.5, 0, 1) * 60000).astype("<u2")


def write_pyramid(folder: Path) -> Path:
    """Levels of 8192^3 to 64^3 voxels. Chunks that hold the fill value are missing; the levels above 1024^3 have one damaged chunk each."""
    datasets = []
    for level in range(COARSEST + 1):
        size, step = SIDE >> level, float(1 << level)
        array = folder / str(level)
        array.mkdir(parents=True)
        array.joinpath(".zarray").write_text(json.dumps(
            {"zarr_format": 2, "shape": [size] * 3, "chunks": [CHUNK] * 3, "dtype": "<u2", "compressor": {"id": "zlib", "level": 1},
             "fill_value": 0, "order": "C", "filters": None, "dimension_separator": "/"}))
        datasets.append({"path": str(level), "coordinateTransformations": [
            {"type": "scale", "scale": [step] * 3}, {"type": "translation", "translation": [(step - 1) / 2] * 3}]})
        half, reach = size // 2, size // 16 + 1
        numbers = range(max(half - reach, 0) // CHUNK, min((half + reach) // CHUNK, size // CHUNK - 1) + 1)
        for chunk in [(k, j, i) for k in numbers for j in numbers for i in numbers] if size <= 1024 else [(half // CHUNK,) * 3]:
            file = array.joinpath(*map(str, chunk))
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_bytes(zlib.compress(ball(level, chunk).tobytes(), 1) if size <= 1024 else b"damaged")
    folder.joinpath(".zgroup").write_text('{"zarr_format": 2}')
    folder.joinpath(".zattrs").write_text(json.dumps({"multiscales": [
        {"version": "0.4", "axes": [{"name": name, "type": "space"} for name in "zyx"], "datasets": datasets}]}))
    return folder


@measures_memory
@pytest.mark.parametrize(("limit", "level", "size"), [("1G", 4, 800), ("256M", 5, 400)])
def test_levels_are_taken_by_memory(tmp_path: Path, program: str, limit: str, level: int, size: int) -> None:
    path, picture = write_pyramid(tmp_path / "a.ome.zarr"), tmp_path / "a.npy"
    command = [program, "render", str(path), "-o", str(picture), "--size", f"{size}x{size}", "--max-memory", limit]
    done = subprocess.run([sys.executable, "-c", MEASURED, *command], stderr=subprocess.PIPE, stdout=subprocess.PIPE, text=True, check=True)
    assert f"level {level} of 8 is taken, the finest that the memory limit leaves room for" in done.stderr
    assert int(done.stdout.split()[-1]) * 1024 < {"1G": 1 << 30, "256M": 1 << 28}[limit] + (64 << 20)  # the program's own code and libraries
    pixels = np.load(picture)
    assert 0.1 < (pixels[..., 3] > 0.5).mean() < 0.9


@measures_memory
@pytest.mark.parametrize("command", ["info", "render"])
def test_absent_chunks_take_no_memory(tmp_path: Path, program: str, command: str) -> None:
    """1024^3 voxels of two bytes, of which a thousandth is there."""
    path = write_pyramid(tmp_path / "a.ome.zarr")
    words = [program, command, str(path), "--level", "3", *(["-o", str(tmp_path / "a.npy"), "--size", "64x64"] if command == "render" else [])]
    done = subprocess.run([sys.executable, "-c", MEASURED, *words], capture_output=True, text=True, check=True)
    # One array of the voxels would take 2 GiB. A picture takes 16 bytes for each 4^3 voxels, and buffers that differ between machines.
    most = 512 << 20 if command == "render" else 100 << 20
    assert int(done.stdout.split()[-1]) * 1024 < most


def write_array(folder: Path, data: Any, chunk: tuple[int, int, int], fill: float, order: str) -> None:
    """An array without the chunks all of whose voxels are the fill value."""
    folder.mkdir()
    folder.joinpath(".zarray").write_text(json.dumps(
        {"zarr_format": 2, "shape": data.shape, "chunks": chunk, "dtype": data.dtype.str, "compressor": None,
         "fill_value": "NaN" if np.isnan(fill) else fill, "order": order, "filters": None}))
    for place in np.ndindex(*(-(-n // c) for n, c in zip(data.shape, chunk))):
        part = data[tuple(slice(p * c, p * c + c) for p, c in zip(place, chunk))]
        if not np.array_equal(part, np.full_like(part, fill), equal_nan=True):
            whole = np.full(chunk, fill, data.dtype)
            whole[tuple(slice(0, n) for n in part.shape)] = part
            folder.joinpath(".".join(map(str, place))).write_bytes(whole.tobytes(order=order))


@pytest.mark.parametrize("kernel", ["bspline", "interpolating"])
@pytest.mark.parametrize(("kind", "fill", "chunk", "order", "radius"), [
    ("|u1", 0, (32, 40, 48), "C", 0.15), ("<u2", 7, (64, 64, 64), "F", 0.15), (">i2", 0, (17, 120, 30), "C", 0.15),
    ("<f4", np.nan, (32, 40, 48), "C", 0.15), ("<f4", 0.25, (30, 30, 30), "F", 0.15), ("<f2", 0, (32, 40, 48), "C", 0.15),
    ("<u2", 7, (32, 40, 48), "C", 0.45)])
def test_absent_chunks_hold_the_fill_value(tmp_path: Path, kernel: str, kind: str, fill: float, chunk: tuple[int, int, int], order: str,
                                           radius: float) -> None:
    """Voxels, statistics and pictures are those of an array in memory."""
    shape = (150, 170, 190)
    z, y, x = np.meshgrid(*((np.arange(n) + 0.5) / n - 0.5 for n in shape), indexing="ij")
    distance = np.sqrt(z * z + (y - 0.05) ** 2 + x * x) / radius
    noise = np.random.default_rng(5).uniform(0.5, 1, shape)
    data = np.where(distance < 1, (noise * (100 if kind != "<f4" else 1)), fill).astype(kind)
    write_array(tmp_path / "a.zarr", data, chunk, fill, order)
    stored, held = hl.Volume(tmp_path / "a.zarr"), hl.Volume(data)
    assert np.array_equal(np.asarray(stored), np.asarray(held), equal_nan=True)
    assert stored.percentile(0) == held.percentile(0) and stored.percentile(99.9) == held.percentile(99.9)
    pictures = [np.asarray(hl.render(volume, size=(48, 48), kernel=kernel)) for volume in (stored, held)]
    assert pictures[0][..., 3].any() and np.array_equal(*pictures)
