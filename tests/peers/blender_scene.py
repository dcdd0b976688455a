"""Runs in Blender: the volume under a disk of light by Cycles, single scattering.

usage: blender --background --factory-startup --python-exit-code 1 --python blender_scene.py -- JOB.json

Writes what was measured to blender.json. A frame is two halves of its samples by two seeds, blender-0.png and
blender-1.png: their mean is the picture, their difference tells its noise.
"""
import json
import math
import sys
import time

import bpy
from mathutils import Matrix, Vector

job = json.load(open(sys.argv[-1]))
camera, light, function = job["camera"], job["light"], job["transfer_function"]

for kept in list(bpy.data.objects):
    bpy.data.objects.remove(kept)
scene = bpy.context.scene


def place(name, data, right, up, backward, position):
    """An object whose local x, y and z are these axes."""
    made = bpy.data.objects.new(name, data)
    axes = Matrix((right, up, backward)).transposed().to_4x4()
    made.matrix_world = Matrix.Translation(position) @ axes
    scene.collection.objects.link(made)
    return made


def eye():
    lens = bpy.data.cameras.new("eye")
    lens.type, lens.ortho_scale, lens.clip_end = "ORTHO", camera["height"], 1e4
    scene.camera = place("eye", lens, camera["right"], camera["true_up"], [-x for x in camera["forward"]], camera["position"])


def lamp():
    """A one-sided disk of power P gives P / (pi D^2) at a distance D before it; one isotropic scattering sends a part of
    1 / 4 pi of that towards the eye."""
    disk = bpy.data.lights.new("light", "AREA")
    disk.shape, disk.size = "DISK", 2 * light["radius"]
    disk.energy = 4 * math.pi ** 2 * light["distance"] ** 2 * light["intensity"]
    towards = Vector(light["direction"])
    backward = -towards
    right = backward.orthogonal().normalized()
    place("light", disk, right, backward.cross(right), backward, light["position"])


def medium():
    """Extinction of the value at each sample; its colour's part of that is scattered, the rest absorbed. One ramp holds
    both, to be looked up but once a step: colours, and in alpha the extinction, of its greatest."""
    material = bpy.data.materials.new("medium")
    material.use_nodes = True
    nodes, links = material.node_tree.nodes, material.node_tree.links
    nodes.clear()
    value, scaled, ramp, density = (nodes.new("ShaderNode" + kind) for kind in ("Attribute", "Math", "ValToRGB", "Math"))
    value.attribute_name = "density"
    scaled.operation, scaled.inputs[1].default_value = "DIVIDE", 255
    density.operation, density.inputs[1].default_value = "MULTIPLY", max(job["extinction"])
    fill(ramp.color_ramp)
    links.new(value.outputs["Fac"], scaled.inputs[0])
    links.new(scaled.outputs[0], ramp.inputs[0])
    links.new(ramp.outputs["Alpha"], density.inputs[0])
    both, output = nodes.new("ShaderNodeAddShader"), nodes.new("ShaderNodeOutputMaterial")
    for slot, kind in enumerate(("ShaderNodeVolumeScatter", "ShaderNodeVolumeAbsorption")):
        part = nodes.new(kind)
        links.new(ramp.outputs["Color"], part.inputs["Color"])
        links.new(density.outputs[0], part.inputs["Density"])
        links.new(part.outputs[0], both.inputs[slot])
    links.new(both.outputs[0], output.inputs["Volume"])
    return material


def fill(ramp):
    """The table's points and some between, where extinction bends: a ramp holds 32 at most."""
    values = {point[0] for point in function["opacity"] + function["color"]} | {40, 73, 87, 93, 100, 107, 113}
    ramp.interpolation = "LINEAR"
    while len(ramp.elements) > 1:
        ramp.elements.remove(ramp.elements[0])
    for number, v in enumerate(sorted(values)):
        element = ramp.elements.new(v / 255) if number else ramp.elements[0]
        element.position, element.color = v / 255, (*job["color"][v], job["extinction"][v] / max(job["extinction"]))


def bonsai():
    data = bpy.data.volumes.new("bonsai")
    data.filepath = job["work"] + "/volume.vdb"
    data.materials.append(medium())
    scene.collection.objects.link(bpy.data.objects.new("bonsai", data))


def settings():
    scene.world = bpy.data.worlds.new("dark")
    scene.world.color = (0, 0, 0)
    render, cycles = scene.render, scene.cycles
    render.engine, render.resolution_x, render.resolution_y = "CYCLES", job["size"], job["size"]
    render.resolution_percentage = 100
    render.image_settings.file_format, render.image_settings.color_mode = "PNG", "RGB"
    scene.view_settings.view_transform, render.dither_intensity = "Standard", 0
    cycles.device, cycles.samples, cycles.use_adaptive_sampling, cycles.use_denoising = "CPU", job["samples"] // 2, False, False
    cycles.max_bounces, cycles.volume_bounces = 0, 0


eye(), lamp(), bonsai(), settings()
begin, processor = time.perf_counter(), time.process_time()
for seed in range(2):
    scene.cycles.seed = seed
    bpy.ops.render.render()
    bpy.data.images["Render Result"].save_render(f"{job['work']}/blender-{seed}.png")
frame, processor = 1e3 * (time.perf_counter() - begin), 1e3 * (time.process_time() - processor)
with open(job["work"] + "/blender.json", "w") as file:
    json.dump({"version": bpy.app.version_string, "soft": {"frame_ms": [frame], "processor_ms": [processor]}}, file)
