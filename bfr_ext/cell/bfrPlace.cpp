// SPDX-License-Identifier: Apache-2.0
#include "bfrPlace.h"

namespace OpenSubdivHex::BfrExt::internal {

using FarExt::internal::FindInPlane;

namespace {

BfrPlace makePlace(BasePoint const &point, PlanePlace const &place) {
    return {point, {{place.byU[0], place.byV[0]}, {place.byU[1], place.byV[1]}}, place.byUv};
}

} // namespace

BfrPlace FindInSubFaces(Bfr::Parameterization const &parameterization, FaceShape shape,
                        Pair const &uv, double tolerance) {
    PlanePlace const place = FindInPlane(parameterization, uv);
    return makePlace(FindBasePoint(shape, place.coords[0], place.coords[1], tolerance), place);
}

BfrPlace MakeBfrEdgePlace(Bfr::Parameterization const &parameterization, FaceShape shape, int edge,
                          int i, int n) {
    double const toEnd = double(i) / n;
    Pair uv;
    parameterization.GetEdgeCoord(edge, toEnd, uv.data());
    SectorPlace<Pair> place = PlaceOnEdge<Pair>(shape, edge, double(n - i) / n, toEnd);
    if (place.coords[0] < 0) {
        place = NameOf(shape, place);
    }
    return makePlace(MakeBasePoint(shape, place.sector, place.coords),
                     FindInPlane(parameterization, uv));
}

BfrPlace MoveToChild(BfrPlace const &place, CellStep const &step, FaceShape shape) {
    Pair const coords = step.Apply(place.point.coords);
    if (step.isChildWhole) {
        // By its own u and v, in which it is twice as large.
        Pair const &u = place.toOwn[0];
        Pair const &v = place.toOwn[1];
        return {MakeBasePoint(shape, place.point.sector, coords),
                {{2 * u[0], 2 * u[1]}, {2 * v[0], 2 * v[1]}},
                {}};
    }
    BfrPlace result = {{0, coords, {{1, 0}, {0, 1}}}, {}, {}};
    Multiply(place.point.toCoords, place.toOwn, result.toOwn);
    Multiply(step.map->rows, result.toOwn, result.toOwn);
    return result;
}

} // namespace OpenSubdivHex::BfrExt::internal
