"""Makes volumes of particles from smoothed particle hydrodynamics and molecular dynamics."""
from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Literal, Unpack

import numpy as np

from ._library import call, context, ffi, lib, made
from ._settings import number, numbers_of
from ._words import choice
from .transfer import TransferFunction
from .volume import Info, Look, Volume, volume_of_handle

__all__ = ["Particles"]

_QUANTITIES = {"log density": "HL_PARTICLES_LOG_DENSITY", "density": "HL_PARTICLES_DENSITY"}
_STEPS = 256


class Particles:
    """Particles that are spread into volumes by the cubic spline kernel, which reaches to twice the smoothing length.
    Where a volume is wanted, as by `render`, they stand for ``volume()``.

    Parameters
    ----------
    positions : array_like, shape (n, 3)
        World x, y, z. Particles whose place is not finite are left out.
    masses : array_like, shape (n,), optional
        The masses, which are at least 0. The default is 1 for each particle.
    h : float or array_like, shape (n,), optional
        Smoothing lengths in world units; by default half of the distance of each particle's 48th neighbour.
    periodic : float, 3 floats, or ((x, y, z), (x, y, z)), optional
        The lengths of a periodic box that begins at the origin, 0 along axes without a period; or the corners of the box.

    Examples
    --------
    >>> import numpy as np
    >>> places = np.random.default_rng(1).random((1000, 3))
    >>> density = Particles(places, periodic=1).volume("density", size=32)
    >>> max(density.dimensions) <= 33
    True
    """

    __slots__ = ("_h", "_low", "_masses", "_period", "_positions")

    def __init__(self, positions: Any, masses: Any = None, *, h: Any = None, periodic: Any = None) -> None:
        places = np.asarray(positions)
        if places.ndim != 2 or places.shape[1] != 3 or len(places) == 0:
            raise ValueError(f"positions have the shape {places.shape}, not (n, 3) with n from 1 on")
        self._positions = np.ascontiguousarray(places, dtype=np.float32 if places.dtype == np.float32 else np.float64)
        self._masses = None if masses is None else self._numbers("masses", masses)
        self._h = None if h is None else self._numbers("h", np.broadcast_to(np.asarray(h), len(places)) if np.ndim(h) == 0 else h)
        self._low, self._period = _box(periodic)

    def _numbers(self, word: str, given: Any) -> np.ndarray[Any, np.dtype[np.float32]]:
        numbers = np.ascontiguousarray(given, dtype=np.float32)
        if numbers.shape != (len(self._positions),):
            raise ValueError(f"{word} have the shape {numbers.shape}, not ({len(self._positions)},): one for each particle")
        return numbers

    def __len__(self) -> int:
        return len(self._positions)

    @property
    def positions(self) -> np.ndarray[Any, Any]:
        """(n, 3), world."""
        return self._positions

    @property
    def h(self) -> np.ndarray[Any, np.dtype[np.float32]]:
        """The smoothing lengths, of shape (n,). If none were given, they were computed. They are 0 for particles
        without a finite place.
        """
        if self._h is None:
            found = np.empty(len(self), np.float32)
            call(lib.hl_particles_find_smoothing, context, self._describe(), ffi.from_buffer("float[]", found))
            self._h = found
        return self._h

    def _describe(self) -> Any:
        struct = ffi.new("hl_particles_description *")
        lib.hl_particles_description_defaults(struct)
        struct.count = len(self)
        struct.positions = ffi.cast("void *", self._positions.ctypes.data)
        struct.position_type = lib.HL_VOXEL_F32 if self._positions.dtype == np.float32 else lib.HL_VOXEL_F64
        if self._masses is not None:
            struct.masses = ffi.cast("float *", self._masses.ctypes.data)
        if self._h is not None:
            struct.lengths = ffi.cast("float *", self._h.ctypes.data)
        struct.period_low, struct.period = self._low, self._period
        return struct

    def volume(self, quantity: Literal["log density", "density"] | Any = "log density", *, spacing: float | None = None,
               size: int | None = None, **look: Unpack[Look]) -> Volume:
        """The particles on a grid: their density, its logarithm to base 10, or the mean of a quantity.

        Parameters
        ----------
        quantity : "log density", "density", or array_like, shape (n,)
            Numbers are averaged, with mass and kernel as weights. At places that no particle reaches, the mean is NaN.
            The least value of the logarithm is the logarithm of a tenth of the least density that any particle has at
            its own place.
        spacing : float, optional
            World units between voxels; by default half of the smoothing length that one particle in fifty stays below.
        size : int, optional
            The greatest number of voxels along an axis if no spacing is given; by default 512.
        **look
            Keywords of `Volume`.
        """
        if isinstance(quantity, str):
            struct = self._on_grid(spacing, size)
            struct.quantity = getattr(lib, _QUANTITIES[choice("quantity", quantity, _QUANTITIES)])
            look.setdefault("name", quantity)
            volume = _made(struct)
        else:
            volume = self._mean(self._numbers("values", quantity), np.nan, spacing, size)
        return volume.replace(**look)

    def _as_volume(self) -> Volume:
        """What stands for the particles where a volume is wanted."""
        return self.volume()

    def _on_grid(self, spacing: float | None, size: int | None) -> Any:
        struct = self._describe()
        if spacing is not None:
            struct.spacing = number("spacing", spacing)
        if size is not None:
            struct.side = int(size)
        return struct

    def _mean(self, values: np.ndarray[Any, np.dtype[np.float32]], outside: float, spacing: float | None, size: int | None) -> Volume:
        """The mean of values. At places that no particle reaches, it is `outside`."""
        struct = self._on_grid(spacing, size)
        struct.quantity, struct.values, struct.outside = lib.HL_PARTICLES_MEAN, ffi.cast("float *", values.ctypes.data), outside
        return _made(struct)

    def colored(self, values: Any, cmap: Any = "viridis", *, clim: Sequence[float] | None = None, depth: float = 2.0,
                name: str = "value", spacing: float | None = None, size: int | None = None) -> list[Volume]:
        """Volumes for one picture: opacity by the logarithm of density, colour by the mean of a quantity.

        Parameters
        ----------
        values : array_like, shape (n,)
            A value of each particle, such as its temperature.
        cmap : str, matplotlib colormap or colours
        clim : (low, high), optional
            The values that the colours spread over; by default percentiles 2 and 98 of `values`. Values beyond the
            range count as the ends of the range.
        depth : float
            The optical depth of dense matter through a twentieth of the box. Dense is the density that only a
            thousandth of the places exceeds.
        name : str
            The name of the volume of the mean, which is not visible itself.
        spacing, size : optional
            As for `volume`.

        Returns
        -------
        list of Volume
            The density, and the mean that gives it its colours: give both to `render`.
        """
        self.h  # the smoothing lengths are computed once for both volumes
        density = self.volume(spacing=spacing, size=size)
        given = self._numbers("values", values)
        low, high = numbers_of("clim", np.percentile(given, (2, 98)) if clim is None else clim, 2)
        if not high > low:
            low, high = low - 0.5, low + 0.5
        # The function has no colours beyond its range, so no mean may leave it, not even by rounding.
        margin = 1e-5 * (high - low)
        held = np.clip(given, low, high)
        mean = self._mean(held, float(np.mean(held)), spacing, size)
        step = float(min(density.info().spacing))
        bottom, top = density.info().range
        # Optical depth is proportional to density, whose logarithm the volume holds.
        dense = _dense(density.info())
        rise = 10 ** (np.linspace(bottom, top, _STEPS) - dense)
        rise[0] = 0
        length = max(density.dimensions) * step / 20
        opacity = 1 - np.exp(-depth * rise * step / length)
        points = TransferFunction.from_matplotlib(cmap, (0.0, 1.0)).color
        shades = np.stack([np.interp(np.linspace(0, 1, _STEPS), points[:, 0], points[:, c]) for c in (1, 2, 3)], axis=1)
        pixels = np.empty((_STEPS, _STEPS, 4), np.float32)
        pixels[..., 3] = opacity
        pixels[..., :3] = shades[::-1, None, :] * opacity[None, :, None]
        function = TransferFunction(second={"volume": name}, unit_distance=step,
                                    image={"pixels": pixels, "value": (bottom, top), "second": (low - margin, high + margin)})
        colored_by = mean.replace(name=name, visible=False, casts_shadow=False)
        return [density.replace(transfer_function=function, shading="none"), colored_by]


def _made(struct: Any) -> Volume:
    return volume_of_handle(made(lib.hl_volume_from_particles, "hl_volume", lib.hl_volume_release, context, struct))


def _dense(info: Info) -> float:
    """The logarithm of the density that one in a thousand voxels with matter exceeds."""
    bottom, top = info.range
    counts = info.histogram.astype(float)
    counts[0] = 0  # voxels without matter have the least number
    if not counts.sum() > 0:
        return top
    above = np.cumsum(counts[::-1])[::-1]
    return bottom + (top - bottom) * (int(np.sum(above > above[0] / 1000)) / len(counts))


def _box(periodic: Any) -> tuple[list[float], list[float]]:
    """The origin of a periodic box, and the lengths of its edges."""
    if periodic is None:
        return [0.0] * 3, [0.0] * 3
    if np.ndim(periodic) == 2:
        low, high = (numbers_of("periodic", corner, 3) for corner in periodic)
        return list(low), [b - a for a, b in zip(low, high, strict=True)]
    lengths = [number("periodic", periodic)] * 3 if np.ndim(periodic) == 0 else list(numbers_of("periodic", periodic, 3))
    return [0.0] * 3, lengths
