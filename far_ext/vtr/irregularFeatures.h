// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_VTR_IRREGULAR_FEATURES_H
#define OPENSUBDIVHEX_FAR_EXT_VTR_IRREGULAR_FEATURES_H

#include "level.h"

#include "far_ext/mask.h"

namespace OpenSubdivHex::FarExt::internal {

/// \brief Fills level.irregularVerts and level.irregularCorners, from the level's relations and
/// tags: with what \p faceMask has masks of its own for.
///
/// Only levels behind hexagonal steps have any: V-vertices with four faces or more that are all
/// E-faces of six sides, and such E-faces beside F-faces of four.
void FindIrregularFeatures(FaceMask faceMask, Level &level);

} // namespace OpenSubdivHex::FarExt::internal

#endif
