// SPDX-License-Identifier: Apache-2.0
//
// GLRefinementEvaluator against RefinementEvaluator, in a context without a window.
#include "glContext.h"

#include "far_ext/topologyRefinerFactory.h"
#include "osd_ext/glRefinementEvaluator.h"
#include "regression/shapes/featureShapes.h"
#include "regression/shapes/shapeDescriptor.h"

#include <opensubdiv/osd/glVertexBuffer.h>

#include <gtest/gtest.h>

#include <cstdlib>
#include <memory>

namespace OpenSubdivHex::Regression {

using FarExt::TopologyRefiner;
using OsdExt::GLRefinementEvaluator;
using OsdExt::RefinementEvaluator;

namespace {

using Descriptor = Osd::BufferDescriptor;
using GlBuffer = std::unique_ptr<Osd::GLVertexBuffer>;

/// Of values up to 1 in size: the two add the same numbers in another order.
constexpr float kTolerance = 2e-6f;
constexpr float kBlank = 9;

std::vector<float> makeValues(int count, int stride) {
    std::vector<float> values;
    for (std::int64_t i = 0; i < std::int64_t(count) * stride; ++i) {
        values.push_back(float(i * 7919 % 1009) / 505 - 1);
    }
    return values;
}

std::unique_ptr<TopologyRefiner> makeRefiner(Shape const &shape, int level,
                                             Sdc::Options::VtxBoundaryInterpolation boundary,
                                             FarExt::HexSchemeOptions schemeOptions = {}) {
    Sdc::Options sdcOptions;
    sdcOptions.SetVtxBoundaryInterpolation(boundary);
    FarExt::TopologyRefinerFactory::Options options;
    options.schemeOptions = schemeOptions;
    ShapeDescriptor const descriptor(shape);
    FarExt::Status status;
    auto refiner =
        FarExt::TopologyRefinerFactory::Create(descriptor.Get(), sdcOptions, options, &status);
    if (!refiner || !refiner->RefineUniform(level, &status)) {
        throw std::runtime_error(shape.name + ": " + status.GetMessage());
    }
    return refiner;
}

class GlRefinement : public testing::Test {
protected:
    void SetUp() override {
        if (!context.GetError().empty()) {
            // ./dev test gl installs a driver, and sets this.
            ASSERT_FALSE(std::getenv("OPENSUBDIVHEX_NEEDS_GL")) << context.GetError();
            GTEST_SKIP() << context.GetError();
        }
    }
    void TearDown() override {
        if (context.GetError().empty()) {
            EXPECT_EQ(context.GetGlError(), GLenum(GL_NO_ERROR));
        }
    }

    static GlBuffer makeBuffer(std::vector<float> const &values, int stride) {
        int const numVertices = int(values.size()) / stride;
        GlBuffer buffer(Osd::GLVertexBuffer::Create(stride, numVertices));
        if (numVertices > 0) {
            buffer->UpdateData(values.data(), 0, numVertices);
        }
        return buffer;
    }

    void expectFloats(Osd::GLVertexBuffer &buffer, std::vector<float> const &expected) const {
        std::vector<float> const values = context.Read(buffer.BindVBO(), expected.size());
        for (std::size_t i = 0; i < values.size(); ++i) {
            ASSERT_NEAR(values[i], expected[i], kTolerance) << "float " << i;
        }
    }

