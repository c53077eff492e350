# SPDX-License-Identifier: Apache-2.0
"""Levels as arrays: what they say, that they are views, and how long they hold."""

import gc

import numpy as np
import opensubdivhex as osh
import pytest
from meshes import CUBE_FACES, CUBE_POSITIONS, make_grid, make_torus

RELATIONS = ["face_offsets", "face_vertices", "face_edges", "edge_vertices", "edge_faces",
             "vertex_face_offsets", "vertex_faces", "vertex_edge_offsets", "vertex_edges"]


def refine(faces, level, full=True, **options):
    refiner = osh.TopologyRefiner(faces, **options)
    refiner.refine_uniform(level, full_topology_in_last_level=full)
    return refiner


@pytest.mark.parametrize("faces, options", [
    (CUBE_FACES, {}), (make_torus(6, 5)[1], {}), (make_grid(3, 2)[1], {}),
    (make_grid(3, 2)[1], {"vtx_boundary_interpolation": "edge_only"})])
@pytest.mark.parametrize("number", [0, 1, 2])
def test_relations_agree_with_each_other(faces, options, number):
    level = refine(faces, 2, **options).get_level(number)
    offsets, corners, edges = level.face_offsets, level.face_vertices, level.face_edges
    edge_vertices, edge_faces = level.edge_vertices, level.edge_faces
    assert len(offsets) == level.num_faces + 1 and len(corners) == level.num_face_vertices
    assert edge_vertices.shape == edge_faces.shape == (level.num_edges, 2)
    face_of = np.repeat(np.arange(level.num_faces), np.diff(offsets))
    following = np.arange(1, len(corners) + 1)
    following[offsets[1:] - 1] = offsets[:-1]
    ends = np.stack([corners, corners[following]], axis=1)
    np.testing.assert_array_equal(np.sort(ends, axis=1), np.sort(edge_vertices[edges], axis=1))
    # A face runs along its edge if and only if it is the edge's first.
    runs_along = (ends == edge_vertices[edges]).all(axis=1)
    np.testing.assert_array_equal(runs_along, edge_faces[edges, 0] == face_of)
    np.testing.assert_array_equal(edge_faces[edges, np.where(runs_along, 0, 1)], face_of)
    # Each vertex lists the faces and edges that list it.
    at = level.vertex_face_offsets
    assert len(at) == level.num_vertices + 1
    vertex_of = np.repeat(np.arange(level.num_vertices), np.diff(at))
    assert (sorted(zip(vertex_of, level.vertex_faces)) == sorted(zip(corners, face_of)))
    vertex_of = np.repeat(np.arange(level.num_vertices), np.diff(level.vertex_edge_offsets))
    assert (sorted(zip(vertex_of, level.vertex_edges)) ==
            sorted((v, e) for e, pair in enumerate(edge_vertices) for v in pair))
    boundary = level.is_edge_boundary()
    np.testing.assert_array_equal(boundary, edge_faces[:, 1] < 0)
    assert np.count_nonzero(boundary) == level.num_boundary_edges
    on_boundary = np.zeros(level.num_vertices, dtype=bool)
    on_boundary[edge_vertices[boundary]] = True
    np.testing.assert_array_equal(level.is_vertex_boundary(), on_boundary)
    np.testing.assert_array_equal(level.is_vertex_corner(),
                                  np.diff(level.vertex_face_offsets) == 1)
    level.validate()


def test_relations_are_views():
    level = refine(CUBE_FACES, 1).get_level(1)
    for name in RELATIONS:
        first, second = getattr(level, name), getattr(level, name)
        assert first.dtype == np.int32
        assert first.ctypes.data == second.ctypes.data, name
        assert not first.flags.owndata and not first.flags.writeable
        with pytest.raises(ValueError):
            first[0] = 7
        with pytest.raises(ValueError):
            first.flags.writeable = True


def test_views_keep_what_they_show():
    expected = refine(CUBE_FACES, 3).get_level(3).face_vertices.copy()
    refiner = refine(CUBE_FACES, 3)
    vertices = refiner.get_level(3).face_vertices
    del refiner
    gc.collect()
    for _ in range(3):  # memory that was free would be taken
        refine(CUBE_FACES, 3)
    np.testing.assert_array_equal(vertices, expected)


def test_views_hold_the_refiner_from_refining():
    refiner = refine(CUBE_FACES, 2)
    vertices = refiner.get_level(2).face_vertices[::2]
    for change in (lambda: refiner.refine_uniform(1), refiner.unrefine,
                   lambda: refiner.refine_coplanar(np.zeros((8, 3), np.float32), 1)):
        with pytest.raises(BufferError, match="copy them"):
            change()
    assert refiner.max_level == 2
    del vertices
    refiner.refine_uniform(1)
    assert refiner.max_level == 1


