# SPDX-License-Identifier: Apache-2.0
"""Patches, against the limit surface, differences and arguments that are wrong."""

import numpy as np
import opensubdivhex as osh
import pytest
from meshes import PYRAMID_FACES, PYRAMID_POSITIONS, make_torus

POSITIONS, FACES = make_torus(8, 6)
LEVEL = 2
RANDOM = np.random.default_rng(7)


@pytest.fixture(scope="module")
def refiner():
    result = osh.TopologyRefiner(FACES, face_mask="smooth")
    result.refine_uniform(LEVEL + 1, full_topology_in_last_level=True)
    return result


@pytest.fixture(scope="module")
def table(refiner):
    return osh.PatchTable(refiner, LEVEL)


def choose_places(table, count=300):
    return RANDOM.integers(0, table.num_patches, count), RANDOM.uniform(0, 1, (count, 2))


def test_points_are_control_vertices_and_local_points(table):
    points = table.make_points(POSITIONS)
    count = len(POSITIONS)
    assert points.dtype == np.float32
    assert points.shape == (table.num_control_vertices + table.num_local_points, 3)
    np.testing.assert_array_equal(points[:count], np.float32(POSITIONS))
    stencils = table.local_point_stencil_table
    assert stencils.num_stencils == table.num_local_points
    np.testing.assert_array_equal(points[count:], osh.CpuEvaluator.eval_stencils(
        stencils, POSITIONS))
    vertices = table.patch_vertices
    assert vertices.shape == (table.num_patches, 20)
    assert vertices.min() >= count and vertices.max() == len(points) - 1
    with pytest.raises(ValueError):
        vertices[0, 0] = 0


def test_corners_are_limit_points_at_their_coords(refiner, table):
    points = table.make_points(POSITIONS)
    factory = osh.SurfaceFactory(refiner)
    for corner, st in enumerate([[0, 0], [1, 0], [1, 1], [0, 1]]):
        patches = np.arange(table.num_patches)
        values = table.evaluate(patches, np.tile(st, (len(patches), 1)), points)
        for patch in RANDOM.integers(0, table.num_patches, 40):
            surface = factory.vertex_surface(int(table.faces[patch]))
            expected = surface.evaluate(table.coords[patch, corner][None], POSITIONS)
            np.testing.assert_allclose(values[patch], expected[0], atol=1e-5)
    np.testing.assert_array_equal(table.faces, table.base_faces)
    assert set(table.faces) == set(range(len(FACES)))


def test_places_of_faces_are_near_the_surface(refiner, table):
    points = table.make_points(POSITIONS)
    faces = np.repeat(np.arange(len(FACES)), 5)
    uv = RANDOM.uniform(0, 1, (len(faces), 2))
    patches, st = table.find_places(faces, uv)
    assert patches.dtype == np.int32 and st.dtype == np.float64
    assert (patches >= 0).all() and st.min() > -1e-9 and st.max() < 1 + 1e-9
    np.testing.assert_array_equal(table.faces[patches], faces)
    s, t = st.T[..., None]
    corners = table.coords[patches].transpose(1, 0, 2)
    np.testing.assert_allclose(
        (1 - t) * ((1 - s) * corners[0] + s * corners[1]) +
        t * ((1 - s) * corners[3] + s * corners[2]), uv, atol=1e-9)
    values = table.evaluate(patches, st, points)
    factory = osh.SurfaceFactory(refiner)
    expected = np.concatenate([factory.vertex_surface(int(face)).evaluate(place[None], POSITIONS)
                               for face, place in zip(faces, uv)])
    # Along the surface they may slip a little.
    assert np.abs(values - expected).max() < 6e-3 * np.ptp(POSITIONS)


def test_derivatives_are_those_of_the_patch(table):
    points = table.make_points(POSITIONS)
    patches, st = choose_places(table)
    st = 0.1 + 0.8 * st
    step = 1e-2

    def shift(i, j):
        return table.evaluate_with_derivatives(patches, st + step * np.array([i, j]), points)

    p, ds, dt, dss, dst, dtt = table.evaluate_with_second_derivatives(patches, st, points)
    np.testing.assert_array_equal(p, table.evaluate(patches, st, points))
    differences = (shift(1, 0)[0] - shift(-1, 0)[0]) / (2 * step)
    scale = (differences * ds).sum(axis=1) / (ds * ds).sum(axis=1)
    np.testing.assert_allclose(scale, 1, atol=0.1)
    # Inside of Gregory patches they are approximate, as those of OpenSubdiv.
    for actual, expected in ((ds, differences),
                             (dt, (shift(0, 1)[0] - shift(0, -1)[0]) / (2 * step))):
        np.testing.assert_allclose(actual, expected, atol=8e-2 * np.abs(expected).max())


