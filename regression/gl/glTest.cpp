// SPDX-License-Identifier: Apache-2.0
//
// Osd's evaluators of OpenGL, by compute shaders and by transform feedback, with the tables of this
// library: against the CPU, in a context without a window.
#include "glContext.h"

#include "far_ext/stencilTableFactory.h"
#include "far_ext/topologyRefinerFactory.h"
#include "osd_ext/cpuEvaluator.h"
#include "osd_ext/glEvaluation.h"
#include "osd_ext/stencilEvaluator.h"
#include "regression/shapes/featureShapes.h"
#include "regression/shapes/shapeDescriptor.h"

#include <opensubdiv/osd/cpuVertexBuffer.h>
#include <opensubdiv/osd/glVertexBuffer.h>
#include <opensubdiv/osd/glXFBEvaluator.h>

#include <gtest/gtest.h>

#include <cstdlib>
#include <memory>

namespace OpenSubdivHex::Regression::glTest {

namespace {

using Descriptor = Osd::BufferDescriptor;
using GlBuffer = std::unique_ptr<Osd::GLVertexBuffer>;

/// Differences between the evaluators of OpenGL.
struct Compute {
    using Evaluator = Osd::GLComputeEvaluator;
    using Table = Osd::GLStencilTableSSBO;
};
struct TransformFeedback {
    using Evaluator = Osd::GLXFBEvaluator;
    using Table = Osd::GLStencilTableTBO;
};

std::vector<float> makeSource(int numVertices, int stride) {
    std::vector<float> source;
    for (int i = 0; i < numVertices * stride; ++i) {
        source.push_back(float(i * 7919 % 1009) / 505 - 1);
    }
    return source;
}

template <typename T>
class Gl : public testing::Test {
protected:
    void SetUp() override {
        if (!context.GetError().empty()) {
            // CI has a driver, and sets this.
            ASSERT_FALSE(std::getenv("OPENSUBDIVHEX_NEEDS_GL")) << context.GetError();
            GTEST_SKIP() << context.GetError();
        }
        context.BindFramebuffer();
        Sdc::Options options;
        options.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER);
        refiner = FarExt::TopologyRefinerFactory::Create(
            *CreateFarRefiner(GetFeatureShape("cubeOfCharts"), options));
        FarExt::TopologyRefiner::UniformOptions uniform(3);
        uniform.fullTopologyInLastLevel = true;
        ASSERT_TRUE(refiner->RefineUniform(uniform));
    }
    void TearDown() override {
        if (context.GetError().empty()) {
            EXPECT_EQ(context.GetGlError(), GLenum(GL_NO_ERROR));
        }
    }

    std::unique_ptr<Far::StencilTable const> makeTable(bool isLastLevelAlone) {
        FarExt::StencilTableFactory::Options options;
        options.generateIntermediateLevels = !isLastLevelAlone;
        return FarExt::StencilTableFactory::Create(*refiner, options);
    }

    static GlBuffer makeBuffer(std::vector<float> const &values, int stride) {
        int const numVertices = int(values.size()) / stride;
        GlBuffer buffer(Osd::GLVertexBuffer::Create(stride, numVertices));
        buffer->UpdateData(values.data(), 0, numVertices);
        return buffer;
    }

    /// Whether the buffer has the floats, rounding apart.
    void expectFloats(Osd::GLVertexBuffer &buffer, std::vector<float> const &expected) {
        std::vector<float> const values = context.Read(buffer.BindVBO(), expected.size());
        for (std::size_t i = 0; i < values.size(); ++i) {
            ASSERT_NEAR(values[i], expected[i], 4e-6f) << "float " << i << " of " << values.size();
        }
    }

    GlContext context;
    std::unique_ptr<FarExt::TopologyRefiner> refiner;
};

using Kinds = testing::Types<Compute, TransformFeedback>;
struct KindNames {
    template <typename T>
    static std::string GetName(int) {
        return std::is_same_v<T, Compute> ? "Compute" : "TransformFeedback";
    }
};
TYPED_TEST_SUITE(Gl, Kinds, KindNames);

} // namespace

