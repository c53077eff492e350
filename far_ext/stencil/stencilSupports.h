// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_STENCIL_STENCIL_SUPPORTS_H
#define OPENSUBDIVHEX_FAR_EXT_STENCIL_STENCIL_SUPPORTS_H

#include "far_ext/vtr/pagedArray.h"
#include "far_ext/vtr/refinementRows.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <memory>
#include <mutex>
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
    using Index = Far::Index;

    /// Scratch memory of one thread.
    class Writer {
    public:
        explicit Writer(SupportArena &arena) : _arena(arena) {}
        /// A list with its length and room for as many sources.
        Index *Add(int size);

    private:
        SupportArena &_arena;
        std::size_t _blockSize = 512;
        std::size_t _numFree = 0;
        Index *_free = nullptr;
    };

private:
    Index *addBlock(std::size_t size);

    std::unique_ptr<std::mutex> _mutex = std::make_unique<std::mutex>(); ///< of the blocks
    std::vector<std::unique_ptr<Index[]>> _blocks;
};

/// \brief Forms unions of supports.  Each thread has one; \p numSources is above all sources.
class SupportUnion {
public:
    using Index = Far::Index;

    SupportUnion(Index numSources, SupportArena &arena) : _stamp(numSources), _writer(arena) {}

    /// Forms the union of \p numSupports, 1 or more, which the rest is about.
    void Form(Support const *supports, int numSupports);
    int size() const { return _base.size() + _numAdded; }
    /// The largest of the supports; mostly it has all sources.
    Support GetBase() const { return _base; }
    /// The sources that the largest does not have, and all, in the arena where they need a list.
    Support KeepAdded();
    Support Keep();

private:
    Support _base;
    int _numAdded = 0;
    Buffer<Index> _added;        ///< shares no cache line with that of another thread
    PagedArray<unsigned> _stamp; ///< by source: _lastStamp for those in the union
    unsigned _lastStamp = 0;
    SupportArena::Writer _writer;
};

/// \brief The supports of a refinement's rows: the F-vertices of a face share a support, and a V-vertex mostly
/// shares the support of one of the faces around it.
class RowSupports {
public:
    using Index = Far::Index;

    /// Supports of rows that are their own sources, or sources[row].
    static RowSupports MakeSources(std::vector<Index> const &sources);

    /// \brief Supports of rows whose sources have the stencils \p parents, which it refers to.
    ///
    /// \param before         the rows that made the parent level, null when its vertices are sources
    /// \param keepsVertices  whether stencils of the next level are to be made of these
    /// \param sizes          null, or where to write the size of every stencil
    RowSupports(RefinementRows const &rows, RefinementRows const *before,
                RowSupports const &parents, Index numSources, bool keepsVertices, int *sizes);

    /// Sum of the sizes of all stencils, when it is no more than \p kMaxNumWeights;
    /// else a lower bound that is above it, and the supports are incomplete.
    std::int64_t GetNumWeights() const { return _numWeights; }

    static constexpr std::int64_t kMaxNumWeights = std::numeric_limits<Index>::max();

    std::vector<Support> const &OfFaces() const { return _ofFaces; }
    /// Supports of all rows; with keepsVertices.
    std::vector<Support> const &OfVertices() const { return _ofVertices; }
    /// The support of a V-vertex; valid until \p scratch is used again.
    Support OfVVertex(Index vVertex, Buffer<Index> &scratch) const;

    /// The length of parallel ranges of faces and V-vertices: their stencils take some hundred
    /// nanoseconds each, and their weights fit into the second cache.
    static constexpr Index kRange = 256;

private:
    RowSupports() = default;

    template <typename FORM>
    void formUnions(Index count, Index numSources, FORM form);
    void formFaces(RefinementRows const &rows, RefinementRows const *before,
                   RowSupports const &parents, Index numSources);
    void formVVertices(RefinementRows const &rows, RowSupports const &parents, Index numSources,
                       bool keepsVertices, int *sizes);
    std::int64_t countLeastVVertexWeights(RefinementRows const &rows) const;

    std::int64_t _numWeights = 0;
    std::vector<Support> _ofFaces;
    std::vector<Support> _ofVertices; ///< else, of V-vertices alone, the largest part of each ...
    std::vector<Support> _added;      ///< ... and what is to be added, mostly nothing
    std::vector<unsigned char> _coversFaces; ///< by V-vertex, if it depends on all its faces do
    SupportArena _arena;
    std::vector<Index> _sourceLists;
};

} // namespace OpenSubdivHex::FarExt::internal

#endif
