// SPDX-License-Identifier: Apache-2.0
#include "limitPatch.h"

#include "far_ext/vtr/baseLevel.h"
#include "far_ext/vtr/hexRefinement.h"
#include "far_ext/vtr/indexSet.h"
#include "far_ext/vtr/refinementRows.h"
#include "far_ext/vtr/sharpFeatures.h"

#include <cstdint>
#include <cstring>
#include <iterator>

namespace OpenSubdivHex::FarExt::internal {

namespace {

using Far::Index;
using Sdc::Crease;

int getBits(float value) {
    static_assert(sizeof(int) == sizeof(float));
    int bits = 0;
    std::memcpy(&bits, &value, sizeof bits);
    return bits;
}

// Tags that are all smooth are left out, as in every level.
void fillTags(std::vector<float> const &from, Buffer<float> &to) {
    if (std::any_of(from.begin(), from.end(), Crease::IsSharp)) {
        to.Assign(from);
    }
}

bool isBreak(FanItem const &item) { return !item.isFace && Crease::IsInfinite(item.sharpness); }

int countBreaks(FanItems const &fan) {
    return int(std::count_if(fan.items.begin(), fan.items.end(), isBreak));
}

// As FindVertexSides makes them.
int countSides(FanItems const &fan) {
    int const numBreaks = countBreaks(fan);
    if (numBreaks < 2) {
        return 1;
    }
    return fan.isClosed ? numBreaks
                        : numBreaks - 1 + !isBreak(fan.items.front()) + !isBreak(fan.items.back());
}

// Whether masks of curves are used in the patch or in those that it makes.
bool hasSharpLines(LimitPatch const &patch) {
    return std::any_of(
               patch.otherCorners.begin(), patch.otherCorners.end(),
               [](Index other) { return other == kSharpBoundaryA || other == kSharpBoundaryB; }) ||
           std::any_of(patch.edgeSharpness.begin(), patch.edgeSharpness.end(), Crease::IsSharp) ||
           std::any_of(patch.diagonalSharpness.begin(), patch.diagonalSharpness.end(),
                       Crease::IsSharp);
}

} // namespace

// It has several fans and is a corner for ever.  Semi-sharp edges fade by what others there are around a vertex,
// and at free boundaries all faces tell the tangents.
bool ComesApart(Level const &level, Index vert) {
    SharpVertex const *const sharp =
        level.IsNonManifold(vert) ? level.FindSharpVertex(vert) : nullptr;
    if (!sharp || sharp->rule != Crease::RULE_CORNER) {
        return false;
    }
    auto const isForEver = [](float sharpness) {
        return !Crease::IsSharp(sharpness) || Crease::IsInfinite(sharpness);
    };
    Far::ConstIndexArray const edges = level.GetVertexEdges(vert);
    bool isCorner = isForEver(level.GetVertexSharpness(vert)) &&
                    std::none_of(edges.begin(), edges.end(), [&](Index edge) {
                        return level.edgeFaces[edge][1] == kFreeBoundary;
                    });
    int numFans = 0;
    ForEachFanItems(level, vert, [&](FanItems const &fan) {
        ++numFans;
        isCorner =
            isCorner && std::all_of(fan.items.begin(), fan.items.end(), [&](FanItem const &item) {
                return item.isFace || isForEver(item.sharpness);
            });
    });
    return isCorner && numFans > 1;
}

int CountFacesTogether(Level const &level, Index vert) {
    if (level.GetNumVertexFaces(vert) > kMaxFacesApart || !ComesApart(level, vert)) {
        return level.GetNumVertexFaces(vert);
    }
    int result = 0;
    ForEachFan(level, vert,
               [&](VertexFan const &fan) { result = std::max(result, fan.GetSize()); });
    return result;
}

// Whether a vertex does, which is looked at once.
bool LimitPatchGatherer::comesApart(Index vert) {
    if (vert == _whole || !_level.IsNonManifold(vert)) {
        return false;
    }
    if (Index const known = _apart.Find(vert); known != Far::INDEX_INVALID) {
        return known != 0;
    }
    bool const isApart = ComesApart(_level, vert);
    _apart.FindOrSet(vert, isApart ? 1 : 0);
    if (isApart) {
        ForEachFan(_level, vert, [&](VertexFan const &fan) {
            for (Index k = fan.begin; k < fan.end; ++k) {
                // No index of a vertex, nor INDEX_INVALID.
                _fanKeys.FindOrSet(_level.GetVertexCorner(k), -2 - fan.begin);
            }
        });
    }
    return isApart;
}

// Returns the key of a corner's vertex in the patch: the vertex of the level or, where that comes apart, the fan.
// Once the complete vertices have numbers, others do not come apart, as in plain neighborhoods.
Index LimitPatchGatherer::findKey(Index corner) {
    Index const vert = _level.faceVerts[corner];
    if (!comesApart(vert)) {
        return vert;
    }
    Index const key = _fanKeys.Find(corner);
    return _numComplete == 0 || _verts.Find(key) != Far::INDEX_INVALID ? key : vert;
}

// The number of the vertex of a corner, INDEX_INVALID where the patch has none.
Index LimitPatchGatherer::findVertex(Index corner) { return _verts.Find(findKey(corner)); }

Index LimitPatchGatherer::addVertex(Index corner, LimitPatch &patch) {
    Index const next = Index(patch.sources.size());
    Index const found = _verts.FindOrSet(findKey(corner), next);
    if (found == next) {
        patch.sources.push_back(_level.faceVerts[corner]);
    }
    return found;
}

// The corner at an end of an edge.
Index LimitPatchGatherer::findEndCorner(Index edge, int end) const {
    Index const corner = _level.GetSideCorner(edge, 0);
    return end == 0 ? corner : _level.GetNextCorner(_level.edgeFaces[edge][0], corner);
}

Index LimitPatchGatherer::findEndVertex(Index edge, int end) {
    return findVertex(findEndCorner(edge, end));
}

// The first corner of a neighbour in the faces around a vertex.
Index LimitPatchGatherer::findCornerBeside(Index vert, Index neighbor) const {
    for (Index const face : _level.GetVertexFaces(vert)) {
        Far::ConstIndexArray const verts = _level.GetFaceVertices(face);
        if (int const local = verts.FindIndex(neighbor); local >= 0) {
            return _level.faceFirstCorner[face] + local;
        }
    }
    return Far::INDEX_INVALID;
}

// Calls function(fan, first of its edges, their number) for the fans of a vertex of the patch.
template <typename FUNCTION>
void LimitPatchGatherer::forEachFanOf(int vert, LimitPatch const &patch, FUNCTION const &function) {
    Index const source = patch.sources[std::size_t(vert)];
    Index firstEdge = _level.vertFirstEdge[source];
    ForEachFan(_level, source, [&](VertexFan const &fan) {
        int const numEdges = fan.end - fan.begin + !fan.isClosed;
        if (findVertex(_level.GetVertexCorner(fan.begin)) == vert) {
            function(fan, firstEdge, numEdges);
        }
        firstEdge += numEdges;
    });
}

// The fans one after the other, as the level has them, but closed ones from their first face on.
void LimitPatchGatherer::orderFans(LimitPatch &patch) {
    forEachFanOf(0, patch, [&](VertexFan const &fan, Index firstEdge, int numEdges) {
        GatherFanItems(_level, fan, _fan);
        int const numFaces = fan.end - fan.begin;
        int firstSide = 0;
        int const first = fan.isClosed ? findFirstFace(fan, firstSide) : 0;
        for (int i = 0; i < numFaces; ++i) {
            _ringFaces.push_back(fan.begin + (first + i) % numFaces);
        }
        for (int i = 0; i < numEdges; ++i) {
            _ringEdges.push_back(_level.vertEdges[firstEdge + (first + i) % numEdges]);
        }
        int const begin = int(patch.sides.size());
        int const numSides = countSides(_fan);
        for (int side = 0; side < numSides; ++side) {
            patch.sides.push_back(begin + (side + numSides - firstSide % numSides) % numSides);
        }
    });
}

// A closed fan has no first face of its own: that with the least sequence of what is around the
// vertex is taken.  firstSide is the side of the level that begins there or next.
int LimitPatchGatherer::findFirstFace(VertexFan const &fan, int &firstSide) {
    int const numFaces = fan.end - fan.begin;
    struct Key {
        int numbers[4];
        int numBreaks;
    };
    std::vector<Key> keys;
    for (FanItem const &item : _fan.items) {
        if (item.isFace && item.half < 0) {
            Index const face = _level.vertFaces[fan.begin + Index(keys.size()) - 1];
            keys.back().numbers[1] =
                _level.faceFirstCorner[face + 1] - _level.faceFirstCorner[face];
            keys.back().numbers[2] =
                _level.IsHalfFace(face) ? 1 + item.corner - _level.faceFirstCorner[face] : 0;
        } else if (item.isLong) {
            keys.back().numbers[3] = getBits(item.sharpness);
            keys.back().numBreaks += isBreak(item);
        } else if (!item.isFace) {
            keys.push_back({{getBits(item.sharpness), 0, 0, 0}, isBreak(item)});
        }
    }
    auto const compare = [&](int first, int second) {
        for (int i = 0; i < numFaces; ++i) {
            int const order =
                std::memcmp(keys[(first + i) % numFaces].numbers,
                            keys[(second + i) % numFaces].numbers, sizeof keys[0].numbers);
            if (order != 0) {
                return order;
            }
        }
        return 0;
    };
    int best = 0;
    bool const isUniform = std::all_of(keys.begin(), keys.end(), [&](Key const &key) {
        return std::memcmp(key.numbers, keys[0].numbers, sizeof key.numbers) == 0;
    });
    for (int i = 1; i < numFaces && !isUniform; ++i) {
        if (compare(i, best) < 0) {
            best = i;
        }
    }
    for (int i = 0; i < best; ++i) {
        firstSide += keys[i].numBreaks;
    }
    return best;
}

// The corners of a face begin at local, or, where a line stands out, at that end of it which comes before: a long edge
// has one order of its ends, and the ends of a diagonal are alike.
void LimitPatchGatherer::addFace(Index face, int local, bool isRing, LimitPatch &patch) {
    Index const next = Index(patch.faceSizes.size());
    if (_faces.FindOrSet(face, next) != next) {
        return;
    }
    Index const first = _level.faceFirstCorner[face];
    int const size = _level.faceFirstCorner[face + 1] - first;
    float const diagonal = _level.GetDiagonalSharpness(face);
    int diagonalEnd = _level.GetDiagonalEnd(face);
    if (_level.IsHalfFace(face)) {
        local = 0;
    } else if (Crease::IsSharp(diagonal)) {
        local = local < diagonalEnd ? kDiagonalStart : diagonalEnd;
        diagonalEnd = local == kDiagonalStart ? diagonalEnd : size - diagonalEnd;
    }
    bool hasTags = false;
    CornerTags::ForEachKind(
        [&](auto const &tags) {
            hasTags = hasTags || !FindCornerTags(tags, first, first + size).empty();
        },
        _level);
    Index const patchFirst = Index(patch.faceVerts.size());
    for (int i = 0; i < size; ++i) {
        Index const corner = first + (local + i < size ? local + i : local + i - size);
        _corners.push_back(corner);
        Index const vert = addVertex(corner, patch);
        patch.faceVerts.push_back(vert);
        // Only corners at the neighbours of vertex 0 matter of the faces further out.
        if (hasTags && (isRing || vert < _numComplete)) {
            CornerTags::ForEachKind(
                [&](auto const &ofLevel, auto &ofPatch) {
                    for (auto tag : FindCornerTags(ofLevel, corner, corner + 1)) {
                        tag.corner = patchFirst + i;
                        ofPatch.push_back(tag);
                    }
                },
                _level, patch);
        }
    }
    if (Crease::IsSharp(diagonal) && _level.FindCrossedFace(face)) {
        patch.crossedFaces.push_back({Index(patch.faceSizes.size()), diagonalEnd});
    }
    patch.faceSizes.push_back(size);
    patch.diagonalSharpness.push_back(diagonal);
}

void LimitPatchGatherer::addEdge(Index corner, Index nextCorner, LimitPatch &patch) {
    Index const edge = _level.faceEdges[_corners[std::size_t(corner)]];
    Index const other = _edges.FindOrSet(edge, corner);
    bool const isComplete = std::min(patch.faceVerts[std::size_t(corner)],
                                     patch.faceVerts[std::size_t(nextCorner)]) < _numComplete;
    patch.edgeSharpness.push_back(isComplete ? _level.GetEdgeSharpness(edge) : 0);
    if (other != corner) {
        // Further out it does not matter which faces are joined: patches that differ in nothing else
        // are to be the same.
        patch.otherCorners.push_back(isComplete ? other : Index(kFreeBoundary));
        if (isComplete) {
            patch.otherCorners[other] = corner;
        }
        return;
    }
    bool const isKept = _level.IsBoundary(edge) && (isComplete || _level.IsSharpBoundaryB(edge));
    patch.otherCorners.push_back(isKept ? _level.edgeFaces[edge][1] : Index(kFreeBoundary));
    Index const line = _level.GetEdgeLine(edge);
    if (isKept && line != Far::INDEX_INVALID) {
        auto const found = std::find(_lines.begin(), _lines.end(), line);
        patch.lineCorners.push_back(corner);
        patch.lines.push_back(Index(found - _lines.begin()));
        if (found == _lines.end()) {
            _lines.push_back(line);
        }
    }
}

void LimitPatchGatherer::addTags(LimitPatch &patch) {
    for (Index vert = 0; vert < Index(patch.sources.size()); ++vert) {
        Index const source = patch.sources[vert];
        bool const isComplete = vert < _numComplete;
        if (isComplete && comesApart(source)) {
            patch.vertSharpness.push_back(Crease::SHARPNESS_INFINITE);
            continue;
        }
        patch.vertSharpness.push_back(isComplete ? _level.GetVertexSharpness(source) : 0);
        if (isComplete && std::binary_search(_level.nonManifoldVerts.begin(),
                                             _level.nonManifoldVerts.end(), source)) {
            patch.nonManifoldVerts.push_back(vert);
        }
    }
}

void LimitPatchGatherer::addSharpVertices(LimitPatch &patch) {
    for (Index vert = 0; vert < _numComplete; ++vert) {
        SharpVertex const *const sharp = _level.FindSharpVertex(patch.sources[vert]);
        if (!sharp) {
            continue;
        }
        SharpVertex mask = *sharp;
        mask.vert = vert;
        for (int i = 0; i < 2; ++i) {
            mask.neighbors[i] =
                mask.neighborWeights[i] > 0
                    ? findVertex(findCornerBeside(patch.sources[vert], sharp->neighbors[i]))
                    : vert;
        }
        patch.sharpVerts.push_back(mask);
    }
}

void LimitPatchGatherer::addSharpEnds(LimitPatch &patch) {
    if (_creasing.IsUniform()) {
        return;
    }
    std::vector<Index> verts;
    auto const addEnds = [&](Index end, Index otherEnd, float sharpness) {
        Index const outer = std::max(end, otherEnd);
        if (Crease::IsSemiSharp(sharpness) && std::min(end, otherEnd) < _numComplete &&
            outer >= _numComplete) {
            verts.push_back(outer);
        }
    };
    Index first = 0;
    for (std::size_t face = 0; face < patch.faceSizes.size(); ++face) {
        int const size = patch.faceSizes[face];
        for (int i = 0; i < size; ++i) {
            addEnds(patch.faceVerts[first + i], patch.faceVerts[first + (i + 1) % size],
                    patch.edgeSharpness[first + i]);
        }
        if (float const sharpness = patch.diagonalSharpness[face]; Crease::IsSharp(sharpness)) {
            int end = kDiagonalEnd;
            for (CrossedFace const &crossed : patch.crossedFaces) {
                end = crossed.face == Index(face) ? crossed.end : end;
            }
            addEnds(patch.faceVerts[first + kDiagonalStart], patch.faceVerts[first + end],
                    sharpness);
        }
        first += size;
    }
    SortUnique(verts);
    for (Index const vert : verts) {
        for (float const sharpness : GatherSharpness(_level, patch.sources[vert])) {
            patch.sharpEnds.push_back({vert, sharpness});
        }
    }
}

// Whether the steps to come make irregular vertices or corners, at most.
bool LimitPatchGatherer::hasIrregularities(LimitPatch const &patch) const {
    constexpr int kQuad = 4;
    auto const isIrregular = [this](Index source) {
        return _level.GetNumVertexFaces(source) >= kMinIrregularFaces;
    };
    if (_level.numHexagonalSteps == 0 || patch.HasCornerTags() ||
        std::any_of(patch.sources.begin(), patch.sources.begin() + _numComplete, isIrregular)) {
        return true;
    }
    std::size_t longEdge = kHalfFaceLongEdge;
    for (int const size : patch.faceSizes) {
        if (size == kQuad && patch.otherCorners[longEdge] != kSharpBoundaryB) {
            return true;
        }
        longEdge += std::size_t(size);
    }
    return false;
}

int LimitPatchGatherer::countSteps(LimitPatch const &patch) const {
    bool const isSmooth = _faceMask == FaceMask::Smooth;
    if (hasSharpLines(patch) || (isSmooth && hasIrregularities(patch))) {
        return std::min(_level.numHexagonalSteps, kNumStepsToConstantMasks);
    }
    return isSmooth ? kNumStepsToConstantMasks : 0;
}

void LimitPatchGatherer::addIrregularVertices(LimitPatch &patch) {
    patch.numHexagonalSteps = countSteps(patch);
    patch.hasFirstLineMasks =
        _level.hasFirstLineMasks && patch.numHexagonalSteps < kNumLineSteps && hasSharpLines(patch);
    for (Index vert = 0; vert < _numComplete; ++vert) {
        if (IrregularVertex const *const irregular =
                _level.FindIrregularVertex(patch.sources[vert])) {
            patch.irregularVerts.push_back({vert, irregular->weight});
        }
    }
}

void LimitPatchGatherer::addSignature(LimitPatch &patch) {
    std::vector<int> &signature = patch.signature;
    // Most patches have no tags.
    constexpr std::size_t kNumSizes = 11;
    signature.reserve(patch.faceSizes.size() + 2 * patch.faceVerts.size() + kNumSizes);
    auto const add = [&](auto const &numbers) {
        signature.push_back(int(numbers.size()));
        for (auto number : numbers) {
            if constexpr (std::is_same_v<decltype(number), float>) {
                signature.push_back(getBits(number));
            } else {
                signature.push_back(number);
            }
        }
    };
    auto const addIfAny = [&](std::vector<float> const &tags) {
        add(std::any_of(tags.begin(), tags.end(), Crease::IsSharp) ? tags : std::vector<float>());
    };
    add(patch.faceSizes);
    add(patch.faceVerts);
    add(patch.otherCorners);
    addIfAny(patch.edgeSharpness);
    addIfAny(patch.diagonalSharpness);
    for (CrossedFace const &crossed : patch.crossedFaces) { // which have a diagonal
        signature.insert(signature.end(), {crossed.face, crossed.end});
    }
    signature.push_back(int(patch.crossedFaces.size()));
    addIfAny(patch.vertSharpness);
    add(patch.nonManifoldVerts);
    add(patch.lineCorners);
    add(patch.lines);
    for (SharpVertex const &sharp : patch.sharpVerts) {
        auto const [first, second] = std::minmax(sharp.neighbors[0], sharp.neighbors[1]);
        signature.insert(signature.end(), {sharp.vert, first, second});
    }
    signature.push_back(int(patch.sharpEnds.size()));
    for (SharpEnd const &end : patch.sharpEnds) {
        signature.insert(signature.end(), {end.vert, getBits(end.sharpness)});
    }
    signature.push_back(patch.numHexagonalSteps);
    signature.push_back(int(patch.hasFirstLineMasks));
    CornerTags::ForEachKind(
        [&signature](auto const &tags) {
            signature.push_back(int(tags.size()));
            for (auto const &tag : tags) {
                int words[sizeof tag / sizeof(int)];
                std::memcpy(words, &tag, sizeof tag);
                signature.insert(signature.end(), std::begin(words), std::end(words));
            }
        },
        patch);
}

// Patches of a level that are gathered one after the other are of similar sizes.
void LimitPatchGatherer::clear(LimitPatch &patch) {
    std::size_t const numCorners = _corners.size();
    _numComplete = 0;
    _verts.Clear();
    _faces.Clear();
    _edges.Clear();
    _corners.clear();
    _lines.clear();
    _ringFaces.clear();
    _ringEdges.clear();
    patch = LimitPatch();
    patch.faceVerts.reserve(numCorners);
    patch.otherCorners.reserve(numCorners);
    patch.edgeSharpness.reserve(numCorners);
}

// The vertices whose faces are all there come first: the centres, for which the patch is made and
// which it has already, and their neighbours.
void LimitPatchGatherer::addNeighborhood(int numCenters, LimitPatch &patch) {
    for (Index ringEdge : _ringEdges) {
        for (int end = 0; end < 2; ++end) {
            addVertex(findEndCorner(ringEdge, end), patch);
        }
    }
    _numComplete = int(patch.sources.size());

    auto const addFaceAt = [&](Index k, bool isRing) {
        addFace(_level.vertFaces[k], _level.vertFaceLocals[k], isRing, patch);
    };
    for (Index k : _ringFaces) {
        addFaceAt(k, true);
    }
    for (int i = numCenters; i < _numComplete; ++i) {
        // Each fan from its edge to the first centre on, where the fan has one: so neighbours of a
        // pole of several fans look alike.
        forEachFanOf(i, patch, [&](VertexFan const &fan, Index firstEdge, int numEdges) {
            int const numFaces = fan.end - fan.begin;
            int const first = findCenterEdge(i, firstEdge, numEdges, numCenters) % numEdges;
            for (int k = 0; k < numFaces; ++k) {
                addFaceAt(fan.begin + (first + k) % numFaces, false);
            }
        });
    }
    Index corner = 0;
    for (int const size : patch.faceSizes) {
        Index const last = corner + size - 1;
        for (; corner < last; ++corner) {
            addEdge(corner, corner + 1, patch);
        }
        addEdge(corner++, last + 1 - size, patch);
    }
    std::stable_sort(
        patch.sectorCorners.begin(), patch.sectorCorners.end(),
        [](SectorCorner const &a, SectorCorner const &b) { return a.corner < b.corner; });
    addTags(patch);
    addSharpVertices(patch);
    addSharpEnds(patch);
    addIrregularVertices(patch);
}

// Which of the edges of a fan leads to the first centre; numEdges where none does.
int LimitPatchGatherer::findCenterEdge(Index neighbor, Index firstEdge, int numEdges,
                                       int numCenters) {
    int best = numEdges;
    Index bestCenter = numCenters;
    for (int i = 0; i < numEdges; ++i) {
        Index const edge = _level.vertEdges[firstEdge + i];
        Index const start = findEndVertex(edge, 0);
        Index const center = start == neighbor ? findEndVertex(edge, 1) : start;
        if (center != Far::INDEX_INVALID && center < bestCenter) {
            best = i;
            bestCenter = center;
        }
    }
    return best;
}

void LimitPatchGatherer::Gather(Index vert, LimitPatch &patch) {
    clear(patch);
    _whole = vert;
    addVertex(_level.GetVertexCorner(_level.vertFirstFace[vert]), patch);
    orderFans(patch);
    addNeighborhood(1, patch);
    addSignature(patch);
}

void LimitPatchGatherer::GatherFan(Index corner, LimitPatch &patch) {
    clear(patch);
    _whole = Far::INDEX_INVALID;
    addVertex(corner, patch);
    orderFans(patch);
    addNeighborhood(1, patch);
    addSignature(patch);
}

int LimitPatchGatherer::GatherCell(Index face, int const *locals, int numCorners,
                                   LimitPatch &patch) {
    clear(patch);
    _whole = Far::INDEX_INVALID;
    Index const first = _level.faceFirstCorner[face];
    for (int i = 0; i < numCorners; ++i) {
        addVertex(first + locals[i], patch);
    }
    int const numCenters = int(patch.sources.size());
    Index const firstVert = patch.sources[0];
    for (Index k = _level.vertFirstFace[firstVert]; k < _level.vertFirstFace[firstVert + 1]; ++k) {
        if (_level.GetVertexCorner(k) == first + locals[0]) {
            _ringFaces.push_back(k);
        }
    }
    for (int center = 0; center < numCenters; ++center) {
        // A fan that has the face begins with it.
        forEachFanOf(center, patch, [&](VertexFan const &fan, Index firstEdge, int numEdges) {
            int const numFaces = fan.end - fan.begin;
            Index const *const faces = _level.vertFaces.data() + fan.begin;
            int const firstFace = int(std::find(faces, faces + numFaces, face) - faces) % numFaces;
            for (int i = 0; i < numFaces; ++i) {
                _ringFaces.push_back(fan.begin + (firstFace + i) % numFaces);
            }
            for (int i = 0; i < numEdges; ++i) {
                _ringEdges.push_back(_level.vertEdges[firstEdge + (firstFace + i) % numEdges]);
            }
        });
    }
    addNeighborhood(numCenters, patch);
    return _corners[0] - first;
}

void BuildPatchLevel(LimitPatch const &patch, Level &level) {
    level.numVertices = Index(patch.sources.size());
    level.numFaces = Index(patch.faceSizes.size());
    level.numCorners = Index(patch.faceVerts.size());
    level.faceFirstCorner.Resize(patch.faceSizes.size() + 1);
    Index first = 0;
    for (Index face = 0; face < level.numFaces; ++face) {
        level.faceFirstCorner[face] = first;
        first += patch.faceSizes[face];
    }
    level.faceFirstCorner[level.numFaces] = first;
    level.faceVerts.Assign(patch.faceVerts);

    std::vector<EdgeSides> edges;
    std::vector<float> edgeSharpness;
    for (Index corner = 0; corner < level.numCorners; ++corner) {
        Index const other = patch.otherCorners[corner];
        if (other < 0 || other > corner) {
            edges.push_back({{corner, other}});
            edgeSharpness.push_back(patch.edgeSharpness[corner]);
        }
    }
    BuildBaseLevel({edges.data(), Index(edges.size())}, level);
    fillTags(edgeSharpness, level.edgeSharpness);
    fillTags(patch.diagonalSharpness, level.diagonalSharpness);
    level.crossedFaces = patch.crossedFaces;
    fillTags(patch.vertSharpness, level.vertSharpness);
    level.nonManifoldVerts = patch.nonManifoldVerts;
    level.lineEdges.clear();
    for (std::size_t i = 0; i < patch.lines.size(); ++i) {
        level.lineEdges.push_back({level.faceEdges[patch.lineCorners[i]], patch.lines[i]});
    }
    level.sharpVerts = patch.sharpVerts;
    level.CornerTags::operator=(patch);
    level.sharpEnds = patch.sharpEnds;
    level.irregularVerts = patch.irregularVerts;
    level.numHexagonalSteps = patch.numHexagonalSteps;
    level.hasFirstLineMasks = patch.hasFirstLineMasks;
}

void PatchRefinement::ApplyLeft(std::vector<double> const &left,
                                std::vector<double> &result) const {
    result.assign(numParentVerts, 0.0);
    for (std::size_t row = 0; row < left.size(); ++row) {
        for (int k = firsts[row]; k < firsts[row + 1]; ++k) {
            result[verts[k]] += left[row] * weights[k];
        }
    }
}

void PatchRefinement::ApplyRight(std::vector<double> const &right,
                                 std::vector<double> &result) const {
    result.assign(firsts.size() - 1, 0.0);
    for (std::size_t row = 0; row < result.size(); ++row) {
        for (int k = firsts[row]; k < firsts[row + 1]; ++k) {
            result[row] += weights[k] * right[verts[k]];
        }
    }
}

namespace {

// Appends rows, their columns ascending, to a step.
class RowAppender {
public:
    explicit RowAppender(PatchRefinement &step)
        : _step(step), _sums(std::size_t(step.numParentVerts)),
          _hasSum(std::size_t(step.numParentVerts) / kWordBits + 1) {}