    /// All levels together and each alone.
    void expectEqual(TopologyRefiner const &refiner, RefinementEvaluator::Options options,
                     int length) const {
        SCOPED_TRACE(testing::Message() << "mode " << options.interpolationMode << ", channel "
                                        << options.fvarChannel << ", length " << length);
        FarExt::Status status;
        auto const evaluator = RefinementEvaluator::Create(refiner, options);
        auto const glEvaluator = GLRefinementEvaluator::Create(refiner, options, &status);
        ASSERT_TRUE(glEvaluator) << status.GetMessage();
        ASSERT_EQ(glEvaluator->GetMaxLevel(), evaluator->GetMaxLevel());
        ASSERT_EQ(glEvaluator->GetNumElementsAllLevels(), evaluator->GetNumElementsAllLevels());
        Descriptor const desc(0, length, length);
        std::vector<float> const src = makeValues(evaluator->GetNumElements(0), length);
        GlBuffer const srcBuffer = makeBuffer(src, length);
        std::vector<float> dst(std::size_t(evaluator->GetNumElementsAllLevels() * length));
        ASSERT_TRUE(evaluator->EvaluateAllLevels(src.data(), desc, dst.data(), desc));
        GlBuffer dstBuffer = makeBuffer(std::vector<float>(dst.size(), kBlank), length);
        ASSERT_TRUE(
            glEvaluator->EvaluateAllLevels(srcBuffer.get(), desc, dstBuffer.get(), desc, &status))
            << status.GetMessage();
        ASSERT_NO_FATAL_FAILURE(expectFloats(*dstBuffer, dst));
        for (int level = 0; level <= evaluator->GetMaxLevel(); ++level) {
            SCOPED_TRACE(testing::Message() << "level " << level);
            dst.assign(std::size_t(evaluator->GetNumElements(level) * length), 0);
            ASSERT_EQ(glEvaluator->GetNumElements(level), evaluator->GetNumElements(level));
            ASSERT_TRUE(evaluator->Evaluate(src.data(), desc, dst.data(), desc, level));
            dstBuffer = makeBuffer(std::vector<float>(dst.size(), kBlank), length);
            ASSERT_TRUE(glEvaluator->Evaluate(srcBuffer.get(), desc, dstBuffer.get(), desc, level));
            ASSERT_NO_FATAL_FAILURE(expectFloats(*dstBuffer, dst));
        }
    }

