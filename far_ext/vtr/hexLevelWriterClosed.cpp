// SPDX-License-Identifier: Apache-2.0
#include "hexLevelWriter.h"

#include <array>
#include <cstring>
#include <type_traits>

namespace OpenSubdivHex::FarExt::internal {

namespace {

using Index = Far::Index;
using LocalIndex = Far::LocalIndex;

// Writes two entries by one store, which compilers do not always make of two.
void writePair(Index *entries, Index first, Index second) {
    Index const pair[2] = {first, second};
    std::memcpy(entries, pair, sizeof(pair));
}

// Writes count groups of SIZE entries to array, from front to back: calls
// fill(entries, i) for i = 0 ... count - 1, which writes group i to entries.
//
// The array overlaps nothing that fill reads.
template <int SIZE, typename T, typename FUNCTION>
void writeArray(T *__restrict array, Index count, FUNCTION fill) {
    for (Index i = 0; i < count; ++i, array += SIZE) {
        fill(array, i);
    }
}

// Writes the same for indices that follow from those of group 0, which fill(entries)
// writes: from group to group all grow by increment.
template <int SIZE, typename FUNCTION>
void writeSequence(Index *array, Index count, Index increment, FUNCTION fill) {
    std::array<Index, SIZE> first;
    fill(first.data());
    writeArray<SIZE>(array, count, [=](Index *entries, Index i) {
        for (int k = 0; k < SIZE; ++k) {
            entries[k] = first[k] + increment * i;
        }
    });
}

// Writes count numbers: first, first + increment ...
void writeSequence(Index *array, Index count, Index first, Index increment) {
    writeSequence<1>(array, count, increment, [=](Index *number) { *number = first; });
}

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

// Refinement::GetEdgeChildFace for loops.
class EFaceOfEdge {
public:
    explicit EFaceOfEdge(Refinement const &refinement)
        : _eFaces(refinement.edgeChildFaces.empty() ? nullptr : refinement.edgeChildFaces.data()),
          _indexing(refinement.parent->ChildIndexing()) {}

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

} // namespace

HexLevelWriter::HexLevelWriter(Refinement const &refinement, Level &child)
    : _refinement(refinement), _p(*refinement.parent), _c(child), _indexing(_p.ChildIndexing()) {}

void HexLevelWriter::Write() {
    if (!_c.hasFullTopology) {
        fillFaces<false>();
        return;
    }
    listOpenFaces();
    listOpenVertices();
    fillFaces<true>();
    fillBoundaries();
    ParallelForRange(_p.numFaces, [this](Index begin, Index end) {
        ForEachRun(
            begin, end, _openFaces,
            [this](Index runBegin, Index runEnd, Index) { fillClosedFaces(runBegin, runEnd); },
            [this](Index pFace, Index) { fillOpenFace(pFace); });
    });
    ParallelForRange(_p.numVertices, [this](Index begin, Index end) {
        ForEachRun(
            begin, end, _openVerts,
            [this](Index runBegin, Index runEnd, Index numOpenBefore) {
                fillClosedVertices(runBegin, runEnd, numOpenBefore);
            },
            [this](Index pVert, Index numOpenBefore) { fillOpenVertex(pVert, numOpenBefore); });
    });
    _c.vertFirstFace[_c.numVertices] = _c.numCorners;
    _c.vertFirstEdge[_c.numVertices] = 2 * _c.numEdges;
}

// Face-vertices, and face-edges for FULL: the F-faces repeat the parent's faces with corners for
// vertices and edges, then come the E-faces.
template <bool FULL>
void HexLevelWriter::fillFaces() {
    ParallelFor(_p.numFaces, [this](Index pFace) {
        _c.faceFirstCorner[_indexing.GetFaceChildFace(pFace)] =
            _indexing.GetFaceChildFirstCorner(_p.faceFirstCorner[pFace]);
    });
    ParallelForRange(_p.numCorners, [=](Index begin, Index end) {
        Index const cCorner = _indexing.GetFaceChildFirstCorner(begin);
        writeSequence(&_c.faceVerts[cCorner], end - begin, _indexing.GetCornerChildVertex(begin),
                      1);
        if constexpr (FULL) {
            writeSequence(&_c.faceEdges[cCorner], end - begin, _indexing.GetCornerChildEdge(begin),
                          1);
        }
    });
    ParallelForRange(_p.numEdges, [this](Index begin, Index end) {
        ForEachRun(
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
void HexLevelWriter::fillEFaces(Index begin, Index end, Index numBoundaryBefore) {
    HexIndexing const indexing = _indexing;
    Index const cFace = _refinement.GetEdgeChildFace(begin);
    Index const numBBefore = indexing.GetEdgeChildFace(begin, 0) - cFace;
    Index const cFirst =
        indexing.GetEdgeChildFirstCorner(begin, numBBefore, numBoundaryBefore - numBBefore);
    constexpr int kSize = HexIndexing::kNumEFaceCorners;
    writeSequence(&_c.faceFirstCorner[cFace], end - begin, cFirst, kSize);

    Level const &parent = _p;
    auto const getSides = [&parent](Index pEdge) {
        Index const startA = parent.GetSideCorner(pEdge, 0);
        Index const startB = parent.GetSideCorner(pEdge, 1);
        return SideCorners{startA, parent.GetNextCorner(parent.edgeFaces[pEdge][0], startA), startB,
                           parent.GetNextCorner(parent.edgeFaces[pEdge][1], startB)};
    };
    IndexPair const *const pVerts = _p.edgeVerts.data();
    writeArray<kSize>(&_c.faceVerts[cFirst], end - begin, [=](Index *verts, Index i) {
        SideCorners const sides = getSides(begin + i);
        IndexPair const &ends = pVerts[begin + i];
        // From the first place to the last: stores to one cache line in a row cost less.
        verts[kEFaceSideA.startVertex] = indexing.GetVertexChildVertex(ends[0]);
        verts[kEFaceSideB.endFVertex] = indexing.GetCornerChildVertex(sides.endB);
        verts[kEFaceSideB.startFVertex] = indexing.GetCornerChildVertex(sides.startB);
        verts[kEFaceSideB.startVertex] = indexing.GetVertexChildVertex(ends[1]);
        verts[kEFaceSideA.endFVertex] = indexing.GetCornerChildVertex(sides.endA);
        verts[kEFaceSideA.startFVertex] = indexing.GetCornerChildVertex(sides.startA);
    });
    if constexpr (FULL) {
        Index *const edgesOfRun = &_c.faceEdges[cFirst];
        writeArray<kSize>(edgesOfRun, end - begin, [=](Index *edges, Index i) {
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

// A run of faces without boundary edges.
void HexLevelWriter::fillClosedFaces(Index begin, Index end) {
    if (_p.isHexagonal) {
        // F-faces come first; then all faces are hexagons.
        Index const endFFaces = std::clamp(_p.numFFaces, begin, end);
        fillClosedFaces(begin, endFFaces, SidesOfFFace());
        fillFacesOfSize<HexIndexing::kNumEFaceCorners>(endFFaces, end, SidesOfEFace());
        return;
    }
    Index const first = _p.faceFirstCorner[begin];
    std::vector<LocalIndex> shifts(_p.faceFirstCorner[end] - first);
    LocalIndex *shift = shifts.data();
    Index const *const pEdges = _p.faceEdges.data();
    IndexPair const *const pFaces = _p.edgeFaces.data();
    for (Index pFace = begin; pFace < end; ++pFace) {
        Index const endCorner = _p.faceFirstCorner[pFace + 1];
        for (Index k = _p.faceFirstCorner[pFace]; k < endCorner; ++k) {
            bool const isSideA = pFaces[pEdges[k]][0] == pFace;
            *shift++ = isSideA ? 0 : kEFaceSideShift;
        }
    }
    fillClosedFaces(begin, end, SidesOfCorners{shifts.data(), first});
}

// Most faces of a mesh are of one size, and lie in long runs; what lies between is taken together.
template <typename SIDES>
void HexLevelWriter::fillClosedFaces(Index begin, Index end, SIDES sides) {
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
void HexLevelWriter::fillFacesOfOneSize(Index begin, Index end, SIDES sides) {
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
void HexLevelWriter::fillFacesOfSize(Index begin, Index end, SIDES sides) {
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
            writeArray<kEntries * SIZE>(array, end - begin, [=](auto *entries, Index i) {
                fillFace(kEntries, entries, i, fill);
            });
        },
        [=](auto kEntries, Index *array, auto fill) {
            writeSequence<kEntries * SIZE>(array, end - begin, SIZE, [=](Index *entries) {
                fillFace(kEntries, entries, 0, fill);
            });
        });
}

template <typename SIDES>
void HexLevelWriter::fillFacesOfAnySize(Index begin, Index end, SIDES sides) {
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
        writeArray<kEntries>(array, Index(corners.size()),
                             [&](auto *entries, Index i) { fill(entries, corners[i]); });
    };
    fillClosedCorners(begin, end, write, write);
}

// Writes the components that corners of a run of faces without boundary edges make: an edge of the F-face, a
// spoke, and the relations of an F-vertex.  One array after the other: so each is written from front to
// back, by a loop that compilers vectorize.
//
// write(kEntries, array, fill) calls fill(entries, corner) for all corners, with their kEntries
// entries of an array; so does writeClosedForm, for entries that are corners but for a constant.
template <typename WRITE, typename WRITE_CLOSED_FORM>
void HexLevelWriter::fillClosedCorners(Index begin, Index end, WRITE write,
                                       WRITE_CLOSED_FORM writeClosedForm) {
    constexpr std::integral_constant<int, 2> kTwo;
    constexpr std::integral_constant<int, 3> kThree;
    HexIndexing const indexing = _indexing;
    Index const *const pVerts = _p.faceVerts.data();
    Index const *const pEdges = _p.faceEdges.data();
    EFaceOfEdge const eFaceOf(_refinement);
    Index const pFirst = _p.faceFirstCorner[begin];

    Index const fEdges = indexing.GetCornerChildEdge(pFirst);
    writeClosedForm(kTwo, _c.edgeVerts[fEdges].data(),
                    [=](Index *verts, ClosedCorner const &corner) {
                        writePair(verts, indexing.GetCornerChildVertex(corner.corner),
                                  indexing.GetCornerChildVertex(corner.next));
                    });
    write(kTwo, _c.edgeFaces[fEdges].data(), [=](Index *faces, ClosedCorner const &corner) {
        writePair(faces, indexing.GetFaceChildFace(corner.face), eFaceOf(pEdges[corner.corner]));
    });
    write(kTwo, _c.edgeFaceLocals[fEdges].data(),
          [](LocalIndex *locals, ClosedCorner const &corner) {
              locals[0] = corner.local;
              locals[1] = corner.OutPlace(kEFaceSideA.fFaceEdge);
          });

    // Seen from the V-vertex, the E-face of the incoming edge is left of the spoke.
    Index const spokes = indexing.GetCornerChildSpoke(pFirst);
    write(kTwo, _c.edgeVerts[spokes].data(), [=](Index *verts, ClosedCorner const &corner) {
        writePair(verts, indexing.GetVertexChildVertex(pVerts[corner.corner]),
                  indexing.GetCornerChildVertex(corner.corner));
    });
    write(kTwo, _c.edgeFaces[spokes].data(), [=](Index *faces, ClosedCorner const &corner) {
        writePair(faces, eFaceOf(pEdges[corner.prev]), eFaceOf(pEdges[corner.corner]));
    });
    write(kTwo, _c.edgeFaceLocals[spokes].data(),
          [](LocalIndex *locals, ClosedCorner const &corner) {
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
        writePair(faces, indexing.GetFaceChildFace(corner.face), eFaceOf(pEdges[corner.prev]));
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
void HexLevelWriter::fillClosedVertices(Index begin, Index end, Index numOpenBefore) {
    Index const cVert = _indexing.GetVertexChildVertex(begin);
    VertexOffsets const shift = _vVertexShifts[numOpenBefore];
    Index const *const pFirstFaces = &_p.vertFirstFace[begin];
    writeArray<1>(&_c.vertFirstFace[cVert], end - begin,
                  [=](Index *first, Index i) { *first = pFirstFaces[i] + shift.face; });
    if (!_c.boundaryEdges.empty()) {
        Index const *const pFirstEdges = &_p.vertFirstEdge[begin];
        writeArray<1>(&_c.vertFirstEdge[cVert], end - begin,
                      [=](Index *first, Index i) { *first = pFirstEdges[i] + shift.edge; });
    }
    VertexOffsets const vertex = vVertexOffsets(begin, numOpenBefore);
    fillClosedVertexEdges(begin, end, vertex);
    // Vertices of any valence come first.
    Index const endAnyValence = std::clamp(_p.numVertsOfAnyValence, begin, end);
    fillFacesOfAnyValence(begin, endAnyValence, vertex.face);
    Index const numOfAnyValence = _p.vertFirstEdge[endAnyValence] - _p.vertFirstEdge[begin];
    fillFacesOfValenceThree(endAnyValence, end, vertex.face + numOfAnyValence);
}

// The spokes around V-vertices.
void HexLevelWriter::fillClosedVertexEdges(Index begin, Index end, VertexOffsets vertex) {
    HexIndexing const indexing = _indexing;
    Index const numFaces = _p.vertFirstFace[end] - _p.vertFirstFace[begin];
    if (!_c.boundaryEdges.empty()) {
        writeArray<1>(_c.vertEdgeLocals.data() + vertex.edge, numFaces,
                      [](LocalIndex *local, Index) { *local = kVVertexEdgeLocals[0]; });
    }
    Index const *const pFaces = _p.vertFaces.data() + _p.vertFirstFace[begin];
    LocalIndex const *const pFaceLocals = _p.vertFaceLocals.data() + _p.vertFirstFace[begin];
    Index const *const pFirstCorner = _p.faceFirstCorner.data();
    writeArray<1>(_c.vertEdges.data() + vertex.edge, numFaces, [=](Index *edge, Index i) {
        *edge = indexing.GetCornerChildSpoke(pFirstCorner[pFaces[i]] + pFaceLocals[i]);
    });
}

// The E-faces around V-vertices of any valence, from firstPlace on in vertFaces: written as if all were edges
// of one vertex, then the last of each vertex, if it has any; values of a face-varying channel need
// not have.
void HexLevelWriter::fillFacesOfAnyValence(Index begin, Index end, Index firstPlace) {
    Index const *const pFirstEdges = &_p.vertFirstEdge[begin];
    Index const numVertices = end - begin;
    Index const numEdges = pFirstEdges[numVertices] - pFirstEdges[0];
    auto const writeRotated = [=](auto *ofEdges, auto ofEdge) {
        for (Index i = 1; i < numEdges; ++i) {
            ofEdges[i - 1] = ofEdge(i);
        }
        for (Index i = 0; i < numVertices; ++i) {
            if (pFirstEdges[i] < pFirstEdges[i + 1]) {
                ofEdges[pFirstEdges[i + 1] - 1 - pFirstEdges[0]] =
                    ofEdge(pFirstEdges[i] - pFirstEdges[0]);
            }
        }
    };
    EFaceOfEdge const eFaceOf(_refinement);
    Index const *const pEdges = _p.vertEdges.data() + pFirstEdges[0];
    writeRotated(_c.vertFaces.data() + firstPlace, [=](Index i) { return eFaceOf(pEdges[i]); });
    LocalIndex *const locals = _c.vertFaceLocals.data() + firstPlace;
    if (_p.isHexagonal) {
        std::fill_n(locals, numEdges, kEFaceSideA.startVertex);
        return;
    }
    LocalIndex const *const pLocals = _p.vertEdgeLocals.data() + pFirstEdges[0];
    writeRotated(locals, [=](Index i) {
        return pLocals[i] == 0 ? kEFaceSideA.startVertex : kEFaceSideA.endVertex;
    });
}

// The E-faces around V-vertices of valence three, from firstPlace on in vertFaces.  V-vertices of the parent
// are the first vertex of three edges, F-vertices the first, second and second.
void HexLevelWriter::fillFacesOfValenceThree(Index begin, Index end, Index firstPlace) {
    constexpr int kValence = 3;
    EFaceOfEdge const eFaceOf(_refinement);
    Index const *const pEdges = _p.vertEdges.data() + _p.vertFirstEdge[begin];
    writeArray<kValence>(_c.vertFaces.data() + firstPlace, end - begin,
                         [=](Index *ofVertex, Index i) {
                             Index const *const edges = pEdges + kValence * std::size_t(i);
                             writePair(ofVertex, eFaceOf(edges[1]), eFaceOf(edges[2]));
                             ofVertex[2] = eFaceOf(edges[0]);
                         });
    Index const endVVertices = _p.isHexagonal ? std::clamp(_p.numVVertices, begin, end) : end;
    Index const numVVertices = endVVertices - begin;
    LocalIndex *const locals = _c.vertFaceLocals.data() + firstPlace;
    writeArray<kValence>(locals, numVVertices, [](LocalIndex *ofVertex, Index) {
        ofVertex[0] = ofVertex[1] = ofVertex[2] = kEFaceSideA.startVertex;
    });
    writeArray<kValence>(locals + kValence * std::size_t(numVVertices), end - endVVertices,
                         [](LocalIndex *ofVertex, Index) {
                             ofVertex[0] = ofVertex[1] = kEFaceSideA.endVertex;
                             ofVertex[2] = kEFaceSideA.startVertex;
                         });
}

} // namespace OpenSubdivHex::FarExt::internal
