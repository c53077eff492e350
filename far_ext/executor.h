// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_EXECUTOR_H
#define OPENSUBDIVHEX_FAR_EXT_EXECUTOR_H

#include "export.h"

#include <functional>

#ifdef _OPENMP
#include <omp.h>
#endif

namespace OpenSubdivHex::FarExt {

/// \brief Sets how many threads each call of this library, of all its parts, uses at most from now on
/// when the calling thread makes it; other threads of the program keep their own number.
///
/// Until then, and again after 0 or less, the Executor in use says: the default one that of OpenMP,
/// which is omp_set_num_threads() of the calling thread or OMP_NUM_THREADS, and in a build without
/// OpenMP that of the processors.  Results do not depend on the number.
///
/// For one call, see ExecutorScope.
OPENSUBDIVHEX_API void SetNumThreads(int numThreads);

/// How many threads a call from the calling thread uses at most, 1 or more.
OPENSUBDIVHEX_API int GetNumThreads();

/// \brief Runs loops on threads: what a host implements to have the calls of this library, of
/// all its parts, work on threads of its own.
///
/// TbbExecutor and OmpExecutor are two.  Results do not depend on the executor, bit for bit.
///
/// A call of the library makes a few loops, one after the other, each of them as
/// ParallelFor(n, function) where n is the number of threads that are wanted.  function(i) then
/// takes pieces of the work until none is left: who comes first does the most, and who comes late
/// finds nothing to do and returns at once.  So a thread that is busy elsewhere holds nobody up.
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
    /// The order is free, and so are the threads, of which the calling one is best one: it need not
    /// wait for any other then.  \p function throws nothing.  Several threads may call this at once,
    /// and \p function may.
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

/// \brief The executor of whoever sets none: threads of this library, which all calls share.
///
/// They are started when a call first wants more threads than there are, and sleep while there is
/// nothing to do.  The calling thread works, too: it does all of the work where no other comes, and
/// waits only for pieces that another has begun.  With many callers at once, who have the processors
/// busy without help, each works alone.
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

/// That of calls from the calling thread: of its innermost ExecutorScope, else of SetExecutor().
OPENSUBDIVHEX_API Executor &GetExecutor();

/// \brief Sets executor and number of threads for the calls that the calling thread makes while it
/// lives: for one call, or some.  Scopes of a thread end in the reverse order.
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
/// What a call throws is thrown again when all have ended; others may then be left out.
OPENSUBDIVHEX_API void ParallelFor(int count, std::function<void(int)> const &function);

#ifdef _OPENMP
/// \brief Runs loops on the threads of OpenMP, those of the calling thread's team: for hosts that
/// have no others, or say by OMP_PROC_BIND and the like where they run.
///
/// There only in programs compiled with OpenMP; the library itself does not know it.
///
/// OpenMP waits at the end of a loop for all threads of the team, for those too that find nothing to
/// do, and its threads keep their processors while they wait, unless OMP_WAIT_POLICY is passive.
/// Beside other threads that are busy a call can be many times slower so than with the default
/// executor, or on one thread (benchmark busy).
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
