"""Reads and sets fields of the library's structs by the names in its tables of settings (halflight/settings.h)."""
from __future__ import annotations

import functools
import numbers
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from ._library import ffi, lib, text_of
from ._words import choice


class Setting(NamedTuple):
    """A row of a table."""

    field: str
    type: int
    choices: dict[str, int]
    only_for: int
    standard: tuple[float, ...]


@functools.cache
def table(kind: int) -> dict[str, Setting]:
    """The rows of a table by the names of the struct's fields."""
    rows = {}
    for index in range(lib.hl_setting_count(kind)):
        row = lib.hl_setting_get(kind, index)
        choices: dict[str, int] = {}
        while row.choices != ffi.NULL and row.choices[len(choices)].name != ffi.NULL:
            one = row.choices[len(choices)]
            choices[text_of(one.name)] = one.value
        field = text_of(row.field)
        rows[field] = Setting(field, row.type, choices, row.only_for, tuple(row.standard))
    return rows


def number(place: str, value: Any) -> float:
    """A real number."""
    if isinstance(value, bool) or not isinstance(value, numbers.Real):
        if not (hasattr(value, "__float__") and getattr(value, "shape", None) == ()):
            raise TypeError(f"{place}: {value!r} is no number")
    return float(value)


def numbers_of(place: str, value: Any, count: int = 3) -> list[float]:
    """A sequence of `count` real numbers."""
    if isinstance(value, (str, bytes)) or not hasattr(value, "__len__"):
        raise TypeError(f"{place}: {value!r} is not {count} numbers")
    if len(value) != count:
        raise ValueError(f"{place}: {len(value)} numbers where {count} are needed")
    return [number(f"{place}[{index}]", one) for index, one in enumerate(value)]


def same(one: Any, other: Any) -> bool:
    """Whether two values of keywords are the same. The values may be arrays, or may contain arrays."""
    if isinstance(one, Mapping) and isinstance(other, Mapping):
        return one.keys() == other.keys() and all(same(value, other[word]) for word, value in one.items())
    if isinstance(one, (list, tuple)) and isinstance(other, (list, tuple)):
        return len(one) == len(other) and all(map(same, one, other))
    if hasattr(one, "__array__") and hasattr(other, "__array__") and hasattr(one, "dtype"):
        return np.array_equal(np.asarray(one), np.asarray(other))
    return bool(one == other)


def size_of(place: str, value: Any) -> tuple[int, int]:
    """(width, height) in pixels of (width, height), one number for a square, or a text such as "640x480"."""
    if isinstance(value, str):
        parts = value.lower().replace("×", "x").split("x")
        if len(parts) not in (1, 2) or not all(part.strip().isdecimal() for part in parts):
            raise ValueError(f"{place}: '{value}' is no size: give (width, height), a number, or a text such as '640x480'")
        value = [int(part) for part in parts]
    elif not hasattr(value, "__len__") and not isinstance(value, bool) and hasattr(value, "__index__"):
        value = [int(value)]
    given = numbers_of(place, [*value] * 2 if isinstance(value, list) and len(value) == 1 else value, 2)
    for word, one in zip(("width", "height"), given, strict=True):
        if one != int(one):
            raise ValueError(f"{place}: {word}: {one!r} is no whole number")
    if min(given) < 1:
        raise ValueError(f"{place}: {given[0]:g} x {given[1]:g} pixels: give whole numbers from 1 on, (width, height)")
    return int(given[0]), int(given[1])


def to_field(place: str, setting: Setting, value: object) -> object:
    """`value` in the form in which cffi stores it in the struct's field."""
    if setting.type == lib.HL_SETTING_FLAG:
        if type(value).__name__ not in ("bool", "bool_"):
            raise TypeError(f"{place}: {value!r} is neither True nor False")
        return int(bool(value))
    if setting.type == lib.HL_SETTING_CHOICE or (setting.choices and isinstance(value, str)):
        return setting.choices[choice(place, value, setting.choices)]
    if setting.type == lib.HL_SETTING_WHOLE:
        whole = number(place, value)
        if whole != int(whole) or abs(whole) >= 2**31:
            raise ValueError(f"{place}: {value!r} is no whole number")
        return int(whole)
    if setting.type == lib.HL_SETTING_NUMBER:
        return number(place, value)
    return numbers_of(place, value)


def from_field(setting: Setting, value: Any) -> Any:
    """The Python value of a struct's field."""
    if setting.type == lib.HL_SETTING_FLAG:
        return bool(value)
    if setting.type == lib.HL_SETTING_CHOICE:
        return next((name for name, code in setting.choices.items() if code == value), None)
    if setting.type in (lib.HL_SETTING_NUMBER, lib.HL_SETTING_WHOLE):
        return value
    return tuple(value)


def names(kind: int, *without: str) -> list[str]:
    """The fields of a table, except the given ones."""
    return [field for field in table(kind) if field not in without]


def taken(values: dict[str, Any], fields: Sequence[str]) -> dict[str, Any]:
    """Take the values of these fields out of `values`."""
    return {field: values.pop(field) for field in fields if field in values}


def fill(place: str, struct: Any, kind: int, values: Mapping[str, object]) -> None:
    """Set the struct's fields that `values` names and that are not None."""
    rows = table(kind)
    for name, value in values.items():
        if value is not None:
            setattr(struct, name, to_field(f"{place}{name}", rows[name], value))


def read(struct: Any, kind: int, only_for: int | None = None) -> dict[str, Any]:
    """The struct's fields. For lights and cameras, only the fields that their type has."""
    return {name: from_field(row, getattr(struct, name)) for name, row in table(kind).items()
            if only_for is None or row.only_for == 0 or row.only_for & 1 << only_for}
