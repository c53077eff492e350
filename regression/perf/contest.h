// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_REGRESSION_PERF_CONTEST_H
#define OPENSUBDIVHEX_REGRESSION_PERF_CONTEST_H

#include <benchmark/benchmark.h>

#include <functional>
#include <string>
#include <vector>

namespace OpenSubdivHex::Regression {

/// \brief One way of doing the work of a benchmark.
struct Contestant {
    std::string name;
    int numThreads = 1;
    std::function<void()> prepare = nullptr; ///< before the work, not timed; may be null
    std::function<void()> work = nullptr;    ///< is timed
    /// Throws std::runtime_error unless the work has made what it should, else gives the number of
    /// items that it has made: costs are per item.
    std::function<double()> validate = nullptr;
    std::function<void()> release = nullptr; ///< frees what the work made, not timed; may be null
    double movedBytes = 0; ///< to be read and written at least; 0: what stays allocated
};

/// \brief Time and memory of a contestant.
struct Cost {
    std::string name;
    int numThreads = 1;
    std::vector<double> nanoseconds; ///< per item, by turn
    double bytes = 0;                ///< per item, that stay allocated after the work
    double bytesPerSecond = 0;       ///< moved, at the median time

    double GetMedian() const;
};

double GetMedian(std::vector<double> values);

/// The median of the ratios \p peer to \p own of each turn.
double GetRatio(Cost const &own, Cost const &peer);

/// \brief Runs the contestants in turns, so that all of them see the same machine: once to validate
/// what they make and to touch their memory, then once in each iteration of \p state.
///
/// \param returnsMemory  whether the work takes its memory from the system and gives it back.  Then
///                       each runs once more before it is timed, else it would be timed with what
///                       the one before it gave back: a virtual machine hands free pages to its
///                       host, and to have them again costs more than the work.
///
/// The benchmark must be registered with UseManualTime(); its time is that of a whole turn, and
/// each contestant has a counter with its median in nanoseconds per item.
std::vector<Cost> RunContest(benchmark::State &state, std::vector<Contestant> const &contestants,
                             bool returnsMemory);

/// For all parallel work of this thread from now on.
void SetNumThreads(int numThreads);

} // namespace OpenSubdivHex::Regression

#endif
