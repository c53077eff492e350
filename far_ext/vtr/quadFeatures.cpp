// SPDX-License-Identifier: Apache-2.0
#include "quadFeatures.h"

#include "indexSet.h"
#include "parallel.h"

#include <opensubdiv/sdc/crease.h>

#include <algorithm>
#include <cstddef>
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

// The first row of quads beside smooth sharp lines, before the first step.
class LineQuadFinder {
public:
    explicit LineQuadFinder(Level const &level) : _level(level) {}

    // Adds the corners of a quad if it is beside the line that its edge from corner \p start on lies in: the vertices
    // of that edge are regular on the line, the other two smooth, with four quads.
    void Add(Index start, std::vector<QuadCorner> &result) const {
        Index const face = _level.FindFaceOfCorner(start);
        if (_level.GetFaceSize(face) != kQuad) {
            return;
        }
        Index corners[kQuad] = {start};
        for (int i = 1; i < kQuad; ++i) {
            corners[i] = _level.GetNextCorner(face, corners[i - 1]);
        }
        auto const getVert = [&](int i) { return _level.faceVerts[corners[i]]; };
        if (!isOnLine(getVert(0)) || !isOnLine(getVert(1)) || !isAbove(getVert(2)) ||
            !isAbove(getVert(3))) {
            return;
        }
        float const sharpness = getSharpness(_level.faceEdges[start]);
        constexpr LineFlag kOut[kQuad] = {LineFlag::Along, LineFlag::Up, LineFlag::Top,
                                          LineFlag::Down};
        for (int i = 0; i < kQuad; ++i) {
            LineFlag const in = kOut[(i % 2 == 0 ? 1 : 0) + (i < 2 ? 0 : 2)];
            result.push_back(
                {corners[i], {MakeLineQuadFlag(kOut[i]), MakeLineQuadFlag(in), sharpness}});
        }
    }

private:
    static constexpr int kQuad = 4;

    float getSharpness(Index edge) const {
        return _level.IsBoundary(edge) ? Crease::SHARPNESS_INFINITE : _level.GetEdgeSharpness(edge);
    }
    bool isAbove(Index vert) const {
        QuadFlags const flags = makeBaseFlags(_level, vert);
        return flags.out == MakeQuadFlag(kQuad) && flags.sharpness == 0;
    }
    bool isOnLine(Index vert) const;

    Level const &_level;
};

// Whether the vertex has two quads on each side of one line, which is as sharp before it as behind it.
bool LineQuadFinder::isOnLine(Index vert) const {
    Far::ConstIndexArray const faces = _level.GetVertexFaces(vert);
    Far::ConstIndexArray const edges = _level.GetVertexEdges(vert);
    bool const isBorder = faces.size() == 2 && edges.size() == 3;
    bool const isInside = faces.size() == 4 && edges.size() == 4;
    if ((!isBorder && !isInside) || _level.IsNonManifold(vert) ||
        Crease::IsSharp(_level.GetVertexSharpness(vert))) {
        return false;
    }
    for (Index face : faces) {
        if (_level.GetFaceSize(face) != kQuad || _level.IsHalfFace(face)) {
            return false;
        }
    }
    // From edge to edge around the vertex.
    int const last = edges.size() - 1;
    auto const isSharp = [&](int i) { return Crease::IsSharp(getSharpness(edges[i])); };
    for (Index edge : edges) {
        if (_level.IsBoundary(edge) && _level.edgeFaces[edge][1] == kFreeBoundary) {
            return false;
        }
    }
    int const first = isSharp(0) ? 0 : 1;
    return (isBorder ? first == 0 && !isSharp(1) && isSharp(last)
                     : isSharp(first) && isSharp(first + 2) && !isSharp(1 - first) &&
                           !isSharp(3 - first)) &&
           getSharpness(edges[first]) == getSharpness(edges[first + 2]);
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
    // The corners where a side of an edge starts and ends.
    std::pair<Index, Index> getEnds(Index edge, int side) const {
        Index const start = _parent.GetSideCorner(edge, side);
        return {start, _parent.GetNextCorner(_parent.edgeFaces[edge][side], start)};
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
    for (QuadCorner const &quad : _parent.quadCorners) {
        _flags[std::size_t(quad.corner)] = quad.flags;
    }
    return !_parent.quadCorners.empty() ||
           std::any_of(ofVerts.begin(), ofVerts.end(),
                       [](QuadFlags flags) { return flags.HasAny(); });
}

// Those of the level that flags of the parent make which go on, ascending.
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
    if (face >= _level.numFaces - _level.numVFaces) {
        return;
    }
    bool const isHalf = _level.IsHalfFace(face);
    if (!isHalf && size != HexIndexing::kNumEFaceCorners) {
        return;
    }
    Index const edge = _refinement.GetEFaceParent(face);
    QuadFlags made[HexIndexing::kNumEFaceCorners];
    for (int side = 0; side < (isHalf ? 1 : 2); ++side) {
        EFaceSide const &places = isHalf      ? kBoundaryEFaceSide
                                  : side == 0 ? kEFaceSideA
                                              : kEFaceSideB;
        auto const [start, end] = getEnds(edge, side);
        SharpQuadFlag const atStart = getParent(start).GetOut();
        SharpQuadFlag const atEnd = getParent(end).GetIn();
        made[places.endFVertex] = append(JoinQuadFlags(atEnd, atEnd), 1, 2);
        made[places.startFVertex] = append(JoinQuadFlags(atStart, atStart), 2, 1);
        if (isHalf) {
            // As if the same was beyond a crease.
            made[places.startVertex] = append(JoinQuadFlags(atStart, atStart), 3, 3);
            made[places.endVertex] = append(JoinQuadFlags(atEnd, atEnd), 3, 3);
        } else {
            SharpQuadFlag const beyond = getParent(getEnds(edge, 1 - side).second).GetIn();
            made[places.startVertex] = append(JoinQuadFlags(beyond, atStart), 3, 3);
        }
    }
    for (int local = 0; local < size; ++local) {
        function(first + local, made[local]);
    }
}

} // namespace

void FindLineQuads(Level &level) {
    std::vector<QuadCorner> quads;
    LineQuadFinder const finder(level);
    for (Index edge : level.boundaryEdges) {
        finder.Add(level.GetSideCorner(edge, 0), quads);
    }
    for (std::size_t edge = 0; edge < level.edgeSharpness.size(); ++edge) {
        if (Crease::IsSharp(level.edgeSharpness[edge]) && !level.IsBoundary(Index(edge))) {
            for (int side : {0, 1}) {
                finder.Add(level.GetSideCorner(Index(edge), side), quads);
            }
        }
    }
    std::sort(quads.begin(), quads.end(),
              [](QuadCorner const &x, QuadCorner const &y) { return x.corner < y.corner; });
    level.quadCorners.clear();
    for (QuadCorner const &quad : quads) {
        level.quadCorners.push_back(quad);
    }
}

void FindQuadCorners(FaceMask faceMask, Refinement const &refinement, Level &level) {
    level.quadCorners.clear();
    if (faceMask != FaceMask::Smooth || !level.hasFullTopology) {
        return;
    }
    if (level.numHexagonalSteps > 0) {
        QuadFinder(refinement, level).Find();
    } else if (refinement.isTruncation) {
        FindLineQuads(level);
    }
}

} // namespace OpenSubdivHex::FarExt::internal
