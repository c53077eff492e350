// SPDX-License-Identifier: Apache-2.0
#include "inputChecks.h"

#include <algorithm>
#include <array>
#include <limits>
#include <set>

namespace OpenSubdivHex::FarExt::internal {

using Far::ConstIndexArray;
using Far::Index;

namespace {

std::string str(std::int64_t number) { return std::to_string(number); }

Status invalid(ComponentType component, Index index, std::string message) {
    return Status(StatusCode::InvalidTopology, component, index, std::move(message));
}

// Checks what can be wrong in face-vertices alone; used for both kinds of input.
class FaceVertexChecker {
public:
    explicit FaceVertexChecker(Index numVertices) : _numFaces(numVertices, 0) {}

    Status Check(Index face, ConstIndexArray verts) {
        if (verts.size() < 3) {
            return invalid(ComponentType::Face, face,
                           "face " + str(face) + " has " + str(verts.size()) +
                               " vertices, but a face needs at least 3");
        }
        if (verts.size() > OpenSubdiv::Vtr::VALENCE_LIMIT) {
            return Status(StatusCode::TooLarge, ComponentType::Face, face,
                          "face " + str(face) + " has " + str(verts.size()) +
                              " vertices, more than the " + str(OpenSubdiv::Vtr::VALENCE_LIMIT) +
                              " that OpenSubdiv's local indices reach");
        }
        for (Index vert : verts) {
            if (vert < 0 || vert >= Index(_numFaces.size())) {
                return invalid(ComponentType::Face, face,
                               "face " + str(face) + " refers to vertex " + str(vert) +
                                   ", but vertices go from 0 to " + str(_numFaces.size() - 1));
            }
            if (++_numFaces[vert] < kManyFaces) {
                continue;
            }
            _hasManyFaces = true;
            if (_numFaces[vert] > OpenSubdiv::Vtr::VALENCE_LIMIT) {
                return tooLarge(vert, _numFaces[vert], "faces");
            }
        }
        return Status();
    }

    // Checks what Far would print about: the numbers of edges of the vertices.  All faces of the
    // descriptor are checked already.
    Status CheckEdges(Far::TopologyDescriptor const &descriptor) const;

private:
    // Every face of a vertex has two edges there at most, so that with fewer faces there are not
    // too many edges.
    static constexpr int kManyFaces = (OpenSubdiv::Vtr::VALENCE_LIMIT + 1) / 2;

    static Status tooLarge(Index vert, std::int64_t count, std::string const &what) {
        return Status(StatusCode::TooLarge, ComponentType::Vertex, vert,
                      "vertex " + str(vert) + " has " + str(count) + " " + what +
                          ", more than the " + str(OpenSubdiv::Vtr::VALENCE_LIMIT) +
                          " that OpenSubdiv's valences reach");
    }

