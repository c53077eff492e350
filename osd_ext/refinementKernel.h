// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_OSD_EXT_REFINEMENT_KERNEL_H
#define OPENSUBDIVHEX_OSD_EXT_REFINEMENT_KERNEL_H

#include "far_ext/refinementMask.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace OpenSubdivHex {

namespace Far = OpenSubdiv::Far;

namespace OsdExt::internal {

/// \brief What all plain faces of one size share:
/// P_i = self V_i + neighbor (V_i-1 + V_i+1) + opposite V_i+3 + all (sum of V).
///
/// So are all masks of 3 to 6 sides, the opposite vertex being there with 6 alone, and Average of
/// any size.
struct PlainFaceMask {
    float self = 0;
    float neighbor = 0;
    float opposite = 0;
    float all = 0;
    /// Of other faces: the weights of corner 0 twice in a row, so that every rotation of them is
    /// contiguous.  Else empty.
    std::vector<float> weights;
};

/// \brief The masks that the plain faces and vertices of a level share.
struct PlainMasks {
    std::vector<PlainFaceMask> faces;   ///< by size; sizes that do not occur are not filled
    std::vector<float> verticesInverse; ///< by number of faces: V' = inverse (V + sum of P)
    bool averagesFaces = true;          ///< else V' = V
};

/// \brief A face with weights of its own: a row for each corner.
struct WeightedFace {
    Far::Index corner; ///< the first
    int size;
    Far::Index const *verts;
    std::size_t firstWeight; ///< position in faceWeights
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
    ITEM const *Begin(int group) const { return items.data() + firsts[std::size_t(group)]; }
    ITEM const *End(int group) const { return Begin(group + 1); }
};

/// \brief Components [begin, end).
struct IndexRun {
    Far::Index begin;
    Far::Index end;
};

/// \brief One refinement step: all that it needs.  Refers to the topology of the parent.
///
/// The faces are grouped into tiles, so that the new points of a tile are still in the cache when
/// the vertices between its faces are averaged: benchmark table-free, 1.3 times as fast for length
/// 3, 1.7 times for length 8.
///
/// The last vertex of the level is never plain, nor are its faces of 3 to 6 sides and the vertex
/// whose F-vertex is the last: what plain faces and vertices read may be read in packets that reach
/// into the element behind.
struct RefinementStep {
    PlainMasks masks;
    Far::Index numVVertices = 0; ///< F-vertices follow in the child
    FarExt::internal::LevelTopology const *parent = nullptr;

    // By tile.
    Groups<IndexRun> plainFaces;
    Groups<WeightedFace> weightedFaces;
    std::vector<float> faceWeights;

    // By tile, if all faces of a vertex are in it; the other vertices follow in batches.
    Groups<IndexRun> plainVertices;
    Groups<WeightedVertex> weightedVertices;
    /// Of each vertex in each of its faces: parallel to the parent's vertFaces.
    FarExt::internal::Buffer<Far::Index> vertCorners;
};

/// \brief Parts of a mesh, each near in space: the tile of each face of a level, at any level.
///
/// They are made of the faces of a level, as soon as there are enough of them; the faces of the
/// levels before have none.
class TileMap {
public:
    /// Those of level 0, whose faces are taken for near in space when they are near in their order.
    explicit TileMap(FarExt::TopologyLevel const &base);

    /// Goes on from \p parent to its child.
    void Refine(FarExt::TopologyLevel const &parent);

    /// The tile of each face of the level, below \p numTiles; ascending in space.
    std::vector<int> GetTiles(int numTiles) const;

private:
    void makeTiles(FarExt::TopologyLevel const &level);

    std::vector<Far::Index> _faceOrder; ///< until there are tiles
    std::vector<std::uint16_t> _tileOfFace;
};

/// Makes \p step for the refinement of \p parent.
void MakeRefinementStep(FarExt::internal::RefinementMask const &mask,
                        FarExt::TopologyLevel const &parent, TileMap const &tileMap,
                        RefinementStep &step);

/// \brief Elements of \c length floats, \c stride floats apart.
template <class FLOAT>
struct Elements {
    FLOAT *data;
    std::ptrdiff_t stride;
};

/// \brief Writes all vertices of the level that \p step makes.
///
/// The order of the arithmetic depends on the topology alone: the result has the same bits for any
/// number of threads, length, stride and place.
void RefineElements(RefinementStep const &step, int length, Elements<float const> src,
                    Elements<float> dst);

} // namespace OsdExt::internal
} // namespace OpenSubdivHex

#endif
