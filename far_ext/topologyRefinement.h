// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_TOPOLOGY_REFINEMENT_H
#define OPENSUBDIVHEX_FAR_EXT_TOPOLOGY_REFINEMENT_H

#include "levelTopology.h"

#include <opensubdiv/sdc/options.h>

namespace OpenSubdivHex::FarExt::internal {

/// \brief The sizes of a level, in 64 bits.
struct LevelSizes {
    std::int64_t vertices;
    std::int64_t edges;
    std::int64_t faces;
    std::int64_t corners;
    std::int64_t freeBoundaries;
    std::int64_t sharpBoundariesA;
    std::int64_t sharpBoundariesB;
};

LevelSizes GetSizes(LevelTopology const &level);

/// The sizes of the level that refinement makes of a level of \p parent sizes.
LevelSizes GetChildSizes(LevelSizes const &parent);

/// \brief Begins \p child, a level of \p sizes, by any step from \p parent: sets its counts.
void BeginLevel(LevelSizes const &sizes, bool fullTopology, LevelTopology const &parent,
                LevelTopology &child);

/// \brief Ends \p child, which has its topology: adds its tags and, with full topology, the masks
/// of its sharp vertices.
void EndLevel(Sdc::Options sdcOptions, LevelTopology &parent, LevelTopology &child);

/// \brief Makes \p child the hexagonal refinement of \p parent: topology, tags and, with \p
/// fullTopology, the masks of its sharp vertices.  Its sizes must fit 32 bits.  Without \p
/// fullTopology only the face-vertices and the tags of faces are made.
void RefineTopology(LevelTopology &parent, Sdc::Options sdcOptions, bool fullTopology,
                    LevelTopology &child);

} // namespace OpenSubdivHex::FarExt::internal

#endif
