// SPDX-License-Identifier: Apache-2.0
//
// The kernel of all evaluators.  It is compiled once per SIMD level, each time with the flags of
// that level, so all of it must have internal linkage: the linker may not hand code of one level to
// another.  Hence the unnamed namespace, and no inline function of the standard library.
#ifndef OPENSUBDIVHEX_OSD_EXT_STENCIL_KERNEL_TEMPLATE_H
#define OPENSUBDIVHEX_OSD_EXT_STENCIL_KERNEL_TEMPLATE_H

#include "stencilKernel.h"

#include "osd_ext/simd/quad.h"

#include <cstddef>
#include <cstdint>

#if defined(__GNUC__)
#define OPENSUBDIVHEX_NOINLINE __attribute__((noinline))
#else
#define OPENSUBDIVHEX_NOINLINE
#endif

namespace OpenSubdivHex::OsdExt::internal {
namespace {

/// Source elements by index.  STRIDE is known when compiling, or 0.
template <int STRIDE>
struct Source {
    OPENSUBDIVHEX_INLINE float const *operator[](int index) const {
        return data + std::ptrdiff_t(index) * STRIDE;
    }

    float const *data;
};

template <>
struct Source<0> {
    OPENSUBDIVHEX_INLINE float const *operator[](int index) const {
        return data + std::ptrdiff_t(index) * stride;
    }

