// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_OSD_EXT_REFINEMENT_PREPARED_REFINEMENT_H
#define OPENSUBDIVHEX_OSD_EXT_REFINEMENT_PREPARED_REFINEMENT_H

#include "tileMap.h"

#include "far_ext/vtr/refinementRules.h"
#include "osd_ext/simd/quad.h"

#include <cstddef>
#include <memory>
#include <vector>

namespace OpenSubdivHex::OsdExt::internal {

/// \brief What all plain faces of one size share:
/// P_i = self V_i + neighbor (V_i-1 + V_i+1) + opposite V_i+3 + all (sum of V).
///
/// So are all masks of 3 to 6 sides, the opposite vertex being there with 6 alone, and Average of
/// any size.
struct PlainFaceMask {
    static constexpr int kMinSize = 3; ///< of faces; of such a face all are neighbors

    float self = 0;
    float neighbor = 0;
    float opposite = 0;
    float all = 0;
    /// Of other faces: the weights of corner 0 twice in a row, so that every rotation of them is
    /// contiguous.  Else empty.
    std::vector<float> weights;
};

/// The mask of faces with a rule.
PlainFaceMask MakePlainFaceMask(FarExt::internal::FaceRule const &circulant);

/// \brief The weights of a hexagon with a dense rule.
struct DenseFaceMask {
    static constexpr int kSize = 6;
    static constexpr int kRowStride = 8; ///< quads, so that vectors of them are aligned

    /// By vertex of the face, those of all rows, one behind the other, each weight four times.
    alignas(64) Quad weights[kSize][kRowStride];
};

/// \brief The masks that the plain faces and vertices of a level share.
struct PlainMasks {
    std::vector<PlainFaceMask> faces;   ///< by size; sizes that do not occur are not filled
    std::vector<float> verticesInverse; ///< by number of faces: V' = inverse (V + sum of P)
    bool averagesFaces = true;          ///< else V' = V
};

/// \brief A face that is in no run: a row of weights for each corner.
struct WeightedFace {
    Far::Index corner; ///< the first
    int size;
    Far::Index const *verts;
    std::size_t firstWeight; ///< position in faceWeights
};

/// \brief A vertex that a truncation makes, with sources of its own.
struct ListedVertex {
    Far::Index child; ///< in the level that is made
    int numSources;
    std::size_t firstSource; ///< position in listedSources and listedWeights
};

/// \brief A vertex with weights of its own.
struct WeightedVertex {
    Far::Index vert;
    Far::Index child; ///< in the level that is made
    float vertexWeight;
    float faceWeight;
    Far::Index neighbors[2];
    float neighborWeights[2]; ///< 0 where there is none
};

/// \brief Things in groups, one group behind the other.
template <class ITEM>
struct Groups {
    FarExt::internal::Buffer<ITEM> items;
    std::vector<std::size_t> firsts = {0}; ///< by group, and the number of items

    int GetNumGroups() const { return int(firsts.size()) - 1; }
    bool IsEmpty() const { return items.empty(); }
    ITEM const *Begin(int group) const { return items.data() + firsts[std::size_t(group)]; }
    ITEM const *End(int group) const { return Begin(group + 1); }
};

/// \brief Components [begin, end).
struct IndexRun {
    Far::Index begin;
    Far::Index end;
};

/// \brief A run of plain vertices, and where their corners begin in vertCorners.
struct VertexRun {
    Far::Index begin;
    Far::Index end;
    std::size_t firstCorner;
};

/// \brief A refinement prepared for evaluation: all that making the points of its child takes.
/// Refers to the parent level and to the two levels before it.
///
/// The faces are grouped into tiles, so that the new points of a tile are still in the cache when
/// the vertices between its faces are averaged: benchmark table-free, 1.3 times as fast for length
/// 3, 1.7 times for length 8.  The vertices are in the group of the tile that all their faces are
/// in; others follow in groups of their own, behind those of the tiles.
///
/// Most vertices were made of a corner one or two levels before: they are runs of the faces of
/// those corners.  Where hexagonal steps made the levels and have no sharp boundary, the numbering
/// tells where the F-vertices around them are (INDEXING.md).  Else one corner is listed for each,
/// and for all other vertices the corners around them.  The last vertex of the level is never
/// plain, nor are its faces of 3 to 6 sides and the vertex whose F-vertex is the last: what plain
/// faces and vertices read may be read in packets that reach into the element behind.
///
/// Groups are done side by side: those of tiles, and behind them those of vertices between tiles.
struct PreparedRefinement {
    std::shared_ptr<FarExt::internal::RefinementRules const> rules; ///< null for a truncation
    PlainMasks masks;
    /// Of the parent, plain faces and hexagons with dense rules, in runs of one size; all of one are F-faces or
    /// none is.
    Groups<IndexRun> faceRuns;
    Groups<WeightedFace> weightedFaces;
    /// Of a truncation, all vertices that it makes, in tiles of some each.
    Groups<ListedVertex> listedVertices;
    /// The faces of the level before the parent whose F-vertices, of all corners, are vertices of the parent,
    /// and those of the level before that one.
    Groups<IndexRun> newVertexFaces;
    Groups<IndexRun> olderVertexFaces;
    /// The other vertices of the parent.
    Groups<VertexRun> vertexRuns;
    Groups<WeightedVertex> weightedVertices;

    Far::Index numVVertices = 0; ///< F-vertices follow in the child
    FarExt::internal::Level const *parent = nullptr;
    /// The level before the parent, and the one before that; null where they are not there.
    FarExt::internal::Level const *before = nullptr;
    FarExt::internal::Level const *beforeThat = nullptr;
    int numTiles = 0;

    std::vector<float> faceWeights;        ///< of weighted faces, those of a rule once
    std::vector<DenseFaceMask> denseMasks; ///< of hexagons, by the number of their rule

    // Of listed vertices.
    std::vector<Far::Index> listedSources;
    std::vector<float> listedWeights;

    /// Where the numbering does not tell, by corner of the level before: its F-vertex's corner in
    /// the E-face of the edge from that corner to the next, side by side with that of the next.
    FarExt::internal::Buffer<Far::Index> startCorners;
    FarExt::internal::Buffer<Far::Index> vertCorners; ///< of each vertex of a run, in each face

    int GetNumVertexGroups() const { return vertexRuns.GetNumGroups(); }
};

/// The first faces of a level, which the hexagonal refinement made of faces and whose vertices follow
/// one another; 0 where it was another.
Far::Index GetNumFFaces(FarExt::internal::Level const &level);

/// The tiles for levels whose last one to be refined is \p lastParent.
int GetNumTiles(FarExt::internal::Level const &lastParent);

/// \brief Prepares the last of \p refinements, which lead to it from level 0.
///
/// \param tileMap  of its parent
void PrepareRefinement(std::shared_ptr<FarExt::internal::RefinementRules const> const &rules,
                       std::vector<FarExt::internal::Refinement const *> const &refinements,
                       TileMap const &tileMap, PreparedRefinement &prepared);

} // namespace OpenSubdivHex::OsdExt::internal

#endif
