// SPDX-License-Identifier: Apache-2.0
//
// Trees of cells, against books that are kept of every line, and their tessellations of whole meshes.
#include "cellFixture.h"
#include "facePlaces.h"
#include "surfaceCase.h"
#include "surfaceFixture.h"
#include "turnedFacets.h"

#include "bfr_ext/cellForest.h"
#include "regression/far_ext/referenceMatch.h"
#include "regression/reference/cellReference.h"
#include "regression/shapes/featureShapes.h"
#include "regression/shapes/shapeDescriptor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <map>
#include <optional>
#include <random>
#include <set>

namespace OpenSubdivHex::Regression::cellTreeTest {

using BfrExt::CellForest;
using BfrExt::CellTree;
using BfrExt::LevelTessellation;
using BfrExt::Parameterization;
using BfrExt::Polyline;
using BfrExt::Surface;

namespace {

LevelTessellation::Options getPolygonOptions(int facetSize) {
    return LevelTessellation::Options().SetFacetSize(facetSize);
}

/// All facets of a forest, whose vertices are numbers of points.
struct ForestMesh {
    ForestMesh(CellForest const &forest, std::vector<bool> const &hasFace, int facetSize) {
        int numPoints = int(forest.GetNumBoundaryPoints());
        for (int face = 0; face < forest.GetNumFaces(); ++face) {
            tessellations.push_back(forest.GetTessellation(face, getPolygonOptions(facetSize)));
            LevelTessellation const &tessellation = tessellations.back();
            EXPECT_TRUE(tessellation.IsValid());
            std::vector<int> numbers(std::size_t(tessellation.GetNumCoords()));
            EXPECT_EQ(forest.GetBoundaryPoints(face, numbers.data()),
                      tessellation.GetNumBoundaryCoords());
            for (std::size_t i = std::size_t(tessellation.GetNumBoundaryCoords());
                 i < numbers.size(); ++i) {
                numbers[i] = numPoints++;
            }
            points.push_back(numbers);
            for (std::vector<int> &facet : GetFacets(tessellation)) {
                if (!hasFace[std::size_t(face)]) {
                    continue;
                }
                for (std::size_t i = 0; i < facet.size(); ++i) {
                    ++sides[{numbers[std::size_t(facet[i])],
                             numbers[std::size_t(facet[(i + 1) % facet.size()])]}];
                }
                ++numFacets;
            }
        }
        for (auto const &side : sides) {
            used.insert(side.first.first);
        }
    }

    /// \brief V - E + F.
    ///
    /// Two vertices may have several edges, as a diagonal in each of two faces that share both.
    int GetEuler() const {
        int numEdges = 0;
        for (auto const &[side, count] : sides) {
            auto const other = sides.find({side.second, side.first});
            int const otherCount = other == sides.end() ? 0 : other->second;
            numEdges +=
                side.first < side.second || otherCount == 0 ? std::max(count, otherCount) : 0;
        }
        return int(used.size()) - numEdges + numFacets;
    }

