// SPDX-License-Identifier: Apache-2.0
#include "quadFeatures.h"

#include "indexSet.h"
#include "parallel.h"

#include <opensubdiv/sdc/crease.h>

#include <algorithm>
#include <cstddef>
#include <unordered_map>
#include <utility>
#include <vector>

namespace OpenSubdivHex::FarExt::internal {

namespace {

using Far::Index;
using Sdc::Crease;

QuadFlags makeBaseFlags(Level const &level, Index vert) {
    Far::ConstIndexArray const faces = level.GetVertexFaces(vert);
    QuadFlag const flag = FindQuadFlag(faces.size(), [&](int i) {
        return level.IsHalfFace(faces[i]) ? 0 : level.GetFaceSize(faces[i]);
    });
    if (faces.empty() || flag == 0 || level.IsNonManifold(vert)) {
        return {};
    }
    Far::ConstIndexArray const edges = level.GetVertexEdges(vert);
    float sharpness = level.GetVertexSharpness(vert);
    for (Index edge : edges) {
        if (level.IsBoundary(edge)) {
            return {};
        }
        sharpness = std::max(sharpness, level.GetEdgeSharpness(edge));
    }
    if (Crease::IsInfinite(sharpness)) {
        return {};
    }
    return {flag, flag, sharpness};
}

// Finds the corners beside lines of a level that no step has made.
class QuadLineFinder {
public:
    explicit QuadLineFinder(Level &level) : _level(level) {}

    void Find();

private:
    // The three sharpest edges at a vertex; those of no line at one that is not manifold.
    struct SharpEdges {
        float sharpness[3]; // descending
        int locals[2];      // of the line, ascending
        float GetCross(float ofVertex) const { return std::max(sharpness[2], ofVertex); }
    };
    float getSharpness(Index edge) const {
        if (_level.IsBoundary(edge)) {
            return _level.edgeFaces[edge][1] == kSharpBoundaryA ? Crease::SHARPNESS_INFINITE : 0;
        }
        return _level.GetEdgeSharpness(edge);
    }
    SharpEdges findSharpEdges(Index vert) const;
    void add(Index corner, LineFlag out, LineFlag in, LineSharpness sharpness);
    void addSides(Index vert);
    void addSide(Index vert, int begin, int numFaces, LineSharpness sharpness);
    void addOtherEnd(Index corner, Index face, Index edge, LineFlag::Kind down, int numQuads,
                     LineSharpness sharpness);
    bool isOnQuads(Index vert, int begin, int numFaces) const;
    Index getFaceOf(Index vert, int i) const {
        Far::ConstIndexArray const faces = _level.GetVertexFaces(vert);
        return faces[i % faces.size()];
    }

