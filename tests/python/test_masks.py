"""Label maps over volumes, and looks."""
import json
import subprocess

import numpy as np
import pytest

import halflight
from halflight import Camera, Renderer, Scene, Volume

LOOK = {"size": (32, 32), "lights": [], "ambient": 1,
        "camera": Camera(position=(15.5, 15.5, 200), target=(15.5, 15.5, 15.5), up=(0, 1, 0), height=32)}
EVEN = {"transfer_function": halflight.TransferFunction([(0, 0.05)], (0.2, 0.4, 0.8)), "shading": "flat"}


@pytest.fixture
def halves():
    """Labels 1 where x is small and 2 where it is large."""
    labels = np.ones((32, 32, 32), np.uint8)
    labels[:, :, 16:] = 2
    return labels


def picture(volume):
    return np.asarray(Renderer().render(Scene(volume, **LOOK)))


def test_labels_hide_fade_and_colour(halves):
    even = np.ones((32, 32, 32), np.uint8)
    mask = {"volume": halves, "show": {1: ((0.81, 0.09, 0.25), 0.5)}}
    pixels = picture(Volume(even, mask=mask, **EVEN))
    left, right = pixels[16, 6], pixels[16, 26]
    assert left[3] == pytest.approx(1 - 0.95**16, abs=1e-4)
    assert left[:3] / left[3] == pytest.approx([0.81, 0.09, 0.25], abs=4e-3)
    assert right == pytest.approx([0, 0, 0, 0], abs=1e-6)
    rest = picture(Volume(even, mask=mask | {"rest": 1}, **EVEN))
    assert rest[16, 26, 3] == pytest.approx(1 - 0.95**32, abs=1e-4)


def test_one_label_alone_and_all(halves):
    even = np.ones((32, 32, 32), np.uint8)
    assert picture(Volume(even, mask=halves, **EVEN))[16, [6, 26], 3] == pytest.approx(1 - 0.95**32, abs=1e-4)
    assert np.array_equal(picture(Volume(even, mask={"volume": halves, "show": 2}, **EVEN)),
                          picture(Volume(even, mask={"volume": halves, "show": [2]}, **EVEN)))


def test_label_maps_show_their_labels(program, tmp_path, halves):
    """A label map shows its labels, and its values where settings ask for them, as the program does."""
    halves[:4] = halves[-4:] = halves[:, :4] = halves[:, -4:] = 0
    np.save(tmp_path / "map.npy", halves)
    path = str(tmp_path / "map.npy")
    for settings, options in (({}, []), ({"cmap": "viridis"}, ["--colormap", "viridis"]), ({"look": "surface"}, ["--look", "surface"])):
        subprocess.run([program, "render", path, "--size", "48x48", "--quiet", "--no-metadata", "-o", str(tmp_path / "map.png"), *options], check=True)
        halflight.render(path, size=48, **settings).save(tmp_path / "own.png", metadata=False)
        assert (tmp_path / "own.png").read_bytes() == (tmp_path / "map.png").read_bytes(), options
    assert Volume(path).look["labels"].keys() == {1, 2}
    assert Volume(path, labels=False).look["labels"] is False
    assert "labels" not in Volume(path, iso=1.5).look
    assert "labels" not in Volume(path, look="surface").look


def test_wrong_masks(halves):
    even = np.ones((32, 32, 32), np.uint8)
    for mask, message in (({"show": 1}, "has no volume"), ({"volume": halves, "shown": 1}, "there is no 'shown'"),
                          ({"volume": halves, "show": 7}, "there is no label 7")):
        with pytest.raises((TypeError, ValueError), match=message):
            Scene(Volume(even, mask=mask, **EVEN))


