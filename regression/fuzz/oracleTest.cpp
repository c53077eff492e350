// SPDX-License-Identifier: Apache-2.0
//
// The oracle itself: that bytes make many kinds of cases, that it prints and shrinks them, and the
// inputs on which it failed once.
#include "oracle.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>

namespace OpenSubdivHex::Regression::oracleTest {

namespace {

OracleCase makeCase(unsigned seed) {
    std::mt19937 random(seed);
    std::vector<std::uint8_t> bytes(120);
    for (std::uint8_t &byte : bytes) {
        byte = std::uint8_t(random() >> 8);
    }
    return MakeOracleCase(bytes.data(), bytes.size());
}

} // namespace

TEST(Oracle, BytesMakeCasesOfAllKinds) {
    std::set<int> faceSizes;
    std::set<int> schemes;
    std::set<int> options;
    int numNonManifold = 0;
    int numWithAllTags = 0;
    int numRefined = 0;
    int numLattices = 0;
    for (unsigned seed = 0; seed < 2000; ++seed) {
        OracleCase const oracleCase = makeCase(seed);
        Shape const &shape = oracleCase.shape;
        numLattices += shape.GetNumCorners() > 100;
        faceSizes.insert(shape.faceSizes.begin(), shape.faceSizes.end());
        schemes.insert(int(oracleCase.schemeType) + 3 * int(oracleCase.firstStep) +
                       9 * int(oracleCase.isCoplanar));
        options.insert(int(oracleCase.sdcOptions.GetVtxBoundaryInterpolation()) +
                       3 * int(oracleCase.sdcOptions.GetCreasingMethod()) +
                       6 * int(oracleCase.sdcOptions.GetFVarLinearInterpolation()) +
                       36 * int(oracleCase.mask));
        numWithAllTags += !shape.creaseSharpness.empty() && !shape.cornerSharpness.empty() &&
                          !shape.holeFaces.empty() && !shape.fvarChannels.empty();
        FarExt::CallStatus status;
        auto const refiner = CreateRefiner(oracleCase, &status);
        numRefined += refiner != nullptr;
        for (int v = 0; refiner && v < shape.GetNumVertices(); ++v) {
            if (refiner->GetLevel(0).IsVertexNonManifold(v)) {
                ++numNonManifold;
                break;
            }
        }
    }
    EXPECT_EQ(faceSizes, (std::set<int>{3, 4, 5, 6, 7, 8}));
    EXPECT_EQ(schemes, (std::set<int>{0, 1, 2, 3, 6, 9}));
    EXPECT_EQ(int(options.size()), 108);
    EXPECT_GT(numNonManifold, 300);
    EXPECT_GT(numWithAllTags, 15);
    EXPECT_GT(numLattices, 50);
    EXPECT_GT(numRefined, 1000);
}

TEST(Oracle, NoBytesMakeACase) {
    OracleCase const oracleCase = MakeOracleCase(nullptr, 0);
    EXPECT_EQ(oracleCase.shape.GetNumFaces(), 1);
    EXPECT_NO_THROW(CheckOracleCase(oracleCase));
}

TEST(Oracle, ShrinksToWhatMatters) {
    // The last face, its crease and the second channel.
    int numShrunk = 0;
    for (unsigned seed = 0; seed < 200; ++seed) {
        OracleCase const oracleCase = makeCase(seed);
        auto const fails = [](OracleCase const &candidate) {
            Shape const &shape = candidate.shape;
            return std::count(shape.creaseSharpness.begin(), shape.creaseSharpness.end(), 0.5f) >
                       0 &&
                   shape.fvarChannels.size() == 1;
        };
        if (!fails(oracleCase)) {
            continue;
        }
        ++numShrunk;
        Shape const shape = Shrink(oracleCase, fails).shape;
        EXPECT_EQ(shape.faceSizes, std::vector<int>{3});
        EXPECT_EQ(shape.GetNumVertices(), 3);
        EXPECT_EQ(shape.creaseSharpness, std::vector<float>{0.5f});
        EXPECT_TRUE(shape.cornerVertices.empty());
        EXPECT_TRUE(shape.holeFaces.empty());
        EXPECT_EQ(shape.fvarChannels[0].valueIndices.size(), 3u);
    }
    EXPECT_GT(numShrunk, 3);
}

TEST(Oracle, PrintsStatements) {
    OracleCase oracleCase = MakeOracleCase(nullptr, 0);
    oracleCase.shape.creaseVertexPairs = {0, 1};
    oracleCase.shape.creaseSharpness = {0.5f};
    std::string const text = Print(oracleCase);
    for (char const *part :
         {"oracleCase.shape.faceSizes = {", "oracleCase.shape.creaseSharpness = {0.5};",
          "VTX_BOUNDARY_NONE", "CheckOracleCase(oracleCase);"}) {
        EXPECT_NE(text.find(part), std::string::npos) << text;
    }
}

// Gaps that are closed give F-vertices a fourth face, so that a hexagon beside a quad has an irregular vertex at
// one end.
TEST(Oracle, HexagonsBesideQuadsAndIrregularVertices) {
    OracleCase oracleCase;
    oracleCase.shape.positions = {-1, 0, 0, -1, -1, 1, 0, -1, 1, -1, 0, -1, 0, -1, -1, 1, 0, 1};
    oracleCase.shape.faceSizes = {4, 4};
    oracleCase.shape.faceVertices = {0, 1, 3, 2, 4, 5, 1, 0};
    oracleCase.sdcOptions.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER);
    oracleCase.mask = ReferenceMask::Smooth;
    oracleCase.schemeType = FarExt::SchemeType::Hexagonal;
    oracleCase.firstStep = FarExt::FirstStep::Same;
    oracleCase.level = 3;
    oracleCase.isCoplanar = true;
    oracleCase.angleTolerance = 0.1;
    oracleCase.closeGaps = true;
    oracleCase.checks = 11708;
    EXPECT_NO_THROW(CheckOracleCase(oracleCase));
}

