# SPDX-License-Identifier: Apache-2.0
"""Errors of the caller are named, and nothing is read or written past an array."""

import numpy as np
import opensubdivhex as osh
import pytest
from meshes import CUBE_FACES, CUBE_POSITIONS


@pytest.fixture(scope="module")
def refiner():
    refiner = osh.TopologyRefiner(CUBE_FACES, fvar_channels=[np.arange(24)])
    refiner.refine_uniform(2)
    return refiner


@pytest.mark.parametrize("arguments, error, message", [
    ({"faces": None}, TypeError, "^faces must be a list of lists of int; it is NoneType$"),
    ({"faces": 3}, TypeError, "^faces must be a list of lists of int; it is int$"),
    ({"faces": [0, 1, 2]}, TypeError, r"^faces must be a list of lists of int; faces\[0\] is int$"),
    ({"faces": [[0, 1, 2.5]]}, TypeError, r"faces\[0\]: integers are needed, not float64"),
    ({"faces": [[0, 1, 2], "abc"]}, (TypeError, ValueError), r"faces\[1\]"),
    ({"faces": [[0, 1, 2], 3]}, TypeError, r"^faces must be .* faces\[1\] is int$"),
    ({"faces": np.zeros((2, 3))}, TypeError, "faces: integers are needed, not float64"),
    ({"faces": np.zeros((2, 3), bool)}, TypeError, "faces: integers"),
    ({"faces": np.zeros(6, int)}, ValueError, "faces: 2 dimensions are needed"),
    ({"faces": [[0, 1, 2**31]]}, ValueError, r"number 2 is 2147483648, which int32 does"),
    ({"faces": np.array([[0, 1, 2**32 + 2]], np.uint64)}, ValueError, "int32 does not hold"),
    ({"faces": [[0, 1, -2**40]]}, ValueError, "int32 does not hold"),
    ({"faces": [[0, 1, 2**31 - 1]]}, ValueError,
     "^num_vertices: corner 2 refers to number 2147483647, but there are 3 corners; pass"),
    ({"faces": [[0, 1, 2**31 - 2]]}, ValueError, "num_vertices: corner 2 refers to number 2147483646"),
    ({"faces": [[0, 10**8, 2]]}, ValueError, "num_vertices: corner 1 refers to number 100000000"),
    ({"faces": [[0, 65536, 2]]}, ValueError, "num_vertices: corner 1 refers to number 65536"),
    ({"faces": [[0, 1, 2]], "fvar_channels": [[0, 1, 65536]]}, ValueError,
     "num_fvar_values: corner 2 refers to number 65536"),
    ({"faces": [[0, 1, 2]], "fvar_channels": [[0, 1, 2]], "num_fvar_values": [2**31 - 1]},
     osh.StatusError, "2147483650 values and face-vertices in face-varying channel 0"),
    ({"faces": np.ma.masked_less(np.zeros((2, 3), int), 1)}, ValueError, "faces: .* masked"),
    ({"faces": CUBE_FACES, "creases": ([[0, 1]], 1e300)}, ValueError,
     r"creases: number 0 is 1e\+300, which float32 does not hold"),
    ({"faces": CUBE_FACES, "num_vertices": -1}, ValueError, "num_vertices: -1"),
    ({"faces": CUBE_FACES, "num_vertices": 8.0}, TypeError,
     "^num_vertices: an integer or None is needed, not float$"),
    ({"faces": CUBE_FACES, "num_vertices": np.array([8, 9])}, TypeError,
     "^num_vertices: an integer or None is needed, not ndarray$"),
    ({"faces": CUBE_FACES, "num_vertices": 2**40}, ValueError,
     "^num_vertices: 1099511627776 is a number that 32 bits do not hold$"),
    ({"faces": CUBE_FACES, "num_vertices": np.int64(-2**40)}, ValueError, "32 bits"),
    ({"faces": CUBE_FACES, "is_left_handed": [0]}, TypeError,
     "^is_left_handed: a bool is needed, not list$"),
    ({"faces": CUBE_FACES, "mask": "smooth"}, TypeError,
     "^TopologyRefiner: there is no argument 'mask'$"),
    ({"faces": np.arange(6), "face_offsets": [0, 3]}, ValueError, "face_offsets: they begin"),
    ({"faces": np.arange(6), "face_offsets": [1, 3, 6]}, ValueError, "face_offsets: they begin"),
    ({"faces": np.arange(6), "face_offsets": []}, ValueError, "face_offsets: they begin"),
    ({"faces": np.arange(6), "face_offsets": [0, 9, 6]}, ValueError, "face 1 descend"),
    ({"faces": np.arange(6), "face_offsets": [0, -3, 6]}, ValueError, "face 0 descend"),
    ({"faces": np.arange(6).reshape(2, 3), "face_offsets": [0, 3, 6]}, ValueError,
     "faces: 1 dimension is needed"),
    ({"faces": CUBE_FACES, "creases": [0, 1]}, ValueError, "creases: 2 dimensions"),
    ({"faces": CUBE_FACES, "creases": 3}, TypeError, "creases: a pair"),
    ({"faces": CUBE_FACES, "creases": ([[0, 1, 3]], 1)}, ValueError, "creases: two vertices"),
    ({"faces": CUBE_FACES, "creases": ([[0, 1]], [1, 2])}, ValueError, "creases: one number"),
    ({"faces": CUBE_FACES, "creases": ([[0, 1]], "sharp")}, TypeError, "creases: numbers"),
    ({"faces": CUBE_FACES, "corners": ([0], 1, 2)}, ValueError, "corners: a pair"),
    ({"faces": CUBE_FACES, "corners": ([0.5], 1)}, TypeError, "corners: integers"),
    ({"faces": CUBE_FACES, "holes": [[1]]}, ValueError, "holes: 1 dimension"),
    ({"faces": CUBE_FACES, "fvar_channels": [np.arange(23)]}, ValueError,
     r"fvar_channels\[0\]: one value for each of the 24"),
    ({"faces": CUBE_FACES, "fvar_channels": [np.arange(24)], "num_fvar_values": [24, 3]},
     ValueError, "num_fvar_values"),
    ({"faces": CUBE_FACES, "num_fvar_values": [24]}, ValueError, "num_fvar_values"),
    ({"faces": CUBE_FACES, "fvar_channels": [np.arange(24)], "num_fvar_values": [23]},
     osh.StatusError, "23"),
    ({"faces": CUBE_FACES, "face_mask": "sharp"}, ValueError,
     "face_mask: 'sharp' is none of 'average', 'cosine', 'smooth'"),
    ({"faces": CUBE_FACES, "face_mask": np.zeros((200, 3))}, TypeError,
     "^face_mask: one of 'average', 'cosine', 'smooth' is needed, not ndarray$"),
    ({"faces": CUBE_FACES, "face_mask": osh.SchemeType.HEXAGONAL}, TypeError, "face_mask"),
    ({"faces": CUBE_FACES, "mask": "smooth"}, TypeError, "mask"),
])
def test_base_meshes(arguments, error, message):
    with pytest.raises(error, match=message):
        osh.TopologyRefiner(**arguments)


