// SPDX-License-Identifier: Apache-2.0
//
// The limit in lattice faces, some faces at a time: compiled once per SIMD level, by the rules of
// limitKernelTemplate.h.
#ifndef OPENSUBDIVHEX_OSD_EXT_REFINEMENT_LATTICE_KERNEL_TEMPLATE_H
#define OPENSUBDIVHEX_OSD_EXT_REFINEMENT_LATTICE_KERNEL_TEMPLATE_H

#include "limitAccess.h"

#include "far_ext/limit/latticePatch.h"

namespace OpenSubdivHex::OsdExt::internal {
namespace {

constexpr float kSineOfThird = 0.86602540378443864676f; ///< of 120 degrees

/// Frequencies that have a cosine and a sine.
template <int FACE_SIZE>
constexpr int kNumFrequencies = (FACE_SIZE - 1) / 2;

/// \brief The values of an orbit, one for each corner, as waves around the face: value i is the sum of
/// the mean, cosine[k - 1] cos(2 pi k i / n) - sine[k - 1] sin(2 pi k i / n) for each frequency k and, where
/// n is even, alternating (-1)^i.
template <class SIMD, int FACE_SIZE>
struct LatticeWaves {
    using T = typename SIMD::Vector;
    T mean;
    T cosine[kNumFrequencies<FACE_SIZE>];
    T sine[kNumFrequencies<FACE_SIZE>];
    T alternating;
};

/// That of values, but that the mean and what alternates are n times as large, and the others n / 2.
template <class SIMD>
OPENSUBDIVHEX_INLINE LatticeWaves<SIMD, 3> findWaves(typename SIMD::Vector const (&x)[3]) {
    using Vector = typename SIMD::Vector;
    Vector const sum = x[1] + x[2];
    LatticeWaves<SIMD, 3> waves;
    waves.mean = x[0] + sum;
    waves.cosine[0] = SIMD::MultiplyAdd(SIMD::Spread(-0.5f), sum, x[0]);
    waves.sine[0] = SIMD::Spread(kSineOfThird) * (x[2] - x[1]);
    return waves;
}
template <class SIMD>
OPENSUBDIVHEX_INLINE LatticeWaves<SIMD, 4> findWaves(typename SIMD::Vector const (&x)[4]) {
    using Vector = typename SIMD::Vector;
    Vector const even = x[0] + x[2];
    Vector const odd = x[1] + x[3];
    LatticeWaves<SIMD, 4> waves;
    waves.mean = even + odd;
    waves.cosine[0] = x[0] - x[2];
    waves.sine[0] = x[3] - x[1];
    waves.alternating = even - odd;
    return waves;
}
/// Even frequencies are those of the sums of opposite values, three of them, odd ones those of the
/// differences.
template <class SIMD>
OPENSUBDIVHEX_INLINE LatticeWaves<SIMD, 6> findWaves(typename SIMD::Vector const (&x)[6]) {
    using Vector = typename SIMD::Vector;
    Vector const sums[] = {x[0] + x[3], x[1] + x[4], x[2] + x[5]};
    LatticeWaves<SIMD, 3> const even = findWaves<SIMD>(sums);
    Vector const first = x[0] - x[3];
    Vector const second = x[1] - x[4];
    Vector const third = x[2] - x[5];
    Vector const difference = second - third;
    LatticeWaves<SIMD, 6> waves;
    waves.mean = even.mean;
    waves.cosine[0] = SIMD::MultiplyAdd(SIMD::Spread(0.5f), difference, first);
    waves.sine[0] = SIMD::Spread(-kSineOfThird) * (second + third);
    waves.cosine[1] = even.cosine[0];
    waves.sine[1] = even.sine[0];
    waves.alternating = first - difference;
    return waves;
}

template <class SIMD>
OPENSUBDIVHEX_INLINE void findValues(LatticeWaves<SIMD, 3> const &waves,
                                     typename SIMD::Vector (&x)[3]) {
    using Vector = typename SIMD::Vector;
    Vector const rest = SIMD::MultiplyAdd(SIMD::Spread(-0.5f), waves.cosine[0], waves.mean);
    x[0] = waves.mean + waves.cosine[0];
    x[1] = SIMD::MultiplyAdd(SIMD::Spread(-kSineOfThird), waves.sine[0], rest);
    x[2] = SIMD::MultiplyAdd(SIMD::Spread(kSineOfThird), waves.sine[0], rest);
}
template <class SIMD>
OPENSUBDIVHEX_INLINE void findValues(LatticeWaves<SIMD, 4> const &waves,
                                     typename SIMD::Vector (&x)[4]) {
    using Vector = typename SIMD::Vector;
    Vector const even = waves.mean + waves.alternating;
    Vector const odd = waves.mean - waves.alternating;
    x[0] = even + waves.cosine[0];
    x[1] = odd - waves.sine[0];
    x[2] = even - waves.cosine[0];
    x[3] = odd + waves.sine[0];
}
template <class SIMD>
OPENSUBDIVHEX_INLINE void findValues(LatticeWaves<SIMD, 6> const &waves,
                                     typename SIMD::Vector (&x)[6]) {
    using Vector = typename SIMD::Vector;
    LatticeWaves<SIMD, 3> evenWaves;
    evenWaves.mean = waves.mean;
    evenWaves.cosine[0] = waves.cosine[1];
    evenWaves.sine[0] = waves.sine[1];
    Vector even[3];
    findValues<SIMD>(evenWaves, even);
    Vector const half = SIMD::Spread(0.5f) * waves.cosine[0] - waves.alternating;
    Vector const sine = SIMD::Spread(kSineOfThird) * waves.sine[0];
    Vector const odd[] = {waves.cosine[0] + waves.alternating, half - sine,
                          SIMD::Spread(0) - (half + sine)};
    for (int i = 0; i < 3; ++i) {
        x[i] = even[i] + odd[i];
        x[i + 3] = even[i] - odd[i];
    }
}

/// The same of waves whose sines have the other sign: the values in the mirror.
template <class SIMD, int FACE_SIZE>
OPENSUBDIVHEX_INLINE void findMirroredValues(LatticeWaves<SIMD, FACE_SIZE> const &waves,
                                             typename SIMD::Vector (&x)[FACE_SIZE]) {
    findValues<SIMD>(waves, x);
    for (int i = 1; i < FACE_SIZE - i; ++i) {
        typename SIMD::Vector const opposite = x[FACE_SIZE - i];
        x[FACE_SIZE - i] = x[i];
        x[i] = opposite;
    }
}

/// \brief The waves of all sources of some faces, as the weights of LatticeWeights take them.
///
/// Of the two orbits of a pair these are their sum, which is like an orbit on an axis, and their
/// difference, which changes its sign in the mirror: its waves are turned by a quarter, so that one
/// weight stands for cosine and sine.
template <class SIMD, int FACE_SIZE, bool IS_COMPACT>
struct LatticeSources {
    using T = typename SIMD::Vector;
    using Orbits = FarExt::internal::LatticeOrbits<FACE_SIZE, IS_COMPACT>;
    static constexpr int kNumSums = Orbits::kNumAxes + Orbits::kNumPairs;
    static constexpr int kNumDifferences = Orbits::kNumPairs;
    static constexpr int kSize = kNumSums + kNumDifferences;

