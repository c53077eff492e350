// SPDX-License-Identifier: Apache-2.0
//
// TopologyRefiner: a base mesh from arrays, and its refinement.
#include "arrays.h"
#include "options.h"
#include "refiner.h"

#include "far_ext/topologyRefinerFactory.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>

namespace OpenSubdivHex::Python {

namespace {

using namespace FarExt;

std::vector<int> takeVector(py::handle object, char const *name) {
    py::array_t<int> const array = TakeIndices(object, name);
    return std::vector<int>(array.data(), array.data() + array.size());
}

/// \brief How many vertices or values there are: as many as were given, else as many as indices refer to.
///
/// These take memory, however few corners have them: far more than there are corners are not taken to be meant.
int findCount(std::vector<int> const &indices, std::optional<int> const &given, char const *name) {
    constexpr std::int64_t kMostInAnyMesh = 65536;
    constexpr std::int64_t kMostPerCorner = 16;
    if (given) {
        if (*given < 0) {
            throw py::value_error(std::string(name) + ": " + std::to_string(*given) +
                                  " is negative");
        }
        return *given;
    }
    auto const most = std::max_element(indices.begin(), indices.end());
    if (indices.empty() || *most < 0) {
        return 0;
    }
    std::int64_t const count = std::int64_t(*most) + 1;
    if (count > std::max(kMostInAnyMesh, kMostPerCorner * std::int64_t(indices.size())) ||
        count > std::numeric_limits<int>::max()) {
        throw py::value_error(
            std::string(name) + ": corner " + std::to_string(most - indices.begin()) +
            " refers to number " + std::to_string(*most) + ", but there are " +
            std::to_string(indices.size()) + " corners; pass " + name + " where so many are meant");
    }
    return int(count);
}

void takeFlatFaces(py::object const &faces, py::object const &faceOffsets, BaseMesh *mesh) {
    mesh->faceVertices = takeVector(faces, "faces");
    std::vector<int> const offsets = takeVector(faceOffsets, "face_offsets");
    if (offsets.empty() || offsets.front() != 0 ||
        std::size_t(offsets.back()) != mesh->faceVertices.size()) {
        throw py::value_error("face_offsets: they begin with 0 and end with the " +
                              std::to_string(mesh->faceVertices.size()) + " vertices of all faces");
    }
    mesh->faceSizes.resize(offsets.size() - 1);
    for (std::size_t f = 0; f + 1 < offsets.size(); ++f) {
        if (offsets[f + 1] < offsets[f]) {
            throw py::value_error("face_offsets: those of face " + std::to_string(f) +
                                  " descend, from " + std::to_string(offsets[f]) + " to " +
                                  std::to_string(offsets[f + 1]));
        }
        mesh->faceSizes[f] = offsets[f + 1] - offsets[f];
    }
}

void takeListOfFaces(py::object const &faces, BaseMesh *mesh) {
    if (py::isinstance<py::array>(faces)) {
        py::array_t<int, py::array::c_style> const taken = TakeIndices(faces, "faces", 2);
        mesh->faceSizes.assign(std::size_t(taken.shape(0)), int(taken.shape(1)));
        mesh->faceVertices.assign(taken.data(), taken.data() + taken.size());
        return;
    }
    auto const check = [](py::handle object, std::string const &name) {
        if (!py::isinstance<py::iterable>(object)) {
            throw py::type_error("faces must be a list of lists of int; " + name + " is " +
                                 Py_TYPE(object.ptr())->tp_name);
        }
    };
    check(faces, "it");
    py::list all;
    for (py::handle const face : faces) {
        std::string const name = "faces[" + std::to_string(mesh->faceSizes.size()) + "]";
        check(face, name);
        py::array_t<int> const taken = TakeIndices(face, name.c_str());
        mesh->faceSizes.push_back(int(taken.size()));
        all.append(taken);
    }
    py::object const joined =
        all.empty() ? py::object(all) : py::module_::import("numpy").attr("concatenate")(all);
    mesh->faceVertices = takeVector(joined, "faces");
}

/// Takes creases or corners: a pair (components, sharpness).
std::pair<py::object, py::object> takePair(py::object const &object, char const *name) {
    if (!py::isinstance<py::tuple>(object) && !py::isinstance<py::list>(object)) {
        throw py::type_error(std::string(name) + ": a pair (indices, sharpness) is needed, not " +
                             Py_TYPE(object.ptr())->tp_name);
    }
    auto const pair = py::reinterpret_borrow<py::sequence>(object);
    if (pair.size() != 2) {
        throw py::value_error(std::string(name) + ": a pair (indices, sharpness) is needed, not " +
                              std::to_string(pair.size()) + " objects");
    }
    return {pair[0], pair[1]};
}

void takeTags(py::object const &creases, py::object const &corners, py::object const &holes,
              BaseMesh *mesh) {
    if (!creases.is_none()) {
        auto const [edges, sharpness] = takePair(creases, "creases");
        py::array_t<int, py::array::c_style> const vertices = TakeIndices(edges, "creases", 2);
        if (vertices.size() != 0 && vertices.shape(1) != 2) {
            throw py::value_error("creases: two vertices for each are needed, the shape is " +
                                  DescribeShape(vertices));
        }
        mesh->creaseVertices.assign(vertices.data(), vertices.data() + vertices.size());
        mesh->creaseSharpness = TakeFloats(sharpness, "creases", std::size_t(vertices.shape(0)));
    }
    if (!corners.is_none()) {
        auto const [vertices, sharpness] = takePair(corners, "corners");
        mesh->cornerVertices = takeVector(vertices, "corners");
        mesh->cornerSharpness = TakeFloats(sharpness, "corners", mesh->cornerVertices.size());
    }
    if (!holes.is_none()) {
        mesh->holes = takeVector(holes, "holes");
    }
}

void takeChannels(py::object const &fvarChannels, py::object const &numFVarValues, BaseMesh *mesh) {
    if (fvarChannels.is_none()) {
        if (!numFVarValues.is_none()) {
            throw py::value_error("num_fvar_values: there are no fvar_channels");
        }
        return;
    }
    for (py::handle const channel : fvarChannels) {
        std::string const name =
            "fvar_channels[" + std::to_string(mesh->channelValues.size()) + "]";
        mesh->channelValues.push_back(takeVector(channel, name.c_str()));
        if (mesh->channelValues.back().size() != mesh->faceVertices.size()) {
            throw py::value_error(
                name + ": one value for each of the " + std::to_string(mesh->faceVertices.size()) +
                " corners is needed, not " + std::to_string(mesh->channelValues.back().size()));
        }
    }
    std::vector<std::optional<int>> counts(mesh->channelValues.size());
    if (!numFVarValues.is_none()) {
        std::vector<int> const taken = takeVector(numFVarValues, "num_fvar_values");
        if (taken.size() != counts.size()) {
            throw py::value_error("num_fvar_values: one number for each of the " +
                                  std::to_string(counts.size()) + " fvar_channels is needed, not " +
                                  std::to_string(taken.size()));
        }
        std::copy(taken.begin(), taken.end(), counts.begin());
    }
    for (std::size_t i = 0; i < counts.size(); ++i) {
        mesh->numChannelValues.push_back(
            findCount(mesh->channelValues[i], counts[i], "num_fvar_values"));
    }
}

/// A mesh for the library, which refers to it.
struct Description {
    std::vector<Far::TopologyDescriptor::FVarChannel> channels;
    Far::TopologyDescriptor descriptor;

