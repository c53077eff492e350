// SPDX-License-Identifier: Apache-2.0
#include "limitKernel.h"

#include "far_ext/vtr/parallel.h"
#include "far_ext/vtr/pi.h"
#include "osd_ext/simdLevel.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace OpenSubdivHex::OsdExt::internal {

using Far::Index;
using FarExt::internal::kPi;
using FarExt::internal::kRegularFaceSize;
using FarExt::internal::Level;
using FarExt::internal::RegularFace;
using FarExt::internal::RegularFaceMask;

namespace {

constexpr double kSine = 0.86602540378443864676; ///< of 60 degrees
constexpr int kPairs = 2;                        ///< among the sources, those between corners

/// The six weights that a mask has for one kind of source.
struct SourceWeights {
    double const *weights;
    int kind;

    /// The factor of the wave of a frequency, where the weights are symmetric or change
    /// their sign.
    double SumCosines(int frequency) const { return sum(frequency, 0); }
    double SumSines(int frequency) const { return sum(frequency, kPi / 2); }

    /// Factors that FaceWaves leaves out.
    double GetCosineFactor(int frequency) const {
        return kind == kPairs && frequency == 1 ? kSine : 1;
    }
    double GetSineFactor(int frequency) const {
        return kind == kPairs && frequency == 1 ? 1 : kSine;
    }

private:
    double sum(int frequency, double phase) const {
        double result = 0;
        for (int i = 0; i < kRegularFaceSize; ++i) {
            double const place = kind == kPairs ? i + 0.5 : i;
            result += weights[i] * std::cos(2 * kPi * frequency * place / kRegularFaceSize - phase);
        }
        return result;
    }
};

/// The derivative along a direction that is turned from that of du to dv.
struct Combination {
    RegularFaceMask::Sum const &du;
    RegularFaceMask::Sum const &dv;
    double ofDu;
    double ofDv;
};

RegularFaceMask::Sum combine(Combination const &c) {
    RegularFaceMask::Sum sum;
    for (int i = 0; i < kRegularFaceSize; ++i) {
        sum.verts[i] = c.ofDu * c.du.verts[i] + c.ofDv * c.dv.verts[i];
        sum.neighbors[i] = c.ofDu * c.du.neighbors[i] + c.ofDv * c.dv.neighbors[i];
        sum.pairs[i] = c.ofDu * c.du.pairs[i] + c.ofDv * c.dv.pairs[i];
    }
    sum.next = c.ofDu * c.du.next + c.ofDv * c.dv.next;
    sum.previous = c.ofDu * c.du.previous + c.ofDv * c.dv.previous;
    sum.others = c.ofDu * c.du.others + c.ofDv * c.dv.others;
    return sum;
}

SourceWeights getSource(RegularFaceMask::Sum const &sum, int kind) {
    return {kind == 0 ? sum.verts : kind == kPairs ? sum.pairs : sum.neighbors, kind};
}

double getTip(RegularFaceMask::Sum const &sum) { return (sum.next + sum.previous) / 2; }

SymmetricWeights<Scalar> makeSymmetric(RegularFaceMask::Sum const &sum) {
    SymmetricWeights<Scalar> result;
    for (int kind = 0; kind < kNumRegularSources; ++kind) {
        SourceWeights const source = getSource(sum, kind);
        auto const findCosine = [&](int frequency) {
            return float(source.SumCosines(frequency) * source.GetCosineFactor(frequency) / 3);
        };
        auto const findSine = [&](int frequency) {
            return float(source.SumCosines(frequency) * source.GetSineFactor(frequency) * kSine /
                         3);
        };
        result.mean[kind] = float(source.SumCosines(0) / 6);
        result.cosine1[kind] = findCosine(1);
        result.sine1[kind] = findSine(1);
        result.cosine2[kind] = findCosine(2);
        result.sine2[kind] = findSine(2);
        if (kind != kPairs) {
            result.alternating[kind] = float(source.SumCosines(3) / 6);
        }
    }
    result.tip = float(getTip(sum));
    return result;
}

AntisymmetricWeights<Scalar> makeAntisymmetric(RegularFaceMask::Sum const &sum) {
    AntisymmetricWeights<Scalar> result;
    for (int kind = 0; kind < kNumRegularSources; ++kind) {
        SourceWeights const source = getSource(sum, kind);
        auto const findCosine = [&](int frequency) {
            return float(source.SumSines(frequency) * source.GetSineFactor(frequency) / 3);
        };
        auto const findSine = [&](int frequency) {
            return float(-source.SumSines(frequency) * source.GetCosineFactor(frequency) * kSine /
                         3);
        };
        result.cosineOfSine1[kind] = findCosine(1);
        result.sineOfCosine1[kind] = findSine(1);
        result.cosineOfSine2[kind] = findCosine(2);
        result.sineOfCosine2[kind] = findSine(2);
    }
    result.alternatingOfPairs = float(getSource(sum, kPairs).SumSines(3) / 6);
    return result;
}

LimitKernel const &getKernel() {
    switch (GetSimdLevel()) {
#ifdef OPENSUBDIVHEX_HAS_X86_KERNELS
    case SimdLevel::Avx512:
        return kLimitKernelAvx512;
    case SimdLevel::Avx2:
        return kLimitKernelAvx2;
#endif
    default:
        return kLimitKernelPortable;
    }
}

// Calls evaluate(task, begin, end) for ranges of \p count, of some microseconds each, in parallel.
template <class TASK, typename EVALUATE>
void forEachRange(TASK const &task, Index count, Index range, EVALUATE evaluate) {
    struct Nothing {};
    FarExt::internal::ParallelForRange(
        count, [] { return Nothing(); },
        [&](Nothing, Index begin, Index end) { evaluate(task, begin, end); }, range);
}

constexpr Index kGroupRange = 128;
constexpr Index kLatticeOutputs = 16384; ///< of a range, the more the fewer groups

} // namespace

