// SPDX-License-Identifier: Apache-2.0
#include "stencilSupports.h"

#include "parallel.h"

#include <algorithm>
#include <bitset>
#include <numeric>

namespace OpenSubdivHex::FarExt::internal {

using Far::Index;

Support SupportArena::Add(Index const *list, int size) {
    constexpr std::size_t kBlock = 16384;
    std::size_t const needed = std::size_t(size) + 1;
    if (needed > _numFree) {
        // The first block is small, for ranges that need little.
        std::size_t const numInBlock = std::max(needed, _blocks.empty() ? kBlock / 16 : kBlock);
        _blocks.emplace_back(new Index[numInBlock]);
        _free = _blocks.back().get();
        _numFree = numInBlock;
    }
    Support const result(_free);
    *_free++ = size;
    _free = std::copy(list, list + size, _free);
    _numFree -= needed;
    return result;
}

void SupportUnion::sort(Support const *supports, int numSupports) {
    _union.clear();
    for (int i = 0; i < numSupports; ++i) {
        _union.insert(_union.end(), supports[i].begin(), supports[i].end());
    }
    std::sort(_union.begin(), _union.end());
    setUnion(_union, std::unique(_union.begin(), _union.end()) - _union.begin());
}

// Whether all sources of a support are in the union, whose sources are stamped.
bool SupportUnion::isCovered(Support support) const {
    return std::all_of(support.begin(), support.end(),
                       [this](Index source) { return _stamp[source] == _lastStamp; });
}

void SupportUnion::merge(Support support) {
    std::size_t const maxSize = std::size_t(size()) + support.size();
    if (_merged.size() < maxSize) {
        _merged.resize(2 * maxSize);
    }
    Index const *i0 = _begin;
    Index const *i1 = support.begin();
    Index const *const end0 = _end;
    Index const *const end1 = support.end();
    Index *result = _merged.data();
    while (i0 != end0 && i1 != end1) {
        Index const value0 = *i0;
        Index const value1 = *i1;
        *result++ = std::min(value0, value1);
        i0 += value0 <= value1;
        i1 += value1 <= value0;
    }
    result = std::copy(i0, end0, result);
    result = std::copy(i1, end1, result);
    _merged.swap(_union);
    setUnion(_union, result - _union.data());
}

void SupportUnion::Form(Support const *supports, int numSupports) {
    _begin = supports[0].begin();
    _end = supports[0].end();
    if (numSupports == 1) {
        return;
    }
    int numSources = 0;
    for (int i = 0; i < numSupports && numSources <= kMaxSorted; ++i) {
        numSources += supports[i].size();
    }
    if (numSupports > kMaxMerged || numSources <= kMaxSorted) {
        sort(supports, numSupports);
        return;
    }
    if (numSupports == 2) {
        merge(supports[1]);
        return;
    }
    if (++_lastStamp == 0) {
        std::fill(_stamp.begin(), _stamp.end(), 0);
        ++_lastStamp;
    }
    auto const stamp = [this](Support support) {
        for (Index source : support) {
            _stamp[source] = _lastStamp;
        }
    };
    stamp(supports[0]);
    // Neighbors overlap most: every other support first, and most of the rest are covered.
    for (int first : {2, 1}) {
        for (int i = first; i < numSupports; i += 2) {
            if (!isCovered(supports[i])) {
                merge(supports[i]);
                stamp(supports[i]);
            }
        }
    }
}

void VVertexGroup::addTerms(StencilStep const &step, std::vector<Support> const &supportsOfVertices,
                            std::vector<Support> const &supportsOfFaces, Index vVertex,
                            bool withAllTerms) {
    Index const pVert = step.GetVVertexParent(vVertex);
    RefinementMask::VertexMask const mask = step.GetVertexMask(pVert);
    bool const hasFaces = mask.faceWeight > 0 && step.HasVertexFaces(pVert);
    if (!hasFaces || withAllTerms) {
        _terms.push_back({pVert, addSupport(supportsOfVertices[pVert]), false, mask.vertexWeight});
        for (int i = 0; i < mask.numNeighbors; ++i) {
            Index const neighbor = mask.neighbors[i];
            _terms.push_back({neighbor, addSupport(supportsOfVertices[neighbor]), false,
                              mask.neighborWeights[i]});
        }
    }
    if (hasFaces) {
        step.ForEachVertexFace(pVert, [&](Index face, Index row) {
            _terms.push_back({row, addSupport(supportsOfFaces[face]), true, mask.faceWeight});
        });
    }
}

Index VVertexGroup::Take(StencilStep const &step, std::vector<Support> const &supportsOfVertices,
                         std::vector<Support> const &supportsOfFaces, Index begin, Index end,
                         bool withAllTerms) {
    _supports.clear();
    _terms.clear();
    _firstTerms.assign(1, 0);
    Support const shared = supportsOfVertices[step.GetVVertexParent(begin)];
    end = std::min(end, begin + kMaxSize);
    Index vVertex = begin;
    do {
        addTerms(step, supportsOfVertices, supportsOfFaces, vVertex, withAllTerms);
        _firstTerms.push_back(int(_terms.size()));
        ++vVertex;
    } while (vVertex < end && supportsOfVertices[step.GetVVertexParent(vVertex)] == shared);
    return vVertex;
}

void VVertexGroup::Locate(Index const *all, int size) {
    _numSources = size;
    for (int k = 0; k < size; ++k) {
        _position[all[k]] = k;
    }
    int numPositions = 0;
    _firstPositions.clear();
    for (Support support : _supports) {
        _firstPositions.push_back(numPositions);
        numPositions += support.size();
    }
    if (_positions.size() < std::size_t(numPositions)) {
        _positions.resize(2 * std::size_t(numPositions));
    }
    int *positions = _positions.data();
    int const *const position = _position.data();
    for (Support support : _supports) {
        positions = std::transform(support.begin(), support.end(), positions,
                                   [position](Index source) { return position[source]; });
    }
    if (GetNumVVertices() == 1) {
        return; // depends on all
    }
    std::size_t const numWords = (std::size_t(size) + kWordBits - 1) / kWordBits;
    _vertexBits.resize(numWords);
    _bits.assign(numWords * _supports.size(), 0);
    Word *bits = _bits.data();
    int const *supportPositions = _positions.data();
    for (Support support : _supports) {
        int const *const end = supportPositions + support.size();
        for (; supportPositions != end; ++supportPositions) {
            auto const k = unsigned(*supportPositions);
            bits[k / kWordBits] |= Word(1) << (k % kWordBits);
        }
        bits += numWords;
    }
}

void VVertexGroup::formBits(int i) {
    std::size_t const numWords = _vertexBits.size();
    Term const *term = BeginTerms(i);
    std::copy_n(_bits.data() + term->support * numWords, numWords, _vertexBits.data());
    while (++term != EndTerms(i)) {
        Word const *const bits = _bits.data() + term->support * numWords;
        for (std::size_t word = 0; word < numWords; ++word) {
            _vertexBits[word] |= bits[word];
        }
    }
}

int VVertexGroup::CountSources(int i) {
    formBits(i);
    std::size_t count = 0;
    for (Word word : _vertexBits) {
        count += std::bitset<kWordBits>(word).count();
    }
    return int(count);
}

StepSupports StepSupports::MakeSources(std::vector<Index> const &sources) {
    StepSupports result;
    result._sourceLists.reserve(2 * sources.size());
    result._ofVertices.reserve(sources.size());
    for (Index source : sources) {
        result._ofVertices.emplace_back(result._sourceLists.data() + result._sourceLists.size());
        result._sourceLists.push_back(1);
        result._sourceLists.push_back(source);
    }
    return result;
}

StepSupports::StepSupports(StencilStep const &step, StencilStep const *before,
                           StepSupports const &parents, Index numSources, bool keepsVertices,
                           int *sizes) {
    formFaces(step, before, parents, numSources);
    for (Index face = 0; face < step.GetNumFaces(); ++face) {
        _numWeights += std::int64_t(step.GetFaceSize(face)) * _ofFaces[face].size();
    }
    if (std::int64_t const numLeast = _numWeights + countLeastVVertexWeights(step);
        numLeast > kMaxNumWeights) {
        _numWeights = numLeast;
        return;
    }
    if (keepsVertices) {
        _ofVertices.resize(step.GetNumRows());
        _coversFaces.resize(step.GetNumVVertices());
    }
    ParallelFor(step.GetNumFaces(), [&](Index face) {
        Index const first = step.GetFaceFirstRow(face);
        if (keepsVertices) {
            std::fill_n(_ofVertices.data() + first, step.GetFaceSize(face), _ofFaces[face]);
        }
        if (sizes) {
            std::fill_n(sizes + first, step.GetFaceSize(face), _ofFaces[face].size());
        }
    });
    formVVertices(step, parents, numSources, sizes);
}

// A vertex that depends on all that the faces around it do makes those needless that stand beside
// it in an E-face.
void StepSupports::formFaces(StencilStep const &step, StencilStep const *before,
                             StepSupports const &parents, Index numSources) {
    Index const numBeforeVVertices = before ? before->GetNumVVertices() : 0;
    auto const isCoveredBy = [&](Index vert, Index neighbor) {
        return neighbor < numBeforeVVertices && parents._coversFaces[neighbor] &&
               before->GetVVertexParent(neighbor) == before->GetFVertexParent(vert);
    };
    _ofFaces.resize(step.GetNumFaces());
    _faceArenas.resize(GetNumParallelRanges(step.GetNumFaces()));
    struct Scratch {
        SupportUnion sources;
        std::vector<Support> supports;
    };
    ParallelForRange(
        step.GetNumFaces(),
        [numSources] {
            return Scratch{SupportUnion(numSources), {}};
        },
        [&](Scratch &scratch, Index begin, Index end) {
            std::vector<Support> &supports = scratch.supports;
            SupportArena &arena = _faceArenas[begin / kParallelRange];
            for (Index face = begin; face < end; ++face) {
                Index const *const verts = step.GetFaceVertices(face);
                int const size = step.GetFaceSize(face);
                supports.clear();
                for (int i = 0; i < size; ++i) {
                    Index const vert = verts[i];
                    bool const isCovered = before && vert >= numBeforeVVertices &&
                                           (isCoveredBy(vert, verts[i == 0 ? size - 1 : i - 1]) ||
                                            isCoveredBy(vert, verts[i + 1 == size ? 0 : i + 1]));
                    Support const support = parents._ofVertices[vert];
                    if (!isCovered && (supports.empty() || !(supports.back() == support))) {
                        supports.push_back(support);
                    }
                }
                if (supports.size() == 1) {
                    _ofFaces[face] = supports[0];
                } else {
                    scratch.sources.Form(supports.data(), int(supports.size()));
                    _ofFaces[face] = arena.Add(scratch.sources.begin(), scratch.sources.size());
                }
            }
        });
}

void StepSupports::formVVertices(StencilStep const &step, StepSupports const &parents,
                                 Index numSources, int *sizes) {
    struct Scratch {
        VVertexGroup group;
        SupportUnion all;
        std::vector<Index> sources;
    };
    bool const keepsVertices = !_ofVertices.empty();
    Index const numRanges = GetNumParallelRanges(step.GetNumVVertices());
    _vertexArenas.resize(numRanges);
    _ofGroups.resize(numRanges);
    std::vector<std::int64_t> numWeights(numRanges);
    ParallelForRange(
        step.GetNumVVertices(),
        [numSources] {
            return Scratch{VVertexGroup(numSources), SupportUnion(numSources), {}};
        },
        [&](Scratch &scratch, Index begin, Index end) {
            VVertexGroup &group = scratch.group;
            SupportUnion &all = scratch.all;
            Index const range = begin / kParallelRange;
            SupportArena &arena = _vertexArenas[range];
            while (begin < end) {
                Index const first = begin;
                begin = group.Take(step, parents._ofVertices, _ofFaces, first, end, false);
                all.Form(group.GetSupports(), group.GetNumSupports());
                Support const ofGroup = arena.Add(all.begin(), all.size());
                _ofGroups[range].push_back(ofGroup);
                if (begin - first == 1) {
                    // As is; nothing is to be selected.
                    numWeights[range] += all.size();
                    if (sizes) {
                        sizes[first] = all.size();
                    }
                    if (keepsVertices) {
                        _ofVertices[first] = ofGroup;
                        _coversFaces[first] = group.BeginTerms(0)->isFVertex;
                    }
                    continue;
                }
                group.Locate(all.begin(), all.size());
                scratch.sources.resize(std::size_t(all.size()) + 1);
                for (Index vVertex = first; vVertex < begin; ++vVertex) {
                    int const i = int(vVertex - first);
                    int const size = group.CountSources(i);
                    numWeights[range] += size;
                    if (sizes) {
                        sizes[vVertex] = size;
                    }
                    if (keepsVertices) {
                        Index *const sources = scratch.sources.data();
                        Index const *const allSources = all.begin();
                        group.ForEachSource(i, [=](int n, int k) { sources[n] = allSources[k]; });
                        _ofVertices[vVertex] =
                            size == all.size() ? ofGroup : arena.Add(sources, size);
                        _coversFaces[vVertex] = group.BeginTerms(i)->isFVertex;
                    }
                }
            }
        });
    _numWeights = std::accumulate(numWeights.begin(), numWeights.end(), _numWeights);
}

// A lower bound: a smooth V-vertex depends on at least what each of its faces does.
std::int64_t StepSupports::countLeastVVertexWeights(StencilStep const &step) const {
    std::int64_t count = 0;
    if (_numWeights < kMaxNumWeights / 8) {
        return count; // far from the limit: not worth a look at every vertex
    }
    for (Index vVertex = 0; vVertex < step.GetNumVVertices(); ++vVertex) {
        Index const pVert = step.GetVVertexParent(vVertex);
        int most = 0;
        if (step.GetVertexMask(pVert).faceWeight > 0) {
            step.ForEachVertexFace(
                pVert, [&](Index face, Index) { most = std::max(most, _ofFaces[face].size()); });
        }
        count += most;
    }
    return count;
}

} // namespace OpenSubdivHex::FarExt::internal
