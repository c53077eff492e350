// SPDX-License-Identifier: Apache-2.0
#include "baseLevel.h"

#include "indexSet.h"
#include "parallel.h"

#include <algorithm>

namespace OpenSubdivHex::FarExt::internal {

namespace {

using Index = Far::Index;
using LocalIndex = Far::LocalIndex;
using EdgeSidesArray = OpenSubdiv::Vtr::ConstArray<EdgeSides>;

// Derives the relations of edges, and mates, from their sides.
void buildEdges(EdgeSidesArray edges, Corners &corners, Level &level) {
    ResizeEdges(std::size_t(edges.size()), level);
    WithPlaces(level, corners, [&](auto const &places) {
        EdgeWriter const writer(places, level);
        Index *const mates = corners.mates.data();
        ParallelFor(edges.size(), [=](Index edge) {
            Index const corner = edges[edge].corners[0];
            Index const other = edges[edge].corners[1];
            writer.Write(edge, corner, other);
            if (other < 0) {
                mates[corner] = kNoMate;
            } else {
                mates[corner] = places.GetNext(places.GetFace(other), other);
                mates[other] = places.GetNext(places.GetFace(corner), corner);
            }
        });
    });
    level.boundaryEdges.Assign(
        ParallelSelect(level.numEdges, [&](Index edge) { return edges[edge].corners[1] < 0; }));
}

// Derives the relations of vertices from the faces around them.
template <typename PLACES>
class VertexBuilder {
public:
    VertexBuilder(PLACES places, Corners const &corners, Level &level)
        : _places(places), _level(level), _ofVerts(corners.ofVerts.data()),
          _mates(corners.mates.data()), _faceEdges(level.faceEdges.data()),
          _edgeVerts(level.edgeVerts.data()), _vertFirstFace(level.vertFirstFace.data()),
          _vertFirstEdge(level.vertFirstEdge.data()), _vertFaces(level.vertFaces.data()),
          _vertFaceLocals(level.vertFaceLocals.data()), _vertEdges(level.vertEdges.data()),
          _vertEdgeLocals(level.vertEdgeLocals.data()) {}

    // The vertices with several fans.
    std::vector<Index> Build() {
        std::vector<Index> fanned = ParallelSelect(
            _level.numVertices, [this](Index vert) { return !fillFan(vert); }, kShortParallelRange);
        for (Index vert : fanned) {
            fillFans(vert);
        }
        return fanned;
    }
    // Overload for faces that are in order, except at some vertices.
    std::vector<Index> BuildOrdered(std::vector<Index> const &oddVerts) {
        ParallelForRange(_level.numVertices, [this](Index begin, Index end) {
            VertexBuilder const builder = *this;
            builder.addEdges(begin, end);
            builder.findFaces(_vertFirstFace[begin], _vertFirstFace[end]);
        });
        std::vector<Index> fanned;
        for (Index vert : oddVerts) {
            if (!fillFan(vert)) {
                fillFans(vert);
                fanned.push_back(vert);
            }
        }
        return fanned;
    }

private:
    /// Where the next face and the next edge of a vertex go.
    struct Position {
        Index face;
        Index edge;
    };

    void addEdges(Index begin, Index end) const;
    void findFaces(Index begin, Index end) const;
    bool fillFan(Index vert) const;
    void fillFans(Index vert) const;
    Index findStart(Index corner) const;
    Index addFaces(Index vert, Index start, Position &position) const;

    Position getPosition(Index vert) const { return {_vertFirstFace[vert], _vertFirstEdge[vert]}; }