    T mean[kSize];
    T cosine[kNumFrequencies<FACE_SIZE>][kSize];
    T sine[kNumFrequencies<FACE_SIZE>][kSize];
    T alternating[kSize];
};

template <class SIMD, class ACCESS, int FACE_SIZE>
OPENSUBDIVHEX_INLINE void loadOrbit(Elements<float const> const &values,
                                    std::uint32_t const *places,
                                    typename SIMD::Vector (&x)[FACE_SIZE]) {
    for (int corner = 0; corner < FACE_SIZE; ++corner, places += RegularFaceGroup::kSize) {
        float const *sources[SIMD::kNumFaces];
        for (int i = 0; i < SIMD::kNumFaces; ++i) {
            sources[i] = ACCESS::AtPlace(values, places[i], RegularFaceGroup::kPointStride);
        }
        x[corner] = SIMD::template Load<ACCESS::kReach>(sources);
    }
}

template <class SIMD, class ACCESS, int FACE_SIZE, bool IS_COMPACT>
OPENSUBDIVHEX_INLINE void loadSources(Elements<float const> const &values,
                                      std::uint32_t const *places,
                                      LatticeSources<SIMD, FACE_SIZE, IS_COMPACT> &result) {
    using Vector = typename SIMD::Vector;
    using Sources = LatticeSources<SIMD, FACE_SIZE, IS_COMPACT>;
    constexpr int kStride = FACE_SIZE * RegularFaceGroup::kSize;
    constexpr int kNumWaves = kNumFrequencies<FACE_SIZE>;
    auto const set = [&](int i, LatticeWaves<SIMD, FACE_SIZE> const &waves) {
        result.mean[i] = waves.mean;
        for (int k = 0; k < kNumWaves; ++k) {
            result.cosine[k][i] = waves.cosine[k];
            result.sine[k][i] = waves.sine[k];
        }
        if constexpr (FACE_SIZE % 2 == 0) {
            result.alternating[i] = waves.alternating;
        }
    };
    Vector x[FACE_SIZE];
    for (int i = 0; i < Sources::Orbits::kNumAxes; ++i, places += kStride) {
        loadOrbit<SIMD, ACCESS, FACE_SIZE>(values, places, x);
        set(i, findWaves<SIMD>(x));
    }
    for (int i = 0; i < Sources::Orbits::kNumPairs; ++i, places += 2 * kStride) {
        Vector y[FACE_SIZE];
        loadOrbit<SIMD, ACCESS, FACE_SIZE>(values, places, x);
        loadOrbit<SIMD, ACCESS, FACE_SIZE>(values, places + kStride, y);
        Vector sums[FACE_SIZE];
        for (int corner = 0; corner < FACE_SIZE; ++corner) {
            sums[corner] = x[corner] + y[corner];
            y[corner] = x[corner] - y[corner];
        }
        set(Sources::Orbits::kNumAxes + i, findWaves<SIMD>(sums));
        LatticeWaves<SIMD, FACE_SIZE> waves = findWaves<SIMD>(y);
        for (int k = 0; k < kNumWaves; ++k) {
            Vector const cosine = waves.cosine[k];
            waves.cosine[k] = SIMD::Spread(0) - waves.sine[k];
            waves.sine[k] = cosine;
        }
        set(Sources::kNumSums + i, waves);
    }
}

/// Sums of COUNT values with weights for NUM_ROWS sums, of which the first NUM are made.
/// \return  the weights behind these
template <class SIMD, int COUNT, int NUM_ROWS, int NUM>
OPENSUBDIVHEX_INLINE float const *sumWaves(float const *weights,
                                           typename SIMD::Vector const *values,
                                           typename SIMD::Vector (&sums)[NUM]) {
    for (int row = 0; row < NUM; ++row) {
        sums[row] = SIMD::Spread(weights[row]) * values[0];
    }
    for (int i = 1; i < COUNT; ++i) {
        for (int row = 0; row < NUM; ++row) {
            addProduct<SIMD>(sums[row], SIMD::Spread(weights[i * NUM_ROWS + row]), values[i]);
        }
    }
    return weights + COUNT * NUM_ROWS;
}
/// The same of two arrays of values.
template <class SIMD, int COUNT, int NUM_ROWS, int NUM>
OPENSUBDIVHEX_INLINE float const *
sumWaves(float const *weights, typename SIMD::Vector const *cosines,
         typename SIMD::Vector const *sines, typename SIMD::Vector (&cosine)[NUM],
         typename SIMD::Vector (&sine)[NUM]) {
    using Vector = typename SIMD::Vector;
    for (int row = 0; row < NUM; ++row) {
        Vector const weight = SIMD::Spread(weights[row]);
        cosine[row] = weight * cosines[0];
        sine[row] = weight * sines[0];
    }
    for (int i = 1; i < COUNT; ++i) {
        for (int row = 0; row < NUM; ++row) {
            Vector const weight = SIMD::Spread(weights[i * NUM_ROWS + row]);
            addProduct<SIMD>(cosine[row], weight, cosines[i]);
            addProduct<SIMD>(sine[row], weight, sines[i]);
        }
    }
    return weights + COUNT * NUM_ROWS;
}

/// Writes the point and the two derivatives of an orbit, these in terms of others.
template <class SIMD, class ACCESS, int FACE_SIZE, int NUM_OUTPUTS>
OPENSUBDIVHEX_INLINE Far::Index const *
storeOrbit(Elements<float> const (&outputs)[NUM_OUTPUTS], Far::Index const *verts,
           float const *derivatives, typename SIMD::Vector (&x)[NUM_OUTPUTS][FACE_SIZE]) {
    using Vector = typename SIMD::Vector;
    if (NUM_OUTPUTS > 1 && derivatives) {
        for (int corner = 0; corner < FACE_SIZE; ++corner) {
            Vector &du = x[1][corner];
            Vector &dv = x[NUM_OUTPUTS - 1][corner];
            Vector const first = du;
            du = SIMD::MultiplyAdd(SIMD::Spread(derivatives[0]), first,
                                   SIMD::Spread(derivatives[1]) * dv);
            dv = SIMD::MultiplyAdd(SIMD::Spread(derivatives[2]), first,
                                   SIMD::Spread(derivatives[3]) * dv);
        }
    }
    for (int corner = 0; corner < FACE_SIZE; ++corner, verts += RegularFaceGroup::kSize) {
        for (int i = 0; i < NUM_OUTPUTS; ++i) {
            float *places[SIMD::kNumFaces];
            for (int k = 0; k < SIMD::kNumFaces; ++k) {
                places[k] = ACCESS::At(outputs[i], verts[k]);
            }
            SIMD::template Store<ACCESS::kWidth>(places, x[i][corner]);
        }
    }
    return verts;
}

/// Asks for the memory of a later group, some of it with each orbit that is made.
template <class ACCESS, int NUM_OUTPUTS>
class LatticePrefetcher {
public:
    OPENSUBDIVHEX_INLINE LatticePrefetcher(LatticeTask const &task, Far::Index group, int numOrbits)
        : _next(task.ahead + task.firstAhead[group + task.numGroupsAhead]),
          _end(task.ahead + task.firstAhead[group + task.numGroupsAhead + 1]),
          _numOfOrbit((_end - _next + numOrbits - 1) / numOrbits) {}

