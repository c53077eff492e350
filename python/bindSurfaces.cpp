// SPDX-License-Identifier: Apache-2.0
#include "arrays.h"
#include "errors.h"
#include "options.h"
#include "surfaces.h"

#include "bfr_ext/surfacePlaces.h"
#include "far_ext/stencilTableFactory.h"

#include <cmath>
#include <utility>

namespace OpenSubdivHex::Python {

namespace {

using BfrExt::LevelTessellation;
using Points = py::array_t<double>;
using PointDescriptor = BfrExt::Surface<double>::PointDescriptor;

FaceTessellation makeTessellation(int faceSize, py::object const &levels, int facetSize,
                                  bool isHalf) {
    if (faceSize < 3) {
        throw py::value_error("face_size: " + std::to_string(faceSize) + " is less than 3");
    }
    std::vector<int> numbers;
    if (py::isinstance<py::int_>(levels)) {
        numbers.push_back(levels.cast<int>());
    } else {
        py::array_t<int> const array = TakeIndices(levels, "levels");
        numbers.assign(array.data(), array.data() + array.size());
    }
    int const count = int(numbers.size());
    if (count != 1 && count != faceSize && count != faceSize + 1) {
        throw py::value_error("levels: " + std::to_string(count) + " of them, not 1, " +
                              std::to_string(faceSize) + " or " + std::to_string(faceSize + 1));
    }
    for (int const level : numbers) {
        if (level < 0 || level > LevelTessellation::kLastLevel) {
            throw py::value_error("levels: " + std::to_string(level) + " is not one of 0 ... " +
                                  std::to_string(LevelTessellation::kLastLevel));
        }
    }
    CheckFacetSize(facetSize);
    py::gil_scoped_release const release;
    return FaceTessellation(
        LevelTessellation(BfrExt::Parameterization({faceSize, isHalf}), count, numbers.data(),
                          LevelTessellation::Options().SetFacetSize(facetSize)));
}

/// Pairs of u and v: \p count, or any number for -1.
std::vector<double> takePlaces(py::object const &uv, int count = -1) {
    Elements<double const> const source = TakeSource<double>(uv, "uv", count, true);
    if (source.desc.length != 2) {
        throw py::value_error("uv: u and v of each place are needed, the shape is " +
                              DescribeShape(source.array));
    }
    std::vector<double> places(source.data, source.data + 2 * std::size_t(source.count));
    for (std::size_t i = 0; i < places.size(); ++i) {
        if (!std::isfinite(places[i])) {
            throw py::value_error("uv: row " + std::to_string(i / 2) + " is not finite");
        }
    }
    return places;
}

/// A surface, and how many points its mesh has.
class FaceSurface {
public:
    FaceSurface(BfrExt::Surface<double> surface, int numMeshPoints)
        : _surface(std::move(surface)), _numMeshPoints(numMeshPoints) {}

    int GetFaceSize() const { return _surface.GetFaceSize(); }
    bool IsHalf() const { return _surface.GetFaceShape().isHalf; }
    py::array_t<int> GetControlPoints() const {
        std::vector<int> indices(std::size_t(_surface.GetNumControlPoints()));
        _surface.GetControlPointIndices(indices.data());
        return TakeOver(std::move(indices));
    }

