// SPDX-License-Identifier: Apache-2.0
#include "refinementRules.h"

#include "far_ext/rules/sharpMask.h"
#include "indexSet.h"
#include "parallel.h"

#include <cstddef>
#include <cstring>
#include <map>
#include <numeric>
#include <unordered_map>
#include <utility>

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

// Masks around irregular vertices, each computed once.
class IrregularMasks {
public:
    explicit IrregularMasks(int numSteps) : _numSteps(numSteps) {}

    IrregularVertexMask const &Get(int numFaces, FacesAround facesAround = FacesAround::Others) {
        int const key = numFaces * kNumFacesAround + int(facesAround);
        auto const [found, isNew] = _masks.try_emplace(key);
        if (isNew) {
            found->second = ComputeIrregularVertexMask(numFaces, _numSteps, facesAround);
        }
        return found->second;
    }

private:
    int const _numSteps;
    std::unordered_map<int, IrregularVertexMask> _masks;
};

// Key of the rule of a face: equal keys have equal rules.
struct FaceTags {
    Index firstCorner;
    int size;
    bool isHalf;
    float diagonal; // share of the rule of a sharp diagonal
    int diagonalEnd;
    SectorCorner const *sectors;
    SectorCorner const *endSectors;
    IrregularCorner const *irregular;
    IrregularCorner const *endIrregular;
    QuadCorner const *quads;
    QuadCorner const *endQuads;

    bool operator==(FaceTags const &other) const {
        return isHalf == other.isHalf && size == other.size && diagonal == other.diagonal &&
               diagonalEnd == other.diagonalEnd &&
               std::equal(sectors, endSectors, other.sectors, other.endSectors,
                          [&](SectorCorner const &x, SectorCorner const &y) {
                              return x.corner - firstCorner == y.corner - other.firstCorner &&
                                     x.weight == y.weight && x.sectorSize == y.sectorSize &&
                                     x.kind == y.kind;
                          }) &&
               std::equal(irregular, endIrregular, other.irregular, other.endIrregular,
                          [&](IrregularCorner const &x, IrregularCorner const &y) {
                              constexpr std::size_t kFirst = offsetof(IrregularCorner, numFaces);
                              return x.corner - firstCorner == y.corner - other.firstCorner &&
                                     std::memcmp(&x.numFaces, &y.numFaces, sizeof x - kFirst) == 0;
                          }) &&
               std::equal(quads, endQuads, other.quads, other.endQuads,
                          [&](QuadCorner const &x, QuadCorner const &y) {
                              return x.corner - firstCorner == y.corner - other.firstCorner &&
                                     x.out == y.out && x.in == y.in && x.sharpness == y.sharpness;
                          });
    }

