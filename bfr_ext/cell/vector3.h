// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_BFR_EXT_CELL_VECTOR3_H
#define OPENSUBDIVHEX_BFR_EXT_CELL_VECTOR3_H

#include <array>
#include <cmath>
#include <cstddef>
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

/// Twice the area of a polygon along its normal, from its corners, three numbers each.
inline Vector3 FindArea(std::vector<double> const &corners) {
    Vector3 const origin = ToVector3(corners.data());
    Vector3 area = {};
    for (std::size_t i = 3; i + 3 < corners.size(); i += 3) {
        area = Add(area, Cross(Subtract(ToVector3(&corners[i]), origin),
                               Subtract(ToVector3(&corners[i + 3]), origin)));
    }
    return area;
}

} // namespace OpenSubdivHex::BfrExt::internal

#endif
