// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_VTR_FACE_WRITER_H
#define OPENSUBDIVHEX_FAR_EXT_VTR_FACE_WRITER_H

#include "baseLevel.h"
#include "parallel.h"
#include "refinement.h"

namespace OpenSubdivHex::FarExt::internal {

/// The corner of a side of an edge that no face has.
inline constexpr Far::Index kNoCorner = -1;

/// \brief Writes the faces of the child of a refinement corner by corner and, for FULL, the sides of its
/// edges.  Different threads may write different faces.
template <bool FULL>
class FaceWriter {
public:
    /// The sides of the edges of the child, for BuildBaseLevel().
    Buffer<EdgeSides> const &GetEdges() const { return _edges; }

protected:
    using Index = Far::Index;
    /// Where the next face goes, and its next corner.
    struct NextFace {
        Index face;
        Index corner;
    };
    /// Which of the two sides of its edge a face is.
    enum Side { kFirst = 0, kSecond = 1 };
    struct EdgeSide {
        Index edge;
        Side side;
    };

    FaceWriter(Level const &parent, Refinement const &refinement, Level &child)
        : _refinement(refinement), _p(parent), _c(child) {
        _c.faceFirstCorner.Resize(std::size_t(_c.numFaces) + 1);
        _c.faceVerts.Resize(std::size_t(_c.numCorners));
        _c.faceFirstCorner[std::size_t(_c.numFaces)] = _c.numCorners;
        if constexpr (FULL) {
            _edges.Resize(std::size_t(_c.numEdges));
            ParallelFor(_c.numEdges, [this](Index cEdge) {
                _edges[std::size_t(cEdge)] = {{kNoCorner, kNoCorner}};
            });
        }
    }
    ~FaceWriter() = default;

    void beginFace(NextFace &place) {
        _c.faceFirstCorner[std::size_t(place.face++)] = place.corner;
    }
    /// Adds a vertex to the face begun last, and the edge from there to the next one.
    void addCorner(NextFace &place, Index vert, EdgeSide edge) {
        if constexpr (FULL) {
            _edges[std::size_t(edge.edge)].corners[edge.side] = place.corner;
        }
        _c.faceVerts[std::size_t(place.corner++)] = vert;
    }
    Index fVertex(Index corner) const { return _refinement.GetCornerChildVertex(corner); }

    Refinement const &_refinement;
    Level const &_p;
    Level &_c;
    Buffer<EdgeSides> _edges;
};

} // namespace OpenSubdivHex::FarExt::internal

#endif