    py::object Evaluate(py::object const &uv, py::object const &points) const {
        return std::move(evaluate(uv, points, 1)[0]);
    }
    py::tuple EvaluateWithDerivatives(py::object const &uv, py::object const &points) const {
        std::vector<py::object> results = evaluate(uv, points, 3);
        return py::make_tuple(results[0], results[1], results[2]);
    }
    py::tuple EvaluateWithSecondDerivatives(py::object const &uv, py::object const &points) const {
        std::vector<py::object> results = evaluate(uv, points, 6);
        return py::make_tuple(results[0], results[1], results[2], results[3], results[4],
                              results[5]);
    }
    Points EvaluateStencil(py::object const &uv) const {
        std::vector<double> const places = takePlaces(uv);
        auto const numPlaces = py::ssize_t(places.size() / 2);
        Points weights({numPlaces, py::ssize_t(_surface.GetNumControlPoints())});
        double *const data = weights.mutable_data();
        py::gil_scoped_release const release;
        for (py::ssize_t i = 0; i < numPlaces; ++i) {
            _surface.EvaluateStencil(places.data() + 2 * i,
                                     data + i * _surface.GetNumControlPoints());
        }
        return weights;
    }
    py::tuple Bound(py::object const &points) const {
        int length = 0;
        std::vector<double> const controlPoints = gather(points, &length);
        Points low(length);
        Points high(length);
        _surface.BoundControlPoints(controlPoints.data(), PointDescriptor(length),
                                    low.mutable_data(), high.mutable_data());
        return py::make_tuple(low, high);
    }

private:
    /// The control points among those of the mesh, side by side.
    std::vector<double> gather(py::object const &points, int *length) const {
        std::vector<double> result;
        auto const take = [&](auto real) {
            using REAL = decltype(real);
            Elements<REAL const> const source = TakeSource<REAL>(points, "points", _numMeshPoints);
            *length = source.desc.length;
            result.resize(std::size_t(_surface.GetNumControlPoints()) * std::size_t(*length));
            _surface.GatherControlPoints(source.data, PointDescriptor(*length, source.desc.stride),
                                         result.data(), PointDescriptor(*length));
        };
        // Numbers of float32 are read where they are: few of them are control points.
        if (py::isinstance<py::array_t<float>>(points)) {
            take(float());
        } else {
            take(double());
        }
        return result;
    }

    /// Points, points and first derivatives, or those and second ones.
    std::vector<py::object> evaluate(py::object const &uv, py::object const &points,
                                     int numResults) const {
        int length = 0;
        std::vector<double> patchPoints = gather(points, &length);
        bool const isPattern = py::isinstance<FaceTessellation>(uv);
        std::vector<double> const places = isPattern ? std::vector<double>() : takePlaces(uv);
        LevelTessellation const *const pattern =
            isPattern ? &uv.cast<FaceTessellation const &>().Get() : nullptr;
        if (pattern && pattern->GetFaceShape() != _surface.GetFaceShape()) {
            auto const getName = [](FarExt::FaceShape shape) {
                return std::to_string(shape.size) + " edges" + (shape.isHalf ? ", a half" : "");
            };
            throw py::value_error("uv: a tessellation of " + getName(pattern->GetFaceShape()) +
                                  ", but the face has " + getName(_surface.GetFaceShape()));
        }
        auto const numPlaces =
            pattern ? py::ssize_t(pattern->GetNumCoords()) : py::ssize_t(places.size() / 2);
        std::vector<Points> results;
        std::vector<double *> data;
        for (int i = 0; i < numResults; ++i) {
            results.emplace_back(std::vector<py::ssize_t>{numPlaces, py::ssize_t(length)});
            data.push_back(results.back().mutable_data());
        }
        {
            py::gil_scoped_release const release;
            PointDescriptor const desc(length);
            if (pattern && numResults == 1) {
                _surface.Evaluate(*pattern, patchPoints.data(), desc, data[0], desc);
            } else if (pattern && numResults == 3) {
                _surface.Evaluate(*pattern, patchPoints.data(), desc, data[0], data[1], data[2],
                                  desc);
            } else if (pattern) {
                _surface.Evaluate(*pattern, patchPoints.data(), desc, data[0], data[1], data[2],
                                  data[3], data[4], data[5], desc);
            }
            if (!pattern) {
                patchPoints.resize(std::size_t(_surface.GetNumPatchPoints()) * std::size_t(length));
                _surface.ComputePatchPoints(patchPoints.data(), desc);
            }
            for (std::size_t i = 0; i < places.size() / 2; ++i) {
                double const *const place = places.data() + 2 * i;
                std::size_t const first = i * std::size_t(length);
                if (numResults == 1) {
                    _surface.Evaluate(place, patchPoints.data(), desc, data[0] + first);
                } else if (numResults == 3) {
                    _surface.Evaluate(place, patchPoints.data(), desc, data[0] + first,
                                      data[1] + first, data[2] + first);
                } else {
                    _surface.Evaluate(place, patchPoints.data(), desc, data[0] + first,
                                      data[1] + first, data[2] + first, data[3] + first,
                                      data[4] + first, data[5] + first);
                }
            }
        }
        return {results.begin(), results.end()};
    }

