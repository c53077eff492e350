// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_BFR_EXT_CELL_SURFACE_SAMPLES_H
#define OPENSUBDIVHEX_BFR_EXT_CELL_SURFACE_SAMPLES_H

#include "cellType.h"
#include "placeKernel.h"

#include <vector>

namespace OpenSubdivHex::BfrExt::internal {

/// \brief Points of the surface in a type of cells, or of the curve of an edge: the corners of the cells, or the ends
/// of the parts, that two steps make of it.
class SurfaceSamples {
public:
    explicit SurfaceSamples(CellType const &type);

    /// The samples of a type, which are found once.
    static SurfaceSamples const &Find(CellType const &type);

    /// Writes the samples, of \p size numbers each without gaps, from the points of a cell.
    void Evaluate(double const *points, std::ptrdiff_t stride, std::size_t size,
                  std::vector<double> &samples) const;

private:
    PlaceMatrix<double> _matrix;
};

} // namespace OpenSubdivHex::BfrExt::internal

#endif
