"""Pickle, copies and comparison: what process pools, joblib and dask hand over makes the same picture, byte for byte."""
import copy
import multiprocessing
import pickle

import numpy as np
import pytest

import halflight
from halflight import Directional, Mesh, Rect, Renderer, Scene, Texture, TransferFunction, Volume

ARRAYS = {
    "C order": lambda a: a, "turned": lambda a: a[::-1, :, ::-1], "transposed": lambda a: a.transpose(2, 0, 1),
    "every second slice": lambda a: a[::2], "every second voxel": lambda a: a[:, :, ::2], "int32": lambda a: a.astype(np.int32),
    "int16": lambda a: a.astype(np.int16) - 100, "float64": lambda a: a / 256, "bool": lambda a: a > 100,
    "not a number": lambda a: np.where(a > 200, np.nan, a).astype(np.float32),
}


def pixels(scene):
    return np.asarray(Renderer().render(scene))


def again(thing):
    return pickle.loads(pickle.dumps(thing))


@pytest.mark.parametrize("kind", ARRAYS)
def test_volumes_of_arrays(blob, kind):
    array = ARRAYS[kind](blob)
    volume = Volume(array, spacing=(2, 1, 1.5), origin=(3, 4, 5), name="ball")
    assert np.array_equal(np.asarray(volume), array, equal_nan=array.dtype.kind == "f")
    for other in (again(volume), copy.deepcopy(volume), copy.copy(volume)):
        assert other == volume and other.look["name"] == "ball" and other.dimensions == volume.dimensions
        assert np.array_equal(pixels(Scene(other, size=(32, 24))), pixels(Scene(volume, size=(32, 24))))
    assert volume != Volume(array, spacing=(2, 1, 1), origin=(3, 4, 5), name="ball") and volume != volume.replace(name="other")


def test_volumes_of_files_name_them(tmp_path, blob, monkeypatch):
    np.save(tmp_path / "two.npy", np.stack([blob, blob[::-1]], axis=-1))
    monkeypatch.chdir(tmp_path)
    volume = Volume("two.npy", component=1, spacing=(1, 1, 2), space="LPS")
    sent = pickle.dumps(volume)
    monkeypatch.chdir("/")
    assert len(sent) < 2000 and np.array_equal(np.asarray(pickle.loads(sent)), blob[::-1])
    assert pickle.loads(sent).info().spacing.tolist() == [2, 1, 1] and pickle.loads(sent).info().space == "LPS"


def test_scenes(blob, tmp_path):
    np.save(tmp_path / "blob.npy", blob)
    slide = Texture(np.eye(4), center=(0, 0, 60), right=(40, 0, 0), up=(0, 40, 0))
    window = Rect(position=(10, 10, 60), edge1=(30, 0, 0), edge2=(0, 30, 0), emission=halflight.EmissionImage(np.eye(3)))
    scene = Scene([Volume(blob, mask={"volume": blob > 60, "show": {1: ((1, 0, 0), 0.5)}, "rest": 0.2}),
                   Volume(tmp_path / "blob.npy", translate=(30, 0, 0), iso=[(90, "gold", 0.5)])],
                  lights=[Directional(direction=(0, 0, -1), texture=slide), window], size=(40, 30), background="navy",
                  sky={"type": "image", "pixels": np.linspace(0, 1, 24).reshape(2, 4, 3)}, description="two balls", tone="filmic",
                  meshes=[Mesh(spheres=[(10, 10, 0)], radius=4, color="red")], soft_method="sublights", light_samples=2,
                  cuts={"type": "plane", "point": (9, 9, 9), "normal": (1, 0, 0)})
    for other in (again(scene), copy.deepcopy(scene), Scene.from_json(scene.replace(volumes=[tmp_path / "blob.npy"], lights=[], sky=0).to_json())):
        expected = scene if other == scene else scene.replace(volumes=[tmp_path / "blob.npy"], lights=[], sky=0)
        assert np.array_equal(pixels(other), pixels(expected))
    assert again(scene) == scene and hash(again(scene)) == hash(scene)
    for change in ({"size": (41, 30)}, {"exposure": 1}, {"sky": 0}, {"meshes": []}, {"camera": "top"}, {"kernel": "linear"}, {"cuts": []},
                   {"lights": [Directional(direction=(0, 0, -1), texture=Texture(np.eye(4) / 2, *(getattr(slide, n) for n in ("center", "right", "up")))), window]}):
        assert scene.replace(**change) != scene, change


