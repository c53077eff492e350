# SPDX-License-Identifier: Apache-2.0
"""The settings of an object, the operator that makes one, and the panel."""

import bpy
import opensubdivhex as osh
from bpy.props import BoolProperty, EnumProperty, IntProperty, PointerProperty, StringProperty

from . import follower
from .mesh_input import MeshInputError


def on_setting(settings, context):
    target = settings.id_data
    if settings.source and context is not None:
        follower.update(target, context.evaluated_depsgraph_get())


def make_properties(update):
    """The settings, for the operator and for the object that it makes."""
    return {
        "level": IntProperty(
            name="Level", description="How many times the mesh is refined", default=2, min=0,
            max=10, soft_max=6, update=update),
        "mask": EnumProperty(
            name="Mask", default="SMOOTH",
            description="How a face makes its new points. Smooth by default, since it is for "
            "pictures; hexrefine and Python begin with the paper's Average",
            items=[("SMOOTH", "Smooth", "The smoothest, for renders"),
                   ("COSINE", "Cosine", "Doo and Sabin's mask: bounded curvature"),
                   ("AVERAGE", "Average", "The paper's mask: lumpy from level 4 on")],
            update=update),
        "first_step": EnumProperty(
            name="First Step", description="How level 1 is made", default="NONE",
            items=[("NONE", "Hexagons", "As the levels behind it: for quads"),
                   ("TRUNCATE", "Truncate", "Corners are cut off: for triangles")],
            update=update),
        "boundary": EnumProperty(
            name="Boundary", default="EDGE_ONLY",
            description="What becomes of open borders. All by default, as in Blender's own "
            "modifier; hexrefine and Python begin with the paper's rule",
            items=[("EDGE_ONLY", "All", "A smooth curve, corners too"),
                   ("EDGE_AND_CORNER", "Keep Corners", "A smooth curve between corners that stay"),
                   ("NONE", "Shrink", "The paper's rule: the border moves inward")],
            update=update),
        "use_limit": BoolProperty(
            name="Limit Surface", description="Place vertices on the limit surface", default=False,
            update=update),
        "sharp_edges": EnumProperty(
            name="Sharp Edges", description="What edges marked as sharp do", default="SHADE",
            items=[("SHADE", "Shade", "They stay sharp in shading; the surface is smooth"),
                   ("CREASE", "Crease", "They are infinitely sharp creases")],
            update=update),
        "use_holes": BoolProperty(
            name="Hidden Faces as Holes", description="Leave hidden faces out of the result",
            default=False, update=update),
        "uv_smooth": EnumProperty(
            name="UV Smooth", description="Where UVs and corner colours are linear",
            default="BOUNDARIES",
            items=[("ALL", "None", "Everywhere: they are not smoothed"),
                   ("CORNERS_ONLY", "Keep Corners", "At corners of islands"),
                   ("CORNERS_PLUS1", "Keep Corners, Junctions", "At corners and junctions"),
                   ("CORNERS_PLUS2", "Keep Corners, Junctions, Concave",
                    "At corners, junctions, darts and concave corners"),
                   ("BOUNDARIES", "Keep Boundaries", "At boundaries of islands"),
                   ("NONE", "All", "Nowhere: they are smoothed, boundaries too")],
            update=update),
    }


SETTINGS = tuple(make_properties(None))


class HexSettings(bpy.types.PropertyGroup):
    """How an object follows its source."""

    __annotations__ = {
        "source": PointerProperty(name="Source", type=bpy.types.Object,
                                  poll=lambda self, other: other.type == "MESH" and
                                  other != self.id_data, update=on_setting),
        "message": StringProperty(name="Message"),
        **make_properties(on_setting),
    }


class OBJECT_OT_hex_subdivide(bpy.types.Operator):
    """Make an object that follows the active mesh, subdivided into hexagons"""

    bl_idname = "object.hex_subdivide"
    bl_label = "Hexagonal Subdivision"
    bl_options = {"REGISTER", "UNDO"}
    __annotations__ = {
        **make_properties(None),
        "hide_source": BoolProperty(name="Hide Source in Renders",
                                    description="Render the new object alone", default=True),
    }

    @classmethod
    def poll(cls, context):
        active = context.active_object
        if active is None or active.type != "MESH" or context.mode != "OBJECT":
            cls.poll_message_set("Needs an active mesh, in Object Mode")
            return False
        return True

    def execute(self, context):
        source = context.active_object
        if source.opensubdivhex.source:
            self.report({"ERROR"}, f"'{source.name}' follows "
                        f"'{source.opensubdivhex.source.name}': change its settings instead")
            return {"CANCELLED"}
        mesh = bpy.data.meshes.new(source.name + " Hex")
        target = bpy.data.objects.new(mesh.name, mesh)
        settings = target.opensubdivhex
        for name in SETTINGS:
            setattr(settings, name, getattr(self, name))
        settings["source"] = source  # without an update yet
        try:
            follower.refine(target, context.evaluated_depsgraph_get())
        except (MeshInputError, osh.StatusError, MemoryError) as error:
            bpy.data.objects.remove(target)
            bpy.data.meshes.remove(mesh)
            self.report({"ERROR"}, follower.describe_error(error))
            return {"CANCELLED"}
        loose = follower.states[target.name].source.num_loose_edges
        if loose:
            self.report({"WARNING"}, f"{loose} loose edges are left out")
        target.parent = source
        for collection in source.users_collection:
            collection.objects.link(target)
        source.hide_render = source.hide_render or self.hide_source
        source.select_set(False)
        target.select_set(True)
        context.view_layer.objects.active = target
        return {"FINISHED"}

    def draw(self, _context):
        draw_settings(self.layout, self)
        self.layout.prop(self, "hide_source")


class OBJECT_PT_hex_subdivision(bpy.types.Panel):
    """In the properties of an object."""

    bl_label = "Hexagonal Subdivision"
    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    bl_context = "data"

    @classmethod
    def poll(cls, context):
        return context.object is not None and context.object.type == "MESH"

    def draw(self, context):
        settings = context.object.opensubdivhex
        if not settings.source:
            self.layout.operator(OBJECT_OT_hex_subdivide.bl_idname, icon="MESH_CIRCLE")
            return
        if settings.message:
            self.layout.label(text=settings.message, icon="ERROR")
        self.layout.use_property_split = True
        self.layout.prop(settings, "source")
        draw_settings(self.layout, settings)


def draw_settings(layout, settings):
    layout.use_property_split = True
    for name in SETTINGS:
        layout.prop(settings, name)


def draw_menu(self, _context):
    self.layout.operator(OBJECT_OT_hex_subdivide.bl_idname, icon="MESH_CIRCLE")


CLASSES = (HexSettings, OBJECT_OT_hex_subdivide, OBJECT_PT_hex_subdivision)


def register():
    for cls in CLASSES:
        bpy.utils.register_class(cls)
    bpy.types.Object.opensubdivhex = PointerProperty(type=HexSettings)
    bpy.types.VIEW3D_MT_object.append(draw_menu)


def unregister():
    bpy.types.VIEW3D_MT_object.remove(draw_menu)
    del bpy.types.Object.opensubdivhex
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)
