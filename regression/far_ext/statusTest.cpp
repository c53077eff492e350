// SPDX-License-Identifier: Apache-2.0
#include "far_ext/topologyRefinerFactory.h"
#include "regression/shapes/shapeDescriptor.h"

#include <gtest/gtest.h>

#include <string>

namespace OpenSubdivHex::Regression {

using FarExt::ComponentType;
using FarExt::Status;
using FarExt::StatusCode;
using FarExt::TopologyRefiner;
using FarExt::TopologyRefinerFactory;

namespace {

std::string lastError;
int numErrors = 0;

void recordError(Far::ErrorType, char const *message) {
    lastError = message;
    ++numErrors;
}

Shape makeShape(int numVertices, std::vector<std::vector<int>> const &faces) {
    Shape shape;
    for (int v = 0; v < numVertices; ++v) {
        shape.positions.insert(shape.positions.end(), {1.0 * v, 1.0 * v * v, 1.0 / (v + 1)});
    }
    for (std::vector<int> const &face : faces) {
        shape.faceSizes.push_back(int(face.size()));
        shape.faceVertices.insert(shape.faceVertices.end(), face.begin(), face.end());
    }
    return shape;
}

} // namespace

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
        StatusCode code;
        ComponentType component;
        int index;
        std::vector<std::string> words; ///< that the message must hold
    };

    void expectRefusal(Status const &status, Refusal const &expected) {
        EXPECT_FALSE(status.IsOk());
        EXPECT_EQ(status.GetCode(), expected.code) << status.GetMessage();
        EXPECT_EQ(status.GetComponentType(), expected.component) << status.GetMessage();
        EXPECT_EQ(status.GetComponentIndex(), expected.index) << status.GetMessage();
        for (std::string const &word : expected.words) {
            EXPECT_NE(status.GetMessage().find(word), std::string::npos)
                << '"' << status.GetMessage() << "\" does not tell \"" << word << '"';
        }
    }

    void expectDescriptorRefused(Shape const &shape, Refusal const &expected,
                                 Sdc::Options options = Sdc::Options()) {
        ShapeDescriptor const descriptor(shape);
        Status status;
        EXPECT_FALSE(TopologyRefinerFactory::Create(descriptor.Get(), options, &status));
        expectRefusal(status, expected);
        // Without a Status, and through the callback.
        FarExt::SetErrorCallback(recordError);
        numErrors = 0;
        EXPECT_FALSE(TopologyRefinerFactory::Create(descriptor.Get(), options));
        EXPECT_EQ(numErrors, 1);
        EXPECT_EQ(lastError, status.GetMessage());
        FarExt::SetErrorCallback(nullptr);
    }

    void expectRefused(Shape const &shape, Refusal const &expected,
                       Sdc::Options options = Sdc::Options()) {
        expectDescriptorRefused(shape, expected, options);
        auto const base = CreateFarRefiner(shape, options);
        ASSERT_TRUE(base);
        Status status;
        EXPECT_FALSE(TopologyRefinerFactory::Create(*base, &status));
        expectRefusal(status, expected);
    }
};

TEST_F(StatusTest, DefaultIsOk) {
    Status const status;
    EXPECT_TRUE(status.IsOk());
    EXPECT_EQ(status.GetCode(), StatusCode::Ok);
    EXPECT_EQ(status.GetComponentType(), ComponentType::None);
    EXPECT_EQ(status.GetComponentIndex(), Far::INDEX_INVALID);
    EXPECT_EQ(status.GetMessage(), "");
}

TEST_F(StatusTest, SuccessOverwritesAFailure) {
    Status status(StatusCode::Unsupported, ComponentType::Face, 3, "old");
    ShapeDescriptor const descriptor(GetShape("cube"));
    auto const refiner = TopologyRefinerFactory::Create(descriptor.Get(), Sdc::Options(), &status);
    ASSERT_TRUE(refiner);
    EXPECT_TRUE(status.IsOk());
    EXPECT_EQ(status.GetMessage(), "");
    status = Status(StatusCode::Unsupported, ComponentType::Face, 3, "old");
    EXPECT_TRUE(refiner->RefineUniform(1, &status));
    EXPECT_TRUE(status.IsOk());
}

