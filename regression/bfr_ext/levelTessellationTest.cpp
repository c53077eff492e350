// SPDX-License-Identifier: Apache-2.0
//
// Tessellations alone, in the parameter plane, and of neighbours, which share points to the bit.
#include "cellFixture.h"
#include "facePlaces.h"
#include "facets.h"
#include "surfaceFixture.h"

#include "regression/far_ext/referenceMatch.h"
#include "regression/shapes/featureShapes.h"
#include "regression/shapes/meshOperations.h"
#include "regression/shapes/shapeDescriptor.h"
#include "regression/shapes/torus.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>
#include <set>
#include <utility>

namespace OpenSubdivHex::Regression::levelTessellationTest {

using BfrExt::LevelTessellation;
using BfrExt::Parameterization;
using BfrExt::Surface;

namespace {

// Segments of polylines.
constexpr int kNumSegments[] = {1, 1, 3, 5, 11, 21, 43, 85};

LevelTessellation::Options getOptions(int facetSize) {
    return LevelTessellation::Options().SetFacetSize(facetSize);
}

std::vector<double> getCoords(LevelTessellation const &tessellation) {
    std::vector<double> coords(2 * std::size_t(tessellation.GetNumCoords()));
    EXPECT_EQ(tessellation.GetCoords(coords.data()), tessellation.GetNumCoords());
    return coords;
}

double getArea(std::vector<int> const &polygon, std::vector<double> const &coords) {
    double sum = 0;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        std::size_t const p = 2 * std::size_t(polygon[i]);
        std::size_t const q = 2 * std::size_t(polygon[(i + 1) % polygon.size()]);
        sum += coords[p] * coords[q + 1] - coords[q] * coords[p + 1];
    }
    return sum / 2;
}

/// The facets tile the face: all are counter-clockwise, meet edge to edge, and leave nothing.
void expectTiling(LevelTessellation const &tessellation, double leastArea = 1e-9) {
    int const size = tessellation.GetFaceSize();
    std::vector<double> const coords = ToPlane(size, getCoords(tessellation));
    std::map<std::pair<int, int>, int> sides;
    std::set<int> used;
    double area = 0;
    for (std::vector<int> const &facet : GetFacets(tessellation)) {
        double const facetArea = getArea(facet, coords);
        ASSERT_GT(facetArea, leastArea);
        area += facetArea;
        for (std::size_t i = 0; i < facet.size(); ++i) {
            ++sides[{facet[i], facet[(i + 1) % facet.size()]}];
        }
        used.insert(facet.begin(), facet.end());
    }
    ASSERT_EQ(int(used.size()), tessellation.GetNumCoords());
    int const numBoundary = tessellation.GetNumBoundaryCoords();
    int numOpen = 0;
    for (auto const &[side, count] : sides) {
        ASSERT_EQ(count, 1);
        if (sides.count({side.second, side.first}) == 0) {
            ++numOpen;
            ASSERT_LT(side.first, numBoundary);
            ASSERT_EQ(side.second, (side.first + 1) % numBoundary);
        }
    }
    ASSERT_EQ(numOpen, numBoundary);
    std::vector<int> corners;
    std::vector<double> cornerCoords;
    for (int i = 0; i < size; ++i) {
        corners.push_back(i);
        cornerCoords.resize(cornerCoords.size() + 2);
        tessellation.GetVertexCoord(i, &cornerCoords[2 * std::size_t(i)]);
    }
    ASSERT_NEAR(area, getArea(corners, ToPlane(size, cornerCoords)), 1e-9);
}

} // namespace

TEST(LevelTessellation, FacetsTileTheFaceForAnyLevels) {
    std::mt19937 random(7);
    for (int round = 0; round < 150; ++round) {
        int const size = 3 + round % 6;
        std::vector<int> levels;
        for (int i = 0; i <= size; ++i) {
            levels.push_back(int(random() % 6));
        }
        for (int const facetSize : {0, 3, 4}) {
            LevelTessellation const tessellation(Parameterization(size), size + 1, levels.data(),
                                                 getOptions(facetSize));
            ASSERT_TRUE(tessellation.IsValid());
            SCOPED_TRACE(testing::Message() << "round " << round << ", facets " << facetSize);
            ASSERT_NO_FATAL_FAILURE(expectTiling(tessellation));
            for (int edge = 0; edge < size; ++edge) {
                ASSERT_EQ(tessellation.GetNumEdgeCoords(edge) + 1,
                          kNumSegments[levels[std::size_t(edge)]]);
            }
            std::vector<int> given(levels.size());
            ASSERT_EQ(tessellation.GetLevels(given.data()), size + 1);
            ASSERT_EQ(given, levels);
        }
    }
}

