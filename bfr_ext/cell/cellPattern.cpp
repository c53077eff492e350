// SPDX-License-Identifier: Apache-2.0
#include "cellPattern.h"

#include <cstring>

namespace OpenSubdivHex::BfrExt::internal {

namespace {

constexpr std::size_t kLaneBytes = 16;

// Numbers that are computed with at once, in a register where the machine has such.
template <typename REAL>
struct PlainLanes {
    static constexpr std::size_t kSize = kLaneBytes / sizeof(REAL);

    PlainLanes operator*(REAL factor) const {
        PlainLanes result;
        for (std::size_t i = 0; i < kSize; ++i) {
            result.values[i] = values[i] * factor;
        }
        return result;
    }
    PlainLanes &operator+=(PlainLanes const &other) {
        for (std::size_t i = 0; i < kSize; ++i) {
            values[i] += other.values[i];
        }
        return *this;
    }

    REAL values[kSize];
};

template <typename REAL>
struct LanesOf {
    using Type = PlainLanes<REAL>;
};
#if defined(__GNUC__)
template <>
struct LanesOf<float> {
    using Type = float __attribute__((vector_size(kLaneBytes)));
};
template <>
struct LanesOf<double> {
    using Type = double __attribute__((vector_size(kLaneBytes)));
};
#endif

// Sums up a block of rows for LENGTH numbers of the points, which stand side by side.
template <int LENGTH, std::size_t BLOCK, typename REAL>
void sumBlock(REAL const *block, std::size_t numPoints, REAL const *points, std::ptrdiff_t stride,
              REAL (&results)[LENGTH][BLOCK]) {
    using Lanes = typename LanesOf<REAL>::Type;
    constexpr std::size_t kNumLanes = BLOCK * sizeof(REAL) / kLaneBytes;
    Lanes sums[LENGTH][kNumLanes] = {};
    for (std::size_t i = 0; i < numPoints; ++i, block += BLOCK, points += stride) {
        Lanes weights[kNumLanes];
        std::memcpy(weights, block, sizeof(weights));
        for (int k = 0; k < LENGTH; ++k) {
            for (std::size_t lane = 0; lane < kNumLanes; ++lane) {
                sums[k][lane] += weights[lane] * points[k];
            }
        }
    }
    std::memcpy(results, sums, sizeof(results));
}

} // namespace

BorderPlace FindBorderPlace(BasePoint const &point, CellType::Border const &border) {
    std::size_t const numEdges = border.size() / 2;
    auto const sector = std::size_t(point.sector);
    if (point.coords[1] == 0) {
        return {numEdges + sector, 0};
    }
    if (point.coords[0] == 0) {
        return {numEdges + (sector + 1) % numEdges, 0};
    }
    return {sector, point.coords[border[sector].isReversed ? 0 : 1]};
}

BorderPattern::BorderPattern(CellType const &type, std::vector<double> const &points) {
    BorderStencil stencil;
    for (double const point : points) {
        stencil.Find(type, point);
        rows.push_back(stencil.GetWeights());
    }
}

template <typename REAL>
CellPattern<REAL>::CellPattern(CellType const &root, std::vector<BasePoint> const &places,
                               bool hasDerivatives)
    : _numPlaces(places.size()), _numPoints(std::size_t(root.GetNumPoints())) {
    std::size_t const numBlocks = (_numPlaces + kBlock - 1) / kBlock;
    std::size_t const numKinds = hasDerivatives ? 3 : 1;
    for (std::size_t kind = 0; kind < numKinds; ++kind) {
        _rows[kind].resize(numBlocks * kBlock * _numPoints);
    }
    CellStencil stencil(root);
    for (std::size_t place = 0; place < _numPlaces; ++place) {
        std::size_t const firstKind = places[place].IsOnBorder() ? 1 : 0;
        if (firstKind == numKinds) {
            continue;
        }
        stencil.Find(places[place], hasDerivatives);
        std::vector<double> const *const weights[3] = {
            &stencil.GetWeights(), &stencil.GetDuWeights(), &stencil.GetDvWeights()};
        for (std::size_t kind = firstKind; kind < numKinds; ++kind) {
            REAL *const block = _rows[kind].data() + place / kBlock * kBlock * _numPoints;
            for (std::size_t i = 0; i < _numPoints; ++i) {
                block[i * kBlock + place % kBlock] = REAL((*weights[kind])[i]);
            }
        }
    }
}

template <typename REAL>
void CellPattern<REAL>::Evaluate(int kind, Points const &points, REAL *results,
                                 std::ptrdiff_t resultStride) const {
    std::vector<REAL> const &rows = _rows[kind];
    for (std::size_t begin = 0; begin < _numPlaces; begin += kBlock) {
        REAL const *const block = rows.data() + begin * _numPoints;
        std::size_t const numRows = std::min(kBlock, _numPlaces - begin);
        REAL *const blockResults = results + std::ptrdiff_t(begin) * resultStride;
        int k = 0;
        auto const sumNext = [&](auto length) {
            constexpr int kLength = decltype(length)::value;
            REAL sums[kLength][kBlock];
            sumBlock(block, _numPoints, points.points + k, points.stride, sums);
            for (std::size_t row = 0; row < numRows; ++row) {
                for (int i = 0; i < kLength; ++i) {
                    blockResults[std::ptrdiff_t(row) * resultStride + k + i] = sums[i][row];
                }
            }
            k += kLength;
        };
        while (k + 3 <= points.size) {
            sumNext(std::integral_constant<int, 3>());
        }
        while (k < points.size) {
            sumNext(std::integral_constant<int, 1>());
        }
    }
}

template class CellPattern<float>;
template class CellPattern<double>;

} // namespace OpenSubdivHex::BfrExt::internal