    BfrExt::Surface<double> _surface;
    int _numMeshPoints;
};

bool hasLimitSurface(FaceSurfaceFactory const &self, int face) {
    CheckIndex(face, self.GetNumFaces(), "face");
    return self.Read([&](BfrExt::SurfaceFactory const &factory) {
        FarExt::CallStatus ignored;
        return factory.FaceHasLimitSurface(face, &ignored);
    });
}

py::tuple getLevelFaces(FaceSurfaceFactory const &self) {
    std::vector<int> faces;
    std::vector<int> halves;
    self.Read([&](BfrExt::SurfaceFactory const &factory) {
        for (int face = 0; face < factory.GetNumFaces(); ++face) {
            auto const [levelFace, half] = factory.GetFaces().GetLevelFace(face);
            faces.push_back(levelFace);
            halves.push_back(half);
        }
    });
    return py::make_tuple(TakeOver(std::move(faces)), TakeOver(std::move(halves)));
}

py::tuple findSurfacePlaces(FaceSurfaceFactory const &self, py::object const &faces,
                            py::object const &uv) {
    py::array_t<int> const controlFaces = TakeIndices(faces, "faces");
    auto const numPlaces = std::size_t(controlFaces.size());
    std::vector<double> const controlCoords = takePlaces(uv, int(numPlaces));
    std::vector<int> surfaceFaces(numPlaces);
    Points surfaceCoords({py::ssize_t(numPlaces), py::ssize_t(2)});
    int const *const read = controlFaces.data();
    double *const write = surfaceCoords.mutable_data();
    FarExt::CallStatus status;
    self.Read([&](BfrExt::SurfaceFactory const &factory) {
        for (std::size_t i = 0; i < numPlaces && status.IsOk(); ++i) {
            factory.FindSurfacePlace(read[i], &controlCoords[2 * i], &surfaceFaces[i],
                                     write + 2 * i, &status);
        }
    });
    RaiseUnlessOk(status);
    return py::make_tuple(TakeOver(std::move(surfaceFaces)), surfaceCoords);
}

// Lists get(faces, local) for the vertices or edges of a face.
template <typename GET>
py::array_t<int> listAround(FaceSurfaceFactory const &self, int face, GET const &get) {
    CheckIndex(face, self.GetNumFaces(), "face");
    return TakeOver(self.Read([&](BfrExt::SurfaceFactory const &factory) {
        FarExt::SurfaceFaces const &faces = factory.GetFaces();
        std::vector<int> result;
        for (int local = 0; local < faces.GetShape(face).size; ++local) {
            result.push_back(get(faces, local));
        }
        return result;
    }));
}

py::array_t<int> getFaceVertices(FaceSurfaceFactory const &self, int face) {
    return listAround(self, face, [face](FarExt::SurfaceFaces const &faces, int local) {
        return faces.GetVertex(face, local);
    });
}

py::array_t<int> getFaceEdges(FaceSurfaceFactory const &self, int face) {
    return listAround(self, face, [face](FarExt::SurfaceFaces const &faces, int local) {
        return faces.GetEdge(face, local).edge;
    });
}

template <typename INIT>
FaceSurface makeSurface(FaceSurfaceFactory const &self, int face, int numMeshPoints,
                        INIT const &init) {
    CheckIndex(face, self.GetNumFaces(), "face");
    BfrExt::Surface<double> surface;
    FarExt::CallStatus status;
    self.Read(
        [&](BfrExt::SurfaceFactory const &factory) { return init(factory, &surface, &status); });
    RaiseUnlessOk(status);
    return {std::move(surface), numMeshPoints};
}

FaceSurface makeVertexSurface(FaceSurfaceFactory const &self, int face) {
    return makeSurface(self, face, self.CountVertices(),
                       [&](auto const &factory, auto *surface, auto *status) {
                           return factory.InitVertexSurface(face, surface, status);
                       });
}
FaceSurface makeVaryingSurface(FaceSurfaceFactory const &self, int face) {
    return makeSurface(self, face, self.CountVertices(),
                       [&](auto const &factory, auto *surface, auto *status) {
                           return factory.InitVaryingSurface(face, surface, status);
                       });
}
FaceSurface makeFaceVaryingSurface(FaceSurfaceFactory const &self, int face, int channel) {
    CheckIndex(channel, self.GetNumFVarChannels(), "channel");
    return makeSurface(self, face, self.CountValues(channel),
                       [&](auto const &factory, auto *surface, auto *status) {
                           return factory.InitFaceVaryingSurface(face, surface, channel, status);
                       });
}

/// BfrExt::SurfacePlaces, and how many points its mesh has.
class Places {
public:
    Places(FaceSurfaceFactory const &factory, py::object const &faces, py::object const &uv,
           py::object const &interpolationMode, int fvarChannel) {
        using FarExt::StencilMode;
        py::array_t<int> const ofPlaces = TakeIndices(faces, "faces");
        int const *const indices = ofPlaces.data();
        auto const numPlaces = int(ofPlaces.size());
        for (int i = 0; i < numPlaces; ++i) {
            if (indices[i] < 0 || indices[i] >= factory.GetNumFaces()) {
                throw py::index_error("faces: row " + std::to_string(i) + " is " +
                                      std::to_string(indices[i]) + ", not one of the " +
                                      std::to_string(factory.GetNumFaces()) + " faces");
            }
        }
        std::vector<double> const coords = takePlaces(uv, numPlaces);
        BfrExt::SurfacePlaces<double>::Options options;
        options.interpolationMode = TakeEnum<StencilMode>(interpolationMode, "interpolation_mode");
        options.fvarChannel = fvarChannel;
        bool const isOfChannel = options.interpolationMode == FarExt::INTERPOLATE_FACE_VARYING;
        if (isOfChannel) {
            CheckIndex(fvarChannel, factory.GetNumFVarChannels(), "fvar_channel");
        }
        _numMeshPoints = isOfChannel ? factory.CountValues(fvarChannel) : factory.CountVertices();
        FarExt::CallStatus status;
        factory.Read([&](BfrExt::SurfaceFactory const &surfaces) {
            _places = BfrExt::SurfacePlaces<double>::Create(surfaces, numPlaces, indices,
                                                            coords.data(), options, &status);
        });
        RaiseUnlessOk(status);
    }

