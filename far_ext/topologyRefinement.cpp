// SPDX-License-Identifier: Apache-2.0
#include "topologyRefinement.h"

#include "parallel.h"
#include "sharpFeatures.h"

#include <utility>

namespace OpenSubdivHex::FarExt::internal {

namespace {

using Index = Far::Index;
using LocalIndex = Far::LocalIndex;

// Which corners of an E-face run along the first side of their edge; known without a look at the
// edge, as the order of its vertices is always the same.
constexpr bool kEFaceCornerIsSideA[HexIndexing::kNumEFaceCorners] = {true, false, false,
                                                                     true, false, false};
constexpr bool kBoundaryEFaceCornerIsSideA[HexIndexing::kNumBoundaryEFaceCorners] = {true, true,
                                                                                     false, false};

// An edge as one of its faces sees it.
struct FaceEdge {
    bool HasEFace() const { return eFace != Far::INDEX_INVALID; }

    Index eFace;       // INDEX_INVALID for a B edge, which makes none
    Index firstCorner; // of the E-face
    EFaceSide const *side;
    bool isBoundary;
};

// Fills a child level.  All that a component makes is written by that component alone, to places
// that are known in advance, so that components can be taken in any order and in parallel.
//
// IS_IRREGULAR is for levels with boundaries or non-manifold vertices; without, all places are
// closed-form.
template <bool IS_IRREGULAR>
class Refinement {
public:
    Refinement(LevelTopology const &parent, LevelTopology &child)
        : _p(parent), _c(child), _indexing(parent.ChildIndexing()) {}

    void FillFaceVertices() {
        fillFaceOffsets();
        _c.faceVerts.Resize(_c.numCorners);
        ParallelFor(_p.numFaces, [this](Index pFace) { fillFaceVerticesOf(pFace); });
    }

    void FillRelations() {
        _c.faceEdges.Resize(_c.numCorners);
        _c.edgeVerts.Resize(2 * std::size_t(_c.numEdges));
        _c.edgeFaces.Resize(2 * std::size_t(_c.numEdges));
        _c.edgeFaceLocals.Resize(2 * std::size_t(_c.numEdges));
        _c.vertFirstFace.Resize(std::size_t(_c.numVertices) + 1);
        _c.vertFirstEdge.Resize(std::size_t(_c.numVertices) + 1);
        _c.vertFaces.Resize(_c.numCorners);
        _c.vertFaceLocals.Resize(_c.numCorners);
        _c.vertEdges.Resize(2 * std::size_t(_c.numEdges));
        _c.vertEdgeLocals.Resize(2 * std::size_t(_c.numEdges));
        fillBoundaries();
        fillVertexOffsets();
        ParallelFor(_p.numFaces, [this](Index pFace) { fillRelationsOfFace(pFace); });
        ParallelFor(_p.numVertices, [this](Index pVert) { fillRelationsOfVertex(pVert); });
    }

private:
    void fillFaceOffsets();
    void fillVertexOffsets();
    void fillBoundaries();
    void fillFaceVerticesOf(Index pFace);
    void fillRelationsOfFace(Index pFace);
    void fillRelationsOfVertex(Index pVert);

    bool isBoundary(Index pEdge) const {
        if constexpr (IS_IRREGULAR) {
            return _p.IsBoundary(pEdge);
        }
        static_cast<void>(pEdge);
        return false;
    }

    bool isSideA(Index pFace, int size, Index pCorner, Index pEdge) const {
        if (!_p.isHexagonal) {
            return _p.edgeFaces[2 * std::size_t(pEdge)] == pFace;
        }
        if (!_p.parent->ChildIndexing().IsFaceFromEdge(pFace)) {
            return true;
        }
        Index const local = pCorner - _p.faceFirstCorner[pFace];
        return size == HexIndexing::kNumEFaceCorners ? kEFaceCornerIsSideA[local]
                                                     : kBoundaryEFaceCornerIsSideA[local];
    }

