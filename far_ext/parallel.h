// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_PARALLEL_H
#define OPENSUBDIVHEX_FAR_EXT_PARALLEL_H

#include "status.h"

#include <algorithm>

namespace OpenSubdivHex::FarExt::internal {

/// \brief Calls function(begin, end) for ranges that together are 0 ... count, in parallel with
/// OpenMP where that is there.
///
/// The ranges do not depend on the number of threads.  Calls must write to places of their own: then
/// the result does not depend on it either.
template <typename FUNCTION>
void ParallelForRange(Far::Index count, FUNCTION function) {
    constexpr Far::Index kRange = 4096;
    Far::Index const numRanges = count / kRange + (count % kRange != 0);
#ifdef _OPENMP
#pragma omp parallel for schedule(dynamic, 4) if (numRanges > 4)
#endif
    for (Far::Index range = 0; range < numRanges; ++range) {
        Far::Index const begin = range * kRange;
        function(begin, std::min(count - begin, kRange) + begin);
    }
}

/// The same for single indices.
template <typename FUNCTION>
void ParallelFor(Far::Index count, FUNCTION function) {
    ParallelForRange(count, [&](Far::Index begin, Far::Index end) {
        for (Far::Index i = begin; i < end; ++i) {
            function(i);
        }
    });
}

} // namespace OpenSubdivHex::FarExt::internal

#endif
