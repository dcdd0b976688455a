"""Defines transfer functions, which give opacities and colours to values."""
from __future__ import annotations

import os
from collections.abc import Sequence
from typing import Any

import numpy as np

from . import colors
from ._library import call, context, ffi, lib, names, path_bytes
from ._settings import number, numbers_of
from ._words import nearest, suggests
from .plane import Plane, plane_from

__all__ = ["TransferFunction", "presets"]


def presets() -> list[str]:
    """The names for ``tf=``: transfer functions that adapt to the volume.

    Examples
    --------
    >>> "ct-bone" in presets()
    True
    """
    return names(lib.hl_preset_name)


class TransferFunction:
    """Opacity and colour by data value, piecewise linear, constant beyond the end points.

    Parameters
    ----------
    opacity : sequence of (value, opacity), optional
        Not with `second`. Sorted by value; opacity 0 to 1 per `unit_distance`: a homogeneous medium of opacity ``o`` lets
        ``(1 - o) ** (d / unit_distance)`` of the light through a length ``d``.
    color : sequence of (value, r, g, b), or (r, g, b)
        Sorted by value; linear RGB.
    unit_distance : float
        World units.
    gradient_opacity : sequence of (gradient, factor)
        What extinction is multiplied by where the data's gradient has this length, in data units per world unit;
        sorted. Empty: 1 everywhere.
    second : "gradient" or {"volume": name}, optional
        The second number that `boxes`, `polygons`, `image` and `curves` take beside the value: the length of the data's
        gradient, in data units per world unit, or the value of another volume of the scene. They then say all that is
        seen; colours are linear RGB or a name, opacities per `unit_distance`.
    boxes : sequence of dict
        ``value`` and ``second``, each (from, to); ``color`` (white), ``opacity`` (0.5), ``edge`` (0, 0): how far within
        the border extinction rises from 0, and ``sigma`` (0): above 0 a Gaussian of this deviation, of the box's sides.
    polygons : sequence of dict
        ``vertices``, a sequence of (value, second), ``color``, ``opacity``, ``apex`` (the vertices' mean), from which
        extinction falls to the border, and ``falloff`` (1), the fraction of the way over which it does.
    image : dict
        ``pixels``, (height, width, 4): linear RGB times opacity, and opacity, the greatest second number in the first
        row; ``value`` and ``second``, the ranges that it covers.
    curves : dict
        ``opacity``, a sequence of (value, opacity), and ``color``, a sequence of (second number, r, g, b): one volume in
        the colours of another. Where the second number lies between the two numbers of ``own_between``, the colour is
        ``own_color``, a sequence of (value, r, g, b).

    Examples
    --------
    >>> TransferFunction([(0, 0), (100, 0.5)], color=(1, 0.5, 0.2)).color.shape
    (1, 4)
    >>> skin = {"value": (40, 255), "second": (20, 80), "color": "gold", "opacity": 0.8}
    >>> TransferFunction(second="gradient", boxes=[skin]).plane.boxes[0]["edge"]
    (0.0, 0.0)
    """

    __slots__ = ("color", "gradient_opacity", "opacity", "plane", "unit_distance")

    @suggests
    def __init__(self, opacity: Any = (), color: Any = (1.0, 1.0, 1.0), unit_distance: float = 1.0,
                 gradient_opacity: Any = (), *, second: Any = None, boxes: Any = (), polygons: Any = (),
                 image: Any = None, curves: Any = None) -> None:
        place = "TransferFunction: "
        self.plane = Plane(place, second, boxes, polygons, image, curves)
        if second is not None and len(opacity) > 0:
            raise TypeError(f"{place}opacity and second exclude each other: boxes, polygons, images and curves have their own")
        self.unit_distance = number(f"{place}unit_distance", unit_distance)
        points = [numbers_of(f"{place}opacity[{n}]", point, 2) for n, point in enumerate(opacity)]
        self.opacity = np.array(points, dtype=np.float64).reshape(-1, 2)
        if isinstance(color, str) or np.ndim(color) <= 1:
            rows = [[0.0, *colors.linear_color(f"{place}color", color)]]
        else:
            rows = [numbers_of(f"{place}color[{n}]", row, 4) for n, row in enumerate(color)]
        self.color = np.array(rows, dtype=np.float64)
        factors = [numbers_of(f"{place}gradient_opacity[{n}]", point, 2) for n, point in enumerate(gradient_opacity)]
        self.gradient_opacity = np.array(factors, dtype=np.float64).reshape(-1, 2)

    @classmethod
    def from_vtk(cls, property: Any, colors: Any = None, *, unit_distance: float | None = None) -> TransferFunction:
        """The transfer function of the first component of a vtkVolumeProperty of VTK, PyVista, ParaView or Slicer.

        Parameters
        ----------
        property : vtkVolumeProperty or vtkPiecewiseFunction
            Further points between the nodes keep the effect of midpoints, sharpness and colour spaces.
        colors : vtkColorTransferFunction, optional
            The colours, if `property` is a vtkPiecewiseFunction.
        unit_distance : float, optional
            World units; by default the property's, or 1.
        """
        from .vtk_functions import function_from_vtk

        return function_from_vtk(property, colors, unit_distance)

    @classmethod
    def from_napari(cls, layer: Any, *, unit_distance: float = 1.0) -> TransferFunction:
        """The colours of a napari image layer over its contrast limits; opacity rises over these limits up to the
        layer's.

        Parameters
        ----------
        layer : napari.layers.Image
            The layer, whose colormap, contrast limits, gamma and opacity are used.
        unit_distance : float
            The length, in world units, over which the brightest value has the layer's opacity.
        """
        low, high = map(float, layer.contrast_limits)
        steps = np.linspace(0, 1, 256)
        shown = np.asarray(layer.colormap.map(steps ** float(layer.gamma)), dtype=np.float64)
        values = np.linspace(low, high, 256)
        opacity = steps ** float(layer.gamma) * shown[:, 3] * float(layer.opacity)
        return cls(np.column_stack([values, opacity]), np.column_stack([values, colors.to_linear(shown[:, :3])]),
                   unit_distance)

    @classmethod
    def from_matplotlib(cls, cmap: Any, clim: tuple[float, float] = (0.0, 1.0), opacity: Any = None, *,
                        unit_distance: float = 1.0) -> TransferFunction:
        """A matplotlib colormap over a range of values.

        Parameters
        ----------
        cmap : matplotlib colormap, ScalarMappable, str, colour or colours
            A ScalarMappable, such as the result of ``imshow``, has a range of its own.
        clim : (low, high)
            The values that the colours spread over.
        opacity : optional
            As for `render`. The default is the colormap's alpha if it is below 1 anywhere, else "linear".
        unit_distance : float
            World units.

        Examples
        --------
        >>> TransferFunction.from_matplotlib("viridis", (0, 100)).opacity[-1].tolist()
        [100.0, 1.0]
        """
        if hasattr(cmap, "get_cmap") and hasattr(cmap, "get_clim"):
            clim, cmap = cmap.get_clim(), cmap.get_cmap()
        low, high = numbers_of("clim", clim, 2)
        points = colors.sampled("cmap", cmap, low, high)
        if points is None:
            points = function_from(_made(lib.hl_transfer_function_colormap, colors.own_name(cmap), low, high)).color.tolist()
        if opacity is None and callable(cmap):
            alpha = np.asarray(cmap(np.linspace(0, 1, 256)), dtype=np.float64)[:, 3]
            opacity = alpha.tolist() if alpha.min() < 1 else None
        return cls(opacity_points("linear" if opacity is None else opacity, [low, high]), points, unit_distance)

    def __repr__(self) -> str:
        return (f"TransferFunction({self.opacity.tolist()}, color={self.color.tolist()}, "
                f"unit_distance={self.unit_distance}"
                + (f", gradient_opacity={self.gradient_opacity.tolist()}" if len(self.gradient_opacity) else "")
                + "".join(f", {word}={value!r}" for word, value in self.plane.arguments().items()) + ")")

    def __eq__(self, other: object) -> bool:
        return (isinstance(other, TransferFunction) and self.unit_distance == other.unit_distance
                and np.array_equal(self.opacity, other.opacity) and np.array_equal(self.color, other.color)
                and np.array_equal(self.gradient_opacity, other.gradient_opacity) and self.plane.equals(other.plane))

    __hash__ = None  # type: ignore[assignment]

    def _fill(self, struct: Any, keep: list[Any]) -> None:
        opacity = ffi.new("hl_opacity_point[]", [tuple(point) for point in self.opacity.tolist()])
        color = ffi.new("hl_color_point[]", [(row[0], row[1:]) for row in self.color.tolist()])
        gradient = ffi.new("hl_opacity_point[]", [tuple(point) for point in self.gradient_opacity.tolist()])
        keep += [opacity, color, gradient]
        struct.unit_distance = self.unit_distance
        struct.opacity, struct.opacity_count = opacity, len(self.opacity)
        struct.color, struct.color_count = color, len(self.color)
        struct.gradient_opacity, struct.gradient_opacity_count = gradient, len(self.gradient_opacity)
        self.plane.fill(struct.plane, keep)


