// SPDX-License-Identifier: Apache-2.0
#include "vertexFan.h"

namespace OpenSubdivHex::FarExt::internal {

namespace {

using Far::Index;
using Sdc::Crease;

RingItem faceItem(Index corner, bool isHalf, int half) {
    return {true, corner, isHalf, half, Far::INDEX_INVALID, false, 0};
}

RingItem edgeItem(LevelTopology const &level, Index edge, Index neighbor) {
    Index const kind = level.edgeFaces[2 * std::size_t(edge) + 1];
    float sharpness = level.GetEdgeSharpness(edge);
    if (kind < 0) {
        sharpness = kind == kFreeBoundary ? 0 : Crease::SHARPNESS_INFINITE;
    }
    bool const isLong = kind == kSharpBoundaryB;
    return {false, Far::INDEX_INVALID, false, -1, neighbor, isLong, sharpness};
}

} // namespace

Index GatherFan(LevelTopology const &level, Index vert, Index i, Fan &fan) {
    fan.items.clear();
    fan.isClosed = false;
    Index firstEdge = Far::INDEX_INVALID;
    for (; i < level.vertFirstFace[vert + 1]; ++i) {
        Index const face = level.vertFaces[i];
        Index const first = level.faceFirstCorner[face];
        int const size = level.faceFirstCorner[face + 1] - first;
        int const local = level.vertFaceLocals[i];
        Index const next = first + (local + 1) % size;
        Index const prev = first + (local + size - 1) % size;
        Index const outEdge = level.faceEdges[first + local];
        Index const inEdge = level.faceEdges[prev];
        if (firstEdge == Far::INDEX_INVALID) {
            firstEdge = outEdge;
        }
        fan.items.push_back(edgeItem(level, outEdge, level.faceVerts[next]));
        float const diagonal = level.GetDiagonalSharpness(face);
        if ((local == kDiagonalStart || local == kDiagonalEnd) && Crease::IsSharp(diagonal)) {
            // Seen from the start of the diagonal, half 1 comes first, from its end half 0.
            int const half = local == kDiagonalStart ? 1 : 0;
            Index const end = first + kDiagonalStart + kDiagonalEnd - local;
            fan.items.push_back(faceItem(first + local, true, half));
            fan.items.push_back(
                {false, Far::INDEX_INVALID, false, -1, level.faceVerts[end], true, diagonal});
            fan.items.push_back(faceItem(first + local, true, 1 - half));
        } else {
            bool const isHalf = level.IsSharpBoundaryB(outEdge) || level.IsSharpBoundaryB(inEdge);
            fan.items.push_back(faceItem(first + local, isHalf, -1));
        }
        if (level.IsBoundary(inEdge)) {
            fan.items.push_back(edgeItem(level, inEdge, level.faceVerts[prev]));
            return i + 1;
        }
        if (inEdge == firstEdge) {
            fan.isClosed = true;
            return i + 1;
        }
    }
    return i;
}

} // namespace OpenSubdivHex::FarExt::internal
