// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_VTR_REFINEMENT_H
#define OPENSUBDIVHEX_FAR_EXT_VTR_REFINEMENT_H

#include "levelSizes.h"

#include "far_ext/rules/mask.h"

#include <opensubdiv/sdc/options.h>

namespace OpenSubdivHex::FarExt::internal {

/// \brief A whole face, or one half of a hexagon that is cut from its vertex 0 to its vertex 3.
///
/// Every cell lies in one cell of the level before, and so in one face of level 0: an edge of level 0
/// runs along edges or diagonals of hexagons at every level, as its vertices persist.
struct Cell {
    Far::Index face;
    int half; ///< 0 or 1, as in kHexagonHalves; of no matter for faces that are not cut
};

/// \brief A mapping between two levels, made by any scheme: which components of the child each
/// component of the parent makes, and of which each was made.
///
/// The F-face of a face has its index, and an F-vertex that of its corner behind the V-vertices.
struct Refinement {
    using Index = Far::Index;

    /// INDEX_INVALID when no V-vertex is made of it.
    Index GetVertexChildVertex(Index v) const {
        return vertChildVerts.empty() ? v : vertChildVerts[v];
    }
    /// The inverse: the vertex that a V-vertex was made of.
    Index GetVVertexParent(Index cVert) const {
        return vVertexParents.empty() ? cVert : vVertexParents[cVert];
    }
    Index GetCornerChildVertex(Index corner) const { return child->numVVertices + corner; }
    Index GetChildVertexCorner(Index cVert) const { return cVert - child->numVVertices; }
    /// The E-face of an edge; INDEX_INVALID when it makes none.
    Index GetEdgeChildFace(Index e) const {
        return edgeChildFaces.empty() ? parent->ChildIndexing().GetEdgeChildFace(e, 0)
                                      : edgeChildFaces[e];
    }

    /// For an E-face, the corner where the first face of its edge begins to run along the edge; for a
    /// V-face, a corner at its vertex.  The last vertex of the face was made of this corner.
    Index GetFaceParentCorner(Index cFace) const {
        return GetChildVertexCorner(child->faceVerts[child->faceFirstCorner[cFace + 1] - 1]);
    }
    /// For a V-face that is crossed: the parent corner of its first vertex, which is beside half 1.
    Index GetFaceFirstParentCorner(Index cFace) const {
        return GetChildVertexCorner(child->faceVerts[child->faceFirstCorner[cFace]]);
    }
    /// The parent edge of an E-face, and the parent vertex of a V-face.
    Index GetEFaceParent(Index cFace) const {
        return parent->faceEdges[GetFaceParentCorner(cFace)];
    }
    Index GetVFaceParent(Index cFace) const {
        return parent->faceVerts[GetFaceParentCorner(cFace)];
    }
    /// The parent of an F-face; of an E-face, the first face of its edge; of a V-face, that of its
    /// last F-vertex.
    Index GetFaceParentFace(Index cFace) const {
        if (cFace < child->numFFaces) {
            return cFace;
        }
        bool const isEFace = cFace < child->numFaces - child->numVFaces;
        return isEFace ? parent->edgeFaces[GetEFaceParent(cFace)][0]
                       : parent->FindFaceOfCorner(GetFaceParentCorner(cFace));
    }

    /// \brief The cell of the parent that a cell of the child lies in.
    ///
    /// Quads of flat edges and V-faces lie in several: a quad counts to that of the first face of its
    /// edge, a V-face to that of its last F-vertex, and there to half 0 at the ends of a diagonal.  Half 1 of a
    /// V-face that is crossed counts to that of its first vertex.
    Cell GetParentCell(Cell cCell) const {
        if (cCell.face < child->numFFaces) {
            return cCell;
        }
        if (cCell.face >= child->numFaces - child->numVFaces) {
            bool const isCrossed = cCell.half == 1 && child->FindCrossedFace(cCell.face);
            Index const corner =
                isCrossed ? GetFaceFirstParentCorner(cCell.face) : GetFaceParentCorner(cCell.face);
            Index const face = parent->FindFaceOfCorner(corner);
            Index const local = corner - parent->faceFirstCorner[face];
            bool const isBesideHalf1 =
                kDiagonalStart < local && local < parent->GetDiagonalEnd(face);
            return {face, isBesideHalf1 ? 1 : 0};
        }
        Index const edge = GetEFaceParent(cCell.face);
        int const side = HasHalves(child->GetFaceSize(cCell.face)) ? cCell.half : 0;
        Index const face = parent->edgeFaces[edge][side];
        return {face, parent->GetHalfOfFaceEdge(face, parent->edgeFaceLocals[edge][side])};
    }

    /// Calls function(array) for all arrays of \p refinement, constant or not.
    template <typename REFINEMENT, typename FUNCTION>
    static void ForEachArray(REFINEMENT &refinement, FUNCTION const &function) {
        function(refinement.vertChildVerts);
        function(refinement.vVertexParents);
        function(refinement.edgeChildFaces);
    }

    Level const *parent = nullptr;
    Level const *child = nullptr;
    /// By FirstStep::Truncate: all new vertices lie on edges.  That of a corner is beside its vertex on
    /// the edge where its face begins there; those at the far ends of boundaries follow.
    bool isTruncation = false;

    Buffer<Index> vertChildVerts; ///< by vertex; empty when V-vertices have their parent's index
    Buffer<Index> vVertexParents; ///< by V-vertex, ascending; empty likewise
    Buffer<Index> edgeChildFaces; ///< by edge; empty when all make E-faces of hexagonal numbering
};

/// \brief Begins a refinement of any scheme to a level of \p sizes: sets the counts of \p child
/// but for numVVertices, numVertsOfAnyValence, numVFaces and numHexagonalSteps.
void BeginRefinement(Level const &parent, LevelSizes const &sizes, bool fullTopology,
                     Refinement &refinement, Level &child);

/// Options that determine the tags of levels.
struct TagOptions {
    Sdc::Options sdcOptions;
    FaceMask faceMask;
};

/// \brief Ends a refinement whose child has its relations: adds the tags and, with full topology,
/// the masks of sharp vertices and what has masks of its own besides.  RefinementRules make rules of them.
void EndRefinement(TagOptions options, Refinement const &refinement, Level &child);

} // namespace OpenSubdivHex::FarExt::internal

#endif
