// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_BFR_EXT_CELL_PATCH_SUMS_TEMPLATE_H
#define OPENSUBDIVHEX_BFR_EXT_CELL_PATCH_SUMS_TEMPLATE_H

#include "patchSums.h"
#include "registers.h"

#include <algorithm>
#include <iterator>
#include <limits>
#include <type_traits>

// Included by one source file for each set of instructions: hence the unnamed namespace.
namespace OpenSubdivHex::BfrExt::internal {
namespace {

/// Numbers of a point that are summed up at once.
constexpr int kNumPointLanes = 4;

/// \brief Some points, number by number: a register of each, with a lane for each point.
template <typename REAL>
struct PointColumns {
    using Columns = Registers<REAL, 32>;
    using Numbers = typename Columns::Lanes[kNumPointLanes];
    using Point = Registers<REAL, kNumPointLanes * sizeof(REAL)>;
    static_assert(PatchBlock<REAL>::kGroup == int(Columns::kSize));

    /// Of points of \p size numbers.
    OPENSUBDIVHEX_INLINE static void Load(REAL const *points, std::ptrdiff_t stride, int size,
                                          int const *indices, Numbers &numbers);
    /// The sum of all points.
    OPENSUBDIVHEX_INLINE static typename Point::Lanes SumUp(Numbers const &numbers);
};

#if defined(__GNUC__) && defined(__AVX2__)
/// Turns rows of four numbers into columns, in each half of the registers.
OPENSUBDIVHEX_INLINE void transposeFour(__m256 const (&rows)[4], __m256 (&columns)[4]) {
    __m256d const low01 = _mm256_castps_pd(_mm256_unpacklo_ps(rows[0], rows[1]));
    __m256d const low23 = _mm256_castps_pd(_mm256_unpacklo_ps(rows[2], rows[3]));
    __m256d const high01 = _mm256_castps_pd(_mm256_unpackhi_ps(rows[0], rows[1]));
    __m256d const high23 = _mm256_castps_pd(_mm256_unpackhi_ps(rows[2], rows[3]));
    columns[0] = _mm256_castpd_ps(_mm256_unpacklo_pd(low01, low23));
    columns[1] = _mm256_castpd_ps(_mm256_unpackhi_pd(low01, low23));
    columns[2] = _mm256_castpd_ps(_mm256_unpacklo_pd(high01, high23));
    columns[3] = _mm256_castpd_ps(_mm256_unpackhi_pd(high01, high23));
}
OPENSUBDIVHEX_INLINE void transposeFour(__m256d const (&rows)[4], __m256d (&columns)[4]) {
    __m256d const even01 = _mm256_unpacklo_pd(rows[0], rows[1]);
    __m256d const even23 = _mm256_unpacklo_pd(rows[2], rows[3]);
    __m256d const odd01 = _mm256_unpackhi_pd(rows[0], rows[1]);
    __m256d const odd23 = _mm256_unpackhi_pd(rows[2], rows[3]);
    columns[0] = _mm256_permute2f128_pd(even01, even23, 0x20);
    columns[1] = _mm256_permute2f128_pd(odd01, odd23, 0x20);
    columns[2] = _mm256_permute2f128_pd(even01, even23, 0x31);
    columns[3] = _mm256_permute2f128_pd(odd01, odd23, 0x31);
}

template <>
OPENSUBDIVHEX_INLINE void PointColumns<float>::Load(float const *points, std::ptrdiff_t stride,
                                                    int size, int const *indices,
                                                    Numbers &numbers) {
    __m128i const wanted = _mm_cmpgt_epi32(_mm_set1_epi32(size), _mm_setr_epi32(0, 1, 2, 3));
    auto const load = [&](int i) { return _mm_maskload_ps(points + indices[i] * stride, wanted); };
    __m256 const rows[4] = {_mm256_set_m128(load(4), load(0)), _mm256_set_m128(load(5), load(1)),
                            _mm256_set_m128(load(6), load(2)), _mm256_set_m128(load(7), load(3))};
    transposeFour(rows, numbers);
}
template <>
OPENSUBDIVHEX_INLINE auto PointColumns<float>::SumUp(Numbers const &numbers) -> Point::Lanes {
    __m256 rows[4];
    transposeFour(numbers, rows);
    __m256 const sum = (rows[0] + rows[1]) + (rows[2] + rows[3]);
    return _mm256_castps256_ps128(sum) + _mm256_extractf128_ps(sum, 1);
}

template <>
OPENSUBDIVHEX_INLINE void PointColumns<double>::Load(double const *points, std::ptrdiff_t stride,
                                                     int size, int const *indices,
                                                     Numbers &numbers) {
    __m256i const wanted =
        _mm256_cmpgt_epi64(_mm256_set1_epi64x(size), _mm256_setr_epi64x(0, 1, 2, 3));
    auto const load = [&](int i) {
        return _mm256_maskload_pd(points + indices[i] * stride, wanted);
    };
    __m256d const rows[4] = {load(0), load(1), load(2), load(3)};
    transposeFour(rows, numbers);
}
template <>
OPENSUBDIVHEX_INLINE auto PointColumns<double>::SumUp(Numbers const &numbers) -> Point::Lanes {
    __m256d rows[4];
    transposeFour(numbers, rows);
    return (rows[0] + rows[1]) + (rows[2] + rows[3]);
}
#else
template <typename REAL>
OPENSUBDIVHEX_INLINE void PointColumns<REAL>::Load(REAL const *points, std::ptrdiff_t stride,
                                                   int size, int const *indices, Numbers &numbers) {
    for (int k = 0; k < kNumPointLanes; ++k) {
        numbers[k] = {};
        for (std::size_t i = 0; k < size && i < Columns::kSize; ++i) {
            numbers[k][i] = points[indices[i] * stride + k];
        }
    }
}
template <typename REAL>
OPENSUBDIVHEX_INLINE auto PointColumns<REAL>::SumUp(Numbers const &numbers) ->
    typename Point::Lanes {
    typename Point::Lanes sum{};
    for (std::size_t i = 0; i < Columns::kSize; ++i) {
        for (std::size_t k = 0; k < kNumPointLanes; ++k) {
            sum[k] += numbers[k][i];
        }
    }
    return sum;
}
#endif

/// \brief The cubic Bernstein polynomials at a place of a patch, and their derivatives.
///
/// Those along s and along t are made at once, and so are the two halves of each, which are mirror images.
template <typename REAL>
class PatchCubics {
public:
    OPENSUBDIVHEX_INLINE PatchCubics(REAL s, REAL t) {
        Four const x{s, t, 1 - t, 1 - s};
        Four const y{x[3], x[2], x[1], x[0]};
        constexpr Four kThree{3, 3, -3, -3};
        _ends[0] = x * x * x;
        _middles[0] = x * x * y * REAL(3);
        _ends[1] = x * x * kThree;
        _middles[1] = x * (y + y - x) * kThree;
        _ends[2] = x * REAL(6);
        _middles[2] = (y - x - x) * REAL(6);
        // The share of the first of two points inside of a corner; where both distances are 0, half.
        constexpr REAL kLeast = std::numeric_limits<REAL>::min();
        Four const ofFirst = x + Four{kLeast, kLeast, kLeast, kLeast};
        Four const ofBoth = ofFirst + Four{ofFirst[1], ofFirst[3], ofFirst[0], ofFirst[2]};
        for (std::size_t i = 0; i < 4; ++i) {
            _shares[i] = ofFirst[i] / ofBoth[i];
        }
    }

