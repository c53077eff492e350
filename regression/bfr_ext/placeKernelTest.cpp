// SPDX-License-Identifier: Apache-2.0
//
// Sums of points at places, which are the same bits with any instructions.
#include "bfr_ext/cell/placeKernel.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace OpenSubdivHex::Regression {

using BfrExt::internal::PlaceMatrix;
using BfrExt::internal::PlaceOfRow;
using BfrExt::internal::PlaceSums;

namespace {

/// What stands where no sum goes.
constexpr int kUntouched = -7;

template <typename REAL>
class Sums {
public:
    using Function = void (*)(PlaceMatrix<REAL> const &, PlaceSums<REAL> const &);

    /// \param gap       numbers between points, and between results
    /// \param isPicked  whether the matrix has some of the points in another order, and some of its
    ///                  rows are wanted
    Sums(std::size_t numPlaces, std::size_t numPoints, std::size_t size, std::size_t gap,
         bool isPicked)
        : _numPlaces(numPlaces), _size(size), _stride(size + gap), _matrix(numPlaces, numPoints) {
        std::mt19937 random{unsigned(numPlaces + numPoints * size)};
        std::uniform_real_distribution<double> uniform(-1, 1);
        _points.resize(2 * numPoints * _stride);
        for (REAL &number : _points) {
            number = REAL(uniform(random));
        }
        for (std::size_t place = 0; place < numPlaces; ++place) {
            _stencils.emplace_back(numPoints);
            for (double &weight : _stencils.back()) {
                weight = uniform(random);
            }
            _matrix.Set(place, _stencils.back());
        }
        for (std::size_t i = 0; isPicked && i < numPoints; ++i) {
            _indices.push_back(int(2 * (numPoints - 1 - i)));
        }
        for (std::size_t row = 0; isPicked && row < numPlaces; row += row < 40 ? 3 : 60) {
            _rows.push_back({int(row), int(numPlaces - 1 - row)});
        }
    }

    std::vector<REAL> Form(Function function) const {
        std::vector<REAL> results(_numPlaces * _stride, REAL(kUntouched));
        PlaceSums<REAL> sums = {_points.data(), std::ptrdiff_t(_stride), _size,
                                nullptr,        results.data(),          std::ptrdiff_t(_stride)};
        if (!_indices.empty()) {
            sums.indices = _indices.data();
        }
        if (!_rows.empty()) {
            sums.rows = _rows.data();
            sums.numRows = _rows.size();
        }
        function(_matrix, sums);
        return results;
    }

    std::vector<REAL> FormLiterally() const {
        std::vector<REAL> results(_numPlaces * _stride, REAL(kUntouched));
        auto const form = [&](std::size_t row, std::size_t place) {
            for (std::size_t k = 0; k < _size; ++k) {
                // Stored, so that no compiler fuses it with the sum.
                REAL volatile sum = 0;
                for (std::size_t i = 0; i < _stencils[row].size(); ++i) {
                    std::size_t const point = _indices.empty() ? i : std::size_t(_indices[i]);
                    REAL volatile const product =
                        REAL(_stencils[row][i]) * _points[point * _stride + k];
                    sum = sum + product;
                }
                results[place * _stride + k] = sum;
            }
        };
        for (std::size_t row = 0; _rows.empty() && row < _numPlaces; ++row) {
            form(row, row);
        }
        for (PlaceOfRow const &row : _rows) {
            form(std::size_t(row.row), std::size_t(row.place));
        }
        return results;
    }

private:
    std::size_t const _numPlaces;
    std::size_t const _size;
    std::size_t const _stride;
    PlaceMatrix<REAL> _matrix;
    std::vector<std::vector<double>> _stencils;
    std::vector<REAL> _points;
    std::vector<int> _indices;
    std::vector<PlaceOfRow> _rows;
};

template <typename REAL>
void expectSameBits(Sums<REAL> const &sums) {
    std::vector<REAL> const expected = sums.FormLiterally();
    ASSERT_EQ(sums.Form(BfrExt::internal::SumUpPlaces), expected);
    ASSERT_EQ(sums.Form(BfrExt::internal::SumUpPlacesPortable), expected);
#if defined(__x86_64__) && defined(__GNUC__)
    if (__builtin_cpu_supports("avx2")) {
        ASSERT_EQ(sums.Form(BfrExt::internal::SumUpPlacesAvx2), expected);
    }
    if (__builtin_cpu_supports("avx512f")) {
        ASSERT_EQ(sums.Form(BfrExt::internal::SumUpPlacesAvx512), expected);
    }
#endif
}

template <typename REAL>
void expectSameBits() {
    for (std::size_t numPlaces = 0; numPlaces <= 210; numPlaces += numPlaces < 50 ? 1 : 7) {
        for (std::size_t const numPoints : {1, 2, 31}) {
            for (std::size_t const size : {1, 3, 4, 6, 8}) {
                for (std::size_t const gap : {0, 2}) {
                    SCOPED_TRACE(std::to_string(numPlaces) + " places, " +
                                 std::to_string(numPoints) + " points of " + std::to_string(size) +
                                 " numbers");
                    for (bool const isPicked : {false, true}) {
                        expectSameBits(Sums<REAL>(numPlaces, numPoints, size, gap, isPicked));
                    }
                }
            }
        }
    }
}

} // namespace

TEST(PlaceKernelTest, AnyInstructionsGiveTheSameBits) {
    expectSameBits<float>();
    expectSameBits<double>();
}

} // namespace OpenSubdivHex::Regression
