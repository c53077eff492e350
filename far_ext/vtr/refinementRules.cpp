// SPDX-License-Identifier: Apache-2.0
#include "refinementRules.h"

#include "indexSet.h"

#include <cstring>
#include <unordered_map>

namespace OpenSubdivHex::FarExt::internal {

using Far::Index;

namespace {

constexpr int kHexagon = HexIndexing::kNumEFaceCorners;
constexpr int kTrapezoid = HexIndexing::kNumBoundaryEFaceCorners;
constexpr int kQuad = 4;

std::uint32_t getBits(float value) {
    std::uint32_t bits = 0;
    std::memcpy(&bits, &value, sizeof bits);
    return bits;
}

// What the rule of a face depends on.  Equal ones have equal rules.
struct FaceTags {
    Index firstCorner;
    int size;
    bool isHalf;    // then nothing else matters
    float diagonal; // share of the rule of a sharp diagonal
    SectorCorner const *sectors;
    SectorCorner const *endSectors;
    IrregularCorner const *irregular;
    IrregularCorner const *endIrregular;

    bool operator==(FaceTags const &other) const {
        if (isHalf || other.isHalf) {
            return isHalf && other.isHalf;
        }
        auto const isSameCorner = [&](auto const &x, auto const &y) {
            return x.corner - firstCorner == y.corner - other.firstCorner && x.weight == y.weight;
        };
        return size == other.size && diagonal == other.diagonal &&
               std::equal(sectors, endSectors, other.sectors, other.endSectors,
                          [&](SectorCorner const &x, SectorCorner const &y) {
                              return isSameCorner(x, y) && x.sectorSize == y.sectorSize;
                          }) &&
               std::equal(irregular, endIrregular, other.irregular, other.endIrregular,
                          [&](IrregularCorner const &x, IrregularCorner const &y) {
                              return isSameCorner(x, y) && x.kind == y.kind &&
                                     x.numFaces == y.numFaces && x.facesAround == y.facesAround;
                          });
    }

