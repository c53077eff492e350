// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_BFR_EXT_CELL_PATCH_SUMS_TEMPLATE_H
#define OPENSUBDIVHEX_BFR_EXT_CELL_PATCH_SUMS_TEMPLATE_H

#include "lanes.h"
#include "patchSums.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <iterator>
#include <type_traits>

#ifdef __FMA__
#include <immintrin.h>
#endif

namespace OpenSubdivHex::BfrExt::internal {

namespace {

// Some numbers of a point, which are computed with at once.  Products are fused with sums where the machine can, and
// where this is said.
#ifdef __FMA__
template <typename REAL>
struct RegisterOf;
template <>
struct RegisterOf<float> {
    using Type = __m128;
};
template <>
struct RegisterOf<double> {
    using Type = __m256d;
};

template <typename REAL>
struct LanesOf {
    static constexpr std::size_t kCount = Lanes<REAL>::kCount;
    using Values = typename RegisterOf<REAL>::Type;
    static_assert(sizeof(Values) == kCount * sizeof(REAL));

    OPENSUBDIVHEX_INLINE static LanesOf Load(REAL const *from) {
        LanesOf result;
        std::memcpy(&result.values, from, sizeof(Values));
        return result;
    }
    OPENSUBDIVHEX_INLINE LanesOf operator+(LanesOf const &other) const {
        return {values + other.values};
    }
    OPENSUBDIVHEX_INLINE LanesOf operator-(LanesOf const &other) const {
        return {values - other.values};
    }
    OPENSUBDIVHEX_INLINE LanesOf operator*(REAL factor) const {
        return {values * Spread(factor).values};
    }
    OPENSUBDIVHEX_INLINE static LanesOf Spread(REAL number) {
        return {Values{number, number, number, number}};
    }

    Values values;
};

template <typename REAL>
OPENSUBDIVHEX_INLINE LanesOf<REAL> addProduct(LanesOf<REAL> const &sum,
                                              LanesOf<REAL> const &factors, REAL factor) {
    auto const spread = LanesOf<REAL>::Spread(factor);
    if constexpr (std::is_same_v<REAL, float>) {
        return {_mm_fmadd_ps(factors.values, spread.values, sum.values)};
    } else {
        return {_mm256_fmadd_pd(factors.values, spread.values, sum.values)};
    }
}
#else
template <typename REAL>
using LanesOf = Lanes<REAL>;

template <typename REAL>
OPENSUBDIVHEX_INLINE Lanes<REAL> addProduct(Lanes<REAL> const &sum, Lanes<REAL> const &factors,
                                            REAL factor) {
    return sum + factors * factor;
}
#endif

// Columns of a block, which are computed with at once.
#ifdef __FMA__
template <typename REAL>
struct ColumnsOf;
template <>
struct ColumnsOf<float> {
    using Type = __m256;
    OPENSUBDIVHEX_INLINE static Type Load(float const *from) { return _mm256_load_ps(from); }
    OPENSUBDIVHEX_INLINE static void Store(Type values, float *to) { _mm256_store_ps(to, values); }
    OPENSUBDIVHEX_INLINE static Type AddProduct(Type sum, Type values, float factor) {
        return _mm256_fmadd_ps(values, _mm256_set1_ps(factor), sum);
    }
};
template <>
struct ColumnsOf<double> {
    using Type = __m256d;
    OPENSUBDIVHEX_INLINE static Type Load(double const *from) { return _mm256_load_pd(from); }
    OPENSUBDIVHEX_INLINE static void Store(Type values, double *to) { _mm256_store_pd(to, values); }
    OPENSUBDIVHEX_INLINE static Type AddProduct(Type sum, Type values, double factor) {
        return _mm256_fmadd_pd(values, _mm256_set1_pd(factor), sum);
    }
};
#else
template <typename REAL>
struct ColumnsOf {
    struct Type {
        REAL values[PatchBlock<REAL>::kPadding];
    };
    OPENSUBDIVHEX_INLINE static Type Load(REAL const *from) {
        Type result;
        std::copy_n(from, PatchBlock<REAL>::kPadding, result.values);
        return result;
    }
    OPENSUBDIVHEX_INLINE static void Store(Type const &values, REAL *to) {
        std::copy_n(values.values, PatchBlock<REAL>::kPadding, to);
    }
    OPENSUBDIVHEX_INLINE static Type AddProduct(Type const &sum, Type const &values, REAL factor) {
        Type result;
        for (int i = 0; i < PatchBlock<REAL>::kPadding; ++i) {
            result.values[i] = sum.values[i] + values.values[i] * factor;
        }
        return result;
    }
};
#endif

// What the rows of a block weigh in each result.
template <int NUM_DERIVATIVES, typename REAL>
class RowWeights {
public:
    static constexpr int kNumResults = NUM_DERIVATIVES == 0 ? 1 : NUM_DERIVATIVES == 1 ? 3 : 6;

