// SPDX-License-Identifier: Apache-2.0
//
// The search for the weights of quads: that it judges what the library makes, and goes downhill.
#include "quadMaskSearch.h"
#include "evenness.h"

#include <gtest/gtest.h>

namespace OpenSubdivHex::Regression {

namespace {

constexpr int kLevel = 3;

} // namespace

TEST(QuadMaskSearch, JudgesTheLibrary) {
    QuadJudge judge(kLevel);
    judge.Measure(GetShippedQuadWeights());
    FarExt::HexSchemeOptions const smooth{FarExt::FaceMask::Smooth};
    PolygonMesh const torus =
        RefineSurface(MakeTorus(14, 8, TorusFaces::Quads), smooth, kLevel).back().mesh;
    EXPECT_NEAR(judge.GetEntries()[0].unevenness, MeasureTorusUnevenness(torus, 14), 1e-12);
    // Those of the library are rounded: none is searched for again.
    EXPECT_EQ(RoundQuadWeights(GetShippedQuadWeights(), 0, judge), GetShippedQuadWeights());
    constexpr int kNumWeights = 31;
    EXPECT_EQ(GetShippedQuadWeights().size(), kNumWeights);
}

TEST(QuadMaskSearch, GoesDownhill) {
    QuadJudge judge(kLevel);
    QuadWeights const plain = GetPlainQuadWeights();
    double const before = judge.Measure(plain).norm();
    QuadWeights const found = SearchQuadWeights(plain, 2, judge);
    EXPECT_LT(judge.Measure(found).norm(), 0.8 * before);
    EXPECT_GE(found.minCoeff(), 0);
    // Where all is at its best, a step gains nothing.
    EXPECT_LE(judge.Measure(SearchQuadWeights(found, 1, judge)).norm(),
              judge.Measure(found).norm());
}

} // namespace OpenSubdivHex::Regression
