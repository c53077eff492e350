// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_VTR_BASE_IMPORTER_H
#define OPENSUBDIVHEX_FAR_EXT_VTR_BASE_IMPORTER_H

#include "hierarchy.h"

#include <opensubdiv/far/topologyRefiner.h>

#include <memory>

namespace OpenSubdivHex::FarExt::internal {

/// \brief Takes the base level of an unrefined refiner, which was checked, apart into faces and
/// edges, and puts them together as level 0, with tags and channels.
///
/// \param isHole  by face; null where only the base knows
/// \param status  may get warnings
/// \return        null with a status for what has no place in a level
std::unique_ptr<Hierarchy> ImportBase(Far::TopologyRefiner const &base, bool const *isHole,
                                      Status &status);

} // namespace OpenSubdivHex::FarExt::internal

#endif
