// SPDX-License-Identifier: Apache-2.0
//
// Faces that an infinitely sharp crease cuts behind a truncation: two surfaces, which meet along it.
#include "cellFixture.h"
#include "surfaceCase.h"
#include "surfaceFixture.h"

#include "regression/shapes/shapeDescriptor.h"

#include <gtest/gtest.h>

#include <opensubdiv/bfr/tessellation.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace OpenSubdivHex::Regression::cutFacesTest {

using BfrExt::CellForest;
using BfrExt::LevelTessellation;
using BfrExt::Surface;
using BfrExt::SurfaceFactory;
using FarExt::SurfaceFaces;

namespace {

constexpr double kAngle = 0.7;
constexpr int kNumX = 8;
constexpr int kNumY = 2; // on each side of the ridge

/// \brief Two planes of triangles, with an angle of kAngle between their normals, that meet along a ridge, the x axis,
/// which is a crease.  Its vertices have two to four triangles on each side.
///
/// Channel 0 has the coordinates in the planes, with a seam along the ridge: of the second plane larger by 10.
struct Roof {
    explicit Roof(float sharpness = Sdc::Crease::SHARPNESS_INFINITE) {
        FVarChannel channel;
        auto const addVertex = [&](int x, int y) {
            shape.positions.insert(
                shape.positions.end(),
                {double(x), y < 0 ? y * std::cos(kAngle) : y, y < 0 ? y * std::sin(kAngle) : 0.0});
        };
        for (int y = -kNumY; y <= kNumY; ++y) {
            for (int x = 0; x <= kNumX; ++x) {
                addVertex(x, y);
            }
        }
        auto const getVertex = [](int x, int y) { return (y + kNumY) * (kNumX + 1) + x; };
        for (int y = -kNumY; y < kNumY; ++y) {
            for (int x = 0; x < kNumX; ++x) {
                int const corners[4][2] = {{x, y}, {x + 1, y}, {x + 1, y + 1}, {x, y + 1}};
                bool const isUp = (x * x + 3 * x * y + y * y) % 3 == 0;
                int const triangles[2][2][3] = {{{0, 1, 2}, {0, 2, 3}}, {{0, 1, 3}, {1, 2, 3}}};
                for (auto const &triangle : triangles[isUp ? 1 : 0]) {
                    shape.faceSizes.push_back(3);
                    for (int const corner : triangle) {
                        auto const [cornerX, cornerY] = corners[corner];
                        shape.faceVertices.push_back(getVertex(cornerX, cornerY));
                        channel.valueIndices.push_back(getVertex(cornerX, cornerY) +
                                                       (y < 0 ? 0 : kNumX + 1));
                    }
                }
            }
        }
        for (int y = -kNumY; y <= kNumY + 1; ++y) { // the ridge twice
            bool const isSecond = y <= 0;
            for (int x = 0; x <= kNumX; ++x) {
                double const offset = isSecond ? 10 : 0;
                channel.values.insert(channel.values.end(),
                                      {x + offset, (isSecond ? y : y - 1) + offset});
            }
        }
        shape.fvarChannels = {channel};
        for (int x = 0; x < kNumX; ++x) {
            shape.creaseVertexPairs.insert(shape.creaseVertexPairs.end(),
                                           {getVertex(x, 0), getVertex(x + 1, 0)});
            shape.creaseSharpness.push_back(sharpness);
        }
        shape.name = "roof";
    }

    Shape shape;
};

bool isInSecondPlane(Vector3 const &normal) { return normal[1] < -std::sin(kAngle / 2); }

Vector3 getPlaneNormal(bool isSecond) {
    return isSecond ? Vector3{0, -std::sin(kAngle), std::cos(kAngle)} : Vector3{0, 0, 1};
}

Sdc::Options getOptions() {
    Sdc::Options options;
    options.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_EDGE_ONLY);
    options.SetFVarLinearInterpolation(Sdc::Options::FVAR_LINEAR_CORNERS_ONLY);
    return options;
}

/// The refiner of a shape, with what is made of it.
struct Made {
    Made(Shape const &shape, SurfaceCase const &surfaceCase)
        : refiner(CreateSurfaceRefiner(shape, surfaceCase, 0, getOptions())),
          factory(SurfaceFactory::Create(*refiner)), faces(factory->GetFaces()) {}

