// SPDX-License-Identifier: Apache-2.0
#include "deviceRefinement.h"

#include "far_ext/vtr/report.h"
#include "osd_ext/refinement/preparedRefinement.h"

#include "far_ext/vtr/indexSet.h"
#include "far_ext/vtr/parallel.h"
#include "far_ext/vtr/runs.h"
#include "far_ext/vtr/truncationMask.h"

#include <algorithm>
#include <limits>
#include <string>
#include <unordered_map>

namespace OpenSubdivHex::OsdExt::internal {

using Far::Index;
using FarExt::internal::FaceRule;
using FarExt::internal::ForEachRun;
using FarExt::internal::Level;
using FarExt::internal::ParallelFor;
using FarExt::internal::Refinement;
using FarExt::internal::RefinementRules;
using FarExt::internal::VertexRule;

namespace {

constexpr int kRunValence = 3;

// Runs of fewer faces or vertices are listed where there are many of them: each run is work of its own
// for the device.
constexpr Index kMinRun = 256;
constexpr std::size_t kFewRuns = 8;

// In which order the F-vertices of a vertex with three faces are added, which is that of
// RefinementEvaluator.
enum class SumOrder {
    InTurn,  // first those of the first corners
    LastTwo, // those of the last two corners first: of an F-vertex of the level before
    FirstTwo // those of the first two corners first: of one of the level before that
};

// Components [begin, end) that are alike.
struct Range {
    Index begin;
    Index end;
    int size; // of faces; of vertices, the number of faces
    SumOrder order = SumOrder::InTurn;
};

// The end of the components from begin on that have the size of the first one.  Blocks are compared as a
// whole, which compilers do in vectors.
template <typename GET_SIZE>
Index findEndOfSize(Index begin, Index end, GET_SIZE const &getSize) {
    constexpr Index kBlock = 64;
    int const size = getSize(begin);
    Index next = begin + 1;
    for (; end - next >= kBlock; next += kBlock) {
        int difference = 0;
        for (Index i = 0; i < kBlock; ++i) {
            difference |= getSize(next + i) ^ size;
        }
        if (difference != 0) {
            break;
        }
    }
    while (next < end && getSize(next) == size) {
        ++next;
    }
    return next;
}

// Adds components [begin, end), each with the size that getSize(component) says, but joins none from
// mayNotJoinAt on with those before.
template <typename GET_SIZE>
void append(std::vector<Range> &ranges, Range rest, Index mayNotJoinAt, GET_SIZE const &getSize) {
    while (rest.begin < rest.end) {
        Index const end = rest.begin < mayNotJoinAt ? std::min(rest.end, mayNotJoinAt) : rest.end;
        Range const range = {rest.begin, findEndOfSize(rest.begin, end, getSize),
                             getSize(rest.begin), rest.order};
        FarExt::internal::AppendRun(ranges, range, [=](Range const &a, Range const &b) {
            return a.size == b.size && a.order == b.order && b.begin != mayNotJoinAt;
        });
        rest.begin = range.end;
    }
}

// Whether one of some ranges is evaluated as a run.
bool isRun(Range const &range, std::vector<Range> const &ranges) {
    return range.end - range.begin >= kMinRun || ranges.size() <= kFewRuns;
}

// Prepares one refinement, in two passes: the first finds what is in runs, and so the number of
// indices; the second writes them.
class Maker {
public:
    Maker(RefinementRules const &rules, Refinement const &refinement, Refinement const *before,
          std::size_t firstIndex, std::vector<float> &weights, DeviceRefinement &result)
        : _rules(rules), _refinement(refinement), _before(before), _level(*refinement.parent),
          _numIndices(firstIndex), _weights(weights), _result(result) {
        _result.numVVertices = refinement.child->numVVertices;
        FarExt::VertexVertexMask const plain = rules.GetPlainVertexMask(kRunValence);
        _result.vertexWeight = float(plain.vertexWeight);
        _result.averagesFaces = plain.faceWeight != 0;
        if (_before && _level.isHexagonal) {
            _firstNewVertex = _before->GetCornerChildVertex(0);
            _result.firstConsecutiveVertex = std::uint32_t(_firstNewVertex);
            _result.numConsecutiveCorners =
                std::uint32_t(_level.faceFirstCorner[std::size_t(_level.numFFaces)]);
            Level const &levelBefore = *_before->parent;
            bool const hasSharpBoundaries =
                levelBefore.numSharpBoundariesA + levelBefore.numSharpBoundariesB > 0;
            _firstOlderVertex = levelBefore.isHexagonal && !hasSharpBoundaries
                                    ? levelBefore.numVVertices
                                    : _firstNewVertex;
        } else {
            _firstNewVertex = _firstOlderVertex = _level.numVertices;
        }
    }

