# SPDX-License-Identifier: Apache-2.0
"""Surfaces of base faces and tessellations, against the limits of refined levels."""

import numpy as np
import opensubdivhex as osh
import pytest
from meshes import PYRAMID_FACES, PYRAMID_POSITIONS, make_torus

POSITIONS, FACES = make_torus(8, 6)
UV = np.stack(np.meshgrid(np.linspace(0, 1, 6), np.linspace(0, 1, 6)), axis=-1).reshape(-1, 2)


def make_refiner(**options):
    return osh.TopologyRefiner(FACES, face_mask="smooth", **options)


@pytest.fixture
def factory():
    return osh.SurfaceFactory(make_refiner())


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_vertices_of_a_level_are_points_of_surfaces(factory, dtype):
    refiner = make_refiner()
    refiner.refine_uniform(3, full_topology_in_last_level=True)
    limit = osh.RefinementEvaluator(refiner).evaluate_limit(POSITIONS, level=3)
    level = refiner.get_level(3)
    vertices = level.face_vertices
    found = 0
    for half in (0, 1):
        coords = level.get_face_base_coords(half)
        faces = np.repeat(level.get_face_base_faces(half), np.diff(level.face_offsets))
        for face in (0, 17, 40):
            here = (faces == face) & np.isfinite(coords).all(axis=1)
            points = factory.vertex_surface(face).evaluate(
                coords[here], POSITIONS.astype(dtype))
            assert points.dtype == np.float64
            np.testing.assert_allclose(points, limit[vertices[here]], atol=3e-6)
            found += here.sum()
    assert found > 300


@pytest.mark.parametrize("first_step", ["tri_hex", "truncate"])
def test_surfaces_behind_a_first_step_are_those_of_level_1(first_step):
    refiner = make_refiner(first_step=first_step)
    with pytest.raises(osh.StatusError, match="level 1"):
        osh.SurfaceFactory(refiner)
    refiner.refine_uniform(1, full_topology_in_last_level=True)
    points = osh.RefinementEvaluator(refiner).evaluate(POSITIONS)
    limit = osh.RefinementEvaluator(refiner).evaluate_limit(POSITIONS, level=1)
    level = refiner.get_level(1)
    vertices = level.face_vertices.copy()
    factory = osh.SurfaceFactory(refiner)
    for face in (0, level.num_faces - 1):
        surface = factory.vertex_surface(face)
        corners = vertices[level.face_offsets[face]:level.face_offsets[face + 1]]
        tessellation = osh.LevelTessellation(surface.face_size, 0)
        np.testing.assert_allclose(surface.evaluate(tessellation, points), limit[corners],
                                   atol=3e-6)
        with pytest.raises(ValueError):
            surface.evaluate(tessellation, POSITIONS)
    refiner.refine_uniform(2)
    with pytest.raises(RuntimeError, match="refined again"):
        factory.has_limit_surface(0)
    with pytest.raises(RuntimeError, match="refined again"):
        factory.vertex_surface(0)


def make_roof(angle):
    """Rows of triangles in two planes that meet along a crease, y = 0, with a seam there."""
    xs, ys = np.meshgrid(np.arange(7), np.arange(-2, 3))
    positions = np.stack([xs, np.where(ys < 0, ys * np.cos(angle), ys),
                          np.where(ys < 0, ys * np.sin(angle), 0)], axis=-1).reshape(-1, 3)
    number = np.arange(35).reshape(5, 7)
    a, b, c, d = number[:-1, :-1], number[:-1, 1:], number[1:, 1:], number[1:, :-1]
    faces = np.stack([a, b, c, a, c, d], axis=-1).reshape(-1, 3)
    ridge = number[2]
    values = faces + np.where(np.arange(len(faces)) < 24, 0, 35)[:, None]
    return positions, faces, np.stack([ridge[:-1], ridge[1:]], axis=-1), values


