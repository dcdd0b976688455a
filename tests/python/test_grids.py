"""One field as voxels, an adaptive grid, tetrahedra and a curvilinear grid: the same pictures, and light by Beer and Lambert."""
from __future__ import annotations

import warnings
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import halflight as hl

from amr_files import levels, means
from cell_files import lattice, mesh, values_at

KINDS = ("voxels", "amr", "tetrahedra", "curvilinear")


def blob(x: Any, y: Any, z: Any) -> Any:
    return np.exp(-((x - 0.45) ** 2 + (y - 0.5) ** 2 + (z - 0.55) ** 2) / (2 * 0.2**2))


def volume_of(kind: str, field: Callable[..., Any], **look: Any) -> hl.Volume:
    """The field over the unit cube."""
    if kind == "voxels":
        return hl.Volume(means(field, 64, (0, 0, 0), (64,) * 3, 2).astype(np.float32), spacing=1 / 64, origin=(1 / 128,) * 3, **look)
    if kind == "amr":
        patches = [(level, first, values) for level, row in enumerate(levels(field)) for first, values in row]
        return hl.Volume.from_amr(patches, spacing=1 / 32, **look)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # how far the samples are from the mesh
        if kind == "tetrahedra":
            places, cells, types = mesh(kind, 41)
        else:
            places, cells, types = mesh("hexahedra", 41, 0.1)
        return hl.Volume.from_cells(places, cells, types, values_at(field, places), **look)


def picture(volume: hl.Volume, shadows: str) -> Any:
    camera = hl.Camera(position=(3, 2.2, 1.9), target=(0.5, 0.5, 0.5), up=(0, 0, 1))
    return np.asarray(hl.render(volume, size=(96, 96), camera=camera, shadows=shadows, lights=[hl.Directional(direction=(-1, -0.3, -0.7))]))


@pytest.mark.parametrize("shadows", ["hard", "soft"])
def test_pictures_agree(shadows: str) -> None:
    look = {"transfer_function": hl.TransferFunction([(0.2, 0), (0.6, 0.9)], unit_distance=0.1), "shading": "phong"}
    pictures = {kind: picture(volume_of(kind, blob, **look), shadows) for kind in KINDS}
    assert pictures["voxels"][..., 3].max() > 0.9
    for kind in KINDS[1:]:
        rms = np.sqrt(np.mean((pictures[kind] - pictures["voxels"]) ** 2))
        assert rms < 0.005, (kind, rms)


@pytest.mark.parametrize("kind", KINDS)
def test_beer_and_lambert(kind: str) -> None:
    function = hl.TransferFunction([(0, 0.5), (1, 0.5)], unit_distance=0.7)
    volume = volume_of(kind, lambda x, y, z: 0.5 + 0 * x * y * z, transfer_function=function, shading="flat")
    camera = hl.Camera(position=(0.5, 0.5, 5), target=(0.5, 0.5, 0.5), up=(0, 1, 0), height=0.6)
    image = np.asarray(hl.render(volume, size=(16, 16), camera=camera, shadows="off"))
    np.testing.assert_allclose(1 - image[..., 3], 0.5 ** (1 / 0.7), atol=1e-4)
