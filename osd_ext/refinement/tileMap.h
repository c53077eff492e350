// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_OSD_EXT_REFINEMENT_TILE_MAP_H
#define OPENSUBDIVHEX_OSD_EXT_REFINEMENT_TILE_MAP_H

#include "far_ext/vtr/refinement.h"

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
///
/// Components are told in runs.  In hexagonal levels these follow from the numbering: time and
/// memory are those of the faces along the borders between tiles, not of all.
class TileMap {
public:
    using Index = Far::Index;
    using Level = FarExt::internal::Level;
    using Refinement = FarExt::internal::Refinement;
    using Tile = std::uint16_t;
    static constexpr Tile kNoTile = 0xffff;

    /// Components [begin, end) in one tile.
    struct Run {
        Index begin;
        Index end;
        Tile tile;
        int size = 0; ///< of faces, all of which have it
    };

    /// Those of level 0, whose faces are taken for near in space when they are near in their order.
    TileMap(Level const &base, int numTiles);

    /// Goes on to the child of \p refinement, which has its full topology.
    ///
    /// \param before  that of the parent, null when this is level 0
    void Refine(Refinement const &refinement, Refinement const *before);

    int GetNumTiles() const { return _faceOrder.empty() ? _numTiles : 1; }

    /// All faces of the level, ascending; tiles ascend in space.
    std::vector<Run> const &GetFaceRuns() const { return _faceRuns; }

    /// @name The tile that a vertex lies inside
    /// kNoTile for some or all of the vertices whose faces are in several.  The first vertices of
    /// the level have runs of their own, the F-vertices behind them share those of their faces.
    /// @{
    std::vector<Run> const &GetFirstVertexRuns() const { return _firstVertexRuns; }
    /// All faces of the levels from which the other vertices come, the newest last: that many
    /// levels before this one.
    std::vector<std::vector<Run>> const &GetFVertexRuns() const { return _fVertexRuns; }
    /// @}

private:
    /// An edge of a face that is in another tile than the face.
    struct Border {
        Index face;
        int local; ///< place of the edge in the face
        bool isSideA;
        Tile faceTile;
        Tile edgeTile;
    };

    void refineOrder(Refinement const &refinement);
    void makeTiles(Level const &level);
    void makeRuns(Level const &level, std::vector<Tile> const &tilesOfFaces);
    std::vector<Tile> getTilesOfFaces() const;
    std::vector<Tile> refineTilesOfFaces(Refinement const &refinement) const;
    Tile findTile(Index face) const;

    void findEdges(Level const &level);
    void refineEdges(Refinement const &refinement);
    std::vector<Run> refineBorders(Refinement const &refinement);
    std::vector<Run> getInnerFaceRuns() const;
    void addEFaces(Level const &parent);

    int _numTiles;
    std::vector<Index> _faceOrder; ///< until there are tiles
    std::vector<Run> _faceRuns;
    std::vector<Run> _firstVertexRuns;
    std::vector<std::vector<Run>> _fVertexRuns;

    // Of the level before.
    std::vector<Run> _edgeRuns;
    std::vector<Border> _borders; ///< ascending
};

} // namespace OsdExt::internal
} // namespace OpenSubdivHex

#endif
