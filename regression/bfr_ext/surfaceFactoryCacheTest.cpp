// SPDX-License-Identifier: Apache-2.0
#include "surfaceCase.h"
#include "surfaceFixture.h"

#include "regression/shapes/featureShapes.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <vector>

namespace OpenSubdivHex::Regression::surfaceFactoryCacheTest {

namespace {

using BfrExt::Surface;
using BfrExt::SurfaceFactory;
using BfrExt::SurfaceFactoryCache;

Sdc::Options getEdgeOnly() {
    Sdc::Options options;
    options.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_EDGE_ONLY);
    return options;
}

std::vector<double> evaluate(Surface<double> const &surface, std::vector<double> const &positions) {
    std::vector<double> points(3 * std::size_t(surface.GetNumPatchPoints()));
    surface.PreparePatchPoints(positions.data(), 3, points.data(), 3);
    BfrExt::LevelTessellation const levels(surface.GetParameterization(), 2);
    OpenSubdiv::Bfr::Tessellation const rates(
        OpenSubdiv::Bfr::Parameterization(OpenSubdiv::Sdc::SCHEME_CATMARK, surface.GetFaceSize()),
        3);
    std::vector<double> all(points);
    auto const add = [&](auto const &tessellation) {
        auto const size = 3 * std::size_t(tessellation.GetNumCoords());
        std::size_t const first = all.size();
        all.resize(first + 3 * size);
        surface.Evaluate(tessellation, points.data(), 3, &all[first], &all[first + size],
                         &all[first + 2 * size], 3);
    };
    add(levels);
    add(rates);
    double const uv[2] = {0.3, 0.2};
    std::vector<double> stencil(std::size_t(surface.GetNumControlPoints()));
    surface.EvaluateStencil(uv, stencil.data());
    all.insert(all.end(), stencil.begin(), stencil.end());
    return all;
}

} // namespace

TEST(SurfaceFactoryCache, MemoryIsBoundedAndResultsKeepTheirBits) {
    Shape const &shape = GetFeatureShape("mixedSharpnessQuads");
    auto const refiner = CreateRefiner(shape, ReferenceMask::Smooth, 0, getEdgeOnly());
    int const numFaces = refiner->GetLevel(0).GetNumFaces();
    // Evaluates all faces, and some of them again, by one surface.
    auto const evaluateAll = [&](SurfaceFactoryCache &cache) {
        auto const factory =
            SurfaceFactory::Create(*refiner, SurfaceFactory::Options().SetExternalCache(&cache));
        std::vector<std::vector<double>> all;
        Surface<double> surface;
        for (int i = 0; i < numFaces + numFaces / 4; ++i) {
            EXPECT_TRUE(factory->InitVertexSurface(i % numFaces, &surface));
            all.push_back(evaluate(surface, shape.positions));
            EXPECT_LE(cache.GetMemory(), cache.GetMaxMemory()) << "face " << i;
        }
        return all;
    };
    SurfaceFactoryCache whole;
    std::vector<std::vector<double>> const expected = evaluateAll(whole);
    std::size_t const size = whole.GetMemory();
    EXPECT_GT(size, 100 * whole.GetNumTypes());
    SurfaceFactoryCache part(size / 3);
    EXPECT_EQ(evaluateAll(part), expected);
    EXPECT_GT(part.GetMemory(), 0u);
    EXPECT_LT(part.GetNumTypes(), whole.GetNumTypes());
}

TEST(SurfaceFactoryCache, SurfacesKeepTypesThatItForgets) {
    Shape const &shape = GetFeatureShape("cornersTriangles");
    auto const refiner = CreateRefiner(shape, ReferenceMask::Smooth, 0, getEdgeOnly());
    int const numFaces = refiner->GetLevel(0).GetNumFaces();
    SurfaceFactoryCache whole;
    SurfaceFactoryCache none(0); // forgets all for each surface
    auto const makeAll = [&](SurfaceFactoryCache &cache) {
        auto const factory =
            SurfaceFactory::Create(*refiner, SurfaceFactory::Options().SetExternalCache(&cache));
        std::vector<Surface<double>> all(static_cast<std::size_t>(numFaces));
        for (int face = 0; face < numFaces; ++face) {
            EXPECT_TRUE(factory->InitVertexSurface(face, &all[std::size_t(face)]));
        }
        return all;
    };
    std::vector<Surface<double>> const expected = makeAll(whole);
    std::vector<Surface<double>> surfaces = makeAll(none);
    for (std::size_t face = 0; face < expected.size(); ++face) {
        ASSERT_EQ(evaluate(surfaces[face], shape.positions),
                  evaluate(expected[face], shape.positions));
    }
    std::size_t const size = none.GetMemory();
    // The type of the last surface stays.
    surfaces.clear();
    EXPECT_LT(none.GetMemory(), size / 2);
    EXPECT_LT(none.GetNumTypes(), whole.GetNumTypes());
}

} // namespace OpenSubdivHex::Regression::surfaceFactoryCacheTest
