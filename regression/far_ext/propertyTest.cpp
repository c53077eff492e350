// SPDX-License-Identifier: Apache-2.0
//
// Properties at boundaries and creases, whatever the rules are in detail: no reference.
#include "properties.h"

#include "regression/reference/largestValue.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

namespace OpenSubdivHex::Regression::propertyTest {

using FarExt::TopologyLevel;
using FarExt::TopologyRefiner;

namespace {

using IndexArray = Far::ConstIndexArray;

/// The largest distance from a point of one set to the nearest of the other, both ways.
double distance(ReferenceValues const &a, ReferenceValues const &b) {
    if (!a.allFinite() || !b.allFinite()) {
        return std::numeric_limits<double>::infinity();
    }
    double largest = 0;
    for (Eigen::Index i = 0; i < a.rows(); ++i) {
        largest = std::max(largest, (b.rowwise() - a.row(i)).rowwise().squaredNorm().minCoeff());
    }
    for (Eigen::Index i = 0; i < b.rows(); ++i) {
        largest = std::max(largest, (a.rowwise() - b.row(i)).rowwise().squaredNorm().minCoeff());
    }
    return std::sqrt(largest);
}

/// Vertices along the boundary from \p start on, until \p end.
std::vector<int> walkBoundary(TopologyLevel const &level, int start, int end) {
    std::vector<int> walk{start};
    while (walk.back() != end && int(walk.size()) <= level.GetNumVertices()) {
        int const edge = level.GetVertexEdges(walk.back())[0];
        IndexArray const verts = level.GetEdgeVertices(edge);
        walk.push_back(verts[0] == walk.back() ? verts[1] : verts[0]);
    }
    return walk;
}

int numberOfFans(TopologyLevel const &level, int vert) {
    int const numBoundaries = level.GetVertexEdges(vert).size() - level.GetVertexFaces(vert).size();
    return std::max(1, numBoundaries);
}

} // namespace

/// Every face of every level is a regular hexagon of the right size, or half of one.
void expectRegularHexagons(TopologyRefiner const &refiner,
                           std::vector<ReferenceValues> const &levels) {
    for (int depth = 1; depth < int(levels.size()); ++depth) {
        SCOPED_TRACE("level " + std::to_string(depth));
        TopologyLevel const &level = refiner.GetLevel(depth);
        double const size = std::ldexp(1.0, -depth);
        for (int f = 0; f < level.GetNumFaces(); ++f) {
            IndexArray const verts = level.GetFaceVertices(f);
            Eigen::RowVector3d const last = levels[depth].row(verts[verts.size() - 1]);
            Eigen::RowVector3d const first = levels[depth].row(verts[0]);
            Eigen::RowVector3d const second = levels[depth].row(verts[1]);
            Eigen::RowVector3d forward = second - first;
            Eigen::RowVector3d const back = last - first;
            // The first edge's direction, and the corner's angle: 120 degrees, 60 of half a one.
            bool const isHalf = level.IsFaceHalf(f);
            ASSERT_EQ(verts.size(), isHalf ? 4 : 6);
            ASSERT_NEAR(forward.norm(), isHalf ? 2 * size : size, 1e-12);
            forward = forward.normalized() * size;
            double const angle = std::acos(-1.0) * (isHalf ? 1 : 2) / 3;
            Eigen::RowVector3d const turned(
                forward[0] * std::cos(angle) - forward[1] * std::sin(angle),
                forward[0] * std::sin(angle) + forward[1] * std::cos(angle), 0);
            ASSERT_LT((turned - back).norm(), 1e-12) << "face " << f;
        }
    }
}

TEST(Property, RegularHexagonStaysRegularToItsStraightBorder) {
    // The lattice of half the size: its border is straight along edges and across hexagons.
    for (ReferenceMask mask : {ReferenceMask::Cosine, ReferenceMask::Smooth}) {
        Shape const shape = MakeTiling(Tiling::Hexagons, 1, 1);
        auto const refiner = CreateRefiner(shape, mask, 5, MakeBoundaryOptions(kEdgeAndCorner));
        expectRegularHexagons(*refiner, InterpolateLevels(*refiner, GetPositions(shape)));
    }
}

TEST(Property, RegularHexagonsStayRegularBesideStraightCreases) {
    for (ReferenceMask mask : {ReferenceMask::Cosine, ReferenceMask::Smooth}) {
        Shape shape = MakeTiling(Tiling::Hexagons, 3, 3);
        Shape const &creased = GetFeatureShape("allSemiSharpHexagons");
        shape.creaseVertexPairs = creased.creaseVertexPairs;
        shape.creaseSharpness.assign(creased.creaseSharpness.size(), kInfinite);
        for (int v = 0; v < shape.GetNumVertices(); ++v) {
            shape.cornerVertices.push_back(v);
            shape.cornerSharpness.push_back(kInfinite);
        }
        auto const refiner = CreateRefiner(shape, mask, 4, MakeBoundaryOptions(kEdgeAndCorner));
        auto const levels = InterpolateLevels(*refiner, GetPositions(shape));
        expectRegularHexagons(*refiner, levels);
    }
}

TEST(Property, InteriorOfRegularTilingsStaysRegular) {
    // Vertices of the base whose neighbourhood is regular stay where they are.
    for (Tiling tiling : {Tiling::Triangles, Tiling::Quads, Tiling::Hexagons}) {
        for (ReferenceMask mask : kMasks) {
            for (auto rule : {kNone, kEdgeOnly, kEdgeAndCorner}) {
                Shape const shape = MakeTiling(tiling, 8, 8);
                auto const refiner = CreateRefiner(shape, mask, 2, MakeBoundaryOptions(rule));
                auto const levels = InterpolateLevels(*refiner, GetPositions(shape));
                TopologyLevel const &base = refiner->GetLevel(0);
                // Two rings away from the border: what it does reaches one ring a level.
                std::set<int> near;
                for (int v = 0; v < base.GetNumVertices(); ++v) {
                    if (base.IsVertexBoundary(v)) {
                        near.insert(v);
                    }
                }
                for (int ring = 0; ring < 2; ++ring) {
                    std::set<int> grown = near;
                    for (int v : near) {
                        for (int f : base.GetVertexFaces(v)) {
                            IndexArray const verts = base.GetFaceVertices(f);
                            grown.insert(verts.begin(), verts.end());
                        }
                    }
                    near = grown;
                }
                int numRegular = 0;
                for (int v = 0; v < base.GetNumVertices(); ++v) {
                    if (near.count(v) == 0) {
                        ++numRegular;
                        for (auto const &level : levels) {
                            ASSERT_LT((level.row(v) - levels[0].row(v)).norm(), 1e-14);
                        }
                    }
                }
                EXPECT_GT(numRegular, 4);
            }
        }
    }
}

TEST(Property, LinearFunctionsStayLinear) {
    ForEachFeature([](Shape const &shape, Sdc::Options options) {
        for (ReferenceMask mask : kMasks) {
            auto const refiner = CreateRefiner(shape, mask, GetTestLevel(shape, 3, 3000), options);
            ReferenceValues values(shape.GetNumVertices(), 4);
            auto const function = [](auto const &p) {
                return (0.3 * p.col(0) - 1.7 * p.col(1) + 0.9 * p.col(2)).array() + 2.5;
            };
            values.leftCols(3) = GetPositions(shape);
            values.col(3) = function(values).matrix();
            for (auto const &level : InterpolateLevels(*refiner, values)) {
                ASSERT_LT(GetLargestValue(level.col(3).array() - function(level)),
                          1e-13 * (1 + GetSize(values)));
            }
        }
    });
}

TEST(Property, StraightBordersStayStraight) {
    constexpr int n = 5;
    for (Tiling tiling : {Tiling::Triangles, Tiling::Quads}) {
        for (ReferenceMask mask : kMasks) {
            Shape shape = MakeTiling(tiling, n, 3);
            // One corner of the triangle grid has two faces.
            shape.cornerVertices = {0, n};
            shape.cornerSharpness = {kInfinite, kInfinite};
            // The inside is anywhere.
            for (int v = n + 1; v < shape.GetNumVertices(); ++v) {
                for (int k = 0; k < 3; ++k) {
                    shape.positions[3 * v + k] += 0.3 * std::sin(3.1 * v + k);
                }
            }
            auto const refiner = CreateRefiner(shape, mask, 4, MakeBoundaryOptions(kEdgeOnly));
            auto const levels = InterpolateLevels(*refiner, GetPositions(shape));
            int const numEdges[5] = {1, 1, 3, 5, 11};
            for (int depth = 0; depth <= 4; ++depth) {
                auto const walk = walkBoundary(refiner->GetLevel(depth), 0, n);
                ASSERT_EQ(int(walk.size()), n * numEdges[depth] + 1);
                // Edges of phase A are half as long as those of phase B; all are evenly long.
                double x = 0;
                for (std::size_t i = 0; i < walk.size(); ++i) {
                    ASSERT_NEAR(levels[depth](walk[i], 0), x, 1e-14) << "level " << depth;
                    ASSERT_NEAR(levels[depth](walk[i], 1), 0, 1e-14);
                    ASSERT_NEAR(levels[depth](walk[i], 2), 0, 1e-14);
                    if (i + 1 < walk.size()) {
                        int const edge = refiner->GetLevel(depth).GetVertexEdges(walk[i])[0];
                        int const face = refiner->GetLevel(depth).GetEdgeFaces(edge)[0];
                        bool const isB = refiner->GetLevel(depth).IsFaceHalf(face);
                        x += std::ldexp(depth == 0 || isB ? 1.0 : 0.5, -std::max(0, depth - 1));
                    }
                }
                ASSERT_NEAR(x, n, 1e-12);
            }
        }
    }
}

TEST(Property, BorderDependsOnBorderVerticesAlone) {
    for (Shape const &shape : GetFeatureShapes()) {
        for (auto rule : {kEdgeOnly, kEdgeAndCorner}) {
            SCOPED_TRACE(shape.name);
            int const numLevels = GetTestLevel(shape, 3, 20000);
            auto const refiner =
                CreateRefiner(shape, ReferenceMask::Average, numLevels, MakeBoundaryOptions(rule));
            bool hasSemiSharpCorner = false;
            for (float sharpness : shape.cornerSharpness) {
                hasSemiSharpCorner |= sharpness < kInfinite;
            }
            Shape moved = shape;
            for (int v = 0; v < shape.GetNumVertices(); ++v) {
                if (!refiner->GetLevel(0).IsVertexBoundary(v)) {
                    for (int k = 0; k < 3; ++k) {
                        moved.positions[3 * v + k] += 0.25 + 0.125 * (v % 5) + 0.5 * k;
                    }
                }
            }
            auto const levels = InterpolateLevels(*refiner, GetPositions(shape));
            auto const movedLevels = InterpolateLevels(*refiner, GetPositions(moved));
            for (int depth = 1; depth <= numLevels; ++depth) {
                TopologyLevel const &level = refiner->GetLevel(depth);
                for (int v = 0; v < level.GetNumVertices(); ++v) {
                    // A crease that meets the border makes a corner of it, as in Far, never more.
                    if (level.IsVertexBoundary(v)) {
                        ASSERT_EQ(levels[depth].row(v), movedLevels[depth].row(v))
                            << "level " << depth << ", vertex " << v << hasSemiSharpCorner;
                    }
                }
            }
        }
    }
}

TEST(Property, PatchesThatShareABorderLineRefineToTheSame) {
    constexpr int n = 4;
    for (ReferenceMask mask : kMasks) {
        // Quads, triangles, and quads on the other side, which run the line backwards.
        std::vector<Shape> shapes{MakeTiling(Tiling::Quads, n, 2),
                                  MakeTiling(Tiling::Triangles, n, 3),
                                  MakeTiling(Tiling::Quads, n, 1)};
        for (int &v : shapes[2].faceVertices) {
            v = v > n ? v : n - v;
        }
        for (int v = 0; v <= n; ++v) {
            for (int k = 0; k < 3; ++k) {
                double const value = std::sin(2.1 * v * v + 1.3 * k) + (k == 0 ? v : 0);
                shapes[0].positions[3 * v + k] = value;
                shapes[1].positions[3 * v + k] = value;
                shapes[2].positions[3 * v + k] = value;
            }
        }
        for (int v = n + 1; v <= 2 * n + 1; ++v) {
            shapes[2].positions[3 * v + 1] *= -1;
        }
        std::vector<std::vector<ReferenceValues>> borders;
        for (Shape &shape : shapes) {
            shape.cornerVertices = {0, n};
            shape.cornerSharpness = {kInfinite, kInfinite};
            bool const isReversed = &shape == &shapes[2];
            auto const refiner = CreateRefiner(shape, mask, 4, MakeBoundaryOptions(kEdgeOnly));
            auto const levels = InterpolateLevels(*refiner, GetPositions(shape));
            borders.emplace_back();
            for (int depth = 0; depth <= 4; ++depth) {
                auto walk =
                    walkBoundary(refiner->GetLevel(depth), isReversed ? n : 0, isReversed ? 0 : n);
                if (isReversed) {
                    std::reverse(walk.begin(), walk.end());
                }
                ReferenceValues points(walk.size(), 3);
                for (std::size_t i = 0; i < walk.size(); ++i) {
                    points.row(i) = levels[depth].row(walk[i]);
                }
                borders.back().push_back(points);
            }
        }
        for (int depth = 0; depth <= 4; ++depth) {
            for (int other : {1, 2}) {
                ASSERT_EQ(borders[0][depth].rows(), borders[other][depth].rows());
                EXPECT_LT(GetLargestValue(borders[0][depth] - borders[other][depth]), 1e-14);
            }
        }
    }
}

namespace {

/// The part of a shape that lies in the faces for which \p isIn; vertices keep their numbers.
Shape part(Shape const &shape, std::vector<bool> const &isIn) {
    Shape result = shape;
    result.faceSizes.clear();
    result.faceVertices.clear();
    result.creaseVertexPairs.clear();
    result.creaseSharpness.clear();
    int first = 0;
    for (int f = 0; f < shape.GetNumFaces(); ++f) {
        if (isIn[f]) {
            result.faceSizes.push_back(shape.faceSizes[f]);
            result.faceVertices.insert(result.faceVertices.end(),
                                       shape.faceVertices.begin() + first,
                                       shape.faceVertices.begin() + first + shape.faceSizes[f]);
        }
        first += shape.faceSizes[f];
    }
    return result;
}

/// The points of the vertices that have a face.
ReferenceValues usedPoints(TopologyLevel const &level, ReferenceValues const &points) {
    ReferenceValues used(points.rows(), points.cols());
    Eigen::Index count = 0;
    for (int v = 0; v < level.GetNumVertices(); ++v) {
        if (level.GetVertexFaces(v).size() > 0) {
            used.row(count++) = points.row(v);
        }
    }
    return used.topRows(count);
}

/// Refines a shape, all of whose creases are infinite, as one and as the parts they divide it in.
void expectCreasesAreBorders(Shape const &shape, ReferenceMask mask, int numLevels) {
    auto const whole = CreateRefiner(shape, mask, numLevels, MakeBoundaryOptions(kEdgeOnly));
    auto const wholeLevels = InterpolateLevels(*whole, GetPositions(shape));
    TopologyLevel const &base = whole->GetLevel(0);
    std::vector<int> region(shape.GetNumFaces(), -1);
    int numRegions = 0;
    for (int seed = 0; seed < shape.GetNumFaces(); ++seed) {
        if (region[seed] >= 0) {
            continue;
        }
        std::vector<int> faces{seed};
        region[seed] = numRegions;
        while (!faces.empty()) {
            int const face = faces.back();
            faces.pop_back();
            for (int edge : base.GetFaceEdges(face)) {
                for (int other : base.GetEdgeFaces(edge)) {
                    if (region[other] < 0 && base.GetEdgeSharpness(edge) == 0) {
                        region[other] = numRegions;
                        faces.push_back(other);
                    }
                }
            }
        }
        ++numRegions;
    }
    ASSERT_GE(numRegions, 2);
    std::vector<ReferenceValues> joined(numLevels + 1, ReferenceValues(0, 3));
    for (int r = 0; r < numRegions; ++r) {
        std::vector<bool> isIn(shape.GetNumFaces());
        for (int f = 0; f < shape.GetNumFaces(); ++f) {
            isIn[f] = region[f] == r;
        }
        Shape const piece = part(shape, isIn);
        auto const refiner = CreateRefiner(piece, mask, numLevels, MakeBoundaryOptions(kEdgeOnly));
        auto const levels = InterpolateLevels(*refiner, GetPositions(piece));
        for (int depth = 0; depth <= numLevels; ++depth) {
            ReferenceValues const points = usedPoints(refiner->GetLevel(depth), levels[depth]);
            ReferenceValues all(joined[depth].rows() + points.rows(), 3);
            all << joined[depth], points;
            joined[depth] = all;
        }
    }
    for (int depth = 0; depth <= numLevels; ++depth) {
        EXPECT_LT(distance(wholeLevels[depth], joined[depth]), 1e-13) << "level " << depth;
    }
}

} // namespace

TEST(Property, CreasesAreTheBordersOfTheirSides) {
    for (ReferenceMask mask : kMasks) {
        expectCreasesAreBorders(GetFeatureShape("creaseLoopClosed"), mask, 4);
        Shape bipyramid = GetShape("bipyramid360");
        bipyramid = GetFeatureShape("wideSectors");
        for (char const *name : {"creaseMeetsBorderQuads", "creaseMeetsBorderTriangles",
                                 "creaseLoopQuads", "creaseLoopTriangles"}) {
            SCOPED_TRACE(name);
            Shape shape = GetFeatureShape(name);
            // Ends on the border are corners of the whole, though of the parts they are not.
            std::map<int, int> uses;
            for (int v : shape.creaseVertexPairs) {
                ++uses[v];
            }
            for (auto const &[v, count] : uses) {
                if (count == 1) {
                    shape.cornerVertices.push_back(v);
                    shape.cornerSharpness.push_back(kInfinite);
                }
            }
            expectCreasesAreBorders(shape, mask, 3);
        }
        expectCreasesAreBorders(GetFeatureShape("allCreases"), mask, 0);
        Shape cube = GetFeatureShape("allCreases");
        for (int v = 0; v < 8; ++v) {
            cube.cornerVertices.push_back(v);
            cube.cornerSharpness.push_back(kInfinite);
        }
        expectCreasesAreBorders(cube, mask, 4);
    }
}

TEST(Property, ValencesAreBounded) {
    ForEachFeature([](Shape const &shape, Sdc::Options options) {
        auto const refiner =
            CreateRefiner(shape, ReferenceMask::Average, GetTestLevel(shape, 4, 30000), options);
        TopologyLevel const &base = refiner->GetLevel(0);
        for (int depth = 1; depth <= refiner->GetMaxLevel(); ++depth) {
            TopologyLevel const &level = refiner->GetLevel(depth);
            for (int v = 0; v < level.GetNumVertices(); ++v) {
                // The paper's rule adds a border face to a border vertex at every level.
                bool const isFree = options.GetVtxBoundaryInterpolation() == kNone;
                int const growth =
                    (v < base.GetNumVertices() ? numberOfFans(base, v) : 0) * (isFree ? depth : 1);
                int const bound =
                    v < base.GetNumVertices() ? base.GetVertexEdges(v).size() + growth : 3;
                ASSERT_LE(level.GetVertexEdges(v).size(), bound) << "level " << depth;
            }
        }
    });
}

TEST(Property, BoundaryEdgesDoubleAndEulerCharacteristicIsKept) {
    ForEachFeature([](Shape const &shape, Sdc::Options options) {
        auto const refiner =
            CreateRefiner(shape, ReferenceMask::Average, GetTestLevel(shape, 4, 30000), options);
        TopologyLevel const &base = refiner->GetLevel(0);
        int const euler = base.GetNumVertices() - base.GetNumEdges() + base.GetNumFaces();
        int const factors[] = {1, 1, 3, 5, 11};
        int numFree = 0;
        for (int e = 0; e < base.GetNumEdges(); ++e) {
            numFree += base.IsEdgeBoundary(e) && base.GetEdgeSharpness(e) == 0;
        }
        int const numSharp = base.GetNumBoundaryEdges() - numFree;
        if (options.GetVtxBoundaryInterpolation() != kNone) {
            ASSERT_EQ(numFree, 0);
        }
        for (int depth = 0; depth <= refiner->GetMaxLevel(); ++depth) {
            TopologyLevel const &level = refiner->GetLevel(depth);
            EXPECT_EQ(level.GetNumVertices() - level.GetNumEdges() + level.GetNumFaces(), euler);
            EXPECT_EQ(level.GetNumBoundaryEdges(), numFree + factors[depth] * numSharp);
        }
    });
}

TEST(Property, EveryLevelIsValid) {
    ForEachFeature([](Shape const &shape, Sdc::Options options) {
        auto const refiner =
            CreateRefiner(shape, ReferenceMask::Average, GetTestLevel(shape, 4, 40000), options);
        for (int depth = 0; depth <= refiner->GetMaxLevel(); ++depth) {
            FarExt::CallStatus status;
            ASSERT_TRUE(refiner->GetLevel(depth).Validate(&status)) << status.GetErrorMessage();
        }
    });
}

} // namespace OpenSubdivHex::Regression::propertyTest