def test_looks_are_the_programs(program, tmp_path):
    z, y, x = np.mgrid[-1:1:24j, -1:1:24j, -1:1:24j]
    np.save(tmp_path / "ball.npy", np.exp(-4 * (x**2 + y**2 + z**2)).astype(np.float32))
    path = str(tmp_path / "ball.npy")
    looked = Volume(path, look="xray").look
    printed = subprocess.run([program, "render", path, "--look", "xray", "--print-scene"], check=True,
                             capture_output=True, text=True).stdout
    assert looked["transfer_function"] == Scene.from_json(printed).volumes[0].look["transfer_function"]
    assert Volume(path).replace(look="xray").look == looked
    assert looked["shading"] == Scene.from_json(printed).volumes[0].look["shading"]


def test_a_maximum_projection_and_a_film_are_the_programs(program, tmp_path):
    z, y, x = np.mgrid[-1:1:24j, -1:1:24j, -1:1:24j]
    np.save(tmp_path / "ball.npy", np.exp(-4 * (x**2 + 2 * y**2 + z**2)).astype(np.float32))
    path = str(tmp_path / "ball.npy")
    for words, asked in (([], {}), (["--background", "white"], {"background": "white"}), (["--view", "left"], {"camera": "left"}),
                         (["--colormap", "red", "--background", "navy"], {"cmap": "red", "background": "navy"}),
                         (["--colormap", "inferno", "--background", "white"], {"cmap": "inferno", "background": "white"}),
                         (["--range", "0.2,0.6", "--colormap", "viridis"], {"clim": (0.2, 0.6), "cmap": "viridis"}),
                         (["--range", "0.2,0.6"], {"clim": (0.2, 0.6)})):
        subprocess.run([program, "render", path, "--look", "mip", *words, "--size", "48x32", "--quiet", "--no-metadata",
                        "-o", str(tmp_path / "ball.png")], check=True)
        halflight.render(path, size=(48, 32), look="mip", **asked).save(tmp_path / "own.png", metadata=False)
        assert (tmp_path / "own.png").read_bytes() == (tmp_path / "ball.png").read_bytes(), words
    subprocess.run([program, "render", path, "--look", "xray", "--background", "white", "--size", "48x32", "--quiet", "--no-metadata",
                    "-o", str(tmp_path / "film.png")], check=True)
    halflight.render(path, size=(48, 32), look="xray", background="white").save(tmp_path / "own.png", metadata=False)
    assert (tmp_path / "own.png").read_bytes() == (tmp_path / "film.png").read_bytes()
    subprocess.run([program, "render", path, path, "--look", "mip", "--size", "48x32", "--quiet", "-o", str(tmp_path / "two.npy")], check=True)
    assert np.array_equal(np.load(tmp_path / "two.npy"), halflight.render([path, path], size=(48, 32), look="mip"))
    Scene(path, size=(48, 32)).save(tmp_path / "ball.json")
    subprocess.run([program, "render", tmp_path / "ball.json", "--look", "mip", "--quiet", "-o", tmp_path / "scene.npy"], check=True)
    assert np.array_equal(np.load(tmp_path / "scene.npy"), halflight.render(tmp_path / "ball.json", look="mip"))
    assert halflight.render(path, size=16, look="mip").scene.settings["compositing"] == "maximum"


