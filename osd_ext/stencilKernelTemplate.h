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

/// Without vectors of its own, for SIMD levels that have no better way.
OPENSUBDIVHEX_INLINE bool equalIndices(int const *first, int const *second, int size) {
    int difference = 0;
    for (int i = 0; i < size; ++i) {
        difference |= first[i] ^ second[i];
    }
    return difference == 0;
}

/// \brief Sums over one list of source elements: stencils that follow each other, or the outputs of
/// one stencil.
struct Run {
    std::size_t firstIndex;
    std::size_t firstWeight;
    std::ptrdiff_t firstStencil;
    int size; ///< of the list
    int numRows;
};

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

/// Row i of a run is stencil i of it.
struct RowsAreStencils {
    static OPENSUBDIVHEX_INLINE float const *Weights(StencilTask const &task, Run const &run,
                                                     int row) {
        return task.outputs[0].weights + run.firstWeight + row * std::ptrdiff_t(run.size);
    }
    static OPENSUBDIVHEX_INLINE float *Dst(StencilTask const &task, Run const &run, int row) {
        return task.outputs[0].dst + (run.firstStencil + row) * task.outputs[0].stride;
    }
    static OPENSUBDIVHEX_INLINE void Prefetch(StencilTask const &task, Run const &run,
                                              int numRows) {
        // As if each stencil had its own indices: a block's one list is asked for early.
        std::size_t const numWeights = std::size_t(numRows) * std::size_t(run.size);
        prefetchAhead(task.rows.indices + run.firstIndex, numWeights);
        prefetchAhead(Weights(task, run, 0), numWeights);
    }
};

/// Row i of a run is output i of its stencil.
struct RowsAreOutputs {
    static OPENSUBDIVHEX_INLINE float const *Weights(StencilTask const &task, Run const &run,
                                                     int row) {
        return task.outputs[row].weights + run.firstWeight;
    }
    static OPENSUBDIVHEX_INLINE float *Dst(StencilTask const &task, Run const &run, int row) {
        return task.outputs[row].dst + run.firstStencil * task.outputs[row].stride;
    }
    static OPENSUBDIVHEX_INLINE void Prefetch(StencilTask const &task, Run const &run,
                                              int numRows) {
        prefetchAhead(task.rows.indices + run.firstIndex, std::size_t(run.size));
        for (int row = 0; row < numRows; ++row) {
            prefetchAhead(Weights(task, run, row), std::size_t(run.size));
        }
    }
};

/// Adds the terms of a whole packet, which starts at term \p first, to the sums of all rows.
template <class PACKET, int ROWS, class SOURCE>
OPENSUBDIVHEX_INLINE void addPacket(SOURCE src, int const *indices, float const *const *weights,
                                    int first, typename PACKET::Vector *sums) {
    auto const elements = PACKET::LoadElements(src, indices + first);
    for (int row = 0; row < ROWS; ++row) {
        sums[row] =
            PACKET::MultiplyAdd(elements, PACKET::LoadWeights(weights[row] + first), sums[row]);
    }
}

/// The same of what is left from term \p first on, a packet or less of it.
template <class PACKET, int ROWS, class SOURCE>
OPENSUBDIVHEX_INLINE void addRest(SOURCE src, int const *indices, float const *const *weights,
                                  int first, int size, typename PACKET::Vector *sums) {
    constexpr int kNumElements = PACKET::kNumElements;
    int const numLeft = size - first;
    if (numLeft >= kNumElements) {
        return addPacket<PACKET, ROWS>(src, indices, weights, first, sums);
    }
    if constexpr (kNumElements > 1) {
        if (numLeft > 0 && size > kNumElements) {
            // Overlaps the packet before it: no branch for each number of those left.
            int const last = size - kNumElements;
            auto const elements = PACKET::LoadElements(src, indices + last);
            for (int row = 0; row < ROWS; ++row) {
                sums[row] = PACKET::MultiplyAddLast(
                    elements, PACKET::LoadWeights(weights[row] + last), sums[row], numLeft);
            }
        } else if (numLeft > 0) {
            auto const elements = PACKET::LoadElements(src, indices + first, numLeft);
            for (int row = 0; row < ROWS; ++row) {
                sums[row] = PACKET::MultiplyAdd(
                    elements, PACKET::LoadWeights(weights[row] + first, numLeft), sums[row]);
            }
        }
    }
}