    explicit Description(BaseMesh const &mesh) {
        descriptor.numVertices = mesh.numVertices;
        descriptor.numFaces = int(mesh.faceSizes.size());
        descriptor.numVertsPerFace = mesh.faceSizes.data();
        descriptor.vertIndicesPerFace = mesh.faceVertices.data();
        descriptor.isLeftHanded = mesh.isLeftHanded;
        descriptor.numCreases = int(mesh.creaseSharpness.size());
        descriptor.creaseVertexIndexPairs = mesh.creaseVertices.data();
        descriptor.creaseWeights = mesh.creaseSharpness.data();
        descriptor.numCorners = int(mesh.cornerVertices.size());
        descriptor.cornerVertexIndices = mesh.cornerVertices.data();
        descriptor.cornerWeights = mesh.cornerSharpness.data();
        descriptor.numHoles = int(mesh.holes.size());
        descriptor.holeIndices = mesh.holes.data();
        for (std::size_t i = 0; i < mesh.channelValues.size(); ++i) {
            Far::TopologyDescriptor::FVarChannel channel;
            channel.numValues = mesh.numChannelValues[i];
            channel.valueIndices = mesh.channelValues[i].data();
            channels.push_back(channel);
        }
        descriptor.numFVarChannels = int(channels.size());
        descriptor.fvarChannels = channels.data();
    }
};

/// Makes level 0, without the interpreter's lock.
std::shared_ptr<Refiner> makeRefiner(BaseMesh mesh, CallStatus *status) {
    std::unique_ptr<TopologyRefiner> refiner;
    {
        py::gil_scoped_release const release;
        TopologyRefinerFactory::Options options;
        options.hexSchemeOptions = mesh.hexSchemeOptions;
        refiner = TopologyRefinerFactory::Create(Description(mesh).descriptor, mesh.sdcOptions,
                                                 options, status);
    }
    RaiseUnlessOk(*status);
    return std::make_shared<Refiner>(std::move(refiner), std::move(mesh));
}

std::shared_ptr<Refiner> createRefiner(py::object const &faces, std::optional<int> numVertices,
                                       py::object const &faceOffsets, py::object const &creases,
                                       py::object const &corners, py::object const &holes,
                                       py::object const &fvarChannels,
                                       py::object const &numFVarValues, bool isLeftHanded,
                                       py::object const &vtxBoundaryInterpolation,
                                       py::object const &fvarLinearInterpolation,
                                       py::object const &creasingMethod, py::object const &faceMask,
                                       py::object const &schemeType, py::object const &firstStep) {
    BaseMesh mesh;
    mesh.sdcOptions.SetVtxBoundaryInterpolation(
        TakeEnum<OpenSubdiv::Sdc::Options::VtxBoundaryInterpolation>(vtxBoundaryInterpolation,
                                                                     "vtx_boundary_interpolation"));
    mesh.sdcOptions.SetFVarLinearInterpolation(
        TakeEnum<OpenSubdiv::Sdc::Options::FVarLinearInterpolation>(fvarLinearInterpolation,
                                                                    "fvar_linear_interpolation"));
    mesh.sdcOptions.SetCreasingMethod(
        TakeEnum<OpenSubdiv::Sdc::Options::CreasingMethod>(creasingMethod, "creasing_method"));
    mesh.hexSchemeOptions.faceMask = TakeEnum<FaceMask>(faceMask, "face_mask");
    mesh.hexSchemeOptions.schemeType = TakeEnum<SchemeType>(schemeType, "scheme_type");
    mesh.hexSchemeOptions.firstStep = TakeEnum<FirstStep>(firstStep, "first_step");
    if (faceOffsets.is_none()) {
        takeListOfFaces(faces, &mesh);
    } else {
        takeFlatFaces(faces, faceOffsets, &mesh);
    }
    mesh.numVertices = findCount(mesh.faceVertices, numVertices, "num_vertices");
    mesh.isLeftHanded = isLeftHanded;
    takeTags(creases, corners, holes, &mesh);
    takeChannels(fvarChannels, numFVarValues, &mesh);

    CallStatus status;
    std::shared_ptr<Refiner> refiner = makeRefiner(std::move(mesh), &status);
    Warn(status);
    return refiner;
}

template <typename REAL>
void refineCoplanar(Refiner &self, Refinement refinement) {
    TopologyRefiner::CoplanarOptions options(refinement.level);
    options.angleTolerance = refinement.angleTolerance;
    options.closeGaps = refinement.closeGaps;
    options.fullTopologyInLastLevel = refinement.hasFullTopologyInLastLevel;
    std::vector<REAL> const positions(refinement.restPositions.begin(),
                                      refinement.restPositions.end());
    self.Change(std::move(refinement), [&](TopologyRefiner &refiner, CallStatus *status) {
        refiner.RefineCoplanar(positions.data(), options, status);
    });
}

void refine(Refiner &self, Refinement refinement) {
    if (!refinement.restPositions.empty()) {
        refinement.isDouble ? refineCoplanar<double>(self, std::move(refinement))
                            : refineCoplanar<float>(self, std::move(refinement));
        return;
    }
    TopologyRefiner::UniformOptions options(refinement.level);
    options.fullTopologyInLastLevel = refinement.hasFullTopologyInLastLevel;
    options.faceLabels = refinement.faceLabels;
    self.Change(std::move(refinement), [&](TopologyRefiner &refiner, CallStatus *status) {
        refiner.RefineUniform(options, status);
    });
}

void refineUniformly(Refiner &self, int level, bool fullTopologyInLastLevel,
                     py::object const &faceLabels) {
    Refinement refinement;
    refinement.level = level;
    refinement.hasFullTopologyInLastLevel = fullTopologyInLastLevel;
    if (!faceLabels.is_none()) {
        refinement.faceLabels = takeVector(faceLabels, "face_labels");
    }
    refine(self, std::move(refinement));
}

void refineByPositions(Refiner &self, py::object const &restPositions, int level,
                       double angleTolerance, bool closeGaps, bool fullTopologyInLastLevel) {
    Refinement refinement;
    refinement.level = level;
    refinement.hasFullTopologyInLastLevel = fullTopologyInLastLevel;
    refinement.angleTolerance = angleTolerance;
    refinement.closeGaps = closeGaps;
    refinement.isDouble = IsDouble(restPositions);
    auto const take = [&](auto const &positions) {
        if (positions.desc.length != 3) {
            throw py::value_error("rest_positions: x, y and z of each vertex are needed, the shape "
                                  "is " +
                                  DescribeShape(positions.array));
        }
        refinement.restPositions.assign(positions.data,
                                        positions.data + 3 * std::size_t(positions.count));
    };
    int const numVertices = self.GetMesh().numVertices;
    if (refinement.isDouble) {
        take(TakeSource<double>(restPositions, "rest_positions", numVertices, true));
    } else {
        take(TakeSource<float>(restPositions, "rest_positions", numVertices, true));
    }
    refine(self, std::move(refinement));
}

template <typename T>
py::array_t<T> makeArray(std::vector<T> const &values) {
    return py::array_t<T>(py::ssize_t(values.size()), values.data());
}

template <typename T>
std::vector<T> takeState(py::handle object) {
    auto const array = object.cast<py::array_t<T, py::array::c_style>>();
    return std::vector<T>(array.data(), array.data() + array.size());
}

/// The state of a refiner for pickle: the mesh, and how it is refined.
py::tuple getState(Refiner const &self) {
    BaseMesh const &mesh = self.GetMesh();
    py::list channels;
    for (std::vector<int> const &values : mesh.channelValues) {
        channels.append(makeArray(values));
    }
    Refinement const refinement = self.GetRefinement();
    return py::make_tuple(
        py::make_tuple(mesh.numVertices, mesh.isLeftHanded, makeArray(mesh.faceSizes),
                       makeArray(mesh.faceVertices), makeArray(mesh.creaseVertices),
                       makeArray(mesh.creaseSharpness), makeArray(mesh.cornerVertices),
                       makeArray(mesh.cornerSharpness), makeArray(mesh.holes), channels,
                       makeArray(mesh.numChannelValues)),
        py::make_tuple(mesh.sdcOptions.GetVtxBoundaryInterpolation(),
                       mesh.sdcOptions.GetFVarLinearInterpolation(),
                       mesh.sdcOptions.GetCreasingMethod(), mesh.hexSchemeOptions.faceMask,
                       mesh.hexSchemeOptions.schemeType, mesh.hexSchemeOptions.firstStep),
        py::make_tuple(refinement.level, refinement.hasFullTopologyInLastLevel,
                       makeArray(refinement.faceLabels), makeArray(refinement.restPositions),
                       refinement.isDouble, refinement.angleTolerance, refinement.closeGaps));
}

/// A refiner of that state, with the same numbers.  It does not warn again.
std::shared_ptr<Refiner> makeOfState(py::tuple const &state) {
    using Sdc = OpenSubdiv::Sdc::Options;
    py::tuple const arrays = state[0];
    py::tuple const options = state[1];
    py::tuple const levels = state[2];
    BaseMesh mesh;
    mesh.numVertices = arrays[0].cast<int>();
    mesh.isLeftHanded = arrays[1].cast<bool>();
    mesh.faceSizes = takeState<int>(arrays[2]);
    mesh.faceVertices = takeState<int>(arrays[3]);
    mesh.creaseVertices = takeState<int>(arrays[4]);
    mesh.creaseSharpness = takeState<float>(arrays[5]);
    mesh.cornerVertices = takeState<int>(arrays[6]);
    mesh.cornerSharpness = takeState<float>(arrays[7]);
    mesh.holes = takeState<int>(arrays[8]);
    for (py::handle const values : arrays[9]) {
        mesh.channelValues.push_back(takeState<int>(values));
    }
    mesh.numChannelValues = takeState<int>(arrays[10]);
    mesh.sdcOptions.SetVtxBoundaryInterpolation(options[0].cast<Sdc::VtxBoundaryInterpolation>());
    mesh.sdcOptions.SetFVarLinearInterpolation(options[1].cast<Sdc::FVarLinearInterpolation>());
    mesh.sdcOptions.SetCreasingMethod(options[2].cast<Sdc::CreasingMethod>());
    mesh.hexSchemeOptions.faceMask = options[3].cast<FaceMask>();
    mesh.hexSchemeOptions.schemeType = options[4].cast<SchemeType>();
    mesh.hexSchemeOptions.firstStep = options[5].cast<FirstStep>();
    Refinement refinement;
    refinement.level = levels[0].cast<int>();
    refinement.hasFullTopologyInLastLevel = levels[1].cast<bool>();
    refinement.faceLabels = takeState<int>(levels[2]);
    refinement.restPositions = takeState<double>(levels[3]);
    refinement.isDouble = levels[4].cast<bool>();
    refinement.angleTolerance = levels[5].cast<double>();
    refinement.closeGaps = levels[6].cast<bool>();

    CallStatus status;
    std::shared_ptr<Refiner> refiner = makeRefiner(std::move(mesh), &status);
    if (refinement.level > 0) {
        refine(*refiner, std::move(refinement));
    }
    return refiner;
}

template <typename T>
auto property(T (TopologyRefiner::*query)() const) {
    return [query](Refiner const &self) {
        return self.Read([query](TopologyRefiner const &refiner) { return (refiner.*query)(); });
    };
}

void checkChannel(TopologyRefiner const &refiner, int channel) {
    CheckIndex(channel, refiner.GetNumFVarChannels(), "channel");
}

} // namespace

void BindRefiner(py::module_ &module) {
    using Sdc = OpenSubdiv::Sdc::Options;
    py::class_<Refiner, std::shared_ptr<Refiner>>(
        module, "TopologyRefiner",
        "TopologyRefiner(faces, num_vertices=None, *, face_offsets=None, creases=None,\n"
        "                corners=None, holes=None, fvar_channels=None, num_fvar_values=None,\n"
        "                is_left_handed=False, vtx_boundary_interpolation='none',\n"
        "                fvar_linear_interpolation='all', creasing_method='uniform',\n"
        "                face_mask='average', scheme_type='hexagonal', first_step='none')\n\n"
        "The topology of a mesh and of its refinements, level by level.\n\n"
        "Args:\n"
        "    faces: the vertices of each face: a sequence of sequences, an integer array of the\n"
        "        shape (faces, sides) or, with face_offsets, one of all faces, shape (corners,)\n"
        "    num_vertices: vertices of the mesh; None: the largest index plus 1.  None raises\n"
        "        ValueError for more than 65536 that are also more than 16 for each corner: a "
        "wrong\n"
        "        index is likely\n"
        "    face_offsets: integers, shape (faces + 1,): face f has the corners from\n"
        "        face_offsets[f] to face_offsets[f + 1]\n"
        "    creases: a pair (edges, sharpness) of integers, shape (creases, 2), and numbers, "
        "shape\n"
        "        (creases,), or one number for all; from 10 on a crease is infinitely sharp\n"
        "    corners: a pair (vertices, sharpness) of the same kind\n"
        "    holes: faces that are not drawn\n"
        "    fvar_channels: for each face-varying channel the values at the corners: integers,\n"
        "        shape (corners,)\n"
        "    num_fvar_values: the number of values of each channel; None: as for num_vertices\n"
        "    is_left_handed: whether the faces run clockwise\n"
        "    vtx_boundary_interpolation and all after it: a value of the enumeration, or its "
        "name\n\n"
        "The defaults are the paper's, as in C++ and hexrefine.  Renderers want "
        "face_mask='smooth',\n"
        "vtx_boundary_interpolation='edge_and_corner' and, for triangles, first_step='truncate', "
        "as\n"
        "hexrefine --like renderer.  hexview and the Blender add-on begin with 'smooth'.\n\n"
        "Integers may have any type and are copied.  Raises StatusError for a mesh that cannot be\n"
        "refined; its code, component and index say why.  Warns with StatusWarning.\n\n"
        "Threads may share a refiner.  While views of its levels exist, refining again raises\n"
        "BufferError.  Copies and pickled refiners have the same mesh, levels and bits.")
        .def(py::init(&createRefiner), py::arg("faces"), py::arg("num_vertices") = py::none(),
             py::kw_only(), py::arg("face_offsets") = py::none(), py::arg("creases") = py::none(),
             py::arg("corners") = py::none(), py::arg("holes") = py::none(),
             py::arg("fvar_channels") = py::none(), py::arg("num_fvar_values") = py::none(),
             py::arg("is_left_handed") = false, py::arg("vtx_boundary_interpolation") = "none",
             py::arg("fvar_linear_interpolation") = "all", py::arg("creasing_method") = "uniform",
             py::arg("face_mask") = "average", py::arg("scheme_type") = "hexagonal",
             py::arg("first_step") = "none")
        .def(py::pickle(&getState, &makeOfState))
        .def("refine_uniform", &refineUniformly,
             "refine_uniform(level, full_topology_in_last_level=False, face_labels=None)\n\n"
             "Refines all faces up to a level; replaces earlier refinements.  Raises "
             "StatusError.\n\n"
             "Args:\n"
             "    full_topology_in_last_level: False: the last level has the vertices of its faces "
             "alone\n"
             "    face_labels: a label for each base face, integers, shape (faces,): with "
             "first_step\n"
             "        'truncate' no face spans base faces of different labels",
             py::arg("level"), py::arg("full_topology_in_last_level") = false,
             py::arg("face_labels") = py::none())
        .def("refine_coplanar", &refineByPositions,
             "refine_coplanar(rest_positions, level, angle_tolerance=0.1, close_gaps=True,\n"
             "                full_topology_in_last_level=False)\n\n"
             "Refines by the paper's stage 3: edges between coplanar faces make quads.\n\n"
             "Args:\n"
             "    rest_positions: float64, or numbers taken as float32, shape (vertices, 3)\n"
             "    angle_tolerance: faces whose normals differ by at most so many degrees are "
             "coplanar\n"
             "    close_gaps: False leaves the gaps open, as the paper prints them",
             py::arg("rest_positions"), py::arg("level"), py::arg("angle_tolerance") = 0.1,
             py::arg("close_gaps") = true, py::arg("full_topology_in_last_level") = false)
        .def(
            "unrefine",
            [](Refiner &self) {
                self.Change(Refinement(),
                            [](TopologyRefiner &refiner, CallStatus *) { refiner.Unrefine(); });
            },
            "unrefine()\n\nRemoves all levels but the base.")
        .def(
            "get_level",
            [](std::shared_ptr<Refiner> const &self, int level) { return Level(self, level); },
            "get_level(level)\n\n"
            "The TopologyLevel of a level, 0 ... max_level.",
            py::arg("level"))
        .def_property_readonly("num_levels", property(&TopologyRefiner::GetNumLevels),
                               "Number of levels, including level 0.")
        .def_property_readonly("max_level", property(&TopologyRefiner::GetMaxLevel),
                               "The last level.")
        .def_property_readonly("is_uniform", property(&TopologyRefiner::IsUniform),
                               "False after refine_coplanar.")
        .def_property_readonly("has_holes", property(&TopologyRefiner::HasHoles),
                               "Whether faces are holes.")
        .def_property_readonly("num_fvar_channels", property(&TopologyRefiner::GetNumFVarChannels),
                               "Face-varying channels.")
        .def_property_readonly("num_vertices_total",
                               property(&TopologyRefiner::GetNumVerticesTotal),
                               "Sum over all levels.")
        .def_property_readonly("num_edges_total", property(&TopologyRefiner::GetNumEdgesTotal),
                               "Sum over all levels.")
        .def_property_readonly("num_faces_total", property(&TopologyRefiner::GetNumFacesTotal),
                               "Sum over all levels.")
        .def_property_readonly("num_face_vertices_total",
                               property(&TopologyRefiner::GetNumFaceVerticesTotal),
                               "Sum over all levels.")
        .def(
            "get_num_fvar_values_total",
            [](Refiner const &self, int channel) {
                return self.Read([channel](TopologyRefiner const &refiner) {
                    checkChannel(refiner, channel);
                    return refiner.GetNumFVarValuesTotal(channel);
                });
            },
            "get_num_fvar_values_total(channel=0)\n\nSum over all levels.", py::arg("channel") = 0)
        .def(
            "get_fvar_linear_interpolation",
            [](Refiner const &self, int channel) {
                return self.Read([channel](TopologyRefiner const &refiner) {
                    checkChannel(refiner, channel);
                    return refiner.GetFVarLinearInterpolation(channel);
                });
            },
            "get_fvar_linear_interpolation(channel=0)\n\nThe FVarLinearInterpolation of a channel.",
            py::arg("channel") = 0)
        .def_property_readonly(
            "vtx_boundary_interpolation",
            [](Refiner const &self) -> Sdc::VtxBoundaryInterpolation {
                return self.Read([](TopologyRefiner const &refiner) {
                    return refiner.GetSchemeOptions().GetVtxBoundaryInterpolation();
                });
            },
            "The VtxBoundaryInterpolation that was given.")
        .def_property_readonly(
            "creasing_method",
            [](Refiner const &self) -> Sdc::CreasingMethod {
                return self.Read([](TopologyRefiner const &refiner) {
                    return refiner.GetSchemeOptions().GetCreasingMethod();
                });
            },
            "The CreasingMethod that was given.")
        .def_property_readonly(
            "face_mask",
            [](Refiner const &self) {
                return self.Read([](TopologyRefiner const &refiner) {
                    return refiner.GetHexSchemeOptions().faceMask;
                });
            },
            "The FaceMask that was given.")
        .def_property_readonly(
            "scheme_type",
            [](Refiner const &self) {
                return self.Read([](TopologyRefiner const &refiner) {
                    return refiner.GetHexSchemeOptions().schemeType;
                });
            },
            "The SchemeType that was given.")
        .def_property_readonly(
            "first_step",
            [](Refiner const &self) {
                return self.Read([](TopologyRefiner const &refiner) {
                    return refiner.GetHexSchemeOptions().firstStep;
                });
            },
            "The FirstStep that was given.");
}

} // namespace OpenSubdivHex::Python
