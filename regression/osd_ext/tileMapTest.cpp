// SPDX-License-Identifier: Apache-2.0
//
// The runs of TileMap against the faces around each vertex.
#include "osd_ext/refinement/tileMap.h"
#include "far_ext/topologyRefinerFactory.h"
#include "far_ext/vtr/hierarchy.h"
#include "regression/shapes/featureShapes.h"
#include "regression/shapes/shapeDescriptor.h"

#include <gtest/gtest.h>

#include <vector>

namespace OpenSubdivHex::Regression::tileMapTest {

using Far::Index;
using FarExt::TopologyLevel;
using OsdExt::internal::TileMap;
using Tile = TileMap::Tile;

namespace {

constexpr int kNumsOfTiles[] = {2, 7};
constexpr int kManyFaces = 16000; ///< of which most are no longer beside another tile

std::vector<Tile> getTilesOfFaces(TopologyLevel const &level, TileMap const &tileMap) {
    std::vector<Tile> tiles;
    for (TileMap::Run const &run : tileMap.GetFaceRuns()) {
        EXPECT_EQ(run.begin, Index(tiles.size()));
        EXPECT_LT(run.begin, run.end);
        EXPECT_LT(run.tile, tileMap.GetNumTiles());
        for (Index face = run.begin; face < run.end; ++face) {
            EXPECT_EQ(level.GetFaceVertices(face).size(), run.size) << "face " << face;
            tiles.push_back(run.tile);
        }
    }
    EXPECT_EQ(level.GetNumFaces(), Index(tiles.size()));
    return tiles;
}

/// The tiles that vertices lie inside, by vertex of \p level.
std::vector<Tile> getTilesOfVertices(TopologyLevel const &level, TileMap const &tileMap) {
    std::vector<Tile> tiles;
    auto const add = [&](Index count, Tile tile) {
        tiles.insert(tiles.end(), std::size_t(count), tile);
    };
    for (TileMap::Run const &run : tileMap.GetFirstVertexRuns()) {
        add(run.end - run.begin, run.tile);
    }
    for (std::vector<TileMap::Run> const &runs : tileMap.GetFVertexRuns()) {
        for (TileMap::Run const &run : runs) {
            add((run.end - run.begin) * run.size, run.tile);
        }
    }
    EXPECT_EQ(level.GetNumVertices(), Index(tiles.size()));
    return tiles;
}

/// Vertices that lie inside a tile have all of their faces there.  Gives their number.
int expectInside(TopologyLevel const &level, TileMap const &tileMap) {
    std::vector<Tile> const tilesOfFaces = getTilesOfFaces(level, tileMap);
    std::vector<Tile> const tilesOfVertices = getTilesOfVertices(level, tileMap);
    if (testing::Test::HasFailure()) {
        return 0;
    }
    int numInside = 0;
    for (Index vert = 0; vert < level.GetNumVertices(); ++vert) {
        Tile const tile = tilesOfVertices[std::size_t(vert)];
        if (tile != TileMap::kNoTile) {
            ++numInside;
            for (Index const face : level.GetVertexFaces(vert)) {
                EXPECT_EQ(tilesOfFaces[std::size_t(face)], tile)
                    << "level " << level.GetDepth() << ", vertex " << vert << ", face " << face;
            }
        }
    }
    return numInside;
}

void expectTiles(Shape const &shape, Sdc::Options sdcOptions,
                 FarExt::HexSchemeOptions schemeOptions) {
    FarExt::TopologyRefinerFactory::Options options;
    options.schemeOptions = schemeOptions;
    ShapeDescriptor const descriptor(shape);
    auto const refiner =
        FarExt::TopologyRefinerFactory::Create(descriptor.Get(), sdcOptions, options);
    FarExt::TopologyRefiner::UniformOptions uniform(GetTestLevel(shape, 6, 200000));
    uniform.fullTopologyInLastLevel = true;
    ASSERT_TRUE(refiner && refiner->RefineUniform(uniform));
    for (int numTiles : kNumsOfTiles) {
        FarExt::internal::MeshLevels const &levels = refiner->GetHierarchy().mesh;
        TileMap tileMap(levels.levels[0], numTiles);
        for (int level = 0; level <= refiner->GetMaxLevel(); ++level) {
            if (level > 0) {
                tileMap.Refine(levels.refinements[std::size_t(level) - 1],
                               level > 1 ? &levels.refinements[std::size_t(level) - 2] : nullptr);
            }
            TopologyLevel const &mesh = refiner->GetLevel(level);
            int const numInside = expectInside(mesh, tileMap);
            ASSERT_FALSE(testing::Test::HasFailure()) << numTiles << " tiles, level " << level;
            if (mesh.GetNumFaces() > kManyFaces) {
                EXPECT_EQ(tileMap.GetNumTiles(), numTiles);
                EXPECT_GT(numInside, mesh.GetNumVertices() / 2);
            }
        }
    }
}

TEST(TileMap, KnowsWhichVerticesLieInside) {
    for (Shape const &shape : GetAllShapes()) {
        for (auto boundary :
             {Sdc::Options::VTX_BOUNDARY_NONE, Sdc::Options::VTX_BOUNDARY_EDGE_ONLY}) {
            SCOPED_TRACE(testing::Message() << shape.name << ", boundary " << boundary);
            Sdc::Options options;
            options.SetVtxBoundaryInterpolation(boundary);
            ASSERT_NO_FATAL_FAILURE(expectTiles(shape, options, FarExt::HexSchemeOptions()));
        }
    }
}

TEST(TileMap, KnowsItInLevelsOfOtherSchemes) {
    FarExt::HexSchemeOptions dooSabin;
    dooSabin.schemeType = FarExt::SchemeType::DooSabin;
    FarExt::HexSchemeOptions triHexFirst;
    triHexFirst.firstStep = FarExt::FirstStep::TriHex;
    FarExt::HexSchemeOptions truncateFirst;
    truncateFirst.firstStep = FarExt::FirstStep::Truncate;
    for (Shape const *const shape : {&GetShape("cube"), &GetShape("prism64")}) {
        SCOPED_TRACE(shape->name);
        ASSERT_NO_FATAL_FAILURE(expectTiles(*shape, Sdc::Options(), dooSabin));
        ASSERT_NO_FATAL_FAILURE(expectTiles(*shape, Sdc::Options(), triHexFirst));
        ASSERT_NO_FATAL_FAILURE(expectTiles(*shape, Sdc::Options(), truncateFirst));
    }
}

} // namespace
} // namespace OpenSubdivHex::Regression::tileMapTest
