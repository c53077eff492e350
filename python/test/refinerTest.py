# SPDX-License-Identifier: Apache-2.0
"""Base meshes from arrays, their options, what is refused, and refinement."""

import numpy as np
import opensubdivhex as osh
import pytest
from meshes import (CUBE_FACES, CUBE_POSITIONS, PYRAMID_FACES, PYRAMID_POSITIONS, make_grid,
                    make_torus, refine_literally)


def average_mask(n):
    weights = np.full(n, 1 / (4 * n))
    weights[0] += 1 / 2
    weights[1] += 1 / 8
    weights[-1] += 1 / 8
    return weights


def canonical(face):
    """A face that begins with its least vertex."""
    first = list(face).index(min(face))
    return tuple(face[first:]) + tuple(face[:first])


def split(level):
    return np.split(level.face_vertices, level.face_offsets[1:-1])


@pytest.mark.parametrize("positions, faces", [
    (CUBE_POSITIONS, CUBE_FACES), (PYRAMID_POSITIONS, PYRAMID_FACES), make_torus(5, 4)])
def test_levels_are_those_of_the_paper(positions, faces):
    refiner = osh.TopologyRefiner(faces)
    refiner.refine_uniform(3)
    assert refiner.max_level == 3 and refiner.num_levels == 4 and refiner.is_uniform
    evaluator = osh.RefinementEvaluator(refiner)
    expected, expected_faces = positions.astype(np.float64), [list(face) for face in faces]
    for number in range(1, 4):
        expected, expected_faces = refine_literally(expected, expected_faces, average_mask)
        level = refiner.get_level(number)
        assert level.num_vertices == len(expected) and level.num_faces == len(expected_faces)
        assert (sorted(map(canonical, split(level))) ==
                sorted(map(canonical, expected_faces)))
        values = evaluator.evaluate(positions, number)
        np.testing.assert_allclose(values, expected, atol=3e-6)
        # The order of the faces of edges is the library's.
        expected_faces = [list(face) for face in split(level)]


def test_faces_are_taken_in_every_form():
    flat = np.array(CUBE_FACES).ravel()
    offsets = np.arange(0, 25, 4)
    refiners = [
        osh.TopologyRefiner(CUBE_FACES),
        osh.TopologyRefiner(tuple(tuple(face) for face in CUBE_FACES)),
        osh.TopologyRefiner([np.array(face, dtype=np.uint64) for face in CUBE_FACES]),
        osh.TopologyRefiner(np.array(CUBE_FACES, dtype=np.int16)),
        osh.TopologyRefiner(np.asfortranarray(CUBE_FACES)),
        osh.TopologyRefiner(iter(CUBE_FACES)),
        osh.TopologyRefiner(flat, face_offsets=offsets),
        osh.TopologyRefiner(np.repeat(flat, 2)[::2], 8, face_offsets=offsets.astype(np.uint8)),
        osh.TopologyRefiner(list(flat), face_offsets=list(offsets)),
    ]
    for refiner in refiners:
        level = refiner.get_level(0)
        np.testing.assert_array_equal(level.face_vertices, flat)
        np.testing.assert_array_equal(level.face_offsets, offsets)
        assert level.num_vertices == 8
    mixed = osh.TopologyRefiner(PYRAMID_FACES, num_vertices=7).get_level(0)
    np.testing.assert_array_equal(mixed.face_offsets, [0, 4, 7, 10, 13, 16])
    assert mixed.num_vertices == 7


def test_left_handed_faces_are_turned():
    level = osh.TopologyRefiner(CUBE_FACES, is_left_handed=True).get_level(0)
    assert [canonical(f) for f in split(level)] == [canonical(f[::-1]) for f in CUBE_FACES]


