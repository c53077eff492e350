// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_TOOLS_POINT_H
#define OPENSUBDIVHEX_TOOLS_POINT_H

#include "mesh.h"

#include <cmath>

namespace OpenSubdivHex::Tools {

/// A position as primvar refiners and Far::StencilTable::UpdateValues take it.
struct Point {
    void Clear() { x = y = z = 0; }
    void AddWithWeight(Point const &source, float weight) {
        x += weight * source.x;
        y += weight * source.y;
        z += weight * source.z;
    }

    float x, y, z;
};

inline float ComputeDistance(Point const &a, Point const &b) {
    return std::hypot(a.x - b.x, a.y - b.y, a.z - b.z);
}

inline std::vector<Point> CopyPoints(Mesh const &mesh) {
    std::vector<Point> points;
    for (std::size_t i = 0; i < mesh.positions.size(); i += 3) {
        points.push_back({mesh.positions[i], mesh.positions[i + 1], mesh.positions[i + 2]});
    }
    return points;
}

} // namespace OpenSubdivHex::Tools

#endif
