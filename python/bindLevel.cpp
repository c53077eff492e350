// SPDX-License-Identifier: Apache-2.0
//
// TopologyLevel: relations as arrays that show the level's memory, and tags as new ones; and
// LimitSides and triangles, which are made of a level.
#include "arrays.h"
#include "options.h"
#include "refiner.h"

#include "far_ext/baseFaceMap.h"
#include "far_ext/stencilTableFactory.h"
#include "osd_ext/polygonIndices.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>

namespace OpenSubdivHex::Python {

namespace {

using namespace FarExt;
using Index = Far::Index;

/// A property that shows a relation: all face-vertices, or one of the others.
auto relation(Far::ConstIndexArray (TopologyLevel::*query)() const, bool isOfFaceVertices = false,
              int width = 1) {
    return [=](Level const &self) {
        // Before the array's memory is looked for, so that it stays where it is from here on.
        py::capsule const pin = self.GetRefiner().Pin();
        auto const find = [query](TopologyLevel const &level) { return (level.*query)(); };
        Far::ConstIndexArray const array = isOfFaceVertices ? self.Read(find) : self.ReadFull(find);
        std::vector<py::ssize_t> shape = {array.size() / width};
        if (width > 1) {
            shape.push_back(width);
        }
        return View(array.begin(), shape, pin);
    };
}

template <typename T>
auto count(T (TopologyLevel::*query)() const) {
    return [query](Level const &self) {
        return self.Read([query](TopologyLevel const &level) { return (level.*query)(); });
    };
}

/// A function that makes an array with query(level, i) for each of the level's components.
template <typename T, typename QUERY>
auto makeArray(int (TopologyLevel::*size)() const, bool isFull, QUERY query) {
    return [=](Level const &self) {
        auto const fill = [=](TopologyLevel const &level) {
            std::vector<T> values(std::size_t((level.*size)()));
            for (std::size_t i = 0; i < values.size(); ++i) {
                values[i] = T((level.*query)(Index(i)));
            }
            return values;
        };
        return TakeOver<T>(isFull ? self.ReadFull(fill) : self.Read(fill));
    };
}

void checkChannel(TopologyLevel const &level, int channel) {
    CheckIndex(channel, level.GetNumFVarChannels(), "channel");
}

py::array_t<int> getFaceFVarValues(Level const &self, int channel) {
    return TakeOver(self.Read([channel](TopologyLevel const &level) {
        checkChannel(level, channel);
        std::vector<int> values;
        values.reserve(std::size_t(level.GetNumFaceVertices()));
        for (Index f = 0; f < level.GetNumFaces(); ++f) {
            Far::ConstIndexArray const face = level.GetFaceFVarValues(f, channel);
            values.insert(values.end(), face.begin(), face.end());
        }
        return values;
    }));
}

py::tuple getSplitFaces(Level const &self, int channel) {
    std::vector<int> faces, values;
    self.Read([&](TopologyLevel const &level) {
        checkChannel(level, channel);
        for (Index f = 0; f < level.GetNumFaces(); ++f) {
            if (!level.IsFaceFVarSplit(f, channel)) {
                continue;
            }
            faces.push_back(f);
            for (int half = 0; half < 2; ++half) {
                Far::ConstIndexArray const side = level.GetFaceFVarValues(f, channel, half);
                values.insert(values.end(), side.begin(), side.end());
            }
        }
    });
    auto const numFaces = py::ssize_t(faces.size());
    return py::make_tuple(
        TakeOver(std::move(faces)),
        TakeOver(std::move(values)).reshape({numFaces, py::ssize_t(2), py::ssize_t(4)}));
}

template <typename COUNT, typename MATCH>
auto matchFVar(COUNT getCount, MATCH match) {
    return [=](Level const &self, int channel) {
        std::vector<std::uint8_t> const matches = self.ReadFull([&](TopologyLevel const &level) {
            checkChannel(level, channel);
            std::vector<std::uint8_t> values(std::size_t((level.*getCount)()));
            for (std::size_t i = 0; i < values.size(); ++i) {
                values[i] = (level.*match)(Index(i), channel);
            }
            return values;
        });
        py::array_t<bool> result(py::ssize_t(matches.size()));
        std::copy(matches.begin(), matches.end(), result.mutable_data());
        return result;
    };
}

/// makeArray for answers of yes or no.
template <typename QUERY>
auto makeMask(int (TopologyLevel::*size)() const, bool isFull, QUERY query) {
    return [=](Level const &self) {
        py::array_t<std::uint8_t> const bytes = makeArray<std::uint8_t>(size, isFull, query)(self);
        return bytes.attr("view")("bool");
    };
}

py::array_t<int> getBaseFaces(Level const &self, int half) {
    CheckIndex(half, 2, "half");
    return TakeOver(self.Read([half](TopologyLevel const &level) {
        BaseFaceMap const map(level);
        std::vector<int> baseFaces(std::size_t(level.GetNumFaces()));
        for (std::size_t i = 0; i < baseFaces.size(); ++i) {
            baseFaces[i] = map.GetBaseFace(Index(i), half);
        }
        return baseFaces;
    }));
}

/// Throws: a level has no places in base faces, or in faces of the surface level.
[[noreturn]] void throwNoPlaces(TopologyLevel const &level, bool ofSurfaceLevel) {
    throw py::value_error("level " + std::to_string(level.GetDepth()) +
                          (ofSurfaceLevel
                               ? " does not come from the surface level by hexagonal steps alone"
                               : " is not made by hexagonal steps alone, which have places in base "
                                 "faces"));
}

py::array_t<int> getSurfaceFaces(Level const &self, int half) {
    CheckIndex(half, 2, "half");
    return TakeOver(self.Read([half](TopologyLevel const &level) {
        std::vector<int> faces(std::size_t(level.GetNumFaces()));
        for (std::size_t i = 0; i < faces.size(); ++i) {
            faces[i] = level.GetFaceSurfaceFace(Index(i), half);
            if (faces[i] == Far::INDEX_INVALID) {
                throwNoPlaces(level, true);
            }
        }
        return faces;
    }));
}

/// \param isSplit  (level, f): whether the halves of a face lie in two faces
/// \param find     (level, f, half, float *): GetFaceBaseCoords or GetFaceSurfaceCoords
template <typename IS_SPLIT, typename FIND>
py::array_t<float> getCoords(Level const &self, int half, IS_SPLIT const &isSplitFace,
                             FIND const &find, bool ofSurfaceLevel) {
    CheckIndex(half, 2, "half");
    std::vector<float> coords = self.Read([&](TopologyLevel const &level) {
        auto const none = std::numeric_limits<float>::quiet_NaN();
        std::vector<float> values(2 * std::size_t(level.GetNumFaceVertices()), none);
        float *place = values.data();
        std::vector<float> ofHalf;
        for (Index f = 0; f < level.GetNumFaces(); ++f) {
            bool const isSplit = isSplitFace(level, f);
            int const size = level.GetFaceVertices(f).size();
            int const end = level.GetFaceDiagonalEnd(f);
            int const numOfHalf = isSplit ? GetHalfSize(half, size, end) : 0;
            ofHalf.resize(2 * std::size_t(numOfHalf));
            if (!find(level, f, half, isSplit ? ofHalf.data() : place)) {
                throwNoPlaces(level, ofSurfaceLevel);
            }
            for (int i = 0; i < numOfHalf; ++i) {
                std::copy_n(&ofHalf[2 * std::size_t(i)], 2,
                            place + 2 * std::ptrdiff_t(GetPlaceInHalves(half, i, end)));
            }
            place += 2 * std::ptrdiff_t(size);
        }
        return values;
    });
    auto const numCorners = py::ssize_t(coords.size() / 2);
    return TakeOver(std::move(coords)).reshape({numCorners, py::ssize_t(2)});
}

py::array_t<float> getBaseCoords(Level const &self, int half) {
    return getCoords(
        self, half, [](TopologyLevel const &level, Index f) { return level.IsFaceBaseSplit(f); },
        [](TopologyLevel const &level, Index f, int ofHalf, float *uv) {
            return level.GetFaceBaseCoords(f, ofHalf, uv);
        },
        false);
}

py::array_t<float> getSurfaceCoords(Level const &self, int half) {
    return getCoords(
        self, half,
        [](TopologyLevel const &level, Index f) {
            return level.GetFaceSurfaceFace(f, 0) != level.GetFaceSurfaceFace(f, 1);
        },
        [](TopologyLevel const &level, Index f, int ofHalf, float *uv) {
            return level.GetFaceSurfaceCoords(f, ofHalf, uv);
        },
        true);
}

py::object areHoles(Level const &self, std::optional<int> half) {
    if (half) {
        CheckIndex(*half, 2, "half");
    }
    py::array_t<std::uint8_t> const bytes = TakeOver(self.Read([half](TopologyLevel const &level) {
        std::vector<std::uint8_t> holes(std::size_t(level.GetNumFaces()));
        for (std::size_t i = 0; i < holes.size(); ++i) {
            holes[i] = half ? level.IsFaceHole(Index(i), *half) : level.IsFaceHole(Index(i));
        }
        return holes;
    }));
    return bytes.attr("view")("bool");
}

void bindRelations(py::class_<Level> &level) {
    level
        .def_property_readonly("face_offsets", relation(&TopologyLevel::GetFaceOffsets, true),
                               "int32, shape (faces + 1,), a view: face f has the corners from\n"
                               "face_offsets[f] to face_offsets[f + 1].")
        .def_property_readonly("face_vertices", relation(&TopologyLevel::GetAllFaceVertices, true),
                               "int32, shape (corners,), a view: the vertex at each corner.")
        .def_property_readonly("face_edges", relation(&TopologyLevel::GetAllFaceEdges),
                               "int32, shape (corners,), a view: the edge from each corner to the "
                               "next.")
        .def_property_readonly("edge_vertices",
                               relation(&TopologyLevel::GetAllEdgeVertices, false, 2),
                               "int32, shape (edges, 2), a view.")
        .def_property_readonly("edge_faces", relation(&TopologyLevel::GetAllEdgeFaces, false, 2),
                               "int32, shape (edges, 2), a view: the first face runs from the "
                               "edge's first vertex to its\n"
                               "second.  A boundary edge has a negative second face.")
        .def_property_readonly("vertex_face_offsets",
                               relation(&TopologyLevel::GetVertexFaceOffsets),
                               "int32, shape (vertices + 1,), a view into vertex_faces.")
        .def_property_readonly(
            "vertex_faces", relation(&TopologyLevel::GetAllVertexFaces),
            "int32, shape (corners,), a view: the faces of each vertex, counter-clockwise.")
        .def_property_readonly("vertex_edge_offsets",
                               relation(&TopologyLevel::GetVertexEdgeOffsets),
                               "int32, shape (vertices + 1,), a view into vertex_edges.")
        .def_property_readonly(
            "vertex_edges", relation(&TopologyLevel::GetAllVertexEdges),
            "int32, shape (2 edges,), a view: the edges of each vertex, counter-clockwise.")
        .def(
            "find_edge",
            [](Level const &self, int v0, int v1) {
                Index const edge = self.ReadFull([&](TopologyLevel const &topology) {
                    CheckIndex(v0, topology.GetNumVertices(), "v0");
                    CheckIndex(v1, topology.GetNumVertices(), "v1");
                    return topology.FindEdge(v0, v1);
                });
                return edge == Far::INDEX_INVALID ? py::object(py::none())
                                                  : py::object(py::int_(edge));
            },
            "find_edge(v0, v1)\n\nThe edge between two vertices, or None.", py::arg("v0"),
            py::arg("v1"));
}

void bindTags(py::class_<Level> &level) {
    auto const faces = &TopologyLevel::GetNumFaces;
    auto const edges = &TopologyLevel::GetNumEdges;
    auto const vertices = &TopologyLevel::GetNumVertices;
    level
        .def("get_face_kinds", makeArray<std::uint8_t>(faces, false, &TopologyLevel::GetFaceKind),
             "get_face_kinds()\n\n"
             "uint8, shape (faces,): the FaceKind of each face.")
        .def("is_face_hole", &areHoles,
             "is_face_hole(half=None)\n\n"
             "bool, shape (faces,): whether each face, or its given half, lies in holes alone.",
             py::arg("half") = py::none())
        .def("is_face_half", makeMask(faces, true, &TopologyLevel::IsFaceHalf),
             "is_face_half()\n\n"
             "bool, shape (faces,): whether each face is half a hexagon, cut by a sharp boundary.")
        .def("get_face_diagonal_sharpness",
             makeArray<float>(faces, false, &TopologyLevel::GetFaceDiagonalSharpness),
             "get_face_diagonal_sharpness()\n\n"
             "float32, shape (faces,): sharpness of the crease that crosses each hexagon from its "
             "vertex 0\n"
             "to its vertex 3, or 0.")
        .def("get_edge_sharpness", makeArray<float>(edges, true, &TopologyLevel::GetEdgeSharpness),
             "get_edge_sharpness()\n\nfloat32, shape (edges,).")
        .def("is_edge_boundary", makeMask(edges, true, &TopologyLevel::IsEdgeBoundary),
             "is_edge_boundary()\n\n"
             "bool, shape (edges,): whether each edge is a boundary.")
        .def("is_edge_non_manifold", makeMask(edges, true, &TopologyLevel::IsEdgeNonManifold),
             "is_edge_non_manifold()\n\n"
             "bool, shape (edges,): whether each edge of level 0 was part of a non-manifold edge.")
        .def("get_vertex_sharpness",
             makeArray<float>(vertices, false, &TopologyLevel::GetVertexSharpness),
             "get_vertex_sharpness()\n\nfloat32, shape (vertices,).")
        .def("get_vertex_rules",
             makeArray<std::uint8_t>(vertices, true, &TopologyLevel::GetVertexRule),
             "get_vertex_rules()\n\n"
             "uint8, shape (vertices,): the Rule of each vertex.")
        .def("is_vertex_boundary", makeMask(vertices, true, &TopologyLevel::IsVertexBoundary),
             "is_vertex_boundary()\n\n"
             "bool, shape (vertices,): whether each vertex is on a boundary.")
        .def("is_vertex_corner", makeMask(vertices, true, &TopologyLevel::IsVertexCorner),
             "is_vertex_corner()\n\n"
             "bool, shape (vertices,): whether each vertex has exactly one face.")
        .def("is_vertex_non_manifold",
             makeMask(vertices, true, &TopologyLevel::IsVertexNonManifold),
             "is_vertex_non_manifold()\n\nbool, shape (vertices,).")
        .def("is_vertex_valence_regular",
             makeMask(vertices, true, &TopologyLevel::IsVertexValenceRegular),
             "is_vertex_valence_regular()\n\n"
             "bool, shape (vertices,): whether each vertex has three faces, or one or two at a "
             "boundary.");
}

void bindParents(py::class_<Level> &level) {
    auto const faces = &TopologyLevel::GetNumFaces;
    level
        .def("get_face_base_faces", &getBaseFaces,
             "get_face_base_faces(half=0)\n\n"
             "int32, shape (faces,): the face of level 0 that contains the given half of each "
             "face.  Most\n"
             "faces have both halves in one base face.",
             py::arg("half") = 0)
        .def("get_face_base_coords", &getBaseCoords,
             "get_face_base_coords(half=0)\n\n"
             "float32, shape (corners, 2): coordinates of each corner in the base face of the "
             "given half.\n"
             "A quad is the unit square; a triangle has the corners (0, 0), (1, 0) and (0, 1); "
             "other faces are\n"
             "regular polygons whose first edge runs from (0, 0) to (1, 0).  In a face with two "
             "base faces\n"
             "the two corners outside the half are nan: half 0 has corners 0, 3, 4, 5, half 1 has "
             "3, 0, 1, 2.\n"
             "Raises ValueError after steps that are not hexagonal.",
             py::arg("half") = 0)
        .def("get_face_surface_faces", &getSurfaceFaces,
             "get_face_surface_faces(half=0)\n\n"
             "int32, shape (faces,): the face of the surface level that contains the given half of "
             "each\n"
             "face.  A SurfaceFactory makes its surface.  The surface level is 0, or 1 with a "
             "first step.\n"
             "Raises ValueError before that level, and after steps that are not hexagonal.",
             py::arg("half") = 0)
        .def("get_face_surface_coords", &getSurfaceCoords,
             "get_face_surface_coords(half=0)\n\n"
             "As get_face_base_coords(), but (u, v) of the surface of get_face_surface_faces(): "
             "evaluated\n"
             "there, it has the limits of the vertices.  Faces of five and more vertices have a "
             "sub-face for\n"
             "each corner, as in OpenSubdiv's Bfr.  Raises ValueError as get_face_surface_faces().",
             py::arg("half") = 0)
        .def("is_face_base_split", makeMask(faces, false, &TopologyLevel::IsFaceBaseSplit),
             "is_face_base_split()\n\n"
             "bool, shape (faces,): whether the halves of each face lie in two base faces.")
        .def("get_face_parent_faces",
             makeArray<int>(faces, false, &TopologyLevel::GetFaceParentFace),
             "get_face_parent_faces()\n\n"
             "int32, shape (faces,): the face of the level before; for a face that an edge made, "
             "the edge's\n"
             "first face.")
        .def("get_face_parent_edges",
             makeArray<int>(faces, false, &TopologyLevel::GetFaceParentEdge),
             "get_face_parent_edges()\n\n"
             "int32, shape (faces,): the edge that made each face, or -1.")
        .def("get_face_parent_vertices",
             makeArray<int>(faces, false, &TopologyLevel::GetFaceParentVertex),
             "get_face_parent_vertices()\n\n"
             "int32, shape (faces,): the vertex that made each face, or -1.")
        .def("get_edge_child_faces",
             makeArray<int>(&TopologyLevel::GetNumEdges, true, &TopologyLevel::GetEdgeChildFace),
             "get_edge_child_faces()\n\n"
             "int32, shape (edges,): the face that each edge makes, or -1.")
        .def("get_vertex_child_vertices",
             makeArray<int>(&TopologyLevel::GetNumVertices, true,
                            &TopologyLevel::GetVertexChildVertex),
             "get_vertex_child_vertices()\n\n"
             "int32, shape (vertices,): the vertex of the next level that each vertex becomes, or "
             "-1.");
}

void bindFVar(py::class_<Level> &level) {
    level
        .def(
            "get_num_fvar_values",
            [](Level const &self, int channel) {
                return self.Read([channel](TopologyLevel const &topology) {
                    checkChannel(topology, channel);
                    return topology.GetNumFVarValues(channel);
                });
            },
            "get_num_fvar_values(channel=0)", py::arg("channel") = 0)
        .def("get_face_fvar_values", &getFaceFVarValues,
             "get_face_fvar_values(channel=0)\n\n"
             "int32, shape (corners,): the value at each corner.  In a face that a seam crosses, "
             "the two\n"
             "corners on the seam have the values of half 0.",
             py::arg("channel") = 0)
        .def("get_fvar_split_faces", &getSplitFaces,
             "get_fvar_split_faces(channel=0)\n\n"
             "Returns (faces, values), int32, shapes (n,) and (n, 2, 4): the faces that a seam "
             "crosses, and the\n"
             "values of their halves.  Half 0 has the corners 0, 3, 4, 5 of the hexagon, half 1 "
             "the corners\n"
             "3, 0, 1, 2.",
             py::arg("channel") = 0)
        .def("does_edge_fvar_topology_match",
             matchFVar(&TopologyLevel::GetNumEdges, &TopologyLevel::DoesEdgeFVarTopologyMatch),
             "does_edge_fvar_topology_match(channel=0)\n\n"
             "bool, shape (edges,): whether both sides of each edge have the same values.",
             py::arg("channel") = 0)
        .def("does_vertex_fvar_topology_match",
             matchFVar(&TopologyLevel::GetNumVertices, &TopologyLevel::DoesVertexFVarTopologyMatch),
             "does_vertex_fvar_topology_match(channel=0)\n\nbool, shape (vertices,).",
             py::arg("channel") = 0)
        .def("does_face_fvar_topology_match",
             matchFVar(&TopologyLevel::GetNumFaces, &TopologyLevel::DoesFaceFVarTopologyMatch),
             "does_face_fvar_topology_match(channel=0)\n\nbool, shape (faces,).",
             py::arg("channel") = 0);
}

LimitSides createSides(Level const &level) {
    return level.ReadFull([](TopologyLevel const &topology) { return LimitSides(topology); });
}

/// For each side what a query of LimitSides says.
auto listSides(Index (LimitSides::*query)(Index) const) {
    return [query](LimitSides const &self) {
        std::vector<int> values(std::size_t(self.GetNumSides()));
        for (std::size_t i = 0; i < values.size(); ++i) {
            values[i] = (self.*query)(Index(i));
        }
        return TakeOver(std::move(values));
    };
}

py::array_t<int> findSides(LimitSides const &self, Level const &level, int half) {
    CheckIndex(half, 2, "half");
    return TakeOver(level.ReadFull([&](TopologyLevel const &topology) {
        if (!self.IsOf(topology)) {
            throw py::value_error("level: the sides are those of another level");
        }
        std::vector<int> sides;
        sides.reserve(std::size_t(topology.GetNumFaceVertices()));
        for (Index f = 0; f < topology.GetNumFaces(); ++f) {
            for (int i = 0; i < topology.GetFaceVertices(f).size(); ++i) {
                sides.push_back(self.FindSide(topology, f, i, half));
            }
        }
        return sides;
    }));
}

/// The options of both kinds of index buffers, taken from a call's keywords.
class DrawArguments {
public:
    DrawArguments(int vertexOffset, bool cutBaseFaces, py::object const &labels,
                  py::object const &cutCreases, std::vector<int> const &fvarChannels,
                  LimitSides const *sides, bool splitVertices, bool separateVertices,
                  bool generateBaseCoords, bool drawHoles) {
        _options.vertexOffset = vertexOffset;
        _options.cutBaseFaces = cutBaseFaces;
        if (!labels.is_none()) {
            _labels = TakeIndices(labels, "labels");
            _options.labels = Far::ConstIndexArray(_labels.data(), int(_labels.size()));
        }
        _options.cutCreases = TakeEnum<OsdExt::CreaseCuts>(cutCreases, "cut_creases");
        _options.fvarChannels = fvarChannels;
        _options.sides = sides;
        _options.splitVertices = splitVertices;
        _options.separateVertices = separateVertices;
        _options.generateBaseCoords = generateBaseCoords;
        _options.drawHoles = drawHoles;
    }

