"""Reads the keyword `iso` of volumes, which gives surfaces on which a volume has one value."""
from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from . import _settings, colors
from ._library import ffi, lib

__all__ = ["fill", "isosurfaces_from"]

_WORDS = ("value", "color", "opacity")


def _parts_of(place: str, given: Any) -> dict[str, Any]:
    """Converts a surface to a mapping. It may be a number, a sequence (value, color, opacity) whose last elements may
    be absent, or a mapping already.
    """
    if isinstance(given, Mapping):
        for word in given:
            if word not in (*_WORDS, "second_color"):
                raise TypeError(f"{place}: there is no '{word}': use value, color, opacity and second_color")
        parts = dict(given)
    elif isinstance(given, tuple) and 1 <= len(given) <= 3:
        parts = {str(word): one for word, one in zip(_WORDS, given, strict=False)}
    elif not isinstance(given, (str, bytes, tuple)) and np.ndim(given) == 0:
        parts = {"value": given}
    else:
        raise TypeError(f"{place}: {given!r} is no value and no (value, color, opacity)")
    if "value" not in parts:
        raise TypeError(f"{place}: has no value")
    return parts


def _list_of(iso: Any) -> Sequence[Any]:
    """The list of surfaces. A single surface need not be in a list."""
    return iso if isinstance(iso, list) else [iso]


def fill(struct: Any, iso: Any, keep: list[Any], place: str) -> None:
    """Set the isosurfaces of an hl_scene_volume, which are valid as long as `keep`."""
    given = _list_of(iso)
    array = ffi.new("hl_isosurface[]", len(given))
    for n, one in enumerate(given):
        at = f"{place}iso[{n}]"
        parts = _parts_of(at, one)
        lib.hl_isosurface_defaults(ffi.addressof(array[n]))
        array[n].value = _settings.number(f"{at}: value", parts["value"])
        if parts.get("color") is not None:
            array[n].color = colors.linear_color(f"{at}: color", parts["color"])
        if parts.get("opacity") is not None:
            array[n].opacity = _settings.number(f"{at}: opacity", parts["opacity"])
        array[n].second_color = bool(parts.get("second_color", False))
    keep.append(array)
    struct.iso, struct.iso_count = array, len(given)


def isosurfaces_from(struct: Any) -> list[Any]:
    """The isosurfaces of an hl_scene_volume: (value, color, opacity), or a mapping of one in another volume's colours."""
    return [{"value": one.value, "color": tuple(one.color), "opacity": one.opacity, "second_color": True} if one.second_color
            else (one.value, tuple(one.color), one.opacity) for one in struct.iso[0:struct.iso_count]]
