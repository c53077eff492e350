// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_PATCH_CELL_PATCH_POINTS_H
#define OPENSUBDIVHEX_FAR_EXT_PATCH_CELL_PATCH_POINTS_H

#include "patchBuilder.h"

#include "far_ext/limit/cellPatch.h"

#include <vector>

namespace OpenSubdivHex::FarExt::internal {

/// \brief Finds the points of the patches of a whole or half cell as sums of the vertices of its patch.
///
/// Varying data, which have kinks along edges of all levels, are bilinear between the corners of a patch.
///
/// \param finder  of limits, with the options of the steps
/// \param ages  steps of the cell behind its base face, and the ages of its corners (CellPatch::corners),
///              in the place of those of vertices
/// \param rows  kNumPatchPoints rows for each patch, each with a weight for each vertex
/// \return      a failure where the cell has no limit at a corner
OPENSUBDIVHEX_API CallStatus FindCellPatchPoints(CellPatch const &cell, LimitMaskFinder &finder,
                                                 Interpolation interpolation, PatchAges const &ages,
                                                 std::vector<double> &rows);

} // namespace OpenSubdivHex::FarExt::internal

#endif
