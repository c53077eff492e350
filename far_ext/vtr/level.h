// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_VTR_LEVEL_H
#define OPENSUBDIVHEX_FAR_EXT_VTR_LEVEL_H

#include "buffer.h"
#include "kept.h"
#include "quadCorners.h"

#include "far_ext/indexing.h"
#include "far_ext/rules/lineRow.h"
#include "far_ext/rules/mask.h"

#include <opensubdiv/sdc/crease.h>
#include <opensubdiv/vtr/types.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

namespace OpenSubdivHex::FarExt::internal {

class RefinementRules;
enum class VertexMark : unsigned char;

/// \brief How a boundary edge refines.  Stands in Level::edgeFaces in place of the second
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
    /// How much of the smooth rule and of that of a crease is in the weights; the rest is that of a corner.
    double smoothShare;
    double creaseShare;
};

/// \brief A corner whose F-vertex has a mask of its own, because a vertex has many faces between two sharp edges, or,
/// on a smooth line and with FaceMask::Smooth, one: see ComputeSectorShrink in mask.h, kOneFaceMask in sharpMask.h.
///
/// Edges whose sharpness is below 1 take part in proportion to it: the corner has an entry for each
/// set of edges that are at least as sharp as some threshold in (0, 1].
struct SectorCorner {
    /// Where the vertex is, seen from the corner.
    enum Kind : std::int32_t {
        kInWide, ///< the corner's own, with many faces
        // With one face:
        kAtOne,     ///< the corner's own
        kBehindOne, ///< before the corner in the face
        kBeforeOne, ///< behind the corner in the face
        kBesideOne, ///< in a half face, or half of a hexagon, the end of the long side beside the corner
        kFarFromOne ///< there, the other end
    };
    Far::Index corner;
    float sectorSize; ///< faces between the sharp edges; a half hexagon counts half
    float weight; ///< share of the thresholds; the entries of a corner and kind sum to 1 at most
    Kind kind;
};

/// \brief One of the sharp edges that meet in a vertex of a patch where some of them may be missing.
///
/// By Chaikin's rule the sharpness of an edge depends on that of all edges at its ends.
struct SharpEnd {
    Far::Index vert;
    float sharpness;
};

/// \brief A vertex inside the mesh where four hexagons or more meet: see ComputeIrregularVertexMask
/// in mask.h.
struct IrregularVertex {
    Far::Index vert;
    /// Share of its masks: less than 1 where it, or an edge or diagonal at it, is sharp.  0 where only the
    /// next level may have a share, and what was around the vertex matters there.
    float weight;
};

/// \brief A corner of a hexagon whose F-vertex has a mask of its own, since an irregular vertex or a
/// quad is beside it.
struct IrregularCorner {
    /// The irregular parts, seen from the corner.
    enum Kind : std::uint16_t { // without padding in the corner, whose bytes are compared
        kAtVertex,              ///< its vertex
        kBehindVertex,          ///< the vertex before it in the face
        kBeforeVertex,          ///< the vertex behind it in the face
        kAlongQuad,             ///< the face across the edge from it
        kBehindQuad,            ///< the face across the edge to it
        kOneBeforeQuad,         ///< the face across the next edge but one
        kOneBehindQuad          ///< the face across the last edge but one
    };
    static bool IsAtQuad(Kind kind) { return kind >= kAlongQuad; }
    Far::Index corner;
    Far::Index numFaces; ///< of the irregular vertex; 0 beside a quad
    float weight;        ///< as of the vertex
    Kind kind;
    FacesAround facesAround; ///< of the irregular vertex; Others beside a quad
};

/// \brief A corner of a face beside a line that is regular there, behind a truncation.
struct LineRowCorner {
    Far::Index corner;
    /// Sharpness of the least sharp of the line's edges that make it regular, less one for each step.
    float sharpness;
    LineFace face;
    std::uint16_t place; ///< of the corner in the face

    /// The share of the masks beside a sharp line.
    float GetShare() const { return std::min(1.0f, sharpness); }
};

/// \brief A corner of a quad beside smooth lines, or of what the first steps made of it.
struct QuadLineCorner {
    Far::Index corner;
    QuadLineFlags flags;
};

/// \brief Tags of corners, each kind ascending by corner.
///
/// Each begins with its corner, and has no padding: behind the corner, equal bytes are equal tags.
struct CornerTags {
    std::vector<SectorCorner> sectorCorners; ///< of a corner by kind
    // Tags of FaceMask::Smooth; empty with other masks.
    std::vector<IrregularCorner> irregularCorners; ///< one for a corner at most
    std::vector<LineRowCorner> lineRowCorners;     ///< more than one between lines
    std::vector<QuadLineCorner>
        quadLineCorners;     ///< one for a corner at most; of level 0 with all masks
    QuadCorners quadCorners; ///< one for a corner at most

