// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_VTR_FAR_RELATIONS_H
#define OPENSUBDIVHEX_FAR_EXT_VTR_FAR_RELATIONS_H

#include "level.h"

#include <opensubdiv/far/topologyRefiner.h>

namespace OpenSubdivHex::FarExt::internal {

/// \brief Copies the relations of the base level of \p base to \p level, which has the same faces, where
/// they are those that BuildLevelOfFaces() would find: where the base is manifold, that is, and Far
/// has numbered and ordered all of it.
///
/// Every relation is checked on the way, since a base may have been assembled by hand.
///
/// \param boundary  the kind of edges with one face
/// \return          whether that is so; else the level is as if it had its faces alone
bool CopyRelations(Far::TopologyRefiner const &base, BoundaryKind boundary, Level &level);

} // namespace OpenSubdivHex::FarExt::internal

#endif
