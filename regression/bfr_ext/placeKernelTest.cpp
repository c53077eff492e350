// SPDX-License-Identifier: Apache-2.0
//
// Sums of points at places, which are the same bits with any instructions that fuse products with them.
#include "bfr_ext/cell/placeKernel.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace OpenSubdivHex::Regression::placeKernelTest {

using BfrExt::internal::PlaceMatrix;
using BfrExt::internal::PlaceRun;
using BfrExt::internal::PlaceSums;

namespace {

/// The value of numbers that no sum overwrites.
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
        // Runs of 1 to 5 places, the last ones first.
        int const end = int(numPlaces);
        for (int row = 0; isPicked && row < end;) {
            int const blockEnd = (row / PlaceRun::kMaxBlock + 1) * PlaceRun::kMaxBlock;
            int const count = std::min({1 + row % 5, blockEnd - row, end - row});
            _runs.push_back({row, end - row - count, count});
            row += count + (row < 60 ? 2 : 60);
        }
    }

    std::vector<REAL> Form(Function function) const {
        std::vector<REAL> results(_numPlaces * _stride, REAL(kUntouched));
        PlaceSums<REAL> sums = {_points.data(), std::ptrdiff_t(_stride), _size,
                                nullptr,        results.data(),          std::ptrdiff_t(_stride)};
        if (!_indices.empty()) {
            sums.indices = _indices.data();
        }
        if (!_runs.empty()) {
            sums.runs = _runs.data();
            sums.numRuns = _runs.size();
        }
        function(_matrix, sums);
        return results;
    }

    /// \param isFused  whether products are fused with the sum
    std::vector<REAL> FormLiterally(bool isFused) const {
        std::vector<REAL> results(_numPlaces * _stride, REAL(kUntouched));
        auto const form = [&](std::size_t row, std::size_t place) {
            for (std::size_t k = 0; k < _size; ++k) {
                // Stored, so that no compiler fuses products with it.
                REAL volatile sum = 0;
                for (std::size_t i = 0; i < _stencils[row].size(); ++i) {
                    std::size_t const point = _indices.empty() ? i : std::size_t(_indices[i]);
                    REAL const weight = REAL(_stencils[row][i]);
                    REAL const number = _points[point * _stride + k];
                    REAL volatile const product = weight * number;
                    sum = isFused ? std::fma(weight, number, REAL(sum)) : sum + product;
                }
                results[place * _stride + k] = sum;
            }
        };
        for (std::size_t row = 0; _runs.empty() && row < _numPlaces; ++row) {
            form(row, row);
        }
        for (PlaceRun const &run : _runs) {
            for (int i = 0; i < run.count; ++i) {
                form(std::size_t(run.row + i), std::size_t(run.place + i));
            }
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
    std::vector<PlaceRun> _runs;
};

template <typename REAL>
void expectSameBits(Sums<REAL> const &sums) {
    auto const kernels = BfrExt::internal::FindKernels<REAL>();
    for (std::size_t i = 0; i < kernels.size(); ++i) {
        ASSERT_EQ(sums.Form(kernels[i].sumUpPlaces), sums.FormLiterally(i > 0)) << "kernel " << i;
    }
    ASSERT_EQ(sums.Form(BfrExt::internal::SumUpPlaces), sums.FormLiterally(kernels.size() > 1));
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
                        Sums<REAL> const sums(numPlaces, numPoints, size, gap, isPicked);
                        expectSameBits(sums);
                    }
                }
            }
        }
    }
}

} // namespace

TEST(PlaceKernelTest, BitsAreThoseOfSumsInOrder) {
    expectSameBits<float>();
    expectSameBits<double>();
}

} // namespace OpenSubdivHex::Regression::placeKernelTest
