// SPDX-License-Identifier: Apache-2.0
//
// The limit in lattice faces, some faces at a time: compiled once per SIMD level, by the rules of
// limitKernelTemplate.h.
#ifndef OPENSUBDIVHEX_OSD_EXT_REFINEMENT_LATTICE_KERNEL_TEMPLATE_H
#define OPENSUBDIVHEX_OSD_EXT_REFINEMENT_LATTICE_KERNEL_TEMPLATE_H

#include "limitAccess.h"

#include "far_ext/limit/latticePatch.h"

#include <type_traits>

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
    // The odd parts of values 0 and 1, and that of value 2 with the other sign.
    Vector const first = waves.cosine[0] + waves.alternating;
    Vector const half = SIMD::Spread(0.5f) * waves.cosine[0] - waves.alternating;
    Vector const second = SIMD::MultiplyAdd(SIMD::Spread(-kSineOfThird), waves.sine[0], half);
    Vector const minusThird = SIMD::MultiplyAdd(SIMD::Spread(kSineOfThird), waves.sine[0], half);
    x[0] = even[0] + first;
    x[1] = even[1] + second;
    x[2] = even[2] - minusThird;
    x[3] = even[0] - first;
    x[4] = even[1] - second;
    x[5] = even[2] + minusThird;
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
template <class SIMD, int FACE_SIZE, LatticeSourceKind KIND>
struct LatticeSources {
    using T = typename SIMD::Vector;
    /// Those that are read, and what they become.
    using Read = FarExt::internal::LatticeOrbits<FACE_SIZE, KIND == LatticeSourceKind::Compact>;
    using Orbits = std::conditional_t<KIND == LatticeSourceKind::Joined,
                                      FarExt::internal::JoinedOrbits<FACE_SIZE>, Read>;
    static constexpr int kNumSums = Orbits::kNumAxes + Orbits::kNumPairs;
    static constexpr int kNumDifferences = Orbits::kNumPairs;
    static constexpr int kSize = kNumSums + kNumDifferences;

    T mean[kSize];
    T cosine[kNumFrequencies<FACE_SIZE>][kSize];
    T sine[kNumFrequencies<FACE_SIZE>][kSize];
    T alternating[kSize];
};

/// Reads the sources of some faces.
template <class SIMD, class ACCESS, int FACE_SIZE>
struct LatticeLoader {
    using Vector = typename SIMD::Vector;

    /// Those of an orbit.
    OPENSUBDIVHEX_INLINE void Load(int orbit, Vector (&x)[FACE_SIZE]) const {
        std::uint32_t const *place = places + orbit * FACE_SIZE * RegularFaceGroup::kSize;
        for (int corner = 0; corner < FACE_SIZE; ++corner, place += RegularFaceGroup::kSize) {
            float const *sources[SIMD::kNumFaces];
            for (int i = 0; i < SIMD::kNumFaces; ++i) {
                sources[i] = ACCESS::AtPlace(values, place[i], RegularFaceGroup::kPointStride);
            }
            x[corner] = ACCESS::template Load<SIMD>(sources, length);
        }
    }

    Elements<float const> const &values;
    int length; ///< of the elements
    std::uint32_t const *places;
};

/// Adds the waves of orbits to LatticeSources.
template <class SIMD, int FACE_SIZE, LatticeSourceKind KIND>
struct LatticeSourceWriter {
    using Vector = typename SIMD::Vector;
    using Sources = LatticeSources<SIMD, FACE_SIZE, KIND>;

    OPENSUBDIVHEX_INLINE void SetAxis(int axis, Vector const (&x)[FACE_SIZE]) {
        set(axis, findWaves<SIMD>(x));
    }
    OPENSUBDIVHEX_INLINE void SetPair(int pair, Vector const (&x)[FACE_SIZE],
                                      Vector const (&y)[FACE_SIZE]) {
        Vector sums[FACE_SIZE];
        Vector differences[FACE_SIZE];
        for (int corner = 0; corner < FACE_SIZE; ++corner) {
            sums[corner] = x[corner] + y[corner];
            differences[corner] = x[corner] - y[corner];
        }
        set(Sources::Orbits::kNumAxes + pair, findWaves<SIMD>(sums));
        LatticeWaves<SIMD, FACE_SIZE> waves = findWaves<SIMD>(differences);
        for (int k = 0; k < kNumFrequencies<FACE_SIZE>; ++k) {
            Vector const cosine = waves.cosine[k];
            waves.cosine[k] = SIMD::Spread(0) - waves.sine[k];
            waves.sine[k] = cosine;
        }
        set(Sources::kNumSums + pair, waves);
    }

