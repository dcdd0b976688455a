"""PyVista's plotters by Halflight, beside the picture that PyVista makes of them itself."""
import subprocess
import sys

import numpy as np
import pytest
from conftest import check_silhouettes, side_by_side

import halflight

pyvista = pytest.importorskip("pyvista")
halflight_component = pytest.importorskip("halflight.pyvista_component")
SIZE = (400, 300)


def plotter(**words):
    made = pyvista.Plotter(off_screen=True, window_size=SIZE, **words)
    made.set_background("white")
    return made


def host_pixels(made):
    made.render()
    return made.screenshot(None, return_img=True)[..., :3]


def silhouette(codes):
    """What differs from the background, a little: edges of fuzzy things, too."""
    return abs(codes[..., :3].astype(int) - codes[0, 0, :3].astype(int)).max(axis=-1) > 12


def inner(mask):
    """What of the mask has the mask around it: not its edges, which Halflight mixes with the background and VTK does not."""
    return mask & np.all([np.roll(mask, (y, x), (0, 1)) for y in (-1, 0, 1) for x in (-1, 0, 1)], axis=0)


def compare(made, name=None, pictures=None, brightness=0.05, **words):
    """Silhouettes within a pixel, and the mean brightness of what both show."""
    host = host_pixels(made)
    image = made.halflight(shading="display", **words)
    codes = image.to_srgb8()
    check_silhouettes(silhouette(host), silhouette(codes))
    both = silhouette(host) & silhouette(codes)
    assert codes[both][:, :3].mean(axis=0) == pytest.approx(host[both].mean(axis=0), rel=brightness)
    if name is not None and pictures is not None:
        side_by_side(pictures / f"{name}.png", host, made.halflight(shadows="soft").to_srgb8())
    return host, codes


def meshes(made):
    ball = pyvista.Sphere(theta_resolution=60, phi_resolution=60)
    ball["height"] = ball.points[:, 2]
    made.add_mesh(ball, cmap="coolwarm", show_scalar_bar=False)
    made.add_mesh(pyvista.Cube(center=(1, 0, 0)), color="tan")
    made.add_mesh(pyvista.Plane(center=(0.5, 0, -0.5), i_size=4, j_size=3), color="lightgrey")
    return made


def test_meshes(pictures):
    compare(meshes(plotter()), "pyvista_meshes", pictures)


@pytest.mark.parametrize("lighting", ["light kit", "three lights"])
@pytest.mark.parametrize("smooth", [False, True])
def test_lights_and_interpolation(lighting, smooth):
    made = plotter(lighting=lighting)
    made.add_mesh(pyvista.Sphere(theta_resolution=16, phi_resolution=12), color="salmon", smooth_shading=smooth, ambient=0.2, diffuse=0.7)
    made.add_mesh(pyvista.Cylinder(center=(0, 1, 0), direction=(0, 0, 1)), color="teal", lighting=False)
    host, codes = compare(made)
    assert abs(codes[..., :3].astype(int) - host).mean() < 3


def test_matrices_opacity_and_cameras():
    made = plotter()
    cone = made.add_mesh(pyvista.Cone(resolution=40), color="lightblue")
    cone.SetPosition(1, 0, 0)
    cone.SetScale(1, 1.5, 1)
    cone.RotateZ(40)
    cells = pyvista.ImageData(dimensions=(4, 4, 4), spacing=(0.3, 0.3, 0.3), origin=(-0.5, -2, 0)).cast_to_unstructured_grid()
    cells.cell_data["number"] = np.arange(27.0)
    made.add_mesh(cells, cmap="jet", show_scalar_bar=False)
    made.add_mesh(pyvista.Plane(center=(1, -2, 0.5)), color="green", opacity=0.6)
    made.camera.zoom(1.2)
    compare(made)
    made.enable_parallel_projection()
    compare(made)
    made.view_xy()
    compare(made)
    made.remove_all_lights()
    made.add_light(pyvista.Light(position=(3, -3, 6), focal_point=(0, 0, 0), light_type="scene light", color="orange", intensity=0.8))
    compare(made)


def test_points_lines_and_wires():
    made = plotter()
    points = pyvista.PolyData(np.random.default_rng(1).normal(size=(60, 3)) * 0.5 + [-1, 0, 0])
    points["number"] = np.arange(60.0)
    made.add_mesh(points, render_points_as_spheres=True, point_size=14, cmap="plasma", show_scalar_bar=False)
    made.add_mesh(pyvista.Spline([(0, 0, 0), (1, 1, 0), (2, 0, 1)], 60), color="red", line_width=8, render_lines_as_tubes=True)
    made.add_mesh(pyvista.Sphere(radius=0.5, center=(0, 1.5, 0), theta_resolution=8, phi_resolution=8), style="wireframe", color="steelblue",
                  line_width=4, render_lines_as_tubes=True)
    compare(made)