    /// Of the first point inside of each corner.
    OPENSUBDIVHEX_INLINE REAL GetShare(int corner) const { return _shares[corner]; }
    OPENSUBDIVHEX_INLINE REAL GetAlongS(int order, int i) const { return get(order, i, 0); }
    OPENSUBDIVHEX_INLINE REAL GetAlongT(int order, int i) const { return get(order, i, 1); }

private:
    using Four = typename Registers<REAL, 4 * sizeof(REAL)>::Lanes;

    OPENSUBDIVHEX_INLINE REAL get(int order, int i, int coordinate) const {
        auto const &polynomials = i == 0 || i == 3 ? _ends : _middles;
        return polynomials[order][std::size_t(i < 2 ? 3 - coordinate : coordinate)];
    }

    // By order of the derivative; lanes are for the end and the start of s and t: s, t, 1 - t, 1 - s.
    Four _ends[3];    // by x three times
    Four _middles[3]; // by x twice
    REAL _shares[4];
};

/// \brief The point of a patch and its derivatives, as far as NUM_DERIVATIVES asks.
///
/// The rows of a block are weighed along s, then along t, and the columns by the result.
template <int NUM_DERIVATIVES, typename REAL>
class PatchKernel {
public:
    OPENSUBDIVHEX_INLINE explicit PatchKernel(PatchSums<REAL> const &all)
        : _all(all), _cubics(REAL(all.place.s), REAL(all.place.t)) {}

