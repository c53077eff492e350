// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_TOOLS_MESH_CONTENT_H
#define OPENSUBDIVHEX_TOOLS_MESH_CONTENT_H

#include "mesh.h"
#include "meshFormat.h"

namespace OpenSubdivHex::Tools {

/// The list of the vertices of a face in PLY files that are written.
inline constexpr char const *kPlyFaceVertices = "vertex_indices";

/// The parts of a mesh that files of a format hold, beside its positions and faces.
struct MeshContent {
    bool hasChannels = false;
    bool hasLabels = false; ///< and material libraries
    /// Indices into the properties of the mesh, in the order in which they are written.
    /// @{
    std::vector<std::size_t> vertexProperties{};
    std::vector<std::size_t> faceProperties{};
    /// @}
};

/// \brief OBJ holds channels, labels and, of vertices, a colour (red, green and blue that are
/// uchar, ushort, float or double) or else w; OFF normals (nx, ny, nz), colours with or without
/// alpha that are uchar or float, texture coordinates (s, t) and colours of faces; PLY all
/// properties but one of faces that has the name of their list of vertices.
MeshContent FindContent(MeshFormat format, Mesh const &mesh);

/// \brief Removes from \p mesh what files of the format that the extension of \p path names do not
/// hold, but for its tags, and gives a name to each thing, such as "channel uv" or "materials".
std::vector<std::string> RemoveWhatIsNotHeld(std::string const &path, Mesh *mesh);

} // namespace OpenSubdivHex::Tools

#endif
