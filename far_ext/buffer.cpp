// SPDX-License-Identifier: Apache-2.0
#include "buffer.h"

#include <cstdlib>
#include <new>

#if defined(__linux__)
#include <sys/mman.h>
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

} // namespace OpenSubdivHex::FarExt::internal
