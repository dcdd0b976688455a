"""Halflight: pictures of volumes in which every voxel can cast a hard or a soft shadow.

>>> import numpy as np, halflight
>>> image = halflight.render(np.ones((16, 16, 16), np.uint8), size=(64, 64))
>>> image.size
(64, 64)

Arrays are [z][y][x] unless ``axes=`` says otherwise. See docs/python.md.
"""
import sys as _sys

if not getattr(_sys, "_is_gil_enabled", lambda: True)():
    raise ImportError("halflight is not made for Python without the global lock: use the ordinary interpreter")

from ._library import lib as _lib, text_of as _text_of
from .amr_files import open_amr
from .camera import Camera
from .colors import colormaps, srgb
from .differences import Difference, diff
from .errors import HalflightWarning, InputError, UnsupportedError
from .figure import Figure, figure
from .image import Image
from .lights import Directional, Disk, EmissionImage, Light, Point, Polygon, Rect, Spot, Texture
from .memory import limit_memory
from .mesh import Mesh
from .particles import Particles
from .program import animate, view
from .render import Renderer, reference, render
from .scene import Scene
from .snapshots import Snapshot, open_snapshot
from .transfer import TransferFunction, presets
from .volume import Info, Volume, info
from .vtk_scenes import from_pyvista, from_vtk
from .widget import show

__version__ = _text_of(_lib.hl_version())

__all__ = [
    "Camera", "Difference", "Directional", "Disk", "EmissionImage", "Figure", "HalflightWarning", "Image", "Info", "InputError", "Light", "Mesh",
    "Particles", "Point", "Polygon", "Rect", "Renderer", "Scene", "Snapshot", "Spot", "Texture", "TransferFunction", "UnsupportedError", "Volume",
    "animate", "colormaps", "diff", "figure", "from_pyvista", "from_vtk", "info", "limit_memory", "open_amr", "open_snapshot", "presets", "reference", "render", "show", "srgb", "view",
]
