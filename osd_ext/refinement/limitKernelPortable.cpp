// SPDX-License-Identifier: Apache-2.0
#include "limitKernelTemplate.h"

namespace OpenSubdivHex::OsdExt::internal {
namespace {

/// One face.
struct PortableFaces {
    static constexpr int kNumFaces = 1;
    using Vector = Quad;

    static OPENSUBDIVHEX_INLINE Vector Spread(float value) {
        return OsdExt::internal::Spread(value);
    }
    static OPENSUBDIVHEX_INLINE Vector MultiplyAdd(Vector const &a, Vector const &b,
                                                   Vector const &sum) {
        return sum + a * b;
    }
    template <int WIDTH>
    static OPENSUBDIVHEX_INLINE Vector Load(float const *const *places) {
        return LoadFloats<WIDTH>(places[0]);
    }
    template <int WIDTH>
    static OPENSUBDIVHEX_INLINE void Store(float *const *places, Vector const &vector) {
        StoreFloats<WIDTH>(places[0], vector);
    }
    template <int COUNT>
    static OPENSUBDIVHEX_INLINE void StoreRun(float *const *places, Vector const (&x)[COUNT]) {
        float *next = places[0];
        for (int i = 0; i + 1 < COUNT; ++i, next += kPoint) {
            StoreFloats<kQuad>(next, x[i]);
        }
        StoreFloats<kPoint>(next, x[COUNT - 1]);
    }
};

} // namespace

LimitKernel const kLimitKernelPortable = LimitKernels<PortableFaces>::kKernel;

} // namespace OpenSubdivHex::OsdExt::internal