def test_numbers_of_vertices():
    assert osh.TopologyRefiner([[0, 1, 65535]]).get_level(0).num_vertices == 65536
    given = osh.TopologyRefiner([[0, 1, 2]], 300000, fvar_channels=[[0, 1, 2]],
                                num_fvar_values=[200000])
    assert given.get_level(0).num_vertices == 300000
    assert given.get_level(0).get_num_fvar_values(0) == 200000
    # 16 for each corner.
    faces = 16 * np.arange(15000).reshape(-1, 3) + 15
    assert osh.TopologyRefiner(faces).get_level(0).num_vertices == 16 * 15000
    faces[-1, 1] = 16 * 15000
    with pytest.raises(ValueError, match="num_vertices: corner 14998 refers to number 240000"):
        osh.TopologyRefiner(faces)


def test_indices_and_sharpness_of_any_type_and_layout():
    expected = osh.TopologyRefiner(CUBE_FACES, creases=([[0, 1]], 2.5)).get_level(0)
    faces = np.array(CUBE_FACES)
    for taken in (faces, faces.astype(">i2"), np.asfortranarray(faces), unaligned(faces),
                  unaligned(faces.astype(np.uint64)), faces[::-1].copy()[::-1]):
        for sharpness in (2.5, [2.5], np.float16([2.5]), unaligned(np.float32([2.5])),
                          unaligned(np.float64([2.5])), np.array(2.5, ">f8")):
            level = osh.TopologyRefiner(taken, creases=([[0, 1]], sharpness)).get_level(0)
            np.testing.assert_array_equal(level.face_vertices, expected.face_vertices)
            np.testing.assert_array_equal(level.get_edge_sharpness(),
                                          expected.get_edge_sharpness())


