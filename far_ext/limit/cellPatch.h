// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_LIMIT_CELL_PATCH_H
#define OPENSUBDIVHEX_FAR_EXT_LIMIT_CELL_PATCH_H

#include "limitMask.h"

namespace OpenSubdivHex::FarExt::internal {

/// Corners of a cell that is no whole face: the ends of the edge that made it and, beside the second
/// and the first of these, those of the edge across from it.
inline constexpr int kNumHalfCellCorners = HexIndexing::kNumBoundaryEFaceCorners;

/// \brief A cell, with the patch that all of the surface in it depends on.
///
/// Cells are what a base face is made of at some level: the F-face that comes of it step by step, a
/// *whole cell*, and halves of hexagons, *half cells*, be they cut off by a boundary or not.  The
/// patch has the cell's face as its face 0.
struct CellPatch {
    bool isWhole = true;
    std::vector<int> locals;         ///< the corners of the cell, as places in face 0
    std::vector<Far::Index> corners; ///< the vertices there
    LimitPatch patch;

    int GetNumCorners() const { return int(locals.size()); }
    /// Of a half cell, which half of a hexagon it is, as in kHexagonHalves.
    int GetHalf() const { return locals[0] == kHexagonHalves[1][0] ? 1 : 0; }
};

/// Gathers the cell of a base face, \p level being level 0.
OPENSUBDIVHEX_API void GatherBaseCell(Level const &level, Far::Index face, CellPatch &cell);

/// A cell that one step makes of another, and the vertices of its patch in terms of the other's.
struct CellChild {
    CellPatch cell;
    PatchRefinement step;
};

/// \brief The cells that a step makes of a cell: first the F-face, or the same half of it, then the
/// half cells on this side of the edges, which are those behind corner 0 and so on of a whole cell
/// and behind corners 1 to 3 of a half cell.
OPENSUBDIVHEX_API std::vector<CellChild> RefineCell(CellPatch const &cell, Sdc::Options sdcOptions,
                                                    HexSchemeOptions const &schemeOptions,
                                                    Interpolation interpolation);

/// \brief The limit at a corner of a cell, and the first derivatives there on the side of the cell, in
/// terms of the vertices of the patch.  LimitStencilTableFactory says what they are derivatives by.
struct CornerLimit {
    std::vector<double> weights;
    LimitMask::Tangents tangents;
};

/// \return  by corner; empty where \p finder does not find one
OPENSUBDIVHEX_API std::vector<CornerLimit> FindCornerLimits(CellPatch const &cell,
                                                            LimitMaskFinder &finder);

} // namespace OpenSubdivHex::FarExt::internal

#endif
