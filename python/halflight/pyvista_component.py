"""Implements ``plotter.halflight(...)``. PyVista imports this module at the first use (entry point
pyvista.plotter_components).
"""
from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pyvista

from .vtk_scenes import from_pyvista, render_pyvista

if TYPE_CHECKING:
    from .image import Image
    from .scene import Scene


@pyvista.register_plotter_component("halflight")
class Halflight:
    """Pictures of a plotter by Halflight: ``plotter.halflight()`` renders, ``plotter.halflight.scene()`` gives the scene."""

    def __init__(self, plotter: Any) -> None:
        self._plotter = plotter

    def __call__(self, **settings: Any) -> Image:
        """The picture: see `halflight.from_pyvista`, whose keywords these are, and `layers` and `progress`; ``legends=False`` leaves
        scalar bars and text out."""
        return render_pyvista(self._plotter, **settings)

    def scene(self, **settings: Any) -> Scene:
        """The scene: see `halflight.from_pyvista`."""
        return from_pyvista(self._plotter, **settings)
