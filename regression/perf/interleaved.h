// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_REGRESSION_PERF_INTERLEAVED_H
#define OPENSUBDIVHEX_REGRESSION_PERF_INTERLEAVED_H

#include <benchmark/benchmark.h>

#include <functional>

namespace OpenSubdivHex::Regression {

/// \brief Times \p own against \p peer, which do the same work on \p numItems items.
///
/// They take turns within each iteration, so that both see the same machine.  The time of the
/// benchmark is that of \p own, and these counters are made: the medians \c own_ns and \c peer_ns,
/// in nanoseconds per item, and \c ratio, the median of the ratios peer to own of each turn.
///
/// The benchmark must be registered with UseManualTime().
void RunInterleaved(benchmark::State &state, double numItems, std::function<void()> const &own,
                    std::function<void()> const &peer);

} // namespace OpenSubdivHex::Regression

#endif
