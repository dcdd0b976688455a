"""The viewer's traits with the real anywidget, without a browser: tests/notebook has one."""
import base64
import json
import re
import sys
import types

import numpy as np
import pytest

pytest.importorskip("anywidget")
import halflight  # noqa: E402
from halflight import Camera, Directional  # noqa: E402

ARRAY = (np.indices((12, 12, 12)).sum(axis=0) % 7 * 36).astype(np.uint8)


@pytest.fixture
def viewer():
    made = halflight.show(ARRAY, size=(48, 32), lights=Directional(direction=(0, 1, -1)))
    made.sent = []
    made.send = lambda content, buffers=None: made.sent.append(content)
    yield made
    made.close()


def arrive(viewer, **changes):
    """What a page says when its scene has changed."""
    text = viewer._named.read(viewer._text).replace(**changes).to_json()
    viewer._on_message(None, {"kind": "arrived", "view": "v", "number": 0, "scene": text}, None)


def test_traits_follow_the_page(viewer):
    told = []
    viewer.observe(lambda change: told.append((change["name"], change["new"])), ["camera", "lights"])
    camera = Camera(position=(1.0, -90.0, 5.0), target=(1.0, 2.0, 3.0))
    arrive(viewer, camera=camera)
    assert told == [("camera", camera)] and viewer.camera == camera == viewer.scene.camera and viewer.sent == []
    arrive(viewer, camera=camera, lights=Directional(direction=(0.0, 0.0, -1.0)))
    assert [name for name, _ in told] == ["camera", "lights"] and viewer.lights[0].direction == (0, 0, -1)


def test_traits_lead_the_page(viewer):
    viewer.camera = Camera(position=(0, -90, 5), target=(5, 5, 5), up=(0, 0, 1))
    viewer.lights = [Directional(direction=(1, 0, 0), intensity=2)]
    assert len(viewer.sent) == 2
    shown = json.loads(viewer.sent[-1]["show"])
    assert shown["camera"]["position"] == [0, -90, 5] and shown["lights"][0]["intensity"] == 2 and shown["volumes"][0]["file"] == "array 0"
    assert viewer.scene.camera.target == (5, 5, 5) and np.array_equal(np.asarray(viewer.scene.volumes[0]), ARRAY)
    assert viewer._frames.scene.camera.position == (0, -90, 5)  # what another page begins with
    with pytest.raises(TypeError, match="is no light"):
        viewer.lights = ["sun"]


def test_static_pages(viewer, tmp_path):
    picture = halflight.Renderer().render(viewer.scene)
    assert viewer.picture() == picture
    page = viewer.to_html(tmp_path / "page.html")
    assert (tmp_path / "page.html").read_text() == page and page.count("data:image/png;base64,") == 1 and "<script" not in page
    for word in ("http:", "https:", "src=\"/", "import "):
        assert word not in page
    turn = viewer.to_html(turntable=3)
    frames = json.loads(re.search(r"const frames = (\[.*?\])", turn)[1])
    assert len(frames) == 3 == len(set(frames)) and frames[0] in page
    with pytest.raises(ValueError, match="turntable: -1 is no whole number from 0 to 720"):
        viewer.to_html(turntable=-1)


def test_pages_without_widgets_show_the_picture(viewer):
    bundle = viewer._repr_mimebundle_()
    data = bundle[0] if isinstance(bundle, tuple) else bundle
    assert "application/vnd.jupyter.widget-view+json" in data and data["image/png"].startswith("iVBOR")
    assert viewer.get_state("still")["still"] == base64.b64decode(data["image/png"])  # what an exported notebook's widget shows


def test_frames_at_rest_are_the_state_and_are_not_sent_back(viewer):
    """The page has them already."""
    messages = []
    viewer.comm.send = lambda *content, **words: messages.append(words)
    viewer._frames.keep(b"a picture")
    assert viewer.get_state("still") == {"still": b"a picture"} and not any(words.get("buffers") for words in messages)


def test_colab_is_told_where_the_widgets_code_lies(viewer, monkeypatch):
    installed = types.SimpleNamespace(_installed_url="https://widgets.example")
    monkeypatch.setitem(sys.modules, "google.colab.output", types.SimpleNamespace(enable_custom_widget_manager=lambda: None, _widgets=installed))
    data, metadata = viewer._repr_mimebundle_()
    assert metadata["application/vnd.jupyter.widget-view+json"]["colab"]["custom_widget_manager"] == {"url": "https://widgets.example"}
    assert data["image/png"].startswith("iVBOR")