    GlContext context;
};

} // namespace

TEST_F(GlRefinement, GivesTheValuesOfTheCpu) {
    std::vector<Shape> shapes = GetShapes();
    shapes.insert(shapes.end(), GetFeatureShapes().begin(), GetFeatureShapes().end());
    for (Shape const &shape : shapes) {
        for (auto boundary :
             {Sdc::Options::VTX_BOUNDARY_NONE, Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER}) {
            SCOPED_TRACE(testing::Message() << shape.name << ", boundary " << boundary);
            auto const refiner = makeRefiner(shape, shape.GetNumFaces() > 100 ? 1 : 3, boundary);
            ASSERT_NO_FATAL_FAILURE(expectEqual(*refiner, {}, 3));
            for (int channel = 0; channel < refiner->GetNumFVarChannels(); ++channel) {
                ASSERT_NO_FATAL_FAILURE(
                    expectEqual(*refiner, {FarExt::INTERPOLATE_FACE_VARYING, channel}, 2));
            }
        }
    }
}

TEST_F(GlRefinement, TakesEveryLengthMaskSchemeAndMode) {
    for (char const *name : {"cubeOfCharts", "cube"}) {
        for (auto type : {FarExt::SchemeType::Hexagonal, FarExt::SchemeType::DooSabin,
                          FarExt::SchemeType::TriHex}) {
            bool const isHexagonal = type == FarExt::SchemeType::Hexagonal;
            bool const hasCharts = std::string("cubeOfCharts") == name;
            if (hasCharts != isHexagonal) {
                continue; // the others have no rules for charts
            }
            for (auto mask :
                 {FarExt::FaceMask::Average, FarExt::FaceMask::Cosine, FarExt::FaceMask::Smooth}) {
                FarExt::HexSchemeOptions schemeOptions;
                schemeOptions.schemeType = type;
                schemeOptions.faceMask = mask;
                if (mask == FarExt::FaceMask::Smooth && isHexagonal) {
                    schemeOptions.firstStep = FarExt::FirstStep::Truncate;
                }
                auto const refiner =
                    makeRefiner(hasCharts ? GetFeatureShape(name) : GetShape(name), 3,
                                Sdc::Options::VTX_BOUNDARY_EDGE_ONLY, schemeOptions);
                for (int length : {1, 4, 7}) {
                    ASSERT_NO_FATAL_FAILURE(expectEqual(*refiner, {}, length));
                }
                ASSERT_NO_FATAL_FAILURE(expectEqual(*refiner, {FarExt::INTERPOLATE_VARYING, 0}, 3));
                for (int channel = 0; channel < refiner->GetNumFVarChannels(); ++channel) {
                    ASSERT_NO_FATAL_FAILURE(
                        expectEqual(*refiner, {FarExt::INTERPOLATE_FACE_VARYING, channel}, 2));
                }
            }
        }
    }
}

TEST_F(GlRefinement, TakesEveryFirstStep) {
    for (auto firstStep : {FarExt::FirstStep::TriHex, FarExt::FirstStep::Truncate}) {
        FarExt::HexSchemeOptions schemeOptions;
        schemeOptions.faceMask = FarExt::FaceMask::Smooth;
        schemeOptions.firstStep = firstStep;
        auto const refiner =
            makeRefiner(GetShape("torus"), 3, Sdc::Options::VTX_BOUNDARY_EDGE_ONLY, schemeOptions);
        ASSERT_NO_FATAL_FAILURE(expectEqual(*refiner, {}, 3));
    }
}

// Long runs of faces and vertices, and what an evaluator keeps of them.
TEST_F(GlRefinement, KeepsFewBytesOfLargeLevels) {
    auto const refiner = makeRefiner(GetShape("torus"), 5, Sdc::Options::VTX_BOUNDARY_EDGE_ONLY);
    ASSERT_NO_FATAL_FAILURE(expectEqual(*refiner, {}, 3));
    auto const evaluator = GLRefinementEvaluator::Create(*refiner);
    EXPECT_LE(evaluator->GetNumDeviceBytes(), 8 * evaluator->GetNumElements(5));
}

// The results behind the control values, in one buffer whose vertices have more floats, which stay.
TEST_F(GlRefinement, IsEvaluatedInPlace) {
    constexpr int kLength = 3;
    constexpr int kStride = 5;
    auto const refiner = makeRefiner(GetShape("cube"), 3, Sdc::Options::VTX_BOUNDARY_EDGE_ONLY);
    auto const evaluator = RefinementEvaluator::Create(*refiner);
    auto const glEvaluator = GLRefinementEvaluator::Create(*refiner);
    int const numControl = evaluator->GetNumElements(0);
    Descriptor const srcDesc(1, kLength, kStride);
    Descriptor const dstDesc(numControl * kStride + 1, kLength, kStride);
    std::vector<float> values =
        makeValues(numControl + int(evaluator->GetNumElementsAllLevels()), kStride);
    GlBuffer const buffer = makeBuffer(values, kStride);
    ASSERT_TRUE(evaluator->EvaluateAllLevels(values.data(), srcDesc, values.data(), dstDesc));
    ASSERT_TRUE(glEvaluator->EvaluateAllLevels(buffer.get(), srcDesc, buffer.get(), dstDesc));
    expectFloats(*buffer, values);
    EXPECT_TRUE(
        glEvaluator->Evaluate(buffer.get(), srcDesc, buffer.get(), dstDesc, 2)); // the first ones
    EXPECT_TRUE(evaluator->Evaluate(values.data(), srcDesc, values.data(), dstDesc, 2));
    expectFloats(*buffer, values);
}

// More elements than one dimension of groups has invocations.
TEST_F(GlRefinement, DispatchesMoreThanOneRowOfGroups) {
    Shape shape;
    shape.name = "quad and many isolated vertices";
    shape.faceSizes = {4};
    shape.faceVertices = {0, 1, 2, 3};
    constexpr int kNumVertices = 65535 * 64 + 100;
    shape.positions.resize(std::size_t(3) * kNumVertices);
    auto const refiner = makeRefiner(shape, 0, Sdc::Options::VTX_BOUNDARY_EDGE_ONLY);
    auto const evaluator = GLRefinementEvaluator::Create(*refiner);
    std::vector<float> const src = makeValues(kNumVertices, 1);
    GlBuffer const srcBuffer = makeBuffer(src, 1);
    GlBuffer const dstBuffer = makeBuffer(std::vector<float>(src.size(), kBlank), 1);
    Descriptor const desc(0, 1, 1);
    ASSERT_TRUE(evaluator->Evaluate(srcBuffer.get(), desc, dstBuffer.get(), desc, 0));
    expectFloats(*dstBuffer, src);
}

TEST(GlRefinementWithoutContext, IsUnsupported) {
    auto const refiner = makeRefiner(GetShape("cube"), 1, Sdc::Options::VTX_BOUNDARY_EDGE_ONLY);
    FarExt::Status status;
    EXPECT_FALSE(GLRefinementEvaluator::Create(*refiner, &status));
    EXPECT_EQ(status.GetCode(), FarExt::StatusCode::Unsupported);
    EXPECT_EQ(status.GetMessage(), "there is no current context of OpenGL 4.3");
}

TEST_F(GlRefinement, RefusesWhatItCannotEvaluate) {
    auto const refiner = makeRefiner(GetShape("cube"), 2, Sdc::Options::VTX_BOUNDARY_EDGE_ONLY);
    FarExt::Status status;
    EXPECT_FALSE(
        GLRefinementEvaluator::Create(*refiner, {FarExt::INTERPOLATE_FACE_VARYING, 0}, &status));
    EXPECT_EQ(status.GetMessage(), "there is no face-varying channel 0 among the refiner's 0");
    auto const evaluator = GLRefinementEvaluator::Create(*refiner);
    Descriptor const desc(0, 3, 3);
    GlBuffer const src = makeBuffer(makeValues(evaluator->GetNumElements(0), 3), 3);
    GlBuffer const dst = makeBuffer(makeValues(evaluator->GetNumElements(2), 3), 3);
    std::vector<float> const before = context.Read(dst->BindVBO(), 3);
    auto const expectRefused = [&](unsigned srcName, Descriptor const &srcDesc, unsigned dstName,
                                   Descriptor const &dstDesc, int level, char const *message) {
        EXPECT_FALSE(evaluator->Evaluate(srcName, srcDesc, dstName, dstDesc, level, &status));
        EXPECT_EQ(status.GetCode(), FarExt::StatusCode::InvalidArgument);
        EXPECT_EQ(status.GetMessage(), message);
    };
    unsigned const srcName = src->BindVBO();
    unsigned const dstName = dst->BindVBO();
    expectRefused(srcName, desc, dstName, desc, 3, "level 3 is not between 0 and 2");
    expectRefused(srcName, desc, dstName, desc, -1, "level -1 is not between 0 and 2");
    expectRefused(
        srcName, desc, dstName, Descriptor(0, 2, 3), 1,
        "the lengths of source and destination are 3 and 2: not the same, or less than 1");
    expectRefused(srcName, Descriptor(0, 3, 2), dstName, desc, 1,
                  "a descriptor has stride 2 for length 3 and offset 0");
    expectRefused(0, desc, dstName, desc, 1, "the source 0 is no buffer");
    expectRefused(srcName, desc, 12345, desc, 1, "the destination 12345 is no buffer");
    expectRefused(srcName, Descriptor(1, 3, 3), dstName, desc, 1,
                  "the source has 96 bytes, but the last of 8 elements ends at byte 100");
    expectRefused(srcName, desc, dstName, Descriptor(1, 3, 3), 2,
                  ("the destination has " + std::to_string(12 * evaluator->GetNumElements(2)) +
                   " bytes, but the last of " + std::to_string(evaluator->GetNumElements(2)) +
                   " elements ends at byte " +
                   std::to_string(12 * evaluator->GetNumElements(2) + 4))
                      .c_str());
    EXPECT_EQ(context.Read(dstName, 3), before);
}

} // namespace OpenSubdivHex::Regression