    OPENSUBDIVHEX_INLINE void Prefetch(Elements<float> const (&outputs)[NUM_OUTPUTS]) {
        Far::Index const *const end = _end - _next > _numOfOrbit ? _next + _numOfOrbit : _end;
        for (; _next != end; ++_next) {
            for (Elements<float> const &output : outputs) {
                prefetch(ACCESS::At(output, *_next));
            }
        }
    }

private:
    Far::Index const *_next;
    Far::Index const *_end;
    std::ptrdiff_t _numOfOrbit;
};

/// \brief Makes the values of orbits, by output: sums the waves of the sources with the weights of an
/// orbit, and joins the sums to values.
template <class SIMD, int FACE_SIZE, bool IS_COMPACT, int NUM_OUTPUTS>
struct LatticeKernel {
    using Vector = typename SIMD::Vector;
    using Sources = LatticeSources<SIMD, FACE_SIZE, IS_COMPACT>;
    using Values = Vector[NUM_OUTPUTS][FACE_SIZE];
    static constexpr int kMaxOutputs = LimitTask::kMaxOutputs;
    static constexpr bool kAlternates = FACE_SIZE % 2 == 0;
    static constexpr int kNumWaves = kNumFrequencies<FACE_SIZE>;
    static constexpr bool kHasDerivatives = NUM_OUTPUTS > 1;

