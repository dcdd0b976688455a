"""Converts VTK's volume properties to transfer functions. The objects of VTK are asked for their values. VTK itself is
never imported.
"""
from __future__ import annotations

from typing import Any

import numpy as np

from . import colors
from .transfer import TransferFunction

__all__ = ["function_from_vtk"]

_BETWEEN = 16  # number of points between two of VTK's nodes if the curve between them is no straight line


def _nodes(function: Any, width: int) -> np.ndarray[Any, Any]:
    """The nodes of a vtkPiecewiseFunction (x, y, midpoint, sharpness) or vtkColorTransferFunction (x, r, g, b, ...)."""
    rows = np.zeros((function.GetSize(), width))
    place = [0.0] * width
    for n in range(len(rows)):
        function.GetNodeValue(n, place)
        rows[n] = place
    return rows[np.argsort(rows[:, 0], kind="stable")]


def _values(nodes: np.ndarray[Any, Any], straight: bool) -> np.ndarray[Any, Any]:
    """The values at which a curve is read: the values of the nodes, and further values between them if the curve is no
    straight line.
    """
    x: np.ndarray[Any, Any] = nodes[:, 0]
    if straight or len(x) < 2:
        return x
    parts = [np.linspace(a, b, _BETWEEN, endpoint=False) for a, b in zip(x[:-1], x[1:], strict=True)]
    return np.concatenate([*parts, x[-1:]])


def _piecewise(function: Any) -> np.ndarray[Any, Any]:
    """Rows (value, y) of a curve. If the nodes have a step at a value, the value occurs twice."""
    nodes = _nodes(function, 4)
    straight = bool(np.all(nodes[:, 2] == 0.5) and np.all(nodes[:, 3] == 0))
    if straight:
        return nodes[:, :2]
    return np.array([(x, function.GetValue(x)) for x in _values(nodes, False)])


def _colored(function: Any) -> np.ndarray[Any, Any]:
    """Rows (value, r, g, b), linear. VTK mixes colours as they are shown, so points between the nodes are needed."""
    nodes = _nodes(function, 6)
    values = _values(nodes, len(np.unique(nodes[:, 1:4], axis=0)) < 2)
    place, rows = [0.0] * 3, []
    for x in values:
        function.GetColor(x, place)
        rows.append((x, *place))
    shown = np.array(rows).reshape(-1, 4)
    return np.column_stack([shown[:, 0], colors.to_linear(np.clip(shown[:, 1:], 0, 1))])


def function_from_vtk(source: Any, given: Any, unit_distance: float | None) -> TransferFunction:
    """See `TransferFunction.from_vtk`."""
    if hasattr(source, "GetScalarOpacity"):
        opacity, distance = source.GetScalarOpacity(0), source.GetScalarOpacityUnitDistance(0)
        grey = source.GetColorChannels(0) == 1
        color = source.GetGrayTransferFunction(0) if grey else source.GetRGBTransferFunction(0)
        steep = None if source.GetDisableGradientOpacity(0) else source.GetGradientOpacity(0)
    elif hasattr(source, "GetNodeValue"):
        opacity, distance, color, steep = source, 1.0, given, None
    else:
        raise TypeError(f"TransferFunction.from_vtk(): {type(source).__name__} is no vtkVolumeProperty and no vtkPiecewiseFunction")
    if color is None:
        rows: Any = (1.0, 1.0, 1.0)
    else:
        rows = _colored(color) if hasattr(color, "GetColorSpace") else _grey(color)
    gradient: Any = ()
    if steep is not None and steep.GetSize() > 0:
        factors = _piecewise(steep)
        gradient = factors if factors[:, 1].min() < 1 else ()
    points = _piecewise(opacity)
    points[:, 1] = points[:, 1].clip(0, 1)
    return TransferFunction(points, rows, distance if unit_distance is None else unit_distance, gradient)


def _grey(function: Any) -> np.ndarray[Any, Any]:
    rows = _piecewise(function)
    linear = colors.to_linear(rows[:, 1].clip(0, 1))
    return np.column_stack([rows[:, 0], linear, linear, linear])