def evaluators(refiner):
    table = osh.StencilTable(refiner, generate_intermediate_levels=False)
    evaluator = osh.RefinementEvaluator(refiner)
    return [
        lambda src, dst=None: evaluator.evaluate(src, dst=dst),
        lambda src, dst=None: osh.CpuEvaluator.eval_stencils(table, src, dst),
        lambda src, dst=None: osh.ParallelEvaluator.eval_stencils(table, src, dst),
        lambda src, dst=None: osh.CpuEvaluator.eval_stencils(
            osh.CompactStencilTable(table), src, dst),
    ]


@pytest.mark.parametrize("which", range(4))
def test_sources(refiner, which):
    run = evaluators(refiner)[which]
    bad = [
        (np.zeros((7, 3), np.float32), ValueError, r"src: 8 elements are needed, the shape is \(7,"),
        (np.zeros((9, 3), np.float32), ValueError, "src: 8 elements"),
        (np.zeros((8, 0), np.float32), ValueError, "src: elements of the shape"),
        (np.zeros((8, 3, 1), np.float32), ValueError, "src: one or two dimensions"),
        (np.float32(3), (TypeError, ValueError), "src"),
        (np.zeros((8, 3), complex), TypeError, "src: numbers are needed, not complex128"),
        (np.zeros((8, 3), bool), TypeError, "src: numbers are needed, not bool"),
        (np.full((8, 3), 2**24 + 1), ValueError,
         "src: number 0 is 16777217, which float32 does not hold"),
        (np.full((8, 3), 2**64 - 1, np.uint64), ValueError, "which float32 does not hold"),
        (np.full((8, 3), 2**63 - 1), ValueError, "which float32 does not hold"),
        (np.full((8, 3), 1e39), ValueError, r"src: number 0 is 1e\+39, which float32 does not hold"),
        (np.full((8, 3), np.longdouble("1e39")), ValueError, "src: number 0 is"),
        ([[0, 0, 0]] * 7 + [[0, -1e300, 0]], ValueError, r"src: number 22 is -1e\+300"),
        (np.ma.masked_less(np.zeros((8, 3), np.float32), 1), ValueError, "src: .* masked"),
        (None, TypeError, "src: an array is needed, not None"),
        ("abc", (TypeError, ValueError), "src"),
    ]
    for src, error, message in bad:
        with pytest.raises(error, match=message):
            run(src)


def unaligned(array):
    """The same numbers, one byte behind where the machine has them."""
    data = np.frombuffer(b"p" + array.tobytes(), np.uint8)[1:]
    result = data.view(array.dtype).reshape(array.shape)
    assert not result.flags.aligned
    return result


