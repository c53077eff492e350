// SPDX-License-Identifier: Apache-2.0
#include "quadFeatures.h"

#include "indexSet.h"
#include "parallel.h"

#include <opensubdiv/sdc/crease.h>

#include <algorithm>
#include <cstddef>
#include <vector>

namespace OpenSubdivHex::FarExt::internal {

namespace {

using Far::Index;
using Sdc::Crease;

constexpr int kHexagon = HexIndexing::kNumEFaceCorners;
constexpr int kQuad = 4;

// The flags of the edges that begin and end at a corner.
struct Flags {
    QuadFlag out = 0;
    QuadFlag in = 0;
    float sharpness = 0;
};

Flags makeBaseFlags(Level const &level, Index vert) {
    Far::ConstIndexArray const faces = level.GetVertexFaces(vert);
    if (faces.size() == 0 || level.IsNonManifold(vert) ||
        !std::all_of(faces.begin(), faces.end(), [&](Index face) {
            return level.GetFaceSize(face) == kQuad && !level.IsHalfFace(face);
        })) {
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
    int const numFaces = faces.size();
    QuadFlag const flag = MakeQuadFlag(numFaces == 4   ? QuadVertex::Four
                                       : numFaces == 3 ? QuadVertex::Three
                                       : numFaces == 5 ? QuadVertex::Five
                                       : numFaces == 6 ? QuadVertex::Six
                                                       : QuadVertex::Other);
    return {flag, flag, sharpness};
}

class QuadFinder {
public:
    QuadFinder(Refinement const &refinement, Level &level)
        : _refinement(refinement), _parent(*refinement.parent), _level(level),
          _isSparse(_parent.numHexagonalSteps + 1 >= kNumStepsToConstantMasks) {}

    void Find() {
        if (_isSparse) {
            listFaces();
        } else if (!readParent()) {
            return;
        }
        Index const count = _isSparse ? Index(_faces.size()) : _level.numFaces;
        auto const forEach = [this](Index begin, Index end, auto const &function) {
            for (Index i = begin; i < end; ++i) {
                Index const face = _isSparse ? _faces[std::size_t(i)] : i;
                forEachCorner(face, [&](Index corner, Flags flags) {
                    if (flags.out != 0 || flags.in != 0) {
                        function(QuadCorner{corner, flags.out, flags.in, flags.sharpness});
                    }
                });
            }
        };
        std::vector<std::size_t> const firsts =
            ParallelSums<std::size_t>(count, [&](Index begin, Index end) {
                std::size_t size = 0;
                forEach(begin, end, [&size](QuadCorner const &) { ++size; });
                return size;
            });
        _level.quadCorners.resize(firsts.back());
        ParallelForRange(count, [&](Index begin, Index end) {
            QuadCorner *next =
                _level.quadCorners.data() + firsts[std::size_t(begin / kParallelRange)];
            forEach(begin, end, [&next](QuadCorner const &corner) { *next++ = corner; });
        });
    }

private:
    bool readParent();
    void listFaces();
    Flags getParent(Index corner) const {
        if (!_isSparse) {
            return _flags[std::size_t(corner)];
        }
        QuadCorner const *const found = _parent.FindQuadCorner(corner);
        return found ? Flags{found->out, found->in, found->sharpness} : Flags();
    }
    static float fade(Flags flags) { return std::max(0.0f, flags.sharpness - 1); }
    QuadFlag append(QuadFlag flag, int digit) const {
        return AppendToQuadFlag(flag, _parent.numHexagonalSteps, digit);
    }
    template <typename FUNCTION>
    void forEachCorner(Index face, FUNCTION const &function) const;

    Refinement const &_refinement;
    Level const &_parent;
    Level &_level;
    bool const _isSparse;      // few of the parent's corners matter
    Buffer<Flags> _flags;      // else of the parent, by corner
    std::vector<Index> _faces; // if so, those of the level that may have flags, ascending
};

// Returns whether there are any flags.
bool QuadFinder::readParent() {
    bool const isBase = _parent.numHexagonalSteps == 0;
    std::vector<Index> const &sizes = _parent.faceSizes;
    if (isBase ? std::find(sizes.begin(), sizes.end(), kQuad) == sizes.end()
               : _parent.quadCorners.empty()) {
        return false;
    }
    _flags.Resize(std::size_t(_parent.numCorners));
    if (!isBase) {
        std::fill_n(_flags.data(), _flags.size(), Flags());
        for (QuadCorner const &corner : _parent.quadCorners) {
            _flags[std::size_t(corner.corner)] = {corner.out, corner.in, corner.sharpness};
        }
        return true;
    }
    Buffer<Flags> ofVerts;
    ofVerts.Resize(std::size_t(_parent.numVertices));
    ParallelFor(_parent.numVertices,
                [&](Index vert) { ofVerts[std::size_t(vert)] = makeBaseFlags(_parent, vert); });
    ParallelFor(_parent.numCorners, [&](Index corner) {
        _flags[std::size_t(corner)] = ofVerts[std::size_t(_parent.faceVerts[corner])];
    });
    return std::any_of(ofVerts.begin(), ofVerts.end(), [](Flags flags) { return flags.out != 0; });
}

// Those that flags of the parent make which go on.
void QuadFinder::listFaces() {
    auto const goesOn = [this](QuadFlag flag) { return append(flag, 0) != 0; };
    auto const addEFace = [this](Index edge) {
        if (Index const face = _refinement.GetEdgeChildFace(edge); face != Far::INDEX_INVALID) {
            _faces.push_back(face);
        }
    };
    for (QuadCorner const &corner : _parent.quadCorners) {
        if (goesOn(corner.out) || goesOn(corner.in)) {
            Index const face = _parent.FindFaceOfCorner(corner.corner);
            _faces.push_back(face);
            addEFace(_parent.faceEdges[corner.corner]);
            addEFace(_parent.faceEdges[_parent.GetPrevCorner(face, corner.corner)]);
        }
    }
    SortUnique(_faces, _level.numFaces);
}

// Calls function(corner, flags) for the corners of a face.
template <typename FUNCTION>
void QuadFinder::forEachCorner(Index face, FUNCTION const &function) const {
    Index const first = _level.faceFirstCorner[face];
    int const size = _level.GetFaceSize(face);
    if (face < _level.numFFaces) {
        for (Index corner = first; corner < first + size; ++corner) {
            Flags const flags = getParent(corner - first + _parent.faceFirstCorner[face]);
            function(corner, Flags{append(flags.out, 0), append(flags.in, 0), fade(flags)});
        }
        return;
    }
    if (face >= _level.numFaces - _level.numVFaces || size != kHexagon) {
        return;
    }
    Index const edge = _refinement.GetEFaceParent(face);
    Flags made[kHexagon];
    for (int side = 0; side < 2; ++side) {
        EFaceSide const &places = side == 0 ? kEFaceSideA : kEFaceSideB;
        Index const start = _parent.GetSideCorner(edge, side);
        Index const end = _parent.GetNextCorner(_parent.edgeFaces[edge][side], start);
        Index const otherStart = _parent.GetSideCorner(edge, 1 - side);
        Index const otherEnd = _parent.GetNextCorner(_parent.edgeFaces[edge][1 - side], otherStart);
        Flags const ofStart = getParent(start);
        Flags const ofEnd = getParent(end);
        QuadFlag const beyond = getParent(otherEnd).in; // of the other side, at the start
        made[places.startVertex] = {append(beyond, 3), append(ofStart.out, 3), fade(ofStart)};
        made[places.endFVertex] = {append(ofEnd.in, 1), append(ofEnd.in, 2), fade(ofEnd)};
        made[places.startFVertex] = {append(ofStart.out, 2), append(ofStart.out, 1), fade(ofStart)};
    }
    for (int local = 0; local < kHexagon; ++local) {
        function(first + local, made[local]);
    }
}

} // namespace

void FindQuadCorners(FaceMask faceMask, Refinement const &refinement, Level &level) {
    level.quadCorners.clear();
    if (faceMask == FaceMask::Smooth && level.numHexagonalSteps > 0 && level.hasFullTopology) {
        QuadFinder(refinement, level).Find();
    }
}

} // namespace OpenSubdivHex::FarExt::internal
