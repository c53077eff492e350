// SPDX-License-Identifier: Apache-2.0
//
// Products of matrices and blocks, which are the same bits with any instructions.
#include "bfr_ext/cell/laneKernel.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace OpenSubdivHex::Regression {

using BfrExt::internal::LaneProduct;

namespace {

template <typename REAL>
class Product {
public:
    Product(std::size_t numRows, std::size_t numColumns, std::size_t width, std::size_t gap)
        : _numRows(numRows), _numColumns(numColumns), _width(width), _gap(gap) {
        std::mt19937 random{unsigned(numRows + numColumns * width)};
        std::uniform_real_distribution<REAL> uniform(-1, 1);
        for (std::vector<REAL> *const numbers : {&_matrix, &_block}) {
            numbers->resize(numColumns * std::max(numRows, width + gap));
            for (REAL &number : *numbers) {
                number = uniform(random);
            }
        }
    }

    // Numbers in the gaps stay as they are.
    std::vector<REAL> Multiply(void (*multiply)(LaneProduct<REAL> const &)) const {
        std::vector<REAL> result(_numRows * (_width + _gap), REAL(-7));
        multiply({_matrix.data(), _numRows, _numColumns, _block.data(), _width + _gap, _width,
                  result.data(), _width + _gap});
        return result;
    }

    std::vector<REAL> MultiplyLiterally() const {
        std::vector<REAL> result(_numRows * (_width + _gap), REAL(-7));
        for (std::size_t row = 0; row < _numRows; ++row) {
            for (std::size_t i = 0; i < _width; ++i) {
                // Stored, so that no compiler fuses it with the sum.
                REAL volatile sum = 0;
                for (std::size_t column = 0; column < _numColumns; ++column) {
                    REAL volatile const product =
                        _matrix[row * _numColumns + column] * _block[column * (_width + _gap) + i];
                    sum = sum + product;
                }
                result[row * (_width + _gap) + i] = sum;
            }
        }
        return result;
    }

private:
    std::size_t const _numRows;
    std::size_t const _numColumns;
    std::size_t const _width;
    std::size_t const _gap;
    std::vector<REAL> _matrix;
    std::vector<REAL> _block;
};

template <typename REAL>
void expectSameBits() {
    for (std::size_t numRows = 0; numRows <= 9; ++numRows) {
        for (std::size_t const numColumns : {1, 2, 31}) {
            for (std::size_t width = 0; width <= 100; width += width < 20 ? 1 : 7) {
                Product<REAL> const product(numRows, numColumns, width, width % 3);
                std::vector<REAL> const expected = product.MultiplyLiterally();
                ASSERT_EQ(product.Multiply(BfrExt::internal::Multiply), expected);
                ASSERT_EQ(product.Multiply(BfrExt::internal::MultiplyPortable), expected);
#if defined(__x86_64__) && defined(__GNUC__)
                if (__builtin_cpu_supports("avx2")) {
                    ASSERT_EQ(product.Multiply(BfrExt::internal::MultiplyAvx2), expected);
                }
                if (__builtin_cpu_supports("avx512f")) {
                    ASSERT_EQ(product.Multiply(BfrExt::internal::MultiplyAvx512), expected);
                }
#endif
            }
        }
    }
}

} // namespace

TEST(LaneKernelTest, AnyInstructionsGiveTheSameBits) {
    expectSameBits<float>();
    expectSameBits<double>();
}

} // namespace OpenSubdivHex::Regression
