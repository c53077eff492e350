// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_TOOLS_DEGENERATE_FACES_H
#define OPENSUBDIVHEX_TOOLS_DEGENERATE_FACES_H

#include "tools/mesh/mesh.h"

#include <string>

namespace OpenSubdivHex::Tools {

/// \brief A sentence that counts the faces of a mesh that have a vertex several times, and names the first
/// by its number, from 0; empty without any.
std::string DescribeDegenerateFaces(Mesh const &mesh);

} // namespace OpenSubdivHex::Tools

#endif
