// SPDX-License-Identifier: Apache-2.0
//
// Tessellations of Bfr, with rates: of faces alone, and of neighbours, which share points to the bit.
#include "facePlaces.h"

#include "bfr_ext/cell/bfrPlace.h"
#include "surfaceFixture.h"

#include "regression/far_ext/referenceMatch.h"
#include "regression/shapes/featureShapes.h"
#include "regression/shapes/meshOperations.h"
#include "regression/shapes/torus.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <random>
#include <thread>
#include <utility>

namespace OpenSubdivHex::Regression::ratesTest {

namespace Bfr = OpenSubdiv::Bfr;

using BfrExt::LevelTessellation;
using BfrExt::Parameterization;
using BfrExt::Surface;

namespace {

Sdc::Options getSmoothBorders() {
    Sdc::Options options;
    options.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_EDGE_ONLY);
    return options;
}

template <typename REAL>
std::vector<REAL> getCoords(Bfr::Tessellation const &tessellation) {
    EXPECT_EQ(tessellation.GetCoordStride(), 2);
    std::vector<REAL> coords(2 * std::size_t(tessellation.GetNumCoords()));
    EXPECT_EQ(tessellation.GetCoords(coords.data()), tessellation.GetNumCoords());
    return coords;
}

template <typename REAL>
std::vector<REAL> gather(Surface<REAL> const &surface, std::vector<REAL> const &positions) {
    std::vector<REAL> control(3 * std::size_t(surface.GetNumControlPoints()));
    surface.GatherControlPoints(positions.data(), 3, control.data(), 3);
    return control;
}

template <typename REAL>
std::vector<REAL> evaluate(Surface<REAL> const &surface, std::vector<REAL> const &control,
                           Bfr::Tessellation const &tessellation) {
    std::vector<REAL> points(3 * std::size_t(tessellation.GetNumCoords()));
    surface.Evaluate(tessellation, control.data(), 3, points.data(), 3);
    return points;
}

// The facets of all faces, joined where their points have the same bits, are manifold, and open at the borders of
// the mesh alone.
//
// \param getRate  of edge number i of the mesh
template <typename REAL, typename RATE>
void expectWelded(FarExt::TopologyRefiner const &refiner, std::vector<REAL> const &positions,
                  SurfaceSet<REAL> const &surfaces, RATE const &getRate, int facetSize) {
    using Point = std::array<REAL, 3>;
    FarExt::TopologyLevel const &base = refiner.GetLevel(0);
    std::map<Point, int> numbers;
    std::map<std::pair<int, int>, int> sides;
    int numFacets = 0;
    int eulerCharacteristic = base.GetNumFaces() - base.GetNumEdges();
    for (int vert = 0; vert < base.GetNumVertices(); ++vert) {
        eulerCharacteristic += base.GetVertexFaces(vert).size() > 0 ? 1 : 0;
    }
    int numOpenSegments = 0;
    for (int edge = 0; edge < base.GetNumEdges(); ++edge) {
        numOpenSegments += base.IsEdgeBoundary(edge) ? getRate(edge) : 0;
    }
    for (int face = 0; face < base.GetNumFaces(); ++face) {
        std::vector<int> rates;
        for (int const edge : base.GetFaceEdges(face)) {
            rates.push_back(getRate(edge));
        }
        Surface<REAL> const &surface = surfaces[face];
        Bfr::Tessellation const tessellation(
            surface.GetParameterization(), int(rates.size()), rates.data(),
            Bfr::Tessellation::Options().SetFacetSize(facetSize).PreserveQuads(facetSize == 4));
        ASSERT_TRUE(tessellation.IsValid());
        std::vector<REAL> const points =
            evaluate(surface, gather(surface, positions), tessellation);
        std::vector<int> indices(std::size_t(facetSize * tessellation.GetNumFacets()));
        ASSERT_EQ(tessellation.GetFacets(indices.data()), tessellation.GetNumFacets());
        for (std::size_t first = 0; first < indices.size(); first += std::size_t(facetSize)) {
            std::vector<int> facet;
            for (std::size_t i = first; i < first + std::size_t(facetSize); ++i) {
                if (indices[i] >= 0) {
                    REAL const *const p = &points[3 * std::size_t(indices[i])];
                    facet.push_back(numbers.emplace(Point{p[0], p[1], p[2]}, int(numbers.size()))
                                        .first->second);
                }
            }
            for (std::size_t i = 0; i < facet.size(); ++i) {
                ++sides[{facet[i], facet[(i + 1) % facet.size()]}];
            }
            ++numFacets;
        }
    }
    int numOpen = 0;
    for (auto const &[side, count] : sides) {
        ASSERT_EQ(count, 1);
        numOpen += sides.count({side.second, side.first}) == 0 ? 1 : 0;
    }
    EXPECT_EQ(numOpen, numOpenSegments);
    int const numEdges = (int(sides.size()) + numOpen) / 2;
    EXPECT_EQ(int(numbers.size()) - numEdges + numFacets, eulerCharacteristic);
}

template <typename REAL>
void expectWelded(Shape const &shape, ReferenceMask mask, Sdc::Options const &options,
                  int facetSize) {
    SCOPED_TRACE(shape.name);
    auto const refiner = CreateRefiner(shape, mask, 0, options);
    std::vector<REAL> const positions(shape.positions.begin(), shape.positions.end());
    SurfaceSet<REAL> const surfaces(*refiner, positions);
    constexpr int kMaxRate = 17;
    std::mt19937 random(5);
    std::vector<int> rates;
    for (int edge = 0; edge < refiner->GetLevel(0).GetNumEdges(); ++edge) {
        rates.push_back(1 + int(random() % kMaxRate));
    }
    ASSERT_NO_FATAL_FAILURE(expectWelded(
        *refiner, positions, surfaces, [&](int edge) { return rates[std::size_t(edge)]; },
        facetSize));
}

} // namespace

