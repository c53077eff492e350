// SPDX-License-Identifier: Apache-2.0
#include "parallel.h"

#include "far_ext/executor.h"

#include <algorithm>
#include <cstdint>

namespace OpenSubdivHex::FarExt::internal {

RangeQueue::RangeQueue(Far::Index numRanges, int numWorkers)
    : _numShares(std::clamp(numWorkers, 1, kMaxShares)) {
    for (int i = 0; i < _numShares; ++i) {
        auto const begin = [&](int share) {
            return Far::Index(std::int64_t(numRanges) * share / _numShares);
        };
        _shares[i].next.store(begin(i), std::memory_order_relaxed);
        _shares[i].end = begin(i + 1);
    }
}

bool RangeQueue::Take(int worker, Far::Index *range) {
    for (int i = 0; i < _numShares; ++i) {
        Share &share = _shares[(worker + i) % _numShares];
        if (share.next.load(std::memory_order_relaxed) < share.end) {
            *range = share.next.fetch_add(1, std::memory_order_relaxed);
            if (*range < share.end) {
                return true;
            }
        }
    }
    return false;
}

void ForEachRange(Far::Index numRanges, Far::Index maxAlone,
                  std::function<void(RangeQueue &, int)> const &work) {
    int const numThreads =
        numRanges > maxAlone ? int(std::min<Far::Index>(numRanges, GetNumThreads())) : 1;
    RangeQueue queue(numRanges, numThreads);
    if (numThreads == 1) {
        work(queue, 0);
    } else {
        // A reference, since a larger function would take memory.
        auto const workOf = [&](int worker) { work(queue, worker); };
        GetExecutor().ParallelFor(numThreads, std::cref(workOf));
    }
}

} // namespace OpenSubdivHex::FarExt::internal
