// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_OSD_EXT_REFINEMENT_ELEMENT_ACCESS_H
#define OPENSUBDIVHEX_OSD_EXT_REFINEMENT_ELEMENT_ACCESS_H

#include "refinementKernel.h"

#include "osd_ext/simd/quad.h"

#include <cstddef>

namespace OpenSubdivHex::OsdExt::internal {
namespace {

constexpr int kQuadPair = 8; ///< floats

// Eight floats.
struct QuadPair {
    Quad first;
    Quad second;
};
inline QuadPair operator+(QuadPair const &a, QuadPair const &b) {
    return {a.first + b.first, a.second + b.second};
}
inline QuadPair operator*(Quad const &a, QuadPair const &b) { return {a * b.first, a * b.second}; }

// Reads WIDTH floats, 1 to 8, and not one more.
template <int WIDTH>
inline auto loadExactly(float const *src) {
    if constexpr (WIDTH > kQuad) {
        return QuadPair{LoadFloats<kQuad>(src), LoadFloats<WIDTH - kQuad>(src + kQuad)};
    } else {
        return LoadFloats<WIDTH>(src);
    }
}
template <int WIDTH>
inline void storeExactly(float *dst, Quad const &quad) {
    StoreFloats<WIDTH>(dst, quad);
}
template <int WIDTH>
inline void storeExactly(float *dst, QuadPair const &pair) {
    StoreFloats<kQuad>(dst, pair.first);
    StoreFloats<WIDTH - kQuad>(dst + kQuad, pair.second);
}

// How elements of WIDTH floats are read and written.  What is not exact takes in a float of the element that
// follows, where three are packed: one that no other thread may be writing meanwhile.
template <int WIDTH, bool IS_PACKED>
struct Access {
    static constexpr int kWidth = WIDTH;
    static constexpr bool kIsPacked = IS_PACKED;
    static constexpr int kReach = IS_PACKED && WIDTH == 3 ? kQuad : WIDTH;

    template <class FLOAT>
    static FLOAT *At(Elements<FLOAT> const &elements, std::ptrdiff_t i) {
        return elements.data + i * (IS_PACKED ? WIDTH : elements.stride);
    }
    static auto LoadExactly(Elements<float const> const &src, std::ptrdiff_t i) {
        return loadExactly<WIDTH>(At(src, i));
    }
    // With the first float of the next element.
    static auto Load(Elements<float const> const &src, std::ptrdiff_t i) {
        return loadExactly<kReach>(At(src, i));
    }
    template <class QUADS>
    static void StoreExactly(Elements<float> const &dst, std::ptrdiff_t i, QUADS const &quads) {
        storeExactly<WIDTH>(At(dst, i), quads);
    }
    // This thread stores the next element afterwards.
    template <class QUADS>
    static void Store(Elements<float> const &dst, std::ptrdiff_t i, QUADS const &quads) {
        storeExactly<kReach>(At(dst, i), quads);
    }
};

OPENSUBDIVHEX_INLINE Elements<float const> asConst(Elements<float> const &elements) {
    return {elements.data, elements.stride};
}

} // namespace
} // namespace OpenSubdivHex::OsdExt::internal

#endif