TEST(Parameterization, IsThatOfBfr) {
    EXPECT_EQ(Parameterization(3).GetType(), Bfr::Parameterization::TRI);
    EXPECT_EQ(Parameterization(4).GetType(), Bfr::Parameterization::QUAD);
    EXPECT_EQ(Parameterization(7).GetType(), Bfr::Parameterization::QUAD_SUBFACES);
    EXPECT_FALSE(Parameterization().IsValid());
    EXPECT_FALSE(Parameterization(2).IsValid());
    for (int size = 3; size <= 12; ++size) {
        SCOPED_TRACE(size);
        Parameterization const parameterization(size);
        FacePlace uv;
        parameterization.GetCenterCoord(uv.data());
        FacePlace const center = MakeFacePlace(size, 0, 0, 0);
        EXPECT_NEAR(uv[0], center[0], 1e-7); // Bfr has a third in single precision
        EXPECT_NEAR(uv[1], center[1], 1e-7);
        for (int edge = 0; edge < size; ++edge) {
            for (double const t : {0.0, 0.25, 0.375, 0.5, 0.75}) {
                parameterization.GetEdgeCoord(edge, t, uv.data());
                EXPECT_EQ(MakeFacePlace(size, edge, 1 - t, t), uv) << edge << " " << t;
            }
        }
    }
}

// A point between two sub-faces is in one of them from both sectors, and the plane is divided as the face is.
TEST(Parameterization, LeadsToThePlaneAndBack) {
    std::mt19937 random(11);
    std::uniform_real_distribution<double> share(0, 1);
    for (int size = 3; size <= 12; ++size) {
        for (int i = 0; i < 100; ++i) {
            int const sector = i % size;
            double const sum = i % 7 == 0 ? 1 : share(random);
            double const toEnd = sum * (i % 5 == 0 ? 0.5 : share(random));
            FacePlace const uv = MakeFacePlace(size, sector, sum - toEnd, toEnd);
            FacePlace const inPlane = ToPlane(size, uv.data());
            FacePlace const corners[2] = {ToPlane(size, MakeFacePlace(size, sector, 1, 0).data()),
                                          ToPlane(size, MakeFacePlace(size, sector, 0, 1).data())};
            FacePlace const center = ToPlane(size, MakeFacePlace(size, 0, 0, 0).data());
            for (std::size_t k = 0; k < 2; ++k) {
                EXPECT_NEAR(inPlane[k],
                            center[k] + (sum - toEnd) * (corners[0][k] - center[k]) +
                                toEnd * (corners[1][k] - center[k]),
                            1e-13)
                    << size;
            }
        }
        EXPECT_EQ(MakeFacePlace(size, 0, 0, 0.25), MakeFacePlace(size, 1, 0.25, 0));
    }
}

