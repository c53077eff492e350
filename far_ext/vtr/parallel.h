// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_VTR_PARALLEL_H
#define OPENSUBDIVHEX_FAR_EXT_VTR_PARALLEL_H

#include "far_ext/status.h"
#include "far_ext/threads.h"

#include <algorithm>
#include <exception>
#include <optional>
#include <vector>

namespace OpenSubdivHex::FarExt::internal {

/// The length of ranges for work of some nanoseconds per index.
constexpr Far::Index kParallelRange = 4096;

/// Number of ranges that ParallelForRange makes of \p count indices.
inline Far::Index GetNumParallelRanges(Far::Index count, Far::Index length = kParallelRange) {
    return count / length + (count % length != 0);
}

/// \brief Keeps the first of the exceptions that pieces of work throw in threads, to be thrown again
/// behind the region of OpenMP, which no exception may leave.
class ExceptionKeeper {
public:
    /// Calls work() in any thread.
    /// \return  whether it threw nothing
    template <typename WORK>
    bool Run(WORK work) noexcept {
        try {
            work();
            return true;
        } catch (...) {
#ifdef _OPENMP
#pragma omp critical(OpenSubdivHexException)
#endif
            if (!_exception) {
                _exception = std::current_exception();
            }
            return false;
        }
    }

    /// Throws what was kept; outside of all regions.
    void Rethrow() const {
        if (_exception) {
            std::rethrow_exception(_exception);
        }
    }

private:
    std::exception_ptr _exception;
};

/// Calls work() while no other thread does so; what it throws reaches the caller.
template <typename WORK>
void RunExclusively(WORK work) {
    ExceptionKeeper exceptions;
#ifdef _OPENMP
#pragma omp critical(OpenSubdivHexExclusive)
#endif
    exceptions.Run(work);
    exceptions.Rethrow();
}

/// \brief Calls function(state, begin, end) for ranges that together are 0 ... count, in parallel
/// with OpenMP where that is there.  Range number i begins at i \p length; each thread has a state
/// of its own, made by makeState().
///
/// The ranges do not depend on the number of threads.  Calls must write to places of their own, and
/// leave nothing in the state that another range could see: then the result does not depend on it
/// either.  What a call throws is thrown again, once all have ended.
template <typename MAKE_STATE, typename FUNCTION>
void ParallelForRange(Far::Index count, MAKE_STATE makeState, FUNCTION function,
                      Far::Index length = kParallelRange) {
    Far::Index const numRanges = GetNumParallelRanges(count, length);
    ExceptionKeeper exceptions;
#ifdef _OPENMP
#pragma omp parallel if (numRanges > 4) num_threads(GetNumThreads())
#endif
    {
        std::optional<decltype(makeState())> state;
        exceptions.Run([&] { state.emplace(makeState()); });
#ifdef _OPENMP
#pragma omp for schedule(dynamic, 2)
#endif
        for (Far::Index range = 0; range < numRanges; ++range) {
            Far::Index const begin = range * length;
            // What a call has thrown out of may have left its state in pieces.
            if (state && !exceptions.Run([&] {
                    function(*state, begin, begin + std::min(count - begin, length));
                })) {
                state.reset();
            }
        }
    }
    exceptions.Rethrow();
}

/// Calls function(begin, end) in the same way, for ranges without a state.
template <typename FUNCTION>
void ParallelForRange(Far::Index count, FUNCTION function) {
    struct Nothing {};
    ParallelForRange(
        count, [] { return Nothing(); },
        [&](Nothing, Far::Index begin, Far::Index end) { function(begin, end); });
}

/// Calls function(i) for 0 <= i < count in the same way.
template <typename FUNCTION>
void ParallelFor(Far::Index count, FUNCTION function) {
    ParallelForRange(count, [&](Far::Index begin, Far::Index end) {
        for (Far::Index i = begin; i < end; ++i) {
            function(i);
        }
    });
}

/// \brief Adds up what sum(begin, end) gives for the ranges of ParallelForRange.
///
/// \return  by range, the sum of those before; then that of all
template <typename SUM, typename FUNCTION>
std::vector<SUM> ParallelSums(Far::Index count, FUNCTION sum) {
    std::vector<SUM> result(std::size_t(GetNumParallelRanges(count)) + 1);
    ParallelForRange(count, [&](Far::Index begin, Far::Index end) {
        result[begin / kParallelRange + 1] = sum(begin, end);
    });
    for (std::size_t i = 1; i < result.size(); ++i) {
        result[i] += result[i - 1];
    }
    return result;
}

/// Gathers the i of 0 <= i < count that satisfy predicate(i), ascending, in the same way.
template <typename PREDICATE>
std::vector<Far::Index> ParallelSelect(Far::Index count, PREDICATE predicate) {
    std::vector<std::vector<Far::Index>> selected(GetNumParallelRanges(count));
    ParallelForRange(count, [&](Far::Index begin, Far::Index end) {
        std::vector<Far::Index> &ofRange = selected[begin / kParallelRange];
        for (Far::Index i = begin; i < end; ++i) {
            if (predicate(i)) {
                ofRange.push_back(i);
            }
        }
    });
    std::vector<Far::Index> result;
    for (std::vector<Far::Index> const &ofRange : selected) {
        result.insert(result.end(), ofRange.begin(), ofRange.end());
    }
    return result;
}

} // namespace OpenSubdivHex::FarExt::internal

#endif
