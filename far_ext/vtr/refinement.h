// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_VTR_REFINEMENT_H
#define OPENSUBDIVHEX_FAR_EXT_VTR_REFINEMENT_H

#include "levelSizes.h"

#include <opensubdiv/sdc/options.h>

namespace OpenSubdivHex::FarExt::internal {

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

    /// Of an E-face, the corner where the first face of its edge begins to run along that; of a
    /// V-face, one at its vertex.  The last vertex of the face was made of it.
    Index GetFaceParentCorner(Index cFace) const {
        return GetChildVertexCorner(child->faceVerts[child->faceFirstCorner[cFace + 1] - 1]);
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

    /// Calls function(array) for all arrays of \p refinement, constant or not.
    template <typename REFINEMENT, typename FUNCTION>
    static void ForEachArray(REFINEMENT &refinement, FUNCTION const &function) {
        function(refinement.vertChildVerts);
        function(refinement.vVertexParents);
        function(refinement.edgeChildFaces);
    }

    Level const *parent = nullptr;
    Level const *child = nullptr;

    Buffer<Index> vertChildVerts; ///< by vertex; empty when V-vertices have their parent's index
    Buffer<Index> vVertexParents; ///< by V-vertex, ascending; empty likewise
    Buffer<Index> edgeChildFaces; ///< by edge; empty when all make E-faces of hexagonal numbering
};

/// \brief Begins a refinement of any scheme to a level of \p sizes: sets the counts of \p child
/// but for numVVertices, numVertsOfAnyValence and numVFaces.
void BeginRefinement(Level const &parent, LevelSizes const &sizes, bool fullTopology,
                     Refinement &refinement, Level &child);

/// \brief Ends a refinement whose child has its relations: adds the tags and, with full topology,
/// the masks of sharp vertices.
void EndRefinement(Sdc::Options sdcOptions, Refinement const &refinement, Level &child);

} // namespace OpenSubdivHex::FarExt::internal

#endif
