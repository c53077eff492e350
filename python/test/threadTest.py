# SPDX-License-Identifier: Apache-2.0
"""The interpreter's lock is released while the library works, and threads share what they may."""

import copy
import threading
import time

import numpy as np
import opensubdivhex as osh
import pytest
from meshes import CUBE_FACES, CUBE_POSITIONS, make_torus


def find_longest_pause(work):
    """The longest time for which another thread stands still while work() runs, as a part of it."""
    stop, ready, pauses = threading.Event(), threading.Event(), [0]

    def watch():
        last = time.perf_counter()
        ready.set()
        while not stop.is_set():
            now = time.perf_counter()
            pauses[0] = max(pauses[0], now - last)
            last = now

    watcher = threading.Thread(target=watch)
    watcher.start()
    ready.wait()
    pauses[0] = 0
    begin = time.perf_counter()
    work()
    seconds = time.perf_counter() - begin
    stop.set()
    watcher.join()
    return pauses[0] / seconds


def test_other_threads_run_while_the_library_works():
    # With the lock held, the other thread would stand still for all of each call.
    positions, faces = make_torus(60, 40)
    refiner = osh.TopologyRefiner(faces)
    osh.set_num_threads(1)
    try:
        refiner.refine_uniform(5)
        table, values = osh.StencilTable(refiner, max_level=4), []
        values.append(osh.CpuEvaluator.eval_stencils(table, positions))
        surfaces = osh.SurfaceFactory(osh.TopologyRefiner(faces, face_mask="smooth"))
        stream, view = osh.PatchStream(surfaces, 6), osh.View(osh.Camera((5, 0, 1)), flatness=0.1)
        works = [lambda: refiner.refine_uniform(5),
                 lambda: stream.run(positions, lambda patch: None),
                 lambda: view.make_forest(surfaces, positions),
                 lambda: copy.copy(refiner),
                 lambda: osh.StencilTable(refiner, max_level=4),
                 lambda: osh.CpuEvaluator.eval_stencils(table, positions, values[0]),
                 lambda: refiner.get_level(5).get_face_kinds()]
        for i, work in enumerate(works):
            # A busy machine may stop the other thread, but not each time.
            pauses = []
            while not pauses or pauses[-1] > 0.5 and len(pauses) < 10:
                pauses.append(find_longest_pause(work))
            assert pauses[-1] <= 0.5, (i, pauses)
    finally:
        osh.set_num_threads(0)


def test_numbers_of_threads_are_those_of_the_thread():
    osh.set_num_threads(1)
    found = []
    thread = threading.Thread(target=lambda: found.append(osh.get_num_threads()))
    thread.start()
    thread.join()
    assert osh.get_num_threads() == 1
    with pytest.raises(ValueError, match="num_threads: -3 is negative"):
        osh.set_num_threads(-3)
    assert osh.get_num_threads() == 1
    osh.set_num_threads(0)
    assert osh.get_num_threads() == found[0]


