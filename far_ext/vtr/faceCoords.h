// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_VTR_FACE_COORDS_H
#define OPENSUBDIVHEX_FAR_EXT_VTR_FACE_COORDS_H

#include "basePolygon.h"

#include "far_ext/export.h"

#include <opensubdiv/bfr/parameterization.h>

namespace OpenSubdivHex::FarExt::internal {

/// \brief The parameterization of a face of \p size vertices: a quad is the unit square, a triangle has the corners
/// (0, 0), (1, 0) and (0, 1), and others have a sub-face for each corner.
///
/// In quads and triangles (u, v) are the coordinates of the plane of BasePolygon.  There is none for fewer than 3
/// vertices, nor for more than Bfr allows.
OPENSUBDIVHEX_API OpenSubdiv::Bfr::Parameterization MakeFaceParameterization(int size);

/// A place in the plane of BasePolygon, with the derivatives of its coordinates by u and v.
struct PlanePlace {
    using Pair = BasePolygon::Pair;

    Pair coords;
    Pair byU;
    Pair byV;
    Pair byUv; ///< by both; there are no others
};

/// \brief Where (u, v) lies in the plane of the face of a valid parameterization; coordinates are not numbers where u or v
/// is none.
///
/// A sub-face is mapped bilinearly to the kite of its corner, the centre of the face, and the middles of the two
/// edges at the corner.  (u, v) outside of the sub-face that Bfr finds is moved to its boundary.
OPENSUBDIVHEX_API PlanePlace FindInPlane(OpenSubdiv::Bfr::Parameterization const &parameterization,
                                         BasePolygon::Pair const &uv);

/// \brief The u and v of a point of the face of a valid parameterization, whose plane \p polygon is.
///
/// Between two sub-faces it is in the second, but the centre is in that of corner 0.
OPENSUBDIVHEX_API BasePolygon::Pair
FindFaceCoords(OpenSubdiv::Bfr::Parameterization const &parameterization,
               BasePolygon const &polygon, int sector, SectorPoint point);

} // namespace OpenSubdivHex::FarExt::internal

#endif
