// SPDX-License-Identifier: Apache-2.0
#include "sharpFeatures.h"

#include "far_ext/rules/mask.h"
#include "far_ext/rules/sharpMask.h"
#include "indexSet.h"
#include "parallel.h"
#include "truncationMask.h"
#include "vertexFan.h"

#include <algorithm>
#include <tuple>

namespace OpenSubdivHex::FarExt::internal {

namespace {

using Far::Index;
using Sdc::Crease;

bool isSharp(FanItem const &item) { return Crease::IsSharp(item.sharpness); }

// The sharp edges that meet in a vertex: boundaries, crease edges and crease diagonals.
struct SharpEdges {
    std::vector<Index> neighbors;
    std::vector<bool> isLong; // a diagonal or a B boundary
    std::vector<float> sharpness;

    int GetSize() const { return int(neighbors.size()); }
    void Clear() {
        neighbors.clear();
        isLong.clear();
        sharpness.clear();
    }
};

bool isNonManifold(Level const &level, Index vert) {
    return std::binary_search(level.nonManifoldVerts.begin(), level.nonManifoldVerts.end(), vert);
}

// At a non-manifold vertex several fans may end in the same line, which counts once.  Uses the memory
// of the fan.
void gatherSharpEdges(Level const &level, Index vert, FanItems &fanItems, SharpEdges &result) {
    result.Clear();
    bool const hasLines = isNonManifold(level, vert);
    std::vector<Index> lines;
    auto const isRepeated = [&](Index edge) {
        Index const line = hasLines ? level.GetEdgeLine(edge) : Far::INDEX_INVALID;
        if (line == Far::INDEX_INVALID) {
            return false;
        }
        bool const isKnown = std::find(lines.begin(), lines.end(), line) != lines.end();
        lines.push_back(line);
        return isKnown;
    };
    ForEachFan(level, vert, [&](VertexFan const &fan) {
        GatherFanItems(level, fan, fanItems);
        auto begin = fanItems.items.begin();
        auto end = fanItems.items.end();
        if (!fan.isClosed) {
            Index const lastCorner = level.GetVertexCorner(fan.end - 1);
            begin += isRepeated(level.faceEdges[level.GetVertexCorner(fan.begin)]);
            end -= isRepeated(
                level.faceEdges[level.GetPrevCorner(level.vertFaces[fan.end - 1], lastCorner)]);
        }
        for (auto item = begin; item != end; ++item) {
            if (isSharp(*item)) {
                result.neighbors.push_back(item->neighbor);
                result.isLong.push_back(item->isLong);
                result.sharpness.push_back(item->sharpness);
            }
        }
    });
}

// The vertices that may need a rule of their own, ascending.
std::vector<Index> findSharpVertices(Level const &level) {
    std::vector<Index> verts = level.nonManifoldVerts;
    auto addEdge = [&](std::size_t edge) {
        verts.insert(verts.end(), level.edgeVerts[edge].begin(), level.edgeVerts[edge].end());
    };
    for (Index edge : level.boundaryEdges) {
        if (level.edgeFaces[edge][1] != kFreeBoundary) {
            addEdge(edge);
        }
    }
    for (std::size_t edge = 0; edge < level.edgeSharpness.size(); ++edge) {
        if (Crease::IsSharp(level.edgeSharpness[edge])) {
            addEdge(edge);
        }
    }
    for (std::size_t face = 0; face < level.diagonalSharpness.size(); ++face) {
        if (Crease::IsSharp(level.diagonalSharpness[face])) {
            verts.push_back(level.faceVerts[level.faceFirstCorner[face] + kDiagonalStart]);
            verts.push_back(
                level.faceVerts[level.faceFirstCorner[face] + level.GetDiagonalEnd(Index(face))]);
        }
    }
    for (std::size_t vert = 0; vert < level.vertSharpness.size(); ++vert) {
        if (Crease::IsSharp(level.vertSharpness[vert])) {
            verts.push_back(Index(vert));
        }
    }
    SortUnique(verts);
    return verts;
}

SharpVertex smoothMask(Index vert, int numFaces) {
    VertexVertexMask const mask = ComputeVertexVertexMask(Interpolation::Vertex, numFaces);
    return {vert, Crease::RULE_SMOOTH, mask.vertexWeight, mask.faceWeight, {vert, vert}, {0, 0}, 1,
            0};
}

SharpVertex cornerMask(Index vert) {
    return {vert, Crease::RULE_CORNER, 1, 0, {vert, vert}, {0, 0}, 0, 0};
}

// Whether one face lies alone between the edges to two vertices.
bool isOneFaceBetween(Level const &level, Index vert, Index const neighbors[2]) {
    for (Index i = level.vertFirstFace[vert]; i < level.vertFirstFace[vert + 1]; ++i) {
        Index const face = level.vertFaces[i];
        Index const corner = level.GetVertexCorner(i);
        Index const next = level.faceVerts[level.GetNextCorner(face, corner)];
        Index const prev = level.faceVerts[level.GetPrevCorner(face, corner)];
        if ((next == neighbors[0] && prev == neighbors[1]) ||
            (next == neighbors[1] && prev == neighbors[0])) {
            return true;
        }
    }
    return false;
}

SharpVertex creaseMask(Level const &level, FaceMask faceMask, Index vert, SharpEdges const &edges,
                       int const pair[2]) {
    Index const neighbors[2] = {edges.neighbors[pair[0]], edges.neighbors[pair[1]]};
    CreaseLevel ofLevel = CreaseLevel::Plain;
    if (!isNonManifold(level, vert)) {
        bool const isBounded =
            level.numHexagonalSteps >= kNumStepsToConstantMasks &&
            (faceMask == FaceMask::Smooth || !isOneFaceBetween(level, vert, neighbors));
        bool const isFirst = faceMask == FaceMask::Smooth && level.hasFirstLineMasks &&
                             level.numHexagonalSteps < kNumLineSteps;
        ofLevel = isBounded ? CreaseLevel::Bounded : isFirst ? CreaseLevel::First : ofLevel;
    }
    auto const [left, right] =
        ComputeCreaseMask(edges.isLong[pair[0]], edges.isLong[pair[1]], ofLevel);
    return {vert,
            Crease::RULE_CREASE,
            1 - left - right,
            0,
            {neighbors[0], neighbors[1]},
            {left, right},
            0,
            1};
}

SharpVertex maskOfRule(Level const &level, FaceMask faceMask, Crease const &creasing,
                       Crease::Rule rule, Index vert, SharpEdges const &edges,
                       std::vector<float> const &sharpness) {
    if (rule == Crease::RULE_CORNER) {
        return cornerMask(vert);
    }
    if (rule == Crease::RULE_CREASE) {
        int pair[2] = {0, 1};
        creasing.GetSharpEdgePairOfCrease(sharpness.data(), int(sharpness.size()), pair);
        return creaseMask(level, faceMask, vert, edges, pair);
    }
    SharpVertex mask = smoothMask(vert, level.GetNumVertexFaces(vert));
    mask.rule = rule;
    return mask;
}

SharpVertex blend(SharpVertex const &parent, SharpVertex const &child, double parentWeight) {
    // At most one of two rules in sequence is a crease, so that its neighbours stand alone; a
    // corner and a smooth mask have neighbours of weight 0.
    SharpVertex result = parent.rule == Crease::RULE_CREASE ? parent : child;
    double const childWeight = 1 - parentWeight;
    result.rule = parent.rule;
    result.vertexWeight = parentWeight * parent.vertexWeight + childWeight * child.vertexWeight;
    result.faceWeight = parentWeight * parent.faceWeight + childWeight * child.faceWeight;
    for (int i = 0; i < 2; ++i) {
        result.neighborWeights[i] =
            parentWeight * parent.neighborWeights[i] + childWeight * child.neighborWeights[i];
    }
    result.smoothShare = parentWeight * parent.smoothShare + childWeight * child.smoothShare;
    result.creaseShare = parentWeight * parent.creaseShare + childWeight * child.creaseShare;
    return result;
}

// Thresholds of sharpness, from lower up to upper, between which the same edges are sharp.
struct SharpnessLayer {
    float lower;
    float upper;

