"""The outer walls of meshes of cells: they are lit like the surfaces that they are, and light passes through matter up to them."""
from __future__ import annotations

import functools
import warnings
from typing import Any

import numpy as np
import pytest

import halflight as hl
from halflight._library import context, lib, made

AROUND, INNER, OUTER, HIGH, TURN = 96, 0.35, 1.0, 0.6, 0.013
OPAQUE = hl.TransferFunction([(0, 0), (0.9, 0), (0.95, 0.999), (2, 0.999)], unit_distance=0.02)


def ring(around: int = AROUND, cells: int = 10) -> tuple[Any, Any]:
    """Points and hexahedra of a ring: `cells` outwards, `cells` high."""
    k, j, i = np.meshgrid(np.arange(cells + 1), np.arange(cells + 1), np.arange(around), indexing="ij")
    angle, radius = 2 * np.pi * i / around + TURN, INNER + (OUTER - INNER) * j / cells
    places = np.stack([radius * np.cos(angle), radius * np.sin(angle), HIGH * k / cells], -1).reshape(-1, 3)
    k, j, i = (a.ravel() for a in np.meshgrid(np.arange(cells), np.arange(cells), np.arange(around), indexing="ij"))
    steps = [(0, 0), (0, 1), (1, 1), (1, 0)]
    corners = [((k + up) * (cells + 1) + j + out) * around + (i + on) % around for up in (0, 1) for on, out in steps]
    return places, np.stack(corners, 1)


def volume_of(places: Any, cells: Any, values: Any, **look: Any) -> hl.Volume:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # how far the samples are from the mesh
        return hl.Volume.from_cells(places, cells, np.full(len(cells), 12, np.uint8), values, **look)


@functools.cache
def even_ring(around: int = AROUND, cells: int = 10) -> hl.Volume:
    """A ring in which the value is 1 everywhere, made once."""
    places, corners = ring(around, cells)
    return volume_of(places, corners, np.ones(len(places)))


def parallel_rays(position: Any, target: Any, height: float, size: tuple[int, int]) -> tuple[Any, Any]:
    """The direction of an orthographic camera's rays, whose up is z, and a point of the ray of each pixel."""
    forward = np.subtract(target, position) / np.linalg.norm(np.subtract(target, position))
    right = np.cross(forward, (0, 0, 1))
    right /= np.linalg.norm(right)
    across, down = ((np.arange(n) + 0.5 - n / 2) * height / size[1] for n in size)
    return forward, np.asarray(position) + across[None, :, None] * right - down[:, None, None] * np.cross(right, forward)


def wall_of_hole(forward: Any, origins: Any, margin: float = 0.06) -> tuple[Any, Any]:
    """The pixels that show the hole's wall through the ring's upper opening, and the cylinder's normals there."""
    a = forward[0] ** 2 + forward[1] ** 2
    b = origins[..., 0] * forward[0] + origins[..., 1] * forward[1]
    root = b**2 - a * (origins[..., 0] ** 2 + origins[..., 1] ** 2 - INNER**2)
    places = origins + ((-b + np.sqrt(np.maximum(root, 0))) / a)[..., None] * forward
    opening = origins + ((HIGH - origins[..., 2]) / forward[2])[..., None] * forward
    seen = (root > 0) & (np.hypot(opening[..., 0], opening[..., 1]) < INNER - margin / 2)
    seen &= (places[..., 2] > margin) & (places[..., 2] < HIGH - margin)
    return seen, -places * (1, 1, 0) / INNER