    Level &_level;
    std::vector<QuadLineCorner> _found;
    std::unordered_map<Index, std::size_t> _indices; // in _found, by corner
};

QuadLineFinder::SharpEdges QuadLineFinder::findSharpEdges(Index vert) const {
    SharpEdges result = {{0, 0, 0}, {-1, -1}};
    Far::ConstIndexArray const edges = _level.GetVertexEdges(vert);
    for (int i = 0; i < edges.size(); ++i) {
        float const sharpness = getSharpness(edges[i]);
        int place = 2;
        while (place >= 0 && result.sharpness[place] < sharpness) {
            --place;
        }
        for (int k = 2; k > place + 1; --k) {
            result.sharpness[k] = result.sharpness[k - 1];
        }
        if (place < 1) {
            result.locals[1] = place < 0 ? result.locals[0] : i;
        }
        if (place < 0) {
            result.locals[0] = i;
        }
        if (place < 2) {
            result.sharpness[place + 1] = sharpness;
        }
    }
    std::sort(result.locals, result.locals + 2);
    return result;
}

bool QuadLineFinder::isOnQuads(Index vert, int begin, int numFaces) const {
    constexpr int kQuad = 4;
    for (int i = begin; i < begin + numFaces; ++i) {
        Index const face = getFaceOf(vert, i);
        if (_level.GetFaceSize(face) != kQuad || _level.IsHalfFace(face)) {
            return false;
        }
    }
    return true;
}

// Of two lines in one role the one with the larger share has it.
void QuadLineFinder::add(Index corner, LineFlag out, LineFlag in, LineSharpness sharpness) {
    auto const [found, isNew] = _indices.try_emplace(corner, _found.size());
    if (isNew) {
        _found.push_back({corner, {}});
    }
    QuadLineFlags &flags = _found[found->second].flags;
    int const role = int(out.GetRole());
    if (flags.outLines[role].GetShare() > sharpness.GetShare()) {
        return;
    }
    flags.out = AddLineFlag(flags.out, out);
    flags.in = AddLineFlag(flags.in, in);
    flags.outLines[role] = flags.inLines[role] = sharpness;
}

// Face i of a vertex lies between its edges i and i + 1.
void QuadLineFinder::addSides(Index vert) {
    SharpEdges const edges = findSharpEdges(vert);
    LineSharpness const sharpness = {edges.sharpness[1],
                                     edges.GetCross(_level.GetVertexSharpness(vert))};
    if (!(sharpness.line > sharpness.cross) || _level.IsNonManifold(vert)) {
        return;
    }
    int const numFaces = _level.GetNumVertexFaces(vert);
    int const ofFirst = edges.locals[1] - edges.locals[0];
    addSide(vert, edges.locals[0], ofFirst, sharpness);
    if (!_level.IsBoundary(_level.GetVertexEdges(vert)[0])) {
        addSide(vert, edges.locals[1], numFaces - ofFirst, sharpness);
    }
}

void QuadLineFinder::addSide(Index vert, int begin, int numFaces, LineSharpness sharpness) {
    if (numFaces < LineFlag::kMinQuads || numFaces > LineFlag::kMaxQuads ||
        !isOnQuads(vert, begin, numFaces)) {
        return;
    }
    // Flags are counted from both ends of the line.
    int const numFlags = 2 * numFaces;
    auto const makeFlag = [&](int i) {
        return LineFlag{numFaces, LineFlag::Kind(std::min(i, numFlags - 1 - i))};
    };
    Far::ConstIndexArray const edges = _level.GetVertexEdges(vert);
    for (int i = 0; i < numFaces; ++i) {
        Index const face = getFaceOf(vert, begin + i);
        Index const edge = edges[(begin + i) % edges.size()];
        Index const corner = _level.GetVertexCorner(_level.vertFirstFace[vert] +
                                                    (begin + i) % _level.GetNumVertexFaces(vert));
        add(corner, makeFlag(2 * i), makeFlag(2 * i + 1), sharpness);
        // The other ends of the edges of this face but those of the line.
        bool const isAtLine = i == 0 || i == numFaces - 1;
        LineFlag::Kind const down = isAtLine ? LineFlag::kDown : LineFlag::kDownBehind;
        if (i > 0) {
            addOtherEnd(_level.GetNextCorner(face, corner), face, edge, down, numFaces, sharpness);
        }
        if (i < numFaces - 1) {
            Index const before = _level.GetPrevCorner(face, corner);
            addOtherEnd(before, face, _level.faceEdges[before], down, numFaces, sharpness);
        }
    }
}

// The corner at the other end of an edge from the line: not where its other edge leads to a line that is as sharp, or it is
// at one itself.
void QuadLineFinder::addOtherEnd(Index corner, Index face, Index edge, LineFlag::Kind down,
                                 int numQuads, LineSharpness sharpness) {
    Index const vert = _level.faceVerts[corner];
    QuadFlags const inside = makeBaseFlags(_level, vert);
    if (inside.out != MakeQuadFlag(4)) {
        return;
    }
    bool const isOut = _level.faceEdges[corner] == edge;
    Index const beyond = _level.faceVerts[isOut ? _level.GetPrevCorner(face, corner)
                                                : _level.GetNextCorner(face, corner)];
    sharpness.cross =
        std::max({sharpness.cross, inside.sharpness, _level.GetVertexSharpness(beyond),
                  findSharpEdges(beyond).sharpness[0]});
    if (!(sharpness.line > sharpness.cross)) {
        return;
    }
    LineFlag const ofDown = {numQuads, down};
    LineFlag const ofTop = {numQuads, LineFlag::Kind(down + 1)};
    add(corner, isOut ? ofDown : ofTop, isOut ? ofTop : ofDown, sharpness);
}

void QuadLineFinder::Find() {
    for (SharpVertex const &sharp : _level.sharpVerts) {
        addSides(sharp.vert);
    }
    std::sort(_found.begin(), _found.end(),
              [](QuadLineCorner const &x, QuadLineCorner const &y) { return x.corner < y.corner; });
    _level.quadLineCorners = std::move(_found);
}

// Finds the tags that a step makes of tags of the parent's corners, by the paths of flags.
class QuadFinder {
public:
    QuadFinder(Refinement const &refinement, Level &level)
        : _refinement(refinement), _parent(*refinement.parent), _level(level) {}