    OPENSUBDIVHEX_INLINE explicit RowWeights(PatchWeights<NUM_DERIVATIVES, REAL> const &weights) {
        Cubic const s(weights.s);
        Cubic const t(weights.t);
        setProducts(0, 0, s.values, t.values);
        if constexpr (NUM_DERIVATIVES > 0) {
            for (int i = 0; i < 2; ++i) {
                auto const &by = weights.byUv[i];
                setProducts(1 + i, 0, scale(s.first, by[0]), t.values);
                setProducts(1 + i, 1, s.values, scale(t.first, by[1]));
            }
        }
        if constexpr (NUM_DERIVATIVES > 1) {
            for (int k = 0; k < 3; ++k) {
                auto const &by = weights.byUvTwice[k];
                Four ofS;
                Four ofT;
                for (std::size_t i = 0; i < 4; ++i) {
                    ofS[i] = s.second[i] * by[2] + s.first[i] * by[0];
                    ofT[i] = t.second[i] * by[4] + t.first[i] * by[1];
                }
                setProducts(3 + k, 0, ofS, t.values);
                setProducts(3 + k, 1, s.values, ofT);
                setProducts(3 + k, 1, scale(s.first, by[3]), t.first);
            }
        }
        for (int i = 0; i < kNumResults; ++i) {
            REAL const *const shares = weights.shares;
            auto const &[low, high] = _inner[i];
            REAL const products[4] = {low.values[1] * shares[0], low.values[2] * shares[1],
                                      high.values[2] * shares[2], high.values[1] * shares[3]};
            std::copy_n(products, 4, values[i] + PatchRow::kNumBicubic);
        }
    }

    alignas(16) REAL values[kNumResults][kNumPatchPoints];

private:
    using Four = std::array<REAL, 4>;

    // The cubic Bernstein polynomials, and their derivatives without factors of the degree.
    struct Cubic {
        OPENSUBDIVHEX_INLINE explicit Cubic(PatchCoordinate<REAL> const &at)
            : values{at.quadratic[0] * at.toStart,
                     at.quadratic[0] * at.toEnd + at.quadratic[1] * at.toStart,
                     at.quadratic[1] * at.toEnd + at.quadratic[2] * at.toStart,
                     at.quadratic[2] * at.toEnd},
              first{-at.quadratic[0], at.quadratic[0] - at.quadratic[1],
                    at.quadratic[1] - at.quadratic[2], at.quadratic[2]},
              second{at.toStart, at.toEnd - 2 * at.toStart, at.toStart - 2 * at.toEnd, at.toEnd} {}

        Four values;
        Four first;
        Four second;
    };

    OPENSUBDIVHEX_INLINE static Four scale(Four const &values, REAL factor) {
        return {values[0] * factor, values[1] * factor, values[2] * factor, values[3] * factor};
    }

    // Sets the products to numbers, or adds them to what there is.
    OPENSUBDIVHEX_INLINE void setProducts(int result, int isSum, Four const &byS, Four const &byT) {
        auto const ofS = LanesOf<REAL>::Load(byS.data());
        for (std::size_t row = 0; row < 4; ++row) {
            REAL *const to = values[result] + 4 * row;
            LanesOf<REAL> const products =
                isSum != 0 ? addProduct(LanesOf<REAL>::Load(to), ofS, byT[row]) : ofS * byT[row];
            std::memcpy(to, &products.values, sizeof(products.values));
            if (row == 1 || row == 2) {
                _inner[result][row - 1] = products;
            }
        }
    }

    // The two rows with points inside of corners, in registers: reading what was just written takes long.
    LanesOf<REAL> _inner[kNumResults][2];
};

// Some numbers of sums of points: the rows of a block are weighed, and so the points of its columns.
//
// IS_PACKED: points are three numbers each, without gaps; else numLanes of them are lanes.
template <int NUM_DERIVATIVES, bool IS_PACKED, typename REAL>
class BlockSums {
public:
    using Rows = RowWeights<NUM_DERIVATIVES, REAL>;
    static constexpr int kNumResults = Rows::kNumResults;

    OPENSUBDIVHEX_INLINE BlockSums(Rows const &rows, PatchBlock<REAL> const &block,
                                   REAL const *points, std::ptrdiff_t stride, int numLanes)
        : _rows(rows), _block(block), _points(points), _stride(IS_PACKED ? 3 : stride),
          _numLanes(IS_PACKED ? 3 : numLanes), _paddedSize(_block.GetPaddedSize(block.numColumns)) {
        setZero(_sums);
        addTiles<kMaxTile>(0);
    }

    OPENSUBDIVHEX_INLINE void Write(REAL *const *results, int firstResult) const {
        for (int i = 0; i < kNumResults; ++i) {
            LanesOf<REAL> const sum = _sums[i][0] + _sums[i][1];
            REAL numbers[LanesOf<REAL>::kCount];
            std::memcpy(numbers, &sum.values, sizeof(numbers));
            std::copy_n(numbers, IS_PACKED ? 3 : _numLanes, results[i] + firstResult);
        }
    }

private:
    using Columns = ColumnsOf<REAL>;
    static constexpr int kWidth = PatchBlock<REAL>::kPadding;
    // Registers of columns, so that the sums of all results are in registers.
    static constexpr int kMaxTile = NUM_DERIVATIVES > 1 ? 2 : 4;

