// SPDX-License-Identifier: Apache-2.0
//
// Threads that share refiners, tables, evaluators' settings and the error callback.  What each of
// them makes is the same; built with ThreadSanitizer, that no two of them race is tested, too.
#include "far_ext/stencilTableFactory.h"
#include "far_ext/topologyRefinerFactory.h"
#include "osd_ext/cpuEvaluator.h"
#include "osd_ext/polygonIndices.h"
#include "osd_ext/refinementEvaluator.h"
#include "osd_ext/stencilEvaluator.h"
#include "regression/osd_ext/evaluators.h"
#include "regression/shapes/featureShapes.h"
#include "regression/shapes/shapeDescriptor.h"
#include "regression/threads/onThreads.h"

#include <gtest/gtest.h>

#include <atomic>

namespace OpenSubdivHex::Regression::sharedTest {

using FarExt::StencilTableFactory;
using FarExt::TopologyRefiner;

namespace {

std::unique_ptr<TopologyRefiner> createRefiner(Shape const &shape, int level) {
    Sdc::Options options;
    options.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER);
    FarExt::HexSchemeOptions scheme;
    scheme.faceMask = FarExt::FaceMask::Smooth;
    auto refiner =
        FarExt::TopologyRefinerFactory::Create(*CreateFarRefiner(shape, options), {scheme});
    TopologyRefiner::UniformOptions uniform(level);
    uniform.fullTopologyInLastLevel = true;
    refiner->RefineUniform(uniform);
    return refiner;
}

/// A level from which on the loops run on several threads themselves.
constexpr int kLargeLevel = 6;

/// The weights of all kinds of tables.
std::vector<float> makeTables(TopologyRefiner const &refiner) {
    std::vector<float> weights;
    auto const add = [&](std::vector<float> const &more) {
        weights.insert(weights.end(), more.begin(), more.end());
    };
    StencilTableFactory::Options options;
    options.generateIntermediateLevels = false;
    add(StencilTableFactory::Create(refiner, options)->GetWeights());
    options.interpolationMode = FarExt::INTERPOLATE_FACE_VARYING;
    add(StencilTableFactory::Create(refiner, options)->GetWeights());
    int const faces[] = {0, 2};
    options.interpolationMode = FarExt::INTERPOLATE_VERTEX;
    add(StencilTableFactory::CreateOfFaces(refiner, Far::ConstIndexArray(faces, 2), options)
            ->GetWeights());
    weights.push_back(float(StencilTableFactory::GetSize(refiner, options).numWeights));
    FarExt::LimitStencilTableFactory::Options limitOptions;
    limitOptions.level = refiner.GetMaxLevel();
    limitOptions.generateFurtherSides = true;
    limitOptions.generateFaceCenters = true;
    add(FarExt::LimitStencilTableFactory::Create(refiner, limitOptions)->GetDuWeights());
    return weights;
}

std::vector<float> makeSource(int numElements) {
    std::vector<float> source;
    for (int i = 0; i < 3 * numElements; ++i) {
        source.push_back(float(i * 7919 % 1009) / 505 - 1);
    }
    return source;
}

template <class EVALUATOR>
std::vector<float> evaluate(Far::StencilTable const &table) {
    std::vector<float> const src = makeSource(table.GetNumControlVertices());
    std::vector<float> dst(3 * std::size_t(table.GetNumStencils()));
    Descriptor const desc(0, 3, 3);
    EVALUATOR::EvalStencils(src.data(), desc, dst.data(), desc, table.GetSizes().data(),
                            table.GetOffsets().data(), table.GetControlIndices().data(),
                            table.GetWeights().data(), 0, table.GetNumStencils());
    return dst;
}

std::vector<float> evaluateWithoutTable(TopologyRefiner const &refiner) {
    auto const evaluator = OsdExt::RefinementEvaluator::Create(refiner);
    std::vector<float> const src = makeSource(evaluator->GetNumElements(0));
    int const level = refiner.GetMaxLevel();
    std::vector<float> dst(3 * std::size_t(evaluator->GetNumElements(level)));
    Descriptor const desc(0, 3, 3);
    evaluator->Evaluate(src.data(), desc, dst.data(), desc, level);
    return dst;
}

/// Expects of each thread that it makes what one alone does.
template <typename MAKE>
void expectSameOnThreads(MAKE const &make) {
    ExpectOnThreads(make(), make);
}

} // namespace

TEST(Shared, RefinerMakesTables) {
    EvaluatorScope const scope(OsdExt::GetMaxSimdLevel(), 2);
    for (int level : {1, kLargeLevel}) {
        auto const refiner = createRefiner(GetFeatureShape("cubeOfCharts"), level);
        expectSameOnThreads([&] { return makeTables(*refiner); });
    }
}

