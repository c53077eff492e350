// SPDX-License-Identifier: Apache-2.0
//
// Limit stencils where the topology around a vertex is unusual: several fans, many faces, few.
#include "referenceMatch.h"
#include "valueLevels.h"

#include "far_ext/stencilTableFactory.h"
#include "regression/shapes/shapeDescriptor.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <random>

namespace OpenSubdivHex::Regression::limitVertexTest {

using FarExt::LimitSides;
using FarExt::TopologyLevel;
using FarExt::TopologyRefiner;

namespace {

using Factory = FarExt::LimitStencilTableFactoryReal<double>;
using Boundary = Sdc::Options::VtxBoundaryInterpolation;
using Vector = Eigen::Vector3d;

/// The header's bound of the weights of derivatives.
constexpr double kMaxDerivativeWeight = 8;

constexpr float kInfinite = 10;

Shape makeShape(std::vector<Vector> const &positions, std::vector<std::vector<int>> const &faces) {
    Shape shape;
    for (Vector const &position : positions) {
        shape.positions.insert(shape.positions.end(), position.data(), position.data() + 3);
    }
    for (std::vector<int> const &face : faces) {
        shape.faceSizes.push_back(int(face.size()));
        shape.faceVertices.insert(shape.faceVertices.end(), face.begin(), face.end());
    }
    return shape;
}

Sdc::Options makeOptions(Boundary boundary) {
    Sdc::Options options;
    options.SetVtxBoundaryInterpolation(boundary);
    return options;
}

std::unique_ptr<Factory::Table const> makeTable(TopologyRefiner const &refiner, int level,
                                                FarExt::CallStatus *status = nullptr) {
    Factory::Options options;
    options.level = level;
    options.generateFurtherSides = true;
    options.generateFaceCenters = true;
    return Factory::Create(refiner, options, status);
}

Vector sum(Factory::Table const &table, std::vector<double> const &weights, int row,
           ReferenceValues const &base) {
    Vector result = Vector::Zero();
    int const offset = table.GetOffsets()[row];
    for (int k = offset; k < offset + table.GetSizes()[row]; ++k) {
        result += weights[k] * base.row(table.GetControlIndices()[k]).transpose();
    }
    return result;
}

Vector normalOf(Factory::Table const &table, int row, ReferenceValues const &base) {
    return sum(table, table.GetDuWeights(), row, base)
        .cross(sum(table, table.GetDvWeights(), row, base))
        .normalized();
}

double angleBetween(Vector const &a, Vector const &b) {
    return std::atan2(a.cross(b).norm(), a.dot(b)) * 180 / 3.14159265358979323846;
}

/// The weights of points are convex, those of derivatives bounded and of sum 0.
void expectSound(Factory::Table const &table) {
    for (int row = 0; row < table.GetNumStencils(); ++row) {
        double point = 0;
        double du = 0;
        double dv = 0;
        int const offset = table.GetOffsets()[row];
        for (int k = offset; k < offset + table.GetSizes()[row]; ++k) {
            ASSERT_GE(table.GetWeights()[k], -1e-12) << "row " << row;
            ASSERT_LE(std::abs(table.GetDuWeights()[k]), kMaxDerivativeWeight) << "row " << row;
            ASSERT_LE(std::abs(table.GetDvWeights()[k]), kMaxDerivativeWeight) << "row " << row;
            point += table.GetWeights()[k];
            du += table.GetDuWeights()[k];
            dv += table.GetDvWeights()[k];
        }
        ASSERT_NEAR(point, 1, 1e-10) << "row " << row;
        ASSERT_NEAR(du, 0, 1e-9) << "row " << row;
        ASSERT_NEAR(dv, 0, 1e-9) << "row " << row;
    }
}

/// The mean of the normals of the faces around a vertex, whose first side they are.
Vector meanNormal(TopologyLevel const &level, int vert, ReferenceValues const &positions) {
    Vector normal = Vector::Zero();
    for (int face : level.GetVertexFaces(vert)) {
        auto const verts = level.GetFaceVertices(face);
        Vector const origin = positions.row(verts[0]);
        for (int i = 1; i + 1 < verts.size(); ++i) {
            Vector const a = positions.row(verts[i]).transpose() - origin;
            Vector const b = positions.row(verts[i + 1]).transpose() - origin;
            normal += a.cross(b);
        }
    }
    return normal.normalized();
}

/// Closed fans of triangles that meet in vertex 0: fan i has sizes[i] faces in the plane z = i.
Shape makeFans(std::vector<int> const &sizes) {
    std::vector<Vector> positions = {Vector::Zero()};
    std::vector<std::vector<int>> faces;
    for (std::size_t fan = 0; fan < sizes.size(); ++fan) {
        int const first = int(positions.size());
        for (int i = 0; i < sizes[fan]; ++i) {
            double const angle = 2 * 3.14159265358979323846 * i / sizes[fan];
            positions.emplace_back(std::cos(angle), std::sin(angle), double(fan));
            faces.push_back({0, first + i, first + (i + 1) % sizes[fan]});
        }
    }
    return makeShape(positions, faces);
}

} // namespace

TEST(LimitVertex, ClosedFanBesideAFreeBorder) {
    Shape const shape =
        makeShape({{0, 0, 0}, {1, 0, 1}, {-1, 1, 1}, {-1, -1, 1}, {1, 0, -1}, {0, 1, -1}},
                  {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}, {0, 4, 5}});
    auto const refiner = CreateRefiner(shape, ReferenceMask::Average, 1,
                                       makeOptions(Sdc::Options::VTX_BOUNDARY_NONE));
    ReferenceValues const positions = GetPositions(shape);
    for (int level : {0, 1}) {
        auto const table = makeTable(*refiner, level);
        ASSERT_TRUE(table);
        ASSERT_NO_FATAL_FAILURE(expectSound(*table));
    }
    // The mean plane of three faces in a regular pyramid that is open above.
    auto const table = makeTable(*refiner, 0);
    Shape const straight = [&] {
        Shape moved = shape;
        double const half = std::sqrt(3.0) / 2;
        double const ring[9] = {1, 0, 1, -0.5, half, 1, -0.5, -half, 1};
        std::copy(std::begin(ring), std::end(ring), moved.positions.begin() + 3);
        return moved;
    }();
    LimitSides const sides(refiner->GetLevel(0));
    int const side = sides.FindSide(refiner->GetLevel(0), 0, 0);
    EXPECT_LT(angleBetween(normalOf(*table, side, GetPositions(straight)), Vector::UnitZ()), 1e-6);
}

