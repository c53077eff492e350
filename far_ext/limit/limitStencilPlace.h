// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_LIMIT_LIMIT_STENCIL_PLACE_H
#define OPENSUBDIVHEX_FAR_EXT_LIMIT_LIMIT_STENCIL_PLACE_H

#include "far_ext/status.h"

namespace OpenSubdivHex::FarExt::internal {

/// Where a limit stencil is to be written, an entry of each array for each of its control vertices.
template <typename REAL>
struct LimitStencilPlace {
    Far::Index *indices;
    REAL *weights;
    REAL *duWeights; ///< these two are null without derivatives
    REAL *dvWeights;
};

} // namespace OpenSubdivHex::FarExt::internal

#endif
