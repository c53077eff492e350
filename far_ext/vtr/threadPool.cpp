// SPDX-License-Identifier: Apache-2.0
#include "far_ext/executor.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <ctime>
#include <exception>
#include <mutex>
#include <new>
#include <thread>
#include <vector>

#if defined(__GLIBC__)
#include <sched.h>
#endif
#ifdef _OPENMP
#include <omp.h>
#endif
#if defined(__unix__) || defined(__APPLE__)
#include <pthread.h>
#endif

namespace OpenSubdivHex::FarExt {

namespace internal {

namespace {

using Lock = std::unique_lock<std::mutex>;
using Clock = std::chrono::steady_clock;
using Nanoseconds = std::chrono::nanoseconds;

// How long a thread looks again and again for what it waits for before it sleeps: about as long as
// it takes to wake it.
constexpr std::chrono::microseconds kSpinTime(50);

// Tells the processor that its thread waits for another.
void pause() {
#if defined(__GNUC__) && (defined(__x86_64__) || defined(__i386__))
    __builtin_ia32_pause();
#elif defined(__GNUC__) && defined(__aarch64__)
    __asm__ volatile("yield");
#endif
}

// Returns when isThere() holds, or after kSpinTime.
template <typename CONDITION>
void spinUntil(CONDITION isThere) {
    constexpr int kLooksPerTime = 16;
    for (auto const end = Clock::now() + kSpinTime; Clock::now() < end;) {
        for (int i = 0; i < kLooksPerTime; ++i) {
            if (isThere()) {
                return;
            }
            pause();
        }
    }
}

// How long the calling thread has had a processor; always 0 where the system does not tell.
Nanoseconds getThreadTime() {
#ifdef CLOCK_THREAD_CPUTIME_ID
    timespec time = {};
    if (clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time) == 0) {
        return std::chrono::seconds(time.tv_sec) + Nanoseconds(time.tv_nsec);
    }
#endif
    return Nanoseconds(0);
}

// The processor that the calling thread runs on, for now; kUnknown where the system does not tell.
constexpr int kUnknown = -1;
int getProcessor() {
#if defined(__GLIBC__)
    return sched_getcpu();
#else
    return kUnknown;
#endif
}

// \brief Account of the gain and cost of workers' help.  On a busy machine a worker may lose its
// processor in the middle of a call, and the caller of the loop has to wait for it, as long as many
// a loop takes.
//
// There is credit in the beginning.  It grows by the work that is done by workers, is spent by
// waiting for those who have no processor, or for one to go on when they are done, and grows with
// time.  Without credit loops are done alone: so waiting costs an eighth of the time at most beside
// what help gains, and where nobody is held up there always is help.
class HelpAccount {
public:
    bool HasCredit() {
        auto const now = Clock::now();
        add((now - _time) / kTimePerCredit);
        _time = now;
        return _credit > Nanoseconds(0);
    }
    void Settle(Nanoseconds gain, Nanoseconds cost) { add(gain - cost); }

private:
    static constexpr int kTimePerCredit = 8;
    static constexpr std::chrono::milliseconds kMaxCredit{2};
    static constexpr std::chrono::milliseconds kMaxDebt{20};

    void add(Nanoseconds credit) {
        _credit = std::clamp<Nanoseconds>(_credit + credit, -kMaxDebt, kMaxCredit);
    }

    Clock::time_point _time = Clock::now();
    Nanoseconds _credit = kMaxCredit;
};

// \brief A loop that a thread has called, and that workers may come to help with.  Whoever calls
// anything but Work() has locked the pool.
class Loop {
public:
    Loop(int count, std::function<void(int)> const &function, int maxWorkers)
        : _count(count), _function(function), _numPlaces(maxWorkers) {}

    // Makes the calls that nobody has begun, one after the other.
    void Work() {
        for (int i; (i = _next.fetch_add(1, std::memory_order_relaxed)) < _count;) {
            _function(i);
        }
    }

    // Where it was called.
    int GetProcessor() const { return _processor; }

    bool WantsWorker() const {
        return _numPlaces > 0 && _next.load(std::memory_order_relaxed) < _count;
    }
    void Enter() {
        --_numPlaces;
        ++_numWorkers;
    }
    // With the time that the worker had a processor, and what it spent without.
    void Leave(Nanoseconds worked, Nanoseconds heldUp) {
        _worked += worked;
        _heldUp = std::max(_heldUp, heldUp);
        if (_numWorkers == 1) {
            _end = Clock::now();
        }
        if (--_numWorkers == 0) {
            _isEmpty.notify_one();
        }
    }
    // Waits until all workers that entered have left; none enters any more.
    void WaitForWorkers(Lock &lock, HelpAccount &account) {
        Nanoseconds cost(0);
        if (_numWorkers > 0) {
            auto const start = Clock::now();
            lock.unlock();
            spinUntil([this] { return _numWorkers == 0; });
            lock.lock();
            _isEmpty.wait(lock, [this] { return _numWorkers == 0; });
            auto const now = Clock::now();
            // Who has slept waits for a processor, too.
            cost = std::min<Nanoseconds>(now - start, _heldUp + (now - _end));
        }
        account.Settle(_worked, cost);
    }