def test_levels_get_out_of_date():
    refiner = refine(CUBE_FACES, 2)
    level = refiner.get_level(1)
    refiner.refine_uniform(2)
    for use in (lambda: level.num_faces, lambda: level.face_vertices, level.get_face_kinds,
                level.validate, lambda: osh.LimitSides(level)):
        with pytest.raises(RuntimeError, match="refined"):
            use()


def test_a_last_level_without_topology_says_so():
    level = refine(CUBE_FACES, 2, full=False).get_level(2)
    assert not level.has_full_topology
    assert len(level.face_vertices) == level.num_face_vertices
    for name in RELATIONS[2:]:
        with pytest.raises(ValueError, match="full_topology_in_last_level"):
            getattr(level, name)
    for query in (level.is_face_half, level.get_edge_sharpness, level.is_vertex_boundary,
                  lambda: level.find_edge(0, 1), lambda: osh.LimitSides(level)):
        with pytest.raises(ValueError, match="full_topology_in_last_level"):
            query()


def test_kinds_and_parents():
    refiner = refine(CUBE_FACES, 2)
    level, parent = refiner.get_level(2), refiner.get_level(1)
    kinds = level.get_face_kinds()
    assert (kinds[:18] == int(osh.FaceKind.FACE)).all()
    assert (kinds[18:] == int(osh.FaceKind.EDGE)).all()
    assert (refiner.get_level(0).get_face_kinds() == int(osh.FaceKind.BASE)).all()
    parents = level.get_face_parent_faces()
    np.testing.assert_array_equal(parents[:18], np.arange(18))
    edges = level.get_face_parent_edges()
    np.testing.assert_array_equal(edges, np.r_[np.full(18, -1), np.arange(48)])
    np.testing.assert_array_equal(parents[18:], parent.edge_faces[:, 0])
    base = level.get_face_base_faces()
    np.testing.assert_array_equal(base[:18], parent.get_face_base_faces())
    assert (level.get_face_parent_vertices() == -1).all()
    np.testing.assert_array_equal(parent.get_edge_child_faces(), 18 + np.arange(48))
    np.testing.assert_array_equal(parent.get_vertex_child_vertices(), np.arange(32))


def test_a_crease_crosses_hexagons():
    refiner = refine(CUBE_FACES, 1, creases=([[0, 1]], 3))
    level = refiner.get_level(1)
    edge = refiner.get_level(0).find_edge(0, 1)
    sharpness = level.get_face_diagonal_sharpness()
    assert sharpness[6 + edge] == 2 and np.count_nonzero(sharpness) == 1
    assert not level.is_face_half().any()
    rules = refiner.get_level(0).get_vertex_rules()
    np.testing.assert_array_equal(np.nonzero(rules == int(osh.Rule.DART))[0], [0, 1])


def test_sharp_boundaries_cut_hexagons():
    level = refine(make_grid(2, 2)[1], 1,
                   vtx_boundary_interpolation="edge_only").get_level(1)
    assert np.count_nonzero(level.is_face_half()) == 8


def test_non_manifold_edges_are_told():
    refiner = refine([[0, 1, 2], [1, 0, 3], [0, 1, 4]], 1)
    level = refiner.get_level(0)
    ends = np.sort(level.edge_vertices, axis=1)
    np.testing.assert_array_equal(level.is_edge_non_manifold(), (ends == [0, 1]).all(axis=1))
    np.testing.assert_array_equal(np.nonzero(level.is_vertex_non_manifold())[0], [0, 1])


def test_find_edge():
    level = osh.TopologyRefiner(CUBE_FACES).get_level(0)
    for edge, (v0, v1) in enumerate(level.edge_vertices.tolist()):
        assert level.find_edge(v0, v1) == edge == level.find_edge(v1, v0)
    assert level.find_edge(0, 7) is None


