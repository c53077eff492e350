# SPDX-License-Identifier: Apache-2.0
"""Tests of the add-on, run inside Blender:

    blender -b --factory-startup --python-exit-code 1 --python addonTest.py -- MODULES ADDONS
"""

import sys
import unittest

import bpy
import numpy as np

for folder in sys.argv[sys.argv.index("--") + 1:]:
    sys.path.insert(0, folder)

import opensubdivhex as osh
import opensubdivhex_blender as addon
from opensubdivhex_blender import follower, mesh_input


def get(collection, name, dtype=np.float32, width=1):
    return mesh_input.get(collection, name, dtype, width)


def make_object(positions, faces, name="Source"):
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata([tuple(map(float, p)) for p in positions], [], faces)
    source = bpy.data.objects.new(name, mesh)
    bpy.context.collection.objects.link(source)
    bpy.context.view_layer.objects.active = source
    return source


def make_cube():
    positions = [(x, y, z) for z in (-1, 1) for y in (-1, 1) for x in (-1, 1)]
    return make_object(positions, [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [1, 3, 7, 5],
                                   [3, 2, 6, 7], [2, 0, 4, 6]])


def subdivide(source, **settings):
    bpy.context.view_layer.objects.active = source
    bpy.ops.object.hex_subdivide(**settings)
    return bpy.context.view_layer.objects.active


def get_positions(target):
    return get(target.data.vertices, "co", np.float32, 3)


def refine(source, level, labels=None, **options):
    """What the library makes of the source's positions and faces."""
    faces = [list(polygon.vertices) for polygon in source.data.polygons]
    options = {"face_mask": "smooth", "vtx_boundary_interpolation": "edge_only", **options}
    refiner = osh.TopologyRefiner(faces, len(source.data.vertices), **options)
    refiner.refine_uniform(level, full_topology_in_last_level=True, face_labels=labels)
    return refiner, osh.RefinementEvaluator(refiner).evaluate(get_positions(source))


