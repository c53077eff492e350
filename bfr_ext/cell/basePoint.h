// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_BFR_EXT_CELL_BASE_POINT_H
#define OPENSUBDIVHEX_BFR_EXT_CELL_BASE_POINT_H

#include "halfCell.h"

#include "far_ext/vtr/inline.h"

#include <algorithm>
#include <cmath>

namespace OpenSubdivHex::BfrExt::internal {

/// A point of a base face: a sector of its polygon, and coordinates there.
struct BasePoint {
    int sector;
    Pair coords;
    Pair toCoords[2]; ///< of u and v: the derivatives of the coordinates by them
};

/// The nearest coordinates in a sector, on the line to the centre; those that are not numbers stay so.
inline Pair ClampToSector(Pair const &coords) {
    if (coords[0] >= 0 && coords[1] >= 0 && coords[0] + coords[1] <= 1) {
        return coords;
    }
    double const a = std::max(coords[0], 0.0);
    double const b = std::max(coords[1], 0.0);
    double const scale = 1 / std::max(a + b, 1.0);
    return {a * scale, b * scale};
}

/// \brief Takes coordinates for the nearest multiple of a small power of 1/2, as vertices of the first levels have, if
/// it is so close.
inline double SnapToGrid(double coordinate, double tolerance) {
    constexpr double kGrid = 1.0 / (1 << 16);
    double const multiple = std::round(coordinate / kGrid) * kGrid;
    return std::abs(coordinate - multiple) <= std::min(tolerance, kGrid / 4) ? multiple
                                                                             : coordinate;
}

/// The sector that has a point of the plane, from the centre of the polygon; between sectors, any of these.
template <typename POLYGON>
OPENSUBDIVHEX_INLINE int FindSector(POLYGON const &polygon, FaceShape shape, double x, double y) {
    // Places come in any order: without branches where these are many.
    if (shape == FaceShape(4)) {
        return (y > x ? 3 : 0) ^ (y > -x ? 1 : 0);
    }
    if (shape == FaceShape(3)) {
        // The corner that weighs least lies opposite.
        constexpr int kSectors[2][2][2] = {{{1, 1}, {2, 0}}, {{1, 0}, {2, 0}}};
        double const ofFirst = -(x + y);
        return kSectors[y < ofFirst ? 1 : 0][x < ofFirst ? 1 : 0][y < x ? 1 : 0];
    }
    int const first = shape.GetFirstSector();
    int sector = first;
    double best = 0;
    for (int i = first; i < shape.size; ++i) {
        auto const &[a, b] = polygon.GetSectorMap(i);
        double const least = std::min(a[0] * x + a[1] * y, b[0] * x + b[1] * y);
        if (i == first || least > best) {
            best = least;
            sector = i;
        }
    }
    return sector;
}

/// The point with coordinates in a sector, which are inside.
template <typename POLYGON>
BasePoint MakeBasePoint(POLYGON const &polygon, int sector, Pair const &coords) {
    auto const &[a, b] = polygon.GetSectorMap(sector);
    return {sector, coords, {a, b}};
}
/// Overload for a whole cell some steps from the face on.
inline BasePoint MakeBasePoint(FaceShape shape, int sector, Pair const &coords, int numSteps = 0) {
    BasePoint point = FarExt::internal::UsePolygon(
        shape, [&](auto const &polygon) { return MakeBasePoint(polygon, sector, coords); });
    for (Pair &toCoord : point.toCoords) {
        toCoord = {std::ldexp(toCoord[0], numSteps), std::ldexp(toCoord[1], numSteps)};
    }
    return point;
}
/// A corner of a whole cell some steps from the face on, in its own sector, whatever the coordinates there.
inline BasePoint MakeCornerPoint(FaceShape shape, int corner, int numSteps) {
    return MakeBasePoint(shape, shape.GetSectorOfCorner(corner), {}, numSteps);
}

/// \brief Finds a point of the plane of a base face, or where the line from the
/// centre to it leaves the face.  Its coordinates are not numbers where u or v is none.
///
/// \param tolerance  of coordinates: those that are so close to a multiple of a small power of 1/2, as
///                   vertices have, are taken for it; 0: none are
template <typename POLYGON>
OPENSUBDIVHEX_INLINE BasePoint FindBasePoint(POLYGON const &polygon, FaceShape shape, double u,
                                             double v, double tolerance) {
    // Places further away are taken to be there: products of finite coordinates are finite.
    constexpr double kFar = 1e100;
    Pair const center = polygon.GetCenter();
    double const x = std::clamp(u - center[0], -kFar, kFar);
    double const y = std::clamp(v - center[1], -kFar, kFar);
    int const sector = FindSector(polygon, shape, x, y);
    auto const &[a, b] = polygon.GetSectorMap(sector);
    Pair coords = {a[0] * x + a[1] * y, b[0] * x + b[1] * y};
    if (tolerance > 0) {
        coords = {SnapToGrid(coords[0], tolerance), SnapToGrid(coords[1], tolerance)};
    }
    coords = ClampToSector(coords);
    // Between two sectors it is the second, as in tessellations.
    if (coords[0] == 0) {
        SectorPlace<Pair> const name = NameOf(shape, SectorPlace<Pair>{sector, coords});
        return MakeBasePoint(polygon, name.sector, name.coords);
    }
    return {sector, coords, {a, b}};
}
BasePoint FindInUncommonPolygon(FaceShape shape, double u, double v, double tolerance);
OPENSUBDIVHEX_INLINE BasePoint FindBasePoint(FaceShape shape, double u, double v,
                                             double tolerance) {
    using FarExt::internal::KnownPolygon;
    KnownPolygon const *const known = KnownPolygon::Find(shape);
    return known ? FindBasePoint(*known, shape, u, v, tolerance)
                 : FindInUncommonPolygon(shape, u, v, tolerance);
}

} // namespace OpenSubdivHex::BfrExt::internal

#endif
