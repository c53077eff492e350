// SPDX-License-Identifier: Apache-2.0
//
// Curvature beside borders, compared with Catmull-Clark and Loop.
#include "besideLines.h"

#include <gtest/gtest.h>

#include <array>
#include <vector>

namespace OpenSubdivHex::Regression::besideLinesTest {

namespace {

using FarExt::FaceMask;
using FarExt::FirstStep;
using FarExt::HexSchemeOptions;
using FarExt::SchemeType;
namespace Sdc = OpenSubdiv::Sdc;

constexpr int kLevel = 5;
HexSchemeOptions const kSmooth{FaceMask::Smooth};
HexSchemeOptions const kTruncate{FaceMask::Smooth, SchemeType::Hexagonal, FirstStep::Truncate};

std::vector<double> measureTube(double rowHeight, AnyScheme const &scheme) {
    constexpr int kNumAround = 12;
    constexpr int kNumRows = 8;
    constexpr int kNumQuarters = 8;
    Sdc::Options options;
    options.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_EDGE_ONLY);
    Shape const tube = MakeTube(kNumAround, kNumRows, rowHeight);
    return MeasureTube(RefineSurface(tube, scheme, kLevel, MeshCenter(), options).back().mesh,
                       GetTubeRowHeight(kNumAround, rowHeight), kNumQuarters);
}

} // namespace

// A cylinder is what Catmull-Clark makes of a tube, up to its border; Smooth nearly does so.
TEST(BesideLines, Tubes) {
    struct Row {
        double rowHeight;
        double lowest; // of Smooth
        double highest;
    };
    for (Row const &row : {Row{1, 0.975, 1.02}, Row{0.5, 0.93, 1.08}}) {
        SCOPED_TRACE(row.rowHeight);
        for (double quarter : measureTube(row.rowHeight, kSmooth)) {
            EXPECT_GT(quarter, row.lowest);
            EXPECT_LT(quarter, row.highest);
        }
        for (double quarter : measureTube(row.rowHeight, Sdc::SCHEME_CATMARK)) {
            EXPECT_NEAR(quarter, 1, 0.001);
        }
    }
}

// Around a vertex that stayed, unevenness would grow from ring to ring.
TEST(BesideLines, HalfDisks) {
    constexpr int kNumRings = 3;
    using Rings = std::array<double, kNumRings>;
    struct Row {
        int numFaces;
        Rings truncated; // at most
        Rings loop;
    };
    for (Row const &row : {Row{2, {0.20, 0.25, 0.42}, {0.045, 0.029, 0.022}},
                           Row{3, {0.18, 0.18, 0.19}, {0.085, 0.040, 0.018}},
                           Row{4, {0.30, 0.26, 0.22}, {0.079, 0.037, 0.032}},
                           Row{5, {0.39, 0.31, 0.22}, {0.113, 0.157, 0.233}},
                           Row{6, {0.49, 0.45, 0.35}, {0.164, 0.321, 0.687}},
                           Row{8, {0.70, 0.69, 0.58}, {0.270, 0.637, 2.225}}}) {
        SCOPED_TRACE(row.numFaces);
        auto const measure = [&](AnyScheme const &scheme) {
            return MeasureHalfDisk(Tiling::Triangles, row.numFaces, scheme, kNumRings, kLevel);
        };
        std::vector<double> const truncated = measure(kTruncate);
        std::vector<double> const loop = measure(Sdc::SCHEME_LOOP);
        for (std::size_t ring = 0; ring < kNumRings; ++ring) {
            EXPECT_LT(truncated[ring], row.truncated[ring]);
            EXPECT_NEAR(loop[ring], row.loop[ring], 5e-4);
        }
    }
}

// Vertices of the border with two to four quads have masks of their own beside them.
TEST(BesideLines, HalfDisksOfQuads) {
    constexpr int kNumRings = 3;
    struct Row {
        int numFaces;
        std::array<double, kNumRings> rings; // at most
    };
    for (Row const &row :
         {Row{2, {0.11, 0.17, 0.12}}, Row{3, {0.205, 0.08, 0.08}}, Row{4, {0.33, 0.10, 0.11}}}) {
        SCOPED_TRACE(row.numFaces);
        std::vector<double> const rings =
            MeasureHalfDisk(Tiling::Quads, row.numFaces, kSmooth, kNumRings, kLevel);
        for (std::size_t ring = 0; ring < kNumRings; ++ring) {
            EXPECT_LT(rings[ring], row.rings[ring]) << ring;
        }
    }
}

} // namespace OpenSubdivHex::Regression::besideLinesTest