// Faces of all sizes, and a triangle with sub-faces, as Catmull-Clark's scheme has it.
TEST(Parameterization, ItsPlaneIsThatOfTessellations) {
    for (int size = 3; size < 12; ++size) {
        Parameterization const parameterization(size);
        LevelTessellation const tessellation(parameterization, 3);
        auto const numCoords = std::size_t(tessellation.GetNumCoords());
        std::vector<double> coords(2 * numCoords);
        std::vector<double> inPlane(2 * numCoords);
        tessellation.GetCoords(coords.data());
        tessellation.GetPlaneCoords(inPlane.data());
        for (std::size_t i = 0; i < coords.size(); i += 2) {
            double found[2];
            parameterization.ConvertToPlane(&coords[i], found);
            EXPECT_NEAR(found[0], inPlane[i], 1e-12) << size;
            EXPECT_NEAR(found[1], inPlane[i + 1], 1e-12) << size;
        }
    }
    for (Parameterization const &parameterization :
         {Parameterization(3), Parameterization(4), Parameterization(5), Parameterization(9),
          Parameterization(Bfr::Parameterization(OpenSubdiv::Sdc::SCHEME_CATMARK, 3))}) {
        int const size = parameterization.GetFaceSize();
        auto const subFaces = std::size_t(parameterization.HasSubFaces() ? size : 1);
        for (std::size_t subFace = 0; subFace < subFaces; ++subFace) {
            double sub[2] = {0.3, 0.6};
            double uv[2] = {0.3, 0.6};
            if (parameterization.HasSubFaces()) {
                parameterization.ConvertNormalizedSubFaceToCoord(int(subFace), sub, uv);
            }
            double coords[2];
            double back[2];
            parameterization.ConvertToPlane(uv, coords);
            parameterization.ConvertFromPlane(coords, back);
            EXPECT_NEAR(back[0], uv[0], 1e-12) << size;
            EXPECT_NEAR(back[1], uv[1], 1e-12) << size;
        }
    }
    // Places outside move to the boundary, towards the centre.
    double const below[2] = {0.5, -3};
    double uv[2];
    double middle[2];
    Parameterization(6).ConvertFromPlane(below, uv);
    Parameterization(6).GetEdgeCoord(0, 0.5, middle);
    EXPECT_NEAR(uv[0], middle[0], 1e-12);
    EXPECT_NEAR(uv[1], middle[1], 1e-12);
}

TEST(Parameterization, HasItsDerivativesInThePlane) {
    constexpr double kStep = 1e-6;
    for (int const size : {3, 4, 5, 6, 11}) {
        for (int const type : {0, 1}) {
            Bfr::Parameterization const parameterization =
                type == 0 ? Parameterization(size)
                          : Bfr::Parameterization(OpenSubdiv::Sdc::SCHEME_CATMARK, size);
            Bfr::Tessellation const tessellation(parameterization, 7);
            std::vector<double> coords = getCoords<double>(tessellation);
            for (std::size_t i = 0; i < coords.size(); i += 2) {
                auto const find = [&](double toU, double toV) {
                    return FarExt::internal::FindInPlane(parameterization,
                                                         {coords[i] + toU, coords[i + 1] + toV});
                };
                auto const at = find(0, 0);
                // Into the sub-face.
                double const toU = coords[i] - std::floor(coords[i]) < 0.25 ? kStep : -kStep;
                double const toV =
                    coords[i + 1] - std::floor(coords[i + 1]) < 0.25 ? kStep : -kStep;
                auto const byU = find(toU, 0);
                auto const byV = find(0, toV);
                for (std::size_t k = 0; k < 2; ++k) {
                    EXPECT_NEAR((byU.coords[k] - at.coords[k]) / toU, at.byU[k], 1e-8);
                    EXPECT_NEAR((byV.coords[k] - at.coords[k]) / toV, at.byV[k], 1e-8);
                    EXPECT_NEAR((byU.byV[k] - at.byV[k]) / toU, at.byUv[k], 1e-8);
                    EXPECT_NEAR((byV.byU[k] - at.byU[k]) / toV, at.byUv[k], 1e-8);
                }
                // No side is turned over.
                EXPECT_GT(at.byU[0] * at.byV[1] - at.byU[1] * at.byV[0], 0.1);
            }
        }
    }
}

