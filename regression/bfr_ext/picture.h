// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_REGRESSION_BFR_EXT_PICTURE_H
#define OPENSUBDIVHEX_REGRESSION_BFR_EXT_PICTURE_H

#include "surfaceFixture.h"

#include "bfr_ext/view.h"

#include <array>
#include <cmath>
#include <limits>

namespace OpenSubdivHex::Regression {

/// A camera's picture, by its definition.
struct Picture {
    explicit Picture(BfrExt::Camera const &camera) : _camera(camera), _eye(ToVector(camera.eye)) {
        _forward = Normalize(Subtract(ToVector(camera.target), _eye));
        _right = Normalize(Cross(_forward, ToVector(camera.up)));
        _up = Cross(_right, _forward);
    }

    /// Pixels to the right of the middle and above it; infinite behind the eye.
    std::array<double, 2> Project(Vector3 const &p) const {
        Vector3 const d = Subtract(p, _eye);
        double const depth = Dot(d, _forward);
        double const pixels = _camera.height / 2.0 / std::tan(_camera.fieldOfView * M_PI / 360);
        double const infinite = std::numeric_limits<double>::infinity();
        return depth > 0 ? std::array<double, 2>{pixels * Dot(d, _right) / depth,
                                                 pixels * Dot(d, _up) / depth}
                         : std::array<double, 2>{infinite, infinite};
    }
    bool HasPoint(Vector3 const &p) const {
        std::array<double, 2> const at = Project(p);
        return std::abs(at[0]) < _camera.width / 2.0 && std::abs(at[1]) < _camera.height / 2.0;
    }
    double GetDistance(Vector3 const &p, Vector3 const &q) const {
        std::array<double, 2> const a = Project(p);
        std::array<double, 2> const b = Project(q);
        return std::hypot(a[0] - b[0], a[1] - b[1]);
    }

private:
    BfrExt::Camera _camera;
    Vector3 _eye;
    Vector3 _forward = {};
    Vector3 _right = {};
    Vector3 _up = {};
};

} // namespace OpenSubdivHex::Regression

#endif
