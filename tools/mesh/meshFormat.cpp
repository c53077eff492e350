// SPDX-License-Identifier: Apache-2.0
#include "meshFormat.h"

#include <algorithm>
#include <cctype>
#include <filesystem>

namespace OpenSubdivHex::Tools {

std::optional<MeshFormat> FindMeshFormat(std::string const &path) {
    std::string extension = std::filesystem::path(path).extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return char(std::tolower(c)); });
    if (extension == ".obj") {
        return MeshFormat::Obj;
    }
    if (extension == ".off") {
        return MeshFormat::Off;
    }
    if (extension == ".ply") {
        return MeshFormat::Ply;
    }
    return std::nullopt;
}

} // namespace OpenSubdivHex::Tools