    /// The two sides of each diagonal.
    std::vector<std::array<SurfaceFaces::Side, 2>> GetDiagonals() const {
        std::vector<std::array<SurfaceFaces::Side, 2>> result;
        for (int edge = factory->GetLevel().GetNumEdges(); edge < faces.GetNumEdges(); ++edge) {
            result.push_back({faces.GetSide(edge, 0), faces.GetSide(edge, 1)});
        }
        return result;
    }

    std::unique_ptr<FarExt::TopologyRefiner> refiner;
    std::unique_ptr<SurfaceFactory> factory;
    SurfaceFaces faces;
};

} // namespace

class CutFacesTest : public testing::TestWithParam<SurfaceCase> {};

// Half 0 has the number of the face, and all vertices and edges are those of the level but for the diagonals.
TEST_P(CutFacesTest, AreTwoHalves) {
    Made const made(Roof().shape, GetParam());
    FarExt::TopologyLevel const &level = made.factory->GetLevel();
    int const numCut = made.faces.GetNumFaces() - level.GetNumFaces();
    EXPECT_EQ(numCut, kNumX - 1);
    EXPECT_EQ(made.faces.GetNumEdges() - level.GetNumEdges(), numCut);
    std::set<int> sizes;
    for (int rank = 0; rank < numCut; ++rank) {
        int const second = level.GetNumFaces() + rank;
        auto const [face, half] = made.faces.GetLevelFace(second);
        EXPECT_EQ(half, 1);
        EXPECT_EQ(made.faces.GetFace({face, 0}), face);
        EXPECT_EQ(made.faces.GetFace({face, 1}), second);
        int const size = level.GetFaceVertices(face).size();
        int const end = level.GetFaceDiagonalEnd(face);
        sizes.insert(end);
        int const diagonal = level.GetNumEdges() + rank;
        std::multiset<int> edges;
        for (int const number : {face, second}) {
            FarExt::FaceShape const shape = made.faces.GetShape(number);
            int const ofHalf = number == face ? 0 : 1;
            EXPECT_TRUE(made.faces.IsHalfOfCut(number));
            EXPECT_EQ(shape, FarExt::FaceShape(FarExt::GetHalfSize(ofHalf, size, end), true));
            for (int local = 0; local < shape.size; ++local) {
                auto const [edge, isReversed] = made.faces.GetEdge(number, local);
                edges.insert(edge);
                int const next = (local + 1) % shape.size;
                int const start = made.faces.GetVertex(number, isReversed ? next : local);
                int const stop = made.faces.GetVertex(number, isReversed ? local : next);
                if (local == 0) {
                    EXPECT_EQ(edge, diagonal);
                    EXPECT_EQ(start, level.GetFaceVertices(face)[0]);
                    EXPECT_EQ(stop, level.GetFaceVertices(face)[end]);
                } else {
                    EXPECT_EQ(start, level.GetEdgeVertices(edge)[0]);
                    EXPECT_EQ(stop, level.GetEdgeVertices(edge)[1]);
                }
                auto const [onSide, place] = made.faces.GetSide(edge, isReversed ? 1 : 0);
                EXPECT_EQ(onSide, number);
                EXPECT_EQ(place, local);
                std::vector<int> const around =
                    made.faces.GetVertexFaces(made.faces.GetVertex(number, local));
                EXPECT_EQ(std::count(around.begin(), around.end(), number), 1);
            }
        }
        EXPECT_EQ(int(edges.size()), size + 2);
        EXPECT_EQ(edges.count(diagonal), 2u);
    }
    EXPECT_GT(sizes.size(), 1u);
}

// Normals are those of the two planes; positions are in the plane.
TEST_P(CutFacesTest, HaveTheNormalsOfTheirSides) {
    Roof const roof;
    Made const made(roof.shape, GetParam());
    SurfaceSet<double> const surfaces(*made.refiner, roof.shape.positions);
    int numPlaces = 0;
    for (auto const &sides : made.GetDiagonals()) {
        for (double const t : {0.0, 0.1, 0.25, 0.5, 0.8, 1.0}) {
            Vector3 normals[2];
            Vector3 points[2];
            for (int side = 0; side < 2; ++side) {
                auto const [face, local] = sides[std::size_t(side)];
                EXPECT_EQ(local, 0);
                double uv[2];
                surfaces[face].GetParameterization().GetEdgeCoord(0, side == 0 ? t : 1 - t, uv);
                SurfacePoint const point = surfaces.Evaluate(face, uv);
                normals[side] = GetNormal(point);
                points[side] = point.p;
                EXPECT_LT(
                    GetDistance(normals[side], getPlaneNormal(isInSecondPlane(normals[side]))),
                    1e-6);
            }
            EXPECT_LT(GetDistance(points[0], points[1]), 1e-14);
            EXPECT_NEAR(std::acos(std::min(Dot(normals[0], normals[1]), 1.0)), kAngle, 1e-5)
                << "face " << sides[0].face << " at " << t;
            ++numPlaces;
        }
    }
    EXPECT_EQ(numPlaces, 6 * (kNumX - 1));
}