// The polygon of the face has 174,784 corners: cutting them off one by one, each found among all that are left, would
// take minutes.
TEST(LevelTessellation, FineEdgesOfACoarsePolygonAreCutInNearlyLinearTime) {
    constexpr int kSize = 64;
    constexpr int kNumSegmentsOfLastLevel = 2731;
    for (int const numFineEdges : {1, kSize}) {
        std::vector<int> levels(kSize + 1, 0);
        std::fill_n(levels.begin(), numFineEdges, int(LevelTessellation::kLastLevel));
        for (int const facetSize : {3, 4}) {
            SCOPED_TRACE(testing::Message() << numFineEdges << ", facets " << facetSize);
            LevelTessellation const tessellation(Parameterization(kSize), kSize + 1, levels.data(),
                                                 getOptions(facetSize));
            ASSERT_TRUE(tessellation.IsValid());
            EXPECT_EQ(tessellation.GetNumFacets(),
                      numFineEdges * kNumSegmentsOfLastLevel + kSize - numFineEdges - 2);
            ASSERT_NO_FATAL_FAILURE(expectTiling(tessellation, 0));
        }
    }
}

// A polygon alone, whose boundary is sharp, is refined to the cells of a base face.
TEST(LevelTessellation, UniformOnesAreRefinedPolygons) {
    Sdc::Options options;
    options.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_EDGE_ONLY);
    for (char const *const name : {"polygon3", "polygon4", "polygon5", "polygon6", "polygon9"}) {
        Shape const &shape = GetShape(name);
        auto const refiner = CreateRefiner(shape, ReferenceMask::Smooth, 4, options);
        for (int level = 0; level <= 4; ++level) {
            SCOPED_TRACE(testing::Message() << name << ", level " << level);
            FarExt::TopologyLevel const &refined = refiner->GetLevel(level);
            LevelTessellation const tessellation(Parameterization(shape.faceSizes[0]), level,
                                                 getOptions(0));
            EXPECT_TRUE(tessellation.IsUniform());
            auto const round = [](double u, double v) {
                return std::make_pair(std::lround(u * 1e7), std::lround(v * 1e7));
            };
            using Polygon = std::set<std::pair<long, long>>;
            std::set<Polygon> expected;
            for (int face = 0; face < refined.GetNumFaces(); ++face) {
                std::vector<double> uv(2 * std::size_t(refined.GetFaceVertices(face).size()));
                ASSERT_TRUE(refined.GetFaceSurfaceCoords(face, 0, uv.data()));
                Polygon polygon;
                for (std::size_t i = 0; i < uv.size(); i += 2) {
                    polygon.insert(round(uv[i], uv[i + 1]));
                }
                expected.insert(polygon);
            }
            std::vector<double> const coords = getCoords(tessellation);
            std::set<Polygon> polygons;
            for (std::vector<int> const &facet : GetFacets(tessellation)) {
                Polygon polygon;
                for (int const place : facet) {
                    polygon.insert(
                        round(coords[2 * std::size_t(place)], coords[2 * std::size_t(place) + 1]));
                }
                polygons.insert(polygon);
            }
            EXPECT_EQ(tessellation.GetNumCoords(), refined.GetNumVertices());
            EXPECT_EQ(tessellation.GetNumFacets(), refined.GetNumFaces());
            EXPECT_EQ(polygons, expected);
        }
    }
}

