// SPDX-License-Identifier: Apache-2.0
//
// Eight floats, as two quads, on processors of any kind and with AVX2.
#ifndef OPENSUBDIVHEX_OSD_EXT_SIMD_OCTET_H
#define OPENSUBDIVHEX_OSD_EXT_SIMD_OCTET_H

#include "quad.h"

namespace OpenSubdivHex::OsdExt::internal {
namespace {

/// In plain C++, in a form that compilers turn into the vectors of any machine.
struct PortableOctet {
    struct Vector {
        Quad first;
        Quad second;
    };

    static OPENSUBDIVHEX_INLINE Vector Join(Quad const &first, Quad const &second) {
        return {first, second};
    }
    static OPENSUBDIVHEX_INLINE Quad GetFirst(Vector const &vector) { return vector.first; }
    static OPENSUBDIVHEX_INLINE Quad GetSecond(Vector const &vector) { return vector.second; }
    /// The first quad of one, the second of the other.
    static OPENSUBDIVHEX_INLINE Vector Mix(Vector const &first, Vector const &second) {
        return {first.first, second.second};
    }
    static OPENSUBDIVHEX_INLINE Vector Add(Vector const &a, Vector const &b) {
        return {a.first + b.first, a.second + b.second};
    }
    /// Rounds products.
    static OPENSUBDIVHEX_INLINE Vector MultiplyAdd(Vector const &a, Vector const &b,
                                                   Vector const &sum) {
        return {sum.first + a.first * b.first, sum.second + a.second * b.second};
    }
    static OPENSUBDIVHEX_INLINE Vector Spread(float value) {
        return {internal::Spread(value), internal::Spread(value)};
    }
    /// The first value in one quad, the second in the other.
    static OPENSUBDIVHEX_INLINE Vector SpreadTwo(float const *values) {
        return {internal::Spread(values[0]), internal::Spread(values[1])};
    }
};

#if defined(__AVX2__) && defined(__FMA__)
/// For sources that are compiled for AVX2 and FMA.
struct Avx2Octet {
    using Vector = __m256;

    static OPENSUBDIVHEX_INLINE Vector Join(Quad const &first, Quad const &second) {
        return _mm256_insertf128_ps(_mm256_castps128_ps256(__m128(first)), __m128(second), 1);
    }
    static OPENSUBDIVHEX_INLINE Quad GetFirst(Vector vector) {
        return Quad(_mm256_castps256_ps128(vector));
    }
    static OPENSUBDIVHEX_INLINE Quad GetSecond(Vector vector) {
        return Quad(_mm256_extractf128_ps(vector, 1));
    }
    static OPENSUBDIVHEX_INLINE Vector Mix(Vector first, Vector second) {
        return _mm256_blend_ps(first, second, 0xf0);
    }
    static OPENSUBDIVHEX_INLINE Vector Add(Vector a, Vector b) { return _mm256_add_ps(a, b); }
    /// Rounds sums alone.
    static OPENSUBDIVHEX_INLINE Vector MultiplyAdd(Vector a, Vector b, Vector sum) {
        return _mm256_fmadd_ps(a, b, sum);
    }
    static OPENSUBDIVHEX_INLINE Vector Spread(float value) { return _mm256_set1_ps(value); }
    static OPENSUBDIVHEX_INLINE Vector SpreadTwo(float const *values) {
        return _mm256_permutevar8x32_ps(_mm256_castps128_ps256(__m128(LoadFloats<2>(values))),
                                        _mm256_setr_epi32(0, 0, 0, 0, 1, 1, 1, 1));
    }
};
#endif

} // namespace
} // namespace OpenSubdivHex::OsdExt::internal

#endif
