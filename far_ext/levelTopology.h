// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_LEVEL_TOPOLOGY_H
#define OPENSUBDIVHEX_FAR_EXT_LEVEL_TOPOLOGY_H

#include "buffer.h"
#include "indexing.h"

#include <opensubdiv/sdc/crease.h>
#include <opensubdiv/vtr/types.h>

#include <algorithm>
#include <array>
#include <vector>

namespace OpenSubdivHex::FarExt::internal {

/// \brief How a boundary edge refines.  Stands in LevelTopology::edgeFaces in place of the second
/// face.  The phases A and B of sharp boundaries alternate as INDEXING.md shows.
enum BoundaryKind : Far::Index {
    kFreeBoundary = Far::INDEX_INVALID, ///< the paper's rule: stays one edge for ever
    kSharpBoundaryA = -2,               ///< runs along an edge of the hexagonal lattice
    kSharpBoundaryB = -3                ///< cuts a hexagon in two: its face is a half face
};

/// \brief The mask of a vertex on a sharp feature:
/// V' = vertexWeight V + faceWeight (sum of its F-vertices) + sum of neighborWeights neighbors.
struct SharpVertex {
    Far::Index vert;
    Sdc::Crease::Rule rule;
    double vertexWeight;
    double faceWeight;
    Far::Index neighbors[2]; ///< along the crease; meaningless where the weight is 0
    double neighborWeights[2];
};

/// \brief A corner whose F-vertex is drawn towards its vertex, because that has many faces between
/// two sharp edges: see ComputeSectorShrink in mask.h.
///
/// Edges whose sharpness is below 1 take part in proportion to it: the corner has an entry for each
/// set of edges that are at least as sharp as some threshold in (0, 1].
struct SectorCorner {
    Far::Index corner;
    float sectorSize; ///< faces between the sharp edges; a half hexagon counts half
    float weight;     ///< share of the thresholds; the entries of a corner sum to 1 at most
};

/// \brief A boundary edge where an edge of level 0 came apart into one for each of its faces.  Edges
/// of one line run along one curve.
struct LineEdge {
    Far::Index edge;
    Far::Index line; ///< the edge of level 0, in the numbering of the base
};

/// @name The places of vertices in their edges, where a hexagonal step made both without boundaries
/// @{
/// All edges of a V-vertex are spokes, which begin there.
inline constexpr std::array<Far::LocalIndex, OpenSubdiv::Vtr::VALENCE_LIMIT> kVVertexEdgeLocals{};
/// An F-vertex has the edge of the F-face to the next corner, that from the corner before, a spoke.
inline constexpr std::array<Far::LocalIndex, 3> kFVertexEdgeLocals = {0, 1, 1};
/// @}

struct FVarLevel;

/// \brief The arrays of one level.  TopologyLevel is the public view of them.
///
/// Invariants of every level, level 0 included:
///  - a face's vertices run in its orientation; its edge i joins its vertices i and i + 1;
///  - an edge's first face runs from the edge's first vertex to its second, the other face back;
///    a boundary edge has a BoundaryKind in place of the second face;
///  - the edges and faces of a vertex are in counter-clockwise order: face i lies between edges i
///    and i + 1; at a boundary vertex the first and the last edge are boundaries.  The fans of a
///    non-manifold vertex follow one another, each in this order.
struct LevelTopology {
    using Index = Far::Index;
    using LocalIndex = Far::LocalIndex;

    LevelTopology();
    ~LevelTopology();

    /// The numbering of a child that the hexagonal step makes.
    HexIndexing ChildIndexing() const { return HexIndexing(numVertices, numFaces, numCorners); }

    /// @name Children, of a level that was refined by any step
    /// @{
    /// INDEX_INVALID when the step makes no V-vertex of it.
    Index GetVertexChildVertex(Index v) const {
        return vertChildVerts.empty() ? v : vertChildVerts[v];
    }
    /// The inverse: the vertex that V-vertex \p cVert, below numVVertices, was made of.
    Index GetVVertexParent(Index cVert) const {
        return vVertexParents.empty() ? cVert : vVertexParents[cVert];
    }
    Index GetCornerChildVertex(Index corner) const { return numVVertices + corner; }
    Index GetChildVertexCorner(Index cVert) const { return cVert - numVVertices; }
    /// @}

