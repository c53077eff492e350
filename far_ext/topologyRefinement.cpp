// SPDX-License-Identifier: Apache-2.0
#include "topologyRefinement.h"

namespace OpenSubdivHex::FarExt::internal {

namespace {

using Index = Far::Index;
using LocalIndex = Far::LocalIndex;

// A corner's two neighbours in its face, and the E-faces of the two edges that meet there.
struct CornerRing {
    Index next;
    Index prev;
    Index outEFace; // of the edge from the corner to the next
    Index inEFace;  // of the edge from the previous corner
    EFaceSide outSide;
    EFaceSide inSide;
};

class Refinement {
public:
    Refinement(LevelTopology const &parent, LevelTopology &child)
        : _p(parent), _c(child), _indexing(parent.ChildIndexing()) {}

    void FillFaceOffsets();
    void FillFaceVertices();
    void FillFaceEdges();
    void FillEdges();
    void FillVerticesOfVertices();
    void FillVerticesOfCorners();

private:
    bool isBoundary(Index pEdge) const {
        return _p.edgeFaces[2 * std::size_t(pEdge) + 1] == Far::INDEX_INVALID;
    }

    // The side from which a face sees its edge, given the corner where the edge starts.
    EFaceSide sideOf(Index pEdge, Index pCorner) const {
        if (isBoundary(pEdge)) {
            return kBoundaryEFaceSide;
        }
        bool const startsHere = _p.edgeVerts[2 * std::size_t(pEdge)] == _p.faceVerts[pCorner];
        return startsHere ? kEFaceSideA : kEFaceSideB;
    }

    Index eFaceFirstCorner(Index eFace) const { return _c.faceFirstCorner[eFace]; }

    CornerRing ringOf(Index pFace, Index pCorner) const {
        Index const first = _p.faceFirstCorner[pFace];
        Index const end = _p.faceFirstCorner[pFace + 1];
        CornerRing ring;
        ring.next = (pCorner + 1 == end) ? first : pCorner + 1;
        ring.prev = (pCorner == first) ? end - 1 : pCorner - 1;
        Index const outEdge = _p.faceEdges[pCorner];
        Index const inEdge = _p.faceEdges[ring.prev];
        ring.outEFace = _indexing.GetEdgeChildFace(outEdge);
        ring.inEFace = _indexing.GetEdgeChildFace(inEdge);
        ring.outSide = sideOf(outEdge, pCorner);
        ring.inSide = sideOf(inEdge, ring.prev);
        return ring;
    }

    template <typename FUNCTION>
    void forEachCorner(FUNCTION function) const {
        for (Index pFace = 0; pFace < _p.numFaces; ++pFace) {
            Index const end = _p.faceFirstCorner[pFace + 1];
            for (Index pCorner = _p.faceFirstCorner[pFace]; pCorner < end; ++pCorner) {
                function(pFace, pCorner, ringOf(pFace, pCorner));
            }
        }
    }

    void setEdge(Index cEdge, Index vert0, Index vert1, Index face0, Index face1,
                 LocalIndex local0, LocalIndex local1) {
        std::size_t const k = 2 * std::size_t(cEdge);
        _c.edgeVerts[k] = vert0;
        _c.edgeVerts[k + 1] = vert1;
        _c.edgeFaces[k] = face0;
        _c.edgeFaces[k + 1] = face1;
        _c.edgeFaceLocals[k] = local0;
        _c.edgeFaceLocals[k + 1] = local1;
    }

