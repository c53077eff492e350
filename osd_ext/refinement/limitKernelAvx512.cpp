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
        Vector result = _mm512_castps128_ps512(load<WIDTH>(places[0]));
        result = _mm512_insertf32x4(result, load<WIDTH>(places[1]), 1);
        result = _mm512_insertf32x4(result, load<WIDTH>(places[2]), 2);
        return _mm512_insertf32x4(result, load<WIDTH>(places[3]), 3);
    }
    template <int WIDTH>
    static OPENSUBDIVHEX_INLINE void Store(float *const *places, Vector vector) {
        StoreFloats<WIDTH>(places[0], Quad(_mm512_castps512_ps128(vector)));
        StoreFloats<WIDTH>(places[1], Quad(_mm512_extractf32x4_ps(vector, 1)));
        StoreFloats<WIDTH>(places[2], Quad(_mm512_extractf32x4_ps(vector, 2)));
        StoreFloats<WIDTH>(places[3], Quad(_mm512_extractf32x4_ps(vector, 3)));
    }

private:
    template <int WIDTH>
    static OPENSUBDIVHEX_INLINE __m128 load(float const *place) {
        return __m128(LoadFloats<WIDTH>(place));
    }
};

} // namespace

LimitKernel const kLimitKernelAvx512 = LimitKernels<Avx512Faces>::kKernel;

} // namespace OpenSubdivHex::OsdExt::internal

#endif
