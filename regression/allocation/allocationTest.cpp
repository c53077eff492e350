// SPDX-License-Identifier: Apache-2.0
//
// Every allocation fails once, and each with all that follow: std::bad_alloc reaches the caller,
// nothing leaks, and what was there before can be used as ever.
#include "failingAllocations.h"

#include "far_ext/executor.h"
#include "far_ext/primvarRefiner.h"
#include "far_ext/stencilTableFactory.h"
#include "far_ext/topologyRefinerFactory.h"
#include "osd_ext/cpuEvaluator.h"
#include "osd_ext/polygonIndices.h"
#include "osd_ext/refinementEvaluator.h"
#include "osd_ext/simdLevel.h"
#include "osd_ext/stencilEvaluator.h"
#include "regression/osd_ext/evaluators.h"
#include "regression/shapes/featureShapes.h"
#include "regression/shapes/shapeDescriptor.h"
#include "regression/shapes/torus.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <functional>

namespace OpenSubdivHex::Regression::allocationTest {

using FarExt::StencilTableFactory;
using FarExt::StencilTableFactoryReal;
using FarExt::TopologyRefiner;

namespace {

/// A base, and how far it is refined.
struct Subject {
    Shape shape;
    int level;
    int numThreads;
    std::unique_ptr<Far::TopologyRefiner> base;

    Subject(Shape const &subjectShape, int subjectLevel, int subjectThreads)
        : shape(subjectShape), level(subjectLevel), numThreads(subjectThreads) {
        Sdc::Options options;
        options.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER);
        base = CreateFarRefiner(shape, options);
    }

    std::unique_ptr<TopologyRefiner> CreateUnrefined() const {
        FarExt::HexSchemeOptions scheme;
        scheme.faceMask = FarExt::FaceMask::Smooth;
        return FarExt::TopologyRefinerFactory::Create(*base, {scheme});
    }
    void Refine(TopologyRefiner &refiner) const {
        TopologyRefiner::UniformOptions options(level);
        options.fullTopologyInLastLevel = true;
        ASSERT_TRUE(refiner.RefineUniform(options));
    }
};

/// All control vertices in a table of the last level: what a refiner that can be used gives.
struct Result {
    std::vector<int> indices;
    std::vector<float> weights;

