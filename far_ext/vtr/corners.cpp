// SPDX-License-Identifier: Apache-2.0
#include "corners.h"

#include "parallel.h"

#include <algorithm>

namespace OpenSubdivHex::FarExt::internal {

namespace {

using Far::Index;

// A counting sort of corners by vertex, in pieces of consecutive faces.  Each piece counts the
// corners of the vertices that it has, so that it knows where its own corners go once all have
// counted.  Where vertices that are near have numbers that are, the counts of all pieces together
// are at most some times the vertices; else one piece has all corners.
class CornerSorter {
public:
    CornerSorter(Level &level, Corners &corners) : _level(level), _sorted(corners) {}

    void Sort(bool findsNeighbors) {
        ResizeCorners(_level);
        auto const numCorners = std::size_t(_level.numCorners);
        _sorted.ofVerts.Resize(numCorners);
        makePieces();
        forEachPiece([this](Piece &piece) { count(piece); });
        addCounts();
        if (!findsNeighbors) {
            forEachPiece([this](Piece &piece) { place(piece); });
            return;
        }
        _sorted.nextVerts.Resize(numCorners + kMaxFacesAtOnce);
        _sorted.prevVerts.Resize(numCorners + kMaxFacesAtOnce);
        WithPlaces(_level, _sorted, [this](auto const &places) {
            forEachPiece([&](Piece &piece) { placeWithNeighbors(places, piece); });
        });
    }

private:
    struct Piece {
        Index beginFace;
        Index endFace;
        Index begin; // of the corners
        Index end;
        Index beginVert; // of a range that has all of their vertices
        Index endVert;
        Index *counts; // by vertex of the range; then where its next corner goes
    };

    template <typename FUNCTION>
    void forEachPiece(FUNCTION function) {
        ParallelForRange(
            Index(_pieces.size()), [] { return Nothing(); },
            [&](Nothing, Index begin, Index) { function(_pieces[std::size_t(begin)]); }, 1);
    }
    // Calls function(counts, begin, end) for the part of each piece's range of vertices that lies
    // within another range; counts are those from begin on.
    template <typename FUNCTION>
    void forEachCounts(Index begin, Index end, FUNCTION function) {
        for (Piece const &piece : _pieces) {
            Index const from = std::max(begin, piece.beginVert);
            Index const to = std::min(end, piece.endVert);
            if (from < to) {
                function(piece.counts + (from - piece.beginVert), from, to);
            }
        }
    }

    void makePieces();
    void findVertices(Piece &piece) const;
    void count(Piece &piece) const;
    void addCounts();
    void place(Piece &piece);
    template <typename PLACES>
    void placeWithNeighbors(PLACES places, Piece &piece);

