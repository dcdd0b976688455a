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


def test_light_of_what_is_left(tmp_path):
    """Cuts of a volume or of its scene change all automatic light by one factor; lights that are given stay."""
    distance = np.hypot(np.hypot(*np.mgrid[:20, :20] - 9.5), np.arange(20)[:, None, None] - 9.5)
    ball = Volume(np.clip(100 * (9 - distance), 0, 200).astype(np.uint8))
    plane = {"type": "plane", "point": (9.5, 9.5, 9.5), "normal": (0, -1, 1)}
    whole, own, of_scene = (Scene(*one, camera="front") if len(one) == 1 else Scene(one[0], camera="front", cuts=one[1])
                            for one in ((ball,), (ball.replace(cuts=plane),), (ball, plane)))
    ratio = own.lights[0].intensity / whole.lights[0].intensity
    assert abs(ratio - 1) > 0.01
    for scene in own, of_scene:
        assert [light.intensity for light in scene.lights] == pytest.approx([light.intensity * ratio for light in whole.lights])
    given = Scene(ball.replace(cuts=plane), camera="front", lights=whole.lights)
    assert [light.intensity for light in given.lights] == [light.intensity for light in whole.lights]


@pytest.mark.parametrize("cut", [{"type": "cone"}, {"type": "plane", "point": (0, 0, 0)}, {**PLANE, "radius": 3}, 3])
def test_wrong_cuts(cut):
    with pytest.raises(TypeError):
        halflight.render(BLOCK, cuts=[cut])
