// SPDX-License-Identifier: Apache-2.0
//
// What must hold at boundaries, creases and seams whatever the rules are in detail: no reference.
#include "referenceMatch.h"
#include "valueLevels.h"

#include "far_ext/stencilTableFactory.h"
#include "regression/shapes/featureShapes.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <deque>
#include <map>
#include <numeric>
#include <set>

namespace OpenSubdivHex::Regression {

using FarExt::TopologyLevel;
using FarExt::TopologyRefiner;

namespace {

using IndexArray = Far::ConstIndexArray;

constexpr auto kNone = Sdc::Options::VTX_BOUNDARY_NONE;
constexpr auto kEdgeOnly = Sdc::Options::VTX_BOUNDARY_EDGE_ONLY;
constexpr auto kEdgeAndCorner = Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER;
constexpr float kInfinite = 10;

Sdc::Options boundary(Sdc::Options::VtxBoundaryInterpolation rule) {
    Sdc::Options options;
    options.SetVtxBoundaryInterpolation(rule);
    return options;
}

/// Calls check(shape, options) for each feature shape, boundary rule and creasing method.
template <typename CHECK>
void forEachFeature(CHECK const &check) {
    for (Shape const &shape : GetFeatureShapes()) {
        for (auto rule : {kNone, kEdgeOnly, kEdgeAndCorner}) {
            for (auto method : {Sdc::Options::CREASE_UNIFORM, Sdc::Options::CREASE_CHAIKIN}) {
                SCOPED_TRACE(testing::Message()
                             << shape.name << ", boundary " << rule << ", creases " << method);
                Sdc::Options options = boundary(rule);
                options.SetCreasingMethod(method);
                check(shape, options);
                if (testing::Test::HasFatalFailure()) {
                    return;
                }
            }
        }
    }
}

std::vector<ReferenceValues> refinePositions(Shape const &shape, ReferenceMask mask, int numLevels,
                                             Sdc::Options options) {
    return InterpolateLevels(*CreateRefiner(shape, mask, numLevels, options), GetPositions(shape));
}

/// The largest distance from a point of one set to the nearest of the other, both ways.
double distance(ReferenceValues const &a, ReferenceValues const &b) {
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
        auto const refiner = CreateRefiner(shape, mask, 5, boundary(kEdgeAndCorner));
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
        auto const refiner = CreateRefiner(shape, mask, 4, boundary(kEdgeAndCorner));
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
                auto const refiner = CreateRefiner(shape, mask, 2, boundary(rule));
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
    forEachFeature([](Shape const &shape, Sdc::Options options) {
        for (ReferenceMask mask : kMasks) {
            auto const refiner = CreateRefiner(shape, mask, GetTestLevel(shape, 3, 3000), options);
            ReferenceValues values(shape.GetNumVertices(), 4);
            auto const function = [](auto const &p) {
                return (0.3 * p.col(0) - 1.7 * p.col(1) + 0.9 * p.col(2)).array() + 2.5;
            };
            values.leftCols(3) = GetPositions(shape);
            values.col(3) = function(values).matrix();
            for (auto const &level : InterpolateLevels(*refiner, values)) {
                ASSERT_LT((level.col(3).array() - function(level)).abs().maxCoeff(),
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
            auto const refiner = CreateRefiner(shape, mask, 4, boundary(kEdgeOnly));
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
                CreateRefiner(shape, ReferenceMask::Average, numLevels, boundary(rule));
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
            auto const refiner = CreateRefiner(shape, mask, 4, boundary(kEdgeOnly));
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
                EXPECT_LT((borders[0][depth] - borders[other][depth]).cwiseAbs().maxCoeff(), 1e-14);
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
    auto const whole = CreateRefiner(shape, mask, numLevels, boundary(kEdgeOnly));
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
        auto const refiner = CreateRefiner(piece, mask, numLevels, boundary(kEdgeOnly));
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
    forEachFeature([](Shape const &shape, Sdc::Options options) {
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
    forEachFeature([](Shape const &shape, Sdc::Options options) {
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

TEST(Property, SharpnessTwoIsSharpForTwoLevels) {
    for (char const *name :
         {"creaseLoopClosed", "creaseLoopQuads", "creaseLoopTriangles", "crossingQuads",
          "creaseMeetsBorderTriangles", "junctionQuads", "wideSectors", "cornersQuads"}) {
        for (ReferenceMask mask : kMasks) {
            for (auto method : {Sdc::Options::CREASE_UNIFORM, Sdc::Options::CREASE_CHAIKIN}) {
                SCOPED_TRACE(name);
                Shape infinite = GetFeatureShape(name);
                std::fill(infinite.creaseSharpness.begin(), infinite.creaseSharpness.end(),
                          kInfinite);
                std::fill(infinite.cornerSharpness.begin(), infinite.cornerSharpness.end(),
                          kInfinite);
                Shape two = infinite;
                std::fill(two.creaseSharpness.begin(), two.creaseSharpness.end(), 2.0f);
                std::fill(two.cornerSharpness.begin(), two.cornerSharpness.end(), 2.0f);
                Shape smooth = infinite;
                smooth.creaseVertexPairs.clear();
                smooth.creaseSharpness.clear();
                smooth.cornerVertices.clear();
                smooth.cornerSharpness.clear();
                Sdc::Options options = boundary(kEdgeOnly);
                options.SetCreasingMethod(method);
                auto const infiniteLevels = refinePositions(infinite, mask, 3, options);
                auto const refiner = CreateRefiner(two, mask, 3, options);
                auto const levels = InterpolateLevels(*refiner, GetPositions(two));
                EXPECT_EQ(levels[1], infiniteLevels[1]);
                EXPECT_EQ(levels[2], infiniteLevels[2]);
                EXPECT_GT((levels[3] - infiniteLevels[3]).norm(), 1e-5);
                // From there on it is smooth.
                auto const smoothRefiner = CreateRefiner(smooth, mask, 3, options);
                FarExt::PrimvarRefinerReal<double> const primvarRefiner(*smoothRefiner);
                std::vector<ValueRow<double>> src(levels[2].rows());
                std::vector<ValueRow<double>> dst(levels[3].rows());
                for (Eigen::Index i = 0; i < levels[2].rows(); ++i) {
                    src[i].value = levels[2].row(i).array();
                }
                for (auto &row : dst) {
                    row.value.resize(3);
                }
                primvarRefiner.Interpolate(3, src, dst);
                for (Eigen::Index i = 0; i < levels[3].rows(); ++i) {
                    ASSERT_EQ(levels[3].row(i), dst[i].value.matrix());
                }
                TopologyLevel const &last = refiner->GetLevel(3);
                for (int f = 0; f < last.GetNumFaces(); ++f) {
                    ASSERT_EQ(last.GetFaceDiagonalSharpness(f), 0);
                }
                for (int e = 0; e < last.GetNumEdges(); ++e) {
                    ASSERT_EQ(last.GetEdgeSharpness(e), last.IsEdgeBoundary(e) ? kInfinite : 0);
                }
            }
        }
    }
}

namespace {

/// The vertices around \p start in an order that depends on the topology alone, up to \p numRings
/// rings of faces away: breadth-first, each face from where it was entered, from the first
/// boundary edge on.
std::vector<int> neighborhood(TopologyLevel const &level, int start, int numRings) {
    struct Entry {
        int face;
        int place;
        int ring;
    };
    std::vector<int> vertices;
    std::set<int> seen;
    std::set<int> seenFaces;
    std::deque<Entry> queue{
        {level.GetVertexFaces(start)[0], level.GetVertexFaceLocalIndices(start)[0], 0}};
    std::map<int, int> ringOf{{start, 0}};
    seenFaces.insert(queue.front().face);
    while (!queue.empty()) {
        Entry const entry = queue.front();
        queue.pop_front();
        IndexArray const verts = level.GetFaceVertices(entry.face);
        IndexArray const edges = level.GetFaceEdges(entry.face);
        int nearest = numRings;
        for (int v : verts) {
            if (ringOf.count(v) != 0) {
                nearest = std::min(nearest, ringOf[v]);
            }
        }
        if (nearest >= numRings) {
            continue;
        }
        for (int i = 0; i < verts.size(); ++i) {
            int const v = verts[(entry.place + i) % verts.size()];
            ringOf.try_emplace(v, nearest + 1);
            if (seen.insert(v).second) {
                vertices.push_back(v);
            }
        }
        for (int i = 0; i < verts.size(); ++i) {
            int const edge = edges[(entry.place + i) % verts.size()];
            if (level.IsEdgeBoundary(edge)) {
                continue;
            }
            int const side = level.GetEdgeFaces(edge)[0] == entry.face ? 1 : 0;
            int const face = level.GetEdgeFaces(edge)[side];
            if (seenFaces.insert(face).second) {
                // Around the start first: its faces must be entered in order.
                Entry const next{face, level.GetEdgeFaceLocalIndices(edge)[side], 0};
                if (level.GetFaceVertices(face).FindIndex(start) >= 0) {
                    queue.push_front(next);
                } else {
                    queue.push_back(next);
                }
            }
        }
    }
    return vertices;
}

/// The eigenvalues by size of two steps at a border vertex of \p numFaces triangles, for data that
/// is zero along the border.
std::vector<double> crossEigenvalues(ReferenceMask mask, int numFaces) {
    // A fan within a ring of quads, so that other borders are far.
    Shape shape;
    shape.positions = {0, 0, 0};
    for (int ring = 1; ring <= 2; ++ring) {
        for (int i = 0; i <= numFaces; ++i) {
            double const angle = std::acos(-1.0) * i / numFaces;
            shape.positions.insert(shape.positions.end(),
                                   {ring * std::cos(angle), ring * std::sin(angle), 0});
        }
    }
    for (int i = 0; i < numFaces; ++i) {
        int const outer = numFaces + 2 + i;
        shape.faceSizes.insert(shape.faceSizes.end(), {3, 4});
        shape.faceVertices.insert(shape.faceVertices.end(), {0, 1 + i, 2 + i});
        shape.faceVertices.insert(shape.faceVertices.end(), {1 + i, outer, outer + 1, 2 + i});
    }
    int const first = 3;
    auto const refiner = CreateRefiner(shape, mask, first + 2, boundary(kEdgeOnly));
    std::vector<int> const from = neighborhood(refiner->GetLevel(first), 0, 2);
    std::vector<int> const to = neighborhood(refiner->GetLevel(first + 2), 0, 2);
    EXPECT_EQ(from.size(), to.size());
    if (from.size() != to.size()) {
        return {};
    }
    std::vector<int> inner; // places of the vertices inside
    for (std::size_t i = 0; i < from.size(); ++i) {
        bool const isInside = !refiner->GetLevel(first).IsVertexBoundary(from[i]);
        EXPECT_EQ(isInside, !refiner->GetLevel(first + 2).IsVertexBoundary(to[i]));
        if (isInside) {
            inner.push_back(int(i));
        }
    }
    auto const n = Eigen::Index(inner.size());
    FarExt::PrimvarRefinerReal<double> const primvarRefiner(*refiner);
    ValueRow<double> const zero{Eigen::Array<double, 1, Eigen::Dynamic>::Zero(n)};
    std::vector<ValueRow<double>> src(refiner->GetLevel(first).GetNumVertices(), zero);
    for (Eigen::Index i = 0; i < n; ++i) {
        src[from[inner[i]]].value[i] = 1;
    }
    for (int level = first + 1; level <= first + 2; ++level) {
        std::vector<ValueRow<double>> dst(refiner->GetLevel(level).GetNumVertices(), zero);
        primvarRefiner.Interpolate(level, src, dst);
        src = std::move(dst);
    }
    Eigen::MatrixXd matrix(n, n);
    for (Eigen::Index i = 0; i < n; ++i) {
        matrix.row(i) = src[to[inner[i]]].value.matrix();
    }
    std::vector<double> sizes;
    Eigen::VectorXcd const eigenvalues =
        Eigen::EigenSolver<Eigen::MatrixXd>(matrix, false).eigenvalues();
    for (auto const &value : eigenvalues) {
        sizes.push_back(std::sqrt(std::abs(value)));
    }
    std::sort(sizes.rbegin(), sizes.rend());
    return sizes;
}

} // namespace

TEST(Property, WideSectorsConvergeAsTheirBorder) {
    // What ComputeSectorShrink claims: per step, the first mode across has 1/2, the next less.
    for (ReferenceMask mask : kMasks) {
        for (int numFaces = 3; numFaces <= 12; ++numFaces) {
            std::vector<double> const sizes = crossEigenvalues(mask, numFaces);
            ASSERT_GE(sizes.size(), 2u);
            EXPECT_NEAR(sizes[0], 0.5, 0.003) << ToString(mask) << " " << numFaces;
            EXPECT_LT(sizes[1], 0.498) << ToString(mask) << " " << numFaces;
        }
    }
}

namespace {

/// The shape with \p excess above the whole part of all finite sharpness.
Shape withExcess(Shape shape, float excess) {
    for (std::vector<float> *tags : {&shape.creaseSharpness, &shape.cornerSharpness}) {
        for (float &sharpness : *tags) {
            if (sharpness < kInfinite) {
                sharpness = std::floor(sharpness) + excess;
            }
        }
    }
    return shape;
}

} // namespace

TEST(Property, FadingCreasesDoNotPop) {
    // The limit from above is what is there without the rest of sharpness.  Not so with
    // CREASE_CHAIKIN: Sdc::Crease takes the mean of those edges at a vertex that are sharp at all.
    constexpr float kExcess = 1e-4f;
    forEachFeature([&](Shape const &shape, Sdc::Options options) {
        if (options.GetCreasingMethod() == Sdc::Options::CREASE_CHAIKIN) {
            return;
        }
        auto const before =
            refinePositions(withExcess(shape, kExcess), ReferenceMask::Smooth, 3, options);
        auto const after = refinePositions(withExcess(shape, 0), ReferenceMask::Smooth, 3, options);
        for (std::size_t level = 0; level < before.size(); ++level) {
            ASSERT_LE((before[level] - after[level]).cwiseAbs().maxCoeff(), 5 * kExcess)
                << "level " << level;
        }
    });
}

namespace {

void expectChartsApart(Shape const &shape, int channel, int numLevels, Sdc::Options options) {
    auto const refiner = CreateRefiner(shape, ReferenceMask::Smooth, numLevels, options);
    TopologyLevel const &base = refiner->GetLevel(0);
    // Charts: faces joined across edges whose ends have the same values on both sides.
    FVarChannel const &values = shape.fvarChannels[channel];
    int const numValues = int(values.values.size()) / values.width;
    std::vector<int> chart(base.GetNumFaces(), -1);
    auto const valueAt = [&](int face, int vert) {
        int const place = base.GetFaceVertices(face).FindIndex(vert);
        return base.GetFaceFVarValues(face, channel)[place];
    };
    for (int seed = 0; seed < base.GetNumFaces(); ++seed) {
        std::vector<int> faces;
        if (chart[seed] < 0) {
            chart[seed] = seed;
            faces.push_back(seed);
        }
        while (!faces.empty()) {
            int const face = faces.back();
            faces.pop_back();
            for (int edge : base.GetFaceEdges(face)) {
                IndexArray const verts = base.GetEdgeVertices(edge);
                for (int other : base.GetEdgeFaces(edge)) {
                    if (chart[other] < 0 && valueAt(face, verts[0]) == valueAt(other, verts[0]) &&
                        valueAt(face, verts[1]) == valueAt(other, verts[1])) {
                        chart[other] = seed;
                        faces.push_back(other);
                    }
                }
            }
        }
    }
    std::vector<std::set<int>> chartsOfValue(numValues);
    for (int f = 0; f < base.GetNumFaces(); ++f) {
        for (int value : base.GetFaceFVarValues(f, channel)) {
            chartsOfValue[value].insert(chart[f]);
        }
    }
    FarExt::StencilTableFactory::Options tableOptions;
    tableOptions.interpolationMode = FarExt::INTERPOLATE_FACE_VARYING;
    tableOptions.fvarChannel = channel;
    tableOptions.generateIntermediateLevels = false;
    auto const table = FarExt::StencilTableFactory::Create(*refiner, tableOptions);
    ASSERT_TRUE(table);
    TopologyLevel const &last = refiner->GetLevel(numLevels);
    ASSERT_EQ(table->GetNumStencils(), last.GetNumFVarValues(channel));
    // There is a chart that all control values of all values of a face, or half of one, are in.
    auto const expectOneChart = [&](IndexArray faceValues) {
        std::set<int> common =
            chartsOfValue[table->GetStencil(faceValues[0]).GetVertexIndices()[0]];
        for (int value : faceValues) {
            auto const stencil = table->GetStencil(value);
            for (int k = 0; k < stencil.GetSize(); ++k) {
                std::set<int> const &charts = chartsOfValue[stencil.GetVertexIndices()[k]];
                for (auto it = common.begin(); it != common.end();) {
                    it = charts.count(*it) != 0 ? std::next(it) : common.erase(it);
                }
            }
        }
        ASSERT_FALSE(common.empty());
    };
    for (int f = 0; f < last.GetNumFaces(); ++f) {
        if (!last.IsFaceFVarSplit(f, channel)) {
            ASSERT_NO_FATAL_FAILURE(expectOneChart(last.GetFaceFVarValues(f, channel)));
            continue;
        }
        std::set<int> halves[2];
        for (int half : {0, 1}) {
            IndexArray const halfValues = last.GetFaceFVarValues(f, channel, half);
            ASSERT_EQ(halfValues.size(), 4);
            ASSERT_NO_FATAL_FAILURE(expectOneChart(halfValues));
            halves[half].insert(halfValues.begin(), halfValues.end());
        }
        for (int value : halves[0]) {
            ASSERT_EQ(halves[1].count(value), 0u);
        }
    }
}

} // namespace

TEST(Property, ChartsStayApart) {
    for (Shape const &shape : GetFeatureShapes()) {
        for (int channel = 0; channel < int(shape.fvarChannels.size()); ++channel) {
            for (auto linear :
                 {Sdc::Options::FVAR_LINEAR_NONE, Sdc::Options::FVAR_LINEAR_CORNERS_ONLY,
                  Sdc::Options::FVAR_LINEAR_BOUNDARIES, Sdc::Options::FVAR_LINEAR_ALL}) {
                SCOPED_TRACE(shape.name);
                Sdc::Options options = boundary(kEdgeAndCorner);
                options.SetFVarLinearInterpolation(linear);
                ASSERT_NO_FATAL_FAILURE(
                    expectChartsApart(shape, channel, GetTestLevel(shape, 2, 120000), options));
            }
        }
    }
}

TEST(Property, LeftHandedIsReversed) {
    Shape const &leftHanded = GetFeatureShape("leftHanded");
    ASSERT_TRUE(leftHanded.leftHanded);
    Shape reversed = leftHanded;
    reversed.leftHanded = false;
    int first = 0;
    for (int size : reversed.faceSizes) {
        // Far keeps the first vertex.
        std::reverse(reversed.faceVertices.begin() + first + 1,
                     reversed.faceVertices.begin() + first + size);
        auto &values = reversed.fvarChannels[0].valueIndices;
        std::reverse(values.begin() + first + 1, values.begin() + first + size);
        first += size;
    }
    for (auto rule : {kNone, kEdgeOnly, kEdgeAndCorner}) {
        auto const a = CreateRefiner(leftHanded, ReferenceMask::Average, 3, boundary(rule));
        auto const b = CreateRefiner(reversed, ReferenceMask::Average, 3, boundary(rule));
        EXPECT_EQ(InterpolateLevels(*a, GetPositions(leftHanded)),
                  InterpolateLevels(*b, GetPositions(leftHanded)));
        ReferenceValues const values = GetValues(leftHanded.fvarChannels[0]);
        EXPECT_EQ(InterpolateLevels(*a, values, ValueKind::FaceVarying),
                  InterpolateLevels(*b, values, ValueKind::FaceVarying));
        for (int depth = 0; depth <= 3; ++depth) {
            ASSERT_EQ(a->GetLevel(depth).GetNumFaces(), b->GetLevel(depth).GetNumFaces());
            for (int f = 0; f < a->GetLevel(depth).GetNumFaces(); ++f) {
                IndexArray const aVerts = a->GetLevel(depth).GetFaceVertices(f);
                IndexArray const bVerts = b->GetLevel(depth).GetFaceVertices(f);
                ASSERT_TRUE(std::equal(aVerts.begin(), aVerts.end(), bVerts.begin(), bVerts.end()));
            }
        }
    }
}

TEST(Property, ChannelWithoutSeamsIsAsVertices) {
    forEachFeature([](Shape const &original, Sdc::Options options) {
        if (!original.manifold || original.name.rfind("degenerate", 0) == 0) {
            return; // come apart at their flaws
        }
        Shape shape = original;
        shape.fvarChannels = {MakeVertexChannel(shape)};
        shape.fvarChannels[0].width = 3;
        shape.fvarChannels[0].values = shape.positions;
        int const numLevels = GetTestLevel(shape, 3, 6000);
        options.SetFVarLinearInterpolation(Sdc::Options::FVAR_LINEAR_NONE);
        auto refiner = CreateRefiner(shape, ReferenceMask::Cosine, numLevels, options);
        auto const vertexLevels = InterpolateLevels(*refiner, GetPositions(shape));
        auto const valueLevels =
            InterpolateLevels(*refiner, GetPositions(shape), ValueKind::FaceVarying);
        options.SetFVarLinearInterpolation(Sdc::Options::FVAR_LINEAR_ALL);
        refiner = CreateRefiner(shape, ReferenceMask::Cosine, numLevels, options);
        auto const varyingLevels =
            InterpolateLevels(*refiner, GetPositions(shape), ValueKind::Varying);
        auto const linearLevels =
            InterpolateLevels(*refiner, GetPositions(shape), ValueKind::FaceVarying);
        for (int depth = 0; depth <= numLevels; ++depth) {
            TopologyLevel const &level = refiner->GetLevel(depth);
            for (int f = 0; f < level.GetNumFaces(); ++f) {
                IndexArray const verts = level.GetFaceVertices(f);
                IndexArray const values = level.GetFaceFVarValues(f);
                ASSERT_FALSE(level.IsFaceFVarSplit(f));
                ASSERT_TRUE(level.DoesFaceFVarTopologyMatch(f));
                for (int i = 0; i < verts.size(); ++i) {
                    ASSERT_LT(
                        (vertexLevels[depth].row(verts[i]) - valueLevels[depth].row(values[i]))
                            .norm(),
                        1e-13 * (1 + GetSize(vertexLevels[0])));
                    ASSERT_LT(
                        (varyingLevels[depth].row(verts[i]) - linearLevels[depth].row(values[i]))
                            .norm(),
                        1e-13 * (1 + GetSize(vertexLevels[0])));
                }
            }
        }
    });
}

TEST(Property, StencilsAreNonNegativeAndSumToOne) {
    forEachFeature([](Shape const &shape, Sdc::Options options) {
        for (ReferenceMask mask : kMasks) {
            auto const refiner = CreateRefiner(shape, mask, GetTestLevel(shape, 3, 3000), options);
            for (int mode = 0; mode < 2 + int(shape.fvarChannels.size()); ++mode) {
                FarExt::StencilTableFactoryReal<double>::Options tableOptions;
                tableOptions.interpolationMode = mode == 0   ? FarExt::INTERPOLATE_VERTEX
                                                 : mode == 1 ? FarExt::INTERPOLATE_VARYING
                                                             : FarExt::INTERPOLATE_FACE_VARYING;
                tableOptions.fvarChannel = std::max(0, mode - 2);
                FarExt::Status status;
                auto const table = FarExt::StencilTableFactoryReal<double>::Create(
                    *refiner, tableOptions, &status);
                ASSERT_TRUE(table) << status.GetMessage();
                for (int i = 0; i < table->GetNumStencils(); ++i) {
                    auto const stencil = table->GetStencil(i);
                    double sum = 0;
                    for (int k = 0; k < stencil.GetSize(); ++k) {
                        ASSERT_GE(stencil.GetWeights()[k], 0);
                        sum += stencil.GetWeights()[k];
                    }
                    ASSERT_NEAR(sum, 1, 1e-12);
                }
            }
        }
    });
}

TEST(Property, StencilTablesRefuseAChannelOutOfRange) {
    Shape const &shape = GetFeatureShape("cubeOfCharts");
    auto const refiner = CreateRefiner(shape, ReferenceMask::Average, 1);
    for (int channel : {-1, 2}) {
        FarExt::StencilTableFactory::Options options;
        options.interpolationMode = FarExt::INTERPOLATE_FACE_VARYING;
        options.fvarChannel = channel;
        FarExt::Status status;
        EXPECT_FALSE(FarExt::StencilTableFactory::Create(*refiner, options, &status));
        EXPECT_EQ(status.GetCode(), FarExt::StatusCode::InvalidArgument);
        EXPECT_NE(status.GetMessage().find(std::to_string(channel)), std::string::npos);
        // It does not matter to other modes.
        options.interpolationMode = FarExt::INTERPOLATE_VERTEX;
        EXPECT_TRUE(FarExt::StencilTableFactory::Create(*refiner, options, &status));
    }
}

TEST(Property, EveryLevelIsValid) {
    forEachFeature([](Shape const &shape, Sdc::Options options) {
        auto const refiner =
            CreateRefiner(shape, ReferenceMask::Average, GetTestLevel(shape, 4, 40000), options);
        for (int depth = 0; depth <= refiner->GetMaxLevel(); ++depth) {
            FarExt::Status status;
            ASSERT_TRUE(refiner->GetLevel(depth).Validate(&status)) << status.GetMessage();
        }
    });
}

} // namespace OpenSubdivHex::Regression
