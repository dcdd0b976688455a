"""Reads the keyword `mask` of volumes, which gives a label map over the volume."""
from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from . import _settings, colors
from ._library import call, context, ffi, lib, text_of

__all__ = ["fill", "fill_labels", "labels_from"]

_WORDS = ("volume", "show", "rest", "table")


def _labels_of(volume: Any, table: Any, keep: list[Any]) -> tuple[Any, int]:
    """All labels of a label map, an hl_volume, owned by `keep`."""
    labels, count = ffi.new("hl_label **"), ffi.new("size_t *")
    path = ffi.NULL if table is None else ffi.new("char[]", str(table).encode())
    call(lib.hl_labels_of_volume, context, volume, path, labels, count)
    keep.append(ffi.gc(labels[0], lambda found: lib.hl_labels_release(context, found)))
    return labels[0], int(count[0])


def _is_named(label: Any, name: Any) -> bool:
    if isinstance(name, str):
        return label.name != ffi.NULL and text_of(label.name) == name
    return bool(label.value == name)


def _change(place: str, label: Any, given: Any) -> None:
    """Give a label a colour, an opacity, or both."""
    color, opacity = given if isinstance(given, tuple) and len(given) == 2 else (None, given)
    if isinstance(opacity, (str, tuple, list)):
        color, opacity = opacity, None
    if color is not None:
        label.color = colors.linear_color(f"{place}: colour", color)
        label.tint = 1
    if opacity is not None:
        label.opacity = _settings.number(f"{place}: opacity", opacity)


def _show(place: str, show: Any, labels: Any, count: int) -> int:
    """Move the labels that are named to the front of the list. Returns their number."""
    wanted = show if isinstance(show, Mapping) else dict.fromkeys([show] if np.ndim(show) == 0 else show)
    named = set[int]()
    for name, given in wanted.items():
        found = [n for n in range(count) if _is_named(labels[n], name)]
        if not found:
            raise ValueError(f"{place}: there is no label {name!r}")
        for n in found:
            _change(f"{place}[{name!r}]", labels[n], given)
        named.update(found)
    for kept, n in enumerate(sorted(named)):
        if kept != n:
            labels[kept] = labels[n]
    return len(named)


def fill_labels(struct: Any, given: Any, handle: Any, keep: list[Any], place: str) -> None:
    """Set the labels of an hl_scene_volume that is a label map, which are valid as long as `keep`."""
    parts = given if isinstance(given, Mapping) and given.keys() & {"show", "table"} else {"show": given}
    for word in parts:
        if word not in ("show", "table"):
            raise TypeError(f"{place}labels: there is no '{word}': use show and table")
    labels, count = _labels_of(handle, parts.get("table"), keep)
    show = parts.get("show")
    if show is not None and show is not True:
        count = _show(f"{place}labels", show, labels, count)
    elif count == 0:
        raise ValueError(f"{place}labels: the volume has no labels: whole numbers other than 0")
    struct.labels, struct.label_count = labels, count


def labels_from(labels: Any, count: int, tints: bool) -> dict[int, tuple[tuple[float, ...] | None, float]]:
    """The visible labels in the form that `show` takes: colour and opacity by number. tints: whether the labels belong
    to a mask, so that they may have no colour.
    """
    return {one.value: (tuple(one.color) if one.tint or not tints else None, one.opacity) for one in labels[0:count] if one.visible}


def fill(struct: Any, mask: Any, as_volume: Callable[[Any], Any], keep: list[Any], place: str) -> None:
    """Set the mask of an hl_scene_volume, which is valid as long as `keep`."""
    parts = dict(mask) if isinstance(mask, Mapping) else {"volume": mask}
    for word in parts:
        if word not in _WORDS:
            raise TypeError(f"{place}mask: there is no '{word}': use volume, show, rest and table")
    if "volume" not in parts:
        raise TypeError(f"{place}mask: has no volume")
    volume = as_volume(parts["volume"])
    labels, count = _labels_of(volume._handle, parts.get("table"), keep)
    if parts.get("show") is not None:
        count = _show(f"{place}mask: show", parts["show"], labels, count)
    keep.append(volume)
    struct.mask.volume, struct.mask.labels, struct.mask.label_count = volume._handle, labels, count
    struct.mask.rest = _settings.number(f"{place}mask: rest", parts.get("rest", 0))
    struct.mask.file = ffi.NULL
    if volume._file is not None:
        keep.append(text := volume._file_text())
        struct.mask.file = text