    bool IsSharp(float sharpness) const { return sharpness >= upper; }
};

// Adds the corners with masks of their own of a face, or half of one, in a sector of one face.
void addOneFaceCorners(Level const &level, FanItem const &item, float weight,
                       std::vector<SectorCorner> &result) {
    constexpr int kHalfFace[4] = {0, 1, 2, 3};
    auto const add = [&](Index corner, SectorCorner::Kind kind) {
        result.push_back({corner, 1, weight, kind});
    };
    if (!item.isHalf) {
        add(item.corner, SectorCorner::kAtOne);
        add(level.GetNextCorner(item.face, item.corner), SectorCorner::kBehindOne);
        add(level.GetPrevCorner(item.face, item.corner), SectorCorner::kBeforeOne);
        return;
    }
    Index const first = level.faceFirstCorner[item.face];
    auto const &places = item.half < 0 ? kHalfFace : kHexagonHalves[item.half];
    bool const isStart = item.corner == first + places[0];
    add(first + places[isStart ? 3 : 2], SectorCorner::kBesideOne);
    add(first + places[isStart ? 2 : 3], SectorCorner::kFarFromOne);
}

// Adds the corners of wide sectors between two edges of a fan that are sharp in the layer; and those of
// sectors of one face, where these have a share.
void addSectorCorners(Level const &level, SharpnessLayer layer, float oneFaceShare,
                      FanItems const &fan, std::vector<SectorCorner> &result) {
    std::size_t const numItems = fan.items.size();
    auto const at = [&](std::size_t i) -> FanItem const & {
        return fan.items[i < numItems ? i : i - numItems];
    };
    auto const findSharp = [&](std::size_t begin, std::size_t end) {
        while (begin < end && !layer.IsSharp(at(begin).sharpness)) {
            ++begin;
        }
        return begin;
    };
    std::size_t start = findSharp(0, numItems);
    std::size_t behind = numItems;
    if (fan.isClosed && start < numItems) {
        // One edge bounds no sector, even if other fans have sharp edges, too.
        if (findSharp(start + 1, numItems) == numItems) {
            return;
        }
        behind = start + numItems + 1; // all around, from a sharp edge back to it
    }
    while (start < behind) {
        std::size_t const end = findSharp(start + 1, behind);
        if (end == behind) {
            return;
        }
        float size = 0;
        for (std::size_t i = start; i < end; ++i) {
            if (at(i).isFace) {
                size += at(i).isHalf ? 0.5f : 1.0f;
            }
        }
        Index lastCorner = Far::INDEX_INVALID;
        for (std::size_t i = start; i < end && size >= kMinShrunkSector; ++i) {
            FanItem const &item = at(i);
            // The halves beside a diagonal that is less sharp are one corner.
            if (!item.isFace || item.corner == lastCorner || level.IsHalfFace(item.face)) {
                continue;
            }
            lastCorner = item.corner;
            float const lower = std::max(layer.lower, level.GetDiagonalSharpness(item.face));
            if (lower < layer.upper) {
                result.push_back({item.corner, size, layer.upper - lower, SectorCorner::kInWide});
            }
        }
        for (std::size_t i = start; i < end && size == 1 && oneFaceShare > 0; ++i) {
            if (at(i).isFace) {
                addOneFaceCorners(level, at(i), oneFaceShare, result);
            }
        }
        start = end;
    }
}

// The masks of one sharp vertex after the other.
class SharpMaskFinder {
public:
    SharpMaskFinder(Level const &level, TagOptions options)
        : _level(level), _faceMask(options.faceMask), _creasing(options.sdcOptions),
          _hasOneFaceMasks(_faceMask == FaceMask::Smooth && level.numHexagonalSteps > 0) {}

