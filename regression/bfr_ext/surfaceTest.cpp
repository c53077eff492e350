// SPDX-License-Identifier: Apache-2.0
//
// Surfaces of base faces, against limit tables of whole meshes and against what they must be.
#include "facePlaces.h"
#include "surfaceCase.h"
#include "surfaceFixture.h"

#include "far_ext/primvarRefiner.h"
#include "far_ext/stencilTableFactory.h"
#include "regression/far_ext/referenceMatch.h"
#include "regression/shapes/featureShapes.h"
#include "regression/shapes/flatShapes.h"
#include "regression/shapes/meshOperations.h"
#include "regression/shapes/shapeDescriptor.h"
#include "regression/shapes/torus.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>
#include <thread>

namespace OpenSubdivHex::Regression::surfaceTest {

using FarExt::StatusCode;
using FarExt::TopologyLevel;
using FarExt::TopologyRefiner;
using Tables = FarExt::LimitStencilTableFactoryReal<double>;

namespace {

constexpr double kTolerance = 1e-11;

Vector3 apply(Tables::Table const &table, std::vector<double> const &weights, int row,
              std::vector<double> const &points) {
    Vector3 sum{};
    int const offset = table.GetOffsets()[std::size_t(row)];
    for (int k = offset; k < offset + table.GetSizes()[row]; ++k) {
        auto const point = 3 * std::size_t(table.GetControlIndices()[std::size_t(k)]);
        for (std::size_t i = 0; i < 3; ++i) {
            sum[i] += weights[std::size_t(k)] * points[point + i];
        }
    }
    return sum;
}

/// A corner of a face of a level, in a face of the surface level.
struct LevelCorner {
    int face;
    int vert;
    int side; ///< as LimitSides numbers them
    double uv[2];
};

std::vector<LevelCorner> getCorners(TopologyLevel const &level) {
    FarExt::LimitSides const sides(level);
    std::vector<LevelCorner> result;
    for (int face = 0; face < level.GetNumFaces(); ++face) {
        auto const verts = level.GetFaceVertices(face);
        bool const isSplit = level.GetFaceSurfaceFace(face, 0) != level.GetFaceSurfaceFace(face, 1);
        for (int half = 0; half < 1 + isSplit; ++half) {
            std::vector<double> uv(2 * std::size_t(verts.size()));
            EXPECT_TRUE(level.GetFaceSurfaceCoords(face, half, uv.data()));
            int const end = level.GetFaceDiagonalEnd(face);
            int const count = isSplit ? FarExt::GetHalfSize(half, verts.size(), end) : verts.size();
            for (int i = 0; i < count; ++i) {
                int const local = isSplit ? FarExt::GetPlaceInHalves(half, i, end) : i;
                result.push_back({level.GetFaceSurfaceFace(face, half),
                                  verts[local],
                                  sides.FindSide(level, face, local, half),
                                  {uv[2 * std::size_t(i)], uv[2 * std::size_t(i) + 1]}});
            }
        }
    }
    return result;
}

struct Limits {
    explicit Limits(TopologyRefiner const &refiner) {
        Tables::Options options;
        options.level = refiner.GetMaxLevel();
        options.generateFurtherSides = true;
        table = Tables::Create(refiner, options);
    }

