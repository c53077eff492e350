// SPDX-License-Identifier: Apache-2.0
#include "topologyRefinerFactory.h"

#include <opensubdiv/far/topologyRefinerFactory.h>

#include <limits>

namespace OpenSubdivHex::FarExt {

using Far::ConstIndexArray;
using Far::Index;
using internal::LevelTopology;

namespace {

std::string str(std::int64_t number) { return std::to_string(number); }

Status invalid(ComponentType component, Index index, std::string message) {
    return Status(StatusCode::InvalidTopology, component, index, std::move(message));
}

Status unsupported(ComponentType component, Index index, std::string message) {
    return Status(StatusCode::Unsupported, component, index, std::move(message));
}

// Checks what can be wrong in face-vertices alone; used for both kinds of input.
class FaceVertexChecker {
public:
    explicit FaceVertexChecker(Index numVertices)
        : _lastFace(numVertices, Far::INDEX_INVALID), _numFaces(numVertices, 0) {}

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
            if (vert < 0 || vert >= Index(_lastFace.size())) {
                return invalid(ComponentType::Face, face,
                               "face " + str(face) + " refers to vertex " + str(vert) +
                                   ", but vertices go from 0 to " + str(_lastFace.size() - 1));
            }
            if (_lastFace[vert] == face) {
                return invalid(ComponentType::Face, face,
                               "face " + str(face) + " has vertex " + str(vert) +
                                   " more than once");
            }
            _lastFace[vert] = face;
            // Far counts the edges of a vertex, of which a boundary vertex has one more.
            if (++_numFaces[vert] >= OpenSubdiv::Vtr::VALENCE_LIMIT) {
                return Status(StatusCode::TooLarge, ComponentType::Vertex, vert,
                              "vertex " + str(vert) + " has " + str(_numFaces[vert]) +
                                  " faces, as many as OpenSubdiv's valences reach");
            }
        }
        return Status();
    }

private:
    std::vector<Index> _lastFace; // that a vertex was seen in
    std::vector<int> _numFaces;   // of a vertex
};

Status checkInventory(std::int64_t numVertices, std::int64_t numFaces) {
    if (numVertices <= 0 || numFaces <= 0) {
        return invalid(ComponentType::None, Far::INDEX_INVALID,
                       "the mesh is empty: it has " + str(numVertices) + " vertices and " +
                           str(numFaces) + " faces");
    }
    return Status();
}

