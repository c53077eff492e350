// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_VTR_REFINEMENT_ROWS_H
#define OPENSUBDIVHEX_FAR_EXT_VTR_REFINEMENT_ROWS_H

#include "refinement.h"
#include "refinementRules.h"
#include "truncationMask.h"

#include <optional>
#include <vector>

namespace OpenSubdivHex::FarExt::internal {

/// \brief A refinement as a matrix: for each vertex that it makes, the *row* of its sources and
/// their weights.  The one place that joins masks to components: primvars are refined, stencils
/// multiplied and limits found through it.
///
/// Rows are those of the V-vertices and then of the F-vertices, face by face.  Of a refinement that
/// is taken whole, all numbers are those of the levels.  Of a part, the vertices, faces and
/// V-vertices of the part are numbered without gaps, in the order that they have in the levels, so
/// that sums come out the same.
///
/// All rows of a truncation are those of V-vertices, whose sources are vertices of the parent alone.
class RefinementRows {
public:
    using Index = Far::Index;
    using LocalIndex = Far::LocalIndex;

    /// A part of a refinement: faces and vertices of the parent level, ascending.
    struct Part {
        std::vector<Index> verts;     ///< those that the faces have, and the parents of V-vertices
        std::vector<Index> faces;     ///< whose F-vertices are made
        std::vector<Index> vVertices; ///< V-vertices, by their index in the child level
    };

    /// The whole of \p refinement, which the rows refer to, as to its parent level.
    RefinementRows(Refinement const &refinement, HexSchemeOptions schemeOptions,
                   Interpolation interpolation);
    RefinementRows(Refinement const &refinement, HexSchemeOptions schemeOptions,
                   Interpolation interpolation, Part part);

    RefinementRows(RefinementRows const &) = delete;
    RefinementRows &operator=(RefinementRows const &) = delete;

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
        if (_truncation) {
            return;
        }
        for (Index k = _vertFirstFace[vert]; k < _vertFirstFace[vert + 1]; ++k) {
            function(_vertFaces[k], GetFaceFirstRow(_vertFaces[k]) + _vertFaceLocals[k]);
        }
    }
    /// Calls function(face, row, weight) for the same where they have a part in the rule of the vertex.
    template <typename FUNCTION>
    void ForEachFaceSource(Index vert, VertexRule const &rule, FUNCTION function) const {
        if (rule.HasFaces()) {
            int i = 0;
            ForEachVertexFace(
                vert, [&](Index face, Index row) { function(face, row, rule.GetFaceWeight(i++)); });
        }
    }
    bool HasVertexFaces(Index vert) const {
        return !_truncation && _vertFirstFace[vert] < _vertFirstFace[vert + 1];
    }
    /// Calls function(vert, weight) for the sources of a V-vertex, of whose parent \p rule is, beside
    /// the F-vertices around it.
    template <typename FUNCTION>
    void ForEachSource(Index vVertex, VertexRule const &rule, FUNCTION function) const {
        if (_truncation) {
            TruncationMask::Sources sources;
            getTruncationSources(vVertex, sources);
            for (std::size_t i = 0; i < sources.verts.size(); ++i) {
                function(sources.verts[i], sources.weights[i]);
            }
        }
        for (int i = 0; i < rule.numSources; ++i) {
            function(rule.sources[i], rule.weights[i]);
        }
    }

    /// As in RefinementRules, with the numbers of the rows.
    FaceRule GetFaceRule(Index face) const { return _rules->GetFaceRule(faceId(face)); }
    VertexRule GetVertexRule(Index vert) const {
        if (_truncation) {
            return {0, 0, {}, {}, nullptr};
        }
        return _part.verts.empty() ? _rules->GetVertexRule(vert) : partVertexRule(vert);
    }

private:
    VertexRule partVertexRule(Index vert) const;
    void getTruncationSources(Index vVertex, TruncationMask::Sources &sources) const;
    Index partVertex(Index vert) const;
    Index faceId(Index face) const { return _part.faces.empty() ? face : _part.faces[face]; }

