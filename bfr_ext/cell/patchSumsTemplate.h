// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_BFR_EXT_CELL_PATCH_SUMS_TEMPLATE_H
#define OPENSUBDIVHEX_BFR_EXT_CELL_PATCH_SUMS_TEMPLATE_H

#include "lanes.h"
#include "patchSums.h"

#include <algorithm>
#include <cstring>
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

// Some numbers of the points of a patch, summed up row by row, by t, as those of a bicubic patch: by De Casteljau's
// algorithm to the four points whose bilinear interpolation is the point, and whose differences are its derivatives.
//
// IS_PACKED: points are three numbers each, without gaps; else numLanes of them are lanes.
template <int NUM_DERIVATIVES, bool IS_PACKED, typename REAL>
class PatchSums {
public:
    using Weights = PatchWeights<NUM_DERIVATIVES, REAL>;

    OPENSUBDIVHEX_INLINE PatchSums(Weights const &weights, REAL const *points,
                                   std::ptrdiff_t stride, int numLanes)
        : _weights(weights), _points(points), _stride(IS_PACKED ? 3 : stride),
          _numLanes(IS_PACKED ? 3 : numLanes) {
        addRow<0>(load(0), load(1), load(7), load(5));
        addRow<1>(load(2), blend(0), blend(1), load(6));
        addRow<2>(load(16), blend(3), blend(2), load(12));
        addRow<3>(load(15), load(17), load(11), load(10));
    }

    OPENSUBDIVHEX_INLINE void Write(REAL *const *results, int firstResult) const {
        auto const write = [&](int result, LanesOf<REAL> const &values) {
            REAL numbers[LanesOf<REAL>::kCount];
            std::memcpy(numbers, &values.values, sizeof(numbers));
            std::copy_n(numbers, IS_PACKED ? 3 : _numLanes, results[result] + firstResult);
        };
        auto const &s = _weights.s;
        auto const &t = _weights.t;
        write(0, mix(t, mix(s, _low[0], _low[1]), mix(s, _high[0], _high[1])));
        if constexpr (NUM_DERIVATIVES > 0) {
            LanesOf<REAL> const atLow = _low[1] - _low[0];
            LanesOf<REAL> const atHigh = _high[1] - _high[0];
            LanesOf<REAL> const ds = mix(t, atLow, atHigh);
            LanesOf<REAL> const dt = mix(s, _high[0] - _low[0], _high[1] - _low[1]);
            for (int i = 0; i < 2; ++i) {
                write(1 + i, addProduct(ds * _weights.byUv[i][0], dt, _weights.byUv[i][1]));
            }
            if constexpr (NUM_DERIVATIVES > 1) {
                LanesOf<REAL> const dst = atHigh - atLow;
                for (int k = 0; k < 3; ++k) {
                    auto const &by = _weights.byUvTwice[k];
                    write(3 + k,
                          _dss * by[2] + dst * by[3] + _dtt * by[4] + (ds * by[0] + dt * by[1]));
                }
            }
        }
    }

private:
    OPENSUBDIVHEX_INLINE LanesOf<REAL> load(int i) const {
        REAL const *const from = _points + i * _stride;
        if (IS_PACKED && i + 1 < kNumPatchPoints) {
            return LanesOf<REAL>::Load(from); // with a number of the next
        }
        REAL numbers[LanesOf<REAL>::kCount] = {};
        std::copy_n(from, _numLanes, numbers);
        return LanesOf<REAL>::Load(numbers);
    }

    // The two points inside of a corner.
    OPENSUBDIVHEX_INLINE LanesOf<REAL> blend(int corner) const {
        LanesOf<REAL> const second = load(5 * corner + 4);
        return addProduct(second, load(5 * corner + 3) - second, _weights.shares[corner]);
    }

    OPENSUBDIVHEX_INLINE static LanesOf<REAL>
    mix(PatchCoordinate<REAL> const &at, LanesOf<REAL> const &start, LanesOf<REAL> const &end) {
        return addProduct(start * at.toStart, end, at.toEnd);
    }

    OPENSUBDIVHEX_INLINE LanesOf<REAL> sumUp(LanesOf<REAL> const &a, LanesOf<REAL> const &b,
                                             LanesOf<REAL> const &c) const {
        auto const &quadratic = _weights.s.quadratic;
        return addProduct(addProduct(a * quadratic[0], b, quadratic[1]), c, quadratic[2]);
    }

    template <int ROW>
    OPENSUBDIVHEX_INLINE void addRow(LanesOf<REAL> const &a, LanesOf<REAL> const &b,
                                     LanesOf<REAL> const &c, LanesOf<REAL> const &d) {
        auto const &s = _weights.s;
        auto const &t = _weights.t;
        LanesOf<REAL> const ofRow[2] = {sumUp(a, b, c), sumUp(b, c, d)};
        for (std::size_t i = 0; i < 2; ++i) {
            if constexpr (ROW < 3) {
                _low[i] = addProduct(_low[i], ofRow[i], t.quadratic[ROW]);
            }
            if constexpr (ROW > 0) {
                _high[i] = addProduct(_high[i], ofRow[i], t.quadratic[ROW - 1]);
            }
        }
        if constexpr (NUM_DERIVATIVES > 1) {
            auto const getBend = [](auto const &x, auto const &y, auto const &z) {
                return (z - y) - (y - x);
            };
            REAL const cubic = (ROW < 3 ? t.quadratic[ROW] * t.toStart : 0) +
                               (ROW > 0 ? t.quadratic[ROW - 1] * t.toEnd : 0);
            _dss = _dss + mix(s, getBend(a, b, c), getBend(b, c, d)) * cubic;
            // The weights of the row in the second differences between rows.
            constexpr REAL kBends[2][4] = {{1, -2, 1, 0}, {0, 1, -2, 1}};
            _dtt = _dtt + mix(s, ofRow[0], ofRow[1]) *
                              (kBends[0][ROW] * t.toStart + kBends[1][ROW] * t.toEnd);
        }
    }

    Weights const &_weights;
    REAL const *const _points;
    std::ptrdiff_t const _stride;
    int const _numLanes;
    LanesOf<REAL> _low[2] = {};  // of the rows but the last: at the start and the end of s
    LanesOf<REAL> _high[2] = {}; // but the first
    LanesOf<REAL> _dss = {};
    LanesOf<REAL> _dtt = {};
};

template <int NUM_DERIVATIVES, typename REAL>
void sumUpPatch(PatchWeights<NUM_DERIVATIVES, REAL> const &weights, REAL const *points, int size,
                std::ptrdiff_t stride, REAL *const *results) {
    if (size == 3 && stride == 3) { // by far the most
        PatchSums<NUM_DERIVATIVES, true, REAL>(weights, points, 3, 3).Write(results, 0);
        return;
    }
    constexpr int kLanes = int(LanesOf<REAL>::kCount);
    for (int lane = 0; lane < size; lane += kLanes) {
        PatchSums<NUM_DERIVATIVES, false, REAL>(weights, points + lane, stride,
                                                std::min(kLanes, size - lane))
            .Write(results, lane);
    }
}

} // namespace

} // namespace OpenSubdivHex::BfrExt::internal

#endif
