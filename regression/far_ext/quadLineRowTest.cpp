// SPDX-License-Identifier: Apache-2.0
//
// The masks beside lines of quads: where they apply, and that they are those of the reference there and elsewhere.
#include "expectations.h"

#include "far_ext/rules/quadLine.h"
#include "far_ext/vtr/hierarchy.h"
#include "regression/shapes/featureShapes.h"
#include "regression/shapes/torus.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>
#include <string>
#include <vector>

namespace OpenSubdivHex::Regression::quadLineRowTest {

namespace {

using FarExt::internal::kLineRoles;
using FarExt::internal::kNumLineSteps;
using FarExt::internal::LineRole;
using FarExt::internal::QuadLineCorner;
using OpenSubdiv::Sdc::Crease;

constexpr int kHexagon = 6;
constexpr int kNone = -1;
struct QuadLineTableRow {
    int numQuads;
    char flag;
    char const *path;
    int ofVertex;
    int parts[kHexagon];
};
constexpr QuadLineTableRow kQuadLineTable[] = {
#include "far_ext/rules/quadLineRows.inl"
};

constexpr int kGridWidth = 6; // in quads
int gridVertex(int column, int row) { return row * (kGridWidth + 1) + column; }

/// Quads of the plane without those of \p gaps, moved about so that no weight is lost by symmetry.
Shape makeQuads(std::set<int> const &gaps = {}) {
    Shape shape;
    shape.name = "quads";
    shape.closed = false;
    for (int row = 0; row <= kGridWidth; ++row) {
        for (int column = 0; column <= kGridWidth; ++column) {
            shape.positions.insert(shape.positions.end(), {double(column), double(row), 0.0});
        }
    }
    for (std::size_t i = 0; i < shape.positions.size(); ++i) {
        shape.positions[i] += 0.2 * std::sin(7.0 * double(i * i % 31));
    }
    for (int row = 0; row < kGridWidth; ++row) {
        for (int column = 0; column < kGridWidth; ++column) {
            if (gaps.count(row * kGridWidth + column) == 0) {
                shape.faceSizes.push_back(4);
                shape.faceVertices.insert(shape.faceVertices.end(),
                                          {gridVertex(column, row), gridVertex(column + 1, row),
                                           gridVertex(column + 1, row + 1),
                                           gridVertex(column, row + 1)});
            }
        }
    }
    return shape;
}

/// A crease along a row of vertices.
void addCreaseInRow(Shape &shape, int row, std::vector<float> const &sharpness) {
    for (std::size_t i = 0; i < sharpness.size(); ++i) {
        shape.creaseVertexPairs.insert(shape.creaseVertexPairs.end(),
                                       {gridVertex(int(i), row), gridVertex(int(i) + 1, row)});
        shape.creaseSharpness.push_back(sharpness[i]);
    }
}

void addCreaseInColumn(Shape &shape, int column, float sharpness) {
    for (int row = 0; row < kGridWidth; ++row) {
        shape.creaseVertexPairs.insert(shape.creaseVertexPairs.end(),
                                       {gridVertex(column, row), gridVertex(column, row + 1)});
        shape.creaseSharpness.push_back(sharpness);
    }
}

Sdc::Options edgeOptions(
    Sdc::Options::VtxBoundaryInterpolation boundary = Sdc::Options::VTX_BOUNDARY_EDGE_ONLY) {
    Sdc::Options options;
    options.SetVtxBoundaryInterpolation(boundary);
    return options;
}

void expectSameAsReference(Shape const &shape, Sdc::Options options = edgeOptions()) {
    constexpr int kLevel = 4; // made by the step behind the last with masks of its own
    ExpectMeshEqual(shape, kLevel, options);
}

int countLineCorners(Shape const &shape, int level, LineRole role) {
    auto const refiner = CreateRefiner(shape, ReferenceMask::Smooth, kNumLineSteps, edgeOptions());
    auto const &corners = refiner->GetHierarchy().mesh.levels[std::size_t(level)].quadLineCorners;
    return int(std::count_if(corners.begin(), corners.end(), [role](QuadLineCorner const &corner) {
        return corner.flags.outLines[int(role)].GetShare() > 0;
    }));
}

} // namespace

TEST(QuadLineRow, WeightsAreNotNegative) {
    for (QuadLineTableRow const &row : kQuadLineTable) {
        SCOPED_TRACE(std::to_string(row.numQuads) + row.flag + row.path);
        EXPECT_TRUE(row.ofVertex == kNone || row.ofVertex > 0);
        EXPECT_TRUE(
            std::all_of(row.parts, row.parts + kHexagon, [](int part) { return part >= 0; }));
        EXPECT_EQ(std::accumulate(row.parts, row.parts + kHexagon, 0), 4096);
    }
}

TEST(QuadLineRow, LieInTheFirstRow) {
    // Without lines there are none.
    Shape const torus = MakeTorus(8, 6, TorusFaces::Quads);
    for (int level = 0; level <= kNumLineSteps; ++level) {
        for (LineRole const role : kLineRoles) {
            EXPECT_EQ(countLineCorners(torus, level, role), 0);
        }
    }
    // At the border of a grid: five vertices of each side have two quads; and at the other ends of their edges two corners
    // each, but none in the grid's corner quads.
    Shape const grid = makeQuads();
    EXPECT_EQ(countLineCorners(grid, 0, LineRole::At), 4 * 2 * 5);
    EXPECT_EQ(countLineCorners(grid, 0, LineRole::Away), 4 * (2 * 5 - 2));
    EXPECT_EQ(countLineCorners(grid, kNumLineSteps, LineRole::At), 0);
}

TEST(QuadLineRow, LinesStayInTheFirstStep) {
    // V' = V between A edges; then (98 V + 15 V_l + 15 V_r)/128 between B edges.
    Shape const shape = makeQuads();
    auto const refiner = CreateRefiner(shape, ReferenceMask::Smooth, 2, edgeOptions());
    ReferenceValues const base = GetPositions(shape);
    auto const levels = InterpolateLevels(*refiner, base);
    for (int i = 1; i < kGridWidth; ++i) {
        EXPECT_EQ(levels[1].row(gridVertex(i, 0)), base.row(gridVertex(i, 0)));
        Eigen::RowVectorXd const expected =
            (98 * base.row(gridVertex(i, 0)) + 15 * base.row(gridVertex(i - 1, 0)) +
             15 * base.row(gridVertex(i + 1, 0))) /
            128;
        EXPECT_LT((levels[2].row(gridVertex(i, 0)) - expected).norm(), 1e-14);
    }
}

TEST(QuadLineRow, BordersEqualReference) {
    for (auto boundary :
         {Sdc::Options::VTX_BOUNDARY_EDGE_ONLY, Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER}) {
        Sdc::Options const options = edgeOptions(boundary);
        expectSameAsReference(makeQuads(), options);
        // Vertices with one, three and four quads, between which there are rows one and two quads wide.
        expectSameAsReference(makeQuads({0}), options);
        expectSameAsReference(makeQuads({0, 1, 2, 6, 7, 8, 35}), options);
        expectSameAsReference(makeQuads({14}), options);
        expectSameAsReference(makeQuads({0, 1, 6, 7, 14, 20, 21}), options);
    }
}

TEST(QuadLineRow, CreasesEqualReference) {
    for (float const sharpness : {Crease::SHARPNESS_INFINITE, 2.0f, 1.3f, 0.4f}) {
        SCOPED_TRACE(sharpness);
        Shape shape = makeQuads();
        addCreaseInRow(shape, 3, std::vector<float>(kGridWidth, sharpness));
        expectSameAsReference(shape);
        // One row away from a border, and two lines that cross.
        addCreaseInRow(shape, 1, std::vector<float>(kGridWidth, 1.7f));
        expectSameAsReference(shape);
        addCreaseInColumn(shape, 4, 0.6f);
        expectSameAsReference(shape);
    }
    // One that ends, and gets sharper.
    Shape shape = makeQuads();
    addCreaseInRow(shape, 2, {0.3f, 1.2f, 2.5f, 0.7f});
    expectSameAsReference(shape);
    shape.cornerVertices = {gridVertex(2, 2), gridVertex(1, 3)};
    shape.cornerSharpness = {0.6f, 1.4f};
    expectSameAsReference(shape);
}

// Two quads beside a crease that meet its other side at a free border alone are no side of two quads.
TEST(QuadLineRow, SidesEndAtFreeBorders) {
    Shape shape;
    shape.name = "a triangle between two quads";
    shape.closed = false;
    shape.positions = {1,   2, 0.3,  2,   2.2, -0.1, -1,  2,  0.2, 0,   0,
                       0.5, 2, -0.2, 0.1, -2,  1.8,  0.4, -2, 0,   -0.3};
    shape.faceSizes = {3, 4, 4};
    shape.faceVertices = {0, 2, 3, 3, 4, 1, 0, 2, 5, 6, 3};
    shape.creaseVertexPairs = {0, 3, 2, 3};
    for (float const sharpness : {Crease::SHARPNESS_INFINITE, 2.25f}) {
        shape.creaseSharpness = {Crease::SHARPNESS_INFINITE, sharpness};
        expectSameAsReference(shape, edgeOptions(Sdc::Options::VTX_BOUNDARY_NONE));
    }
}

} // namespace OpenSubdivHex::Regression::quadLineRowTest
