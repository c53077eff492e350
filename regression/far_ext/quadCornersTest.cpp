// SPDX-License-Identifier: Apache-2.0
#include "far_ext/vtr/level.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <vector>

namespace OpenSubdivHex::Regression::quadCornersTest {
namespace {

using FarExt::internal::FindCornerTags;
using FarExt::internal::QuadCorner;
using FarExt::internal::QuadCorners;
using FarExt::internal::QuadFlags;

/// Flags that repeat with every hexagon, but for a gap and one corner behind it.
std::vector<QuadCorner> makeCorners() {
    constexpr int kNumCorners = 6000;
    constexpr int kOdd = 5000;
    std::vector<QuadCorner> corners;
    for (int corner = 0; corner < kNumCorners; ++corner) {
        bool const isGap = corner > 3000 && corner < 4001;
        if (corner % 6 < 4 && !isGap) {
            corners.push_back(
                {corner,
                 {FarExt::internal::QuadFlag(1 + corner % 6), 1, corner == kOdd ? 0.5f : 0}});
        }
    }
    return corners;
}

QuadCorners makeTags(std::vector<QuadCorner> const &corners) {
    QuadCorners tags;
    for (QuadCorner const &corner : corners) {
        tags.push_back(corner);
    }
    return tags;
}

void expectSame(QuadCorner const &tag, QuadCorner const &expected) {
    EXPECT_EQ(tag.corner, expected.corner);
    EXPECT_EQ(tag.flags.out, expected.flags.out);
    EXPECT_EQ(tag.flags.in, expected.flags.in);
    EXPECT_EQ(tag.flags.sharpness, expected.flags.sharpness);
}

TEST(QuadCorners, HasTheCornersThatWereAdded) {
    std::vector<QuadCorner> const corners = makeCorners();
    QuadCorners const tags = makeTags(corners);
    EXPECT_EQ(tags.size(), corners.size());
    std::size_t next = 0;
    for (QuadCorner const &tag : tags) {
        ASSERT_LT(next, corners.size());
        expectSame(tag, corners[next++]);
    }
    EXPECT_EQ(next, corners.size());
    EXPECT_TRUE(QuadCorners().empty());
    EXPECT_FALSE(tags.GetFlags(3500).HasAny());
    EXPECT_FALSE(tags.GetFlags(1000000).HasAny());
}

TEST(QuadCorners, FindsThoseOfAFace) {
    QuadCorners const tags = makeTags(makeCorners());
    auto const found = FindCornerTags(tags, 4998, 5004);
    ASSERT_FALSE(found.empty());
    std::vector<int> corners;
    for (QuadCorner const &tag : found) {
        corners.push_back(tag.corner);
    }
    EXPECT_EQ(corners, std::vector<int>({4998, 4999, 5000, 5001}));
    EXPECT_TRUE(FindCornerTags(tags, 3500, 3506).empty());
    EXPECT_TRUE(FindCornerTags(tags, 4, 6).empty());
    EXPECT_TRUE(FindCornerTags(tags, 7000, 7006).empty());
    EXPECT_TRUE(FindCornerTags(QuadCorners(), 0, 6).empty());
}

TEST(QuadCorners, KeepsRepeatedFlagsOnce) {
    QuadCorners const tags = makeTags(makeCorners());
    std::size_t numFlags = 0;
    QuadCorners::ForEachArray(tags, [&numFlags](auto const &array) {
        numFlags = array.size(); // of the last one
    });
    // Pages of none, of those that repeat, before the gap and behind it, with the odd corner, and the last.
    EXPECT_LE(numFlags, 6u * 48u);
}

} // namespace
} // namespace OpenSubdivHex::Regression::quadCornersTest
