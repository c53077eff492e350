// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_VTR_ARRAY_WRITER_H
#define OPENSUBDIVHEX_FAR_EXT_VTR_ARRAY_WRITER_H

#include "buffer.h"
#include "far_ext/status.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <type_traits>

namespace OpenSubdivHex::FarExt::internal {

/// Bytes of the blocks in which arrays are written past the caches: about as many cache lines as a
/// core has on the way to memory at a time (10 to 16), so that it does not wait for them while it
/// makes the next block.
constexpr std::size_t kBlockSize = 12 * kCacheLine;

/// \brief Copies without bringing \p dst into the caches, where the processor (and this code) can.
///
/// A store to memory that is in no cache reads it first; this does not.
void CopyPastCaches(void *dst, void const *src, std::size_t bytes);
/// Such copies may be late: to be called before other threads are told of them.
void FinishCopiesPastCaches();

/// Writes two entries by one store, which compilers do not always make of two.
inline void WritePair(Far::Index *entries, Far::Index first, Far::Index second) {
    Far::Index const pair[2] = {first, second};
    std::memcpy(entries, pair, sizeof(pair));
}

/// \brief Writes count groups of SIZE entries to \p array, from front to back: calls
/// fill(entries, i) for i = 0 ... count - 1, which writes group i to entries.
///
/// \param array       overlaps nothing that fill reads
/// \param pastCaches  for an array that is larger than the caches.  Groups are then collected in a
///                    block that stays in the first cache; FinishCopiesPastCaches() is to follow.
template <int SIZE, typename T, typename FUNCTION>
void WriteArray(T *__restrict array, Far::Index count, bool pastCaches, FUNCTION fill) {
    static_assert(std::is_trivially_copyable_v<T>);
    if (!pastCaches) {
        for (Far::Index i = 0; i < count; ++i, array += SIZE) {
            fill(array, i);
        }
        return;
    }
    constexpr Far::Index kBlockGroups = kBlockSize / (SIZE * sizeof(T));
    alignas(kCacheLine) T block[(kBlockSize + kCacheLine) / sizeof(T)];
    std::size_t numHeld = 0; // entries that wait for the rest of their cache line
    for (Far::Index begin = 0; begin < count; begin += kBlockGroups) {
        Far::Index const end = begin + std::min(count - begin, kBlockGroups);
        T *entries = block + numHeld;
        for (Far::Index i = begin; i < end; ++i, entries += SIZE) {
            fill(entries, i);
        }
        std::size_t const numEntries = entries - block;
        numHeld = end == count ? 0
                               : reinterpret_cast<std::uintptr_t>(array + numEntries) % kCacheLine /
                                     sizeof(T);
        std::size_t const numCopied = numEntries - numHeld;
        CopyPastCaches(array, block, numCopied * sizeof(T));
        array += numCopied;
        std::copy(block + numCopied, block + numEntries, block);
    }
}

/// \brief Writes the same for indices that follow from those of group 0, which fill(entries)
/// writes: from group to group all grow by \p increment.
template <int SIZE, typename FUNCTION>
void WriteSequence(Far::Index *array, Far::Index count, bool pastCaches, Far::Index increment,
                   FUNCTION fill) {
    // Whole vectors at a time, as long as there are enough groups.
    constexpr int kGroups = SIZE % 4 == 0 ? 1 : 4;
    std::array<Far::Index, std::size_t(kGroups * SIZE)> first;
    for (int i = 0; i < kGroups; ++i) {
        fill(first.data() + SIZE * i);
        for (int k = 0; k < SIZE; ++k) {
            first[SIZE * i + k] += increment * i;
        }
    }
    Far::Index const numWhole = count / kGroups;
    WriteArray<kGroups * SIZE>(array, numWhole, pastCaches, [=](Far::Index *entries, Far::Index i) {
        for (int k = 0; k < kGroups * SIZE; ++k) {
            entries[k] = first[k] + kGroups * increment * i;
        }
    });
    WriteArray<SIZE>(array + std::size_t(numWhole) * first.size(), count % kGroups, pastCaches,
                     [=](Far::Index *entries, Far::Index i) {
                         for (int k = 0; k < SIZE; ++k) {
                             entries[k] = first[k] + increment * (kGroups * numWhole + i);
                         }
                     });
}

} // namespace OpenSubdivHex::FarExt::internal

#endif