TEST(Parameterization, TakesPlacesOutsideToTheFaceAndNoneForNone) {
    constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
    constexpr double kInfinite = std::numeric_limits<double>::infinity();
    for (int const size : {5, 7}) { // before a sub-face they are moved to its side
        Parameterization const parameterization(size);
        auto const find = [&](FacePlace const &uv) {
            auto const point = BfrExt::internal::FindBfrPlace(parameterization, size, uv, 0).point;
            return std::make_pair(point.sector, point.coords);
        };
        for (double const far : {0.01, 5.0, 1e300, kInfinite}) {
            EXPECT_EQ(find({-far, 0.2}), find({0, 0.2})) << size << " " << far;
            EXPECT_EQ(find({0.1, -far}), find({0.1, 0})) << size << " " << far;
        }
    }
    for (int const size : {3, 4, 5, 7}) {
        Parameterization const parameterization(size);
        for (double const far : {5.0, 1e300, kInfinite}) {
            for (FacePlace const &uv : {FacePlace{far, 0.2}, {-far, far}, {0.1, -far}}) {
                auto const place = BfrExt::internal::FindBfrPlace(parameterization, size, uv, 0);
                double const sum = place.point.coords[0] + place.point.coords[1];
                EXPECT_TRUE(size <= 4 ? std::abs(sum - 1) <= 1e-15 : sum <= 1)
                    << size << " " << uv[0];
            }
        }
        for (FacePlace const &uv : {FacePlace{kNan, 0.2}, {0.2, kNan}}) {
            auto const place = BfrExt::internal::FindBfrPlace(parameterization, size, uv, 0);
            EXPECT_TRUE(std::isnan(place.point.coords[0] + place.point.coords[1])) << size;
            FacePlace converted;
            parameterization.ConvertToPlane(uv.data(), converted.data());
            EXPECT_TRUE(std::isnan(converted[0] + converted[1])) << size;
            parameterization.ConvertFromPlane(uv.data(), converted.data());
            EXPECT_TRUE(std::isnan(converted[0] + converted[1])) << size;
        }
    }
}

TEST(Rates, NeighboursShareTheirPointsToTheBit) {
    for (Shape const &shape : GetManifoldShapes()) {
        // The two sides of a dihedron lie in one place.
        if (shape.GetNumFaces() > 40 || shape.name.find("dihedron") == 0) {
            continue;
        }
        ASSERT_NO_FATAL_FAILURE(
            expectWelded<double>(shape, ReferenceMask::Smooth, getSmoothBorders(), 3));
        ASSERT_NO_FATAL_FAILURE(
            expectWelded<float>(shape, ReferenceMask::Average, getSmoothBorders(), 4));
    }
}

TEST(Rates, NeighboursShareTheirPointsAtFeatures) {
    for (char const *const name :
         {"creaseLoopClosed", "creasedBall", "mixedSharpnessQuads", "cornersTriangles"}) {
        ASSERT_NO_FATAL_FAILURE(expectWelded<double>(GetFeatureShape(name), ReferenceMask::Cosine,
                                                     getSmoothBorders(), 4));
    }
}

