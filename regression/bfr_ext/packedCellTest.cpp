// SPDX-License-Identifier: Apache-2.0
//
// Packed cells have all that the cells have on which steps and limits depend.
#include "bfr_ext/cell/packedCell.h"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <numeric>
#include <string>

namespace OpenSubdivHex::Regression::packedCellTest {

using namespace FarExt::internal;
using BfrExt::internal::PackCell;
using BfrExt::internal::UnpackCell;

namespace {

constexpr float kInfinite = std::numeric_limits<float>::infinity();

// Two triangles beside each other, with numbers of all sizes and signs, no matter whether a mesh has them.
CellPatch makeCell() {
    CellPatch cell;
    cell.kind = CellKind::HalfPolygon;
    cell.locals = {2, 0, 1};
    cell.corners = {130, 0, 1};
    LimitPatch &patch = cell.patch;
    patch.sources.resize(131);
    std::iota(patch.sources.begin(), patch.sources.end(), 0);
    patch.faceSizes = {3, 3};
    patch.faceVerts = {0, 1, 130, 1, 0, 64};
    patch.otherCorners = {3, kFreeBoundary, kSharpBoundaryA, 0, kSharpBoundaryB, -200};
    patch.edgeSharpness = {0, 1.5f, kInfinite, 0, -0.0f, 1e-30f};
    patch.diagonalSharpness = {0, 0.1f};
    patch.vertSharpness.resize(131);
    patch.vertSharpness[130] = 10;
    patch.crossedFaces = {{1, 3}};
    patch.nonManifoldVerts = {0, 63};
    patch.lineCorners = {4, 5};
    patch.lines = {1 << 30, std::numeric_limits<int>::min()};
    patch.sharpVerts = {
        {5, Sdc::Crease::RULE_CREASE, 1.0 / 3, -0.1, {7, -1}, {0.25, 1e-300}, 0.7, 0.3}};
    patch.sharpEnds = {{64, 2.25f}, {64, 0.5f}};
    patch.irregularVerts = {{3, 0.75f}};
    patch.numHexagonalSteps = 4;
    patch.hasFirstLineMasks = true;
    patch.sectorCorners = {{2, 5.5f, 0.125f, SectorCorner::kFarFromOne}};
    patch.irregularCorners = {
        {4, 7, 0.5f, IrregularCorner::kBehindQuad, FarExt::FacesAround::Others}};
    patch.lineRowCorners = {{1, 3.5f, LineFace::OnLine, 2}};
    patch.quadLineCorners.resize(1);
    std::memset(&patch.quadLineCorners[0], 0x5a, sizeof(QuadLineCorner));
    for (Far::Index const corner : {0, 5}) {
        QuadFlags flags;
        std::memset(&flags, 0x35 + corner, sizeof flags);
        patch.quadCorners.push_back({corner, flags});
    }
    return cell;
}

template <typename T>
void expectSame(std::vector<T> const &a, std::vector<T> const &b, int kind) {
    ASSERT_EQ(a.size(), b.size()) << kind;
    EXPECT_EQ(std::memcmp(a.data(), b.data(), a.size() * sizeof(T)), 0) << kind;
}

void expectSame(CellPatch const &a, CellPatch const &b) {
    EXPECT_EQ(a.kind, b.kind);
    EXPECT_EQ(a.locals, b.locals);
    EXPECT_EQ(a.corners, b.corners);
    EXPECT_EQ(a.patch.sources, b.patch.sources);
    int kind = 0;
    auto const expectSameArrays = [&](auto const &x, auto const &y) { expectSame(x, y, ++kind); };
    expectSameArrays(a.patch.faceSizes, b.patch.faceSizes);
    expectSameArrays(a.patch.faceVerts, b.patch.faceVerts);
    expectSameArrays(a.patch.otherCorners, b.patch.otherCorners);
    expectSameArrays(a.patch.edgeSharpness, b.patch.edgeSharpness);
    expectSameArrays(a.patch.diagonalSharpness, b.patch.diagonalSharpness);
    expectSameArrays(a.patch.vertSharpness, b.patch.vertSharpness);
    expectSameArrays(a.patch.crossedFaces, b.patch.crossedFaces);
    expectSameArrays(a.patch.nonManifoldVerts, b.patch.nonManifoldVerts);
    expectSameArrays(a.patch.lineCorners, b.patch.lineCorners);
    expectSameArrays(a.patch.lines, b.patch.lines);
    expectSameArrays(a.patch.sharpVerts, b.patch.sharpVerts);
    expectSameArrays(a.patch.sharpEnds, b.patch.sharpEnds);
    expectSameArrays(a.patch.irregularVerts, b.patch.irregularVerts);
    EXPECT_EQ(a.patch.numHexagonalSteps, b.patch.numHexagonalSteps);
    EXPECT_EQ(a.patch.hasFirstLineMasks, b.patch.hasFirstLineMasks);
    CornerTags::ForEachListedKind(expectSameArrays, a.patch, b.patch);
    expectSameArrays(
        std::vector<QuadCorner>(a.patch.quadCorners.begin(), a.patch.quadCorners.end()),
        std::vector<QuadCorner>(b.patch.quadCorners.begin(), b.patch.quadCorners.end()));
}

} // namespace

TEST(PackedCell, HasAllOfTheCell) {
    CellPatch const cell = makeCell();
    std::string bytes;
    PackCell(cell, bytes);
    bytes += "and more";
    expectSame(UnpackCell(bytes), cell);
}

TEST(PackedCell, DiffersWhereCellsDo) {
    std::string bytes;
    PackCell(makeCell(), bytes);
    CellPatch other = makeCell();
    other.patch.vertSharpness[130] = 9;
    std::string bytesOfOther;
    PackCell(other, bytesOfOther);
    EXPECT_NE(bytes, bytesOfOther);
    other.patch.vertSharpness[130] = 10;
    bytesOfOther.clear();
    PackCell(other, bytesOfOther);
    EXPECT_EQ(bytes, bytesOfOther);
}

} // namespace OpenSubdivHex::Regression::packedCellTest
