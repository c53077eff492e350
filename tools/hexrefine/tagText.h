// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_TOOLS_TAG_TEXT_H
#define OPENSUBDIVHEX_TOOLS_TAG_TEXT_H

#include "tools/mesh/mesh.h"

#include <string>

namespace OpenSubdivHex::Tools {

/// \brief The tags of \p mesh, and the rules \p options, as lines of an OBJ file that say the same;
/// before them, comments that count the tags and name the channels.
std::string FormatTags(Mesh const &mesh, OpenSubdiv::Sdc::Options options);

} // namespace OpenSubdivHex::Tools

#endif
