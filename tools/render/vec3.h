// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_TOOLS_VEC3_H
#define OPENSUBDIVHEX_TOOLS_VEC3_H

#include <cmath>
#include <cstddef>

namespace OpenSubdivHex::Tools {

/// A point, direction or colour.
struct Vec3 {
    float x = 0, y = 0, z = 0;
};

inline Vec3 operator+(Vec3 a, Vec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Vec3 operator-(Vec3 a, Vec3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Vec3 operator-(Vec3 a) { return {-a.x, -a.y, -a.z}; }
inline Vec3 operator*(Vec3 a, Vec3 b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }
inline Vec3 operator*(float s, Vec3 a) { return {s * a.x, s * a.y, s * a.z}; }

inline float Dot(Vec3 a, Vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Vec3 Cross(Vec3 a, Vec3 b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline float Length(Vec3 a) { return std::sqrt(Dot(a, a)); }
/// The zero vector stays as it is.
inline Vec3 Normalize(Vec3 a) {
    float const length = Length(a);
    return length > 0 ? (1 / length) * a : a;
}
inline Vec3 Mix(Vec3 a, Vec3 b, float t) { return (1 - t) * a + t * b; }

/// 0 up to \p low, 1 from \p high on.
inline float SmoothStep(float low, float high, float x) {
    float const t = std::fmin(std::fmax((x - low) / (high - low), 0.0f), 1.0f);
    return t * t * (3 - 2 * t);
}

/// Point \p i of an array x y z x y z ...
inline Vec3 GetVec3(float const *values, int i) {
    values += 3 * std::ptrdiff_t(i);
    return {values[0], values[1], values[2]};
}

} // namespace OpenSubdivHex::Tools

#endif