def test_options_are_taken_by_name_and_by_member():
    for boundary in ("edge_and_corner", osh.VtxBoundaryInterpolation.EDGE_AND_CORNER):
        refiner = osh.TopologyRefiner(
            CUBE_FACES, vtx_boundary_interpolation=boundary, creasing_method="chaikin",
            face_mask=osh.FaceMask.SMOOTH, fvar_linear_interpolation="boundaries",
            fvar_channels=[np.arange(24)])
        assert refiner.vtx_boundary_interpolation == osh.VtxBoundaryInterpolation.EDGE_AND_CORNER
        assert refiner.creasing_method == osh.CreasingMethod.CHAIKIN
        assert refiner.face_mask == osh.FaceMask.SMOOTH
        assert (refiner.get_fvar_linear_interpolation() ==
                osh.FVarLinearInterpolation.BOUNDARIES)
        assert refiner.scheme_type == osh.SchemeType.HEXAGONAL
        assert refiner.first_step == osh.FirstStep.NONE
    plain = osh.TopologyRefiner(CUBE_FACES)
    assert plain.face_mask == osh.FaceMask.AVERAGE
    assert plain.vtx_boundary_interpolation == osh.VtxBoundaryInterpolation.NONE


@pytest.mark.parametrize("scheme, counts", [
    ("hexagonal", (32, 48, 18)), ("doo_sabin", (24, 48, 26)), ("tri_hex", (24, 36, 14))])
def test_schemes_make_their_counts(scheme, counts):
    refiner = osh.TopologyRefiner(CUBE_FACES, scheme_type=scheme)
    refiner.refine_uniform(1, full_topology_in_last_level=True)
    level = refiner.get_level(1)
    assert (level.num_vertices, level.num_edges, level.num_faces) == counts
    level.validate()


def test_tri_hex_first_makes_level_1():
    refiner = osh.TopologyRefiner(CUBE_FACES, first_step="tri_hex")
    refiner.refine_uniform(1)
    assert refiner.get_level(1).num_vertices == 24


def test_truncation_keeps_labels_apart():
    refiner = osh.TopologyRefiner(CUBE_FACES, first_step=osh.FirstStep.TRUNCATE)
    refiner.refine_uniform(1, full_topology_in_last_level=True)
    level = refiner.get_level(1)
    assert (level.num_vertices, level.num_edges, level.num_faces) == (24, 36, 14)
    del level
    # Two halves: a ring of four vertices, each with two sectors, and another of four without.
    refiner.refine_uniform(1, full_topology_in_last_level=True, face_labels=[0, 1, 1, 1, 1, 1])
    level = refiner.get_level(1)
    assert level.num_vertices == 24 + 4 and level.num_faces == 14 + 4
    level.validate()
    del level
    with pytest.raises(osh.StatusError, match="labels"):
        refiner.refine_uniform(1, face_labels=[0, 1])


def test_tags_arrive_at_the_level():
    refiner = osh.TopologyRefiner(
        CUBE_FACES, creases=([[0, 1], [1, 3]], [2.5, osh.SHARPNESS_INFINITE]),
        corners=([5, 6], 3), holes=[4])
    level = refiner.get_level(0)
    sharpness = level.get_edge_sharpness()
    assert sharpness[level.find_edge(0, 1)] == 2.5
    assert sharpness[level.find_edge(3, 1)] == osh.SHARPNESS_INFINITE
    assert np.count_nonzero(sharpness) == 2
    np.testing.assert_array_equal(np.nonzero(level.get_vertex_sharpness())[0], [5, 6])
    assert level.get_vertex_sharpness()[5] == 3
    np.testing.assert_array_equal(level.is_face_hole(), [False] * 4 + [True, False])
    assert refiner.has_holes and not osh.TopologyRefiner(CUBE_FACES).has_holes


def test_totals_are_sums_over_levels():
    refiner = osh.TopologyRefiner(CUBE_FACES, fvar_channels=[np.arange(24)])
    refiner.refine_uniform(1)
    assert refiner.num_vertices_total == 8 + 32
    assert refiner.num_faces_total == 6 + 18
    assert refiner.num_edges_total == 12 + 48
    assert refiner.num_face_vertices_total == 24 + 96
    assert refiner.get_num_fvar_values_total() == 24 + refiner.get_level(1).get_num_fvar_values()


