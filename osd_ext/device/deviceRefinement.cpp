// SPDX-License-Identifier: Apache-2.0
#include "deviceRefinement.h"

#include "far_ext/vtr/parallel.h"
#include "far_ext/vtr/runs.h"
#include "far_ext/vtr/truncationMask.h"

#include <algorithm>
#include <limits>

namespace OpenSubdivHex::OsdExt::internal {

using Far::Index;
using FarExt::internal::ForEachRun;
using FarExt::internal::Level;
using FarExt::internal::ParallelFor;
using FarExt::internal::Refinement;
using FarExt::internal::RefinementMask;

namespace {

constexpr int kRunValence = 3;

// Runs of fewer faces or vertices are listed: each run is work of its own for the device.
constexpr Index kMinRun = 256;
// Faces of more sides are listed: of those in runs a kernel holds all vertices at once.
constexpr int kMaxRunFaceSize = 12;

// Components [begin, end) that are alike.
struct Range {
    Index begin;
    Index end;
    int size; // of faces; of vertices, the number of faces
};

// Adds one component, or some.
void append(std::vector<Range> &ranges, Range const &range, Index mayNotJoinAt) {
    FarExt::internal::AppendRun(ranges, range, [=](Range const &a, Range const &b) {
        return a.size == b.size && b.begin != mayNotJoinAt;
    });
}

// Prepares one refinement, in two passes: the first finds what is in runs, and so the number of
// indices; the second writes them.
class Maker {
public:
    Maker(RefinementMask const &mask, Refinement const &refinement, Refinement const *before,
          std::size_t firstIndex, std::vector<float> &weights)
        : _mask(mask), _refinement(refinement), _before(before), _level(*refinement.parent),
          _numIndices(firstIndex), _weights(weights) {
        _result.numVVertices = refinement.child->numVVertices;
        FarExt::VertexVertexMask const plain = mask.GetPlainVertexMask(kRunValence);
        _result.vertexWeight = float(plain.vertexWeight);
        _result.averagesFaces = plain.faceWeight != 0;
    }

    void Plan() {
        if (_refinement.isTruncation) {
            planTruncation();
            return;
        }
        planFaces();
        planVertices();
    }
    std::size_t GetNumIndices() const { return _numIndices; }
    DeviceRefinement Take(std::int32_t *indices) {
        fill(indices);
        return std::move(_result);
    }

private:
    void planFaces();
    void planVertices();
    void planTruncation();
    void addRun(Range const &range);
    void listFace(Index face);
    void listIrregularCorners(Range const &run);
    std::uint32_t takeIndicesOf(Index face);
    void listVertex(Index vert);
    void fill(std::int32_t *indices) const;

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
    // The weights of corner 0 of plain faces, twice in a row.
    std::uint32_t getPlainWeights(int size) {
        if (_plainWeights.size() <= std::size_t(size)) {
            _plainWeights.resize(std::size_t(size) + 1, kNone);
        }
        std::uint32_t &first = _plainWeights[std::size_t(size)];
        if (first == kNone) {
            first = addWeights(_mask.GetPlainFaceWeights(size), size);
            addWeights(_mask.GetPlainFaceWeights(size), size);
        }
        return first;
    }

    static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

