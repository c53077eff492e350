// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_VTR_RUNS_H
#define OPENSUBDIVHEX_FAR_EXT_VTR_RUNS_H

#include "far_ext/status.h"

#include <algorithm>

namespace OpenSubdivHex::FarExt::internal {

/// \brief Takes the run [begin, end) of components apart at those that are listed, ascending.
///
/// Calls between(begin, end, n) for the runs between them, which are not empty, and
/// listed(index, n) for those themselves, in order; n of all listed components come before.
template <typename LIST, typename BETWEEN, typename LISTED>
void ForEachRun(Far::Index begin, Far::Index end, LIST const &list, BETWEEN between,
                LISTED listed) {
    auto next = std::lower_bound(list.begin(), list.end(), begin);
    while (begin < end) {
        auto const numBefore = Far::Index(next - list.begin());
        Far::Index const runEnd = next == list.end() ? end : std::min(*next, end);
        if (begin < runEnd) {
            between(begin, runEnd, numBefore);
        }
        if (runEnd < end) {
            listed(runEnd, numBefore);
            ++next;
        }
        begin = runEnd + 1;
    }
}

/// \brief Adds a run behind the others, or to the last one where it goes on with that.
///
/// A RUN has a begin and an end; isAlike(a, b) tells whether two runs may become one.
template <typename RUNS, typename RUN, typename IS_ALIKE>
void AppendRun(RUNS &runs, RUN const &run, IS_ALIKE isAlike) {
    if (run.begin == run.end) {
        return;
    }
    if (!runs.empty() && runs.back().end == run.begin && isAlike(runs.back(), run)) {
        runs.back().end = run.end;
    } else {
        runs.push_back(run);
    }
}

} // namespace OpenSubdivHex::FarExt::internal

#endif
