// SPDX-License-Identifier: Apache-2.0
#include "topologyLevel.h"

#include "fvarLevel.h"

#include <algorithm>
#include <vector>

namespace OpenSubdivHex::FarExt {

using Index = Far::Index;
using internal::FVarLevel;
using internal::LevelTopology;

namespace {

int numEdgeFaces(LevelTopology const &topology, Index e) { return topology.IsBoundary(e) ? 1 : 2; }

bool contains(std::vector<Index> const &ascending, Index index) {
    return std::binary_search(ascending.begin(), ascending.end(), index);
}

} // namespace

Far::ConstIndexArray TopologyLevel::GetEdgeVertices(Index e) const {
    if (!HasFullTopology()) {
        return ConstIndexArray();
    }
    return ConstIndexArray(_topology->edgeVerts.data() + 2 * std::size_t(e), 2);
}

Far::ConstIndexArray TopologyLevel::GetEdgeFaces(Index e) const {
    if (!HasFullTopology()) {
        return ConstIndexArray();
    }
    return ConstIndexArray(_topology->edgeFaces.data() + 2 * std::size_t(e),
                           numEdgeFaces(*_topology, e));
}

Far::ConstLocalIndexArray TopologyLevel::GetEdgeFaceLocalIndices(Index e) const {
    if (!HasFullTopology()) {
        return ConstLocalIndexArray();
    }
    return ConstLocalIndexArray(_topology->edgeFaceLocals.data() + 2 * std::size_t(e),
                                numEdgeFaces(*_topology, e));
}

Far::ConstIndexArray TopologyLevel::GetVertexFaces(Index v) const {
    return span(_topology->vertFaces, _topology->vertFirstFace, v);
}

Far::ConstLocalIndexArray TopologyLevel::GetVertexFaceLocalIndices(Index v) const {
    return span(_topology->vertFaceLocals, _topology->vertFirstFace, v);
}

Far::ConstIndexArray TopologyLevel::GetVertexEdges(Index v) const {
    return span(_topology->vertEdges, _topology->vertFirstEdge, v);
}

Far::ConstLocalIndexArray TopologyLevel::GetVertexEdgeLocalIndices(Index v) const {
    if (!HasFullTopology()) {
        return ConstLocalIndexArray();
    }
    return ConstLocalIndexArray(_topology->GetVertexEdgeLocals(v),
                                _topology->vertFirstEdge[v + 1] - _topology->vertFirstEdge[v]);
}

Index TopologyLevel::FindEdge(Index v0, Index v1) const {
    for (Index edge : GetVertexEdges(v0)) {
        ConstIndexArray const verts = GetEdgeVertices(edge);
        if ((verts[0] == v0 && verts[1] == v1) || (verts[0] == v1 && verts[1] == v0)) {
            return edge;
        }
    }
    return Far::INDEX_INVALID;
}

bool TopologyLevel::IsEdgeBoundary(Index e) const { return GetEdgeFaces(e).size() == 1; }

bool TopologyLevel::IsVertexBoundary(Index v) const {
    return GetVertexEdges(v).size() > GetVertexFaces(v).size();
}

bool TopologyLevel::IsEdgeNonManifold(Index e) const {
    return contains(_topology->nonManifoldEdges, e);
}

bool TopologyLevel::IsVertexNonManifold(Index v) const {
    return contains(_topology->nonManifoldVerts, v);
}

float TopologyLevel::GetEdgeSharpness(Index e) const {
    if (HasFullTopology() && _topology->IsBoundary(e)) {
        bool const isFree = _topology->edgeFaces[2 * std::size_t(e) + 1] == internal::kFreeBoundary;
        return isFree ? Sdc::Crease::SHARPNESS_SMOOTH : Sdc::Crease::SHARPNESS_INFINITE;
    }
    return _topology->GetEdgeSharpness(e);
}

Sdc::Crease::Rule TopologyLevel::GetVertexRule(Index v) const {
    internal::SharpVertex const *sharp = _topology->FindSharpVertex(v);
    return sharp ? sharp->rule : Sdc::Crease::RULE_SMOOTH;
}

bool TopologyLevel::IsVertexValenceRegular(Index v) const {
    int const numFaces = GetVertexFaces(v).size();
    return IsVertexBoundary(v) ? (numFaces <= 2) : (numFaces == 3);
}

int TopologyLevel::GetNumFVarValues(int channel) const {
    return _topology->fvarLevels[channel]->numValues;
}

Far::ConstIndexArray TopologyLevel::GetFaceFVarValues(Index f, int channel) const {
    FVarLevel const &fvarLevel = *_topology->fvarLevels[channel];
    if (!fvarLevel.faceValues.empty()) {
        return span(fvarLevel.faceValues, _topology->faceFirstCorner, f);
    }
    if (FVarLevel::SplitFace const *split = fvarLevel.FindSplitFace(f)) {
        return ConstIndexArray(split->values, HexIndexing::kNumEFaceCorners);
    }
    return TopologyLevel(&fvarLevel.topology).GetFaceVertices(fvarLevel.valueFaces[f]);
}

bool TopologyLevel::IsFaceFVarSplit(Index f, int channel) const {
    return _topology->fvarLevels[channel]->FindSplitFace(f) != nullptr;
}

Far::ConstIndexArray TopologyLevel::GetFaceFVarValues(Index f, int channel, int half) const {
    FVarLevel const &fvarLevel = *_topology->fvarLevels[channel];
    FVarLevel::SplitFace const *split = fvarLevel.FindSplitFace(f);
    return split ? TopologyLevel(&fvarLevel.topology).GetFaceVertices(split->valueFaces[half])
                 : ConstIndexArray();
}

bool TopologyLevel::DoesEdgeFVarTopologyMatch(Index e, int channel) const {
    if (IsEdgeBoundary(e)) {
        return true;
    }
    FVarLevel const &fvarLevel = *_topology->fvarLevels[channel];
    ConstIndexArray const faces = GetEdgeFaces(e);
    ConstLocalIndexArray const locals = GetEdgeFaceLocalIndices(e);
    return fvarLevel.GetFaceEdge(faces[0], locals[0]) == fvarLevel.GetFaceEdge(faces[1], locals[1]);
}

bool TopologyLevel::DoesVertexFVarTopologyMatch(Index v, int channel) const {
    ConstIndexArray const faces = GetVertexFaces(v);
    ConstLocalIndexArray const locals = GetVertexFaceLocalIndices(v);
    ConstIndexArray const edges = GetVertexEdges(v);
    auto isSplitHere = [&](int i) {
        bool const onDiagonal = locals[i] == kDiagonalStart || locals[i] == kDiagonalEnd;
        return onDiagonal && IsFaceFVarSplit(faces[i], channel);
    };
    for (int i = 0; i < faces.size(); ++i) {
        if (GetFaceFVarValues(faces[i], channel)[locals[i]] !=
                GetFaceFVarValues(faces[0], channel)[locals[0]] ||
            isSplitHere(i)) {
            return false;
        }
    }
    return std::all_of(edges.begin(), edges.end(),
                       [&](Index e) { return DoesEdgeFVarTopologyMatch(e, channel); });
}

bool TopologyLevel::DoesFaceFVarTopologyMatch(Index f, int channel) const {
    ConstIndexArray const verts = GetFaceVertices(f);
    return std::all_of(verts.begin(), verts.end(),
                       [&](Index v) { return DoesVertexFVarTopologyMatch(v, channel); });
}

FaceKind TopologyLevel::GetFaceKind(Index f) const {
    if (!_topology->parent) {
        return FaceKind::Base;
    }
    if (f < _topology->parent->numFaces) {
        return FaceKind::Face;
    }
    return f < _topology->numFaces - _topology->numVFaces ? FaceKind::Edge : FaceKind::Vertex;
}

namespace {

// The corner of the parent that the last vertex of a face was made of: of an E-face, that where the
// first face of its edge runs along it; of a V-face, one at its vertex.
Index parentCornerOf(LevelTopology const &topology, Index f) {
    Index const lastVert = topology.faceVerts[topology.faceFirstCorner[f + 1] - 1];
    return topology.parent->GetChildVertexCorner(lastVert);
}

} // namespace

Index TopologyLevel::GetFaceParentEdge(Index f) const {
    if (GetFaceKind(f) != FaceKind::Edge) {
        return Far::INDEX_INVALID;
    }
    return _topology->parent->faceEdges[parentCornerOf(*_topology, f)];
}

Index TopologyLevel::GetFaceParentVertex(Index f) const {
    if (GetFaceKind(f) != FaceKind::Vertex) {
        return Far::INDEX_INVALID;
    }
    return _topology->parent->faceVerts[parentCornerOf(*_topology, f)];
}

Index TopologyLevel::GetFaceParentFace(Index f) const {
    switch (GetFaceKind(f)) {
    case FaceKind::Face:
        return f;
    case FaceKind::Edge:
        return _topology->parent->edgeFaces[2 * std::size_t(GetFaceParentEdge(f))];
    case FaceKind::Vertex: {
        TopologyLevel const parent(_topology->parent);
        Index const vert = GetFaceParentVertex(f);
        int i = 0;
        while (parent.GetVertexCorner(vert, i) != parentCornerOf(*_topology, f)) {
            ++i;
        }
        return parent.GetVertexFaces(vert)[i];
    }
    case FaceKind::Base:
        break;
    }
    return Far::INDEX_INVALID;
}

Index TopologyLevel::GetFaceBaseFace(Index f) const {
    for (LevelTopology const *level = _topology; level->parent; level = level->parent) {
        f = TopologyLevel(level).GetFaceParentFace(f);
    }
    return f;
}

Far::ConstIndexArray TopologyLevel::GetFaceChildFaces(Index f) const {
    if (!_topology->child) {
        return ConstIndexArray();
    }
    return ConstIndexArray(_topology->faceChildFaces.data() + f, 1);
}

Far::ConstIndexArray TopologyLevel::GetFaceChildVertices(Index f) const {
    if (!_topology->child) {
        return ConstIndexArray();
    }
    return TopologyLevel(_topology->child).GetFaceVertices(_topology->faceChildFaces[f]);
}

Far::ConstIndexArray TopologyLevel::GetFaceChildEdges(Index f) const {
    if (!_topology->child) {
        return ConstIndexArray();
    }
    return TopologyLevel(_topology->child).GetFaceEdges(_topology->faceChildFaces[f]);
}

Far::ConstIndexArray TopologyLevel::GetEdgeChildEdges(Index e) const {
    if (!_topology->child || !IsEdgeBoundary(e) || GetEdgeChildFace(e) == Far::INDEX_INVALID) {
        return ConstIndexArray();
    }
    ConstIndexArray const edges = TopologyLevel(_topology->child).GetFaceEdges(GetEdgeChildFace(e));
    return edges.empty() ? edges : ConstIndexArray(&edges[kBoundaryEFaceEdge], 1);
}

Index TopologyLevel::GetEdgeChildFace(Index e) const {
    return _topology->child ? _topology->GetEdgeChildFace(e) : Far::INDEX_INVALID;
}

Index TopologyLevel::GetVertexChildVertex(Index v) const {
    return _topology->child ? _topology->GetVertexChildVertex(v) : Far::INDEX_INVALID;
}

namespace {

// Looks for a broken invariant; each check returns false after naming the first.
class Validator {
public:
    Validator(TopologyLevel const &level, LevelTopology const &topology)
        : _level(level), _topology(topology) {}

