"""Reads the keywords `second`, `boxes`, `polygons`, `image` and `curves` of TransferFunction, which make it a function of two
numbers.
"""
from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from . import colors
from ._library import ffi, lib, text_of
from ._settings import number, numbers_of

__all__ = ["Plane"]

_BOX = {"value": None, "second": None, "color": (1.0, 1.0, 1.0), "opacity": 0.5, "edge": (0.0, 0.0), "sigma": 0.0}
_POLYGON = {"vertices": None, "apex": None, "color": (1.0, 1.0, 1.0), "opacity": 0.5, "falloff": 1.0}
_IMAGE = {"pixels": None, "value": None, "second": None}
_CURVES: dict[str, Any] = {"opacity": None, "color": (), "own_color": (), "own_between": (0.0, 0.0)}


def _parts(place: str, given: Any, standard: Mapping[str, Any], optional: Sequence[str] = ()) -> dict[str, Any]:
    """The members of a shape. Members that are not given are taken from `standard`."""
    if not isinstance(given, Mapping):
        raise TypeError(f"{place}: {given!r} is no dict")
    for word in given:
        if word not in standard:
            raise TypeError(f"{place}: there is no '{word}': use {', '.join(standard)}")
    parts = {**standard, **given}
    for word in standard:
        if parts[word] is None and word not in optional:
            raise TypeError(f"{place}: has no {word}")
    return parts


def _look(place: str, parts: dict[str, Any]) -> None:
    parts["color"] = tuple(colors.linear_color(f"{place}: color", parts["color"]))
    parts["opacity"] = number(f"{place}: opacity", parts["opacity"])


def _box(place: str, given: Any) -> dict[str, Any]:
    parts = _parts(place, given, _BOX)
    for word in ("value", "second", "edge"):
        parts[word] = tuple(numbers_of(f"{place}: {word}", parts[word], 2))
    parts["sigma"] = number(f"{place}: sigma", parts["sigma"])
    _look(place, parts)
    return parts


def _polygon(place: str, given: Any) -> dict[str, Any]:
    parts = _parts(place, given, _POLYGON, ["apex"])
    parts["vertices"] = [tuple(numbers_of(f"{place}: vertices[{n}]", one, 2)) for n, one in enumerate(parts["vertices"])]
    if len(parts["vertices"]) < 3:
        raise ValueError(f"{place}: has fewer than three vertices")
    middle = np.mean(parts["vertices"], axis=0)
    parts["apex"] = tuple(numbers_of(f"{place}: apex", middle if parts["apex"] is None else parts["apex"], 2))
    parts["falloff"] = number(f"{place}: falloff", parts["falloff"])
    _look(place, parts)
    return parts


def _image(place: str, given: Any) -> dict[str, Any]:
    parts = _parts(place, given, _IMAGE)
    pixels = np.ascontiguousarray(parts["pixels"], dtype=np.float32)
    if pixels.ndim != 3 or pixels.shape[2] != 4:
        raise ValueError(f"{place}: pixels have the shape {pixels.shape}, not (height, width, 4)")
    parts["pixels"] = pixels
    for word in ("value", "second"):
        parts[word] = tuple(numbers_of(f"{place}: {word}", parts[word], 2))
    return parts


def _points(place: str, given: Any, width: int) -> list[tuple[float, ...]]:
    """Rows of numbers, sorted by the first one."""
    return sorted((tuple(numbers_of(f"{place}[{n}]", one, width)) for n, one in enumerate(given)), key=lambda row: row[0])


def _curves(place: str, given: Any) -> dict[str, Any]:
    parts = _parts(place, given, _CURVES)
    return {"opacity": _points(f"{place}: opacity", parts["opacity"], 2), "color": _points(f"{place}: color", parts["color"], 4),
            "own_color": _points(f"{place}: own_color", parts["own_color"], 4),
            "own_between": tuple(numbers_of(f"{place}: own_between", parts["own_between"], 2))}


