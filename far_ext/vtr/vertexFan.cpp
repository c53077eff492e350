// SPDX-License-Identifier: Apache-2.0
#include "vertexFan.h"

namespace OpenSubdivHex::FarExt::internal {

namespace {

using Far::Index;
using Sdc::Crease;

FanItem faceItem(Index face, Index corner, bool isHalf, int half) {
    return {true, face, corner, isHalf, half, Far::INDEX_INVALID, false, 0};
}

FanItem lineItem(Index neighbor, bool isLong, float sharpness) {
    return {false, Far::INDEX_INVALID, Far::INDEX_INVALID, false, -1, neighbor, isLong, sharpness};
}

FanItem edgeItem(Level const &level, Index edge, Index neighbor) {
    Index const kind = level.edgeFaces[edge][1];
    float sharpness = level.GetEdgeSharpness(edge);
    if (kind < 0) {
        sharpness = kind == kFreeBoundary ? 0 : Crease::SHARPNESS_INFINITE;
    }
    return lineItem(neighbor, kind == kSharpBoundaryB, sharpness);
}

} // namespace

void GatherFanItems(Level const &level, VertexFan const &fan, FanItems &result) {
    std::vector<FanItem> &items = result.items;
    items.clear();
    result.isClosed = fan.isClosed;
    for (Index i = fan.begin; i < fan.end; ++i) {
        Index const face = level.vertFaces[i];
        int const local = level.vertFaceLocals[i];
        Index const corner = level.GetVertexCorner(i);
        Index const next = level.GetNextCorner(face, corner);
        Index const prev = level.GetPrevCorner(face, corner);
        Index const outEdge = level.faceEdges[corner];
        Index const inEdge = level.faceEdges[prev];
        items.push_back(edgeItem(level, outEdge, level.faceVerts[next]));
        float const diagonal = level.GetDiagonalSharpness(face);
        int const diagonalEnd = Crease::IsSharp(diagonal) ? level.GetDiagonalEnd(face) : -1;
        if (diagonalEnd >= 0 && (local == kDiagonalStart || local == diagonalEnd)) {
            // Seen from the start of the diagonal, half 1 comes first, from its end half 0.
            int const half = local == kDiagonalStart ? 1 : 0;
            Index const end = corner - local + kDiagonalStart + diagonalEnd - local;
            items.push_back(faceItem(face, corner, true, half));
            items.push_back(lineItem(level.faceVerts[end], true, diagonal));
            items.push_back(faceItem(face, corner, true, 1 - half));
        } else {
            bool const isHalf = level.IsSharpBoundaryB(outEdge) || level.IsSharpBoundaryB(inEdge);
            items.push_back(faceItem(face, corner, isHalf, -1));
        }
        if (i + 1 == fan.end && !fan.isClosed) {
            items.push_back(edgeItem(level, inEdge, level.faceVerts[prev]));
        }
    }
}

} // namespace OpenSubdivHex::FarExt::internal
