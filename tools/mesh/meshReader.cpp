// SPDX-License-Identifier: Apache-2.0
#include "meshReader.h"

#include "fileError.h"
#include "meshCheck.h"
#include "meshFormat.h"
#include "meshText.h"

namespace OpenSubdivHex::Tools {

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

MeshFormat findFormat(std::string const &path) {
    std::optional<MeshFormat> const format = FindMeshFormat(path);
    if (!format) {
        throw FileError(path, std::string("is not a ") + kMeshExtensions + " file");
    }
    return *format;
}

} // namespace

Mesh ReadMesh(std::string const &path) {
    findFormat(path); // before a file that need not be a mesh is read, or a device without end
    return internal::ParseMesh(path, ReadFile(path));
}

Mesh internal::ParseMesh(std::string const &path, std::string content) {
    MeshFormat const format = findFormat(path);
    if (content.empty()) {
        throw FileError(path, "is empty");
    }
    Mesh mesh = readContent(path, format, &content);
    CheckMesh(mesh, path);
    return mesh;
}

} // namespace OpenSubdivHex::Tools
