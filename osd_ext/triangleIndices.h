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
    /// The face of the level that each triangle belongs to.
    std::vector<int> faces;
    /// The face of level 0 that each triangle came from (TopologyLevel::GetFaceBaseFace).
    std::vector<int> baseFaces;

    int GetNumTriangles() const { return int(faces.size()); }
};

/// \brief Triangulates every face of \p level: a face of n sides makes n - 2 triangles that
/// zigzag across it, so that no vertex collects them all.
///
/// Triangles are in the order of the faces.  \p vertexOffset is added to every vertex, for
/// levels that lie behind others in one vertex buffer.
TriangleIndices CreateTriangleIndices(FarExt::TopologyLevel const &level, int vertexOffset = 0);

} // namespace OpenSubdivHex::OsdExt

#endif
