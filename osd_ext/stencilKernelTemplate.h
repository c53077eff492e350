// SPDX-License-Identifier: Apache-2.0
//
// The kernel of all evaluators.  It is compiled once per SIMD level, each time with the flags of
// that level, so all of it must have internal linkage: the linker may not hand code of one level to
// another.  Hence the unnamed namespace, and no inline function of the standard library.
#ifndef OPENSUBDIVHEX_OSD_EXT_STENCIL_KERNEL_TEMPLATE_H
#define OPENSUBDIVHEX_OSD_EXT_STENCIL_KERNEL_TEMPLATE_H

#include "stencilKernel.h"

#include <cstddef>
#include <cstdint>

#if defined(__GNUC__)
#define OPENSUBDIVHEX_INLINE inline __attribute__((always_inline))
#define OPENSUBDIVHEX_NOINLINE __attribute__((noinline))
#else
#define OPENSUBDIVHEX_INLINE inline
#define OPENSUBDIVHEX_NOINLINE
#endif

namespace OpenSubdivHex::OsdExt::internal {
namespace {

/// Source elements by index.  STRIDE is known when compiling, or 0.
template <int STRIDE>
struct Source {
    OPENSUBDIVHEX_INLINE float const *operator[](int index) const {
        return data + std::ptrdiff_t(index) * (STRIDE != 0 ? STRIDE : stride);
    }