    bool HasCornerTags() const {
        return !sectorCorners.empty() || !irregularCorners.empty() || !quadCorners.empty() ||
               !lineRowCorners.empty() || !quadLineCorners.empty();
    }
    /// Calls function(tags of the kind ...) for each kind, of one thing or of several that have members of these names.
    template <typename FUNCTION, typename... THINGS>
    static void ForEachKind(FUNCTION const &function, THINGS &...things) {
        ForEachListedKind(function, things...);
        function(things.quadCorners...);
    }
    /// Only for those that are listed, as vectors.
    template <typename FUNCTION, typename... THINGS>
    static void ForEachListedKind(FUNCTION const &function, THINGS &...things) {
        function(things.sectorCorners...);
        function(things.irregularCorners...);
        function(things.lineRowCorners...);
        function(things.quadLineCorners...);
    }
};

/// The tags of corners \p begin to \p end - 1 among those of a kind, of few corners.
template <typename TAG>
OpenSubdiv::Vtr::ConstArray<TAG> FindCornerTags(std::vector<TAG> const &tags, Far::Index begin,
                                                Far::Index end) {
    auto const first =
        std::lower_bound(tags.begin(), tags.end(), begin,
                         [](TAG const &tag, Far::Index corner) { return tag.corner < corner; });
    auto last = first;
    while (last != tags.end() && last->corner < end) {
        ++last;
    }
    return {tags.data() + (first - tags.begin()), int(last - first)};
}

/// \brief A range of tags in a QuadCorners.
struct QuadCornerRange {
    QuadCorners::Iterator first;
    QuadCorners::Iterator behind;

    QuadCorners::Iterator begin() const { return first; }
    QuadCorners::Iterator end() const { return behind; }
    bool empty() const { return first == behind; }
    QuadCorner const &front() const { return *first; }
};
inline QuadCornerRange FindCornerTags(QuadCorners const &tags, Far::Index begin, Far::Index end) {
    return {{tags, begin, end}, {tags, end, end}};
}

/// \brief A boundary edge where an edge of level 0 came apart into one for each of its faces.  Edges
/// of one line run along one curve.
struct LineEdge {
    Far::Index edge;
    Far::Index line; ///< the edge of level 0, in the numbering of the base
};

/// \brief A face that a line crosses from its vertex 0 to another one, and no hexagon that an edge made: the V-face
/// that a truncation makes of a vertex which a crease passes, and what becomes of it.
struct CrossedFace {
    Far::Index face;
    int end; ///< the vertex where the diagonal ends
};

/// The entry of a face among some that ascend; null where there is none.
inline CrossedFace const *FindCrossedFaceIn(std::vector<CrossedFace> const &faces,
                                            Far::Index face) {
    if (faces.empty()) {
        return nullptr;
    }
    auto const found = std::lower_bound(
        faces.begin(), faces.end(), face,
        [](CrossedFace const &crossed, Far::Index other) { return crossed.face < other; });
    return found != faces.end() && found->face == face ? &*found : nullptr;
}

/// @name The places of vertices in their edges, where a hexagonal step made both without boundaries
/// @{
/// All edges of a V-vertex are spokes, which begin there.
inline constexpr std::array<Far::LocalIndex, OpenSubdiv::Vtr::VALENCE_LIMIT> kVVertexEdgeLocals{};
/// An F-vertex has the edge of the F-face to the next corner, that from the corner before, a spoke.
inline constexpr std::array<Far::LocalIndex, 3> kFVertexEdgeLocals = {0, 1, 1};
/// @}

/// In Level::faceHoles, a face all of which lies in holes.
inline constexpr unsigned char kHole = 3;

/// \brief A corner, and the face that has it.
struct FaceCorner {
    Far::Index face;
    Far::Index corner;
};

/// Two of something, for the two ends or sides of an edge.
using IndexPair = std::array<Far::Index, 2>;
using LocalIndexPair = std::array<Far::LocalIndex, 2>;

