// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_TOOLS_GL_ORBIT_CAMERA_H
#define OPENSUBDIVHEX_TOOLS_GL_ORBIT_CAMERA_H

#include "bfr_ext/view.h"

#include <glm/glm.hpp>

#include <vector>

namespace OpenSubdivHex::Tools {

/// \brief A perspective camera that goes around a point, with y up.
struct OrbitCamera {
    /// Sees all \p points, of which there is one at least.
    static OrbitCamera Around(std::vector<float> const &points);

    glm::vec3 GetEye() const;
    glm::vec3 GetUp() const;
    /// From space to the cube that OpenGL draws.
    glm::mat4 GetProjection(float aspect) const { return GetLens(aspect) * GetView(); }
    /// From space to that of the eye, and from there on.
    glm::mat4 GetView() const;
    glm::mat4 GetLens(float aspect) const; ///< \copydoc GetView()
    /// Returns this camera for a picture of \p width x \p height pixels.
    BfrExt::Camera ForPicture(int width, int height) const;

    glm::vec3 center{0};
    float size = 1; ///< radius of what is seen
    float azimuth = 30;
    float elevation = 20;
    float distance = 1; ///< 1 sees all
};

} // namespace OpenSubdivHex::Tools

#endif