    float const *data;
    std::ptrdiff_t stride;
};

/// \brief ROWS sums over the same source elements: ROWS outputs of one stencil, or stencils of one
/// index list.
///
/// SIMD::Packet<WIDTH> holds kNumElements consecutive terms of a sum, WIDTH floats each, of which
/// kNumSums run side by side so that one addition need not wait for the one before it.  The order
/// of a sum depends on nothing but its size.
template <class SIMD, int WIDTH, int ROWS, int STRIDE>
OPENSUBDIVHEX_INLINE void sumRows(Source<STRIDE> src, int const *indices, int size,
                                  float const *const *weights, float *const *dst) {
    using Packet = typename SIMD::template Packet<WIDTH>;
    constexpr int kNumElements = Packet::kNumElements;
    constexpr int kNumSums = Packet::kNumSums;

    typename Packet::Vector sums[kNumSums][ROWS];
    for (int k = 0; k < kNumSums; ++k) {
        for (int row = 0; row < ROWS; ++row) {
            sums[k][row] = Packet::Zero();
        }
    }
    int i = 0;
    for (; i + kNumSums * kNumElements <= size; i += kNumSums * kNumElements) {
        for (int k = 0; k < kNumSums; ++k) {
            int const first = i + k * kNumElements;
            auto const elements = Packet::LoadElements(src, indices + first);
            for (int row = 0; row < ROWS; ++row) {
                sums[k][row] = Packet::MultiplyAdd(
                    elements, Packet::LoadWeights(weights[row] + first), sums[k][row]);
            }
        }
    }
    for (int k = 0; k < kNumSums; ++k) {
        int const first = i + k * kNumElements;
        int const numLeft = size - first;
        if (numLeft >= kNumElements) {
            auto const elements = Packet::LoadElements(src, indices + first);
            for (int row = 0; row < ROWS; ++row) {
                sums[k][row] = Packet::MultiplyAdd(
                    elements, Packet::LoadWeights(weights[row] + first), sums[k][row]);
            }
        } else if (numLeft > 0) {
            auto const elements = Packet::LoadElements(src, indices + first, numLeft);
            for (int row = 0; row < ROWS; ++row) {
                sums[k][row] = Packet::MultiplyAdd(
                    elements, Packet::LoadWeights(weights[row] + first, numLeft), sums[k][row]);
            }
        }
    }
    for (int row = 0; row < ROWS; ++row) {
        auto sum = sums[0][row];
        for (int k = 1; k < kNumSums; ++k) {
            sum = Packet::Add(sum, sums[k][row]);
        }
        Packet::StoreSum(dst[row], sum);
    }
}

/// WIDTH floats of \p numRows rows, from float \p firstFloat of the elements on.
template <class SIMD, int WIDTH, int STRIDE>
OPENSUBDIVHEX_INLINE void sumAllRows(Source<STRIDE> src, int const *indices, int size, int numRows,
                                     float const *const *weights, float *const *dst) {
    if constexpr (SIMD::template Packet<WIDTH>::kMaxRows >= 6) {
        for (; numRows >= 6; numRows -= 6, weights += 6, dst += 6) {
            sumRows<SIMD, WIDTH, 6>(src, indices, size, weights, dst);
        }
    }
    for (; numRows >= 3; numRows -= 3, weights += 3, dst += 3) {
        sumRows<SIMD, WIDTH, 3>(src, indices, size, weights, dst);
    }
    if (numRows == 2) {
        sumRows<SIMD, WIDTH, 2>(src, indices, size, weights, dst);
    } else if (numRows == 1) {
        sumRows<SIMD, WIDTH, 1>(src, indices, size, weights, dst);
    }
}

OPENSUBDIVHEX_INLINE bool equalIndices(int const *first, int const *second, int size) {
    if (size == 0 || first[0] != second[0] || first[size - 1] != second[size - 1]) {
        return false;
    }
    int difference = 0;
    for (int i = 0; i < size; ++i) {
        difference |= first[i] ^ second[i];
    }
    return difference == 0;
}

template <class SIMD, int WIDTH>
OPENSUBDIVHEX_NOINLINE void sumWidth(Source<0> src, int const *indices, int size, int numRows,
                                     float const *const *weights, float *const *dst) {
    sumAllRows<SIMD, WIDTH>(src, indices, size, numRows, weights, dst);
}

/// Eight floats at a time, then the rest.  Advances \p dst.
template <class SIMD>
void sumAnyLength(StencilTask const &task, int const *indices, int size, int numRows,
                  float const *const *weights, float **dst) {
    Source<0> src{task.src, task.srcStride};
    int length = task.length;
    for (; length > 8; length -= 8) {
        sumWidth<SIMD, 8>(src, indices, size, numRows, weights, dst);
        src.data += 8;
        for (int row = 0; row < numRows; ++row) {
            dst[row] += 8;
        }
    }
    constexpr decltype(&sumWidth<SIMD, 1>) kSums[] = {
        sumWidth<SIMD, 1>, sumWidth<SIMD, 2>, sumWidth<SIMD, 3>, sumWidth<SIMD, 4>,
        sumWidth<SIMD, 5>, sumWidth<SIMD, 6>, sumWidth<SIMD, 7>, sumWidth<SIMD, 8>};
    kSums[length - 1](src, indices, size, numRows, weights, dst);
}

/// All floats of \p numRows rows.  LENGTH is that of packed elements, or 0: any length and stride.
template <class SIMD, int LENGTH>
OPENSUBDIVHEX_INLINE void sumElements(StencilTask const &task, int const *indices, int size,
                                      int numRows, float const *const *weights, float **dst) {
    if constexpr (LENGTH != 0) {
        sumAllRows<SIMD, LENGTH>(Source<LENGTH>{task.src, LENGTH}, indices, size, numRows, weights,
                                 dst);
    } else {
        sumAnyLength<SIMD>(task, indices, size, numRows, weights, dst);
    }
}

/// Asks for the memory that lies some stencils behind \p count entries of the indices or weights:
/// benchmark evaluation/quad5, 1.2 to 1.7 times as fast with it.
template <class ENTRY>
OPENSUBDIVHEX_INLINE void prefetchAhead([[maybe_unused]] ENTRY const *entries,
                                        [[maybe_unused]] std::size_t count) {
#if defined(__GNUC__)
    constexpr std::size_t kBytesAhead = 4096;
    constexpr std::size_t kCacheLine = 64;
    // Numbers, since a pointer may not lead behind the end of its array.
    std::uintptr_t const begin = reinterpret_cast<std::uintptr_t>(entries) + kBytesAhead;
    std::uintptr_t const end = begin + count * sizeof(ENTRY);
    for (std::uintptr_t address = begin; address < end; address += kCacheLine) {
        __builtin_prefetch(reinterpret_cast<void const *>(address));
    }
#endif
}

template <class SIMD, int LENGTH>
void evalBlocks(StencilTask const &task, int begin, int end) {
    StencilTask::Output const &output = task.outputs[0];
    float const *weights[StencilTask::kMaxRows];
    float *dst[StencilTask::kMaxRows];
    for (int i = begin; i < end; ++i) {
        StencilBlock const &block = task.rows.blocks[i];
        int const *const indices = task.rows.indices + block.firstIndex;
        std::size_t const size = std::size_t(block.size);
        for (int row = 0; row < block.numStencils; ++row) {
            weights[row] = output.weights + block.firstWeight + std::size_t(row) * size;
            dst[row] = output.dst + (std::ptrdiff_t(block.firstStencil) + row) * output.stride;
        }
        prefetchAhead(indices, size);
        prefetchAhead(weights[0], std::size_t(block.numStencils) * size);
        sumElements<SIMD, LENGTH>(task, indices, block.size, block.numStencils, weights, dst);
    }
}

template <class SIMD, int LENGTH>
void evalStencils(StencilTask const &task, int begin, int end, std::size_t firstWeight) {
    if (task.rows.blocks) {
        return evalBlocks<SIMD, LENGTH>(task, begin, end);
    }
    constexpr int kMaxRows = StencilTask::kMaxRows;
    StencilTask::Output const *const outputs = task.outputs;
    int const *const sizes = task.rows.sizes;
    int const *const offsets = task.rows.offsets;
    float const *weights[kMaxRows];
    float *dst[kMaxRows];

    std::size_t next = firstWeight;
    for (int i = begin; i < end;) {
        std::size_t const first = offsets ? std::size_t(offsets[i]) : next;
        int const size = sizes[i];
        int const *const indices = task.rows.indices + first;
        next = first + std::size_t(size);
        int numRows = 0;
        if (task.numOutputs > 1) {
            for (; numRows < task.numOutputs; ++numRows) {
                StencilTask::Output const &output = outputs[numRows];
                weights[numRows] = output.weights + first;
                dst[numRows] = output.dst + i * output.stride;
            }
            ++i;
        } else {
            std::size_t rowFirst = first;
            do {
                weights[numRows] = outputs[0].weights + rowFirst;
                dst[numRows] = outputs[0].dst + i * outputs[0].stride;
                next = rowFirst + std::size_t(size);
                ++numRows;
                ++i;
                if (i == end || numRows == kMaxRows || sizes[i] != size) {
                    break;
                }
                rowFirst = offsets ? std::size_t(offsets[i]) : next;
            } while (equalIndices(indices, task.rows.indices + rowFirst, size));
        }
        std::size_t const numWeights =
            std::size_t(size) * std::size_t(task.numOutputs > 1 ? 1 : numRows);
        prefetchAhead(indices, numWeights);
        prefetchAhead(weights[0], numWeights);
        sumElements<SIMD, LENGTH>(task, indices, size, numRows, weights, dst);
    }
}

/// The kernel for a SIMD level: see StencilKernel.
template <class SIMD>
OPENSUBDIVHEX_INLINE void evalStencilsAs(StencilTask const &task, int begin, int end,
                                         std::size_t firstWeight) {
    switch (task.srcStride == task.length ? task.length : 0) {
    case 1:
        return evalStencils<SIMD, 1>(task, begin, end, firstWeight);
    case 2:
        return evalStencils<SIMD, 2>(task, begin, end, firstWeight);
    case 3:
        return evalStencils<SIMD, 3>(task, begin, end, firstWeight);
    case 4:
        return evalStencils<SIMD, 4>(task, begin, end, firstWeight);
    case 6:
        return evalStencils<SIMD, 6>(task, begin, end, firstWeight);
    case 8:
        return evalStencils<SIMD, 8>(task, begin, end, firstWeight);
    default:
        return evalStencils<SIMD, 0>(task, begin, end, firstWeight);
    }
}

} // namespace
} // namespace OpenSubdivHex::OsdExt::internal

#endif
