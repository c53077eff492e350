// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_REGRESSION_THREADS_ON_THREADS_H
#define OPENSUBDIVHEX_REGRESSION_THREADS_ON_THREADS_H

#include <gtest/gtest.h>

#include <atomic>
#include <cstddef>
#include <thread>
#include <vector>

namespace OpenSubdivHex::Regression {

/// Threads that the following functions start.
constexpr int kNumThreadsAtOnce = 4;

/// Calls run(thread) on several threads at once.
template <typename RUN>
void RunOnThreads(RUN const &run) {
    std::atomic<int> numWaiting{0};
    std::vector<std::thread> threads;
    for (int thread = 0; thread < kNumThreadsAtOnce; ++thread) {
        threads.emplace_back([&, thread] {
            ++numWaiting;
            while (numWaiting < kNumThreadsAtOnce) {
            }
            run(thread);
        });
    }
    for (std::thread &thread : threads) {
        thread.join();
    }
}

/// Expects of make() that it gives \p expected on each of several threads at once.
template <typename RESULT, typename MAKE>
void ExpectOnThreads(RESULT const &expected, MAKE const &make) {
    EXPECT_FALSE(expected.empty());
    std::vector<RESULT> made(kNumThreadsAtOnce);
    RunOnThreads([&](int thread) { made[std::size_t(thread)] = make(); });
    for (RESULT const &ofThread : made) {
        EXPECT_TRUE(ofThread == expected);
    }
}

} // namespace OpenSubdivHex::Regression

#endif