def test_shapes_and_labels(blob):
    text = '{"halflight": 1, "volumes": [{"shapes": [{"type": "sphere", "radius": 8}], "voxel_size": 1}]}'
    scene = Scene.from_json(text)
    assert again(scene) == scene and np.array_equal(pixels(again(scene)), pixels(scene))
    labels = Volume((blob > 60).astype(np.uint8) + (blob > 150), labels={1: ("red", 0.3), 2: "lime"})
    assert again(labels) == labels and np.array_equal(pixels(again(Scene(labels, size=32))), pixels(Scene(labels, size=32)))
    colored = np.stack([blob, blob[::-1], 255 - blob], axis=-1)
    assert np.array_equal(pixels(again(Scene(colored, size=32))), pixels(Scene(colored, size=32)))


def test_meshes_functions_cameras_and_images(small):
    meshes = [Mesh([(0, 0, 0), (9, 0, 0), (9, 9, 0)], [(0, 1, 2)], normals=[(0, 0, 1)] * 3, colors=[(1, 0, 0)] * 3, color=1, name="face"),
              Mesh(lines=[[(0, 0, 0), (9, 9, 9)]], radius=1), Mesh(spheres=[(0, 0, 0, 2)], sphere_colors=[(1, 0, 0, 0.5)])]
    for mesh in meshes:
        assert again(mesh) == mesh == copy.deepcopy(mesh) and mesh != mesh.replace(opacity=0.5)
        assert np.array_equal(pixels(Scene(again(mesh), size=32)), pixels(Scene(mesh, size=32)))
    assert meshes[0] != meshes[1]
    for thing in (TransferFunction([(0, 0), (9, 1)], gradient_opacity=[(0, 0), (1, 1)]), small.camera, *small.lights,
                  TransferFunction(second="gradient", boxes=[{"value": (0, 9), "second": (0, 9)}])):
        assert again(thing) == thing == copy.deepcopy(thing)
    image = Renderer().render(small, layers=True)
    for other in (again(image), copy.deepcopy(image)):
        assert other == image and other.scene == small and other.statistics == image.statistics
        assert other.encode("npy") == image.encode("npy") and not np.shares_memory(other, image)
    assert image != Renderer().render(small)


def sum_of(scene):
    return float(np.asarray(Renderer().render(scene.replace(threads=1))).sum())


def test_process_pools(small):
    with multiprocessing.get_context("spawn").Pool(2) as pool:
        assert pool.map(sum_of, [small, small.replace(camera="top")]) == [sum_of(small), sum_of(small.replace(camera="top"))]


def test_joblib_and_dask(small):
    joblib = pytest.importorskip("joblib")
    assert joblib.Parallel(2)(joblib.delayed(sum_of)(one) for one in (small, small)) == 2 * [sum_of(small)]
    dask = pytest.importorskip("dask")
    assert dask.compute(dask.delayed(sum_of)(small), scheduler="processes") == (sum_of(small),)


def test_bundles(tmp_path, blob, monkeypatch):
    """A saved scene has all that it needs beside it, and the program renders it to the same bytes."""
    colored = np.stack([blob, blob[::-1], 255 - blob], axis=-1)
    slide = Texture(np.eye(4), center=(0, 0, 60), right=(40, 0, 0), up=(0, 40, 0))
    scene = Scene([Volume(blob, affine=[[0, -1, 0, 7], [2, 0, 0, 8], [0, 0, 3, 9]], name="a/b"), Volume(colored, translate=(50, 0, 0)),
                   Volume(blob.astype(float) / 255, mask=blob > 60, translate=(0, 50, 0), name="a/b")],
                  size=(40, 30), sky={"type": "image", "pixels": np.ones((2, 4, 3))}, lights=Directional(direction=(0, 0, -1), texture=slide),
                  meshes=Mesh(spheres=[(10, 10, 0)], radius=4))
    (tmp_path / "one").mkdir()
    scene.save(tmp_path / "one" / "figure.json")
    assert sorted(path.name for path in (tmp_path / "one" / "figure_files").iterdir()) == [
        "a_b-2.nrrd", "a_b.nrrd", "image-2.npy", "image.npy", "mask2.nrrd", "volume1.nrrd"]
    (tmp_path / "one").rename(tmp_path / "moved")
    loaded = Scene.load(tmp_path / "moved" / "figure.json")
    assert np.array_equal(pixels(loaded), pixels(scene))
    np.save(tmp_path / "blob.npy", blob)
    filed = Scene(tmp_path / "blob.npy", size=(40, 30))
    filed.save(tmp_path / "there.json")
    assert not (tmp_path / "there_files").exists()
    filed.save(tmp_path / "copied.json", copy=True)
    (tmp_path / "blob.npy").unlink()
    assert np.array_equal(pixels(Scene.load(tmp_path / "copied.json")), pixels(filed))
    with pytest.raises(OSError, match="blob.npy: cannot open"):
        Scene.load(tmp_path / "there.json")
