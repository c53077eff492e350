// SPDX-License-Identifier: Apache-2.0
#include "baseEdges.h"

#include "indexSet.h"
#include "parallel.h"

#include <algorithm>
#include <limits>
#include <tuple>
#include <type_traits>

#if defined(__SSE2__) || defined(_M_X64)
#include <emmintrin.h>
#endif

namespace OpenSubdivHex::FarExt::internal {

namespace {

using Far::Index;
using Far::LocalIndex;

// Half of an edge: from the corner of a face to the next one.
struct HalfEdge {
    Index neighbor; // of the vertex that is looked at
    Index corner;
};

bool operator<(HalfEdge const &a, HalfEdge const &b) {
    return std::tie(a.neighbor, a.corner) < std::tie(b.neighbor, b.corner);
}

// A side of an edge that comes apart and has no number yet.
struct NewSide {
    Index first; // corner of the first side of the edge
    Index corner;
};

// Vertices that are compared with one all at once.
template <int SIZE>
class Keys {
public:
    // All of SIZE are read.
    explicit Keys(Index const *keys) {
#if defined(__SSE2__) || defined(_M_X64)
        for (int i = 0; i < SIZE / 4; ++i) {
            _fours[i] = _mm_loadu_si128(reinterpret_cast<__m128i const *>(keys) + i);
        }
#else
        std::copy_n(keys, SIZE, _keys);
#endif
    }

    // A bit for each key that equals another one.
    unsigned FindEqual(Index key) const {
#if defined(__SSE2__) || defined(_M_X64)
        __m128i const wanted = _mm_set1_epi32(key);
        auto const isEqual = [&](int i) { return _mm_cmpeq_epi32(_fours[i], wanted); };
        if constexpr (SIZE == 4) {
            return unsigned(_mm_movemask_ps(_mm_castsi128_ps(isEqual(0))));
        } else {
            unsigned result = 0;
            for (int i = 0; i < SIZE / 4; i += 2) {
                __m128i const eight = _mm_packs_epi32(isEqual(i), isEqual(i + 1));
                result |= unsigned(_mm_movemask_epi8(_mm_packs_epi16(eight, _mm_setzero_si128())))
                          << 4 * i;
            }
            return result;
        }
#else
        unsigned result = 0;
        for (int i = 0; i < SIZE; ++i) {
            result |= unsigned(_keys[i] == key) << i;
        }
        return result;
#endif
    }

private:
    static_assert((SIZE == 4 || SIZE % 8 == 0) && SIZE <= kMaxFacesAtOnce);
#if defined(__SSE2__) || defined(_M_X64)
    __m128i _fours[SIZE / 4];
#else
    Index _keys[SIZE];
#endif
};

// The place of the lowest bit of those that are set; there is one.
inline int findLowestBit(unsigned bits) {
#if defined(__GNUC__)
    return __builtin_ctz(bits);
#else
    int result = 0;
    while ((bits >> result & 1) == 0) {
        ++result;
    }
    return result;
#endif
}

// Finds the other sides of the edges that begin at corners, and the order of the faces of vertices.
//
// Every vertex has all that there is to know of its edges at hand: each of its faces leaves it along
// one and comes back along another.
template <typename PLACES>
class MateFinder {
public:
    MateFinder(PLACES places, Level &level, Corners &corners)
        : _places(places), _level(level), _faceVerts(level.faceVerts.data()), _corners(corners),
          _ofVerts(corners.ofVerts.data()), _nextVerts(corners.nextVerts.data()),
          _prevVerts(corners.prevVerts.data()), _mates(corners.mates.data()),
          _vertFirstFace(level.vertFirstFace.data()), _orderedCorners(level.vertFaces.data()) {}

    // All of them, with what faces have several times; gives the sides of edges that come apart.
    std::vector<NewSide> Find(std::vector<Index> const &repeatedVerts) {
        std::vector<Index> &oddVerts = _corners.oddVerts;
        oddVerts = ParallelSelect(
            _level.numVertices,
            [finder = MateFinder(*this)](Index vert) { return !finder.findMates(vert); },
            kShortParallelRange);
        oddVerts.insert(oddVerts.end(), repeatedVerts.begin(), repeatedVerts.end());
        SortUnique(oddVerts);
        for (Index vert : oddVerts) {
            findMatesOfAny(vert);
        }
        return std::move(_apartSides);
    }

private:
    bool findMates(Index vert) const;
    template <int NUM_FACES>
    bool findMatesOf(Index first) const {
        return findMatesOfFew<(NUM_FACES + 3) / 4 * 4>(first,
                                                       std::integral_constant<int, NUM_FACES>());
    }
    template <int SIZE, typename NUM_FACES>
    bool findMatesOfFew(Index first, NUM_FACES numFaces) const;
    template <int SIZE>
    bool findMatesOfOpen(Index first, int numFaces, int start) const;
    void findMatesOfAny(Index vert);
    void findMatesOfEdge(HalfEdge const *begin, HalfEdge const *end, Index vert);

