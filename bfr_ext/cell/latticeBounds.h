// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_BFR_EXT_CELL_LATTICE_BOUNDS_H
#define OPENSUBDIVHEX_BFR_EXT_CELL_LATTICE_BOUNDS_H

#include "cellType.h"
#include "placeKernel.h"

#include <array>
#include <vector>

namespace OpenSubdivHex::BfrExt::internal {

/// \brief Close bounds of heights in all half cells of a type, where their points have places in a
/// lattice that linear functions of are kept (FindLatticePlaces()).
///
/// **What is done.**  The surface is a sum of the points P_i with weights w_i(x).  In each of the *parts*
/// of a cell, the cells two steps on, a weight is a linear function A_i of the place x, and a rest r_i.
/// So a height, the sum of all h_i w_i(x), is a linear function, whose range in a part is that at its
/// corners, and a rest that is at most the sum of all |h_i| c_i, where c_i is a bound of |r_i| there.
/// Weights have bounded curvature, so that rests are small: c_i add up to about a tenth.
///
/// **A and c.**  A_i is the linear function that is closest to w_i at the corners of the part, where w_i is
/// known exactly.  Steps make points of cells in the part, with weights of P_i in a row each.  At all
/// these points, r_i has what the row has, less A_i at the place of the point: for A_i is kept.  As the
/// surface is between points, so is r_i; and c_i is the largest of these in all cells some steps on.
class LatticeBounds {
public:
    explicit LatticeBounds(CellType const &type);

    /// Those of a type, which are found once.
    static LatticeBounds const &Find(CellType const &type);

    /// Whether there are any: else nothing else may be asked for.
    bool Exist() const { return !_parts.empty(); }

    /// What is found of the heights in a cell.
    struct Range {
        double min;
        double max;
    };
    struct Ranges {
        Range attained; ///< of the surface at the corners of the parts
        Range bound;    ///< of all of the surface
    };
    /// \param heights  by point
    /// \param scratch  of the thread, whatever it has
    Ranges GetRanges(std::vector<double> const &heights, std::vector<double> &scratch) const;

private:
    using Part = std::array<std::size_t, 4>; // its corners, as samples

    std::vector<Part> _parts;
    PlaceMatrix<double> _samples; // the surface at the corners of parts, each once
    PlaceMatrix<double> _rests;   // c, by part
};

} // namespace OpenSubdivHex::BfrExt::internal

#endif
