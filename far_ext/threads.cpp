// SPDX-License-Identifier: Apache-2.0
#include "threads.h"

#ifdef _OPENMP
#include <omp.h>
#endif
#if defined(__unix__) || defined(__APPLE__)
#include <pthread.h>
#endif

#include <algorithm>

namespace OpenSubdivHex::FarExt {

namespace {

thread_local int chosenNumThreads = 0;

#if defined(_OPENMP) && (defined(__unix__) || defined(__APPLE__))
// When the library is loaded, since the program may have used OpenMP before it calls the library.
// Without memory for the handler the child is as it would be without.
[[maybe_unused]] int const kForkHandlerError =
    pthread_atfork(nullptr, nullptr, [] { chosenNumThreads = 1; });
#endif

} // namespace

void SetNumThreads(int numThreads) { chosenNumThreads = std::max(0, numThreads); }

int GetNumThreads() {
#ifdef _OPENMP
    return chosenNumThreads > 0 ? chosenNumThreads : omp_get_max_threads();
#else
    return 1;
#endif
}

} // namespace OpenSubdivHex::FarExt
