// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_BFR_EXT_CELL_LANE_KERNEL_H
#define OPENSUBDIVHEX_BFR_EXT_CELL_LANE_KERNEL_H

#include <cstddef>

namespace OpenSubdivHex::BfrExt::internal {

/// \brief A dense matrix and a block of columns, whose product is wanted.
///
/// Each number of the result is a sum of its own, over the columns of the matrix in their order and
/// without fused products: so it does not depend on what stands beside it, nor on the machine.
template <typename REAL>
struct LaneProduct {
    REAL const *matrix; ///< row by row
    std::size_t numRows;
    std::size_t numColumns;
    REAL const *block; ///< numColumns rows, each of width numbers
    std::size_t blockStride;
    std::size_t width;
    REAL *result; ///< numRows rows, each of width numbers
    std::size_t resultStride;
};

/// Forms the product with the widest registers that the machine has.
void Multiply(LaneProduct<float> const &product);
/// \copydoc Multiply(LaneProduct<float> const &)
void Multiply(LaneProduct<double> const &product);

/// @name The same with some instructions, which the machine must have
/// @{
void MultiplyPortable(LaneProduct<float> const &product);
void MultiplyPortable(LaneProduct<double> const &product);
void MultiplyAvx2(LaneProduct<float> const &product);
void MultiplyAvx2(LaneProduct<double> const &product);
void MultiplyAvx512(LaneProduct<float> const &product);
void MultiplyAvx512(LaneProduct<double> const &product);
/// @}

} // namespace OpenSubdivHex::BfrExt::internal

#endif
