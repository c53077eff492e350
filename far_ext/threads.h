// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_THREADS_H
#define OPENSUBDIVHEX_FAR_EXT_THREADS_H

#include "export.h"

namespace OpenSubdivHex::FarExt {

/// \brief Sets how many threads each call of this library, far_ext or osd_ext, uses from now on
/// when the calling thread makes it; other threads of the program keep their own number.
///
/// Until then, and again after 0 or less, OpenMP says: omp_set_num_threads(), which is of the
/// calling thread, too, and OMP_NUM_THREADS.  Without OpenMP every call uses its own thread alone.
/// Results do not depend on the number.
///
/// **After fork()** the number is 1 in the child, for the thread that goes on there: the OpenMP of
/// GCC would wait for ever for the threads of the parent.  It may be raised again where the parent
/// did not use OpenMP before, or with the OpenMP of LLVM.  Threads that the child makes are free of
/// this.  No other thread of the parent may be in a call of this library at the fork.
OPENSUBDIVHEX_API void SetNumThreads(int numThreads);

/// How many threads a call from the calling thread uses at most, 1 or more.
OPENSUBDIVHEX_API int GetNumThreads();

} // namespace OpenSubdivHex::FarExt

#endif
