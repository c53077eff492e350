// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_TOOLS_CAMERA_H
#define OPENSUBDIVHEX_TOOLS_CAMERA_H

#include "vec3.h"

#include <vector>

namespace OpenSubdivHex::Tools {

/// \brief Where a camera looks from, with y up.
struct View {
    float azimuth = 30;   ///< degrees around y, from the z axis towards the x axis
    float elevation = 20; ///< degrees above the horizon
    float zoom = 1;       ///< 1: the picture is filled, but for a margin
};

/// \brief A pinhole camera with a shifted image plane, as an architect's.
class Camera {
public:
    /// \brief A camera that sees all \p points in the middle of a picture.
    ///
    /// \param points  x y z of each point; at least one
    /// \param aspect  width of the picture by its height
    Camera(View view, std::vector<float> const &points, float aspect);

    /// \brief A camera at \p eye with \p target in the middle of the picture.
    ///
    /// \param fieldOfView  degrees, of the height of the picture
    /// \param aspect       width of the picture by its height
    Camera(Vec3 eye, Vec3 target, float fieldOfView, float aspect);

    /// Turns the camera around the vertical axis through \p center.
    void Orbit(float degrees, Vec3 center);

    Vec3 GetPosition() const { return _position; }
    /// The camera's x axis, horizontal.
    Vec3 GetRight() const { return _right; }
    /// The camera's y axis.
    Vec3 GetUp() const { return _up; }
    /// Unit direction of the ray through a place in the picture: (0, 0) is the upper left corner,
    /// (1, 1) the lower right.
    Vec3 GetDirection(float x, float y) const;
    /// Height of the picture, measured in a plane through \p point.
    float GetPictureHeight(Vec3 point) const;

private:
    Vec3 _position;
    Vec3 _right;
    Vec3 _up;
    Vec3 _back;
    float _width = 0; ///< of the image plane, at distance 1
    float _height = 0;
    float _shiftX = 0;
    float _shiftY = 0;
};

/// \p point turned around the vertical axis through \p center, from the z axis towards the x axis.
Vec3 RotateAroundVertical(Vec3 point, float degrees, Vec3 center);

} // namespace OpenSubdivHex::Tools

#endif
