// SPDX-License-Identifier: Apache-2.0
//
// Places of faces for tests: ratesTest.cpp tests the conversions themselves.
#ifndef OPENSUBDIVHEX_REGRESSION_BFR_EXT_FACE_PLACES_H
#define OPENSUBDIVHEX_REGRESSION_BFR_EXT_FACE_PLACES_H

#include "bfr_ext/cell/cellStencil.h"
#include "bfr_ext/parameterization.h"
#include "far_ext/vtr/faceCoords.h"

#include <array>
#include <vector>

namespace OpenSubdivHex::Regression {

using FacePlace = std::array<double, 2>;

/// (u, v) of the place that is so far from the centre of a face towards the start and the end of an edge.
inline FacePlace MakeFacePlace(int faceSize, int edge, double toStart, double toEnd) {
    return FarExt::internal::FindFaceCoords(faceSize, edge, {toStart, toEnd});
}

/// Those of a place in the plane of the face, which is inside.
inline FacePlace FromPlane(int faceSize, FacePlace const &coords) {
    BfrExt::internal::BasePoint const point =
        BfrExt::internal::FindBasePoint(faceSize, coords[0], coords[1], 0);
    return MakeFacePlace(faceSize, point.sector, point.coords[0], point.coords[1]);
}

/// The place in the plane of the face of (u, v).
inline FacePlace ToPlane(int faceSize, double const uv[2]) {
    return FarExt::internal::FindInPlane(BfrExt::Parameterization(faceSize), {uv[0], uv[1]}).coords;
}

/// The same of many.
inline std::vector<double> ToPlane(int faceSize, std::vector<double> coords) {
    for (std::size_t i = 0; i < coords.size(); i += 2) {
        FacePlace const place = ToPlane(faceSize, &coords[i]);
        coords[i] = place[0];
        coords[i + 1] = place[1];
    }
    return coords;
}

} // namespace OpenSubdivHex::Regression

#endif
