// SPDX-License-Identifier: Apache-2.0
#include "refinementRules.h"

#include "far_ext/rules/sharpMask.h"
#include "indexSet.h"
#include "parallel.h"

#include <array>
#include <cstddef>
#include <cstring>
#include <iterator>
#include <map>
#include <numeric>
#include <unordered_map>
#include <utility>

namespace OpenSubdivHex::FarExt::internal {

using Far::Index;

namespace {

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

// The tags of a face's corners among all of their kind.
template <typename TAG>
struct TagRange {
    TAG const *first;
    TAG const *behind;

    TAG const *begin() const { return first; }
    TAG const *end() const { return behind; }
    bool empty() const { return first == behind; }
};

// The masks beside the sharpest line at a corner, and their share: as much as it is sharper than any other line there.
struct LineShare {
    MaskRow row = kNoMaskRow;
    LineFace face = LineFace::OnLine;
    float share = 0;
};
template <typename TAGS>
LineShare findLineShare(int numSteps, TAGS const &ofCorner) {
    LineRowCorner const *sharpest = nullptr;
    float most = 0;
    float second = 0;
    for (LineRowCorner const &tag : ofCorner) {
        float const share = tag.GetShare();
        second = std::max(second, std::min(most, share));
        if (share > most) {
            most = share;
            sharpest = &tag;
        }
    }
    return sharpest ? LineShare{FindLineRow(numSteps, sharpest->face, sharpest->place),
                                sharpest->face, most - second}
                    : LineShare();
}

// Returns the words of a tag in a face that begins at a corner: an even number of them.
template <typename TAG>
auto getWords(TAG tag, Index firstCorner) {
    tag.corner -= firstCorner;
    constexpr std::size_t kNumWords = sizeof tag / sizeof(std::uint32_t);
    std::array<std::uint32_t, (kNumWords + 1) / 2 * 2> words = {};
    std::memcpy(words.data(), &tag, sizeof tag);
    return words;
}

// Key of the rule of a face: equal keys have equal rules.
struct FaceTags {
    Index firstCorner;
    int size;
    bool isHalf;
    float diagonal; // share of the rule of a sharp diagonal
    int diagonalEnd;
    TagRange<SectorCorner> sectorCorners;
    TagRange<IrregularCorner> irregularCorners;
    TagRange<LineRowCorner> lineRowCorners;
    TagRange<QuadLineCorner> quadLineCorners;
    std::array<QuadFlags, kHexagon> quadFlags; // by corner; none of larger faces have any

    auto GetQuadWords() const {
        std::array<std::uint32_t, sizeof quadFlags / sizeof(std::uint32_t)> words;
        std::memcpy(words.data(), quadFlags.data(), sizeof words);
        return words;
    }

    bool operator==(FaceTags const &other) const {
        bool result = isHalf == other.isHalf && size == other.size && diagonal == other.diagonal &&
                      diagonalEnd == other.diagonalEnd && GetQuadWords() == other.GetQuadWords();
        CornerTags::ForEachListedKind(
            [&](auto const &tags, auto const &otherTags) {
                auto const isSame = [&](auto const &x, auto const &y) {
                    return getWords(x, firstCorner) == getWords(y, other.firstCorner);
                };
                result = result && std::equal(tags.begin(), tags.end(), otherTags.begin(),
                                              otherTags.end(), isSame);
            },
            *this, other);
        return result;
    }