    explicit Result(TopologyRefiner const &refiner) {
        StencilTableFactory::Options options;
        options.generateIntermediateLevels = false;
        auto const table = StencilTableFactory::Create(refiner, options);
        indices = table->GetControlIndices();
        weights = table->GetWeights();
    }
    bool operator==(Result const &other) const {
        return indices == other.indices && weights == other.weights;
    }
};

/// Something that takes memory.
struct Step {
    char const *name;
    bool isOfRefined; ///< else of a refiner that has the base alone
    std::function<void(Subject const &, TopologyRefiner &)> run;
};

template <typename REAL>
void createTables(TopologyRefiner const &refiner, FarExt::StencilMode mode, bool isFactorized) {
    typename StencilTableFactoryReal<REAL>::Options options;
    options.interpolationMode = mode;
    options.factorizeIntermediateLevels = isFactorized;
    options.generateControlVerts = !isFactorized;
    StencilTableFactoryReal<REAL>::Create(refiner, options);
}

void createSelection(TopologyRefiner const &refiner) {
    std::vector<int> const faces = {0, refiner.GetLevel(0).GetNumFaces() - 1};
    Far::ConstIndexArray const selected(faces.data(), int(faces.size()));
    StencilTableFactory::CreateOfFaces(refiner, selected, {});
    StencilTableFactory::GetVerticesOfFaces(refiner, selected, {}, refiner.GetMaxLevel());
}

template <typename REAL>
void createLimit(TopologyRefiner const &refiner, int level) {
    typename FarExt::LimitStencilTableFactoryReal<REAL>::Options options;
    options.level = level;
    options.generateFurtherSides = true;
    options.generateFaceCenters = true;
    FarExt::LimitStencilTableFactoryReal<REAL>::Create(refiner, options);
}

void evaluateTable(TopologyRefiner const &refiner) {
    auto const table = StencilTableFactory::Create(refiner);
    auto const compact = OsdExt::CompactStencilTable::Create(*table);
    std::vector<float> const src(std::size_t(3 * table->GetNumControlVertices()), 1.0f);
    std::vector<float> dst(std::size_t(3 * table->GetNumStencils()));
    Descriptor const desc(0, 3, 3);
    auto const evaluate = [&](auto const &function) {
        ASSERT_TRUE(function(src.data(), desc, dst.data(), desc, table->GetSizes().data(),
                             table->GetOffsets().data(), table->GetControlIndices().data(),
                             table->GetWeights().data(), 0, table->GetNumStencils()));
    };
    evaluate(EvaluatorFunctions::Of<OsdExt::CpuEvaluator>().value);
    evaluate(EvaluatorFunctions::Of<OsdExt::ParallelEvaluator>().value);
}

void evaluateWithoutTable(TopologyRefiner const &refiner, FarExt::StencilMode mode) {
    OsdExt::RefinementEvaluator::Options options;
    options.interpolationMode = mode;
    auto const evaluator = OsdExt::RefinementEvaluator::Create(refiner, options);
    std::vector<float> const src(std::size_t(3 * evaluator->GetNumElements(0)), 1.0f);
    std::vector<float> dst(std::size_t(3 * evaluator->GetNumElementsAllLevels()));
    Descriptor const desc(0, 3, 3);
    ASSERT_TRUE(evaluator->Evaluate(src.data(), desc, dst.data(), desc, refiner.GetMaxLevel()));
    ASSERT_TRUE(evaluator->EvaluateAllLevels(src.data(), desc, dst.data(), desc));
}

std::vector<Step> const &getSteps() {
    static std::vector<Step> const steps = {
        {"create", false,
         [](Subject const &subject, TopologyRefiner &) { subject.CreateUnrefined(); }},
        {"refine", false,
         [](Subject const &subject, TopologyRefiner &refiner) { subject.Refine(refiner); }},
        {"refine again", true,
         [](Subject const &subject, TopologyRefiner &refiner) { subject.Refine(refiner); }},
        {"refine coplanar", false,
         [](Subject const &subject, TopologyRefiner &refiner) {
             TopologyRefiner::CoplanarOptions options(subject.level);
             options.fullTopologyInLastLevel = true;
             refiner.RefineCoplanar(subject.shape.positions.data(), options);
         }},
        {"table", true,
         [](Subject const &, TopologyRefiner &refiner) {
             createTables<float>(refiner, FarExt::INTERPOLATE_VERTEX, true);
         }},
        {"table of doubles, not factorized", true,
         [](Subject const &, TopologyRefiner &refiner) {
             createTables<double>(refiner, FarExt::INTERPOLATE_VERTEX, false);
         }},
        {"varying table", true,
         [](Subject const &, TopologyRefiner &refiner) {
             createTables<float>(refiner, FarExt::INTERPOLATE_VARYING, true);
         }},
        {"face-varying table", true,
         [](Subject const &, TopologyRefiner &refiner) {
             createTables<float>(refiner, FarExt::INTERPOLATE_FACE_VARYING, true);
         }},
        {"table of faces", true,
         [](Subject const &, TopologyRefiner &refiner) { createSelection(refiner); }},
        {"size of a table", true,
         [](Subject const &, TopologyRefiner &refiner) {
             StencilTableFactory::GetSize(refiner, {});
         }},
        {"limit of the base", true,
         [](Subject const &, TopologyRefiner &refiner) { createLimit<double>(refiner, 0); }},
        {"limit of level 1", true,
         [](Subject const &, TopologyRefiner &refiner) { createLimit<float>(refiner, 1); }},
        {"evaluation of a table", true,
         [](Subject const &, TopologyRefiner &refiner) { evaluateTable(refiner); }},
        {"evaluation without a table", true,
         [](Subject const &, TopologyRefiner &refiner) {
             evaluateWithoutTable(refiner, FarExt::INTERPOLATE_VERTEX);
         }},
        {"face-varying evaluation without a table", true,
         [](Subject const &, TopologyRefiner &refiner) {
             evaluateWithoutTable(refiner, FarExt::INTERPOLATE_FACE_VARYING);
         }},
        {"triangles", true,
         [](Subject const &, TopologyRefiner &refiner) {
             OsdExt::DrawOptions options;
             options.separateVertices = true;
             OsdExt::CreateTriangleIndices(refiner.GetLevel(refiner.GetMaxLevel()), options);
         }},
        {"validation", true,
         [](Subject const &, TopologyRefiner &refiner) { refiner.GetLevel(1).Validate(); }},
    };
    return steps;
}

/// Printed by std::terminate.
char const *currentStep = "";
long currentNumber = 0;

/// \brief Runs a step in which allocations fail, and checks what is left.
/// \return  whether one failed
bool runFailing(Subject const &subject, Step const &step, Failing failing, long number,
                Result const &expected) {
    currentStep = step.name;
    currentNumber = number;
    long const numLive = CountLiveAllocations();
    auto refiner = subject.CreateUnrefined();
    if (step.isOfRefined) {
        subject.Refine(*refiner);
    }
    bool isThrown = false;
    bool hasFailed = false;
    {
        FailingAllocations const failures(failing, number);
        try {
            step.run(subject, *refiner);
        } catch (std::bad_alloc const &) {
            isThrown = true;
        }
        hasFailed = failures.HasFailed();
    }
    bool const isOfTopology = std::string(step.name).find("refine") == 0;
    // A step may do without memory that it does not get, but not end well in another way.
    EXPECT_TRUE(hasFailed || !isThrown) << step.name << ", allocation " << number;
    if (isThrown && isOfTopology) {
        bool const isAsBefore = step.isOfRefined && refiner->GetMaxLevel() == subject.level;
        EXPECT_TRUE(isAsBefore || refiner->GetMaxLevel() == 0) << step.name << ", " << number;
    }
    if (step.isOfRefined && refiner->GetMaxLevel() > 0) {
        EXPECT_TRUE(Result(*refiner) == expected) << step.name << ", allocation " << number;
    }
    subject.Refine(*refiner);
    EXPECT_TRUE(Result(*refiner) == expected) << step.name << ", allocation " << number;
    refiner.reset(); // it keeps what it needs again, such as rules of levels
    EXPECT_EQ(CountLiveAllocations(), numLive) << step.name << " leaks, allocation " << number;
    return hasFailed;
}

/// \param maxTries  of a step that makes more allocations, so many are chosen evenly
void runSteps(Subject const &subject, long maxTries) {
    EvaluatorScope const scope(OsdExt::GetMaxSimdLevel(), subject.numThreads);
    std::set_terminate([] {
        std::fprintf(stderr, "terminated: %s, allocation %ld\n", currentStep, currentNumber);
        std::abort();
    });
    auto const refiner = subject.CreateUnrefined();
    subject.Refine(*refiner);
    Result const expected(*refiner);
    for (Step const &step : getSteps()) {
        SCOPED_TRACE(step.name);
        // Once without a failure: what is kept for ever is there then.
        long count = 0;
        for (int round = 0; round < 2; ++round) {
            auto const other = subject.CreateUnrefined();
            if (step.isOfRefined) {
                subject.Refine(*other);
            }
            FailingAllocations const counted(Failing::None, 0);
            step.run(subject, *other);
            count = counted.GetCount();
        }
        EXPECT_GT(count, 0);
        long numFailed = 0;
        long const stride = std::max(1L, count / maxTries);
        for (long number = 1; number <= count; number += stride) {
            numFailed += runFailing(subject, step, Failing::One, number, expected);
            numFailed += runFailing(subject, step, Failing::AllSince, number, expected);
            if (testing::Test::HasFailure()) {
                return;
            }
        }
        EXPECT_GE(numFailed, count / stride);
        long const numLive = CountLiveAllocations();
        { auto const gone = subject.CreateUnrefined(); }
        EXPECT_EQ(CountLiveAllocations(), numLive);
    }
}

} // namespace