    void Find();
    void FindLines();

private:
    // Flags of the child.
    QuadFlags append(QuadFlags flags, int outDigit, int inDigit) const {
        return AppendToQuadFlags(flags, _parent.numHexagonalSteps, outDigit, inDigit);
    }
    QuadLineFlags append(QuadLineFlags const &flags, int outDigit, int inDigit) const {
        return AppendToQuadLineFlags(flags, _parent.numHexagonalSteps, outDigit, inDigit);
    }

    bool readParent();
    template <typename TAGS>
    std::vector<Index> listFaces(TAGS const &ofParent) const;
    template <typename GETPARENT, typename FUNCTION>
    void forEachCorner(Index face, GETPARENT const &getParent, FUNCTION const &function) const;

    Refinement const &_refinement;
    Level const &_parent;
    Level &_level;
    Buffer<QuadFlags> _flags; // of the parent, by corner, before the first step
};

// The flags of a corner with the one of an edge for both.
QuadFlags getOut(QuadFlags flags) { return {flags.out, flags.out, flags.sharpness}; }
QuadFlags getIn(QuadFlags flags) { return {flags.in, flags.in, flags.sharpness}; }
QuadLineFlags getOut(QuadLineFlags const &flags) { return flags.GetOut(); }
QuadLineFlags getIn(QuadLineFlags const &flags) { return flags.GetIn(); }
// One flag of each of two corners at a vertex.
QuadFlags join(QuadFlags out, QuadFlags in) {
    return {out.out, in.in, std::max(out.sharpness, in.sharpness)};
}
QuadLineFlags join(QuadLineFlags const &out, QuadLineFlags const &in) {
    return {out.out, in.in, {out.outLines[0], out.outLines[1]}, {in.inLines[0], in.inLines[1]}};
}

void QuadFinder::Find() {
    if (!readParent()) {
        return;
    }
    auto const getParent = [this](Index corner) {
        return _flags.empty() ? _parent.quadCorners.GetFlags(corner) : _flags[std::size_t(corner)];
    };
    bool const areFew = _parent.numHexagonalSteps + 1 >= kNumStepsToConstantMasks;
    if (areFew) {
        for (Index face : listFaces(_parent.quadCorners)) {
            forEachCorner(face, getParent, [&](Index corner, QuadFlags flags) {
                if (flags.HasAny()) {
                    _level.quadCorners.push_back({corner, flags});
                }
            });
        }
        return;
    }
    Buffer<QuadFlags> made;
    made.Resize(std::size_t(_level.numCorners));
    ParallelFor(_level.numFaces, [&](Index face) {
        std::fill_n(made.data() + _level.faceFirstCorner[face], _level.GetFaceSize(face),
                    QuadFlags());
        forEachCorner(face, getParent, [&](Index corner, QuadFlags flags) {
            if (flags.HasAny()) {
                made[std::size_t(corner)] = flags;
            }
        });
    });
    _level.quadCorners.Assign(made);
}

void QuadFinder::FindLines() {
    auto const getParent = [this](Index corner) {
        auto const found = FindCornerTags(_parent.quadLineCorners, corner, corner + 1);
        return found.empty() ? QuadLineFlags{} : found[0].flags;
    };
    for (Index face : listFaces(_parent.quadLineCorners)) {
        forEachCorner(face, getParent, [&](Index corner, QuadLineFlags const &flags) {
            if (flags.HasAny()) {
                _level.quadLineCorners.push_back({corner, flags});
            }
        });
    }
}

// Returns whether there are any flags.
bool QuadFinder::readParent() {
    constexpr int kQuad = 4;
    if (_parent.numHexagonalSteps > 0) {
        return !_parent.quadCorners.empty();
    }
    std::vector<Index> const &sizes = _parent.faceSizes;
    if (std::find(sizes.begin(), sizes.end(), kQuad) == sizes.end()) {
        return false;
    }
    _flags.Resize(std::size_t(_parent.numCorners));
    Buffer<QuadFlags> ofVerts;
    ofVerts.Resize(std::size_t(_parent.numVertices));
    ParallelFor(_parent.numVertices,
                [&](Index vert) { ofVerts[std::size_t(vert)] = makeBaseFlags(_parent, vert); });
    ParallelFor(_parent.numCorners, [&](Index corner) {
        _flags[std::size_t(corner)] = ofVerts[std::size_t(_parent.faceVerts[corner])];
    });
    return std::any_of(ofVerts.begin(), ofVerts.end(),
                       [](QuadFlags flags) { return flags.HasAny(); });
}

// Lists the faces of the level that tags of the parent make which go on, ascending.
template <typename TAGS>
std::vector<Index> QuadFinder::listFaces(TAGS const &ofParent) const {
    std::vector<Index> faces;
    auto const addEFace = [&](Index edge) {
        if (Index const face = _refinement.GetEdgeChildFace(edge); face != Far::INDEX_INVALID) {
            faces.push_back(face);
        }
    };
    for (auto const &[corner, flags] : ofParent) {
        if (append(flags, 0, 0).HasAny()) {
            Index const face = _parent.FindFaceOfCorner(corner);
            faces.push_back(face);
            addEFace(_parent.faceEdges[corner]);
            addEFace(_parent.faceEdges[_parent.GetPrevCorner(face, corner)]);
        }
    }
    SortUnique(faces, _level.numFaces);
    return faces;
}

// Calls function(corner, flags) for the corners of a face, given those of the parent's corners.
template <typename GETPARENT, typename FUNCTION>
void QuadFinder::forEachCorner(Index face, GETPARENT const &getParent,
                               FUNCTION const &function) const {
    Index const first = _level.faceFirstCorner[face];
    int const size = _level.GetFaceSize(face);
    if (face < _level.numFFaces) {
        for (Index corner = first; corner < first + size; ++corner) {
            function(corner,
                     append(getParent(corner - first + _parent.faceFirstCorner[face]), 0, 0));
        }
        return;
    }
    bool const isHalf = _level.IsHalfFace(face);
    if (face >= _level.numFaces - _level.numVFaces ||
        (size != HexIndexing::kNumEFaceCorners && !isHalf)) {
        return;
    }
    Index const edge = _refinement.GetEFaceParent(face);
    decltype(getParent(first)) made[HexIndexing::kNumEFaceCorners];
    for (int side = 0; side < (isHalf ? 1 : 2); ++side) {
        EFaceSide const &places = isHalf      ? kBoundaryEFaceSide
                                  : side == 0 ? kEFaceSideA
                                              : kEFaceSideB;
        Index const start = _parent.GetSideCorner(edge, side);
        Index const end = _parent.GetNextCorner(_parent.edgeFaces[edge][side], start);
        auto const atStart = getOut(getParent(start));
        auto const atEnd = getIn(getParent(end));
        made[places.endFVertex] = append(atEnd, 1, 2);
        made[places.startFVertex] = append(atStart, 2, 1);
        if (isHalf) {
            made[places.startVertex] = append(atStart, 3, 3);
            made[places.startVertex].out = 0;
            made[places.endVertex] = append(atEnd, 3, 3);
            made[places.endVertex].in = 0;
            continue;
        }
        Index const otherStart = _parent.GetSideCorner(edge, 1 - side);
        Index const otherEnd = _parent.GetNextCorner(_parent.edgeFaces[edge][1 - side], otherStart);
        // At the start, from both sides.
        made[places.startVertex] = append(join(getIn(getParent(otherEnd)), atStart), 3, 3);
    }
    for (int local = 0; local < size; ++local) {
        function(first + local, made[local]);
    }
}

} // namespace

void FindBaseLineCorners(Level &level) { QuadLineFinder(level).Find(); }

void FindQuadCorners(FaceMask faceMask, Refinement const &refinement, Level &level) {
    level.quadCorners.clear();
    level.quadLineCorners.clear();
    if (faceMask == FaceMask::Smooth && level.numHexagonalSteps > 0 && level.hasFullTopology) {
        QuadFinder finder(refinement, level);
        finder.Find();
        finder.FindLines();
    }
}

} // namespace OpenSubdivHex::FarExt::internal