TEST_F(StatusTest, EmptyMesh) {
    expectDescriptorRefused(
        Shape(), {StatusCode::InvalidTopology, ComponentType::None, -1, {"empty", "0 faces"}});
    expectDescriptorRefused(
        makeShape(3, {}),
        {StatusCode::InvalidTopology, ComponentType::None, -1, {"empty", "0 faces"}});
}

TEST_F(StatusTest, NoArrays) {
    Status status;
    Far::TopologyDescriptor descriptor;
    descriptor.numVertices = 3;
    descriptor.numFaces = 1;
    EXPECT_FALSE(TopologyRefinerFactory::Create(descriptor, Sdc::Options(), &status));
    expectRefusal(status, {StatusCode::InvalidArgument, ComponentType::None, -1, {"arrays"}});
}

TEST_F(StatusTest, FaceTooSmall) {
    expectDescriptorRefused(
        makeShape(5, {{0, 1, 2}, {2, 1}, {2, 1, 3}}),
        {StatusCode::InvalidTopology, ComponentType::Face, 1, {"face 1", "2 vertices"}});
    expectDescriptorRefused(
        makeShape(5, {{0, 1, 2}, {2, 1, 3}, {}}),
        {StatusCode::InvalidTopology, ComponentType::Face, 2, {"face 2", "0 vertices"}});
    Shape negative = makeShape(3, {{0, 1, 2}});
    negative.faceSizes[0] = -3;
    expectDescriptorRefused(
        negative, {StatusCode::InvalidTopology, ComponentType::Face, 0, {"face 0", "-3 vertices"}});
}

TEST_F(StatusTest, FaceTooLarge) {
    Shape shape;
    shape.positions.resize(3 * 70000);
    shape.faceSizes = {70000};
    for (int v = 0; v < 70000; ++v) {
        shape.faceVertices.push_back(v);
    }
    expectDescriptorRefused(
        shape, {StatusCode::TooLarge, ComponentType::Face, 0, {"face 0", "70000", "65535"}});
}

TEST_F(StatusTest, VertexOfTooManyFaces) {
    Shape shape = makeShape(1, {});
    int const numFaces = 66000;
    shape.positions.resize(3 * (2 * numFaces + 1));
    for (int f = 0; f < numFaces; ++f) {
        shape.faceSizes.push_back(3);
        shape.faceVertices.insert(shape.faceVertices.end(), {0, 1 + f, 2 + f});
    }
    expectDescriptorRefused(
        shape, {StatusCode::TooLarge, ComponentType::Vertex, 0, {"vertex 0", "faces"}});
}

TEST_F(StatusTest, VertexOutOfRange) {
    expectDescriptorRefused(
        makeShape(4, {{0, 1, 2}, {2, 1, 4}}),
        {StatusCode::InvalidTopology, ComponentType::Face, 1, {"face 1", "vertex 4", "0 to 3"}});
    expectDescriptorRefused(
        makeShape(4, {{0, 1, 2}, {2, 1, 3}, {0, -7, 1}}),
        {StatusCode::InvalidTopology, ComponentType::Face, 2, {"face 2", "vertex -7"}});
}

TEST_F(StatusTest, RepeatedVertex) {
    expectRefused(makeShape(5, {{0, 1, 2}, {2, 1, 3, 1}}),
                  {StatusCode::InvalidTopology,
                   ComponentType::Face,
                   1,
                   {"face 1", "vertex 1", "more than once"}});
}

TEST_F(StatusTest, InconsistentOrientation) {
    Shape const shape = makeShape(4, {{0, 1, 2}, {1, 2, 3}});
    int edge = -1;
    {
        auto const base = CreateFarRefiner(shape);
        edge = base->GetLevel(0).FindEdge(1, 2);
    }
    expectRefused(shape, {StatusCode::InvalidTopology,
                          ComponentType::Edge,
                          edge,
                          {"faces 0 and 1", "vertices 1 and 2", "same direction"}});
}

TEST_F(StatusTest, NonManifoldEdge) {
    Shape const shape = makeShape(5, {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}});
    int edge = -1;
    {
        auto const base = CreateFarRefiner(shape);
        edge = base->GetLevel(0).FindEdge(0, 1);
    }
    expectRefused(shape, {StatusCode::Unsupported,
                          ComponentType::Edge,
                          edge,
                          {"non-manifold", "vertices 0 and 1", "3 faces"}});
}

