// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_STENCIL_SUPPORTS_H
#define OPENSUBDIVHEX_FAR_EXT_STENCIL_SUPPORTS_H

#include "stencilStep.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

namespace OpenSubdivHex::FarExt::internal {

/// \brief The sources that a stencil depends on: a view of an ascending list, whose address is its
/// identity.  Vertices that are known to depend on the same share one.
class Support {
public:
    using Index = Far::Index;

    Support() = default;
    /// \p list begins with its length.
    explicit Support(Index const *list) : _list(list) {}

    int size() const { return *_list; }
    Index const *begin() const { return _list + 1; }
    Index const *end() const { return begin() + size(); }
    Index operator[](int i) const { return begin()[i]; }
    friend bool operator==(Support a, Support b) { return a._list == b._list; }

private:
    Index const *_list = nullptr;
};

/// \brief Memory for supports, which stay where they are.
class SupportArena {
public:
    Support Add(Far::Index const *list, int size);

private:
    std::vector<std::unique_ptr<Far::Index[]>> _blocks;
    std::size_t _numFree = 0;
    Far::Index *_free = nullptr;
};

/// \brief Forms unions of supports.  Each thread has one; \p numSources is above all sources.
class SupportUnion {
public:
    using Index = Far::Index;

    explicit SupportUnion(Index numSources) : _stamp(numSources) {}

    /// Forms the union of \p numSupports, 1 or more, which begin() and end() are about.
    void Form(Support const *supports, int numSupports);
    int size() const { return int(_end - _begin); }
    Index const *begin() const { return _begin; }
    Index const *end() const { return _end; }

private:
    void setUnion(std::vector<Index> const &list, std::size_t size) {
        _begin = list.data();
        _end = _begin + size;
    }
    void sort(Support const *supports, int numSupports);
    void merge(Support support);
    bool isCovered(Support support) const;

    static constexpr int kMaxMerged = 16; ///< more supports are sorted together ...
    static constexpr int kMaxSorted = 16; ///< ... as are those with few sources

    Index const *_begin = nullptr;
    Index const *_end = nullptr;
    std::vector<Index> _union;
    std::vector<Index> _merged;
    std::vector<unsigned> _stamp; ///< by source: _lastStamp for those in the union
    unsigned _lastStamp = 0;
};

/// \brief V-vertices of a step whose stencils are made together, because they share what they
/// depend on: those of the F-vertices of a face, or a single one.
class VVertexGroup {
public:
    using Index = Far::Index;

    /// A stencil that is a part of that of a V-vertex.
    struct Term {
        Index row;   ///< of the step if isFVertex, else of the step before
        int support; ///< number in the group
        bool isFVertex;
        double weight;
    };

    explicit VVertexGroup(Index numSources) : _position(numSources) {}

    /// Takes the V-vertices from \p begin on, up to \p end at most, and returns where they end.
    /// \p withAllTerms is false when it is only asked what the stencils depend on: the faces around
    /// a vertex depend on all that the vertex and its neighbors do.
    Index Take(StencilStep const &step, std::vector<Support> const &supportsOfVertices,
               std::vector<Support> const &supportsOfFaces, Index begin, Index end,
               bool withAllTerms);

    int GetNumSupports() const { return int(_supports.size()); }
    Support const *GetSupports() const { return _supports.data(); }
    int GetNumVVertices() const { return int(_firstTerms.size()) - 1; }
    /// The terms of the i'th V-vertex.
    Term const *BeginTerms(int i) const { return _terms.data() + _firstTerms[i]; }
    Term const *EndTerms(int i) const { return _terms.data() + _firstTerms[i + 1]; }

