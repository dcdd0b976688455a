"""Stores on web servers by their URLs: the folder's voxels, one line for what a server does wrong, and no server unasked."""
from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import halflight as hl

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "cli"))
import servers  # type: ignore[import-not-found]  # the server of the program's tests

from test_pyramids import write_pyramid  # noqa: E402

pytestmark = pytest.mark.skipif(shutil.which("curl") is None, reason="there is no curl")


@pytest.fixture
def server(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Any]:
    """Serves stores/v2.zarr; copies are kept in the test's folder."""
    servers.write_store(tmp_path / "stores/v2.zarr", 2)
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    monkeypatch.setenv("no_proxy", "127.0.0.1")
    monkeypatch.delenv("http_proxy", raising=False)
    made = servers.Server(tmp_path / "stores")
    yield made
    made.http.shutdown()
    made.http.server_close()


def test_a_url_is_its_folder(server: Any) -> None:
    url, folder = f"{server.url}/v2.zarr", server.folder / "v2.zarr"
    for level in (0, 1, 2):
        assert np.array_equal(hl.Volume(url, level=level), hl.Volume(folder, level=level))
    assert np.array_equal(np.asarray(hl.render(url, size=(32, 32))), np.asarray(hl.render(folder, size=(32, 32))))
    assert (server.folder.parent / "halflight/servers").is_dir()
    server.forget()
    hl.Volume(url, level=0)
    assert server.answers and set(server.answers) <= {304, 404}


@pytest.mark.parametrize("fault, words", [("403", "the server answers 403"), ("page", "a chunk does not unpack"),
                                          ("half", "a chunk does not unpack")])
def test_faults_are_told(server: Any, fault: str, words: str) -> None:
    server.forget(**{"v2.zarr__0__1__1__1": ["always", fault]})
    with pytest.raises((OSError, hl.InputError), match=words) as failed:
        hl.Volume(f"{server.url}/v2.zarr", level=0)
    assert not isinstance(failed.value, FileNotFoundError)


def test_a_chunk_that_is_absent_is_told_to_the_logger(server: Any, caplog: pytest.LogCaptureFixture) -> None:
    """Stores leave out chunks that hold nothing else than the fill value, so that it is no warning."""
    with caplog.at_level("INFO", logger="halflight"):
        hl.Volume(f"{server.url}/v2.zarr", level=0)
        assert "the server has no file for 8 of 64 chunks" in caplog.text
        shutil.rmtree(server.folder.parent / "halflight")
        server.forget(**{"v2.zarr__0__1__1__1": ["always", "404"]})
        hl.Volume(f"{server.url}/v2.zarr", level=0)
    assert "the server has no file for 9 of 64 chunks" in caplog.text


def test_only_what_is_named_is_asked_for(server: Any, tmp_path: Path) -> None:
    scene = tmp_path / "scene.json"
    scene.write_text(json.dumps({"halflight": 1, "volumes": [{"file": f"{server.url}/v2.zarr"}]}))
    with pytest.raises(hl.UnsupportedError, match="a URL in a file"):
        hl.Scene.load(scene)
    assert server.requests == []


def test_copies_need_a_place(server: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("XDG_CACHE_HOME")
    monkeypatch.delenv("HOME")
    with pytest.raises(OSError, match="no place for copies"):
        hl.Volume(f"{server.url}/v2.zarr")
    assert server.requests == []


def test_bytes_of_a_pyramid(server: Any, tmp_path: Path, program: str) -> None:
    """A picture of 512 pixels shows no more than 512^3 voxels of 8192^3: it takes at most 3 times the bytes of these, with no copies."""
    folder = write_pyramid(server.folder / "a.ome.zarr")
    needed = sum(file.stat().st_size for file in (folder / "4").rglob("*") if file.is_file())
    server.forget()
    words = [program, "render", f"{server.url}/a.ome.zarr", "--size", "512x512", "-o", str(tmp_path / "a.npy")]
    done = subprocess.run(words, capture_output=True, text=True, check=True, env=dict(os.environ))
    assert needed < server.sent <= 3 * needed
    assert "the server has no file for 504 of 512 chunks" in done.stderr


@pytest.mark.parametrize("words", [{}, {"channel": "all"}])
def test_of_a_zoomed_picture_a_part_is_fetched(server: Any, tmp_path: Path, program: str, words: dict[str, Any]) -> None:
    """As by the program: the level of the whole picture, and of the finest level the chunks that the camera sees."""
    url, folder = f"{server.url}/v2.zarr", server.folder / "v2.zarr"
    finest, first = (servers.level_bytes(folder, level) for level in (0, 1))
    server.forget()
    image = hl.render(url, camera={"zoom": 8}, size=32, shadows=False, **words)
    assert first < server.sent < first + 3 / 4 * finest
    assert image.scene.volumes[0].dimensions == (64, 64, 64)
    options = [word for name, value in words.items() for word in (f"--{name}", value)]
    subprocess.run([program, "render", str(folder), "--zoom", "8", "--size", "32x32", "--shadows", "off", "--quiet",
                    *options, "-o", str(tmp_path / "a.npy")], check=True)
    assert np.array_equal(np.asarray(image), np.load(tmp_path / "a.npy"))
    again = hl.Scene.from_json(image.scene.to_json().replace(url, str(folder)))
    assert np.allclose(np.asarray(hl.Renderer().render(again)), np.asarray(image), atol=1e-6)


@pytest.mark.parametrize("fault", ["403", "page", "half"])
def test_faults_of_what_a_zoomed_picture_sees_are_told(server: Any, fault: str) -> None:
    """No chunk that is seen is left out, or taken from the coarser level, without a word."""
    picture = {"camera": {"zoom": 8}, "size": 32, "shadows": False}
    server.forget()
    hl.render(f"{server.url}/v2.zarr", **picture)
    seen = next(name for name in server.requests if name.startswith("v2.zarr/0/") and (server.folder / name).exists() and name[-1].isdigit())
    shutil.rmtree(server.folder.parent / "halflight")
    server.forget(**{seen.replace("/", "__"): ["always", fault]})
    with pytest.raises((OSError, hl.InputError)):
        hl.render(f"{server.url}/v2.zarr", **picture)


def test_a_picture_takes_the_level_that_it_shows(server: Any) -> None:
    """As the program does, unless a level is asked for."""
    url = f"{server.url}/v2.zarr"
    assert hl.render(url, size=32).scene.volumes[0].dimensions == (32, 32, 32)
    assert hl.render(url, size=64).scene.volumes[0].dimensions == (64, 64, 64)
    assert hl.render(url, size=32, level=0).scene.volumes[0].dimensions == (64, 64, 64)
    assert hl.Volume(url).dimensions == (64, 64, 64)
