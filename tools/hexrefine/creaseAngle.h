// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_TOOLS_CREASE_ANGLE_H
#define OPENSUBDIVHEX_TOOLS_CREASE_ANGLE_H

#include "tools/mesh/mesh.h"

namespace OpenSubdivHex::Tools {

/// \brief Makes an infinitely sharp crease of every edge whose two faces have normals with an angle
/// of more than \p degrees between them; the other creases of \p mesh stay.
///
/// The normal of a face is the vector of its areas as the coordinate planes see it, which faces
/// that are not flat have as well.  Edges with other than two faces that run it in opposite
/// directions, and edges of faces without area, make no crease.
void AddCreases(double degrees, Mesh *mesh);

} // namespace OpenSubdivHex::Tools

#endif
