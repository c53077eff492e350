// SPDX-License-Identifier: Apache-2.0
#include "innerRings.h"

#include "lanes.h"
#include "patchCorners.h"

#include "far_ext/rules/quadPath.h"
#include "far_ext/vtr/irregularFeatures.h"

#include <algorithm>
#include <array>

namespace OpenSubdivHex::BfrExt::internal {

using FarExt::internal::Refinement;
using FarExt::internal::RefinementRules;
using FarExt::internal::VertexRule;

namespace {

constexpr std::size_t kHexagon = 6;
// In the block of a face, in which the vertex of the ring comes first.
constexpr std::size_t kVVertex = 1;
constexpr std::size_t kFVerticesOfHexagon = 2;
static_assert(kFVerticesOfHexagon + kHexagon == Ring::GetNumOthers(RingStep::Second));
// In the block of the first step, before the F-vertices.
constexpr std::size_t kNumOuter = Ring::GetNumOthers(RingStep::First);

} // namespace

// Finds the masks around vertices of a patch, which is refined where one is met for the first time.
class InnerRings::MaskFinder {
public:
    MaskFinder(RingMasks &masks, PatchCorners const &corners) : _masks(masks), _corners(corners) {}

    // The weights of a vertex, from the corners there.
    Weights const &FindVertex(std::vector<int> const &ring) {
        return find(RingMasks::Of::SecondVertex, getKey(ring),
                    [&](Refinement const &refinement, RefinementRules const &rules) {
                        return toWeights(rules.GetVertexRule(
                            refinement.GetVertexChildVertex(_corners.GetVertex(ring[0]))));
                    });
    }
    // Weights of the F-vertices of all faces around a vertex, for a vertex itself, and for those of its F-face and
    // of its two E-faces.
    Weights const &FindFVertex(std::vector<int> const &ring) {
        return find(RingMasks::Of::SecondFVertex, getKey(ring),
                    [&](Refinement const &refinement, RefinementRules const &rules) {
                        return findFVertex(refinement, rules, ring[0]);
                    });
    }
    Weights const &FindFace(int size) {
        return find(RingMasks::Of::SecondFace, {size},
                    [&](Refinement const &, RefinementRules const &rules) {
                        double const *const weights = rules.GetCirculantRule(size).GetRow(0);
                        return std::vector<double>(weights, weights + size);
                    });
    }
    // Weights for the E-face of the edge from a corner on; the faces beside the edge are the face of the corner and
    // the face before it around the vertex.
    Weights const &FindHexagon(std::vector<int> const &ring, int corner, int before) {
        std::vector<int> key = getKey(ring);
        std::vector<int> ringOfNeighbor;
        _corners.FindRing(_corners.GetNext(corner, 1), ringOfNeighbor);
        std::vector<int> const ofNeighbor = getKey(ringOfNeighbor);
        key.insert(key.end(), ofNeighbor.begin(), ofNeighbor.end());
        key.push_back(_corners.GetFaceSize(before));
        key.push_back(_corners.GetFaceSize(corner));
        return find(RingMasks::Of::SecondHexagon, key,
                    [&](Refinement const &refinement, RefinementRules const &rules) {
                        return findHexagon(corner, refinement, rules);
                    });
    }

private:
    // Key of the masks around a vertex.
    std::vector<int> getKey(std::vector<int> const &ring) const {
        int const numFaces = int(ring.size());
        auto const getFaceSize = [&](int i) { return _corners.GetFaceSize(ring[std::size_t(i)]); };
        return {numFaces, FarExt::internal::FindQuadFlag(numFaces, getFaceSize),
                int(FarExt::internal::FindFacesAround(numFaces, getFaceSize))};
    }

    template <typename MAKE>
    Weights const &find(RingMasks::Of of, std::vector<int> const &key, MAKE const &make) {
        return _masks.Find<Weights>(of, key, [&] {
            std::vector<double> weights;
            CellRules const &ofCells = _masks.GetRules();
            FarExt::internal::UseNextMasks(
                _corners.GetPatch(), ofCells.sdcOptions, ofCells.hexSchemeOptions,
                ofCells.interpolation,
                [&](Refinement const &refinement, RefinementRules const &rules) {
                    weights = make(refinement, rules);
                });
            return Weights(std::move(weights));
        });
    }

    static std::vector<double> toWeights(VertexRule const &rule) {
        return {rule.weights[rule.numSources - 1], rule.faceWeight};
    }

    static std::vector<double> findFVertex(Refinement const &refinement,
                                           RefinementRules const &rules, int corner) {
        FarExt::internal::Level const &child = *refinement.child;
        Far::Index const vert = refinement.GetCornerChildVertex(Far::Index(corner));
        VertexRule const rule = rules.GetVertexRule(vert);
        std::vector<double> weights = {rule.weights[0], 0, 0};
        Far::ConstIndexArray const faces = child.GetVertexFaces(vert);
        for (int i = 0; i < faces.size(); ++i) {
            weights[faces[i] < child.numFFaces ? 1 : 2] = rule.GetFaceWeight(i);
        }
        return weights;
    }

