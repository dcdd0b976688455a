"""Finds the place of a label map that lies over a volume, where the map's source does not tell the place."""
from __future__ import annotations

from typing import TYPE_CHECKING, Any

from . import grids, neighbours, vtk_grids
from ._library import ffi, lib, text_of

if TYPE_CHECKING:
    from .volume import Volume

__all__ = ["place_of_array", "place_of_file"]


def _facts(handle: Any) -> Any:
    """The hl_volume_info of an hl_volume."""
    facts = ffi.new("hl_volume_info *", {"struct_size": ffi.sizeof("hl_volume_info")})
    lib.hl_volume_get_info(handle, facts)
    return facts


def _tells_no_spacing(handle: Any, facts: Any) -> bool:
    """Whether the volume's file tells neither a spacing of voxels, nor a unit of lengths, nor the body's directions."""
    return bool(lib.hl_volume_unit(handle) == ffi.NULL and lib.hl_space_name(facts.space) == ffi.NULL and list(facts.spacing) == [1, 1, 1])


def place_of_file(found: Any, volume: Any, loading: Any) -> dict[str, Any]:
    """The keywords of `Volume` that a label map in a file takes from the volume, as the program's label maps do.

    A map of as many voxels takes the volume's spacing if the caller has stated that spacing, or if the map's file tells none.
    A map whose file does not tell the body's directions takes the directions that the caller has stated for the volume.

    Parameters
    ----------
    found : hl_volume
        The map, as its file places it.
    volume : hl_volume
    loading : (hl_volume_load_options, object) or None
        The options by which the volume was read; None if it was not read from a file.
    """
    own, other, place = _facts(found), _facts(volume), dict[str, Any]()
    stated = loading is not None and loading[0].spacing[0] > 0
    told = not _tells_no_spacing(volume, other)
    if list(own.dimensions) == list(other.dimensions) and (stated or (told and _tells_no_spacing(found, own))):
        place["spacing"] = tuple(other.spacing)[::-1]
    if loading is not None and loading[0].file_space != ffi.NULL and lib.hl_space_name(own.space) == ffi.NULL:
        place["space"] = text_of(loading[0].file_space)
    return place


def place_of_array(source: Any, volume: Volume) -> dict[str, Any]:
    """The keywords of `Volume` that a label map in an array takes from the volume. An array that does not tell its place, and has as
    many voxels, takes the volume's place and the order of its axes.
    """
    if isinstance(source, (grids.Cells, grids.Patches)) or vtk_grids.is_grid(source):
        return {}
    found, other = neighbours.find(source), _facts(volume._handle)
    axes, where = volume._laid or ("zyx", volume._place())
    axes, count = found.axes or axes, list(volume._order or other.dimensions)
    if found.place or found.space or [found.array.shape[axes.index(letter)] for letter in "xyz" if len(found.array.shape) == 3] != count:
        return {}
    columns = [*where.steps, where.origin]
    place: dict[str, Any] = {"axes": axes, "affine": [[column[row] for column in columns] for row in range(3)]}
    if (name := lib.hl_space_name(other.space)) != ffi.NULL:
        place["space"] = text_of(name)
    return place
