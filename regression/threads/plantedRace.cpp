// SPDX-License-Identifier: Apache-2.0
//
// A program with a race, of threads of the default executor, of OpenMP or of std::thread, that
// ThreadSanitizer must see.
#include "far_ext/executor.h"

#include <string>
#include <thread>

namespace {

using namespace OpenSubdivHex;

int raceOfExecutor(int numRounds) {
    int sum = 0;
    FarExt::SetNumThreads(4);
    for (int round = 0; round < numRounds; ++round) {
        FarExt::ParallelFor(100, [&](int i) {
            sum += i;
            std::this_thread::yield(); // so that other threads come
        });
    }
    return sum;
}

int raceOfOpenMp() {
    int sum = 0;
#pragma omp parallel num_threads(4)
    { sum += 1; }
    return sum;
}

int raceOfThreads(int numRounds) {
    int sum = 0;
    auto const add = [&] {
        for (int i = 0; i < numRounds; ++i) {
            sum += i;
        }
    };
    std::thread other(add);
    add();
    other.join();
    return sum;
}

int race(std::string const &kind) {
    if (kind == "executor") {
        return raceOfExecutor(100);
    }
    return kind == "openmp" ? raceOfOpenMp() : raceOfThreads(1000);
}

} // namespace

int main(int numArguments, char **arguments) {
    return race(numArguments > 1 ? arguments[1] : "") == -1;
}