    Sources &sources;

private:
    OPENSUBDIVHEX_INLINE void set(int i, LatticeWaves<SIMD, FACE_SIZE> const &waves) {
        sources.mean[i] = waves.mean;
        for (int k = 0; k < kNumFrequencies<FACE_SIZE>; ++k) {
            sources.cosine[k][i] = waves.cosine[k];
            sources.sine[k][i] = waves.sine[k];
        }
        if constexpr (FACE_SIZE % 2 == 0) {
            sources.alternating[i] = waves.alternating;
        }
    }
};

/// Sources as they are.
template <class SIMD, class ACCESS, int FACE_SIZE, LatticeSourceKind KIND>
OPENSUBDIVHEX_INLINE void loadSources(LatticeLoader<SIMD, ACCESS, FACE_SIZE> const &loader,
                                      LatticeTask const &,
                                      LatticeSources<SIMD, FACE_SIZE, KIND> &result) {
    using Vector = typename SIMD::Vector;
    using Orbits = typename LatticeSources<SIMD, FACE_SIZE, KIND>::Orbits;
    LatticeSourceWriter<SIMD, FACE_SIZE, KIND> writer{result};
    Vector x[FACE_SIZE];
    for (int i = 0; i < Orbits::kNumAxes; ++i) {
        loader.Load(i, x);
        writer.SetAxis(i, x);
    }
    for (int i = 0; i < Orbits::kNumPairs; ++i) {
        Vector y[FACE_SIZE];
        loader.Load(Orbits::kNumAxes + 2 * i, x);
        loader.Load(Orbits::kNumAxes + 2 * i + 1, y);
        writer.SetPair(i, x, y);
    }
}

