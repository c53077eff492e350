// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_VTR_VALIDATOR_H
#define OPENSUBDIVHEX_FAR_EXT_VTR_VALIDATOR_H

#include "refinement.h"

namespace OpenSubdivHex::FarExt::internal {

/// \brief Checks every invariant of \p level by direct search, and its relation to the level before
/// by \p refinement, null for a level 0.
///
/// \return  InvalidTopology, which names the first component that breaks one, or Ok
CallStatus Validate(Level const &level, Refinement const *refinement);

} // namespace OpenSubdivHex::FarExt::internal

#endif
