// SPDX-License-Identifier: Apache-2.0
//
// Places on the control mesh, as places of surfaces.
#include "surfaceFactory.h"

#include "far_ext/status.h"

#include <algorithm>
#include <array>
#include <string>
#include <vector>

namespace OpenSubdivHex::BfrExt {

using Far::Index;
using FarExt::CallStatus;
using FarExt::ComponentType;
using FarExt::StatusCode;

namespace {

/// A point, or a difference of two, in the plane of a face.
using PlanePoint = std::array<double, 2>;

PlanePoint subtractPlanePoints(PlanePoint const &a, PlanePoint const &b) {
    return {a[0] - b[0], a[1] - b[1]};
}

PlanePoint mixPlanePoints(PlanePoint const &a, PlanePoint const &b, double t) {
    return {a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])};
}

/// A triangle, whose first corner is its apex.
struct PlaneTriangle {
    /// The weights of the second and the third corner that make a point.
    PlanePoint FindWeights(PlanePoint const &point) const {
        PlanePoint const a = subtractPlanePoints(second, apex);
        PlanePoint const b = subtractPlanePoints(third, apex);
        PlanePoint const p = subtractPlanePoints(point, apex);
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

PlanePoint getPlaneVertex(Parameterization const &face, int vertex) {
    PlanePoint point;
    face.GetVertexCoord(vertex, point.data());
    face.ConvertToPlane(point.data(), point.data());
    return point;
}

/// The centre of a face, of half a polygon the middle of its long edge.
PlanePoint getPlaneCenter(Parameterization const &face) {
    if (face.GetFaceShape().isHalf) {
        return mixPlanePoints(getPlaneVertex(face, 0), getPlaneVertex(face, 1), 0.5);
    }
    PlanePoint point;
    face.GetCenterCoord(point.data());
    face.ConvertToPlane(point.data(), point.data());
    return point;
}

/// \brief A place of a face that is truncated: in the triangle that a corner of its F-face and the next one make with the
/// centre or with a vertex of the face.
struct TruncatedPlace {
    int corner; ///< of the F-face
    bool isAtVertex;
    PlanePoint weights; ///< of the corner and the next one
};

TruncatedPlace findTruncatedPlace(Parameterization const &face, PlanePoint const &point) {
    // Truncation cuts edges at a third of their length.
    constexpr double kCut = 1.0 / 3;
    int const size = face.GetFaceSize();
    std::vector<PlanePoint> corners; // of the F-face
    for (int i = 0; i < size; ++i) {
        PlanePoint const vertex = getPlaneVertex(face, i);
        corners.push_back(
            mixPlanePoints(vertex, getPlaneVertex(face, (i + size - 1) % size), kCut));
        corners.push_back(mixPlanePoints(vertex, getPlaneVertex(face, (i + 1) % size), kCut));
        PlaneTriangle const cutOff = {vertex, corners.end()[-2], corners.end()[-1]};
        PlanePoint const weights = cutOff.FindWeights(point);
        if (weights[0] + weights[1] < 1) {
            return {2 * i, true, weights};
        }
    }
    TruncatedPlace best = {0, false, {}};
    double bestWeight = 0;
    for (int i = 0; i < 2 * size; ++i) {
        PlaneTriangle const sector = {getPlaneCenter(face), corners[std::size_t(i)],
                                      corners[std::size_t((i + 1) % (2 * size))]};
        PlanePoint const weights = sector.FindWeights(point);
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
    }
    bool const isOk = result.IsOk();
    if (status) {
        *status = std::move(result);
    }
    if (!isOk) {
        return false;
    }
    if (_level.GetDepth() == 0) {
        *face = controlFace;
        std::copy_n(controlUv, 2, uv);
        return true;
    }
    Parameterization const ofControl(
        FarExt::FaceShape(control.GetFaceVertices(controlFace).size()));
    PlanePoint point = {controlUv[0], controlUv[1]};
    ofControl.ConvertToPlane(point.data(), point.data());
    TruncatedPlace const place = findTruncatedPlace(ofControl, point);

    // The surface face on this side of the corner's edge, or beyond it, where the edge runs the other way.
    FarExt::SurfaceFaces::Side side = _faces.GetSideOfPlace(controlFace, place.corner);
    Index const edge = _faces.GetEdge(side.face, side.local).edge;
    if (place.isAtVertex) {
        FarExt::SurfaceFaces::Side const first = _faces.GetSide(edge, 0);
        side = first.face == side.face ? _faces.GetSide(edge, 1) : first;
    }
    Parameterization const ofSurface = GetFaceParameterization(side.face);
    int const size = ofSurface.GetFaceSize();
    PlaneTriangle triangle = {getPlaneCenter(ofSurface), getPlaneVertex(ofSurface, side.local),
                              getPlaneVertex(ofSurface, (side.local + 1) % size)};
    if (place.isAtVertex) {
        std::swap(triangle.second, triangle.third);
        // The vertex is the centre of its face, unless it is kept.
        Index const kept =
            control.GetVertexChildVertex(control.GetFaceVertices(controlFace)[place.corner / 2]);
        for (int i = 0; i < size; ++i) {
            if (_faces.GetVertex(side.face, i) == kept) {
                triangle.apex = getPlaneVertex(ofSurface, i);
            }
        }
    }
    point = triangle.Apply(place.weights);
    ofSurface.ConvertFromPlane(point.data(), point.data());
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