    std::vector<LevelTessellation> tessellations;
    std::vector<std::vector<int>> points; ///< by face and place
    std::map<std::pair<int, int>, int> sides;
    std::set<int> used;
    int numFacets = 0;
};

/// The number of random forests of each shape that OPENSUBDIVHEX_TREES asks for, if it is there.
std::optional<unsigned> findNumRounds() {
    constexpr int kDecimal = 10;
    char const *const text = std::getenv("OPENSUBDIVHEX_TREES");
    return text ? std::optional<unsigned>(
                      unsigned(std::max(1L, std::strtol(text, nullptr, kDecimal))))
                : std::nullopt;
}

/// The number of rounds: so many forests that they have 200 trees together, two at least.
unsigned getNumRounds(Shape const &shape) {
    constexpr int kNumTrees = 200;
    int const numFaces = std::max(1, shape.GetNumFaces());
    return findNumRounds().value_or(unsigned(std::max(2, (kNumTrees + numFaces - 1) / numFaces)));
}

} // namespace

TEST(Polyline, LevelsAndPlaces) {
    constexpr int kNumSegments[] = {1, 1, 3, 5, 11, 21, 43, 85, 171, 341, 683, 1365, 2731};
    for (int level = 0; level <= Polyline::kLastLevel; ++level) {
        Polyline const polyline(level);
        EXPECT_EQ(polyline.GetNumSegments(), kNumSegments[level]);
        EXPECT_EQ(polyline.GetReversed(), polyline);
        Polyline copy;
        ASSERT_TRUE(Polyline::FromPlaces(polyline.GetPlaces(), &copy));
        EXPECT_EQ(copy, polyline);
        if (level > 0) {
            EXPECT_TRUE(polyline.Contains(Polyline(level - 1)));
        }
    }
    EXPECT_EQ(Polyline(2).GetPlaces(), (std::vector<Polyline::Place>{2048, 6144}));
    EXPECT_EQ(Polyline(2).GetParameter(1), 0.75);

    Polyline start;
    Polyline end;
    ASSERT_TRUE(Polyline::FromPlaces({512, 1536, 2048, 6144}, &start));
    ASSERT_TRUE(Polyline::FromPlaces({2048, 3072, 5120, 6144}, &end));
    EXPECT_EQ(start.GetReversed().GetPlaces(),
              (std::vector<Polyline::Place>{2048, 6144, 6656, 7680}));
    Polyline both = start;
    both.Merge(end);
    EXPECT_EQ(both.GetPlaces(), (std::vector<Polyline::Place>{512, 1536, 2048, 3072, 5120, 6144}));
    EXPECT_TRUE(both.Contains(start) && both.Contains(end));
    EXPECT_FALSE(start.Contains(both));
    for (std::vector<Polyline::Place> const &places :
         std::vector<std::vector<Polyline::Place>>{{2048},
                                                   {6144},
                                                   {4096},
                                                   {512, 1536},
                                                   {2048, 2048, 6144},
                                                   {6144, 2048},
                                                   {0, 2048, 6144},
                                                   {2048, 6144, 8192},
                                                   {2048, 3000, 5120, 6144},
                                                   {2048, 4096, 6144}}) {
        EXPECT_FALSE(Polyline::FromPlaces(places, &both));
    }
    EXPECT_EQ(both.GetNumPoints(), 6);
}

TEST(CellTree, RefinesWhatItIsAskedTo) {
    CellTree tree(5);
    EXPECT_EQ(tree.GetNumLeaves(), 1);
    ASSERT_EQ(tree.Refine(0), 1);
    EXPECT_EQ(tree.Refine(0), 1);
    EXPECT_EQ(tree.GetNumCells(), 7);
    EXPECT_TRUE(tree.IsWhole(1));
    EXPECT_EQ(tree.GetEdge(4), 2);
    EXPECT_EQ(tree.GetBorderSide(4), 0);
    int const half = tree.Refine(4);
    EXPECT_EQ(tree.GetNumLeaves(), 9);
    EXPECT_EQ(tree.GetBorderSide(half), 0);
    EXPECT_EQ(tree.GetBorderSide(half + 1), 3);
    EXPECT_EQ(tree.GetBorderSide(half + 2), -1);
    EXPECT_EQ(tree.GetBorderSide(half + 3), 1);
    EXPECT_EQ(tree.GetEdgePolyline(2), Polyline(2));
    EXPECT_EQ(tree.GetEdgePolyline(1), Polyline());
    // At the start of the edge, two levels on.
    int const start = tree.Refine(half + 3);
    EXPECT_EQ(tree.GetEdgePolyline(2), Polyline(2));
    tree.Refine(start + 1);
    EXPECT_EQ(tree.GetEdgePolyline(2).GetPlaces(),
              (std::vector<Polyline::Place>{512, 1536, 2048, 6144}));
    EXPECT_EQ(tree.GetMaxLevel(), 4);
    for (int level = 0; level < 6; ++level) {
        EXPECT_EQ(CellTree(3, level).GetEdgePolyline(1), Polyline(level));
        EXPECT_EQ(CellTree(3, level).GetMaxLevel(), level);
    }
    CellTree deep(3);
    int cell = 0;
    for (int level = 0; level < CellTree::kLastLevel; ++level) {
        cell = deep.Refine(cell);
    }
    EXPECT_EQ(deep.GetLevel(cell), CellTree::kLastLevel);
    EXPECT_EQ(deep.Refine(cell), 0);
    int const numCells = deep.GetNumCells();
    for (int const none : {-1, numCells, numCells + 99}) {
        EXPECT_EQ(deep.Refine(none), 0);
        EXPECT_EQ(deep.GetNumCells(), numCells);
    }
}

TEST(CellTree, TessellationsNeedAllPointsOfTheTree) {
    CellTree const tree(4, 3);
    std::vector<Polyline> edges(4, Polyline(3));
    EXPECT_TRUE(LevelTessellation(tree, edges.data()).IsValid());
    EXPECT_TRUE(LevelTessellation(tree).IsValid());
    edges[2] = Polyline(2);
    EXPECT_FALSE(LevelTessellation(tree, edges.data()).IsValid());
    EXPECT_FALSE(LevelTessellation(tree, nullptr, getPolygonOptions(5)).IsValid());
    EXPECT_EQ(LevelTessellation(tree, edges.data()).GetNumFacets(), 0);
    edges[2] = Polyline(4);
    LevelTessellation const finer(tree, edges.data());
    EXPECT_EQ(finer.GetNumEdgeCoords(2), 10);
    EXPECT_EQ(finer.GetLevels(nullptr), 0);
    EXPECT_FALSE(finer.IsUniform());
    std::vector<int> levels(std::size_t(finer.GetNumFacets()));
    EXPECT_EQ(finer.GetFacetLevels(levels.data()), finer.GetNumFacets());
    EXPECT_EQ(std::set<int>(levels.begin(), levels.end()), std::set<int>{3});
}

TEST(CellForest, CopiesAndMovesAreValues) {
    auto const refiner = CreateRefiner(GetShape("cube"), ReferenceMask::Smooth, 0, {});
    CellTree const tree(4, 2);
    CellForest forest(*refiner);
    CellForest assigned(*refiner);
    forest.SetTree(2, tree);
    forest.MatchEdges();
    auto const numPoints = forest.GetNumBoundaryPoints();
    ASSERT_GT(numPoints, 8);
    CellForest copy(forest);
    assigned = forest;
    forest.SetTree(2, CellTree(4));
    forest.MatchEdges();
    EXPECT_EQ(forest.GetNumBoundaryPoints(), 8);
    auto const expectTree = [&](CellForest const &other) {
        EXPECT_EQ(other.GetTree(2).GetNumCells(), tree.GetNumCells());
        EXPECT_EQ(other.GetNumBoundaryPoints(), numPoints);
        EXPECT_TRUE(other.GetTessellation(2).IsValid());
    };
    expectTree(copy);
    expectTree(assigned);
    CellForest const moved(std::move(copy));
    expectTree(moved);
    copy = moved; // what was moved from can be assigned to
    expectTree(copy);
}

TEST(CellForest, TreesOfOtherFacesHaveNoTessellation) {
    auto const refiner = CreateRefiner(GetShape("cube"), ReferenceMask::Smooth, 0, {});
    CellForest forest(*refiner);
    for (int const faceSize : {3, 5, 60}) {
        forest.SetTree(2, CellTree(faceSize, 2));
        EXPECT_FALSE(forest.GetTessellation(2).IsValid());
        EXPECT_EQ(forest.GetTessellation(2).GetNumFacets(), 0);
        EXPECT_TRUE(forest.GetTessellation(1).IsValid());
        forest.MatchEdges();
        EXPECT_FALSE(forest.IsMatched(2));
        EXPECT_EQ(forest.GetNumBoundaryPoints(), 8); // no edge has a point of that tree
    }
    forest.SetTree(2, CellTree(4, 2));
    EXPECT_FALSE(forest.GetTessellation(2).IsValid()); // until edges are matched
    forest.MatchEdges();
    EXPECT_TRUE(forest.GetTessellation(2).IsValid());
}

namespace {

/// Refines the pieces of the reference as the cells of a tree.
void refineAlike(CellTree const &tree, int cell, CellReference &reference, int piece) {
    if (tree.IsRefined(cell)) {
        int const first = reference.Refine(piece);
        for (int i = 0; i < tree.GetNumChildren(cell); ++i) {
            refineAlike(tree, tree.GetFirstChild(cell) + i, reference, first + i);
        }
    }
}

using PlacePolygon = std::vector<std::pair<long, long>>;

/// From the least place on.
PlacePolygon turn(PlacePolygon polygon) {
    std::rotate(polygon.begin(), std::min_element(polygon.begin(), polygon.end()), polygon.end());
    return polygon;
}

std::pair<long, long> roundPlace(double u, double v) {
    return {std::lround(u * 1e9), std::lround(v * 1e9)};
}

void expectReference(Shape const &shape, unsigned seed) {
    auto const refiner = CreateRefiner(shape, ReferenceMask::Smooth, 0);
    CellForest const forest = MakeRandomForest(*refiner, seed);
    ReferenceMesh const base =
        MakeReferenceMesh(shape.positions, shape.faceSizes, shape.faceVertices);
    CellReference reference(base, shape.faceVertices);
    for (int face = 0; face < forest.GetNumFaces(); ++face) {
        refineAlike(forest.GetTree(face), 0, reference, face);
    }
    std::vector<std::multiset<PlacePolygon>> expected(std::size_t(forest.GetNumFaces()));
    for (CellReference::Polygon const &polygon : reference.GetPolygons()) {
        PlacePolygon places;
        for (auto const &place : polygon.places) {
            places.push_back(roundPlace(place[0], place[1]));
        }
        expected[std::size_t(polygon.baseFace)].insert(turn(places));
    }
    ForestMesh const mesh(forest, std::vector<bool>(shape.faceSizes.size(), true), 0);
    for (int face = 0; face < forest.GetNumFaces(); ++face) {
        LevelTessellation const &tessellation = mesh.tessellations[std::size_t(face)];
        std::vector<double> coords(2 * std::size_t(tessellation.GetNumCoords()));
        tessellation.GetCoords(coords.data());
        coords = ToPlane(tessellation.GetFaceSize(), coords);
        std::multiset<PlacePolygon> polygons;
        for (std::vector<int> const &facet : GetFacets(tessellation)) {
            PlacePolygon places;
            for (int const place : facet) {
                places.push_back(
                    roundPlace(coords[2 * std::size_t(place)], coords[2 * std::size_t(place) + 1]));
            }
            polygons.insert(turn(places));
        }
        ASSERT_EQ(polygons, expected[std::size_t(face)]) << "face " << face;
    }
    // OpenMesh takes manifold polygons alone.
    ReferenceMesh const cells = reference.MakeMesh();
    ASSERT_EQ(mesh.numFacets, int(cells.n_faces()));
    ASSERT_EQ(mesh.used.size(),
              cells.n_vertices() - std::size_t(std::count_if(
                                       cells.vertices_begin(), cells.vertices_end(),
                                       [&](auto vertex) { return cells.is_isolated(vertex); })));
    std::size_t numSides = 0;
    for (auto const half : cells.halfedges()) {
        numSides += !half.is_boundary();
    }
    ASSERT_EQ(mesh.sides.size(), numSides);
    ASSERT_EQ(mesh.GetEuler(), int(mesh.used.size()) - int(cells.n_edges()) + int(cells.n_faces()));
}

} // namespace

TEST(CellForest, PolygonsAreThoseOfTheReference) {
    for (Shape const &shape : GetManifoldShapes()) {
        SCOPED_TRACE(shape.name);
        if (shape.GetNumFaces() > 700) {
            continue;
        }
        for (unsigned seed = 0; seed < getNumRounds(shape); ++seed) {
            SCOPED_TRACE(testing::Message() << "seed " << seed);
            ASSERT_NO_FATAL_FAILURE(expectReference(shape, seed));
        }
    }
}

namespace {

/// Counts of the facets of random forests.
struct ForestCounts {
    /// Expects that no more of them than some shares are turned over, which are those of the trees that
    /// there are by default.
    void Bound(double shareOfPolygons, double shareOfTriangles) const {
        polygons.Report("polygons");
        triangles.Report("triangles");
        if (findNumRounds()) {
            return;
        }
        EXPECT_LT(polygons.GetShare(), shareOfPolygons);
        EXPECT_LT(triangles.GetShare(), shareOfTriangles);
    }