TEST_F(StatusTest, NonManifoldVertex) {
    expectRefused(
        makeShape(5, {{0, 1, 2}, {3, 4, 2}}),
        {StatusCode::Unsupported, ComponentType::Vertex, 2, {"vertex 2", "non-manifold"}});
}

TEST_F(StatusTest, NonManifoldShapesAreRefused) {
    for (Shape const &shape : GetShapes()) {
        ShapeDescriptor const descriptor(shape);
        Status status;
        auto const refiner =
            TopologyRefinerFactory::Create(descriptor.Get(), Sdc::Options(), &status);
        EXPECT_EQ(refiner != nullptr, shape.manifold) << shape.name << ": " << status.GetMessage();
    }
}

TEST_F(StatusTest, BoundaryRules) {
    for (auto rule :
         {Sdc::Options::VTX_BOUNDARY_EDGE_ONLY, Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER}) {
        Sdc::Options options;
        options.SetVtxBoundaryInterpolation(rule);
        expectRefused(GetShape("quadGrid"),
                      {StatusCode::Unsupported, ComponentType::None, -1, {"VTX_BOUNDARY_NONE"}},
                      options);
    }
}

TEST_F(StatusTest, Creases) {
    Shape shape = GetShape("cube");
    shape.creaseVertexPairs = {shape.faceVertices[5], shape.faceVertices[6]};
    shape.creaseSharpness = {2.5f};
    int edge = -1;
    {
        auto const base = CreateFarRefiner(shape);
        edge = base->GetLevel(0).FindEdge(shape.faceVertices[5], shape.faceVertices[6]);
    }
    expectRefused(shape, {StatusCode::Unsupported, ComponentType::Edge, edge, {"crease", "2.5"}});
}

TEST_F(StatusTest, Corners) {
    Shape shape = GetShape("cube");
    shape.cornerVertices = {5};
    shape.cornerSharpness = {1.5f};
    expectRefused(
        shape, {StatusCode::Unsupported, ComponentType::Vertex, 5, {"vertex 5", "corner", "1.5"}});
}

TEST_F(StatusTest, NegativeRefinementLevel) {
    ShapeDescriptor const descriptor(GetShape("cube"));
    auto const refiner = TopologyRefinerFactory::Create(descriptor.Get());
    ASSERT_TRUE(refiner->RefineUniform(2));
    Status status;
    EXPECT_FALSE(refiner->RefineUniform(-1, &status));
    expectRefusal(status, {StatusCode::InvalidArgument, ComponentType::Level, -1, {"-1"}});
    EXPECT_EQ(refiner->GetMaxLevel(), 2);
}

TEST_F(StatusTest, TooManyLevels) {
    // V' = V + 2E, E' = 4E: the cube has 8 + 8 (4^L - 1) = 2^(2L + 3) vertices, 2^31 at level 14.
    ShapeDescriptor const descriptor(GetShape("cube"));
    auto const refiner = TopologyRefinerFactory::Create(descriptor.Get());
    ASSERT_TRUE(refiner->RefineUniform(2));
    for (int level : {14, 15, 40, 1000000}) {
        Status status;
        EXPECT_FALSE(refiner->RefineUniform(level, &status));
        expectRefusal(status, {StatusCode::TooLarge,
                               ComponentType::Level,
                               14,
                               {"level 14", "2147483648", "vertices"}});
        EXPECT_EQ(refiner->GetMaxLevel(), 2);
        EXPECT_EQ(refiner->GetUniformOptions().refinementLevel, 2);
        EXPECT_EQ(refiner->GetLevel(2).GetNumVertices(), 128);
        EXPECT_TRUE(refiner->GetLevel(1).Validate());
    }
}

TEST_F(StatusTest, CallbackCanBeTakenBack) {
    Shape const shape = makeShape(3, {{0, 1, 3}});
    ShapeDescriptor const descriptor(shape);
    FarExt::SetErrorCallback(recordError);
    EXPECT_FALSE(TopologyRefinerFactory::Create(descriptor.Get()));
    EXPECT_EQ(numErrors, 1);
    FarExt::SetErrorCallback(nullptr);
    EXPECT_FALSE(TopologyRefinerFactory::Create(descriptor.Get()));
    EXPECT_EQ(numErrors, 1);
}

} // namespace OpenSubdivHex::Regression
