# SPDX-License-Identifier: Apache-2.0
"""Objects that follow a source: what is kept of them between frames, and when they are refined."""

import bpy
import numpy as np
import opensubdivhex as osh
from bpy.app.handlers import persistent

from .mesh_input import MeshInput, MeshInputError, are_equal
from .mesh_output import write_groups, write_mesh, write_positions, write_values
from .refinement import Options, Refinement


class State:
    """What an object was made from last."""

    def __init__(self, refinement, source, mesh):
        self.refinement = refinement
        self.source = source
        self.vertices = len(mesh.vertices)


# By the name of the object.  A state is compared with what it is for before it is used, so that one
# of another time, as after an undo, does no harm.
states = {}
is_updating = False


def describe_error(error):
    """As Blender's messages read: a sentence without a full stop."""
    message = str(error).rstrip(".")
    return message[:1].upper() + message[1:]


def read_source(source, depsgraph):
    evaluated = source.evaluated_get(depsgraph)
    mesh = evaluated.to_mesh()
    if mesh is None:
        raise MeshInputError(f"'{source.name}' has no mesh")
    try:
        return MeshInput(mesh, [group.name for group in source.vertex_groups])
    finally:
        evaluated.to_mesh_clear()


def get_options(settings):
    return Options(settings.level, settings.mask.lower(), settings.boundary.lower(),
                   settings.use_limit, settings.sharp_edges, settings.use_holes,
                   settings.uv_smooth.lower(), settings.first_step.lower())


def refine(target, depsgraph):
    """Brings an object up to date.  Raises MeshInputError or StatusError; then it is as before."""
    settings = target.opensubdivhex
    if target.mode == "EDIT":
        raise MeshInputError(f"'{target.name}' is in Edit Mode and follows afterwards")
    source = read_source(settings.source, depsgraph)
    options = get_options(settings)
    state, mesh = states.get(target.name), target.data
    materials = [slot.material for slot in settings.source.material_slots]
    if (state is None or not state.refinement.fits(source, options) or
            state.source.get_names() != source.get_names() or
            len(mesh.vertices) != state.vertices or list(mesh.materials) != materials):
        refinement = state.refinement if state and state.refinement.fits(source, options) else None
        refinement = refinement or Refinement(source, options)
        write_mesh(mesh, refinement, source, materials)
        write_groups(target, refinement, source)
        states[target.name] = State(refinement, source, mesh)
        return
    if not are_equal(state.source.get_values(), source.get_values()):
        write_values(mesh, state.refinement, source)
        if not np.array_equal(state.source.weights, source.weights):
            write_groups(target, state.refinement, source)
    if not np.array_equal(state.source.positions, source.positions):
        write_positions(mesh, state.refinement, source)
    state.source = source


def update(target, depsgraph):
    """The same where nobody waits for an answer: the panel shows what went wrong."""
    global is_updating
    if is_updating:
        return
    is_updating = True
    try:
        refine(target, depsgraph)
        message = ""
    except (MeshInputError, osh.StatusError, MemoryError) as error:
        message = describe_error(error)
    finally:
        is_updating = False
    if target.opensubdivhex.message != message:
        target.opensubdivhex.message = message


def list_followers(scene):
    return [target for target in scene.objects
            if target.type == "MESH" and target.opensubdivhex.source]


@persistent
def on_depsgraph_update(scene, depsgraph):
    changed = {item.id.original for item in depsgraph.updates if item.is_updated_geometry}
    if not changed or is_updating:
        return
    for target in list_followers(scene):
        source = target.opensubdivhex.source
        if source in changed or source.data in changed:
            update(target, depsgraph)


@persistent
def on_frame_change(scene, depsgraph):
    for target in list_followers(scene):
        update(target, depsgraph)


@persistent
def on_history(*_):
    states.clear()


HANDLERS = [(bpy.app.handlers.depsgraph_update_post, on_depsgraph_update),
            (bpy.app.handlers.frame_change_post, on_frame_change),
            (bpy.app.handlers.undo_post, on_history),
            (bpy.app.handlers.redo_post, on_history),
            (bpy.app.handlers.load_post, on_history)]


def register():
    for handlers, function in HANDLERS:
        handlers.append(function)


def unregister():
    for handlers, function in HANDLERS:
        handlers.remove(function)
    states.clear()
