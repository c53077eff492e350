// SPDX-License-Identifier: Apache-2.0
//
// The masks beside lines of truncated meshes: where they apply, and that they are those of the reference there and
// elsewhere.
#include "expectations.h"

#include "far_ext/rules/lineRow.h"
#include "far_ext/vtr/hierarchy.h"
#include "regression/shapes/featureShapes.h"
#include "regression/shapes/shapeDescriptor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

namespace OpenSubdivHex::Regression::lineRowTest {

using FarExt::FirstStep;
using FarExt::HexSchemeOptions;
using FarExt::SchemeType;
using FarExt::TopologyRefiner;
using FarExt::internal::kNumLineSteps;
using FarExt::internal::LineFace;
using FarExt::internal::LineRowCorner;
using OpenSubdiv::Sdc::Crease;

namespace {

constexpr int kHexagon = 6;
constexpr int kNone = -1;
constexpr int kParts = 4096;
constexpr LineFace kOnLine = LineFace::OnLine;
constexpr LineFace kHalf = LineFace::Half;
constexpr LineFace kBehind = LineFace::Behind;
constexpr LineFace kBeyond = LineFace::Beyond;
struct TableRow {
    int numSteps;
    LineFace face;
    int place;
    int ofVertex;
    int parts[kHexagon];
};
constexpr TableRow kTable[] = {
#include "far_ext/rules/lineRows.inl"
};

HexSchemeOptions const kTruncate{FarExt::FaceMask::Smooth, SchemeType::Hexagonal,
                                 FirstStep::Truncate};
constexpr int kWidth = 5; // of the mesh, in triangles
constexpr int kRows = 4;

int vertexAt(int column, int row) { return row * (kWidth + 1) + column; }

/// Triangles of the plane in rows, moved about so that no weight is lost by symmetry.
Shape makeTriangles() {
    Shape shape = MakeTiling(Tiling::Triangles, kWidth, kRows);
    for (std::size_t i = 0; i < shape.positions.size(); ++i) {
        shape.positions[i] += 0.2 * std::sin(7.0 * double(i * i % 31));
    }
    return shape;
}

/// A crease along the middle row of vertices.
void addCrease(Shape &shape, std::vector<float> const &sharpness) {
    for (std::size_t i = 0; i < sharpness.size(); ++i) {
        shape.creaseVertexPairs.insert(
            shape.creaseVertexPairs.end(),
            {vertexAt(int(i), kRows / 2), vertexAt(int(i) + 1, kRows / 2)});
        shape.creaseSharpness.push_back(sharpness[i]);
    }
}

std::vector<float> const kInfinite(kWidth, Crease::SHARPNESS_INFINITE);

Sdc::Options getOptions(Sdc::Options::CreasingMethod method = Sdc::Options::CREASE_UNIFORM) {
    Sdc::Options options;
    options.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER);
    options.SetCreasingMethod(method);
    return options;
}

std::unique_ptr<TopologyRefiner> refine(Shape const &shape, int level, Sdc::Options options) {
    return CreateRefiner(shape, ReferenceMask::Smooth, level, options, kTruncate);
}

std::vector<LineRowCorner> const &getTags(TopologyRefiner const &refiner, int level) {
    return refiner.GetHierarchy().mesh.levels[std::size_t(level)].lineRowCorners;
}

int countFaces(TopologyRefiner const &refiner, int level, LineFace face) {
    auto const &tags = getTags(refiner, level);
    // Place 2 of half a hexagon, and place 1 of others, come once.
    int const place = face == LineFace::Half ? 2 : 1;
    return int(std::count_if(tags.begin(), tags.end(), [&](LineRowCorner const &tag) {
        return tag.face == face && tag.place == place;
    }));
}

void expectReference(Shape const &shape, Sdc::Options options = getOptions()) {
    constexpr int kLevel = 4; // made by the last step with masks of its own
    SCOPED_TRACE(shape.name);
    ExpectMeshEqual(shape, kLevel, options, kTruncate);
}

} // namespace