@pytest.mark.parametrize("which", range(4))
def test_sources_of_any_type_and_layout(refiner, which):
    run = evaluators(refiner)[which]
    expected = run(CUBE_POSITIONS)
    wide = np.zeros((8, 6), np.float32)
    wide[:, ::2] = CUBE_POSITIONS
    records = np.zeros(8, [("p", "f4", 3), ("tag", "u1")])
    records["p"] = CUBE_POSITIONS
    for src in (CUBE_POSITIONS.tolist(), CUBE_POSITIONS.astype(int).tolist(),
                CUBE_POSITIONS.astype(np.float64), CUBE_POSITIONS.astype(np.float16),
                CUBE_POSITIONS.astype(np.longdouble), CUBE_POSITIONS.astype(np.int8),
                CUBE_POSITIONS.astype(">f4"), CUBE_POSITIONS.astype(">i2"),
                np.asfortranarray(CUBE_POSITIONS), CUBE_POSITIONS[::-1].copy()[::-1],
                CUBE_POSITIONS[:, ::-1].copy()[:, ::-1], wide[:, ::2], records["p"],
                unaligned(CUBE_POSITIONS), unaligned(CUBE_POSITIONS.astype(np.float64)),
                unaligned(CUBE_POSITIONS.astype(np.int64)),
                np.frombuffer(b"ply" + CUBE_POSITIONS.tobytes(), "<f4", 24, 3).reshape(8, 3),
                np.ma.masked_greater(CUBE_POSITIONS, 7)):
        found = run(src)
        assert found.dtype == np.float32
        np.testing.assert_array_equal(found, expected)
    np.testing.assert_array_equal(run(CUBE_POSITIONS[::-1]), run(CUBE_POSITIONS[::-1].copy()))
    np.testing.assert_array_equal(run(np.broadcast_to([1, 2, 3], (8, 3))),
                                  run(np.tile([1, 2, 3], (8, 1))))
    # float64 is rounded; infinities, and integers that are some, stay what they are.
    tenths = np.full((8, 3), 0.1)
    np.testing.assert_array_equal(run(tenths), run(tenths.astype(np.float32)))
    large = np.full((8, 3), 2**62)
    np.testing.assert_array_equal(run(large), run(np.full((8, 3), 2.0**62, np.float32)))
    with np.errstate(all="ignore"):
        assert np.isnan(run(np.full((8, 3), np.nan))).all()
        assert np.isinf(run(np.full(8, -np.inf))).all()
    # Arrays are copied before they are read.
    buffer = np.zeros((refiner.get_level(2).num_vertices + 8, 3), np.float32)
    buffer[:8] = CUBE_POSITIONS[::-1]
    np.testing.assert_array_equal(run(buffer[7::-1], buffer[:-8]), expected)


@pytest.mark.parametrize("which", range(4))
def test_destinations(refiner, which):
    run = evaluators(refiner)[which]
    n = refiner.get_level(2).num_vertices
    read_only = np.zeros((n, 3), np.float32)
    read_only.flags.writeable = False
    bad = [
        (np.zeros((n - 1, 3), np.float32), ValueError, f"dst: {n} elements are needed"),
        (np.zeros((n + 1, 3), np.float32), ValueError, f"dst: {n} elements are needed"),
        (np.zeros((n, 2), np.float32), ValueError, "dst: elements of 3 numbers are needed"),
        (np.zeros((n, 4), np.float32), ValueError, "dst: elements of 3 numbers are needed"),
        (np.zeros(n, np.float32), ValueError, "dst: elements of 3 numbers"),
        (np.zeros((n, 3)), TypeError, "^dst: float32 is needed, not float64$"),
        (np.zeros((n, 3), ">f4"), TypeError, "^dst: float32 is needed, not >f4$"),
        (np.zeros((3, n), np.float32).T, ValueError, "dst: the numbers of an element"),
        (np.zeros((n, 3), np.float32)[::-1], ValueError, "dst: elements must lie one behind"),
        (np.frombuffer(bytearray(12 * n + 1), np.uint8)[1:].view(np.float32).reshape(n, 3),
         ValueError, "^dst: the array is not aligned$"),
        (np.broadcast_to(np.zeros((1, 3), np.float32), (n, 3)), ValueError, "dst"),
        (read_only, ValueError, "dst: the array is read-only"),
        ([[0.0] * 3] * n, TypeError, "dst: an array to write to is needed, not list"),
        (bytearray(12 * n), TypeError, "dst: an array to write to"),
    ]
    for dst, error, message in bad:
        with pytest.raises(error, match=message):
            run(CUBE_POSITIONS, dst)
    assert (read_only == 0).all()
    buffer = np.zeros((n + 8, 3), np.float32)
    with pytest.raises(ValueError, match="dst: it shows the memory of numbers that are read"):
        run(buffer[:8], buffer[7:n + 7])
    run(buffer[:8], buffer[8:])


