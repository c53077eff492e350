// SPDX-License-Identifier: Apache-2.0
//
// Refinements that are refused, and what they say.
#include "statusFixture.h"

#include <cmath>
#include <cstdint>
#include <limits>

namespace OpenSubdivHex::Regression::refinementStatusTest {

using FarExt::CallStatus;
using FarExt::ComponentType;
using FarExt::HexSchemeOptions;
using FarExt::StatusCode;
using FarExt::TopologyRefiner;
using FarExt::TopologyRefinerFactory;

TEST_F(StatusTest, NegativeRefinementLevel) {
    ShapeDescriptor const descriptor(GetShape("cube"));
    auto const refiner = TopologyRefinerFactory::Create(descriptor.Get());
    ASSERT_TRUE(refiner->RefineUniform(2));
    CallStatus status;
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
        CallStatus status;
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
    Shape const plain = MakeShape(7, {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 1}});
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
        textured, {StatusCode::Unsupported, ComponentType::NoComponent, -1, {"face-varying"}});
    Shape const fin = MakeShape(5, {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}});
    int const edge = findEdge(fin, 0, 1);
    expectRefusedByOtherSchemes(fin, {StatusCode::Unsupported,
                                      ComponentType::Edge,
                                      edge,
                                      {"edge " + std::to_string(edge), "non-manifold"}});
}

TEST_F(StatusTest, OtherSchemesTakeSharpBorders) {
    // Corners at the border are dropped with it.
    Shape shape = MakeShape(4, {{0, 1, 2, 3}});
    shape.cornerVertices = {1};
    shape.cornerSharpness = {10};
    Sdc::Options sdcOptions;
    sdcOptions.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER);
    ShapeDescriptor const descriptor(shape);
    for (HexSchemeOptions const &scheme : kOtherSchemes) {
        TopologyRefinerFactory::Options options;
        options.hexSchemeOptions = scheme;
        CallStatus status;
        auto const refiner =
            TopologyRefinerFactory::Create(descriptor.Get(), sdcOptions, options, &status);
        ASSERT_TRUE(refiner) << status.GetErrorMessage();
        EXPECT_EQ(refiner->GetHexSchemeOptions().schemeType, scheme.schemeType);
        EXPECT_EQ(refiner->GetHexSchemeOptions().firstStep, scheme.firstStep);
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
        CallStatus status;
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
                          {StatusCode::InvalidArgument, ComponentType::NoComponent, -1, {"null"}});
    for (double tolerance : {-0.5, 180.5, std::nan(""), double(INFINITY)}) {
        TopologyRefiner::CoplanarOptions options(1);
        options.angleTolerance = tolerance;
        expectCoplanarRefused(
            cube.positions.data(), options,
            {StatusCode::InvalidArgument, ComponentType::NoComponent, -1, {"angle", "180"}});
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
    CallStatus status;
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
        options.hexSchemeOptions = scheme;
        auto const refiner =
            TopologyRefinerFactory::Create(descriptor.Get(), Sdc::Options(), options);
        ASSERT_TRUE(refiner && refiner->RefineUniform(1));
        CallStatus status;
        EXPECT_FALSE(refiner->RefineCoplanar(cube.positions.data(), 1, &status));
        expectRefusal(
            status,
            {StatusCode::Unsupported, ComponentType::NoComponent, -1, {"coplanar", "hexagonal"}});
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
        options.hexSchemeOptions = expected.scheme;
        auto const refiner =
            TopologyRefinerFactory::Create(descriptor.Get(), Sdc::Options(), options);
        ASSERT_TRUE(refiner->RefineUniform(2));
        int const numVertices = refiner->GetLevel(2).GetNumVertices();
        for (int level : {expected.level, 1000000}) {
            CallStatus status;
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
        options.hexSchemeOptions.schemeType = scheme;
        auto const refiner =
            TopologyRefinerFactory::Create(descriptor.Get(), Sdc::Options(), options);
        for (int level : {TopologyRefiner::kLastLevel + 1, std::numeric_limits<int>::max()}) {
            CallStatus status;
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
        CallStatus status;
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
                    Shape const other = MakeShape(refiner->GetLevel(level));
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
            CallStatus status;
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
        options.hexSchemeOptions = scheme;
        ShapeDescriptor const descriptor(shape);
        return TopologyRefinerFactory::Create(descriptor.Get(), Sdc::Options(), options);
    };
    auto const refuse = [](TopologyRefiner &refiner) {
        CallStatus status;
        EXPECT_FALSE(refiner.RefineUniform(100, &status));
        EXPECT_EQ(status.GetCode(), StatusCode::TooLarge);
        return status;
    };
    // All that are chosen have too many face-vertices, those of the levels before included.
    std::string const kCount = "face-vertices together with the levels before";
    auto const readCount = [](CallStatus const &status) {
        std::string const before = "would have ";
        std::size_t const place = status.GetErrorMessage().find(before) + before.size();
        return std::stoll(status.GetErrorMessage().substr(place));
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
        CallStatus const expected = refuse(*refiner);
        int const lastLevel = expected.GetComponentIndex();
        ASSERT_NE(expected.GetErrorMessage().find(kCount), std::string::npos)
            << expected.GetErrorMessage();
        std::int64_t count = readCount(expected);
        for (int level : {1, 2, 3}) {
            ASSERT_TRUE(refiner->RefineUniform(level));
            auto const other = create(MakeShape(refiner->GetLevel(level)), test.scheme);
            ASSERT_TRUE(other);
            CallStatus const actual = refuse(*other);
            EXPECT_EQ(actual.GetComponentIndex(), lastLevel - level);
            count -= refiner->GetLevel(level - 1).GetNumFaceVertices();
            EXPECT_EQ(readCount(actual), count);
        }
    }
    // With borders the sizes are known after the tri-hex step.
    EXPECT_NE(refuse(*create(GetShape("mixedPatch"), kOtherSchemes[2])).GetErrorMessage(), "");
}

} // namespace OpenSubdivHex::Regression::refinementStatusTest
