"""Makes figures: pictures on a page, with scale bars, legends, axes and texts, as PDF, SVG, PNG or TIFF."""
from __future__ import annotations

import os
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from ._library import call, context, encoded, ffi, lib, path_bytes
from ._settings import number, numbers_of
from ._words import choice, suggests
from .colors import linear_color

if TYPE_CHECKING:
    from .image import Image

__all__ = ["Figure", "figure"]

_FORMATS = ("pdf", "svg", "png", "tif")
_AXES = {"arrows": "HL_AXES_ARROWS", "letters": "HL_AXES_LETTERS"}
_PLACED = {"legend": "legend_corner", "scale_bar": "scale_bar_corner", "axes": "arrows_corner"}
_CORNERS = {"upper left": "HL_CORNER_UPPER_LEFT", "upper right": "HL_CORNER_UPPER_RIGHT", "lower left": "HL_CORNER_LOWER_LEFT",
            "lower right": "HL_CORNER_LOWER_RIGHT", "below": "HL_CORNER_BELOW"}
_MILLIMETRES = {"mm": 1.0, "cm": 10.0, "in": 25.4, "pt": 25.4 / 72}


def _millimetres(place: str, length: Any) -> float:
    """A number of millimetres, or a text as "89mm", "3.5in"."""
    if not isinstance(length, str):
        return number(place, length)
    parts = re.fullmatch(r"\s*([0-9.eE+-]+)\s*(mm|cm|in|pt)\s*", length)
    if parts is None:
        raise ValueError(f"{place}: '{length}' is no length: give millimetres, or a text as '89mm', '8.9cm', '3.5in', '252pt'")
    return float(parts[1]) * _MILLIMETRES[parts[2]]


@dataclass
class _Overlay:
    """The overlay that is drawn over one picture. Texts and numbers are given as for `Image.annotate`."""

    scale_bar: bool | str = False
    unit: str | None = None
    depth: float | str | None = None
    legend: bool | str = False
    axes: str | None = None
    marks: bool = False
    texts: Sequence[tuple[str, Sequence[float]]] | Mapping[str, Sequence[float]] = ()
    letter: str | None = None
    places: Mapping[str, str] = field(default_factory=dict)

    def fill(self, overlay: Any, kept: list[Any]) -> None:
        """Write the overlay to an hl_overlay, whose texts `kept` keeps alive."""
        def text(value: str) -> Any:
            kept.append(ffi.new("char[]", str(value).encode("utf-8", "replace")))
            return kept[-1]

        lib.hl_overlay_defaults(ffi.addressof(overlay))
        if self.scale_bar:
            overlay.scale_bar = 1
            bar = "auto" if self.scale_bar is True else str(self.scale_bar)
            parts = re.fullmatch(r"\s*([0-9.eE+-]+)\s*(.*?)\s*", bar)
            if bar != "auto" and parts is None:
                raise ValueError(f"scale_bar: '{bar}' is not True, 'auto' or a length, as '50um'")
            if parts is not None:
                overlay.scale_bar_length = float(parts[1])
                if parts[2]:
                    overlay.scale_bar_unit = text(parts[2])
        if self.unit is not None:
            overlay.world_unit = text(self.unit)
        if self.depth is not None:
            overlay.scale_bar_depth = -1.0 if self.depth == "target" else number("depth", self.depth)
        if self.legend:
            overlay.legend = 1
            if isinstance(self.legend, str) and self.legend != "auto":
                overlay.legend_title = text(self.legend)
        if self.axes is not None:
            overlay.axes = getattr(lib, _AXES[choice("axes", self.axes, list(_AXES))])
        overlay.marks = bool(self.marks)
        if self.letter is not None:
            overlay.letter = text(self.letter)
        for part, corner in self.places.items():
            there = _PLACED[choice("places", part, list(_PLACED))]
            setattr(overlay, there, getattr(lib, _CORNERS[choice(f"places: {part}", corner, list(_CORNERS))]))
        items = list(self.texts.items() if isinstance(self.texts, Mapping) else self.texts)
        notes = ffi.new("hl_annotation[]", max(1, len(items)))
        for note, (words, at) in zip(notes, items):
            note.text = text(words)
            note.in_world = len(at) == 3
            note.at[0:len(at)] = numbers_of("texts", at, 3 if len(at) == 3 else 2)
        kept.append(notes)
        overlay.annotations, overlay.annotation_count = notes, len(items)


@dataclass
class _Panel:
    image: Image
    overlay: _Overlay = field(default_factory=_Overlay)
    place: tuple[float, float, float, float] = (0.0, 0.0, 0.0, 0.0)  # left, top, width, height; millimetres