TEST(Rates, NeighboursShareTheirPointsAtEachRate) {
    constexpr int kMaxRate = 17;
    for (auto const faces : {TorusFaces::Quads, TorusFaces::Triangles}) {
        Shape const shape = MakeTorus(5, 4, faces);
        auto const refiner = CreateRefiner(shape, ReferenceMask::Smooth, 0, Sdc::Options());
        SurfaceSet<double> const surfaces(*refiner, shape.positions);
        for (int rate = 1; rate <= kMaxRate; ++rate) {
            SCOPED_TRACE(testing::Message() << shape.name << ", rate " << rate);
            ASSERT_NO_FATAL_FAILURE(expectWelded(
                *refiner, shape.positions, surfaces, [&](int) { return rate; }, 3));
        }
    }
}

// 1 - i/n is rounded where n is no power of 2; a place does not depend on n, nor on the other rates.
TEST(Rates, PlacesOfEdgesDoNotDependOnRates) {
    constexpr int kMaxFaces = 60;
    auto const expectSame = [](double const *a, double const *b) {
        EXPECT_EQ(ToVector(a), ToVector(b));
    };
    for (Shape const &shape :
         {MakeChamfered("chamfered", MakeTorus(7, 6, TorusFaces::Quads)),
          MakeTorus(9, 7, TorusFaces::IrregularTriangles), MakeTorus(7, 6, TorusFaces::Quads)}) {
        SCOPED_TRACE(shape.name);
        auto const refiner = CreateRefiner(shape, ReferenceMask::Smooth, 0, Sdc::Options());
        SurfaceSet<double> const surfaces(*refiner, shape.positions);
        for (int face = 0; face < std::min(shape.GetNumFaces(), kMaxFaces); ++face) {
            Surface<double> const &surface = surfaces[face];
            std::vector<double> const control = gather(surface, shape.positions);
            Bfr::Parameterization const bfr = surface.GetParameterization();
            auto const evaluateAtRate = [&](int rate) {
                return evaluate(surface, control, {bfr, rate});
            };
            std::vector<double> const thirds = evaluateAtRate(3);
            std::vector<double> const ninths = evaluateAtRate(9);
            std::vector<double> const quarters = evaluateAtRate(4);
            auto const size = std::size_t(surface.GetFaceSize());
            std::vector<int> rates(size + 1, 9);
            rates[size] = 5;
            std::vector<double> const others =
                evaluate(surface, control, {bfr, int(rates.size()), rates.data()});
            BfrExt::LevelTessellation const ofLevel(surface.GetParameterization(), 2);
            std::vector<double> ofLevelPoints(3 * std::size_t(ofLevel.GetNumCoords()));
            surface.Evaluate(ofLevel, control.data(), 3, ofLevelPoints.data(), 3);
            for (std::size_t edge = 0; edge < size; ++edge) {
                expectSame(&thirds[3 * (3 * edge + 1)], &ninths[3 * (9 * edge + 3)]);
                expectSame(&thirds[3 * (3 * edge + 2)], &ninths[3 * (9 * edge + 6)]);
                expectSame(&quarters[3 * (4 * edge)], &ofLevelPoints[3 * (3 * edge)]);
                expectSame(&quarters[3 * (4 * edge + 1)], &ofLevelPoints[3 * (3 * edge + 1)]);
                expectSame(&quarters[3 * (4 * edge + 3)], &ofLevelPoints[3 * (3 * edge + 2)]);
            }
            for (std::size_t place = 0; place < 9 * size; ++place) {
                expectSame(&ninths[3 * place], &others[3 * place]);
            }
        }
    }
}

