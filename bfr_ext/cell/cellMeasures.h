// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_BFR_EXT_CELL_CELL_MEASURES_H
#define OPENSUBDIVHEX_BFR_EXT_CELL_CELL_MEASURES_H

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

namespace OpenSubdivHex::BfrExt::internal {

/// \brief A point or a direction in space, for what cells look like in a view.
using Vector3 = std::array<double, 3>;

inline Vector3 ToVector3(double const *p) { return {p[0], p[1], p[2]}; }
inline Vector3 Add(Vector3 const &a, Vector3 const &b) {
    return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
inline Vector3 Subtract(Vector3 const &a, Vector3 const &b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
inline Vector3 Scale(Vector3 const &a, double s) { return {a[0] * s, a[1] * s, a[2] * s}; }
inline double Dot(Vector3 const &a, Vector3 const &b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline double GetLength(Vector3 const &a) { return std::sqrt(Dot(a, a)); }
inline Vector3 Cross(Vector3 const &a, Vector3 const &b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// A ball that encloses some points.
struct Ball {
    Vector3 center = {};
    double radius = 0;
};

/// \brief Measures of a cell that do not depend on the camera, as far as views have asked for them.
struct CellMeasures {
    /// A ball that holds the surface also where long sides bend between samples, in the plane of the corners.
    Ball GetOuterBall() const {
        constexpr double kMargin = 1.2;
        return {ball.center, kMargin * ball.radius};
    }

    Ball ball;               ///< around the surface, estimated
    double longestSide = -1; ///< between corners; -1: not measured
    double thickness =
        -1; ///< range of the heights over the plane of the corners, estimated; -1: not measured
    double childThickness =
        0;              ///< what is expected of its children, where these are not measured with it
    int firstChild = 0; ///< in the same face; 0: none were asked for
    int facing = -1;    ///< in the same face; -1: not found
};

/// \brief Where a cell faces, estimated from the polygons of the corners of the cells that one or two steps make of it, by
/// their normals at each corner, and from the normals of the surface at its own corners.
///
/// With m the unit normal of all, others are m + s w, with w of length 1 at most in the plane across from it.  With c the
/// mean of the places and r how far they are from it, (m + s w) . (eye - p) is at most m . (eye - c) - m . (p - c) +
/// s (|part of eye - c in the plane| + r).
struct CellFacing {
    bool IsBackFacing(Vector3 const &eye) const {
        Vector3 const toEye = Subtract(eye, center);
        double const height = Dot(normal, toEye);
        double const across = GetLength(Subtract(toEye, Scale(normal, height)));
        return height + depth + spread * (across + radius) < 0;
    }

    Vector3 normal = {};
    double spread = std::numeric_limits<double>::infinity(); ///< s; infinite where nothing is known
    Vector3 center = {};
    double radius = 0; ///< r
    double depth = 0;  ///< of places below the center, along the normal
};

/// \brief Measures of the cells of a base face that views have asked for: first the face itself; the
/// children of a cell are consecutive.
struct FaceMeasures {
    void Clear() {
        cells.clear();
        facings.clear();
    }
    /// Memory, in bytes.
    std::size_t GetMemory() const {
        return cells.capacity() * sizeof(CellMeasures) + facings.capacity() * sizeof(CellFacing);
    }

    std::vector<CellMeasures> cells;
    std::vector<CellFacing> facings;
};

} // namespace OpenSubdivHex::BfrExt::internal

#endif
