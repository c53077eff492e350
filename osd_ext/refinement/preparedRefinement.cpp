// SPDX-License-Identifier: Apache-2.0
#include "preparedRefinement.h"

#include "far_ext/vtr/indexSet.h"
#include "far_ext/vtr/parallel.h"
#include "far_ext/vtr/runs.h"
#include "far_ext/vtr/truncationMask.h"

#include <algorithm>
#include <unordered_map>

namespace OpenSubdivHex::OsdExt::internal {

using Far::Index;
using FarExt::internal::FaceRule;
using FarExt::internal::ForEachRun;
using FarExt::internal::InsertUnique;
using FarExt::internal::kFVertexFaces;
using FarExt::internal::Level;
using FarExt::internal::ParallelFor;
using FarExt::internal::Refinement;
using FarExt::internal::RefinementRules;
using FarExt::internal::VertexRule;

namespace {

constexpr int kMaxUnrolledSize = 6;
/// Faces and vertices that a thread takes at a time, of some microseconds.
constexpr Index kFaceBatch = 1024;
constexpr Index kVertexBatch = 4096;

// Calls function(begin, end) for batches of 0 ... count - 1.
template <typename FUNCTION>
void forEachBatch(Index count, Index batch, FUNCTION function) {
    for (Index begin = 0; begin < count;) {
        Index const end = begin + std::min(batch, count - begin);
        function(begin, end);
        begin = end;
    }
}

// The masks of hexagons with dense rules, by the number of the rule.
std::vector<DenseFaceMask> makeDenseMasks(RefinementRules const &rules) {
    std::vector<DenseFaceMask> masks(std::size_t(rules.GetNumDenseRules()));
    for (std::size_t number = 0; number < masks.size(); ++number) {
        FaceRule const rule = rules.GetDenseRule(int(number));
        if (rule.GetSize() != DenseFaceMask::kSize) {
            continue;
        }
        for (int corner = 0; corner < DenseFaceMask::kSize; ++corner) {
            for (int vert = 0; vert < DenseFaceMask::kSize; ++vert) {
                masks[number].weights[vert][corner] = Spread(float(rule.GetRow(corner)[vert]));
            }
        }
    }
    return masks;
}

// The faces that are in no run: those with dense rules that are no hexagons, and those that need exact access
// (see PreparedRefinement).
std::vector<Index> findWeightedFaces(RefinementRules const &rules, Level const &parent) {
    std::vector<Index> faces;
    rules.ForEachDenseFace(0, parent.numFaces, [&](Index face, int rule) {
        if (rules.GetDenseRule(rule).GetSize() != DenseFaceMask::kSize) {
            faces.push_back(face);
        }
    });
    if (parent.numVertices > 0) {
        for (Index const face : parent.GetVertexFaces(parent.numVertices - 1)) {
            if (parent.GetFaceSize(face) <= kMaxUnrolledSize) {
                InsertUnique(faces, face);
            }
        }
    }
    return faces;
}

// The vertices that are in no run: those with rules of their own, and those that need exact access.
std::vector<Index> findWeightedVertices(RefinementRules const &rules,
                                        Refinement const &refinement) {
    Level const &parent = *refinement.parent;
    if (!refinement.vVertexParents.empty()) {
        // All, since those that are plain keep their index.
        return std::vector<Index>(refinement.vVertexParents.begin(),
                                  refinement.vVertexParents.end());
    }
    std::vector<Index> verts;
    if (refinement.child->numVVertices > 0) {
        verts.reserve(rules.GetRuledVertices().size() + 2);
        for (RefinementRules::RuledVertex const &ruled : rules.GetRuledVertices()) {
            verts.push_back(ruled.vert);
        }
        InsertUnique(verts, parent.numVertices - 1);
        if (parent.numCorners > 0) {
            InsertUnique(verts, parent.faceVerts[parent.numCorners - 1]);
        }
    }
    return verts;
}

// The weights of faces that are in no run, each rule once.
class FaceWeightLister {
public:
    FaceWeightLister(RefinementRules const &rules, std::vector<float> &weights)
        : _rules(rules), _weights(weights) {}

