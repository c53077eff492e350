# SPDX-License-Identifier: Apache-2.0
"""Cameras, views and streams: watertight meshes in bounded memory, the same bits in any order."""

import threading

import numpy as np
import opensubdivhex as osh
import pytest
from meshes import CUBE_FACES, CUBE_POSITIONS, make_grid, make_torus


def make_factory(faces=CUBE_FACES, **options):
    return osh.SurfaceFactory(osh.TopologyRefiner(faces, face_mask="smooth", **options))


@pytest.fixture
def factory():
    return make_factory()


def weld(arrays):
    """Edges of the triangles of a result of PatchStream.evaluate, by points that are equal to the bit."""
    _, welded = np.unique(arrays["points"], axis=0, return_inverse=True)
    facets = welded.reshape(-1)[arrays["facets"]]
    edges = np.concatenate([facets[:, [0, 1]], facets[:, [1, 2]], facets[:, [2, 0]]])
    return welded.max() + 1, len(facets), edges


def check_closed(arrays):
    """Each edge has two facets, one in each direction, and V - E + F = 2."""
    num_points, num_facets, edges = weld(arrays)
    forward = set(map(tuple, edges))
    assert len(forward) == len(edges)
    assert forward == {(b, a) for a, b in forward}
    assert num_points - len(edges) // 2 + num_facets == 2


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_patches_are_the_surfaces_of_faces(factory, dtype):
    positions = CUBE_POSITIONS.astype(dtype)
    patches = []
    stream = osh.PatchStream(factory, 3, derivatives=True)
    assert stream.num_faces == 6
    assert stream.run(positions, patches.append) is True
    assert sorted(patch.face for patch in patches) == list(range(6))
    for patch in patches:
        tessellation = osh.LevelTessellation(4, 3)
        np.testing.assert_array_equal(patch.tessellation.coords, tessellation.coords)
        np.testing.assert_array_equal(patch.tessellation.facets, tessellation.facets)
        expected = factory.vertex_surface(patch.face).evaluate_with_derivatives(
            tessellation, CUBE_POSITIONS)
        for found, wanted in zip((patch.points, patch.du, patch.dv), expected):
            assert found.dtype == dtype
            np.testing.assert_allclose(found, wanted, atol=3e-6)
        assert patch.varying is None and patch.fvar_values == []


def test_arrays_are_those_of_patches_in_the_order_of_faces(factory):
    stream = osh.PatchStream(factory, 2)
    patches = {}
    stream.run(CUBE_POSITIONS, lambda patch: patches.update({patch.face: patch}))
    arrays = stream.evaluate(CUBE_POSITIONS)
    np.testing.assert_array_equal(arrays["faces"], range(6))
    for i in range(6):
        points = slice(*arrays["first_points"][i:i + 2])
        facets = slice(*arrays["first_facets"][i:i + 2])
        np.testing.assert_array_equal(arrays["points"][points], patches[i].points)
        np.testing.assert_array_equal(arrays["facets"][facets] - points.start,
                                      patches[i].tessellation.facets)
    assert arrays["du"] is None and arrays["dv"] is None and arrays["facet_sizes"] is None
    check_closed(arrays)


def test_ranges_and_threads_make_the_same_bits(factory):
    stream = osh.PatchStream(factory, 4)
    whole = stream.evaluate(CUBE_POSITIONS)
    parts = [stream.evaluate(CUBE_POSITIONS, begin_face=i, end_face=i + 2) for i in (0, 2, 4)]
    assert b"".join(part["points"].tobytes() for part in parts) == whole["points"].tobytes()
    for threads in (1, 2, 3):
        with osh.ExecutorScope(num_threads=threads):
            again = stream.evaluate(CUBE_POSITIONS)
        assert again["points"].tobytes() == whole["points"].tobytes()
        assert again["facets"].tobytes() == whole["facets"].tobytes()
    listed = stream.evaluate(CUBE_POSITIONS, faces=[5, 1])
    assert listed["faces"].tolist() == [1, 5]
    points = slice(*whole["first_points"][1:3])
    assert listed["points"][:points.stop - points.start].tobytes() == whole["points"][points].tobytes()
    assert len(stream.evaluate(CUBE_POSITIONS, faces=[])["faces"]) == 0
    empty = stream.evaluate(CUBE_POSITIONS, begin_face=3, end_face=3)
    assert empty["points"].shape == (0, 3) and empty["facets"].shape == (0, 3)
    assert empty["first_points"].tolist() == [0]


