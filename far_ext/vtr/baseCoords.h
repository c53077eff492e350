// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_VTR_BASE_COORDS_H
#define OPENSUBDIVHEX_FAR_EXT_VTR_BASE_COORDS_H

#include "hierarchy.h"

namespace OpenSubdivHex::FarExt::internal {

/// \brief The places of the vertices of a cell of level \p depth in the parameter plane of its base
/// face: see TopologyLevel::GetFaceBaseCoords.
///
/// \param cell  of a face that lies in one base face all of that is meant
/// \param uv    gets u and v of each vertex
/// \return      false when a step to the level was not hexagonal
template <typename REAL>
bool FindBaseCoords(MeshLevels const &mesh, int depth, Cell cell, REAL *uv);

} // namespace OpenSubdivHex::FarExt::internal

#endif
