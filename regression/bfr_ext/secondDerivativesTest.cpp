// SPDX-License-Identifier: Apache-2.0
//
// Second derivatives of surfaces; referenceSurfaceTest compares them with those of the reference.
#include "facePlaces.h"
#include "surfaceFixture.h"

#include "bfr_ext/surfaceFactory.h"
#include "regression/far_ext/referenceMatch.h"
#include "regression/reference/largestValue.h"
#include "regression/shapes/featureShapes.h"
#include "regression/shapes/shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace OpenSubdivHex::Regression::secondDerivativesTest {

namespace {

using Place = std::array<double, 2>;

/// Hexagons with sides 1 long, some rows around one that lies as its parameter plane says: edge 0 from
/// (0, 0) to (1, 0).
Shape makeHexagons(int numRings) {
    double const height = std::sqrt(0.75);
    Shape shape;
    shape.name = "hexagons";
    // By the place in halves of 1 and of the height, which are whole numbers.
    std::map<std::pair<int, int>, int> vertices;
    auto const addHexagon = [&](int x, int y) {
        constexpr int kCorners[6][2] = {{0, 0}, {2, 0}, {3, 2}, {2, 4}, {0, 4}, {-1, 2}};
        shape.faceSizes.push_back(6);
        for (auto const &corner : kCorners) {
            std::pair<int, int> const place = {x + corner[0], y + corner[1]};
            auto const [vertex, isNew] = vertices.emplace(place, int(vertices.size()));
            shape.faceVertices.push_back(vertex->second);
            if (isNew) {
                shape.positions.insert(shape.positions.end(),
                                       {0.5 * place.first, 0.5 * height * place.second, 0.0});
            }
        }
    };
    addHexagon(0, 0);
    for (int i = -numRings; i <= numRings; ++i) {
        for (int k = -numRings; k <= numRings; ++k) {
            if ((i != 0 || k != 0) && std::abs(i + k) <= numRings) {
                addHexagon(3 * i, 2 * i + 4 * k);
            }
        }
    }
    return shape;
}

/// Places of a face away from the lines between its sectors.
std::vector<Place> findPlacesInSectors(BfrExt::Parameterization const &parameterization,
                                       int numPlacesInSector) {
    constexpr double kDistance = 0.1;
    int const size = parameterization.GetFaceSize();
    std::mt19937 random(static_cast<unsigned>(size));
    std::uniform_real_distribution<double> uniform(0, 1);
    std::vector<Place> places;
    for (int sector = 0; sector < size; ++sector) {
        for (int i = 0; i < numPlacesInSector; ++i) {
            double weights[3] = {uniform(random), uniform(random), uniform(random)};
            double const sum = weights[0] + weights[1] + weights[2];
            for (double &weight : weights) {
                weight = kDistance + (1 - 3 * kDistance) * weight / sum;
            }
            places.push_back(MakeFacePlace(size, sector, weights[0], weights[1]));
        }
    }
    return places;
}

/// The point and all derivatives: p, du, dv, duu, duv, dvv.
template <typename REAL>
using All = std::array<std::array<REAL, 3>, 6>;

template <typename REAL>
All<REAL> evaluateAll(BfrExt::Surface<REAL> const &surface, std::vector<REAL> const &points,
                      std::array<REAL, 2> const &uv) {
    std::array<std::vector<REAL>, 6> weights;
    weights.fill(std::vector<REAL>(std::size_t(surface.GetNumControlPoints())));
    surface.EvaluateStencil(uv.data(), weights[0].data(), weights[1].data(), weights[2].data(),
                            weights[3].data(), weights[4].data(), weights[5].data());
    All<REAL> all;
    for (std::size_t i = 0; i < all.size(); ++i) {
        surface.ApplyStencil(weights[i].data(), points.data(), 3, all[i].data());
    }
    return all;
}

template <typename REAL>
std::vector<REAL> gather(BfrExt::Surface<REAL> const &surface,
                         std::vector<double> const &positions) {
    std::vector<REAL> points(3 * std::size_t(surface.GetNumControlPoints()));
    std::vector<REAL> const meshPoints(positions.begin(), positions.end());
    surface.GatherControlPoints(meshPoints.data(), 3, points.data(), 3);
    return points;
}

class SurfaceOf {
public:
    SurfaceOf(Shape const &shape, ReferenceMask mask, int face)
        : refiner(CreateRefiner(shape, mask, 0, getOptions())),
          factory(BfrExt::SurfaceFactory::Create(*refiner)) {
        EXPECT_TRUE(factory->InitVertexSurface(face, &surface));
        points = gather(surface, shape.positions);
    }

