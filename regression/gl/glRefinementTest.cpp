// SPDX-License-Identifier: Apache-2.0
//
// GLRefinementEvaluator against RefinementEvaluator, and against the same kernels on the processor, in
// a context without a window.
#include "glContext.h"

#include "osd_ext/glRefinementEvaluator.h"
#include "regression/device/deviceEvaluatorTest.h"

#include <opensubdiv/osd/glVertexBuffer.h>

#include <cstdlib>

namespace OpenSubdivHex::Regression::glRefinementTest {

using OsdExt::GLRefinementEvaluator;
using OsdExt::RefinementEvaluator;

namespace {

/// A context of OpenGL, current while this lives.
struct OpenGl {
    static constexpr char const *kName = "Compute";
    using Evaluator = GLRefinementEvaluator;
    using Buffer = Osd::GLVertexBuffer;

    ~OpenGl() {
        if (context.GetError().empty()) {
            EXPECT_EQ(context.GetGlError(), GLenum(GL_NO_ERROR));
        }
    }
    std::string GetMissing() const { return context.GetError(); }
    // CI has a driver, and sets this.
    static bool IsNeeded() { return std::getenv("OPENSUBDIVHEX_NEEDS_GL") != nullptr; }
    static std::unique_ptr<Buffer> MakeBuffer(std::vector<float> const &values, int stride) {
        int const numVertices = int(values.size()) / stride;
        std::unique_ptr<Buffer> buffer(Buffer::Create(stride, numVertices));
        if (numVertices > 0) {
            buffer->UpdateData(values.data(), 0, numVertices);
        }
        return buffer;
    }
    std::vector<float> Read(Buffer &buffer, std::size_t numFloats) const {
        return context.Read(buffer.BindVBO(), numFloats);
    }
    static unsigned GetIntegers(Buffer &buffer) { return buffer.BindVBO(); }

