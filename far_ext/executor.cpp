// SPDX-License-Identifier: Apache-2.0
#include "executor.h"

#include "vtr/parallel.h"

#include <algorithm>
#include <atomic>

namespace OpenSubdivHex::FarExt {

namespace {

std::atomic<Executor *> executorOfAll{nullptr}; // null: the default one

// The choice of the calling thread.
thread_local Executor *chosenExecutor = nullptr; // null: that of all
thread_local int chosenNumThreads = 0;           // 0: that of the executor

} // namespace

Executor::~Executor() = default;

void SetExecutor(Executor *executor) { executorOfAll = executor; }

Executor &GetExecutor() {
    Executor *const executor = chosenExecutor ? chosenExecutor : executorOfAll.load();
    return executor ? *executor : GetDefaultExecutor();
}

void SetNumThreads(int numThreads) { chosenNumThreads = std::max(0, numThreads); }

int GetNumThreads() {
    return chosenNumThreads > 0 ? chosenNumThreads : std::max(1, GetExecutor().GetNumThreads());
}

ExecutorScope::ExecutorScope(Executor *executor, int numThreads)
    : _executor(chosenExecutor), _numThreads(chosenNumThreads) {
    if (executor) {
        chosenExecutor = executor;
        chosenNumThreads = 0;
    }
    if (numThreads > 0) {
        chosenNumThreads = numThreads;
    }
}

ExecutorScope::~ExecutorScope() {
    chosenExecutor = _executor;
    chosenNumThreads = _numThreads;
}

void ParallelFor(int count, std::function<void(int)> const &function) {
    internal::ExceptionKeeper exceptions;
    internal::ForEachRange(count, 1, [&](internal::RangeQueue &queue, int worker) {
        for (int i; queue.Take(worker, &i);) {
            if (!exceptions.Run([&] { function(i); })) {
                return;
            }
        }
    });
    exceptions.Rethrow();
}

} // namespace OpenSubdivHex::FarExt
