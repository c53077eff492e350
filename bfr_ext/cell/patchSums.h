// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_BFR_EXT_CELL_PATCH_SUMS_H
#define OPENSUBDIVHEX_BFR_EXT_CELL_PATCH_SUMS_H

#include "halfCell.h"

#include "far_ext/patch/cellPatchPoints.h"
#include "far_ext/vtr/inline.h"

#include <cstddef>
#include <limits>

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
/// corner.  The last four make what the first point inside of each corner, in turn, has more than the second.
struct PatchRow {
    static constexpr int kNumBicubic = 16;
    /// By row, the point of the patch; of the last four the first point inside of a corner.
    static constexpr int kPoints[kNumPatchPoints] = {0,  1,  7,  5,  2,  4,  9, 6, 16, 19,
                                                     14, 12, 15, 17, 11, 10, 3, 8, 13, 18};
    /// The rows of the second points inside of the corners.
    static constexpr int kOfCorners[4] = {5, 6, 10, 9};
};

/// \brief A Gregory patch as sums of points, the columns of a dense matrix.
template <typename REAL>
struct PatchBlock {
    /// Rows are padded with zeros to a multiple of it.
    static constexpr int kPadding = 32 / int(sizeof(REAL));
    static int GetPaddedSize(int numColumns) {
        return (numColumns + kPadding - 1) / kPadding * kPadding;
    }

    REAL const *weights; ///< row by row
    int const *columns;  ///< the points
    int numColumns;
    int lastColumn; ///< the largest of the columns
};

/// A coordinate in a patch, and the quadratic Bernstein polynomials there.
template <typename REAL>
struct PatchCoordinate {
    explicit PatchCoordinate(double s)
        : toStart(REAL(1 - s)),
          toEnd(REAL(s)), quadratic{toStart * toStart, 2 * toStart * toEnd, toEnd * toEnd} {}

    REAL toStart; ///< what the ends weigh
    REAL toEnd;
    REAL quadratic[3];
};

/// The weights of a patch's points, and the factors that turn derivatives by s and t into derivatives by u and v.
template <int NUM_DERIVATIVES, typename REAL>
struct PatchWeights {
    OPENSUBDIVHEX_INLINE explicit PatchWeights(PatchPlace const &place) : s(place.s), t(place.t) {
        // The share of the first of two points inside of a corner; where both distances are 0, half.
        auto const getShare = [](REAL ofFirst, REAL ofSecond) {
            constexpr REAL kLeast = std::numeric_limits<REAL>::min();
            return (ofFirst + kLeast) / (ofFirst + ofSecond + 2 * kLeast);
        };
        shares[0] = getShare(s.toEnd, t.toEnd);
        shares[1] = getShare(t.toEnd, s.toStart);
        shares[2] = getShare(s.toStart, t.toStart);
        shares[3] = getShare(t.toStart, s.toEnd);
        if constexpr (NUM_DERIVATIVES > 0) {
            constexpr int kDegree = 3;
            auto const &[toS, toT] = place.first;
            for (std::size_t i = 0; i < 2; ++i) {
                byUv[i][0] = REAL(kDegree * toS[i]);
                byUv[i][1] = REAL(kDegree * toT[i]);
            }
            if constexpr (NUM_DERIVATIVES > 1) {
                constexpr std::size_t kBy[3][2] = {{0, 0}, {0, 1}, {1, 1}};
                for (std::size_t k = 0; k < 3; ++k) {
                    auto const [i, j] = kBy[k];
                    byUvTwice[k][0] = REAL(kDegree * place.second[k][0]);
                    byUvTwice[k][1] = REAL(kDegree * place.second[k][1]);
                    byUvTwice[k][2] = REAL(2 * kDegree * (toS[i] * toS[j]));
                    byUvTwice[k][3] = REAL(kDegree * kDegree * (toS[i] * toT[j] + toS[j] * toT[i]));
                    byUvTwice[k][4] = REAL(2 * kDegree * (toT[i] * toT[j]));
                }
            }
        }
    }

    PatchCoordinate<REAL> const s;
    PatchCoordinate<REAL> const t;
    REAL shares[4]; ///< of the first point inside of each corner
    /// Factors of the derivatives by s and t, with factors of the degree; then of second ones by s, both, and t.
    REAL byUv[2][2];
    REAL byUvTwice[3][5];
};

/// \brief Writes the point of a patch, and its derivatives, in the order of FacePatches::Evaluate(), by what the machine has.
///
/// The rows of the block are weighed, and so its columns, whose points are summed up.  The same bits for any size and stride
/// of points.
///
/// \param points   those that columns name
/// \param results  the point, and its derivatives
template <int NUM_DERIVATIVES, typename REAL>
void SumUpPatch(PatchWeights<NUM_DERIVATIVES, REAL> const &weights, PatchBlock<REAL> const &block,
                REAL const *points, int size, std::ptrdiff_t stride, REAL *const *results);

/// @name The same with some instructions, which the machine must have
/// @{
template <int NUM_DERIVATIVES, typename REAL>
void SumUpPatchPortable(PatchWeights<NUM_DERIVATIVES, REAL> const &weights,
                        PatchBlock<REAL> const &block, REAL const *points, int size,
                        std::ptrdiff_t stride, REAL *const *results);
template <int NUM_DERIVATIVES, typename REAL>
void SumUpPatchAvx2(PatchWeights<NUM_DERIVATIVES, REAL> const &weights,
                    PatchBlock<REAL> const &block, REAL const *points, int size,
                    std::ptrdiff_t stride, REAL *const *results);
/// @}

} // namespace OpenSubdivHex::BfrExt::internal

#endif