def test_large_faces_come_in_sections(factory):
    whole, cut = (osh.PatchStream(factory, 7, max_memory=memory).evaluate(CUBE_POSITIONS, end_face=1)
                  for memory in (1 << 30, 1))
    assert len(whole["faces"]) == 1 and len(cut["faces"]) > 1 == len(set(cut["faces"]))
    triangles = [np.unique(arrays["points"][arrays["facets"]].reshape(-1, 9), axis=0)
                 for arrays in (whole, cut)]
    assert len(triangles[0]) == len(whole["facets"]) == len(cut["facets"])
    np.testing.assert_array_equal(*triangles)


def test_levels_of_faces_and_edges_fit(factory):
    faces = [0, 1, 2, 3, 4, 0]
    edges = np.arange(12) % 5
    arrays = osh.PatchStream(factory, (faces, edges)).evaluate(CUBE_POSITIONS)
    check_closed(arrays)
    coarse, fine = (np.diff(arrays["first_points"])[face] for face in (0, 4))
    assert fine > coarse


def test_facets_of_all_sizes(factory):
    quads = osh.PatchStream(factory, 2, facet_size=4).evaluate(CUBE_POSITIONS)
    assert quads["facets"].shape[1] == 4 and quads["facet_sizes"] is None
    assert quads["facets"].min() >= -1
    polygons = osh.PatchStream(factory, 2, facet_size=0).evaluate(CUBE_POSITIONS)
    assert polygons["facet_sizes"].sum() == len(polygons["facets"])
    assert len(polygons["facet_sizes"]) == polygons["first_facets"][-1]
    triangles = osh.PatchStream(factory, 2).evaluate(CUBE_POSITIONS)
    assert (polygons["facet_sizes"] - 2).sum() == len(triangles["facets"])


def test_varying_and_face_varying_values_come_along():
    corners = np.arange(24)
    factory = make_factory(fvar_channels=[corners, corners % 8])
    uvs = np.tile([[0, 0], [1, 0], [1, 1], [0, 1]], (6, 1))
    other = np.arange(8, dtype=float)
    arrays = osh.PatchStream(factory, 3, derivatives=True).evaluate(
        CUBE_POSITIONS, varying=CUBE_POSITIONS[:, :1], fvar_values=[uvs, other])
    assert [values.shape[1] for values in arrays["fvar_values"]] == [2, 1]
    tessellation = osh.LevelTessellation(4, 3)
    for i in range(6):
        points = slice(*arrays["first_points"][i:i + 2])
        for found, surface, values in [
                (arrays["varying"], factory.varying_surface(i), CUBE_POSITIONS[:, :1]),
                (arrays["fvar_values"][0], factory.face_varying_surface(i, 0), uvs),
                (arrays["fvar_values"][1], factory.face_varying_surface(i, 1), other[:, None])]:
            np.testing.assert_allclose(found[points], surface.evaluate(tessellation, values),
                                       atol=1e-6)
    normals = osh.compute_normals(arrays["du"], arrays["dv"])
    assert (np.einsum("ij,ij->i", normals, arrays["points"]) > 0).all()
    patches = []
    osh.PatchStream(factory, 1).run(CUBE_POSITIONS, patches.append, fvar_values=[uvs])
    assert [values.shape for values in patches[0].fvar_values] == [(len(patches[0].points), 2)]


def test_holes_have_no_patch():
    stream = osh.PatchStream(make_factory(holes=[2]), 2)
    assert stream.evaluate(CUBE_POSITIONS)["faces"].tolist() == [0, 1, 3, 4, 5]


def test_sinks_end_streams_and_raise(factory):
    stream = osh.PatchStream(factory, 2)
    seen = []

    def end(patch):
        seen.append(patch.face)
        return False

    assert stream.run(CUBE_POSITIONS, end) is False
    assert 1 <= len(seen) <= 6

    def fail(patch):
        raise KeyError(patch.face)

    with pytest.raises(KeyError):
        stream.run(CUBE_POSITIONS, fail)
    with pytest.raises(TypeError, match="sink: it returns None, True or False, not int"):
        stream.run(CUBE_POSITIONS, lambda patch: 1)
    assert stream.run(CUBE_POSITIONS, lambda patch: True) is True