// A vertex at both ends of one boundary edge is on no dart.
TEST(Oracle, TruncatedVertexWithABoundaryEdgeToItself) {
    OracleCase oracleCase;
    oracleCase.shape.positions = {0.375, 1.75, 0.875, 0.25, -0.5, -0.75, -1.625, -1.5, -1.25};
    oracleCase.shape.faceSizes = {3, 4};
    oracleCase.shape.faceVertices = {2, 0, 1, 2, 2, 1, 0};
    oracleCase.sdcOptions.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER);
    oracleCase.mask = ReferenceMask::Average;
    oracleCase.schemeType = FarExt::SchemeType::Hexagonal;
    oracleCase.firstStep = FarExt::FirstStep::Truncate;
    oracleCase.level = 1;
    oracleCase.checks = 43784;
    EXPECT_NO_THROW(CheckOracleCase(oracleCase));
}

// By Chaikin's rule the crease from vertex 7 to 3 is less sharp for the other one at 3, which is no neighbour
// of vertex 0.
TEST(Oracle, LimitBesideTheFarEndOfACreaseByChaikin) {
    OracleCase oracleCase;
    oracleCase.shape.positions = {-1.6875,  1.4375,   -1.0625,   1.03125,   -0.078125, -1.015625,
                                  1.78125,  -0.125,   -1.203125, -1.578125, -1.71875,  1.109375,
                                  0.1875,   1.375,    -0.265625, -0.953125, 1.421875,  0.90625,
                                  -0.78125, 0.546875, -0.4375,   1.703125,  -1.875,    1.359375};
    oracleCase.shape.faceSizes = {3, 3, 3, 3, 3, 3, 3, 3, 3, 3, 3, 3};
    oracleCase.shape.faceVertices = {0, 1, 6, 1, 0, 7, 1, 2, 6, 2, 1, 7, 2, 3, 6, 3, 2, 7,
                                     3, 4, 6, 4, 3, 7, 4, 5, 6, 5, 4, 7, 5, 0, 6, 0, 5, 7};
    oracleCase.shape.creaseVertexPairs = {3, 7, 2, 3, 0, 1};
    oracleCase.shape.creaseSharpness = {2, 0.25, 10};
    oracleCase.sdcOptions.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER);
    oracleCase.sdcOptions.SetCreasingMethod(Sdc::Options::CREASE_CHAIKIN);
    oracleCase.mask = ReferenceMask::Smooth;
    oracleCase.level = 1;
    oracleCase.checks = 3969;
    EXPECT_NO_THROW(CheckOracleCase(oracleCase));
}

// Far takes vertex 4 for manifold, since its walk around the vertex finds the first corner of face 2 alone.
TEST(Oracle, ValuesOfAVertexThatAFaceHasTwiceStay) {
    OracleCase oracleCase;
    oracleCase.shape.positions = {-0.109375, -0.703125, 1.875,   -1.90625,  0.234375, 1.15625,
                                  1.59375,   -0.109375, 0.84375, -1.609375, 0.765625, 0.421875,
                                  -1.65625,  -1.140625, -1.4375, -0.5,      0.359375, 0.328125};
    oracleCase.shape.faceSizes = {3, 3, 6};
    oracleCase.shape.faceVertices = {0, 4, 1, 0, 2, 4, 1, 4, 2, 3, 4, 5};
    oracleCase.shape.fvarChannels.push_back(
        {2,
         {-1.078125, 0.359375, 0.21875, -0.46875, 1.359375, 1.421875, -0.921875, -1.15625, 1.5,
          -0.1875, -1.40625, 1.6875, 0.65625, 0.453125, 1.671875, -1.953125, 0.515625, 0.796875},
         {0, 1, 2, 0, 3, 4, 5, 4, 6, 7, 4, 8}});
    oracleCase.sdcOptions.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER);
    oracleCase.sdcOptions.SetFVarLinearInterpolation(Sdc::Options::FVAR_LINEAR_NONE);
    oracleCase.mask = ReferenceMask::Average;
    oracleCase.level = 1;
    oracleCase.checks = 21374;
    EXPECT_NO_THROW(CheckOracleCase(oracleCase));
}

} // namespace OpenSubdivHex::Regression::oracleTest
