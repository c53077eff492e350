# SPDX-License-Identifier: Apache-2.0
"""Refiners, options and tessellations can be copied and pickled, with the same bits."""

import copy
import pickle
import warnings

import numpy as np
import opensubdivhex as osh
import pytest
from meshes import CUBE_FACES, CUBE_POSITIONS, PYRAMID_FACES, PYRAMID_POSITIONS, make_grid

COPIES = [copy.copy, copy.deepcopy] + [
    lambda value, protocol=protocol: pickle.loads(pickle.dumps(value, protocol))
    for protocol in range(pickle.HIGHEST_PROTOCOL + 1)]


def describe(refiner):
    """All that tells a refiner from another one, as bytes and numbers."""
    parts = [refiner.face_mask, refiner.scheme_type, refiner.first_step, refiner.creasing_method,
             refiner.vtx_boundary_interpolation, refiner.is_uniform, refiner.has_holes,
             refiner.num_levels]
    for channel in range(refiner.num_fvar_channels):
        parts.append(refiner.get_fvar_linear_interpolation(channel))
    for depth in range(refiner.num_levels):
        level = refiner.get_level(depth)
        parts += [level.has_full_topology, level.num_vertices, level.face_offsets.tobytes(),
                  level.face_vertices.tobytes(), level.is_face_hole().tobytes()]
        if level.has_full_topology:
            parts += [level.edge_vertices.tobytes(), level.get_edge_sharpness().tobytes(),
                      level.get_vertex_sharpness().tobytes(), level.get_vertex_rules().tobytes()]
        for channel in range(refiner.num_fvar_channels):
            parts.append(level.get_face_fvar_values(channel).tobytes())
    return parts


def make_tagged():
    rim = [[4, 5], [5, 7], [7, 6], [6, 4]]
    return osh.TopologyRefiner(
        CUBE_FACES, num_vertices=9, creases=(rim, [10.0, 2.5, 0.3, 1.0]), corners=([0, 1], 1.5),
        holes=[3], fvar_channels=[np.arange(24), np.zeros(24, int)], num_fvar_values=[30, 1],
        is_left_handed=True, vtx_boundary_interpolation="edge_and_corner",
        fvar_linear_interpolation="boundaries", creasing_method="chaikin", face_mask="cosine")


@pytest.mark.parametrize("make_copy", COPIES)
def test_refiners(make_copy):
    refiners = [make_tagged() for _ in range(3)]
    refiners[1].refine_uniform(2, full_topology_in_last_level=True)
    refiners[2].refine_uniform(3)
    for refiner in refiners:
        made = make_copy(refiner)
        assert made is not refiner
        assert describe(made) == describe(refiner)
        if refiner.max_level:
            points = [osh.RefinementEvaluator(r).evaluate(np.ones((9, 1))) for r in (made, refiner)]
            assert points[0].tobytes() == points[1].tobytes()


def test_copies_are_apart():
    refiner = make_tagged()
    refiner.refine_uniform(1)
    made = copy.copy(refiner)
    made.refine_uniform(3)
    assert (refiner.max_level, made.max_level) == (1, 3)
    # The last refinement counts, and one that is refused does not.
    made.unrefine()
    assert copy.copy(made).max_level == 0
    refiner.refine_uniform(2)
    with pytest.raises(osh.StatusError):
        refiner.refine_uniform(1000)
    assert describe(copy.copy(refiner)) == describe(refiner)


def test_arrays_that_were_given_may_change():
    faces = np.array(CUBE_FACES, np.int32)
    refiner = osh.TopologyRefiner(faces)
    expected = describe(refiner)
    faces[:] = 0
    assert describe(copy.copy(refiner)) == expected