    struct Hash {
        std::size_t operator()(FaceTags const &tags) const {
            if (tags.isHalf) {
                return 0;
            }
            constexpr std::uint64_t kFactor = 0x9e3779b97f4a7c15u; // of Fibonacci hashing
            std::uint64_t hash = 0;
            auto const add = [&hash](std::uint32_t high, std::uint32_t low) {
                hash = (hash ^ (std::uint64_t(high) << 32 | low)) * kFactor;
                hash ^= hash >> 32;
            };
            add(std::uint32_t(tags.size), getBits(tags.diagonal));
            for (SectorCorner const *sector = tags.sectors; sector != tags.endSectors; ++sector) {
                add(getBits(sector->weight), getBits(sector->sectorSize));
                add(std::uint32_t(sector->corner - tags.firstCorner), 0);
            }
            for (IrregularCorner const *corner = tags.irregular; corner != tags.endIrregular;
                 ++corner) {
                add(getBits(corner->weight), std::uint32_t(corner->numFaces));
                add(std::uint32_t(corner->corner - tags.firstCorner),
                    std::uint32_t(corner->kind) << 16 | std::uint32_t(corner->facesAround));
            }
            return std::size_t(hash);
        }
    };
};

} // namespace

void RefinementRules::makeCirculantRules() {
    bool const hasQuadMasks = _step == StepType::Hexagonal && _faceMask == FaceMask::Smooth &&
                              _interpolation == Interpolation::Vertex;
    _circulants.resize(_level.faceSizes.empty() ? 0 : std::size_t(_level.faceSizes.back()) + 1);
    for (Index const size : _level.faceSizes) {
        std::size_t const first = _weights.size();
        _circulants[std::size_t(size)] = first;
        _weights.resize(first + 2 * std::size_t(size));
        double *const mask = _weights.data() + first;
        if (_step == StepType::TriHex) {
            ComputeTriHexMask(size, mask);
        } else if (hasQuadMasks && size == kQuad) {
            std::copy_n(ComputeQuadMask(_level.numHexagonalSteps).inQuad, kQuad, mask);
        } else {
            ComputeFaceVertexMask(_faceMask, _interpolation, size, mask);
        }
        std::copy_n(mask, size, mask + size);
    }
}

// Sharp vertices have their rules; in an irregular vertex, the smooth one has the share that these leave.
void RefinementRules::makeRuledVertices(bool hasIrregular) {
    auto nextIrregular = _level.irregularVerts.begin();
    auto const endIrregular = hasIrregular ? _level.irregularVerts.end() : nextIrregular;
    std::unordered_map<int, VertexVertexMask> irregularMasks; // by number of faces
    auto const addIrregular = [&](IrregularVertex const &irregular, double smoothShare,
                                  VertexRule &rule) {
        int const numFaces = _level.GetNumVertexFaces(irregular.vert);
        auto const [found, isNew] = irregularMasks.try_emplace(numFaces);
        if (isNew) {
            found->second = ComputeIrregularVertexMask(numFaces, _level.numHexagonalSteps).vertex;
        }
        VertexVertexMask const plain = GetPlainVertexMask(numFaces);
        double const share = irregular.weight * smoothShare;
        rule.faceWeight += share * (found->second.faceWeight - plain.faceWeight);
        rule.weights[rule.numSources - 1] +=
            share * (found->second.vertexWeight - plain.vertexWeight);
    };
    auto const addIrregularBefore = [&](Index vert) {
        for (; nextIrregular != endIrregular && nextIrregular->vert < vert; ++nextIrregular) {
            if (nextIrregular->weight > 0) {
                Index const index = nextIrregular->vert;
                VertexRule rule = plainRule(index, _level.GetNumVertexFaces(index));
                addIrregular(*nextIrregular, 1, rule);
                _ruledVertices.push_back({index, rule});
            }
        }
    };
    for (SharpVertex const &sharp : _level.sharpVerts) {
        addIrregularBefore(sharp.vert);
        VertexRule rule = {sharp.faceWeight, 0, {}, {}};
        auto const add = [&rule](Index source, double weight) {
            rule.sources[rule.numSources] = source;
            rule.weights[rule.numSources++] = weight;
        };
        for (int i = 0; i < 2; ++i) {
            if (sharp.neighborWeights[i] > 0) {
                add(sharp.neighbors[i], sharp.neighborWeights[i]);
            }
        }
        add(sharp.vert, sharp.vertexWeight);
        if (nextIrregular != endIrregular && nextIrregular->vert == sharp.vert) {
            addIrregular(*nextIrregular++, sharp.smoothShare, rule);
        }
        _ruledVertices.push_back({sharp.vert, rule});
    }
    addIrregularBefore(_level.numVertices);
}

// Finds the faces that are not circulant, and makes a rule for each kind of them.
class RefinementRules::DenseRuleMaker {
public:
    DenseRuleMaker(RefinementRules &rules, FaceMask faceMask)
        : _rules(rules), _level(rules._level), _faceMask(faceMask),
          _isVertex(rules._interpolation == Interpolation::Vertex),
          _quadMask(ComputeQuadMask(_level.numHexagonalSteps)) {
        ComputeHalfFaceVertexMask(faceMask, rules._interpolation, &_halfFaceWeights[0][0]);
    }