def test_levels_channels_and_ranges(refiner):
    evaluator, primvars = osh.RefinementEvaluator(refiner), osh.PrimvarRefiner(refiner)
    table = osh.StencilTable(refiner)
    dst = np.zeros((table.num_stencils, 3), np.float32)
    limit = osh.LimitStencilTable(refiner, 0)
    calls = [
        lambda: refiner.get_level(3), lambda: refiner.get_level(-1),
        lambda: evaluator.evaluate(CUBE_POSITIONS, 3),
        lambda: evaluator.evaluate(CUBE_POSITIONS, -1),
        lambda: evaluator.get_num_elements(3),
        lambda: primvars.interpolate(0, CUBE_POSITIONS),
        lambda: primvars.interpolate(3, CUBE_POSITIONS),
        lambda: primvars.interpolate_face_uniform(3, np.zeros(6)),
        lambda: primvars.interpolate_face_varying(1, CUBE_POSITIONS, channel=1),
        lambda: refiner.get_level(0).get_num_fvar_values(1),
        lambda: refiner.get_level(0).get_face_fvar_values(-1),
        lambda: refiner.get_level(0).does_edge_fvar_topology_match(1),
        lambda: refiner.get_level(0).get_fvar_split_faces(1),
        lambda: refiner.get_num_fvar_values_total(1),
        lambda: refiner.get_fvar_linear_interpolation(1),
        lambda: refiner.get_level(0).find_edge(0, 8),
        lambda: refiner.get_level(1).get_face_base_faces(2),
        lambda: refiner.get_level(1).is_face_hole(-1),
        lambda: osh.LimitSides(refiner.get_level(0)).find_sides(refiner.get_level(0), 2),
        lambda: osh.CpuEvaluator.eval_stencils(table, CUBE_POSITIONS, dst, -1),
        lambda: osh.CpuEvaluator.eval_stencils(table, CUBE_POSITIONS, dst, 0, len(dst) + 1),
        lambda: osh.CpuEvaluator.eval_stencils(table, CUBE_POSITIONS, dst, 3, 2),
        lambda: osh.ParallelEvaluator.eval_stencils_with_derivatives(limit, CUBE_POSITIONS, start=9),
    ]
    for call in calls:
        with pytest.raises(IndexError):
            call()
    with pytest.raises(ValueError, match="dst: a range needs an array"):
        osh.CpuEvaluator.eval_stencils(table, CUBE_POSITIONS, start=1)


def test_further_arguments(refiner):
    primvars = osh.PrimvarRefiner(refiner)
    table = osh.StencilTable(refiner, dtype="float64")
    three = np.zeros((5, 3), np.float32)
    calls = [
        (lambda: osh.StencilTable(refiner, dtype="int32"), TypeError, "dtype: float32 or float64"),
        (lambda: osh.StencilTable(refiner, dtype="float16"), TypeError, "dtype"),
        (lambda: osh.StencilTable(refiner, interpolation_mode="limit"), ValueError,
         "interpolation_mode: 'limit' is none of 'vertex', 'varying', 'face_varying'"),
        (lambda: osh.StencilTable(refiner, max_level=-1), osh.StatusError, ""),
        (lambda: osh.StencilTable(None), TypeError, "refiner"),
        (lambda: osh.PrimvarRefiner(None), TypeError, "refiner"),
        (lambda: osh.RefinementEvaluator(None), TypeError, "refiner"),
        (lambda: osh.LimitStencilTable(refiner, 0, generate_vertices=False), osh.StatusError, ""),
        (lambda: osh.CpuEvaluator.eval_stencils(table, CUBE_POSITIONS), TypeError,
         "table: evaluators take float32"),
        (lambda: osh.CpuEvaluator.eval_stencils(None, CUBE_POSITIONS), TypeError,
         "^table: a (Compact)?StencilTable is needed, not NoneType$"),
        (lambda: osh.RefinementEvaluator(refiner, interpolation_mode="face_varying",
                                         fvar_channel=1), osh.StatusError, ""),
        (lambda: primvars.interpolate(1, CUBE_POSITIONS.astype(complex)), TypeError, "numbers"),
        (lambda: primvars.interpolate(1, CUBE_POSITIONS, np.zeros((32, 3))), TypeError,
         "dst: float32"),
        (lambda: primvars.interpolate_face_uniform(1, np.zeros(5)), ValueError, "src: 6 elements"),
        (lambda: primvars.interpolate_face_uniform(1, np.zeros(6), np.zeros(3)), ValueError, ""),
        (lambda: osh.compute_normals(three, three[:4]), ValueError, "dv: 5 elements"),
        (lambda: osh.compute_normals(three[:, :2], three[:, :2]), ValueError, "vectors"),
        (lambda: osh.compute_normals(three, three, np.zeros((5, 3))), TypeError, "normals"),
        (lambda: osh.set_simd_level("sse"), ValueError, "level: 'sse' is none of"),
        (lambda: osh.set_num_threads("two"), TypeError, "^num_threads: an integer is needed, not str$"),
    ]
    for call, error, message in calls:
        with pytest.raises(error, match=message):
            call()


