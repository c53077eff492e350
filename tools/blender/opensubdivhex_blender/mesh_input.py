# SPDX-License-Identifier: Apache-2.0
"""A Blender mesh as arrays, with its creases, maps and colours."""

import numpy as np


class MeshInputError(Exception):
    """A mesh that cannot be refined, in words for Blender's user."""


def get(collection, name, dtype, width=1):
    """One property of all items of a collection: shape (items,) or (items, width)."""
    values = np.empty(len(collection) * width, dtype)
    collection.foreach_get(name, values)
    return values if width == 1 else values.reshape(-1, width)


def crease_to_sharpness(crease):
    """As Blender's own subdivision does it: 10 crease^2, and OpenSubdiv takes 10 as infinite."""
    return 10 * np.square(crease)


def weld(vertices, values):
    """One index for all corners of a vertex that have the same value, and the values by index."""
    keys = np.column_stack([vertices.astype(np.float64), values])
    _, first, indices = np.unique(keys, axis=0, return_index=True, return_inverse=True)
    return indices.reshape(-1).astype(np.int32), values[first]


class Channel:
    """Values of corners, such as a UV map, as a face-varying channel."""

    def __init__(self, name, vertices, values):
        self.name = name
        self.indices, self.values = weld(vertices, values)


class MeshInput:
    """What the refinement of a mesh depends on.  Nothing refers to Blender's mesh afterwards."""

    def __init__(self, mesh, group_names, has_creases=True):
        polygons = mesh.polygons
        if not len(polygons):
            raise MeshInputError("The mesh has no faces to subdivide")
        starts, sizes = get(polygons, "loop_start", np.int32), get(polygons, "loop_total", np.int32)
        self.offsets = np.concatenate([[0], np.cumsum(sizes)]).astype(np.int32)
        vertices = get(mesh.loops, "vertex_index", np.int32)
        # Blender's faces need not lie one behind the other.
        self.loops = np.repeat(starts - self.offsets[:-1], sizes) + np.arange(self.offsets[-1])
        self.corners = vertices[self.loops]
        self.positions = get(mesh.vertices, "co", np.float32, 3)

        self.edges = get(mesh.edges, "vertices", np.int32, 2)
        creases = get(mesh.edges, "crease", np.float32) if has_creases else np.zeros(0)
        self.edge_sharpness = np.zeros(len(self.edges), np.float32)
        if len(creases):
            self.edge_sharpness[:] = crease_to_sharpness(creases)
        loose = get(mesh.edges, "is_loose", bool)
        self.num_loose_edges = int(np.count_nonzero(loose))
        self.edge_sharpness[loose] = 0
        self.sharp_edges = get(mesh.edges, "use_edge_sharp", bool) & ~loose
        self.vertex_sharpness = np.zeros(len(mesh.vertices), np.float32)
        if has_creases and len(mesh.vertex_creases):
            self.vertex_sharpness[:] = crease_to_sharpness(
                get(mesh.vertex_creases[0].data, "value", np.float32))

        self.materials = get(polygons, "material_index", np.int32)
        self.smooth = get(polygons, "use_smooth", bool)
        self.hidden = get(polygons, "hide", bool)

        self.uv_maps = [Channel(layer.name, self.corners,
                                get(layer.data, "uv", np.float32, 2)[self.loops])
                        for layer in mesh.uv_layers]
        self.corner_colours, self.point_colours = [], []
        for attribute in mesh.color_attributes:
            colours = get(attribute.data, "color", np.float32, 4)
            if attribute.domain == "CORNER":
                channel = Channel(attribute.name, self.corners, colours[self.loops])
                channel.data_type = attribute.data_type
                self.corner_colours.append(channel)
            else:
                self.point_colours.append((attribute.name, attribute.data_type, colours))
        self.group_names = group_names
        self.weights = np.zeros((len(mesh.vertices), len(group_names)), np.float32)
        if group_names:
            for index, vertex in enumerate(mesh.vertices):
                for element in vertex.groups:
                    if element.group < len(group_names):
                        self.weights[index, element.group] = element.weight

    def get_channels(self):
        return self.uv_maps + self.corner_colours

    def get_topology(self):
        """All that the refined topology depends on; equal for meshes that differ in values alone."""
        return ([self.offsets, self.corners, np.array([len(self.positions)]), self.edges,
                 self.edge_sharpness, self.sharp_edges, self.vertex_sharpness, self.materials,
                 self.smooth, self.hidden] + [channel.indices for channel in self.get_channels()])

    def get_values(self):
        """All values but the positions."""
        return ([channel.values for channel in self.get_channels()] +
                [colours for *_, colours in self.point_colours] + [self.weights])

    def get_names(self):
        """What the maps, colours and groups are called."""
        return ([channel.name for channel in self.uv_maps],
                [(channel.name, channel.data_type) for channel in self.corner_colours],
                [colour[:2] for colour in self.point_colours], list(self.group_names))


def are_equal(arrays, others):
    return (len(arrays) == len(others) and
            all(np.array_equal(a, b) for a, b in zip(arrays, others)))