    template <int TILE>
    OPENSUBDIVHEX_INLINE void addTiles(int first) {
        if constexpr (TILE > 0) {
            for (; first + TILE * kWidth <= _paddedSize; first += TILE * kWidth) {
                addTile<TILE>(first);
            }
            addTiles<TILE - 1>(first);
        }
    }

    // Weighs some columns, and adds their points.
    template <int TILE>
    OPENSUBDIVHEX_INLINE void addTile(int first) {
        typename Columns::Type weights[kNumResults][TILE];
        setZero(weights);
        REAL const *from = _block.weights + first;
        for (int row = 0; row < kNumPatchPoints; ++row, from += _paddedSize) {
            for (int i = 0; i < TILE; ++i) {
                auto const columns = Columns::Load(from + i * kWidth);
                for (int k = 0; k < kNumResults; ++k) {
                    weights[k][i] =
                        Columns::AddProduct(weights[k][i], columns, _rows.values[k][row]);
                }
            }
        }
        alignas(32) REAL numbers[kNumResults][TILE * kWidth];
        for (int k = 0; k < kNumResults; ++k) {
            for (int i = 0; i < TILE; ++i) {
                Columns::Store(weights[k][i], numbers[k] + i * kWidth);
            }
        }
        addPoints(numbers, std::min(TILE * kWidth, _block.numColumns - first), first);
    }

    // Adds the points of some columns, whose weights are given by result.
    template <int SIZE>
    OPENSUBDIVHEX_INLINE void addPoints(REAL const (&weights)[kNumResults][SIZE], int count,
                                        int first) {
        // In registers.
        LanesOf<REAL> sums[kNumResults][2];
        copySums(_sums, sums);
        auto const add = [&](int i, int sum) {
            int const column = first + i;
            LanesOf<REAL> const point = load(_block.columns[column]);
            for (int k = 0; k < kNumResults; ++k) {
                sums[k][sum] = addProduct(sums[k][sum], point, weights[k][i]);
            }
        };
        // Two sums do not wait for each other.
        int i = 0;
        for (; i + 1 < count; i += 2) {
            add(i, 0);
            add(i + 1, 1);
        }
        if (i < count) {
            add(i, 0);
        }
        copySums(sums, _sums);
    }

    using Sums = LanesOf<REAL>[kNumResults][2];
    OPENSUBDIVHEX_INLINE static void copySums(Sums const &from, Sums &to) {
        for (int k = 0; k < kNumResults; ++k) {
            to[k][0] = from[k][0];
            to[k][1] = from[k][1];
        }
    }
    // GCC would keep an array in memory that is set to 0 as a whole.
    template <typename T, std::size_t SIZE>
    OPENSUBDIVHEX_INLINE static void setZero(T (&arrays)[kNumResults][SIZE]) {
        for (auto &array : arrays) {
            std::fill(std::begin(array), std::end(array), T{});
        }
    }

    OPENSUBDIVHEX_INLINE LanesOf<REAL> load(int point) const {
        REAL const *const from = _points + point * _stride;
        if (IS_PACKED && point < _block.lastColumn) {
            return LanesOf<REAL>::Load(from); // with a number of the next
        }
        REAL numbers[LanesOf<REAL>::kCount] = {};
        std::copy_n(from, _numLanes, numbers);
        return LanesOf<REAL>::Load(numbers);
    }

    Rows const &_rows;
    PatchBlock<REAL> const &_block;
    REAL const *const _points;
    std::ptrdiff_t const _stride;
    int const _numLanes;
    int const _paddedSize;
    LanesOf<REAL> _sums[kNumResults][2]; // of even columns, and of odd ones
};

// Calls function(is packed, first, number) for lanes of points.
template <typename REAL, typename FUNCTION>
OPENSUBDIVHEX_INLINE void forLanes(int size, std::ptrdiff_t stride, FUNCTION const &function) {
    if (size == 3 && stride == 3) { // by far the most
        function(std::true_type(), 0, 3);
        return;
    }
    constexpr int kLanes = int(LanesOf<REAL>::kCount);
    for (int lane = 0; lane < size; lane += kLanes) {
        function(std::false_type(), lane, std::min(kLanes, size - lane));
    }
}

template <int NUM_DERIVATIVES, typename REAL>
void sumUpBlock(PatchWeights<NUM_DERIVATIVES, REAL> const &weights, PatchBlock<REAL> const &block,
                REAL const *points, int size, std::ptrdiff_t stride, REAL *const *results) {
    RowWeights<NUM_DERIVATIVES, REAL> const rows(weights);
    forLanes<REAL>(size, stride, [&](auto isPacked, int lane, int numLanes) {
        BlockSums<NUM_DERIVATIVES, isPacked(), REAL>(rows, block, points + lane, stride, numLanes)
            .Write(results, lane);
    });
}

} // namespace

} // namespace OpenSubdivHex::BfrExt::internal

#endif