    bool Run() {
        return checkSizes() && checkFaces() &&
               (!_topology.hasFullTopology ||
                (checkFaceEdges() && checkEdges() && checkVertices())) &&
               (!_topology.parent || (checkFFaces() && checkEFaces() && checkVFaces()));
    }

    Status const &GetStatus() const { return _status; }

private:
    bool require(bool holds, ComponentType component, Index index, char const *cause) {
        if (!holds && _status.IsOk()) {
            static char const *const kNames[] = {"level", "face", "edge", "vertex", "level"};
            _status =
                Status(StatusCode::InvalidTopology, component, index,
                       "level " + std::to_string(_level.GetDepth()) + ", " +
                           kNames[int(component)] + " " + std::to_string(index) + ": " + cause);
        }
        return holds;
    }

    template <typename T>
    bool sized(internal::Buffer<T> const &array, std::size_t size) {
        return require(array.size() == size, ComponentType::Level, _level.GetDepth(),
                       "an array has the wrong size");
    }

    // Offsets that start at 0, never fall, and end at the size of what they divide.
    bool offsets(internal::Buffer<Index> const &first, std::size_t count, std::size_t end,
                 ComponentType component) {
        if (!sized(first, count + 1) || !require(first[0] == 0, component, 0, "offset is not 0")) {
            return false;
        }
        for (std::size_t i = 0; i < count; ++i) {
            if (!require(first[i] <= first[i + 1], component, Index(i), "offsets fall")) {
                return false;
            }
        }
        return require(std::size_t(first[count]) == end, component, Index(count) - 1,
                       "the last offset is not the size of the array");
    }

