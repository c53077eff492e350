// SPDX-License-Identifier: Apache-2.0
#include "shapes.h"
#include "flatShapes.h"
#include "meshOperations.h"
#include "objShape.h"
#include "shapeDescriptor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <random>
#include <set>
#include <utility>

namespace OpenSubdivHex::Regression::shapesTest {

namespace {

using DirectedEdge = std::pair<int, int>;

/// How many faces run each edge in each direction.
std::map<DirectedEdge, int> countEdgeUses(Shape const &shape) {
    std::map<DirectedEdge, int> uses;
    int first = 0;
    for (int size : shape.faceSizes) {
        for (int i = 0; i < size; ++i) {
            ++uses[{shape.faceVertices[first + i], shape.faceVertices[first + (i + 1) % size]}];
        }
        first += size;
    }
    return uses;
}

int countEdges(Shape const &shape) {
    std::set<DirectedEdge> edges;
    for (auto const &[edge, uses] : countEdgeUses(shape)) {
        edges.insert(std::minmax(edge.first, edge.second));
    }
    return int(edges.size());
}

int eulerCharacteristic(std::string const &name) {
    Shape const &shape = GetShape(name);
    return shape.GetNumVertices() - countEdges(shape) + shape.GetNumFaces();
}

/// Six times the volume: each face as a fan from its first vertex.
double volume(Shape const &shape) {
    double sum = 0;
    int first = 0;
    auto const point = [&](int corner) { return &shape.positions[3 * shape.faceVertices[corner]]; };
    for (int size : shape.faceSizes) {
        for (int i = 1; i + 1 < size; ++i) {
            double const *const a = point(first);
            double const *const b = point(first + i);
            double const *const c = point(first + i + 1);
            sum += a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
                   a[2] * (b[0] * c[1] - b[1] * c[0]);
        }
        first += size;
    }
    return sum;
}

} // namespace

TEST(Shapes, NamesAreUnique) {
    std::set<std::string> names;
    for (Shape const &shape : GetShapes()) {
        EXPECT_TRUE(names.insert(shape.name).second) << shape.name;
    }
    EXPECT_GE(names.size(), 39u);
    EXPECT_THROW(GetShape("no such shape"), std::out_of_range);
}

TEST(Shapes, FlatShapesAreClosedAndOutward) {
    for (Shape const &shape : GetFlatShapes()) {
        SCOPED_TRACE(shape.name);
        EXPECT_TRUE(shape.closed && shape.manifold);
        EXPECT_TRUE(IsManifold(shape));
        EXPECT_EQ(CountBoundaryEdges(shape), 0);
        EXPECT_EQ(shape.GetNumVertices() - countEdges(shape) + shape.GetNumFaces(), 2);
    }
    EXPECT_NEAR(volume(MakeBox(3, 2, 1)), 6 * 6, 1e-12);
    EXPECT_NEAR(volume(MakePrism(4, 3, 2)), 6 * 4, 1e-12);
}

TEST(Shapes, ArraysAgreeInSize) {
    for (Shape const &shape : GetShapes()) {
        SCOPED_TRACE(shape.name);
        EXPECT_EQ(shape.positions.size() % 3, 0u);
        int corners = 0;
        for (int size : shape.faceSizes) {
            EXPECT_GE(size, 3);
            corners += size;
        }
        EXPECT_EQ(corners, shape.GetNumCorners());
        for (int v : shape.faceVertices) {
            EXPECT_GE(v, 0);
            EXPECT_LT(v, shape.GetNumVertices());
        }
        for (FVarChannel const &channel : shape.fvarChannels) {
            EXPECT_EQ(int(channel.valueIndices.size()), corners);
            int const numValues = int(channel.values.size()) / channel.width;
            for (int value : channel.valueIndices) {
                EXPECT_GE(value, 0);
                EXPECT_LT(value, numValues);
            }
        }
        for (double coordinate : shape.positions) {
            EXPECT_TRUE(std::isfinite(coordinate));
        }
    }
}

TEST(Shapes, OrientationIsConsistent) {
    for (Shape const &shape : GetShapes()) {
        SCOPED_TRACE(shape.name);
        std::map<DirectedEdge, int> const uses = countEdgeUses(shape);
        int numBoundaryEdges = 0;
        for (auto const &[edge, count] : uses) {
            EXPECT_EQ(count, 1) << "edge " << edge.first << " " << edge.second;
            numBoundaryEdges += uses.count({edge.second, edge.first}) == 0;
        }
        EXPECT_EQ(shape.closed, numBoundaryEdges == 0);
        EXPECT_EQ(CountBoundaryEdges(shape), numBoundaryEdges);
    }
}

TEST(Shapes, ClosedOnesPointOutward) {
    int numClosed = 0;
    for (Shape const &shape : GetShapes()) {
        if (shape.closed && shape.name.find("dihedron") != 0) {
            EXPECT_GT(volume(shape), 0.1) << shape.name;
            ++numClosed;
        }
    }
    EXPECT_GE(numClosed, 25);
}

TEST(Shapes, EulerCharacteristics) {
    for (char const *name : {"tetrahedron", "cube", "octahedron", "dodecahedron", "icosahedron",
                             "prism3", "prism360", "pyramid12", "bipyramid64", "dihedron5",
                             "truncatedCube", "truncatedIcosahedron", "chamferedCube"}) {
        EXPECT_EQ(eulerCharacteristic(name), 2) << name;
    }
    EXPECT_EQ(eulerCharacteristic("torus"), 0);
    EXPECT_EQ(eulerCharacteristic("hexTorus"), 0);
    EXPECT_EQ(eulerCharacteristic("genus2"), -2);
    EXPECT_EQ(eulerCharacteristic("twoComponents"), 4);
    EXPECT_EQ(eulerCharacteristic("polygon9"), 1);
    EXPECT_EQ(eulerCharacteristic("quadGrid"), 1);
    EXPECT_EQ(eulerCharacteristic("triangleGrid"), 1);
    EXPECT_EQ(eulerCharacteristic("hexGrid"), 1);
    EXPECT_EQ(eulerCharacteristic("mixedPatch"), 1);
    EXPECT_EQ(eulerCharacteristic("openCylinder"), 0);
    EXPECT_EQ(eulerCharacteristic("annulus"), 0);
    EXPECT_EQ(eulerCharacteristic("discFan7"), 1);
    EXPECT_EQ(eulerCharacteristic("isolatedVertex"), 2);
}

TEST(Shapes, Manifold) {
    for (Shape const &shape : GetShapes()) {
        EXPECT_EQ(shape.manifold, shape.name != "teapot") << shape.name;
    }
    for (Shape const &shape : GetManifoldShapes()) {
        EXPECT_TRUE(shape.manifold);
    }
    EXPECT_GE(GetManifoldShapes().size(), 39u);

    Shape bowTie;
    bowTie.positions.resize(3 * 5);
    bowTie.faceSizes = {3, 3};
    bowTie.faceVertices = {0, 1, 2, 2, 3, 4};
    EXPECT_FALSE(IsManifold(bowTie));
    Shape const split = MakeSplit("split", bowTie);
    EXPECT_EQ(split.faceVertices, (std::vector<int>{0, 1, 2, 5, 3, 4}));
    EXPECT_EQ(split.GetNumVertices(), 6);
    EXPECT_TRUE(IsManifold(split));

    Shape fin;
    fin.positions.resize(3 * 5);
    fin.faceSizes = {3, 3, 3};
    fin.faceVertices = {0, 1, 2, 1, 0, 3, 0, 1, 4};
    EXPECT_FALSE(IsManifold(fin));
}

TEST(Shapes, FacesAndValencesAreAsNamed) {
    EXPECT_EQ(GetShape("dodecahedron").faceSizes, std::vector<int>(12, 5));
    EXPECT_EQ(GetShape("hexTorus").faceSizes, std::vector<int>(30, 6));
    EXPECT_EQ(GetShape("hexGrid").faceSizes, std::vector<int>(12, 6));
    std::vector<int> const &ball = GetShape("truncatedIcosahedron").faceSizes;
    EXPECT_EQ(std::count(ball.begin(), ball.end(), 6), 20);
    EXPECT_EQ(std::count(ball.begin(), ball.end(), 5), 12);
    std::vector<int> const &chamfered = GetShape("chamferedCube").faceSizes;
    EXPECT_EQ(std::count(chamfered.begin(), chamfered.end(), 4), 6);
    EXPECT_EQ(std::count(chamfered.begin(), chamfered.end(), 6), 12);
    std::vector<int> const &prism = GetShape("prism360").faceSizes;
    EXPECT_EQ(std::count(prism.begin(), prism.end(), 360), 2);
    Shape const &bipyramid = GetShape("bipyramid360");
    EXPECT_EQ(std::count(bipyramid.faceVertices.begin(), bipyramid.faceVertices.end(), 361), 360);
    Shape const &isolated = GetShape("isolatedVertex");
    EXPECT_EQ(std::count(isolated.faceVertices.begin(), isolated.faceVertices.end(), 2), 0);
}

TEST(Shapes, TestLevelKeepsToItsLimit) {
    constexpr double divisor = OPENSUBDIVHEX_TEST_DIVISOR;
    // Cube: 24 corners, times 4 a level.
    EXPECT_EQ(GetTestLevel(GetShape("cube"), 3, 1536 * divisor), 3);
    EXPECT_EQ(GetTestLevel(GetShape("cube"), 3, 1535 * divisor), 2);
    EXPECT_EQ(GetTestLevel(GetShape("cube"), 2, 1e9), 2);
    // Triangle: 3 corners and 3 boundary edges: 3, 15, 63.
    EXPECT_EQ(GetTestLevel(GetShape("polygon3"), 3, 63 * divisor), 2);
    EXPECT_EQ(GetTestLevel(GetShape("polygon3"), 3, 62 * divisor), 1);
}

TEST(ObjShape, HasTheFacesOfAllObjectsAndTheirTexture) {
    std::string const path = testing::TempDir() + "OpenSubdivHex.objShape." +
                             std::to_string(std::random_device()()) + ".obj";
    std::ofstream(path) << "o quad\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 .5\n"
                           "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 .25\nf 1/1 2/2 3/3 4/4\n"
                           "o others\nv 2 0 0\nv 3 .5 0\nv 2 1 0\n"
                           "f 3/1 2/4 5/2\nf 5/1 6/2 7/3 3/4 2/2\n";
    Shape const shape = LoadObjShape("of a file", path);
    std::filesystem::remove(path);
    EXPECT_EQ(shape.name, "of a file");
    EXPECT_EQ(shape.positions, (std::vector<double>{0,  0, 0, 1, 0, 0,  1, 1, 0, 0, 1,
                                                    .5, 2, 0, 0, 3, .5, 0, 2, 1, 0}));
    EXPECT_EQ(shape.faceSizes, (std::vector<int>{4, 3, 5}));
    EXPECT_EQ(shape.faceVertices, (std::vector<int>{0, 1, 2, 3, 2, 1, 4, 4, 5, 6, 2, 1}));
    ASSERT_EQ(shape.fvarChannels.size(), 1u);
    EXPECT_EQ(shape.fvarChannels[0].values, (std::vector<double>{0, 0, 1, 0, 1, 1, 0, .25}));
    EXPECT_EQ(shape.fvarChannels[0].valueIndices,
              (std::vector<int>{0, 1, 2, 3, 0, 3, 1, 0, 1, 2, 3, 1}));
    EXPECT_THROW(LoadObjShape("of no file", path), std::runtime_error);
}

// A mesh of the tutorials, and the real ones where their folder is there.
TEST(ObjShape, FilesHaveTheirCounts) {
    struct Expected {
        int numVertices;
        int numFaces;
        int numBoundaryEdges;
        std::size_t numUvs;
        bool isManifold;
    };
    // 38 vertices of the teapot have two fans or more, 47 fans more than one each.
    std::map<std::string, Expected> const expected = {
        {"lantern", {346, 354, 0, 0, true}},
        {"spot", {2930, 5856, 0, 3225, true}},
        {"suzanne", {507, 500, 42, 0, true}},
        {"teapot", {3644, 6320, 1036, 0, false}},
        {"teapotSplit", {3644 + 47, 6320, 1036, 0, true}}};
    std::vector<Shape> shapes = {LoadObjShape("lantern", LANTERN_FILE)};
    for (Shape const &shape : GetShapes()) {
        if (expected.count(shape.name) > 0) {
            EXPECT_EQ(shape.closed, expected.at(shape.name).numBoundaryEdges == 0) << shape.name;
            shapes.push_back(shape);
        }
    }
    for (Shape const &shape : shapes) {
        SCOPED_TRACE(shape.name);
        Expected const &counts = expected.at(shape.name);
        EXPECT_EQ(shape.GetNumVertices(), counts.numVertices);
        EXPECT_EQ(shape.GetNumFaces(), counts.numFaces);
        EXPECT_EQ(CountBoundaryEdges(shape), counts.numBoundaryEdges);
        EXPECT_EQ(IsManifold(shape), counts.isManifold);
        ASSERT_EQ(shape.fvarChannels.size(), counts.numUvs > 0 ? 1u : 0u);
        if (counts.numUvs > 0) {
            EXPECT_EQ(shape.fvarChannels[0].values.size(), 2 * counts.numUvs);
        }
    }
}

TEST(ShapeDescriptor, FarTakesEveryShape) {
    for (Shape const &shape : GetShapes()) {
        SCOPED_TRACE(shape.name);
        auto const refiner = CreateFarRefiner(shape);
        ASSERT_TRUE(refiner);
        OpenSubdiv::Far::TopologyLevel const level = refiner->GetLevel(0);
        EXPECT_EQ(level.GetNumVertices(), shape.GetNumVertices());
        EXPECT_EQ(level.GetNumFaces(), shape.GetNumFaces());
        EXPECT_EQ(level.GetNumEdges(), countEdges(shape));
        EXPECT_EQ(level.GetNumFVarChannels(), int(shape.fvarChannels.size()));
        int corner = 0;
        for (int f = 0; f < level.GetNumFaces(); ++f) {
            for (int v : level.GetFaceVertices(f)) {
                EXPECT_EQ(v, shape.faceVertices[corner++]);
            }
        }
    }
}

TEST(ShapeDescriptor, PassesTags) {
    Shape shape = GetShape("cube");
    shape.creaseVertexPairs = {shape.faceVertices[0], shape.faceVertices[1]};
    shape.creaseSharpness = {2.5f};
    shape.cornerVertices = {3};
    shape.cornerSharpness = {1.5f};
    shape.holeFaces = {4};
    shape.fvarChannels.resize(1);
    shape.fvarChannels[0].values.assign(2 * 24, 0.25);
    for (int i = 0; i < 24; ++i) {
        shape.fvarChannels[0].valueIndices.push_back(23 - i);
    }
    OpenSubdiv::Sdc::Options options;
    options.SetVtxBoundaryInterpolation(OpenSubdiv::Sdc::Options::VTX_BOUNDARY_EDGE_ONLY);
    auto const refiner = CreateFarRefiner(shape, options);
    ASSERT_TRUE(refiner);
    OpenSubdiv::Far::TopologyLevel const level = refiner->GetLevel(0);
    EXPECT_EQ(refiner->GetSchemeType(), OpenSubdiv::Sdc::SCHEME_CATMARK);
    EXPECT_EQ(refiner->GetSchemeOptions().GetVtxBoundaryInterpolation(),
              OpenSubdiv::Sdc::Options::VTX_BOUNDARY_EDGE_ONLY);
    EXPECT_EQ(level.GetEdgeSharpness(
                  level.FindEdge(shape.creaseVertexPairs[0], shape.creaseVertexPairs[1])),
              2.5f);
    EXPECT_EQ(level.GetVertexSharpness(3), 1.5f);
    EXPECT_TRUE(level.IsFaceHole(4));
    EXPECT_FALSE(level.IsFaceHole(3));
    EXPECT_EQ(level.GetNumFVarValues(0), 24);
    EXPECT_EQ(level.GetFaceFVarValues(0, 0)[1], 22);

    shape.fvarChannels.clear();
    shape.leftHanded = true;
    auto const leftHanded = CreateFarRefiner(shape);
    ASSERT_TRUE(leftHanded);
    EXPECT_EQ(leftHanded->GetLevel(0).GetFaceVertices(0)[1], shape.faceVertices[3]);
}

} // namespace OpenSubdivHex::Regression::shapesTest
