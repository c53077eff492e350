# SPDX-License-Identifier: Apache-2.0
"""Times the Python module against C++ and, where it runs inside Blender, against Blender's
subdivision: contestants take turns in one process.  Writes what `perf --measured` reads.
"""

import argparse
import ctypes
import json
import platform
import sys
import time

import numpy as np

try:
    import bpy
except ImportError:
    bpy = None

CONDITIONS = """\
Sizes: small is about 100,000 vertices at the last level. Python and C++ do the same work, and make the
same bits, in one process; memory: *default* is malloc as it is, each contestant runs twice and the
second time counts; *resident* means that results are written to memory that was touched before.

Frames are those of Blender, which all of it runs in: control points move, and Blender brings its
dependency graph up to date, with a subdivision modifier of level 4 and the rest of its settings as
they are, or with an object of the add-on that follows the mesh. The same control points evaluated
alone, by `RefinementEvaluator` into an array, are the other contestant; a hexagonal mesh of level 4
has about a third more vertices. Threads are those of all contestants, Blender too."""


class Contestant:
    """One way of doing the work; validate() gives the number of items that it made."""

    def __init__(self, name, work, validate, prepare=None, release=None):
        self.name, self.work, self.validate = name, work, validate
        self.prepare = prepare or (lambda: None)
        self.release = release or (lambda: None)

    def measure(self):
        self.prepare()
        start = time.perf_counter()
        self.work()
        seconds = time.perf_counter() - start
        self.release()
        return seconds


def run_contest(setting, contestants, pairings, options):
    """Turn by turn, as the contests of perf do."""
    results = []
    for contestant in contestants:
        contestant.prepare()
        contestant.work()
        results.append({"who": contestant.name, "threads": options.threads,
                        "items": contestant.validate(), "seconds": []})
        contestant.release()
    for _ in range(1 if options.quick else options.turns):
        for contestant, result in zip(contestants, results):
            if setting["memory"] == "default":
                contestant.measure()
            result["seconds"].append(contestant.measure())
    names = ", ".join(f"{r['who']} {1e3 * float(np.median(r['seconds'])):.3f} ms" for r in results)
    print(f"{setting['work']}/{setting['mesh']}/{setting['size']}: {names}", file=sys.stderr)
    return {**setting, "contestants": results,
            "pairings": [{"row": row, "own": own, "peer": peer} for row, own, peer in pairings]}


class Mesh:
    """A torus of num_u x num_v quads, each of them cut in two if asked."""

    def __init__(self, name, num_u, num_v, triangles):
        self.name = name
        u, v = (grid.ravel() for grid in np.mgrid[:num_u, :num_v])
        angle, other = 2 * np.pi * u / num_u, 2 * np.pi * v / num_v
        radius = 1 + 0.4 * np.cos(other)
        self.positions = np.stack([radius * np.cos(angle), radius * np.sin(angle),
                                   0.4 * np.sin(other)], axis=1).astype(np.float32)

        def vertex(du, dv):
            return (u + du) % num_u * num_v + (v + dv) % num_v

        faces = np.stack([vertex(0, 0), vertex(1, 0), vertex(1, 1), vertex(0, 1)], axis=1)
        if triangles:
            faces = faces[:, [0, 1, 2, 0, 2, 3]].reshape(-1, 3)
        self.faces = np.ascontiguousarray(faces, np.int32)


def load_native(path):
    library = ctypes.CDLL(path)
    library.nativeCreate.restype = ctypes.c_void_p
    for function in (library.nativeMakeEvaluator, library.nativeEvaluateTable,
                     library.nativeEvaluate):
        function.restype = ctypes.c_bool
    return library


def require(condition, what):
    if not condition:
        raise RuntimeError(what)


class NativePeer:
    """A refiner of C++, whose functions are those of nativePeer.cpp without the prefix."""

    def __init__(self, library, mesh):
        self.library = library
        sizes = np.full(len(mesh.faces), mesh.faces.shape[1], np.int32)
        self.peer = ctypes.c_void_p(library.nativeCreate(
            len(mesh.positions), len(sizes), sizes.ctypes, mesh.faces.ctypes))
        require(self.peer, "no base level")

    def call(self, name, *arguments):
        return getattr(self.library, "native" + name)(self.peer, *arguments)

    def destroy(self):
        self.call("Destroy")


