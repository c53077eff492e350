// SPDX-License-Identifier: Apache-2.0
#include "farRelations.h"

#include "baseLevel.h"
#include "corners.h"
#include "parallel.h"

#include <algorithm>
#include <type_traits>

namespace OpenSubdivHex::FarExt::internal {

namespace {

using Far::ConstIndexArray;
using Far::Index;
using Far::LocalIndex;

// Copies the relations of a level of Far, looking at each.
template <typename PLACES>
class RelationCopier {
public:
    RelationCopier(Far::TopologyRefiner const &base, BoundaryKind boundary, PLACES places,
                   Level &level)
        : _base(base.getLevel(0)), _boundary(boundary), _places(places), _level(level) {}

    bool Copy();

private:
    bool isSide(Index edge, int side, Index face, LocalIndex local, Index const *verts) const;
    bool copyEdge(Index edge) const;
    bool copyVertex(Index vert) const;
    template <bool IS_CLOSED, typename NUM_FACES>
    bool copyFaces(Index vert, NUM_FACES numFaces) const;
    template <typename COPY>
    bool copyAll(Index count, COPY copy);

    OpenSubdiv::Vtr::internal::Level const &_base;
    BoundaryKind _boundary;
    PLACES _places;
    Level &_level;
    // What copyAll() finds in the levels once, since it is asked for again and again.
    Index _numFaces = 0;
    Index const *_faceVerts = nullptr;
    Index const *_faceEdges = nullptr;
    IndexPair *_edgeVerts = nullptr;
    IndexPair *_edgeFaces = nullptr;
    LocalIndexPair *_edgeFaceLocals = nullptr;
    Index const *_vertFirstFace = nullptr;
    Index const *_vertFirstEdge = nullptr;
    Index *_vertFaces = nullptr;
    LocalIndex *_vertFaceLocals = nullptr;
    Index *_vertEdges = nullptr;
    LocalIndex *_vertEdgeLocals = nullptr;
};

// Whether side \p side of an edge is where this says that it is.
template <typename PLACES>
inline bool RelationCopier<PLACES>::isSide(Index edge, int side, Index face, LocalIndex local,
                                           Index const *verts) const {
    if (unsigned(face) >= unsigned(_numFaces)) {
        return false;
    }
    Index const corner = _places.GetFirst(face) + local;
    if (corner >= _places.GetFirst(face + 1)) {
        return false;
    }
    Index const next = _places.GetNext(face, corner);
    return ((_faceEdges[corner] ^ edge) | (_faceVerts[corner] ^ verts[side]) |
            (_faceVerts[next] ^ verts[1 - side])) == 0;
}

// The sides of an edge: the first runs from its first vertex to the second, the other back.
template <typename PLACES>
bool RelationCopier<PLACES>::copyEdge(Index edge) const {
    Index const *const verts = _base.getEdgeVertices(edge).begin();
    ConstIndexArray const faces = _base.getEdgeFaces(edge);
    LocalIndex const *const locals = _base.getEdgeFaceLocalIndices(edge).begin();
    bool const isBoundary = faces.size() == 1;
    if ((!isBoundary && faces.size() != 2) || verts[0] == verts[1] ||
        !isSide(edge, 0, faces[0], locals[0], verts) ||
        !(isBoundary || (faces[0] != faces[1] && isSide(edge, 1, faces[1], locals[1], verts)))) {
        return false;
    }
    _edgeVerts[edge] = {verts[0], verts[1]};
    _edgeFaces[edge] = {faces[0], isBoundary ? _boundary : faces[1]};
    _edgeFaceLocals[edge] = {locals[0], isBoundary ? LocalIndex(0) : locals[1]};
    return true;
}

// One fan that begins at a boundary or, all around, with its lowest face.  All edges of faces are
// known to be right.
template <typename PLACES>
bool RelationCopier<PLACES>::copyVertex(Index vert) const {
    Index const firstFace = _vertFirstFace[vert];
    Index const firstEdge = _vertFirstEdge[vert];
    Index const numFaces = _vertFirstFace[vert + 1] - firstFace;
    Index const numEdges = _vertFirstEdge[vert + 1] - firstEdge;
    if (_base.getNumVertexFaces(vert) != numFaces || _base.getNumVertexEdges(vert) != numEdges) {
        return false;
    }
    if (numEdges != numFaces) {
        return numEdges == numFaces + 1 && copyFaces<false>(vert, numFaces);
    }
    switch (numFaces) {
    case 3:
        return copyFaces<true>(vert, std::integral_constant<int, 3>());
    case 4:
        return copyFaces<true>(vert, std::integral_constant<int, 4>());
    case 5:
        return copyFaces<true>(vert, std::integral_constant<int, 5>());
    case 6:
        return copyFaces<true>(vert, std::integral_constant<int, 6>());
    default:
        return copyFaces<true>(vert, numFaces);
    }
}

// Usual numbers of faces are constants to the compiler, as in MateFinder.
template <typename PLACES>
template <bool IS_CLOSED, typename NUM_FACES>
inline bool RelationCopier<PLACES>::copyFaces(Index vert, NUM_FACES numFaces) const {
    Index const *const faces = _base.getVertexFaces(vert).begin();
    LocalIndex const *const locals = _base.getVertexFaceLocalIndices(vert).begin();
    Index const *const edges = _base.getVertexEdges(vert).begin();
    Index const firstFace = _vertFirstFace[vert];
    Index const firstEdge = _vertFirstEdge[vert];
    Index wrong = 0; // where any bit is set
    for (int i = 0; i < numFaces; ++i) {
        Index const face = faces[i];
        if (unsigned(face) >= unsigned(_numFaces)) {
            return false;
        }
        Index const corner = _places.GetFirst(face) + locals[i];
        if (corner >= _places.GetFirst(face + 1)) {
            return false;
        }
        Index const prev = _places.GetPrev(face, corner);
        Index const edge = _faceEdges[corner];
        int const behind = IS_CLOSED && i + 1 == numFaces ? 0 : i + 1;
        wrong |= (_faceVerts[corner] ^ vert) | (edge ^ edges[i]) |
                 (_faceEdges[prev] ^ edges[behind]) | Index(IS_CLOSED && i > 0 && face <= faces[0]);
        _vertFaces[firstFace + i] = face;
        _vertFaceLocals[firstFace + i] = locals[i];
        _vertEdges[firstEdge + i] = edge;
        _vertEdgeLocals[firstEdge + i] = LocalIndex(_edgeVerts[edge][0] != vert);
    }
    if (IS_CLOSED || wrong != 0) {
        return wrong == 0;
    }
    Index const last = edges[numFaces];
    _vertEdges[firstEdge + numFaces] = last;
    _vertEdgeLocals[firstEdge + numFaces] = 1;
    return _level.IsBoundary(edges[0]) && _level.IsBoundary(last);
}

// Whether copy(copier, i) is well for all.
template <typename PLACES>
template <typename COPY>
bool RelationCopier<PLACES>::copyAll(Index count, COPY copy) {
    _numFaces = _level.numFaces;
    _faceVerts = _level.faceVerts.data();
    _faceEdges = _level.faceEdges.data();
    _edgeVerts = _level.edgeVerts.data();
    _edgeFaces = _level.edgeFaces.data();
    _edgeFaceLocals = _level.edgeFaceLocals.data();
    _vertFirstFace = _level.vertFirstFace.data();
    _vertFirstEdge = _level.vertFirstEdge.data();
    _vertFaces = _level.vertFaces.data();
    _vertFaceLocals = _level.vertFaceLocals.data();
    _vertEdges = _level.vertEdges.data();
    _vertEdgeLocals = _level.vertEdgeLocals.data();
    return ParallelSums<Index>(count, [&](Index begin, Index end) {
               // The compiler must expect that what is written is a member of
               // this, but not of a copy.
               RelationCopier const copier = *this;
               Index numWrong = 0;
               for (Index i = begin; i < end; ++i) {
                   numWrong += !copy(copier, i);
               }
               return numWrong;
           }).back() == 0;
}

template <typename PLACES>
bool RelationCopier<PLACES>::Copy() {
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
    ResizeCorners(_level);
    ResizeEdges(std::size_t(numEdges), _level);
    ParallelForRange(_level.numFaces, [this](Index begin, Index end) {
        Index const first = _level.faceFirstCorner[begin];
        std::copy_n(_base.getFaceEdges(begin).begin(), _level.faceFirstCorner[end] - first,
                    _level.faceEdges.data() + first);
    });
    if (!copyAll(numEdges,
                 [](RelationCopier const &copier, Index edge) { return copier.copyEdge(edge); })) {
        return false;
    }
    _level.boundaryEdges.Assign(
        ParallelSelect(numEdges, [this](Index edge) { return _level.IsBoundary(edge); }));
    ParallelFor(_level.numVertices, [this](Index vert) {
        _level.vertFirstFace[vert] = _base.getOffsetOfVertexFaces(vert);
    });
    _level.vertFirstFace[_level.numVertices] = _level.numCorners;
    BeginVertices(_level);
    return copyAll(_level.numVertices, [](RelationCopier const &copier, Index vert) {
        return copier.copyVertex(vert);
    });
}

} // namespace

bool CopyRelations(Far::TopologyRefiner const &base, BoundaryKind boundary, Level &level) {
    return WithPlaces(level, Corners(), [&](auto const &places) {
        return RelationCopier(base, boundary, places, level).Copy();
    });
}

} // namespace OpenSubdivHex::FarExt::internal
