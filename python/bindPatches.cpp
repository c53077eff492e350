// SPDX-License-Identifier: Apache-2.0
//
// PatchTable: the patches of a level, with their places, evaluated at arrays of places.
#include "arrays.h"
#include "refiner.h"
#include "stencilTable.h"

#include "far_ext/patchTableFactory.h"
#include "osd_ext/cpuEvaluator.h"

#include <opensubdiv/osd/cpuPatchTable.h>

#include <algorithm>

namespace OpenSubdivHex::Python {

namespace {

using FarExt::PatchMap;
using FarExt::PatchTableFactory;

constexpr int kNumPoints = 20; // of a patch
constexpr int kNumCorners = 4;

struct PatchTable {
    std::shared_ptr<Far::PatchTable const> table;
    std::unique_ptr<Osd::CpuPatchTable const> evaluated;
    std::unique_ptr<PatchMap const> map;
    StencilTable localPoints;
    std::vector<StencilTable> ofChannels;

    int GetNumPatches() const { return map->GetNumPatches(); }
    int GetNumControlVertices() const { return localPoints.numSources; }
    int GetNumLocalPoints() const { return table->GetNumLocalPoints(); }
    int GetNumFVarChannels() const { return int(ofChannels.size()); }
    StencilTable const &GetLocalPoints(int channel) const {
        CheckIndex(channel, GetNumFVarChannels(), "channel");
        return ofChannels[std::size_t(channel)];
    }
};

Far::StencilTableReal<float> const &getStencils(StencilTable const &points) {
    return *std::get<StencilTable::Pointer<float>>(points.table);
}

/// The control points, or values, and the local points.
int getNumPoints(StencilTable const &points) {
    return points.numSources + getStencils(points).GetNumStencils();
}

PatchTable createTable(Refiner const &refiner, int isolationLevel, bool generateFVarTables,
                       bool generateFVarLegacyLinearPatches) {
    PatchTable made;
    FarExt::CallStatus status;
    refiner.Read([&](FarExt::TopologyRefiner const &topology) {
        PatchTableFactory::Options options(isolationLevel);
        options.generateFVarTables = generateFVarTables;
        options.generateFVarLegacyLinearPatches = generateFVarLegacyLinearPatches;
        made.table = PatchTableFactory::Create(topology, options, &status);
        if (!made.table) {
            return;
        }
        // The local points are the table's, which lives as long as they do.
        made.localPoints.table =
            StencilTable::Pointer<float>(made.table, made.table->GetLocalPointStencilTable());
        made.localPoints.numSources = topology.GetLevel(0).GetNumVertices();
        for (int channel = 0; channel < made.table->GetNumFVarChannels(); ++channel) {
            StencilTable &ofChannel = made.ofChannels.emplace_back();
            ofChannel.numSources = topology.GetLevel(0).GetNumFVarValues(channel);
            if (auto const *known = made.table->GetLocalPointFaceVaryingStencilTable(channel)) {
                ofChannel.table = StencilTable::Pointer<float>(made.table, known);
                continue;
            }
            // Far's tables have none of linear channels.
            ofChannel.table = StencilTable::Pointer<float>(
                PatchTableFactory::CreateLocalPointFaceVaryingStencilTable(topology, options,
                                                                           channel, &status));
            if (!status.IsOk()) {
                return;
            }
        }
        made.map = std::make_unique<PatchMap>(topology, options, &status);
        made.evaluated = std::make_unique<Osd::CpuPatchTable>(made.table.get());
    });
    RaiseUnlessOk(status);
    return made;
}

py::array_t<float> makePoints(StencilTable const &localPoints, py::object const &values) {
    int const numControl = localPoints.numSources;
    auto const source = TakeSource<float>(values, "values", numControl);
    auto const width = py::ssize_t(source.desc.length);
    py::array_t<float> points({py::ssize_t(getNumPoints(localPoints)), width});
    float *const data = points.mutable_data();
    py::gil_scoped_release const release;
    for (int i = 0; i < numControl; ++i) {
        std::copy_n(source.data + std::ptrdiff_t(i) * source.desc.stride, width, data + i * width);
    }
    Osd::BufferDescriptor const control(0, int(width), int(width));
    Osd::BufferDescriptor const local(int(width) * numControl, int(width), int(width));
    Far::StencilTableReal<float> const &stencils = getStencils(localPoints);
    OsdExt::ParallelEvaluator::EvalStencils(
        data, control, data, local, stencils.GetSizes().data(), stencils.GetOffsets().data(),
        stencils.GetControlIndices().data(), stencils.GetWeights().data(), 0,
        stencils.GetNumStencils());
    return points;
}

/// The places that two arrays have.
std::vector<Osd::PatchCoord> takePlaces(PatchTable const &self, py::object const &patches,
                                        py::object const &st) {
    py::array_t<int> const indices = TakeIndices(patches, "patches");
    auto const coords = TakeSource<float>(st, "st", int(indices.size()));
    if (coords.desc.length != 2) {
        throw py::value_error("st: the shape (n, 2) is needed, not " + DescribeShape(coords.array));
    }
    std::vector<Osd::PatchCoord> places;
    places.reserve(std::size_t(indices.size()));
    for (py::ssize_t i = 0; i < indices.size(); ++i) {
        int const patch = indices.data()[i];
        CheckIndex(patch, self.GetNumPatches(), "patches");
        float const *const place = coords.data + i * coords.desc.stride;
        places.emplace_back(PatchMap::GetHandle(patch), place[0], place[1]);
    }
    return places;
}

/// Points, and derivatives behind them: \p numOutputs arrays; values of a \p channel of 0 or more.
py::object evaluate(PatchTable const &self, py::object const &patches, py::object const &st,
                    py::object const &points, int numOutputs, int channel = -1) {
    StencilTable const &localPoints =
        channel < 0 ? self.localPoints : self.ofChannels[std::size_t(channel)];
    std::vector<Osd::PatchCoord> const places = takePlaces(self, patches, st);
    auto const source = TakeSource<float>(points, "points", getNumPoints(localPoints));
    Osd::CpuPatchTable const &table = *self.evaluated;
    bool const isOfChannel = channel >= 0;
    constexpr int kMaxOutputs = 6;
    py::tuple result(numOutputs);
    float *outputs[kMaxOutputs] = {};
    int const width = source.desc.length;
    for (int i = 0; i < numOutputs; ++i) {
        py::array_t<float> output({py::ssize_t(places.size()), py::ssize_t(width)});
        outputs[i] = output.mutable_data();
        result[std::size_t(i)] = output;
    }
    {
        py::gil_scoped_release const release;
        Osd::BufferDescriptor const desc(0, width, width);
        OsdExt::ParallelEvaluator::EvalPatches(
            source.data, source.desc, outputs[0], desc, outputs[1], desc, outputs[2], desc,
            outputs[3], desc, outputs[4], desc, outputs[5], desc, int(places.size()), places.data(),
            isOfChannel ? table.GetFVarPatchArrayBuffer(channel) : table.GetPatchArrayBuffer(),
            isOfChannel ? table.GetFVarPatchIndexBuffer(channel) : table.GetPatchIndexBuffer(),
            isOfChannel ? table.GetFVarPatchParamBuffer(channel) : table.GetPatchParamBuffer());
    }
    return numOutputs == 1 ? py::object(result[0]) : py::object(result);
}

py::tuple findPlaces(PatchTable const &self, py::object const &faces, py::object const &uv) {
    py::array_t<int> const indices = TakeIndices(faces, "faces");
    auto const coords = TakeSource<double>(uv, "uv", int(indices.size()));
    if (coords.desc.length != 2) {
        throw py::value_error("uv: the shape (n, 2) is needed, not " + DescribeShape(coords.array));
    }
    for (py::ssize_t i = 0; i < indices.size(); ++i) {
        CheckIndex(indices.data()[i], self.map->GetNumFaces(), "faces");
    }
    py::array_t<int> patches(indices.size());
    py::array_t<double> st({indices.size(), py::ssize_t(2)});
    int *const patch = patches.mutable_data();
    double *const place = st.mutable_data();
    py::gil_scoped_release const release;
    for (py::ssize_t i = 0; i < indices.size(); ++i) {
        double const *const at = coords.data + i * coords.desc.stride;
        PatchMap::Place const found = self.map->FindPlace(indices.data()[i], at[0], at[1]);
        patch[i] = found.patch;
        place[2 * i] = found.s;
        place[2 * i + 1] = found.t;
    }
    py::gil_scoped_acquire const acquire;
    return py::make_tuple(patches, st);
}

template <typename QUERY>
py::array_t<int> listFaces(PatchTable const &self, QUERY const &query) {
    std::vector<int> faces(std::size_t(self.GetNumPatches()));
    for (std::size_t i = 0; i < faces.size(); ++i) {
        faces[i] = query(*self.map, int(i));
    }
    return TakeOver(std::move(faces));
}

py::array_t<double> listCoords(PatchTable const &self) {
    py::array_t<double> result(
        {py::ssize_t(self.GetNumPatches()), py::ssize_t(kNumCorners), py::ssize_t(2)});
    double *next = result.mutable_data();
    for (int patch = 0; patch < self.GetNumPatches(); ++patch) {
        auto const &coords = self.map->GetCoords(patch);
        next = std::copy(coords.begin(), coords.end(), next);
    }
    return result;
}

} // namespace

void BindPatches(py::module_ &module) {
    py::class_<PatchTable>(
        module, "PatchTable",
        "PatchTable(refiner, isolation_level, *, generate_fvar_tables=False,\n"
        "           generate_fvar_legacy_linear_patches=True)\n\n"
        "The limit surface as bicubic Gregory patches: those of FarExt::PatchTableFactory.\n\n"
        "Args:\n"
        "    isolation_level: the level whose faces become patches, less than the refiner's "
        "max_level.\n"
        "        Refine by refine_uniform(isolation_level + 1, full_topology_in_last_level=True)\n"
        "    generate_fvar_tables: also makes patches of the face-varying channels\n"
        "    generate_fvar_legacy_linear_patches: True: patches of all channels are bilinear; "
        "False:\n"
        "        those of linear channels alone\n\n"
        "Nothing refers to the refiner afterwards.  Raises StatusError.")
        .def(py::init(&createTable), py::arg("refiner"), py::arg("isolation_level"), py::kw_only(),
             py::arg("generate_fvar_tables") = false,
             py::arg("generate_fvar_legacy_linear_patches") = true)
        .def_property_readonly("num_patches", &PatchTable::GetNumPatches, "Number of patches.")
        .def_property_readonly("num_control_vertices", &PatchTable::GetNumControlVertices,
                               "Vertices of the base mesh.")
        .def_property_readonly("num_local_points", &PatchTable::GetNumLocalPoints,
                               "Number of points that make_points() adds to the control vertices.")
        .def_property_readonly(
            "local_point_stencil_table", [](PatchTable const &self) { return self.localPoints; },
            "The StencilTable that makes the local points from the control vertices.")
        .def_property_readonly(
            "patch_vertices",
            [](py::object const &self) {
                auto const &table = self.cast<PatchTable const &>();
                return View(table.evaluated->GetPatchIndexBuffer(),
                            {py::ssize_t(table.GetNumPatches()), py::ssize_t(kNumPoints)}, self);
            },
            "int32, shape (patches, 20), a view: indices into the result of make_points().")
        .def_property_readonly(
            "faces",
            [](PatchTable const &self) {
                return listFaces(self, [](PatchMap const &map, int p) { return map.GetFace(p); });
            },
            "int32, shape (patches,): the face of the surface level that has each patch.")
        .def_property_readonly(
            "base_faces",
            [](PatchTable const &self) {
                return listFaces(self,
                                 [](PatchMap const &map, int p) { return map.GetBaseFace(p); });
            },
            "int32, shape (patches,): the face of level 0 that has each patch.")
        .def_property_readonly("coords", &listCoords,
                               "float64, shape (patches, 4, 2): u and v of the four corners of "
                               "each patch in its base face.")
        .def_property_readonly("num_fvar_channels", &PatchTable::GetNumFVarChannels,
                               "Number of channels that have patches.")
        .def(
            "local_point_fvar_stencil_table",
            [](PatchTable const &self, int channel) { return self.GetLocalPoints(channel); },
            "local_point_fvar_stencil_table(channel=0)\n\n"
            "The StencilTable that makes the local points of a channel from its values.",
            py::arg("channel") = 0)
        .def(
            "patch_fvar_values",
            [](py::object const &self, int channel) {
                auto const &table = self.cast<PatchTable const &>();
                table.GetLocalPoints(channel); // or it is out of range
                return View(table.evaluated->GetFVarPatchIndexBuffer(channel),
                            {py::ssize_t(table.GetNumPatches()),
                             py::ssize_t(table.table->GetFVarValueStride(channel))},
                            self);
            },
            "patch_fvar_values(channel=0)\n\n"
            "int32, shape (patches, 20), or (patches, 4) where patches are bilinear, a view: "
            "indices into\n"
            "the result of make_fvar_points().",
            py::arg("channel") = 0)
        .def(
            "make_fvar_points",
            [](PatchTable const &self, py::object const &values, int channel) {
                return makePoints(self.GetLocalPoints(channel), values);
            },
            "make_fvar_points(values, channel=0)\n\n"
            "The points of a channel's patches: float32, shape (values + local points, width).\n\n"
            "Args:\n"
            "    values: the channel's values of level 0, shape (values, width)",
            py::arg("values"), py::arg("channel") = 0)
        .def(
            "evaluate_fvar",
            [](PatchTable const &self, py::object const &patches, py::object const &st,
               py::object const &points, int channel) {
                self.GetLocalPoints(channel); // or it is out of range
                return evaluate(self, patches, st, points, 1, channel);
            },
            "evaluate_fvar(patches, st, points, channel=0)\n\n"
            "Values of a face-varying channel: float32, shape (n, width).\n\n"
            "Args:\n"
            "    patches, st: as for evaluate()\n"
            "    points: the result of make_fvar_points()",
            py::arg("patches"), py::arg("st"), py::arg("points"), py::arg("channel") = 0)
        .def(
            "make_points",
            [](PatchTable const &self, py::object const &values) {
                return makePoints(self.localPoints, values);
            },
            "make_points(values)\n\n"
            "The points of the patches: float32, shape (control vertices + local points, "
            "width).\n\n"
            "Args:\n"
            "    values: data of the control vertices, shape (control vertices, width)",
            py::arg("values"))
        .def("find_places", &findPlaces,
             "find_places(faces, uv)\n\n"
             "Finds the patch at each (face, u, v) of the surface level.\n\n"
             "Returns (patches, st): int32, shape (n,), -1 where there is no patch; and float64, "
             "shape (n, 2).\n\n"
             "Args:\n"
             "    faces: integers, shape (n,)\n"
             "    uv: shape (n, 2)",
             py::arg("faces"), py::arg("uv"))
        .def(
            "evaluate",
            [](PatchTable const &self, py::object const &patches, py::object const &st,
               py::object const &points) { return evaluate(self, patches, st, points, 1); },
            "evaluate(patches, st, points)\n\n"
            "Points of the surface: float32, shape (n, width).\n\n"
            "Args:\n"
            "    patches: the patch of each point, integers, shape (n,)\n"
            "    st: s and t of each point in its patch, shape (n, 2), from 0 to 1\n"
            "    points: the result of make_points()",
            py::arg("patches"), py::arg("st"), py::arg("points"))
        .def(
            "evaluate_with_derivatives",
            [](PatchTable const &self, py::object const &patches, py::object const &st,
               py::object const &points) { return evaluate(self, patches, st, points, 3); },
            "evaluate_with_derivatives(patches, st, points)\n\n"
            "Returns (points, ds, dt): points as evaluate(), and their derivatives by s and t.",
            py::arg("patches"), py::arg("st"), py::arg("points"))
        .def(
            "evaluate_with_second_derivatives",
            [](PatchTable const &self, py::object const &patches, py::object const &st,
               py::object const &points) { return evaluate(self, patches, st, points, 6); },
            "evaluate_with_second_derivatives(patches, st, points)\n\n"
            "Returns (points, ds, dt, dss, dst, dtt): points as evaluate(), first and second "
            "derivatives.",
            py::arg("patches"), py::arg("st"), py::arg("points"));
}

} // namespace OpenSubdivHex::Python
