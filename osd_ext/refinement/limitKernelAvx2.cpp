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
    template <bool IS_EXACT>
    static OPENSUBDIVHEX_INLINE void StorePairs(float *const *places, Vector first, Vector second) {
        // Joining them takes as long as it saves.
        float *const ofSecond[] = {places[0] + kPoint, places[1] + kPoint};
        Store<kQuad>(places, first);
        Store<IS_EXACT ? kPoint : kQuad>(ofSecond, second);
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
