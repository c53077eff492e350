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
        : _refinement(refinement), _parent(*refinement.parent), _level(level) {}

    void Find() {
        if (!readParent()) {
            return;
        }
        bool const areFew = _parent.numHexagonalSteps + 1 >= kNumStepsToConstantMasks;
        if (areFew) {
            for (Index face : listFaces()) {
                forEachCorner(face, [&](Index corner, QuadFlags flags) {
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
            forEachCorner(face, [&](Index corner, QuadFlags flags) {
                if (flags.HasAny()) {
                    made[std::size_t(corner)] = flags;
                }
            });
        });
        _level.quadCorners.Assign(made);
    }

private:
    bool readParent();
    std::vector<Index> listFaces() const;
    QuadFlags getParent(Index corner) const {
        return _flags.empty() ? _parent.quadCorners.GetFlags(corner) : _flags[std::size_t(corner)];
    }
    QuadFlags append(QuadFlags flags, int outDigit, int inDigit) const {
        return AppendToQuadFlags(flags, _parent.numHexagonalSteps, outDigit, inDigit);
    }
    template <typename FUNCTION>
    void forEachCorner(Index face, FUNCTION const &function) const;

    Refinement const &_refinement;
    Level const &_parent;
    Level &_level;
    Buffer<QuadFlags> _flags; // of the parent, by corner, before the first step
};

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

// Lists the faces of the level that flags of the parent make which go on, ascending.
std::vector<Index> QuadFinder::listFaces() const {
    std::vector<Index> faces;
    auto const addEFace = [&](Index edge) {
        if (Index const face = _refinement.GetEdgeChildFace(edge); face != Far::INDEX_INVALID) {
            faces.push_back(face);
        }
    };
    for (auto const &[corner, flags] : _parent.quadCorners) {
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