TEST(LimitVertex, FoldedNonManifoldFansHaveBoundedWeights) {
    Shape const shape = makeShape({{0, 0, 0}, {1, 0, 1}, {-1, 1, 1}, {-1, -1, 1}},
                                  {{0, 2, 1}, {0, 1, 2}, {1, 2, 3}, {2, 1, 3}, {1, 2, 0}});
    for (ReferenceMask mask : kMasks) {
        auto const refiner =
            CreateRefiner(shape, mask, 3, makeOptions(Sdc::Options::VTX_BOUNDARY_EDGE_ONLY));
        for (int level = 0; level <= 3; ++level) {
            SCOPED_TRACE(testing::Message() << ToString(mask) << ", level " << level);
            auto const table = makeTable(*refiner, level);
            ASSERT_TRUE(table);
            ASSERT_NO_FATAL_FAILURE(expectSound(*table));
        }
    }
}

// Each sheet has copies of the crease's vertices from level 2 on.
TEST(LimitVertex, SheetsThatMeetInACreaseHaveTheirOwnPlanes) {
    std::vector<Vector> positions = {{0, 0, 0}, {0, 0, 1}, {0, 0, 2}};
    std::vector<std::vector<int>> faces;
    std::vector<Vector> normals;
    for (double angle : {0.3, 1.9, 3.5}) {
        Vector const out(std::cos(angle), std::sin(angle), 0);
        int const first = int(positions.size());
        for (int z = 0; z < 3; ++z) {
            positions.emplace_back(out + z * Vector::UnitZ());
        }
        for (int z = 0; z < 2; ++z) {
            faces.push_back({z, z + 1, first + z + 1, first + z});
            normals.emplace_back(Vector::UnitZ().cross(out));
        }
    }
    Shape const shape = makeShape(positions, faces);
    for (ReferenceMask mask : kMasks) {
        auto const refiner =
            CreateRefiner(shape, mask, 3, makeOptions(Sdc::Options::VTX_BOUNDARY_EDGE_ONLY));
        for (int i = 0; i <= 3; ++i) {
            SCOPED_TRACE(testing::Message() << ToString(mask) << ", level " << i);
            auto const table = makeTable(*refiner, i);
            ASSERT_TRUE(table);
            ASSERT_NO_FATAL_FAILURE(expectSound(*table));
            TopologyLevel const &level = refiner->GetLevel(i);
            LimitSides const sides(level);
            int const vert = 1; // the middle of the crease
            for (int k = 0; k < level.GetVertexFaces(vert).size(); ++k) {
                int const face = level.GetVertexFaces(vert)[k];
                int const side =
                    sides.FindSide(level, face, level.GetVertexFaceLocalIndices(vert)[k]);
                Vector const normal = normalOf(*table, side, GetPositions(shape));
                double least = 180;
                for (Vector const &expected : normals) {
                    least = std::min(least, angleBetween(normal, expected));
                }
                ASSERT_LT(least, 1e-6) << "face " << face;
            }
        }
    }
}

