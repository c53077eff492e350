// SPDX-License-Identifier: Apache-2.0
//
// Compiled for AVX-512 F and VL; called only where the machine has them.
#ifdef OPENSUBDIVHEX_HAS_X86_KERNELS

#include "limitKernelTemplate.h"

#if defined(__GNUC__) && !defined(__clang__)
// GCC 12 sees uninitialized values in its own intrinsics.
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#pragma GCC diagnostic ignored "-Wuninitialized"
#endif
#include <immintrin.h>

namespace OpenSubdivHex::OsdExt::internal {
namespace {

/// Four faces.
struct Avx512Faces {
    static constexpr int kNumFaces = 4;
    using Vector = __m512;

    static OPENSUBDIVHEX_INLINE Vector Spread(float value) { return _mm512_set1_ps(value); }
    static OPENSUBDIVHEX_INLINE Vector MultiplyAdd(Vector a, Vector b, Vector sum) {
        return _mm512_fmadd_ps(a, b, sum);
    }
    template <int WIDTH>
    static OPENSUBDIVHEX_INLINE Vector Load(float const *const *places) {
        // Halves first: quads that are inserted one after the other wait for one another.
        __m512d const low = _mm512_castpd256_pd512(_mm256_castps_pd(loadPair<WIDTH>(places)));
        __m256d const high = _mm256_castps_pd(loadPair<WIDTH>(places + 2));
        return _mm512_castpd_ps(_mm512_insertf64x4(low, high, 1));
    }
    template <int WIDTH>
    static OPENSUBDIVHEX_INLINE void Store(float *const *places, Vector vector) {
        store<WIDTH>(places[0], _mm512_castps512_ps128(vector));
        store<WIDTH>(places[1], _mm512_extractf32x4_ps(vector, 1));
        store<WIDTH>(places[2], _mm512_extractf32x4_ps(vector, 2));
        store<WIDTH>(places[3], _mm512_extractf32x4_ps(vector, 3));
    }
    template <bool IS_EXACT>
    static OPENSUBDIVHEX_INLINE void StorePairs(float *const *places, Vector first, Vector second) {
        // Of two faces each: numbers from 16 on are floats of the second vector.
        __m512i const ofFirstFaces =
            _mm512_setr_epi32(0, 1, 2, 16, 17, 18, 3, 19, 4, 5, 6, 20, 21, 22, 7, 23);
        __m512i const ofLastFaces = _mm512_add_epi32(ofFirstFaces, _mm512_set1_epi32(8));
        storePairs<IS_EXACT>(places, _mm512_permutex2var_ps(first, ofFirstFaces, second));
        storePairs<IS_EXACT>(places + 2, _mm512_permutex2var_ps(first, ofLastFaces, second));
    }

private:
    template <int WIDTH>
    static OPENSUBDIVHEX_INLINE __m256 loadPair(float const *const *places) {
        return _mm256_insertf128_ps(_mm256_castps128_ps256(__m128(LoadFloats<WIDTH>(places[0]))),
                                    __m128(LoadFloats<WIDTH>(places[1])), 1);
    }
    template <int WIDTH>
    static OPENSUBDIVHEX_INLINE void store(float *place, __m128 quad) {
        if constexpr (WIDTH == kPoint) {
            constexpr __mmask8 kOnePoint = 0x7;
            _mm_mask_storeu_ps(place, kOnePoint, quad);
        } else {
            StoreFloats<WIDTH>(place, Quad(quad));
        }
    }
    // Eight floats of each of two faces.
    template <bool IS_EXACT>
    static OPENSUBDIVHEX_INLINE void storePairs(float *const *places, Vector pairs) {
        storePair<IS_EXACT>(places[0], _mm512_castps512_ps256(pairs));
        storePair<IS_EXACT>(places[1],
                            _mm256_castpd_ps(_mm512_extractf64x4_pd(_mm512_castps_pd(pairs), 1)));
    }
    template <bool IS_EXACT>
    static OPENSUBDIVHEX_INLINE void storePair(float *place, __m256 pair) {
        constexpr __mmask8 kTwoPoints = 0x3f;
        if constexpr (IS_EXACT) {
            _mm256_mask_storeu_ps(place, kTwoPoints, pair);
        } else {
            _mm256_storeu_ps(place, pair);
        }
    }
};

} // namespace

LimitKernel const kLimitKernelAvx512 = LimitKernels<Avx512Faces>::kKernel;

} // namespace OpenSubdivHex::OsdExt::internal

#endif
