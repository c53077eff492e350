// SPDX-License-Identifier: Apache-2.0
//
// SurfaceFactoryCache counts what its types take.
#include "failingAllocations.h"

#include "bfr_ext/surfaceFactory.h"
#include "far_ext/topologyRefinerFactory.h"
#include "regression/shapes/featureShapes.h"
#include "regression/shapes/shapeDescriptor.h"

#include <gtest/gtest.h>

namespace OpenSubdivHex::Regression::cacheMemoryTest {

using BfrExt::Surface;
using BfrExt::SurfaceFactory;
using BfrExt::SurfaceFactoryCache;

TEST(CacheMemoryTest, IsWhatItCounts) {
    for (char const *const name : {"mixedSharpnessQuads", "dartsTriangles"}) {
        SCOPED_TRACE(name);
        Shape const &shape = GetFeatureShape(name);
        Sdc::Options options;
        options.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_EDGE_ONLY);
        auto const base = CreateFarRefiner(shape, options);
        FarExt::HexSchemeOptions scheme;
        scheme.faceMask = FarExt::FaceMask::Smooth;
        auto const refiner = FarExt::TopologyRefinerFactory::Create(*base, {scheme});
        std::vector<float> const positions(shape.positions.begin(), shape.positions.end());
        auto const evaluate = [&](SurfaceFactory const &factory) {
            std::vector<float> control;
            std::vector<float> points;
            Surface<float> surface;
            for (int face = 0; face < factory.GetNumFaces(); ++face) {
                ASSERT_TRUE(factory.InitVertexSurface(face, &surface));
                control.resize(3 * std::size_t(surface.GetNumPatchPoints()));
                surface.PreparePatchPoints(positions.data(), 3, control.data(), 3);
                BfrExt::LevelTessellation const tessellation(surface.GetParameterization(), 4);
                std::size_t const size = 3 * std::size_t(tessellation.GetNumCoords());
                points.resize(3 * size);
                surface.Evaluate(tessellation, control.data(), 3, points.data(), &points[size],
                                 &points[2 * size], 3);
            }
        };
        // Threads keep the memory of evaluators, and factories ways around faces.
        evaluate(*SurfaceFactory::Create(*refiner));
        SurfaceFactoryCache cache;
        {
            auto const factory = SurfaceFactory::Create(
                *refiner, SurfaceFactory::Options().SetExternalCache(&cache));
            long const before = CountLiveBytes();
            evaluate(*factory);
            auto const taken = double(CountLiveBytes() - before);
            EXPECT_NEAR(double(cache.GetMemory()), taken,
                        0.15 * taken); // limit masks are not counted
        }
    }
}

} // namespace OpenSubdivHex::Regression::cacheMemoryTest
