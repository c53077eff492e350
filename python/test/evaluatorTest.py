# SPDX-License-Identifier: Apache-2.0
"""Evaluators and primvar refinement: all ways to the same values, into any array that fits."""

import numpy as np
import opensubdivhex as osh
import pytest
from meshes import CUBE_FACES, CUBE_POSITIONS, make_grid

POSITIONS, FACES = make_grid(5, 4)
EVALUATORS = [osh.CpuEvaluator, osh.ParallelEvaluator]


@pytest.fixture
def refiner():
    refiner = osh.TopologyRefiner(
        FACES, vtx_boundary_interpolation="edge_and_corner", face_mask="smooth",
        creases=([[7, 8], [8, 9]], [2.5, 10]), fvar_channels=[np.arange(80)],
        fvar_linear_interpolation="boundaries")
    refiner.refine_uniform(3)
    return refiner


def values_of(length, count=len(POSITIONS), dtype=np.float32):
    return np.random.default_rng(length).random((count, length)).astype(dtype)


@pytest.mark.parametrize("length", [1, 2, 3, 4, 8, 11])
@pytest.mark.parametrize("mode", ["vertex", "varying", "face_varying"])
def test_all_evaluators_agree(refiner, mode, length):
    count = 80 if mode == "face_varying" else len(POSITIONS)
    src = values_of(length, count)
    expected = osh.RefinementEvaluator(refiner, interpolation_mode=mode).evaluate(src)
    table = osh.StencilTable(refiner, interpolation_mode=mode, generate_intermediate_levels=False)
    for evaluator in EVALUATORS:
        for form in (table, osh.CompactStencilTable(table)):
            np.testing.assert_allclose(evaluator.eval_stencils(form, src), expected, atol=2e-6)
    primvars = osh.PrimvarRefiner(refiner)
    step = {"vertex": primvars.interpolate, "varying": primvars.interpolate_varying,
            "face_varying": primvars.interpolate_face_varying}[mode]
    for dtype in (np.float32, np.float64):
        values = src.astype(dtype)
        for level in (1, 2, 3):
            values = step(level, values)
            assert values.dtype == dtype
        np.testing.assert_allclose(values, expected, atol=2e-6)


def test_numbers_alone_are_elements_too(refiner):
    src = np.arange(len(POSITIONS), dtype=np.float32)
    evaluator = osh.RefinementEvaluator(refiner)
    table = osh.StencilTable(refiner, generate_intermediate_levels=False)
    expected = evaluator.evaluate(src[:, None])[:, 0]
    for values in (evaluator.evaluate(src), osh.CpuEvaluator.eval_stencils(table, src),
                   evaluator.evaluate(list(src))):
        assert values.shape == expected.shape
        np.testing.assert_allclose(values, expected, rtol=1e-6)
    assert osh.PrimvarRefiner(refiner).interpolate(1, src).ndim == 1


def test_levels_follow_each_other(refiner):
    evaluator = osh.RefinementEvaluator(refiner)
    assert evaluator.max_level == 3
    counts = [evaluator.get_num_elements(level) for level in range(4)]
    assert counts == [refiner.get_level(level).num_vertices for level in range(4)]
    everything = evaluator.evaluate_all_levels(POSITIONS)
    assert len(everything) == evaluator.num_elements_all_levels == sum(counts[1:])
    ends = np.cumsum([0] + counts[1:])
    for level in (1, 2, 3):
        np.testing.assert_array_equal(evaluator.evaluate(POSITIONS, level),
                                      everything[ends[level - 1]:ends[level]])
    np.testing.assert_array_equal(evaluator.evaluate(POSITIONS, 0), POSITIONS)


