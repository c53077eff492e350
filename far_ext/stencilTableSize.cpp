// SPDX-License-Identifier: Apache-2.0
#include "stencilTableSize.h"

#include "fvarLevel.h"
#include "symbolicTable.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace OpenSubdivHex::FarExt::internal {

using Far::ConstIndexArray;
using Far::Index;

namespace {

// How many weights a step's stencils have.
struct StepWeights {
    double ofFVertices = 0;
    double ofVVertices = 0;
    double Total() const { return ofFVertices + ofVVertices; }
};

// The sizes of stencils that refer to the level before, if faces share no more than edges.
StepWeights countUnfactorizedWeights(StencilPlan const &plan, int level) {
    TopologyLevel const pLevel = plan.GetLevel(level - 1);
    LevelTopology const &topology = pLevel.GetTopology();
    RefinementMask const mask(pLevel, plan.refiner.GetHexSchemeOptions(), plan.interpolation);
    StepWeights result;
    for (Index face = 0; face < pLevel.GetNumFaces(); ++face) {
        double const size = pLevel.GetFaceVertices(face).size();
        result.ofFVertices += size * size;
    }
    for (Index cVert = 0; cVert < topology.numVVertices; ++cVert) {
        Index const pVert = topology.GetVVertexParent(cVert);
        auto const weights = mask.GetVertexMask(pVert);
        ConstIndexArray const faces = pLevel.GetVertexFaces(pVert);
        if (!(weights.faceWeight > 0) || faces.empty()) {
            result.ofVVertices += 1 + weights.numNeighbors;
            continue;
        }
        // The vertex, its neighbors, and the rest of each face.
        result.ofVVertices += 1 + pLevel.GetVertexEdges(pVert).size();
        for (Index face : faces) {
            result.ofVVertices += pLevel.GetFaceVertices(face).size() - 3;
        }
    }
    return result;
}

// Estimates the sizes of stencils from those of some faces.
class WeightSampler {
public:
    explicit WeightSampler(StencilPlan const &plan) : _plan(plan) {}

    // Forms the supports of the first levels of the sample.
    Status Form();
    StepWeights Estimate(int level) const;

private:
    static constexpr int kMaxSampledLevel = 4;
    static constexpr Index kMaxSampledFaces = 128;
    static constexpr Index kMaxLargeFaces = 32;

    // Faces, and how many corners and vertices of a level they have; a vertex counts as a part for
    // each of its faces.
    struct Stratum {
        std::vector<Index> baseFaces;
        std::vector<std::vector<Index>> faces; // of the mesh, or the value mesh, by level
        double numCorners = 0;
        double numVerts = 0;
        StepWeights weights; // of the stencils made of these
    };

    void countIsolated();
    void takeSample();
    std::vector<Index> getFaces(int level, std::vector<Index> const &meshFaces) const;
    std::vector<Index> findMade(int level) const;
    void count(int level, std::vector<Index> const &made, int const *sizes, Stratum &stratum) const;
    StepWeights average(int level) const;