def test_faces_that_a_crease_cuts_have_a_normal_on_each_side():
    angle = 0.6
    positions, faces, creases, values = make_roof(angle)
    refiner = osh.TopologyRefiner(
        faces, face_mask="smooth", first_step="truncate",
        creases=(creases, np.full(len(creases), 10.0)), fvar_channels=[values.ravel()],
        vtx_boundary_interpolation="edge_only")
    refiner.refine_uniform(1, full_topology_in_last_level=True)
    level = refiner.get_level(1)
    points = osh.RefinementEvaluator(refiner).evaluate(positions)
    factory = osh.SurfaceFactory(refiner)
    level_faces, halves = factory.get_level_faces()
    assert factory.num_faces == level.num_faces + 5 == len(level_faces)
    assert factory.num_edges == level.num_edges + 5
    np.testing.assert_array_equal(halves, np.arange(factory.num_faces) >= level.num_faces)
    for second in range(level.num_faces, factory.num_faces):
        normals, ends = [], []
        for face in (level_faces[second], second):
            surface = factory.vertex_surface(face)
            assert surface.is_half and surface.face_size == 4
            pattern = osh.LevelTessellation(4, 2, is_half=True)
            found, du, dv = surface.evaluate_with_derivatives(pattern, points)
            normal = np.cross(du, dv)
            normal /= np.linalg.norm(normal, axis=1)[:, None]
            np.testing.assert_allclose(normal, normal[:1].repeat(len(normal), axis=0), atol=1e-6)
            normals.append(normal[0])
            ends.append(found[:pattern.num_boundary_coords])
            vertices = factory.get_face_vertices(face)
            corners = level.face_vertices[level.face_offsets[level_faces[second]]:][:6]
            np.testing.assert_array_equal(
                vertices, corners[[0, 3, 4, 5] if face < second else [3, 0, 1, 2]])
            assert factory.get_face_edges(face)[0] == level.num_edges + second - level.num_faces
            with pytest.raises(ValueError, match="4 edges, but the face has 4 edges, a half"):
                surface.evaluate(osh.LevelTessellation(4, 2), points)
        assert abs(np.arccos(normals[0] @ normals[1]) - angle) < 1e-6
        along = [points_of_half[np.abs(points_of_half[:, 1:]).max(axis=1) < 1e-12]
                 for points_of_half in ends]
        np.testing.assert_array_equal(along[0], along[1][::-1])
        assert len(along[0]) > 3


def test_vertices_behind_a_first_step_are_points_of_surfaces():
    refiner = make_refiner(first_step="truncate")
    refiner.refine_uniform(3, full_topology_in_last_level=True)
    limit = osh.RefinementEvaluator(refiner).evaluate_limit(POSITIONS, level=3)
    level = refiner.get_level(3)
    vertices, sizes = level.face_vertices, np.diff(level.face_offsets)
    coarse = make_refiner(first_step="truncate")
    coarse.refine_uniform(1, full_topology_in_last_level=True)
    points = osh.RefinementEvaluator(coarse).evaluate(POSITIONS)
    factory = osh.SurfaceFactory(coarse)
    found = 0
    for half in (0, 1):
        coords = level.get_face_surface_coords(half)
        faces = np.repeat(level.get_face_surface_faces(half), sizes)
        assert faces.min() == 0 and faces.max() == coarse.get_level(1).num_faces - 1
        for face in (0, 17, 60):
            here = (faces == face) & np.isfinite(coords).all(axis=1)
            np.testing.assert_allclose(factory.vertex_surface(face).evaluate(coords[here], points),
                                       limit[vertices[here]], atol=3e-6)
            found += here.sum()
    assert found > 100
    for ask in (refiner.get_level(0).get_face_surface_faces,
                refiner.get_level(0).get_face_surface_coords):
        with pytest.raises(ValueError, match="level 0 does not come from the surface level"):
            ask()
        with pytest.raises(IndexError, match="half"):
            ask(2)
    # Without a first step these are base faces.
    plain = make_refiner()
    plain.refine_uniform(2)
    level = plain.get_level(2)
    for half in (0, 1):
        np.testing.assert_array_equal(level.get_face_surface_faces(half),
                                      level.get_face_base_faces(half))
        np.testing.assert_array_equal(level.get_face_surface_coords(half),
                                      level.get_face_base_coords(half))
    other = osh.TopologyRefiner(FACES, scheme_type="doo_sabin")
    other.refine_uniform(1)
    with pytest.raises(ValueError, match="hexagonal steps alone"):
        other.get_level(1).get_face_surface_faces()