    void Make() {
        std::vector<Index> const faces = findFaces();
        if (faces.empty()) {
            return;
        }
        _rules._ruleOfFace.assign(std::size_t(_level.numFaces), kCirculant);
        _rules._denseFaces.reserve(faces.size());
        std::unordered_map<FaceTags, int, FaceTags::Hash> ruleOfTags;
        FaceTags tags = {};
        tags.endSectors = _level.sectorCorners.data();
        tags.endIrregular = _level.irregularCorners.data();
        FaceTags before = {}; // of the last face: those that follow one another are mostly alike
        int rule = kCirculant;
        for (Index const face : faces) {
            readTags(face, tags);
            if (!(tags == before)) {
                auto const [found, isNew] = ruleOfTags.try_emplace(tags, _rules.GetNumDenseRules());
                rule = found->second;
                if (isNew) {
                    addRule(tags);
                }
            }
            before = tags;
            _rules._ruleOfFace[std::size_t(face)] = rule;
            _rules._denseFaces.push_back({face, rule});
        }
    }

private:
    std::vector<Index> findFaces() const;
    void readTags(Index face, FaceTags &tags) const;
    void addRule(FaceTags const &tags);
    void addRow(std::vector<double> const &row);
    void addIrregularWeights(IrregularCorner const &irregular, int corner,
                             std::vector<double> &row) const;