    float const *data;
    std::ptrdiff_t stride;
};

/// Asks for the indices and the weights that lie some stencils behind those of a list: benchmark
/// evaluation, large meshes, 1.3 times as fast with it.  Two cache lines of each, which lists of up
/// to 32 fill; a loop over the lines of longer ones would cost more than it gains.
template <int ROWS>
OPENSUBDIVHEX_INLINE void prefetchAhead([[maybe_unused]] int const *indices,
                                        [[maybe_unused]] float const *const *weights) {
#if defined(__GNUC__)
    constexpr std::uintptr_t kCacheLine = 64;
    constexpr std::uintptr_t kBytesAhead = 4096;
    auto const prefetch = [](void const *entries) {
        // Numbers, since a pointer may not lead behind the end of its array.
        auto const address = reinterpret_cast<std::uintptr_t>(entries) + kBytesAhead;
        __builtin_prefetch(reinterpret_cast<void const *>(address));
        __builtin_prefetch(reinterpret_cast<void const *>(address + kCacheLine));
    };
    prefetch(indices);
    for (int row = 0; row < ROWS; ++row) {
        prefetch(weights[row]);
    }
#endif
}

/// \brief Sums over one list of source elements: writes WIDTH floats per row of weights to dst.
///
/// SIMD::Packet<WIDTH> holds kNumElements consecutive terms of a sum, WIDTH floats each.  The order
/// of a sum depends on nothing but its size.
template <class SIMD, int WIDTH, int ROWS, int STRIDE>
OPENSUBDIVHEX_INLINE void sumRows(Source<STRIDE> src, int const *indices, int size,
                                  float const *const *weights, float *const *dst) {
    using Packet = typename SIMD::template Packet<WIDTH>;
    constexpr int kNumElements = Packet::kNumElements;

    prefetchAhead<ROWS>(indices, weights);
    typename Packet::Vector sums[ROWS];
    for (int row = 0; row < ROWS; ++row) {
        sums[row] = Packet::Zero();
    }
    int const last = size - kNumElements;
    if (last >= 0) {
        for (int i = 0; i < last; i += kNumElements) {
            auto const elements = Packet::LoadElements(src, indices + i);
            for (int row = 0; row < ROWS; ++row) {
                sums[row] =
                    Packet::MultiplyAdd(elements, Packet::LoadWeights(weights[row] + i), sums[row]);
            }
        }
        // Overlaps the packet before it: no branch for each number of those left.
        static_assert((kNumElements & (kNumElements - 1)) == 0);
        int const numAdded = -size & (kNumElements - 1);
        auto const elements = Packet::LoadElements(src, indices + last);
        for (int row = 0; row < ROWS; ++row) {
            sums[row] = Packet::MultiplyAddFrom(
                numAdded, elements, Packet::LoadWeights(weights[row] + last), sums[row]);
        }
    } else if (size > 0) {
        auto const elements = Packet::LoadElements(src, indices, size);
        for (int row = 0; row < ROWS; ++row) {
            sums[row] =
                Packet::MultiplyAdd(elements, Packet::LoadWeights(weights[row], size), sums[row]);
        }
    }
    for (int row = 0; row < ROWS; ++row) {
        Packet::StoreSum(dst[row], sums[row]);
    }
}

/// \brief WIDTH floats, from float \p firstFloat of the elements on, of ROWS outputs of stencils
/// [begin, end).
///
/// Stencils that follow each other and have equal indices could share the loads of their elements,
/// as those of a block do.  But to compare the indices costs as much as that gains, and makes the
/// stencils of Catmull-Clark, which have none to share, 1.5 times as dear (benchmark evaluation).
///
/// Not inlined: where all numbers of rows share their registers, compilers run out of them.
/// \return  where the indices of stencil \p end start
template <class SIMD, int WIDTH, int ROWS, int STRIDE>
OPENSUBDIVHEX_NOINLINE std::size_t sumStencils(StencilTask const &task, Source<STRIDE> src,
                                               int firstFloat, int begin, int end,
                                               std::size_t firstWeight) {
    // Copies, since the compiler must expect that sums are written to the task.
    StencilRows const rows = task.rows;
    StencilTask::Output outputs[ROWS];
    for (int row = 0; row < ROWS; ++row) {
        outputs[row] = task.outputs[row];
    }
    for (int i = begin; i < end; ++i) {
        std::size_t const first = rows.offsets ? std::size_t(rows.offsets[i]) : firstWeight;
        int const size = rows.sizes[i];
        float const *weights[ROWS];
        float *dst[ROWS];
        for (int row = 0; row < ROWS; ++row) {
            weights[row] = outputs[row].weights + first;
            dst[row] = outputs[row].dst + i * outputs[row].stride + firstFloat;
        }
        sumRows<SIMD, WIDTH, ROWS>(src, rows.indices + first, size, weights, dst);
        firstWeight = first + std::size_t(size);
    }
    return firstWeight;
}

/// \brief Sums up the blocks from \p block on that have ROWS stencils each: up to \p end or the
/// first block with another number, which is returned.
template <class SIMD, int WIDTH, int ROWS, int STRIDE>
OPENSUBDIVHEX_NOINLINE StencilBlock const *sumBlocks(StencilTask const &task, Source<STRIDE> src,
                                                     int firstFloat, StencilBlock const *block,
                                                     StencilBlock const *end) {
    int const *const indices = task.rows.indices;
    StencilTask::Output const output = task.outputs[0];
    do {
        float const *weights[ROWS];
        float *dst[ROWS];
        for (int row = 0; row < ROWS; ++row) {
            weights[row] = output.weights + block->firstWeight + row * std::ptrdiff_t(block->size);
            dst[row] = output.dst + (block->firstStencil + row) * output.stride + firstFloat;
        }
        sumRows<SIMD, WIDTH, ROWS>(src, indices + block->firstIndex, block->size, weights, dst);
        ++block;
    } while (block != end && block->numStencils == ROWS);
    return block;
}

/// \brief WIDTH floats, from float \p firstFloat of the elements on, of all outputs of stencils, or
/// of blocks, [begin, end).
/// \return  where the indices of stencil \p end start
template <class SIMD, int WIDTH, int STRIDE>
std::size_t sumFloats(StencilTask const &task, Source<STRIDE> src, int firstFloat, int begin,
                      int end, std::size_t firstWeight) {
    if (task.rows.blocks) {
        static_assert(StencilTask::kMaxRows == 6);
        constexpr decltype(&sumBlocks<SIMD, WIDTH, 1, STRIDE>) kSums[] = {
            sumBlocks<SIMD, WIDTH, 1>, sumBlocks<SIMD, WIDTH, 2>, sumBlocks<SIMD, WIDTH, 3>,
            sumBlocks<SIMD, WIDTH, 4>, sumBlocks<SIMD, WIDTH, 5>, sumBlocks<SIMD, WIDTH, 6>};
        StencilBlock const *block = task.rows.blocks + begin;
        while (block != task.rows.blocks + end) {
            block =
                kSums[block->numStencils - 1](task, src, firstFloat, block, task.rows.blocks + end);
        }
        return firstWeight;
    }
    switch (task.numOutputs) {
    case 1:
        return sumStencils<SIMD, WIDTH, 1>(task, src, firstFloat, begin, end, firstWeight);
    case 3:
        return sumStencils<SIMD, WIDTH, 3>(task, src, firstFloat, begin, end, firstWeight);
    default:
        return sumStencils<SIMD, WIDTH, 6>(task, src, firstFloat, begin, end, firstWeight);
    }
}

/// All floats of stencils [begin, end), whose elements are packed and of length LENGTH.
template <class SIMD, int LENGTH>
void evalPacked(StencilTask const &task, int begin, int end, std::size_t firstWeight) {
    sumFloats<SIMD, LENGTH>(task, Source<LENGTH>{task.src}, 0, begin, end, firstWeight);
}

/// Any length and stride: eight floats at a time, then the rest.
template <class SIMD>
void evalStrided(StencilTask const &task, int begin, int end, std::size_t firstWeight) {
    constexpr decltype(&sumFloats<SIMD, 8, 0>) kSums[] = {
        sumFloats<SIMD, 1>, sumFloats<SIMD, 2>, sumFloats<SIMD, 3>, sumFloats<SIMD, 4>,
        sumFloats<SIMD, 5>, sumFloats<SIMD, 6>, sumFloats<SIMD, 7>, sumFloats<SIMD, 8>};
    // Few stencils at a time: the first cache keeps their indices and weights for the next floats.
    constexpr int kBatch = 16;
    for (int next = begin; begin < end; begin = next) {
        next = end - begin > kBatch ? begin + kBatch : end;
        std::size_t nextWeight = firstWeight;
        for (int firstFloat = 0; firstFloat < task.length; firstFloat += 8) {
            int const numLeft = task.length - firstFloat;
            Source<0> const src{task.src + firstFloat, task.srcStride};
            nextWeight = kSums[numLeft < 8 ? numLeft - 1 : 7](task, src, firstFloat, begin, next,
                                                              firstWeight);
        }
        firstWeight = nextWeight;
    }
}

/// The kernel for a SIMD level: see StencilKernel.
template <class SIMD>
OPENSUBDIVHEX_INLINE void evalStencilsAs(StencilTask const &task, int begin, int end,
                                         std::size_t firstWeight) {
    switch (task.srcStride == task.length ? task.length : 0) {
    case 1:
        return evalPacked<SIMD, 1>(task, begin, end, firstWeight);
    case 2:
        return evalPacked<SIMD, 2>(task, begin, end, firstWeight);
    case 3:
        return evalPacked<SIMD, 3>(task, begin, end, firstWeight);
    case 4:
        return evalPacked<SIMD, 4>(task, begin, end, firstWeight);
    case 6:
        return evalPacked<SIMD, 6>(task, begin, end, firstWeight);
    case 8:
        return evalPacked<SIMD, 8>(task, begin, end, firstWeight);
    default:
        return evalStrided<SIMD>(task, begin, end, firstWeight);
    }
}

} // namespace
} // namespace OpenSubdivHex::OsdExt::internal

#endif