class Figure:
    """Pictures on a page, with their overlays. `Image.annotate` and `halflight.figure` make figures."""

    def __init__(self, panels: Sequence[_Panel], size: tuple[float, float] | None, dpi: float | None, font_size: float,
                 font: str, background: Any = None) -> None:
        self._panels, self._size, self._dpi = list(panels), size, dpi
        self._font_size, self._font, self._background = font_size, font, background

    def _figure(self, kept: list[Any]) -> Any:
        made = ffi.new("hl_figure *")
        panels = ffi.new("hl_figure_panel[]", max(1, len(self._panels)))
        kept += [made, panels]
        lib.hl_figure_defaults(made)
        for there, panel in zip(panels, self._panels):
            panel.overlay.fill(there.overlay, kept)
            there.image, there.scene = panel.image._plain(), panel.image.scene._handle
            kept.append(there.image)
            there.left, there.top, there.width, there.height = panel.place
        if self._size is None:
            width = 0.0 if self._dpi is None else 25.4 * self._panels[0].image.size[0] / self._dpi
            lib.hl_figure_of_picture(panels[0].image, panels[0].scene, width, made, panels)
        else:
            made.width, made.height = self._size
            made.panels, made.panel_count = panels, len(self._panels)
            if self._dpi is not None:
                made.pixels_per_inch = self._dpi
        if self._background is not None:
            made.background_transparent = isinstance(self._background, str) and self._background == "transparent"
            if not made.background_transparent:
                made.background[0:3] = linear_color("background", self._background)
        kept.append(ffi.new("char[]", self._font.encode()))
        made.font, made.font_points = kept[-1], self._font_size
        if self._size is None:
            call(lib.hl_figure_clear_legend, context, made, panels)
        call(lib.hl_figure_add_strip, context, made)
        return made

    def _options(self, made: Any) -> Any:
        options = ffi.new("hl_image_write_options *")
        lib.hl_image_write_options_defaults(options)
        options.pixels_per_inch = made.pixels_per_inch if self._dpi is not None or self._size is not None else 0
        return options

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write a .pdf or .svg file (pictures as pixels, all else as vectors), or a .png or .tif file, which states
        its size.
        """
        kept: list[Any] = []
        made = self._figure(kept)
        call(lib.hl_figure_write, context, made, path_bytes(path), self._options(made))

    def encode(self, format: str = "png") -> bytes:
        """The bytes of a "pdf", "svg", "png" or "tif" file."""
        kept: list[Any] = []
        made = self._figure(kept)
        return encoded(lib.hl_figure_encode, context, made, choice("format", format, _FORMATS).encode(), self._options(made))

    def _repr_png_(self) -> bytes:
        return self.encode("png")

    def __repr__(self) -> str:
        return f"<halflight.Figure of {len(self._panels)} picture{'' if len(self._panels) == 1 else 's'}>"


def annotate(image: Image, overlay: _Overlay, width: Any, dpi: float | None, font_size: float, font: str) -> Figure:
    """See `Image.annotate`."""
    size = None
    if width is not None:
        wide = _millimetres("width", width)
        size = wide, wide * image.size[1] / image.size[0]
        if dpi is None:
            dpi = image.size[0] / wide * 25.4
    panel = _Panel(image, overlay, (0, 0, *size) if size is not None else (0, 0, 1, 1))
    return Figure([panel], size, None if dpi is None else number("dpi", dpi), number("font_size", font_size), font)


@suggests
def figure(panels: Sequence[Image | Figure], *, columns: int | None = None, width: Any = "183mm", gap: Any = "2mm",
           letters: bool | str = True, dpi: float = 300, font_size: float = 7, font: str = "Sans",
           background: Any = "white") -> Figure:
    """Pictures side by side on a page.

    Parameters
    ----------
    panels : sequence of Image, or of Figure as `Image.annotate` makes them
        Row by row. A row is as high as its highest picture.
    columns : int, optional
        The number of pictures in a row; by default all pictures are in one row.
    width, gap : float or str
        The width of the page, and the gap between pictures: millimetres, or a text such as "89mm", "3.5in".
    letters : bool or str
        Whether panels without a letter of their own get one. A text is the first letter.
    dpi : float
        Pixels an inch of .png and .tif.
    font_size, font : float, str
        The size of letters in points; the name of a family of fonts.
    background : color
        The colour of the page; "transparent" for none.

    Examples
    --------
    >>> import numpy as np, halflight
    >>> ball = halflight.render(np.ones((8, 8, 8), np.uint8), size=(32, 24))
    >>> halflight.figure([ball, ball.annotate(legend="Density")], width="89mm")
    <halflight.Figure of 2 pictures>
    """
    flat = [panel._panels[0] if isinstance(panel, Figure) else _Panel(panel) for panel in panels]
    if not flat:
        raise ValueError("panels: a figure needs at least one picture")
    for panel in panels:
        if isinstance(panel, Figure) and len(panel._panels) != 1:
            raise ValueError("panels: a figure of several pictures is no panel: give its pictures")
    columns = min(len(flat), columns or len(flat))
    wide, space = _millimetres("width", width), _millimetres("gap", gap)
    each = (wide - (columns - 1) * space) / columns
    first = ord((letters if isinstance(letters, str) else "a")[:1] or "a")
    placed, top = [], 0.0
    for start in range(0, len(flat), columns):
        row = flat[start:start + columns]
        highs = [each * shown.image.size[1] / shown.image.size[0] for shown in row]
        for index, (shown, high) in enumerate(zip(row, highs)):
            overlay = shown.overlay
            if letters and overlay.letter is None:
                overlay = _Overlay(**{**vars(overlay), "letter": chr(first + start + index)})
            placed.append(_Panel(shown.image, overlay, (index * (each + space), top, each, high)))
        top += max(highs) + space
    return Figure(placed, (wide, top - space), number("dpi", dpi), number("font_size", font_size), font, background)
