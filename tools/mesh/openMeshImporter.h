// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_TOOLS_OPEN_MESH_IMPORTER_H
#define OPENSUBDIVHEX_TOOLS_OPEN_MESH_IMPORTER_H

#include "mesh.h"

#include <OpenMesh/Core/IO/importer/BaseImporter.hh>
#include <OpenMesh/Core/IO/reader/BaseReader.hh>

#include <sstream>
#include <string>
#include <string_view>
#include <vector>

namespace OpenSubdivHex::Tools::internal {

/// \brief A text as OpenMesh's readers get it: rewritten so far that they cannot misread it.
struct OpenMeshInput {
    std::string const &path;
    std::string_view header; ///< lines that replace the first numHeaderLines lines of the file
    std::string_view body;   ///< the rest of the file, as it is
    int numHeaderLines = 0;
    int numVertices = 0; ///< as announced
    int numFaces = 0;    ///< as announced
};

/// \brief Takes the words that follow what OpenMesh reads on the line of a vertex or of a face:
/// colours, for one.
class ExtrasReader {
public:
    virtual ~ExtrasReader() = default;

    /// \name Each gives what is wrong with the line of which \p words are, "too many values", or
    /// nothing.
    /// @{
    virtual std::string ReadVertex(std::vector<std::string_view> const &words) = 0;
    virtual std::string ReadFace(std::vector<std::string_view> const &words) = 0;
    /// @}
};

/// \brief Reads a mesh through one of OpenMesh's readers, but not into an OpenMesh mesh, which
/// drops faces that it cannot connect.
///
/// Checks what the readers do not: that each number could be read, that each vertex and face stands
/// on a line of its own, the ranges of values, and that there are as many vertices and faces as
/// announced, no more and no less.  Throws FileError.
Mesh ReadThroughOpenMesh(OpenMesh::IO::BaseReader &reader, OpenMeshInput const &input,
                         ExtrasReader &extras);

} // namespace OpenSubdivHex::Tools::internal

#endif