TEST(LevelTessellation, CoordinatesAndFacetsAreWhereTheyAreAskedFor) {
    int const levels[] = {2, 3, 0, 2};
    LevelTessellation::Options options = getOptions(4);
    options.SetCoordStride(5).SetFacetStride(6);
    LevelTessellation const tessellation(Parameterization(4), 4, levels, options);
    ASSERT_TRUE(tessellation.IsValid());
    EXPECT_FALSE(tessellation.IsUniform());
    int all[5];
    tessellation.GetLevels(all);
    EXPECT_EQ(all[4], 3);
    ASSERT_EQ(tessellation.GetNumBoundaryCoords(), 3 + 5 + 1 + 3);
    std::vector<float> coords(5 * std::size_t(tessellation.GetNumCoords()), -1.0F);
    ASSERT_EQ(tessellation.GetBoundaryCoords(coords.data()), tessellation.GetNumBoundaryCoords());
    ASSERT_EQ(tessellation.GetInteriorCoords(
                  &coords[5 * std::size_t(tessellation.GetNumBoundaryCoords())]),
              tessellation.GetNumInteriorCoords());
    std::vector<float> together(coords.size(), -1.0F);
    tessellation.GetCoords(together.data());
    EXPECT_EQ(coords, together);
    // The quarters of edge 0, and vertex 1.
    float edge[10] = {};
    ASSERT_EQ(tessellation.GetEdgeCoords(0, edge), 2);
    EXPECT_EQ(edge[0], 0.25F);
    EXPECT_EQ(edge[5], 0.75F);
    EXPECT_EQ(edge[6], 0.0F);
    EXPECT_EQ(coords[5], 0.25F);
    EXPECT_EQ(coords[15], 1.0F);
    float vertex[2];
    tessellation.GetVertexCoord(2, vertex);
    EXPECT_EQ(vertex[0], 1.0F);
    EXPECT_EQ(vertex[1], 1.0F);

    std::vector<int> facets(6 * std::size_t(tessellation.GetNumFacets()), -9);
    tessellation.GetFacets(facets.data());
    std::vector<int> boundary(std::size_t(tessellation.GetNumBoundaryCoords()));
    std::vector<int> interior(std::size_t(tessellation.GetNumInteriorCoords()));
    for (std::size_t i = 0; i < boundary.size(); ++i) {
        boundary[i] = 1000 + int(i);
    }
    for (std::size_t i = 0; i < interior.size(); ++i) {
        interior[i] = int(i + boundary.size()) + 50;
    }
    std::vector<int> shifted = facets;
    tessellation.TransformFacetCoordIndices(shifted.data(), 3);
    std::vector<int> moved = facets;
    tessellation.TransformFacetCoordIndices(moved.data(), boundary.data(), 50);
    std::vector<int> replaced = facets;
    tessellation.TransformFacetCoordIndices(replaced.data(), boundary.data(), interior.data());
    EXPECT_EQ(moved, replaced);
    for (std::size_t i = 0; i < facets.size(); ++i) {
        bool const isIndex = facets[i] >= 0;
        EXPECT_EQ(shifted[i], isIndex ? facets[i] + 3 : facets[i]);
        bool const isBoundary = isIndex && facets[i] < tessellation.GetNumBoundaryCoords();
        EXPECT_EQ(moved[i], !isIndex ? facets[i] : facets[i] + (isBoundary ? 1000 : 50));
    }
}

TEST(LevelTessellation, IsInvalidForWrongArguments) {
    int const levels[] = {1, 2, 3, 13, 1, 1};
    Parameterization const quad(4);
    EXPECT_TRUE(LevelTessellation(quad, 3, levels).IsValid() == false);
    EXPECT_FALSE(LevelTessellation(quad, 4, levels).IsValid());
    EXPECT_FALSE(LevelTessellation(quad, 6, levels).IsValid());
    EXPECT_FALSE(LevelTessellation(quad, -1).IsValid());
    EXPECT_FALSE(LevelTessellation(quad, LevelTessellation::kLastLevel + 1).IsValid());
    EXPECT_FALSE(LevelTessellation(Parameterization(), 1).IsValid());
    EXPECT_FALSE(LevelTessellation(Parameterization(2), 1).IsValid());
    EXPECT_FALSE(LevelTessellation(quad, 1, getOptions(5)).IsValid());
    EXPECT_FALSE(LevelTessellation(quad, 1, getOptions(4).SetFacetStride(3)).IsValid());
    EXPECT_FALSE(LevelTessellation(quad, 1, getOptions(3).SetCoordStride(1)).IsValid());
    EXPECT_EQ(LevelTessellation(quad, -1).GetNumFacets(), 0);
    EXPECT_EQ(LevelTessellation(quad, -1).GetNumCoords(), 0);
    EXPECT_EQ(LevelTessellation(quad, -1).GetNumBoundaryCoords(), 0);
}

