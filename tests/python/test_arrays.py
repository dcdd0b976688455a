"""Arrays: any type, order, stride and byte order; no copies where none is needed; lifetimes."""
import gc
import warnings
import weakref

import numpy as np
import pytest

import halflight
from halflight import _library


def pixels(volume, **words):
    """The picture without a sky, whose cells follow bricks from the first voxel on: flipped volumes have others."""
    words.setdefault("sky", 0)
    return np.asarray(halflight.render(volume, size=(64, 48), **words))


def fine(volume):
    """The picture by sheets so close that it hardly matters at which end of the volume they begin."""
    return pixels(volume, tf=halflight.TransferFunction([(20, 0), (255, 0.2)]), sheet_spacing=0.1)


def held():
    """Bytes that the library holds."""
    return _library.lib.hl_context_memory_held(_library.context)


@pytest.mark.parametrize("kind", ["bool", "u1", "i1", "u2", "i2", "u4", "i4", "u8", "i8", "f2", "f4", "f8"])
def test_types(blob, kind):
    array = (blob > 100) if kind == "bool" else (blob // 2).astype(kind)
    info = halflight.info(array)
    assert info.range == (float(array.min()), float(array.max()))
    assert info.mean == pytest.approx(array.mean(dtype=float), rel=1e-6)


@pytest.mark.parametrize("kind", ["i2", "u2", "u4", "f4", "f8"])
def test_either_byte_order(blob, kind):
    little, big = blob.astype("<" + kind), blob.astype(">" + kind)
    assert np.array_equal(pixels(little), pixels(big))


def test_large_big_endian_arrays_are_said_to_be_copied():
    big = np.zeros((64, 512, 512), ">f4")
    with pytest.warns(halflight.HalflightWarning, match="64 MiB are copied"):
        halflight.Volume(big)


@pytest.mark.parametrize("kind", ["u1", "u2", "f4", "i2"])
@pytest.mark.parametrize("axes", ["zyx", "xyz", "yzx", "xzy", "zxy", "yxz"])
@pytest.mark.parametrize("order", "CF")
def test_orders_of_axes_give_one_picture(blob, kind, axes, order):
    plain = blob.astype(kind)
    turned = np.array(plain.transpose(["zyx".index(letter) for letter in axes]), order=order)
    spacing = [{"x": 1, "y": 1.5, "z": 2}[letter] for letter in axes]
    volume = halflight.Volume(turned, axes=axes, spacing=spacing)
    assert volume.dimensions == (28, 20, 24)
    difference = abs(pixels(volume) - pixels(plain, spacing=(2, 1.5, 1)))
    assert difference.max() < 2e-3  # sums in another order


def test_flips_and_steps(blob):
    assert np.array_equal(pixels(blob[::2, ::2, ::2]), pixels(blob[::2, ::2, ::2].copy()))
    flipped = halflight.Volume(blob[::-1, :, ::-1])
    difference = abs(fine(flipped) - fine(blob[::-1, :, ::-1].copy()))
    assert difference.max() < 2e-3
    assert np.array_equal(pixels(np.broadcast_to(blob[:, :, :1], (24, 20, 9))),
                          pixels(np.broadcast_to(blob[:, :, :1], (24, 20, 9)).copy()))


@pytest.mark.parametrize("shape", [(1, 20, 28), (24, 1, 28), (24, 20, 1), (1, 1, 1)])
def test_thin_arrays(shape):
    array = np.arange(np.prod(shape), dtype=np.float32).reshape(shape)
    info = halflight.info(array[::-1])
    assert info.dimensions == shape[::-1] and info.range == (0, array.max())


def test_packed_arrays_are_not_copied():
    array = np.zeros((64, 64, 64), np.float32)
    array[20:40, 20:40, 20:40] = 1
    for view in (array, array.T, array[::-1], array.transpose(1, 0, 2)[:, ::-1]):
        before = held()
        volume = halflight.Volume(view)
        assert held() - before < 100_000
        del volume
    before = held()
    volume = halflight.Volume(array[:, :, ::2])
    assert held() - before >= array.nbytes // 2
    del volume
    assert held() == before


@pytest.mark.parametrize("kind", ["u1", "u2", "f4"])
def test_boxes_cut_out_of_arrays_are_not_copied(blob, kind):
    whole = np.pad(blob, 9, mode="wrap").astype(kind)
    box = whole[9:-9, 9:-9, 9:-9]
    expected = pixels(blob.astype(kind))
    before = held()
    volume = halflight.Volume(box)
    assert held() - before < 10_000
    assert np.array_equal(pixels(volume), expected)
    for view in (box.T, box[::-1], box[:, ::-1, ::-1], box[::2], box[:, ::3], box[4:5], box[:, 4:5], box[::2, 4:5],
                 np.asfortranarray(whole)[9:-9, 9:-9, 9:-9]):
        before = held()
        volume = halflight.Volume(view)
        assert held() - before < 10_000
        assert abs(fine(volume) - fine(view.copy())).max() < 2e-3  # sums in another order
    exact = halflight.Scene(volume, size=(12, 9), shadows="hard", sky=0)  # the reference takes minutes for a sky
    assert abs(np.asarray(halflight.reference(exact)) - halflight.reference(
        exact.replace([view.copy()]))).max() < 1e-5


def test_read_only_and_memmap(tmp_path, blob):
    np.save(tmp_path / "blob.npy", blob)
    mapped = np.load(tmp_path / "blob.npy", mmap_mode="r")
    assert not mapped.flags.writeable
    before = held()
    volume = halflight.Volume(mapped)
    assert held() - before < blob.nbytes
    assert np.array_equal(pixels(volume), pixels(blob))


def test_an_array_lives_as_long_as_what_reads_it(blob):
    class Array(np.ndarray):
        pass

    array = blob.copy().view(Array)
    gone = weakref.ref(array)
    expected = pixels(blob)
    scene = halflight.Scene(array, size=(64, 48), sky=0)
    renderer = halflight.Renderer()
    del array
    gc.collect()
    assert gone() is not None
    assert np.array_equal(np.asarray(renderer.render(scene)), expected)
    image = renderer.render(scene)
    del scene
    image.scene = None
    gc.collect()
    assert gone() is not None  # the renderer keeps what it prepared
    renderer.render(halflight.Scene(np.ones((4, 4, 4), np.uint8), size=(16, 16)))
    gc.collect()
    assert gone() is None


def test_failed_volumes_keep_nothing(blob):
    before = len(_library._lent)
    with pytest.raises(ValueError):
        halflight.Volume(blob, spacing=0)
    assert len(_library._lent) == before


def test_buffers_and_dlpack(blob):
    class Exchanged:
        def __dlpack__(self, **words):
            return blob.__dlpack__(**words)

        def __dlpack_device__(self):
            return blob.__dlpack_device__()

    class Interface:
        __array_interface__ = blob.__array_interface__

    expected = pixels(blob)
    for source in (memoryview(blob), Exchanged(), Interface()):
        assert np.array_equal(pixels(source), expected)


def test_masked_voxels_are_transparent(blob):
    masked = np.ma.masked_less(blob, 100)
    assert halflight.info(masked).nonfinite_count == (blob < 100).sum()


@pytest.mark.parametrize(("letters", "space", "columns"), [
    ("RAS", "RAS", [(1, 0, 0), (0, 1, 0), (0, 0, 1)]), ("lps", "LPS", [(1, 0, 0), (0, 1, 0), (0, 0, 1)]),
    ("PIR", "RAS", [(0, -1, 0), (0, 0, -1), (1, 0, 0)]), ("SLA", "RAS", [(0, 0, 1), (-1, 0, 0), (0, 1, 0)])])
def test_directions_in_the_body(letters, space, columns, tmp_path):
    """An array and a file of the same voxels lie in the body as three letters say."""
    array = np.arange(24, dtype=np.uint8).reshape(2, 3, 4)
    np.save(tmp_path / "box.npy", array)
    for source in array, tmp_path / "box.npy":
        info = halflight.info(source, spacing=(3, 2, 1), space=letters)
        assert info.space == space and info.spacing.tolist() == [1, 2, 3]
        assert list(map(tuple, info.direction.T.tolist())) == columns
    placed = [halflight.info(array, origin=(7, 8, 9), space=one).origin.tolist() for one in ("LPS", "IRA")]
    assert placed == [[7, 8, 9], [8, 9, -7]]
    for wrong in "RA", "RAR", "RASS", "xyz":
        with pytest.raises(ValueError, match="R or L"):
            halflight.Volume(array, space=wrong)
    pictures = [np.asarray(halflight.render(source, space=letters, slice="sagittal", size=32)) for source in (array, str(tmp_path / "box.npy"))]
    assert np.array_equal(*pictures)


def test_units_are_told(tmp_path):
    halflight.Volume(np.zeros((2, 2, 2), np.uint8)).save(tmp_path / "a.nrrd", unit="um")
    assert halflight.info(tmp_path / "a.nrrd").unit == "micrometre" and halflight.info(np.zeros((2, 2, 2), np.uint8)).unit is None


def test_place():
    array = np.zeros((2, 3, 4), np.uint8)
    info = halflight.info(array, spacing=(3, 2, 1), origin=(7, 8, 9), direction=[[0, -1, 0], [1, 0, 0], [0, 0, 1]])
    assert info.spacing.tolist() == [1, 2, 3] and info.origin.tolist() == [7, 8, 9]
    assert info.direction.tolist() == [[0, -1, 0], [1, 0, 0], [0, 0, 1]]
    info = halflight.info(array.T, axes="xyz", affine=[[0, -2, 0, 7], [1, 0, 0, 8], [0, 0, 3, 9], [0, 0, 0, 1]])
    assert info.dimensions == (4, 3, 2) and info.origin.tolist() == [7, 8, 9]


def test_arrays_of_a_file_come_without_a_word(tmp_path, blob):
    """The file between the library and the array is nobody's business."""
    halflight.Volume(blob).save(tmp_path / "a.nrrd")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert np.array_equal(np.asarray(halflight.Volume(tmp_path / "a.nrrd")), blob)