def test_the_wall_of_a_hole_is_lit_like_a_cylinder() -> None:
    """Steps of the lattice would turn the normals by 15 degrees (root mean square), and change the light by .09. The faces
    of the mesh themselves turn them by up to 1.9 degrees."""
    volume = even_ring().replace(transfer_function=OPAQUE, shading="phong")
    position, target, size = (0.9, -1.6, 3.2), (0, 0.1, 0.3), (600, 450)
    towards_light = np.array([0.5, -0.8, 0.9]) / np.sqrt(0.5**2 + 0.8**2 + 0.9**2)
    scene = hl.Scene(volume, size=size, shadows="off", camera=hl.Camera(position=position, target=target, up=(0, 0, 1), height=2.4),
                     lights=[hl.Directional(direction=tuple(-towards_light))])
    layers = hl.Renderer().render(scene, layers=True).layers
    seen, truth = wall_of_hole(*parallel_rays(position, target, 2.4, size))
    normals, light = layers["normal"][seen].astype(float), layers["light0"][..., 1][seen].astype(float)
    assert len(normals) > 5000
    lengths = np.linalg.norm(normals, axis=1)
    assert lengths.min() > 0.99
    turned = np.degrees(np.arccos(np.clip((normals * truth[seen]).sum(axis=1) / lengths, -1, 1)))
    print(f"normals: {np.sqrt(np.mean(turned**2)):.2f} degrees, at most {turned.max():.2f}")
    assert np.sqrt(np.mean(turned**2)) < 0.8 and turned.max() < 3
    cosines = truth[seen] @ towards_light
    lit = cosines > 0.05
    strength = (light * cosines)[lit].sum() / (cosines[lit] ** 2).sum()
    away = np.abs(light / strength - cosines)[lit]
    print(f"light: {np.sqrt(np.mean(away**2)):.4f}, at most {away.max():.4f}")
    assert np.sqrt(np.mean(away**2)) < 0.008 and away.max() < 0.035


def test_maximum_projections_end_at_the_wall() -> None:
    """A ring of one value is of one colour up to a round edge. It had the steps of the lattice, and a rim of other values."""
    places, cells = ring()
    function = hl.TransferFunction([(0, 0), (0.2, 0.5)], color=[(0, 1, 0, 0), (1, 0, 1, 0)])
    volume = volume_of(places, cells, 0.5 + places[:, 2] / HIGH / 2, transfer_function=function)
    camera = hl.Camera(position=(0, 0, 5), target=(0, 0, HIGH / 2), up=(0, 1, 0), height=2.2)
    image = np.asarray(hl.render(volume, size=(400, 400), camera=camera, compositing="maximum", background="transparent"))
    at = (np.arange(400) + 0.5 - 200) * 2.2 / 400
    radius = np.hypot(at[None, :], at[:, None])
    inner, outside = (radius > INNER + 0.003) & (radius < OUTER - 0.003), (radius < INNER - 0.003) | (radius > OUTER + 0.003)
    print("least and greatest", image[inner].min(axis=0), image[inner].max(axis=0))
    assert (image[outside] == 0).all()
    np.testing.assert_allclose(image[inner], np.broadcast_to((0, 1, 0, 1), image[inner].shape), atol=0.02)  # the upper wall's
    oblique = hl.Scene(volume, size=(96, 72), camera=hl.Camera(position=(0.9, -1.6, 3.2), target=(0, 0.1, 0.3), up=(0, 0, 1), height=2.4),
                       compositing="maximum", background="transparent")
    away = np.abs(np.asarray(hl.render(oblique)) - np.asarray(hl.reference(oblique))).max(axis=-1)
    print(f"away from the reference by more than .01: {np.count_nonzero(away > 0.01)} of {away.size} pixels")
    assert np.count_nonzero(away > 0.01) < 8


def moving(scene: hl.Scene) -> hl.Scene:
    """The scene with the coarser copies of its volumes, as the viewer shows it while something moves."""
    preview = made(lib.hl_preview_create, "hl_preview", lib.hl_preview_destroy, context, scene._handle)
    return hl.Scene._of(made(lib.hl_preview_scene, "hl_scene", lib.hl_scene_release, preview, scene._handle))