TEST(LevelTessellation, CopiesStayWhenItIsAssigned) {
    for (bool const isTree : {false, true}) {
        LevelTessellation tessellation = isTree ? LevelTessellation(BfrExt::CellTree(4, 2))
                                                : LevelTessellation(Parameterization(4), 2);
        LevelTessellation const copy = tessellation;
        tessellation = LevelTessellation(Parameterization(3), 0);
        EXPECT_EQ(tessellation.GetNumCoords(), 3);
        EXPECT_TRUE(copy.IsValid());
        EXPECT_EQ(copy.GetNumFacets(), 42);
        EXPECT_EQ(copy.GetNumCoords(), 28);
    }
}

TEST(Surface, IsInvalidWhereItIsMovedFrom) {
    Shape const &shape = GetShape("cube");
    auto const refiner = CreateRefiner(shape, ReferenceMask::Smooth, 0);
    auto const factory = BfrExt::SurfaceFactory::Create(*refiner);
    LevelTessellation const tessellation(Parameterization(4), 2);
    std::vector<std::vector<double>> results;
    // First with data of the surface's own, then with data that the factory has kept.
    for (int round = 0; round < 2; ++round) {
        BfrExt::Surface<double> from;
        ASSERT_TRUE(factory->InitVertexSurface(0, &from));
        BfrExt::Surface<double> const copy = from;
        BfrExt::Surface<double> const to = std::move(from);
        // NOLINTBEGIN(bugprone-use-after-move, clang-analyzer-cplusplus.Move)
        EXPECT_FALSE(from.IsValid());
        EXPECT_EQ(from.GetNumControlPoints(), 0);
        double untouched = 77;
        from.Evaluate(tessellation, shape.positions.data(), 3, &untouched, 3);
        EXPECT_EQ(untouched, 77);
        // NOLINTEND(bugprone-use-after-move, clang-analyzer-cplusplus.Move)
        for (BfrExt::Surface<double> const *const surface : {&copy, &to}) {
            std::vector<double> control(3 * std::size_t(surface->GetNumControlPoints()));
            surface->GatherControlPoints(shape.positions.data(), 3, control.data(), 3);
            results.emplace_back(3 * std::size_t(tessellation.GetNumCoords()));
            surface->Evaluate(tessellation, control.data(), 3, results.back().data(), 3);
            EXPECT_EQ(results.back(), results.front());
        }
    }
}

// Refused before any memory is taken for them.
TEST(LevelTessellation, IsInvalidForMoreIndicesThanAnIntCounts) {
    // A face of n sides has n (4^12 - 1)/3 half cells at level 12, of two triangles each.
    for (int const faceSize : {65, 290, 1000, 65535}) {
        LevelTessellation const tessellation(Parameterization(faceSize),
                                             LevelTessellation::kLastLevel);
        EXPECT_FALSE(tessellation.IsValid());
        EXPECT_EQ(tessellation.GetNumFacets(), 0);
        EXPECT_EQ(tessellation.GetNumCoords(), 0);
        EXPECT_EQ(tessellation.GetNumEdges(), 0);
    }
    EXPECT_TRUE(LevelTessellation(Parameterization(1000), 4).IsValid());
}

namespace {

/// Random levels for the edges and the insides of a mesh.
struct RandomLevels {
    RandomLevels(FarExt::TopologyLevel const &base, unsigned seed) : random(seed) {
        for (int edge = 0; edge < base.GetNumEdges(); ++edge) {
            edges.push_back(int(random() % 5));
        }
    }

    LevelTessellation Make(FarExt::TopologyLevel const &base, int face, int facetSize) {
        std::vector<int> levels;
        for (int const edge : base.GetFaceEdges(face)) {
            levels.push_back(edges[std::size_t(edge)]);
        }
        levels.push_back(int(random() % 4));
        return LevelTessellation(Parameterization(base.GetFaceVertices(face).size()),
                                 int(levels.size()), levels.data(), getOptions(facetSize));
    }

