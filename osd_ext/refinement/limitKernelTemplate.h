// SPDX-License-Identifier: Apache-2.0
//
// The limit, of some regular faces or some vertices of a type at a time.  It is compiled once per SIMD
// level, each time with the flags of that level, so all of it must have internal linkage: the linker
// may not hand code of one level to another.  Hence the unnamed namespace, and no inline function of
// the standard library.
#ifndef OPENSUBDIVHEX_OSD_EXT_REFINEMENT_LIMIT_KERNEL_TEMPLATE_H
#define OPENSUBDIVHEX_OSD_EXT_REFINEMENT_LIMIT_KERNEL_TEMPLATE_H

#include "latticeKernelTemplate.h"
#include "limitAccess.h"

#include <cstddef>
#include <cstdint>
#include <cstring>

namespace OpenSubdivHex::OsdExt::internal {
namespace {

using FarExt::internal::kRegularFaceSize;

constexpr int kHalf = kRegularFaceSize / 2;

/// \brief The frequencies of values around a regular face: six values x_i, one for
/// each corner, are a sum of waves around the face.
///
/// A mask that is the same for all corners multiplies each wave by a number, or mixes its cosine with
/// its sine.  Where the mask is symmetric, as those of points and along a corner's axis are, the
/// cosine stays one; where it changes its sign, as across the axis, the cosine becomes a sine.  So a
/// few weights stand for all six rows.  Sines are short of the factor sqrt(3)/2.
template <class SIMD>
struct FaceWaves {
    using T = typename SIMD::Vector;
    T mean;
    T cosine1;
    T sine1;
    T cosine2;
    T sine2;
    T alternating;
};

template <class SIMD>
OPENSUBDIVHEX_INLINE FaceWaves<SIMD>
findWavesOfCorners(typename SIMD::Vector const (&x)[kRegularFaceSize]) {
    using Vector = typename SIMD::Vector;
    Vector const half = SIMD::Spread(0.5f);
    Vector const minusHalf = SIMD::Spread(-0.5f);
    Vector sums[kHalf];
    Vector differences[kHalf];
    for (int i = 0; i < kHalf; ++i) {
        sums[i] = x[i] + x[i + kHalf];
        differences[i] = x[i] - x[i + kHalf];
    }
    Vector const sum = sums[1] + sums[2];
    Vector const difference = differences[1] - differences[2];
    FaceWaves<SIMD> waves;
    waves.mean = sums[0] + sum;
    waves.cosine2 = SIMD::MultiplyAdd(minusHalf, sum, sums[0]);
    waves.sine2 = sums[1] - sums[2];
    waves.alternating = differences[0] - difference;
    waves.cosine1 = SIMD::MultiplyAdd(half, difference, differences[0]);
    waves.sine1 = differences[1] + differences[2];
    return waves;
}

/// Variant for values between the corners, behind them: waves begin at corner 0, so that the
/// first cosine lacks the factor, and the first sine does not.
template <class SIMD>
OPENSUBDIVHEX_INLINE FaceWaves<SIMD>
findWavesOfEdges(typename SIMD::Vector const (&x)[kRegularFaceSize]) {
    using Vector = typename SIMD::Vector;
    Vector const half = SIMD::Spread(0.5f);
    Vector sums[kHalf];
    Vector differences[kHalf];
    for (int i = 0; i < kHalf; ++i) {
        sums[i] = x[i] + x[i + kHalf];
        differences[i] = x[i] - x[i + kHalf];
    }
    Vector const sum = sums[0] + sums[2];
    Vector const difference = differences[0] + differences[2];
    FaceWaves<SIMD> waves;
    waves.mean = sum + sums[1];
    waves.cosine2 = half * sum - sums[1];
    waves.sine2 = sums[0] - sums[2];
    waves.alternating = difference - differences[1];
    waves.cosine1 = differences[0] - differences[2];
    waves.sine1 = SIMD::MultiplyAdd(half, difference, differences[1]);
    return waves;
}

/// The values at the corners.
template <class SIMD>
OPENSUBDIVHEX_INLINE void addWaves(FaceWaves<SIMD> const &waves,
                                   typename SIMD::Vector (&x)[kRegularFaceSize]) {
    using Vector = typename SIMD::Vector;
    Vector const rest = SIMD::MultiplyAdd(SIMD::Spread(-0.5f), waves.cosine2, waves.mean);
    Vector const even[kHalf] = {waves.mean + waves.cosine2, rest + waves.sine2, rest - waves.sine2};
    Vector const turned = SIMD::Spread(0.5f) * waves.cosine1 - waves.alternating;
    Vector const odd[kHalf] = {waves.alternating + waves.cosine1, turned + waves.sine1,
                               waves.sine1 - turned};
    for (int i = 0; i < kHalf; ++i) {
        x[i] = even[i] + odd[i];
        x[i + kHalf] = even[i] - odd[i];
    }
}

template <class SIMD>
OPENSUBDIVHEX_INLINE FaceWaves<SIMD> weigh(SymmetricWeights<SIMD> const &weights,
                                           FaceWaves<SIMD> const (&sources)[kNumRegularSources]) {
    FaceWaves<SIMD> result;
    result.mean = weights.mean[0] * sources[0].mean;
    result.cosine1 = weights.cosine1[0] * sources[0].cosine1;
    result.sine1 = weights.sine1[0] * sources[0].sine1;
    result.cosine2 = weights.cosine2[0] * sources[0].cosine2;
    result.sine2 = weights.sine2[0] * sources[0].sine2;
    result.alternating = weights.alternating[0] * sources[0].alternating;
    for (int i = 1; i < kNumRegularSources; ++i) {
        addProduct<SIMD>(result.mean, weights.mean[i], sources[i].mean);
        addProduct<SIMD>(result.cosine1, weights.cosine1[i], sources[i].cosine1);
        addProduct<SIMD>(result.sine1, weights.sine1[i], sources[i].sine1);
        addProduct<SIMD>(result.cosine2, weights.cosine2[i], sources[i].cosine2);
        addProduct<SIMD>(result.sine2, weights.sine2[i], sources[i].sine2);
    }
    addProduct<SIMD>(result.alternating, weights.alternating[1], sources[1].alternating);
    return result;
}

template <class SIMD>
OPENSUBDIVHEX_INLINE FaceWaves<SIMD> weigh(AntisymmetricWeights<SIMD> const &weights,
                                           FaceWaves<SIMD> const (&sources)[kNumRegularSources]) {
    FaceWaves<SIMD> result;
    result.mean = SIMD::Spread(0);
    result.cosine1 = weights.cosineOfSine1[0] * sources[0].sine1;
    result.sine1 = weights.sineOfCosine1[0] * sources[0].cosine1;
    result.cosine2 = weights.cosineOfSine2[0] * sources[0].sine2;
    result.sine2 = weights.sineOfCosine2[0] * sources[0].cosine2;
    for (int i = 1; i < kNumRegularSources; ++i) {
        addProduct<SIMD>(result.cosine1, weights.cosineOfSine1[i], sources[i].sine1);
        addProduct<SIMD>(result.sine1, weights.sineOfCosine1[i], sources[i].cosine1);
        addProduct<SIMD>(result.cosine2, weights.cosineOfSine2[i], sources[i].sine2);
        addProduct<SIMD>(result.sine2, weights.sineOfCosine2[i], sources[i].cosine2);
    }
    result.alternating = weights.alternatingOfPairs * sources[kNumRegularSources - 1].alternating;
    return result;
}

/// Weights for each float of a vector.
template <class SIMD>
OPENSUBDIVHEX_INLINE RegularLimitWeights<SIMD>
spreadWeights(RegularLimitWeights<Scalar> const &weights) {
    using Vector = typename SIMD::Vector;
    constexpr int kNumWeights = sizeof(weights) / sizeof(float);
    static_assert(sizeof(RegularLimitWeights<SIMD>) == kNumWeights * sizeof(Vector));
    float values[kNumWeights];
    std::memcpy(values, &weights, sizeof(weights));
    Vector vectors[kNumWeights];
    for (int i = 0; i < kNumWeights; ++i) {
        vectors[i] = SIMD::Spread(values[i]);
    }
    RegularLimitWeights<SIMD> result;
    std::memcpy(&result, vectors, sizeof(result));
    return result;
}

/// The elements of as many faces of a group, from number \c first on, as a vector holds.
template <class SIMD, class ACCESS>
struct FaceElements {
    using Vector = typename SIMD::Vector;
    using Values = Vector[kRegularFaceSize];

