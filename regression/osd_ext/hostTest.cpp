// SPDX-License-Identifier: Apache-2.0
//
// Hosts as there are: with many threads that call at once, with threads that have numbers of
// threads of their own, and with child processes.
#include "far_ext/executor.h"
#include "far_ext/stencilTableFactory.h"
#include "far_ext/topologyRefinerFactory.h"
#include "osd_ext/cpuEvaluator.h"
#include "osd_ext/polygonIndices.h"
#include "osd_ext/refinementEvaluator.h"
#include "osd_ext/simdLevel.h"
#include "regression/shapes/shapeDescriptor.h"

#include <opensubdiv/osd/cpuVertexBuffer.h>

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <memory>
#include <numeric>
#include <thread>

#if defined(__unix__) || defined(__APPLE__)
#include <sys/wait.h>
#include <unistd.h>
#endif

namespace OpenSubdivHex::Regression::hostTest {

namespace {

/// Deep enough that topology, tables and evaluators work in parallel.
constexpr int kLevel = 6;

/// \brief Data that the threads of a host share, made by one of them.
struct Scene {
    Scene() {
        shape = MakeIcosahedron();
        shape.fvarChannels.resize(1);
        shape.fvarChannels[0].values = shape.positions;
        shape.fvarChannels[0].width = 3;
        shape.fvarChannels[0].valueIndices = shape.faceVertices;
        points.assign(shape.positions.begin(), shape.positions.end());
        base = CreateFarRefiner(shape);
        refiner = FarExt::TopologyRefinerFactory::Create(*base);
        refiner->RefineUniform(kLevel);
        table = FarExt::StencilTableFactory::Create(*refiner, getTableOptions());
        compactTable = OsdExt::CompactStencilTable::Create(*table);
    }

    static FarExt::StencilTableFactory::Options getTableOptions() {
        FarExt::StencilTableFactory::Options options;
        options.generateIntermediateLevels = false;
        return options;
    }

    Shape shape;
    std::vector<float> points;
    std::unique_ptr<Far::TopologyRefiner> base;
    std::unique_ptr<FarExt::TopologyRefiner> refiner;
    std::unique_ptr<Far::StencilTable const> table;
    std::unique_ptr<OsdExt::CompactStencilTable const> compactTable;
};

/// All that a thread of a host makes of the scene: of the refiner and the tables that the threads
/// share, and of its own.
struct Results {
    explicit Results(Scene const &scene) {
        auto const own = FarExt::TopologyRefinerFactory::Create(*scene.base);
        own->RefineUniform({kLevel});
        addTopology(own->GetLevel(kLevel));
        addTopology(scene.refiner->GetLevel(kLevel));
        for (FarExt::TopologyRefiner const *const refiner : {own.get(), scene.refiner.get()}) {
            addTables(*refiner);
            auto const evaluator = OsdExt::RefinementEvaluator::Create(*refiner);
            std::vector<float> &values = add(*scene.table);
            Osd::BufferDescriptor const desc(0, 3, 3);
            evaluator->Evaluate(scene.points.data(), desc, values.data(), desc, kLevel);
        }
        evaluate<OsdExt::CpuEvaluator>(scene, *scene.table);
        evaluate<OsdExt::ParallelEvaluator>(scene, *scene.table);
        evaluate<OsdExt::ParallelEvaluator>(scene, *scene.compactTable);
    }

    bool operator==(Results const &other) const {
        return indices == other.indices && floats == other.floats;
    }

    std::vector<std::vector<int>> indices;
    std::vector<std::vector<float>> floats;

private:
    std::vector<float> &add(Far::StencilTable const &table) {
        return floats.emplace_back(3 * std::size_t(table.GetNumStencils()));
    }

