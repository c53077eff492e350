// SPDX-License-Identifier: Apache-2.0
//
// Meshes and arguments that the factories refuse, and what they say.
#include "statusFixture.h"

#include "far_ext/stencilTableFactory.h"

#include <cmath>
#include <cstring>
#include <limits>

namespace OpenSubdivHex::Regression::statusTest {

using FarExt::CallStatus;
using FarExt::ComponentType;
using FarExt::HexSchemeOptions;
using FarExt::StatusCode;
using FarExt::TopologyRefinerFactory;

TEST_F(StatusTest, DefaultIsOk) {
    CallStatus const status;
    EXPECT_TRUE(status.IsOk());
    EXPECT_EQ(status.GetCode(), StatusCode::Ok);
    EXPECT_EQ(status.GetComponentType(), ComponentType::NoComponent);
    EXPECT_EQ(status.GetComponentIndex(), Far::INDEX_INVALID);
    EXPECT_EQ(status.GetErrorMessage(), "");
}

TEST_F(StatusTest, SuccessOverwritesAFailure) {
    CallStatus status(StatusCode::Unsupported, ComponentType::Face, 3, "old");
    ShapeDescriptor const descriptor(GetShape("cube"));
    auto const refiner = TopologyRefinerFactory::Create(descriptor.Get(), Sdc::Options(), &status);
    ASSERT_TRUE(refiner);
    EXPECT_TRUE(status.IsOk());
    EXPECT_EQ(status.GetErrorMessage(), "");
    status = CallStatus(StatusCode::Unsupported, ComponentType::Face, 3, "old");
    EXPECT_TRUE(refiner->RefineUniform(1, &status));
    EXPECT_TRUE(status.IsOk());
}

TEST_F(StatusTest, EmptyMesh) {
    expectDescriptorRefused(
        Shape(),
        {StatusCode::InvalidTopology, ComponentType::NoComponent, -1, {"empty", "0 faces"}});
    expectDescriptorRefused(
        MakeShape(3, {}),
        {StatusCode::InvalidTopology, ComponentType::NoComponent, -1, {"empty", "0 faces"}});
}

TEST_F(StatusTest, NoArrays) {
    CallStatus status;
    Far::TopologyDescriptor descriptor;
    descriptor.numVertices = 3;
    descriptor.numFaces = 1;
    EXPECT_FALSE(TopologyRefinerFactory::Create(descriptor, Sdc::Options(), &status));
    expectRefusal(
        status, {StatusCode::InvalidArgument, ComponentType::NoComponent, -1, {"numVertsPerFace"}});
}

TEST_F(StatusTest, FaceTooSmall) {
    expectDescriptorRefused(
        MakeShape(5, {{0, 1, 2}, {2, 1}, {2, 1, 3}}),
        {StatusCode::InvalidTopology, ComponentType::Face, 1, {"face 1", "2 vertices"}});
    expectDescriptorRefused(
        MakeShape(5, {{0, 1, 2}, {2, 1, 3}, {}}),
        {StatusCode::InvalidTopology, ComponentType::Face, 2, {"face 2", "0 vertices"}});
    Shape negative = MakeShape(3, {{0, 1, 2}});
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
    Shape shape = MakeShape(1, {});
    int const numFaces = 66000;
    shape.positions.resize(3 * (2 * numFaces + 1));
    for (int f = 0; f < numFaces; ++f) {
        shape.faceSizes.push_back(3);
        shape.faceVertices.insert(shape.faceVertices.end(), {0, 1 + f, 2 + f});
    }
    expectDescriptorRefused(
        shape, {StatusCode::TooLarge, ComponentType::Vertex, 0, {"vertex 0", "faces"}});
}

// Far has a limit to the edges of a vertex, which is none here: a fan of its own for each face has
// twice as many edges as faces.
TEST_F(StatusTest, VertexOfManyEdges) {
    int const numTriangles = 40000;
    Shape shape = MakeShape(1, {});
    for (int f = 0; f < numTriangles; ++f) {
        shape.faceSizes.push_back(3);
        shape.faceVertices.insert(shape.faceVertices.end(), {1 + 2 * f, 2 + 2 * f, 0});
    }
    shape.positions.resize(3 * (2 * std::size_t(numTriangles) + 1));
    ShapeDescriptor const descriptor(shape);
    CallStatus status;
    auto const refiner = TopologyRefinerFactory::Create(descriptor.Get(), Sdc::Options(), &status);
    ASSERT_TRUE(refiner) << status.GetErrorMessage();
    EXPECT_EQ(refiner->GetLevel(0).GetVertexEdges(0).size(), 2 * numTriangles);
    ASSERT_TRUE(refiner->RefineUniform(1));
    EXPECT_TRUE(refiner->GetLevel(1).Validate(&status)) << status.GetErrorMessage();
}

TEST_F(StatusTest, VertexOutOfRange) {
    expectDescriptorRefused(
        MakeShape(4, {{0, 1, 2}, {2, 1, 4}}),
        {StatusCode::InvalidTopology, ComponentType::Face, 1, {"face 1", "vertex 4", "0 to 3"}});
    expectDescriptorRefused(
        MakeShape(4, {{0, 1, 2}, {2, 1, 3}, {0, -7, 1}}),
        {StatusCode::InvalidTopology, ComponentType::Face, 2, {"face 2", "vertex -7"}});
}

TEST_F(StatusTest, InconsistentOrientationIsAWarning) {
    Shape const shape = MakeShape(5, {{0, 1, 2}, {1, 2, 3}, {2, 3, 4}});
    auto const base = CreateFarRefiner(shape);
    int const edge = base->GetLevel(0).FindEdge(1, 2);
    ShapeDescriptor const descriptor(shape);
    FarExt::SetErrorCallback(RecordError);
    for (bool const isFromBase : {false, true}) {
        CallStatus status;
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
    CallStatus status;
    status.AddWarning(
        {FarExt::WarningCode::InconsistentOrientation, ComponentType::Edge, 1, 1, ""});
    EXPECT_TRUE(TopologyRefinerFactory::Create(*CreateFarRefiner(GetShape("cube")), &status));
    EXPECT_TRUE(status.GetWarnings().empty());
}

TEST_F(StatusTest, NonManifoldEdgesAreAWarning) {
    // Three faces at the edge of vertices 1 and 2, four at that of 5 and 6, and an edge between 9 and 10
    // that two faces run in the same direction.
    Shape const shape = MakeShape(13, {{0, 1, 2},
                                       {2, 1, 3},
                                       {2, 1, 4},
                                       {5, 6, 7},
                                       {6, 5, 8},
                                       {6, 5, 0},
                                       {5, 6, 3},
                                       {9, 10, 11},
                                       {9, 10, 12}});
    auto const base = CreateFarRefiner(shape);
    int const edge = std::min(base->GetLevel(0).FindEdge(1, 2), base->GetLevel(0).FindEdge(5, 6));
    ShapeDescriptor const descriptor(shape);
    for (bool const isFromBase : {false, true}) {
        CallStatus status;
        EXPECT_TRUE(
            isFromBase ? TopologyRefinerFactory::Create(*base, &status)
                       : TopologyRefinerFactory::Create(descriptor.Get(), Sdc::Options(), &status));
        EXPECT_TRUE(status.IsOk());
        ASSERT_EQ(status.GetWarnings().size(), 2U);
        FarExt::Warning const &warning = status.GetWarnings()[0];
        EXPECT_EQ(warning.code, FarExt::WarningCode::NonManifoldEdges);
        EXPECT_EQ(warning.component, ComponentType::Edge);
        EXPECT_EQ(warning.index, edge);
        EXPECT_EQ(warning.count, 2);
        EXPECT_EQ(warning.message, "2 non-manifold edges come apart, first edge " +
                                       std::to_string(edge) + " between vertices 1 and 2");
        EXPECT_EQ(status.GetWarnings()[1].code, FarExt::WarningCode::InconsistentOrientation);
        EXPECT_EQ(status.GetWarnings()[1].count, 1);
    }
}

// Fans of faces around a value get values of their own, of which there may be as many as corners.
TEST_F(StatusTest, ChannelTooLarge) {
    Shape const &shape = GetShape("cube");
    ShapeDescriptor const descriptor(shape);
    Far::TopologyDescriptor::FVarChannel channel;
    channel.numValues = std::numeric_limits<int>::max();
    channel.valueIndices = shape.faceVertices.data();
    Far::TopologyDescriptor large = descriptor.Get();
    large.numFVarChannels = 1;
    large.fvarChannels = &channel;
    CallStatus status;
    EXPECT_FALSE(TopologyRefinerFactory::Create(large, Sdc::Options(), &status));
    expectRefusal(status, {StatusCode::TooLarge,
                           ComponentType::Level,
                           0,
                           {"2147483671 values and face-vertices in face-varying channel 0"}});
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
        CallStatus status;
        EXPECT_FALSE(TopologyRefinerFactory::Create(broken, Sdc::Options(), &status)) << name;
        expectRefusal(status,
                      {StatusCode::InvalidArgument, ComponentType::NoComponent, -1, {name}});
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
        CallStatus status;
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
        options.hexSchemeOptions = scheme;
        CallStatus status;
        EXPECT_FALSE(
            TopologyRefinerFactory::Create(descriptor.Get(), sdcOptions, options, &status));
        expectRefusal(status,
                      {StatusCode::InvalidArgument, ComponentType::NoComponent, -1, {name, "9"}});
    };
    HexSchemeOptions scheme;
    scheme.schemeType = FarExt::SchemeType(9);
    expectNamed(scheme, Sdc::Options(), "schemeType");
    CallStatus status;
    EXPECT_FALSE(TopologyRefinerFactory::Create(*CreateFarRefiner(shape), {scheme}, &status));
    expectRefusal(status,
                  {StatusCode::InvalidArgument, ComponentType::NoComponent, -1, {"schemeType"}});
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
                                             ComponentType::NoComponent,
                                             -1,
                                             {"interpolationMode " + std::to_string(mode)}};
        options.interpolationMode = FarExt::StencilMode(mode);
        EXPECT_FALSE(FarExt::StencilTableFactory::Create(*refiner, options, &status));
        expectRefusal(status, refusal);
        EXPECT_FALSE(FarExt::StencilTableFactory::CreateOfFaces(*refiner, {}, options, &status));
        expectRefusal(status, refusal);
        EXPECT_EQ(FarExt::StencilTableFactory::GetSize(*refiner, options, &status).numStencils, 0);
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
            CallStatus status;
            auto const refiner = TopologyRefinerFactory::Create(descriptor.Get(), options, &status);
            ASSERT_TRUE(refiner) << shape.name << ": " << status.GetErrorMessage();
            EXPECT_TRUE(status.IsOk());
            EXPECT_EQ(refiner->GetSchemeOptions().GetVtxBoundaryInterpolation(), rule);
        }
    }
}

