// SPDX-License-Identifier: Apache-2.0
//
// Runs a fuzz target where libFuzzer is not: on bytes that follow from a seed, seed by seed, or on
// the content of files.
#include "apart.h"

#include <atomic>
#include <charconv>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <iterator>
#include <new>
#include <random>
#include <string>
#include <vector>

#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

extern "C" int LLVMFuzzerTestOneInput(std::uint8_t const *data, std::size_t size);
extern "C" __attribute__((weak)) void FuzzReport(unsigned char const *data, unsigned long size);

namespace {

using Bytes = std::vector<std::uint8_t>;
using Clock = std::chrono::steady_clock;

constexpr double kLongestCase = 120; ///< seconds

/// Messages of the process that runs cases to the process that waits for it.
struct Progress {
    std::atomic<std::uint64_t> seed{0};
    std::atomic<std::uint64_t> numCases{0};
    std::atomic<bool> isDone{false};
};

Bytes makeBytes(std::uint64_t seed) {
    std::mt19937_64 random(seed);
    Bytes bytes(24 + random() % 160);
    for (std::uint8_t &byte : bytes) {
        byte = std::uint8_t(random() >> 32);
    }
    return bytes;
}

void run(Bytes const &bytes) { LLVMFuzzerTestOneInput(bytes.data(), bytes.size()); }

double getSecondsSince(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Runs \p numCases cases, or for \p numSeconds where that is 0, and ends the process.
[[noreturn]] void runCases(Progress &progress, std::uint64_t numCases, double numSeconds) {
    auto const start = Clock::now();
    while (numCases > 0 ? progress.numCases < numCases : getSecondsSince(start) < numSeconds) {
        run(makeBytes(progress.seed));
        ++progress.numCases;
        ++progress.seed;
    }
    progress.isDone = true;
    std::exit(0);
}

/// \return  whether the process ended well; one that spends too long on a case is ended
bool waitFor(pid_t child, Progress const &progress) {
    std::uint64_t numCases = progress.numCases;
    auto since = Clock::now();
    int status = 0;
    while (waitpid(child, &status, WNOHANG) == 0) {
        usleep(20000);
        if (progress.numCases != numCases || progress.isDone) {
            numCases = progress.numCases;
            since = Clock::now();
        } else if (getSecondsSince(since) > kLongestCase) {
            std::cerr << "fuzz: a case takes longer than " << kLongestCase << " seconds\n";
            kill(child, SIGKILL);
            waitpid(child, &status, 0);
            return false;
        }
    }
    return status == 0;
}

void report(Bytes const &bytes) {
    if (&FuzzReport) {
        FuzzReport(bytes.data(), bytes.size());
    }
}

/// As runCases() in a process of its own.
int fuzz(std::uint64_t firstSeed, std::uint64_t numCases, double numSeconds) {
    void *const shared =
        mmap(nullptr, sizeof(Progress), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (shared == MAP_FAILED) {
        std::cerr << "fuzz: no shared memory\n";
        return 2;
    }
    auto &progress = *new (shared) Progress;
    progress.seed = firstSeed;
    auto const start = Clock::now();
    pid_t const child = fork();
    if (child == 0) {
        runCases(progress, numCases, numSeconds);
    }
    // Done, too: a case may end the process as if all were well.
    bool const isGood = child > 0 && waitFor(child, progress) && progress.isDone;
    std::cout << "fuzz: " << progress.numCases << " cases, seeds from " << firstSeed << " on, "
              << getSecondsSince(start) << " seconds" << std::endl;
    if (isGood) {
        return 0;
    }
    if (progress.isDone) {
        std::cerr << "fuzz: all cases pass, but the process did not end well\n";
        return 1;
    }
    std::cerr << "fuzz: seed " << progress.seed << " fails: repeat it by --seed " << progress.seed
              << " --cases 1\n";
    report(makeBytes(progress.seed));
    return 1;
}

/// \return  whether \p text is a number above 0
bool parse(std::string const &text, std::uint64_t *number) {
    auto const [end, error] = std::from_chars(text.data(), text.data() + text.size(), *number);
    return error == std::errc() && end == text.data() + text.size() && *number > 0;
}

int runFile(std::string const &name) {
    std::ifstream file(name, std::ios::binary);
    Bytes const bytes{std::istreambuf_iterator<char>(file), {}};
    if (!file) {
        std::cerr << "fuzz: cannot read " << name << '\n';
        return 2;
    }
    if (!OpenSubdivHex::Regression::FailsApart([&] { run(bytes); }, unsigned(kLongestCase))) {
        std::cout << "fuzz: " << name << " passes\n";
        return 0;
    }
    std::cerr << "fuzz: " << name << " fails\n";
    report(bytes);
    return 1;
}

} // namespace

int main(int numArguments, char **arguments) {
    std::uint64_t seed = 1;
    std::uint64_t numCases = 0;
    std::uint64_t numSeconds = 0;
    bool isValid = numArguments > 1;
    for (int i = 1; isValid && i < numArguments; ++i) {
        std::string const option = arguments[i];
        std::uint64_t *const number = option == "--seed"      ? &seed
                                      : option == "--cases"   ? &numCases
                                      : option == "--seconds" ? &numSeconds
                                                              : nullptr;
        if (number) {
            isValid = ++i < numArguments && parse(arguments[i], number);
        } else if (numArguments == 2 && option[0] != '-') {
            return runFile(option);
        } else {
            isValid = false;
        }
    }
    if (!isValid || (numCases == 0) == (numSeconds == 0)) {
        std::cerr << "usage: " << arguments[0]
                  << " [--seed FIRST] --cases NUMBER | [--seed FIRST] --seconds NUMBER | FILE\n";
        return 2;
    }
    return fuzz(seed, numCases, numSeconds);
}
