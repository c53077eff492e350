// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_OSD_EXT_REFINEMENT_GROUP_SELECTION_H
#define OPENSUBDIVHEX_OSD_EXT_REFINEMENT_GROUP_SELECTION_H

#include "preparedRefinement.h"

#include <optional>
#include <vector>

namespace OpenSubdivHex::OsdExt::internal {

/// \brief The part of a refinement that some vertices of its child need: the limit depends on few
/// vertices of the last level, those near irregular ones.
///
/// What is made has the same bits as with all groups.
///
/// \param isNeeded  a mark for each vertex of the child
/// \return          nothing where that is most of the refinement, and doing all is as fast
std::optional<RefinementGroups> SelectGroups(PreparedRefinement const &prepared,
                                             FarExt::internal::Refinement const &refinement,
                                             std::vector<unsigned char> isNeeded);

} // namespace OpenSubdivHex::OsdExt::internal

#endif