def test_other_schemes_and_first_steps():
    triangles = osh.TopologyRefiner(PYRAMID_FACES, first_step="truncate", face_mask="smooth")
    triangles.refine_uniform(2, face_labels=[0, 1, 1, 0, 2])
    unlabelled = osh.TopologyRefiner(PYRAMID_FACES, first_step="truncate", face_mask="smooth")
    unlabelled.refine_uniform(2)
    assert describe(pickle.loads(pickle.dumps(triangles))) == describe(triangles)
    first_faces = [r.get_level(1).get_face_base_faces().tobytes()
                   for r in (triangles, unlabelled, copy.copy(triangles))]
    assert first_faces[0] == first_faces[2]
    for scheme in ("doo_sabin", "tri_hex"):
        refiner = osh.TopologyRefiner(CUBE_FACES, scheme_type=scheme)
        refiner.refine_uniform(2)
        assert describe(pickle.loads(pickle.dumps(refiner))) == describe(refiner)


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_coplanar_refinement(dtype):
    refiner = osh.TopologyRefiner(CUBE_FACES)
    refiner.refine_coplanar(CUBE_POSITIONS.astype(dtype), 2, 0.5, close_gaps=False,
                            full_topology_in_last_level=True)
    made = pickle.loads(pickle.dumps(refiner))
    assert not made.is_uniform
    assert describe(made) == describe(refiner)


def test_copies_do_not_warn_again():
    with pytest.warns(osh.StatusWarning):
        refiner = osh.TopologyRefiner([[0, 1, 2], [0, 1, 3]])
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert describe(copy.copy(refiner)) == describe(refiner)


@pytest.mark.parametrize("make_copy", COPIES)
def test_options(make_copy):
    enumerations = [value for value in vars(osh).values() if hasattr(value, "__members__")]
    assert len(enumerations) >= 12
    for enumeration in enumerations:
        for member in enumeration.__members__.values():
            assert make_copy(member) == member and type(make_copy(member)) is enumeration
    camera = osh.Camera((1, 2, 3), (0.5, 0, 0), (0, 0, 1), 35, 640, 480)
    assert repr(make_copy(camera)) == repr(camera) == (
        "<Camera eye=(1.0, 2.0, 3.0), target=(0.5, 0.0, 0.0), up=(0.0, 0.0, 1.0), "
        "field_of_view=35.0, width=640, height=480>")
    view = osh.View(camera, flatness=0.25, edge_length=9, max_level=5, culling=True, hysteresis=0.75)
    assert repr(make_copy(view)) == repr(view)
    factory = osh.SurfaceFactory(osh.TopologyRefiner(CUBE_FACES))
    cells = [v.make_forest(factory, CUBE_POSITIONS).cells_by_level for v in (view, make_copy(view))]
    assert cells[0] == cells[1]


@pytest.mark.parametrize("make_copy", COPIES)
def test_tessellations(make_copy):
    for levels in (2, [0, 1, 2, 3, 1]):
        for facet_size in (0, 3, 4):
            tessellation = osh.LevelTessellation(4, levels, facet_size)
            made = make_copy(tessellation)
            assert made.levels == tessellation.levels and made.facet_size == facet_size
            np.testing.assert_array_equal(made.coords, tessellation.coords)
            np.testing.assert_array_equal(made.facets, tessellation.facets)
    factory = osh.SurfaceFactory(osh.TopologyRefiner(CUBE_FACES))
    forest = osh.View(osh.Camera((0, 0, 5))).make_forest(factory, CUBE_POSITIONS)
    with pytest.raises(TypeError, match="of a CellForest, or of a section"):
        make_copy(forest.tessellation(0))


def test_other_objects_are_refused():
    refiner = make_tagged()
    factory = osh.SurfaceFactory(refiner)
    for value in (refiner.get_level(0), osh.StencilTable(refiner), factory, factory.vertex_surface(0)):
        for protocol in range(pickle.HIGHEST_PROTOCOL + 1):
            with pytest.raises(TypeError, match=f"cannot pickle.*{type(value).__name__}"):
                pickle.dumps(value, protocol)


def test_errors():
    with pytest.raises(osh.StatusError) as caught:
        osh.TopologyRefiner([[0, 1, 2], [2, 1]])
    made = pickle.loads(pickle.dumps(caught.value))
    assert type(made) is osh.StatusError and str(made) == str(caught.value)
    assert (made.code, made.component, made.index) == (
        osh.StatusCode.INVALID_TOPOLOGY, osh.ComponentType.FACE, 1)


def test_functions_are_those_of_the_package():
    for function in (osh.create_triangle_indices, osh.CpuEvaluator.eval_stencils, osh.TopologyRefiner.get_level):
        assert function.__module__ == "opensubdivhex"
        assert pickle.loads(pickle.dumps(function)) is function
