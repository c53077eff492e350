// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_VTR_FVAR_LEVEL_H
#define OPENSUBDIVHEX_FAR_EXT_VTR_FVAR_LEVEL_H

#include "refinement.h"

namespace OpenSubdivHex::FarExt::internal {

/// \brief A face-varying channel at one level: relates the level to a mesh of its own, the *value
/// mesh*, whose vertices are the values.
///
/// The value mesh has the faces of the level, cut open along the channel's seams: a seam is a sharp boundary of
/// phase A to both sides.  So it refines as any mesh does, values of two charts never meet, and the
/// E-face of a seam edge falls into two half faces: the level's face is *split*.
///
/// A value that serves several fans of faces (several vertices, say) has a value vertex for each;
/// the first has the index of the value, the others follow the values of the channel.
struct FVarLevel {
    using Index = Far::Index;

    /// The edge of the value mesh that the mesh's face \p face has as its edge number \p local.
    Index GetFaceEdge(Index face, int local) const {
        Index valueFace = valueFaces[face];
        if (SplitFace const *split = FindSplitFace(face)) {
            valueFace = split->valueFaces[GetHalfOfEdge(local, split->end)];
            local = GetEdgeInHalf(local, split->end);
        }
        return values->faceEdges[values->faceFirstCorner[valueFace] + local];
    }

    struct SplitFace {
        Index face;                      ///< of the mesh
        Index valueFaces[2];             ///< its halves in the value mesh
        int end;                         ///< the corner where the seam ends
        std::vector<Index> cornerValues; ///< by corner; of the first half on the seam
    };
    SplitFace const *FindSplitFace(Index face) const {
        auto const found =
            std::lower_bound(splitFaces.begin(), splitFaces.end(), face,
                             [](SplitFace const &split, Index f) { return split.face < f; });
        return found != splitFaces.end() && found->face == face ? &*found : nullptr;
    }

    /// The cell of the value mesh that a cell of the mesh is; of a face that is split, each half is a face there.
    Cell GetValueCell(Cell cell) const {
        SplitFace const *const split = FindSplitFace(cell.face);
        return split ? Cell{split->valueFaces[cell.half], 0}
                     : Cell{valueFaces[cell.face], cell.half};
    }

    Level const *values = nullptr;     ///< the value mesh at this level
    Buffer<Index> valueFaces;          ///< its face, or first half, of each face of the mesh
    std::vector<SplitFace> splitFaces; ///< ascending
};

struct FVarChannel;

/// \brief The edges of \p mesh whose sides differ in a value, ascending.
///
/// \param faceValues  value of each corner of the mesh
std::vector<Far::Index> FindSeams(Level const &mesh, Far::Index const *faceValues);

/// \brief Makes level 0 of a channel of \p mesh, a level 0.
///
/// \param faceValues     value of each corner of the mesh
/// \param seams          of FindSeams()
/// \param sharpness      of the value of each corner, the same around a vertex for the same value:
///                       infinite for one that is to stay, else that of the vertex
void BuildFVarChannel(Level const &mesh, Far::Index numValues, Buffer<Far::Index> faceValues,
                      std::vector<Far::Index> const &seams, std::vector<float> const &sharpness,
                      Sdc::Options sdcOptions, FVarChannel &channel);

/// \brief Relates \p cLevel, of a channel whose value mesh was refined by \p values as the mesh was
/// by \p mesh, to the mesh.
void RefineFVarLevel(Refinement const &mesh, Refinement const &values, FVarLevel const &pLevel,
                     FVarLevel &cLevel);

} // namespace OpenSubdivHex::FarExt::internal

#endif
