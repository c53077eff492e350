// SPDX-License-Identifier: Apache-2.0
//
// Places on the control mesh, as places of surfaces.
#include "surfaceFactory.h"

#include "far_ext/vtr/faceCoords.h"
#include "far_ext/vtr/report.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace OpenSubdivHex::BfrExt {

using Far::Index;
using FarExt::CallStatus;
using FarExt::ComponentType;
using FarExt::StatusCode;

namespace {

using FarExt::internal::BasePolygon;

/// A point in the plane of a face, from its centre.
using PlanePoint = BasePolygon::Pair;

/// Triangles with an apex, in which a place has weights of the second and the third corner.
struct PlaneTriangle {
    PlanePoint FindWeights(PlanePoint const &point) const {
        PlanePoint const a = {second[0] - apex[0], second[1] - apex[1]};
        PlanePoint const b = {third[0] - apex[0], third[1] - apex[1]};
        PlanePoint const p = {point[0] - apex[0], point[1] - apex[1]};
        double const area = a[0] * b[1] - a[1] * b[0];
        return {(p[0] * b[1] - p[1] * b[0]) / area, (a[0] * p[1] - a[1] * p[0]) / area};
    }
    PlanePoint Apply(PlanePoint const &weights) const {
        PlanePoint point = apex;
        for (std::size_t k = 0; k < 2; ++k) {
            point[k] += weights[0] * (second[k] - apex[k]) + weights[1] * (third[k] - apex[k]);
        }
        return point;
    }

    PlanePoint apex;
    PlanePoint second;
    PlanePoint third;
};

/// \brief A place of a face that is truncated: in the triangle that a corner of its F-face and the next one make with the
/// centre or with a vertex of the face.
struct TruncatedPlace {
    int corner; ///< of the F-face
    bool isAtVertex;
    PlanePoint weights; ///< of the corner and the next one
};

TruncatedPlace findTruncatedPlace(BasePolygon const &face, PlanePoint const &point) {
    int const size = face.GetSize();
    // Truncation cuts edges at a third of their length.
    auto const getCut = [&](int vertex, int other) -> PlanePoint {
        PlanePoint const a = face.GetCorner(vertex);
        PlanePoint const b = face.GetCorner(other % size);
        return {(2 * a[0] + b[0]) / 3, (2 * a[1] + b[1]) / 3};
    };
    std::vector<PlanePoint> corners; // of the F-face
    for (int i = 0; i < size; ++i) {
        corners.push_back(getCut(i, i + size - 1));
        corners.push_back(getCut(i, i + 1));
        PlanePoint const weights =
            PlaneTriangle{face.GetCorner(i), corners.end()[-2], corners.end()[-1]}.FindWeights(
                point);
        if (weights[0] + weights[1] < 1) {
            return {2 * i, true, weights};
        }
    }
    TruncatedPlace best = {0, false, {}};
    double bestWeight = 0;
    for (int i = 0; i < 2 * size; ++i) {
        PlanePoint const weights =
            PlaneTriangle{{}, corners[std::size_t(i)], corners[std::size_t((i + 1) % (2 * size))]}
                .FindWeights(point);
        double const least = std::min(weights[0], weights[1]);
        if (i == 0 || least > bestWeight) {
            bestWeight = least;
            best = {i, false, weights};
        }
    }
    return best;
}

} // namespace

template <typename REAL>
bool SurfaceFactory::FindSurfacePlace(Index controlFace, REAL const controlUv[2], Index *face,
                                      REAL uv[2], CallStatus *status) const {
    FarExt::TopologyLevel const &control = _refiner.GetLevel(0);
    CallStatus result;
    if (controlFace < 0 || controlFace >= control.GetNumFaces()) {
        result = CallStatus(StatusCode::InvalidArgument, ComponentType::Face, controlFace,
                            "face " + std::to_string(controlFace) + " is not one of the " +
                                std::to_string(control.GetNumFaces()) + " faces of level 0");
    } else if (_refiner.GetHexSchemeOptions().firstStep == FarExt::FirstStep::TriHex) {
        result = CallStatus(StatusCode::Unsupported, ComponentType::NoComponent, Far::INDEX_INVALID,
                            "places on the control mesh are not found behind FirstStep::TriHex");
    } else if (hasRefinedAgain()) {
        result = checkIsFace(0);
    } else if (!std::isfinite(controlUv[0]) || !std::isfinite(controlUv[1])) {
        result = CallStatus(StatusCode::InvalidArgument, ComponentType::Face, controlFace,
                            "u and v are not finite, in face " + std::to_string(controlFace) +
                                " of level 0");
    }
    if (!FarExt::internal::Report(result, status)) {
        return false;
    }
    if (_level.GetDepth() == 0) {
        *face = controlFace;
        std::copy_n(controlUv, 2, uv);
        return true;
    }
    FarExt::FaceShape const shape(control.GetFaceVertices(controlFace).size());
    BasePolygon const ofControl(shape);
    PlanePoint point =
        FarExt::internal::FindInPlane(Parameterization(shape), {controlUv[0], controlUv[1]}).coords;
    PlanePoint const center = ofControl.GetCenter();
    TruncatedPlace const place =
        findTruncatedPlace(ofControl, {point[0] - center[0], point[1] - center[1]});

    // The surface face on this side of the corner's edge, or beyond it, where the edge runs the other way.
    FarExt::SurfaceFaces::Side side = _faces.GetSideOfPlace(controlFace, place.corner);
    Index const edge = _faces.GetEdge(side.face, side.local).edge;
    if (place.isAtVertex) {
        FarExt::SurfaceFaces::Side const first = _faces.GetSide(edge, 0);
        side = first.face == side.face ? _faces.GetSide(edge, 1) : first;
    }
    BasePolygon const ofSurface(_faces.GetShape(side.face));
    int const size = ofSurface.GetSize();
    PlaneTriangle triangle = {
        {}, ofSurface.GetCorner(side.local), ofSurface.GetCorner((side.local + 1) % size)};
    if (place.isAtVertex) {
        std::swap(triangle.second, triangle.third);
        // The vertex is the centre of its face, unless it is kept.
        Index const kept =
            control.GetVertexChildVertex(control.GetFaceVertices(controlFace)[place.corner / 2]);
        for (int i = 0; i < size; ++i) {
            if (_faces.GetVertex(side.face, i) == kept) {
                triangle.apex = ofSurface.GetCorner(i);
            }
        }
    }
    point = triangle.Apply(place.weights);
    point = {point[0] + ofSurface.GetCenter()[0], point[1] + ofSurface.GetCenter()[1]};
    GetFaceParameterization(side.face).ConvertFromPlane(point.data(), point.data());
    *face = side.face;
    uv[0] = REAL(point[0]);
    uv[1] = REAL(point[1]);
    return true;
}

template bool SurfaceFactory::FindSurfacePlace(Index, float const[2], Index *, float[2],
                                               CallStatus *) const;
template bool SurfaceFactory::FindSurfacePlace(Index, double const[2], Index *, double[2],
                                               CallStatus *) const;

} // namespace OpenSubdivHex::BfrExt