@pytest.mark.parametrize("background", ["black", "white"])
def test_wires_are_as_bright_as_vtk_s(background):
    """Away from the wires' edges."""
    for tubes, ratio in ((True, 1), (False, 0.93)):
        made = plotter()
        made.set_background(background)
        made.add_mesh(pyvista.Sphere(theta_resolution=8, phi_resolution=8), style="wireframe", color="steelblue", line_width=4, render_lines_as_tubes=tubes)
        host, codes = host_pixels(made), made.halflight(shading="display").to_srgb8()
        check_silhouettes(silhouette(host), silhouette(codes))
        both = inner(silhouette(host) & silhouette(codes))
        # VTK lights a flat line as if all of it were turned to the eye as far as it goes; of a tube only the middle is.
        assert both.sum() > 8000 and codes[both][:, :3].mean() == pytest.approx(ratio * host[both].mean(), rel=0.02)


@pytest.mark.parametrize("way", [(1, 0, 0), (0, 1, 0)])
def test_tubes_are_round(way):
    """The light across a tube is VTK's, pixel by pixel: of a tube with flat sides neighbours are alike or far apart."""
    made = plotter()
    made.set_background("black")
    made.add_mesh(pyvista.Line(-np.array(way), way), color="white", line_width=16, render_lines_as_tubes=True)
    made.camera_position = [(0, 0, 6), (0, 0, 0), (0, 1, 0)]
    host, codes = (picture[150, :, 0] if way[1] else picture[:, 200, 0] for picture in (host_pixels(made), made.halflight(shading="display").to_srgb8()))
    shown = np.flatnonzero(host)
    assert len(shown) == 16
    assert abs(host[shown[3:-3]].astype(int) - codes[shown[3:-3]]).max() <= 2


def blob():
    grid = pyvista.ImageData(dimensions=(40, 50, 60), spacing=(1, 1, 0.7), origin=(3, 4, 5))
    x, y, z = (grid.points - np.array(grid.center)).T
    grid["density"] = 100 * np.exp(-(x**2 + y**2 + 2 * z**2) / 200)
    return grid


def test_volumes(pictures):
    made = plotter()
    made.add_volume(blob(), cmap="viridis", opacity="sigmoid", show_scalar_bar=False)
    host, codes = host_pixels(made), made.halflight(shading="display").to_srgb8()
    solid = abs(host.astype(int) - 255).max(axis=-1) > 128  # where the medium is dense
    mine = abs(codes[..., :3].astype(int) - 255).max(axis=-1) > 128
    check_silhouettes(solid, mine)
    assert codes[solid & mine][:, :3].mean(axis=0) == pytest.approx(host[solid & mine].mean(axis=0), abs=8)
    lit = plotter()
    lit.add_volume(blob(), cmap="viridis", opacity="sigmoid", shade=True, show_scalar_bar=False)
    if pictures is not None:
        side_by_side(pictures / "pyvista_volume.png", host_pixels(lit), lit.halflight(shadows="soft").to_srgb8())
    turned = lit.renderer.actors[next(iter(lit.renderer.actors))]
    turned.SetPosition(20, 0, 0)
    assert lit.halflight.scene().volumes[0].affine[0, 3] == pytest.approx(23)


def test_maximum_and_other_grids():
    made = plotter()
    made.add_volume(blob(), blending="maximum", show_scalar_bar=False)
    assert made.halflight.scene().settings["compositing"] == "maximum"
    steps = np.linspace(0, 1, 12)
    uneven = pyvista.RectilinearGrid(20 * steps**2, 20 * steps, 20 * steps)
    uneven["distance"] = np.linalg.norm(uneven.points - 10, axis=1)
    made = plotter()
    made.add_volume(uneven, show_scalar_bar=False)
    with pytest.warns(halflight.HalflightWarning, match="RectilinearGrid is sampled to 34 x 34 x 34 voxels|is sampled to"):
        volume = made.halflight.scene().volumes[0]
    # The values at the voxels are those of the field.
    voxels = np.asarray(volume)
    index = np.array(voxels.shape[::-1]) // 3
    place = (volume.affine @ [*index, 1])[:3]
    assert voxels[tuple(index[::-1])] == pytest.approx(np.linalg.norm(place - 10), rel=0.05)


