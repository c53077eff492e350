// SPDX-License-Identifier: Apache-2.0
#include "buffer.h"

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <new>

#if defined(__linux__)
#include <sys/mman.h>
#include <unistd.h>
#endif

namespace OpenSubdivHex::FarExt::internal {

namespace {
constexpr std::size_t kHugePage = std::size_t(2) << 20;

std::size_t roundUp(std::size_t bytes, std::size_t unit) {
    return (bytes + unit - 1) / unit * unit;
}
} // namespace

void *AllocateArray(std::size_t bytes) {
    std::size_t const alignment = bytes >= kHugePage ? kHugePage : kCacheLine;
    void *memory = std::aligned_alloc(alignment, roundUp(bytes, alignment));
    if (!memory) {
        throw std::bad_alloc();
    }
#if defined(__linux__)
    if (alignment == kHugePage) {
        // Advice only: without huge pages the array is as good, just slower to touch first.
        madvise(memory, roundUp(bytes, alignment), MADV_HUGEPAGE);
    }
#endif
    return memory;
}

void FreeArray(void *memory) { std::free(memory); }

void PrepareArray([[maybe_unused]] void *memory, [[maybe_unused]] std::size_t bytes) {
#if defined(__linux__)
    auto const address = reinterpret_cast<std::uintptr_t>(memory);
    std::size_t const skipped = roundUp(address, kHugePage) - address;
    if (bytes < skipped + 2 * kHugePage) {
        return;
    }
    std::size_t const numPages = (bytes - skipped) / kHugePage;
    char *const pages = static_cast<char *>(memory) + skipped;
    // Advice only, as above; a system too old to make pages ready makes them at first touch.
    madvise(pages, numPages * kHugePage, MADV_HUGEPAGE);
#ifdef MADV_POPULATE_WRITE
    constexpr std::size_t kPagesPerCall = 8;
#ifdef _OPENMP
#pragma omp parallel for schedule(dynamic)
#endif
    for (std::size_t page = 0; page < numPages; page += kPagesPerCall) {
        madvise(pages + page * kHugePage, std::min(kPagesPerCall, numPages - page) * kHugePage,
                MADV_POPULATE_WRITE);
    }
#endif
#endif
}

bool IsResident([[maybe_unused]] void const *memory, [[maybe_unused]] std::size_t bytes) {
#if defined(__linux__)
    auto const middle = reinterpret_cast<std::uintptr_t>(memory) + bytes / 2;
    std::uintptr_t const page = middle - middle % std::uintptr_t(sysconf(_SC_PAGESIZE));
    unsigned char isResident = 0;
    if (mincore(reinterpret_cast<void *>(page), 1, &isResident) == 0) {
        return isResident & 1;
    }
#endif
    return true;
}

} // namespace OpenSubdivHex::FarExt::internal
