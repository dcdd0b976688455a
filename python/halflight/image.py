"""Pictures: linear premultiplied RGBA in float32, top row first."""
from __future__ import annotations

import os
from collections.abc import Mapping
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

import numpy as np

from . import colors
from ._library import call, context, ffi, lib, made
from ._settings import number, table, to_field
from ._words import choice, suggests
from .scene import Scene

if TYPE_CHECKING:
    from matplotlib.axes import Axes

__all__ = ["Image"]

Pixels = np.ndarray[Any, np.dtype[np.float32]]
_FORMATS = ("png", "exr", "npy")


def _view(pointer: Any, owner: Any, shape: tuple[int, ...]) -> Pixels:
    """The library's floats as an array, which keeps `owner` alive."""
    kept = ffi.gc(pointer, lambda _: owner and None)
    count = int(np.prod(shape))
    return np.frombuffer(ffi.buffer(kept, 4 * count), np.float32, count).reshape(shape)


class Image:
    """A picture: ``numpy.asarray(image)`` is float32, [height][width][4], without a copy.

    Values are linear premultiplied RGBA of the volumes alone; the background is added where a picture is shown:
    in `to_srgb8`, PNG files, notebooks and `plot`.

    Attributes
    ----------
    layers : mapping of str to ndarray of float32
        What the picture is made of, where ``layers=True`` was asked for: "light0", "light0_shadow", "ambient",
        "normal" [height][width][3], "depth_first", "depth_mean", "object" [height][width]; see docs/layers.md.
    statistics : mapping
        Seconds, sheets, voxels, threads and the instruction set, named as in `hl_render_statistics`.
    scene : Scene
        What was rendered.

    Examples
    --------
    >>> import numpy as np, halflight
    >>> image = halflight.render(np.ones((8, 8, 8), np.uint8), size=(32, 24))
    >>> np.asarray(image).shape, image.to_srgb8().dtype
    ((24, 32, 4), dtype('uint8'))
    """

    __slots__ = ("__weakref__", "_handle", "_pixels", "layers", "scene", "statistics")

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
            How light brighter than white is shown; default: the scene's.

        Returns
        -------
        ndarray of uint8, shape (height, width, 4)
            sRGB; alpha is 255, or unassociated over "transparent".
        """
        codes = np.empty(self._pixels.shape, np.uint8)
        call(lib.hl_image_to_srgb8, self._handle, self._options(background, exposure, tone),
             ffi.from_buffer("uint8_t[]", codes), codes.strides[0])
        return codes

    def _scene_text(self, folder: str | None) -> Any:
        """The scene for a PNG in a folder; none where volumes are arrays, which no file can name."""
        try:
            return ffi.new("char[]", self.scene._text(folder).encode())
        except ValueError:
            return ffi.NULL

    @suggests
    def save(self, path: str | os.PathLike[str], *, depth: int = 8, background: Any = None,
             exposure: float | None = None, tone: str | None = None, metadata: bool = True) -> None:
        """Write a .png (sRGB, over the background, with the scene in it), .exr or .npy (linear; with layers).

        Parameters
        ----------
        path : path
            The file appears whole or not at all. Layers are channels of an .exr, and files of their own beside
            an .npy; a .png is written without them.
        depth : 8 or 16
            Bits per channel of a .png.
        background, exposure, tone : optional
            As in `to_srgb8`; of a .png.
        metadata : bool
            Whether a .png carries its scene, with the names of its files: of files beside the picture, or below
            its folder, relative to it.
        """
        file = os.fspath(path)
        if not file.lower().endswith(".png"):
            for word, given in (("depth", depth != 8), ("background", background is not None),
                                ("exposure", exposure is not None), ("tone", tone is not None)):
                if given:
                    raise ValueError(f"{word} is for .png pictures, not for '{file}': .exr and .npy hold linear floats")
        call(lib.hl_image_write, context, self._handle if not file.lower().endswith(".png") else self._plain(),
             os.fsencode(file), self._with_scene(self._options(background, exposure, tone, depth), metadata, os.path.dirname(file)))

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
        """The bytes of a "png" (of 8 or 16 bits), "exr" or "npy" file; metadata: as for `save`."""
        choice("format", format, _FORMATS)
        data, length = ffi.new("unsigned char **"), ffi.new("size_t *")
        call(lib.hl_image_encode, context, self._handle if format == "exr" else self._plain(), format.encode(),
             self._with_scene(self._options(depth=depth), metadata), data, length)
        try:
            return bytes(ffi.buffer(data[0], length[0]))
        finally:
            lib.hl_bytes_release(context, data[0])

    def _repr_png_(self) -> bytes:
        return self.encode("png")

    def __repr__(self) -> str:
        return f"<halflight.Image {self.size[0]}x{self.size[1]}>"

    @suggests
    def plot(self, ax: Axes | None = None, *, colorbar: bool = True, scale_bar: bool = True, unit: str = "") -> Axes:
        """Show the picture in a matplotlib axis, with the colours of the first volume and a scale bar.

        Parameters
        ----------
        ax : matplotlib Axes, optional
            Default: a new figure's.
        colorbar, scale_bar : bool
            The colour bar shows the transfer function's colours; the scale bar holds at the camera's target.
        unit : str
            Of the world, for the scale bar.
        """
        from .plot import plot

        return plot(self, ax, colorbar, scale_bar, unit)