// A crease that fades cuts no face: the surface is smooth there.
TEST_P(CutFacesTest, AreNotThereWhereACreaseFades) {
    for (float const sharpness : {0.5F, 1.0F, 3.0F, 9.5F}) {
        Made const made(Roof(sharpness).shape, GetParam());
        EXPECT_EQ(made.faces.GetNumFaces(), made.factory->GetLevel().GetNumFaces());
        EXPECT_EQ(made.faces.GetNumEdges(), made.factory->GetLevel().GetNumEdges());
    }
}

// To the bit: of all ways to tessellate, along the diagonals.
TEST_P(CutFacesTest, MeetToTheBit) {
    Shape shape = Roof().shape;
    for (std::size_t i = 0; i < shape.positions.size(); i += 3) { // curved
        shape.positions[i + 2] +=
            0.3 * std::sin(shape.positions[i]) + 0.1 * std::cos(2 * shape.positions[i + 1]);
    }
    Made const made(shape, GetParam());
    std::vector<float> const positions(shape.positions.begin(), shape.positions.end());
    SurfaceSet<float> const surfaces(*made.refiner, positions);
    CellForest const forest = MakeRandomForest(*made.refiner, 3);
    // The points from corner 0 to corner 1, with so many between them: the first ones of a tessellation.
    auto const getDiagonal = [&](int face, auto const &tessellation, int numInner) {
        Surface<float> const &surface = surfaces[face];
        std::vector<float> control(3 * std::size_t(surface.GetNumControlPoints()));
        surface.GatherControlPoints(surfaces.GetPositions().data(), 3, control.data(), 3);
        std::vector<std::array<float, 3>> points(std::size_t(tessellation.GetNumCoords()));
        surface.Evaluate(tessellation, control.data(), 3, points[0].data(), 3);
        points.resize(std::size_t(numInner) + 2);
        return points;
    };
    std::size_t numPoints = 0;
    for (auto const &sides : made.GetDiagonals()) {
        auto const expectSame = [&](auto const &makeTessellation, int numInner) {
            auto first = getDiagonal(sides[0].face, makeTessellation(sides[0].face), numInner);
            auto const second =
                getDiagonal(sides[1].face, makeTessellation(sides[1].face), numInner);
            std::reverse(first.begin(), first.end());
            ASSERT_EQ(first, second);
            numPoints += first.size();
        };
        auto const expectSameOfLevels = [&](auto const &makeTessellation) {
            expectSame(makeTessellation, makeTessellation(sides[0].face).GetNumEdgeCoords(0));
        };
        for (int level = 0; level <= 4; ++level) {
            ASSERT_NO_FATAL_FAILURE(expectSameOfLevels([&](int face) {
                return LevelTessellation(surfaces[face].GetParameterization(), level);
            }));
        }
        ASSERT_NO_FATAL_FAILURE(
            expectSameOfLevels([&](int face) { return forest.GetTessellation(face); }));
        for (int const rate : {1, 2, 3, 7}) {
            auto const make = [&](int face) {
                return OpenSubdiv::Bfr::Tessellation(surfaces[face].GetParameterization(), rate,
                                                     OpenSubdiv::Bfr::Tessellation::Options());
            };
            ASSERT_NO_FATAL_FAILURE(expectSame(make, rate - 1));
        }
    }
    EXPECT_GT(numPoints, 100u);
}

