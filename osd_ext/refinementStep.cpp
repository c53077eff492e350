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
constexpr Index kMinJoinedTileCorners = 4096;
/// Vertices that a thread takes at a time of those between the tiles.
constexpr Index kVertexBatch = 256;

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
    FaceRunMaker() = default;
    explicit FaceRunMaker(LevelTopology const &level) : _numFFaces(GetNumFFaces(level)) {}

    void Add(Index begin, Index end, int size, Group group) {
        if (begin < _numFFaces && _numFFaces < end) {
            append(begin, _numFFaces, size, group);
            begin = _numFFaces;
        }
        append(begin, end, size, group);
    }
    Groups<IndexRun> Take(int numGroups) const { return makeGroups(_runs, _groupOf, numGroups); }

private:
    void append(Index begin, Index end, int size, Group group) {
        if (begin == end) {
            return;
        }
        if (begin != _numFFaces && !_runs.empty() && _runs.back().end == begin && _size == size &&
            _groupOf.back() == group) {
            _runs.back().end = end;
        } else {
            _runs.push_back({begin, end});
            _groupOf.push_back(group);
            _size = size;
        }
    }

    Index _numFFaces = 0;
    std::vector<IndexRun> _runs;
    std::vector<Group> _groupOf;
    int _size = 0; // of the faces of the last run
};

// Some of the indices of a level, ascending, that runs are to be parted at, one after the other.
class Partition {
public:
    explicit Partition(std::vector<Index> const &indices)
        : _next(indices.begin()), _end(indices.end()) {}

    // Calls addSingle(i) for those in [begin, end), and addRest(begin, end) for what lies between.
    template <class ADD_REST, class ADD_SINGLE>
    void Part(Index begin, Index end, ADD_REST addRest, ADD_SINGLE addSingle) {
        for (_next = std::lower_bound(_next, _end, begin); _next != _end && *_next < end; ++_next) {
            addRest(begin, *_next);
            addSingle(*_next);
            begin = *_next + 1;
        }
        addRest(begin, end);
    }

private:
    std::vector<Index>::const_iterator _next;
    std::vector<Index>::const_iterator _end;
};

// Makes runs of the vertices of a group that follow one another.
class VertexRunMaker {
public:
    explicit VertexRunMaker(LevelTopology const &level) : _firstFaces(level.vertFirstFace.data()) {}

    void Add(Index begin, Index end, Group group) {
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

    std::vector<VertexRun> const &GetRuns() const { return _runs; }
    std::size_t GetNumCorners() const { return _numCorners; }
    Groups<VertexRun> Take(int numGroups) const { return makeGroups(_runs, _groupOf, numGroups); }

private:
    Index const *_firstFaces;
    std::size_t _numCorners = 0;
    std::vector<VertexRun> _runs;
    std::vector<Group> _groupOf;
};

// The groups of the vertices between the tiles, behind those of the tiles: some vertices in each.
class BatchMaker {
public:
    explicit BatchMaker(int numTiles) : _numTiles(numTiles) {}