def test_face_varying_values_and_seams():
    # Two faces that share an edge, with a seam along it, and another channel without.
    faces = [[0, 1, 4, 3], [1, 2, 5, 4]]
    refiner = refine(faces, 1, fvar_channels=[np.arange(8), np.array(faces).ravel()])
    base = refiner.get_level(0)
    assert refiner.num_fvar_channels == base.num_fvar_channels == 2
    assert base.get_num_fvar_values(0) == 8 and base.get_num_fvar_values(1) == 6
    np.testing.assert_array_equal(base.get_face_fvar_values(0), np.arange(8))
    np.testing.assert_array_equal(base.get_face_fvar_values(1), base.face_vertices)
    seam = base.find_edge(1, 4)
    assert not base.does_edge_fvar_topology_match(0)[seam]
    assert base.does_edge_fvar_topology_match(1).all()
    np.testing.assert_array_equal(np.nonzero(~base.does_vertex_fvar_topology_match(0))[0], [1, 4])
    assert not base.does_face_fvar_topology_match(0).any()
    assert base.does_face_fvar_topology_match(1).all()

    level = refiner.get_level(1)
    split, values = level.get_fvar_split_faces(0)
    np.testing.assert_array_equal(split, [2 + seam])
    assert values.shape == (1, 2, 4)
    assert not set(values[0, 0]) & set(values[0, 1])
    first = level.get_face_fvar_values(0)[level.face_offsets[split[0]]:][:6]
    np.testing.assert_array_equal(first[[0, 3, 4, 5]], values[0, 0])
    assert len(level.get_fvar_split_faces(1)[0]) == 0


def test_limit_sides_of_a_cut_cube():
    edges = [[0, 1], [1, 3], [3, 2], [2, 0]]
    level = refine(CUBE_FACES, 1, creases=(edges, 10)).get_level(0)
    sides = osh.LimitSides(level)
    assert sides.num_vertices == 8 and sides.num_sides == 12
    np.testing.assert_array_equal(sides.get_vertices(), [0, 1, 2, 3, 4, 5, 6, 7, 0, 1, 2, 3])
    np.testing.assert_array_equal(sides.get_local_sides(), [0] * 8 + [1] * 4)
    found = sides.find_sides(level)
    np.testing.assert_array_equal(sides.get_vertices()[found], level.face_vertices)
    top = set(found[0:4])
    assert not top & set(found[4:])
    with pytest.raises(ValueError, match="another level"):
        sides.find_sides(osh.TopologyRefiner(make_grid(1, 1)[1]).get_level(0))
    # One with as many vertices.
    smooth = refine(CUBE_FACES, 1).get_level(0)
    with pytest.raises(ValueError, match="another level"):
        sides.find_sides(smooth)
    with pytest.raises(osh.StatusError, match="another level than level 0"):
        osh.create_polygon_indices(smooth, sides=sides, split_vertices=True)
    with pytest.raises(osh.StatusError, match="vertex offset is -1"):
        osh.create_polygon_indices(smooth, vertex_offset=-1)


def make_box_refiner(level, **options):
    """A cube with all edges sharp, so that refined faces stay in the planes of the base's."""
    edges = osh.TopologyRefiner(CUBE_FACES).get_level(0).edge_vertices.copy()
    return refine(CUBE_FACES, level, creases=(edges, 10), **options)


def test_base_faces_are_exact():
    refiner = make_box_refiner(3)
    level = refiner.get_level(3)
    split = level.is_face_base_split()
    halves = np.stack([level.get_face_base_faces(0), level.get_face_base_faces(1)], axis=1)
    np.testing.assert_array_equal(split, halves[:, 0] != halves[:, 1])
    assert split.any()
    positions = osh.RefinementEvaluator(refiner).evaluate(CUBE_POSITIONS)
    normals = [CUBE_POSITIONS[face].mean(axis=0) for face in CUBE_FACES]
    for corners, bases in zip(np.split(level.face_vertices, level.face_offsets[1:-1]), halves):
        for half, places in enumerate(([0, 3, 4, 5], [3, 0, 1, 2])):
            part = corners[places] if bases[0] != bases[1] else corners
            np.testing.assert_allclose(positions[part] @ normals[bases[half]], 1, atol=1e-5)


def measure_areas(uv):
    """Signed areas of polygons of the shape (n, corners, 2)."""
    after = np.roll(uv, -1, axis=1)
    return (uv[..., 0] * after[..., 1] - after[..., 0] * uv[..., 1]).sum(axis=1) / 2


