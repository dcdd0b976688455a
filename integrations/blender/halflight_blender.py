"""Blender add-on: camera, lights and meshes of the scene by Halflight, among volumes of files; the picture comes back as an image."""
from __future__ import annotations

import math
from typing import Any

import bpy
import halflight
import numpy as np

bl_info = {"name": "Halflight", "blender": (3, 3, 0), "category": "Render", "version": (0, 1, 0),
           "description": "Volumes and meshes with hard and soft shadows"}


def _matrix(matrix: Any) -> np.ndarray:
    return np.array([list(row) for row in matrix], dtype=float)


def camera_of(item: Any, size: tuple[int, int]) -> halflight.Camera:
    """A camera object's view: it looks along its -z axis."""
    place, data = _matrix(item.matrix_world), item.data
    position, forward, up = place[:3, 3], -place[:3, 2], place[:3, 1]
    words: dict[str, Any] = {"position": tuple(position), "target": tuple(position + 10 * forward / np.linalg.norm(forward)), "up": tuple(up)}
    wide = size[0] / size[1]
    across = data.sensor_fit == "HORIZONTAL" or data.sensor_fit == "AUTO" and wide >= 1
    if data.type == "ORTHO":
        return halflight.Camera(**words, height=data.ortho_scale / wide if across else data.ortho_scale)
    half = math.tan(data.angle / 2)
    return halflight.Camera(**words, fovy_deg=math.degrees(2 * math.atan(half / wide if across else half)))


def light_of(item: Any) -> halflight.Light:
    """A light: suns as strong as they are, lamps as strong as their watts make a white wall at a distance of 1."""
    place, data = _matrix(item.matrix_world), item.data
    position, forward = tuple(place[:3, 3]), tuple(-place[:3, 2])
    words: dict[str, Any] = {"color": tuple(data.color)}
    if data.type == "SUN":
        return halflight.Directional(direction=forward, angular_diameter_deg=math.degrees(data.angle), intensity=data.energy / math.pi, **words)
    words |= {"intensity": data.energy / (4 * math.pi**2), "falloff": "inverse_square"}
    if data.type == "SPOT":
        return halflight.Spot(position=position, direction=forward, radius=data.shadow_soft_size, opening_angle_deg=math.degrees(data.spot_size),
                              falloff_angle_deg=math.degrees(data.spot_size) * data.spot_blend / 2, **words)
    if data.type == "AREA":
        width, height = data.size, data.size_y if data.shape in ("RECTANGLE", "ELLIPSE") else data.size
        return halflight.Rect(position=position, edge1=tuple(width * place[:3, 0]), edge2=tuple(height * place[:3, 1]), **words)
    return halflight.Point(position=position, radius=data.shadow_soft_size, **words)


def _color_of(material: Any) -> tuple[tuple[float, ...], float]:
    """The base colour, linear, and the opacity of a material."""
    if material is None:
        return (0.8, 0.8, 0.8), 1.0
    shader = next((node for node in material.node_tree.nodes if node.type == "BSDF_PRINCIPLED"), None) if material.use_nodes else None
    rgba = tuple(shader.inputs["Base Color"].default_value) if shader is not None else tuple(material.diffuse_color)
    return rgba[:3], float(shader.inputs["Alpha"].default_value) if shader is not None else rgba[3]


def mesh_of(item: Any, depsgraph: Any) -> halflight.Mesh | None:
    """An object's evaluated mesh in the world, each triangle in its material's colour."""
    evaluated = item.evaluated_get(depsgraph)
    mesh = evaluated.to_mesh()
    try:
        mesh.calc_loop_triangles()
        count = len(mesh.loop_triangles)
        if count == 0:
            return None
        vertices, triangles = np.empty(3 * len(mesh.vertices), np.float32), np.empty(3 * count, np.int32)
        numbers, flat = np.empty(count, np.int32), np.empty(count, bool)
        mesh.vertices.foreach_get("co", vertices)
        mesh.loop_triangles.foreach_get("vertices", triangles)
        mesh.loop_triangles.foreach_get("material_index", numbers)
        mesh.loop_triangles.foreach_get("use_smooth", flat)
        looks = [_color_of(slot.material) for slot in item.material_slots] or [_color_of(None)]
        colors = np.array([(*color, opacity) for color, opacity in looks], np.float32)[np.minimum(numbers, len(looks) - 1)]
        return halflight.Mesh(vertices.reshape(-1, 3), triangles.reshape(-1, 3), face_colors=colors, color=1, specular=0.1, name=item.name,
                              smooth=bool(flat.any()), affine=_matrix(item.matrix_world))
    finally:
        evaluated.to_mesh_clear()


def scene_of(context: Any, volumes: Any = (), **settings: Any) -> halflight.Scene:
    """The scene of Blender's context. volumes: what `halflight.Volume` takes, in Blender's world; keywords of `halflight.Scene`."""
    scene = context.scene
    size = (scene.render.resolution_x * scene.render.resolution_percentage // 100, scene.render.resolution_y * scene.render.resolution_percentage // 100)
    depsgraph = context.evaluated_depsgraph_get()
    meshes, lights = [], []
    for item in scene.objects:
        if item.hide_render or not item.visible_get():
            continue
        if item.type in ("MESH", "CURVE", "SURFACE", "META", "FONT"):
            meshes.append(mesh_of(item, depsgraph))
        elif item.type == "LIGHT":
            lights.append(light_of(item))
    words: dict[str, Any] = {"size": size, "lights": lights, "sky": 0.0}
    if scene.camera is not None:
        words["camera"] = camera_of(scene.camera, size)
    if scene.world is not None:
        shader = next((node for node in scene.world.node_tree.nodes if node.type == "BACKGROUND"), None) if scene.world.use_nodes else None
        color = tuple(shader.inputs["Color"].default_value)[:3] if shader is not None else tuple(scene.world.color)
        words["background"], words["ambient"] = color, color
    return halflight.Scene([*volumes, *(one for one in meshes if one is not None)], **{**words, **settings})


def render_to_image(context: Any, name: str = "Halflight", **settings: Any) -> Any:
    """Render, and keep the picture as an image of Blender's with floats."""
    picture = np.asarray(halflight.Renderer().render(scene_of(context, **settings)))
    image = bpy.data.images.get(name)
    if image is not None:
        bpy.data.images.remove(image)
    image = bpy.data.images.new(name, picture.shape[1], picture.shape[0], alpha=True, float_buffer=True)
    image.pixels.foreach_set(np.ascontiguousarray(picture[::-1]).ravel())
    image.update()
    return image


class HALFLIGHT_OT_render(bpy.types.Operator):
    """Render the scene by Halflight into the image "Halflight"."""

    bl_idname, bl_label = "render.halflight", "Render by Halflight"
    volume: bpy.props.StringProperty(name="Volume", description="A volume file among the meshes", subtype="FILE_PATH")

    def execute(self, context: Any) -> set[str]:
        render_to_image(context, volumes=[bpy.path.abspath(self.volume)] if self.volume else [])
        self.report({"INFO"}, 'The picture is the image "Halflight"')
        return {"FINISHED"}


def _menu(self: Any, context: Any) -> None:
    self.layout.operator(HALFLIGHT_OT_render.bl_idname)


def register() -> None:
    """Add the operator and its entry in the menu Render."""
    bpy.utils.register_class(HALFLIGHT_OT_render)
    bpy.types.TOPBAR_MT_render.append(_menu)


def unregister() -> None:
    """Take them away."""
    bpy.types.TOPBAR_MT_render.remove(_menu)
    bpy.utils.unregister_class(HALFLIGHT_OT_render)