    // The edge from a corner to the next, seen from the face.
    FaceEdge edgeFrom(Index pFace, int size, Index pCorner) const {
        Index const pEdge = _p.faceEdges[pCorner];
        if constexpr (IS_IRREGULAR) {
            Index const eFace = _p.GetEdgeChildFace(pEdge);
            Index const first = eFace < 0 ? Far::INDEX_INVALID : _c.faceFirstCorner[eFace];
            if (isBoundary(pEdge)) {
                return {eFace, first, &kBoundaryEFaceSide, true};
            }
            return {eFace, first,
                    isSideA(pFace, size, pCorner, pEdge) ? &kEFaceSideA : &kEFaceSideB, false};
        }
        return {_indexing.GetEdgeChildFace(pEdge, 0),
                _indexing.GetEdgeChildFirstCorner(pEdge, 0, 0),
                isSideA(pFace, size, pCorner, pEdge) ? &kEFaceSideA : &kEFaceSideB, false};
    }

    // Calls function(inEdge, outEdge, prev, pCorner, next) for all corners of a face.
    template <typename FUNCTION>
    void forEachCorner(Index pFace, FUNCTION function) const {
        Index const first = _p.faceFirstCorner[pFace];
        Index const last = _p.faceFirstCorner[pFace + 1] - 1;
        int const size = last - first + 1;
        FaceEdge inEdge = edgeFrom(pFace, size, last);
        Index prev = last;
        for (Index pCorner = first; pCorner <= last; ++pCorner) {
            FaceEdge const outEdge = edgeFrom(pFace, size, pCorner);
            function(inEdge, outEdge, prev, pCorner, pCorner == last ? first : pCorner + 1);
            inEdge = outEdge;
            prev = pCorner;
        }
    }

