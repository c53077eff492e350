// SPDX-License-Identifier: Apache-2.0
#include "refinementStep.h"

#include "far_ext/parallel.h"

#include <algorithm>
#include <numeric>

namespace OpenSubdivHex::OsdExt::internal {

using Far::Index;
using FarExt::TopologyLevel;
using FarExt::internal::LevelTopology;
using FarExt::internal::ParallelFor;
using FarExt::internal::RefinementMask;

namespace {

constexpr int kMinPlainSize = 3;
constexpr int kMaxUnrolledSize = 6;
/// Corners of a tile in the last level that is refined, a sixteenth of the level's between these
/// bounds: 1.5 MiB of new points of length 3 at most.
constexpr Index kMinTileCorners = 32768;
constexpr Index kMaxTileCorners = 131072;
constexpr Index kTilesPerLevel = 16;
/// Corners of a tile, at least, in the levels before, where tiles are joined.
constexpr Index kMinJoinedTileCorners = 8192;
/// Vertices that a thread takes at a time of those between the tiles.
constexpr Index kVertexBatch = 1024;

using Group = int;
constexpr Group kBetween = -1; ///< of vertices whose faces are in several tiles

PlainFaceMask makePlainFaceMask(double const *weights, int size) {
    PlainFaceMask mask;
    bool const hasOpposite = size == kMaxUnrolledSize;
    bool isOrdinary = weights[1] == weights[size - 1];
    for (int j = 2; j <= size - 2; ++j) {
        isOrdinary &= weights[j] == weights[2] || (hasOpposite && j == size / 2);
    }
    if (!isOrdinary) {
        mask.weights.assign(weights, weights + size);
        mask.weights.insert(mask.weights.end(), weights, weights + size);
        return mask;
    }
    double const all = weights[size > kMinPlainSize ? 2 : 1];
    mask.self = float(weights[0] - all);
    mask.neighbor = float(weights[1] - all);
    mask.opposite = hasOpposite ? float(weights[size / 2] - all) : 0;
    mask.all = float(all);
    return mask;
}

// Sorts items into groups, in the order in which they stand: number i is in group groupOf[i].
template <class ITEM>
Groups<ITEM> makeGroups(std::vector<ITEM> const &items, std::vector<Group> const &groupOf,
                        int numGroups) {
    Groups<ITEM> groups;
    groups.firsts.assign(std::size_t(numGroups) + 1, 0);
    for (Group const group : groupOf) {
        ++groups.firsts[std::size_t(group) + 1];
    }
    std::partial_sum(groups.firsts.begin(), groups.firsts.end(), groups.firsts.begin());
    groups.items.Resize(items.size());
    std::vector<std::size_t> next = groups.firsts;
    for (std::size_t i = 0; i < items.size(); ++i) {
        groups.items[next[std::size_t(groupOf[i])]++] = items[i];
    }
    return groups;
}

// Makes runs of the faces of a group that follow one another, each of faces of one size, and of
// F-faces or others.
class FaceRunMaker {
public:
    explicit FaceRunMaker(LevelTopology const &level)
        : _firstCorners(level.faceFirstCorner.data()), _numFFaces(GetNumFFaces(level)) {}

    void Add(Index begin, Index end, Group group) {
        while (begin < end) {
            Index const size = _firstCorners[begin + 1] - _firstCorners[begin];
            Index const limit = begin < _numFFaces ? std::min(end, _numFFaces) : end;
            Index runEnd = begin + 1;
            while (runEnd < limit && _firstCorners[runEnd + 1] - _firstCorners[runEnd] == size) {
                ++runEnd;
            }
            if (begin != _end || group != _group || size != _size || begin == _numFFaces) {
                _runs.push_back({begin, begin});
                _groupOf.push_back(group);
                _group = group;
                _size = size;
            }
            _end = _runs.back().end = begin = runEnd;
        }
    }
    Groups<IndexRun> Take(int numGroups) const { return makeGroups(_runs, _groupOf, numGroups); }

private:
    Index const *_firstCorners;
    Index _numFFaces;
    std::vector<IndexRun> _runs;
    std::vector<Group> _groupOf;
    // Of the last run.
    Index _end = Far::INDEX_INVALID;
    Group _group = 0;
    Index _size = 0;
};

// Makes runs of the vertices of a group that follow one another, and groups of those between the
// tiles.
class VertexRunMaker {
public:
    VertexRunMaker(LevelTopology const &level, int numTiles)
        : _firstFaces(level.vertFirstFace.data()), _numTiles(numTiles) {}