    Level &_level;
    Corners &_sorted;
    std::vector<Piece> _pieces;
    Buffer<Index> _counts;
};

void CornerSorter::makePieces() {
    constexpr Index kMaxPieces = 64;
    constexpr Index kPieceCorners = Index(1) << 12;
    Index numPieces = std::min({_level.numCorners / kPieceCorners, kMaxPieces, _level.numFaces});
    if (numPieces <= kMaxRangesAlone) {
        numPieces = 1;
    }
    auto const addPiece = [this](Index beginFace, Index endFace) {
        _pieces.push_back({beginFace, endFace, _level.faceFirstCorner[beginFace],
                           _level.faceFirstCorner[endFace], 0, _level.numVertices, nullptr});
    };
    auto const findFace = [&](Index piece) {
        return Index(std::int64_t(_level.numFaces) * piece / numPieces);
    };
    for (Index i = 0; i < numPieces; ++i) {
        addPiece(findFace(i), findFace(i + 1));
    }
    if (numPieces > 1) {
        forEachPiece([this](Piece &piece) { findVertices(piece); });
    }
    auto const getNumCounts = [this] {
        std::size_t result = 0;
        for (Piece const &piece : _pieces) {
            result += std::size_t(piece.endVert - piece.beginVert);
        }
        return result;
    };
    if (getNumCounts() > 3 * std::size_t(_level.numVertices)) {
        _pieces.clear();
        addPiece(0, _level.numFaces);
    }
    _counts.Resize(getNumCounts());
    Index *counts = _counts.data();
    for (Piece &piece : _pieces) {
        piece.counts = counts;
        counts += piece.endVert - piece.beginVert;
    }
}

void CornerSorter::findVertices(Piece &piece) const {
    Index const *const verts = _level.faceVerts.data();
    Index lowest = verts[piece.begin];
    Index highest = lowest;
    for (Index corner = piece.begin; corner < piece.end; ++corner) {
        lowest = std::min(lowest, verts[corner]);
        highest = std::max(highest, verts[corner]);
    }
    piece.beginVert = lowest;
    piece.endVert = highest + 1;
}

void CornerSorter::count(Piece &piece) const {
    Index const *const verts = _level.faceVerts.data();
    Index const beginVert = piece.beginVert;
    Index *const counts = piece.counts;
    std::fill_n(counts, piece.endVert - beginVert, 0);
    for (Index corner = piece.begin; corner < piece.end; ++corner) {
        ++counts[verts[corner] - beginVert];
    }
}

// Sums the counts of all pieces to vertFirstFace, and makes them the places of the next corners.
void CornerSorter::addCounts() {
    Index *const first = _level.vertFirstFace.data();
    std::vector<Index> const sums =
        ParallelSums<Index>(_level.numVertices, [&](Index begin, Index end) {
            Index sum = 0;
            std::fill(first + begin + 1, first + end + 1, 0);
            forEachCounts(begin, end, [&](Index *counts, Index from, Index to) {
                for (Index vert = from; vert < to; ++vert) {
                    Index const numBefore = first[vert + 1];
                    first[vert + 1] += counts[vert - from];
                    sum += counts[vert - from];
                    counts[vert - from] = numBefore;
                }
            });
            return sum;
        });
    first[0] = 0;
    ParallelForRange(_level.numVertices, [&](Index begin, Index end) {
        Index const start = sums[std::size_t(begin / kParallelRange)];
        Index next = start;
        for (Index vert = begin; vert < end; ++vert) {
            next += first[vert + 1];
            first[vert + 1] = next;
        }
        forEachCounts(begin, end, [&](Index *counts, Index from, Index to) {
            for (Index vert = from; vert < to; ++vert) {
                // The first entry of the range is written by another one.
                counts[vert - from] += vert == begin ? start : first[vert];
            }
        });
    });
}

void CornerSorter::place(Piece &piece) {
    Index const *const verts = _level.faceVerts.data();
    Index const beginVert = piece.beginVert;
    Index *const next = piece.counts;
    Index *const ofVerts = _sorted.ofVerts.data();
    for (Index corner = piece.begin; corner < piece.end; ++corner) {
        ofVerts[next[verts[corner] - beginVert]++] = corner;
    }
}

template <typename PLACES>
void CornerSorter::placeWithNeighbors(PLACES places, Piece &piece) {
    Index const *const verts = _level.faceVerts.data();
    Index const beginVert = piece.beginVert;
    Index *const next = piece.counts;
    Index *const ofVerts = _sorted.ofVerts.data();
    Index *const nextVerts = _sorted.nextVerts.data();
    Index *const prevVerts = _sorted.prevVerts.data();
    for (Index face = piece.beginFace; face < piece.endFace; ++face) {
        Index const first = places.GetFirst(face);
        Index const size = places.GetFirst(face + 1) - first;
        Index prevVert = verts[first + size - 1];
        Index vert = verts[first];
        for (Index i = 0; i < size; ++i) {
            Index const nextVert = verts[first + (i + 1 < size ? i + 1 : 0)];
            Index const place = next[vert - beginVert]++;
            ofVerts[place] = first + i;
            nextVerts[place] = nextVert;
            prevVerts[place] = prevVert;
            prevVert = vert;
            vert = nextVert;
        }
    }
}

} // namespace

void ResizeCorners(Level &level) {
    auto const numCorners = std::size_t(level.numCorners);
    PlaceArrays(level.cornerMemory, [&](auto const &place) {
        place(level.vertFirstFace, std::size_t(level.numVertices) + 1);
        place(level.vertFaces, numCorners);
        place(level.vertFaceLocals, numCorners);
        place(level.faceEdges, numCorners);
    });
}

void ResizeEdges(std::size_t numEdges, Level &level) {
    level.numEdges = Index(numEdges);
    PlaceArrays(level.edgeMemory, [&](auto const &place) {
        place(level.edgeVerts, numEdges);
        place(level.edgeFaces, numEdges);
        place(level.edgeFaceLocals, numEdges);
        place(level.vertFirstEdge, std::size_t(level.numVertices) + 1);
        place(level.vertEdges, 2 * numEdges);
        place(level.vertEdgeLocals, 2 * numEdges);
    });
}

void FindCorners(Level &level, Corners &corners, bool findsNeighbors) {
    CornerSorter(level, corners).Sort(findsNeighbors);
    corners.mates.Resize(level.numCorners);
    bool const isUniform = level.faceSizes.size() == 1 && level.faceSizes[0] <= 4;
    if (isUniform) {
        return;
    }
    corners.faces.Resize(level.numCorners);
    ParallelFor(level.numFaces, [&](Index face) {
        std::fill(corners.faces.data() + level.faceFirstCorner[face],
                  corners.faces.data() + level.faceFirstCorner[face + 1], face);
    });
}

} // namespace OpenSubdivHex::FarExt::internal
