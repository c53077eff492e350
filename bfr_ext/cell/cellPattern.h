// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_BFR_EXT_CELL_CELL_PATTERN_H
#define OPENSUBDIVHEX_BFR_EXT_CELL_CELL_PATTERN_H

#include "cellStencil.h"
#include "laneKernel.h"

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
    static constexpr std::size_t kBlock = 192 / sizeof(REAL);

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

/// \brief The stencils of some places on what an edge of a base face becomes in a step (EdgeValues), in
/// the direction of the edge; or that of a vertex.
struct BorderPattern {
    BorderPattern(CellType const &type, std::vector<double> const &points);

    std::size_t numPlaces;
    std::vector<double> weights; ///< by point of the type, and then by place
};

/// \brief What a place on the border is summed up with: an item of the border, by edge and then by
/// vertex, and where on an edge it is.
struct BorderPlace {
    std::size_t item;
    double point;
};
BorderPlace FindBorderPlace(BasePoint const &point, CellType::Border const &border);

/// \brief The points of what lies on the border, of which all faces that share it form the same sums.
///
/// Those of a vertex are its own.  Those of an edge are the points of the long edge that it becomes in
/// the first step: long edges have far fewer types than edges.
class BorderValues {
public:
    /// Of an edge, or of a vertex.
    template <typename REAL>
    BorderValues(CellType::BorderItem const &item, REAL const *points, std::ptrdiff_t stride,
                 int size);

    /// That of the long edge or of the vertex, which patterns are made for.
    CellType const &GetType() const { return *_type; }
    /// \brief Writes the points of a pattern.
    ///
    /// \param getResult  gives, of a place, where its first number goes
    template <typename GET_RESULT>
    void Sum(BorderPattern const &pattern, GET_RESULT getResult) const {
        std::vector<double> sums(_size * pattern.numPlaces);
        Multiply({_values.data(), _size, _values.size() / _size, pattern.weights.data(),
                  pattern.numPlaces, pattern.numPlaces, sums.data(), pattern.numPlaces});
        for (std::size_t place = 0; place < pattern.numPlaces; ++place) {
            auto *const result = getResult(place);
            for (std::size_t k = 0; k < _size; ++k) {
                result[k] =
                    std::remove_reference_t<decltype(*result)>(sums[k * pattern.numPlaces + place]);
            }
        }
    }

private:
    CellType const *_type;
    std::size_t _size;           // of a point
    std::vector<double> _values; // by number of a point, and then by point
};

} // namespace OpenSubdivHex::BfrExt::internal

#endif
