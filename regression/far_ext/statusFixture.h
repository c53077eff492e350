// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_REGRESSION_FAR_EXT_STATUS_FIXTURE_H
#define OPENSUBDIVHEX_REGRESSION_FAR_EXT_STATUS_FIXTURE_H

#include "far_ext/topologyRefinerFactory.h"
#include "regression/shapes/shapeDescriptor.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace OpenSubdivHex::Regression {

inline FarExt::HexSchemeOptions const kOtherSchemes[] = {
    {FarExt::FaceMask::Average, FarExt::SchemeType::DooSabin, FarExt::FirstStep::Same},
    {FarExt::FaceMask::Average, FarExt::SchemeType::TriHex, FarExt::FirstStep::Same},
    {FarExt::FaceMask::Average, FarExt::SchemeType::Hexagonal, FarExt::FirstStep::TriHex}};

inline std::string lastError;
inline int numErrors = 0;

inline void RecordError(Far::ErrorType, char const *message) {
    lastError = message;
    ++numErrors;
}

inline Shape MakeShape(int numVertices, std::vector<std::vector<int>> const &faces) {
    Shape shape;
    for (int v = 0; v < numVertices; ++v) {
        for (double coordinate : {1.0 * v, 1.0 * v * v, 1.0 / (v + 1)}) {
            shape.positions.push_back(coordinate);
        }
    }
    for (std::vector<int> const &face : faces) {
        shape.faceSizes.push_back(int(face.size()));
        shape.faceVertices.insert(shape.faceVertices.end(), face.begin(), face.end());
    }
    return shape;
}

/// A base of the faces of \p level.
inline Shape MakeShape(FarExt::TopologyLevel const &level) {
    std::vector<std::vector<int>> faces;
    for (int f = 0; f < level.GetNumFaces(); ++f) {
        auto const vertices = level.GetFaceVertices(f);
        faces.emplace_back(vertices.begin(), vertices.end());
    }
    return MakeShape(level.GetNumVertices(), faces);
}

/// No test of this group may print.
class StatusTest : public testing::Test {
protected:
    void SetUp() override {
        lastError.clear();
        numErrors = 0;
        testing::internal::CaptureStdout();
        testing::internal::CaptureStderr();
    }

    void TearDown() override {
        FarExt::SetErrorCallback(nullptr);
        EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
        EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
    }

    struct Refusal {
        FarExt::StatusCode code;
        FarExt::ComponentType component;
        int index;
        std::vector<std::string> words; ///< that the message must hold
    };

    void expectRefusal(FarExt::CallStatus const &status, Refusal const &expected) {
        EXPECT_FALSE(status.IsOk());
        EXPECT_EQ(status.GetCode(), expected.code) << status.GetErrorMessage();
        EXPECT_EQ(status.GetComponentType(), expected.component) << status.GetErrorMessage();
        EXPECT_EQ(status.GetComponentIndex(), expected.index) << status.GetErrorMessage();
        for (std::string const &word : expected.words) {
            EXPECT_NE(status.GetErrorMessage().find(word), std::string::npos)
                << '"' << status.GetErrorMessage() << "\" does not tell \"" << word << '"';
        }
    }

    void expectDescriptorRefused(Shape const &shape, Refusal const &expected,
                                 Sdc::Options options = Sdc::Options()) {
        ShapeDescriptor const descriptor(shape);
        FarExt::CallStatus status;
        EXPECT_FALSE(FarExt::TopologyRefinerFactory::Create(descriptor.Get(), options, &status));
        expectRefusal(status, expected);
        // Without a CallStatus, and through the callback.
        FarExt::SetErrorCallback(RecordError);
        numErrors = 0;
        EXPECT_FALSE(FarExt::TopologyRefinerFactory::Create(descriptor.Get(), options));
        EXPECT_EQ(numErrors, 1);
        EXPECT_EQ(lastError, status.GetErrorMessage());
        FarExt::SetErrorCallback(nullptr);
    }

    /// Every scheme but the hexagonal one refuses the shape.
    void expectRefusedByOtherSchemes(Shape const &shape, Refusal const &expected) {
        auto const base = CreateFarRefiner(shape);
        ASSERT_TRUE(base);
        ShapeDescriptor const descriptor(shape);
        for (FarExt::HexSchemeOptions const &scheme : kOtherSchemes) {
            FarExt::TopologyRefinerFactory::Options options;
            options.hexSchemeOptions = scheme;
            FarExt::CallStatus status;
            EXPECT_FALSE(FarExt::TopologyRefinerFactory::Create(descriptor.Get(), Sdc::Options(),
                                                                options, &status));
            expectRefusal(status, expected);
            status = FarExt::CallStatus();
            EXPECT_FALSE(FarExt::TopologyRefinerFactory::Create(*base, options, &status));
            expectRefusal(status, expected);
        }
        EXPECT_TRUE(FarExt::TopologyRefinerFactory::Create(*base));
    }

    void expectRefused(Shape const &shape, Refusal const &expected,
                       Sdc::Options options = Sdc::Options()) {
        expectDescriptorRefused(shape, expected, options);
        auto const base = CreateFarRefiner(shape, options);
        ASSERT_TRUE(base);
        FarExt::CallStatus status;
        EXPECT_FALSE(FarExt::TopologyRefinerFactory::Create(*base, &status));
        expectRefusal(status, expected);
    }
};

} // namespace OpenSubdivHex::Regression

#endif
