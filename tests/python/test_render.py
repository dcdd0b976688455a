"""halflight.render(): the program's bytes, and every keyword."""
import os
import subprocess
import zlib

import numpy as np
import pytest

import halflight
from halflight import Camera, Directional, TransferFunction


def pixels(volume, **words):
    return np.asarray(halflight.render(volume, size=words.pop("size", (64, 48)), **words))


def run(program, folder, source, *options):
    subprocess.run([program, "render", source, "--quiet", "-o", folder / "program.npy", *options], check=True)
    return (folder / "program.npy").read_bytes()


CASES = [
    ({}, []),
    ({"size": (96, 64)}, ["--size", "96x64"]),
    ({"size": (96, 64), "shadows": "hard"}, ["--size", "96x64", "--shadows", "hard"]),
    ({"size": (64, 64), "cmap": "viridis", "clim": (10, 200)},
     ["--size", "64x64", "--colormap", "viridis", "--range", "10,200"]),
    ({"size": (64, 64), "camera": {"view": "left", "up": "+y", "ortho": True, "zoom": 1.2, "roll": 15}},
     ["--size", "64x64", "--view", "left", "--up", "+y", "--ortho", "--zoom", "1.2", "--roll", "15"]),
    ({"size": (64, 64), "camera": {"azimuth": 40, "up": (0, 1, 1), "ortho": False, "fovy": 12}},
     ["--size", "64x64", "--azimuth", "40", "--up", "0,1,1", "--fovy", "12"]),
    ({"size": (64, 64), "clim": (10, 200)}, ["--size", "64x64", "--range", "10,200"]),
    ({"size": (64, 64), "cmap": ["gray"], "clim": (2, 250)}, ["--size", "64x64", "--range", "2,250", "--colormap", "#808080"]),
    ({"size": (64, 64), "cmap": "gray", "clim": (0, 255)}, ["--size", "64x64", "--range", "0,255", "--colormap", "gray"]),
    ({"size": (64, 64), "clim": ("20%", "99.5%")}, ["--size", "64x64", "--range", "20%,99.5%"]),
    ({"size": (64, 64), "cmap": "viridis", "clim": (10, 200), "log_scale": True},
     ["--size", "64x64", "--colormap", "viridis", "--range", "10,200", "--range-scale", "log"]),
    ({"size": (64, 64), "tf": "ct-bone"}, ["--size", "64x64", "--tf", "ct-bone"]),
    ({"size": (64, 64), "camera": (30, 40)}, ["--size", "64x64", "--azimuth", "30", "--elevation", "40"]),
    ({"size": (64, 64), "camera": "left"}, ["--size", "64x64", "--view", "left"]),
    ({"size": (64, 64), "shade": False}, ["--size", "64x64", "--shading", "flat"]),
    ({"size": (64, 64), "spacing": (3, 2, 1)}, ["--size", "64x64", "--spacing", "1,2,3"]),
    ({"size": (64, 64), "soft_method": "sublights", "light_samples": 3, "sheet_spacing": 1, "pixel_samples": 2, "kernel": "linear"},
     ["--size", "64x64", "--soft-method", "sublights", "--light-samples", "3", "--sheet-spacing", "1", "--pixel-samples", "2", "--kernel", "linear"]),
    ({"size": (64, 64), "threads": 1, "background": "red"}, ["--size", "64x64", "--threads", "1"]),
    ({"size": 64, "lights": "rim", "background": "sky"}, ["--size", "64x64", "--light-rig", "rim", "--background", "sky"]),
]


@pytest.mark.parametrize("words, options", CASES, ids=[" ".join(options) or "default" for _, options in CASES])
def test_a_path_gives_the_bytes_of_the_program(program, tmp_path, blob, words, options):
    source = tmp_path / "blob.npy"
    np.save(source, blob)
    halflight.render(source, **words).save(tmp_path / "python.npy")
    assert (tmp_path / "python.npy").read_bytes() == run(program, tmp_path, source, *options)


def test_a_png_is_the_program_s_too(program, tmp_path, blob):
    source = tmp_path / "blob.npy"
    np.save(source, blob)
    halflight.render(source, size=(64, 48)).save(tmp_path / "python.png")
    command = [program, "render", source, "--quiet", "--size", "64x48", "-o", tmp_path / "program.png"]
    subprocess.run(command, check=True)
    assert (tmp_path / "python.png").read_bytes() == (tmp_path / "program.png").read_bytes()


