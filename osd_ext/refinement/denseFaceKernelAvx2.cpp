// SPDX-License-Identifier: Apache-2.0
//
// Compiled for AVX2; called only where the machine has it.
#ifdef OPENSUBDIVHEX_HAS_X86_KERNELS

#include "denseFaceKernelTemplate.h"

#include <immintrin.h>

namespace OpenSubdivHex::OsdExt::internal {
namespace {

/// Two rows, or a last one.
struct TwoRows {
    static constexpr int kNumRows = 2;

    struct Mask {
        explicit Mask(DenseFaceMask const &mask) : weights(mask.weights) {}
        template <int FIRST, int COUNT>
        OPENSUBDIVHEX_INLINE auto Get(int vert) const {
            static_assert(COUNT == kNumRows);
            return _mm256_load_ps(reinterpret_cast<float const *>(weights[vert] + FIRST));
        }

        Quad const (*weights)[DenseFaceMask::kRowStride];
    };
    template <int COUNT>
    static OPENSUBDIVHEX_INLINE auto Spread(Quad const &quad) {
        if constexpr (COUNT == 1) {
            return quad;
        } else {
            return _mm256_set_m128(__m128(quad), __m128(quad));
        }
    }
    template <int COUNT, class VECTOR>
    static OPENSUBDIVHEX_INLINE void Store(Quad *quads, VECTOR const &rows) {
        if constexpr (COUNT == 1) {
            quads[0] = rows;
        } else {
            quads[0] = Quad(_mm256_castps256_ps128(rows));
            quads[1] = Quad(_mm256_extractf128_ps(rows, 1));
        }
    }
};

} // namespace

DenseFaceKernels const kDenseFaceKernelsAvx2 = kKernelsOfRows<TwoRows>;

} // namespace OpenSubdivHex::OsdExt::internal

#endif