TEST(LineRow, WeightsAreNotNegative) {
    for (TableRow const &row : kTable) {
        SCOPED_TRACE(testing::Message() << row.numSteps << " steps, face " << int(row.face)
                                        << ", place " << row.place);
        EXPECT_GE(*std::min_element(row.parts, row.parts + kHexagon), 0);
        int const sum = std::accumulate(row.parts, row.parts + kHexagon, 0);
        EXPECT_EQ(sum, row.face == kBeyond ? 0 : kParts);
        EXPECT_TRUE(row.face != kHalf || (row.parts[4] == 0 && row.parts[5] == 0));
    }
    for (int steps = 0; steps < kNumLineSteps; ++steps) {
        using Place = std::pair<LineFace, int>;
        for (auto const &around :
             {std::array<Place, 3>{{{kHalf, 2}, {kOnLine, 2}, {kBehind, 1}}},
              std::array<Place, 3>{{{kOnLine, 3}, {kBehind, 2}, {kBeyond, 0}}}}) {
            int sum = 0;
            for (auto const &[face, place] : around) {
                for (TableRow const &row : kTable) {
                    bool const isThere =
                        row.numSteps == steps && row.face == face && row.place == place;
                    EXPECT_TRUE(!isThere || row.ofVertex > 0);
                    sum += isThere ? row.ofVertex : 0;
                }
            }
            EXPECT_GT(sum, 0);
            EXPECT_LE(sum, kParts);
        }
    }
}

// Half hexagons and hexagons lie in turn along the line; what is on it and behind it doubles with each step.
TEST(LineRow, LieOnBothSidesOfACrease) {
    Shape shape = makeTriangles();
    addCrease(shape, kInfinite);
    auto const refiner = refine(shape, 4, getOptions());
    // The border's corners and the ends of the crease keep their vertices; beside them no line is regular.
    Shape plain = makeTriangles();
    auto const ofBorder = refine(plain, 4, getOptions());
    for (int level = 1; level <= kNumLineSteps; ++level) {
        SCOPED_TRACE(level);
        int const ofCrease =
            countFaces(*refiner, level, kOnLine) - countFaces(*ofBorder, level, kOnLine);
        EXPECT_GT(ofCrease, 0);
        EXPECT_EQ(ofCrease % 2, 0);
        for (LineFace face : {kHalf, kBehind, kBeyond}) {
            EXPECT_GT(countFaces(*refiner, level, face), 0);
        }
    }
    EXPECT_EQ(countFaces(*refiner, 2, kHalf), countFaces(*refiner, 2, kBehind));
    // Later levels have none, and neither have meshes that are not truncated.
    EXPECT_TRUE(getTags(*refiner, kNumLineSteps + 1).empty());
    auto const whole = CreateRefiner(shape, ReferenceMask::Smooth, 3, getOptions(),
                                     HexSchemeOptions{FarExt::FaceMask::Smooth});
    for (int level = 0; level <= 3; ++level) {
        EXPECT_TRUE(getTags(*whole, level).empty());
    }
    auto const average = CreateRefiner(shape, ReferenceMask::Average, 3, getOptions(), kTruncate);
    EXPECT_TRUE(getTags(*average, 1).empty());
}

TEST(LineRow, BordersAndCreasesEqualReference) {
    Shape shape = makeTriangles();
    expectReference(shape);
    addCrease(shape, kInfinite);
    expectReference(shape);
}

// The table stands in the place of the sharp share.
TEST(LineRow, SemiSharpCreasesEqualReference) {
    for (auto method : {Sdc::Options::CREASE_UNIFORM, Sdc::Options::CREASE_CHAIKIN}) {
        for (std::vector<float> const &sharpness :
             {std::vector<float>(kWidth, 0.75F), std::vector<float>(kWidth, 2.25F),
              std::vector<float>{0.5F, 1.5F, 3, 2.25F, 10}}) {
            Shape shape = makeTriangles();
            addCrease(shape, sharpness);
            expectReference(shape, getOptions(method));
        }
    }
}