class AddonTest(unittest.TestCase):
    def setUp(self):
        bpy.ops.wm.read_factory_settings(use_empty=True)
        addon.register()

    def tearDown(self):
        addon.unregister()

    def test_its_version_is_that_of_the_module(self):
        self.assertEqual(".".join(map(str, addon.bl_info["version"])), osh.__version__)

    def test_positions_are_those_of_the_library(self):
        for mask in ("SMOOTH", "COSINE", "AVERAGE"):
            source = make_cube()
            target = subdivide(source, level=3, mask=mask)
            _, expected = refine(source, 3, face_mask=mask.lower())
            np.testing.assert_array_equal(get_positions(target), expected)
            self.assertFalse(target.data.validate())
            self.assertEqual(target.parent, source)
            self.assertTrue(source.hide_render)

    def test_first_step(self):
        source = make_cube()
        source.data.edges[0].use_edge_sharp = True
        target = subdivide(source, level=3, first_step="TRUNCATE")
        ends = sorted(source.data.edges[0].vertices)
        labels = [9 + number if {*ends} <= {*face.vertices} else 0
                  for number, face in enumerate(source.data.polygons)]
        _, expected = refine(source, 3, labels=labels, first_step="truncate")
        np.testing.assert_array_equal(get_positions(target), expected)
        self.assertFalse(target.data.validate())
        # As is the line that the edge becomes.
        self.assertTrue(get(target.data.edges, "use_edge_sharp", bool).any())

    def test_boundaries_and_limit(self):
        positions = [(x, y, 0.3 * x * y) for y in range(3) for x in range(3)]
        faces = [[0, 1, 4, 3], [1, 2, 5, 4], [3, 4, 7, 6], [4, 5, 8, 7]]
        for boundary in ("NONE", "EDGE_ONLY", "EDGE_AND_CORNER"):
            source = make_object(positions, faces)
            target = subdivide(source, level=2, boundary=boundary)
            refiner, expected = refine(source, 2, vtx_boundary_interpolation=boundary.lower())
            np.testing.assert_array_equal(get_positions(target), expected)
            table = osh.LimitStencilTable(refiner, 2)
            expected = osh.CpuEvaluator.eval_stencils(table, get_positions(source))
            target.opensubdivhex.use_limit = True
            np.testing.assert_allclose(get_positions(target), expected, atol=1e-6)

    def test_creases_are_mapped_as_blender_maps_them(self):
        source = make_cube()
        ends, values = [[0, 1], [1, 3]], [0.5, 1.0]
        for edge in source.data.edges:
            if sorted(edge.vertices) in ends:
                edge.crease = values[ends.index(sorted(edge.vertices))]
        target = subdivide(source, level=3)
        _, expected = refine(source, 3, creases=(ends, [2.5, 10]))
        np.testing.assert_allclose(get_positions(target), expected, atol=1e-5)
        # The infinitely sharp one is sharp in shading, too.
        self.assertTrue(get(target.data.edges, "use_edge_sharp", bool).any())
        self.assertTrue(target.data.use_auto_smooth)

    def test_sharp_edges_shade_or_crease(self):
        source = make_cube()
        for edge in source.data.edges:
            edge.use_edge_sharp = True
        target = subdivide(source, level=2)
        _, expected = refine(source, 2)
        np.testing.assert_array_equal(get_positions(target), expected)
        self.assertTrue(get(target.data.edges, "use_edge_sharp", bool).any())
        target.opensubdivhex.sharp_edges = "CREASE"
        extent = np.abs(get_positions(target)).max(axis=1)
        np.testing.assert_allclose(extent, 1, atol=1e-6)

    def test_materials_keep_to_their_faces(self):
        source = make_cube()
        for name in ("side", "top"):
            source.data.materials.append(bpy.data.materials.new(name))
        for edge in source.data.edges:
            edge.crease = 1.0
        source.data.polygons[1].material_index = 1  # the face at z = 1
        for level in (1, 2, 3, 4):
            target = subdivide(source, level=level)
            self.assertEqual([m.name for m in target.data.materials], ["side", "top"])
            area = 0
            for polygon in target.data.polygons:
                flat = all(abs(target.data.vertices[v].co.z - 1) < 1e-5 for v in polygon.vertices)
                self.assertEqual(polygon.material_index, int(flat))
                area += polygon.area if flat else 0
            self.assertAlmostEqual(area, 4, places=4)

    def test_uv_maps_colours_and_groups(self):
        source = make_cube()
        source.data.uv_layers.new(name="Map")
        corners = get(source.data.loops, "vertex_index", np.int32)
        flat = get_positions(source)[corners][:, :2]  # without seams
        source.data.uv_layers["Map"].data.foreach_set("uv", flat.ravel())
        values = np.random.default_rng(1).random((8, 4)).astype(np.float32)
        source.data.color_attributes.new("Tint", "FLOAT_COLOR", "POINT")
        source.data.color_attributes["Tint"].data.foreach_set("color", values.ravel())
        chart = np.repeat(np.float32([[i, 1, 0, 1] for i in range(6)]), 4, axis=0)
        source.data.color_attributes.new("Chart", "FLOAT_COLOR", "CORNER")
        source.data.color_attributes["Chart"].data.foreach_set("color", chart.ravel())
        group = source.vertex_groups.new(name="Half")
        group.add([0, 1, 2, 3], 1.0, "REPLACE")
        target = subdivide(source, level=2, uv_smooth="ALL")
        refiner, _ = refine(source, 2)
        varying = osh.RefinementEvaluator(refiner, interpolation_mode="varying")
        mesh = target.data
        found = get(mesh.color_attributes["Tint"].data, "color", np.float32, 4)
        np.testing.assert_allclose(found, varying.evaluate(values), atol=1e-6)
        loops = get(mesh.loops, "vertex_index", np.int32)
        uvs = get(mesh.uv_layers["Map"].data, "uv", np.float32, 2)
        linear = varying.evaluate(get_positions(source)[:, :2].copy())
        np.testing.assert_allclose(uvs, linear[loops], atol=1e-5)
        # Each base face has a colour of its own, up to its border.
        charts = get(mesh.color_attributes["Chart"].data, "color", np.float32, 4)
        for polygon in mesh.polygons:
            span = slice(polygon.loop_start, polygon.loop_start + polygon.loop_total)
            np.testing.assert_allclose(charts[span], charts[span][:1].repeat(
                polygon.loop_total, axis=0), atol=1e-6)
        weights = [next((g.weight for g in v.groups), 0) for v in mesh.vertices]
        np.testing.assert_allclose(
            weights, varying.evaluate(np.float32([1, 1, 1, 1, 0, 0, 0, 0])), atol=1e-6)

    def test_hidden_faces_are_holes_if_asked(self):
        source = make_cube()
        source.data.polygons[1].hide = True
        whole = subdivide(source, level=2)
        count = len(whole.data.polygons)
        holed = subdivide(source, level=2, use_holes=True)
        self.assertGreater(count, len(holed.data.polygons))
        self.assertFalse(holed.data.validate())

    def test_it_follows_frames(self):
        source = make_cube()
        source.shape_key_add(name="Basis")
        key = source.shape_key_add(name="Tall")
        for point in key.data:
            point.co.z *= 3
        for frame, value in ((1, 0.0), (11, 1.0)):
            key.value = value
            key.keyframe_insert("value", frame=frame)
        scene = bpy.context.scene
        scene.frame_set(1)
        target = subdivide(source, level=3)
        refinement = follower.states[target.name].refinement
        low = np.abs(get_positions(target)[:, 2]).max()
        scene.frame_set(11)
        self.assertAlmostEqual(np.abs(get_positions(target)[:, 2]).max() / low, 3, places=4)
        scene.frame_set(1)
        self.assertAlmostEqual(np.abs(get_positions(target)[:, 2]).max(), low, places=5)
        # The topology was refined once.
        self.assertIs(follower.states[target.name].refinement, refinement)

    def test_it_follows_edits(self):
        source = make_cube()
        target = subdivide(source, level=2)
        refinement = follower.states[target.name].refinement
        source.data.vertices[0].co.x = -5
        source.data.update()
        bpy.context.view_layer.update()
        _, expected = refine(source, 2)
        np.testing.assert_array_equal(get_positions(target), expected)
        self.assertIs(follower.states[target.name].refinement, refinement)
        # In edit mode, and with other topology.
        target.select_set(False)
        source.select_set(True)
        bpy.context.view_layer.objects.active = source
        bpy.ops.object.mode_set(mode="EDIT")
        bpy.ops.mesh.select_all(action="SELECT")
        bpy.ops.mesh.subdivide(number_cuts=1)
        bpy.context.view_layer.update()
        count = len(target.data.vertices)
        bpy.ops.object.mode_set(mode="OBJECT")
        bpy.context.view_layer.update()
        _, expected = refine(source, 2)
        self.assertEqual(count, len(expected))
        np.testing.assert_allclose(get_positions(target), expected, atol=1e-6)
        self.assertEqual(target.opensubdivhex.message, "")
        # Not while the object itself is edited, but when it was.
        source.select_set(False)
        bpy.context.view_layer.objects.active = target
        bpy.ops.object.mode_set(mode="EDIT")
        source.data.vertices[0].co.y = -7
        source.data.update()
        bpy.context.view_layer.update()
        self.assertIn("Edit Mode", target.opensubdivhex.message)
        bpy.ops.object.mode_set(mode="OBJECT")
        source.data.update()
        bpy.context.view_layer.update()
        _, expected = refine(source, 2)
        np.testing.assert_allclose(get_positions(target), expected, atol=1e-6)

    def test_bad_meshes_are_refused_in_words(self):
        make_object([(0, 0, 0), (1, 0, 0)], [])
        count = len(bpy.data.objects), len(bpy.data.meshes)
        with self.assertRaisesRegex(RuntimeError, "The mesh has no faces to subdivide"):
            bpy.ops.object.hex_subdivide()
        self.assertEqual((len(bpy.data.objects), len(bpy.data.meshes)), count)
        # One that gets bad later keeps what was made of it, and the panel says why.
        source = make_cube()
        target = subdivide(source, level=1)
        before = get_positions(target)
        source.data.clear_geometry()
        source.data.update()
        bpy.context.view_layer.update()
        np.testing.assert_array_equal(get_positions(target), before)
        self.assertIn("no faces", target.opensubdivhex.message)
        bpy.context.view_layer.objects.active = target
        with self.assertRaisesRegex(RuntimeError, "follows"):
            bpy.ops.object.hex_subdivide()

    def test_undo(self):
        source = make_cube()
        bpy.ops.ed.undo_push(message="before")
        subdivide(source, level=1)
        bpy.ops.ed.undo_push(message="made")
        bpy.data.objects["Source Hex"].opensubdivhex.level = 3
        bpy.ops.ed.undo_push(message="level")
        many = len(bpy.data.objects["Source Hex"].data.vertices)
        bpy.ops.ed.undo()
        target = bpy.data.objects["Source Hex"]
        self.assertEqual(target.opensubdivhex.level, 1)
        self.assertEqual(len(target.data.vertices), 32)
        bpy.ops.ed.undo()
        self.assertNotIn("Source Hex", bpy.data.objects)
        bpy.ops.ed.redo()
        bpy.ops.ed.redo()
        target = bpy.data.objects["Source Hex"]
        self.assertEqual(len(target.data.vertices), many)
        # It follows on.
        source = bpy.data.objects["Source"]
        source.data.vertices[0].co.x = -3
        source.data.update()
        bpy.context.view_layer.update()
        _, expected = refine(source, 3)
        np.testing.assert_array_equal(get_positions(target), expected)


if __name__ == "__main__":
    result = unittest.TextTestRunner(verbosity=2).run(
        unittest.defaultTestLoader.loadTestsFromTestCase(AddonTest))
    sys.exit(not result.wasSuccessful())