    StencilPlan const &_plan;
    Stratum _large;  // the faces with the most sides, when they have far more than others
    Stratum _sample; // of the rest
    std::vector<Index> _numIsolated;    // V-vertices without a face, by level, from 1 on
    std::vector<StepWeights> _averages; // by level, from 1 on: per stencil
};

void WeightSampler::countIsolated() {
    TopologyLevel const base = _plan.GetLevel(0);
    std::vector<Index> isolated;
    for (Index vert = 0; vert < base.GetNumVertices(); ++vert) {
        if (base.GetVertexFaces(vert).empty()) {
            isolated.push_back(vert);
        }
    }
    for (int level = 1; level <= _plan.lastLevel; ++level) {
        TopologyLevel const pLevel = _plan.GetLevel(level - 1);
        for (Index &vert : isolated) {
            vert = pLevel.GetVertexChildVertex(vert);
        }
        isolated.erase(std::remove(isolated.begin(), isolated.end(), Far::INDEX_INVALID),
                       isolated.end());
        _numIsolated.push_back(Index(isolated.size()));
    }
}

void WeightSampler::takeSample() {
    TopologyLevel const &base = _plan.refiner.GetLevel(0);
    Index const numFaces = base.GetNumFaces();
    std::vector<Index> faces(numFaces);
    std::iota(faces.begin(), faces.end(), 0);
    if (numFaces > kMaxSampledFaces) {
        auto const isLarge = [&](Index face) {
            return std::int64_t(base.GetFaceVertices(face).size()) * numFaces >
                   2 * std::int64_t(base.GetNumFaceVertices());
        };
        auto const largeEnd = std::stable_partition(faces.begin(), faces.end(), isLarge);
        std::stable_sort(faces.begin(), largeEnd, [&](Index a, Index b) {
            return base.GetFaceVertices(a).size() > base.GetFaceVertices(b).size();
        });
        auto const numLarge = std::min(largeEnd - faces.begin(), std::ptrdiff_t(kMaxLargeFaces));
        _large.baseFaces.assign(faces.begin(), faces.begin() + numLarge);
        faces.erase(faces.begin(), faces.begin() + numLarge);
        std::sort(faces.begin(), faces.end());
    }
    auto const numRest = std::int64_t(faces.size());
    std::int64_t const numSampled = std::min(numRest, std::int64_t(kMaxSampledFaces));
    for (std::int64_t i = 0; i < numSampled; ++i) {
        // One in each of equal ranges, at places in them that no regular numbering of the mesh
        // meets: the fractional parts of multiples of the golden ratio.
        std::int64_t const begin = i * numRest / numSampled;
        std::int64_t const end = (i + 1) * numRest / numSampled;
        double const golden = 0.6180339887498949 * double(i);
        double const place = (golden - std::floor(golden)) * double(end - begin);
        _sample.baseFaces.push_back(faces[begin + std::int64_t(place)]);
    }
}

// The faces of the value mesh that faces of the mesh have.
std::vector<Index> WeightSampler::getFaces(int level, std::vector<Index> const &meshFaces) const {
    if (_plan.channel < 0) {
        return meshFaces;
    }
    FVarLevel const &channel =
        *_plan.refiner.GetLevel(level).GetTopology().fvarLevels[_plan.channel];
    std::vector<Index> faces;
    for (Index face : meshFaces) {
        faces.push_back(channel.valueFaces[face]);
        if (FVarLevel::SplitFace const *split = channel.FindSplitFace(face)) {
            faces.push_back(split->valueFaces[1]);
        }
    }
    return faces;
}

// The vertices made of the corners, one for each face, and the vertices of all strata.
std::vector<Index> WeightSampler::findMade(int level) const {
    TopologyLevel const pLevel = _plan.GetLevel(level - 1);
    LevelTopology const &topology = pLevel.GetTopology();
    std::vector<Index> verts;
    for (Stratum const *stratum : {&_large, &_sample}) {
        for (Index pFace : stratum->faces[level - 1]) {
            verts.push_back(topology.GetCornerChildVertex(pLevel.GetFaceFirstCorner(pFace)));
            for (Index pVert : pLevel.GetFaceVertices(pFace)) {
                if (Index const cVert = topology.GetVertexChildVertex(pVert);
                    cVert != Far::INDEX_INVALID) {
                    verts.push_back(cVert);
                }
            }
        }
    }
    std::sort(verts.begin(), verts.end());
    verts.erase(std::unique(verts.begin(), verts.end()), verts.end());
    return verts;
}

void WeightSampler::count(int level, std::vector<Index> const &made, int const *sizes,
                          Stratum &stratum) const {
    TopologyLevel const pLevel = _plan.GetLevel(level - 1);
    LevelTopology const &topology = pLevel.GetTopology();
    auto const sizeOf = [&](Index cVert) {
        return sizes[std::lower_bound(made.begin(), made.end(), cVert) - made.begin()];
    };
    stratum.numCorners = stratum.numVerts = 0;
    stratum.weights = StepWeights();
    for (Index pFace : stratum.faces[level - 1]) {
        Index const first = pLevel.GetFaceFirstCorner(pFace);
        ConstIndexArray const pVerts = pLevel.GetFaceVertices(pFace);
        stratum.numCorners += pVerts.size();
        stratum.weights.ofFVertices +=
            double(pVerts.size()) * sizeOf(topology.GetCornerChildVertex(first));
        for (Index pVert : pVerts) {
            Index const cVert = topology.GetVertexChildVertex(pVert);
            if (cVert != Far::INDEX_INVALID) {
                double const share = 1.0 / pLevel.GetVertexFaces(pVert).size();
                stratum.numVerts += share;
                stratum.weights.ofVVertices += share * sizeOf(cVert);
            }
        }
    }
}

// What the large faces do not have is as in the sample.
StepWeights WeightSampler::average(int level) const {
    LevelTopology const &parent = _plan.GetLevel(level - 1).GetTopology();
    auto const combine = [](double all, double large, double largeWeights, double sampled,
                            double sampledWeights) {
        double const rest = sampled > 0 ? (all - large) * sampledWeights / sampled : 0;
        return all > 0 ? (largeWeights + rest) / all : 0;
    };
    return {combine(parent.numCorners, _large.numCorners, _large.weights.ofFVertices,
                    _sample.numCorners, _sample.weights.ofFVertices),
            combine(parent.numVVertices - _numIsolated[level - 1], _large.numVerts,
                    _large.weights.ofVVertices, _sample.numVerts, _sample.weights.ofVVertices)};
}

Status WeightSampler::Form() {
    StencilPlan plan = _plan;
    plan.firstStored = 1;
    plan.lastLevel = std::min(_plan.lastLevel, kMaxSampledLevel);
    plan.numControlStencils = 0;
    if (plan.lastLevel == 0) {
        return Status();
    }
    countIsolated();
    takeSample();
    for (Stratum *stratum : {&_large, &_sample}) {
        auto const meshFaces = FindFacesOfBaseFaces(
            plan.refiner,
            ConstIndexArray(stratum->baseFaces.data(), int(stratum->baseFaces.size())),
            plan.lastLevel - 1);
        for (int level = 0; level < plan.lastLevel; ++level) {
            stratum->faces.push_back(getFaces(level, meshFaces[level]));
        }
    }
    std::vector<std::vector<Index>> wanted(1);
    for (int level = 1; level <= plan.lastLevel; ++level) {
        wanted.push_back(findMade(level));
    }
    StencilSelection const selection(plan, std::move(wanted));
    SymbolicTable symbolic(plan, selection);
    if (Status status = symbolic.Form(); !status.IsOk()) {
        return status;
    }
    for (int level = 1; level <= plan.lastLevel; ++level) {
        std::vector<Index> const made =
            FindMadeVertices(_plan.GetLevel(level - 1), selection.parts[level - 1]);
        int const *const sizes = symbolic.GetSizes(level);
        count(level, made, sizes, _large);
        count(level, made, sizes, _sample);
        _averages.push_back(average(level));
    }
    return Status();
}

StepWeights WeightSampler::Estimate(int level) const {
    LevelTopology const &parent = _plan.GetLevel(level - 1).GetTopology();
    int const numSampled = int(_averages.size());
    StepWeights average = _averages[std::min(level, numSampled) - 1];
    if (level > numSampled) {
        // Supports grow towards a limit, each level by half as much as the one before.
        StepWeights const &before = _averages[numSampled - 2];
        double const growth = 1 - std::ldexp(1.0, numSampled - level);
        average.ofFVertices += growth * (average.ofFVertices - before.ofFVertices);
        average.ofVVertices += growth * (average.ofVVertices - before.ofVVertices);
    }
    Index const numIsolated = _numIsolated[level - 1];
    return {average.ofFVertices * parent.numCorners,
            average.ofVVertices * (parent.numVVertices - numIsolated) + numIsolated};
}

// Bytes that the supports of a step take, by what StepSupports keeps.
double estimateSupportBytes(StencilPlan const &plan, int level, StepWeights const &weights) {
    TopologyLevel const pLevel = plan.GetLevel(level - 1);
    double const cornersPerFace = double(pLevel.GetNumFaceVertices()) / pLevel.GetNumFaces();
    bool const keepsVertices = plan.factorize && level < plan.lastLevel;
    // Of the first two steps most supports have lists of their own, then from step to step fewer;
    // what is added for a V-vertex is about a quarter of what it depends on.
    double const share = plan.factorize ? std::ldexp(1.0, std::min(0, 2 - level)) : 1;
    double const numSources = share * (weights.ofFVertices / cornersPerFace +
                                       weights.ofVVertices * (keepsVertices ? 1 : 0.25));
    double const numSupports =
        pLevel.GetNumFaces() + (keepsVertices ? double(plan.GetNumVertices(level))
                                              : 2.0 * pLevel.GetTopology().numVVertices);
    return numSources * sizeof(Index) + numSupports * sizeof(Support);
}

} // namespace

