// SPDX-License-Identifier: Apache-2.0
#include "failingAllocations.h"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdlib>
#include <new>

#include <malloc.h>

// The linker puts these in the place of malloc and free, by its option --wrap.
extern "C" {
void *__real_malloc(std::size_t size);
void __real_free(void *memory);
void *__wrap_malloc(std::size_t size);
void __wrap_free(void *memory);
}

namespace OpenSubdivHex::Regression {

namespace {

std::atomic<Failing> failing{Failing::None};
std::atomic<bool> isCounting{false};
std::atomic<bool> hasFailed{false};
std::atomic<long> failingNumber{0};
std::atomic<long> count{0};
std::atomic<long> numLive{0};
std::atomic<long> numLiveBytes{0};
std::atomic<long> numPeakBytes{0};

void countBytes(void *memory) {
    long const live = numLiveBytes += long(malloc_usable_size(memory));
    for (long peak = numPeakBytes;
         live > peak && !numPeakBytes.compare_exchange_weak(peak, live);) {
    }
}

bool shallFail() {
    if (!isCounting) {
        return false;
    }
    long const number = ++count;
    bool const fails = (failing == Failing::One && number == failingNumber) ||
                       (failing == Failing::AllSince && number >= failingNumber);
    if (fails) {
        hasFailed = true;
    }
    return fails;
}

void *allocate(std::size_t size, std::size_t alignment) {
    if (shallFail()) {
        return nullptr;
    }
    void *memory = nullptr;
    if (alignment <= alignof(std::max_align_t)) {
        memory = __real_malloc(std::max(size, std::size_t(1)));
    } else if (posix_memalign(&memory, alignment, std::max(size, std::size_t(1))) != 0) {
        memory = nullptr;
    }
    if (memory) {
        ++numLive;
        countBytes(memory);
    }
    return memory;
}

void *allocateOrThrow(std::size_t size, std::size_t alignment = alignof(std::max_align_t)) {
    void *const memory = allocate(size, alignment);
    if (!memory) {
        throw std::bad_alloc();
    }
    return memory;
}

void release(void *memory) {
    if (memory) {
        --numLive;
        numLiveBytes -= long(malloc_usable_size(memory));
    }
    __real_free(memory);
}

} // namespace

FailingAllocations::FailingAllocations(Failing newFailing, long number) {
    failing = newFailing;
    failingNumber = number;
    hasFailed = false;
    count = 0;
    isCounting = true;
}

FailingAllocations::~FailingAllocations() { isCounting = false; }

long FailingAllocations::GetCount() const { return count; }

bool FailingAllocations::HasFailed() const { return hasFailed; }

long CountLiveAllocations() { return numLive; }

long CountLiveBytes() { return numLiveBytes; }

long GetPeakBytes() { return numPeakBytes; }

void ResetPeakBytes() { numPeakBytes = numLiveBytes.load(); }

} // namespace OpenSubdivHex::Regression

using namespace OpenSubdivHex::Regression;

extern "C" void *__wrap_malloc(std::size_t size) {
    return allocate(size, alignof(std::max_align_t));
}
extern "C" void __wrap_free(void *memory) { release(memory); }

// The other forms call these; AddressSanitizer has one of its own that does not throw.
void *operator new(std::size_t size) { return allocateOrThrow(size); }
void *operator new(std::size_t size, std::nothrow_t const &) noexcept {
    return allocate(size, alignof(std::max_align_t));
}
void *operator new(std::size_t size, std::align_val_t alignment) {
    return allocateOrThrow(size, std::size_t(alignment));
}
void operator delete(void *memory) noexcept { release(memory); }
void operator delete(void *memory, std::size_t) noexcept { release(memory); }
void operator delete(void *memory, std::align_val_t) noexcept { release(memory); }
void operator delete(void *memory, std::size_t, std::align_val_t) noexcept { release(memory); }
