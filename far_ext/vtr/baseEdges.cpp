// SPDX-License-Identifier: Apache-2.0
#include "baseEdges.h"

#include "parallel.h"

#include <algorithm>
#include <array>
#include <limits>
#include <tuple>
#include <type_traits>

namespace OpenSubdivHex::FarExt::internal {

namespace {

using Far::Index;

std::string str(std::int64_t number) { return std::to_string(number); }

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

// The place of the one of SIZE keys that equals another key, SIZE or more if there are several, -1 if
// there is none.  Without branches, which would be guessed wrongly on meshes that are not regular.
template <int SIZE>
int findOne(Index const *keys, Index key) {
    constexpr int kCount = 1 << 8; // a sum of these tells how many there are, and the place of one
    static_assert(SIZE < kCount);
    constexpr auto kPlaces = [] {
        std::array<int, SIZE> places{};
        for (int i = 0; i < SIZE; ++i) {
            places[i] = kCount + i;
        }
        return places;
    }();
    int sum = 0;
    for (int i = 0; i < SIZE; ++i) {
        sum += keys[i] == key ? kPlaces[i] : 0;
    }
    return std::max(-1, sum - kCount);
}

// Finds the other sides of the edges that begin at corners.
//
// Every vertex has all that there is to know of its edges at hand: each of its faces leaves it along
// one and comes back along another.
template <typename PLACES>
class MateFinder {
public:
    MateFinder(PLACES places, Level const &level, Corners &corners)
        : _places(places), _level(level), _faceVerts(level.faceVerts.data()), _corners(corners),
          _mates(corners.mates.data()) {}

    // All of them; gives the sides of edges that come apart.
    std::vector<NewSide> Find() {
        std::vector<Index> const others = ParallelSelect(
            _level.numVertices, [this](Index vert) { return !findMates(vert); },
            kShortParallelRange);
        for (Index vert : others) {
            findMatesOfAny(vert);
        }
        return std::move(_apartSides);
    }

private:
    bool findMates(Index vert) const;
    template <int NUM_FACES>
    bool findMatesOf(Index const *corners) const {
        return findMatesOfFew<NUM_FACES>(corners, std::integral_constant<int, NUM_FACES>());
    }
    template <int SIZE, typename NUM_FACES>
    bool findMatesOfFew(Index const *corners, NUM_FACES numFaces) const;
    void findMatesOfAny(Index vert);
    void findMatesOfEdge(HalfEdge const *begin, HalfEdge const *end, Index vert);

    PLACES const _places;
    Level const &_level;
    Index const *const _faceVerts;
    Corners &_corners;
    Index *const _mates;
    std::vector<NewSide> _apartSides;
    std::vector<HalfEdge> _halfEdges; // of the vertex that is looked at
};

// Finds the mates of the corners of a vertex; false where an edge comes apart, or there are many.
// Usual numbers of faces are constants to the compiler, which then keeps all in registers (benchmark
// base level/triangle is 1.1 times as fast).
template <typename PLACES>
bool MateFinder<PLACES>::findMates(Index vert) const {
    Index const *const corners = _corners.ofVerts.data() + _level.vertFirstFace[vert];
    int const numFaces = _level.GetNumVertexFaces(vert);
    switch (numFaces) {
    case 3:
        return findMatesOf<3>(corners);
    case 4:
        return findMatesOf<4>(corners);
    case 5:
        return findMatesOf<5>(corners);
    case 6:
        return findMatesOf<6>(corners);
    case 7:
        return findMatesOf<7>(corners);
    case 8:
        return findMatesOf<8>(corners);
    default:
        return numFaces <= 16 && findMatesOfFew<16>(corners, numFaces);
    }
}

template <typename PLACES>
template <int SIZE, typename NUM_FACES>
bool MateFinder<PLACES>::findMatesOfFew(Index const *corners, NUM_FACES numFaces) const {
    // The vertices to which the faces leave, and from which they come back; no vertex behind these.
    Index outs[SIZE];
    Index ins[SIZE];
    Index prevs[SIZE]; // corners
    for (int i = 0; i < SIZE; ++i) {
        ins[i] = Far::INDEX_INVALID;
    }
    for (int i = 0; i < numFaces; ++i) {
        Index const face = _places.GetFace(corners[i]);
        prevs[i] = _places.GetPrev(face, corners[i]);
        outs[i] = _faceVerts[_places.GetNext(face, corners[i])];
        ins[i] = _faceVerts[prevs[i]];
    }
    unsigned matched = 0; // of those that come back
    int numMatched = 0;
    bool isOdd = false;
    for (int i = 0; i < numFaces; ++i) {
        int const place = findOne<SIZE>(ins, outs[i]);
        isOdd |= place >= SIZE;
        if (place < 0 || place >= SIZE) {
            _mates[corners[i]] = kNoMate;
            continue;
        }
        _mates[corners[i]] = prevs[place];
        isOdd |= _places.GetFace(prevs[place]) == _places.GetFace(corners[i]) ||
                 (matched >> place & 1) != 0;
        matched |= 1u << place;
        ++numMatched;
    }
    // Where two faces leave along edges without others, these may be one edge; so where they come
    // back.
    return !isOdd && numMatched >= numFaces - 1;
}

template <typename PLACES>
void MateFinder<PLACES>::findMatesOfAny(Index vert) {
    _halfEdges.clear();
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
        _mates[begin[0].corner] = begin[1].corner;
        _mates[begin[1].corner] = begin[0].corner;
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

    // Those at boundaries, ascending.
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
            Index other = mates[corner];
            if (other <= corner) {
                continue;
            }
            if (!IsCorner(other)) {
                other = other == kNoMate ? _boundary : kSharpBoundaryA;
                _boundaryEdges[range].push_back(edge);
            }
            writer.Write(edge++, corner, other);
        }
    }