@pytest.mark.parametrize("spacing", [1.5, 3])
def test_coarser_copies_have_walls(spacing: float) -> None:
    """While a camera moves, the wall stays a cylinder: steps of the coarser lattice turned its normals by 37 degrees."""
    volume = even_ring(128, 14).replace(transfer_function=OPAQUE, shading="phong")
    position, target, size = (0.9, -1.6, 3.2), (0, 0.1, 0.3), (300, 225)
    scene = hl.Scene(volume, size=size, shadows="off", camera=hl.Camera(position=position, target=target, up=(0, 0, 1), height=2.4),
                     lights=[hl.Directional(direction=(-0.5, 0.8, -0.9))], sheet_spacing=spacing)
    coarser = moving(scene)
    assert coarser.volumes[0].dimensions != volume.dimensions
    seen, truth = wall_of_hole(*parallel_rays(position, target, 2.4, size))
    image = hl.Renderer().render(coarser, layers=True)
    normals = image.layers["normal"][seen].astype(float)
    assert len(normals) > 1000 and np.asarray(image)[..., 3][seen].min() > 0.99
    turned = np.degrees(np.arccos(np.clip((normals * truth[seen]).sum(axis=1) / np.linalg.norm(normals, axis=1), -1, 1)))
    print(f"normals: {np.sqrt(np.mean(turned**2)):.2f} degrees, at most {turned.max():.2f}")
    assert np.sqrt(np.mean(turned**2)) < 3 and turned.max() < 10


def test_coarser_copies_are_whole_up_to_the_wall() -> None:
    """A copy of a quarter of the resolution has all of the matter, although values are needed beyond the walls for it. Where
    they were missing, .03 more light passed, and .27 at single places."""
    places, cells = ring(256, 28)
    function = hl.TransferFunction([(0, 0), (1, 0.8)], unit_distance=0.7)
    values = np.abs(2 * places[:, 2] / HIGH - 1)
    volume = volume_of(places, cells, values, transfer_function=function, shading="flat")
    camera = hl.Camera(position=(3, 1, 2), target=(0, 0, HIGH / 2), up=(0, 1, 0), height=2.2)
    scene = hl.Scene(volume, size=(40, 40), camera=camera, shadows="off", sheet_spacing=3)
    fine, coarse = (1 - np.asarray(hl.render(s.replace(sheet_spacing=0.5)))[..., 3] for s in (scene, moving(scene)))
    inner = fine < 0.9
    print(f"mean {(coarse - fine)[inner].mean():.4f}, greatest {np.abs(coarse - fine)[inner].max():.4f}")
    assert abs((coarse - fine)[inner].mean()) < 0.01 and np.abs(coarse - fine)[inner].max() < 0.1


def transmittance(volume: hl.Volume, position: Any, up: Any, pixels: int) -> Any:
    camera = hl.Camera(position=position, target=(0, 0, HIGH / 2), up=up, height=2.2)
    return 1 - np.asarray(hl.render(volume, size=(pixels, pixels), camera=camera, shadows="off"))[..., 3]


def way_through(radius: float, at: Any) -> Any:
    """The lengths of lines parallel to y within a polygon of AROUND corners."""
    angle = 2 * np.pi * np.arange(AROUND + 1) / AROUND + TURN
    x, y = radius * np.cos(angle), radius * np.sin(angle)
    upper = x[1:] < x[:-1]
    ways = np.zeros(len(at))
    for x0, x1, y0, y1, up in zip(x[:-1], x[1:], y[:-1], y[1:], upper, strict=True):
        inside = (at >= min(x0, x1)) & (at < max(x0, x1))
        ways[inside] += (1 if up else -1) * (y0 + (at[inside] - x0) / (x1 - x0) * (y1 - y0))
    return ways


