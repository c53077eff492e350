// SPDX-License-Identifier: Apache-2.0
//
// Gregory patches by each kernel, against Bernstein polynomials in double precision.
#include "bfr_ext/cell/patchSums.h"
#include "bfr_ext/cell/placeKernel.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <random>
#include <vector>

namespace OpenSubdivHex::Regression::patchSumsTest {
namespace {

using BfrExt::internal::kNumPatchPoints;
using BfrExt::internal::PatchBlock;
using BfrExt::internal::PatchPlace;
using BfrExt::internal::PatchRow;
using BfrExt::internal::PatchSums;
using BfrExt::internal::RegisterAllocator;

using Weights = std::array<double, 4>;

/// The cubic polynomials, and their first and second derivatives.
std::array<Weights, 3> getBernstein(double s) {
    double const r = 1 - s;
    return {{{r * r * r, 3 * r * r * s, 3 * r * s * s, s * s * s},
             {-3 * r * r, 3 * r * (r - 2 * s), 3 * s * (2 * r - s), 3 * s * s},
             {6 * r, 6 * (s - 2 * r), 6 * (r - 2 * s), 6 * s}}};
}

/// One number of the 16 points of the bicubic patch at a place, row by row.
std::array<Weights, 4> getBicubic(std::vector<double> const &points, double s, double t) {
    auto const blend = [&](std::size_t corner, double first, double second) {
        double const share = first / (first + second);
        return points[5 * corner + 3] * share + points[5 * corner + 4] * (1 - share);
    };
    return {{{points[0], points[1], points[7], points[5]},
             {points[2], blend(0, s, t), blend(1, t, 1 - s), points[6]},
             {points[16], blend(3, 1 - t, s), blend(2, 1 - s, 1 - t), points[12]},
             {points[15], points[17], points[11], points[10]}}};
}

/// The point and its derivatives by u and v, in the order of results.
std::array<double, 6> evaluate(PatchPlace const &place, std::vector<double> const &points) {
    std::array<Weights, 3> const byS = getBernstein(place.s);
    std::array<Weights, 3> const byT = getBernstein(place.t);
    std::array<Weights, 4> const rows = getBicubic(points, place.s, place.t);
    auto const sum = [&](std::size_t orderS, std::size_t orderT) {
        double result = 0;
        for (std::size_t row = 0; row < 4; ++row) {
            for (std::size_t i = 0; i < 4; ++i) {
                result += byT[orderT][row] * byS[orderS][i] * rows[row][i];
            }
        }
        return result;
    };
    auto const &[s, t] = place.first;
    std::array<double, 6> results = {sum(0, 0), sum(1, 0) * s[0] + sum(0, 1) * t[0],
                                     sum(1, 0) * s[1] + sum(0, 1) * t[1]};
    constexpr std::size_t kBy[3][2] = {{0, 0}, {0, 1}, {1, 1}};
    for (std::size_t k = 0; k < 3; ++k) {
        auto const [i, j] = kBy[k];
        results[3 + k] = sum(2, 0) * s[i] * s[j] + sum(1, 1) * (s[i] * t[j] + s[j] * t[i]) +
                         sum(0, 2) * t[i] * t[j] + sum(1, 0) * place.second[k][0] +
                         sum(0, 1) * place.second[k][1];
    }
    return results;
}

/// A patch of some points, in any order.
template <typename REAL>
class RandomBlock {
public:
    static constexpr std::size_t kNumPoints = 100;

    RandomBlock(int numColumns, std::mt19937 &random) : _columns(kNumPoints) {
        std::iota(_columns.begin(), _columns.end(), 0);
        std::shuffle(_columns.begin(), _columns.end(), random);
        int const paddedSize = PatchBlock<REAL>::GetPaddedSize(numColumns);
        _columns.resize(std::size_t(numColumns));
        _columns.resize(std::size_t(paddedSize), _columns[0]);
        std::uniform_real_distribution<double> uniform(-1, 1);
        _weights.resize(std::size_t(kNumPatchPoints * paddedSize));
        for (int row = 0; row < kNumPatchPoints; ++row) {
            for (int i = 0; i < numColumns; ++i) {
                _weights[PatchBlock<REAL>::GetPlace(row, i)] = REAL(uniform(random) / numColumns);
            }
        }
    }

    PatchBlock<REAL> Get() const {
        return {_weights.data(), _columns.data(), int(_columns.size())};
    }
    /// No more than those that the columns name: what lies behind them must not be read.
    std::size_t GetNumPoints() const {
        return std::size_t(*std::max_element(_columns.begin(), _columns.end())) + 1;
    }

