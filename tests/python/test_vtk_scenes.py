"""Renderers of VTK as scenes, without a picture by VTK; scripts/test_integrations compares pictures with PyVista's."""
import warnings

import numpy as np
import pytest

import halflight
from halflight import Renderer

pytest.importorskip("vtkmodules.vtkRenderingOpenGL2")
pytest.importorskip("vtkmodules.vtkRenderingVolumeOpenGL2")
from vtkmodules.util.numpy_support import numpy_to_vtk  # noqa: E402
from vtkmodules.vtkCommonDataModel import vtkImageData, vtkPiecewiseFunction, vtkPlane  # noqa: E402
from vtkmodules.vtkFiltersSources import vtkCubeSource, vtkLineSource, vtkSphereSource  # noqa: E402
from vtkmodules.vtkRenderingCore import (  # noqa: E402
    vtkActor, vtkAssembly, vtkColorTransferFunction, vtkLight, vtkPolyDataMapper, vtkRenderer, vtkVolume, vtkVolumeProperty)
from vtkmodules.vtkRenderingVolume import vtkFixedPointVolumeRayCastMapper  # noqa: E402


def actor(source, **properties):
    mapper, made = vtkPolyDataMapper(), vtkActor()
    mapper.SetInputConnection(source.GetOutputPort())
    made.SetMapper(mapper)
    for word, value in properties.items():
        getattr(made.GetProperty(), f"Set{word}")(value)
    return made


@pytest.fixture
def renderer():
    made = vtkRenderer()
    made.SetBackground(0, 0, 1)
    camera = made.GetActiveCamera()
    camera.SetPosition(0, -30, 0)
    camera.SetFocalPoint(0, 0, 0)
    camera.SetViewUp(0, 0, 1)
    camera.ParallelProjectionOn()
    camera.SetParallelScale(8)
    return made


def test_actors_bring_their_places_colours_and_material(renderer):
    ball = vtkSphereSource()
    ball.SetRadius(2)
    ball.SetThetaResolution(32)
    ball.SetPhiResolution(32)
    part = actor(ball, Color=(0.5, 0.5, 0.5), Opacity=0.5, Ambient=0.25, Diffuse=0.5, Specular=0.125, SpecularPower=9)
    part.SetPosition(3, 0, 0)
    whole, hidden = vtkAssembly(), actor(vtkCubeSource())
    whole.AddPart(part)
    whole.SetPosition(0, 0, 1)
    hidden.VisibilityOff()
    line = vtkLineSource()
    line.SetPoint1(-4, 0, -4)
    line.SetPoint2(4, 0, -4)
    wire = actor(line, Color=(1, 0, 0), LineWidth=10, Lighting=False)
    for prop in (whole, hidden, wire):
        renderer.AddViewProp(prop)
    scene = halflight.from_vtk(renderer, size=160)
    assert len(scene.meshes) == 2 and scene.background == (0, 0, 1) and scene.camera.height == 16
    look = scene.meshes[0].look
    assert look["color"][0] == pytest.approx(0.21404, abs=1e-4) and look["opacity"] == 0.5
    assert [look[word] for word in ("ambient", "diffuse", "specular", "shininess")] == [0.25, 0.5, 0.125, 9]
    picture = np.asarray(Renderer().render(scene.replace(lights=[])))[..., 3]
    shown = np.argwhere(picture[:110] > 0.2)  # 10 pixels a unit: the ball's middle is at 3, 1
    assert shown.mean(axis=0) == pytest.approx([69.5, 109.5], abs=1) and np.ptp(shown[:, 1]) == pytest.approx(40, abs=2)
    tube = np.asarray(Renderer().render(scene))[:, 80]
    assert (tube[110:, 3] > 0.5).sum() == pytest.approx(10, abs=1) and tube[120, :3] == pytest.approx([1, 0, 0], abs=1e-3)


def test_shading_as_displays_have_it(renderer):
    renderer.AddViewProp(actor(vtkCubeSource(), Color=(0.5, 0.25, 1), Ambient=0.4, Diffuse=0.6))
    scene = halflight.from_vtk(renderer, size=64, shading="display")
    image = Renderer().render(scene).as_display()
    assert image.to_srgb8()[32, 32, :3].tolist() == pytest.approx([128, 64, 255], abs=1)
    assert image.to_srgb8()[0, 0].tolist() == [0, 0, 255, 255]
    half = vtkLight()
    half.SetLightTypeToSceneLight()
    half.SetPosition(0, -10, 0)
    half.SetFocalPoint(0, 0, 0)
    half.SetIntensity(0.5)
    renderer.AddLight(half)
    image = Renderer().render(halflight.from_vtk(renderer, size=64, shading="display")).as_display()
    assert image.to_srgb8()[32, 32, :3].tolist() == pytest.approx([0.7 * 127.5, 0.7 * 63.75, 0.7 * 255], abs=1)


def test_volumes(renderer):
    values = np.random.default_rng(2).integers(0, 255, (6, 7, 8)).astype(np.uint8)
    image = vtkImageData()
    image.SetDimensions(8, 7, 6)
    image.SetSpacing(1, 2, 3)
    image.SetOrigin(4, 5, 6)
    image.GetPointData().SetScalars(numpy_to_vtk(values.ravel(), deep=True))
    opacity, color, prop, mapper, volume = vtkPiecewiseFunction(), vtkColorTransferFunction(), vtkVolumeProperty(), vtkFixedPointVolumeRayCastMapper(), vtkVolume()
    opacity.AddPoint(0, 0)
    opacity.AddPoint(255, 0.5)
    color.AddRGBPoint(0, 1, 1, 1)
    prop.SetScalarOpacity(opacity)
    prop.SetColor(color)
    prop.SetScalarOpacityUnitDistance(2)
    prop.ShadeOn()
    mapper.SetInputData(image)
    plane = vtkPlane()
    plane.SetOrigin(5, 0, 0)
    plane.SetNormal(1, 0, 0)
    mapper.AddClippingPlane(plane)
    mapper.SetBlendModeToMaximumIntensity()
    volume.SetMapper(mapper)
    volume.SetProperty(prop)
    volume.SetPosition(10, 0, 0)
    renderer.AddViewProp(volume)
    with warnings.catch_warnings():
        warnings.simplefilter("error")  # nothing is said of what the renderer did not ask for
        scene = halflight.from_vtk(renderer, size=32)
    found = scene.volumes[0]
    assert np.array_equal(np.asarray(found), values) and found.affine.tolist() == [[1, 0, 0, 14], [0, 2, 0, 5], [0, 0, 3, 6], [0, 0, 0, 1]]
    assert found.look["shading"] == "phong" and found.look["transfer_function"].unit_distance == 2
    assert found.look["cuts"] == [{"type": "plane", "point": (5, 0, 0), "normal": (-1, 0, 0), "world": True}]
    assert scene.settings["compositing"] == "maximum" and scene.settings["kernel"] == "linear"
    mapper.CroppingOn()
    mapper.SetCroppingRegionPlanes(5, 7, 6, 9, 7, 12)
    assert halflight.from_vtk(renderer, size=32).volumes[0].look["clip"] == ((5, 6, 7), (7, 9, 12))


def test_what_is_left_out_is_said(renderer):
    renderer.AddViewProp(actor(vtkCubeSource(), Interpolation=3))
    renderer.GradientBackgroundOn()
    with pytest.warns(halflight.HalflightWarning) as said:
        halflight.from_vtk(renderer, size=32)
    assert sorted(str(one.message).split(" is left out")[0] for one in said) == ["an actor's texture or physically based material", "the background's gradient"]