    static Sdc::Options getOptions() {
        Sdc::Options options;
        options.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_EDGE_ONLY);
        return options;
    }

    std::unique_ptr<FarExt::TopologyRefiner> const refiner;
    std::unique_ptr<BfrExt::SurfaceFactory> const factory;
    BfrExt::Surface<double> surface;
    std::vector<double> points;
};

} // namespace

// By Smooth they are exact, by Cosine as far as first derivatives over a cell of the tenth level are.
TEST(SecondDerivatives, AreThoseOfQuadratics) {
    Shape shape = makeHexagons(4);
    for (std::size_t i = 0; i < shape.positions.size(); i += 3) {
        double const x = shape.positions[i];
        double const y = shape.positions[i + 1];
        double const values[3] = {x * x + y, x * y, y * y - 3 * x};
        std::copy_n(values, 3, shape.positions.begin() + std::ptrdiff_t(i));
    }
    for (auto const &[mask, tolerance] :
         {std::pair(ReferenceMask::Smooth, 1e-8), std::pair(ReferenceMask::Cosine, 5e-3)}) {
        SurfaceOf const of(shape, mask, 0);
        std::vector<Place> places = findPlacesInSectors(of.surface.GetParameterization(), 20);
        // Places of vertices of the base mesh and of the first levels, on edges and inside.
        for (auto const &[edge, toStart, toEnd] :
             {std::tuple(0, 1.0, 0.0), std::tuple(0, 0.0, 1.0), std::tuple(0, 0.5, 0.5),
              std::tuple(0, 0.75, 0.25), std::tuple(4, 0.5, 0.25)}) {
            places.push_back(MakeFacePlace(6, edge, toStart, toEnd));
        }
        for (Place const &uv : places) {
            SCOPED_TRACE(testing::Message() << ToString(mask) << " at " << uv[0] << ", " << uv[1]);
            All<double> const all = evaluateAll(of.surface, of.points, uv);
            // Derivatives of x * x + y, x * y, y * y - 3 * x, where x and y are bilinear in u and v.
            auto const [at, byU, byV, byUv] =
                FarExt::internal::FindInPlane(BfrExt::Parameterization(6), uv);
            double const x = at[0];
            double const y = at[1];
            auto const first = [&](FacePlace const &d) {
                return Vector3{2 * x * d[0] + d[1], x * d[1] + y * d[0], 2 * y * d[1] - 3 * d[0]};
            };
            auto const second = [&](FacePlace const &d, FacePlace const &e) {
                return Vector3{2 * d[0] * e[0], d[0] * e[1] + d[1] * e[0], 2 * d[1] * e[1]};
            };
            Vector3 const mixed = Subtract(second(byU, byV), Scale(first(byUv), -1));
            EXPECT_LE(GetDistance(all[1], first(byU)), 1e-4);
            EXPECT_LE(GetDistance(all[2], first(byV)), 1e-4);
            EXPECT_LE(GetDistance(all[3], second(byU, byU)), 4 * tolerance);
            // First derivatives are less exact than second ones.
            EXPECT_LE(GetDistance(all[4], mixed), 4 * tolerance + 1e-4);
            EXPECT_LE(GetDistance(all[5], second(byV, byV)), 4 * tolerance);
        }
    }
}