/// All sources, the outer ones joined as GetJoinedSourceOrbits() says: of triangles,
template <class SIMD, class ACCESS>
OPENSUBDIVHEX_INLINE void loadSources(LatticeLoader<SIMD, ACCESS, 3> const &loader,
                                      LatticeTask const &task,
                                      LatticeSources<SIMD, 3, LatticeSourceKind::Joined> &result) {
    using Vector = typename SIMD::Vector;
    LatticeSourceWriter<SIMD, 3, LatticeSourceKind::Joined> writer{result};
    Vector const weight = SIMD::Spread(task.outerWeights[0]);
    Vector const halfWeight = SIMD::Spread(task.outerWeights[0] / 2);
    Vector x[3];
    Vector y[3];
    Vector joined[3];
    // Orbits 5 and 6.
    loader.Load(5, x);
    loader.Load(6, y);
    for (int i = 0; i < 3; ++i) {
        joined[i] = x[(i + 1) % 3] + y[(i + 2) % 3];
    }
    writer.SetAxis(3, joined);
    for (int i = 0; i < 3; ++i) {
        joined[i] = (y[(i + 1) % 3] - x[i]) + (x[(i + 2) % 3] - y[i]);
    }
    // Orbits 2, 7 and 8.
    loader.Load(2, x);
    for (int i = 0; i < 3; ++i) {
        joined[i] = SIMD::MultiplyAdd(halfWeight, joined[i], x[i]);
    }
    loader.Load(7, x);
    loader.Load(8, y);
    for (int i = 0; i < 3; ++i) {
        addProduct<SIMD>(joined[i], weight, x[i] + y[i]);
    }
    writer.SetAxis(2, joined);
    loader.Load(0, x);
    writer.SetAxis(0, x);
    loader.Load(1, x);
    writer.SetAxis(1, x);
    loader.Load(3, x);
    loader.Load(4, y);
    writer.SetPair(0, x, y);
}
/// of quads,
template <class SIMD, class ACCESS>
OPENSUBDIVHEX_INLINE void loadSources(LatticeLoader<SIMD, ACCESS, 4> const &loader,
                                      LatticeTask const &task,
                                      LatticeSources<SIMD, 4, LatticeSourceKind::Joined> &result) {
    using Vector = typename SIMD::Vector;
    LatticeSourceWriter<SIMD, 4, LatticeSourceKind::Joined> writer{result};
    Vector const weight = SIMD::Spread(task.outerWeights[0]);
    Vector const ofOther = SIMD::Spread(task.outerWeights[1]);
    Vector x[4];
    Vector y[4];
    loader.Load(0, x);
    writer.SetAxis(0, x);
    loader.Load(1, x);
    writer.SetAxis(1, x);
    loader.Load(2, x);
    loader.Load(3, y);
    writer.SetPair(0, x, y);
    Vector outer[4];
    Vector ofMirror[4];
    loader.Load(4, x);
    loader.Load(5, y);
    loader.Load(6, outer);
    loader.Load(7, ofMirror);
    for (int i = 0; i < 4; ++i) {
        addProduct<SIMD>(x[i], weight, outer[i]);
        addProduct<SIMD>(x[i], ofOther, ofMirror[(i + 1) % 4]);
        addProduct<SIMD>(y[i], weight, ofMirror[i]);
        addProduct<SIMD>(y[i], ofOther, outer[(i + 3) % 4]);
    }
    writer.SetPair(1, x, y);
}
/// and of hexagons.
template <class SIMD, class ACCESS>
OPENSUBDIVHEX_INLINE void loadSources(LatticeLoader<SIMD, ACCESS, 6> const &loader,
                                      LatticeTask const &task,
                                      LatticeSources<SIMD, 6, LatticeSourceKind::Joined> &result) {
    using Vector = typename SIMD::Vector;
    LatticeSourceWriter<SIMD, 6, LatticeSourceKind::Joined> writer{result};
    Vector const weight = SIMD::Spread(task.outerWeights[0]);
    Vector x[6];
    Vector y[6];
    Vector joined[6];
    loader.Load(0, x);
    writer.SetAxis(0, x);
    loader.Load(1, x);
    writer.SetAxis(1, x);
    loader.Load(2, joined);
    loader.Load(5, x);
    loader.Load(6, y);
    for (int i = 0; i < 6; ++i) {
        addProduct<SIMD>(joined[i], weight, x[i] + y[i]);
    }
    writer.SetAxis(2, joined);
    loader.Load(3, x);
    loader.Load(4, y);
    writer.SetPair(0, x, y);
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
template <class SIMD, int FACE_SIZE, LatticeSourceKind KIND, int NUM_OUTPUTS>
struct LatticeKernel {
    using Vector = typename SIMD::Vector;
    using Sources = LatticeSources<SIMD, FACE_SIZE, KIND>;
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

    /// Those of the first one.
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

    /// Of half the sum of the two orbits of a pair, and of half their difference in the mirror.
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

template <class SIMD, class ACCESS, int FACE_SIZE, LatticeSourceKind KIND, int NUM_OUTPUTS>
void evaluateLattice(LatticeTask const &task, Far::Index begin, Far::Index end) {
    using Kernel = LatticeKernel<SIMD, FACE_SIZE, KIND, NUM_OUTPUTS>;
    using Sources = LatticeSources<SIMD, FACE_SIZE, KIND>;
    constexpr int kGroup = RegularFaceGroup::kSize;
    constexpr int kNumDerivatives = LatticeTask::kNumDerivatives;
    Elements<float const> const values = task.values;
    Elements<float> outputs[NUM_OUTPUTS];
    for (int i = 0; i < NUM_OUTPUTS; ++i) {
        outputs[i] = task.outputs[i];
    }
    using Read = typename Sources::Read;
    std::ptrdiff_t const numPlaces =
        std::ptrdiff_t(kGroup) * FACE_SIZE * (Read::kNumAxes + 2 * Read::kNumPairs);
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
                task, sources);
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