// With Average, one face beside a smooth border has no tangent plane that finite levels show.
TEST(LimitVertex, NormalsOfNarrowBordersAreThoseOfDeepLevels) {
    Shape const one =
        makeShape({{0, 0, 0}, {1, 0, 0.5}, {0, 1, 0}, {1, 1, 0.8}}, {{0, 1, 2}, {1, 3, 2}});
    Shape const two =
        makeShape({{0, 0, 0}, {1, 0, 0.5}, {1, 1, 0.8}, {0, 1, 0}, {-1, 1, 0.2}, {-1, 0, 0.5}},
                  {{0, 1, 2, 3}, {0, 3, 4, 5}});
    for (Shape const *shape : {&one, &two}) {
        ReferenceValues const positions = GetPositions(*shape);
        for (ReferenceMask mask : kMasks) {
            bool const isOne = shape == &one;
            if (isOne && mask == ReferenceMask::Average) {
                continue;
            }
            SCOPED_TRACE(testing::Message() << (isOne ? "one face, " : "two, ") << ToString(mask));
            int const maxLevel = 8;
            auto const refiner = CreateRefiner(*shape, mask, maxLevel,
                                               makeOptions(Sdc::Options::VTX_BOUNDARY_EDGE_ONLY));
            auto const values = InterpolateLevels(*refiner, positions);
            Vector const deep = meanNormal(refiner->GetLevel(maxLevel), 0, values.back());
            auto const table = makeTable(*refiner, 0);
            ASSERT_TRUE(table);
            Vector const normal = normalOf(*table, 0, positions);
            EXPECT_LT(angleBetween(normal, deep), 1);
            auto const deepTable = makeTable(*refiner, 6);
            ASSERT_TRUE(deepTable);
            EXPECT_LT(angleBetween(normal, normalOf(*deepTable, 0, positions)), 1e-6);
        }
    }
}

