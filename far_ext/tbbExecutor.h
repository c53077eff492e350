// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_TBB_EXECUTOR_H
#define OPENSUBDIVHEX_FAR_EXT_TBB_EXECUTOR_H

#include "executor.h"

#include <tbb/parallel_for.h>
#include <tbb/partitioner.h>
#include <tbb/task_arena.h>

namespace OpenSubdivHex::FarExt {

/// \brief Runs loops on TBB's threads, in the arena of the calling thread: for hosts that use TBB, as Embree, USD and
/// Blender do.
///
/// Header only: the library does not use TBB; a program that includes this header links it.
///
/// \code
/// static FarExt::TbbExecutor executor;
/// FarExt::SetExecutor(&executor);
/// \endcode
class TbbExecutor : public Executor {
public:
    int GetNumThreads() const override { return tbb::this_task_arena::max_concurrency(); }

    void ParallelFor(int count, std::function<void(int)> const &function) override {
        // While the calling thread waits, it takes no other work of the host, which might be long, or
        // want what the host has locked for the call.
        tbb::this_task_arena::isolate(
            [&] { tbb::parallel_for(0, count, function, tbb::simple_partitioner()); });
    }
};

} // namespace OpenSubdivHex::FarExt

#endif
