"""Makes one page without any other file from a picture, or from the pictures of a turn. The viewer in notebooks uses
it in `to_html`.
"""
from __future__ import annotations

import base64
import html
import math
from dataclasses import replace
from typing import TYPE_CHECKING

from ._settings import number
from .render import Renderer

if TYPE_CHECKING:
    from .image import Image

__all__ = ["page_of"]

_MOST_FRAMES = 720

_PAGE = """<!doctype html>
<meta charset="utf-8"><meta name="viewport" content="width=device-width"><title>{title}</title>
<style>body {{ margin: 0; background: {background} }} img {{ display: block; margin: auto; max-width: 100%; cursor: {cursor}; touch-action: pan-y }}
input {{ display: block; margin: .5em auto; width: min({width}px, 90%) }}</style>
<img alt="{title}" width="{width}" height="{height}" draggable="false" src="data:image/png;base64,{first}">
{turn}
"""

_TURN = """<input type="range" min="0" max="{last}" value="0" aria-label="turn">
<script>
const frames = {frames}, image = document.querySelector("img"), slider = document.querySelector("input");
let from = null;
const show = (frame) => {{
  slider.value = (frame % frames.length + frames.length) % frames.length;
  image.src = "data:image/png;base64," + frames[slider.value];
}};
slider.addEventListener("input", () => show(Number(slider.value)));
image.addEventListener("pointerdown", (event) => {{
  from = {{ x: event.clientX, frame: Number(slider.value) }};
  image.setPointerCapture(event.pointerId);
}});
image.addEventListener("pointermove", (event) => {{
  if (from) show(from.frame - Math.round((event.clientX - from.x) / image.clientWidth * frames.length));
}});
image.addEventListener("pointerup", () => {{ from = null; }});
</script>"""


def _turned(image: Image, count: int) -> list[bytes]:
    """The frames of one turn to the right about the camera's up, the picture's own first."""
    import numpy as np

    camera = image.scene.camera
    target, up = np.asarray(camera.target, dtype=float), np.asarray(camera.up, dtype=float)
    up /= np.linalg.norm(up)
    away, frames = np.asarray(camera.position, dtype=float) - target, [image.encode("png")]
    with Renderer() as renderer:
        for frame in range(1, count):
            angle = 2 * math.pi * frame / count  # Rodrigues' formula
            moved = away * math.cos(angle) + np.cross(up, away) * math.sin(angle) + up * (up @ away) * (1 - math.cos(angle))
            turned = replace(camera, position=tuple((target + moved).tolist()), up=tuple(up.tolist()))
            frames.append(renderer.render(image.scene.replace(camera=turned)).encode("png", metadata=False))
    return frames


def page_of(image: Image, turntable: int = 0) -> str:
    """HTML with the picture, and with `turntable` frames of a turn if `turntable` is above 1."""
    count = number("turntable", turntable)
    if count != int(count) or not 0 <= count <= _MOST_FRAMES:
        raise ValueError(f"turntable: {turntable!r} is no whole number from 0 to {_MOST_FRAMES}")
    frames = [base64.b64encode(one).decode() for one in (_turned(image, int(count)) if count > 1 else [image.encode("png")])]
    width, height = image.size
    turn = _TURN.format(last=len(frames) - 1, frames="[" + ",".join(f'"{one}"' for one in frames) + "]") if len(frames) > 1 else ""
    shown = "#%02x%02x%02x" % tuple(int(one) for one in image.to_srgb8()[0, 0, :3])
    return _PAGE.format(title=html.escape(image.scene.description or "Halflight"), background=shown, cursor="grab" if turn else "auto",
                        width=width, height=height, first=frames[0], turn=turn)
