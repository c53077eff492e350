// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_BFR_EXT_CELL_LANE_KERNEL_TEMPLATE_H
#define OPENSUBDIVHEX_BFR_EXT_CELL_LANE_KERNEL_TEMPLATE_H

#include "laneKernel.h"

#include <cstring>

// Included by one source file for each set of instructions, which must not share what the compiler
// makes of it: hence the unnamed namespace.
namespace OpenSubdivHex::BfrExt::internal {
namespace {

/// Numbers that are computed with at once, in a register where the machine has such.
template <typename REAL, std::size_t BYTES>
struct PlainLanes {
    static constexpr std::size_t kSize = BYTES / sizeof(REAL);

    PlainLanes operator*(REAL factor) const {
        PlainLanes result;
        for (std::size_t i = 0; i < kSize; ++i) {
            result.values[i] = values[i] * factor;
        }
        return result;
    }
    PlainLanes &operator+=(PlainLanes const &other) {
        for (std::size_t i = 0; i < kSize; ++i) {
            values[i] += other.values[i];
        }
        return *this;
    }

    REAL values[kSize];
};

template <typename REAL, std::size_t BYTES>
struct LanesOf {
    using Type = PlainLanes<REAL, BYTES>;
};
#if defined(__GNUC__)
template <>
struct LanesOf<float, 16> {
    using Type = float __attribute__((vector_size(16)));
};
template <>
struct LanesOf<double, 16> {
    using Type = double __attribute__((vector_size(16)));
};
template <>
struct LanesOf<float, 32> {
    using Type = float __attribute__((vector_size(32)));
};
template <>
struct LanesOf<double, 32> {
    using Type = double __attribute__((vector_size(32)));
};
template <>
struct LanesOf<float, 64> {
    using Type = float __attribute__((vector_size(64)));
};
template <>
struct LanesOf<double, 64> {
    using Type = double __attribute__((vector_size(64)));
};
#endif

/// NUM_ROWS rows of the product, in NUM_LANES registers each, from row and number first on.
template <std::size_t NUM_ROWS, std::size_t NUM_LANES, std::size_t BYTES, typename REAL>
void multiplyTile(LaneProduct<REAL> const &product, std::size_t row, std::size_t first) {
    using Lanes = typename LanesOf<REAL, BYTES>::Type;
    REAL const *const weights = product.matrix + row * product.numColumns;
    REAL const *from = product.block + first;
    static_assert(sizeof(Lanes) == BYTES);
    Lanes sums[NUM_ROWS][NUM_LANES] = {};
    for (std::size_t column = 0; column < product.numColumns; ++column) {
        Lanes lanes[NUM_LANES];
        std::memcpy(lanes, from, sizeof(lanes));
        from += product.blockStride;
        for (std::size_t i = 0; i < NUM_ROWS; ++i) {
            REAL const weight = weights[i * product.numColumns + column];
            for (std::size_t k = 0; k < NUM_LANES; ++k) {
                sums[i][k] += lanes[k] * weight;
            }
        }
    }
    for (std::size_t i = 0; i < NUM_ROWS; ++i) {
        std::memcpy(product.result + (row + i) * product.resultStride + first, sums[i],
                    sizeof(sums[i]));
    }
}

/// The same for all numbers of the rows.
template <std::size_t NUM_ROWS, std::size_t BYTES, typename REAL>
void multiplyRows(LaneProduct<REAL> const &product, std::size_t row) {
    constexpr std::size_t kSize = BYTES / sizeof(REAL);
    std::size_t first = 0;
    for (; first + 3 * kSize <= product.width; first += 3 * kSize) {
        multiplyTile<NUM_ROWS, 3, BYTES>(product, row, first);
    }
    for (; first + kSize <= product.width; first += kSize) {
        multiplyTile<NUM_ROWS, 1, BYTES>(product, row, first);
    }
    for (; first < product.width; ++first) {
        for (std::size_t i = row; i < row + NUM_ROWS; ++i) {
            REAL sum = 0;
            for (std::size_t column = 0; column < product.numColumns; ++column) {
                sum += product.block[column * product.blockStride + first] *
                       product.matrix[i * product.numColumns + column];
            }
            product.result[i * product.resultStride + first] = sum;
        }
    }
}

template <std::size_t BYTES, typename REAL>
void multiply(LaneProduct<REAL> const &product) {
    std::size_t row = 0;
    for (; row + 4 <= product.numRows; row += 4) {
        multiplyRows<4, BYTES>(product, row);
    }
    switch (product.numRows - row) {
    case 3:
        multiplyRows<3, BYTES>(product, row);
        break;
    case 2:
        multiplyRows<2, BYTES>(product, row);
        break;
    case 1:
        multiplyRows<1, BYTES>(product, row);
        break;
    default:
        break;
    }
}

} // namespace
} // namespace OpenSubdivHex::BfrExt::internal

#endif
