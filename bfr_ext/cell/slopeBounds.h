// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_BFR_EXT_CELL_SLOPE_BOUNDS_H
#define OPENSUBDIVHEX_BFR_EXT_CELL_SLOPE_BOUNDS_H

#include "cellValues.h"
#include "halfCell.h"
#include "vector3.h"

#include <vector>

namespace OpenSubdivHex::BfrExt::internal {

class PointRows;

/// \brief How far the derivatives of the surface in cells of a type are from those of the linear function
/// that is nearest to their points.
///
/// There are bounds where all cells that a step makes are of the same type again and it keeps linear
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
class SlopeBounds {
public:
    explicit SlopeBounds(CellType const &type);

    /// Those of a type, which are found once.
    static SlopeBounds const &Find(CellType const &type);

    /// Whether there are any: else there are no normals.
    bool Exist() const { return !_changes.empty(); }
    /// \brief How many steps on all cells have bounds, if that is kMaxSteps at most; else a larger number,
    /// as of all cells at an irregular vertex.
    int GetNumSteps() const { return _numSteps; }
    static constexpr int kMaxSteps = 3;

    /// \brief A unit vector, and the largest length of what normals of the surface have besides, in the
    /// plane across from it, where they have length 1 along it; infinite where nothing is known.
    struct Normals {
        Vector3 middle;
        double spread;
    };
    /// \brief The normals in the cell, as Du x Dv.
    ///
    /// The slopes of the nearest linear function span a plane.  By the parts of rests in it
    /// derivatives change there: where it is by less than the slopes stretch any direction, they are not
    /// turned over.  By the parts along the normal they leave it.
    ///
    /// \param values  of points, 3 numbers each
    Normals GetNormals(CellValues const &values) const;

private:
    // What the points of a cell some steps on are, in terms of those of the type.
    struct Descendant;

    void fitSlopes();
    Pair fromCenter(std::size_t point) const;
    Descendant look(PointRows const &points) const;
    void close(std::vector<Descendant> const &descendants);
    void narrow(std::vector<Descendant> const &descendants);

    int _numSteps = 0;
    std::vector<Pair> _places;      // of points, where there are bounds
    Pair _center = {};              // the mean of the places
    std::vector<double> _slopes[2]; // of A, as sums of points
    std::vector<double> _changes;   // by point: how much slopes may change by, over its rest
};

} // namespace OpenSubdivHex::BfrExt::internal

#endif