    /// Writes \p size numbers of the results, no more than four, from the first one on.
    ///
    /// \param size, stride  integral constants where they are known
    template <typename SIZE, typename STRIDE>
    OPENSUBDIVHEX_INLINE void Write(int first, SIZE size, STRIDE stride) const {
        constexpr std::make_index_sequence<kNumSums> kAllSums{};
        ColumnSums sums[kNumSums] = {};
        REAL const *rows = _all.block.weights;
        for (int column = 0; column < _all.block.numColumns; column += kGroup) {
            // Points are read while their weights are made.
            ColumnSums points;
            PointColumns<REAL>::Load(_all.points + first, stride, size, _all.block.columns + column,
                                     points);
            ColumnLanes weights[kNumSums] = {};
            weighColumns(rows, weights);
            addProducts(weights, points, size, sums, kAllSums);
            rows += kNumPatchPoints * kGroup;
        }
        typename Point::Lanes bySt[kNumSums];
        sumUp(sums, bySt, kAllSums);
        // Adds some of these by factors.
        auto const write = [&](int result, auto const &...factors) {
            typename Point::Lanes sum{};
            int next = 1;
            (Point::AddProducts(sum, bySt[next++], REAL(factors)), ...);
            sum = sizeof...(factors) == 0 ? bySt[0] : sum;
            REAL *const numbers = _all.results[result] + first;
            for (int k = 0; k < size; ++k) {
                numbers[k] = sum[std::size_t(k)];
            }
        };
        write(0);
        if constexpr (NUM_DERIVATIVES > 0) {
            auto const &[s, t] = _all.place.first;
            write(1, s[0], t[0]);
            write(2, s[1], t[1]);
            if constexpr (NUM_DERIVATIVES > 1) {
                for (std::size_t i = 0; i < 3; ++i) {
                    std::size_t const a = i / 2;
                    std::size_t const b = (i + 1) / 2;
                    auto const &[byS, byT] = _all.place.second[i];
                    write(3 + int(i), byS, byT, s[a] * s[b], s[a] * t[b] + s[b] * t[a],
                          t[a] * t[b]);
                }
            }
        }
    }

private:
    using Columns = typename PointColumns<REAL>::Columns;
    using ColumnLanes = typename Columns::Lanes;
    using ColumnSums = typename PointColumns<REAL>::Numbers;
    using Point = typename PointColumns<REAL>::Point;
    static constexpr int kGroup = PatchBlock<REAL>::kGroup;

    /// The point; its derivatives by s, t; by s twice, both, and t twice.
    static constexpr int kNumSums = NUM_DERIVATIVES == 0 ? 1 : NUM_DERIVATIVES == 1 ? 3 : 6;
    static constexpr int kOrders[6][2] = {{0, 0}, {1, 0}, {0, 1}, {2, 0}, {1, 1}, {0, 2}};

