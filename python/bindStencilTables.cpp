// SPDX-License-Identifier: Apache-2.0
//
// StencilTable and LimitStencilTable: made of a refiner, read as arrays or as sparse matrices.
#include "arrays.h"
#include "options.h"
#include "refiner.h"
#include "stencilTable.h"

#include "far_ext/stencilTableFactory.h"
#include "osd_ext/stencilEvaluator.h"

#include <optional>

namespace OpenSubdivHex::Python {

namespace {

using namespace FarExt;

/// Whether tables have weights of 64 bits, as numpy names the type.
bool takeIsDouble(py::object const &dtype) {
    py::dtype const type = py::dtype::from_args(dtype);
    if (type.kind() == 'f' && type.itemsize() == sizeof(float)) {
        return false;
    }
    if (type.kind() == 'f' && type.itemsize() == sizeof(double)) {
        return true;
    }
    throw py::type_error("dtype: float32 or float64 is needed, not " + std::string(py::repr(type)));
}

/// The options of all tables, of either precision.
struct TableOptions {
    TableOptions(py::object const &interpolationMode, int channel)
        : mode(TakeEnum<StencilMode>(interpolationMode, "interpolation_mode")),
          fvarChannel(channel) {}

    template <typename REAL>
    typename StencilTableFactoryReal<REAL>::Options Get() const {
        typename StencilTableFactoryReal<REAL>::Options options;
        options.interpolationMode = mode;
        options.generateControlVerts = generateControlVerts;
        options.generateIntermediateLevels = generateIntermediateLevels;
        options.factorizeIntermediateLevels = factorizeIntermediateLevels;
        options.maxLevel = maxLevel.value_or(options.maxLevel);
        options.fvarChannel = fvarChannel;
        return options;
    }

