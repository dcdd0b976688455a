"""napari's layers by Halflight, in a real napari on a virtual screen, and beside its own picture."""
import pathlib
import sys

import numpy as np
import pytest
from conftest import check_silhouettes, side_by_side

import halflight

napari = pytest.importorskip("napari")
PLUGIN = pathlib.Path(__file__).resolve().parents[2] / "integrations" / "napari"
sys.path.insert(0, str(PLUGIN))
import napari_halflight  # noqa: E402
from napari.components import ViewerModel  # noqa: E402


@pytest.fixture
def viewer():
    made = ViewerModel(ndisplay=3)
    if hasattr(made, "canvas"):
        made.canvas.size = (300, 400)
    else:
        made._canvas_size = (300, 400)
    return made


def blob(shape=(24, 30, 36)):
    z, y, x = (np.linspace(-1, 1, size) for size in shape)
    return (255 * np.exp(-4 * (x**2 + y[:, None] ** 2 + z[:, None, None] ** 2))).astype(np.uint8)


def test_the_manifest_is_valid():
    npe2 = pytest.importorskip("npe2")
    manifest = npe2.PluginManifest.from_file(PLUGIN / "napari_halflight" / "napari.yaml")
    assert manifest.name == "napari-halflight" and [one.display_name for one in manifest.contributions.widgets] == ["Light and shadows"]
    module, _, name = manifest.contributions.commands[0].python_name.partition(":")
    assert (PLUGIN / (module.replace(".", "/") + ".py")).read_text().count(f"class {name}(") == 1


def test_images_have_their_place_and_colours(viewer):
    layer = viewer.add_image(blob(), colormap="magma", contrast_limits=(60, 200), gamma=0.8, scale=(2, 1, 0.5), translate=(5, 6, 7), opacity=0.7)
    scene = napari_halflight.scene_of(viewer)
    volume = scene.volumes[0]
    assert np.array_equal(np.asarray(volume), blob()) and np.allclose(abs(volume.affine), abs(np.array([[0.5, 0, 0, 7], [0, 1, 0, 6], [0, 0, 2, 5], [0, 0, 0, 1]])))
    function = volume.look["transfer_function"]
    assert function.opacity[0].tolist() == [60, 0] and function.opacity[-1].tolist() == [200, pytest.approx(0.7)]
    assert halflight.colors.to_srgb(function.color[-1, 1:]) == pytest.approx(layer.colormap.map([1.0])[0][:3], abs=1e-3)
    assert scene.size == (400, 300)
    viewer.layers[0].visible = False
    with pytest.raises(ValueError, match="no visible layer has anything to show"):
        napari_halflight.scene_of(viewer)


def test_sliders_choose_the_slice(viewer):
    frames = np.stack([np.zeros_like(blob()), blob(), 255 - blob()])
    viewer.add_image(frames)
    viewer.add_points([(1, 10, 10, 10), (2, 10, 10, 10)], size=4)
    viewer.dims.set_point(0, 1)
    scene = napari_halflight.scene_of(viewer)
    assert np.array_equal(np.asarray(scene.volumes[0]), frames[1]) and len(scene.meshes) == 1
    assert scene.meshes[0]._arrays()[1]["spheres"].shape == (1, 4)
    viewer.dims.set_point(0, 2)
    assert np.array_equal(np.asarray(napari_halflight.scene_of(viewer).volumes[0]), frames[2])


