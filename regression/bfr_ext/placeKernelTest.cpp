// SPDX-License-Identifier: Apache-2.0
//
// Sums of points at places, which are the same bits with any instructions that fuse products with them.
#include "bfr_ext/cell/placeKernel.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

namespace OpenSubdivHex::Regression::placeKernelTest {

using BfrExt::internal::PlaceMatrix;
using BfrExt::internal::PlaceRun;
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

    /// Derivatives by u and behind them those by v, which this matrix and one of other stencils make.
    using DerivativeFunction = void (*)(std::array<PlaceMatrix<REAL>, 2> const &,
                                        BfrExt::internal::DerivativeSums<REAL> const &);
    std::vector<REAL> FormDerivatives(DerivativeFunction function) const {
        std::size_t const numResults = _numPlaces * _stride;
        std::vector<REAL> results(2 * numResults, REAL(kUntouched));
        std::array<PlaceMatrix<REAL>, 2> const matrices = {_matrix, makeOther()};
        function(matrices, {_points.data(),
                            std::ptrdiff_t(_stride),
                            _size,
                            _indices.empty() ? nullptr : _indices.data(),
                            {{kFactors[0][0], kFactors[0][1]}, {kFactors[1][0], kFactors[1][1]}},
                            {results.data(), results.data() + numResults},
                            std::ptrdiff_t(_stride),
                            _runs.empty() ? nullptr : _runs.data(),
                            _runs.size()});
        return results;
    }

    /// The same from the sums of each matrix.
    std::vector<REAL> JoinSums(Function function) const {
        Sums other(*this);
        other._matrix = makeOther();
        std::vector<REAL> const sums[2] = {Form(function), other.Form(function)};
        std::vector<REAL> results;
        for (std::size_t derivative = 0; derivative < 2; ++derivative) {
            for (std::size_t i = 0; i < sums[0].size(); ++i) {
                REAL volatile const first = sums[0][i] * kFactors[0][derivative];
                REAL volatile const second = sums[1][i] * kFactors[1][derivative];
                results.push_back(sums[0][i] == REAL(kUntouched) ? REAL(kUntouched)
                                                                 : first + second);
            }
        }
        return results;
    }

    /// The sums of several choices of the points, each of all places.
    using ItemFunction = void (*)(PlaceMatrix<REAL> const &,
                                  BfrExt::internal::ItemSums<REAL> const &);
    std::vector<REAL> FormItems(ItemFunction function, std::size_t numItems) const {
        std::vector<std::vector<int>> const indices = makeItems(numItems);
        std::size_t const sizeOfItem = _numPlaces * _stride;
        std::vector<REAL> results(numItems * sizeOfItem, REAL(kUntouched));
        std::vector<typename BfrExt::internal::ItemSums<REAL>::Item> items;
        for (std::size_t item = 0; item < numItems; ++item) {
            // Every other one is written from its end on.
            auto const stride = std::ptrdiff_t(_stride);
            REAL *const begin = results.data() + item * sizeOfItem;
            items.push_back({indices[item].data(),
                             item % 2 == 0 ? begin : begin + sizeOfItem - _stride,
                             item % 2 == 0 ? stride : -stride});
        }
        function(_matrix, {_points.data(), std::ptrdiff_t(_stride), _size, items.data(), numItems});
        return results;
    }

    /// The same one by one.
    std::vector<REAL> FormItemByItem(Function function, std::size_t numItems) const {
        std::size_t const sizeOfItem = _numPlaces * _stride;
        std::vector<REAL> results(numItems * sizeOfItem, REAL(kUntouched));
        std::vector<std::vector<int>> const indices = makeItems(numItems);
        for (std::size_t item = 0; item < numItems; ++item) {
            auto const stride = std::ptrdiff_t(_stride);
            REAL *const begin = results.data() + item * sizeOfItem;
            function(_matrix, {_points.data(), stride, _size, indices[item].data(),
                               item % 2 == 0 ? begin : begin + sizeOfItem - _stride,
                               item % 2 == 0 ? stride : -stride});
        }
        return results;
    }

