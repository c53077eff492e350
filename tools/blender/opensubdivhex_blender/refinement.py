# SPDX-License-Identifier: Apache-2.0
"""A refined mesh: its polygons once, and its values as often as the source changes."""

import numpy as np
import opensubdivhex as osh

from .mesh_input import are_equal


class Options:
    """How a mesh is refined."""

    def __init__(self, level=2, mask="smooth", boundary="edge_only", use_limit=False,
                 sharp_edges="SHADE", use_holes=False, uv_smooth="boundaries",
                 first_step="none"):
        self.level = level
        self.mask = mask
        self.boundary = boundary
        self.use_limit = use_limit
        self.sharp_edges = sharp_edges
        self.use_holes = use_holes
        self.uv_smooth = uv_smooth
        self.first_step = first_step

    def __eq__(self, other):
        return vars(self) == vars(other)


def create_refiner(mesh, options):
    sharpness = mesh.edge_sharpness
    if options.sharp_edges == "CREASE":
        sharpness = np.where(mesh.sharp_edges, np.float32(osh.SHARPNESS_INFINITE), sharpness)
    creased, corners = np.nonzero(sharpness)[0], np.nonzero(mesh.vertex_sharpness)[0]
    channels = mesh.get_channels()
    refiner = osh.TopologyRefiner(
        mesh.corners, len(mesh.positions), face_offsets=mesh.offsets,
        creases=(mesh.edges[creased], sharpness[creased]),
        corners=(corners, mesh.vertex_sharpness[corners]),
        holes=np.nonzero(mesh.hidden)[0] if options.use_holes else None,
        fvar_channels=[channel.indices for channel in channels],
        num_fvar_values=[len(channel.values) for channel in channels] or None,
        vtx_boundary_interpolation=options.boundary, fvar_linear_interpolation=options.uv_smooth,
        face_mask=options.mask, first_step=options.first_step)
    refiner.refine_uniform(options.level, full_topology_in_last_level=options.use_limit,
                           face_labels=find_parted_faces(refiner, mesh))
    return refiner, sharpness


def find_labels(mesh):
    """The same number for faces with the same material and shading."""
    return np.unique(np.stack([mesh.materials, mesh.smooth], axis=1), axis=0,
                     return_inverse=True)[1].reshape(-1)


def find_edges(level, edges):
    """Of all edges of a level, those that join the pairs of vertices."""
    ends = np.sort(level.edge_vertices, axis=1).astype(np.int64)
    wanted = np.sort(edges, axis=1).astype(np.int64)
    scale = level.num_vertices
    return np.isin(ends[:, 0] * scale + ends[:, 1], wanted[:, 0] * scale + wanted[:, 1])


def find_parted_faces(refiner, mesh):
    """Labels, and a number of its own for each face beside an edge that is sharp in shading: a
    truncation then cuts along all that shows."""
    level = refiner.get_level(0)
    labels = find_labels(mesh)
    beside = np.unique(level.edge_faces[find_edges(level, mesh.edges[mesh.sharp_edges])])
    beside = beside[beside >= 0]
    labels[beside] = len(labels) + np.arange(len(beside))
    return labels


class Polygons:
    """The polygons that are drawn of a level: faces, or halves of hexagons.

    A hexagon that the line of a base edge crosses lies in two base faces.  It is cut where these
    differ in material or shading, or the edge is sharp, and where a seam of a channel crosses it.
    """

    def __init__(self, refiner, level, mesh, sharpness, options):
        # Sharpness falls by one per level; what is left of it bends faces here, and shading with them.
        creased = (sharpness >= osh.SHARPNESS_INFINITE) | (sharpness > options.level)
        drawn = osh.create_polygon_indices(
            level, cut_base_faces=bool((mesh.sharp_edges & ~creased).any()),
            labels=find_labels(mesh), fvar_channels=range(level.num_fvar_channels))
        self.sizes, self.corners = drawn["sizes"], drawn["vertices"]
        self.values, self.base_faces = drawn["fvar_values"], drawn["base_faces"]
        self.hard = self.find_hard_pairs(refiner, mesh.edges[mesh.sharp_edges | creased])

    @staticmethod
    def find_hard_pairs(refiner, edges):
        """The pairs of base faces with a hard edge between, each as one number, ascending."""
        level = refiner.get_level(0)
        pairs = level.edge_faces[find_edges(level, edges) & (level.edge_faces[:, 1] >= 0)]
        return Polygons.number_pairs(pairs)

    @staticmethod
    def number_pairs(pairs):
        ordered = np.sort(pairs, axis=1).astype(np.int64)
        return (ordered[:, 0] << 32) | ordered[:, 1]

    @staticmethod
    def are_hard(pairs, hard):
        return (pairs[:, 0] != pairs[:, 1]) & np.isin(Polygons.number_pairs(pairs), hard)


class Refinement:
    """The refinement of a mesh.  Another mesh with the same topology has only its values refined."""

    def __init__(self, mesh, options):
        self.options = options
        self.topology = mesh.get_topology()
        self.refiner, sharpness = create_refiner(mesh, options)
        self.level = self.refiner.get_level(options.level)
        self.polygons = Polygons(self.refiner, self.level, mesh, sharpness, options)
        self.materials = mesh.materials[self.polygons.base_faces]
        self.smooth = mesh.smooth[self.polygons.base_faces]
        self.vertex_evaluator = osh.RefinementEvaluator(self.refiner)
        self.varying_evaluator = None

    def fits(self, mesh, options):
        return self.options == options and are_equal(self.topology, mesh.get_topology())

    def get_positions(self, mesh):
        if self.options.use_limit:
            return self.vertex_evaluator.evaluate_limit(mesh.positions)
        return self.vertex_evaluator.evaluate(mesh.positions)

    def get_varying(self, values):
        """Colours and weights of vertices: linear."""
        if self.varying_evaluator is None:
            self.varying_evaluator = osh.RefinementEvaluator(self.refiner,
                                                             interpolation_mode="varying")
        return self.varying_evaluator.evaluate(np.ascontiguousarray(values))

    def get_corner_values(self, mesh):
        """For each channel its values at the corners of the polygons."""
        result = []
        for number, channel in enumerate(mesh.get_channels()):
            evaluator = osh.RefinementEvaluator(self.refiner, interpolation_mode="face_varying",
                                                fvar_channel=number)
            values = evaluator.evaluate(np.ascontiguousarray(channel.values, np.float32))
            result.append(values[self.polygons.values[number]])
        return result
