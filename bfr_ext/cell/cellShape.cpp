// SPDX-License-Identifier: Apache-2.0
#include "cellShape.h"

#include <algorithm>

namespace OpenSubdivHex::BfrExt::internal {

namespace {

using Place = CellShape::Place;

// The corners of a cell that lie in a sector, or on the lines at its sides, in the coordinates there, and
// whether each of them has a side to the next that lies there, too.
struct Outline {
    std::array<Place, 4> corners;
    std::array<Place, 4> ends;
    std::array<bool, 4> hasCorner;
    std::array<bool, 4> hasSide;
};

// Changes a place of one sector to what it is in another, if it lies there, too.
bool changeSector(int faceSize, int from, int to, Place &place) {
    if (from == to) {
        return true;
    }
    if (to == (from + 1) % faceSize && place[0] == 0) {
        place = {place[1], 0};
        return true;
    }
    if (from == (to + 1) % faceSize && place[1] == 0) {
        place = {0, place[0]};
        return true;
    }
    return false;
}

Outline makeOutline(int faceSize, int sector, CellShape const &cell) {
    Outline outline = {};
    if (cell.isWhole) {
        outline.corners[0] = {cell.scale, 0};
        outline.corners[1] = {0, cell.scale};
        outline.ends[0] = outline.corners[1];
        outline.hasCorner = {true, true, false, false};
        outline.hasSide[0] = true;
        return outline;
    }
    outline.corners = cell.corners;
    for (std::size_t i = 0; i < 4; ++i) {
        outline.hasCorner[i] = changeSector(faceSize, cell.sector, sector, outline.corners[i]);
    }
    for (std::size_t i = 0; i < 4; ++i) {
        std::size_t const next = (i + 1) % 4;
        outline.ends[i] = outline.corners[next];
        outline.hasSide[i] = outline.hasCorner[i] && outline.hasCorner[next];
    }
    return outline;
}

bool isBetween(Place const &place, Place const &start, Place const &end) {
    std::int64_t const along[2] = {end[0] - start[0], end[1] - start[1]};
    std::int64_t const to[2] = {place[0] - start[0], place[1] - start[1]};
    std::int64_t const product = along[0] * to[0] + along[1] * to[1];
    return along[0] * to[1] == along[1] * to[0] && 0 <= product &&
           product <= along[0] * along[0] + along[1] * along[1];
}

// Whether a corner of a lies on a side of b.
bool hasCornerOnSide(Outline const &a, Outline const &b) {
    for (std::size_t i = 0; i < 4; ++i) {
        for (std::size_t k = 0; a.hasCorner[i] && k < 4; ++k) {
            if (b.hasSide[k] && isBetween(a.corners[i], b.corners[k], b.ends[k])) {
                return true;
            }
        }
    }
    return false;
}

} // namespace

// Cells have their corners on the sides of those that they meet, or have corners of these on their own.
bool CellShape::Touches(FaceShape shape, CellShape const &other) const {
    int const faceSize = shape.size;
    if (!other.isWhole) {
        int const turn = (other.sector - sector + faceSize) % faceSize;
        if (turn > 1 && turn < faceSize - 1) {
            return false;
        }
    }
    Outline const own = makeOutline(faceSize, sector, *this);
    Outline const others = makeOutline(faceSize, sector, other);
    return hasCornerOnSide(own, others) || hasCornerOnSide(others, own);
}

} // namespace OpenSubdivHex::BfrExt::internal
