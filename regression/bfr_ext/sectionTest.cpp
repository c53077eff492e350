// SPDX-License-Identifier: Apache-2.0
//
// Faces that come in sections, against the same as a whole.
#include "cellFixture.h"
#include "facets.h"
#include "streamFixture.h"

#include "regression/far_ext/referenceMatch.h"
#include "regression/shapes/featureShapes.h"
#include "regression/shapes/torus.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <mutex>
#include <set>

namespace OpenSubdivHex::Regression::sectionTest {

using BfrExt::CellForest;
using BfrExt::CellTree;
using BfrExt::LevelTessellation;
using BfrExt::PatchStream;
using BfrExt::SurfaceFactory;

namespace {

using Coord = std::array<double, 2>;
using Polygon = std::vector<Coord>; // from the least of its coordinates on

Polygon rotate(Polygon polygon) {
    std::rotate(polygon.begin(), std::min_element(polygon.begin(), polygon.end()), polygon.end());
    return polygon;
}

/// The output of a stream for one face, by places.
template <typename REAL>
struct FaceContents {
    std::map<Coord, std::vector<REAL>> points; // with derivatives and values
    std::multiset<Polygon> facets;
    /// Polygons as they come, for halves of hexagons.
    std::vector<Polygon> polygons;
    int numPatches = 0;
    /// Sides of sections inside of the face that no other section has backwards.
    std::map<std::vector<Coord>, int> boundaries;
};

template <typename REAL>
void add(typename PatchStream<REAL>::Patch const &patch, FaceContents<REAL> &contents) {
    LevelTessellation const &tessellation = patch.tessellation;
    ++contents.numPatches;
    auto const numCoords = std::size_t(tessellation.GetNumCoords());
    std::vector<Coord> coords(numCoords);
    tessellation.GetCoords(coords[0].data());
    auto const size = std::size_t(patch.pointSize);
    for (std::size_t i = 0; i < numCoords; ++i) {
        std::vector<REAL> values(patch.points + i * size, patch.points + (i + 1) * size);
        if (patch.du) {
            values.insert(values.end(), patch.du + i * size, patch.du + (i + 1) * size);
            values.insert(values.end(), patch.dv + i * size, patch.dv + (i + 1) * size);
            values.insert(values.end(), patch.values[0] + 2 * i, patch.values[0] + 2 * (i + 1));
        }
        auto const [found, isNew] = contents.points.emplace(coords[i], values);
        ASSERT_EQ(found->second, values) << "sections differ at a place that they share";
    }
    for (std::vector<int> const &facet : GetFacets(tessellation)) {
        Polygon polygon;
        for (int const place : facet) {
            polygon.push_back(coords[std::size_t(place)]);
        }
        contents.facets.insert(rotate(polygon));
        contents.polygons.push_back(std::move(polygon));
    }
    // An edge of a section is that of another, with the same points.
    std::vector<Coord> boundary(std::size_t(tessellation.GetNumBoundaryCoords()));
    tessellation.GetBoundaryCoords(boundary[0].data());
    std::size_t first = 0;
    for (int edge = 0; edge < tessellation.GetNumEdges(); ++edge) {
        Coord corner = {};
        tessellation.GetVertexCoord(edge, corner.data());
        ASSERT_EQ(corner, boundary[first]);
        std::vector<Coord> line;
        auto const count = std::size_t(tessellation.GetNumEdgeCoords(edge)) + 2;
        for (std::size_t i = 0; i < count; ++i) {
            line.push_back(boundary[(first + i) % boundary.size()]);
        }
        first += count - 1;
        std::vector<Coord> const reversed(line.rbegin(), line.rend());
        auto const other = contents.boundaries.find(reversed);
        if (other != contents.boundaries.end()) {
            contents.boundaries.erase(other);
        } else {
            ASSERT_EQ(++contents.boundaries[line], 1);
        }
    }
    ASSERT_EQ(first, boundary.size());
}

/// Joins halves of hexagons that lie in two sections.
void joinHalves(std::vector<Polygon> const &polygons, std::multiset<Polygon> const &whole,
                std::multiset<Polygon> &result) {
    std::map<std::pair<Coord, Coord>, Polygon> halves;
    for (Polygon const &polygon : polygons) {
        if (whole.count(rotate(polygon)) > 0) {
            result.insert(rotate(polygon));
            continue;
        }
        auto const other = halves.find({polygon[1], polygon[0]});
        if (other == halves.end()) {
            halves[{polygon[0], polygon[1]}] = polygon;
            continue;
        }
        Polygon hexagon = polygon;
        hexagon.insert(hexagon.begin() + 1, other->second.begin() + 2, other->second.end());
        result.insert(rotate(hexagon));
        halves.erase(other);
    }
    EXPECT_TRUE(halves.empty());
}

/// All faces of a stream, with little memory and as much as is needed.
template <typename REAL, typename MAKE>
void expectSections(Shape const &shape, SurfaceFactory const &factory, int facetSize,
                    bool hasDerivatives, MAKE const &makeStream) {
    SCOPED_TRACE(shape.name);
    using Stream = PatchStream<REAL>;
    std::vector<REAL> const positions(shape.positions.begin(), shape.positions.end());
    std::vector<FaceContents<REAL>> results[2];
    for (std::size_t i = 0; i < 2; ++i) {
        typename Stream::Options options;
        options.SetMaxMemory(i == 0 ? std::size_t(1) << 30 : 0);
        options.SetDerivatives(hasDerivatives);
        options.SetTessellationOptions(LevelTessellation::Options().SetFacetSize(facetSize));
        results[i].resize(std::size_t(factory.GetNumFaces()));
        std::mutex mutex;
        Stream const stream = makeStream(options);
        FarExt::CallStatus status;
        // The first numbers of positions are varying data, too.
        ASSERT_TRUE(stream.Run(
            positions.data(), 3, {{positions.data(), {2, 3}, Stream::Values::kVarying}}, 0,
            factory.GetNumFaces(),
            [&](typename Stream::Patch const &patch) {
                std::lock_guard<std::mutex> const lock(mutex);
                add<REAL>(patch, results[i][std::size_t(patch.face)]);
                return !testing::Test::HasFatalFailure();
            },
            &status))
            << status.GetErrorMessage();
    }
    int numCut = 0;
    for (std::size_t face = 0; face < results[0].size(); ++face) {
        FaceContents<REAL> const &whole = results[0][face];
        FaceContents<REAL> const &sections = results[1][face];
        ASSERT_EQ(whole.numPatches, 1);
        numCut += sections.numPatches > 1 ? 1 : 0;
        ASSERT_EQ(sections.points, whole.points) << "face " << face;
        if (facetSize == 0) {
            std::multiset<Polygon> facets;
            joinHalves(sections.polygons, whole.facets, facets);
            ASSERT_EQ(facets, whole.facets) << "face " << face;
        } else {
            ASSERT_EQ(sections.facets, whole.facets) << "face " << face;
        }
        // Lines that no other section has lie on the edges of the face.
        std::size_t numPoints = 0;
        for (auto const &[line, count] : sections.boundaries) {
            numPoints += line.size() - 1;
        }
        std::size_t numPointsOfWhole = 0;
        for (auto const &[line, count] : whole.boundaries) {
            numPointsOfWhole += line.size() - 1;
        }
        ASSERT_EQ(numPoints, numPointsOfWhole) << "face " << face;
    }
    EXPECT_GE(numCut, 1);
}

Sdc::Options getEdgeOnly() {
    Sdc::Options options;
    options.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_EDGE_ONLY);
    return options;
}

/// Face 0 finer than the others, or with a large tree.
template <typename REAL>
void expectShape(Shape const &shape, ReferenceMask mask, int level, int facetSize,
                 bool hasDerivatives) {
    auto const refiner = CreateRefiner(shape, mask, 0, getEdgeOnly());
    auto const factory = SurfaceFactory::Create(*refiner);
    using Stream = PatchStream<REAL>;
    using Options = typename Stream::Options;
    FarExt::TopologyLevel const &base = refiner->GetLevel(0);
    for (bool const isUniform : {true, false}) {
        RandomPatchLevels levels(base, 4, 3);
        levels.faces[0] = level;
        for (int local = 0; local < base.GetFaceEdges(0).size(); ++local) {
            int const edge = base.GetFaceEdges(0)[local];
            levels.edges[std::size_t(edge)] = isUniform ? level : level + 1 - local % 4;
        }
        expectSections<REAL>(
            shape, *factory, facetSize, hasDerivatives,
            [&](Options const &options) { return Stream(*factory, levels.Get(), options); });
    }
    // Edges of the second tree have the points of a level.
    int const size = base.GetFaceVertices(0).size();
    for (CellTree const &tree : {MakeLargeTree(size, 11), CellTree(size, level)}) {
        CellForest forest = MakeRandomForest(*refiner, 5);
        forest.SetTree(0, tree);
        forest.MatchEdges();
        expectSections<REAL>(
            shape, *factory, facetSize, hasDerivatives,
            [&](Options const &options) { return Stream(*factory, forest, options); });
    }
}

} // namespace

TEST(SectionTest, HaveThePointsAndFacetsOfTheWhole) {
    // In a lattice, where all points of a level are made by the face's type, and beside features.
    Shape const torus = MakeTorus(5, 5, TorusFaces::Quads);
    for (int const facetSize : {0, 3, 4}) {
        expectShape<float>(torus, ReferenceMask::Smooth, 7, facetSize, facetSize == 3);
    }
    expectShape<double>(GetFeatureShape("mixedSharpnessQuads"), ReferenceMask::Cosine, 7, 0, true);
    expectShape<double>(GetShape("icosahedron"), ReferenceMask::Average, 7, 3, false);
    expectShape<float>(GetShape("polygon9"), ReferenceMask::Smooth, 6, 0, false);
}

} // namespace OpenSubdivHex::Regression::sectionTest