    PLACES const _places;
    BoundaryKind _boundary;
    Corners const &_corners;
    Level &_level;
    std::vector<std::int64_t> _firstEdges;          // by range of corners
    std::vector<std::vector<Index>> _boundaryEdges; // by range of corners
};

// Notes the edges that two faces, and no others, run in the same direction.
class OrientationWarning {
public:
    explicit OrientationWarning(Level const &level) : _level(level) {}

    void Inspect(ApartSide const *begin, ApartSide const *end) {
        if (end - begin != 2 || getFace(begin[0]) == getFace(begin[1]) ||
            getStart(begin[0]) != getStart(begin[1]) || getStart(begin[0]) == getEnd(begin[0])) {
            return;
        }
        if (_count++ == 0) {
            _first.assign(begin, end);
        }
    }
    Status GetStatus() const {
        Status status;
        if (_count > 0) {
            status.AddWarning({WarningCode::InconsistentOrientation, ComponentType::Edge,
                               _first[0].edge, _count, describe()});
        }
        return status;
    }

private:
    Index getFace(ApartSide const &side) const { return _level.FindFaceOfCorner(side.corner); }
    Index getStart(ApartSide const &side) const { return _level.faceVerts[side.corner]; }
    Index getEnd(ApartSide const &side) const {
        return _level.faceVerts[_level.GetNextCorner(getFace(side), side.corner)];
    }
    std::string describe() const {
        return "inconsistent orientation, taken as non-manifold: faces run " + str(_count) +
               (_count == 1 ? " edge" : " edges") + " in the same direction, first edge " +
               str(_first[0].edge) + " between vertices " + str(getStart(_first[0])) + " and " +
               str(getEnd(_first[0])) + ", of faces " + str(getFace(_first[0])) + " and " +
               str(getFace(_first[1]));
    }

    Level const &_level;
    std::vector<ApartSide> _first; // sides of the first edge
    std::int64_t _count = 0;
};

// Gives each side of the edges of the base that come apart an edge of its own: the first of each has
// that edge's index, the others follow the edges of the base in the order of their corners.  Adds the
// tags, and gives a Status with a warning of edges that two faces run in the same direction.
Status takeApart(Index numEdges, std::vector<ApartSide> &sides, Level &level) {
    auto const isBefore = [](ApartSide const &a, ApartSide const &b) {
        return std::tie(a.edge, a.corner) < std::tie(b.edge, b.corner);
    };
    std::sort(sides.begin(), sides.end(), isBefore);
    OrientationWarning warning(level);
    std::vector<ApartSide> firsts;
    std::vector<ApartSide> others;
    ApartSide const *const last = sides.data() + sides.size();
    for (ApartSide const *begin = sides.data(), *end = begin; begin != last; begin = end) {
        end = std::find_if(begin, last,
                           [&](ApartSide const &side) { return side.edge != begin->edge; });
        warning.Inspect(begin, end);
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
    return warning.GetStatus();
}

// Numbers the edges of a level, with all their relations.
template <typename PLACES>
Status numberEdges(PLACES const &places, BoundaryKind boundary,
                   std::vector<NewSide> const &apartSides, Corners const &corners, Level &level) {
    EdgeNumbering<PLACES> numbering(places, boundary, corners, level);
    std::int64_t const numBaseEdges = numbering.Count();
    std::int64_t const numOthers =
        std::count_if(apartSides.begin(), apartSides.end(),
                      [](NewSide const &side) { return side.corner != side.first; });
    if (Status status = CheckCount(2 * (numBaseEdges + numOthers), "ends of edges");
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
    Status status = takeApart(Index(numBaseEdges), sides, level);
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

Status BuildLevelOfFaces(BoundaryKind boundary, Level &level, std::vector<Index> &fanned) {
    FindFaceSizes(level);
    Corners corners;
    FindCorners(level, corners);
    Status status = WithPlaces(level, corners, [&](auto const &places) {
        std::vector<NewSide> const apartSides = MateFinder(places, level, corners).Find();
        return numberEdges(places, boundary, apartSides, corners, level);
    });
    if (status.IsOk()) {
        fanned = FinishBaseLevel(corners, level);
    }
    return status;
}

Status BuildLevelOfEdges(Buffer<EdgeSides> edges, std::vector<ApartSide> sides, Level &level,
                         std::vector<Index> &fanned) {
    auto const numBaseEdges = Index(edges.size());
    Status status = takeApart(numBaseEdges, sides, level);
    std::size_t const numEdges =
        sides.empty() ? edges.size() : std::max(edges.size(), std::size_t(sides.back().edge) + 1);
    if (Status count = CheckCount(2 * std::int64_t(numEdges), "ends of edges"); !count.IsOk()) {
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

Status CheckCount(std::int64_t count, std::string const &what) {
    if (count <= std::numeric_limits<Index>::max()) {
        return Status();
    }
    return Status(StatusCode::TooLarge, ComponentType::Level, 0,
                  "level 0 would have " + str(count) + " " + what +
                      ", more than 32-bit indices reach");
}

} // namespace OpenSubdivHex::FarExt::internal
