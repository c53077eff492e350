// SPDX-License-Identifier: Apache-2.0
//
// Executors whose threads make other calls of the library while they wait for a loop to end.
#include "bfr_ext/patchStream.h"
#include "bfr_ext/surfaceFactory.h"
#include "bfr_ext/view.h"
#include "far_ext/executor.h"
#include "far_ext/stencilTableFactory.h"
#include "far_ext/topologyRefinerFactory.h"
#include "osd_ext/cpuEvaluator.h"
#include "osd_ext/polygonIndices.h"
#include "osd_ext/refinementEvaluator.h"
#include "regression/osd_ext/evaluators.h"
#include "regression/shapes/shapeDescriptor.h"
#include "regression/shapes/shapes.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <functional>
#include <memory>
#include <thread>
#include <tuple>
#include <utility>
#include <vector>

namespace OpenSubdivHex::Regression::nestedTest {

using BfrExt::LevelTessellation;
using BfrExt::Parameterization;
using BfrExt::Surface;
using BfrExt::SurfaceFactory;
using FarExt::TopologyRefiner;

namespace {

/// A thread for each call.  Before it waits for them, every thread does what there is to do meanwhile, but not inside
/// of that again.
class BusyWaiter : public FarExt::Executor {
public:
    explicit BusyWaiter(std::function<void()> meanwhile) : _meanwhile(std::move(meanwhile)) {}

    int GetNumThreads() const override { return 3; }
    void ParallelFor(int count, std::function<void(int)> const &function) override {
        static thread_local bool isBusy = false;
        std::vector<std::thread> threads;
        for (int i = 1; i < count; ++i) {
            threads.emplace_back([&function, i] { function(i); });
        }
        if (!std::exchange(isBusy, true)) {
            ++_numTimes;
            _meanwhile();
            isBusy = false;
        }
        function(0);
        for (std::thread &thread : threads) {
            thread.join();
        }
    }

    int GetNumTimes() const { return _numTimes; }

private:
    std::function<void()> const _meanwhile;
    std::atomic<int> _numTimes{0};
};

constexpr int kDim = 3;

std::vector<double> moved(std::vector<double> positions, double factor) {
    for (double &number : positions) {
        number = factor * number + 1;
    }
    return positions;
}

/// Surfaces, evaluated for tessellations and trees.
class SurfaceCalls {
public:
    SurfaceCalls(TopologyRefiner const &refiner, std::vector<int> const &faces)
        : _factory(SurfaceFactory::Create(refiner)) {
        for (int const face : faces) {
            _surfaces.push_back(_factory->CreateVertexSurface<double>(face));
            int const size = _surfaces.back()->GetFaceSize();
            _tessellations.push_back({LevelTessellation(Parameterization(size), 0),
                                      LevelTessellation(Parameterization(size), 2),
                                      LevelTessellation(BfrExt::CellTree(size, 4))});
        }
    }

    std::vector<double> Evaluate(std::vector<double> const &positions, bool hasDerivatives) const {
        std::vector<double> all;
        for (std::size_t i = 0; i < _surfaces.size(); ++i) {
            Surface<double> const &surface = *_surfaces[i];
            std::vector<double> control(kDim * std::size_t(surface.GetNumControlPoints()));
            surface.GatherControlPoints(positions.data(), kDim, control.data(), kDim);
            for (LevelTessellation const &tessellation : _tessellations[i]) {
                std::size_t const size = kDim * std::size_t(tessellation.GetNumCoords());
                std::vector<double> results(3 * size);
                if (hasDerivatives) {
                    surface.Evaluate(tessellation, control.data(), kDim, results.data(),
                                     &results[size], &results[2 * size], kDim);
                } else {
                    surface.Evaluate(tessellation, control.data(), kDim, results.data(), kDim);
                }
                all.insert(all.end(), results.begin(), results.end());
            }
        }
        return all;
    }

    SurfaceFactory const &GetFactory() const { return *_factory; }

private:
    std::unique_ptr<SurfaceFactory> _factory;
    std::vector<std::unique_ptr<Surface<double>>> _surfaces;
    std::vector<std::vector<LevelTessellation>> _tessellations;
};

std::unique_ptr<TopologyRefiner> createRefiner(Shape const &shape, int level) {
    Sdc::Options options;
    options.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER);
    auto refiner = FarExt::TopologyRefinerFactory::Create(*CreateFarRefiner(shape, options));
    TopologyRefiner::UniformOptions uniform(level);
    uniform.fullTopologyInLastLevel = true;
    refiner->RefineUniform(uniform);
    return refiner;
}

/// Polygons of \p size sides around vertex 0.
Shape makePole(int numFaces, int size) {
    int const numOthers = numFaces * (size - 2); // vertices
    Shape shape;
    shape.positions = {0, 0, 1};
    for (int i = 0; i < numOthers; ++i) {
        double const angle = 2 * std::acos(-1.0) * i / numOthers;
        shape.positions.insert(shape.positions.end(), {std::cos(angle), std::sin(angle), 0});
    }
    for (int face = 0; face < numFaces; ++face) {
        shape.faceSizes.push_back(size);
        shape.faceVertices.push_back(0);
        for (int i = 0; i < size - 1; ++i) {
            shape.faceVertices.push_back(1 + (face * (size - 2) + i) % numOthers);
        }
    }
    return shape;
}

} // namespace

