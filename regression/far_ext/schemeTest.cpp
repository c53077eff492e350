// SPDX-License-Identifier: Apache-2.0
//
// Doo-Sabin, tri-hex, and a tri-hex step first: every shape against the reference.
#include "expectations.h"

#include "regression/shapes/featureShapes.h"
#include "regression/shapes/flatShapes.h"
#include "regression/shapes/shapeDescriptor.h"

#include <gtest/gtest.h>

#include <array>

namespace OpenSubdivHex::Regression::schemeTest {

using FarExt::FirstStep;
using FarExt::HexSchemeOptions;
using FarExt::SchemeType;
using FarExt::TopologyLevel;
using FarExt::TopologyRefiner;

namespace {

struct NamedScheme {
    char const *name;
    SchemeType schemeType;
    FirstStep firstStep;
};

constexpr NamedScheme kSchemes[] = {
    {"Doo-Sabin", SchemeType::DooSabin, FirstStep::Same},
    {"tri-hex", SchemeType::TriHex, FirstStep::Same},
    {"tri-hex, then hexagonal", SchemeType::Hexagonal, FirstStep::TriHex},
    {"tri-hex, then Doo-Sabin", SchemeType::DooSabin, FirstStep::TriHex}};

HexSchemeOptions makeOptions(NamedScheme const &scheme) {
    HexSchemeOptions options;
    options.schemeType = scheme.schemeType;
    options.firstStep = scheme.firstStep;
    return options;
}

std::unique_ptr<TopologyRefiner> createRefiner(Shape const &shape, ReferenceMask mask,
                                               NamedScheme const &scheme, int level,
                                               Sdc::Options options = Sdc::Options()) {
    return CreateRefiner(shape, mask, level, options, makeOptions(scheme));
}

/// Calls check(shape, scheme, options) for all shapes without flaws, and without their channels.
template <typename CHECK>
void forEach(CHECK const &check) {
    for (auto const *shapes : {&GetManifoldShapes(), &GetFlatShapes()}) {
        for (Shape shape : *shapes) {
            shape.fvarChannels.clear();
            for (NamedScheme const &scheme : kSchemes) {
                for (auto boundary : kBoundaries) {
                    if (shape.closed && boundary != Sdc::Options::VTX_BOUNDARY_NONE) {
                        continue;
                    }
                    SCOPED_TRACE(testing::Message()
                                 << shape.name << ", " << scheme.name << ", boundary " << boundary);
                    Sdc::Options options;
                    options.SetVtxBoundaryInterpolation(boundary);
                    check(shape, scheme, options);
                    if (testing::Test::HasFatalFailure()) {
                        return;
                    }
                }
            }
        }
    }
}

} // namespace

TEST(Scheme, EqualsReference) {
    forEach([](Shape const &shape, NamedScheme const &scheme, Sdc::Options options) {
        ExpectMeshEqual(shape, GetTestLevel(shape, 3, 6000), options, makeOptions(scheme));
    });
}

TEST(Scheme, HolesAndTurnedFacesEqualReference) {
    for (char const *name : {"holesInside", "cubeWithHole", "leftHanded", "bowTie"}) {
        Shape shape = GetFeatureShape(name);
        shape.fvarChannels.clear();
        shape.creaseVertexPairs.clear();
        shape.creaseSharpness.clear();
        for (NamedScheme const &scheme : kSchemes) {
            SCOPED_TRACE(std::string(name) + ", " + scheme.name);
            ASSERT_NO_FATAL_FAILURE(ExpectMeshEqual(shape, 3, Sdc::Options(), makeOptions(scheme)));
        }
    }
}

TEST(Scheme, TriHexFirstGivesThreeFacesToEveryVertex) {
    for (Shape shape : GetManifoldShapes()) {
        SCOPED_TRACE(shape.name);
        shape.fvarChannels.clear();
        auto const refiner =
            createRefiner(shape, ReferenceMask::Smooth, kSchemes[2], GetTestLevel(shape, 3, 6000));
        for (int level = 1; level <= refiner->GetMaxLevel(); ++level) {
            TopologyLevel const &topology = refiner->GetLevel(level);
            for (int v = 0; v < topology.GetNumVertices(); ++v) {
                if (!topology.IsVertexBoundary(v)) {
                    ASSERT_EQ(topology.GetVertexFaces(v).size(), 3);
                }
            }
        }
    }
}

TEST(Scheme, Counts) {
    // The cube: 8 vertices, 12 edges, 6 faces, 24 corners.
    Shape const &cube = GetShape("cube");
    std::vector<std::array<int, 3>> const expected[] = {
        {{24, 48, 26}, {96, 192, 98}},
        {{24, 36, 14}, {72, 108, 38}},
        {{24, 36, 14}, {96, 144, 50}},
        {{24, 36, 14}, {72, 144, 74}},
    };
    for (int scheme = 0; scheme < 4; ++scheme) {
        SCOPED_TRACE(kSchemes[scheme].name);
        auto const refiner = createRefiner(cube, ReferenceMask::Average, kSchemes[scheme], 2);
        for (int level = 1; level <= 2; ++level) {
            TopologyLevel const &topology = refiner->GetLevel(level);
            EXPECT_EQ((std::array<int, 3>{topology.GetNumVertices(), topology.GetNumEdges(),
                                          topology.GetNumFaces()}),
                      expected[scheme][level - 1]);
        }
    }
}

TEST(Scheme, RefinesAgain) {
    Shape const &shape = GetShape("truncatedCube");
    for (NamedScheme const &scheme : kSchemes) {
        SCOPED_TRACE(scheme.name);
        auto const refiner = createRefiner(shape, ReferenceMask::Smooth, scheme, 3);
        TopologyRefiner::UniformOptions options(2);
        options.fullTopologyInLastLevel = true;
        ASSERT_TRUE(refiner->RefineUniform(options));
        TaggedMatch const match(shape, *refiner);
        ASSERT_EQ(match.GetError(), "");
        ASSERT_NO_FATAL_FAILURE(ExpectValid(*refiner));
        ASSERT_NO_FATAL_FAILURE(
            ExpectVertexValuesEqual(*refiner, match, ReferenceMask::Smooth, GetPositions(shape)));
    }
}

TEST(Scheme, LastLevelNeedsFaceVerticesOnly) {
    Shape const &shape = GetShape("mixedPatch");
    for (NamedScheme const &scheme : kSchemes) {
        SCOPED_TRACE(scheme.name);
        auto const full = createRefiner(shape, ReferenceMask::Smooth, scheme, 2);
        TaggedMatch const match(shape, *full);
        ASSERT_EQ(match.GetError(), "");
        auto const refiner = createRefiner(shape, ReferenceMask::Smooth, scheme, 2);
        ASSERT_TRUE(refiner->RefineUniform(2));
        EXPECT_FALSE(refiner->GetLevel(2).HasFullTopology());
        ASSERT_NO_FATAL_FAILURE(ExpectValid(*refiner));
        ASSERT_NO_FATAL_FAILURE(ExpectNumbering(*refiner));
        ASSERT_NO_FATAL_FAILURE(
            ExpectVertexValuesEqual(*refiner, match, ReferenceMask::Smooth, GetPositions(shape)));
    }
}

} // namespace OpenSubdivHex::Regression::schemeTest