    void Add(Index begin, Index end, Group group) {
        if (group != kBetween) {
            append(begin, end, group);
            return;
        }
        while (begin < end) {
            Index const size = std::min(end - begin, kVertexBatch - _numBetween % kVertexBatch);
            append(begin, begin + size, nextBatch());
            _numBetween += size;
            begin += size;
        }
    }
    // The group of a vertex that is not part of any run.
    Group AddSingle(Group group) {
        if (group != kBetween) {
            return group;
        }
        Group const batch = nextBatch();
        ++_numBetween;
        return batch;
    }

    int GetNumGroups() const { return _numTiles + (_numBetween + kVertexBatch - 1) / kVertexBatch; }
    std::vector<VertexRun> const &GetRuns() const { return _runs; }
    std::size_t GetNumCorners() const { return _numCorners; }
    Groups<VertexRun> Take() const { return makeGroups(_runs, _groupOf, GetNumGroups()); }

private:
    Group nextBatch() const { return _numTiles + _numBetween / kVertexBatch; }
    void append(Index begin, Index end, Group group) {
        if (begin == end) {
            return;
        }
        if (!_runs.empty() && _runs.back().end == begin && _groupOf.back() == group) {
            _runs.back().end = end;
        } else {
            _runs.push_back({begin, end, _numCorners});
            _groupOf.push_back(group);
        }
        _numCorners += std::size_t(_firstFaces[end] - _firstFaces[begin]);
    }

    Index const *_firstFaces;
    int _numTiles;
    Index _numBetween = 0;
    std::size_t _numCorners = 0;
    std::vector<VertexRun> _runs;
    std::vector<Group> _groupOf;
};

void sortUnique(std::vector<Index> &indices) {
    std::sort(indices.begin(), indices.end());
    indices.erase(std::unique(indices.begin(), indices.end()), indices.end());
}

// The faces that need weights of their own, or exact access (see RefinementStep).
std::vector<Index> findWeightedFaces(RefinementMask const &mask, TopologyLevel const &parent) {
    std::vector<Index> faces = mask.FindFeatureFaces();
    if (parent.GetNumVertices() > 0) {
        for (Index const face : parent.GetVertexFaces(parent.GetNumVertices() - 1)) {
            if (parent.GetFaceVertices(face).size() <= kMaxUnrolledSize) {
                faces.push_back(face);
            }
        }
    }
    sortUnique(faces);
    return faces;
}

std::vector<Index> findWeightedVertices(RefinementMask const &mask, TopologyLevel const &parent) {
    LevelTopology const &topology = parent.GetTopology();
    if (!topology.vVertexParents.empty()) {
        // All, since those that are plain keep their index.
        return std::vector<Index>(topology.vVertexParents.begin(), topology.vVertexParents.end());
    }
    std::vector<Index> verts;
    if (topology.numVVertices > 0) {
        verts = mask.FindFeatureVertices();
        verts.push_back(topology.numVertices - 1);
        if (topology.numCorners > 0) {
            verts.push_back(topology.faceVerts[topology.numCorners - 1]);
        }
        sortUnique(verts);
    }
    return verts;
}

// Groups all faces of the level, and makes the weights of those that need their own.
void makeFaces(RefinementMask const &mask, TopologyLevel const &parent,
               std::vector<Group> const &groupOfTile, TileMap const &tileMap,
               RefinementStep &step) {
    std::vector<Index> const indices = findWeightedFaces(mask, parent);
    std::vector<WeightedFace> weighted;
    std::vector<Group> groupOfWeighted;
    std::vector<double> scratch;
    auto const addWeighted = [&](Index face, Group group) {
        Far::ConstIndexArray const verts = parent.GetFaceVertices(face);
        int const size = verts.size();
        weighted.push_back(
            {parent.GetFaceFirstCorner(face), size, verts.begin(), step.faceWeights.size()});
        groupOfWeighted.push_back(group);
        for (int corner = 0; corner < size; ++corner) {
            double const *const weights = mask.GetFaceVertexWeights(face, corner, scratch);
            step.faceWeights.insert(step.faceWeights.end(), weights, weights + size);
        }
    };
    FaceRunMaker plain(parent.GetTopology());
    TileMap::Tile const *const tiles = tileMap.GetTilesOfFaces().data();
    auto nextWeighted = indices.begin();
    for (Index begin = 0; begin < parent.GetNumFaces();) {
        Group const group = groupOfTile[tiles[begin]];
        if (nextWeighted != indices.end() && *nextWeighted == begin) {
            addWeighted(begin++, group);
            ++nextWeighted;
            continue;
        }
        Index const limit = nextWeighted == indices.end() ? parent.GetNumFaces() : *nextWeighted;
        Index end = begin + 1;
        while (end < limit && tiles[end] == tiles[begin]) {
            ++end;
        }
        plain.Add(begin, end, group);
        begin = end;
    }
    step.weightedFaces = makeGroups(weighted, groupOfWeighted, step.numTiles);
    step.plainFaces = plain.Take(step.numTiles);
}

WeightedVertex makeWeightedVertex(RefinementMask const &mask, LevelTopology const &parent,
                                  Index vert) {
    RefinementMask::VertexMask const weights = mask.GetVertexMask(vert);
    WeightedVertex vertex = {vert,
                             parent.GetVertexChildVertex(vert),
                             float(weights.vertexWeight),
                             float(weights.faceWeight),
                             {vert, vert},
                             {0, 0}};
    for (int i = 0; i < weights.numNeighbors; ++i) {
        vertex.neighbors[i] = weights.neighbors[i];
        vertex.neighborWeights[i] = float(weights.neighborWeights[i]);
    }
    return vertex;
}

// Groups all vertices of a level that make a V-vertex, from first to last.
class VertexGrouper {
public:
    VertexGrouper(RefinementMask const &mask, TopologyLevel const &parent,
                  std::vector<Group> const &groupOfTile, RefinementStep &step)
        : _mask(mask), _parent(parent.GetTopology()), _groupOfTile(groupOfTile), _step(step),
          _arePlain(_parent.numVVertices == _parent.numVertices),
          _weightedVerts(findWeightedVertices(mask, parent)), _nextWeighted(_weightedVerts.begin()),
          _plain(_parent, step.numTiles) {
        if (_arePlain && step.masks.averagesFaces && _parent.isHexagonal) {
            LevelTopology const *const before = _parent.parent;
            _levelOfNewVertices = before;
            if (before->isHexagonal && before->numSharpBoundariesA == 0 &&
                before->numSharpBoundariesB == 0) {
                _levelOfOlderVertices = before->parent;
            }
        }
    }