    // Indices of sums are constants, without which GCC would keep sums in memory.
    template <typename SIZE, std::size_t... SUM>
    OPENSUBDIVHEX_INLINE static void addProducts(ColumnLanes const (&weights)[kNumSums],
                                                 ColumnLanes const (&numbers)[kNumPointLanes],
                                                 SIZE size, ColumnSums (&sums)[kNumSums],
                                                 std::index_sequence<SUM...> /*all*/) {
        (Columns::AddProducts(sums[SUM][0], weights[SUM], numbers[0]), ...);
        (Columns::AddProducts(sums[SUM][1], weights[SUM], numbers[1]), ...);
        (Columns::AddProducts(sums[SUM][2], weights[SUM], numbers[2]), ...);
        if (size > 3) {
            (Columns::AddProducts(sums[SUM][3], weights[SUM], numbers[3]), ...);
        }
    }
    template <std::size_t... SUM>
    OPENSUBDIVHEX_INLINE static void sumUp(ColumnSums const (&sums)[kNumSums],
                                           typename Point::Lanes (&bySt)[kNumSums],
                                           std::index_sequence<SUM...> /*all*/) {
        ((bySt[SUM] = PointColumns<REAL>::SumUp(sums[SUM])), ...);
    }

    OPENSUBDIVHEX_INLINE void weighColumns(REAL const *rows,
                                           ColumnLanes (&weights)[kNumSums]) const {
        for (int k = 0; k < 4; ++k) {
            ColumnLanes alongS[NUM_DERIVATIVES + 1] = {};
            for (int i = 0; i < 4; ++i) {
                ColumnLanes row = Columns::Load(rows + (4 * k + i) * kGroup);
                if ((k == 1 || k == 2) && (i == 1 || i == 2)) {
                    int const corner = 2 * (k - 1) + i - 1;
                    Columns::AddProducts(
                        row, Columns::Load(rows + (PatchRow::kNumBicubic + corner) * kGroup),
                        _cubics.GetShare(corner));
                }
                for (int order = 0; order <= NUM_DERIVATIVES; ++order) {
                    add(i, row, _cubics.GetAlongS(order, i), alongS[order]);
                }
            }
            for (int sum = 0; sum < kNumSums; ++sum) {
                auto const [ofS, ofT] = kOrders[sum];
                add(k, alongS[ofS], _cubics.GetAlongT(ofT, k), weights[sum]);
            }
        }
    }
    // Adds the products of a row, or sets the sum to those of the first one.
    OPENSUBDIVHEX_INLINE static void add(int row, ColumnLanes const &factors, REAL factor,
                                         ColumnLanes &sum) {
        if (row == 0) {
            sum = factors * Columns::Spread(factor);
        } else {
            Columns::AddProducts(sum, factors, factor);
        }
    }

    PatchSums<REAL> const &_all;
    PatchCubics<REAL> const _cubics;
};

template <int NUM_DERIVATIVES, typename REAL>
void sumUpPatch(PatchSums<REAL> const &sums) {
    PatchKernel<NUM_DERIVATIVES, REAL> const kernel(sums);
    if (sums.size == 3 && sums.stride == 3) { // by far the most
        constexpr std::integral_constant<int, 3> kThree{};
        kernel.Write(0, kThree, kThree);
        return;
    }
    for (int first = 0; first < sums.size; first += kNumPointLanes) {
        kernel.Write(first, std::min(kNumPointLanes, sums.size - first), sums.stride);
    }
}

template <typename REAL>
void sumUpPatch(PatchSums<REAL> const &sums) {
    return sums.numDerivatives == 0   ? sumUpPatch<0>(sums)
           : sums.numDerivatives == 1 ? sumUpPatch<1>(sums)
                                      : sumUpPatch<2>(sums);
}

} // namespace
} // namespace OpenSubdivHex::BfrExt::internal

#endif
