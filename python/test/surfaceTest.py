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
    with pytest.raises(osh.StatusError, match="refined again"):
        factory.has_limit_surface(0)
    with pytest.raises(osh.StatusError, match="refined again"):
        factory.vertex_surface(0)


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


def test_second_derivatives_are_differences_of_first_ones(factory):
    surface = factory.vertex_surface(5)
    inside = np.array([[0.3, 0.11], [0.62, 0.2], [0.81, 0.46]])
    results = surface.evaluate_with_second_derivatives(inside, POSITIONS)
    for result, first in zip(results, surface.evaluate_with_derivatives(inside, POSITIONS)):
        np.testing.assert_array_equal(result, first)
    step = 2e-4
    for axis in (0, 1):
        shift = np.eye(2)[axis] * step
        ends = [surface.evaluate_with_derivatives(inside + sign * shift, POSITIONS)
                for sign in (-1, 1)]
        for kind in (0, 1):
            difference = (ends[1][1 + kind] - ends[0][1 + kind]) / (2 * step)
            np.testing.assert_allclose(results[3 + kind + axis], difference, atol=0.03)
    tessellation = osh.LevelTessellation(surface.face_size, 1)
    of_tessellation = surface.evaluate_with_second_derivatives(tessellation, POSITIONS)
    of_places = surface.evaluate_with_second_derivatives(tessellation.coords, POSITIONS)
    for found, expected in zip(of_tessellation, of_places):
        np.testing.assert_allclose(found, expected, atol=1e-6)


def test_stencils_are_weights_of_the_control_points(factory):
    surface = factory.vertex_surface(2)
    weights = surface.evaluate_stencil(UV)
    assert weights.shape == (len(UV), len(surface.control_points))
    np.testing.assert_allclose(weights.sum(axis=1), 1, atol=1e-12)
    np.testing.assert_allclose(weights @ POSITIONS[surface.control_points].astype(np.float64),
                               surface.evaluate(UV, POSITIONS), atol=1e-12)
    low, high = surface.bound(POSITIONS)
    points = surface.evaluate(UV, POSITIONS)
    assert (low <= points.min(axis=0)).all() and (points.max(axis=0) <= high).all()


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
