"""Defines the keywords for a volume's look and its place, and fills the library's struct from them."""
from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any, Literal

import numpy as np

from . import _settings, cuts, isosurface, mask
from ._library import call, choices_of, context, ffi, lib
from ._words import choice
from .keywords import MaterialSettings, VolumeSettings
from .transfer import TransferFunction
from .values import Values

__all__ = ["Look", "fill_look"]

_MATERIAL = _settings.names(lib.HL_SETTINGS_MATERIAL)


class Look(VolumeSettings, MaterialSettings, Values, total=False):
    """Keywords of `Volume` for the volume's look and its place. Keywords that are not given are chosen from the data.

    Parameters
    ----------
    name : str
        The volume's name.
    transfer_function : TransferFunction
        The opacities and colours of values.
    cmap, clim, log_scale, opacity, opacity_unit_distance, tf
        Changes of this function, or of the one that is chosen from the data, as for `halflight.render`.
    clip : ((x, y, z), (x, y, z)) or None
        The corners of the box that is kept, in the world before the transform.
    scale : float or 3 floats
        The factors along the world's axes, before the rotation.
    iso : a value, (value, color, opacity), or a list of them
        Surfaces on which the volume has one value, in place of what an automatic transfer function shows. Colour and
        opacity may be left out.
    cuts : a mapping or a list of them
        What is cut out of the volume, as in a scene file: {"type": "plane", "point": (x, y, z), "normal": (x, y, z)},
        {"type": "box", "min": ..., "max": ...}, {"type": "sphere", "center": ..., "radius": ...}; with "keep":
        "inside" all else is cut away.
    mask : a label map (path, array or Volume), or a mapping
        A label map within whose labels the volume is visible. A mapping has the map as `volume`; as `show` the labels,
        by name or number, alone or with a colour, an opacity from 0 to 1, or (colour, opacity); as `rest` what is left
        outside of them; as `table` a file of names and colours: ``{"volume": "organs.seg.nrrd", "show": {"bone": None,
        "tumour": "red", "liver": 0.3}, "rest": 0.02}``. A map of as many voxels whose source does not tell its place has
        the volume's place.
    labels : bool, a label, a list of labels, or a mapping
        The volume is a label map, and its labels show as smooth surfaces: all of them, or those that are named, by name or
        number, with what a mask's `show` may say of each; a mapping may have a `table` of names and colours beside `show`.
        A volume that is taken for a label map shows all its labels without being told; False: it is drawn by its values, as
        with a `transfer_function`, `iso` or `mask`.
    look : str
        "surface", "translucent", "xray", "smoke" or "vessels": the transfer function and shading of that look; "mip": a
        maximum projection, which the whole picture is then.
    """

    name: str
    transfer_function: TransferFunction
    clip: tuple[Sequence[float], Sequence[float]] | None
    scale: float | Sequence[float]
    iso: Any
    cuts: Any
    mask: Any
    labels: Any
    look: Literal["auto", "surface", "translucent", "xray", "smoke", "vessels", "mip"]


def fill_look(struct: Any, look: Mapping[str, Any], handle: Any, takes_look: bool, as_volume: Callable[[Any], Any],
              keep: list[Any], place: str) -> None:
    """Set the members of an hl_scene_volume that the keywords of a volume give.

    Parameters
    ----------
    struct : hl_scene_volume
        Valid as long as `keep`.
    look : mapping
        The keywords of `Look` that were given.
    handle : hl_volume
    takes_look : bool
        Whether the transfer function and shading of the keyword `look` are still to be set.
    as_volume : callable
        A function that makes a Volume of the source that a mask names.
    place : str
        The text with which messages of errors begin.
    """
    changes = dict(look)
    if (name := changes.pop("name", None)) is not None:
        if not isinstance(name, str):
            raise TypeError(f"{place}name: {name!r} is no text")
        keep.append(text := ffi.new("char[]", name.encode()))
        struct.name = text
    if (given := changes.pop("mask", None)) is not None:
        mask.fill(struct, given, as_volume, keep, place)
    if (labels := changes.pop("labels", None)) is not None and labels is not False:
        mask.fill_labels(struct, labels, handle, keep, place)
    if (name := changes.pop("look", None)) is not None and takes_look:
        _take_look(struct, name, handle, keep)
    if (iso := changes.pop("iso", None)) is not None:
        isosurface.fill(struct, iso, keep, place)
        changes.setdefault("transfer_function", TransferFunction([(0, 0)]) if struct.iso_count > 0 else None)
    if (cut := changes.pop("cuts", None)) is not None:
        cuts.fill(struct, cut, keep, place)
    if (function := changes.pop("transfer_function", None)) is not None:
        if not isinstance(function, TransferFunction):
            raise TypeError(f"{place}transfer_function: {function!r} is no TransferFunction")
        function._fill(struct.transfer_function, keep)
    if "clip" in changes:
        clip = changes.pop("clip")
        struct.clipped = clip is not None
        if clip is not None:
            if len(clip) != 2:
                raise ValueError(f"{place}clip: {clip!r} is not ((x, y, z), (x, y, z))")
            struct.clip_min = _settings.numbers_of(f"{place}clip[0]", clip[0])
            struct.clip_max = _settings.numbers_of(f"{place}clip[1]", clip[1])
            if not all(low < high for low, high in zip(struct.clip_min, struct.clip_max, strict=True)):
                raise ValueError(f"{place}clip: {clip!r}: the first corner is not below the second")
    if (scale := changes.pop("scale", None)) is not None:
        struct.scale = 1.0
        struct.axis_scale = ([_settings.number(f"{place}scale", scale)] * 3 if np.ndim(scale) == 0
                             else _settings.numbers_of(f"{place}scale", scale))
    material = _settings.taken(changes, _MATERIAL)
    _settings.fill(place, struct.material, lib.HL_SETTINGS_MATERIAL, material)
    _settings.fill(place, struct, lib.HL_SETTINGS_VOLUME, changes)


def _take_look(struct: Any, look: Any, handle: Any, keep: list[Any]) -> None:
    """Give an hl_scene_volume the transfer function and shading of a look; in a maximum projection both stay."""
    if choice("look", look, choices_of("look")) == "mip":
        return
    function, shading = ffi.new("hl_transfer_function *"), ffi.new("hl_shading *", struct.shading)
    call(lib.hl_transfer_function_look, context, look.encode(), handle, function, shading)
    keep += [function, ffi.gc(function, lambda made: lib.hl_transfer_function_release(context, made))]
    struct.transfer_function, struct.shading = function[0], shading[0]
