"""Reads the keyword `cuts` of volumes and scenes, which gives the parts that are cut out of them."""
from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from . import _settings
from ._library import ffi, lib

__all__ = ["cuts_from", "fill"]

_TYPES = {"plane": ("point", "normal"), "box": ("min", "max"), "sphere": ("center", "radius")}
_SIDES = ("outside", "inside")


def _three(place: str, given: Any) -> list[float]:
    if isinstance(given, (str, bytes)) or len(given) != 3:
        raise TypeError(f"{place}: {given!r} is no (x, y, z)")
    return [_settings.number(f"{place}[{a}]", one) for a, one in enumerate(given)]


def _fill_one(cut: Any, given: Any, place: str) -> None:
    if not isinstance(given, Mapping) or given.get("type") not in _TYPES:
        raise TypeError(f"{place}: {given!r} is no mapping with a type: one of {', '.join(_TYPES)}")
    words = _TYPES[given["type"]]
    for word in given:
        if word not in ("type", "keep", "world", *words):
            raise TypeError(f"{place}: a {given['type']} has no '{word}': use {words[0]}, {words[1]}, keep and world")
    lib.hl_cut_defaults(ffi.addressof(cut))
    cut.type = list(_TYPES).index(given["type"])
    for word in words:
        if word not in given:
            raise TypeError(f"{place}: has no {word}")
        at = f"{place}: {word}"
        setattr(cut, word, _settings.number(at, given[word]) if word == "radius" else _three(at, given[word]))
    keep = given.get("keep", "outside")
    if keep not in _SIDES:
        raise ValueError(f"{place}: keep: {keep!r} is not outside or inside")
    cut.keep = _SIDES.index(keep)
    if type(world := given.get("world", False)).__name__ not in ("bool", "bool_"):
        raise TypeError(f"{place}: world: {world!r} is neither True nor False")
    cut.world = int(bool(world))


def fill(struct: Any, cuts: Any, keep: list[Any], place: str) -> None:
    """Set the cuts of an hl_scene_volume or hl_scene_description, which are valid as long as `keep`. A single cut need
    not be in a list.
    """
    given = [cuts] if isinstance(cuts, Mapping) else list(cuts)
    array = ffi.new("hl_cut[]", len(given))
    for n, one in enumerate(given):
        _fill_one(array[n], one, f"{place}cuts[{n}]")
    keep.append(array)
    struct.cuts, struct.cut_count = array, len(given)


def cuts_from(struct: Any) -> list[dict[str, Any]]:
    """The cuts of an hl_scene_volume or hl_scene_description."""
    made = []
    for cut in struct.cuts[0:struct.cut_count]:
        name = list(_TYPES)[cut.type]
        parts = {word: cut.radius if word == "radius" else tuple(getattr(cut, word)) for word in _TYPES[name]}
        made.append({"type": name, **parts, "keep": _SIDES[cut.keep], **({"world": True} if cut.world else {})})
    return made