def test_derivatives_are_those_of_the_points(factory):
    surface = factory.vertex_surface(5)
    inside = UV * 0.8 + 0.1
    points, du, dv = surface.evaluate_with_derivatives(inside, POSITIONS)
    np.testing.assert_array_equal(points, surface.evaluate(inside, POSITIONS))
    normals = np.cross(du, dv)
    for axis, derivative in ((0, du), (1, dv)):
        step = np.zeros(2)
        step[axis] = 1e-4
        difference = (surface.evaluate(inside + step, POSITIONS) -
                      surface.evaluate(inside - step, POSITIONS)) / 2e-4
        # Along the lines where cells meet u and v have a bend, but the plane goes on.
        assert np.abs(np.einsum("ij,ij->i", difference, normals)).max() < 2e-2 * np.abs(
            np.linalg.norm(difference, axis=1) * np.linalg.norm(normals, axis=1)).max()
        assert np.median(np.abs(difference - derivative)) < 1e-2


def find_smooth_places(coords):
    """Those amid a quad and off its diagonals, where u and v have a bend."""
    diagonals = np.abs(np.stack([coords[:, 0] - coords[:, 1], coords.sum(axis=1) - 1]))
    return (np.abs(coords - 0.5) < 0.4).all(axis=1) & (diagonals > 0.06).all(axis=0)


def test_second_derivatives_of_a_tessellation_are_differences_of_stencils(factory):
    surface = factory.vertex_surface(5)
    tessellation = osh.LevelTessellation(surface.face_size, 3)
    results = surface.evaluate_with_second_derivatives(tessellation, POSITIONS)
    for result, first in zip(results, surface.evaluate_with_derivatives(tessellation, POSITIONS)):
        np.testing.assert_allclose(result, first, atol=1e-12)
    control = POSITIONS[surface.control_points].astype(np.float64)
    smooth = find_smooth_places(tessellation.coords)
    coords = tessellation.coords[smooth]
    assert len(coords) == 40
    step = 1e-2
    for axis, second in ((0, results[3]), (1, results[5])):
        shift = np.eye(2)[axis] * step
        ends = [surface.evaluate_stencil(coords + sign * shift) @ control for sign in (-1, 1)]
        difference = (ends[0] + ends[1] - 2 * surface.evaluate_stencil(coords) @ control) / step**2
        np.testing.assert_allclose(second[smooth], difference, atol=0.06)


def test_second_derivatives_of_places_are_near_those_of_the_surface(factory):
    surface = factory.vertex_surface(5)
    tessellation = osh.LevelTessellation(surface.face_size, 3)
    coords = tessellation.coords
    exact = surface.evaluate_with_second_derivatives(tessellation, POSITIONS)
    places = surface.evaluate_with_second_derivatives(coords, POSITIONS)
    for result, first in zip(places, surface.evaluate_with_derivatives(coords, POSITIONS)):
        np.testing.assert_array_equal(result, first)
    smooth = find_smooth_places(coords)
    size = np.mean([np.abs(values[smooth]) for values in exact[3:]])
    for found, expected in zip(places[3:], exact[3:]):
        assert np.abs(found - expected)[smooth].mean() < 0.5 * size


def test_stencils_are_weights_of_the_control_points(factory):
    surface = factory.vertex_surface(2)
    control = POSITIONS[surface.control_points].astype(np.float64)
    weights = surface.evaluate_stencil(UV)
    assert weights.shape == (len(UV), len(surface.control_points))
    np.testing.assert_allclose(weights.sum(axis=1), 1, atol=1e-12)
    # They are exact as tessellations are; places are those of patches.
    tessellation = osh.LevelTessellation(surface.face_size, 3)
    np.testing.assert_allclose(surface.evaluate_stencil(tessellation.coords) @ control,
                               surface.evaluate(tessellation, POSITIONS), atol=1e-6)
    points = surface.evaluate(UV, POSITIONS)
    np.testing.assert_allclose(weights @ control, points, atol=3e-3)
    low, high = surface.bound(POSITIONS)
    assert (low <= points.min(axis=0)).all() and (points.max(axis=0) <= high).all()


