// SPDX-License-Identifier: Apache-2.0
//
// Places of faces for tests: ratesTest.cpp tests the conversions themselves.
#ifndef OPENSUBDIVHEX_REGRESSION_BFR_EXT_FACE_PLACES_H
#define OPENSUBDIVHEX_REGRESSION_BFR_EXT_FACE_PLACES_H

#include "bfr_ext/parameterization.h"
#include "far_ext/vtr/faceCoords.h"

#include <algorithm>
#include <array>
#include <vector>

namespace OpenSubdivHex::Regression {

using FacePlace = std::array<double, 2>;

/// (u, v) of the place that is so far from the centre of a face towards the start and the end of an edge.
inline FacePlace MakeFacePlace(int faceSize, int edge, double toStart, double toEnd) {
    return FarExt::internal::FindFaceCoords(BfrExt::Parameterization(faceSize),
                                            FarExt::internal::BasePolygon(faceSize), edge,
                                            {toStart, toEnd});
}

/// The place in the plane of the face of (u, v).
inline FacePlace ToPlane(int faceSize, double const uv[2]) {
    FacePlace result;
    BfrExt::Parameterization(faceSize).ConvertToPlane(uv, result.data());
    return result;
}

/// (u, v) of a place in the plane of the face, which is inside.
inline FacePlace FromPlane(int faceSize, FacePlace const &coords) {
    auto const getCorner = [&](int corner) {
        return ToPlane(faceSize, MakeFacePlace(faceSize, corner % faceSize, 1, 0).data());
    };
    FacePlace const center = FarExt::internal::BasePolygon(faceSize).GetCenter();
    auto const cross = [&](FacePlace const &a, FacePlace const &b) {
        return (a[0] - center[0]) * (b[1] - center[1]) - (a[1] - center[1]) * (b[0] - center[0]);
    };
    int best = 0;
    FacePlace inBest = {};
    for (int edge = 0; edge < faceSize; ++edge) {
        FacePlace const start = getCorner(edge);
        FacePlace const end = getCorner(edge + 1);
        double const whole = cross(start, end);
        FacePlace const inSector = {cross(coords, end) / whole, cross(start, coords) / whole};
        if (edge == 0 || std::min(inSector[0], inSector[1]) > std::min(inBest[0], inBest[1])) {
            best = edge;
            inBest = inSector;
        }
    }
    return MakeFacePlace(faceSize, best, std::max(inBest[0], 0.0), std::max(inBest[1], 0.0));
}

/// Overload for many places.
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
