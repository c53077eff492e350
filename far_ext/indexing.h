// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_INDEXING_H
#define OPENSUBDIVHEX_FAR_EXT_INDEXING_H

#include "status.h"

#include <cstdint>

namespace OpenSubdivHex::FarExt {

/// \brief Where the components of one side of an edge stand in the edge's E-face.
///
/// A *side* is a face's view of its edge: the face runs from the side's start vertex to its end
/// vertex.  An interior edge v0-v1 has side a (its first face, v0 to v1) and side b (v1 to v0); its
/// E-face is v0', P_b(v0), P_b(v1), v1', P_a(v1), P_a(v0).  A boundary edge has side a alone; its
/// E-face is v0', v1', P_a(v1), P_a(v0).  Edge i of the E-face joins its vertices i and i + 1.
/// In both, the last vertex is the F-vertex of the corner where side a starts.
struct EFaceSide {
    Far::LocalIndex startVertex;  ///< V-vertex of the start vertex
    Far::LocalIndex endVertex;    ///< V-vertex of the end vertex
    Far::LocalIndex startFVertex; ///< the face's F-vertex beside the start vertex
    Far::LocalIndex endFVertex;   ///< the face's F-vertex beside the end vertex
    Far::LocalIndex fFaceEdge;    ///< edge shared with the F-face, run from end to start
    Far::LocalIndex startSpoke;   ///< edge from startFVertex to startVertex
    Far::LocalIndex endSpoke;     ///< edge from endVertex to endFVertex
};

/// Side a of an interior edge, which runs as the edge does.
inline constexpr EFaceSide kEFaceSideA = {0, 3, 5, 4, 4, 5, 3};
/// Side b of an interior edge, which runs against it.
inline constexpr EFaceSide kEFaceSideB = {3, 0, 2, 1, 1, 2, 0};
/// The one side of a boundary edge.
inline constexpr EFaceSide kBoundaryEFaceSide = {0, 1, 3, 2, 2, 3, 1};
/// Offset of the corners behind the start vertex in side a, against side b.
inline constexpr Far::LocalIndex kEFaceSideShift = 3;
static_assert(kEFaceSideA.startFVertex == kEFaceSideB.startFVertex + kEFaceSideShift &&
              kEFaceSideA.endFVertex == kEFaceSideB.endFVertex + kEFaceSideShift &&
              kEFaceSideA.fFaceEdge == kEFaceSideB.fFaceEdge + kEFaceSideShift &&
              kEFaceSideA.startSpoke == kEFaceSideB.startSpoke + kEFaceSideShift &&
              kEFaceSideA.endSpoke == kEFaceSideB.endSpoke + kEFaceSideShift);
/// Whether an E-face of six corners is side a of its own edge \p local, or side b.  F-faces are side
/// a of all theirs.
constexpr bool IsEFaceSideA(int local) { return local % 3 == 0; }
/// Place in a boundary edge's E-face of the edge that stays on the boundary.
inline constexpr Far::LocalIndex kBoundaryEFaceEdge = 0;

/// \brief Where sharp features stand in the faces they cross.
///
/// The E-face of a crease edge v0-v1 is cut along the diagonal v0'-v1', its corners 0 and 3; that
/// of a sharp boundary edge is a half-hexagon whose long side, its edge 0, lies on the boundary.
/// F-faces inherit both in the same place.
inline constexpr int kDiagonalStart = 0;
/// The corner where the diagonal ends.
inline constexpr int kDiagonalEnd = 3;
/// The long edge of a half face, on the boundary.
inline constexpr int kHalfFaceLongEdge = 0;

/// The corners of the two halves of a hexagon that an edge of the base mesh crosses, be it a crease,
/// a face-varying seam or neither: half 0 is on the side of the first face of the parent edge.
inline constexpr int kHexagonHalves[2][4] = {{0, 3, 4, 5}, {3, 0, 1, 2}};
/// \brief Vertex \p i of a half, as a vertex of the whole face: the face is cut along a diagonal from vertex 0 to \p end.
/// For hexagons these are the numbers of kHexagonHalves.
///
/// Half 1 has the vertices from 0 to \p end, half 0 has \p end, the others, and 0.  Both have the diagonal as edge 0: half 0
/// begins with 0 and \p end, half 1 with \p end and 0.
constexpr int GetPlaceInHalves(int half, int i, int end) {
    return half == 1 ? (i == 0 ? end : i - 1) : (i == 0 ? 0 : end + i - 1);
}
/// The number of vertices of a half, in a face of \p numVertices.
constexpr int GetHalfSize(int half, int numVertices, int end) {
    return half == 1 ? end + 1 : numVertices - end + 1;
}
/// The half that edge \p local of a face belongs to, by default of a hexagon.
constexpr int GetHalfOfEdge(int local, int end = kDiagonalEnd) { return local < end ? 1 : 0; }
/// Edge \p local of a face, as an edge of its half: 1 or more, since the diagonal is edge 0 of each half.
constexpr int GetEdgeInHalf(int local, int end = kDiagonalEnd) {
    return local < end ? local + 1 : local - end + 1;
}
/// Whether an E-face of \p numCorners corners has two halves: it is a hexagon.
constexpr bool HasHalves(int numCorners) { return numCorners == 6; }

/// \brief The shape of a face that has a surface: a polygon, or half of one.
///
/// Hexagonal steps divide a polygon into *sectors*, one for each edge: the triangle of the edge and the centre.  The
/// centre of half a polygon is the middle of its *long edge*, edge 0, along which the whole was cut: edge 0 has no
/// sector.
struct FaceShape {
    /// A face of \p numVertices vertices.
    constexpr FaceShape(int numVertices = 0, bool isHalfPolygon = false)
        : size(numVertices), isHalf(isHalfPolygon) {}

