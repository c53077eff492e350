// SPDX-License-Identifier: Apache-2.0
#include "validator.h"

#include "truncationMask.h"

#include <algorithm>

namespace OpenSubdivHex::FarExt::internal {

namespace {

using Index = Far::Index;
using LocalIndex = Far::LocalIndex;

// Looks for a broken invariant; each check returns false after naming the first.
class Validator {
public:
    Validator(Level const &level, Refinement const *refinement)
        : _level(level), _refinement(refinement) {}

    bool Run() {
        return checkSizes() && checkFaces() &&
               (!_level.hasFullTopology || (checkFaceEdges() && checkEdges() && checkVertices())) &&
               (!_refinement || (checkFFaces() && checkEFaces() && checkVFaces()));
    }

    CallStatus const &GetStatus() const { return _status; }

private:
    bool require(bool holds, ComponentType component, Index index, char const *cause) {
        if (!holds && _status.IsOk()) {
            static char const *const kNames[] = {"level", "face", "edge", "vertex", "level"};
            _status =
                CallStatus(StatusCode::InvalidTopology, component, index,
                           "level " + std::to_string(_level.depth) + ", " + kNames[int(component)] +
                               " " + std::to_string(index) + ": " + cause);
        }
        return holds;
    }

    template <typename T>
    bool sized(Buffer<T> const &array, std::size_t size) {
        return require(array.size() == size, ComponentType::Level, _level.depth,
                       "an array has the wrong size");
    }

