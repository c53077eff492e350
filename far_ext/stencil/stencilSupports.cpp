// SPDX-License-Identifier: Apache-2.0
#include "stencilSupports.h"

#include "far_ext/vtr/parallel.h"

#include <algorithm>
#include <numeric>

namespace OpenSubdivHex::FarExt::internal {

using Far::Index;

Index *SupportArena::addBlock(std::size_t size) {
    std::unique_ptr<Index[]> block(new Index[size]);
    Index *const result = block.get();
    std::lock_guard<std::mutex> const lock(*_mutex);
    _blocks.push_back(std::move(block));
    return result;
}

Index *SupportArena::Writer::Add(int size) {
    constexpr std::size_t kMaxBlock = 16384;
    std::size_t const needed = std::size_t(size) + 1;
    if (needed > _numFree) {
        // The first block is small, for refinements that need little.
        _blockSize = std::min(2 * _blockSize, kMaxBlock);
        std::size_t const numFree = std::max(needed, _blockSize);
        _free = _arena.addBlock(numFree); // may throw; the free part of the last block stays then
        _numFree = numFree;
    }
    Index *const list = _free;
    *list = size;
    _free += needed;
    _numFree -= needed;
    return list;
}

void SupportUnion::Form(Support const *supports, int numSupports) {
    _base = supports[0];
    _numAdded = 0;
    if (numSupports == 1) {
        return;
    }
    int largest = 0;
    std::size_t numSources = 0;
    for (int i = 0; i < numSupports; ++i) {
        numSources += supports[i].size();
        largest = supports[i].size() > supports[largest].size() ? i : largest;
    }
    _stamp.Begin();
    if (++_lastStamp == 0) {
        _stamp.Clear();
        ++_lastStamp;
    }
    _base = supports[largest];
    _stamp.ForEach(_base.begin(), _base.size(),
                   [stamp = _lastStamp](unsigned &ofSource, int) { ofSource = stamp; });
    _added.Resize(numSources);
    Index *const added = _added.data();
    int numAdded = 0;
    bool isSorted = true;
    for (int i = 0; i < numSupports; ++i) {
        if (i == largest) {
            continue;
        }
        int const numBefore = numAdded;
        Index const *const sources = supports[i].begin();
        _stamp.ForEach(sources, supports[i].size(),
                       [&numAdded, added, sources, stamp = _lastStamp](unsigned &ofSource, int k) {
                           added[numAdded] = sources[k];
                           numAdded += ofSource != stamp;
                           ofSource = stamp;
                       });
        isSorted = isSorted && (numBefore == 0 || numBefore == numAdded);
    }
    if (!isSorted) {
        std::sort(added, added + numAdded);
    }
    _numAdded = numAdded;
}

Support SupportUnion::KeepAdded() {
    static constexpr Index kNone[] = {0};
    if (_numAdded == 0) {
        return Support(kNone);
    }
    Index *const list = _writer.Add(_numAdded);
    std::copy_n(_added.data(), _numAdded, list + 1);
    return Support(list);
}

Support SupportUnion::Keep() {
    if (_numAdded == 0) {
        return _base;
    }
    Index *const list = _writer.Add(size());
    std::merge(_base.begin(), _base.end(), _added.data(), _added.data() + _numAdded, list + 1);
    return Support(list);
}

RowSupports RowSupports::MakeSources(std::vector<Index> const &sources) {
    RowSupports result;
    result._sourceLists.reserve(2 * sources.size());
    result._ofVertices.reserve(sources.size());
    for (Index source : sources) {
        result._ofVertices.emplace_back(result._sourceLists.data() + result._sourceLists.size());
        result._sourceLists.push_back(1);
        result._sourceLists.push_back(source);
    }
    return result;
}

Support RowSupports::OfVVertex(Index vVertex, Buffer<Index> &scratch) const {
    Support const base = _ofVertices[vVertex];
    if (_added.empty() || _added[vVertex].size() == 0) {
        return base;
    }
    Support const added = _added[vVertex];
    int const size = base.size() + added.size();
    scratch.Resize(std::size_t(size) + 1);
    scratch[0] = size;
    std::merge(base.begin(), base.end(), added.begin(), added.end(), scratch.data() + 1);
    return Support(scratch.data());
}

RowSupports::RowSupports(RefinementRows const &rows, RefinementRows const *before,
                         RowSupports const &parents, Index numSources, bool keepsVertices,
                         int *sizes) {
    formFaces(rows, before, parents, numSources);
    if (std::int64_t const numLeast = _numWeights + countLeastVVertexWeights(rows);
        numLeast > kMaxNumWeights) {
        _numWeights = numLeast;
        return;
    }
    if (keepsVertices) {
        _ofVertices.resize(rows.GetNumRows());
        _coversFaces.resize(rows.GetNumVVertices());
    } else {
        _ofVertices.resize(rows.GetNumVVertices());
        _added.resize(rows.GetNumVVertices());
    }
    ParallelFor(rows.GetNumFaces(), [&](Index face) {
        Index const first = rows.GetFaceFirstRow(face);
        if (keepsVertices) {
            std::fill_n(_ofVertices.data() + first, rows.GetFaceSize(face), _ofFaces[face]);
        }
        if (sizes) {
            std::fill_n(sizes + first, rows.GetFaceSize(face), _ofFaces[face].size());
        }
    });
    formVVertices(rows, parents, numSources, keepsVertices, sizes);
}

// form(item, sources, supports) forms the union of an item's supports and returns its weights.
template <typename FORM>
void RowSupports::formUnions(Index count, Index numSources, FORM form) {
    struct Scratch {
        SupportUnion sources;
        std::vector<Support> supports;
    };
    std::vector<std::int64_t> numWeights(GetNumParallelRanges(count, kRange));
    ParallelForRange(
        count,
        [&] {
            return Scratch{SupportUnion(numSources, _arena), {}};
        },
        [&](Scratch &scratch, Index begin, Index end) {
            std::int64_t numRangeWeights = 0;
            for (Index item = begin; item < end; ++item) {
                numRangeWeights += form(item, scratch.sources, scratch.supports);
            }
            numWeights[begin / kRange] = numRangeWeights;
        },
        kRange);
    _numWeights = std::accumulate(numWeights.begin(), numWeights.end(), _numWeights);
}

// A vertex that depends on all that the faces around it do makes those needless that stand beside
// it in an E-face.
void RowSupports::formFaces(RefinementRows const &rows, RefinementRows const *before,
                            RowSupports const &parents, Index numSources) {
    Index const numBeforeVVertices = before ? before->GetNumVVertices() : 0;
    auto const isCoveredBy = [&](Index vert, Index neighbor) {
        return neighbor < numBeforeVVertices && parents._coversFaces[neighbor] &&
               before->GetVVertexParent(neighbor) == before->GetFVertexParent(vert);
    };
    _ofFaces.resize(rows.GetNumFaces());
    auto const form = [&](Index face, SupportUnion &sources, std::vector<Support> &supports) {
        Index const *const verts = rows.GetFaceVertices(face);
        int const size = rows.GetFaceSize(face);
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
        sources.Form(supports.data(), int(supports.size()));
        _ofFaces[face] = sources.Keep();
        return std::int64_t(size) * _ofFaces[face].size();
    };
    formUnions(rows.GetNumFaces(), numSources, form);
}

// The faces around a vertex depend on all that the vertex and its neighbors do.
void RowSupports::formVVertices(RefinementRows const &rows, RowSupports const &parents,
                                Index numSources, bool keepsVertices, int *sizes) {
    auto const form = [&](Index vVertex, SupportUnion &sources, std::vector<Support> &supports) {
        Index const pVert = rows.GetVVertexParent(vVertex);
        VertexRule const rule = rows.GetVertexRule(pVert);
        bool const hasFaces = rule.HasFaces() && rows.HasVertexFaces(pVert);
        supports.clear();
        if (hasFaces) {
            supports.push_back(parents._ofVertices[pVert]);
            rows.ForEachFaceSource(pVert, rule, [&](Index face, Index, double) {
                if (!(_ofFaces[face] == supports[0])) {
                    supports.push_back(_ofFaces[face]);
                }
            });
        } else {
            rows.ForEachSource(vVertex, rule, [&](Index source, double) {
                supports.push_back(parents._ofVertices[source]);
            });
        }
        bool const isCovered = hasFaces && supports.size() > 1;
        sources.Form(supports.data() + isCovered, int(supports.size()) - isCovered);
        if (keepsVertices) {
            _ofVertices[vVertex] = sources.Keep();
            _coversFaces[vVertex] = hasFaces;
        } else {
            _ofVertices[vVertex] = sources.GetBase();
            _added[vVertex] = sources.KeepAdded();
        }
        if (sizes) {
            sizes[vVertex] = sources.size();
        }
        return std::int64_t(sources.size());
    };
    formUnions(rows.GetNumVVertices(), numSources, form);
}

// A lower bound: a smooth V-vertex depends on at least what each of its faces does.
std::int64_t RowSupports::countLeastVVertexWeights(RefinementRows const &rows) const {
    std::int64_t count = 0;
    if (_numWeights < kMaxNumWeights / 8) {
        return count; // far from the limit: not worth a look at every vertex
    }
    for (Index vVertex = 0; vVertex < rows.GetNumVVertices(); ++vVertex) {
        Index const pVert = rows.GetVVertexParent(vVertex);
        int most = 0;
        rows.ForEachFaceSource(pVert, rows.GetVertexRule(pVert), [&](Index face, Index, double) {
            most = std::max(most, _ofFaces[face].size());
        });
        count += most;
    }
    return count;
}

} // namespace OpenSubdivHex::FarExt::internal