    LevelTopology const &_p;
    LevelTopology &_c;
    HexIndexing _indexing;
};

void Refinement::FillFaceOffsets() {
    _c.faceFirstCorner.Resize(std::size_t(_c.numFaces) + 1);
    for (Index pFace = 0; pFace < _p.numFaces; ++pFace) {
        _c.faceFirstCorner[_indexing.GetFaceChildFace(pFace)] =
            _indexing.GetFaceChildFirstCorner(_p.faceFirstCorner[pFace]);
    }
    Index numBoundaryBefore = 0;
    for (Index pEdge = 0; pEdge < _p.numEdges; ++pEdge) {
        _c.faceFirstCorner[_indexing.GetEdgeChildFace(pEdge)] =
            _indexing.GetEdgeChildFirstCorner(pEdge, numBoundaryBefore);
        numBoundaryBefore += isBoundary(pEdge);
    }
    _c.faceFirstCorner[_c.numFaces] = _c.numCorners;
}

// Every corner writes its own corner of the F-face and its own side of its edge's E-face.
void Refinement::FillFaceVertices() {
    _c.faceVerts.Resize(_c.numCorners);
    forEachCorner([&](Index, Index pCorner, CornerRing const &ring) {
        Index const pVert = _p.faceVerts[pCorner];
        Index const first = eFaceFirstCorner(ring.outEFace);
        _c.faceVerts[_indexing.GetFaceChildFirstCorner(pCorner)] =
            _indexing.GetCornerChildVertex(pCorner);
        _c.faceVerts[first + ring.outSide.startVertex] = _indexing.GetVertexChildVertex(pVert);
        _c.faceVerts[first + ring.outSide.startFVertex] = _indexing.GetCornerChildVertex(pCorner);
        _c.faceVerts[first + ring.outSide.endFVertex] = _indexing.GetCornerChildVertex(ring.next);
    });
    for (Index pEdge : _p.boundaryEdges) {
        Index const first = eFaceFirstCorner(_indexing.GetEdgeChildFace(pEdge));
        _c.faceVerts[first + kBoundaryEFaceSide.endVertex] =
            _indexing.GetVertexChildVertex(_p.edgeVerts[2 * std::size_t(pEdge) + 1]);
    }
}

void Refinement::FillFaceEdges() {
    _c.faceEdges.Resize(_c.numCorners);
    forEachCorner([&](Index, Index pCorner, CornerRing const &ring) {
        Index const first = eFaceFirstCorner(ring.outEFace);
        _c.faceEdges[_indexing.GetFaceChildFirstCorner(pCorner)] =
            _indexing.GetCornerChildEdge(pCorner);
        _c.faceEdges[first + ring.outSide.fFaceEdge] = _indexing.GetCornerChildEdge(pCorner);
        _c.faceEdges[first + ring.outSide.startSpoke] = _indexing.GetCornerChildSpoke(pCorner);
        _c.faceEdges[first + ring.outSide.endSpoke] = _indexing.GetCornerChildSpoke(ring.next);
    });
    Index rank = 0;
    for (Index pEdge : _p.boundaryEdges) {
        Index const first = eFaceFirstCorner(_indexing.GetEdgeChildFace(pEdge));
        _c.faceEdges[first + kBoundaryEFaceEdge] = _indexing.GetBoundaryChildEdge(rank++);
    }
}

void Refinement::FillEdges() {
    _c.edgeVerts.Resize(2 * std::size_t(_c.numEdges));
    _c.edgeFaces.Resize(2 * std::size_t(_c.numEdges));
    _c.edgeFaceLocals.Resize(2 * std::size_t(_c.numEdges));
    forEachCorner([&](Index pFace, Index pCorner, CornerRing const &ring) {
        Index const cVert = _indexing.GetCornerChildVertex(pCorner);
        Index const local = pCorner - _p.faceFirstCorner[pFace];
        setEdge(_indexing.GetCornerChildEdge(pCorner), cVert,
                _indexing.GetCornerChildVertex(ring.next), _indexing.GetFaceChildFace(pFace),
                ring.outEFace, LocalIndex(local), ring.outSide.fFaceEdge);
        // Seen from the V-vertex, the E-face of the incoming edge lies to the left of the spoke.
        setEdge(_indexing.GetCornerChildSpoke(pCorner),
                _indexing.GetVertexChildVertex(_p.faceVerts[pCorner]), cVert, ring.inEFace,
                ring.outEFace, ring.inSide.endSpoke, ring.outSide.startSpoke);
    });
    _c.boundaryEdges.Resize(_p.boundaryEdges.size());
    Index rank = 0;
    for (Index pEdge : _p.boundaryEdges) {
        Index const cEdge = _indexing.GetBoundaryChildEdge(rank);
        setEdge(cEdge, _indexing.GetVertexChildVertex(_p.edgeVerts[2 * std::size_t(pEdge)]),
                _indexing.GetVertexChildVertex(_p.edgeVerts[2 * std::size_t(pEdge) + 1]),
                _indexing.GetEdgeChildFace(pEdge), Far::INDEX_INVALID, kBoundaryEFaceEdge, 0);
        _c.boundaryEdges[rank++] = cEdge;
    }
}

// Around a V-vertex the spokes take the place of the parent's faces and the E-faces that of its
// edges; at a boundary the first and last E-face are followed by a boundary edge each.
void Refinement::FillVerticesOfVertices() {
    std::size_t const numCornersOfAll = _c.numCorners;
    _c.vertFirstFace.Resize(std::size_t(_c.numVertices) + 1);
    _c.vertFirstEdge.Resize(std::size_t(_c.numVertices) + 1);
    _c.vertFaces.Resize(numCornersOfAll);
    _c.vertFaceLocals.Resize(numCornersOfAll);
    _c.vertEdges.Resize(2 * std::size_t(_c.numEdges));
    _c.vertEdgeLocals.Resize(2 * std::size_t(_c.numEdges));

    Index nextFace = 0;
    Index nextEdge = 0;
    auto addEdge = [&](Index cEdge, LocalIndex local) {
        _c.vertEdges[nextEdge] = cEdge;
        _c.vertEdgeLocals[nextEdge++] = local;
    };
    auto addEFace = [&](Index pVert, Index pEdge) {
        bool const isStart = _p.edgeVerts[2 * std::size_t(pEdge)] == pVert;
        EFaceSide const &side = isBoundary(pEdge) ? kBoundaryEFaceSide : kEFaceSideA;
        _c.vertFaces[nextFace] = _indexing.GetEdgeChildFace(pEdge);
        _c.vertFaceLocals[nextFace++] = isStart ? side.startVertex : side.endVertex;
    };
    auto addBoundaryEdge = [&](Index pVert, Index pEdge) {
        Index const first = eFaceFirstCorner(_indexing.GetEdgeChildFace(pEdge));
        bool const isStart = _p.edgeVerts[2 * std::size_t(pEdge)] == pVert;
        addEdge(_c.faceEdges[first + kBoundaryEFaceEdge], isStart ? 0 : 1);
    };

    for (Index pVert = 0; pVert < _p.numVertices; ++pVert) {
        Index const firstFace = _p.vertFirstFace[pVert];
        Index const numFaces = _p.vertFirstFace[pVert + 1] - firstFace;
        Index const *pEdges = _p.vertEdges.data() + _p.vertFirstEdge[pVert];
        Index const numEdges = _p.vertFirstEdge[pVert + 1] - _p.vertFirstEdge[pVert];
        bool const onBoundary = numEdges > numFaces;

        Index const cVert = _indexing.GetVertexChildVertex(pVert);
        _c.vertFirstFace[cVert] = nextFace;
        _c.vertFirstEdge[cVert] = nextEdge;
        if (onBoundary) {
            addBoundaryEdge(pVert, pEdges[0]);
            addEFace(pVert, pEdges[0]);
        }
        for (Index i = 0; i < numFaces; ++i) {
            Index const pFace = _p.vertFaces[firstFace + i];
            Index const pCorner = _p.faceFirstCorner[pFace] + _p.vertFaceLocals[firstFace + i];
            addEdge(_indexing.GetCornerChildSpoke(pCorner), 0);
            addEFace(pVert, pEdges[(i + 1) % numEdges]);
        }
        if (onBoundary) {
            addBoundaryEdge(pVert, pEdges[numEdges - 1]);
        }
    }
    // F-vertices follow, three faces and three edges each.
    Index const cFirst = _indexing.GetCornerChildVertex(0);
    for (Index i = 0; i <= _p.numCorners; ++i) {
        _c.vertFirstFace[cFirst + i] = nextFace + 3 * i;
        _c.vertFirstEdge[cFirst + i] = nextEdge + 3 * i;
    }
}

void Refinement::FillVerticesOfCorners() {
    forEachCorner([&](Index pFace, Index pCorner, CornerRing const &ring) {
        Index const cVert = _indexing.GetCornerChildVertex(pCorner);
        std::size_t const face = _c.vertFirstFace[cVert];
        _c.vertFaces[face] = _indexing.GetFaceChildFace(pFace);
        _c.vertFaces[face + 1] = ring.inEFace;
        _c.vertFaces[face + 2] = ring.outEFace;
        _c.vertFaceLocals[face] = LocalIndex(pCorner - _p.faceFirstCorner[pFace]);
        _c.vertFaceLocals[face + 1] = ring.inSide.endFVertex;
        _c.vertFaceLocals[face + 2] = ring.outSide.startFVertex;

        std::size_t const edge = _c.vertFirstEdge[cVert];
        _c.vertEdges[edge] = _indexing.GetCornerChildEdge(pCorner);
        _c.vertEdges[edge + 1] = _indexing.GetCornerChildEdge(ring.prev);
        _c.vertEdges[edge + 2] = _indexing.GetCornerChildSpoke(pCorner);
        _c.vertEdgeLocals[edge] = 0;
        _c.vertEdgeLocals[edge + 1] = 1;
        _c.vertEdgeLocals[edge + 2] = 1;
    });
}

} // namespace

LevelSizes GetSizes(LevelTopology const &level) {
    return {level.numVertices, level.numEdges, level.numFaces, level.numCorners,
            level.numBoundaryEdges};
}

LevelSizes GetChildSizes(LevelSizes const &p) {
    return {HexIndexing::GetNumChildVertices(p.vertices, p.corners),
            HexIndexing::GetNumChildEdges(p.corners, p.boundaryEdges),
            HexIndexing::GetNumChildFaces(p.faces, p.edges),
            HexIndexing::GetNumChildCorners(p.corners, p.edges, p.boundaryEdges),
            p.boundaryEdges};
}

void RefineTopology(LevelTopology &parent, LevelTopology &child, bool fullTopology) {
    LevelSizes const sizes = GetChildSizes(GetSizes(parent));
    child.depth = parent.depth + 1;
    child.parent = &parent;
    child.child = nullptr;
    child.numVertices = Index(sizes.vertices);
    child.numEdges = Index(sizes.edges);
    child.numFaces = Index(sizes.faces);
    child.numCorners = Index(sizes.corners);
    child.numBoundaryEdges = Index(sizes.boundaryEdges);
    child.hasFullTopology = fullTopology;

    parent.child = &child;
    parent.faceChildFaces.Resize(parent.numFaces);
    for (Index pFace = 0; pFace < parent.numFaces; ++pFace) {
        parent.faceChildFaces[pFace] = parent.ChildIndexing().GetFaceChildFace(pFace);
    }

    Refinement refinement(parent, child);
    refinement.FillFaceOffsets();
    refinement.FillFaceVertices();
    if (fullTopology) {
        refinement.FillFaceEdges();
        refinement.FillEdges();
        refinement.FillVerticesOfVertices();
        refinement.FillVerticesOfCorners();
    } else {
        child.ClearRelations();
    }
}

} // namespace OpenSubdivHex::FarExt::internal
