// SPDX-License-Identifier: Apache-2.0
#include "lineFeatures.h"

#include <opensubdiv/sdc/crease.h>

#include <algorithm>
#include <tuple>

namespace OpenSubdivHex::FarExt::internal {

namespace {

using Far::Index;
using Sdc::Crease;

constexpr int kTrapezoid = HexIndexing::kNumBoundaryEFaceCorners;
constexpr int kEndOfHalf = 0; // both of them

// Whether across the edge that begins at a corner there is half a hexagon.
bool isBesideHalfHexagon(Level const &level, Index corner) {
    if (level.IsBoundary(level.faceEdges[corner])) {
        return false;
    }
    FaceCorner const across = level.GetCornerAcross(corner);
    int const size = level.GetFaceSize(across.face);
    if (level.IsHalfFace(across.face)) {
        return size == kTrapezoid;
    }
    int const local = across.corner - level.faceFirstCorner[across.face];
    return level.HasFaceHalves(across.face) &&
           GetHalfSize(level.GetHalfOfFaceEdge(across.face, local), size,
                       level.GetDiagonalEnd(across.face)) == kTrapezoid;
}

class LineRowFinder {
public:
    LineRowFinder(TagOptions options, Refinement const &refinement, Level &level)
        : _creasing(options.sdcOptions), _sdcOptions(options.sdcOptions), _refinement(refinement),
          _parent(*refinement.parent), _level(level) {}

    // Finds the tags of a level that a truncation made.
    void Begin();
    void GoOn();

private:
    void add(Index corner, LineFace face, int place, float sharpness) {
        if (sharpness > 0) {
            _level.lineRowCorners.push_back({corner, sharpness, face, std::uint16_t(place)});
        }
    }
    // All places of a hexagon, from a corner of it on.
    void addHexagon(Index face, int local, LineFace kind, float sharpness) {
        for (int place = 0; place < kHexagon; ++place) {
            add(getCorner(face, local + place), kind, place, sharpness);
        }
    }
    Index getCorner(Index face, int local) const {
        return _level.faceFirstCorner[face] + local % _level.GetFaceSize(face);
    }
    void addHalf(Index face, int half, float sharpness);
    void sort();

    float getLineSharpness(Index edge) const {
        return _level.IsBoundary(edge) ? Crease::SHARPNESS_INFINITE : _level.GetEdgeSharpness(edge);
    }
    float findSharpnessBeyond(Index edge, Index vert) const;
    void beginOnLine(Index edge);
    void beginHalves(Index face);
    float findSharpnessOfEnds(Index face, int start, int end) const;

    void goOnFrom(Index face, LineRowCorner const &tag);
    void goOnAtEnd(Index face, LineRowCorner const &tag, float sharpness);
    Index findHexagon(Index pCorner) const;
    EFaceSide const &getSide(Index pCorner) const {
        Index const edge = _parent.faceEdges[pCorner];
        return _parent.GetSideCorner(edge, 0) == pCorner ? kEFaceSideA : kEFaceSideB;
    }