    /// The values of both orbits.
    static OPENSUBDIVHEX_INLINE float const *
    EvaluatePair(float const *weights, Sources const &sources, Values &first, Values &second) {
        constexpr int kNumRows = 2 * kMaxOutputs;
        constexpr int kNum = 2 * NUM_OUTPUTS; // half their sums and half their differences in turn
        Vector mean[2][NUM_OUTPUTS];
        Vector alternating[2][NUM_OUTPUTS];
        Vector cosine[kNumWaves][kNum];
        Vector sine[kNumWaves][kNum];
        weights = sumSingle(weights, sources.mean, mean);
        if constexpr (kAlternates) {
            weights = sumSingle(weights, sources.alternating, alternating);
        }
        for (int k = 0; k < kNumWaves; ++k) {
            weights = sumWaves<SIMD, Sources::kSize, kNumRows>(weights, sources.cosine[k],
                                                               sources.sine[k], cosine[k], sine[k]);
        }
        for (int i = 0; i < NUM_OUTPUTS; ++i) {
            LatticeWaves<SIMD, FACE_SIZE> sum;
            LatticeWaves<SIMD, FACE_SIZE> difference;
            sum.mean = mean[0][i];
            difference.mean = mean[1][i];
            for (int k = 0; k < kNumWaves; ++k) {
                sum.cosine[k] = cosine[k][2 * i];
                sum.sine[k] = sine[k][2 * i];
                difference.cosine[k] = sine[k][2 * i + 1];
                difference.sine[k] = cosine[k][2 * i + 1];
            }
            if constexpr (kAlternates) {
                sum.alternating = alternating[0][i];
                difference.alternating = alternating[1][i];
            }
            Vector x[FACE_SIZE];
            findValues<SIMD>(sum, x);
            findMirroredValues<SIMD>(difference, second[i]);
            for (int corner = 0; corner < FACE_SIZE; ++corner) {
                first[i][corner] = x[corner] + second[i][corner];
                second[i][corner] = x[corner] - second[i][corner];
            }
        }
        return weights;
    }

