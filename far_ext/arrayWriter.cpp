// SPDX-License-Identifier: Apache-2.0
#include "arrayWriter.h"

#include <cstdint>
#include <cstring>

#if defined(__SSE2__) || defined(_M_X64)
#include <emmintrin.h>
#endif

namespace OpenSubdivHex::FarExt::internal {

#if defined(__SSE2__) || defined(_M_X64)
void CopyPastCaches(void *dst, void const *src, std::size_t bytes) {
    // Whole cache lines are streamed; the ends share theirs with what others write.
    auto *to = static_cast<std::byte *>(dst);
    auto const *from = static_cast<std::byte const *>(src);
    std::size_t const misaligned = reinterpret_cast<std::uintptr_t>(to) % kCacheLine;
    std::size_t const head = std::min(bytes, (kCacheLine - misaligned) % kCacheLine);
    std::memcpy(to, from, head);
    std::size_t done = head;
    for (; done + kCacheLine <= bytes; done += kCacheLine) {
        for (std::size_t i = 0; i < kCacheLine; i += sizeof(__m128i)) {
            _mm_stream_si128(reinterpret_cast<__m128i *>(to + done + i),
                             _mm_loadu_si128(reinterpret_cast<__m128i const *>(from + done + i)));
        }
    }
    std::memcpy(to + done, from + done, bytes - done);
}
void FinishCopiesPastCaches() { _mm_sfence(); }
#else
void CopyPastCaches(void *dst, void const *src, std::size_t bytes) { std::memcpy(dst, src, bytes); }
void FinishCopiesPastCaches() {}
#endif

} // namespace OpenSubdivHex::FarExt::internal
