// SPDX-License-Identifier: Apache-2.0
#include "preparedRefinement.h"

#include "far_ext/vtr/indexSet.h"
#include "far_ext/vtr/parallel.h"
#include "far_ext/vtr/runs.h"
#include "far_ext/vtr/truncationMask.h"

#include <algorithm>
#include <numeric>
#include <unordered_map>

namespace OpenSubdivHex::OsdExt::internal {

using Far::Index;
using FarExt::internal::FaceRule;
using FarExt::internal::ForEachRun;
using FarExt::internal::InsertUnique;
using FarExt::internal::Level;
using FarExt::internal::ParallelFor;
using FarExt::internal::Refinement;
using FarExt::internal::RefinementRules;
using FarExt::internal::SortUnique;
using FarExt::internal::VertexRule;

namespace {

constexpr int kMaxUnrolledSize = 6;
constexpr int kFVertexFaces = 3; ///< around an F-vertex, at most
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
    explicit FaceRunMaker(Level const &level) : _numFFaces(GetNumFFaces(level)) {}

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

// The masks of hexagons with dense rules, by the number of the rule.
std::vector<DenseFaceMask> makeDenseMasks(RefinementRules const &rules) {
    std::vector<DenseFaceMask> masks(std::size_t(rules.GetNumDenseRules()));
    for (std::size_t number = 0; number < masks.size(); ++number) {
        FaceRule const rule = rules.GetDenseRule(int(number));
        if (rule.GetSize() != DenseFaceMask::kSize) {
            continue;
        }
        for (int corner = 0; corner < DenseFaceMask::kSize; ++corner) {
            for (int vert = 0; vert < DenseFaceMask::kSize; ++vert) {
                masks[number].weights[vert][corner] = Spread(float(rule.GetRow(corner)[vert]));
            }
        }
    }
    return masks;
}

// Makes runs of the vertices of a group that follow one another.
class VertexRunMaker {
public:
    explicit VertexRunMaker(Level const &level) : _firstFaces(level.vertFirstFace.data()) {}

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

// The faces that are in no run: those with dense rules that are no hexagons, and those that need exact access
// (see PreparedRefinement).
std::vector<Index> findWeightedFaces(RefinementRules const &rules, Level const &parent) {
    std::vector<Index> faces;
    rules.ForEachDenseFace(0, parent.numFaces, [&](Index face, int rule) {
        if (rules.GetDenseRule(rule).GetSize() != DenseFaceMask::kSize) {
            faces.push_back(face);
        }
    });
    if (parent.numVertices > 0) {
        for (Index const face : parent.GetVertexFaces(parent.numVertices - 1)) {
            if (parent.GetFaceSize(face) <= kMaxUnrolledSize) {
                InsertUnique(faces, face);
            }
        }
    }
    return faces;
}

// The vertices that are in no run: those with rules of their own, and those that need exact access.
std::vector<Index> findWeightedVertices(RefinementRules const &rules,
                                        Refinement const &refinement) {
    Level const &parent = *refinement.parent;
    if (!refinement.vVertexParents.empty()) {
        // All, since those that are plain keep their index.
        return std::vector<Index>(refinement.vVertexParents.begin(),
                                  refinement.vVertexParents.end());
    }
    std::vector<Index> verts;
    if (refinement.child->numVVertices > 0) {
        verts.reserve(rules.GetRuledVertices().size() + 2);
        for (RefinementRules::RuledVertex const &ruled : rules.GetRuledVertices()) {
            verts.push_back(ruled.vert);
        }
        InsertUnique(verts, parent.numVertices - 1);
        if (parent.numCorners > 0) {
            InsertUnique(verts, parent.faceVerts[parent.numCorners - 1]);
        }
    }
    return verts;
}

// The weights of faces that are in no run, each rule once.
class FaceWeightLister {
public:
    FaceWeightLister(RefinementRules const &rules, std::vector<float> &weights)
        : _rules(rules), _weights(weights) {}

