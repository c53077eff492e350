// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_VTR_HEX_LEVEL_WRITER_H
#define OPENSUBDIVHEX_FAR_EXT_VTR_HEX_LEVEL_WRITER_H

#include "parallel.h"
#include "refinement.h"
#include "runs.h"

namespace OpenSubdivHex::FarExt::internal {

/// \brief Fills the relations of a level that a hexagonal refinement makes: all that have a place,
/// in the arrays that the caller has placed.
///
/// All that a component makes is written for that component alone, to places that are known in
/// advance, so that components can be taken in any order and in parallel; and it lies together, so
/// that memory is written from front to back.
///
/// Few components are *open*: they meet a boundary or a non-manifold vertex.  They are listed, and
/// hexLevelWriterOpen.cpp writes them one by one.  The others are *closed*: between the open ones
/// all places are closed-form but for shifts that are the same from one listed component to the
/// next, so that hexLevelWriterClosed.cpp writes whole runs, one array after the other.
class HexLevelWriter {
public:
    /// \p child has its counts, and \p refinement the E-faces of its parent's edges.
    HexLevelWriter(Refinement const &refinement, Level &child);

    /// Writes all relations of the child, or without full topology its face-vertices.
    void Write();

private:
    using Index = Far::Index;
    using LocalIndex = Far::LocalIndex;

    /// Where the faces and edges of a vertex begin in the arrays of all vertices.
    struct VertexOffsets {
        Index face;
        Index edge;
    };
    /// An edge as one of its faces sees it.
    struct FaceEdge {
        bool HasEFace() const { return eFace != Far::INDEX_INVALID; }

        Index eFace; ///< INDEX_INVALID for a B edge, which makes none
        EFaceSide const *side;
        bool isBoundary;
    };
    /// A corner with its neighbours in the face and the edges that end and start there.
    struct CornerEdges {
        Index prev;
        Index corner;
        Index next;
        FaceEdge inEdge;
        FaceEdge outEdge;
    };

    void listOpenFaces();
    void listOpenVertices();
    template <bool FULL>
    void fillFaces();
    template <bool FULL>
    void fillEFaces(Index begin, Index end, Index numBoundaryBefore);
    template <bool FULL>
    void fillBoundaryEFace(Index pEdge, Index numBoundaryBefore);
    void fillBoundaries();
    void fillOpenFace(Index pFace);
    void fillClosedFaces(Index begin, Index end);
    template <typename SIDES>
    void fillClosedFaces(Index begin, Index end, SIDES sides);
    template <typename SIDES>
    void fillFacesOfOneSize(Index begin, Index end, SIDES sides);
    template <int SIZE, typename SIDES>
    void fillFacesOfSize(Index begin, Index end, SIDES sides);
    template <typename SIDES>
    void fillFacesOfAnySize(Index begin, Index end, SIDES sides);
    template <typename WRITE, typename WRITE_CLOSED_FORM>
    void fillClosedCorners(Index begin, Index end, WRITE write, WRITE_CLOSED_FORM writeClosedForm);
    void fillClosedVertices(Index begin, Index end, Index numOpenBefore);
    void fillClosedVertexEdges(Index begin, Index end, VertexOffsets vertex);
    void fillFacesOfAnyValence(Index begin, Index end, Index firstPlace);
    void fillFacesOfValenceThree(Index begin, Index end, Index firstPlace);
    void fillOpenVertex(Index pVert, Index numOpenBefore);

    // The edge from a corner to the next, seen from the face.
    FaceEdge edgeFrom(Index pFace, Index pCorner) const {
        Index const pEdge = _p.faceEdges[pCorner];
        Index const eFace = _refinement.GetEdgeChildFace(pEdge);
        if (_p.IsBoundary(pEdge)) {
            return {eFace, &kBoundaryEFaceSide, true};
        }
        bool const isSideA = _p.edgeFaces[pEdge][0] == pFace;
        return {eFace, isSideA ? &kEFaceSideA : &kEFaceSideB, false};
    }
    CornerEdges cornerOf(Index pFace, LocalIndex local) const {
        Index const first = _p.faceFirstCorner[pFace];
        Index const last = _p.faceFirstCorner[pFace + 1] - 1;
        Index const corner = first + local;
        Index const prev = corner == first ? last : corner - 1;
        Index const next = corner == last ? first : corner + 1;
        return {prev, corner, next, edgeFrom(pFace, prev), edgeFrom(pFace, corner)};
    }
    Index numHalfFacesBefore(Index pFace) const {
        return Index(std::lower_bound(_p.halfFaces.begin(), _p.halfFaces.end(), pFace) -
                     _p.halfFaces.begin());
    }

    // A V-vertex has as many faces and edges as its parent, unless that is open.
    VertexOffsets vVertexOffsets(Index pVert, Index numOpenBefore) const {
        VertexOffsets const &shift = _vVertexShifts[numOpenBefore];
        return {_p.vertFirstFace[pVert] + shift.face, _p.vertFirstEdge[pVert] + shift.edge};
    }
    // F-vertices have three faces and edges, but for two in each half face that have two faces.
    VertexOffsets fVertexOffsets(Index pCorner, Index numHalfBefore) const {
        Index const numHalfFaces = Index(_p.halfFaces.size());
        Index const numRemaining = 3 * (_p.numCorners - pCorner);
        return {_c.numCorners - numRemaining + 2 * (numHalfFaces - numHalfBefore),
                2 * _c.numEdges - numRemaining};
    }

    void setEdge(Index cEdge, Index vert0, Index vert1, Index face0, Index face1, LocalIndex local0,
                 LocalIndex local1) {
        _c.edgeVerts[cEdge] = {vert0, vert1};
        _c.edgeFaces[cEdge] = {face0, face1};
        _c.edgeFaceLocals[cEdge] = {local0, local1};
    }
    void setBoundaryEdge(Index cEdge, Index vert0, Index vert1, Index face, BoundaryKind kind,
                         LocalIndex local) {
        setEdge(cEdge, vert0, vert1, face, kind, local, 0);
    }
    void addVertexEdge(VertexOffsets &vertex, Index cEdge, LocalIndex local) {
        if (!_c.vertEdgeLocals.empty()) {
            _c.vertEdgeLocals[vertex.edge] = local;
        }
        _c.vertEdges[vertex.edge++] = cEdge;
    }
    void addVertexFace(VertexOffsets &vertex, Index cFace, LocalIndex local) {
        _c.vertFaces[vertex.face] = cFace;
        _c.vertFaceLocals[vertex.face++] = local;
    }

    Refinement const &_refinement;
    Level const &_p;
    Level &_c;
    HexIndexing const _indexing;

    std::vector<Index> _openFaces; // have a boundary edge
    std::vector<Index> _openVerts; // on a boundary, or non-manifold
    // How far the offsets of V-vertices lie behind those of their parents, when n of the open
    // vertices come before.
    std::vector<VertexOffsets> _vVertexShifts;
};

} // namespace OpenSubdivHex::FarExt::internal

#endif
