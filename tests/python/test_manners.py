"""Ctrl-C, progress, threads, fork, memory."""
import gc
import multiprocessing
import os
import signal
import sys
import threading
import time

import numpy as np
import pytest

import halflight
from halflight import Renderer, Scene, _library


@pytest.fixture(scope="module")
def slow():
    """A scene that takes many seconds."""
    rng = np.random.default_rng(1)
    return Scene(rng.integers(0, 255, (40, 40, 40), np.uint8), size=(400, 400), sheet_spacing=0.02,
                 soft_method="sublights", light_samples=8, shadows="soft")


@pytest.fixture(autouse=True)
def interruptible():
    """SIGINT raises KeyboardInterrupt, even where a shell has started the tests in its background: it ignores the signal there."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


def test_ctrl_c_stops_a_render_and_leaves_the_renderer_usable(slow, small):
    renderer = Renderer()
    expected = np.asarray(Renderer().render(small))
    sent, late = threading.Event(), []

    def interrupt():
        signal.raise_signal(signal.SIGINT)
        sent.set()

    threading.Timer(0.3, interrupt).start()
    with pytest.raises(KeyboardInterrupt):
        renderer.render(slow, progress=lambda *told: late.append(told) if sent.is_set() else None)
    assert len(late) <= 2  # steps of the frame, of which it has hundreds
    assert np.array_equal(np.asarray(renderer.render(small)), expected)


def test_ctrl_c_stops_the_reference(slow):
    threading.Timer(0.2, signal.raise_signal, (signal.SIGINT,)).start()
    with pytest.raises(KeyboardInterrupt):
        halflight.reference(slow)


def test_progress_calls_and_may_stop(slow, small):
    told = []
    Renderer().render(small, progress=lambda stage, fraction: told.append((stage, fraction)))
    assert told and told[-1][1] <= 1 and {stage for stage, _ in told} <= {"prepare", "sky", "render", "load", "write"}
    assert all(isinstance(stage, str) and 0 <= fraction <= 1 for stage, fraction in told)

    class Enough(Exception):
        pass

    def stop(stage, fraction):
        raise Enough(stage)

    with pytest.raises(Enough):
        Renderer().render(slow, progress=stop)


def test_progress_of_labels_that_are_smoothed():
    labels = np.zeros((24, 24, 24), np.uint8)
    labels[4:12, 4:20, 4:20], labels[12:20, 4:20, 4:20] = 1, 2
    scene = Scene(halflight.Volume(labels, labels={1: "red", 2: "lime"}), size=(32, 32))
    told = []
    Renderer().render(scene, progress=lambda stage, fraction: told.append(fraction) if stage == "prepare" else None)
    assert told == sorted(told) and 0 < told[0] < 1 and told[-1] == 1
    again = []
    Renderer().render(scene, progress=lambda stage, _: again.append(stage))
    assert again and "prepare" not in again  # they are kept


def test_progress_of_the_light_of_the_sky(small):
    told, renderer = [], Renderer()
    renderer.render(small.replace(sky=0.5), progress=lambda stage, fraction: told.append((stage, fraction)))
    sky = [fraction for stage, fraction in told if stage == "sky"]
    assert sky == sorted(sky) and sky[0] == 0 and sky[-1] == 1 and len(sky) > 1
    assert [stage for stage, _ in told].index("render") == len(sky)  # it comes before the picture
    again = []
    renderer.render(small.replace(sky=0.5, camera="front"), progress=lambda stage, _: again.append(stage))
    assert again and "sky" not in again  # it is kept


def test_progress_on_stderr(small, capfd, monkeypatch):
    monkeypatch.setitem(__import__("sys").modules, "tqdm.auto", None)
    Renderer().render(small, progress=True)
    assert "%" in capfd.readouterr().err


def test_progress_may_render(small):
    inner = []
    scene = small.replace(size=(16, 16))

    def nested(stage, fraction):
        if not inner:
            inner.append(Renderer().render(scene))

    outer = Renderer().render(small, progress=nested)
    assert np.array_equal(np.asarray(outer), np.asarray(Renderer().render(small))) and len(inner) == 1


def test_the_lock_is_released(slow):
    """Python goes on while the library renders."""

    def count():
        for _ in range(20):
            time.sleep(0.005)
        signal.raise_signal(signal.SIGINT)

    threading.Thread(target=count).start()
    with pytest.raises(KeyboardInterrupt):
        Renderer().render(slow)


def test_renderers_in_threads(small):
    expected = np.asarray(Renderer().render(small))
    results = []

    def work(renderer):
        for _ in range(3):
            results.append(np.asarray(renderer.render(small)))

    shared = Renderer()
    threads = [threading.Thread(target=work, args=(renderer,)) for renderer in (Renderer(), Renderer(), shared, shared)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(results) == 12 and all(np.array_equal(one, expected) for one in results)


@pytest.mark.skipif(not hasattr(os, "fork"), reason="the system has no fork")
def test_fork(small):
    renderer = Renderer()
    expected = np.asarray(renderer.render(small))
    read, write = os.pipe()
    child = os.fork()
    if child == 0:
        same = np.array_equal(np.asarray(renderer.render(small)), expected)
        os.write(write, b"1" if same else b"0")
        os._exit(0)
    os.waitpid(child, 0)
    assert os.read(read, 1) == b"1"
    assert np.array_equal(np.asarray(renderer.render(small)), expected)


def mean_of(angle):
    z, y, x = np.mgrid[-1:1:16j, -1:1:16j, -1:1:16j]
    volume = (255 * np.exp(-5 * (x**2 + y**2 + z**2))).astype(np.uint8)
    return float(np.asarray(halflight.render(volume, size=(32, 32), camera=(angle, 20), threads=1)).mean())


@pytest.mark.parametrize("method", sorted({"fork", "spawn"} & set(multiprocessing.get_all_start_methods())))
def test_multiprocessing(method):
    with multiprocessing.get_context(method).Pool(2) as pool:
        assert pool.map(mean_of, [0, 40]) == [mean_of(0), mean_of(40)]


def test_frames_leave_memory_flat(blob):
    renderer, lent = Renderer(), len(_library._lent)

    def frames(count):
        for n in range(count):
            renderer.render(Scene(blob[n % 2:], size=(32, 32), threads=1))

    frames(2)
    gc.collect()
    before = _library.lib.hl_context_memory_held(_library.context)
    frames(12)
    gc.collect()
    assert _library.lib.hl_context_memory_held(_library.context) <= before + 4096
    assert len(_library._lent) <= lent + 1


def test_warnings_point_at_the_caller(tmp_path):
    np.save(tmp_path / "vectors.npy", np.ones((6, 5, 4, 3), np.float32))
    with pytest.warns(halflight.HalflightWarning) as found:
        halflight.Volume(tmp_path / "vectors.npy")
    assert found[0].filename == __file__


def test_other_messages_go_to_the_logger(tmp_path, caplog):
    np.save(tmp_path / "ball.npy", (np.linalg.norm(np.indices((24, 24, 24)) - 11.5, axis=0) < 9).astype(np.float32))
    halflight.render(tmp_path / "ball.npy", slice="z", size=16)
    assert not caplog.records  # nobody asked for them
    with caplog.at_level("INFO", logger="halflight"):
        halflight.render(tmp_path / "ball.npy", slice="z", size=16)
    assert {record.name for record in caplog.records} == {"halflight"}
    assert "seen from the top" in caplog.text


@pytest.fixture
def large(tmp_path):
    """A file of 5.4 MB of voxels, and an empty scratch folder."""
    k, j, i = np.indices((160, 180, 190), np.uint16)
    path = tmp_path / "large_190x180x160_uint8.raw"
    ((3 * i + 5 * j + 7 * k) % 256).astype(np.uint8).tofile(path)
    (tmp_path / "scratch").mkdir()
    yield path, tmp_path / "scratch"
    halflight.limit_memory(None)


def test_volumes_larger_than_memory_give_the_same_pictures(large):
    path, scratch = large
    whole = np.asarray(halflight.render(path, size=(40, 30)))
    kept = halflight.Volume(np.zeros((140, 140, 140)))
    held = _library.lib.hl_context_memory_held(_library.context)
    assert held >= np.asarray(kept).size
    halflight.limit_memory(held + 5_300_000, scratch_folder=scratch)
    volume = halflight.Volume(path)  # less is left than its voxels alone take
    halflight.limit_memory(600_000_000, scratch_folder=scratch)
    assert np.array_equal(np.asarray(halflight.render(volume, size=(40, 30))), whole)
    assert sys.platform == "win32" or list(scratch.iterdir()) == []  # there a file has its name until it is closed


def test_arrays_larger_than_memory_are_refused(large):
    halflight.limit_memory(5_000_000)
    with pytest.raises(MemoryError):
        halflight.Volume(np.zeros((100, 110, 120), np.int32))


def test_impossible_limits_are_refused(large):
    path, scratch = large
    for limit in (0, -1, 1.5, True, 1 << 64, "4G"):
        with pytest.raises(ValueError, match="is no number of bytes above 0"):
            halflight.limit_memory(limit)
    with pytest.raises(FileNotFoundError, match="there is no folder"):
        halflight.limit_memory(1 << 30, scratch_folder=scratch / "nowhere")
