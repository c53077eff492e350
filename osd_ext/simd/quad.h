// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_OSD_EXT_SIMD_QUAD_H
#define OPENSUBDIVHEX_OSD_EXT_SIMD_QUAD_H

#include "far_ext/vtr/inline.h"

#include <cstring>

#ifdef __AVX__
#include <immintrin.h>
#endif

namespace OpenSubdivHex::OsdExt::internal {
// Files that are compiled for other processors have quads of their own: none may be linked with
// the code of another.
namespace {

constexpr int kQuad = 4; ///< floats

/// Four floats, in a register where the machine has such.
#if defined(__GNUC__)
using Quad = float __attribute__((vector_size(kQuad * sizeof(float))));
#else
struct Quad {
    float values[kQuad];

    float &operator[](int i) { return values[i]; }
    float operator[](int i) const { return values[i]; }
};

inline Quad operator+(Quad const &a, Quad const &b) {
    return {{a[0] + b[0], a[1] + b[1], a[2] + b[2], a[3] + b[3]}};
}
inline Quad operator*(Quad const &a, Quad const &b) {
    return {{a[0] * b[0], a[1] * b[1], a[2] * b[2], a[3] * b[3]}};
}
#endif

OPENSUBDIVHEX_INLINE Quad Spread(float value) { return Quad{value, value, value, value}; }

/// Element I of a quad four times, which takes no memory access.
template <int I>
OPENSUBDIVHEX_INLINE Quad SpreadElement(Quad const &quad) {
#if defined(__clang__)
    return __builtin_shufflevector(quad, quad, I, I, I, I);
#elif defined(__GNUC__)
    using Places = int __attribute__((vector_size(kQuad * sizeof(int))));
    return __builtin_shuffle(quad, Places{I, I, I, I});
#else
    return Spread(quad[I]);
#endif
}

/// Reads the first WIDTH floats, 1 to 4, and not one more; the others are 0.
template <int WIDTH>
OPENSUBDIVHEX_INLINE Quad LoadFloats(float const *src) {
    if constexpr (WIDTH == kQuad) {
        Quad result;
        std::memcpy(&result, src, sizeof(result));
        return result;
#ifdef __AVX__
    } else if constexpr (WIDTH == 3) {
        return Quad(_mm_maskload_ps(src, _mm_setr_epi32(-1, -1, -1, 0)));
#endif
#ifdef __SSE2__
    } else if constexpr (WIDTH > 1) {
        // Two at once, as a double; compilers read them one by one.
        using Pairs = double __attribute__((vector_size(kQuad * sizeof(float))));
        double pair = 0;
        std::memcpy(&pair, src, sizeof(pair));
        auto const rest = reinterpret_cast<Pairs>(Quad{WIDTH > 2 ? src[2] : 0, 0, 0, 0});
        return reinterpret_cast<Quad>(Pairs{pair, rest[0]});
#endif
    } else {
        return Quad{src[0], WIDTH > 1 ? src[1] : 0, WIDTH > 2 ? src[2] : 0, 0};
    }
}

/// Writes the first WIDTH floats, 1 to 4.  One by one where there is no such register: compilers
/// take a copy of three for a reason to go through memory.
template <int WIDTH>
OPENSUBDIVHEX_INLINE void StoreFloats(float *dst, Quad const &packet) {
    if constexpr (WIDTH == kQuad) {
        std::memcpy(dst, &packet, sizeof(packet));
    } else {
        for (int i = 0; i < WIDTH; ++i) {
            dst[i] = packet[i];
        }
    }
}

/// Reads the first \p length floats, 1 to 3, and not one more; the others are 0.
OPENSUBDIVHEX_INLINE Quad LoadRest(float const *src, int length) {
    return Quad{src[0], length > 1 ? src[1] : 0, length > 2 ? src[2] : 0, 0};
}

/// Writes the first \p length floats, 1 to 3.
OPENSUBDIVHEX_INLINE void StoreRest(float *dst, Quad const &packet, int length) {
    dst[0] = packet[0];
    if (length > 1) {
        dst[1] = packet[1];
    }
    if (length > 2) {
        dst[2] = packet[2];
    }
}

} // namespace
} // namespace OpenSubdivHex::OsdExt::internal

#endif
