// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_TOOLS_HEXVIEW_ANIMATION_H
#define OPENSUBDIVHEX_TOOLS_HEXVIEW_ANIMATION_H

#include "surfacePainter.h"

#include <cmath>
#include <vector>

namespace OpenSubdivHex::Tools {

/// \brief Twists points around the vertical axis: by \p angle for a height of the size of what the camera
/// goes around.
///
/// \param angle  radians
/// \return  the points, x y z each
inline std::vector<float> TwistPoints(std::vector<float> points, OrbitCamera const &camera,
                                      float angle) {
    for (std::size_t i = 0; i + 2 < points.size(); i += 3) {
        float const x = points[i] - camera.center.x;
        float const z = points[i + 2] - camera.center.z;
        float const turn = angle * (points[i + 1] - camera.center.y) / camera.size;
        points[i] = camera.center.x + x * std::cos(turn) + z * std::sin(turn);
        points[i + 2] = camera.center.z - x * std::sin(turn) + z * std::cos(turn);
    }
    return points;
}

} // namespace OpenSubdivHex::Tools

#endif