def test_a_png_does_not_tell_its_threads(tmp_path, blob):
    halflight.Volume(blob).save(tmp_path / "blob.nrrd")
    for threads in 0, 2:
        halflight.render(str(tmp_path / "blob.nrrd"), size=32, threads=threads).save(tmp_path / f"{threads}.png")
    assert (tmp_path / "0.png").read_bytes() == (tmp_path / "2.png").read_bytes()


def test_a_png_tells_no_more_than_it_is_asked_to(program, tmp_path, blob):
    source = tmp_path / "blob.npy"
    np.save(source, blob)
    image = halflight.render(source, size=(64, 48))
    image.save(tmp_path / "told.png")
    image.save(tmp_path / "bare.png", metadata=False)
    told, bare = (tmp_path / "told.png").read_bytes(), (tmp_path / "bare.png").read_bytes()
    packed = told.split(b"halflight:scene\0")[1][2:].split(b"\0", 2)[2]  # an iTXt chunk: flag, method, language, keyword, text
    text = zlib.decompressobj().decompress(packed)
    assert b'"file": "blob.npy"' in text and os.fsencode(tmp_path) not in text
    assert b"halflight:scene" not in bare and b"blob.npy" not in bare
    assert b"halflight:scene" not in image.encode(metadata=False) and b"halflight:scene" in image.encode()
    command = [program, "render", source, "--quiet", "--size", "64x48", "--no-metadata", "-o", tmp_path / "program.png"]
    subprocess.run(command, check=True)
    assert bare == (tmp_path / "program.png").read_bytes()


def test_layers_are_the_program_s(program, tmp_path, blob, has_openexr):
    source = tmp_path / "blob.npy"
    np.save(source, blob)
    halflight.render(source, size=(64, 48), layers=True).save(tmp_path / "python.exr")
    command = [program, "render", source, "--quiet", "--layers", "--size", "64x48", "-o", tmp_path / "program.exr"]
    subprocess.run(command, check=True)
    assert (tmp_path / "python.exr").read_bytes() == (tmp_path / "program.exr").read_bytes()


def test_an_array_gives_the_picture_of_its_file(tmp_path, blob):
    np.save(tmp_path / "blob.npy", blob)
    assert np.array_equal(pixels(blob), pixels(tmp_path / "blob.npy"))


def test_no_keyword_is_ignored(blob):
    plain = pixels(blob)
    for words in ({"spacing": (2, 1, 1)}, {"affine": np.diag([1, 2, 1, 1])}, {"axes": "xyz"}, {"cmap": "magma"},
                  {"clim": (100, 200)}, {"opacity": 0.1}, {"opacity": "linear"}, {"opacity": "sigmoid"},
                  {"opacity": "geom"}, {"opacity": [0, 0.2, 0.9]}, {"opacity": [(50, 0), (60, 0.3)]},
                  {"opacity_unit_distance": 9}, {"shade": False}, {"shade": "none"}, {"ambient": 3}, {"diffuse": 0.2},
                  {"specular": 2}, {"shininess": 2}, {"tf": "smoke"}, {"shadows": False}, {"shadows": "hard"},
                  {"direction": [[0, -1, 0], [1, 0, 0], [0, 0, 1]]},
                  {"lights": Directional(direction=(0, 1, 0))}, {"lights": []}, {"sky": 0}, {"sky": 0.4},
                  {"camera": "top"}, {"camera": (10, 80)}, {"camera": Camera(position=(14, -99, 9), target=(14, 0, 9))},
                  {"tf": TransferFunction([(30, 0), (40, 0.9)], color=(1, 0, 0))}):
        assert not np.array_equal(pixels(blob, **words), plain), words
    # The world's origin moves what is looked at, and the camera with it: the picture is the same up to rounding.
    moved, here = (halflight.Scene(halflight.Volume(blob, origin=(x, 0, 0)), size=(64, 48)).camera for x in (100, 0))
    assert moved.target[0] == pytest.approx(100 + here.target[0], abs=1e-6)
    assert np.array_equal(pixels(blob, threads=1), plain)
    assert pixels(blob, size=(30, 20)).shape == (20, 30, 4)
    assert tuple(halflight.render(blob, background="white", size=(16, 16)).to_srgb8()[0, 0]) == (255,) * 4


def test_opacity_is_per_unit_distance():
    """A homogeneous slab of 8 units with opacity 0.2 per 2 units lets (1 - 0.2)^(8 / 2) through."""
    slab = np.full((8, 40, 40), 7, np.uint8)
    camera = Camera(position=(19.5, 19.5, 100), target=(19.5, 19.5, 3.5), up=(0, 1, 0), height=4)
    alpha = pixels(slab, opacity=0.2, opacity_unit_distance=2, camera=camera, shade=False, cmap="white")[24, 32, 3]
    assert alpha == pytest.approx(1 - 0.8**4, abs=1e-4)