    PLACES const _places;
    Level const &_level;
    Index const *const _faceVerts;
    Corners &_corners;
    Index const *const _ofVerts;
    Index const *const _nextVerts;
    Index const *const _prevVerts;
    Index *const _mates;
    Index const *const _vertFirstFace;
    Index *const _orderedCorners;
    std::vector<NewSide> _apartSides;
    std::vector<HalfEdge> _halfEdges; // of the vertex that is looked at
};

// Finds the mates of the corners of a vertex, and the order of its faces; false where an edge comes
// apart, or there are several fans, or many faces.  Usual numbers of faces are constants to the
// compiler (benchmark base level is 1.03 times as fast).
template <typename PLACES>
inline bool MateFinder<PLACES>::findMates(Index vert) const {
    Index const first = _vertFirstFace[vert];
    int const numFaces = _vertFirstFace[vert + 1] - first;
    switch (numFaces) {
    case 0:
        return true;
    case 3:
        return findMatesOf<3>(first);
    case 4:
        return findMatesOf<4>(first);
    case 5:
        return findMatesOf<5>(first);
    case 6:
        return findMatesOf<6>(first);
    case 7:
        return findMatesOf<7>(first);
    case 8:
        return findMatesOf<8>(first);
    default:
        return numFaces <= kMaxFacesAtOnce && findMatesOfFew<kMaxFacesAtOnce>(first, numFaces);
    }
}

// The face before another comes back along the edge that this leaves along.
template <typename PLACES>
template <int SIZE, typename NUM_FACES>
inline bool MateFinder<PLACES>::findMatesOfFew(Index first, NUM_FACES numFaces) const {
    Index const *const corners = _ofVerts + first;
    Index const *const nextVerts = _nextVerts + first;
    Keys<SIZE> const prevVerts(_prevVerts + first);
    unsigned const all = (1u << numFaces) - 1;
    int before[SIZE]; // by face of the vertex
    for (int face = 0; face < numFaces; ++face) {
        unsigned const matches = prevVerts.FindEqual(nextVerts[face]) & all;
        if (matches == 0) {
            return findMatesOfOpen<SIZE>(first, numFaces, face);
        }
        before[face] = findLowestBit(matches);
        _mates[corners[face]] = corners[before[face]];
    }
    unsigned met = 0;
    int face = 0;
    for (int i = numFaces; i-- > 0;) {
        face = before[face];
        met |= 1u << face;
        _orderedCorners[first + i] = corners[face];
    }
    // No edge has further faces: two that leave along one edge would have the same face before them,
    // and two that come back along one would leave one of them without a face behind it.
    return met == all && numFaces > 1; // one face alone has come back to itself
}

// Finds the mates in an open fan that begins with a face of the vertex: from this face on, counter-clockwise.
template <typename PLACES>
template <int SIZE>
bool MateFinder<PLACES>::findMatesOfOpen(Index first, int numFaces, int start) const {
    Index const *const corners = _ofVerts + first;
    Index const *const prevVerts = _prevVerts + first;
    Keys<SIZE> const nextVerts(_nextVerts + first);
    unsigned const all = (1u << numFaces) - 1;
    Index mate = kNoMate;
    int face = start;
    for (int i = 0;; ++i) {
        Index const corner = corners[face];
        _orderedCorners[first + i] = corner;
        _mates[corner] = mate;
        mate = corner;
        unsigned const matches = nextVerts.FindEqual(prevVerts[face]) & all;
        if (matches == 0 || i + 1 == numFaces) {
            // Had a face been met twice, there would be one behind the last.
            return matches == 0 && i + 1 == numFaces;
        }
        if ((matches & (matches - 1)) != 0) {
            return false;
        }
        face = findLowestBit(matches);
    }
}

template <typename PLACES>
void MateFinder<PLACES>::findMatesOfAny(Index vert) {
    _halfEdges.clear();
    for (Index i = _vertFirstFace[vert]; i < _vertFirstFace[vert + 1]; ++i) {
        _orderedCorners[i] = _ofVerts[i];
    }
    for (Index i = _level.vertFirstFace[vert]; i < _level.vertFirstFace[vert + 1]; ++i) {
        Index const corner = _corners.ofVerts[i];
        Index const face = _places.GetFace(corner);
        Index const prev = _places.GetPrev(face, corner);
        _halfEdges.push_back({_faceVerts[_places.GetNext(face, corner)], corner});
        if (_faceVerts[prev] != vert) { // a degenerate edge leaves the vertex, too
            _halfEdges.push_back({_faceVerts[prev], prev});
        }
    }
    std::sort(_halfEdges.begin(), _halfEdges.end());
    HalfEdge const *const last = _halfEdges.data() + _halfEdges.size();
    for (HalfEdge const *begin = _halfEdges.data(), *end = begin; begin != last; begin = end) {
        end = std::find_if(begin, last,
                           [&](HalfEdge const &half) { return half.neighbor != begin->neighbor; });
        findMatesOfEdge(begin, end, vert);
    }
}

// The halves of edges between the vertex and one of its neighbors, ascending.  An edge that comes
// apart does so at both of its vertices, and is looked at from the lower one.
template <typename PLACES>
void MateFinder<PLACES>::findMatesOfEdge(HalfEdge const *begin, HalfEdge const *end, Index vert) {
    bool const isDegenerate = begin->neighbor == vert;
    auto const leaves = [&](HalfEdge const &half) { return _faceVerts[half.corner] == vert; };
    if (!isDegenerate && end - begin == 1) {
        _mates[begin->corner] = kNoMate;
        return;
    }
    if (!isDegenerate && end - begin == 2 && leaves(begin[0]) != leaves(begin[1]) &&
        _places.GetFace(begin[0].corner) != _places.GetFace(begin[1].corner)) {
        for (int i = 0; i < 2; ++i) {
            Index const other = begin[1 - i].corner;
            _mates[begin[i].corner] = _places.GetNext(_places.GetFace(other), other);
        }
        return;
    }
    Index lastFace = Far::INDEX_INVALID; // of the edge that begins with the first half
    for (HalfEdge const *half = begin; half != end && vert <= begin->neighbor; ++half) {
        Index const face = _places.GetFace(half->corner);
        bool const isFirst = isDegenerate || half == begin || face == lastFace;
        lastFace = face;
        _mates[half->corner] = isFirst ? Index(kBeginsEdge) : kJoinsEdge;
        _apartSides.push_back({isFirst ? half->corner : begin->corner, half->corner});
    }
}

// Numbers the edges whose sides are known, and derives their relations.  Those that come apart have
// their first side here.
template <typename PLACES>
class EdgeNumbering {
public:
    EdgeNumbering(PLACES places, BoundaryKind boundary, Corners const &corners, Level &level)
        : _places(places), _boundary(boundary), _corners(corners), _level(level),
          _boundaryEdges(std::size_t(GetNumParallelRanges(level.numCorners))) {}