    // The position of those of a face, row by row.
    std::size_t Find(Index face) {
        FaceRule const rule = _rules.GetFaceRule(face);
        // Of circulant rules, which are told by the size, negative numbers.
        int const key = rule.IsCirculant() ? -rule.GetSize() : _rules.FindRun(face)->rule;
        auto const [found, isNew] = _positions.try_emplace(key, _weights.size());
        if (isNew) {
            for (int corner = 0; corner < rule.GetSize(); ++corner) {
                double const *const row = rule.GetRow(corner);
                _weights.insert(_weights.end(), row, row + rule.GetSize());
            }
        }
        return found->second;
    }

private:
    RefinementRules const &_rules;
    std::vector<float> &_weights;
    std::unordered_map<int, std::size_t> _positions;
};

// Groups all faces of the level, and lists the weights of those that are in no run.
void makeFaces(RefinementRules const &rules, Level const &parent,
               std::vector<Group> const &groupOfTile, TileMap const &tileMap,
               PreparedRefinement &prepared) {
    std::vector<Index> const indices = findWeightedFaces(rules, parent);
    std::vector<WeightedFace> weighted;
    std::vector<Group> groupOfWeighted;
    FaceWeightLister weights(rules, prepared.faceWeights);
    FaceRunMaker runs(parent);
    for (TileMap::Run const &run : tileMap.GetFaceRuns()) {
        Group const group = groupOfTile[run.tile];
        ForEachRun(
            run.begin, run.end, indices,
            [&](Index begin, Index end, Index) { runs.Add(begin, end, run.size, group); },
            [&](Index face, Index) {
                Far::ConstIndexArray const verts = parent.GetFaceVertices(face);
                weighted.push_back({parent.faceFirstCorner[std::size_t(face)], verts.size(),
                                    verts.begin(), weights.Find(face)});
                groupOfWeighted.push_back(group);
            });
    }
    prepared.weightedFaces = makeGroups(weighted, groupOfWeighted, prepared.numTiles);
    prepared.faceRuns = runs.Take(prepared.numTiles);
}

WeightedVertex makeWeightedVertex(VertexRule const &rule, Refinement const &refinement,
                                  Index vert) {
    WeightedVertex vertex = {vert,
                             refinement.GetVertexChildVertex(vert),
                             float(rule.weights[rule.numSources - 1]),
                             float(rule.faceWeight),
                             {vert, vert},
                             {0, 0}};
    for (int i = 0; i + 1 < rule.numSources; ++i) {
        vertex.neighbors[i] = rule.sources[i];
        vertex.neighborWeights[i] = float(rule.weights[i]);
    }
    return vertex;
}

// Groups all vertices of a level that make a V-vertex, from first to last.
class VertexGrouper {
public:
    VertexGrouper(RefinementRules const &rules, Refinement const &refinement,
                  std::vector<Group> const &groupOfTile, PreparedRefinement &prepared)
        : _rules(rules), _refinement(refinement), _parent(*refinement.parent),
          _groupOfTile(groupOfTile), _prepared(prepared),
          _arePlain(refinement.child->numVVertices == _parent.numVertices),
          _weightedVerts(findWeightedVertices(rules, refinement)),
          _nextWeighted(_weightedVerts.begin()), _nextRuled(rules.GetRuledVertices().begin()),
          _batches(prepared.numTiles), _runs(_parent) {
        if (_arePlain && prepared.masks.averagesFaces && _parent.isHexagonal) {
            _levelOfNewVertices = prepared.before;
            if (prepared.before->isHexagonal && prepared.before->numSharpBoundariesA == 0 &&
                prepared.before->numSharpBoundariesB == 0) {
                _levelOfOlderVertices = prepared.beforeThat;
            }
        }
    }