    /// \param isFused  whether products are fused with the sum
    std::vector<REAL> FormLiterally(bool isFused) const {
        std::vector<REAL> results(_numPlaces * _stride, REAL(kUntouched));
        auto const form = [&](std::size_t row, std::size_t place) {
            for (std::size_t k = 0; k < _size; ++k) {
                // Stored, so that no compiler fuses it with the sum.
                REAL volatile sum = 0;
                for (std::size_t i = 0; i < _stencils[row].size(); ++i) {
                    std::size_t const point = _indices.empty() ? i : std::size_t(_indices[i]);
                    REAL const weight = REAL(_stencils[row][i]);
                    REAL const number = _points[point * _stride + k];
                    REAL volatile const product = weight * number;
                    sum = isFused ? std::fma(weight, number, sum) : sum + product;
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
    static constexpr REAL kFactors[2][2] = {{REAL(0.3), REAL(-1.7)}, {REAL(2.1), REAL(0.9)}};

    // A matrix of the stencils in another order.
    PlaceMatrix<REAL> makeOther() const {
        PlaceMatrix<REAL> other(_numPlaces, _matrix.GetNumPoints());
        for (std::size_t place = 0; place < _numPlaces; ++place) {
            std::vector<double> stencil = _stencils[_numPlaces - 1 - place];
            std::reverse(stencil.begin(), stencil.end());
            other.Set(place, stencil);
        }
        return other;
    }

    // Which points each of some items has.
    std::vector<std::vector<int>> makeItems(std::size_t numItems) const {
        std::vector<std::vector<int>> items(numItems);
        for (std::size_t item = 0; item < numItems; ++item) {
            for (std::size_t i = 0; i < _matrix.GetNumPoints(); ++i) {
                items[item].push_back(int((i + item) % (2 * _matrix.GetNumPoints())));
            }
        }
        return items;
    }

    std::size_t const _numPlaces;
    std::size_t const _size;
    std::size_t const _stride;
    PlaceMatrix<REAL> _matrix;
    std::vector<std::vector<double>> _stencils;
    std::vector<REAL> _points;
    std::vector<int> _indices;
    std::vector<PlaceRun> _runs;
};

/// The functions of a set of instructions.
template <typename REAL>
struct Kernel {
    typename Sums<REAL>::Function form;
    typename Sums<REAL>::DerivativeFunction formDerivatives;
    typename Sums<REAL>::ItemFunction formItems;
    bool isFused;
};

/// Those that the machine has, the widest ones last.
template <typename REAL>
std::vector<Kernel<REAL>> getKernels() {
    using namespace BfrExt::internal;
    std::vector<Kernel<REAL>> kernels = {
        {SumUpPlacesPortable, SumUpPlacesPortable, SumUpPlacesPortable, false}};
#if defined(__x86_64__) && defined(__GNUC__)
    if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) {
        kernels.push_back({SumUpPlacesAvx2, SumUpPlacesAvx2, SumUpPlacesAvx2, true});
    }
    if (__builtin_cpu_supports("avx512f")) {
        kernels.push_back({SumUpPlacesAvx512, SumUpPlacesAvx512, SumUpPlacesAvx512, true});
    }
#endif
    kernels.push_back({SumUpPlaces, SumUpPlaces, SumUpPlaces, kernels.back().isFused});
    return kernels;
}

template <typename REAL>
void expectSameBits(Sums<REAL> const &sums) {
    for (Kernel<REAL> const &kernel : getKernels<REAL>()) {
        ASSERT_EQ(sums.Form(kernel.form), sums.FormLiterally(kernel.isFused));
        ASSERT_EQ(sums.FormDerivatives(kernel.formDerivatives), sums.JoinSums(kernel.form));
    }
}

template <typename REAL>
void expectSameBitsOfItems(Sums<REAL> const &sums, std::size_t numItems) {
    for (Kernel<REAL> const &kernel : getKernels<REAL>()) {
        ASSERT_EQ(sums.FormItems(kernel.formItems, numItems),
                  sums.FormItemByItem(kernel.form, numItems));
    }
}

template <typename REAL>
void expectSameBitsOfItems() {
    for (std::size_t const numPlaces : {1, 2, 10, 16, 17, 48, 50, 100}) {
        for (std::size_t const size : {1, 3, 4, 6}) {
            for (std::size_t const gap : {0, 2}) {
                for (std::size_t numItems = 1; numItems <= 8; ++numItems) {
                    SCOPED_TRACE(std::to_string(numItems) + " times " + std::to_string(numPlaces) +
                                 " places, points of " + std::to_string(size) + " numbers");
                    expectSameBitsOfItems(Sums<REAL>(numPlaces, 19, size, gap, false), numItems);
                }
            }
        }
    }
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

TEST(PlaceKernelTest, ItemsAreTheSameTogether) {
    expectSameBitsOfItems<float>();
    expectSameBitsOfItems<double>();
}

} // namespace OpenSubdivHex::Regression::placeKernelTest
