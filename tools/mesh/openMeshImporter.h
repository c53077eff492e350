// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_TOOLS_OPEN_MESH_IMPORTER_H
#define OPENSUBDIVHEX_TOOLS_OPEN_MESH_IMPORTER_H

#include "mesh.h"

#include <OpenMesh/Core/IO/importer/BaseImporter.hh>
#include <OpenMesh/Core/IO/reader/BaseReader.hh>

#include <sstream>
#include <string>
#include <string_view>

namespace OpenSubdivHex::Tools::internal {

/// \brief A file as OpenMesh's readers get it: rewritten so far that they cannot misread it.
struct OpenMeshInput {
    std::string const &path;
    std::string_view header; ///< lines that replace the first numHeaderLines lines of the file
    std::string_view body;   ///< the rest of the file, as it is
    int numHeaderLines = 0;
    int numVertices = 0; ///< as announced
    int numFaces = 0;    ///< as announced
    bool isText = false;
    std::size_t numVertexWords = 3; ///< in text: words that the reader takes for a vertex, ...
    int maxVertexExtras = 0;        ///< ... words that may follow them ...
    int maxFaceExtras = 0;          ///< ... and words that may follow the corners of a face
    bool skipFaceExtras = false;    ///< whether the reader does not step over those itself
    bool mayHaveMore = false;       ///< whether other content may follow the faces
};

/// \brief Reads a mesh through one of OpenMesh's readers, but not into an OpenMesh mesh, which
/// drops faces that it cannot connect.
///
/// Checks what the readers do not: that each number could be read, that each vertex and face of a
/// text stands on a line of its own, the ranges of values, and that there are as many vertices and
/// faces as announced, no more and no less.  Throws FileError.
Mesh ReadThroughOpenMesh(OpenMesh::IO::BaseReader &reader, OpenMeshInput const &input);

} // namespace OpenSubdivHex::Tools::internal

#endif
