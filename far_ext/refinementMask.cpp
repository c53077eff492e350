// SPDX-License-Identifier: Apache-2.0
#include "refinementMask.h"

#include <algorithm>
#include <set>

namespace OpenSubdivHex::FarExt::internal {

template <typename REAL>
RefinementMask<REAL>::RefinementMask(TopologyLevel const &baseLevel, FaceMask faceMask,
                                     Interpolation interpolation)
    : _interpolation(interpolation) {
    // F-faces keep the size of their parent, so all sizes are those of the base and of E-faces.
    constexpr int kHexagon = HexIndexing::kNumEFaceCorners;
    constexpr int kTrapezoid = HexIndexing::kNumBoundaryEFaceCorners;
    std::set<int> sizes = {kHexagon, kTrapezoid};
    for (Index face = 0; face < baseLevel.GetNumFaces(); ++face) {
        sizes.insert(baseLevel.GetFaceVertices(face).size());
    }
    for (int size : sizes) {
        std::vector<REAL> &mask = _faceMasks[size];
        mask.resize(2 * std::size_t(size));
        ComputeFaceVertexMask(faceMask, interpolation, size, mask.data());
        std::copy_n(mask.begin(), size, mask.begin() + size);
    }

    ComputeHalfFaceVertexMask(faceMask, interpolation, &_halfFaceWeights[0][0]);
    // Of a hexagon cut by its diagonal 0-3, each half follows the mask of a half face V, W, Q, P:
    // V and W are the ends of the diagonal, Q and P the two vertices between them.
    std::fill_n(&_diagonalWeights[0][0], kHexagon * kHexagon, REAL(0));
    int const halves[2][kTrapezoid] = {{3, 0, 1, 2}, {0, 3, 4, 5}};
    for (auto const &half : halves) {
        for (int i = 0; i < kTrapezoid; ++i) {
            for (int j = 0; j < kTrapezoid; ++j) {
                _diagonalWeights[half[i]][half[j]] = _halfFaceWeights[i][j];
            }
        }
    }
}

template <typename REAL>
REAL const *
RefinementMask<REAL>::GetFaceVertexWeights(TopologyLevel const &level, Index face, int corner,
                                           REAL scratch[HexIndexing::kNumEFaceCorners]) const {
    int const size = level.GetFaceVertices(face).size();
    if (level.IsFaceHalf(face)) {
        return _halfFaceWeights[corner];
    }
    REAL const *smooth = smoothWeights(size, corner);
    float const sharpness = level.GetFaceDiagonalSharpness(face);
    if (_interpolation == Interpolation::Varying || !Sdc::Crease::IsSharp(sharpness)) {
        return smooth;
    }
    REAL const *sharp = _diagonalWeights[corner];
    if (sharpness >= 1) {
        return sharp;
    }
    REAL const weight = REAL(sharpness);
    for (int j = 0; j < size; ++j) {
        scratch[j] = weight * sharp[j] + (1 - weight) * smooth[j];
    }
    return scratch;
}

template <typename REAL>
auto RefinementMask<REAL>::GetVertexMask(TopologyLevel const &level, Index vert) const
    -> VertexMask {
    SharpVertex const *sharp = _interpolation == Interpolation::Vertex
                                   ? level.GetTopology().FindSharpVertex(vert)
                                   : nullptr;
    if (!sharp) {
        VertexVertexMask<REAL> const mask =
            ComputeVertexVertexMask<REAL>(_interpolation, level.GetVertexFaces(vert).size());
        return {mask.vertexWeight, mask.faceWeight, 0, {}, {}};
    }
    VertexMask mask = {REAL(sharp->vertexWeight), REAL(sharp->faceWeight), 0, {}, {}};
    for (int i = 0; i < 2; ++i) {
        if (sharp->neighborWeights[i] > 0) {
            mask.neighbors[mask.numNeighbors] = sharp->neighbors[i];
            mask.neighborWeights[mask.numNeighbors++] = REAL(sharp->neighborWeights[i]);
        }
    }
    return mask;
}

template class RefinementMask<float>;
template class RefinementMask<double>;

} // namespace OpenSubdivHex::FarExt::internal
