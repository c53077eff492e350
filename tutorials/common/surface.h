// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_TUTORIALS_SURFACE_H
#define OPENSUBDIVHEX_TUTORIALS_SURFACE_H

#include "far_ext/topologyLevel.h"
#include "osd_ext/triangleIndices.h"
#include "vec3.h"

#include <vector>

namespace OpenSubdivHex::Tutorials {

/// \brief The faces of a level with positions and normals, ready to be ray traced.
///
/// The topology is set up once; positions may change from frame to frame.
class Surface {
public:
    /// \p level must outlive the surface.
    explicit Surface(FarExt::TopologyLevel const &level);

    /// \param positions  x y z of each vertex of the level; copied
    void SetPositions(float const *positions);

    OsdExt::TriangleIndices const &GetTriangles() const { return _triangles; }
    std::vector<float> const &GetPositions() const { return _positions; }

    /// The vertex normals, interpolated at the barycentric coordinates \p u and \p v of a triangle.
    Vec3 GetSmoothNormal(int triangle, float u, float v) const;
    /// The normal of the polygon that the triangle is a part of, by Newell's formula.
    Vec3 GetFlatNormal(int triangle) const;
    /// Number of sides of the polygon that the triangle is a part of.
    int GetFaceSize(int triangle) const;
    /// Distance of \p point from the edges of the polygon that the triangle is a part of; the
    /// triangle's own other edges do not count.
    float GetEdgeDistance(int triangle, Vec3 point) const;

private:
    FarExt::TopologyLevel const &_level;
    OsdExt::TriangleIndices const _triangles;
    std::vector<float> _positions;
    std::vector<Vec3> _faceNormals;
    std::vector<Vec3> _vertexNormals;
};

} // namespace OpenSubdivHex::Tutorials

#endif