    struct Hash {
        std::size_t operator()(FaceTags const &tags) const {
            constexpr std::uint64_t kFactor = 0x9e3779b97f4a7c15u; // of Fibonacci hashing
            auto hash = std::uint64_t(tags.size) << 1 | std::uint64_t(tags.isHalf);
            auto const add = [&hash](std::uint32_t high, std::uint32_t low) {
                hash = (hash ^ (std::uint64_t(high) << 32 | low)) * kFactor;
            };
            add(getBits(tags.diagonal), std::uint32_t(tags.diagonalEnd));
            CornerTags::ForEachListedKind(
                [&](auto const &ofKind) {
                    for (auto const &tag : ofKind) {
                        auto const words = getWords(tag, tags.firstCorner);
                        for (std::size_t i = 0; i < words.size(); i += 2) {
                            add(words[i], words[i + 1]);
                        }
                    }
                },
                tags);
            auto const words = tags.GetQuadWords();
            for (std::size_t i = 0; i < words.size(); i += 2) {
                add(words[i], words[i + 1]);
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

// Sharp vertices have their rules; in an irregular vertex, the smooth one has the share that these leave.
void RefinementRules::makeRuledVertices(bool hasIrregular) {
    _ruledVertices.reserve(_level.sharpVerts.size() +
                           (hasIrregular ? _level.irregularVerts.size() : 0));
    auto nextIrregular = _level.irregularVerts.begin();
    auto const endIrregular = hasIrregular ? _level.irregularVerts.end() : nextIrregular;
    IrregularMasks masks(_level.numHexagonalSteps);
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
            if (nextIrregular->weight > 0) {
                Index const index = nextIrregular->vert;
                VertexRule rule = plainRule(index, _level.GetNumVertexFaces(index));
                addIrregular(*nextIrregular, 1, rule);
                _ruledVertices.push_back({index, rule});
            }
        }
    };
    // Level 0 has the tags of all masks, and edges of phase A alone: with CreaseLevel::First lines stay.
    bool const doLinesStay = _step == StepType::Hexagonal && _faceMask == FaceMask::Smooth &&
                             _level.hasFirstLineMasks && _level.numHexagonalSteps == 0;
    for (SharpVertex const &sharp : _level.sharpVerts) {
        addIrregularBefore(sharp.vert);
        bool const stays = doLinesStay && !_level.IsNonManifold(sharp.vert);
        VertexRule rule = {sharp.faceWeight, 0, {}, {}, nullptr};
        auto const add = [&rule](Index source, double weight) {
            rule.sources[rule.numSources] = source;
            rule.weights[rule.numSources++] = weight;
        };
        for (int i = 0; i < 2; ++i) {
            if (sharp.neighborWeights[i] > 0 && !stays) {
                add(sharp.neighbors[i], sharp.neighborWeights[i]);
            }
        }
        add(sharp.vert,
            sharp.vertexWeight + (stays ? sharp.neighborWeights[0] + sharp.neighborWeights[1] : 0));
        if (nextIrregular != endIrregular && nextIrregular->vert == sharp.vert) {
            addIrregular(*nextIrregular++, sharp.smoothShare, rule);
        }
        _ruledVertices.push_back({sharp.vert, rule});
    }
    addIrregularBefore(_level.numVertices);
}

// Where the tags of all corners of a vertex tell the weights of its F-vertices, these have the least share of the
// corners; with paths, all have that which the vertex's sharpness leaves.  Then weights beside lines of quads take their
// share of each F-vertex that has one.
void RefinementRules::makeVertexWeights() {
    if ((_level.quadCorners.empty() && _level.quadLineCorners.empty() &&
         _level.lineRowCorners.empty()) ||
        _level.numVertices == 0) {
        return;
    }
    struct OfCorner {
        float weight = -1; // with so few digits it is exact
        float share = 0;
    };
    VertexVertexMask const plain = GetPlainVertexMask(kFVertexFaces);
    _vertexWeights.assign(1 + kFVertexFaces, plain.faceWeight);
    _vertexWeights[0] = plain.vertexWeight;
    std::map<std::vector<double>, int> positions;
    struct Ruled {
        VertexRule rule;
        int position; // of its weights
    };
    std::map<Index, Ruled> ruled; // those with neighbors
    // The rule so far, with the weights of the vertex and of its F-vertices; to be used before another is set.
    auto const getRule = [&](Index vert) -> VertexRule {
        if (auto const found = ruled.find(vert); found != ruled.end()) {
            VertexRule rule = found->second.rule;
            rule.faceWeights = _vertexWeights.data() + found->second.position + 1;
            return rule;
        }
        int const position = GetVertexWeights(vert);
        return position == kPlain ? GetVertexRule(vert) : weightedRule(vert, position);
    };
    auto const setRule = [&](Index vert, VertexRule const &rule,
                             std::vector<double> const &weights) {
        auto const [found, isNew] = positions.try_emplace(weights, int(_vertexWeights.size()));
        if (isNew) {
            _vertexWeights.insert(_vertexWeights.end(), weights.begin(), weights.end());
        }
        if (rule.numSources > 1) {
            ruled[vert] = {rule, found->second};
        } else {
            _weightsOfVerts.resize(std::max(_weightsOfVerts.size(), std::size_t(vert) + 1), kPlain);
            _weightsOfVerts[std::size_t(vert)] = found->second;
        }
    };
    std::vector<double> weights;
    auto const setWeights = [&](Index vert, float smoothShare, auto const &findOf) {
        weights.assign(1, 1.0);
        double share = smoothShare;
        for (Index k = _level.vertFirstFace[vert]; k < _level.vertFirstFace[vert + 1]; ++k) {
            OfCorner const ofCorner = findOf(_level.GetVertexCorner(k));
            share = ofCorner.weight < 0 ? 0 : std::min(share, double(ofCorner.share));
            if (share == 0) {
                break;
            }
            weights.push_back(double(ofCorner.weight));
            weights[0] -= weights.back();
        }
        if (share == 0 || weights.size() == 1) {
            return;
        }
        VertexRule rule = {0, 1, {vert}, {weights[0]}, nullptr};
        if (share < 1) {
            rule = getRule(vert);
            for (double &weight : rule.weights) {
                weight *= 1 - share;
            }
            double &ofVertex = rule.weights[rule.numSources - 1];
            ofVertex += share * weights[0];
            weights[0] = ofVertex;
            for (std::size_t j = 1; j < weights.size(); ++j) {
                double const before = rule.GetFaceWeight(int(j) - 1);
                weights[j] = before + share * (weights[j] - before);
            }
        }
        setRule(vert, rule, weights);
    };
    auto const setBesideLine = [&](Index vert) {
        SharpVertex const *const sharp = _level.FindSharpVertex(vert);
        double const smoothShare = sharp ? sharp->smoothShare : 1;
        VertexRule rule = getRule(vert);
        double &ofVertex = rule.weights[rule.numSources - 1];
        weights.assign(1, 0.0);
        for (int i = 0; i < _level.GetNumVertexFaces(vert); ++i) {
            Index const corner = _level.GetVertexCorner(_level.vertFirstFace[vert] + i);
            double const before = rule.GetFaceWeight(i);
            double change = 0;
            for (QuadLineCorner const &tag :
                 FindCornerTags(_level.quadLineCorners, corner, corner + 1)) {
                for (LineRole const role : kLineRoles) {
                    QuadLineRow const own =
                        FindQuadLineRow(_level.numHexagonalSteps, tag.flags, role);
                    if (own.row.vertexWeight >= 0) {
                        change +=
                            smoothShare * own.share * (own.row.vertexWeight - before - change);
                    }
                }
            }
            weights.push_back(before + change);
            ofVertex -= change;
        }
        weights[0] = ofVertex;
        setRule(vert, rule, weights);
    };

    auto const findOfQuad = [this](Index corner) -> OfCorner {
        QuadFlags const flags = _level.quadCorners.GetFlags(corner);
        if (!flags.HasAny()) {
            return {};
        }
        MaskRow const row = FindQuadRow(_level.numHexagonalSteps, flags);
        return {float(row.vertexWeight), flags.GetShare()};
    };
    auto const listVertices = [this](auto const &tags, auto const &matters) {
        std::vector<Index> verts;
        verts.reserve(tags.size());
        for (auto const &tag : tags) {
            if (matters(tag)) {
                verts.push_back(_level.faceVerts[tag.corner]);
            }
        }
        SortUnique(verts);
        return verts;
    };
    auto const allMatter = [](auto const &) { return true; };
    // In the constant levels few vertices have such weights, and have rules of their own.
    if (_level.numHexagonalSteps >= kNumStepsToConstantMasks) {
        for (Index const vert : listVertices(_level.quadCorners, allMatter)) {
            setWeights(vert, 1, findOfQuad);
        }
    } else if (!_level.quadCorners.empty()) {
        Buffer<OfCorner> ofCorners;
        ofCorners.Resize(std::size_t(_level.numCorners));
        ParallelFor(_level.numCorners,
                    [&](Index corner) { ofCorners[std::size_t(corner)] = findOfQuad(corner); });
        for (Index vert = 0; vert < _level.numVertices; ++vert) {
            setWeights(vert, 1, [&](Index corner) { return ofCorners[std::size_t(corner)]; });
        }
    }
    auto const hasWeight = [this](QuadLineCorner const &tag) {
        return std::any_of(std::begin(kLineRoles), std::end(kLineRoles), [&](LineRole role) {
            return FindQuadLineRow(_level.numHexagonalSteps, tag.flags, role).row.vertexWeight >= 0;
        });
    };
    for (Index const vert : listVertices(_level.quadLineCorners, hasWeight)) {
        setBesideLine(vert);
    }
    auto const findBesideLine = [this](Index corner) -> OfCorner {
        LineShare const line = findLineShare(
            _level.numHexagonalSteps, FindCornerTags(_level.lineRowCorners, corner, corner + 1));
        return {float(line.row.vertexWeight), line.share};
    };
    for (Index const vert : listVertices(_level.lineRowCorners, allMatter)) {
        if (_level.GetNumVertexFaces(vert) == kFVertexFaces) {
            SharpVertex const *const sharp = _level.FindSharpVertex(vert);
            setWeights(vert, sharp ? float(sharp->smoothShare) : 1, findBesideLine);
        }
    }

    // They take the place of those that vertices had.
    std::vector<RuledVertex> withNeighbors;
    for (auto &[vert, ofVert] : ruled) {
        ofVert.rule.faceWeights = _vertexWeights.data() + ofVert.position + 1;
        ofVert.rule.faceWeight = ofVert.rule.faceWeights[0];
        withNeighbors.push_back({vert, ofVert.rule});
    }
    std::vector<RuledVertex> before;
    before.swap(_ruledVertices);
    std::set_union(withNeighbors.begin(), withNeighbors.end(), before.begin(), before.end(),
                   std::back_inserter(_ruledVertices),
                   [](RuledVertex const &x, RuledVertex const &y) { return x.vert < y.vert; });
    _ruledVertices.erase(std::remove_if(_ruledVertices.begin(), _ruledVertices.end(),
                                        [this](RuledVertex const &vertex) {
                                            return GetVertexWeights(vertex.vert) != kPlain;
                                        }),
                         _ruledVertices.end());
}

// Finds the faces that are not circulant, and makes a rule for each kind of them.
class RefinementRules::DenseRuleMaker {
public:
    DenseRuleMaker(RefinementRules &rules, FaceMask faceMask)
        : _rules(rules), _level(rules._level), _faceMask(faceMask),
          _isVertex(rules._interpolation == Interpolation::Vertex),
          _hasPathRows(_isVertex && faceMask == FaceMask::Smooth), _masks(_level.numHexagonalSteps),
          _quadMask(ComputeQuadMask(_level.numHexagonalSteps)) {}

