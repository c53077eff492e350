// SPDX-License-Identifier: Apache-2.0
#include "hexLevelWriter.h"

#include "indexSet.h"

namespace OpenSubdivHex::FarExt::internal {

void HexLevelWriter::listOpenFaces() {
    for (Index pEdge : _p.boundaryEdges) {
        _openFaces.push_back(_p.edgeFaces[pEdge][0]);
    }
    SortUnique(_openFaces);
}

// Where a fan of faces ends in a boundary edge with an E-face, its V-vertex has the E-face's
// boundary edge besides the spokes, and as many faces as there are E-faces.
void HexLevelWriter::listOpenVertices() {
    _openVerts = _p.nonManifoldVerts;
    for (Index pEdge : _p.boundaryEdges) {
        _openVerts.insert(_openVerts.end(), _p.edgeVerts[pEdge].begin(), _p.edgeVerts[pEdge].end());
    }
    SortUnique(_openVerts, _p.numVertices);
    VertexOffsets shift = {0, 0};
    _vVertexShifts.reserve(_openVerts.size() + 1);
    _vVertexShifts.push_back(shift);
    for (Index pVert : _openVerts) {
        Index const begin = _p.vertFirstFace[pVert];
        Index const end = _p.vertFirstFace[pVert + 1];
        Index numFaces = 0;
        Index numEdges = end - begin;
        for (Index i = begin; i < end; ++i) {
            CornerEdges const corner = cornerOf(_p.vertFaces[i], _p.vertFaceLocals[i]);
            bool const startsFan = corner.outEdge.isBoundary && corner.outEdge.HasEFace();
            bool const endsFan = corner.inEdge.isBoundary && corner.inEdge.HasEFace();
            numFaces += Index(corner.inEdge.HasEFace()) + Index(startsFan);
            numEdges += Index(startsFan) + Index(endsFan);
        }
        shift.face += numFaces - (end - begin);
        shift.edge += numEdges - (_p.vertFirstEdge[pVert + 1] - _p.vertFirstEdge[pVert]);
        _vVertexShifts.push_back(shift);
    }
}

// All of the E-face of a boundary edge but its edge that is on the boundary.
template <bool FULL>
void HexLevelWriter::fillBoundaryEFace(Index pEdge, Index numBoundaryBefore) {
    Index const cFace = _refinement.GetEdgeChildFace(pEdge);
    if (cFace == Far::INDEX_INVALID) {
        return;
    }
    EFaceSide const &side = kBoundaryEFaceSide;
    Index const numBBefore = _indexing.GetEdgeChildFace(pEdge, 0) - cFace;
    Index const cFirst =
        _indexing.GetEdgeChildFirstCorner(pEdge, numBBefore, numBoundaryBefore - numBBefore);
    CornerEdges const corner = cornerOf(_p.edgeFaces[pEdge][0], _p.edgeFaceLocals[pEdge][0]);
    _c.faceFirstCorner[cFace] = cFirst;
    Index *const verts = _c.faceVerts.data() + cFirst;
    verts[side.startVertex] = _indexing.GetVertexChildVertex(_p.edgeVerts[pEdge][0]);
    verts[side.endVertex] = _indexing.GetVertexChildVertex(_p.edgeVerts[pEdge][1]);
    verts[side.endFVertex] = _indexing.GetCornerChildVertex(corner.next);
    verts[side.startFVertex] = _indexing.GetCornerChildVertex(corner.corner);
    if constexpr (FULL) {
        Index *const edges = _c.faceEdges.data() + cFirst;
        edges[side.endSpoke] = _indexing.GetCornerChildSpoke(corner.next);
        edges[side.fFaceEdge] = _indexing.GetCornerChildEdge(corner.corner);
        edges[side.startSpoke] = _indexing.GetCornerChildSpoke(corner.corner);
    }
}

template void HexLevelWriter::fillBoundaryEFace<false>(Index pEdge, Index numBoundaryBefore);
template void HexLevelWriter::fillBoundaryEFace<true>(Index pEdge, Index numBoundaryBefore);

// Writes the components that corners of a face with boundary edges make, as fillClosedCorners does.
//
// An edge whose E-face is missing is a boundary: the edge of the F-face is a B edge then, and the
// spokes at its ends are A edges, each directed as its one face runs; the F-vertices at its ends
// have two faces, others have three.
void HexLevelWriter::fillOpenFace(Index pFace) {
    Index const cFace = _indexing.GetFaceChildFace(pFace);
    Index const first = _p.faceFirstCorner[pFace];
    Index const size = _p.faceFirstCorner[pFace + 1] - first;
    VertexOffsets vertex = fVertexOffsets(first, numHalfFacesBefore(pFace));
    for (Index i = 0; i < size; ++i) {
        LocalIndex const local = LocalIndex(i);
        CornerEdges const corner = cornerOf(pFace, local);
        FaceEdge const &in = corner.inEdge;
        FaceEdge const &out = corner.outEdge;
        Index const vVertex = _indexing.GetVertexChildVertex(_p.faceVerts[corner.corner]);
        Index const fVertex = _indexing.GetCornerChildVertex(corner.corner);
        Index const nextFVertex = _indexing.GetCornerChildVertex(corner.next);
        Index const fEdge = _indexing.GetCornerChildEdge(corner.corner);
        Index const spoke = _indexing.GetCornerChildSpoke(corner.corner);

        if (!out.HasEFace()) {
            setBoundaryEdge(fEdge, fVertex, nextFVertex, cFace, kSharpBoundaryB, local);
            setBoundaryEdge(spoke, vVertex, fVertex, in.eFace, kSharpBoundaryA, in.side->endSpoke);
        } else {
            setEdge(fEdge, fVertex, nextFVertex, cFace, out.eFace, local, out.side->fFaceEdge);
            if (!in.HasEFace()) {
                setBoundaryEdge(spoke, fVertex, vVertex, out.eFace, kSharpBoundaryA,
                                out.side->startSpoke);
            } else {
                setEdge(spoke, vVertex, fVertex, in.eFace, out.eFace, in.side->endSpoke,
                        out.side->startSpoke);
            }
        }

        _c.vertFirstFace[fVertex] = vertex.face;
        _c.vertFirstEdge[fVertex] = vertex.edge;
        if (!in.HasEFace()) {
            // The way around begins behind the missing face.
            addVertexEdge(vertex, spoke, 0);
            addVertexFace(vertex, out.eFace, out.side->startFVertex);
        }
        addVertexEdge(vertex, fEdge, 0);
        addVertexFace(vertex, cFace, local);
        addVertexEdge(vertex, _indexing.GetCornerChildEdge(corner.prev), 1);
        if (in.HasEFace()) {
            addVertexFace(vertex, in.eFace, in.side->endFVertex);
            addVertexEdge(vertex, spoke, 1);
            if (out.HasEFace()) {
                addVertexFace(vertex, out.eFace, out.side->startFVertex);
            }
        }
    }
}

// Where a fan of faces ends in a boundary edge with an E-face, that one's boundary edge comes first
// or last.
void HexLevelWriter::fillOpenVertex(Index pVert, Index numOpenBefore) {
    VertexOffsets vertex = vVertexOffsets(pVert, numOpenBefore);
    Index const cVert = _indexing.GetVertexChildVertex(pVert);
    _c.vertFirstFace[cVert] = vertex.face;
    _c.vertFirstEdge[cVert] = vertex.edge;
    auto const boundaryEdgeOf = [this](Index eFace) {
        return _c.faceEdges[_c.faceFirstCorner[eFace] + kBoundaryEFaceEdge];
    };
    for (Index i = _p.vertFirstFace[pVert]; i < _p.vertFirstFace[pVert + 1]; ++i) {
        CornerEdges const corner = cornerOf(_p.vertFaces[i], _p.vertFaceLocals[i]);
        FaceEdge const &in = corner.inEdge;
        FaceEdge const &out = corner.outEdge;
        if (out.isBoundary && out.HasEFace()) {
            addVertexEdge(vertex, boundaryEdgeOf(out.eFace), 0);
            addVertexFace(vertex, out.eFace, out.side->startVertex);
        }
        addVertexEdge(vertex, _indexing.GetCornerChildSpoke(corner.corner), in.HasEFace() ? 0 : 1);
        if (in.HasEFace()) {
            addVertexFace(vertex, in.eFace, in.side->endVertex);
            if (in.isBoundary) {
                addVertexEdge(vertex, boundaryEdgeOf(in.eFace), 1);
            }
        }
    }
}

// The edges on the boundary, and the half faces.
void HexLevelWriter::fillBoundaries() {
    std::size_t const numHalfFaces = _p.halfFaces.size();
    Index *bEdges = _c.boundaryEdges.data();
    Index *spokes = bEdges + numHalfFaces;
    for (std::size_t i = 0; i < numHalfFaces; ++i) {
        Index const pFace = _p.halfFaces[i];
        Index const corner = _p.faceFirstCorner[pFace] + kHalfFaceLongEdge;
        _c.halfFaces[i] = _indexing.GetFaceChildFace(pFace);
        bEdges[i] = _indexing.GetCornerChildEdge(corner);
        spokes[2 * i] = _indexing.GetCornerChildSpoke(corner);
        spokes[2 * i + 1] = _indexing.GetCornerChildSpoke(corner + 1);
    }
    Index *boundaryChildren = spokes + 2 * numHalfFaces;
    Index *halfEFaces = _c.halfFaces.data() + numHalfFaces;
    Index rank = 0;
    for (Index pEdge : _p.boundaryEdges) {
        if (_p.IsSharpBoundaryB(pEdge)) {
            continue;
        }
        Index const eFace = _refinement.GetEdgeChildFace(pEdge);
        Index const cEdge = _indexing.GetBoundaryChildEdge(rank);
        bool const isFree = _p.edgeFaces[pEdge][1] == kFreeBoundary;
        boundaryChildren[rank++] = cEdge;
        if (!isFree) {
            *halfEFaces++ = eFace;
        }
        _c.faceEdges[_c.faceFirstCorner[eFace] + kBoundaryEFaceEdge] = cEdge;
        setBoundaryEdge(cEdge, _indexing.GetVertexChildVertex(_p.edgeVerts[pEdge][0]),
                        _indexing.GetVertexChildVertex(_p.edgeVerts[pEdge][1]), eFace,
                        isFree ? kFreeBoundary : kSharpBoundaryB, kBoundaryEFaceEdge);
    }
}

} // namespace OpenSubdivHex::FarExt::internal
