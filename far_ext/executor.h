// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_EXECUTOR_H
#define OPENSUBDIVHEX_FAR_EXT_EXECUTOR_H

#include "export.h"

#include <functional>

#ifdef _OPENMP
#include <omp.h>
#endif

namespace OpenSubdivHex::FarExt {

/// \brief Sets how many threads each call of the calling thread uses at most, from now on.
///
/// 0 or less: as many as the Executor says, which is the initial state.  The default executor says OpenMP's number
/// (omp_set_num_threads() of the calling thread, or OMP_NUM_THREADS); in a build without OpenMP the number of processors.
/// Results do not depend on the number.
///
/// For one call, see ExecutorScope.
OPENSUBDIVHEX_API void SetNumThreads(int numThreads);

/// How many threads a call from the calling thread uses at most, 1 or more.
OPENSUBDIVHEX_API int GetNumThreads();

/// \brief Interface that a host implements to run the loops of this library on its own threads.
///
/// TbbExecutor and OmpExecutor implement it.  Results do not depend on the executor, bit for bit.
///
/// \code
///     static FarExt::TbbExecutor executor;
///     FarExt::SetExecutor(&executor);                     // for all calls
///     FarExt::ExecutorScope const scope(&executor, 4);    // for the calls of this thread in this scope
/// \endcode
///
/// A call of the library makes a few loops, one after the other: ParallelFor(n, function), where n is the number of threads
/// wanted.  function(i) takes pieces of work until none is left.  The first thread to come does the most; a late one finds
/// nothing and returns at once.  So a busy thread delays no other.
class OPENSUBDIVHEX_API Executor {
public:
    Executor() = default;
    virtual ~Executor();

    Executor(Executor const &) = delete;
    Executor &operator=(Executor const &) = delete;

    /// How many threads a call uses at most where SetNumThreads() does not say, the calling one
    /// included: 1 or more.  Called by any thread, at any time.
    virtual int GetNumThreads() const = 0;

    /// \brief Calls function(i) once for each 0 <= i < \p count, and returns when all calls have.
    ///
    /// Order and threads are free.  Use the calling thread, too: it can then do all the work without waiting.  \p function
    /// throws nothing.  Several threads may call this at once, \p function included.
    ///
    /// While it waits, the calling thread may do other work of the host, which may call this library.  Such a call may
    /// read whatever the waiting call reads: the same refiner, table, surface or stream.  As from any other thread, it
    /// must not use a RefinementEvaluator that evaluates, nor a refiner that is being refined.  It is inside the
    /// ExecutorScope of the waiting call; scopes that it begins it must end, and SetNumThreads() it must leave alone.
    ///
    /// The library calls this while it holds no lock and while it uses nothing that it keeps for the thread.  Surfaces
    /// are made and evaluated by the calling thread alone, without an executor.  ParallelFor() returns on the thread that
    /// called it.
    ///
    /// May throw std::bad_alloc, once no call of \p function is running any more.
    virtual void ParallelFor(int count, std::function<void(int)> const &function) = 0;
};

/// \brief The default executor: a pool of threads that all calls share.
///
/// Calls run on the caller plus the pool, and never wait for idle workers: the calling thread waits only for pieces that
/// another thread has begun.  Threads start when a call first wants more than there are, and sleep while idle.  With many
/// callers at once, who keep the processors busy, each caller works alone.
///
/// GetNumThreads() is the number that OpenMP says, omp_set_num_threads() of the calling thread or
/// OMP_NUM_THREADS, where the library was built with OpenMP; else that of the processors.
///
/// A child process that fork() made has threads of its own; none of the parent's may be in a call of
/// this library at the fork.  When the program exits, or unloads the library, its threads end;
/// calls that come later use the calling thread alone.
OPENSUBDIVHEX_API Executor &GetDefaultExecutor();

/// \brief Sets the executor of all calls from now on, by any thread; null: the default one.
///
/// \param executor  must live until another was set and all calls that use it have returned
OPENSUBDIVHEX_API void SetExecutor(Executor *executor);

/// The executor of calls from the calling thread: of its innermost ExecutorScope, else of SetExecutor().
OPENSUBDIVHEX_API Executor &GetExecutor();

/// \brief Sets executor and number of threads for the calls of the calling thread while the scope lives.  Scopes of a
/// thread end in reverse order.
class OPENSUBDIVHEX_API ExecutorScope {
public:
    /// \param executor    null: as it is; else must live as long as the scope
    /// \param numThreads  1 or more; 0 or less: that of the executor, or as it is without one
    explicit ExecutorScope(Executor *executor, int numThreads = 0);
    ~ExecutorScope();

    ExecutorScope(ExecutorScope const &) = delete;
    ExecutorScope &operator=(ExecutorScope const &) = delete;

private:
    Executor *_executor; // before
    int _numThreads;
};

/// \brief Calls function(i) once for each 0 <= i < \p count, as the library's own loops do: on
/// GetExecutor(), by GetNumThreads() threads at most.
///
/// If a call throws, ParallelFor() throws the same when all running calls have ended; other calls may be left out.
OPENSUBDIVHEX_API void ParallelFor(int count, std::function<void(int)> const &function);

#ifdef _OPENMP
/// \brief Runs loops on OpenMP's threads: for hosts that bind these to processors (OMP_PROC_BIND).
///
/// Header only, and only in programs compiled with OpenMP.
///
/// \code
///     FarExt::OmpExecutor executor;
///     FarExt::ExecutorScope const scope(&executor);
/// \endcode
///
/// OpenMP waits at the end of a loop for all threads of the team, idle ones included, and threads keep their processors
/// while they wait unless OMP_WAIT_POLICY is passive.  Beside other busy threads a call can be many times slower than with
/// the default executor, or than on one thread (benchmark busy).
class OmpExecutor : public Executor {
public:
    int GetNumThreads() const override { return omp_get_max_threads(); }

    void ParallelFor(int count, std::function<void(int)> const &function) override {
        if (count < 1) {
            return;
        }
        int const numThreads = FarExt::GetNumThreads();
#pragma omp parallel for schedule(dynamic) num_threads(count < numThreads ? count : numThreads)
        for (int i = 0; i < count; ++i) {
            function(i);
        }
    }
};
#endif

} // namespace OpenSubdivHex::FarExt

#endif
