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
    template <bool IS_EXACT>
    static OPENSUBDIVHEX_INLINE void StorePairs(float *const *places, Vector const &first,
                                                Vector const &second) {
        StoreFloats<kQuad>(places[0], first);
        StoreFloats<IS_EXACT ? kPoint : kQuad>(places[0] + kPoint, second);
    }
};

} // namespace

LimitKernel const kLimitKernelPortable = LimitKernels<PortableFaces>::kKernel;

} // namespace OpenSubdivHex::OsdExt::internal