def test_a_slice_is_the_programs(program, tmp_path):
    z, y, x = np.mgrid[-1:1:24j, -1:1:24j, -1:1:24j]
    np.save(tmp_path / "ball.npy", np.exp(-4 * (x**2 + 2 * y**2 + z**2)).astype(np.float32))
    path, one = str(tmp_path / "ball.npy"), str(tmp_path / "one.nrrd")
    np.save(tmp_path / "halves.npy", (1 + (x > 0)).astype(np.uint8))
    Volume(path).save(one)
    halves = str(tmp_path / "halves.npy")
    for words, asked in (([], {}), (["--view", "top"], {"camera": "top"}), (["--colormap", "red"], {"cmap": "red"}),
                         (["--colormap", "viridis"], {"cmap": "viridis"}), (["--range", "0.2,0.6"], {"clim": (0.2, 0.6)}),
                         (["--range", "1%,90%", "--colormap", "viridis"], {"clim": ("1%", "90%"), "cmap": "viridis"}),
                         (["--labels", halves], {"labels": halves}), (["--sheet-spacing", "0.25"], {"sheet_spacing": 0.25})):
        subprocess.run([program, "render", path, "--slice", "z=0.4", *words, "--size", "48x32", "--quiet", "--no-metadata",
                        "-o", str(tmp_path / "ball.png")], check=True)
        halflight.render(path, size=(48, 32), slice="z=0.4", **asked).save(tmp_path / "own.png", metadata=False)
        assert (tmp_path / "own.png").read_bytes() == (tmp_path / "ball.png").read_bytes(), words
    subprocess.run([program, "render", path, one, "--slice", "x=0.5", "--size", "48x32", "--quiet", "-o", str(tmp_path / "two.npy")], check=True)
    assert np.array_equal(np.load(tmp_path / "two.npy"), halflight.render([path, one], size=(48, 32), slice="x=0.5"))
    each = np.asarray(halflight.render([path, one], size=(48, 32), slice="x=0.5", cmap=["red", "blue"]))
    assert each[16, 24, 0] > 0.4 and each[16, 24, 2] > 0.4 and each[16, 24, 1] == 0
    for map_of_first, shown, range_of_second in ((None, "hot", (0.3, 0.8)), ("viridis", "hot", (0.2, 0.6)), (None, "hot", None)):
        words = [f"--colormap=one={shown}"] + ([f"--colormap=ball={map_of_first}"] if map_of_first else [])
        words += [f"--range=one={range_of_second[0]},{range_of_second[1]}"] if range_of_second else []
        subprocess.run([program, "render", path, one, "--slice", "x=0.5", *words, "--size", "48x32", "--quiet", "-o", str(tmp_path / "layers.npy")],
                       check=True)
        own = halflight.render([path, one], size=(48, 32), slice="x=0.5", cmap=[map_of_first, shown], clim=[None, range_of_second])
        assert np.abs(np.load(tmp_path / "layers.npy") - own).max() < 1e-6, (map_of_first, range_of_second)  # float32
        legend = json.loads(own.scene.to_json())["volumes"][1].get("legend")
        assert legend == (range_of_second and {"low": range_of_second[0], "high": range_of_second[1]})
    for asked in ({"look": "mip"}, {"iso": 0.5}):
        with pytest.raises(ValueError, match="slice and (look|iso) exclude each other"):
            halflight.render(path, slice="z=0.5", **asked)
    with pytest.raises(ValueError, match="'z=2' is not AXIS=AT"):
        halflight.render(path, slice="z=2")


def test_labels_in_glass_are_the_programs(program, tmp_path):
    z, y, x = np.mgrid[-1:1:24j, -1:1:24j, -1:1:24j]
    away = np.sqrt(x**2 + y**2 + z**2)
    np.save(tmp_path / "head.npy", np.clip(200 + 400 * (0.8 - away), 0, 255).astype(np.uint8))
    np.save(tmp_path / "core.npy", (away < 0.3).astype(np.uint8))
    head, core = str(tmp_path / "head.npy"), str(tmp_path / "core.npy")
    for look in ("translucent", "surface"):
        subprocess.run([program, "render", head, "--labels", core, "--look", look, "--size", "48x32", "--quiet", "-o", str(tmp_path / "own.npy")], check=True)
        assert np.array_equal(np.load(tmp_path / "own.npy"), halflight.render(head, labels=core, look=look, size=(48, 32))), look


def test_density_is_the_programs(program, tmp_path):
    z, y, x = np.mgrid[-1:1:24j, -1:1:24j, -1:1:24j]
    np.save(tmp_path / "ball.npy", np.exp(-4 * (x**2 + 2 * y**2 + z**2)).astype(np.float32))
    path = str(tmp_path / "ball.npy")
    pictures = []
    for density in (None, 3):
        words = [] if density is None else ["--density", str(density)]
        subprocess.run([program, "render", path, "--look", "smoke", *words, "--size", "48x32", "--quiet", "-o", str(tmp_path / "ball.npy.npy")], check=True)
        pictures.append(np.asarray(halflight.render(path, size=(48, 32), look="smoke", density=density)))
        assert np.array_equal(np.load(tmp_path / "ball.npy.npy"), pictures[-1])
    assert pictures[1][16, 24, 3] > pictures[0][16, 24, 3]
    with pytest.raises(ValueError, match="density"):
        halflight.render(path, density=0)