    // The features of a vertex that may need a rule of its own.
    SharpVertex Find(Index vert);
    // Adds the corners of wide sectors, and of those of one face, at the vertex that was found last.
    void AddSectorCorners(Index vert, std::vector<SectorCorner> &result);

private:
    float findOneFaceShare(Index vert, SharpnessLayer layer) const;

    Level const &_level;
    FaceMask const _faceMask;
    Crease const _creasing;
    bool const _hasOneFaceMasks;
    // Results at a vertex, in memory that is used again.
    FanItems _fan;
    std::vector<FanItems> _fans;
    SharpEdges _edges;
    std::vector<float> _childSharpness;
    std::vector<float> _layers;
};

SharpVertex SharpMaskFinder::Find(Index vert) {
    float const vertSharpness = _level.GetVertexSharpness(vert);
    gatherSharpEdges(_level, vert, _fan, _edges);
    float const *const sharpness = _edges.sharpness.data();
    Crease::Rule const rule =
        _creasing.DetermineVertexVertexRule(vertSharpness, _edges.GetSize(), sharpness);
    SharpVertex const mask =
        maskOfRule(_level, _faceMask, _creasing, rule, vert, _edges, _edges.sharpness);

    float const childVertSharpness = _creasing.SubdivideVertexSharpness(vertSharpness);
    _childSharpness.resize(_edges.sharpness.size());
    _creasing.SubdivideEdgeSharpnessesAroundVertex(_edges.GetSize(), sharpness,
                                                   _childSharpness.data());
    Crease::Rule const childRule = _creasing.DetermineVertexVertexRule(
        childVertSharpness, _edges.GetSize(), _childSharpness.data());
    if (childRule == rule) {
        return mask;
    }
    float const weight = _creasing.ComputeFractionalWeightAtVertex(
        vertSharpness, childVertSharpness, _edges.GetSize(), sharpness, _childSharpness.data());
    return blend(mask,
                 maskOfRule(_level, _faceMask, _creasing, childRule, vert, _edges, _childSharpness),
                 weight);
}

// How much of a layer lets a smooth line go through the vertex.
float SharpMaskFinder::findOneFaceShare(Index vert, SharpnessLayer layer) const {
    auto const numSharp = std::count_if(_edges.sharpness.begin(), _edges.sharpness.end(),
                                        [&](float sharpness) { return layer.IsSharp(sharpness); });
    if (!_hasOneFaceMasks || numSharp != 2 || isNonManifold(_level, vert)) {
        return 0;
    }
    return std::max(0.0f, layer.upper - std::max(layer.lower, _level.GetVertexSharpness(vert)));
}

void SharpMaskFinder::AddSectorCorners(Index vert, std::vector<SectorCorner> &result) {
    if (!_hasOneFaceMasks && _level.GetNumVertexFaces(vert) < kMinShrunkSector) {
        return;
    }
    // For each fan, because a sector may lie between two ends of a fan on the same line.
    _layers.clear();
    std::size_t numFans = 0;
    ForEachFan(_level, vert, [&](VertexFan const &fan) {
        _fans.resize(std::max(_fans.size(), ++numFans));
        FanItems &items = _fans[numFans - 1];
        GatherFanItems(_level, fan, items);
        for (FanItem const &item : items.items) {
            if (isSharp(item)) {
                _layers.push_back(std::min(1.0f, item.sharpness));
            }
        }
    });
    std::sort(_layers.begin(), _layers.end());
    float lower = 0;
    // The sharpest edge of all is alone in its layer.
    for (int i = 0; i + 1 < int(_layers.size()); ++i) {
        if (_layers[i] > lower) {
            SharpnessLayer const layer = {lower, _layers[i]};
            float const oneFaceShare = findOneFaceShare(vert, layer);
            for (std::size_t fan = 0; fan < numFans; ++fan) {
                addSectorCorners(_level, layer, oneFaceShare, _fans[fan], result);
            }
            lower = layer.upper;
        }
    }
}

} // namespace

void ComputeSharpMasks(TagOptions options, Level &level) {
    constexpr Index kRange = 256; // of vertices, which take some hundred nanoseconds each
    struct Masks {
        std::vector<SharpVertex> verts;
        std::vector<SectorCorner> corners;
    };
    std::vector<Index> const verts = findSharpVertices(level);
    std::vector<Masks> masksOfRanges(
        std::size_t(GetNumParallelRanges(Index(verts.size()), kRange)));
    ParallelForRange(
        Index(verts.size()), [&] { return SharpMaskFinder(level, options); },
        [&](SharpMaskFinder &finder, Index begin, Index end) {
            Masks &masks = masksOfRanges[std::size_t(begin / kRange)];
            for (Index i = begin; i < end; ++i) {
                SharpVertex const mask = finder.Find(verts[i]);
                if (mask.rule != Crease::RULE_SMOOTH) {
                    masks.verts.push_back(mask);
                }
                finder.AddSectorCorners(verts[i], masks.corners);
            }
        },
        kRange);
    level.sharpVerts.clear();
    level.sectorCorners.clear();
    for (Masks const &masks : masksOfRanges) {
        level.sharpVerts.insert(level.sharpVerts.end(), masks.verts.begin(), masks.verts.end());
        level.sectorCorners.insert(level.sectorCorners.end(), masks.corners.begin(),
                                   masks.corners.end());
    }
    std::stable_sort(level.sectorCorners.begin(), level.sectorCorners.end(),
                     [](SectorCorner const &a, SectorCorner const &b) {
                         return std::tie(a.corner, a.kind) < std::tie(b.corner, b.kind);
                     });
}

std::vector<float> GatherSharpness(Level const &level, Index vert) {
    auto const isBefore = [](SharpEnd const &end, Index v) { return end.vert < v; };
    auto const first =
        std::lower_bound(level.sharpEnds.begin(), level.sharpEnds.end(), vert, isBefore);
    auto const last = std::lower_bound(first, level.sharpEnds.end(), vert + 1, isBefore);
    FanItems fan;
    SharpEdges edges;
    if (first == last) {
        gatherSharpEdges(level, vert, fan, edges);
    }
    std::for_each(first, last,
                  [&](SharpEnd const &end) { edges.sharpness.push_back(end.sharpness); });
    return edges.sharpness;
}

namespace {

// Sharpness after one step, as seen at the ends of a sharp edge.
class SharpnessRefiner {
public:
    SharpnessRefiner(Level const &level, Sdc::Options sdcOptions)
        : _level(level), _creasing(sdcOptions) {}