    // The number of edges, but for other sides of those that come apart.
    std::int64_t Count() {
        _firstEdges = ParallelSums<std::int64_t>(_level.numCorners, [this](Index begin, Index end) {
            Index const *const mates = _corners.mates.data();
            Index count = 0;
            for (Index corner = begin; corner < end; ++corner) {
                count += mates[corner] > corner;
            }
            return std::int64_t(count);
        });
        return _firstEdges.back();
    }

    // Fills in all of them; there is room.
    void Fill() {
        ParallelForRange(_level.numCorners, [this](Index begin, Index end) { fill(begin, end); });
    }

    // Edges at boundaries, ascending.
    std::vector<Index> GetBoundaryEdges() const {
        std::vector<Index> result;
        for (std::vector<Index> const &edges : _boundaryEdges) {
            result.insert(result.end(), edges.begin(), edges.end());
        }
        return result;
    }

private:
    void fill(Index begin, Index end) {
        std::size_t const range = std::size_t(begin / kParallelRange);
        EdgeWriter<PLACES> const writer(_places, _level);
        Index const *const mates = _corners.mates.data();
        auto edge = Index(_firstEdges[range]);
        for (Index corner = begin; corner < end; ++corner) {
            Index const mate = mates[corner];
            if (mate <= corner) {
                continue;
            }
            if (IsCorner(mate)) {
                writer.WriteBeforeMate(edge++, corner, mate);
            } else {
                _boundaryEdges[range].push_back(edge);
                writer.Write(edge++, corner, mate == kNoMate ? _boundary : kSharpBoundaryA);
            }
        }
    }

