// SPDX-License-Identifier: Apache-2.0
#include "cellPattern.h"

#include <algorithm>

namespace OpenSubdivHex::BfrExt::internal {

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

template <typename REAL>
CellPattern<REAL>::CellPattern(CellType const &root, CellType::Border const &border,
                               std::vector<BasePoint> const &places, bool hasDerivatives)
    : _numPlaces(places.size()), _numPoints(std::size_t(root.GetNumPoints())) {
    std::size_t const numBlocks = (_numPlaces + kBlock - 1) / kBlock;
    std::size_t const numKinds = hasDerivatives ? 3 : 1;
    for (std::size_t kind = 0; kind < numKinds; ++kind) {
        _rows[kind].resize(numBlocks * kBlock * _numPoints);
    }
    CellStencil stencil(root);
    BorderStencil borderStencil;
    for (std::size_t place = 0; place < _numPlaces; ++place) {
        bool const isOnBorder = places[place].IsOnBorder();
        if (isOnBorder) {
            addBorderRow(border, places[place], place, borderStencil);
        }
        if (isOnBorder && !hasDerivatives) {
            continue;
        }
        stencil.Find(places[place], hasDerivatives);
        std::vector<double> const *const weights[3] = {
            &stencil.GetWeights(), &stencil.GetDuWeights(), &stencil.GetDvWeights()};
        for (std::size_t kind = 0; kind < numKinds; ++kind) {
            REAL *const block = _rows[kind].data() + place / kBlock * kBlock * _numPoints;
            for (std::size_t i = 0; i < _numPoints; ++i) {
                block[i * kBlock + place % kBlock] = REAL((*weights[kind])[i]);
            }
        }
    }
}

template <typename REAL>
void CellPattern<REAL>::addBorderRow(CellType::Border const &border, BasePoint const &point,
                                     std::size_t place, BorderStencil &stencil) {
    BorderPlace const borderPlace = FindBorderPlace(point, border);
    CellType::BorderItem const &item = border[borderPlace.item];
    stencil.Find(*item.type, borderPlace.point);
    _borderRows.push_back({place, &item.points, stencil.GetWeights()});
}

template <typename REAL>
void CellPattern<REAL>::Evaluate(int kind, Points const &points, REAL *results,
                                 std::ptrdiff_t resultStride) const {
    std::vector<REAL> const &rows = _rows[kind];
    for (std::size_t begin = 0; begin < _numPlaces; begin += kBlock) {
        REAL const *const block = rows.data() + begin * _numPoints;
        std::size_t const numRows = std::min(kBlock, _numPlaces - begin);
        for (int k = 0; k < points.size; ++k) {
            REAL const *const values = points.points + k;
            REAL sums[kBlock] = {};
            for (std::size_t i = 0; i < _numPoints; ++i) {
                REAL const value = values[std::ptrdiff_t(i) * points.stride];
                for (std::size_t row = 0; row < kBlock; ++row) {
                    sums[row] += block[i * kBlock + row] * value;
                }
            }
            for (std::size_t row = 0; row < numRows; ++row) {
                results[std::ptrdiff_t(begin + row) * resultStride + k] = sums[row];
            }
        }
    }
    if (kind > 0) {
        return;
    }
    for (BorderRow const &row : _borderRows) {
        for (int k = 0; k < points.size; ++k) {
            results[std::ptrdiff_t(row.place) * resultStride + k] =
                SumBorderPoints(row.weights, *row.points, points.points + k, points.stride);
        }
    }
}

template class CellPattern<float>;
template class CellPattern<double>;

} // namespace OpenSubdivHex::BfrExt::internal
