// SPDX-License-Identifier: Apache-2.0
//
// The curves that sharp borders become, which depend on their vertices alone: their curvature, and how
// close to them the surface bends less.
#include "surfaceLevels.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>
#include <utility>
#include <vector>

namespace OpenSubdivHex::Regression::curveTest {

namespace {

using Eigen::Vector3d;
using FarExt::FaceMask;
using FarExt::FirstStep;
using FarExt::HexSchemeOptions;
using FarExt::SchemeType;
namespace Sdc = OpenSubdiv::Sdc;

constexpr int kNumSides = 9;

/// One face, of vertices at equal angles on a circle.
Shape makePolygon() {
    Shape shape;
    shape.name = "polygon";
    shape.closed = false;
    shape.faceSizes = {kNumSides};
    shape.faceVertices.resize(kNumSides);
    std::iota(shape.faceVertices.begin(), shape.faceVertices.end(), 0);
    for (int i = 0; i < kNumSides; ++i) {
        double const angle = 2 * std::acos(-1.0) * i / kNumSides;
        shape.positions.insert(shape.positions.end(), {std::cos(angle), std::sin(angle), 0});
    }
    return shape;
}

/// A ring of quads around a hole of that radius, with two at each vertex of its borders.
Shape makeRing(double innerRadius) {
    Shape shape;
    shape.name = "ring";
    shape.closed = false;
    shape.positions = makePolygon().positions;
    for (int i = 0; i < kNumSides; ++i) {
        std::size_t const outer = 3 * std::size_t(i);
        shape.positions.insert(
            shape.positions.end(),
            {shape.positions[outer] * innerRadius, shape.positions[outer + 1] * innerRadius, 0});
        int const next = (i + 1) % kNumSides;
        shape.faceSizes.push_back(4);
        shape.faceVertices.insert(shape.faceVertices.end(),
                                  {i, next, kNumSides + next, kNumSides + i});
    }
    return shape;
}

/// The border of a mesh that vertex 0 lies on, from there on.
std::vector<Vector3d> findBorder(PolygonMesh const &mesh) {
    std::set<std::pair<int, int>> sides;
    for (int face = 0; face < mesh.GetNumFaces(); ++face) {
        int const size = mesh.GetFaceSize(face);
        for (int i = 0; i < size; ++i) {
            sides.emplace(mesh.GetFaceVertex(face, i), mesh.GetFaceVertex(face, (i + 1) % size));
        }
    }
    std::vector<int> next(mesh.positions.size(), -1);
    for (auto const &[start, end] : sides) {
        if (sides.count({end, start}) == 0) {
            next[std::size_t(start)] = end;
        }
    }
    std::vector<Vector3d> points;
    int vertex = 0;
    do {
        points.push_back(mesh.positions[std::size_t(vertex)]);
        vertex = next[std::size_t(vertex)];
    } while (vertex > 0);
    EXPECT_EQ(vertex, 0);
    return points;
}

/// By point of a closed line: one over the radius of the circle through it and those beside it.
std::vector<double> measureCurvatures(std::vector<Vector3d> const &points) {
    std::size_t const size = points.size();
    std::vector<double> result(size);
    for (std::size_t i = 0; i < size; ++i) {
        Vector3d const a = points[i] - points[(i + size - 1) % size];
        Vector3d const b = points[(i + 1) % size] - points[i];
        result[i] = 2 * a.cross(b).norm() / (a.norm() * b.norm() * (a + b).norm());
    }
    return result;
}

std::vector<std::vector<double>> measureBorder(Shape const &shape, HexSchemeOptions const &scheme,
                                               int maxLevel) {
    Sdc::Options options;
    options.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_EDGE_ONLY);
    std::vector<std::vector<double>> result;
    for (SurfaceLevel const &level :
         RefineSurface(shape, scheme, maxLevel, MeshCenter(), options)) {
        result.push_back(measureCurvatures(findBorder(level.mesh)));
    }
    return result;
}

/// How many faces of a mesh in the plane z = 0 are turned over.
int countFolded(PolygonMesh const &mesh) {
    int result = 0;
    for (int face = 0; face < mesh.GetNumFaces(); ++face) {
        int const size = mesh.GetFaceSize(face);
        double area = 0;
        for (int i = 0; i < size; ++i) {
            Vector3d const &a = mesh.positions[std::size_t(mesh.GetFaceVertex(face, i))];
            Vector3d const &b =
                mesh.positions[std::size_t(mesh.GetFaceVertex(face, (i + 1) % size))];
            area += a.cross(b).z();
        }
        result += area < 0 ? 1 : 0;
    }
    return result;
}

} // namespace

