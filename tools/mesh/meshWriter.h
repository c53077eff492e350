// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_TOOLS_MESH_WRITER_H
#define OPENSUBDIVHEX_TOOLS_MESH_WRITER_H

#include "mesh.h"

#include <string>

namespace OpenSubdivHex::Tools {

/// Whether files of the format that the extension of \p path names hold face-varying channels.
bool HasChannels(std::string const &path);

/// \brief Writes \p mesh in the format that the extension of \p path names: OBJ and OFF as text,
/// PLY in little-endian binary.
///
/// OBJ gets the channels (one of each kind at most), OFF and PLY positions and faces alone; tags
/// are written to none.
///
/// Text has as many digits as it takes to read the same floats again.  The file appears whole or
/// not at all.  Throws FileError, also for what CheckMesh refuses: ReadMesh would do so.
void WriteMesh(Mesh const &mesh, std::string const &path);

} // namespace OpenSubdivHex::Tools

#endif
