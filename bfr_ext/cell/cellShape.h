// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_BFR_EXT_CELL_CELL_SHAPE_H
#define OPENSUBDIVHEX_BFR_EXT_CELL_CELL_SHAPE_H

#include "halfCell.h"

#include "bfr_ext/cellTree.h"

#include <array>
#include <cstdint>

namespace OpenSubdivHex::BfrExt::internal {

/// \brief Where a cell of a tree lies in the plane of its base face.
///
/// All lines are straight there: half cells are trapezoids, and what an edge becomes lies on it.
struct CellShape : CellOutline<std::array<std::int32_t, 2>> {
    /// The coordinates a and b in a sector, in units of 2^-kBits: what the start and the end of the edge
    /// weigh beside the centre.
    using Place = std::array<std::int32_t, 2>;
    static constexpr int kBits = Polyline::kLastLevel + 2;
    static constexpr std::int32_t kOne = std::int32_t(1) << kBits;

    /// The shape of the base face.
    static CellShape MakeFace() { return {MakeWhole(kOne), 0, 0}; }

    /// The shape of a child, of a cell that \p tree has refined.
    CellShape GetChild(CellTree const &tree, int child) const {
        return {CellOutline::GetChild(tree.GetFaceShape(), child),
                tree.GetFirstChild(number) + child, level + 1};
    }

    int number; ///< in the tree
    int level;
};

} // namespace OpenSubdivHex::BfrExt::internal

#endif
