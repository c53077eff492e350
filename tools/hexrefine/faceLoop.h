// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_TOOLS_FACE_LOOP_H
#define OPENSUBDIVHEX_TOOLS_FACE_LOOP_H

#include "far_ext/executor.h"

#include <atomic>
#include <exception>
#include <mutex>

namespace OpenSubdivHex::Tools {

/// \brief Calls function(face) for faces [0, numFaces), on the threads of the executor and in any order.
///
/// The last exception of those that it throws is thrown again.
template <typename FUNCTION>
void ForEachFace(int numFaces, FUNCTION const &function) {
    std::atomic<int> next(0);
    std::mutex mutex;
    std::exception_ptr exception; // which no worker may let out
    FarExt::GetExecutor().ParallelFor(FarExt::GetNumThreads(), [&](int) {
        try {
            for (int face = next++; face < numFaces; face = next++) {
                function(face);
            }
        } catch (...) {
            std::lock_guard<std::mutex> const lock(mutex);
            exception = std::current_exception();
        }
    });
    if (exception) {
        std::rethrow_exception(exception);
    }
}

} // namespace OpenSubdivHex::Tools

#endif
