// SPDX-License-Identifier: Apache-2.0
//
// Compiled for AVX-512 F and VL; called only where the machine has them.
#ifdef OPENSUBDIVHEX_HAS_X86_KERNELS

#include "denseFaceKernelTemplate.h"

#include "osd_ext/simd/avx512.h"

namespace OpenSubdivHex::OsdExt::internal {
namespace {

/// Four rows, or the last ones.
struct FourRows {
    static constexpr int kNumRows = 4;

    /// In registers: reads bound this kernel (benchmark all levels, Smooth/quad/small: 1.1 times as fast).
    struct Mask {
        explicit OPENSUBDIVHEX_INLINE Mask(DenseFaceMask const &mask) {
            for (int vert = 0; vert < DenseFaceMask::kSize; ++vert) {
                Quad const *const weights = mask.weights[vert];
                first[vert] = _mm512_load_ps(reinterpret_cast<float const *>(weights));
                last[vert] = _mm256_load_ps(reinterpret_cast<float const *>(weights + kNumRows));
            }
        }
        template <int FIRST, int COUNT>
        OPENSUBDIVHEX_INLINE auto Get(int vert) const {
            static_assert((FIRST == 0 && COUNT == kNumRows) || (FIRST == kNumRows && COUNT == 2));
            if constexpr (FIRST == 0) {
                return first[vert];
            } else {
                return last[vert];
            }
        }

        __m512 first[DenseFaceMask::kSize];
        __m256 last[DenseFaceMask::kSize];
    };
    template <int COUNT>
    static OPENSUBDIVHEX_INLINE auto Spread(Quad const &quad) {
        if constexpr (COUNT == 1) {
            return quad;
        } else if constexpr (COUNT == 2) {
            // Half of what there is for the first rows.
            return _mm512_castps512_ps256(_mm512_broadcast_f32x4(__m128(quad)));
        } else {
            return _mm512_broadcast_f32x4(__m128(quad));
        }
    }
    template <int COUNT, class VECTOR>
    static OPENSUBDIVHEX_INLINE void Store(Quad *quads, VECTOR const &rows) {
        if constexpr (COUNT == 1) {
            quads[0] = rows;
        } else if constexpr (COUNT == 2) {
            quads[0] = Quad(_mm256_castps256_ps128(rows));
            quads[1] = Quad(_mm256_extractf128_ps(rows, 1));
        } else {
            quads[0] = Quad(_mm512_castps512_ps128(rows));
            quads[1] = Quad(_mm512_extractf32x4_ps(rows, 1));
            quads[2] = Quad(_mm512_extractf32x4_ps(rows, 2));
            if constexpr (COUNT > 3) {
                quads[3] = Quad(_mm512_extractf32x4_ps(rows, 3));
            }
        }
    }
};

} // namespace

DenseFaceKernels const kDenseFaceKernelsAvx512 = kKernelsOfRows<FourRows>;

} // namespace OpenSubdivHex::OsdExt::internal

#endif