def test_labels_points_surfaces_shapes_tracks_and_vectors(viewer):
    seg = np.zeros((24, 30, 36), np.uint8)
    seg[6:12, 8:20, 8:20], seg[14:20, 8:20, 8:20] = 1, 5
    labels = viewer.add_labels(seg, opacity=0.5)
    shown = napari_halflight.scene_of(viewer).volumes[0].look["labels"]
    assert shown.keys() == {1, 5} and shown[5][1] == 0.5
    assert halflight.colors.to_srgb(shown[5][0]) == pytest.approx(labels.get_color(5)[:3], abs=1e-3)
    labels.show_selected_label, labels.selected_label = True, 5
    assert napari_halflight.scene_of(viewer).volumes[0].look["labels"].keys() == {5}
    labels.visible = False
    viewer.add_points([(5, 6, 7), (9, 9, 9)], size=[2, 4], face_color=["red", "lime"], scale=(2, 2, 2))
    spheres = napari_halflight.scene_of(viewer).meshes[0]._arrays()[1]
    assert spheres["spheres"][:, 3].tolist() == [2, 4] and abs(spheres["spheres"][0, :3]).tolist() == [14, 12, 10]
    assert spheres["sphere_colors"][1].tolist() == pytest.approx([0, 1, 0, 1])
    viewer.add_surface((np.array([(0, 0, 0), (0, 9, 0), (0, 0, 9)], float), np.array([(0, 1, 2)]), np.array([0, 1, 2.0])), colormap="viridis")
    viewer.add_shapes([np.array([(3, 0, 0), (3, 0, 9), (3, 9, 9), (3, 9, 0)])], shape_type="rectangle", edge_width=2, edge_color="white", face_color="blue")
    viewer.add_shapes([np.array([(3, 0, 0), (3, 9, 9)])], shape_type="line", edge_width=2)
    viewer.add_vectors(np.array([[(1, 1, 1), (0, 5, 0)]], float))
    scene = napari_halflight.scene_of(viewer)
    assert len(scene.meshes) == 6 and scene.meshes[1].triangle_count == 1 and scene.meshes[2].triangle_count == 2
    tracked = ViewerModel(ndisplay=3)
    tracked.add_tracks(np.array([(0, t, 5, 5 + t, 5) for t in range(5)] + [(1, t, 9, 5, 5 + t) for t in range(5)], float))
    tracked.dims.set_point(0, 4)
    assert len(napari_halflight.scene_of(tracked).meshes) == 1
    assert len(viewer.layers) == 6 and not viewer.layers[0].visible


def test_pyramids_and_colours(viewer):
    large = np.kron(blob(), np.ones((2, 2, 2), np.uint8))
    viewer.add_image([large, large[::2, ::2, ::2]], multiscale=True, contrast_limits=(0, 255))
    assert napari_halflight.scene_of(viewer).volumes[0].dimensions == (72, 60, 48)
    napari_halflight._layers._MOST_VOXELS, kept = 40000, napari_halflight._layers._MOST_VOXELS
    try:
        volume = napari_halflight.scene_of(viewer).volumes[0]
    finally:
        napari_halflight._layers._MOST_VOXELS = kept
    assert volume.dimensions == (36, 30, 24) and abs(volume.affine[:3, 3]).tolist() == [0.5, 0.5, 0.5] and abs(np.diag(volume.affine))[:3].tolist() == [2, 2, 2]
    viewer.layers.clear()
    viewer.add_image(np.stack([blob()] * 3, axis=-1), rgb=True)
    assert napari_halflight.scene_of(viewer).volumes[0]._colored.shape == (24, 30, 36, 3)


def test_animations(window, tmp_path):
    napari_animation = pytest.importorskip("napari_animation")
    window.layers.clear()
    window.add_image(blob(), contrast_limits=(50, 200))
    animation = napari_animation.Animation(window)
    window.camera.angles = (0, 0, 90)
    animation.capture_keyframe(steps=2)
    window.camera.angles = (0, 60, 90)
    animation.capture_keyframe(steps=2)
    paths = napari_halflight.render_animation(animation, tmp_path / "film", size=(64, 48))
    assert len(paths) == len(animation._frames) >= 3 and len({pathlib.Path(path).read_bytes() for path in paths}) == len(paths)


@pytest.fixture(scope="module")
def window():
    qtpy = pytest.importorskip("qtpy")
    try:
        made = napari.Viewer(ndisplay=3, show=True)
    except Exception as problem:  # no screen, no OpenGL
        pytest.skip(f"napari has no window here: {problem}")
    made.window.resize(900, 700)
    qtpy.QtWidgets.QApplication.processEvents()
    yield made
    made.close()