    PLACES const _places;
    Level const &_level;
    // The arrays at hand, since they are found again and again.
    Index const *const _ofVerts;
    Index const *const _mates;
    Index const *const _faceEdges;
    IndexPair const *const _edgeVerts;
    Index const *const _vertFirstFace;
    Index const *const _vertFirstEdge;
    Index *const _vertFaces;
    LocalIndex *const _vertFaceLocals;
    Index *const _vertEdges;
    LocalIndex *const _vertEdgeLocals;
};

// Adds the faces of a fan, counter-clockwise from a corner on, and their edges.
// Returns the corner that it comes back to, or a mark at the end of an open fan, whose last edge is
// added, too.
template <typename PLACES>
Index VertexBuilder<PLACES>::addFaces(Index vert, Index start, Position &position) const {
    Position next = position; // which nothing that is written can be
    Index corner = start;
    for (;;) {
        Index const face = _places.GetFace(corner);
        Index const edge = _faceEdges[corner];
        _vertFaces[next.face] = face;
        _vertFaceLocals[next.face++] = _places.GetLocal(face, corner);
        _vertEdges[next.edge] = edge;
        _vertEdgeLocals[next.edge++] = LocalIndex(_edgeVerts[edge][0] != vert);
        Index const prev = _places.GetPrev(face, corner);
        Index const mate = _mates[prev];
        if (!IsCorner(mate)) {
            corner = mate;
            _vertEdges[next.edge] = _faceEdges[prev];
            _vertEdgeLocals[next.edge++] = 1;
            break;
        }
        corner = _places.GetPrev(_places.GetFace(mate), mate);
        if (corner == start) {
            break;
        }
    }
    position = next;
    return corner;
}

// The first corner of an open fan that has a corner; of a closed one the same corner.
template <typename PLACES>
Index VertexBuilder<PLACES>::findStart(Index corner) const {
    Index start = corner;
    for (;;) {
        Index const mate = _mates[start];
        if (!IsCorner(mate)) {
            return start;
        }
        start = mate;
        if (start == corner) {
            return start;
        }
    }
}

// Adds the edges of vertices that have one fan each, in order, whose corners are in vertFaces.
template <typename PLACES>
void VertexBuilder<PLACES>::addEdges(Index begin, Index end) const {
    Index const *const corners = _vertFaces;
    Index place = _vertFirstFace[begin];
    for (Index vert = begin; vert < end; ++vert) {
        // Up to a vertex with an edge more than faces, all edges are at the place of a face.
        Index const shift = _vertFirstEdge[vert] - _vertFirstFace[vert];
        while (vert + 1 < end && _vertFirstEdge[vert + 1] - _vertFirstFace[vert + 1] == shift) {
            ++vert;
        }
        for (Index const last = _vertFirstFace[vert + 1]; place < last; ++place) {
            Index const corner = corners[place];
            _vertEdges[place + shift] = _faceEdges[corner];
            _vertEdgeLocals[place + shift] = LocalIndex(_mates[corner] < corner);
        }
        if (Index const next = place + shift; next < _vertFirstEdge[vert + 1]) {
            Index const corner = corners[place - 1];
            _vertEdges[next] = _faceEdges[_places.GetPrev(_places.GetFace(corner), corner)];
            _vertEdgeLocals[next] = 1;
        }
    }
}

// Makes faces of corners in vertFaces.
template <typename PLACES>
void VertexBuilder<PLACES>::findFaces(Index begin, Index end) const {
    PLACES const places = _places;
    Index *const faces = _vertFaces;
    LocalIndex *const locals = _vertFaceLocals;
    for (Index place = begin; place < end; ++place) {
        Index const corner = faces[place];
        Index const face = places.GetFace(corner);
        faces[place] = face;
        locals[place] = places.GetLocal(face, corner);
    }
}

// Whether all faces of a vertex are one fan.
template <typename PLACES>
bool VertexBuilder<PLACES>::fillFan(Index vert) const {
    Index const begin = _vertFirstFace[vert];
    Index const end = _vertFirstFace[vert + 1];
    if (begin == end) {
        return true;
    }
    Index start = _ofVerts[begin];
    bool const isOpen = _vertFirstEdge[vert + 1] - _vertFirstEdge[vert] > end - begin;
    if (isOpen) {
        start = findStart(start);
    }
    Position position = getPosition(vert);
    addFaces(vert, start, position);
    return position.face == end;
}

// The fans of a vertex, by their lowest corners.
template <typename PLACES>
void VertexBuilder<PLACES>::fillFans(Index vert) const {
    Index const *const corners = _ofVerts + _level.vertFirstFace[vert];
    int const numCorners = _level.GetNumVertexFaces(vert);
    std::vector<bool> isPlaced(std::size_t(numCorners), false);
    Position position = getPosition(vert);
    for (int i = 0; i < numCorners; ++i) {
        if (isPlaced[std::size_t(i)]) {
            continue;
        }
        Index next = position.face;
        addFaces(vert, findStart(corners[i]), position);
        for (; next < position.face; ++next) {
            Index const corner = _level.GetVertexCorner(next);
            isPlaced[std::size_t(std::lower_bound(corners, corners + numCorners, corner) -
                                 corners)] = true;
        }
    }
}

// A vertex has an edge more than faces for each fan that begins with a boundary edge.
void findFirstEdges(Level &level) {
    std::vector<Index> starts; // of boundary edges
    starts.reserve(level.boundaryEdges.size());
    for (Index edge : level.boundaryEdges) {
        starts.push_back(level.edgeVerts[edge][0]);
    }
    std::sort(starts.begin(), starts.end());
    ParallelForRange(level.numVertices, [&](Index begin, Index end) {
        auto start = std::lower_bound(starts.begin(), starts.end(), begin);
        for (Index vert = begin; vert < end; ++vert) {
            while (start != starts.end() && *start < vert) {
                ++start;
            }
            level.vertFirstEdge[vert] = level.vertFirstFace[vert] + Index(start - starts.begin());
        }
    });
    level.vertFirstEdge[level.numVertices] =
        level.vertFirstFace[level.numVertices] + Index(starts.size());
}

void countBoundaries(Level &level) {
    level.numFreeBoundaries = level.numSharpBoundariesA = level.numSharpBoundariesB = 0;
    for (Index edge : level.boundaryEdges) {
        Index const kind = level.edgeFaces[edge][1];
        ++(kind == kFreeBoundary     ? level.numFreeBoundaries
           : kind == kSharpBoundaryA ? level.numSharpBoundariesA
                                     : level.numSharpBoundariesB);
    }
}

void findHalfFaces(Level &level) {
    Index *halfFace = level.halfFaces.data();
    for (Index edge : level.boundaryEdges) {
        if (level.IsSharpBoundaryB(edge)) {
            *halfFace++ = level.edgeFaces[edge][0];
        }
    }
    std::sort(level.halfFaces.data(), halfFace);
}

} // namespace

std::vector<Index> BuildBaseLevel(EdgeSidesArray edges, Level &level) {
    FindFaceSizes(level);
    Corners corners;
    FindCorners(level, corners, false);
    buildEdges(edges, corners, level);
    return FinishBaseLevel(corners, level);
}

void BeginVertices(Level &level) {
    level.hasFullTopology = true;
    level.isHexagonal = false;
    level.numVertsOfAnyValence = level.numVertices;
    countBoundaries(level);
    Level::ForEachRelation(level, [](auto &array, std::size_t size) {
        if (array.size() != size) { // else it is filled, or large enough
            array.Resize(size);
        }
    });
    findHalfFaces(level);
    findFirstEdges(level);
}

std::vector<Index> FinishBaseLevel(Corners const &corners, Level &level) {
    BeginVertices(level);
    return WithPlaces(level, corners, [&](auto const &places) {
        return VertexBuilder(places, corners, level).Build();
    });
}

std::vector<Index> FinishOrderedLevel(Corners const &corners, Level &level) {
    BeginVertices(level);
    return WithPlaces(level, corners, [&](auto const &places) {
        return VertexBuilder(places, corners, level).BuildOrdered(corners.oddVerts);
    });
}

void FindFaceSizes(Level &level) {
    std::vector<std::vector<Index>> sizesOfRanges(
        std::size_t(GetNumParallelRanges(level.numFaces)));
    ParallelForRange(level.numFaces, [&](Index begin, Index end) {
        std::vector<Index> &sizes = sizesOfRanges[std::size_t(begin / kParallelRange)];
        Index const *const first = level.faceFirstCorner.data();
        Index const firstSize = level.GetFaceSize(begin);
        sizes.push_back(firstSize);
        Index others = 0; // bits, so that compilers look at several faces at a time
        for (Index face = begin; face < end; ++face) {
            others |= (first[face + 1] - first[face]) ^ firstSize;
        }
        for (Index face = begin; face < end && others != 0; ++face) {
            Index const size = level.GetFaceSize(face);
            if (size != sizes.back() &&
                std::find(sizes.begin(), sizes.end(), size) == sizes.end()) {
                sizes.push_back(size);
            }
        }
    });
    level.faceSizes.clear();
    for (std::vector<Index> const &sizes : sizesOfRanges) {
        level.faceSizes.insert(level.faceSizes.end(), sizes.begin(), sizes.end());
    }
    SortUnique(level.faceSizes);
}

void FinishFaces(Level &level) {
    FindFaceSizes(level);
    Level::ForEachRelation(level, [](auto &array, std::size_t size) {
        if (size == 0) {
            array.Resize(0);
        }
    });
}

} // namespace OpenSubdivHex::FarExt::internal
