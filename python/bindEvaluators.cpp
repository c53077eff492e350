// SPDX-License-Identifier: Apache-2.0
//
// Evaluation of tables, and without one, from arrays into arrays.
#include "arrays.h"
#include "options.h"
#include "refiner.h"
#include "stencilTable.h"

#include "osd_ext/cpuEvaluator.h"
#include "osd_ext/refinementEvaluator.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>

namespace OpenSubdivHex::Python {

namespace {

using namespace FarExt;
using Table = Far::StencilTableReal<float>;
using OsdExt::CompactStencilTable;
using OsdExt::RefinementEvaluator;

Table const &takeTable(StencilTable const &stencils) {
    auto const *const table = std::get_if<StencilTable::Pointer<float>>(&stencils.table);
    if (!table) {
        throw py::type_error("table: evaluators take float32; multiply by to_scipy() for float64");
    }
    return **table;
}

struct Range {
    int start, end;
};

Range takeRange(int start, std::optional<int> end, Table const &table, bool hasDestination) {
    int const numStencils = table.GetNumStencils();
    Range const range = {start, end.value_or(numStencils)};
    if (range.start < 0 || range.start > range.end || range.end > numStencils) {
        throw py::index_error("start, end: " + std::to_string(range.start) + " ... " +
                              std::to_string(range.end) + " is no range of the " +
                              std::to_string(numStencils) + " stencils");
    }
    if (!hasDestination && (range.start != 0 || range.end != numStencils)) {
        throw py::value_error("dst: a range needs an array to write to");
    }
    return range;
}

/// The control values; of a table whose levels refer to different vertices, those that the range
/// refers to.
Elements<float const> takeControlValues(StencilTable const &stencils, Table const &table,
                                        Range const &range, py::object const &src) {
    if (stencils.isMatrix) {
        return TakeSource<float>(src, "src", stencils.numSources);
    }
    int const *const indices = table.GetControlIndices().data();
    int numSources = 0;
    for (int i = range.start; i < range.end; ++i) {
        int const *const first = indices + table.GetOffsets()[std::size_t(i)];
        int const *const last = first + table.GetSizes()[std::size_t(i)];
        numSources = std::max(numSources, first == last ? 0 : *std::max_element(first, last) + 1);
    }
    Elements<float const> source = TakeSource<float>(src, "src", -1);
    if (source.count < numSources) {
        throw py::value_error("src: " + std::to_string(numSources) +
                              " elements at least are needed, the shape is " +
                              DescribeShape(source.array));
    }
    return source;
}

/// The evaluators return false for what was checked here before.
void checkEvaluated(bool isEvaluated) {
    if (!isEvaluated) {
        throw std::runtime_error("the evaluator refused its arguments");
    }
}

template <class EVALUATOR>
py::array evalStencils(StencilTable const &stencils, py::object const &src, py::object const &dst,
                       int start, std::optional<int> end) {
    Table const &table = takeTable(stencils);
    Range const range = takeRange(start, end, table, !dst.is_none());
    auto const source = takeControlValues(stencils, table, range, src);
    auto const destination = TakeDestination<float>(dst, "dst", table.GetNumStencils(), source);
    CheckApart(source, destination, "dst", range.start, range.end);
    {
        py::gil_scoped_release const release;
        checkEvaluated(EVALUATOR::EvalStencils(
            source.data, source.desc, destination.data, destination.desc, table.GetSizes().data(),
            table.GetOffsets().data(), table.GetControlIndices().data(), table.GetWeights().data(),
            range.start, range.end));
    }
    return destination.array;
}

template <class EVALUATOR>
py::tuple evalDerivatives(LimitStencilTable const &stencils, py::object const &src,
                          py::object const &dst, py::object const &du, py::object const &dv,
                          int start, std::optional<int> end) {
    auto const &table = static_cast<Far::LimitStencilTableReal<float> const &>(takeTable(stencils));
    if (!stencils.hasDerivatives) {
        throw py::value_error("table: it was made without derivatives");
    }
    bool const hasDestination = !dst.is_none() && !du.is_none() && !dv.is_none();
    Range const range = takeRange(start, end, table, hasDestination);
    auto const source = takeControlValues(stencils, table, range, src);
    int const count = table.GetNumStencils();
    auto const points = TakeDestination<float>(dst, "dst", count, source);
    auto const duValues = TakeDestination<float>(du, "du", count, source);
    auto const dvValues = TakeDestination<float>(dv, "dv", count, source);
    CheckApart(source, points, "dst", range.start, range.end);
    CheckApart(source, duValues, "du", range.start, range.end);
    CheckApart(source, dvValues, "dv", range.start, range.end);
    {
        py::gil_scoped_release const release;
        checkEvaluated(EVALUATOR::EvalStencils(
            source.data, source.desc, points.data, points.desc, duValues.data, duValues.desc,
            dvValues.data, dvValues.desc, table.GetSizes().data(), table.GetOffsets().data(),
            table.GetControlIndices().data(), table.GetWeights().data(),
            table.GetDuWeights().data(), table.GetDvWeights().data(), range.start, range.end));
    }
    return py::make_tuple(points.array, duValues.array, dvValues.array);
}

/// A buffer as the evaluators of tables in blocks ask for.
struct FloatBuffer {
    float *BindCpuBuffer() const { return data; }
    float *data;
};

template <class EVALUATOR>
py::array evalCompact(CompactStencilTable const &table, py::object const &src,
                      py::object const &dst) {
    auto const source = TakeSource<float>(src, "src", table.GetNumControlVertices());
    auto const destination = TakeDestination<float>(dst, "dst", table.GetNumStencils(), source);
    CheckApart(source, destination, "dst", 0, destination.count);
    FloatBuffer const from = {const_cast<float *>(source.data)}; // evaluators only read it
    FloatBuffer const to = {destination.data};
    {
        py::gil_scoped_release const release;
        checkEvaluated(EVALUATOR::EvalStencils(&from, source.desc, &to, destination.desc, &table));
    }
    return destination.array;
}

/// \brief A RefinementEvaluator that waits for other threads which use it.
class Evaluator {
    template <typename FUNCTION>
    auto read(FUNCTION const &function) const {
        return _refiner->Read([&](TopologyRefiner const &topology) {
            std::lock_guard const lock(_mutex);
            if (topology.GetNumRefinements() != _numRefinements) {
                throw std::runtime_error(
                    "the refiner refined or unrefined since this evaluator was "
                    "made: make another");
            }
            return function(*_evaluator);
        });
    }

public:
    Evaluator(std::shared_ptr<Refiner> refiner, py::object const &interpolationMode,
              int fvarChannel)
        : _refiner(std::move(refiner)) {
        RefinementEvaluator::Options options;
        options.interpolationMode = TakeEnum<StencilMode>(interpolationMode, "interpolation_mode");
        options.fvarChannel = fvarChannel;
        CallStatus status;
        _refiner->Read([&](TopologyRefiner const &topology) {
            _evaluator = RefinementEvaluator::Create(topology, options, &status);
            _numRefinements = topology.GetNumRefinements();
        });
        RaiseUnlessOk(status);
    }

