// SPDX-License-Identifier: Apache-2.0
//
// The search for weights of the first levels: that it judges what the library makes, and goes downhill.
#include "maskSearch.h"
#include "evenness.h"

#include <gtest/gtest.h>

namespace OpenSubdivHex::Regression::maskSearchTest {

namespace {

constexpr int kLevel = 3;
constexpr SearchedMasks kOfQuads = {4, FarExt::FacesAround::Quads};

} // namespace

TEST(MaskSearch, JudgesTheLibrary) {
    MaskJudge judge(kOfQuads, kLevel);
    judge.Measure(GetShippedWeights(kOfQuads));
    FarExt::HexSchemeOptions const smooth{FarExt::FaceMask::Smooth};
    PolygonMesh const torus =
        RefineSurface(MakeTorus(14, 8, TorusFaces::Quads), smooth, kLevel).back().mesh;
    EXPECT_NEAR(judge.GetEntries()[0].unevenness, MeasureTorusUnevenness(torus, 14), 1e-12);
    // The library's weights are rounded: none is searched for again.
    EXPECT_EQ(RoundWeights(GetShippedWeights(kOfQuads), 0, judge), GetShippedWeights(kOfQuads));
    constexpr int kNumWeights = 27;
    EXPECT_EQ(GetShippedWeights(kOfQuads).size(), kNumWeights);
}

TEST(MaskSearch, GoesDownhill) {
    SearchedMasks const searched = {5, FarExt::FacesAround::Others};
    MaskJudge judge(searched, kLevel);
    MaskWeights const plain = GetPlainWeights(searched);
    double const before = judge.Measure(plain).norm();
    MaskWeights const found = SearchWeights(plain, 2, judge);
    EXPECT_LT(judge.Measure(found).norm(), 0.84 * before);
    EXPECT_GE(found.minCoeff(), 0);
    // Where all is at its best, a step gains nothing.
    EXPECT_LE(judge.Measure(SearchWeights(found, 1, judge)).norm(), judge.Measure(found).norm());
}

// Around a vertex: those that the library has make all surfaces more even than those of later levels.
TEST(MaskSearch, Vertices) {
    using FarExt::FacesAround;
    constexpr int kLevelOfVertices = 5;
    for (int numFaces = 4; numFaces <= 8; ++numFaces) {
        for (FacesAround facesAround : {FacesAround::Others, FacesAround::Triangles}) {
            SearchedMasks const searched = {numFaces, facesAround};
            if (numFaces == 4 && facesAround == FacesAround::Triangles) {
                continue;
            }
            SCOPED_TRACE(::testing::Message() << numFaces << ", " << int(facesAround));
            MaskJudge judge(searched, kLevelOfVertices);
            MaskWeights const shipped = GetShippedWeights(searched);
            EXPECT_EQ(shipped.size(), facesAround == FacesAround::Triangles ? 10 : 14);
            EXPECT_LT(judge.Measure(shipped).norm(),
                      0.95 * judge.Measure(GetPlainWeights(searched)).norm());
        }
    }
}

} // namespace OpenSubdivHex::Regression::maskSearchTest
