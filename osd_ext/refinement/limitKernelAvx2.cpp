// SPDX-License-Identifier: Apache-2.0
//
// Compiled for AVX2 and FMA; called only where the machine has them.
#ifdef OPENSUBDIVHEX_HAS_X86_KERNELS

#include "limitKernelTemplate.h"

#include <immintrin.h>

namespace OpenSubdivHex::OsdExt::internal {
namespace {

/// Two faces.
struct Avx2Faces {
    static constexpr int kNumFaces = 2;
    using Vector = __m256;

    static OPENSUBDIVHEX_INLINE Vector Spread(float value) { return _mm256_set1_ps(value); }
    static OPENSUBDIVHEX_INLINE Vector MultiplyAdd(Vector a, Vector b, Vector sum) {
        return _mm256_fmadd_ps(a, b, sum);
    }
    template <int WIDTH>
    static OPENSUBDIVHEX_INLINE Vector Load(float const *const *places) {
        return _mm256_insertf128_ps(_mm256_castps128_ps256(load<WIDTH>(places[0])),
                                    load<WIDTH>(places[1]), 1);
    }
    template <int WIDTH>
    static OPENSUBDIVHEX_INLINE void Store(float *const *places, Vector vector) {
        StoreFloats<WIDTH>(places[0], Quad(_mm256_castps256_ps128(vector)));
        StoreFloats<WIDTH>(places[1], Quad(_mm256_extractf128_ps(vector, 1)));
    }
    template <int COUNT>
    static OPENSUBDIVHEX_INLINE void StoreRun(float *const *places, Vector const (&x)[COUNT]) {
        // Joining points takes as long as it saves: each overwrites the first float of the next one.
        float *next[] = {places[0], places[1]};
        for (int i = 0; i + 1 < COUNT; ++i) {
            Store<kQuad>(next, x[i]);
            next[0] += kPoint;
            next[1] += kPoint;
        }
        Store<kPoint>(next, x[COUNT - 1]);
    }

private:
    template <int WIDTH>
    static OPENSUBDIVHEX_INLINE __m128 load(float const *place) {
        return __m128(LoadFloats<WIDTH>(place));
    }
};

} // namespace

LimitKernel const kLimitKernelAvx2 = LimitKernels<Avx2Faces>::kKernel;

} // namespace OpenSubdivHex::OsdExt::internal

#endif
