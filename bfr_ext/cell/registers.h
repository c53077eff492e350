// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_BFR_EXT_CELL_REGISTERS_H
#define OPENSUBDIVHEX_BFR_EXT_CELL_REGISTERS_H

#include "far_ext/vtr/inline.h"

#include <cstddef>
#include <type_traits>
#include <utility>

#ifdef __FMA__
#include <immintrin.h>
#endif

// Included by the source files of each set of instructions, which must not share what the compiler
// makes of it: hence the unnamed namespace.
namespace OpenSubdivHex::BfrExt::internal {
namespace {

/// Numbers that are computed with at once, in a register where the machine has such.
template <typename REAL, std::size_t BYTES>
struct PlainLanes {
    static constexpr std::size_t kSize = BYTES / sizeof(REAL);

    PlainLanes operator*(PlainLanes const &other) const {
        PlainLanes result;
        for (std::size_t i = 0; i < kSize; ++i) {
            result.values[i] = values[i] * other.values[i];
        }
        return result;
    }
    PlainLanes &operator+=(PlainLanes const &other) {
        for (std::size_t i = 0; i < kSize; ++i) {
            values[i] += other.values[i];
        }
        return *this;
    }
    PlainLanes operator+(PlainLanes const &other) const { return PlainLanes(*this) += other; }
    REAL &operator[](std::size_t i) { return values[i]; }
    REAL operator[](std::size_t i) const { return values[i]; }

    REAL values[kSize];
};

template <typename REAL, std::size_t BYTES>
struct LanesOf {
    using Type = PlainLanes<REAL, BYTES>;
};
#if defined(__GNUC__)
template <>
struct LanesOf<float, 16> {
    using Type = float __attribute__((vector_size(16)));
};
template <>
struct LanesOf<double, 16> {
    using Type = double __attribute__((vector_size(16)));
};
#ifdef __AVX2__
template <>
struct LanesOf<float, 32> {
    using Type = float __attribute__((vector_size(32)));
};
template <>
struct LanesOf<double, 32> {
    using Type = double __attribute__((vector_size(32)));
};
#endif
#ifdef __AVX512F__
template <>
struct LanesOf<float, 64> {
    using Type = float __attribute__((vector_size(64)));
};
template <>
struct LanesOf<double, 64> {
    using Type = double __attribute__((vector_size(64)));
};
#endif
#endif

/// Lanes as they lie in memory, aligned no more than numbers are.  They are read and written as such and
/// never by std::memcpy(), with which compilers would keep all sums in memory.
template <typename LANES>
struct
#if defined(__GNUC__)
    __attribute__((packed, may_alias))
#endif
    LanesInMemory {
    LANES lanes;
};

/// What kernels compute with.
template <typename REAL, std::size_t BYTES>
struct Registers {
    using Lanes = typename LanesOf<REAL, BYTES>::Type;
    static constexpr std::size_t kSize = BYTES / sizeof(REAL);
    static_assert(sizeof(Lanes) == BYTES);

    OPENSUBDIVHEX_INLINE static Lanes Load(REAL const *from) {
        return reinterpret_cast<LanesInMemory<Lanes> const *>(from)->lanes;
    }
    OPENSUBDIVHEX_INLINE static void Store(Lanes const &lanes, REAL *to) {
        reinterpret_cast<LanesInMemory<Lanes> *>(to)->lanes = lanes;
    }

    /// The same number in all lanes.
    OPENSUBDIVHEX_INLINE static Lanes Spread(REAL number) {
        return spread(number, std::make_index_sequence<kSize>());
    }
    /// Adds products to sums, which are rounded once where the registers are those of machines that fuse the two.
    OPENSUBDIVHEX_INLINE static void AddProducts(Lanes &sums, Lanes const &a, Lanes const &b) {
#ifdef __AVX512F__
        if constexpr (BYTES == 64 && std::is_same_v<REAL, float>) {
            sums = Lanes(_mm512_fmadd_ps(__m512(a), __m512(b), __m512(sums)));
            return;
        }
        if constexpr (BYTES == 64 && std::is_same_v<REAL, double>) {
            sums = Lanes(_mm512_fmadd_pd(__m512d(a), __m512d(b), __m512d(sums)));
            return;
        }
#endif
#if defined(__AVX2__) && defined(__FMA__)
        if constexpr (BYTES == 16 && std::is_same_v<REAL, float>) {
            sums = Lanes(_mm_fmadd_ps(__m128(a), __m128(b), __m128(sums)));
            return;
        }
        if constexpr (BYTES == 32 && std::is_same_v<REAL, float>) {
            sums = Lanes(_mm256_fmadd_ps(__m256(a), __m256(b), __m256(sums)));
            return;
        }
        if constexpr (BYTES == 32 && std::is_same_v<REAL, double>) {
            sums = Lanes(_mm256_fmadd_pd(__m256d(a), __m256d(b), __m256d(sums)));
            return;
        }
#endif
        sums += a * b;
    }
    OPENSUBDIVHEX_INLINE static void AddProducts(Lanes &sums, Lanes const &factors, REAL factor) {
        AddProducts(sums, factors, Spread(factor));
    }

private:
    template <std::size_t... I>
    OPENSUBDIVHEX_INLINE static Lanes spread(REAL number, std::index_sequence<I...> /*lanes*/) {
        return Lanes{(static_cast<void>(I), number)...};
    }
};

} // namespace
} // namespace OpenSubdivHex::BfrExt::internal

#endif