    std::unique_ptr<Tables::Table const> table;
};

using Point = Numbers<double, 3>;

/// Finds the limits of all vertices of the last level, from positions of level 0.
std::vector<Point> findLimits(TopologyRefiner const &refiner,
                              std::vector<double> const &positions) {
    FarExt::PrimvarRefinerReal<double> const primvarRefiner(refiner);
    std::vector<Point> points = ToPoints(positions);
    for (int level = 1; level <= refiner.GetMaxLevel(); ++level) {
        std::vector<Point> next(std::size_t(refiner.GetLevel(level).GetNumVertices()));
        primvarRefiner.Interpolate(level, points, next);
        points = std::move(next);
    }
    std::vector<Point> limits(points.size());
    FarExt::CallStatus status;
    EXPECT_TRUE(primvarRefiner.Limit(points, limits, &status)) << status.GetErrorMessage();
    return limits;
}

bool isAtFreeBoundary(TopologyLevel const &level, int face) {
    for (int const vert : level.GetFaceVertices(face)) {
        for (int const edge : level.GetVertexEdges(vert)) {
            if (level.IsEdgeBoundary(edge) && level.GetEdgeSharpness(edge) == 0) {
                return true;
            }
        }
    }
    return false;
}

void expectLimits(Shape const &shape, SurfaceCase const &surfaceCase, Sdc::Options const &options,
                  BfrExt::SurfaceFactoryCache &cache) {
    int const level = GetTestLevel(shape, 2, surfaceCase.HasFirstStep() ? 700 : 8000);
    auto const refiner = CreateSurfaceRefiner(shape, surfaceCase, level, options);
    std::vector<Point> const limits = findLimits(*refiner, shape.positions);
    SurfaceSet<double> const surfaces(*refiner, shape.positions, &cache);
    TopologyLevel const &base = refiner->GetLevel(refiner->GetMaxLevel() - level);
    bool const isFree = options.GetVtxBoundaryInterpolation() == Sdc::Options::VTX_BOUNDARY_NONE;
    FarExt::SurfaceFaces const faces(base.GetLevel());
    for (int face = 0; face < faces.GetNumFaces(); ++face) {
        bool const isAtFree = isFree && isAtFreeBoundary(base, faces.GetLevelFace(face).face);
        ASSERT_EQ(surfaces[face].IsValid(), !faces.IsHole(face) && !isAtFree) << "face " << face;
    }
    for (LevelCorner const &corner : getCorners(refiner->GetLevel(refiner->GetMaxLevel()))) {
        if (surfaces[corner.face].IsValid()) {
            ASSERT_LE(GetDistance(surfaces.EvaluatePosition(corner.face, corner.uv),
                                  limits[std::size_t(corner.vert)].values),
                      kTolerance)
                << "vertex " << corner.vert << " in face " << corner.face;
        }
    }
}

Sdc::Options getOptions(Sdc::Options::VtxBoundaryInterpolation boundary) {
    Sdc::Options options;
    options.SetVtxBoundaryInterpolation(boundary);
    return options;
}

/// Places in a polygon, none of them near its edges.
std::vector<std::array<double, 2>> getRandomPlaces(int size, int count) {
    std::mt19937 random{unsigned(size)};
    std::uniform_real_distribution<double> uniform(0.05, 1);
    std::vector<std::array<double, 2>> result(std::size_t(count), {0.0, 0.0});
    for (std::array<double, 2> &place : result) {
        std::vector<double> weights(static_cast<std::size_t>(size));
        double sum = 0;
        for (double &weight : weights) {
            sum += weight = uniform(random);
        }
        for (int i = 0; i < size; ++i) {
            FacePlace const corner = ToPlane(size, MakeFacePlace(size, i, 1, 0).data());
            place[0] += weights[std::size_t(i)] / sum * corner[0];
            place[1] += weights[std::size_t(i)] / sum * corner[1];
        }
        place = FromPlane(size, place);
    }
    return result;
}

} // namespace

class SurfaceLimitTest : public testing::TestWithParam<SurfaceCase> {};
class FeatureLimitTest : public testing::TestWithParam<SurfaceCase> {};

TEST_P(SurfaceLimitTest, IsThatOfVerticesOfAllLevels) {
    BfrExt::SurfaceFactoryCache cache;
    for (Shape const &shape : GetParam().IsPlain() ? GetManifoldShapes() : GetShapes()) {
        SCOPED_TRACE(shape.name);
        ASSERT_NO_FATAL_FAILURE(expectLimits(
            shape, GetParam(), getOptions(Sdc::Options::VTX_BOUNDARY_EDGE_ONLY), cache));
    }
}

// Around columns of three to six quads the lattice meets itself, in other ways than at the ends.
TEST_P(SurfaceLimitTest, IsThatOfVerticesOfColumns) {
    BfrExt::SurfaceFactoryCache cache;
    for (int numSides = 3; numSides <= 6; ++numSides) {
        SCOPED_TRACE(numSides);
        ASSERT_NO_FATAL_FAILURE(expectLimits(MakePrism(numSides, 1, 8), GetParam(),
                                             getOptions(Sdc::Options::VTX_BOUNDARY_EDGE_ONLY),
                                             cache));
    }
}

// Such a pole is a corner with a fan for each edge, or, with a semi-sharp edge, in the end one.
TEST_P(FeatureLimitTest, IsThatOfVerticesAtPolesThatFacesNameTwice) {
    BfrExt::SurfaceFactoryCache cache;
    Sdc::Options options = getOptions(Sdc::Options::VTX_BOUNDARY_EDGE_ONLY);
    for (auto const creasing : {Sdc::Options::CREASE_UNIFORM, Sdc::Options::CREASE_CHAIKIN}) {
        options.SetCreasingMethod(creasing);
        for (float const sharpness : {0.0F, 1.5F, Sdc::Crease::SHARPNESS_INFINITE}) {
            SCOPED_TRACE(sharpness);
            Shape shape = MakePole(7, 2);
            Deform(shape);
            shape.creaseVertexPairs = {0, 3, 3, 10, 0, 4, 4, 5};
            shape.creaseSharpness.assign(4, sharpness);
            ASSERT_NO_FATAL_FAILURE(expectLimits(shape, GetParam(), options, cache));
        }
    }
}

TEST_P(FeatureLimitTest, IsThatOfVerticesOfAllLevels) {
    BfrExt::SurfaceFactoryCache cache;
    for (Shape const &shape : GetFeatureShapes()) {
        for (auto const boundary : kBoundaries) {
            SCOPED_TRACE(testing::Message() << shape.name << ", boundary rule " << boundary);
            ASSERT_NO_FATAL_FAILURE(expectLimits(shape, GetParam(), getOptions(boundary), cache));
        }
    }
}

namespace {

std::string getName(testing::TestParamInfo<SurfaceCase> const &info) {
    return info.param.GetName();
}

} // namespace

INSTANTIATE_TEST_SUITE_P(Masks, SurfaceLimitTest, testing::ValuesIn(kPlainCases), getName);
INSTANTIATE_TEST_SUITE_P(Truncate, SurfaceLimitTest, testing::ValuesIn(kTruncateCases), getName);
INSTANTIATE_TEST_SUITE_P(TriHex, SurfaceLimitTest, testing::ValuesIn(kTriHexCases), getName);
INSTANTIATE_TEST_SUITE_P(Masks, FeatureLimitTest, testing::ValuesIn(kPlainCases), getName);
INSTANTIATE_TEST_SUITE_P(Truncate, FeatureLimitTest, testing::ValuesIn(kTruncateCases), getName);

class SurfaceTest : public testing::TestWithParam<ReferenceMask> {};

TEST_P(SurfaceTest, HasTheNormalsOfLimitTables) {
    // Such small n-gons that all vertices have tangent planes that iteration finds.
    for (char const *const name : {"cube", "icosahedron", "hexTorus", "dodecahedron"}) {
        Shape const &shape = GetShape(name);
        SCOPED_TRACE(name);
        auto const refiner = CreateRefiner(shape, GetParam(), 2);
        Limits const limits(*refiner);
        SurfaceSet<double> const surfaces(*refiner, shape.positions);
        for (LevelCorner const &corner : getCorners(refiner->GetLevel(2))) {
            Vector3 const normal = GetNormal(surfaces.Evaluate(corner.face, corner.uv));
            Vector3 const expected = Normalize(Cross(
                apply(*limits.table, limits.table->GetDuWeights(), corner.side, shape.positions),
                apply(*limits.table, limits.table->GetDvWeights(), corner.side, shape.positions)));
            ASSERT_LE(GetDistance(normal, expected), 1e-7) << "vertex " << corner.vert;
        }
    }
}

// Where a crease passes the vertices of a truncated mesh, with two and three triangles on its sides.
TEST_P(SurfaceTest, HasTheNormalsOfLimitTablesOnBothSidesOfACrease) {
    Shape const &shape = GetFeatureShape("creaseLoopClosed");
    auto const refiner = CreateSurfaceRefiner(shape, {GetParam(), FarExt::FirstStep::Truncate}, 1);
    TopologyLevel const &level = refiner->GetLevel(refiner->GetMaxLevel());
    FarExt::LimitSides const sides(level);
    Limits const limits(*refiner);
    SurfaceSet<double> const surfaces(*refiner, shape.positions);
    int numOfSecondSides = 0;
    for (LevelCorner const &corner : getCorners(level)) {
        Vector3 const normal = GetNormal(surfaces.Evaluate(corner.face, corner.uv));
        Vector3 const expected = Normalize(Cross(
            apply(*limits.table, limits.table->GetDuWeights(), corner.side, shape.positions),
            apply(*limits.table, limits.table->GetDvWeights(), corner.side, shape.positions)));
        EXPECT_LE(GetDistance(normal, expected), 1e-6)
            << "vertex " << corner.vert << " in face " << corner.face;
        numOfSecondSides += sides.GetLocalSide(corner.side) > 0 ? 1 : 0;
    }
    EXPECT_GT(numOfSecondSides, 40);
}

TEST_P(SurfaceTest, HasAnyPlaceBetweenThoseAround) {
    Shape const &shape = GetShape("icosahedron");
    auto const refiner = CreateRefiner(shape, GetParam(), 0);
    SurfaceSet<double> const surfaces(*refiner, shape.positions);
    for (std::array<double, 2> const &uv : getRandomPlaces(3, 50)) {
        std::vector<double> weights(std::size_t(surfaces[0].GetNumControlPoints()));
        ASSERT_EQ(surfaces[0].EvaluateStencil(uv.data(), weights.data()), int(weights.size()));
        double sum = 0;
        for (double const weight : weights) {
            ASSERT_GE(weight, 0);
            sum += weight;
        }
        ASSERT_NEAR(sum, 1, kTolerance);
        Vector3 const p = surfaces.Evaluate(0, uv.data()).p;
        for (double const step : {1e-9, -1e-9}) {
            double const beside[2] = {uv[0] + step, uv[1] - step};
            ASSERT_LE(GetDistance(surfaces.Evaluate(0, beside).p, p), 2e-6);
        }
    }
}

// However small the cells are whose differences they were made of.
TEST_P(SurfaceTest, DerivativesDoNotDependOnWhereTheMeshIs) {
    Shape const &shape = GetFeatureShape("mixedSharpnessQuads");
    Sdc::Options options;
    options.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_EDGE_ONLY);
    auto const refiner = CreateRefiner(shape, GetParam(), 0, options);
    SurfaceSet<double> const surfaces(*refiner, shape.positions);
    for (int face = 0; face < shape.GetNumFaces(); ++face) {
        std::vector<double> far(std::size_t(surfaces[face].GetNumPatchPoints()), 1e6);
        surfaces[face].ComputePatchPoints(far.data(), 1);
        // On edges and inside.
        for (std::array<double, 2> uv : getRandomPlaces(4, 20)) {
            for (double const v : {uv[1], 0.0}) {
                uv[1] = v;
                double p;
                double du;
                double dv;
                surfaces[face].Evaluate(uv.data(), far.data(), 1, &p, &du, &dv);
                ASSERT_NEAR(du, 0, 1e-6) << "face " << face << " at " << uv[0] << ", " << uv[1];
                ASSERT_NEAR(dv, 0, 1e-6) << "face " << face << " at " << uv[0] << ", " << uv[1];
            }
        }
    }
}

