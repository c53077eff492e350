// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_BFR_EXT_PARAMETERIZATION_H
#define OPENSUBDIVHEX_BFR_EXT_PARAMETERIZATION_H

#include "far_ext/export.h"
#include "far_ext/indexing.h"

#include <opensubdiv/bfr/parameterization.h>

namespace OpenSubdivHex::BfrExt {

/// \brief (u, v) of a base face: the Bfr::Parameterization of OpenSubdiv for a face of its size.
///
/// \code
///     float uv[2];
///     surface.GetParameterization().GetCenterCoord(uv);
/// \endcode
///
/// A quad is the unit square.  A triangle has the corners (0, 0), (1, 0) and (0, 1), as with Loop's scheme.  Other
/// faces have sub-faces, as with Catmull-Clark's: a *sub-face* is the kite of a corner, the middles of the two edges
/// at it, and the centre of the face.  FarExt::TopologyLevel::GetFaceSurfaceCoords() has (u, v) of the vertices of all
/// levels.
class OPENSUBDIVHEX_API Parameterization : public OpenSubdiv::Bfr::Parameterization {
public:
    /// An invalid one.
    Parameterization() = default;
    /// The parameterization of a face; invalid for fewer than 3 vertices, and for more than Bfr allows.
    explicit Parameterization(FarExt::FaceShape shape);
    /// One of OpenSubdiv's own, of any scheme.
    explicit Parameterization(OpenSubdiv::Bfr::Parameterization const &other)
        : OpenSubdiv::Bfr::Parameterization(other) {}

    /// The shape of the face.  Half a polygon has the (u, v) of a polygon of as many vertices.
    FarExt::FaceShape GetFaceShape() const { return {GetFaceSize(), _isHalf}; }

    /// @name The plane of the face
    /// Coordinates in one piece, as LevelTessellation::GetPlaneCoords() has them: quads and triangles have their (u, v),
    /// other faces are regular polygons with sides 1 long.  Take (u, v) there to weigh those of several points, as
    /// for a ray's hit in a facet: points of different sub-faces have no mean in (u, v).
    ///
    /// For valid parameterizations.  Coordinates are not numbers where one that is given is none.  REAL is float or double.
    /// @{

    /// Where \p uv lies in the plane.  (u, v) outside its sub-face is moved to the boundary of this.
    template <typename REAL>
    void ConvertToPlane(REAL const uv[2], REAL xy[2]) const;
    /// (u, v) of a point of the plane.  A point outside a face with sub-faces is moved to its boundary, towards the centre.
    template <typename REAL>
    void ConvertFromPlane(REAL const xy[2], REAL uv[2]) const;
    /// @}

private:
    bool _isHalf = false;
};

} // namespace OpenSubdivHex::BfrExt

#endif
