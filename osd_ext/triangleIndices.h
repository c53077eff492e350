// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_OSD_EXT_TRIANGLE_INDICES_H
#define OPENSUBDIVHEX_OSD_EXT_TRIANGLE_INDICES_H

#include "far_ext/topologyLevel.h"

#include <vector>

namespace OpenSubdivHex::OsdExt {

/// \brief Index buffers to draw the faces of a level as triangles.
struct TriangleIndices {
    /// Three vertices of the level per triangle, in the orientation of the face.
    std::vector<int> vertices;
    /// Three face-varying values per triangle; empty unless a channel was chosen.
    std::vector<int> fvarValues;
    /// The face of the level that each triangle belongs to.
    std::vector<int> faces;
    /// The face of level 0 that each triangle came from (TopologyLevel::GetFaceBaseFace).
    std::vector<int> baseFaces;

    /// Triangles: a third of the vertices.
    int GetNumTriangles() const { return int(faces.size()); }
};

/// \brief What CreateTriangleIndices draws.
struct TriangleOptions {
    int vertexOffset = 0;   ///< added to every vertex, for levels behind others in one buffer
    int fvarChannel = -1;   ///< for fvarValues, one that the level has; -1 for none
    bool drawHoles = false; ///< whether faces tagged as holes are drawn as well
};

/// \brief Triangulates the faces of \p level: a face of n sides makes n - 2 triangles that zigzag
/// across it, so that no vertex collects them all.
///
/// A hexagon that a crease, or a seam of the chosen channel, crosses is split along that diagonal
/// first, so that normals and values may differ to both sides.  Triangles are in the order of the
/// faces.  Works on the calling thread; several may call it at once.  std::bad_alloc passes through.
OPENSUBDIVHEX_API TriangleIndices CreateTriangleIndices(
    FarExt::TopologyLevel const &level, TriangleOptions options = TriangleOptions());

} // namespace OpenSubdivHex::OsdExt

#endif
