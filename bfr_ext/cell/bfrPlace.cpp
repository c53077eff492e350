// SPDX-License-Identifier: Apache-2.0
#include "bfrPlace.h"

#include <algorithm>

namespace OpenSubdivHex::BfrExt::internal {

using FarExt::internal::BasePolygon;

namespace {

// From the centre of a polygon, the place of a sub-face at (s, t): its corners are corner number i of the
// polygon, the middle of the edge behind, the centre, and the middle of the edge before.
PlanePlace findInSubFace(BasePolygon const &polygon, int subFace, double s, double t) {
    int const size = polygon.GetSize();
    Pair const corner = polygon.GetCorner(subFace);
    Pair const next = polygon.GetCorner((subFace + 1) % size);
    Pair const previous = polygon.GetCorner((subFace + size - 1) % size);
    PlanePlace place = {};
    for (std::size_t i = 0; i < 2; ++i) {
        double const behind = 0.5 * (corner[i] + next[i]);
        double const before = 0.5 * (corner[i] + previous[i]);
        place.uv[i] = (1 - s) * (1 - t) * corner[i] + s * (1 - t) * behind + (1 - s) * t * before;
        place.byU[i] = (1 - t) * (behind - corner[i]) - t * before;
        place.byV[i] = (1 - s) * (before - corner[i]) - s * behind;
    }
    return place;
}

BfrPlace makePlace(BasePoint const &point, PlanePlace const &place) {
    return {point, {{place.byU[0], place.byV[0]}, {place.byU[1], place.byV[1]}}};
}

} // namespace

PlanePlace FindInPlane(Bfr::Parameterization const &parameterization, Pair const &uv) {
    BasePolygon const polygon(parameterization.GetFaceSize());
    if (parameterization.GetType() == Bfr::Parameterization::QUAD) {
        return {uv, {1, 0}, {0, 1}};
    }
    if (parameterization.GetType() == Bfr::Parameterization::TRI) {
        // Of the third corner.
        double const height = polygon.GetCorner(2)[1] + polygon.GetCenter()[1];
        return {{uv[0] + 0.5 * uv[1], height * uv[1]}, {1, 0}, {0.5, height}};
    }
    // Bfr converts coordinates to integers, and has tiles up to the size of the face.
    double const farthest = polygon.GetSize();
    Pair const nearUv = {std::clamp(uv[0], -farthest, farthest),
                         std::clamp(uv[1], -farthest, farthest)};
    Pair subUv;
    int const subFace =
        parameterization.ConvertCoordToNormalizedSubFace(nearUv.data(), subUv.data());
    PlanePlace place = findInSubFace(polygon, subFace, subUv[0], subUv[1]);
    constexpr double kNormalization = 2; // sub-faces have half the width of a tile
    Pair const center = polygon.GetCenter();
    for (std::size_t i = 0; i < 2; ++i) {
        place.uv[i] += center[i];
        place.byU[i] *= kNormalization;
        place.byV[i] *= kNormalization;
    }
    return place;
}

BfrPlace FindBfrPlace(Bfr::Parameterization const &parameterization, Pair const &uv,
                      double tolerance) {
    PlanePlace const place = FindInPlane(parameterization, uv);
    return makePlace(
        FindBasePoint(parameterization.GetFaceSize(), place.uv[0], place.uv[1], tolerance), place);
}

BfrPlace MakeBfrEdgePlace(Bfr::Parameterization const &parameterization, int edge, int i, int n) {
    double const toEnd = double(i) / n;
    Pair uv;
    parameterization.GetEdgeCoord(edge, toEnd, uv.data());
    return makePlace(
        MakeBasePoint(parameterization.GetFaceSize(), edge, {double(n - i) / n, toEnd}),
        FindInPlane(parameterization, uv));
}

BfrPlace MoveToChild(BfrPlace const &place, CellStep const &step, int faceSize) {
    Pair const coords = step.Apply(place.point.coords);
    auto const &rows = step.map->rows;
    if (step.isChildWhole) {
        // By its own u and v, in which it is twice as large.
        Pair const &u = place.toOwn[0];
        Pair const &v = place.toOwn[1];
        return {MakeBasePoint(faceSize, place.point.sector, coords),
                {{2 * u[0], 2 * u[1]}, {2 * v[0], 2 * v[1]}}};
    }
    BfrPlace result = {{0, coords, {{1, 0}, {0, 1}}}, {}};
    for (std::size_t k = 0; k < 2; ++k) {
        Pair ofSector = {};
        for (std::size_t i = 0; i < 2; ++i) {
            Pair const &toCoords = place.point.toCoords[i];
            ofSector[i] = toCoords[0] * place.toOwn[0][k] + toCoords[1] * place.toOwn[1][k];
        }
        for (std::size_t i = 0; i < 2; ++i) {
            result.toOwn[i][k] = rows[i][0] * ofSector[0] + rows[i][1] * ofSector[1];
        }
    }
    return result;
}

} // namespace OpenSubdivHex::BfrExt::internal