def test_cmap_takes_colours_in_srgb_and_numbers_in_linear_light(blob):
    flat = {"shade": False, "opacity": 0.99}
    assert np.allclose(pixels(blob, cmap="#bc0000", **flat)[24, 32, :3], [0.5029, 0, 0], atol=2e-3)
    assert np.allclose(pixels(blob, cmap=(0.5, 0, 0), **flat)[24, 32, :3], [0.5, 0, 0], atol=1e-3)
    grey = pixels(blob, cmap=["black", "white"], clim=(0, 255), **flat)
    assert np.allclose(grey[..., 0], grey[..., 1])


@pytest.mark.parametrize("words", [{"cmap": "inferno", "clim": (10, 200)}, {"opacity": "linear", "clim": ("5%", "99%"), "opacity_unit_distance": 3},
                                   {"tf": "ct-bone"}, {"clim": (1, 200), "log_scale": True, "cmap": "viridis"}, {"look": "mip", "cmap": "gold"}])
def test_a_volume_takes_the_keywords_of_its_values(blob, words):
    volume = halflight.Volume(blob, **words)
    assert np.array_equal(pixels(volume), pixels(blob, **words))
    assert np.array_equal(pixels(halflight.Volume(blob).replace(**words)), pixels(blob, **words))


def test_a_scene_s_camera_is_turned_by_the_program_s_options(blob):
    scene = halflight.Scene(blob, size=64, camera={"view": "front", "ortho": True})
    nearer = scene.replace(camera={"zoom": 2}).camera
    assert nearer.height == pytest.approx(scene.camera.height / 2, rel=0.02) and nearer.up == pytest.approx(scene.camera.up)


def test_percentiles_are_those_of_numpy(blob):
    volume = halflight.Volume(blob)
    for percent in (0, 1, 33.3, 50, 99.5, 100):
        assert volume.percentile(percent) == pytest.approx(np.percentile(blob, percent), abs=1e-9)


def test_matplotlib_colormaps_by_logarithms():
    """Of a range from 1 to 100, the middle colour is that of 10."""
    pytest.importorskip("matplotlib")
    slab, flat = np.full((8, 8, 8), 10, np.uint8), {"shade": False, "opacity": 1.0, "size": (16, 16)}
    spread = pixels(slab, cmap=["black", "#bc0000", "white"], clim=(1, 100), log_scale=True, **flat)
    assert np.allclose(spread[8, 8, :3], [0.5029, 0, 0], atol=2e-3)


def test_matplotlib_colormaps(blob):
    matplotlib = pytest.importorskip("matplotlib")
    by_name = pixels(blob, cmap="Spectral", clim=(0, 255))
    assert np.array_equal(by_name, pixels(blob, cmap=matplotlib.colormaps["Spectral"], clim=(0, 255)))
    # Halflight's viridis is matplotlib's, in fewer points.
    own = pixels(blob, cmap="viridis", clim=(0, 255))
    assert abs(own - pixels(blob, cmap=matplotlib.colormaps["viridis"], clim=(0, 255))).max() < 0.02


def test_a_scene_file_is_rendered_as_by_the_program(program, tmp_path):
    scene = tmp_path / "scene.json"
    scene.write_text('{"halflight": 1, "image": {"width": 64, "height": 48}, "volumes": '
                     '[{"shapes": [{"type": "torus", "radius": 20, "tube_radius": 6}], "voxel_size": 1}]}')
    halflight.render(scene).save(tmp_path / "python.npy")
    assert (tmp_path / "python.npy").read_bytes() == run(program, tmp_path, scene)


def test_device():
    """A device that is not there: the processors make the picture, and the statistics say why."""
    volume = np.arange(8 * 8 * 8, dtype=np.uint8).reshape(8, 8, 8)
    words = {"size": (32, 32), "shadows": "off", "sky": 0}
    own, other = (halflight.render(volume, device=device, **words) for device in (None, "no such device"))
    assert np.array_equal(np.asarray(own), np.asarray(other))
    assert own.statistics["device_reason"] == ""
    assert other.statistics["device"] == "cpu" and "no device answers" in other.statistics["device_reason"]
    with pytest.raises(TypeError, match="device: 3 is no text"):
        halflight.Renderer(device=3)
    with pytest.raises(ValueError, match="less than 128 bytes"):
        halflight.Renderer(device="a" * 200)
