// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_THREADS_H
#define OPENSUBDIVHEX_FAR_EXT_THREADS_H

#include "export.h"

namespace OpenSubdivHex::FarExt {

/// \brief Sets how many threads each call of the calling thread uses at most, from now on.
///
/// 0 or less: as many as the Executor says, which is the initial state.  The default executor says OpenMP's number
/// (omp_set_num_threads() of the calling thread, or OMP_NUM_THREADS); in a build without OpenMP the number of processors.
/// Results do not depend on the number.
///
/// For one call, see ExecutorScope.
OPENSUBDIVHEX_API void SetNumThreads(int numThreads);

/// How many threads a call from the calling thread uses at most, 1 or more.
OPENSUBDIVHEX_API int GetNumThreads();

} // namespace OpenSubdivHex::FarExt

#endif