TEST(Shared, RefinerIsValidatedAndDrawn) {
    EvaluatorScope const scope(OsdExt::GetMaxSimdLevel(), 2);
    auto const refiner = createRefiner(GetFeatureShape("cubeOfCharts"), 3);
    expectSameOnThreads([&] {
        std::vector<int> result = {refiner->GetLevel(2).Validate()};
        OsdExt::DrawOptions options;
        options.fvarChannels = {0};
        options.separateVertices = true;
        auto const triangles = OsdExt::CreateTriangleIndices(refiner->GetLevel(3), options);
        result.insert(result.end(), triangles.vertices.begin(), triangles.vertices.end());
        return result;
    });
}

TEST(Shared, RefinersAreMadeOfOneBase) {
    EvaluatorScope const scope(OsdExt::GetMaxSimdLevel(), 2);
    Shape const &shape = GetFeatureShape("cubeOfCharts");
    auto const base = CreateFarRefiner(shape);
    expectSameOnThreads([&] {
        auto const refiner = FarExt::TopologyRefinerFactory::Create(*base);
        refiner->RefineUniform(kLargeLevel);
        std::vector<int> vertices;
        FarExt::TopologyLevel const &last = refiner->GetLevel(kLargeLevel);
        for (int face = 0; face < last.GetNumFaces(); ++face) {
            auto const ofFace = last.GetFaceVertices(face);
            vertices.insert(vertices.end(), ofFace.begin(), ofFace.end());
        }
        return vertices;
    });
}

TEST(Shared, TableIsEvaluated) {
    EvaluatorScope const scope(OsdExt::GetMaxSimdLevel(), 2);
    auto const refiner = createRefiner(GetFeatureShape("cubeOfCharts"), kLargeLevel);
    auto const table = StencilTableFactory::Create(*refiner);
    expectSameOnThreads([&] { return evaluate<OsdExt::CpuEvaluator>(*table); });
    expectSameOnThreads([&] { return evaluate<OsdExt::ParallelEvaluator>(*table); });
    expectSameOnThreads([&] {
        return std::vector<std::size_t>{OsdExt::CompactStencilTable::Create(*table)->GetNumBytes()};
    });
}

TEST(Shared, RefinerHasSeveralEvaluators) {
    EvaluatorScope const scope(OsdExt::GetMaxSimdLevel(), 2);
    auto const refiner = createRefiner(GetFeatureShape("cubeOfCharts"), kLargeLevel);
    expectSameOnThreads([&] { return evaluateWithoutTable(*refiner); });
}

TEST(Shared, SimdLevelIsSetMeanwhile) {
    EvaluatorScope const scope(OsdExt::GetMaxSimdLevel(), 2);
    auto const refiner = createRefiner(GetFeatureShape("cubeOfCharts"), 3);
    auto const table = StencilTableFactory::Create(*refiner);
    std::vector<float> const expected = evaluate<OsdExt::CpuEvaluator>(*table);
    RunOnThreads([&](int thread) {
        for (int i = 0; i < 20; ++i) {
            if (thread == 0) {
                OsdExt::SetSimdLevel(GetSimdLevels()[std::size_t(i) % GetSimdLevels().size()]);
            }
            std::vector<float> const values = evaluate<OsdExt::CpuEvaluator>(*table);
            for (std::size_t k = 0; k < values.size(); ++k) {
                ASSERT_NEAR(values[k], expected[k], 1e-5f);
            }
        }
    });
}

namespace {
std::atomic<int> numErrors{0};
}

TEST(Shared, ErrorsAreReportedFromAllThreads) {
    FarExt::SetErrorCallback([](Far::ErrorType, char const *) { ++numErrors; });
    numErrors = 0;
    auto const refiner = createRefiner(GetFeatureShape("cubeOfCharts"), 1);
    constexpr int kNumRounds = 50;
    RunOnThreads([&](int) {
        for (int i = 0; i < kNumRounds; ++i) {
            StencilTableFactory::Options options;
            options.maxLevel = -1;
            FarExt::CallStatus status;
            EXPECT_FALSE(StencilTableFactory::Create(*refiner, options, &status));
            EXPECT_EQ(status.GetCode(), FarExt::StatusCode::InvalidArgument);
        }
    });
    FarExt::SetErrorCallback(nullptr);
    EXPECT_EQ(numErrors, kNumThreadsAtOnce * kNumRounds);
}

} // namespace OpenSubdivHex::Regression::sharedTest
