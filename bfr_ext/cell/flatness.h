// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_BFR_EXT_CELL_FLATNESS_H
#define OPENSUBDIVHEX_BFR_EXT_CELL_FLATNESS_H

#include "refinedCells.h"
#include "vector3.h"

#include <algorithm>
#include <limits>
#include <vector>

namespace OpenSubdivHex::BfrExt::internal {

/// \brief Bounds how flat the surface in a cell is.
///
/// **What is bounded.**  The *thickness* of the cell: the length of the range that the heights of the surface
/// over the plane of the cell's corners have.  The corners and all points on the sides of the cell are of the
/// surface, too, so that no facet between such points is farther from the surface, in the direction of the
/// normal.
///
/// **Why it holds.**  Heights are linear in the points, so those of a cell's points give, by the same
/// steps, those of the points of all cells in it; and no height of the surface in such a cell is outside
/// of the range that HeightBounds or, where there are none, the points themselves tell of it.  Each part of the
/// surface is in one of the children, and in one of their children, and so on: so the ranges of cells
/// any number of steps on, together, bound all heights.  Heights that the surface has for certain, as at
/// corners, are a bound from below.
///
/// **What is looked at.**  Only cells whose range is not within a window, which is a little longer than
/// the heights that the surface has for certain, are looked at one step on.
///
/// **How close it is.**  Ranges of HeightBounds are close, and often decide at once.  Those of other
/// cells reach farther: their points lie around a cell by about its size, so that their heights have a
/// range that is some times as large as that of the surface.  Where curvature is bounded, this excess
/// falls by 4 in a step, so that it is a small part after kNumSteps of them.  The bound that is found then is
/// the last one.
///
/// No camera is needed, and what is looked at does not depend on the length that is asked about, only when
/// it ends does: so bounds that are kept say the same as those that are found anew.
class Flatness {
public:
    /// The thickness of a cell is within.
    struct Bounds {
        double least = 0;
        double most = std::numeric_limits<double>::infinity();
    };
    /// \brief Finds bounds of which either is on one side of a length: \p least is larger, or \p most is not,
    /// or both are the last bound.
    ///
    /// \param cells    gets cells that some steps make of it; points have 3 numbers
    /// \param cell     that is looked at
    /// \param corners  the surface's points there
    /// \param length   that the thickness is compared to
    Bounds Find(RefinedCells &cells, std::size_t cell, std::vector<double> const &corners,
                double length);

private:
    static constexpr int kNumSteps = 4;
    static constexpr int kNumBoundedSteps = 2; // of these, at most

    struct Plane {
        double GetHeight(double const *point) const {
            return Dot(normal, Subtract(ToVector3(point), origin));
        }

        Vector3 origin;
        Vector3 normal;
    };
    struct Range {
        void Add(double height) {
            min = std::min(min, height);
            max = std::max(max, height);
        }
        void Add(Range const &other) {
            Add(other.min);
            Add(other.max);
        }
        bool Has(Range const &other) const { return min <= other.min && other.max <= max; }
        Range Cut(Range const &other) const {
            return {std::max(min, other.min), std::min(max, other.max)};
        }
        double GetLength() const { return max - min; }
        double min;
        double max;
    };
    // A cell some steps on.
    struct Part {
        std::size_t cell;
        int numStepsLeft;
        Range range; // of heights; until it is looked at, that of the parent
    };

    static Plane findPlane(std::vector<double> const &corners);
    Range findHeights(CellValues const &values);
    Range findRange(RefinedCells &cells, std::size_t cell);
    void refine(RefinedCells &cells, Part const &parent, std::vector<Part> &children);

    Plane _plane = {};
    Range _attained = {0, 0};     // of heights that the surface has
    std::vector<Part> _parts;     // of this step
    std::vector<Part> _next;      // of the next
    std::vector<double> _heights; // of a part's points
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
