// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_BFR_EXT_CELL_FLATNESS_H
#define OPENSUBDIVHEX_BFR_EXT_CELL_FLATNESS_H

#include "refinedCells.h"
#include "vector3.h"

#include <vector>

namespace OpenSubdivHex::BfrExt::internal {

/// \brief Estimates the *thickness* of cells: the length of the range that the heights of the surface over the plane
/// of a cell's corners have.
///
/// The heights of SurfaceSamples are known.  Between them a quadratic surface reaches a fifteenth further at most:
/// the range is taken to be an eighth longer.  Cells whose types few are of have the samples of those that some steps
/// make of them.
class Flatness {
public:
    /// \param cells    gets cells that some steps make of it; points have 3 numbers
    /// \param cell     that is looked at
    /// \param corners  the surface's points there
    double FindThickness(RefinedCells &cells, std::size_t cell, std::vector<double> const &corners);

private:
    struct Plane {
        double GetHeight(double const *point) const {
            return Dot(normal, Subtract(ToVector3(point), origin));
        }

        Vector3 origin;
        Vector3 normal;
    };

    static Plane findPlane(std::vector<double> const &corners);
    void add(double height);
    void addSamples(RefinedCells &cells, std::size_t cell, int numSteps);

    Plane _plane = {};
    double _least = 0; // of the heights so far
    double _largest = 0;
    std::vector<double> _heights; // of a cell's points
    std::vector<double> _samples;
};

/// \brief Whether a curve is within \p length of the line between two points, likewise: an edge or a half of a cell's
/// diagonal, with the values of its points.
///
/// \param parts  those that the curve is made of one step on
bool IsStraight(std::vector<CellValues> const &parts, double const start[3], double const end[3],
                double length);

} // namespace OpenSubdivHex::BfrExt::internal

#endif