// Nothing else has called OpenGL before, when CTest runs this alone.
TYPED_TEST(Gl, TableMayBeMadeFirst) {
    auto const table = this->makeTable(true);
    auto const glTable = OsdExt::CreateGLStencilTable<typename TypeParam::Table>(*table);
    ASSERT_TRUE(glTable);
    EXPECT_EQ(glTable->GetNumStencils(), table->GetNumStencils());
}

TYPED_TEST(Gl, TablesGiveTheValuesOfTheCpu) {
    for (bool isLastLevelAlone : {true, false}) {
        auto const table = this->makeTable(isLastLevelAlone);
        auto const glTable = OsdExt::CreateGLStencilTable<typename TypeParam::Table>(*table);
        for (int length : {1, 3, 4, 8}) {
            SCOPED_TRACE(length);
            Descriptor const desc(0, length, length);
            std::vector<float> const src = makeSource(table->GetNumControlVertices(), length);
            std::vector<float> expected(std::size_t(table->GetNumStencils() * length), 7);
            OsdExt::CpuEvaluator::EvalStencils(
                src.data(), desc, expected.data(), desc, table->GetSizes().data(),
                table->GetOffsets().data(), table->GetControlIndices().data(),
                table->GetWeights().data(), 0, table->GetNumStencils());
            GlBuffer const srcBuffer = this->makeBuffer(src, length);
            GlBuffer const dstBuffer =
                this->makeBuffer(std::vector<float>(expected.size(), 9), length);
            std::unique_ptr<typename TypeParam::Evaluator> const evaluator(
                TypeParam::Evaluator::Create(desc, desc, Descriptor(), Descriptor()));
            ASSERT_TRUE(evaluator);
            ASSERT_TRUE(TypeParam::Evaluator::EvalStencils(srcBuffer.get(), desc, dstBuffer.get(),
                                                           desc, glTable.get(), evaluator.get()));
            this->expectFloats(*dstBuffer, expected);
        }
    }
}

// The results behind the control values, in one buffer whose vertices have more floats, which stay.
TYPED_TEST(Gl, TablesAreEvaluatedInPlace) {
    auto const table = this->makeTable(false);
    auto const glTable = OsdExt::CreateGLStencilTable<typename TypeParam::Table>(*table);
    int const numControl = table->GetNumControlVertices();
    constexpr int kLength = 3;
    constexpr int kStride = 5;
    Descriptor const srcDesc(0, kLength, kStride);
    Descriptor const dstDesc(numControl * kStride, kLength, kStride);
    std::vector<float> values = makeSource(numControl + table->GetNumStencils(), kStride);
    GlBuffer const buffer = this->makeBuffer(values, kStride);
    OsdExt::CpuEvaluator::EvalStencils(values.data(), srcDesc, values.data(), dstDesc,
                                       table->GetSizes().data(), table->GetOffsets().data(),
                                       table->GetControlIndices().data(),
                                       table->GetWeights().data(), 0, table->GetNumStencils());
    std::unique_ptr<typename TypeParam::Evaluator> const evaluator(
        TypeParam::Evaluator::Create(srcDesc, dstDesc, Descriptor(), Descriptor()));
    ASSERT_TRUE(evaluator);
    ASSERT_TRUE(TypeParam::Evaluator::EvalStencils(buffer.get(), srcDesc, buffer.get(), dstDesc,
                                                   glTable.get(), evaluator.get()));
    this->expectFloats(*buffer, values);
}