    // The edges of a face that end and start at a corner.
    std::pair<FaceEdge, FaceEdge> edgesAt(Index pFace, Index pCorner) const {
        Index const first = _p.faceFirstCorner[pFace];
        Index const last = _p.faceFirstCorner[pFace + 1] - 1;
        int const size = last - first + 1;
        return {edgeFrom(pFace, size, pCorner == first ? last : pCorner - 1),
                edgeFrom(pFace, size, pCorner)};
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
    HexIndexing const _indexing;
};

template <bool IS_IRREGULAR>
void Refinement<IS_IRREGULAR>::fillFaceOffsets() {
    _c.faceFirstCorner.Resize(std::size_t(_c.numFaces) + 1);
    ParallelFor(_p.numFaces, [this](Index pFace) {
        _c.faceFirstCorner[_indexing.GetFaceChildFace(pFace)] =
            _indexing.GetFaceChildFirstCorner(_p.faceFirstCorner[pFace]);
    });
    if constexpr (IS_IRREGULAR) {
        Index numBBefore = 0;
        Index numBoundaryBefore = 0;
        for (Index pEdge = 0; pEdge < _p.numEdges; ++pEdge) {
            if (_p.IsSharpBoundaryB(pEdge)) {
                ++numBBefore;
                continue;
            }
            _c.faceFirstCorner[_indexing.GetEdgeChildFace(pEdge, numBBefore)] =
                _indexing.GetEdgeChildFirstCorner(pEdge, numBBefore, numBoundaryBefore);
            numBoundaryBefore += isBoundary(pEdge);
        }
    } else {
        ParallelFor(_p.numEdges, [this](Index pEdge) {
            _c.faceFirstCorner[_indexing.GetEdgeChildFace(pEdge, 0)] =
                _indexing.GetEdgeChildFirstCorner(pEdge, 0, 0);
        });
    }
    _c.faceFirstCorner[_c.numFaces] = _c.numCorners;
}

// Every corner writes its own corner of the F-face and its own side of its edge's E-face; that of
// a boundary edge has no other side, so its end vertex is written as well.
template <bool IS_IRREGULAR>
void Refinement<IS_IRREGULAR>::fillFaceVerticesOf(Index pFace) {
    forEachCorner(
        pFace, [this](FaceEdge const &, FaceEdge const &edge, Index, Index pCorner, Index next) {
            Index const fVertex = _indexing.GetCornerChildVertex(pCorner);
            _c.faceVerts[_indexing.GetFaceChildFirstCorner(pCorner)] = fVertex;
            if (IS_IRREGULAR && !edge.HasEFace()) {
                return;
            }
            Index *verts = _c.faceVerts.data() + edge.firstCorner;
            verts[edge.side->startVertex] = _indexing.GetVertexChildVertex(_p.faceVerts[pCorner]);
            verts[edge.side->startFVertex] = fVertex;
            verts[edge.side->endFVertex] = _indexing.GetCornerChildVertex(next);
            if (IS_IRREGULAR && edge.isBoundary) {
                verts[edge.side->endVertex] = _indexing.GetVertexChildVertex(_p.faceVerts[next]);
            }
        });
}

// What the corners of a face make: their part of the face-edges, two edges each, and the relations
// of their F-vertices.
//
// An edge whose E-face is missing is a boundary: the edge of the F-face is a B edge then, and the
// spokes at its ends are A edges, each directed as its one face runs; the F-vertices at its ends
// have two faces, others have three.
template <bool IS_IRREGULAR>
void Refinement<IS_IRREGULAR>::fillRelationsOfFace(Index pFace) {
    Index const cFace = _indexing.GetFaceChildFace(pFace);
    Index const first = _p.faceFirstCorner[pFace];
    std::size_t face = _c.vertFirstFace[_indexing.GetCornerChildVertex(first)];
    std::size_t edge = _c.vertFirstEdge[_indexing.GetCornerChildVertex(first)];
    forEachCorner(pFace, [&](FaceEdge const &inEdge, FaceEdge const &outEdge, Index prev,
                             Index pCorner, Index next) {
        Index const vVertex = _indexing.GetVertexChildVertex(_p.faceVerts[pCorner]);
        Index const fVertex = _indexing.GetCornerChildVertex(pCorner);
        Index const nextFVertex = _indexing.GetCornerChildVertex(next);
        Index const fEdge = _indexing.GetCornerChildEdge(pCorner);
        Index const prevFEdge = _indexing.GetCornerChildEdge(prev);
        Index const spoke = _indexing.GetCornerChildSpoke(pCorner);
        LocalIndex const local = LocalIndex(pCorner - first);
        bool const hasOut = !IS_IRREGULAR || outEdge.HasEFace();
        bool const hasIn = !IS_IRREGULAR || inEdge.HasEFace();

        _c.faceEdges[_indexing.GetFaceChildFirstCorner(pCorner)] = fEdge;
        if (hasOut) {
            Index *edges = _c.faceEdges.data() + outEdge.firstCorner;
            edges[outEdge.side->fFaceEdge] = fEdge;
            edges[outEdge.side->startSpoke] = spoke;
            edges[outEdge.side->endSpoke] = _indexing.GetCornerChildSpoke(next);
        }

        if (!hasOut) {
            setBoundaryEdge(fEdge, fVertex, nextFVertex, cFace, kSharpBoundaryB, local);
            setBoundaryEdge(spoke, vVertex, fVertex, inEdge.eFace, kSharpBoundaryA,
                            inEdge.side->endSpoke);
        } else {
            setEdge(fEdge, fVertex, nextFVertex, cFace, outEdge.eFace, local,
                    outEdge.side->fFaceEdge);
            if (!hasIn) {
                setBoundaryEdge(spoke, fVertex, vVertex, outEdge.eFace, kSharpBoundaryA,
                                outEdge.side->startSpoke);
            } else {
                // Seen from the V-vertex, the E-face of the incoming edge is left of the spoke.
                setEdge(spoke, vVertex, fVertex, inEdge.eFace, outEdge.eFace, inEdge.side->endSpoke,
                        outEdge.side->startSpoke);
            }
        }

        _c.vertFirstFace[fVertex] = Index(face);
        _c.vertFirstEdge[fVertex] = Index(edge);
        auto addFace = [&](Index vertFace, LocalIndex vertLocal) {
            _c.vertFaces[face] = vertFace;
            _c.vertFaceLocals[face++] = vertLocal;
        };
        auto addEdge = [&](Index vertEdge, LocalIndex vertLocal) {
            _c.vertEdges[edge] = vertEdge;
            _c.vertEdgeLocals[edge++] = vertLocal;
        };
        if (!hasIn) {
            // The way around begins behind the missing face.
            addEdge(spoke, 0);
            addFace(outEdge.eFace, outEdge.side->startFVertex);
        }
        addEdge(fEdge, 0);
        addFace(cFace, local);
        addEdge(prevFEdge, 1);
        if (hasIn) {
            addFace(inEdge.eFace, inEdge.side->endFVertex);
            addEdge(spoke, 1);
            if (hasOut) {
                addFace(outEdge.eFace, outEdge.side->startFVertex);
            }
        }
    });
}

// Around a V-vertex the spokes take the place of the parent's faces and the E-faces that of its
// edges.  Where a fan of faces ends in a boundary edge with an E-face, that one's boundary edge
// comes first or last.
template <bool IS_IRREGULAR>
void Refinement<IS_IRREGULAR>::fillRelationsOfVertex(Index pVert) {
    Index const cVert = _indexing.GetVertexChildVertex(pVert);
    std::size_t face = _c.vertFirstFace[cVert];
    std::size_t edge = _c.vertFirstEdge[cVert];
    auto addEdge = [&](Index cEdge, LocalIndex local) {
        _c.vertEdges[edge] = cEdge;
        _c.vertEdgeLocals[edge++] = local;
    };
    auto addFace = [&](Index cFace, LocalIndex local) {
        _c.vertFaces[face] = cFace;
        _c.vertFaceLocals[face++] = local;
    };
    Index const begin = _p.vertFirstFace[pVert];
    Index const end = _p.vertFirstFace[pVert + 1];
    for (Index i = begin; i < end; ++i) {
        Index const pFace = _p.vertFaces[i];
        Index const pCorner = _p.faceFirstCorner[pFace] + _p.vertFaceLocals[i];
        Index const spoke = _indexing.GetCornerChildSpoke(pCorner);
        if constexpr (IS_IRREGULAR) {
            auto const [inEdge, outEdge] = edgesAt(pFace, pCorner);
            if (outEdge.isBoundary && outEdge.HasEFace()) {
                addEdge(_c.faceEdges[outEdge.firstCorner + kBoundaryEFaceEdge], 0);
                addFace(outEdge.eFace, outEdge.side->startVertex);
            }
            addEdge(spoke, inEdge.HasEFace() ? 0 : 1);
            if (inEdge.HasEFace()) {
                addFace(inEdge.eFace, inEdge.side->endVertex);
                if (inEdge.isBoundary) {
                    addEdge(_c.faceEdges[inEdge.firstCorner + kBoundaryEFaceEdge], 1);
                }
            }
        } else {
            // The edge behind the face comes next in the vertex's own list.
            Index const k = _p.vertFirstEdge[pVert] + (i + 1 == end ? 0 : i + 1 - begin);
            addEdge(spoke, 0);
            addFace(_indexing.GetEdgeChildFace(_p.vertEdges[k], 0),
                    _p.vertEdgeLocals[k] == 0 ? kEFaceSideA.startVertex : kEFaceSideA.endVertex);
        }
    }
}

// Where the faces and edges of each vertex begin: those of V-vertices, and of each parent face's
// first F-vertex; the others follow from it.
template <bool IS_IRREGULAR>
void Refinement<IS_IRREGULAR>::fillVertexOffsets() {
    Index numFaces = 0;
    Index numEdges = 0;
    if constexpr (IS_IRREGULAR) {
        for (Index pVert = 0; pVert < _p.numVertices; ++pVert) {
            Index const cVert = _indexing.GetVertexChildVertex(pVert);
            _c.vertFirstFace[cVert] = numFaces;
            _c.vertFirstEdge[cVert] = numEdges;
            for (Index i = _p.vertFirstFace[pVert]; i < _p.vertFirstFace[pVert + 1]; ++i) {
                Index const pFace = _p.vertFaces[i];
                auto const [inEdge, outEdge] =
                    edgesAt(pFace, _p.faceFirstCorner[pFace] + _p.vertFaceLocals[i]);
                bool const startsFan = outEdge.isBoundary && outEdge.HasEFace();
                bool const endsFan = inEdge.isBoundary && inEdge.HasEFace();
                numFaces += Index(inEdge.HasEFace()) + Index(startsFan);
                numEdges += 1 + Index(startsFan) + Index(endsFan);
            }
        }
        std::size_t half = 0;
        for (Index pFace = 0; pFace < _p.numFaces; ++pFace) {
            Index const first = _p.faceFirstCorner[pFace];
            Index const size = _p.faceFirstCorner[pFace + 1] - first;
            Index const fVertex = _indexing.GetCornerChildVertex(first);
            bool const isHalf = half < _p.halfFaces.size() && _p.halfFaces[half] == pFace;
            half += isHalf;
            _c.vertFirstFace[fVertex] = numFaces;
            _c.vertFirstEdge[fVertex] = numEdges;
            numFaces += 3 * size - (isHalf ? 2 : 0);
            numEdges += 3 * size;
        }
    } else {
        // A V-vertex has as many faces and edges as its parent, which come to numCorners in all.
        ParallelFor(_p.numVertices, [this](Index pVert) {
            Index const cVert = _indexing.GetVertexChildVertex(pVert);
            _c.vertFirstFace[cVert] = _p.vertFirstFace[pVert];
            _c.vertFirstEdge[cVert] = _p.vertFirstEdge[pVert];
        });
        ParallelFor(_p.numFaces, [this](Index pFace) {
            Index const first = _p.faceFirstCorner[pFace];
            Index const fVertex = _indexing.GetCornerChildVertex(first);
            _c.vertFirstFace[fVertex] = _p.numCorners + 3 * first;
            _c.vertFirstEdge[fVertex] = _p.numCorners + 3 * first;
        });
    }
    _c.vertFirstFace[_c.numVertices] = _c.numCorners;
    _c.vertFirstEdge[_c.numVertices] = 2 * _c.numEdges;
}

template <bool IS_IRREGULAR>
void Refinement<IS_IRREGULAR>::fillBoundaries() {
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
        std::size_t const k = 2 * std::size_t(pEdge);
        Index const eFace = _p.GetEdgeChildFace(pEdge);
        Index const cEdge = _indexing.GetBoundaryChildEdge(rank);
        bool const isFree = _p.edgeFaces[k + 1] == kFreeBoundary;
        boundaryChildren[rank] = cEdge;
        if (!isFree) {
            *halfEFaces++ = eFace;
        }
        _c.faceEdges[_c.faceFirstCorner[eFace] + kBoundaryEFaceEdge] = cEdge;
        setBoundaryEdge(cEdge, _indexing.GetVertexChildVertex(_p.edgeVerts[k]),
                        _indexing.GetVertexChildVertex(_p.edgeVerts[k + 1]), eFace,
                        isFree ? kFreeBoundary : kSharpBoundaryB, kBoundaryEFaceEdge);
    });
}

template <bool IS_IRREGULAR>
void fillLevel(LevelTopology const &parent, bool fullTopology, LevelTopology &child) {
    Refinement<IS_IRREGULAR> refinement(parent, child);
    refinement.FillFaceVertices();
    if (fullTopology) {
        refinement.FillRelations();
    }
}

// The relations that only a refined level has: to its children.
void fillChildRelations(LevelTopology &parent) {
    parent.numVVertices = parent.numVertices;
    parent.vertChildVerts.Resize(0);
    parent.vVertexParents.Resize(0);
    HexIndexing const indexing = parent.ChildIndexing();
    parent.faceChildFaces.Resize(parent.numFaces);
    ParallelFor(parent.numFaces, [&](Index pFace) {
        parent.faceChildFaces[pFace] = indexing.GetFaceChildFace(pFace);
    });
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

void BeginLevel(LevelSizes const &sizes, bool fullTopology, LevelTopology const &parent,
                LevelTopology &child) {
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
    child.partedVerts.clear();
    child.hasFullTopology = fullTopology;
}

void EndLevel(Sdc::Options sdcOptions, LevelTopology &parent, LevelTopology &child) {
    if (!child.hasFullTopology) {
        clearRelations(child);
    }
    RefineTags(parent, sdcOptions, child);
    if (child.hasFullTopology) {
        ComputeSharpMasks(sdcOptions, child);
    }
    // Last, so that a parent has no child that is only half made.
    parent.child = &child;
}

void RefineTopology(LevelTopology &parent, Sdc::Options sdcOptions, bool fullTopology,
                    LevelTopology &child) {
    BeginLevel(GetChildSizes(GetSizes(parent)), fullTopology, parent, child);
    child.isHexagonal = true;
    child.numVFaces = 0;
    child.faceSizes = parent.faceSizes;
    for (int size : {HexIndexing::kNumBoundaryEFaceCorners, HexIndexing::kNumEFaceCorners}) {
        auto const place =
            std::lower_bound(child.faceSizes.begin(), child.faceSizes.end(), Index(size));
        if (place == child.faceSizes.end() || *place != size) {
            child.faceSizes.insert(place, size);
        }
    }
    fillChildRelations(parent);
    if (parent.boundaryEdges.empty() && parent.nonManifoldVerts.empty()) {
        fillLevel<false>(parent, fullTopology, child);
    } else {
        fillLevel<true>(parent, fullTopology, child);
    }
    EndLevel(sdcOptions, parent, child);
}

} // namespace OpenSubdivHex::FarExt::internal