// Where a side of the crease is a hole, the halves there have no surface, and the other ones stay as they are.
TEST_P(CutFacesTest, AreHolesOnTheSideOfHoles) {
    Roof const roof;
    Shape withHoles = roof.shape;
    for (int face = 0; face < roof.shape.GetNumFaces() / 2; ++face) {
        withHoles.holeFaces.push_back(face);
    }
    Made const whole(roof.shape, GetParam());
    Made const made(withHoles, GetParam());
    ASSERT_EQ(made.faces.GetNumFaces(), whole.faces.GetNumFaces());
    SurfaceSet<double> const ofWhole(*whole.refiner, roof.shape.positions);
    SurfaceSet<double> const surfaces(*made.refiner, roof.shape.positions);
    int numHoles = 0;
    for (int face = 0; face < made.faces.GetNumFaces(); ++face) {
        if (!made.faces.IsHalfOfCut(face)) {
            continue;
        }
        bool const isHole = made.factory->GetFaceBaseFace(face) < roof.shape.GetNumFaces() / 2;
        EXPECT_EQ(made.faces.IsHole(face), isHole);
        FarExt::CallStatus status;
        EXPECT_EQ(made.factory->FaceHasLimitSurface(face, &status), !isHole);
        numHoles += isHole ? 1 : 0;
        for (double const t : {0.0, 0.3, 1.0}) {
            double uv[2];
            ofWhole[face].GetParameterization().GetEdgeCoord(0, t, uv);
            SurfacePoint const expected = ofWhole.Evaluate(face, uv);
            EXPECT_EQ(isInSecondPlane(GetNormal(expected)), isHole);
            if (!isHole) {
                SurfacePoint const point = surfaces.Evaluate(face, uv);
                EXPECT_LT(GetDistance(point.p, expected.p), 1e-12);
                EXPECT_LT(GetDistance(GetNormal(point), GetNormal(expected)), 1e-6);
            }
        }
    }
    EXPECT_EQ(numHoles, kNumX - 1);
}

// Each half has the values of its own side of a seam along the crease: they are the coordinates in its plane.
TEST_P(CutFacesTest, HaveTheValuesOfTheirSides) {
    Roof const roof;
    Made const made(roof.shape, GetParam());
    SurfaceSet<double> const surfaces(*made.refiner, roof.shape.positions);
    FarExt::TopologyLevel const &level = made.factory->GetLevel();
    using Value = Numbers<double, 2>;
    std::vector<Value> base(roof.shape.fvarChannels[0].values.size() / 2);
    for (std::size_t i = 0; i < base.size(); ++i) {
        base[i].values = {roof.shape.fvarChannels[0].values[2 * i],
                          roof.shape.fvarChannels[0].values[2 * i + 1]};
    }
    std::vector<Value> values(std::size_t(level.GetNumFVarValues()));
    FarExt::PrimvarRefinerReal<double>(*made.refiner)
        .InterpolateFaceVarying(level.GetDepth(), base, values);
    int numPlaces = 0;
    for (int face = 0; face < made.faces.GetNumFaces(); ++face) {
        if (!made.faces.IsHalfOfCut(face)) {
            continue;
        }
        Surface<double> surface;
        ASSERT_TRUE(made.factory->InitFaceVaryingSurface(face, &surface));
        EXPECT_EQ(surface.GetFaceShape(), made.faces.GetShape(face));
        for (std::array<double, 2> const &uv :
             {std::array{0.0, 0.0}, {0.5, 0.0}, {0.3, 0.05}, {0.4, 0.3}}) {
            std::vector<double> weights(std::size_t(surface.GetNumControlPoints()));
            surface.EvaluateStencil(uv.data(), weights.data());
            double value[2];
            surface.ApplyStencilFromMesh(weights.data(), values[0].values.data(), 2, value);
            SurfacePoint const point = surfaces.Evaluate(face, uv.data());
            // At the ends of the ridge corners of the channel stay.
            if (point.p[0] < 1.5 || point.p[0] > kNumX - 1.5) {
                continue;
            }
            bool const isSecond = isInSecondPlane(GetNormal(point));
            double const offset = isSecond ? 10 : 0;
            double const y = isSecond ? point.p[1] / std::cos(kAngle) : point.p[1];
            EXPECT_NEAR(value[0], point.p[0] + offset, 1e-9) << "face " << face;
            EXPECT_NEAR(value[1], y + offset, 1e-9) << "face " << face;
            ++numPlaces;
        }
    }
    EXPECT_EQ(numPlaces, 8 * (kNumX - 3));
}

namespace {

std::string getName(testing::TestParamInfo<SurfaceCase> const &info) {
    return info.param.GetName();
}

} // namespace

INSTANTIATE_TEST_SUITE_P(Masks, CutFacesTest, testing::ValuesIn(kTruncateCases), getName);

} // namespace OpenSubdivHex::Regression::cutFacesTest