class Plane:
    """The shapes, the image and the curves of a function of two numbers in the plane of these numbers. Users give them as keywords
    of TransferFunction.
    """

    __slots__ = ("boxes", "curves", "image", "polygons", "second")

    def __init__(self, place: str, second: Any, boxes: Any, polygons: Any, image: Any, curves: Any) -> None:
        if isinstance(second, Mapping) and list(second) == ["volume"]:
            second = {"volume": str(second["volume"])}
        elif second is not None and second != "gradient":
            raise ValueError(f'{place}second: {second!r} is neither "gradient" nor {{"volume": name}}')
        self.second: Any = second
        self.boxes = [_box(f"{place}boxes[{n}]", one) for n, one in enumerate(boxes)]
        self.polygons = [_polygon(f"{place}polygons[{n}]", one) for n, one in enumerate(polygons)]
        self.image: Any = None if image is None else _image(f"{place}image", image)
        self.curves: Any = None if curves is None else _curves(f"{place}curves", curves)
        if second is None and (self.boxes or self.polygons or self.image or self.curves):
            raise TypeError(f'{place}boxes, polygons, images and curves need second="gradient" or second={{"volume": name}}')

    def arguments(self) -> dict[str, Any]:
        """The keywords of TransferFunction that make this."""
        words = ("second", "boxes", "polygons", "image", "curves")
        return {word: getattr(self, word) for word in words if getattr(self, word)}

    def equals(self, other: Plane) -> bool:
        """Whether the other plane shows the same."""
        if (self.image is None) != (other.image is None):
            return False
        return ((self.second, self.boxes, self.polygons, self.curves)
                == (other.second, other.boxes, other.polygons, other.curves)
                and (self.image is None or all(np.array_equal(self.image[word], other.image[word]) for word in _IMAGE)))

    def fill(self, struct: Any, keep: list[Any]) -> None:
        """Set an hl_function_plane, which is valid as long as `keep`."""
        if self.second is None:
            struct.second = lib.HL_SECOND_NONE
            return
        struct.second = lib.HL_SECOND_GRADIENT
        if self.second != "gradient":
            struct.second = lib.HL_SECOND_VOLUME
            keep.append(name := ffi.new("char[]", self.second["volume"].encode()))
            struct.volume = name
        keep.append(boxes := ffi.new("hl_function_box[]", len(self.boxes)))
        for made, one in zip(boxes, self.boxes, strict=True):
            made.low, made.high = zip(one["value"], one["second"], strict=True)
            made.color, made.opacity, made.edge, made.sigma = one["color"], one["opacity"], one["edge"], one["sigma"]
        keep.append(polygons := ffi.new("hl_function_polygon[]", len(self.polygons)))
        for made, one in zip(polygons, self.polygons, strict=True):
            keep.append(vertices := ffi.new("double[][2]", one["vertices"]))
            made.vertices, made.vertex_count = vertices, len(one["vertices"])
            made.apex, made.color, made.opacity, made.falloff = one["apex"], one["color"], one["opacity"], one["falloff"]
        struct.boxes, struct.box_count = boxes, len(self.boxes)
        struct.polygons, struct.polygon_count = polygons, len(self.polygons)
        if self.curves is not None:
            keep.append(opacity := ffi.new("hl_opacity_point[]", self.curves["opacity"]))
            keep.append(color := ffi.new("hl_color_point[]", [(row[0], row[1:]) for row in self.curves["color"]]))
            struct.curves.opacity, struct.curves.opacity_count = opacity, len(self.curves["opacity"])
            struct.curves.color, struct.curves.color_count = color, len(self.curves["color"])
            keep.append(own := ffi.new("hl_color_point[]", [(row[0], row[1:]) for row in self.curves["own_color"]]))
            struct.curves.own_color, struct.curves.own_color_count = own, len(self.curves["own_color"])
            struct.curves.own_between = self.curves["own_between"]
        if self.image is not None:
            pixels = self.image["pixels"]
            keep.append(pixels)
            struct.image.pixels = ffi.cast("float *", pixels.ctypes.data)
            struct.image.height, struct.image.width = pixels.shape[:2]
            struct.image.low, struct.image.high = zip(self.image["value"], self.image["second"], strict=True)


def plane_from(struct: Any) -> Plane:
    """The plane of an hl_function_plane."""
    second: Any = None
    if struct.second == lib.HL_SECOND_GRADIENT:
        second = "gradient"
    elif struct.second == lib.HL_SECOND_VOLUME:
        second = {"volume": text_of(struct.volume)}
    boxes = [{"value": (one.low[0], one.high[0]), "second": (one.low[1], one.high[1]), "color": tuple(one.color),
              "opacity": one.opacity, "edge": tuple(one.edge), "sigma": one.sigma}
             for one in (struct.boxes[n] for n in range(struct.box_count))]
    polygons = [{"vertices": [tuple(one.vertices[v]) for v in range(one.vertex_count)], "apex": tuple(one.apex),
                 "color": tuple(one.color), "opacity": one.opacity, "falloff": one.falloff}
                for one in (struct.polygons[n] for n in range(struct.polygon_count))]
    image = None
    if struct.image.pixels != ffi.NULL:
        shape = (struct.image.height, struct.image.width, 4)
        pixels = np.frombuffer(ffi.buffer(struct.image.pixels, 4 * int(np.prod(shape))), np.float32).reshape(shape).copy()
        low, high = struct.image.low, struct.image.high
        image = {"pixels": pixels, "value": (low[0], high[0]), "second": (low[1], high[1])}
    curves = None
    if struct.curves.opacity_count > 0:
        opacity, color, own = struct.curves.opacity, struct.curves.color, struct.curves.own_color
        curves = {"opacity": [(opacity[n].value, opacity[n].opacity) for n in range(struct.curves.opacity_count)],
                  "color": [(color[n].value, *color[n].color) for n in range(struct.curves.color_count)],
                  "own_color": [(own[n].value, *own[n].color) for n in range(struct.curves.own_color_count)],
                  "own_between": tuple(struct.curves.own_between)}
    return Plane("TransferFunction: ", second, boxes, polygons, image, curves)
