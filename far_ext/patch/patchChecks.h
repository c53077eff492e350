// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_PATCH_PATCH_CHECKS_H
#define OPENSUBDIVHEX_FAR_EXT_PATCH_PATCH_CHECKS_H

#include "patchCells.h"

#include "far_ext/patchTableFactory.h"

#include <optional>

namespace OpenSubdivHex::FarExt::internal {

/// \brief Which cells are patches, or why a refiner has none: as PatchTableFactory::Create() says.
CallStatus FindPatchCells(TopologyRefiner const &refiner, PatchTableFactory::Options const &options,
                          std::optional<PatchCells> &cells);

} // namespace OpenSubdivHex::FarExt::internal

#endif