// A reflection at the axis of corner 0 exchanges corners 1 and 5: what is along the axis weighs both
// alike, what is across with opposite signs.  With cos and sin of the angle from the axis to du,
// du = cos along + sin across and dv = cos across - sin along; the angle is a multiple of 60 degrees,
// so that cos is not 0, and along and across are scaled to save two products.
RegularLimitWeights<Scalar> MakeRegularLimitWeights(RegularFaceMask const &mask) {
    RegularFaceMask::Sum const &du = mask.sums[1];
    RegularFaceMask::Sum const &dv = mask.sums[2];
    double cosine = du.verts[0] - du.verts[3];
    double sine = dv.verts[3] - dv.verts[0];
    double const length = std::hypot(cosine, sine);
    cosine /= length;
    sine /= length;

    RegularLimitWeights<Scalar> weights;
    weights.point = makeSymmetric(mask.sums[0]);
    RegularFaceMask::Sum const along = combine({du, dv, cosine * cosine, -cosine * sine});
    RegularFaceMask::Sum const across = combine({du, dv, sine / cosine, 1});
    weights.along = makeSymmetric(along);
    weights.across = makeAntisymmetric(across);
    weights.duOfAcross = float(sine * cosine);
    weights.dvOfDu = float(-sine / cosine);
    weights.othersOfTip = float(mask.sums[0].others / getTip(mask.sums[0]));
    weights.othersOfTipAlong = float(along.others / getTip(along));
    weights.tipAcross = float((across.next - across.previous) / 2);
    return weights;
}

std::vector<RegularFaceGroup> MakeRegularFaceGroups(Level const &level,
                                                    std::vector<RegularFace> const &faces) {
    constexpr int kSize = RegularFaceGroup::kSize;
    auto const numFaces = Index(faces.size());
    std::vector<RegularFaceGroup> groups(std::size_t((numFaces + kSize - 1) / kSize));
    FarExt::internal::ParallelFor(Index(groups.size()) * kSize, [&](Index k) {
        RegularFace const &face = faces[std::size_t(std::min(k, numFaces - 1))];
        RegularFaceGroup &group = groups[std::size_t(k / kSize)];
        int const member = k % kSize;
        for (int i = 0; i < kRegularFaceSize; ++i) {
            auto const setPlace = [&](RegularFaceGroup::Places &places, Index vert) {
                places[i][member] =
                    std::uint32_t(vert) * std::uint32_t(RegularFaceGroup::kPointStride);
            };
            setPlace(group.verts, level.faceVerts[std::size_t(face.firstCorner) + std::size_t(i)]);
            setPlace(group.neighbors, face.neighbors[i]);
            setPlace(group.next, face.next[i]);
            setPlace(group.previous, face.previous[i]);
            for (int other = 0; other < RegularFace::kNumOthers; ++other) {
                setPlace(group.others[other], face.GetOther(level, i, other));
            }
        }
        group.firstCorners[member] = face.firstCorner;
    });
    return groups;
}

void EvaluateLimit(RegularLimitTask const &task, Index numGroups) {
    forEachRange(task, numGroups, kGroupRange, getKernel().evaluateFaces);
}

void EvaluateLimit(VertexLimitTask const &task, Index numGroups) {
    forEachRange(task, numGroups, kGroupRange, getKernel().evaluateVertices);
}

void EvaluateLimit(LatticeTask const &task, Index numGroups) {
    int const numOutputs = RegularFaceGroup::kSize * task.faceSize * task.GetNumOrbits();
    forEachRange(task, numGroups, 1 + kLatticeOutputs / numOutputs, getKernel().evaluateLattice);
}

} // namespace OpenSubdivHex::OsdExt::internal
