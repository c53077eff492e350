// SPDX-License-Identifier: Apache-2.0
#include "refinementMask.h"

#include <algorithm>

namespace OpenSubdivHex::FarExt::internal {

RefinementMask::RefinementMask(TopologyLevel const &pLevel, SchemeOptions schemeOptions,
                               Interpolation interpolation)
    : _level(pLevel), _faceMask(schemeOptions.faceMask), _interpolation(interpolation) {
    SchemeType const scheme = schemeOptions.GetSchemeOfLevel(pLevel.GetDepth() + 1);
    LevelTopology const &topology = pLevel.GetTopology();
    _hasFeatures = scheme == SchemeType::Hexagonal && topology.HasFeatures();
    _hasSharpVertices = interpolation == Interpolation::Vertex && !topology.sharpVerts.empty();
    for (int numFaces = 0; numFaces < kNumKept; ++numFaces) {
        _plainVertexMasks[numFaces] = ComputeVertexVertexMask(interpolation, numFaces);
    }

    _faceMasks.resize(topology.faceSizes.empty() ? 0 : topology.faceSizes.back() + 1);
    for (Index size : topology.faceSizes) {
        std::vector<double> &mask = _faceMasks[size];
        mask.resize(2 * std::size_t(size));
        if (scheme == SchemeType::TriHex) {
            ComputeTriHexMask(size, mask.data());
        } else {
            ComputeFaceVertexMask(_faceMask, interpolation, size, mask.data());
        }
        std::copy_n(mask.begin(), size, mask.begin() + size);
    }

    constexpr int kHexagon = HexIndexing::kNumEFaceCorners;
    constexpr int kTrapezoid = HexIndexing::kNumBoundaryEFaceCorners;
    ComputeHalfFaceVertexMask(_faceMask, interpolation, &_halfFaceWeights[0][0]);
    // Of a hexagon cut by its diagonal 0-3, each half follows the mask of a half face V, W, Q, P:
    // V and W are the ends of the diagonal, Q and P the two vertices between them.
    std::fill_n(&_diagonalWeights[0][0], kHexagon * kHexagon, 0.0);
    for (auto const &half : kHexagonHalves) {
        for (int i = 0; i < kTrapezoid; ++i) {
            for (int j = 0; j < kTrapezoid; ++j) {
                _diagonalWeights[half[i]][half[j]] = _halfFaceWeights[i][j];
            }
        }
    }
}

double const *RefinementMask::GetFaceVertexWeights(Index face, int corner,
                                                   std::vector<double> &scratch) const {
    return _hasFeatures ? featureWeights(face, corner, scratch)
                        : smoothWeights(_level.GetFaceVertices(face).size(), corner);
}

bool RefinementMask::hasFeatures(Index face) const {
    LevelTopology const &topology = _level.GetTopology();
    if (_level.IsFaceHalf(face)) {
        return true;
    }
    if (_interpolation == Interpolation::Varying) {
        return false;
    }
    return Sdc::Crease::IsSharp(_level.GetFaceDiagonalSharpness(face)) ||
           !topology
                .GetSectorCorners(topology.faceFirstCorner[face],
                                  topology.faceFirstCorner[face + 1])
                .empty();
}

double const *RefinementMask::featureWeights(Index face, int corner,
                                             std::vector<double> &scratch) const {
    int const size = _level.GetFaceVertices(face).size();
    if (_level.IsFaceHalf(face)) {
        return _halfFaceWeights[corner];
    }
    double const *smooth = smoothWeights(size, corner);
    if (_interpolation == Interpolation::Varying) {
        return smooth;
    }
    double const sharp = std::min(1.0f, _level.GetFaceDiagonalSharpness(face));
    double towards = 0;
    Index const levelCorner = _level.GetFaceFirstCorner(face) + corner;
    for (SectorCorner const &sector :
         _level.GetTopology().GetSectorCorners(levelCorner, levelCorner + 1)) {
        towards += sector.weight * (1 - ComputeSectorShrink(_faceMask, sector.sectorSize));
    }
    scratch.assign(smooth, smooth + size);
    for (double &weight : scratch) {
        weight *= 1 - sharp - towards;
    }
    scratch[corner] += towards;
    for (int j = 0; j < size && sharp > 0; ++j) {
        scratch[j] += sharp * _diagonalWeights[corner][j];
    }
    return scratch.data();
}

auto RefinementMask::sharpMask(SharpVertex const &sharp) -> VertexMask {
    VertexMask mask = {sharp.vertexWeight, sharp.faceWeight, 0, {}, {}};
    for (int i = 0; i < 2; ++i) {
        if (sharp.neighborWeights[i] > 0) {
            mask.neighbors[mask.numNeighbors] = sharp.neighbors[i];
            mask.neighborWeights[mask.numNeighbors++] = sharp.neighborWeights[i];
        }
    }
    return mask;
}

std::vector<Far::Index> RefinementMask::FindFeatureFaces() const {
    LevelTopology const &topology = _level.GetTopology();
    if (!_hasFeatures) {
        return {};
    }
    std::vector<Index> faces(topology.halfFaces.begin(), topology.halfFaces.end());
    if (_interpolation == Interpolation::Varying) {
        return faces;
    }
    for (std::size_t face = 0; face < topology.diagonalSharpness.size(); ++face) {
        if (Sdc::Crease::IsSharp(topology.diagonalSharpness[face])) {
            faces.push_back(Index(face));
        }
    }
    for (SectorCorner const &sector : topology.sectorCorners) {
        Index const *const next = std::upper_bound(topology.faceFirstCorner.begin(),
                                                   topology.faceFirstCorner.end(), sector.corner);
        faces.push_back(Index(next - topology.faceFirstCorner.begin()) - 1);
    }
    std::sort(faces.begin(), faces.end());
    faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
    return faces;
}

std::vector<Far::Index> RefinementMask::FindFeatureVertices() const {
    std::vector<Index> verts;
    if (_interpolation == Interpolation::Vertex) {
        for (SharpVertex const &sharp : _level.GetTopology().sharpVerts) {
            verts.push_back(sharp.vert);
        }
    }
    return verts;
}

} // namespace OpenSubdivHex::FarExt::internal
