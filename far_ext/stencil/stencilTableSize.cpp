// SPDX-License-Identifier: Apache-2.0
#include "stencilTableSize.h"

#include "symbolicTable.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace OpenSubdivHex::FarExt::internal {

using Far::ConstIndexArray;
using Far::Index;

namespace {

// How many weights the rows of a refinement have.
struct RowWeights {
    double ofFVertices = 0;
    double ofVVertices = 0;
    double Total() const { return ofFVertices + ofVVertices; }
};

// Those of rows that refer to the level before, if faces share no more than edges.
RowWeights countUnfactorizedWeights(StencilPlan const &plan, int level) {
    Level const &parent = plan.GetLevel(level - 1);
    RefinementRows const rows(plan.GetRefinement(level), plan.schemeOptions, plan.interpolation);
    RowWeights result;
    for (Index face = 0; face < rows.GetNumFaces(); ++face) {
        double const size = rows.GetFaceSize(face);
        result.ofFVertices += size * size;
    }
    for (Index vVertex = 0; vVertex < rows.GetNumVVertices(); ++vVertex) {
        Index const pVert = rows.GetVVertexParent(vVertex);
        auto const mask = rows.GetVertexRule(pVert);
        if (!mask.HasFaces() || !rows.HasVertexFaces(pVert)) {
            rows.ForEachSource(vVertex, mask, [&](Index, double) { ++result.ofVVertices; });
            continue;
        }
        // The vertex, its neighbors, and the rest of each face.
        result.ofVVertices += 1 + parent.GetVertexEdges(pVert).size();
        for (Index face : parent.GetVertexFaces(pVert)) {
            result.ofVVertices += parent.GetFaceSize(face) - 3;
        }
    }
    return result;
}

constexpr int kMaxSampledLevel = 4;
constexpr Index kMaxSampledFaces = 512;

// One face in each of equal ranges, at places in them that no regular numbering of the mesh meets:
// the fractional parts of multiples of the golden ratio.
std::vector<Index> takeSample(std::int64_t numFaces) {
    std::int64_t const numSampled = std::min(numFaces, std::int64_t(kMaxSampledFaces));
    std::vector<Index> result;
    for (std::int64_t i = 0; i < numSampled; ++i) {
        std::int64_t const begin = i * numFaces / numSampled;
        std::int64_t const end = (i + 1) * numFaces / numSampled;
        double const golden = 0.6180339887498949 * double(i);
        double const place = (golden - std::floor(golden)) * double(end - begin);
        result.push_back(Index(begin + std::int64_t(place)));
    }
    return result;
}

// The weights of a row, on average, in the first levels of some base faces, from level 1 on.
CallStatus findAverages(StencilPlan plan, std::vector<RowWeights> &averages) {
    plan.firstStored = 1;
    plan.lastLevel = std::min(plan.lastLevel, kMaxSampledLevel);
    plan.numControlStencils = 0;
    if (plan.lastLevel == 0) {
        return CallStatus();
    }
    std::vector<Index> const faces = takeSample(plan.hierarchy.mesh.levels[0].numFaces);
    StencilSelection const selection(
        plan, FindVerticesOfBaseFaces(plan, ConstIndexArray(faces.data(), int(faces.size()))));
    SymbolicTable symbolic(plan, selection);
    if (CallStatus status = symbolic.Form(); !status.IsOk()) {
        return status;
    }
    for (int level = 1; level <= plan.lastLevel; ++level) {
        std::vector<Index> const made =
            GetMadeVertices(plan.GetRefinement(level), selection.parts[level - 1]);
        auto const numVVertices =
            std::lower_bound(made.begin(), made.end(), plan.GetLevel(level).numVVertices) -
            made.begin();
        int const *const sizes = symbolic.GetSizes(level);
        auto const average = [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
            return std::accumulate(sizes + begin, sizes + end, 0.0) /
                   double(std::max<std::ptrdiff_t>(end - begin, 1));
        };
        averages.push_back(
            {average(numVVertices, std::ptrdiff_t(made.size())), average(0, numVVertices)});
    }
    return CallStatus();
}

// V-vertices without a face, whose rows have one weight: a scheme keeps all of them, or none.
Index countIsolated(StencilPlan const &plan, int level) {
    for (int made = 1; made <= level; ++made) {
        if (plan.GetLevel(made).numVVertices == 0) {
            return 0;
        }
    }
    Level const &base = plan.GetLevel(0);
    Index count = 0;
    for (Index vert = 0; vert < base.numVertices; ++vert) {
        count += base.GetNumVertexFaces(vert) == 0 ? 1 : 0;
    }
    return count;
}

RowWeights estimateWeights(StencilPlan const &plan, int level,
                           std::vector<RowWeights> const &averages) {
    int const numSampled = int(averages.size());
    RowWeights average = averages[std::min(level, numSampled) - 1];
    if (level > numSampled) {
        // Supports grow towards a limit, each level by half as much as the one before.
        RowWeights const &before = averages[numSampled - 2];
        double const growth = 1 - std::ldexp(1.0, numSampled - level);
        average.ofFVertices += growth * (average.ofFVertices - before.ofFVertices);
        average.ofVVertices += growth * (average.ofVVertices - before.ofVVertices);
    }
    Index const numIsolated = countIsolated(plan, level);
    Level const &made = plan.GetLevel(level);
    return {average.ofFVertices * (made.numVertices - made.numVVertices),
            average.ofVVertices * (made.numVVertices - numIsolated) + numIsolated};
}

// Bytes that the supports of a refinement take, by what RowSupports keeps.
double estimateSupportBytes(StencilPlan const &plan, int level, RowWeights const &weights) {
    Level const &parent = plan.GetLevel(level - 1);
    double const cornersPerFace = double(parent.numCorners) / parent.numFaces;
    bool const keepsVertices = plan.factorize && level < plan.lastLevel;
    // Of the first two refinements most supports have lists of their own, then fewer and fewer;
    // what is added for a V-vertex is about a quarter of what it depends on.
    double const share = plan.factorize ? std::ldexp(1.0, std::min(0, 2 - level)) : 1;
    double const numSources = share * (weights.ofFVertices / cornersPerFace +
                                       weights.ofVVertices * (keepsVertices ? 1 : 0.25));
    double const numSupports =
        parent.numFaces + (keepsVertices ? double(plan.GetNumVertices(level))
                                         : 2.0 * plan.GetLevel(level).numVVertices);
    return numSources * sizeof(Index) + numSupports * sizeof(Support);
}

} // namespace

CallStatus EstimateTableSize(StencilPlan const &plan, std::size_t weightBytes,
                             StencilTableSize &size) {
    std::vector<RowWeights> averages;
    if (plan.factorize) {
        if (CallStatus status = findAverages(plan, averages); !status.IsOk()) {
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
        RowWeights const weights = plan.factorize ? estimateWeights(plan, level, averages)
                                                  : countUnfactorizedWeights(plan, level);
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
    return CallStatus();
}

} // namespace OpenSubdivHex::FarExt::internal
