// SPDX-License-Identifier: Apache-2.0
//
// Memory at a pole of many faces is in proportion to their number.
#include "failingAllocations.h"

#include "bfr_ext/cellTree.h"
#include "bfr_ext/levelTessellation.h"
#include "bfr_ext/surfaceFactory.h"
#include "far_ext/stencilTableFactory.h"
#include "far_ext/topologyRefinerFactory.h"
#include "regression/shapes/shapeDescriptor.h"
#include "regression/shapes/shapes.h"

#include <gtest/gtest.h>

#include <thread>
#include <vector>

namespace OpenSubdivHex::Regression::poleMemoryTest {

using BfrExt::LevelTessellation;
using BfrExt::Polyline;
using BfrExt::SurfaceFactory;
using FarExt::TopologyRefiner;

namespace {

std::unique_ptr<TopologyRefiner> createRefiner(Shape const &shape) {
    Sdc::Options options;
    options.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_EDGE_ONLY);
    auto const base = CreateFarRefiner(shape, options);
    return FarExt::TopologyRefinerFactory::Create(*base, {FarExt::HexSchemeOptions()});
}

/// Evaluates a tessellation of some surfaces of a factory, one after the other.
void evaluateFaces(SurfaceFactory const &factory, Shape const &shape, int numFaces,
                   LevelTessellation const &tessellation) {
    std::vector<double> points;
    std::vector<double> results(3 * std::size_t(tessellation.GetNumCoords()));
    BfrExt::Surface<double> surface;
    for (int face = 0; face < numFaces; ++face) {
        ASSERT_TRUE(factory.InitVertexSurface(face, &surface));
        points.resize(3 * std::size_t(surface.GetNumControlPoints()));
        surface.GatherControlPoints(shape.positions.data(), 3, points.data(), 3);
        surface.Evaluate(tessellation, points.data(), 3, results.data(), 3);
    }
}

/// The most that surfaces of all faces at a pole of quads which name it twice take, at a time.
long measureSurfaces(int n) {
    Shape const shape = MakePole(n, 2);
    auto const refiner = createRefiner(shape);
    LevelTessellation const tessellation(BfrExt::Parameterization(4), 2);
    ResetPeakBytes();
    long const before = CountLiveBytes();
    evaluateFaces(*SurfaceFactory::Create(*refiner), shape, n, tessellation);
    return GetPeakBytes() - before;
}

/// The most that the derivatives at a pole take, at a time, all of whose \p n edges but one are creases.
long measureCreases(int n) {
    Shape shape = MakePole(n, 1);
    for (int i = 1; i < n; ++i) {
        shape.creaseVertexPairs.insert(shape.creaseVertexPairs.end(), {0, 1 + i});
        shape.creaseSharpness.push_back(Sdc::Crease::SHARPNESS_INFINITE);
    }
    auto const refiner = createRefiner(shape);
    ResetPeakBytes();
    long const before = CountLiveBytes();
    auto const factory = SurfaceFactory::Create(*refiner);
    BfrExt::Surface<double> surface;
    std::vector<double> weights[3];
    double const uv[2] = {0, 0}; // the pole
    for (int face = 0; face < n; ++face) {
        EXPECT_TRUE(factory->InitVertexSurface(face, &surface));
        for (std::vector<double> &row : weights) {
            row.resize(std::size_t(surface.GetNumControlPoints()));
        }
        surface.EvaluateStencil(uv, weights[0].data(), weights[1].data(), weights[2].data());
    }
    return GetPeakBytes() - before;
}

/// The most that making the limit table of level 0 of such a pole takes, at a time.
long measureTable(int n) {
    auto const refiner = createRefiner(MakePole(n, 2));
    ResetPeakBytes();
    long const before = CountLiveBytes();
    EXPECT_TRUE(FarExt::LimitStencilTableFactory::Create(
        *refiner, FarExt::LimitStencilTableFactory::Options()));
    return GetPeakBytes() - before;
}

} // namespace

TEST(PoleMemoryTest, OfSurfacesGrowsWithTheFaces) {
    measureSurfaces(8); // what threads keep
    long const few = measureSurfaces(16);
    EXPECT_LE(measureSurfaces(64), 2 * few);
    EXPECT_LE(measureSurfaces(256), 4 * few);
}

// All faces share the limit at the pole, which has a tangent plane for each: its weights alone grow with the square.
TEST(PoleMemoryTest, OfCreasesGrowsWithTheSquareOfTheFaces) {
    measureCreases(8); // what threads keep
    long const few = measureCreases(48);
    EXPECT_LE(measureCreases(96), 4 * few);
}

TEST(PoleMemoryTest, OfTablesGrowsWithTheFaces) {
    measureTable(8);
    long const few = measureTable(16);
    EXPECT_LE(measureTable(64), 5 * few);
    EXPECT_LE(measureTable(256), 17 * few);
}

TEST(PoleMemoryTest, ThreadsKeepNothingOfTables) {
    std::thread([] {
        measureTable(8);
        long const before = CountLiveBytes();
        auto const make = [] {
            auto const refiner = createRefiner(MakePole(200, 1));
            EXPECT_TRUE(FarExt::LimitStencilTableFactory::Create(
                *refiner, FarExt::LimitStencilTableFactory::Options()));
        };
        make();
        EXPECT_LE(CountLiveBytes() - before, 256);
    }).join();
}

// All places of a polyline of the last level; those of level 8 are a sixteenth of them.
TEST(PoleMemoryTest, OfPolylinesIsThatOfTheirFirstLevels) {
    Shape const shape = MakePrism(5);
    auto const refiner = createRefiner(shape);
    auto const factory = SurfaceFactory::Create(*refiner);
    BfrExt::CellTree const tree(5);
    auto const keep = [&](int level) {
        // Deep at the start alone: what has a level is kept as a whole.
        std::vector<Polyline::Place> places;
        Polyline const whole(level);
        for (Polyline::Place const place : whole.GetPlaces()) {
            if (place <= Polyline::kLength / 4 || place == 3 * Polyline::kLength / 4) {
                places.push_back(place);
            }
        }
        Polyline polyline;
        ASSERT_TRUE(Polyline::FromPlaces(places, &polyline));
        std::vector<Polyline> const edges(5, polyline);
        LevelTessellation const tessellation(tree, edges.data());
        ASSERT_TRUE(tessellation.IsValid());
        evaluateFaces(*factory, shape, 1, tessellation);
    };
    keep(3);
    long const before = CountLiveBytes();
    keep(8);
    long const ofLevel8 = CountLiveBytes() - before;
    EXPECT_GT(ofLevel8, 0);
    EXPECT_LE(ofLevel8, 5L * Polyline(8).GetNumPoints() * 1024);
    keep(Polyline::kLastLevel);
    long const ofLast = CountLiveBytes() - before - ofLevel8;
    EXPECT_LE(ofLast, ofLevel8);
}

} // namespace OpenSubdivHex::Regression::poleMemoryTest
