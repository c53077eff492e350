// SPDX-License-Identifier: Apache-2.0
//
// Threads that share caches, factories, surfaces, tessellations and streams, each of which is new, so that the
// threads make together what is made at the first use.  What each of them gets is the same; built with
// ThreadSanitizer, that no two of them race is tested, too.
#include "bfr_ext/patchStream.h"
#include "bfr_ext/surfaceFactory.h"
#include "bfr_ext/view.h"
#include "far_ext/executor.h"
#include "far_ext/topologyRefinerFactory.h"
#include "regression/shapes/featureShapes.h"
#include "regression/shapes/shapeDescriptor.h"
#include "regression/threads/onThreads.h"

#include <gtest/gtest.h>

#include <map>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

namespace OpenSubdivHex::Regression::surfacesTest {

using BfrExt::CellForest;
using BfrExt::LevelTessellation;
using BfrExt::Surface;
using BfrExt::SurfaceFactory;
using BfrExt::SurfaceFactoryCache;
using FarExt::TopologyRefiner;

namespace {

using Stream = BfrExt::PatchStream<double>;

constexpr int kDim = 3;

std::unique_ptr<TopologyRefiner> createRefiner(Shape const &shape) {
    Sdc::Options options;
    options.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER);
    FarExt::HexSchemeOptions scheme;
    scheme.faceMask = FarExt::FaceMask::Smooth;
    return FarExt::TopologyRefinerFactory::Create(*CreateFarRefiner(shape, options), {scheme});
}

std::unique_ptr<SurfaceFactory> createFactory(TopologyRefiner const &refiner,
                                              SurfaceFactoryCache *cache = nullptr) {
    return SurfaceFactory::Create(refiner, SurfaceFactory::Options().SetExternalCache(cache));
}

/// The points of a surface, with derivatives: at a place, and of a tessellation.
void addPoints(Surface<double> const &surface, LevelTessellation const &tessellation,
               std::vector<double> const &positions, std::vector<double> *all) {
    std::vector<double> control(kDim * std::size_t(surface.GetNumPatchPoints()));
    surface.PreparePatchPoints(positions.data(), kDim, control.data(), kDim);
    double const uv[] = {0.3, 0.2};
    double results[6][kDim];
    surface.Evaluate(uv, control.data(), kDim, results[0], results[1], results[2], results[3],
                     results[4], results[5]);
    for (auto const &result : results) {
        all->insert(all->end(), std::begin(result), std::end(result));
    }
    std::size_t const size = kDim * std::size_t(tessellation.GetNumCoords());
    std::vector<double> points(3 * size);
    surface.Evaluate(tessellation, control.data(), kDim, points.data(), &points[size],
                     &points[2 * size], kDim);
    all->insert(all->end(), points.begin(), points.end());
}

/// Evaluates the surfaces of all faces and kinds of data, each made twice: then it is kept.
std::vector<double> evaluateAll(SurfaceFactory const &factory, Shape const &shape) {
    // For values of a channel, too, whatever they stand for.
    std::vector<double> positions = shape.positions;
    positions.resize(kDim * shape.faceVertices.size(), 1.0);
    std::vector<double> all;
    for (int i = 0; i < 2 * factory.GetNumFaces(); ++i) {
        int const face = i / 2;
        LevelTessellation const tessellation(factory.GetFaceParameterization(face), 2);
        Surface<double> surface;
        EXPECT_TRUE(factory.InitVertexSurface(face, &surface));
        addPoints(surface, tessellation, positions, &all);
        EXPECT_TRUE(factory.InitVaryingSurface(face, &surface));
        addPoints(surface, tessellation, positions, &all);
        if (factory.GetNumFVarChannels() > 0) {
            EXPECT_TRUE(factory.InitFaceVaryingSurface(face, &surface, 0));
            addPoints(surface, tessellation, positions, &all);
        }
    }
    return all;
}

std::vector<char const *> getShapeNames() {
    return {"cubeOfCharts", "dartsQuads", "creaseLoopClosed"};
}

/// The numbers of all patches, by face and place in it, on threads of the default executor.
using Patches = std::map<std::pair<int, int>, std::vector<double>>;

Patches run(Stream const &stream, Shape const &shape) {
    FarExt::ExecutorScope const scope(nullptr, 3);
    std::mutex mutex;
    Patches patches;
    EXPECT_TRUE(stream.Run(shape.positions.data(), kDim, [&](Stream::Patch const &patch) {
        std::size_t const size = kDim * std::size_t(patch.tessellation.GetNumCoords());
        std::vector<double> numbers(patch.points, patch.points + size);
        numbers.insert(numbers.end(), patch.du, patch.du + size);
        std::lock_guard<std::mutex> const lock(mutex);
        return patches.emplace(std::pair(patch.face, patch.tessellation.GetSection()), numbers)
            .second;
    }));
    return patches;
}

CellForest makeForest(SurfaceFactory const &factory, Shape const &shape) {
    FarExt::ExecutorScope const scope(nullptr, 3);
    BfrExt::Camera camera;
    for (int axis = 0; axis < kDim; ++axis) {
        camera.eye[axis] = axis + 2;
    }
    return BfrExt::View(camera).MakeForest<double>(factory, shape.positions.data(), kDim);
}

} // namespace

