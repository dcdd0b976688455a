"""Scenes, lights, cameras, transfer functions, images."""
import copy
import dataclasses
import io
import json
import pickle
import subprocess
import sys

import numpy as np
import pytest

import halflight
from halflight import (Camera, Directional, Disk, Image, Point, Polygon, Rect, Renderer, Scene, Spot, TransferFunction,
                       Volume, _library, _settings)

LIGHTS = [
    Directional(direction=(0, 1, -1), angular_diameter_deg=3, color=(1, 0.5, 0.25), intensity=2, shadows="hard"),
    Point(position=(1, 2, 30), radius=2, falloff="inverse_square"),
    Spot(position=(1, 2, 30), direction=(0, 0, -2), opening_angle_deg=50, falloff_angle_deg=4, radius=1),
    Rect(position=(0, 0, 40), edge1=(2, 0, 0), edge2=(0, 3, 0), shadows="off"),
    Disk(position=(0, 0, 40), normal=(0, 0, -1), radius=3, frame="camera"),
    Polygon(vertices=((0, 0, 40), (5, 0, 40), (0, 5, 40))),
]


def plain(light):
    values = {field.name: getattr(light, field.name) for field in dataclasses.fields(light)}
    return type(light), {name: np.asarray(value).tolist() for name, value in values.items()}


@pytest.mark.parametrize("light", LIGHTS, ids=lambda light: type(light).__name__)
def test_lights_come_back_from_the_scene(blob, light):
    assert plain(Scene(blob, lights=light).lights[0]) == plain(light)


def test_lights_have_images(program, tmp_path, blob):
    slide = np.zeros((4, 6, 3), np.float32)
    slide[:, 3:] = (1, 0.5, 0.25)
    png = (255 * slide).astype(np.uint8)
    np.save(tmp_path / "slide.npy", slide)
    np.save(tmp_path / "blob.npy", blob)
    texture = halflight.Texture(slide, center=(10, 10, 60), right=(20, 0, 0), up=(0, 20, 0))
    light = Point(position=(10, 10, 120), texture=texture)
    white = TransferFunction([(20, 0), (255, 0.9)])  # of the colours that the look of a field has, each sends another part of the light
    scene = Scene(Volume(tmp_path / "blob.npy", transfer_function=white), size=(64, 48), lights=light, ambient=0)
    picture = np.asarray(Renderer().render(scene))
    assert picture[..., 0].max() > 0.05 and np.allclose(picture[..., 2], picture[..., 0] / 4, atol=0.2 * picture[..., 0].max())
    again = scene.lights[0]
    assert again.texture == texture and np.array_equal(again.texture.image, slide)
    assert np.array_equal(np.asarray(Renderer().render(scene.replace(lights=again))), picture)
    named = dataclasses.replace(texture, image=tmp_path / "slide.npy")
    filed = scene.replace(lights=dataclasses.replace(light, texture=named))
    assert np.array_equal(np.asarray(Renderer().render(filed)), picture)
    (tmp_path / "scene.json").write_text(filed.to_json())
    subprocess.run([program, "render", tmp_path / "scene.json", "--quiet", "-o", tmp_path / "c.npy"], check=True)
    assert np.array_equal(np.load(tmp_path / "c.npy"), picture)
    window = Rect(position=(10, 10, 60), edge1=(30, 0, 0), edge2=(0, 30, 0), emission=halflight.EmissionImage(png))
    shown = scene.replace(lights=window).lights[0].emission
    assert shown.image.shape == (4, 6, 3) and shown.image[0, 5, 1] == pytest.approx(0.2122, abs=1e-3)  # sRGB 127


@pytest.mark.parametrize("light", LIGHTS, ids=lambda light: type(light).__name__)
def test_defaults_are_the_library_s(light):
    """Each default of a dataclass is the table's."""
    rows = _settings.table(_library.lib.HL_SETTINGS_LIGHT)
    standard = {"texture": None, "emission": None, "shadows": None, "falloff": "none", "frame": "world", "vertices": ()}
    for field in dataclasses.fields(light):
        if field.name.startswith("_"):
            continue
        expected = standard.get(field.name, ()) if field.name in standard else rows[field.name].standard
        actual = field.default
        if isinstance(actual, float):
            expected = expected[0]
        assert actual == expected, field.name