    void AddFirstVertices(std::vector<TileMap::Tile> const &tiles) {
        for (std::size_t begin = 0; begin < tiles.size();) {
            std::size_t end = begin + 1;
            while (end < tiles.size() && tiles[end] == tiles[begin]) {
                ++end;
            }
            add(Index(begin), Index(end), groupOf(tiles[begin]));
            begin = end;
        }
    }
    // The F-vertices of the faces of a level before.
    void AddFVertices(LevelTopology const &level, std::vector<TileMap::Tile> const &tilesOfFaces) {
        bool const areNew = &level == _levelOfNewVertices;
        bool const areOlder = &level == _levelOfOlderVertices;
        FaceRunMaker regular(level);
        for (Index face = 0; face < level.numFaces; ++face) {
            Group const group = groupOf(tilesOfFaces[std::size_t(face)]);
            Index const *const corners = level.faceFirstCorner.data() + face;
            Index const begin = level.GetCornerChildVertex(corners[0]);
            Index const end = level.GetCornerChildVertex(corners[1]);
            bool const hasWeighted = _nextWeighted != _weightedVerts.end() && *_nextWeighted < end;
            if (group != kBetween && !hasWeighted &&
                (areOlder || (areNew && hasInteriorEdges(level, face)))) {
                regular.Add(face, face + 1, group);
            } else {
                add(begin, end, group);
            }
        }
        if (areNew) {
            _step.newVertexFaces = regular.Take(_step.numTiles);
            if (!_levelOfOlderVertices) {
                listStartCorners(level);
            }
        }
        if (areOlder) {
            _step.olderVertexFaces = regular.Take(_step.numTiles);
        }
    }
    void End() {
        if (_step.masks.averagesFaces) {
            listCorners();
        }
        _step.plainVertices = _plain.Take();
        _step.weightedVertices = makeGroups(_weighted, _groupOfWeighted, _plain.GetNumGroups());
    }

private:
    Group groupOf(TileMap::Tile tile) const {
        return tile == TileMap::kNoTile ? kBetween : _groupOfTile[tile];
    }
    static bool hasInteriorEdges(LevelTopology const &level, Index face) {
        return level.boundaryEdges.empty() ||
               std::none_of(level.faceEdges.begin() + level.faceFirstCorner[std::size_t(face)],
                            level.faceEdges.begin() + level.faceFirstCorner[std::size_t(face) + 1],
                            [&](Index edge) { return level.IsBoundary(edge); });
    }
    void listStartCorners(LevelTopology const &level) {
        _step.startCorners.Resize(std::size_t(level.numCorners));
        Index const firstVertex = level.GetCornerChildVertex(0);
        ParallelFor(level.numCorners, [&](Index corner) {
            // The last of three faces around an F-vertex is the E-face of the edge from its corner.
            Index const end = _parent.vertFirstFace[std::size_t(firstVertex + corner) + 1];
            _step.startCorners[std::size_t(corner)] = _parent.GetVertexCorner(end - 1);
        });
    }
    void add(Index begin, Index end, Group group) {
        for (; _nextWeighted != _weightedVerts.end() && *_nextWeighted < end; ++_nextWeighted) {
            _weighted.push_back(makeWeightedVertex(_mask, _parent, *_nextWeighted));
            _groupOfWeighted.push_back(_plain.AddSingle(group));
            if (_arePlain) {
                _plain.Add(begin, *_nextWeighted, group);
                begin = *_nextWeighted + 1;
            }
        }
        if (_arePlain) {
            _plain.Add(begin, end, group);
        }
    }
    void listCorners() {
        _step.vertCorners.Resize(_plain.GetNumCorners());
        ParallelFor(Index(_plain.GetRuns().size()), [&](Index i) {
            VertexRun const &run = _plain.GetRuns()[std::size_t(i)];
            Index const first = _parent.vertFirstFace[std::size_t(run.begin)];
            Index const last = _parent.vertFirstFace[std::size_t(run.end)];
            for (Index k = first; k < last; ++k) {
                _step.vertCorners[run.firstCorner + std::size_t(k - first)] =
                    _parent.GetVertexCorner(k);
            }
        });
    }

