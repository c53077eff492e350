// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_BFR_EXT_CELL_CELL_PATTERN_H
#define OPENSUBDIVHEX_BFR_EXT_CELL_CELL_PATTERN_H

#include "cellStencil.h"

#include <algorithm>
#include <type_traits>

namespace OpenSubdivHex::BfrExt::internal {

/// \brief A pattern of places of a base face, as the dense matrices of their stencils.
///
/// Rows stand in blocks of kBlock, column by column, so that a block is summed up at once.  Points on
/// the border are made by BorderPattern.
template <typename REAL>
class CellPattern {
public:
    static constexpr std::size_t kBlock = 64 / sizeof(REAL);

    CellPattern(CellType const &root, std::vector<BasePoint> const &places, bool hasDerivatives);

    /// A sum of \p size numbers for each place, the points being \p stride apart.
    struct Points {
        REAL const *points;
        int size;
        std::ptrdiff_t stride;
    };
    /// \param kind  0: the points of all places but for those on the border, which get 0; 1, 2: the
    ///              derivatives of all
    void Evaluate(int kind, Points const &points, REAL *results, std::ptrdiff_t resultStride) const;

private:
    std::size_t _numPlaces;
    std::size_t _numPoints;
    std::vector<REAL> _rows[3];
};

/// The stencils of some points of an edge of a base face, in the direction of the edge, or that of a
/// vertex.
struct BorderPattern {
    BorderPattern(CellType const &type, std::vector<double> const &points);

    std::vector<std::vector<double>> rows;
};

/// \brief What a place on the border is summed up with: an item of the border, by edge and then by
/// vertex, and where on an edge it is.
struct BorderPlace {
    std::size_t item;
    double point;
};
BorderPlace FindBorderPlace(BasePoint const &point, CellType::Border const &border);

/// \brief Writes the sum of some of the points, \p size numbers each, as all faces that share a place
/// on the border form it: every number in the order of \p points.
template <typename REAL>
void SumBorderPoints(std::vector<double> const &weights, std::vector<int> const &points,
                     REAL const *values, std::ptrdiff_t stride, int size, REAL *result) {
    auto const sum = [&](auto length) {
        constexpr int kLength = decltype(length)::value;
        double sums[kLength] = {};
        for (std::size_t i = 0; i < weights.size(); ++i) {
            REAL const *const point = values + points[i] * stride;
            for (int k = 0; k < kLength; ++k) {
                sums[k] += weights[i] * double(point[k]);
            }
        }
        std::copy(sums, sums + kLength, result);
        values += kLength;
        result += kLength;
        size -= kLength;
    };
    while (size >= 3) {
        sum(std::integral_constant<int, 3>());
    }
    while (size > 0) {
        sum(std::integral_constant<int, 1>());
    }
}

} // namespace OpenSubdivHex::BfrExt::internal

#endif
