// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_BFR_EXT_CELL_ENTRY_TABLE_H
#define OPENSUBDIVHEX_BFR_EXT_CELL_ENTRY_TABLE_H

#include <atomic>
#include <cstddef>
#include <memory>
#include <mutex>
#include <new>
#include <type_traits>
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
            SlotsPointer slots = makeSlots(size);
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
    using Slot = std::atomic<ENTRY const *>;
    // Entries by their hashes, from where these say on, without gaps.
    struct Slots {
        explicit Slots(std::size_t size) : mask(size - 1) {
            for (std::size_t i = 0; i < size; ++i) {
                new (GetEntries() + i) Slot(nullptr);
            }
        }

        Slot *GetEntries() { return reinterpret_cast<Slot *>(this + 1); }
        Slot const *GetEntries() const { return reinterpret_cast<Slot const *>(this + 1); }

        std::size_t const mask; // the size, a power of two, less one
    };
    static_assert(std::is_trivially_destructible_v<Slot> &&
                  sizeof(std::size_t) % alignof(Slot) == 0);
    struct DeleteSlots {
        void operator()(Slots *slots) const { ::operator delete(slots); }
    };
    using SlotsPointer = std::unique_ptr<Slots, DeleteSlots>;
    // In one block of memory with the entries.
    static SlotsPointer makeSlots(std::size_t size) {
        void *const memory = ::operator new(sizeof(Slots) + size * sizeof(Slot));
        return SlotsPointer(new (memory) Slots(size));
    }
    static constexpr std::size_t kLeastSize = 4;

    template <typename SAME>
    static ENTRY const *find(Slots const *slots, std::size_t hash, SAME const &isSame) {
        if (!slots) {
            return nullptr;
        }
        for (std::size_t i = hash;; ++i) {
            ENTRY const *const entry =
                slots->GetEntries()[i & slots->mask].load(std::memory_order_acquire);
            if (!entry || (entry->hash == hash && isSame(*entry))) {
                return entry;
            }
        }
    }

    static void insert(Slots &slots, ENTRY const &entry) {
        std::size_t i = entry.hash;
        while (slots.GetEntries()[i & slots.mask].load(std::memory_order_relaxed)) {
            ++i;
        }
        slots.GetEntries()[i & slots.mask].store(&entry, std::memory_order_release);
    }

    std::atomic<Slots const *> _slots{nullptr};
    std::mutex _mutex;
    std::vector<SlotsPointer> _allSlots;
    std::vector<Pointer> _entries;
};

} // namespace OpenSubdivHex::BfrExt::internal

#endif
