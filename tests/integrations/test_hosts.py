"""ParaView, Slicer's converters, Blender, yt, pynbody, folders of masks, Snakemake and Nextflow: with the real programs where they are installed."""
import os
import pathlib
import shutil
import subprocess
import sys

import numpy as np
import pytest
from conftest import side_by_side

import halflight

ROOT = pathlib.Path(__file__).resolve().parents[2]
FOLDER = ROOT / "integrations"
PACKAGES = os.path.dirname(os.path.dirname(halflight.__file__))


def code_of(name):
    """The module of a host's folder."""
    import importlib.util

    path = next((FOLDER / name).rglob("*alflight*.py"))
    spec = importlib.util.spec_from_file_location(path.stem + "_under_test", path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def environment(*folders):
    return os.environ | {"PYTHONPATH": os.pathsep.join([PACKAGES, *map(str, folders), os.environ.get("PYTHONPATH", "")])}


def read_png(path):
    from PIL import Image

    return np.asarray(Image.open(path).convert("RGB"))


@pytest.mark.parametrize("name", sorted(path.name for path in FOLDER.iterdir() if path.is_dir()))
def test_each_host_has_its_page(name):
    lines = (FOLDER / name / "README.md").read_text().splitlines()
    assert 8 <= len(lines) <= 16 and lines[0].startswith("# ")
    picture = next(line for line in lines if line.startswith("!["))
    assert (FOLDER / name / picture.partition("](")[2].rstrip(")")).resolve().is_file()


# ---- ParaView

PARAVIEW = """
import sys
import numpy as np
from paraview import simple
from vtkmodules.util.numpy_support import vtk_to_numpy
import halflight, halflight_paraview
view = simple.CreateView("RenderView")
view.ViewSize = [400, 300]
view.OrientationAxesVisibility = 0
wavelet = simple.Wavelet(WholeExtent=[-15, 15, -15, 15, -15, 15])
shown = simple.Show(wavelet, view, "UniformGridRepresentation")
shown.SetRepresentationType("Volume")
simple.ColorBy(shown, ("POINTS", "RTData"))
ball = simple.Show(simple.Sphere(Center=[22, 4, 0], Radius=6, ThetaResolution=40, PhiResolution=40), view)
ball.DiffuseColor = ball.AmbientColor = [1, 0.5, 0.2]
contour = simple.Contour(wavelet, ContourBy=["POINTS", "RTData"], Isosurfaces=[200])
contour = simple.Show(simple.Transform(contour, Transform="Transform"), view)
simple.ResetCamera(view)
view.CameraPosition = [-20, -70, 60]
view.CameraViewUp = [0, 0, 1]
simple.ResetCamera(view)
simple.Render(view)
simple.SaveScreenshot(sys.argv[1] + "/host.png", view)
halflight_paraview.save_picture(sys.argv[1] + "/mine.png", view)
import inspect
if not hasattr(inspect, "getargspec"):  # ParaView 5.11 was made for Python 3.10
    inspect.getargspec = inspect.getfullargspec
simple.LoadPlugin(sys.argv[2], remote=False, ns=globals())
picture = HalflightPicture(wavelet)
picture.Size = [64, 48]
picture.UpdatePipeline()
data = simple.servermanager.Fetch(picture)
expected = halflight.render(simple.servermanager.Fetch(wavelet), size=(64, 48)).to_srgb8()
found = vtk_to_numpy(data.GetPointData().GetArray("picture")).reshape(48, 64, 4)[::-1]
assert np.array_equal(found, expected)
print(repr(halflight_paraview.scene_of(view)))
"""


def test_paraview(tmp_path, pictures):
    program = os.environ.get("HALFLIGHT_PVPYTHON") or shutil.which("pvpython")
    if not program:
        pytest.skip("pvpython is not installed: HALFLIGHT_PVPYTHON names another one")
    (tmp_path / "script.py").write_text(PARAVIEW)
    ran = subprocess.run([program, tmp_path / "script.py", tmp_path, FOLDER / "paraview" / "halflight_paraview.py"], capture_output=True, text=True,
                         env=environment(FOLDER / "paraview"))
    assert ran.returncode == 0, ran.stderr
    assert "<halflight.Scene 400x300, 1 volume, 2 meshes," in ran.stdout
    host, mine = read_png(tmp_path / "host.png"), read_png(tmp_path / "mine.png")
    seen, shown = (abs(one.astype(int) - one[0, 0]).max(axis=-1) > 40 for one in (host, mine))
    assert host.shape == mine.shape and (seen & shown).sum() > 0.9 * (seen | shown).sum()
    if pictures is not None:
        side_by_side(pictures / "paraview.png", host, mine)


# ---- 3D Slicer


def test_slicer_s_converters(pictures):
    pytest.importorskip("vtkmodules.vtkRenderingVolumeOpenGL2")
    from vtkmodules.util.numpy_support import numpy_to_vtk
    from vtkmodules.vtkCommonDataModel import vtkImageData, vtkPiecewiseFunction, vtkPlane, vtkPlaneCollection
    from vtkmodules.vtkCommonMath import vtkMatrix4x4
    from vtkmodules.vtkFiltersSources import vtkSphereSource
    from vtkmodules.vtkRenderingCore import (vtkActor, vtkColorTransferFunction, vtkPolyDataMapper, vtkRenderer, vtkRenderWindow, vtkVolume,
                                             vtkVolumeProperty, vtkWindowToImageFilter)
    from vtkmodules.vtkRenderingVolume import vtkGPUVolumeRayCastMapper

    slicer = code_of("slicer")
    # As Slicer has it: voxels without a place, in the world by the volume's own matrix; a ROI by six planes.
    z, y, x = np.mgrid[-1:1:40j, -1:1:50j, -1:1:60j]
    voxels = (1000 * np.exp(-3 * (x**2 + y**2 + z**2)) * (np.cos(9 * x) * np.cos(9 * y) > -0.3) - 200).astype(np.int16)
    image = vtkImageData()
    image.SetDimensions(60, 50, 40)
    image.GetPointData().SetScalars(numpy_to_vtk(voxels.ravel(), deep=True))
    matrix = vtkMatrix4x4()
    for row, values in enumerate(((-1, 0, 0, 30), (0, -1, 0, 25), (0, 0, 1.5, -30), (0, 0, 0, 1))):  # LPS files in a RAS world
        for column, value in enumerate(values):
            matrix.SetElement(row, column, value)
    opacity, color, prop = vtkPiecewiseFunction(), vtkColorTransferFunction(), vtkVolumeProperty()
    opacity.AddPoint(100, 0)
    opacity.AddPoint(200, 0.9)
    color.AddRGBPoint(100, 0.8, 0.3, 0.2)
    color.AddRGBPoint(800, 1, 0.9, 0.8)
    prop.SetScalarOpacity(opacity)
    prop.SetColor(color)
    prop.ShadeOn()
    prop.SetInterpolationTypeToLinear()

    class Node:
        """What the converters ask MRML nodes."""

        GetImageData, GetName, GetVolumeProperty = staticmethod(lambda: image), staticmethod(lambda: "CT"), staticmethod(lambda: prop)
        GetIJKToRASMatrix = staticmethod(lambda found: found.DeepCopy(matrix))

        @staticmethod
        def GetVolumePropertyNode():
            return Node

    volume = slicer.volume_of(Node, Node)
    assert np.array_equal(np.asarray(volume), voxels) and volume.affine.tolist()[0] == [-1, 0, 0, 30] and volume.look["name"] == "CT"
    assert volume.look["transfer_function"] == slicer.transfer_function_of(Node) == halflight.TransferFunction.from_vtk(prop)

    mapper, actor, renderer, window = vtkGPUVolumeRayCastMapper(), vtkVolume(), vtkRenderer(), vtkRenderWindow()
    mapper.SetInputData(image)
    planes, plane = vtkPlaneCollection(), vtkPlane()
    plane.SetOrigin(0, 5, 0)
    plane.SetNormal(0, 1, 0)
    planes.AddItem(plane)
    mapper.SetClippingPlanes(planes)
    actor.SetMapper(mapper)
    actor.SetProperty(prop)
    actor.SetUserMatrix(matrix)
    renderer.AddViewProp(actor)
    ball, ball_mapper, model = vtkSphereSource(), vtkPolyDataMapper(), vtkActor()
    ball.SetCenter(20, 20, 25)
    ball.SetRadius(7)
    ball.SetThetaResolution(40)
    ball.SetPhiResolution(40)
    ball_mapper.SetInputConnection(ball.GetOutputPort())
    model.SetMapper(ball_mapper)
    model.GetProperty().SetColor(0.5, 0.9, 0.5)
    renderer.AddViewProp(model)
    renderer.SetBackground(0.75, 0.75, 0.95)
    window.SetOffScreenRendering(1)
    window.SetMultiSamples(0)
    window.SetSize(400, 300)
    window.AddRenderer(renderer)
    renderer.GetActiveCamera().SetPosition(30, -200, 80)
    renderer.GetActiveCamera().SetViewUp(0, 0, 1)
    renderer.ResetCamera()
    window.Render()
    grab = vtkWindowToImageFilter()
    grab.SetInput(window)
    grab.Update()
    from vtkmodules.util.numpy_support import vtk_to_numpy

    host = vtk_to_numpy(grab.GetOutput().GetPointData().GetScalars()).reshape(300, 400, -1)[::-1, :, :3]
    scene = slicer.scene_of_view(renderer, (400, 300))
    assert scene.volumes[0].affine.tolist() == volume.affine.tolist() and scene.volumes[0].look["cuts"][0]["normal"] == (0, -1, 0)
    mine = halflight.Renderer().render(scene).to_srgb8()
    seen, shown = (abs(one[..., :3].astype(int) - one[0, 0, :3]).max(axis=-1) > 60 for one in (host, mine))
    assert (seen & shown).sum() > 0.9 * (seen | shown).sum()
    if pictures is not None:
        side_by_side(pictures / "slicer.png", host, mine)


# ---- Blender

BLENDER = """
import sys
sys.path[:0] = sys.argv[sys.argv.index("--") + 2:]
import bpy, halflight_blender, halflight, numpy as np
out = sys.argv[sys.argv.index("--") + 1]
halflight_blender.register()
scene = bpy.context.scene
for item in list(bpy.data.objects):
    bpy.data.objects.remove(item)
bpy.ops.mesh.primitive_plane_add(size=12, location=(0, 0, 0))
bpy.ops.mesh.primitive_monkey_add(size=2, location=(-1.2, 0, 1.2), rotation=(0, 0, 0.5))
monkey = bpy.context.object
bpy.ops.object.shade_smooth()
monkey.modifiers.new("fine", "SUBSURF").render_levels = 2
material = bpy.data.materials.new("red")
material.use_nodes = True
material.node_tree.nodes["Principled BSDF"].inputs["Base Color"].default_value = (0.6, 0.1, 0.05, 1)
monkey.data.materials.append(material)
bpy.ops.object.light_add(type="SUN", rotation=(0.6, 0.5, 0))
bpy.context.object.data.energy = 3
bpy.context.object.data.angle = 0.1
bpy.ops.object.camera_add(location=(5, -9, 6), rotation=(1.04, 0, 0.5))
scene.camera = bpy.context.object
scene.render.resolution_x, scene.render.resolution_y = 400, 300
z, y, x = np.mgrid[-1:1:32j, -1:1:32j, -1:1:32j]
smoke = halflight.Volume(np.clip(1.2 - np.sqrt(x**2 + y**2 + z**2) + 0.3 * np.sin(9 * x) * np.cos(8 * y), 0, 1).astype(np.float32),
                         affine=[[0.07, 0, 0, 1], [0, 0.07, 0, -1], [0, 0, 0.07, 0.3], [0, 0, 0, 1]], shading="none",
                         transfer_function=halflight.TransferFunction([(0.4, 0), (1, 0.6)], (0.9, 0.9, 1), 0.3))
image = halflight_blender.render_to_image(bpy.context, volumes=[smoke])
assert tuple(image.size) == (400, 300)
pixels = np.array(image.pixels[:], np.float32).reshape(300, 400, 4)[::-1]
np.save(out + "/pixels.npy", pixels)
halflight.Renderer().render(halflight_blender.scene_of(bpy.context, volumes=[smoke])).save(out + "/mine.png")
from bpy_extras.object_utils import world_to_camera_view
places = [(-1.2, 0, 1.2), (3, 2, 0), (-4, 4, 0), (1, 1, 3)]
np.save(out + "/places.npy", places)
np.save(out + "/seen.npy", [tuple(world_to_camera_view(scene, scene.camera, __import__("mathutils").Vector(place))) for place in places])
camera = halflight_blender.scene_of(bpy.context).camera
np.save(out + "/camera.npy", [camera.position, camera.target, camera.up, (camera.fovy_deg, 0, 0)])
bpy.ops.render.halflight()
assert bpy.data.images["Halflight"].is_float
halflight_blender.unregister()
"""


def test_blender(tmp_path, pictures):
    program = os.environ.get("HALFLIGHT_BLENDER") or shutil.which("blender")
    if not program:
        pytest.skip("blender is not installed")
    (tmp_path / "script.py").write_text(BLENDER)
    version = subprocess.run([program, "-b", "--python-expr", "import sys; print(sys.version_info[:2])"], capture_output=True, text=True)
    ran = subprocess.run([program, "-b", "--factory-startup", "--python-exit-code", "3", "--python", tmp_path / "script.py", "--", tmp_path,
                          PACKAGES, FOLDER / "blender"], capture_output=True, text=True, env={k: v for k, v in os.environ.items() if k != "PYTHONPATH"})
    assert ran.returncode == 0, version.stdout + ran.stdout[-2000:] + ran.stderr[-2000:]
    position, target, up, (fovy, _, _) = np.load(tmp_path / "camera.npy")
    forward = (target - position) / np.linalg.norm(target - position)
    right = np.cross(forward, up) / np.linalg.norm(np.cross(forward, up))
    top = np.cross(right, forward)
    for place, (u, v, depth) in zip(np.load(tmp_path / "places.npy"), np.load(tmp_path / "seen.npy"), strict=True):
        away = place - position
        half = np.tan(np.radians(fovy) / 2) * (away @ forward)
        assert away @ forward == pytest.approx(depth, rel=1e-4)
        assert (away @ top / half + 1) / 2 == pytest.approx(v, abs=1e-3) and (away @ right / (half * 4 / 3) + 1) / 2 == pytest.approx(u, abs=1e-3)
    pixels = np.load(tmp_path / "pixels.npy")
    assert pixels[..., 3].mean() > 0.2 and pixels[..., :3].std() > 0.05
    if pictures is not None:
        shutil.copy(tmp_path / "mine.png", pictures / "blender.png")


# ---- yt, pynbody


def test_yt(pictures):
    yt = pytest.importorskip("yt")
    yt.set_log_level(50)
    z, y, x = np.mgrid[-1:1:48j, -1:1:32j, -1:1:40j]
    density = (np.exp(-3 * (x**2 + 2 * y**2 + z**2)) * (1.2 + np.sin(7 * x) * np.cos(6 * z))).transpose(2, 1, 0)  # [x][y][z]
    data = yt.load_uniform_grid({("gas", "density"): (density, "g/cm**3")}, density.shape, length_unit="kpc", bbox=np.array([[-2, 3], [0, 4], [1, 7]]))
    module = code_of("yt")
    volume = module.volume_of(data, ("gas", "density"), log=False)
    assert np.allclose(np.asarray(volume), density.transpose(2, 1, 0), rtol=1e-6)
    spacing = np.array([5, 4, 6]) / density.shape
    assert np.allclose(volume.affine, np.vstack([np.column_stack([np.diag(spacing), np.array([-2, 0, 1]) + spacing / 2]), [0, 0, 0, 1]]))
    logs = module.volume_of(data, ("gas", "density"), unit="kpc")
    assert np.asarray(logs).max() == pytest.approx(np.log10(density.max()), abs=1e-5)
    box = data.box(data.arr([-2, 0, 1], "kpc"), data.arr([0.5, 4, 4], "kpc"))
    assert module.volume_of(box, ("gas", "density"), log=False).dimensions == (20, 32, 24)
    levels = [{"left_edge": [0, 0, 0], "right_edge": [1, 1, 1], "level": 0, "dimensions": [16, 16, 16], ("gas", "density"): (np.ones((16, 16, 16)), "g/cm**3")},
              {"left_edge": [0.25] * 3, "right_edge": [0.5] * 3, "level": 1, "dimensions": [8, 8, 8], ("gas", "density"): (np.full((8, 8, 8), 5.0), "g/cm**3")}]
    refined = yt.load_amr_grids(levels, [16, 16, 16])
    adaptive = module.volume_of(refined, ("gas", "density"), log=False)
    box = np.asarray(module.volume_of(refined, ("gas", "density"), log=False, level=1))
    assert adaptive.dimensions == box.shape == (32, 32, 32) and np.array_equal(adaptive.affine[:3, 3], [1 / 64] * 3)
    assert abs(np.asarray(adaptive)[[12, 2], [12, 2], [12, 2]] - [5, 1]).max() < 1e-6
    away = np.ones((32, 32, 32), bool)
    away[4:20, 4:20, 4:20] = False  # around the patch the field turns from 1 to 5
    away[11:13, 11:13, 11:13] = True
    assert abs(np.asarray(adaptive) - box)[away].max() < 1e-6
    if pictures is not None:
        halflight.render(volume, cmap="inferno", shade="none", size=(400, 300)).save(pictures / "yt.png")


RAMSES_INFO = """ncpu        = 1
ndim        = 3
levelmin    = 4
levelmax    = 6
ngridmax    = 100000
nstep_coarse= 1

boxlen      = 2
time        = 0
aexp        = 1
H0          = 1
omega_m     = 1
omega_l     = 0
omega_k     = 0
omega_b     = 0
unit_l      = 1
unit_d      = 1
unit_t      = 1

ordering type=hilbert
 DOMAIN ind_min ind_max
 1 0.0 2097152.0
"""


def write_ramses(folder, is_split, density):
    """An output of RAMSES, of one processor, with the octs of six levels. The octs of level n are 2^-(n-1) wide in the box from 0 to 1, and
    `is_split` tells which cells of levels 4 and 5 hold octs of the next level. It gives the number of octs of each level."""
    folder.mkdir()
    (folder / "info_00001.txt").write_text(RAMSES_INFO)
    octs = [np.array([[0.5] * 3])]
    corners = np.array([[n & 1, n >> 1 & 1, n >> 2] for n in range(8)]) - 0.5
    for level in range(1, 6):
        cells = (octs[-1][:, None] + corners * 0.5**level).reshape(-1, 3)
        octs.append(cells if level < 4 else cells[is_split(level, cells)])
    counts = [len(one) for one in octs]

    def record(file, values, kind):
        body = np.asarray(values, kind).tobytes()
        file.write(np.int32(len(body)).tobytes() + body + np.int32(len(body)).tobytes())

    with open(folder / "amr_00001.out00001", "wb") as file:
        for values, kind in ((1, "i4"), (3, "i4"), ([1] * 3, "i4"), (6, "i4"), (100000, "i4"), (0, "i4"), (sum(counts), "i4"), (2, "f8"), ([1] * 3, "i4"),
                             (0, "f8"), (1, "f8"), (0, "f8"), ([0] * 6, "f8"), ([0] * 6, "f8"), ([1] * 2, "i4"), ([0] * 3, "f8"), ([0] * 7, "f8"),
                             ([0] * 5, "f8"), (0, "f8"), ([0] * 6, "i4"), ([0] * 6, "i4"), (counts, "i4"), ([0] * 60, "i4"), ([0] * 5, "i4")):
            record(file, values, kind)
        record(file, np.frombuffer(b"hilbert".ljust(128), "S1"), "S1")
        for values, kind in (([0, 1 << 21], "f8"), (0, "i4"), (0, "i4"), (1, "i4")):  # keys of the domains; son, flag1, cpu_map
            record(file, values, kind)
        for places in octs:
            for kind, columns in (("i4", [np.arange(len(places))] * 3), ("f8", places.T), ("i4", [np.zeros(len(places))] * 31)):
                for column in columns:
                    record(file, column, kind)
    with open(folder / "hydro_00001.out00001", "wb") as file:
        for values, kind in ((1, "i4"), (5, "i4"), (3, "i4"), (6, "i4"), (0, "i4"), (1.4, "f8")):
            record(file, values, kind)
        for level, places in enumerate(octs, 1):
            record(file, level, "i4")
            record(file, len(places), "i4")
            for corner in corners:
                for variable in range(5):
                    record(file, density(places + corner * 0.5**level) if variable == 0 else np.zeros(len(places)), "f8")
    return counts


def test_yt_octree(tmp_path):
    """A linear density on an octree of RAMSES is the same linear field in the volume, across all borders of levels."""
    yt = pytest.importorskip("yt")
    yt.set_log_level(50)

    def density(places):
        return 1 + places @ [1, 2, 3]

    def is_split(level, cells):
        return np.linalg.norm(cells - [0.5, 0.55, 0.45], axis=1) < (0.3 if level == 4 else 0.17)

    counts = write_ramses(tmp_path / "output_00001", is_split, density)
    assert counts[3] == 512 and min(counts[4:]) > 100
    data = yt.load(str(tmp_path / "output_00001"))
    module = code_of("yt")
    volume = module.volume_of(data, ("ramses", "Density"), log=False)
    assert volume.dimensions == (64, 64, 64) and np.allclose(volume.info().spacing, 1 / 64)
    z, y, x = (np.indices((64, 64, 64)) + 0.5) / 64
    right = 1 + x + 2 * y + 3 * z
    within = (slice(16, 48),) * 3  # at the box's faces the values go on as they are
    assert abs(np.asarray(volume) - right)[within].max() < 2e-6
    part = module.volume_of(data.sphere([0.5, 0.55, 0.45], (0.25, "code_length")), ("ramses", "Density"), log=False)
    assert max(part.dimensions) <= 40
    assert np.array_equal(np.asarray(part.affine)[:3, 3] * 64 % 4, [0.5] * 3)
    with pytest.raises(ValueError, match="no cell"):
        module.volume_of(data.box([0.001] * 3, [0.002] * 3), ("ramses", "Density"))


def test_pynbody(pictures):
    pynbody = pytest.importorskip("pynbody")
    module = code_of("pynbody")
    rng = np.random.default_rng(5)
    angle, radius = rng.uniform(0, 2 * np.pi, 60000), rng.gamma(3, 2.2, 60000)
    arm = angle + 0.35 * np.round(radius)
    snapshot = pynbody.new(gas=60000)
    snapshot["pos"] = np.column_stack([radius * np.cos(arm + 0.4 * np.sin(2 * angle)), radius * np.sin(arm), rng.normal(0, 0.5, 60000)])
    snapshot["mass"], snapshot["temp"] = np.full(60000, 2.0), np.full(60000, 7.0)
    volume = module.volume_of(snapshot.gas, width=60, size=64, log=False)
    total = np.asarray(volume, dtype=float).sum() * np.prod(volume.info().spacing)
    assert total == pytest.approx(2.0 * (abs(np.asarray(snapshot["pos"])).max(axis=1) <= 30).sum(), rel=1e-4)
    means = np.asarray(module.volume_of(snapshot.gas, "temp", width=60, size=64, log=False))
    # Each is a quotient of two sums of floats, over some thousand particles where they are dense.
    assert np.nanmin(means) == pytest.approx(7, rel=1e-5) and np.nanmax(means) == pytest.approx(7, rel=1e-5)
    if pictures is not None:
        shown = module.volume_of(snapshot.gas, width=44, size=256)
        halflight.render(shown, camera=(20, 50), size=(400, 300)).save(pictures / "pynbody.png")


# ---- folders of masks


@pytest.fixture
def masks(tmp_path):
    """Three structures on one oblique grid, one of them empty, and a scan."""
    z, y, x = np.mgrid[-1:1:48j, -1:1:56j, -1:1:64j]
    affine = np.array([[-1.5, 0, 0, 40], [0, 1.5, 0, -40], [0, 0, 2, 10], [0, 0, 0, 1]])
    folder = tmp_path / "segmentations"
    folder.mkdir()
    found = {"liver": (x + 0.3) ** 2 / 0.3 + y**2 / 0.3 + (z - 0.1) ** 2 / 0.2 < 1, "spleen": (x - 0.6) ** 2 + y**2 + z**2 < 0.07,
             "vertebra_L1": (x**2 + (y - 0.7) ** 2 < 0.03) & (abs(z % 0.25 - 0.12) < 0.09), "gallbladder": np.zeros(x.shape, bool)}
    for name, mask in found.items():
        halflight.Volume(mask.astype(np.uint8), affine=affine).save(folder / f"{name}.nii.gz")
    halflight.Volume((200 * (x**2 + y**2 < 0.9) - 100).astype(np.int16), affine=affine).save(tmp_path / "ct.nii.gz")
    return folder, found


def test_masks(masks, tmp_path, pictures):
    folder, found = masks
    module = code_of("masks")
    volume = module.labels_of(folder)
    assert sorted(module.names_of(folder)) == ["gallbladder", "liver", "spleen", "vertebra_L1"]
    assert [int((np.asarray(volume) == n).sum()) for n in (2, 3, 4)] == [int(found[name].sum()) for name in ("liver", "spleen", "vertebra_L1")]
    shown = halflight.volume.volume_from(halflight.Scene(module.labels_of(folder, {"liver": ("red", 0.25)}))._handle, 0).look["labels"]
    assert shown == {1: ((1, 0, 0), 0.25)}
    for words, text in (({"show": {"livre": None}}, "there is no mask 'livre': use one of gallbladder, liver"), ({"show": {"gallbladder": None}}, "all masks are empty")):
        with pytest.raises(ValueError, match=text):
            module.labels_of(folder, **words)
    ran = subprocess.run([sys.executable, FOLDER / "masks" / "halflight_masks.py", folder, "-o", tmp_path / "organs.png", "--scan", tmp_path / "ct.nii.gz",
                          "--show", "liver,spleen=gold,vertebra_L1:0.9", "--size", "400x300"], capture_output=True, text=True, env=environment())
    assert ran.returncode == 0, ran.stderr
    assert read_png(tmp_path / "organs.png").std() > 10
    wrong = subprocess.run([sys.executable, FOLDER / "masks" / "halflight_masks.py", tmp_path / "nowhere"], capture_output=True, text=True, env=environment())
    assert wrong.returncode == 1 and wrong.stderr.startswith("halflight_masks.py: ")
    if pictures is not None:
        shutil.copy(tmp_path / "organs.png", pictures / "masks.png")


# ---- workflows


def test_snakemake(tmp_path, pictures):
    pytest.importorskip("snakemake")
    z, y, x = np.mgrid[-1:1:40j, -1:1:40j, -1:1:40j]
    np.save(tmp_path / "blob.npy", (np.sin(5 * x) * np.cos(5 * y) + np.sin(5 * y) * np.cos(5 * z) + np.sin(5 * z) * np.cos(5 * x)).astype(np.float32))
    (tmp_path / "Snakefile").write_text(f"""
rule all:
    input: "blob.png", "blob.json"
rule picture:
    input: "{{name}}.npy"
    output: "{{name}}.png"
    params: options="--size 400x300 --iso 0.3"
    log: "{{name}}.log"
    threads: 2
    wrapper: "file:{FOLDER / 'snakemake' / 'halflight'}"
rule info:
    input: "{{name}}.npy"
    output: "{{name}}.json"
    params: command="info"
    wrapper: "file:{FOLDER / 'snakemake' / 'halflight'}"
""")
    (tmp_path / "bin").mkdir()
    (tmp_path / "bin" / "halflight").symlink_to(os.environ["HALFLIGHT_PROGRAM"])
    ran = subprocess.run([sys.executable, "-m", "snakemake", "--cores", "2", "--quiet"], cwd=tmp_path, capture_output=True, text=True,
                         env=environment() | {"PATH": f"{tmp_path / 'bin'}:{os.path.dirname(sys.executable)}:{os.environ['PATH']}"})
    assert ran.returncode == 0, ran.stderr[-2000:]
    assert read_png(tmp_path / "blob.png").shape == (300, 400, 3) and '"dimensions"' in (tmp_path / "blob.json").read_text()
    if pictures is not None:
        shutil.copy(tmp_path / "blob.png", pictures / "snakemake.png")


def test_nextflow_s_script(tmp_path):
    """The module's shell script, with Nextflow's variables filled in; Nextflow itself where it is installed."""
    text = (FOLDER / "nextflow" / "main.nf").read_text()
    script = text.split('"""')[1].replace("${volume}", "blob.npy").replace("${task.cpus}", "1").replace("${options}", "--size 32x24").replace("${meta.id}", "blob")
    script = script.replace("${task.process}", "RENDER").replace("\\$", "$").replace("\\\\n", "\\n")
    np.save(tmp_path / "blob.npy", np.ones((8, 8, 8), np.uint8))
    (tmp_path / "bin").mkdir()
    (tmp_path / "bin" / "halflight").symlink_to(os.environ["HALFLIGHT_PROGRAM"])
    ran = subprocess.run(["bash", "-eu", "-c", script], cwd=tmp_path, capture_output=True, text=True, env=os.environ | {"PATH": f"{tmp_path / 'bin'}:{os.environ['PATH']}"})
    assert ran.returncode == 0, ran.stderr
    assert read_png(tmp_path / "blob.png").shape == (24, 32, 3)
    assert (tmp_path / "versions.yml").read_text() == f'"RENDER":\n    halflight: {halflight.__version__}\n'


def test_nextflow_s_module_is_groovy():
    """Nextflow's language is Groovy, whose own parser finds the process and its blocks."""
    if shutil.which("groovy") is None or shutil.which("java") is None:
        pytest.skip("groovy and java are not installed")
    java = pathlib.Path(shutil.which("java")).resolve().parents[1]
    ran = subprocess.run(["groovy", pathlib.Path(__file__).parent / "nextflow_processes.groovy", FOLDER / "nextflow" / "main.nf"], capture_output=True, text=True,
                         env=os.environ | {"JAVA_HOME": str(java)})
    assert ran.returncode == 0, ran.stderr
    assert ran.stdout == "process HALFLIGHT_RENDER: input output script stub\n"


def test_nextflow(tmp_path):
    if shutil.which("nextflow") is None or shutil.which("java") is None:
        pytest.skip("nextflow and java are not installed")
    np.save(tmp_path / "blob.npy", np.ones((8, 8, 8), np.uint8))
    ran = subprocess.run(["nextflow", "run", FOLDER / "nextflow" / "main.nf", "--volumes", tmp_path / "blob.npy"], cwd=tmp_path, capture_output=True, text=True)
    assert ran.returncode == 0, ran.stdout
