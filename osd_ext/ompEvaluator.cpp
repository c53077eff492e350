// SPDX-License-Identifier: Apache-2.0
#include "ompEvaluator.h"

#include "far_ext/threads.h"
#include "osd_ext/stencil/stencilKernel.h"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace OpenSubdivHex::OsdExt {
namespace {

/// Stencils, or blocks of them, that a thread takes at a time: enough that starting on them costs
/// nothing beside them, few enough that the threads end together.
constexpr std::int64_t kMinBatch = 256;
constexpr std::int64_t kMaxBatch = 4096;
constexpr int kBatchesPerThread = 16;

// Evaluates stencils, or blocks of them, [begin, end), at least one.
void evaluate(internal::StencilTask const &task, int begin, int end) {
    internal::StencilKernel const kernel = internal::GetStencilKernel();
    std::int64_t const numStencils = std::int64_t(end) - begin;
    std::int64_t const numThreads = FarExt::GetNumThreads();
    int const batchSize =
        int(std::clamp(numStencils / (numThreads * kBatchesPerThread), kMinBatch, kMaxBatch));
    int const numBatches = int((numStencils + batchSize - 1) / batchSize);
    if (numThreads == 1 || numBatches == 1) {
        kernel(task, begin, end, internal::FindFirstWeight(task.rows, begin));
        return;
    }

    std::vector<std::size_t> firstWeights;
    if (!task.rows.HasPlaces()) {
        firstWeights.reserve(std::size_t(numBatches));
        std::size_t first = internal::FindFirstWeight(task.rows, begin);
        for (int i = begin; i < end; ++i) {
            if ((i - begin) % batchSize == 0) {
                firstWeights.push_back(first);
            }
            first += std::size_t(task.rows.sizes[i]);
        }
    }
#ifdef _OPENMP
#pragma omp parallel for schedule(dynamic) num_threads(FarExt::GetNumThreads())
#endif
    for (int batch = 0; batch < numBatches; ++batch) {
        int const batchBegin = begin + batch * batchSize;
        int const batchEnd = int(std::min<std::int64_t>(end, std::int64_t(batchBegin) + batchSize));
        std::size_t const first = firstWeights.empty() ? 0 : firstWeights[std::size_t(batch)];
        kernel(task, batchBegin, batchEnd, first);
    }
}

} // namespace

bool OmpEvaluator::IsParallel() {
#ifdef _OPENMP
    return true;
#else
    return false;
#endif
}

bool OmpEvaluator::run(float const *src, Osd::BufferDescriptor const &srcDesc,
                       internal::StencilOutput const *outputs, int numOutputs,
                       internal::StencilRows const &rows, int start, int end) {
    internal::StencilTask task;
    if (!internal::MakeStencilTask(src, srcDesc, outputs, numOutputs, rows, start, end, &task)) {
        return false;
    }
    if (start < end) {
        evaluate(task, start, end);
    }
    return true;
}

} // namespace OpenSubdivHex::OsdExt