def test_every_setting_has_its_keyword():
    """Rows of the library's tables: of lights here, the others are written by scripts/settings."""
    table = _settings.table
    lights = {field.name for light in LIGHTS for field in dataclasses.fields(light)}
    assert set(table(_library.lib.HL_SETTINGS_LIGHT)) - {"type"} == lights - {"texture", "emission", "vertices"}
    assert set(table(_library.lib.HL_SETTINGS_CAMERA)) - {"type"} == {field.name for field in dataclasses.fields(Camera)}
    look, settings = halflight.volume.Look.__annotations__, halflight.scene.Settings.__annotations__
    assert set(table(_library.lib.HL_SETTINGS_VOLUME)) - {"clip_min", "clip_max"} <= set(look)
    assert set(table(_library.lib.HL_SETTINGS_MATERIAL)) <= set(look)
    assert set(table(_library.lib.HL_SETTINGS_RENDER)) <= set(settings)


def test_info_is_the_program_s(program, tmp_path, blob):
    np.save(tmp_path / "blob.npy", np.stack([blob, blob + 1], axis=-1))
    said = json.loads(subprocess.run([program, "info", tmp_path / "blob.npy", "--json"], check=True, capture_output=True).stdout)
    with pytest.warns(halflight.HalflightWarning):
        found = dataclasses.asdict(halflight.info(tmp_path / "blob.npy"))
    for name, value in found.items():
        expected = said.get(name)
        if name == "arrays":
            assert [dict(one) for one in value] == expected
        elif name in ("series", "segments", "channel_list"):
            assert list(value) == (expected or [])
        else:
            assert np.asarray(value).tolist() == expected, name


def test_cameras_come_back(blob):
    for camera in (Camera(position=(0, -90, 5), target=(1, 2, 3), fovy_deg=20),
                   Camera(position=(0, -90, 5), target=(1, 2, 3), up=(0, 1, 1), height=40)):
        found = Scene(blob, camera=camera).camera
        assert tuple(found.position) == tuple(camera.position) and found.height == camera.height
        assert tuple(found.up) == tuple(camera.up) and tuple(found.target) == tuple(camera.target)


def test_json_is_the_program_s_file(program, tmp_path, blob):
    np.save(tmp_path / "blob.npy", blob)
    scene = Scene(str(tmp_path / "blob.npy"), size=(64, 48), shadows="hard", lights=LIGHTS[:2], background="navy")
    text = scene.to_json()
    (tmp_path / "scene.json").write_text(text)
    again = Scene.from_json(text)
    assert again.to_json() == text and json.loads(text)["halflight"] == 1
    picture = np.asarray(Renderer().render(scene))
    assert np.array_equal(picture, np.asarray(Renderer().render(again)))
    assert np.array_equal(picture, np.asarray(Renderer().render(Scene.load(tmp_path / "scene.json"))))
    subprocess.run([program, "render", tmp_path / "scene.json", "--quiet", "-o", tmp_path / "c.npy"], check=True)
    assert np.array_equal(np.load(tmp_path / "c.npy"), picture)


def test_volume_looks_come_back(blob):
    look = {"name": "ball", "shading": "none", "ambient": 0.5, "diffuse": 0.25, "specular": 0.125, "shininess": 7.0,
            "emission": 0.5, "attenuation_color": (1.0, 0.5, 0.25), "anisotropy": 0.5,
            "albedo": (0.875, 0.75, 0.5), "multiple_scattering": True, "visible": False, "casts_shadow": False,
            "receives_shadow": False, "clip": ((1.0, 2.0, 3.0), (9.0, 8.0, 7.0)), "scale": (2.0, 1.0, 1.0),
            "rotate_axis": (0.0, 1.0, 0.0), "rotate_angle_deg": 30.0, "translate": (5.0, 6.0, 7.0),
            "cuts": [{"type": "sphere", "center": (3.0, 2.0, 1.0), "radius": 1.5, "keep": "inside"}],
            "cut_shading": "gradient", "cut_casts_shadow": True, "scraps_faint": 10.0, "scraps_firm": 20.0, "scraps_least": 0.25, "legend_low": 2.0, "legend_high": 6.0,
            "transfer_function": TransferFunction([(0, 0), (50, 0.5)], color=[(0, 1, 0, 0), (9, 0, 1, 0)],
                                                  unit_distance=2)}
    scene = Scene([Volume(blob), Volume(blob, **look)], size=(32, 32))
    # Through the library and back, for a volume that knows nothing but the scene.
    found = halflight.volume.volume_from(scene._handle, 1)
    assert found.look == look
    assert found.replace(visible=True).look["visible"] is True


