// SPDX-License-Identifier: Apache-2.0
#include "cellShape.h"

#include "far_ext/vtr/basePolygon.h"

#include <algorithm>
#include <vector>

namespace OpenSubdivHex::BfrExt::internal {

namespace {

// The corners of a cell in the plane of its face, counter-clockwise.
std::vector<Pair> findCornersInPlane(FaceShape shape, CellShape const &cell) {
    FarExt::internal::BasePolygon const polygon(shape);
    std::vector<Pair> corners;
    for (int i = 0; i < cell.GetNumCorners(shape); ++i) {
        auto const [sector, place] = cell.GetCorner(shape, i);
        Pair const start = polygon.GetCorner(sector);
        Pair const end = polygon.GetCorner((sector + 1) % shape.size);
        corners.push_back(
            {place[0] * start[0] + place[1] * end[0], place[0] * start[1] + place[1] * end[1]});
    }
    return corners;
}

// Whether all corners of one convex polygon are beyond a side of the other.
bool isBeyondSide(std::vector<Pair> const &corners, std::vector<Pair> const &other) {
    constexpr double kTolerance = 1e-6; // of areas, in units of whole numbers
    for (std::size_t i = 0; i < other.size(); ++i) {
        Pair const &start = other[i];
        Pair const &end = other[(i + 1) % other.size()];
        if (std::all_of(corners.begin(), corners.end(), [&](Pair const &corner) {
                return (end[0] - start[0]) * (corner[1] - start[1]) -
                           (end[1] - start[1]) * (corner[0] - start[0]) <
                       -kTolerance;
            })) {
            return true;
        }
    }
    return false;
}

} // namespace

bool CellShape::Touches(FaceShape shape, CellShape const &other) const {
    std::vector<Pair> const own = findCornersInPlane(shape, *this);
    std::vector<Pair> const others = findCornersInPlane(shape, other);
    return !isBeyondSide(own, others) && !isBeyondSide(others, own);
}

} // namespace OpenSubdivHex::BfrExt::internal
