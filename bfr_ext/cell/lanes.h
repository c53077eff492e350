// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_BFR_EXT_CELL_LANES_H
#define OPENSUBDIVHEX_BFR_EXT_CELL_LANES_H

#include "far_ext/vtr/inline.h"

#include <algorithm>
#include <cstddef>

namespace OpenSubdivHex::BfrExt::internal {

/// Some numbers, as those of a point, which are computed with at once.
template <typename REAL, std::size_t COUNT = 4>
struct Lanes {
    static constexpr std::size_t kCount = COUNT;

    OPENSUBDIVHEX_INLINE static Lanes Load(REAL const *from) {
        Lanes result;
        std::copy_n(from, kCount, result.values);
        return result;
    }
    OPENSUBDIVHEX_INLINE void Store(REAL *to) const { std::copy_n(values, kCount, to); }

    OPENSUBDIVHEX_INLINE Lanes operator+(Lanes const &other) const {
        Lanes result;
        for (std::size_t i = 0; i < kCount; ++i) {
            result.values[i] = values[i] + other.values[i];
        }
        return result;
    }
    OPENSUBDIVHEX_INLINE Lanes operator-(Lanes const &other) const {
        Lanes result;
        for (std::size_t i = 0; i < kCount; ++i) {
            result.values[i] = values[i] - other.values[i];
        }
        return result;
    }
    OPENSUBDIVHEX_INLINE Lanes operator*(Lanes const &other) const {
        Lanes result;
        for (std::size_t i = 0; i < kCount; ++i) {
            result.values[i] = values[i] * other.values[i];
        }
        return result;
    }
    OPENSUBDIVHEX_INLINE Lanes operator*(REAL factor) const {
        Lanes result;
        for (std::size_t i = 0; i < kCount; ++i) {
            result.values[i] = values[i] * factor;
        }
        return result;
    }

    OPENSUBDIVHEX_INLINE REAL &operator[](std::size_t i) { return values[i]; }
    OPENSUBDIVHEX_INLINE REAL operator[](std::size_t i) const { return values[i]; }

    REAL values[kCount];
};

} // namespace OpenSubdivHex::BfrExt::internal

#endif
