"""Halflight for napari: `scene_of` and `render` take a viewer, the dock does it by a button."""
from ._layers import render, render_animation, scene_of

__all__ = ["render", "render_animation", "scene_of"]
