// SPDX-License-Identifier: Apache-2.0
//
// Compiled for AVX2 and FMA; called only where the machine has them.
#ifdef OPENSUBDIVHEX_HAS_X86_KERNELS

#include "limitKernelTemplate.h"

#include "osd_ext/simd/octet.h"

namespace OpenSubdivHex::OsdExt::internal {
namespace {

/// Two faces.
struct Avx2Faces : Avx2Octet {
    static constexpr int kNumFaces = 2;

    static OPENSUBDIVHEX_INLINE Vector Load(float const *const *places) {
        return Join(LoadFloats<kQuad>(places[0]), LoadFloats<kQuad>(places[1]));
    }
    static OPENSUBDIVHEX_INLINE Vector LoadRest(float const *const *places, int length) {
        __m128i const isRead = _mm_cmpgt_epi32(_mm_set1_epi32(length), _mm_setr_epi32(0, 1, 2, 3));
        return Join(Quad(_mm_maskload_ps(places[0], isRead)),
                    Quad(_mm_maskload_ps(places[1], isRead)));
    }
    static OPENSUBDIVHEX_INLINE void StorePoints(float *const *places, Vector vector) {
        StoreFloats<kPoint>(places[0], GetFirst(vector));
        StoreFloats<kPoint>(places[1], GetSecond(vector));
    }
    static OPENSUBDIVHEX_INLINE void StoreQuads(float *const *places, Vector vector) {
        StoreFloats<kQuad>(places[0], GetFirst(vector));
        StoreFloats<kQuad>(places[1], GetSecond(vector));
    }
    static OPENSUBDIVHEX_INLINE void StoreRest(float *const *places, Vector vector, int length) {
        OsdExt::internal::StoreRest(places[0], GetFirst(vector), length);
        OsdExt::internal::StoreRest(places[1], GetSecond(vector), length);
    }
    template <int COUNT>
    static OPENSUBDIVHEX_INLINE void StoreRun(float *const *places, Vector const (&x)[COUNT]) {
        // Joining points takes as long as it saves: each overwrites the first float of the next one.
        float *next[] = {places[0], places[1]};
        for (int i = 0; i + 1 < COUNT; ++i) {
            StoreQuads(next, x[i]);
            next[0] += kPoint;
            next[1] += kPoint;
        }
        StorePoints(next, x[COUNT - 1]);
    }
};

} // namespace

LimitKernel const kLimitKernelAvx2 = LimitKernels<Avx2Faces>::kKernel;

} // namespace OpenSubdivHex::OsdExt::internal

#endif
