// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_LIMIT_FACE_DESCENDANTS_H
#define OPENSUBDIVHEX_FAR_EXT_LIMIT_FACE_DESCENDANTS_H

#include "far_ext/vtr/hierarchy.h"

namespace OpenSubdivHex::FarExt::internal {

/// As ForEachDescendant, for what is made in half a hexagon, of one side of its parent edge.
template <typename FUNCTION>
void ForEachDescendantOfHalf(MeshLevels const &mesh, int level, int last, Far::Index face, int side,
                             FUNCTION &function) {
    using Index = Far::Index;
    EFaceSide const &places = side == 0 ? kEFaceSideA : kEFaceSideB;
    for (int i = level; i < last; ++i) {
        Level const &ofFace = mesh.levels[std::size_t(i)];
        Refinement const &refinement = mesh.refinements[std::size_t(i)];
        Index const first = ofFace.faceFirstCorner[face];
        for (Index const local :
             {places.startVertex, places.endVertex, places.startFVertex, places.endFVertex}) {
            function(refinement.GetCornerChildVertex(first + local));
        }
        for (Index const local : {places.startSpoke, places.fFaceEdge, places.endSpoke}) {
            Index const edge = ofFace.faceEdges[first + local];
            int const sideOfEdge = ofFace.GetSideCorner(edge, 0) == first + local ? 0 : 1;
            ForEachDescendantOfHalf(mesh, i + 1, last, refinement.GetEdgeChildFace(edge),
                                    sideOfEdge, function);
        }
    }
}

/// \brief Calls function(vert) for the vertices of levels \p level + 1 ... \p last that lie in a face of
/// \p level, by their index in the last one, in an order that begins at the face's first corner; for some
/// twice.  All steps are hexagonal, and the face has no border.
template <typename FUNCTION>
void ForEachDescendant(MeshLevels const &mesh, int level, int last, Far::Index face,
                       FUNCTION function) {
    using Index = Far::Index;
    for (int i = level; i < last; ++i) {
        Level const &ofFace = mesh.levels[std::size_t(i)];
        Refinement const &refinement = mesh.refinements[std::size_t(i)];
        Index const first = ofFace.faceFirstCorner[face];
        for (Index corner = first; corner < ofFace.faceFirstCorner[face + 1]; ++corner) {
            function(refinement.GetCornerChildVertex(corner));
            Index const edge = ofFace.faceEdges[corner];
            int const side = ofFace.GetSideCorner(edge, 0) == corner ? 0 : 1;
            ForEachDescendantOfHalf(mesh, i + 1, last, refinement.GetEdgeChildFace(edge), side,
                                    function);
        }
    }
}

} // namespace OpenSubdivHex::FarExt::internal

#endif