    void Make() {
        std::vector<Index> const sharpFaces = findSharpFaces();
        auto nextSharp = sharpFaces.begin();
        std::unordered_map<FaceTags, int, FaceTags::Hash> ruleOfTags;
        FaceTags before = {}; // of the last face: those that follow one another are mostly alike
        FaceTags tags = {};
        CornerTags::ForEachListedKind(
            [](auto const &all, auto &read) {
                read = {all.data(), all.data()};
            },
            _level, tags);
        int rule = kCirculant;
        for (;;) {
            Index face = findNextFace(tags);
            if (nextSharp != sharpFaces.end() && *nextSharp <= face) {
                face = *nextSharp++;
            }
            if (face == _level.numFaces) {
                break;
            }
            readTags(face, tags);
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
    void readTags(Index face, FaceTags &tags);
    // The masks of a corner by the paths of its flags, and their shares: of hexagons inside, then beside lines.
    struct PathRows {
        MaskRow inside = kNoMaskRow;
        double ofInside = 0;
        QuadLineRow besideLines[2] = {{kNoMaskRow, false, 0}, {kNoMaskRow, false, 0}};

        bool HasAny() const {
            return ofInside > 0 || besideLines[0].row.mask || besideLines[1].row.mask;
        }
    };
    PathRows findPathRows(FaceTags const &tags, int corner) const;
    bool hasOwnRows(FaceTags const &tags) const;
    Index findNextFace(FaceTags const &read);
    void addRule(FaceTags const &tags);
    void addRow(std::vector<double> const &row);
    static void addMask(MaskRow const &mask, int corner, double share, std::vector<double> &row);
    void addIrregularWeights(IrregularCorner const &irregular, int corner,
                             std::vector<double> &row);
    // The entries of one corner.
    struct Sectors {
        SectorCorner const *first;
        SectorCorner const *behind;

        SectorCorner const *begin() const { return first; }
        SectorCorner const *end() const { return behind; }
    };
    static void addOneFace(Sectors sectors, int corner, std::vector<double> &row);
    void addOneFaceHalf(Sectors sectors, std::vector<int> const &half, int place, double ofLine,
                        std::vector<double> &row);
    std::vector<double> const &getHalfFaceWeights(int size);

    RefinementRules &_rules;
    Level const &_level;
    FaceMask _faceMask;
    bool _isVertex;
    bool _hasPathRows; // level 0 has quadLineCorners for all masks
    IrregularMasks _masks;
    QuadMask _quadMask;
    std::unordered_map<int, std::vector<double>> _halfFaceWeights; // by number of corners
    Index _endDense = 0;  // behind the last face with a dense rule
    Index _endRead = 0;   // behind the last face whose tags were read
    Index _nextQuad = -1; // the first corner behind that with flags of quads, or the end
};

// Faces with a feature that is no tag of a corner, ascending.
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
void RefinementRules::DenseRuleMaker::readTags(Index face, FaceTags &tags) {
    tags.firstCorner = _level.faceFirstCorner[face];
    tags.size = _level.GetFaceSize(face);
    tags.isHalf = _level.IsHalfFace(face);
    tags.diagonal = std::min(1.0f, _level.GetDiagonalSharpness(face));
    tags.diagonalEnd = tags.diagonal > 0 ? _level.GetDiagonalEnd(face) : 0;
    _endRead = face + 1;
    if (!_isVertex) {
        return;
    }
    CornerTags::ForEachListedKind(
        [end = tags.firstCorner + tags.size](auto const &all, auto &read) {
            read.first = read.behind;
            while (read.behind != all.data() + all.size() && read.behind->corner < end) {
                ++read.behind;
            }
        },
        _level, tags);
    for (int i = 0; i < kHexagon; ++i) {
        tags.quadFlags[std::size_t(i)] =
            i < tags.size ? _level.quadCorners.GetFlags(tags.firstCorner + i) : QuadFlags();
    }
}

auto RefinementRules::DenseRuleMaker::findPathRows(FaceTags const &tags, int corner) const
    -> PathRows {
    PathRows result;
    if (!_hasPathRows || corner >= kHexagon || tags.size > kHexagon) {
        return result;
    }
    if (QuadFlags const flags = tags.quadFlags[std::size_t(corner)];
        flags.HasAny() && tags.size == kHexagon) {
        result.inside = FindQuadRow(_level.numHexagonalSteps, flags);
        result.ofInside = result.inside.mask ? double(flags.GetShare()) : 0;
    }
    for (QuadLineCorner const &tag : tags.quadLineCorners) {
        if (tag.corner == tags.firstCorner + corner) {
            for (LineRole const role : kLineRoles) {
                result.besideLines[int(role)] =
                    FindQuadLineRow(_level.numHexagonalSteps, tag.flags, role);
            }
        }
    }
    return result;
}

// The first face with tags of corners behind those that have been read, mostly the next one; else the end.
Index RefinementRules::DenseRuleMaker::findNextFace(FaceTags const &read) {
    Index const endRead = _level.faceFirstCorner[_endRead];
    if (_nextQuad < endRead) {
        _nextQuad = QuadCorners::Iterator(_level.quadCorners, endRead, _level.numCorners)->corner;
    }
    Index corner = _nextQuad;
    CornerTags::ForEachListedKind(
        [&corner](auto const &all, auto const &ofKind) {
            if (ofKind.behind != all.data() + all.size()) {
                corner = std::min(corner, ofKind.behind->corner);
            }
        },
        _level, read);
    if (!_isVertex || corner == _level.numCorners) {
        return _level.numFaces;
    }
    return corner < _level.faceFirstCorner[_endRead + 1] ? _endRead
                                                         : _level.FindFaceOfCorner(corner);
}

void RefinementRules::DenseRuleMaker::addRow(std::vector<double> const &row) {
    _rules._rows.push_back(_rules._weights.size());
    _rules._weights.insert(_rules._weights.end(), row.begin(), row.end());
}

// Whether any corner does not follow the circulant mask: flags alone are no reason.
bool RefinementRules::DenseRuleMaker::hasOwnRows(FaceTags const &tags) const {
    if (tags.isHalf || tags.diagonal > 0 || !tags.sectorCorners.empty() ||
        !tags.irregularCorners.empty()) {
        return true;
    }
    for (int i = 0; i < tags.size && i < kHexagon; ++i) {
        if (findPathRows(tags, i).HasAny()) {
            return true;
        }
    }
    return std::any_of(
        tags.lineRowCorners.begin(), tags.lineRowCorners.end(), [this](LineRowCorner const &tag) {
            return FindLineRow(_level.numHexagonalSteps, tag.face, tag.place).mask != nullptr;
        });
}

// Corners of a face with nothing of their own have the rows of its circulant rule.
void RefinementRules::DenseRuleMaker::addRule(FaceTags const &tags) {
    int const size = tags.size;
    _rules._denseRules.push_back({size, _rules._rows.size()});
    double const sharp = tags.isHalf ? 1 : tags.diagonal;
    SectorCorner const *sector = tags.sectorCorners.begin();
    IrregularCorner const *irregular = tags.irregularCorners.begin();
    LineRowCorner const *line = tags.lineRowCorners.begin();
    for (int i = 0; i < size; ++i) {
        Index const corner = tags.firstCorner + i;
        double towards = 0;
        bool hasOneFace = false;
        SectorCorner const *const sectors = sector;
        for (; sector != tags.sectorCorners.end() && sector->corner == corner; ++sector) {
            if (sector->kind == SectorCorner::kInWide) {
                towards +=
                    sector->weight * (1 - ComputeSectorShrink(_faceMask, sector->sectorSize));
            }
            hasOneFace = hasOneFace || sector->kind != SectorCorner::kInWide;
        }
        IrregularCorner const *const ofIrregular =
            irregular != tags.irregularCorners.end() && irregular->corner == corner ? irregular++
                                                                                    : nullptr;
        PathRows const byPath = findPathRows(tags, i);
        LineRowCorner const *const lines = line;
        while (line != tags.lineRowCorners.end() && line->corner == corner) {
            ++line;
        }
        LineShare besideLine =
            findLineShare(_level.numHexagonalSteps, TagRange<LineRowCorner>{lines, line});
        if (!besideLine.row.mask) {
            besideLine.share = 0;
        }
        std::size_t const circulantRow =
            _rules._circulants[std::size_t(size)] + std::size_t(size - i);
        if (sharp == 0 && towards == 0 && !hasOneFace && !ofIrregular && !byPath.HasAny() &&
            besideLine.share == 0) {
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
            // If a face is cut by its diagonal, each half follows the mask of a half face V, W, Q, P ...: V and W are
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
            auto const isOfHalf = [](QuadLineRow const &beside) {
                return beside.row.mask && beside.isOfHalf;
            };
            if (hasOneFace) {
                double ofLine = 0;
                for (QuadLineRow const &beside : byPath.besideLines) {
                    ofLine =
                        isOfHalf(beside) ? std::max(ofLine, std::min(sharp, beside.share)) : ofLine;
                }
                addOneFaceHalf({sectors, sector}, half, int(place), ofLine, row);
            }
            // In the place of the half face's own mask.
            auto const addHalfMask = [&](MaskRow const &mask, double share) {
                for (int j = 0; j < kTrapezoid; ++j) {
                    int const turns = mask.isBackwards ? kTrapezoid - j : j;
                    std::size_t const to = (place + std::size_t(turns)) % kTrapezoid;
                    row[std::size_t(half[to])] += share * (mask.mask[j] - weights[to]);
                }
            };
            if (besideLine.share > 0 && besideLine.face == LineFace::Half) {
                addHalfMask(besideLine.row, std::min(sharp, double(besideLine.share)));
            }
            for (QuadLineRow const &beside : byPath.besideLines) {
                if (isOfHalf(beside)) {
                    addHalfMask(beside.row, std::min(sharp, beside.share));
                }
            }
        } else if (hasOneFace) {
            addOneFace({sectors, sector}, i, row);
        }
        if (ofIrregular && byPath.ofInside < 1) {
            addIrregularWeights(*ofIrregular, i, row);
        }
        if (byPath.ofInside > 0) {
            addMask(byPath.inside, i, byPath.ofInside, row);
        }
        // Where another line crosses the face, as much as it is sharper than that.
        if (besideLine.share > 0 && besideLine.face != LineFace::Half) {
            addMask(besideLine.row, i, std::max(0.0, double(besideLine.share) - sharp), row);
        }
        for (QuadLineRow const &beside : byPath.besideLines) {
            if (beside.row.mask && !beside.isOfHalf) {
                addMask(beside.row, i, std::max(0.0, beside.share - sharp), row);
            }
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
    double const *const mask =
        kind == SectorCorner::kAtOne ? kOneFaceMask.atVertex : kOneFaceMask.atNeighbor;
    addMask({mask, kind == SectorCorner::kBeforeOne, -1, -1}, corner, share, row);
}

// The corner is number \p place of half a face, whose mask has the share of its sharp side in the row.  Masks beside lines
// go before these, which have what \p ofLine leaves; beside one end of the line, that end's mask goes before the other's.
void RefinementRules::DenseRuleMaker::addOneFaceHalf(Sectors sectors, std::vector<int> const &half,
                                                     int place, double ofLine,
                                                     std::vector<double> &row) {
    double beside = 0;
    double farFrom = 0;
    for (SectorCorner const &sector : sectors) {
        beside += sector.kind == SectorCorner::kBesideOne ? sector.weight : 0;
        farFrom += sector.kind == SectorCorner::kFarFromOne ? sector.weight : 0;
    }
    farFrom = std::max(0.0, farFrom - std::max(beside, ofLine));
    beside = std::max(0.0, beside - ofLine);
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

// Mixes a share of a face's mask into a row of its corner, forward from there or backward.
void RefinementRules::DenseRuleMaker::addMask(MaskRow const &mask, int corner, double share,
                                              std::vector<double> &row) {
    int const size = int(row.size());
    for (int j = 0; j < size; ++j) {
        double &weight = row[std::size_t((corner + (mask.isBackwards ? size - j : j)) % size)];
        weight = share == 1 ? mask.mask[j] : weight + share * (mask.mask[j] - weight);
    }
}

// The corner is number \p corner of its face, whose weights these are so far.
void RefinementRules::DenseRuleMaker::addIrregularWeights(IrregularCorner const &irregular,
                                                          int corner, std::vector<double> &row) {
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
    addMask({*mask, isBackwards, -1, -1}, corner, double(irregular.weight), row);
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
        if (isHexagonal && _faceMask == FaceMask::Smooth) {
            makeVertexWeights();
        }
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