// A refiner keeps memory for the next refinement: its leaks show when it is gone.
TEST(Allocation, RefinersThatRanOutOfMemoryLeaveNothing) {
    Subject const subject(GetFeatureShape("cubeOfCharts"), 2, 1);
    for (int round = 0; round < 2; ++round) {
        long const numLive = CountLiveAllocations();
        for (long number = 1; number < 200; ++number) {
            auto const refiner = subject.CreateUnrefined();
            FailingAllocations const failures(Failing::One, number);
            try {
                refiner->RefineUniform(subject.level);
            } catch (std::bad_alloc const &) {
            }
        }
        EXPECT_EQ(CountLiveAllocations(), numLive);
    }
}

TEST(Allocation, FailsOnceOnOneThread) {
    for (char const *name : {"cubeOfCharts", "creaseMeetsBorderQuads", "wideSectors"}) {
        SCOPED_TRACE(name);
        Shape shape = GetFeatureShape(name);
        long maxTries = 1000000;
        if (shape.fvarChannels.empty()) {
            shape.fvarChannels.push_back(MakeFaceChannel(shape));
            maxTries = 40;
        }
        runSteps(Subject(shape, 1, 1), maxTries);
    }
}

// A level that is large enough for several threads.
TEST(Allocation, FailsOnceOnThreads) {
    Subject const subject(GetFeatureShape("cubeOfCharts"), 6, 3);
    runSteps(subject, 4);
}