TEST(SharedSurfaces, OfOneFactory) {
    for (char const *const name : getShapeNames()) {
        SCOPED_TRACE(name);
        Shape const &shape = GetFeatureShape(name);
        auto const refiner = createRefiner(shape);
        std::vector<double> const expected = evaluateAll(*createFactory(*refiner), shape);
        auto const factory = createFactory(*refiner);
        ExpectOnThreads(expected, [&] { return evaluateAll(*factory, shape); });
    }
}

TEST(SharedSurfaces, OfOneCache) {
    std::vector<std::vector<double>> expected;
    std::vector<std::unique_ptr<TopologyRefiner>> refiners;
    for (char const *const name : getShapeNames()) {
        refiners.push_back(createRefiner(GetFeatureShape(name)));
        expected.push_back(evaluateAll(*createFactory(*refiners.back()), GetFeatureShape(name)));
    }
    SurfaceFactoryCache cache;
    ExpectOnThreads(expected, [&] {
        std::vector<std::vector<double>> made;
        for (std::size_t i = 0; i < refiners.size(); ++i) {
            auto const factory = createFactory(*refiners[i], &cache);
            made.push_back(evaluateAll(*factory, GetFeatureShape(getShapeNames()[i])));
            EXPECT_GT(cache.GetNumTypes(), 0u);
        }
        return made;
    });
}

// Types are forgotten while other threads evaluate them.
TEST(SharedSurfaces, OfOneSmallCache) {
    Shape const &shape = GetFeatureShape("dartsQuads");
    auto const refiner = createRefiner(shape);
    std::vector<double> const expected = evaluateAll(*createFactory(*refiner), shape);
    SurfaceFactoryCache cache(1 << 22);
    auto const factory = createFactory(*refiner, &cache);
    ExpectOnThreads(expected, [&] { return evaluateAll(*factory, shape); });
}

TEST(SharedSurfaces, OfOneTessellation) {
    Shape const &shape = GetFeatureShape("dartsQuads");
    auto const refiner = createRefiner(shape);
    // The first surface finds the plan of a tessellation.
    auto const makeTessellations = [] {
        int const levels[] = {4, 1, 5, 2, 3};
        std::vector<LevelTessellation> made;
        made.emplace_back(BfrExt::Parameterization(4), 5, levels);
        made.emplace_back(BfrExt::CellTree(4, 4));
        return made;
    };
    auto const evaluate = [&](std::vector<Surface<double>> const &surfaces,
                              std::vector<LevelTessellation> const &tessellations) {
        std::vector<double> all;
        for (Surface<double> const &surface : surfaces) {
            for (LevelTessellation const &tessellation : tessellations) {
                addPoints(surface, tessellation, shape.positions, &all);
            }
        }
        return all;
    };
    auto const makeSurfaces = [&] {
        auto const factory = createFactory(*refiner);
        std::vector<Surface<double>> made(std::size_t(factory->GetNumFaces()));
        for (int face = 0; face < factory->GetNumFaces(); ++face) {
            EXPECT_TRUE(factory->InitVertexSurface(face, &made[std::size_t(face)]));
        }
        return made;
    };
    std::vector<double> const expected = evaluate(makeSurfaces(), makeTessellations());
    auto const surfaces = makeSurfaces();
    auto const tessellations = makeTessellations();
    ExpectOnThreads(expected, [&] { return evaluate(surfaces, tessellations); });
}

// Tessellations and types are all kept, or there is memory for few.
TEST(SharedSurfaces, OfOneStream) {
    Shape const &shape = GetFeatureShape("dartsQuads");
    auto const refiner = createRefiner(shape);
    BfrExt::PatchLevels const levels([](int face) { return face % 5; },
                                     [](int edge) { return edge % 6; });
    Patches expected;
    for (bool const isKept : {true, false}) {
        Stream::Options options;
        options.SetDerivatives(true);
        options.SetMaxMemory(isKept ? 1 << 22 : 1 << 14);
        SurfaceFactoryCache cache(isKept ? 1 << 28 : 1 << 16);
        auto const factory = createFactory(*refiner, &cache);
        Stream const stream(*factory, levels, options);
        if (expected.empty()) {
            expected = run(Stream(*createFactory(*refiner), levels, options), shape);
        }
        ExpectOnThreads(expected, [&] { return run(stream, shape); });
    }
}

// A new forest and stream for each thread, as of cameras.
TEST(SharedSurfaces, OfForests) {
    Shape const &shape = GetFeatureShape("dartsQuads");
    auto const refiner = createRefiner(shape);
    auto const makePatches = [&](SurfaceFactory const &factory) {
        CellForest const forest = makeForest(factory, shape);
        Stream const stream(factory, forest, Stream::Options().SetDerivatives(true));
        return run(stream, shape);
    };
    Patches const expected = makePatches(*createFactory(*refiner));
    auto const factory = createFactory(*refiner);
    ExpectOnThreads(expected, [&] { return makePatches(*factory); });
}

} // namespace OpenSubdivHex::Regression::surfacesTest
