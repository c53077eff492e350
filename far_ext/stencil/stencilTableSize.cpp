// SPDX-License-Identifier: Apache-2.0
#include "stencilTableSize.h"

#include "symbolicTable.h"

#include "far_ext/vtr/indexSet.h"

#include <algorithm>
#include <cmath>

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
        if (!(mask.faceWeight > 0) || !rows.HasVertexFaces(pVert)) {
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

// Estimates the weights of factorized rows from those of some base faces.
class WeightSampler {
public:
    explicit WeightSampler(StencilPlan const &plan) : _plan(plan) {}

    // Forms the supports of the first levels of the sample.
    CallStatus Form();
    RowWeights Estimate(int level) const;

private:
    static constexpr int kMaxSampledLevel = 4;
    static constexpr Index kMaxSampledFaces = 512;

    std::vector<Index> takeSample() const;
    std::vector<Index> getFaces(int level, std::vector<FacePart> const &parts) const;
    std::vector<Index> findMade(int level, std::vector<Index> const &pFaces) const;
    RowWeights average(int level, std::vector<Index> const &pFaces, std::vector<Index> const &made,
                       int const *sizes) const;
    Index countIsolated(int level) const;

    StencilPlan const &_plan;
    std::vector<RowWeights> _averages; // by level, from 1 on: per row
};

// One face in each of equal ranges, at places in them that no regular numbering of the mesh meets:
// the fractional parts of multiples of the golden ratio.
std::vector<Index> WeightSampler::takeSample() const {
    std::int64_t const numFaces = _plan.hierarchy.mesh.levels[0].numFaces;
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

// The faces of the mesh or of the value mesh, each with the base face of its half 0 alone.
std::vector<Index> WeightSampler::getFaces(int level, std::vector<FacePart> const &parts) const {
    std::vector<Index> faces;
    for (FacePart const &part : parts) {
        if ((part.halves & 1u) == 0) {
            continue;
        }
        if (_plan.channel < 0) {
            faces.push_back(part.face);
            continue;
        }
        FVarLevel const &fvarLevel = _plan.hierarchy.channels[_plan.channel].levels[level];
        faces.push_back(fvarLevel.valueFaces[part.face]);
        if (FVarLevel::SplitFace const *split = fvarLevel.FindSplitFace(part.face)) {
            faces.push_back(split->valueFaces[1]);
        }
    }
    return faces;
}

// Calls function(cVert, count) for F-vertices of a face, of which count have stencils of that size: in
// a truncation each its own, and the far ones of boundaries, too.
template <typename FUNCTION>
void forEachFVertex(Refinement const &refinement, Index pFace, FUNCTION function) {
    Level const &parent = *refinement.parent;
    Index const begin = parent.faceFirstCorner[pFace];
    if (!refinement.isTruncation) {
        function(refinement.GetCornerChildVertex(begin), parent.GetFaceSize(pFace));
        return;
    }
    for (Index corner = begin; corner < parent.faceFirstCorner[pFace + 1]; ++corner) {
        function(refinement.GetCornerChildVertex(corner), 1);
        if (parent.IsBoundary(parent.faceEdges[corner])) {
            function(GetEdgeEndVertex(refinement, FindEdgeEnd(parent, corner) ^ 1u), 1);
        }
    }
}

// The vertices made of faces' corners, one for each stencil size of a face, and of their vertices.
std::vector<Index> WeightSampler::findMade(int level, std::vector<Index> const &pFaces) const {
    Level const &parent = _plan.GetLevel(level - 1);
    Refinement const &refinement = _plan.GetRefinement(level);
    std::vector<Index> verts;
    for (Index pFace : pFaces) {
        forEachFVertex(refinement, pFace, [&](Index cVert, int) { verts.push_back(cVert); });
        for (Index pVert : parent.GetFaceVertices(pFace)) {
            if (Index const cVert = refinement.GetVertexChildVertex(pVert);
                cVert != Far::INDEX_INVALID) {
                verts.push_back(cVert);
            }
        }
    }
    SortUnique(verts);
    return verts;
}

// A vertex counts as a part for each of its faces.
RowWeights WeightSampler::average(int level, std::vector<Index> const &pFaces,
                                  std::vector<Index> const &made, int const *sizes) const {
    Level const &parent = _plan.GetLevel(level - 1);
    Refinement const &refinement = _plan.GetRefinement(level);
    auto const sizeOf = [&](Index cVert) {
        return sizes[std::lower_bound(made.begin(), made.end(), cVert) - made.begin()];
    };
    RowWeights weights;
    double numFVertices = 0;
    double numVVertices = 0;
    for (Index pFace : pFaces) {
        forEachFVertex(refinement, pFace, [&](Index cVert, int count) {
            numFVertices += count;
            weights.ofFVertices += double(count) * sizeOf(cVert);
        });
        for (Index pVert : parent.GetFaceVertices(pFace)) {
            Index const cVert = refinement.GetVertexChildVertex(pVert);
            if (cVert != Far::INDEX_INVALID) {
                double const share = 1.0 / parent.GetNumVertexFaces(pVert);
                numVVertices += share;
                weights.ofVVertices += share * sizeOf(cVert);
            }
        }
    }
    weights.ofFVertices /= std::max(numFVertices, 1.0);
    weights.ofVVertices /= numVVertices > 0 ? numVVertices : 1;
    return weights;
}

CallStatus WeightSampler::Form() {
    StencilPlan plan = _plan;
    plan.firstStored = 1;
    plan.lastLevel = std::min(_plan.lastLevel, kMaxSampledLevel);
    plan.numControlStencils = 0;
    if (plan.lastLevel == 0) {
        return CallStatus();
    }
    std::vector<Index> const baseFaces = takeSample();
    auto const parts = FindFacesOfBaseFaces(
        plan.hierarchy.mesh, ConstIndexArray(baseFaces.data(), int(baseFaces.size())),
        plan.lastLevel - 1);
    std::vector<std::vector<Index>> faces;
    std::vector<std::vector<Index>> wanted(1);
    for (int level = 1; level <= plan.lastLevel; ++level) {
        faces.push_back(getFaces(level - 1, parts[level - 1]));
        wanted.push_back(findMade(level, faces[level - 1]));
    }
    StencilSelection const selection(plan, std::move(wanted));
    SymbolicTable symbolic(plan, selection);
    if (CallStatus status = symbolic.Form(); !status.IsOk()) {
        return status;
    }
    for (int level = 1; level <= plan.lastLevel; ++level) {
        std::vector<Index> const made =
            GetMadeVertices(_plan.GetRefinement(level), selection.parts[level - 1]);
        _averages.push_back(average(level, faces[level - 1], made, symbolic.GetSizes(level)));
    }
    return CallStatus();
}

// V-vertices without a face, whose rows have one weight: a scheme keeps all of them, or none.
Index WeightSampler::countIsolated(int level) const {
    for (int made = 1; made <= level; ++made) {
        if (_plan.GetLevel(made).numVVertices == 0) {
            return 0;
        }
    }
    Level const &base = _plan.GetLevel(0);
    Index count = 0;
    for (Index vert = 0; vert < base.numVertices; ++vert) {
        count += base.GetNumVertexFaces(vert) == 0 ? 1 : 0;
    }
    return count;
}

RowWeights WeightSampler::Estimate(int level) const {
    int const numSampled = int(_averages.size());
    RowWeights average = _averages[std::min(level, numSampled) - 1];
    if (level > numSampled) {
        // Supports grow towards a limit, each level by half as much as the one before.
        RowWeights const &before = _averages[numSampled - 2];
        double const growth = 1 - std::ldexp(1.0, numSampled - level);
        average.ofFVertices += growth * (average.ofFVertices - before.ofFVertices);
        average.ofVVertices += growth * (average.ofVVertices - before.ofVVertices);
    }
    Index const numIsolated = countIsolated(level);
    Level const &made = _plan.GetLevel(level);
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
    WeightSampler sampler(plan);
    if (plan.factorize) {
        if (CallStatus status = sampler.Form(); !status.IsOk()) {
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
        RowWeights const weights =
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
    return CallStatus();
}

} // namespace OpenSubdivHex::FarExt::internal
