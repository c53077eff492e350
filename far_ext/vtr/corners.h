// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_VTR_CORNERS_H
#define OPENSUBDIVHEX_FAR_EXT_VTR_CORNERS_H

#include "level.h"

#include <limits>

namespace OpenSubdivHex::FarExt::internal {

/// \brief In place of a mate.  All are above any corner, so that the first side of an edge is that whose
/// mate is above it.
enum MateMark : Far::Index {
    kBeginsEdge = std::numeric_limits<Far::Index>::max() - 1, ///< the edge comes apart
    kNoMate = std::numeric_limits<Far::Index>::max()          ///< the edge has one side
};

/// Another than the first side of an edge that comes apart; below any corner.
constexpr Far::Index kJoinsEdge = -1;

/// Mates are found for this many faces of a vertex at once.
constexpr int kMaxFacesAtOnce = 16;

inline bool IsCorner(Far::Index mate) { return 0 <= mate && mate < kBeginsEdge; }

/// \brief Input of level 0, by corner; not kept.
struct Corners {
    Buffer<Far::Index> faces;   ///< by corner; empty where all faces have one size, 3 or 4
    Buffer<Far::Index> ofVerts; ///< those of each vertex, ascending, at the places of vertFirstFace
    /// The vertices behind and before each corner in its face, at the places of ofVerts, with any
    /// kMaxFacesAtOnce entries behind the last; empty where mates are known.
    Buffer<Far::Index> nextVerts;
    Buffer<Far::Index> prevVerts;
    /// By corner, that of the same vertex in the face on the other side of the edge that begins there.
    /// It is always another face.
    Buffer<Far::Index> mates;
    /// Vertices whose faces may have any order, where those of all others have theirs; ascending.
    std::vector<Far::Index> oddVerts;
};

/// \brief Where corners are in their faces, all of which have \p SIZE corners, or any number if that
/// is 0.
template <int SIZE>
class CornerPlaces {
public:
    using Index = Far::Index;

    CornerPlaces(Level const &level, Corners const &corners)
        : _firstCorner(level.faceFirstCorner.data()), _faces(corners.faces.data()) {}

    Index GetFace(Index corner) const {
        if constexpr (SIZE > 0) {
            return Index(unsigned(corner) / SIZE);
        } else {
            return _faces[corner];
        }
    }
    Index GetFirst(Index face) const { return SIZE > 0 ? face * SIZE : _firstCorner[face]; }
    Far::LocalIndex GetLocal(Index face, Index corner) const {
        return Far::LocalIndex(SIZE == 4 ? corner & 3 : corner - GetFirst(face));
    }
    /// The corners before and behind one of a face.
    Index GetPrev(Index face, Index corner) const {
        if constexpr (SIZE == 4) {
            return (corner & ~3) | ((corner + 3) & 3);
        } else {
            return corner == GetFirst(face) ? GetFirst(face + 1) - 1 : corner - 1;
        }
    }
    Index GetNext(Index face, Index corner) const {
        if constexpr (SIZE == 4) {
            return (corner & ~3) | ((corner + 1) & 3);
        } else {
            Index const next = corner + 1;
            return next == GetFirst(face + 1) ? GetFirst(face) : next;
        }
    }

private:
    Index const *_firstCorner;
    Index const *_faces;
};

/// Calls function(places) with the CornerPlaces of a level whose faceSizes are known.
template <typename FUNCTION>
auto WithPlaces(Level const &level, Corners const &corners, FUNCTION function) {
    bool const isUniform = level.faceSizes.size() == 1;
    if (isUniform && level.faceSizes[0] == 3) {
        return function(CornerPlaces<3>(level, corners));
    }
    if (isUniform && level.faceSizes[0] == 4) {
        return function(CornerPlaces<4>(level, corners));
    }
    return function(CornerPlaces<0>(level, corners));
}

/// \brief Writes the relations of edges, for which there is room.
template <typename PLACES>
class EdgeWriter {
public:
    using Index = Far::Index;

    EdgeWriter(PLACES const &places, Level &level)
        : _places(places), _faceVerts(level.faceVerts.data()), _edgeVerts(level.edgeVerts.data()),
          _edgeFaces(level.edgeFaces.data()), _edgeFaceLocals(level.edgeFaceLocals.data()),
          _faceEdges(level.faceEdges.data()) {}

    /// An edge with side 0 at \p corner, and side 1 at \p other or, at a boundary, a BoundaryKind in
    /// place of that.
    void Write(Index edge, Index corner, Index other) const {
        Index const face = _places.GetFace(corner);
        if (other < 0) {
            writeFirst(edge, face, corner, _faceVerts[_places.GetNext(face, corner)]);
            _edgeFaces[edge][1] = other;
            _edgeFaceLocals[edge][1] = 0;
        } else {
            writeFirst(edge, face, corner, _faceVerts[other]);
            writeSecond(edge, _places.GetFace(other), other);
        }
    }
    /// One whose other side ends at \p mate.
    void WriteBeforeMate(Index edge, Index corner, Index mate) const {
        Index const otherFace = _places.GetFace(mate);
        Index const other = _places.GetPrev(otherFace, mate);
        writeFirst(edge, _places.GetFace(corner), corner, _faceVerts[other]);
        writeSecond(edge, otherFace, other);
    }

private:
    void writeFirst(Index edge, Index face, Index corner, Index endVert) const {
        _edgeVerts[edge] = {_faceVerts[corner], endVert};
        _edgeFaces[edge][0] = face;
        _edgeFaceLocals[edge][0] = _places.GetLocal(face, corner);
        _faceEdges[corner] = edge;
    }
    void writeSecond(Index edge, Index face, Index corner) const {
        _edgeFaces[edge][1] = face;
        _edgeFaceLocals[edge][1] = _places.GetLocal(face, corner);
        _faceEdges[corner] = edge;
    }

    PLACES const _places;
    Index const *const _faceVerts;
    IndexPair *const _edgeVerts;
    IndexPair *const _edgeFaces;
    LocalIndexPair *const _edgeFaceLocals;
    Index *const _faceEdges;
};

/// Makes room for the relations whose sizes are the numbers of corners and vertices, but for faceVerts.
void ResizeCorners(Level &level);

/// Makes room for \p numEdges edges, those of vertices included.
void ResizeEdges(std::size_t numEdges, Level &level);

/// \brief Finds vertFirstFace of \p level, and \p corners but for the mates, for which there is room
/// then.
///
/// The level has its faces: numVertices, numFaces, numCorners, faceFirstCorner, faceVerts and
/// faceSizes.
///
/// \param findsNeighbors  whether to find nextVerts and prevVerts, too
void FindCorners(Level &level, Corners &corners, bool findsNeighbors);

} // namespace OpenSubdivHex::FarExt::internal

#endif
