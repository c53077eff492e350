// SPDX-License-Identifier: Apache-2.0
#include "farRelations.h"

#include "baseLevel.h"
#include "parallel.h"

#include <algorithm>

namespace OpenSubdivHex::FarExt::internal {

namespace {

using Far::ConstIndexArray;
using Far::Index;
using Far::LocalIndex;

class RelationCopier {
public:
    RelationCopier(Far::TopologyRefiner const &base, BoundaryKind boundary, Level &level)
        : _base(base.getLevel(0)), _boundary(boundary), _level(level) {}

    bool Copy();

private:
    bool copyEdge(Index edge) const;
    bool copyVertex(Index vert) const;

    OpenSubdiv::Vtr::internal::Level const &_base;
    BoundaryKind _boundary;
    Level &_level;
    // The arrays at hand, since they are read again and again.
    Index const *const _firstCorner = _level.faceFirstCorner.data();
    Index const *const _faceVerts = _level.faceVerts.data();
    Index const *_faceEdges = nullptr;
    IndexPair const *_edgeVerts = nullptr;
};

// The sides of an edge: the first runs from its first vertex to the second, the other back.
bool RelationCopier::copyEdge(Index edge) const {
    Index const *const verts = _base.getEdgeVertices(edge).begin();
    ConstIndexArray const faces = _base.getEdgeFaces(edge);
    LocalIndex const *const locals = _base.getEdgeFaceLocalIndices(edge).begin();
    int const numFaces = faces.size();
    bool isRight = 1 <= numFaces && numFaces <= 2 && verts[0] != verts[1];
    for (int side = 0; side < numFaces && isRight; ++side) {
        Index const face = faces[side];
        if (unsigned(face) >= unsigned(_level.numFaces)) {
            return false;
        }
        Index const corner = _firstCorner[face] + locals[side];
        Index const end = _firstCorner[face + 1];
        if (corner >= end) {
            return false;
        }
        Index const next = corner + 1 == end ? _firstCorner[face] : corner + 1;
        isRight = _faceEdges[corner] == edge && _faceVerts[corner] == verts[side] &&
                  _faceVerts[next] == verts[1 - side];
    }
    if (!isRight) {
        return false;
    }
    bool const isBoundary = numFaces == 1;
    _level.edgeVerts[edge] = {verts[0], verts[1]};
    _level.edgeFaces[edge] = {faces[0], isBoundary ? _boundary : faces[1]};
    _level.edgeFaceLocals[edge] = {locals[0], isBoundary ? LocalIndex(0) : locals[1]};
    return isBoundary || faces[0] != faces[1];
}

// One fan that begins at a boundary or, all around, with its lowest face.  All edges of faces are
// known to be right.
bool RelationCopier::copyVertex(Index vert) const {
    ConstIndexArray const faces = _base.getVertexFaces(vert);
    LocalIndex const *const locals = _base.getVertexFaceLocalIndices(vert).begin();
    ConstIndexArray const edges = _base.getVertexEdges(vert);
    Index const firstFace = _level.vertFirstFace[vert];
    Index const firstEdge = _level.vertFirstEdge[vert];
    int const numFaces = faces.size();
    int const numEdges = edges.size();
    if (numFaces != _level.vertFirstFace[vert + 1] - firstFace ||
        numEdges != _level.vertFirstEdge[vert + 1] - firstEdge) {
        return false;
    }
    bool const isClosed = numEdges == numFaces;
    Index *const vertFaces = _level.vertFaces.data() + firstFace;
    LocalIndex *const vertFaceLocals = _level.vertFaceLocals.data() + firstFace;
    Index *const vertEdges = _level.vertEdges.data() + firstEdge;
    LocalIndex *const vertEdgeLocals = _level.vertEdgeLocals.data() + firstEdge;
    for (int i = 0; i < numFaces; ++i) {
        Index const face = faces[i];
        if (unsigned(face) >= unsigned(_level.numFaces)) {
            return false;
        }
        Index const first = _firstCorner[face];
        Index const corner = first + locals[i];
        Index const end = _firstCorner[face + 1];
        if (corner >= end) {
            return false;
        }
        Index const prev = (corner == first ? end : corner) - 1;
        Index const edge = _faceEdges[corner];
        if (_faceVerts[corner] != vert || edge != edges[i] ||
            _faceEdges[prev] != edges[i + 1 < numEdges ? i + 1 : 0] ||
            (isClosed && i > 0 && face <= faces[0])) {
            return false;
        }
        vertFaces[i] = face;
        vertFaceLocals[i] = locals[i];
        vertEdges[i] = edge;
        vertEdgeLocals[i] = LocalIndex(_edgeVerts[edge][0] != vert);
    }
    if (isClosed) {
        return true;
    }
    Index const lastEdge = edges[numEdges - 1];
    vertEdges[numEdges - 1] = lastEdge;
    vertEdgeLocals[numEdges - 1] = 1;
    return numEdges == numFaces + 1 && _level.IsBoundary(edges[0]) && _level.IsBoundary(lastEdge);
}

bool RelationCopier::Copy() {
    Index const numEdges = _base.getNumEdges();
    // Every corner is one side of one edge, and at one vertex, if there are so many of both.
    std::vector<std::int64_t> const numSides =
        ParallelSums<std::int64_t>(numEdges, [this](Index begin, Index end) {
            std::int64_t sum = 0;
            for (Index edge = begin; edge < end; ++edge) {
                sum += _base.getNumEdgeFaces(edge);
            }
            return sum;
        });
    if (numSides.back() != _level.numCorners) {
        return false;
    }
    ResizeEdges(std::size_t(numEdges), _level);
    _level.vertFirstFace.Resize(std::size_t(_level.numVertices) + 1);
    ParallelForRange(_level.numFaces, [this](Index begin, Index end) {
        std::copy_n(_base.getFaceEdges(begin).begin(), _firstCorner[end] - _firstCorner[begin],
                    _level.faceEdges.data() + _firstCorner[begin]);
    });
    _faceEdges = _level.faceEdges.data();
    _edgeVerts = _level.edgeVerts.data();
    if (!ParallelSelect(numEdges, [this](Index edge) { return !copyEdge(edge); }).empty()) {
        return false;
    }
    _level.boundaryEdges.Assign(
        ParallelSelect(numEdges, [this](Index edge) { return _level.IsBoundary(edge); }));
    ParallelFor(_level.numVertices, [this](Index vert) {
        _level.vertFirstFace[vert] = _base.getOffsetOfVertexFaces(vert);
    });
    _level.vertFirstFace[_level.numVertices] = _level.numCorners;
    FindFaceSizes(_level);
    BeginVertices(_level);
    return ParallelSelect(_level.numVertices, [this](Index vert) { return !copyVertex(vert); })
        .empty();
}

} // namespace

bool CopyRelations(Far::TopologyRefiner const &base, BoundaryKind boundary, Level &level) {
    return RelationCopier(base, boundary, level).Copy();
}

} // namespace OpenSubdivHex::FarExt::internal
