"""Transfer functions, cameras and places as other programs have them."""
import types

import numpy as np
import pytest

import halflight
from halflight import Camera, TransferFunction


def lookup(points, value):
    return np.array([np.interp(value, points[:, 0], points[:, n]) for n in range(1, points.shape[1])])


def srgb(linear):
    return halflight.colors.to_srgb(linear)


def test_srgb():
    assert halflight.srgb(1, 1, 1) == (1, 1, 1) and halflight.srgb("#bc0000") == halflight.srgb(np.array([188, 0, 0], np.uint8))
    assert halflight.srgb([0.5, 0.5, 0.5])[0] == pytest.approx(0.21404, abs=1e-5)
    assert srgb(halflight.srgb(0.2, 0.4, 0.6)) == pytest.approx([0.2, 0.4, 0.6])


def test_matplotlib():
    function = TransferFunction.from_matplotlib(["black", "white"], (10, 20), 0.5, unit_distance=3)
    assert function.opacity.tolist() == [[10, 0.5], [20, 0.5]] and function.unit_distance == 3
    pytest.importorskip("matplotlib")
    from matplotlib import colormaps
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import ListedColormap, Normalize

    function = TransferFunction.from_matplotlib(ScalarMappable(Normalize(2, 4), "coolwarm"))
    assert function.color[0, 0] == 2 and function.color[-1, 0] == 4
    assert srgb(lookup(function.color, 2.5)) == pytest.approx(colormaps["coolwarm"](0.25)[:3], abs=5e-3)
    faint = ListedColormap([(1, 0, 0, 0), (1, 0, 0, 0.5)])
    assert lookup(TransferFunction.from_matplotlib(faint, (0, 1)).opacity, [0.1, 0.9])[0].tolist() == [0, 0.5]


def test_vtk_properties():
    pytest.importorskip("vtkmodules")
    from vtkmodules.vtkCommonDataModel import vtkPiecewiseFunction
    from vtkmodules.vtkRenderingCore import vtkColorTransferFunction, vtkVolumeProperty

    opacity, color, steep = vtkPiecewiseFunction(), vtkColorTransferFunction(), vtkPiecewiseFunction()
    opacity.AddPoint(0, 0)
    opacity.AddPoint(100, 0.25, 0.3, 0.5)  # a curve to the next point
    opacity.AddPoint(200, 1)
    color.AddRGBPoint(0, 1, 0, 0)
    color.AddRGBPoint(200, 0, 0, 1)
    steep.AddPoint(0, 0)
    steep.AddPoint(50, 1)
    prop = vtkVolumeProperty()
    prop.SetScalarOpacity(opacity)
    prop.SetColor(color)
    prop.SetGradientOpacity(steep)
    prop.SetScalarOpacityUnitDistance(2.5)
    function = TransferFunction.from_vtk(prop)
    assert function.unit_distance == 2.5 and function.gradient_opacity.tolist() == [[0, 0], [50, 1]]
    for value in (0, 30, 100, 118, 150, 190):
        assert lookup(function.opacity, value)[0] == pytest.approx(opacity.GetValue(value), abs=0.02), value
        assert srgb(lookup(function.color, value)) == pytest.approx(list(color.GetColor(value)), abs=5e-3), value
    for space in ("SetColorSpaceToHSV", "SetColorSpaceToLab", "SetColorSpaceToDiverging"):
        getattr(color, space)()
        again = TransferFunction.from_vtk(prop)
        assert srgb(lookup(again.color, 77)) == pytest.approx(list(color.GetColor(77)), abs=2e-2), space
    grey = vtkVolumeProperty()
    grey.SetScalarOpacity(opacity)
    grey.SetColor(opacity)
    assert srgb(lookup(TransferFunction.from_vtk(grey).color, 100)) == pytest.approx([0.25] * 3, abs=5e-3)
    both = TransferFunction.from_vtk(opacity, color, unit_distance=4)
    assert both.unit_distance == 4 and np.array_equal(both.opacity, function.opacity)


def test_vtk_cameras():
    pytest.importorskip("vtkmodules")
    from vtkmodules.vtkRenderingCore import vtkCamera

    camera = vtkCamera()
    camera.SetPosition(1, 2, 30)
    camera.SetFocalPoint(4, 5, 6)
    camera.SetViewUp(0, 1, 0)
    camera.SetViewAngle(25)
    assert Camera.from_vtk(camera) == Camera(position=(1, 2, 30), target=(4, 5, 6), up=(0, 1, 0), fovy_deg=25)
    camera.UseHorizontalViewAngleOn()
    assert Camera.from_vtk(camera, 2).fovy_deg == pytest.approx(12.65, abs=0.01)
    with pytest.raises(TypeError, match="a horizontal view angle needs aspect="):
        Camera.from_vtk(camera)
    camera.ParallelProjectionOn()
    camera.SetParallelScale(7)
    assert Camera.from_vtk(camera).height == 14
    camera.SetWindowCenter(0.5, 0)
    with pytest.warns(halflight.HalflightWarning, match="the camera's window centre is left out"):
        Camera.from_vtk(camera)


