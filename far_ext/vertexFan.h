// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_VERTEX_FAN_H
#define OPENSUBDIVHEX_FAR_EXT_VERTEX_FAN_H

#include "levelTopology.h"

namespace OpenSubdivHex::FarExt::internal {

/// \brief Faces around a vertex, counter-clockwise, each joined to the next by an edge: from
/// boundary to boundary or, when closed, all around.
struct VertexFan {
    Far::Index begin; ///< positions in LevelTopology::vertFaces
    Far::Index end;
    bool isClosed;
};

/// Calls function(fan) for the fans of a vertex, in their order.
template <typename FUNCTION>
void ForEachFan(LevelTopology const &level, Far::Index vert, FUNCTION function) {
    Far::Index const end = level.vertFirstFace[vert + 1];
    Far::Index i = level.vertFirstFace[vert];
    while (i < end) {
        VertexFan fan = {i, end, false};
        Far::Index const firstEdge = level.faceEdges[level.GetVertexCorner(i)];
        while (i < end) {
            Far::Index const corner = level.GetVertexCorner(i);
            Far::Index const inEdge =
                level.faceEdges[level.GetPrevCorner(level.vertFaces[i], corner)];
            ++i;
            fan.isClosed = inEdge == firstEdge && !level.IsBoundary(inEdge);
            if (fan.isClosed || level.IsBoundary(inEdge)) {
                break;
            }
        }
        fan.end = i;
        function(fan);
    }
}

} // namespace OpenSubdivHex::FarExt::internal

#endif
