# SPDX-License-Identifier: Apache-2.0
"""Stencil tables: as arrays, as sparse matrices, of all options."""

import gc

import numpy as np
import opensubdivhex as osh
import pytest
from meshes import CUBE_FACES, CUBE_POSITIONS, make_grid, make_torus
from scipy import sparse

GRID_POSITIONS, GRID_FACES = make_grid(4, 3)


def refine(faces, level, full=False, **options):
    refiner = osh.TopologyRefiner(faces, **options)
    refiner.refine_uniform(level, full_topology_in_last_level=full)
    return refiner


def multiply(table, values):
    """The stencils, one by one."""
    result = np.zeros((table.num_stencils,) + values.shape[1:])
    for i, (begin, size) in enumerate(zip(table.offsets, table.sizes)):
        row = slice(begin, begin + size)
        result[i] = table.weights[row].astype(np.float64) @ values[table.control_indices[row]]
    return result


def test_a_table_is_its_arrays():
    refiner = refine(GRID_FACES, 2, vtx_boundary_interpolation="edge_and_corner")
    table = osh.StencilTable(refiner)
    counts = [refiner.get_level(i).num_vertices for i in range(3)]
    assert table.num_control_vertices == counts[0]
    assert table.num_stencils == counts[1] + counts[2] == len(table.sizes) == len(table.offsets)
    assert len(table.weights) == len(table.control_indices) == table.sizes.sum()
    np.testing.assert_array_equal(table.offsets, np.r_[0, np.cumsum(table.sizes)[:-1]])
    sums = np.add.reduceat(table.weights, table.offsets)
    np.testing.assert_allclose(sums, 1, atol=1e-6)
    expected = osh.RefinementEvaluator(refiner).evaluate_all_levels(GRID_POSITIONS)
    np.testing.assert_allclose(multiply(table, GRID_POSITIONS), expected, atol=2e-6)


def test_arrays_are_views_that_keep_the_table():
    table = osh.StencilTable(refine(CUBE_FACES, 2))
    arrays = [table.sizes, table.offsets, table.control_indices, table.weights]
    copies = [array.copy() for array in arrays]
    assert table.weights.ctypes.data == table.weights.ctypes.data
    assert table.weights.dtype == np.float32 and table.sizes.dtype == np.int32
    assert not any(array.flags.writeable or array.flags.owndata for array in arrays)
    del table
    gc.collect()
    osh.StencilTable(refine(CUBE_FACES, 2, face_mask="smooth"))
    for array, copy in zip(arrays, copies):
        np.testing.assert_array_equal(array, copy)


@pytest.mark.parametrize("dtype", [np.float32, np.float64, "float64", float])
def test_weights_have_the_type_that_was_asked_for(dtype):
    refiner = refine(CUBE_FACES, 2)
    table = osh.StencilTable(refiner, dtype=dtype)
    limit = osh.LimitStencilTable(refiner, 1, dtype=dtype)
    assert table.weights.dtype == limit.weights.dtype == limit.dv_weights.dtype == np.dtype(dtype)
    single = osh.StencilTable(refiner)
    np.testing.assert_allclose(table.weights, single.weights, atol=1e-7)


def test_options_choose_stencils():
    refiner = refine(CUBE_FACES, 3)
    n = [refiner.get_level(i).num_vertices for i in range(4)]
    last = osh.StencilTable(refiner, generate_intermediate_levels=False)
    everything = osh.StencilTable(refiner)
    assert last.num_stencils == n[3] and everything.num_stencils == n[1] + n[2] + n[3]
    np.testing.assert_array_equal(last.weights, everything.weights[everything.offsets[n[1] + n[2]]:])
    with_control = osh.StencilTable(refiner, generate_control_verts=True, max_level=1)
    assert with_control.num_stencils == n[0] + n[1]
    np.testing.assert_array_equal(with_control.sizes[:8], 1)
    step = osh.StencilTable(refiner, generate_intermediate_levels=False,
                            factorize_intermediate_levels=False)
    coarse = osh.StencilTable(refiner, generate_intermediate_levels=False, max_level=2)
    product = step.to_scipy() @ (coarse.to_scipy() @ CUBE_POSITIONS)
    np.testing.assert_allclose(product, last.to_scipy() @ CUBE_POSITIONS, atol=1e-6)