def test_values_are_written_to_given_arrays(refiner):
    evaluator = osh.RefinementEvaluator(refiner)
    table = osh.StencilTable(refiner, generate_intermediate_levels=False)
    n = refiner.get_level(3).num_vertices
    expected = evaluator.evaluate(POSITIONS)
    # Columns of a wider array, on both sides, and what is beside stays.
    wide_src = np.zeros((len(POSITIONS), 5), np.float32)
    wide_src[:, 1:4] = POSITIONS
    for run in (lambda s, d: evaluator.evaluate(s, dst=d),
                lambda s, d: osh.ParallelEvaluator.eval_stencils(table, s, d),
                lambda s, d: osh.CpuEvaluator.eval_stencils(osh.CompactStencilTable(table), s, d)):
        wide = np.full((n + 2, 7), 99, np.float32)
        dst = wide[1:-1, 2:5]
        assert run(wide_src[:, 1:4], dst) is dst
        np.testing.assert_allclose(dst, expected, atol=1e-6)
        wide[1:-1, 2:5] = 99
        assert (wide == 99).all()
    # Behind the control values, in one array.
    buffer = np.empty((len(POSITIONS) + n, 3), np.float32)
    buffer[:len(POSITIONS)] = POSITIONS
    evaluator.evaluate(buffer[:len(POSITIONS)], dst=buffer[len(POSITIONS):])
    np.testing.assert_array_equal(buffer[len(POSITIONS):], expected)
    # Beside them.
    step = osh.PrimvarRefiner(refiner)
    double = np.zeros((refiner.get_level(1).num_vertices, 6))
    double[:len(POSITIONS), :3] = POSITIONS
    step.interpolate(1, double[:len(POSITIONS), :3], double[:, 3:])
    np.testing.assert_allclose(double[:, 3:], evaluator.evaluate(POSITIONS, 1), atol=1e-6)


@pytest.mark.parametrize("evaluator", EVALUATORS)
def test_ranges_write_their_stencils_alone(refiner, evaluator):
    table = osh.StencilTable(refiner)
    n = table.num_stencils
    expected = evaluator.eval_stencils(table, POSITIONS)
    for start, end in ((0, n), (5, 6), (7, 7), (n - 3, None), (0, 1)):
        dst = np.full((n, 3), 99, np.float32)
        evaluator.eval_stencils(table, POSITIONS, dst, start, end)
        end = n if end is None else end
        np.testing.assert_array_equal(dst[start:end], expected[start:end])
        assert (dst[:start] == 99).all() and (dst[end:] == 99).all()


def test_derivatives_go_to_given_arrays():
    refiner = osh.TopologyRefiner(CUBE_FACES)
    table = osh.LimitStencilTable(refiner)
    expected = osh.CpuEvaluator.eval_stencils_with_derivatives(table, CUBE_POSITIONS)
    whole = np.zeros((8, 9), np.float32)
    views = whole[:, 0:3], whole[:, 3:6], whole[:, 6:9]
    result = osh.ParallelEvaluator.eval_stencils_with_derivatives(table, CUBE_POSITIONS, *views)
    for view, returned, values in zip(views, result, expected):
        assert view is returned
        np.testing.assert_array_equal(view, values)
    normals = np.zeros((8, 3), np.float32)
    assert osh.compute_normals(result[1], result[2], normals) is normals
    np.testing.assert_allclose(normals, CUBE_POSITIONS / np.sqrt(3), atol=1e-6)
    assert (osh.compute_normals(np.ones((1, 3), np.float32), np.ones((1, 3), np.float32)) == 0).all()


def test_face_uniform_data_of_any_type(refiner):
    primvars = osh.PrimvarRefiner(refiner)
    names = np.array([f"face {i}" for i in range(len(FACES))])
    for level in (1, 2, 3):
        names = primvars.interpolate_face_uniform(level, names)
    expected = [f"face {i}" for i in refiner.get_level(3).get_face_base_faces()]
    np.testing.assert_array_equal(names, expected)
    colours = np.random.default_rng(0).random((len(FACES), 2, 2))
    dst = np.empty((refiner.get_level(1).num_faces, 2, 2))
    assert primvars.interpolate_face_uniform(1, colours, dst) is dst
    np.testing.assert_array_equal(dst, colours[refiner.get_level(1).get_face_base_faces()])


def test_an_evaluator_gets_out_of_date():
    refiner = osh.TopologyRefiner(CUBE_FACES)
    refiner.refine_uniform(2)
    evaluator = osh.RefinementEvaluator(refiner)
    table = osh.StencilTable(refiner, generate_intermediate_levels=False)
    expected = evaluator.evaluate(CUBE_POSITIONS)
    refiner.refine_uniform(1)
    with pytest.raises(RuntimeError, match="refined"):
        evaluator.evaluate(CUBE_POSITIONS)
    with pytest.raises(RuntimeError, match="refined"):
        evaluator.max_level
    # A table refers to nothing.
    np.testing.assert_allclose(osh.CpuEvaluator.eval_stencils(table, CUBE_POSITIONS), expected,
                               atol=1e-6)