def test_simple_arguments(refiner):
    surfaces = osh.SurfaceFactory(refiner)
    camera = osh.Camera((0, 0, 5))
    calls = [
        (lambda: refiner.refine_uniform("3"), "^level: an integer is needed, not str$"),
        (lambda: refiner.refine_uniform(level=3.0), "^level: an integer is needed, not float$"),
        (lambda: refiner.refine_uniform(np.zeros(2, int)), "^level: an integer is needed, not ndarray$"),
        (lambda: refiner.refine_uniform(), "^refine_uniform: the argument level is missing$"),
        (lambda: refiner.refine_uniform(3, full=True), "^refine_uniform: there is no argument 'full'$"),
        (lambda: refiner.refine_uniform(3, level=3), "^refine_uniform: level is given twice$"),
        (lambda: refiner.refine_uniform(3, []), "full_topology_in_last_level: a bool is needed, not list"),
        (lambda: surfaces.vertex_surface(face=None), "^face: an integer is needed, not NoneType$"),
        (lambda: osh.SurfaceFactory(CUBE_POSITIONS),
         "^refiner: a TopologyRefiner is needed, not ndarray$"),
        (lambda: osh.StencilTable(refiner, max_level="1"),
         "^max_level: an integer or None is needed, not str$"),
        (lambda: osh.StencilTable(refiner, "varying"),
         "^StencilTable: at most 1 arguments without a name, not 2$"),
        (lambda: osh.Camera((0, 0, 5), field_of_view="wide"), "^field_of_view: a number is needed, not str$"),
        (lambda: osh.View(camera, flatness=None), "^flatness: a number is needed, not NoneType$"),
        (lambda: osh.create_triangle_indices(refiner.get_level(1), fvar_channels=["uv"]),
         "^fvar_channels: a list of int is needed, not list of str$"),
        (lambda: osh.CpuEvaluator.eval_stencils(osh.StencilTable(refiner), CUBE_POSITIONS, end="all"),
         "^end: an integer or None is needed, not str$"),
    ]
    for call, message in calls:
        with pytest.raises(TypeError, match=message) as caught:
            call()
        assert caught.value.__context__ is None
    with pytest.raises(TypeError, match="^refine_uniform: at most 3 arguments without a name, not 4$"):
        refiner.refine_uniform(3, True, None, 4)
    with pytest.raises(ValueError, match="^level: 4294967296 is a number that 32 bits do not hold$"):
        refiner.refine_uniform(2**32)
    with pytest.raises(ValueError, match="^fvar_channels: -4294967296 is a number that 32 bits"):
        osh.create_triangle_indices(refiner.get_level(1), fvar_channels=[0, -2**32])
    with pytest.raises(ValueError, match="^max_memory: -1 is below 0$"):
        osh.ViewBounds(surfaces, -1)
    with pytest.raises(ValueError, match="^max_memory: -2 is below 0$"):
        osh.PatchStream(surfaces, 1, max_memory=-2)
    with pytest.raises(TypeError, match="No constructor"):
        osh.Surface(refiner)


def test_objects_whose_constructor_raised_an_error_are_shown():
    classes = [value for value in vars(osh).values() if isinstance(value, type)
               and not hasattr(value, "__members__") and not issubclass(value, Exception)]
    assert len(classes) > 15
    for value in classes:
        if value not in (osh.CpuEvaluator, osh.ParallelEvaluator):  # which have no objects
            assert repr(value.__new__(value)) == f"<{value.__name__}, not initialized>"


@pytest.mark.parametrize("rest, error, message", [
    (np.zeros((7, 3), np.float32), ValueError, "rest_positions: 8 elements"),
    (np.zeros((8, 2), np.float32), ValueError, "rest_positions: x, y and z"),
    (np.zeros(8, np.float32), ValueError, "rest_positions: x, y and z"),
    (np.zeros((8, 3), bool), TypeError, "rest_positions: numbers"),
    (np.full((8, 3), np.nan), osh.StatusError, ""),
])
def test_rest_positions(rest, error, message):
    refiner = osh.TopologyRefiner(CUBE_FACES)
    with pytest.raises(error, match=message):
        refiner.refine_coplanar(rest, 1)