TEST(Curve, CurvatureHasALimit) {
    constexpr int kMaxLevel = 7;
    for (FaceMask const mask : {FaceMask::Average, FaceMask::Cosine, FaceMask::Smooth}) {
        SCOPED_TRACE(int(mask));
        auto const levels = measureBorder(makeRing(0.5), HexSchemeOptions{mask}, kMaxLevel);
        std::vector<double> const &last = levels[kMaxLevel];
        std::vector<double> const &before = levels[kMaxLevel - 2];
        EXPECT_NEAR(last[0], before[0], 0.002 * last[0]);
        auto const [min, max] = std::minmax_element(last.begin(), last.end());
        bool const isSmooth =
            mask == FaceMask::Smooth; // which has masks of its own at the first levels
        EXPECT_NEAR(*min, isSmooth ? 0.695 : 0.779, 0.001);
        EXPECT_NEAR(*max, isSmooth ? 1.345 : 1.804, 0.001);
    }
}

// The vertices of the base are the last ones where two short edges meet.  Where they have one face, a step of two levels
// has the eigenvalue 3/32 there with Average, and 1/16, which bounds curvature, with Smooth.
TEST(Curve, CurvatureAtVerticesOfTheBaseWithOneFace) {
    constexpr int kMaxLevel = 7;
    HexSchemeOptions const truncated{FaceMask::Smooth, SchemeType::Hexagonal, FirstStep::Truncate};
    for (HexSchemeOptions const &scheme :
         {HexSchemeOptions{FaceMask::Average}, HexSchemeOptions{FaceMask::Smooth}, truncated}) {
        SCOPED_TRACE(int(scheme.firstStep));
        double const growth = scheme.faceMask == FaceMask::Average ? 16 * 3 / 32.0 : 1;
        auto const levels = measureBorder(makePolygon(), scheme, kMaxLevel);
        std::vector<double> const &last = levels[kMaxLevel];
        std::vector<double> const &before = levels[kMaxLevel - 2];
        EXPECT_NEAR(last[0], growth * before[0], 0.02 * last[0]);
        auto const getAmongEdge = [](std::vector<double> const &curvatures) {
            return curvatures[curvatures.size() / 2 / kNumSides];
        };
        EXPECT_NEAR(getAmongEdge(last), getAmongEdge(before), 0.02 * getAmongEdge(last));
    }
}

// The line moves towards its hollow side by more than what is beside it there, so that a narrow row of
// faces folds over the line.  With Smooth it stays where it is in the first step, and nothing folds.  Widths are parts
// of the height of the line's vertices above the chord of their neighbours.
TEST(Curve, NarrowRowsOnItsHollowSideFold) {
    constexpr int kMaxLevel = 6;
    double const height = 1 - std::cos(2 * std::acos(-1.0) / kNumSides);
    Sdc::Options options;
    options.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_EDGE_ONLY);
    auto const count = [&](AnyScheme const &scheme, double width) {
        Shape const ring = makeRing(1 - width * height);
        return countFolded(
            RefineSurface(ring, scheme, kMaxLevel, MeshCenter(), options).back().mesh);
    };
    struct Row {
        FaceMask mask;
        double width; // from which on nothing folds
    };
    for (Row const &row : {Row{FaceMask::Average, 1.4}, Row{FaceMask::Cosine, 1.1}}) {
        SCOPED_TRACE(int(row.mask));
        HexSchemeOptions const scheme{row.mask};
        EXPECT_EQ(count(scheme, row.width + 0.05), 0);
        EXPECT_GT(count(scheme, row.width - 0.15), 0);
        EXPECT_GT(count(scheme, 0.1), count(scheme, row.width - 0.15));
    }
    EXPECT_EQ(count(HexSchemeOptions{FaceMask::Smooth}, 0.1), 0);
    EXPECT_EQ(count(Sdc::SCHEME_CATMARK, 0.1), 0);
}

} // namespace OpenSubdivHex::Regression::curveTest