    std::shared_ptr<RefinementRules const> const _rules;
    std::optional<TruncationMask> _truncation;
    Part _part; // empty when the refinement is taken whole
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

/// \brief Calls function(vertex, weight) for the vertices of the parent that a vertex of the child of a hexagonal
/// refinement is a sum of; a vertex may come more than once.
///
/// \param rules  of the refinement
template <typename FUNCTION>
void ForEachParentWeight(Refinement const &refinement, RefinementRules const &rules,
                         Far::Index cVert, FUNCTION function) {
    using Index = Far::Index;
    Level const &parent = *refinement.parent;
    auto const addFVertex = [&](Index face, int local, double factor) {
        Index const *const verts = parent.faceVerts.data() + parent.faceFirstCorner[face];
        FaceRule const rule = rules.GetFaceRule(face);
        double const *const weights = rule.GetRow(local);
        for (int i = 0; i < rule.GetSize(); ++i) {
            if (weights[i] > 0) {
                function(verts[i], factor * weights[i]);
            }
        }
    };
    if (cVert >= refinement.child->numVVertices) {
        Index const corner = refinement.GetChildVertexCorner(cVert);
        Index const face = parent.FindFaceOfCorner(corner);
        addFVertex(face, corner - parent.faceFirstCorner[face], 1);
        return;
    }
    Index const pVert = refinement.GetVVertexParent(cVert);
    VertexRule const ofVertex = rules.GetVertexRule(pVert);
    for (int i = 0; i < ofVertex.numSources; ++i) {
        function(ofVertex.sources[i], ofVertex.weights[i]);
    }
    if (ofVertex.HasFaces()) {
        Index const first = parent.vertFirstFace[pVert];
        for (Index k = first; k < parent.vertFirstFace[pVert + 1]; ++k) {
            addFVertex(parent.vertFaces[k], parent.vertFaceLocals[k],
                       ofVertex.GetFaceWeight(k - first));
        }
    }
}

/// The faces and V-vertices that make \p wanted vertices of the child, which ascend, and all that
/// these depend on in the parent.
RefinementRows::Part FindPart(Refinement const &refinement, HexSchemeOptions schemeOptions,
                              Interpolation interpolation, std::vector<Far::Index> const &wanted);

/// The vertices that a part makes, as indices of the child level, by row: they ascend.
std::vector<Far::Index> GetMadeVertices(Refinement const &refinement,
                                        RefinementRows::Part const &part);

/// \brief Writes dst[row] for the F-vertices of faces [begin, end) from src, which has the values of
/// the parent's vertices.
///
/// The elements follow Far's protocol: Clear() and AddWithWeight(element, REAL).  An element of
/// \p dst takes elements of \p src and of \p dst.
template <typename REAL, class SRC, class DST>
void InterpolateFaces(RefinementRows const &rows, Far::Index begin, Far::Index end, SRC const &src,
                      DST &dst) {
    for (Far::Index face = begin; face < end; ++face) {
        Far::Index const *const verts = rows.GetFaceVertices(face);
        FaceRule const rule = rows.GetFaceRule(face);
        int const size = rule.GetSize();
        for (int i = 0; i < size; ++i) {
            double const *const weights = rule.GetRow(i);
            auto &&point = dst[rows.GetFaceFirstRow(face) + i];
            point.Clear();
            for (int j = 0; j < size; ++j) {
                if (weights[j] > 0) {
                    point.AddWithWeight(src[verts[j]], REAL(weights[j]));
                }
            }
        }
    }
}

/// Overload for V-vertices [begin, end), whose F-vertices are made already.
template <typename REAL, class SRC, class DST>
void InterpolateVVertices(RefinementRows const &rows, Far::Index begin, Far::Index end,
                          SRC const &src, DST &dst) {
    for (Far::Index vVertex = begin; vVertex < end; ++vVertex) {
        Far::Index const pVert = rows.GetVVertexParent(vVertex);
        VertexRule const rule = rows.GetVertexRule(pVert);
        auto &&point = dst[vVertex];
        point.Clear();
        rows.ForEachSource(vVertex, rule, [&](Far::Index vert, double weight) {
            point.AddWithWeight(src[vert], REAL(weight));
        });
        rows.ForEachFaceSource(pVert, rule, [&](Far::Index, Far::Index row, double weight) {
            point.AddWithWeight(dst[row], REAL(weight));
        });
    }
}

/// Overload for all rows.
template <typename REAL, class SRC, class DST>
void Interpolate(RefinementRows const &rows, SRC const &src, DST &dst) {
    InterpolateFaces<REAL>(rows, 0, rows.GetNumFaces(), src, dst);
    InterpolateVVertices<REAL>(rows, 0, rows.GetNumVVertices(), src, dst);
}

} // namespace OpenSubdivHex::FarExt::internal

#endif