namespace {

void expectStencils(Surface<double> const &surface, std::vector<double> const &control,
                    Bfr::Tessellation const &tessellation, std::size_t step = 1,
                    double tolerance = 1e-5) {
    auto const numPlaces = std::size_t(tessellation.GetNumCoords());
    constexpr std::size_t kStride = 5;
    std::vector<double> p(kStride * numPlaces), du(kStride * numPlaces), dv(kStride * numPlaces);
    surface.Evaluate(tessellation, control.data(), 3, p.data(), du.data(), dv.data(),
                     {3, int(kStride)});
    std::vector<double> const alone = evaluate(surface, control, tessellation);
    std::vector<double> const coords = getCoords<double>(tessellation);
    auto const numPoints = std::size_t(surface.GetNumControlPoints());
    std::vector<double> stencils[3];
    for (std::vector<double> &stencil : stencils) {
        stencil.resize(numPoints);
    }
    for (std::size_t i = 0; i < numPlaces; i += step) {
        SCOPED_TRACE(testing::Message() << "place " << coords[2 * i] << " " << coords[2 * i + 1]);
        // In a triangle with sub-faces, (u, v) are its own where these lie in its plane.
        bool const isOther =
            surface.GetFaceSize() == 3 && tessellation.GetParameterization().HasSubFaces();
        FacePlace const given = {coords[2 * i], coords[2 * i + 1]};
        auto const [uv, byU, byV, byUv] =
            isOther ? FarExt::internal::FindInPlane(tessellation.GetParameterization(), given)
                    : FarExt::internal::PlanePlace{given, {1, 0}, {0, 1}, {0, 0}};
        double const d[4] = {byU[0], byU[1], byV[0], byV[1]};
        surface.EvaluateStencil(uv.data(), stencils[0].data(), stencils[1].data(),
                                stencils[2].data());
        double expected[3][3];
        for (std::size_t k = 0; k < 3; ++k) {
            surface.ApplyStencil(stencils[k].data(), control.data(), 3, expected[k]);
        }
        for (std::size_t k = 0; k < 3; ++k) {
            ASSERT_EQ(p[kStride * i + k], alone[3 * i + k]);
            ASSERT_NEAR(p[kStride * i + k], expected[0][k], 1e-3 * tolerance);
            ASSERT_NEAR(du[kStride * i + k], d[0] * expected[1][k] + d[1] * expected[2][k],
                        tolerance);
            ASSERT_NEAR(dv[kStride * i + k], d[2] * expected[1][k] + d[3] * expected[2][k],
                        tolerance);
        }
    }
}

} // namespace

TEST(Rates, PointsAndDerivativesAreThoseOfStencils) {
    constexpr int kMaxFaces = 12;
    Shape const irregular = MakeTorus(9, 7, TorusFaces::IrregularTriangles);
    Shape const chamfered = MakeChamfered("chamfered", MakeTorus(7, 6, TorusFaces::Quads));
    std::mt19937 random(7);
    for (auto const &[shape, mask] :
         {std::make_pair(GetFeatureShape("mixedSharpnessQuads"), ReferenceMask::Smooth),
          std::make_pair(GetFeatureShape("bowTieOfFans"), ReferenceMask::Smooth),
          std::make_pair(irregular, ReferenceMask::Smooth),
          std::make_pair(chamfered, ReferenceMask::Cosine)}) {
        SCOPED_TRACE(shape.name);
        auto const refiner = CreateRefiner(shape, mask, 0, getSmoothBorders());
        SurfaceSet<double> const surfaces(*refiner, shape.positions);
        for (int face = 0; face < std::min(shape.GetNumFaces(), kMaxFaces); ++face) {
            Surface<double> const &surface = surfaces[face];
            std::vector<int> rates;
            for (int i = 0; i < surface.GetFaceSize(); ++i) {
                rates.push_back(1 + int(random() % 9));
            }
            // With Cosine, derivatives are no smoother than their weights are exact.
            double const tolerance = mask == ReferenceMask::Cosine ? 1e-4 : 1e-5;
            std::vector<double> const control = gather(surface, shape.positions);
            Bfr::Parameterization const bfr = surface.GetParameterization();
            expectStencils(surface, control, {bfr, int(rates.size()), rates.data()}, 1, tolerance);
            expectStencils(surface, control, {bfr, 2 + face % 7}, 1, tolerance);
        }
    }
}

// A type keeps the matrices of each of them.
TEST(Rates, InnerRatesOfAQuadAreToldApart) {
    Shape const shape = MakeTorus(7, 6, TorusFaces::Quads);
    auto const refiner = CreateRefiner(shape, ReferenceMask::Smooth, 0, Sdc::Options());
    SurfaceSet<double> const surfaces(*refiner, shape.positions);
    std::vector<double> const control = gather(surfaces[0], shape.positions);
    Bfr::Parameterization const quad = Parameterization(4);
    for (int u = 1; u <= 7; ++u) {
        for (int v = 1; v <= 7; ++v) {
            SCOPED_TRACE(testing::Message() << u << " by " << v);
            int const rates[] = {2, 3, 1, 4, u, v};
            expectStencils(surfaces[0], control, {quad, 6, rates});
            expectStencils(surfaces[0], control, {quad, 2, rates + 4});
        }
        expectStencils(surfaces[0], control, {quad, u});
    }
}

