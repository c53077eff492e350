// SPDX-License-Identifier: Apache-2.0
#include "far_ext/stencilTableFactory.h"
#include "far_ext/topologyRefinerFactory.h"
#include "regression/shapes/shapeDescriptor.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>

namespace OpenSubdivHex::Regression {

using FarExt::ComponentType;
using FarExt::HexSchemeOptions;
using FarExt::Status;
using FarExt::StatusCode;
using FarExt::TopologyRefiner;
using FarExt::TopologyRefinerFactory;

namespace {

HexSchemeOptions const kOtherSchemes[] = {
    {FarExt::FaceMask::Average, FarExt::SchemeType::DooSabin, false},
    {FarExt::FaceMask::Average, FarExt::SchemeType::TriHex, false},
    {FarExt::FaceMask::Average, FarExt::SchemeType::Hexagonal, true}};

std::string lastError;
int numErrors = 0;

void recordError(Far::ErrorType, char const *message) {
    lastError = message;
    ++numErrors;
}

Shape makeShape(int numVertices, std::vector<std::vector<int>> const &faces) {
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
Shape makeShape(FarExt::TopologyLevel const &level) {
    std::vector<std::vector<int>> faces;
    for (int f = 0; f < level.GetNumFaces(); ++f) {
        auto const vertices = level.GetFaceVertices(f);
        faces.emplace_back(vertices.begin(), vertices.end());
    }
    return makeShape(level.GetNumVertices(), faces);
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

    /// Every scheme but the hexagonal one refuses the shape.
    void expectRefusedByOtherSchemes(Shape const &shape, Refusal const &expected) {
        auto const base = CreateFarRefiner(shape);
        ASSERT_TRUE(base);
        ShapeDescriptor const descriptor(shape);
        for (HexSchemeOptions const &scheme : kOtherSchemes) {
            TopologyRefinerFactory::Options options;
            options.schemeOptions = scheme;
            Status status;
            EXPECT_FALSE(
                TopologyRefinerFactory::Create(descriptor.Get(), Sdc::Options(), options, &status));
            expectRefusal(status, expected);
            status = Status();
            EXPECT_FALSE(TopologyRefinerFactory::Create(*base, options, &status));
            expectRefusal(status, expected);
        }
        EXPECT_TRUE(TopologyRefinerFactory::Create(*base));
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
    expectRefusal(status,
                  {StatusCode::InvalidArgument, ComponentType::None, -1, {"numVertsPerFace"}});
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

namespace {

constexpr int kMaxValence = 65535; ///< that Far takes

/// \brief Triangles that share vertex 0 alone, with as many edges there as Far takes less
/// \p numFree, and three more vertices.
Shape makePinwheel(int numFree) {
    int const numTriangles = (kMaxValence - numFree) / 2;
    Shape shape = makeShape(1, {});
    for (int f = 0; f < numTriangles; ++f) {
        shape.faceSizes.push_back(3);
        shape.faceVertices.insert(shape.faceVertices.end(), {1 + 2 * f, 2 + 2 * f, 0});
    }
    shape.positions.resize(3 * (2 * numTriangles + 4));
    return shape;
}

Shape addFace(Shape shape, std::vector<int> const &face) {
    shape.faceSizes.push_back(int(face.size()));
    shape.faceVertices.insert(shape.faceVertices.end(), face.begin(), face.end());
    return shape;
}

} // namespace

TEST_F(StatusTest, VertexOfTooManyEdges) {
    Refusal const refusal = {
        StatusCode::TooLarge, ComponentType::Vertex, 0, {"vertex 0", "65536 edges", "65535"}};
    expectDescriptorRefused(addFace(makePinwheel(1), {0, 65535, 65536}), refusal);
    expectDescriptorRefused(makePinwheel(-465),
                            {StatusCode::TooLarge, ComponentType::Vertex, 0, {"66000 edges"}});
    // Of all kinds of edges that Far counts one too many, and as many as it takes.
    int const last = kMaxValence - 5; // of the neighbours
    for (bool const isTooLarge : {true, false}) {
        Shape shape = makePinwheel(5);
        shape = addFace(shape, {0, 0, 1, 2});        // a degenerate edge: two more
        shape = addFace(shape, {0, 1, 2, 0, 1, 3});  // an edge twice: one more
        shape = addFace(shape, {3, 0, last});        // both are known
        shape = addFace(shape, {0, last + 1, last}); // one more
        shape = addFace(shape, {0, last + 2, isTooLarge ? last + 3 : last}); // one or two more
        if (isTooLarge) {
            expectDescriptorRefused(shape, refusal);
        } else {
            ShapeDescriptor const descriptor(shape);
            Status status;
            auto const refiner =
                TopologyRefinerFactory::Create(descriptor.Get(), Sdc::Options(), &status);
            ASSERT_TRUE(refiner) << status.GetMessage();
            EXPECT_TRUE(refiner->RefineUniform(1));
        }
    }
}

TEST_F(StatusTest, VertexOutOfRange) {
    expectDescriptorRefused(
        makeShape(4, {{0, 1, 2}, {2, 1, 4}}),
        {StatusCode::InvalidTopology, ComponentType::Face, 1, {"face 1", "vertex 4", "0 to 3"}});
    expectDescriptorRefused(
        makeShape(4, {{0, 1, 2}, {2, 1, 3}, {0, -7, 1}}),
        {StatusCode::InvalidTopology, ComponentType::Face, 2, {"face 2", "vertex -7"}});
}

TEST_F(StatusTest, InconsistentOrientationIsAWarning) {
    Shape const shape = makeShape(5, {{0, 1, 2}, {1, 2, 3}, {2, 3, 4}});
    auto const base = CreateFarRefiner(shape);
    int const edge = base->GetLevel(0).FindEdge(1, 2);
    ShapeDescriptor const descriptor(shape);
    FarExt::SetErrorCallback(recordError);
    for (bool const isFromBase : {false, true}) {
        Status status;
        EXPECT_TRUE(
            isFromBase ? TopologyRefinerFactory::Create(*base, &status)
                       : TopologyRefinerFactory::Create(descriptor.Get(), Sdc::Options(), &status));
        EXPECT_TRUE(status.IsOk());
        ASSERT_EQ(status.GetWarnings().size(), 1U);
        FarExt::Warning const &warning = status.GetWarnings()[0];
        EXPECT_EQ(warning.code, FarExt::WarningCode::InconsistentOrientation);
        EXPECT_EQ(warning.component, ComponentType::Edge);
        EXPECT_EQ(warning.index, edge);
        EXPECT_EQ(warning.count, 2);
        std::vector<std::string> const words = {"2 edges", "edge " + std::to_string(edge),
                                                "vertices 1 and 2", "faces 0 and 1",
                                                "same direction"};
        for (std::string const &word : words) {
            EXPECT_NE(warning.message.find(word), std::string::npos) << warning.message;
        }
    }
    EXPECT_EQ(numErrors, 0);
    // As other schemes treat any non-manifold edge; what was noticed does not outlive a success.
    expectRefusedByOtherSchemes(shape, {StatusCode::Unsupported,
                                        ComponentType::Edge,
                                        edge,
                                        {"edge " + std::to_string(edge), "non-manifold"}});
    Status status;
    status.AddWarning(
        {FarExt::WarningCode::InconsistentOrientation, ComponentType::Edge, 1, 1, ""});
    EXPECT_TRUE(TopologyRefinerFactory::Create(*CreateFarRefiner(GetShape("cube")), &status));
    EXPECT_TRUE(status.GetWarnings().empty());
}

TEST_F(StatusTest, NullArraysAreNamed) {
    Shape shape = GetShape("cube");
    shape.creaseVertexPairs = {0, 1};
    shape.creaseSharpness = {1};
    shape.cornerVertices = {0};
    shape.cornerSharpness = {1};
    shape.holeFaces = {0};
    shape.fvarChannels.push_back(
        {2, std::vector<double>(16), std::vector<int>(shape.faceVertices)});
    ShapeDescriptor const descriptor(shape);
    using Descriptor = Far::TopologyDescriptor;
    auto const expectNamed = [&](Descriptor const &broken, std::string const &name) {
        Status status;
        EXPECT_FALSE(TopologyRefinerFactory::Create(broken, Sdc::Options(), &status)) << name;
        expectRefusal(status, {StatusCode::InvalidArgument, ComponentType::None, -1, {name}});
    };
    auto const expectNeeded = [&](auto Descriptor::*array, std::string const &name) {
        Descriptor broken = descriptor.Get();
        broken.*array = nullptr;
        expectNamed(broken, name);
    };
    expectNeeded(&Descriptor::numVertsPerFace, "numVertsPerFace");
    expectNeeded(&Descriptor::vertIndicesPerFace, "vertIndicesPerFace");
    expectNeeded(&Descriptor::creaseVertexIndexPairs, "creaseVertexIndexPairs");
    expectNeeded(&Descriptor::creaseWeights, "creaseWeights");
    expectNeeded(&Descriptor::cornerVertexIndices, "cornerVertexIndices");
    expectNeeded(&Descriptor::cornerWeights, "cornerWeights");
    expectNeeded(&Descriptor::holeIndices, "holeIndices");
    expectNeeded(&Descriptor::fvarChannels, "fvarChannels");
    auto const expectCounted = [&](int Descriptor::*count, std::string const &name) {
        Descriptor broken = descriptor.Get();
        broken.*count = -3;
        expectNamed(broken, name);
    };
    expectCounted(&Descriptor::numCreases, "creaseVertexIndexPairs");
    expectCounted(&Descriptor::numCorners, "cornerVertexIndices");
    expectCounted(&Descriptor::numHoles, "holeIndices");
    expectCounted(&Descriptor::numFVarChannels, "fvarChannels");
    Descriptor::FVarChannel channel;
    channel.numValues = 8;
    Descriptor broken = descriptor.Get();
    broken.fvarChannels = &channel;
    expectNamed(broken, "channel 0 has no array valueIndices");
    channel.valueIndices = shape.faceVertices.data();
    channel.numValues = -1;
    expectNamed(broken, "channel 0 has -1 values");
    // Without a count no array is needed.
    broken = descriptor.Get();
    broken.numCreases = broken.numCorners = broken.numHoles = broken.numFVarChannels = 0;
    broken.creaseVertexIndexPairs = broken.cornerVertexIndices = broken.holeIndices = nullptr;
    broken.creaseWeights = broken.cornerWeights = nullptr;
    broken.fvarChannels = nullptr;
    EXPECT_TRUE(TopologyRefinerFactory::Create(broken));
}

TEST_F(StatusTest, SharpnessMustBeANumber) {
    for (float sharpness : {-1.0f, -0.001f, std::nanf("")}) {
        Shape shape = GetShape("cube");
        shape.creaseVertexPairs = {shape.faceVertices[1], shape.faceVertices[2]};
        shape.creaseSharpness = {sharpness};
        expectDescriptorRefused(shape, {StatusCode::InvalidTopology,
                                        ComponentType::Vertex,
                                        shape.faceVertices[1],
                                        {"crease 0", "sharpness"}});
        shape.creaseSharpness = {1};
        shape.cornerVertices = {3};
        shape.cornerSharpness = {sharpness};
        expectDescriptorRefused(shape, {StatusCode::InvalidTopology,
                                        ComponentType::Vertex,
                                        3,
                                        {"corner 0", "vertex 3", "sharpness"}});
        // A base that has it already.
        shape.cornerSharpness = {1};
        auto const base = CreateFarRefiner(shape);
        auto &level = const_cast<OpenSubdiv::Vtr::internal::Level &>(base->getLevel(0));
        level.getVertexSharpness(3) = sharpness;
        Status status;
        EXPECT_FALSE(TopologyRefinerFactory::Create(*base, &status));
        expectRefusal(status,
                      {StatusCode::InvalidTopology, ComponentType::Vertex, 3, {"vertex 3"}});
        level.getVertexSharpness(3) = 0;
        level.getEdgeSharpness(5) = sharpness;
        EXPECT_FALSE(TopologyRefinerFactory::Create(*base, &status));
        expectRefusal(status, {StatusCode::InvalidTopology, ComponentType::Edge, 5, {"edge 5"}});
    }
}

TEST_F(StatusTest, OptionsOutsideOfTheirEnumerationsAreNamed) {
    Shape const &shape = GetShape("cube");
    ShapeDescriptor const descriptor(shape);
    auto const expectNamed = [&](HexSchemeOptions scheme, Sdc::Options sdcOptions,
                                 std::string const &name) {
        TopologyRefinerFactory::Options options;
        options.schemeOptions = scheme;
        Status status;
        EXPECT_FALSE(
            TopologyRefinerFactory::Create(descriptor.Get(), sdcOptions, options, &status));
        expectRefusal(status, {StatusCode::InvalidArgument, ComponentType::None, -1, {name, "9"}});
    };
    HexSchemeOptions scheme;
    scheme.schemeType = FarExt::SchemeType(9);
    expectNamed(scheme, Sdc::Options(), "schemeType");
    Status status;
    EXPECT_FALSE(TopologyRefinerFactory::Create(*CreateFarRefiner(shape), {scheme}, &status));
    expectRefusal(status, {StatusCode::InvalidArgument, ComponentType::None, -1, {"schemeType"}});
    scheme = HexSchemeOptions();
    scheme.faceMask = FarExt::FaceMask(9);
    expectNamed(scheme, Sdc::Options(), "faceMask");
    Sdc::Options sdcOptions;
    std::memset(static_cast<void *>(&sdcOptions), 9, sizeof sdcOptions);
    expectNamed(HexSchemeOptions(), sdcOptions, "VtxBoundaryInterpolation");
    sdcOptions.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_NONE);
    expectNamed(HexSchemeOptions(), sdcOptions, "FVarLinearInterpolation");
    sdcOptions.SetFVarLinearInterpolation(Sdc::Options::FVAR_LINEAR_NONE);
    expectNamed(HexSchemeOptions(), sdcOptions, "CreasingMethod");

    auto const refiner = TopologyRefinerFactory::Create(descriptor.Get());
    refiner->RefineUniform(1);
    FarExt::StencilTableFactory::Options options;
    for (int mode : {77, 3, -1}) {
        StatusTest::Refusal const refusal = {StatusCode::InvalidArgument,
                                             ComponentType::None,
                                             -1,
                                             {"interpolationMode " + std::to_string(mode)}};
        options.interpolationMode = FarExt::StencilMode(mode);
        EXPECT_FALSE(FarExt::StencilTableFactory::Create(*refiner, options, &status));
        expectRefusal(status, refusal);
        EXPECT_FALSE(FarExt::StencilTableFactory::CreateOfFaces(*refiner, {}, options, &status));
        expectRefusal(status, refusal);
        EXPECT_EQ(FarExt::StencilTableFactory::EstimateSize(*refiner, options, &status).numStencils,
                  0);
        expectRefusal(status, refusal);
        FarExt::StencilTableFactory::GetVerticesOfFaces(*refiner, {}, options, 0, &status);
        expectRefusal(status, refusal);
    }
}

TEST_F(StatusTest, EveryShapeAndBoundaryRuleIsTaken) {
    for (Shape const &shape : GetShapes()) {
        for (auto rule : {Sdc::Options::VTX_BOUNDARY_NONE, Sdc::Options::VTX_BOUNDARY_EDGE_ONLY,
                          Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER}) {
            Sdc::Options options;
            options.SetVtxBoundaryInterpolation(rule);
            ShapeDescriptor const descriptor(shape);
            Status status;
            auto const refiner = TopologyRefinerFactory::Create(descriptor.Get(), options, &status);
            ASSERT_TRUE(refiner) << shape.name << ": " << status.GetMessage();
            EXPECT_TRUE(status.IsOk());
            EXPECT_EQ(refiner->GetSchemeOptions().GetVtxBoundaryInterpolation(), rule);
        }
    }
}

TEST_F(StatusTest, CreaseThatIsNoEdge) {
    Shape shape = makeShape(5, {{0, 1, 2, 3}, {3, 2, 4}});
    shape.creaseVertexPairs = {2, 3, 0, 2};
    shape.creaseSharpness = {2.5f, 10};
    expectDescriptorRefused(
        shape,
        {StatusCode::InvalidTopology, ComponentType::Vertex, 0, {"crease", "vertices 0 and 2"}});
    shape.creaseVertexPairs = {2, 3, 4, 4};
    expectDescriptorRefused(
        shape,
        {StatusCode::InvalidTopology, ComponentType::Vertex, 4, {"crease", "vertices 4 and 4"}});
}

TEST_F(StatusTest, CreaseOutOfRange) {
    Shape shape = makeShape(5, {{0, 1, 2, 3}, {3, 2, 4}});
    for (int vertex : {-1, 5}) {
        for (std::vector<int> const &pair : {std::vector<int>{2, vertex}, {vertex, 2}}) {
            shape.creaseVertexPairs = {2, 3, pair[0], pair[1]};
            shape.creaseSharpness = {2.5f, 10};
            expectDescriptorRefused(
                shape, {StatusCode::InvalidTopology,
                        ComponentType::Vertex,
                        vertex,
                        {"crease 1", "refers to " + std::to_string(vertex), "0 to 4"}});
        }
    }
}

TEST_F(StatusTest, CornerOutOfRange) {
    Shape shape = makeShape(4, {{0, 1, 2, 3}});
    for (int vertex : {-2, 4}) {
        shape.cornerVertices = {0, vertex};
        shape.cornerSharpness = {1, 2};
        expectDescriptorRefused(shape,
                                {StatusCode::InvalidTopology,
                                 ComponentType::Vertex,
                                 vertex,
                                 {"corner 1", "refers to " + std::to_string(vertex), "0 to 3"}});
    }
}

TEST_F(StatusTest, HoleOutOfRange) {
    Shape shape = makeShape(5, {{0, 1, 2, 3}, {3, 2, 4}});
    for (int face : {-1, 2}) {
        shape.holeFaces = {0, face};
        expectDescriptorRefused(shape, {StatusCode::InvalidTopology,
                                        ComponentType::Face,
                                        face,
                                        {"hole 1", "refers to " + std::to_string(face), "0 to 1"}});
    }
}

TEST_F(StatusTest, FaceVaryingValueOutOfRange) {
    Shape shape = makeShape(5, {{0, 1, 2, 3}, {3, 2, 4}});
    shape.fvarChannels.resize(2);
    for (FVarChannel &channel : shape.fvarChannels) {
        channel.values.resize(2 * 7);
        channel.valueIndices = {0, 1, 2, 3, 4, 5, 6};
    }
    for (int value : {-1, 7}) {
        shape.fvarChannels[1].valueIndices[4] = value;
        expectDescriptorRefused(
            shape, {StatusCode::InvalidTopology,
                    ComponentType::None,
                    value,
                    {"corner 4", "channel 1", "refers to " + std::to_string(value), "0 to 6"}});
    }
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

TEST_F(StatusTest, OtherSchemesRefuseFeatures) {
    Shape const plain = makeShape(7, {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 1}});
    auto const findEdge = [](Shape const &shape, int v, int w) {
        return CreateFarRefiner(shape)->GetLevel(0).FindEdge(v, w);
    };
    Shape creased = plain;
    creased.creaseVertexPairs = {0, 3};
    creased.creaseSharpness = {0.5f};
    int const crease = findEdge(creased, 0, 3);
    expectRefusedByOtherSchemes(creased,
                                {StatusCode::Unsupported,
                                 ComponentType::Edge,
                                 crease,
                                 {"edge " + std::to_string(crease), "crease", "hexagonal"}});
    Shape corner = plain;
    corner.cornerVertices = {0};
    corner.cornerSharpness = {1.5f};
    expectRefusedByOtherSchemes(
        corner, {StatusCode::Unsupported, ComponentType::Vertex, 0, {"vertex 0", "corner"}});
    Shape textured = plain;
    textured.fvarChannels.resize(1);
    textured.fvarChannels[0].values.resize(2 * 12);
    textured.fvarChannels[0].valueIndices.resize(12);
    expectRefusedByOtherSchemes(
        textured, {StatusCode::Unsupported, ComponentType::None, -1, {"face-varying"}});
    Shape const fin = makeShape(5, {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}});
    int const edge = findEdge(fin, 0, 1);
    expectRefusedByOtherSchemes(fin, {StatusCode::Unsupported,
                                      ComponentType::Edge,
                                      edge,
                                      {"edge " + std::to_string(edge), "non-manifold"}});
}

TEST_F(StatusTest, OtherSchemesTakeSharpBorders) {
    // Corners at the border are dropped with it.
    Shape shape = makeShape(4, {{0, 1, 2, 3}});
    shape.cornerVertices = {1};
    shape.cornerSharpness = {10};
    Sdc::Options sdcOptions;
    sdcOptions.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER);
    ShapeDescriptor const descriptor(shape);
    for (HexSchemeOptions const &scheme : kOtherSchemes) {
        TopologyRefinerFactory::Options options;
        options.schemeOptions = scheme;
        Status status;
        auto const refiner =
            TopologyRefinerFactory::Create(descriptor.Get(), sdcOptions, options, &status);
        ASSERT_TRUE(refiner) << status.GetMessage();
        EXPECT_EQ(refiner->GetHexSchemeOptions().schemeType, scheme.schemeType);
        EXPECT_EQ(refiner->GetHexSchemeOptions().triHexFirst, scheme.triHexFirst);
        EXPECT_TRUE(refiner->RefineUniform(2));
    }
}

TEST_F(StatusTest, CoplanarArguments) {
    Shape const &cube = GetShape("cube");
    ShapeDescriptor const descriptor(cube);
    auto const refiner = TopologyRefinerFactory::Create(descriptor.Get());
    ASSERT_TRUE(refiner->RefineUniform(2));
    auto const expectCoplanarRefused = [&](double const *positions,
                                           TopologyRefiner::CoplanarOptions options,
                                           Refusal const &expected) {
        Status status;
        EXPECT_FALSE(refiner->RefineCoplanar(positions, options, &status));
        expectRefusal(status, expected);
        // The levels are as before.
        EXPECT_EQ(refiner->GetMaxLevel(), 2);
        EXPECT_TRUE(refiner->IsUniform());
        EXPECT_EQ(refiner->GetLevel(2).GetNumVertices(), 128);
        EXPECT_TRUE(refiner->GetLevel(1).Validate());
    };
    TopologyRefiner::CoplanarOptions const good(1);
    expectCoplanarRefused(cube.positions.data(), TopologyRefiner::CoplanarOptions(-2),
                          {StatusCode::InvalidArgument, ComponentType::Level, -2, {"-2"}});
    expectCoplanarRefused(nullptr, good,
                          {StatusCode::InvalidArgument, ComponentType::None, -1, {"null"}});
    for (double tolerance : {-0.5, 180.5, std::nan(""), double(INFINITY)}) {
        TopologyRefiner::CoplanarOptions options(1);
        options.angleTolerance = tolerance;
        expectCoplanarRefused(
            cube.positions.data(), options,
            {StatusCode::InvalidArgument, ComponentType::None, -1, {"angle", "180"}});
    }
    for (double coordinate : {std::nan(""), double(INFINITY), -double(INFINITY), 1e300}) {
        for (int axis = 0; axis < 3; ++axis) {
            std::vector<double> positions = cube.positions;
            positions[3 * 5 + axis] = coordinate;
            expectCoplanarRefused(
                positions.data(), good,
                {StatusCode::InvalidArgument, ComponentType::Vertex, 5, {"vertex 5", "finite"}});
        }
    }
    std::vector<float> positions(cube.positions.begin(), cube.positions.end());
    positions[23] = NAN;
    Status status;
    EXPECT_FALSE(refiner->RefineCoplanar(positions.data(), good, &status));
    expectRefusal(status, {StatusCode::InvalidArgument, ComponentType::Vertex, 7, {"vertex 7"}});
    EXPECT_TRUE(refiner->RefineCoplanar(cube.positions.data(), good, &status));
    EXPECT_TRUE(status.IsOk());
    EXPECT_FALSE(refiner->IsUniform());
    EXPECT_TRUE(refiner->RefineCoplanar(cube.positions.data(), 0));
    EXPECT_EQ(refiner->GetMaxLevel(), 0);
}

TEST_F(StatusTest, OtherSchemesRefuseCoplanarRefinement) {
    Shape const &cube = GetShape("cube");
    ShapeDescriptor const descriptor(cube);
    for (HexSchemeOptions const &scheme : kOtherSchemes) {
        TopologyRefinerFactory::Options options;
        options.schemeOptions = scheme;
        auto const refiner =
            TopologyRefinerFactory::Create(descriptor.Get(), Sdc::Options(), options);
        ASSERT_TRUE(refiner && refiner->RefineUniform(1));
        Status status;
        EXPECT_FALSE(refiner->RefineCoplanar(cube.positions.data(), 1, &status));
        expectRefusal(
            status, {StatusCode::Unsupported, ComponentType::None, -1, {"coplanar", "hexagonal"}});
        EXPECT_EQ(refiner->GetMaxLevel(), 1);
        EXPECT_FALSE(refiner->RefineUniform(-1, &status));
        expectRefusal(status, {StatusCode::InvalidArgument, ComponentType::Level, -1, {"-1"}});
        EXPECT_EQ(refiner->GetMaxLevel(), 1);
    }
}

TEST_F(StatusTest, TooManyLevelsOfOtherSchemes) {
    // Edges of the cube: 12 4^L with Doo-Sabin; a tri-hex step first makes 36 of 12.  With tri-hex
    // it has 24 3^L face-vertices.
    struct Case {
        HexSchemeOptions scheme;
        int level;
        std::string count;
    };
    Case const cases[] = {{kOtherSchemes[0], 14, "3221225472 edges"},
                          {kOtherSchemes[1], 17, "3099363912 face-vertices"},
                          {kOtherSchemes[2], 14, "2415919104 edges"}};
    Shape const &cube = GetShape("cube");
    ShapeDescriptor const descriptor(cube);
    for (Case const &expected : cases) {
        TopologyRefinerFactory::Options options;
        options.schemeOptions = expected.scheme;
        auto const refiner =
            TopologyRefinerFactory::Create(descriptor.Get(), Sdc::Options(), options);
        ASSERT_TRUE(refiner->RefineUniform(2));
        int const numVertices = refiner->GetLevel(2).GetNumVertices();
        for (int level : {expected.level, 1000000}) {
            Status status;
            EXPECT_FALSE(refiner->RefineUniform(level, &status));
            expectRefusal(status, {StatusCode::TooLarge,
                                   ComponentType::Level,
                                   expected.level,
                                   {"level " + std::to_string(expected.level), expected.count}});
            EXPECT_EQ(refiner->GetMaxLevel(), 2);
            EXPECT_EQ(refiner->GetLevel(2).GetNumVertices(), numVertices);
        }
    }
}

TEST_F(StatusTest, LevelsThatDoNotGrowHaveALast) {
    // A face that shares no edge makes one such face in each level.
    ShapeDescriptor const descriptor(GetShape("polygon3"));
    for (FarExt::SchemeType scheme : {FarExt::SchemeType::DooSabin, FarExt::SchemeType::TriHex}) {
        TopologyRefinerFactory::Options options;
        options.schemeOptions.schemeType = scheme;
        auto const refiner =
            TopologyRefinerFactory::Create(descriptor.Get(), Sdc::Options(), options);
        for (int level : {TopologyRefiner::kLastLevel + 1, std::numeric_limits<int>::max()}) {
            Status status;
            EXPECT_FALSE(refiner->RefineUniform(level, &status));
            expectRefusal(status, {StatusCode::TooLarge,
                                   ComponentType::Level,
                                   level,
                                   {"level " + std::to_string(level), "level 100"}});
        }
        ASSERT_TRUE(refiner->RefineUniform(TopologyRefiner::kLastLevel));
        EXPECT_EQ(refiner->GetLevel(TopologyRefiner::kLastLevel).GetNumFaces(), 1);
    }
}

TEST_F(StatusTest, TooManyCoplanarLevels) {
    // Refused before anything is made, by sizes that the shape has in any pose: what is made of it
    // cannot be refined further.
    auto const create = [](Shape const &shape, Sdc::Options sdcOptions) {
        ShapeDescriptor const descriptor(shape);
        return TopologyRefinerFactory::Create(descriptor.Get(), sdcOptions);
    };
    auto const findRefusedLevel = [&](Shape const &shape, Sdc::Options sdcOptions, bool closeGaps) {
        auto const refiner = create(shape, sdcOptions);
        EXPECT_TRUE(refiner->RefineUniform(1));
        TopologyRefiner::CoplanarOptions options(1000000);
        options.closeGaps = closeGaps;
        Status status;
        EXPECT_FALSE(refiner->RefineCoplanar(shape.positions.data(), options, &status));
        int const level = status.GetComponentIndex();
        expectRefusal(status, {StatusCode::TooLarge, ComponentType::Level, level, {"or more"}});
        EXPECT_EQ(refiner->GetMaxLevel(), 1);
        return level;
    };
    for (char const *name :
         {"cube", "quadGrid", "mixedPatch", "closedAndOpen", "dihedron5", "prism5"}) {
        Shape const &shape = GetShape(name);
        for (bool closeGaps : {true, false}) {
            SCOPED_TRACE(std::string(name) + (closeGaps ? ", closed" : ", open"));
            Sdc::Options sdcOptions;
            sdcOptions.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_NONE);
            int const refusedLevel = findRefusedLevel(shape, sdcOptions, closeGaps);
            for (double tolerance : {0.0, 60.0, 180.0}) {
                for (int level : {1, 2}) {
                    TopologyRefiner::CoplanarOptions options(level);
                    options.angleTolerance = tolerance;
                    options.closeGaps = closeGaps;
                    auto const refiner = create(shape, sdcOptions);
                    ASSERT_TRUE(refiner->RefineCoplanar(shape.positions.data(), options));
                    Shape const other = makeShape(refiner->GetLevel(level));
                    EXPECT_LE(findRefusedLevel(other, sdcOptions, closeGaps), refusedLevel - level)
                        << tolerance << " degrees, level " << level;
                }
            }
        }
        // Without flat edges the sizes are those of the hexagonal step, but for vertices.
        for (auto boundary :
             {Sdc::Options::VTX_BOUNDARY_NONE, Sdc::Options::VTX_BOUNDARY_EDGE_ONLY}) {
            Sdc::Options sdcOptions;
            sdcOptions.SetVtxBoundaryInterpolation(boundary);
            Status status;
            EXPECT_FALSE(create(shape, sdcOptions)->RefineUniform(1000000, &status));
            bool const hasDigons = std::string(name) == "dihedron5";
            EXPECT_TRUE(hasDigons ||
                        findRefusedLevel(shape, sdcOptions, true) == status.GetComponentIndex());
        }
    }
}

TEST_F(StatusTest, TooManyLevelsSeenFromAnyLevel) {
    // The refusals of a mesh and of its own refinement as a base name the same sizes, so that these
    // are right however many levels lie between.
    auto const create = [](Shape const &shape, HexSchemeOptions const &scheme) {
        TopologyRefinerFactory::Options options;
        options.schemeOptions = scheme;
        ShapeDescriptor const descriptor(shape);
        return TopologyRefinerFactory::Create(descriptor.Get(), Sdc::Options(), options);
    };
    auto const refuse = [](TopologyRefiner &refiner) {
        Status status;
        EXPECT_FALSE(refiner.RefineUniform(100, &status));
        EXPECT_EQ(status.GetCode(), StatusCode::TooLarge);
        return status;
    };
    // All that are chosen have too many face-vertices, those of the levels before included.
    std::string const kCount = "face-vertices together with the levels before";
    auto const readCount = [](Status const &status) {
        std::string const before = "would have ";
        std::size_t const place = status.GetMessage().find(before) + before.size();
        return std::stoll(status.GetMessage().substr(place));
    };
    HexSchemeOptions const dooSabin = kOtherSchemes[0];
    HexSchemeOptions const triHex = kOtherSchemes[1];
    struct Case {
        char const *name;
        HexSchemeOptions scheme;
    };
    for (Case const &test :
         {Case{"mixedPatch", dooSabin}, Case{"quadGrid", dooSabin}, Case{"closedAndOpen", dooSabin},
          Case{"dihedron5", dooSabin}, Case{"prism5", dooSabin}, Case{"tetrahedron", triHex}}) {
        SCOPED_TRACE(test.name);
        auto const refiner = create(GetShape(test.name), test.scheme);
        Status const expected = refuse(*refiner);
        int const lastLevel = expected.GetComponentIndex();
        ASSERT_NE(expected.GetMessage().find(kCount), std::string::npos) << expected.GetMessage();
        std::int64_t count = readCount(expected);
        for (int level : {1, 2, 3}) {
            ASSERT_TRUE(refiner->RefineUniform(level));
            auto const other = create(makeShape(refiner->GetLevel(level)), test.scheme);
            ASSERT_TRUE(other);
            Status const actual = refuse(*other);
            EXPECT_EQ(actual.GetComponentIndex(), lastLevel - level);
            count -= refiner->GetLevel(level - 1).GetNumFaceVertices();
            EXPECT_EQ(readCount(actual), count);
        }
    }
    // With borders the sizes are known after the tri-hex step.
    EXPECT_NE(refuse(*create(GetShape("mixedPatch"), kOtherSchemes[2])).GetMessage(), "");
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
