// SPDX-License-Identifier: Apache-2.0
//
// A program with a race, of threads of OpenMP or of std::thread, that ThreadSanitizer must see.
#include <string>
#include <thread>

namespace {

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

} // namespace

int main(int numArguments, char **arguments) {
    bool const isOpenMp = numArguments > 1 && std::string(arguments[1]) == "openmp";
    return (isOpenMp ? raceOfOpenMp() : raceOfThreads(1000)) == -1;
}
