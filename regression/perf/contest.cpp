// SPDX-License-Identifier: Apache-2.0
#include "contest.h"

#include "memory.h"

#include "far_ext/executor.h"

#ifdef _OPENMP
#include <omp.h>
#endif

#include <algorithm>
#include <chrono>
#include <cstddef>

namespace OpenSubdivHex::Regression {
namespace {

void callIfThere(std::function<void()> const &function) {
    if (function) {
        function();
    }
}

double measureSeconds(Contestant const &contestant) {
    SetNumThreads(contestant.numThreads);
    callIfThere(contestant.prepare);
    auto const start = std::chrono::steady_clock::now();
    contestant.work();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

} // namespace

double GetMedian(std::vector<double> values) {
    auto const middle = values.begin() + std::ptrdiff_t(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

double Cost::GetMedian() const { return Regression::GetMedian(nanoseconds); }

double GetRatio(Cost const &own, Cost const &peer) {
    std::vector<double> ratios;
    for (std::size_t i = 0; i < own.nanoseconds.size(); ++i) {
        ratios.push_back(peer.nanoseconds[i] / own.nanoseconds[i]);
    }
    return GetMedian(ratios);
}

std::vector<Cost> RunContest(benchmark::State &state, std::vector<Contestant> const &contestants,
                             bool returnsMemory) {
    std::vector<Cost> costs;
    std::vector<double> numItems;
    std::vector<double> movedBytes;
    for (Contestant const &contestant : contestants) {
        SetNumThreads(contestant.numThreads);
        callIfThere(contestant.prepare);
        double const before = GetAllocatedBytes();
        contestant.work();
        double const made = std::max(0.0, GetAllocatedBytes() - before);
        numItems.push_back(contestant.validate());
        callIfThere(contestant.release);
        Cost cost;
        cost.name = contestant.name;
        cost.numThreads = contestant.numThreads;
        cost.bytes = made / numItems.back();
        costs.push_back(cost);
        movedBytes.push_back(contestant.movedBytes > 0 ? contestant.movedBytes : made);
    }
    for ([[maybe_unused]] auto const &iteration : state) {
        double turnSeconds = 0;
        for (std::size_t i = 0; i < contestants.size(); ++i) {
            if (returnsMemory) {
                measureSeconds(contestants[i]);
                callIfThere(contestants[i].release);
            }
            double const seconds = measureSeconds(contestants[i]);
            callIfThere(contestants[i].release);
            costs[i].nanoseconds.push_back(seconds / numItems[i] * 1e9);
            turnSeconds += seconds;
        }
        state.SetIterationTime(turnSeconds);
    }
    for (std::size_t i = 0; i < contestants.size(); ++i) {
        double const nanoseconds = costs[i].GetMedian();
        costs[i].bytesPerSecond = movedBytes[i] / (nanoseconds * numItems[i]) * 1e9;
        std::string const threads = "/" + std::to_string(costs[i].numThreads);
        state.counters[costs[i].name + threads] = nanoseconds;
    }
    return costs;
}

void SetNumThreads(int numThreads) {
#ifdef _OPENMP
    // For Osd's evaluators.
    omp_set_num_threads(numThreads);
#endif
    FarExt::SetNumThreads(numThreads);
    // Starts or wakes them, which the first contestant alone would pay for.
    FarExt::ParallelFor(numThreads, [](int) {});
}

} // namespace OpenSubdivHex::Regression
