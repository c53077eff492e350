// SPDX-License-Identifier: Apache-2.0
//
// An allocation that fails in any thread reaches the caller as std::bad_alloc.  A program of its
// own, since it replaces operator new.
#include "referenceMatch.h"

#include "far_ext/executor.h"
#include "far_ext/stencilTableFactory.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <new>

namespace {

constexpr std::int64_t kNever = -1;

// Allocations until one fails, counted down by all threads.
std::atomic<std::int64_t> numBeforeFailure = kNever;

void *allocate(std::size_t size) {
    if (numBeforeFailure.load() != kNever && numBeforeFailure.fetch_sub(1) == 0) {
        throw std::bad_alloc();
    }
    if (void *const memory = std::malloc(size > 0 ? size : 1)) {
        return memory;
    }
    throw std::bad_alloc();
}

} // namespace

void *operator new(std::size_t size) { return allocate(size); }
void *operator new[](std::size_t size) { return allocate(size); }
// Who asks for memory in this way does without it: these do not fail.
void *operator new(std::size_t size, std::nothrow_t const &) noexcept { return std::malloc(size); }
void *operator new[](std::size_t size, std::nothrow_t const &) noexcept {
    return std::malloc(size);
}
void operator delete(void *memory) noexcept { std::free(memory); }
void operator delete[](void *memory) noexcept { std::free(memory); }
void operator delete(void *memory, std::size_t) noexcept { std::free(memory); }
void operator delete[](void *memory, std::size_t) noexcept { std::free(memory); }

namespace OpenSubdivHex::Regression::allocationTest {

namespace {

/// Whether work() throws std::bad_alloc when the allocation after \p numBefore others fails.
template <typename WORK>
bool failsAt(std::int64_t numBefore, WORK work) {
    bool fails = false;
    numBeforeFailure = numBefore;
    try {
        work();
    } catch (std::bad_alloc const &) {
        fails = true;
    }
    numBeforeFailure = kNever;
    return fails;
}

/// Lets one allocation of work() after the other fail: all of the first ones, then some.
template <typename WORK>
void expectBadAllocs(WORK work) {
    for (int numThreads : {1, 2}) {
        FarExt::SetNumThreads(numThreads);
        work(); // has the threads started
        std::int64_t numBefore = 0;
        while (failsAt(numBefore, work)) {
            numBefore += 1 + numBefore / 100;
        }
        EXPECT_GT(numBefore, 20);
    }
}

} // namespace

TEST(Allocation, OfStencilTablesMayFail) {
    auto const refiner = CreateRefiner(GetShape("cube"), ReferenceMask::Average, 5);
    expectBadAllocs([&] { FarExt::StencilTableFactory::Create(*refiner); });
}

TEST(Allocation, OfLimitStencilTablesMayFail) {
    auto const refiner = CreateRefiner(GetShape("cube"), ReferenceMask::Average, 1);
    FarExt::LimitStencilTableFactory::Options options;
    options.level = 1;
    options.generateFaceCenters = true;
    expectBadAllocs([&] { FarExt::LimitStencilTableFactory::Create(*refiner, options); });
}

} // namespace OpenSubdivHex::Regression::allocationTest
