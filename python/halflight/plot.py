"""Implements `Image.plot`, which shows a picture in axes of matplotlib."""
from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from ._library import ffi, lib
from .colors import srgb, to_srgb

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from .image import Image

_LONGEST = 0.25  # the scale bar's greatest length, as a fraction of the picture's width


def world_height(image: Image) -> float:
    """The world height of the picture at the camera's target."""
    camera = image.scene.camera
    if camera.height is not None:
        return camera.height
    return 2 * math.dist(camera.position, camera.target) * math.tan(math.radians(camera.fovy_deg) / 2)


def ink_over(image: Image, axis: Any) -> str:
    """Black or white, whichever is seen better on the ground of the picture: as in figures, the limit is the middle of
    sRGB's scale.
    """
    from matplotlib.colors import to_rgba

    description = lib.hl_scene_describe(image.scene._handle)
    ground = np.array(list(description.background))
    if description.background_transparent:
        paper: Any = to_rgba(axis.figure.get_facecolor())
        red, green, blue, alpha = paper
        ground = alpha * np.array(srgb(red, green, blue)) + (1 - alpha)
    return "white" if float(ground @ (0.2126, 0.7152, 0.0722)) < 0.214 else "black"


def round_length(longest: float) -> float:
    """The greatest of 1, 2 and 5 times a power of ten that is not longer."""
    power = 10.0 ** math.floor(math.log10(longest))
    return next(factor * power for factor in (5, 2, 1) if factor * power <= longest)


def plot(image: Image, ax: Axes | None, colorbar: bool, scale_bar: bool, unit: str) -> Axes:
    """See `Image.plot`."""
    from matplotlib import pyplot
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import ListedColormap, LogNorm, Normalize

    axis: Any = pyplot.subplots()[1] if ax is None else ax
    axis.imshow(image.to_srgb8())
    axis.set_axis_off()
    width, height = image.size
    if scale_bar:
        pixel = world_height(image) / height
        length = round_length(_LONGEST * width * pixel)
        x, y = 0.05 * width, 0.95 * height
        ink = ink_over(image, axis)
        axis.plot([x, x + length / pixel], [y, y], color=ink, linewidth=3, solid_capstyle="butt")
        axis.annotate(f"{length:g} {unit}".strip(), (x + length / pixel / 2, y), xytext=(0, 4),
                      textcoords="offset points", color=ink, ha="center", va="bottom")
    if colorbar:
        points = image.scene.volumes[0].look["transfer_function"].color
        low, high = points[0, 0], points[-1, 0]
        if low < high:
            function = lib.hl_scene_describe(image.scene._handle).volumes[0].transfer_function
            log = lib.hl_transfer_function_scale(ffi.addressof(function)) == lib.HL_RANGE_LOG
            values = (np.geomspace if log else np.linspace)(low, high, 256)
            shown = to_srgb(np.stack([np.interp(values, points[:, 0], points[:, c]) for c in (1, 2, 3)], 1))
            norm: Any = LogNorm if log else Normalize
            bar = ScalarMappable(norm(low, high), ListedColormap(shown.tolist()))
            axis.figure.colorbar(bar, ax=axis)
    return axis
