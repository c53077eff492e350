// SPDX-License-Identifier: Apache-2.0
//
// Faces at a pole, a vertex of many faces, whose edges are all differently sharp: each is of types of its own.
#include "surfaceFixture.h"

#include "bfr_ext/levelTessellation.h"
#include "far_ext/topologyRefinerFactory.h"
#include "regression/shapes/shapeDescriptor.h"
#include "regression/shapes/shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <vector>

namespace OpenSubdivHex::Regression::poleTest {

using BfrExt::LevelTessellation;
using BfrExt::Surface;
using BfrExt::SurfaceFactory;
using BfrExt::SurfaceFactoryCache;

namespace {

std::unique_ptr<FarExt::TopologyRefiner> createRefiner(Shape const &shape) {
    Sdc::Options options;
    options.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER);
    FarExt::HexSchemeOptions schemeOptions;
    schemeOptions.faceMask = FarExt::FaceMask::Smooth;
    return FarExt::TopologyRefinerFactory::Create(*CreateFarRefiner(shape, options),
                                                  {schemeOptions});
}

/// Places of a tessellation of a surface.
template <typename REAL>
struct Places {
    Places(Surface<REAL> const &surface, LevelTessellation const &tessellation,
           std::vector<REAL> const &positions) {
        std::vector<REAL> controlPoints(3 * std::size_t(surface.GetNumControlPoints()));
        surface.GatherControlPoints(positions.data(), 3, controlPoints.data(), 3);
        for (std::vector<REAL> *const result : {&points, &du, &dv}) {
            result->resize(3 * std::size_t(tessellation.GetNumCoords()));
        }
        surface.Evaluate(tessellation, controlPoints.data(), 3, points.data(), du.data(), dv.data(),
                         3);
    }

    SurfacePoint Get(std::size_t place) const {
        auto const get = [&](std::vector<REAL> const &numbers) {
            REAL const *const p = &numbers[3 * place];
            return Vector3{double(p[0]), double(p[1]), double(p[2])};
        };
        return {get(points), get(du), get(dv)};
    }

    std::vector<REAL> points;
    std::vector<REAL> du;
    std::vector<REAL> dv;
};

/// Whether the places are those of stencils, which take no matrix; derivatives to a tolerance of their own.
template <typename REAL>
void expectStencils(double tolerance, double toleranceOfDerivatives) {
    constexpr int kNumFaces = 40;
    Shape const shape = MakePoleOfSpokes(kNumFaces);
    auto const refiner = createRefiner(shape);
    std::vector<REAL> const positions(shape.positions.begin(), shape.positions.end());
    SurfaceSet<REAL> const surfaces(*refiner, positions);
    SurfaceSet<double> const exact(*refiner, shape.positions);
    // One at the pole, and the quad beyond it.
    for (int const face : {kNumFaces / 2, kNumFaces + kNumFaces / 2}) {
        for (int const level : {4, 5}) {
            LevelTessellation const tessellation(surfaces[face].GetParameterization(), level);
            auto const numPlaces = std::size_t(tessellation.GetNumCoords());
            std::vector<double> coords(2 * numPlaces);
            tessellation.GetCoords(coords.data());
            Places<REAL> const places(surfaces[face], tessellation, positions);
            for (std::size_t place = 0; place < numPlaces; place += 5) {
                SCOPED_TRACE(testing::Message()
                             << "face " << face << ", level " << level << ", place " << place);
                SurfacePoint const found = places.Get(place);
                SurfacePoint const expected = exact.Evaluate(face, &coords[2 * place]);
                ASSERT_LE(GetDistance(found.p, expected.p), tolerance);
                double const length = std::max(GetLength(expected.du), GetLength(expected.dv));
                ASSERT_LE(GetDistance(found.du, expected.du), toleranceOfDerivatives * length);
                ASSERT_LE(GetDistance(found.dv, expected.dv), toleranceOfDerivatives * length);
            }
        }
    }
}

/// The memory of the cache for the points of a level in all faces at such a pole.
std::size_t measureMemory(int numFaces, int level) {
    Shape const shape = MakePoleOfSpokes(numFaces);
    auto const refiner = createRefiner(shape);
    std::vector<float> const positions(shape.positions.begin(), shape.positions.end());
    SurfaceFactoryCache cache;
    auto const factory =
        SurfaceFactory::Create(*refiner, SurfaceFactory::Options().SetExternalCache(&cache));
    LevelTessellation const tessellation(BfrExt::Parameterization(3), level);
    std::vector<float> results(3 * std::size_t(tessellation.GetNumCoords()));
    std::vector<float> points;
    Surface<float> surface;
    for (int face = 0; face < numFaces; ++face) {
        EXPECT_TRUE(factory->InitVertexSurface(face, &surface));
        points.resize(3 * std::size_t(surface.GetNumControlPoints()));
        surface.GatherControlPoints(positions.data(), 3, points.data(), 3);
        surface.Evaluate(tessellation, points.data(), 3, results.data(), 3);
    }
    return cache.GetMemory();
}

} // namespace

TEST(Pole, PlacesAreThoseOfStencils) {
    expectStencils<double>(1e-13, 1e-11);
    expectStencils<float>(1.5e-6, 1.5e-5);
}

// Each face has types with all faces at the pole: what a type takes grows with these, but no matrix of places does.
TEST(Pole, TypesTakeLittleOfEachFaceAtThePole) {
    constexpr int kNumFaces = 40;
    constexpr int kMaxBytes = 18 * 1024;
    EXPECT_LE(measureMemory(kNumFaces, 5), std::size_t(kMaxBytes * kNumFaces * kNumFaces));
}

} // namespace OpenSubdivHex::Regression::poleTest
