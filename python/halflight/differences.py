"""Compares two pictures by the numbers of ``halflight diff``."""
from __future__ import annotations

import os
from dataclasses import dataclass
from typing import Any

import numpy as np

from . import colors
from ._library import call, context, ffi, lib, made, path_bytes
from ._words import suggests
from .image import Image

__all__ = ["Difference", "diff"]


@dataclass(frozen=True)
class Difference:
    """The differences of picture b from picture a, in linear premultiplied R, G, B and A.

    Attributes
    ----------
    rmse : float
        Root mean square over all pixels and channels.
    rmse_channel, mean_signed : 4 floats
        The root mean square of each channel, and the mean of b - a in each channel.
    percentile_99_9 : float
        The percentile 99.9 of the greatest difference in each pixel.
    maximum : float
        The greatest difference.
    maximum_at : (x, y)
        The place of the greatest difference.
    differing_pixels : int
        The number of pixels that are not equal.
    """

    rmse: float
    rmse_channel: tuple[float, ...]
    mean_signed: tuple[float, ...]
    percentile_99_9: float
    maximum: float
    maximum_at: tuple[int, int]
    differing_pixels: int


def _handle_of(name: str, picture: Any) -> Any:
    """The hl_image of an Image, a file, or an array."""
    if isinstance(picture, Image):
        return picture._handle
    if isinstance(picture, (str, os.PathLike)):
        path = os.fspath(picture)
        return made(lib.hl_image_read, "hl_image", lib.hl_image_destroy, context, path_bytes(path), path=path)
    values = np.asarray(picture)
    if values.ndim != 3 or values.shape[2] not in (3, 4) or 0 in values.shape:
        raise ValueError(f"{name}: the shape {values.shape} is not (height, width, 3) or (height, width, 4)")
    if values.dtype == np.uint8:
        alpha = values[..., 3:] / 255.0 if values.shape[2] == 4 else 1.0
        values = np.concatenate([colors.to_linear(values[..., :3] / 255.0) * alpha, np.broadcast_to(alpha, (*values.shape[:2], 1))], axis=-1)
    elif values.dtype.kind != "f":
        raise TypeError(f"{name}: {values.dtype} is neither uint8 (sRGB) nor float (linear, premultiplied)")
    height, width = values.shape[:2]
    handle = made(lib.hl_image_create, "hl_image", lib.hl_image_destroy, context, width, height)
    pixels = np.frombuffer(ffi.buffer(lib.hl_image_pixels(handle), 16 * width * height), np.float32).reshape(height, width, 4)
    pixels[..., 3] = 1
    pixels[..., :values.shape[2]] = values
    return handle


@suggests
def diff(a: Any, b: Any) -> Difference:
    """Find the differences of picture `b` from picture `a`, as ``halflight diff A B`` does.

    Parameters
    ----------
    a, b : Image, path, or array of shape (height, width, 3 or 4)
        Two pictures of the same size. Files are .png, .exr, .npy or .hdr. Arrays of floats are linear premultiplied
        RGBA, as ``numpy.asarray(image)`` has it; arrays of uint8 are sRGB with unassociated alpha, as `Image.to_srgb8`
        makes them.

    Raises
    ------
    ValueError
        The pictures have different sizes.

    Examples
    --------
    >>> import numpy as np
    >>> told = diff(np.zeros((2, 3, 4)), np.full((2, 3, 4), 0.5))
    >>> told.rmse, told.differing_pixels
    (0.5, 6)
    """
    one, other = _handle_of("a", a), _handle_of("b", b)
    sizes = [(lib.hl_image_width(each), lib.hl_image_height(each)) for each in (one, other)]
    if sizes[0] != sizes[1]:
        (aw, ah), (bw, bh) = sizes
        raise ValueError(f"a is {aw}x{ah} and b is {bw}x{bh}: only pictures of the same size compare")
    struct = ffi.new("hl_image_difference *")
    struct.struct_size = ffi.sizeof("hl_image_difference")
    call(lib.hl_image_compare, one, other, struct)
    return Difference(struct.rmse, tuple(struct.rmse_channel), tuple(struct.mean_signed), struct.percentile_99_9, struct.maximum,
                      (struct.maximum_x, struct.maximum_y), struct.differing_pixels)