Status checkDescriptor(Far::TopologyDescriptor const &descriptor) {
    Status status = checkInventory(descriptor.numVertices, descriptor.numFaces);
    if (status.IsOk() && (!descriptor.numVertsPerFace || !descriptor.vertIndicesPerFace)) {
        status = Status(StatusCode::InvalidArgument, ComponentType::None, Far::INDEX_INVALID,
                        "the descriptor has no arrays of face sizes and face vertices");
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
    return status;
}

Status checkFaces(Far::TopologyLevel const &base) {
    Status status = checkInventory(base.GetNumVertices(), base.GetNumFaces());
    FaceVertexChecker checker(base.GetNumVertices());
    for (Index face = 0; face < base.GetNumFaces() && status.IsOk(); ++face) {
        status = checker.Check(face, base.GetFaceVertices(face));
    }
    return status;
}

// Whether face number \p i of the edge runs from the edge's first vertex to its second.
bool runsForward(Far::TopologyLevel const &base, Index edge, int i) {
    Index const face = base.GetEdgeFaces(edge)[i];
    int const local = base.GetEdgeFaceLocalIndices(edge)[i];
    return base.GetFaceVertices(face)[local] == base.GetEdgeVertices(edge)[0];
}

Status checkEdges(Far::TopologyLevel const &base) {
    for (Index edge = 0; edge < base.GetNumEdges(); ++edge) {
        ConstIndexArray const verts = base.GetEdgeVertices(edge);
        ConstIndexArray const faces = base.GetEdgeFaces(edge);
        std::string const name =
            "edge " + str(edge) + " between vertices " + str(verts[0]) + " and " + str(verts[1]);
        if (faces.size() == 2 && runsForward(base, edge, 0) == runsForward(base, edge, 1)) {
            return invalid(ComponentType::Edge, edge,
                           "faces " + str(faces[0]) + " and " + str(faces[1]) + " run " + name +
                               " in the same direction: their orientations are inconsistent");
        }
        if (faces.size() > 2 || base.IsEdgeNonManifold(edge)) {
            return unsupported(ComponentType::Edge, edge,
                               name + " is non-manifold: it has " + str(faces.size()) + " faces");
        }
        if (faces.size() == 2 && base.GetEdgeSharpness(edge) > 0) {
            return unsupported(ComponentType::Edge, edge,
                               name + " is a crease of sharpness " +
                                   std::to_string(base.GetEdgeSharpness(edge)) +
                                   "; creases are not supported yet");
        }
    }
    return Status();
}

Status checkVertices(Far::TopologyLevel const &base) {
    for (Index vert = 0; vert < base.GetNumVertices(); ++vert) {
        if (base.IsVertexNonManifold(vert)) {
            return unsupported(ComponentType::Vertex, vert,
                               "vertex " + str(vert) +
                                   " is non-manifold: its faces do not form one fan");
        }
        if (base.GetVertexSharpness(vert) > 0) {
            return unsupported(ComponentType::Vertex, vert,
                               "vertex " + str(vert) + " is a corner of sharpness " +
                                   std::to_string(base.GetVertexSharpness(vert)) +
                                   "; corners are not supported yet");
        }
    }
    return Status();
}

Status checkBoundaryRule(Sdc::Options sdcOptions) {
    if (sdcOptions.GetVtxBoundaryInterpolation() != Sdc::Options::VTX_BOUNDARY_NONE) {
        return unsupported(ComponentType::None, Far::INDEX_INVALID,
                           "boundary interpolation other than VTX_BOUNDARY_NONE is not supported "
                           "yet");
    }
    return Status();
}

Status checkBase(Far::TopologyRefiner const &base) {
    Far::TopologyLevel const &level = base.GetLevel(0);
    Status status = checkBoundaryRule(base.GetSchemeOptions());
    if (status.IsOk()) {
        status = checkFaces(level);
    }
    if (status.IsOk()) {
        status = checkEdges(level);
    }
    if (status.IsOk()) {
        status = checkVertices(level);
    }
    return status;
}

void importFaces(Far::TopologyLevel const &base, LevelTopology &level) {
    level.faceFirstCorner.Resize(std::size_t(level.numFaces) + 1);
    level.faceVerts.Resize(level.numCorners);
    level.faceEdges.Resize(level.numCorners);
    Index corner = 0;
    for (Index face = 0; face < level.numFaces; ++face) {
        level.faceFirstCorner[face] = corner;
        ConstIndexArray const verts = base.GetFaceVertices(face);
        ConstIndexArray const edges = base.GetFaceEdges(face);
        for (int i = 0; i < verts.size(); ++i, ++corner) {
            level.faceVerts[corner] = verts[i];
            level.faceEdges[corner] = edges[i];
        }
    }
    level.faceFirstCorner[level.numFaces] = corner;
}

// The first face is made to run from the first vertex to the second, by swapping the faces of an
// interior edge or the vertices of a boundary edge.
void importEdges(Far::TopologyLevel const &base, LevelTopology &level) {
    level.edgeVerts.Resize(2 * std::size_t(level.numEdges));
    level.edgeFaces.Resize(2 * std::size_t(level.numEdges));
    level.edgeFaceLocals.Resize(2 * std::size_t(level.numEdges));
    std::vector<Index> boundaryEdges;
    for (Index edge = 0; edge < level.numEdges; ++edge) {
        std::size_t const k = 2 * std::size_t(edge);
        ConstIndexArray const verts = base.GetEdgeVertices(edge);
        ConstIndexArray const faces = base.GetEdgeFaces(edge);
        bool const isBoundary = faces.size() == 1;
        int const a = runsForward(base, edge, 0) || isBoundary ? 0 : 1;
        int const start = runsForward(base, edge, a) ? 0 : 1;
        level.edgeVerts[k] = verts[start];
        level.edgeVerts[k + 1] = verts[1 - start];
        level.edgeFaces[k] = faces[a];
        level.edgeFaceLocals[k] = base.GetEdgeFaceLocalIndices(edge)[a];
        level.edgeFaces[k + 1] = isBoundary ? Far::INDEX_INVALID : faces[1 - a];
        level.edgeFaceLocals[k + 1] =
            isBoundary ? Far::LocalIndex(0) : base.GetEdgeFaceLocalIndices(edge)[1 - a];
        if (isBoundary) {
            boundaryEdges.push_back(edge);
        }
    }
    level.numBoundaryEdges = Index(boundaryEdges.size());
    level.boundaryEdges.Resize(boundaryEdges.size());
    std::copy(boundaryEdges.begin(), boundaryEdges.end(), level.boundaryEdges.data());
}

// Far orders the edges and faces of a manifold vertex as LevelTopology wants them.
void importVertices(Far::TopologyLevel const &base, LevelTopology &level) {
    level.vertFirstFace.Resize(std::size_t(level.numVertices) + 1);
    level.vertFirstEdge.Resize(std::size_t(level.numVertices) + 1);
    level.vertFaces.Resize(level.numCorners);
    level.vertFaceLocals.Resize(level.numCorners);
    level.vertEdges.Resize(2 * std::size_t(level.numEdges));
    level.vertEdgeLocals.Resize(2 * std::size_t(level.numEdges));
    Index nextFace = 0;
    Index nextEdge = 0;
    for (Index vert = 0; vert < level.numVertices; ++vert) {
        level.vertFirstFace[vert] = nextFace;
        level.vertFirstEdge[vert] = nextEdge;
        ConstIndexArray const faces = base.GetVertexFaces(vert);
        for (int i = 0; i < faces.size(); ++i) {
            level.vertFaces[nextFace] = faces[i];
            level.vertFaceLocals[nextFace++] = base.GetVertexFaceLocalIndices(vert)[i];
        }
        for (Index edge : base.GetVertexEdges(vert)) {
            level.vertEdges[nextEdge] = edge;
            level.vertEdgeLocals[nextEdge++] =
                level.edgeVerts[2 * std::size_t(edge)] == vert ? 0 : 1;
        }
    }
    level.vertFirstFace[level.numVertices] = nextFace;
    level.vertFirstEdge[level.numVertices] = nextEdge;
}

std::unique_ptr<LevelTopology> importBase(Far::TopologyLevel const &base) {
    auto level = std::make_unique<LevelTopology>();
    level->numVertices = base.GetNumVertices();
    level->numEdges = base.GetNumEdges();
    level->numFaces = base.GetNumFaces();
    level->numCorners = base.GetNumFaceVertices();
    level->hasFullTopology = true;
    importFaces(base, *level);
    importEdges(base, *level);
    importVertices(base, *level);
    return level;
}

} // namespace

