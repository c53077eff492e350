// SPDX-License-Identifier: Apache-2.0
//
// Steps in little memory are those that they are made of, to the bit, whatever their size.
#include "bfr_ext/cell/stepMatrix.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

namespace OpenSubdivHex::Regression::stepMatrixTest {

using BfrExt::internal::ChildStep;
using BfrExt::internal::StepMatrix;
using FarExt::internal::PatchRefinement;

namespace {

PatchRefinement makeStep(int numParentVerts, int numRows, int numWeights) {
    std::mt19937 random(unsigned(numParentVerts + numWeights));
    PatchRefinement step;
    step.numParentVerts = numParentVerts;
    step.firsts.push_back(0);
    for (int row = 0; row < numRows; ++row) {
        // Some rows are empty, and the last point and weight occur.
        for (int i = 0; i < row % 8; ++i) {
            step.verts.push_back(numParentVerts - 1 - int(random() % unsigned(numParentVerts)));
            step.weights.push_back(1.0 / (1 + int(random() % unsigned(numWeights))) - 0.125);
        }
        step.firsts.push_back(int(step.verts.size()));
    }
    step.verts.back() = numParentVerts - 1;
    step.weights.back() = -0.0;
    return step;
}

} // namespace

TEST(StepMatrixTest, HasTheEntriesOfTheStep) {
    struct Size {
        int numParentVerts;
        int numRows;
        int numWeights;
    };
    for (Size const &size : {Size{40, 40, 12}, Size{256, 80, 20}, Size{257, 80, 20},
                             Size{50, 400, 1000}, Size{65536, 100, 9}, Size{65537, 100, 9},
                             Size{100, 80000, 1000000}, Size{40, 40000, 12}}) {
        PatchRefinement const step = makeStep(size.numParentVerts, size.numRows, size.numWeights);
        StepMatrix const matrix(step);
        ASSERT_EQ(matrix.GetNumRows(), std::size_t(size.numRows));
        std::size_t k = 0;
        for (std::size_t row = 0; row < matrix.GetNumRows(); ++row) {
            ASSERT_EQ(k, std::size_t(step.firsts[row]));
            matrix.ForEachEntry(row, [&](std::size_t point, double weight) {
                ASSERT_EQ(point, std::size_t(step.verts[k]));
                ASSERT_EQ(weight, step.weights[k]);
                ASSERT_EQ(std::signbit(weight), std::signbit(step.weights[k]));
                ++k;
            });
        }
        ASSERT_EQ(k, step.verts.size());

        std::vector<double> left;
        left.reserve(std::size_t(size.numRows));
        for (int row = 0; row < size.numRows; ++row) {
            left.push_back(row % 5 - 1.75);
        }
        std::vector<double> expected;
        std::vector<double> result;
        step.ApplyLeft(left, expected);
        std::vector<int> rows(matrix.GetNumRows());
        std::iota(rows.begin(), rows.end(), 0);
        ChildStep(matrix, rows).ApplyLeft(left, result);
        ASSERT_EQ(result, expected);

        // A child may have its points in any order.
        std::reverse(left.begin(), left.end());
        std::reverse(rows.begin(), rows.end());
        ChildStep const child(matrix, rows);
        std::size_t first = 0;
        child.ForEachEntry(1, [&](std::size_t point, double) {
            ASSERT_EQ(point,
                      std::size_t(step.verts[std::size_t(step.firsts[rows.size() - 2]) + first++]));
        });
        child.ApplyLeft(left, result);
        for (std::size_t i = 0; i < result.size(); ++i) {
            ASSERT_NEAR(result[i], expected[i], 1e-6);
        }
    }
}

TEST(StepMatrixTest, MakesPointsOfAnySize) {
    auto const check = [](auto number, std::size_t size) {
        using Real = decltype(number);
        PatchRefinement const step = makeStep(30, 300, 20);
        StepMatrix const matrix(step);
        std::size_t const paddedSize = StepMatrix::GetPaddedSize(size);
        std::vector<Real> points(30 * paddedSize);
        for (std::size_t i = 0; i < 30; ++i) {
            std::vector<Real> point(size);
            for (std::size_t k = 0; k < size; ++k) {
                point[k] = Real(i + 1) / Real(k + 3);
            }
            StepMatrix::Pad(point.data(), size, &points[i * paddedSize]);
        }
        std::vector<Real> results(300 * paddedSize);
        matrix.Apply(points.data(), paddedSize, results.data());
        for (std::size_t row = 0; row < 300; ++row) {
            for (std::size_t k = 0; k < size; ++k) {
                Real sum = 0;
                matrix.ForEachEntry(row, [&](std::size_t point, double weight) {
                    sum += Real(weight) * points[point * paddedSize + k];
                });
                ASSERT_EQ(results[row * paddedSize + k], sum) << size << ", row " << row;
            }
        }
        // Rows beyond 255 take more than a byte.
        for (std::vector<int> const &rows : {std::vector<int>{255, 3, 0}, {256, 299, 1, 256}}) {
            ChildStep const child(matrix, rows);
            ASSERT_EQ(child.GetNumRows(), rows.size());
            std::vector<Real> copies(rows.size() * paddedSize);
            child.CopyPoints(results.data(), paddedSize, copies.data());
            for (std::size_t i = 0; i < rows.size(); ++i) {
                ASSERT_TRUE(std::equal(copies.begin() + std::ptrdiff_t(i * paddedSize),
                                       copies.begin() + std::ptrdiff_t((i + 1) * paddedSize),
                                       results.begin() +
                                           std::ptrdiff_t(std::size_t(rows[i]) * paddedSize)));
            }
        }
    };
    for (std::size_t const size : {1, 3, 4, 7}) {
        check(float(), size);
        check(double(), size);
    }
}

TEST(StepMatrixTest, MayBeEmpty) {
    PatchRefinement step;
    step.firsts.push_back(0);
    EXPECT_EQ(StepMatrix(step).GetNumRows(), 0U);
    // Rows may be, too.
    step.firsts.push_back(0);
    step.firsts.push_back(0);
    StepMatrix const matrix(step);
    EXPECT_EQ(matrix.GetNumRows(), 2U);
    double result[2 * StepMatrix::kPadding] = {1, 1, 1, 1, 1, 1, 1, 1};
    matrix.Apply(static_cast<double const *>(nullptr), StepMatrix::kPadding, result);
    EXPECT_EQ(*std::max_element(std::begin(result), std::end(result)), 0);
}

} // namespace OpenSubdivHex::Regression::stepMatrixTest
