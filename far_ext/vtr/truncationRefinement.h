// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_VTR_TRUNCATION_REFINEMENT_H
#define OPENSUBDIVHEX_FAR_EXT_VTR_TRUNCATION_REFINEMENT_H

#include "baseLevel.h"
#include "childCounts.h"
#include "hierarchy.h"
#include "vertexFan.h"

namespace OpenSubdivHex::FarExt::internal {

/// \brief The effect of a truncation on the polygon of a vertex where an edge ends.
enum class EndCut : unsigned char {
    Whole, ///< nothing
    Cut,   ///< cuts it along a spoke to the vertex, which stays
    Passed ///< lets a line through it, straight from there to the other such edge of the vertex, which does not stay
};

/// By end of an edge, 2 e for the end at the first vertex of edge e and 2 e + 1 for the other.
using EndCuts = std::vector<EndCut>;

/// \brief Where the truncation of level 0 of \p base cuts polygons.
///
/// They are cut where an edge ends that is a boundary, is sharp, is a seam of a channel, or has faces
/// of which one is a hole or has another of the \p labels that base faces may have.  A vertex where
/// one such edge ends, but for a dart, or none though it is sharp itself, is cut at all its edges; so
/// is one with two faces, whose polygon would have two vertices.
///
/// A line passes a vertex whose rule is that of a crease if it is cut at the two edges of that alone, and has two to
/// kMaxPassedFaces faces on each side; unless it is non-manifold, or in a channel one of the edges is a seam and the other
/// is not, or a value is sharp there, or the edges would be cut if they were not sharp, and are not both infinitely sharp.
EndCuts FindEndCuts(Hierarchy const &base, Far::ConstIndexArray labels);

/// Cuts for the value mesh of a channel of \p mesh, both of level 0.
EndCuts GetEndCutsOfChannel(Level const &mesh, EndCuts const &cuts, FVarLevel const &channel);

/// \brief Makes the refinement of FirstStep::Truncate.
///
/// A face of n sides becomes an F-face of 2n vertices, two on each edge; a vertex a V-face of those
/// beside it.  Where it is cut, the vertex makes a V-vertex and a V-face for each wedge between two
/// cuts.  Where a border passes it, its V-face is a half face, whose long edge is on the border; where a crease does,
/// its V-face is crossed by a diagonal (CrossedFace).  The vertices on edges count as F-vertices: each has the corner where a face begins to run
/// along the edge from there.  The one at the far end of a boundary has no such corner and follows
/// them all.  The last vertex of a V-face is the F-vertex of a corner at its vertex.
/// INDEXING.md has the numbering.
class TruncationRefiner {
public:
    /// Counts what the refinement of \p parent, a level 0 to which it refers, makes.
    TruncationRefiner(Level const &parent, EndCuts cuts, TagOptions tagOptions);

    LevelSizes GetSizes() const { return _sizes; }

    /// Makes \p child, whose sizes must fit 32 bits, as RefineHexagonally does.
    void Refine(bool fullTopology, Refinement &refinement, Level &child) const;

private:
    using Index = Far::Index;
    template <bool FULL>
    class Builder;

    bool isCut(Index pVert) const;
    template <typename FUNCTION>
    void forEachVFace(Index pVert, FUNCTION function) const;
    void relate(Refinement &refinement) const;
    void listCrossedFaces(Level &child) const;

    Level const &_parent;
    EndCuts const _cuts;
    TagOptions const _tagOptions;
    LevelSizes _sizes{};
    // By range, the counts that the components before the range make.
    std::vector<ChildCounts> _vertexCounts; ///< V-vertices, V-faces, and edges that pass vertices
    std::vector<ChildCounts> _edgeCounts;   ///< spokes
};

} // namespace OpenSubdivHex::FarExt::internal

#endif
