"""Meshes among volumes."""
import subprocess
import types

import numpy as np
import pytest

import halflight
from halflight import Camera, Mesh, Renderer, Scene, TransferFunction, Volume

SQUARE = [(0, 0, 0), (20, 0, 0), (20, 20, 0), (0, 20, 0)]
TRIANGLES = [(0, 1, 2), (0, 2, 3)]
STL = """solid square
facet normal 0 0 1 outer loop vertex 0 0 0 vertex 20 0 0 vertex 20 20 0 endloop endfacet
facet normal 0 0 1 outer loop vertex 0 0 0 vertex 20 20 0 vertex 0 20 0 endloop endfacet
endsolid
"""


@pytest.fixture
def clear():
    """A volume of which nothing is seen, and a camera that looks straight down on the square."""
    volume = Volume(np.ones((6, 21, 21), np.uint8), transfer_function=TransferFunction([(0, 0)]))
    return Scene(volume, size=(32, 32), lights=[], ambient=1,
                 camera=Camera(position=(10, 10, 90), target=(10, 10, 0), up=(0, 1, 0), height=10))


def middle(scene):
    return np.asarray(Renderer().render(scene))[16, 16]


def test_a_mesh_has_its_colour_and_opacity(clear):
    mesh = Mesh(SQUARE, TRIANGLES, color=(0.5, 0.25, 0.125), opacity=0.25)
    assert middle(clear.replace(meshes=mesh)) == pytest.approx([0.125, 0.0625, 0.03125, 0.25], abs=1e-5)
    # sRGB 188 is linear 0.5029; given as uint8 with half opacity.
    painted = Mesh(SQUARE, TRIANGLES, colors=np.full((4, 4), (188, 0, 0, 255), np.uint8), color=1)
    assert middle(clear.replace(meshes=painted)) == pytest.approx([0.5029, 0, 0, 1], abs=1e-3)
    assert middle(clear.replace(meshes=[])) == pytest.approx([0, 0, 0, 0])


def test_a_mesh_shades_a_volume(blob):
    scene = Scene(blob, size=(48, 40), shadows="hard", lights=halflight.Directional(direction=(0, 0, -1)))
    roof = Mesh([(-40, -40, 40), (60, -40, 40), (60, 60, 40), (-40, 60, 40)], TRIANGLES, visible=False)
    lit, shaded = (np.asarray(Renderer().render(one))[..., :3].sum() for one in (scene, scene.replace(meshes=roof)))
    assert shaded < 0.8 * lit


def test_files_and_scenes_are_the_program_s(program, tmp_path, blob):
    (tmp_path / "square.stl").write_text(STL)
    np.save(tmp_path / "blob.npy", blob)
    mesh = Mesh(tmp_path / "square.stl", color="navy", name="floor", diffuse=0.5, translate=(1, 2, -3))
    assert mesh.triangle_count == 2
    scene = Scene(str(tmp_path / "blob.npy"), size=(48, 40), meshes=[mesh])
    (tmp_path / "scene.json").write_text(scene.to_json())
    again = Scene.load(tmp_path / "scene.json")
    assert again.meshes[0].look["name"] == "floor" and again.meshes[0].look["translate"] == (1, 2, -3)
    picture = np.asarray(Renderer().render(scene))
    assert np.array_equal(picture, np.asarray(Renderer().render(again.replace(meshes=again.meshes))))
    subprocess.run([program, "render", tmp_path / "scene.json", "--quiet", "-o", tmp_path / "c.npy"], check=True)
    assert np.array_equal(np.load(tmp_path / "c.npy"), picture)
    assert np.array_equal(picture, np.asarray(halflight.render(tmp_path / "blob.npy", size=(48, 40), meshes=mesh)))


