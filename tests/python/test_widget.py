"""The viewer in a notebook, without a notebook: its module, its frames, its scene."""
import contextvars
import io
import json
import queue

import numpy as np
import pytest

import halflight
from halflight import _page, widget

ARRAY = (np.indices((12, 12, 12)).sum(axis=0) % 7 * 36).astype(np.uint8)


def frames_of(scene):
    answers = queue.Queue()
    kept = []
    thread = widget._Frames(widget._Named(scene), "title", lambda content, buffers: answers.put((content, buffers)), kept.append)
    thread.kept = kept
    thread.start()
    return thread, answers


def ask(thread, answers, **message):
    thread.ask({"view": "v", "number": 1, **message})
    return answers.get(timeout=60)


def test_module_is_one_file_that_imports_nothing():
    module = _page.module()
    assert module.count("\nexport ") == 1
    assert "\nimport " not in module
    assert module.endswith("export default { render: $widget.render };\n")
    assert ".halflight-cell" in _page.style()
    # Of what VS Code and Colab may forbid it needs nothing.
    for word in ("fetch(", "XMLHttpRequest", "WebSocket", "Worker(", "eval(", "new Function(", "import("):
        assert word not in module, word


def test_frames_are_those_of_the_scene():
    Image = pytest.importorskip("PIL.Image")
    scene = halflight.Scene(ARRAY, size=(48, 32), shadows="soft")
    thread, answers = frames_of(scene)
    start = json.loads(ask(thread, answers, kind="start")[0]["text"])
    assert start["volumes"][0]["dimensions"] == [12, 12, 12]
    assert start["scene"]["volumes"][0]["file"] == "array 0"
    assert "viridis" in start["colormaps"]
    told, (png,) = ask(thread, answers, kind="frame", number=2, scene=json.dumps(start["scene"]), format="png", depth=8,
                       quality=80)
    assert told["type"] == "image/png"
    image = halflight.Renderer().render(scene)
    assert np.array_equal(np.asarray(Image.open(io.BytesIO(png)).convert("RGBA")), image.to_srgb8())
    thread.asked.put(None)


def test_frames_at_rest_are_kept():
    """What a page without a kernel shows: no moving frame, no small picture, and none that is made for a file."""
    thread, answers = frames_of(halflight.Scene(ARRAY, size=(48, 32)))
    scene = json.dumps(json.loads(ask(thread, answers, kind="start")[0]["text"])["scene"])
    still = {"format": "png", "depth": 8, "quality": 80}
    for number, words in enumerate(({"moving": True}, {"lane": "small"}, {"depth": 16}, {"format": "jpeg"}, {"format": "exr"}), 2):
        ask(thread, answers, kind="frame", number=number, scene=scene, **still | words)
    assert thread.kept == []
    _, (png,) = ask(thread, answers, kind="frame", number=9, scene=scene, **still)
    assert thread.kept == [png]
    thread.asked.put(None)


def test_newer_frames_cancel():
    scene = halflight.Scene(ARRAY, size=(32, 32))
    thread, answers = frames_of(scene)
    thread.newest["v", ""] = 9
    thread.asked.put((contextvars.copy_context(), {"kind": "frame", "view": "v", "number": 8, "scene": "", "format": "png"}))
    told, buffers = answers.get(timeout=60)
    assert "type" not in told and "problem" not in told and buffers == []
    thread.asked.put(None)


def test_moving_frames_are_told_by_differences():
    """From the newest whole scene of the same view; lanes keep none, and a closed view's is forgotten."""
    thread, answers = frames_of(halflight.Scene(ARRAY, size=(48, 32)))
    scene = json.loads(ask(thread, answers, kind="start")[0]["text"])["scene"]

    def frame(number, told, **words):
        answer, buffers = ask(thread, answers, kind="frame", number=number, scene=json.dumps(told), format="png", depth=8, quality=80, **words)
        return buffers[0] if buffers else answer["problem"]

    moved = json.loads(json.dumps(scene))
    moved["camera"]["position"][0] += 5
    moved["lights"] = [{"type": "directional", "direction": [1, 0, 0]}]
    del moved["sky"]
    part = {"in": {"camera": {"in": {"position": {"in": {"0": {"to": moved["camera"]["position"][0]}}}}}, "lights": {"to": moved["lights"]}, "sky": {"gone": 1}}}
    whole = frame(2, scene)
    expected = frame(3, moved, lane="small")
    assert expected != whole and frame(4, part, base=2) == expected
    assert frame(5, {"in": {}}, base=2) == whole  # the base stays as it came
    lost = "the kernel no longer holds the scene that this one differs from: send it whole"
    assert frame(6, part, base=3) == lost and frame(7, part, base=2, view="other") == lost
    for wrong in ({}, 3, {"in": {"camera": {"in": {"position": {"in": {"9": {"to": 1}}}}}}}, {"in": {"nothing": {"gone": 1}}}):
        assert frame(8, wrong, base=2) == "the message is no difference from the scene of its base"
    refused, _ = ask(thread, answers, kind="frame", number=9, scene="{}", base=1, format="png")
    assert refused["no_base"] is True
    ask(thread, answers, kind="leave", number=10)
    assert frame(11, part, base=2) == lost and thread.bases == {}
    thread.asked.put(None)


def test_mistakes_are_answered():
    thread, answers = frames_of(halflight.Scene(ARRAY, size=(32, 32)))
    for text in ("", "{", '{"halflight": 1, "volumes": [{"file": "/etc/passwd"}]}'):
        told, _ = ask(thread, answers, kind="complete", scene=text)
        assert told["problem"]
    thread.asked.put(None)


def test_scene_comes_back_with_its_arrays():
    scene = halflight.Scene(ARRAY, size=(32, 32))
    named = widget._Named(scene)
    text = named.scene.to_json().replace('"width": 32', '"width": 40')
    back = named.restored(text)
    assert back.size == (40, 32)
    assert np.array_equal(halflight.Renderer().render(back.replace(size=(32, 32))), halflight.Renderer().render(scene))
    with pytest.raises(ValueError, match="file"):
        back.to_json()


def test_show_says_what_it_needs(monkeypatch):
    import sys
    monkeypatch.setitem(sys.modules, "anywidget", None)
    monkeypatch.setattr(widget, "_classes", [])
    with pytest.raises(ImportError, match="pip install anywidget"):
        halflight.show(ARRAY)
    with pytest.raises(TypeError, match="did you mean 'shadows'"):
        widget.scene_for(ARRAY, shadow="hard")