@pytest.mark.parametrize("depth", [0, 1, 2, 3])
def test_corners_have_places_in_base_faces(depth):
    # A channel with a chart for each base face, linear all over, holds the same places, until half
    # faces, whose centre is another to it, have children.
    refiner = refine(CUBE_FACES, depth, fvar_channels=[np.arange(24)],
                     fvar_linear_interpolation="all")
    level = refiner.get_level(depth)
    square = np.float32([[0, 0], [1, 0], [1, 1], [0, 1]])
    charts = osh.RefinementEvaluator(refiner, interpolation_mode="face_varying").evaluate(
        np.tile(square, (6, 1)))
    split, halves = level.get_fvar_split_faces()
    np.testing.assert_array_equal(split, np.nonzero(level.is_face_base_split())[0])
    assert bool(len(split)) == (depth > 0)
    starts = level.face_offsets[split]
    is_split = np.zeros(level.num_face_vertices, bool)
    is_split[np.repeat(starts, 6) + np.tile(np.arange(6), len(starts))] = True
    areas = np.zeros(6)
    for half, places in enumerate(([0, 3, 4, 5], [3, 0, 1, 2])):
        coords = level.get_face_base_coords(half)
        corners = starts[:, None] + places
        if depth <= 2:
            np.testing.assert_allclose(coords[corners], charts[halves[:, half]], atol=1e-6)
            np.testing.assert_allclose(coords[~is_split],
                                       charts[level.get_face_fvar_values()[~is_split]], atol=1e-6)
        areas += np.bincount(level.get_face_base_faces(half)[split],
                             measure_areas(coords[corners]), 6)
        assert np.isnan(coords).sum() == 4 * len(split)
    # They tile the squares.
    bases = level.get_face_base_faces()
    for f in np.nonzero(~level.is_face_base_split())[0]:
        span = slice(level.face_offsets[f], level.face_offsets[f + 1])
        areas[bases[f]] += measure_areas(coords[span][None])[0]
    np.testing.assert_allclose(areas, 1, atol=1e-6)


def test_places_in_base_faces_need_hexagonal_steps():
    level = refine(CUBE_FACES, 1, scheme_type="doo_sabin").get_level(1)
    with pytest.raises(ValueError, match="hexagonal"):
        level.get_face_base_coords()
    with pytest.raises(IndexError, match="half"):
        level.get_face_base_coords(2)


@pytest.mark.parametrize("cut_base_faces, labels", [
    (True, None), (False, [7, 7, 7, 7, 7, 7]), (False, [1, 2, 1, 1, 1, 1])])
def test_polygons_are_cut_where_asked(cut_base_faces, labels):
    level = refine(CUBE_FACES, 2).get_level(2)
    polygons = osh.create_polygon_indices(level, cut_base_faces=cut_base_faces, labels=labels,
                                          vertex_offset=100)
    halves = np.stack([level.get_face_base_faces(0), level.get_face_base_faces(1)], axis=1)
    given = np.array(labels or np.arange(6))
    cut = given[halves[:, 0]] != given[halves[:, 1]]
    assert cut.any() == (cut_base_faces or len(set(labels)) > 1)
    expected = []
    for f, corners in enumerate(np.split(level.face_vertices, level.face_offsets[1:-1])):
        if cut[f]:
            expected += [(f, halves[f, 0], list(corners[[0, 3, 4, 5]])),
                         (f, halves[f, 1], list(corners[[3, 0, 1, 2]]))]
        else:
            expected.append((f, halves[f, 0], list(corners)))
    found = np.split(polygons["vertices"] - 100, np.cumsum(polygons["sizes"])[:-1])
    assert [(f, b, list(c)) for f, b, c in zip(
        polygons["faces"], polygons["base_faces"], found)] == expected
    if labels:
        np.testing.assert_array_equal(polygons["labels"], given[polygons["base_faces"]])
    else:
        assert "labels" not in polygons
    assert polygons["fvar_values"] == [] and "sides" not in polygons


def test_polygons_have_values_sides_and_places():
    refiner = make_box_refiner(2, fvar_channels=[np.arange(24), np.ravel(CUBE_FACES)])
    level, sides = refiner.get_level(2), osh.LimitSides(refiner.get_level(2))
    polygons = osh.create_polygon_indices(level, fvar_channels=[1, 0], sides=sides,
                                          generate_base_coords=True)
    corners = len(polygons["vertices"])
    assert corners == polygons["sizes"].sum()
    assert [len(values) for values in polygons["fvar_values"]] == [corners] * 2
    # The second channel is the mesh itself; the first has one chart for each base face.
    np.testing.assert_array_equal(polygons["fvar_values"][0], polygons["vertices"])
    base = np.repeat(polygons["base_faces"], polygons["sizes"])
    charts = {}
    for value, face in zip(polygons["fvar_values"][1], base):
        assert charts.setdefault(value, face) == face
    np.testing.assert_array_equal(sides.get_vertices()[polygons["sides"]], polygons["vertices"])
    assert polygons["base_coords"].shape == (corners, 2)
    assert polygons["base_coords"].min() == 0 and polygons["base_coords"].max() == 1
    split = osh.create_polygon_indices(level, sides=sides, split_vertices=True)
    np.testing.assert_array_equal(split["vertices"], split["sides"])


