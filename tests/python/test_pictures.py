"""Pictures as files, in open files, in NumPy's sums, and sizes."""
import io
import json
import subprocess
import sys

import numpy as np
import pytest

import halflight
from halflight import Renderer, Scene, TransferFunction, Volume


@pytest.fixture
def image(blob):
    """A soft picture, which JPEG keeps well."""
    return Renderer().render(Scene(Volume(blob, transfer_function=TransferFunction([(20, 0), (255, 0.2)])), size=(64, 48)))


@pytest.mark.parametrize("ending, mark", [("jpg", b"\xff\xd8\xff"), ("jpeg", b"\xff\xd8\xff"), ("tif", b"II*\0"), ("pdf", b"%PDF"), ("webp", b"RIFF")])
def test_pillow_writes_more_formats(image, tmp_path, ending, mark):
    Pillow = pytest.importorskip("PIL.Image")
    image.save(tmp_path / f"a.{ending}")
    content = (tmp_path / f"a.{ending}").read_bytes()
    assert content.startswith(mark) and [path.name for path in tmp_path.iterdir()] == [f"a.{ending}"]
    if ending != "pdf":
        shown = np.asarray(Pillow.open(io.BytesIO(content)).convert("RGB")).astype(int)
        assert abs(shown - image.to_srgb8()[..., :3]).max() <= (12 if ending.startswith("jp") else 0)
    image.save(tmp_path / f"b.{ending}", background="white")
    assert (tmp_path / f"b.{ending}").read_bytes() != content


def test_transparent_pictures_keep_their_alpha(image, tmp_path):
    Pillow = pytest.importorskip("PIL.Image")
    image.save(tmp_path / "a.tif", background="transparent")
    assert np.array_equal(np.asarray(Pillow.open(tmp_path / "a.tif")), image.to_srgb8("transparent"))


def test_differences_are_the_programs(program, image, tmp_path):
    """The numbers of `halflight diff --json`, for pictures, arrays, and files of linear light and of sRGB."""
    other = 0.75 * np.asarray(image)
    other[3, 5] += 0.25
    np.save(tmp_path / "b.npy", other.astype(np.float32))
    image.save(tmp_path / "a.npy")
    image.save(tmp_path / "a.png", background="transparent")
    image.save(tmp_path / "b.png", background="transparent", exposure=-1)
    codes = image.to_srgb8("transparent"), image.to_srgb8("transparent", exposure=-1)
    for ending, given in ("npy", (image, other)), ("npy", (tmp_path / "a.npy", tmp_path / "b.npy")), ("png", codes):
        done = subprocess.run([program, "diff", f"a.{ending}", f"b.{ending}", "--json"], cwd=tmp_path, capture_output=True, check=True)
        told, found = json.loads(done.stdout), halflight.diff(*given)
        for word in "rmse", "rmse_channel", "mean_signed", "percentile_99_9", "maximum", "maximum_at", "differing_pixels":
            assert getattr(found, word) == pytest.approx(told[word] if not isinstance(told[word], list) else tuple(told[word]), rel=1e-6, abs=1e-9)
    assert halflight.diff(image, image).rmse == 0
    with pytest.raises(ValueError, match="a is 64x48 and b is 64x24: only pictures of the same size compare"):
        halflight.diff(image, other[:24])
    with pytest.raises(ValueError, match=r"b: the shape \(48, 64\) is not"):
        halflight.diff(image, other[..., 0])
    with pytest.raises(TypeError, match="a: int64 is neither uint8"):
        halflight.diff(np.zeros((4, 4, 3), np.int64), image)
    with pytest.raises(FileNotFoundError):
        halflight.diff(image, tmp_path / "no.png")


def test_open_files(image, tmp_path):
    for word in ("png", "npy"):
        place = io.BytesIO()
        image.save(place, format=word)
        assert place.getvalue() == image.encode(word)
    with open(tmp_path / "named.npy", "wb") as file:
        image.save(file)
    assert np.array_equal(np.load(tmp_path / "named.npy"), np.asarray(image))
    place = io.BytesIO()
    image.save(place, depth=16, background="white")
    assert place.getvalue()[24] == 16  # bits per channel, in the PNG's header
    image.save(tmp_path / "picture.dat", format="png")
    assert (tmp_path / "picture.dat").read_bytes()[:4] == b"\x89PNG"


def test_without_pillow(image, tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "PIL", None)
    with pytest.raises(ImportError, match=r"^\.jpg pictures need Pillow: pip install pillow, or save a \.png$"):
        image.save(tmp_path / "a.jpg")
    assert not list(tmp_path.iterdir())


def test_arithmetic_is_numpy_s(image):
    array = np.asarray(image)
    assert np.array_equal(image - image, np.zeros_like(array)) and np.array_equal(2 * image + 1, 2 * array + 1)
    assert np.array_equal(np.sqrt(image), np.sqrt(array)) and (image > 0.5).dtype == bool
    assert type(image + image) is np.ndarray and np.array_equal(-image, -array) and image == image
    interface = np.asarray(memoryview_of(image))
    assert np.array_equal(interface, array) and np.shares_memory(interface, array)


def memoryview_of(image):
    """What sees the array interface and nothing else."""
    class Holder:
        __array_interface__ = image.__array_interface__
    return Holder()


def test_arrays_of_pictures_keep_no_scene(small):
    import gc
    import weakref

    image = Renderer().render(small)
    gone, array = weakref.ref(image), np.asarray(image)
    expected = array.copy()
    del image
    gc.collect()
    assert gone() is None and np.array_equal(array, expected)


def test_show_opens_a_png(image, monkeypatch):
    shown = []
    monkeypatch.setattr("webbrowser.open", shown.append)
    image.show()
    assert open(shown[0].removeprefix("file://"), "rb").read() == image.encode("png")


@pytest.mark.parametrize("size, expected", [(64, (64, 64)), ("64", (64, 64)), ("64x48", (64, 48)), ("64 x 48", (64, 48)), ([64, 48], (64, 48)),
                                            (np.int64(64), (64, 64)), (np.array([64, 48]), (64, 48))])
def test_sizes(blob, size, expected):
    assert halflight.Scene(blob, size=size).size == expected


def test_renderers_end(small):
    with Renderer() as renderer:
        expected = renderer.render(small)
    assert expected == Renderer().render(small)
    with pytest.raises(ValueError, match="the renderer is closed: make another one"):
        renderer.render(small)
    renderer.close()


def test_names_of_css_without_matplotlib(monkeypatch):
    """The library's names of colours are those of CSS, as the program reads them; matplotlib is not needed for them."""
    for module in ("matplotlib", "matplotlib.colors"):
        monkeypatch.setitem(sys.modules, module, None)
    for name, code in (("skyblue", "#87ceeb"), ("RebeccaPurple", "#663399"), ("green", "#008000"), ("k", "#000000"), ("#f80", "#ff8800")):
        assert halflight.srgb(name) == halflight.srgb(code)
    assert halflight.srgb("#ff8000") == pytest.approx((1, 0.2158605, 0), abs=1e-6)
    for wrong in ("", "0.5", "#12345", "tab:blue"):
        with pytest.raises(ValueError, match="no colour"):
            halflight.srgb(wrong)