def test_kites_at_a_pyramid():
    refiner = osh.TopologyRefiner(PYRAMID_FACES, face_mask="smooth",
                                  vtx_boundary_interpolation="edge_only")
    refiner.refine_uniform(1, full_topology_in_last_level=True)
    table = osh.PatchTable(refiner, 0)
    sizes = np.bincount(table.faces)
    expected = [1 if len(face) == 4 else len(face) for face in PYRAMID_FACES]
    np.testing.assert_array_equal(sizes, expected)
    colors = table.make_points(np.asarray(PYRAMID_POSITIONS)[:, :1])
    assert table.evaluate([0], [[0.5, 0.5]], colors).shape == (1, 1)


def make_cut_refiner(**options):
    """Each face has values of its own."""
    values = np.arange(4 * len(FACES))
    refiner = osh.TopologyRefiner(FACES, face_mask="smooth", fvar_channels=[values], **options)
    refiner.refine_uniform(LEVEL + 1, full_topology_in_last_level=True)
    return refiner, RANDOM.uniform(0, 1, (len(values), 2))


def test_values_of_channels_are_near_their_surfaces():
    refiner, values = make_cut_refiner(fvar_linear_interpolation="none")
    table = osh.PatchTable(refiner, LEVEL, generate_fvar_tables=True,
                           generate_fvar_legacy_linear_patches=False)
    assert table.num_fvar_channels == 1
    assert table.patch_fvar_values().shape == (table.num_patches, 20)
    points = table.make_fvar_points(values)
    np.testing.assert_array_equal(points[len(values):], osh.CpuEvaluator.eval_stencils(
        table.local_point_fvar_stencil_table(), values))
    faces = np.repeat(np.arange(len(FACES)), 3)
    uv = RANDOM.uniform(0, 1, (len(faces), 2))
    patches, st = table.find_places(faces, uv)
    actual = table.evaluate_fvar(patches, st, points)
    factory = osh.SurfaceFactory(refiner)
    expected = np.concatenate([
        factory.face_varying_surface(int(face)).evaluate(place[None], values)
        for face, place in zip(faces, uv)])
    assert np.abs(actual - expected).max() < 1.2e-2


def test_linear_channels_are_bilinear():
    refiner, values = make_cut_refiner(fvar_linear_interpolation="all")
    table = osh.PatchTable(refiner, LEVEL, generate_fvar_tables=True)
    assert table.patch_fvar_values().shape == (table.num_patches, 4)
    points = table.make_fvar_points(values)
    patches, st = choose_places(table)
    s, t = np.float32(st.T[..., None])
    corners = points[table.patch_fvar_values()[patches]].transpose(1, 0, 2)
    np.testing.assert_allclose(
        table.evaluate_fvar(patches, st, points),
        (1 - t) * ((1 - s) * corners[0] + s * corners[1]) +
        t * ((1 - s) * corners[3] + s * corners[2]), atol=1e-6)
    with pytest.raises(IndexError, match="channel"):
        table.make_fvar_points(values, 1)
    with pytest.raises(IndexError, match="channel"):
        table.evaluate_fvar([0], [[0, 0]], points, -1)
    assert osh.PatchTable(refiner, LEVEL).num_fvar_channels == 0


def test_wrong_arguments_are_named(refiner, table):
    points = table.make_points(POSITIONS)
    with pytest.raises(osh.StatusError, match="level"):
        osh.PatchTable(refiner, LEVEL + 1)
    for patches, st, error, cause in (
            ([table.num_patches], [[0, 0]], IndexError, "patches"),
            ([-1], [[0, 0]], IndexError, "patches"),
            ([0.5], [[0, 0]], TypeError, "patches"),
            ([0], [[0, 0, 0]], ValueError, "st"),
            ([0, 1], [[0, 0]], ValueError, "st")):
        with pytest.raises(error, match=cause):
            table.evaluate(patches, st, points)
    with pytest.raises(ValueError, match="points"):
        table.evaluate([0], [[0, 0]], POSITIONS)
    with pytest.raises(ValueError, match="values"):
        table.make_points(POSITIONS[1:])
    with pytest.raises(IndexError, match="faces"):
        table.find_places([len(FACES)], [[0, 0]])
    with pytest.raises(ValueError, match="uv"):
        table.find_places([0], [[0, 0, 0]])
    free = osh.TopologyRefiner(PYRAMID_FACES[:-1], face_mask="smooth",
                               vtx_boundary_interpolation="none")
    free.refine_uniform(1, full_topology_in_last_level=True)
    with pytest.raises(osh.StatusError, match="edge"):
        osh.PatchTable(free, 0)