    // Adds to a column of the next row; sums are in the order in which these come.
    void Add(Index column, double weight) {
        auto const place = std::size_t(column);
        std::uint64_t &word = _hasSum[place / kWordBits];
        std::uint64_t const bit = std::uint64_t(1) << place % kWordBits;
        _sums[place] = (word & bit) != 0 ? _sums[place] + weight : weight;
        word |= bit;
    }

    void EndRow() {
        for (std::size_t i = 0; i < _hasSum.size(); ++i) {
            for (std::size_t place = i * kWordBits; _hasSum[i] != 0; ++place, _hasSum[i] >>= 1) {
                if ((_hasSum[i] & 1) != 0) {
                    _step.verts.push_back(int(place));
                    _step.weights.push_back(_sums[place]);
                }
            }
        }
        _step.firsts.push_back(int(_step.verts.size()));
    }

private:
    static constexpr std::size_t kWordBits = 64;

    PatchRefinement &_step;
    std::vector<double> _sums; // by column
    std::vector<std::uint64_t> _hasSum;
};

// Around a V-vertex the children of edges take the place of faces: the first edge of a closed fan
// comes last, and so does the side that begins there.
std::vector<int> mapSides(Level const &pLevel, LimitPatch const &cPatch) {
    std::vector<int> result;
    ForEachFanItems(pLevel, 0, [&](FanItems const &fan) {
        int const first = int(result.size());
        int const numSides = countSides(fan);
        int const shift = fan.isClosed && isBreak(fan.items.front());
        for (int side = 0; side < numSides; ++side) {
            result.push_back(cPatch.sides[first + (side + numSides - shift) % numSides]);
        }
    });
    return result;
}

} // namespace

PatchRefinement MakePatchStep(Refinement const &refinement, HexSchemeOptions const &schemeOptions,
                              Interpolation interpolation, std::vector<Index> const &cVerts) {
    std::shared_ptr<RefinementRules const> const rules =
        GetRules(*refinement.parent, schemeOptions, interpolation);
    PatchRefinement step;
    step.numParentVerts = refinement.parent->numVertices;
    step.firsts.reserve(cVerts.size() + 1);
    step.firsts.push_back(0);
    constexpr std::size_t kUsualSize = 16; // of rows
    step.verts.reserve(cVerts.size() * kUsualSize);
    step.weights.reserve(cVerts.size() * kUsualSize);
    RowAppender appender(step);
    for (Index cVert : cVerts) {
        ForEachParentWeight(refinement, *rules, cVert,
                            [&](Index pVert, double weight) { appender.Add(pVert, weight); });
        appender.EndRow();
    }
    return step;
}

PatchRefinement RefinePatch(LimitPatch const &pPatch, Sdc::Options sdcOptions,
                            HexSchemeOptions const &schemeOptions, LimitPatch &cPatch) {
    Level parent;
    Level child;
    Refinement refinement;
    BuildPatchLevel(pPatch, parent);
    RefineHexagonally(parent, {sdcOptions, schemeOptions.faceMask}, true, refinement, child);
    LimitPatchGatherer(child, sdcOptions, schemeOptions.faceMask)
        .Gather(refinement.GetVertexChildVertex(0), cPatch);

    PatchRefinement step =
        MakePatchStep(refinement, schemeOptions, Interpolation::Vertex, cPatch.sources);
    step.sides = mapSides(parent, cPatch);
    return step;
}

std::vector<VertexSide> FindVertexSides(Level const &level, Index vert) {
    std::vector<VertexSide> sides;
    int fanIndex = 0;
    ForEachFanItems(level, vert, [&](FanItems &fan) {
        std::vector<FanItem> &items = fan.items;
        int const numBreaks = countBreaks(fan);
        if (fan.isClosed && numBreaks > 0) {
            std::rotate(items.begin(), std::find_if(items.begin(), items.end(), isBreak),
                        items.end());
        }
        if (numBreaks < 2) {
            sides.push_back({items, fan.isClosed, fanIndex++});
            return;
        }
        if (fan.isClosed) {
            items.push_back(items.front());
        }
        auto begin = items.begin();
        for (auto item = begin + 1; item != items.end(); ++item) {
            if (isBreak(*item) || item + 1 == items.end()) {
                sides.push_back({std::vector<FanItem>(begin, item + 1), false, fanIndex});
                begin = item;
            }
        }
        ++fanIndex;
    });
    return sides;
}

} // namespace OpenSubdivHex::FarExt::internal
