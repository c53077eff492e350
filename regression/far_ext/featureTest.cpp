// SPDX-License-Identifier: Apache-2.0
//
// Boundaries, tags, flaws and face-varying channels: every feature shape against the reference.
#include "expectations.h"

#include "regression/shapes/featureShapes.h"
#include "regression/shapes/meshOperations.h"
#include "regression/shapes/shapeDescriptor.h"

#include <gtest/gtest.h>

namespace OpenSubdivHex::Regression::featureTest {

namespace {

constexpr Sdc::Options::CreasingMethod kCreasingMethods[] = {Sdc::Options::CREASE_UNIFORM,
                                                             Sdc::Options::CREASE_CHAIKIN};
constexpr Sdc::Options::FVarLinearInterpolation kLinearInterpolations[] = {
    Sdc::Options::FVAR_LINEAR_NONE,          Sdc::Options::FVAR_LINEAR_CORNERS_ONLY,
    Sdc::Options::FVAR_LINEAR_CORNERS_PLUS1, Sdc::Options::FVAR_LINEAR_CORNERS_PLUS2,
    Sdc::Options::FVAR_LINEAR_BOUNDARIES,    Sdc::Options::FVAR_LINEAR_ALL};

void expectChannelEqual(Shape const &shape, Sdc::Options options, int channel, int numLevels) {
    SCOPED_TRACE(testing::Message()
                 << "channel " << channel << ", linear " << options.GetFVarLinearInterpolation());
    auto const topology = CreateRefiner(shape, ReferenceMask::Average, numLevels, options);
    ASSERT_EQ(topology->GetFVarLinearInterpolation(channel), options.GetFVarLinearInterpolation());
    TaggedMatch const match(shape, *topology, channel);
    ASSERT_EQ(match.GetError(), "");
    ReferenceValues const values = GetValues(shape.fvarChannels[channel]);
    for (ReferenceMask mask : kMasks) {
        SCOPED_TRACE(ToString(mask));
        auto const refiner = CreateRefiner(shape, mask, numLevels, options);
        ASSERT_NO_FATAL_FAILURE(ExpectChannelValuesEqual(*refiner, match, mask, values, channel));
    }
}

} // namespace

class Feature : public testing::Test {
protected:
    /// Runs check(shape, options) for every shape, boundary rule and creasing method; a failure
    /// ends the shape's checks, not those of others.
    template <typename CHECK>
    void forEach(std::vector<Shape> const &shapes, CHECK const &check) {
        for (Shape const &shape : shapes) {
            for (auto boundary : kBoundaries) {
                for (auto method : kCreasingMethods) {
                    if (shape.creaseSharpness.empty() && method != kCreasingMethods[0]) {
                        continue;
                    }
                    SCOPED_TRACE(testing::Message() << shape.name << ", boundary " << boundary
                                                    << ", creases " << method);
                    Sdc::Options options;
                    options.SetVtxBoundaryInterpolation(boundary);
                    options.SetCreasingMethod(method);
                    check(shape, options);
                }
            }
        }
    }
};

// Up to the step from which on all masks are constant, where the shape is small enough.
TEST_F(Feature, MeshEqualsReference) {
    forEach(GetFeatureShapes(), [](Shape const &shape, Sdc::Options options) {
        ExpectMeshEqual(shape, GetTestLevel(shape, 5, 40000), options);
    });
}

TEST_F(Feature, PlainShapesEqualReference) {
    forEach(GetShapes(), [](Shape const &shape, Sdc::Options options) {
        ExpectMeshEqual(shape, GetTestLevel(shape, 4, 16000), options);
    });
}

// Quads around vertices of three, four, five and six, in all steps with masks of their own.
TEST_F(Feature, QuadsEqualReference) {
    for (Shape const &shape : {MakeOrtho("quads of an icosahedron", MakeIcosahedron()),
                               MakeOrtho("quads of a bipyramid", MakeBipyramid(6))}) {
        SCOPED_TRACE(shape.name);
        ExpectMeshEqual(shape, 4, Sdc::Options());
    }
}

TEST_F(Feature, FaceVaryingEqualsReference) {
    forEach(GetFeatureShapes(), [](Shape const &shape, Sdc::Options options) {
        for (auto linear : kLinearInterpolations) {
            options.SetFVarLinearInterpolation(linear);
            for (int channel = 0; channel < int(shape.fvarChannels.size()); ++channel) {
                expectChannelEqual(shape, options, channel, GetTestLevel(shape, 5, 10000));
            }
        }
    });
}

} // namespace OpenSubdivHex::Regression::featureTest
