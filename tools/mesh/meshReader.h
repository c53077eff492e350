// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_TOOLS_MESH_READER_H
#define OPENSUBDIVHEX_TOOLS_MESH_READER_H

#include "mesh.h"

#include <string>

namespace OpenSubdivHex::Tools {

/// \brief Reads an OBJ, OFF or PLY file (PLY in text or binary): positions and faces; of OBJ the
/// texture coordinates, the normals, colours and w of vertices, the labels of faces, and the tag
/// lines of OpenSubdiv's shape files; of OFF normals, texture coordinates and colours; of PLY all
/// numbers that vertices and faces have.
///
/// Faces may have any number of corners.  Nothing is dropped, split, merged or repaired: vertices
/// and faces are those of the file, in its order, or the file is refused.  Texture coordinates
/// become a channel when faces name them, and so do normals; either all corners of all faces have
/// one or none, else the file is refused.  What else the file has is named in Mesh::notRead.
/// In OBJ files, a backslash joins a line with the next one.  If that begins with a statement, the backslash is part
/// of the line, with one of Mesh::warnings.
/// Whether the faces make a surface is not looked at; that is TopologyRefinerFactory's task.
///
/// Throws FileError, which names line, vertex or face, for anything it cannot read as it stands:
/// numbers that are not finite or not of their type, indices out of range, faces of fewer than
/// three corners, less or more content than announced, statements and tags it does not know, no
/// face at all.
Mesh ReadMesh(std::string const &path);

namespace internal {

/// ReadMesh() for a file with this content.
Mesh ParseMesh(std::string const &path, std::string content);

/// The readers of the formats.  \p content is the content of the file \p path and is changed.
Mesh ReadObj(std::string const &path, std::string *content);
Mesh ReadOff(std::string const &path, std::string *content);
Mesh ReadPly(std::string const &path, std::string *content);

} // namespace internal
} // namespace OpenSubdivHex::Tools

#endif