@pytest.mark.parametrize("from_zero", [False, True])
def test_beer_and_lambert(from_zero: bool) -> None:
    """The mean fault across the walls was .0025, and the greatest .156, where walls were steps of the lattice."""
    function = hl.TransferFunction([(0, 0), (0.2, 0.5), (1, 0.5)] if from_zero else [(0, 0.5), (1, 0.5)], unit_distance=0.7)
    volume = even_ring().replace(transfer_function=function, shading="flat")
    at = (np.arange(400) + 0.5 - 200) * 2.2 / 400
    above, radius = transmittance(volume, (0, 0, 5), (0, 1, 0), 400), np.hypot(at[None, :], at[:, None])
    np.testing.assert_allclose(above[(radius > 0.45) & (radius < 0.9)], 0.5 ** (HIGH / 0.7), atol=1e-5)
    assert (above[(radius < INNER - 0.06) | (radius > OUTER + 0.06)] == 1).all()
    beside = transmittance(volume, (0, -5, HIGH / 2), (0, 0, 1), 400)[200]
    fault = beside - 0.5 ** ((way_through(OUTER, at) - way_through(INNER, at)) / 0.7)
    near = np.minimum(np.abs(np.abs(at) - OUTER), np.abs(np.abs(at) - INNER)) < 0.07
    print(f"mean {fault.mean():.1e}, across walls {np.abs(fault[near]).max():.4f}, else {np.abs(fault[~near]).max():.5f}")
    assert abs(fault.mean()) < 1e-4 and np.abs(fault[~near]).max() < 1e-3 and np.abs(fault[near]).max() < 0.06


def test_linear_fields_up_to_the_wall() -> None:
    """Light through a linear field: its optical depth is the mean of the values at the two walls times the way."""
    values = np.linspace(0, 1, 257)
    function = hl.TransferFunction([(v, 1 - np.exp(-0.5 * v)) for v in values], unit_distance=1)
    places, cells = ring()
    volume = volume_of(places, cells, 0.2 + places[:, 2], transfer_function=function, shading="flat")
    at = (np.arange(200) + 0.5 - 100) * 2.2 / 200
    above, radius = transmittance(volume, (0, 0, 5), (0, 1, 0), 200), np.hypot(at[None, :], at[:, None])
    np.testing.assert_allclose(above[(radius > 0.45) & (radius < 0.9)], np.exp(-0.5 * 0.5 * HIGH), atol=1e-4)


def test_seams_are_no_walls() -> None:
    """Pieces that repeat the points of their seam make the same picture as one mesh."""
    places, cells = ring()
    half = len(cells) // 2
    copied = np.concatenate([cells[:half], cells[half:] + len(places)])
    look = {"transfer_function": hl.TransferFunction([(0, 0.5), (1, 0.5)], unit_distance=0.7), "shading": "phong"}
    camera = hl.Camera(position=(0.9, -1.6, 3.2), target=(0, 0.1, 0.3), up=(0, 0, 1), height=2.4)
    pieces = volume_of(np.concatenate([places, places]), copied, np.ones(2 * len(places)))
    one, other = (np.asarray(hl.render(volume.replace(**look), size=(120, 90), camera=camera, shadows="hard")) for volume in (even_ring(), pieces))
    assert one[..., 3].max() > 0.3
    np.testing.assert_allclose(one, other, atol=1e-6)


def test_cells_without_values_leave_walls() -> None:
    """A mesh whose upper half has no values ends in the middle, with a wall there."""
    function = hl.TransferFunction([(0, 0.5), (1, 0.5)], unit_distance=0.7)
    places, cells = ring()
    values = np.where(places[:, 2] > HIGH / 2 + 1e-6, np.nan, 0.5)
    volume = volume_of(places, cells, values, transfer_function=function, shading="flat")
    camera = hl.Camera(position=(0.7, 0, 5), target=(0.7, 0, 0.3), up=(0, 1, 0), height=0.2)
    image = np.asarray(hl.render(volume, size=(8, 8), camera=camera, shadows="off"))
    np.testing.assert_allclose(1 - image[..., 3], 0.5 ** (HIGH / 2 / 0.7), atol=1e-4)