    void addTopology(FarExt::TopologyLevel const &level) {
        std::vector<int> &verts = indices.emplace_back();
        for (int face = 0; face < level.GetNumFaces(); ++face) {
            Far::ConstIndexArray const faceVerts = level.GetFaceVertices(face);
            verts.insert(verts.end(), faceVerts.begin(), faceVerts.end());
        }
        OsdExt::DrawOptions options;
        options.fvarChannels.resize(std::size_t(level.GetNumFVarChannels()));
        std::iota(options.fvarChannels.begin(), options.fvarChannels.end(), 0);
        options.separateVertices = true;
        indices.push_back(OsdExt::CreateTriangleIndices(level, options).vertices);
    }

    void addTables(FarExt::TopologyRefiner const &refiner) {
        FarExt::StencilTableFactory::Options options = Scene::getTableOptions();
        for (auto const mode : {FarExt::INTERPOLATE_VERTEX, FarExt::INTERPOLATE_FACE_VARYING}) {
            options.interpolationMode = mode;
            auto const table = FarExt::StencilTableFactory::Create(refiner, options);
            indices.push_back(table->GetControlIndices());
            floats.push_back(table->GetWeights());
        }
        FarExt::LimitStencilTableFactory::Options limitOptions;
        limitOptions.level = 1;
        auto const limit = FarExt::LimitStencilTableFactory::Create(refiner, limitOptions);
        indices.push_back(limit->GetControlIndices());
        floats.push_back(limit->GetDuWeights());
    }