    OPENSUBDIVHEX_INLINE void Load(Elements<float const> const &points,
                                   RegularFaceGroup::Places const &places, Values &x) const {
        for (int corner = 0; corner < kRegularFaceSize; ++corner) {
            float const *sources[SIMD::kNumFaces];
            for (int i = 0; i < SIMD::kNumFaces; ++i) {
                sources[i] = ACCESS::AtPlace(points, places[corner][first + i]);
            }
            x[corner] = ACCESS::template Load<SIMD>(sources, length);
        }
    }
    OPENSUBDIVHEX_INLINE void LoadOthers(Elements<float const> const &points, Values &x) const {
        Values more[2];
        Load(points, group.others[0], x);
        Load(points, group.others[1], more[0]);
        Load(points, group.others[2], more[1]);
        for (int i = 0; i < kRegularFaceSize; ++i) {
            x[i] = x[i] + (more[0][i] + more[1][i]);
        }
    }
    OPENSUBDIVHEX_INLINE void Store(Elements<float> const &output, Values const &x) const {
        float *begins[SIMD::kNumFaces];
        for (int i = 0; i < SIMD::kNumFaces; ++i) {
            begins[i] = ACCESS::At(output, group.firstCorners[first + i]);
        }
        if constexpr (ACCESS::kIsPoints) {
            SIMD::StoreRun(begins, x);
        } else {
            for (int corner = 0; corner < kRegularFaceSize; ++corner) {
                float *places[SIMD::kNumFaces];
                for (int i = 0; i < SIMD::kNumFaces; ++i) {
                    places[i] = begins[i] + corner * output.stride;
                }
                ACCESS::template Store<SIMD>(places, x[corner], length);
            }
        }
    }