def test_coplanar_refinement_makes_quads_between_flat_faces():
    positions, faces = make_grid(3, 3)
    positions[:, 2] = 0
    refiner = osh.TopologyRefiner(faces)
    refiner.refine_uniform(1)
    hexagons = np.count_nonzero(np.diff(refiner.get_level(1).face_offsets) == 6)
    assert hexagons == 12
    for rest in (positions, positions.astype(np.float64)):
        refiner.refine_coplanar(rest, 1)
        assert not refiner.is_uniform
        assert np.count_nonzero(np.diff(refiner.get_level(1).face_offsets) == 6) == 0


@pytest.mark.parametrize("arguments, code, component, index", [
    ({"faces": [[0, 1, 2], [2, 1, 3], [0, 1]]}, "INVALID_TOPOLOGY", "FACE", 2),
    ({"faces": [[0, 1, 2], [2, 1, 9]], "num_vertices": 4}, "INVALID_TOPOLOGY", "FACE", 1),
    ({"faces": [[0, 1, 2], [2, 1, -1]]}, "INVALID_TOPOLOGY", "FACE", 1),
    ({"faces": []}, "INVALID_TOPOLOGY", "NONE", None),
    ({"faces": CUBE_FACES, "holes": [6]}, "INVALID_TOPOLOGY", "FACE", 6),
    ({"faces": CUBE_FACES, "scheme_type": "doo_sabin", "creases": ([[0, 1]], 1)},
     "UNSUPPORTED", "EDGE", None),
])
def test_refused_meshes_are_named(arguments, code, component, index):
    with pytest.raises(osh.StatusError) as caught:
        osh.TopologyRefiner(**arguments)
    error = caught.value
    assert isinstance(error, ValueError)
    assert error.code == getattr(osh.StatusCode, code)
    if index is not None:
        assert error.component == getattr(osh.ComponentType, component)
        assert error.index == index
        assert str(index) in str(error)
    assert len(str(error)) > 10


def test_a_crease_that_is_no_edge_is_refused():
    with pytest.raises(osh.StatusError, match="crease"):
        osh.TopologyRefiner(CUBE_FACES, creases=([[0, 7]], 1))


@pytest.mark.parametrize("sharpness", [-1.0, float("nan")])
def test_sharpness_that_is_no_number_is_refused(sharpness):
    with pytest.raises(osh.StatusError):
        osh.TopologyRefiner(CUBE_FACES, creases=([[0, 1]], sharpness))


def test_levels_that_are_too_large_are_refused():
    refiner = osh.TopologyRefiner(CUBE_FACES)
    refiner.refine_uniform(2)
    with pytest.raises(osh.StatusError) as caught:
        refiner.refine_uniform(60)
    assert caught.value.code == osh.StatusCode.TOO_LARGE
    assert caught.value.component == osh.ComponentType.LEVEL
    assert refiner.max_level == 2
    with pytest.raises(osh.StatusError) as caught:
        refiner.refine_uniform(-1)
    assert caught.value.code == osh.StatusCode.INVALID_ARGUMENT


def test_inconsistent_orientation_is_warned_of():
    with pytest.warns(osh.StatusWarning) as caught:
        osh.TopologyRefiner([[0, 1, 2], [0, 1, 3]])
    assert caught[0].filename == __file__
    warning = caught[0].message
    assert warning.code == osh.WarningCode.INCONSISTENT_ORIENTATION
    assert warning.component == osh.ComponentType.EDGE
    assert warning.count == 1 and warning.index >= 0
    assert "1" in str(warning)


def test_unrefine_leaves_the_base():
    refiner = osh.TopologyRefiner(CUBE_FACES)
    refiner.refine_uniform(2)
    refiner.unrefine()
    assert refiner.max_level == 0
    refiner.refine_uniform(1)
    assert refiner.get_level(1).num_faces == 18
