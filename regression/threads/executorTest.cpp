// SPDX-License-Identifier: Apache-2.0
//
// Executors: that each makes all calls once, how many threads do, that hosts can bring their own,
// and that nobody waits for who does not come.
#include "far_ext/executor.h"
#include "far_ext/stencilTableFactory.h"
#include "far_ext/topologyRefinerFactory.h"
#include "osd_ext/cpuEvaluator.h"
#include "osd_ext/refinementEvaluator.h"
#include "regression/osd_ext/evaluators.h"
#include "regression/shapes/shapeDescriptor.h"

#ifdef OPENSUBDIVHEX_HAS_TBB
#include "far_ext/tbbExecutor.h"

#include <tbb/task_arena.h>
#include <tbb/task_scheduler_observer.h>
#endif

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdlib>
#include <memory>
#include <mutex>
#include <new>
#include <set>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace OpenSubdivHex::Regression::executorTest {

using FarExt::Executor;
using FarExt::ExecutorScope;

namespace {

/// A thread for each call, as a host might have it at worst; in reverse order.
class ThreadPerCall : public Executor {
public:
    int GetNumThreads() const override { return 5; }
    void ParallelFor(int count, std::function<void(int)> const &function) override {
        ++numLoops;
        std::vector<std::thread> threads;
        for (int i = count - 1; i >= 0; --i) {
            threads.emplace_back([&function, i] { function(i); });
        }
        for (std::thread &thread : threads) {
            thread.join();
        }
    }

    std::atomic<int> numLoops{0};
};

/// All calls by the calling thread, one after the other.
class Alone : public Executor {
public:
    int GetNumThreads() const override { return 4; }
    void ParallelFor(int count, std::function<void(int)> const &function) override {
        ++numLoops;
        maxCount = std::max(maxCount, count);
        for (int i = 0; i < count; ++i) {
            function(i);
        }
    }

    int numLoops = 0;
    int maxCount = 0;
};

class NoMemory : public Executor {
public:
    int GetNumThreads() const override { return 2; }
    void ParallelFor(int, std::function<void(int)> const &) override { throw std::bad_alloc(); }
};

struct NamedExecutor {
    std::string name;
    Executor *executor;
};

std::vector<NamedExecutor> const &getExecutors() {
    static ThreadPerCall threadPerCall;
    static Alone alone;
    static std::vector<NamedExecutor> const executors = [] {
        std::vector<NamedExecutor> result = {{"default", &FarExt::GetDefaultExecutor()},
                                             {"thread per call", &threadPerCall},
                                             {"alone", &alone}};
#ifdef _OPENMP
        static FarExt::OmpExecutor openMp;
        result.push_back({"OpenMP", &openMp});
#endif
#ifdef OPENSUBDIVHEX_HAS_TBB
        static FarExt::TbbExecutor tbb;
        result.push_back({"TBB", &tbb});
#endif
        return result;
    }();
    return executors;
}

/// \brief Everything that calls make of a shape, large enough for several threads.
struct Made {
    Made() {
        constexpr int kLevel = 6;
        Shape const shape = MakeIcosahedron();
        refiner = FarExt::TopologyRefinerFactory::Create(*CreateFarRefiner(shape));
        FarExt::TopologyRefiner::UniformOptions options(kLevel);
        options.fullTopologyInLastLevel = true;
        refiner->RefineUniform(options);
        FarExt::TopologyLevel const &last = refiner->GetLevel(kLevel);
        for (int face = 0; face < last.GetNumFaces(); ++face) {
            add(last.GetFaceVertices(face), &indices);
            add(last.GetFaceEdges(face), &indices);
        }
        table = FarExt::StencilTableFactory::Create(*refiner);
        add(table->GetControlIndices(), &indices);
        add(table->GetWeights(), &floats);
        FarExt::LimitStencilTableFactory::Options limitOptions;
        limitOptions.level = 3;
        auto const limit = FarExt::LimitStencilTableFactory::Create(*refiner, limitOptions);
        add(limit->GetDuWeights(), &floats);
        source.assign(shape.positions.begin(), shape.positions.end());
        Evaluate<OsdExt::ParallelEvaluator>();
        auto const evaluator = OsdExt::RefinementEvaluator::Create(*refiner);
        std::vector<float> values(3 * std::size_t(evaluator->GetNumElementsAllLevels()));
        Descriptor const desc(0, 3, 3);
        evaluator->EvaluateAllLevels(source.data(), desc, values.data(), desc);
        add(values, &floats);
    }