    RegularFaceGroup const &group;
    int first;
    int length; ///< of the elements
};

template <class SIMD, class ACCESS, bool HAS_DERIVATIVES>
OPENSUBDIVHEX_INLINE void evaluateFaces(RegularLimitTask const &task,
                                        RegularLimitWeights<SIMD> const &weights,
                                        FaceElements<SIMD, ACCESS> const &faces) {
    using Vector = typename SIMD::Vector;
    RegularFaceGroup const &group = faces.group;
    FaceWaves<SIMD> sources[kNumRegularSources];
    Vector x[kRegularFaceSize];
    faces.Load(task.values, group.verts, x);
    sources[0] = findWavesOfCorners<SIMD>(x);
    faces.Load(task.values, group.neighbors, x);
    sources[1] = findWavesOfCorners<SIMD>(x);
    Vector next[kRegularFaceSize];
    Vector previous[kRegularFaceSize];
    Vector others[kRegularFaceSize];
    Vector tips[kRegularFaceSize];
    faces.Load(task.values, group.next, next);
    faces.Load(task.values, group.previous, previous);
    faces.LoadOthers(task.values, others);
    for (int i = 0; i < kRegularFaceSize; ++i) {
        x[i] = next[i] + previous[(i + 1) % kRegularFaceSize];
        tips[i] = SIMD::MultiplyAdd(weights.othersOfTip, others[i], next[i] + previous[i]);
    }
    sources[2] = findWavesOfEdges<SIMD>(x);

    addWaves<SIMD>(weigh<SIMD>(weights.point, sources), x);
    for (int i = 0; i < kRegularFaceSize; ++i) {
        addProduct<SIMD>(x[i], weights.point.tip, tips[i]);
    }
    faces.Store(task.outputs[0], x);
    if constexpr (HAS_DERIVATIVES) {
        addWaves<SIMD>(weigh<SIMD>(weights.along, sources), x);
        Vector across[kRegularFaceSize];
        addWaves<SIMD>(weigh<SIMD>(weights.across, sources), across);
        for (int i = 0; i < kRegularFaceSize; ++i) {
            tips[i] = SIMD::MultiplyAdd(weights.othersOfTipAlong, others[i], next[i] + previous[i]);
            addProduct<SIMD>(across[i], weights.tipAcross, next[i] - previous[i]);
            addProduct<SIMD>(x[i], weights.along.tip, tips[i]);
            addProduct<SIMD>(x[i], weights.duOfAcross, across[i]);
            addProduct<SIMD>(across[i], weights.dvOfDu, x[i]);
        }
        faces.Store(task.outputs[1], x);
        faces.Store(task.outputs[2], across);
    }
}

template <class SIMD, class ACCESS, bool HAS_DERIVATIVES>
void evaluateGroups(RegularLimitTask const &given, Far::Index begin, Far::Index end) {
    // A copy, since the compiler must expect that outputs are written to the given one.
    RegularLimitTask const task = given;
    RegularLimitWeights<SIMD> const weights = spreadWeights<SIMD>(*task.weights);
    for (Far::Index group = begin; group < end; ++group) {
        for (int first = 0; first < RegularFaceGroup::kSize; first += SIMD::kNumFaces) {
            FaceElements<SIMD, ACCESS> const faces = {task.groups[group], first, task.length};
            evaluateFaces<SIMD, ACCESS, HAS_DERIVATIVES>(task, weights, faces);
        }
    }
}

/// The outputs of a vertex are sums over the same sources, with three weights for each.  There are
/// two sums of each, or the time to add would bound them.
template <class SIMD, class ACCESS, int NUM_OUTPUTS>
void evaluateVertices(VertexLimitTask const &task, Far::Index begin, Far::Index end) {
    using Vector = typename SIMD::Vector;
    constexpr int kNumFaces = SIMD::kNumFaces;
    constexpr int kMaxOutputs = LimitTask::kMaxOutputs;
    Elements<float const> const values = task.values;
    Elements<float> outputs[NUM_OUTPUTS];
    for (int i = 0; i < NUM_OUTPUTS; ++i) {
        outputs[i] = task.outputs[i];
    }
    for (VertexGroup const *group = task.groups + begin; group != task.groups + end; ++group) {
        for (int first = 0; first < VertexGroup::kSize; first += kNumFaces) {
            std::uint32_t const *places = task.places + group->firstPlace + first;
            float const *weights = task.weights + group->firstWeight;
            auto const addSource = [&](Vector(&sums)[NUM_OUTPUTS]) {
                float const *sources[kNumFaces];
                for (int i = 0; i < kNumFaces; ++i) {
                    sources[i] = ACCESS::AtPlace(values, places[i]);
                }
                Vector const value = ACCESS::template Load<SIMD>(sources, task.length);
                for (int i = 0; i < NUM_OUTPUTS; ++i) {
                    addProduct<SIMD>(sums[i], SIMD::Spread(weights[i]), value);
                }
                places += VertexGroup::kSize;
                weights += kMaxOutputs;
            };
            Vector even[NUM_OUTPUTS];
            Vector odd[NUM_OUTPUTS];
            for (int i = 0; i < NUM_OUTPUTS; ++i) {
                even[i] = odd[i] = SIMD::Spread(0);
            }
            for (int source = 0; source + 1 < group->numSources; source += 2) {
                addSource(even);
                addSource(odd);
            }
            if (group->numSources % 2 != 0) {
                addSource(even);
            }
            for (int i = 0; i < NUM_OUTPUTS; ++i) {
                float *dst[kNumFaces];
                for (int k = 0; k < kNumFaces; ++k) {
                    dst[k] = ACCESS::At(outputs[i], group->verts[first + k]);
                }
                ACCESS::template Store<SIMD>(dst, even[i] + odd[i], task.length);
            }
        }
    }
}

/// The kernels for a SIMD level.
template <class SIMD>
struct LimitKernels {
    static void EvaluateFaces(RegularLimitTask const &task, Far::Index begin, Far::Index end) {
        forEachQuad(task, [=](RegularLimitTask const &part, auto access) {
            using Access = decltype(access);
            part.numOutputs > 1 ? evaluateGroups<SIMD, Access, true>(part, begin, end)
                                : evaluateGroups<SIMD, Access, false>(part, begin, end);
        });
    }
    static void EvaluateVertices(VertexLimitTask const &task, Far::Index begin, Far::Index end) {
        forEachQuad(task, [=](VertexLimitTask const &part, auto access) {
            if (part.numOutputs > 1) {
                evaluateVertices<SIMD, decltype(access), LimitTask::kMaxOutputs>(part, begin, end);
            } else {
                evaluateVertices<SIMD, decltype(access), 1>(part, begin, end);
            }
        });
    }
    static void EvaluateLattice(LatticeTask const &task, Far::Index begin, Far::Index end) {
        forEachQuad(task, [=](LatticeTask const &part, auto access) {
            using Access = decltype(access);
            switch (part.faceSize) {
            case 3:
                return evaluateLattice<Access, 3>(part, begin, end);
            case 4:
                return evaluateLattice<Access, 4>(part, begin, end);
            default:
                return evaluateLattice<Access, 6>(part, begin, end);
            }
        });
    }

    static constexpr LimitKernel kKernel = {EvaluateFaces, EvaluateVertices, EvaluateLattice};

private:
    template <class ACCESS, int FACE_SIZE>
    static void evaluateLattice(LatticeTask const &task, Far::Index begin, Far::Index end) {
        if (task.isCompact) {
            evaluateLattice<ACCESS, FACE_SIZE, true>(task, begin, end);
        } else {
            evaluateLattice<ACCESS, FACE_SIZE, false>(task, begin, end);
        }
    }
    template <class ACCESS, int FACE_SIZE, bool IS_COMPACT>
    static void evaluateLattice(LatticeTask const &task, Far::Index begin, Far::Index end) {
        if (task.numOutputs > 1) {
            internal::evaluateLattice<SIMD, ACCESS, FACE_SIZE, IS_COMPACT, LimitTask::kMaxOutputs>(
                task, begin, end);
        } else {
            internal::evaluateLattice<SIMD, ACCESS, FACE_SIZE, IS_COMPACT, 1>(task, begin, end);
        }
    }
};

} // namespace
} // namespace OpenSubdivHex::OsdExt::internal

#endif