// Blocks of matrices that are kept, and of more places, that are not.
TEST(Rates, HighRatesAreThoseOfStencils) {
    Shape const shape = MakeTorus(7, 6, TorusFaces::Quads);
    auto const refiner = CreateRefiner(shape, ReferenceMask::Smooth, 0, Sdc::Options());
    SurfaceSet<double> const surfaces(*refiner, shape.positions);
    std::vector<double> const control = gather(surfaces[0], shape.positions);
    // Near vertices, stencils of places are those of bilinear cells, and those of edges are not.
    constexpr double kTolerance = 1e-4;
    int const rates[] = {40, 3, 1200, 5, 40, 30};
    expectStencils(surfaces[0], control, {Parameterization(4), 6, rates}, 41, kTolerance);
    int const higherRates[] = {1, 2, 3, 4, 70, 62};
    expectStencils(surfaces[0], control, {Parameterization(4), 6, higherRates}, 101, kTolerance);
}

// A triangle has the sub-faces of Catmull-Clark, too.
TEST(Rates, TrianglesHaveSubFaces) {
    Shape const shape = MakeTorus(7, 6, TorusFaces::Triangles);
    auto const refiner = CreateRefiner(shape, ReferenceMask::Smooth, 0, Sdc::Options());
    SurfaceSet<double> const surfaces(*refiner, shape.positions);
    std::vector<double> const control = gather(surfaces[0], shape.positions);
    Bfr::Parameterization const subFaces(OpenSubdiv::Sdc::SCHEME_CATMARK, 3);
    for (int const rate : {1, 2, 5, 6}) {
        expectStencils(surfaces[0], control, {subFaces, rate});
        expectStencils(surfaces[0], control, {Parameterization(3), rate});
    }
}

namespace {

// On the lines from the centre of a quad or a triangle to its corners, coordinates have a bend, and at the sides of
// sub-faces.
bool isOnLine(Bfr::Parameterization const &bfr, double const uv[2]) {
    auto const areSame = [](double a, double b) { return std::abs(a - b) < 1e-9; };
    if (bfr.HasSubFaces()) {
        return areSame(uv[0] - std::floor(uv[0]), 0.5) || areSame(uv[1] - std::floor(uv[1]), 0.5);
    }
    double const rest = 1 - uv[0] - (bfr.GetFaceSize() == 3 ? uv[1] : 0);
    return areSame(uv[0], uv[1]) || areSame(uv[1], rest) ||
           (bfr.GetFaceSize() == 3 && areSame(uv[0], rest));
}

} // namespace