def make_places(number=200):
    """Places of faces in no order, many in one face."""
    random = np.random.default_rng(3)
    return random.integers(0, 20, number), random.random((number, 2))


def test_places_of_many_faces_are_those_of_surfaces(factory):
    faces, uv = make_places()
    places = osh.SurfacePlaces(factory, faces, uv)
    assert places.num_places == len(faces)
    values = np.random.default_rng(4).random((len(POSITIONS), 5))
    for points in (POSITIONS.astype(np.float64), values, values[:, 1]):
        results = places.evaluate_with_derivatives(points)
        assert [r.shape for r in results] == 3 * [(len(faces),) + (points.shape[1:] or (1,))]
        assert all(r.dtype == np.float64 for r in results)
        np.testing.assert_array_equal(places.evaluate(points), results[0])
        for i in range(0, len(faces), 7):
            expected = factory.vertex_surface(faces[i]).evaluate_with_derivatives(uv[i:i + 1],
                                                                                  points)
            for result, one in zip(results, expected):
                np.testing.assert_array_equal(result[i:i + 1], one)
    with osh.ExecutorScope(None, num_threads=1):
        np.testing.assert_array_equal(places.evaluate(values[:, 1]), results[0])


def test_places_take_points_of_any_type_and_layout(factory):
    faces, uv = make_places(20)
    wide = np.random.default_rng(5).random((len(POSITIONS), 6)).astype(np.float32)
    places = osh.SurfacePlaces(factory, faces, uv)
    expected = places.evaluate(wide[:, 1:4].astype(np.float64))
    for points in (wide[:, 1:4], np.asfortranarray(wide[:, 1:4]), wide[:, 1:4].tolist(),
                   wide.astype(np.float64)[:, 1:4], wide.astype(">f8")[:, 1:4]):
        np.testing.assert_array_equal(places.evaluate(points), expected)
    for other_faces in (faces.tolist(), faces.astype(">i8"), faces.astype(np.uint8)):
        for other_uv in (uv.tolist(), np.asfortranarray(uv), uv.astype(">f8")):
            other = osh.SurfacePlaces(factory, other_faces, other_uv)
            np.testing.assert_array_equal(other.evaluate(wide[:, 1:4]), expected)
    none = osh.SurfacePlaces(factory, [], np.zeros((0, 2)))
    assert none.num_places == 0 and none.evaluate(POSITIONS).shape == (0, 3)


def test_places_of_other_data_outlive_the_factory():
    values = np.arange(4 * len(FACES))
    factory = osh.SurfaceFactory(
        make_refiner(fvar_channels=[values], fvar_linear_interpolation="all"))
    faces, uv = make_places(30)
    data = np.random.default_rng(1).random((len(values), 2))
    of_channel = factory.face_varying_surface(faces[0]).evaluate(uv[:1], data)
    varying = factory.varying_surface(faces[0]).evaluate(uv[:1], POSITIONS)
    channel_places = osh.SurfacePlaces(factory, faces, uv, interpolation_mode="face_varying")
    varying_places = osh.SurfacePlaces(factory, faces, uv, interpolation_mode="varying")
    with pytest.raises(IndexError, match="fvar_channel: 1 is not one of the 1"):
        osh.SurfacePlaces(factory, faces, uv, interpolation_mode="face_varying", fvar_channel=1)
    del factory
    np.testing.assert_array_equal(channel_places.evaluate(data)[:1], of_channel)
    np.testing.assert_array_equal(varying_places.evaluate(POSITIONS)[:1], varying)
    # Channels have their own number of points.
    with pytest.raises(ValueError, match=f"points: {len(values)} elements are needed"):
        channel_places.evaluate(POSITIONS)
    with pytest.raises(ValueError, match=f"points: {len(POSITIONS)} elements are needed"):
        varying_places.evaluate(data)


