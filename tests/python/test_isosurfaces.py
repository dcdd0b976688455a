"""Isosurfaces of volumes."""
import subprocess

import numpy as np
import pytest

import halflight
from halflight import Camera, Renderer, Scene, Volume

LOOK = {"size": (32, 32), "lights": [], "ambient": 1,
        "camera": Camera(position=(10, 10, 90), target=(10, 10, 10), up=(0, 1, 0), height=24)}


@pytest.fixture
def ball():
    """Minus the squared distance from (10, 10, 10): surfaces of one value are spheres."""
    z, y, x = np.mgrid[0:21, 0:21, 0:21].astype(np.float32)
    return -((x - 10) ** 2 + (y - 10) ** 2 + (z - 10) ** 2)


def test_surfaces_have_colour_and_opacity(ball):
    volume = Volume(ball, iso=[(-26, (0, 1, 0)), (-65, (1, 0, 0), 0.25)], specular=0)
    middle = np.asarray(Renderer().render(Scene(volume, **LOOK)))[16, 16]
    assert middle == pytest.approx([0.25, 0.75, 0, 1], abs=1e-5)
    rim = np.asarray(Renderer().render(Scene(volume, **LOOK)))[16, 25]
    assert rim == pytest.approx([1 - 0.75**2, 0, 0, 1 - 0.75**2], abs=1e-5)


def test_one_alone_and_by_words(ball):
    pictures = [np.asarray(Renderer().render(Scene(Volume(ball, iso=iso), **LOOK)))
                for iso in (-26, (-26,), [-26], {"value": -26}, [{"value": -26, "opacity": 1}])]
    assert all(np.array_equal(one, pictures[0]) for one in pictures[1:])
    look = {word: LOOK[word] for word in ("size", "lights", "camera")}
    one = Renderer().render(Scene(Volume(ball, iso=-26), **look))
    assert np.array_equal(np.asarray(halflight.render(ball, iso=-26, **look)), np.asarray(one))


def test_automatic_light_is_for_what_is_seen(program, tmp_path, ball):
    """A white surface of a bare volume is bright and not clipped, though the volume's own look is darker."""
    np.save(tmp_path / "ball.npy", ball)
    subprocess.run([program, "render", "ball.npy", "--iso", "-26:white", "--size", "64x64", "--quiet", "-o", "made.npy"], cwd=tmp_path, check=True)
    made = np.load(tmp_path / "made.npy")
    surface = made[made[:, :, 3] > 0.99][:, :3].max(1)
    assert len(surface) > 500 and np.mean(surface > 1) < 0.01 and np.quantile(surface, 0.99) > 0.7
    assert np.array_equal(np.asarray(halflight.render(str(tmp_path / "ball.npy"), iso=(-26, "white"), size=(64, 64))), made)


def test_scenes_keep_them(program, tmp_path, ball):
    np.save(tmp_path / "ball.npy", ball)
    scene = Scene(Volume(str(tmp_path / "ball.npy"), iso=[(-26, "gold"), (-65, "blue", 0.5)]), size=(24, 24))
    assert [one[0] for one in scene.volumes[0].look["iso"]] == [-26, -65]
    (tmp_path / "scene.json").write_text(scene.to_json())
    subprocess.run([program, "render", tmp_path / "scene.json", "--quiet", "-o", tmp_path / "c.npy"], check=True)
    assert np.array_equal(np.load(tmp_path / "c.npy"), np.asarray(Renderer().render(scene)))
    bare = Scene(scene.volumes[0].replace(iso=[]), size=(24, 24))
    assert not bare.volumes[0].look.get("iso")


@pytest.mark.parametrize(("iso", "message"), [
    ("gold", r"iso\[0\]: 'gold' is no value"), ((1, "goldd"), "goldd"), ([(1, "gold", 2)], "iso/0/opacity: 2 is out of range"),
    ({"valu": 1}, "there is no 'valu'"), ({"color": "gold"}, "has no value"), ((1, 2, 3, 4), "is no value")])
def test_wrong_ones_are_refused(ball, iso, message):
    with pytest.raises((TypeError, ValueError, halflight.InputError), match=message):
        Renderer().render(Scene(Volume(ball, iso=iso), **LOOK))