    void Plan() {
        if (_refinement.isTruncation) {
            planTruncation();
            return;
        }
        _result.firstListedVertex = takeIndices(std::size_t(_level.numCorners) -
                                                std::size_t(_result.numConsecutiveCorners));
        planFaces();
        planVertices();
    }
    std::size_t GetNumIndices() const { return _numIndices; }
    void Fill(std::int32_t *indices) const;

private:
    void planFaces();
    void planVertices();
    void planTruncation();
    void addRun(Range const &range);
    void listFace(Index face);
    void listCorner(Index face, int corner, std::uint32_t firstIndex);
    void listDenseCorners(Range const &run);
    bool isCirculant(FaceRule const &rule, int corner) const;
    std::vector<Index> findFacesInNoRun() const;
    std::uint32_t takeIndicesOf(Index face);
    void listPlainVertex(Index vert);
    void listVertex(Index vert);

    std::uint32_t takeIndices(std::size_t count) {
        std::size_t const first = _numIndices;
        _numIndices += count;
        return std::uint32_t(first);
    }
    std::uint32_t addWeights(double const *weights, int count) {
        std::size_t const first = _weights.size();
        _weights.insert(_weights.end(), weights, weights + count);
        return std::uint32_t(first);
    }
    // Position of the weights of plain faces of a size, which make() adds.
    template <typename MAKE>
    std::uint32_t find(std::vector<std::uint32_t> &positions, int size, MAKE make) {
        if (positions.size() <= std::size_t(size)) {
            positions.resize(std::size_t(size) + 1, kNone);
        }
        std::uint32_t &first = positions[std::size_t(size)];
        if (first == kNone) {
            first = make();
        }
        return first;
    }
    // The weights of corner 0 of plain faces, twice in a row.
    std::uint32_t getPlainWeights(int size) {
        return find(_plainWeights, size, [&] {
            double const *const mask = _rules.GetCirculantRule(size).GetRow(0);
            std::uint32_t const first = addWeights(mask, size);
            addWeights(mask, size);
            return first;
        });
    }
    SumOrder getSumOrder(Index vert) const {
        if (vert >= _firstNewVertex) {
            return SumOrder::LastTwo;
        }
        return vert >= _firstOlderVertex ? SumOrder::FirstTwo : SumOrder::InTurn;
    }

    // Behind the vertices that follow one and have its order.
    Index getEndOfOrder(Index vert) const {
        return vert >= _firstNewVertex     ? _level.numVertices
               : vert >= _firstOlderVertex ? _firstNewVertex
                                           : _firstOlderVertex;
    }

    static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