def function_from(struct: Any) -> TransferFunction:
    """The transfer function of a struct."""
    opacity = [(struct.opacity[n].value, struct.opacity[n].opacity) for n in range(struct.opacity_count)]
    color = [(struct.color[n].value, *struct.color[n].color) for n in range(struct.color_count)]
    gradient = [(struct.gradient_opacity[n].value, struct.gradient_opacity[n].opacity)
                for n in range(struct.gradient_opacity_count)]
    plane = plane_from(struct.plane)
    if plane.second is not None:  # opacity and colour are made of the plane
        return TransferFunction((), unit_distance=struct.unit_distance, gradient_opacity=gradient, **plane.arguments())
    return TransferFunction(opacity, color or (1.0, 1.0, 1.0), struct.unit_distance, gradient)


def _made(function: Any, *arguments: Any, path: str | None = None) -> Any:
    struct = ffi.gc(ffi.new("hl_transfer_function *"), lambda one: lib.hl_transfer_function_release(context, one))
    call(function, context, *arguments, struct, path=path)
    return struct


def named_function(tf: Any, volume: Any, old: TransferFunction) -> TransferFunction:
    """The transfer function that ``tf=`` names: a preset, a file or a TransferFunction. If a file has only colours,
    the opacity of `old` is kept.
    """
    if isinstance(tf, TransferFunction):
        return tf
    if not isinstance(tf, (str, os.PathLike)):
        raise TypeError(f"tf: {tf!r} is no preset, path or TransferFunction")
    path = os.fspath(tf)
    if path in presets():
        return function_from(_made(lib.hl_transfer_function_preset, path.encode(), volume))
    if "." not in path and "/" not in path and not os.path.exists(path):
        raise ValueError(f"tf: there is no preset or file '{path}'{nearest(path, presets())}")
    loaded = _made(lib.hl_transfer_function_load_for, path_bytes(path), volume, path=path)
    function = function_from(loaded)
    if loaded.opacity == ffi.NULL and function.plane.second is None:
        function.opacity, function.unit_distance = old.opacity, old.unit_distance
        function.gradient_opacity = old.gradient_opacity
    return function


