// SPDX-License-Identifier: Apache-2.0
#include "interleaved.h"

#include <algorithm>
#include <chrono>
#include <vector>

namespace OpenSubdivHex::Regression {
namespace {

double measureSeconds(std::function<void()> const &work) {
    auto const start = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

double median(std::vector<double> values) {
    auto const middle = values.begin() + std::ptrdiff_t(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

} // namespace

void RunInterleaved(benchmark::State &state, double numItems, std::function<void()> const &own,
                    std::function<void()> const &peer) {
    own();
    peer();
    std::vector<double> ownSeconds;
    std::vector<double> peerSeconds;
    std::vector<double> ratios;
    for ([[maybe_unused]] auto const &iteration : state) {
        ownSeconds.push_back(measureSeconds(own));
        peerSeconds.push_back(measureSeconds(peer));
        ratios.push_back(peerSeconds.back() / ownSeconds.back());
        state.SetIterationTime(ownSeconds.back());
    }
    state.counters["own_ns"] = median(ownSeconds) / numItems * 1e9;
    state.counters["peer_ns"] = median(peerSeconds) / numItems * 1e9;
    state.counters["ratio"] = median(ratios);
}

} // namespace OpenSubdivHex::Regression