// Closed fans of different sizes turn by different angles in a step.
TEST(LimitVertex, ClosedFansOfSeveralSizes) {
    Shape shape = makeFans({5, 6, 7, 9});
    shape.creaseVertexPairs = {0, 1, 0, 3, 0, 8};
    shape.creaseSharpness = {kInfinite, kInfinite, kInfinite};
    for (ReferenceMask mask : kMasks) {
        auto const refiner =
            CreateRefiner(shape, mask, 2, makeOptions(Sdc::Options::VTX_BOUNDARY_EDGE_ONLY));
        for (int i = 0; i <= 2; ++i) {
            SCOPED_TRACE(testing::Message() << ToString(mask) << ", level " << i);
            FarExt::CallStatus status;
            auto const table = makeTable(*refiner, i, &status);
            ASSERT_TRUE(table) << status.GetErrorMessage();
            ASSERT_NO_FATAL_FAILURE(expectSound(*table));
            TopologyLevel const &level = refiner->GetLevel(i);
            LimitSides const sides(level);
            // Two sides of the first fan, which is flat; then three cones, of which one has a sharp
            // edge, that rises as steeply as it goes out.
            int numSides = 0;
            for (int side = 0; side < sides.GetNumSides(); ++side) {
                if (sides.GetVertex(side) == 0) {
                    ++numSides;
                    double const angle =
                        angleBetween(normalOf(*table, side, GetPositions(shape)), Vector::UnitZ());
                    EXPECT_NEAR(angle, sides.GetLocalSide(side) == 2 ? 45 : 0, 1e-6)
                        << "local side " << sides.GetLocalSide(side);
                }
            }
            EXPECT_EQ(numSides, 5);
        }
    }
}

TEST(LimitVertex, PoleOfManyFaces) {
    Shape const shape = makeFans({180, 180});
    auto const refiner = CreateRefiner(shape, ReferenceMask::Average, 0,
                                       makeOptions(Sdc::Options::VTX_BOUNDARY_EDGE_ONLY));
    auto const table = makeTable(*refiner, 0);
    ASSERT_TRUE(table);
    ASSERT_NO_FATAL_FAILURE(expectSound(*table));
    EXPECT_LT(angleBetween(normalOf(*table, 0, GetPositions(shape)), Vector::UnitZ()), 1e-6);
}

// Each side of such a pole is a triangle with three straight edges.  The steps lead a side to the next
// one, so that it comes back to itself after as many as there are.
TEST(LimitVertex, PoleFullOfCreases) {
    for (int numFaces : {4, 60, 400}) {
        SCOPED_TRACE(testing::Message() << numFaces << " faces");
        Shape shape = makeFans({numFaces});
        for (int i = 1; i <= numFaces; ++i) {
            shape.positions[3 * i + 2] = 0.2 * (i % 2);
            shape.creaseVertexPairs.insert(shape.creaseVertexPairs.end(), {0, i});
            shape.creaseSharpness.push_back(kInfinite);
        }
        auto const refiner = CreateRefiner(shape, ReferenceMask::Average, 0,
                                           makeOptions(Sdc::Options::VTX_BOUNDARY_EDGE_ONLY));
        FarExt::CallStatus status;
        auto const table = makeTable(*refiner, 0, &status);
        ASSERT_TRUE(table) << status.GetErrorMessage();
        ASSERT_NO_FATAL_FAILURE(expectSound(*table));
        TopologyLevel const &level = refiner->GetLevel(0);
        LimitSides const sides(level);
        ReferenceValues const positions = GetPositions(shape);
        for (int face = 0; face < numFaces; ++face) {
            auto const verts = level.GetFaceVertices(face);
            Vector const a = positions.row(verts[1]) - positions.row(verts[0]);
            Vector const b = positions.row(verts[2]) - positions.row(verts[0]);
            ASSERT_LT(angleBetween(normalOf(*table, sides.FindSide(level, face, 0), positions),
                                   a.cross(b)),
                      1e-6)
                << "face " << face;
        }
    }
}

// Stencils of all that is around would have all faces of a vertex, or all vertices of a face.
TEST(LimitVertex, RefusesWhereTooManyMeet) {
    constexpr int kMost = 1024;
    auto const check = [](Shape const &shape, bool isRefused, FarExt::ComponentType type,
                          int index) {
        auto const refiner = CreateRefiner(shape, ReferenceMask::Average, 0,
                                           makeOptions(Sdc::Options::VTX_BOUNDARY_EDGE_ONLY));
        FarExt::CallStatus status;
        EXPECT_EQ(!makeTable(*refiner, 0, &status), isRefused) << status.GetErrorMessage();
        if (isRefused) {
            EXPECT_EQ(status.GetCode(), FarExt::StatusCode::Unsupported);
            EXPECT_EQ(status.GetComponentType(), type);
            EXPECT_EQ(status.GetComponentIndex(), index);
        }
    };
    check(MakePole(kMost, 1), false, FarExt::ComponentType::NoComponent, 0);
    check(MakePole(kMost + 1, 1), true, FarExt::ComponentType::Vertex, 0);
    check(MakePrism(kMost), false, FarExt::ComponentType::NoComponent, 0);
    check(MakePrism(kMost + 1), true, FarExt::ComponentType::Face, 0);
    // Fans of two faces each.
    check(MakePole(kMost, 2), false, FarExt::ComponentType::NoComponent, 0);
}