    Loop *next = nullptr; // in the pool's list

private:
    int const _count;
    int const _processor = getProcessor();
    std::function<void(int)> const &_function;
    std::atomic<int> _next{0};
    int _numPlaces; // of workers that may still enter
    std::atomic<int> _numWorkers{0};
    Nanoseconds _worked{0}; // all workers together
    Nanoseconds _heldUp{0}; // the longest of them
    Clock::time_point _end; // of the last
    std::condition_variable _isEmpty;
};

// \brief Workers, and the loops that they may help with.
class ThreadPool : public Executor {
public:
    static ThreadPool &Get() {
        static ThreadPool &pool = make();
        return pool;
    }

    int GetNumThreads() const override {
#ifdef _OPENMP
        return omp_get_max_threads();
#else
        return std::max(1, int(std::thread::hardware_concurrency())); // 0: not known
#endif
    }

    void ParallelFor(int count, std::function<void(int)> const &function) override {
        int const numThreads = std::min(count, FarExt::GetNumThreads());
        Loop loop(count, function, numThreads - 1);
        if (numThreads <= 1) {
            loop.Work();
            return;
        }
        Lock lock(_mutex);
        if (!_account.HasCredit()) {
            lock.unlock();
            loop.Work();
            return;
        }
        startWorkers(numThreads - 1);
        add(loop);
        int const numWanted = std::min(numThreads - _numLoops - _numBusy - _numSpinning,
                                       std::min(numThreads - 1, _numSleeping));
        lock.unlock();
        for (int i = 0; i < numWanted; ++i) {
            _hasLoop.notify_one();
        }
        loop.Work();
        lock.lock();
        remove(loop);
        loop.WaitForWorkers(lock, _account);
    }

private:
    ThreadPool() = default;

    // Never destroyed, since calls may come when all else is.  A child process makes it anew, for
    // its parent's threads are not there, and what they held and waited for is as they left it.
    static ThreadPool &make() {
        alignas(ThreadPool) static unsigned char memory[sizeof(ThreadPool)];
        static ThreadPool *pool = new (memory) ThreadPool;
#if defined(__unix__) || defined(__APPLE__)
        // Without memory for the handlers the child is as it would be without.
        static_cast<void>(pthread_atfork([] { pool->_mutex.lock(); }, [] { pool->_mutex.unlock(); },
                                         [] {
                                             pool->_mutex.unlock();
                                             new (memory) ThreadPool;
                                         }));
#endif
        return *pool;
    }

    // Has \p count workers, or as many as the system gives.
    void startWorkers(int count) {
        // Ends the workers when the program exits or unloads the library.
        static struct Closer {
            ~Closer() { Get().close(); }
        } closer;
        try {
            while (int(_workers.size()) < count && !_isClosed) {
                _workers.emplace_back([this] { work(); });
            }
        } catch (std::exception const &) {
        }
    }

    void close() {
        std::vector<std::thread> workers;
        {
            Lock const lock(_mutex);
            _isClosed = true;
            workers.swap(_workers);
        }
        _hasLoop.notify_all();
        for (std::thread &worker : workers) {
            worker.join();
        }
    }

    // The loop of a worker.
    void work() {
        Lock lock(_mutex);
        while (!_isClosed) {
            Loop *const loop = findLoop();
            if (!loop) {
                ++_numSleeping;
                _hasLoop.wait(lock);
                --_numSleeping;
                continue;
            }
            loop->Enter();
            ++_numBusy;
            lock.unlock();
            auto const start = Clock::now();
            Nanoseconds const threadStart = getThreadTime();
            loop->Work();
            Nanoseconds const worked = getThreadTime() - threadStart;
            Nanoseconds const heldUp = Clock::now() - start - worked;
            int const processor = getProcessor();
            bool const isApart = processor == kUnknown || processor != loop->GetProcessor();
            lock.lock();
            loop->Leave(worked, heldUp);
            --_numBusy;
            if (!isApart) {
                continue; // who spins here keeps the caller from its processor
            }
            // Mostly the caller makes another loop at once.
            ++_numSpinning;
            lock.unlock();
            spinUntil([this, numAdded = _numAdded.load()] { return _numAdded != numAdded; });
            lock.lock();
            --_numSpinning;
        }
    }

    Loop *findLoop() const {
        Loop *loop = _firstLoop;
        while (loop && !loop->WantsWorker()) {
            loop = loop->next;
        }
        return loop;
    }

    void add(Loop &loop) {
        *findLink(nullptr) = &loop;
        ++_numLoops;
        ++_numAdded;
    }
    void remove(Loop &loop) {
        *findLink(&loop) = loop.next;
        --_numLoops;
    }
    // Pointer to a loop of the list; null is the end.
    Loop **findLink(Loop const *loop) {
        Loop **link = &_firstLoop;
        while (*link != loop) {
            link = &(*link)->next;
        }
        return link;
    }

    std::mutex _mutex; // guards all that is not atomic
    std::vector<std::thread> _workers;
    bool _isClosed = false;
    std::condition_variable _hasLoop; // what sleeping workers wait for
    int _numBusy = 0;                 // of the workers
    int _numSpinning = 0;
    int _numSleeping = 0;
    Loop *_firstLoop = nullptr; // the oldest
    int _numLoops = 0;
    std::atomic<unsigned> _numAdded{0}; // loops so far
    HelpAccount _account;
};

} // namespace

} // namespace internal

Executor &GetDefaultExecutor() { return internal::ThreadPool::Get(); }

} // namespace OpenSubdivHex::FarExt