def test_an_unknown_look_lists_those_that_exist(tmp_path):
    np.save(tmp_path / "ball.npy", np.ones((4, 4, 4), np.uint8))
    every = "auto, surface, translucent, xray, smoke, vessels, mip"
    for asked in ({}, {"channel": [0]}):
        with pytest.raises(ValueError, match=f"look: there is no 'quux': use one of {every}"):
            halflight.render(tmp_path / "ball.npy", look="quux", **asked)


def test_a_look_stays_with_other_colours(program, tmp_path):
    z, y, x = np.mgrid[-1:1:24j, -1:1:24j, -1:1:24j]
    np.save(tmp_path / "ball.npy", np.exp(-4 * (x**2 + y**2 + z**2)).astype(np.float32))
    path = str(tmp_path / "ball.npy")
    subprocess.run([program, "render", path, "--look", "translucent", "--colormap", "viridis", "--size", "48x48", "--quiet",
                    "--no-metadata", "-o", str(tmp_path / "ball.png")], check=True)
    halflight.render(path, size=48, look="translucent", cmap="viridis").save(tmp_path / "own.png", metadata=False)
    assert (tmp_path / "own.png").read_bytes() == (tmp_path / "ball.png").read_bytes()


def _place_of(map_given, volume_given, **place):
    """The pictures of a label map, and of a mask, over a volume."""
    return [np.asarray(halflight.render(volume_given, size=48, **{word: map_given}, **place)) for word in ("labels", "mask")]


@pytest.mark.parametrize("place", [
    {"spacing": (2, 1, 0.5)},
    {"origin": (40, -7, 3), "spacing": (3, 1, 1)},
    {"affine": [[0, 2, 0, 5], [-1, 0, 0, 9], [0, 0, 1, 1], [0, 0, 0, 1]]},
    {"spacing": (2, 1, 1), "space": "PIR"},
    {"spacing": (1, 1, 2), "axes": "xyz"},
])
def test_an_array_lies_over_the_volume(place, blob):
    """A label map or mask in an array without a place of its own has the place of the volume's voxels."""
    mask = (blob > 150).astype(np.uint8)
    pictures = _place_of(mask, blob, **place)
    for plain, placed in zip(pictures, _place_of(halflight.Volume(mask, **place), blob, **place), strict=True):
        assert np.array_equal(plain, placed)
    unplaced = _place_of(halflight.Volume(mask), blob, **place)
    assert not np.array_equal(pictures[1], unplaced[1])


def test_an_array_of_another_size_keeps_its_place(blob):
    mask = np.ones((4, 4, 4), np.uint8)
    assert np.array_equal(*(_place_of(one, blob, spacing=(2, 1, 1))[1] for one in (mask, halflight.Volume(mask))))


def test_a_file_lies_over_the_volume(blob, tmp_path):
    """Bare voxels over bare voxels take the spacing and the directions that were stated for the volume; a file that tells its own
    directions keeps them."""
    mask, place = (blob > 150).astype(np.uint8), {"spacing": (2, 1, 0.5), "space": "PIR"}
    names = [str(tmp_path / f"{name}_28x20x24_uint8.raw") for name in ("blob", "mask")]
    blob.tofile(names[0])
    mask.tofile(names[1])
    halflight.Volume(mask, **place).save(told := str(tmp_path / "told.nii"))
    plain, stated, own = (_place_of(one, names[0], **place) for one in (names[1], halflight.Volume(names[1], **place), told))
    for one, other, third in zip(plain, stated, own, strict=True):
        assert np.array_equal(one, other) and np.array_equal(one, third)
