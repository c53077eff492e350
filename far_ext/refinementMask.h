// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_REFINEMENT_MASK_H
#define OPENSUBDIVHEX_FAR_EXT_REFINEMENT_MASK_H

#include "schemeOptions.h"
#include "topologyLevel.h"

#include <vector>

namespace OpenSubdivHex::FarExt::internal {

/// \brief Joins the masks to the components of a parent level: which vertices make an F-vertex or
/// a V-vertex, and with which weights.  PrimvarRefiner and the stencil factory both read it.
class OPENSUBDIVHEX_API RefinementMask {
public:
    using Index = Far::Index;

    /// The mask of a V-vertex: V' = vertexWeight V + faceWeight (sum of the F-vertices around it) +
    /// the sum of neighborWeights[i] neighbors[i], i < numNeighbors.
    struct VertexMask {
        double vertexWeight;
        double faceWeight;
        int numNeighbors;
        Index neighbors[2];
        double neighborWeights[2];
    };

    /// Makes the masks of the step from \p pLevel, to which it refers, to its child.
    RefinementMask(TopologyLevel const &pLevel, SchemeOptions schemeOptions,
                   Interpolation interpolation);

    /// Weights of the vertices of \p face, in their order, for the F-vertex of its corner number
    /// \p corner.  The result is valid until \p scratch is used again.
    double const *GetFaceVertexWeights(Index face, int corner, std::vector<double> &scratch) const;

    VertexMask GetVertexMask(Index vert) const {
        SharpVertex const *sharp =
            _hasSharpVertices ? _level.GetTopology().FindSharpVertex(vert) : nullptr;
        if (sharp) {
            return sharpMask(*sharp);
        }
        VertexVertexMask const mask = GetPlainVertexMask(_level.GetVertexFaces(vert).size());
        return {mask.vertexWeight, mask.faceWeight, 0, {}, {}};
    }

    /// @name The plain majority and the rest
    /// All faces of a size have the same weights, and all vertices with as many faces the same mask
    /// without neighbors, but for those that a feature gives others.
    /// @{

    /// The weights of corner 0 of a plain face; those of corner i lie i steps further around.
    double const *GetPlainFaceWeights(int faceSize) const { return smoothWeights(faceSize, 0); }
    VertexVertexMask GetPlainVertexMask(int numFaces) const {
        return numFaces < kNumKept ? _plainVertexMasks[numFaces]
                                   : ComputeVertexVertexMask(_interpolation, numFaces);
    }
    bool IsFacePlain(Index face) const { return !_hasFeatures || !hasFeatures(face); }
    /// All faces and vertices that are not plain, and perhaps some that are; ascending.
    std::vector<Index> FindFeatureFaces() const;
    std::vector<Index> FindFeatureVertices() const;
    /// @}

private:
    double const *smoothWeights(int faceSize, int corner) const {
        // The mask stands twice in a row, so that every rotation of it is contiguous.
        return _faceMasks[faceSize].data() + faceSize - corner;
    }

    static VertexMask sharpMask(SharpVertex const &sharp);
    bool hasFeatures(Index face) const;
    double const *featureWeights(Index face, int corner, std::vector<double> &scratch) const;

    TopologyLevel const _level;
    FaceMask _faceMask;
    bool _hasFeatures;
    bool _hasSharpVertices;
    Interpolation _interpolation;
    static constexpr int kNumKept = 8;
    VertexVertexMask _plainVertexMasks[kNumKept]; ///< by number of faces
    std::vector<std::vector<double>> _faceMasks;  ///< by face size

    // One row of weights per corner of a half face and of a hexagon with a sharp diagonal.
    double _halfFaceWeights[HexIndexing::kNumBoundaryEFaceCorners]
                           [HexIndexing::kNumBoundaryEFaceCorners];
    double _diagonalWeights[HexIndexing::kNumEFaceCorners][HexIndexing::kNumEFaceCorners];
};

} // namespace OpenSubdivHex::FarExt::internal

#endif