// Kernels ask for it in loops that throw nothing.  The name is too long for a string without memory.
TEST(Allocation, TheSimdLevelIsFoundWithoutMemory) {
    ASSERT_EQ(setenv("OPENSUBDIVHEX_SIMD", "a level that no machine and no library has", 1), 0);
    FailingAllocations const failures(Failing::AllSince, 1);
    EXPECT_EQ(OsdExt::GetSimdLevel(), OsdExt::GetMaxSimdLevel());
    EXPECT_EQ(failures.GetCount(), 0);
}

namespace {

/// Bytes that are needed at once to make the tables of a level beyond those of the tables.
long findScratchBytes(TopologyRefiner const &refiner, int numThreads) {
    FarExt::SetNumThreads(numThreads);
    auto const measure = [](auto const &make) {
        long const live = CountLiveBytes();
        ResetPeakBytes();
        auto const table = make();
        EXPECT_TRUE(table);
        return GetPeakBytes() - live;
    };
    StencilTableFactory::Options options;
    options.generateIntermediateLevels = false;
    FarExt::LimitStencilTableFactory::Options limitOptions;
    limitOptions.level = 1;
    limitOptions.generateVertices = false;
    limitOptions.generateFaceCenters = true;
    long const result = std::max(
        measure([&] { return StencilTableFactory::Create(refiner, options); }),
        measure([&] { return FarExt::LimitStencilTableFactory::Create(refiner, limitOptions); }));
    FarExt::SetNumThreads(0);
    return result;
}

} // namespace

// Vertices that no face has make the level large and its tables quick to make.
TEST(Allocation, ThreadsNeedLittleBesideALevel) {
    constexpr int kNumVertices = 1 << 21;
    Shape shape = MakeTorus(40, 40, TorusFaces::Quads);
    shape.positions.resize(3 * std::size_t(kNumVertices));
    Subject const subject(shape, 1, 1);
    auto const refiner = subject.CreateUnrefined();
    subject.Refine(*refiner);
    long const ofOne = findScratchBytes(*refiner, 1);
    long const ofMany = findScratchBytes(*refiner, 8);
    EXPECT_LT(ofMany - ofOne, 32 * kNumVertices) << "bytes more for seven threads more";
}

} // namespace OpenSubdivHex::Regression::allocationTest