    PLACES const _places;
    BoundaryKind _boundary;
    Corners const &_corners;
    Level &_level;
    std::vector<std::int64_t> _firstEdges;          // by range of corners
    std::vector<std::vector<Index>> _boundaryEdges; // by range of corners
};

// Counts the edges of the base that come apart, and tells the first ones: those that two faces, and no
// others, run in the same direction, and all others.
class ApartEdges {
public:
    explicit ApartEdges(Level const &level) : _level(level) {}

    void Add(ApartSide const *begin, ApartSide const *end) {
        Found &found = isInconsistent(begin, end) ? _inconsistent : _nonManifold;
        if (found.count++ == 0) {
            found.first.assign(begin, end);
        }
    }
    CallStatus GetStatus() const {
        CallStatus status;
        if (_nonManifold.count > 0) {
            status.AddWarning({WarningCode::NonManifoldEdges, ComponentType::Edge,
                               _nonManifold.first[0].edge, _nonManifold.count,
                               describeNonManifold()});
        }
        if (_inconsistent.count > 0) {
            status.AddWarning({WarningCode::InconsistentOrientation, ComponentType::Edge,
                               _inconsistent.first[0].edge, _inconsistent.count,
                               describeInconsistent()});
        }
        return status;
    }

private:
    struct Found {
        std::vector<ApartSide> first; // sides of the first edge
        std::int64_t count = 0;
    };

    Index getFace(ApartSide const &side) const { return _level.FindFaceOfCorner(side.corner); }
    Index getStart(ApartSide const &side) const { return _level.faceVerts[side.corner]; }
    Index getEnd(ApartSide const &side) const {
        return _level.faceVerts[_level.GetNextCorner(getFace(side), side.corner)];
    }
    bool isInconsistent(ApartSide const *begin, ApartSide const *end) const {
        return end - begin == 2 && getFace(begin[0]) != getFace(begin[1]) &&
               getStart(begin[0]) == getStart(begin[1]) && getStart(begin[0]) != getEnd(begin[0]);
    }
    std::string describeFirst(Found const &found) const {
        ApartSide const &side = found.first[0];
        return "first edge " + std::to_string(side.edge) + " between vertices " +
               std::to_string(getStart(side)) + " and " + std::to_string(getEnd(side));
    }
    std::string describeNonManifold() const {
        return std::to_string(_nonManifold.count) +
               (_nonManifold.count == 1 ? " non-manifold edge comes" : " non-manifold edges come") +
               " apart, " + describeFirst(_nonManifold);
    }
    std::string describeInconsistent() const {
        return "inconsistent orientation, taken as non-manifold: faces run " +
               std::to_string(_inconsistent.count) +
               (_inconsistent.count == 1 ? " edge" : " edges") + " in the same direction, " +
               describeFirst(_inconsistent) + ", of faces " +
               std::to_string(getFace(_inconsistent.first[0])) + " and " +
               std::to_string(getFace(_inconsistent.first[1]));
    }