TEST_F(StatusTest, CreaseThatIsNoEdge) {
    Shape shape = MakeShape(5, {{0, 1, 2, 3}, {3, 2, 4}});
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
    Shape shape = MakeShape(5, {{0, 1, 2, 3}, {3, 2, 4}});
    for (int vertex : {-1, 5}) {
        for (std::vector<int> const &pair : {std::vector<int>{2, vertex}, {vertex, 2}}) {
            shape.creaseVertexPairs = {2, 3, pair[0], pair[1]};
            shape.creaseSharpness = {2.5f, 10};
            expectDescriptorRefused(
                shape, {StatusCode::InvalidTopology,
                        ComponentType::Vertex,
                        vertex,
                        {"crease 1", "refers to vertex " + std::to_string(vertex), "0 to 4"}});
        }
    }
}

TEST_F(StatusTest, CornerOutOfRange) {
    Shape shape = MakeShape(4, {{0, 1, 2, 3}});
    for (int vertex : {-2, 4}) {
        shape.cornerVertices = {0, vertex};
        shape.cornerSharpness = {1, 2};
        expectDescriptorRefused(
            shape, {StatusCode::InvalidTopology,
                    ComponentType::Vertex,
                    vertex,
                    {"corner 1", "refers to vertex " + std::to_string(vertex), "0 to 3"}});
    }
}