    /// The corners before and after a corner of a face.
    Index GetPrevCorner(Index f, Index corner) const {
        return (corner == faceFirstCorner[f] ? faceFirstCorner[f + 1] : corner) - 1;
    }
    Index GetNextCorner(Index f, Index corner) const {
        return corner + 1 == faceFirstCorner[f + 1] ? faceFirstCorner[f] : corner + 1;
    }
    /// The corner of a vertex in the face at position \p k of vertFaces.
    Index GetVertexCorner(Index k) const {
        return faceFirstCorner[vertFaces[k]] + vertFaceLocals[k];
    }
    /// The corner where side \p side of an edge starts; a BoundaryKind, negative, where there is
    /// none.
    Index GetSideCorner(Index e, int side) const {
        std::size_t const k = 2 * std::size_t(e) + std::size_t(side);
        return edgeFaces[k] < 0 ? edgeFaces[k] : faceFirstCorner[edgeFaces[k]] + edgeFaceLocals[k];
    }

    /// The place of a vertex, 0 or 1, in each of its edges.
    LocalIndex const *GetVertexEdgeLocals(Index v) const {
        if (!vertEdgeLocals.empty()) {
            return vertEdgeLocals.data() + vertFirstEdge[v];
        }
        return v < parent->numVertices ? kVVertexEdgeLocals.data() : kFVertexEdgeLocals.data();
    }

    bool IsBoundary(Index e) const { return edgeFaces[2 * std::size_t(e) + 1] < 0; }
    bool IsSharpBoundaryB(Index e) const {
        return edgeFaces[2 * std::size_t(e) + 1] == kSharpBoundaryB;
    }
    /// The E-face of edge \p e, INDEX_INVALID for a B edge.
    Index GetEdgeChildFace(Index e) const {
        return edgeChildFaces.empty() ? ChildIndexing().GetEdgeChildFace(e, 0) : edgeChildFaces[e];
    }
    bool IsHalfFace(Index f) const {
        return !halfFaces.empty() &&
               IsSharpBoundaryB(faceEdges[faceFirstCorner[f] + kHalfFaceLongEdge]);
    }
    /// Whether any face of the level has another mask than that of its size.
    bool HasFeatures() const {
        return !halfFaces.empty() || !diagonalSharpness.empty() || !sectorCorners.empty();
    }
    float GetEdgeSharpness(Index e) const { return edgeSharpness.empty() ? 0 : edgeSharpness[e]; }
    float GetDiagonalSharpness(Index f) const {
        return diagonalSharpness.empty() ? 0 : diagonalSharpness[f];
    }
    float GetVertexSharpness(Index v) const {
        return std::size_t(v) < vertSharpness.size() ? vertSharpness[v] : 0;
    }

    /// The line of edge \p e, INDEX_INVALID when it has none.
    Index GetEdgeLine(Index e) const {
        auto const found =
            std::lower_bound(lineEdges.begin(), lineEdges.end(), e,
                             [](LineEdge const &line, Index edge) { return line.edge < edge; });
        return found != lineEdges.end() && found->edge == e ? found->line : Far::INDEX_INVALID;
    }

    /// The sharp vertex \p v, null when its rule is the smooth one.
    SharpVertex const *FindSharpVertex(Index v) const {
        auto const found = std::lower_bound(
            sharpVerts.begin(), sharpVerts.end(), v,
            [](SharpVertex const &sharp, Index vert) { return sharp.vert < vert; });
        return found != sharpVerts.end() && found->vert == v ? &*found : nullptr;
    }
    /// The entries of the corners from \p begin to \p end - 1 that lie in wide sectors.
    OpenSubdiv::Vtr::ConstArray<SectorCorner> GetSectorCorners(Index begin, Index end) const {
        auto const isBefore = [](SectorCorner const &sector, Index c) { return sector.corner < c; };
        auto const first =
            std::lower_bound(sectorCorners.begin(), sectorCorners.end(), begin, isBefore);
        auto const last = std::lower_bound(first, sectorCorners.end(), end, isBefore);
        return {sectorCorners.data() + (first - sectorCorners.begin()), int(last - first)};
    }