    struct Hash {
        std::size_t operator()(FaceTags const &tags) const {
            constexpr std::uint64_t kFactor = 0x9e3779b97f4a7c15u; // of Fibonacci hashing
            auto hash = std::uint64_t(tags.size) << 1 | std::uint64_t(tags.isHalf);
            auto const add = [&hash](float weight, Index rest) {
                std::uint64_t const high = getBits(weight);
                hash = (hash ^ (high << 32 | std::uint32_t(rest))) * kFactor;
            };
            add(tags.diagonal, tags.diagonalEnd);
            for (SectorCorner const *sector = tags.sectors; sector != tags.endSectors; ++sector) {
                add(sector->weight, sector->corner - tags.firstCorner);
                add(sector->sectorSize, sector->kind);
            }
            for (IrregularCorner const *corner = tags.irregular; corner != tags.endIrregular;
                 ++corner) {
                add(corner->weight, (corner->corner - tags.firstCorner) ^ corner->kind << 8 ^
                                        int(corner->facesAround) << 12 ^ corner->numFaces << 16);
            }
            for (QuadCorner const *quad = tags.quads; quad != tags.endQuads; ++quad) {
                add(quad->sharpness,
                    (quad->corner - tags.firstCorner) ^ quad->out << 4 ^ quad->in << 16);
            }
            hash ^= hash >> 32;
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

void RefinementRules::endFaceRuns() {
    _faceRuns.push_back({_level.numFaces, kCirculant});
    if (_faceRuns.size() == 2) {
        return;
    }
    _runOfBlock.reserve(std::size_t(_level.numFaces / kBlock) + 1);
    Index run = 0;
    for (Index face = 0; face < _level.numFaces; face += kBlock) {
        while (_faceRuns[std::size_t(run) + 1].begin <= face) {
            ++run;
        }
        _runOfBlock.push_back(run);
    }
}

// A vertex has them where the paths of all of its corners tell one.
void RefinementRules::makeVertexWeights() {
    if (_level.quadCorners.empty()) {
        return;
    }
    struct OfCorner {
        float weight = -1; // with so few digits it is exact
        float share = 0;
    };
    Buffer<OfCorner> ofCorners;
    ofCorners.Resize(std::size_t(_level.numCorners));
    std::fill_n(ofCorners.data(), ofCorners.size(), OfCorner());
    IrregularMasks masks(_level.numHexagonalSteps);
    ParallelFor(Index(_level.quadCorners.size()), [&](Index i) {
        QuadCorner const &quad = _level.quadCorners[std::size_t(i)];
        ofCorners[std::size_t(quad.corner)] = {
            float(FindQuadRow(_level.numHexagonalSteps, quad.out, quad.in).vertexWeight),
            quad.GetShare()};
    });
    _weightsOfVerts.Resize(std::size_t(_level.numVertices));
    std::map<std::vector<double>, int> positions;
    std::vector<double> weights;
    for (Index vert = 0; vert < _level.numVertices; ++vert) {
        weights.assign(1, 1.0);
        float share = 0;
        for (Index k = _level.vertFirstFace[vert]; k < _level.vertFirstFace[vert + 1]; ++k) {
            OfCorner const &ofCorner = ofCorners[std::size_t(_level.GetVertexCorner(k))];
            weights.push_back(ofCorner.weight);
            weights[0] -= weights.back();
            share = ofCorner.share; // all are of one vertex of quads
        }
        bool const isPlain = share == 0 || weights.size() == 1 ||
                             *std::min_element(weights.begin() + 1, weights.end()) < 0;
        if (!isPlain && share < 1) {
            int const numFaces = int(weights.size()) - 1;
            VertexVertexMask other = GetPlainVertexMask(numFaces);
            if (IrregularVertex const *const irregular = _level.FindIrregularVertex(vert)) {
                VertexVertexMask const &mask = masks.Get(numFaces).vertex;
                other.vertexWeight += irregular->weight * (mask.vertexWeight - other.vertexWeight);
                other.faceWeight += irregular->weight * (mask.faceWeight - other.faceWeight);
            }
            for (std::size_t i = 0; i < weights.size(); ++i) {
                double const rest = i == 0 ? other.vertexWeight : other.faceWeight;
                weights[i] = rest + double(share) * (weights[i] - rest);
            }
        }
        int &ofVert = _weightsOfVerts[std::size_t(vert)];
        ofVert = kPlain;
        if (!isPlain) {
            auto const [found, isNew] = positions.try_emplace(weights, int(_vertexWeights.size()));
            if (isNew) {
                _vertexWeights.insert(_vertexWeights.end(), weights.begin(), weights.end());
            }
            ofVert = found->second;
        }
    }
}

// Appends the weights of a sharp vertex, in which those at a position have a share in place of plain ones.
void RefinementRules::addVertexWeights(int smooth, double share, VertexRule &rule, int numFaces) {
    VertexVertexMask const plain = GetPlainVertexMask(numFaces);
    auto const first = std::size_t(smooth);
    double &ofVertex = rule.weights[rule.numSources - 1];
    ofVertex += share * (_vertexWeights[first] - plain.vertexWeight);
    _vertexWeights.push_back(ofVertex);
    for (int i = 1; i <= numFaces; ++i) {
        double const weight = _vertexWeights[first + std::size_t(i)];
        _vertexWeights.push_back(rule.faceWeight + share * (weight - plain.faceWeight));
    }
}

// Sharp vertices have their rules; in an irregular vertex, and in one with weights by face, the smooth one has the share
// that these leave.
void RefinementRules::makeRuledVertices(bool hasIrregular) {
    _ruledVertices.reserve(_level.sharpVerts.size() +
                           (hasIrregular ? _level.irregularVerts.size() : 0));
    auto nextIrregular = _level.irregularVerts.begin();
    auto const endIrregular = hasIrregular ? _level.irregularVerts.end() : nextIrregular;
    IrregularMasks masks(_level.numHexagonalSteps);
    std::vector<std::pair<std::size_t, std::size_t>> byFace; // with positions of weights
    auto const addIrregular = [&](IrregularVertex const &irregular, double smoothShare,
                                  VertexRule &rule) {
        int const numFaces = _level.GetNumVertexFaces(irregular.vert);
        VertexVertexMask const &mask = masks.Get(numFaces).vertex;
        VertexVertexMask const plain = GetPlainVertexMask(numFaces);
        double const share = irregular.weight * smoothShare;
        rule.faceWeight += share * (mask.faceWeight - plain.faceWeight);
        rule.weights[rule.numSources - 1] += share * (mask.vertexWeight - plain.vertexWeight);
    };
    auto const addIrregularBefore = [&](Index vert) {
        for (; nextIrregular != endIrregular && nextIrregular->vert < vert; ++nextIrregular) {
            if (nextIrregular->weight > 0 && GetVertexWeights(nextIrregular->vert) == kPlain) {
                Index const index = nextIrregular->vert;
                VertexRule rule = plainRule(index, _level.GetNumVertexFaces(index));
                addIrregular(*nextIrregular, 1, rule);
                _ruledVertices.push_back({index, rule});
            }
        }
    };
    for (SharpVertex const &sharp : _level.sharpVerts) {
        addIrregularBefore(sharp.vert);
        VertexRule rule = {sharp.faceWeight, 0, {}, {}, nullptr};
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
        bool const isIrregular = nextIrregular != endIrregular && nextIrregular->vert == sharp.vert;
        if (int const smooth = GetVertexWeights(sharp.vert);
            smooth != kPlain && sharp.smoothShare > 0) {
            byFace.emplace_back(_ruledVertices.size(), _vertexWeights.size());
            addVertexWeights(smooth, sharp.smoothShare, rule, _level.GetNumVertexFaces(sharp.vert));
        } else if (isIrregular) {
            addIrregular(*nextIrregular, sharp.smoothShare, rule);
        }
        nextIrregular += isIrregular ? 1 : 0;
        _ruledVertices.push_back({sharp.vert, rule});
    }
    addIrregularBefore(_level.numVertices);
    for (auto const &[ruled, position] : byFace) {
        VertexRule &rule = _ruledVertices[ruled].rule;
        rule.faceWeights = _vertexWeights.data() + position + 1;
        rule.faceWeight = rule.faceWeights[0];
    }
}

// Finds the faces that are not circulant, and makes a rule for each kind of them.
class RefinementRules::DenseRuleMaker {
public:
    DenseRuleMaker(RefinementRules &rules, FaceMask faceMask)
        : _rules(rules), _level(rules._level), _faceMask(faceMask),
          _isVertex(rules._interpolation == Interpolation::Vertex),
          _masks(_level.numHexagonalSteps), _quadMask(ComputeQuadMask(_level.numHexagonalSteps)) {}

    void Make() {
        std::vector<Index> const sharpFaces = findSharpFaces();
        auto nextSharp = sharpFaces.begin();
        IrregularCorner const *const endCorners =
            _level.irregularCorners.data() + _level.irregularCorners.size();
        IrregularCorner const *nextCorner = _isVertex ? _level.irregularCorners.data() : endCorners;
        std::unordered_map<FaceTags, int, FaceTags::Hash> ruleOfTags;
        FaceTags before = {}; // of the last face: those that follow one another are mostly alike
        FaceTags tags = {};
        tags.sectors = tags.endSectors = _level.sectorCorners.data();
        tags.irregular = tags.endIrregular = _level.irregularCorners.data();
        tags.quads = tags.endQuads = _level.quadCorners.data();
        QuadCorner const *const endQuads = tags.quads + (_isVertex ? _level.quadCorners.size() : 0);
        QuadCorner const *nextQuad = tags.quads;
        int rule = kCirculant;
        while (nextSharp != sharpFaces.end() || nextCorner != endCorners || nextQuad != endQuads) {
            Index face = nextSharp != sharpFaces.end() ? *nextSharp : _level.numFaces;
            if (nextCorner != endCorners) {
                face = std::min(face, _level.FindFaceOfCorner(nextCorner->corner));
            }
            if (nextQuad != endQuads) {
                face = std::min(face, findFaceOfNext(nextQuad->corner));
            }
            nextSharp += nextSharp != sharpFaces.end() && *nextSharp == face;
            readTags(face, tags);
            _endRead = face + 1;
            nextCorner = std::max(nextCorner, tags.endIrregular);
            nextQuad = std::max(nextQuad, tags.endQuads);
            if (!hasOwnRows(tags)) {
                continue;
            }
            if (!(tags == before)) {
                auto const [found, isNew] = ruleOfTags.try_emplace(tags, _rules.GetNumDenseRules());
                rule = found->second;
                if (isNew) {
                    addRule(tags);
                }
            }
            before = tags;
            addFace(face, rule);
        }
        if (_endDense < _level.numFaces) {
            _rules._faceRuns.push_back({_endDense, kCirculant});
        }
    }

private:
    std::vector<Index> findSharpFaces() const;
    void addFace(Index face, int rule);
    void readTags(Index face, FaceTags &tags) const;
    // The row that a path tells of a corner, whose entry is the next one, if it is not behind it.
    QuadRow readQuadRow(QuadCorner const *&quad, QuadCorner const *end, Index corner) const {
        while (quad != end && quad->corner < corner) {
            ++quad;
        }
        return quad != end && quad->corner == corner
                   ? FindQuadRow(_level.numHexagonalSteps, quad->out, quad->in)
                   : QuadRow{nullptr, false, -1};
    }
    bool hasOwnRows(FaceTags const &tags) const;
    Index findFaceOfNext(Index corner) const;
    void addRule(FaceTags const &tags);
    void addRow(std::vector<double> const &row);
    static void addMask(double const (&mask)[kHexagon], int corner, bool isBackwards, double share,
                        std::vector<double> &row);
    void addIrregularWeights(IrregularCorner const &irregular, int corner, double factor,
                             std::vector<double> &row);
    // The entries of one corner.
    struct Sectors {
        SectorCorner const *first;
        SectorCorner const *behind;

        SectorCorner const *begin() const { return first; }
        SectorCorner const *end() const { return behind; }
    };
    static void addOneFace(Sectors sectors, int corner, std::vector<double> &row);
    void addOneFaceHalf(Sectors sectors, std::vector<int> const &half, int place,
                        std::vector<double> &row);
    std::vector<double> const &getHalfFaceWeights(int size);

    RefinementRules &_rules;
    Level const &_level;
    FaceMask _faceMask;
    bool _isVertex;
    IrregularMasks _masks;
    QuadMask _quadMask;
    std::unordered_map<int, std::vector<double>> _halfFaceWeights; // by number of corners
    Index _endDense = 0; // behind the last face with a dense rule
    Index _endRead = 0;  // behind the last face whose tags were read
};

// Faces with other features than irregular corners, ascending.
std::vector<Index> RefinementRules::DenseRuleMaker::findSharpFaces() const {
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
    return faces;
}

// Goes on with the last run or begins another, behind one of circulant faces.
void RefinementRules::DenseRuleMaker::addFace(Index face, int rule) {
    std::vector<FaceRun> &runs = _rules._faceRuns;
    if (_endDense < face) {
        runs.push_back({_endDense, kCirculant});
    }
    if (_endDense < face || runs.empty() || runs.back().rule != rule) {
        runs.push_back({face, rule});
    }
    _endDense = face + 1;
}

// Corners are read on from those of the faces before.
void RefinementRules::DenseRuleMaker::readTags(Index face, FaceTags &tags) const {
    tags.firstCorner = _level.faceFirstCorner[face];
    tags.size = _level.GetFaceSize(face);
    tags.isHalf = _level.IsHalfFace(face);
    tags.diagonal = std::min(1.0f, _level.GetDiagonalSharpness(face));
    tags.diagonalEnd = tags.diagonal > 0 ? _level.GetDiagonalEnd(face) : 0;
    auto const readOn = [end = tags.firstCorner + tags.size](auto const &all, auto const *&begin,
                                                             auto const *&behind) {
        begin = behind;
        while (behind != all.data() + all.size() && behind->corner < end) {
            ++behind;
        }
    };
    if (_isVertex) {
        readOn(_level.sectorCorners, tags.sectors, tags.endSectors);
        readOn(_level.irregularCorners, tags.irregular, tags.endIrregular);
        readOn(_level.quadCorners, tags.quads, tags.endQuads);
    }
}

void RefinementRules::DenseRuleMaker::addRow(std::vector<double> const &row) {
    _rules._rows.push_back(_rules._weights.size());
    _rules._weights.insert(_rules._weights.end(), row.begin(), row.end());
}

// Whether any corner does not follow the circulant mask: flags alone are no reason.
bool RefinementRules::DenseRuleMaker::hasOwnRows(FaceTags const &tags) const {
    if (tags.isHalf || tags.diagonal > 0 || tags.sectors != tags.endSectors ||
        tags.irregular != tags.endIrregular) {
        return true;
    }
    return tags.size == kHexagon &&
           std::any_of(tags.quads, tags.endQuads, [this](QuadCorner const &quad) {
               return quad.GetShare() > 0 &&
                      FindQuadRow(_level.numHexagonalSteps, quad.out, quad.in).mask != nullptr;
           });
}

// The face of a corner, which lies behind those that have been read: mostly in the next face.
Index RefinementRules::DenseRuleMaker::findFaceOfNext(Index corner) const {
    bool const isNext = _endRead < _level.numFaces && corner < _level.faceFirstCorner[_endRead + 1];
    return isNext ? _endRead : _level.FindFaceOfCorner(corner);
}

// Corners of a face with nothing of their own have the rows of its circulant rule.
void RefinementRules::DenseRuleMaker::addRule(FaceTags const &tags) {
    int const size = tags.size;
    _rules._denseRules.push_back({size, _rules._rows.size()});
    double const sharp = tags.isHalf ? 1 : tags.diagonal;
    SectorCorner const *sector = tags.sectors;
    IrregularCorner const *irregular = tags.irregular;
    QuadCorner const *quad = tags.quads;
    for (int i = 0; i < size; ++i) {
        Index const corner = tags.firstCorner + i;
        double towards = 0;
        bool hasOneFace = false;
        SectorCorner const *const sectors = sector;
        for (; sector != tags.endSectors && sector->corner == corner; ++sector) {
            if (sector->kind == SectorCorner::kInWide) {
                towards +=
                    sector->weight * (1 - ComputeSectorShrink(_faceMask, sector->sectorSize));
            }
            hasOneFace = hasOneFace || sector->kind != SectorCorner::kInWide;
        }
        bool const isIrregular = irregular != tags.endIrregular && irregular->corner == corner;
        std::size_t const circulantRow =
            _rules._circulants[std::size_t(size)] + std::size_t(size - i);
        QuadRow const byPath = size == kHexagon ? readQuadRow(quad, tags.endQuads, corner)
                                                : QuadRow{nullptr, false, -1};
        if (sharp == 0 && towards == 0 && !hasOneFace && !isIrregular && !byPath.mask) {
            _rules._rows.push_back(circulantRow);
            continue;
        }
        auto const circulant = _rules._weights.begin() + std::ptrdiff_t(circulantRow);
        std::vector<double> row(circulant, circulant + size);
        if (byPath.mask) {
            addMask(*byPath.mask, i, byPath.isBackwards, quad->GetShare(), row);
        }
        for (double &weight : row) {
            weight *= 1 - sharp - towards;
        }
        row[std::size_t(i)] += towards;
        if (sharp > 0) {
            // Of a face cut by its diagonal, each half follows the mask of a half face V, W, Q, P ...: V and W are
            // the ends of the diagonal, the others the vertices between them.  At the ends both halves have the
            // same weights.
            std::vector<int> half;
            if (tags.isHalf) {
                half.resize(std::size_t(size));
                std::iota(half.begin(), half.end(), 0);
            } else {
                int const side = i < tags.diagonalEnd ? 1 : 0;
                half.resize(std::size_t(GetHalfSize(side, size, tags.diagonalEnd)));
                for (std::size_t j = 0; j < half.size(); ++j) {
                    half[j] = GetPlaceInHalves(side, int(j), tags.diagonalEnd);
                }
            }
            std::size_t const place =
                std::size_t(std::find(half.begin(), half.end(), i) - half.begin());
            double const *const weights =
                getHalfFaceWeights(int(half.size())).data() + place * half.size();
            for (std::size_t j = 0; j < half.size(); ++j) {
                row[std::size_t(half[j])] += sharp * weights[j];
            }
            if (hasOneFace) {
                addOneFaceHalf({sectors, sector}, half, int(place), row);
            }
        } else if (hasOneFace) {
            addOneFace({sectors, sector}, i, row);
        }
        if (isIrregular) {
            double const besidePath = byPath.mask ? 1 - double(quad->GetShare()) : 1;
            addIrregularWeights(*irregular++, i, besidePath, row);
        }
        addRow(row);
    }
}

// Row by row.
std::vector<double> const &RefinementRules::DenseRuleMaker::getHalfFaceWeights(int size) {
    auto const [found, isNew] = _halfFaceWeights.try_emplace(size);
    if (isNew) {
        found->second.resize(std::size_t(size) * std::size_t(size));
        ComputeHalfFaceVertexMask(_faceMask, _rules._interpolation, size, found->second.data());
    }
    return found->second;
}

// The corner is number \p corner of a hexagon, whose weights these are so far.
void RefinementRules::DenseRuleMaker::addOneFace(Sectors sectors, int corner,
                                                 std::vector<double> &row) {
    double share = 0;
    SectorCorner::Kind kind = SectorCorner::kInWide;
    for (SectorCorner const &sector : sectors) {
        if (sector.kind != SectorCorner::kInWide) {
            share += sector.weight;
            kind = sector.kind;
        }
    }
    addMask(kind == SectorCorner::kAtOne ? kOneFaceMask.atVertex : kOneFaceMask.atNeighbor, corner,
            kind == SectorCorner::kBeforeOne, share, row);
}

// The corner is number \p place of half a face, whose mask has the share of its sharp side in the row.  Beside one end
// of the line, that end's mask goes before the other's.
void RefinementRules::DenseRuleMaker::addOneFaceHalf(Sectors sectors, std::vector<int> const &half,
                                                     int place, std::vector<double> &row) {
    double beside = 0;
    double farFrom = 0;
    for (SectorCorner const &sector : sectors) {
        beside += sector.kind == SectorCorner::kBesideOne ? sector.weight : 0;
        farFrom += sector.kind == SectorCorner::kFarFromOne ? sector.weight : 0;
    }
    farFrom = std::max(0.0, farFrom - beside);
    // From the corner by the end beside it and the other end to the corner next to it.
    int const places[kTrapezoid] = {place, 3 - place, place - 2, 5 - place};
    double const *const weights =
        getHalfFaceWeights(kTrapezoid).data() + std::ptrdiff_t(place) * kTrapezoid;
    for (int j = 0; j < kTrapezoid; ++j) {
        double const plain = weights[places[j]];
        row[std::size_t(half[std::size_t(places[j])])] +=
            beside * (kOneFaceMask.atHalf[j] - plain) +
            farFrom * (kOneFaceMask.farInHalf[j] - plain);
    }
}

// Mixes a share of a hexagon's mask into a row of its corner, forward from there or backward.
void RefinementRules::DenseRuleMaker::addMask(double const (&mask)[kHexagon], int corner,
                                              bool isBackwards, double share,
                                              std::vector<double> &row) {
    for (int j = 0; j < kHexagon; ++j) {
        double &weight = row[std::size_t((corner + (isBackwards ? kHexagon - j : j)) % kHexagon)];
        weight += share * (mask[j] - weight);
    }
}

// The corner is number \p corner of its face, whose weights these are so far.
void RefinementRules::DenseRuleMaker::addIrregularWeights(IrregularCorner const &irregular,
                                                          int corner, double factor,
                                                          std::vector<double> &row) {
    using Kind = IrregularCorner::Kind;
    Kind const kind = irregular.kind;
    double const(*mask)[kHexagon] = nullptr;
    if (IrregularCorner::IsAtQuad(kind)) {
        bool const isAtEdge = kind == Kind::kAlongQuad || kind == Kind::kBehindQuad;
        mask = &_quadMask.beside[isAtEdge ? 0 : 1];
    } else {
        IrregularVertexMask const &ofVertex = _masks.Get(irregular.numFaces, irregular.facesAround);
        mask = kind == Kind::kAtVertex ? &ofVertex.atVertex : &ofVertex.atNeighbor;
    }
    bool const isBackwards =
        kind == Kind::kBeforeVertex || kind == Kind::kBehindQuad || kind == Kind::kOneBeforeQuad;
    addMask(*mask, corner, isBackwards, factor * irregular.weight, row);
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
        if (isHexagonal) {
            makeVertexWeights();
        }
        makeRuledVertices(isHexagonal);
    }
    if (isHexagonal && parent.HasFeatures()) {
        DenseRuleMaker(*this, _faceMask).Make();
    } else {
        _faceRuns.push_back({0, kCirculant});
    }
    endFaceRuns();
}

std::shared_ptr<RefinementRules const> GetRules(Level const &parent, HexSchemeOptions schemeOptions,
                                                Interpolation interpolation) {
    auto const make = [&] {
        return std::make_shared<RefinementRules const>(parent, schemeOptions, interpolation);
    };
    auto const rules = parent.rules[std::size_t(interpolation)].Get(make);
    return rules->AreThoseOf(schemeOptions) ? rules : make();
}

} // namespace OpenSubdivHex::FarExt::internal
