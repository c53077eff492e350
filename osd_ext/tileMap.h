// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_OSD_EXT_TILE_MAP_H
#define OPENSUBDIVHEX_OSD_EXT_TILE_MAP_H

#include "far_ext/topologyLevel.h"

#include <cstdint>
#include <vector>

namespace OpenSubdivHex {

namespace Far = OpenSubdiv::Far;

namespace OsdExt::internal {

/// \brief Tiles of a mesh, parts that are near in space: which faces of a level belong to each, and
/// which vertices lie inside, having all their faces in one tile.
///
/// They are made of the faces of a level, as soon as there are enough of them; the levels before
/// are one tile each.  From then on each component is where its parent is.
class TileMap {
public:
    using Tile = std::uint16_t;
    static constexpr Tile kNoTile = 0xffff;

    /// Those of level 0, whose faces are taken for near in space when they are near in their order.
    TileMap(FarExt::TopologyLevel const &base, int numTiles);

    /// Goes on from \p parent to its child, which needs its full topology.
    void Refine(FarExt::TopologyLevel const &parent);

    int GetNumTiles() const { return _faceOrder.empty() ? _numTiles : 1; }

    /// By face of the level; ascending in space.
    std::vector<Tile> const &GetTilesOfFaces() const { return _tilesOfFaces; }

    /// @name The tile that a vertex lies inside
    /// kNoTile for some or all of the vertices whose faces are in several.  The first vertices of
    /// the level have a tile each, the F-vertices behind them share that of the parent's face.
    /// @{
    std::vector<Tile> const &GetTilesOfFirstVertices() const { return _tilesOfFirstVertices; }
    /// By face of the levels from which the other vertices come, the newest last: that many levels
    /// before this one.
    std::vector<std::vector<Tile>> const &GetTilesOfFVertices() const { return _tilesOfFVertices; }
    /// @}

private:
    void refineOrder(FarExt::TopologyLevel const &parent);
    void makeTiles(FarExt::TopologyLevel const &level);
    void makeVertexTiles(FarExt::TopologyLevel const &level);

    int _numTiles;
    std::vector<Far::Index> _faceOrder; ///< until there are tiles
    std::vector<Tile> _tilesOfFaces;
    std::vector<Tile> _tilesOfFirstVertices;
    std::vector<std::vector<Tile>> _tilesOfFVertices;
};

} // namespace OsdExt::internal
} // namespace OpenSubdivHex

#endif