def test_sinks_may_use_the_library_but_not_refine():
    refiner = osh.TopologyRefiner(CUBE_FACES, face_mask="smooth")
    factory = osh.SurfaceFactory(refiner)
    stream = osh.PatchStream(factory, 2)
    found = []

    def use(patch):
        found.append(factory.vertex_surface(patch.face).face_size)
        with pytest.raises(BufferError, match="or a stream reads them"):
            refiner.refine_uniform(1)

    done = []
    thread = threading.Thread(
        target=lambda: done.append(stream.run(CUBE_POSITIONS, use)), daemon=True)
    thread.start()
    thread.join(60)
    assert done == [True] and found == [4] * 6
    refiner.refine_uniform(1)
    assert stream.run(CUBE_POSITIONS, found.append) is True


def test_kept_patches_stay(factory):
    patches = []
    stream = osh.PatchStream(factory, 3)
    stream.run(CUBE_POSITIONS, patches.append)
    before = {patch.face: patch.points.copy() for patch in patches}
    stream.run(CUBE_POSITIONS * 5, lambda patch: None)
    del stream, factory
    for patch in patches:
        np.testing.assert_array_equal(patch.points, before[patch.face])
        assert patch.tessellation.facets.max() == len(patch.points) - 1


def test_arguments_of_streams_are_named(factory):
    stream = osh.PatchStream(factory, 1)
    for error, message, arguments in [
            (ValueError, "levels: 13 is not one of 0 ... 12", dict(levels=13)),
            (ValueError, "levels: -1 is not one of 0 ... 12", dict(levels=-1)),
            (TypeError, "levels: an int, a pair .* is needed, not float", dict(levels=1.5)),
            (ValueError, r"levels\[0\]: 6 levels are needed, not 5", dict(levels=([0] * 5, [0] * 12))),
            (ValueError, r"levels\[1\]: number 3 is 99, not one of 0 ... 12",
             dict(levels=([0] * 6, [0] * 3 + [99] * 9))),
            (ValueError, "facet_size: 5 is not 3, 4 or 0", dict(levels=1, facet_size=5))]:
        with pytest.raises(error, match=message):
            osh.PatchStream(factory, **arguments)
    for error, message, arguments in [
            (ValueError, "points: 8 elements are needed", dict(points=CUBE_POSITIONS[:7])),
            (ValueError, "varying: 8 elements are needed", dict(varying=[1, 2])),
            (ValueError, "fvar_values: 1 arrays, but the mesh has 0 channels",
             dict(fvar_values=[[1, 2]])),
            (TypeError, "fvar_values: a list of arrays is needed", dict(fvar_values=3)),
            (IndexError, "begin_face, end_face: 4 ... 3 is no range of the 6 faces",
             dict(begin_face=4, end_face=3)),
            (IndexError, "begin_face, end_face: 0 ... 7 is no range", dict(end_face=7)),
            (ValueError, "faces: no begin_face and end_face", dict(faces=[1], begin_face=1)),
            (osh.StatusError, "face 6 is none of the 6 of the mesh", dict(faces=[1, 6]))]:
        with pytest.raises(error, match=message):
            stream.evaluate(**{"points": CUBE_POSITIONS, **arguments})
    with pytest.raises(TypeError, match="sink: a function of a patch is needed, not int"):
        stream.run(CUBE_POSITIONS, 3)
    positions, faces = make_grid(2, 2)
    with pytest.raises(osh.StatusError, match="face 0"):
        osh.PatchStream(make_factory(faces), 1).evaluate(positions)


def test_streams_behind_a_first_step():
    refiner = osh.TopologyRefiner(CUBE_FACES, face_mask="smooth", first_step="truncate")
    refiner.refine_uniform(1, full_topology_in_last_level=True)
    points = osh.RefinementEvaluator(refiner).evaluate(CUBE_POSITIONS)
    factory = osh.SurfaceFactory(refiner)
    stream = osh.PatchStream(factory, 2)
    check_closed(stream.evaluate(points))
    forest = osh.View(osh.Camera((0, 0, 5))).make_forest(factory, points)
    assert forest.num_faces == factory.num_faces
    refiner.refine_uniform(2)
    for use in (lambda: stream.evaluate(points), lambda: forest.tessellation(0),
                lambda: osh.View(osh.Camera((0, 0, 5))).make_forest(factory, points)):
        with pytest.raises(RuntimeError, match="refined again"):
            use()


