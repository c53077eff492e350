// SPDX-License-Identifier: Apache-2.0
#include "cpuEvaluator.h"

#include "far_ext/executor.h"
#include "osd_ext/stencil/stencilKernel.h"

#include <algorithm>
#include <functional>
#include <vector>

namespace OpenSubdivHex::OsdExt {
namespace {

/// Stencils, or blocks of them, that a thread takes at a time: enough that starting on them costs
/// nothing beside them, few enough that the threads end together.
constexpr int kMinBatch = 256;
constexpr int kMaxBatch = 4096;
constexpr int kNumBatches = 64; // of tables that are not very large

// Evaluates stencils, or blocks of them, [begin, end), at least one.
void evaluate(internal::StencilTask const &task, int begin, int end) {
    internal::StencilKernel const kernel = internal::GetStencilKernel();
    int const numStencils = end - begin;
    int const batchSize = std::clamp(numStencils / kNumBatches, kMinBatch, kMaxBatch);
    int const numBatches = numStencils / batchSize + (numStencils % batchSize != 0);
    if (numBatches == 1 || FarExt::GetNumThreads() == 1) {
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
    auto const evaluateBatch = [&](int batch) {
        int const batchBegin = begin + batch * batchSize;
        int const batchEnd = batchBegin + std::min(end - batchBegin, batchSize);
        std::size_t const first = firstWeights.empty() ? 0 : firstWeights[std::size_t(batch)];
        kernel(task, batchBegin, batchEnd, first);
    };
    FarExt::ParallelFor(numBatches, std::cref(evaluateBatch));
}

} // namespace

bool ParallelEvaluator::run(float const *src, Osd::BufferDescriptor const &srcDesc,
                            StencilOutput const *outputs, int numOutputs, StencilRows const &rows,
                            int start, int end) {
    internal::StencilTask task;
    if (!internal::MakeStencilTask(src, srcDesc, outputs, numOutputs, rows, start, end, &task)) {
        return false;
    }
    if (start < end) {
        evaluate(task, start, end);
    }
    return true;
}

void ParallelEvaluator::runPatches(PatchTask const &task, int numPlaces) {
    constexpr int kBatch = 1024; // some tens of microseconds
    int const numBatches = numPlaces / kBatch + (numPlaces % kBatch != 0);
    auto const evaluateBatch = [&](int batch) {
        int const begin = batch * kBatch;
        evaluatePatches(task, begin, begin + std::min(numPlaces - begin, kBatch));
    };
    FarExt::ParallelFor(numBatches, std::cref(evaluateBatch));
}

} // namespace OpenSubdivHex::OsdExt
