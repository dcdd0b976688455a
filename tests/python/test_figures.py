"""Figures: pictures with scale bars, legends and texts, and several on a page."""
import io
import pickle
import re

import numpy as np
import pytest

import halflight


@pytest.fixture(scope="module")
def image():
    ball = np.hypot(np.hypot(*np.mgrid[-1:1:24j, -1:1:24j]), np.linspace(-1, 1, 24)[:, None, None]) < 0.7
    picture = halflight.render(ball, size=(90, 60))
    try:
        picture.annotate().encode()
    except halflight.UnsupportedError as missing:
        pytest.skip(str(missing))
    return picture


def test_a_plain_figure_has_the_picture_s_pixels(image):
    Pillow = pytest.importorskip("PIL.Image")
    for kind in "png", "tif":
        shown = np.asarray(Pillow.open(io.BytesIO(image.annotate().encode(kind))).convert("RGB"))
        assert np.array_equal(shown, image.to_srgb8()[..., :3])


def test_what_is_drawn_changes_pixels(image):
    plain = image.annotate().encode()
    for words in dict(legend=True), dict(axes="arrows"), dict(texts=[("x", (0.5, 0.5))]), dict(letter="a"), \
            dict(scale_bar="5mm", unit="mm", depth="target"), dict(texts={"y": (12, 12, 12)}):
        assert image.annotate(**words).encode() != plain, words


def test_corners_are_asked_for(image):
    Pillow = pytest.importorskip("PIL.Image")
    plain = np.asarray(Pillow.open(io.BytesIO(image.annotate().encode())).convert("RGB"))
    for part, words in ("legend", dict(legend=True)), ("scale_bar", dict(scale_bar="1mm", unit="mm", depth="target")), ("axes", dict(axes="arrows")):
        for corner in "upper left", "upper right", "lower left", "lower right":
            drawn = np.asarray(Pillow.open(io.BytesIO(image.annotate(**words, font_size=3, places={part: corner}).encode())).convert("RGB"))
            rows, columns = np.nonzero((drawn != plain).any(axis=2))
            middle = [(place.min() + place.max()) / 2 / size for place, size in ((rows, plain.shape[0]), (columns, plain.shape[1]))]
            assert [part < 0.5 for part in middle] == [corner.startswith("upper"), corner.endswith("left")], (part, corner, middle)
    with pytest.raises(ValueError, match="did you mean 'legend'"):
        image.annotate(legend=True, places={"legnd": "upper left"}).encode()
    with pytest.raises(ValueError, match="places: legend: there is no 'top'"):
        image.annotate(legend=True, places={"legend": "top"}).encode()


def test_marks_of_a_scene_are_kept_and_drawn(image):
    marks = [{"kind": "ruler", "points": [(2, 2, 2), (20, 2, 2)], "text": "width"}, {"kind": "text", "points": [(12, 12, 12)], "text": "café"}]
    scene = image.scene.replace(marks=marks)
    text = '{"halflight": 1, "volumes": [{"shapes": [{"type": "sphere", "radius": 8}], "voxel_size": 1}]}'
    of_file = halflight.Scene.from_json(text).replace(marks=marks)
    assert scene.marks == marks == of_file.marks == halflight.Scene.from_json(of_file.to_json()).marks
    assert pickle.loads(pickle.dumps(scene)).marks == marks and scene.replace(size=(80, 60)).marks == marks
    marked = halflight.Renderer().render(scene)
    assert np.array_equal(np.asarray(marked), np.asarray(image))
    assert marked.annotate(marks=True).encode() != marked.annotate().encode() == image.annotate().encode()
    with pytest.raises(ValueError, match="none"):
        image.annotate(marks=True).encode()
    with pytest.raises(TypeError, match=r"marks\[0\]"):
        image.scene.replace(marks=[{"kind": "circle", "points": [(1, 2, 3)]}])
    with pytest.raises(ValueError, match="/marks/0/points"):
        image.scene.replace(marks=[{"kind": "angle", "points": [(1, 2, 3)]}])


def test_sizes_are_stated(image, tmp_path):
    Pillow = pytest.importorskip("PIL.Image")
    image.annotate(legend="D", width="2in").save(tmp_path / "a.png")
    assert Pillow.open(tmp_path / "a.png").info["dpi"][0] == pytest.approx(45, abs=0.02)
    assert "dpi" not in Pillow.open(io.BytesIO(image.annotate(legend="D").encode())).info
    page = halflight.figure([image, image.annotate(legend="D"), image], columns=2, width="50mm", gap=2, dpi=254).encode()
    assert Pillow.open(io.BytesIO(page)).size == (500, 340)


def test_vectors(image):
    svg = image.annotate(scale_bar=True, unit="kpc", depth="target").encode("svg").decode()
    assert svg.startswith("<?xml") and "<use" in svg
    pdf = halflight.figure([image, image], width="89mm").encode("pdf")
    assert pdf.startswith(b"%PDF") and re.search(rb"/MediaBox \[ 0 0 252\.28", pdf)


def test_units_are_not_invented(image):
    with pytest.raises(ValueError, match="perspective"):
        image.annotate(scale_bar=True, unit="mm").encode()
    with pytest.raises(ValueError, match="unit"):
        image.annotate(scale_bar=True, depth="target").encode()
    with pytest.raises(ValueError, match="body"):
        image.annotate(axes="letters").encode()


def test_wrong_words(image, tmp_path):
    with pytest.raises(ValueError, match="arrows"):
        image.annotate(axes="arows").encode()
    with pytest.raises(ValueError, match="89mm"):
        image.annotate(width="89 furlongs")
    with pytest.raises(ValueError, match="at least one"):
        halflight.figure([])
    with pytest.raises(ValueError, match="no panel"):
        halflight.figure([halflight.figure([image, image])])
    with pytest.raises(halflight.UnsupportedError, match=r"\.pdf, \.svg"):
        image.annotate().save(tmp_path / "a.doc")
    assert not list(tmp_path.iterdir())