    TurnedFacets polygons;
    TurnedFacets triangles;
};

/// In the plane of the face facets are counter-clockwise and cover it.
void expectPlaneTiling(LevelTessellation const &tessellation) {
    std::vector<double> coords(2 * std::size_t(tessellation.GetNumCoords()));
    tessellation.GetCoords(coords.data());
    coords = ToPlane(tessellation.GetFaceSize(), coords);
    auto const getArea = [&](std::vector<int> const &polygon) {
        double sum = 0;
        for (std::size_t i = 0; i < polygon.size(); ++i) {
            std::size_t const p = 2 * std::size_t(polygon[i]);
            std::size_t const q = 2 * std::size_t(polygon[(i + 1) % polygon.size()]);
            sum += coords[p] * coords[q + 1] - coords[q] * coords[p + 1];
        }
        return sum / 2;
    };
    double area = 0;
    for (std::vector<int> const &facet : GetFacets(tessellation)) {
        ASSERT_GT(getArea(facet), 1e-12);
        area += getArea(facet);
    }
    std::vector<int> boundary(std::size_t(tessellation.GetNumBoundaryCoords()));
    for (std::size_t i = 0; i < boundary.size(); ++i) {
        boundary[i] = int(i);
    }
    ASSERT_NEAR(area, getArea(boundary), 1e-9);
}

/// With polygons and triangles in turn, polygons where a seed is even.
void expectSound(Shape const &shape, SurfaceCase const &surfaceCase,
                 Sdc::Options::VtxBoundaryInterpolation boundary, unsigned firstSeed,
                 unsigned numRounds, ForestCounts &counts) {
    Sdc::Options options;
    options.SetVtxBoundaryInterpolation(boundary);
    auto const refiner = CreateSurfaceRefiner(shape, surfaceCase, 0, options);
    FarExt::TopologyLevel const &base = refiner->GetLevel(refiner->GetMaxLevel());
    FarExt::SurfaceFaces const faces(base.GetLevel());
    SurfaceSet<double> const surfaces(*refiner, shape.positions);
    std::vector<bool> hasFace(std::size_t(faces.GetNumFaces()));
    for (int face = 0; face < faces.GetNumFaces(); ++face) {
        hasFace[std::size_t(face)] = surfaces[face].IsValid();
    }
    bool hasVertexTwice = false; // in a face
    for (int face = 0; face < base.GetNumFaces(); ++face) {
        auto const verts = base.GetFaceVertices(face);
        hasVertexTwice = hasVertexTwice || std::set<int>(verts.begin(), verts.end()).size() <
                                               std::size_t(verts.size());
    }
    // Where edges come apart, they part further points the more they have; and of edges with the same ends
    // sides are the same, unless they have points.
    bool hasPartedEdges = false;
    std::set<std::pair<int, int>> ends;
    for (int edge = 0; edge < base.GetNumEdges(); ++edge) {
        auto const verts = base.GetEdgeVertices(edge);
        bool const isNew = ends.insert(std::minmax(verts[0], verts[1])).second;
        hasPartedEdges = hasPartedEdges || base.IsEdgeNonManifold(edge) || !isNew;
    }
    // The base mesh itself is the least tessellation.
    CellForest plain(*refiner);
    plain.MatchEdges();
    ForestMesh const baseMesh(plain, hasFace, 0);
    for (unsigned seed = firstSeed; seed < firstSeed + numRounds; ++seed) {
        SCOPED_TRACE(testing::Message() << "seed " << seed);
        CellForest const forest = MakeRandomForest(*refiner, seed + 1000);
        ForestMesh const mesh(forest, hasFace, seed % 2 == 0 ? 0 : 3);
        if (!hasPartedEdges) {
            ASSERT_EQ(mesh.GetEuler(), baseMesh.GetEuler());
        }
        // Sides are open only along those of the base that are.
        std::set<int> openPoints;
        for (auto const &[side, count] : mesh.sides) {
            bool const isShared =
                side.first < base.GetNumVertices() && side.second < base.GetNumVertices();
            ASSERT_TRUE(count == 1 || isShared || hasVertexTwice);
            if (mesh.sides.count({side.second, side.first}) == 0) {
                ASSERT_LT(side.first, forest.GetNumBoundaryPoints());
                ASSERT_LT(side.second, forest.GetNumBoundaryPoints());
                openPoints.insert({side.first, side.second});
            }
        }
        for (int edge = 0; edge < faces.GetNumEdges(); ++edge) {
            int numFaces = 0;
            for (int side = 0; side < 2; ++side) {
                int const face = faces.GetSide(edge, side).face;
                numFaces += face != Far::INDEX_INVALID && hasFace[std::size_t(face)] ? 1 : 0;
            }
            for (int i = 0; i < forest.GetPolyline(edge).GetNumPoints(); ++i) {
                ASSERT_EQ(openPoints.count(forest.GetFirstEdgePoint(edge) + i), numFaces == 1);
            }
        }

        std::map<int, Vector3> shared;
        for (int face = 0; face < faces.GetNumFaces(); ++face) {
            if (!hasFace[std::size_t(face)]) {
                continue;
            }
            LevelTessellation const &tessellation = mesh.tessellations[std::size_t(face)];
            ASSERT_NO_FATAL_FAILURE(expectPlaneTiling(tessellation));
            Surface<double> const &surface = surfaces[face];
            std::vector<double> control(3 * std::size_t(surface.GetNumControlPoints()));
            surface.GatherControlPoints(surfaces.GetPositions().data(), 3, control.data(), 3);
            auto const numPlaces = std::size_t(tessellation.GetNumCoords());
            std::vector<double> p(3 * numPlaces), du(p), dv(p), alone(p), coords(2 * numPlaces);
            surface.Evaluate(tessellation, control.data(), 3, p.data(), du.data(), dv.data(), 3);
            surface.Evaluate(tessellation, control.data(), 3, alone.data(), 3);
            ASSERT_EQ(p, alone);
            tessellation.GetCoords(coords.data());
            for (std::size_t i = 0; i < numPlaces; ++i) {
                bool const isOnBoundary = i < std::size_t(tessellation.GetNumBoundaryCoords());
                // Single places are slow, and each is looked at in some of the rounds.
                if ((i + seed) % 16 == 0) {
                    SurfacePoint const expected = surfaces.Evaluate(face, &coords[2 * i]);
                    for (std::size_t k = 0; k < 3; ++k) {
                        ASSERT_NEAR(p[3 * i + k], expected.p[k], 1e-11);
                    }
                }
                if (isOnBoundary) {
                    Vector3 const point = {p[3 * i], p[3 * i + 1], p[3 * i + 2]};
                    int const number = mesh.points[std::size_t(face)][i];
                    auto const [found, isNew] = shared.emplace(number, point);
                    bool const isNonManifold =
                        number < base.GetNumVertices() && base.IsVertexNonManifold(number);
                    ASSERT_TRUE(isNew || isNonManifold || found->second == point)
                        << "point " << number;
                }
            }
            (seed % 2 == 0 ? counts.polygons : counts.triangles).Add(tessellation, p, du, dv);
        }
    }
}

} // namespace

TEST(CellForest, RandomTreesAreClosedAndShareTheirPointsToTheBit) {
    ForestCounts counts;
    for (Shape const &shape : GetManifoldShapes()) {
        if (shape.GetNumFaces() > 700) {
            continue;
        }
        SCOPED_TRACE(shape.name);
        ASSERT_NO_FATAL_FAILURE(expectSound(shape, kPlainCases[2],
                                            Sdc::Options::VTX_BOUNDARY_EDGE_ONLY, 0,
                                            getNumRounds(shape), counts));
    }
    counts.Bound(0.004, 0.012);
}

// Each shape has all masks and all rules for boundaries, and over the shapes each mask has each rule.
TEST(CellForest, TagsAndFlawsStayClosed) {
    constexpr unsigned kNumPairs = 9;
    constexpr unsigned kNumRounds = 3;
    ForestCounts counts;
    unsigned numShapes = 0;
    unsigned seed = 0;
    for (Shape const &shape : GetFeatureShapes()) {
        if (shape.GetNumFaces() > 700) {
            continue;
        }
        SCOPED_TRACE(shape.name);
        unsigned const numRounds = findNumRounds().value_or(kNumRounds);
        for (unsigned pair = 0; pair < std::min(numRounds, kNumPairs); ++pair) {
            unsigned const rule = (pair + pair / 3 + numShapes) % 3;
            unsigned const numSeeds = (numRounds - pair + kNumPairs - 1) / kNumPairs;
            SCOPED_TRACE(testing::Message()
                         << kPlainCases[pair % 3].GetName() << ", rule " << rule);
            ASSERT_NO_FATAL_FAILURE(expectSound(shape, kPlainCases[pair % 3],
                                                Sdc::Options::VtxBoundaryInterpolation(rule), seed,
                                                numSeeds, counts));
            seed += numSeeds;
        }
        ++numShapes;
    }
    counts.Bound(0.001, 0.008);
}

// The long edge has no sector of its own, and is divided by its neighbours' cells and those of the F-faces.
TEST(CellTree, HalfPolygonsAreTiled) {
    for (int const size : {3, 4, 5, 6, 9}) {
        FarExt::FaceShape const shape(size, true);
        std::mt19937 random(static_cast<unsigned>(size));
        for (int level = 0; level <= 5; ++level) {
            SCOPED_TRACE(testing::Message() << size << " vertices, level " << level);
            CellTree const tree(shape, level);
            EXPECT_EQ(tree.GetNumLeaves(), 1 + (size - 1) * ((1 << 2 * level) - 1) / 3);
            EXPECT_EQ(tree.GetEdgePolyline(0), Polyline(level + 1));
            for (int edge = 1; edge < size; ++edge) {
                EXPECT_EQ(tree.GetEdgePolyline(edge), Polyline(level));
            }
            LevelTessellation const ofTree(tree);
            LevelTessellation const ofLevel(Parameterization(shape), level);
            ASSERT_TRUE(ofTree.IsValid() && ofLevel.IsValid());
            ASSERT_NO_FATAL_FAILURE(expectPlaneTiling(ofLevel));
            EXPECT_EQ(GetFacets(ofTree), GetFacets(ofLevel));
            EXPECT_EQ(ofLevel.GetNumEdgeCoords(0), Polyline(level + 1).GetNumPoints());
            ASSERT_NO_FATAL_FAILURE(
                expectPlaneTiling(LevelTessellation(MakeRandomTree(shape, random))));
            // Edges of levels of their own.
            std::vector<int> levels(std::size_t(size) + 1, level);
            for (int &ofEdge : levels) {
                ofEdge = int(random() % 6);
            }
            LevelTessellation const mixed(Parameterization(shape), size + 1, levels.data());
            ASSERT_NO_FATAL_FAILURE(expectPlaneTiling(mixed));
            for (int edge = 0; edge < size; ++edge) {
                int const ofEdge = levels[std::size_t(edge)] + (edge == 0 ? 1 : 0);
                EXPECT_EQ(mixed.GetNumEdgeCoords(edge), Polyline(ofEdge).GetNumPoints());
            }
        }
    }
    int const levels[] = {LevelTessellation::kLastLevel, 0, 0, 0, 0};
    LevelTessellation const finest(Parameterization(FarExt::FaceShape(4, true)), 5, levels);
    ASSERT_TRUE(finest.IsValid());
    EXPECT_EQ(finest.GetNumEdgeCoords(0), (1 << (LevelTessellation::kLastLevel + 2)) / 3 - 1);
}

// Trees of the faces of level 1; of features in turn one mask, since each takes its time.
TEST(CellForest, BehindAFirstStepStaysClosed) {
    constexpr int kManyFaces = 30;
    constexpr unsigned kNumRounds = 2;
    constexpr unsigned kNumRoundsOfFeatures = 1;
    ForestCounts counts;
    for (Shape const &shape : GetManifoldShapes()) {
        if (shape.GetNumFaces() <= kManyFaces) {
            SCOPED_TRACE(shape.name);
            for (SurfaceCase const &surfaceCase : {kTruncateCases[2], kTriHexCases[1]}) {
                ASSERT_NO_FATAL_FAILURE(expectSound(shape, surfaceCase,
                                                    Sdc::Options::VTX_BOUNDARY_EDGE_ONLY, 0,
                                                    findNumRounds().value_or(kNumRounds), counts));
            }
        }
    }
    unsigned const numRounds = findNumRounds().value_or(kNumRoundsOfFeatures);
    unsigned numShapes = 0;
    for (Shape const &shape : GetFeatureShapes()) {
        if (shape.GetNumFaces() <= kManyFaces) {
            SCOPED_TRACE(shape.name);
            ASSERT_NO_FATAL_FAILURE(
                expectSound(shape, kTruncateCases[numShapes % std::size(kTruncateCases)],
                            Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER, numShapes * numRounds,
                            numRounds, counts));
            ++numShapes;
        }
    }
    counts.Bound(0.005, 0.012);
}

// All places, on the long edge among them, which no other face has.
TEST(CellForest, HalfPolygonsHaveThePointsOfPlaces) {
    Sdc::Options options;
    options.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_EDGE_ONLY);
    Shape const &shape = GetShape("triangleGrid");
    for (SurfaceCase const &surfaceCase : kTruncateCases) {
        auto const refiner = CreateSurfaceRefiner(shape, surfaceCase, 0, options);
        SurfaceSet<double> const surfaces(*refiner, shape.positions);
        std::mt19937 random(1);
        int numHalves = 0;
        for (int face = 0; face < refiner->GetLevel(1).GetNumFaces(); ++face) {
            Surface<double> const &surface = surfaces[face];
            if (!surface.GetFaceShape().isHalf) {
                continue;
            }
            ++numHalves;
            std::vector<double> control(3 * std::size_t(surface.GetNumControlPoints()));
            surface.GatherControlPoints(surfaces.GetPositions().data(), 3, control.data(), 3);
            for (LevelTessellation const &tessellation :
                 {LevelTessellation(surface.GetParameterization(), 3),
                  LevelTessellation(MakeRandomTree(surface.GetFaceShape(), random))}) {
                auto const numPlaces = std::size_t(tessellation.GetNumCoords());
                std::vector<double> p(3 * numPlaces), coords(2 * numPlaces);
                surface.Evaluate(tessellation, control.data(), 3, p.data(), 3);
                tessellation.GetCoords(coords.data());
                for (std::size_t i = 0; i < numPlaces; ++i) {
                    Vector3 const expected = surfaces.EvaluatePosition(face, &coords[2 * i]);
                    for (std::size_t k = 0; k < 3; ++k) {
                        ASSERT_NEAR(p[3 * i + k], expected[k], 1e-11)
                            << "face " << face << ", place " << i;
                    }
                }
            }
        }
        EXPECT_GT(numHalves, 3);
    }
}

} // namespace OpenSubdivHex::Regression::cellTreeTest
