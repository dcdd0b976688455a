"""What would go wrong silently: arrays that change after they were borrowed, limits that do not hold."""
import re
import sys

import numpy as np
import pytest

import halflight
from halflight import Renderer, Scene, Volume
from halflight._library import context, lib

CHANGED = "the array was changed after the volume was made: make a new Volume and Scene of it, or give copy=True"


@pytest.fixture
def array(blob):
    return blob.copy()


CHANGES = {
    "all": lambda a: a.__imul__(2), "a slice": lambda a: a.__setitem__(9, 7), "a box": lambda a: a.__setitem__(np.s_[8:12, 8:12, 8:12], 7),
    "a voxel": lambda a: a.__setitem__((3, 4, 5), a[3, 4, 5] + 1),
}


@pytest.mark.parametrize("change", CHANGES)
def test_an_array_that_changed_gives_no_old_picture(array, change):
    volume = Volume(array)
    scene, renderer = Scene(volume, size=(32, 24)), Renderer()
    renderer.render(scene)
    CHANGES[change](array)
    for use in (lambda: renderer.render(scene), lambda: Renderer().render(scene.replace(size=16)), lambda: halflight.reference(scene),
                lambda: scene.save("changed.json")):
        with pytest.raises(ValueError, match=f"^{re.escape(CHANGED)}$"):
            use()
    assert np.array_equal(np.asarray(halflight.render(array, size=(32, 24))), np.asarray(halflight.render(array.copy(), size=(32, 24))))


def test_a_large_array_is_sampled():
    large = np.zeros((100, 120, 300), np.uint16)
    large[20:60, 30:90, 50:250] = 900
    scene = Scene(large, size=16)
    large[40:44, 50:54, 101:109] = 5  # a box as wide as the gaps between the sample's voxels
    with pytest.raises(ValueError, match=CHANGED):
        Renderer().render(scene)


def test_masks_are_watched(array, blob):
    mask = (blob > 60).astype(np.uint8)
    scene = Scene([Volume(array, mask=mask), Volume(array)], size=16)
    mask[...] = 0
    with pytest.raises(ValueError, match=r"^volumes\[0\]: the mask was changed"):
        Renderer().render(scene)


def test_copies_may_change(array):
    volume = Volume(array, copy=True)
    scene = Scene(volume, size=(32, 24))
    expected = np.asarray(Renderer().render(scene))
    array[...] = 0
    assert np.array_equal(np.asarray(Renderer().render(scene)), expected)
    kept = Scene(array.astype(np.int32), size=16)  # copied in any case
    Renderer().render(kept)


def test_volumes_of_scenes_are_watched(array):
    scene = Scene(array, size=16)
    inner = Scene._of(scene._handle)
    array[...] = 9
    with pytest.raises(ValueError, match="was changed"):
        Renderer().render(inner)


class Chunks:
    """An array that is read by slices: it counts the largest piece that was asked for."""

    def __init__(self, values):
        self.values, self.shape, self.dtype, self.chunks = values, values.shape, values.dtype, (8, 64, 64)
        self.largest = 0

    def __getitem__(self, index):
        piece = self.values[index]
        self.largest = max(self.largest, piece.nbytes)
        return piece


@pytest.fixture
def scratch(tmp_path):
    (tmp_path / "scratch").mkdir()
    yield tmp_path / "scratch"
    halflight.limit_memory(None)


def has_no_names(scratch):
    """Whether other users find nothing in the folder of scratch files. On Windows a file has its name until it is closed."""
    return sys.platform == "win32" or list(scratch.iterdir()) == []


def test_limits_hold_for_arrays_that_are_read_by_slices(scratch, monkeypatch):
    monkeypatch.setattr(halflight.pieces, "_PIECE", 1 << 20)
    k, j, i = np.indices((160, 180, 190), np.uint16)
    values = ((3 * i + 5 * j + 7 * k) % 256).astype(np.uint8)
    place = {"spacing": (2, 1, 1.5), "axes": "zyx", "origin": (1, 2, 3)}
    look = {"size": (16, 12), "shadows": "off", "sky": 0, "tf": halflight.TransferFunction([(250, 0), (255, 0.9)])}
    whole = np.asarray(halflight.render(values, **look, **place))
    held = lib.hl_context_memory_held(context)
    halflight.limit_memory(held + 5_300_000, scratch_folder=scratch)
    source = Chunks(values)
    volume = Volume(source, **place)
    assert source.largest <= 1 << 20 and has_no_names(scratch)
    assert lib.hl_context_memory_held(context) < held + 5_300_000 < held + values.nbytes
    halflight.limit_memory(held + 600_000_000, scratch_folder=scratch)
    assert np.array_equal(np.asarray(halflight.render(volume, **look)), whole)
    halflight.limit_memory(held + 5_300_000, scratch_folder=scratch)
    turned = Volume(Chunks(values.transpose(2, 0, 1)), axes="xzy", spacing=(1.5, 2, 1), origin=(1, 2, 3))
    assert turned.info().range == (0, 255)
    corner = turned.affine @ [0, 0, 0, 1]
    assert corner.tolist() == [1, 2, 3, 1] and sorted(turned.info().spacing.tolist()) == [1, 1.5, 2]
    with pytest.raises(TypeError, match="the array's type is complex128"):
        Volume(Chunks(np.zeros((160, 180, 190), complex)))
    assert has_no_names(scratch)


@pytest.mark.parametrize("package", ["dask", "zarr", "h5py"])
def test_limits_hold_for_packages(scratch, package, tmp_path):
    values = (np.indices((160, 180, 190), np.uint16).sum(axis=0) % 251).astype(np.uint8)
    if package == "dask":
        source = pytest.importorskip("dask.array").from_array(values, chunks=(20, 90, 190))
    elif package == "zarr":
        source = pytest.importorskip("zarr").create_array(tmp_path / "a.zarr", data=values, chunks=(20, 90, 190))
    else:
        source = pytest.importorskip("h5py").File(tmp_path / "a.h5", "w").create_dataset("a", data=values, chunks=(20, 90, 190))
    held = lib.hl_context_memory_held(context)
    halflight.limit_memory(held + 5_300_000, scratch_folder=scratch)
    volume = Volume(source)
    assert lib.hl_context_memory_held(context) < held + 5_300_000
    halflight.limit_memory(held + 600_000_000, scratch_folder=scratch)
    assert np.array_equal(np.asarray(volume), values)
