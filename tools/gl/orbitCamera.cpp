// SPDX-License-Identifier: Apache-2.0
#include "orbitCamera.h"

#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace OpenSubdivHex::Tools {

namespace {

constexpr float kFieldOfView = 35; // degrees, of the height

// Radians, of the height: a picture that is higher than wide sees as much of the width.
float findFieldOfView(float aspect) {
    return 2 * std::atan(std::tan(glm::radians(kFieldOfView / 2)) / std::min(aspect, 1.0f));
}

} // namespace

OrbitCamera OrbitCamera::Around(std::vector<float> const &points) {
    constexpr float kLarge = std::numeric_limits<float>::max();
    glm::vec3 low(kLarge);
    glm::vec3 high(-kLarge);
    for (std::size_t i = 0; i + 2 < points.size(); i += 3) {
        glm::vec3 const point(points[i], points[i + 1], points[i + 2]);
        low = glm::min(low, point);
        high = glm::max(high, point);
    }
    OrbitCamera camera;
    camera.center = low + 0.5f * (high - low);
    camera.size = std::numeric_limits<float>::min();
    for (std::size_t i = 0; i + 2 < points.size(); i += 3) {
        camera.size =
            std::max(camera.size, glm::length(glm::vec3(points[i], points[i + 1], points[i + 2]) -
                                              camera.center));
    }
    return camera;
}

glm::vec3 OrbitCamera::GetEye() const {
    float const turn = glm::radians(azimuth);
    float const rise = glm::radians(elevation);
    glm::vec3 const direction(std::sin(turn) * std::cos(rise), std::sin(rise),
                              std::cos(turn) * std::cos(rise));
    return center + size * distance / std::sin(glm::radians(kFieldOfView / 2)) * direction;
}

glm::vec3 OrbitCamera::GetUp() const {
    glm::vec3 const back = glm::normalize(GetEye() - center);
    return glm::normalize(glm::vec3(0, 1, 0) - back.y * back);
}

glm::mat4 OrbitCamera::GetView() const { return glm::lookAt(GetEye(), center, GetUp()); }

glm::mat4 OrbitCamera::GetLens(float aspect) const {
    float const eyeDistance = glm::length(GetEye() - center);
    float const nearest = std::max(eyeDistance - 2 * size, 0.01f * eyeDistance);
    return glm::perspective(findFieldOfView(aspect), aspect, nearest, eyeDistance + 2 * size);
}

BfrExt::Camera OrbitCamera::ForPicture(int width, int height) const {
    BfrExt::Camera camera;
    for (int k = 0; k < 3; ++k) {
        camera.eye[k] = double(GetEye()[k]);
        camera.target[k] = double(center[k]);
    }
    camera.fieldOfView =
        double(glm::degrees(findFieldOfView(float(width) / float(std::max(height, 1)))));
    camera.width = width;
    camera.height = height;
    return camera;
}

} // namespace OpenSubdivHex::Tools