    RefinementRules const &_rules;
    Refinement const &_refinement;
    Refinement const *_before;
    Level const &_level;
    std::size_t _numIndices;
    std::vector<float> &_weights;
    DeviceRefinement &_result;
    Index _firstNewVertex;                     // F-vertices of the level before ...
    Index _firstOlderVertex;                   // ... and of the level before that
    std::vector<std::uint32_t> _plainWeights;  // by size, twice in a row
    std::vector<std::uint32_t> _vertexWeights; // of plain vertices, by their number of faces
    std::vector<std::uint32_t> _weightsByFace; // by position in those of the rules
    std::vector<Index> _listedFaces;           // F-faces
    std::vector<std::uint32_t> _firstIndices;  // of those
    std::vector<Index> _truncationSources;
    std::unordered_map<double const *, std::uint32_t> _rowWeights; // of rows of dense rules
};

void Maker::planFaces() {
    // Vertices of F-faces follow one another.
    Index const numFFaces = _result.numConsecutiveCorners > 0 ? _level.numFFaces : 0;
    std::vector<Range> ranges;
    ForEachRun(
        0, _level.numFaces, findFacesInNoRun(),
        [&](Index begin, Index end, Index) {
            append(ranges, {begin, end, 0}, numFFaces,
                   [&](Index face) { return _level.GetFaceSize(face); });
        },
        [&](Index face, Index) { listFace(face); });
    for (Range const &range : ranges) {
        if (isRun(range, ranges)) {
            addRun(range);
        } else {
            for (Index face = range.begin; face < range.end; ++face) {
                listFace(face);
            }
        }
    }
}

void Maker::addRun(Range const &range) {
    PlainFaceMask const mask = MakePlainFaceMask(_rules.GetCirculantRule(range.size));
    bool const isWeighted = !mask.weights.empty();
    _result.faceRuns.push_back({range.size, std::uint32_t(range.end - range.begin),
                                std::uint32_t(_level.faceFirstCorner[std::size_t(range.begin)]),
                                isWeighted, isWeighted ? getPlainWeights(range.size) : 0, mask.all,
                                mask.self, mask.neighbor, mask.opposite});
    listDenseCorners(range);
}

// Whether a corner has the row of the circulant rule of the face's size.
bool Maker::isCirculant(FaceRule const &rule, int corner) const {
    return rule.IsCirculant() ||
           rule.GetRow(corner) == _rules.GetCirculantRule(rule.GetSize()).GetRow(corner);
}

// Faces without any corner in a run.
std::vector<Index> Maker::findFacesInNoRun() const {
    std::vector<Index> faces;
    _rules.ForEachDenseFace(0, _level.numFaces, [&](Index face, int number) {
        FaceRule const rule = _rules.GetDenseRule(number);
        bool isInRun = false;
        for (int i = 0; i < rule.GetSize(); ++i) {
            isInRun = isInRun || isCirculant(rule, i);
        }
        if (!isInRun) {
            faces.push_back(face);
        }
    });
    return faces;
}

// Behind runs, which make all F-vertices of their faces: these few again.
void Maker::listDenseCorners(Range const &run) {
    _rules.ForEachDenseFace(run.begin, run.end, [&](Index face, int number) {
        FaceRule const rule = _rules.GetDenseRule(number);
        std::uint32_t const firstIndex = takeIndicesOf(face);
        for (int i = 0; i < rule.GetSize(); ++i) {
            if (!isCirculant(rule, i)) {
                listCorner(face, i, firstIndex);
            }
        }
    });
}

// Position of the vertices of a face.
std::uint32_t Maker::takeIndicesOf(Index face) {
    auto const firstCorner = std::uint32_t(_level.faceFirstCorner[std::size_t(face)]);
    if (firstCorner >= _result.numConsecutiveCorners) {
        return _result.firstListedVertex + (firstCorner - _result.numConsecutiveCorners);
    }
    _listedFaces.push_back(face);
    _firstIndices.push_back(takeIndices(std::size_t(_level.GetFaceSize(face))));
    return _firstIndices.back();
}

void Maker::listFace(Index face) {
    std::uint32_t const firstIndex = takeIndicesOf(face);
    for (int i = 0; i < _level.GetFaceSize(face); ++i) {
        listCorner(face, i, firstIndex);
    }
}

void Maker::listCorner(Index face, int corner, std::uint32_t firstIndex) {
    FaceRule const rule = _rules.GetFaceRule(face);
    int const size = rule.GetSize();
    std::uint32_t firstWeight = 0;
    if (isCirculant(rule, corner)) {
        firstWeight = getPlainWeights(size) + std::uint32_t(size - corner);
    } else {
        double const *const row = rule.GetRow(corner);
        auto const [found, isNew] = _rowWeights.try_emplace(row);
        if (isNew) {
            found->second = addWeights(row, size);
        }
        firstWeight = found->second;
    }
    _result.corners.push_back({std::uint32_t(_level.faceFirstCorner[std::size_t(face)] + corner),
                               std::uint32_t(size), firstIndex, firstWeight});
}

void Maker::planVertices() {
    if (!_refinement.vVertexParents.empty()) {
        for (Index vert : _refinement.vVertexParents) {
            listVertex(vert);
        }
        return;
    }
    if (_result.numVVertices == 0) {
        return;
    }
    std::vector<Index> ruled;
    for (RefinementRules::RuledVertex const &vertex : _rules.GetRuledVertices()) {
        ruled.push_back(vertex.vert);
    }
    for (Index vert = 0; vert < _rules.GetEndOfVertexWeights(); ++vert) {
        if (_rules.GetVertexWeights(vert) != RefinementRules::kPlain) {
            ruled.push_back(vert);
        }
    }
    if (_rules.GetEndOfVertexWeights() > 0) {
        FarExt::internal::SortUnique(ruled);
    }
    std::vector<Range> ranges;
    ForEachRun(
        0, _level.numVertices, ruled,
        [&](Index begin, Index end, Index) {
            while (begin < end) {
                Index const behind = std::min(end, getEndOfOrder(begin));
                append(ranges, {begin, behind, 0, getSumOrder(begin)}, -1,
                       [&](Index vert) { return _level.GetNumVertexFaces(vert); });
                begin = behind;
            }
        },
        [&](Index vert, Index) { listVertex(vert); });
    for (Range const &range : ranges) {
        auto const count = std::uint32_t(range.end - range.begin);
        if (range.size == kRunValence && isRun(range, ranges)) {
            std::uint32_t const firstIndex =
                _result.averagesFaces ? takeIndices(std::size_t(count) * kRunValence) : 0;
            _result.vertexRuns.push_back(
                {count, std::uint32_t(range.begin), firstIndex, range.order == SumOrder::InTurn});
        } else {
            for (Index vert = range.begin; vert < range.end; ++vert) {
                if (_result.averagesFaces) {
                    listPlainVertex(vert);
                } else {
                    listVertex(vert);
                }
            }
        }
    }
}

void Maker::listPlainVertex(Index vert) {
    int const numFaces = _level.GetNumVertexFaces(vert);
    std::uint32_t const firstWeight = find(_vertexWeights, numFaces, [&] {
        double const weight = _rules.GetPlainVertexMask(numFaces).vertexWeight;
        return addWeights(&weight, 1);
    });
    // Written member by member, not copied from a temporary (benchmark OpenGL, preparation/triangle/small:
    // 1.1 times as fast).
    DeviceVertex &vertex = _result.vertices.emplace_back();
    vertex.child = std::uint32_t(vert);
    vertex.numSources = 0;
    vertex.numCorners = std::uint32_t(numFaces);
    vertex.firstIndex = takeIndices(std::size_t(numFaces));
    vertex.firstWeight = firstWeight;
}

void Maker::listVertex(Index vert) {
    VertexRule const rule = _rules.GetVertexRule(vert);
    int const numCorners = rule.HasFaces() ? _level.GetNumVertexFaces(vert) : 0;
    std::uint32_t const firstIndex =
        takeIndices(std::size_t(rule.numSources) + std::size_t(numCorners));
    auto const addAll = [&] {
        std::uint32_t const firstWeight = addWeights(rule.weights, rule.numSources);
        addWeights(rule.faceWeights ? rule.faceWeights : &rule.faceWeight,
                   rule.faceWeights ? numCorners : 1);
        return firstWeight;
    };
    // Rules with weights by face share these weights.
    std::uint32_t const firstWeight =
        rule.faceWeights ? find(_weightsByFace,
                                int(rule.faceWeights - _rules.GetAllVertexWeights().data()), addAll)
                         : addAll();
    std::uint32_t const flag = rule.faceWeights ? DeviceVertex::kEachHasAWeight : 0;
    _result.vertices.push_back({std::uint32_t(_refinement.GetVertexChildVertex(vert)),
                                std::uint32_t(rule.numSources), std::uint32_t(numCorners) | flag,
                                firstIndex, firstWeight});
}

// All vertices have sources in the parent alone.
void Maker::planTruncation() {
    FarExt::internal::TruncationMask const mask(_refinement, _rules.GetInterpolation());
    FarExt::internal::TruncationMask::Sources sources;
    for (Index cVert = 0; cVert < _refinement.child->numVertices; ++cVert) {
        mask.GetSources(cVert, sources);
        auto const numSources = std::uint32_t(sources.verts.size());
        std::uint32_t const firstIndex = takeIndices(numSources);
        _result.vertices.push_back({std::uint32_t(cVert), numSources, 0, firstIndex,
                                    addWeights(sources.weights.data(), int(numSources))});
        _truncationSources.insert(_truncationSources.end(), sources.verts.begin(),
                                  sources.verts.end());
    }
}

void Maker::Fill(std::int32_t *indices) const {
    if (_refinement.isTruncation) {
        // Sources in level 0 come first of all indices.
        std::copy(_truncationSources.begin(), _truncationSources.end(), indices);
        return;
    }
    std::copy(_level.faceVerts.begin() + _result.numConsecutiveCorners, _level.faceVerts.end(),
              indices + _result.firstListedVertex);
    for (std::size_t i = 0; i < _listedFaces.size(); ++i) {
        Far::ConstIndexArray const verts = _level.GetFaceVertices(_listedFaces[i]);
        std::copy(verts.begin(), verts.end(), indices + _firstIndices[i]);
    }
    for (DeviceVertexRun const &run : _result.vertexRuns) {
        if (_result.averagesFaces) {
            // Sums in the order of the first two are turned by one, so that all sums but those
            // in turn add the last two first.
            bool const isTurned = getSumOrder(Index(run.firstVertex)) == SumOrder::FirstTwo;
            Index const order[kRunValence] = {isTurned ? 2 : 0, isTurned ? 0 : 1, isTurned ? 1 : 2};
            Index const first = _level.vertFirstFace[std::size_t(run.firstVertex)];
            ParallelFor(Index(run.count), [&](Index i) {
                std::int32_t *const corners =
                    indices + run.firstIndex + std::size_t(i) * kRunValence;
                for (Index k = 0; k < kRunValence; ++k) {
                    corners[k] = _level.GetVertexCorner(first + i * kRunValence + order[k]);
                }
            });
        }
    }
    for (DeviceVertex const &vertex : _result.vertices) {
        Index const vert = _refinement.GetVVertexParent(Index(vertex.child));
        std::int32_t *next = indices + vertex.firstIndex;
        if (vertex.numSources > 0) {
            VertexRule const rule = _rules.GetVertexRule(vert);
            next = std::copy_n(rule.sources, rule.numSources, next);
        }
        Index const firstFace = _level.vertFirstFace[std::size_t(vert)];
        for (std::uint32_t i = 0; i < vertex.GetNumCorners(); ++i) {
            *next++ = _level.GetVertexCorner(firstFace + Index(i));
        }
    }
}

} // namespace

FarExt::CallStatus MakeDeviceRefinements(
    std::vector<Refinement const *> const &refinements,
    std::vector<std::shared_ptr<RefinementRules const>> const &rules, std::vector<float> &weights,
    std::vector<DeviceRefinement> &result,
    std::function<FarExt::CallStatus(
        std::size_t numIndices, std::function<void(std::int32_t *)> const &fill)> const &write) {
    std::vector<Maker> makers;
    std::size_t numIndices = 0;
    result.resize(refinements.size());
    for (std::size_t i = 0; i < refinements.size(); ++i) {
        makers.emplace_back(*rules[i], *refinements[i], i > 0 ? refinements[i - 1] : nullptr,
                            numIndices, weights, result[i]);
        makers.back().Plan();
        numIndices = makers.back().GetNumIndices();
    }
    constexpr std::size_t kMaxSize = std::numeric_limits<std::uint32_t>::max();
    if (std::max(numIndices, weights.size()) > kMaxSize) {
        return FarExt::internal::Failure(FarExt::StatusCode::TooLarge,
                                         "the refinements have " + std::to_string(numIndices) +
                                             " indices and " + std::to_string(weights.size()) +
                                             " weights, more than 32 bits reach");
    }
    return write(numIndices, [&](std::int32_t *indices) {
        for (Maker const &maker : makers) {
            maker.Fill(indices);
        }
    });
}

} // namespace OpenSubdivHex::OsdExt::internal
