// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_BFR_EXT_CELL_SURFACE_TURNS_H
#define OPENSUBDIVHEX_BFR_EXT_CELL_SURFACE_TURNS_H

#include "far_ext/limit/cellPatch.h"

namespace OpenSubdivHex::BfrExt::internal {

/// What a surface keeps of its face, besides its type, to agree with its neighbours; declared by
/// surface.h.
struct SurfaceTurns {
    FarExt::internal::BaseCellTurns turns;
};

} // namespace OpenSubdivHex::BfrExt::internal

#endif
