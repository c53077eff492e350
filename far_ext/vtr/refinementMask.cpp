// SPDX-License-Identifier: Apache-2.0
#include "refinementMask.h"

#include "indexSet.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <unordered_map>

namespace OpenSubdivHex::FarExt::internal {

RefinementMask::RefinementMask(Level const &parent, HexSchemeOptions schemeOptions,
                               Interpolation interpolation)
    : _level(parent), _faceMask(schemeOptions.faceMask), _interpolation(interpolation),
      _quadMask(ComputeQuadMask(parent.numHexagonalSteps)) {
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
        } else if (isHexagonal && _faceMask == FaceMask::Smooth && size == kQuadSize &&
                   interpolation == Interpolation::Vertex) {
            std::copy_n(_quadMask.inQuad, kQuadSize, mask.data());
        } else {
            ComputeFaceVertexMask(_faceMask, interpolation, size, mask.data());
        }
        std::copy_n(mask.begin(), size, mask.begin() + size);
    }

    constexpr int kTrapezoid = HexIndexing::kNumBoundaryEFaceCorners;
    ComputeHalfFaceVertexMask(_faceMask, interpolation, &_halfFaceWeights[0][0]);
    // Of a hexagon cut by its diagonal 0-3, each half follows the mask of a half face V, W, Q, P:
    // V and W are the ends of the diagonal, Q and P the two vertices between them.
    std::fill_n(&_diagonalWeights[0][0], kHexagonSize * kHexagonSize, 0.0);
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

// The masks first, then the faces, from corner to corner.
void RefinementMask::findIrregularMasks() {
    Index last = 0; // most are of the same size
    for (IrregularCorner const &irregular : _level.irregularCorners) {
        if (irregular.numFaces > 0 && irregular.numFaces != last) {
            last = irregular.numFaces;
            auto const place = findMask(last);
            if (place == _irregularMasks.end() || place->first != last) {
                MasksByFacesAround masks;
                for (int around = 0; around < kNumFacesAround; ++around) {
                    masks[std::size_t(around)] = ComputeIrregularVertexMask(
                        last, _level.numHexagonalSteps, FacesAround(around));
                }
                _irregularMasks.insert(place, {last, masks});
            }
        }
    }
    findIrregularTypes();
}

// The irregular corners of a hexagon, which tell its type.
struct RefinementMask::IrregularCornersOfFace {
    struct Hash {
        std::size_t operator()(IrregularCornersOfFace const &face) const {
            constexpr std::uint64_t kFactor = 0x9e3779b97f4a7c15u; // of Fibonacci hashing
            std::uint64_t hash = 0;
            for (IrregularCorner const &corner : face) {
                std::uint32_t weight = 0;
                std::memcpy(&weight, &corner.weight, sizeof(weight));
                for (std::uint64_t const number :
                     {std::uint64_t(weight) << 32 | std::uint32_t(corner.numFaces),
                      std::uint64_t(corner.corner - face.firstCorner) << 32 |
                          std::uint64_t(corner.kind) << 16 | std::uint64_t(corner.facesAround)}) {
                    hash = (hash ^ number) * kFactor;
                    hash ^= hash >> 32;
                }
            }
            return std::size_t(hash);
        }
    };

    IrregularCorner const *begin() const { return first; }
    IrregularCorner const *end() const { return last; }
    bool operator==(IrregularCornersOfFace const &other) const {
        return std::equal(first, last, other.first, other.last,
                          [&](IrregularCorner const &x, IrregularCorner const &y) {
                              return x.corner - firstCorner == y.corner - other.firstCorner &&
                                     x.numFaces == y.numFaces && x.weight == y.weight &&
                                     x.kind == y.kind && x.facesAround == y.facesAround;
                          });
    }

    Index firstCorner;
    IrregularCorner const *first;
    IrregularCorner const *last; ///< behind them
};

// Faces that follow one another are mostly of one type.
void RefinementMask::findIrregularTypes() {
    _irregularTypes.assign(std::size_t(_level.numFaces), kPlainType);
    std::unordered_map<IrregularCornersOfFace, int, IrregularCornersOfFace::Hash> types;
    IrregularCornersOfFace before = {};
    int type = kPlainType;
    IrregularCorner const *const end =
        _level.irregularCorners.data() + _level.irregularCorners.size();
    for (IrregularCorner const *next = _level.irregularCorners.data(); next < end;) {
        Index const face = _level.FindFaceOfCorner(next->corner);
        Index const firstCorner = _level.faceFirstCorner[face];
        IrregularCornersOfFace corners = {firstCorner, next, next + 1};
        while (corners.last < end && corners.last->corner < firstCorner + kHexagonSize) {
            ++corners.last;
        }
        next = corners.last;
        if (!(corners == before)) {
            auto const found = types.try_emplace(corners, int(_irregularWeights.size()));
            type = found.first->second;
            if (found.second) {
                addIrregularType(corners);
            }
        }
        before = corners;
        _irregularTypes[std::size_t(face)] = type;
        _irregularFaces.push_back({face, type});
    }
}

