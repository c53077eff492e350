// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_BFR_EXT_CELL_REGISTERS_H
#define OPENSUBDIVHEX_BFR_EXT_CELL_REGISTERS_H

#include "lanes.h"

#include <cstddef>
#include <utility>

#if defined(__GNUC__) && defined(__AVX2__)
#include <immintrin.h>
#endif

// Included by the source files of each set of instructions, which must not share what the compiler
// makes of it: hence the unnamed namespace.
namespace OpenSubdivHex::BfrExt::internal {
namespace {

/// Bytes of the registers that the compiler may use; 0: it has no types for them.
#if !defined(__GNUC__)
constexpr std::size_t kRegisterSize = 0;
#elif defined(__AVX512F__)
constexpr std::size_t kRegisterSize = 64;
#elif defined(__AVX2__)
constexpr std::size_t kRegisterSize = 32;
#else
constexpr std::size_t kRegisterSize = 16;
#endif

template <typename REAL, std::size_t BYTES, bool FITS = BYTES <= kRegisterSize>
struct LanesOf {
    using Type = Lanes<REAL, BYTES / sizeof(REAL)>;
};
#if defined(__GNUC__)
template <typename REAL, std::size_t BYTES>
struct LanesOf<REAL, BYTES, true> {
    using Type __attribute__((vector_size(BYTES))) = REAL;
};
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

/// Sums with products, which are rounded once where the machine fuses the two.
template <typename LANES>
OPENSUBDIVHEX_INLINE LANES addProducts(LANES const &sums, LANES const &a, LANES const &b) {
    return sums + a * b;
}
#if defined(__GNUC__) && defined(__AVX2__) && defined(__FMA__)
OPENSUBDIVHEX_INLINE __m128 addProducts(__m128 const &sums, __m128 const &a, __m128 const &b) {
    return _mm_fmadd_ps(a, b, sums);
}
OPENSUBDIVHEX_INLINE __m256 addProducts(__m256 const &sums, __m256 const &a, __m256 const &b) {
    return _mm256_fmadd_ps(a, b, sums);
}
OPENSUBDIVHEX_INLINE __m256d addProducts(__m256d const &sums, __m256d const &a, __m256d const &b) {
    return _mm256_fmadd_pd(a, b, sums);
}
#endif
#if defined(__GNUC__) && defined(__AVX512F__)
OPENSUBDIVHEX_INLINE __m512 addProducts(__m512 const &sums, __m512 const &a, __m512 const &b) {
    return _mm512_fmadd_ps(a, b, sums);
}
OPENSUBDIVHEX_INLINE __m512d addProducts(__m512d const &sums, __m512d const &a, __m512d const &b) {
    return _mm512_fmadd_pd(a, b, sums);
}
#endif

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
    OPENSUBDIVHEX_INLINE static void AddProducts(Lanes &sums, Lanes const &a, Lanes const &b) {
        sums = addProducts(sums, a, b);
    }
    OPENSUBDIVHEX_INLINE static void AddProducts(Lanes &sums, Lanes const &factors, REAL factor) {
        sums = addProducts(sums, factors, Spread(factor));
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
