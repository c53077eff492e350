// SPDX-License-Identifier: Apache-2.0
#include "faceCoords.h"

#include <algorithm>
#include <cmath>

namespace OpenSubdivHex::FarExt::internal {

namespace Bfr = OpenSubdiv::Bfr;
using Pair = BasePolygon::Pair;

Bfr::Parameterization MakeFaceParameterization(int size) {
    return {size == 3 ? OpenSubdiv::Sdc::SCHEME_LOOP : OpenSubdiv::Sdc::SCHEME_CATMARK, size};
}

namespace {

// The place in a sub-face, with (s, t) from 0 to 1.
template <typename POLYGON>
PlanePlace findInSubFace(POLYGON const &polygon, int size, int subFace, double s, double t) {
    // From the centre of the polygon.
    Pair const corner = polygon.GetCorner(subFace);
    Pair const next = polygon.GetCorner((subFace + 1) % size);
    Pair const previous = polygon.GetCorner((subFace + size - 1) % size);
    constexpr double kNormalization = 2; // sub-faces have half the width of a tile
    PlanePlace place;
    for (std::size_t i = 0; i < 2; ++i) {
        double const behind = 0.5 * (corner[i] + next[i]);
        double const before = 0.5 * (corner[i] + previous[i]);
        place.coords[i] = polygon.GetCenter()[i] + (1 - s) * (1 - t) * corner[i] +
                          s * (1 - t) * behind + (1 - s) * t * before;
        place.byU[i] = kNormalization * ((1 - t) * (behind - corner[i]) - t * before);
        place.byV[i] = kNormalization * ((1 - s) * (before - corner[i]) - s * behind);
        place.byUv[i] = kNormalization * kNormalization * (corner[i] - behind - before);
    }
    return place;
}

} // namespace

PlanePlace FindInPlane(Bfr::Parameterization const &parameterization, Pair const &uv) {
    if (!parameterization.HasSubFaces()) {
        return {uv, {1, 0}, {0, 1}, {0, 0}};
    }
    if (std::isnan(uv[0]) || std::isnan(uv[1])) { // in no sub-face
        return {{NAN, NAN}, {1, 0}, {0, 1}, {0, 0}};
    }
    int const size = parameterization.GetFaceSize();
    // Bfr converts coordinates to integers, and has tiles from 0 on, up to the size of the face.
    double const farthest = size;
    Pair const nearUv = {std::clamp(uv[0], 0.0, farthest), std::clamp(uv[1], 0.0, farthest)};
    Pair subUv;
    int const subFace = std::min(
        parameterization.ConvertCoordToNormalizedSubFace(nearUv.data(), subUv.data()), size - 1);
    double const s = std::clamp(subUv[0], 0.0, 1.0);
    double const t = std::clamp(subUv[1], 0.0, 1.0);
    return UsePolygon(
        size, [&](auto const &polygon) { return findInSubFace(polygon, size, subFace, s, t); });
}

Pair FindFaceCoords(Bfr::Parameterization const &parameterization, BasePolygon const &polygon,
                    int sector, SectorPoint point) {
    int const size = polygon.GetSize();
    if (!parameterization.HasSubFaces()) {
        Pair uv;
        polygon.Write(sector, point, uv.data());
        return uv;
    }
    if (polygon.GetShape().isHalf) {
        Pair coords;
        polygon.Write(sector, point, coords.data());
        BasePolygon const whole(size);
        SectorPoint const inWhole = whole.FindSector(coords, sector);
        return FindFaceCoords(parameterization, whole, sector, inWhole);
    }
    auto const [a, b] = point;
    Pair found;
    if (a == 0 && b == 0) {
        parameterization.GetCenterCoord(found.data());
    } else {
        bool const isAtStart = a > b;
        Pair subUv;
        if (a + b == 1) { // without rounding
            subUv = {isAtStart ? 2 * b : 0.0, isAtStart ? 0.0 : 2 * a};
        } else {
            // The point is x times the middle of the edge behind the corner, and y times that of the edge before;
            // the corner is 1 + m times their sum.
            double const cosine = std::cos(kPi / size);
            double const corner = 0.5 / (cosine * cosine);
            double const ofCorner = corner * std::max(a, b);
            double const ofOther = std::min(a, b);
            double const along = ofCorner + (2 - corner) * ofOther;
            double const beside = ofCorner - corner * ofOther;
            double const x = isAtStart ? along : beside;
            double const y = isAtStart ? beside : along;
            // It is (1 - t) (1 + m (1 - s)) and (1 - s) (1 + m (1 - t)).
            double const m = corner - 1;
            double const linear = 1 + m * (x - y);
            double const toS = 2 * y / (linear + std::sqrt(linear * linear + 4 * m * y));
            double const toT = toS + (x - y);
            subUv = {1 - toS, 1 - toT};
        }
        parameterization.ConvertNormalizedSubFaceToCoord(isAtStart ? sector : (sector + 1) % size,
                                                         subUv.data(), found.data());
    }
    return found;
}

} // namespace OpenSubdivHex::FarExt::internal
