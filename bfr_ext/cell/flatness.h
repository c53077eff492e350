// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_BFR_EXT_CELL_FLATNESS_H
#define OPENSUBDIVHEX_BFR_EXT_CELL_FLATNESS_H

#include "cellBounds.h"

#include <vector>

namespace OpenSubdivHex::BfrExt::internal {

/// \brief Says whether the surface in a cell is as flat as is asked for.
///
/// **What is shown.**  The heights of the surface over the plane of the cell's corners have a range that
/// is no larger than a length.  The corners and all points on the sides of the cell are of the surface,
/// too, so that no facet between such points is farther from the surface, in the direction of the
/// normal.
///
/// **Why it holds.**  Heights are linear in the points, so those of a cell's points give, by the same
/// steps, those of the points of all cells in it; and CellBounds::GetRange() has no height of the
/// surface in such a cell outside of its range.  Each part of the surface is in one of the children, and
/// in one of their children, and so on: so the ranges of the cells any number of steps on, together,
/// bound all heights.  A cell whose range lies within heights that the surface has for certain, as at
/// corners, adds nothing, and neither do the cells in it: these are not looked at.
///
/// **How close it is.**  Points of a cell reach beyond it by about its size, so that their heights have
/// a range that is some times as large as that of the surface.  Where curvature is bounded, this excess
/// falls by 4 in a step, so that it is a small part after kNumSteps of them.  What cannot be shown then
/// counts as not flat.
class Flatness {
public:
    /// Whether the surface of a cell is so flat.
    ///
    /// \param corners   the surface's points there, of 3 numbers each
    /// \param children  of the cell
    /// \param length    the largest range of heights
    bool IsFlat(std::vector<double> const &corners, std::vector<CellValues> const &children,
                double length);

private:
    static constexpr int kNumSteps = 3;

    struct Range {
        void Add(double height);
        bool Has(Range const &other) const { return min <= other.min && other.max <= max; }
        double GetLength() const { return max - min; }
        double min;
        double max;
    };
    // A cell some steps on, with the heights of its points in a row of all such cells'.
    struct Cell {
        CellType const *type;
        std::size_t firstHeight;
        bool isWithin; // heights that the surface has
    };
    struct Cells {
        std::vector<Cell> cells;
        std::vector<double> heights;
    };

    Range findBound(Cells &cells, Range const &attained);
    static void refine(Cells const &parents, Cells &children);

    Cells _cells[2]; // of this step and of the next, in turn
    std::vector<double> _scratch;
};

/// \brief The same of a curve: an edge or a half of a cell's diagonal, with the values of its points.
///
/// Distances from a line are convex, so that of a sum with weights that are not negative and add up to 1
/// is no more than the same sum of distances.
///
/// \param parts   those that the curve is made of one step on
/// \param start   of the line
/// \param end     of the line
/// \param length  the largest distance
bool IsStraight(std::vector<CellValues> const &parts, double const start[3], double const end[3],
                double length);

} // namespace OpenSubdivHex::BfrExt::internal

#endif