    void AddFirstVertices(std::vector<TileMap::Run> const &runs) {
        for (TileMap::Run const &run : runs) {
            add(run.begin, run.end, groupOf(run.tile));
        }
    }
    // The F-vertices that an earlier refinement made of the faces of its parent.
    void AddFVertices(Refinement const &earlier, std::vector<TileMap::Run> const &runs) {
        Level const &level = *earlier.parent;
        bool const areNew = &level == _levelOfNewVertices;
        bool const areOlder = &level == _levelOfOlderVertices;
        auto const addFVertices = [&](Index begin, Index end, Group group) {
            Index const *const corners = level.faceFirstCorner.data();
            add(earlier.GetCornerChildVertex(corners[begin]),
                earlier.GetCornerChildVertex(corners[end]), group);
        };
        std::vector<Index> exceptions = findFacesOfWeighted(earlier);
        if (areNew) {
            for (Index const edge : level.boundaryEdges) {
                exceptions.push_back(level.edgeFaces[std::size_t(edge)][0]);
            }
        }
        SortUnique(exceptions);
        FaceRunMaker others(level);
        for (TileMap::Run const &run : runs) {
            Group const group = groupOf(run.tile);
            if (!areNew && !areOlder) {
                addFVertices(run.begin, run.end, group);
                continue;
            }
            ForEachRun(
                run.begin, run.end, exceptions,
                [&](Index begin, Index end, Index) {
                    addToGroups(begin, end, run.size, group,
                                [&](Index first, Index last, Group groupOfPart) {
                                    others.Add(first, last, run.size, groupOfPart);
                                });
                },
                [&](Index face, Index) { addFVertices(face, face + 1, group); });
        }
        if (areNew) {
            _newVertexFaces = std::move(others);
            if (!_levelOfOlderVertices) {
                listStartCorners(earlier);
            }
        } else if (areOlder) {
            _olderVertexFaces = std::move(others);
        }
    }
    void End() {
        if (_prepared.masks.averagesFaces) {
            listCorners();
        }
        int const numGroups = _batches.GetNumGroups();
        _prepared.newVertexFaces = _newVertexFaces.Take(numGroups);
        _prepared.olderVertexFaces = _olderVertexFaces.Take(numGroups);
        _prepared.vertexRuns = _runs.Take(numGroups);
        _prepared.weightedVertices = makeGroups(_weighted, _groupOfWeighted, numGroups);
    }

private:
    Group groupOf(TileMap::Tile tile) const {
        return tile == TileMap::kNoTile ? kBetween : _groupOfTile[tile];
    }
    // The faces that made vertices with weights of their own.
    std::vector<Index> findFacesOfWeighted(Refinement const &earlier) const {
        std::vector<Index> faces;
        Index const endVert = earlier.GetCornerChildVertex(earlier.parent->numCorners);
        for (auto vert = _nextWeighted; vert != _weightedVerts.end() && *vert < endVert; ++vert) {
            faces.push_back(earlier.parent->FindFaceOfCorner(earlier.GetChildVertexCorner(*vert)));
        }
        return faces;
    }
    void listStartCorners(Refinement const &earlier) {
        Index const numCorners = earlier.parent->numCorners;
        _prepared.startCorners.Resize(std::size_t(numCorners));
        ParallelFor(numCorners, [&](Index corner) {
            // The last of three faces around an F-vertex is the E-face of the edge from its corner.
            Index const vert = earlier.GetCornerChildVertex(corner);
            Index const end = _parent.vertFirstFace[std::size_t(vert) + 1];
            _prepared.startCorners[std::size_t(corner)] = _parent.GetVertexCorner(end - 1);
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
    // Vertices without weights of their own.
    void addRuns(Index begin, Index end, Group group) {
        if (!_arePlain) {
            return;
        }
        addToGroups(begin, end, 1, group, [&](Index first, Index last, Group groupOfPart) {
            _runs.Add(first, last, groupOfPart);
        });
    }
    void add(Index begin, Index end, Group group) {
        for (; _nextWeighted != _weightedVerts.end() && *_nextWeighted < end; ++_nextWeighted) {
            Index const vert = *_nextWeighted;
            addRuns(begin, vert, group);
            addToGroups(vert, vert + 1, 1, group, [&](Index, Index, Group groupOfVertex) {
                _weighted.push_back(makeWeightedVertex(getNextRule(vert), _refinement, vert));
                _groupOfWeighted.push_back(groupOfVertex);
            });
            begin = vert + 1;
        }
        addRuns(begin, end, group);
    }
    // The rule of the next weighted vertex.
    VertexRule getNextRule(Index vert) {
        while (_nextRuled != _rules.GetRuledVertices().end() && _nextRuled->vert < vert) {
            ++_nextRuled;
        }
        bool const isRuled =
            _nextRuled != _rules.GetRuledVertices().end() && _nextRuled->vert == vert;
        return isRuled ? _nextRuled->rule : _rules.GetVertexRule(vert);
    }
    void listCorners() {
        _prepared.vertCorners.Resize(_runs.GetNumCorners());
        ParallelFor(Index(_runs.GetRuns().size()), [&](Index i) {
            VertexRun const &run = _runs.GetRuns()[std::size_t(i)];
            Index const first = _parent.vertFirstFace[std::size_t(run.begin)];
            Index const last = _parent.vertFirstFace[std::size_t(run.end)];
            for (Index k = first; k < last; ++k) {
                _prepared.vertCorners[run.firstCorner + std::size_t(k - first)] =
                    _parent.GetVertexCorner(k);
            }
        });
    }

    RefinementRules const &_rules;
    Refinement const &_refinement;
    Level const &_parent;
    std::vector<Group> const &_groupOfTile;
    PreparedRefinement &_prepared;
    bool const _arePlain; // those that are not weighted; else there are no others
    std::vector<Index> const _weightedVerts;
    std::vector<Index>::const_iterator _nextWeighted;
    std::vector<RefinementRules::RuledVertex>::const_iterator _nextRuled;
    std::vector<WeightedVertex> _weighted;
    std::vector<Group> _groupOfWeighted;
    BatchMaker _batches;
    VertexRunMaker _runs;
    FaceRunMaker _newVertexFaces;
    FaceRunMaker _olderVertexFaces;
    // Null where their vertices have no kernel of their own.
    Level const *_levelOfNewVertices = nullptr;
    Level const *_levelOfOlderVertices = nullptr;
};

PlainMasks makePlainMasks(RefinementRules const &rules, Level const &parent) {
    PlainMasks masks;
    int maxValence = kFVertexFaces;
    Index const end = std::min(parent.numVertsOfAnyValence, parent.numVertices);
    for (Index vert = 0; vert < end; ++vert) {
        maxValence = std::max(maxValence, parent.GetNumVertexFaces(vert));
    }
    for (int numFaces = 0; numFaces <= maxValence; ++numFaces) {
        FarExt::VertexVertexMask const vertexMask = rules.GetPlainVertexMask(numFaces);
        masks.verticesInverse.push_back(float(vertexMask.vertexWeight));
    }
    masks.averagesFaces = rules.GetPlainVertexMask(1).faceWeight != 0;
    for (Index const size : parent.faceSizes) {
        masks.faces.resize(std::size_t(size) + 1);
        masks.faces[std::size_t(size)] = MakePlainFaceMask(rules.GetCirculantRule(size));
    }
    return masks;
}

// All that a truncation makes.
void listVertices(Refinement const &refinement, FarExt::Interpolation interpolation,
                  PreparedRefinement &prepared) {
    constexpr Index kTile = 1024;
    Index const numVertices = refinement.child->numVertices;
    FarExt::internal::TruncationMask const mask(refinement, interpolation);
    FarExt::internal::TruncationMask::Sources sources;
    prepared.parent = refinement.parent;
    prepared.numTiles = numVertices / kTile + 1;
    prepared.vertexRuns.firsts.assign(std::size_t(prepared.numTiles) + 1, 0);
    Groups<ListedVertex> &groups = prepared.listedVertices;
    groups.firsts.clear();
    groups.items.Resize(std::size_t(numVertices));
    for (Index cVert = 0; cVert < numVertices; ++cVert) {
        if (cVert % kTile == 0) {
            groups.firsts.push_back(std::size_t(cVert));
        }
        mask.GetSources(cVert, sources);
        groups.items[std::size_t(cVert)] = {cVert, int(sources.verts.size()),
                                            prepared.listedSources.size()};
        prepared.listedSources.insert(prepared.listedSources.end(), sources.verts.begin(),
                                      sources.verts.end());
        prepared.listedWeights.insert(prepared.listedWeights.end(), sources.weights.begin(),
                                      sources.weights.end());
    }
    groups.firsts.resize(std::size_t(prepared.numTiles) + 1, std::size_t(numVertices));
}

} // namespace

PlainFaceMask MakePlainFaceMask(FaceRule const &circulant) {
    int const size = circulant.GetSize();
    double const *const weights = circulant.GetRow(0);
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
    double const all = weights[size > PlainFaceMask::kMinSize ? 2 : 1];
    mask.self = float(weights[0] - all);
    mask.neighbor = float(weights[1] - all);
    // Of two that are the same but for rounding, none is there for the kernel.
    mask.opposite = hasOpposite ? float(weights[size / 2]) - float(all) : 0;
    mask.all = float(all);
    return mask;
}

int GetNumTiles(Level const &lastParent) {
    Index const numCorners = lastParent.numCorners;
    return numCorners / std::clamp(numCorners / kTilesPerLevel, kMinTileCorners, kMaxTileCorners) +
           1;
}

Index GetNumFFaces(Level const &level) { return level.isHexagonal ? level.numFFaces : 0; }

void PrepareRefinement(std::shared_ptr<RefinementRules const> const &rules,
                       std::vector<Refinement const *> const &refinements, TileMap const &tileMap,
                       PreparedRefinement &prepared) {
    Refinement const &refinement = *refinements.back();
    if (refinement.isTruncation) {
        listVertices(refinement, rules->GetInterpolation(), prepared);
        return;
    }
    Level const &parent = *refinement.parent;
    std::size_t const numBefore = refinements.size() - 1;
    prepared.numVVertices = refinement.child->numVVertices;
    prepared.rules = rules;
    prepared.masks = makePlainMasks(*rules, parent);
    prepared.denseMasks = makeDenseMasks(*rules);
    prepared.parent = &parent;
    prepared.before = numBefore > 0 ? refinements[numBefore - 1]->parent : nullptr;
    prepared.beforeThat = numBefore > 1 ? refinements[numBefore - 2]->parent : nullptr;
    prepared.numTiles =
        std::min(parent.numCorners / kMinJoinedTileCorners + 1, tileMap.GetNumTiles());
    std::vector<Group> groupOfTile(std::size_t(tileMap.GetNumTiles()));
    for (int tile = 0; tile < tileMap.GetNumTiles(); ++tile) {
        groupOfTile[std::size_t(tile)] = tile * prepared.numTiles / tileMap.GetNumTiles();
    }
    makeFaces(*rules, parent, groupOfTile, tileMap, prepared);

    VertexGrouper vertices(*rules, refinement, groupOfTile, prepared);
    vertices.AddFirstVertices(tileMap.GetFirstVertexRuns());
    std::vector<std::vector<TileMap::Run>> const &fVertexRuns = tileMap.GetFVertexRuns();
    for (std::size_t i = 0; i < fVertexRuns.size(); ++i) {
        vertices.AddFVertices(*refinements[numBefore - fVertexRuns.size() + i], fVertexRuns[i]);
    }
    vertices.End();
}

} // namespace OpenSubdivHex::OsdExt::internal
