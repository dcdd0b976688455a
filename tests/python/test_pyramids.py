"""Pyramids of OME-Zarr far beyond memory: the program takes the level that the limit leaves room for, and reads none of the finest levels."""
from __future__ import annotations

import json
import subprocess
import sys
import zlib
from pathlib import Path
from typing import Any

import numpy as np
import pytest

SIDE, CHUNK, COARSEST = 8192, 64, 7

# Runs a command and prints the KiB that it used at most. The system counts the memory of the process that starts another one to that
# one's peak, too: a small interpreter starts the command in place of the tests' own.
MEASURED = """import resource, subprocess, sys
subprocess.run(sys.argv[1:], stdout=subprocess.DEVNULL, check=True)
print(resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss)"""


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


@pytest.mark.parametrize(("limit", "level", "size"), [("1G", 4, 800), ("256M", 5, 400)])
def test_levels_are_taken_by_memory(tmp_path: Path, program: str, limit: str, level: int, size: int) -> None:
    path, picture = write_pyramid(tmp_path / "a.ome.zarr"), tmp_path / "a.npy"
    command = [program, "render", str(path), "-o", str(picture), "--size", f"{size}x{size}", "--max-memory", limit]
    done = subprocess.run([sys.executable, "-c", MEASURED, *command], stderr=subprocess.PIPE, stdout=subprocess.PIPE, text=True, check=True)
    assert f"level {level} of 8 is taken, the finest that the memory limit leaves room for" in done.stderr
    assert int(done.stdout.split()[-1]) * 1024 < {"1G": 1 << 30, "256M": 1 << 28}[limit] + (64 << 20)  # the program's own code and libraries
    pixels = np.load(picture)
    assert 0.1 < (pixels[..., 3] > 0.5).mean() < 0.9
