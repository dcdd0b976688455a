"""Defines images of lights: slides that a light projects, and pictures on a light's own surface."""
from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from . import _settings, colors
from ._library import call, context, ffi, lib, path_bytes
from ._words import suggests

__all__ = ["EmissionImage", "Texture"]

Pixels = np.ndarray[Any, np.dtype[np.float32]]


def _read(path: str) -> Pixels:
    """The file's linear RGB, [height][width][3]."""
    place = ffi.new("hl_image **")
    call(lib.hl_image_read, context, path_bytes(path), place, path=path)
    image = ffi.gc(place[0], lib.hl_image_destroy)
    shape = (lib.hl_image_height(image), lib.hl_image_width(image), 4)
    held = ffi.buffer(lib.hl_image_pixels(image), 4 * shape[0] * shape[1] * 4)
    return np.frombuffer(held, np.float32).reshape(shape)[..., :3].copy()


def pixels_of(place: str, image: Any) -> Pixels:
    """The image as linear RGB, [height][width][3]."""
    if isinstance(image, (str, os.PathLike)):
        return _read(os.fspath(image))
    values = np.asarray(image)
    if values.ndim == 2:
        values = np.repeat(values[..., None], 3, axis=2)
    if values.ndim != 3 or values.shape[2] not in (3, 4) or 0 in values.shape:
        raise ValueError(f"{place}image: the shape {values.shape} is not (height, width) with 3 or 4 numbers a pixel")
    if values.dtype == np.uint8:
        values = colors.to_linear(values / 255.0)
    elif values.dtype.kind != "f":
        raise TypeError(f"{place}image: {values.dtype} is neither uint8 (sRGB) nor float (linear)")
    return np.ascontiguousarray(values[..., :3], np.float32)


def _fill_image(struct: Any, keep: list[Any], place: str, image: Any, file: str | None) -> None:
    pixels = pixels_of(place, image)
    keep += [pixels, pointer := ffi.from_buffer("float[]", pixels)]
    struct.pixels, struct.width, struct.height = pointer, pixels.shape[1], pixels.shape[0]
    name = os.fspath(image) if isinstance(image, (str, os.PathLike)) else file
    if name is not None:
        keep.append(text := ffi.new("char[]", path_bytes(name)))
        struct.file = text


def _image_of(struct: Any) -> dict[str, Any]:
    held = ffi.buffer(struct.pixels, 4 * struct.width * struct.height * 3)
    pixels = np.frombuffer(held, np.float32).reshape(struct.height, struct.width, 3).copy()
    return {"image": pixels, "file": None if struct.file == ffi.NULL else os.fsdecode(ffi.string(struct.file))}


@dataclass(frozen=True)
class Texture:
    """An image that a light projects through a screen. Rays that miss the screen are dark.

    Parameters
    ----------
    image : path or array_like, shape (height, width, 3)
        A .png, .exr or .npy file, or pixels, top row first. Pixels of uint8 are sRGB, and floats are linear. Grey
        pixels need no last axis.
    center, right, up : (x, y, z)
        The screen's middle, and from there to the middles of its right edge and of its top edge.
    file : str, optional
        What a scene file calls an image that is an array.

    Examples
    --------
    >>> import numpy as np
    >>> slide = Texture(np.eye(8), center=(0, 0, 50), right=(20, 0, 0), up=(0, 20, 0))
    """

    image: Any = field(repr=False, compare=False)
    center: Sequence[float]
    right: Sequence[float]
    up: Sequence[float]
    file: str | None = None

    def _fill(self, struct: Any, keep: list[Any], place: str) -> None:
        _fill_image(struct, keep, place, self.image, self.file)
        for word in ("center", "right", "up"):
            setattr(struct, f"screen_{word}", _settings.numbers_of(f"{place}{word}", getattr(self, word)))


@dataclass(frozen=True)
class EmissionImage:
    """An image on the surface of an extended light: soft shadows have its shape and colours.

    Parameters
    ----------
    image : path or array_like, shape (height, width, 3)
        As for `Texture`.
    up : (x, y, z)
        The direction of the image's top. For a `Rect`, the light's second edge gives this direction.
    file : str, optional
        What a scene file calls an image that is an array.
    """

    image: Any = field(repr=False, compare=False)
    up: Sequence[float] = (0.0, 1.0, 0.0)
    file: str | None = None

    def _fill(self, struct: Any, keep: list[Any], place: str) -> None:
        _fill_image(struct, keep, place, self.image, self.file)
        struct.up = _settings.numbers_of(f"{place}up", self.up)


for _class in (Texture, EmissionImage):
    _class.__init__ = suggests(_class.__init__)  # type: ignore[method-assign]


def texture_from(struct: Any) -> Texture | None:
    """The texture of an hl_light_texture."""
    if struct.pixels == ffi.NULL:
        return None
    center, right, up = (tuple(getattr(struct, f"screen_{word}")) for word in ("center", "right", "up"))
    return Texture(center=center, right=right, up=up, **_image_of(struct))


def emission_from(struct: Any) -> EmissionImage | None:
    """The image of an hl_light_emission."""
    return None if struct.pixels == ffi.NULL else EmissionImage(up=tuple(struct.up), **_image_of(struct))