/// \brief The relations, tags and masks of one level of a mesh.  It is not changed once it is
/// filled.  What relates it to other levels is in Refinement; TopologyLevel is the public view.
///
/// Invariants of every level, level 0 included:
///  - a face's vertices run in its orientation; its edge i joins its vertices i and i + 1;
///  - an edge's first face runs from the edge's first vertex to its second, the other face back;
///    a boundary edge has a BoundaryKind in place of the second face;
///  - the edges and faces of a vertex are in counter-clockwise order: face i lies between edges i
///    and i + 1; at a boundary vertex the first and the last edge are boundaries.  The fans of a
///    non-manifold vertex follow one another, each in this order.
struct Level : CornerTags {
    using Index = Far::Index;
    using LocalIndex = Far::LocalIndex;

    Level() = default;
    Level(Level const &) = delete; // its arrays may lie in its memory
    Level &operator=(Level const &) = delete;

    /// The numbering of a child that the hexagonal refinement makes.
    HexIndexing ChildIndexing() const { return HexIndexing(numVertices, numFaces, numCorners); }

    int GetFaceSize(Index f) const { return faceFirstCorner[f + 1] - faceFirstCorner[f]; }
    Far::ConstIndexArray GetFaceVertices(Index f) const {
        return {faceVerts.data() + faceFirstCorner[f], GetFaceSize(f)};
    }
    int GetNumVertexFaces(Index v) const { return vertFirstFace[v + 1] - vertFirstFace[v]; }
    Far::ConstIndexArray GetVertexFaces(Index v) const {
        return {vertFaces.data() + vertFirstFace[v], GetNumVertexFaces(v)};
    }
    Far::ConstIndexArray GetVertexEdges(Index v) const {
        return {vertEdges.data() + vertFirstEdge[v], vertFirstEdge[v + 1] - vertFirstEdge[v]};
    }