    // From the V-vertex at the corner on, a row for each F-vertex.
    std::vector<double> findHexagon(int corner, Refinement const &refinement,
                                    RefinementRules const &rules) const {
        Far::Index const face =
            refinement.GetEdgeChildFace(refinement.parent->faceEdges[Far::Index(corner)]);
        Far::ConstIndexArray const verts = refinement.child->GetFaceVertices(face);
        Far::Index const vert = refinement.GetVertexChildVertex(_corners.GetVertex(corner));
        auto const first = std::size_t(std::find(verts.begin(), verts.end(), vert) - verts.begin());
        std::vector<double> weights;
        weights.reserve(kHexagon * kHexagon);
        FarExt::internal::FaceRule const rule = rules.GetFaceRule(face);
        for (std::size_t row = 0; row < kHexagon; ++row) {
            double const *const ofRow = rule.GetRow(int((first + row) % kHexagon));
            for (std::size_t i = 0; i < kHexagon; ++i) {
                weights.push_back(ofRow[(first + i) % kHexagon]);
            }
        }
        return weights;
    }

    RingMasks &_masks;
    PatchCorners const &_corners;
};

bool InnerRings::Init(PatchCorners const &ofPatch, std::vector<int> const &corners,
                      RingMasks &masks) {
    MaskFinder finder(masks, ofPatch);
    std::vector<int> ring;
    for (int const first : corners) {
        if (!ofPatch.FindRing(first, ring) || ring.size() > kMaxFaces) {
            return false;
        }
        Center center = {&finder.FindVertex(ring), &finder.FindFVertex(ring), {}};
        center.spokes.reserve(ring.size());
        int before = ring.back();
        for (int const corner : ring) {
            center.spokes.push_back({&finder.FindHexagon(ring, corner, before),
                                     &finder.FindFace(ofPatch.GetFaceSize(corner))});
            before = corner;
        }
        _rings.push_back(std::move(center));
    }
    return true;
}

// Writes the F-vertices of a block: of the E-face and of the F-face.
template <std::size_t PADDED_SIZE, typename REAL>
void InnerRings::applyFaces(Spoke const &spoke, std::size_t faceSize, REAL const *outer,
                            REAL const *lastBefore, REAL const *firstBefore, std::size_t paddedSize,
                            REAL *inner) {
    std::size_t const stride = PADDED_SIZE == 0 ? paddedSize : PADDED_SIZE;
    REAL const *const weights = spoke.hexagon->Get(REAL());
    REAL const *const mask = spoke.face->Get(REAL());
    std::array<REAL const *, kHexagon> const hexagon = {outer,
                                                        firstBefore,
                                                        lastBefore,
                                                        outer + stride,
                                                        outer + (kNumOuter + 1) * stride,
                                                        outer + kNumOuter * stride};
    for (std::size_t first = 0; first < stride; first += Lanes<REAL>::kCount) {
        std::array<Lanes<REAL>, kHexagon> verts;
        for (std::size_t i = 0; i < kHexagon; ++i) {
            verts[i] = Lanes<REAL>::Load(hexagon[i] + first);
        }
        REAL *to = inner + kFVerticesOfHexagon * stride + first;
        for (std::size_t row = 0; row < kHexagon; ++row, to += stride) {
            REAL const *const ofRow = weights + row * kHexagon;
            Lanes<REAL> sum = verts[0] * ofRow[0];
            for (std::size_t i = 1; i < kHexagon; ++i) {
                sum = sum + verts[i] * ofRow[i];
            }
            sum.Store(to);
        }
        REAL const *const ofFace = outer + kNumOuter * stride + first;
        for (std::size_t corner = 0; corner < faceSize; ++corner, to += stride) {
            Lanes<REAL> sum = Lanes<REAL>::Load(ofFace + corner * stride) * mask[0];
            for (std::size_t i = 1; i < faceSize; ++i) {
                std::size_t const vert = corner + i < faceSize ? corner + i : corner + i - faceSize;
                sum = sum + Lanes<REAL>::Load(ofFace + vert * stride) * mask[i];
            }
            sum.Store(to);
        }
    }
}

template <std::size_t PADDED_SIZE, typename REAL>
void InnerRings::Apply(Ring const &ring, std::size_t number, int turn, std::size_t paddedSize,
                       REAL const *first, REAL *second) const {
    std::size_t const stride = PADDED_SIZE == 0 ? paddedSize : PADDED_SIZE;
    Center const &center = _rings[number];
    int const numFaces = ring.GetNumFaces();
    int const firstFace = ring.GetFirstFace(turn);
    REAL const *const beginOfOuter = first + ring.GetBlock(turn, 0, RingStep::First) * stride;
    REAL *const begin = second + ring.GetBlock(turn, 0, RingStep::Second) * stride;
    REAL const *outer = beginOfOuter;
    REAL const *before = first + ring.GetBlock(turn, -1, RingStep::First) * stride;
    REAL *inner = begin;
    for (int face = 0; face < numFaces; ++face) {
        if (face == firstFace) {
            outer = first;
            inner = second;
        }
        REAL const *const firstBefore = before + kNumOuter * stride;
        applyFaces<PADDED_SIZE>(center.spokes[std::size_t(face)],
                                std::size_t(ring.GetFaceSize(face)), outer,
                                firstBefore + std::size_t(ring.GetFaceSize(face - 1) - 1) * stride,
                                firstBefore, paddedSize, inner);
        before = outer;
        outer += ring.GetBlockSize(face, RingStep::First) * stride;
        inner += ring.GetBlockSize(face, RingStep::Second) * stride;
    }
    // The V-vertices of F-vertices need the next block.
    REAL const *const weights = center.fVertex->Get(REAL());
    outer = beginOfOuter;
    inner = begin;
    for (int face = 0; face < numFaces; ++face) {
        REAL *next = inner + ring.GetBlockSize(face, RingStep::Second) * stride;
        REAL const *nextOuter = outer + ring.GetBlockSize(face, RingStep::First) * stride;
        if (face + 1 == (firstFace == 0 ? numFaces : firstFace)) {
            next = second;
            nextOuter = first;
        }
        for (std::size_t lane = 0; lane < stride; lane += Lanes<REAL>::kCount) {
            auto const load = [&](REAL const *block, std::size_t place) {
                return Lanes<REAL>::Load(block + place * stride + lane);
            };
            Lanes<REAL> const ofFFace = load(inner, kFVerticesOfHexagon + kHexagon);
            Lanes<REAL> const ofEFace = load(inner, kFVerticesOfHexagon + kHexagon - 1);
            Lanes<REAL> const ofNext = load(next, kFVerticesOfHexagon + 1);
            Lanes<REAL> const faces = weights[1] == weights[2]
                                          ? (ofFFace + ofEFace + ofNext) * weights[1]
                                          : ofFFace * weights[1] + (ofEFace + ofNext) * weights[2];
            (load(outer, kNumOuter) * weights[0] + faces).Store(inner + kVVertex * stride + lane);
        }
        outer = nextOuter;
        inner = next;
    }
    writeCenter<PADDED_SIZE>(ring, center, firstFace, first, paddedSize, second);
}

// Writes the vertex of a ring to all blocks.
template <std::size_t PADDED_SIZE, typename REAL>
void InnerRings::writeCenter(Ring const &ring, Center const &center, int firstFace,
                             REAL const *outer, std::size_t paddedSize, REAL *blocks) {
    std::size_t const stride = PADDED_SIZE == 0 ? paddedSize : PADDED_SIZE;
    REAL const *const weights = center.vertex->Get(REAL());
    int const numFaces = ring.GetNumFaces();
    auto const forEachBlock = [&](REAL *block, auto const &function) {
        for (int i = 0, face = firstFace; i < numFaces; ++i) {
            function(block);
            block += ring.GetBlockSize(face, RingStep::Second) * stride;
            face = face + 1 < numFaces ? face + 1 : 0;
        }
    };
    for (std::size_t lane = 0; lane < stride; lane += Lanes<REAL>::kCount) {
        REAL *const begin = blocks + lane;
        auto sum = Lanes<REAL>::Load(begin + kFVerticesOfHexagon * stride);
        forEachBlock(begin, [&](REAL const *block) {
            if (block != begin) {
                sum = sum + Lanes<REAL>::Load(block + kFVerticesOfHexagon * stride);
            }
        });
        sum = Lanes<REAL>::Load(outer + lane) * weights[0] + sum * weights[1];
        forEachBlock(begin, [&](REAL *block) { sum.Store(block); });
    }
}

template void InnerRings::Apply<0>(Ring const &, std::size_t, int, std::size_t, float const *,
                                   float *) const;
template void InnerRings::Apply<0>(Ring const &, std::size_t, int, std::size_t, double const *,
                                   double *) const;
template void InnerRings::Apply<StepMatrix::kPadding>(Ring const &, std::size_t, int, std::size_t,
                                                      float const *, float *) const;
template void InnerRings::Apply<StepMatrix::kPadding>(Ring const &, std::size_t, int, std::size_t,
                                                      double const *, double *) const;

} // namespace OpenSubdivHex::BfrExt::internal
