// SPDX-License-Identifier: Apache-2.0
#include "topologyRefinement.h"

#include "arrayWriter.h"
#include "parallel.h"
#include "sharpFeatures.h"

#include <type_traits>

namespace OpenSubdivHex::FarExt::internal {

namespace {

using Index = Far::Index;
using LocalIndex = Far::LocalIndex;

// Which sides of its edges a face is: by how much its F-vertices and edges in the E-face of the
// edge from a corner to the next come before those of side a, 0 or kEFaceSideShift.
//
// Known without a look at the edges where the hexagonal step made the face, as that always gives
// the vertices of an edge the same order.
struct SidesOfFFace {
    LocalIndex operator()(Index /* corner */, int /* local */) const { return 0; }
};
struct SidesOfEFace {
    LocalIndex operator()(Index /* corner */, int local) const {
        return IsEFaceSideA(local) ? 0 : kEFaceSideShift;
    }
};
struct SidesOfCorners {
    LocalIndex operator()(Index corner, int /* local */) const { return shifts[corner - first]; }

    LocalIndex const *shifts;
    Index first; // corner
};

// Bytes of a level above which it is written past the caches: less than most caches have, but they
// hold its parent as well.  Not on new pages: the system clears them in the caches.
//
// More for levels with all relations, which are read again when they are refined.
constexpr std::size_t kCacheSizeOfFaces = std::size_t(16) << 20;
constexpr std::size_t kCacheSizeOfAll = std::size_t(32) << 20;

// An edge as one of its faces sees it.
struct FaceEdge {
    bool HasEFace() const { return eFace != Far::INDEX_INVALID; }

    Index eFace; // INDEX_INVALID for a B edge, which makes none
    EFaceSide const *side;
    bool isBoundary;
};

// A corner with its neighbours in the face and the edges that end and start there.
struct FaceCorner {
    Index prev;
    Index corner;
    Index next;
    FaceEdge inEdge;
    FaceEdge outEdge;
};

// A corner of a face without boundary edges.
struct ClosedCorner {
    // Places in the E-faces of the edges that end and start here.
    LocalIndex InPlace(LocalIndex placeOfSideA) const { return LocalIndex(placeOfSideA - inShift); }
    LocalIndex OutPlace(LocalIndex placeOfSideA) const {
        return LocalIndex(placeOfSideA - outShift);
    }

    Index face;
    LocalIndex local; // its place in the face
    Index prev;
    Index corner;
    Index next;
    LocalIndex inShift; // of the sides that the face is of these edges
    LocalIndex outShift;
};

// Where the faces and edges of a vertex begin in the arrays of all vertices.
struct VertexOffsets {
    Index face;
    Index edge;
};

// LevelTopology::GetEdgeChildFace for loops.
class EFaceOfEdge {
public:
    explicit EFaceOfEdge(LevelTopology const &level)
        : _eFaces(level.edgeChildFaces.empty() ? nullptr : level.edgeChildFaces.data()),
          _indexing(level.ChildIndexing()) {}

    Index operator()(Index edge) const {
        return _eFaces ? _eFaces[edge] : _indexing.GetEdgeChildFace(edge, 0);
    }

private:
    Index const *_eFaces;
    HexIndexing _indexing;
};

// The parent corners where the sides of an interior edge start and end.
struct SideCorners {
    Index startA;
    Index endA;
    Index startB;
    Index endB;
};

void sortUnique(std::vector<Index> &indices) {
    std::sort(indices.begin(), indices.end());
    indices.erase(std::unique(indices.begin(), indices.end()), indices.end());
}

// The vertices of the last level that was not made by a hexagonal step.
Index getNumVertsOfAnyValence(LevelTopology const &level) {
    return level.isHexagonal ? getNumVertsOfAnyValence(*level.parent) : level.numVertices;
}

// Takes [begin, end) apart at the indices that are listed, ascending: calls regular(begin, end, n)
// for the runs between them and listed(index, n) for those themselves, in order; n of the listed
// indices come before.
template <typename LIST, typename REGULAR, typename LISTED>
void forEachRun(Index begin, Index end, LIST const &list, REGULAR regular, LISTED listed) {
    auto next = std::lower_bound(list.begin(), list.end(), begin);
    while (begin < end) {
        Index const numBefore = Index(next - list.begin());
        Index const runEnd = next == list.end() ? end : std::min(*next, end);
        if (begin < runEnd) {
            regular(begin, runEnd, numBefore);
        }
        if (runEnd < end) {
            listed(runEnd, numBefore);
            ++next;
        }
        begin = runEnd + 1;
    }
}

// Fills a child level.  All that a component makes is written by that component alone, to places
// that are known in advance, so that components can be taken in any order and in parallel; and it
// lies together, so that memory is written from front to back.
//
// Few components meet a boundary or a non-manifold vertex.  They are listed; between them all
// places are closed-form but for shifts that are the same from one listed component to the next.
class Refinement {
public:
    Refinement(LevelTopology const &parent, LevelTopology &child)
        : _p(parent), _c(child), _indexing(parent.ChildIndexing()),
          _numVertsOfAnyValence(getNumVertsOfAnyValence(parent)),
          _pastCaches(child.memory.size() >
                          (child.hasFullTopology ? kCacheSizeOfAll : kCacheSizeOfFaces) &&
                      IsResident(child.memory.data(), child.memory.size())) {}

