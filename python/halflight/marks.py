"""Reads the keyword `marks`, which gives measures and texts that stand in a scene."""
from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from . import _settings
from ._library import ffi

__all__ = ["fill", "marks_from"]

_KINDS = ("ruler", "angle", "line", "arrow", "text")  # in the order of hl_mark_kind


def _fill_one(mark: Any, given: Any, keep: list[Any], place: str) -> None:
    if not isinstance(given, Mapping) or given.get("kind") not in _KINDS:
        raise TypeError(f"{place}: {given!r} is no mapping with a kind: one of {', '.join(_KINDS)}")
    for word in given:
        if word not in ("kind", "points", "text"):
            raise TypeError(f"{place}: a mark has no '{word}': use kind, points and text")
    points = [_settings.numbers_of(f"{place}: points[{p}]", point, 3) for p, point in enumerate(given.get("points", ()))]
    keep += [array := ffi.new("double[][3]", points), text := ffi.new("char[]", str(given.get("text", "")).encode("utf-8", "replace"))]
    mark.kind, mark.points, mark.point_count, mark.text = _KINDS.index(given["kind"]), array, len(points), text


def fill(struct: Any, marks: Any, keep: list[Any]) -> None:
    """Set the marks of an hl_scene_description, which are valid as long as `keep`. A single mark need not be in a
    list.
    """
    given = [marks] if isinstance(marks, Mapping) else list(marks)
    array = ffi.new("hl_mark[]", len(given))
    for n, one in enumerate(given):
        _fill_one(array[n], one, keep, f"marks[{n}]")
    keep.append(array)
    struct.marks, struct.mark_count = array, len(given)


def marks_from(struct: Any) -> list[dict[str, Any]]:
    """The marks of an hl_scene_description."""
    return [{"kind": _KINDS[mark.kind], "points": [tuple(point) for point in mark.points[0:mark.point_count]],
             "text": "" if mark.text == ffi.NULL else ffi.string(mark.text).decode()} for mark in struct.marks[0:struct.mark_count]]