    /// The first edge that has a sector.
    constexpr int GetFirstSector() const { return isHalf ? 1 : 0; }
    /// The number of edges that have a sector.
    constexpr int GetNumSectors() const { return size - GetFirstSector(); }
    /// \brief The sector that begins at the line from the centre to a corner.
    ///
    /// At corner 0 of half a polygon no sector begins: the result is the last sector, which ends there.
    constexpr int GetSectorOfCorner(int corner) const {
        return isHalf && corner == 0 ? size - 1 : corner;
    }

    /// Whether two shapes are equal.
    friend constexpr bool operator==(FaceShape const &a, FaceShape const &b) {
        return a.size == b.size && a.isHalf == b.isHalf;
    }
    /// Whether two shapes differ.
    friend constexpr bool operator!=(FaceShape const &a, FaceShape const &b) { return !(a == b); }
    /// An order of shapes.
    friend constexpr bool operator<(FaceShape const &a, FaceShape const &b) {
        return a.size != b.size ? a.size < b.size : a.isHalf < b.isHalf;
    }

    int size;    ///< vertices
    bool isHalf; ///< half a polygon
};

/// \brief The closed-form numbering of a child level in terms of its parent: see INDEXING.md.
///
/// \code
///     FarExt::HexIndexing const indexing = parent.GetChildIndexing();
///     int const vertex = indexing.GetCornerChildVertex(corner);
/// \endcode
///
/// A *corner* is a position in the parent's face-vertex array.  Nothing is stored but the parent's
/// counts; every function is arithmetic on them, in which nothing is larger than the result.  Results are
/// those of a child whose counts fit into Index, as all have that RefineUniform makes.  This numbering is
/// public and stable.
class HexIndexing {
public:
    /// A vertex, an edge, a face or a corner.
    using Index = Far::Index;

    /// From the counts of the parent.
    constexpr HexIndexing(Index numVertices, Index numFaces, Index numCorners)
        : _numVertices(numVertices), _numFaces(numFaces), _numCorners(numCorners) {}

    /// Corners of the E-face of an interior edge.
    static constexpr int kNumEFaceCorners = 6;
    /// Corners of the E-face of a boundary edge.
    static constexpr int kNumBoundaryEFaceCorners = 4;

    /// V-vertex: the child of parent vertex \p v.
    constexpr Index GetVertexChildVertex(Index v) const { return v; }
    /// F-vertex: the child of parent corner \p c.
    constexpr Index GetCornerChildVertex(Index c) const { return _numVertices + c; }

    /// F-face: the child of parent face \p f.
    constexpr Index GetFaceChildFace(Index f) const { return f; }
    /// E-face: the child of parent edge \p e.  \p numBBefore of the edges before it are B edges,
    /// which make none.
    constexpr Index GetEdgeChildFace(Index e, Index numBBefore) const {
        return _numFaces + (e - numBBefore);
    }

    /// First corner of the F-face of parent face \p f, whose first corner is \p pFirstCorner.
    constexpr Index GetFaceChildFirstCorner(Index pFirstCorner) const { return pFirstCorner; }
    /// First corner of the E-face of parent edge \p e, when \p numBBefore of the edges before are
    /// B edges, and \p numBoundaryBefore are boundaries that make an E-face.
    constexpr Index GetEdgeChildFirstCorner(Index e, Index numBBefore,
                                            Index numBoundaryBefore) const {
        return _numCorners + kNumEFaceCorners * (e - numBBefore - numBoundaryBefore) +
               kNumBoundaryEFaceCorners * numBoundaryBefore;
    }

    /// Edge of the F-face from the F-vertex of parent corner \p c to that of the next corner.
    constexpr Index GetCornerChildEdge(Index c) const { return c; }
    /// Spoke: the edge from the V-vertex to the F-vertex of parent corner \p c.
    constexpr Index GetCornerChildSpoke(Index c) const { return _numCorners + c; }
    /// Edge between the V-vertices of the \p rank'th of the parent's boundary edges that make an
    /// E-face.
    constexpr Index GetBoundaryChildEdge(Index rank) const { return 2 * _numCorners + rank; }

    /// Whether a child vertex is an F-vertex.
    constexpr bool IsVertexFromCorner(Index cVert) const { return cVert >= _numVertices; }
    /// The parent corner of an F-vertex.
    constexpr Index GetChildVertexCorner(Index cVert) const { return cVert - _numVertices; }
    /// Whether a child face is an E-face.
    constexpr bool IsFaceFromEdge(Index cFace) const { return cFace >= _numFaces; }

private:
    Index _numVertices;
    Index _numFaces;
    Index _numCorners;
};

} // namespace OpenSubdivHex::FarExt

#endif