    Level const &_level;
    Found _nonManifold;
    Found _inconsistent;
};

// Gives each side of the edges of the base that come apart an edge of its own: the first of each has
// that edge's index, the others follow the edges of the base in the order of their corners.  Adds the
// tags, and gives a CallStatus with warnings of these edges.
CallStatus takeApart(Index numEdges, std::vector<ApartSide> &sides, Level &level) {
    auto const isBefore = [](ApartSide const &a, ApartSide const &b) {
        return std::tie(a.edge, a.corner) < std::tie(b.edge, b.corner);
    };
    std::sort(sides.begin(), sides.end(), isBefore);
    ApartEdges apartEdges(level);
    std::vector<ApartSide> firsts;
    std::vector<ApartSide> others;
    ApartSide const *const last = sides.data() + sides.size();
    for (ApartSide const *begin = sides.data(), *end = begin; begin != last; begin = end) {
        end = std::find_if(begin, last,
                           [&](ApartSide const &side) { return side.edge != begin->edge; });
        apartEdges.Add(begin, end);
        firsts.push_back(*begin);
        others.insert(others.end(), begin + 1, end);
    }
    std::sort(others.begin(), others.end(),
              [](ApartSide const &a, ApartSide const &b) { return a.corner < b.corner; });
    for (ApartSide const &side : firsts) {
        level.lineEdges.push_back({side.edge, side.edge});
    }
    for (ApartSide &side : others) {
        level.lineEdges.push_back({numEdges, side.edge});
        side.edge = numEdges++;
    }
    for (LineEdge const &line : level.lineEdges) {
        level.nonManifoldEdges.push_back(line.edge);
    }
    sides = std::move(firsts);
    sides.insert(sides.end(), others.begin(), others.end());
    return apartEdges.GetStatus();
}

// Numbers the edges of a level, with all their relations.
template <typename PLACES>
CallStatus numberEdges(PLACES const &places, BoundaryKind boundary,
                       std::vector<NewSide> const &apartSides, Corners const &corners,
                       Level &level) {
    EdgeNumbering<PLACES> numbering(places, boundary, corners, level);
    std::int64_t const numBaseEdges = numbering.Count();
    std::int64_t const numOthers =
        std::count_if(apartSides.begin(), apartSides.end(),
                      [](NewSide const &side) { return side.corner != side.first; });
    if (CallStatus status = CheckCount(2 * (numBaseEdges + numOthers), "ends of edges");
        !status.IsOk()) {
        return status;
    }
    ResizeEdges(std::size_t(numBaseEdges + numOthers), level);
    numbering.Fill();
    std::vector<ApartSide> sides;
    sides.reserve(apartSides.size());
    for (NewSide const &side : apartSides) {
        sides.push_back({level.faceEdges[side.first], side.corner});
    }
    std::vector<Index> boundaryEdges = numbering.GetBoundaryEdges();
    CallStatus status = takeApart(Index(numBaseEdges), sides, level);
    for (ApartSide const &side : sides) {
        if (side.edge >= numBaseEdges) {
            EdgeWriter(places, level).Write(side.edge, side.corner, kSharpBoundaryA);
            boundaryEdges.push_back(side.edge);
        }
    }
    level.boundaryEdges.Assign(boundaryEdges);
    return status;
}

} // namespace

CallStatus BuildLevelOfFaces(BoundaryKind boundary, std::vector<Index> const &repeatedVerts,
                             Level &level, std::vector<Index> &fanned) {
    Corners corners;
    FindCorners(level, corners, true);
    CallStatus status = WithPlaces(level, corners, [&](auto const &places) {
        std::vector<NewSide> const apartSides =
            MateFinder(places, level, corners).Find(repeatedVerts);
        return numberEdges(places, boundary, apartSides, corners, level);
    });
    if (status.IsOk()) {
        fanned = FinishOrderedLevel(corners, level);
    }
    return status;
}

CallStatus BuildLevelOfEdges(Buffer<EdgeSides> edges, std::vector<ApartSide> sides, Level &level,
                             std::vector<Index> &fanned) {
    auto const numBaseEdges = Index(edges.size());
    CallStatus status = takeApart(numBaseEdges, sides, level);
    std::size_t const numEdges =
        sides.empty() ? edges.size() : std::max(edges.size(), std::size_t(sides.back().edge) + 1);
    if (CallStatus count = CheckCount(2 * std::int64_t(numEdges), "ends of edges"); !count.IsOk()) {
        return count;
    }
    if (numEdges > edges.size()) {
        Buffer<EdgeSides> all;
        all.Resize(numEdges);
        std::copy(edges.begin(), edges.end(), all.data());
        edges = std::move(all);
    }
    for (ApartSide const &side : sides) {
        edges[std::size_t(side.edge)] = {{side.corner, kSharpBoundaryA}};
    }
    fanned = BuildBaseLevel({edges.data(), Index(numEdges)}, level);
    return status;
}

CallStatus CheckCount(std::int64_t count, std::string const &what) {
    if (count <= std::numeric_limits<Index>::max()) {
        return CallStatus();
    }
    return CallStatus(StatusCode::TooLarge, ComponentType::Level, 0,
                      "level 0 would have " + std::to_string(count) + " " + what +
                          ", more than 32-bit indices reach");
}

} // namespace OpenSubdivHex::FarExt::internal
