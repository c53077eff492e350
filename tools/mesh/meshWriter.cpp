// SPDX-License-Identifier: Apache-2.0
#include "meshWriter.h"

#include "fileError.h"
#include "meshCheck.h"
#include "meshOutput.h"
#include "outputFile.h"

namespace OpenSubdivHex::Tools {

void WriteMesh(Mesh const &mesh, std::string const &path) {
    std::optional<MeshFormat> const format = FindMeshFormat(path);
    if (!format) {
        throw FileError(path, std::string("is not a ") + kMeshExtensions + " file");
    }
    CheckMesh(mesh, path);
    OutputFile file(path);
    WriteBytes const write = [&](std::string_view bytes) { file.Write(bytes); };
    MeshCounts const counts = {mesh.GetNumVertices(), mesh.GetNumFaces(), HasShortFaces(mesh)};
    WriteHeader(*format, mesh, counts, write);
    WriteVertices(*format, mesh, write);
    for (FVarChannel const &channel : mesh.channels) {
        WriteValues(*format, channel, write);
    }
    WriteFaces(*format, mesh, counts.hasShortFaces, write);
    file.Commit();
}

} // namespace OpenSubdivHex::Tools