    int GetNumPlaces() const { return _places->GetNumPlaces(); }

    Points Evaluate(py::object const &points) const {
        auto const source = TakeSource<double>(points, "points", _numMeshPoints);
        Points result = makeResult(source.desc.length);
        double *const p = result.mutable_data();
        py::gil_scoped_release const release;
        _places->Evaluate(source.data, PointDescriptor(source.desc.length, source.desc.stride), p,
                          PointDescriptor(source.desc.length));
        return result;
    }
    py::tuple EvaluateWithDerivatives(py::object const &points) const {
        auto const source = TakeSource<double>(points, "points", _numMeshPoints);
        Points results[3];
        double *data[3];
        for (int i = 0; i < 3; ++i) {
            results[i] = makeResult(source.desc.length);
            data[i] = results[i].mutable_data();
        }
        {
            py::gil_scoped_release const release;
            _places->Evaluate(source.data, PointDescriptor(source.desc.length, source.desc.stride),
                              data[0], data[1], data[2], PointDescriptor(source.desc.length));
        }
        return py::make_tuple(results[0], results[1], results[2]);
    }

private:
    Points makeResult(int length) const {
        return Points({py::ssize_t(GetNumPlaces()), py::ssize_t(length)});
    }

    std::unique_ptr<BfrExt::SurfacePlaces<double>> _places;
    int _numMeshPoints = 0;
};

} // namespace

void CheckFacetSize(int size) {
    if (size != 0 && size != 3 && size != 4) {
        throw py::value_error("facet_size: " + std::to_string(size) + " is not 3, 4 or 0");
    }
}

void BindSurfaces(py::module_ &module) {
    py::class_<FaceTessellation>(
        module, "LevelTessellation",
        "LevelTessellation(face_size, levels, facet_size=3, is_half=False)\n\n"
        "A base face cut into facets.  Two faces are watertight if they have the same level for "
        "their\n"
        "common edge.\n\n"
        "Args:\n"
        "    face_size: number of vertices of the face\n"
        "    levels: 0 ... 12: one level for all; or one for each edge, where edge i runs from "
        "vertex i\n"
        "        to the next; or one for each edge, then one for the inside\n"
        "    facet_size: 3: triangles; 4: quads where all cells are quads, else triangles padded "
        "with\n"
        "        -1; 0: polygons\n"
        "    is_half: whether the face is half a polygon (Surface.is_half)")
        .def(py::init(&makeTessellation), py::arg("face_size"), py::arg("levels"),
             py::arg("facet_size") = 3, py::arg("is_half") = false)
        .def(py::pickle(
            [](FaceTessellation const &self) {
                std::vector<int> levels = self.GetLevels();
                if (levels.empty() || self.Get().GetNumSections() > 1) {
                    throw py::type_error("a LevelTessellation of a CellForest, or of a section of "
                                         "a face, cannot be pickled");
                }
                return py::make_tuple(self.Get().GetFaceSize(), std::move(levels),
                                      self.Get().GetFacetSize(), self.Get().GetFaceShape().isHalf);
            },
            [](py::tuple const &state) {
                return makeTessellation(state[0].cast<int>(), state[1], state[2].cast<int>(),
                                        state[3].cast<bool>());
            }))
        .def_property_readonly(
            "face_size", [](FaceTessellation const &self) { return self.Get().GetFaceSize(); },
            "Vertices of the face.")
        .def_property_readonly(
            "is_half",
            [](FaceTessellation const &self) { return self.Get().GetFaceShape().isHalf; },
            "Whether the face is half a polygon, cut along its edge 0.")
        .def_property_readonly(
            "levels", &FaceTessellation::GetLevels,
            "Levels of the edges, then the level of the inside; empty for a face of a CellForest.")
        .def_property_readonly(
            "facet_size", [](FaceTessellation const &self) { return self.Get().GetFacetSize(); },
            "3 for triangles, 4 for quads and triangles, 0 for polygons.")
        .def_property_readonly("coords", &FaceTessellation::GetCoords,
                               "float64, shape (points, 2): u and v of each point.  The boundary "
                               "comes first, from vertex 0 on.")
        .def_property_readonly(
            "num_boundary_coords",
            [](FaceTessellation const &self) { return self.Get().GetNumBoundaryCoords(); },
            "Number of points on the boundary.")
        .def_property_readonly("facet_sizes", &FaceTessellation::GetFacetSizes,
                               "int32: the number of corners of each facet.")
        .def_property_readonly("facets", &FaceTessellation::GetFacets,
                               "int32: indices of points, shape (facets, facet_size); with facet "
                               "size 0 the corners of\n"
                               "all polygons in one array.");

    py::class_<FaceSurface>(
        module, "Surface",
        "The limit surface of a base face, made by a SurfaceFactory: a function of u and v.\n\n"
        "Positions of the mesh have the shape (points,) or (points, length); float32 and float64 "
        "are\n"
        "read in place.  uv has the shape (n, 2), or is a LevelTessellation.  Results are "
        "float64.\n\n"
        "Points of a LevelTessellation, and stencils, are exact.  Points at (u, v) lie on bicubic\n"
        "patches, some millionths of the mesh's size from the surface.")
        .def_property_readonly("face_size", &FaceSurface::GetFaceSize, "Vertices of the face.")
        .def_property_readonly("is_half", &FaceSurface::IsHalf,
                               "Whether the face is half a polygon, cut along its edge 0.")
        .def_property_readonly(
            "control_points", &FaceSurface::GetControlPoints,
            "int32: the points of the mesh that the surface depends on; the face's own come first.")
        .def("evaluate", &FaceSurface::Evaluate,
             "evaluate(uv, points)\n\n"
             "Points of the surface, shape (n, length).",
             py::arg("uv"), py::arg("points"))
        .def("evaluate_with_derivatives", &FaceSurface::EvaluateWithDerivatives,
             "evaluate_with_derivatives(uv, points)\n\n"
             "Returns (points, du, dv), each of the shape (n, length).",
             py::arg("uv"), py::arg("points"))
        .def("evaluate_with_second_derivatives", &FaceSurface::EvaluateWithSecondDerivatives,
             "evaluate_with_second_derivatives(uv, points)\n\n"
             "Returns (points, du, dv, duu, duv, dvv), each of the shape (n, length).  Second "
             "derivatives\n"
             "exist with face mask 'smooth', except at single points, such as extraordinary "
             "vertices.",
             py::arg("uv"), py::arg("points"))
        .def(
            "evaluate_stencil", &FaceSurface::EvaluateStencil,
            "evaluate_stencil(uv)\n\n"
            "Weights of the control points, shape (n, control points), for uv of the shape (n, 2).",
            py::arg("uv"))
        .def("bound", &FaceSurface::Bound,
             "bound(points)\n\nReturns (low, high), the box of the control points, in which the "
             "surface lies.",
             py::arg("points"));

    py::class_<FaceSurfaceFactory, std::shared_ptr<FaceSurfaceFactory>>(
        module, "SurfaceFactory",
        "SurfaceFactory(refiner)\n\n"
        "Makes the limit surfaces of the faces of level 0.  The refiner needs no refinement.\n\n"
        "With a first step the faces and the points of the mesh are those of level 1: refine to "
        "level 1\n"
        "with full topology before.  After the refiner was refined again, the factory raises\n"
        "RuntimeError.\n\n"
        "A face of the level that an infinitely sharp crease crosses is two faces here, half a "
        "polygon each,\n"
        "with normals of its own along the crease: half 0 has the number of the face, and halves 1 "
        "follow\n"
        "all faces of the level (get_level_faces()).\n\n"
        "Raises StatusError if level 1 is missing, and for levels that no hexagonal step made.")
        .def(py::init<std::shared_ptr<Refiner>>(), py::arg("refiner").none(false))
        .def_property_readonly("num_faces", &FaceSurfaceFactory::GetNumFaces, "Number of faces.")
        .def_property_readonly("num_edges", &FaceSurfaceFactory::GetNumEdges,
                               "Number of edges, diagonals between halves included.")
        .def("get_level_faces", &getLevelFaces,
             "get_level_faces()\n\n"
             "Returns (faces, halves), int32, shape (num_faces,): the face of the level, and which "
             "half of\n"
             "it where it is cut, else 0.")
        .def("get_face_vertices", &getFaceVertices,
             "get_face_vertices(face)\n\n"
             "int32, shape (n,): the vertices of a face; (u, v) of vertex 0 are (0, 0).",
             py::arg("face"))
        .def(
            "get_face_edges", &getFaceEdges,
            "get_face_edges(face)\n\n"
            "int32, shape (n,): the edges of a face.  Edge i joins its vertices i and i + 1.  The "
            "edge\n"
            "between two halves of a face, edge 0 of both, has a number behind those of the level.",
            py::arg("face"))
        .def("has_limit_surface", &hasLimitSurface,
             "has_limit_surface(face)\n\n"
             "False for holes, for faces at a boundary with vtx_boundary_interpolation 'none', and "
             "for faces\n"
             "that depend on too many others.  vertex_surface() raises an error with the cause.",
             py::arg("face"))
        .def(
            "find_surface_places", &findSurfacePlaces,
            "find_surface_places(faces, uv)\n\n"
            "Returns (faces, uv) of places on the control mesh, for SurfacePlaces: with first step "
            "'truncate'\n"
            "those of level 1, else what was given.\n\n"
            "Args:\n"
            "    faces: faces of level 0, integers, shape (n,)\n"
            "    uv: u and v in each face, inside of it, shape (n, 2)\n\n"
            "Raises StatusError for a face out of range, and with first step 'tri_hex'.",
            py::arg("faces"), py::arg("uv"))
        .def("vertex_surface", &makeVertexSurface,
             "vertex_surface(face)\n\nThe Surface of vertex data.  Raises StatusError where the "
             "face has none.",
             py::arg("face"))
        .def("varying_surface", &makeVaryingSurface,
             "varying_surface(face)\n\nThe Surface of varying data.", py::arg("face"))
        .def("face_varying_surface", &makeFaceVaryingSurface,
             "face_varying_surface(face, channel=0)\n\nThe Surface of face-varying data, "
             "whose points are values of the channel.",
             py::arg("face"), py::arg("channel") = 0);

    py::class_<Places>(
        module, "SurfacePlaces",
        "SurfacePlaces(factory, faces, uv, *, interpolation_mode='vertex', fvar_channel=0)\n\n"
        "Evaluates many (face, u, v) together, in any order, in every frame, in parallel: ray "
        "hits,\n"
        "samples, roots of hair.  It does not need the factory afterwards.  Points have the bits "
        "of\n"
        "Surface.evaluate().\n\n"
        "Args:\n"
        "    factory: a SurfaceFactory\n"
        "    faces: integers, shape (n,)\n"
        "    uv: u and v in each face, shape (n, 2); (u, v) outside the face is moved to its "
        "boundary\n"
        "    interpolation_mode: 'vertex', 'varying' or 'face_varying'\n"
        "    fvar_channel: the channel, with 'face_varying'\n\n"
        "Raises IndexError for a face out of range and ValueError for uv that are not finite, "
        "which\n"
        "name the row, and StatusError for a face without a surface.")
        .def(py::init<FaceSurfaceFactory const &, py::object, py::object, py::object, int>(),
             py::arg("factory").none(false), py::arg("faces"), py::arg("uv"), py::kw_only(),
             py::arg("interpolation_mode") = "vertex", py::arg("fvar_channel") = 0)
        .def_property_readonly("num_places", &Places::GetNumPlaces, "Number of (face, u, v).")
        .def("evaluate", &Places::Evaluate,
             "evaluate(points)\n\n"
             "A point for each (face, u, v): float64, shape (n, length).\n\n"
             "Args:\n"
             "    points: positions of the mesh, shape (points,) or (points, length); float64 is "
             "read\n"
             "        in place",
             py::arg("points"))
        .def("evaluate_with_derivatives", &Places::EvaluateWithDerivatives,
             "evaluate_with_derivatives(points)\n\n"
             "Returns (points, du, dv), each of the shape (n, length).",
             py::arg("points"));
}

} // namespace OpenSubdivHex::Python