def test_separate_vertices_have_one_value_and_side():
    refiner = make_box_refiner(2, fvar_channels=[np.arange(24)])
    level, sides = refiner.get_level(2), osh.LimitSides(refiner.get_level(2))
    options = {"fvar_channels": [0], "sides": sides}
    whole = osh.create_polygon_indices(level, **options)
    assert "drawn_vertices" not in whole
    for create, values in ((osh.create_polygon_indices, whole),
                           (osh.create_triangle_indices,
                            osh.create_triangle_indices(level, **options))):
        faces = create(level, separate_vertices=True, vertex_offset=7, **options)
        drawn, corners = faces["drawn_vertices"], faces["vertices"] - 7
        # Two vertices inside each edge of the box are there twice, its corners three times.
        assert drawn["vertices"].shape == (level.num_vertices + 12 * 2 + 8 * 2,)
        np.testing.assert_array_equal(drawn["vertices"][corners], values["vertices"])
        np.testing.assert_array_equal(drawn["sides"][corners], values["sides"])
        np.testing.assert_array_equal(drawn["fvar_values"][0][corners], values["fvar_values"][0])
        assert "base_coords" not in drawn


def test_separate_vertices_have_one_place():
    level = refine(CUBE_FACES, 2).get_level(2)
    faces = osh.create_polygon_indices(level, separate_vertices=True, generate_base_coords=True)
    drawn, corners = faces["drawn_vertices"], faces["vertices"]
    assert drawn["base_coords"].shape == (level.num_vertices + 12 * 2 + 8 * 2, 2)
    np.testing.assert_array_equal(drawn["base_coords"][corners], faces["base_coords"])
    np.testing.assert_array_equal(drawn["base_faces"][corners],
                                  np.repeat(faces["base_faces"], faces["sizes"]))


def test_holes_are_left_out():
    refiner = refine(CUBE_FACES, 1, holes=[1])
    level = refiner.get_level(1)
    polygons = osh.create_polygon_indices(level)
    assert 1 not in polygons["base_faces"] and len(set(polygons["base_faces"])) == 5
    everything = osh.create_polygon_indices(level, draw_holes=True)
    assert np.count_nonzero(everything["base_faces"] == 1) == 5
    halves = np.stack([level.is_face_hole(0), level.is_face_hole(1)])
    np.testing.assert_array_equal(level.is_face_hole(), halves.all(axis=0))
    assert np.count_nonzero(halves[0] != halves[1]) == 4


def test_triangles_cover_polygons():
    refiner = refine(CUBE_FACES, 1, holes=[1], fvar_channels=[np.arange(24)])
    level = refiner.get_level(1)
    options = {"fvar_channels": [0], "vertex_offset": 100, "generate_base_coords": True}
    polygons = osh.create_polygon_indices(level, **options)
    triangles = osh.create_triangle_indices(level, **options)
    count = (polygons["sizes"] - 2).sum()
    assert triangles["vertices"].shape == triangles["fvar_values"][0].shape == (count, 3)
    assert triangles["base_coords"].shape == (count, 3, 2)
    np.testing.assert_array_equal(triangles["base_faces"],
                                  np.repeat(polygons["base_faces"], polygons["sizes"] - 2))
    assert triangles["vertices"].min() >= 100
    for face, triangle in zip(triangles["faces"], triangles["vertices"] - 100):
        begin, end = level.face_offsets[face:face + 2]
        assert set(triangle) <= set(level.face_vertices[begin:end])


@pytest.mark.parametrize("arguments, error", [
    ({"labels": [1, 2]}, osh.StatusError), ({"fvar_channels": [0]}, osh.StatusError),
    ({"split_vertices": True}, osh.StatusError), ({"labels": [0.5] * 6}, TypeError),
    ({"cut_creases": "some"}, ValueError), ({"fvar_channels": "ab"}, TypeError),
    ({"sides": osh.LimitSides(osh.TopologyRefiner([[0, 1, 2]]).get_level(0))}, osh.StatusError)])
def test_polygons_that_cannot_be_drawn(arguments, error):
    level = refine(CUBE_FACES, 1).get_level(1)
    for create in (osh.create_polygon_indices, osh.create_triangle_indices):
        with pytest.raises(error):
            create(level, **arguments)
