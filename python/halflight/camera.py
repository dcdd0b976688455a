"""The camera."""
from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields
from typing import Any

from . import _settings
from ._library import lib
from ._words import suggests

__all__ = ["Camera"]


@dataclass(frozen=True, kw_only=True)
class Camera:
    """Where the eye is, and what it looks at.

    Parameters
    ----------
    position, target, up : (x, y, z)
        World units: the eye, the point in the middle of the picture, and which way is up.
    fovy_deg : float
        Perspective: the vertical field of view.
    height : float, optional
        World height of the picture. Given, the projection is orthographic, and `fovy_deg` says nothing.

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

    def _fill(self, struct: Any) -> None:
        given = {one.name: getattr(self, one.name) for one in fields(self)}
        given["type"] = "perspective" if self.height is None else "orthographic"
        _settings.fill("Camera: ", struct, lib.HL_SETTINGS_CAMERA, given)


Camera.__init__ = suggests(Camera.__init__)  # type: ignore[method-assign]


def camera_from(struct: Any) -> Camera:
    """The camera of a struct."""
    values = _settings.read(struct, lib.HL_SETTINGS_CAMERA, struct.type)
    del values["type"]
    return Camera(**values)
