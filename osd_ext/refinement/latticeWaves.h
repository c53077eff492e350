// SPDX-License-Identifier: Apache-2.0
//
// Values around a lattice face as waves: compiled once per SIMD level with the kernel of lattice faces,
// by the rules of limitKernelTemplate.h.
#ifndef OPENSUBDIVHEX_OSD_EXT_REFINEMENT_LATTICE_WAVES_H
#define OPENSUBDIVHEX_OSD_EXT_REFINEMENT_LATTICE_WAVES_H

#include "limitAccess.h"

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

/// Returns the waves of values, but mean and alternating wave n times as large, the other waves n / 2 times.
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

/// Finds the values in the mirror: of waves whose sines have the other sign.
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

} // namespace
} // namespace OpenSubdivHex::OsdExt::internal

#endif
