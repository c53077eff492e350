// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_TOOLS_LEVEL_MESH_H
#define OPENSUBDIVHEX_TOOLS_LEVEL_MESH_H

#include "far_ext/stencilTableFactory.h"
#include "tools/mesh/mesh.h"

#include <vector>

namespace OpenSubdivHex::Tools {

/// A number for each face, the same for those that no label and no property tells apart; empty where
/// faces have neither.
std::vector<int> FindFaceClasses(Mesh const &mesh);

/// \brief Replaces the faces of \p mesh, whose channels are those of \p level, by the faces of
/// \p level.
///
/// Holes are left out: of a hexagon with one half in a hole the other half is a quad.  A hexagon
/// becomes two quads, its halves, where a seam of a channel crosses it, since a mesh has one value per
/// corner, and where base faces of different labels or properties share it; other faces stay whole.
///
/// They are in the order of the level or, where the faces of a refined level have labels, in that of
/// Mesh::labels: a file has its objects, groups and materials one after the other.
void CopyFaces(FarExt::TopologyLevel const &level, Mesh *mesh);

/// \brief Overload with a further channel, the last of \p mesh, whose values are those of \p
/// sides.
///
/// Hexagons that a sharp crease crosses become two quads as well.
void CopyFaces(FarExt::TopologyLevel const &level, FarExt::LimitSides const &sides, Mesh *mesh);

/// \brief Overload with the values of channels as properties of vertices: s, t and, of three
/// numbers, r; or nx, ny and nz.
///
/// A vertex at which corners have different ones becomes several: the first in its place, the others
/// behind all vertices.
///
/// \param sides  null where no channel has their values
void CopySeparateFaces(FarExt::TopologyLevel const &level, FarExt::LimitSides const *sides,
                       Mesh *mesh);

/// \brief Puts the faces of \p mesh in the order of their labels, those with the same in the order in
/// which they are, so that a file has its objects, groups and materials one after the other.  Without
/// labels they stay as they are.
void SortFacesByLabel(Mesh *mesh);

} // namespace OpenSubdivHex::Tools

#endif
