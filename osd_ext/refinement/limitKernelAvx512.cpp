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
        __m128 ofFaces[kNumFaces];
        split(vector, ofFaces);
        for (int face = 0; face < kNumFaces; ++face) {
            store<WIDTH>(places[face], ofFaces[face]);
        }
    }
    template <int COUNT>
    static OPENSUBDIVHEX_INLINE void StoreRun(float *const *places, Vector const (&x)[COUNT]) {
        constexpr int kNumPairs = COUNT / 2;
        __m256 pairs[kNumPairs][kNumFaces];
        for (int i = 0; i < kNumPairs; ++i) {
            joinPairs(x[2 * i], x[2 * i + 1], pairs[i]);
        }
        __m128 last[kNumFaces];
        if constexpr (COUNT % 2 != 0) {
            split(x[COUNT - 1], last);
        }
        // Face by face: what goes to one cache line takes less time together.
        for (int face = 0; face < kNumFaces; ++face) {
            for (int i = 0; i < kNumPairs; ++i) {
                // Each two overwrite what comes behind them, but for the last ones.
                float *const place = places[face] + std::ptrdiff_t(2 * kPoint) * i;
                if (2 * i + 2 < COUNT) {
                    _mm256_storeu_ps(place, pairs[i][face]);
                } else {
                    constexpr __mmask8 kTwoPoints = 0x3f;
                    _mm256_mask_storeu_ps(place, kTwoPoints, pairs[i][face]);
                }
            }
            if constexpr (COUNT % 2 != 0) {
                store<kPoint>(places[face] + std::ptrdiff_t(COUNT - 1) * kPoint, last[face]);
            }
        }
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
    static OPENSUBDIVHEX_INLINE void split(Vector vector, __m128 (&ofFaces)[kNumFaces]) {
        ofFaces[0] = _mm512_castps512_ps128(vector);
        ofFaces[1] = _mm512_extractf32x4_ps(vector, 1);
        ofFaces[2] = _mm512_extractf32x4_ps(vector, 2);
        ofFaces[3] = _mm512_extractf32x4_ps(vector, 3);
    }
    // Two points of each face, side by side.
    static OPENSUBDIVHEX_INLINE void joinPairs(Vector first, Vector second,
                                               __m256 (&ofFaces)[kNumFaces]) {
        // Of two faces each: numbers from 16 on are floats of the second vector.
        __m512i const ofFirstFaces =
            _mm512_setr_epi32(0, 1, 2, 16, 17, 18, 3, 19, 4, 5, 6, 20, 21, 22, 7, 23);
        __m512i const ofLastFaces = _mm512_add_epi32(ofFirstFaces, _mm512_set1_epi32(8));
        splitPairs(_mm512_permutex2var_ps(first, ofFirstFaces, second), ofFaces);
        splitPairs(_mm512_permutex2var_ps(first, ofLastFaces, second), ofFaces + 2);
    }
    static OPENSUBDIVHEX_INLINE void splitPairs(Vector pairs, __m256 *ofFaces) {
        ofFaces[0] = _mm512_castps512_ps256(pairs);
        ofFaces[1] = _mm256_castpd_ps(_mm512_extractf64x4_pd(_mm512_castps_pd(pairs), 1));
    }
};

} // namespace

LimitKernel const kLimitKernelAvx512 = LimitKernels<Avx512Faces>::kKernel;

} // namespace OpenSubdivHex::OsdExt::internal

#endif