TYPED_TEST(Gl, LimitTablesGivePointsAndDerivatives) {
    FarExt::LimitStencilTableFactory::Options options;
    options.level = 2;
    options.generateFurtherSides = true;
    options.generateFaceCenters = true;
    auto const table = FarExt::LimitStencilTableFactory::Create(*this->refiner, options);
    ASSERT_TRUE(table);
    auto const glTable = OsdExt::CreateGLStencilTable<typename TypeParam::Table>(*table);
    constexpr int kLength = 3;
    Descriptor const desc(0, kLength, kLength);
    std::vector<float> const src = makeSource(table->GetNumControlVertices(), kLength);
    std::size_t const size = std::size_t(table->GetNumStencils() * kLength);
    std::vector<float> points(size);
    std::vector<float> du(size);
    std::vector<float> dv(size);
    OsdExt::CpuEvaluator::EvalStencils(
        src.data(), desc, points.data(), desc, du.data(), desc, dv.data(), desc,
        table->GetSizes().data(), table->GetOffsets().data(), table->GetControlIndices().data(),
        table->GetWeights().data(), table->GetDuWeights().data(), table->GetDvWeights().data(), 0,
        table->GetNumStencils());
    std::vector<float> const blank(size, 9);
    GlBuffer const srcBuffer = this->makeBuffer(src, kLength);
    GlBuffer const pointBuffer = this->makeBuffer(blank, kLength);
    GlBuffer const duBuffer = this->makeBuffer(blank, kLength);
    GlBuffer const dvBuffer = this->makeBuffer(blank, kLength);
    std::unique_ptr<typename TypeParam::Evaluator> const evaluator(
        TypeParam::Evaluator::Create(desc, desc, desc, desc));
    ASSERT_TRUE(evaluator);
    ASSERT_TRUE(TypeParam::Evaluator::EvalStencils(srcBuffer.get(), desc, pointBuffer.get(), desc,
                                                   duBuffer.get(), desc, dvBuffer.get(), desc,
                                                   glTable.get(), evaluator.get()));
    this->expectFloats(*pointBuffer, points);
    this->expectFloats(*duBuffer, du);
    this->expectFloats(*dvBuffer, dv);
    if constexpr (std::is_same_v<TypeParam, Compute>) {
        GlBuffer const others[] = {this->makeBuffer(blank, kLength),
                                   this->makeBuffer(blank, kLength),
                                   this->makeBuffer(blank, kLength)};
        constexpr int kRange = 100;
        ASSERT_TRUE(OsdExt::EvalStencilsInRanges(*evaluator, srcBuffer.get(), desc, others[0].get(),
                                                 desc, others[1].get(), desc, others[2].get(), desc,
                                                 *glTable, kRange));
        this->expectFloats(*others[0], points);
        this->expectFloats(*others[1], du);
        this->expectFloats(*others[2], dv);
    }
}

namespace {

class GlTransformFeedback : public Gl<TransformFeedback> {};

} // namespace

// A warning of the guide: without a complete framebuffer there is an error of OpenGL, and no output, but
// Osd's evaluator returns true.
TEST_F(GlTransformFeedback, WritesNothingWithoutAFramebuffer) {
    auto const table = makeTable(true);
    auto const glTable = OsdExt::CreateGLStencilTable<Osd::GLStencilTableTBO>(*table);
    Descriptor const desc(0, 3, 3);
    std::vector<float> const src = makeSource(table->GetNumControlVertices(), 3);
    std::vector<float> const before(3 * std::size_t(table->GetNumStencils()), 9);
    GlBuffer const srcBuffer = makeBuffer(src, 3);
    GlBuffer const dstBuffer = makeBuffer(before, 3);
    std::unique_ptr<Osd::GLXFBEvaluator> const evaluator(
        Osd::GLXFBEvaluator::Create(desc, desc, Descriptor(), Descriptor()));
    ASSERT_TRUE(evaluator);
    auto const evaluate = [&] {
        return Osd::GLXFBEvaluator::EvalStencils(srcBuffer.get(), desc, dstBuffer.get(), desc,
                                                 glTable.get(), evaluator.get());
    };
    auto const read = [&] { return context.Read(dstBuffer->BindVBO(), before.size()); };
    ASSERT_EQ(context.GetGlError(), GLenum(GL_NO_ERROR));
    context.UnbindFramebuffer();
    EXPECT_TRUE(evaluate());
    EXPECT_EQ(context.GetGlError(), GLenum(GL_INVALID_FRAMEBUFFER_OPERATION)); // 0x506
    EXPECT_TRUE(read() == before);
    context.BindFramebuffer();
    EXPECT_TRUE(evaluate());
    EXPECT_EQ(context.GetGlError(), GLenum(GL_NO_ERROR));
    EXPECT_FALSE(read() == before);
}

