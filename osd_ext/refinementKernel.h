// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_OSD_EXT_REFINEMENT_KERNEL_H
#define OPENSUBDIVHEX_OSD_EXT_REFINEMENT_KERNEL_H

#include "far_ext/refinementMask.h"

#include <cstddef>
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
    int numFaces;
    std::size_t firstCorner; ///< position in weightedCorners
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

/// \brief One refinement step: all that it needs.
///
/// The faces are grouped into tiles, so that the new points of a tile are still in the cache when
/// the vertices between its faces are averaged: benchmark refinementEvaluation/quad5, 1.3 times as
/// fast for length 3, 1.7 times for length 8.  What is plain stands in records that are read from
/// first to last.
///
/// The last vertex of the level is never plain, nor are its faces of 3 to 6 sides and the vertex
/// whose F-vertex is the last: what plain faces and vertices read may be read in packets that reach
/// into the element behind.
struct RefinementStep {
    PlainMasks masks;
    Far::Index numVVertices = 0; ///< F-vertices follow in the child

    // By tile.
    Groups<Far::Index> plainFaces; ///< records: first corner, number of vertices, vertices
    Groups<WeightedFace> weightedFaces;
    std::vector<float> faceWeights;

    // By tile, if all faces of a vertex are in it; the other vertices follow in batches.
    Groups<Far::Index> plainVertices; ///< records: vertex, number of faces, its corners in them
    Groups<WeightedVertex> weightedVertices;
    std::vector<Far::Index> weightedCorners; ///< of weighted vertices in their faces
};

/// Makes \p step for the refinement of \p parent, with tiles of faces that follow each other in
/// \p faceOrder.
void MakeRefinementStep(FarExt::internal::RefinementMask const &mask,
                        FarExt::TopologyLevel const &parent,
                        std::vector<Far::Index> const &faceOrder, RefinementStep &step);

/// Of the order \p faceOrder of the faces of \p parent makes one for its child level, in which faces
/// that are near in the order are near in space, too: each face is replaced by its children.
std::vector<Far::Index> RefineFaceOrder(FarExt::TopologyLevel const &parent,
                                        std::vector<Far::Index> const &faceOrder);

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
