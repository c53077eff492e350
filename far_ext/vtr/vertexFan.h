// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_VTR_VERTEX_FAN_H
#define OPENSUBDIVHEX_FAR_EXT_VTR_VERTEX_FAN_H

#include "level.h"

namespace OpenSubdivHex::FarExt::internal {

/// \brief Faces around a vertex, counter-clockwise, each joined to the next by an edge: from
/// boundary to boundary or, when closed, all around.
struct VertexFan {
    Far::Index begin; ///< positions in Level::vertFaces
    Far::Index end;
    bool isClosed;

    Far::Index GetSize() const { return end - begin; }
    /// The position \p count places on from \p position, which leads from the last to the first once at
    /// the most.
    Far::Index Advance(Far::Index position, Far::Index count) const {
        Far::Index const k = position + count;
        return k < end ? k : k - GetSize();
    }
};

/// The faces around a vertex that a V-face joins: all of a fan, or part of it.
struct VFace {
    VertexFan fan;
    Far::Index begin; ///< position in Level::vertFaces
    Far::Index count;
    bool hasVVertex;     ///< in the polygon too
    bool isHalf = false; ///< a half face, along whose long edge a border passes the vertex
    int diagonalEnd =
        0; ///< of a face that a crease which passes the vertex crosses: the faces before it; else 0

    /// The position of its face \p i.
    Far::Index GetPosition(Far::Index i) const { return fan.Advance(begin, i); }
};

/// Calls function(fan) for the fans of a vertex, in their order.
template <typename FUNCTION>
void ForEachFan(Level const &level, Far::Index vert, FUNCTION function) {
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

/// \brief The items around a vertex: its faces, and between them edges and diagonals.
struct FanItem {
    bool isFace;
    Far::Index face;     ///< of a face
    Far::Index corner;   ///< of a face: where the vertex is in it
    bool isHalf;         ///< a half face, or one side of a sharp diagonal
    int half;            ///< of a hexagon with a sharp diagonal, as in kHexagonHalves; else -1
    Far::Index neighbor; ///< at the other end of an edge or diagonal
    bool isLong;         ///< a diagonal or a B boundary
    float sharpness;     ///< of an edge or diagonal; 0 for smooth ones and free boundaries
};

/// \brief The edges and faces of a fan in turn: from boundary to boundary or, when closed, from the
/// edge before the first face to the last face.
struct FanItems {
    std::vector<FanItem> items;
    bool isClosed;
};

OPENSUBDIVHEX_API void GatherFanItems(Level const &level, VertexFan const &fan, FanItems &result);

/// Calls function(items) for the fans of a vertex, in their order; \p items keeps its memory.
template <typename FUNCTION>
void ForEachFanItems(Level const &level, Far::Index vert, FanItems &items, FUNCTION function) {
    ForEachFan(level, vert, [&](VertexFan const &fan) {
        GatherFanItems(level, fan, items);
        function(items);
    });
}

/// Overload with its own items.
template <typename FUNCTION>
void ForEachFanItems(Level const &level, Far::Index vert, FUNCTION function) {
    FanItems items;
    ForEachFanItems(level, vert, items, function);
}

} // namespace OpenSubdivHex::FarExt::internal

#endif
