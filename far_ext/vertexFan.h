// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_VERTEX_FAN_H
#define OPENSUBDIVHEX_FAR_EXT_VERTEX_FAN_H

#include "levelTopology.h"

namespace OpenSubdivHex::FarExt::internal {

/// \brief What is met on the way around a vertex: its faces, and between them edges and diagonals.
struct RingItem {
    bool isFace;
    Far::Index corner;   ///< of a face: where the vertex is in it
    bool isHalf;         ///< a half face, or one side of a sharp diagonal
    int half;            ///< of a hexagon with a sharp diagonal, as in kHexagonHalves; else -1
    Far::Index neighbor; ///< at the other end of an edge or diagonal
    bool isLong;         ///< a diagonal or a B boundary
    float sharpness;     ///< of an edge or diagonal; 0 for smooth ones and free boundaries
};

/// \brief The faces around a vertex that are joined by edges, counter-clockwise: from boundary to
/// boundary or, when closed, all around, from the edge before the first face to the last face.
struct Fan {
    std::vector<RingItem> items;
    bool isClosed;
};

/// The fan that begins with the face at position \p i of the vertex's faces; returns where the next
/// one begins.
Far::Index GatherFan(LevelTopology const &level, Far::Index vert, Far::Index i, Fan &fan);

/// Calls function(fan) for the fans of a vertex.
template <typename FUNCTION>
void ForEachFan(LevelTopology const &level, Far::Index vert, FUNCTION function) {
    Fan fan;
    for (Far::Index i = level.vertFirstFace[vert]; i < level.vertFirstFace[vert + 1];) {
        i = GatherFan(level, vert, i, fan);
        function(fan);
    }
}

} // namespace OpenSubdivHex::FarExt::internal

#endif