TEST_P(SurfaceTest, TakesPlacesOutsideToTheEdgeAndNoNumbersForNone) {
    Shape const &shape = GetShape("icosahedron");
    auto const refiner = CreateRefiner(shape, GetParam(), 0);
    SurfaceSet<double> const surfaces(*refiner, shape.positions);
    constexpr double kInfinite = std::numeric_limits<double>::infinity();
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    double const center[2] = {1.0 / 3, 1.0 / 3}; // Bfr's is in single precision
    for (Vector3 const &direction : {Vector3{1, 0, 0}, {-0.3, 0.8, 0}, {0.1, -1, 0}}) {
        auto const evaluate = [&](double distance) {
            double const uv[2] = {center[0] + distance * direction[0],
                                  center[1] + distance * direction[1]};
            return surfaces.EvaluatePosition(0, uv);
        };
        for (double const distance : {2.0, 1e9, 1e90}) {
            EXPECT_LE(GetDistance(evaluate(distance), evaluate(1)), kTolerance) << distance;
        }
    }
    for (double const u : {1e308, kInfinite}) {
        for (double const v : {-u, 0.0, u}) {
            double const uv[2] = {u, v};
            SurfacePoint const point = surfaces.Evaluate(0, uv);
            EXPECT_LE(GetLength(point.p), 2) << u << ", " << v;
            EXPECT_GT(GetLength(Cross(point.du, point.dv)), 0) << u << ", " << v;
        }
    }
    for (auto const &uv : {std::array{kNone, 0.25}, {0.25, kNone}, {kNone, kNone}}) {
        SurfacePoint const point = surfaces.Evaluate(0, uv.data());
        for (Vector3 const &vector : {point.p, point.du, point.dv}) {
            for (double const number : vector) {
                EXPECT_TRUE(std::isnan(number)) << uv[0] << ", " << uv[1];
            }
        }
        std::vector<double> weights(std::size_t(surfaces[0].GetNumControlPoints()));
        surfaces[0].EvaluateStencil(uv.data(), weights.data());
        EXPECT_TRUE(std::isnan(std::accumulate(weights.begin(), weights.end(), 0.0)));
    }
}

// On a plane of regular hexagons linear functions are kept, and places in it are one.
TEST_P(SurfaceTest, IsThePlaneOfRegularHexagons) {
    Shape const shape = MakeTiling(Tiling::Hexagons, 7, 7);
    auto const refiner = CreateRefiner(shape, GetParam(), 0);
    SurfaceSet<double> const surfaces(*refiner, shape.positions);
    int const face = 24; // the middle
    TopologyLevel const &base = refiner->GetLevel(0);
    Vector3 corners[6];
    for (int i = 0; i < 6; ++i) {
        double uv[2];
        surfaces[face].GetParameterization().GetVertexCoord(i, uv);
        corners[i] = surfaces.Evaluate(face, uv).p;
        auto const vert = 3 * std::size_t(base.GetFaceVertices(face)[i]);
        ASSERT_LE(GetDistance(corners[i], {shape.positions[vert], shape.positions[vert + 1],
                                           shape.positions[vert + 2]}),
                  kTolerance);
    }
    Vector3 const du = Subtract(corners[1], corners[0]);
    Vector3 const dv = Scale(Subtract(corners[4], corners[0]), 1 / std::sqrt(3.0));
    for (std::array<double, 2> const &uv : getRandomPlaces(6, 50)) {
        SurfacePoint const point = surfaces.Evaluate(face, uv.data());
        auto const [coords, byU, byV, byUv] =
            FarExt::internal::FindInPlane(BfrExt::Parameterization(6), uv);
        auto const inPlane = [&](FacePlace const &of) {
            return Subtract(Scale(du, of[0]), Scale(dv, -of[1]));
        };
        Vector3 const away = Subtract(Subtract(point.p, corners[0]), inPlane(coords));
        if (GetParam() == ReferenceMask::Average) {
            // Linear functions are kept at vertices alone.
            ASSERT_NEAR(GetLength(Cross(GetNormal(point), Normalize(Cross(du, dv)))), 0, 1e-6);
            continue;
        }
        ASSERT_LE(GetLength(away), kTolerance);
        ASSERT_LE(GetDistance(point.du, inPlane(byU)), 2e-6);
        ASSERT_LE(GetDistance(point.dv, inPlane(byV)), 2e-6);
    }
}

// Where there are no derivatives by u and v, their directions are there.
TEST(AverageSurfaceTest, HasTheDirectionsOfItsPointsAtCornersOfManySides) {
    constexpr int kSize = 360;
    Shape const &shape = GetShape("prism360");
    auto const refiner = CreateRefiner(shape, ReferenceMask::Average, 0, Sdc::Options());
    auto const factory = BfrExt::SurfaceFactory::Create(*refiner);
    FarExt::TopologyLevel const &base = refiner->GetLevel(0);
    int face = 0;
    while (base.GetFaceVertices(face).size() != kSize) {
        ++face;
    }
    BfrExt::Surface<double> surface;
    ASSERT_TRUE(factory->InitVertexSurface(face, &surface));
    double const origin[2] = {0, 0};
    SurfacePoint const corner = EvaluateSurface(surface, shape.positions, origin);
    double before = 0;
    for (int level = 10; level <= 16; level += 2) {
        double const uv[2] = {std::ldexp(1.0, -level), 0};
        Vector3 const point = EvaluateSurface(surface, shape.positions, uv).p;
        Vector3 const difference = Scale(Subtract(point, corner.p), 1 / uv[0]);
        EXPECT_LE(GetDistance(Normalize(difference), Normalize(corner.du)), std::ldexp(1.0, -level))
            << "level " << level;
        double const length = GetLength(difference);
        if (level > 10) {
            // A step shrinks what is around a vertex of three faces by .4405, and u by 1/2.
            EXPECT_NEAR(length / before, std::pow(2 * 0.4405, 2), 1e-3) << "level " << level;
        }
        before = length;
    }
}

