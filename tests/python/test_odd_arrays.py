"""Thirty arrays that are no packed [z][y][x] of uint8: each gives the picture of the plain one that it stands for."""
import array
import ctypes
import warnings

import numpy as np
import pytest

import halflight
from halflight import Volume


class Interface:
    """An array by the array interface alone."""

    def __init__(self, values):
        self.values, self.__array_interface__ = values, values.__array_interface__


class Method:
    """An array by __array__ alone, without the keyword of NumPy 2."""

    def __init__(self, values):
        self.values = values

    def __array__(self, dtype=None):
        return self.values if dtype is None else self.values.astype(dtype)


class Stored:
    """Chunks on a disk, read by slices."""

    def __init__(self, values):
        self.values, self.shape, self.dtype, self.chunks = values, values.shape, values.dtype, (5, 5, 5)

    def __getitem__(self, index):
        return self.values[index]


def memory_mapped(a, folder):
    np.save(folder / "mapped.npy", a)
    return np.load(folder / "mapped.npy", mmap_mode="r")


def unaligned(a, folder):
    raw = np.zeros(a.size * 2 + 1, np.uint8)
    found = raw[1:].view(np.uint16).reshape(a.shape)
    found[...] = a
    return found


def of_ctypes(a, folder):
    found = (ctypes.c_uint8 * a.shape[2] * a.shape[1] * a.shape[0])()
    np.ctypeslib.as_array(found)[...] = a
    return found


def field_of_records(a, folder):
    records = np.zeros(a.shape, [("id", "u1"), ("value", "u2")])
    records["value"] = a
    return records["value"]


class Subclass(np.ndarray):
    """A class of its own, as astropy's and unyt's are."""


def read_only(a, folder):
    found = a.copy()
    found.flags.writeable = False
    return found


ODD = {
    "Fortran order": lambda a, _: np.asfortranarray(a), "turned": lambda a, _: a[::-1].copy()[::-1],
    "turned everywhere": lambda a, _: a[::-1, ::-1, ::-1].copy()[::-1, ::-1, ::-1],
    "cut out": lambda a, _: np.pad(a, 3)[3:-3, 3:-3, 3:-3], "every second of more": lambda a, _: np.repeat(a, 2, 2)[:, :, ::2],
    "one component": lambda a, _: np.stack([a, a], axis=-1)[..., 1], "one frame": lambda a, _: np.stack([a, 255 - a])[0],
    "a frame alone": lambda a, _: a[None], "a channel alone": lambda a, _: a[..., None], "both alone": lambda a, _: a[None, None],
    "big-endian": lambda a, _: a.astype(">u2"), "little-endian": lambda a, _: a.astype("<i4"), "int64": lambda a, _: a.astype(np.int64),
    "uint64": lambda a, _: a.astype(np.uint64), "float16": lambda a, _: a.astype(np.float16), "float32": lambda a, _: a.astype(np.float32),
    "float64": lambda a, _: a.astype(np.float64), "int16": lambda a, _: a.astype(np.int16), "uint32": lambda a, _: a.astype(np.uint32),
    "read-only": read_only, "mapped": memory_mapped, "unaligned": unaligned,
    "masked": lambda a, _: np.ma.masked_array(a, np.zeros(a.shape, bool)), "a subclass": lambda a, _: a.view(Subclass),
    "records": field_of_records, "interface": lambda a, _: Interface(a), "method": lambda a, _: Method(a), "memoryview": lambda a, _: memoryview(a),
    "ctypes": of_ctypes, "chunks": lambda a, _: Stored(a), "a volume's": lambda a, _: np.asarray(Volume(a)),
    "python's array": lambda a, _: memoryview(array.array("B", a.tobytes())).cast("B", a.shape),
}


def test_there_are_thirty():
    assert len(ODD) >= 30


@pytest.mark.parametrize("kind", ODD)
def test_odd_arrays(blob, tmp_path, kind):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        odd = ODD[kind](blob, tmp_path)
        volume = Volume(odd)
    assert volume.dimensions == (28, 20, 24) and volume.info().range == (blob.min(), blob.max())
    assert np.array_equal(np.asarray(volume), blob)
    look = {"tf": halflight.TransferFunction([(0, 0), (255, 0.8)], color=(1, 0.5, 0.2)), "lights": halflight.Directional(direction=(0, 1, -1)),
            "camera": halflight.Camera(position=(14, -90, 30), target=(14, 10, 12)), "size": (48, 32), "threads": 1}
    assert abs(np.asarray(halflight.render(odd, **look)) - np.asarray(halflight.render(blob, **look))).max() < 2e-3


def test_colours_of_voxels():
    """Red, green and blue are sRGB; all the ways to give them are one."""
    red = np.zeros((8, 8, 8, 3), np.uint8)
    red[..., 0] = 255
    look = {"opacity": 0.99, "shade": False, "size": 32, "sky": 0}
    middle = np.asarray(halflight.render(red, **look))[16, 16]
    assert middle[0] > 0.9 and middle[1] < 0.01 and middle[2] < 0.01
    for other in (red.astype(np.uint16) * 257, red / 255, red.transpose(2, 1, 0, 3)[::-1]):
        assert np.allclose(np.asarray(halflight.render(other, **look))[16, 16], middle, atol=2e-2), other.dtype
    faint = np.concatenate([red, np.full((8, 8, 8, 1), 20, np.uint8)], axis=-1)
    faint[4:, ..., 3] = 250
    assert halflight.info(faint).range == (20, 250)  # alpha is the value
    with pytest.raises(ValueError, match="the array's colours go from 0 to 255: floats are from 0 to 1"):
        Volume(red.astype(float))
    nested = Volume(red.transpose(2, 1, 0, 3), axes="xyz", spacing=(1, 2, 3))
    assert sorted(nested.info().spacing.tolist()) == [1, 2, 3] and nested.dimensions == (8, 8, 8)


def test_several_volumes(blob):
    """Channels in one call: lists have one of each."""
    other = np.ascontiguousarray(blob[::-1])
    picture = np.asarray(halflight.render([blob, other], cmap=["red", "lime"], clim=[(50, 250), (60, 255)], specular=0, size=48))
    scene = halflight.Scene([halflight.Volume(blob), halflight.Volume(other)], size=48)
    assert picture[..., 0].max() > 0.1 and picture[..., 1].max() > 0.1 and picture[..., 2].max() < 0.01
    plain = halflight.render([blob, other], size=48)
    assert np.array_equal(np.asarray(plain), np.asarray(halflight.Renderer().render(scene)))
    assert not np.array_equal(picture, np.asarray(halflight.render([blob, other], cmap="red", size=48)))
    one = halflight.render([blob], cmap=["black", "red"], size=48)  # of one volume a list is its colours
    assert np.array_equal(np.asarray(one), np.asarray(halflight.render(blob, cmap=["black", "red"], size=48)))


def test_label_maps(blob):
    labels = (blob > 60).astype(np.uint8) + (blob > 150)

    def shown(**words):
        """The labels that the library shows of the last volume."""
        scene = halflight.render(size=48, **words).scene
        return halflight.volume.volume_from(scene._handle, len(scene.volumes) - 1).look["labels"]

    assert shown(volume=labels, labels=True).keys() == {1, 2} and shown(volume=labels, labels=[2]).keys() == {2}
    assert shown(volume=blob, labels={"volume": labels, "show": {1: ("red", 0.25)}}) == {1: ((1, 0, 0), 0.25)}
    assert shown(volume=blob, labels=labels).keys() == {1, 2}
    assert len(halflight.render(blob, labels=labels, size=48).scene.volumes) == 2
