"""Implements `Scene.to_html`, which writes a scene with its data as one page for browsers."""
from __future__ import annotations

import os
import tempfile
from importlib.resources import files
from typing import TYPE_CHECKING

from ._library import call, context, ffi, lib, path_bytes

if TYPE_CHECKING:
    from .scene import Scene

__all__ = ["page_of"]


def _viewer_page() -> str:
    """The path of the viewer's page without a scene, which scripts/web makes."""
    path = os.environ.get("HALFLIGHT_PAGE") or str(files("halflight") / "page" / "halflight.html")
    if not os.path.exists(path):
        raise FileNotFoundError(f"'{path}': the viewer's page is not there: make it with scripts/web, and let HALFLIGHT_PAGE name "
                                "build-web/halflight.html")
    return path


def page_of(scene: Scene, title: str) -> str:
    """HTML."""
    scene._check_arrays()
    viewer = _viewer_page()
    with tempfile.TemporaryDirectory(prefix="halflight-") as folder:
        path = os.path.join(folder, "page.html")
        call(lib.hl_scene_write_page, context, scene._handle, path_bytes(viewer), title.encode(), path_bytes(path))
        with open(path, encoding="utf-8") as file:
            return file.read()