    /// Finds where the sources of each support stand in \p all, a list that has them all.
    void Locate(Index const *all, int size);
    int const *GetPositions(int support) const {
        return _positions.data() + _firstPositions[support];
    }
    /// How many sources the i'th V-vertex depends on.
    int CountSources(int i);
    /// Calls write(n, k) for all positions k, with n counting those before that the i'th V-vertex
    /// depends on: the last write for n is for number n of these.  Returns their number.
    template <typename FUNCTION>
    int ForEachSource(int i, FUNCTION write) {
        int n = 0;
        if (GetNumVVertices() == 1) {
            for (; n < _numSources; ++n) {
                write(n, n);
            }
            return n;
        }
        formBits(i);
        int k = 0;
        for (Word word : _vertexBits) {
            for (int const end = std::min(k + kWordBits, _numSources); k < end; ++k) {
                write(n, k);
                n += int(word & 1);
                word >>= 1;
            }
        }
        return n;
    }

private:
    using Word = std::uint64_t;
    static constexpr int kWordBits = 64;

    // Any numbers will do; they bound the work for supports that are not the same.
    static constexpr int kMaxSize = 16;
    static constexpr int kMaxCompared = 16;

    int addSupport(Support support) {
        // All vertices share the support of their face, which came first; neighbors that of the
        // face between them, which came last.
        if (!_supports.empty() && _supports[0] == support) {
            return 0;
        }
        int const numSupports = GetNumSupports();
        for (int i = numSupports; i-- > std::max(1, numSupports - kMaxCompared);) {
            if (_supports[i] == support) {
                return i;
            }
        }
        _supports.push_back(support);
        return numSupports;
    }
    void formBits(int i);
    void addTerms(StencilStep const &step, std::vector<Support> const &supportsOfVertices,
                  std::vector<Support> const &supportsOfFaces, Index vVertex, bool withAllTerms);

    std::vector<Support> _supports;
    std::vector<Term> _terms;
    std::vector<int> _firstTerms;
    std::vector<int> _position;  ///< by source
    std::vector<int> _positions; ///< of the sources of all supports
    std::vector<int> _firstPositions;
    int _numSources = 0;
    std::vector<Word> _bits;       ///< of each support, one bit for each source of all
    std::vector<Word> _vertexBits; ///< the same of one V-vertex
};

/// \brief What the stencils of a step depend on: those of the F-vertices of a face share a support,
/// every V-vertex has its own.
class StepSupports {
public:
    using Index = Far::Index;

    /// Of a step whose rows are their own sources, or sources[row].
    static StepSupports MakeSources(std::vector<Index> const &sources);

    /// \brief Of a step whose faces' vertices have the stencils \p parents, which it refers to.
    ///
    /// \param before         the step that made the vertices, null when they are sources
    /// \param keepsVertices  whether a further step is to be made of this one
    /// \param sizes          null, or where to write the size of every stencil of the step
    StepSupports(StencilStep const &step, StencilStep const *before, StepSupports const &parents,
                 Index numSources, bool keepsVertices, int *sizes);

    /// Sum of the sizes of all stencils of the step, when it is no more than \p kMaxNumWeights;
    /// else a lower bound that is above it, and the supports are incomplete.
    std::int64_t GetNumWeights() const { return _numWeights; }
    /// Of the groups of V-vertices in a parallel range: all that a group depends on.
    std::vector<Support> const &OfGroups(Index range) const { return _ofGroups[range]; }

    static constexpr std::int64_t kMaxNumWeights = std::numeric_limits<Index>::max();

    std::vector<Support> const &OfFaces() const { return _ofFaces; }
    /// Of all rows; empty unless keepsVertices.
    std::vector<Support> const &OfVertices() const { return _ofVertices; }

private:
    StepSupports() = default;

    void formFaces(StencilStep const &step, StencilStep const *before, StepSupports const &parents,
                   Index numSources);
    void formVVertices(StencilStep const &step, StepSupports const &parents, Index numSources,
                       int *sizes);
    std::int64_t countLeastVVertexWeights(StencilStep const &step) const;

    std::int64_t _numWeights = 0;
    std::vector<Support> _ofFaces;
    std::vector<Support> _ofVertices;
    std::vector<unsigned char> _coversFaces;     ///< by V-vertex, if it depends on all its faces do
    std::vector<std::vector<Support>> _ofGroups; ///< by parallel range
    std::vector<SupportArena> _faceArenas;       ///< by parallel range
    std::vector<SupportArena> _vertexArenas;
    std::vector<Index> _sourceLists;
};

} // namespace OpenSubdivHex::FarExt::internal

#endif
