// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_TOOLS_MESH_WRITER_H
#define OPENSUBDIVHEX_TOOLS_MESH_WRITER_H

#include "mesh.h"

#include <string>

namespace OpenSubdivHex::Tools {

/// \brief Writes \p mesh in the format that the extension of \p path names: OBJ and OFF as text,
/// PLY in little-endian binary.
///
/// Writes the content that FindContent() finds, with one channel of each kind at most; in OBJ files a label's
/// statements stand where it differs from that of the face before.  No file gets tags.
/// Numbers of integer types are rounded to the nearest that the type has.  OBJ has colours of
/// integers divided by the largest that the type has.
///
/// Text has as many digits as it takes to read the same floats again.  The file appears whole or
/// not at all.  Throws FileError, also for what CheckMesh refuses: ReadMesh would do so.
void WriteMesh(Mesh const &mesh, std::string const &path);

} // namespace OpenSubdivHex::Tools

#endif