    // Calls add(begin, end, group) for pieces of [begin, end), things of numVertices vertices each.
    template <class ADD>
    void Split(Index begin, Index end, int numVertices, ADD add) {
        while (begin < end) {
            Index const room = (kVertexBatch - _numBetween % kVertexBatch) / numVertices;
            Index const size = std::min(end - begin, std::max(1, room));
            add(begin, begin + size, _numTiles + _numBetween / kVertexBatch);
            _numBetween += size * numVertices;
            begin += size;
        }
    }
    int GetNumGroups() const { return _numTiles + (_numBetween + kVertexBatch - 1) / kVertexBatch; }

private:
    int _numTiles;
    Index _numBetween = 0;
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
    Partition partition(indices);
    for (TileMap::FaceRun const &run : tileMap.GetFaceRuns()) {
        Group const group = groupOfTile[run.tile];
        partition.Part(
            run.begin, run.end,
            [&](Index begin, Index end) { plain.Add(begin, end, run.size, group); },
            [&](Index face) { addWeighted(face, group); });
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
          _batches(step.numTiles), _plain(_parent) {
        if (_arePlain && step.masks.averagesFaces && _parent.isHexagonal) {
            LevelTopology const *const before = _parent.parent;
            _levelOfNewVertices = before;
            if (before->isHexagonal && before->numSharpBoundariesA == 0 &&
                before->numSharpBoundariesB == 0) {
                _levelOfOlderVertices = before->parent;
            }
        }
    }

    void AddFirstVertices(std::vector<TileMap::Run> const &runs) {
        for (TileMap::Run const &run : runs) {
            add(run.begin, run.end, groupOf(run.tile));
        }
    }
    // The F-vertices of the faces of a level before.
    void AddFVertices(LevelTopology const &level, std::vector<TileMap::FaceRun> const &runs) {
        bool const areNew = &level == _levelOfNewVertices;
        bool const areOlder = &level == _levelOfOlderVertices;
        auto const addFVertices = [&](Index begin, Index end, Group group) {
            Index const *const corners = level.faceFirstCorner.data();
            add(level.GetCornerChildVertex(corners[begin]),
                level.GetCornerChildVertex(corners[end]), group);
        };
        std::vector<Index> irregular = findFacesOfWeighted(level);
        if (areNew) {
            for (Index const edge : level.boundaryEdges) {
                irregular.push_back(level.edgeFaces[2 * std::size_t(edge)]);
            }
        }
        sortUnique(irregular);
        FaceRunMaker regular(level);
        Partition partition(irregular);
        for (TileMap::FaceRun const &run : runs) {
            Group const group = groupOf(run.tile);
            if (!areNew && !areOlder) {
                addFVertices(run.begin, run.end, group);
                continue;
            }
            partition.Part(
                run.begin, run.end,
                [&](Index begin, Index end) {
                    addToGroups(begin, end, run.size, group,
                                [&](Index first, Index last, Group groupOfPart) {
                                    regular.Add(first, last, run.size, groupOfPart);
                                });
                },
                [&](Index face) { addFVertices(face, face + 1, group); });
        }
        if (areNew) {
            _newVertexFaces = std::move(regular);
            if (!_levelOfOlderVertices) {
                listStartCorners(level);
            }
        } else if (areOlder) {
            _olderVertexFaces = std::move(regular);
        }
    }
    void End() {
        if (_step.masks.averagesFaces) {
            listCorners();
        }
        int const numGroups = _batches.GetNumGroups();
        _step.newVertexFaces = _newVertexFaces.Take(numGroups);
        _step.olderVertexFaces = _olderVertexFaces.Take(numGroups);
        _step.plainVertices = _plain.Take(numGroups);
        _step.weightedVertices = makeGroups(_weighted, _groupOfWeighted, numGroups);
    }

private:
    Group groupOf(TileMap::Tile tile) const {
        return tile == TileMap::kNoTile ? kBetween : _groupOfTile[tile];
    }
    // The faces of a level that made vertices with weights of their own.
    std::vector<Index> findFacesOfWeighted(LevelTopology const &level) const {
        std::vector<Index> faces;
        Index const endVert = level.GetCornerChildVertex(level.numCorners);
        for (auto vert = _nextWeighted; vert != _weightedVerts.end() && *vert < endVert; ++vert) {
            Index const *const next =
                std::upper_bound(level.faceFirstCorner.begin(), level.faceFirstCorner.end(),
                                 level.GetChildVertexCorner(*vert));
            faces.push_back(Index(next - level.faceFirstCorner.begin()) - 1);
        }
        return faces;
    }
    void listStartCorners(LevelTopology const &level) {
        _step.startCorners.Resize(std::size_t(level.numCorners));
        ParallelFor(level.numCorners, [&](Index corner) {
            // The last of three faces around an F-vertex is the E-face of the edge from its corner.
            Index const vert = level.GetCornerChildVertex(corner);
            Index const end = _parent.vertFirstFace[std::size_t(vert) + 1];
            _step.startCorners[std::size_t(corner)] = _parent.GetVertexCorner(end - 1);
        });
    }
    // Calls add(begin, end, group) for [begin, end), things of numVertices vertices each, or for
    // pieces of it.
    template <class ADD>
    void addToGroups(Index begin, Index end, int numVertices, Group group, ADD add) {
        if (group == kBetween) {
            _batches.Split(begin, end, numVertices, add);
        } else {
            add(begin, end, group);
        }
    }
    void addPlain(Index begin, Index end, Group group) {
        if (_arePlain) {
            addToGroups(begin, end, 1, group, [&](Index first, Index last, Group groupOfPart) {
                _plain.Add(first, last, groupOfPart);
            });
        }
    }
    void add(Index begin, Index end, Group group) {
        for (; _nextWeighted != _weightedVerts.end() && *_nextWeighted < end; ++_nextWeighted) {
            Index const vert = *_nextWeighted;
            addPlain(begin, vert, group);
            addToGroups(vert, vert + 1, 1, group, [&](Index, Index, Group groupOfVertex) {
                _weighted.push_back(makeWeightedVertex(_mask, _parent, vert));
                _groupOfWeighted.push_back(groupOfVertex);
            });
            begin = vert + 1;
        }
        addPlain(begin, end, group);
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
    BatchMaker _batches;
    VertexRunMaker _plain;
    FaceRunMaker _newVertexFaces;
    FaceRunMaker _olderVertexFaces;
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
    vertices.AddFirstVertices(tileMap.GetFirstVertexRuns());
    std::vector<std::vector<TileMap::FaceRun>> const &fVertexRuns = tileMap.GetFVertexRuns();
    std::vector<LevelTopology const *> levels(fVertexRuns.size());
    LevelTopology const *level = &topology;
    for (auto it = levels.rbegin(); it != levels.rend(); ++it) {
        *it = level = level->parent;
    }
    for (std::size_t i = 0; i < levels.size(); ++i) {
        vertices.AddFVertices(*levels[i], fVertexRuns[i]);
    }
    vertices.End();
}

} // namespace OpenSubdivHex::OsdExt::internal