    RefinementMask const &_mask;
    Refinement const &_refinement;
    Refinement const *_before;
    Level const &_level;
    std::size_t _numIndices;
    std::vector<float> &_weights;
    std::vector<std::uint32_t> _plainWeights; // by size
    std::vector<Index> _listedFaces;
    std::vector<std::uint32_t> _firstIndices; // of those
    std::vector<Index> _truncationSources;
    DeviceRefinement _result;
    std::vector<double> _scratch;
};

void Maker::planFaces() {
    // Vertices of F-faces follow one another.
    Index const numFFaces = _before && _level.isHexagonal ? _level.numFFaces : 0;
    std::vector<Range> ranges;
    ForEachRun(
        0, _level.numFaces, _mask.FindSharpFaces(),
        [&](Index begin, Index end, Index) {
            for (Index face = begin; face < end; ++face) {
                append(ranges, {face, face + 1, _level.GetFaceSize(face)}, numFFaces);
            }
        },
        [&](Index face, Index) { listFace(face); });
    for (Range const &range : ranges) {
        if (range.end - range.begin >= kMinRun && range.size <= kMaxRunFaceSize) {
            addRun(range);
        } else {
            for (Index face = range.begin; face < range.end; ++face) {
                listFace(face);
            }
        }
    }
}

void Maker::addRun(Range const &range) {
    Index const firstCorner = _level.faceFirstCorner[std::size_t(range.begin)];
    Index const endCorner = _level.faceFirstCorner[std::size_t(range.end)];
    bool const areConsecutive = _before && _level.isHexagonal && range.end <= _level.numFFaces;
    std::uint32_t const first = areConsecutive
                                    ? std::uint32_t(_before->GetCornerChildVertex(firstCorner))
                                    : takeIndices(std::size_t(endCorner - firstCorner));
    _result.faceRuns.push_back({range.size, std::uint32_t(range.end - range.begin),
                                std::uint32_t(firstCorner), areConsecutive, first,
                                getPlainWeights(range.size)});
    listIrregularCorners(range);
}

// Behind runs, which make all F-vertices of their faces: these few again.
void Maker::listIrregularCorners(Range const &run) {
    Index const firstCorner = _level.faceFirstCorner[std::size_t(run.begin)];
    Index const endCorner = _level.faceFirstCorner[std::size_t(run.end)];
    Index endOfFace = firstCorner;
    std::uint32_t firstIndex = 0;
    for (FarExt::internal::IrregularCorner const &irregular :
         _mask.GetIrregularCorners(firstCorner, endCorner)) {
        Index const corner = irregular.corner;
        if (corner >= endOfFace) {
            Index const face = _level.FindFaceOfCorner(corner);
            endOfFace = _level.faceFirstCorner[std::size_t(face) + 1];
            firstIndex = takeIndicesOf(face);
        }
        double const *const weights = _mask.GetFaceVertexWeights(
            _listedFaces.back(), corner - (endOfFace - run.size), _scratch);
        _result.corners.push_back({std::uint32_t(corner), std::uint32_t(run.size), firstIndex,
                                   addWeights(weights, run.size)});
    }
}

std::uint32_t Maker::takeIndicesOf(Index face) {
    _listedFaces.push_back(face);
    _firstIndices.push_back(takeIndices(std::size_t(_level.GetFaceSize(face))));
    return _firstIndices.back();
}

void Maker::listFace(Index face) {
    int const size = _level.GetFaceSize(face);
    Index const firstCorner = _level.faceFirstCorner[std::size_t(face)];
    std::uint32_t const firstIndex = takeIndicesOf(face);
    bool const isPlain = _mask.IsFacePlain(face);
    for (int i = 0; i < size; ++i) {
        std::uint32_t const firstWeight =
            isPlain ? getPlainWeights(size) + std::uint32_t(size - i)
                    : addWeights(_mask.GetFaceVertexWeights(face, i, _scratch), size);
        _result.corners.push_back(
            {std::uint32_t(firstCorner + i), std::uint32_t(size), firstIndex, firstWeight});
    }
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
    std::vector<Range> ranges;
    ForEachRun(
        0, _level.numVertices, _mask.FindFeatureVertices(),
        [&](Index begin, Index end, Index) {
            for (Index vert = begin; vert < end; ++vert) {
                append(ranges, {vert, vert + 1, _level.GetNumVertexFaces(vert)}, -1);
            }
        },
        [&](Index vert, Index) { listVertex(vert); });
    for (Range const &range : ranges) {
        auto const count = std::uint32_t(range.end - range.begin);
        if (range.size == kRunValence && range.end - range.begin >= kMinRun) {
            std::uint32_t const firstIndex =
                _result.averagesFaces ? takeIndices(std::size_t(count) * kRunValence) : 0;
            _result.vertexRuns.push_back({count, std::uint32_t(range.begin), firstIndex});
        } else {
            for (Index vert = range.begin; vert < range.end; ++vert) {
                listVertex(vert);
            }
        }
    }
}

void Maker::listVertex(Index vert) {
    RefinementMask::VertexMask const mask = _mask.GetVertexMask(vert);
    int const numCorners = mask.faceWeight != 0 ? _level.GetNumVertexFaces(vert) : 0;
    std::uint32_t const firstIndex =
        takeIndices(std::size_t(mask.numSources) + std::size_t(numCorners));
    std::uint32_t const firstWeight = addWeights(mask.weights, mask.numSources);
    addWeights(&mask.faceWeight, 1);
    _result.vertices.push_back({std::uint32_t(_refinement.GetVertexChildVertex(vert)),
                                std::uint32_t(mask.numSources), std::uint32_t(numCorners),
                                firstIndex, firstWeight});
}

// All vertices have sources in the parent alone.
void Maker::planTruncation() {
    FarExt::internal::TruncationMask const mask(_refinement, _mask.GetInterpolation());
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

void Maker::fill(std::int32_t *indices) const {
    if (_refinement.isTruncation) {
        // Those of level 0 are the first of all.
        std::copy(_truncationSources.begin(), _truncationSources.end(), indices);
        return;
    }
    for (DeviceFaceRun const &run : _result.faceRuns) {
        if (!run.areConsecutive) {
            Index const *const verts = _level.faceVerts.data() + run.firstCorner;
            ParallelFor(Index(run.count), [&](Index i) {
                std::size_t const place = std::size_t(i) * std::size_t(run.size);
                std::copy_n(verts + place, run.size, indices + run.first + place);
            });
        }
    }
    for (std::size_t i = 0; i < _listedFaces.size(); ++i) {
        Far::ConstIndexArray const verts = _level.GetFaceVertices(_listedFaces[i]);
        std::copy(verts.begin(), verts.end(), indices + _firstIndices[i]);
    }
    for (DeviceVertexRun const &run : _result.vertexRuns) {
        if (_result.averagesFaces) {
            Index const first = _level.vertFirstFace[std::size_t(run.firstVertex)];
            ParallelFor(Index(run.count) * kRunValence, [&](Index k) {
                indices[run.firstIndex + std::size_t(k)] = _level.GetVertexCorner(first + k);
            });
        }
    }
    for (DeviceVertex const &vertex : _result.vertices) {
        Index const vert = _refinement.GetVVertexParent(Index(vertex.child));
        RefinementMask::VertexMask const mask = _mask.GetVertexMask(vert);
        std::int32_t *next =
            std::copy_n(mask.sources, mask.numSources, indices + vertex.firstIndex);
        Index const firstFace = _level.vertFirstFace[std::size_t(vert)];
        for (std::uint32_t i = 0; i < vertex.numCorners; ++i) {
            *next++ = _level.GetVertexCorner(firstFace + Index(i));
        }
    }
}

} // namespace

std::vector<DeviceRefinement>
MakeDeviceRefinements(std::vector<Refinement const *> const &refinements,
                      std::vector<RefinementMask> const &masks, DeviceArrays &arrays) {
    std::vector<Maker> makers;
    std::size_t numIndices = 0;
    for (std::size_t i = 0; i < refinements.size(); ++i) {
        makers.emplace_back(masks[i], *refinements[i], i > 0 ? refinements[i - 1] : nullptr,
                            numIndices, arrays.weights);
        makers.back().Plan();
        numIndices = makers.back().GetNumIndices();
    }
    std::vector<DeviceRefinement> result;
    constexpr std::size_t kMaxSize = std::numeric_limits<std::uint32_t>::max();
    if (std::max(numIndices, arrays.weights.size()) > kMaxSize) {
        return result;
    }
    arrays.indices.Resize(numIndices);
    for (Maker &maker : makers) {
        result.push_back(maker.Take(arrays.indices.data()));
    }
    return result;
}

} // namespace OpenSubdivHex::OsdExt::internal
