// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_BFR_EXT_PARAMETERIZATION_H
#define OPENSUBDIVHEX_BFR_EXT_PARAMETERIZATION_H

#include "far_ext/export.h"

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
    /// The parameterization of a face of \p faceSize vertices; invalid for fewer than 3, and for more than Bfr allows.
    explicit Parameterization(int faceSize);
};

} // namespace OpenSubdivHex::BfrExt

#endif
