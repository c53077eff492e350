// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_TOOLS_MESH_OUTPUT_H
#define OPENSUBDIVHEX_TOOLS_MESH_OUTPUT_H

#include "mesh.h"
#include "meshFormat.h"

#include <cstdint>
#include <functional>
#include <string_view>

namespace OpenSubdivHex::Tools {

/// Takes the bytes of a file, in their order.
using WriteBytes = std::function<void(std::string_view)>;

/// The counts in the header of a file.
struct MeshCounts {
    std::int64_t vertices = 0;
    std::int64_t faces = 0;
    bool hasShortFaces = true; ///< HasShortFaces() of all
};

/// Whether the numbers of corners take one byte each, as a binary file has them then.
bool HasShortFaces(Mesh const &mesh);

/// @name Parts of a file
/// A mesh file is its header, its vertices, the values of each channel (OBJ) and its faces, one behind
/// the other.  Of a mesh that comes in pieces, each part is those of the pieces; the header has what
/// the mesh has beside arrays, and the counts of all.
/// @{
void WriteHeader(MeshFormat format, Mesh const &mesh, MeshCounts const &counts,
                 WriteBytes const &write);
void WriteVertices(MeshFormat format, Mesh const &mesh, WriteBytes const &write);
/// Nothing in formats without channels.
void WriteValues(MeshFormat format, FVarChannel const &channel, WriteBytes const &write);
/// With the statements of labels, where the mesh has some.
void WriteFaces(MeshFormat format, Mesh const &mesh, bool hasShortFaces, WriteBytes const &write);
/// @}

/// The lines of an OBJ file between faces with one label and faces with another.
std::string FormatLabelChange(FaceLabel const &before, FaceLabel const &label);

} // namespace OpenSubdivHex::Tools

#endif
