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
        // All is read before the first write: so are lines written at the speed of memory.
        auto const *const line = reinterpret_cast<__m128i const *>(from + done);
        auto *const dstLine = reinterpret_cast<__m128i *>(to + done);
        __m128i const quarter0 = _mm_loadu_si128(line);
        __m128i const quarter1 = _mm_loadu_si128(line + 1);
        __m128i const quarter2 = _mm_loadu_si128(line + 2);
        __m128i const quarter3 = _mm_loadu_si128(line + 3);
        _mm_stream_si128(dstLine, quarter0);
        _mm_stream_si128(dstLine + 1, quarter1);
        _mm_stream_si128(dstLine + 2, quarter2);
        _mm_stream_si128(dstLine + 3, quarter3);
    }
    std::memcpy(to + done, from + done, bytes - done);
}
void FinishCopiesPastCaches() { _mm_sfence(); }
#else
void CopyPastCaches(void *dst, void const *src, std::size_t bytes) { std::memcpy(dst, src, bytes); }
void FinishCopiesPastCaches() {}
#endif

} // namespace OpenSubdivHex::FarExt::internal