def make_refinements(osh, library, mesh, level):
    """Refiners of both, made anew for each turn."""
    held = {}

    def prepare_python():
        held["python"] = osh.TopologyRefiner(mesh.faces)

    def refine_python():
        held["python"].refine_uniform(level)

    def count_python():
        return held["python"].get_level(level).num_vertices

    def prepare_native():
        held["native"] = NativePeer(library, mesh)

    def refine_native():
        held["count"] = held["native"].call("Refine", level)

    def count_native():
        require(held["count"] == count_expected, "C++ made other vertices")
        return held["count"]

    def release(name):
        peer = held.pop(name)
        if name == "native":
            peer.destroy()

    prepare_python()
    refine_python()
    count_expected = count_python()
    return [Contestant("Python", refine_python, count_python, prepare_python,
                       lambda: release("python")),
            Contestant("C++", refine_native, count_native, prepare_native,
                       lambda: release("native"))]


def make_python_contests(osh, library, mesh, level, options):
    """Refinement, tables and evaluation, from Python and in C++."""
    setting = {"mesh": mesh.name, "size": "small", "level": level}
    vertex = {**setting, "item": "vertex"}
    yield run_contest({**vertex, "work": "topology, face-vertices", "memory": "default"},
                      make_refinements(osh, library, mesh, level), [("python-refinement", 0, 1)],
                      options)

    refiner = osh.TopologyRefiner(mesh.faces)
    refiner.refine_uniform(level)
    native = NativePeer(library, mesh)
    count = native.call("Refine", level)
    require(count == refiner.get_level(level).num_vertices, "other vertices")
    tables = {}

    def make_table():
        tables["python"] = osh.StencilTable(refiner, generate_intermediate_levels=False)

    def make_native_table():
        tables["weights"] = native.call("MakeTable")

    def count_weights():
        require(tables["weights"] == tables["python"].weights.size, "other tables")
        return tables["weights"]

    make_table()
    make_native_table()
    yield run_contest({**setting, "item": "weight", "work": "table", "memory": "default"},
                      [Contestant("Python", make_table, count_weights,
                                  release=lambda: tables.pop("python")),
                       Contestant("C++", make_native_table,
                                  lambda: tables["weights"],
                                  release=lambda: native.call("ReleaseTable"))],
                      [("python-table", 0, 1)], options)

    make_table()
    make_native_table()
    evaluator = osh.RefinementEvaluator(refiner)
    require(native.call("MakeEvaluator"), "no evaluator")
    source = mesh.positions
    own, other = (np.empty((count, 3), np.float32) for _ in range(2))
    arguments = source.ctypes, other.ctypes

    def count_equal():
        require(np.array_equal(own, other), "values differ")
        return count

    ways = {
        "table-evaluation": (
            "evaluation of a table, length 3",
            lambda: osh.CpuEvaluator.eval_stencils(tables["python"], source, own),
            lambda: native.call("EvaluateTable", *arguments)),
        "evaluation": (
            "table-free, last level, length 3",
            lambda: evaluator.evaluate(source, dst=own),
            lambda: native.call("Evaluate", *arguments))}
    for row, (work, python_work, native_work) in ways.items():
        own[:] = other[:] = np.nan
        require(native_work(), "not evaluated")
        yield run_contest({**vertex, "work": work, "memory": "resident"},
                          [Contestant("Python", python_work, count_equal),
                           Contestant("C++", native_work, count_equal)],
                          [("python-" + row, 0, 1)], options)
    native.destroy()


class Scene:
    """A mesh in Blender whose control points move from frame to frame."""

    def __init__(self, mesh):
        bpy.ops.wm.read_factory_settings(use_empty=True)
        if mesh is None:
            bpy.ops.mesh.primitive_monkey_add()
            self.source = bpy.context.object
        else:
            data = bpy.data.meshes.new(mesh.name)
            data.from_pydata(mesh.positions.tolist(), [], mesh.faces.tolist())
            self.source = bpy.data.objects.new(mesh.name, data)
            bpy.context.collection.objects.link(self.source)
        bpy.context.view_layer.objects.active = self.source
        self.source.select_set(True)
        vertices = self.source.data.vertices
        self.rest = np.empty((len(vertices), 3), np.float32)
        vertices.foreach_get("co", self.rest.ravel())
        self.frame = 0
        self.update()

    def update(self):
        bpy.context.view_layer.update()

    def next_points(self):
        self.frame += 1
        return self.rest * np.float32(1 + 0.01 * (self.frame % 10))

    def move(self):
        self.source.data.vertices.foreach_set("co", self.next_points().ravel())
        self.source.data.update()

    def get_refined(self, target):
        """The vertices that Blender has of an object now, and their largest coordinate."""
        mesh = target.evaluated_get(bpy.context.evaluated_depsgraph_get()).data
        points = np.empty(3 * len(mesh.vertices), np.float32)
        mesh.vertices.foreach_get("co", points)
        return len(mesh.vertices), float(np.abs(points).max())

    def check_moved(self, target):
        """That a frame brings the object up to date, and what vertices it has."""
        count, before = self.get_refined(target)
        self.move()
        self.update()
        _, after = self.get_refined(target)
        require(after != before, f"'{target.name}' did not move")
        return count


