// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_BFR_EXT_CELL_CELL_PATTERN_H
#define OPENSUBDIVHEX_BFR_EXT_CELL_CELL_PATTERN_H

#include "cellStencil.h"
#include "mirrorMatrix.h"

namespace OpenSubdivHex::BfrExt::internal {

/// \brief A pattern of places of a base face in a lattice, as matrices of their stencils.
template <typename REAL>
struct CellPattern {
    /// Of the points.
    ///
    /// \param numBorderPlaces  the first ones, whose points BorderEvaluator makes
    CellPattern(CellType const &root, std::vector<BasePoint> const &places,
                std::size_t numBorderPlaces);
    /// Of the derivatives of all places.
    CellPattern(CellType const &root, std::vector<BasePoint> const &places);

    /// One of the points, or those of the derivatives by u and v.
    std::vector<MirrorMatrix<REAL>> matrices;
};

/// \brief What a place on the border is summed up with: an item of the border, by edge and then by
/// vertex, and where on an edge it is.
struct BorderPlace {
    CellType::BorderItem const *item;
    double point;
};
BorderPlace FindBorderPlace(CellType const &root, int const *turns, BasePoint const &point);

/// \brief Evaluates what lies on the border of a base face, of which all faces that share it form the
/// same sums.
///
/// Those of a vertex are its own, and so are those of an edge in a regular neighborhood.  Those of
/// other edges are the sums for the long edge that they become in the first step: long edges have far
/// fewer types than edges.
template <typename REAL>
class BorderEvaluator {
public:
    /// \param size  of a point; they are \p stride numbers apart
    void SetPoints(REAL const *points, std::ptrdiff_t stride, int size);

    /// That of an edge, of the long edge of it or of a vertex: the matrices are of its points.
    static CellType const &GetType(CellType::BorderItem const &item) {
        CellType const &type = *item.type;
        return type.IsVertex() || type.IsInLattice() ? type : *type.GetChildren()[0].type;
    }
    /// The stencils of some places on it, in its own direction.
    static PlaceMatrix<REAL> MakeMatrix(CellType const &type, std::vector<double> const &points);

    /// Writes the points at the places of a matrix.
    void Evaluate(CellType::BorderItem const &item, PlaceMatrix<REAL> const &matrix, REAL *results,
                  std::ptrdiff_t resultStride);

    /// @name The same for all of a border
    /// @{

    /// Forms the sums that the border is made of.
    void FormSums(CellType::Border const &border);
    /// Writes the point of a vertex.
    void EvaluateVertex(std::size_t vert, REAL *result) const;
    /// Writes the points at the places of a matrix.
    void EvaluateEdge(CellType::Border::Edge const &edge, PlaceMatrix<REAL> const &matrix,
                      REAL *results, std::ptrdiff_t resultStride) const;
    /// @}

private:
    void padPoints(int const *indices, std::size_t numPoints);

    REAL const *_points = nullptr;
    std::ptrdiff_t _stride = 0;
    std::size_t _size = 0;
    std::size_t _paddedSize = 0;
    // Those that sums are formed of, these, and those of a long edge, padded.
    std::vector<REAL> _paddedPoints;
    std::vector<REAL> _sums;
    std::vector<REAL> _longEdgePoints;
};

} // namespace OpenSubdivHex::BfrExt::internal

#endif
