// SPDX-License-Identifier: Apache-2.0
#include "buffer.h"

#include "parallel.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <new>

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace OpenSubdivHex::FarExt::internal {

namespace {

constexpr std::size_t kHugePage = std::size_t(2) << 20;

std::uintptr_t roundUp(std::uintptr_t bytes, std::size_t unit) {
    return (bytes + unit - 1) / unit * unit;
}

struct Pages {
    char *begin;
    std::size_t count;
};

// The huge pages that lie within an array.  Advises the system to have them; without, the array is
// as good, just slower to touch first.
Pages adviseHugePages(void *memory, std::size_t bytes) {
    auto const address = reinterpret_cast<std::uintptr_t>(memory);
    std::size_t const skipped = roundUp(address, kHugePage) - address;
    if (bytes < skipped + kHugePage) {
        return {nullptr, 0};
    }
    Pages const pages = {static_cast<char *>(memory) + skipped, (bytes - skipped) / kHugePage};
#if defined(__linux__)
    madvise(pages.begin, pages.count * kHugePage, MADV_HUGEPAGE);
#endif
    return pages;
}

} // namespace

// Not by std::aligned_alloc: glibc may give to others what it cuts off in front of an aligned
// array.  The next of the size then finds no place where this one was, and the heap grows for ever.
void *AllocateArray(std::size_t bytes) {
    static_assert(alignof(std::max_align_t) >= sizeof(void *) &&
                  kCacheLine % alignof(std::max_align_t) == 0);
    std::size_t const alignment = bytes >= kHugePage ? kHugePage : kCacheLine;
    std::size_t const size = roundUp(bytes, alignment);
    void *const whole = std::malloc(size + alignment);
    if (!whole) {
        throw std::bad_alloc();
    }
    auto const address = reinterpret_cast<std::uintptr_t>(whole);
    char *const memory =
        static_cast<char *>(whole) + (roundUp(address + sizeof(void *), alignment) - address);
    std::memcpy(memory - sizeof(void *), &whole, sizeof(void *));
    adviseHugePages(memory, size);
    return memory;
}

void FreeArray(void *memory) {
    if (memory) {
        void *whole = nullptr;
        std::memcpy(&whole, static_cast<char *>(memory) - sizeof(void *), sizeof(void *));
        std::free(whole);
    }
}

void PrepareArray(void *memory, std::size_t bytes) {
    [[maybe_unused]] Pages const pages = adviseHugePages(memory, bytes);
#ifdef MADV_POPULATE_WRITE
    // A system too old to make pages ready makes them at first touch.
    constexpr std::size_t kPagesPerCall = 8;
    auto const numCalls = Far::Index((pages.count + kPagesPerCall - 1) / kPagesPerCall);
    auto const prepare = [&](RangeQueue &queue, int worker) {
        for (Far::Index call = 0; queue.Take(worker, &call);) {
            std::size_t const page = std::size_t(call) * kPagesPerCall;
            madvise(pages.begin + page * kHugePage,
                    std::min(kPagesPerCall, pages.count - page) * kHugePage, MADV_POPULATE_WRITE);
        }
    };
    ForEachRange(numCalls, 1, std::cref(prepare));
#endif
}

} // namespace OpenSubdivHex::FarExt::internal