    Crease const _creasing;
    Sdc::Options const _sdcOptions;
    Refinement const &_refinement;
    Level const &_parent;
    Level &_level;
};

void LineRowFinder::sort() {
    auto const order = [](LineRowCorner const &tag) {
        return std::make_tuple(tag.corner, tag.face, tag.place, tag.sharpness);
    };
    std::vector<LineRowCorner> &tags = _level.lineRowCorners;
    std::sort(tags.begin(), tags.end(), [order](LineRowCorner const &x, LineRowCorner const &y) {
        return order(x) < order(y);
    });
    tags.erase(std::unique(tags.begin(), tags.end(),
                           [order](LineRowCorner const &x, LineRowCorner const &y) {
                               return order(x) == order(y);
                           }),
               tags.end());
}

// Half a polygon: half a face that is crossed, or a half face, which is half 0 of itself.
void LineRowFinder::addHalf(Index face, int half, float sharpness) {
    bool const isHalfFace = _level.IsHalfFace(face);
    int const size = _level.GetFaceSize(face);
    int const end = _level.GetDiagonalEnd(face);
    auto const getPlace = [&](int i) { return isHalfFace ? i : GetPlaceInHalves(half, i, end); };
    for (int i = 0; i < 2; ++i) {
        add(getCorner(face, getPlace(i)), LineFace::Half, kEndOfHalf, sharpness);
    }
    if ((isHalfFace ? size : GetHalfSize(half, size, end)) == kTrapezoid) {
        for (int i = 2; i < kTrapezoid; ++i) {
            add(getCorner(face, getPlace(i)), LineFace::Half, i, sharpness);
        }
    }
}

// Returns the sharpness of the line beyond an end of an edge, across half a polygon; 0 where it ends.
float LineRowFinder::findSharpnessBeyond(Index edge, Index vert) const {
    for (Index k = _level.vertFirstFace[vert]; k < _level.vertFirstFace[vert + 1]; ++k) {
        Index const face = _level.vertFaces[k];
        int const local = _level.vertFaceLocals[k];
        if (_level.IsHalfFace(face) && _level.IsBoundary(edge) && local <= 1) {
            return Crease::SHARPNESS_INFINITE;
        }
        if (_level.FindCrossedFace(face) && !_level.IsBoundary(edge) &&
            (local == kDiagonalStart || local == _level.GetDiagonalEnd(face))) {
            return _level.GetDiagonalSharpness(face);
        }
    }
    return 0;
}

void LineRowFinder::beginOnLine(Index edge) {
    float sharpness = getLineSharpness(edge);
    for (Index vert : _level.edgeVerts[edge]) {
        sharpness = std::min(sharpness, findSharpnessBeyond(edge, vert));
    }
    for (int side = 0; side < (_level.IsBoundary(edge) ? 1 : 2) && sharpness > 0; ++side) {
        Index const face = _level.edgeFaces[edge][side];
        int const local = _level.edgeFaceLocals[edge][side];
        if (_level.GetFaceSize(face) != kHexagon) {
            add(getCorner(face, local), LineFace::OnOtherLine, 0, sharpness);
            add(getCorner(face, local + 1), LineFace::OnOtherLine, 1, sharpness);
            continue;
        }
        bool const isRegular = isBesideHalfHexagon(_level, getCorner(face, local + 1)) &&
                               isBesideHalfHexagon(_level, getCorner(face, local + kHexagon - 1));
        addHexagon(face, local, isRegular ? LineFace::OnLine : LineFace::OnOtherLine, sharpness);
        Index const far = getCorner(face, local + kHexagon / 2);
        if (!_level.IsBoundary(_level.faceEdges[far])) {
            FaceCorner const beyond = _level.GetCornerAcross(far);
            if (_level.GetFaceSize(beyond.face) == kHexagon) {
                add(beyond.corner, LineFace::Beyond, 0, sharpness);
                add(_level.GetNextCorner(beyond.face, beyond.corner), LineFace::Beyond, 1,
                    sharpness);
            }
        }
    }
}

// The least of the line's edges at both ends of what crosses a face or bounds half of one.
float LineRowFinder::findSharpnessOfEnds(Index face, int start, int end) const {
    float result =
        _level.IsHalfFace(face) ? Crease::SHARPNESS_INFINITE : _level.GetDiagonalSharpness(face);
    for (int local : {start, end}) {
        float sharpest = 0;
        for (Index edge : _level.GetVertexEdges(_level.faceVerts[getCorner(face, local)])) {
            if (!_level.IsSharpBoundaryB(edge)) {
                sharpest = std::max(sharpest, getLineSharpness(edge));
            }
        }
        result = std::min(result, sharpest);
    }
    return result;
}

void LineRowFinder::beginHalves(Index face) {
    bool const isHalfFace = _level.IsHalfFace(face);
    int const size = _level.GetFaceSize(face);
    int const end = isHalfFace ? 1 : _level.GetDiagonalEnd(face);
    float const sharpness = findSharpnessOfEnds(face, 0, end);
    if (!(sharpness > 0)) {
        return;
    }
    for (int half = 0; half < (isHalfFace ? 1 : 2); ++half) {
        addHalf(face, half, sharpness);
        if ((isHalfFace ? size : GetHalfSize(half, size, end)) != kTrapezoid) {
            continue;
        }
        Index const far = getCorner(face, isHalfFace ? 2 : GetPlaceInHalves(half, 2, end));
        if (_level.IsBoundary(_level.faceEdges[far])) {
            continue;
        }
        FaceCorner const behind = _level.GetCornerAcross(far);
        if (_level.GetFaceSize(behind.face) == kHexagon) {
            addHexagon(behind.face, behind.corner - _level.faceFirstCorner[behind.face],
                       LineFace::Behind, sharpness);
        }
    }
}

void LineRowFinder::Begin() {
    for (Index edge : _level.boundaryEdges) {
        if (_level.edgeFaces[edge][1] == kSharpBoundaryA) {
            beginOnLine(edge);
        }
    }
    for (std::size_t edge = 0; edge < _level.edgeSharpness.size(); ++edge) {
        if (Crease::IsSharp(_level.edgeSharpness[edge])) {
            beginOnLine(Index(edge));
        }
    }
    for (Index face : _level.halfFaces) {
        beginHalves(face);
    }
    for (CrossedFace const &crossed : _level.crossedFaces) {
        beginHalves(crossed.face);
    }
    sort();
}

// The hexagon that the edge which begins at a corner makes; INDEX_INVALID where it makes another face or none.
Index LineRowFinder::findHexagon(Index pCorner) const {
    Index const edge = _parent.faceEdges[pCorner];
    Index const eFace =
        _parent.IsBoundary(edge) ? Far::INDEX_INVALID : _refinement.GetEdgeChildFace(edge);
    bool const isHexagon = eFace != Far::INDEX_INVALID && _level.GetFaceSize(eFace) == kHexagon;
    return isHexagon ? eFace : Far::INDEX_INVALID;
}

void LineRowFinder::goOnFrom(Index face, LineRowCorner const &tag) {
    if (std::optional<LineRowCorner> ofFFace =
            FindLineRowOfFFace(tag, _parent.GetFaceSize(face), _sdcOptions)) {
        ofFFace->corner = getCorner(face, tag.corner - _parent.faceFirstCorner[face]);
        _level.lineRowCorners.push_back(*ofFFace);
    }
    float const sharpness = _creasing.SubdivideUniformSharpness(tag.sharpness);
    if (tag.face == LineFace::Half && tag.place == 2) {
        if (Index const eFace = findHexagon(tag.corner); eFace != Far::INDEX_INVALID) {
            addHexagon(eFace, getSide(tag.corner).fFaceEdge, LineFace::Behind, sharpness);
        }
    }
    if ((tag.face != LineFace::OnLine && tag.face != LineFace::OnOtherLine) || tag.place > 1) {
        return;
    }
    if (tag.place == 0) {
        Index const edge = _parent.faceEdges[tag.corner];
        int const half = _parent.GetSideCorner(edge, 0) == tag.corner ? 0 : 1;
        addHalf(_refinement.GetEdgeChildFace(edge), half, sharpness);
    }
    goOnAtEnd(face, tag, sharpness);
}

// At an end V of the A edge of a face, V's child and the F-vertex in the half polygon beside it begin and end another A
// edge, of the E-face between the two faces.
void LineRowFinder::goOnAtEnd(Index face, LineRowCorner const &tag, float sharpness) {
    bool const isStart = tag.place == 0;
    Index const between = isStart ? _parent.GetPrevCorner(face, tag.corner) : tag.corner;
    Index const eFace = findHexagon(between);
    if (eFace == Far::INDEX_INVALID) {
        return;
    }
    FaceCorner const across = _parent.GetCornerAcross(between);
    EFaceSide const &side = getSide(across.corner);
    Index const end = isStart ? across.corner : _parent.GetNextCorner(across.face, across.corner);
    for (LineRowCorner const &beside : FindCornerTags(_parent.lineRowCorners, end, end + 1)) {
        if (beside.face != LineFace::Half) {
            continue;
        }
        float const least =
            std::min(sharpness, _creasing.SubdivideUniformSharpness(beside.sharpness));
        addHexagon(eFace, isStart ? side.startFVertex : side.endVertex,
                   isBesideHalfHexagon(_parent, between) ? LineFace::OnLine : LineFace::OnOtherLine,
                   least);
        // The next edge of the face makes the one beyond.
        Index const next =
            isStart ? _parent.GetPrevCorner(face, between) : _parent.GetNextCorner(face, between);
        if (Index const beyond = findHexagon(next); beyond != Far::INDEX_INVALID) {
            EFaceSide const &own = getSide(next);
            add(getCorner(beyond, isStart ? own.endVertex : own.startFVertex), LineFace::Beyond, 0,
                least);
            add(getCorner(beyond, isStart ? own.endFVertex : own.startVertex), LineFace::Beyond, 1,
                least);
        }
    }
}

void LineRowFinder::GoOn() {
    for (LineRowCorner const &tag : _parent.lineRowCorners) {
        goOnFrom(_parent.FindFaceOfCorner(tag.corner), tag);
    }
    sort();
}

} // namespace

std::optional<LineRowCorner> FindLineRowOfFFace(LineRowCorner const &parent, int faceSize,
                                                Sdc::Options sdcOptions) {
    LineRowCorner result = parent;
    result.sharpness = Crease(sdcOptions).SubdivideUniformSharpness(parent.sharpness);
    bool const isOnLine = parent.face == LineFace::OnLine || parent.face == LineFace::OnOtherLine;
    if (isOnLine) {
        result.face = LineFace::Behind;
    }
    bool const isTagged = parent.face == LineFace::Half || (isOnLine && faceSize == kHexagon);
    return isTagged && result.sharpness > 0 ? std::optional(result) : std::nullopt;
}

void FindLineRowCorners(TagOptions options, Refinement const &refinement, Level &level) {
    level.lineRowCorners.clear();
    if (options.faceMask != FaceMask::Smooth || !level.hasFullTopology ||
        level.numHexagonalSteps >= kNumLineSteps) {
        return;
    }
    LineRowFinder finder(options, refinement, level);
    if (refinement.isTruncation) {
        finder.Begin();
    } else {
        finder.GoOn();
    }
}

} // namespace OpenSubdivHex::FarExt::internal
