// SPDX-License-Identifier: Apache-2.0
#include "patchConstants.h"

namespace OpenSubdivHex::FarExt::internal {

namespace {

struct Constant {
    PatchSite site;
    double value;
};

constexpr auto kLength = PatchQuantity::Length;
constexpr auto kBlend = PatchQuantity::Blend;
constexpr auto kEdgeShare = PatchQuantity::EdgeShare;
constexpr auto kDiagonalShare = PatchQuantity::DiagonalShare;
constexpr auto kEdge = PatchSite::kEdge;
constexpr auto kDiagonal = PatchSite::kDiagonal;
constexpr auto kLongBoundary = PatchSite::kLongBoundary;
constexpr auto kSharpEdge = PatchSite::kSharpEdge;
constexpr auto kVertex = PatchSite::kVertex;
constexpr auto kSpoke = PatchSite::kSpoke;

// In the order of the members of PatchSite.
constexpr Constant kSmoothConstants[] = {
#include "patchConstants.inl"
};

} // namespace

std::uint64_t PatchSite::GetKey() const {
    std::uint64_t key = 0;
    for (std::uint8_t part :
         {std::uint8_t(std::uint8_t(quantity) << 4 | std::uint8_t(kind)), steps, vert, otherVert,
          smallFace, largeFace,
          std::uint8_t((isBesideOther ? 2 : 0) | (isOtherBesideOther ? 1 : 0)), surfaceFace}) {
        key = key << 8 | part;
    }
    return key;
}

double PatchConstants::GetDefault(PatchSite const &site) {
    if (site.quantity != PatchQuantity::Length) {
        return 0;
    }
    if (site.steps == 0 || site.kind == PatchSite::kSpoke) {
        return 1;
    }
    constexpr double kIrregular[] = {0.85, 0.90, 0.98}; // by steps, from 1 on
    constexpr double kBesideQuad = 1.2;
    bool const isIrregular =
        site.vert > PatchSite::kBase + 3 && site.vert <= PatchSite::kBase + PatchSite::kMaxFaces;
    return (isIrregular ? kIrregular[site.steps - 1] : 1) * (site.smallFace == 4 ? kBesideQuad : 1);
}

PatchConstants::PatchConstants(FaceMask mask) {
    if (mask != FaceMask::Smooth) {
        return;
    }
    for (Constant const &row : kSmoothConstants) {
        Set(row.site, row.value);
    }
}

} // namespace OpenSubdivHex::FarExt::internal