    bool checkSizes();
    bool checkFaces();
    bool checkFaceEdges();
    bool checkEdges();
    bool checkVertices();
    bool checkFFaces();
    bool checkEFaces();
    bool checkVFaces();

    TopologyLevel const _level;
    LevelTopology const &_topology;
    Status _status;
};

bool Validator::checkSizes() {
    LevelTopology const &t = _topology;
    std::size_t const numEdges = t.numEdges;
    std::size_t const numCorners = t.numCorners;
    if (!sized(t.faceVerts, numCorners) ||
        !offsets(t.faceFirstCorner, t.numFaces, numCorners, ComponentType::Face)) {
        return false;
    }
    if (!t.hasFullTopology) {
        return true;
    }
    bool const hasVertexEdgeLocals =
        !t.vertEdgeLocals.empty() || !t.isHexagonal || _level.GetNumBoundaryEdges() > 0;
    return sized(t.faceEdges, numCorners) && sized(t.edgeVerts, 2 * numEdges) &&
           sized(t.edgeFaces, 2 * numEdges) && sized(t.edgeFaceLocals, 2 * numEdges) &&
           sized(t.boundaryEdges, _level.GetNumBoundaryEdges()) &&
           sized(t.halfFaces, t.numSharpBoundariesB) && sized(t.vertFaces, numCorners) &&
           sized(t.vertFaceLocals, numCorners) && sized(t.vertEdges, 2 * numEdges) &&
           sized(t.vertEdgeLocals, hasVertexEdgeLocals ? 2 * numEdges : 0) &&
           offsets(t.vertFirstFace, t.numVertices, numCorners, ComponentType::Vertex) &&
           offsets(t.vertFirstEdge, t.numVertices, 2 * numEdges, ComponentType::Vertex);
}

bool Validator::checkFaces() {
    std::vector<Index> lastFace(_level.GetNumVertices(), Far::INDEX_INVALID);
    for (Index face = 0; face < _level.GetNumFaces(); ++face) {
        Far::ConstIndexArray const verts = _level.GetFaceVertices(face);
        if (!require(verts.size() >= 3, ComponentType::Face, face, "fewer than three vertices")) {
            return false;
        }
        for (Index vert : verts) {
            bool const inRange = 0 <= vert && vert < _level.GetNumVertices();
            if (!require(inRange, ComponentType::Face, face, "a vertex is out of range") ||
                !require(lastFace[vert] != face || _level.IsVertexNonManifold(vert),
                         ComponentType::Face, face, "a vertex is repeated")) {
                return false;
            }
            lastFace[vert] = face;
        }
    }
    return true;
}

bool Validator::checkFaceEdges() {
    for (Index face = 0; face < _level.GetNumFaces(); ++face) {
        Far::ConstIndexArray const verts = _level.GetFaceVertices(face);
        Far::ConstIndexArray const edges = _level.GetFaceEdges(face);
        for (int i = 0; i < edges.size(); ++i) {
            bool const inRange = 0 <= edges[i] && edges[i] < _level.GetNumEdges();
            if (!require(inRange, ComponentType::Face, face, "an edge is out of range")) {
                return false;
            }
            Far::ConstIndexArray const edgeVerts = _level.GetEdgeVertices(edges[i]);
            Far::ConstIndexArray const edgeFaces = _level.GetEdgeFaces(edges[i]);
            Index const start = verts[i];
            Index const end = verts[(i + 1) % verts.size()];
            int const side =
                (edgeFaces[0] == face && _level.GetEdgeFaceLocalIndices(edges[i])[0] == i) ? 0 : 1;
            if (!require(edgeVerts[side] == start && edgeVerts[1 - side] == end,
                         ComponentType::Face, face, "an edge does not join its two vertices") ||
                !require(side < edgeFaces.size() && edgeFaces[side] == face &&
                             _level.GetEdgeFaceLocalIndices(edges[i])[side] == i,
                         ComponentType::Edge, edges[i], "a face is not on the side it runs on")) {
                return false;
            }
        }
    }
    return true;
}

// With checkFaceEdges, which sees each side of each edge once, the sum of sides being the number
// of corners shows that no edge names a face that does not have it.
bool Validator::checkEdges() {
    std::int64_t numSides = 0;
    std::size_t numBoundary = 0;
    for (Index edge = 0; edge < _level.GetNumEdges(); ++edge) {
        Far::ConstIndexArray const verts = _level.GetEdgeVertices(edge);
        bool const inRange = 0 <= std::min(verts[0], verts[1]) &&
                             std::max(verts[0], verts[1]) < _level.GetNumVertices();
        bool const isLoop = inRange && verts[0] == verts[1];
        if (!require(inRange && !(isLoop && !_level.IsVertexNonManifold(verts[0])),
                     ComponentType::Edge, edge, "its vertices are not two of the level")) {
            return false;
        }
        numSides += _level.GetEdgeFaces(edge).size();
        if (_level.IsEdgeBoundary(edge)) {
            bool const listed = numBoundary < _topology.boundaryEdges.size() &&
                                _topology.boundaryEdges[numBoundary] == edge;
            if (!require(listed, ComponentType::Edge, edge, "not in the list of boundaries")) {
                return false;
            }
            ++numBoundary;
        }
    }
    return require(numSides == _level.GetNumFaceVertices(), ComponentType::Level, _level.GetDepth(),
                   "edges have not as many sides as faces") &&
           require(numBoundary == _topology.boundaryEdges.size(), ComponentType::Level,
                   _level.GetDepth(), "the list of boundaries is too long");
}

// As for edges: what each vertex names has it, and the sizes of the arrays leave no room for
// anything missing or repeated.  Faces are followed fan by fan: a fan that begins with a boundary
// edge ends with one and has an edge more than faces, any other comes back to its first edge.
bool Validator::checkVertices() {
    for (Index vert = 0; vert < _level.GetNumVertices(); ++vert) {
        Far::ConstIndexArray const faces = _level.GetVertexFaces(vert);
        Far::ConstIndexArray const edges = _level.GetVertexEdges(vert);
        Far::ConstLocalIndexArray const inFace = _level.GetVertexFaceLocalIndices(vert);
        Far::ConstLocalIndexArray const inEdge = _level.GetVertexEdgeLocalIndices(vert);
        for (int i = 0; i < edges.size(); ++i) {
            bool const inRange = 0 <= edges[i] && edges[i] < _level.GetNumEdges() && inEdge[i] < 2;
            if (!require(inRange && _level.GetEdgeVertices(edges[i])[inEdge[i]] == vert,
                         ComponentType::Vertex, vert, "an edge does not have it there")) {
                return false;
            }
        }
        int numFans = 0;
        int edge = 0;
        int fanStart = 0;
        bool inFan = false;
        for (int i = 0; i < faces.size(); ++i) {
            bool const inRange = 0 <= faces[i] && faces[i] < _level.GetNumFaces() &&
                                 inFace[i] < _level.GetFaceVertices(faces[i]).size();
            if (!require(inRange && _level.GetFaceVertices(faces[i])[inFace[i]] == vert,
                         ComponentType::Vertex, vert, "a face does not have it there")) {
                return false;
            }
            if (!inFan) {
                fanStart = edge;
                inFan = true;
                ++numFans;
            }
            Far::ConstIndexArray const faceEdges = _level.GetFaceEdges(faces[i]);
            Index const outEdge = faceEdges[inFace[i]];
            Index const backEdge = faceEdges[(inFace[i] + faceEdges.size() - 1) % faceEdges.size()];
            if (!require(edge < edges.size() && edges[edge] == outEdge, ComponentType::Vertex, vert,
                         "a face does not begin at its edge")) {
                return false;
            }
            ++edge;
            bool const isOpen = _level.IsEdgeBoundary(edges[fanStart]);
            if (isOpen && _level.IsEdgeBoundary(backEdge)) {
                if (!require(edge < edges.size() && edges[edge] == backEdge, ComponentType::Vertex,
                             vert, "a fan of faces does not end at its boundary edge")) {
                    return false;
                }
                ++edge;
                inFan = false;
            } else if (!isOpen && backEdge == edges[fanStart]) {
                inFan = false;
            }
        }
        if (!require(!inFan && edge == edges.size(), ComponentType::Vertex, vert,
                     "its edges and faces do not alternate") ||
            !require(numFans <= 1 || _level.IsVertexNonManifold(vert), ComponentType::Vertex, vert,
                     "more than one fan of faces, but not tagged non-manifold")) {
            return false;
        }
    }
    return true;
}

bool Validator::checkFFaces() {
    LevelTopology const &parent = *_topology.parent;
    for (Index pFace = 0; pFace < parent.numFaces; ++pFace) {
        Index const cFace = parent.faceChildFaces[pFace];
        Far::ConstIndexArray const verts = _level.GetFaceVertices(cFace);
        Index const first = parent.faceFirstCorner[pFace];
        bool good = verts.size() == parent.faceFirstCorner[pFace + 1] - first;
        for (int i = 0; good && i < verts.size(); ++i) {
            good = verts[i] == parent.GetCornerChildVertex(first + i);
        }
        if (!require(good, ComponentType::Face, cFace, "not the F-face of its parent")) {
            return false;
        }
    }
    return true;
}

bool Validator::checkEFaces() {
    LevelTopology const &topology = *_topology.parent;
    TopologyLevel const parent(&topology);
    std::vector<Index> expected;
    for (Index pEdge = 0; pEdge < parent.GetNumEdges(); ++pEdge) {
        Index const cFace = parent.GetEdgeChildFace(pEdge);
        if (cFace == Far::INDEX_INVALID) {
            continue;
        }
        // V-vertex, unless the edge makes a quad of its F-vertices alone, then the two F-vertices
        // of the face on the far side, for each end.
        expected.clear();
        Far::ConstIndexArray const actual = _level.GetFaceVertices(cFace);
        Far::ConstIndexArray const verts = parent.GetEdgeVertices(pEdge);
        Far::ConstIndexArray const faces = parent.GetEdgeFaces(pEdge);
        Far::ConstLocalIndexArray const locals = parent.GetEdgeFaceLocalIndices(pEdge);
        bool const isQuad = faces.size() == 2 && actual.size() == 4;
        for (int side = 0; side < 2; ++side) {
            if (!isQuad) {
                expected.push_back(topology.GetVertexChildVertex(verts[side]));
            }
            if (faces.size() == 1 && side == 0) {
                continue;
            }
            int const far = (faces.size() == 2) ? 1 - side : 0;
            int const size = parent.GetFaceVertices(faces[far]).size();
            Index const first = parent.GetFaceFirstCorner(faces[far]);
            expected.push_back(topology.GetCornerChildVertex(first + (locals[far] + 1) % size));
            expected.push_back(topology.GetCornerChildVertex(first + locals[far]));
        }
        bool const good = actual.size() == int(expected.size()) &&
                          std::equal(expected.begin(), expected.end(), actual.begin());
        if (!require(good, ComponentType::Face, cFace, "not the E-face of its parent edge")) {
            return false;
        }
    }
    return true;
}

// A V-face has its V-vertex first or not at all, and F-vertices of faces around its vertex: those
// of corners there or, in tri-hex, of the corners before.
bool Validator::checkVFaces() {
    LevelTopology const &topology = *_topology.parent;
    TopologyLevel const parent(&topology);
    for (Index cFace = _topology.numFaces - _topology.numVFaces; cFace < _topology.numFaces;
         ++cFace) {
        Far::ConstIndexArray const verts = _level.GetFaceVertices(cFace);
        bool good = verts[verts.size() - 1] >= topology.numVVertices;
        Index const vert = good ? _level.GetFaceParentVertex(cFace) : Far::INDEX_INVALID;
        for (int i = 0; good && i < verts.size(); ++i) {
            if (verts[i] < topology.numVVertices) {
                good = i == 0 && topology.GetVertexChildVertex(vert) == verts[i];
                continue;
            }
            Index const corner = topology.GetChildVertexCorner(verts[i]);
            Far::ConstIndexArray const faces = parent.GetVertexFaces(vert);
            good = false;
            for (int j = 0; j < faces.size(); ++j) {
                Index const atVertex = parent.GetVertexCorner(vert, j);
                good |= corner == atVertex || corner == topology.GetPrevCorner(faces[j], atVertex);
            }
        }
        if (!require(good, ComponentType::Face, cFace, "not a V-face of its parent vertex")) {
            return false;
        }
    }
    return true;
}

} // namespace

bool TopologyLevel::Validate(Status *status) const {
    Validator validator(*this, *_topology);
    Status result = validator.Run() ? Status() : validator.GetStatus();
    for (std::size_t channel = 0; channel < _topology->fvarLevels.size() && result.IsOk();
         ++channel) {
        // Values are the vertices of a mesh of their own; level 0 may have values without faces
        // and, in place of shared values, more vertices than values.
        LevelTopology const &values = _topology->fvarLevels[channel]->topology;
        Validator valueValidator(TopologyLevel(&values), values);
        if (!valueValidator.Run()) {
            Status const &cause = valueValidator.GetStatus();
            result = Status(cause.GetCode(), ComponentType::None, Far::INDEX_INVALID,
                            "face-varying channel " + std::to_string(channel) + ": " +
                                cause.GetMessage());
        }
    }
    return internal::Report(result, status);
}

} // namespace OpenSubdivHex::FarExt