@pytest.mark.parametrize("perspective", [0, 45])
@pytest.mark.parametrize("orientation", [("away", "down", "right"), ("towards", "down", "right")])
def test_silhouettes_are_napari_s(window, perspective, orientation, pictures):
    """A solid figure without any symmetry, from a skew view: also where napari shows the world mirrored."""
    from qtpy.QtWidgets import QApplication

    window.layers.clear()
    figure = np.zeros((24, 30, 36), np.uint8)
    figure[4:20, 4:26, 4:32] = 1
    figure[4:12, 4:15, 20:32] = 0
    figure[14:20, 18:26, 4:10] = 0
    surface = solid_surface(figure)
    window.add_surface(surface, shading="flat", colormap="gray", contrast_limits=(0, 1.2))
    window.camera.orientation = orientation
    window.camera.angles = (20, 35, -80)
    window.camera.center, window.camera.zoom, window.camera.perspective = (12, 15, 18), 9.0, perspective
    QApplication.processEvents()
    host = window.screenshot(canvas_only=True, flash=False)
    mine = napari_halflight.render(window, size=(host.shape[1], host.shape[0]), shadows="off")
    seen = host[..., :3].max(axis=-1) > 25
    check_silhouettes(seen, np.asarray(mine)[..., 3] > 0.5)


def solid_surface(figure):
    """The faces of voxels, as vertices z, y, x in voxel coordinates and triangles."""
    vertices, faces = [], []
    solid = np.pad(figure, 1)
    for axis in range(3):
        for side in (1, -1):
            border = (solid == 1) & (np.roll(solid, -side, axis) == 0)
            for voxel in np.argwhere(border) - 1:
                one, two = [other for other in range(3) if other != axis]
                corners = np.repeat((voxel + 0.0)[None], 4, axis=0)
                corners[:, axis] += side / 2
                corners[:, one] += (-0.5, 0.5, 0.5, -0.5)
                corners[:, two] += (-0.5, -0.5, 0.5, 0.5)
                order = (0, 1, 2, 3) if (side > 0) == (axis != 1) else (3, 2, 1, 0)
                first = len(vertices)
                vertices += corners[list(order)].tolist()
                faces += [(first, first + 1, first + 2), (first, first + 2, first + 3)]
    return np.array(vertices), np.array(faces), np.ones(len(vertices))


def test_the_dock(window, tmp_path, pictures):
    from qtpy.QtWidgets import QApplication
    from napari_halflight._dock import Dock

    window.layers.clear()
    window.camera.orientation = ("away", "down", "right")
    rng = np.random.default_rng(3)
    nuclei = rng.uniform((6, 8, 8), (34, 42, 52), (22, 3))
    grid = np.stack(np.mgrid[:40, :50, :60], axis=-1)
    image = sum(np.exp(-((grid - one) ** 2).sum(axis=-1) / rng.uniform(12, 26)) for one in nuclei)
    window.add_image(image.astype(np.float32), colormap="magma", contrast_limits=(0.2, 1.1))
    window.add_points(nuclei[::3], size=5, face_color="lime")
    window.camera.center, window.camera.zoom, window.camera.angles, window.camera.perspective = (20, 25, 30), 7.0, (15, 30, -100), 0
    dock = Dock(window)
    window.window.add_dock_widget(dock, name="Halflight")
    assert not dock.save_button.isEnabled()
    dock.softness.setValue(12)
    dock.look.setCurrentText("surface")
    dock.render()
    assert not dock.render_button.isEnabled()
    while not dock.render_button.isEnabled():
        QApplication.processEvents()
    assert dock.image is not None, dock.message.text()
    assert dock.render_button.isEnabled() and dock.picture.pixmap().width() > 100
    dock.save(tmp_path / "picture.png")
    assert (tmp_path / "picture.png").read_bytes()[:4] == b"\x89PNG"
    layer = dock.add_layer()
    assert layer.rgb and np.array_equal(layer.data, dock.image.to_srgb8())
    assert len(dock.scene().volumes) == 1  # its own picture is left out
    window.layers.remove(layer)
    for each in window.layers:
        each.visible = False
    dock.render()
    assert dock.message.text() == "no visible layer has anything to show"
    for each in window.layers:
        each.visible = True
    if pictures is not None:
        window.window.remove_dock_widget(dock)
        QApplication.processEvents()
        host = window.screenshot(canvas_only=True, flash=False)
        side_by_side(pictures / "napari.png", host, napari_halflight.render(window, size=(host.shape[1], host.shape[0]), softness=8).to_srgb8())
