// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_SURFACE_FACES_H
#define OPENSUBDIVHEX_FAR_EXT_SURFACE_FACES_H

#include "export.h"
#include "indexing.h"
#include "status.h"

#include <vector>

namespace OpenSubdivHex::FarExt {

namespace internal {
struct CrossedFace;
struct Level;
} // namespace internal

/// \brief The *surface faces*, the faces that surfaces are made for, and their edges.
///
/// \code
///     FarExt::SurfaceFaces const faces = factory->GetFaces(); // of a BfrExt::SurfaceFactory
///     for (int face = 0; face < faces.GetNumFaces(); ++face) {
///         int const firstVertex = faces.GetVertex(face, 0);
///     }
/// \endcode
///
/// Surface faces are the faces of the surface level (HexSchemeOptions::GetSurfaceLevel()), with one exception:
/// FirstStep::Truncate makes a face of each vertex on a crease.  If the crease is infinitely sharp, this face is *cut*:
/// its two halves are surface faces, half polygons (FaceShape) back to back, with normals of their own along the crease.
///
/// Half 0 has the number of the cut face.  Halves 1 follow all faces of the level, in the order of the cut faces.  The
/// diagonals between halves follow all edges of the level in the same order; they run from vertex 0 of the face to
/// TopologyLevel::GetFaceDiagonalEnd().
///
/// The object refers to the level.  Several threads may use it at once.  Arguments are not checked.
class OPENSUBDIVHEX_API SurfaceFaces {
public:
    /// A face, an edge or a vertex.
    using Index = Far::Index;

    /// A face of the level, or a half of it.
    struct LevelFace {
        Index face; ///< of the level
        int half;   ///< 0, or 1 as in GetPlaceInHalves()
    };
    /// An edge of a surface face.
    struct Edge {
        Index edge;      ///< its number
        bool isReversed; ///< whether it runs against the face
    };
    /// A side of an edge.
    struct Side {
        Index face; ///< the surface face there; INDEX_INVALID where there is none
        int local;  ///< which edge of the face the edge is
    };

    /// The surface faces of a level, TopologyLevel::GetLevel(), which has full topology and must live as long.
    explicit SurfaceFaces(internal::Level const &level) : _level(&level) {}

    /// Surface faces, holes included.
    int GetNumFaces() const;
    /// Edges, diagonals included.
    int GetNumEdges() const;

    /// The face of the level that a surface face is or lies in.
    LevelFace GetLevelFace(Index face) const;
    /// The surface face that a face of the level is, or its half is if it is cut.
    Index GetFace(LevelFace levelFace) const;
    /// Whether a surface face is half of a face of the level that is cut.
    bool IsHalfOfCut(Index face) const;
    /// The shape of a surface face.
    FaceShape GetShape(Index face) const;
    /// Whether all of a surface face lies in faces of level 0 that are holes: it has no surface then.
    bool IsHole(Index face) const;

    /// The place in the face of the level of vertex \p local of a surface face, and of its edge but for a diagonal.
    int GetPlace(Index face, int local) const;
    /// Vertex \p local of a surface face.
    Index GetVertex(Index face, int local) const;
    /// Edge \p local of a surface face, from its vertex \p local to the next.  Edge 0 of each half of a cut face is the
    /// diagonal.
    Edge GetEdge(Index face, int local) const;
    /// Side 0 of an edge, which runs as the edge does, or side 1.
    Side GetSide(Index edge, int side) const;
    /// The side of a surface face that edge \p place of a face of the level is.
    Side GetSideOfPlace(Index levelFace, int place) const;
    /// The surface faces around a vertex, in the order of the faces of the level, half 0 before half 1.
    std::vector<Index> GetVertexFaces(Index vert) const;

    /// The arrays of the level, for the library's own use.
    internal::Level const &GetLevel() const { return *_level; }

private:
    internal::CrossedFace const *findCut(Index levelFace) const;
    Index getRank(internal::CrossedFace const &cut) const;

    internal::Level const *_level;
};

} // namespace OpenSubdivHex::FarExt

#endif
