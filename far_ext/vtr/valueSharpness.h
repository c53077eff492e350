// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_VTR_VALUE_SHARPNESS_H
#define OPENSUBDIVHEX_FAR_EXT_VTR_VALUE_SHARPNESS_H

#include "level.h"

#include <opensubdiv/sdc/options.h>

#include <vector>

namespace OpenSubdivHex::FarExt::internal {

/// \brief The rules by which Far's FVarLinearInterpolation keeps values of a face-varying channel in
/// place, but for those at non-manifold vertices without seams.
///
/// \param mesh        level 0, with its tags
/// \param faceValues  by corner
/// \param seams       edges of the mesh, of FindSeams()
/// \return            by corner, the sharpness of its value: infinite for one that stays, 0 for one
///                    that follows its seam, else that of the vertex
std::vector<float> FindValueSharpness(Level const &mesh, Far::Index const *faceValues,
                                      std::vector<Far::Index> const &seams,
                                      Sdc::Options::FVarLinearInterpolation interpolation);

} // namespace OpenSubdivHex::FarExt::internal

#endif