def test_threads_share_a_refiner_and_an_evaluator():
    refiner = osh.TopologyRefiner(CUBE_FACES)
    refiner.refine_uniform(4)
    evaluator = osh.RefinementEvaluator(refiner)
    expected = {level: evaluator.evaluate(CUBE_POSITIONS, level) for level in (1, 2, 3, 4)}
    table = osh.StencilTable(refiner)
    weights, failures = table.weights.copy(), []

    def work(seed):
        try:
            for turn in range(40):
                level = (seed + turn) % 4 + 1
                values = evaluator.evaluate(CUBE_POSITIONS, level)
                np.testing.assert_array_equal(values, expected[level])
                if turn % 10 == seed:
                    np.testing.assert_array_equal(osh.StencilTable(refiner).weights, weights)
        except BaseException as failure:
            failures.append(failure)

    threads = [threading.Thread(target=work, args=(seed,)) for seed in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert not failures


def test_levels_that_vanish_are_not_taken():
    # A depth is looked up in the refinement that the level then shows: once that is gone, no level does.
    refiner = osh.TopologyRefiner(CUBE_FACES)
    failures, taken, is_over = [], [], False

    def take():
        while not is_over:
            try:
                taken.append(refiner.get_level(3))
            except IndexError:
                pass
            except BaseException as failure:
                failures.append(failure)
                return

    threads = [threading.Thread(target=take) for _ in range(3)]
    for thread in threads:
        thread.start()
    num_taken, end = 0, time.monotonic() + 2
    try:
        while time.monotonic() < end or not num_taken:
            refiner.refine_uniform(3)
            time.sleep(0.0002)
            refiner.unrefine()
            time.sleep(0.001)  # calls that were under way end
            levels = taken[:]
            taken.clear()
            num_taken += len(levels)
            for level in levels:
                with pytest.raises(RuntimeError, match="refined"):
                    level.num_vertices
    finally:
        is_over = True
        for thread in threads:
            thread.join()
    assert not failures and num_taken


def test_refining_while_others_look():
    # Whatever the order, a level or its arrays are whole, or an error says that they are not.
    refiner = osh.TopologyRefiner(CUBE_FACES)
    counts = {}
    for depth in range(4):
        refiner.refine_uniform(depth, full_topology_in_last_level=True)
        counts[depth] = refiner.get_level(depth).num_face_vertices
    stop, failures, seen = threading.Event(), [], [0, 0]

    def look():
        try:
            while not stop.is_set():
                try:
                    level = refiner.get_level(1)
                    vertices = level.face_vertices
                    assert len(vertices) == counts[1] and vertices.max() == 31
                    del vertices
                    seen[0] += 1
                    time.sleep(0.0005)
                except (RuntimeError, IndexError):
                    seen[1] += 1
        except BaseException as failure:
            failures.append(failure)

    threads = [threading.Thread(target=look) for _ in range(2)]
    for thread in threads:
        thread.start()
    refined, end = 0, time.monotonic() + 1
    while time.monotonic() < end or not refined:
        try:
            refiner.refine_uniform(refined % 4, full_topology_in_last_level=True)
            refined += 1
        except BufferError:
            pass
    stop.set()
    for thread in threads:
        thread.join()
    assert not failures and seen[0] and refined


def test_executors_make_the_same_bits():
    positions, faces = make_torus(40, 30)
    assert osh.get_executor() == osh.ExecutorType.DEFAULT
    assert osh.ExecutorType.DEFAULT in osh.get_executors()
    results = []
    for executor in osh.get_executors():
        for num_threads in (1, 3):
            with osh.ExecutorScope(executor, num_threads):
                assert osh.get_executor() == executor and osh.get_num_threads() == num_threads
                refiner = osh.TopologyRefiner(faces)
                refiner.refine_uniform(3)
                table = osh.StencilTable(refiner, max_level=2)
                results.append((refiner.get_level(3).face_vertices.tobytes(),
                                table.weights.tobytes(),
                                osh.ParallelEvaluator.eval_stencils(table, positions).tobytes(),
                                osh.RefinementEvaluator(refiner).evaluate(positions).tobytes()))
    assert len(results) > 1 and all(result == results[0] for result in results)
    assert osh.get_executor() == osh.ExecutorType.DEFAULT


def test_scopes_are_of_their_thread_and_nested():
    before = osh.get_num_threads()
    with osh.ExecutorScope(num_threads=3) as outer:
        assert osh.get_num_threads() == 3
        found = []
        thread = threading.Thread(target=lambda: found.append(osh.get_num_threads()))
        thread.start()
        thread.join()
        assert found == [before]
        with osh.ExecutorScope("default", 2):
            assert osh.get_num_threads() == 2
            with pytest.raises(RuntimeError, match="the last first"):
                outer.__exit__(None, None, None)
            with pytest.raises(RuntimeError, match="already"):
                outer.__enter__()
            assert osh.get_num_threads() == 2
        assert osh.get_num_threads() == 3
    assert osh.get_num_threads() == before
    with outer:  # once more
        assert osh.get_num_threads() == 3
    with pytest.raises(ZeroDivisionError):
        with outer:
            1 / 0
    assert osh.get_num_threads() == before
    with pytest.raises(ValueError, match="negative"):
        osh.ExecutorScope(num_threads=-1)


def test_scopes_of_dropped_generators_end():
    before = osh.get_num_threads()

    def wait():
        with osh.ExecutorScope(num_threads=3):
            yield

    generator = wait()
    next(generator)
    assert osh.get_num_threads() == 3
    del generator
    assert osh.get_num_threads() == before
    scope = osh.ExecutorScope(num_threads=3)
    scope.__enter__()
    del scope
    assert osh.get_num_threads() == before


def test_the_executor_of_all_threads_is_set():
    found = []
    for executor in osh.get_executors():
        osh.set_executor(executor)
        try:
            thread = threading.Thread(target=lambda: found.append(osh.get_executor()))
            thread.start()
            thread.join()
        finally:
            osh.set_executor("default")
    assert found == osh.get_executors()
    with pytest.raises(ValueError, match="'default', 'omp', 'tbb'"):
        osh.set_executor("cuda")
    for executor in set(osh.ExecutorType.__members__.values()) - set(osh.get_executors()):
        with pytest.raises(ValueError, match="without"):
            osh.set_executor(executor)
