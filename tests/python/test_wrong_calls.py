"""Wrong calls: each gets its exception and its text, as wrong_calls.txt lists them."""
import pathlib

import numpy as np
import pytest

import halflight

LINES = (pathlib.Path(__file__).parent / "wrong_calls.txt").read_text().splitlines()
CASES = [(LINES[n], LINES[n + 1].strip()) for n in range(0, len(LINES), 2)]
NAMES = {name: getattr(halflight, name) for name in halflight.__all__} | {"np": np}


def test_there_are_many():
    assert len(CASES) >= 40


@pytest.mark.parametrize("call, expected", CASES, ids=[call for call, _ in CASES])
def test_wrong_call(call, expected, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    array = np.zeros((4, 5, 6), np.uint8)
    array[1:3, 1:3, 1:3] = 200
    scene = halflight.Scene(array, size=(8, 8))
    with pytest.raises(Exception) as found:
        eval(call, NAMES | {"a": array, "scene": scene})
    # NumPy's usual integers: of 32 bits on Windows before NumPy 2.
    assert f"{found.type.__name__}: {found.value}" == expected.replace("int64", np.array(0).dtype.name)
    assert not list(tmp_path.iterdir())
