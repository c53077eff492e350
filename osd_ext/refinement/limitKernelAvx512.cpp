// SPDX-License-Identifier: Apache-2.0
//
// Compiled for AVX-512 F and VL; called only where the machine has them.
#ifdef OPENSUBDIVHEX_HAS_X86_KERNELS

#include "limitKernelTemplate.h"

#include "osd_ext/simd/avx512.h"

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
    static OPENSUBDIVHEX_INLINE Vector Load(float const *const *places) {
        return join(_mm_loadu_ps(places[0]), _mm_loadu_ps(places[1]), _mm_loadu_ps(places[2]),
                    _mm_loadu_ps(places[3]));
    }
    static OPENSUBDIVHEX_INLINE Vector LoadRest(float const *const *places, int length) {
        __mmask8 const mask = getMask(length);
        return join(_mm_maskz_loadu_ps(mask, places[0]), _mm_maskz_loadu_ps(mask, places[1]),
                    _mm_maskz_loadu_ps(mask, places[2]), _mm_maskz_loadu_ps(mask, places[3]));
    }
    static OPENSUBDIVHEX_INLINE void StorePoints(float *const *places, Vector vector) {
        StoreRest(places, vector, kPoint);
    }
    static OPENSUBDIVHEX_INLINE void StoreQuads(float *const *places, Vector vector) {
        __m128 ofFaces[kNumFaces];
        split(vector, ofFaces);
        for (int face = 0; face < kNumFaces; ++face) {
            _mm_storeu_ps(places[face], ofFaces[face]);
        }
    }
    static OPENSUBDIVHEX_INLINE void StoreRest(float *const *places, Vector vector, int length) {
        __m128 ofFaces[kNumFaces];
        split(vector, ofFaces);
        for (int face = 0; face < kNumFaces; ++face) {
            _mm_mask_storeu_ps(places[face], getMask(length), ofFaces[face]);
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
                    _mm256_mask_storeu_ps(place, getMask(2 * kPoint), pairs[i][face]);
                }
            }
            if constexpr (COUNT % 2 != 0) {
                _mm_mask_storeu_ps(places[face] + std::ptrdiff_t(COUNT - 1) * kPoint,
                                   getMask(kPoint), last[face]);
            }
        }
    }

private:
    // A mask of the first floats.
    static OPENSUBDIVHEX_INLINE __mmask8 getMask(int count) { return __mmask8((1U << count) - 1); }
    static OPENSUBDIVHEX_INLINE Vector join(__m128 first, __m128 second, __m128 third,
                                            __m128 fourth) {
        // Halves first: quads that are inserted one after the other wait for one another.
        __m256 const low = _mm256_insertf128_ps(_mm256_castps128_ps256(first), second, 1);
        __m256 const high = _mm256_insertf128_ps(_mm256_castps128_ps256(third), fourth, 1);
        return _mm512_castpd_ps(_mm512_insertf64x4(_mm512_castpd256_pd512(_mm256_castps_pd(low)),
                                                   _mm256_castps_pd(high), 1));
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
        // Lanes of two faces each: numbers from 16 on are floats of the second vector.
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
