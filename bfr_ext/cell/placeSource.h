// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_BFR_EXT_CELL_PLACE_SOURCE_H
#define OPENSUBDIVHEX_BFR_EXT_CELL_PLACE_SOURCE_H

#include "bfrPlace.h"
#include "placeKernel.h"
#include "ringCell.h"

#include <array>
#include <vector>

namespace OpenSubdivHex::BfrExt::internal {

/// \brief What places are sums of: the points of a type or, in a product of a plain face, points of rings.
template <typename REAL>
struct PlaceSource {
    /// \brief One matrix for points, or two for derivatives.
    ///
    /// They lie in an array: a look-up reads fewer lines of the cache than with a vector.
    struct Matrices {
        std::size_t GetHeapSize() const { return internal::GetHeapSize(matrices); }

        std::array<PlaceMatrix<REAL>, 2> matrices;
        std::size_t count;
    };

    /// Where matrices of the sources are kept.
    PatternTable &GetPatterns() const {
        return ringCell ? ringCell->GetPatterns() : type->GetPatterns();
    }
    /// What stencils are to be of.
    StencilOf GetSources() const { return ringCell ? ringCell->GetSources() : StencilOf::Points; }
    /// Weights by column, from those of a stencil.
    std::vector<double> Order(std::vector<double> const &stencil) const {
        return ringCell ? ringCell->GetPlaces().Order(stencil) : stencil;
    }
    /// A matrix of some rows, of which getStencil(row) gives the stencils.
    template <typename GET>
    PlaceMatrix<REAL> MakeMatrix(std::size_t numRows, GET const &getStencil) const {
        PlaceMatrix<REAL> matrix(numRows, ringCell ? ringCell->GetColumns().size()
                                                   : std::size_t(type->GetNumPoints()));
        for (std::size_t row = 0; row < numRows; ++row) {
            matrix.Set(row, Order(getStencil(row)));
        }
        return matrix;
    }
    /// Makes matrices with a row for each place: one for the points, or two for the derivatives by u and v.
    Matrices MakeMatrices(std::vector<BfrPlace> const &places, bool hasDerivatives) const;

    /// Evaluates the places of a matrix.
    ///
    /// \param runs  which places; null: all
    void Evaluate(PlaceMatrix<REAL> const &matrix, std::size_t size, REAL *results,
                  std::ptrdiff_t resultStride, std::vector<PlaceRun> const *runs = nullptr) const {
        SumUpPlaces(matrix, {points, stride, size, indices, results, resultStride,
                             runs ? runs->data() : nullptr, runs ? runs->size() : 0});
    }
    /// Overload for matrices, each of which writes results of its own.
    void Evaluate(Matrices const &matrices, std::size_t size, REAL *const *results,
                  std::ptrdiff_t resultStride, std::vector<PlaceRun> const *runs) const {
        for (std::size_t i = 0; i < matrices.count; ++i) {
            Evaluate(matrices.matrices[i], size, results[i], resultStride, runs);
        }
    }

    CellType const *type;
    RingCell const *ringCell; ///< null: the points of the type
    REAL const *points;
    std::ptrdiff_t stride;
    int const *indices; ///< by column; null: all in turn
};

/// The source of a child of a plain face.
///
/// \param indices  gets the points that columns have
template <typename REAL>
PlaceSource<REAL> FindChildSource(FaceRings const &face, std::size_t child,
                                  RingValues<REAL> &values, std::vector<int> &indices) {
    RingCell const &cell = face.GetChild(child);
    REAL const *const points = values.GetPoints();
    values.FindChildIndices(face, child, indices);
    return {&cell.GetType(), &cell, points, std::ptrdiff_t(values.GetPaddedSize()), indices.data()};
}

/// Writes a weighted sum of points of \p size numbers, in double precision: of all, or of those that \p indices name.
template <typename REAL, typename WEIGHT>
void SumUp(WEIGHT const *weights, std::size_t numPoints, REAL const *points, int const *indices,
           std::size_t size, std::ptrdiff_t stride, REAL *result) {
    for (std::size_t k = 0; k < size; ++k) {
        double sum = 0;
        for (std::size_t i = 0; i < numPoints; ++i) {
            std::ptrdiff_t const point = indices ? indices[i] : std::ptrdiff_t(i);
            sum += double(weights[i]) * double(points[point * stride + std::ptrdiff_t(k)]);
        }
        result[k] = REAL(sum);
    }
}

extern template struct PlaceSource<float>;
extern template struct PlaceSource<double>;

} // namespace OpenSubdivHex::BfrExt::internal

#endif