void RefinementMask::addIrregularType(IrregularCornersOfFace const &corners) {
    IrregularFaceWeights &type = _irregularWeights.emplace_back();
    for (int i = 0; i < kHexagonSize; ++i) {
        std::copy_n(smoothWeights(kHexagonSize, i), kHexagonSize, type.weights[i]);
        type.areIrregular[i] = false;
    }
    for (IrregularCorner const &corner : corners) {
        int const i = corner.corner - corners.firstCorner;
        type.areIrregular[i] = true;
        addIrregularWeights(corner, i, type.weights[i]);
    }
}

auto RefinementMask::findMask(Index numFaces) const -> IrregularMasks::const_iterator {
    return std::lower_bound(_irregularMasks.begin(), _irregularMasks.end(), numFaces,
                            [](auto const &mask, Index size) { return mask.first < size; });
}

double const *RefinementMask::GetFaceVertexWeights(Index face, int corner,
                                                   std::vector<double> &scratch) const {
    if (_hasSharpFaces && isSharp(face)) {
        return sharpWeights(face, corner, scratch);
    }
    return IsIrregular(face) ? _irregularWeights[std::size_t(getType(face))].weights[corner]
                             : smoothWeights(_level.GetFaceSize(face), corner);
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

double const *RefinementMask::sharpWeights(Index face, int corner,
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
    addSharpWeights(face, corner, scratch);
    if (_hasIrregular) {
        Index const levelCorner = _level.faceFirstCorner[face] + corner;
        for (IrregularCorner const &irregular :
             _level.GetIrregularCorners(levelCorner, levelCorner + 1)) {
            addIrregularWeights(irregular, corner, scratch.data());
        }
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

// The mask of a corner, and whether its weights go around the face backwards.
auto RefinementMask::findCornerMask(IrregularCorner const &irregular) const -> CornerMask {
    auto const getVertexMask = [&]() -> IrregularVertexMask const & {
        return getIrregularMask(irregular.numFaces, irregular.facesAround);
    };
    switch (irregular.kind) {
    case IrregularCorner::kAtVertex:
        return {getVertexMask().atVertex, false};
    case IrregularCorner::kBehindVertex:
        return {getVertexMask().atNeighbor, false};
    case IrregularCorner::kBeforeVertex:
        return {getVertexMask().atNeighbor, true};
    case IrregularCorner::kAlongQuad:
        return {_quadMask.beside[0], false};
    case IrregularCorner::kBehindQuad:
        return {_quadMask.beside[0], true};
    case IrregularCorner::kOneBehindQuad:
        return {_quadMask.beside[1], false};
    case IrregularCorner::kOneBeforeQuad:
        return {_quadMask.beside[1], true};
    }
    return {nullptr, false};
}

// The corner is number \p corner of its face, whose weights these are so far.
void RefinementMask::addIrregularWeights(IrregularCorner const &irregular, int corner,
                                         double *weights) const {
    auto const [mask, isBackwards] = findCornerMask(irregular);
    for (int j = 0; j < kHexagonSize; ++j) {
        int const place = (corner + (isBackwards ? kHexagonSize - j : j)) % kHexagonSize;
        weights[place] += irregular.weight * (mask[j] - weights[place]);
    }
}

auto RefinementMask::irregularMask(IrregularVertex const &irregular, VertexMask mask) const
    -> VertexMask {
    Index const numFaces = _level.GetNumVertexFaces(irregular.vert);
    VertexVertexMask const plain = GetPlainVertexMask(numFaces);
    VertexVertexMask const full = getIrregularMask(numFaces, FacesAround::Others).vertex;
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
    return findVertices([](IrregularVertex const &) { return true; });
}

std::vector<Far::Index> RefinementMask::FindWeightedVertices() const {
    return findVertices([](IrregularVertex const &irregular) { return irregular.weight != 1; });
}

// The sharp vertices, and the irregular ones that satisfy isWanted(irregular).
template <typename IS_WANTED>
std::vector<Far::Index> RefinementMask::findVertices(IS_WANTED isWanted) const {
    std::vector<Index> verts;
    if (_hasSharpVertices) {
        for (SharpVertex const &sharp : _level.sharpVerts) {
            verts.push_back(sharp.vert);
        }
    }
    auto const numSharp = std::ptrdiff_t(verts.size());
    for (IrregularVertex const &irregular : GetIrregularVertices()) {
        if (isWanted(irregular)) {
            verts.push_back(irregular.vert);
        }
    }
    std::inplace_merge(verts.begin(), verts.begin() + numSharp, verts.end());
    verts.erase(std::unique(verts.begin(), verts.end()), verts.end());
    return verts;
}

} // namespace OpenSubdivHex::FarExt::internal
