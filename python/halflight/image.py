"""Defines pictures: linear premultiplied RGBA in float32, top row first."""
from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from types import MappingProxyType
from typing import IO, TYPE_CHECKING, Any

import numpy as np
from numpy.lib.mixins import NDArrayOperatorsMixin

from . import colors, picture_files
from ._library import call, context, encoded, ffi, lib, made, path_bytes
from ._settings import number, table, to_field
from ._words import choice, suggests
from .errors import UnsupportedError
from .scene import Scene

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from .figure import Figure

__all__ = ["Image"]

Pixels = np.ndarray[Any, np.dtype[np.float32]]
_FORMATS = ("png", "exr", "npy")


def _view(pointer: Any, owner: Any, shape: tuple[int, ...]) -> Pixels:
    """The library's floats as an array, which keeps `owner` alive."""
    kept = ffi.gc(pointer, lambda _: owner and None)
    count = int(np.prod(shape))
    return np.frombuffer(ffi.buffer(kept, 4 * count), np.float32, count).reshape(shape)


class Image(NDArrayOperatorsMixin):
    """A picture: ``numpy.asarray(image)`` is float32, [height][width][4], without a copy.

    Values are linear premultiplied RGBA of the volumes alone; the background is added where a picture is shown:
    in `to_srgb8`, PNG files, notebooks and `plot`. Sums, differences and NumPy's functions give arrays; ``==``
    tells whether two pictures have the same pixels and layers.

    Attributes
    ----------
    layers : mapping of str to ndarray of float32
        The layers of which the picture is made, if it was rendered with ``layers=True``: "light0", "light0_shadow",
        "ambient", "normal" [height][width][3], "depth_first", "depth_mean", "object" [height][width]; see
        docs/layers.md.
    statistics : mapping
        Seconds, sheets, voxels, threads and the instruction set, named as in `hl_render_statistics`.
    scene : Scene
        The scene that was rendered.

    Examples
    --------
    >>> import numpy as np, halflight
    >>> image = halflight.render(np.ones((8, 8, 8), np.uint8), size=(32, 24))
    >>> np.asarray(image).shape, image.to_srgb8().dtype
    ((24, 32, 4), dtype('uint8'))
    """

    def __init__(self, scene: Scene) -> None:
        width, height = scene.size
        self._handle = made(lib.hl_image_create, "hl_image", lib.hl_image_destroy, context, width, height)
        self._pixels = _view(lib.hl_image_pixels(self._handle), self._handle, (height, width, 4))
        self.scene = scene
        self.layers: Mapping[str, Pixels] = {}
        self.statistics: Mapping[str, Any] = {}

    def _finish(self, layers: Mapping[str, Pixels], statistics: Mapping[str, Any]) -> None:
        self.layers, self.statistics = MappingProxyType(layers), MappingProxyType(statistics)

    def _add_layer(self, name: str, channels: str) -> tuple[Any, Pixels]:
        place = ffi.new("float **")
        call(lib.hl_image_add_layer, self._handle, name.encode(), channels.encode(), place)
        shape = self._pixels.shape[:2] + ((len(channels),) if len(channels) > 1 else ())
        return place[0], _view(place[0], self._handle, shape)

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> np.ndarray[Any, Any]:
        if dtype is not None and np.dtype(dtype) != np.float32:
            if copy is False:
                raise ValueError("the picture is float32: another type needs a copy")
            return self._pixels.astype(dtype)
        return self._pixels.copy() if copy else self._pixels

    @property
    def __array_interface__(self) -> dict[str, Any]:
        # Arrays get the buffer, and not its address. So they keep the pixels alive, but neither the picture nor its scene.
        return {**self._pixels.__array_interface__, "data": self._pixels.data.cast("B"), "strides": None}

    def __array_ufunc__(self, ufunc: Any, method: str, *inputs: Any, **kwargs: Any) -> Any:
        plain = [one._pixels if isinstance(one, Image) else one for one in inputs]
        if "out" in kwargs:
            kwargs["out"] = tuple(one._pixels if isinstance(one, Image) else one for one in kwargs["out"])
        return getattr(ufunc, method)(*plain, **kwargs)

    def __eq__(self, other: object) -> Any:
        if not isinstance(other, Image):
            return NotImplemented
        return (np.array_equal(self._pixels, other._pixels, equal_nan=True) and self.layers.keys() == other.layers.keys()
                and all(np.array_equal(one, other.layers[name], equal_nan=True) for name, one in self.layers.items()))

    def __ne__(self, other: object) -> Any:
        same = self.__eq__(other)
        return same if same is NotImplemented else not same

    __hash__ = None  # type: ignore[assignment]

    def __reduce__(self) -> Any:
        return _restored, (self.scene, self._pixels.copy(), dict(self.layers), dict(self.statistics))

    def __deepcopy__(self, memo: dict[int, Any]) -> Image:
        return _restored(self.scene, self._pixels, self.layers, dict(self.statistics))

    @property
    def size(self) -> tuple[int, int]:
        """Width and height in pixels."""
        return self._pixels.shape[1], self._pixels.shape[0]

    @property
    def shape(self) -> tuple[int, ...]:
        """(height, width, 4)."""
        return tuple(self._pixels.shape)

    def _options(self, background: Any = None, exposure: float | None = None, tone: str | None = None,
                 depth: int = 8) -> Any:
        options = ffi.new("hl_image_write_options *")
        lib.hl_scene_write_options(self.scene._handle, options)
        options.png_depth = depth
        if exposure is not None:
            options.exposure = number("exposure", exposure)
        if tone is not None:
            options.tone = to_field("tone", table(lib.HL_SETTINGS_IMAGE)["tone"], tone)
        if background is not None:
            options.background_transparent = isinstance(background, str) and background == "transparent"
            if not options.background_transparent:
                options.background = colors.linear_color("background", background)
        return options

    @suggests
    def to_srgb8(self, background: Any = None, exposure: float | None = None,
                 tone: str | None = None) -> np.ndarray[Any, np.dtype[np.uint8]]:
        """The picture for screens.

        Parameters
        ----------
        background : colour or "transparent", optional
            Default: the scene's. Names and "#rrggbb" are sRGB, numbers linear.
        exposure : float, optional
            Stops; default: the scene's.
        tone : "clip" or "filmic", optional
            The way in which light brighter than white is shown; default: the scene's.

        Returns
        -------
        ndarray of uint8, shape (height, width, 4)
            sRGB; alpha is 255, or unassociated over "transparent".
        """
        codes = np.empty(self._pixels.shape, np.uint8)
        call(lib.hl_image_to_srgb8, self._handle, self._options(background, exposure, tone),
             ffi.from_buffer("uint8_t[]", codes), codes.strides[0])
        return codes

    def as_display(self) -> Image:
        """The picture whose colours were shaded as screens show them, as VTK does: its numbers are taken for sRGB.

        Returns
        -------
        Image
            A picture without layers. If it is shown or saved, its colours are this picture's numbers. The picture is
            opaque. It is mixed with the scene's background in sRGB, as screens do, unless the background is
            transparent.
        """
        alpha, background = self._pixels[..., 3:], self.scene.background
        if not isinstance(background, str):
            mixed = self._pixels[..., :3] + (1 - alpha) * colors.to_srgb(background)
            opaque = np.concatenate([colors.to_linear(mixed.clip(0)), np.ones_like(alpha)], axis=-1)
            return _restored(self.scene, opaque.astype(np.float32), {}, self.statistics)
        plain = np.divide(self._pixels[..., :3], alpha, out=np.zeros_like(self._pixels[..., :3]), where=alpha > 0)
        linear = colors.to_linear(plain.clip(0)) * alpha
        return _restored(self.scene, np.concatenate([linear, alpha], axis=-1).astype(np.float32), {}, self.statistics)

    def _scene_text(self, folder: str | None) -> Any:
        """The text of the scene for a PNG in a folder; None if volumes are arrays, because no file can name them."""
        try:
            return ffi.new("char[]", self.scene._text(folder).encode())
        except ValueError:
            return ffi.NULL

    @suggests
    def save(self, path: str | os.PathLike[str] | IO[bytes], *, format: str | None = None, depth: int = 8,
             background: Any = None, exposure: float | None = None, tone: str | None = None, metadata: bool = True) -> None:
        """Write a .png (sRGB, over the background, with the scene in it), .exr or .npy (linear; with layers).

        If Pillow is installed, it writes .jpg, .tif, .pdf and .webp files, too, in 8-bit sRGB without the scene.

        Parameters
        ----------
        path : path, or an open binary file such as io.BytesIO
            A file appears whole or not at all. Layers are channels of an .exr, and files of their own beside
            an .npy; other pictures are written without them.
        format : str, optional
            "png", "exr", ...; by default the ending of the name, and "png" for open files without a name.
        depth : 8 or 16
            Bits per channel of a .png.
        background, exposure, tone : optional
            As in `to_srgb8`. They have no effect on .exr and .npy files.
        metadata : bool
            Whether a .png carries its scene. Files in the picture's folder or below it are named relative to this
            folder.
        """
        open_file: Any = path if hasattr(path, "write") else None
        name = str(getattr(path, "name", "")) if open_file is not None else os.fspath(path)  # type: ignore[arg-type]
        ending = os.path.splitext(name)[1][1:].lower()
        if format is not None:
            kind = choice("format", format, [*_FORMATS, *picture_files.FORMATS])
        else:
            kind = "png" if open_file is not None and ending not in (*_FORMATS, *picture_files.FORMATS) else ending
            if kind not in (*_FORMATS, *picture_files.FORMATS):
                raise UnsupportedError(f"{name}: unknown picture format: end the name in .png, .exr, .npy, .jpg, .tif, .pdf or .webp")
        shown = {"background": background is not None, "exposure": exposure is not None, "tone": tone is not None}
        for word, given in ({"depth": depth != 8} | (shown if kind not in picture_files.FORMATS else {})).items():
            if given and kind != "png":
                raise ValueError(f"{word} is for .png pictures, not for '{name}': " + (
                    "its colours have 8 bits" if kind in picture_files.FORMATS else ".exr and .npy hold linear floats"))
        if kind in picture_files.FORMATS:
            content = picture_files.encode(self.to_srgb8(background, exposure, tone), kind)
        elif open_file is None and kind == ending:
            call(lib.hl_image_write, context, self._handle if kind != "png" else self._plain(), path_bytes(name),
                 self._with_scene(self._options(background, exposure, tone, depth), metadata, os.path.dirname(name)))
            return
        else:
            content = self._encoded(kind, self._options(background, exposure, tone, depth), metadata)
        if open_file is not None:
            open_file.write(content)
        else:
            picture_files.write_whole(name, content)

    def _with_scene(self, options: Any, metadata: bool, folder: str | None = None) -> Any:
        text = self._scene_text(folder) if metadata else ffi.NULL
        options.scene_json = text
        return ffi.gc(options, lambda _: text and None)

    def _plain(self) -> Any:
        """The picture without layers, which a PNG cannot hold."""
        if not self.layers:
            return self._handle
        plain = Image(self.scene)
        plain._pixels[...] = self._pixels
        return plain._handle

    def encode(self, format: str = "png", *, depth: int = 8, metadata: bool = True) -> bytes:
        """The bytes of a "png" (of 8 or 16 bits), "exr" or "npy" file, or of one that Pillow writes; metadata: as for `save`."""
        if choice("format", format, [*_FORMATS, *picture_files.FORMATS]) in picture_files.FORMATS:
            return picture_files.encode(self.to_srgb8(), format)
        return self._encoded(format, self._options(depth=depth), metadata)

    def _encoded(self, format: str, options: Any, metadata: bool) -> bytes:
        return encoded(lib.hl_image_encode, context, self._handle if format == "exr" else self._plain(), format.encode(),
                       self._with_scene(options, metadata))

    def _repr_png_(self) -> bytes:
        return self.encode("png")

    def show(self) -> None:
        """Show the picture in the cell's output of a notebook, or else by the program that the system uses for PNG
        files.
        """
        try:
            from IPython import get_ipython
            from IPython.display import display

            if getattr(get_ipython(), "kernel", None) is not None:
                display(self)
                return
        except ImportError:
            pass
        import tempfile
        import webbrowser

        folder = tempfile.mkdtemp(prefix="halflight-")
        self.save(os.path.join(folder, "picture.png"))
        webbrowser.open(f"file://{folder}/picture.png")

    @suggests
    def annotate(self, *, scale_bar: bool | str = False, unit: str | None = None, depth: float | str | None = None,
                 legend: bool | str = False, axes: str | None = None, marks: bool = False,
                 texts: Sequence[tuple[str, Sequence[float]]] | Mapping[str, Sequence[float]] = (), letter: str | None = None,
                 places: Mapping[str, str] | None = None,
                 width: float | str | None = None, dpi: float | None = None, font_size: float = 7, font: str = "Sans") -> Figure:
        """The picture as a figure, with an overlay that is drawn over it. The figure's `save` writes .pdf, .svg, .png
        or .tif.

        Parameters
        ----------
        scale_bar : bool or str
            Whether a scale bar is drawn, or the bar's length, such as "50um".
        unit : str, optional
            The unit of lengths in the volumes if their files do not state it: "mm", "um", ... or any other text.
        depth : float or "target", optional
            The distance from the eye at which the bar's length is right. A perspective picture needs it, because its
            scale changes with depth.
        legend : bool or str
            Whether a legend is drawn. It shows the volumes' colours and opacities over their values, or the names of
            labels. A text is the legend's title.
        axes : "arrows" or "letters", optional
            Draws the directions of the world as arrows, or the directions of the body as letters at the edges.
        marks : bool
            Whether the scene's rulers, angles, lines, arrows and texts are drawn, with their lengths and angles.
        texts : sequence of (str, (x, y)) or (str, (x, y, z)), or a mapping
            Texts with their places. A place is two fractions of the picture, counted from its upper left corner, or a
            point of the scene's world.
        letter : str, optional
            The panel's letter, which is drawn at the upper left.
        places : mapping, optional
            Corners for "legend", "scale_bar" and "axes" (arrows), such as ``{"legend": "upper left"}``. Each of them that
            has no corner here lies where it covers the least. ``{"legend": "below"}`` adds a strip with the legend below
            the picture, or below all pictures of a page.
        width : float or str, optional
            The width of the picture on paper: millimetres, or a text such as "89mm", "3.5in".
        dpi : float, optional
            Pixels an inch of .png and .tif. Without `width` it decides how large the picture is on paper.
        font_size, font : float, str
            The size of letters in points on a picture of that width (89 mm if none is given); the name of a family of
            fonts.

        Examples
        --------
        ``image.annotate(legend="Density (g/cm3)", width="40mm").save("figure.pdf")``, where the build draws figures: wheels do not.
        """
        from .figure import _Overlay, annotate

        overlay = _Overlay(scale_bar, unit, depth, legend, axes, marks, texts, letter, dict(places or {}))
        return annotate(self, overlay, width, dpi, font_size, font)

    def __repr__(self) -> str:
        return f"<halflight.Image {self.size[0]}x{self.size[1]}>"

    @suggests
    def plot(self, ax: Axes | None = None, *, colorbar: bool = True, scale_bar: bool = True, unit: str = "") -> Axes:
        """Show the picture in axes of matplotlib, with the colours of the first volume and a scale bar.

        Parameters
        ----------
        ax : matplotlib Axes, optional
            Default: a new figure's.
        colorbar, scale_bar : bool
            The colour bar shows the transfer function's colours; the scale bar's length is right at the camera's
            target.
        unit : str
            Of the world, for the scale bar.
        """
        from .plot import plot

        return plot(self, ax, colorbar, scale_bar, unit)


def _restored(scene: Scene, pixels: Pixels, layers: Mapping[str, Pixels], statistics: Mapping[str, Any]) -> Image:
    """The picture with these pixels, as pickle and copy make it."""
    image = Image(scene)
    image._pixels[...] = pixels
    found = {}
    for name, values in layers.items():
        letters = "Z" if values.ndim == 2 else "XYZ" if name == "normal" else "RGB"
        _, found[name] = image._add_layer(name, letters)
        found[name][...] = values
    image._finish(found, statistics)
    return image