def test_places_behind_a_first_step_are_in_faces_of_level_1():
    refiner = make_refiner(first_step="truncate")
    refiner.refine_uniform(1, full_topology_in_last_level=True)
    points = osh.RefinementEvaluator(refiner).evaluate(POSITIONS)
    factory = osh.SurfaceFactory(refiner)
    last = refiner.get_level(1).num_faces - 1
    places = osh.SurfacePlaces(factory, [last], [[0.5, 0.3]])
    np.testing.assert_array_equal(places.evaluate(points),
                                  factory.vertex_surface(last).evaluate([[0.5, 0.3]], points))
    with pytest.raises(ValueError, match="points"):
        places.evaluate(POSITIONS)
    refiner.refine_uniform(2)
    with pytest.raises(RuntimeError, match="refined again"):
        osh.SurfacePlaces(factory, [last], [[0.5, 0.3]])


def test_neighbours_share_points_to_the_bit(factory):
    level = 3
    edges = {}
    for face, vertices in enumerate(FACES):
        tessellation = osh.LevelTessellation(4, [level] * 4 + [face % 4])
        assert tessellation.levels == [level] * 4 + [face % 4]
        points = factory.vertex_surface(face).evaluate(tessellation, POSITIONS)
        coords = tessellation.coords
        assert points.shape == (len(coords), 3)
        facets = tessellation.facets
        assert facets.shape[1] == 3 and facets.max() == len(coords) - 1
        a, b, c = (coords[facets[:, i]] for i in range(3))
        areas = np.cross(b - a, c - a) / 2
        assert (areas > 0).all()
        assert areas.sum() == pytest.approx(1)
        size = tessellation.num_boundary_coords // 4
        for i in range(4):
            run = [points[(i * size + j) % (4 * size)].tobytes() for j in range(size + 1)]
            edges.setdefault(frozenset((int(vertices[i]), int(vertices[(i + 1) % 4]))),
                             []).append(run)
    assert len(edges) == 2 * len(FACES)
    for one, other in edges.values():
        assert one == other[::-1]


def test_faces_of_any_size_and_kinds_of_facets():
    factory = osh.SurfaceFactory(osh.TopologyRefiner(PYRAMID_FACES))
    surface = factory.vertex_surface(1)
    assert surface.face_size == 3
    polygons = osh.LevelTessellation(3, 2, facet_size=0)
    assert polygons.facet_sizes.sum() == len(polygons.facets)
    assert surface.evaluate(polygons, PYRAMID_POSITIONS).shape == (len(polygons.coords), 3)
    assert osh.LevelTessellation(4, 1, facet_size=4).facets.shape[1] == 4
    with pytest.raises(ValueError, match="a tessellation of 4 edges, but the face has 3"):
        surface.evaluate(osh.LevelTessellation(4, 1), PYRAMID_POSITIONS)


def test_values_of_channels():
    values = np.arange(4 * len(FACES))
    factory = osh.SurfaceFactory(
        make_refiner(fvar_channels=[values], fvar_linear_interpolation="all"))
    data = np.random.default_rng(1).random((len(values), 2))
    surface = factory.face_varying_surface(3)
    corners = np.array([[0, 0], [1, 0], [1, 1], [0, 1]])
    np.testing.assert_allclose(surface.evaluate(corners, data), data[12:16], atol=1e-12)
    np.testing.assert_allclose(
        factory.varying_surface(3).evaluate(corners, POSITIONS), POSITIONS[FACES[3]], atol=1e-6)
    with pytest.raises(IndexError, match="channel"):
        factory.face_varying_surface(0, 1)


def test_places_and_points_of_any_type_and_layout(factory):
    surface = factory.vertex_surface(3)
    places = np.array([[0, 0], [1, 0.5], [0.25, 0.75]])
    expected = surface.evaluate(places, POSITIONS.astype(np.float64))
    for uv in (places.tolist(), places.astype(np.float16), np.asfortranarray(places),
               places[::-1].copy()[::-1], places.astype(">f8")):
        for points in (POSITIONS, POSITIONS.astype(np.float64).tolist(), POSITIONS.astype(">f8"),
                       np.asfortranarray(POSITIONS)):
            np.testing.assert_array_equal(surface.evaluate(uv, points), expected)
    # Nothing is rounded to float32.
    thirds = np.full(len(POSITIONS), 1 / 3).tolist()
    np.testing.assert_allclose(surface.evaluate(places, thirds), 1 / 3, rtol=0, atol=1e-15)
    with pytest.raises(TypeError, match="uv: numbers are needed, not"):
        surface.evaluate([["a", "b"]], POSITIONS)
    with pytest.raises(ValueError, match="points: .* masked"):
        surface.evaluate(places, np.ma.masked_less(POSITIONS, 1))