std::unique_ptr<TopologyRefiner>
TopologyRefinerFactory::Create(Far::TopologyRefiner const &base, Options options, Status *status) {
    if (!internal::Report(checkBase(base), status)) {
        return nullptr;
    }
    return std::make_unique<TopologyRefiner>(importBase(base.GetLevel(0)), base.GetSchemeOptions(),
                                             options.schemeOptions);
}

std::unique_ptr<TopologyRefiner>
TopologyRefinerFactory::Create(Far::TopologyDescriptor const &descriptor, Sdc::Options sdcOptions,
                               Options options, Status *status) {
    if (!internal::Report(checkDescriptor(descriptor), status)) {
        return nullptr;
    }
    using FarFactory = Far::TopologyRefinerFactory<Far::TopologyDescriptor>;
    std::unique_ptr<Far::TopologyRefiner> const base(FarFactory::Create(
        descriptor, FarFactory::Options(OpenSubdiv::Sdc::SCHEME_CATMARK, sdcOptions)));
    if (!base) {
        internal::Report(invalid(ComponentType::None, Far::INDEX_INVALID,
                                 "OpenSubdiv refuses the mesh; its error callback has the cause"),
                         status);
        return nullptr;
    }
    return Create(*base, options, status);
}

} // namespace OpenSubdivHex::FarExt
