// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_TOOLS_MESH_CHECK_H
#define OPENSUBDIVHEX_TOOLS_MESH_CHECK_H

#include "mesh.h"

#include <cstdint>
#include <string>
#include <vector>

namespace OpenSubdivHex::Tools {

/// Counts of the pieces before a piece of a mesh.
struct MeshStart {
    std::int64_t vertex = 0;
    std::vector<std::int64_t> values{}; ///< by channel; empty: none
};

/// \brief Throws FileError for the file \p path, which names the vertex or the value, if a number
/// of \p mesh is not finite.  \p place, such as "level 3: ", goes before the cause: there the numbers
/// are sums of finite ones, beyond what floats hold.
///
/// \param start  what is before it in the mesh that names are of
void CheckFinite(Mesh const &mesh, std::string const &path, std::string const &place = "",
                 MeshStart const &start = {});

/// \brief Throws FileError unless a file may hold \p mesh: it has faces, no more vertices, values
/// and corners than 31 bits count, and finite numbers.  What is read and what is written meets it.
void CheckMesh(Mesh const &mesh, std::string const &path);

} // namespace OpenSubdivHex::Tools

#endif
