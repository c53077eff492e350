// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_BFR_EXT_CELL_SECOND_DERIVATIVES_H
#define OPENSUBDIVHEX_BFR_EXT_CELL_SECOND_DERIVATIVES_H

#include "cellType.h"

#include <array>
#include <cstddef>
#include <vector>

namespace OpenSubdivHex::BfrExt::internal {

/// \brief The second derivatives of the surface at the corners of a half cell in a regular lattice, where
/// FaceMask::Smooth gives it continuous ones.
///
/// They are sums of points: by the first coordinate of HalfCell twice, by both, and by the second twice.
/// Let D_c be these three rows at corner c, as a symmetric 2 x 2 matrix.
///
/// A step A makes a child of the same type that has corner c as its corner k, at coordinates R x + shift.
/// The surface of the child is that of the cell, hence
///
///     D_c = R^T (D_k A) R.
///
/// Steps keep quadratic functions of the places of points but for a constant: so D_c gives the second
/// derivatives of each such function, and 0 of each linear one.  Rows that do so come to fulfil the equation by
/// going through it again and again: what is left falls by 2 in each step, since the scheme's eigenvalues behind
/// the three of 1/4 are 1/8.
class SecondDerivatives {
public:
    /// By the first coordinate twice, by both, by the second twice.
    static constexpr std::size_t kNumRows = 3;
    using Rows = std::array<std::vector<double>, kNumRows>;

    static SecondDerivatives const &Find(CellType const &type);
    /// Turns rows by coordinates into those by others, of which these have some derivatives.
    static void Turn(Pair const (&toCoords)[2], Rows &rows) {
        double *const by[kNumRows] = {rows[0].data(), rows[1].data(), rows[2].data()};
        TurnSecondDerivatives(toCoords, rows[0].size(), by);
    }

    /// Whether the type is of such cells.
    bool Exist() const { return !_rows.empty(); }
    std::size_t GetHeapSize() const { return internal::GetHeapSize(_rows); }
    Rows const &AtCorner(std::size_t corner) const { return _rows[corner]; }

private:
    explicit SecondDerivatives(CellType const &type);

    std::vector<Rows> _rows; // by corner
};

} // namespace OpenSubdivHex::BfrExt::internal

#endif
