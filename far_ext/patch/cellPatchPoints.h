// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_PATCH_CELL_PATCH_POINTS_H
#define OPENSUBDIVHEX_FAR_EXT_PATCH_CELL_PATCH_POINTS_H

#include "patchBuilder.h"

#include "far_ext/limit/cellPatch.h"

#include <vector>

namespace OpenSubdivHex::FarExt::internal {

/// The Gregory patches of a cell: a whole hexagon is one for each half, each other cell of four corners is one, and all
/// others are a kite for each corner.
constexpr int GetNumCellPatches(CellKind kind, int numCorners) {
    return kind == CellKind::Half  ? 1
           : HasHalves(numCorners) ? 2
           : numCorners == 4       ? 1
                                   : numCorners;
}

/// \brief Finds the points of the patches of a whole or half cell as sums of the vertices of its patch.
///
/// Varying data, which have kinks along edges of all levels, are bilinear between the corners of a patch.
///
/// \param ages  steps of the cell behind its base face, and the ages of its corners (CellPatch::corners),
///              in the place of those of vertices
/// \param rows  kNumPatchPoints rows for each patch, each with a weight for each vertex
/// \return      a failure where the cell has no limit at a corner
OPENSUBDIVHEX_API CallStatus FindCellPatchPoints(CellPatch const &cell, Sdc::Options sdcOptions,
                                                 HexSchemeOptions const &schemeOptions,
                                                 Interpolation interpolation, PatchAges const &ages,
                                                 std::vector<double> &rows);

} // namespace OpenSubdivHex::FarExt::internal

#endif
