// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_TOOLS_PROGRESS_H
#define OPENSUBDIVHEX_TOOLS_PROGRESS_H

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

namespace OpenSubdivHex::Tools {

/// \brief Shows on a terminal what a long run is doing: one line that is rewritten twice a second,
/// from the second second on, and removed at the end.
class Progress {
public:
    /// Shows nothing unless \p isShown.
    explicit Progress(bool isShown);
    ~Progress();

    Progress(Progress const &) = delete;
    Progress &operator=(Progress const &) = delete;

    /// Whether the standard error stream is a terminal.
    static bool IsTerminal();

    void SetPhase(std::string const &phase);

private:
    void run();

    std::chrono::steady_clock::time_point const _start = std::chrono::steady_clock::now();
    std::mutex _mutex;
    std::condition_variable _wakeUp;
    std::string _phase;
    bool _isDone = false;
    std::thread _thread;
};

} // namespace OpenSubdivHex::Tools

#endif
