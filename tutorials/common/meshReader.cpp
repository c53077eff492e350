// SPDX-License-Identifier: Apache-2.0
#include "meshReader.h"

#include "fileError.h"
#include "meshFormat.h"
#include "meshText.h"

#include <algorithm>
#include <limits>

namespace OpenSubdivHex::Tutorials {

namespace {

Mesh readContent(std::string const &path, MeshFormat format, std::string *content) {
    switch (format) {
    case MeshFormat::Obj:
        return internal::ReadObj(path, content);
    case MeshFormat::Off:
        return internal::ReadOff(path, content);
    case MeshFormat::Ply:
        break;
    }
    return internal::ReadPly(path, content);
}

} // namespace

Mesh ReadMesh(std::string const &path) {
    std::optional<MeshFormat> const format = FindMeshFormat(path);
    std::string content = ReadFile(path);
    if (!format) {
        throw FileError(path, std::string("is not a ") + kMeshExtensions + " file");
    }
    if (content.empty()) {
        throw FileError(path, "is empty");
    }
    Mesh mesh = readContent(path, *format, &content);
    if (mesh.faceSizes.empty()) {
        throw FileError(path, "has no faces");
    }
    if (std::max(mesh.positions.size() / 3, mesh.faceVertices.size()) >
        std::size_t(std::numeric_limits<int>::max())) {
        throw FileError(path, "has more than 2147483647 vertices or face corners");
    }
    return mesh;
}

} // namespace OpenSubdivHex::Tutorials