    /// Points, derivatives along the axis and across.
    static OPENSUBDIVHEX_INLINE float const *EvaluateAxis(float const *weights,
                                                          Sources const &sources, Values &values) {
        constexpr int kNumAlong = kHasDerivatives ? 2 : 1;
        Vector mean[NUM_OUTPUTS];
        Vector alternating[NUM_OUTPUTS];
        Vector cosine[kNumWaves][NUM_OUTPUTS];
        Vector sine[kNumWaves][NUM_OUTPUTS];
        auto const sum = [&](Vector const *of, Vector(&sums)[NUM_OUTPUTS]) {
            Vector along[kNumAlong];
            weights = sumWaves<SIMD, Sources::kNumSums, 2>(weights, of, along);
            for (int i = 0; i < kNumAlong; ++i) {
                sums[i] = along[i];
            }
            Vector across[1];
            weights = sumWaves<SIMD, Sources::kNumDifferences, 1>(weights, of + Sources::kNumSums,
                                                                  across);
            if constexpr (kHasDerivatives) {
                sums[NUM_OUTPUTS - 1] = across[0];
            }
        };
        sum(sources.mean, mean);
        if constexpr (kAlternates) {
            sum(sources.alternating, alternating);
        }
        for (int k = 0; k < kNumWaves; ++k) {
            weights = sumWaves<SIMD, Sources::kSize, kMaxOutputs>(
                weights, sources.cosine[k], sources.sine[k], cosine[k], sine[k]);
        }
        for (int i = 0; i < NUM_OUTPUTS; ++i) {
            bool const isAcross = i == kMaxOutputs - 1;
            LatticeWaves<SIMD, FACE_SIZE> waves;
            waves.mean = mean[i];
            for (int k = 0; k < kNumWaves; ++k) {
                waves.cosine[k] = isAcross ? sine[k][i] : cosine[k][i];
                waves.sine[k] = isAcross ? cosine[k][i] : sine[k][i];
            }
            if constexpr (kAlternates) {
                waves.alternating = alternating[i];
            }
            if (isAcross) {
                findMirroredValues<SIMD>(waves, values[i]);
            } else {
                findValues<SIMD>(waves, values[i]);
            }
        }
        return weights;
    }

private:
    // Waves that are alike at all corners, but for the sign perhaps: to those of half the sum of a pair
    // sums contribute, and differences to those of half the difference.
    static OPENSUBDIVHEX_INLINE float const *sumSingle(float const *weights, Vector const *values,
                                                       Vector (&sums)[2][NUM_OUTPUTS]) {
        weights = sumWaves<SIMD, Sources::kNumSums, kMaxOutputs>(weights, values, sums[0]);
        return sumWaves<SIMD, Sources::kNumDifferences, kMaxOutputs>(
            weights, values + Sources::kNumSums, sums[1]);
    }
};

template <class SIMD, class ACCESS, int FACE_SIZE, bool IS_COMPACT, int NUM_OUTPUTS>
void evaluateLattice(LatticeTask const &task, Far::Index begin, Far::Index end) {
    using Kernel = LatticeKernel<SIMD, FACE_SIZE, IS_COMPACT, NUM_OUTPUTS>;
    using Sources = LatticeSources<SIMD, FACE_SIZE, IS_COMPACT>;
    constexpr int kGroup = RegularFaceGroup::kSize;
    constexpr int kNumDerivatives = LatticeTask::kNumDerivatives;
    Elements<float const> const values = task.values;
    Elements<float> outputs[NUM_OUTPUTS];
    for (int i = 0; i < NUM_OUTPUTS; ++i) {
        outputs[i] = task.outputs[i];
    }
    std::ptrdiff_t const numPlaces = std::ptrdiff_t(kGroup) * FACE_SIZE * Sources::kSize;
    std::ptrdiff_t const numVerts = std::ptrdiff_t(kGroup) * FACE_SIZE * task.GetNumOrbits();
    for (Far::Index group = begin; group < end; ++group) {
        LatticePrefetcher<ACCESS, NUM_OUTPUTS> prefetcher(task, group, task.GetNumOrbits());
        for (int first = 0; first < kGroup; first += SIMD::kNumFaces) {
            Sources sources;
            loadSources<SIMD, ACCESS>(values, task.places + group * numPlaces + first, sources);
            Far::Index const *verts = task.verts + group * numVerts + first;
            float const *weights = task.weights;
            typename Kernel::Values x;
            for (int i = 0; i < task.numPairs + task.numHalves; ++i, weights += kNumDerivatives) {
                typename Kernel::Values images;
                weights = Kernel::EvaluatePair(weights, sources, x, images);
                prefetcher.Prefetch(outputs);
                verts = storeOrbit<SIMD, ACCESS, FACE_SIZE>(outputs, verts, nullptr, x);
                if (i < task.numPairs) {
                    prefetcher.Prefetch(outputs);
                    verts = storeOrbit<SIMD, ACCESS, FACE_SIZE>(outputs, verts, weights, images);
                }
            }
            for (int i = 0; i < task.numAxes; ++i, weights += kNumDerivatives) {
                weights = Kernel::EvaluateAxis(weights, sources, x);
                prefetcher.Prefetch(outputs);
                verts = storeOrbit<SIMD, ACCESS, FACE_SIZE>(outputs, verts, weights, x);
            }
        }
    }
}

} // namespace
} // namespace OpenSubdivHex::OsdExt::internal

#endif
