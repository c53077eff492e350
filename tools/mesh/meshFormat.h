// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_TOOLS_MESH_FORMAT_H
#define OPENSUBDIVHEX_TOOLS_MESH_FORMAT_H

#include <optional>
#include <string>

namespace OpenSubdivHex::Tools {

enum class MeshFormat { Obj, Off, Ply };

/// The format that the extension of \p path names, in upper or lower case.
std::optional<MeshFormat> FindMeshFormat(std::string const &path);

/// The extensions that FindMeshFormat knows, for messages.
inline constexpr char kMeshExtensions[] = ".obj, .off or .ply";

} // namespace OpenSubdivHex::Tools

#endif