TEST_P(SurfaceTest, HasTheDerivativesOfItsPoints) {
    if (GetParam() == ReferenceMask::Average) {
        return; // has none
    }
    constexpr double kStep = 1e-4;
    for (char const *const name : {"cube", "icosahedron", "creasedBall", "dartsQuads"}) {
        SCOPED_TRACE(name);
        bool const isFeature =
            std::string(name) == "creasedBall" || std::string(name) == "dartsQuads";
        Shape const &shape = isFeature ? GetFeatureShape(name) : GetShape(name);
        auto const refiner =
            CreateRefiner(shape, GetParam(), 0, getOptions(Sdc::Options::VTX_BOUNDARY_EDGE_ONLY));
        SurfaceSet<double> const surfaces(*refiner, shape.positions);
        for (int face = 0; face < refiner->GetLevel(0).GetNumFaces(); ++face) {
            for (std::array<double, 2> const &uv :
                 getRandomPlaces(surfaces[face].GetFaceSize(), 10)) {
                SurfacePoint const point = surfaces.Evaluate(face, uv.data());
                double const next[2][2] = {{uv[0] + kStep, uv[1]}, {uv[0], uv[1] + kStep}};
                double const before[2][2] = {{uv[0] - kStep, uv[1]}, {uv[0], uv[1] - kStep}};
                for (int k = 0; k < 2; ++k) {
                    Vector3 const difference = Scale(Subtract(surfaces.Evaluate(face, next[k]).p,
                                                              surfaces.Evaluate(face, before[k]).p),
                                                     0.5 / kStep);
                    Vector3 const &derivative = k == 0 ? point.du : point.dv;
                    ASSERT_LE(GetDistance(derivative, difference), 0.02 * GetLength(derivative))
                        << "face " << face << " at " << uv[0] << ", " << uv[1];
                }
            }
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Masks, SurfaceTest, testing::ValuesIn(kMasks),
                         [](auto const &mask) { return std::string(ToString(mask.param)); });

namespace {

using Number = Numbers<double, 1>;

std::vector<Number> makeNumbers(int count) {
    std::vector<Number> result(static_cast<std::size_t>(count));
    for (std::size_t i = 0; i < result.size(); ++i) {
        result[i].values[0] = std::sin(3.0 * double(i));
    }
    return result;
}

double evaluate(BfrExt::Surface<double> const &surface, std::vector<Number> const &points,
                double const uv[2]) {
    std::vector<double> weights(std::size_t(surface.GetNumControlPoints()));
    surface.EvaluateStencil(uv, weights.data());
    double result = 0;
    surface.ApplyStencilFromMesh(weights.data(), points[0].values.data(), 1, &result);
    return result;
}

} // namespace

class SurfaceDataTest : public testing::TestWithParam<SurfaceCase> {};

TEST_P(SurfaceDataTest, VaryingDataStay) {
    for (char const *const name : {"creasedBall", "creaseMeetsBorderTriangles", "bowTieOfFans"}) {
        SCOPED_TRACE(name);
        Shape const &shape = GetFeatureShape(name);
        auto const refiner = CreateSurfaceRefiner(shape, GetParam(), 3,
                                                  getOptions(Sdc::Options::VTX_BOUNDARY_EDGE_ONLY));
        auto const factory = BfrExt::SurfaceFactory::Create(*refiner);
        std::vector<Number> values = makeNumbers(shape.GetNumVertices());
        std::vector<Number> base = values;
        for (int level = 1; level <= refiner->GetMaxLevel(); ++level) {
            std::vector<Number> next(std::size_t(refiner->GetLevel(level).GetNumVertices()));
            FarExt::PrimvarRefinerReal<double>(*refiner).InterpolateVarying(level, values, next);
            values = std::move(next);
            if (level == factory->GetLevel().GetDepth()) {
                base = values;
            }
        }
        for (LevelCorner const &corner : getCorners(refiner->GetLevel(refiner->GetMaxLevel()))) {
            BfrExt::Surface<double> surface;
            ASSERT_TRUE(factory->InitVaryingSurface(corner.face, &surface));
            ASSERT_NEAR(evaluate(surface, base, corner.uv),
                        values[std::size_t(corner.vert)].values[0], kTolerance)
                << "vertex " << corner.vert;
        }
    }
}

TEST_P(SurfaceDataTest, FaceVaryingValuesAreTheirLimits) {
    constexpr int kLevel = 6;
    int const numSteps = kLevel - (GetParam().HasFirstStep() ? 1 : 0);
    for (auto const rule : {Sdc::Options::FVAR_LINEAR_ALL, Sdc::Options::FVAR_LINEAR_NONE,
                            Sdc::Options::FVAR_LINEAR_CORNERS_ONLY}) {
        for (char const *const name : {"seamAcrossCrease", "seamsCross", "cornersOnSeam"}) {
            SCOPED_TRACE(testing::Message() << name << ", rule " << rule);
            Shape const &shape = GetFeatureShape(name);
            Sdc::Options options = getOptions(Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER);
            options.SetFVarLinearInterpolation(rule);
            auto const refiner = CreateSurfaceRefiner(shape, GetParam(), numSteps, options);
            auto const factory = BfrExt::SurfaceFactory::Create(*refiner);
            std::vector<Number> values = makeNumbers(refiner->GetLevel(0).GetNumFVarValues());
            std::vector<Number> base = values;
            for (int level = 1; level <= kLevel; ++level) {
                std::vector<Number> next(std::size_t(refiner->GetLevel(level).GetNumFVarValues()));
                FarExt::PrimvarRefinerReal<double>(*refiner).InterpolateFaceVarying(level, values,
                                                                                    next);
                values = std::move(next);
                if (level == factory->GetLevel().GetDepth()) {
                    base = values;
                }
            }
            TopologyLevel const &level = refiner->GetLevel(kLevel);
            for (int face = 0; face < level.GetNumFaces(); face += 7) {
                int const ofSurface = level.GetFaceSurfaceFace(face);
                if (level.IsFaceFVarSplit(face) || level.GetFaceSurfaceFace(face, 1) != ofSurface) {
                    continue;
                }
                BfrExt::Surface<double> surface;
                ASSERT_TRUE(factory->InitFaceVaryingSurface(ofSurface, &surface));
                auto const faceValues = level.GetFaceFVarValues(face);
                std::vector<double> uv(2 * std::size_t(faceValues.size()));
                level.GetFaceSurfaceCoords(face, 0, uv.data());
                for (int i = 0; i < faceValues.size(); ++i) {
                    // Values of the level are as far from their limits as its faces are large.
                    ASSERT_NEAR(evaluate(surface, base, uv.data() + 2 * std::ptrdiff_t(i)),
                                values[std::size_t(faceValues[i])].values[0],
                                rule == Sdc::Options::FVAR_LINEAR_ALL ? kTolerance : 1e-2)
                        << "value " << faceValues[i];
                }
            }
        }
    }
}

INSTANTIATE_TEST_SUITE_P(, SurfaceDataTest, testing::Values(kPlainCases[2], kTruncateCases[2]),
                         getName);

TEST(SurfaceFactoryTest, RefusesFacesWithoutASurface) {
    Shape const &shape = GetShape("quadGrid");
    auto const refiner =
        CreateRefiner(shape, ReferenceMask::Smooth, 0, getOptions(Sdc::Options::VTX_BOUNDARY_NONE));
    auto const factory = BfrExt::SurfaceFactory::Create(*refiner);
    BfrExt::Surface<float> surface;
    FarExt::CallStatus status;
    EXPECT_FALSE(factory->InitVertexSurface(0, &surface, &status));
    EXPECT_FALSE(surface.IsValid());
    EXPECT_EQ(status.GetCode(), StatusCode::Unsupported);
    EXPECT_EQ(status.GetComponentType(), FarExt::ComponentType::Face);
    EXPECT_EQ(status.GetComponentIndex(), 0);
    EXPECT_NE(status.GetErrorMessage().find("VTX_BOUNDARY_NONE"), std::string::npos);

    for (int const face : {-1, shape.GetNumFaces()}) {
        EXPECT_FALSE(factory->FaceHasLimitSurface(face, &status));
        EXPECT_EQ(status.GetCode(), StatusCode::InvalidArgument);
        EXPECT_EQ(status.GetComponentIndex(), face);
    }
    for (int const channel : {-1, 0}) {
        EXPECT_FALSE(factory->InitFaceVaryingSurface(0, &surface, channel, &status));
        EXPECT_EQ(status.GetCode(), StatusCode::InvalidArgument);
    }

    Shape withHole = GetShape("cube");
    withHole.holeFaces = {2};
    auto const refinerOfHole = CreateRefiner(withHole, ReferenceMask::Smooth, 0);
    auto const factoryOfHole = BfrExt::SurfaceFactory::Create(*refinerOfHole);
    EXPECT_FALSE(factoryOfHole->FaceHasLimitSurface(2, &status));
    EXPECT_EQ(status.GetCode(), StatusCode::InvalidArgument);
    EXPECT_EQ(status.GetComponentIndex(), 2);
    EXPECT_TRUE(factoryOfHole->InitVertexSurface(1, &surface, &status));
    EXPECT_TRUE(status.IsOk());
}

namespace {

/// Expects that faces around the pole of a shape have no surface, with an error that names \p index, and faces farther
/// out have one; or that all have one.
void expectCrowd(Shape const &shape, FarExt::ComponentType type, int index, bool isRefused) {
    SCOPED_TRACE(shape.GetNumFaces());
    int const n = shape.GetNumFaces() / 3;
    auto const refiner = CreateRefiner(shape, ReferenceMask::Smooth, 0,
                                       getOptions(Sdc::Options::VTX_BOUNDARY_EDGE_ONLY));
    auto const factory = BfrExt::SurfaceFactory::Create(*refiner);
    BfrExt::Surface<float> surface;
    for (int const face : {0, n / 2, n + 1, 2 * n + 2}) {
        SCOPED_TRACE(face);
        bool const hasNone = isRefused && face < 2 * n;
        FarExt::CallStatus status;
        EXPECT_EQ(factory->InitVertexSurface(face, &surface, &status), !hasNone)
            << status.GetErrorMessage();
        EXPECT_EQ(surface.IsValid(), !hasNone);
        for (bool const isInit : {true, false}) {
            if (!isInit) {
                EXPECT_EQ(factory->FaceHasLimitSurface(face, &status), !hasNone);
            }
            if (hasNone) {
                EXPECT_EQ(status.GetCode(), StatusCode::Unsupported);
                EXPECT_EQ(status.GetComponentType(), type);
                EXPECT_EQ(status.GetComponentIndex(), index);
                EXPECT_EQ(status.GetErrorMessage().find("face " + std::to_string(face) +
                                                        " has no limit surface: "),
                          0);
            }
        }
    }
}

/// A pole with creases from it to some of the vertices around.
Shape makeCreasedPole(int n, std::vector<int> const &verts, std::vector<float> const &sharpness) {
    Shape shape = MakePole(n, 1);
    for (std::size_t i = 0; i < verts.size(); ++i) {
        shape.creaseVertexPairs.insert(shape.creaseVertexPairs.end(), {0, 1 + verts[i]});
        shape.creaseSharpness.push_back(sharpness[i]);
    }
    return shape;
}

} // namespace

TEST(SurfaceFactoryTest, RefusesFacesWhereTooManyMeet) {
    auto const expectMost = [](int most, auto const &makeShape) {
        expectCrowd(makeShape(most), FarExt::ComponentType::Vertex, 0, false);
        expectCrowd(makeShape(most + 1), FarExt::ComponentType::Vertex, 0, true);
    };
    float const infinite = Sdc::Crease::SHARPNESS_INFINITE;
    expectMost(512, [](int n) { return MakePole(n, 1); });
    expectMost(128, [&](int n) { return makeCreasedPole(n, {0, n / 3}, {infinite, infinite}); });
    expectMost(128, [&](int n) { return makeCreasedPole(n, {1}, {infinite}); });
    expectMost(64, [&](int n) { return makeCreasedPole(n, {1, 5}, {2, 1.5F}); });
    // Alike all around, and of fans that count by themselves.
    Shape pole = MakePole(300, 1);
    for (int i = 0; i < 300; ++i) {
        pole.creaseVertexPairs.insert(pole.creaseVertexPairs.end(), {0, 1 + i});
        pole.creaseSharpness.push_back(2.5F);
    }
    expectCrowd(pole, FarExt::ComponentType::Vertex, 0, false);
    expectCrowd(MakePole(2000, 2), FarExt::ComponentType::Vertex, 0, false);
}

TEST(SurfaceFactoryTest, RefusesWhatIsAroundLargeFaces) {
    constexpr int kMost = 1024;
    for (int const n : {kMost, kMost + 1}) {
        // One face in the place of those at the pole.
        Shape shape = MakePole(n, 1);
        shape.faceSizes.erase(shape.faceSizes.begin(), shape.faceSizes.begin() + n - 1);
        shape.faceSizes[0] = n;
        shape.faceVertices.erase(shape.faceVertices.begin(), shape.faceVertices.begin() + 2 * n);
        std::iota(shape.faceVertices.begin(), shape.faceVertices.begin() + n, 1);
        auto const refiner = CreateRefiner(shape, ReferenceMask::Average, 0,
                                           getOptions(Sdc::Options::VTX_BOUNDARY_EDGE_ONLY));
        auto const factory = BfrExt::SurfaceFactory::Create(*refiner);
        for (int const face : {0, 1, n, n + 1, 2 * n}) { // of the second ring from n + 1 on
            SCOPED_TRACE(face);
            FarExt::CallStatus status;
            EXPECT_EQ(factory->FaceHasLimitSurface(face, &status), n == kMost);
            if (n > kMost) {
                EXPECT_EQ(status.GetCode(), StatusCode::Unsupported);
                EXPECT_EQ(status.GetComponentType(), FarExt::ComponentType::Face);
                EXPECT_EQ(status.GetComponentIndex(), 0);
                EXPECT_NE(status.GetErrorMessage().find(": face 0 has 1025 vertices, "),
                          std::string::npos);
            }
        }
    }
}

TEST(SurfaceFactoryTest, MakesSurfacesAsBfrDoes) {
    Shape const &shape = GetFeatureShape("seamsCross");
    auto const refiner = CreateRefiner(shape, ReferenceMask::Smooth, 0,
                                       getOptions(Sdc::Options::VTX_BOUNDARY_EDGE_ONLY));
    auto const factory = BfrExt::SurfaceFactory::Create(
        *refiner, BfrExt::SurfaceFactory::Options().SetDefaultFVarID(1));
    using Surface = BfrExt::Surface<float>;
    int const numChannels = factory->GetNumFVarChannels();
    ASSERT_GT(numChannels, 1);
    auto const getPoints = [](Surface const &surface) {
        std::vector<int> points(std::size_t(surface.GetNumControlPoints()));
        surface.GetControlPointIndices(points.data());
        return points;
    };
    for (int face = 0; face < factory->GetNumFaces(); ++face) {
        std::vector<std::vector<int>> expected; // vertex, varying, and by channel
        Surface one;
        ASSERT_TRUE(factory->InitVertexSurface(face, &one));
        expected.push_back(getPoints(one));
        ASSERT_TRUE(factory->InitVaryingSurface(face, &one));
        expected.push_back(getPoints(one));
        for (int channel = 0; channel < numChannels; ++channel) {
            ASSERT_TRUE(factory->InitFaceVaryingSurface(face, &one, channel));
            expected.push_back(getPoints(one));
        }
        EXPECT_EQ(getPoints(*factory->CreateVertexSurface<float>(face)), expected[0]);
        EXPECT_EQ(getPoints(*factory->CreateVaryingSurface<float>(face)), expected[1]);
        EXPECT_EQ(getPoints(*factory->CreateFaceVaryingSurface<float>(face)), expected[3]);
        EXPECT_EQ(getPoints(*factory->CreateFaceVaryingSurface<float>(face, 0)), expected[2]);

        Surface vertex;
        Surface varying;
        std::vector<Surface> ofChannels(2);
        int const ids[] = {1, 0};
        ASSERT_TRUE(factory->InitSurfaces(face, &vertex, ofChannels.data(), ids, 2, &varying));
        EXPECT_EQ(getPoints(vertex), expected[0]);
        EXPECT_EQ(getPoints(varying), expected[1]);
        EXPECT_EQ(getPoints(ofChannels[0]), expected[3]);
        EXPECT_EQ(getPoints(ofChannels[1]), expected[2]);
        ASSERT_TRUE(factory->InitSurfaces<float>(face, nullptr, ofChannels.data(), nullptr, 2));
        EXPECT_EQ(getPoints(ofChannels[0]), expected[2]);
        EXPECT_EQ(getPoints(ofChannels[1]), expected[3]);
        ASSERT_TRUE(factory->InitSurfaces<float>(face, nullptr, ofChannels.data()));
        EXPECT_EQ(getPoints(ofChannels[0]), expected[3]);

        FarExt::CallStatus status;
        int const badIds[] = {0, numChannels};
        EXPECT_FALSE(
            factory->InitSurfaces(face, &vertex, ofChannels.data(), badIds, 2, &varying, &status));
        EXPECT_EQ(status.GetCode(), StatusCode::InvalidArgument);
        for (Surface const *const surface : {&vertex, &varying, &ofChannels[0], &ofChannels[1]}) {
            EXPECT_FALSE(surface->IsValid());
        }
    }
    FarExt::CallStatus status;
    EXPECT_FALSE(factory->CreateVertexSurface<float>(-1, &status));
    EXPECT_EQ(status.GetCode(), StatusCode::InvalidArgument);
    EXPECT_FALSE(factory->CreateFaceVaryingSurface<float>(0, numChannels, &status));
    EXPECT_EQ(status.GetCode(), StatusCode::InvalidArgument);
}

TEST(SurfaceFactoryTest, WhatDoesNotFitIsNotEvaluated) {
    Shape const &shape = GetShape("cube");
    auto const refiner = CreateRefiner(shape, ReferenceMask::Smooth, 0);
    auto const factory = BfrExt::SurfaceFactory::Create(*refiner);
    BfrExt::Surface<double> surface;
    constexpr double kUntouched = 77;
    constexpr std::size_t kSize = 3 * 64;
    std::vector<double> const control(kSize, 1);
    using BfrExt::LevelTessellation;
    using BfrExt::Parameterization;
    auto const expectNothing = [&](LevelTessellation const &tessellation) {
        std::vector<double> results(3 * kSize, kUntouched);
        double *const p = results.data();
        surface.Evaluate(tessellation, control.data(), 3, p, 3);
        surface.Evaluate(tessellation, control.data(), 3, p, p + kSize, p + 2 * kSize, 3);
        EXPECT_EQ(results, std::vector<double>(3 * kSize, kUntouched));
    };
    double const uv[2] = {0.5, 0.25};
    std::vector<double> results(9, kUntouched);
    double *const p = results.data();
    surface.Evaluate(uv, control.data(), 3, p);
    surface.Evaluate(uv, control.data(), 3, p, p + 3, p + 6);
    EXPECT_EQ(surface.EvaluateStencil(uv, p), 0);
    EXPECT_EQ(surface.EvaluateStencil(uv, p, p + 3, p + 6), 0);
    surface.ApplyStencil(control.data(), control.data(), 3, p);
    surface.ApplyStencilFromMesh(control.data(), control.data(), 3, p + 3);
    EXPECT_EQ(results, std::vector<double>(9, kUntouched));
    expectNothing(LevelTessellation(Parameterization(4), 1));

    ASSERT_TRUE(factory->InitVertexSurface(0, &surface));
    for (int const faceSize : {3, 5}) {
        expectNothing(LevelTessellation(Parameterization(faceSize), 1));
        expectNothing(LevelTessellation(BfrExt::CellTree(faceSize, 1)));
    }
    expectNothing(LevelTessellation(Parameterization(4), 99));
    results.resize(3 * 4);
    surface.Evaluate(LevelTessellation(Parameterization(4), 0), control.data(), 3, results.data(),
                     3);
    EXPECT_NE(results[0], kUntouched);
}

TEST(SurfaceFactoryTest, RefusesOtherSchemes) {
    FarExt::HexSchemeOptions options;
    options.schemeType = FarExt::SchemeType::DooSabin;
    auto const refiner =
        CreateRefiner(GetShape("cube"), ReferenceMask::Cosine, 0, Sdc::Options(), options);
    FarExt::CallStatus status;
    EXPECT_FALSE(BfrExt::SurfaceFactory::Create(*refiner, &status));
    EXPECT_EQ(status.GetCode(), StatusCode::Unsupported);
}

// Behind a first step, surfaces are those of level 1.
TEST(SurfaceFactoryTest, NeedsTheSurfaceLevelAsItWas) {
    for (auto const firstStep : {FarExt::FirstStep::Truncate, FarExt::FirstStep::TriHex}) {
        FarExt::HexSchemeOptions options;
        options.firstStep = firstStep;
        EXPECT_EQ(options.GetSurfaceLevel(), 1);
        auto const refiner =
            CreateRefiner(GetShape("cube"), ReferenceMask::Smooth, 0, Sdc::Options(), options);
        FarExt::CallStatus status;
        EXPECT_FALSE(BfrExt::SurfaceFactory::Create(*refiner, &status));
        EXPECT_EQ(status.GetCode(), StatusCode::InvalidArgument);
        EXPECT_EQ(status.GetComponentType(), FarExt::ComponentType::Level);
        EXPECT_EQ(status.GetComponentIndex(), 1);
        TopologyRefiner::UniformOptions uniformOptions(1);
        ASSERT_TRUE(refiner->RefineUniform(uniformOptions));
        if (!refiner->GetLevel(1).HasFullTopology()) {
            EXPECT_FALSE(BfrExt::SurfaceFactory::Create(*refiner, &status));
            EXPECT_NE(status.GetErrorMessage().find("fullTopologyInLastLevel"), std::string::npos);
        }
        uniformOptions.fullTopologyInLastLevel = true;
        ASSERT_TRUE(refiner->RefineUniform(uniformOptions));
        auto const factory = BfrExt::SurfaceFactory::Create(*refiner, &status);
        ASSERT_TRUE(factory) << status.GetErrorMessage();
        EXPECT_EQ(factory->GetLevel().GetDepth(), 1);
        EXPECT_EQ(factory->GetNumFaces(), 14);
        EXPECT_EQ(factory->GetFaceParameterization(0).GetFaceSize(),
                  firstStep == FarExt::FirstStep::Truncate ? 8 : 4);
        BfrExt::Surface<double> surface;
        for (int i = 0; i < 3; ++i) { // what is found twice is kept
            EXPECT_TRUE(factory->InitVertexSurface(13, &surface, &status));
        }
        EXPECT_FALSE(factory->InitVertexSurface(14, &surface, &status));
        EXPECT_EQ(status.GetErrorMessage(), "face 14 is not one of the 14 faces of level 1");

        ASSERT_TRUE(refiner->RefineUniform(3));
        EXPECT_FALSE(factory->FaceHasLimitSurface(0, &status));
        EXPECT_EQ(status.GetCode(), StatusCode::InvalidArgument);
        EXPECT_FALSE(factory->InitVaryingSurface(0, &surface, &status));
        EXPECT_FALSE(surface.IsValid());
        EXPECT_FALSE(factory->InitVertexSurface(13, &surface, &status));
        EXPECT_NE(status.GetErrorMessage().find("refined again"), std::string::npos);
    }
}

TEST(SurfaceFactoryTest, TypesAreSharedByFacesThatLookAlike) {
    Shape const shape = MakeTiling(Tiling::Quads, 12, 12);
    auto const refiner = CreateRefiner(shape, ReferenceMask::Smooth, 0);
    BfrExt::SurfaceFactoryCache cache;
    BfrExt::SurfaceFactory::Options options;
    options.SetExternalCache(&cache);
    auto const factory = BfrExt::SurfaceFactory::Create(*refiner, options);
    BfrExt::Surface<float> surface;
    for (int row = 3; row < 9; ++row) {
        for (int column = 3; column < 9; ++column) {
            ASSERT_TRUE(factory->InitVertexSurface(12 * row + column, &surface));
        }
    }
    EXPECT_EQ(cache.GetNumTypes(), 1u);
    EXPECT_EQ(surface.GetNumControlPoints(), 32);
}

// Lines that several sheets share have copies of their vertices, with other numbers around each face.
TEST(SurfaceFactoryTest, TypesDoNotDependOnWhichFaceComesFirst) {
    Shape shape;
    shape.name = "three quads on four vertices";
    shape.closed = false;
    shape.positions = {0, 0, 0, 1, 0, 1, 1, 1, 0, 0, 1, 2};
    shape.faceSizes = {4, 4, 4};
    shape.faceVertices = {1, 3, 2, 0, 2, 0, 1, 3, 3, 1, 0, 2};
    FarExt::HexSchemeOptions options;
    options.firstStep = FarExt::FirstStep::Truncate;
    auto const refiner = CreateRefiner(shape, ReferenceMask::Average, 1,
                                       getOptions(Sdc::Options::VTX_BOUNDARY_EDGE_ONLY), options);
    FarExt::TopologyLevel const level = refiner->GetLevel(1);
    // Copies have different values here, so that it shows which one was taken.
    std::vector<double> points(3 * std::size_t(level.GetNumVertices()));
    for (std::size_t i = 0; i < points.size(); ++i) {
        points[i] = std::sin(1.7 * double(i));
    }
    auto const evaluate = [&](int firstFace) {
        std::vector<std::vector<double>> result(std::size_t(level.GetNumFaces()));
        auto const factory = BfrExt::SurfaceFactory::Create(*refiner);
        for (int i = 0; i < level.GetNumFaces(); ++i) {
            int const face = (firstFace + i) % level.GetNumFaces();
            BfrExt::Surface<double> surface;
            EXPECT_TRUE(factory->InitVertexSurface(face, &surface));
            std::vector<double> control(3 * std::size_t(surface.GetNumControlPoints()));
            surface.GatherControlPoints(points.data(), 3, control.data(), 3);
            BfrExt::LevelTessellation const tessellation(surface.GetParameterization(), 1);
            std::vector<double> &ofFace = result[std::size_t(face)];
            ofFace.resize(3 * std::size_t(tessellation.GetNumCoords()));
            surface.Evaluate(tessellation, control.data(), 3, ofFace.data(), 3);
        }
        return result;
    };
    auto const expected = evaluate(0);
    for (int face = 1; face < level.GetNumFaces(); ++face) {
        EXPECT_EQ(evaluate(face), expected) << "with face " << face << " first";
    }
}

TEST(SurfaceFactoryTest, CellsHaveFewTypesWhateverVerticesAreIrregular) {
    Shape const shape = MakeTorus(24, 16, TorusFaces::IrregularTriangles);
    for (ReferenceMask const mask : kMasks) {
        SCOPED_TRACE(ToString(mask));
        auto const refiner = CreateRefiner(shape, mask, 0);
        BfrExt::SurfaceFactoryCache cache;
        SurfaceSet<double> const surfaces(*refiner, shape.positions, &cache);
        std::size_t const numFaceTypes = cache.GetNumTypes();
        EXPECT_GT(numFaceTypes, std::size_t(shape.GetNumFaces()) / 2);
        BfrExt::LevelTessellation const tessellation(surfaces[0].GetParameterization(), 3);
        auto const size = 3 * std::size_t(tessellation.GetNumCoords());
        std::vector<double> p(size), du(size), dv(size);
        for (int face = 0; face < shape.GetNumFaces(); ++face) {
            std::vector<double> control(3 * std::size_t(surfaces[face].GetNumControlPoints()));
            surfaces[face].GatherControlPoints(shape.positions.data(), 3, control.data(), 3);
            surfaces[face].Evaluate(tessellation, control.data(), 3, p.data(), du.data(), dv.data(),
                                    3);
        }
        EXPECT_LT(cache.GetNumTypes() - numFaceTypes, std::size_t(shape.GetNumFaces()));
    }
}

TEST(SurfaceFactoryTest, ThreadsMayShareACacheThatGoesFirst) {
    Shape const &shape = GetFeatureShape("dartsTriangles");
    auto const refiner = CreateRefiner(shape, ReferenceMask::Smooth, 0,
                                       getOptions(Sdc::Options::VTX_BOUNDARY_EDGE_ONLY));
    int const numFaces = refiner->GetLevel(0).GetNumFaces();
    double const uv[2] = {0.3, 0.2};
    auto const evaluateAll = [&](BfrExt::SurfaceFactoryCache *cache) {
        BfrExt::SurfaceFactory::Options options;
        options.SetExternalCache(cache);
        auto factory = BfrExt::SurfaceFactory::Create(*refiner, options);
        std::vector<BfrExt::Surface<double>> surfaces(static_cast<std::size_t>(numFaces));
        for (int face = 0; face < numFaces; ++face) {
            factory->InitVertexSurface(face, &surfaces[std::size_t(face)]);
        }
        factory.reset();
        std::vector<Vector3> points;
        for (BfrExt::Surface<double> const &surface : surfaces) {
            SurfacePoint const point = EvaluateSurface(surface, shape.positions, uv);
            points.insert(points.end(), {point.p, point.du, point.dv});
        }
        return points;
    };
    std::vector<Vector3> const expected = evaluateAll(nullptr);
    for (int round = 0; round < 5; ++round) {
        BfrExt::SurfaceFactoryCache cache;
        std::vector<Vector3> results[4];
        std::vector<std::thread> threads;
        for (std::vector<Vector3> &result : results) {
            threads.emplace_back([&] { result = evaluateAll(&cache); });
        }
        for (std::thread &thread : threads) {
            thread.join();
        }
        for (std::vector<Vector3> const &result : results) {
            ASSERT_EQ(result, expected);
        }
    }
}

// On a flat grid of squares: how far points lie beside their (u, v), by a coordinate, in sides of a square.
TEST(SurfaceTest, PlacesOfSquaresAreBentMostBesideBorders) {
    constexpr int kNumSquares = 6; // to a side
    constexpr int kNumSteps = 16;
    Shape const shape = MakeTiling(Tiling::Quads, kNumSquares, kNumSquares);
    auto const refiner = CreateRefiner(shape, ReferenceMask::Smooth, 0,
                                       getOptions(Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER));
    SurfaceSet<double> const surfaces(*refiner, shape.positions);
    double atBorder = 0;
    double inside = 0;
    for (int face = 0; face < shape.GetNumFaces(); ++face) {
        int const square[2] = {face % kNumSquares, face / kNumSquares};
        bool const isInside = std::all_of(
            square, square + 2, [](int place) { return place > 0 && place < kNumSquares - 1; });
        double &largest = isInside ? inside : atBorder;
        for (int i = 0; i <= kNumSteps; ++i) {
            for (int k = 0; k <= kNumSteps; ++k) {
                double const uv[2] = {double(i) / kNumSteps, double(k) / kNumSteps};
                Vector3 const point = surfaces.EvaluatePosition(face, uv);
                for (std::size_t j = 0; j < 2; ++j) {
                    largest = std::max(largest, std::abs(point[j] - square[j] - uv[j]));
                }
                ASSERT_NEAR(point[2], 0, 1e-12);
            }
        }
    }
    EXPECT_NEAR(atBorder, 0.132, 0.002);
    EXPECT_NEAR(inside, 0.067, 0.002);
}

TEST(SurfaceTest, ControlPointsBoundTheSurface) {
    Shape const &shape = GetShape("cube");
    auto const refiner = CreateRefiner(shape, ReferenceMask::Average, 0);
    std::vector<float> const positions(shape.positions.begin(), shape.positions.end());
    SurfaceSet<float> const surfaces(*refiner, positions);
    SurfaceSet<double> const exact(*refiner, shape.positions);
    for (int face = 0; face < shape.GetNumFaces(); ++face) {
        BfrExt::Surface<float> const &surface = surfaces[face];
        std::vector<int> indices(std::size_t(surface.GetNumControlPoints()));
        ASSERT_EQ(surface.GetControlPointIndices(indices.data()), int(indices.size()));
        for (int i = 0; i < surface.GetFaceSize(); ++i) {
            EXPECT_EQ(indices[std::size_t(i)], refiner->GetLevel(0).GetFaceVertices(face)[i]);
        }
        std::vector<float> controlPoints(5 * std::size_t(surface.GetNumPatchPoints()));
        surface.PreparePatchPoints(positions.data(), 3, controlPoints.data(), {3, 5});
        float least[2][3];
        float most[2][3];
        surface.BoundControlPoints(controlPoints.data(), {3, 5}, least[0], most[0]);
        surface.BoundControlPointsFromMesh(positions.data(), 3, least[1], most[1]);
        for (std::array<double, 2> const &place : getRandomPlaces(4, 20)) {
            float const uv[2] = {float(place[0]), float(place[1])};
            float p[3];
            surface.Evaluate(uv, controlPoints.data(), {3, 5}, p);
            std::vector<float> weights(indices.size());
            surface.EvaluateStencil(uv, weights.data());
            float ofStencil[2][3];
            surface.ApplyStencil(weights.data(), controlPoints.data(), {3, 5}, ofStencil[0]);
            surface.ApplyStencilFromMesh(weights.data(), positions.data(), 3, ofStencil[1]);
            double const exactUv[2] = {double(uv[0]), double(uv[1])};
            Vector3 const expected = exact.Evaluate(face, exactUv).p;
            for (std::size_t k = 0; k < 3; ++k) {
                EXPECT_EQ(least[0][k], least[1][k]);
                EXPECT_EQ(most[0][k], most[1][k]);
                EXPECT_LE(least[0][k], p[k]);
                EXPECT_GE(most[0][k], p[k]);
                EXPECT_NEAR(ofStencil[0][k], expected[k], 2e-6);
                EXPECT_EQ(ofStencil[0][k], ofStencil[1][k]);
            }
        }
    }
}

} // namespace OpenSubdivHex::Regression::surfaceTest