    // Offsets that start at 0, never fall, and end at the size of what they divide.
    bool offsets(Buffer<Index> const &first, std::size_t count, std::size_t end,
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
    bool isBesideVertex(Index cVert, Index pVert) const;

    Level const &_level;
    Refinement const *_refinement; // that made the level
    CallStatus _status;
};

bool Validator::checkSizes() {
    bool good = true;
    Level::ForEachRelation(_level, [&](auto const &array, std::size_t size) {
        // The order of edges around vertices may lie in the place of that of faces.
        good = good && (size == 0 || sized(array, size));
    });
    if (!good ||
        !offsets(_level.faceFirstCorner, _level.numFaces, _level.numCorners, ComponentType::Face)) {
        return false;
    }
    return !_level.hasFullTopology ||
           (offsets(_level.vertFirstFace, _level.numVertices, _level.numCorners,
                    ComponentType::Vertex) &&
            offsets(_level.vertFirstEdge, _level.numVertices, 2 * std::size_t(_level.numEdges),
                    ComponentType::Vertex));
}

bool Validator::checkFaces() {
    std::vector<Index> lastFace(_level.numVertices, Far::INDEX_INVALID);
    for (Index face = 0; face < _level.numFaces; ++face) {
        Far::ConstIndexArray const verts = _level.GetFaceVertices(face);
        if (!require(verts.size() >= 3, ComponentType::Face, face, "fewer than three vertices")) {
            return false;
        }
        for (Index vert : verts) {
            bool const inRange = 0 <= vert && vert < _level.numVertices;
            if (!require(inRange, ComponentType::Face, face, "a vertex is out of range") ||
                !require(lastFace[vert] != face || _level.IsNonManifold(vert), ComponentType::Face,
                         face, "a vertex is repeated")) {
                return false;
            }
            lastFace[vert] = face;
        }
    }
    return true;
}

bool Validator::checkFaceEdges() {
    for (Index face = 0; face < _level.numFaces; ++face) {
        Index const first = _level.faceFirstCorner[face];
        int const size = _level.GetFaceSize(face);
        for (int i = 0; i < size; ++i) {
            Index const edge = _level.faceEdges[first + i];
            bool const inRange = 0 <= edge && edge < _level.numEdges;
            if (!require(inRange, ComponentType::Face, face, "an edge is out of range")) {
                return false;
            }
            IndexPair const &verts = _level.edgeVerts[edge];
            auto const isOnSide = [&](int side) {
                return _level.edgeFaces[edge][side] == face &&
                       _level.edgeFaceLocals[edge][side] == i;
            };
            int const side = isOnSide(0) ? 0 : 1;
            if (!require(verts[side] == _level.faceVerts[first + i] &&
                             verts[1 - side] == _level.faceVerts[first + (i + 1) % size],
                         ComponentType::Face, face, "an edge does not join its two vertices") ||
                !require(isOnSide(side), ComponentType::Edge, edge,
                         "a face is not on the side it runs on")) {
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
    for (Index edge = 0; edge < _level.numEdges; ++edge) {
        IndexPair const &verts = _level.edgeVerts[edge];
        bool const inRange =
            0 <= std::min(verts[0], verts[1]) && std::max(verts[0], verts[1]) < _level.numVertices;
        bool const isLoop = inRange && verts[0] == verts[1];
        if (!require(inRange && !(isLoop && !_level.IsNonManifold(verts[0])), ComponentType::Edge,
                     edge, "its vertices are not two of the level")) {
            return false;
        }
        numSides += _level.IsBoundary(edge) ? 1 : 2;
        if (_level.IsBoundary(edge)) {
            bool const listed = numBoundary < _level.boundaryEdges.size() &&
                                _level.boundaryEdges[numBoundary] == edge;
            if (!require(listed, ComponentType::Edge, edge, "not in the list of boundaries")) {
                return false;
            }
            ++numBoundary;
        }
    }
    return require(numSides == _level.numCorners, ComponentType::Level, _level.depth,
                   "edges have not as many sides as faces") &&
           require(numBoundary == _level.boundaryEdges.size(), ComponentType::Level, _level.depth,
                   "the list of boundaries is too long");
}

// As for edges: what each vertex names has it, and the sizes of the arrays leave no room for
// anything missing or repeated.  Faces are followed fan by fan: a fan that begins with a boundary
// edge ends with one and has an edge more than faces, any other comes back to its first edge.
bool Validator::checkVertices() {
    for (Index vert = 0; vert < _level.numVertices; ++vert) {
        Far::ConstIndexArray const faces = _level.GetVertexFaces(vert);
        Far::ConstIndexArray const edges = _level.GetVertexEdges(vert);
        LocalIndex const *const inFace = _level.vertFaceLocals.data() + _level.vertFirstFace[vert];
        LocalIndex const *const inEdge = _level.GetVertexEdgeLocals(vert);
        for (int i = 0; i < edges.size(); ++i) {
            bool const inRange = 0 <= edges[i] && edges[i] < _level.numEdges && inEdge[i] < 2;
            if (!require(inRange && _level.edgeVerts[edges[i]][inEdge[i]] == vert,
                         ComponentType::Vertex, vert, "an edge does not have it there")) {
                return false;
            }
        }
        int numFans = 0;
        int edge = 0;
        int fanStart = 0;
        bool inFan = false;
        for (int i = 0; i < faces.size(); ++i) {
            bool const inRange = 0 <= faces[i] && faces[i] < _level.numFaces &&
                                 inFace[i] < _level.GetFaceSize(faces[i]);
            if (!require(inRange && _level.GetFaceVertices(faces[i])[inFace[i]] == vert,
                         ComponentType::Vertex, vert, "a face does not have it there")) {
                return false;
            }
            if (!inFan) {
                fanStart = edge;
                inFan = true;
                ++numFans;
            }
            Index const corner = _level.faceFirstCorner[faces[i]] + inFace[i];
            Index const outEdge = _level.faceEdges[corner];
            Index const backEdge = _level.faceEdges[_level.GetPrevCorner(faces[i], corner)];
            if (!require(edge < edges.size() && edges[edge] == outEdge, ComponentType::Vertex, vert,
                         "a face does not begin at its edge")) {
                return false;
            }
            ++edge;
            bool const isOpen = _level.IsBoundary(edges[fanStart]);
            if (isOpen && _level.IsBoundary(backEdge)) {
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
            !require(numFans <= 1 || _level.IsNonManifold(vert), ComponentType::Vertex, vert,
                     "more than one fan of faces, but not tagged non-manifold")) {
            return false;
        }
    }
    return true;
}

bool Validator::checkFFaces() {
    Level const &parent = *_refinement->parent;
    for (Index face = 0; face < parent.numFaces; ++face) {
        Far::ConstIndexArray const verts = _level.GetFaceVertices(face);
        Index const first = parent.faceFirstCorner[face];
        if (_refinement->isTruncation) {
            bool good = verts.size() == 2 * parent.GetFaceSize(face);
            for (int i = 0; good && i < verts.size(); ++i) {
                Index const corner = first + (i == 0 ? verts.size() - 1 : i - 1) / 2;
                std::size_t const end = FindEdgeEnd(parent, corner) ^ (i % 2 == 0 ? 1u : 0u);
                good = verts[i] == GetEdgeEndVertex(*_refinement, end);
            }
            if (!require(good, ComponentType::Face, face, "not the F-face of its parent")) {
                return false;
            }
            continue;
        }
        bool good = verts.size() == parent.GetFaceSize(face);
        for (int i = 0; good && i < verts.size(); ++i) {
            good = verts[i] == _refinement->GetCornerChildVertex(first + i);
        }
        if (!require(good, ComponentType::Face, face, "not the F-face of its parent")) {
            return false;
        }
    }
    return true;
}

bool Validator::checkEFaces() {
    Level const &parent = *_refinement->parent;
    std::vector<Index> expected;
    for (Index pEdge = 0; pEdge < parent.numEdges; ++pEdge) {
        Index const cFace = _refinement->GetEdgeChildFace(pEdge);
        if (cFace == Far::INDEX_INVALID) {
            continue;
        }
        // V-vertex, unless the edge makes a quad of its F-vertices alone, then the two F-vertices
        // of the face on the far side, for each end.
        expected.clear();
        Far::ConstIndexArray const actual = _level.GetFaceVertices(cFace);
        bool const isBoundary = parent.IsBoundary(pEdge);
        bool const isQuad = !isBoundary && actual.size() == 4;
        for (int side = 0; side < 2; ++side) {
            if (!isQuad) {
                expected.push_back(
                    _refinement->GetVertexChildVertex(parent.edgeVerts[pEdge][side]));
            }
            if (isBoundary && side == 0) {
                continue;
            }
            int const far = isBoundary ? 0 : 1 - side;
            Index const start = parent.GetSideCorner(pEdge, far);
            Index const end = parent.GetNextCorner(parent.edgeFaces[pEdge][far], start);
            expected.push_back(_refinement->GetCornerChildVertex(end));
            expected.push_back(_refinement->GetCornerChildVertex(start));
        }
        bool const good = actual.size() == int(expected.size()) &&
                          std::equal(expected.begin(), expected.end(), actual.begin());
        if (!require(good, ComponentType::Face, cFace, "not the E-face of its parent edge")) {
            return false;
        }
    }
    return true;
}

// Whether a truncation made a vertex beside one of the parent, on any of its edges.
bool Validator::isBesideVertex(Index cVert, Index pVert) const {
    Level const &parent = *_refinement->parent;
    Far::ConstIndexArray const edges = parent.GetVertexEdges(pVert);
    LocalIndex const *const locals = parent.GetVertexEdgeLocals(pVert);
    for (int i = 0; i < edges.size(); ++i) {
        if (GetEdgeEndVertex(*_refinement, 2 * std::size_t(edges[i]) + locals[i]) == cVert) {
            return true;
        }
    }
    return false;
}

// A V-face has its V-vertex first, in a truncation before its last vertex, or not at all, and
// F-vertices of faces around its vertex: those of corners there or, in tri-hex, of the corners before.
bool Validator::checkVFaces() {
    Level const &parent = *_refinement->parent;
    for (Index cFace = _level.numFaces - _level.numVFaces; cFace < _level.numFaces; ++cFace) {
        Far::ConstIndexArray const verts = _level.GetFaceVertices(cFace);
        bool good = verts[verts.size() - 1] >= _level.numVVertices;
        Index const vert = good ? _refinement->GetVFaceParent(cFace) : Far::INDEX_INVALID;
        for (int i = 0; good && i < verts.size(); ++i) {
            if (verts[i] < _level.numVVertices) {
                good = i == (_refinement->isTruncation ? verts.size() - 2 : 0) &&
                       _refinement->GetVertexChildVertex(vert) == verts[i];
                continue;
            }
            if (_refinement->isTruncation) {
                good = isBesideVertex(verts[i], vert);
                continue;
            }
            Index const corner = _refinement->GetChildVertexCorner(verts[i]);
            good = false;
            for (Index k = parent.vertFirstFace[vert]; k < parent.vertFirstFace[vert + 1]; ++k) {
                Index const atVertex = parent.GetVertexCorner(k);
                good |= corner == atVertex ||
                        corner == parent.GetPrevCorner(parent.vertFaces[k], atVertex);
            }
        }
        if (!require(good, ComponentType::Face, cFace, "not a V-face of its parent vertex")) {
            return false;
        }
    }
    return true;
}

} // namespace

CallStatus Validate(Level const &level, Refinement const *refinement) {
    Validator validator(level, refinement);
    return validator.Run() ? CallStatus() : validator.GetStatus();
}

} // namespace OpenSubdivHex::FarExt::internal