    template <class EVALUATOR, class TABLE>
    void evaluate(Scene const &scene, TABLE const &table) {
        auto const numVertices = int(scene.points.size() / 3);
        std::unique_ptr<Osd::CpuVertexBuffer> const src(
            Osd::CpuVertexBuffer::Create(3, numVertices));
        std::unique_ptr<Osd::CpuVertexBuffer> const dst(
            Osd::CpuVertexBuffer::Create(3, table.GetNumStencils()));
        src->UpdateData(scene.points.data(), 0, numVertices);
        Osd::BufferDescriptor const desc(0, 3, 3);
        EVALUATOR::EvalStencils(src.get(), desc, dst.get(), desc, &table);
        float const *const values = dst->BindCpuBuffer();
        floats.emplace_back(values, values + 3 * std::size_t(table.GetNumStencils()));
    }
};

#if defined(__linux__)
/// The threads of this process.
int countThreads() {
    using Iterator = std::filesystem::directory_iterator;
    return int(std::distance(Iterator("/proc/self/task"), Iterator()));
}
#endif

/// Calls function() on a thread of its own, whose number of threads is \p numThreads.
template <class FUNCTION>
void callWithThreads(int numThreads, FUNCTION function) {
    std::thread([&] {
        FarExt::SetNumThreads(numThreads);
        function();
    }).join();
}

} // namespace

TEST(Host, ManyThreadsShareRefinersAndTables) {
    Scene const scene;
    Results const expected(scene);
    ASSERT_GT(scene.table->GetNumStencils(), 20000);
    constexpr int kNumThreads = 6;
    std::vector<std::unique_ptr<Results>> results(kNumThreads);
    std::vector<std::thread> threads;
    for (int i = 0; i < kNumThreads; ++i) {
        threads.emplace_back([&scene, &results, i] {
            FarExt::SetNumThreads(1 + i % 3);
            results[std::size_t(i)] = std::make_unique<Results>(scene);
        });
    }
    for (std::thread &thread : threads) {
        thread.join();
    }
    for (std::unique_ptr<Results> const &result : results) {
        EXPECT_TRUE(*result == expected);
    }
}

TEST(Host, EveryThreadHasItsOwnNumberOfThreads) {
    int const before = FarExt::GetNumThreads();
    callWithThreads(3, [&] {
        EXPECT_EQ(FarExt::GetNumThreads(), 3);
        callWithThreads(2, [&] { EXPECT_EQ(FarExt::GetNumThreads(), 2); });
        EXPECT_EQ(FarExt::GetNumThreads(), 3);
        FarExt::SetNumThreads(0);
        EXPECT_EQ(FarExt::GetNumThreads(), before);
        FarExt::SetNumThreads(-1);
        EXPECT_EQ(FarExt::GetNumThreads(), before);
    });
    EXPECT_EQ(FarExt::GetNumThreads(), before);
}

#if defined(__linux__)
// All calls share the threads that the library started for those that wanted the most.
TEST(Host, CallsUseAsManyThreadsAsTheirThreadSays) {
    FarExt::SetNumThreads(1);
    Scene const scene;
    callWithThreads(1, [&] {
        int const before = countThreads();
        Results const results(scene);
        EXPECT_EQ(countThreads(), before);
    });
    constexpr int kNumThreads = 20; // more than any test before
    callWithThreads(kNumThreads - 1, [&] { Results const results(scene); });
    int const before = countThreads();
    callWithThreads(kNumThreads, [&] { Results const results(scene); });
    EXPECT_EQ(countThreads(), before + 1);
    callWithThreads(2, [&] { Results const results(scene); });
    EXPECT_EQ(countThreads(), before + 1);
    FarExt::SetNumThreads(0);
}
#endif

#if defined(__unix__) || defined(__APPLE__)
// A child has none of the threads that its parent had.
TEST(Host, ChildProcessesGoOn) {
    Scene const scene;
    int const before = FarExt::GetNumThreads();
    FarExt::SetNumThreads(3);
    Results const expected(scene);
    pid_t const child = fork();
    if (child == 0) {
        constexpr unsigned kSeconds = 120;
        alarm(kSeconds);
        bool isRight = FarExt::GetNumThreads() == 3 && Results(scene) == expected;
#if defined(__linux__)
        isRight = isRight && countThreads() == 3;
#endif
        // A thread of the child has threads of its own.
        callWithThreads(2, [&] { isRight = isRight && Results(scene) == expected; });
        _exit(isRight ? 0 : 1);
    }
    ASSERT_GT(child, 0);
    EXPECT_EQ(FarExt::GetNumThreads(), 3);
    int status = 0;
    ASSERT_EQ(waitpid(child, &status, 0), child);
    EXPECT_TRUE(WIFEXITED(status)) << "signal " << WTERMSIG(status);
    EXPECT_EQ(WEXITSTATUS(status), 0);
    EXPECT_TRUE(Results(scene) == expected);
    FarExt::SetNumThreads(0);
    EXPECT_EQ(FarExt::GetNumThreads(), before);
}

namespace {

/// Exits with the level in use of a process that OPENSUBDIVHEX_SIMD says \p name to.
[[noreturn]] void exitWithSimdLevel(char const *name) {
    setenv("OPENSUBDIVHEX_SIMD", name, 1);
    _exit(int(OsdExt::GetSimdLevel()));
}

} // namespace

TEST(HostDeathTest, EnvironmentChoosesSimdLevel) {
    using OsdExt::SimdLevel;
    // Runs the program again, so that the variable is there when the level is first needed.
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    SimdLevel const max = OsdExt::GetMaxSimdLevel();
    for (SimdLevel const level : {SimdLevel::Portable, SimdLevel::Avx2, SimdLevel::Avx512}) {
        char const *const name = OsdExt::GetSimdLevelName(level);
        EXPECT_EXIT(exitWithSimdLevel(name), testing::ExitedWithCode(int(std::min(level, max))), "")
            << name;
        SimdLevel found = max;
        EXPECT_TRUE(OsdExt::FindSimdLevel(name, &found));
        EXPECT_EQ(found, level);
        EXPECT_FALSE(OsdExt::FindSimdLevel(std::string(name) + "x", &found));
        EXPECT_EQ(found, level);
    }
    for (char const *const name : {"", "AVX2", "sse"}) {
        EXPECT_EXIT(exitWithSimdLevel(name), testing::ExitedWithCode(int(max)), "") << name;
    }
}
#endif

} // namespace OpenSubdivHex::Regression::hostTest
