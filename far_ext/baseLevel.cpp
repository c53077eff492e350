// SPDX-License-Identifier: Apache-2.0
#include "baseLevel.h"

#include <algorithm>

namespace OpenSubdivHex::FarExt::internal {

namespace {

using Index = Far::Index;
using LocalIndex = Far::LocalIndex;

class BaseLevelBuilder {
public:
    BaseLevelBuilder(std::vector<EdgeSides> const &edges, LevelTopology &level)
        : _edges(edges), _level(level) {}

    void Build() {
        buildFacesOfCorners();
        buildEdges();
        buildVertices();
    }

private:
    void buildFacesOfCorners();
    void buildEdges();
    void buildVertices();
    void appendFan(Index startCorner);

    Index prevCorner(Index corner) const {
        Index const face = _faceOfCorner[corner];
        bool const isFirst = corner == _level.faceFirstCorner[face];
        return (isFirst ? _level.faceFirstCorner[face + 1] : corner) - 1;
    }
    LocalIndex local(Index corner) const {
        return LocalIndex(corner - _level.faceFirstCorner[_faceOfCorner[corner]]);
    }
    // The corner at which the other side of a corner's edge starts; negative at a boundary.
    Index otherSide(Index corner) const {
        EdgeSides const &edge = _edges[_level.faceEdges[corner]];
        return edge.corners[0] == corner ? edge.corners[1] : edge.corners[0];
    }
    // The corners of the same vertex in the next face around it, counter-clockwise and clockwise;
    // negative across a boundary.
    Index nextAround(Index corner) const { return otherSide(prevCorner(corner)); }
    Index prevAround(Index corner) const {
        Index const other = otherSide(corner);
        if (other < 0) {
            return other;
        }
        Index const face = _faceOfCorner[other];
        bool const isLast = other + 1 == _level.faceFirstCorner[face + 1];
        return isLast ? _level.faceFirstCorner[face] : other + 1;
    }

