// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_BFR_EXT_CELL_PATTERN_TABLE_H
#define OPENSUBDIVHEX_BFR_EXT_CELL_PATTERN_TABLE_H

#include "entryTable.h"
#include "memoryCount.h"

#include "far_ext/vtr/hash.h"

#include <algorithm>
#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

namespace OpenSubdivHex::BfrExt::internal {

/// Kinds of entries of a PatternTable of a type of cells: one for each precision of a PatternOf.
enum class PatternOf {
    Border,
    BorderPlace,
    BorderRate,
    Rates,
    RateDerivatives,
    RateDerivativesOnEdge,
    Leaf,
    LeafDerivatives,
    VertexWeights,
    Derivatives,
    FaceCorner,
    ChildCorner,
    RingCell,
    RingItem,
    SecondDerivatives,
    PatchPoints,
    PatchRows,
    ChildPatches,
    FacePatches,
    BorderItem
};

/// \brief Values by key, of any type.
///
/// Any number of threads may use it; what is there already is found without a lock, and none is held while a value is made.
class PatternTable {
public:
    /// \param memory  counts what the values take
    explicit PatternTable(MemoryCount &memory) : _memory(memory) {}

    /// The kind of patterns of a precision.
    template <typename REAL>
    static constexpr int GetKind(PatternOf of) {
        return 2 * int(of) + int(sizeof(REAL) == sizeof(double));
    }

    /// \brief The PATTERN that make() made when it was first called with a key.
    ///
    /// \param kind         tells what PATTERN is, and how the rest is to be understood
    /// \param begin, end  the rest of the key
    template <typename PATTERN, typename MAKE>
    PATTERN const &Get(int kind, int const *begin, int const *end, MAKE const &make) {
        std::size_t const hash = getHash(kind, begin, end);
        auto const isSame = [&](Entry const &entry) {
            return entry.kind == kind &&
                   std::equal(begin, end, entry.rest.begin(), entry.rest.end());
        };
        Entry const *entry = _entries.Find(hash, isSame);
        if (!entry) {
            auto made = std::make_unique<EntryOf<PATTERN> const>(hash, kind, begin, end, make);
            std::size_t const size = sizeof(PATTERN) + GetHeapSize(made->pattern);
            auto const [added, isNew] = _entries.Add(std::move(made), isSame);
            if (isNew) {
                _memory.Add(decltype(_entries)::kEntrySize + GetHeapSize(added->rest) + size);
            }
            entry = added;
        }
        return static_cast<EntryOf<PATTERN> const *>(entry)->pattern;
    }

private:
    struct Entry {
        Entry(std::size_t hashOfKey, int kindOfKey, int const *begin, int const *end)
            : hash(hashOfKey), kind(kindOfKey), rest(begin, end) {}
        virtual ~Entry() = default;

        std::size_t const hash;
        int const kind;
        std::vector<int> const rest;
    };
    // Beside its key, so that a look-up reads few lines of the cache.
    template <typename PATTERN>
    struct EntryOf final : Entry {
        template <typename MAKE>
        EntryOf(std::size_t hashOfKey, int kindOfKey, int const *begin, int const *end,
                MAKE const &make)
            : Entry(hashOfKey, kindOfKey, begin, end), pattern(make()) {}

        PATTERN const pattern;
    };

    static std::size_t getHash(int kind, int const *begin, int const *end) {
        auto hash = std::uint64_t(kind);
        for (; begin != end; ++begin) {
            hash = FarExt::internal::AddToHash(hash, std::uint64_t(*begin));
        }
        return hash;
    }

    MemoryCount &_memory;
    EntryTable<Entry> _entries;
};

} // namespace OpenSubdivHex::BfrExt::internal

#endif
