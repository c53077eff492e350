// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_REFINEMENT_MASK_H
#define OPENSUBDIVHEX_FAR_EXT_REFINEMENT_MASK_H

#include "mask.h"
#include "topologyLevel.h"

#include <map>
#include <vector>

namespace OpenSubdivHex::FarExt::internal {

/// \brief Joins the masks to the components of a parent level: which vertices make an F-vertex or
/// a V-vertex, and with which weights.  PrimvarRefiner and the stencil factory both read it.
template <typename REAL>
class RefinementMask {
public:
    using Index = Far::Index;

    /// The mask of a V-vertex: V' = vertexWeight V + faceWeight (sum of the F-vertices around it) +
    /// the sum of neighborWeights[i] neighbors[i], i < numNeighbors.
    struct VertexMask {
        REAL vertexWeight;
        REAL faceWeight;
        int numNeighbors;
        Index neighbors[2];
        REAL neighborWeights[2];
    };

    /// Makes masks for faces of the sizes that \p baseLevel and its refinements have.
    RefinementMask(TopologyLevel const &baseLevel, FaceMask faceMask, Interpolation interpolation);

    /// Weights of the vertices of \p face, in their order, for the F-vertex of its corner number
    /// \p corner.  \p scratch has room for a hexagon; the result may lie in it.
    REAL const *GetFaceVertexWeights(TopologyLevel const &level, Index face, int corner,
                                     REAL scratch[HexIndexing::kNumEFaceCorners]) const;

    VertexMask GetVertexMask(TopologyLevel const &level, Index vert) const;

private:
    REAL const *smoothWeights(int faceSize, int corner) const {
        // The mask stands twice in a row, so that every rotation of it is contiguous.
        return _faceMasks.find(faceSize)->second.data() + faceSize - corner;
    }

    Interpolation _interpolation;
    std::map<int, std::vector<REAL>> _faceMasks; ///< by face size

    // One row of weights per corner of a half face and of a hexagon with a sharp diagonal.
    REAL _halfFaceWeights[HexIndexing::kNumBoundaryEFaceCorners]
                         [HexIndexing::kNumBoundaryEFaceCorners];
    REAL _diagonalWeights[HexIndexing::kNumEFaceCorners][HexIndexing::kNumEFaceCorners];
};

extern template class RefinementMask<float>;
extern template class RefinementMask<double>;

} // namespace OpenSubdivHex::FarExt::internal

#endif
