// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_BFR_EXT_CELL_HEIGHT_BOUNDS_H
#define OPENSUBDIVHEX_BFR_EXT_CELL_HEIGHT_BOUNDS_H

#include "cellType.h"
#include "halfCell.h"
#include "placeKernel.h"

#include <array>
#include <vector>

namespace OpenSubdivHex::BfrExt::internal {

/// \brief Close bounds of heights in all cells of a type.
///
/// **What is done.**  The points have places x_i in the plane of the cell (PlacePoints()).  Of their heights h
/// a quadratic function q(x) is taken away that comes close to them: h_i = q(x_i) + e_i.  The heights of the
/// surface are then those that it has for q, and a sum of the e_i.  Weights are not negative, add up to 1,
/// and each has a bound m_i in the cell (CellBounds): so that sum is at most the largest e_i, and at most the sum
/// of all m_i e_i where e_i > 0.  Of all q that is taken for which the sum of m_i e_i^2 is the least.
///
/// **The surface for q** is a sum of those for the *terms* 1, x, y, x^2, x y, y^2.  In each of the *parts* of the
/// cell, half cells some steps on, such a surface is a quadratic function of the part's own places, and something in
/// an interval.  Both depend on the type alone: of the points that a step makes for a term a function is
/// taken away in the same way.
///
/// **In half cells** the surface differs from a term by something in an interval, too: in a
/// regular lattice, with FaceMask::Smooth and Cosine, by a constant; where the lattice is regular but for a vertex
/// nearby, by nearly that.  One step on, the points of a child have for a term what the term is at their places
/// there, and something else, e.  The term is a sum of terms in coordinates of the child, those of first and
/// second degree being 1/2 and 1/4 as large: so the interval of the cell is that of the child's, made
/// smaller by so much, and that of the e.  From intervals that are wide enough for any surface,
/// some steps on, they come to nearly what they are.  A half cell whose intervals are small is
/// one part; others, beside a base vertex that has not three faces, where places come together by
/// another factor than 1/2, and whole cells are taken apart.
class HeightBounds {
public:
    HeightBounds(HeightBounds &&) = default;
    explicit HeightBounds(CellType const &type);

    /// Those of a type, which are found once.
    static HeightBounds const &Find(CellType const &type);

    struct Range {
        double min;
        double max;
    };
    struct Ranges {
        Range
            attained; ///< that the surface has at least; turned over, min > max, if nothing is known
        Range bound;  ///< of all of the surface
    };
    /// \param heights  by point
    /// \param scratch  of the thread, whatever it has
    Ranges GetRanges(double const *heights, std::vector<double> &scratch) const;

private:
    static constexpr std::size_t kNumTerms = 6;
    static constexpr std::size_t kPadded = 8;
    static constexpr std::size_t kNumCorners = 4;

    using Terms = std::array<double, kNumTerms>;
    using Intervals = std::array<Range, kNumTerms>;
    using Corners = std::array<std::size_t, kNumCorners>; // of a part, as samples
    struct ChildMap;
    class Fit;

    static Terms getTerms(Pair const &place);
    static std::array<Pair, kNumCorners> getCorners();
    static std::vector<Pair> placePoints(CellType const &type);
    static Intervals const &findIntervals(CellType const &type, int numSteps);
    static Intervals boundAny(CellType const &type);
    static Intervals boundBySteps(CellType const &type, int numSteps);
    static Range findRange(Terms const &quadratic);
    class Maker;

    Fit const &_fit;
    std::vector<Corners> _parts;
    PlaceMatrix<double> _samples; // the surface at the corners of parts, each once
    PlaceMatrix<double> _rests; // by part, of points and terms: how far the surface is from linear
};

} // namespace OpenSubdivHex::BfrExt::internal

#endif