    RefinementMask const &_mask;
    LevelTopology const &_parent;
    std::vector<Group> const &_groupOfTile;
    RefinementStep &_step;
    bool const _arePlain; // those that are not weighted; else there are no others
    std::vector<Index> const _weightedVerts;
    std::vector<Index>::const_iterator _nextWeighted;
    std::vector<WeightedVertex> _weighted;
    std::vector<Group> _groupOfWeighted;
    VertexRunMaker _plain;
    // Null where their vertices have no kernel of their own.
    LevelTopology const *_levelOfNewVertices = nullptr;
    LevelTopology const *_levelOfOlderVertices = nullptr;
};

PlainMasks makePlainMasks(RefinementMask const &mask, TopologyLevel const &parent) {
    PlainMasks masks;
    // F-vertices of a hexagonal step have three faces at most.
    LevelTopology const &topology = parent.GetTopology();
    int maxValence = topology.isHexagonal ? 3 : 0;
    Index const end = topology.isHexagonal ? topology.parent->numVVertices : topology.numVertices;
    Index const *const firstFaces = topology.vertFirstFace.data();
    for (Index vert = 0; vert < end; ++vert) {
        maxValence = std::max(maxValence, firstFaces[vert + 1] - firstFaces[vert]);
    }
    for (int numFaces = 0; numFaces <= maxValence; ++numFaces) {
        FarExt::VertexVertexMask const vertexMask = mask.GetPlainVertexMask(numFaces);
        masks.verticesInverse.push_back(float(vertexMask.vertexWeight));
    }
    masks.averagesFaces = mask.GetPlainVertexMask(1).faceWeight != 0;
    for (Index const size : topology.faceSizes) {
        masks.faces.resize(std::size_t(size) + 1);
        masks.faces[std::size_t(size)] = makePlainFaceMask(mask.GetPlainFaceWeights(size), size);
    }
    return masks;
}

} // namespace

int GetNumTiles(TopologyLevel const &lastParent) {
    Index const numCorners = lastParent.GetNumFaceVertices();
    return numCorners / std::clamp(numCorners / kTilesPerLevel, kMinTileCorners, kMaxTileCorners) +
           1;
}

Index GetNumFFaces(LevelTopology const &level) {
    return level.isHexagonal ? level.parent->numFaces : 0;
}

void MakeRefinementStep(RefinementMask const &mask, TopologyLevel const &parent,
                        TileMap const &tileMap, RefinementStep &step) {
    LevelTopology const &topology = parent.GetTopology();
    step.numVVertices = topology.numVVertices;
    step.masks = makePlainMasks(mask, parent);
    step.parent = &topology;
    step.numTiles =
        std::min(topology.numCorners / kMinJoinedTileCorners + 1, tileMap.GetNumTiles());
    std::vector<Group> groupOfTile(std::size_t(tileMap.GetNumTiles()));
    for (int tile = 0; tile < tileMap.GetNumTiles(); ++tile) {
        groupOfTile[std::size_t(tile)] = tile * step.numTiles / tileMap.GetNumTiles();
    }
    makeFaces(mask, parent, groupOfTile, tileMap, step);

    VertexGrouper vertices(mask, parent, groupOfTile, step);
    vertices.AddFirstVertices(tileMap.GetTilesOfFirstVertices());
    std::vector<std::vector<TileMap::Tile>> const &tilesOfFVertices = tileMap.GetTilesOfFVertices();
    std::vector<LevelTopology const *> levels(tilesOfFVertices.size());
    LevelTopology const *level = &topology;
    for (auto it = levels.rbegin(); it != levels.rend(); ++it) {
        *it = level = level->parent;
    }
    for (std::size_t i = 0; i < levels.size(); ++i) {
        vertices.AddFVertices(*levels[i], tilesOfFVertices[i]);
    }
    vertices.End();
}

} // namespace OpenSubdivHex::OsdExt::internal
