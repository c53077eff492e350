// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_BFR_EXT_CELL_PATCH_SUMS_H
#define OPENSUBDIVHEX_BFR_EXT_CELL_PATCH_SUMS_H

#include "halfCell.h"

#include "far_ext/patch/cellPatchPoints.h"

#include <cstddef>

namespace OpenSubdivHex::BfrExt::internal {

using FarExt::internal::kNumPatchPoints;

/// A place in one of the patches of a face; its derivatives are there as far as they were asked for.
struct PatchPlace {
    int patch;
    double s;
    double t;
    Pair first[2];  ///< derivatives of s, and of t, by u and v
    Pair second[3]; ///< of (s, t), by u twice, by u and v, by v twice
};

/// \brief The rows by which the points of a Gregory patch are sums of other points.
///
/// The first 16 make the points of the bicubic patch, row by row by t, each with the second of the two points inside of a
/// corner.  The last four make what the first point inside of each corner has more than the second.
struct PatchRow {
    static constexpr int kNumBicubic = 16;
    /// By row, the point of the patch; of the last four the first point inside of a corner.
    static constexpr int kPoints[kNumPatchPoints] = {0,  1,  7,  5,  2,  4,  9, 6, 16, 19,
                                                     14, 12, 15, 17, 11, 10, 3, 8, 18, 13};
    /// The rows of the second points inside of the corners, in the order of the last four.
    static constexpr int kOfCorners[4] = {5, 6, 9, 10};
};

/// \brief A Gregory patch as sums of points, the columns of a dense matrix.
template <typename REAL>
struct PatchBlock {
    /// Columns that lie together, row by row.
    static constexpr int kGroup = 32 / int(sizeof(REAL));
    static int GetPaddedSize(int numColumns) { return (numColumns + kGroup - 1) / kGroup * kGroup; }
    /// Where the weight of a row is, behind the first one.
    static std::size_t GetPlace(int row, int column) {
        return std::size_t((column / kGroup * kNumPatchPoints + row) * kGroup + column % kGroup);
    }

    REAL const *weights; ///< group by group
    int const *columns;  ///< the points
    int numColumns;      ///< those of whole groups: the last ones may weigh nothing
};

/// A place of a patch, and where its point and its derivatives by u and v go.
template <typename REAL>
struct PatchSums {
    PatchPlace const &place;
    int numDerivatives; ///< 0, 1 or 2
    PatchBlock<REAL> const &block;
    REAL const *points;    ///< those that columns name
    int size;              ///< of a point
    std::ptrdiff_t stride; ///< from one point to the next, in numbers
    REAL *const *results;  ///< in the order of FacePatches::Evaluate()
};

} // namespace OpenSubdivHex::BfrExt::internal

#endif
