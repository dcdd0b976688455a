"""Writes pictures in the formats that Pillow writes: `Image.save` uses this module for .jpg, .tif, .pdf and .webp."""
from __future__ import annotations

import io
import os
from typing import Any

import numpy as np

__all__ = ["FORMATS", "encode", "write_whole"]

FORMATS = {"jpg": "jpeg", "jpeg": "jpeg", "tif": "tiff", "tiff": "tiff", "pdf": "pdf", "webp": "webp"}
_OPAQUE = ("jpeg", "pdf")


def encode(codes: np.ndarray[Any, Any], format: str) -> bytes:
    """The bytes of a file with the pixels, [height][width][4] in 8-bit sRGB. format: a key of FORMATS."""
    try:
        from PIL import Image as Pillow
    except ImportError:
        raise ImportError(f".{format} pictures need Pillow: pip install pillow, or save a .png") from None
    kind = FORMATS[format]
    solid = kind in _OPAQUE or codes[..., 3].min() == 255
    place = io.BytesIO()
    words: dict[str, dict[str, Any]] = {"jpeg": {"quality": 95, "subsampling": 0}, "tiff": {"compression": "tiff_deflate"},
                                        "pdf": {"resolution": 300.0}, "webp": {"lossless": True}}
    Pillow.fromarray(np.ascontiguousarray(codes[..., :3] if solid else codes)).save(place, kind, **words[kind])
    return place.getvalue()


def write_whole(path: str, content: bytes) -> None:
    """Write a file that appears whole or not at all."""
    beside = f"{path}.{os.getpid()}.part"
    try:
        with open(beside, "xb") as file:
            file.write(content)
        os.replace(beside, path)
    except BaseException:
        if os.path.exists(beside):
            os.unlink(beside)
        raise
