// SPDX-License-Identifier: Apache-2.0
#include "topologyRefinement.h"

#include "sharpFeatures.h"

namespace OpenSubdivHex::FarExt::internal {

namespace {

using Index = Far::Index;
using LocalIndex = Far::LocalIndex;

// A corner's two neighbours in its face, and the E-faces of the two edges that meet there
// (INDEX_INVALID for a B edge, which makes none).
struct CornerRing {
    Index next;
    Index prev;
    Index outEdge; // from the corner to the next
    Index inEdge;  // from the previous corner
    Index outEFace;
    Index inEFace;
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
    void FillBoundaries();
    void FillVerticesOfVertices();
    void FillVerticesOfCorners();

private:
    // The side from which a face sees its edge.
    EFaceSide sideOf(Index pEdge, Index pFace) const {
        if (_p.IsBoundary(pEdge)) {
            return kBoundaryEFaceSide;
        }
        return _p.edgeFaces[2 * std::size_t(pEdge)] == pFace ? kEFaceSideA : kEFaceSideB;
    }

    CornerRing ringOf(Index pFace, Index pCorner) const {
        Index const first = _p.faceFirstCorner[pFace];
        Index const end = _p.faceFirstCorner[pFace + 1];
        CornerRing ring;
        ring.next = (pCorner + 1 == end) ? first : pCorner + 1;
        ring.prev = (pCorner == first) ? end - 1 : pCorner - 1;
        ring.outEdge = _p.faceEdges[pCorner];
        ring.inEdge = _p.faceEdges[ring.prev];
        ring.outEFace = _p.GetEdgeChildFace(ring.outEdge);
        ring.inEFace = _p.GetEdgeChildFace(ring.inEdge);
        ring.outSide = sideOf(ring.outEdge, pFace);
        ring.inSide = sideOf(ring.inEdge, pFace);
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

    // Calls function(pEdge, rank) for the boundary edges that make an E-face.
    template <typename FUNCTION>
    void forEachBoundaryEFace(FUNCTION function) const {
        Index rank = 0;
        for (Index pEdge : _p.boundaryEdges) {
            if (!_p.IsSharpBoundaryB(pEdge)) {
                function(pEdge, rank++);
            }
        }
    }

    void setEdge(Index cEdge, Index vert0, Index vert1, Index face0, Index face1, LocalIndex local0,
                 LocalIndex local1) {
        std::size_t const k = 2 * std::size_t(cEdge);
        _c.edgeVerts[k] = vert0;
        _c.edgeVerts[k + 1] = vert1;
        _c.edgeFaces[k] = face0;
        _c.edgeFaces[k + 1] = face1;
        _c.edgeFaceLocals[k] = local0;
        _c.edgeFaceLocals[k + 1] = local1;
    }
    void setBoundaryEdge(Index cEdge, Index vert0, Index vert1, Index face, BoundaryKind kind,
                         LocalIndex local) {
        setEdge(cEdge, vert0, vert1, face, kind, local, 0);
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
    Index numBBefore = 0;
    Index numBoundaryBefore = 0;
    for (Index pEdge = 0; pEdge < _p.numEdges; ++pEdge) {
        if (_p.IsSharpBoundaryB(pEdge)) {
            ++numBBefore;
            continue;
        }
        _c.faceFirstCorner[_indexing.GetEdgeChildFace(pEdge, numBBefore)] =
            _indexing.GetEdgeChildFirstCorner(pEdge, numBBefore, numBoundaryBefore);
        numBoundaryBefore += _p.IsBoundary(pEdge);
    }
    _c.faceFirstCorner[_c.numFaces] = _c.numCorners;
}

// Every corner writes its own corner of the F-face and its own side of its edge's E-face; that of
// a boundary edge has no other side, so its end vertex is written as well.
void Refinement::FillFaceVertices() {
    _c.faceVerts.Resize(_c.numCorners);
    forEachCorner([&](Index, Index pCorner, CornerRing const &ring) {
        _c.faceVerts[_indexing.GetFaceChildFirstCorner(pCorner)] =
            _indexing.GetCornerChildVertex(pCorner);
        if (ring.outEFace == Far::INDEX_INVALID) {
            return;
        }
        Index *verts = _c.faceVerts.data() + _c.faceFirstCorner[ring.outEFace];
        verts[ring.outSide.startVertex] = _indexing.GetVertexChildVertex(_p.faceVerts[pCorner]);
        verts[ring.outSide.startFVertex] = _indexing.GetCornerChildVertex(pCorner);
        verts[ring.outSide.endFVertex] = _indexing.GetCornerChildVertex(ring.next);
        if (_p.IsBoundary(ring.outEdge)) {
            verts[ring.outSide.endVertex] = _indexing.GetVertexChildVertex(_p.faceVerts[ring.next]);
        }
    });
}

void Refinement::FillFaceEdges() {
    _c.faceEdges.Resize(_c.numCorners);
    forEachCorner([&](Index, Index pCorner, CornerRing const &ring) {
        _c.faceEdges[_indexing.GetFaceChildFirstCorner(pCorner)] =
            _indexing.GetCornerChildEdge(pCorner);
        if (ring.outEFace == Far::INDEX_INVALID) {
            return;
        }
        Index *edges = _c.faceEdges.data() + _c.faceFirstCorner[ring.outEFace];
        edges[ring.outSide.fFaceEdge] = _indexing.GetCornerChildEdge(pCorner);
        edges[ring.outSide.startSpoke] = _indexing.GetCornerChildSpoke(pCorner);
        edges[ring.outSide.endSpoke] = _indexing.GetCornerChildSpoke(ring.next);
    });
    forEachBoundaryEFace([&](Index pEdge, Index rank) {
        Index const first = _c.faceFirstCorner[_p.GetEdgeChildFace(pEdge)];
        _c.faceEdges[first + kBoundaryEFaceEdge] = _indexing.GetBoundaryChildEdge(rank);
    });
}

// An edge whose E-face is missing is a boundary: the edge of the F-face is a B edge then, and the
// spokes at its ends are A edges, each directed as its one face runs.
void Refinement::FillEdges() {
    _c.edgeVerts.Resize(2 * std::size_t(_c.numEdges));
    _c.edgeFaces.Resize(2 * std::size_t(_c.numEdges));
    _c.edgeFaceLocals.Resize(2 * std::size_t(_c.numEdges));
    forEachCorner([&](Index pFace, Index pCorner, CornerRing const &ring) {
        Index const cFace = _indexing.GetFaceChildFace(pFace);
        Index const vVertex = _indexing.GetVertexChildVertex(_p.faceVerts[pCorner]);
        Index const fVertex = _indexing.GetCornerChildVertex(pCorner);
        Index const nextFVertex = _indexing.GetCornerChildVertex(ring.next);
        Index const edge = _indexing.GetCornerChildEdge(pCorner);
        Index const spoke = _indexing.GetCornerChildSpoke(pCorner);
        LocalIndex const local = LocalIndex(pCorner - _p.faceFirstCorner[pFace]);
        if (ring.outEFace == Far::INDEX_INVALID) {
            setBoundaryEdge(edge, fVertex, nextFVertex, cFace, kSharpBoundaryB, local);
            setBoundaryEdge(spoke, vVertex, fVertex, ring.inEFace, kSharpBoundaryA,
                            ring.inSide.endSpoke);
            return;
        }
        setEdge(edge, fVertex, nextFVertex, cFace, ring.outEFace, local, ring.outSide.fFaceEdge);
        if (ring.inEFace == Far::INDEX_INVALID) {
            setBoundaryEdge(spoke, fVertex, vVertex, ring.outEFace, kSharpBoundaryA,
                            ring.outSide.startSpoke);
        } else {
            // Seen from the V-vertex, the E-face of the incoming edge is left of the spoke.
            setEdge(spoke, vVertex, fVertex, ring.inEFace, ring.outEFace, ring.inSide.endSpoke,
                    ring.outSide.startSpoke);
        }
    });
    forEachBoundaryEFace([&](Index pEdge, Index rank) {
        std::size_t const k = 2 * std::size_t(pEdge);
        bool const isFree = _p.edgeFaces[k + 1] == kFreeBoundary;
        setBoundaryEdge(
            _indexing.GetBoundaryChildEdge(rank), _indexing.GetVertexChildVertex(_p.edgeVerts[k]),
            _indexing.GetVertexChildVertex(_p.edgeVerts[k + 1]), _p.GetEdgeChildFace(pEdge),
            isFree ? kFreeBoundary : kSharpBoundaryB, kBoundaryEFaceEdge);
    });
}

void Refinement::FillBoundaries() {
    std::size_t const numHalfFaces = _p.halfFaces.size();
    std::size_t const numBoundaryEFaces = _p.boundaryEdges.size() - numHalfFaces;
    _c.boundaryEdges.Resize(3 * numHalfFaces + numBoundaryEFaces);
    _c.halfFaces.Resize(numHalfFaces + std::size_t(_p.numSharpBoundariesA));
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
    forEachBoundaryEFace([&](Index pEdge, Index rank) {
        boundaryChildren[rank] = _indexing.GetBoundaryChildEdge(rank);
        if (_p.edgeFaces[2 * std::size_t(pEdge) + 1] == kSharpBoundaryA) {
            *halfEFaces++ = _p.GetEdgeChildFace(pEdge);
        }
    });
}

// Around a V-vertex the spokes take the place of the parent's faces and the E-faces that of its
// edges.  Where a fan of faces ends in a boundary edge with an E-face, that one's boundary edge
// comes first or last.
void Refinement::FillVerticesOfVertices() {
    _c.vertFirstFace.Resize(std::size_t(_c.numVertices) + 1);
    _c.vertFirstEdge.Resize(std::size_t(_c.numVertices) + 1);
    _c.vertFaces.Resize(_c.numCorners);
    _c.vertFaceLocals.Resize(_c.numCorners);
    _c.vertEdges.Resize(2 * std::size_t(_c.numEdges));
    _c.vertEdgeLocals.Resize(2 * std::size_t(_c.numEdges));

    Index nextFace = 0;
    Index nextEdge = 0;
    auto addEdge = [&](Index cEdge, LocalIndex local) {
        _c.vertEdges[nextEdge] = cEdge;
        _c.vertEdgeLocals[nextEdge++] = local;
    };
    auto addFace = [&](Index cFace, LocalIndex local) {
        _c.vertFaces[nextFace] = cFace;
        _c.vertFaceLocals[nextFace++] = local;
    };
    auto boundaryEdgeOf = [&](Index eFace) {
        return _c.faceEdges[_c.faceFirstCorner[eFace] + kBoundaryEFaceEdge];
    };

    for (Index pVert = 0; pVert < _p.numVertices; ++pVert) {
        Index const cVert = _indexing.GetVertexChildVertex(pVert);
        _c.vertFirstFace[cVert] = nextFace;
        _c.vertFirstEdge[cVert] = nextEdge;
        for (Index i = _p.vertFirstFace[pVert]; i < _p.vertFirstFace[pVert + 1]; ++i) {
            Index const pFace = _p.vertFaces[i];
            Index const pCorner = _p.faceFirstCorner[pFace] + _p.vertFaceLocals[i];
            CornerRing const ring = ringOf(pFace, pCorner);
            if (_p.IsBoundary(ring.outEdge) && ring.outEFace != Far::INDEX_INVALID) {
                addEdge(boundaryEdgeOf(ring.outEFace), 0);
                addFace(ring.outEFace, ring.outSide.startVertex);
            }
            addEdge(_indexing.GetCornerChildSpoke(pCorner),
                    ring.inEFace == Far::INDEX_INVALID ? 1 : 0);
            if (ring.inEFace != Far::INDEX_INVALID) {
                addFace(ring.inEFace, ring.inSide.endVertex);
                if (_p.IsBoundary(ring.inEdge)) {
                    addEdge(boundaryEdgeOf(ring.inEFace), 1);
                }
            }
        }
    }
    _c.vertFirstFace[_indexing.GetCornerChildVertex(0)] = nextFace;
    _c.vertFirstEdge[_indexing.GetCornerChildVertex(0)] = nextEdge;
}

// An F-vertex has three edges and, but for the ends of a B edge, three faces.
void Refinement::FillVerticesOfCorners() {
    forEachCorner([&](Index pFace, Index pCorner, CornerRing const &ring) {
        Index const cVert = _indexing.GetCornerChildVertex(pCorner);
        std::size_t face = _c.vertFirstFace[cVert];
        std::size_t edge = _c.vertFirstEdge[cVert];
        auto addFace = [&](Index cFace, LocalIndex local) {
            _c.vertFaces[face] = cFace;
            _c.vertFaceLocals[face++] = local;
        };
        auto addEdge = [&](Index cEdge, LocalIndex local) {
            _c.vertEdges[edge] = cEdge;
            _c.vertEdgeLocals[edge++] = local;
        };
        auto addFFace = [&] {
            addEdge(_indexing.GetCornerChildEdge(pCorner), 0);
            addFace(_indexing.GetFaceChildFace(pFace),
                    LocalIndex(pCorner - _p.faceFirstCorner[pFace]));
            addEdge(_indexing.GetCornerChildEdge(ring.prev), 1);
        };
        Index const spoke = _indexing.GetCornerChildSpoke(pCorner);
        if (ring.inEFace == Far::INDEX_INVALID) {
            addEdge(spoke, 0);
            addFace(ring.outEFace, ring.outSide.startFVertex);
            addFFace();
        } else {
            addFFace();
            addFace(ring.inEFace, ring.inSide.endFVertex);
            addEdge(spoke, 1);
            if (ring.outEFace != Far::INDEX_INVALID) {
                addFace(ring.outEFace, ring.outSide.startFVertex);
            }
        }
        _c.vertFirstFace[cVert + 1] = Index(face);
        _c.vertFirstEdge[cVert + 1] = Index(edge);
    });
}

// The relations that only a refined level has: to its children.
void fillChildRelations(LevelTopology &parent) {
    HexIndexing const indexing = parent.ChildIndexing();
    parent.faceChildFaces.Resize(parent.numFaces);
    for (Index pFace = 0; pFace < parent.numFaces; ++pFace) {
        parent.faceChildFaces[pFace] = indexing.GetFaceChildFace(pFace);
    }
    parent.edgeChildFaces.Resize(parent.halfFaces.empty() ? 0 : parent.numEdges);
    Index numBBefore = 0;
    for (std::size_t pEdge = 0; pEdge < parent.edgeChildFaces.size(); ++pEdge) {
        bool const isB = parent.IsSharpBoundaryB(Index(pEdge));
        parent.edgeChildFaces[pEdge] =
            isB ? Far::INDEX_INVALID : indexing.GetEdgeChildFace(Index(pEdge), numBBefore);
        numBBefore += isB;
    }
}

void clearRelations(LevelTopology &level) {
    for (Buffer<Index> *array : {&level.faceEdges, &level.edgeVerts, &level.edgeFaces,
                                 &level.boundaryEdges, &level.halfFaces, &level.vertFirstFace,
                                 &level.vertFaces, &level.vertFirstEdge, &level.vertEdges}) {
        array->Resize(0);
    }
    for (Buffer<LocalIndex> *array :
         {&level.edgeFaceLocals, &level.vertFaceLocals, &level.vertEdgeLocals}) {
        array->Resize(0);
    }
    level.sharpVerts.clear();
    level.sectorCorners.clear();
}

} // namespace

LevelSizes GetSizes(LevelTopology const &level) {
    return {level.numVertices,        level.numEdges,          level.numFaces,
            level.numCorners,         level.numFreeBoundaries, level.numSharpBoundariesA,
            level.numSharpBoundariesB};
}

// With A, B and free boundary edges: V' = V + C, E' = 2C + A + free, F' = F + E - B,
// C' = C + 6 (E - A - B - free) + 4 (A + free), A' = 2B, B' = A + B.  On a closed mesh C = 2E, so
// that E' = 4E, V' = V + 2E and C' = 4C: see INDEXING.md.
LevelSizes GetChildSizes(LevelSizes const &p) {
    std::int64_t const boundaryEFaces = p.freeBoundaries + p.sharpBoundariesA;
    std::int64_t const interiorEdges = p.edges - boundaryEFaces - p.sharpBoundariesB;
    return {p.vertices + p.corners,
            2 * p.corners + boundaryEFaces,
            p.faces + p.edges - p.sharpBoundariesB,
            p.corners + HexIndexing::kNumEFaceCorners * interiorEdges +
                HexIndexing::kNumBoundaryEFaceCorners * boundaryEFaces,
            p.freeBoundaries,
            2 * p.sharpBoundariesB,
            p.sharpBoundariesA + p.sharpBoundariesB};
}

void RefineTopology(LevelTopology &parent, Sdc::Options sdcOptions, bool fullTopology,
                    LevelTopology &child) {
    LevelSizes const sizes = GetChildSizes(GetSizes(parent));
    child.depth = parent.depth + 1;
    child.parent = &parent;
    child.child = nullptr;
    child.numVertices = Index(sizes.vertices);
    child.numEdges = Index(sizes.edges);
    child.numFaces = Index(sizes.faces);
    child.numCorners = Index(sizes.corners);
    child.numFreeBoundaries = Index(sizes.freeBoundaries);
    child.numSharpBoundariesA = Index(sizes.sharpBoundariesA);
    child.numSharpBoundariesB = Index(sizes.sharpBoundariesB);
    child.hasFullTopology = fullTopology;

    parent.child = &child;
    fillChildRelations(parent);

    Refinement refinement(parent, child);
    refinement.FillFaceOffsets();
    refinement.FillFaceVertices();
    if (fullTopology) {
        refinement.FillFaceEdges();
        refinement.FillEdges();
        refinement.FillBoundaries();
        refinement.FillVerticesOfVertices();
        refinement.FillVerticesOfCorners();
    } else {
        clearRelations(child);
    }
    RefineTags(parent, sdcOptions, child);
    if (fullTopology) {
        ComputeSharpMasks(sdcOptions, child);
    }
}

} // namespace OpenSubdivHex::FarExt::internal
