// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_TUTORIALS_LEVEL_MESH_H
#define OPENSUBDIVHEX_TUTORIALS_LEVEL_MESH_H

#include "far_ext/topologyLevel.h"
#include "tutorials/common/mesh.h"

namespace OpenSubdivHex::Tutorials {

/// \brief Replaces the faces of \p mesh, whose channels are those of \p level, by the faces of
/// \p level.
///
/// Holes are left out.  A hexagon that a seam of a channel crosses becomes two quads, its halves,
/// since a mesh has one value per corner; other faces stay whole.
void CopyFaces(FarExt::TopologyLevel const &level, Mesh *mesh);

} // namespace OpenSubdivHex::Tutorials

#endif