def test_views_refine_what_is_near():
    positions, faces = make_torus(12, 8)
    factory = make_factory(faces)
    near = osh.View(osh.Camera((5, 0, 1)), flatness=0.5).make_forest(factory, positions)
    far = osh.View(osh.Camera((50, 0, 10)), flatness=0.5).make_forest(factory, positions)
    coarse = osh.View(osh.Camera((5, 0, 1)), flatness=8).make_forest(factory, positions)
    assert near.find_changed_faces(near).tolist() == []
    changed = near.find_changed_faces(coarse).tolist()
    assert changed and changed == sorted(set(changed))
    with pytest.raises(TypeError):
        near.find_changed_faces(None)
    assert near.num_cells > far.num_cells and near.num_cells > coarse.num_cells
    assert near.num_cells == sum(near.cells_by_level) > near.num_faces == len(faces)
    culled = osh.View(osh.Camera((5, 0, 1)), culling=True).make_forest(factory, positions)
    assert culled.num_outside + culled.num_back_facing > 0 == near.num_outside
    assert culled.num_cells < near.num_cells

    arrays = osh.PatchStream(factory, near).evaluate(positions)
    num_points, num_facets, edges = weld(arrays)
    assert num_points - len(edges) // 2 + num_facets == 0  # a torus
    assert np.bincount(edges[:, 0]).min() > 0
    assert len(set(map(tuple, edges))) == len(edges)


def test_forests_number_the_points_that_faces_share(factory):
    forest = osh.View(osh.Camera((3, 2, 4)), flatness=1).make_forest(factory, CUBE_POSITIONS)
    at = {}
    for face in range(6):
        tessellation = forest.tessellation(face)
        assert tessellation.levels == [] and tessellation.facet_size == 3
        points = factory.vertex_surface(face).evaluate(tessellation, CUBE_POSITIONS)
        numbers = forest.boundary_points(face)
        assert len(numbers) == tessellation.num_boundary_coords
        for number, point in zip(numbers, points):
            assert at.setdefault(number, tuple(point)) == tuple(point)
    assert sorted(at) == list(range(forest.num_boundary_points))
    with pytest.raises(IndexError, match="face: 6 is not one of the 6"):
        forest.tessellation(6)


def test_bounds_and_the_last_forest_change_no_more_than_they_should(factory):
    bounds = osh.ViewBounds(factory)
    view = osh.View(osh.Camera((0, 1, 4)))
    forests = [view.make_forest(mesh, CUBE_POSITIONS) for mesh in (factory, bounds, bounds)]
    assert len({tuple(forest.cells_by_level) for forest in forests}) == 1
    assert bounds.memory > 0
    bounds.clear()
    assert bounds.memory == 0
    away = osh.View(osh.Camera((0, 1.2, 4.8)))
    alone, after = (away.make_forest(factory, CUBE_POSITIONS, before) for before in (None, forests[0]))
    assert alone.num_cells <= after.num_cells <= forests[0].num_cells
    strict = osh.View(osh.Camera((0, 1.2, 4.8)), hysteresis=1)
    assert strict.make_forest(factory, CUBE_POSITIONS, forests[0]).num_cells == alone.num_cells


def test_arguments_of_cameras_and_views_are_named(factory):
    camera = osh.Camera((0, 0, 5))
    for message, arguments in [
            ("eye: x, y and z are needed", dict(eye=(0, 0))),
            ("up: nan is not finite", dict(up=(0, 0, float("nan")))),
            ("field_of_view: 180.0 is not between 0 and 180 degrees", dict(field_of_view=180)),
            ("width: 0 is less than 1", dict(width=0))]:
        with pytest.raises(ValueError, match=message):
            osh.Camera(**{"eye": (0, 0, 5), **arguments})
    for message, arguments in [
            ("flatness: -1.0 is not a number of pixels", dict(flatness=-1)),
            ("edge_length: inf is not a number of pixels", dict(edge_length=float("inf"))),
            ("flatness, edge_length: one of them must be above 0", dict(flatness=0)),
            ("max_level: 13 is not one of 0 ... 12", dict(max_level=13)),
            ("hysteresis: 2.0 is not one of 0 ... 1", dict(hysteresis=2)),
            ("camera: eye and target are equal", dict(camera=osh.Camera((0, 0, 0))))]:
        with pytest.raises(ValueError, match=message):
            osh.View(**{"camera": camera, **arguments})
    view = osh.View(camera)
    with pytest.raises(TypeError, match="factory: a SurfaceFactory or ViewBounds is needed, not int"):
        view.make_forest(3, CUBE_POSITIONS)
    with pytest.raises(ValueError, match="points: x, y and z of each are needed"):
        view.make_forest(factory, CUBE_POSITIONS[:, :2])
    with pytest.raises(osh.StatusError, match="forest"):
        other = osh.SurfaceFactory(osh.TopologyRefiner(CUBE_FACES))
        osh.PatchStream(factory, view.make_forest(other, CUBE_POSITIONS)).evaluate(CUBE_POSITIONS)
