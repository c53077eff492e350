// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_VTR_INDEX_SET_H
#define OPENSUBDIVHEX_FAR_EXT_VTR_INDEX_SET_H

#include "far_ext/status.h"

#include <cstdint>
#include <vector>

namespace OpenSubdivHex::FarExt::internal {

/// \brief A set of indices in pages of bits: what it takes is proportional to the indices, but for
/// one entry per page of the range that they are from.
class IndexSet {
public:
    using Index = Far::Index;

    /// For indices below \p end; empty.
    explicit IndexSet(Index end) : _pages(end / kPageBits + 1, -1) {}

    void Insert(Index index);

    /// All indices, ascending.
    std::vector<Index> GetIndices() const;

private:
    friend class IndexNumbering;

    using Word = std::uint64_t;
    static constexpr Index kWordBits = 64;
    static constexpr Index kPageWords = 8;
    static constexpr Index kPageBits = kWordBits * kPageWords;

    // The word that has an index of a page that is there.
    std::size_t findWord(Index index) const {
        return std::size_t(_pages[index / kPageBits]) * kPageWords + index % kPageBits / kWordBits;
    }

    std::vector<Index> _pages; // number of each page among those that are there, or -1
    std::vector<Word> _words;
    Index _numPages = 0;
};

/// \brief The place of each index in an ascending list.
class IndexNumbering {
public:
    using Index = Far::Index;

    /// \p ascending has no index twice, and all are below \p end.
    IndexNumbering(std::vector<Index> const &ascending, Index end);

    /// The place of an index that the list has.
    Index operator()(Index index) const;

private:
    IndexSet _set;
    std::vector<Index> _numBefore; // each word of the set
};

/// \brief A few indices with a value each.  All are forgotten at once, and neither time nor memory
/// depend on the range that they are from.
class OPENSUBDIVHEX_API IndexMap {
public:
    using Index = Far::Index;

    IndexMap() : _entries(kLeastSize) {}

    void Clear() {
        _numEntries = 0;
        if (++_round == 0) {
            _entries.assign(_entries.size(), Entry());
            ++_round;
        }
    }
    /// INDEX_INVALID when \p index has none.
    Index Find(Index index) const {
        Entry const &entry = _entries[findPlace(index)];
        return entry.round == _round ? entry.value : Far::INDEX_INVALID;
    }
    /// The value of \p index, which is \p value if it had none.
    Index FindOrSet(Index index, Index value) {
        Entry &entry = _entries[findPlace(index)];
        if (entry.round == _round) {
            return entry.value;
        }
        entry = {_round, index, value};
        if (2 * ++_numEntries > _entries.size()) {
            grow();
        }
        return value;
    }

private:
    struct Entry {
        std::uint32_t round = 0;
        Index index = 0;
        Index value = 0;
    };
    static constexpr std::size_t kLeastSize = 256; // a power of two, as all sizes

    // Where an index is, or would be.
    std::size_t findPlace(Index index) const {
        std::size_t const mask = _entries.size() - 1;
        std::size_t place = (std::uint32_t(index) * std::uint64_t(0x9e3779b97f4a7c15)) >> 32 & mask;
        while (_entries[place].round == _round && _entries[place].index != index) {
            place = (place + 1) & mask;
        }
        return place;
    }
    void grow();

    std::vector<Entry> _entries;
    std::size_t _numEntries = 0;
    std::uint32_t _round = 1;
};

/// Sorts indices and removes repeated ones.
OPENSUBDIVHEX_API void SortUnique(std::vector<Far::Index> &indices);
/// Adds an index to ascending ones that do not repeat, unless it is there.
OPENSUBDIVHEX_API void InsertUnique(std::vector<Far::Index> &indices, Far::Index index);
/// As SortUnique() of many indices, all below \p end.
void SortUnique(std::vector<Far::Index> &indices, Far::Index end);

} // namespace OpenSubdivHex::FarExt::internal

#endif