// Where the line is not regular, masks are as without the table: ends of creases, corners, sharp vertices, vertices
// with other numbers of faces, and other faces.
TEST(LineRow, OtherNeighborhoodsEqualReference) {
    int const middle = vertexAt(kWidth / 2, kRows / 2);
    Shape dart = makeTriangles();
    dart.name = "dart";
    addCrease(dart, {10, 10, 10});
    expectReference(dart);

    Shape crossing = makeTriangles();
    crossing.name = "crossing lines";
    addCrease(crossing, kInfinite);
    for (int row = 0; row < kRows; ++row) {
        crossing.creaseVertexPairs.insert(crossing.creaseVertexPairs.end(),
                                          {vertexAt(2, row), vertexAt(2, row + 1)});
        crossing.creaseSharpness.push_back(row % 2 == 0 ? 10.0F : 1.5F);
    }
    expectReference(crossing);

    Shape sharp = makeTriangles();
    sharp.name = "sharp vertex";
    addCrease(sharp, kInfinite);
    sharp.cornerVertices = {middle};
    sharp.cornerSharpness = {1.5F};
    expectReference(sharp);

    // Two triangles make a quad: the vertices around it have one face less.
    Shape quad = makeTriangles();
    quad.name = "quad on the line";
    addCrease(quad, kInfinite);
    std::size_t const face = 2 * std::size_t(kRows / 2 * kWidth + kWidth / 2);
    std::vector<int> &verts = quad.faceVertices;
    auto const first = verts.begin() + std::ptrdiff_t(3 * face);
    std::vector<int> made(first, first + 3);
    for (auto vert = first + 3; vert != first + 6; ++vert) {
        if (std::find(made.begin(), made.end(), *vert) == made.end()) {
            // Between the two that both have.
            auto const isShared = [&](int v) {
                return std::find(first + 3, first + 6, v) != first + 6;
            };
            std::size_t i = 0;
            while (!isShared(made[i]) || !isShared(made[(i + 1) % 3])) {
                ++i;
            }
            made.insert(made.begin() + std::ptrdiff_t(i) + 1, *vert);
            break;
        }
    }
    verts.erase(first, first + 6);
    verts.insert(verts.begin() + std::ptrdiff_t(3 * face), made.begin(), made.end());
    quad.faceSizes.erase(quad.faceSizes.begin() + std::ptrdiff_t(face));
    quad.faceSizes[face] = 4;
    expectReference(quad);

    Shape hole = makeTriangles();
    hole.name = "hole";
    addCrease(hole, kInfinite);
    hole.holeFaces = {int(face)};
    expectReference(hole);

    // A crease through the next row of vertices: lines are too near for rows of both.
    Shape two = makeTriangles();
    two.name = "lines side by side";
    addCrease(two, std::vector<float>(kWidth, 2.5F));
    for (int column = 0; column < kWidth; ++column) {
        two.creaseVertexPairs.insert(
            two.creaseVertexPairs.end(),
            {vertexAt(column, kRows / 2 + 1), vertexAt(column + 1, kRows / 2 + 1)});
        two.creaseSharpness.push_back(0.75F + float(column) / 4);
    }
    expectReference(two);
}

// A seam beside the crease, and one along part of it.
TEST(LineRow, SeamsEqualReference) {
    constexpr int kLevel = 4;
    Shape shape = makeTriangles();
    addCrease(shape, kInfinite);
    std::vector<int> seam;
    for (int column = 0; column < kWidth; ++column) {
        int const row = column < kWidth / 2 ? kRows / 2 : kRows / 2 - 1;
        seam.insert(seam.end(), {vertexAt(column, row), vertexAt(column + 1, row)});
    }
    shape.fvarChannels = {MakeSeamChannel(shape, seam)};
    expectReference(shape);
    auto const refiner = refine(shape, kLevel, getOptions());
    TaggedMatch const match(shape, *refiner, 0);
    ASSERT_EQ(match.GetError(), "");
    ExpectChannelValuesEqual(*refiner, match, ReferenceMask::Smooth,
                             GetValues(shape.fvarChannels[0]), 0);
}

} // namespace OpenSubdivHex::Regression::lineRowTest