    // Sharpness of a part of the edge that ends in the vertex.
    float AtVertex(float sharpness, Index vert) const {
        if (_creasing.IsUniform()) {
            return Along(sharpness);
        }
        std::vector<float> const ofEdges = GatherSharpness(_level, vert);
        return _creasing.SubdivideEdgeSharpnessAtVertex(sharpness, int(ofEdges.size()),
                                                        ofEdges.data());
    }
    // Sharpness of a part of the edge that ends in neither vertex.
    float Along(float sharpness) const { return _creasing.SubdivideUniformSharpness(sharpness); }
    // Sharpness of the whole edge: the mean of both ends.
    float Between(float sharpness, Index vert0, Index vert1) const {
        if (Crease::IsInfinite(sharpness)) {
            return sharpness;
        }
        return 0.5f * (AtVertex(sharpness, vert0) + AtVertex(sharpness, vert1));
    }

private:
    Level const &_level;
    Crease const _creasing;
};

void fillZero(Buffer<float> &array, std::size_t size) {
    array.Resize(size);
    std::fill_n(array.data(), size, 0.0f);
}

// An array without any sharp entry is dropped, so that levels without tags have none.
void dropIfSmooth(Buffer<float> &array) {
    if (std::none_of(array.begin(), array.end(), Crease::IsSharp)) {
        array.Resize(0);
    }
}

void refineDiagonals(Refinement const &refinement, SharpnessRefiner const &refiner, Level &child) {
    Level const &parent = *refinement.parent;
    fillZero(child.diagonalSharpness, child.numFaces);
    for (std::size_t face = 0; face < parent.diagonalSharpness.size(); ++face) {
        child.diagonalSharpness[face] = refiner.Along(parent.diagonalSharpness[face]);
    }
    for (std::size_t edge = 0; edge < parent.edgeSharpness.size(); ++edge) {
        if (Crease::IsSharp(parent.edgeSharpness[edge])) {
            child.diagonalSharpness[refinement.GetEdgeChildFace(Index(edge))] = refiner.Between(
                parent.edgeSharpness[edge], parent.edgeVerts[edge][0], parent.edgeVerts[edge][1]);
        }
    }
    dropIfSmooth(child.diagonalSharpness);
}

// The sharp vertices of level 0 and their children are the first of their level.
void refineVertices(Refinement const &refinement, SharpnessRefiner const &refiner, Level &child) {
    Level const &parent = *refinement.parent;
    child.vertSharpness.Resize(parent.vertSharpness.size());
    std::size_t size = 0;
    for (std::size_t vert = 0; vert < parent.vertSharpness.size(); ++vert) {
        if (refinement.GetVertexChildVertex(Index(vert)) != Far::INDEX_INVALID) {
            child.vertSharpness[size++] = refiner.Along(parent.vertSharpness[vert]);
        }
    }
    child.vertSharpness.Resize(size);
    dropIfSmooth(child.vertSharpness);
}

// The child edge from the V-vertex of a vertex to an F-vertex.
Index findSpoke(Refinement const &refinement, Index pVert, Index fVertex, Level const &child) {
    Index const vVertex = refinement.GetVertexChildVertex(pVert);
    Far::LocalIndex const *local = child.GetVertexEdgeLocals(fVertex);
    for (Index i = child.vertFirstEdge[fVertex]; i < child.vertFirstEdge[fVertex + 1]; ++i) {
        Index const edge = child.vertEdges[i];
        if (child.edgeVerts[edge][1 - *local++] == vVertex) {
            return edge;
        }
    }
    return Far::INDEX_INVALID;
}

// The spoke to the F-vertex of a corner.
Index findSpoke(Refinement const &refinement, Index corner, Level const &child) {
    return findSpoke(refinement, refinement.parent->faceVerts[corner],
                     refinement.GetCornerChildVertex(corner), child);
}

void refineEdges(Refinement const &refinement, SharpnessRefiner const &refiner, Level &child) {
    Level const &parent = *refinement.parent;
    if (parent.diagonalSharpness.empty()) {
        return;
    }
    fillZero(child.edgeSharpness, child.numEdges);
    for (Index face = 0; face < parent.numFaces; ++face) {
        float const sharpness = parent.diagonalSharpness[face];
        if (!Crease::IsSharp(sharpness)) {
            continue;
        }
        for (int local : {kDiagonalStart, parent.GetDiagonalEnd(face)}) {
            Index const corner = parent.faceFirstCorner[face] + local;
            Index const spoke = findSpoke(refinement, corner, child);
            child.edgeSharpness[spoke] = refiner.AtVertex(sharpness, parent.faceVerts[corner]);
        }
    }
    dropIfSmooth(child.edgeSharpness);
}

// A boundary of phase A has a child of phase B, in a half face; one of phase B has one in the F-face
// of its half face, and the spokes at its ends.
void refineLines(Refinement const &refinement, Level &child) {
    Level const &parent = *refinement.parent;
    for (LineEdge const &pEdge : parent.lineEdges) {
        if (refinement.isTruncation) {
            std::size_t const end = 2 * std::size_t(pEdge.edge);
            for (Index edge : {parent.numCorners + pEdge.edge,
                               findSpoke(refinement, parent.edgeVerts[pEdge.edge][0],
                                         GetEdgeEndVertex(refinement, end), child),
                               findSpoke(refinement, parent.edgeVerts[pEdge.edge][1],
                                         GetEdgeEndVertex(refinement, end + 1), child)}) {
                child.lineEdges.push_back({edge, pEdge.line});
            }
            continue;
        }
        Index const eFace = refinement.GetEdgeChildFace(pEdge.edge);
        if (eFace != Far::INDEX_INVALID) {
            Index const corner = child.faceFirstCorner[eFace] + kHalfFaceLongEdge;
            child.lineEdges.push_back({child.faceEdges[corner], pEdge.line});
            continue;
        }
        Index const face = parent.edgeFaces[pEdge.edge][0];
        Index const corner = parent.faceFirstCorner[face] + kHalfFaceLongEdge;
        Index const fFaceEdge = child.faceEdges[child.faceFirstCorner[face] + kHalfFaceLongEdge];
        for (Index edge : {fFaceEdge, findSpoke(refinement, corner, child),
                           findSpoke(refinement, corner + 1, child)}) {
            child.lineEdges.push_back({edge, pEdge.line});
        }
    }
    std::sort(child.lineEdges.begin(), child.lineEdges.end(),
              [](LineEdge const &a, LineEdge const &b) { return a.edge < b.edge; });
}

// In a truncation a sharp edge has a child between its two new vertices, and a spoke at each end where
// the polygon of its vertex is cut.
void refineEdgesOfTruncation(Refinement const &refinement, SharpnessRefiner const &refiner,
                             Level &child) {
    Level const &parent = *refinement.parent;
    fillZero(child.edgeSharpness, std::size_t(child.numEdges));
    for (Index edge = 0; edge < parent.numEdges; ++edge) {
        float const sharpness = parent.edgeSharpness[edge];
        if (!Crease::IsSharp(sharpness) || parent.IsBoundary(edge)) {
            continue;
        }
        IndexPair const &verts = parent.edgeVerts[edge];
        child.edgeSharpness[parent.numCorners + edge] =
            refiner.Between(sharpness, verts[0], verts[1]);
        for (int side : {0, 1}) {
            Index const corner = parent.GetSideCorner(edge, side);
            if (Index const spoke = findSpoke(refinement, corner, child);
                spoke != Far::INDEX_INVALID) {
                child.edgeSharpness[spoke] = refiner.AtVertex(sharpness, verts[side]);
            }
        }
    }
    dropIfSmooth(child.edgeSharpness);
}

// Where a crease passes a vertex the diagonal of the V-face is as sharp as its less sharp end.
void refineDiagonalsOfTruncation(Refinement const &refinement, SharpnessRefiner const &refiner,
                                 Level &child) {
    Level const &parent = *refinement.parent;
    fillZero(child.diagonalSharpness, std::size_t(child.numFaces));
    for (CrossedFace const &crossed : child.crossedFaces) {
        auto const getSharpness = [&](int local) {
            Index const cVert = child.faceVerts[child.faceFirstCorner[crossed.face] + local];
            Index const corner = refinement.GetChildVertexCorner(cVert);
            return refiner.AtVertex(parent.GetEdgeSharpness(parent.faceEdges[corner]),
                                    parent.faceVerts[corner]);
        };
        child.diagonalSharpness[crossed.face] =
            std::min(getSharpness(kDiagonalStart), getSharpness(crossed.end));
        if (Crease::IsInfinite(child.diagonalSharpness[crossed.face])) {
            child.cutFaces.push_back(crossed);
        }
    }
    dropIfSmooth(child.diagonalSharpness);
}

// The halves of a hexagon lie in the cells of its edge's faces.  Other faces that lie in several cells
// are holes when all of these are.
void refineHoles(Refinement const &refinement, Level &child) {
    Level const &parent = *refinement.parent;
    // Whether half number half of a face is a hole; bits as in Level::faceHoles.
    auto const getHole = [&](Index face, int half) -> unsigned {
        return (parent.faceHoles[face] >> half & 1u) != 0 ? kHole : 0;
    };
    child.faceHoles.Resize(child.numFaces);
    std::copy(parent.faceHoles.begin(), parent.faceHoles.end(), child.faceHoles.data());
    for (Index edge = 0; edge < parent.numEdges; ++edge) {
        Index const cFace = refinement.GetEdgeChildFace(edge);
        if (cFace == Far::INDEX_INVALID) {
            continue;
        }
        unsigned holes[2];
        for (int side = 0; side < 2; ++side) {
            int const from = parent.IsBoundary(edge) ? 0 : side;
            holes[side] = getHole(parent.edgeFaces[edge][from],
                                  parent.GetHalfOfFaceEdge(parent.edgeFaces[edge][from],
                                                           parent.edgeFaceLocals[edge][from]));
        }
        child.faceHoles[cFace] = static_cast<unsigned char>(HasHalves(child.GetFaceSize(cFace))
                                                                ? (holes[0] & 1u) | (holes[1] & 2u)
                                                                : holes[0] & holes[1]);
    }
    for (Index cFace = child.numFaces - child.numVFaces; cFace < child.numFaces; ++cFace) {
        if (refinement.isTruncation) { // holes end at cuts
            unsigned holes = 0;
            for (int half : {0, 1}) {
                Index const pFace = refinement.GetParentCell({cFace, half}).face;
                holes |= parent.faceHoles[pFace] & 1u << half;
            }
            child.faceHoles[cFace] = static_cast<unsigned char>(holes);
            continue;
        }
        unsigned hole = kHole;
        for (Index k = child.faceFirstCorner[cFace]; k < child.faceFirstCorner[cFace + 1]; ++k) {
            if (Index const cVert = child.faceVerts[k]; cVert >= child.numVVertices) {
                Index const corner = refinement.GetChildVertexCorner(cVert);
                Index const pFace = parent.FindFaceOfCorner(corner);
                int const local = corner - parent.faceFirstCorner[pFace];
                // A corner lies in the halves of its two edges.
                hole &= getHole(pFace, parent.GetHalfOfFaceEdge(pFace, local)) &
                        getHole(pFace, local == 0 ? 0 : parent.GetHalfOfFaceEdge(pFace, local - 1));
            }
        }
        child.faceHoles[cFace] = static_cast<unsigned char>(hole);
    }
}

} // namespace

void RefineTags(Refinement const &refinement, Sdc::Options sdcOptions, Level &child) {
    Level const &parent = *refinement.parent;
    child.edgeSharpness.Resize(0);
    child.diagonalSharpness.Resize(0);
    child.vertSharpness.Resize(0);
    child.faceHoles.Resize(0);
    child.cutFaces.clear();
    child.nonManifoldVerts.clear();
    for (Index vert : parent.nonManifoldVerts) {
        if (Index const cVert = refinement.GetVertexChildVertex(vert);
            cVert != Far::INDEX_INVALID) {
            child.nonManifoldVerts.push_back(cVert);
        }
    }
    std::vector<Index> &verts = child.nonManifoldVerts;
    verts.insert(verts.end(), child.partedVerts.begin(), child.partedVerts.end());
    SortUnique(verts);

    child.lineEdges.clear();
    if (child.hasFullTopology) {
        refineLines(refinement, child);
    }
    SharpnessRefiner const refiner(parent, sdcOptions);
    if (refinement.isTruncation) {
        if (!parent.edgeSharpness.empty()) {
            refineDiagonalsOfTruncation(refinement, refiner, child);
        }
        if (!parent.edgeSharpness.empty() && child.hasFullTopology) {
            refineEdgesOfTruncation(refinement, refiner, child);
        }
    } else if (!parent.edgeSharpness.empty() || !parent.diagonalSharpness.empty()) {
        refineDiagonals(refinement, refiner, child);
        if (child.hasFullTopology) {
            refineEdges(refinement, refiner, child);
        }
    }
    if (!parent.vertSharpness.empty()) {
        refineVertices(refinement, refiner, child);
    }
    if (!parent.faceHoles.empty()) {
        refineHoles(refinement, child);
    }
}

} // namespace OpenSubdivHex::FarExt::internal
