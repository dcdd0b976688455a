"""Scalars of meshes become colours: arrays, and the data sets of VTK, PyVista, trimesh and meshio."""
import types

import numpy as np
import pytest

import halflight
from halflight import Camera, Mesh, Renderer, Scene

SQUARE = np.array([(0, 0, 0), (20, 0, 0), (20, 20, 0), (0, 20, 0)], float)
TRIANGLES = [(0, 1, 2), (0, 2, 3)]
# White over the mesh's colours: what a pixel shows is the colour itself.
LOOK = {"size": (32, 32), "lights": [], "ambient": 1, "sky": 0,
        "camera": Camera(position=(10, 10, 90), target=(10, 10, 0), up=(0, 1, 0), height=20)}


def pixels(*meshes):
    return np.asarray(Renderer().render(Scene(list(meshes), **LOOK)))


def test_values_of_vertices_and_triangles():
    ramp = pixels(Mesh(SQUARE, TRIANGLES, scalars=[0, 1, 1, 0], cmap=["black", "white"]))
    assert ramp[16, :, 0] == pytest.approx((np.arange(32) + 0.5) / 32, abs=2e-2)
    two = pixels(Mesh(SQUARE, TRIANGLES, scalars=[3, 7], cmap=["red", "blue"]))
    assert two[28, 24, :3] == pytest.approx([1, 0, 0], abs=1e-5) and two[4, 8, :3] == pytest.approx([0, 0, 1], abs=1e-5)
    clipped = pixels(Mesh(SQUARE, TRIANGLES, scalars=[3, 7], cmap=["red", "blue"], clim=(7, 9)))
    assert clipped[4, 8, :3] == pytest.approx([1, 0, 0], abs=1e-5)
    logs = pixels(Mesh(SQUARE, TRIANGLES, scalars=[10, 1000], cmap=["black", "white"], clim=(1, 100), log_scale=True))
    assert logs[28, 24, 0] == pytest.approx(0.5, abs=1e-3) and logs[4, 8, 0] == pytest.approx(1, abs=1e-3)
    none = pixels(Mesh(SQUARE, TRIANGLES, scalars=[np.nan, 1], nan_color="red"))
    assert none[28, 24, :3] == pytest.approx([1, 0, 0], abs=1e-5)
    painted = pixels(Mesh(SQUARE, TRIANGLES, scalars=np.array([(188, 0, 0), (0, 188, 0)], np.uint8)))
    assert painted[28, 24, :3] == pytest.approx([0.5029, 0, 0], abs=1e-3)
    vectors = pixels(Mesh(SQUARE, TRIANGLES, scalars=[(3.0, 4.0), (6.0, 8.0)], cmap=["black", "white"], clim=(0, 10)))
    assert vectors[28, 24, 0] == pytest.approx(0.5, abs=1e-3)


def test_affine_moves_mirrors_and_scales():
    turned = np.array([[0, -1, 0, 20], [1, 0, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]], float)
    ramp = [0, 1, 1, 0]
    moved = pixels(Mesh(SQUARE, TRIANGLES, scalars=ramp, cmap=["black", "white"], affine=turned))
    assert moved[::-1, 16, 0] == pytest.approx((np.arange(32) + 0.5) / 32, abs=2e-2)
    again = Mesh(Mesh(SQUARE, TRIANGLES, scalars=ramp, cmap=["black", "white"]), affine=turned)
    assert np.array_equal(pixels(again), moved)
    mirrored = Mesh(SQUARE - (20, 0, 0), TRIANGLES, normals=[(0, 0, 1)] * 4, affine=np.diag([-1, 1, 1, 1]), two_sided=False, color=1)
    assert pixels(mirrored)[16, 16] == pytest.approx([1, 1, 1, 1], abs=1e-5)  # its front still faces the viewer
    ball = pixels(Mesh(spheres=[(5, 5, 0)], radius=2.5, color=1, affine=np.diag([2, 2, 2, 1])))
    assert np.sqrt(np.pi * 25) * 32 / 20 == pytest.approx(np.sqrt((ball[..., 3] > 0.5).sum()), abs=0.5)


def vtk_square(scalars=None, cells=None):
    pytest.importorskip("vtkmodules")
    from vtkmodules.util.numpy_support import numpy_to_vtk
    from vtkmodules.vtkCommonCore import vtkPoints
    from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData

    data, points, quads = vtkPolyData(), vtkPoints(), vtkCellArray()
    for corner in SQUARE:
        points.InsertNextPoint(corner)
    quads.InsertNextCell(4)
    for n in range(4):
        quads.InsertCellPoint(n)
    data.SetPoints(points)
    data.SetPolys(quads)
    for values, where in ((scalars, data.GetPointData()), (cells, data.GetCellData())):
        if values is not None:
            array = numpy_to_vtk(np.asarray(values, float), deep=True)
            array.SetName("values")
            where.SetScalars(array)
    return data


