"""Defines lights. There is one frozen dataclass for each of the scene file's types of lights.

Lengths are in world units, angles in degrees, colours linear RGB. A light with ``frame="camera"`` moves with the
camera. Its x axis points to the camera's right, y up, and z towards the viewer; the origin is the camera's target.
"""
from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields
from typing import Any, ClassVar, Literal

from . import _settings
from ._library import ffi, lib
from ._words import suggests
from .light_images import EmissionImage, Texture, emission_from, texture_from

__all__ = ["Directional", "Disk", "EmissionImage", "Light", "Point", "Polygon", "Rect", "Spot", "Texture", "images_are_same"]

Vector = Sequence[float]


@dataclass(frozen=True, kw_only=True)
class Light:
    """The properties that all lights have.

    Parameters
    ----------
    color : (r, g, b)
        Linear RGB.
    intensity : float
        A factor on `color`. The light that arrives is ``color * intensity``, independently of the light's size and
        distance.
    falloff : str
        "none", or "inverse_square": divided by the square of the distance from the light's centre.
    shadows : str, optional
        "off", "hard" or "soft". Default: as the scene says.
    frame : str
        "world" or "camera": the axes that places and directions are in.
    texture : Texture, optional
        An image that the light projects, like a slide.
    emission : EmissionImage, optional
        An image on the light's own surface; not beside a texture.
    """

    color: Vector = (1.0, 1.0, 1.0)
    intensity: float = 1.0
    falloff: Literal["none", "inverse_square"] = "none"
    shadows: Literal["off", "hard", "soft"] | None = None
    frame: Literal["world", "camera"] = "world"
    texture: Texture | None = None
    emission: EmissionImage | None = None
    _type: ClassVar[int]

    def _fill(self, struct: Any, keep: list[Any], place: str) -> None:
        lib.hl_light_defaults(ffi.addressof(struct))
        struct.type = self._type
        given = {one.name: getattr(self, one.name) for one in fields(self)}
        for word, kind in (("texture", Texture), ("emission", EmissionImage)):
            if (image := given.pop(word)) is None:
                continue
            if not isinstance(image, kind):
                raise TypeError(f"{place}{word}: {image!r} is no {kind.__name__}")
            image._fill(getattr(struct, word), keep, f"{place}{word}: ")
        vertices = given.pop("vertices", None)
        if vertices is not None:
            corners = [_settings.numbers_of(f"{place}vertices[{n}]", corner) for n, corner in enumerate(vertices)]
            keep.append(array := ffi.new("double[][3]", corners))
            struct.vertices, struct.vertex_count = array, len(corners)
        _settings.fill(place, struct, lib.HL_SETTINGS_LIGHT, given)


@dataclass(frozen=True, kw_only=True)
class Directional(Light):
    """Parallel light, or a disk of directions.

    Parameters
    ----------
    direction : (x, y, z)
        The direction in which the light travels.
    angular_diameter_deg : float
        Above 0, shadows can be soft; the sun has 0.5.

    Examples
    --------
    >>> Directional(direction=(1, 1, -2), angular_diameter_deg=7).direction
    (1, 1, -2)
    """

    direction: Vector = (0.0, 0.0, -1.0)
    angular_diameter_deg: float = 0.0
    _type: ClassVar[int] = lib.HL_LIGHT_DIRECTIONAL

    @classmethod
    def beside_camera(cls, azimuth_deg: float, elevation_deg: float, **values: Any) -> Directional:
        """A light that moves with the camera: (0, 0) is a headlight, (-40, 45) comes from the upper left.

        Examples
        --------
        >>> Directional.beside_camera(0, 0).direction
        (0.0, 0.0, -1.0)
        """
        direction = ffi.new("double[3]")
        lib.hl_light_direction_beside(azimuth_deg, elevation_deg, direction)
        return cls(direction=tuple(one + 0.0 for one in direction), frame="camera", **values)


@dataclass(frozen=True, kw_only=True)
class Point(Light):
    """A point or, with a radius, a sphere. `position` is its centre (x, y, z)."""

    position: Vector = (0.0, 0.0, 0.0)
    radius: float = 0.0
    _type: ClassVar[int] = lib.HL_LIGHT_POINT


@dataclass(frozen=True, kw_only=True)
class Spot(Light):
    """A point or a sphere that shines within a cone.

    Parameters
    ----------
    position, direction : (x, y, z)
        The light's centre, and the direction in which the light travels along the cone's axis.
    radius : float
        World units.
    opening_angle_deg, falloff_angle_deg : float
        The cone's full angle, and the width of the smooth edge within it.
    """

    position: Vector = (0.0, 0.0, 0.0)
    direction: Vector = (0.0, 0.0, -1.0)
    radius: float = 0.0
    opening_angle_deg: float = 40.0
    falloff_angle_deg: float = 5.0
    _type: ClassVar[int] = lib.HL_LIGHT_SPOT


@dataclass(frozen=True, kw_only=True)
class Rect(Light):
    """A parallelogram: `position` is its centre, `edge1` and `edge2` are its full edges (x, y, z)."""

    position: Vector = (0.0, 0.0, 0.0)
    edge1: Vector = (1.0, 0.0, 0.0)
    edge2: Vector = (0.0, 1.0, 0.0)
    _type: ClassVar[int] = lib.HL_LIGHT_RECT


@dataclass(frozen=True, kw_only=True)
class Disk(Light):
    """A flat disk: centre `position`, `normal` (x, y, z) and `radius`."""

    position: Vector = (0.0, 0.0, 0.0)
    normal: Vector = (0.0, 0.0, -1.0)
    radius: float = 0.0
    _type: ClassVar[int] = lib.HL_LIGHT_DISK


@dataclass(frozen=True, kw_only=True)
class Polygon(Light):
    """A flat polygon, convex or not: at least three `vertices` (x, y, z), in order around it."""

    vertices: Sequence[Vector] = ()
    _type: ClassVar[int] = lib.HL_LIGHT_POLYGON


_CLASSES: tuple[type[Light], ...] = (Directional, Point, Spot, Rect, Disk, Polygon)
for _class in _CLASSES:
    _class.__init__ = suggests(_class.__init__)  # type: ignore[method-assign]


def images_are_same(one: Light, other: Light) -> bool:
    """Whether the images of two lights are the same. A comparison of the lights themselves ignores pixels."""
    return all(_settings.same(a.image, b.image) for a, b in ((one.texture, other.texture), (one.emission, other.emission))
               if a is not None and b is not None)


def light_from(struct: Any) -> Light:
    """The light of a struct."""
    kind = next(one for one in _CLASSES if one._type == struct.type)
    values = _settings.read(struct, lib.HL_SETTINGS_LIGHT, struct.type)
    del values["type"]
    if kind is Polygon:
        values["vertices"] = tuple(tuple(struct.vertices[n]) for n in range(struct.vertex_count))
    values["texture"], values["emission"] = texture_from(struct.texture), emission_from(struct.emission)
    return kind(**values)
