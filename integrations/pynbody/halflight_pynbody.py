"""Particles of pynbody's snapshots as volumes, spread by their SPH kernels."""
from __future__ import annotations

from typing import Any

import halflight
import numpy as np


def volume_of(snapshot: Any, quantity: str = "rho", *, width: float | None = None, size: int = 256, log: bool = True,
              **look: Any) -> halflight.Volume:
    """A quantity of particles on a grid around the origin of the snapshot's coordinates.

    Parameters
    ----------
    snapshot : pynbody snapshot or a family of it
    quantity : str
        "rho" is mass over volume; others are means weighted by mass.
    width : float, optional
        Of the cube in the snapshot's units whose particles are taken; by default all are.
    size : int
        Most voxels along a side.
    log : bool
        The density's logarithm to base 10; of other quantities the mean of their logarithms.
    **look
        Keywords of `halflight.Volume`.
    """
    particles, inside = particles_of(snapshot, width)
    look.setdefault("name", quantity)
    if quantity == "rho":
        return particles.volume("log density" if log else "density", size=size, **look)
    values = np.asarray(snapshot[quantity], dtype=float)[inside]
    if log:
        with np.errstate(divide="ignore", invalid="ignore"):
            values = np.log10(values)
        values = np.where(np.isfinite(values), values, np.min(values[np.isfinite(values)], initial=0))
    return particles.volume(values, size=size, **look)


def particles_of(snapshot: Any, width: float | None = None) -> tuple[halflight.Particles, np.ndarray]:
    """The particles, and which of the snapshot's they are.

    Smoothing lengths that the file has are taken; others are found from the distances of neighbours. pynbody's reach to
    twice of them, as Halflight's.
    """
    places = np.asarray(snapshot["pos"], dtype=float)
    inside = np.ones(len(places), bool) if width is None else (abs(places) <= width / 2).all(axis=1)
    h = np.asarray(snapshot["smooth"], dtype=float)[inside] if "smooth" in snapshot.loadable_keys() else None
    return halflight.Particles(places[inside], np.asarray(snapshot["mass"], dtype=float)[inside], h=h), inside
