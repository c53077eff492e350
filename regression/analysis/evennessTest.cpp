// SPDX-License-Identifier: Apache-2.0
//
// How even curvature is on surfaces whose control meshes people have, beside Catmull-Clark and Loop.
#include "evenness.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numeric>
#include <vector>

namespace OpenSubdivHex::Regression::evennessTest {

namespace {

using FarExt::FaceMask;
using FarExt::HexSchemeOptions;
namespace Sdc = OpenSubdiv::Sdc;

constexpr int kLevel = 5;
/// Levels for measures that grow with the level: around quads and irregular vertices there are ever finer ripples.
constexpr int kFineLevel = 6;
constexpr int kFinestLevel = 7;
constexpr double kDigits = 1e-4;

double measureTorus(int numU, int numV, TorusFaces faces, AnyScheme const &scheme,
                    int level = kLevel) {
    Shape const torus = MakeTorus(numU, numV, faces);
    return MeasureTorusUnevenness(RefineSurface(torus, scheme, level).back().mesh, numU);
}

double measureSphere(Shape const &shape, AnyScheme const &scheme, int level = kLevel) {
    return MeasureSphereUnevenness(RefineSurface(shape, scheme, level).back().mesh);
}

/// By row of faces from the line on: beside a crease along the outermost line, and beside the border
/// of a torus without the row above that.
struct Strips {
    std::vector<double> crease;
    std::vector<double> border;
};

Strips measureStrips(int numU, int numV, TorusFaces faces, AnyScheme const &scheme,
                     int level = kLevel) {
    double const rowWidth = 1.0 / numV;
    auto const measure = [&](Shape const &shape, auto boundary, double line) {
        Sdc::Options options;
        options.SetVtxBoundaryInterpolation(boundary);
        auto const levels = RefineSurface(shape, scheme, level, MeshCenter(), options);
        return MeasureTorusStrips(levels.back().mesh, numU, line, rowWidth, 2);
    };
    Shape const open = MakeOpenTorus(numU, numV, faces);
    Strips result;
    result.crease =
        measure(MakeCreasedTorus(numU, numV, faces), Sdc::Options::VTX_BOUNDARY_EDGE_ONLY, 0);
    result.border = measure(open, Sdc::Options::VTX_BOUNDARY_EDGE_ONLY, rowWidth);
    // Its border has no corner.
    EXPECT_EQ(measure(open, Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER, rowWidth), result.border);
    return result;
}

} // namespace

// A sphere in hexagons is even but for its coarseness; one that is pulled along an axis is not.
TEST(Evenness, SpheresAndEllipsoids) {
    PolygonMesh mesh =
        RefineSurface(MakeSphereHull(60, 200), HexSchemeOptions{FaceMask::Smooth}, 4).back().mesh;
    for (Eigen::Vector3d &position : mesh.positions) {
        position.normalize();
    }
    EXPECT_LT(MeasureSphereUnevenness(mesh), 0.01);
    // Mean curvature of an ellipsoid with the half axes 1, 1 and 2: 2 at the tips, 5/8 around.
    for (Eigen::Vector3d &position : mesh.positions) {
        position.z() *= 2;
    }
    double const ellipsoid = MeasureSphereUnevenness(mesh);
    EXPECT_GT(ellipsoid, 0.2);
    EXPECT_LT(ellipsoid, 0.5);
    // Its Gaussian curvature is 4 / s^4 and an element of area s sin(t) dt, at the angle t from the axis,
    // with s^2 = cos(t)^2 + 4 sin(t)^2.
    double area = 0;
    double sum = 0;
    double square = 0;
    constexpr int kNumSteps = 1000;
    for (int i = 0; i < kNumSteps; ++i) {
        double const t = std::acos(-1.0) * (i + 0.5) / kNumSteps;
        double const s2 = 1 + 3 * std::sin(t) * std::sin(t);
        double const part = std::sqrt(s2) * std::sin(t);
        double const gaussian = 4 / (s2 * s2);
        area += part;
        sum += part * gaussian;
        square += part * gaussian * gaussian;
    }
    std::vector<int> vertices(mesh.positions.size());
    std::iota(vertices.begin(), vertices.end(), 0);
    EXPECT_NEAR(MeasureUnevenness(mesh, vertices, std::vector<int>(vertices.size(), 0),
                                  Curvature::Gaussian),
                std::sqrt(square * area / (sum * sum) - 1), 0.02);
}

TEST(Evenness, HullOfPointsOnASphere) {
    Shape const hull = MakeSphereHull(60, 200);
    EXPECT_EQ(hull.GetNumVertices(), 60);
    EXPECT_EQ(hull.GetNumFaces(), 2 * 60 - 4);
}

// Control meshes of quads: four faces at each vertex.  Catmull-Clark is regular there, and calm.
TEST(Evenness, ToriOfQuads) {
    struct Row {
        int numU;
        int numV;
        double smooth;
        double fine; // the same at the fine level
        double catmark;
    };
    for (Row const &row : {Row{14, 8, 0.0158, 0.0187, 0.0050}, Row{20, 10, 0.0122, 0.0166, 0.0044},
                           Row{9, 6, 0.0252, 0.0260, 0.0075}}) {
        SCOPED_TRACE(row.numU);
        HexSchemeOptions const smooth{FaceMask::Smooth};
        EXPECT_NEAR(measureTorus(row.numU, row.numV, TorusFaces::Quads, smooth), row.smooth,
                    kDigits);
        EXPECT_NEAR(measureTorus(row.numU, row.numV, TorusFaces::Quads, smooth, kFineLevel),
                    row.fine, kDigits);
        EXPECT_NEAR(measureTorus(row.numU, row.numV, TorusFaces::Quads, Sdc::SCHEME_CATMARK),
                    row.catmark, kDigits);
    }
    // Finer ripples come with each level, and what they add becomes less.
    EXPECT_NEAR(
        measureTorus(9, 6, TorusFaces::Quads, HexSchemeOptions{FaceMask::Smooth}, kFinestLevel),
        0.0314, kDigits);
}

// Quads that are two to seven times as long as wide, for which the weights were not searched; and irregular
// meshes of quads, where Catmull-Clark is uneven, too.
TEST(Evenness, QuadsOfOtherKinds) {
    HexSchemeOptions const smooth{FaceMask::Smooth};
    struct Torus {
        int numU;
        int numV;
        double smooth;
        double fine; // the same at the fine level
        double catmark;
    };
    for (Torus const &row :
         {Torus{30, 6, 0.0249, 0.0359, 0.0054}, Torus{7, 12, 0.0548, 0.0824, 0.0120}}) {
        SCOPED_TRACE(row.numU);
        EXPECT_NEAR(measureTorus(row.numU, row.numV, TorusFaces::Quads, smooth), row.smooth,
                    kDigits);
        EXPECT_NEAR(measureTorus(row.numU, row.numV, TorusFaces::Quads, smooth, kFineLevel),
                    row.fine, kDigits);
        EXPECT_NEAR(measureTorus(row.numU, row.numV, TorusFaces::Quads, Sdc::SCHEME_CATMARK),
                    row.catmark, kDigits);
    }
    struct Sphere {
        Shape shape;
        double smooth;
        double catmark;
    };
    std::vector<Shape> const platonics = MakeTrianglePlatonics();
    for (Sphere const &row :
         {Sphere{GetShape("cube"), 0.1093, 0.1047}, Sphere{platonics[0], 0.0997, 0.0429},
          Sphere{platonics[1], 0.0982, 0.1004}, Sphere{platonics[2], 0.1437, 0.1487},
          Sphere{MakeSphereHull(60, 200), 0.2307, 0.2082}}) {
        SCOPED_TRACE(row.shape.name);
        Shape const sphere = MakeSphereOfQuads(row.shape);
        EXPECT_NEAR(measureSphere(sphere, smooth), row.smooth, kDigits);
        EXPECT_NEAR(measureSphere(sphere, Sdc::SCHEME_CATMARK), row.catmark, kDigits);
    }
}

// Truncations are for triangles: of quads they make octagons and worse surfaces.
TEST(Evenness, QuadsTruncatedFirst) {
    AnyScheme const truncate = HexSchemeOptions{FaceMask::Smooth, FarExt::SchemeType::Hexagonal,
                                                FarExt::FirstStep::Truncate};
    EXPECT_GT(measureTorus(14, 8, TorusFaces::Quads, truncate),
              5 * measureTorus(14, 8, TorusFaces::Quads, HexSchemeOptions{FaceMask::Smooth}));
}

// Surfaces without the masks around irregular vertices and beside quads: the reason for these masks.
TEST(Evenness, OneMaskForAllHexagons) {
    Shape const torus = MakeTorus(14, 8, TorusFaces::Quads);
    double const uneven = MeasureTorusUnevenness(RefineWithOneMask(torus, kLevel).back().mesh, 14);
    EXPECT_GT(uneven,
              3.5 * measureTorus(14, 8, TorusFaces::Quads, HexSchemeOptions{FaceMask::Smooth}));
    // Where nothing is irregular, it is Smooth.
    Shape const dodecahedron = GetShape("dodecahedron");
    PolygonMesh const expected =
        RefineSurface(dodecahedron, HexSchemeOptions{FaceMask::Smooth}, 3).back().mesh;
    PolygonMesh const mesh = RefineWithOneMask(dodecahedron, 3).back().mesh;
    for (int vertex = 0; vertex < mesh.GetNumVertices(); ++vertex) {
        EXPECT_LT((mesh.positions[vertex] - expected.positions[vertex]).norm(), 1e-12);
    }
}

// Control meshes of triangles: six faces at nearly every vertex, where Loop is regular.
TEST(Evenness, Triangles) {
    AnyScheme const smooth = HexSchemeOptions{FaceMask::Smooth};
    EXPECT_NEAR(measureTorus(14, 8, TorusFaces::Triangles, smooth), 0.4642, kDigits);
    EXPECT_NEAR(measureTorus(14, 8, TorusFaces::Triangles, Sdc::SCHEME_LOOP), 0.0082, kDigits);
    double const ofSmooth[] = {0.4892, 0.2192, 0.1346};
    double const ofLoop[] = {0.3866, 0.1558, 0.0602};
    std::vector<Shape> const shapes = MakeTrianglePlatonics();
    for (std::size_t i = 0; i < shapes.size(); ++i) {
        SCOPED_TRACE(shapes[i].name);
        EXPECT_NEAR(measureSphere(shapes[i], smooth), ofSmooth[i], kDigits);
        EXPECT_NEAR(measureSphere(shapes[i], Sdc::SCHEME_LOOP), ofLoop[i], kDigits);
    }
    Shape const hull = MakeSphereHull(60, 200);
    EXPECT_NEAR(measureSphere(hull, smooth), 0.2989, kDigits);
    EXPECT_NEAR(measureSphere(hull, Sdc::SCHEME_LOOP), 0.0765, kDigits);
}

// A truncation makes vertices faces, where curvature is bounded: as calm as Loop, and calmer where it
// is irregular.
TEST(Evenness, TrianglesTruncatedFirst) {
    AnyScheme const truncate = HexSchemeOptions{FaceMask::Smooth, FarExt::SchemeType::Hexagonal,
                                                FarExt::FirstStep::Truncate};
    EXPECT_LT(measureTorus(14, 8, TorusFaces::Triangles, truncate), 0.027);
    EXPECT_LT(measureTorus(14, 8, TorusFaces::Triangles, truncate, kFineLevel), 0.025);
    double const bounds[] = {0.27, 0.112, 0.047};
    double const fineBounds[] = {0.28, 0.118, 0.049};
    std::vector<Shape> const shapes = MakeTrianglePlatonics();
    for (std::size_t i = 0; i < shapes.size(); ++i) {
        SCOPED_TRACE(shapes[i].name);
        EXPECT_LT(measureSphere(shapes[i], truncate), bounds[i]);
        EXPECT_LT(measureSphere(shapes[i], truncate, kFineLevel), fineBounds[i]);
    }
    Shape const hull = MakeSphereHull(60, 200);
    EXPECT_LT(measureSphere(hull, truncate), 0.066);
    EXPECT_LT(measureSphere(hull, truncate, kFineLevel), 0.067);
    // Valences from three to nine.
    for (Shape const &rough : {MakeSphereHull(100, 20), MakeSphereHull(200, 12)}) {
        EXPECT_LT(measureSphere(rough, truncate), 0.97 * measureSphere(rough, Sdc::SCHEME_LOOP));
    }
}

// Beside creases and borders: by row of faces, the first two from the line.
TEST(Evenness, QuadsBesideLines) {
    struct Row {
        int numU;
        int numV;
        std::array<double, 2> crease;
        std::array<double, 2> border;
        double fineCrease; // of the first row at the fine level
    };
    for (Row const &row : {Row{14, 8, {0.0657, 0.0165}, {0.0727, 0.0225}, 0.0786},
                           Row{20, 10, {0.0679, 0.0127}, {0.0768, 0.0154}, 0.0757},
                           Row{9, 6, {0.0905, 0.0253}, {0.0807, 0.0486}, 0.1139}}) {
        SCOPED_TRACE(row.numU);
        HexSchemeOptions const smooth{FaceMask::Smooth};
        Strips const strips = measureStrips(row.numU, row.numV, TorusFaces::Quads, smooth);
        for (std::size_t i = 0; i < 2; ++i) {
            EXPECT_NEAR(strips.crease[i], row.crease[i], kDigits);
            EXPECT_NEAR(strips.border[i], row.border[i], kDigits);
        }
        EXPECT_NEAR(
            measureStrips(row.numU, row.numV, TorusFaces::Quads, smooth, kFineLevel).crease[0],
            row.fineCrease, kDigits);
        // The second row of the open torus is that of the closed one, and so is its measure.
        PolygonMesh const closed =
            RefineSurface(MakeTorus(row.numU, row.numV, TorusFaces::Quads), smooth, kLevel)
                .back()
                .mesh;
        double const rowWidth = 1.0 / row.numV;
        EXPECT_NEAR(MeasureTorusStrips(closed, row.numU, rowWidth, rowWidth, 2)[1],
                    strips.border[1], 0.004);
        Strips const catmark =
            measureStrips(row.numU, row.numV, TorusFaces::Quads, Sdc::SCHEME_CATMARK);
        EXPECT_LT(catmark.crease[0], 0.03);
        EXPECT_LT(catmark.border[0], 0.035);
    }
}

// Masks of their own beside the line keep the first row calm, at finer levels, too, where there are none.
TEST(Evenness, TruncatedTrianglesBesideLines) {
    AnyScheme const truncate = HexSchemeOptions{FaceMask::Smooth, FarExt::SchemeType::Hexagonal,
                                                FarExt::FirstStep::Truncate};
    struct Row {
        int numU;
        int numV;
        std::array<double, 2> crease;
        std::array<double, 2> border;
        double fineCrease; // of the first row at the fine level
    };
    for (Row const &row : {Row{14, 8, {0.052, 0.027}, {0.062, 0.034}, 0.059},
                           Row{20, 10, {0.055, 0.018}, {0.060, 0.019}, 0.062},
                           Row{9, 6, {0.062, 0.044}, {0.081, 0.064}, 0.072}}) {
        SCOPED_TRACE(row.numU);
        Strips const strips = measureStrips(row.numU, row.numV, TorusFaces::Triangles, truncate);
        for (std::size_t i = 0; i < 2; ++i) {
            EXPECT_LT(strips.crease[i], row.crease[i]);
            EXPECT_LT(strips.border[i], row.border[i]);
        }
        EXPECT_LT(measureStrips(row.numU, row.numV, TorusFaces::Triangles, truncate, kFineLevel)
                      .crease[0],
                  row.fineCrease);
    }
}

} // namespace OpenSubdivHex::Regression::evennessTest