def test_clipping_planes_and_hidden_actors():
    made = plotter()
    ball = made.add_mesh(pyvista.Sphere(theta_resolution=60, phi_resolution=60), color="tan")
    made.add_mesh(pyvista.Cube(center=(3, 0, 0)), color="red").SetVisibility(False)
    plane = pyvista.plotting._vtk.vtkPlane() if hasattr(pyvista.plotting, "_vtk") else None
    if plane is None:
        from vtkmodules.vtkCommonDataModel import vtkPlane
        plane = vtkPlane()
    plane.SetNormal(0, 0, -1)
    ball.GetMapper().AddClippingPlane(plane)
    made.add_text("left out")
    scene = made.halflight.scene()
    assert len(scene.meshes) == 1
    host, image = host_pixels_without_text(made), made.halflight(shading="display").to_srgb8()
    check_silhouettes(silhouette(host), silhouette(image))


def host_pixels_without_text(made):
    for name in list(made.renderer.actors):
        if "text" in name.lower() or made.renderer.actors[name].IsA("vtkActor2D"):
            made.remove_actor(name)
    return host_pixels(made)


def test_scalar_bars_lie_over_the_picture(pictures):
    made = plotter()
    ball = pyvista.Sphere(theta_resolution=60, phi_resolution=60)
    ball["height of the ball"] = ball.points[:, 2]
    made.add_mesh(ball, cmap="coolwarm", scalar_bar_args={"color": "black"})
    made.add_text("a ball", color="navy", font_size=14)
    host, codes = host_pixels(made), made.halflight(shading="display").to_srgb8()[..., :3]
    bar = np.zeros(host.shape[:2], bool)
    bar[250:, :], bar[:40, :] = True, True  # where the bar and the text are
    drawn = bar & silhouette(host)
    assert drawn.sum() > 1500 and abs(host[drawn].astype(int) - codes[drawn]).mean() < 6
    assert np.array_equal(host_pixels(made), host)  # the plotter is as it was
    bare = made.halflight(shading="display", legends=False).to_srgb8()
    assert not silhouette(bare)[bar].any()
    with pytest.warns(halflight.HalflightWarning, match="scalar bars and text are left out: the picture is not as large as the window, 400 x 300"):
        made.halflight(size=64)


def test_settings_replace_the_host_s():
    made = meshes(plotter())
    scene = halflight.from_pyvista(made, size=200, background="black", lights=halflight.Directional(direction=(0, 0, -1)), camera="top")
    assert scene.size == (200, 200) and scene.background == (0, 0, 0) and len(scene.lights) == 1
    with pytest.raises(ValueError, match="shading: there is no 'vtk'"):
        halflight.from_pyvista(made, shading="vtk")
    with pytest.raises(TypeError, match=r"from_pyvista\(\): int is no pyvista.Plotter"):
        halflight.from_pyvista(3)
    with pytest.raises(ValueError, match="the renderer shows no volume and no mesh"):
        halflight.from_pyvista(plotter())
    assert halflight.from_vtk(made.renderer) == halflight.from_pyvista(made)


def test_the_accessor_registers_itself():
    """An installed package: PyVista finds it by its entry point, without an import of it."""
    code = ("import pyvista, sys; p = pyvista.Plotter(off_screen=True); p.add_mesh(pyvista.Sphere()); "
            "assert 'halflight' not in sys.modules; print(p.halflight(size=32).size)")
    assert subprocess.run([sys.executable, "-c", code], check=True, capture_output=True, text=True).stdout.strip() == "(32, 32)"


def test_meshes_of_pyvista():
    """Scalars, grids, lines and blocks of PyVista's data sets as halflight.Mesh takes them."""
    ball = pyvista.Sphere()
    ball["height"] = ball.points[:, 2]
    assert halflight.Mesh(ball).look["color"] == 1  # its scalars colour it
    assert halflight.Mesh(ball, color="red", scalars=False).look["color"] == "red"
    assert halflight.Mesh(pyvista.ImageData(dimensions=(3, 3, 3))).triangle_count == 48
    assert halflight.Mesh(pyvista.Spline([(0, 0, 0), (1, 1, 0), (2, 0, 1)], 30)).triangle_count > 100
    with pytest.raises(TypeError, match="MultiBlock has several blocks: give one of them"):
        halflight.Mesh(pyvista.MultiBlock([ball, ball]))
