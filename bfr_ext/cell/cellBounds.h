// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_BFR_EXT_CELL_CELL_BOUNDS_H
#define OPENSUBDIVHEX_BFR_EXT_CELL_CELL_BOUNDS_H

#include "cellValues.h"

#include <vector>

namespace OpenSubdivHex::BfrExt::internal {

/// \brief What holds for the surface in all cells of a type, wherever their points lie.
///
/// **Weights.**  A place of a cell is a sum of the points, with weights that are not negative and add up
/// to 1.  A step makes points of a child of them with such weights, too, and so do some steps: a place
/// in the cell is a sum of the points of the cell two steps on that has it.  So no weight of a place is
/// larger than the largest that these points have.
///
/// **Derivatives**, where all cells that a step makes are of the same type again and it keeps linear
/// functions: with FaceMask::Smooth and Cosine, in a regular lattice.  Let x be the places of the points
/// in a plane, and A the linear function that is nearest to points P, with the rest r = P - A(x).  The
/// cells k steps on have the rest N r, where N is a matrix for each of them, and their A has another
/// slope by H r.  Let n and h be, by point, the largest absolute values in all rows of these matrices,
/// and g and s the largest sums of absolute values in a row of N and of H.  Lengths shrink by 2 in a
/// step: k steps on the slope differs by h |r| at most, and then by s (2^k n |r|), s (2^k n |r|) (2^k g)
/// and so on for each k further steps, as far as one goes.  Where 2^k g < 1, all of it is at most
/// h |r| + s 2^k n |r| / (1 - 2^k g).  That bounds what the derivatives of the surface differ by from the
/// slope: the surface differs from A by no more than the largest rest, and rests fall faster than
/// lengths do, so that slopes tend to the derivatives.  Once there is such a bound b |r|, those of the
/// matrices of each of the cells are a closer one: |H r| + 2^k b |N r|, and so on.
class CellBounds {
public:
    explicit CellBounds(CellType const &type);

    /// Those of a type, which are found once.
    static CellBounds const &Find(CellType const &type);

    /// The bounds of a number of all places of the cell, from that of each point.
    struct Range {
        double min;
        double max;
    };
    Range GetRange(std::vector<double> const &numbers) const;

    /// Whether derivatives are bounded.
    bool HasSlopes() const { return !_slopes[0].empty(); }
    /// \brief A unit vector, and the largest length of what normals of the surface have besides, in the
    /// plane across from it, where they have length 1 along it; infinite where nothing is known.
    struct Normals {
        std::array<double, 3> middle;
        double spread;
    };
    /// \brief The normals in the cell, as Du x Dv.
    ///
    /// The slopes of the nearest linear function span a plane.  By the parts of rests in it
    /// derivatives change there: where it is by less than the slopes stretch any direction, they are not
    /// turned over.  By the parts along the normal they leave it.
    ///
    /// \param values  of points, 3 numbers each
    Normals GetNormals(std::vector<double> const &values) const;

private:
    std::vector<double> _weights;      // by point
    std::vector<Pair> _places;         // of points, where derivatives are bounded
    std::vector<double> _slopes[2];    // of A, as sums of points
    Pair _center = {};                 // the mean of the places
    std::vector<double> _slopeChanges; // by point: how much slopes may change by, over its rest
};

} // namespace OpenSubdivHex::BfrExt::internal

#endif
