// SPDX-License-Identifier: Apache-2.0
#include "irregularFeatures.h"

#include <opensubdiv/sdc/crease.h>

#include <algorithm>

namespace OpenSubdivHex::FarExt::internal {

namespace {

using Far::Index;

constexpr int kHexagon = HexIndexing::kNumEFaceCorners;
constexpr int kQuad = 4;

// The weight of a smooth mask where something is as sharp as this: the rest is as without it.
float smoothPart(float sharpness) { return std::max(0.0f, 1 - sharpness); }

bool isWholeEFace(Level const &level, Index face) {
    return face >= level.numFFaces && face < level.numFaces - level.numVFaces &&
           level.GetFaceSize(face) == kHexagon;
}

// The share of the masks of a vertex inside the mesh all of whose faces are E-faces of six sides;
// 0 of others.
float findWeight(Level const &level, Index vert) {
    float sharpness = level.GetVertexSharpness(vert);
    for (Index k = level.vertFirstFace[vert]; k < level.vertFirstFace[vert + 1]; ++k) {
        Index const face = level.vertFaces[k];
        Index const corner = level.GetVertexCorner(k);
        Index const edge = level.faceEdges[corner];
        Index const before = level.faceEdges[level.GetPrevCorner(face, corner)];
        if (!isWholeEFace(level, face) || level.IsBoundary(edge) || level.IsBoundary(before)) {
            return 0;
        }
        sharpness =
            std::max({sharpness, level.GetDiagonalSharpness(face), level.GetEdgeSharpness(edge)});
    }
    return level.IsNonManifold(vert) ? 0 : smoothPart(sharpness);
}

void addVertex(Index vert, Level &level) {
    float const weight = findWeight(level, vert);
    if (weight == 0) {
        return;
    }
    level.irregularVerts.push_back({vert, weight});
    Index const numFaces = level.GetNumVertexFaces(vert);
    for (Index k = level.vertFirstFace[vert]; k < level.vertFirstFace[vert + 1]; ++k) {
        Index const face = level.vertFaces[k];
        Index const corner = level.GetVertexCorner(k);
        level.irregularCorners.insert(
            level.irregularCorners.end(),
            {{corner, numFaces, weight, IrregularCorner::kAtVertex},
             {level.GetNextCorner(face, corner), numFaces, weight, IrregularCorner::kBehindVertex},
             {level.GetPrevCorner(face, corner), numFaces, weight,
              IrregularCorner::kBeforeVertex}});
    }
}

// The E-faces around an F-face of four sides.
void addQuad(Index quad, Level &level) {
    for (Index corner = level.faceFirstCorner[quad]; corner < level.faceFirstCorner[quad + 1];
         ++corner) {
        Index const edge = level.faceEdges[corner];
        int const otherSide = level.edgeFaces[edge][0] == quad ? 1 : 0;
        Index const face = level.edgeFaces[edge][otherSide];
        if (face < 0 || !isWholeEFace(level, face)) {
            continue;
        }
        float const weight = smoothPart(level.GetDiagonalSharpness(face));
        if (weight > 0) {
            Index const start = level.GetSideCorner(edge, otherSide);
            level.irregularCorners.insert(
                level.irregularCorners.end(),
                {{start, 0, weight, IrregularCorner::kAlongQuad},
                 {level.GetNextCorner(face, start), 0, weight, IrregularCorner::kBehindQuad}});
        }
    }
}

} // namespace

void FindIrregularFeatures(FaceMask faceMask, Level &level) {
    level.irregularVerts.clear();
    level.irregularCorners.clear();
    if (faceMask != FaceMask::Smooth || level.numHexagonalSteps == 0 || !level.hasFullTopology) {
        return;
    }
    // Quads come first: beside one, its masks are taken, and not those of a vertex.
    double weights[kHexagon];
    if (ComputeQuadNeighborMask(level.numHexagonalSteps, weights)) {
        for (Index face = 0; face < level.numFFaces; ++face) {
            if (level.GetFaceSize(face) == kQuad && !level.IsHalfFace(face)) {
                addQuad(face, level);
            }
        }
    }
    Index const end = std::min(level.numVertsOfAnyValence, level.numVVertices);
    for (Index vert = 0; vert < end; ++vert) {
        if (level.GetNumVertexFaces(vert) >= kMinIrregularFaces) {
            addVertex(vert, level);
        }
    }
    std::vector<IrregularCorner> &corners = level.irregularCorners;
    std::stable_sort(
        corners.begin(), corners.end(),
        [](IrregularCorner const &a, IrregularCorner const &b) { return a.corner < b.corner; });
    corners.erase(std::unique(corners.begin(), corners.end(),
                              [](IrregularCorner const &a, IrregularCorner const &b) {
                                  return a.corner == b.corner;
                              }),
                  corners.end());
}

} // namespace OpenSubdivHex::FarExt::internal
