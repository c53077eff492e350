// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_TOPOLOGY_REFINEMENT_H
#define OPENSUBDIVHEX_FAR_EXT_TOPOLOGY_REFINEMENT_H

#include "levelTopology.h"

namespace OpenSubdivHex::FarExt::internal {

/// \brief The sizes of a level, in 64 bits.
struct LevelSizes {
    std::int64_t vertices;
    std::int64_t edges;
    std::int64_t faces;
    std::int64_t corners;
    std::int64_t boundaryEdges;
};

LevelSizes GetSizes(LevelTopology const &level);

/// The sizes of the level that refinement makes of a level of \p parent sizes.
LevelSizes GetChildSizes(LevelSizes const &parent);

/// \brief Makes \p child the refinement of \p parent, whose sizes must fit GetChildSizes and
/// 32 bits.  Without \p fullTopology only the face-vertices of the child are made.
void RefineTopology(LevelTopology &parent, LevelTopology &child, bool fullTopology);

} // namespace OpenSubdivHex::FarExt::internal

#endif