    GlContext context;
};

class GlRefinement : public DeviceEvaluator<OpenGl> {};

} // namespace

INSTANTIATE_TYPED_TEST_SUITE_P(OpenGl, DeviceEvaluator, OpenGl, KindName);

// More elements than one dimension of groups has invocations.
TEST_F(GlRefinement, DispatchesMoreThanOneRowOfGroups) {
    Shape shape;
    shape.name = "quad and many isolated vertices";
    shape.faceSizes = {4};
    shape.faceVertices = {0, 1, 2, 3};
    constexpr int kNumVertices = 65535 * 64 + 100;
    shape.positions.resize(std::size_t(3) * kNumVertices);
    auto const refiner = MakeRefiner(shape, 0, Sdc::Options::VTX_BOUNDARY_EDGE_ONLY);
    auto const evaluator = GLRefinementEvaluator::Create(*refiner);
    std::vector<float> const src = MakeValues(kNumVertices, 1);
    Buffer const srcBuffer = kind.MakeBuffer(src, 1);
    Buffer const dstBuffer = kind.MakeBuffer(std::vector<float>(src.size(), kBlank), 1);
    Descriptor const desc(0, 1, 1);
    ASSERT_TRUE(evaluator->Evaluate(srcBuffer.get(), desc, dstBuffer.get(), desc, 0));
    expectBits(dstBuffer, src);
}

// Elements far apart, in a buffer of more than 2^31 bytes, few pages of which are touched: drivers that do
// not reach so far are not asked to.
TEST_F(GlRefinement, WritesBeyondTwoGigabytesOrRefuses) {
    auto const refiner = MakeRefiner(GetShape("cube"), 2, Sdc::Options::VTX_BOUNDARY_EDGE_ONLY);
    auto const evaluator = GLRefinementEvaluator::Create(*refiner);
    auto const expected = RefinementEvaluator::Create(*refiner);
    constexpr int kLength = 3;
    constexpr int kStride = 4500000;
    int const numElements = evaluator->GetNumElements(2);
    std::int64_t const numBytes = std::int64_t(numElements) * kStride * std::int64_t(sizeof(float));
    ASSERT_GT(numBytes, std::int64_t(1) << 31);
    GLuint const dst = kind.context.MakeBuffer(numBytes);
    if (dst == 0) {
        GTEST_SKIP() << "this driver has no buffer of " << numBytes << " bytes";
    }
    Descriptor const desc(0, kLength, kLength);
    std::vector<float> const src = MakeValues(evaluator->GetNumElements(0), kLength);
    std::vector<float> values(std::size_t(numElements) * kLength);
    ASSERT_TRUE(expected->Evaluate(src.data(), desc, values.data(), desc, 2));
    Buffer const srcBuffer = kind.MakeBuffer(src, kLength);
    FarExt::CallStatus status;
    if (evaluator->Evaluate(srcBuffer->BindVBO(), desc, dst, Descriptor(0, kLength, kStride), 2,
                            &status)) {
        for (int i = 0; i < numElements; ++i) {
            std::vector<float> const element =
                kind.context.Read(dst, kLength, std::int64_t(i) * kStride);
            for (int k = 0; k < kLength; ++k) {
                ASSERT_NEAR(element[std::size_t(k)], values[std::size_t(i * kLength + k)],
                            kNumUnits * kUnit)
                    << "element " << i;
            }
        }
    } else {
        EXPECT_EQ(status.GetCode(), FarExt::StatusCode::TooLarge);
        EXPECT_NE(status.GetErrorMessage().find("beyond what this driver reaches"),
                  std::string::npos);
    }
    kind.context.DeleteBuffer(dst);
}

TEST(GlRefinementWithoutContext, IsUnsupported) {
    auto const refiner = MakeRefiner(GetShape("cube"), 1, Sdc::Options::VTX_BOUNDARY_EDGE_ONLY);
    FarExt::CallStatus status;
    EXPECT_FALSE(GLRefinementEvaluator::Create(*refiner, &status));
    EXPECT_EQ(status.GetCode(), FarExt::StatusCode::Unsupported);
    EXPECT_EQ(status.GetErrorMessage(), "there is no current context of OpenGL 4.3");
}

TEST_F(GlRefinement, RefusesWhatItCannotEvaluate) {
    auto const refiner = MakeRefiner(GetShape("cube"), 2, Sdc::Options::VTX_BOUNDARY_EDGE_ONLY);
    FarExt::CallStatus status;
    EXPECT_FALSE(
        GLRefinementEvaluator::Create(*refiner, {FarExt::INTERPOLATE_FACE_VARYING, 0}, &status));
    EXPECT_EQ(status.GetErrorMessage(), "there is no face-varying channel 0; the mesh has 0");
    auto const evaluator = GLRefinementEvaluator::Create(*refiner);
    Descriptor const desc(0, 3, 3);
    Buffer const src = kind.MakeBuffer(MakeValues(evaluator->GetNumElements(0), 3), 3);
    Buffer const dst = kind.MakeBuffer(MakeValues(evaluator->GetNumElements(2), 3), 3);
    std::vector<float> const before = kind.context.Read(dst->BindVBO(), 3);
    auto const expectRefused = [&](unsigned srcName, Descriptor const &srcDesc, unsigned dstName,
                                   Descriptor const &dstDesc, int level, char const *message) {
        EXPECT_FALSE(evaluator->Evaluate(srcName, srcDesc, dstName, dstDesc, level, &status));
        EXPECT_EQ(status.GetCode(), FarExt::StatusCode::InvalidArgument);
        EXPECT_EQ(status.GetErrorMessage(), message);
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
                  "the source has 96 bytes, but its last element ends at byte 100");
    expectRefused(srcName, desc, dstName, Descriptor(1, 3, 3), 2,
                  ("the destination has " + std::to_string(12 * evaluator->GetNumElements(2)) +
                   " bytes, but its last element ends at byte " +
                   std::to_string(12 * evaluator->GetNumElements(2) + 4))
                      .c_str());
    EXPECT_EQ(kind.context.Read(dstName, 3), before);
}

} // namespace OpenSubdivHex::Regression::glRefinementTest