    // Face-vertices alone.
    void FillFaces() { fillFaces<false>(); }
    // All relations.
    void FillAll() {
        listOpenFaces();
        listOpenVertices();
        fillFaces<true>();
        fillBoundaries();
        writeRanges(_p.numFaces, [this](Index begin, Index end) {
            forEachRun(
                begin, end, _openFaces,
                [this](Index runBegin, Index runEnd, Index) { fillClosedFaces(runBegin, runEnd); },
                [this](Index pFace, Index) { fillOpenFace(pFace); });
        });
        writeRanges(_p.numVertices, [this](Index begin, Index end) {
            forEachRun(
                begin, end, _openVerts,
                [this](Index runBegin, Index runEnd, Index numOpenBefore) {
                    fillClosedVertices(runBegin, runEnd, numOpenBefore);
                },
                [this](Index pVert, Index numOpenBefore) { fillOpenVertex(pVert, numOpenBefore); });
        });
        _c.vertFirstFace[_c.numVertices] = _c.numCorners;
        _c.vertFirstEdge[_c.numVertices] = 2 * _c.numEdges;
    }

private:
    void listOpenFaces();
    void listOpenVertices();
    template <bool FULL>
    void fillFaces();
    template <bool FULL>
    void fillEFaces(Index begin, Index end, Index numBoundaryBefore);
    template <bool FULL, typename GET_SIDES>
    void fillEFaces(Index begin, Index end, Index numBoundaryBefore, GET_SIDES getSides);
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
    void fillOpenVertex(Index pVert, Index numOpenBefore);