    std::vector<EdgeSides> const &_edges;
    LevelTopology &_level;
    std::vector<Index> _faceOfCorner;
    std::vector<bool> _isPlaced; // corner in a fan
    Index _nextFace = 0;
    Index _nextEdge = 0;
};

void BaseLevelBuilder::buildFacesOfCorners() {
    _faceOfCorner.resize(_level.numCorners);
    for (Index face = 0; face < _level.numFaces; ++face) {
        std::fill(_faceOfCorner.begin() + _level.faceFirstCorner[face],
                  _faceOfCorner.begin() + _level.faceFirstCorner[face + 1], face);
    }
}

void BaseLevelBuilder::buildEdges() {
    _level.numEdges = Index(_edges.size());
    _level.faceEdges.Resize(_level.numCorners);
    _level.edgeVerts.Resize(2 * _edges.size());
    _level.edgeFaces.Resize(2 * _edges.size());
    _level.edgeFaceLocals.Resize(2 * _edges.size());
    _level.numFreeBoundaries = 0;
    _level.numSharpBoundariesA = 0;
    _level.numSharpBoundariesB = 0;
    std::vector<Index> boundaryEdges;
    std::vector<Index> halfFaces;
    for (std::size_t edge = 0; edge < _edges.size(); ++edge) {
        Index const corner = _edges[edge].corners[0];
        Index const other = _edges[edge].corners[1];
        Index const face = _faceOfCorner[corner];
        bool const isLast = corner + 1 == _level.faceFirstCorner[face + 1];
        Index const next = isLast ? _level.faceFirstCorner[face] : corner + 1;
        _level.edgeVerts[2 * edge] = _level.faceVerts[corner];
        _level.edgeVerts[2 * edge + 1] = _level.faceVerts[next];
        _level.edgeFaces[2 * edge] = face;
        _level.edgeFaceLocals[2 * edge] = local(corner);
        _level.faceEdges[corner] = Index(edge);
        if (other < 0) {
            _level.edgeFaces[2 * edge + 1] = other;
            _level.edgeFaceLocals[2 * edge + 1] = 0;
            boundaryEdges.push_back(Index(edge));
            if (other == kSharpBoundaryB) {
                ++_level.numSharpBoundariesB;
                halfFaces.push_back(face);
            } else {
                ++(other == kFreeBoundary ? _level.numFreeBoundaries : _level.numSharpBoundariesA);
            }
        } else {
            _level.edgeFaces[2 * edge + 1] = _faceOfCorner[other];
            _level.edgeFaceLocals[2 * edge + 1] = local(other);
            _level.faceEdges[other] = Index(edge);
        }
    }
    _level.boundaryEdges.Resize(boundaryEdges.size());
    std::copy(boundaryEdges.begin(), boundaryEdges.end(), _level.boundaryEdges.data());
    std::sort(halfFaces.begin(), halfFaces.end());
    _level.halfFaces.Resize(halfFaces.size());
    std::copy(halfFaces.begin(), halfFaces.end(), _level.halfFaces.data());
}

void BaseLevelBuilder::buildVertices() {
    // The corners of each vertex, ascending.
    std::vector<Index> first(std::size_t(_level.numVertices) + 1, 0);
    for (Index vert : _level.faceVerts) {
        ++first[vert + 1];
    }
    for (Index vert = 0; vert < _level.numVertices; ++vert) {
        first[vert + 1] += first[vert];
    }
    std::vector<Index> cornersOfVerts(_level.numCorners);
    std::vector<Index> next(first.begin(), first.end() - 1);
    for (Index corner = 0; corner < _level.numCorners; ++corner) {
        cornersOfVerts[next[_level.faceVerts[corner]]++] = corner;
    }

    _level.vertFirstFace.Resize(std::size_t(_level.numVertices) + 1);
    _level.vertFirstEdge.Resize(std::size_t(_level.numVertices) + 1);
    _level.vertFaces.Resize(_level.numCorners);
    _level.vertFaceLocals.Resize(_level.numCorners);
    _level.vertEdges.Resize(2 * std::size_t(_level.numEdges));
    _level.vertEdgeLocals.Resize(2 * std::size_t(_level.numEdges));
    _isPlaced.assign(_level.numCorners, false);
    for (Index vert = 0; vert < _level.numVertices; ++vert) {
        _level.vertFirstFace[vert] = _nextFace;
        _level.vertFirstEdge[vert] = _nextEdge;
        for (Index k = first[vert]; k < first[vert + 1]; ++k) {
            Index const corner = cornersOfVerts[k];
            if (_isPlaced[corner]) {
                continue;
            }
            Index start = corner;
            for (Index prev = prevAround(start); prev >= 0 && prev != corner;
                 prev = prevAround(start)) {
                start = prev;
            }
            // A closed fan comes back to the corner, and starts there.
            appendFan(prevAround(start) < 0 ? start : corner);
        }
    }
    _level.vertFirstFace[_level.numVertices] = _nextFace;
    _level.vertFirstEdge[_level.numVertices] = _nextEdge;
}

void BaseLevelBuilder::appendFan(Index startCorner) {
    // An interior edge may have the vertex as its first or second; in a fan it is seen from the
    // side that starts at the vertex.
    auto addEdge = [&](Index edge, bool isStartOfSide, Index sideCorner) {
        bool const isSideA = _edges[edge].corners[0] == sideCorner;
        _level.vertEdges[_nextEdge] = edge;
        _level.vertEdgeLocals[_nextEdge++] = LocalIndex(isStartOfSide == isSideA ? 0 : 1);
    };
    Index corner = startCorner;
    for (;;) {
        _isPlaced[corner] = true;
        _level.vertFaces[_nextFace] = _faceOfCorner[corner];
        _level.vertFaceLocals[_nextFace++] = local(corner);
        addEdge(_level.faceEdges[corner], true, corner);
        Index const next = nextAround(corner);
        if (next == startCorner) {
            return;
        }
        if (next < 0) {
            Index const prev = prevCorner(corner);
            addEdge(_level.faceEdges[prev], false, prev);
            return;
        }
        corner = next;
    }
}

} // namespace

void BuildBaseLevel(std::vector<EdgeSides> const &edges, LevelTopology &level) {
    level.hasFullTopology = true;
    BaseLevelBuilder(edges, level).Build();
}

} // namespace OpenSubdivHex::FarExt::internal
