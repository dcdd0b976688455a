"""The camera."""
from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields
from typing import Any

import numpy as np

from . import _settings
from ._library import lib, warn
from ._words import check_keywords, suggests

__all__ = ["Camera"]


@dataclass(frozen=True, kw_only=True)
class Camera:
    """The place of the eye, and the point at which it looks.

    Parameters
    ----------
    position, target, up : (x, y, z)
        World units: the place of the eye, the point in the middle of the picture, and the direction that is up.
    fovy_deg : float
        The vertical field of view of a perspective camera.
    height : float, optional
        World height of the picture. If it is given, the projection is orthographic, and `fovy_deg` has no effect.

    Examples
    --------
    >>> Camera(position=(0, -300, 0), target=(0, 0, 0)).fovy_deg
    30.0
    """

    position: Sequence[float]
    target: Sequence[float]
    up: Sequence[float] = (0.0, 0.0, 1.0)
    fovy_deg: float = 30.0
    height: float | None = None

    @classmethod
    def from_vtk(cls, camera: Any, aspect: float | None = None) -> Camera:
        """The camera of VTK, PyVista, ParaView's render views or Slicer's.

        Parameters
        ----------
        camera : vtkCamera
            `parallel_projection` gives an orthographic camera, twice as high as its parallel scale.
        aspect : float, optional
            The picture's width divided by its height. A camera with a horizontal view angle needs it.
        """
        words: dict[str, Any] = {"position": tuple(camera.GetPosition()), "target": tuple(camera.GetFocalPoint()),
                                 "up": tuple(camera.GetViewUp())}
        if any(camera.GetWindowCenter()):
            warn("the camera's window centre is left out: Halflight's cameras look at the middle of the picture")
        if camera.GetParallelProjection():
            return cls(**words, height=2 * camera.GetParallelScale())
        angle = camera.GetViewAngle()
        if camera.GetUseHorizontalViewAngle():
            if aspect is None:
                raise TypeError("Camera.from_vtk(): a horizontal view angle needs aspect=width / height")
            angle = math.degrees(2 * math.atan(math.tan(math.radians(angle) / 2) / aspect))
        return cls(**words, fovy_deg=angle)

    @classmethod
    def from_napari(cls, camera: Any, canvas_height: float) -> Camera:
        """The camera of a napari viewer that shows three dimensions; (x, y, z) are napari's last three axes, last first.

        Parameters
        ----------
        camera : napari.components.Camera
            ``viewer.camera``. If its orientation shows x, y and z as a left-handed system, as napari's word "right"
            for axes z, y, x means, napari mirrors the world. No camera of this package does this.
        canvas_height : float
            The height of napari's canvas in pixels. Napari's zoom refers to it.
        """
        center, view, up = (np.array(one, dtype=float)[-3:][::-1]
                            for one in (camera.center, camera.view_direction, camera.up_direction))
        height = float(canvas_height) / camera.zoom
        distance = height if camera.perspective <= 0 else height / (2 * math.tan(math.radians(camera.perspective) / 2))
        words: dict[str, Any] = {"fovy_deg": camera.perspective} if camera.perspective > 0 else {"height": height}
        return cls(position=tuple((center - distance * view).tolist()), target=tuple(center.tolist()),
                   up=tuple(up.tolist()), **words)

    @classmethod
    def from_cpos(cls, cpos: Any, fovy_deg: float = 30.0) -> Camera:
        """The camera of PyVista's ``plotter.camera_position``: position, focal point and up, each (x, y, z).

        Examples
        --------
        >>> Camera.from_cpos([(0, -9, 0), (0, 0, 0), (0, 0, 1)]).target
        (0.0, 0.0, 0.0)
        """
        position, target, up = (tuple(_settings.numbers_of(f"camera: {word}", one))
                                for word, one in zip(("position", "focal point", "up"), cpos, strict=True))
        return cls(position=position, target=target, up=up, fovy_deg=fovy_deg)

    def _fill(self, struct: Any) -> None:
        given = {one.name: getattr(self, one.name) for one in fields(self)}
        given["type"] = "perspective" if self.height is None else "orthographic"
        _settings.fill("Camera: ", struct, lib.HL_SETTINGS_CAMERA, given)


Camera.__init__ = suggests(Camera.__init__)  # type: ignore[method-assign]


_OF_VIEWS = ("view", "up", "azimuth", "elevation", "roll", "zoom", "fovy", "ortho")


def view_options(camera: Mapping[str, Any]) -> dict[str, str]:
    """The options of the program that a mapping of the camera's view stands for."""
    check_keywords("camera", camera, _OF_VIEWS)
    options: dict[str, str] = {}
    for word, value in camera.items():
        if word == "ortho":
            if not isinstance(value, (bool, np.bool_)):
                raise TypeError(f"camera: ortho: {value!r} is not True or False")
            if value:
                options[word] = ""
        elif value is not None:
            plain = isinstance(value, str) or np.ndim(value) == 0
            options[word] = str(value) if plain else ",".join(repr(float(one)) for one in value)
    return options


def camera_from(struct: Any) -> Camera:
    """The camera of a struct."""
    values = _settings.read(struct, lib.HL_SETTINGS_CAMERA, struct.type)
    del values["type"]
    return Camera(**values)