Status EstimateTableSize(StencilPlan const &plan, std::size_t weightBytes, StencilTableSize &size) {
    WeightSampler sampler(plan);
    if (plan.factorize) {
        if (Status status = sampler.Form(); !status.IsOk()) {
            return status;
        }
    }
    size = StencilTableSize();
    size.numStencils = plan.numControlStencils;
    double numWeights = plan.numControlStencils;
    double numSupportBytes = 0;
    double numRowBytes = 0; // of the level before the last, when it is not in the table
    double numSourceBytes = 0;
    for (int level = plan.firstBuilt; level <= plan.lastLevel; ++level) {
        StepWeights const weights =
            plan.factorize ? sampler.Estimate(level) : countUnfactorizedWeights(plan, level);
        if (level >= plan.firstStored) {
            size.numStencils += plan.GetNumVertices(level);
            numWeights += weights.Total();
        } else if (level == plan.lastLevel - 1) {
            numRowBytes =
                weights.Total() * weightBytes + double(plan.GetNumVertices(level)) * sizeof(Index);
        }
        numSupportBytes += estimateSupportBytes(plan, level, weights);
        if (!plan.HasParentStencils(level)) {
            numSourceBytes +=
                double(plan.GetNumVertices(level - 1)) * (3 * sizeof(Index) + sizeof(Support));
        }
    }
    size.numWeights = std::llround(numWeights);
    size.numBytes = size.numStencils * std::int64_t(sizeof(int) + sizeof(Index)) +
                    size.numWeights * std::int64_t(sizeof(Index) + weightBytes);
    size.numPeakBytes =
        size.numBytes + std::llround(numSupportBytes + numRowBytes + numSourceBytes);
    return Status();
}

} // namespace OpenSubdivHex::FarExt::internal