def test_errors_name_the_argument(factory):
    with pytest.raises(IndexError, match="face"):
        factory.vertex_surface(len(FACES))
    surface = factory.vertex_surface(0)
    with pytest.raises(ValueError, match="points"):
        surface.evaluate(UV, POSITIONS[1:])
    with pytest.raises(ValueError, match="uv: u and v of each place are needed"):
        surface.evaluate([0.5, 0.5], POSITIONS)
    with pytest.raises(ValueError, match="uv: row 1"):
        surface.evaluate([[0, 0], [np.nan, 0]], POSITIONS)
    for arguments, name in (((2, 1), "face_size"), ((4, 13), "levels"), ((4, [1, 2]), "levels"),
                            ((4, 1, 5), "facet_size")):
        with pytest.raises(ValueError, match=name):
            osh.LevelTessellation(*arguments)
    holes = osh.SurfaceFactory(make_refiner(holes=[4]))
    assert holes.has_limit_surface(3) and not holes.has_limit_surface(4)
    with pytest.raises(osh.StatusError):
        holes.vertex_surface(4)
    with pytest.raises(osh.StatusError):
        osh.SurfaceFactory(make_refiner(scheme_type="doo_sabin"))


def test_faces_that_depend_on_too_many_others_have_no_surface():
    count = 600  # around vertex 0; at most 512 are taken
    ring = np.arange(count)
    faces = np.stack([np.zeros(count, int), 1 + ring, 1 + (ring + 1) % count], axis=1)
    factory = osh.SurfaceFactory(osh.TopologyRefiner(faces, vtx_boundary_interpolation="edge_only"))
    assert factory.num_faces == count
    assert not factory.has_limit_surface(0)
    with pytest.raises(osh.StatusError, match="vertex 0") as caught:
        factory.vertex_surface(0)
    assert caught.value.component == osh.ComponentType.VERTEX


def test_places_on_the_control_mesh():
    coarse = make_refiner()
    faces, uv = osh.SurfaceFactory(coarse).find_surface_places([4, 0], [[0.25, 0.5], [1, 0]])
    np.testing.assert_array_equal(faces, [4, 0])
    np.testing.assert_array_equal(uv, [[0.25, 0.5], [1, 0]])

    refiner = make_refiner(first_step="truncate")
    refiner.refine_uniform(1, full_topology_in_last_level=True)
    factory = osh.SurfaceFactory(refiner)
    points = osh.RefinementEvaluator(refiner).evaluate(POSITIONS, 1)
    # A vertex is one point from all four faces, the middle of its face of level 1.
    corners = np.array([[0, 0], [1, 0], [1, 1], [0, 1]])
    faces, local = np.nonzero(np.array(FACES) == FACES[0][0])
    faces, uv = factory.find_surface_places(faces, corners[local])
    assert len(faces) == 4 and (faces == faces[0]).all() and faces[0] >= len(FACES)
    found = osh.SurfacePlaces(factory, faces, uv).evaluate(points)
    np.testing.assert_allclose(found, np.tile(found[0], (4, 1)), atol=1e-6)
    edge = np.linalg.norm(POSITIONS[FACES[0][1]] - POSITIONS[FACES[0][0]])
    assert np.linalg.norm(found[0] - POSITIONS[FACES[0][0]]) < 0.3 * edge
    with pytest.raises(osh.StatusError, match="face 48"):
        factory.find_surface_places([0, 48], [[0, 0], [0, 0]])
    with pytest.raises(ValueError, match="uv: row 1 is not finite"):
        factory.find_surface_places([0, 1], [[0, 0], [np.nan, 0]])
