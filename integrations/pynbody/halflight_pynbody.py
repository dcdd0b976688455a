"""Particles of pynbody's snapshots as volumes: deposited on a grid by the cloud in cell, or SPH-smoothed by pynbody."""
from __future__ import annotations

from typing import Any

import halflight
import numpy as np


def volume_of(snapshot: Any, quantity: str = "rho", *, width: float | None = None, size: int = 128, log: bool = True, smooth: bool | None = None,
              **look: Any) -> halflight.Volume:
    """A quantity of particles on a cubic grid around the origin of the snapshot's coordinates.

    Parameters
    ----------
    snapshot : pynbody snapshot or a family of it
    quantity : str
        "rho" is mass over volume; others are means weighted by mass.
    width : float, optional
        Of the cube in the snapshot's units; by default what holds 99 % of the particles.
    size : int
        Voxels along each side.
    log : bool
        Logarithms to base 10.
    smooth : bool, optional
        True: pynbody's own SPH interpolation, which gas particles want; by default for gas alone.
    **look
        Keywords of `halflight.Volume`.
    """
    places, masses = np.asarray(snapshot["pos"], dtype=float), np.asarray(snapshot["mass"], dtype=float)
    if width is None:
        width = 2 * float(np.quantile(abs(places).max(axis=1), 0.99))
    step = width / size
    if smooth:
        from pynbody.sph import render_3d_grid

        values = np.asarray(render_3d_grid(snapshot, quantity, nx=size, x2=width / 2, z_plane=0.0))
    else:
        density = deposit(places, masses, width, size) / step**3
        values = density
        if quantity != "rho":
            carried = deposit(places, masses * np.asarray(snapshot[quantity], dtype=float), width, size) / step**3
            values = np.divide(carried, density, out=np.full_like(density, np.nan), where=density > 0)
    if log:
        with np.errstate(divide="ignore"):
            values = np.where(values > 0, np.log10(values), np.nan)
    corner = -width / 2 + step / 2
    look.setdefault("name", quantity)
    return halflight.Volume(values.astype(np.float32), axes="xyz", spacing=step, origin=(corner, corner, corner), **look)


def deposit(places: np.ndarray, weights: np.ndarray, width: float, size: int) -> np.ndarray:
    """The weights of points on a grid [x][y][z] around the origin, each shared among the eight voxels beside it."""
    scaled = (places / width + 0.5) * size - 0.5
    first = np.floor(scaled).astype(np.int64)
    rest = scaled - first
    total = np.zeros(size**3)
    for corner in np.ndindex(2, 2, 2):
        index = first + corner
        share = np.prod(np.where(corner, rest, 1 - rest), axis=1) * weights
        inside = ((index >= 0) & (index < size)).all(axis=1)
        total += np.bincount(np.ravel_multi_index(index[inside].T, (size,) * 3), share[inside], size**3)
    return total.reshape((size,) * 3)
