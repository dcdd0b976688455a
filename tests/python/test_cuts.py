"""Cuts of volumes: the keyword `cuts`."""
import numpy as np
import pytest

import halflight
from halflight import Scene, Volume

BLOCK = np.full((8, 8, 8), 200, np.uint8)
PLANE = {"type": "plane", "point": (3.5, 3.5, 3.5), "normal": (1, 0, 0)}


def test_scenes_keep_cuts(tmp_path):
    np.save(tmp_path / "block.npy", BLOCK)
    cuts = [PLANE, {"type": "box", "min": (0, 0, 0), "max": (3, 4, 5), "keep": "inside"},
            {"type": "sphere", "center": (1, 2, 3), "radius": 2}]
    made = Scene(Volume(str(tmp_path / "block.npy"), cuts=cuts, cut_shading="none"), size=(16, 16), cuts=cuts[1])
    read = Scene.from_json(made.to_json())
    look = read.volumes[0].look
    assert read.cuts == [cuts[1]]
    assert look["cuts"] == [{**cuts[0], "keep": "outside"}, cuts[1], {**cuts[2], "keep": "outside"}]
    assert look["cut_shading"] == "none"


def test_cuts_of_a_scene():
    """Of two blocks side by side the scene's plane takes what is right of it, as each block's own in the world does."""
    blocks = [Volume(BLOCK), Volume(BLOCK, translate=(9, 0, 0))]
    plane = {**PLANE, "point": (11, 0, 0)}
    kinds = {"size": (48, 32), "camera": "front", "background": "transparent"}
    scene = Scene(blocks, cuts=plane, **kinds)
    assert scene.cuts == [{**plane, "keep": "outside"}]
    renderer = halflight.Renderer()
    by_scene, whole = (np.asarray(renderer.render(one)) for one in (scene, scene.replace(cuts=[])))
    own = scene.replace([one.replace(cuts={**plane, "world": True}) for one in blocks], cuts=[])
    assert np.array_equal(by_scene, np.asarray(renderer.render(own)))
    assert (by_scene[..., 3] > 0).sum() < 0.9 * (whole[..., 3] > 0).sum()  # the whole leaves the picture


def test_a_plane_takes_half():
    kinds = {"camera": "front", "size": (32, 32), "background": "transparent"}
    whole, half = (np.asarray(halflight.render(BLOCK, cuts=cuts, **kinds)) for cuts in ([], PLANE))
    assert 0 < (half[..., 3] > 0).sum() < (whole[..., 3] > 0).sum() + 1
    assert not np.array_equal(whole, half)


@pytest.mark.parametrize("cut", [{"type": "cone"}, {"type": "plane", "point": (0, 0, 0)}, {**PLANE, "radius": 3}, 3])
def test_wrong_cuts(cut):
    with pytest.raises(TypeError):
        halflight.render(BLOCK, cuts=[cut])
