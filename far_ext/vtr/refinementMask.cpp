// SPDX-License-Identifier: Apache-2.0
#include "refinementMask.h"

#include "indexSet.h"

#include <algorithm>

namespace OpenSubdivHex::FarExt::internal {

RefinementMask::RefinementMask(Level const &parent, HexSchemeOptions schemeOptions,
                               Interpolation interpolation)
    : _level(parent), _faceMask(schemeOptions.faceMask), _interpolation(interpolation) {
    StepType const step = schemeOptions.GetStepOfLevel(parent.depth + 1);
    bool const isHexagonal = step == StepType::Hexagonal;
    _hasSharpFaces = isHexagonal && _level.HasSharpFaces();
    _hasIrregular =
        isHexagonal && interpolation == Interpolation::Vertex && !_level.irregularCorners.empty();
    _hasSharpVertices = interpolation == Interpolation::Vertex && !_level.sharpVerts.empty();
    for (int numFaces = 0; numFaces < kNumKept; ++numFaces) {
        _plainVertexMasks[numFaces] = ComputeVertexVertexMask(interpolation, numFaces);
    }

    _faceMasks.resize(_level.faceSizes.empty() ? 0 : _level.faceSizes.back() + 1);
    for (Index size : _level.faceSizes) {
        std::vector<double> &mask = _faceMasks[size];
        mask.resize(2 * std::size_t(size));
        if (step == StepType::TriHex) {
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
    if (_hasIrregular) {
        findIrregularMasks();
    }
}

void RefinementMask::findIrregularMasks() {
    _areIrregular.assign(std::size_t(_level.numFaces), false);
    for (IrregularCorner const &irregular : _level.irregularCorners) {
        _areIrregular[_level.FindFaceOfCorner(irregular.corner)] = true;
        if (irregular.numFaces == 0) {
            ComputeQuadNeighborMask(_level.numHexagonalSteps, _quadNeighborWeights);
            continue;
        }
        auto const place =
            std::lower_bound(_irregularMasks.begin(), _irregularMasks.end(), irregular.numFaces,
                             [](auto const &mask, Index size) { return mask.first < size; });
        if (place == _irregularMasks.end() || place->first != irregular.numFaces) {
            _irregularMasks.insert(
                place, {irregular.numFaces,
                        ComputeIrregularVertexMask(irregular.numFaces, _level.numHexagonalSteps)});
        }
    }
}

IrregularVertexMask const &RefinementMask::getIrregularMask(Index numFaces) const {
    return std::lower_bound(_irregularMasks.begin(), _irregularMasks.end(), numFaces,
                            [](auto const &mask, Index size) { return mask.first < size; })
        ->second;
}

double const *RefinementMask::GetFaceVertexWeights(Index face, int corner,
                                                   std::vector<double> &scratch) const {
    return IsFacePlain(face) ? smoothWeights(_level.GetFaceSize(face), corner)
                             : featureWeights(face, corner, scratch);
}

bool RefinementMask::isSharp(Index face) const {
    if (_level.IsHalfFace(face)) {
        return true;
    }
    if (_interpolation == Interpolation::Varying) {
        return false;
    }
    return Sdc::Crease::IsSharp(_level.GetDiagonalSharpness(face)) ||
           !_level.GetSectorCorners(_level.faceFirstCorner[face], _level.faceFirstCorner[face + 1])
                .empty();
}

double const *RefinementMask::featureWeights(Index face, int corner,
                                             std::vector<double> &scratch) const {
    int const size = _level.GetFaceSize(face);
    if (_level.IsHalfFace(face)) {
        return _halfFaceWeights[corner];
    }
    double const *smooth = smoothWeights(size, corner);
    if (_interpolation == Interpolation::Varying) {
        return smooth;
    }
    scratch.assign(smooth, smooth + size);
    if (_hasSharpFaces) {
        addSharpWeights(face, corner, scratch);
    }
    if (_hasIrregular) {
        addIrregularWeights(face, corner, scratch);
    }
    return scratch.data();
}

void RefinementMask::addSharpWeights(Index face, int corner, std::vector<double> &weights) const {
    double const sharp = std::min(1.0f, _level.GetDiagonalSharpness(face));
    double towards = 0;
    Index const levelCorner = _level.faceFirstCorner[face] + corner;
    for (SectorCorner const &sector : _level.GetSectorCorners(levelCorner, levelCorner + 1)) {
        towards += sector.weight * (1 - ComputeSectorShrink(_faceMask, sector.sectorSize));
    }
    for (double &weight : weights) {
        weight *= 1 - sharp - towards;
    }
    weights[std::size_t(corner)] += towards;
    for (std::size_t j = 0; j < weights.size() && sharp > 0; ++j) {
        weights[j] += sharp * _diagonalWeights[corner][j];
    }
}

void RefinementMask::addIrregularWeights(Index face, int corner,
                                         std::vector<double> &weights) const {
    constexpr int kHexagon = HexIndexing::kNumEFaceCorners;
    Index const levelCorner = _level.faceFirstCorner[face] + corner;
    for (IrregularCorner const &irregular :
         _level.GetIrregularCorners(levelCorner, levelCorner + 1)) {
        double const *mask = _quadNeighborWeights;
        if (irregular.numFaces > 0) {
            IrregularVertexMask const &masks = getIrregularMask(irregular.numFaces);
            mask = irregular.kind == IrregularCorner::kAtVertex ? masks.atVertex : masks.atNeighbor;
        }
        bool const isBackwards = irregular.kind == IrregularCorner::kBeforeVertex ||
                                 irregular.kind == IrregularCorner::kBehindQuad;
        for (int j = 0; j < kHexagon; ++j) {
            int const place = (corner + (isBackwards ? kHexagon - j : j)) % kHexagon;
            double &weight = weights[std::size_t(place)];
            weight += irregular.weight * (mask[j] - weight);
        }
    }
}

auto RefinementMask::irregularMask(IrregularVertex const &irregular, VertexMask mask) const
    -> VertexMask {
    Index const numFaces = _level.GetNumVertexFaces(irregular.vert);
    VertexVertexMask const plain = GetPlainVertexMask(numFaces);
    VertexVertexMask const full = getIrregularMask(numFaces).vertex;
    // Rules of sharp vertices do not depend on the faces: the smooth one has the share that these
    // have.
    double const share = irregular.weight * mask.faceWeight / plain.faceWeight;
    mask.faceWeight += share * (full.faceWeight - plain.faceWeight);
    mask.weights[mask.numSources - 1] += share * (full.vertexWeight - plain.vertexWeight);
    return mask;
}

auto RefinementMask::sharpMask(SharpVertex const &sharp) -> VertexMask {
    VertexMask mask = {sharp.faceWeight, 0, {}, {}};
    auto const add = [&mask](Index source, double weight) {
        mask.sources[mask.numSources] = source;
        mask.weights[mask.numSources++] = weight;
    };
    for (int i = 0; i < 2; ++i) {
        if (sharp.neighborWeights[i] > 0) {
            add(sharp.neighbors[i], sharp.neighborWeights[i]);
        }
    }
    add(sharp.vert, sharp.vertexWeight);
    return mask;
}

std::vector<Far::Index> RefinementMask::FindSharpFaces() const {
    if (!_hasSharpFaces) {
        return {};
    }
    std::vector<Index> faces(_level.halfFaces.begin(), _level.halfFaces.end());
    if (_interpolation == Interpolation::Varying) {
        return faces;
    }
    for (std::size_t face = 0; face < _level.diagonalSharpness.size(); ++face) {
        if (Sdc::Crease::IsSharp(_level.diagonalSharpness[face])) {
            faces.push_back(Index(face));
        }
    }
    for (SectorCorner const &sector : _level.sectorCorners) {
        faces.push_back(_level.FindFaceOfCorner(sector.corner));
    }
    SortUnique(faces);
    return faces;
}

std::vector<Far::Index> RefinementMask::FindFeatureVertices() const {
    std::vector<Index> verts;
    if (_interpolation == Interpolation::Vertex) {
        for (SharpVertex const &sharp : _level.sharpVerts) {
            verts.push_back(sharp.vert);
        }
    }
    if (_hasIrregular) {
        for (IrregularVertex const &irregular : _level.irregularVerts) {
            verts.push_back(irregular.vert);
        }
        SortUnique(verts);
    }
    return verts;
}

} // namespace OpenSubdivHex::FarExt::internal