def test_napari_s_camera_and_colours():
    """napari counts axes z, y, x. Its own package is tried by scripts/test_integrations."""
    camera = types.SimpleNamespace(center=(1, 2, 3), view_direction=(1, 0, 0), up_direction=(0, -1, 0), zoom=4, perspective=0)
    found = Camera.from_napari(camera, 400)
    assert found.height == 100 and found.target == (3, 2, 1) and found.up == (0, -1, 0) and found.position == (3, 2, -99)
    camera.perspective = 60
    wide = Camera.from_napari(camera, 400)
    assert wide.fovy_deg == 60 and wide.target[2] - wide.position[2] == pytest.approx(50 / np.tan(np.pi / 6))
    colormap = types.SimpleNamespace(map=lambda steps: np.column_stack([steps, 0 * steps, 0 * steps, 0 * steps + 1]))
    layer = types.SimpleNamespace(colormap=colormap, contrast_limits=(10, 20), gamma=2.0, opacity=0.5)
    function = TransferFunction.from_napari(layer)
    assert lookup(function.opacity, 15)[0] == pytest.approx(0.125, abs=1e-3)
    assert srgb(lookup(function.color, 15))[0] == pytest.approx(0.25, abs=1e-2)


def test_camera_positions_of_pyvista(blob):
    cpos = [(1, -90, 30), (14, 10, 12), (0, 0, 1)]
    scene = halflight.Scene(blob, camera=cpos, size=32)
    assert scene.camera == Camera(position=(1, -90, 30), target=(14, 10, 12), up=(0, 0, 1))
    for word, axis, sign in (("xy", 2, 1), ("yx", 2, -1), ("xz", 1, -1), ("zx", 1, 1), ("yz", 0, 1), ("zy", 0, -1)):
        camera = halflight.Scene(blob, camera=word, size=32).camera
        towards = np.subtract(camera.position, camera.target)
        assert abs(towards).argmax() == axis and np.sign(towards[axis]) == sign
        assert np.cross(camera.up, towards / np.linalg.norm(towards)) == pytest.approx(np.eye(3)["xyz".index(word[0])], abs=1e-6)


def dataset():
    xarray = pytest.importorskip("xarray")
    values = np.arange(2 * 4 * 5 * 6, dtype=np.float32).reshape(2, 4, 5, 6)
    coords = {"lev": [0, 10, 20, 30.0], "lat": [1, 2, 3, 4, 5.0], "lon": [10, 12, 14, 16, 18, 20.0], "time": [0, 1]}
    return xarray.Dataset({"t": (("time", "lev", "lat", "lon"), values), "flat": (("lat", "lon"), values[0, 0])}, coords)


def test_dimensions_have_their_names():
    one = dataset()["t"].isel(time=0)
    for order in (("lev", "lat", "lon"), ("lon", "lat", "lev"), ("lat", "lev", "lon")):
        volume = halflight.Volume(one.transpose(*order))
        assert np.array_equal(np.asarray(volume), one.values) and volume.affine[:3, 3].tolist() == [10, 1, 0]
        assert volume.affine[:3, :3].tolist() == [[2, 0, 0], [0, 1, 0], [0, 0, 10]]
    deep = one.assign_coords(lev=("lev", one.lev.values, {"positive": "down"}))
    assert halflight.Volume(deep).affine[2].tolist() == [0, 0, -10, 0]
    renamed = one.rename(lev="a", lat="b", lon="c")
    for name, axis in (("a", "Z"), ("b", "Y"), ("c", "X")):
        renamed[name].attrs["axis"] = axis
    assert halflight.Volume(renamed.transpose("c", "a", "b")).affine[0, 0] == 2
    with pytest.warns(halflight.HalflightWarning, match="by its coordinates the volume is x 10, y 4, z 30000 wide: give spacing="):
        halflight.Volume(one.assign_coords(lev=one.lev * 1000))


def test_datasets():
    data = dataset()
    first = data.isel(time=[0])
    assert halflight.Volume(first).look["name"] == "t" and halflight.Volume(first).dimensions == (6, 5, 4)  # the time alone is left out
    two = first.assign(u=first["t"] * 2)
    assert halflight.Volume(two, array="u").info().range == (0, 238)
    with pytest.raises(ValueError, match="the dataset has 2 volumes: choose one of 't', 'u' with array="):
        halflight.Volume(two)
    with pytest.raises(ValueError, match="array: the dataset has no volume 'w': use one of 't', 'u'"):
        halflight.Volume(two, array="w")
    with pytest.raises(ValueError, match=r"the array has the shape \(2, 4, 5, 6\)"):
        halflight.Volume(data)


def test_shrunk_labels_are_labels(tmp_path):
    index = np.arange(24)
    labels = np.array([0, 3, 100])[(np.add.outer(np.add.outer(index, index), index) // 7) % 3].astype(np.uint8)
    halflight.Volume(labels).save(tmp_path / "labels.nrrd", shrink=2)
    assert set(np.unique(np.asarray(halflight.Volume(tmp_path / "labels.nrrd")))) == {0, 3, 100}
    values = np.linspace(0, 250, 24**3).reshape(24, 24, 24).astype(np.float32)
    halflight.Volume(values).save(tmp_path / "values.nrrd", shrink=2)
    means = values.reshape(12, 2, 12, 2, 12, 2).mean((1, 3, 5))
    assert np.asarray(halflight.Volume(tmp_path / "values.nrrd")) == pytest.approx(means, abs=1e-4)