    /// The face that a corner is in.
    Index FindFaceOfCorner(Index corner) const {
        Index const *const first = faceFirstCorner.begin();
        if (isHexagonal && corner >= numFFaceCorners) {
            // E-faces have six corners, but for those at boundaries, which come last.
            Index const face =
                numFFaces + (corner - numFFaceCorners) / HexIndexing::kNumEFaceCorners;
            if (corner < first[face + 1]) {
                return face;
            }
        }
        return Index(std::upper_bound(first, faceFirstCorner.end(), corner) - first) - 1;
    }
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
        Index const face = edgeFaces[e][side];
        return face < 0 ? face : faceFirstCorner[face] + edgeFaceLocals[e][side];
    }

    /// The corner at which the other side begins, of an interior edge that begins at a corner.
    FaceCorner GetCornerAcross(Index corner) const {
        Index const edge = faceEdges[corner];
        int const side = GetSideCorner(edge, 0) == corner ? 1 : 0;
        return {edgeFaces[edge][side], GetSideCorner(edge, side)};
    }

    /// The place of a vertex, 0 or 1, in each of its edges.
    LocalIndex const *GetVertexEdgeLocals(Index v) const {
        if (!vertEdgeLocals.empty()) {
            return vertEdgeLocals.data() + vertFirstEdge[v];
        }
        return v < numVVertices ? kVVertexEdgeLocals.data() : kFVertexEdgeLocals.data();
    }

    bool IsBoundary(Index e) const { return edgeFaces[e][1] < 0; }
    bool IsSharpBoundaryB(Index e) const { return edgeFaces[e][1] == kSharpBoundaryB; }
    bool IsHalfFace(Index f) const {
        return !halfFaces.empty() &&
               IsSharpBoundaryB(faceEdges[faceFirstCorner[f] + kHalfFaceLongEdge]);
    }
    int GetNumBoundaries() const {
        return numFreeBoundaries + numSharpBoundariesA + numSharpBoundariesB;
    }
    /// Whether any face of the level has another mask than that of its size.
    bool HasFeatures() const { return HasSharpFaces() || HasCornerTags(); }
    /// Whether that is so because of something sharp.
    bool HasSharpFaces() const {
        return !halfFaces.empty() || !diagonalSharpness.empty() || !sectorCorners.empty();
    }
    float GetEdgeSharpness(Index e) const { return edgeSharpness.empty() ? 0 : edgeSharpness[e]; }
    /// @name Faces in two halves
    /// @{
    CrossedFace const *FindCrossedFace(Index f) const { return FindCrossedFaceIn(crossedFaces, f); }
    /// The vertex where the diagonal of a face ends, if it has one.
    int GetDiagonalEnd(Index f) const {
        CrossedFace const *const crossed = FindCrossedFace(f);
        return crossed ? crossed->end : kDiagonalEnd;
    }
    bool HasFaceHalves(Index f) const { return HasHalves(GetFaceSize(f)) || FindCrossedFace(f); }
    /// The half that edge \p local of a face belongs to, if it has halves.
    int GetHalfOfFaceEdge(Index f, int local) const {
        return GetHalfOfEdge(local, GetDiagonalEnd(f));
    }
    /// @}
    float GetDiagonalSharpness(Index f) const {
        return diagonalSharpness.empty() ? 0 : diagonalSharpness[f];
    }
    float GetVertexSharpness(Index v) const {
        return std::size_t(v) < vertSharpness.size() ? vertSharpness[v] : 0;
    }
    /// Bits of faceHoles, both of a face that is not cut.
    unsigned GetHoles(Index f) const { return faceHoles.empty() ? 0 : faceHoles[f]; }
    /// The line of edge \p e, INDEX_INVALID when it has none.
    Index GetEdgeLine(Index e) const {
        auto const found =
            std::lower_bound(lineEdges.begin(), lineEdges.end(), e,
                             [](LineEdge const &line, Index edge) { return line.edge < edge; });
        return found != lineEdges.end() && found->edge == e ? found->line : Far::INDEX_INVALID;
    }
    bool IsNonManifold(Index v) const {
        return std::binary_search(nonManifoldVerts.begin(), nonManifoldVerts.end(), v);
    }

    /// The sharp vertex \p v, null when its rule is the smooth one.
    SharpVertex const *FindSharpVertex(Index v) const {
        auto const found = std::lower_bound(
            sharpVerts.begin(), sharpVerts.end(), v,
            [](SharpVertex const &sharp, Index vert) { return sharp.vert < vert; });
        return found != sharpVerts.end() && found->vert == v ? &*found : nullptr;
    }
    /// The irregular vertex \p v, null when it is none.
    IrregularVertex const *FindIrregularVertex(Index v) const {
        if (irregularVerts.empty() || v > irregularVerts.back().vert) {
            return nullptr; // F-vertices, which are most, and the last
        }
        auto const found = std::lower_bound(
            irregularVerts.begin(), irregularVerts.end(), v,
            [](IrregularVertex const &irregular, Index vert) { return irregular.vert < vert; });
        return found->vert == v ? &*found : nullptr;
    }
    /// Whether the level has no orders of edges around vertices of its own: where a hexagonal
    /// refinement made it without boundaries, vertices have as many edges as faces, and their
    /// places in these are known.
    bool HasImpliedVertexEdges() const { return isHexagonal && GetNumBoundaries() == 0; }

    /// \brief Calls function(array, size) for the arrays of all relations of \p level, a Level or a
    /// constant one, with the number of entries that follows from its counts: 0 for those that it
    /// does not have.
    ///
    /// Where HasImpliedVertexEdges(), vertFirstEdge lies in the place of vertFirstFace.
    template <typename LEVEL, typename FUNCTION>
    static void ForEachRelation(LEVEL &level, FUNCTION const &function) {
        auto const numVertices = std::size_t(level.numVertices);
        auto const numFaces = std::size_t(level.numFaces);
        auto const numCorners = std::size_t(level.numCorners);
        auto const numEdges = std::size_t(level.hasFullTopology ? level.numEdges : 0);
        std::size_t const numFullCorners = level.hasFullTopology ? numCorners : 0;
        bool const hasVertexEdges = level.hasFullTopology && !level.HasImpliedVertexEdges();
        function(level.faceFirstCorner, numFaces + 1);
        function(level.faceVerts, numCorners);
        function(level.faceEdges, numFullCorners);
        function(level.edgeVerts, numEdges);
        function(level.edgeFaces, numEdges);
        function(level.edgeFaceLocals, numEdges);
        function(level.boundaryEdges, level.hasFullTopology ? level.GetNumBoundaries() : 0);
        function(level.halfFaces, level.hasFullTopology ? level.numSharpBoundariesB : 0);
        function(level.vertFirstFace, level.hasFullTopology ? numVertices + 1 : 0);
        function(level.vertFaces, numFullCorners);
        function(level.vertFaceLocals, numFullCorners);
        function(level.vertEdges, 2 * numEdges);
        function(level.vertFirstEdge, hasVertexEdges ? numVertices + 1 : 0);
        function(level.vertEdgeLocals, hasVertexEdges ? 2 * numEdges : 0);
    }
    /// Calls function(array) for the arrays of all tags and masks.
    template <typename LEVEL, typename FUNCTION>
    static void ForEachTag(LEVEL &level, FUNCTION const &function) {
        function(level.edgeSharpness);
        function(level.diagonalSharpness);
        function(level.crossedFaces);
        function(level.cutFaces);
        function(level.vertSharpness);
        function(level.faceHoles);
        function(level.nonManifoldVerts);
        function(level.partedVerts);
        function(level.nonManifoldEdges);
        function(level.lineEdges);
        function(level.sharpVerts);
        function(level.irregularVerts);
        CornerTags::ForEachListedKind(function, level);
        QuadCorners::ForEachArray(level.quadCorners, function);
    }

    int depth = 0;

    Index numVertices = 0;
    Index numEdges = 0;
    Index numFaces = 0;
    Index numCorners = 0;        ///< entries of faceVerts
    Index numFreeBoundaries = 0; ///< boundary edges by their BoundaryKind
    Index numSharpBoundariesA = 0;
    Index numSharpBoundariesB = 0;

    // Origin of a refined level, as the numbering has it.
    bool isHexagonal = false;  ///< by a hexagonal refinement, whose E-faces' sides are known
    int numHexagonalSteps = 0; ///< that made it, behind the last step of another scheme
    Index numVVertices = 0;    ///< the first vertices, made of vertices; F-vertices follow
    Index numFFaces = 0;       ///< the first faces, made of faces; they have ...
    Index numFFaceCorners = 0; ///< ... the first corners, and from each of these an edge
    Index numVFaces = 0;       ///< the last faces, made for vertices
    /// Whether no step of another scheme came before: then lines have masks of their own in the first steps.
    bool hasFirstLineMasks = true;
    /// The vertices of the last level that was not made by a hexagonal refinement; those behind
    /// them have three faces, or two at a boundary.
    Index numVertsOfAnyValence = 0;

    /// False when only the face-vertices were made (the last level, unless asked for more).
    bool hasFullTopology = false;

    Buffer<std::byte> memory; ///< of the relations that a hexagonal refinement makes
    /// Relations that are derived from faces: of corners and vertices, and of edges.
    Buffer<std::byte> cornerMemory;
    Buffer<std::byte> edgeMemory;

    Buffer<Index> faceFirstCorner; ///< positions in faceVerts and faceEdges
    Buffer<Index> faceVerts;
    Buffer<Index> faceEdges;

    Buffer<IndexPair> edgeVerts;
    Buffer<IndexPair> edgeFaces;
    Buffer<LocalIndexPair> edgeFaceLocals; ///< the edge's place in each face
    Buffer<Index> boundaryEdges;           ///< all kinds, ascending
    Buffer<Index> halfFaces;               ///< faces with a B edge, ascending

    Buffer<Index> vertFirstFace; ///< positions in vertFaces and vertFaceLocals
    Buffer<Index> vertFaces;
    Buffer<LocalIndex> vertFaceLocals; ///< the vertex's place in each of its faces
    Buffer<Index> vertFirstEdge;       ///< positions in vertEdges and vertEdgeLocals
    Buffer<Index> vertEdges;
    Buffer<LocalIndex> vertEdgeLocals; ///< see GetVertexEdgeLocals

    std::vector<Index> faceSizes; ///< ascending; all that occur in the level, perhaps more

    // Tags; each array is empty in a level that has none of its kind.
    Buffer<float> edgeSharpness;     ///< by edge, of interior ones
    Buffer<float> diagonalSharpness; ///< by face
    std::vector<CrossedFace>
        crossedFaces; ///< ascending; the same at all levels behind a truncation
    /// The crossed faces whose diagonals are infinitely sharp, in the level that a truncation makes.
    std::vector<CrossedFace> cutFaces;
    Buffer<float> vertSharpness;     ///< of the vertices of level 0, the only ones that have any
    Buffer<unsigned char> faceHoles; ///< by face: bit h is set when half h lies in holes
    std::vector<Index> nonManifoldVerts; ///< ascending
    std::vector<Index> partedVerts;      ///< those that gaps of the refinement part into fans
    std::vector<Index> nonManifoldEdges; ///< ascending; of level 0 alone
    std::vector<LineEdge> lineEdges;     ///< ascending; of levels with full topology

    std::vector<SharpVertex> sharpVerts; ///< ascending; all with a rule but RULE_SMOOTH
    /// Only in patches; vertices ascend, and edges are in the order around them.
    std::vector<SharpEnd> sharpEnds;

    std::vector<IrregularVertex> irregularVerts; ///< ascending; empty but with FaceMask::Smooth

    // Made when they are first asked for.
    Kept<RefinementRules> rules[2];            ///< by Interpolation; see GetRules()
    Kept<std::vector<VertexMark>> vertexMarks; ///< see GetVertexMarks()
};

} // namespace OpenSubdivHex::FarExt::internal

#endif