def test_an_evaluator_keeps_its_refiner():
    def make():
        refiner = osh.TopologyRefiner(CUBE_FACES)
        refiner.refine_uniform(2)
        return osh.RefinementEvaluator(refiner), osh.PrimvarRefiner(refiner)

    evaluator, primvars = make()
    values = primvars.interpolate(2, primvars.interpolate(1, CUBE_POSITIONS))
    np.testing.assert_allclose(evaluator.evaluate(CUBE_POSITIONS), values, atol=1e-6)


def test_simd_levels():
    table = osh.StencilTable(osh.TopologyRefiner(CUBE_FACES), generate_control_verts=True)
    before = osh.get_simd_level()
    try:
        osh.set_simd_level("portable")
        assert osh.get_simd_level() == osh.SimdLevel.PORTABLE
        values = osh.CpuEvaluator.eval_stencils(table, CUBE_POSITIONS)
        np.testing.assert_array_equal(values, CUBE_POSITIONS)
        if osh.get_max_simd_level() != osh.SimdLevel.AVX512:
            with pytest.raises(ValueError, match="none above"):
                osh.set_simd_level("avx512")
    finally:
        osh.set_simd_level(before)


@pytest.fixture
def full_refiner():
    refiner = osh.TopologyRefiner(
        FACES, vtx_boundary_interpolation="edge_and_corner", face_mask="smooth",
        creases=([[7, 8], [8, 9]], 10))
    refiner.refine_uniform(2, full_topology_in_last_level=True)
    return refiner


@pytest.mark.parametrize("level", [0, 1, 2])
def test_all_ways_to_the_limit_agree(full_refiner, level):
    table = osh.LimitStencilTable(full_refiner, level)
    expected = osh.CpuEvaluator.eval_stencils_with_derivatives(table, POSITIONS)
    assert np.abs(expected[1]).max() > 0.1 and np.abs(expected[2]).max() > 0.1
    evaluator = osh.RefinementEvaluator(full_refiner)
    found = evaluator.evaluate_limit_with_derivatives(POSITIONS, level)
    for values, wanted in zip(found, expected):
        np.testing.assert_allclose(values, wanted, atol=1e-4)
    np.testing.assert_array_equal(evaluator.evaluate_limit(POSITIONS, level), found[0])

    # Tables of the vertices of the level, in both precisions.
    for dtype in (np.float32, np.float64):
        own = osh.LimitStencilTable(full_refiner, level, factorize_intermediate_levels=False,
                                    dtype=dtype)
        assert own.to_scipy().shape == (table.num_stencils, evaluator.get_num_elements(level))
        refined = evaluator.evaluate(POSITIONS, level).astype(dtype)
        for matrix, wanted in zip((own.to_scipy(), own.du_to_scipy(), own.dv_to_scipy()), expected):
            np.testing.assert_allclose(matrix @ refined, wanted, atol=1e-4)
        if level < 2:
            continue
        primvars = osh.PrimvarRefiner(full_refiner)
        limits = primvars.limit_with_derivatives(refined)
        for values, wanted in zip(limits, expected):
            assert values.dtype == dtype
            np.testing.assert_allclose(values, wanted, atol=1e-4)
        np.testing.assert_array_equal(primvars.limit(refined), limits[0])


def test_limits_are_written_to_given_arrays(full_refiner):
    evaluator, primvars = osh.RefinementEvaluator(full_refiner), osh.PrimvarRefiner(full_refiner)
    expected = evaluator.evaluate_limit_with_derivatives(POSITIONS)
    refined = evaluator.evaluate(POSITIONS)
    for evaluate, src in ((evaluator.evaluate_limit_with_derivatives, POSITIONS),
                          (primvars.limit_with_derivatives, refined)):
        wide = np.full((len(refined), 10), 7, np.float32)
        found = evaluate(src, dst=wide[:, 0:3], du=wide[:, 3:6], dv=wide[:, 6:9])
        assert all(np.shares_memory(part, wide) for part in found)
        np.testing.assert_allclose(wide[:, :9], np.hstack(expected), atol=1e-4)
        assert (wide[:, 9] == 7).all()
    for evaluate, src in ((evaluator.evaluate_limit, POSITIONS), (primvars.limit, refined)):
        points = np.empty((len(refined), 3), np.float32)
        assert evaluate(src, dst=points) is points
        np.testing.assert_allclose(points, expected[0], atol=1e-5)
        with pytest.raises(ValueError, match="dst"):
            evaluate(src, dst=points[1:])
        with pytest.raises(ValueError, match="src"):
            evaluate(src[1:])
    with pytest.raises(ValueError, match="dv"):
        evaluator.evaluate_limit_with_derivatives(POSITIONS, dv=np.empty((3, 3), np.float32))
    with pytest.raises(ValueError, match="du"):
        primvars.limit_with_derivatives(refined, du=refined)


