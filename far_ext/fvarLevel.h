// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_FVAR_LEVEL_H
#define OPENSUBDIVHEX_FAR_EXT_FVAR_LEVEL_H

#include "levelTopology.h"

namespace OpenSubdivHex::FarExt::internal {

/// \brief A face-varying channel at one level: a mesh of its own, whose vertices are the values.
///
/// It has the faces of the level, cut open along the channel's seams: a seam is a sharp boundary of
/// phase A to both sides.  So it refines as any mesh does, values of two charts never meet, and the
/// E-face of a seam edge falls into two half faces: the level's face is *split*.
///
/// A value that serves several fans of faces (several vertices, say) has a value vertex for each;
/// the first has the index of the value, the others follow the values of the channel.
struct FVarLevel {
    using Index = Far::Index;

    /// The edge of \p topology that the mesh's face \p face has as its edge number \p local.
    Index GetFaceEdge(Index face, int local) const {
        Index valueFace = valueFaces[face];
        if (SplitFace const *split = FindSplitFace(face)) {
            bool const inFirst = local >= kDiagonalEnd;
            valueFace = split->valueFaces[inFirst ? 0 : 1];
            local = inFirst ? local - kDiagonalEnd + 1 : local + 1;
        }
        return topology.faceEdges[topology.faceFirstCorner[valueFace] + local];
    }

    struct SplitFace {
        Index face;                                  ///< of the mesh
        Index valueFaces[2];                         ///< its halves in topology
        Index values[HexIndexing::kNumEFaceCorners]; ///< by corner; of the first half on the seam
    };
    SplitFace const *FindSplitFace(Index face) const {
        auto const found =
            std::lower_bound(splitFaces.begin(), splitFaces.end(), face,
                             [](SplitFace const &split, Index f) { return split.face < f; });
        return found != splitFaces.end() && found->face == face ? &*found : nullptr;
    }

    LevelTopology topology;
    Sdc::Options::FVarLinearInterpolation linearInterpolation =
        Sdc::Options::FVAR_LINEAR_CORNERS_ONLY;
    Buffer<Index> valueFaces; ///< face of topology, or first half, of each face of the mesh
    std::vector<SplitFace> splitFaces; ///< ascending

    // Of level 0 alone.
    Index numValues = 0;            ///< values of the user
    Buffer<Index> valuesOfVertices; ///< the value of each vertex of topology
    Buffer<Index> faceValues;       ///< the value of each corner of the mesh
};

/// \brief Makes the value mesh of a channel of \p mesh, a level 0.
///
/// \param faceValues     value of each corner of the mesh
/// \param sharpness      of the value of each corner, the same around a vertex for the same value:
///                       infinite for one that is to stay, else that of the vertex
void BuildFVarLevel(LevelTopology const &mesh, Far::Index numValues,
                    std::vector<Far::Index> const &faceValues, std::vector<float> const &sharpness,
                    Sdc::Options sdcOptions, FVarLevel &channel);

/// \brief Relates \p cChannel, whose value mesh was refined from that of \p pChannel by the same
/// step as \p cMesh from \p pMesh, to its mesh.
void RelateFVarLevels(LevelTopology const &pMesh, LevelTopology const &cMesh,
                      FVarLevel const &pChannel, FVarLevel &cChannel);

} // namespace OpenSubdivHex::FarExt::internal

#endif
