// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_OSD_EXT_REFINEMENT_PREPARED_REFINEMENT_H
#define OPENSUBDIVHEX_OSD_EXT_REFINEMENT_PREPARED_REFINEMENT_H

#include "far_ext/vtr/refinement.h"
#include "far_ext/vtr/refinementRules.h"
#include "osd_ext/simd/quad.h"

#include <cstddef>
#include <memory>
#include <vector>

namespace OpenSubdivHex::OsdExt::internal {

/// \brief The mask of all plain faces of one size:
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
    /// For other faces: the weights of corner 0 twice in a row, so that every rotation of them is
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
    /// Where weights of the F-vertices around it begin, in vertexWeights; kEqual: all have faceWeight.
    int firstFaceWeight;
    static constexpr int kEqual = -1;
    Far::Index neighbors[2];
    float neighborWeights[2]; ///< 0 where there is none
};

/// \brief Things in groups, one group behind the other.
template <class ITEM>
struct Groups {
    std::vector<ITEM> items;
    std::vector<std::size_t> firsts = {0}; ///< by group, and the number of items

    /// Makes a group of the items added since the last call.
    void EndGroup() { firsts.push_back(items.size()); }

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

/// \brief Plain vertices of the parent, and those with weights by face.
struct VertexRun {
    Far::Index begin;
    Far::Index end;
    bool haveWeights;    ///< some, by face; all are before RefinementRules::GetEndOfVertexWeights()
    bool haveThreeFaces; ///< all of them
};

/// \brief A refinement prepared for evaluation: all that making the points of its child takes.
/// Refers to the parent level.
///
/// The groups are faces that follow one another, and vertices that do; the faces are done before the
/// vertices, and the groups of either side by side.  The last vertex of the level is never plain, nor
/// are its faces of 3 to 6 sides and the vertex whose F-vertex is the last: what plain faces and vertices
/// read may be read in packets that reach into the element behind.
struct PreparedRefinement {
    std::shared_ptr<FarExt::internal::RefinementRules const> rules; ///< null for a truncation
    PlainMasks masks;
    /// Plain faces of the parent, and hexagons with dense rules, in runs of one size.
    Groups<IndexRun> faceRuns;
    Groups<WeightedFace> weightedFaces;
    /// For a truncation, all vertices that it makes.
    Groups<ListedVertex> listedVertices;
    Groups<VertexRun> vertexRuns;
    Groups<WeightedVertex> weightedVertices;

    Far::Index numVVertices = 0; ///< F-vertices follow in the child
    FarExt::internal::Level const *parent = nullptr;

    std::vector<float> faceWeights; ///< of weighted faces, those of a rule once
    /// As RefinementRules::GetAllVertexWeights(): of vertices with weights by face.
    std::vector<float> vertexWeights;
    std::vector<DenseFaceMask> denseMasks; ///< of hexagons, by the number of their rule

    // Rules of listed vertices.
    std::vector<Far::Index> listedSources;
    std::vector<float> listedWeights;

    /// The corners around the vertices of the parent, as Level::vertFaces has their faces; none where
    /// plain vertices do not average these.
    FarExt::internal::Buffer<Far::Index> vertCorners;
};

void PrepareRefinement(std::shared_ptr<FarExt::internal::RefinementRules const> const &rules,
                       FarExt::internal::Refinement const &refinement,
                       PreparedRefinement &prepared);

} // namespace OpenSubdivHex::OsdExt::internal

#endif
