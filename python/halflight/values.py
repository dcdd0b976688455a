"""Makes the transfer functions that the keywords of a volume's values ask for: `cmap`, `clim`, `opacity` and others."""
from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, TypedDict

from . import _settings, transfer

if TYPE_CHECKING:
    from .volume import Volume

__all__ = ["VALUES", "Values", "function_for", "range_for", "range_of_slice"]


class Values(TypedDict, total=False):
    """Keywords of `Volume` and `halflight.render` that change the volume's transfer function: see `halflight.render`."""

    cmap: Any
    clim: Sequence[float | str]
    log_scale: bool
    opacity: Any
    opacity_unit_distance: float
    tf: Any


VALUES = tuple(Values.__annotations__)


def range_for(clim: Any, volume: Volume) -> list[float] | None:
    """The two values that `clim` stands for; None if it is None."""
    if clim is None:
        return None
    ends = clim if isinstance(clim, str) or not hasattr(clim, "__len__") else \
        [_percentile(end, volume) if isinstance(end, str) else end for end in clim]
    low, high = _settings.numbers_of("clim", ends, 2)
    if not low < high:
        raise ValueError(f"clim: {low:g} is not below {high:g}")
    return [low, high]


def _percentile(text: str, volume: Volume) -> float:
    """The data value that a text such as "99.5%" stands for."""
    try:
        percent = float(text.removesuffix("%")) if text.endswith("%") else -1.0
    except ValueError:
        percent = -1.0
    if not 0 <= percent <= 100:
        raise ValueError(f"clim: '{text}' is no number and no percentile from '0%' to '100%'")
    return volume.percentile(percent)


def range_of_slice(volume: Volume) -> tuple[float, float]:
    """The values over which a colormap spreads in a slice: the window that the volume in the slice has, or else the values that
    a maximum projection shows.
    """
    for channel in volume.info().channel_list:
        if channel.chosen and channel.window is not None:
            return channel.window
    shown, greys = volume.look["transfer_function"], transfer.named_function("mip", volume._handle, transfer.TransferFunction([(0, 0)]))
    ends, of_greys = ((float(one.color[0][0]), float(one.color[-1][0])) for one in (shown, greys))
    return ends if ends != of_greys else transfer.seen_range(greys, volume._handle)


def function_for(volume: Volume, projected: bool, *, cmap: Any = None, clim: Any = None, log_scale: Any = None, opacity: Any = None,
                 opacity_unit_distance: float | None = None, tf: Any = None) -> transfer.TransferFunction | None:
    """The volume's transfer function with the changes that the keywords ask for; None if they ask for none. projected:
    whether the picture is a maximum projection.
    """
    range_wanted, log = range_for(clim, volume), bool(log_scale)
    if log and range_wanted is None:
        raise ValueError("log_scale: it spreads over clim: give clim=(low, high), too")
    if all(one is None for one in (cmap, clim, opacity, opacity_unit_distance, tf)):
        return None
    by_values = volume if "labels" in volume._changes else volume.replace(labels=False)
    function: transfer.TransferFunction = by_values.look["transfer_function"]
    info = volume.info()
    if tf is not None:
        function = transfer.named_function(tf, volume._handle, function)
    if opacity is not None:
        values = range_wanted or list(info.range)
        distance = float(info.spacing.min()) if opacity_unit_distance is None else opacity_unit_distance
        color = function.color
        if range_wanted is not None and cmap is None:
            color = transfer.spread(function, cmap, range_wanted, log, volume._handle, projected).color
        function = transfer.TransferFunction(transfer.opacity_points(opacity, values, log), color, distance)
    elif range_wanted is not None:
        function = transfer.spread(function, cmap, range_wanted, log, volume._handle, projected)
    if opacity_unit_distance is not None:
        function = transfer.TransferFunction(function.opacity, function.color,
                                             _settings.number("opacity_unit_distance", opacity_unit_distance),
                                             function.gradient_opacity)
    if cmap is not None:
        function = transfer.recolored(function, cmap, range_wanted, log, volume._handle, projected)
        if projected and tf is None:
            function = transfer.MappedProjection(function.opacity, function.color, function.unit_distance, function.gradient_opacity)
    return function
