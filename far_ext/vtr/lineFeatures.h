// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_VTR_LINE_FEATURES_H
#define OPENSUBDIVHEX_FAR_EXT_VTR_LINE_FEATURES_H

#include "refinement.h"

#include <optional>

namespace OpenSubdivHex::FarExt::internal {

/// \brief Fills lineRowCorners of \p level, the child of \p refinement, where \p faceMask has masks beside lines.
///
/// A truncation begins them: on a sharp edge between two vertices that the line passes, at the half polygons or crossed
/// faces of these, and at the hexagons behind and beyond.  The next steps go on from the parent's.
void FindLineRowCorners(TagOptions options, Refinement const &refinement, Level &level);

/// \brief Returns the tag that the F-face of a face of \p faceSize corners has at the same corner, if any.
std::optional<LineRowCorner> FindLineRowOfFFace(LineRowCorner const &parent, int faceSize,
                                                Sdc::Options sdcOptions);

} // namespace OpenSubdivHex::FarExt::internal

#endif
