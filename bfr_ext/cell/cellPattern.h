// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_BFR_EXT_CELL_CELL_PATTERN_H
#define OPENSUBDIVHEX_BFR_EXT_CELL_CELL_PATTERN_H

#include "cellStencil.h"

namespace OpenSubdivHex::BfrExt::internal {

/// \brief A pattern of places of a base face, as the dense matrices of their stencils.
///
/// Rows stand in blocks of kBlock, column by column, so that a block is summed up at once.  Points on
/// the border have rows of their own, those of their edges and vertices, and are summed up in an order
/// that all faces share.
template <typename REAL>
class CellPattern {
public:
    static constexpr std::size_t kBlock = 8;

    /// \param border  the items of \p root's border; it is referred to
    CellPattern(CellType const &root, CellType::Border const &border,
                std::vector<BasePoint> const &places, bool hasDerivatives);

    /// A sum of \p size numbers for each place, the points being \p stride apart.
    struct Points {
        REAL const *points;
        int size;
        std::ptrdiff_t stride;
    };
    /// \param kind  0: the points of all places; 1, 2: their derivatives
    void Evaluate(int kind, Points const &points, REAL *results, std::ptrdiff_t resultStride) const;

private:
    struct BorderRow {
        std::size_t place;
        std::vector<int> const *points;
        std::vector<double> weights;
    };

    void addBorderRow(CellType::Border const &border, BasePoint const &point, std::size_t place,
                      BorderStencil &stencil);

    std::size_t _numPlaces;
    std::size_t _numPoints;
    std::vector<REAL> _rows[3];
    std::vector<BorderRow> _borderRows;
};

/// \brief What a place on the border is summed up with: an item of the border, by edge and then by
/// vertex, and where on an edge it is.
struct BorderPlace {
    std::size_t item;
    double point;
};
BorderPlace FindBorderPlace(BasePoint const &point, CellType::Border const &border);

/// The sum of some of the points, as all faces that share a place on the border form it.
template <typename REAL>
REAL SumBorderPoints(std::vector<double> const &weights, std::vector<int> const &points,
                     REAL const *values, std::ptrdiff_t stride) {
    double sum = 0;
    for (std::size_t i = 0; i < weights.size(); ++i) {
        sum += weights[i] * double(values[points[i] * stride]);
    }
    return REAL(sum);
}

} // namespace OpenSubdivHex::BfrExt::internal

#endif