    std::mt19937 random;
    std::vector<int> edges;
};

/// The facets of all faces, joined where their points have the same bits.
template <typename REAL>
struct Welded {
    using Point = std::array<REAL, 3>;

    Welded(Shape const &shape, ReferenceMask mask, Sdc::Options const &options, unsigned seed,
           int facetSize) {
        auto const refiner = CreateRefiner(shape, mask, 0, options);
        FarExt::TopologyLevel const &base = refiner->GetLevel(0);
        std::vector<REAL> const positions(shape.positions.begin(), shape.positions.end());
        SurfaceSet<REAL> const surfaces(*refiner, positions);
        RandomLevels levels(base, seed);
        for (int face = 0; face < base.GetNumFaces(); ++face) {
            LevelTessellation const tessellation = levels.Make(base, face, facetSize);
            Surface<REAL> const &surface = surfaces[face];
            std::vector<REAL> control(3 * std::size_t(surface.GetNumControlPoints()));
            surface.GatherControlPoints(positions.data(), 3, control.data(), 3);
            std::vector<Point> points(std::size_t(tessellation.GetNumCoords()));
            surface.Evaluate(tessellation, control.data(), 3, points[0].data(), 3);
            for (std::vector<int> facet : GetFacets(tessellation)) {
                for (int &place : facet) {
                    place = numbers.emplace(points[std::size_t(place)], int(numbers.size()))
                                .first->second;
                }
                for (std::size_t i = 0; i < facet.size(); ++i) {
                    ++sides[{facet[i], facet[(i + 1) % facet.size()]}];
                }
                ++numFacets;
            }
        }
    }

    std::map<Point, int> numbers;
    std::map<std::pair<int, int>, int> sides;
    int numFacets = 0;
};

template <typename REAL>
void expectClosed(Shape const &shape, ReferenceMask mask, unsigned seed, int facetSize) {
    Welded<REAL> const welded(shape, mask, Sdc::Options(), seed, facetSize);
    for (auto const &[side, count] : welded.sides) {
        ASSERT_EQ(count, 1);
        ASSERT_EQ(welded.sides.count({side.second, side.first}), 1u);
    }
    std::set<std::pair<int, int>> edges;
    for (std::size_t corner = 0, face = 0; face < shape.faceSizes.size(); ++face) {
        auto const size = std::size_t(shape.faceSizes[face]);
        for (std::size_t i = 0; i < size; ++i) {
            edges.insert(std::minmax(shape.faceVertices[corner + i],
                                     shape.faceVertices[corner + (i + 1) % size]));
        }
        corner += size;
    }
    EXPECT_EQ(int(welded.numbers.size()) - int(welded.sides.size()) / 2 + welded.numFacets,
              shape.GetNumVertices() - int(edges.size()) + shape.GetNumFaces());
}

} // namespace

TEST(TessellationSurface, NeighboursShareTheirPointsToTheBit) {
    for (Shape const &shape : GetManifoldShapes()) {
        // The two sides of a dihedron lie in one place.
        if (!shape.closed || shape.GetNumFaces() > 40 || shape.name.find("dihedron") == 0) {
            continue;
        }
        SCOPED_TRACE(shape.name);
        for (unsigned seed = 0; seed < 3; ++seed) {
            ASSERT_NO_FATAL_FAILURE(
                expectClosed<double>(shape, ReferenceMask::Smooth, seed, int(3 * (seed % 2))));
            ASSERT_NO_FATAL_FAILURE(expectClosed<float>(shape, ReferenceMask::Average, seed, 4));
        }
    }
    for (char const *const name : {"creaseLoopClosed", "creasedBall"}) {
        SCOPED_TRACE(name);
        ASSERT_NO_FATAL_FAILURE(
            expectClosed<double>(GetFeatureShape(name), ReferenceMask::Cosine, 11, 0));
    }
}