    StencilMode mode;
    int fvarChannel;
    bool generateControlVerts = false;
    bool generateIntermediateLevels = true;
    bool factorizeIntermediateLevels = true;
    std::optional<int> maxLevel;
};

TableOptions takeOptions(py::object const &interpolationMode, bool generateControlVerts,
                         bool generateIntermediateLevels, bool factorizeIntermediateLevels,
                         std::optional<int> maxLevel, int fvarChannel) {
    TableOptions options(interpolationMode, fvarChannel);
    options.generateControlVerts = generateControlVerts;
    options.generateIntermediateLevels = generateIntermediateLevels;
    options.factorizeIntermediateLevels = factorizeIntermediateLevels;
    options.maxLevel = maxLevel;
    return options;
}

int countElements(TopologyLevel const &level, TableOptions const &options) {
    return options.mode == INTERPOLATE_FACE_VARYING ? level.GetNumFVarValues(options.fvarChannel)
                                                    : level.GetNumVertices();
}

/// Makes a table by create(refiner, options, &status).
template <typename REAL, typename CREATE>
StencilTable makeTable(Refiner const &refiner, TableOptions const &options, CREATE const &create) {
    CallStatus status;
    StencilTable made;
    refiner.Read([&](TopologyRefiner const &topology) {
        std::shared_ptr<typename StencilTableFactoryReal<REAL>::Table const> table =
            create(topology, options.Get<REAL>(), &status);
        if (!table) {
            return;
        }
        made.table = StencilTable::Pointer<REAL>(table);
        int const lastLevel =
            std::min(options.maxLevel.value_or(topology.GetMaxLevel()), topology.GetMaxLevel());
        int const sourceLevel =
            options.factorizeIntermediateLevels ? 0 : std::max(lastLevel - 1, 0);
        made.numSources = countElements(topology.GetLevel(sourceLevel), options);
        made.isMatrix = sourceLevel == 0 ||
                        (!options.generateIntermediateLevels && !options.generateControlVerts);
    });
    RaiseUnlessOk(status);
    return made;
}

StencilTable createTable(Refiner const &refiner, TableOptions const &options, bool isDouble) {
    auto const make = [&](auto real) {
        using REAL = decltype(real);
        return makeTable<REAL>(
            refiner, options,
            [](TopologyRefiner const &topology, auto const &tableOptions, CallStatus *status) {
                return StencilTableFactoryReal<REAL>::Create(topology, tableOptions, status);
            });
    };
    return isDouble ? make(double()) : make(float());
}

StencilTable createTableOfFaces(Refiner const &refiner, py::object const &baseFaces,
                                TableOptions const &options, bool isDouble) {
    py::array_t<int> const faces = TakeIndices(baseFaces, "base_faces");
    Far::ConstIndexArray const selection(faces.data(), int(faces.size()));
    auto const make = [&](auto real) {
        using REAL = decltype(real);
        return makeTable<REAL>(
            refiner, options,
            [&](TopologyRefiner const &topology, auto const &tableOptions, CallStatus *status) {
                return StencilTableFactoryReal<REAL>::CreateOfFaces(topology, selection,
                                                                    tableOptions, status);
            });
    };
    return isDouble ? make(double()) : make(float());
}

py::array_t<int> getVerticesOfFaces(Refiner const &refiner, py::object const &baseFaces, int level,
                                    TableOptions const &options) {
    py::array_t<int> const faces = TakeIndices(baseFaces, "base_faces");
    Far::ConstIndexArray const selection(faces.data(), int(faces.size()));
    CallStatus status;
    std::vector<int> vertices = refiner.Read([&](TopologyRefiner const &topology) {
        return StencilTableFactory::GetVerticesOfFaces(topology, selection, options.Get<float>(),
                                                       level, &status);
    });
    RaiseUnlessOk(status);
    return TakeOver(std::move(vertices));
}

py::dict getSize(Refiner const &refiner, TableOptions const &options, bool isDouble) {
    CallStatus status;
    StencilTableSize const size = refiner.Read([&](TopologyRefiner const &topology) {
        return isDouble ? StencilTableFactoryReal<double>::GetSize(topology, options.Get<double>(),
                                                                   &status)
                        : StencilTableFactory::GetSize(topology, options.Get<float>(), &status);
    });
    RaiseUnlessOk(status);
    py::dict result;
    result["num_stencils"] = size.numStencils;
    result["num_weights"] = size.numWeights;
    result["num_bytes"] = size.numBytes;
    return result;
}

LimitStencilTable createLimitTable(Refiner const &refiner, int level, bool generateVertices,
                                   bool generateFurtherSides, bool generateFaceCenters,
                                   bool generate1stDerivatives, bool factorizeIntermediateLevels,
                                   py::object const &dtype) {
    auto const make = [&](auto real) {
        using REAL = decltype(real);
        using Factory = LimitStencilTableFactoryReal<REAL>;
        typename Factory::Options options;
        options.level = level;
        options.generateVertices = generateVertices;
        options.generateFurtherSides = generateFurtherSides;
        options.generateFaceCenters = generateFaceCenters;
        options.generate1stDerivatives = generate1stDerivatives;
        options.factorizeIntermediateLevels = factorizeIntermediateLevels;
        CallStatus status;
        LimitStencilTable made;
        refiner.Read([&](TopologyRefiner const &topology) {
            std::shared_ptr<typename Factory::Table const> const table =
                Factory::Create(topology, options, &status);
            if (!table) {
                return;
            }
            made.table = StencilTable::Pointer<REAL>(table);
            int const sourceLevel = factorizeIntermediateLevels ? 0
                                    : level == -1               ? topology.GetMaxLevel()
                                                                : level;
            made.numSources = topology.GetLevel(sourceLevel).GetNumVertices();
            made.hasDerivatives = generate1stDerivatives;
        });
        RaiseUnlessOk(status);
        return made;
    };
    return takeIsDouble(dtype) ? make(double()) : make(float());
}

/// Calls function(table) with the table of one precision.
template <typename FUNCTION>
auto visit(StencilTable const &self, FUNCTION const &function) {
    return std::visit([&](auto const &table) { return function(*table); }, self.table);
}

template <typename T>
py::array showVector(std::vector<T> const &values, py::object const &owner) {
    return View(values.data(), {py::ssize_t(values.size())}, owner);
}

/// A property that shows an array of the table, query(table).
template <typename QUERY>
auto show(QUERY query) {
    return [query](py::object const &self) {
        return visit(self.cast<StencilTable const &>(), [&](auto const &table) -> py::array {
            return showVector(query(table), self);
        });
    };
}

/// The weights of the points or of a derivative.
py::array showWeights(py::object const &self, int derivative) {
    auto const *const limit =
        dynamic_cast<LimitStencilTable const *>(&self.cast<StencilTable const &>());
    if (derivative != 0 && !(limit && limit->hasDerivatives)) {
        throw py::value_error("the table was made without derivatives");
    }
    return visit(self.cast<StencilTable const &>(), [&](auto const &table) -> py::array {
        if (derivative == 0) {
            return showVector(table.GetWeights(), self);
        }
        using Table = std::decay_t<decltype(table)>;
        using REAL = std::decay_t<decltype(table.GetWeights()[0])>;
        static_assert(std::is_base_of_v<Table, Far::LimitStencilTableReal<REAL>>);
        auto const &limits = static_cast<Far::LimitStencilTableReal<REAL> const &>(table);
        return showVector(derivative == 1 ? limits.GetDuWeights() : limits.GetDvWeights(), self);
    });
}

/// A scipy.sparse.csr_matrix that shares the table's indices and weights.
py::object toScipy(py::object const &self, int derivative) {
    auto const &stencils = self.cast<StencilTable const &>();
    if (!stencils.isMatrix) {
        throw py::value_error("the table's levels refer to different vertices: make it with "
                              "factorize_intermediate_levels=True");
    }
    py::array const weights = showWeights(self, derivative);
    return visit(stencils, [&](auto const &table) -> py::object {
        std::vector<int> rows = table.GetOffsets();
        rows.push_back(int(table.GetControlIndices().size()));
        py::tuple const arrays = py::make_tuple(
            weights, showVector(table.GetControlIndices(), self), TakeOver(std::move(rows)));
        return py::module_::import("scipy.sparse")
            .attr("csr_matrix")(arrays, py::arg("copy") = false,
                                py::arg("shape") =
                                    py::make_tuple(table.GetNumStencils(), stencils.numSources));
    });
}

void bindTable(py::module_ &module) {
    constexpr char const *kOptions =
        "    interpolation_mode: a StencilMode or its name\n"
        "    generate_control_verts: starts the table with a row for each control vertex\n"
        "    generate_intermediate_levels: True: rows of levels 1 ... max_level; False: of\n"
        "        max_level alone\n"
        "    factorize_intermediate_levels: True: stencils refer to control vertices; False: to\n"
        "        vertices of the level before\n"
        "    max_level: None, or a larger number: the refiner's max_level\n"
        "    fvar_channel: the channel, with interpolation mode 'face_varying'\n"
        "    dtype: type of the weights, float32 or float64; evaluators take float32\n";
    auto const doc = [&](std::string const &before, std::string const &after) {
        return before + kOptions + after;
    };
    py::class_<StencilTable>(
        module, "StencilTable",
        doc("StencilTable(refiner, *, interpolation_mode='vertex', generate_control_verts=False,\n"
            "             generate_intermediate_levels=True, factorize_intermediate_levels=True,\n"
            "             max_level=None, fvar_channel=0, dtype='float32')\n\n"
            "Stencils of refined vertices, or face-varying values: weighted sums of control\n"
            "vertices.\n\n"
            "Args:\n",
            "\nArrays are views.  A table never changes and does not need the refiner.\n"
            "Raises StatusError.")
            .c_str())
        .def(py::init([](Refiner const &refiner, py::object const &mode, bool controlVerts,
                         bool intermediate, bool factorize, std::optional<int> maxLevel,
                         int channel, py::object const &dtype) {
                 return createTable(
                     refiner,
                     takeOptions(mode, controlVerts, intermediate, factorize, maxLevel, channel),
                     takeIsDouble(dtype));
             }),
             py::arg("refiner"), py::kw_only(), py::arg("interpolation_mode") = "vertex",
             py::arg("generate_control_verts") = false,
             py::arg("generate_intermediate_levels") = true,
             py::arg("factorize_intermediate_levels") = true, py::arg("max_level") = py::none(),
             py::arg("fvar_channel") = 0, py::arg("dtype") = "float32")
        .def_static(
            "create_of_faces",
            [](Refiner const &refiner, py::object const &baseFaces, py::object const &mode,
               bool controlVerts, bool intermediate, bool factorize, std::optional<int> maxLevel,
               int channel, py::object const &dtype) {
                return createTableOfFaces(
                    refiner, baseFaces,
                    takeOptions(mode, controlVerts, intermediate, factorize, maxLevel, channel),
                    takeIsDouble(dtype));
            },
            doc("create_of_faces(refiner, base_faces, *, interpolation_mode='vertex',\n"
                "                generate_control_verts=False, generate_intermediate_levels=True,\n"
                "                factorize_intermediate_levels=True, max_level=None,\n"
                "                fvar_channel=0, dtype='float32')\n\n"
                "The table of the refined faces that lie in the given base faces.\n\n"
                "Args:\n"
                "    base_faces: integers, shape (n,), in any order\n",
                "")
                .c_str(),
            py::arg("refiner"), py::arg("base_faces"), py::kw_only(),
            py::arg("interpolation_mode") = "vertex", py::arg("generate_control_verts") = false,
            py::arg("generate_intermediate_levels") = true,
            py::arg("factorize_intermediate_levels") = true, py::arg("max_level") = py::none(),
            py::arg("fvar_channel") = 0, py::arg("dtype") = "float32")
        .def_static(
            "get_vertices_of_faces",
            [](Refiner const &refiner, py::object const &baseFaces, int level,
               py::object const &mode, int channel) {
                return getVerticesOfFaces(refiner, baseFaces, level, TableOptions(mode, channel));
            },
            "get_vertices_of_faces(refiner, base_faces, level, *, interpolation_mode='vertex',\n"
            "                      fvar_channel=0)\n\n"
            "int32, shape (n,): the vertices, or values, of a level that have stencils in the\n"
            "table of create_of_faces(), in the order of its stencils.",
            py::arg("refiner"), py::arg("base_faces"), py::arg("level"), py::kw_only(),
            py::arg("interpolation_mode") = "vertex", py::arg("fvar_channel") = 0)
        .def_static(
            "get_size",
            [](Refiner const &refiner, py::object const &mode, bool controlVerts, bool intermediate,
               bool factorize, std::optional<int> maxLevel, int channel, py::object const &dtype) {
                return getSize(
                    refiner,
                    takeOptions(mode, controlVerts, intermediate, factorize, maxLevel, channel),
                    takeIsDouble(dtype));
            },
            "get_size(refiner, *, interpolation_mode='vertex', generate_control_verts=False,\n"
            "         generate_intermediate_levels=True, factorize_intermediate_levels=True,\n"
            "         max_level=None, fvar_channel=0, dtype='float32')\n\n"
            "How large a table will be: a dict with the integers 'num_stencils', 'num_weights' "
            "and\n"
            "'num_bytes' of its arrays.",
            py::arg("refiner"), py::kw_only(), py::arg("interpolation_mode") = "vertex",
            py::arg("generate_control_verts") = false,
            py::arg("generate_intermediate_levels") = true,
            py::arg("factorize_intermediate_levels") = true, py::arg("max_level") = py::none(),
            py::arg("fvar_channel") = 0, py::arg("dtype") = "float32")
        .def_property_readonly(
            "num_stencils",
            [](StencilTable const &self) {
                return visit(self, [](auto const &table) { return table.GetNumStencils(); });
            },
            "Number of rows, one for each refined vertex or value.")
        .def_property_readonly(
            "num_control_vertices",
            [](StencilTable const &self) {
                return visit(self, [](auto const &table) { return table.GetNumControlVertices(); });
            },
            "Number of control vertices, or face-varying values.")
        .def_property_readonly(
            "sizes", show([](auto const &table) -> decltype(auto) { return (table.GetSizes()); }),
            "int32, shape (stencils,), a view: the number of weights of each stencil.")
        .def_property_readonly(
            "offsets",
            show([](auto const &table) -> decltype(auto) { return (table.GetOffsets()); }),
            "int32, shape (stencils,), a view: the index of each stencil's first weight.")
        .def_property_readonly("control_indices", show([](auto const &table) -> decltype(auto) {
                                   return (table.GetControlIndices());
                               }),
                               "int32, shape (weights,), a view.")
        .def_property_readonly(
            "weights", [](py::object const &self) { return showWeights(self, 0); },
            "float32 or float64, shape (weights,), a view.")
        .def(
            "to_scipy", [](py::object const &self) { return toScipy(self, 0); },
            "to_scipy()\n\n"
            "A scipy.sparse.csr_matrix, shape (stencils, control vertices), that shares the "
            "table's\n"
            "memory: do not write to it.  matrix @ control_values are the refined values.");
}

void bindLimitTable(py::module_ &module) {
    py::class_<LimitStencilTable, StencilTable>(
        module, "LimitStencilTable",
        "LimitStencilTable(refiner, level=-1, *, generate_vertices=True,\n"
        "                  generate_further_sides=False, generate_face_centers=False,\n"
        "                  generate_1st_derivatives=True, factorize_intermediate_levels=True,\n"
        "                  dtype='float32')\n\n"
        "Stencils of points on the limit surface and of the first derivatives there.\n\n"
        "Args:\n"
        "    level: the level that has the vertices and faces, with full topology; -1: the last\n"
        "    generate_vertices: makes a stencil for each vertex\n"
        "    generate_further_sides: after these, one for each further side, as LimitSides numbers "
        "them\n"
        "    generate_face_centers: after these, one for the center of each face\n"
        "    generate_1st_derivatives: makes du_weights and dv_weights\n"
        "    factorize_intermediate_levels: True: stencils refer to control vertices; False: to\n"
        "        vertices of the level, for values that are refined already\n"
        "    dtype: type of the weights, float32 or float64; evaluators take float32\n\n"
        "Raises StatusError.")
        .def(py::init(&createLimitTable), py::arg("refiner"), py::arg("level") = -1, py::kw_only(),
             py::arg("generate_vertices") = true, py::arg("generate_further_sides") = false,
             py::arg("generate_face_centers") = false, py::arg("generate_1st_derivatives") = true,
             py::arg("factorize_intermediate_levels") = true, py::arg("dtype") = "float32")
        .def_readonly("has_derivatives", &LimitStencilTable::hasDerivatives,
                      "Whether the table has du_weights and dv_weights.")
        .def_property_readonly(
            "du_weights", [](py::object const &self) { return showWeights(self, 1); },
            "float32 or float64, shape (weights,), a view: the weights of derivative du.")
        .def_property_readonly(
            "dv_weights", [](py::object const &self) { return showWeights(self, 2); },
            "float32 or float64, shape (weights,), a view: the weights of derivative dv.")
        .def(
            "du_to_scipy", [](py::object const &self) { return toScipy(self, 1); },
            "du_to_scipy()\n\n"
            "A scipy.sparse.csr_matrix with du_weights, as to_scipy().")
        .def(
            "dv_to_scipy", [](py::object const &self) { return toScipy(self, 2); },
            "dv_to_scipy()\n\n"
            "A scipy.sparse.csr_matrix with dv_weights, as to_scipy().");
}

void bindCompactTable(py::module_ &module) {
    using OsdExt::CompactStencilTable;
    py::class_<CompactStencilTable>(module, "CompactStencilTable",
                                    "CompactStencilTable(table)\n\n"
                                    "A float32 StencilTable in two thirds of the memory: faster to "
                                    "evaluate, with equal results.")
        .def(py::init([](StencilTable const &stencils) {
                 auto const *const table =
                     std::get_if<StencilTable::Pointer<float>>(&stencils.table);
                 if (!table || !stencils.isMatrix ||
                     dynamic_cast<LimitStencilTable const *>(&stencils)) {
                     throw py::type_error("table: a factorized StencilTable of float32 is needed");
                 }
                 py::gil_scoped_release const release;
                 // StencilTableFactory made it, whose tables are of this type.
                 auto compact =
                     CompactStencilTable::Create(static_cast<Far::StencilTable const &>(**table));
                 return std::unique_ptr<CompactStencilTable>(
                     const_cast<CompactStencilTable *>(compact.release()));
             }),
             py::arg("table"))
        .def_property_readonly("num_stencils", &CompactStencilTable::GetNumStencils,
                               "Rows of the table.")
        .def_property_readonly("num_control_vertices", &CompactStencilTable::GetNumControlVertices,
                               "Number of control vertices, or face-varying values.")
        .def_property_readonly("num_blocks", &CompactStencilTable::GetNumBlocks,
                               "Groups of stencils that are evaluated together.")
        .def_property_readonly("num_bytes", &CompactStencilTable::GetNumBytes,
                               "Memory of all arrays.");
}

} // namespace

void BindStencilTables(py::module_ &module) {
    bindTable(module);
    bindLimitTable(module);
    bindCompactTable(module);
}

} // namespace OpenSubdivHex::Python