TEST_F(StatusTest, HoleOutOfRange) {
    Shape shape = MakeShape(5, {{0, 1, 2, 3}, {3, 2, 4}});
    for (int face : {-1, 2}) {
        shape.holeFaces = {0, face};
        expectDescriptorRefused(shape,
                                {StatusCode::InvalidTopology,
                                 ComponentType::Face,
                                 face,
                                 {"hole 1", "refers to face " + std::to_string(face), "0 to 1"}});
    }
}

TEST_F(StatusTest, FaceVaryingValueOutOfRange) {
    Shape shape = MakeShape(5, {{0, 1, 2, 3}, {3, 2, 4}});
    shape.fvarChannels.resize(2);
    for (FVarChannel &channel : shape.fvarChannels) {
        channel.values.resize(2 * 7);
        channel.valueIndices = {0, 1, 2, 3, 4, 5, 6};
    }
    for (int value : {-1, 7}) {
        shape.fvarChannels[1].valueIndices[4] = value;
        expectDescriptorRefused(shape, {StatusCode::InvalidTopology,
                                        ComponentType::NoComponent,
                                        value,
                                        {"corner 4", "channel 1",
                                         "refers to value " + std::to_string(value), "0 to 6"}});
    }
}

TEST_F(StatusTest, CallbackCanBeTakenBack) {
    Shape const shape = MakeShape(3, {{0, 1, 3}});
    ShapeDescriptor const descriptor(shape);
    FarExt::SetErrorCallback(RecordError);
    EXPECT_FALSE(TopologyRefinerFactory::Create(descriptor.Get()));
    EXPECT_EQ(numErrors, 1);
    FarExt::SetErrorCallback(nullptr);
    EXPECT_FALSE(TopologyRefinerFactory::Create(descriptor.Get()));
    EXPECT_EQ(numErrors, 1);
}

} // namespace OpenSubdivHex::Regression::statusTest