    int GetMaxLevel() const {
        return read([](RefinementEvaluator &evaluator) { return evaluator.GetMaxLevel(); });
    }
    int GetNumElements(int level) const {
        CheckIndex(level, GetMaxLevel() + 1, "level");
        return read(
            [level](RefinementEvaluator &evaluator) { return evaluator.GetNumElements(level); });
    }
    std::int64_t GetNumElementsAllLevels() const {
        return read(
            [](RefinementEvaluator &evaluator) { return evaluator.GetNumElementsAllLevels(); });
    }

    py::array Evaluate(py::object const &src, std::optional<int> givenLevel,
                       py::object const &dst) const {
        int const level = givenLevel ? *givenLevel : GetMaxLevel();
        auto const source = TakeSource<float>(src, "src", GetNumElements(0));
        auto const destination = TakeDestination<float>(dst, "dst", GetNumElements(level), source);
        CheckApart(source, destination, "dst", 0, destination.count);
        CallStatus status;
        read([&](RefinementEvaluator &evaluator) {
            evaluator.Evaluate(source.data, source.desc, destination.data, destination.desc, level,
                               &status);
        });
        RaiseUnlessOk(status);
        return destination.array;
    }

    py::array EvaluateAllLevels(py::object const &src, py::object const &dst) const {
        auto const source = TakeSource<float>(src, "src", GetNumElements(0));
        std::int64_t const numElements = GetNumElementsAllLevels();
        if (numElements > std::numeric_limits<int>::max()) {
            throw py::value_error("dst: " + std::to_string(numElements) +
                                  " elements are more than an array here takes; evaluate levels");
        }
        auto const destination = TakeDestination<float>(dst, "dst", int(numElements), source);
        CheckApart(source, destination, "dst", 0, destination.count);
        CallStatus status;
        read([&](RefinementEvaluator &evaluator) {
            evaluator.EvaluateAllLevels(source.data, source.desc, destination.data,
                                        destination.desc, &status);
        });
        RaiseUnlessOk(status);
        return destination.array;
    }

