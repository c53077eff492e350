// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_VTR_HEX_REFINEMENT_H
#define OPENSUBDIVHEX_FAR_EXT_VTR_HEX_REFINEMENT_H

#include "refinement.h"

#include <opensubdiv/sdc/options.h>

namespace OpenSubdivHex::FarExt::internal {

/// \brief Makes \p child the hexagonal refinement of \p parent: relations, tags and, with \p
/// fullTopology, the masks of its sharp vertices.  Its sizes must fit 32 bits.  Without \p
/// fullTopology only the face-vertices and the tags of faces are made.
void RefineHexagonally(Level const &parent, TagOptions tagOptions, bool fullTopology,
                       Refinement &refinement, Level &child);

} // namespace OpenSubdivHex::FarExt::internal

#endif