def test_a_replaced_scene_changes_only_what_is_named(small):
    other = small.replace(size=(32, 24), exposure=1, tone="filmic")
    assert other.size == (32, 24) and other.exposure == 1 and other.tone == "filmic" and small.tone == "clip" and small.size == (64, 48)
    assert other.camera == small.camera and [plain(one) for one in other.lights] == [plain(one) for one in small.lights]
    assert small.replace(shadows="off").settings["shadows"] == "off"
    assert small.replace(background="transparent").background == "transparent"


def test_several_volumes_are_framed_together(blob):
    one, two = Volume(blob), Volume(blob, origin=(60, 0, 0))
    target = Scene([one, two], size=(64, 48)).camera.target
    assert 30 < target[0] < 60


def test_sheets_of_several_volumes_are_as_close_as_the_closest():
    array = np.zeros((16, 16, 16), np.uint8)
    array[4:12, 4:12, 4:12] = np.linspace(150, 200, 8)
    fine, coarse = Volume(np.kron(array, np.ones((4, 4, 4), np.uint8)), spacing=0.5), Volume(array, spacing=2)
    alone = [Scene(one).settings["sheet_spacing"] for one in (fine, coarse)]
    together = Scene([coarse, fine]).settings["sheet_spacing"]
    assert alone[0] != alone[1]
    assert together == pytest.approx(min(alone[0] * 0.5, alone[1] * 2) / 0.5, abs=1e-6)


def test_images(tmp_path, small):
    image = Renderer().render(small)
    array = np.asarray(image)
    assert array.dtype == np.float32 and array.shape == (48, 64, 4) == image.shape
    assert np.asarray(image) is array or np.shares_memory(np.asarray(image), array)
    assert np.array(image, dtype=np.float64).dtype == np.float64
    for name in ("a.png", "a.npy"):
        image.save(tmp_path / name)
    assert np.array_equal(np.load(tmp_path / "a.npy"), array)
    assert image.encode("npy") == (tmp_path / "a.npy").read_bytes()
    assert image._repr_png_() == (tmp_path / "a.png").read_bytes()
    Image_ = pytest.importorskip("PIL.Image")
    shown = np.asarray(Image_.open(io.BytesIO(image._repr_png_())).convert("RGBA"))
    assert np.array_equal(shown, image.to_srgb8())
    assert image.to_srgb8("transparent")[0, 0, 3] == 0
    assert image.statistics["sheets"] > 0 and image.statistics["voxels_total"] == 24 * 20 * 28


def test_images_are_saved_as_openexr(tmp_path, small, has_openexr):
    image = Renderer().render(small)
    image.save(tmp_path / "a.exr")
    place = io.BytesIO()
    image.save(place, format="exr")
    assert image.encode("exr") == (tmp_path / "a.exr").read_bytes() == place.getvalue()
    layered = Renderer().render(small, layers=True)
    assert copy.deepcopy(layered).encode("exr") == layered.encode("exr")


def test_pixels_outlive_their_image(small):
    array = np.asarray(Renderer().render(small))
    expected = array.copy()
    others = [Renderer().render(small.replace(background=0.1 * n, camera=(n, 10))) for n in range(5)]
    assert len(others) == 5 and np.array_equal(array, expected)


def test_layers_sum_to_the_picture(small):
    image = Renderer().render(small, layers=True)
    layers = image.layers
    total = layers["ambient"] + sum(layers[f"light{n}"] for n in range(len(small.lights))) + layers["sky"]
    assert np.allclose(total, np.asarray(image)[..., :3], atol=1e-5)
    assert layers["depth_first"].shape == (48, 64) and layers["normal"].shape == (48, 64, 3)
    assert set(np.unique(layers["object"])) == {0, 1}
    with pytest.raises(TypeError):
        layers["ambient2"] = 1
    assert image.encode("png")[:4] == b"\x89PNG"


