// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_OMP_EXECUTOR_H
#define OPENSUBDIVHEX_FAR_EXT_OMP_EXECUTOR_H

#ifdef _OPENMP

#include "executor.h"
#include "threads.h"

#include <omp.h>

namespace OpenSubdivHex::FarExt {

/// \brief Runs loops on the threads of OpenMP, those of the calling thread's team: for hosts that
/// have no others, or say by OMP_PROC_BIND and the like where they run.
///
/// There only in programs compiled with OpenMP: this header is all of it.
///
/// OpenMP waits at the end of a loop for all threads of the team, for those too that find nothing to
/// do, and its threads keep their processors while they wait, unless OMP_WAIT_POLICY is passive.
/// Beside other threads that are busy a call can be many times slower so than with the default
/// executor, or on one thread (benchmark busy).
class OmpExecutor : public Executor {
public:
    int GetNumThreads() const override { return omp_get_max_threads(); }

    void ParallelFor(int count, std::function<void(int)> const &function) override {
        if (count < 1) {
            return;
        }
        int const numThreads = FarExt::GetNumThreads();
#pragma omp parallel for schedule(dynamic) num_threads(count < numThreads ? count : numThreads)
        for (int i = 0; i < count; ++i) {
            function(i);
        }
    }
};

} // namespace OpenSubdivHex::FarExt

#endif

#endif
