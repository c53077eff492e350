// SPDX-License-Identifier: Apache-2.0
//
// How uneven curvature is around a vertex by its valence, beside Catmull-Clark and Loop.
#include "ripple.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

namespace OpenSubdivHex::Regression::rippleTest {

namespace {

using FarExt::FaceMask;
using FarExt::FirstStep;
using FarExt::HexSchemeOptions;
using FarExt::SchemeType;
namespace Sdc = OpenSubdiv::Sdc;

HexSchemeOptions const kSmooth{FaceMask::Smooth};
HexSchemeOptions const kTruncate{FaceMask::Smooth, SchemeType::Hexagonal, FirstStep::Truncate};

constexpr int kLevel = 5;
constexpr int kNumRings = 2;

/// The larger one of both rings.
double measureRipple(Tiling tiling, int valence, AnyScheme const &scheme, Quadratic quadratic) {
    std::vector<double> const rings =
        MeasureRipple(tiling, valence, scheme, quadratic, kNumRings, kLevel);
    return *std::max_element(rings.begin(), rings.end());
}

} // namespace

TEST(Ripple, VertexDisks) {
    constexpr int kNumDiskRings = 3;
    for (Tiling tiling : {Tiling::Triangles, Tiling::Quads, Tiling::Hexagons}) {
        int const regular = tiling == Tiling::Triangles ? 6 : tiling == Tiling::Quads ? 4 : 3;
        for (int valence : {3, 4, 5, 6, 12}) {
            SCOPED_TRACE(::testing::Message() << regular << ", " << valence);
            Shape const disk = MakeVertexDisk(tiling, valence, kNumDiskRings);
            PolygonMesh const mesh = RefineSurface(disk, kSmooth, 0)[0].mesh;
            EXPECT_EQ(mesh.GetNumFaces(), valence * kNumDiskRings * kNumDiskRings);
            EXPECT_EQ(mesh.GetNumVertices() - mesh.numEdges + mesh.GetNumFaces(), 1);
            EXPECT_EQ(mesh.positions[0].norm(), 0);
            EXPECT_EQ(mesh.vertexFirst[1], valence);
            // No other vertex has more faces than a regular one; those of the first ring have all.
            for (int vertex = 1; vertex < mesh.GetNumVertices(); ++vertex) {
                int const numFaces = mesh.vertexFirst[vertex + 1] - mesh.vertexFirst[vertex];
                double const distance = mesh.positions[vertex].norm();
                EXPECT_GE(distance, 1 - 1e-9);
                EXPECT_LE(numFaces, regular);
                EXPECT_TRUE(numFaces == regular || distance > 1.5);
            }
            if (valence != regular) {
                continue;
            }
            for (int face = 0; face < mesh.GetNumFaces(); ++face) {
                for (int i = 0; i < mesh.GetFaceSize(face); ++i) {
                    int const next = (i + 1) % mesh.GetFaceSize(face);
                    EXPECT_NEAR((mesh.positions[mesh.GetFaceVertex(face, i)] -
                                 mesh.positions[mesh.GetFaceVertex(face, next)])
                                    .norm(),
                                1, 1e-12);
                }
            }
        }
    }
}

// Where all is regular a quadratic stays one, and nothing ripples; what is measured is then the
// rounding, and slopes of a thousandth.
TEST(Ripple, RegularVerticesHaveNone) {
    struct Entry {
        Tiling tiling;
        int valence;
        AnyScheme scheme;
    };
    for (Entry const &entry :
         {Entry{Tiling::Hexagons, 3, kSmooth}, Entry{Tiling::Quads, 4, Sdc::SCHEME_CATMARK},
          Entry{Tiling::Triangles, 6, kTruncate}, Entry{Tiling::Triangles, 6, Sdc::SCHEME_LOOP}}) {
        for (Quadratic quadratic : {Quadratic::Elliptic, Quadratic::Hyperbolic}) {
            EXPECT_LT(measureRipple(entry.tiling, entry.valence, entry.scheme, quadratic), 1e-5);
        }
    }
    // At level 2 no vertex is that near to the center.
    EXPECT_THROW(MeasureRipple(Tiling::Hexagons, 3, kSmooth, Quadratic::Elliptic, 5, 2),
                 std::runtime_error);
}

// Around irregular vertices: of Smooth no more than these, of the others what they have.
TEST(Ripple, ByValence) {
    struct Values {
        double elliptic;
        double hyperbolic;
    };
    struct Row {
        int valence;
        Values hexagons; // Smooth in the scheme's own topology
        Values quads;    // Smooth
        Values catmark;
        Values truncated; // of triangles
        Values loop;
    };
    for (
        Row const &row :
        {Row{3, {0.001, 0.001}, {0.071, 0.389}, {0.0376, 0.1065}, {0.135, 1.030}, {0.1322, 0.6950}},
         Row{4, {0.069, 0.160}, {0.053, 0.197}, {0.0000, 0.0000}, {0.062, 0.343}, {0.0691, 0.0203}},
         Row{5, {0.060, 0.262}, {0.052, 0.239}, {0.0232, 0.0902}, {0.035, 0.175}, {0.0212, 0.0748}},
         Row{6, {0.101, 0.294}, {0.095, 0.399}, {0.0375, 0.1769}, {0.001, 0.001}, {0.0000, 0.0000}},
         Row{7, {0.122, 0.352}, {0.168, 0.443}, {0.0480, 0.2550}, {0.023, 0.146}, {0.0148, 0.0815}},
         Row{8, {0.169, 0.518}, {0.192, 0.501}, {0.0571, 0.2888}, {0.043, 0.225}, {0.0268, 0.1539}},
         Row{10,
             {0.341, 0.661},
             {0.275, 0.710},
             {0.0730, 0.4207},
             {0.080, 0.462},
             {0.0452, 0.2767}},
         Row{12,
             {0.376, 0.763},
             {0.460, 0.873},
             {0.0922, 0.4957},
             {0.120, 0.669},
             {0.0647, 0.3774}},
         Row{16,
             {0.441, 1.080},
             {0.817, 1.262},
             {0.1411, 0.5702},
             {0.206, 1.128},
             {0.1102, 0.5011}}}) {
        SCOPED_TRACE(row.valence);
        auto const measure = [&](Tiling tiling, AnyScheme const &scheme) {
            return Values{measureRipple(tiling, row.valence, scheme, Quadratic::Elliptic),
                          measureRipple(tiling, row.valence, scheme, Quadratic::Hyperbolic)};
        };
        auto const expectBelow = [](Values const &values, Values const &bounds) {
            EXPECT_LT(values.elliptic, bounds.elliptic);
            EXPECT_LT(values.hyperbolic, bounds.hyperbolic);
        };
        auto const expectNear = [](Values const &values, Values const &expected) {
            constexpr double kDigits = 5e-4;
            EXPECT_NEAR(values.elliptic, expected.elliptic, kDigits);
            EXPECT_NEAR(values.hyperbolic, expected.hyperbolic, kDigits);
        };
        expectBelow(measure(Tiling::Hexagons, kSmooth), row.hexagons);
        expectBelow(measure(Tiling::Quads, kSmooth), row.quads);
        expectBelow(measure(Tiling::Triangles, kTruncate), row.truncated);
        expectNear(measure(Tiling::Quads, Sdc::SCHEME_CATMARK), row.catmark);
        expectNear(measure(Tiling::Triangles, Sdc::SCHEME_LOOP), row.loop);
    }
}

} // namespace OpenSubdivHex::Regression::rippleTest