    int depth = 0;
    LevelTopology const *parent = nullptr;
    LevelTopology const *child = nullptr;

    Index numVertices = 0;
    Index numEdges = 0;
    Index numFaces = 0;
    Index numCorners = 0;        ///< entries of faceVerts
    Index numFreeBoundaries = 0; ///< boundary edges by their BoundaryKind
    Index numSharpBoundariesA = 0;
    Index numSharpBoundariesB = 0;

    /// False when only the face-vertices were made (the last level, unless asked for more).
    bool hasFullTopology = false;
    /// Whether the hexagonal step made the level: the sides of its E-faces' edges are known then.
    bool isHexagonal = false;

    Buffer<std::byte> memory; ///< of the arrays that refinement makes

    Buffer<Index> faceFirstCorner; ///< numFaces + 1 positions in faceVerts and faceEdges
    Buffer<Index> faceVerts;       ///< numCorners
    Buffer<Index> faceEdges;       ///< numCorners

    Buffer<Index> edgeVerts;           ///< 2 per edge
    Buffer<Index> edgeFaces;           ///< 2 per edge
    Buffer<LocalIndex> edgeFaceLocals; ///< 2 per edge: the edge's place in each face
    Buffer<Index> boundaryEdges;       ///< all kinds, ascending
    Buffer<Index> halfFaces;           ///< faces with a B edge, ascending

    Buffer<Index> vertFirstFace; ///< numVertices + 1 positions in vertFaces, vertFaceLocals
    Buffer<Index> vertFaces;
    Buffer<LocalIndex> vertFaceLocals; ///< the vertex's place in each of its faces
    Buffer<Index> vertFirstEdge;       ///< numVertices + 1 positions in vertEdges, vertEdgeLocals
    Buffer<Index> vertEdges;
    Buffer<LocalIndex> vertEdgeLocals; ///< see GetVertexEdgeLocals; empty where that knows

    // Children, of a level that was refined.
    Index numVVertices = 0;       ///< vertices of the child that were made of vertices
    Buffer<Index> vertChildVerts; ///< numVertices; empty when V-vertices have their parent's index
    Buffer<Index> vVertexParents; ///< numVVertices, ascending; empty likewise
    // After a hexagonal step in the memory of the child.
    Buffer<Index> faceChildFaces; ///< numFaces
    Buffer<Index> edgeChildFaces; ///< numEdges; empty when every edge makes an E-face

    Index numVFaces = 0;          ///< the last faces of the level, made for vertices of its parent
    std::vector<Index> faceSizes; ///< ascending; all that occur in the level, perhaps more

    // Tags; each array is empty in a level that has none of its kind.
    Buffer<float> edgeSharpness;     ///< numEdges, of interior edges
    Buffer<float> diagonalSharpness; ///< numFaces
    Buffer<float> vertSharpness;     ///< of the vertices of level 0, the only ones that have any
    Buffer<unsigned char> faceHoles; ///< numFaces
    std::vector<Index> nonManifoldVerts; ///< ascending
    std::vector<Index> partedVerts; ///< those that gaps of the step to the level part into fans
    std::vector<Index> nonManifoldEdges; ///< ascending; of level 0 alone
    std::vector<LineEdge> lineEdges;     ///< ascending; of levels with full topology

    std::vector<SharpVertex> sharpVerts; ///< ascending; all vertices with a rule but RULE_SMOOTH

    std::vector<SectorCorner> sectorCorners; ///< ascending

    std::vector<std::unique_ptr<FVarLevel>> fvarLevels; ///< by channel
};

} // namespace OpenSubdivHex::FarExt::internal

#endif