    std::vector<int> _numFaces; // of a vertex, which a face may have several times
    bool _hasManyFaces = false; // whether a vertex has kManyFaces or more
};

// Counts as Far does, which gives each degenerate edge, and each repetition of an edge within a
// face, an edge of its own.
Status FaceVertexChecker::CheckEdges(Far::TopologyDescriptor const &descriptor) const {
    if (!_hasManyFaces) {
        return Status();
    }
    using EdgeEnd = std::array<Index, 3>; // vertex, the vertex at the other end, face
    std::vector<EdgeEnd> ends;
    Index const *verts = descriptor.vertIndicesPerFace;
    for (Index face = 0; face < descriptor.numFaces; ++face) {
        int const size = descriptor.numVertsPerFace[face];
        for (int i = 0; i < size; ++i) {
            Index const start = verts[i];
            Index const end = verts[(i + 1) % size];
            if (_numFaces[start] >= kManyFaces) {
                ends.push_back({start, end, face});
            }
            if (_numFaces[end] >= kManyFaces) {
                ends.push_back({end, start, face});
            }
        }
        verts += size;
    }
    std::sort(ends.begin(), ends.end());
    int numEdges = 0;
    for (std::size_t i = 0; i < ends.size(); ++i) {
        auto const [vert, other, face] = ends[i];
        if (i == 0 || vert != ends[i - 1][0]) {
            numEdges = 0;
        }
        bool const isKnown = numEdges > 0 && other == ends[i - 1][1] && face != ends[i - 1][2];
        numEdges += isKnown && other != vert ? 0 : 1;
        bool const isLast = i + 1 == ends.size() || vert != ends[i + 1][0];
        if (isLast && numEdges > OpenSubdiv::Vtr::VALENCE_LIMIT) {
            return tooLarge(vert, numEdges, "edges");
        }
    }
    return Status();
}

Status checkInventory(std::int64_t numVertices, std::int64_t numFaces) {
    if (numVertices <= 0 || numFaces <= 0) {
        return invalid(ComponentType::None, Far::INDEX_INVALID,
                       "the mesh is empty: it has " + str(numVertices) + " vertices and " +
                           str(numFaces) + " faces");
    }
    return Status();
}

Status checkRange(std::string const &name, Index index, int count, ComponentType component) {
    if (0 <= index && index < count) {
        return Status();
    }
    return invalid(component, index,
                   name + " refers to " + str(index) + ", but indices go from 0 to " +
                       str(count - 1));
}

// An array of a descriptor that has a count.
Status checkArray(int count, void const *array, std::string const &name) {
    if (count < 0) {
        return Failure(StatusCode::InvalidArgument,
                       "the descriptor has " + str(count) + " entries in " + name);
    }
    if (count > 0 && !array) {
        return Failure(StatusCode::InvalidArgument, "the descriptor has no array " + name +
                                                        ", but " + str(count) + " entries in it");
    }
    return Status();
}

template <typename ENUM>
Status checkEnum(int value, ENUM last, std::string const &name) {
    return IsInEnum(value, last)
               ? Status()
               : Failure(StatusCode::InvalidArgument, "there is no " + name + " " + str(value));
}

} // namespace

Status CheckOptions(HexSchemeOptions schemeOptions, Sdc::Options sdcOptions) {
    for (Status const &status :
         {checkEnum(int(schemeOptions.faceMask), FaceMask::Smooth, "faceMask"),
          checkEnum(int(schemeOptions.schemeType), SchemeType::TriHex, "schemeType"),
          checkEnum(sdcOptions.GetVtxBoundaryInterpolation(),
                    Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER, "VtxBoundaryInterpolation"),
          checkEnum(sdcOptions.GetFVarLinearInterpolation(), Sdc::Options::FVAR_LINEAR_ALL,
                    "FVarLinearInterpolation"),
          checkEnum(sdcOptions.GetCreasingMethod(), Sdc::Options::CREASE_CHAIKIN,
                    "CreasingMethod")}) {
        if (!status.IsOk()) {
            return status;
        }
    }
    return Status();
}

namespace {

// Not a number is less than 0, too.
Status checkSharpness(float sharpness, ComponentType component, Index index,
                      std::string const &name) {
    if (sharpness >= 0) {
        return Status();
    }
    return invalid(component, index,
                   name + " has sharpness " + std::to_string(sharpness) +
                       ", but a sharpness is 0 or more");
}

// Far skips a crease that is no edge with a warning; here it is an error.
Status checkCreases(Far::TopologyDescriptor const &descriptor) {
    using Pair = std::pair<Index, Index>;
    std::set<Pair> missing;
    for (int i = 0; i < descriptor.numCreases; ++i) {
        Index const *verts = descriptor.creaseVertexIndexPairs + 2 * std::ptrdiff_t(i);
        Status sharp = checkSharpness(descriptor.creaseWeights[i], ComponentType::Vertex, verts[0],
                                      "crease " + str(i) + ", of vertices " + str(verts[0]) +
                                          " and " + str(verts[1]) + ",");
        if (!sharp.IsOk()) {
            return sharp;
        }
        for (int end = 0; end < 2; ++end) {
            Status status = checkRange("crease " + str(i), verts[end], descriptor.numVertices,
                                       ComponentType::Vertex);
            if (!status.IsOk()) {
                return status;
            }
        }
        missing.insert(std::minmax(verts[0], verts[1]));
    }
    Index const *verts = descriptor.vertIndicesPerFace;
    for (Index face = 0; face < descriptor.numFaces && !missing.empty(); ++face) {
        int const size = descriptor.numVertsPerFace[face];
        for (int i = 0; i < size; ++i) {
            missing.erase(std::minmax(verts[i], verts[(i + 1) % size]));
        }
        verts += size;
    }
    if (missing.empty()) {
        return Status();
    }
    return invalid(ComponentType::Vertex, missing.begin()->first,
                   "a crease joins vertices " + str(missing.begin()->first) + " and " +
                       str(missing.begin()->second) + ", but no face has that edge");
}

Status checkArrays(Far::TopologyDescriptor const &descriptor) {
    Status status;
    auto const check = [&](int count, void const *array, std::string const &name) {
        if (status.IsOk()) {
            status = checkArray(count, array, name);
        }
    };
    check(descriptor.numFaces, descriptor.numVertsPerFace, "numVertsPerFace");
    check(descriptor.numFaces, descriptor.vertIndicesPerFace, "vertIndicesPerFace");
    check(descriptor.numCreases, descriptor.creaseVertexIndexPairs, "creaseVertexIndexPairs");
    check(descriptor.numCreases, descriptor.creaseWeights, "creaseWeights");
    check(descriptor.numCorners, descriptor.cornerVertexIndices, "cornerVertexIndices");
    check(descriptor.numCorners, descriptor.cornerWeights, "cornerWeights");
    check(descriptor.numHoles, descriptor.holeIndices, "holeIndices");
    check(descriptor.numFVarChannels, descriptor.fvarChannels, "fvarChannels");
    for (int channel = 0; channel < descriptor.numFVarChannels && status.IsOk(); ++channel) {
        Far::TopologyDescriptor::FVarChannel const &fvar = descriptor.fvarChannels[channel];
        if (fvar.numValues < 0 || !fvar.valueIndices) {
            status = Failure(StatusCode::InvalidArgument,
                             "face-varying channel " + str(channel) +
                                 (fvar.valueIndices ? " has " + str(fvar.numValues) + " values"
                                                    : " has no array valueIndices"));
        }
    }
    return status;
}

Status checkTags(Far::TopologyDescriptor const &descriptor) {
    Status status = checkCreases(descriptor);
    for (int i = 0; i < descriptor.numCorners && status.IsOk(); ++i) {
        Index const vert = descriptor.cornerVertexIndices[i];
        status =
            checkRange("corner " + str(i), vert, descriptor.numVertices, ComponentType::Vertex);
        if (status.IsOk()) {
            status = checkSharpness(descriptor.cornerWeights[i], ComponentType::Vertex, vert,
                                    "corner " + str(i) + ", vertex " + str(vert) + ",");
        }
    }
    for (int i = 0; i < descriptor.numHoles && status.IsOk(); ++i) {
        status = checkRange("hole " + str(i), descriptor.holeIndices[i], descriptor.numFaces,
                            ComponentType::Face);
    }
    std::int64_t numCorners = 0;
    for (Index face = 0; face < descriptor.numFaces; ++face) {
        numCorners += descriptor.numVertsPerFace[face];
    }
    for (int channel = 0; channel < descriptor.numFVarChannels; ++channel) {
        Far::TopologyDescriptor::FVarChannel const &fvar = descriptor.fvarChannels[channel];
        for (std::int64_t corner = 0; corner < numCorners && status.IsOk(); ++corner) {
            status =
                checkRange("corner " + str(corner) + " of face-varying channel " + str(channel),
                           fvar.valueIndices[corner], fvar.numValues, ComponentType::None);
        }
    }
    return status;
}

} // namespace

Status CheckDescriptor(Far::TopologyDescriptor const &descriptor) {
    Status status = checkInventory(descriptor.numVertices, descriptor.numFaces);
    if (status.IsOk()) {
        status = checkArrays(descriptor);
    }
    if (!status.IsOk()) {
        return status;
    }
    std::int64_t numCorners = 0;
    for (Index face = 0; face < descriptor.numFaces; ++face) {
        numCorners += descriptor.numVertsPerFace[face];
    }
    if (numCorners > std::numeric_limits<Index>::max()) {
        return Status(StatusCode::TooLarge, ComponentType::Level, 0,
                      "level 0 would have " + str(numCorners) +
                          " face-vertices, more than 32-bit indices reach");
    }
    FaceVertexChecker checker(descriptor.numVertices);
    Index const *verts = descriptor.vertIndicesPerFace;
    for (Index face = 0; face < descriptor.numFaces && status.IsOk(); ++face) {
        int const size = descriptor.numVertsPerFace[face];
        status = checker.Check(face, ConstIndexArray(verts, size));
        verts += size;
    }
    if (status.IsOk()) {
        status = checker.CheckEdges(descriptor);
    }
    return status.IsOk() ? checkTags(descriptor) : status;
}

namespace {

Status checkFaces(Far::TopologyLevel const &base) {
    Status status = checkInventory(base.GetNumVertices(), base.GetNumFaces());
    FaceVertexChecker checker(base.GetNumVertices());
    for (Index face = 0; face < base.GetNumFaces() && status.IsOk(); ++face) {
        status = checker.Check(face, base.GetFaceVertices(face));
    }
    return status;
}

Status checkSharpnesses(Far::TopologyLevel const &base) {
    Status status;
    for (Index edge = 0; edge < base.GetNumEdges() && status.IsOk(); ++edge) {
        if (!(base.GetEdgeSharpness(edge) >= 0)) {
            ConstIndexArray const verts = base.GetEdgeVertices(edge);
            status = checkSharpness(base.GetEdgeSharpness(edge), ComponentType::Edge, edge,
                                    "edge " + str(edge) + ", of vertices " + str(verts[0]) +
                                        " and " + str(verts[1]) + ",");
        }
    }
    for (Index vert = 0; vert < base.GetNumVertices() && status.IsOk(); ++vert) {
        if (!(base.GetVertexSharpness(vert) >= 0)) {
            status = checkSharpness(base.GetVertexSharpness(vert), ComponentType::Vertex, vert,
                                    "vertex " + str(vert));
        }
    }
    return status;
}

} // namespace

Status CheckBase(Far::TopologyLevel const &base) {
    Status const status = checkFaces(base);
    return status.IsOk() ? checkSharpnesses(base) : status;
}

// Schemes without rules for sharp features and seams take none.
Status CheckScheme(HexSchemeOptions schemeOptions, Hierarchy const &base) {
    Level const &level = base.mesh.levels[0];
    auto const unsupported = [](ComponentType component, Index index, std::string const &what) {
        return Status(StatusCode::Unsupported, component, index,
                      what + ", which only the hexagonal scheme has rules for");
    };
    if (schemeOptions.IsHexagonal()) {
        return Status();
    }
    if (!level.nonManifoldEdges.empty()) {
        Index const edge = level.nonManifoldEdges[0];
        return unsupported(ComponentType::Edge, edge,
                           "edge " + std::to_string(edge) + " is non-manifold");
    }
    for (Index edge = 0; edge < level.numEdges; ++edge) {
        if (Sdc::Crease::IsSharp(level.GetEdgeSharpness(edge))) {
            return unsupported(ComponentType::Edge, edge,
                               "edge " + std::to_string(edge) + " is a crease");
        }
    }
    for (Index vert = 0; vert < level.numVertices; ++vert) {
        // Borders are dropped, and Far takes vertices without faces for sharp.
        int const numFaces = level.GetNumVertexFaces(vert);
        bool const isInterior = numFaces > 0 && level.GetVertexEdges(vert).size() == numFaces;
        if (isInterior && Sdc::Crease::IsSharp(level.GetVertexSharpness(vert))) {
            return unsupported(ComponentType::Vertex, vert,
                               "vertex " + std::to_string(vert) + " is a sharp corner");
        }
    }
    if (!base.channels.empty()) {
        return unsupported(ComponentType::None, Far::INDEX_INVALID,
                           "the mesh has face-varying channels");
    }
    return Status();
}

} // namespace OpenSubdivHex::FarExt::internal
