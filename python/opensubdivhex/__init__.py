# SPDX-License-Identifier: Apache-2.0
"""Hexagonal vertex-to-vertex subdivision: the libraries of OpenSubdivHex for Python.

A TopologyRefiner takes a base mesh as arrays and refines it; its levels are arrays.  Values, such
as positions, are refined with a RefinementEvaluator, with a StencilTable and one of the evaluators
CpuEvaluator and ParallelEvaluator, or level by level with a PrimvarRefiner.  A LimitStencilTable has
points and tangents of the limit surface, a PatchTable patches close to it for any place, a
SurfaceFactory the surfaces of the base faces, and SurfacePlaces any number of places on these.  A
View refines faces as far as a Camera sees, and a PatchStream evaluates all faces in bounded memory.

Refiners, cameras, views, tessellations of levels and all options can be copied and pickled.

Names are those of the C++ API, in Python's spelling.  Values are float32 arrays.  What a
function reads may have any type of number and any layout, and may be a list: float32 (or float64,
where a function takes that) with the numbers of an element side by side is read in place, all else
is converted in a copy.  float64 is rounded to float32; an integer that float32 does not hold, or a
number beyond its range, raises ValueError.  An array to write to must have exactly the type, be
writable and aligned, and have the numbers of an element side by side.

Wrong types, shapes and lengths raise TypeError, ValueError or IndexError, which name the argument.
What the library refuses raises StatusError.  The interpreter's lock is released while the library works.
"""

try:
    from . import _opensubdivhex
    from ._arguments import name_wrong_arguments as _name_wrong_arguments

    # So help() lists them, under the names by which programs know them.
    __all__ = [name for name in dir(_opensubdivhex) if not name.startswith("_")]
    _name_wrong_arguments(_opensubdivhex, __all__)
    from ._opensubdivhex import *
    from ._opensubdivhex import __version__
except ImportError as error:
    import pathlib
    import sys

    built = [path.name for path in pathlib.Path(__file__).parent.glob("_opensubdivhex.*")]
    if built and getattr(error, "name", None) == "opensubdivhex._opensubdivhex":
        raise ImportError(
            f"{built[0]} is not for this Python, {sys.executable} {sys.version.split()[0]}: "
            "configure with -D Python_EXECUTABLE=... to build it for this one"
        ) from error
    raise


def _reduce(self, protocol):
    """As object's, by protocol 2 at least: pybind11 ends the process in older ones."""
    return object.__reduce_ex__(self, max(protocol, 2))


for _value in map(globals().get, __all__):
    if isinstance(_value, type):
        _value.__module__ = __name__
        if not issubclass(_value, BaseException):
            _value.__reduce_ex__ = _reduce
del _value


def _show(cls, *names):
    """Has the objects of a class represented by some of their properties."""
    def represent(self):
        if not _opensubdivhex._is_initialized(self):
            return f"<{type(self).__name__}, not initialized>"  # whose properties must not be read
        try:
            values = [f"{name}={getattr(self, name)!r}" for name in names]
        except RuntimeError as error:  # a level that is out of date
            values = [str(error)]
        return f"<{' '.join([type(self).__name__, ', '.join(values)]).strip()}>"
    cls.__repr__ = represent


_show(TopologyRefiner, "scheme_type", "face_mask", "first_step", "max_level", "num_faces_total")
_show(TopologyLevel, "depth", "num_vertices", "num_faces", "has_full_topology")
_show(LimitSides, "num_vertices", "num_sides")
_show(StencilTable, "num_stencils", "num_control_vertices")
_show(CompactStencilTable, "num_stencils", "num_control_vertices", "num_bytes")
_show(PatchTable, "num_patches", "num_control_vertices", "num_fvar_channels")
_show(RefinementEvaluator, "max_level", "num_elements_all_levels")
_show(PrimvarRefiner)
_show(LevelTessellation, "face_size", "levels")
_show(SurfaceFactory, "num_faces")
_show(Surface, "face_size")
_show(SurfacePlaces, "num_places")
_show(Camera, "eye", "target", "up", "field_of_view", "width", "height")
_show(View, "camera", "flatness", "edge_length", "max_level", "culling", "hysteresis")
_show(ViewBounds, "memory")
_show(CellForest, "num_faces", "num_cells")
_show(Patch, "face", "tessellation")
_show(PatchStream, "num_faces")
_show(ExecutorScope)
