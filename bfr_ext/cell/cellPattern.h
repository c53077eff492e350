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

} // namespace OpenSubdivHex::BfrExt::internal

#endif