def test_sparse_matrices_share_memory():
    table = osh.StencilTable(refine(CUBE_FACES, 2))
    matrix = table.to_scipy()
    assert sparse.isspmatrix_csr(matrix)
    assert matrix.shape == (table.num_stencils, 8)
    assert np.shares_memory(matrix.data, table.weights)
    assert np.shares_memory(matrix.indices, table.control_indices)
    np.testing.assert_allclose(matrix @ CUBE_POSITIONS, multiply(table, CUBE_POSITIONS), atol=1e-6)


def test_a_table_of_levels_in_turn_is_no_matrix():
    refiner = refine(CUBE_FACES, 2)
    table = osh.StencilTable(refiner, factorize_intermediate_levels=False)
    with pytest.raises(ValueError, match="factorize_intermediate_levels"):
        table.to_scipy()
    with pytest.raises(TypeError, match="factorized"):
        osh.CompactStencilTable(table)
    # It is evaluated level by level.
    n1, n2 = (refiner.get_level(i).num_vertices for i in (1, 2))
    values = np.zeros((n1 + n2, 3), np.float32)
    osh.CpuEvaluator.eval_stencils(table, CUBE_POSITIONS, values, 0, n1)
    osh.CpuEvaluator.eval_stencils(table, values[:n1], values, n1)
    expected = osh.RefinementEvaluator(refiner).evaluate_all_levels(CUBE_POSITIONS)
    np.testing.assert_allclose(values, expected, atol=1e-6)
    with pytest.raises(ValueError, match=r"src: 32 elements at least"):
        osh.CpuEvaluator.eval_stencils(table, values[:n1 - 1].copy(), values, n1)


def test_tables_of_faces():
    refiner = refine(GRID_FACES, 2)
    whole = osh.StencilTable(refiner, generate_intermediate_levels=False)
    part = osh.StencilTable.create_of_faces(refiner, [5, 2], generate_intermediate_levels=False)
    vertices = osh.StencilTable.get_vertices_of_faces(refiner, [2, 5], 2)
    assert 0 < len(vertices) == part.num_stencils < whole.num_stencils
    rows = whole.to_scipy()[vertices]
    assert abs(rows - part.to_scipy()).max() == 0
    polygons = osh.create_polygon_indices(refiner.get_level(2))
    inside = np.isin(np.repeat(polygons["base_faces"], polygons["sizes"]), [2, 5])
    np.testing.assert_array_equal(np.unique(polygons["vertices"][inside]), vertices)
    with pytest.raises(osh.StatusError) as caught:
        osh.StencilTable.create_of_faces(refiner, [0, 12])
    assert caught.value.component == osh.ComponentType.FACE and caught.value.index == 12


def test_sizes_are_told_before():
    refiner = refine(CUBE_FACES, 3)
    for dtype in ("float32", "float64"):
        table = osh.StencilTable(refiner, dtype=dtype)
        size = osh.StencilTable.get_size(refiner, dtype=dtype)
        assert size["num_stencils"] == table.num_stencils
        assert size["num_weights"] == len(table.weights)
        assert size["num_bytes"] == sum(array.nbytes for array in (
            table.sizes, table.offsets, table.control_indices, table.weights))


def test_face_varying_tables():
    faces = make_torus(4, 3)[1]
    refiner = refine(faces, 2, fvar_channels=[np.arange(48), faces.ravel()],
                     fvar_linear_interpolation="none")
    values = np.random.default_rng(1).random((48, 2), np.float32)
    table = osh.StencilTable(refiner, interpolation_mode="face_varying", fvar_channel=0,
                             generate_intermediate_levels=False)
    assert table.num_control_vertices == 48
    assert table.num_stencils == refiner.get_level(2).get_num_fvar_values(0)
    expected = osh.RefinementEvaluator(refiner, interpolation_mode="face_varying").evaluate(values)
    np.testing.assert_allclose(table.to_scipy() @ values, expected, atol=1e-6)
    with pytest.raises(osh.StatusError):
        osh.StencilTable(refiner, interpolation_mode="face_varying", fvar_channel=2)


