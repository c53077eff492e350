// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_STENCIL_STEP_H
#define OPENSUBDIVHEX_FAR_EXT_STENCIL_STEP_H

#include "refinementMask.h"

#include <vector>

namespace OpenSubdivHex::FarExt::internal {

/// \brief The part of one refinement step that stencils are made of, in numbers of its own.
///
/// The vertices it makes, the *rows*, are V-vertices and then the F-vertices of its faces, in their
/// order; its faces' vertices are rows of the step before.  Of a step that is taken whole, all
/// numbers are those of the levels.  Of a step that makes only some faces and V-vertices these are
/// numbered without gaps; their order is that of the levels, so that stencils come out the same.
class StencilStep {
public:
    using Index = Far::Index;
    using LocalIndex = Far::LocalIndex;

    /// A part of a step: faces and vertices of the parent level, ascending.
    struct Part {
        std::vector<Index> verts;     ///< those that the faces have, and the parents of V-vertices
        std::vector<Index> faces;     ///< whose F-vertices are made
        std::vector<Index> vVertices; ///< V-vertices, by their index in the child level
    };

    /// The whole step from \p pLevel, which the step refers to.
    StencilStep(TopologyLevel const &pLevel, SchemeOptions schemeOptions,
                Interpolation interpolation);
    StencilStep(TopologyLevel const &pLevel, SchemeOptions schemeOptions,
                Interpolation interpolation, Part part);

    StencilStep(StencilStep const &) = delete;
    StencilStep &operator=(StencilStep const &) = delete;

    Index GetNumFaces() const { return _numFaces; }
    Index GetNumVVertices() const { return _numVVertices; }
    Index GetNumRows() const { return GetFaceFirstRow(_numFaces); }

    /// The row of the first F-vertex of a face; of number GetNumFaces(), the end of all rows.
    Index GetFaceFirstRow(Index face) const { return _numVVertices + _faceFirstCorner[face]; }
    int GetFaceSize(Index face) const {
        return _faceFirstCorner[face + 1] - _faceFirstCorner[face];
    }
    Index const *GetFaceVertices(Index face) const { return _faceVerts + _faceFirstCorner[face]; }
    /// The vertex of the corner that an F-vertex was made of.
    Index GetFVertexParent(Index row) const { return _faceVerts[row - _numVVertices]; }
    Index GetVVertexParent(Index vVertex) const {
        return _vVertexParents ? _vVertexParents[vVertex] : vVertex;
    }

    /// Calls function(face, row) for the faces around a parent of a V-vertex, in their order, with
    /// the F-vertex of each at the vertex.
    template <typename FUNCTION>
    void ForEachVertexFace(Index vert, FUNCTION function) const {
        for (Index k = _vertFirstFace[vert]; k < _vertFirstFace[vert + 1]; ++k) {
            function(_vertFaces[k], GetFaceFirstRow(_vertFaces[k]) + _vertFaceLocals[k]);
        }
    }
    bool HasVertexFaces(Index vert) const {
        return _vertFirstFace[vert] < _vertFirstFace[vert + 1];
    }

    /// As in RefinementMask, with the numbers of the step.
    bool IsFacePlain(Index face) const { return _mask.IsFacePlain(faceId(face)); }
    double const *GetPlainFaceWeights(int faceSize) const {
        return _mask.GetPlainFaceWeights(faceSize);
    }
    double const *GetFaceVertexWeights(Index face, int corner, std::vector<double> &scratch) const {
        return _mask.GetFaceVertexWeights(faceId(face), corner, scratch);
    }
    RefinementMask::VertexMask GetVertexMask(Index vert) const {
        return _part.verts.empty() ? _mask.GetVertexMask(vert) : partVertexMask(vert);
    }

private:
    RefinementMask::VertexMask partVertexMask(Index vert) const;
    Index faceId(Index face) const { return _part.faces.empty() ? face : _part.faces[face]; }

    RefinementMask const _mask;
    Part _part; // empty when the step is whole
    Index _numFaces;
    Index _numVVertices;
    Index const *_faceFirstCorner;
    Index const *_faceVerts;
    Index const *_vVertexParents; // null: their own indices
    Index const *_vertFirstFace;
    Index const *_vertFaces;
    LocalIndex const *_vertFaceLocals;

    // The arrays of a part.
    std::vector<Index> _partFaceFirstCorner;
    std::vector<Index> _partFaceVerts;
    std::vector<Index> _partVVertexParents;
    std::vector<Index> _partVertFirstFace;
    std::vector<Index> _partVertFaces;
    std::vector<LocalIndex> _partVertFaceLocals;
};

} // namespace OpenSubdivHex::FarExt::internal

#endif