TEST(TessellationSurface, PointsAreThoseOfSinglePlaces) {
    Sdc::Options options;
    options.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_EDGE_ONLY);
    // Faces of tori are plain; with Average, derivatives grow and shrink in steps.
    constexpr int kMaxFaces = 40;
    Shape const irregular = MakeTorus(9, 7, TorusFaces::IrregularTriangles);
    Shape const chamfered = MakeChamfered("chamfered", MakeTorus(7, 6, TorusFaces::Quads));
    for (auto const &[shape, mask] :
         {std::make_pair(GetFeatureShape("mixedSharpnessQuads"), ReferenceMask::Smooth),
          std::make_pair(GetFeatureShape("cornersTriangles"), ReferenceMask::Smooth),
          std::make_pair(GetFeatureShape("bowTieOfFans"), ReferenceMask::Smooth),
          std::make_pair(irregular, ReferenceMask::Average),
          std::make_pair(irregular, ReferenceMask::Smooth),
          std::make_pair(chamfered, ReferenceMask::Smooth)}) {
        SCOPED_TRACE(shape.name);
        auto const refiner = CreateRefiner(shape, mask, 0, options);
        FarExt::TopologyLevel const &base = refiner->GetLevel(0);
        SurfaceSet<double> const surfaces(*refiner, shape.positions);
        RandomLevels levels(base, 3);
        for (int face = 0; face < std::min(base.GetNumFaces(), kMaxFaces); ++face) {
            Surface<double> const &surface = surfaces[face];
            // At level 6, a face is taken apart further.
            LevelTessellation const tessellation =
                face == 0 ? LevelTessellation(surface.GetParameterization(), 6)
                          : levels.Make(base, face, 3);
            std::vector<double> control(4 * std::size_t(surface.GetNumControlPoints()));
            surface.GatherControlPoints(shape.positions.data(), 3, control.data(), {3, 4});
            auto const numPlaces = std::size_t(tessellation.GetNumCoords());
            std::vector<double> p(5 * numPlaces), du(5 * numPlaces), dv(5 * numPlaces);
            surface.Evaluate(tessellation, control.data(), {3, 4}, p.data(), du.data(), dv.data(),
                             {3, 5});
            std::vector<double> alone(3 * numPlaces);
            surface.Evaluate(tessellation, control.data(), {3, 4}, alone.data(), 3);
            std::vector<double> const coords = getCoords(tessellation);
            for (std::size_t i = 0; i < numPlaces; ++i) {
                SurfacePoint const expected = surfaces.Evaluate(face, &coords[2 * i]);
                std::vector<double> stencil(std::size_t(surface.GetNumControlPoints()));
                surface.EvaluateStencil(&coords[2 * i], stencil.data());
                double ofStencil[3];
                surface.ApplyStencil(stencil.data(), control.data(), {3, 4}, ofStencil);
                for (std::size_t k = 0; k < 3; ++k) {
                    ASSERT_NEAR(p[5 * i + k], expected.p[k], 1e-12);
                    ASSERT_NEAR(ofStencil[k], expected.p[k], 1e-12);
                    ASSERT_NEAR(du[5 * i + k], expected.du[k], 1e-10);
                    ASSERT_NEAR(dv[5 * i + k], expected.dv[k], 1e-10);
                    ASSERT_EQ(p[5 * i + k], alone[3 * i + k]);
                }
            }
        }
    }
}

// On the lines from the centre to corners derivatives are different on both sides, and with FaceMask::Average in
// all cells with a corner; trees have cells there on one side, the other, or both.
class TreeDerivativesTest : public testing::TestWithParam<ReferenceMask> {};

