// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_THREADS_H
#define OPENSUBDIVHEX_FAR_EXT_THREADS_H

#include "export.h"

namespace OpenSubdivHex::FarExt {

/// \brief Sets how many threads each call of this library, of all its parts, uses at most from now on
/// when the calling thread makes it; other threads of the program keep their own number.
///
/// Until then, and again after 0 or less, the Executor in use says: the default one that of OpenMP,
/// which is omp_set_num_threads() of the calling thread or OMP_NUM_THREADS, and in a build without
/// OpenMP that of the processors.  Results do not depend on the number.
///
/// For one call, see ExecutorScope.
OPENSUBDIVHEX_API void SetNumThreads(int numThreads);

/// How many threads a call from the calling thread uses at most, 1 or more.
OPENSUBDIVHEX_API int GetNumThreads();

} // namespace OpenSubdivHex::FarExt

#endif