    template <class EVALUATOR>
    std::vector<float> Evaluate() {
        std::vector<float> values(3 * std::size_t(table->GetNumStencils()));
        Descriptor const desc(0, 3, 3);
        EVALUATOR::EvalStencils(source.data(), desc, values.data(), desc, table->GetSizes().data(),
                                table->GetOffsets().data(), table->GetControlIndices().data(),
                                table->GetWeights().data(), 0, table->GetNumStencils());
        add(values, &floats);
        return values;
    }

    template <class ARRAY, typename T>
    static void add(ARRAY const &array, std::vector<T> *all) {
        all->insert(all->end(), array.begin(), array.end());
    }

    std::unique_ptr<FarExt::TopologyRefiner> refiner;
    std::unique_ptr<Far::StencilTable const> table;
    std::vector<float> source;
    std::vector<int> indices;
    std::vector<float> floats;
};

} // namespace

TEST(Executor, MakesEveryCallOnce) {
    for (auto const &[name, executor] : getExecutors()) {
        SCOPED_TRACE(name);
        for (int numThreads : {0, 1, 2, 3, 8}) {
            ExecutorScope const scope(executor, numThreads);
            for (int count : {0, 1, 2, 3, 7, 200}) {
                std::vector<std::atomic<int>> numCalls(std::size_t(count) + 1);
                executor->ParallelFor(count, [&](int i) { ++numCalls[std::size_t(i)]; });
                FarExt::ParallelFor(count, [&](int i) { ++numCalls[std::size_t(i)]; });
                for (int i = 0; i < count; ++i) {
                    ASSERT_EQ(numCalls[std::size_t(i)], 2) << i << " of " << count;
                }
                EXPECT_EQ(numCalls.back(), 0);
            }
        }
    }
}

TEST(Executor, DoesNotChangeResults) {
    FarExt::SetNumThreads(1);
    Made const expected;
    FarExt::SetNumThreads(0);
    for (auto const &[name, executor] : getExecutors()) {
        for (int numThreads : {0, 2, 7}) {
            SCOPED_TRACE(name + ", " + std::to_string(numThreads));
            ExecutorScope const scope(executor, numThreads);
            Made const made;
            EXPECT_TRUE(made.indices == expected.indices);
            EXPECT_TRUE(made.floats == expected.floats);
        }
    }
}

#ifdef OPENSUBDIVHEX_HAS_TBB
namespace {

/// Counts how often threads of TBB come to an arena to work there.
class WorkerCounter : public tbb::task_scheduler_observer {
public:
    explicit WorkerCounter(tbb::task_arena &arena) : tbb::task_scheduler_observer(arena) {
        observe(true);
    }
    ~WorkerCounter() override { observe(false); }
    void on_scheduler_entry(bool isWorker) override { numTimes += isWorker ? 1 : 0; }

    std::atomic<int> numTimes{0};
};

} // namespace

TEST(Executor, TbbUsesAsManyThreadsAsWereChosen) {
    Made made;
    tbb::task_arena arena(2);
    WorkerCounter const workers(arena);
    FarExt::TbbExecutor executor;
    auto const evaluate = [&](int numThreads) {
        ExecutorScope const scope(&executor, numThreads);
        arena.execute([&] { made.Evaluate<OsdExt::ParallelEvaluator>(); });
    };
    for (int i = 0; i < 50; ++i) {
        evaluate(1);
    }
    EXPECT_EQ(workers.numTimes, 0);
    // All of TBB otherwise: they come when they find the time.
    for (int i = 0; i < 10000 && workers.numTimes == 0; ++i) {
        evaluate(0);
    }
    EXPECT_GT(workers.numTimes, 0);
}
#endif

