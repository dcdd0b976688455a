"""The program from Python: python -m halflight, animate, view."""
import os
import pathlib
import shutil
import subprocess
import sys
import urllib.request

import numpy as np
import pytest

import halflight


def run(*words, **environment):
    return subprocess.run([sys.executable, "-m", "halflight", *words], capture_output=True, text=True, env=os.environ | environment)


def test_the_package_is_the_program(program, tmp_path, blob):
    np.save(tmp_path / "blob.npy", blob)
    assert run("--version").stdout == f"halflight {halflight.__version__}\n"
    made = run("render", str(tmp_path / "blob.npy"), "--size", "48x32", "--quiet", "-o", str(tmp_path / "a.npy"))
    assert made.returncode == 0 and np.array_equal(np.load(tmp_path / "a.npy"), np.asarray(halflight.render(tmp_path / "blob.npy", size="48x32")))
    wrong = run("rendre")
    assert wrong.returncode == 2 and wrong.stderr == "halflight: unknown command 'rendre': did you mean 'render'?\n"


def test_without_a_program(tmp_path):
    if list((pathlib.Path(halflight.__file__).parent / "bin").glob("halflight-program*")):
        pytest.skip("the package brings its program")
    missing = run("--version", PATH=str(tmp_path), HALFLIGHT_PROGRAM="")
    assert missing.returncode == 1
    assert missing.stderr == "halflight: the program halflight is not installed: install a wheel of the package, or build it by scripts/build\n"


def test_animate(program, small, tmp_path):
    folder = halflight.animate(small, tmp_path / "frames", turntable=2, keys={"lights.0.intensity": {0: 1, 1: 2}})
    assert folder == str(tmp_path / "frames")
    frames = sorted(path for path in (tmp_path / "frames").iterdir() if path.suffix == ".png")
    assert len(frames) == 2 and frames[0].read_bytes() != frames[1].read_bytes()
    # Keywords of render are taken, too, and arrays.
    halflight.animate(np.asarray(small.volumes[0]), tmp_path / "more", turntable=1, size=32, cmap="magma")
    for words, text in (({}, "nothing moves: give turntable= or keys="), ({"keys": {"lights.0.intensity": 3}}, "is no mapping of frames to values")):
        with pytest.raises(TypeError, match=text):
            halflight.animate(small, tmp_path / "none", **words)
    with pytest.raises(RuntimeError, match="lights"):
        halflight.animate(small, tmp_path / "none", keys={"lights.9.intensity": {0: 1, 1: 2}})


def test_films(program, small, tmp_path):
    if shutil.which("ffmpeg") is None:
        pytest.skip("ffmpeg is not installed")
    halflight.animate(small, tmp_path / "turn.mp4", turntable=3, fps=10)
    assert (tmp_path / "turn.mp4").read_bytes()[4:8] == b"ftyp"


def test_view(program, small):
    try:
        viewing = halflight.view(small, browser=False)
    except RuntimeError as problem:
        pytest.skip(str(problem))
    with viewing:
        assert viewing.url.startswith("http://127.0.0.1:")
        assert b"<html" in urllib.request.urlopen(viewing.url, timeout=20).read()
    with pytest.raises(OSError):
        urllib.request.urlopen(viewing.url, timeout=5)
    with pytest.raises(RuntimeError, match="unknown option|--prot"):
        halflight.view(small, browser=False, options=["--prot", "1"])