TEST(SecondDerivatives, AreTheDifferencesOfFirstOnes) {
    constexpr double kStep = 2e-4;
    for (char const *const name : {"cube", "icosahedron", "torus", "creasedBall", "dartsQuads"}) {
        SCOPED_TRACE(name);
        auto const &features = GetFeatureShapes();
        bool const isFeature = std::any_of(features.begin(), features.end(),
                                           [&](Shape const &shape) { return shape.name == name; });
        Shape const &shape = isFeature ? GetFeatureShape(name) : GetShape(name);
        double sum = 0;
        int numPlaces = 0;
        for (int face = 0; face < std::min(shape.GetNumFaces(), 12); ++face) {
            SurfaceOf const of(shape, ReferenceMask::Smooth, face);
            for (Place const &uv : findPlacesInSectors(of.surface.GetParameterization(), 4)) {
                All<double> const all = evaluateAll(of.surface, of.points, uv);
                double size = 0;
                double distance = 0;
                for (std::size_t k = 0; k < 2; ++k) {
                    Place before = uv;
                    Place next = uv;
                    before[k] -= kStep;
                    next[k] += kStep;
                    All<double> const ends[2] = {evaluateAll(of.surface, of.points, before),
                                                 evaluateAll(of.surface, of.points, next)};
                    for (std::size_t i = 0; i < 2; ++i) {
                        Vector3 const difference =
                            Scale(Subtract(ends[1][1 + i], ends[0][1 + i]), 0.5 / kStep);
                        distance = GetLarger(distance, GetDistance(all[3 + i + k], difference));
                        size = std::max(size, GetLength(difference));
                    }
                }
                ASSERT_LE(distance, 0.14 * size)
                    << "face " << face << " at " << uv[0] << ", " << uv[1];
                sum += distance / size;
                ++numPlaces;
            }
        }
        EXPECT_LE(sum / numPlaces, 0.006);
    }
}

TEST(SecondDerivatives, OfTessellationsAndStencilsAreThoseOfPlaces) {
    for (ReferenceMask const mask : {ReferenceMask::Average, ReferenceMask::Smooth}) {
        SurfaceOf const of(GetShape("icosahedron"), mask, 3);
        BfrExt::Surface<double> const &surface = of.surface;
        BfrExt::LevelTessellation const tessellation(surface.GetParameterization(), 2);
        auto const numPlaces = std::size_t(tessellation.GetNumCoords());
        std::vector<double> coords(2 * numPlaces);
        tessellation.GetCoords(coords.data());
        constexpr std::ptrdiff_t kStride = 4;
        std::vector<std::vector<double>> results(6, std::vector<double>(kStride * numPlaces, -7));
        surface.Evaluate(tessellation, of.points.data(), 3, results[0].data(), results[1].data(),
                         results[2].data(), results[3].data(), results[4].data(), results[5].data(),
                         {3, kStride});
        auto const numPoints = std::size_t(surface.GetNumControlPoints());
        std::vector<std::vector<double>> weights(6, std::vector<double>(numPoints));
        for (std::size_t place = 0; place < numPlaces; ++place) {
            Place const uv = {coords[2 * place], coords[2 * place + 1]};
            All<double> const all = evaluateAll(surface, of.points, uv);
            ASSERT_EQ(surface.EvaluateStencil(uv.data(), weights[0].data(), weights[1].data(),
                                              weights[2].data(), weights[3].data(),
                                              weights[4].data(), weights[5].data()),
                      surface.GetNumControlPoints());
            for (std::size_t kind = 0; kind < all.size(); ++kind) {
                double applied[3];
                surface.ApplyStencil(weights[kind].data(), of.points.data(), 3, applied);
                for (std::size_t k = 0; k < 3; ++k) {
                    double const tolerance = 1e-7 * (1 + std::abs(all[kind][k]));
                    ASSERT_NEAR(results[kind][kStride * place + k], all[kind][k], tolerance)
                        << "place " << place << ", kind " << kind;
                    ASSERT_NEAR(applied[k], all[kind][k], tolerance);
                }
                ASSERT_EQ(results[kind][kStride * place + 3], -7);
            }
        }
    }
}

