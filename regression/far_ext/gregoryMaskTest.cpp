// SPDX-License-Identifier: Apache-2.0
//
// The points of Gregory patches beside a curve: what they are sums of, and that tangent planes agree.
#include "far_ext/patch/gregoryMask.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <cmath>

namespace OpenSubdivHex::Regression::gregoryMaskTest {

using FarExt::internal::AddCurvePoints;
using FarExt::internal::AddInnerPoints;
using FarExt::internal::AddKitePoints;
using FarExt::internal::CurveNeighbor;
using FarExt::internal::CurveShape;
using FarExt::internal::GregoryMask;
using FarExt::internal::MakeHalfKiteSide;
using FarExt::internal::MakeKiteSide;

namespace {

using Vector = Eigen::Vector3d;

// Limits that nothing relates.
struct Limits {
    Limits() {
        for (int i = 0; i < GregoryMask::kNumTerms; ++i) {
            terms[i] = Vector(std::sin(1.3 * i + 0.4), std::cos(2.1 * i), std::sin(0.7 * i * i));
        }
    }
    Vector Sum(GregoryMask::Point const &point) const {
        Vector result = Vector::Zero();
        for (int i = 0; i < GregoryMask::kNumTerms; ++i) {
            result += point[std::size_t(i)] * terms[i];
        }
        return result;
    }
    Vector GetDerivative(int row, double angle) const {
        return std::cos(angle) * terms[3 * row + 1] + std::sin(angle) * terms[3 * row + 2];
    }

    Vector terms[GregoryMask::kNumTerms];
};

Vector cubic(Vector const p[4], double u) {
    double const v = 1 - u;
    return v * v * v * p[0] + 3 * u * v * v * p[1] + 3 * u * u * v * p[2] + u * u * u * p[3];
}

} // namespace

// Weights of points sum to 1, also those of kites.
TEST(GregoryMask, PointsAreAffine) {
    CurveShape const shape = {{{0.3, 1.2}, {2.5, 0.8}}, 0.1};
    CurveNeighbor const neighbors[2] = {{1.9, 1.1}, {2.2, 0.7}};
    GregoryMask mask;
    AddCurvePoints(shape, mask);
    AddInnerPoints(shape, neighbors, 1, false, mask);
    AddInnerPoints(shape, neighbors, -1, true, mask);
    for (auto const &side : {MakeKiteSide(5, 2), MakeHalfKiteSide(3, 0), MakeHalfKiteSide(6, 2)}) {
        AddKitePoints(shape, neighbors, {{0.9, 1.1}, 0.2}, side, 1, mask);
    }
    ASSERT_EQ(mask.points.size(), 2u + 2u + 2u + 3 * 15u);
    for (GregoryMask::Point const &point : mask.points) {
        double sum = 0;
        for (std::size_t i = 0; i < point.size(); i += 3) {
            sum += point[i];
        }
        EXPECT_NEAR(sum, 1, 1e-14);
    }
}

// Whatever angles and lengths both patches have, their derivatives across a curve and that along it lie in
// one plane at every place.
TEST(GregoryMask, TangentPlanesAgree) {
    Limits const limits;
    for (double unit : {1.0, 1.7}) {
        // Seen from the left patch, and from the right one, which has end 1 first.
        CurveShape left = {{{0.4, 1.3}, {2.9, 0.9}}, 0.2};
        left.ends[0].unit = unit;
        left.ends[1].unit = 1 / unit;
        left.unit = 2;
        CurveShape right = left;
        std::swap(right.ends[0], right.ends[1]);
        CurveNeighbor const ofLeft[2] = {{2.0, 1.1}, {1.4, 0.6}};
        CurveNeighbor const ofRight[2] = {{1.8, 0.9}, {2.3, 1.2}};
        GregoryMask mask;
        AddCurvePoints(left, mask);
        AddInnerPoints(left, ofLeft, 1, false, mask);
        AddInnerPoints(right, ofRight, -1, true, mask);
        Vector points[6];
        for (int i = 0; i < 6; ++i) {
            points[i] = limits.Sum(mask.points[std::size_t(i)]);
        }
        Vector const curve[4] = {limits.terms[0], points[0], points[1], limits.terms[3]};
        EXPECT_LT((points[0] - limits.terms[0] - 1.3 / 3 * limits.GetDerivative(0, 0.4)).norm(),
                  1e-14);
        EXPECT_LT((points[1] - limits.terms[3] - 0.9 / 3 * limits.GetDerivative(1, 2.9)).norm(),
                  1e-14);
        // The derivative into each patch: thirds of the other sides, and inner points.
        Vector const intoLeft[4] = {1.1 / 3 * limits.GetDerivative(0, 0.4 + 2.0),
                                    points[2] - curve[1], points[3] - curve[2],
                                    0.6 / 3 * limits.GetDerivative(1, 2.9 - 1.4)};
        Vector const intoRight[4] = {1.2 / 3 * limits.GetDerivative(0, 0.4 - 2.3),
                                     points[5] - curve[1], points[4] - curve[2],
                                     0.9 / 3 * limits.GetDerivative(1, 2.9 + 1.8)};
        for (double u : {0.0, 0.1, 0.37, 0.5, 0.8, 1.0}) {
            double const v = 1 - u;
            Vector const along = v * v * (curve[1] - curve[0]) + 2 * u * v * (curve[2] - curve[1]) +
                                 u * u * (curve[3] - curve[2]);
            Vector const a = cubic(intoLeft, u).normalized();
            Vector const b = cubic(intoRight, u).normalized();
            EXPECT_NEAR(along.normalized().cross(a).dot(b), 0, 1e-13) << "at " << u;
            EXPECT_GT(along.cross(a).norm(), 1e-3);
        }
    }
}

} // namespace OpenSubdivHex::Regression::gregoryMaskTest