    // The edge from a corner to the next, seen from the face.
    FaceEdge edgeFrom(Index pFace, Index pCorner) const {
        Index const pEdge = _p.faceEdges[pCorner];
        Index const eFace = _p.GetEdgeChildFace(pEdge);
        if (_p.IsBoundary(pEdge)) {
            return {eFace, &kBoundaryEFaceSide, true};
        }
        bool const isSideA = _p.edgeFaces[2 * std::size_t(pEdge)] == pFace;
        return {eFace, isSideA ? &kEFaceSideA : &kEFaceSideB, false};
    }
    FaceCorner cornerOf(Index pFace, LocalIndex local) const {
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

    // ParallelForRange for functions that write arrays.
    template <typename FUNCTION>
    static void writeRanges(Index count, FUNCTION function) {
        ParallelForRange(count, [=](Index begin, Index end) {
            function(begin, end);
            FinishCopiesPastCaches();
        });
    }

    // Writes count numbers: first, first + step ...
    void writeSequence(Index *array, Index count, Index first, Index step) const {
        WriteSequence<1>(array, count, _pastCaches, step, [=](Index *number) { *number = first; });
    }

    LevelTopology const &_p;
    LevelTopology &_c;
    HexIndexing const _indexing;
    Index const _numVertsOfAnyValence; // closed vertices behind them have three faces
    bool const _pastCaches;

    std::vector<Index> _openFaces; // have a boundary edge
    std::vector<Index> _openVerts; // on a boundary, or non-manifold
    // How far the offsets of V-vertices lie behind those of their parents, when n of the open
    // vertices come before.
    std::vector<VertexOffsets> _vVertexShifts;
};

void Refinement::listOpenFaces() {
    for (Index pEdge : _p.boundaryEdges) {
        _openFaces.push_back(_p.edgeFaces[2 * std::size_t(pEdge)]);
    }
    sortUnique(_openFaces);
}

// Where a fan of faces ends in a boundary edge with an E-face, its V-vertex has the E-face's
// boundary edge besides the spokes, and as many faces as there are E-faces.
void Refinement::listOpenVertices() {
    _openVerts = _p.nonManifoldVerts;
    for (Index pEdge : _p.boundaryEdges) {
        std::size_t const k = 2 * std::size_t(pEdge);
        _openVerts.insert(_openVerts.end(), {_p.edgeVerts[k], _p.edgeVerts[k + 1]});
    }
    sortUnique(_openVerts);
    VertexOffsets shift = {0, 0};
    _vVertexShifts.reserve(_openVerts.size() + 1);
    _vVertexShifts.push_back(shift);
    for (Index pVert : _openVerts) {
        Index const begin = _p.vertFirstFace[pVert];
        Index const end = _p.vertFirstFace[pVert + 1];
        Index numFaces = 0;
        Index numEdges = end - begin;
        for (Index i = begin; i < end; ++i) {
            FaceCorner const corner = cornerOf(_p.vertFaces[i], _p.vertFaceLocals[i]);
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

// Face-vertices, and face-edges for FULL: the F-faces repeat the parent's faces with corners for
// vertices and edges, then come the E-faces.
template <bool FULL>
void Refinement::fillFaces() {
    ParallelFor(_p.numFaces, [this](Index pFace) {
        _c.faceFirstCorner[_indexing.GetFaceChildFace(pFace)] =
            _indexing.GetFaceChildFirstCorner(_p.faceFirstCorner[pFace]);
    });
    writeRanges(_p.numCorners, [=](Index begin, Index end) {
        Index const cCorner = _indexing.GetFaceChildFirstCorner(begin);
        writeSequence(&_c.faceVerts[cCorner], end - begin, _indexing.GetCornerChildVertex(begin),
                      1);
        if constexpr (FULL) {
            writeSequence(&_c.faceEdges[cCorner], end - begin, _indexing.GetCornerChildEdge(begin),
                          1);
        }
    });
    writeRanges(_p.numEdges, [this](Index begin, Index end) {
        forEachRun(
            begin, end, _p.boundaryEdges,
            [this](Index runBegin, Index runEnd, Index numBoundaryBefore) {
                fillEFaces<FULL>(runBegin, runEnd, numBoundaryBefore);
            },
            [this](Index pEdge, Index numBoundaryBefore) {
                fillBoundaryEFace<FULL>(pEdge, numBoundaryBefore);
            });
    });
    _c.faceFirstCorner[_c.numFaces] = _c.numCorners;
}

// The E-faces of a run of interior edges.
template <bool FULL>
void Refinement::fillEFaces(Index begin, Index end, Index numBoundaryBefore) {
    if (!_p.isHexagonal) {
        fillEFaces<FULL>(begin, end, numBoundaryBefore, [this](Index pEdge) {
            std::size_t const k = 2 * std::size_t(pEdge);
            Index const startA = _p.GetSideCorner(pEdge, 0);
            Index const startB = _p.GetSideCorner(pEdge, 1);
            return SideCorners{startA, _p.GetNextCorner(_p.edgeFaces[k], startA), startB,
                               _p.GetNextCorner(_p.edgeFaces[k + 1], startB)};
        });
        return;
    }
    // The edges of F-faces come first: side a is the F-face, from whose corner to the next the edge
    // has its number and its F-vertices; side b is an E-face.  Then come spokes, with E-faces
    // alone. Of all these sides in E-faces only side b of a spoke can be the last edge of its face.
    Index const beginSpokes = std::clamp(_p.parent->numCorners, begin, end);
    Index const *const pVerts = _p.edgeVerts.data();
    Index const *const pFaces = _p.edgeFaces.data();
    LocalIndex const *const pLocals = _p.edgeFaceLocals.data();
    Index const *const pFirstCorner = _p.faceFirstCorner.data();
    Index const firstFVertex = _p.parent->ChildIndexing().GetCornerChildVertex(0);
    fillEFaces<FULL>(begin, beginSpokes, numBoundaryBefore, [=](Index pEdge) {
        std::size_t const k = 2 * std::size_t(pEdge);
        Index const startB = pFirstCorner[pFaces[k + 1]] + pLocals[k + 1];
        return SideCorners{pVerts[k] - firstFVertex, pVerts[k + 1] - firstFVertex, startB,
                           startB + 1};
    });
    fillEFaces<FULL>(beginSpokes, end, numBoundaryBefore, [=](Index pEdge) {
        std::size_t const k = 2 * std::size_t(pEdge);
        Index const startA = pFirstCorner[pFaces[k]] + pLocals[k];
        Index const firstB = pFirstCorner[pFaces[k + 1]];
        Index const startB = firstB + pLocals[k + 1];
        return SideCorners{startA, startA + 1, startB,
                           pLocals[k + 1] == kEFaceSideB.startSpoke ? startB + 1 : firstB};
    });
}

// getSides(pEdge) tells the corners of an edge's sides.
template <bool FULL, typename GET_SIDES>
void Refinement::fillEFaces(Index begin, Index end, Index numBoundaryBefore, GET_SIDES getSides) {
    if (begin == end) {
        return;
    }
    HexIndexing const indexing = _indexing;
    Index const cFace = _p.GetEdgeChildFace(begin);
    Index const numBBefore = indexing.GetEdgeChildFace(begin, 0) - cFace;
    Index const cFirst =
        indexing.GetEdgeChildFirstCorner(begin, numBBefore, numBoundaryBefore - numBBefore);
    constexpr int kSize = HexIndexing::kNumEFaceCorners;
    writeSequence(&_c.faceFirstCorner[cFace], end - begin, cFirst, kSize);

    Index const *const pVerts = _p.edgeVerts.data();
    WriteArray<kSize>(&_c.faceVerts[cFirst], end - begin, _pastCaches, [=](Index *verts, Index i) {
        SideCorners const sides = getSides(begin + i);
        std::size_t const k = 2 * std::size_t(begin + i);
        // From the first place to the last: stores to one cache line in a row cost less.
        verts[kEFaceSideA.startVertex] = indexing.GetVertexChildVertex(pVerts[k]);
        verts[kEFaceSideB.endFVertex] = indexing.GetCornerChildVertex(sides.endB);
        verts[kEFaceSideB.startFVertex] = indexing.GetCornerChildVertex(sides.startB);
        verts[kEFaceSideB.startVertex] = indexing.GetVertexChildVertex(pVerts[k + 1]);
        verts[kEFaceSideA.endFVertex] = indexing.GetCornerChildVertex(sides.endA);
        verts[kEFaceSideA.startFVertex] = indexing.GetCornerChildVertex(sides.startA);
    });
    if constexpr (FULL) {
        Index *const edgesOfRun = &_c.faceEdges[cFirst];
        WriteArray<kSize>(edgesOfRun, end - begin, _pastCaches, [=](Index *edges, Index i) {
            SideCorners const sides = getSides(begin + i);
            edges[kEFaceSideA.fFaceEdge] = indexing.GetCornerChildEdge(sides.startA);
            edges[kEFaceSideA.startSpoke] = indexing.GetCornerChildSpoke(sides.startA);
            edges[kEFaceSideA.endSpoke] = indexing.GetCornerChildSpoke(sides.endA);
            edges[kEFaceSideB.fFaceEdge] = indexing.GetCornerChildEdge(sides.startB);
            edges[kEFaceSideB.startSpoke] = indexing.GetCornerChildSpoke(sides.startB);
            edges[kEFaceSideB.endSpoke] = indexing.GetCornerChildSpoke(sides.endB);
        });
    }
}

// All of the E-face of a boundary edge but its edge that is on the boundary.
template <bool FULL>
void Refinement::fillBoundaryEFace(Index pEdge, Index numBoundaryBefore) {
    Index const cFace = _p.GetEdgeChildFace(pEdge);
    if (cFace == Far::INDEX_INVALID) {
        return;
    }
    EFaceSide const &side = kBoundaryEFaceSide;
    std::size_t const k = 2 * std::size_t(pEdge);
    Index const numBBefore = _indexing.GetEdgeChildFace(pEdge, 0) - cFace;
    Index const cFirst =
        _indexing.GetEdgeChildFirstCorner(pEdge, numBBefore, numBoundaryBefore - numBBefore);
    FaceCorner const corner = cornerOf(_p.edgeFaces[k], _p.edgeFaceLocals[k]);
    _c.faceFirstCorner[cFace] = cFirst;
    Index *const verts = _c.faceVerts.data() + cFirst;
    verts[side.startVertex] = _indexing.GetVertexChildVertex(_p.edgeVerts[k]);
    verts[side.endVertex] = _indexing.GetVertexChildVertex(_p.edgeVerts[k + 1]);
    verts[side.endFVertex] = _indexing.GetCornerChildVertex(corner.next);
    verts[side.startFVertex] = _indexing.GetCornerChildVertex(corner.corner);
    if constexpr (FULL) {
        Index *const edges = _c.faceEdges.data() + cFirst;
        edges[side.endSpoke] = _indexing.GetCornerChildSpoke(corner.next);
        edges[side.fFaceEdge] = _indexing.GetCornerChildEdge(corner.corner);
        edges[side.startSpoke] = _indexing.GetCornerChildSpoke(corner.corner);
    }
}

// What the corners of a face with boundary edges make, as in fillClosedCorners.
//
// An edge whose E-face is missing is a boundary: the edge of the F-face is a B edge then, and the
// spokes at its ends are A edges, each directed as its one face runs; the F-vertices at its ends
// have two faces, others have three.
void Refinement::fillOpenFace(Index pFace) {
    Index const cFace = _indexing.GetFaceChildFace(pFace);
    Index const first = _p.faceFirstCorner[pFace];
    Index const size = _p.faceFirstCorner[pFace + 1] - first;
    VertexOffsets vertex = fVertexOffsets(first, numHalfFacesBefore(pFace));
    for (Index i = 0; i < size; ++i) {
        LocalIndex const local = LocalIndex(i);
        FaceCorner const corner = cornerOf(pFace, local);
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

// A run of faces without boundary edges.
void Refinement::fillClosedFaces(Index begin, Index end) {
    if (_p.isHexagonal) {
        // F-faces come first; then all faces are hexagons.
        Index const endFFaces = std::clamp(_p.parent->numFaces, begin, end);
        fillClosedFaces(begin, endFFaces, SidesOfFFace());
        fillFacesOfSize<HexIndexing::kNumEFaceCorners>(endFFaces, end, SidesOfEFace());
        return;
    }
    Index const first = _p.faceFirstCorner[begin];
    std::vector<LocalIndex> shifts(_p.faceFirstCorner[end] - first);
    LocalIndex *shift = shifts.data();
    Index const *const pEdges = _p.faceEdges.data();
    Index const *const pFaces = _p.edgeFaces.data();
    for (Index pFace = begin; pFace < end; ++pFace) {
        Index const endCorner = _p.faceFirstCorner[pFace + 1];
        for (Index k = _p.faceFirstCorner[pFace]; k < endCorner; ++k) {
            bool const isSideA = pFaces[2 * std::size_t(pEdges[k])] == pFace;
            *shift++ = isSideA ? 0 : kEFaceSideShift;
        }
    }
    fillClosedFaces(begin, end, SidesOfCorners{shifts.data(), first});
}

// Most faces of a mesh are of one size, and lie in long runs; what lies between is taken together.
template <typename SIDES>
void Refinement::fillClosedFaces(Index begin, Index end, SIDES sides) {
    constexpr Index kLongRun = 32;
    auto const sizeOf = [this](Index pFace) {
        return _p.faceFirstCorner[pFace + 1] - _p.faceFirstCorner[pFace];
    };
    auto const endOfRun = [=](Index pFace) {
        Index const size = sizeOf(pFace);
        do {
            ++pFace;
        } while (pFace < end && sizeOf(pFace) == size);
        return pFace;
    };
    Index shortRuns = begin; // from here on
    for (Index run = begin; run < end;) {
        Index const runEnd = endOfRun(run);
        if (runEnd - run >= kLongRun) {
            fillFacesOfAnySize(shortRuns, run, sides);
            fillFacesOfOneSize(run, runEnd, sides);
            shortRuns = runEnd;
        }
        run = runEnd;
    }
    fillFacesOfAnySize(shortRuns, end, sides);
}

template <typename SIDES>
void Refinement::fillFacesOfOneSize(Index begin, Index end, SIDES sides) {
    switch (_p.faceFirstCorner[begin + 1] - _p.faceFirstCorner[begin]) {
    case 3:
        fillFacesOfSize<3>(begin, end, sides);
        break;
    case 4:
        fillFacesOfSize<4>(begin, end, sides);
        break;
    case HexIndexing::kNumEFaceCorners:
        fillFacesOfSize<HexIndexing::kNumEFaceCorners>(begin, end, sides);
        break;
    default:
        fillFacesOfAnySize(begin, end, sides);
    }
}

// The places of the corners in their faces are constants.
template <int SIZE, typename SIDES>
void Refinement::fillFacesOfSize(Index begin, Index end, SIDES sides) {
    if (begin == end) {
        return;
    }
    Index const runFirst = _p.faceFirstCorner[begin];
    auto const fillFace = [=](auto kEntries, auto *entries, Index i, auto fill) {
        Index const first = runFirst + SIZE * i;
        for (int local = 0; local < SIZE; ++local) {
            int const prev = (local + SIZE - 1) % SIZE;
            int const next = (local + 1) % SIZE;
            fill(entries + kEntries * local,
                 ClosedCorner{begin + i, LocalIndex(local), first + prev, first + local,
                              first + next, sides(first + prev, prev),
                              sides(first + local, local)});
        }
    };
    fillClosedCorners(
        begin, end,
        [=](auto kEntries, auto *array, auto fill) {
            WriteArray<kEntries * SIZE>(
                array, end - begin, _pastCaches,
                [=](auto *entries, Index i) { fillFace(kEntries, entries, i, fill); });
        },
        [=](auto kEntries, Index *array, auto fill) {
            WriteSequence<kEntries * SIZE>(
                array, end - begin, _pastCaches, SIZE,
                [=](Index *entries) { fillFace(kEntries, entries, 0, fill); });
        });
}

template <typename SIDES>
void Refinement::fillFacesOfAnySize(Index begin, Index end, SIDES sides) {
    if (begin == end) {
        return;
    }
    std::vector<ClosedCorner> corners;
    corners.reserve(_p.faceFirstCorner[end] - _p.faceFirstCorner[begin]);
    for (Index pFace = begin; pFace < end; ++pFace) {
        Index const first = _p.faceFirstCorner[pFace];
        Index const last = _p.faceFirstCorner[pFace + 1] - 1;
        LocalIndex inShift = sides(last, last - first);
        Index prev = last;
        for (Index k = first; k <= last; ++k) {
            LocalIndex const outShift = sides(k, k - first);
            corners.push_back({pFace, LocalIndex(k - first), prev, k, k == last ? first : k + 1,
                               inShift, outShift});
            prev = k;
            inShift = outShift;
        }
    }
    auto const write = [&](auto kEntries, auto *array, auto fill) {
        WriteArray<kEntries>(array, Index(corners.size()), _pastCaches,
                             [&](auto *entries, Index i) { fill(entries, corners[i]); });
    };
    fillClosedCorners(begin, end, write, write);
}

// What the corners of a run of faces without boundary edges make: an edge of the F-face, a spoke,
// and the relations of an F-vertex.  One array after the other: so each is written from front to
// back, by a loop that compilers make vectors of.
//
// write(kEntries, array, fill) calls fill(entries, corner) for all corners, with their kEntries
// entries of an array; so does writeClosedForm, for entries that are corners but for a constant.
template <typename WRITE, typename WRITE_CLOSED_FORM>
void Refinement::fillClosedCorners(Index begin, Index end, WRITE write,
                                   WRITE_CLOSED_FORM writeClosedForm) {
    constexpr std::integral_constant<int, 2> kTwo;
    constexpr std::integral_constant<int, 3> kThree;
    HexIndexing const indexing = _indexing;
    Index const *const pVerts = _p.faceVerts.data();
    Index const *const pEdges = _p.faceEdges.data();
    EFaceOfEdge const eFaceOf(_p);
    Index const pFirst = _p.faceFirstCorner[begin];

    std::size_t const fEdges = 2 * std::size_t(indexing.GetCornerChildEdge(pFirst));
    writeClosedForm(kTwo, &_c.edgeVerts[fEdges], [=](Index *verts, ClosedCorner const &corner) {
        WritePair(verts, indexing.GetCornerChildVertex(corner.corner),
                  indexing.GetCornerChildVertex(corner.next));
    });
    write(kTwo, &_c.edgeFaces[fEdges], [=](Index *faces, ClosedCorner const &corner) {
        WritePair(faces, indexing.GetFaceChildFace(corner.face), eFaceOf(pEdges[corner.corner]));
    });
    write(kTwo, &_c.edgeFaceLocals[fEdges], [](LocalIndex *locals, ClosedCorner const &corner) {
        locals[0] = corner.local;
        locals[1] = corner.OutPlace(kEFaceSideA.fFaceEdge);
    });

    // Seen from the V-vertex, the E-face of the incoming edge is left of the spoke.
    std::size_t const spokes = 2 * std::size_t(indexing.GetCornerChildSpoke(pFirst));
    write(kTwo, &_c.edgeVerts[spokes], [=](Index *verts, ClosedCorner const &corner) {
        WritePair(verts, indexing.GetVertexChildVertex(pVerts[corner.corner]),
                  indexing.GetCornerChildVertex(corner.corner));
    });
    write(kTwo, &_c.edgeFaces[spokes], [=](Index *faces, ClosedCorner const &corner) {
        WritePair(faces, eFaceOf(pEdges[corner.prev]), eFaceOf(pEdges[corner.corner]));
    });
    write(kTwo, &_c.edgeFaceLocals[spokes], [](LocalIndex *locals, ClosedCorner const &corner) {
        locals[0] = corner.InPlace(kEFaceSideA.endSpoke);
        locals[1] = corner.OutPlace(kEFaceSideA.startSpoke);
    });

    // None of the faces is a half face, so that all F-vertices have three faces and edges.
    VertexOffsets const vertex = fVertexOffsets(pFirst, numHalfFacesBefore(begin));
    Index const numCorners = _p.faceFirstCorner[end] - pFirst;
    Index const fVertex = indexing.GetCornerChildVertex(pFirst);
    writeSequence(&_c.vertFirstFace[fVertex], numCorners, vertex.face, kThree);
    if (!_c.boundaryEdges.empty()) {
        writeSequence(&_c.vertFirstEdge[fVertex], numCorners, vertex.edge, kThree);
        write(kThree, &_c.vertEdgeLocals[vertex.edge],
              [](LocalIndex *locals, ClosedCorner const &) {
                  std::copy(kFVertexEdgeLocals.begin(), kFVertexEdgeLocals.end(), locals);
              });
    }
    write(kThree, &_c.vertFaces[vertex.face], [=](Index *faces, ClosedCorner const &corner) {
        WritePair(faces, indexing.GetFaceChildFace(corner.face), eFaceOf(pEdges[corner.prev]));
        faces[2] = eFaceOf(pEdges[corner.corner]);
    });
    write(kThree, &_c.vertFaceLocals[vertex.face],
          [](LocalIndex *locals, ClosedCorner const &corner) {
              locals[0] = corner.local;
              locals[1] = corner.InPlace(kEFaceSideA.endFVertex);
              locals[2] = corner.OutPlace(kEFaceSideA.startFVertex);
          });
    writeClosedForm(kThree, &_c.vertEdges[vertex.edge],
                    [=](Index *edges, ClosedCorner const &corner) {
                        edges[0] = indexing.GetCornerChildEdge(corner.corner);
                        edges[1] = indexing.GetCornerChildEdge(corner.prev);
                        edges[2] = indexing.GetCornerChildSpoke(corner.corner);
                    });
}

// Around a V-vertex the spokes take the place of the parent's faces and the E-faces that of its
// edges, beginning with the second one.
void Refinement::fillClosedVertices(Index begin, Index end, Index numOpenBefore) {
    HexIndexing const indexing = _indexing;
    Index const cVert = indexing.GetVertexChildVertex(begin);
    VertexOffsets const shift = _vVertexShifts[numOpenBefore];
    Index const *const pFirstFaces = &_p.vertFirstFace[begin];
    WriteArray<1>(&_c.vertFirstFace[cVert], end - begin, _pastCaches,
                  [=](Index *first, Index i) { *first = pFirstFaces[i] + shift.face; });
    VertexOffsets const vertex = vVertexOffsets(begin, numOpenBefore);
    Index const numFaces = _p.vertFirstFace[end] - _p.vertFirstFace[begin];
    if (!_c.boundaryEdges.empty()) {
        Index const *const pFirstEdges = &_p.vertFirstEdge[begin];
        WriteArray<1>(&_c.vertFirstEdge[cVert], end - begin, _pastCaches,
                      [=](Index *first, Index i) { *first = pFirstEdges[i] + shift.edge; });
        WriteArray<1>(_c.vertEdgeLocals.data() + vertex.edge, numFaces, _pastCaches,
                      [](LocalIndex *local, Index) { *local = kVVertexEdgeLocals[0]; });
    }

    Index const *const pFaces = _p.vertFaces.data() + _p.vertFirstFace[begin];
    LocalIndex const *const pFaceLocals = _p.vertFaceLocals.data() + _p.vertFirstFace[begin];
    Index const *const pFirstCorner = _p.faceFirstCorner.data();
    WriteArray<1>(
        _c.vertEdges.data() + vertex.edge, numFaces, _pastCaches, [=](Index *edge, Index i) {
            *edge = indexing.GetCornerChildSpoke(pFirstCorner[pFaces[i]] + pFaceLocals[i]);
        });

    EFaceOfEdge const eFaceOf(_p);
    // Vertices of any valence: written as if all were edges of one vertex, then the last of each
    // vertex, if it has any; values of a face-varying channel need not have.
    Index const endAnyValence = std::clamp(_numVertsOfAnyValence, begin, end);
    Index const *const pFirstEdges = &_p.vertFirstEdge[begin];
    Index const *const pEdges = _p.vertEdges.data() + pFirstEdges[0];
    Index const numOfAnyValence = pFirstEdges[endAnyValence - begin] - pFirstEdges[0];
    auto const writeRotated = [=](auto *ofEdges, auto ofEdge) {
        for (Index i = 1; i < numOfAnyValence; ++i) {
            ofEdges[i - 1] = ofEdge(i);
        }
        for (Index i = 0; i < endAnyValence - begin; ++i) {
            if (pFirstEdges[i] < pFirstEdges[i + 1]) {
                ofEdges[pFirstEdges[i + 1] - 1 - pFirstEdges[0]] =
                    ofEdge(pFirstEdges[i] - pFirstEdges[0]);
            }
        }
    };
    Index *const faces = _c.vertFaces.data() + vertex.face;
    LocalIndex *const locals = _c.vertFaceLocals.data() + vertex.face;
    writeRotated(faces, [=](Index i) { return eFaceOf(pEdges[i]); });
    if (_p.isHexagonal) {
        std::fill_n(locals, numOfAnyValence, kEFaceSideA.startVertex);
    } else {
        LocalIndex const *const pLocals = _p.vertEdgeLocals.data() + pFirstEdges[0];
        writeRotated(locals, [=](Index i) {
            return pLocals[i] == 0 ? kEFaceSideA.startVertex : kEFaceSideA.endVertex;
        });
    }
    // V-vertices of the parent are the first vertex of three edges, F-vertices the first, second
    // and second.
    constexpr int kValence = 3;
    Index const *const pEdgesOfThree = pEdges + numOfAnyValence;
    WriteArray<kValence>(faces + numOfAnyValence, end - endAnyValence, _pastCaches,
                         [=](Index *ofVertex, Index i) {
                             Index const *const edges = pEdgesOfThree + kValence * std::size_t(i);
                             WritePair(ofVertex, eFaceOf(edges[1]), eFaceOf(edges[2]));
                             ofVertex[2] = eFaceOf(edges[0]);
                         });
    Index const endVVertices =
        _p.isHexagonal ? std::clamp(_p.parent->numVertices, endAnyValence, end) : end;
    Index const numVVertices = endVVertices - endAnyValence;
    LocalIndex *const localsOfThree = locals + numOfAnyValence;
    WriteArray<kValence>(localsOfThree, numVVertices, _pastCaches, [](LocalIndex *ofVertex, Index) {
        ofVertex[0] = ofVertex[1] = ofVertex[2] = kEFaceSideA.startVertex;
    });
    WriteArray<kValence>(localsOfThree + kValence * std::size_t(numVVertices), end - endVVertices,
                         _pastCaches, [](LocalIndex *ofVertex, Index) {
                             ofVertex[0] = ofVertex[1] = kEFaceSideA.endVertex;
                             ofVertex[2] = kEFaceSideA.startVertex;
                         });
}

// Where a fan of faces ends in a boundary edge with an E-face, that one's boundary edge comes first
// or last.
void Refinement::fillOpenVertex(Index pVert, Index numOpenBefore) {
    VertexOffsets vertex = vVertexOffsets(pVert, numOpenBefore);
    Index const cVert = _indexing.GetVertexChildVertex(pVert);
    _c.vertFirstFace[cVert] = vertex.face;
    _c.vertFirstEdge[cVert] = vertex.edge;
    auto const boundaryEdgeOf = [this](Index eFace) {
        return _c.faceEdges[_c.faceFirstCorner[eFace] + kBoundaryEFaceEdge];
    };
    for (Index i = _p.vertFirstFace[pVert]; i < _p.vertFirstFace[pVert + 1]; ++i) {
        FaceCorner const corner = cornerOf(_p.vertFaces[i], _p.vertFaceLocals[i]);
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
void Refinement::fillBoundaries() {
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
        std::size_t const k = 2 * std::size_t(pEdge);
        Index const eFace = _p.GetEdgeChildFace(pEdge);
        Index const cEdge = _indexing.GetBoundaryChildEdge(rank);
        bool const isFree = _p.edgeFaces[k + 1] == kFreeBoundary;
        boundaryChildren[rank++] = cEdge;
        if (!isFree) {
            *halfEFaces++ = eFace;
        }
        _c.faceEdges[_c.faceFirstCorner[eFace] + kBoundaryEFaceEdge] = cEdge;
        setBoundaryEdge(cEdge, _indexing.GetVertexChildVertex(_p.edgeVerts[k]),
                        _indexing.GetVertexChildVertex(_p.edgeVerts[k + 1]), eFace,
                        isFree ? kFreeBoundary : kSharpBoundaryB, kBoundaryEFaceEdge);
    }
}

// Gives all arrays of the child and the relations of the parent to it a place.
void placeArrays(LevelTopology &parent, LevelTopology &child) {
    std::size_t const numSharpBoundaries =
        std::size_t(child.numSharpBoundariesA) + child.numSharpBoundariesB;
    std::size_t const numBoundaries = child.numFreeBoundaries + numSharpBoundaries;
    PlaceArrays(child.memory, [&](auto place) {
        place(parent.faceChildFaces, parent.numFaces);
        place(parent.edgeChildFaces, parent.halfFaces.empty() ? 0 : parent.numEdges);
        place(child.faceFirstCorner, std::size_t(child.numFaces) + 1);
        place(child.faceVerts, child.numCorners);
        // Arrays that are not wanted get no place.
        auto const placeRelation = [&](auto &array, std::size_t size) {
            place(array, child.hasFullTopology ? size : 0);
        };
        placeRelation(child.faceEdges, child.numCorners);
        placeRelation(child.edgeVerts, 2 * std::size_t(child.numEdges));
        placeRelation(child.edgeFaces, 2 * std::size_t(child.numEdges));
        placeRelation(child.edgeFaceLocals, 2 * std::size_t(child.numEdges));
        placeRelation(child.boundaryEdges, numBoundaries);
        placeRelation(child.halfFaces, child.numSharpBoundariesB);
        placeRelation(child.vertFirstFace, std::size_t(child.numVertices) + 1);
        placeRelation(child.vertFaces, child.numCorners);
        placeRelation(child.vertFaceLocals, child.numCorners);
        placeRelation(child.vertEdges, 2 * std::size_t(child.numEdges));
        // Without boundaries a vertex has as many edges as faces, and known places in them.
        bool const hasBoundaries = numBoundaries > 0;
        placeRelation(child.vertFirstEdge, hasBoundaries * (std::size_t(child.numVertices) + 1));
        placeRelation(child.vertEdgeLocals, hasBoundaries * (2 * std::size_t(child.numEdges)));
    });
    if (numBoundaries == 0) {
        child.vertFirstEdge.Place(child.vertFirstFace.data(), child.vertFirstFace.size());
    }
}

// The relations that only a refined level has: to its children.
void fillChildRelations(LevelTopology &parent) {
    parent.numVVertices = parent.numVertices;
    parent.vertChildVerts.Resize(0);
    parent.vVertexParents.Resize(0);
    HexIndexing const indexing = parent.ChildIndexing();
    ParallelFor(parent.numFaces, [&](Index pFace) {
        parent.faceChildFaces[pFace] = indexing.GetFaceChildFace(pFace);
    });
    if (parent.edgeChildFaces.empty()) {
        return;
    }
    // By the number of boundary edges before.
    std::vector<Index> numBBefore = {0};
    numBBefore.reserve(parent.boundaryEdges.size() + 1);
    for (Index pEdge : parent.boundaryEdges) {
        numBBefore.push_back(numBBefore.back() + Index(parent.IsSharpBoundaryB(pEdge)));
    }
    ParallelForRange(parent.numEdges, [&](Index begin, Index end) {
        auto const fillRun = [&](Index runBegin, Index runEnd, Index numBoundaryBefore) {
            for (Index pEdge = runBegin; pEdge < runEnd; ++pEdge) {
                parent.edgeChildFaces[pEdge] =
                    indexing.GetEdgeChildFace(pEdge, numBBefore[numBoundaryBefore]);
            }
        };
        forEachRun(begin, end, parent.boundaryEdges, fillRun,
                   [&](Index pEdge, Index numBoundaryBefore) {
                       if (parent.IsSharpBoundaryB(pEdge)) {
                           parent.edgeChildFaces[pEdge] = Far::INDEX_INVALID;
                       } else {
                           fillRun(pEdge, pEdge + 1, numBoundaryBefore);
                       }
                   });
    });
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
    RefineTags(parent, sdcOptions, child);
    if (child.hasFullTopology) {
        ComputeSharpMasks(sdcOptions, child);
    } else {
        child.sharpVerts.clear();
        child.sectorCorners.clear();
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
    placeArrays(parent, child);
    fillChildRelations(parent);
    Refinement refinement(parent, child);
    if (fullTopology) {
        refinement.FillAll();
    } else {
        refinement.FillFaces();
    }
    EndLevel(sdcOptions, parent, child);
}

} // namespace OpenSubdivHex::FarExt::internal
