// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_BFR_EXT_CELL_ENTRY_TABLE_H
#define OPENSUBDIVHEX_BFR_EXT_CELL_ENTRY_TABLE_H

#include <atomic>
#include <cstddef>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

namespace OpenSubdivHex::BfrExt::internal {

/// \brief Entries that are found by their hashes, and stay until the table goes.
///
/// Any number of threads may use it; what is there already is found without a lock.
///
/// \tparam ENTRY   has a member hash, a std::size_t
/// \tparam DELETE  what becomes of entries
template <typename ENTRY, typename DELETE = std::default_delete<ENTRY const>>
class EntryTable {
public:
    using Pointer = std::unique_ptr<ENTRY const, DELETE>;

    /// Bytes that an entry takes, with its part of the table, without what it has on the heap.
    static constexpr std::size_t kEntrySize = sizeof(ENTRY) + 5 * sizeof(void *);

    EntryTable() = default;
    EntryTable(EntryTable const &) = delete;
    EntryTable &operator=(EntryTable const &) = delete;

    /// The entry with a hash of which isSame(entry) is true; null where there is none.
    template <typename SAME>
    ENTRY const *Find(std::size_t hash, SAME const &isSame) const {
        return find(_slots.load(std::memory_order_acquire), hash, isSame);
    }

    /// Adds an entry unless another thread was faster.
    /// \return  the one that is there, and whether it is this one
    template <typename SAME>
    std::pair<ENTRY const *, bool> Add(Pointer entry, SAME const &isSame) {
        std::lock_guard<std::mutex> const lock(_mutex);
        if (ENTRY const *const found =
                find(_slots.load(std::memory_order_relaxed), entry->hash, isSame)) {
            return {found, false};
        }
        _entries.push_back(std::move(entry));
        if (_allSlots.empty() || 2 * _entries.size() > _allSlots.back()->mask + 1) {
            std::size_t const size =
                _allSlots.empty() ? kLeastSize : 2 * (_allSlots.back()->mask + 1);
            auto slots = std::make_unique<Slots>(size);
            for (auto const &other : _entries) {
                insert(*slots, *other);
            }
            // Other threads may still look at those before.
            _allSlots.push_back(std::move(slots));
            _slots.store(_allSlots.back().get(), std::memory_order_release);
        } else {
            insert(*_allSlots.back(), *_entries.back());
        }
        return {_entries.back().get(), true};
    }

private:
    // Entries by their hashes, from where these say on, without gaps.
    struct Slots {
        explicit Slots(std::size_t size)
            : mask(size - 1), entries(new std::atomic<ENTRY const *>[size]()) {}

        std::size_t const mask; // the size, a power of two, less one
        std::unique_ptr<std::atomic<ENTRY const *>[]> const entries;
    };
    static constexpr std::size_t kLeastSize = 4;

    template <typename SAME>
    static ENTRY const *find(Slots const *slots, std::size_t hash, SAME const &isSame) {
        if (!slots) {
            return nullptr;
        }
        for (std::size_t i = hash;; ++i) {
            ENTRY const *const entry =
                slots->entries[i & slots->mask].load(std::memory_order_acquire);
            if (!entry || (entry->hash == hash && isSame(*entry))) {
                return entry;
            }
        }
    }

    static void insert(Slots &slots, ENTRY const &entry) {
        std::size_t i = entry.hash;
        while (slots.entries[i & slots.mask].load(std::memory_order_relaxed)) {
            ++i;
        }
        slots.entries[i & slots.mask].store(&entry, std::memory_order_release);
    }

    std::atomic<Slots const *> _slots{nullptr};
    std::mutex _mutex;
    std::vector<std::unique_ptr<Slots>> _allSlots;
    std::vector<Pointer> _entries;
};

} // namespace OpenSubdivHex::BfrExt::internal

#endif