    /// One number of the points of the patch.
    std::vector<double> GetPatchPoints(std::vector<REAL> const &points, std::size_t stride,
                                       std::size_t number) const {
        std::vector<double> result(kNumPatchPoints);
        for (int row = 0; row < kNumPatchPoints; ++row) {
            for (int i = 0; i < int(_columns.size()); ++i) {
                auto const point = std::size_t(_columns[std::size_t(i)]);
                result[std::size_t(PatchRow::kPoints[row])] +=
                    double(_weights[PatchBlock<REAL>::GetPlace(row, i)]) *
                    double(points[point * stride + number]);
            }
        }
        // The first point inside of each corner is given by what it has more than the second.
        for (std::size_t corner = 0; corner < 4; ++corner) {
            result[5 * corner + 3] += result[5 * corner + 4];
        }
        return result;
    }

private:
    std::vector<int> _columns;
    std::vector<REAL, RegisterAllocator<REAL>> _weights;
};

template <int NUM_DERIVATIVES, typename REAL, typename KERNEL>
void expectSums(KERNEL const &kernel, double tolerance) {
    constexpr int kNumResults[] = {1, 3, 6};
    constexpr REAL kUntouched = -7;
    std::mt19937 random{unsigned(NUM_DERIVATIVES)};
    std::uniform_real_distribution<double> uniform(-1, 1);
    std::uniform_real_distribution<double> inside(0.01, 0.99);
    for (int const numColumns : {1, 7, 8, 26, 32, 45, 100}) {
        RandomBlock<REAL> const block(numColumns, random);
        PatchPlace place = {};
        place.s = inside(random);
        place.t = inside(random);
        for (auto *const pairs : {place.first, place.second}) {
            for (int i = 0; i < (pairs == place.first ? 2 : 3); ++i) {
                pairs[i] = {uniform(random), uniform(random)};
            }
        }
        for (std::size_t const size : {1, 3, 4, 7}) {
            for (std::size_t const stride : {size, size + 2}) {
                SCOPED_TRACE(testing::Message() << numColumns << " columns, " << size
                                                << " numbers, stride " << stride);
                std::vector<REAL> points(stride * (block.GetNumPoints() - 1) + size);
                for (REAL &number : points) {
                    number = REAL(uniform(random));
                }
                std::vector<std::vector<REAL>> results(6, std::vector<REAL>(size + 1, kUntouched));
                REAL *pointers[6];
                for (std::size_t i = 0; i < 6; ++i) {
                    pointers[i] = results[i].data();
                }
                PatchBlock<REAL> const all = block.Get();
                kernel(PatchSums<REAL>{place, NUM_DERIVATIVES, all, points.data(), int(size),
                                       std::ptrdiff_t(stride), pointers});
                for (std::size_t k = 0; k < size; ++k) {
                    std::array<double, 6> const expected =
                        evaluate(place, block.GetPatchPoints(points, stride, k));
                    for (std::size_t i = 0; i < 6; ++i) {
                        if (int(i) < kNumResults[NUM_DERIVATIVES]) {
                            EXPECT_NEAR(double(results[i][k]), expected[i], tolerance) << i;
                        } else {
                            EXPECT_EQ(results[i][k], kUntouched);
                        }
                    }
                }
                for (std::vector<REAL> const &result : results) {
                    EXPECT_EQ(result[size], kUntouched);
                }
            }
        }
    }
}

template <int NUM_DERIVATIVES, typename REAL>
void expectSumsOfKernels(double tolerance) {
    auto const kernels = BfrExt::internal::FindKernels<REAL>();
    for (std::size_t i = 0; i < kernels.size(); ++i) {
        SCOPED_TRACE(testing::Message() << "kernel " << i);
        expectSums<NUM_DERIVATIVES, REAL>(kernels[i].sumUpPatch, tolerance);
    }
    SCOPED_TRACE("of the machine");
    using Kernel = void (*)(PatchSums<REAL> const &);
    expectSums<NUM_DERIVATIVES, REAL>(Kernel(BfrExt::internal::SumUpPatch), tolerance);
}

} // namespace

TEST(PatchSums, AreThoseOfBernsteinPolynomials) {
    constexpr double kOfFloats = 5e-5;
    constexpr double kOfDoubles = 1e-12;
    expectSumsOfKernels<0, float>(kOfFloats);
    expectSumsOfKernels<1, float>(kOfFloats);
    expectSumsOfKernels<2, float>(kOfFloats);
    expectSumsOfKernels<0, double>(kOfDoubles);
    expectSumsOfKernels<1, double>(kOfDoubles);
    expectSumsOfKernels<2, double>(kOfDoubles);
}

} // namespace OpenSubdivHex::Regression::patchSumsTest