def test_meshes_of_other_packages(clear):
    expected = middle(clear.replace(meshes=Mesh(SQUARE, TRIANGLES)))
    faces = np.hstack([np.full((2, 1), 3), TRIANGLES]).ravel()
    polydata = types.SimpleNamespace(points=np.array(SQUARE), faces=faces)
    polydata.triangulate = lambda: polydata
    for source in (polydata, types.SimpleNamespace(vertices=SQUARE, faces=TRIANGLES),
                   types.SimpleNamespace(points=SQUARE, cells_dict={"triangle": TRIANGLES})):
        assert np.array_equal(middle(clear.replace(meshes=Mesh(source))), expected)


def test_pyvista(clear):
    pyvista = pytest.importorskip("pyvista")
    plane = pyvista.Plane(center=(10, 10, 0), i_size=20, j_size=20, i_resolution=1, j_resolution=1)
    assert middle(clear.replace(meshes=Mesh(plane))) == pytest.approx(
        middle(clear.replace(meshes=Mesh(SQUARE, TRIANGLES))), abs=1e-5)


def test_spheres_lines_and_floors(clear):
    red = Mesh(spheres=[(10, 10, 0)], radius=8, sphere_colors=[(0.5, 0, 0)], color=1)
    assert middle(clear.replace(meshes=red)) == pytest.approx([0.5, 0, 0, 1], abs=1e-5)
    glass = Mesh(spheres=[(10, 10, 0, 8)], opacity=0.5, color=1)
    assert middle(clear.replace(meshes=glass))[3] == pytest.approx(0.75, abs=1e-5)
    tube = Mesh(lines=[[(0, 10, 0), (20, 10, 0)]], radius=4, line_colors=[(0, 1, 0), (0, 0.5, 0)], color=1)
    halfway = 0.75 - 0.5 * (10 / 32 / 2) / 20  # at the pixel's middle
    assert middle(clear.replace(meshes=tube)) == pytest.approx([0, halfway, 0, 1], abs=1e-4)
    faces = Mesh(SQUARE, TRIANGLES, face_colors=[(0, 0, 0.25), (0, 0, 0.25)], color=1)
    assert middle(clear.replace(meshes=faces)) == pytest.approx([0, 0, 0.25, 1], abs=1e-5)
    standing = clear.replace(meshes=red)
    assert Mesh.floor(standing, 2).triangle_count == 2
    for wrong, text in (({"spheres": [(0, 0, 0)]}, "rows of three numbers need radius="), ({}, "give a file"),
                        ({"spheres": [(0, 0, 0, 1)], "sphere_colors": [(1, 1, 1)] * 2}, "2 rows for 1 spheres")):
        with pytest.raises((TypeError, ValueError), match=text):
            Mesh(**wrong)


def test_surfaces_of_volumes_are_written(tmp_path):
    """The kernel turns the distance r from the middle into r + 1 / (3 r) (derived: a sixth of the Laplacian, 2 / r, is added)."""
    x, y, z = np.ogrid[-9:10, -9:10, -9:10]
    ball = Mesh.isosurface(Volume((6 - np.sqrt(x * x + y * y + z * z)).astype(np.float32), spacing=2), 0, color="gold")
    vertices, arrays = ball._arrays()
    one, two, three = (vertices[arrays["triangles"][:, corner]].astype(float) for corner in range(3))
    radius = (6 + np.sqrt(36 - 4 / 3)) / 2 * 2  # of the two solutions the greater one, in voxels of 2
    assert abs(np.einsum("ij,ij", one, np.cross(two, three))) / 6 == pytest.approx(4 / 3 * np.pi * radius**3, rel=0.01)
    for name in ("ball.stl", "ball.ply", "ball.obj"):
        ball.save(tmp_path / name)
        assert Mesh(tmp_path / name).triangle_count == ball.triangle_count
    with pytest.raises(NotImplementedError, match=r"ball\.step"):
        ball.save(tmp_path / "ball.step")
    with pytest.raises(ValueError, match="value"):
        Mesh.isosurface(np.zeros((4, 4, 4), np.float32), 3)
