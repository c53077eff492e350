// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_TOOLS_SURFACE_H
#define OPENSUBDIVHEX_TOOLS_SURFACE_H

#include "far_ext/stencilTableFactory.h"
#include "osd_ext/polygonIndices.h"
#include "vec3.h"

#include <vector>

namespace OpenSubdivHex::Tools {

/// \brief The faces of a level with positions and normals, ready to be ray traced.
///
/// The topology is set up once; positions may change from frame to frame.
class Surface {
public:
    /// \p level must outlive the surface, and has full topology.  Triangles lie in one base face each
    /// when \p cutsBaseFaces, else those of a hexagon may lie across two.
    explicit Surface(FarExt::TopologyLevel const &level, bool cutsBaseFaces = false);

    /// The sides of the level's vertices: where normals are asked for.
    FarExt::LimitSides const &GetSides() const { return _sides; }

    /// \param positions  x y z of each vertex of the level; copied
    /// \param du, dv     x y z of the derivatives on each of GetSides(): the normals are theirs.
    ///                   Null for those of the polygons: the mean on each side of a vertex
    void SetPositions(float const *positions, float const *du = nullptr, float const *dv = nullptr);

    OsdExt::TriangleIndices const &GetTriangles() const { return _triangles; }
    std::vector<float> const &GetPositions() const { return _positions; }

    /// The normals at the corners, interpolated at the barycentric coordinates \p u and \p v of a
    /// triangle.
    Vec3 GetSmoothNormal(int triangle, float u, float v) const;
    /// The normal of the polygon that the triangle is a part of, by Newell's formula: of the half, where
    /// an infinitely sharp crease crosses a hexagon.
    Vec3 GetFlatNormal(int triangle) const;
    /// The face of the control mesh that the triangle lies in.
    int GetBaseFace(int triangle) const { return _triangles.baseFaces[triangle]; }
    /// Number of sides of the polygon that the triangle is a part of.
    int GetFaceSize(int triangle) const;
    /// Distance of \p point from the edges of the polygon that the triangle is a part of; the
    /// triangle's own other edges do not count.
    float GetEdgeDistance(int triangle, Vec3 point) const;

private:
    void findTrianglePolygons();
    void findPolygonNormals();

    FarExt::TopologyLevel const &_level;
    FarExt::LimitSides const _sides;
    OsdExt::TriangleIndices const _triangles;
    OsdExt::PolygonIndices const
        _polygons; ///< what has one normal: holes, too, cut along creases alone
    std::vector<int> _trianglePolygons; ///< by triangle
    std::vector<float> _positions;
    std::vector<Vec3> _polygonNormals;
    std::vector<Vec3> _normals; ///< by side
};

} // namespace OpenSubdivHex::Tools

#endif