TEST(LimitVertex, RefusesWhatDoesNotConverge) {
    Shape shape = makeFans({140});
    shape.creaseVertexPairs = {0, 1};
    shape.creaseSharpness = {kInfinite};
    auto const refiner = CreateRefiner(shape, ReferenceMask::Average, 0,
                                       makeOptions(Sdc::Options::VTX_BOUNDARY_EDGE_ONLY));
    FarExt::CallStatus status;
    EXPECT_FALSE(makeTable(*refiner, 0, &status));
    EXPECT_EQ(status.GetCode(), FarExt::StatusCode::Unsupported);
    EXPECT_EQ(status.GetComponentType(), FarExt::ComponentType::Vertex);
    EXPECT_EQ(status.GetComponentIndex(), 0);
    EXPECT_NE(status.GetErrorMessage().find("vertex 0 of level 0"), std::string::npos)
        << status.GetErrorMessage();
}

// Faces of any vertices, so that most vertices and edges are not manifold.
TEST(LimitVertex, RandomFacesHaveSoundTables) {
    int numTables = 0;
    for (unsigned seed = 0; seed < 300; ++seed) {
        std::mt19937 random(seed);
        auto const choose = [&](int count) { return int(random() % unsigned(count)); };
        int const numVertices = 4 + choose(6);
        std::vector<Vector> positions(numVertices, Vector::Zero());
        std::vector<int> verts;
        for (int vert = 0; vert < numVertices; ++vert) {
            verts.push_back(vert);
        }
        std::vector<std::vector<int>> faces(1 + choose(8));
        for (std::vector<int> &face : faces) {
            for (int i = numVertices - 1; i > 0; --i) {
                std::swap(verts[i], verts[choose(i + 1)]);
            }
            face.assign(verts.begin(), verts.begin() + 3 + choose(std::min(4, numVertices - 2)));
        }
        Shape shape = makeShape(positions, faces);
        for (int i = choose(4); i > 0; --i) {
            std::vector<int> const &face = faces[choose(int(faces.size()))];
            shape.creaseVertexPairs.insert(shape.creaseVertexPairs.end(), {face[0], face[1]});
            shape.creaseSharpness.push_back(choose(2) ? kInfinite : 0.25f * choose(12));
            shape.cornerVertices.push_back(choose(numVertices));
            shape.cornerSharpness.push_back(choose(2) ? kInfinite : 0.25f * choose(12));
        }
        FarExt::TopologyRefinerFactory::Options options;
        options.hexSchemeOptions.faceMask = ToFaceMask(kMasks[choose(3)]);
        auto const refiner = FarExt::TopologyRefinerFactory::Create(
            ShapeDescriptor(shape).Get(), makeOptions(kBoundaries[choose(3)]), options);
        if (!refiner) {
            continue; // faces that run an edge in the same direction, where those are refused
        }
        int const level = choose(3);
        TopologyRefiner::UniformOptions uniformOptions(level);
        uniformOptions.fullTopologyInLastLevel = true;
        ASSERT_TRUE(refiner->RefineUniform(uniformOptions));
        SCOPED_TRACE(testing::Message() << "seed " << seed << ", level " << level);
        FarExt::CallStatus status;
        auto const table = makeTable(*refiner, level, &status);
        ASSERT_TRUE(table) << status.GetErrorMessage();
        ASSERT_NO_FATAL_FAILURE(expectSound(*table));
        ++numTables;
    }
    EXPECT_GT(numTables, 50);
}

} // namespace OpenSubdivHex::Regression::limitVertexTest