TEST(SecondDerivatives, InSinglePrecisionAreThoseInDouble) {
    Shape const &shape = GetShape("cube");
    SurfaceOf const of(shape, ReferenceMask::Smooth, 1);
    BfrExt::Surface<float> surface;
    ASSERT_TRUE(of.factory->InitVertexSurface(1, &surface));
    std::vector<float> const points = gather(surface, shape.positions);
    for (Place const &uv : findPlacesInSectors(of.surface.GetParameterization(), 5)) {
        std::array<float, 2> const place = {float(uv[0]), float(uv[1])};
        All<float> const found = evaluateAll(surface, points, place);
        All<double> const expected =
            evaluateAll(of.surface, of.points, Place{double(place[0]), double(place[1])});
        for (std::size_t kind = 0; kind < found.size(); ++kind) {
            // Places that are closer than floats tell are taken for one, where second derivatives differ more.
            double const tolerance = kind == 0 ? 2e-6 : kind <= 2 ? 1e-5 : 5e-3;
            for (std::size_t k = 0; k < 3; ++k) {
                ASSERT_NEAR(double(found[kind][k]), expected[kind][k], tolerance)
                    << "kind " << kind;
            }
        }
    }
}

TEST(SecondDerivatives, OfAnyPlaceAreNumbers) {
    int numFaces = 0;
    for (ReferenceMask const mask :
         {ReferenceMask::Average, ReferenceMask::Cosine, ReferenceMask::Smooth}) {
        for (Shape const &shape : GetFeatureShapes()) {
            SCOPED_TRACE(shape.name);
            auto const refiner = CreateRefiner(shape, mask, 0, SurfaceOf::getOptions());
            auto const factory = BfrExt::SurfaceFactory::Create(*refiner);
            for (int face = 0; face < factory->GetNumFaces(); face += 11) {
                BfrExt::Surface<double> surface;
                if (!factory->FaceHasLimitSurface(face) ||
                    !factory->InitVertexSurface(face, &surface)) {
                    continue;
                }
                ++numFaces;
                std::vector<double> const points = gather(surface, shape.positions);
                Place corner;
                Place center;
                surface.GetParameterization().GetVertexCoord(1, corner.data());
                surface.GetParameterization().GetCenterCoord(center.data());
                for (Place const &uv : {corner, center, Place{0.5, 0}, Place{0.3, 0}}) {
                    for (auto const &values : evaluateAll(surface, points, uv)) {
                        for (double const value : values) {
                            ASSERT_TRUE(std::isfinite(value)) << "face " << face;
                        }
                    }
                }
            }
        }
    }
    EXPECT_GT(numFaces, 100);
}

TEST(SecondDerivatives, OfInvalidSurfacesAreNotWritten) {
    BfrExt::Surface<double> const surface;
    double const uv[2] = {0.25, 0.25};
    double const point[3] = {1, 2, 3};
    double results[6] = {7, 7, 7, 7, 7, 7};
    surface.Evaluate(uv, point, 1, results, results + 1, results + 2, results + 3, results + 4,
                     results + 5);
    EXPECT_EQ(surface.EvaluateStencil(uv, results, results + 1, results + 2, results + 3,
                                      results + 4, results + 5),
              0);
    surface.Evaluate(BfrExt::LevelTessellation(BfrExt::Parameterization(4), 1), point, 1, results,
                     results + 1, results + 2, results + 3, results + 4, results + 5, 1);
    EXPECT_EQ(std::count(results, results + 6, 7.0), 6);
}

} // namespace OpenSubdivHex::Regression::secondDerivativesTest