def test_limits_that_are_not_there(refiner):
    with pytest.raises(osh.StatusError):  # the last level has face-vertices alone
        osh.RefinementEvaluator(refiner).evaluate_limit(POSITIONS)
    with pytest.raises(osh.StatusError):
        osh.PrimvarRefiner(refiner).limit(osh.RefinementEvaluator(refiner).evaluate(POSITIONS))
    osh.RefinementEvaluator(refiner).evaluate_limit(POSITIONS, 2)
    varying = osh.RefinementEvaluator(refiner, interpolation_mode="varying")
    with pytest.raises(osh.StatusError):
        varying.evaluate_limit(POSITIONS, 1)
    with pytest.raises(IndexError, match="level"):
        varying.evaluate_limit(POSITIONS, 4)


def test_normals_of_either_precision():
    random = np.random.default_rng(4)
    du, dv = random.random((2, 50, 3))
    expected = np.cross(du, dv)
    expected /= np.linalg.norm(expected, axis=1)[:, None]
    exact = osh.compute_normals(du, dv)
    assert exact.dtype == np.float64
    np.testing.assert_allclose(exact, expected, rtol=0, atol=1e-14)
    single = osh.compute_normals(du.astype(np.float32), dv.astype(np.float32))
    assert single.dtype == np.float32
    np.testing.assert_allclose(single, expected, rtol=0, atol=1e-5)
    mixed = np.empty((50, 3))
    assert osh.compute_normals(du.astype(np.float32), dv, mixed) is mixed
    np.testing.assert_allclose(mixed, expected, rtol=0, atol=1e-5)
    with pytest.raises(TypeError, match="^normals: float64 is needed, not float32$"):
        osh.compute_normals(du, dv, np.empty((50, 3), np.float32))
    # Derivatives as the module makes them.
    factory = osh.SurfaceFactory(osh.TopologyRefiner(CUBE_FACES, face_mask="smooth"))
    points, du, dv = factory.vertex_surface(0).evaluate_with_derivatives([[0.5, 0.5]],
                                                                         CUBE_POSITIONS)
    normals = osh.compute_normals(du, dv)
    assert normals.dtype == np.float64 and abs(np.linalg.norm(normals) - 1) < 1e-15
    assert points[0] @ normals[0] > 0


def test_primvars_of_any_type(refiner):
    primvars = osh.PrimvarRefiner(refiner)
    expected = primvars.interpolate(1, POSITIONS)
    for src in (POSITIONS.tolist(), POSITIONS.astype(np.float16).astype(">f2"), POSITIONS[::-1]):
        wanted = primvars.interpolate(1, np.array(src, np.float32))
        found = primvars.interpolate(1, src)
        assert found.dtype == np.float32
        np.testing.assert_array_equal(found, wanted)
    exact = primvars.interpolate(1, POSITIONS.astype(np.float64))
    np.testing.assert_allclose(exact, expected, atol=1e-6)
    for src in (POSITIONS.astype(">f8"), np.asfortranarray(POSITIONS.astype(np.float64)),
                POSITIONS.astype(np.longdouble)):
        found = primvars.interpolate(1, src)
        assert found.dtype == np.float64
        np.testing.assert_array_equal(found, exact)
    if np.finfo(np.longdouble).max > np.finfo(np.float64).max:
        with pytest.raises(ValueError, match="src: number 0 is inf, which float64 does not hold"):
            primvars.interpolate(1, np.full((len(POSITIONS), 3), np.longdouble("1e400")))