// The executor is that of the thread's innermost scope, then that of SetExecutor(), else the default one.
TEST(Executor, IsChosenForAllOrForAThread) {
    Executor &standard = FarExt::GetDefaultExecutor();
    int const numDefault = FarExt::GetNumThreads();
    EXPECT_EQ(&FarExt::GetExecutor(), &standard);
    ThreadPerCall ofAll;
    Alone ofScope;
    FarExt::SetExecutor(&ofAll);
    EXPECT_EQ(&FarExt::GetExecutor(), &ofAll);
    EXPECT_EQ(FarExt::GetNumThreads(), 5);
    std::thread([&] { EXPECT_EQ(&FarExt::GetExecutor(), &ofAll); }).join();
    {
        ExecutorScope const scope(&ofScope);
        EXPECT_EQ(&FarExt::GetExecutor(), &ofScope);
        EXPECT_EQ(FarExt::GetNumThreads(), 4);
        std::thread([&] { EXPECT_EQ(&FarExt::GetExecutor(), &ofAll); }).join();
        {
            ExecutorScope const inner(nullptr, 2);
            EXPECT_EQ(&FarExt::GetExecutor(), &ofScope);
            EXPECT_EQ(FarExt::GetNumThreads(), 2);
            ExecutorScope const innermost(&ofAll);
            EXPECT_EQ(FarExt::GetNumThreads(), 5);
        }
        EXPECT_EQ(FarExt::GetNumThreads(), 4);
        FarExt::SetNumThreads(3);
        EXPECT_EQ(FarExt::GetNumThreads(), 3);
    }
    EXPECT_EQ(&FarExt::GetExecutor(), &ofAll);
    FarExt::SetExecutor(nullptr);
    EXPECT_EQ(&FarExt::GetExecutor(), &standard);
    EXPECT_EQ(FarExt::GetNumThreads(), numDefault);
}

TEST(Executor, RunsAllLoopsOfCalls) {
    Alone executor;
    {
        ExecutorScope const scope(&executor);
        Made const made;
        EXPECT_EQ(executor.maxCount, 4);
    }
    EXPECT_GT(executor.numLoops, 10);
}

namespace {

/// Until help has credit again, whatever the loops before were like.
void waitForCredit() { std::this_thread::sleep_for(std::chrono::milliseconds(250)); }

/// \brief Calls function(), in a loop of two calls at once, on the thread that comes to help, while
/// the calling one waits for it to begin.
template <typename FUNCTION>
void callOnWorker(FUNCTION function) {
    ExecutorScope const scope(nullptr, 2);
    std::atomic<bool> hasBegun{false};
    auto const caller = std::this_thread::get_id();
    FarExt::ParallelFor(2, [&](int) {
        if (std::this_thread::get_id() != caller) {
            hasBegun = true;
            function();
            return;
        }
        auto const end = std::chrono::steady_clock::now() + std::chrono::seconds(60);
        while (!hasBegun && std::chrono::steady_clock::now() < end) {
            std::this_thread::yield();
        }
        EXPECT_TRUE(hasBegun);
    });
}

} // namespace

// A worker that has no processor, as it is here asleep, costs the credit that help has.
TEST(Executor, DefaultOneWorksAloneForATimeWhereHelpIsHeldUp) {
    using Clock = std::chrono::steady_clock;
    constexpr std::chrono::milliseconds kTime(40);
    constexpr int kMaxTries = 100;
    bool isTested = false;
    for (int i = 0; i < kMaxTries && !isTested; ++i) {
        waitForCredit();
        callOnWorker([&] { std::this_thread::sleep_for(kTime); });
        auto const end = Clock::now() + kTime;
        ExecutorScope const scope(nullptr, 2);
        std::atomic<int> numOthers{0};
        auto const caller = std::this_thread::get_id();
        FarExt::ParallelFor(20, [&](int) {
            std::this_thread::sleep_for(std::chrono::microseconds(100));
            numOthers += std::this_thread::get_id() != caller;
        });
        if (Clock::now() < end) { // else there may be credit again
            EXPECT_EQ(numOthers, 0);
            isTested = true;
        }
    }
    EXPECT_TRUE(isTested);
    waitForCredit();
    callOnWorker([] {});
}

// The calling thread and those that come to help it.
TEST(Executor, DefaultOneUsesAsManyThreadsAsAreWanted) {
    constexpr int kNumThreads = 4;
    std::mutex mutex;
    std::condition_variable isThere;
    std::set<std::thread::id> threads;
    waitForCredit();
    ExecutorScope const scope(&FarExt::GetDefaultExecutor(), kNumThreads);
    // Every thread waits for the others: without them the loop would not end.
    FarExt::ParallelFor(kNumThreads, [&](int) {
        std::unique_lock<std::mutex> lock(mutex);
        threads.insert(std::this_thread::get_id());
        isThere.notify_all();
        EXPECT_TRUE(isThere.wait_for(lock, std::chrono::seconds(60),
                                     [&] { return threads.size() == kNumThreads; }));
    });
    EXPECT_EQ(threads.size(), kNumThreads);
    EXPECT_EQ(threads.count(std::this_thread::get_id()), 1u);
    // No more than that, however long the loop.
    threads.clear();
    FarExt::ParallelFor(200, [&](int) {
        std::this_thread::sleep_for(std::chrono::microseconds(100));
        std::lock_guard<std::mutex> const lock(mutex);
        threads.insert(std::this_thread::get_id());
    });
    EXPECT_LE(threads.size(), kNumThreads);
    // The default executor itself, called for more than the thread wants, keeps to that, too.
    threads.clear();
    FarExt::GetDefaultExecutor().ParallelFor(200, [&](int) {
        std::this_thread::sleep_for(std::chrono::microseconds(100));
        std::lock_guard<std::mutex> const lock(mutex);
        threads.insert(std::this_thread::get_id());
    });
    EXPECT_LE(threads.size(), kNumThreads);
}

