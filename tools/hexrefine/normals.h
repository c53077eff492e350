// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_TOOLS_NORMALS_H
#define OPENSUBDIVHEX_TOOLS_NORMALS_H

#include "tools/mesh/mesh.h"

namespace OpenSubdivHex::Tools {

/// Whether a property of vertices is a number of their normals.
bool IsNormal(VertexProperty const &property);

/// Whether vertices have normals as properties, not rounded to integers.
bool HasFloatNormals(Mesh const &mesh);

/// Makes all normals of \p mesh 1 long: those of channels and, where they are not
/// rounded to integers, those of vertices.
void NormalizeNormals(Mesh *mesh);

} // namespace OpenSubdivHex::Tools

#endif