def test_vtk_polydata_shows_its_active_scalars():
    ramp = pixels(Mesh(vtk_square([0, 1, 1, 0]), cmap=["black", "white"]))
    assert ramp[16, :, 0] == pytest.approx((np.arange(32) + 0.5) / 32, abs=2e-2)
    by_default = pixels(Mesh(vtk_square(cells=[3])))[16, 16, :3]
    assert by_default == pytest.approx(halflight.transfer.colormap_points("viridis")[0][1:], abs=1e-4)
    assert pixels(Mesh(vtk_square([0, 1, 1, 0]), color=(1, 0, 0)))[16, 16, :3] == pytest.approx([1, 0, 0], abs=1e-5)
    assert pixels(Mesh(vtk_square([0, 1, 1, 0]), scalars=False, color=1))[16, 16, :3] == pytest.approx([1, 1, 1], abs=1e-5)
    named = pixels(Mesh(vtk_square([0, 1, 1, 0]), scalars="values", cmap=["black", "white"]))
    assert np.array_equal(named, ramp)
    with pytest.raises(ValueError, match=r"the mesh has no array 'vlaues': did you mean 'values'\?"):
        Mesh(vtk_square([0, 1, 1, 0]), scalars="vlaues")
    with pytest.raises(TypeError, match="of which the mesh has none active"):
        Mesh(vtk_square(), cmap="viridis")


def test_vtk_lines_points_and_other_grids():
    pytest.importorskip("vtkmodules")
    from vtkmodules.util.numpy_support import numpy_to_vtk
    from vtkmodules.vtkCommonCore import vtkPoints
    from vtkmodules.vtkCommonDataModel import VTK_VOXEL, vtkCellArray, vtkPolyData, vtkUnstructuredGrid

    points, lines, verts, data = vtkPoints(), vtkCellArray(), vtkCellArray(), vtkPolyData()
    for corner in ((0, 10, 0), (10, 10, 0), (20, 10, 0), (10, 17, 0)):
        points.InsertNextPoint(corner)
    lines.InsertNextCell(3)
    for n in range(3):
        lines.InsertCellPoint(n)
    verts.InsertNextCell(1)
    verts.InsertCellPoint(3)
    data.SetPoints(points)
    data.SetLines(lines)
    data.SetVerts(verts)
    array = numpy_to_vtk(np.array([0.0, 1.0]), deep=True)  # cells: the point, then the line
    array.SetName("kind")
    data.GetCellData().SetScalars(array)
    shown = pixels(Mesh(data, cmap=["red", "lime"], radius=2))
    assert shown[16, 16, :3] == pytest.approx([0, 1, 0], abs=1e-4) and shown[5, 16, :3] == pytest.approx([1, 0, 0], abs=1e-4)
    assert Mesh(data).triangle_count > 0  # a radius is chosen
    grid, corners = vtkUnstructuredGrid(), vtkPoints()
    for n in range(8):
        corners.InsertNextPoint(20 * (n & 1), 20 * (n >> 1 & 1), -20 * (n >> 2))
    grid.SetPoints(corners)
    grid.InsertNextCell(VTK_VOXEL, 8, list(range(8)))
    assert Mesh(grid).triangle_count == 12 and pixels(Mesh(grid, color=1))[16, 16, 3] == 1


def test_trimesh_and_meshio_bring_their_colours():
    visual = types.SimpleNamespace(kind="vertex", vertex_colors=np.full((4, 4), (188, 0, 0, 255), np.uint8))
    mesh = types.SimpleNamespace(vertices=SQUARE, faces=TRIANGLES, visual=visual)
    assert pixels(Mesh(mesh))[16, 16, :3] == pytest.approx([0.5029, 0, 0], abs=1e-3)
    filed = types.SimpleNamespace(points=SQUARE, cells_dict={"quad": np.array([(0, 1, 2, 3)])}, point_data={"t": np.array([0, 1, 1, 0.0])},
                                  cell_data_dict={"kind": {"quad": np.array([4.0])}})
    assert pixels(Mesh(filed, scalars="t", cmap=["black", "white"]))[16, 16, 0] == pytest.approx(0.5, abs=3e-2)
    assert Mesh(filed, scalars="kind").triangle_count == 2
    assert Mesh(filed, color="red").look["color"] == "red"


def test_real_trimesh_and_meshio():
    trimesh = pytest.importorskip("trimesh")
    box = trimesh.creation.box((8, 8, 8))
    box.visual.vertex_colors = np.full((len(box.vertices), 4), (0, 188, 0, 255), np.uint8)
    assert pixels(Mesh(box, translate=(10, 10, 0)))[16, 16, :3] == pytest.approx([0, 0.5029, 0], abs=1e-3)
    meshio = pytest.importorskip("meshio")
    square = meshio.Mesh(SQUARE, [("triangle", np.array(TRIANGLES))], point_data={"t": np.array([0, 1, 1, 0.0])},
                         cell_data={"kind": [np.array([1.0, 2.0])]})
    assert pixels(Mesh(square, scalars="kind", cmap=["red", "blue"]))[4, 8, :3] == pytest.approx([0, 0, 1], abs=1e-4)