def make_blender_contest(osh, addon, name, mesh, options):
    """The same control points through Blender's modifier, the add-on, and the module alone."""
    level = 1 if options.quick else 4
    addon.register()
    # Two scenes would be updated together: the contestants have the source in turns.
    scene = Scene(mesh)
    source = scene.source
    faces = [list(polygon.vertices) for polygon in source.data.polygons]
    refiner = osh.TopologyRefiner(faces, len(scene.rest), face_mask="smooth",
                                  vtx_boundary_interpolation="edge_only")
    refiner.refine_uniform(level)
    evaluator = osh.RefinementEvaluator(refiner)
    points = np.empty((evaluator.get_num_elements(level), 3), np.float32)
    control = {}

    def prepare_own():
        control["points"] = scene.next_points()

    modifier = source.modifiers.new("Subdivision", "SUBSURF")
    modifier.levels = modifier.render_levels = level
    scene.update()
    print(f"Blender's mesh of {name}: {scene.check_moved(source)} vertices, own: {len(points)}",
          file=sys.stderr)
    setting = {"mesh": name, "size": f"at level {level}", "level": level, "item": "frame",
               "memory": "resident"}

    def check_own():
        require(np.isfinite(points).all(), "not evaluated")
        return 1

    def check_blender():
        scene.check_moved(source)
        return 1

    points[:] = np.nan
    yield run_contest({**setting, "work": "frame, evaluation"},
                      [Contestant("RefinementEvaluator",
                                  lambda: evaluator.evaluate(control["points"], dst=points),
                                  check_own, prepare_own),
                       Contestant("Blender", scene.update, check_blender, scene.move)],
                      [("python-blender", 0, 1)], options)

    # The add-on's object follows the mesh as its modifiers leave it: there are none in its turns.
    modifier.show_viewport = False
    scene.update()
    bpy.ops.object.hex_subdivide(level=level)
    target = bpy.context.object
    require(target is not source, "no object was made")
    follower = target.opensubdivhex

    def prepare_addon():
        modifier.show_viewport = False
        follower.source = source
        scene.update()
        scene.move()

    def prepare_blender():
        follower.source = None
        modifier.show_viewport = True
        scene.update()
        scene.move()

    def check_addon():
        scene.check_moved(target)
        return 1

    yield run_contest({**setting, "work": "frame, an object"},
                      [Contestant("add-on", scene.update, check_addon, prepare_addon),
                       Contestant("Blender", scene.update, check_blender, prepare_blender)],
                      [("addon-blender", 0, 1)], options)
    addon.unregister()


def read_options():
    arguments = sys.argv[1:] if bpy is None else sys.argv[sys.argv.index("--") + 1:]
    parser = argparse.ArgumentParser(prog="pythonBenchmark.py", description=__doc__)
    parser.add_argument("--modules", required=True, help="folder of the module opensubdivhex")
    parser.add_argument("--addons", help="folder of the add-on")
    parser.add_argument("--native", required=True, help="the library nativePeer")
    parser.add_argument("--json", required=True, help="file that is written")
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--turns", type=int, default=21)
    parser.add_argument("--quick", action="store_true", help="tiny sizes, one turn")
    return parser.parse_args(arguments)


def main():
    options = read_options()
    sys.path[:0] = [options.modules, options.addons or options.modules]
    import opensubdivhex as osh

    library = load_native(options.native)
    osh.set_num_threads(options.threads)
    library.nativeSetNumThreads(options.threads)
    environment = {"Python": platform.python_version(), "numpy": np.__version__}
    quad, triangle = Mesh("quad", 48, 32, False), Mesh("triangle", 64, 40, True)
    contests = []
    for mesh, level in ((quad, 3), (triangle, 2)):
        contests += make_python_contests(osh, library, mesh, 1 if options.quick else level, options)
    if bpy is not None:
        import opensubdivhex_blender as addon

        environment["Blender"] = bpy.app.version_string
        for name, mesh in (("quad", quad), ("suzanne", None)):
            contests += make_blender_contest(osh, addon, name, mesh, options)
    with open(options.json, "w", encoding="utf-8") as file:
        json.dump({"environment": environment, "conditions": CONDITIONS, "contests": contests},
                  file, indent=1)


main()