/// \brief WIDTH floats, from float \p firstFloat of the elements on, of the runs from \p run on
/// that have ROWS rows each: up to \p end or the first with another number, which is returned.
///
/// SIMD::Packet<WIDTH> holds kNumElements consecutive terms of a sum, WIDTH floats each, of which
/// kNumSums, 1 or 2, run side by side so that one addition need not wait for the one before it.
/// The order of a sum depends on nothing but its size.
///
/// Not inlined: where all numbers of rows share their registers, compilers run out of them.
template <class SIMD, int WIDTH, int ROWS, class KIND, int STRIDE>
OPENSUBDIVHEX_NOINLINE Run const *sumRuns(StencilTask const &task, Source<STRIDE> src,
                                          int firstFloat, Run const *run, Run const *end) {
    using Packet = typename SIMD::template Packet<WIDTH>;
    constexpr int kNumElements = Packet::kNumElements;
    constexpr bool kHasTwoSums = Packet::kNumSums == 2;
    constexpr int kStep = kHasTwoSums ? 2 * kNumElements : kNumElements;

    do {
        int const *const indices = task.rows.indices + run->firstIndex;
        int const size = run->size;
        // Run by run, not when they are read: so many requests at once would stop all others.
        KIND::Prefetch(task, *run, ROWS);
        float const *weights[ROWS];
        // Two arrays, not one of two dimensions, which GCC 12 keeps in memory.
        typename Packet::Vector sums[ROWS];
        [[maybe_unused]] typename Packet::Vector otherSums[ROWS];
        for (int row = 0; row < ROWS; ++row) {
            weights[row] = KIND::Weights(task, *run, row);
            sums[row] = Packet::Zero();
            otherSums[row] = Packet::Zero();
        }
        int i = 0;
        for (; i + kStep <= size; i += kStep) {
            addPacket<Packet, ROWS>(src, indices, weights, i, sums);
            if constexpr (kHasTwoSums) {
                addPacket<Packet, ROWS>(src, indices, weights, i + kNumElements, otherSums);
            }
        }
        addRest<Packet, ROWS>(src, indices, weights, i, size, sums);
        if constexpr (kHasTwoSums) {
            addRest<Packet, ROWS>(src, indices, weights, i + kNumElements, size, otherSums);
        }
        for (int row = 0; row < ROWS; ++row) {
            if constexpr (kHasTwoSums) {
                sums[row] = Packet::Add(sums[row], otherSums[row]);
            }
            Packet::StoreSum(KIND::Dst(task, *run, row) + firstFloat, sums[row]);
        }
        ++run;
    } while (run != end && run->numRows == ROWS);
    return run;
}

/// WIDTH floats of runs [run, end), from float \p firstFloat of the elements on.
template <class SIMD, int WIDTH, class KIND, int STRIDE>
void sumAllRuns(StencilTask const &task, Source<STRIDE> src, int firstFloat, Run const *run,
                Run const *end) {
    static_assert(StencilTask::kMaxRows == 6);
    constexpr decltype(&sumRuns<SIMD, WIDTH, 1, KIND, STRIDE>) kSums[] = {
        sumRuns<SIMD, WIDTH, 1, KIND>, sumRuns<SIMD, WIDTH, 2, KIND>,
        sumRuns<SIMD, WIDTH, 3, KIND>, sumRuns<SIMD, WIDTH, 4, KIND>,
        sumRuns<SIMD, WIDTH, 5, KIND>, sumRuns<SIMD, WIDTH, 6, KIND>};
    while (run != end) {
        run = kSums[run->numRows - 1](task, src, firstFloat, run, end);
    }
}

/// All floats of runs [run, end).  LENGTH is that of packed elements, or 0: any length and stride.
template <class SIMD, int LENGTH, class KIND>
OPENSUBDIVHEX_INLINE void sumElements(StencilTask const &task, Run const *run, Run const *end) {
    if constexpr (LENGTH != 0) {
        sumAllRuns<SIMD, LENGTH, KIND>(task, Source<LENGTH>{task.src}, 0, run, end);
    } else {
        // Eight floats at a time, then the rest.
        Source<0> src{task.src, task.srcStride};
        int firstFloat = 0;
        for (; task.length - firstFloat > 8; firstFloat += 8, src.data += 8) {
            sumAllRuns<SIMD, 8, KIND>(task, src, firstFloat, run, end);
        }
        constexpr decltype(&sumAllRuns<SIMD, 1, KIND, 0>) kSums[] = {
            sumAllRuns<SIMD, 1, KIND>, sumAllRuns<SIMD, 2, KIND>, sumAllRuns<SIMD, 3, KIND>,
            sumAllRuns<SIMD, 4, KIND>, sumAllRuns<SIMD, 5, KIND>, sumAllRuns<SIMD, 6, KIND>,
            sumAllRuns<SIMD, 7, KIND>, sumAllRuns<SIMD, 8, KIND>};
        kSums[task.length - firstFloat - 1](task, src, firstFloat, run, end);
    }
}

