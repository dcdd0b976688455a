"""Implements `Scene.save`: writes a scene file, and a folder beside it with the data that were only in memory."""
from __future__ import annotations

import os
import re
from typing import TYPE_CHECKING, Any

import numpy as np

from . import pieces, picture_files
from ._library import call, context, ffi, lib, made, path_bytes, text_of

if TYPE_CHECKING:
    from .scene import Scene
    from .volume import Volume

__all__ = ["save"]


class _Folder:
    """The folder for the files that a scene names. It is made when the first file is written."""

    def __init__(self, path: str) -> None:
        self.path = path
        self.taken: set[str] = set()

    def place(self, wanted: str | None, standard: str, ending: str) -> str:
        """A path in the folder that no other file of the scene has."""
        stem = re.sub(r"[^A-Za-z0-9._-]+", "_", wanted or standard).strip("._") or standard
        name, count = stem, 2
        while name + ending in self.taken:
            name, count = f"{stem}-{count}", count + 1
        self.taken.add(name + ending)
        os.makedirs(self.path, exist_ok=True)
        return os.path.join(self.path, name + ending)


def _write_voxels(volume: Volume, path: str) -> None:
    if volume._colored is None:
        call(lib.hl_volume_save, context, volume._handle if volume._sharp is None else volume._sharp, path_bytes(path))
    else:
        _, (voxels, place, space, _) = volume._source()
        picture_files.write_whole(path, pieces.color_file(voxels, "zyx", place, space))


def _write_pixels(struct: Any, path: str) -> None:
    held = ffi.buffer(struct.pixels, 4 * struct.width * struct.height * 3)
    with open(path, "wb") as file:
        np.save(file, np.frombuffer(held, np.float32).reshape(struct.height, struct.width, 3))


def _forget_reading(struct: Any) -> None:
    """Remove the options by which the volume was read from its old file, because the new file has only one array."""
    plain = ffi.new("hl_scene_volume *")
    lib.hl_scene_volume_defaults(plain)
    for word in ("array", "series", "component", "time", "channel", "level", "spacing", "file_space"):
        setattr(struct, word, getattr(plain, word))


def _put_volumes(scene: Scene, folder: _Folder, copy: bool, name: Any) -> Any:
    description = scene._struct
    if description.volume_count == 0:
        return ffi.NULL
    volumes = ffi.new("hl_scene_volume[]", description.volume_count)
    ffi.memmove(volumes, description.volumes, ffi.sizeof(volumes))
    for n, (struct, volume) in enumerate(zip(volumes, scene.volumes, strict=True)):
        if struct.shapes == ffi.NULL and (copy or struct.file == ffi.NULL):
            path = folder.place(None if struct.name == ffi.NULL else text_of(struct.name), f"volume{n}", ".nrrd")
            _write_voxels(volume, path)
            struct.file = name(path)
            _forget_reading(struct)
        elif struct.file != ffi.NULL:
            struct.file = name(os.path.abspath(os.fsdecode(ffi.string(struct.file))))
        if struct.mask.volume != ffi.NULL and (copy or struct.mask.file == ffi.NULL):
            path = folder.place(None, f"mask{n}", ".nrrd")
            call(lib.hl_volume_save, context, struct.mask.volume, path_bytes(path))
            struct.mask.file = name(path)
    return volumes


def save(scene: Scene, path: str, copy: bool) -> None:
    """See `Scene.save`."""
    if not path.lower().endswith(".json"):
        raise ValueError(f"'{path}': a scene file's name ends in .json")
    scene._check_arrays()
    beside = os.path.dirname(os.path.abspath(path))
    folder = _Folder(os.path.join(beside, os.path.basename(path)[:-5] + "_files"))
    keep: list[Any] = []

    def name(file: str) -> Any:
        keep.append(text := ffi.new("char[]", path_bytes(file)))
        return text

    description = ffi.new("hl_scene_description *", scene._struct[0])
    description.volumes = volumes = _put_volumes(scene, folder, copy, name)
    lights = ffi.new("hl_light[]", description.light_count)
    ffi.memmove(lights, description.lights, ffi.sizeof(lights))
    images = [getattr(light, word) for light in lights for word in ("texture", "emission")] + [description.sky]
    for image in images:
        if image.pixels != ffi.NULL and image.file == ffi.NULL:
            _write_pixels(image, file := folder.place(None, "image", ".npy"))
            image.file = name(file)
    description.lights = lights
    named = made(lib.hl_scene_create, "hl_scene", lib.hl_scene_release, context, description)
    del volumes
    text = ffi.new("char **")
    call(lib.hl_scene_to_json_beside, context, named, ffi.new("char[]", path_bytes(beside)), text)
    try:
        picture_files.write_whole(path, ffi.string(text[0]))
    finally:
        lib.hl_text_release(context, text[0])
