// SPDX-License-Identifier: Apache-2.0
#include "indexSet.h"

#include <algorithm>
#include <bitset>

namespace OpenSubdivHex::FarExt::internal {

using Far::Index;

namespace {

template <typename WORD>
Index countBits(WORD word) {
    return Index(std::bitset<sizeof(WORD) * 8>(word).count());
}

} // namespace

void IndexSet::Insert(Index index) {
    Index &page = _pages[index / kPageBits];
    if (page < 0) {
        page = _numPages++;
        _words.resize(_words.size() + kPageWords);
    }
    _words[findWord(index)] |= Word(1) << (index % kWordBits);
}

std::vector<Index> IndexSet::GetIndices() const {
    std::size_t count = 0;
    for (Word word : _words) {
        count += countBits(word);
    }
    std::vector<Index> result;
    result.reserve(count);
    for (std::size_t page = 0; page < _pages.size(); ++page) {
        if (_pages[page] < 0) {
            continue;
        }
        Index first = Index(page) * kPageBits;
        Word const *const words = _words.data() + std::size_t(_pages[page]) * kPageWords;
        for (Index i = 0; i < kPageWords; ++i, first += kWordBits) {
            for (Word word = words[i]; word != 0; word &= word - 1) {
                result.push_back(first + countBits(~word & (word - 1)));
            }
        }
    }
    return result;
}

IndexNumbering::IndexNumbering(std::vector<Index> const &ascending, Index end) : _set(end) {
    for (Index number = 0; number < Index(ascending.size()); ++number) {
        _set.Insert(ascending[number]);
        std::size_t const word = _set.findWord(ascending[number]);
        if (word >= _numBefore.size()) {
            // Words come in the order of the indices.
            _numBefore.resize(word + 1, number);
        }
    }
}

Index IndexNumbering::operator()(Index index) const {
    std::size_t const word = _set.findWord(index);
    IndexSet::Word const before = (IndexSet::Word(1) << (index % IndexSet::kWordBits)) - 1;
    return _numBefore[word] + countBits(_set._words[word] & before);
}

void SortUnique(std::vector<Index> &indices) {
    if (!std::is_sorted(indices.begin(), indices.end())) {
        std::sort(indices.begin(), indices.end());
    }
    indices.erase(std::unique(indices.begin(), indices.end()), indices.end());
}

void InsertUnique(std::vector<Index> &indices, Index index) {
    auto const place = std::lower_bound(indices.begin(), indices.end(), index);
    if (place == indices.end() || *place != index) {
        indices.insert(place, index);
    }
}

void SortUnique(std::vector<Index> &indices, Index end) {
    IndexSet set(end);
    for (Index index : indices) {
        set.Insert(index);
    }
    indices = set.GetIndices();
}

void IndexMap::grow() {
    std::vector<Entry> entries(2 * _entries.size());
    entries.swap(_entries);
    for (Entry const &entry : entries) {
        if (entry.round == _round) {
            _entries[findPlace(entry.index)] = entry;
        }
    }
}

} // namespace OpenSubdivHex::FarExt::internal