def _moved(function: TransferFunction, old: Sequence[float], clim: Sequence[float], log: bool) -> TransferFunction:
    """The function with its points moved from the values `old` to those of `clim`."""
    struct, keep = ffi.new("hl_transfer_function *"), list[Any]()
    function._fill(struct, keep)
    return function_from(_made(lib.hl_transfer_function_spread, struct, list(old), list(clim),
                               lib.HL_RANGE_LOG if log else lib.HL_RANGE_LINEAR))


def seen_range(function: TransferFunction, volume: Any) -> tuple[float, float]:
    """The values that are seen of a volume with this function."""
    seen, struct, keep = ffi.new("double[2]"), ffi.new("hl_transfer_function *"), list[Any]()
    function._fill(struct, keep)
    call(lib.hl_transfer_function_seen_range, volume, struct, seen)
    return float(seen[0]), float(seen[1])


class MappedProjection(TransferFunction):
    """The function of a maximum projection in the colours of a colormap. The picture fits them to its background."""

    __slots__ = ()


def faded(volume: Any, background: list[float], function: Any) -> Any:
    """The hl_transfer_function whose colours fade into the background of a maximum projection."""
    return _made(lib.hl_transfer_function_fade, volume, background, ffi.new("hl_transfer_function *", function))


def recolored(function: TransferFunction, cmap: Any, clim: list[float] | None, log: bool, volume: Any, projected: bool) -> TransferFunction:
    """The function with the colours of `cmap` over `clim`, by default over the values that are seen. projected:
    whether the function is for a maximum projection, in which a single colour becomes a ramp that begins at black.
    """
    if clim is None:
        clim = list(seen_range(function, volume))
    points = colors.sampled("cmap", cmap, *clim)
    if points is None:
        points = function_from(_made(lib.hl_transfer_function_colormap, colors.own_name(cmap), *clim)).color.tolist()
    elif projected and len(points) == 1:
        points = [[clim[0], 0.0, 0.0, 0.0], [clim[1], *points[0][1:]]]
    if log:
        points = _moved(TransferFunction([], points), clim, clim, True).color.tolist()
    return TransferFunction(function.opacity, points, function.unit_distance, function.gradient_opacity)


