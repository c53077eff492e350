# SPDX-License-Identifier: Apache-2.0
"""Refined arrays into a Blender mesh."""

import numpy as np

from .refinement import Polygons


def write_mesh(mesh, refinement, source, materials):
    """Replaces all of a mesh but the name."""
    polygons, positions = refinement.polygons, refinement.get_positions(source)
    mesh.clear_geometry()
    mesh.materials.clear()  # which takes the material indices of faces back
    for material in materials:
        mesh.materials.append(material)
    mesh.vertices.add(len(positions))
    mesh.loops.add(len(polygons.corners))
    mesh.polygons.add(len(polygons.sizes))
    mesh.vertices.foreach_set("co", positions.ravel())
    mesh.loops.foreach_set("vertex_index", polygons.corners)
    starts = np.cumsum(polygons.sizes) - polygons.sizes
    mesh.polygons.foreach_set("loop_start", starts.astype(np.int32))
    mesh.polygons.foreach_set("loop_total", polygons.sizes.astype(np.int32))
    mesh.polygons.foreach_set("material_index", refinement.materials.astype(np.int32))
    mesh.polygons.foreach_set("use_smooth", refinement.smooth)
    mesh.update(calc_edges=True)
    mark_hard_edges(mesh, polygons)
    write_values(mesh, refinement, source)


def mark_hard_edges(mesh, polygons):
    """Marks what became of sharp edges as sharp, and has Blender shade them so."""
    mesh.use_auto_smooth = bool(len(polygons.hard))
    if not len(polygons.hard):
        return
    mesh.auto_smooth_angle = np.pi
    edges = np.empty(len(mesh.loops), np.int32)
    mesh.loops.foreach_get("edge_index", edges)
    base = np.repeat(polygons.base_faces, polygons.sizes)
    order = np.argsort(edges, kind="stable")
    edges, base = edges[order], base[order]
    pairs = np.stack([base[:-1], base[1:]], axis=1)
    is_hard = (edges[1:] == edges[:-1]) & Polygons.are_hard(pairs, polygons.hard)
    sharp = np.zeros(len(mesh.edges), bool)
    sharp[edges[1:][is_hard]] = True
    mesh.edges.foreach_set("use_edge_sharp", sharp)


def write_values(mesh, refinement, source):
    """UV maps and colours, made where they are not there yet."""
    corner_values = refinement.get_corner_values(source)
    for channel, values in zip(source.uv_maps, corner_values):
        layer = mesh.uv_layers.get(channel.name) or mesh.uv_layers.new(name=channel.name)
        layer.data.foreach_set("uv", values.ravel())
    for channel, values in zip(source.corner_colours, corner_values[len(source.uv_maps):]):
        write_colours(mesh, channel.name, channel.data_type, "CORNER", values)
    for name, data_type, colours in source.point_colours:
        write_colours(mesh, name, data_type, "POINT", refinement.get_varying(colours))


def write_colours(mesh, name, data_type, domain, colours):
    attribute = (mesh.color_attributes.get(name) or
                 mesh.color_attributes.new(name=name, type=data_type, domain=domain))
    attribute.data.foreach_set("color", np.clip(colours, 0, None).ravel())


def write_groups(target, refinement, source):
    """Vertex groups belong to the object."""
    target.vertex_groups.clear()
    if not source.group_names:
        return
    weights = refinement.get_varying(source.weights)
    for number, name in enumerate(source.group_names):
        group = target.vertex_groups.new(name=name)
        values, indices = np.unique(weights[:, number], return_inverse=True)
        order = np.argsort(indices, kind="stable")
        ends = np.searchsorted(indices[order], np.arange(1, len(values) + 1))
        begin = 0
        for value, end in zip(values, ends):
            if value > 0:
                group.add(order[begin:end].tolist(), float(value), "REPLACE")
            begin = end


def write_positions(mesh, refinement, source):
    """The positions alone, for a frame."""
    mesh.vertices.foreach_set("co", refinement.get_positions(source).ravel())
    mesh.update()
