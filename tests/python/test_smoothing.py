"""Slices and maximum projections of noisy scans, which show the voxels of the file."""
import json

import numpy as np
import pytest

import halflight
from halflight import Scene


@pytest.fixture
def cells(tmp_path):
    """Two channels, each a ball whose noise makes its surface grainy."""
    random, places = np.random.default_rng(1), np.indices((24, 24, 24))
    path = tmp_path / "cells.zarr"
    (path / "0").mkdir(parents=True)
    axes = [{"name": name, "type": "channel" if name == "c" else "space"} for name in "czyx"]
    (path / ".zgroup").write_text(json.dumps({"zarr_format": 2}))
    (path / ".zattrs").write_text(json.dumps({"multiscales": [{"version": "0.4", "axes": axes, "datasets": [{"path": "0"}]}]}))
    (path / "0" / ".zarray").write_text(json.dumps({
        "zarr_format": 2, "shape": [2, 24, 24, 24], "chunks": [1, 24, 24, 24], "dtype": "|u1", "compressor": None, "fill_value": 0, "order": "C",
        "filters": None}))
    for channel, at in enumerate((8, 15)):
        distance = np.sqrt((places[2] - at) ** 2 + (places[1] - 11.5) ** 2 + (places[0] - 11.5) ** 2)
        values = np.clip(128 + 40 * (6 - distance), 20, 200) + random.normal(0, 12, distance.shape)
        (path / "0" / f"{channel}.0.0.0").write_bytes(np.clip(values, 0, 235).astype(np.uint8).tobytes())
    return path


@pytest.mark.parametrize("channel", [0, "all"])
@pytest.mark.parametrize("words", [{"slice": "z=0.5"}, {"look": "mip"}])
def test_voxels_of_the_file(cells, channel, words):
    def picture(**more):
        return np.asarray(halflight.render(cells, channel=channel, size=(32, 32), **words, **more))

    assert np.array_equal(picture(), picture(smooth=0))
    assert not np.array_equal(picture(), picture(smooth=0.8))


def test_smoothing_of_channels(cells):
    def smoothing(**words):
        volumes = json.loads(Scene.of_channels(cells, **words).to_json())["volumes"]
        return [volume.get("smooth", 0) for volume in volumes]

    assert smoothing() == [0.8, 0.8]
    assert smoothing(smooth=0) == smoothing(look="mip") == [0, 0]
    assert smoothing(smooth=1.5) == smoothing(smooth=1.5, look="mip") == [1.5, 1.5]
