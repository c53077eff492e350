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
                forEachCorner(face, [&](Index corner, QuadFlags flags) {
                    if (flags.HasAny()) {
                        function(QuadCorner{corner, flags});
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
    QuadFlags getParent(Index corner) const {
        if (!_isSparse) {
            return _flags[std::size_t(corner)];
        }
        auto const found = FindCornerTags(_parent.quadCorners, corner, corner + 1);
        return found.empty() ? QuadFlags() : found[0].flags;
    }
    QuadFlags append(QuadFlags flags, int outDigit, int inDigit) const {
        return AppendToQuadFlags(flags, _parent.numHexagonalSteps, outDigit, inDigit);
    }
    template <typename FUNCTION>
    void forEachCorner(Index face, FUNCTION const &function) const;

    Refinement const &_refinement;
    Level const &_parent;
    Level &_level;
    bool const _isSparse;      // few of the parent's corners matter
    Buffer<QuadFlags> _flags;  // else of the parent, by corner
    std::vector<Index> _faces; // if so, those of the level that may have flags, ascending
};

// Returns whether there are any flags.
bool QuadFinder::readParent() {
    constexpr int kQuad = 4;
    bool const isBase = _parent.numHexagonalSteps == 0;
    std::vector<Index> const &sizes = _parent.faceSizes;
    if (isBase ? std::find(sizes.begin(), sizes.end(), kQuad) == sizes.end()
               : _parent.quadCorners.empty()) {
        return false;
    }
    _flags.Resize(std::size_t(_parent.numCorners));
    if (!isBase) {
        std::fill_n(_flags.data(), _flags.size(), QuadFlags());
        for (QuadCorner const &quad : _parent.quadCorners) {
            _flags[std::size_t(quad.corner)] = quad.flags;
        }
        return true;
    }
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

// Those that flags of the parent make which go on.
void QuadFinder::listFaces() {
    auto const addEFace = [this](Index edge) {
        if (Index const face = _refinement.GetEdgeChildFace(edge); face != Far::INDEX_INVALID) {
            _faces.push_back(face);
        }
    };
    for (auto const &[corner, flags] : _parent.quadCorners) {
        if (append(flags, 0, 0).HasAny()) {
            Index const face = _parent.FindFaceOfCorner(corner);
            _faces.push_back(face);
            addEFace(_parent.faceEdges[corner]);
            addEFace(_parent.faceEdges[_parent.GetPrevCorner(face, corner)]);
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
            function(corner,
                     append(getParent(corner - first + _parent.faceFirstCorner[face]), 0, 0));
        }
        return;
    }
    if (face >= _level.numFaces - _level.numVFaces || size != HexIndexing::kNumEFaceCorners) {
        return;
    }
    Index const edge = _refinement.GetEFaceParent(face);
    QuadFlags made[HexIndexing::kNumEFaceCorners];
    for (int side = 0; side < 2; ++side) {
        EFaceSide const &places = side == 0 ? kEFaceSideA : kEFaceSideB;
        Index const start = _parent.GetSideCorner(edge, side);
        Index const end = _parent.GetNextCorner(_parent.edgeFaces[edge][side], start);
        Index const otherStart = _parent.GetSideCorner(edge, 1 - side);
        Index const otherEnd = _parent.GetNextCorner(_parent.edgeFaces[edge][1 - side], otherStart);
        QuadFlags const atStart = getParent(start);
        QuadFlags const atEnd = getParent(end);
        QuadFlags const beyond = getParent(otherEnd); // at the start, on the other side
        float const sharpness = std::max(atStart.sharpness, beyond.sharpness);
        made[places.startVertex] = append({beyond.in, atStart.out, sharpness}, 3, 3);
        made[places.endFVertex] = append({atEnd.in, atEnd.in, atEnd.sharpness}, 1, 2);
        made[places.startFVertex] = append({atStart.out, atStart.out, atStart.sharpness}, 2, 1);
    }
    for (int local = 0; local < HexIndexing::kNumEFaceCorners; ++local) {
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
