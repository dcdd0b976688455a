"""One field as voxels, an adaptive grid, tetrahedra, a curvilinear grid and particles: the same pictures, and light by Beer and Lambert."""
from __future__ import annotations

import functools
import itertools
import warnings
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import halflight as hl

from amr_files import levels, means
from cell_files import lattice, mesh, values_at

KINDS = ("voxels", "amr", "tetrahedra", "curvilinear", "particles")


def blob(x: Any, y: Any, z: Any) -> Any:
    return np.exp(-((x - 0.45) ** 2 + (y - 0.5) ** 2 + (z - 0.55) ** 2) / (2 * 0.2**2))


def volume_of(kind: str, field: Callable[..., Any], **look: Any) -> hl.Volume:
    """The field over the unit cube."""
    if kind == "voxels":
        return hl.Volume(means(field, 64, (0, 0, 0), (64,) * 3, 2).astype(np.float32), spacing=1 / 64, origin=(1 / 128,) * 3, **look)
    if kind == "amr":
        patches = [(level, first, values) for level, row in enumerate(levels(field)) for first, values in row]
        return hl.Volume.from_amr(patches, spacing=1 / 32, **look)
    if kind == "particles":
        places = (np.stack(np.meshgrid(*[np.arange(64)] * 3, indexing="ij"), axis=-1).reshape(-1, 3) + 0.5) / 64
        particles = hl.Particles(places, values_at(field, places) / 64**3, h=1.2 / 64, periodic=1)
        return particles.volume("density", clip=((0, 0, 0), (1, 1, 1)), **look)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # how far the samples are from the mesh
        if kind == "tetrahedra":
            places, cells, types = mesh(kind, 41)
        else:
            places, cells, types = mesh("hexahedra", 41, 0.1)
        return hl.Volume.from_cells(places, cells, types, values_at(field, places), **look)


def picture(volume: hl.Volume, shadows: str) -> Any:
    camera = hl.Camera(position=(3, 2.2, 1.9), target=(0.5, 0.5, 0.5), up=(0, 0, 1))
    return np.asarray(hl.render(volume, size=(96, 96), camera=camera, shadows=shadows, lights=[hl.Directional(direction=(-1, -0.3, -0.7), angular_diameter_deg=40)]))


@functools.cache
def blob_of(kind: str) -> hl.Volume:
    """The blob of a kind, made once. Truth has so many voxels that a picture of twice as many is the same to .0003."""
    if kind == "truth":
        return hl.Volume(means(blob, 192, (0, 0, 0), (192,) * 3, 1).astype(np.float32), spacing=1 / 192, origin=(1 / 384,) * 3)
    return volume_of(kind, blob)


def greatest_difference(pictures: dict[str, Any]) -> float:
    """The greatest root of the mean square of the differences of two pictures."""
    pairs = {(one, other): np.sqrt(np.mean((pictures[one] - pictures[other]) ** 2)) for one, other in itertools.combinations(pictures, 2)}
    print({f"{one}, {other}": f"{rms:.5f}" for (one, other), rms in pairs.items()})
    return max(pairs.values())


@pytest.mark.parametrize("shadows", ["hard", "soft"])
@pytest.mark.parametrize("shading", ["none", "phong"])
def test_pictures_agree(shading: str, shadows: str) -> None:
    look = {"transfer_function": hl.TransferFunction([(0.2, 0), (0.6, 0.9)], unit_distance=0.1), "shading": shading}
    kinds = (*KINDS, "truth") if shading == "none" else KINDS  # the light on surfaces depends on the edges of voxels
    pictures = {kind: picture(blob_of(kind).replace(**look), shadows) for kind in kinds}
    assert pictures["voxels"][..., 3].max() > 0.9
    assert greatest_difference(pictures) < (0.002 if shading == "none" else 0.005)


def test_shadows_matter() -> None:
    """The pictures that are compared have shadows: without them they differ by far more."""
    volume = blob_of("voxels").replace(transfer_function=hl.TransferFunction([(0.2, 0), (0.6, 0.9)], unit_distance=0.1), shading="none")
    for shadows in ("hard", "soft"):
        assert greatest_difference({name: picture(volume, name) for name in ("off", shadows)}) > 0.05


def ways_through_cube(position: Any, height: float, pixels: int) -> Any:
    """The lengths within the unit cube of the parallel rays through pixels, seen from a position towards the cube's middle."""
    middle = np.full(3, 0.5)
    forward = (middle - position) / np.linalg.norm(middle - position)
    right = np.cross(forward, (0.1, 0.2, 1))
    right /= np.linalg.norm(right)
    places = (np.arange(pixels) + 0.5 - pixels / 2) * height / pixels
    origins = position + places[None, :, None] * right - places[:, None, None] * np.cross(right, forward)
    with np.errstate(divide="ignore"):
        ends = -origins / forward, (1 - origins) / forward
    return np.minimum.reduce(np.maximum(*ends), axis=-1) - np.maximum.reduce(np.minimum(*ends), axis=-1)


@pytest.mark.parametrize("kind", KINDS)
def test_beer_and_lambert(kind: str) -> None:
    """Light from any side, where no ray meets an edge of the cube. Edges of meshes of cells are round by half a sample."""
    function = hl.TransferFunction([(0, 0.5), (1, 0.5)], unit_distance=0.7)
    volume = volume_of(kind, lambda x, y, z: 0.5 + 0 * x * y * z, transfer_function=function, shading="flat")
    for position in ((0.5, 0.5, 5), (5, 0.5, 0.5), (4.5, 1.5, 1), (1.5, 1.5, 3.5), (1.5, 4.5, -1.5)):
        camera = hl.Camera(position=position, target=(0.5, 0.5, 0.5), up=(0.1, 0.2, 1), height=0.3)
        image = np.asarray(hl.render(volume, size=(16, 16), camera=camera, shadows="off"))
        np.testing.assert_allclose(1 - image[..., 3], 0.5 ** (ways_through_cube(position, 0.3, 16) / 0.7), atol=1e-4)
