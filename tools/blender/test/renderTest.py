# SPDX-License-Identifier: Apache-2.0
"""Renders Suzanne and a creased cup of two materials in Cycles, subdivided by the add-on, and compares
them with expected pictures; with --write, writes these and those of Blender's subdivision.  Run inside
Blender:

    blender -b --factory-startup --python-exit-code 1 --python renderTest.py -- MODULES ADDONS OUT
        EXPECTED [--write]
"""

import math
import pathlib
import sys

import bpy
import numpy as np

arguments = sys.argv[sys.argv.index("--") + 1:]
for folder in arguments[:2]:
    sys.path.insert(0, folder)
out, expected = map(pathlib.Path, arguments[2:4])
is_writing = "--write" in arguments

import opensubdivhex_blender as addon

SIZE = 800
# Pictures are written with little noise; to be compared, fewer samples are enough.
SAMPLES = 96 if is_writing else 32
# Means of blocks of pixels are compared, in which noise is small and a moved edge is not.
BLOCK = 32
LARGEST_DIFFERENCE = 1.5  # of 255


def make_material(name, colour, roughness):
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    shader = material.node_tree.nodes["Principled BSDF"]
    shader.inputs["Base Color"].default_value = (*colour, 1)
    shader.inputs["Roughness"].default_value = roughness
    return material


def make_suzanne():
    bpy.ops.mesh.primitive_monkey_add()
    suzanne = bpy.context.object
    suzanne.rotation_euler = (0, 0, 0.45)
    bpy.ops.object.shade_smooth()
    suzanne.data.materials.append(make_material("clay", (0.55, 0.3, 0.2), 0.35))
    return suzanne


def make_cup():
    """Rings of vertices, outside and inside, with a sharp rim and foot."""
    # A line along a narrow row needs as many vertices as keep it from folding, and its outline from being seen.
    number = 32
    rings = [(0.55, -1.0), (0.8, -0.7), (0.9, 0.2), (1.0, 1.0), (0.85, 1.0), (0.75, 0.2),
             (0.6, -0.6)]
    angles = [2 * math.pi * i / number for i in range(number)]
    positions = [(r * math.cos(a), r * math.sin(a), z) for r, z in rings for a in angles]
    faces = [[ring * number + i, ring * number + (i + 1) % number,
              (ring + 1) * number + (i + 1) % number, (ring + 1) * number + i]
             for ring in range(len(rings) - 1) for i in range(number)]
    faces += [list(range(number - 1, -1, -1)),
              list(range(number * (len(rings) - 1), number * len(rings)))]
    mesh = bpy.data.meshes.new("Cup")
    mesh.from_pydata(positions, [], faces)
    creases = {0: 1.0, 3: 0.8, 4: 0.8}
    for edge in mesh.edges:
        first, second = (v // number for v in edge.vertices)
        if first == second and first in creases:
            edge.crease = creases[first]
    mesh.materials.append(make_material("glaze", (0.05, 0.2, 0.45), 0.15))
    mesh.materials.append(make_material("cream", (0.8, 0.7, 0.5), 0.4))
    for polygon in mesh.polygons:
        polygon.use_smooth = True
        polygon.material_index = int(min(polygon.vertices) // number >= 2)
    cup = bpy.data.objects.new("Cup", mesh)
    bpy.context.collection.objects.link(cup)
    cup.rotation_euler = (0.75, 0, 0.2)
    bpy.context.view_layer.objects.active = cup
    return cup


def make_stage():
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.cycles.device, scene.cycles.samples, scene.cycles.seed = "CPU", SAMPLES, 1
    scene.cycles.use_denoising = False
    scene.cycles.max_bounces = 3
    scene.render.resolution_x = scene.render.resolution_y = SIZE
    scene.view_settings.view_transform = "Standard"
    scene.render.image_settings.file_format = "PNG"
    scene.render.image_settings.color_mode = "RGB"
    scene.world = bpy.data.worlds.new("World")
    scene.world.use_nodes = True
    scene.world.node_tree.nodes["Background"].inputs["Color"].default_value = (0.6, 0.65, 0.7, 1)
    lamp = bpy.data.lights.new("Key", "SUN")
    lamp.energy, lamp.angle = 1.8, 0.3
    key = bpy.data.objects.new("Key", lamp)
    key.rotation_euler = (0.7, 0.3, 0.4)
    camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    camera.location, camera.rotation_euler = (0, -4.5, 0.15), (math.pi / 2, 0, 0)
    for item in (key, camera):
        bpy.context.collection.objects.link(item)
    scene.camera = camera
    return scene


def render(scene, name):
    scene.render.filepath = str(out / f"{name}.png")
    bpy.ops.render.render(write_still=True)
    return read(out / f"{name}.png")


def read(path):
    image = bpy.data.images.load(str(path))
    image.colorspace_settings.name = "Non-Color"
    pixels = np.empty(len(image.pixels), np.float32)
    image.pixels.foreach_get(pixels)
    shape = image.size[1], image.size[0], image.channels
    bpy.data.images.remove(image)
    return pixels.reshape(shape)[:, :, :3]


def has_folds(name, mesh):
    """Whether polygons beside each other lie back to back."""
    normals = [polygon.normal for polygon in mesh.polygons]
    sides = {}
    for polygon in mesh.polygons:
        for key in polygon.edge_keys:
            sides.setdefault(key, []).append(normals[polygon.index])
    count = sum(len(pair) == 2 and pair[0].dot(pair[1]) < -0.9 for pair in sides.values())
    if count:
        print(f"{name}: the surface folds at {count} edges")
    return count > 0


def compare(name, picture):
    if is_writing:
        (expected / f"{name}.png").write_bytes((out / f"{name}.png").read_bytes())
        return True
    wanted = read(expected / f"{name}.png")
    if wanted.shape != picture.shape:
        print(f"{name}: {picture.shape} in place of {wanted.shape}")
        return False
    number = SIZE // BLOCK
    blocks = (picture - wanted).reshape(number, BLOCK, number, BLOCK, 3).mean(axis=(1, 3))
    difference = 255 * float(np.abs(blocks).max())
    print(f"{name}: {difference:.3f} of 255 is the largest difference of blocks of pixels")
    return difference <= LARGEST_DIFFERENCE


addon_is_fine = True
for make, name in ((make_suzanne, "suzanne"), (make_cup, "cup")):
    scene = make_stage()
    addon.register()
    source = make()
    if is_writing:
        modifier = source.modifiers.new("Subdivision", "SUBSURF")
        modifier.levels = modifier.render_levels = 3
        compare(f"{name}-blender", render(scene, f"{name}-blender"))
        source.modifiers.remove(modifier)
    bpy.ops.object.hex_subdivide(level=3)
    addon_is_fine &= not has_folds(name, bpy.context.view_layer.objects.active.data)
    addon_is_fine &= compare(f"{name}-hexagonal", render(scene, f"{name}-hexagonal"))
    addon.unregister()
sys.exit(not addon_is_fine)
