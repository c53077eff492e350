// SPDX-License-Identifier: Apache-2.0
#include "camera.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace OpenSubdivHex::Tools {

namespace {

constexpr float kDegree = 3.14159265f / 180;
constexpr float kFieldOfView = 24; // vertical, in degrees
constexpr float kFilled = 0.86f;   // part of the picture that the points fill

// A range of projected coordinates.
struct Extent {
    void Add(float value) {
        low = std::min(low, value);
        high = std::max(high, value);
    }

    float low = std::numeric_limits<float>::max();
    float high = std::numeric_limits<float>::lowest();
};

} // namespace

Camera::Camera(View view, std::vector<float> const &points, float aspect) {
    float const azimuth = view.azimuth * kDegree;
    float const elevation = view.elevation * kDegree;
    _back = {std::sin(azimuth) * std::cos(elevation), std::sin(elevation),
             std::cos(azimuth) * std::cos(elevation)};
    _right = {std::cos(azimuth), 0, -std::sin(azimuth)};
    _up = Cross(_back, _right);
    _height = 2 * std::tan(kFieldOfView / 2 * kDegree);
    _width = aspect * _height;

    // The points in the camera's axes.
    std::vector<Vec3> seen;
    Extent depth;
    float size = 0;
    for (int i = 0; i < int(points.size() / 3); ++i) {
        Vec3 const offset = GetVec3(points.data(), i) - GetVec3(points.data(), 0);
        seen.push_back({Dot(offset, _right), Dot(offset, _up), Dot(offset, _back)});
        depth.Add(seen.back().z);
        size = std::max(size, Length(offset));
    }

    // The further away, the smaller: bisect for the distance from which they fill the picture.
    Extent x, y;
    auto const project = [&](float distance) {
        x = y = Extent();
        for (Vec3 point : seen) {
            x.Add(point.x / (distance - point.z));
            y.Add(point.y / (distance - point.z));
        }
        float const filled = std::max((x.high - x.low) / _width, (y.high - y.low) / _height);
        return filled <= kFilled * view.zoom;
    };
    float near = depth.high + 0.01f * size;
    float far = depth.high + 1000 * std::max(size, 1e-6f);
    for (int i = 0; i < 40; ++i) {
        float const middle = (near + far) / 2;
        (project(middle) ? far : near) = middle;
    }
    project(far);
    _shiftX = (x.low + x.high) / 2;
    _shiftY = (y.low + y.high) / 2;
    _position = GetVec3(points.data(), 0) + far * _back;
}

Camera::Camera(Vec3 eye, Vec3 target, float fieldOfView, float aspect)
    : _position(eye), _back(Normalize(eye - target)),
      _height(2 * std::tan(fieldOfView / 2 * kDegree)) {
    // The direction up, unless the camera looks up or down.
    bool const isUpright = std::abs(_back.x) + std::abs(_back.z) > 0;
    _right = Normalize(Cross(isUpright ? Vec3{0, 1, 0} : Vec3{0, 0, -1}, _back));
    _up = Cross(_back, _right);
    _width = aspect * _height;
}

void Camera::Orbit(float degrees, Vec3 center) {
    _position = RotateAroundVertical(_position, degrees, center);
    for (Vec3 *axis : {&_right, &_up, &_back}) {
        *axis = RotateAroundVertical(*axis, degrees, Vec3());
    }
}

Vec3 Camera::GetDirection(float x, float y) const {
    return Normalize((_shiftX + (x - 0.5f) * _width) * _right +
                     (_shiftY + (0.5f - y) * _height) * _up - _back);
}

float Camera::GetPictureHeight(Vec3 point) const { return _height * Dot(_position - point, _back); }

Vec3 RotateAroundVertical(Vec3 point, float degrees, Vec3 center) {
    float const cosine = std::cos(degrees * kDegree);
    float const sine = std::sin(degrees * kDegree);
    Vec3 const offset = point - center;
    return center +
           Vec3{cosine * offset.x + sine * offset.z, offset.y, cosine * offset.z - sine * offset.x};
}

} // namespace OpenSubdivHex::Tools
