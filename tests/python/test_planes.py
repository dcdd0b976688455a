"""Transfer functions of two numbers."""
import json
import subprocess

import numpy as np
import pytest

import halflight
from halflight import Camera, Renderer, Scene, TransferFunction, Volume

LOOK = {"size": (32, 32), "lights": [], "ambient": 1,
        "camera": Camera(position=(15.5, 15.5, 200), target=(15.5, 15.5, 15.5), up=(0, 1, 0), height=32)}
HOLDS = {"value": (30, 63), "second": (2, 4), "color": (0.9, 0.2, 0.1), "opacity": 0.05}
MISSES = {"value": (0, 255), "second": (5, 20), "opacity": 0.9}


@pytest.fixture
def ramp():
    """Three a voxel along x."""
    return np.broadcast_to(3 * np.arange(32, dtype=np.uint8), (32, 32, 32)).copy()


def picture(*volumes):
    return np.asarray(Renderer().render(Scene(list(volumes), **LOOK)))


def test_boxes_by_the_gradient(ramp):
    pixels = picture(Volume(ramp, transfer_function=TransferFunction(second="gradient", boxes=[HOLDS, MISSES]), shading="flat"))
    assert pixels[16, 15] == pytest.approx([*((1 - 0.95**32) * np.array([0.9, 0.2, 0.1])), 1 - 0.95**32], abs=1e-3)
    assert pixels[16, [5, 26], 3] == pytest.approx(0, abs=1e-6)


def test_another_volume_and_an_image(ramp):
    other = np.zeros((32, 32, 32), np.uint8)
    other[:, 16:] = 100
    table = np.zeros((2, 1, 4), np.float32)
    table[0] = (0, 0.04, 0, 0.05)  # at the top: the greater second numbers
    function = TransferFunction(second={"volume": "mask"},
                                image={"pixels": table, "value": (-1, 256), "second": (0, 100.5)})
    pixels = picture(Volume(ramp, transfer_function=function, shading="flat"),
                     Volume(other, name="mask", visible=False, casts_shadow=False))
    assert pixels[6, 16, 3] == pytest.approx(1 - 0.95**32, abs=1e-3)
    assert pixels[6, 16, 1] == pytest.approx(0.8 * (1 - 0.95**32), abs=1e-3)
    assert pixels[26, 16, 3] == pytest.approx(0, abs=1e-6)


def test_curves_of_another_volume(ramp):
    """The opacity is that of the value, and the colour that of the other volume, which rises along y."""
    other = np.broadcast_to(np.arange(32, dtype=np.uint8)[:, None], (32, 32, 32)).copy()
    curves = {"opacity": [(30, 0), (60, 0.05)], "color": [(8, 1, 0, 0), (24, 0, 0.5, 1)]}
    function = TransferFunction(second={"volume": "other"}, curves=curves)
    hidden = Volume(other, name="other", visible=False, casts_shadow=False)
    pixels = picture(Volume(ramp, transfer_function=function, shading="flat"), hidden)
    alone = picture(Volume(ramp, transfer_function=TransferFunction(curves["opacity"]), shading="flat"))
    assert pixels[..., 3] == pytest.approx(alone[..., 3], abs=1e-3)
    assert pixels[16, 26, 3] == pytest.approx(1 - 0.95**32, abs=1e-3)
    for row in range(2, 30):
        t = np.clip((31 - row - 8) / 16, 0, 1)  # the picture's first row is the greatest y
        color = pixels[row, 26, :3] / pixels[row, 26, 3]
        assert color == pytest.approx([1 - t, 0.5 * t, t], abs=0.02)


def test_matter_keeps_its_own_color(ramp):
    """Where the other volume's values lie between two numbers, the colour follows from the own value."""
    other = np.broadcast_to(np.arange(32, dtype=np.uint8)[:, None], (32, 32, 32)).copy()
    curves = {"opacity": [(30, 0), (60, 0.05)], "color": [(0, 1, 0, 0)], "own_color": [(0, 0, 0, 1)], "own_between": (10, 20)}
    function = TransferFunction(second={"volume": "other"}, curves=curves)
    pixels = picture(Volume(ramp, transfer_function=function, shading="flat"),
                     Volume(other, name="other", visible=False, casts_shadow=False))
    for row in (3, 8, 13, 16, 19, 24, 28):
        own = 10 < 31 - row < 20
        assert pixels[row, 26, :3] / pixels[row, 26, 3] == pytest.approx([1 - own, 0, int(own)], abs=1e-3)