    RefinementRules &_rules;
    Level const &_level;
    FaceMask _faceMask;
    bool _isVertex;
    QuadMask _quadMask;
    double _halfFaceWeights[kTrapezoid][kTrapezoid];
};

// Ascending.
std::vector<Index> RefinementRules::DenseRuleMaker::findFaces() const {
    std::vector<Index> faces(_level.halfFaces.begin(), _level.halfFaces.end());
    if (!_isVertex) {
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
    auto const numSharp = std::ptrdiff_t(faces.size());
    Index end = 0; // of the last face with irregular corners
    for (IrregularCorner const &irregular : _level.irregularCorners) {
        if (irregular.corner >= end) {
            faces.push_back(_level.FindFaceOfCorner(irregular.corner));
            end = _level.faceFirstCorner[faces.back() + 1];
        }
    }
    std::inplace_merge(faces.begin(), faces.begin() + numSharp, faces.end());
    faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
    return faces;
}

// Corners are read on from those of the faces before.
void RefinementRules::DenseRuleMaker::readTags(Index face, FaceTags &tags) const {
    tags.firstCorner = _level.faceFirstCorner[face];
    tags.size = _level.GetFaceSize(face);
    tags.isHalf = _level.IsHalfFace(face);
    tags.diagonal = std::min(1.0f, _level.GetDiagonalSharpness(face));
    auto const readOn = [end = tags.firstCorner + tags.size](auto const &all, auto const *&begin,
                                                             auto const *&behind) {
        begin = behind;
        while (behind != all.data() + all.size() && behind->corner < end) {
            ++behind;
        }
    };
    readOn(_level.sectorCorners, tags.sectors, tags.endSectors);
    readOn(_level.irregularCorners, tags.irregular, tags.endIrregular);
}

void RefinementRules::DenseRuleMaker::addRow(std::vector<double> const &row) {
    _rules._rows.push_back(_rules._weights.size());
    _rules._weights.insert(_rules._weights.end(), row.begin(), row.end());
}

// Corners of a face with nothing of their own have the rows of its circulant rule.
void RefinementRules::DenseRuleMaker::addRule(FaceTags const &tags) {
    int const size = tags.size;
    _rules._denseRules.push_back({size, _rules._rows.size()});
    if (tags.isHalf) {
        for (auto const &ofCorner : _halfFaceWeights) {
            addRow({ofCorner, ofCorner + kTrapezoid});
        }
        return;
    }
    double const sharp = tags.diagonal;
    SectorCorner const *sector = tags.sectors;
    IrregularCorner const *irregular = tags.irregular;
    for (int i = 0; i < size; ++i) {
        Index const corner = tags.firstCorner + i;
        double towards = 0;
        for (; sector != tags.endSectors && sector->corner == corner; ++sector) {
            towards += sector->weight * (1 - ComputeSectorShrink(_faceMask, sector->sectorSize));
        }
        bool const isIrregular = irregular != tags.endIrregular && irregular->corner == corner;
        std::size_t const circulantRow =
            _rules._circulants[std::size_t(size)] + std::size_t(size - i);
        if (sharp == 0 && towards == 0 && !isIrregular) {
            _rules._rows.push_back(circulantRow);
            continue;
        }
        auto const circulant = _rules._weights.begin() + std::ptrdiff_t(circulantRow);
        std::vector<double> row(circulant, circulant + size);
        for (double &weight : row) {
            weight *= 1 - sharp - towards;
        }
        row[std::size_t(i)] += towards;
        if (sharp > 0) {
            // Of a hexagon cut by its diagonal 0-3, each half follows the mask of a half face V, W, Q, P:
            // V and W are the ends of the diagonal, Q and P the two vertices between them.  At the ends
            // both halves have the same weights.
            auto const &half = kHexagonHalves[i < kDiagonalEnd ? 1 : 0];
            int const place = int(std::find(half, half + kTrapezoid, i) - half);
            for (int j = 0; j < kTrapezoid; ++j) {
                row[std::size_t(half[j])] += sharp * _halfFaceWeights[place][j];
            }
        }
        if (isIrregular) {
            addIrregularWeights(*irregular++, i, row);
        }
        addRow(row);
    }
}

// The corner is number \p corner of its face, whose weights these are so far.
void RefinementRules::DenseRuleMaker::addIrregularWeights(IrregularCorner const &irregular,
                                                          int corner,
                                                          std::vector<double> &row) const {
    using Kind = IrregularCorner::Kind;
    Kind const kind = irregular.kind;
    double const *mask = nullptr;
    IrregularVertexMask ofVertex;
    if (IrregularCorner::IsAtQuad(kind)) {
        bool const isAtEdge = kind == Kind::kAlongQuad || kind == Kind::kBehindQuad;
        mask = _quadMask.beside[isAtEdge ? 0 : 1];
    } else {
        ofVertex = ComputeIrregularVertexMask(irregular.numFaces, _level.numHexagonalSteps,
                                              irregular.facesAround);
        mask = kind == Kind::kAtVertex ? ofVertex.atVertex : ofVertex.atNeighbor;
    }
    bool const isBackwards =
        kind == Kind::kBeforeVertex || kind == Kind::kBehindQuad || kind == Kind::kOneBeforeQuad;
    for (int j = 0; j < kHexagon; ++j) {
        double &weight = row[std::size_t((corner + (isBackwards ? kHexagon - j : j)) % kHexagon)];
        weight += irregular.weight * (mask[j] - weight);
    }
}

RefinementRules::RefinementRules(Level const &parent, HexSchemeOptions schemeOptions,
                                 Interpolation interpolation)
    : _level(parent), _faceMask(schemeOptions.faceMask),
      _step(schemeOptions.GetStepOfLevel(parent.depth + 1)), _interpolation(interpolation) {
    for (int numFaces = 0; numFaces < kNumKept; ++numFaces) {
        _plainVertexMasks[numFaces] = ComputeVertexVertexMask(interpolation, numFaces);
    }
    bool const isHexagonal = _step == StepType::Hexagonal;
    makeCirculantRules();
    if (interpolation == Interpolation::Vertex) {
        makeRuledVertices(isHexagonal);
    }
    if (isHexagonal && parent.HasFeatures()) {
        DenseRuleMaker(*this, _faceMask).Make();
    }
}

std::shared_ptr<RefinementRules const> GetRules(Level const &parent, HexSchemeOptions schemeOptions,
                                                Interpolation interpolation) {
    std::shared_ptr<RefinementRules const> &kept = parent.rules[std::size_t(interpolation)];
    std::shared_ptr<RefinementRules const> rules = std::atomic_load(&kept);
    if (rules && rules->AreThoseOf(schemeOptions)) {
        return rules;
    }
    auto const made = std::make_shared<RefinementRules const>(parent, schemeOptions, interpolation);
    // Of those that several threads have made, all get the first.
    return rules || std::atomic_compare_exchange_strong(
                        &kept, &rules, std::shared_ptr<RefinementRules const>(made))
               ? made
               : rules;
}

} // namespace OpenSubdivHex::FarExt::internal
