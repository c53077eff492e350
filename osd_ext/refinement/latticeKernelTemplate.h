// SPDX-License-Identifier: Apache-2.0
//
// The limit in lattice faces, some faces at a time: compiled once per SIMD level, by the rules of
// limitKernelTemplate.h.
#ifndef OPENSUBDIVHEX_OSD_EXT_REFINEMENT_LATTICE_KERNEL_TEMPLATE_H
#define OPENSUBDIVHEX_OSD_EXT_REFINEMENT_LATTICE_KERNEL_TEMPLATE_H

#include "latticeSources.h"

#include <cstddef>

namespace OpenSubdivHex::OsdExt::internal {
namespace {

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
/// Overload for two arrays of values.
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

/// Replaces the two derivatives of an orbit by du and dv, which are given in terms of them.
template <class SIMD, int FACE_SIZE, int NUM_OUTPUTS>
OPENSUBDIVHEX_INLINE void turnDerivatives(float const *derivatives,
                                          typename SIMD::Vector (&x)[NUM_OUTPUTS][FACE_SIZE]) {
    using Vector = typename SIMD::Vector;
    if constexpr (NUM_OUTPUTS > 1) {
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
}

/// Writes the outputs of orbits, whose vertices stand corner by corner.
template <class SIMD, class ACCESS, int FACE_SIZE, int NUM_OUTPUTS>
struct LatticeWriter {
    using Vector = typename SIMD::Vector;
    using Values = Vector[NUM_OUTPUTS][FACE_SIZE];
    static constexpr int kNumVerts = FACE_SIZE * RegularFaceGroup::kSize; ///< of an orbit

    /// \param areConsecutive  whether the vertices of a face follow one another
    OPENSUBDIVHEX_INLINE void StoreOrbit(Far::Index const *verts, bool areConsecutive,
                                         Values const &x) const {
        if (ACCESS::kIsPoints && areConsecutive) {
            for (int i = 0; i < NUM_OUTPUTS; ++i) {
                float *places[SIMD::kNumFaces];
                findPlaces(i, verts, 0, places);
                SIMD::StoreRun(places, x[i]);
            }
        } else {
            for (int i = 0; i < NUM_OUTPUTS; ++i) {
                for (int corner = 0; corner < FACE_SIZE; ++corner) {
                    float *places[SIMD::kNumFaces];
                    findPlaces(i, verts, corner, places);
                    ACCESS::template Store<SIMD>(places, x[i][corner], length);
                }
            }
        }
    }
    /// \param areConsecutive  whether behind each image there is the vertex of the corner before
    OPENSUBDIVHEX_INLINE void StorePair(Far::Index const *verts, bool areConsecutive,
                                        Values const &x, Values const &images) const {
        if (ACCESS::kIsPoints && areConsecutive) {
            for (int i = 0; i < NUM_OUTPUTS; ++i) {
                for (int corner = 0; corner < FACE_SIZE; ++corner) {
                    float *places[SIMD::kNumFaces];
                    findPlaces(i, verts + kNumVerts, corner, places);
                    Vector const run[] = {images[i][corner],
                                          x[i][(corner + FACE_SIZE - 1) % FACE_SIZE]};
                    SIMD::StoreRun(places, run);
                }
            }
        } else {
            StoreOrbit(verts, false, x);
            StoreOrbit(verts + kNumVerts, false, images);
        }
    }

    Elements<float> const (&outputs)[NUM_OUTPUTS];
    int length; ///< of the elements

private:
    OPENSUBDIVHEX_INLINE void findPlaces(int output, Far::Index const *verts, int corner,
                                         float *(&places)[SIMD::kNumFaces]) const {
        for (int face = 0; face < SIMD::kNumFaces; ++face) {
            places[face] =
                ACCESS::At(outputs[output], verts[corner * RegularFaceGroup::kSize + face]);
        }
    }
};

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

    /// The values of both orbits of a pair.
    static OPENSUBDIVHEX_INLINE float const *
    EvaluatePair(float const *weights, Sources const &sources, Values &first, Values &second) {
        PairWaves pair;
        weights = sumPair(weights, sources, pair);
        for (int i = 0; i < NUM_OUTPUTS; ++i) {
            Vector x[FACE_SIZE];
            findValues<SIMD>(pair.sums[i], x);
            findMirroredValues<SIMD>(pair.differences[i], second[i]);
            for (int corner = 0; corner < FACE_SIZE; ++corner) {
                first[i][corner] = x[corner] + second[i][corner];
                second[i][corner] = x[corner] - second[i][corner];
            }
        }
        return weights;
    }

    /// The values of the first face.
    static OPENSUBDIVHEX_INLINE float const *EvaluateHalf(float const *weights,
                                                          Sources const &sources, Values &first) {
        PairWaves pair;
        weights = sumPair(weights, sources, pair);
        for (int i = 0; i < NUM_OUTPUTS; ++i) {
            Waves &waves = pair.sums[i];
            Waves const &difference = pair.differences[i];
            waves.mean = waves.mean + difference.mean;
            for (int k = 0; k < kNumWaves; ++k) {
                // Sines have the other sign in the mirror.
                waves.cosine[k] = waves.cosine[k] + difference.cosine[k];
                waves.sine[k] = waves.sine[k] - difference.sine[k];
            }
            if constexpr (kAlternates) {
                waves.alternating = waves.alternating + difference.alternating;
            }
            findValues<SIMD>(waves, first[i]);
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
    using Waves = LatticeWaves<SIMD, FACE_SIZE>;

    /// Waves of half the sum of the two orbits of a pair, and of half their difference in the mirror.
    struct PairWaves {
        Waves sums[NUM_OUTPUTS];
        Waves differences[NUM_OUTPUTS];
    };

    static OPENSUBDIVHEX_INLINE float const *sumPair(float const *weights, Sources const &sources,
                                                     PairWaves &pair) {
        constexpr int kNumRows = 2 * kMaxOutputs;
        constexpr int kNum = 2 * NUM_OUTPUTS; // sums and differences in turn
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
            Waves &sum = pair.sums[i];
            Waves &difference = pair.differences[i];
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
        }
        return weights;
    }

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
    using Orbits = typename Sources::Orbits;
    std::ptrdiff_t const numPlaces =
        std::ptrdiff_t(kGroup) * FACE_SIZE * (Orbits::kNumAxes + 2 * Orbits::kNumPairs);
    using Writer = LatticeWriter<SIMD, ACCESS, FACE_SIZE, NUM_OUTPUTS>;
    Writer const writer{outputs, task.length};
    std::ptrdiff_t const numVerts = std::ptrdiff_t(Writer::kNumVerts) * task.GetNumOrbits();
    for (Far::Index group = begin; group < end; ++group) {
        LatticePrefetcher<ACCESS, NUM_OUTPUTS> prefetcher(task, group, task.GetNumOrbits());
        for (int first = 0; first < kGroup; first += SIMD::kNumFaces) {
            Sources sources;
            loadSources<SIMD, ACCESS>(
                LatticeLoader<SIMD, ACCESS, FACE_SIZE>{values, task.length,
                                                       task.places + group * numPlaces + first},
                sources);
            Far::Index const *verts = task.verts + group * numVerts + first;
            unsigned char const *areConsecutive = task.areConsecutive;
            float const *weights = task.weights;
            typename Kernel::Values x;
            for (int i = 0; i < task.numPairs; ++i) {
                typename Kernel::Values images;
                weights = Kernel::EvaluatePair(weights, sources, x, images);
                turnDerivatives<SIMD>(weights, images);
                prefetcher.Prefetch(outputs);
                prefetcher.Prefetch(outputs);
                writer.StorePair(verts, *areConsecutive++ != 0, x, images);
                weights += kNumDerivatives;
                verts += 2 * Writer::kNumVerts;
            }
            for (int i = 0; i < task.numHalves; ++i) {
                weights = Kernel::EvaluateHalf(weights, sources, x) + kNumDerivatives;
                prefetcher.Prefetch(outputs);
                writer.StoreOrbit(verts, *areConsecutive++ != 0, x);
                verts += Writer::kNumVerts;
            }
            for (int i = 0; i < task.numAxes; ++i) {
                weights = Kernel::EvaluateAxis(weights, sources, x);
                turnDerivatives<SIMD>(weights, x);
                prefetcher.Prefetch(outputs);
                writer.StoreOrbit(verts, *areConsecutive++ != 0, x);
                weights += kNumDerivatives;
                verts += Writer::kNumVerts;
            }
        }
    }
}

} // namespace
} // namespace OpenSubdivHex::OsdExt::internal

#endif