namespace {

/// As many stencils as one likes, each of one source and half its value.
class LargeTable : public Far::StencilTable {
public:
    LargeTable(int numControlVertices, int numStencils) {
        _numControlVertices = numControlVertices;
        for (int i = 0; i < numStencils; ++i) {
            _sizes.push_back(1);
            _offsets.push_back(i);
            _indices.push_back(i % numControlVertices);
            _weights.push_back(0.5f);
        }
    }
};

class GlLarge : public Gl<Compute> {};

} // namespace

TEST_F(GlLarge, RangesEvaluateMoreStencilsThanADispatchHas) {
    constexpr int kNumSources = 1000;
    constexpr int kNumStencils = OsdExt::kMaxGLComputeStencils + 1000;
    LargeTable const table(kNumSources, kNumStencils);
    auto const glTable = OsdExt::CreateGLStencilTable<Osd::GLStencilTableSSBO>(
        static_cast<Far::StencilTable const &>(table));
    Descriptor const desc(0, 1, 1);
    std::vector<float> const src = makeSource(kNumSources, 1);
    std::vector<float> expected;
    for (int i = 0; i < kNumStencils; ++i) {
        expected.push_back(src[std::size_t(i % kNumSources)] / 2);
    }
    GlBuffer const srcBuffer = makeBuffer(src, 1);
    std::unique_ptr<Osd::GLComputeEvaluator> const evaluator(
        Osd::GLComputeEvaluator::Create(desc, desc, Descriptor(), Descriptor()));
    ASSERT_TRUE(evaluator);
    std::vector<float> const before(expected.size(), 9);
    // A warning of the guide: more groups than the driver takes are an error of OpenGL, and no output,
    // but Osd's evaluator returns true.
    {
        bool const isTaken = (kNumStencils + 63) / 64 <= context.GetMaxComputeGroups();
        GlBuffer const dstBuffer = makeBuffer(before, 1);
        EXPECT_TRUE(Osd::GLComputeEvaluator::EvalStencils(srcBuffer.get(), desc, dstBuffer.get(),
                                                          desc, glTable.get(), evaluator.get()));
        EXPECT_EQ(context.GetGlError(), GLenum(isTaken ? GL_NO_ERROR : GL_INVALID_VALUE));
        expectFloats(*dstBuffer, isTaken ? expected : before);
    }
    for (int maxStencils : {OsdExt::kMaxGLComputeStencils, 1000000}) {
        GlBuffer const dstBuffer = makeBuffer(before, 1);
        ASSERT_TRUE(OsdExt::EvalStencilsInRanges(*evaluator, srcBuffer.get(), desc, dstBuffer.get(),
                                                 desc, *glTable, maxStencils));
        EXPECT_EQ(context.GetGlError(), GLenum(GL_NO_ERROR));
        expectFloats(*dstBuffer, expected);
    }
    for (int maxStencils : {0, -1}) {
        GlBuffer const dstBuffer = makeBuffer(before, 1);
        EXPECT_FALSE(OsdExt::EvalStencilsInRanges(*evaluator, srcBuffer.get(), desc,
                                                  dstBuffer.get(), desc, *glTable, maxStencils));
        expectFloats(*dstBuffer, before);
    }
}

} // namespace OpenSubdivHex::Regression::glTest
