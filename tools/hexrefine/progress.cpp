// SPDX-License-Identifier: Apache-2.0
#include "progress.h"

#include <cstdio>

#ifdef _WIN32
#include <io.h>
#else
#include <unistd.h>
#endif

namespace OpenSubdivHex::Tools {

Progress::Progress(bool isShown) {
    if (isShown) {
        _thread = std::thread(&Progress::run, this);
    }
}

Progress::~Progress() {
    if (_thread.joinable()) {
        {
            std::lock_guard<std::mutex> const lock(_mutex);
            _isDone = true;
        }
        _wakeUp.notify_one();
        _thread.join();
    }
}

bool Progress::IsTerminal() {
#ifdef _WIN32
    return _isatty(_fileno(stderr)) != 0;
#else
    return isatty(fileno(stderr)) != 0;
#endif
}

void Progress::SetPhase(std::string const &phase) {
    std::lock_guard<std::mutex> const lock(_mutex);
    _phase = phase;
}

void Progress::run() {
    using namespace std::chrono_literals;
    constexpr char kClearLine[] = "\r\x1b[K";

    std::unique_lock<std::mutex> lock(_mutex);
    bool isLineShown = false;
    for (auto next = _start + 1s; !_wakeUp.wait_until(lock, next, [this] { return _isDone; });
         next += 500ms) {
        std::chrono::duration<double> const time = std::chrono::steady_clock::now() - _start;
        std::fprintf(stderr, "%s%s ... %.1f s", kClearLine, _phase.c_str(), time.count());
        std::fflush(stderr);
        isLineShown = true;
    }
    if (isLineShown) {
        std::fputs(kClearLine, stderr);
    }
}

} // namespace OpenSubdivHex::Tools
