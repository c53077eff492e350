// SPDX-License-Identifier: Apache-2.0
//
// The measures of smoothness on meshes whose angles and curvatures are known, and on refined ones
// against what the eigenvalues foretell.
#include "smoothness.h"
#include "spectrum.h"

#include "regression/shapes/featureShapes.h"

#include <gtest/gtest.h>

#include <cmath>

namespace OpenSubdivHex::Regression::smoothnessTest {

namespace {

using FarExt::FaceMask;
using FarExt::FirstStep;
using FarExt::HexSchemeOptions;
using FarExt::SchemeType;
namespace Sdc = OpenSubdiv::Sdc;

double const kPi = std::acos(-1.0);

/// Growth of the curvature from one step to the next, at the end.
double findLastGrowth(std::vector<double> const &curvatures) {
    return curvatures[curvatures.size() - 1] / curvatures[curvatures.size() - 2];
}

double computeGrowth(LocalSubdivision const &subdivision) {
    return ComputeSpectrum(subdivision).GetCurvatureGrowth();
}

/// Curvature at the tip of a bipyramid, level by level.
std::vector<double> measureTip(int n, AnyScheme const &scheme, int maxLevel) {
    std::vector<double> curvatures;
    for (SurfaceLevel const &level :
         RefineSurface(MakeSaddleBipyramid(n), scheme, maxLevel, {CenterKind::Vertex, n + 1})) {
        curvatures.push_back(MeasureCurvature(level.mesh, level.center));
    }
    return curvatures;
}

/// Catmull-Clark's eigenvalue of frequency m at a vertex with n faces.
double computeCatmarkEigenvalue(int n, int m) {
    double const c = std::cos(2 * kPi * m / n);
    return (5 + c + std::cos(kPi * m / n) * std::sqrt(2 * (9 + c))) / 16;
}

/// Loop's eigenvalue of frequency m > 0.
double computeLoopEigenvalue(int n, int m) { return (3 + 2 * std::cos(2 * kPi * m / n)) / 8; }

} // namespace

TEST(Smoothness, Prism) {
    PolygonMesh const mesh = RefineSurface(MakePrism(6), HexSchemeOptions(), 0)[0].mesh;
    Smoothness const smoothness = MeasureSmoothness(mesh);
    EXPECT_NEAR(smoothness.maxNormalAngle, kPi / 2, 1e-12);
    // Between a side, whose centroid is sqrt(3/4) from the axis, and the top, 0.8 above it.
    EXPECT_NEAR(smoothness.maxCurvature, kPi / 2 / std::hypot(std::sqrt(0.75), 0.8), 1e-12);
}

TEST(Smoothness, PrincipalCurvaturesOfAQuadric) {
    for (Tiling tiling : {Tiling::Triangles, Tiling::Quads, Tiling::Hexagons}) {
        Shape shape = MakeTiling(tiling, 6, 6);
        // The vertex next to the middle becomes the origin.
        double middle[2] = {0, 0};
        int const numVertices = shape.GetNumVertices();
        for (int i = 0; i < numVertices; ++i) {
            middle[0] += shape.positions[3 * i] / numVertices;
            middle[1] += shape.positions[3 * i + 1] / numVertices;
        }
        auto const getDistance = [&](int i) {
            return std::hypot(shape.positions[3 * i] - middle[0],
                              shape.positions[3 * i + 1] - middle[1]);
        };
        int vertex = 0;
        for (int i = 1; i < numVertices; ++i) {
            vertex = getDistance(i) < getDistance(vertex) ? i : vertex;
        }
        double const origin[2] = {shape.positions[3 * vertex], shape.positions[3 * vertex + 1]};
        constexpr double kSmaller = -0.02;
        constexpr double kLarger = 0.03;
        for (int i = 0; i < numVertices; ++i) {
            double const x = shape.positions[3 * i] - origin[0];
            double const y = shape.positions[3 * i + 1] - origin[1];
            double const along = 0.6 * x + 0.8 * y;
            double const across = 0.8 * x - 0.6 * y;
            shape.positions[3 * i + 2] =
                0.5 * (kSmaller * along * along + kLarger * across * across);
        }
        PolygonMesh const mesh = RefineSurface(shape, HexSchemeOptions(), 0)[0].mesh;
        auto const [smaller, larger] = EstimateCurvatures(mesh, vertex);
        EXPECT_NEAR(smaller, kSmaller, 2e-5);
        EXPECT_NEAR(larger, kLarger, 2e-5);
        EXPECT_GE(MeasureCurvature(mesh, {CenterKind::Vertex, vertex}), kLarger - 2e-5);
        EXPECT_LT(MeasureCurvature(mesh, {CenterKind::Vertex, vertex}), 1.1 * kLarger);
    }
}

TEST(Smoothness, CenterIsFollowed) {
    int const n = 5;
    auto const getSize = [&](AnyScheme const &scheme, CenterKind *kind) {
        SurfaceLevel const level =
            RefineSurface(MakeSaddleBipyramid(n), scheme, 2, {CenterKind::Vertex, n + 1}).back();
        *kind = level.center.kind;
        int const index = level.center.index;
        return level.center.kind == CenterKind::Face
                   ? level.mesh.GetFaceSize(index)
                   : level.mesh.vertexFirst[index + 1] - level.mesh.vertexFirst[index];
    };
    CenterKind kind;
    for (AnyScheme const &scheme : {AnyScheme(HexSchemeOptions()), AnyScheme(Sdc::SCHEME_CATMARK),
                                    AnyScheme(Sdc::SCHEME_LOOP)}) {
        EXPECT_EQ(getSize(scheme, &kind), n);
        EXPECT_EQ(kind, CenterKind::Vertex);
    }
    EXPECT_EQ(getSize(HexSchemeOptions{FaceMask::Cosine, SchemeType::DooSabin}, &kind), n);
    EXPECT_EQ(kind, CenterKind::Face);
    EXPECT_EQ(getSize(HexSchemeOptions{FaceMask::Cosine, SchemeType::Hexagonal, FirstStep::TriHex},
                      &kind),
              2 * n);
    EXPECT_EQ(kind, CenterKind::Face);
    EXPECT_THROW(RefineSurface(MakeSaddleBipyramid(n), Sdc::SCHEME_LOOP, 1, {CenterKind::Face, 0}),
                 std::runtime_error);
}

// Curvature at an irregular vertex changes from level to level by next / subdominant^2.
TEST(Smoothness, CurvatureGrowsAsForetold) {
    constexpr int kLevel = 6;
    for (int n : {8, 12}) {
        SCOPED_TRACE(n);
        double const catmark =
            computeCatmarkEigenvalue(n, 2) / std::pow(computeCatmarkEigenvalue(n, 1), 2);
        EXPECT_NEAR(findLastGrowth(measureTip(n, Sdc::SCHEME_CATMARK, kLevel)), catmark, 0.06);
        double const loop = computeLoopEigenvalue(n, 2) / std::pow(computeLoopEigenvalue(n, 1), 2);
        EXPECT_NEAR(findLastGrowth(measureTip(n, Sdc::SCHEME_LOOP, kLevel)), loop, 0.06);
        for (FaceMask mask : {FaceMask::Average, FaceMask::Cosine, FaceMask::Smooth}) {
            HexSchemeOptions const scheme{mask, SchemeType::Hexagonal, FirstStep::Same};
            Spectrum const spectrum =
                ComputeSpectrum(MakeLocalSubdivision(scheme, CenterKind::Vertex, n));
            // With Smooth it grows so slowly that what is bounded is still half of it.
            EXPECT_NEAR(findLastGrowth(measureTip(n, scheme, kLevel)),
                        spectrum.GetCurvatureGrowth(), mask == FaceMask::Smooth ? 0.08 : 0.06);
        }
    }
}

// OpenSubdiv's steps have the eigenvalues and limits that are known in closed form.
TEST(Smoothness, MatricesOfCatmullClarkAndLoop) {
    constexpr double kDigits = 1e-9;
    for (int n : {3, 4, 5, 6, 7, 8, 12, 16, 32}) {
        SCOPED_TRACE(n);
        LocalSubdivision const catmark = MakeLocalSubdivision(Sdc::SCHEME_CATMARK, n);
        ASSERT_EQ(catmark.GetNumVertices(), 2 * n + 1);
        EXPECT_NEAR(ComputeSpectrum(catmark).subdominant, computeCatmarkEigenvalue(n, 1), kDigits);
        Eigen::VectorXd const limit = ComputeLimitMask(catmark);
        EXPECT_NEAR(limit(0), double(n) / (n + 5), kDigits);
        for (int i = 0; i < n; ++i) {
            std::vector<int> const &face = catmark.faces[i];
            EXPECT_NEAR(limit(face[1]), 4.0 / (n * (n + 5)), kDigits);
            EXPECT_NEAR(limit(face[2]), 1.0 / (n * (n + 5)), kDigits);
        }

        LocalSubdivision const loop = MakeLocalSubdivision(Sdc::SCHEME_LOOP, n);
        ASSERT_EQ(loop.GetNumVertices(), n + 1);
        EXPECT_NEAR(ComputeSpectrum(loop).subdominant, computeLoopEigenvalue(n, 1), kDigits);
        double const beta = (0.625 - std::pow(computeLoopEigenvalue(n, 1), 2)) / n;
        EXPECT_NEAR(ComputeLimitMask(loop)(0), 3 / (3 + 8 * n * beta), kDigits);
        for (LocalSubdivision const *one : {&catmark, &loop}) {
            EXPECT_TRUE(IsRegular(*one, ComputeCharacteristicMap(*one)));
        }
    }
}

// The factor by which curvature changes from level to level at a vertex of valence n: at most 1 for
// any n with a truncation first, up to seven without; with Catmull-Clark up to four, with Loop up to
// six.
TEST(Smoothness, GrowthBesideCatmullClarkAndLoop) {
    constexpr double kDigits = 1e-9;
    HexSchemeOptions const scheme{FaceMask::Smooth};
    HexSchemeOptions const truncateFirst{FaceMask::Smooth, SchemeType::Hexagonal,
                                         FirstStep::Truncate};
    for (int n : {3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 16, 24, 32, 64}) {
        SCOPED_TRACE(n);
        double const smooth = computeGrowth(MakeLocalSubdivision(scheme, CenterKind::Vertex, n));
        double const truncated =
            computeGrowth(MakeLocalSubdivision(truncateFirst, CenterKind::Vertex, n));
        double const catmark = computeGrowth(MakeLocalSubdivision(Sdc::SCHEME_CATMARK, n));
        double const loop = computeGrowth(MakeLocalSubdivision(Sdc::SCHEME_LOOP, n));
        EXPECT_NEAR(truncated, 1, kDigits);
        if (n <= 7) {
            EXPECT_NEAR(smooth, 1, kDigits);
        } else {
            EXPECT_LT(smooth, 0.9 * std::min(catmark, loop));
            EXPECT_LT(smooth, 1.3);
        }
        if (n <= 4) {
            EXPECT_LT(catmark, 1 + kDigits);
        } else {
            EXPECT_NEAR(catmark,
                        computeCatmarkEigenvalue(n, 2) /
                            std::pow(computeCatmarkEigenvalue(n, 1), 2),
                        kDigits);
            EXPECT_GT(catmark, 1.12);
        }
        if (n <= 6) {
            EXPECT_NEAR(loop, 1, kDigits);
        } else {
            EXPECT_NEAR(loop,
                        computeLoopEigenvalue(n, 2) / std::pow(computeLoopEigenvalue(n, 1), 2),
                        kDigits);
            EXPECT_GT(loop, 1.13);
        }
    }
}

// Curvature over more steps than a mesh can be refined, as foretold.
TEST(Smoothness, TracedCurvature) {
    for (int order : {3, 5, 6, 8, 12}) {
        SCOPED_TRACE(order);
        for (FaceMask mask : {FaceMask::Cosine, FaceMask::Smooth}) {
            // With a tri-hex step first it grows less and less, by the ratio of frequency 2's
            // second eigenvalue to its first, 1/4: the sum of what is to come is finite.
            LocalSubdivision const face = MakeLocalSubdivision(
                {mask, SchemeType::Hexagonal, FirstStep::TriHex}, CenterKind::Vertex, order);
            std::vector<double> values;
            for (Eigenvalue const &eigenvalue : ComputeEigenvalues(face)) {
                if (eigenvalue.frequency == 2) {
                    values.push_back(std::abs(eigenvalue.value));
                }
            }
            std::vector<double> const bounded = TraceCurvature(face, 16);
            double const growth = bounded[16] - bounded[15];
            if (order == 3) {
                EXPECT_NEAR(bounded[16], bounded[0], 1e-4); // the regular honeycomb
            } else {
                EXPECT_NEAR(growth / (bounded[15] - bounded[14]), values[1] / 0.25, 0.03);
                EXPECT_LT(growth, 0.98 * (bounded[15] - bounded[14]));
            }

            // ... and without, it grows at vertices with more than three faces, with Smooth with more
            // than seven, slowly.
            LocalSubdivision const vertex = MakeLocalSubdivision(
                {mask, SchemeType::Hexagonal, FirstStep::Same}, CenterKind::Vertex, order);
            std::vector<double> const growing = TraceCurvature(vertex, order < 8 ? 14 : 40);
            EXPECT_NEAR(findLastGrowth(growing), ComputeSpectrum(vertex).GetCurvatureGrowth(),
                        0.01);
        }
    }
}

// With Doo-Sabin's mask the eigenvalues are the same, but 1/4 is there twice with one eigenvector:
// every step adds as much curvature again.
TEST(Smoothness, DooSabinAddsCurvature) {
    for (int order : {5, 6, 8, 12}) {
        LocalSubdivision const face = MakeLocalSubdivision(
            {FaceMask::Cosine, SchemeType::DooSabin, FirstStep::Same}, CenterKind::Vertex, order);
        EXPECT_NEAR(ComputeSpectrum(face).GetCurvatureGrowth(), 1, 1e-6);
        std::vector<double> const curvatures = TraceCurvature(face, 16);
        double const growth = curvatures[16] - curvatures[15];
        EXPECT_GT(growth, 0.1);
        EXPECT_NEAR(growth / (curvatures[15] - curvatures[14]), 1, 0.01) << order;
    }
}

// Where all is regular, the largest curvature of a mesh settles with Cosine and Smooth, and angles
// between neighbouring normals fall by half; with Average curvature grows and angles fall by
// 2^-0.68.
TEST(Smoothness, MasksOnTheRegularHoneycomb) {
    constexpr int kLevel = 6;
    auto const findGrowth = [](FaceMask mask) {
        std::vector<SurfaceLevel> const levels =
            RefineSurface(GetShape("hexTorus"), HexSchemeOptions{mask}, kLevel);
        Smoothness const before = MeasureSmoothness(levels[kLevel - 1].mesh);
        Smoothness const after = MeasureSmoothness(levels[kLevel].mesh);
        return Smoothness{after.maxNormalAngle / before.maxNormalAngle,
                          after.maxCurvature / before.maxCurvature};
    };
    for (FaceMask mask : {FaceMask::Cosine, FaceMask::Smooth}) {
        Smoothness const growth = findGrowth(mask);
        EXPECT_NEAR(growth.maxNormalAngle, 0.5, 0.02);
        EXPECT_NEAR(growth.maxCurvature, 1, 0.05);
    }
    Smoothness const growth = findGrowth(FaceMask::Average);
    EXPECT_NEAR(growth.maxNormalAngle, std::pow(2, -0.68), 0.04);
    EXPECT_GT(growth.maxCurvature, 1.2);
}

} // namespace OpenSubdivHex::Regression::smoothnessTest
