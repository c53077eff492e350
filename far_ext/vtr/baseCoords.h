// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_VTR_BASE_COORDS_H
#define OPENSUBDIVHEX_FAR_EXT_VTR_BASE_COORDS_H

#include "hierarchy.h"

#include "far_ext/surfaceFaces.h"

namespace OpenSubdivHex::FarExt::internal {

/// Kinds of coordinates in a face.
enum class CoordsOf {
    Plane,           ///< that of BasePolygon
    Parameterization ///< that of MakeFaceParameterization()
};

/// \brief The places of the vertices of a cell of level \p depth in its surface face of level \p baseDepth: see
/// TopologyLevel::GetFaceBaseCoords.
///
/// \param cell  of a face that lies in one such face all of that is meant
/// \param uv    gets two coordinates of each vertex
/// \return      false when a step from that level on was not hexagonal, or it comes later
template <typename REAL>
bool FindBaseCoords(MeshLevels const &mesh, int baseDepth, int depth, Cell cell, CoordsOf coordsOf,
                    REAL *uv);
/// The surface face; INDEX_INVALID where FindBaseCoords() is false.
Far::Index FindBaseFace(MeshLevels const &mesh, int baseDepth, int depth, Cell cell);

} // namespace OpenSubdivHex::FarExt::internal

#endif