// With so many vertices around a face, what is made of them when it is first asked for is enough for several threads.
// It is made with a lock held, and in the midst of an evaluation.
TEST(Nested, SurfacesAreEvaluatedInsideOfSurfaces) {
    Shape const shape = makePole(500, 12);
    auto const refiner = createRefiner(shape, 0);
    std::vector<int> const faces = {0, 3};
    std::vector<double> const others = moved(shape.positions, 2);
    std::vector<double> expected;
    std::vector<double> expectedOthers;
    {
        FarExt::ExecutorScope const scope(nullptr, 1);
        SurfaceCalls const calls(*refiner, faces);
        expected = calls.Evaluate(shape.positions, false);
        expectedOthers = calls.Evaluate(others, false);
    }
    SurfaceCalls const calls(*refiner, faces);
    BusyWaiter executor([&] { EXPECT_TRUE(calls.Evaluate(others, false) == expectedOthers); });
    FarExt::ExecutorScope const scope(&executor);
    EXPECT_TRUE(calls.Evaluate(shape.positions, false) == expected);
    EXPECT_EQ(executor.GetNumTimes(), 0); // surfaces have no loops of several threads
}

namespace {

/// Calls that make loops of several threads.
class LargeCalls {
public:
    explicit LargeCalls(Shape const &shape)
        : _shape(shape), _refiner(createRefiner(shape, kLevel)), _surfaces(*_refiner, {0, 1, 5}) {
        _source.assign(shape.positions.begin(), shape.positions.end());
    }

    std::vector<double> EvaluateSurfaces() const {
        return _surfaces.Evaluate(_shape.positions, true);
    }

    std::vector<float> RefineAndEvaluate() const {
        auto const refiner = createRefiner(_shape, kLevel);
        auto const evaluator = OsdExt::RefinementEvaluator::Create(*refiner);
        std::vector<float> values(kDim * std::size_t(evaluator->GetNumElements(kLevel)));
        Descriptor const desc(0, kDim, kDim);
        evaluator->Evaluate(_source.data(), desc, values.data(), desc, kLevel);
        std::vector<float> limits(values.size());
        evaluator->EvaluateLimit(_source.data(), desc, limits.data(), desc, kLevel);
        values.insert(values.end(), limits.begin(), limits.end());
        return values;
    }

    std::vector<float> MakeTables() const {
        auto const table = FarExt::StencilTableFactory::Create(*_refiner);
        std::vector<float> values(kDim * std::size_t(table->GetNumStencils()));
        Descriptor const desc(0, kDim, kDim);
        OsdExt::ParallelEvaluator::EvalStencils(
            _source.data(), desc, values.data(), desc, table->GetSizes().data(),
            table->GetOffsets().data(), table->GetControlIndices().data(),
            table->GetWeights().data(), 0, table->GetNumStencils());
        FarExt::LimitStencilTableFactory::Options options;
        options.level = 3;
        auto const limit = FarExt::LimitStencilTableFactory::Create(*_refiner, options);
        values.insert(values.end(), limit->GetDuWeights().begin(), limit->GetDuWeights().end());
        return values;
    }

    std::vector<int> Draw() const {
        return OsdExt::CreateTriangleIndices(_refiner->GetLevel(kLevel)).vertices;
    }

    // Trees of all faces, as an eye sees them, and their patches.
    std::vector<double> Stream() const {
        BfrExt::Camera camera;
        for (int axis = 0; axis < kDim; ++axis) {
            camera.eye[axis] = axis + 2;
        }
        BfrExt::View const view(camera);
        EXPECT_TRUE(view.IsValid());
        SurfaceFactory const &factory = _surfaces.GetFactory();
        BfrExt::CellForest const forest =
            view.MakeForest<double>(factory, _shape.positions.data(), kDim);
        std::vector<std::vector<double>> ofFaces(std::size_t(_shape.GetNumFaces()));
        BfrExt::PatchStream<double> const stream(factory, forest);
        EXPECT_TRUE(stream.Run(_shape.positions.data(), kDim, [&](auto const &patch) {
            std::vector<double> &points = ofFaces[std::size_t(patch.face)];
            points.assign(patch.points,
                          patch.points + kDim * std::size_t(patch.tessellation.GetNumCoords()));
            return true;
        }));
        std::vector<double> all;
        for (std::vector<double> const &points : ofFaces) {
            all.insert(all.end(), points.begin(), points.end());
        }
        return all;
    }

private:
    static constexpr int kLevel = 5;

    Shape const &_shape;
    std::unique_ptr<TopologyRefiner> _refiner;
    SurfaceCalls _surfaces;
    std::vector<float> _source;
};

} // namespace

TEST(Nested, CallsAreMadeInsideOfCalls) {
    Shape const shape = MakeIcosahedron();
    auto const makeAll = [](LargeCalls const &calls) {
        return std::make_tuple(calls.EvaluateSurfaces(), calls.RefineAndEvaluate(),
                               calls.MakeTables(), calls.Draw(), calls.Stream());
    };
    FarExt::SetNumThreads(1);
    auto const expected = makeAll(LargeCalls(shape));
    FarExt::SetNumThreads(0);
    LargeCalls const calls(shape);
    std::atomic<int> numCalls{0};
    BusyWaiter executor([&] {
        // In turn, since all together take long.
        int const call = numCalls++ % 5;
        if (call == 0) {
            EXPECT_TRUE(calls.EvaluateSurfaces() == std::get<0>(expected));
        } else if (call == 1) {
            EXPECT_TRUE(calls.RefineAndEvaluate() == std::get<1>(expected));
        } else if (call == 2) {
            EXPECT_TRUE(calls.MakeTables() == std::get<2>(expected));
        } else if (call == 3) {
            EXPECT_TRUE(calls.Draw() == std::get<3>(expected));
        } else {
            EXPECT_TRUE(calls.Stream() == std::get<4>(expected));
        }
    });
    FarExt::SetExecutor(&executor); // of its threads, too
    EXPECT_TRUE(makeAll(calls) == expected);
    FarExt::SetExecutor(nullptr);
    EXPECT_GT(numCalls, 10);
}

} // namespace OpenSubdivHex::Regression::nestedTest