def test_functions_come_back(ramp, tmp_path, program):
    cone = {"vertices": [(10, 1), (50, 1), (30, 6)], "color": "red", "falloff": 0.5}
    function = TransferFunction(second="gradient", boxes=[HOLDS, {**MISSES, "edge": (3, 1)}], polygons=[cone],
                                unit_distance=2, gradient_opacity=[(0, 0), (1, 1)])
    np.save(tmp_path / "ramp.npy", ramp)
    scene = Scene(Volume(str(tmp_path / "ramp.npy"), transfer_function=function, shading="flat"), **LOOK)
    assert halflight.volume.volume_from(scene._handle, 0).look["transfer_function"] == function
    assert Scene.from_json(scene.to_json()).volumes[0].look["transfer_function"] == function
    assert "opacity" not in json.loads(scene.to_json())["volumes"][0]["transfer_function"]
    assert repr(function) == repr(eval(repr(function)))  # noqa: S307
    curves = TransferFunction(second={"volume": "b"}, curves={"opacity": [(0, 0), (9, 0.5)], "color": [(1, 0, 1, 0)], "own_color": [(2, 1, 0, 0)], "own_between": (-1, 3)})
    both = Scene([Volume(str(tmp_path / "ramp.npy"), transfer_function=curves, shading="flat"),
                  Volume(str(tmp_path / "ramp.npy"), name="b", transfer_function=TransferFunction([(0, 0.1)]), visible=False)],
                 **LOOK)
    assert Scene.from_json(both.to_json()).volumes[0].look["transfer_function"] == curves
    assert repr(curves) == repr(eval(repr(curves)))  # noqa: S307
    # The program reads it from a file of its own, and from the scene.
    (tmp_path / "tf.json").write_text(json.dumps(json.loads(scene.to_json())["volumes"][0]["transfer_function"]))
    (tmp_path / "scene.json").write_text(scene.to_json())
    for source in (["scene.json"], ["scene.json", "--tf", "tf.json"]):
        subprocess.run([program, "render", *source, "--quiet", "-o", "a.npy"], check=True, cwd=tmp_path)
        assert np.array_equal(np.load(tmp_path / "a.npy"), np.asarray(Renderer().render(scene)))
    failed = subprocess.run([program, "render", "scene.json", "--colormap", "hot", "-o", "b.png"], check=False,
                            capture_output=True, text=True, cwd=tmp_path)
    assert failed.returncode == 2 and "functions of the value alone" in failed.stderr


def test_wrong_functions():
    for given, message in (({"boxes": [HOLDS]}, "need second"), ({"second": "slope"}, "neither"),
                           ({"second": "gradient", "boxes": [{"value": (0, 1)}]}, "has no second"),
                           ({"second": "gradient", "boxes": [{**HOLDS, "soft": 1}]}, "there is no 'soft'"),
                           ({"second": "gradient", "polygons": [{"vertices": [(0, 0), (1, 1)]}]}, "fewer than three"),
                           ({"second": "gradient", "image": {"pixels": np.zeros((2, 2)), "value": (0, 1), "second": (0, 1)}},
                            "not \\(height, width, 4\\)"),
                           ({"second": {"volume": "b"}, "curves": {"color": [(0, 1, 1, 1)]}}, "has no opacity"),
                           ({"opacity": [(0, 1)], "second": "gradient", "boxes": [HOLDS]}, "exclude each other")):
        with pytest.raises((TypeError, ValueError), match=message):
            TransferFunction(**given)


def test_color_by_is_the_program_s(tmp_path, program):
    """Keywords that give a volume the colours of another one make the program's picture."""
    z, y, x = np.mgrid[0:16, 0:16, 0:16]
    np.save(tmp_path / "ball.npy", (255 * np.clip(1 - np.sqrt((x - 7.5)**2 + (y - 7.5)**2 + (z - 7.5)**2) / 8, 0, 1)).astype(np.uint8))
    np.save(tmp_path / "heat.npy", (10 * x).astype(np.uint8))
    options = ["--color-by", "heat.npy:inferno:20,150", "--color-by-threshold", "60,100", "--size", "32", "--quiet"]
    subprocess.run([program, "render", "ball.npy", *options, "-o", "a.npy"], check=True, cwd=tmp_path)
    picture = halflight.render(tmp_path / "ball.npy", color_by=f"{tmp_path}/heat.npy:inferno:20,150", color_by_threshold=(60, 100), size=32)
    assert np.array_equal(np.load(tmp_path / "a.npy"), np.asarray(picture))
    with pytest.raises(TypeError, match="color_by"):
        halflight.render(tmp_path / "ball.npy", color_by=7, size=8)


def test_colored_isosurfaces_come_back(tmp_path, program):
    """A scene keeps the isosurfaces that have another volume's colours."""
    z, y, x = np.mgrid[0:16, 0:16, 0:16]
    np.save(tmp_path / "ball.npy", (255 * np.clip(1 - np.sqrt((x - 7.5)**2 + (y - 7.5)**2 + (z - 7.5)**2) / 8, 0, 1)).astype(np.uint8))
    np.save(tmp_path / "heat.npy", (10 * x).astype(np.uint8))
    options = ["--iso", "90", "--color-by", "heat.npy:inferno", "--size", "24", "--print-scene"]
    made = subprocess.run([program, "render", "ball.npy", *options], check=True, cwd=tmp_path, capture_output=True)
    (tmp_path / "a.json").write_bytes(made.stdout)
    scene = Scene.load(tmp_path / "a.json")
    again = Scene(list(scene.volumes), camera=scene.camera, lights=list(scene.lights), size=scene.size)
    assert again.volumes[0].look["iso"] == scene.volumes[0].look["iso"]
    assert scene.volumes[0].look["iso"][0]["second_color"] is True
