"""`Scene.to_html`: a scene with its data as one page."""
import base64
import gzip
import json
import re

import numpy as np
import pytest

import halflight as hl

STUB = '<!doctype html><head><title>Halflight</title><script data-part="worker.js"></script></head><body></body>\n'


@pytest.fixture
def viewer_page(tmp_path, monkeypatch):
    (tmp_path / "stub.html").write_text(STUB)
    monkeypatch.setenv("HALFLIGHT_PAGE", str(tmp_path / "stub.html"))


def held_files(page):
    held = re.findall(r'<script type="text/plain" data-file="([^"]*)">([^<]*)</script>', page)
    return {name: gzip.decompress(base64.b64decode(packed, validate=True)) for name, packed in held}


def test_a_page_holds_a_scene_of_arrays(viewer_page, tmp_path):
    voxels = np.zeros((30, 30, 30), np.float32)
    voxels[12:16, 4:9, 20:24] = 180
    pixels = np.full((4, 8, 3), 0.25, np.float32)
    scene = hl.Scene(hl.Volume(voxels, transfer_function=hl.TransferFunction(opacity=[(100, 0), (150, 0.9)])), size=(64, 48), sky={"type": "image", "pixels": pixels})
    page = scene.to_html(tmp_path / "page.html", title="one & two")
    assert (tmp_path / "page.html").read_text() == page and "<title>one &amp; two</title>" in page
    files = held_files(page)
    for name, content in files.items():
        (tmp_path / name).write_bytes(content)
    shown = hl.Scene.load(tmp_path / "scene.json")
    volume, read = shown.volumes[0], json.loads(files["scene.json"])
    assert read["volumes"][0]["file"] == "volume0.nrrd" and shown.size == (64, 48) and shown.camera == scene.camera
    assert np.asarray(volume).dtype == np.uint8 and np.asarray(volume).sum() == voxels.sum()
    assert np.asarray(volume).shape == (4 + 8, 5 + 8, 4 + 8)  # a plane and three voxels on each side
    assert np.array_equal(shown.sky["pixels"], pixels)


def test_the_viewers_page_is_needed(monkeypatch, tmp_path):
    monkeypatch.setenv("HALFLIGHT_PAGE", str(tmp_path / "none.html"))
    with pytest.raises(FileNotFoundError, match="none.html': the viewer's page is not there: make it with scripts/web"):
        hl.Scene(np.ones((8, 8, 8), np.uint8)).to_html()
