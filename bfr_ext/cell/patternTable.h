// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_BFR_EXT_CELL_PATTERN_TABLE_H
#define OPENSUBDIVHEX_BFR_EXT_CELL_PATTERN_TABLE_H

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

namespace OpenSubdivHex::BfrExt::internal {

/// What a PatternTable of a type of cells has: one kind for each precision of a PatternOf.
enum class PatternOf {
    Face,
    FaceDerivatives,
    Border,
    BorderPlace,
    Leaf,
    LeafDerivatives,
    CellBounds,
    LatticeBounds,
    SlopeBounds
};

/// \brief What was made for some keys, of whatever type.
///
/// Any number of threads may use it; what is there already is found without a lock.
class PatternTable {
public:
    PatternTable() = default;
    PatternTable(PatternTable const &) = delete;
    PatternTable &operator=(PatternTable const &) = delete;

    /// The kind of patterns of a precision.
    template <typename REAL>
    static constexpr int GetKind(PatternOf of) {
        return 2 * int(of) + int(sizeof(REAL) == sizeof(double));
    }

    /// \brief What make(), which gives a PATTERN, made when it was first called with a key.
    ///
    /// \param kind         tells what PATTERN is, and how the rest is to be understood
    /// \param begin, end  the rest of the key
    template <typename PATTERN, typename MAKE>
    PATTERN const &Get(int kind, int const *begin, int const *end, MAKE const &make) {
        Key const key = {kind, begin, end, getHash(kind, begin, end)};
        Entry const *entry = find(_table.load(std::memory_order_acquire), key);
        if (!entry) {
            entry = &add(key, std::make_shared<PATTERN const>(make()));
        }
        return *static_cast<PATTERN const *>(entry->pattern.get());
    }

private:
    struct Key {
        int kind;
        int const *begin;
        int const *end;
        std::size_t hash;
    };
    struct Entry {
        int kind;
        std::vector<int> rest;
        std::size_t hash;
        std::shared_ptr<void const> pattern;
    };
    // Entries by their hashes, from where these say on, without gaps.
    struct Table {
        explicit Table(std::size_t size)
            : mask(size - 1), entries(new std::atomic<Entry const *>[size]()) {}

        std::size_t const mask; // the size, a power of two, less one
        std::unique_ptr<std::atomic<Entry const *>[]> const entries;
    };
    static constexpr std::size_t kLeastSize = 4;

    static std::size_t getHash(int kind, int const *begin, int const *end) {
        auto hash = std::size_t(kind);
        for (; begin != end; ++begin) {
            hash = (hash ^ std::size_t(*begin)) * 0x9e3779b97f4a7c15;
            hash ^= hash >> 29;
        }
        return hash;
    }

    static Entry const *find(Table const *table, Key const &key) {
        if (!table) {
            return nullptr;
        }
        for (std::size_t i = key.hash;; ++i) {
            Entry const *const entry =
                table->entries[i & table->mask].load(std::memory_order_acquire);
            if (!entry ||
                (entry->kind == key.kind &&
                 std::equal(key.begin, key.end, entry->rest.begin(), entry->rest.end()))) {
                return entry;
            }
        }
    }

    static void insert(Table &table, Entry const &entry) {
        std::size_t i = entry.hash;
        while (table.entries[i & table.mask].load(std::memory_order_relaxed)) {
            ++i;
        }
        table.entries[i & table.mask].store(&entry, std::memory_order_release);
    }

    // Unless another thread was faster.
    Entry const &add(Key const &key, std::shared_ptr<void const> pattern) {
        std::lock_guard<std::mutex> const lock(_mutex);
        if (Entry const *const entry = find(_table.load(std::memory_order_relaxed), key)) {
            return *entry;
        }
        _entries.push_back(std::make_unique<Entry const>(
            Entry{key.kind, {key.begin, key.end}, key.hash, std::move(pattern)}));
        if (_tables.empty() || 2 * _entries.size() > _tables.back()->mask + 1) {
            std::size_t const size = _tables.empty() ? kLeastSize : 2 * (_tables.back()->mask + 1);
            auto table = std::make_unique<Table>(size);
            for (auto const &entry : _entries) {
                insert(*table, *entry);
            }
            // Other threads may still look at those before.
            _tables.push_back(std::move(table));
            _table.store(_tables.back().get(), std::memory_order_release);
        } else {
            insert(*_tables.back(), *_entries.back());
        }
        return *_entries.back();
    }

    std::atomic<Table const *> _table{nullptr};
    std::mutex _mutex;
    std::vector<std::unique_ptr<Table>> _tables;
    std::vector<std::unique_ptr<Entry const>> _entries;
};

} // namespace OpenSubdivHex::BfrExt::internal

#endif