def test_rest_positions_of_any_type_and_layout():
    def refine(rest):
        refiner = osh.TopologyRefiner(CUBE_FACES)
        refiner.refine_coplanar(rest, 2)
        return refiner.get_level(2).face_vertices.copy()

    expected = refine(CUBE_POSITIONS)
    wide = np.zeros((8, 4), np.float32)
    wide[:, :3] = CUBE_POSITIONS
    for rest in (CUBE_POSITIONS.tolist(), CUBE_POSITIONS.astype(int), wide[:, :3],
                 wide.astype(np.float64)[:, :3], np.asfortranarray(CUBE_POSITIONS),
                 unaligned(CUBE_POSITIONS.astype(np.float64)), CUBE_POSITIONS.astype(">f8")):
        np.testing.assert_array_equal(refine(rest), expected)


def test_places_of_surfaces(refiner):
    factory = osh.SurfaceFactory(refiner)
    uv = np.full((3, 2), 0.5)
    bad = [
        (([0, 6, 1], uv), IndexError, "^faces: row 1 is 6, not one of the 6 faces$"),
        (([0, 1, -1], uv), IndexError, "^faces: row 2 is -1, not one of the 6 faces$"),
        (([0.0, 1.0, 2.0], uv), TypeError, "faces: integers are needed, not float64"),
        (([[0, 1, 2]], uv), ValueError, "faces: 1 dimension is needed"),
        (([0, 1, 2**31], uv), ValueError, "faces: number 2 is 2147483648, which int32 does"),
        ((None, uv), TypeError, "faces: an array is needed, not None"),
        (([0, 1], uv), ValueError, r"uv: 2 elements are needed, the shape is \(3, 2\)"),
        (([0, 1, 2], uv[:, :1]), ValueError,
         r"uv: u and v of each place are needed, the shape is \(3, 1\)"),
        (([0, 1, 2], [0.5] * 3), ValueError,
         r"uv: u and v of each place are needed, the shape is \(3,\)"),
        (([0, 1, 2], [[0, 0], [0, 0], [0, np.inf]]), ValueError, "uv: row 2 is not finite"),
        (([0, 1, 2], [[0, 0], [np.nan, 0], [0, 0]]), ValueError, "uv: row 1 is not finite"),
        (([0, 1, 2], [["a", "b"]] * 3), TypeError, "uv: numbers are needed"),
    ]
    for arguments, error, message in bad:
        with pytest.raises(error, match=message):
            osh.SurfacePlaces(factory, *arguments)
    for mode, channel, error, message in (
            ("sharp", 0, ValueError, "interpolation_mode: 'sharp' is none of 'vertex'"),
            (None, 0, TypeError, "interpolation_mode: one of 'vertex', .* is needed, not NoneType"),
            ("face_varying", 1, IndexError, "fvar_channel: 1 is not one of the 1"),
            ("face_varying", -1, IndexError, "fvar_channel: -1 is not one of the 1")):
        with pytest.raises(error, match=message):
            osh.SurfacePlaces(factory, [0, 1, 2], uv, interpolation_mode=mode,
                              fvar_channel=channel)
    with pytest.raises(TypeError):
        osh.SurfacePlaces(None, [0], uv[:1])
    holes = osh.SurfaceFactory(osh.TopologyRefiner(CUBE_FACES, holes=[4]))
    with pytest.raises(osh.StatusError, match="hole") as raised:
        osh.SurfacePlaces(holes, [0, 4, 1], uv)
    assert raised.value.component == osh.ComponentType.FACE and raised.value.index == 4

    places = osh.SurfacePlaces(factory, [5, 0, 5], uv)
    for points, error, message in (
            (CUBE_POSITIONS[1:], ValueError,
             r"points: 8 elements are needed, the shape is \(7, 3\)"),
            (np.zeros((8, 0)), ValueError, "points: elements of the shape"),
            (np.zeros((8, 3, 1)), ValueError, "points: one or two dimensions"),
            (np.zeros((8, 3), complex), TypeError, "points: numbers are needed, not complex128"),
            (None, TypeError, "points: an array is needed, not None")):
        for run in (places.evaluate, places.evaluate_with_derivatives):
            with pytest.raises(error, match=message):
                run(points)
