// SPDX-License-Identifier: Apache-2.0
//
// How even curvature is on surfaces whose control meshes people have, beside Catmull-Clark and Loop.
#include "evenness.h"

#include <gtest/gtest.h>

namespace OpenSubdivHex::Regression {

namespace {

using FarExt::FaceMask;
using FarExt::HexSchemeOptions;
namespace Sdc = OpenSubdiv::Sdc;

constexpr int kLevel = 5;
constexpr double kDigits = 1e-4;

double measureTorus(int numU, int numV, bool isTriangles, AnyScheme const &scheme) {
    Shape const torus = MakeTorus(numU, numV, isTriangles);
    return MeasureTorusUnevenness(RefineSurface(torus, scheme, kLevel).back().mesh, numU);
}

double measureSphere(Shape const &shape, AnyScheme const &scheme) {
    return MeasureSphereUnevenness(RefineSurface(shape, scheme, kLevel).back().mesh);
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
        double catmark;
    };
    for (Row const &row :
         {Row{14, 8, 0.0856, 0.0050}, Row{20, 10, 0.0934, 0.0044}, Row{9, 6, 0.0862, 0.0075}}) {
        SCOPED_TRACE(row.numU);
        HexSchemeOptions const smooth{FaceMask::Smooth};
        EXPECT_LT(row.smooth, 0.1);
        EXPECT_NEAR(measureTorus(row.numU, row.numV, false, smooth), row.smooth, kDigits);
        EXPECT_NEAR(measureTorus(row.numU, row.numV, false, Sdc::SCHEME_CATMARK), row.catmark,
                    kDigits);
    }
}

// Control meshes of triangles: six faces at nearly every vertex, where Loop is regular.
TEST(Evenness, Triangles) {
    AnyScheme const smooth = HexSchemeOptions{FaceMask::Smooth};
    EXPECT_NEAR(measureTorus(14, 8, true, smooth), 0.7984, kDigits);
    EXPECT_NEAR(measureTorus(14, 8, true, Sdc::SCHEME_LOOP), 0.0082, kDigits);
    double const ofSmooth[] = {0.4892, 0.2928, 0.3788};
    double const ofLoop[] = {0.3866, 0.1558, 0.0602};
    std::vector<Shape> const shapes = MakeTrianglePlatonics();
    for (std::size_t i = 0; i < shapes.size(); ++i) {
        SCOPED_TRACE(shapes[i].name);
        EXPECT_NEAR(measureSphere(shapes[i], smooth), ofSmooth[i], kDigits);
        EXPECT_NEAR(measureSphere(shapes[i], Sdc::SCHEME_LOOP), ofLoop[i], kDigits);
    }
    Shape const hull = MakeSphereHull(60, 200);
    EXPECT_NEAR(measureSphere(hull, smooth), 0.5751, kDigits);
    EXPECT_NEAR(measureSphere(hull, Sdc::SCHEME_LOOP), 0.0765, kDigits);
}

// A truncation makes vertices faces, where curvature is bounded: as calm as Loop, and calmer where it
// is irregular.
TEST(Evenness, TrianglesTruncatedFirst) {
    AnyScheme const truncate = HexSchemeOptions{FaceMask::Smooth, FarExt::SchemeType::Hexagonal,
                                                FarExt::FirstStep::Truncate};
    EXPECT_LT(measureTorus(14, 8, true, truncate), 0.03);
    double const bounds[] = {0.32, 0.12, 0.05};
    std::vector<Shape> const shapes = MakeTrianglePlatonics();
    for (std::size_t i = 0; i < shapes.size(); ++i) {
        SCOPED_TRACE(shapes[i].name);
        EXPECT_LT(measureSphere(shapes[i], truncate), bounds[i]);
    }
    EXPECT_LT(measureSphere(MakeSphereHull(60, 200), truncate), 0.08);
}

} // namespace OpenSubdivHex::Regression
