// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_OMP_EXECUTOR_H
#define OPENSUBDIVHEX_FAR_EXT_OMP_EXECUTOR_H

#ifdef _OPENMP

#include "executor.h"
#include "threads.h"

#include <omp.h>

namespace OpenSubdivHex::FarExt {

/// \brief Runs loops on OpenMP's threads: for hosts that bind these to processors (OMP_PROC_BIND).
///
/// Header only, and only in programs compiled with OpenMP.
///
/// \code
///     FarExt::OmpExecutor executor;
///     FarExt::ExecutorScope const scope(&executor);
/// \endcode
///
/// OpenMP waits at the end of a loop for all threads of the team, idle ones included, and threads keep their processors
/// while they wait unless OMP_WAIT_POLICY is passive.  Beside other busy threads a call can be many times slower than with
/// the default executor, or than on one thread (benchmark busy).
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