/// \brief Splits stencils [begin, end) of a task, or blocks of them, into runs.
///
/// Apart from the sums, and several runs at a time, because neither leaves registers to the other.
template <class SIMD>
class RunReader {
public:
    static constexpr int kMaxRuns = 4;

    RunReader(StencilTask const &task, int begin, int end, std::size_t firstWeight)
        : _task(task), _next(begin), _end(end), _firstWeight(firstWeight) {}

    bool IsAtEnd() const { return _next >= _end; }

    /// The next runs, kMaxRuns at most: writes them and returns the end of those written.
    OPENSUBDIVHEX_NOINLINE Run *ReadStencils(Run *run) {
        int const *const sizes = _task.rows.sizes;
        int const *const offsets = _task.rows.offsets;
        Run const *const endOfRuns = run + kMaxRuns;
        int const end = _end;
        int i = _next;
        std::size_t next = _firstWeight;
        for (; i < end && run != endOfRuns; ++run) {
            std::size_t const first = offsets ? std::size_t(offsets[i]) : next;
            int const size = sizes[i];
            int const *const indices = _task.rows.indices + first;
            *run = {first, first, i, size, 1};
            next = first + std::size_t(size);
            int numRows = 1;
            for (++i; i < end && numRows < StencilTask::kMaxRows && sizes[i] == size; ++i) {
                bool const follows = !offsets || std::size_t(offsets[i]) == next;
                if (!follows || !haveEqualIndices(indices, _task.rows.indices + next, size)) {
                    break;
                }
                next += std::size_t(size);
                ++numRows;
            }
            run->numRows = numRows;
        }
        _next = i;
        _firstWeight = next;
        return run;
    }

    /// The same where each stencil has several outputs.
    OPENSUBDIVHEX_NOINLINE Run *ReadOutputs(Run *run) {
        Run const *const endOfRuns = run + kMaxRuns;
        for (; _next < _end && run != endOfRuns; ++run, ++_next) {
            std::size_t const first =
                _task.rows.offsets ? std::size_t(_task.rows.offsets[_next]) : _firstWeight;
            std::size_t const size = std::size_t(_task.rows.sizes[_next]);
            *run = {first, first, _next, int(size), _task.numOutputs};
            _firstWeight = first + size;
        }
        return run;
    }

    /// The same of blocks.
    OPENSUBDIVHEX_NOINLINE Run *ReadBlocks(Run *run) {
        Run const *const endOfRuns = run + kMaxRuns;
        for (; _next < _end && run != endOfRuns; ++run, ++_next) {
            StencilBlock const &block = _task.rows.blocks[_next];
            *run = {std::size_t(block.firstIndex), std::size_t(block.firstWeight),
                    block.firstStencil, block.size, block.numStencils};
        }
        return run;
    }

private:
    static OPENSUBDIVHEX_INLINE bool haveEqualIndices(int const *first, int const *second,
                                                      int size) {
        return size > 0 && *first == *second && SIMD::EqualIndices(first, second, size);
    }

    StencilTask const &_task;
    int _next;
    int const _end;
    std::size_t _firstWeight;
};

template <class SIMD, int LENGTH>
void evalStencils(StencilTask const &task, int begin, int end, std::size_t firstWeight) {
    RunReader<SIMD> reader(task, begin, end, firstWeight);
    Run runs[RunReader<SIMD>::kMaxRuns];
    while (!reader.IsAtEnd()) {
        if (task.numOutputs > 1) {
            sumElements<SIMD, LENGTH, RowsAreOutputs>(task, runs, reader.ReadOutputs(runs));
        } else {
            Run const *const endOfRuns =
                task.rows.blocks ? reader.ReadBlocks(runs) : reader.ReadStencils(runs);
            sumElements<SIMD, LENGTH, RowsAreStencils>(task, runs, endOfRuns);
        }
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