TEST(Rates, DerivativesAreDifferences) {
    constexpr double kStep = 1e-5;
    Shape const quads = MakeTorus(7, 6, TorusFaces::Quads);
    for (Shape const &shape :
         {quads, MakeTorus(7, 6, TorusFaces::Triangles), MakeChamfered("chamfered", quads)}) {
        auto const refiner = CreateRefiner(shape, ReferenceMask::Smooth, 0, Sdc::Options());
        SurfaceSet<double> const surfaces(*refiner, shape.positions);
        // Hexagons of a chamfered mesh come behind its faces.
        int const face = shape.GetNumFaces() - 1;
        Surface<double> const &surface = surfaces[face];
        SCOPED_TRACE(testing::Message() << "face of " << surface.GetFaceSize());
        Bfr::Parameterization const bfr = surface.GetParameterization();
        std::vector<double> const control = gather(surface, shape.positions);
        Bfr::Tessellation const tessellation(bfr, 7);
        auto const numPlaces = std::size_t(tessellation.GetNumCoords());
        std::vector<double> p(3 * numPlaces), du(3 * numPlaces), dv(3 * numPlaces);
        surface.Evaluate(tessellation, control.data(), 3, p.data(), du.data(), dv.data(), 3);
        std::vector<double> const coords = getCoords<double>(tessellation);
        int numCompared = 0;
        for (auto i = std::size_t(tessellation.GetNumBoundaryCoords()); i < numPlaces; ++i) {
            if (isOnLine(bfr, &coords[2 * i])) {
                continue;
            }
            for (std::size_t k = 0; k < 2; ++k) {
                Vector3 ends[2];
                for (std::size_t end = 0; end < 2; ++end) {
                    double uv[2] = {coords[2 * i], coords[2 * i + 1]};
                    uv[k] += end == 0 ? -kStep : kStep;
                    ends[end] = surfaces.EvaluatePosition(face, uv);
                }
                Vector3 const difference = Scale(Subtract(ends[1], ends[0]), 0.5 / kStep);
                Vector3 const derivative = ToVector(&(k == 0 ? du : dv)[3 * i]);
                EXPECT_LT(GetDistance(difference, derivative), 2e-3 * GetLength(derivative));
            }
            ++numCompared;
        }
        EXPECT_GT(numCompared, tessellation.GetNumInteriorCoords() / 3);
    }
}

TEST(Rates, WrongArgumentsWriteNothing) {
    Shape const &shape = GetShape("cube");
    auto const refiner = CreateRefiner(shape, ReferenceMask::Smooth, 0);
    SurfaceSet<double> const surfaces(*refiner, shape.positions);
    std::vector<double> const control = gather(surfaces[0], shape.positions);
    int const rates[] = {1, 2, 0, 4};
    double untouched = 77;
    auto const expectNothing = [&](Surface<double> const &surface,
                                   Bfr::Tessellation const &tessellation) {
        surface.Evaluate(tessellation, control.data(), 3, &untouched, 3);
        surface.Evaluate(tessellation, control.data(), 3, &untouched, &untouched, &untouched, 3);
        EXPECT_EQ(untouched, 77);
    };
    Bfr::Parameterization const quad = surfaces[0].GetParameterization();
    expectNothing(surfaces[0], {quad, 4, rates});
    expectNothing(surfaces[0], {quad, 0});
    expectNothing(surfaces[0], {Parameterization(3), 2});
    expectNothing(surfaces[0], {Parameterization(5), 2});
    expectNothing(surfaces[0], {Bfr::Parameterization(), 2});
    expectNothing(Surface<double>(), {quad, 2});
}

TEST(Rates, ThreadsShareACache) {
    constexpr int kNumThreads = 4;
    Shape const shape = MakeTorus(9, 7, TorusFaces::IrregularTriangles);
    auto const refiner = CreateRefiner(shape, ReferenceMask::Smooth, 0, Sdc::Options());
    auto const evaluateAll = [&](SurfaceSet<float> const &surfaces,
                                 std::vector<float> const &positions, int begin) {
        std::vector<std::vector<float>> results(std::size_t(shape.GetNumFaces()));
        for (int i = 0; i < shape.GetNumFaces(); ++i) {
            int const face = (begin + i) % shape.GetNumFaces();
            results[std::size_t(face)] = evaluate(surfaces[face], gather(surfaces[face], positions),
                                                  {Parameterization(3), 2 + face % 5});
        }
        return results;
    };
    std::vector<float> const positions(shape.positions.begin(), shape.positions.end());
    SurfaceSet<float> const own(*refiner, positions);
    auto const expected = evaluateAll(own, positions, 0);
    SurfaceSet<float> const shared(*refiner, positions);
    std::vector<std::vector<std::vector<float>>> results(kNumThreads);
    std::vector<std::thread> threads;
    for (int i = 0; i < kNumThreads; ++i) {
        threads.emplace_back([&, i] {
            results[std::size_t(i)] =
                evaluateAll(shared, positions, i * shape.GetNumFaces() / kNumThreads);
        });
    }
    for (std::thread &thread : threads) {
        thread.join();
    }
    for (auto const &result : results) {
        EXPECT_EQ(result, expected);
    }
}

} // namespace OpenSubdivHex::Regression::ratesTest
