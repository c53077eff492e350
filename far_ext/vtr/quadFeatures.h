// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_VTR_QUAD_FEATURES_H
#define OPENSUBDIVHEX_FAR_EXT_VTR_QUAD_FEATURES_H

#include "refinement.h"

namespace OpenSubdivHex::FarExt::internal {

/// \brief Fills quadLineCorners of a level that no step has made, with the corners of quads beside smooth lines.
///
/// Lines are sharp borders and creases at vertices with two sharp edges; sharpVerts of the level are known.
void FindBaseLineCorners(Level &level);

/// \brief Fills quadCorners and quadLineCorners of \p level, the child of \p refinement, from the parent's: with the paths
/// by which the corners of quads came to be corners of the level, where \p faceMask has masks by these.
///
/// Before the first step quadCorners begin around vertices all of whose faces are quads, but for those on a boundary, on an
/// infinitely sharp edge, infinitely sharp, or not manifold.
void FindQuadCorners(FaceMask faceMask, Refinement const &refinement, Level &level);

} // namespace OpenSubdivHex::FarExt::internal

#endif