def test_the_sky_s_layers(small):
    image = Renderer().render(small.replace(sky=0.5), layers=True)
    layers = image.layers
    total = layers["ambient"] + layers["sky"] + sum(layers[f"light{n}"] for n in range(len(small.lights)))
    assert np.allclose(total, np.asarray(image)[..., :3], atol=1e-5)
    assert layers["sky"].max() > 0.05 and 0.1 < layers["sky_shadow"].max() <= 1


def test_without_shadows_light_is_constant():
    array = np.ones((8, 8, 8), np.uint8)
    beside_sky = Scene(array).ambient[0]
    assert 0 < beside_sky < 0.1 < Scene(array, shadows="off").ambient[0]
    assert Scene(array, shadows="off", sky=0.5).ambient[0] == Scene(array, shadows="hard").ambient[0] == beside_sky


def test_the_reference_agrees(blob):
    volume = Volume(blob, transfer_function=TransferFunction([(20, 0), (255, 0.2)]))
    scene = Scene(volume, shadows="hard", sky=0, size=(32, 24))  # the reference takes minutes for a sky
    exact = halflight.reference(scene)
    assert abs(np.asarray(exact) - Renderer().render(scene)).max() < 0.005


def test_lists():
    assert "viridis" in halflight.colormaps() and "mip" in halflight.presets()
    assert halflight.__version__ == "0.1.0"


def test_plot(small):
    pyplot = pytest.importorskip("matplotlib.pyplot")
    pyplot.switch_backend("agg")
    _, axis = pyplot.subplots()
    assert Renderer().render(small).plot(axis, unit="mm") is axis
    assert len(axis.images) == 1 and len(axis.figure.axes) == 2
    assert axis.texts[0].get_text().endswith("mm")
    pyplot.close("all")


@pytest.mark.parametrize(("background", "face", "ink"), [("white", "black", "black"), ("black", "white", "white"),
                                                         ("transparent", "white", "black"), ("transparent", "navy", "white")])
def test_scale_bars_of_plots_are_seen(small, background, face, ink):
    pyplot = pytest.importorskip("matplotlib.pyplot")
    pyplot.switch_backend("agg")
    figure, axis = pyplot.subplots(facecolor=face)
    Renderer().render(small.replace(background=background)).plot(axis)
    assert axis.lines[0].get_color() == axis.texts[0].get_color() == ink
    pyplot.close("all")


def test_colour_bars_of_plots_are_logarithmic():
    pyplot = pytest.importorskip("matplotlib.pyplot")
    pyplot.switch_backend("agg")
    field = np.geomspace(1e-4, 10, 512).reshape(8, 8, 8)
    for log in False, True:
        figure, axis = pyplot.subplots()
        halflight.render(field, cmap="viridis", clim=(1e-4, 10), log_scale=log, size=32).plot(axis)
        assert figure.axes[1].get_yscale() == ("log" if log else "linear")
        assert figure.axes[1].get_ylim() == pytest.approx((1e-4, 10))
        pyplot.close("all")


def test_import_loads_little_and_needs_numpy_alone():
    code = ("import sys, numpy; before = set(sys.modules); import halflight; "
            "print(*sorted(set(sys.modules) - before))")
    added = subprocess.run([sys.executable, "-c", code], check=True, capture_output=True, text=True).stdout.split()
    others = {name.partition(".")[0] for name in added} - set(sys.stdlib_module_names)
    assert others <= {"halflight", "_cffi_backend"}
    # What of the standard library takes long to load; versions of NumPy differ in which small modules they bring.
    slow = {"asyncio", "concurrent", "ctypes", "difflib", "email", "html", "http", "logging", "multiprocessing", "pdb", "socket", "sqlite3", "ssl", "unittest", "xml", "zipfile"}
    assert not slow & {name.partition(".")[0] for name in added}


