"""Colours and colormaps.

Numbers are linear RGB, as everywhere in Halflight. Names, "#rrggbb" and matplotlib's colormaps are sRGB, and
are made linear here.
"""
from __future__ import annotations

from typing import Any

import numpy as np

from ._library import ffi, lib, names
from ._settings import numbers_of
from ._words import nearest

__all__ = ["colormaps", "srgb"]

# Matplotlib's names of one letter. If matplotlib is installed, it gives others, and names that CSS does not have.
_LETTERS = {"k": "black", "w": "white"}

# The names that messages of errors suggest.
_COMMON = ("black", "white", "red", "lime", "green", "blue", "yellow", "cyan", "magenta", "gray", "grey", "silver", "orange", "purple",
           "brown", "pink", "gold", "navy", "teal", "ivory", "tan", "skyblue", "tomato")


# Names that other programs have for the library's colormap "grays", although they are CSS colours, too.
_GRAYS = ("gray", "grey")


def colormaps() -> list[str]:
    """The library's own colormaps.

    Examples
    --------
    >>> "viridis" in colormaps()
    True
    """
    return names(lib.hl_colormap_name)


def to_linear(srgb: Any) -> Any:
    """sRGB values from 0 to 1 as linear light (IEC 61966-2-1)."""
    values = np.asarray(srgb, dtype=np.float64)
    return np.where(values <= 0.04045, values / 12.92, ((values + 0.055) / 1.055) ** 2.4)


def to_srgb(linear: Any) -> Any:
    """Linear light as sRGB values from 0 to 1 (IEC 61966-2-1). Values outside of this range are cut."""
    values = np.clip(np.asarray(linear, dtype=np.float64), 0, 1)
    return np.where(values <= 0.0031308, 12.92 * values, 1.055 * values ** (1 / 2.4) - 0.055)


def srgb(*color: Any) -> tuple[float, float, float]:
    """An sRGB colour as linear RGB, which is what numbers mean in Halflight.

    Parameters
    ----------
    color : three numbers from 0 to 1, one sequence of them, of uint8 from 0 to 255, or a name or "#rrggbb"
        As matplotlib, PyVista and CSS give them.

    Examples
    --------
    >>> srgb(1, 0.5, 0)
    (1.0, 0.21404114048223255, 0.0)
    >>> srgb("#ff8000") == srgb(np.array([255, 128, 0], np.uint8))
    True
    """
    given = color[0] if len(color) == 1 else color
    if isinstance(given, str):
        red, green, blue = linear_color("srgb()", given)
        return red, green, blue
    values = numbers_of("srgb()", given)
    if getattr(given, "dtype", None) == np.uint8:
        values = [value / 255 for value in values]
    for value in values:
        if not 0 <= value <= 1:
            raise ValueError(f"srgb(): {value:g} is not from 0 to 1: divide by 255, or give an array of uint8")
    red, green, blue = map(float, to_linear(values))
    return red, green, blue


def linear_color(place: str, color: Any) -> list[float]:
    """A colour as three numbers: a name, "#rrggbb", a grey level or linear RGB."""
    if isinstance(color, str):
        found = ffi.new("double[3]")
        if lib.python_color(_LETTERS.get(color, color).encode(), found):
            return list(found)
        try:
            from matplotlib.colors import to_rgb

            return [float(one) for one in to_linear(to_rgb(color))]
        except (ImportError, ValueError):
            raise ValueError(f"{place}: there is no colour '{color}'{nearest(color, _COMMON)}") from None
    if np.ndim(color) == 0:
        return 3 * numbers_of(place, [color], 1)
    return numbers_of(place, color)


def own_name(cmap: str) -> bytes:
    """The library's name of a colormap of which `sampled` makes no points."""
    return ("grays" if cmap in _GRAYS else cmap).encode()


def sampled(place: str, cmap: Any, low: float, high: float) -> list[list[float]] | None:
    """Colour points [value, r, g, b] from `low` to `high` for a colormap that the library does not name.

    `cmap` is a matplotlib colormap, its name, a colour, or a sequence of colours. Returns None if the library has the
    colormap.
    """
    if isinstance(cmap, str):
        if cmap in colormaps() or cmap in _GRAYS:
            return None
        cmap = _by_name(place, cmap)
    if not callable(cmap) and (not hasattr(cmap, "__len__") or len(cmap) == 0):
        raise TypeError(f"{place}: {cmap!r} is no colormap, colour or list of colours")
    if callable(cmap):
        colors = to_linear(np.asarray(cmap(np.linspace(0, 1, 256)))[:, :3])
    else:
        colors = np.asarray([linear_color(place, one) for one in cmap]) if np.ndim(cmap) != 1 or any(
            isinstance(one, str) for one in cmap) else np.asarray([linear_color(place, cmap)])
    if len(colors) == 0:
        raise ValueError(f"{place}: there is no colour in it")
    values = np.linspace(low, high, len(colors)) if len(colors) > 1 else [low]
    return [[float(value), *map(float, color)] for value, color in zip(values, colors, strict=True)]


def is_colormap(cmap: Any) -> bool:
    """Whether `cmap` has several colours, and is not one colour for all values."""
    points = None if cmap is None else sampled("cmap", cmap, 0.0, 1.0)
    return cmap is not None and (points is None or len(points) > 1)


def _by_name(place: str, name: str) -> Any:
    """A matplotlib colormap, or one colour."""
    try:
        from matplotlib import colormaps as of_matplotlib

        if name in of_matplotlib:
            return of_matplotlib[name]
    except ImportError:
        pass
    try:
        return [linear_color(place, name)]
    except ValueError:
        raise ValueError(f"{place}: there is no colormap or colour '{name}'{nearest(name, colormaps())}") from None