    bool IsSeparate() const { return _options.separateVertices; }

    /// Calls create(level, options, &status).
    template <typename CREATE>
    auto Create(Level const &level, CREATE const &create) const {
        CallStatus status;
        auto const call = [&](TopologyLevel const &topology) {
            return create(topology, _options, &status);
        };
        auto result = level.Read(call);
        RaiseUnlessOk(status);
        return result;
    }

private:
    py::array_t<int> _labels;
    OsdExt::DrawOptions _options;
};

/// Returns the data of drawn faces by corner and by face, and the separate vertices, where there are any.  Data by
/// corner have the shape (corners,), or (faces, \p width) where all faces have \p width corners.
py::dict describeFaces(OsdExt::DrawnFaces &&faces, py::ssize_t width, bool isSeparate) {
    auto const byCorner = [width](auto values, py::ssize_t numbers) -> py::object {
        using T = typename decltype(values)::value_type;
        std::vector<py::ssize_t> shape = {py::ssize_t(values.size()) / numbers};
        if (width > 1) {
            shape = {shape[0] / width, width};
        }
        if (numbers > 1) {
            shape.push_back(numbers);
        }
        py::array_t<T> array = TakeOver(std::move(values));
        return array.reshape(shape);
    };
    py::dict result;
    bool const hasLabels = !faces.labels.empty(), hasSides = !faces.sides.empty();
    result["vertices"] = byCorner(std::move(faces.vertices), 1);
    py::list channels;
    for (std::vector<int> &values : faces.fvarValues) {
        channels.append(byCorner(std::move(values), 1));
    }
    result["fvar_values"] = channels;
    if (hasSides) {
        result["sides"] = byCorner(std::move(faces.sides), 1);
    }
    if (!faces.baseCoords.empty()) {
        result["base_coords"] = byCorner(std::move(faces.baseCoords), 2);
    }
    result["faces"] = TakeOver(std::move(faces.faces));
    result["base_faces"] = TakeOver(std::move(faces.baseFaces));
    if (hasLabels) {
        result["labels"] = TakeOver(std::move(faces.labels));
    }
    OsdExt::DrawnVertices &drawn = faces.drawnVertices;
    if (isSeparate) {
        py::dict vertices;
        vertices["vertices"] = TakeOver(std::move(drawn.vertices));
        py::list ofChannels;
        for (std::vector<int> &values : drawn.fvarValues) {
            ofChannels.append(TakeOver(std::move(values)));
        }
        vertices["fvar_values"] = ofChannels;
        if (hasSides) {
            vertices["sides"] = TakeOver(std::move(drawn.sides));
        }
        if (!drawn.baseFaces.empty()) {
            auto const numVertices = py::ssize_t(drawn.baseFaces.size());
            py::array_t<float> coords = TakeOver(std::move(drawn.baseCoords));
            vertices["base_coords"] = coords.reshape({numVertices, py::ssize_t(2)});
            vertices["base_faces"] = TakeOver(std::move(drawn.baseFaces));
        }
        result["drawn_vertices"] = vertices;
    }
    return result;
}

py::dict createPolygonIndices(Level const &level, DrawArguments const &arguments) {
    OsdExt::PolygonIndices polygons =
        arguments.Create(level, [](TopologyLevel const &topology,
                                   OsdExt::DrawOptions const &options, CallStatus *status) {
            return OsdExt::CreatePolygonIndices(topology, options, status);
        });
    std::vector<int> sizes = std::move(polygons.sizes);
    py::dict result = describeFaces(std::move(polygons), 1, arguments.IsSeparate());
    result["sizes"] = TakeOver(std::move(sizes));
    return result;
}

py::dict createTriangleIndices(Level const &level, DrawArguments const &arguments) {
    return describeFaces(
        arguments.Create(level,
                         [](TopologyLevel const &topology, OsdExt::DrawOptions const &options,
                            CallStatus *status) {
                             return OsdExt::CreateTriangleIndices(topology, options, status);
                         }),
        3, arguments.IsSeparate());
}

/// Binds a function of a level and all DrawOptions.
template <typename CREATE>
void defineDrawing(py::module_ &module, char const *name, std::string const &docstring,
                   CREATE const &create) {
    module.def(
        name,
        [create](Level const &level, int vertexOffset, bool cutBaseFaces, py::object const &labels,
                 py::object const &cutCreases, std::vector<int> const &fvarChannels,
                 LimitSides const *sides, bool splitVertices, bool separateVertices,
                 bool generateBaseCoords, bool drawHoles) {
            return create(level, DrawArguments(vertexOffset, cutBaseFaces, labels, cutCreases,
                                               fvarChannels, sides, splitVertices, separateVertices,
                                               generateBaseCoords, drawHoles));
        },
        docstring.c_str(), py::arg("level"), py::kw_only(), py::arg("vertex_offset") = 0,
        py::arg("cut_base_faces") = true, py::arg("labels") = py::none(),
        py::arg("cut_creases") = "all", py::arg("fvar_channels") = py::tuple(),
        py::arg("sides") = py::none(), py::arg("split_vertices") = false,
        py::arg("separate_vertices") = false, py::arg("generate_base_coords") = false,
        py::arg("draw_holes") = false);
}

void bindDrawing(py::module_ &module) {
    defineDrawing(
        module, "create_polygon_indices",
        "create_polygon_indices(level, *, vertex_offset=0, cut_base_faces=True, labels=None,\n"
        "                       cut_creases='all', fvar_channels=(), sides=None,\n"
        "                       split_vertices=False, separate_vertices=False,\n"
        "                       generate_base_coords=False, draw_holes=False)\n\n"
        "The polygons that draw a level: its faces, with hexagons cut in halves where asked.\n\n"
        "Args:\n"
        "    vertex_offset: added to every vertex, not negative\n"
        "    cut_base_faces: cuts hexagons that lie in two base faces\n"
        "    labels: a number for each base face, for example its material: integers, shape\n"
        "        (base faces,); cuts hexagons whose halves have different labels\n"
        "    cut_creases: a CreaseCuts, or its name\n"
        "    fvar_channels: the channels whose seams cut hexagons\n"
        "    sides: the LimitSides of the level, for normals by side; or None\n"
        "    split_vertices: 'vertices' are indices of sides\n"
        "    separate_vertices: makes a vertex for each combination of vertex, values of the "
        "channels,\n"
        "        side and, with generate_base_coords, coordinates in a base face\n"
        "    generate_base_coords: makes coordinates in base faces; cuts as cut_base_faces\n"
        "    draw_holes: whether holes are drawn\n\n"
        "Returns a dict.  By corner, int32 of the shape (corners,): 'vertices', 'sides' with\n"
        "sides, and 'fvar_values', a list with an array for each channel; 'base_coords', float32\n"
        "of the shape (corners, 2).  By polygon, int32 of the shape (polygons,): 'sizes', "
        "'faces',\n"
        "'base_faces', and 'labels' with labels.  With separate_vertices 'drawn_vertices' is a "
        "dict\n"
        "that describes each drawn vertex, int32 of the shape (drawn vertices,): 'vertices',\n"
        "'fvar_values', 'sides', 'base_coords' and, with these, 'base_faces'.  The first drawn\n"
        "vertices are the level's vertices in their order.\n"
        "Raises StatusError.",
        &createPolygonIndices);
    defineDrawing(
        module, "create_triangle_indices",
        "create_triangle_indices(level, *, vertex_offset=0, cut_base_faces=True, labels=None,\n"
        "                        cut_creases='all', fvar_channels=(), sides=None,\n"
        "                        split_vertices=False, separate_vertices=False,\n"
        "                        generate_base_coords=False, draw_holes=False)\n\n"
        "Triangles of the polygons of create_polygon_indices(): a dict without 'sizes', whose "
        "arrays by corner have\n"
        "the shape (triangles, 3), 'base_coords' (triangles, 3, 2).",
        &createTriangleIndices);
}

} // namespace

void BindLevel(py::module_ &module) {
    py::class_<Level> level(
        module, "TopologyLevel",
        "One level of a refined mesh, from TopologyRefiner.get_level().\n\n"
        "Properties that are arrays are read-only views of the level's memory: they keep the "
        "refiner\n"
        "alive, and prevent it from being refined again.  Functions return new arrays.\n\n"
        "Without full_topology_in_last_level=True the last level has face_offsets, face_vertices "
        "and\n"
        "what follows from them; everything else raises ValueError.  After the refiner was "
        "refined\n"
        "again, everything raises RuntimeError.");
    level
        .def_property_readonly("depth", &Level::GetDepth,
                               "Number of refinements from the base mesh to this level.")
        .def_property_readonly("num_vertices", count(&TopologyLevel::GetNumVertices),
                               "Vertices of this level.")
        .def_property_readonly("num_faces", count(&TopologyLevel::GetNumFaces),
                               "Faces of this level.")
        .def_property_readonly("num_edges", count(&TopologyLevel::GetNumEdges),
                               "Edges of this level.")
        .def_property_readonly("num_face_vertices", count(&TopologyLevel::GetNumFaceVertices),
                               "Number of corners of all faces.")
        .def_property_readonly("num_boundary_edges", count(&TopologyLevel::GetNumBoundaryEdges),
                               "Edges with one face.")
        .def_property_readonly("num_fvar_channels", count(&TopologyLevel::GetNumFVarChannels),
                               "Face-varying channels.")
        .def_property_readonly(
            "has_full_topology", count(&TopologyLevel::HasFullTopology),
            "Whether the level has more than face_vertices: edges, and faces around vertices.")
        .def(
            "validate",
            [](Level const &self) {
                CallStatus status;
                self.Read([&](TopologyLevel const &topology) { topology.Validate(&status); });
                RaiseUnlessOk(status);
            },
            "validate()\n\n"
            "Checks every invariant of the topology.  Raises StatusError, which names the first "
            "component\n"
            "that breaks one.");
    bindRelations(level);
    bindTags(level);
    bindParents(level);
    bindFVar(level);

    py::class_<LimitSides>(module, "LimitSides",
                           "LimitSides(level)\n\n"
                           "The sides of the vertices of a level with full topology.\n\n"
                           "Where infinitely sharp edges meet at a vertex, they part its faces "
                           "into sides, and the surface\n"
                           "has a tangent plane for each side.  Side 0 of a vertex has the "
                           "vertex's index; further sides\n"
                           "follow the vertices.")
        .def(py::init(&createSides), py::arg("level"))
        .def_property_readonly("num_vertices", &LimitSides::GetNumVertices,
                               "Vertices of the level.")
        .def_property_readonly(
            "num_sides", &LimitSides::GetNumSides,
            "Number of sides: one for each vertex, and further ones along sharp creases.")
        .def("get_vertices", listSides(&LimitSides::GetVertex),
             "get_vertices()\n\n"
             "int32, shape (sides,): the vertex of each side.")
        .def("get_local_sides", listSides(&LimitSides::GetLocalSide),
             "get_local_sides()\n\n"
             "int32, shape (sides,): the number of each side among the sides of its vertex.")
        .def("find_sides", &findSides,
             "find_sides(level, half=0)\n\n"
             "int32, shape (corners,): for each corner of each face, the side of its vertex on "
             "which the\n"
             "face lies.  For a hexagon with a sharp diagonal: the side of the given half, 0 or 1.",
             py::arg("level"), py::arg("half") = 0);

    bindDrawing(module);
}

} // namespace OpenSubdivHex::Python