// All workers are held up in a loop of one thread: the loops of another end without them.
TEST(Executor, DefaultOneWaitsForNobodyWhoHasNotBegun) {
    constexpr int kNumThreads = 3;
    std::atomic<int> numHeld{0};
    std::atomic<bool> isReleased{false};
    waitForCredit();
    std::thread holder([&] {
        FarExt::SetNumThreads(kNumThreads);
        FarExt::ParallelFor(kNumThreads, [&](int) {
            ++numHeld;
            while (!isReleased) {
                std::this_thread::sleep_for(std::chrono::milliseconds(1));
            }
        });
    });
    while (numHeld < kNumThreads) {
        std::this_thread::yield();
    }
    std::set<std::thread::id> threads;
    std::mutex mutex;
    {
        ExecutorScope const scope(nullptr, kNumThreads);
        for (int loop = 0; loop < 100; ++loop) {
            FarExt::ParallelFor(10, [&](int) {
                std::lock_guard<std::mutex> const lock(mutex);
                threads.insert(std::this_thread::get_id());
            });
        }
    }
    EXPECT_EQ(threads, std::set<std::thread::id>{std::this_thread::get_id()});
    EXPECT_EQ(numHeld, kNumThreads);
    isReleased = true;
    holder.join();
}

TEST(Executor, LoopsMayBeNested) {
    for (auto const &[name, executor] : getExecutors()) {
        SCOPED_TRACE(name);
        FarExt::SetExecutor(executor); // for all threads that make the outer calls
        std::atomic<int> numCalls{0};
        FarExt::ParallelFor(6, [&](int) { FarExt::ParallelFor(7, [&](int) { ++numCalls; }); });
        EXPECT_EQ(numCalls, 42);
        FarExt::SetExecutor(nullptr);
    }
}

TEST(Executor, CarriesExceptionsOut) {
    for (auto const &[name, executor] : getExecutors()) {
        SCOPED_TRACE(name);
        ExecutorScope const scope(executor, 3);
        std::atomic<int> numCalls{0};
        EXPECT_THROW(FarExt::ParallelFor(100,
                                         [&](int i) {
                                             ++numCalls;
                                             if (i == 60) {
                                                 throw std::runtime_error("at 60");
                                             }
                                         }),
                     std::runtime_error);
        EXPECT_GE(numCalls, 1);
        numCalls = 0;
        FarExt::ParallelFor(100, [&](int) { ++numCalls; });
        EXPECT_EQ(numCalls, 100);
    }
    // Exceptions of an executor itself reach the caller, too.
    NoMemory noMemory;
    ExecutorScope const scope(&noMemory);
    EXPECT_THROW(FarExt::ParallelFor(2, [](int) {}), std::bad_alloc);
    EXPECT_THROW(Made(), std::bad_alloc);
}

namespace {

/// Calls the library when it is destroyed, behind the end of main.
struct LastCaller {
    ~LastCaller() {
        std::atomic<int> numCalls{0};
        FarExt::SetNumThreads(3);
        FarExt::ParallelFor(50, [&](int) { ++numCalls; });
        if (numCalls != 50) {
            std::abort();
        }
    }
};

} // namespace

TEST(ExecutorDeathTest, ServesCallsWhileTheProgramExits) {
    for (bool const usesThreadsBefore : {false, true}) {
        EXPECT_EXIT(
            {
                static LastCaller const last;
                if (usesThreadsBefore) {
                    FarExt::SetNumThreads(3);
                    FarExt::ParallelFor(50, [](int) {});
                }
                std::exit(0);
            },
            testing::ExitedWithCode(0), "");
    }
}

} // namespace OpenSubdivHex::Regression::executorTest