    py::array EvaluateLimit(py::object const &src, std::optional<int> givenLevel,
                            py::object const &dst) const {
        int const level = givenLevel ? *givenLevel : GetMaxLevel();
        auto const source = TakeSource<float>(src, "src", GetNumElements(0));
        auto const points = TakeDestination<float>(dst, "dst", GetNumElements(level), source);
        CheckApart(source, points, "dst", 0, points.count);
        CallStatus status;
        read([&](RefinementEvaluator &evaluator) {
            evaluator.EvaluateLimit(source.data, source.desc, points.data, points.desc, level,
                                    &status);
        });
        RaiseUnlessOk(status);
        return points.array;
    }

    py::tuple EvaluateLimitWithDerivatives(py::object const &src, std::optional<int> givenLevel,
                                           py::object const &dst, py::object const &du,
                                           py::object const &dv) const {
        int const level = givenLevel ? *givenLevel : GetMaxLevel();
        auto const source = TakeSource<float>(src, "src", GetNumElements(0));
        int const count = GetNumElements(level);
        auto const points = TakeDestination<float>(dst, "dst", count, source);
        auto const duValues = TakeDestination<float>(du, "du", count, source);
        auto const dvValues = TakeDestination<float>(dv, "dv", count, source);
        CheckApart(source, points, "dst", 0, count);
        CheckApart(source, duValues, "du", 0, count);
        CheckApart(source, dvValues, "dv", 0, count);
        CallStatus status;
        read([&](RefinementEvaluator &evaluator) {
            evaluator.EvaluateLimit(source.data, source.desc, points.data, points.desc,
                                    duValues.data, duValues.desc, dvValues.data, dvValues.desc,
                                    level, &status);
        });
        RaiseUnlessOk(status);
        return py::make_tuple(points.array, duValues.array, dvValues.array);
    }

private:
    std::shared_ptr<Refiner> _refiner;
    std::unique_ptr<RefinementEvaluator> _evaluator;
    int _numRefinements = 0;
    mutable std::mutex _mutex;
};

template <typename REAL>
py::array computeNormalsOf(py::object const &du, py::object const &dv, py::object const &normals) {
    auto const us = TakeSource<REAL>(du, "du", -1);
    auto const vs = TakeSource<REAL>(dv, "dv", us.count);
    if (us.desc.length != 3 || vs.desc.length != 3) {
        throw py::value_error("du, dv: vectors of the shape (n, 3) are needed, the shapes are " +
                              DescribeShape(us.array) + " and " + DescribeShape(vs.array));
    }
    auto const result = TakeDestination<REAL>(normals, "normals", us.count, us);
    {
        py::gil_scoped_release const release;
        for (int i = 0; i < us.count; ++i) {
            REAL const *const u = us.data + std::size_t(i) * us.desc.stride;
            REAL const *const v = vs.data + std::size_t(i) * vs.desc.stride;
            REAL *const normal = result.data + std::size_t(i) * result.desc.stride;
            double const cross[3] = {double(u[1]) * v[2] - double(u[2]) * v[1],
                                     double(u[2]) * v[0] - double(u[0]) * v[2],
                                     double(u[0]) * v[1] - double(u[1]) * v[0]};
            double const length =
                std::sqrt(cross[0] * cross[0] + cross[1] * cross[1] + cross[2] * cross[2]);
            for (int axis = 0; axis < 3; ++axis) {
                normal[axis] = length > 0 ? REAL(cross[axis] / length) : 0;
            }
        }
    }
    return result.array;
}

py::array computeNormals(py::object const &du, py::object const &dv, py::object const &normals) {
    return IsDouble(du) || IsDouble(dv) ? computeNormalsOf<double>(du, dv, normals)
                                        : computeNormalsOf<float>(du, dv, normals);
}

/// Stands for a class of static functions.
template <class EVALUATOR>
struct StaticEvaluator {};

template <class EVALUATOR>
void bindStencilEvaluator(py::module_ &module, char const *name, char const *docstring) {
    py::class_<StaticEvaluator<EVALUATOR>>(module, name, docstring)
        .def_static(
            "eval_stencils", &evalStencils<EVALUATOR>,
            "eval_stencils(table, src, dst=None, start=0, end=None)\n\n"
            "Evaluates stencils start ... end - 1 of a StencilTable, or all of a\n"
            "CompactStencilTable.\n\n"
            "Args:\n"
            "    src: control values, taken as float32, shape (control vertices,) or\n"
            "        (control vertices, length)\n"
            "    dst: float32, shape (stencils,) or (stencils, length); stencil i is element\n"
            "        i; None: it is made.  It may show the memory of src, but for elements\n"
            "        that are read.\n\n"
            "Returns dst.",
            py::arg("table"), py::arg("src"), py::arg("dst") = py::none(), py::arg("start") = 0,
            py::arg("end") = py::none())
        .def_static("eval_stencils", &evalCompact<EVALUATOR>, "", py::arg("table"), py::arg("src"),
                    py::arg("dst") = py::none())
        .def_static(
            "eval_stencils_with_derivatives", &evalDerivatives<EVALUATOR>,
            "eval_stencils_with_derivatives(table, src, dst=None, du=None, dv=None, start=0,\n"
            "                               end=None)\n\n"
            "Points and first derivatives of a LimitStencilTable, as eval_stencils().  Returns\n"
            "(dst, du, dv).",
            py::arg("table"), py::arg("src"), py::arg("dst") = py::none(),
            py::arg("du") = py::none(), py::arg("dv") = py::none(), py::arg("start") = 0,
            py::arg("end") = py::none());
}

} // namespace

void BindEvaluators(py::module_ &module) {
    bindStencilEvaluator<OsdExt::CpuEvaluator>(
        module, "CpuEvaluator", "Evaluates stencils on the calling thread, in ascending order.");
    bindStencilEvaluator<OsdExt::ParallelEvaluator>(
        module, "ParallelEvaluator",
        "Evaluates stencils on all threads that the executor has, with the results of "
        "CpuEvaluator.\n"
        "set_num_threads() and set_executor() choose the threads.");

    py::class_<Evaluator>(
        module, "RefinementEvaluator",
        "RefinementEvaluator(refiner, *, interpolation_mode='vertex', fvar_channel=0)\n\n"
        "Computes the values of refined levels directly from the control values, without a table: "
        "the\n"
        "fastest way to refine a whole mesh in every frame.  Raises RuntimeError after the refiner "
        "was\n"
        "refined again.  Threads that share an evaluator wait for each other.")
        .def(py::init<std::shared_ptr<Refiner>, py::object, int>(), py::arg("refiner").none(false),
             py::kw_only(), py::arg("interpolation_mode") = "vertex", py::arg("fvar_channel") = 0)
        .def_property_readonly("max_level", &Evaluator::GetMaxLevel,
                               "The last level of the refiner.")
        .def("get_num_elements", &Evaluator::GetNumElements,
             "get_num_elements(level)\n\n"
             "Number of vertices, or face-varying values, of a level.",
             py::arg("level"))
        .def_property_readonly("num_elements_all_levels", &Evaluator::GetNumElementsAllLevels,
                               "Number of elements of levels 1 ... max_level.")
        .def("evaluate", &Evaluator::Evaluate,
             "evaluate(src, level=None, dst=None)\n\n"
             "The values of one level.\n\n"
             "Args:\n"
             "    src: control values, converted to float32, shape (elements of level 0,) or\n"
             "        (elements of level 0, length)\n"
             "    level: None: the last\n"
             "    dst: float32, shape (elements of the level,) or (elements of the level,\n"
             "        length); must not overlap src; None: allocated\n\n"
             "Returns dst.",
             py::arg("src"), py::arg("level") = py::none(), py::arg("dst") = py::none())
        .def("evaluate_all_levels", &Evaluator::EvaluateAllLevels,
             "evaluate_all_levels(src, dst=None)\n\n"
             "The values of levels 1 ... max_level in one array.  Returns dst.",
             py::arg("src"), py::arg("dst") = py::none())
        .def("evaluate_limit", &Evaluator::EvaluateLimit,
             "evaluate_limit(src, level=None, dst=None)\n\n"
             "Points of the limit surface at the vertices of a level with full topology; for "
             "vertex data\n"
             "only.  Arguments are those of evaluate().  The first call for a level takes longer "
             "and\n"
             "allocates memory that stays.  Returns dst.  Raises StatusError.",
             py::arg("src"), py::arg("level") = py::none(), py::arg("dst") = py::none())
        .def("evaluate_limit_with_derivatives", &Evaluator::EvaluateLimitWithDerivatives,
             "evaluate_limit_with_derivatives(src, level=None, dst=None, du=None, dv=None)\n\n"
             "Points as evaluate_limit(), and both first derivatives, which span the tangent plane "
             "on side 0\n"
             "of each vertex.  du and dv have the shape of dst.  Returns (dst, du, dv).",
             py::arg("src"), py::arg("level") = py::none(), py::arg("dst") = py::none(),
             py::arg("du") = py::none(), py::arg("dv") = py::none());

    module.def("compute_normals", &computeNormals,
               "compute_normals(du, dv, normals=None)\n\n"
               "Unit vectors perpendicular to du and dv, shape (n, 3); zeros where du and dv are "
               "parallel.\n"
               "float64 if du or dv is, else float32.  Returns normals, which None allocates.",
               py::arg("du"), py::arg("dv"), py::arg("normals") = py::none());
}

} // namespace OpenSubdivHex::Python