def test_limit_tables():
    positions, faces = make_torus(8, 6)
    refiner = refine(faces, 1, full=True, face_mask="smooth")
    table = osh.LimitStencilTable(refiner, 1, generate_face_centers=True)
    level = refiner.get_level(1)
    assert isinstance(table, osh.StencilTable) and table.has_derivatives
    assert table.num_stencils == level.num_vertices + level.num_faces
    matrices = table.to_scipy(), table.du_to_scipy(), table.dv_to_scipy()
    np.testing.assert_allclose(matrices[0].sum(axis=1), 1, atol=1e-5)
    for matrix in matrices[1:]:
        np.testing.assert_allclose(matrix.sum(axis=1), 0, atol=1e-5)
    points, du, dv = osh.CpuEvaluator.eval_stencils_with_derivatives(table, positions)
    for matrix, values in zip(matrices, (points, du, dv)):
        np.testing.assert_allclose(matrix @ positions, values, atol=1e-5)
    normals = osh.compute_normals(du, dv)
    np.testing.assert_allclose(np.linalg.norm(normals, axis=1), 1, atol=1e-6)
    # Away from the circle in the middle of the tube.
    axis = 2 * points / np.linalg.norm(points[:, :2], axis=1)[:, None] * [1, 1, 0]
    assert (np.einsum("ij,ij->i", points - axis, normals) > 0).all()

    plain = osh.LimitStencilTable(refiner, 1, generate_1st_derivatives=False)
    assert not plain.has_derivatives and plain.num_stencils == level.num_vertices
    with pytest.raises(ValueError, match="without derivatives"):
        plain.du_weights
    with pytest.raises(ValueError, match="without derivatives"):
        osh.CpuEvaluator.eval_stencils_with_derivatives(plain, positions)
    with pytest.raises(osh.StatusError):
        osh.LimitStencilTable(refiner, 2)


def test_limit_points_have_further_sides():
    refiner = refine(CUBE_FACES, 0, creases=([[0, 1], [1, 3], [3, 2], [2, 0]], 10))
    table = osh.LimitStencilTable(refiner, generate_further_sides=True)
    assert table.num_stencils == osh.LimitSides(refiner.get_level(0)).num_sides == 12


def test_compact_tables_are_smaller():
    table = osh.StencilTable(refine(CUBE_FACES, 3))
    compact = osh.CompactStencilTable(table)
    assert compact.num_stencils == table.num_stencils
    assert compact.num_control_vertices == 8 and 0 < compact.num_blocks < table.num_stencils
    size = sum(a.nbytes for a in (table.sizes, table.control_indices, table.weights))
    assert compact.num_bytes < 0.8 * size
    with pytest.raises(TypeError, match="float32"):
        osh.CompactStencilTable(osh.StencilTable(refine(CUBE_FACES, 1), dtype="float64"))
    with pytest.raises(TypeError, match="StencilTable"):
        osh.CompactStencilTable(osh.LimitStencilTable(refine(CUBE_FACES, 1), 0))


def test_limit_tables_are_of_the_last_level_by_default():
    refiner = refine(CUBE_FACES, 2, full=True)
    for factorized in (True, False):
        table = osh.LimitStencilTable(refiner, factorize_intermediate_levels=factorized)
        same = osh.LimitStencilTable(refiner, 2, factorize_intermediate_levels=factorized)
        assert table.num_stencils == refiner.get_level(2).num_vertices
        assert table.weights.tobytes() == same.weights.tobytes()
        assert table.to_scipy().shape == same.to_scipy().shape
    assert osh.LimitStencilTable(refiner, 0).num_stencils == 8
