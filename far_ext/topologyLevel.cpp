// SPDX-License-Identifier: Apache-2.0
#include "topologyLevel.h"

#include <algorithm>
#include <vector>

namespace OpenSubdivHex::FarExt {

using Index = Far::Index;
using internal::LevelTopology;

namespace {

int numEdgeFaces(LevelTopology const &topology, Index e) {
    return topology.edgeFaces[2 * std::size_t(e) + 1] == Far::INDEX_INVALID ? 1 : 2;
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
    return span(_topology->vertEdgeLocals, _topology->vertFirstEdge, v);
}

Index TopologyLevel::FindEdge(Index v0, Index v1) const {
    for (Index edge : GetVertexEdges(v0)) {
        ConstIndexArray const verts = GetEdgeVertices(edge);
        if (verts[0] == v1 || verts[1] == v1) {
            return edge;
        }
    }
    return Far::INDEX_INVALID;
}

bool TopologyLevel::IsEdgeBoundary(Index e) const { return GetEdgeFaces(e).size() == 1; }

bool TopologyLevel::IsVertexBoundary(Index v) const {
    return GetVertexEdges(v).size() > GetVertexFaces(v).size();
}

bool TopologyLevel::IsVertexValenceRegular(Index v) const {
    int const numFaces = GetVertexFaces(v).size();
    return IsVertexBoundary(v) ? (numFaces <= 2) : (numFaces == 3);
}

FaceKind TopologyLevel::GetFaceKind(Index f) const {
    if (!_topology->parent) {
        return FaceKind::Base;
    }
    return _topology->parent->ChildIndexing().IsFaceFromEdge(f) ? FaceKind::Edge : FaceKind::Face;
}

Index TopologyLevel::GetFaceParentEdge(Index f) const {
    if (GetFaceKind(f) != FaceKind::Edge) {
        return Far::INDEX_INVALID;
    }
    return _topology->parent->ChildIndexing().GetChildFaceEdge(f);
}

Index TopologyLevel::GetFaceParentFace(Index f) const {
    switch (GetFaceKind(f)) {
    case FaceKind::Face:
        return f;
    case FaceKind::Edge:
        return _topology->parent->edgeFaces[2 * std::size_t(GetFaceParentEdge(f))];
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
    return TopologyLevel(_topology->child)
        .GetFaceVertices(GetChildIndexing().GetFaceChildFace(f));
}

Far::ConstIndexArray TopologyLevel::GetFaceChildEdges(Index f) const {
    if (!_topology->child) {
        return ConstIndexArray();
    }
    return TopologyLevel(_topology->child).GetFaceEdges(GetChildIndexing().GetFaceChildFace(f));
}

Far::ConstIndexArray TopologyLevel::GetEdgeChildEdges(Index e) const {
    if (!_topology->child || !IsEdgeBoundary(e)) {
        return ConstIndexArray();
    }
    ConstIndexArray const edges = TopologyLevel(_topology->child).GetFaceEdges(GetEdgeChildFace(e));
    return edges.size() ? ConstIndexArray(&edges[kBoundaryEFaceEdge], 1) : edges;
}

Index TopologyLevel::GetEdgeChildFace(Index e) const {
    return _topology->child ? GetChildIndexing().GetEdgeChildFace(e) : Far::INDEX_INVALID;
}

Index TopologyLevel::GetVertexChildVertex(Index v) const {
    return _topology->child ? GetChildIndexing().GetVertexChildVertex(v) : Far::INDEX_INVALID;
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
               (!_topology.parent || (checkFFaces() && checkEFaces()));
    }

    Status const &GetStatus() const { return _status; }

private:
    bool require(bool holds, ComponentType component, Index index, char const *cause) {
        if (!holds && _status.IsOk()) {
            static char const *const kNames[] = {"level", "face", "edge", "vertex", "level"};
            _status = Status(StatusCode::InvalidTopology, component, index,
                             "level " + std::to_string(_level.GetDepth()) + ", " +
                                 kNames[int(component)] + " " + std::to_string(index) + ": " +
                                 cause);
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

    TopologyLevel const &_level;
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
    return sized(t.faceEdges, numCorners) && sized(t.edgeVerts, 2 * numEdges) &&
           sized(t.edgeFaces, 2 * numEdges) && sized(t.edgeFaceLocals, 2 * numEdges) &&
           sized(t.boundaryEdges, t.numBoundaryEdges) && sized(t.vertFaces, numCorners) &&
           sized(t.vertFaceLocals, numCorners) && sized(t.vertEdges, 2 * numEdges) &&
           sized(t.vertEdgeLocals, 2 * numEdges) &&
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
                !require(lastFace[vert] != face, ComponentType::Face, face,
                         "a vertex is repeated")) {
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
            int const side = (edgeVerts[0] == start) ? 0 : 1;
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
        if (!require(inRange && verts[0] != verts[1], ComponentType::Edge, edge,
                     "its vertices are not two of the level")) {
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
    return require(numSides == _level.GetNumFaceVertices(), ComponentType::Level,
                   _level.GetDepth(), "edges have not as many sides as faces") &&
           require(numBoundary == _topology.boundaryEdges.size(), ComponentType::Level,
                   _level.GetDepth(), "the list of boundaries is too long");
}

// As for edges: what each vertex names has it, and the sizes of the arrays leave no room for
// anything missing or repeated.
bool Validator::checkVertices() {
    for (Index vert = 0; vert < _level.GetNumVertices(); ++vert) {
        Far::ConstIndexArray const faces = _level.GetVertexFaces(vert);
        Far::ConstIndexArray const edges = _level.GetVertexEdges(vert);
        Far::ConstLocalIndexArray const inFace = _level.GetVertexFaceLocalIndices(vert);
        Far::ConstLocalIndexArray const inEdge = _level.GetVertexEdgeLocalIndices(vert);
        bool const onBoundary = edges.size() == faces.size() + 1;
        if (!require(onBoundary || edges.size() == faces.size(), ComponentType::Vertex, vert,
                     "edges and faces do not alternate")) {
            return false;
        }
        for (int i = 0; i < edges.size(); ++i) {
            bool const inRange = 0 <= edges[i] && edges[i] < _level.GetNumEdges() && inEdge[i] < 2;
            if (!require(inRange && _level.GetEdgeVertices(edges[i])[inEdge[i]] == vert,
                         ComponentType::Vertex, vert, "an edge does not have it there")) {
                return false;
            }
            bool const atEnd = (i == 0 || i == edges.size() - 1);
            if (!require(_level.IsEdgeBoundary(edges[i]) == (onBoundary && atEnd),
                         ComponentType::Vertex, vert, "a boundary edge is not first or last")) {
                return false;
            }
        }
        for (int i = 0; i < faces.size(); ++i) {
            bool const inRange = 0 <= faces[i] && faces[i] < _level.GetNumFaces() &&
                                 inFace[i] < _level.GetFaceVertices(faces[i]).size();
            if (!require(inRange && _level.GetFaceVertices(faces[i])[inFace[i]] == vert,
                         ComponentType::Vertex, vert, "a face does not have it there")) {
                return false;
            }
            Far::ConstIndexArray const faceEdges = _level.GetFaceEdges(faces[i]);
            int const prev = (inFace[i] + faceEdges.size() - 1) % faceEdges.size();
            if (!require(faceEdges[inFace[i]] == edges[i] &&
                             faceEdges[prev] == edges[(i + 1) % edges.size()],
                         ComponentType::Vertex, vert, "a face is not between its two edges")) {
                return false;
            }
        }
    }
    return true;
}

bool Validator::checkFFaces() {
    TopologyLevel const parent(_topology.parent);
    HexIndexing const indexing = parent.GetChildIndexing();
    for (Index pFace = 0; pFace < parent.GetNumFaces(); ++pFace) {
        Index const cFace = indexing.GetFaceChildFace(pFace);
        Far::ConstIndexArray const verts = _level.GetFaceVertices(cFace);
        bool good = verts.size() == parent.GetFaceVertices(pFace).size();
        for (int i = 0; good && i < verts.size(); ++i) {
            Index const corner = parent.GetFaceFirstCorner(pFace) + i;
            good = verts[i] == indexing.GetCornerChildVertex(corner);
        }
        if (!require(good, ComponentType::Face, cFace, "not the F-face of its parent")) {
            return false;
        }
    }
    return true;
}

bool Validator::checkEFaces() {
    TopologyLevel const parent(_topology.parent);
    HexIndexing const indexing = parent.GetChildIndexing();
    std::vector<Index> expected;
    for (Index pEdge = 0; pEdge < parent.GetNumEdges(); ++pEdge) {
        // V-vertex, then the two F-vertices of the face on the far side, for each end.
        expected.clear();
        Far::ConstIndexArray const verts = parent.GetEdgeVertices(pEdge);
        Far::ConstIndexArray const faces = parent.GetEdgeFaces(pEdge);
        Far::ConstLocalIndexArray const locals = parent.GetEdgeFaceLocalIndices(pEdge);
        for (int side = 0; side < 2; ++side) {
            expected.push_back(indexing.GetVertexChildVertex(verts[side]));
            if (faces.size() == 1 && side == 0) {
                continue;
            }
            int const far = (faces.size() == 2) ? 1 - side : 0;
            int const size = parent.GetFaceVertices(faces[far]).size();
            Index const first = parent.GetFaceFirstCorner(faces[far]);
            expected.push_back(
                indexing.GetCornerChildVertex(first + (locals[far] + 1) % size));
            expected.push_back(indexing.GetCornerChildVertex(first + locals[far]));
        }
        Index const cFace = indexing.GetEdgeChildFace(pEdge);
        Far::ConstIndexArray const actual = _level.GetFaceVertices(cFace);
        bool const good = actual.size() == int(expected.size()) &&
                          std::equal(expected.begin(), expected.end(), actual.begin());
        if (!require(good, ComponentType::Face, cFace, "not the E-face of its parent edge")) {
            return false;
        }
    }
    return true;
}

} // namespace

bool TopologyLevel::Validate(Status *status) const {
    Validator validator(*this, *_topology);
    validator.Run();
    return internal::Report(validator.GetStatus(), status);
}

} // namespace OpenSubdivHex::FarExt
