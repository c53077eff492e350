// SPDX-License-Identifier: Apache-2.0
#include "memory.h"

#include <fstream>
#include <limits>
#include <optional>
#include <string>

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace OpenSubdivHex::Regression {

bool KeepFreedMemory() {
#ifdef __GLIBC__
    return mallopt(M_MMAP_MAX, 0) && mallopt(M_TRIM_THRESHOLD, -1) && mallopt(M_ARENA_MAX, 1);
#else
    return false;
#endif
}

double GetAllocatedBytes() {
#ifdef __GLIBC__
    struct mallinfo2 const info = mallinfo2();
    return double(info.uordblks) + double(info.hblkhd);
#else
    return 0;
#endif
}

namespace {

/// A size of /proc/self/status, in bytes.
std::optional<double> readStatus(std::string const &name) {
    std::ifstream file("/proc/self/status");
    std::string word;
    while (file >> word) {
        double kilobytes = 0;
        if (word == name + ":" && file >> kilobytes) {
            return kilobytes * 1024;
        }
    }
    return std::nullopt;
}

} // namespace

double MeasurePeakBytes(std::function<void()> const &work) {
#ifdef __GLIBC__
    malloc_trim(0); // else the work could use pages that are touched already
#endif
    // 5 sets the peak, VmHWM, to what the process has now: see proc(5).
    bool const isReset = bool(std::ofstream("/proc/self/clear_refs") << "5" << std::flush);
    std::optional<double> const before = readStatus("VmRSS");
    work();
    std::optional<double> const peak = readStatus("VmHWM");
    return isReset && before && peak ? *peak - *before : std::numeric_limits<double>::quiet_NaN();
}

} // namespace OpenSubdivHex::Regression