TEST_P(TreeDerivativesTest, AreThoseOfSinglePlaces) {
    constexpr int kFaceSize = 3;
    constexpr int kNumFaces = 6;
    Shape const shape = MakeTorus(9, 7, TorusFaces::IrregularTriangles);
    auto const refiner = CreateRefiner(shape, GetParam(), 0, Sdc::Options());
    SurfaceSet<double> const surfaces(*refiner, shape.positions);
    std::vector<BfrExt::CellTree> trees = {BfrExt::CellTree(kFaceSize, 4)};
    for (int refined = 0; refined <= kFaceSize; ++refined) {
        BfrExt::CellTree &tree = trees.emplace_back(kFaceSize);
        int const cell = tree.Refine(0) + refined;
        int const first = tree.Refine(cell);
        for (int child = 0; child < tree.GetNumChildren(cell); ++child) {
            tree.Refine(first + child);
        }
    }
    std::mt19937 random(3);
    for (int i = 0; i < 4; ++i) {
        trees.push_back(MakeRandomTree(kFaceSize, random));
    }
    for (int face = 0; face < kNumFaces; ++face) {
        Surface<double> const &surface = surfaces[face];
        std::vector<double> control(3 * std::size_t(surface.GetNumControlPoints()));
        surface.GatherControlPoints(shape.positions.data(), 3, control.data(), 3);
        for (BfrExt::CellTree const &tree : trees) {
            LevelTessellation const tessellation(tree);
            auto const numPlaces = std::size_t(tessellation.GetNumCoords());
            std::vector<double> p(3 * numPlaces), du(3 * numPlaces), dv(3 * numPlaces);
            surface.Evaluate(tessellation, control.data(), 3, p.data(), du.data(), dv.data(), 3);
            std::vector<double> const coords = getCoords(tessellation);
            for (std::size_t i = 0; i < numPlaces; ++i) {
                SurfacePoint const expected = surfaces.Evaluate(face, &coords[2 * i]);
                for (std::size_t k = 0; k < 3; ++k) {
                    ASSERT_NEAR(p[3 * i + k], expected.p[k], 1e-12);
                    ASSERT_NEAR(du[3 * i + k], expected.du[k], 1e-10);
                    ASSERT_NEAR(dv[3 * i + k], expected.dv[k], 1e-10);
                }
            }
        }
    }
}

INSTANTIATE_TEST_SUITE_P(, TreeDerivativesTest,
                         testing::Values(ReferenceMask::Average, ReferenceMask::Cosine,
                                         ReferenceMask::Smooth),
                         [](auto const &mask) { return std::string(ToString(mask.param)); });

// The neighbourhood of a face's edges and vertices has vertices twice around a tube of few faces, or is cut off at
// boundaries, though all faces around are those of a lattice: they are not all of one type.
TEST(TessellationSurface, BordersInCutLatticesAreThoseOfSinglePlaces) {
    constexpr int kNumFaces = 12;
    Sdc::Options options;
    options.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_NONE);
    std::vector<Shape> shapes = {GetFeatureShape("seamEndsInside")};
    for (int numU : {3, 4, 5}) {
        shapes.push_back(MakeTorus(numU, 8, TorusFaces::Triangles));
        shapes.push_back(MakeTorus(numU, 8, TorusFaces::Quads));
        shapes.push_back(MakeTorus(numU, numU, TorusFaces::Quads));
    }
    for (Shape const &shape : shapes) {
        for (ReferenceMask const mask :
             {ReferenceMask::Average, ReferenceMask::Cosine, ReferenceMask::Smooth}) {
            SCOPED_TRACE(shape.name);
            auto const refiner = CreateRefiner(shape, mask, 0, options);
            SurfaceSet<double> const surfaces(*refiner, shape.positions);
            for (int face = 0; face < std::min(shape.GetNumFaces(), kNumFaces); ++face) {
                Surface<double> const &surface = surfaces[face];
                if (!surface.IsValid()) {
                    continue;
                }
                LevelTessellation const tessellation(surface.GetParameterization(), 3);
                std::vector<double> control(3 * std::size_t(surface.GetNumControlPoints()));
                surface.GatherControlPoints(shape.positions.data(), 3, control.data(), 3);
                std::vector<double> p(3 * std::size_t(tessellation.GetNumCoords()));
                surface.Evaluate(tessellation, control.data(), 3, p.data(), 3);
                std::vector<double> const coords = getCoords(tessellation);
                for (std::size_t i = 0; i < std::size_t(tessellation.GetNumBoundaryCoords()); ++i) {
                    SurfacePoint const expected = surfaces.Evaluate(face, &coords[2 * i]);
                    for (std::size_t k = 0; k < 3; ++k) {
                        ASSERT_NEAR(p[3 * i + k], expected.p[k], 1e-12)
                            << "face " << face << " place " << i;
                    }
                }
            }
        }
    }
}

} // namespace OpenSubdivHex::Regression::levelTessellationTest