def colormap_points(name: str) -> list[list[float]]:
    """Rows [value, r, g, b] of one of the library's colormaps, over values from 0 to 1."""
    points: list[list[float]] = function_from(_made(lib.hl_transfer_function_colormap, name.encode(), 0.0, 1.0)).color.tolist()
    return points


def spread(function: TransferFunction, cmap: Any, clim: list[float], log: bool, volume: Any, projected: bool) -> TransferFunction:
    """Opacity and colours, moved so that the visible values lie between the values of `clim`. In a maximum projection,
    the range of the colours lies between them instead. cmap: the colours that will replace the function's own.
    """
    points = None if cmap is None else colors.sampled("cmap", cmap, *clim)
    mapped = cmap is not None and (points is None or len(points) > 1)
    use = lib.HL_SPREAD_PROJECTION if projected else lib.HL_SPREAD_COLORMAP if mapped else lib.HL_SPREAD_ALONE
    struct, keep = ffi.new("hl_transfer_function *"), list[Any]()
    function._fill(struct, keep)
    return function_from(_made(lib.hl_transfer_function_spread_over, volume, struct, clim,
                               lib.HL_RANGE_LOG if log else lib.HL_RANGE_LINEAR, use))


_SHAPES = ("linear", "sigmoid", "geom")


def opacity_points(opacity: Any, clim: list[float], log: bool = False) -> Any:
    """The value of ``opacity=`` as points (value, opacity).

    A number holds for all values within `clim`; a name or a list of numbers is spread evenly over `clim`, or over
    the logarithms of its values; pairs are data values and opacities.
    """
    points = _even_points(opacity, clim)
    if log and (isinstance(opacity, str) or not hasattr(opacity[0] if hasattr(opacity, "__len__") else 0, "__len__")):
        return _moved(TransferFunction(points), clim, clim, True).opacity
    return points


def _even_points(opacity: Any, clim: list[float]) -> list[tuple[float, float]]:
    if isinstance(opacity, str):
        if opacity not in _SHAPES:
            raise ValueError(f"opacity: there is no '{opacity}'{nearest(opacity, _SHAPES)}")
        x = np.linspace(0, 1, 33)
        shape = {"linear": x, "geom": (256.0 ** x - 1) / 255, "sigmoid": 1 / (1 + np.exp(-10 * (x - 0.5)))}[opacity]
        if opacity == "sigmoid":
            shape = (shape - shape[0]) / (shape[-1] - shape[0])
        return list(zip(np.linspace(clim[0], clim[1], 33).tolist(), shape.tolist(), strict=True))
    if not hasattr(opacity, "__len__"):
        return [(clim[0], number("opacity", opacity)), (clim[1], number("opacity", opacity))]
    if len(opacity) == 0:
        raise ValueError("opacity: there is no point in it")
    if all(hasattr(point, "__len__") for point in opacity):
        return [tuple(numbers_of(f"opacity[{n}]", point, 2)) for n, point in enumerate(opacity)]  # type: ignore[misc]
    flat = numbers_of("opacity", opacity, len(opacity))
    return list(zip(np.linspace(clim[0], clim[1], len(flat)).tolist(), flat, strict=True))
