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

    template <int COUNT>
    static OPENSUBDIVHEX_INLINE auto Load(Quad const *quads) {
        auto const *const floats = reinterpret_cast<float const *>(quads);
        if constexpr (COUNT == 1) {
            return *quads;
        } else if constexpr (COUNT == 2) {
            return _mm256_load_ps(floats);
        } else {
            return _mm512_load_ps(floats);
        }
    }
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