    // The position of those of a face, row by row.
    std::size_t Find(Index face) {
        FaceRule const rule = _rules.GetFaceRule(face);
        // Circulant rules, which their size identifies, have negative keys.
        int const key = rule.IsCirculant() ? -rule.GetSize() : _rules.FindRun(face)->rule;
        auto const [found, isNew] = _positions.try_emplace(key, _weights.size());
        if (isNew) {
            for (int corner = 0; corner < rule.GetSize(); ++corner) {
                double const *const row = rule.GetRow(corner);
                _weights.insert(_weights.end(), row, row + rule.GetSize());
            }
        }
        return found->second;
    }

private:
    RefinementRules const &_rules;
    std::vector<float> &_weights;
    std::unordered_map<int, std::size_t> _positions;
};

// Appends the runs of one size that make up a run of faces.
void appendFaceRuns(Level const &level, Index begin, Index end, std::vector<IndexRun> &runs) {
    while (begin < end) {
        Index last = begin + 1;
        while (last < end && level.GetFaceSize(last) == level.GetFaceSize(begin)) {
            ++last;
        }
        runs.push_back({begin, last});
        begin = last;
    }
}

// Groups all faces of the level, and lists the weights of those that are in no run.
void makeFaces(RefinementRules const &rules, PreparedRefinement &prepared) {
    Level const &parent = *prepared.parent;
    std::vector<Index> const weighted = findWeightedFaces(rules, parent);
    FaceWeightLister weights(rules, prepared.faceWeights);
    forEachBatch(parent.numFaces, kFaceBatch, [&](Index batchBegin, Index batchEnd) {
        ForEachRun(
            batchBegin, batchEnd, weighted,
            [&](Index begin, Index end, Index) {
                appendFaceRuns(parent, begin, end, prepared.faceRuns.items);
            },
            [&](Index face, Index) {
                Far::ConstIndexArray const verts = parent.GetFaceVertices(face);
                prepared.weightedFaces.items.push_back({parent.faceFirstCorner[std::size_t(face)],
                                                        verts.size(), verts.begin(),
                                                        weights.Find(face)});
            });
        prepared.faceRuns.EndGroup();
        prepared.weightedFaces.EndGroup();
    });
}

WeightedVertex makeWeightedVertex(VertexRule const &rule, RefinementRules const &rules,
                                  Refinement const &refinement, Index vert) {
    int const firstFaceWeight = rule.faceWeights
                                    ? int(rule.faceWeights - rules.GetAllVertexWeights().data())
                                    : WeightedVertex::kEqual;
    WeightedVertex vertex = {vert,
                             refinement.GetVertexChildVertex(vert),
                             float(rule.weights[rule.numSources - 1]),
                             float(rule.faceWeight),
                             firstFaceWeight,
                             {vert, vert},
                             {0, 0}};
    for (int i = 0; i + 1 < rule.numSources; ++i) {
        vertex.neighbors[i] = rule.sources[i];
        vertex.neighborWeights[i] = float(rule.weights[i]);
    }
    return vertex;
}

// Appends the runs that make up vertices [begin, end): from one on all have three faces, up to another some have weights.
void appendVertexRuns(RefinementRules const &rules, Level const &parent, Index begin, Index end,
                      std::vector<VertexRun> &runs) {
    Index const endOfWeights = rules.GetEndOfVertexWeights();
    while (begin < end) {
        Index behind = end;
        for (Index const limit : {parent.numVertsOfAnyValence, endOfWeights}) {
            behind = begin < limit ? std::min(behind, limit) : behind;
        }
        int const *const weights = rules.GetWeightsOfVertices();
        Index const numCorners = parent.vertFirstFace[behind] - parent.vertFirstFace[begin];
        runs.push_back(
            {begin, behind,
             begin < endOfWeights &&
                 std::any_of(weights + begin, weights + behind,
                             [](int position) { return position != RefinementRules::kPlain; }),
             begin >= parent.numVertsOfAnyValence &&
                 numCorners == kFVertexFaces * (behind - begin)});
        begin = behind;
    }
}

// Groups all vertices of the level that make a V-vertex.
void makeVertices(RefinementRules const &rules, Refinement const &refinement,
                  PreparedRefinement &prepared) {
    Level const &parent = *refinement.parent;
    bool const arePlain = // those that are not weighted; else there are no others
        prepared.numVVertices == parent.numVertices;
    std::vector<Index> const weighted = findWeightedVertices(rules, refinement);
    std::vector<double> const &weights = rules.GetAllVertexWeights();
    prepared.vertexWeights.assign(weights.begin(), weights.end());
    auto nextRuled = rules.GetRuledVertices().begin();
    auto const endRuled = rules.GetRuledVertices().end();
    forEachBatch(parent.numVertices, kVertexBatch, [&](Index batchBegin, Index batchEnd) {
        ForEachRun(
            batchBegin, batchEnd, weighted,
            [&](Index begin, Index end, Index) {
                if (arePlain) {
                    appendVertexRuns(rules, parent, begin, end, prepared.vertexRuns.items);
                }
            },
            [&](Index vert, Index) {
                while (nextRuled != endRuled && nextRuled->vert < vert) {
                    ++nextRuled;
                }
                bool const isRuled = nextRuled != endRuled && nextRuled->vert == vert;
                prepared.weightedVertices.items.push_back(
                    makeWeightedVertex(isRuled ? nextRuled->rule : rules.GetVertexRule(vert), rules,
                                       refinement, vert));
            });
        prepared.vertexRuns.EndGroup();
        prepared.weightedVertices.EndGroup();
    });
    if (!prepared.vertexRuns.IsEmpty() && prepared.masks.averagesFaces) {
        prepared.vertCorners.Resize(std::size_t(parent.numCorners));
        ParallelFor(parent.numCorners, [&](Index k) {
            prepared.vertCorners[std::size_t(k)] = parent.GetVertexCorner(k);
        });
    }
}

PlainMasks makePlainMasks(RefinementRules const &rules, Level const &parent) {
    PlainMasks masks;
    int maxValence = kFVertexFaces;
    Index const end = std::min(parent.numVertsOfAnyValence, parent.numVertices);
    for (Index vert = 0; vert < end; ++vert) {
        maxValence = std::max(maxValence, parent.GetNumVertexFaces(vert));
    }
    for (int numFaces = 0; numFaces <= maxValence; ++numFaces) {
        FarExt::VertexVertexMask const vertexMask = rules.GetPlainVertexMask(numFaces);
        masks.verticesInverse.push_back(float(vertexMask.vertexWeight));
    }
    masks.averagesFaces = rules.GetPlainVertexMask(1).faceWeight != 0;
    for (Index const size : parent.faceSizes) {
        masks.faces.resize(std::size_t(size) + 1);
        masks.faces[std::size_t(size)] = MakePlainFaceMask(rules.GetCirculantRule(size));
    }
    return masks;
}

// All that a truncation makes.
void listVertices(Refinement const &refinement, FarExt::Interpolation interpolation,
                  PreparedRefinement &prepared) {
    Index const numVertices = refinement.child->numVertices;
    FarExt::internal::TruncationMask const mask(refinement, interpolation);
    FarExt::internal::TruncationMask::Sources sources;
    prepared.parent = refinement.parent;
    Groups<ListedVertex> &listed = prepared.listedVertices;
    forEachBatch(numVertices, kVertexBatch, [&](Index begin, Index end) {
        for (Index cVert = begin; cVert < end; ++cVert) {
            mask.GetSources(cVert, sources);
            listed.items.push_back(
                {cVert, int(sources.verts.size()), prepared.listedSources.size()});
            prepared.listedSources.insert(prepared.listedSources.end(), sources.verts.begin(),
                                          sources.verts.end());
            prepared.listedWeights.insert(prepared.listedWeights.end(), sources.weights.begin(),
                                          sources.weights.end());
        }
        listed.EndGroup();
    });
}

} // namespace

PlainFaceMask MakePlainFaceMask(FaceRule const &circulant) {
    int const size = circulant.GetSize();
    double const *const weights = circulant.GetRow(0);
    PlainFaceMask mask;
    bool const hasOpposite = size == kMaxUnrolledSize;
    bool isOrdinary = weights[1] == weights[size - 1];
    for (int j = 2; j <= size - 2; ++j) {
        isOrdinary &= weights[j] == weights[2] || (hasOpposite && j == size / 2);
    }
    if (!isOrdinary) {
        mask.weights.assign(weights, weights + size);
        mask.weights.insert(mask.weights.end(), weights, weights + size);
        return mask;
    }
    double const all = weights[size > PlainFaceMask::kMinSize ? 2 : 1];
    mask.self = float(weights[0] - all);
    mask.neighbor = float(weights[1] - all);
    // Two weights that differ by rounding alone count as equal: the kernel then adds none.
    mask.opposite = hasOpposite ? float(weights[size / 2]) - float(all) : 0;
    mask.all = float(all);
    return mask;
}

void PrepareRefinement(std::shared_ptr<RefinementRules const> const &rules,
                       Refinement const &refinement, PreparedRefinement &prepared) {
    if (refinement.isTruncation) {
        listVertices(refinement, rules->GetInterpolation(), prepared);
        return;
    }
    prepared.numVVertices = refinement.child->numVVertices;
    prepared.rules = rules;
    prepared.masks = makePlainMasks(*rules, *refinement.parent);
    prepared.denseMasks = makeDenseMasks(*rules);
    prepared.parent = refinement.parent;
    makeFaces(*rules, prepared);
    makeVertices(*rules, refinement, prepared);
}

} // namespace OpenSubdivHex::OsdExt::internal