def write_channels(folder):
    """An OME-Zarr image of three channels; omero has colours for them."""
    z, y, x = np.mgrid[:16, :16, :16]
    (folder / "0").mkdir(parents=True)
    axes = [{"name": "c", "type": "channel"}, *({"name": name, "type": "space"} for name in "zyx")]
    scale = [{"type": "scale", "scale": [1, 1, 1, 1]}]
    image = {"version": "0.4", "axes": axes, "datasets": [{"path": "0", "coordinateTransformations": scale}]}
    told = [{"label": "DAPI", "color": "0000FF", "window": {"start": 5, "end": 200}}, {"label": "GFP", "color": "00FF00"}, {"color": "FF0000"}]
    (folder / ".zgroup").write_text('{"zarr_format": 2}')
    (folder / ".zattrs").write_text(json.dumps({"multiscales": [image], "omero": {"channels": told}}))
    (folder / "0/.zarray").write_text(json.dumps({
        "zarr_format": 2, "shape": [3, 16, 16, 16], "chunks": [1, 16, 16, 16], "dtype": "|u1", "compressor": None, "fill_value": 0,
        "order": "C", "filters": None}))
    for n, middle in enumerate((4, 8, 12)):
        away = np.sqrt((x - middle) ** 2 + (y - 8) ** 2 + (z - 8) ** 2)
        (folder / f"0/{n}.0.0.0").write_bytes(np.clip(250 - 50 * away, 0, 250).astype(np.uint8).tobytes())


def test_channels_of_a_file(program, tmp_path):
    write_channels(tmp_path / "cells.zarr")
    told = Volume(tmp_path / "cells.zarr", channel=1).info()
    assert (told.channels, told.channel) == (3, 1)
    assert [(one.name, one.color, one.window, one.chosen) for one in told.channel_list] == [
        ("DAPI", (0, 0, 1), (5, 200), False), ("GFP", (0, 1, 0), None, True), ("", (1, 0, 0), None, False)]
    for words, channel in (("all", "all"), ("2,0", [2, 0])):
        subprocess.run([program, "render", "cells.zarr", "--channel", words, "--size", "40x40", "--quiet", "-o", "a.npy"], cwd=tmp_path, check=True)
        image = halflight.render(tmp_path / "cells.zarr", channel=channel, size=(40, 40))
        assert np.array_equal(np.load(tmp_path / "a.npy"), np.asarray(image))
    for look in "mip", "translucent":
        for size, words in (((40, 40), []), ((48, 30), ["--view", "left", "--background", "white"])):
            subprocess.run([program, "render", "cells.zarr", "--channel", "all", "--look", look, "--size", f"{size[0]}x{size[1]}", *words,
                            "--quiet", "--no-metadata", "-o", "a.png"], cwd=tmp_path, check=True)
            asked = {"camera": "left", "background": "white"} if words else {}
            halflight.render(tmp_path / "cells.zarr", channel="all", look=look, size=size, **asked).save(tmp_path / "b.png", metadata=False)
            assert (tmp_path / "a.png").read_bytes() == (tmp_path / "b.png").read_bytes(), (look, words)
    assert Volume(tmp_path / "cells.zarr", channel="dapi").info().channel == 0
    assert Volume(tmp_path / "cells.zarr", channel="DAPI") == Volume(tmp_path / "cells.zarr", channel=0)
    named = Scene.of_channels(tmp_path / "cells.zarr", [2, "DAPI"])
    assert named == Scene.of_channels(tmp_path / "cells.zarr", [2, 0])
    assert Scene.from_json(named.to_json()) == named
    with pytest.raises(ValueError, match="there is no channel 'Cy5': choose 0 to 2, or by name: DAPI, GFP"):
        Volume(tmp_path / "cells.zarr", channel="Cy5")
    scene = Scene.of_channels(tmp_path / "cells.zarr", [2, 0])
    assert [volume.look["name"] for volume in scene.volumes] == ["channel2", "DAPI"]
    with pytest.raises(ValueError, match="there is no channel 'both'"):
        Scene.of_channels(tmp_path / "cells.zarr", "both")
    with pytest.raises(ValueError, match="names none"):
        halflight.render(tmp_path / "cells.zarr", channel=[])
    with pytest.raises(TypeError, match="channel is for files that hold several"):
        halflight.render(np.zeros((4, 4, 4), np.uint8), channel=[0, 1])
    with pytest.raises(TypeError, match="affine is not for several channels"):
        halflight.render(tmp_path / "cells.zarr", channel="all", affine=np.eye(4))
